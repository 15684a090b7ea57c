//! Quad layouts: the patches between the lines of edges that go straight on from the irregular vertices, the corners of features and the
//! boundary. Each patch is a rectangle of quads.

use super::quad_halfedges::QuadHalfedges;
use super::quad_mesh::QuadMesh;
use crate::archive::stored;
use crate::error::{Error, Result};
use std::collections::{BTreeMap, BTreeSet};

/// A layout of four-sided patches on a quad mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct QuadLayout {
    /// The quad mesh; each unit of the layout is [`QuadLayout::parts`] edges of it.
    pub mesh: QuadMesh,
    /// The number of edges of the mesh in one unit of length.
    pub parts: u32,
    /// The places where arcs end.
    pub nodes: Vec<LayoutNode>,
    /// The arcs between them.
    pub arcs: Vec<LayoutArc>,
    /// The patches.
    pub patches: Vec<LayoutPatch>,
}
stored!(sections QuadLayout { mesh, parts, nodes, arcs, patches });

/// A node of a layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LayoutNode {
    /// The vertex of the quad mesh.
    pub vertex: u32,
    /// The number of patches around it.
    pub valence: u32,
    /// True on features and the boundary.
    pub is_crease: bool,
}
stored!(row LayoutNode { vertex: u32, valence: u32, is_crease: bool });

/// An arc of a layout.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LayoutArc {
    /// The nodes at its ends.
    pub ends: [u32; 2],
    /// Its whole length.
    pub length: u32,
    /// True on features and the boundary.
    pub is_crease: bool,
    /// The vertices of the quad mesh along it, from the first node to the second.
    pub vertices: Vec<u32>,
}
stored!(sections LayoutArc { ends, length, is_crease, vertices });

/// A patch of a layout.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LayoutPatch {
    /// The arcs along its sides, counterclockwise: arc a as a + 1 in its direction, −(a + 1) against it.
    pub sides: [Vec<i32>; 4],
    /// The lengths of the first and the second side.
    pub size: [u32; 2],
    /// The quads of the patch.
    pub quads: Vec<u32>,
}
stored!(sections LayoutPatch { sides, size, quads });

impl QuadLayout {
    /// The layout of a quad mesh whose edges are `parts` to a unit of length.
    ///
    /// # Errors
    /// [`Error::Layout`] for quads with edges in more than two of them, and where a piece between lines is no rectangle of whole units.
    pub fn new(mesh: QuadMesh, parts: u32) -> Result<QuadLayout> {
        let QuadPatches { nodes, arcs, patches } =
            QuadPatches::new(&mesh.quads, mesh.valences(), &mesh.creases, parts)?;
        Ok(QuadLayout { parts, nodes, arcs, patches, mesh })
    }
}

/// The parts of a layout.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct QuadPatches {
    pub nodes: Vec<LayoutNode>,
    pub arcs: Vec<LayoutArc>,
    pub patches: Vec<LayoutPatch>,
}

impl QuadPatches {
    /// Those of quads whose edges are `parts` to a unit of length. `valence`: the number of quads around each vertex; `creases`: the edges of
    /// features and of the boundary.
    ///
    /// # Errors
    /// Those of [`QuadLayout::new`].
    pub fn new(
        quads: &[[u32; 4]],
        valence: Vec<u32>,
        creases: &[[u32; 2]],
        parts: u32,
    ) -> Result<QuadPatches> {
        let halfedges = QuadHalfedges::new(quads)?;
        let lines = LayoutLines::new(&halfedges, valence, creases);
        let (nodes, arcs, side) = lines.arcs(parts)?;
        let pieces = lines.pieces().into_iter();
        let patches = pieces.map(|quads| lines.patch(&arcs, &side, quads)).collect::<Result<_>>()?;
        Ok(QuadPatches { nodes, arcs, patches })
    }
}

/// The lines of a layout on the half-edges of a quad mesh.
struct LayoutLines<'a> {
    halfedges: &'a QuadHalfedges<'a>,
    creases: BTreeSet<[u32; 2]>,
    valence: Vec<u32>,
    /// True on the boundary, per vertex.
    is_border: Vec<bool>,
    /// True on both half-edges of the edges on lines.
    is_marked: Vec<bool>,
    /// True at the vertices at which arcs end.
    is_node: Vec<bool>,
}

