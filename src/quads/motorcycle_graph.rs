//! The motorcycle graph: from cones and corners, lines along the axes that all grow at the same speed, until each meets another or a wall
//! \[EGKT08\]. Everything is exact: lines keep one whole coordinate, and they meet at whole points.

use super::grid_surface::{GridSurface, VertexSlot};
use super::grid_vector::{Axis, GridPoint, cross, opposite, unit};
use super::line_heading::{LineHeading, LinePlace};
use super::t_mesh_node::{NodeKey, NodeSlots};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::{FaceId, HalfedgeId, VertexId};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Steps from triangle to triangle between two checks of the control.
const STEPS_PER_CHECK: usize = 4096;
/// Most steps, per triangle and line: lines that meet nothing for so long are an error and not a loop.
const MOST_STEPS: usize = 1000;

/// A line of the motorcycle graph.
#[derive(Debug, Clone)]
pub(super) struct TracedLine {
    /// The vertex that it leaves, and in which of the directions there.
    pub origin: (VertexId, usize),
    /// Places where other lines end at it: its length there, the node, and the direction at the node from which it comes.
    pub passes: Vec<LineStop>,
    /// Its end.
    pub end: Option<LineStop>,
}

/// A place of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct LineStop {
    /// The length of the line up to here.
    pub length: i128,
    /// The place.
    pub node: NodeKey,
    /// The direction at the node that leads back along the line.
    pub back: usize,
}

/// A line in one triangle.
#[derive(Debug, Clone, Copy)]
struct LineSpan {
    line: usize,
    heading: LineHeading,
}

/// A line's arrival at a vertex.
struct VertexArrival {
    /// A half-edge from the vertex.
    halfedge: HalfedgeId,
    /// The vertex in the coordinates of the line.
    at: GridPoint,
    /// The direction back along the line, in the coordinates of the half-edge's face.
    back: Axis,
}

/// Events in the order in which they happen; those that start something come before those that end something at the same time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum GrowthEvent {
    /// A line comes to a triangle.
    Enter { line: usize, heading: LineHeading },
    /// A line comes to a vertex, from this direction.
    Arrive { line: usize, vertex: VertexId, back: usize },
    /// A line ends at a wall.
    Wall { line: usize, stop: LineStop },
    /// A line ends at a place of another.
    Meet { line: usize, stop: LineStop, other: usize, passed: LineStop },
}

/// The growth of all lines.
struct LineGrowth<'a> {
    surface: &'a GridSurface,
    lines: Vec<TracedLine>,
    events: BinaryHeap<Reverse<(i128, GrowthEvent)>>,
    spans: BTreeMap<FaceId, Vec<LineSpan>>,
    /// Lines that came through a vertex, with their lengths there and the directions from which they came.
    visits: BTreeMap<VertexId, Vec<(usize, i128, usize)>>,
}

/// Grows all lines from these directions at vertices to their ends.
///
/// # Errors
/// [`Error::Layout`] where a line meets nothing for too long; [`Error::Cancelled`].
pub(super) fn grow_lines(
    surface: &GridSurface,
    starts: &[(VertexId, usize)],
    control: &Control,
) -> Result<Vec<TracedLine>> {
    let mut growth = LineGrowth {
        surface,
        lines: Vec::new(),
        events: BinaryHeap::new(),
        spans: BTreeMap::new(),
        visits: BTreeMap::new(),
    };
    for &(v, slot) in starts {
        let line = growth.lines.len();
        growth.lines.push(TracedLine { origin: (v, slot), passes: Vec::new(), end: None });
        growth.leave_vertex(line, surface.slots(v)[slot], 0);
    }
    let most = (surface.mesh.n_faces() + 1).saturating_mul(MOST_STEPS);
    let mut steps = 0;
    while let Some(Reverse((time, event))) = growth.events.pop() {
        steps += 1;
        if steps % STEPS_PER_CHECK == 0 {
            control.check()?;
        }
        if steps > most {
            return Err(Error::Layout(format!(
                "lines of the motorcycle graph do not end after {most} steps"
            )));
        }
        growth.handle(time, event)?;
    }
    Ok(growth.lines)
}

