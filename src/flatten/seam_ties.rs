//! The points of an opened surface in free unknowns: the two sides of each seam stay a rotation by a multiple of 90° and a translation of
//! each other, whatever the unknowns are.
//!
//! An edge of the cut has the rotation `iᵏ` and an unknown translation t: its right side is `iᵏ z + t` where its left side is z. So all
//! points at a vertex of the cut follow from one of them, x, and from the translations of the edges that are crossed on the way around. Once
//! around, `x = iᵐ x + T`. If iᵐ is not 1, the vertex is a cone and `x = T/(1 − iᵐ)`; if it is, x is free and T = 0 is an equation for the
//! translations, which is solved for one of them. At a vertex of the boundary there is no way around: one of its points is free, and the others
//! follow from it.

use crate::error::{Error, Result};
use crate::geometry::complex::{Complex, add, conj, cross, dot, mul, norm2, scale, sub};
use crate::mesh::{EdgeId, HalfedgeId, Mesh, PerEdge, PerHalfedge, VertexId};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

/// Largest difference, radians, of a seam's rotation from a multiple of 90° that is rounding.
const ROTATION_ROUNDING: f64 = 1e-6;
/// Coefficients below this are 0 and rounding: those that are not are sums of units, and of quotients of such sums by each other.
const NO_COEFFICIENT: f64 = 1e-9;

/// Numbers times complex unknowns.
type Combination = BTreeMap<u32, Complex>;

/// Each point as a combination of unknowns.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SeamTies {
    /// Per point the unknowns and their coefficients, both complex.
    pub rows: Vec<Vec<(u32, Complex)>>,
    /// The number of complex unknowns.
    pub n_unknowns: usize,
    /// Per unknown a point minus iᵏ times another one, which it is; the second is none where the unknown is a point itself.
    measured: Vec<(u32, Option<(u32, Complex)>)>,
}

impl SeamTies {
    /// `corners`: per face of the mesh the points at its corners; edges of the cut are those whose sides have different points.
    ///
    /// # Errors
    /// [`Error::Layout`] for a seam whose sides are no rotation by a multiple of 90° of each other.
    pub fn new(mesh: &Mesh, corners: &[[u32; 3]], points: &[[f64; 2]]) -> Result<SeamTies> {
        let opened = OpenedMesh::new(mesh, corners, points)?;
        let mut translations = SolvedTranslations { solved: BTreeMap::new() };
        let at_vertices: Vec<_> = mesh.vertices().filter_map(|v| opened.around(v)).collect();
        for around in &at_vertices {
            if around.turn == 0 {
                translations.let_vanish(around.shift.clone());
            }
        }
        let mut ties = SeamTies { rows: vec![Vec::new(); points.len()], n_unknowns: 0, measured: Vec::new() };
        let mut is_on_cut = vec![false; points.len()];
        at_vertices.iter().flat_map(|a| &a.corners).for_each(|c| is_on_cut[c.point as usize] = true);
        for point in (0..points.len() as u32).filter(|&p| !is_on_cut[p as usize]) {
            ties.free_point(point);
        }
        let mut of_translation = BTreeMap::new();
        for around in &at_vertices {
            ties.tie(around, &opened, &mut translations, &mut of_translation);
        }
        Ok(ties)
    }

    /// A point that is an unknown of its own.
    fn free_point(&mut self, point: u32) -> u32 {
        let unknown = self.n_unknowns as u32;
        self.n_unknowns += 1;
        self.measured.push((point, None));
        self.rows[point as usize].push((unknown, [1.0, 0.0]));
        unknown
    }

    /// The points at a vertex of the cut.
    fn tie(
        &mut self,
        around: &AroundVertex,
        opened: &OpenedMesh<'_>,
        translations: &mut SolvedTranslations,
        of_translation: &mut BTreeMap<u32, u32>,
    ) {
        let root = (around.turn == 0).then(|| self.free_point(around.corners[0].point));
        let at_cone = |z: Complex| {
            let apart = sub([1.0, 0.0], quarter(around.turn));
            scale(1.0 / norm2(apart), mul(z, conj(apart)))
        };
        for (k, corner) in around.corners.iter().enumerate() {
            let mut sum = corner.shift.clone();
            if root.is_none() {
                add_times(&mut sum, at_cone(quarter(corner.turn)), &around.shift);
            }
            let row = match root {
                Some(_) if k == 0 => continue,
                Some(root) => vec![(root, quarter(corner.turn))],
                None => Vec::new(),
            };
            self.rows[corner.point as usize] = row;
            for (edge, factor) in translations.reduced(&sum) {
                let unknown = *of_translation.entry(edge).or_insert_with(|| {
                    let [left, right] = opened.tails(EdgeId(edge));
                    self.measured.push((right, Some((left, quarter(opened.turns[EdgeId(edge)])))));
                    self.n_unknowns += 1;
                    self.n_unknowns as u32 - 1
                });
                self.rows[corner.point as usize].push((unknown, factor));
            }
        }
    }

