//! The start of a seamless metric: the right angles of its sectors, and a metric near the one with these angles.

use super::aligned_field::CrossField;
use super::corner_choice::{check_totals, simplified};
use super::cross_field::field_cones;
use super::holonomy_state::HolonomyState;
use super::options::{SeamlessCones, SeamlessOptions};
use super::sectors::Sectors;
use super::signature::{ConeValence, MOST_CURVED, given_right_angles};
use crate::control::Control;
use crate::error::{Error, Result, check_size};
use crate::flow::{Flow, Options, Solution, auto_cones};
use crate::geometry::Space;
use crate::mesh::{EdgeId, Mesh, PerEdge, PerVertex, VertexId};
use crate::metric::{Class, Surface, Target};
use std::f64::consts::FRAC_PI_2;

/// Most iterations of a flow beside features, which is only a start.
const FLOW_ITERATIONS: usize = 20;
/// The least and the most curvature of corners of patches, in quarter turns.
const OF_PATCHES: [i32; 2] = [-2, 1];

/// The sectors between features and the boundary, and the right angles of each. Features around a piece that is too small to have right
/// angles in all its corners are left out.
pub(super) fn chosen_right_angles(
    surface: &Surface,
    features: &[EdgeId],
    options: &SeamlessOptions,
    control: &Control,
) -> Result<(Sectors, Vec<i32>)> {
    let mesh = surface.mesh();
    let mut sectors = Sectors::new(mesh, features)?;
    let of_curvature = |curvature: PerVertex<i32>| curvature.iter().map(|k| 4 - k).collect::<Vec<_>>();
    let right_angles = match &options.cones {
        SeamlessCones::Field if sectors.are_vertices() && options.guides.is_empty() => {
            of_curvature(field_cones(surface, control)?)
        }
        SeamlessCones::Field => loop {
            let field = CrossField::along(surface, &sectors, &options.guides, control)?;
            match simplified(mesh, &sectors, field.right_angles(mesh, &sectors)) {
                Ok(right_angles) => break right_angles,
                Err(sector) => sectors = without_piece(mesh, &sectors, sector)?,
            }
        },
        SeamlessCones::Auto(n) => {
            if !sectors.are_vertices() {
                let need = "those of the field or given ones, on a surface with boundary or features";
                return Err(Error::argument("cones", "placed ones", need));
            }
            let placed = auto_cones(mesh, surface.lengths(), *n, control)?;
            let quarters = rounded_to_quarters(mesh, &placed.cones, [i32::MIN, MOST_CURVED]);
            let mut curvature = PerVertex::filled(mesh.n_vertices(), 0);
            placed.cones.iter().zip(quarters).for_each(|(cone, k)| curvature[cone.0] = k);
            of_curvature(curvature)
        }
        SeamlessCones::Valences(cones) => given_right_angles(mesh, &sectors, cones)?,
    };
    check_totals(mesh, &sectors, &right_angles)?;
    Ok((sectors, right_angles))
}

/// The sectors without the features around the piece of a sector.
fn without_piece(mesh: &Mesh, sectors: &Sectors, sector: usize) -> Result<Sectors> {
    let left = sectors.features_off(mesh, sectors.piece[sector]);
    if left.len() == sectors.inner_features(mesh).len() {
        let vertex = sectors.vertex[sector];
        let message = format!(
            "the corner of the boundary at vertex {vertex} has no room for a right angle; refine the mesh"
        );
        return Err(Error::TargetKind { target: "seamless", message });
    }
    Sectors::new(mesh, &left)
}

/// This many cones of a closed surface, placed so that areas change little ([`auto_cones`]), with valences from 3 to 6, which suit corners of
/// patches; fewer where some are flat once they are rounded.
///
/// # Errors
/// Those of [`auto_cones`]; [`Error::TargetKind`] where so many cones with such valences do not add up to the curvature of the surface.
pub fn placed_cones(surface: &Surface, n: usize, control: &Control) -> Result<Vec<ConeValence>> {
    let mesh = surface.mesh();
    let placed = auto_cones(mesh, surface.lengths(), n, control)?.cones;
    let quarters = rounded_to_quarters(mesh, &placed, OF_PATCHES);
    let total: i64 = quarters.iter().map(|&k| i64::from(k)).sum();
    if total != 4 * mesh.euler() {
        let message = format!(
            "{n} cones with valences from 3 to 6 do not add up to the curvature of the surface; more do"
        );
        return Err(Error::TargetKind { target: "cones", message });
    }
    let cone =
        |((vertex, _), k): (&(VertexId, f64), i32)| ConeValence { vertex: *vertex, valence: (4 - k) as u32 };
    Ok(placed.iter().zip(quarters).filter(|(_, k)| *k != 0).map(cone).collect())
}

