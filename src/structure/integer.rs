//! The integer structure: charts in which the quads of a mesh are unit squares, so that all transitions are rotations by multiples of 90° with
//! integer translations.

use super::developable::DevelopableSurface;
use super::flat_source::{StructureSource, source_of_flat};
use super::options::AtlasOptions;
use crate::control::Control;
use crate::embed::FaceTransitions;
use crate::error::{Error, Result};
use crate::flow::{Flips, Options, flow};
use crate::geometry::complex::{conj, mul, norm2, scale, sub};
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerEdge, PerFace, PerHalfedge, PerVertex, Place};
use crate::metric::{Class, Surface, Target};
use crate::quads::{QuadMesh, QuadOptions, QuadSize, quad_layout, quad_mesh};
use crate::seamless::{SeamlessOptions, seamless};
use std::f64::consts::{FRAC_PI_2, SQRT_2};
use std::sync::Arc;

/// Corners of a quad in the plane.
const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

/// The developed squares of a quad mesh of a surface: that of its coarsest layout, or one of a number of quads.
pub(super) fn of_quads(
    surface: &Surface,
    options: &AtlasOptions,
    control: &Control,
) -> Result<StructureSource> {
    let threads = options.flow.threads;
    let metric_options =
        SeamlessOptions { threads, tolerance: options.flow.tolerance, ..SeamlessOptions::default() };
    let metric = seamless(surface, &metric_options, &control.part(0.0, 0.4))?;
    if !metric.converged() {
        let message = format!("the seamless metric is {:e} radians off its angles", metric.error);
        return Err(Error::Layout(message));
    }
    let control = control.part(0.4, 0.9);
    let quads = match options.quads {
        Some(n) => quad_mesh(&metric, &QuadOptions { size: QuadSize::Quads(n), threads }, &control)?,
        None => quad_layout(&metric, &QuadOptions { size: QuadSize::Coarse, threads }, &control)?.mesh,
    };
    developed(quads, threads, &control)
}

/// The unit squares of a quad mesh, each in two triangles.
fn developed(quads: QuadMesh, threads: usize, control: &Control) -> Result<StructureSource> {
    let faces: Vec<[u32; 3]> = quads.quads.iter().flat_map(|&quad| QuadMesh::halves(quad)).collect();
    let mesh = Arc::new(Mesh::from_faces(quads.places.len(), &faces)?);
    let surface = unit_squares(&mesh)?;
    let valences = quads.valences();
    let regular = |v| if mesh.is_boundary_vertex(v) { 2 } else { 4 };
    let mut curvature = PerVertex::filled(mesh.n_vertices(), 0.0);
    for v in mesh.vertices() {
        curvature[v] = FRAC_PI_2 * f64::from(regular(v) - valences[v.index()] as i32);
    }
    let mut lengths = PerEdge::filled(mesh.n_edges(), 1.0);
    for f in mesh.faces() {
        let sides = mesh.face_halfedges(f);
        lengths[sides[if f.index().is_multiple_of(2) { 2 } else { 0 }].edge()] = SQRT_2;
    }
    let given = Surface::intrinsic(mesh.clone(), lengths, Space::E2)?;
    let options = Options { flips: Flips::Never, threads, ..Options::default() };
    let metric = flow(given, Class::yamabe(Space::E2), &Target::All(curvature.clone()), &options, control)?;
    let mut found = source_of_flat(surface, metric, control)?;
    for v in mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v)) {
        found.developed.singular[v] = curvature[v] != 0.0;
        found.developed.turns |= curvature[v] != 0.0;
    }
    found.on_given = Some(quads.places.into_iter().map(|(face, weights)| Place { face, weights }).collect());
    Ok(found)
}

/// The triangles of unit squares, with the turns by multiples of 90° and the integer translations between them.
fn unit_squares(mesh: &Arc<Mesh>) -> Result<DevelopableSurface> {
    let halves = QuadMesh::halves([0, 1, 2, 3]);
    let corners = PerFace::from_fn(mesh.n_faces(), |f: FaceId| {
        halves[f.index() % 2].map(|i| {
            let [x, y] = SQUARE[i as usize];
            [x, y, 1.0]
        })
    });
    let ends = |h: HalfedgeId| -> Result<[[f64; 2]; 2]> {
        let none = || Error::Layout(format!("half-edge {h} belongs to no face"));
        let (f, k) = mesh.corner(h).ok_or_else(none)?;
        Ok([k, (k + 1) % 3].map(|k| [corners[f][k][0], corners[f][k][1]]))
    };
    let across = |h: HalfedgeId| -> Result<Motion<DoubleDouble>> {
        if mesh.is_boundary_edge(h.edge()) {
            return Ok(Motion::identity(Space::E2));
        }
        let ([from, to], [to_beyond, from_beyond]) = (ends(h)?, ends(h.twin())?);
        let (here, beyond) = (sub(to, from), sub(to_beyond, from_beyond));
        // Both are as long, and parallel to an axis or both the diagonal: the quotient is 1, i, −1 or −i.
        let turn = scale(1.0 / norm2(beyond), mul(here, conj(beyond)));
        let place = sub(from, mul(turn, from_beyond));
        Ok(Motion::in_plane(turn.map(DoubleDouble::from), place.map(DoubleDouble::from)))
    };
    let across: PerHalfedge<_> = mesh.halfedges().map(across).collect::<Result<Vec<_>>>()?.into();
    let area = 0.5 * mesh.n_faces() as f64;
    let faces = FaceTransitions { mesh: mesh.clone(), space: Space::E2, corners, across, area };
    let mut surface = DevelopableSurface::new(faces);
    surface.begins_at_corners = true;
    Ok(surface)
}
