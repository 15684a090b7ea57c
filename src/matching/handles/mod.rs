//! Surfaces with handles: both in the flat or hyperbolic metric of the target, the homotopy class of the map given by bases of the
//! fundamental groups.
//!
//! A homotopy basis of each surface has the same relator, and the map brings letter to letter. Which bases correspond is not canonical:
//! from the two that are found, twists and turns of the handles are tried as long as they lower the energy of the harmonic map. A class
//! that pairs of loops name ([`super::class`]) is taken as it is.

use super::balance::{Freedom, Relaxed, relax, settle};
use super::canonical::canonical_metric;
use super::class::{Class, Looped, class_of};
use super::cover::{Cover, Placed, logarithm, moved, on_axis, seen_from};
use super::generators::Generators;
use super::options::{Boundary, MatchOptions};
use super::orbifold::Pair;
use super::route::Marks;
use super::walk::Seed;
use super::weights::mean_value_weights;
use crate::control::Control;
use crate::embed::{UnrollOptions, unroll};
use crate::error::{Error, Result};
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::{HalfedgeId, Mesh, PerHalfedge, PerVertex, VertexId};
use crate::metric::Surface;
use crate::parallel::join;
use crate::topology::{CutGraph, FundamentalDomain, HomotopyBasis, crossed_halfedges, homotopy_basis};
use std::sync::Arc;

/// Most maps whose energies are compared.
const MOST_TRIED: usize = 60;
/// Share of the energy by which a move has to lower it.
const LOWER: f64 = 1e-3;
/// Energy of the source in the target's domain over that of the target itself, below which no other class is looked for.
const UNTWISTED: f64 = 1.05;

/// A surface in its own metric, opened along the cut of its homotopy basis.
struct Own {
    basis: HomotopyBasis,
    placed: Placed,
    domain: FundamentalDomain,
    weights: PerHalfedge<f64>,
    /// The generators of its deck group, with the lines of its boundary, in its own order.
    generators: Generators,
    iterations: usize,
}

/// Energy of another class over the least, up to which the map of it may be the better one for landmarks.
const SIMILAR: f64 = 1.5;

/// Both surfaces in the target's metric, and, where `more` marks are to be brought to their partners, the source in other classes of about
/// the same energy.
///
/// # Errors
/// [`Error::Matching`] for landmarks other than one on a torus, where a flow does not come to its target, and where no harmonic map is
/// found; those of [`homotopy_basis`], [`canonical_metric`] and [`unroll`]; [`Error::Cancelled`].
pub(super) fn with_handles(
    surfaces: [&Surface; 2],
    (marks, more): ([&Marks; 2], bool),
    options: &MatchOptions,
    control: &Control,
) -> Result<(Pair, Vec<Placed>)> {
    let flat = surfaces[0].mesh().euler() == 0;
    let landmarks = marks[0].landmarks.len();
    if landmarks > usize::from(flat) || !marks[0].corners.is_empty() {
        return Err(Error::Matching(format!(
            "{landmarks} landmarks inside and {} on the boundary: on surfaces with handles only one, on a torus, is possible",
            marks[0].corners.len()
        )));
    }
    let space = if flat { Space::E2 } else { Space::H2 };
    let own =
        |s: usize| in_own_metric(surfaces[s], marks[s].landmarks.first().copied(), space, options, control);
    let (source, target) = join(|| own(0), || own(1));
    let (source, target) = (source?, target?);
    let order = loop_order(surfaces, marks, [&source, &target]);
    let named = named(surfaces, [&source, &target], (&options.basis, &order))?;
    let is_named = named.is_some();
    let generators = named.unwrap_or_else(|| target.generators.clone().reordered(&order));
    let search = Search { surfaces, source: &source, target: &target, boundary: options.boundary };
    let freedom = [0, 1].map(|s| search.freedom(s, space));
    let mut domain = target.placed.clone();
    search.straighten(&mut domain)?;
    let second = relax(&mut domain, &target.weights, &freedom[1], control)?;
    // Of a class that is named no other one has less energy to offer.
    let enough = if is_named { f64::INFINITY } else { UNTWISTED * second.1 };
    let Least { mut image, relaxed: first, generators, mut tried } =
        search.least(generators, (&freedom[0], enough), control)?;
    let mut others = Vec::new();
    for next in generators.symmetric().into_iter().filter(|_| more && !is_named) {
        tried += 1;
        match search.image(&next, &freedom[0], control) {
            Ok((other, (_, energy))) if energy < SIMILAR * first.1 => others.push(other),
            Err(Error::Cancelled) => return Err(Error::Cancelled),
            _ => {}
        }
    }
    let (first, second) = join(
        || settle(&mut image, &source.weights, &freedom[0], first, control),
        || settle(&mut domain, &target.weights, &freedom[1], second, control),
    );
    let reports = [first?, second?];
    let seed =
        |from: &Own, to: &Own| Seed { vertex: from.basis.base, near: to.placed.cover.own(to.basis.base) };
    let seeds = [seed(&source, &target), seed(&target, &source)];
    let flow_iterations = [source.iterations, target.iterations];
    Ok((Pair { source: image, target: domain, seeds, reports, flow_iterations, markings: tried }, others))
}

