//! Building connectivity from index buffers and from gluings.
//!
//! ```
//! use ricci::mesh::Mesh;
//! assert!(Mesh::from_faces(3, &[[0, 1, 2]])?.is_simplicial());
//! // Two triangles glued along all three edges to a torus with a single vertex.
//! let torus = Mesh::from_gluing(1, &[[0; 3]; 2], &[[2, -3, 1], [-1, -2, 3]])?;
//! assert_eq!((torus.genus(), torus.is_simplicial()), (1, false));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::check::{Diagnosis, diagnose_gluing, diagnose_incidence, diagnose_positions, is_sound};
use super::halfedge::Mesh;
use super::ids::{FaceId, HalfedgeId, VertexId};
use super::incidence::{Incidence, NONE, hangs_together};
use super::io::Soup;
use crate::error::{Error, Result, check_size};
use crate::parallel;
use std::cmp::Reverse;

impl Mesh {
    /// The surface of an indexed triangle list (0-based, counterclockwise).
    ///
    /// Vertices, faces and corners keep their numbers. Edges are numbered in the order in which the faces' sides (first to second corner,
    /// second to third, third to first) first name them, and half-edge `2e` runs in the direction of that first side.
    ///
    /// # Errors
    ///
    /// [`Error::Defects`] with all defects; [`Error::TooLarge`]; [`Error::Argument`] for far more vertices than faces can use.
    pub fn from_faces(n_vertices: usize, faces: &[[u32; 3]]) -> Result<Mesh> {
        check_counts(n_vertices, faces.len())?;
        let incidence = Incidence::new(n_vertices, faces);
        connect(faces, incidence).map_err(|error| {
            let incidence = Incidence::new(n_vertices, faces);
            defects(diagnose_incidence(faces, &incidence)).unwrap_or(error)
        })
    }

    /// The surface of a triangle list in space. Its diagnosis includes the positions (zero-area faces, coordinates that are not finite).
    ///
    /// # Errors
    ///
    /// As [`Mesh::from_faces`].
    pub fn from_soup(soup: &Soup) -> Result<Mesh> {
        if let Some(mesh) = Mesh::from_sound(soup)? {
            return Ok(mesh);
        }
        let Soup { positions, faces, .. } = soup;
        let incidence = Incidence::new(positions.len(), faces);
        match defects(diagnose_positions(positions, faces, &incidence)) {
            Some(error) => Err(error),
            None => connect(faces, incidence),
        }
    }

    /// The surface of a triangle list without defects; none where there are some, which [`Mesh::from_soup`] names in several times the memory.
    ///
    /// # Errors
    /// [`Error::TooLarge`].
    pub fn from_sound(soup: &Soup) -> Result<Option<Mesh>> {
        let Soup { positions, faces, .. } = soup;
        check_counts(positions.len(), faces.len())?;
        let mesh = connect(faces, Incidence::new(positions.len(), faces));
        Ok(mesh.ok().filter(|_| is_sound(positions, faces)))
    }

    /// The surface of triangles glued along numbered edges: a Δ-complex, in which several edges may have the same ends.
    ///
    /// `face_edges[f] = [±e_bc, ±e_ca, ±e_ab]` for the face (a, b, c). Edges are numbered from 1 without gaps; the sign is positive if
    /// the side (b to c, c to a, a to b) has the edge's direction, that of half-edge `2(e − 1)`. Each edge is named once (boundary) or
    /// twice, with opposite signs.
    ///
    /// # Errors
    ///
    /// [`Error::Gluing`] for edge numbers that break these rules or glue different vertices, [`Error::Defects`] for a consistent gluing
    /// that is not a surface in which every vertex is the centre of one fan.
    pub fn from_gluing(n_vertices: usize, faces: &[[u32; 3]], face_edges: &[[i32; 3]]) -> Result<Mesh> {
        check_counts(n_vertices, faces.len())?;
        check_size("face_edges", face_edges.len(), faces.len())?;
        let (origin, sides) = glue(n_vertices, faces, face_edges)?;
        let diagnosis = diagnose_gluing(n_vertices, faces, &origin, &sides);
        if !diagnosis.defects.is_empty() {
            return Err(Error::Defects(Box::new(diagnosis)));
        }
        Mesh::assemble(n_vertices, origin, &sides)
    }

