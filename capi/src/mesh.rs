//! Meshes: connectivity with positions in space, or with edge lengths alone.

use crate::arrays::{self, copy_out, copy_rows};
use crate::choice::choose;
use crate::edges::signed_edge;
use crate::failure::{Failure, Outcome};
use crate::guard::{self, Poison, handle};
use crate::sized::{self, sized};
use crate::space::ricci_space;
use crate::status::ricci_status;
use ricci::Surface;
use ricci::geometry::space::Space;
use ricci::mesh::io::{Attributes, Soup};
use ricci::mesh::{Mesh, PerEdge, Point};
use std::mem::MaybeUninit;
use std::sync::Arc;

/// A connected oriented triangulated surface with the lengths of its edges. It never changes.
pub struct ricci_mesh {
    poison: Poison,
    pub(crate) connectivity: Arc<Mesh>,
    pub(crate) shape: Shape,
    /// What the file had beside positions and faces.
    pub(crate) attributes: Attributes,
}

/// Where the edge lengths come from.
#[derive(Clone)]
pub(crate) enum Shape {
    /// A surface in space.
    Positions(Arc<Vec<Point>>),
    /// An intrinsic surface: one length per edge, in this geometry.
    Lengths(Arc<PerEdge<f64>>, Space),
}

handle!(ricci_mesh, "mesh");

impl ricci_mesh {
    pub(crate) fn new(connectivity: Arc<Mesh>, shape: Shape) -> ricci_mesh {
        ricci_mesh { poison: Poison::default(), connectivity, shape, attributes: Attributes::default() }
    }

    pub(crate) fn from_soup(soup: Soup) -> Outcome<ricci_mesh> {
        let connectivity = Arc::new(Mesh::from_soup(&soup)?);
        let Soup { positions, attributes, .. } = soup;
        Ok(ricci_mesh { attributes, ..ricci_mesh::new(connectivity, Shape::Positions(Arc::new(positions))) })
    }

    pub(crate) fn positions(&self) -> Outcome<&[Point]> {
        match &self.shape {
            Shape::Positions(positions) => Ok(positions),
            Shape::Lengths(..) => {
                Err(Failure::argument("this mesh is intrinsic: it has lengths, no positions"))
            }
        }
    }

    /// The surface with the lengths that are measured in space, or those of an intrinsic mesh.
    pub(crate) fn surface(&self) -> Outcome<Surface> {
        let connectivity = self.connectivity.clone();
        Ok(match &self.shape {
            Shape::Positions(positions) => Surface::in_space(connectivity, positions.clone())?,
            Shape::Lengths(lengths, space) => Surface::intrinsic(connectivity, lengths.clone(), *space)?,
        })
    }

    /// The surface with lengths of the caller's, and the mesh's own positions if it has any.
    pub(crate) fn surface_with(&self, lengths: Vec<f64>, geometry: Space) -> Outcome<Surface> {
        let surface = Surface::intrinsic(self.connectivity.clone(), PerEdge::from(lengths), geometry)?;
        Ok(match &self.shape {
            Shape::Positions(positions) => surface.with_positions(positions.clone())?,
            Shape::Lengths(..) => surface,
        })
    }
}

/// Counts of a mesh.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ricci_mesh_summary {
    /// Bytes of this struct that are filled.
    pub size: usize,
    /// V.
    pub n_vertices: usize,
    /// E.
    pub n_edges: usize,
    /// F.
    pub n_faces: usize,
    /// Number of boundary loops; 0 for a closed surface.
    pub n_boundary_loops: usize,
    /// Number of vertices on the boundary.
    pub n_boundary_vertices: usize,
    /// V - E + F.
    pub euler: i64,
    /// (2 - euler - boundary loops) / 2.
    pub genus: usize,
    /// Number of normals of vertices: V, or 0 if the mesh was not read from a file that has them.
    pub n_normals: usize,
    /// Number of colours: V, or 0.
    pub n_colors: usize,
    /// Number of faces with texture coordinates: F, or 0.
    pub n_uv: usize,
    /// Number of faces with normals at their corners, instead of those of the vertices: F, or 0.
    pub n_corner_normals: usize,
}

// SAFETY: integers of 8 bytes, size first.
sized!(ricci_mesh_summary, "summary");

