/* ricci: triangle lists that are no surface yet. Read, diagnose, repair, write.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_soup_read("scan.stl", &soup);                      // or ricci_soup_from_arrays
 *     ricci_soup_summarise(soup, &summary, sizeof summary);    // summary.n_defects
 *     ricci_soup_repair(soup, NULL, &repaired);                // NULL: what needs no guess
 *     ricci_soup_origins(repaired, vertices, n, faces, m);     // where its elements came from
 *     ricci_soup_mesh(repaired, &mesh);                        // RICCI_DEFECTS if some are left
 *
 * The conventions are those of ricci/ricci.h.
 *
 * Sources, by the keys of docs/bibliography.md: filled holes [BS95; Lie03; BS08].
 */

#ifndef RICCI_REPAIR_H
#define RICCI_REPAIR_H

#include <ricci/ricci.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * A triangle list with attributes, whatever its defects, and where it came from if it was repaired. It
 * never changes.
 */
typedef struct ricci_soup ricci_soup;

/** Counts of a triangle list, and what its repair did. */
typedef struct ricci_soup_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Number of vertices. */
    size_t n_vertices;
    /** Number of distinct edges. */
    size_t n_edges;
    /** Number of faces. */
    size_t n_faces;
    /** Number of defects; without any, a mesh can be built. */
    size_t n_defects;
    /** Connected pieces. */
    size_t n_components;
    /**
     * Boundary loops, as connected pieces of the edges with one face (where the surface is no manifold,
     * too).
     */
    size_t n_boundary_loops;
    /** V - E + F over the vertices in use. */
    int64_t euler;
    /** Genus; -1 where the surface is not a connected, orientable manifold. */
    int64_t genus;
    /** Number of normals of vertices: n_vertices, or 0. */
    size_t n_normals;
    /** Number of colours: n_vertices, or 0. */
    size_t n_colors;
    /** Number of faces with texture coordinates: n_faces, or 0. */
    size_t n_uv;
    /** Number of faces with normals at their corners: n_faces, or 0. */
    size_t n_corner_normals;
    /** Of a repaired list, as all below: vertices that became one with an earlier vertex. */
    size_t welded_vertices;
    /** Faces dropped because they used a vertex twice. */
    size_t degenerate_faces;
    /** Faces dropped because an earlier face had their vertices. */
    size_t duplicate_faces;
    /** Edges along which the surface was cut open. */
    size_t cut_edges;
    /** Vertices made for further fans of faces. */
    size_t split_vertices;
    /** Faces turned around. */
    size_t turned_faces;
    /** Faces of other components than the one that was asked for. */
    size_t faces_of_other_components;
    /** Vertices dropped because no face uses them. */
    size_t isolated_vertices;
    /** Edges in which welding would have made more than two faces meet: ricci_soup_refused lists them. */
    size_t refused_edges;
    /** Faces of all these edges together. */
    size_t refused_faces;
    /** Faces dropped because a corner has no finite place. */
    size_t non_finite_faces;
    /** Vertices put on the boundary edges on which they lie. */
    size_t joined_t_junctions;
    /** Edges collapsed because a face without area had two corners in nearly one place. */
    size_t collapsed_edges;
    /** Faces without area replaced by dividing the face beyond their longest edge. */
    size_t flipped_edges;
    /** Faces without area dropped at the boundary. */
    size_t opened_faces;
    /** Boundary loops that were filled. */
    size_t filled_holes;
    /** Boundary loops that were to be filled and could not be. */
    size_t open_holes;
    /** Of any list: findings that are no defects, see ricci_soup_hint. */
    size_t n_hints;
    /** Number of loops of ricci_soup_loops: chains that end in an edge of more than two faces are none. */
    size_t n_loops;
    /** Number of vertices of all these loops. */
    size_t n_loop_vertices;
    /** Number of further numbers of every vertex, see ricci_soup_numbers. */
    size_t n_vertex_numbers;
    /** Number of further numbers of every face. */
    size_t n_face_numbers;
} ricci_soup_summary;

/** One defect. The pointers are views into the soup and live as long as it does. */
typedef struct ricci_defect {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Stable name of the kind of defect, such as "non_manifold_edge". */
    const char *code;
    /** One sentence with the elements concerned. */
    const char *message;
    /** Advice what to do about it. */
    const char *remedy;
    /** The vertices concerned: n_vertices 0-based indices. */
    const uint32_t *vertices;
    /** Number of vertices. */
    size_t n_vertices;
    /** The faces concerned: n_faces 0-based indices. */
    const uint32_t *faces;
    /** Number of faces. */
    size_t n_faces;
} ricci_defect;

