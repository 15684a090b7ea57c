//! Builds the common subdivision: from triangles of pieces (`assemble`), numbering the vertices and edges in use without gaps, or from
//! barycentric coordinates (`from_barycentric`).

use super::data::{CommonSubdivision, Crossing, FacePoint, PackedPlace, torn};
use super::pieces::{PieceTriangles, SubdivisionCorner};
use crate::error::Result;
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerEdge, PerFace, PerVertex, VertexId};
use crate::parallel;

/// Marks a vertex or edge that is in no triangle.
const UNUSED: u32 = u32::MAX;
/// Marks a vertex or edge that is in use, before it has its number.
const USED: u32 = 0;

/// New numbers of the elements that are not [`UNUSED`], in order, and how many these are.
fn numbered(mut all: Vec<u32>) -> (Vec<u32>, usize) {
    let mut n = 0;
    for x in all.iter_mut().filter(|x| **x != UNUSED) {
        *x = n;
        n += 1;
    }
    (all, n as usize)
}

/// The common subdivision of these pieces. `crossings` and `weight` (per vertex, [`CommonSubdivision::weight`]) are those of
/// all faces, also of those whose pieces are not among these.
///
/// # Errors
/// [`crate::Error::Connectivity`] where a corner of a piece lies outside the input or the final triangulation.
pub(super) fn assemble(
    pieces: PieceTriangles,
    crossings: Vec<Crossing>,
    weight: Vec<f64>,
) -> Result<CommonSubdivision> {
    let [input, final_mesh] = [pieces.drawn.input, pieces.drawn.result.mesh];
    let mut vertex = vec![UNUSED; weight.len()];
    let mut edge = vec![UNUSED; pieces.halfedges_along.len()];
    for (sides, corners) in pieces.sides.iter().zip(&pieces.corners) {
        sides.iter().for_each(|h| edge[(h >> 1) as usize] = USED);
        corners.iter().for_each(|c| vertex[c.vertex as usize] = USED);
    }
    let (vertex, n_vertices) = numbered(vertex);
    let (edge, n_edges) = numbered(edge);
    let mut sides = pieces.sides;
    let connected = || {
        let mut origin = vec![0; 2 * n_edges];
        for (sides, corners) in sides.iter_mut().zip(&pieces.corners) {
            for k in 0..3 {
                sides[k] = 2 * edge[(sides[k] >> 1) as usize] + (sides[k] & 1);
                origin[sides[k] as usize] = vertex[corners[k].vertex as usize];
                origin[sides[k] as usize ^ 1] = vertex[corners[(k + 1) % 3].vertex as usize];
            }
        }
        Mesh::assemble(n_vertices, origin, &sides)
    };
    let (mesh, faces) = parallel::join(connected, || places_and_faces(&pieces.corners, [input, final_mesh]));
    let (mesh, (places, faces)) = (mesh?, faces?);
    let n = input.n_vertices();
    let is_in_use = |v: &usize| vertex[*v] != UNUSED;
    let edges_in_use = (0..edge.len()).filter(|&e| edge[e] != UNUSED);
    Ok(CommonSubdivision {
        n_vertices: [(0..n).filter(is_in_use).count(); 2],
        crossings: (0..crossings.len()).filter(|c| is_in_use(&(n + c))).map(|c| crossings[c]).collect(),
        weight: (0..weight.len()).filter(is_in_use).map(|v| weight[v]).collect::<Vec<_>>().into(),
        faces,
        places,
        // Stored only if the triangulations have different vertices.
        points: Vec::new(),
        polygon_of: pieces.polygon_of.into(),
        halfedges_along: edges_in_use.map(|e| pieces.halfedges_along[e]).collect::<Vec<_>>().into(),
        mesh,
    })
}