impl LineGrowth<'_> {
    fn handle(&mut self, time: i128, event: GrowthEvent) -> Result<()> {
        match event {
            GrowthEvent::Enter { line, heading } => {
                if self.is_alive(line) {
                    self.enter(line, heading)?;
                }
            }
            GrowthEvent::Arrive { line, vertex, back } => {
                if self.is_alive(line) {
                    self.arrive(line, vertex, back, time);
                }
            }
            GrowthEvent::Wall { line, stop } => {
                if self.is_alive(line) {
                    self.lines[line].end = Some(stop);
                }
            }
            GrowthEvent::Meet { line, stop, other, passed } => {
                let is_there = self.lines[other].end.is_none_or(|end| end.length >= passed.length);
                if self.is_alive(line) && is_there {
                    self.lines[line].end = Some(stop);
                    self.lines[other].passes.push(passed);
                }
            }
        }
        Ok(())
    }

    fn is_alive(&self, line: usize) -> bool {
        self.lines[line].end.is_none()
    }

    fn push(&mut self, time: i128, event: GrowthEvent) {
        self.events.push(Reverse((time, event)));
    }

    /// Lets a line leave a vertex at this length.
    fn leave_vertex(&mut self, line: usize, slot: VertexSlot, length: i128) {
        let at = self.surface.origin(slot.halfedge);
        let heading = LineHeading::from_point(at, slot.axis, length, LinePlace::Vertex(slot.halfedge));
        self.push(length, GrowthEvent::Enter { line, heading });
    }

    /// Follows a line through a triangle.
    fn enter(&mut self, line: usize, heading: LineHeading) -> Result<()> {
        let surface = self.surface;
        let mesh = &surface.mesh;
        let h = heading.place.halfedge();
        let face = |h: HalfedgeId| {
            mesh.face(h)
                .ok_or_else(|| Error::Layout(format!("a line leaves the surface at edge {}", h.edge())))
        };
        let f = face(h)?;
        self.register(f, LineSpan { line, heading });
        let exit = match heading.place {
            LinePlace::Vertex(_) if surface.axis_along(h) == Some(heading.axis) => {
                let across = surface.across(h);
                let twin = h.twin();
                self.register(
                    face(twin)?,
                    LineSpan { line, heading: heading.moved(&across, LinePlace::Edge(twin)) },
                );
                let back = across.turn(opposite(heading.axis));
                self.come_to_vertex(
                    line,
                    &heading,
                    VertexArrival { halfedge: twin, at: surface.tip(h), back },
                );
                return Ok(());
            }
            LinePlace::Vertex(_) => mesh.next(h),
            LinePlace::Edge(_) => {
                let apex = mesh.prev(h);
                let at = surface.origin(apex);
                match cross(unit(heading.axis), heading.offset_of(at)) {
                    0 => {
                        let back = opposite(heading.axis);
                        self.come_to_vertex(line, &heading, VertexArrival { halfedge: apex, at, back });
                        return Ok(());
                    }
                    left if left > 0 => mesh.next(h),
                    _ => apex,
                }
            }
        };
        if surface.is_wall[exit.edge()] {
            let point = heading.point_at(surface.origin(exit)[heading.moving()]);
            let (node, turns) = NodeKey::on_edge(surface, exit, point);
            let back = node.slots(surface).of_axis(opposite(heading.axis) + turns);
            let length = heading.length_at(point);
            self.push(length, GrowthEvent::Wall { line, stop: LineStop { length, node, back } });
            return Ok(());
        }
        let time = heading.floor_of_crossing(surface.origin(exit), surface.tip(exit));
        let heading = heading.moved(&surface.across(exit), LinePlace::Edge(exit.twin()));
        self.push(time, GrowthEvent::Enter { line, heading });
        Ok(())
    }

    /// A line comes to a vertex.
    fn come_to_vertex(&mut self, line: usize, heading: &LineHeading, arrival: VertexArrival) {
        let VertexArrival { halfedge, at, back } = arrival;
        let vertex = self.surface.mesh.origin(halfedge);
        let slots = self.surface.slots(vertex);
        if let Some(back) = slots.iter().position(|slot| slot.halfedge == halfedge && slot.axis == back) {
            self.push(heading.length_at(at), GrowthEvent::Arrive { line, vertex, back });
        }
    }

    /// A line is at a vertex: it ends at cones and walls.
    fn arrive(&mut self, line: usize, vertex: VertexId, back: usize, length: i128) {
        let node = NodeKey::Vertex(vertex);
        let stop = LineStop { length, node, back };
        let slots = self.surface.slots(vertex);
        let is_origin = self.lines.iter().any(|other| other.origin.0 == vertex);
        if slots.len() != 4 || is_origin || slots.iter().any(|slot| slot.is_wall) {
            self.lines[line].end = Some(stop);
            return;
        }
        for (other, at, from) in self.visits.get(&vertex).cloned().unwrap_or_default() {
            let passed = LineStop { length: at, node, back: from };
            self.meet((line, stop), (other, passed), (from + 2) % 4 == back);
        }
        self.visits.entry(vertex).or_default().push((line, length, back));
        self.leave_vertex(line, slots[(back + 2) % 4], length);
    }

    /// Two lines share a place: the later one ends there, both where they come from opposite sides.
    fn meet(&mut self, a: (usize, LineStop), b: (usize, LineStop), is_head_on: bool) {
        if is_head_on {
            if a.1.length == b.1.length {
                for ((line, stop), (other, passed)) in [(a, b), (b, a)] {
                    self.push(stop.length, GrowthEvent::Meet { line, stop, other, passed });
                }
            }
            return;
        }
        let is_first_later = (a.1.length, a.0) > (b.1.length, b.0);
        let ((line, stop), (other, passed)) = if is_first_later { (a, b) } else { (b, a) };
        self.push(stop.length, GrowthEvent::Meet { line, stop, other, passed });
    }

    /// Notes a line in a triangle, with all places there that it shares with others.
    fn register(&mut self, f: FaceId, span: LineSpan) {
        let others = self.spans.get(&f).cloned().unwrap_or_default();
        for other in others {
            let (a, b) = (&span.heading, &other.heading);
            let is_head_on = a.axis == opposite(b.axis) && a.fixed == b.fixed;
            let point = if a.moving() != b.moving() {
                a.point_at(b.fixed)
            } else if is_head_on {
                a.meeting_point(b)
            } else {
                continue;
            };
            if let Some((node, turns)) = NodeKey::in_face(self.surface, f, point) {
                let slots: NodeSlots = node.slots(self.surface);
                let stop = |heading: &LineHeading| {
                    let back = slots.of_axis(opposite(heading.axis) + turns);
                    LineStop { length: heading.length_at(point), node, back }
                };
                self.meet((span.line, stop(a)), (other.line, stop(b)), is_head_on);
            }
        }
        self.spans.entry(f).or_default().push(span);
    }
}

/// The directions in which lines start: from cones, and from corners, ends and junctions of walls those inside of more than two right
/// angles; from the seeds all.
pub(super) fn starts(surface: &GridSurface, seeds: &[VertexId]) -> Vec<(VertexId, usize)> {
    let mut starts = Vec::new();
    for v in surface.mesh.vertices() {
        let slots = surface.slots(v);
        let is_open = surface.mesh.is_boundary_vertex(v);
        let walls: Vec<usize> = (0..slots.len()).filter(|&k| slots[k].is_wall).collect();
        if seeds.contains(&v) {
            starts.extend((0..slots.len()).filter(|k| !slots[*k].is_wall).map(|k| (v, k)));
            continue;
        }
        let n = slots.len();
        let Some(&first) = walls.first() else {
            if n != 4 {
                starts.extend((0..n).map(|k| (v, k)));
            }
            continue;
        };
        let ends = walls.iter().copied().skip(1).chain((!is_open).then_some(first + n));
        for (&from, to) in walls.iter().zip(ends) {
            if to - from > 2 {
                starts.extend((from + 1..to).map(|k| (v, k % n)));
            }
        }
    }
    starts
}