/** A hole that a repair was asked to fill. */
typedef struct ricci_hole {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** "filled", or the reason why it was left open: a view into the soup. */
    const char *reason;
    /** Number of edges of its loop. */
    size_t n_edges;
    /** The first face of its patch; the others follow. */
    size_t first_face;
    /** Number of faces of the patch; 0 where it was left open, as all below. */
    size_t n_faces;
    /** The first vertex inside the patch; the others follow. */
    size_t first_vertex;
    /** Number of vertices inside the patch. */
    size_t n_vertices;
    /** Length of the loop; NaN where it was left open, as the area. */
    double length;
    /** Area of the patch. */
    double area;
    /** The vertex of the loop with the lowest number, in the repaired list. */
    uint32_t vertex;
    /** 1 where it was filled. */
    uint32_t filled;
} ricci_hole;

/**
 * Steps of a repair that are done on request only. These are always done: dropping faces that use a vertex
 * twice or repeat a face, giving each fan of faces a vertex of its own, turning faces until neighbours agree,
 * dropping isolated vertices. Zeroed by ricci_init: the defaults.
 */
typedef struct ricci_repair_options {
    /** sizeof(ricci_repair_options). */
    size_t size;
    /**
     * Vertices within this distance become one; 0: those in exactly the same place, where their faces are
     * then connected through edges, but not in edges in which more than two faces would meet
     * (ricci_soup_refused); negative: no welding. ricci_soup_hint names the distance that closes an open
     * seam.
     */
    double weld;
    /**
     * Keep one connected piece: 1 is that with the most faces, 2 the next, and so on, up to n_components; 0:
     * all. ricci_soup_origins is then the way back from the piece to the list. 1 suits scans with loose
     * pieces.
     */
    size_t component;
    /**
     * 1 cuts the surface open along edges in which more than two faces meet. 0 suits solids, where such an
     * edge is a mistake to be looked at; 1 unions of sheets.
     */
    uint32_t cut_non_manifold_edges;
    /**
     * 1 drops the faces of vertices whose coordinates are not finite, which are RICCI_DEFECTS otherwise. 1
     * suits scans and brain surfaces with missing vertices, together with fill_holes.
     */
    uint32_t drop_non_finite;
    /**
     * 1 divides faces at vertices that lie on their boundary edges, before welding. 1 suits tessellations of
     * CAD programs face by face.
     */
    uint32_t split_t_junctions;
    /**
     * 1 mends faces without area by collapses and flips; vertices keep their places. 1 suits files of CAD
     * programs, whose slivers no metric has.
     */
    uint32_t mend_zero_area;
    /**
     * Fill the boundary loops of at most so many edges; 0: none; SIZE_MAX: all. 100 fills small holes of
     * scans and leaves openings that are meant.
     */
    size_t fill_holes;
    /**
     * In place of it, vertices of the given list: the loops through them are filled. NULL: none. It suits
     * parts of which one opening alone is a mistake.
     */
    const uint32_t *holes;
    /** Number of these vertices. 0 with NULL. */
    size_t n_holes;
} ricci_repair_options;

/**
 * A triangle list from arrays, which are copied. It may have any defects.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (stride), RICCI_TOO_LARGE, RICCI_NO_MEMORY.
 *
 * @param positions   n_vertices points: x, y, z as double.
 * @param stride      bytes from one point to the next, at least 24; 0 means 24.
 * @param n_vertices  number of points.
 * @param faces       n_faces x 3 vertex indices, 0-based.
 * @param n_faces     number of triangles.
 * @param soup        out: the new handle, to be released by ricci_soup_free.
 */
RICCI_API ricci_status ricci_soup_from_arrays(const double *positions, size_t stride, size_t n_vertices,
                                              const uint32_t *faces, size_t n_faces, ricci_soup **soup);

/**
 * The same triangle list with attributes of the caller's in place of its own; ricci_soup_mesh hands them on
 * to a mesh. The list counts as one that was not repaired.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (a texture, which belongs to a
 * file), RICCI_NO_MEMORY.
 *
 * @param soup        the triangle list.
 * @param attributes  the attributes, which are copied; `png` NULL.
 * @param result      out: the new handle, to be released by ricci_soup_free.
 */
RICCI_API ricci_status ricci_soup_with_attributes(const ricci_soup *soup, const ricci_attributes *attributes,
                                                  ricci_soup **result);