/// A mesh from positions and faces.
///
/// Both arrays are copied; vertices, faces and corners keep their order and numbers.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (stride), RICCI_TOO_LARGE, RICCI_DEFECTS (ask
/// ricci_diagnose_arrays for the list).
///
/// @param positions   n_vertices points: x, y, z as double; finite.
/// @param stride      bytes from one point to the next, at least 24; 0 means 24. Need not be a multiple of 8.
/// @param n_vertices  number of points.
/// @param faces       n_faces x 3 vertex indices, 0-based, consistently oriented.
/// @param n_faces     number of triangles, at least 1.
/// @param mesh        out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_from_arrays(
    positions: *const f64,
    stride: usize,
    n_vertices: usize,
    faces: *const u32,
    n_faces: usize,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make("mesh", mesh, |_| {
        let positions = arrays::points(positions, stride, n_vertices)?;
        let faces = arrays::faces(faces, n_faces)?;
        ricci_mesh::from_soup(Soup::new(positions, faces))
    })
}

/// ricci_mesh_from_arrays for faces of int32_t. A negative index is refused by face and corner.
///
/// @return as ricci_mesh_from_arrays; RICCI_ARGUMENT also for a negative index.
///
/// @param positions   n_vertices points: x, y, z as double; finite.
/// @param stride      bytes from one point to the next, at least 24; 0 means 24. Need not be a multiple of 8.
/// @param n_vertices  number of points.
/// @param faces       n_faces x 3 vertex indices, 0-based, consistently oriented.
/// @param n_faces     number of triangles, at least 1.
/// @param mesh        out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_from_arrays_i32(
    positions: *const f64,
    stride: usize,
    n_vertices: usize,
    faces: *const i32,
    n_faces: usize,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make("mesh", mesh, |_| {
        let positions = arrays::points(positions, stride, n_vertices)?;
        let faces = arrays::faces_i32(faces, n_faces)?;
        ricci_mesh::from_soup(Soup::new(positions, faces))
    })
}

/// An intrinsic surface: triangles glued along numbered edges, and a length for every edge.
///
/// Two vertices may share several edges, an edge may be a loop, a face may be glued to itself. Edge number e
/// (1-based in `face_edges`) is edge e - 1 of every per-edge array.
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_WRONG_SIZE (`n_edges` is not the number of edges),
/// RICCI_GLUING, RICCI_DEFECTS, RICCI_EDGE_LENGTH, RICCI_ARGUMENT, RICCI_TOO_LARGE.
///
/// @param n_vertices  number of vertices.
/// @param faces       n_faces x 3 vertex indices (a, b, c), 0-based.
/// @param face_edges  n_faces x 3 edge numbers (bc, ca, ab): 1-based, negative where the face runs against
///                    the edge's direction; each edge once with either sign, or once only (boundary).
/// @param n_faces     number of triangles, at least 1.
/// @param lengths     n_edges lengths, finite and positive.
/// @param n_edges     number of edges.
/// @param geometry    the geometry in which the lengths are meant.
/// @param mesh        out: the new handle, to be released by ricci_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_from_gluing(
    n_vertices: usize,
    faces: *const u32,
    face_edges: *const i32,
    n_faces: usize,
    lengths: *const f64,
    n_edges: usize,
    geometry: MaybeUninit<ricci_space>,
    mesh: *mut *mut ricci_mesh,
) -> ricci_status {
    guard::make("mesh", mesh, |_| {
        let geometry = choose(geometry)?;
        let faces = arrays::faces(faces, n_faces)?;
        let face_edges: Vec<[i32; 3]> = arrays::array("face_edges", face_edges.cast(), n_faces)?;
        let connectivity = Mesh::from_gluing(n_vertices, &faces, &face_edges)?;
        let lengths = arrays::array_of("lengths", lengths, n_edges, connectivity.n_edges())?;
        for (edge, &length) in lengths.iter().enumerate() {
            if !(length.is_finite() && length > 0.0) {
                return Err(ricci::Error::EdgeLength { edge, length }.into());
            }
        }
        let shape = Shape::Lengths(Arc::new(lengths.into()), geometry);
        Ok(ricci_mesh::new(Arc::new(connectivity), shape))
    })
}

/// Release a mesh. Metrics made from it live on.
///
/// @param mesh  the handle, or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_free(mesh: *mut ricci_mesh) {
    guard::free(mesh);
}