    /// `[±e_bc, ±e_ca, ±e_ab]` of a face, in the format of [`Mesh::from_gluing`].
    pub fn face_edges(&self, f: FaceId) -> [i32; 3] {
        let number = |h: HalfedgeId| (h.edge().0 as i32 + 1) * if h.0 & 1 == 0 { 1 } else { -1 };
        let [ab, bc, ca] = self.face_halfedges(f).map(number);
        [bc, ca, ab]
    }

    /// True if every edge has two different ends and no other edge has the same two.
    pub fn is_simplicial(&self) -> bool {
        // For each vertex the last one that was found to be its neighbour.
        let mut beside = vec![NONE; self.n_vertices()];
        let mut is_new =
            |v: VertexId, tip: VertexId| tip != v && std::mem::replace(&mut beside[tip.index()], v.0) != v.0;
        self.vertices().all(|v| self.outgoing(v).all(|h| is_new(v, self.tip(h))))
    }

    /// True if the faces' vertices determine the surface, so that [`Mesh::from_faces`] accepts them: edges are determined by their ends,
    /// and no two faces have the same vertices.
    pub fn is_given_by_faces(&self) -> bool {
        // In a simplicial surface, faces with the same vertices have the same edges.
        let is_repeated = |f: FaceId| {
            let [h, _, ca] = self.face_halfedges(f);
            self.face(h.twin()).is_some_and(|g| g != f) && self.origin(self.prev(h.twin())) == self.origin(ca)
        };
        self.is_simplicial() && !self.faces().any(is_repeated)
    }
}

fn refuse<T>(face: usize, message: String) -> Result<T> {
    Err(Error::Gluing { face, message })
}

/// The edge numbers of each face, with the face.
fn numbers(face_edges: &[[i32; 3]]) -> impl Iterator<Item = (usize, usize)> {
    let of_face = |(f, edges): (usize, &[i32; 3])| edges.map(|e| (e.unsigned_abs() as usize, f));
    face_edges.iter().enumerate().flat_map(of_face)
}

/// The highest edge number, which is at most the number of sides.
fn count_edges(face_edges: &[[i32; 3]]) -> Result<usize> {
    let highest = numbers(face_edges).map(|(e, f)| (e, Reverse(f))).max();
    match highest {
        Some((e, Reverse(f))) if e > 3 * face_edges.len() => {
            let need = "number edges from 1 without gaps";
            refuse(f, format!("edge number {e} exceeds the number of sides; {need}"))
        }
        highest => Ok(highest.map_or(0, |(e, _)| e)),
    }
}

/// Checks that each of the numbers from 1 to `n_edges`, the highest, occurs in some face.
fn check_gaps(face_edges: &[[i32; 3]], n_edges: usize) -> Result<()> {
    let mut is_named = vec![false; n_edges + 1];
    numbers(face_edges).for_each(|(e, _)| is_named[e] = true);
    let gap = (1..=n_edges).find(|&e| !is_named[e]);
    match gap.and_then(|gap| Some((gap, numbers(face_edges).find(|&(e, _)| e > gap)?))) {
        Some((gap, (_, f))) => {
            let missing = format!("no face names edge {gap}; number edges from 1 without gaps");
            refuse(f, format!("the edge numbers go up to {n_edges}, but {missing}"))
        }
        None => Ok(()),
    }
}

