//! The camera of a surface: the direction that it is seen from, which is chosen where none is given.

use super::raster::{DrawnShape, Hit, Samples};
use super::upright::{Stance, stance};
use super::vector::{V3, add, bounding_ball, cross, dot, normal, scaled, sub, unit};
use ricci::parallel::map;

/// The direction that a caller wants to see a surface from; parts that are none are chosen.
#[derive(Clone, Copy, Debug, Default)]
pub struct Viewpoint {
    /// The direction that is up.
    pub up: Option<V3>,
    /// Azimuth around the vertical (0: from the front, growing to the right) and elevation above the horizon, radians.
    pub angles: Option<[f64; 2]>,
    /// Without angles: the direction from which to look.
    pub from: Option<V3>,
}

/// An orthographic camera.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// Unit vectors to the right and up on the screen, and towards the viewer.
    pub axes: [V3; 3],
    /// The vertical of the scene, in the camera's axes.
    pub up: V3,
}

/// Side of the small images in which candidate views are compared, pixels.
const PROBE: usize = 72;
/// Candidate azimuths, degrees: three-quarter views from the front and from the back.
const AROUND: [f64; 8] = [-32.0, 32.0, -50.0, 50.0, -130.0, 130.0, -148.0, 148.0];
/// Elevation of the camera, degrees, over surfaces that stand and over those that lie flat.
const STANDING: f64 = 20.0;
const LYING: f64 = 40.0;
/// The area of a surface at a glancing angle counts as this many times its projected area at most.
const GLANCING: f64 = 2.5;
/// Views with more detail are better: the area that a view shows is multiplied with the mean turn of the normals from pixel to pixel, plus
/// [`LEAST_DETAIL`], to this power.
const DETAIL: f64 = 0.3;
const LEAST_DETAIL: f64 = 0.01;
/// Share by which a view from the front is preferred to one from the back.
const FRONT: f64 = 0.08;

impl Camera {
    fn new(up: V3, front: V3, azimuth: f64, elevation: f64) -> Camera {
        let side = cross(up, front);
        let level = add(scaled(front, azimuth.cos()), scaled(side, azimuth.sin()));
        let (sin, cos) = elevation.sin_cos();
        let screen_up = sub(scaled(up, cos), scaled(level, sin));
        let towards = add(scaled(level, cos), scaled(up, sin));
        Camera { axes: [cross(up, level), screen_up, towards], up: [0.0, cos, sin] }
    }

    /// The camera that was asked for, or, of those around the surface at the elevation [`STANDING`] or [`LYING`], the one that shows most.
    pub fn choose(points: &[V3], faces: &[[u32; 3]], view: &Viewpoint) -> Camera {
        let given = view.up.and_then(unit).map(|up| Stance { up, lies: false });
        let Stance { up, lies } = given.unwrap_or_else(|| stance(points, faces));
        let front = front_of(up);
        if let Some([azimuth, elevation]) = view.angles {
            return Camera::new(up, front, azimuth, elevation);
        }
        if let Some(from) = view.from.and_then(unit) {
            let (azimuth, elevation) =
                (dot(from, cross(up, front)).atan2(dot(from, front)), dot(from, up).clamp(-1.0, 1.0).asin());
            return Camera::new(up, front, azimuth, elevation);
        }
        let ball = bounding_ball(points);
        let elevation = if lies { LYING } else { STANDING }.to_radians();
        let candidate = |azimuth: f64| {
            let azimuth = azimuth.to_radians();
            let camera = Camera::new(up, front, azimuth, elevation);
            (camera, (1.0 + FRONT * azimuth.cos()) * camera.shows(points, faces, ball))
        };
        let candidates = map(AROUND.len(), |k| candidate(AROUND[k]));
        let first = candidates[0];
        candidates.into_iter().fold(first, |best, c| if c.1 > best.1 { c } else { best }).0
    }

    /// A point of space as the camera sees it.
    pub fn apply(&self, p: V3) -> V3 {
        self.axes.map(|axis| dot(axis, p))
    }

