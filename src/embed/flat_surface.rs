//! Layouts in the plane as geometry: a mesh of points (x, y, 0), and the lines along which a sheet is cut and folded.
//!
//! ```
//! use ricci::embed::{FlatSurface, Layout, fold_edges};
//! use ricci::mesh::io::SheetLayer;
//! use ricci::{Control, Surface, mesh::shapes, topology::cut_graph};
//! # fn main() -> ricci::Result<()> {
//! let soup = shapes::disk(4)?;
//! let disk = Surface::from_soup(&soup)?;
//! let cut = cut_graph(disk.mesh(), disk.lengths(), &[], &Control::new())?;
//! let layout = Layout::of_lengths(disk.mesh(), disk.lengths(), &cut, &Control::new())?;
//! let flat = FlatSurface::of_layout(&layout);
//! let sheet = flat.sheet(|e| fold_edges(disk.mesh(), &soup.positions, 0.5).contains(&e));
//! assert_eq!(sheet.lines.len(), 1);
//! assert!(sheet.lines[0].layer == SheetLayer::Boundary && sheet.lines[0].is_closed);
//! assert_eq!(flat.soup().faces.len(), disk.mesh().n_faces());
//! # Ok(())
//! # }
//! ```

use super::layout::{Layout, OnInput};
use super::repaired_input::RepairedInput;
use crate::error::Result;
use crate::geometry::vector::{cross, dot, norm, triangle_normal};
use crate::mesh::io::{self, CuttingSheet, SheetLayer, SheetLine, SheetUnit, Soup};
use crate::mesh::{EdgeId, HalfedgeId, Mesh, PerEdge, PerHalfedge, Point};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

/// A surface whose faces lie in the plane.
#[derive(Debug, Clone)]
pub struct FlatSurface<'a> {
    /// The faces.
    pub mesh: &'a Mesh,
    /// Per half-edge of a face, the index into `points` of the corner at its origin. Corners around a vertex share an index unless seams or
    /// the boundary separate them.
    pub corner_index: &'a PerHalfedge<u32>,
    /// The points of the opened surface.
    pub points: Cow<'a, [[f64; 2]]>,
    /// The half-edges on the left side of the seams, with the number of the seam.
    pub seams: Vec<(HalfedgeId, usize)>,
}

/// The part of an outline that a half-edge belongs to: the boundary, or the left or right side of a seam.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum OutlinePart {
    Boundary,
    Left(u32),
    Right(u32),
}

/// The edges along which a surface in space has a crease: the angle between the normals of the two faces exceeds `angle`, in radians.
/// Ascending; faces without area have no crease.
pub fn fold_edges(mesh: &Mesh, positions: &[Point], angle: f64) -> Vec<EdgeId> {
    let normal = |h: HalfedgeId| -> Option<Point> {
        let f = mesh.face(h)?;
        let n = triangle_normal(mesh.face_vertices(f).map(|v| positions[v.index()]));
        (norm(n) > 0.0).then_some(n)
    };
    let is_fold = |e: &EdgeId| match [e.halfedge(), e.halfedge().twin()].map(normal) {
        [Some(a), Some(b)] => norm(cross(a, b)).atan2(dot(a, b)) > angle,
        _ => false,
    };
    mesh.edges().filter(is_fold).collect()
}

/// The half-edges of the segments of a cut, with the number of the segment.
fn numbered(segments: &[Vec<HalfedgeId>]) -> Vec<(HalfedgeId, usize)> {
    let of_segment =
        |(k, segment): (usize, &Vec<HalfedgeId>)| -> Vec<_> { segment.iter().map(|&h| (h, k)).collect() };
    segments.iter().enumerate().flat_map(of_segment).collect()
}

impl<'a> FlatSurface<'a> {
    /// A layout on the faces of the surface as it came with edges split; `on_input`: the same layout without the splits.
    pub fn of_repaired(repaired: &'a RepairedInput, on_input: &OnInput) -> FlatSurface<'a> {
        let (r, mesh) = (&repaired.refinement, repaired.mesh());
        let seam: BTreeMap<HalfedgeId, usize> = numbered(&on_input.cut.segments).into_iter().collect();
        let of = |h: HalfedgeId| Some((h, *seam.get(&r.halfedge(0, h)?)?));
        FlatSurface {
            mesh,
            corner_index: &repaired.corner_index,
            points: Cow::Borrowed(&repaired.coordinates),
            seams: mesh.halfedges().filter_map(of).collect(),
        }
    }

    /// A layout in E²; of one in another space the plane coordinates of its model.
    pub fn of_layout(layout: &'a Layout) -> FlatSurface<'a> {
        FlatSurface {
            mesh: layout.mesh(),
            corner_index: &layout.corner_index,
            points: Cow::Borrowed(&layout.coordinates),
            seams: numbered(&layout.cut.segments),
        }
    }

    /// A layout on the faces of the surface as it came, `mesh`.
    pub fn of_input(mesh: &'a Mesh, on_input: &'a OnInput) -> FlatSurface<'a> {
        FlatSurface {
            mesh,
            corner_index: &on_input.corner_index,
            points: Cow::Borrowed(&on_input.coordinates),
            seams: numbered(&on_input.cut.segments),
        }
    }

    /// The mesh with its points at (x, y, 0); its vertices are the points of the opened surface.
    pub fn soup(&self) -> Soup {
        let positions = self.points.iter().map(|&[x, y]| [x, y, 0.0]).collect();
        let corners = |f| self.mesh.face_halfedges(f).map(|h| self.corner_index[h]);
        Soup::new(positions, self.mesh.faces().map(corners).collect())
    }

    /// The outline of the opened surface, in lines of the boundary and of the sides of seams, with the surface on their left; and the edges
    /// that `is_fold` names. A loop of the boundary that no seam meets is one closed line.
    pub fn sheet(&self, is_fold: impl Fn(EdgeId) -> bool) -> CuttingSheet {
        let mut part = PerEdge::filled(self.mesh.n_edges(), None);
        self.seams.iter().for_each(|&(h, k)| part[h.edge()] = Some((h, k as u32)));
        let is_outline = |e: EdgeId| part[e].is_some() || self.mesh.is_boundary_edge(e);
        let mut lines = self.outline(&part);
        let folds = self.mesh.edges().filter(|&e| !is_outline(e) && is_fold(e));
        let ends = |e: EdgeId| {
            let h = e.halfedge();
            [self.corner_index[h], self.corner_index[self.mesh.next(h)]]
        };
        let fold =
            |(points, is_closed)| SheetLine { layer: SheetLayer::Folds, seam: None, points, is_closed };
        lines.extend(joined(folds.map(ends)).into_iter().map(fold));
        CuttingSheet { points: self.points.to_vec(), lines }
    }

    /// Writes [`FlatSurface::sheet`] for a name that ends in .svg or .dxf, and else [`FlatSurface::soup`] in the format of the name.
    ///
    /// # Errors
    /// Those of [`io::write`], [`io::write_svg`] and [`io::write_dxf`].
    pub fn write(&self, path: &Path, is_fold: impl Fn(EdgeId) -> bool, unit: SheetUnit) -> Result<()> {
        match path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).as_deref() {
            Some("svg") => io::write_svg(path, &self.sheet(is_fold), unit),
            Some("dxf") => io::write_dxf(path, &self.sheet(is_fold), unit),
            _ => io::write(path, &self.soup()).map(drop),
        }
    }

