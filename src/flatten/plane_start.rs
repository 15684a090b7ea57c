//! The map that a descent starts from: the conformal layout, or an embedding by Tutte's theorem where that turns a triangle over.

use super::report::FlattenStart;
use super::rim::BorderRim;
use super::tutte::tutte;
use super::upright::is_upright;
use crate::control::Control;
use crate::embed::{Layout, LayoutOptions};
use crate::error::{Error, Result};
use crate::flow::{Options, flow};
use crate::geometry::Space;
use crate::metric::{Class, Surface, Target};
use crate::topology::check_connected;

/// A map of the vertices to the plane that turns no triangle over.
pub(super) struct PlaneStart {
    pub points: Vec<[f64; 2]>,
    pub way: FlattenStart,
}

/// Refuses surfaces that have no such map.
///
/// # Errors
/// [`Error::Layout`] for a surface that is not connected, closed, or of higher genus; [`Error::Argument`] for one that is not flat inside
/// its triangles.
pub(super) fn check_surface(surface: &Surface) -> Result<()> {
    let mesh = surface.mesh();
    check_connected(mesh, "flatten")?;
    if surface.geometry() != Space::E2 {
        let need = "e2: a map to the plane is linear on flat triangles";
        return Err(Error::argument("geometry of the surface", surface.geometry().name(), need));
    }
    let (genus, loops) = (mesh.genus(), mesh.boundary_loops().len());
    if genus > 0 || loops == 0 {
        return Err(Error::Layout(format!(
            "the surface has genus {genus} and {loops} boundary loops; an open surface of genus 0 is needed: cut it open first"
        )));
    }
    Ok(())
}

/// The start of a descent; where `rim` is given, one that is one to one.
///
/// # Errors
/// [`Error::Layout`] where neither map is free of triangles that are turned over; [`Error::Factorisation`], [`Error::Cancelled`].
pub(super) fn plane_start(
    surface: &Surface,
    rim: Option<&BorderRim>,
    control: &Control,
) -> Result<PlaneStart> {
    let faces = surface.mesh().triangles();
    let serves = |points: &[[f64; 2]]| {
        is_upright(&faces, points) && rim.is_none_or(|rim| rim.is_one_to_one(&faces, points))
    };
    match conformal(surface, &control.part(0.0, 0.9)) {
        Ok(Some(points)) if serves(&points) => {
            return Ok(PlaneStart { points, way: FlattenStart::Conformal });
        }
        Err(Error::Cancelled) => return Err(Error::Cancelled),
        // A flow that fails, or whose layout folds on the given triangles, leaves the other way.
        _ => {}
    }
    let points = tutte(surface, &control.part(0.9, 1.0))?;
    if serves(&points) {
        return Ok(PlaneStart { points, way: FlattenStart::Tutte });
    }
    let why = "no map without a folded triangle to start from: the surface has two edges with the same ends, or a part that is too long for \
               doubles beside the rest; refine the surface, or cut such parts off";
    Err(Error::Layout(why.into()))
}

/// The conformal layout with the lengths of the outer loop, on the given triangles; `None` where it is not one piece.
fn conformal(surface: &Surface, control: &Control) -> Result<Option<Vec<[f64; 2]>>> {
    let (mesh, class) = (surface.mesh(), Class::yamabe(Space::E2));
    let flat =
        flow(surface.clone(), class, &Target::Outer(None), &Options::default(), &control.part(0.0, 0.8))?;
    if !flat.converged() {
        return Ok(None);
    }
    let layout = Layout::of_solution(&flat, &LayoutOptions::default(), &control.part(0.8, 1.0))?;
    let on_input = layout.on_input().filter(|found| found.coordinates.len() == mesh.n_vertices());
    Ok(on_input.map(|found| {
        let mut points = vec![[0.0; 2]; mesh.n_vertices()];
        for h in mesh.halfedges().filter(|&h| !mesh.is_outside(h)) {
            points[mesh.origin(h).index()] = found.coordinates[found.corner_index[h] as usize];
        }
        points
    }))
}