    /// The area of the surface's outside in a small image, in pixels, weighted with its detail.
    fn shows(&self, points: &[V3], faces: &[[u32; 3]], (centre, radius): (V3, f64)) -> f64 {
        let middle = 0.5 * PROBE as f64;
        let scale = middle * 0.96 / radius;
        let place = |p: &V3| {
            let [x, y, z] = self.apply(sub(*p, centre));
            [middle + scale * x, middle - scale * y, scale * z]
        };
        let seen: Vec<V3> = points.iter().map(place).collect();
        let shapes: Vec<DrawnShape> =
            faces.iter().map(|f| DrawnShape::Triangle(f.map(|v| seen[v as usize]))).collect();
        let samples = Samples::new(&shapes, [PROBE, 0, PROBE], 1.0);
        let normal_of =
            |hit: Hit| unit(normal(faces[hit.shape].map(|v| points[v as usize]))).unwrap_or([0.0; 3]);
        let rows = (0..PROBE).flat_map(|y| samples.row(&shapes, y));
        let normals: Vec<Option<V3>> = rows.map(|(_, hit)| hit.map(normal_of)).collect();
        let (mut area, mut bends) = (0.0, 0.0);
        for (i, n) in normals.iter().enumerate().filter_map(|(i, n)| Some((i, (*n)?))) {
            let cosine = dot(n, self.axes[2]);
            area += if cosine > 0.0 { (1.0 / cosine).min(GLANCING) } else { 0.0 };
            let before = [(i % PROBE > 0).then(|| i - 1), i.checked_sub(PROBE)];
            let turns = before.into_iter().flatten().filter_map(|j| normals[j]);
            bends += turns.map(|m| (1.0 - dot(n, m)).clamp(0.0, 1.0)).sum::<f64>();
        }
        area * (bends / f64::max(area, 1.0) + LEAST_DETAIL).powf(DETAIL)
    }
}

/// The direction of the front of a surface whose vertical is `up`: files with y up mostly face +z, those with z up −y.
fn front_of(up: V3) -> V3 {
    let usual = if up[2].abs() > 0.8 { [0.0, -1.0, 0.0] } else { [0.0, 0.0, 1.0] };
    unit(sub(usual, scaled(up, dot(up, usual)))).unwrap_or([1.0, 0.0, 0.0])
}

#[cfg(test)]
mod tests {
    use super::super::vector::norm;
    use super::*;
    use ricci::mesh::shapes;

    #[test]
    fn axes_are_right_handed_and_the_asked_angles_are_taken() {
        let soup = shapes::icosphere(3).unwrap();
        let view = Viewpoint { up: Some([0.0, 1.0, 0.0]), angles: Some([0.0, 0.0]), from: None };
        let camera = Camera::choose(&soup.positions, &soup.faces, &view);
        for (axis, expected) in camera.axes.iter().zip([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]) {
            assert!(norm(sub(*axis, expected)) < 1e-15, "{axis:?}");
        }
        // From the right and from above.
        let view = Viewpoint { angles: Some([0.5f64, 0.3]), ..view };
        let [x, y, z] = Camera::choose(&soup.positions, &soup.faces, &view).axes;
        assert!(norm(sub(cross(x, y), z)) < 1e-15 && z[0] > 0.0 && (z[1] - 0.3f64.sin()).abs() < 1e-15);
        // From a given direction.
        let from = [0.48, -0.6, -0.64];
        let view = Viewpoint { angles: None, from: Some(from), ..view };
        let [x, y, z] = Camera::choose(&soup.positions, &soup.faces, &view).axes;
        assert!(norm(sub(cross(x, y), z)) < 1e-15 && norm(sub(z, from)) < 1e-15, "{z:?}");
    }

    #[test]
    fn a_torus_lies_and_shows_its_hole() {
        let soup = shapes::torus(2.0, 0.7, 40, 20).unwrap();
        let camera = Camera::choose(&soup.positions, &soup.faces, &Viewpoint::default());
        let up = [0, 1, 2].map(|k| dot(camera.up, camera.axes.map(|a| a[k])));
        assert!((up[2] - 1.0).abs() < 1e-12, "{up:?}");
        assert!(camera.axes[2][2] > 0.5, "{:?}", camera.axes);
    }

    #[test]
    fn an_open_surface_shows_its_outside() {
        // A bowl seen from its convex side: the half sphere z < 0.
        let mut soup = shapes::icosphere(8).unwrap();
        soup.faces.retain(|f| f.iter().all(|v| soup.positions[*v as usize][2] < 0.05));
        let camera = Camera::choose(&soup.positions, &soup.faces, &Viewpoint::default());
        assert!(camera.axes[2][2] < 0.0, "{:?}", camera.axes);
    }
}