    fn outline(&self, seam: &PerEdge<Option<(HalfedgeId, u32)>>) -> Vec<SheetLine> {
        let mesh = self.mesh;
        let part = |h: HalfedgeId| match seam[h.edge()] {
            _ if mesh.is_outside(h.twin()) => Some(OutlinePart::Boundary),
            Some((left, k)) => Some(if left == h { OutlinePart::Left(k) } else { OutlinePart::Right(k) }),
            None => None,
        };
        // The next half-edge of the outline is the first one around the tip that bounds the opened surface.
        let next = |h: HalfedgeId| {
            let mut g = mesh.next(h);
            while part(g).is_none() {
                g = mesh.next(g.twin());
            }
            g
        };
        let (mut seen, mut lines) = (PerHalfedge::filled(mesh.n_halfedges(), false), Vec::new());
        for start in mesh.halfedges().filter(|&h| !mesh.is_outside(h)) {
            if seen[start] || part(start).is_none() {
                continue;
            }
            let mut walk = vec![start];
            seen[start] = true;
            let mut h = next(start);
            while h != start {
                seen[h] = true;
                walk.push(h);
                h = next(h);
            }
            self.add_lines(&walk, &part, &mut lines);
        }
        lines
    }

    /// Divide a closed walk around the opened surface where it comes to another part of the outline.
    fn add_lines(
        &self,
        walk: &[HalfedgeId],
        part: &impl Fn(HalfedgeId) -> Option<OutlinePart>,
        lines: &mut Vec<SheetLine>,
    ) {
        let n = walk.len();
        let begins = |&i: &usize| part(walk[i]) != part(walk[(i + n - 1) % n]);
        let starts: Vec<usize> = (0..n).filter(begins).collect();
        let is_closed = starts.is_empty();
        let starts = if is_closed { vec![0] } else { starts };
        for (k, &first) in starts.iter().enumerate() {
            let end = starts.get(k + 1).copied().unwrap_or(starts[0] + n);
            let mut points: Vec<u32> = (first..end).map(|i| self.corner_index[walk[i % n]]).collect();
            if !is_closed {
                points.push(self.corner_index[self.mesh.next(walk[(end + n - 1) % n])]);
            }
            let (layer, seam) = match part(walk[first]) {
                Some(OutlinePart::Left(k) | OutlinePart::Right(k)) => (SheetLayer::Seams, Some(k)),
                _ => (SheetLayer::Boundary, None),
            };
            lines.push(SheetLine { layer, seam, points, is_closed });
        }
    }
}

/// Segments joined into lines, which end where not just two segments meet; true for closed lines, which do not repeat their first point.
fn joined(segments: impl Iterator<Item = [u32; 2]>) -> Vec<(Vec<u32>, bool)> {
    let segments: Vec<[u32; 2]> = segments.collect();
    let mut at: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (i, ends) in segments.iter().enumerate() {
        ends.iter().for_each(|&p| at.entry(p).or_default().push(i));
    }
    // From the ends of lines first, then around what is closed.
    let forks = at.iter().filter(|(_, around)| around.len() != 2);
    let forks = forks.flat_map(|(&p, around)| around.iter().map(move |&i| (p, i)));
    let starts = forks.chain(segments.iter().enumerate().map(|(i, ends)| (ends[0], i)));
    let (mut used, mut lines) = (vec![false; segments.len()], Vec::new());
    for (from, first) in starts {
        let (mut line, mut next) = (vec![from], (!used[first]).then_some(first));
        while let Some(i) = next {
            used[i] = true;
            let [a, b] = segments[i];
            let end = if line.last() == Some(&a) { b } else { a };
            line.push(end);
            let around = &at[&end];
            next = around.iter().copied().find(|&j| !used[j]).filter(|_| around.len() == 2);
        }
        let is_closed = line.len() > 2 && line.first() == line.last();
        line.truncate(line.len() - usize::from(is_closed));
        lines.extend((line.len() > 1).then_some((line, is_closed)));
    }
    lines
}