/**
 * A triangle list from a mesh file, with its attributes, in the file's numbers.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (not UTF-8), RICCI_IO, RICCI_PARSE,
 * RICCI_UNKNOWN_FORMAT.
 *
 * @param path  file name in UTF-8, ending in .obj, .off, .ply, .stl, .glb, .gltf, .gii, .vtk, .vtp, .mz3, or
 *              as FreeSurfer names surfaces (.white, .pial, .inflated, .sphere, .reg, .orig, .smoothwm,
 *              .midthickness, .asc), or in one of these and .gz.
 * @param soup  out: the new handle, to be released by ricci_soup_free.
 */
RICCI_API ricci_status ricci_soup_read(const char *path, ricci_soup **soup);

/**
 * Release a triangle list.
 *
 * @param soup  the handle, or NULL.
 */
RICCI_API_VOID void ricci_soup_free(ricci_soup *soup);

/**
 * Counts of the triangle list, the number of its defects, and the steps of a repair. The first call diagnoses
 * it.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param soup     the triangle list.
 * @param summary  out: the counts.
 * @param size     sizeof *summary.
 */
RICCI_API ricci_status ricci_soup_summarise(const ricci_soup *soup, ricci_soup_summary *summary, size_t size);

/**
 * How well shaped the triangles of a list are: as a surface if it is one; else face by face, without those
 * that name no vertex or one that is not finite.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param soup     the triangle list.
 * @param quality  out: the figures.
 * @param size     sizeof *quality.
 */
RICCI_API ricci_status ricci_soup_quality(const ricci_soup *soup, ricci_quality_summary *quality,
                                          size_t size);

/**
 * Positions, or an attribute.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (it has none).
 *
 * @param soup      the triangle list.
 * @param which     RICCI_POSITIONS, RICCI_NORMALS, RICCI_COLORS, RICCI_UV or RICCI_CORNER_NORMALS.
 * @param values    out: the numbers, in the shape that is documented at the constant.
 * @param capacity  entries of `values`.
 */
RICCI_API ricci_status ricci_soup_values(const ricci_soup *soup, uint32_t which, double *values,
                                         size_t capacity);

/**
 * The vertices of every face.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param soup      the triangle list.
 * @param faces     out: n_faces x 3 vertex indices.
 * @param capacity  entries of `faces`, at least 3 n_faces.
 */
RICCI_API ricci_status ricci_soup_faces(const ricci_soup *soup, uint32_t *faces, size_t capacity);

/**
 * One defect.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (index), RICCI_STRUCT_SIZE.
 *
 * @param soup    the triangle list.
 * @param index   which one, below n_defects.
 * @param defect  out: the defect.
 * @param size    sizeof *defect.
 */
RICCI_API ricci_status ricci_soup_defect(const ricci_soup *soup, size_t index, ricci_defect *defect,
                                         size_t size);

/**
 * One finding that is no defect and still seldom meant: an open seam of nearly coincident vertices with the
 * weld that closes it, T-junctions, coordinates in single precision far from the origin.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (index), RICCI_STRUCT_SIZE.
 *
 * @param soup   the triangle list.
 * @param index  which one, below n_hints.
 * @param hint   out: the finding.
 * @param size   sizeof *hint.
 */
RICCI_API ricci_status ricci_soup_hint(const ricci_soup *soup, size_t index, ricci_defect *hint, size_t size);

/**
 * The boundary loops, in the order in which other functions and the command number them, with their vertices
 * in the direction of the faces beside them. Positions that are not finite give a loop the length NaN.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param soup               the triangle list.
 * @param lengths            out: n_loops lengths.
 * @param lengths_capacity   entries of `lengths`.
 * @param vertices           out: n_loop_vertices vertices, loop by loop.
 * @param vertices_capacity  entries of `vertices`.
 * @param starts             out: n_loops + 1 entries: the offsets of each loop in `vertices`, and the end
 *                           of the last.
 * @param starts_capacity    entries of `starts`.
 */
RICCI_API ricci_status ricci_soup_loops(const ricci_soup *soup, double *lengths, size_t lengths_capacity,
                                        uint32_t *vertices, size_t vertices_capacity, size_t *starts,
                                        size_t starts_capacity);

/**
 * The edges of two faces at which the surface turns by an angle or more. Faces without area have none.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (an angle out of range).
 *
 * @param soup               the triangle list.
 * @param angle              radians between the normals of the faces, more than 0 and at most pi.
 * @param vertices           out: 2 vertices of each edge; NULL with capacity 0 asks for the number alone.
 * @param vertices_capacity  entries of `vertices`.
 * @param angles             out: the angle at each edge.
 * @param angles_capacity    entries of `angles`.
 * @param n_edges            out: the number of these edges.
 */
RICCI_API ricci_status ricci_soup_sharp_edges(const ricci_soup *soup, double angle, uint32_t *vertices,
                                              size_t vertices_capacity, double *angles,
                                              size_t angles_capacity, size_t *n_edges);