/// Curvature of cones rounded to quarter turns between these bounds, such that the total is 4χ where the bounds allow it.
fn rounded_to_quarters(mesh: &Mesh, cones: &[(VertexId, f64)], [least, most]: [i32; 2]) -> Vec<i32> {
    let exact = |k: usize| cones[k].1 / FRAC_PI_2;
    let mut quarters: Vec<i32> =
        (0..cones.len()).map(|k| (exact(k).round() as i32).clamp(least, most)).collect();
    loop {
        let missing = 4 * mesh.euler() - quarters.iter().map(|&k| i64::from(k)).sum::<i64>();
        let step = missing.signum() as i32;
        let off = |k: &usize| f64::from(step) * (exact(*k) - f64::from(quarters[*k]));
        let furthest = (0..cones.len())
            .filter(|&k| (least..=most).contains(&(quarters[k] + step)))
            .max_by(|a, b| off(a).total_cmp(&off(b)));
        match furthest {
            Some(k) if step != 0 => quarters[k] += step,
            _ => return quarters,
        }
    }
}

/// The conformal metric whose angles around vertices add up to these of their sectors; where features keep the flow from it, the surface
/// itself on a triangulation that is Delaunay but for features.
pub(super) fn start_state(
    surface: &Surface,
    sectors: Sectors,
    right_angles: &[i32],
    options: &SeamlessOptions,
    control: &Control,
) -> Result<(Solution, HolonomyState)> {
    let mesh = surface.mesh();
    let flat = |v| if mesh.is_boundary_vertex(v) { 2 } else { 4 };
    let mut quarters = PerVertex::from_fn(mesh.n_vertices(), flat);
    sectors.vertex.iter().zip(right_angles).for_each(|(&v, k)| quarters[v] -= k);
    let target = Target::All(PerVertex::from_fn(mesh.n_vertices(), |v| f64::from(quarters[v]) * FRAC_PI_2));
    let class = Class::yamabe(Space::E2);
    let is_whole = sectors.are_vertices();
    let flow_options = Options {
        tolerance: options.tolerance,
        threads: options.threads,
        fixed_edges: sectors.inner_features(mesh),
        // A vertex that holds its size keeps the surface from being doubled; its curvature follows from the others.
        pinned: if mesh.is_closed() { Vec::new() } else { vec![VertexId(0)] },
        max_iterations: if is_whole { 0 } else { FLOW_ITERATIONS },
        ..Options::default()
    };
    let flow = Flow::new(surface.clone(), class, &flow_options, control)
        .and_then(|mut flow| flow.solve(&target, control));
    match flow {
        Err(Error::Cancelled) => return Err(Error::Cancelled),
        Err(error) if is_whole => return Err(error),
        Ok(solution) if is_whole || solution.converged() => {
            let state = state_of(&solution, sectors.clone(), options)?;
            if is_whole || !state.is_broken {
                return Ok((solution, state));
            }
        }
        _ => {}
    }
    let solution = Solution::delaunay(surface.clone(), class, &flow_options.fixed_edges, control)?;
    let state = state_of(&solution, sectors, options)?;
    Ok((solution, state))
}

/// The state of a metric, which is to be near the lengths of the surface times the sizes.
fn state_of(solution: &Solution, sectors: Sectors, options: &SeamlessOptions) -> Result<HolonomyState> {
    let (mesh, metric, followed) = solution.parts();
    let mut state = HolonomyState::new(mesh, metric, followed, sectors)?;
    let n = state.mesh.n_vertices();
    let mut change = PerVertex::from_fn(n, |v| solution.initial().input_u[v] - state.metric.u[v]);
    if let Some(sizes) = &options.sizes {
        check_size("sizes", sizes.len(), n)?;
        if let Some(size) = sizes.iter().find(|size| !(size.is_finite() && **size > 0.0)) {
            return Err(Error::argument("size", size, "positive and finite"));
        }
        change = PerVertex::from_fn(n, |v| change[v] + sizes[v].ln());
    }
    let wanted = |e| {
        let [a, b] = state.mesh.ends(e);
        state.wanted[e] + change[a] + change[b]
    };
    state.wanted = PerEdge::from_fn(state.mesh.n_edges(), wanted);
    Ok(state)
}