    /// The points that are tied and nearest the given ones where those are free.
    pub fn tied(&self, points: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let at = |p: u32| points[p as usize];
        let unknown = |(point, less): &(u32, Option<(u32, Complex)>)| match less {
            Some((from, factor)) => sub(at(*point), mul(*factor, at(*from))),
            None => at(*point),
        };
        self.expanded(&self.measured.iter().map(unknown).collect::<Vec<_>>())
    }

    /// The points of these unknowns.
    pub fn expanded(&self, unknowns: &[Complex]) -> Vec<[f64; 2]> {
        let sum = |row: &Vec<(u32, Complex)>| {
            row.iter().fold([0.0; 2], |sum, &(u, c)| add(sum, mul(c, unknowns[u as usize])))
        };
        self.rows.iter().map(sum).collect()
    }
}

/// iᵏ.
fn quarter(turns: i32) -> Complex {
    [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]][turns.rem_euclid(4) as usize]
}

fn add_times(sum: &mut Combination, factor: Complex, other: &Combination) {
    for (&of, &c) in other {
        let entry = sum.entry(of).or_insert([0.0; 2]);
        *entry = add(*entry, mul(factor, c));
    }
    sum.retain(|_, c| norm2(*c) > NO_COEFFICIENT * NO_COEFFICIENT);
}

/// The points at one vertex of the cut, counterclockwise.
struct AroundVertex {
    corners: Vec<TiedCorner>,
    /// Quarter turns once around; 0 at the boundary.
    turn: i32,
    /// The translation once around; 0 at the boundary.
    shift: Combination,
}

/// A point that is iᵗᵘʳⁿ x + shift, of the first point x at the vertex.
struct TiedCorner {
    point: u32,
    turn: i32,
    shift: Combination,
}

/// A mesh with the points of its corners in the plane.
struct OpenedMesh<'a> {
    mesh: &'a Mesh,
    /// Per half-edge of a face the point at its origin.
    corner: PerHalfedge<u32>,
    /// Per edge true if it is cut.
    is_cut: PerEdge<bool>,
    /// Per edge of the cut the quarter turns from the left side of its half-edge to the right one.
    turns: PerEdge<i32>,
}

