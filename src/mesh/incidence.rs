//! Which faces meet in which edge of a triangle list that may have any defect.
//!
//! Side `3f + k` is the side of face f from its corner k to corner k + 1. Faces that name a missing vertex or a vertex
//! twice have no sides.

/// No face, no side.
pub(super) const NONE: u32 = u32::MAX;

pub(super) struct Incidence {
    pub n_vertices: usize,
    triangle: Vec<bool>,
    /// Sides sorted by their unordered end vertices, then by number; `group` delimits equal ends.
    sides: Vec<u32>,
    group: Vec<u32>,
}

impl Incidence {
    pub fn new(n_vertices: usize, faces: &[[u32; 3]]) -> Incidence {
        let proper = |f: &[u32; 3]| f.iter().all(|&v| (v as usize) < n_vertices) && distinct(f);
        let triangle: Vec<bool> = faces.iter().map(proper).collect();
        let mut keyed: Vec<(u64, u32)> = Vec::with_capacity(3 * faces.len());
        for (f, corners) in faces.iter().enumerate().filter(|(f, _)| triangle[*f]) {
            for k in 0..3 {
                let (a, b) = (u64::from(corners[k]), u64::from(corners[(k + 1) % 3]));
                keyed.push((a.min(b) << 32 | a.max(b), (3 * f + k) as u32));
            }
        }
        keyed.sort_unstable();
        let mut group = vec![0];
        for i in 1..keyed.len() {
            if keyed[i].0 != keyed[i - 1].0 {
                group.push(i as u32);
            }
        }
        if !keyed.is_empty() {
            group.push(keyed.len() as u32);
        }
        Incidence { n_vertices, triangle, sides: keyed.into_iter().map(|(_, side)| side).collect(), group }
    }

    /// Whether the face has three different existing vertices.
    pub fn is_triangle(&self, f: usize) -> bool {
        self.triangle[f]
    }

    /// The sides along each distinct edge.
    pub fn edges(&self) -> impl Iterator<Item = &[u32]> {
        self.group.windows(2).map(|w| &self.sides[w[0] as usize..w[1] as usize])
    }

    /// Whether a side runs from the smaller to the larger vertex.
    pub fn is_forward(&self, faces: &[[u32; 3]], side: u32) -> bool {
        let (f, k) = (side as usize / 3, side as usize % 3);
        faces[f][k] < faces[f][(k + 1) % 3]
    }

    /// Per vertex: how many fans of edge-connected faces touch it.
    pub fn sheets(&self, faces: &[[u32; 3]]) -> Vec<u32> {
        let mut corners = UnionFind::new(3 * faces.len());
        for sides in self.edges() {
            for pair in sides.windows(2) {
                let forward = pair.iter().map(|&s| self.is_forward(faces, s)).collect::<Vec<_>>();
                // Corner 3f + k is where side 3f + k starts; the next corner is where it ends.
                let ends = |s: u32, forward: bool| {
                    let (start, end) = (s, 3 * (s / 3) + (s % 3 + 1) % 3);
                    if forward { (start, end) } else { (end, start) }
                };
                let ((a, b), (c, d)) = (ends(pair[0], forward[0]), ends(pair[1], forward[1]));
                corners.join(a, c, false);
                corners.join(b, d, false);
            }
        }
        let mut sheets = vec![0; self.n_vertices];
        for (f, face) in faces.iter().enumerate().filter(|(f, _)| self.triangle[*f]) {
            for k in 0..3 {
                let corner = (3 * f + k) as u32;
                sheets[face[k] as usize] += u32::from(corners.root(corner).0 == corner);
            }
        }
        sheets
    }

    /// Number of faces of each piece connected through vertices.
    pub fn components(&self, faces: &[[u32; 3]]) -> Vec<u32> {
        let mut pieces = UnionFind::new(self.n_vertices);
        for (_, face) in faces.iter().enumerate().filter(|(f, _)| self.triangle[*f]) {
            pieces.join(face[0], face[1], false);
            pieces.join(face[0], face[2], false);
        }
        let mut count = vec![0u32; self.n_vertices];
        for (_, face) in faces.iter().enumerate().filter(|(f, _)| self.triangle[*f]) {
            count[pieces.root(face[0]).0 as usize] += 1;
        }
        count.into_iter().filter(|&n| n > 0).collect()
    }

    /// Connected pieces of the boundary edges (the boundary loops, on a manifold).
    pub fn boundary_loops(&self, faces: &[[u32; 3]]) -> usize {
        let mut pieces = UnionFind::new(self.n_vertices);
        let mut boundary = vec![false; self.n_vertices];
        for side in self.edges().filter(|sides| sides.len() == 1).map(|sides| sides[0] as usize) {
            let (a, b) = (faces[side / 3][side % 3], faces[side / 3][(side + 1 - 3 * (side / 3)) % 3]);
            pieces.join(a, b, false);
            boundary[a as usize] = true;
            boundary[b as usize] = true;
        }
        (0..self.n_vertices as u32).filter(|&v| boundary[v as usize] && pieces.root(v).0 == v).count()
    }

    /// Per side: the other side along its edge, `NONE` on the boundary. For lists without non-manifold edges.
    pub fn partners(&self, n_faces: usize) -> Vec<u32> {
        let mut partner = vec![NONE; 3 * n_faces];
        for sides in self.edges() {
            if let [a, b] = *sides {
                partner[a as usize] = b;
                partner[b as usize] = a;
            }
        }
        partner
    }
}

fn distinct(f: &[u32; 3]) -> bool {
    f[0] != f[1] && f[1] != f[2] && f[2] != f[0]
}

/// Disjoint sets whose members carry a sign relative to their root. The root is the smallest member.
pub(super) struct UnionFind(Vec<(u32, bool)>);

impl UnionFind {
    pub fn new(n: usize) -> UnionFind {
        UnionFind((0..n as u32).map(|i| (i, false)).collect())
    }

    /// The root of `i`, and whether `i` has the opposite sign.
    pub fn root(&mut self, mut i: u32) -> (u32, bool) {
        let mut sign = false;
        while self.0[i as usize].0 != i {
            let (parent, up) = self.0[i as usize];
            let (above, further) = self.0[parent as usize];
            // Path halving.
            self.0[i as usize] = (above, up ^ (parent != above && further));
            let (next, step) = self.0[i as usize];
            sign ^= step;
            i = next;
        }
        (i, sign)
    }

    /// Put `a` and `b` into one set with opposite signs (or equal ones); false if they already are, differently.
    pub fn join(&mut self, a: u32, b: u32, opposite: bool) -> bool {
        let ((a, sign_a), (b, sign_b)) = (self.root(a), self.root(b));
        let relation = sign_a ^ sign_b ^ opposite;
        if a == b {
            return !relation;
        }
        let (low, high) = (a.min(b), a.max(b));
        self.0[high as usize] = (low, relation);
        true
    }
}
