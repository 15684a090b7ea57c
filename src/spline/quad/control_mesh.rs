//! Meshes of polygons as control meshes of Catmull–Clark surfaces: their refinement \[CC78\], and the points of the limit \[HKD93\].

use super::layout::ascending;
use crate::error::{Error, Result};
use crate::geometry::vector::{Vector, add, scale};
use std::collections::BTreeMap;

/// The side of a mesh of polygons.
#[derive(Clone, Copy)]
struct ControlEdge {
    /// Its vertices, in the direction of the first face that has it.
    ends: [u32; 2],
    /// The faces that have it.
    faces: [Option<u32>; 2],
}

/// The edges of a mesh of polygons.
struct ControlEdges {
    all: Vec<ControlEdge>,
    /// Per face the edges from its corners to the next ones.
    of_face: Vec<Vec<u32>>,
}

/// A connected, oriented mesh of polygons whose Catmull–Clark surface is wanted. Its boundary becomes a cubic spline; vertices of the boundary with a single face
/// stay in place.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlMesh {
    positions: Vec<Vector>,
    faces: Vec<Vec<u32>>,
}

/// What a vertex has around it.
#[derive(Clone, Default)]
struct ControlVertex {
    /// The number of its faces.
    valence: usize,
    /// The sums over its faces of a point of each, and over its edges of the vertices at the other ends.
    of_faces: Vector,
    of_edges: Vector,
    /// The number of its edges on the boundary, and the sum of the vertices at their other ends.
    n_border: usize,
    of_border: Vector,
}

impl ControlMesh {
    /// The mesh with these faces, corners counterclockwise seen from outside.
    ///
    /// # Errors
    /// [`Error::Spline`] with the number of the face or vertex: for a face with fewer than three corners, with one that does not exist or occurs twice,
    /// or with a side that another face has in the same direction; for a vertex whose position is not finite, that no face has, or at which faces meet
    /// that no sides join.
    pub fn new(positions: Vec<Vector>, faces: Vec<Vec<u32>>) -> Result<ControlMesh> {
        let of_face = |index: usize, message: String| Error::Spline {
            what: "face of the control mesh",
            index,
            message,
        };
        if faces.is_empty() {
            return Err(of_face(0, "there is none".into()));
        }
        for (f, face) in faces.iter().enumerate() {
            if face.len() < 3 {
                return Err(of_face(
                    f,
                    format!("it has {} corners, and a polygon at least three", face.len()),
                ));
            }
            if let Some(v) = face.iter().find(|&&v| v as usize >= positions.len()) {
                return Err(of_face(
                    f,
                    format!("its corner {v} does not exist: there are {} vertices", positions.len()),
                ));
            }
            if let Some(v) = face.iter().enumerate().find(|(k, v)| face[..*k].contains(v)).map(|(_, v)| v) {
                return Err(of_face(f, format!("vertex {v} is more than one of its corners")));
            }
        }
        let mesh = ControlMesh { positions, faces };
        let edges = mesh.edges()?;
        mesh.check_vertices(&edges)?;
        Ok(mesh)
    }

    /// The positions of the vertices.
    pub fn positions(&self) -> &[Vector] {
        &self.positions
    }

    /// The corners of each face.
    pub fn faces(&self) -> &[Vec<u32>] {
        &self.faces
    }

    /// The faces as quadrilaterals, if all are.
    pub(super) fn quads(&self) -> Option<Vec<[u32; 4]>> {
        self.faces.iter().map(|face| <[u32; 4]>::try_from(&face[..]).ok()).collect()
    }

    /// The sides of which only one face is known, in the direction of that face.
    pub(super) fn border(&self) -> Result<Vec<[u32; 2]>> {
        Ok(self.edges()?.all.iter().filter(|edge| edge.faces[1].is_none()).map(|edge| edge.ends).collect())
    }

    /// The mesh after one step of refinement: the vertices move, then follow one vertex per edge and one per face. Face f becomes as many quadrilaterals as it
    /// has corners, one after the other; those of the faces before it come first.
    pub(super) fn refined(&self) -> Result<ControlMesh> {
        let edges = self.edges()?;
        let centres: Vec<Vector> = self.faces.iter().map(|face| self.centre(face)).collect();
        let around = self.around(&edges, |f, _| centres[f]);
        let position = |v: u32| self.positions[v as usize];
        let moved = self.positions.iter().zip(&around).map(|(&p, around)| moved(p, around));
        let on_edge = |edge: &ControlEdge| {
            let ends = add(position(edge.ends[0]), position(edge.ends[1]));
            match edge.faces.map(|f| f.map(|f| centres[f as usize])) {
                [Some(a), Some(b)] => scale(0.25, add(ends, add(a, b))),
                _ => scale(0.5, ends),
            }
        };
        let positions: Vec<Vector> =
            moved.chain(edges.all.iter().map(on_edge)).chain(centres.iter().copied()).collect();
        let (first_edge, first_face) =
            (self.positions.len() as u32, (self.positions.len() + edges.all.len()) as u32);
        let quads_of = |f: usize| {
            let (face, sides) = (&self.faces[f], &edges.of_face[f]);
            let n = face.len();
            (0..n).map(move |k| {
                vec![
                    face[k],
                    first_edge + sides[k],
                    first_face + f as u32,
                    first_edge + sides[(k + n - 1) % n],
                ]
            })
        };
        Ok(ControlMesh { positions, faces: (0..self.faces.len()).flat_map(quads_of).collect() })
    }

