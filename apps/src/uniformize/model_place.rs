//! The coordinates of points of the plane, or of the hyperbolic plane in one of its models.

use ricci::geometry::Space;
use ricci::geometry::model::{Model, between, distance};

/// Straight pieces per unit of hyperbolic length by which a geodesic is drawn.
const STEPS_PER_LENGTH: f64 = 14.0;
/// Most straight pieces by which one geodesic is drawn.
const MOST_STEPS: f64 = 96.0;

/// The model of the space in which points are written or drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ModelPlace {
    Plane,
    Hyperbolic(Model),
}

impl ModelPlace {
    pub fn new(space: Space, model: Model) -> ModelPlace {
        if space == Space::H2 { ModelPlace::Hyperbolic(model) } else { ModelPlace::Plane }
    }

    /// The name of the model.
    pub fn name(self) -> &'static str {
        match self {
            ModelPlace::Plane => "plane",
            ModelPlace::Hyperbolic(model) => model.name(),
        }
    }

    /// Coordinates of a point given in ambient coordinates, the third 0 but on the hyperboloid.
    pub fn coordinates(self, p: [f64; 3]) -> [f64; 3] {
        match self {
            ModelPlace::Plane => [p[0], p[1], 0.0],
            ModelPlace::Hyperbolic(model) => model.from_hyperboloid(p),
        }
    }

    /// Plane coordinates.
    pub fn flat(self, p: [f64; 3]) -> [f64; 2] {
        match self {
            ModelPlace::Plane => [p[0], p[1]],
            ModelPlace::Hyperbolic(model) => model.plane(p),
        }
    }

    /// The coordinates of a point, as many as the model has.
    pub fn numbers(self, p: [f64; 3]) -> Vec<f64> {
        let n = if self == ModelPlace::Hyperbolic(Model::Hyperboloid) { 3 } else { 2 };
        self.coordinates(p)[..n].to_vec()
    }

    /// The geodesic from p to q as a polygon of ambient points, both ends included.
    pub fn geodesic(self, p: [f64; 3], q: [f64; 3]) -> Vec<[f64; 3]> {
        if self == ModelPlace::Plane || self == ModelPlace::Hyperbolic(Model::Klein) {
            return vec![p, q];
        }
        let steps = (STEPS_PER_LENGTH * distance(p, q)).clamp(1.0, MOST_STEPS).ceil() as usize;
        (0..=steps).map(|k| between(p, q, k as f64 / steps as f64)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn geodesics_run_evenly_between_their_ends() {
        let at = |r: f64, t: f64| [r.sinh() * t.cos(), r.sinh() * t.sin(), r.cosh()];
        let (p, q) = (at(2.0, 0.3), at(1.4, 2.5));
        let place = ModelPlace::Hyperbolic(Model::Poincare);
        let points = place.geodesic(p, q);
        let length: f64 = points.windows(2).map(|w| distance(w[0], w[1])).sum();
        assert!((length - distance(p, q)).abs() < 1e-12);
        let steps: Vec<f64> = points.windows(2).map(|w| distance(w[0], w[1])).collect();
        assert!(steps.iter().all(|step| (step - steps[0]).abs() < 1e-12));
    }
}
