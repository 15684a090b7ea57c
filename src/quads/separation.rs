//! The test of a quantisation with arcs of length 0: no two cones, corners or walls fall together, and the surface keeps its topology.

use super::grid_complex::GridComplex;
use super::grid_surface::GridSurface;
use super::quantisation::Quantisation;
use super::t_mesh::TMesh;
use super::t_mesh_node::NodeKey;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::union_find::UnionFind;
use std::collections::{BTreeMap, BTreeSet};

/// Rounds in which arcs are made longer one by one to part edges with the same ends.
const MOST_RAISED: usize = 64;
/// Times that numbers are doubled: with four edges to each shortest arc, cones are too far apart for edges with the same ends.
const MOST_DOUBLINGS: usize = 3;

/// The nodes and arcs of a T-mesh that are to stay apart.
pub(super) struct Separation<'a> {
    pub t_mesh: &'a TMesh,
    /// Per node the number of squares around it.
    corners: Vec<u32>,
    /// True at cones, corners, and ends and junctions of walls.
    is_special: Vec<bool>,
    /// Per arc the straight piece of wall that it is a part of, if it is a wall.
    wall: Vec<Option<u32>>,
    /// Per arc true on the boundary.
    is_boundary: Vec<bool>,
}

impl<'a> Separation<'a> {
    pub fn new(surface: &GridSurface, t_mesh: &'a TMesh) -> Separation<'a> {
        let n = t_mesh.nodes.len();
        let mut at: Vec<Vec<(usize, usize)>> = vec![Vec::new(); n];
        for (a, arc) in t_mesh.arcs.iter().enumerate().filter(|(_, arc)| arc.is_wall) {
            arc.ends.iter().for_each(|&(node, slot)| at[node].push((slot, a)));
        }
        let (mut corners, mut is_special) = (vec![4; n], vec![false; n]);
        let mut lines = UnionFind::new(t_mesh.arcs.len());
        for (k, node) in t_mesh.nodes.iter().enumerate() {
            let (slots, is_open) = match node {
                NodeKey::Vertex(v) => (surface.slots(*v).len(), surface.mesh.is_boundary_vertex(*v)),
                _ => {
                    let slots = node.slots(surface);
                    (slots.len(), !slots.is_closed)
                }
            };
            corners[k] = (slots - usize::from(is_open)) as u32;
            let is_regular = slots == if is_open { 3 } else { 4 };
            let is_straight = match at[k][..] {
                [] => true,
                [(s, a), (t, b)] if s.abs_diff(t) == 2 => {
                    if is_regular {
                        lines.join(a as u32, b as u32);
                    }
                    true
                }
                _ => false,
            };
            is_special[k] = !(is_regular && is_straight);
        }
        let wall = |a: usize| t_mesh.arcs[a].is_wall.then(|| lines.root(a as u32));
        let wall = (0..t_mesh.arcs.len()).map(wall).collect();
        let mut sides = vec![0; t_mesh.arcs.len()];
        t_mesh.rectangles.iter().flat_map(|r| r.sides.iter().flatten()).for_each(|h| sides[h / 2] += 1);
        Separation { t_mesh, corners, is_special, wall, is_boundary: sides.iter().map(|&n| n < 2).collect() }
    }

    /// True for a node that is a cone or corner, or at which walls end or meet.
    pub fn is_special(&self, node: usize) -> bool {
        self.is_special[node]
    }

    /// True if the squares of these numbers form the surface with its cones and walls.
    pub fn holds(&self, numbers: &[i64]) -> bool {
        Identification::new(self.t_mesh, numbers).conflicts(self).is_empty()
    }

    /// Raises strips of arcs of length 0 until cones, corners and walls are apart.
    ///
    /// # Errors
    /// [`Error::Layout`] as [`Quantisation::balanced`]; [`Error::Cancelled`].
    pub fn enforce(&self, found: &mut Quantisation, control: &Control) -> Result<()> {
        loop {
            control.check()?;
            let same = Identification::new(self.t_mesh, &found.numbers);
            let conflicts = same.conflicts(self);
            if conflicts.is_empty() {
                return Ok(());
            }
            let mut arcs = self.arcs_to_raise(&same, &conflicts, found);
            if arcs.is_empty() {
                arcs.extend(found.longest_zero(0..found.numbers.len()));
            }
            if arcs.is_empty() {
                return Err(Error::Layout("cones fall together though no arc has the length 0".into()));
            }
            arcs.into_iter().try_for_each(|arc| found.keep_above_zero(arc))?;
        }
    }

    /// Raises strips of arcs of length 0 until no two edges of the quad mesh have the same two ends; where there are no such arcs near these
    /// edges, the shortest arcs there are made longer, and if that does not end, all numbers are doubled.
    ///
    /// # Errors
    /// [`Error::Layout`] where doubling does not help; [`Error::Cancelled`].
    pub fn enforce_single_edges(&self, found: &mut Quantisation, control: &Control) -> Result<()> {
        let (mut doublings, mut rounds) = (0, 0);
        loop {
            control.check()?;
            rounds += 1;
            let same = Identification::new(self.t_mesh, &found.numbers);
            let conflicts = same.complex.repeated_edges();
            if conflicts.is_empty() {
                return Ok(());
            }
            let arcs = self.arcs_to_raise(&same, &conflicts, found);
            if !arcs.is_empty() {
                self.raise(arcs, found, control)?;
                continue;
            }
            let shortest = same.shortest_arcs_at(&conflicts);
            if rounds < MOST_RAISED && !shortest.is_empty() {
                for (arc, number) in shortest {
                    if found.numbers[arc] == number {
                        found.make_longer(arc)?;
                    }
                }
            } else if doublings < MOST_DOUBLINGS {
                doublings += 1;
                found.numbers.iter_mut().for_each(|n| *n *= 2);
            } else {
                return Err(Error::Layout("two edges of the quad mesh have the same ends".into()));
            }
        }
    }

    /// Raises strips of arcs of length 0 at these rectangles; false where there is none.
    ///
    /// # Errors
    /// Those of [`Separation::enforce`].
    pub fn raise_near(
        &self,
        rectangles: &[usize],
        found: &mut Quantisation,
        control: &Control,
    ) -> Result<bool> {
        let same = Identification::new(self.t_mesh, &found.numbers);
        let half_arcs = rectangles.iter().flat_map(|&r| self.t_mesh.rectangles[r].sides.iter().flatten());
        let mut classes: Vec<usize> = half_arcs.map(|&h| same.root[self.t_mesh.origin(h)]).collect();
        classes.sort_unstable();
        classes.dedup();
        let arcs = self.arcs_to_raise(&same, &classes, found);
        if arcs.is_empty() {
            return Ok(false);
        }
        self.raise(arcs, found, control)?;
        Ok(true)
    }

    /// Keeps arcs above 0 from now on, with cones, corners and walls apart.
    fn raise(&self, arcs: Vec<usize>, found: &mut Quantisation, control: &Control) -> Result<()> {
        arcs.into_iter().try_for_each(|arc| found.keep_above_zero(arc))?;
        self.enforce(found, control)
    }

    /// Per class of points that is in conflict the longest arc of length 0 in it, else of a rectangle beside it.
    fn arcs_to_raise(&self, same: &Identification, conflicts: &[usize], found: &Quantisation) -> Vec<usize> {
        let mut within: BTreeMap<usize, Vec<usize>> = conflicts.iter().map(|&p| (p, Vec::new())).collect();
        let mut beside = within.clone();
        let node = |h: usize| same.root[self.t_mesh.origin(h)];
        let is_zero = |arc: &usize| found.numbers[*arc] == 0;
        for arc in (0..found.numbers.len()).filter(is_zero) {
            if let Some(arcs) = within.get_mut(&node(2 * arc)) {
                arcs.push(arc);
            }
        }
        for rectangle in &self.t_mesh.rectangles {
            let arcs = || rectangle.sides.iter().flatten().map(|h| h / 2);
            for h in rectangle.sides.iter().flatten() {
                if let Some(list) = beside.get_mut(&node(*h)) {
                    list.extend(arcs().filter(is_zero));
                }
            }
        }
        let of = |p: &usize| {
            let inside = found.longest_zero(within[p].iter().copied());
            inside.or_else(|| found.longest_zero(beside[p].iter().copied()))
        };
        let mut arcs: Vec<usize> = conflicts.iter().filter_map(of).collect();
        arcs.sort_unstable();
        arcs.dedup();
        arcs
    }
}

/// Points of nodes and arcs that fall together.
struct Identification<'a> {
    complex: GridComplex<'a>,
    numbers: &'a [i64],
    /// Per point the one that stands for its class.
    root: Vec<usize>,
}

