//! From pieces to their layout: triangles are unfolded face after face, and the opened surface gets its corners, seams and measures.

use super::develop::Development;
use super::faces::Faces;
use super::frame::HalfedgeFrame;
use super::layout::{Layout, Seam, bounding_diagonal, flat, radius};
use super::pieces::LayoutPieces;
use crate::control::Control;
use crate::error::{Error, Result, check_size};
use crate::geometry::complex::{norm2, sub};
use crate::geometry::{DoubleDouble, Motion, Space, worse};
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerEdge, PerHalfedge, VertexId};
use crate::metric::{CommonSubdivision, Metric};
use crate::parallel;
use crate::topology::{CutGraph, check_lengths, cut, number_corners};
use std::sync::Arc;

impl Layout {
    /// The layout in E² of lengths that are flat off the cut, in units of the lengths, computed in f64, O(E log E). A corner of the
    /// smallest triangle lies at the origin.
    ///
    /// `lengths`: one per edge, flat at every vertex inside the opened surface; how far they are from that shows in
    /// [`Layout::consistency`] and [`Layout::broken`]. `cut`: opens the surface into a disk ([`crate::topology::cut_graph`]).
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::EdgeLength`], [`Error::Layout`] if the cut does not leave a disk, [`Error::Cancelled`].
    ///
    /// ```
    /// use ricci::embed::Layout;
    /// use ricci::{Control, Surface, mesh::shapes, topology::cut_graph};
    /// # fn main() -> ricci::Result<()> {
    /// let disk = Surface::from_soup(&shapes::disk(4)?)?;
    /// let cut = cut_graph(disk.mesh(), disk.lengths(), &[], &Control::new())?;
    /// let layout = Layout::of_lengths(disk.mesh(), disk.lengths(), &cut, &Control::new())?;
    /// assert!(layout.seams.is_empty() && layout.consistency() < 1e-14);
    /// # Ok(())
    /// # }
    /// ```
    pub fn of_lengths(
        mesh: &Arc<Mesh>,
        lengths: &PerEdge<f64>,
        cut: &CutGraph,
        control: &Control,
    ) -> Result<Layout> {
        check_lengths(mesh, lengths)?;
        let faces = Faces::of_lengths(mesh, lengths.clone());
        let mut layout = unfold(LayoutPieces::Mesh(mesh.clone()), &faces, None, Some(cut.clone()), control)?;
        layout.find_flat();
        Ok(layout)
    }
}

/// The part of a flat surface that a cut leaves around the smallest triangle, unfolded: the plane coordinates of the corner at the origin
/// of each half-edge of a face, NaN beyond the cut.
///
/// # Errors
/// Those of [`Metric::lengths`]; [`Error::Layout`] for lengths beyond what f64s can place; [`Error::Cancelled`].
pub(crate) fn unfold_part(
    mesh: &Arc<Mesh>,
    metric: &Metric,
    is_cut: &PerEdge<bool>,
    control: &Control,
) -> Result<PerHalfedge<[f64; 2]>> {
    let faces = Faces::in_plane(mesh, metric)?;
    let grown = Development::grow(LayoutPieces::Mesh(mesh.clone()), &faces, None, Some(is_cut), control)?;
    let (corner, n_corners) = number_corners(mesh, is_cut);
    let points = grown.points(&corner, n_corners);
    Ok(PerHalfedge::from_fn(mesh.n_halfedges(), |h| flat(Space::E2, points[corner[h] as usize])))
}

/// [`unfold_part`] in double-double precision: x and y.
///
/// # Errors
/// As there.
pub(crate) fn unfold_part_precisely(
    mesh: &Arc<Mesh>,
    metric: &Metric,
    is_cut: &PerEdge<bool>,
    control: &Control,
) -> Result<PerHalfedge<[DoubleDouble; 2]>> {
    let faces = Faces::precise(mesh, metric)?;
    let grown = Development::grow(LayoutPieces::Mesh(mesh.clone()), &faces, None, Some(is_cut), control)?;
    let (corner, n_corners) = number_corners(mesh, is_cut);
    let (points, low) = grown.points_and_remainders(&corner, n_corners);
    let place = |k: usize| [0, 1].map(|i| DoubleDouble::from(points[k][i]).plus(low[k][i]));
    Ok(PerHalfedge::from_fn(mesh.n_halfedges(), |h| place(corner[h] as usize)))
}