impl<'a> LayoutLines<'a> {
    fn new(halfedges: &'a QuadHalfedges<'a>, valence: Vec<u32>, creases: &[[u32; 2]]) -> LayoutLines<'a> {
        let n = valence.len();
        let mut is_border = vec![false; n];
        for h in (0..halfedges.len()).filter(|&h| halfedges.twin(h).is_none()) {
            is_border[halfedges.origin(h) as usize] = true;
            is_border[halfedges.tip(h) as usize] = true;
        }
        let creases = creases.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
        let is_marked = vec![false; halfedges.len()];
        let mut lines =
            LayoutLines { halfedges, creases, valence, is_border, is_marked, is_node: vec![false; n] };
        lines.mark();
        lines.find_nodes();
        lines
    }

    fn is_crease(&self, h: usize) -> bool {
        let [a, b] = [self.halfedges.origin(h), self.halfedges.tip(h)];
        self.halfedges.twin(h).is_none() || self.creases.contains(&[a.min(b), a.max(b)])
    }

    fn is_regular(&self, v: u32) -> bool {
        let v = v as usize;
        self.valence[v] == if self.is_border[v] { 2 } else { 4 }
    }

    fn mark_edge(&mut self, h: usize) {
        self.is_marked[h] = true;
        if let Some(twin) = self.halfedges.twin(h) {
            self.is_marked[twin] = true;
        }
    }

    /// Marks the edges of creases, and of the lines that go straight on from vertices where other than two creases in line meet, or that are
    /// irregular; then those of the lines through a vertex of each piece that has no corner.
    fn mark(&mut self) {
        let halfedges = self.halfedges;
        let mut crease_ends: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        let on_creases: Vec<usize> = (0..halfedges.len()).filter(|&h| self.is_crease(h)).collect();
        for h in on_creases {
            self.mark_edge(h);
            crease_ends.entry(halfedges.origin(h)).or_default().push(h);
        }
        let is_start = |v: u32| {
            if !self.is_regular(v) {
                return true;
            }
            // On the boundary a crease inside ends or begins; inside a single crease ends, two turn, or more meet.
            match crease_ends.get(&v).map(Vec::as_slice) {
                None => false,
                Some(_) if self.is_border[v as usize] => {
                    crease_ends[&v].iter().any(|&h| halfedges.twin(h).is_some())
                }
                Some(&[a, b]) => {
                    let back = halfedges.twin(a);
                    back.and_then(|back| halfedges.straight(back)) != Some(b)
                }
                Some(_) => true,
            }
        };
        let starts: Vec<usize> = (0..halfedges.len()).filter(|&h| is_start(halfedges.origin(h))).collect();
        starts.into_iter().for_each(|start| self.mark_line(start));
        while let Some(v) = self.cornerless_vertex() {
            let starts = (0..halfedges.len()).filter(|&h| halfedges.origin(h) == v);
            starts.for_each(|start| self.mark_line(start));
        }
    }

    /// Marks the edges straight on from a half-edge up to an irregular vertex, the boundary, or its own beginning.
    fn mark_line(&mut self, start: usize) {
        let halfedges = self.halfedges;
        let mut at = Some(start);
        while let Some(h) = at {
            self.mark_edge(h);
            let v = halfedges.tip(h);
            let is_over = !self.is_regular(v) || self.is_border[v as usize] || v == halfedges.origin(start);
            at = if is_over { None } else { halfedges.straight(h) };
        }
    }

    /// A vertex of a piece between lines that has no corner, if there is such a piece.
    fn cornerless_vertex(&self) -> Option<u32> {
        let pieces = self.pieces();
        let piece = pieces.iter().find(|piece| self.corner(piece).is_none())?;
        Some(self.halfedges.origin(4 * piece[0] as usize))
    }

    /// A half-edge of a piece that begins at one of its corners.
    fn corner(&self, quads: &[u32]) -> Option<usize> {
        // The half-edge before that around its quad is marked too.
        let before = |h: usize| h - h % 4 + (h + 3) % 4;
        let mut all = quads.iter().flat_map(|&q| 4 * q as usize..4 * q as usize + 4);
        all.find(|&h| self.is_marked[h] && self.is_marked[before(h)])
    }

    /// Nodes are the vertices where lines cross, end or turn.
    fn find_nodes(&mut self) {
        let halfedges = self.halfedges;
        let mut marked = vec![0u32; self.is_node.len()];
        for h in (0..halfedges.len()).filter(|&h| self.is_marked[h]) {
            marked[halfedges.origin(h) as usize] += 1;
            if halfedges.twin(h).is_none() {
                marked[halfedges.tip(h) as usize] += 1;
            }
        }
        for v in 0..self.is_node.len() {
            let is_plain = self.is_regular(v as u32) && (marked[v] == 0 || marked[v] == 2);
            self.is_node[v] = !is_plain;
        }
    }

    /// The nodes, the arcs, and per half-edge on a line its arc: a + 1 in its direction, −(a + 1) against it.
    fn arcs(&self, parts: u32) -> Result<(Vec<LayoutNode>, Vec<LayoutArc>, Vec<i32>)> {
        let halfedges = self.halfedges;
        let mut number = BTreeMap::new();
        let mut nodes = Vec::new();
        for v in (0..self.is_node.len()).filter(|&v| self.is_node[v]) {
            number.insert(v as u32, nodes.len() as u32);
            nodes.push(LayoutNode { vertex: v as u32, valence: self.valence[v], is_crease: false });
        }
        let (mut arcs, mut side) = (Vec::new(), vec![0; halfedges.len()]);
        for first in (0..halfedges.len()).filter(|&h| self.is_marked[h]) {
            if side[first] != 0 || !self.is_node[halfedges.origin(first) as usize] {
                continue;
            }
            let arc = arcs.len() as i32 + 1;
            let is_crease = self.is_crease(first);
            let mut vertices = vec![halfedges.origin(first)];
            let mut h = first;
            loop {
                side[h] = arc;
                if let Some(twin) = halfedges.twin(h) {
                    side[twin] = -arc;
                }
                let v = halfedges.tip(h);
                vertices.push(v);
                if self.is_node[v as usize] {
                    break;
                }
                let next = if self.is_border[v as usize] { Some(halfedges.next(h)) } else { None };
                // Along the boundary the line stays on it; inside it goes straight on.
                let straight =
                    next.filter(|&n| halfedges.twin(n).is_none()).or_else(|| halfedges.straight(h));
                let Some(straight) = straight.filter(|&n| side[n] == 0) else {
                    return Err(Error::Layout(format!("a line of the layout ends at vertex {v}")));
                };
                h = straight;
            }
            let edges = vertices.len() as u32 - 1;
            let ends = [vertices[0], vertices[edges as usize]].map(|v| number[&v]);
            if is_crease {
                ends.iter().for_each(|&k| nodes[k as usize].is_crease = true);
            }
            arcs.push(LayoutArc { ends, length: edges / parts, is_crease, vertices });
        }
        Ok((nodes, arcs, side))
    }

    /// The quads of the pieces between lines.
    fn pieces(&self) -> Vec<Vec<u32>> {
        let halfedges = self.halfedges;
        let n = halfedges.len() / 4;
        let mut is_done = vec![false; n];
        let mut pieces = Vec::new();
        for first in 0..n {
            if std::mem::replace(&mut is_done[first], true) {
                continue;
            }
            let mut quads = vec![first as u32];
            let mut k = 0;
            while k < quads.len() {
                let q = quads[k] as usize;
                k += 1;
                for h in 4 * q..4 * q + 4 {
                    if let Some(twin) = halfedges.twin(h).filter(|_| !self.is_marked[h])
                        && !std::mem::replace(&mut is_done[twin / 4], true)
                    {
                        quads.push((twin / 4) as u32);
                    }
                }
            }
            pieces.push(quads);
        }
        pieces
    }

    /// The sides of a patch with these quads.
    fn patch(&self, arcs: &[LayoutArc], side: &[i32], quads: Vec<u32>) -> Result<LayoutPatch> {
        let halfedges = self.halfedges;
        let no_rectangle = || Error::Layout(format!("the piece of quad {} is no rectangle", quads[0]));
        let first = self.corner(&quads).ok_or_else(no_rectangle)?;
        let mut sides: [Vec<i32>; 4] = Default::default();
        let (mut h, mut k) = (first, 0);
        loop {
            if sides[k].last() != Some(&side[h]) || self.is_node[halfedges.origin(h) as usize] {
                sides[k].push(side[h]);
            }
            let left = halfedges.next(h);
            if self.is_marked[left] {
                k += 1;
                h = left;
            } else {
                h = halfedges.straight(h).ok_or_else(no_rectangle)?;
            }
            if h == first {
                break;
            }
            if k > 3 {
                return Err(no_rectangle());
            }
        }
        let length =
            |k: usize| sides[k].iter().map(|a| arcs[a.unsigned_abs() as usize - 1].length).sum::<u32>();
        let size = [length(0), length(1)];
        if k != 4 || size != [length(2), length(3)] {
            return Err(no_rectangle());
        }
        Ok(LayoutPatch { sides, size, quads })
    }
}