impl<'a> OpenedMesh<'a> {
    fn new(mesh: &'a Mesh, corners: &[[u32; 3]], points: &[[f64; 2]]) -> Result<OpenedMesh<'a>> {
        let mut corner = PerHalfedge::filled(mesh.n_halfedges(), 0);
        for (f, points) in mesh.faces().zip(corners) {
            mesh.face_halfedges(f).into_iter().zip(points).for_each(|(h, &p)| corner[h] = p);
        }
        let mut opened = OpenedMesh {
            mesh,
            corner,
            is_cut: PerEdge::filled(mesh.n_edges(), false),
            turns: PerEdge::filled(mesh.n_edges(), 0),
        };
        for e in mesh.edges().filter(|&e| !mesh.is_boundary_edge(e)) {
            let [left, right] = opened.sides(e.halfedge());
            opened.is_cut[e] = left != right;
            if left == right {
                continue;
            }
            let [from, to] = [left, right].map(|[a, b]| sub(points[b as usize], points[a as usize]));
            let angle = cross(from, to).atan2(dot(from, to)) / FRAC_PI_2;
            let off = (angle - angle.round()).abs() * FRAC_PI_2;
            if off.is_nan() || off > ROTATION_ROUNDING {
                let why =
                    format!("the sides of edge {e} of the cut are {off:.1e} radians off a multiple of 90°");
                return Err(Error::Layout(why));
            }
            opened.turns[e] = angle.round() as i32;
        }
        Ok(opened)
    }

    /// The points at the ends of a half-edge, on its left and on its right.
    fn sides(&self, h: HalfedgeId) -> [[u32; 2]; 2] {
        let (mesh, t) = (self.mesh, h.twin());
        [[self.corner[h], self.corner[mesh.next(h)]], [self.corner[mesh.next(t)], self.corner[t]]]
    }

    /// The points at the origin of an edge's half-edge, on its left and on its right.
    fn tails(&self, e: EdgeId) -> [u32; 2] {
        self.sides(e.halfedge()).map(|side| side[0])
    }

    /// The points at a vertex, if an edge of the cut ends there.
    fn around(&self, v: VertexId) -> Option<AroundVertex> {
        let mesh = self.mesh;
        mesh.outgoing(v).find(|&h| self.is_cut[h.edge()])?;
        // At the boundary the first half-edge is the one without a face on its right.
        let at_boundary = mesh.outgoing(v).find(|&h| mesh.is_outside(h.twin()));
        let first = at_boundary.or_else(|| mesh.outgoing(v).find(|&h| self.is_cut[h.edge()]))?;
        let mut now = TiedCorner { point: self.corner[first], turn: 0, shift: Combination::new() };
        let mut corners = Vec::new();
        let mut h = first;
        loop {
            // Counterclockwise around the vertex, to the next half-edge that leaves it.
            h = mesh.prev(h).twin();
            if mesh.is_outside(h) {
                corners.push(now);
                return Some(AroundVertex { corners, turn: 0, shift: Combination::new() });
            }
            if !self.is_cut[h.edge()] {
                continue;
            }
            let next = self.across(&now, h);
            corners.push(std::mem::replace(&mut now, next));
            if h == first {
                let turn = now.turn.rem_euclid(4);
                return Some(AroundVertex { corners, turn, shift: now.shift });
            }
        }
    }

    /// The point on the left of a half-edge that leaves a vertex, from the one on its right.
    fn across(&self, right: &TiedCorner, h: HalfedgeId) -> TiedCorner {
        let (e, k) = (h.edge(), self.turns[h.edge()]);
        let own = Combination::from([(e.0, [1.0, 0.0])]);
        let mut shift = right.shift.clone();
        let turn = if h == e.halfedge() {
            // The right side is iᵏ z + t of the left one, z.
            add_times(&mut shift, [-1.0, 0.0], &own);
            shift.values_mut().for_each(|c| *c = mul(quarter(-k), *c));
            right.turn - k
        } else {
            shift.values_mut().for_each(|c| *c = mul(quarter(k), *c));
            add_times(&mut shift, [1.0, 0.0], &own);
            right.turn + k
        };
        TiedCorner { point: self.corner[h], turn, shift }
    }
}

/// Translations of edges of the cut, of which some are combinations of others.
struct SolvedTranslations {
    /// Per edge that is solved for, what it is: of edges that were free when it was solved.
    solved: BTreeMap<u32, Combination>,
}

impl SolvedTranslations {
    /// Solves `sum = 0` for one of its translations.
    fn let_vanish(&mut self, sum: Combination) {
        let sum = self.reduced(&sum);
        // The largest coefficient, the first of equal ones.
        let largest = sum.iter().fold(None, |best: Option<(u32, Complex)>, (&e, &c)| match best {
            Some((_, most)) if norm2(c) <= norm2(most) * (1.0 + NO_COEFFICIENT) => best,
            _ => Some((e, c)),
        });
        let Some((pivot, c)) = largest else { return };
        let factor = scale(-1.0 / norm2(c), conj(c));
        let others = sum.into_iter().filter(|&(e, _)| e != pivot);
        self.solved.insert(pivot, others.map(|(e, c)| (e, mul(factor, c))).collect());
    }

    /// A combination in translations that are free.
    fn reduced(&mut self, sum: &Combination) -> Combination {
        let mut found = Combination::new();
        for (&edge, &factor) in sum {
            add_times(&mut found, factor, &self.value(edge));
        }
        found
    }

    /// A translation in those that are free; kept, so that chains of solved ones are followed once.
    fn value(&mut self, edge: u32) -> Combination {
        // Edges that wait for the values of those that they consist of.
        let mut waiting = vec![edge];
        while let Some(&now) = waiting.last() {
            let Some(sum) = self.solved.get(&now) else {
                waiting.pop();
                continue;
            };
            let is_settled = |e: &u32| !self.solved.contains_key(e);
            let open: Vec<u32> = sum.keys().filter(|e| !is_settled(e)).copied().collect();
            // One whose parts are all free, or made of free ones, is replaced by what its parts are.
            let deep = open.iter().find(|e| self.solved[e].keys().any(|part| !is_settled(part)));
            if let Some(&deep) = deep {
                waiting.push(deep);
                continue;
            }
            let mut flat = Combination::new();
            for (&part, &factor) in &self.solved[&now] {
                match self.solved.get(&part) {
                    Some(of_part) => add_times(&mut flat, factor, of_part),
                    None => add_times(&mut flat, factor, &Combination::from([(part, [1.0, 0.0])])),
                }
            }
            self.solved.insert(now, flat);
            waiting.pop();
        }
        self.solved.get(&edge).cloned().unwrap_or_else(|| Combination::from([(edge, [1.0, 0.0])]))
    }
}