/// Unfolds a surface that lies in the plane without a cut: around each of its holes, its metric leads back to where it began.
pub(super) fn unfold_whole<F: HalfedgeFrame>(
    pieces: LayoutPieces,
    faces: &Faces<F>,
    root: Option<VertexId>,
    control: &Control,
) -> Result<Layout> {
    let cut = CutGraph::empty(pieces.mesh());
    let corners = CutCorners::new(pieces.mesh(), &cut);
    grow_all(&pieces, faces, root, Some(&cut), control)?.into_layout(cut, corners, control)
}

/// Unfolds pieces that are opened along a cut of them; without a cut, the surface is opened where the growing disk meets itself. Flipped
/// and degenerate triangles are found later ([`Layout::find_flat`]).
pub(super) fn unfold<F: HalfedgeFrame>(
    pieces: LayoutPieces,
    faces: &Faces<F>,
    root: Option<VertexId>,
    cut: Option<CutGraph>,
    control: &Control,
) -> Result<Layout> {
    let grow = |cut: Option<&CutGraph>| grow_all(&pieces, faces, root, cut, control);
    match cut {
        Some(cut) => {
            check_size("is_cut", cut.is_cut.len(), pieces.mesh().n_edges())?;
            check_cut(pieces.mesh(), &cut)?;
            let corners = CutCorners::new(pieces.mesh(), &cut);
            grow(Some(&cut))?.into_layout(cut, corners, control)
        }
        None => {
            let (grown, mesh) = (grow(None)?, pieces.mesh());
            let cut = CutGraph::around(mesh, PerEdge::from_fn(mesh.n_edges(), |e| !grown.crossed[e]));
            let corners = CutCorners::new(mesh, &cut);
            grown.into_layout(cut, corners, control)
        }
    }
}

/// The development of all pieces.
fn grow_all<'a, F: HalfedgeFrame>(
    pieces: &LayoutPieces,
    faces: &'a Faces<'a, F>,
    root: Option<VertexId>,
    cut: Option<&CutGraph>,
    control: &Control,
) -> Result<Development<'a, F>> {
    let grown = Development::grow(pieces.clone(), faces, root, cut.map(|cut| &cut.is_cut), control)?;
    if grown.n_reached() < pieces.mesh().n_faces() {
        return Err(Error::Layout("the surface has several components: lay out each alone".into()));
    }
    Ok(grown)
}

/// The corners of the opened surface and the sides of its seams, which follow from the cut alone.
struct CutCorners {
    /// [`Layout::corner_index`].
    corner_index: PerHalfedge<u32>,
    n_corners: usize,
    /// [`Layout::side`].
    side: PerHalfedge<i32>,
}

impl CutCorners {
    fn new(mesh: &Mesh, cut: &CutGraph) -> CutCorners {
        let (corner_index, n_corners) = number_corners(mesh, &cut.is_cut);
        CutCorners { corner_index, n_corners, side: seam_sides(mesh, cut) }
    }
}