impl<'a> Identification<'a> {
    fn new(t_mesh: &'a TMesh, numbers: &'a [i64]) -> Identification<'a> {
        let complex = GridComplex::new(t_mesh, numbers);
        let n = complex.n_arc_points;
        let mut same = complex.identified(n);
        let root = (0..n as u32).map(|p| same.root(p) as usize).collect();
        Identification { complex, numbers, root }
    }

    /// For each of these points, each standing for its class, the arc of the least number that has it, with this number.
    fn shortest_arcs_at(&self, classes: &[usize]) -> BTreeSet<(usize, i64)> {
        let mut shortest: Vec<Option<(i64, usize)>> = vec![None; classes.len()];
        for arc in (0..self.numbers.len()).filter(|&a| self.numbers[a] > 0) {
            for k in 0..=self.numbers[arc] {
                let class = self.root[self.complex.arc_point(2 * arc, k) as usize];
                let Ok(at) = classes.binary_search(&class) else { continue };
                let known = shortest[at].get_or_insert((self.numbers[arc], arc));
                *known = (*known).min((self.numbers[arc], arc));
            }
        }
        shortest.into_iter().flatten().map(|(number, arc)| (arc, number)).collect()
    }

    /// The classes that are in conflict: of two special nodes or two walls, and those in which not as many squares meet as are to.
    fn conflicts(&self, of: &Separation<'_>) -> Vec<usize> {
        let mut special: Vec<Option<usize>> = vec![None; self.root.len()];
        let mut conflicts = Vec::new();
        for k in (0..of.t_mesh.nodes.len()).filter(|&k| of.is_special[k]) {
            if special[self.root[k]].replace(k).is_some() {
                conflicts.push(self.root[k]);
            }
        }
        if conflicts.is_empty() {
            self.walls_together(of, &special, &mut conflicts);
        }
        if conflicts.is_empty() {
            self.wrong_corners(of, &special, &mut conflicts);
        }
        conflicts.sort_unstable();
        conflicts.dedup();
        conflicts
    }

    /// Finds points that belong to two pieces of wall, but for points where the special node is an end of them.
    fn walls_together(&self, of: &Separation<'_>, special: &[Option<usize>], conflicts: &mut Vec<usize>) {
        let mut line: Vec<Option<u32>> = vec![None; self.root.len()];
        let mut ends: Vec<Vec<u32>> = vec![Vec::new(); of.t_mesh.nodes.len()];
        let walls = || of.wall.iter().enumerate().filter_map(|(a, wall)| Some((a, (*wall)?)));
        for (a, wall) in walls() {
            [2 * a, 2 * a + 1].into_iter().for_each(|h| ends[of.t_mesh.origin(h)].push(wall));
        }
        for (a, wall) in walls() {
            for k in 0..=self.numbers[a] {
                let at = self.root[self.complex.arc_point(2 * a, k) as usize];
                let is_known = match special[at] {
                    Some(node) => ends[node].contains(&wall),
                    None => *line[at].get_or_insert(wall) == wall,
                };
                if !is_known {
                    conflicts.push(at);
                }
            }
        }
    }

    /// Finds points in which not as many squares meet as do at their cone or corner, else four, and two on the boundary.
    fn wrong_corners(&self, of: &Separation<'_>, special: &[Option<usize>], conflicts: &mut Vec<usize>) {
        // In halves of a square: corners are on two sides of a rectangle, other points of a side have two squares there.
        let mut count = vec![0u32; self.root.len()];
        for rectangle in &of.t_mesh.rectangles {
            if self.complex.size(rectangle).contains(&0) {
                continue;
            }
            let sides = self.complex.sides(rectangle);
            for side in [&sides.bottom, &sides.right, &sides.top, &sides.left] {
                let last = side.len() - 1;
                side.iter().enumerate().for_each(|(k, &p)| {
                    count[self.root[p as usize]] += if k == 0 || k == last { 1 } else { 4 };
                });
            }
        }
        let mut is_border = vec![false; self.root.len()];
        for a in (0..of.is_boundary.len()).filter(|&a| of.is_boundary[a]) {
            (0..=self.numbers[a])
                .for_each(|k| is_border[self.root[self.complex.arc_point(2 * a, k) as usize]] = true);
        }
        for p in (0..self.root.len()).filter(|&p| self.root[p] == p) {
            let wanted = match special[p] {
                Some(node) => of.corners[node],
                None if is_border[p] => 2,
                None => 4,
            };
            if count[p] != 2 * wanted {
                conflicts.push(p);
            }
        }
    }
}