fn in_own_metric(
    surface: &Surface,
    base: Option<VertexId>,
    space: Space,
    options: &MatchOptions,
    control: &Control,
) -> Result<Own> {
    let mesh = surface.mesh();
    let basis = homotopy_basis(mesh, surface.lengths(), base, control)?;
    let cut = CutGraph::around(mesh, basis.cut(mesh));
    let domain = FundamentalDomain::new(mesh, &cut.is_cut, &basis)?;
    let curvature = PerVertex::filled(mesh.n_vertices(), 0.0);
    let (metric, iterations) = canonical_metric(surface, space, curvature, &options.flow, control)?;
    let unrolling = UnrollOptions {
        cones: Some(Vec::new()),
        root: Some(basis.base),
        cut: Some(cut.clone()),
        threads: options.flow.threads,
        ..UnrollOptions::default()
    };
    let layout = unroll(&metric, &unrolling, control)?;
    let pairings: Vec<_> = layout.seams.iter().map(|seam| seam.pairing).collect();
    let cover = Cover::along_cut(mesh, space, (&cut, &pairings), &[domain.base_corner])?;
    let mut placed = Placed::of_layout(cover, &layout)?;
    let mut generators = generators(&basis, &domain, &placed, mesh)?;
    if let Some(closed) = generators.clone().closed() {
        placed.cover = cover_by_words(mesh, (&basis, &domain), &closed)?;
        generators = closed;
    }
    lay_lines(&mut generators, &basis, &placed, mesh)?;
    let weights = mean_value_weights(&placed, surface);
    Ok(Own { basis, placed, domain, weights, generators, iterations })
}

/// The cover of a surface that is opened along the cut of its homotopy basis, letters going to these motions.
fn cover_by_words(
    mesh: &Arc<Mesh>,
    (basis, domain): (&HomotopyBasis, &FundamentalDomain),
    generators: &Generators,
) -> Result<Cover> {
    let mut words: Vec<Option<Motion<DoubleDouble>>> = vec![None; mesh.n_halfedges()];
    for h in mesh.halfedges().filter(|&h| !mesh.is_outside(h)) {
        let word = basis.transition(mesh, h);
        if !word.is_empty() {
            words[h.index()] = Some(generators.motion(&word)?);
        }
    }
    Cover::new(mesh, generators.space, |h| words[h.index()], &[domain.base_corner])
}

/// A surface's own generators as motions, without lines.
fn generators(
    basis: &HomotopyBasis,
    domain: &FundamentalDomain,
    placed: &Placed,
    mesh: &Mesh,
) -> Result<Generators> {
    let cover = &placed.cover;
    let motion = |path: &Vec<HalfedgeId>| {
        let crossed = crossed_halfedges(mesh, domain.base_corner, path)?;
        let through = crossed.into_iter().filter_map(|h| cover.across(h));
        Ok(through.fold(Motion::identity(cover.space), |all, step| all.compose(step)).normalised())
    };
    let motions: Vec<Motion<DoubleDouble>> = basis.loops.iter().map(motion).collect::<Result<_>>()?;
    Ok(Generators { space: cover.space, genus: basis.group.genus, motions, lines: Vec::new() })
}

