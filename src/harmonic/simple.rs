//! Intrinsic Delaunay triangulations whose harmonic maps to the plane do not collapse, by vertices added on edges.
//!
//! On an intrinsic Delaunay triangulation two edges may join the same vertices, around the tip of a spike. A map that is linear on edges
//! maps both to one segment and so, by the maximum principle, everything between them. In the same way the part of a disk that an interior
//! edge cuts off collapses if both ends of the edge are mapped to one side of a polygon. Vertices are added on such edges.
//!
//! ```
//! use ricci::harmonic::{planar, simple_domain};
//! use ricci::{Control, Surface, mesh::shapes};
//! let disk = Surface::from_soup(&shapes::disk(3)?)?;
//! let (split, domain) = simple_domain(&disk, true, &Control::new())?;
//! assert_eq!(split.n_added(), 0);
//! assert!(planar::flipped(&domain, &planar::to_disk(&domain, &Control::new())?.points).is_empty());
//! # Ok::<(), ricci::Error>(())
//! ```

use super::domain::Domain;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::{EdgeId, HalfedgeId, Mesh};
use crate::metric::{Split, Surface};
use std::collections::{BTreeMap, BTreeSet};

/// Most rounds of added vertices: each round adds a vertex near the middle of every unwanted edge, which leaves edges of half the length.
const ROUNDS: usize = 24;
/// Least share of an edge that an added vertex cuts off; the vertex need not lie exactly on the unwanted edge.
const LEAST_PART: f64 = 0.1;

/// The surface on an intrinsic Delaunay triangulation without loops and without edges that have the same two ends, and the vertices that
/// had to be added for that on interior edges; none on most surfaces. With `apart`, no interior edge joins two boundary vertices either.
///
/// # Errors
/// Those of [`Domain::new`] and [`Domain::common_subdivision`]; [`Error::Layout`] if such edges are left after 24 rounds of added vertices.
pub fn simple_domain(surface: &Surface, apart: bool, control: &Control) -> Result<(Split, Domain)> {
    let mut split = Split::new(surface);
    for _ in 0..ROUNDS {
        let given = split.surface()?;
        let domain = Domain::new(&given, control)?;
        let edges = edges_to_part(domain.mesh(), apart);
        if edges.is_empty() {
            return Ok((split, domain));
        }
        part(&mut split, given.mesh(), places(&domain, &edges, control)?)?;
    }
    let what = if apart { ", or join boundary vertices through the inside," } else { "" };
    Err(Error::Layout(format!(
        "edges of the intrinsic Delaunay triangulation still have the same two ends{what} after {ROUNDS} rounds of added \
         vertices; remesh the surface, or refine its metric (`ricci refine --intrinsic`)"
    )))
}

/// The unwanted edges of a triangulation.
fn edges_to_part(mesh: &Mesh, apart: bool) -> BTreeSet<EdgeId> {
    let mut ends: Vec<_> =
        mesh.edges().map(|e| (mesh.ends(e), e)).map(|([i, j], e)| (i.min(j), i.max(j), e)).collect();
    ends.sort_unstable();
    let same = ends.windows(2).filter(|pair| (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1));
    let mut found: BTreeSet<EdgeId> = same.flat_map(|pair| [pair[0].2, pair[1].2]).collect();
    let joins = |i, j| apart && mesh.is_boundary_vertex(i) && mesh.is_boundary_vertex(j);
    found.extend(ends.iter().filter(|&&(i, j, _)| i == j || joins(i, j)).map(|&(_, _, e)| e));
    found.retain(|&e| !mesh.is_boundary_edge(e));
    found
}

/// Places near the middles of these Delaunay edges: edges of the given triangulation with shares of their length.
fn places(domain: &Domain, edges: &BTreeSet<EdgeId>, control: &Control) -> Result<Vec<(EdgeId, f64)>> {
    let Some(subdivision) = domain.common_subdivision(control)? else {
        return Ok(edges.iter().map(|&e| (e, 0.5)).collect());
    };
    let mut nearest: BTreeMap<EdgeId, (f64, EdgeId, f64)> = BTreeMap::new();
    let middles = subdivision
        .crossings
        .iter()
        .map(|c| (c[1].edge, ((c[1].weights[0] - 0.5).abs(), c[0].edge, c[0].weights[1])));
    // A Delaunay edge that is an edge of the given triangulation has no crossings.
    let given = subdivision.halfedges_along.iter().filter_map(|&[given, here]| {
        let [given, here] = [given?, here?].map(HalfedgeId::edge);
        Some((here, (0.5, given, 0.5)))
    });
    for (e, place) in middles.chain(given).filter(|(e, _)| edges.contains(e)) {
        let best = nearest.entry(e).or_insert(place);
        if place.0 < best.0 {
            *best = place;
        }
    }
    Ok(nearest.into_values().map(|(_, e, share)| (e, share)).collect())
}

/// Divides interior edges at these shares.
fn part(split: &mut Split, given: &Mesh, mut places: Vec<(EdgeId, f64)>) -> Result<()> {
    places.retain(|&(e, _)| !given.is_boundary_edge(e));
    // The first part of a divided edge keeps its number, so the farthest place comes first.
    places.sort_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
    let mut before = None;
    for (e, share) in places {
        let length = match before {
            Some((same, left)) if same == e => left,
            _ => 1.0,
        };
        let share = (share / length).clamp(LEAST_PART, 1.0 - LEAST_PART);
        split.part(e, share)?;
        before = Some((e, share * length));
    }
    Ok(())
}