    /// The points of the limit surface at the vertices of a mesh of quadrilaterals.
    pub(super) fn limit_points(&self) -> Result<Vec<Vector>> {
        let opposite = |f: usize, k: usize| self.positions[self.faces[f][(k + 2) % 4] as usize];
        let around = self.around(&self.edges()?, opposite);
        Ok(self.positions.iter().zip(&around).map(|(&p, around)| limit(p, around)).collect())
    }

    fn centre(&self, face: &[u32]) -> Vector {
        let sum = face.iter().fold([0.0; 3], |sum, &v| add(sum, self.positions[v as usize]));
        scale(1.0 / face.len() as f64, sum)
    }

    /// # Errors
    /// [`Error::Spline`] for a face with a side that another has in the same direction.
    fn edges(&self) -> Result<ControlEdges> {
        let mut numbers: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        let (mut all, mut of_face) = (Vec::<ControlEdge>::new(), Vec::with_capacity(self.faces.len()));
        for (f, face) in self.faces.iter().enumerate() {
            let mut sides = Vec::with_capacity(face.len());
            for (k, &v) in face.iter().enumerate() {
                let ends = [v, face[(k + 1) % face.len()]];
                let number = *numbers.entry(ascending(ends)).or_insert(all.len() as u32);
                match all.get_mut(number as usize) {
                    None => all.push(ControlEdge { ends, faces: [Some(f as u32), None] }),
                    Some(edge) if edge.ends != ends && edge.faces[1].is_none() => {
                        edge.faces[1] = Some(f as u32)
                    }
                    Some(_) => {
                        let [a, b] = ends;
                        let message = format!(
                            "another face has its side {a}–{b} in the same direction: turn one over or cut them apart"
                        );
                        return Err(Error::Spline { what: "face of the control mesh", index: f, message });
                    }
                }
                sides.push(number);
            }
            of_face.push(sides);
        }
        Ok(ControlEdges { all, of_face })
    }

    /// # Errors
    /// [`Error::Spline`] for a vertex whose position is not finite, that no face has, or whose faces are not joined by sides.
    fn check_vertices(&self, edges: &ControlEdges) -> Result<()> {
        // Per vertex its faces, each as the side that leaves the vertex and the one that comes to it.
        let mut fans: BTreeMap<u32, BTreeMap<u32, u32>> = BTreeMap::new();
        for (f, face) in self.faces.iter().enumerate() {
            for (k, &v) in face.iter().enumerate() {
                let sides = &edges.of_face[f];
                let [next, before] = [sides[k], sides[(k + face.len() - 1) % face.len()]];
                fans.entry(v).or_default().insert(next, before);
            }
        }
        for (v, position) in self.positions.iter().enumerate() {
            let message = match fans.get(&(v as u32)) {
                _ if position.iter().any(|x| !x.is_finite()) => "its position is not finite",
                None => "no face has it: leave it out",
                Some(fan) if !is_one_fan(fan) => "its faces are not joined by sides: cut them apart there",
                Some(_) => continue,
            };
            return Err(Error::Spline {
                what: "vertex of the control mesh",
                index: v,
                message: message.into(),
            });
        }
        Ok(())
    }

    /// What each vertex has around it. `point`: that of a face, seen from this one of its corners.
    fn around(&self, edges: &ControlEdges, point: impl Fn(usize, usize) -> Vector) -> Vec<ControlVertex> {
        let mut around = vec![ControlVertex::default(); self.positions.len()];
        for (f, face) in self.faces.iter().enumerate() {
            for (k, &v) in face.iter().enumerate() {
                let at = &mut around[v as usize];
                at.valence += 1;
                at.of_faces = add(at.of_faces, point(f, k));
            }
        }
        for ControlEdge { ends: [a, b], faces } in &edges.all {
            for (v, other) in [(a, b), (b, a)] {
                let (at, other) = (&mut around[*v as usize], self.positions[*other as usize]);
                at.of_edges = add(at.of_edges, other);
                if faces[1].is_none() {
                    at.n_border += 1;
                    at.of_border = add(at.of_border, other);
                }
            }
        }
        around
    }
}

