//! T-meshes: the surface divided into rectangles by the lines of the motorcycle graph and walls. Sides of rectangles consist of arcs between
//! nodes, and opposite sides have the same length exactly.

use super::grid_surface::GridSurface;
use super::grid_vector::{doubled_area, opposite};
use super::motorcycle_graph::{LineStop, TracedLine, grow_lines, starts};
use super::t_mesh_node::{NodeKey, first_halfedge};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::{EdgeId, VertexId};
use std::collections::BTreeMap;

/// An arc with a direction: 2a leaves the first end of arc a, 2a + 1 the second.
pub(super) type HalfArc = usize;

/// An arc between two nodes, parallel to an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct TArc {
    /// The nodes at its ends, and the direction at each in which it leaves.
    pub ends: [(usize, usize); 2],
    /// Its length in units of the grid.
    pub length: i128,
    /// True on features and the boundary.
    pub is_wall: bool,
}

/// A rectangle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct TRectangle {
    /// The arcs along its sides, counterclockwise.
    pub sides: [Vec<HalfArc>; 4],
    /// The lengths of the first and the second side.
    pub size: [i128; 2],
}

/// A T-mesh.
#[derive(Debug, Clone)]
pub(super) struct TMesh {
    pub nodes: Vec<NodeKey>,
    pub arcs: Vec<TArc>,
    pub rectangles: Vec<TRectangle>,
}

/// The half-arcs around each node by direction.
struct NodeStar {
    arcs: Vec<Option<HalfArc>>,
    is_closed: bool,
}

impl NodeStar {
    fn len(&self) -> usize {
        self.arcs.len()
    }
}

/// Nodes and arcs that are being put together.
struct TMeshGraph {
    number: BTreeMap<NodeKey, usize>,
    nodes: Vec<NodeKey>,
    stars: Vec<NodeStar>,
    arcs: Vec<TArc>,
}

/// A face of the graph: its half-arcs counterclockwise, each with the right angles, from 1, between it and the next.
type FaceWalk = Vec<(HalfArc, usize)>;

impl TMesh {
    /// The T-mesh of a surface. Pieces of the surface without corners get lines from a vertex in all directions.
    ///
    /// # Errors
    /// [`Error::Layout`] where pieces are no rectangles; those of [`grow_lines`].
    pub fn new(surface: &GridSurface, control: &Control) -> Result<TMesh> {
        let mut seeds: Vec<VertexId> = Vec::new();
        loop {
            let lines = grow_lines(surface, &starts(surface, &seeds), control)?;
            let mut graph = TMeshGraph::new(surface, &lines)?;
            if graph.arcs.is_empty() {
                seeds.push(VertexId(0));
                continue;
            }
            if let Some(seed) = graph.cornerless_vertex()? {
                if seeds.contains(&seed) {
                    return Err(Error::Layout(format!(
                        "lines from vertex {seed} leave a piece without corners"
                    )));
                }
                seeds.push(seed);
                continue;
            }
            graph.dissolve_straight_nodes();
            return graph.into_t_mesh(surface);
        }
    }

    /// The node that a half-arc leaves.
    pub fn origin(&self, h: HalfArc) -> usize {
        self.arcs[h / 2].ends[h % 2].0
    }

    /// The node to which a half-arc leads.
    pub fn tip(&self, h: HalfArc) -> usize {
        self.origin(h ^ 1)
    }
}

impl TMeshGraph {
    fn new(surface: &GridSurface, lines: &[TracedLine]) -> Result<TMeshGraph> {
        let mut graph =
            TMeshGraph { number: BTreeMap::new(), nodes: Vec::new(), stars: Vec::new(), arcs: Vec::new() };
        let mut on_edge: BTreeMap<EdgeId, Vec<NodeKey>> = BTreeMap::new();
        for line in lines {
            let Some(end) = line.end else {
                return Err(Error::Layout(format!("the line from vertex {} has no end", line.origin.0)));
            };
            let mut stops: Vec<LineStop> = line.passes.clone();
            stops.retain(|stop| stop.length < end.length);
            stops.push(end);
            stops.sort_unstable();
            stops.dedup();
            let mut from = (graph.node(surface, NodeKey::Vertex(line.origin.0)), line.origin.1);
            let mut length = 0;
            for stop in stops {
                let node = graph.node(surface, stop.node);
                graph.add(TArc {
                    ends: [from, (node, stop.back)],
                    length: stop.length - length,
                    is_wall: false,
                })?;
                from = (node, (stop.back + 2) % 4);
                length = stop.length;
            }
            if let NodeKey::Edge(e, _) = end.node
                && surface.is_wall[e]
            {
                on_edge.entry(e).or_default().push(end.node);
            }
        }
        for e in surface.mesh.edges().filter(|&e| surface.is_wall[e]) {
            graph.add_wall(surface, e, on_edge.remove(&e).unwrap_or_default())?;
        }
        Ok(graph)
    }