impl<F: HalfedgeFrame> Development<'_, F> {
    /// The layout of a development in which every piece was reached, opened along a cut of the pieces. Its lists of flipped and degenerate
    /// triangles are empty yet.
    fn into_layout(self, cut: CutGraph, corners: CutCorners, control: &Control) -> Result<Layout> {
        let (mesh, faces, space) = (self.pieces.mesh(), self.faces, self.faces.space);
        let CutCorners { corner_index, n_corners, side } = corners;
        let (points, remainders) = self.points_and_remainders(&corner_index, n_corners);
        let mut coordinates = vec![[0.0; 2]; n_corners];
        parallel::fill(&mut coordinates, |k| flat(space, points[k]));
        let diameter = bounding_diagonal(&coordinates);
        // The south pole of a sphere has no plane coordinates.
        let is_placed = points.as_flattened().iter().all(|x| x.is_finite()) && diameter > 0.0;
        if !(is_placed && (diameter.is_finite() || space == Space::S2)) {
            return Err(Error::Layout(
                "the lengths are too large or too small for floating-point numbers: rescale them".into(),
            ));
        }
        control.check()?;
        let [apart, local_consistency] = self.most_misses(|h| points[corner_index[h] as usize]);
        let mut seams = cut.segments.iter().map(|s| self.seam(s)).collect::<Result<Vec<_>>>()?;
        let disagreement = seams.iter().fold(apart, |far, seam| worse(far, seam.residual));
        if space == Space::E2 {
            seams.iter_mut().for_each(|seam| seam.residual /= diameter);
        }
        control.check()?;
        Ok(Layout {
            space,
            seams,
            flipped: Vec::new(),
            degenerate: Vec::new(),
            broken: mesh.faces().filter(|&f| faces.is_broken(self.pieces.final_face(f))).collect(),
            disagreement,
            local_consistency,
            radius: radius(space, &points),
            diameter,
            area: faces.area_of(&self.pieces),
            scale: 1.0,
            input: None,
            side,
            n_steps: self.n_patches,
            frames: if F::IS_PRECISE {
                self.frames.into_iter().map(|frame| frame.motion()).collect()
            } else {
                Vec::new()
            },
            patch: if F::IS_PRECISE { self.patch } else { Vec::new().into() },
            pieces: self.pieces,
            cut,
            corner_index,
            points,
            remainders,
            coordinates,
        })
    }

    /// The largest [`Development::misses`] of all patches.
    fn most_misses(&self, point: impl Fn(HalfedgeId) -> [f64; 3] + Sync) -> [f64; 2] {
        let mut misses = vec![[0.0; 2]; self.frames.len()];
        parallel::fill(&mut misses, |patch| self.misses(patch, &point));
        misses.iter().fold([0.0; 2], |[a, b], m| [worse(a, m[0]), worse(b, m[1])])
    }

    /// The largest distance in one patch between the place of a corner by its face and its point in the layout, and the largest such
    /// difference of an edge relative to the face's longest side.
    fn misses(&self, patch: usize, point: impl Fn(HalfedgeId) -> [f64; 3]) -> [f64; 2] {
        let mut pieces = self.pieces_of(patch).peekable();
        let Some(placed) = pieces.peek().map(|&f| self.placed(f)) else { return [0.0; 2] };
        let (sides, over) = (placed.sides(), 1.0 / placed.longest());
        let (mut worst, mut worst_edge) = (0.0, 0.0);
        for f in pieces {
            let corners = self.pieces.mesh().face_halfedges(f);
            let places = [0, 1, 2].map(|k| self.pieces.final_place((f, k), corners[k]));
            let off = placed.misses(corners.map(&point), places, &sides);
            let off = off.map(|off| off.map(|x| x * over));
            for k in 0..3 {
                worst = worse(worst, norm2(off[k]));
                worst_edge = worse(worst_edge, norm2(sub(off[(k + 1) % 3], off[k])));
            }
        }
        [worst.sqrt() / over, worst_edge.sqrt()]
    }

    /// The seam of a segment: the isometry of its edge that is nearest to the origin, and the largest distance of the other edges'
    /// isometries from it.
    fn seam(&self, segment: &[HalfedgeId]) -> Result<Seam> {
        let frames = segment.iter().map(|&h| self.on_both_sides(h)).collect::<Result<Vec<_>>>()?;
        let far =
            |sides: &[Motion<DoubleDouble>; 2]| sides.iter().map(Motion::displacement).fold(0.0, f64::max);
        let far: Vec<f64> = frames.iter().map(far).collect();
        let nearest = (0..far.len()).min_by(|&i, &j| far[i].total_cmp(&far[j]));
        let pairing = match nearest.map(|k| frames[k]) {
            Some([left, right]) => left.compose(&right.inverse()),
            None => Motion::identity(self.faces.space),
        };
        // The distance of isometries loses a factor e^r of the digits in H²; that of vectors would lose e^{2r}.
        let off = |[left, right]: &[Motion<DoubleDouble>; 2]| {
            left.inverse().compose(&pairing).compose(right).displacement()
        };
        Ok(Seam { pairing, residual: frames.iter().map(off).fold(0.0, worse) })
    }
}

