//! The options of [`super::flatten()`]: which energy is least, and where the descent ends.

use super::energy::EnergyShares;
use crate::error::{Error, Result};
use crate::mesh::{Mesh, VertexId};

/// Default of [`FlattenOptions::tolerance`]. The step after it is the last, so that the map is then exact to its square.
pub const TOLERANCE: f64 = 1e-8;
/// Default of [`FlattenOptions::max_iterations`]: three times the steps of the slowest surface that was measured.
pub const MAX_ITERATIONS: usize = 2000;
/// Default of [`FlattenOptions::conformal`] for [`DistortionEnergy::Area`], which has no minimum without it.
pub const AREA_CONFORMAL: f64 = 0.1;

/// Default of [`FlattenOptions::rings`].
pub const RINGS: usize = 2;
/// The share of the symmetric Dirichlet energy in [`DistortionEnergy::Distance`].
pub const DISTANCE_ISOMETRIC: f64 = 0.01;

/// What a flat map is to keep. σ and τ are the singular values of the map of a triangle, the stretches along two directions that are
/// perpendicular before and after; energies are means weighed with the areas of the surface's triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DistortionEnergy {
    /// Lengths: the symmetric Dirichlet energy `σ² + τ² + σ⁻² + τ⁻²`, 4 where lengths are kept \[SS15\].
    #[default]
    Isometric,
    /// Lengths, as rigid as possible: `(σ − 1)² + (τ − 1)²`, 0 where lengths are kept \[LZXGG08\]. It stays finite as a triangle loses its area, so that
    /// a descent can end where one is about to.
    Arap,
    /// Areas, as far as [`FlattenOptions::conformal`] lets them: `2 (στ + 1/(στ))`, 4 where areas are kept.
    Area,
    /// Distances: the mean of `(|p − q|/d − 1)²` over the pairs of vertices that at most [`FlattenOptions::rings`] edges separate, of the
    /// length d of the shortest path between them on the surface \[FSD99\]. [`DISTANCE_ISOMETRIC`] of the symmetric Dirichlet energy is added, which
    /// keeps triangles from losing their area.
    Distance,
}

impl DistortionEnergy {
    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            DistortionEnergy::Isometric => "isometric",
            DistortionEnergy::Arap => "arap",
            DistortionEnergy::Area => "area",
            DistortionEnergy::Distance => "distance",
        }
    }
}

/// The options of [`super::flatten()`].
#[derive(Debug, Clone, PartialEq)]
pub struct FlattenOptions {
    /// What the map is to keep. Default [`DistortionEnergy::Isometric`].
    pub energy: DistortionEnergy,
    /// The share c from 0 to 1 of the conformal energy `2 (σ/τ + τ/σ)`, 4 where angles are kept \[HG00\], in the energy that is least:
    /// (1 − c) times that of `energy` and c times this. With 1 the energy does not tell sizes apart; the map then has the area of the surface. Default: 0, and for [`DistortionEnergy::Area`],
    /// where it must be greater than 0, [`AREA_CONFORMAL`].
    pub conformal: Option<f64>,
    /// The Newton decrement at which the descent has converged: the square root of −g·d, of the slope g of the energy and the Newton step d,
    /// so about the square root of twice the energy that is still to be lost. Default [`TOLERANCE`].
    pub tolerance: f64,
    /// The most Newton steps; 0 leaves the map at the start. Default [`MAX_ITERATIONS`].
    pub max_iterations: usize,
    /// How many edges separate two vertices at most whose distance [`DistortionEnergy::Distance`] keeps. Default [`RINGS`].
    pub rings: usize,
    /// True if no part of the map is to lie on another one: sides of the border repel each other where they come near \[SS15\], no step lets
    /// them meet, and the start is a map that is one to one. Default false.
    pub injective: bool,
    /// Per face a factor above 0 of its part in the energy; empty: 1. Distances and contacts have none.
    pub weights: Vec<f64>,
    /// Vertices and their places in the plane, in units of the surface's lengths, each vertex once. They are there to the last bit.
    pub pins: Vec<(VertexId, [f64; 2])>,
    /// Runs of at least three vertices, such as parts of the border, each of which is to lie on one straight line.
    pub straight: Vec<Vec<VertexId>>,
    /// The number of threads, in a pool of the call's own unless the caller is in one ([`crate::parallel::within`]); default 0: one per core.
    /// The result does not depend on it.
    pub threads: usize,
}