    /// Adds the arcs along a wall, on which lines end at these nodes.
    fn add_wall(&mut self, surface: &GridSurface, e: EdgeId, mut ends: Vec<NodeKey>) -> Result<()> {
        let mesh = &surface.mesh;
        let h = first_halfedge(surface, e);
        let Some(axis) = surface.axis_along(h) else { return Ok(()) };
        let along = usize::from(axis % 2);
        let sign = if axis < 2 { 1 } else { -1 };
        let position = |node: &NodeKey| match node {
            NodeKey::Edge(_, point) => sign * point[along],
            _ => 0,
        };
        ends.sort_unstable_by_key(position);
        ends.dedup();
        let slot = |v: VertexId, wanted: &dyn Fn(usize) -> bool| {
            let found = (0..surface.slots(v).len()).find(|&k| wanted(k));
            found.ok_or_else(|| Error::Layout(format!("edge {e} does not lie along an axis at vertex {v}")))
        };
        let [a, b] = [mesh.origin(h), mesh.tip(h)];
        let (at_a, at_b) = (surface.slots(a), surface.slots(b));
        let first = slot(a, &|k| at_a[k].halfedge == h && at_a[k].axis == axis)?;
        let last = if mesh.is_boundary_edge(e) {
            at_b.len().saturating_sub(1)
        } else {
            let back = surface.across(h).turn(opposite(axis));
            slot(b, &|k| at_b[k].halfedge == h.twin() && at_b[k].axis == back)?
        };
        let mut from = (self.node(surface, NodeKey::Vertex(a)), first);
        let mut at = sign * surface.origin(h)[along];
        for node in ends {
            let slots = node.slots(surface);
            let number = self.node(surface, node);
            let next = position(&node);
            let to = (number, slots.of_axis(opposite(axis)));
            self.add(TArc { ends: [from, to], length: i128::from(next - at), is_wall: true })?;
            from = (number, slots.of_axis(axis));
            at = next;
        }
        let to = (self.node(surface, NodeKey::Vertex(b)), last);
        let length = i128::from(sign * surface.tip(h)[along] - at);
        self.add(TArc { ends: [from, to], length, is_wall: true })
    }

    /// The number of a node.
    fn node(&mut self, surface: &GridSurface, key: NodeKey) -> usize {
        if let Some(&known) = self.number.get(&key) {
            return known;
        }
        let (n, is_closed) = match key {
            NodeKey::Vertex(v) => (surface.slots(v).len(), !surface.mesh.is_boundary_vertex(v)),
            _ => {
                let slots = key.slots(surface);
                (slots.len(), slots.is_closed)
            }
        };
        let number = self.nodes.len();
        self.number.insert(key, number);
        self.nodes.push(key);
        self.stars.push(NodeStar { arcs: vec![None; n], is_closed });
        number
    }

    fn add(&mut self, arc: TArc) -> Result<()> {
        for (end, (node, slot)) in arc.ends.into_iter().enumerate() {
            let place = self.stars[node].arcs.get_mut(slot);
            match place {
                Some(free @ None) => *free = Some(2 * self.arcs.len() + end),
                _ => {
                    let place = self.nodes[node];
                    return Err(Error::Layout(format!("two lines leave {place:?} in the same direction")));
                }
            }
        }
        self.arcs.push(arc);
        Ok(())
    }

    /// The next half-arc around the face to the left, and the right angles between the two; none outside of the boundary.
    fn next(&self, h: HalfArc) -> Option<(HalfArc, usize)> {
        let (node, slot) = self.arcs[h / 2].ends[1 - h % 2];
        let star = &self.stars[node];
        let n = star.len();
        (1..=n).find_map(|k| {
            let at = if star.is_closed { Some((slot + 2 * n - k) % n) } else { slot.checked_sub(k) };
            Some((star.arcs[at?]?, k))
        })
    }

    /// The faces, without the outside of the boundary.
    fn faces(&self) -> Result<Vec<FaceWalk>> {
        let is_outside = |h: HalfArc| {
            let (node, slot) = self.arcs[h / 2].ends[h % 2];
            self.arcs[h / 2].is_wall && !self.stars[node].is_closed && slot + 1 == self.stars[node].len()
        };
        let mut is_done = vec![false; 2 * self.arcs.len()];
        let mut faces = Vec::new();
        for first in 0..2 * self.arcs.len() {
            if is_done[first] || is_outside(first) {
                continue;
            }
            let mut face = FaceWalk::new();
            let mut h = first;
            while !std::mem::replace(&mut is_done[h], true) {
                let Some((next, angle)) = self.next(h) else {
                    return Err(Error::Layout("a side of a rectangle leaves the surface".into()));
                };
                if angle > 2 {
                    let node = self.nodes[self.arcs[h / 2].ends[1 - h % 2].0];
                    return Err(Error::Layout(format!("a rectangle has {angle} right angles at {node:?}")));
                }
                face.push((h, angle));
                h = next;
            }
            faces.push(face);
        }
        Ok(faces)
    }