/// The origin of each half-edge, and the three half-edges of each face, of a gluing in the format of [`Mesh::from_gluing`].
fn glue(n_vertices: usize, faces: &[[u32; 3]], face_edges: &[[i32; 3]]) -> Result<(Vec<u32>, Vec<[u32; 3]>)> {
    let n_edges = count_edges(face_edges)?;
    let mut origin = vec![NONE; 2 * n_edges];
    let mut used = vec![false; 2 * n_edges];
    let mut sides = vec![[NONE; 3]; faces.len()];
    for (f, (corners, edges)) in faces.iter().zip(face_edges).enumerate() {
        if let Some(v) = corners.iter().find(|&&v| v as usize >= n_vertices) {
            let message = format!("vertex {v} does not exist; the {n_vertices} vertices are numbered from 0");
            return refuse(f, message);
        }
        for k in 0..3 {
            // The side from corner k is opposite corner k + 2.
            let edge = edges[(k + 2) % 3];
            let Some(e) = edge.unsigned_abs().checked_sub(1) else {
                return refuse(f, "edge number 0: edges are numbered from 1".into());
            };
            let h = 2 * e as usize + usize::from(edge < 0);
            if std::mem::replace(&mut used[h], true) {
                let need = "the two faces of an edge run along it in opposite directions";
                return refuse(f, format!("edge {} is named twice in this direction; {need}", e + 1));
            }
            for (h, v) in [(h, corners[k]), (h ^ 1, corners[(k + 1) % 3])] {
                if origin[h] != NONE && origin[h] != v {
                    let elsewhere =
                        format!("at vertex {} elsewhere; glue sides with the same ends", origin[h]);
                    return refuse(
                        f,
                        format!("edge {} starts or ends at vertex {v} here, {elsewhere}", e + 1),
                    );
                }
                origin[h] = v;
            }
            sides[f][k] = h as u32;
        }
    }
    check_gaps(face_edges, n_edges)?;
    Ok((origin, sides))
}

/// The error of a diagnosis that has found defects.
fn defects(diagnosis: Diagnosis) -> Option<Error> {
    (!diagnosis.defects.is_empty()).then(|| Error::Defects(Box::new(diagnosis)))
}

/// Numbers the edges of a triangle list.
///
/// # Errors
///
/// [`Error::Connectivity`] for a list with any defect of its indices; only the diagnosis tells which.
fn connect(faces: &[[u32; 3]], incidence: Incidence) -> Result<Mesh> {
    let n_vertices = incidence.n_vertices;
    let (hangs_together, numbered) =
        parallel::join(|| hangs_together(n_vertices, faces), || numbered(faces, incidence));
    let (true, Some((origin, sides))) = (hangs_together, numbered) else {
        let message = "is no connected oriented surface of triangles";
        return Err(Error::Connectivity { element: "mesh", index: 0, message });
    };
    Mesh::assemble(n_vertices, origin, &sides)
}

/// The origins of the half-edges, and the half-edges of each face, of oriented triangles.
fn numbered(faces: &[[u32; 3]], incidence: Incidence) -> Option<(Vec<u32>, Vec<[u32; 3]>)> {
    if !incidence.is_oriented(faces) {
        return None;
    }
    let (partner, n_edges) = (incidence.partners(faces.len()), incidence.edges().len());
    drop(incidence);
    let mut origin = Vec::with_capacity(2 * n_edges);
    let mut sides = vec![[NONE; 3]; faces.len()];
    for (f, corners) in faces.iter().enumerate() {
        for k in 0..3 {
            // NONE is larger than every side.
            let other = partner[3 * f + k] as usize;
            sides[f][k] = if other < 3 * f + k {
                sides[other / 3][other % 3] ^ 1
            } else {
                origin.extend([corners[k], corners[(k + 1) % 3]]);
                origin.len() as u32 - 2
            };
        }
    }
    Some((origin, sides))
}

/// Most isolated vertices that are diagnosed one by one, a million. A list with more is refused as a whole, before memory is allocated
/// for each of them.
const SPARE_VERTICES: usize = 1 << 20;

fn check_counts(n_vertices: usize, n_faces: usize) -> Result<()> {
    // Sides are numbered in u32, edges from 1 in i32.
    for (what, count) in [("vertices", n_vertices), ("sides of faces", n_faces.saturating_mul(3))] {
        if count >= i32::MAX as usize {
            return Err(Error::TooLarge { what, count });
        }
    }
    // The number of vertices is only a claim of the caller, for which no memory should be allocated.
    if n_vertices > n_faces.saturating_mul(3).saturating_add(SPARE_VERTICES) {
        return Err(Error::argument("number of vertices", n_vertices, "three per face or fewer"));
    }
    Ok(())
}
