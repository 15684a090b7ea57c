//! Integrals of complex forms: over paths, and over the surface opened along a cut.
//!
//! ```
//! use ricci::harmonic::{Domain, FormsOptions, HarmonicForms, PeriodMatrix, integrate};
//! use ricci::topology::cut_graph;
//! use ricci::{Control, Surface, mesh::shapes};
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 24, 12)?)?;
//! let control = Control::new();
//! let forms = HarmonicForms::new(&Domain::new(&torus, &control)?, &FormsOptions::default(), &control)?;
//! let form = PeriodMatrix::new(&forms)?.basis_form(&forms, 0)?;
//! let domain = &forms.domain;
//! let cut = cut_graph(domain.mesh(), domain.lengths(), &[], &control)?;
//! let layout = integrate(domain, &form, &cut)?;
//! assert!(layout.flipped.is_empty() && (layout.dilatation(domain).1 - 1.0).abs() < 0.1);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::domain::Domain;
use super::one_form::ComplexForm;
use crate::error::{Error, Result, check_size};
use crate::geometry::complex::{Complex, add, doubled_area};
use crate::geometry::predicates::orientation;
use crate::mesh::{FaceId, PerFace};
use crate::topology::{CutGraph, cut::is_disk};
use std::cmp::Ordering;

/// The surface opened along a cut, drawn by the integral of a complex form: conformal where that is holomorphic, up to O(h²).
#[derive(Debug, Clone, PartialEq)]
pub struct FormLayout {
    /// The cut on the domain's triangulation.
    pub cut: CutGraph,
    /// Per face the points of its corners, in corner order.
    pub corners: PerFace<[Complex; 3]>,
    /// Faces that are not counterclockwise: those that hold a zero of the form. By exact arithmetic.
    pub flipped: Vec<FaceId>,
}

/// The integral of a closed form over the surface opened along `cut`, 0 at the first corner of face 0. Corners of one vertex on the two
/// sides of a segment of the cut differ by a period of the form.
///
/// # Errors
/// [`Error::Size`]; [`Error::Layout`] for a cut that does not leave a disk.
pub fn integrate(domain: &Domain, form: &ComplexForm, cut: &CutGraph) -> Result<FormLayout> {
    let mesh = domain.mesh();
    check_size("form", form.0.len(), mesh.n_edges())?;
    check_size("is_cut", cut.is_cut.len(), mesh.n_edges())?;
    if !is_disk(mesh, &cut.is_cut) {
        return Err(Error::Layout("the cut does not open the surface into a disk".into()));
    }
    let mut corners = PerFace::filled(mesh.n_faces(), [[f64::NAN; 2]; 3]);
    let mut reached = PerFace::filled(mesh.n_faces(), false);
    let mut open = std::collections::VecDeque::new();
    if let Some(h) = mesh.faces().next().map(|f| mesh.face_halfedge(f)) {
        open.push_back((h, [0.0; 2]));
    }
    while let Some((h, start)) = open.pop_front() {
        let Some((f, k)) = mesh.corner(h).filter(|(f, _)| !reached[*f]) else { continue };
        reached[f] = true;
        let next = mesh.next(h);
        let points = [start, add(start, form.along(h)), add(add(start, form.along(h)), form.along(next))];
        (0..3).for_each(|i| corners[f][(k + i) % 3] = points[i]);
        for (i, side) in [h, next, mesh.next(next)].into_iter().enumerate() {
            if !cut.is_cut[side.edge()] {
                // The twin starts where the side ends.
                open.push_back((side.twin(), points[(i + 1) % 3]));
            }
        }
    }
    let is_left = |f: &FaceId| {
        let [a, b, c] = corners[*f];
        orientation(a, b, c) == Ordering::Greater
    };
    let flipped = mesh.faces().filter(|f| !is_left(f)).collect();
    Ok(FormLayout { cut: cut.clone(), corners, flipped })
}

impl FormLayout {
    /// Quasi-conformal dilatation of the faces that are not flipped: area-weighted mean, and the dilatation that 99% of their area stay
    /// below (at zeros of the form it is unbounded).
    pub fn dilatation(&self, domain: &Domain) -> (f64, f64) {
        let mut all: Vec<(f64, f64)> = Vec::with_capacity(self.corners.len());
        for f in domain.mesh().faces() {
            let drawn = doubled_area(self.corners[f]);
            if drawn > 0.0 {
                all.push((
                    dilatation(domain.cotangents()[f], self.corners[f], drawn),
                    domain.face_areas()[f],
                ));
            }
        }
        all.sort_by(|x, y| x.0.total_cmp(&y.0));
        let total: f64 = all.iter().map(|(_, area)| area).sum();
        let mean = all.iter().map(|(k, area)| k * area).sum::<f64>() / total;
        let mut below = 0.0;
        let most = all.iter().find(|(_, area)| {
            below += area;
            below >= 0.99 * total
        });
        (mean, most.map_or(f64::NAN, |m| m.0))
    }
}

/// Ratio of the singular values of a triangle's map: with the Dirichlet energy `E = Σ cot θ_k |side k|²/4` of the map and the area A of
/// the image, `(K + 1/K)/2 = E/A`.
fn dilatation(cotangents: [f64; 3], image: [Complex; 3], doubled: f64) -> f64 {
    let energy: f64 = (0..3)
        .map(|k| {
            let [p, q] = [image[(k + 1) % 3], image[(k + 2) % 3]];
            0.5 * cotangents[k] * ((p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2))
        })
        .sum();
    let mean = (energy / doubled).max(1.0);
    mean + (mean * mean - 1.0).sqrt()
}