/**
 * The vertices at which lines of sharp edges and of the boundary end, branch, or turn by the angle or more.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (an angle out of range).
 *
 * @param soup       the triangle list.
 * @param angle      radians, more than 0 and at most pi.
 * @param vertices   out: the vertices, ascending; NULL with capacity 0 asks for the number alone.
 * @param capacity   entries of `vertices`.
 * @param n_corners  out: the number of these vertices.
 */
RICCI_API ricci_status ricci_soup_corners(const ricci_soup *soup, double angle, uint32_t *vertices,
                                          size_t capacity, size_t *n_corners);

/**
 * One hole that a repair was asked to fill: first those that it filled, then those that it left open.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (index, it was not repaired), RICCI_STRUCT_SIZE.
 *
 * @param repaired  a list of ricci_soup_repair.
 * @param index     which one, below filled_holes + open_holes.
 * @param hole      out: the hole.
 * @param size      sizeof *hole.
 */
RICCI_API ricci_status ricci_soup_hole(const ricci_soup *repaired, size_t index, ricci_hole *hole,
                                       size_t size);

/**
 * The mesh of a triangle list without defects, with its attributes.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_TOO_LARGE, RICCI_DEFECTS.
 *
 * @param soup  the triangle list.
 * @param mesh  out: the new handle, to be released by ricci_mesh_free.
 */
RICCI_API ricci_status ricci_soup_mesh(const ricci_soup *soup, ricci_mesh **mesh);

/**
 * Write a triangle list, which may have defects, in the format of the file's extension, with its attributes;
 * those that the format has no place for are left out, with a warning to the callback of ricci_log_set.
 *
 * A file of that name is replaced only once the new one is complete.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_IO, RICCI_UNKNOWN_FORMAT, RICCI_ARGUMENT (an attribute is not
 * finite), RICCI_TOO_LARGE.
 *
 * @param soup  the triangle list.
 * @param path  file name in UTF-8, ending in .obj, .off, .ply or .glb.
 */
RICCI_API ricci_status ricci_soup_write(const ricci_soup *soup, const char *path);

/**
 * Repair every defect that takes no guess. Defects that are left are a result, not an error.
 *
 * Elements keep their order, and attributes stay with their elements; those of filled holes come last.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (options, no such component), RICCI_TOO_LARGE,
 * RICCI_STRUCT_SIZE, RICCI_DEFECTS (a face that names no vertex or, without drop_non_finite, one without
 * finite coordinates), RICCI_CANCELLED (the control of the thread).
 *
 * @param soup      the triangle list.
 * @param options   the steps on request, or NULL for the defaults.
 * @param repaired  out: the new handle, to be released by ricci_soup_free.
 */
RICCI_API ricci_status ricci_soup_repair(const ricci_soup *soup, const ricci_repair_options *options,
                                         ricci_soup **repaired);

/**
 * The origins of the elements of a repaired list; UINT32_MAX for those of filled holes. The origin of a face
 * is the face in which it lies.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (it was not repaired).
 *
 * @param repaired           a list of ricci_soup_repair.
 * @param vertices           out: n_vertices vertices of the list that was repaired.
 * @param vertices_capacity  entries of `vertices`.
 * @param faces              out: n_faces faces of that list.
 * @param faces_capacity     entries of `faces`.
 */
RICCI_API ricci_status ricci_soup_origins(const ricci_soup *repaired, uint32_t *vertices,
                                          size_t vertices_capacity, uint32_t *faces, size_t faces_capacity);

/**
 * The edges that kept vertices in exactly the same place from being welded throughout.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (it was not repaired).
 *
 * @param repaired           a list of ricci_soup_repair.
 * @param vertices           out: refused_edges x 2 vertices of the list that was repaired: the first in the
 *                           place of either end.
 * @param vertices_capacity  entries of `vertices`.
 * @param faces              out: the refused_faces faces of that list that would meet, edge by edge.
 * @param faces_capacity     entries of `faces`.
 * @param starts             out: refused_edges + 1 entries: the offsets at which each edge's faces start in
 *                           `faces`, and the end of the last.
 * @param starts_capacity    entries of `starts`.
 */
RICCI_API ricci_status ricci_soup_refused(const ricci_soup *repaired, uint32_t *vertices,
                                          size_t vertices_capacity, uint32_t *faces, size_t faces_capacity,
                                          size_t *starts, size_t starts_capacity);

#ifdef __cplusplus
}
#endif

/* They were parts of this header. */
#include <ricci/labels.h>
#include <ricci/refine.h>

#endif
