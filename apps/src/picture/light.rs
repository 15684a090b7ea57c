//! Light on a surface: a key light from above left, a weak fill from the right, and the sky.

use super::color::Rgb;
use super::occlusion::ReceivedLight;
use super::vector::{V3, add, dot, scaled, unit};

/// Brightness of each light on a white surface that faces it.
const KEY: f64 = 0.76;
const FILL: f64 = 0.16;
const SKY: f64 = 0.40;
/// Brightness of the light that the ground reflects upwards.
const BOUNCE: f64 = 0.16;
const SHINE: f64 = 0.05;
/// Shares of the white of the ground that come from the sky and from the key light: a full shadow lacks both.
const GROUND_SKY: f64 = 0.42;
const GROUND_KEY: f64 = 0.26;
/// Hidden share of the sky at which the ground is dimmed by half of that share. Smaller shares dim it by less, so that shadows end softly.
const FAINT: f64 = 0.05;

/// The lights of a scene, in pixel coordinates (x right, y down, z towards the viewer).
pub struct Lights {
    up: V3,
    /// Unit vector towards the key light.
    pub key: V3,
    fill: V3,
}

impl Lights {
    /// `up`: the vertical of the scene.
    pub fn new(up: V3) -> Lights {
        // The horizontal direction nearest to the viewer.
        let ahead = unit([0.0, -up[1] * up[2], 1.0 - up[2] * up[2]]).unwrap_or([0.0, 1.0, 0.0]);
        let from = |right: f64, height: f64, front: f64| {
            let direction = add([right, 0.0, 0.0], add(scaled(up, height), scaled(ahead, front)));
            unit(direction).unwrap_or([0.0, 0.0, 1.0])
        };
        Lights { up, key: from(-0.45, 0.66, 0.72), fill: from(0.85, 0.15, 0.6) }
    }

    /// Light from a surface of this colour and unit normal `n` towards the viewer.
    pub fn on(&self, albedo: Rgb, n: V3, open: ReceivedLight) -> Rgb {
        let facing = |light: V3| dot(light, n).max(0.0);
        let tilt = 0.5 + 0.5 * dot(self.up, n);
        let direct = KEY * facing(self.key) * open.key;
        let around = SKY * tilt + BOUNCE * (1.0 - tilt) + FILL * facing(self.fill);
        let half = unit(add(self.key, [0.0, 0.0, 1.0])).unwrap_or([0.0, 0.0, 1.0]);
        let shine = SHINE * facing(half).powi(30) * open.key;
        albedo.map(|a| {
            // Where the surface hides the sky from itself, part of the missing light is reflected by the surface, once or more often.
            let sky = open.sky / (1.0 - 0.9 * a * (1.0 - open.sky));
            soft(a * (direct + around * sky) + shine)
        })
    }

    /// The ground, white where nothing shades it.
    pub fn on_ground(open: ReceivedLight) -> Rgb {
        let hidden = 1.0 - open.sky;
        let sky = hidden * hidden / (hidden + FAINT);
        [1.0 - GROUND_SKY * sky - GROUND_KEY * (1.0 - open.key); 3]
    }
}

/// Keeps what is darker than 0.7 and bends the rest below 1.
fn soft(x: f64) -> f64 {
    const KNEE: f64 = 0.7;
    if x <= KNEE { x } else { 1.0 - (1.0 - KNEE) * f64::exp(-(x - KNEE) / (1.0 - KNEE)) }
}
