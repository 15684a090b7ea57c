//! The choice of the vertex of a closed surface at which all its curvature distorts areas least.

use crate::control::Control;
use crate::error::Result;
use crate::harmonic::{Domain, Laplace};
use crate::mesh::{PerVertex, VertexId};
use crate::metric::Surface;
use crate::metric::curvature::curvature;
use crate::parallel::Pool;
use crate::topology::farthest_vertices;
use std::f64::consts::TAU;

/// Number of vertices, far from each other, that are tried first.
const FIRST: usize = 48;
/// Most steps to neighbours after that.
const STEPS: usize = 32;

/// The inner vertex of a surface that distorts areas least, by the linearised flow, if it gets the whole curvature 2πχ and boundaries
/// become straight.
///
/// To first order, the conformal factor of the flow solves `L u = K̄ − K` with the cotangent Laplacian of the surface. Its area-weighted
/// variance measures the distortion: it is 0 if all areas change alike. One factorisation serves all vertices. The search takes the best of
/// 48 vertices far from each other, and goes on to its best neighbour as long as that is better.
///
/// # Errors
/// Those of [`Laplace::new`] and [`farthest_vertices`].
pub fn least_distorting_vertex(domain: &Domain, control: &Control) -> Result<VertexId> {
    let mesh = domain.mesh();
    let laplace = Laplace::new(domain, |_| false, control)?;
    let given = domain.metric().surface();
    let own = curvature(given.mesh(), given.geometry(), given.lengths())?.at;
    let total = TAU * mesh.euler() as f64;
    let areas = domain.vertex_areas();
    let area: f64 = areas.iter().sum();
    let variances = |tried: &[VertexId]| -> Result<Vec<f64>> {
        control.check()?;
        let mut columns: Vec<f64> = Vec::with_capacity(tried.len() * mesh.n_vertices());
        for &v in tried {
            let first = columns.len();
            columns.extend(own.iter().map(|k| -k));
            columns[first + v.index()] += total;
        }
        laplace.solve(&mut columns)?;
        let variance = |u: &[f64]| {
            let mean = u.iter().zip(areas).map(|(u, a)| a * u).sum::<f64>() / area;
            u.iter().zip(areas).map(|(u, a)| a * (u - mean) * (u - mean)).sum::<f64>() / area
        };
        Ok(columns.chunks(mesh.n_vertices()).map(variance).collect())
    };
    let n = FIRST.min(mesh.n_vertices());
    let mut tried = farthest_vertices(mesh, domain.lengths(), VertexId(0), n, control)?;
    let mut seen = PerVertex::filled(mesh.n_vertices(), false);
    let (mut best, mut least) = (VertexId(0), f64::INFINITY);
    for _ in 0..STEPS {
        tried.retain(|&v| !mesh.is_boundary_vertex(v) && !std::mem::replace(&mut seen[v], true));
        let before = least;
        for (&v, variance) in tried.iter().zip(variances(&tried)?) {
            if variance < least {
                (best, least) = (v, variance);
            }
        }
        if least >= before {
            break;
        }
        tried = mesh.outgoing(best).map(|h| mesh.tip(h)).collect();
    }
    Ok(best)
}

/// The given singular vertex, or the least distorting one.
pub(crate) fn singular_vertex(
    surface: &Surface,
    given: Option<VertexId>,
    threads: usize,
    control: &Control,
) -> Result<VertexId> {
    if let Some(v) = given {
        return Ok(v);
    }
    let domain = Domain::new(surface, control)?;
    Pool::new(threads)?.run(|| least_distorting_vertex(&domain, control))
}
