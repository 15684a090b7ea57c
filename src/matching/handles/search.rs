//! The search for a homotopy class of low energy among maps between surfaces with handles.

use super::generators::Generators;
use super::handle_surface::{HandleSurface, cover_by_words};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::Space;
use crate::matching::balance::{EnergyMinimum, Springs, VertexFreedom, relax};
use crate::matching::cover::{PlacedMesh, logarithm, moved, seen_from};
use crate::matching::options::BoundaryMatching;
use crate::mesh::{HalfedgeId, PerVertex, VertexId};
use crate::metric::Surface;

/// Most maps whose energies are compared.
const MOST_TRIED: usize = 60;
/// Share of the energy by which a move has to lower it.
const LOWER: f64 = 1e-3;

/// The map of a class of low energy.
pub(super) struct LeastMap {
    pub image: PlacedMesh,
    pub relaxed: EnergyMinimum,
    /// The images of the source's letters.
    pub generators: Generators,
    /// Number of classes that were tried.
    pub tried: usize,
}

/// The surfaces between which classes are compared, source and target.
pub(super) struct ClassSearch<'a> {
    pub surfaces: [&'a Surface; 2],
    pub own: [&'a HandleSurface; 2],
    pub boundary: BoundaryMatching,
}

impl ClassSearch<'_> {
    /// The freedom of a surface's vertices. A flat torus can be shifted: there the base is held.
    pub fn freedom(&self, s: usize, space: Space) -> PerVertex<VertexFreedom> {
        let mut freedom = VertexFreedom::of(self.surfaces[s].mesh(), self.boundary);
        if space == Space::E2 {
            freedom[self.own[s].basis.base] = VertexFreedom::Held;
        }
        freedom
    }

    /// The boundary loops of a surface, from the tips of their rims on: each vertex with its distance along the line of its loop, in the
    /// surface's own metric or by the share of the length.
    fn loops(&self, s: usize) -> Result<Vec<Vec<(VertexId, f64)>>> {
        let (mesh, HandleSurface { basis, own, generators, .. }) = (self.surfaces[s].mesh(), self.own[s]);
        let mut all = Vec::with_capacity(basis.rims.len());
        for (rim, line) in basis.rims.iter().zip(&generators.lines) {
            let mut path = mesh.boundary_from(*rim);
            if !path.is_empty() {
                path.rotate_left(1);
            }
            let lengths = self.surfaces[s].lengths();
            let total: f64 = path.iter().map(|h| lengths[h.edge()]).sum();
            let around = generators.motions[2 * generators.genus + all.len()].translation_length();
            let mut before = 0.0;
            let along = |h: HalfedgeId| {
                let v = mesh.origin(h);
                let share = before / total;
                before += lengths[h.edge()];
                if self.boundary == BoundaryMatching::ArcLength {
                    return Ok((v, share * around));
                }
                let word = basis.corner_word(own.placed.cover.own(v));
                let line = generators.motion(&word)?.compose(line);
                let [x, _] = logarithm(generators.space, seen_from(&line, &own.placed.at[v]));
                Ok((v, x))
            };
            all.push(path.into_iter().map(along).collect::<Result<_>>()?);
        }
        Ok(all)
    }

    /// Puts the target's boundary exactly on its lines, with frames along them.
    pub fn straighten(&self, placed: &mut PlacedMesh) -> Result<()> {
        let (basis, generators) = (&self.own[1].basis, &self.own[1].generators);
        for (line, around) in generators.lines.iter().zip(self.loops(1)?) {
            for (v, x) in around {
                let corner = generators.motion(&basis.corner_word(placed.cover.own(v)))?;
                placed.at[v] = moved(&corner.compose(line), [x, 0.0]);
            }
        }
        Ok(())
    }

    /// The source in the target's domain at the minimum of its energy, in the class in which its letters go to these generators.
    pub fn image(
        &self,
        generators: &Generators,
        springs: Springs,
        control: &Control,
    ) -> Result<(PlacedMesh, EnergyMinimum)> {
        let [source, target] = self.own;
        let (mesh, basis, space) = (self.surfaces[0].mesh(), &source.basis, generators.space);
        let cover = cover_by_words(mesh, basis, &source.domain, generators)?;
        // The start is the source as it lies in its own metric, its base where the target's is.
        let (own, domain) = (&source.own.placed, &target.own.placed);
        let home = domain.at[target.basis.base].compose(&own.at[basis.base].inverse());
        let at = PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| home.compose(&own.at[v]).normalised());
        let mut placed = PlacedMesh { cover, at };
        for (j, around) in self.loops(0)?.into_iter().enumerate() {
            let length = |all: &Generators| all.motions[2 * all.genus + j].translation_length();
            let longer = length(generators) / length(&source.generators).max(f64::MIN_POSITIVE);
            for (v, x) in around {
                let corner = generators.motion(&basis.corner_word(placed.cover.own(v)))?;
                placed.at[v] = moved(&corner.compose(&generators.lines[j]), [longer * x, 0.0]);
            }
        }
        if space == Space::E2 {
            placed.at[basis.base] = domain.at[target.basis.base];
        }
        let relaxed = relax(&mut placed, springs, control)?;
        Ok((placed, relaxed))
    }

    /// The map after moves from class to class, each of which lowers the energy, until it is no more than `enough` or no move lowers it.
    pub fn least(
        &self,
        mut generators: Generators,
        springs: Springs,
        enough: f64,
        control: &Control,
    ) -> Result<LeastMap> {
        let (mut best, mut relaxed) = self.image(&generators, springs, control)?;
        let mut tried = 1;
        'search: while relaxed.energy > enough {
            for by in generators.moves() {
                if tried >= MOST_TRIED {
                    break 'search;
                }
                let next = generators.moved(by);
                tried += 1;
                let (image, after) = match self.image(&next, springs, control) {
                    Ok(image) => image,
                    Err(Error::Cancelled) => return Err(Error::Cancelled),
                    // Without a map the class cannot be compared.
                    Err(_) => continue,
                };
                log::debug!("{by:?}: energy {} after {}", after.energy, relaxed.energy);
                if after.energy < (1.0 - LOWER) * relaxed.energy {
                    (best, relaxed, generators) = (image, after, next);
                    continue 'search;
                }
            }
            break;
        }
        Ok(LeastMap { image: best, relaxed, generators, tried })
    }
}
