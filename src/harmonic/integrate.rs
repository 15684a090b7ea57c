//! The integral of a complex 1-form over a surface that is opened along a cut: a drawing of the surface in the plane.
//!
//! ```
//! use ricci::harmonic::{Domain, FormsOptions, HarmonicForms, PeriodMatrix, integrate};
//! use ricci::topology::cut_graph;
//! use ricci::{Control, Surface, mesh::shapes};
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 48, 24)?)?;
//! let control = Control::new();
//! let forms = HarmonicForms::new(&Domain::new(&torus, &control)?, &FormsOptions::default(), &control)?;
//! let form = PeriodMatrix::new(&forms)?.basis_form(&forms, 0)?;
//! let domain = &forms.domain;
//! let cut = cut_graph(domain.mesh(), domain.lengths(), &[], &control)?;
//! let layout = integrate(domain, &form, &cut)?;
//! assert!(layout.flipped.is_empty() && (layout.dilatation(domain).0 - 1.0).abs() < 0.1);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::domain::Domain;
use super::one_form::ComplexForm;
use crate::error::{Error, Result, check_size};
use crate::geometry::complex::{Complex, add, doubled_area};
use crate::geometry::predicates::orientation;
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerEdge, PerFace, PerHalfedge};
use crate::metric::CommonSubdivision;
use crate::topology::{CutGraph, cut::is_disk, number_corners};
use std::cmp::Ordering;
use std::collections::VecDeque;
use std::sync::Arc;

/// The triangulation that is drawn: the domain's own, or a subdivision of it.
#[derive(Debug, Clone, PartialEq)]
enum DrawnTriangulation {
    Mesh(Arc<Mesh>),
    Subdivision(Arc<CommonSubdivision>),
}

/// A drawing of a surface, opened along a cut, by the integral of a complex form. If the form is holomorphic, the drawing is conformal up
/// to O(h²).
#[derive(Debug, Clone, PartialEq)]
pub struct FormLayout {
    drawn: DrawnTriangulation,
    /// The edges along which the surface is opened.
    pub is_cut: PerEdge<bool>,
    /// Per half-edge, the index into `points` of the corner at its origin, in its face ([`crate::embed::Layout::corner_index`]).
    pub corner_index: PerHalfedge<u32>,
    /// The coordinates of the vertices of the opened surface.
    pub points: Vec<Complex>,
    /// The faces that are not counterclockwise, by exact arithmetic: those that hold a zero of the form.
    pub flipped: Vec<FaceId>,
}

/// The integral of a closed form over the surface, opened along `cut`; it is 0 at the first corner of face 0. The two corners of a vertex
/// on the sides of a segment of the cut differ by a period of the form.
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
    let mut corners = vec![[[f64::NAN; 2]; 3]; mesh.n_faces()];
    let mut reached = PerFace::filled(mesh.n_faces(), false);
    let start = mesh.faces().next().map(|f| (mesh.face_halfedge(f), [0.0; 2]));
    let mut open: VecDeque<(HalfedgeId, Complex)> = start.into_iter().collect();
    while let Some((h, start)) = open.pop_front() {
        let Some((f, k)) = mesh.corner(h).filter(|(f, _)| !reached[*f]) else { continue };
        reached[f] = true;
        let sides = [h, mesh.next(h), mesh.prev(h)];
        let second = add(start, form.along(h));
        let points = [start, second, add(second, form.along(sides[1]))];
        for (i, side) in sides.into_iter().enumerate() {
            corners[f.index()][(k + i) % 3] = points[i];
            if !cut.is_cut[side.edge()] {
                // The twin starts at the end of the side.
                open.push_back((side.twin(), points[(i + 1) % 3]));
            }
        }
    }
    Ok(FormLayout::new(DrawnTriangulation::Mesh(mesh.clone()), cut.is_cut.clone(), &corners))
}

impl FormLayout {
    fn new(drawn: DrawnTriangulation, is_cut: PerEdge<bool>, corners: &[[Complex; 3]]) -> FormLayout {
        let mesh = drawn.mesh();
        let (corner_index, n) = number_corners(mesh, &is_cut);
        let mut points = vec![[f64::NAN; 2]; n];
        for f in mesh.faces() {
            let placed = mesh.face_halfedges(f).into_iter().zip(corners[f.index()]);
            placed.for_each(|(h, z)| points[corner_index[h] as usize] = z);
        }
        let is_left = |f: &FaceId| {
            let [a, b, c] = mesh.face_halfedges(*f).map(|h| points[corner_index[h] as usize]);
            orientation(a, b, c) == Ordering::Greater
        };
        let flipped = mesh.faces().filter(|f| !is_left(f)).collect();
        FormLayout { is_cut, corner_index, points, flipped, drawn }
    }

    /// The same drawing on a common subdivision of the domain's triangulation and the given one ([`Domain::common_subdivision`]).
    ///
    /// # Errors
    /// [`Error::Size`] for the subdivision of another triangulation; [`Error::Layout`] for a drawing of a subdivision.
    pub fn on_subdivision(&self, subdivision: &Arc<CommonSubdivision>) -> Result<FormLayout> {
        let DrawnTriangulation::Mesh(mesh) = &self.drawn else {
            return Err(Error::Layout("a drawing of a subdivision has no other subdivision".into()));
        };
        let corners: Vec<[Complex; 3]> = mesh.faces().map(|f| self.face(f)).collect();
        let corners = subdivision.from_corners(1, &corners)?;
        let is_cut = |e| subdivision.edge(1, e).is_some_and(|e| self.is_cut[e]);
        let is_cut = PerEdge::from_fn(subdivision.mesh.n_edges(), is_cut);
        Ok(FormLayout::new(DrawnTriangulation::Subdivision(subdivision.clone()), is_cut, &corners))
    }

    /// The triangulation that is drawn: the domain's own, or a subdivision of it.
    pub fn mesh(&self) -> &Mesh {
        self.drawn.mesh()
    }

    /// The subdivision that is drawn, if it is one.
    pub fn common_subdivision(&self) -> Option<&Arc<CommonSubdivision>> {
        match &self.drawn {
            DrawnTriangulation::Mesh(_) => None,
            DrawnTriangulation::Subdivision(r) => Some(r),
        }
    }

    /// The point of the corner at the origin of a half-edge, in its face.
    pub fn point(&self, h: HalfedgeId) -> Complex {
        self.points[self.corner_index[h] as usize]
    }

    /// The points of a face's corners, in corner order.
    pub fn face(&self, f: FaceId) -> [Complex; 3] {
        self.mesh().face_halfedges(f).map(|h| self.point(h))
    }

    /// The quasi-conformal dilatation of the faces that are not flipped, in a drawing of the domain's own triangulation: the mean weighted
    /// by area, and the bound that 99% of the area stay below (at zeros of the form the dilatation is unbounded).
    pub fn dilatation(&self, domain: &Domain) -> (f64, f64) {
        let mut all: Vec<(f64, f64)> = Vec::with_capacity(domain.mesh().n_faces());
        for f in domain.mesh().faces() {
            let doubled = doubled_area(self.face(f));
            if doubled > 0.0 {
                all.push((dilatation(domain.cotangents()[f], self.face(f), doubled), domain.face_areas()[f]));
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

impl DrawnTriangulation {
    fn mesh(&self) -> &Mesh {
        match self {
            DrawnTriangulation::Mesh(mesh) => mesh,
            DrawnTriangulation::Subdivision(r) => &r.mesh,
        }
    }
}

/// The ratio of the singular values of a triangle's map. With the Dirichlet energy `E = Σ cot θ_k |side k|²/4` of the map and the area A of
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