/// The lines of the boundary: the axes of its generators.
fn lay_lines(generators: &mut Generators, basis: &HomotopyBasis, placed: &Placed, mesh: &Mesh) -> Result<()> {
    for (j, &rim) in basis.rims.iter().enumerate() {
        let start = mesh.tip(rim);
        let tree = generators.motion(&basis.corner_word(placed.cover.own(start)))?.inverse();
        let along = &generators.motions[2 * generators.genus + j];
        let line = on_axis(along, &tree.compose(&placed.at[start]));
        generators.lines.push(line);
    }
    Ok(())
}

/// For each letter of the source's boundary the number of the target's letter whose loop it goes to.
fn loop_order(surfaces: [&Surface; 2], marks: [&Marks; 2], own: [&Own; 2]) -> Vec<usize> {
    let of = |s: usize, rim: &HalfedgeId| {
        let v = surfaces[s].mesh().tip(*rim);
        marks[s].loops.iter().position(|around| around.iter().any(|&h| surfaces[s].mesh().origin(h) == v))
    };
    let second: Vec<_> = own[1].basis.rims.iter().map(|rim| of(1, rim)).collect();
    own[0].basis.rims.iter().filter_map(|rim| second.iter().position(|k| *k == of(0, rim))).collect()
}

/// The images of the source's letters in the class that pairs of loops name; `None` without loops.
///
/// # Errors
/// [`Error::Matching`] for boundary loops that go elsewhere by the loops than by their order; those of [`class_of`].
fn named(
    surfaces: [&Surface; 2],
    own: [&Own; 2],
    (pairs, order): (&[[Vec<HalfedgeId>; 2]], &[usize]),
) -> Result<Option<Generators>> {
    if pairs.is_empty() {
        return Ok(None);
    }
    let looped = |s: usize| Looped {
        mesh: surfaces[s].mesh(),
        basis: &own[s].basis,
        generators: &own[s].generators,
        at_base: own[s].placed.at[own[s].basis.base],
        loops: pairs.iter().map(|pair| &pair[s][..]).collect(),
    };
    let Class { handles, rims } = class_of([&looped(0), &looped(1)])?;
    let target = &own[1].generators;
    let mut motions = handles.iter().map(|word| target.motion(word)).collect::<Result<Vec<_>>>()?;
    let mut lines = Vec::with_capacity(rims.len());
    for (j, (k, by)) in rims.iter().enumerate() {
        if order[j] != *k {
            return Err(other_loop(surfaces, own, (j, *k)));
        }
        let by = target.motion(by)?;
        motions.push(target.motions[2 * target.genus + k].conjugated_by(&by).normalised());
        lines.push(by.compose(&target.lines[*k]).normalised());
    }
    Ok(Some(Generators { motions, lines, ..target.clone() }))
}

/// That the loops of the basis bring the boundary of the source's letter j to that of the target's letter k.
fn other_loop(surfaces: [&Surface; 2], own: [&Own; 2], (j, k): (usize, usize)) -> Error {
    let number = |s: usize, letter: usize| {
        let (mesh, rim) = (surfaces[s].mesh(), own[s].basis.rims[letter]);
        let runs = |around: &Vec<HalfedgeId>| around.contains(&rim.twin());
        mesh.boundary_loops().iter().position(runs).unwrap_or_default()
    };
    Error::Matching(format!(
        "the loops of the basis bring boundary loop {} of the source to boundary loop {} of the target, which is not the one that was asked for or, \
         by default, the one of the same rank by length",
        number(0, j),
        number(1, k)
    ))
}

/// A class of low energy.
struct Least {
    image: Placed,
    relaxed: Relaxed,
    generators: Generators,
    tried: usize,
}

struct Search<'a> {
    surfaces: [&'a Surface; 2],
    source: &'a Own,
    target: &'a Own,
    boundary: Boundary,
}