/// Per triangle the places of its corners, and its faces, in the input and in the final triangulation.
fn places_and_faces(
    all: &[[SubdivisionCorner; 3]],
    meshes: [&Mesh; 2],
) -> Result<(Vec<[[PackedPlace; 2]; 3]>, [PerFace<FaceId>; 2])> {
    let lies_on = |mesh: &Mesh, h: HalfedgeId| {
        let (face, corner) = mesh.corner(h)?;
        Some((face, PackedPlace { corner: corner as u8, backward: h.0 & 1 == 1 }))
    };
    let of = |c: SubdivisionCorner| lies_on(meshes[0], c.input).zip(lies_on(meshes[1], c.result));
    let mut places = Vec::with_capacity(all.len());
    let mut faces = [Vec::with_capacity(all.len()), Vec::with_capacity(all.len())];
    for corners in all {
        let [Some(first), Some(second), Some(third)] = corners.map(of) else { return Err(torn()) };
        // All three corners are in the same face, of the input as of the final triangulation.
        let ((input_face, _), (final_face, _)) = first;
        faces[0].push(input_face);
        faces[1].push(final_face);
        places.push([first, second, third].map(|((_, in_input), (_, in_final))| [in_input, in_final]));
    }
    Ok((places, faces.map(PerFace::from)))
}

/// A common subdivision whose triangulations have different vertices, before the places of its corners are packed. The fields are those
/// of [`CommonSubdivision`].
pub(crate) struct Unpacked {
    pub mesh: Mesh,
    pub n_vertices: [usize; 2],
    pub crossings: Vec<Crossing>,
    pub weight: PerVertex<f64>,
    pub polygon_of: PerFace<u32>,
    pub faces: [PerFace<FaceId>; 2],
    pub halfedges_along: PerEdge<[Option<HalfedgeId>; 2]>,
    /// Per triangle: the barycentric coordinates of its corners in its face, `[corner of the triangle][corner of the face]`.
    pub barycentric: [Vec<[[f64; 3]; 3]>; 2],
}

impl CommonSubdivision {
    /// The common subdivision of these parts; `meshes` are its two triangulations.
    pub(crate) fn from_barycentric(parts: Unpacked, meshes: [&Mesh; 2]) -> CommonSubdivision {
        let Unpacked { mesh, n_vertices, crossings, weight, polygon_of, faces, halfedges_along, barycentric } =
            parts;
        let nowhere = FacePoint { vertices: [VertexId(0); 3], weights: [0.0; 3] };
        let mut points = vec![[nowhere; 2]; mesh.n_vertices()];
        let mut places = Vec::with_capacity(mesh.n_faces());
        for f in mesh.faces() {
            let corners = mesh.face_vertices(f);
            places.push([0, 1, 2].map(|k| {
                [0, 1].map(|side| {
                    let (face, weights) = (faces[side][f], barycentric[side][f.index()][k]);
                    let (place, point) = pack(meshes[side], face, weights);
                    points[corners[k].index()][side] = point;
                    place
                })
            }));
        }
        CommonSubdivision {
            mesh,
            n_vertices,
            crossings,
            weight,
            polygon_of,
            faces,
            halfedges_along,
            places,
            points,
        }
    }
}

/// The point in a form shared by all faces around it (for a point on an edge, weights in the direction of the even half-edge; for a vertex,
/// 1, 0, 0), and the corner and direction with which this face reads that form.
fn pack(mesh: &Mesh, face: FaceId, weights: [f64; 3]) -> (PackedPlace, FacePoint) {
    let is_zero = |k: usize| weights[k % 3] == 0.0;
    let vertex = (0..3).find(|&k| is_zero(k + 1) && is_zero(k + 2));
    let side = || (0..3).find(|&k| is_zero(k + 2));
    let (corner, backward) = match vertex {
        Some(corner) => (corner, false),
        None => side().map_or((0, false), |k| (k, mesh.face_halfedges(face)[k].0 & 1 == 1)),
    };
    let [first, second, third] = [corner, (corner + 1) % 3, (corner + 2) % 3];
    let order = if backward { [second, first, third] } else { [first, second, third] };
    let vertices = mesh.face_vertices(face);
    let point = FacePoint { vertices: order.map(|k| vertices[k]), weights: order.map(|k| weights[k]) };
    (PackedPlace { corner: corner as u8, backward }, point)
}