    /// A vertex on the border of a face without corners, if there is one.
    fn cornerless_vertex(&self) -> Result<Option<VertexId>> {
        for face in self.faces()? {
            if face.iter().all(|(_, angle)| *angle != 1) {
                let vertex =
                    face.iter().find_map(|(h, _)| match self.nodes[self.arcs[h / 2].ends[h % 2].0] {
                        NodeKey::Vertex(v) => Some(v),
                        _ => None,
                    });
                return match vertex {
                    Some(v) => Ok(Some(v)),
                    None => Err(Error::Layout("a piece without corners has no vertex on its border".into())),
                };
            }
        }
        Ok(None)
    }

    /// Joins the two arcs at nodes where nothing else ends and that are regular.
    fn dissolve_straight_nodes(&mut self) {
        let mut is_gone = vec![false; self.arcs.len()];
        for node in 0..self.nodes.len() {
            let star = &self.stars[node];
            let regular = if star.is_closed { 4 } else { 3 };
            let used: Vec<usize> = (0..star.len()).filter(|&k| star.arcs[k].is_some()).collect();
            if star.len() != regular || used.len() != 2 || used[1] - used[0] != 2 {
                continue;
            }
            let (Some(a), Some(b)) = (star.arcs[used[0]], star.arcs[used[1]]) else { continue };
            if a / 2 == b / 2 {
                continue;
            }
            // Arc b is taken into arc a.
            let (node_b, slot_b) = self.arcs[b / 2].ends[1 - b % 2];
            self.stars[node_b].arcs[slot_b] = Some(a);
            self.arcs[a / 2].ends[a % 2] = (node_b, slot_b);
            self.arcs[a / 2].length += self.arcs[b / 2].length;
            self.stars[node].arcs.fill(None);
            is_gone[b / 2] = true;
        }
        self.renumber(&is_gone);
    }

    /// Leaves out arcs that are gone and nodes without arcs.
    fn renumber(&mut self, is_gone: &[bool]) {
        let mut new_arc = vec![0; self.arcs.len()];
        let mut kept = 0;
        for (k, gone) in is_gone.iter().enumerate() {
            new_arc[k] = kept;
            kept += usize::from(!gone);
        }
        let is_used: Vec<bool> =
            self.stars.iter().map(|star| star.arcs.iter().any(Option::is_some)).collect();
        let mut new_node = vec![0; self.nodes.len()];
        let mut nodes = 0;
        for (k, used) in is_used.iter().enumerate() {
            new_node[k] = nodes;
            nodes += usize::from(*used);
        }
        let mut k = 0;
        self.nodes.retain(|_| {
            k += 1;
            is_used[k - 1]
        });
        self.stars.retain(|star| star.arcs.iter().any(Option::is_some));
        self.number.clear();
        for star in &mut self.stars {
            star.arcs.iter_mut().flatten().for_each(|h| *h = 2 * new_arc[*h / 2] + *h % 2);
        }
        let arcs = std::mem::take(&mut self.arcs);
        self.arcs = arcs.into_iter().zip(is_gone).filter(|(_, gone)| !**gone).map(|(arc, _)| arc).collect();
        for arc in &mut self.arcs {
            arc.ends.iter_mut().for_each(|(node, _)| *node = new_node[*node]);
        }
    }

    /// The T-mesh; checks that all its faces are rectangles and cover the surface.
    fn into_t_mesh(self, surface: &GridSurface) -> Result<TMesh> {
        let mut rectangles = Vec::new();
        let mut area = 0;
        for mut face in self.faces()? {
            let corners = face.iter().filter(|(_, angle)| *angle == 1).count();
            let last = face.iter().rposition(|(_, angle)| *angle == 1);
            let (4, Some(last)) = (corners, last) else {
                return Err(Error::Layout(format!("a piece between lines has {corners} corners")));
            };
            let n = face.len();
            face.rotate_left((last + 1) % n);
            let mut sides: [Vec<HalfArc>; 4] = Default::default();
            let mut side = 0;
            for (h, angle) in face {
                sides[side].push(h);
                side = (side + usize::from(angle == 1)).min(3);
            }
            let lengths =
                [0, 1, 2, 3].map(|k| sides[k].iter().map(|h| self.arcs[h / 2].length).sum::<i128>());
            if lengths[0] != lengths[2] || lengths[1] != lengths[3] {
                return Err(Error::Layout(format!("a rectangle has sides of lengths {lengths:?}")));
            }
            area += 2 * lengths[0] * lengths[1];
            rectangles.push(TRectangle { sides, size: [lengths[0], lengths[1]] });
        }
        let faces = surface.mesh.faces().map(|f| surface.corners(f));
        let whole: i128 = faces.map(|[a, b, c]| doubled_area(a, b, c)).sum();
        if whole != area {
            return Err(Error::Layout(format!("rectangles cover {area} of the area {whole}")));
        }
        Ok(TMesh { nodes: self.nodes, arcs: self.arcs, rectangles })
    }
}