impl Default for FlattenOptions {
    fn default() -> Self {
        FlattenOptions {
            energy: DistortionEnergy::default(),
            conformal: None,
            tolerance: TOLERANCE,
            max_iterations: MAX_ITERATIONS,
            rings: RINGS,
            injective: false,
            weights: Vec::new(),
            pins: Vec::new(),
            straight: Vec::new(),
            threads: 0,
        }
    }
}

impl FlattenOptions {
    /// The share of the conformal energy.
    pub fn conformal_share(&self) -> f64 {
        let usual = if self.energy == DistortionEnergy::Area { AREA_CONFORMAL } else { 0.0 };
        self.conformal.unwrap_or(usual)
    }

    /// The energy as shares of its parts.
    ///
    /// # Errors
    /// [`Error::Argument`] for a share outside its range and a tolerance that is not positive.
    pub(super) fn shares(&self) -> Result<EnergyShares> {
        let conformal = self.conformal_share();
        if !(0.0..=1.0).contains(&conformal) {
            return Err(Error::argument("conformal", conformal, "a share from 0 to 1"));
        }
        if self.energy == DistortionEnergy::Area && conformal == 0.0 {
            let need = "greater than 0 where areas are to be kept: maps that keep areas are too many for one to be least";
            return Err(Error::argument("conformal", conformal, need));
        }
        if !(self.tolerance > 0.0 && self.tolerance.is_finite()) {
            return Err(Error::argument("tolerance", self.tolerance, "a positive number"));
        }
        let shares = EnergyShares { conformal, ..EnergyShares::default() };
        let rest = 1.0 - conformal;
        Ok(match self.energy {
            DistortionEnergy::Isometric => EnergyShares { isometric: rest, ..shares },
            DistortionEnergy::Arap => EnergyShares { arap: rest, ..shares },
            DistortionEnergy::Area => EnergyShares { area: rest, ..shares },
            DistortionEnergy::Distance => EnergyShares { isometric: rest * DISTANCE_ISOMETRIC, ..shares },
        })
    }

    /// Refuses weights, pins and pieces that do not fit the mesh.
    ///
    /// # Errors
    /// [`Error::Argument`].
    pub(super) fn check_parts(&self, mesh: &Mesh) -> Result<()> {
        if !self.weights.is_empty() && self.weights.len() != mesh.n_faces() {
            return Err(Error::argument("number of weights", self.weights.len(), "one for each face"));
        }
        if let Some(weight) = self.weights.iter().find(|w| !(w.is_finite() && **w > 0.0)) {
            return Err(Error::argument("weights", weight, "positive numbers"));
        }
        if self.energy == DistortionEnergy::Distance && self.rings == 0 {
            return Err(Error::argument("rings", self.rings, "at least 1"));
        }
        check_distinct("pins", self.pins.iter().map(|pin| pin.0), mesh)?;
        if let Some((v, _)) = self.pins.iter().find(|(_, at)| !at.iter().all(|x| x.is_finite())) {
            return Err(Error::argument("place of pinned vertex", v, "two numbers"));
        }
        for piece in &self.straight {
            check_distinct("straight", piece.iter().copied(), mesh)?;
            if piece.len() < 3 {
                return Err(Error::argument("vertices of a straight piece", piece.len(), "at least 3"));
            }
        }
        Ok(())
    }
}

fn check_distinct(what: &'static str, vertices: impl Iterator<Item = VertexId>, mesh: &Mesh) -> Result<()> {
    let mut seen = vec![false; mesh.n_vertices()];
    for v in vertices {
        match seen.get_mut(v.index()) {
            None => {
                return Err(Error::argument(what, v, "vertices of the mesh"));
            }
            Some(true) => return Err(Error::argument(what, v, "each vertex once")),
            Some(is_named) => *is_named = true,
        }
    }
    Ok(())
}
