//! Small surfaces to run the command on.

use std::f64::consts::TAU;

pub struct Surface {
    pub positions: Vec<[f64; 3]>,
    pub faces: Vec<[usize; 3]>,
}

impl Surface {
    pub fn obj(&self) -> String {
        let v = self.positions.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n"));
        let f = self.faces.iter().map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1));
        v.chain(f).collect()
    }

    /// Both surfaces in one file, the other's vertices after these.
    pub fn beside(mut self, other: Surface) -> Surface {
        let n = self.positions.len();
        self.positions.extend(other.positions.iter().map(|p| [p[0] + 10.0, p[1], p[2]]));
        self.faces.extend(other.faces.iter().map(|f| f.map(|v| v + n)));
        self
    }
}

/// Torus of revolution with radii 2 and 1, n × m vertices.
pub fn torus(n: usize, m: usize) -> Surface {
    let mut positions = Vec::new();
    for i in 0..n {
        for j in 0..m {
            let (a, b) = (TAU * i as f64 / n as f64, TAU * j as f64 / m as f64);
            let r = 2.0 + b.cos();
            positions.push([r * a.cos(), r * a.sin(), b.sin()]);
        }
    }
    let at = |i: usize, j: usize| (i % n) * m + j % m;
    let faces = (0..n * m).flat_map(|k| {
        let (i, j) = (k / m, k % m);
        [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
    });
    Surface { positions, faces: faces.collect() }
}

/// The hill sheared: triangles at two of its sides are obtuse, and edges are flipped across its boundary.
pub fn sheared_hill(n: usize) -> Surface {
    let mut hill = hill(n);
    hill.positions.iter_mut().for_each(|p| p[0] += 1.5 * p[1]);
    hill
}

/// Graph of a smooth function over a square of n × n cells: a disk.
pub fn hill(n: usize) -> Surface {
    let at = |i: usize, j: usize| i * (n + 1) + j;
    let mut positions = Vec::new();
    for i in 0..=n {
        for j in 0..=n {
            let (x, y) = (i as f64 / n as f64 - 0.5, j as f64 / n as f64 - 0.45);
            positions.push([x, y, 0.4 * (-6.0 * (x * x + y * y)).exp()]);
        }
    }
    let faces = (0..n * n).flat_map(|k| {
        let (i, j) = (k / n, k % n);
        [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
    });
    Surface { positions, faces: faces.collect() }
}

/// Two tori joined along the four edges of a removed square each: genus 2.
pub fn genus_two(n: usize) -> Surface {
    let (mut left, right) = (torus(n, n), torus(n, n));
    let square = [0, n, n + 1, 1];
    let other = |v: usize| if square.contains(&v) { v } else { v + left.positions.len() };
    let mirrored = right.faces.iter().filter(|f| !f.iter().all(|v| square.contains(v)));
    let glued: Vec<_> = mirrored.map(|&[a, b, c]| [other(a), other(c), other(b)]).collect();
    left.faces.retain(|f| !f.iter().all(|v| square.contains(v)));
    // The second copy is mirrored in the plane x = 3, near which the square lies.
    let copy: Vec<_> = right.positions.iter().map(|p| [6.5 - p[0], p[1], p[2]]).collect();
    left.positions.extend(copy);
    left.faces.extend(glued);
    // The square's vertices of the second copy are not used: drop them, highest first.
    let unused = square.map(|v| v + n * n);
    let mut surface = left;
    let mut order = unused;
    order.sort_unstable_by(|a, b| b.cmp(a));
    for v in order {
        surface.positions.remove(v);
        surface.faces.iter_mut().flatten().filter(|w| **w > v).for_each(|w| *w -= 1);
    }
    surface
}

pub fn octahedron() -> Surface {
    let positions = vec![
        [1.0, 0.0, 0.0],
        [0.0, 1.1, 0.0],
        [-1.2, 0.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.3],
        [0.0, 0.0, -0.9],
    ];
    let ring = |k: usize| (k, (k + 1) % 4);
    let faces = (0..4).flat_map(|k| {
        let (a, b) = ring(k);
        [[a, b, 4], [b, a, 5]]
    });
    Surface { positions, faces: faces.collect() }
}

/// A band of n quadrilaterals with a half twist.
pub fn moebius(n: usize) -> Surface {
    let mut positions = Vec::new();
    for i in 0..n {
        let a = TAU * i as f64 / n as f64;
        for s in [-0.3, 0.3] {
            let r = 1.0 + s * (0.5 * a).cos();
            positions.push([r * a.cos(), r * a.sin(), s * (0.5 * a).sin()]);
        }
    }
    let at = |i: usize, side: usize| if i < n { 2 * i + side } else { 1 - side };
    let faces =
        (0..n).flat_map(|i| [[at(i, 0), at(i + 1, 0), at(i + 1, 1)], [at(i, 0), at(i + 1, 1), at(i, 1)]]);
    Surface { positions, faces: faces.collect() }
}

/// A flat torus of two triangles and one vertex, glued from the parallelogram with sides `a`, `b` and diagonal `d`.
pub fn one_vertex_torus(a: f64, b: f64, d: f64) -> String {
    // Triangle 1: a along, b up, back along the diagonal. Triangle 2: the diagonal, then back along a and b.
    serde_json::json!({
        "faces": [[0, 0, 0], [0, 0, 0]],
        "face_edges": [[2, -3, 1], [-1, -2, 3]],
        "lengths": [[b, d, a], [a, b, d]],
    })
    .to_string()
}

/// A plane sheet of length n and width 1 in n by m squares, cut along their diagonals.
pub fn sheet(length: usize, n: usize, m: usize) -> Surface {
    let at = |i: usize, j: usize| (m + 1) * i + j;
    let place = |k: usize| {
        let (i, j) = (k / (m + 1), k % (m + 1));
        [length as f64 * i as f64 / n as f64, j as f64 / m as f64, 0.0]
    };
    let faces = (0..n * m).flat_map(|k| {
        let (i, j) = (k / m, k % m);
        [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
    });
    Surface { positions: (0..(n + 1) * (m + 1)).map(place).collect(), faces: faces.collect() }
}

/// A plate of 70 × 3 × 0.05 with two holes through it, in triangles of very different lengths: genus 2.
pub fn pierced_plate() -> Surface {
    let (xs, ys) = ([0.0, 1.0, 20.0, 50.0, 60.0, 70.0], [0.0, 1.0, 2.0, 3.0]);
    let at = |[i, j]: [usize; 2], k: usize| (4 * k + j) * 6 + i;
    let positions = (0..48).map(|v| [xs[v % 6], ys[v / 6 % 4], 0.05 * (v / 24) as f64]).collect();
    let is_solid = |i: usize, j: usize| i < 5 && j < 3 && !(j == 1 && (i == 1 || i == 3));
    let mut faces = Vec::new();
    for (i, j) in (0..15).map(|k| (k / 3, k % 3)).filter(|&(i, j)| is_solid(i, j)) {
        let square = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
        let [[a, b, c, d], [e, f, g, h]] = [1, 0].map(|k| square.map(|p| at(p, k)));
        faces.extend([[a, b, c], [a, c, d], [e, g, f], [e, h, g]]);
        let beside = [(i, j.wrapping_sub(1)), (i + 1, j), (i, j + 1), (i.wrapping_sub(1), j)];
        for (side, _) in beside.into_iter().enumerate().filter(|&(_, (i, j))| !is_solid(i, j)) {
            let (p, q) = (square[side], square[(side + 1) % 4]);
            let [a, b, c, d] = [at(p, 0), at(q, 0), at(q, 1), at(p, 1)];
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    Surface { positions, faces }
}