impl Search<'_> {
    fn own(&self, s: usize) -> &Own {
        if s == 0 { self.source } else { self.target }
    }

    fn freedom(&self, s: usize, space: Space) -> PerVertex<Freedom> {
        let mut freedom = Freedom::of(self.surfaces[s].mesh(), self.boundary);
        // A flat torus can be shifted: the base is held.
        if space == Space::E2 {
            freedom[self.own(s).basis.base] = Freedom::Held;
        }
        freedom
    }

    /// The boundary loops of a surface as they are run through from the tips of their rims, each vertex with where it lies along its line:
    /// in the surface's own metric, or by the share of the length.
    fn loops(&self, s: usize) -> Result<Vec<Vec<(VertexId, f64)>>> {
        let (mesh, Own { basis, placed, .. }, own) =
            (self.surfaces[s].mesh(), self.own(s), &self.own(s).generators);
        let mut all = Vec::with_capacity(basis.rims.len());
        for (rim, line) in basis.rims.iter().zip(&own.lines) {
            let mut path = mesh.boundary_from(*rim);
            if !path.is_empty() {
                path.rotate_left(1);
            }
            let lengths = self.surfaces[s].lengths();
            let total: f64 = path.iter().map(|h| lengths[h.edge()]).sum();
            let (around, mut before) = (own.motions[2 * own.genus + all.len()].translation_length(), 0.0);
            let along = |h: HalfedgeId| {
                let v = mesh.origin(h);
                let share = before / total;
                before += lengths[h.edge()];
                if self.boundary == Boundary::ArcLength {
                    return Ok((v, share * around));
                }
                let line = own.motion(&basis.corner_word(placed.cover.own(v)))?.compose(line);
                let [x, _] = logarithm(own.space, seen_from(&line, &placed.at[v]));
                Ok((v, x))
            };
            all.push(path.into_iter().map(along).collect::<Result<_>>()?);
        }
        Ok(all)
    }

    /// Puts the target's boundary exactly on its lines, with frames along them.
    fn straighten(&self, placed: &mut Placed) -> Result<()> {
        let (basis, own) = (&self.target.basis, &self.target.generators);
        for (line, around) in own.lines.iter().zip(self.loops(1)?) {
            for (v, x) in around {
                let corner = own.motion(&basis.corner_word(placed.cover.own(v)))?;
                placed.at[v] = moved(&corner.compose(line), [x, 0.0]);
            }
        }
        Ok(())
    }

    /// The source in the target's domain in the class of these generators, at the minimum of its energy.
    fn image(
        &self,
        generators: &Generators,
        freedom: &PerVertex<Freedom>,
        control: &Control,
    ) -> Result<(Placed, Relaxed)> {
        let (mesh, basis, space) = (self.surfaces[0].mesh(), &self.source.basis, generators.space);
        let cover = cover_by_words(mesh, (basis, &self.source.domain), generators)?;
        // Positions of the source's own metric, its base where the target's is: a place to start from.
        let home = self.target.placed.at[self.target.basis.base]
            .compose(&self.source.placed.at[basis.base].inverse());
        let at = PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| {
            home.compose(&self.source.placed.at[v]).normalised()
        });
        let mut placed = Placed { cover, at };
        for (j, around) in self.loops(0)?.into_iter().enumerate() {
            let length = |all: &Generators| all.motions[2 * all.genus + j].translation_length();
            let longer = length(generators) / length(&self.source.generators).max(f64::MIN_POSITIVE);
            for (v, x) in around {
                let corner = generators.motion(&basis.corner_word(placed.cover.own(v)))?;
                placed.at[v] = moved(&corner.compose(&generators.lines[j]), [longer * x, 0.0]);
            }
        }
        if space == Space::E2 {
            placed.at[basis.base] = self.target.placed.at[self.target.basis.base];
        }
        let energy = relax(&mut placed, &self.source.weights, freedom, control)?;
        Ok((placed, energy))
    }

    /// From class to class as long as the energy falls and is not small enough; the map, and the number of classes that were tried.
    fn least(
        &self,
        mut generators: Generators,
        (freedom, enough): (&PerVertex<Freedom>, f64),
        control: &Control,
    ) -> Result<Least> {
        let (mut best, mut energy) = self.image(&generators, freedom, control)?;
        let mut tried = 1;
        'search: while energy.1 > enough {
            for by in generators.moves() {
                if tried >= MOST_TRIED {
                    break 'search;
                }
                let next = generators.moved(by);
                tried += 1;
                let (image, after) = match self.image(&next, freedom, control) {
                    Ok(image) => image,
                    Err(Error::Cancelled) => return Err(Error::Cancelled),
                    // Of this class there is nothing to compare.
                    Err(_) => continue,
                };
                log::debug!("{by:?}: energy {} after {}", after.1, energy.1);
                if after.1 < (1.0 - LOWER) * energy.1 {
                    (best, energy, generators) = (image, after, next);
                    continue 'search;
                }
            }
            break;
        }
        Ok(Least { image: best, relaxed: energy, generators, tried })
    }
}
