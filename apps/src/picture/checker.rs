//! The checkerboard of a layout on one triangle, filtered to the pixel.

/// Checks along the square root of the surface's area.
const CHECKS: f64 = 26.0;
/// Where a layout's scale varies by more than this factor, the checks are made finer or coarser by it: they stay
/// squares of visible size on the whole surface, nested into one another.
const OCTAVE: f64 = 8.0;
/// Checks narrower than this many pixels are faded to their mean.
const FADE_PIXELS: f64 = 1.5;

/// Checkerboard coordinates at the corners of a triangle.
pub struct Checker {
    uv: [[f64; 2]; 3],
    /// Logarithm to base `OCTAVE` of the layout's scale at the corners, 0 at its median.
    level: [f64; 3],
    /// 1: full contrast, 0: the mean.
    contrast: f64,
}

impl Checker {
    /// `uv`: layout coordinates of face `f`; `pixels`: the triangle on the screen.
    pub fn new(uv: [[f64; 2]; 3], tiles: &Tiles, f: usize, pixels: [[f64; 2]; 3]) -> Checker {
        let uv = uv.map(|p| p.map(|x| x / tiles.size));
        let level = tiles.level[f];
        let mean = ((level[0] + level[1] + level[2]) / 3.0).round();
        // A check covers (pixel area / uv area) pixels.
        let side = (doubled_area(pixels).abs() / doubled_area(uv).abs()).sqrt() * OCTAVE.powf(mean);
        let contrast = if side.is_finite() { (side / FADE_PIXELS - 1.0).clamp(0.0, 1.0) } else { 0.0 };
        Checker { uv, level, contrast }
    }

    /// 0 or 1 (or ½ where faded) at barycentric coordinates.
    pub fn value(&self, b: [f64; 3]) -> f64 {
        let level = (b[0] * self.level[0] + b[1] * self.level[1] + b[2] * self.level[2]).round();
        let zoom = OCTAVE.powf(-level);
        let at =
            |k: usize| (zoom * (b[0] * self.uv[0][k] + b[1] * self.uv[1][k] + b[2] * self.uv[2][k])).floor();
        let odd = (at(0) + at(1)).rem_euclid(2.0) == 1.0;
        0.5 + self.contrast * if odd { 0.5 } else { -0.5 }
    }
}

/// Twice the signed area.
pub fn doubled_area(p: [[f64; 2]; 3]) -> f64 {
    (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0])
}

/// How large the checks are, on the surface and in the layout alike.
pub struct Tiles {
    /// Side of a check at the median scale, in the layout.
    pub size: f64,
    /// Per face and corner: logarithm to base `OCTAVE` of the layout's scale over the median.
    pub level: Vec<[f64; 3]>,
}

impl Tiles {
    /// From the areas of the faces on the surface and in the layout; `faces` over `n` vertices joins the corners.
    pub fn new(surface: &[f64], layout: &[f64], faces: &[[u32; 3]], n: usize) -> Tiles {
        let scale = |(s, l): (&f64, &f64)| (l / s).sqrt();
        let mut order: Vec<(f64, f64)> =
            surface.iter().zip(layout).map(|(s, l)| (scale((s, l)), *s)).collect();
        order.retain(|(x, s)| x.is_finite() && *x > 0.0 && s.is_finite());
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        let total: f64 = order.iter().map(|(_, s)| s).sum();
        let mut sum = 0.0;
        let middle = order.iter().find(|(_, s)| {
            sum += s;
            2.0 * sum >= total
        });
        let median = middle.map_or(1.0, |m| m.0);
        let size = median * total.max(f64::MIN_POSITIVE).sqrt() / CHECKS;
        // Averaged over the faces at each vertex, so that levels change along smooth lines.
        let mut mean = vec![(0.0, 0.0); n];
        for (face, pair) in faces.iter().zip(surface.iter().zip(layout)) {
            let x = scale(pair);
            if x.is_finite() && x > 0.0 {
                for v in face {
                    mean[*v as usize].0 += (x / median).log(OCTAVE);
                    mean[*v as usize].1 += 1.0;
                }
            }
        }
        let level = |v: u32| mean[v as usize].0 / f64::max(mean[v as usize].1, 1.0);
        Tiles { size, level: faces.iter().map(|f| f.map(level)).collect() }
    }
}