impl Layout {
    /// The same layout on a common subdivision of the triangulation that is laid out, opened along the same edges; O(pieces). `metric`: the
    /// metric that was laid out.
    ///
    /// # Errors
    /// [`Error::Size`] for the subdivision of another triangulation; [`Error::Layout`] for a layout that is already one of a subdivision or
    /// has not been computed in double-double precision ([`super::LayoutOpening`]); [`Error::Cancelled`].
    pub fn on_subdivision(
        &self,
        r: &Arc<CommonSubdivision>,
        metric: &Metric,
        control: &Control,
    ) -> Result<Layout> {
        let LayoutPieces::Mesh(mesh) = &self.pieces else {
            return Err(Error::Layout("a layout of a subdivision has no other subdivision".into()));
        };
        if self.frames.is_empty() {
            return Err(Error::Layout(
                "this layout was not computed in double-double precision, which pieces need".into(),
            ));
        }
        let need = r.faces[1].iter().map(|f| f.index() + 1).fold(0, usize::max);
        check_size("final faces", mesh.n_faces().min(need), need)?;
        let faces = Faces::precise(mesh, metric)?;
        let frame = |f: FaceId| {
            let mut frame = self.frames[self.patch[f] as usize];
            frame.b = frame.b.map(|x| x / self.scale.into());
            frame
        };
        let frames: Vec<_> = mesh.faces().map(frame).collect();
        let grown = Development::of_frames(r, &faces, frames);
        let cut = grown.pieces.cut_of_final(mesh, &self.cut)?.inside(&r.mesh);
        let corners = CutCorners::new(grown.pieces.mesh(), &cut);
        let mut layout = grown.into_layout(cut, corners, control)?;
        layout.scale_by(self.scale);
        layout.find_flat();
        Ok(layout)
    }
}

/// [`Layout::side`] of each half-edge.
fn seam_sides(mesh: &Mesh, cut: &CutGraph) -> PerHalfedge<i32> {
    let mut side = PerHalfedge::filled(mesh.n_halfedges(), 0);
    for (k, segment) in cut.segments.iter().enumerate() {
        for &h in segment {
            (side[h], side[h.twin()]) = (k as i32 + 1, -(k as i32) - 1);
        }
    }
    side
}

/// Checks that a cut, which has an entry per edge, opens the surface into a disk, and that every cut edge lies inside the surface and in
/// exactly one segment, once.
fn check_cut(mesh: &Mesh, cut: &CutGraph) -> Result<()> {
    if !cut::is_disk(mesh, &cut.is_cut) {
        return Err(Error::Layout("the cut does not open the surface into a disk".into()));
    }
    let mut left = cut.is_cut.clone();
    for &h in cut.segments.iter().flatten() {
        if h.index() >= mesh.n_halfedges() || !std::mem::replace(&mut left[h.edge()], false) {
            return Err(Error::Layout(format!("half-edge {h} of a segment is not cut, or in two segments")));
        }
    }
    let wrong = mesh.edges().find(|&e| left[e] || (cut.is_cut[e] && mesh.is_boundary_edge(e)));
    wrong.map_or(Ok(()), |e| Err(Error::Layout(format!("cut edge {e} is in no segment, or on the boundary"))))
}