/// Counts, Euler characteristic, genus, boundary loops, and which attributes there are.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
///
/// @param mesh     the mesh.
/// @param summary  out: the counts.
/// @param size     sizeof *summary.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_summarise(
    mesh: *const ricci_mesh,
    summary: *mut ricci_mesh_summary,
    size: usize,
) -> ricci_status {
    guard::with(mesh, |ricci_mesh { connectivity: mesh, attributes, .. }| {
        let counts = ricci_mesh_summary {
            size,
            n_vertices: mesh.n_vertices(),
            n_edges: mesh.n_edges(),
            n_faces: mesh.n_faces(),
            n_boundary_loops: mesh.boundary_loops().len(),
            n_boundary_vertices: mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v)).count(),
            euler: mesh.euler(),
            genus: mesh.genus(),
            n_normals: attributes.normals.as_ref().map_or(0, Vec::len),
            n_colors: attributes.colors.as_ref().map_or(0, Vec::len),
            n_uv: attributes.uv.as_ref().map_or(0, Vec::len),
            n_corner_normals: attributes.corner_normals.as_ref().map_or(0, Vec::len),
        };
        sized::write(counts, summary, size)
    })
}

/// The positions a mesh was made from.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (the mesh is intrinsic).
///
/// @param mesh       the mesh.
/// @param positions  out: n_vertices x 3.
/// @param capacity   entries of `positions`, at least 3 n_vertices.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_positions(
    mesh: *const ricci_mesh,
    positions: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| copy_out("positions", mesh.positions()?, positions, capacity))
}

/// The vertices of every face, in corner order.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param mesh      the mesh.
/// @param faces     out: n_faces x 3 vertex indices (a, b, c).
/// @param capacity  entries of `faces`, at least 3 n_faces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_faces(
    mesh: *const ricci_mesh,
    faces: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(mesh, |mesh| copy_out("faces", &mesh.connectivity.triangles(), faces, capacity))
}

/// The edges opposite the corners of every face: how the triangles are glued, and where in a per-edge array a
/// face finds its sides.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param mesh        the mesh.
/// @param face_edges  out: n_faces x 3 edge numbers (bc, ca, ab): 1-based, negative where the face runs
///                    against the edge's direction.
/// @param capacity    entries of `face_edges`, at least 3 n_faces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_face_edges(
    mesh: *const ricci_mesh,
    face_edges: *mut i32,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let mesh = &door.shared(mesh)?.connectivity;
        let signed: Vec<[i32; 3]> = mesh
            .faces()
            .map(|f| {
                let [ab, bc, ca] = mesh.face_halfedges(f).map(signed_edge);
                [bc, ca, ab]
            })
            .collect();
        copy_out("face_edges", &signed, face_edges, capacity)
    })
}

/// The two ends of every edge, in the edge's direction.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param mesh      the mesh.
/// @param edges     out: n_edges x 2 vertex indices.
/// @param capacity  entries of `edges`, at least 2 n_edges.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_edges(
    mesh: *const ricci_mesh,
    edges: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let mesh = &door.shared(mesh)?.connectivity;
        let ends: Vec<[u32; 2]> = mesh.edges().map(|e| mesh.ends(e).map(|v| v.0)).collect();
        copy_out("edges", &ends, edges, capacity)
    })
}

/// The length of every edge, in space or as given.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_EDGE_LENGTH (two positions coincide).
///
/// @param mesh      the mesh.
/// @param lengths   out: n_edges lengths.
/// @param capacity  entries of `lengths`, at least n_edges.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_lengths(
    mesh: *const ricci_mesh,
    lengths: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let surface = door.shared(mesh)?.surface()?;
        let values = surface.lengths();
        copy_out("lengths", values, lengths, capacity)
    })
}

/// The vertices of every boundary loop, each loop with the surface on its left.
///
/// @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
///
/// @param mesh               the mesh.
/// @param vertices           out: n_boundary_vertices vertex indices, loop after loop.
/// @param vertices_capacity  entries of `vertices`.
/// @param starts             out: n_boundary_loops + 1 offsets: loop i is vertices[starts[i] .. starts[i +
///                           1]).
/// @param starts_capacity    entries of `starts`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_mesh_boundary(
    mesh: *const ricci_mesh,
    vertices: *mut u32,
    vertices_capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::call(|door| {
        let mesh = &door.shared(mesh)?.connectivity;
        let loops = mesh.boundary_loops();
        let rows = loops.iter().map(|walk| walk.iter().rev().map(|&h| mesh.origin(h).0));
        copy_rows("vertices", rows, (vertices, vertices_capacity), (starts, starts_capacity))
    })
}