/// True if the faces of a vertex, each from one edge to the one before it, follow each other in a single fan.
fn is_one_fan(fan: &BTreeMap<u32, u32>) -> bool {
    // The first face of an open fan is the one that no other leads to.
    let open = fan.keys().copied().find(|edge| !fan.values().any(|before| before == edge));
    let Some(first) = open.or_else(|| fan.keys().next().copied()) else { return true };
    let (mut edge, mut n) = (first, 0);
    while let Some(&before) = fan.get(&edge) {
        (edge, n) = (before, n + 1);
        if edge == first {
            break;
        }
    }
    n == fan.len()
}

/// The vertex after a step of refinement; the faces around it count by their centres.
fn moved(p: Vector, around: &ControlVertex) -> Vector {
    let n = around.valence as f64;
    match around {
        ControlVertex { valence: 1, n_border: 2, .. } => p,
        ControlVertex { n_border: 2, of_border, .. } => add(scale(0.75, p), scale(0.125, *of_border)),
        // (centres + 2 middles of edges + (n − 3) p) / n, in means.
        ControlVertex { of_faces, of_edges, .. } => {
            let middles = scale(0.5, add(scale(n, p), *of_edges));
            scale(1.0 / (n * n), add(add(*of_faces, scale(2.0, middles)), scale(n * (n - 3.0), p)))
        }
    }
}

/// The point of the limit at a vertex; the quadrilaterals around it count by their opposite corners.
fn limit(p: Vector, around: &ControlVertex) -> Vector {
    let n = around.valence as f64;
    match around {
        ControlVertex { valence: 1, n_border: 2, .. } => p,
        ControlVertex { n_border: 2, of_border, .. } => scale(1.0 / 6.0, add(scale(4.0, p), *of_border)),
        ControlVertex { of_faces, of_edges, .. } => {
            let sum = add(add(scale(n * n, p), scale(4.0, *of_edges)), *of_faces);
            scale(1.0 / (n * (n + 5.0)), sum)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::vector::{distance, norm};

    fn cube() -> ControlMesh {
        let positions = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(|x| 2.0 * x as f64 - 1.0)).collect();
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]];
        ControlMesh::new(positions, faces.iter().map(|face| face.to_vec()).collect()).unwrap()
    }

    #[test]
    fn limits_do_not_change_with_refinement() {
        let mut mesh = cube();
        let coarse = mesh.limit_points().unwrap();
        // (9 + 4 − 1) / 24 of the corner.
        assert!(coarse.iter().flatten().all(|x| (x.abs() - 0.5).abs() < 1e-15));
        for _ in 0..3 {
            mesh = mesh.refined().unwrap();
            let fine = mesh.limit_points().unwrap();
            for (a, b) in coarse.iter().zip(&fine) {
                assert!(distance(*a, *b) < 1e-14, "{a:?} {b:?}");
            }
        }
        assert_eq!(mesh.faces().len(), 6 * 64);
        assert!(mesh.positions().iter().all(|p| norm(*p) < 1.2));
    }

    /// On a regular grid the limit is the uniform bicubic spline: of control points on a quadratic surface z = x², z = x² + 1/3.
    #[test]
    fn regular_grids_are_uniform_splines() {
        let n = 7;
        let positions =
            (0..n * n).map(|k| [(k % n) as f64, (k / n) as f64, ((k % n) * (k % n)) as f64]).collect();
        let corner = |i: usize, j: usize| (j * n + i) as u32;
        let faces = (0..(n - 1) * (n - 1)).map(|q| {
            let (i, j) = (q % (n - 1), q / (n - 1));
            vec![corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]
        });
        let mesh = ControlMesh::new(positions, faces.collect()).unwrap();
        let limit = mesh.limit_points().unwrap();
        let at = limit[3 * n + 3];
        assert!(distance(at, [3.0, 3.0, 9.0 + 1.0 / 3.0]) < 1e-13, "{at:?}");
        assert_eq!(limit[0], [0.0; 3]);
        assert!(distance(limit[3], [3.0, 0.0, 9.0 + 1.0 / 3.0]) < 1e-13);
        assert_eq!(mesh.border().unwrap().len(), 4 * (n - 1));
    }

    #[test]
    fn what_is_no_surface_is_named() {
        let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [2.0, 2.0, 0.0]];
        let failure = |faces: &[&[u32]]| {
            let faces = faces.iter().map(|face| face.to_vec()).collect();
            ControlMesh::new(points.clone(), faces).unwrap_err().to_string()
        };
        assert!(failure(&[]).contains("there is none"));
        assert!(failure(&[&[0, 1]]).contains("2 corners"));
        assert!(failure(&[&[0, 1, 9]]).contains("corner 9 does not exist"));
        assert!(failure(&[&[0, 1, 2, 0]]).contains("vertex 0 is more than one"));
        assert!(failure(&[&[0, 1, 2], &[0, 1, 3], &[2, 3, 4]]).contains("0–1 in the same direction"));
        assert!(failure(&[&[0, 1, 2, 3]]).contains("no face has it"));
        assert!(failure(&[&[0, 1, 2], &[0, 3, 4]]).contains("not joined by sides"));
    }
}
