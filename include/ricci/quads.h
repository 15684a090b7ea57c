/* ricci: quad meshes of seamless metrics, and layouts of few large four-sided patches.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_seamless_new(mesh, NULL, NULL, &seamless);
 *     ricci_quads_new(seamless, NULL, NULL, &quads);           // about 1,000 quads
 *     ricci_quads_summarise(quads, &summary, sizeof summary);
 *     ricci_quads_faces(quads, corners, 4 * summary.n_quads);
 *     ricci_quads_positions(quads, positions, 3 * summary.n_vertices);
 *
 * The conventions are those of ricci/ricci.h; faces of a quad mesh are n x 4, counterclockwise seen from
 * outside.
 *
 * A library that was built without the feature `quads` has these functions; each answers RICCI_LEFT_OUT.
 *
 * Sources, by the keys of docs/bibliography.md: motorcycle graphs [EGKT08], whole lengths of arcs [LCK21].
 */

#ifndef RICCI_QUADS_H
#define RICCI_QUADS_H

#include <ricci/ricci.h>
#include <ricci/seamless.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A mesh of quads on a surface. */
typedef struct ricci_quads ricci_quads;
/** A layout of four-sided patches on a quad mesh, each a rectangle of quads. */
typedef struct ricci_quad_layout ricci_quad_layout;

/** How the size of the quads is told. */
enum {
    /** A quad mesh has about 1,000 quads, a layout as few patches as the lines between cones allow. */
    RICCI_QUADS_DEFAULT = 0,
    /** About `n_quads` quads. */
    RICCI_QUADS_NUMBER = 1,
    /** Edges of about the length `edge`. */
    RICCI_QUADS_EDGE = 2,
    /** As few quads as the lines between cones allow. */
    RICCI_QUADS_COARSE = 3,
    /** At most `n_quads` quads, each side as near as that allows to its length on the surface. */
    RICCI_QUADS_AT_MOST = 4
};

/** Options of quad meshes and layouts. Zeroed by ricci_init: the defaults. */
typedef struct ricci_quads_options {
    /** sizeof(ricci_quads_options). */
    size_t size;
    /**
     * RICCI_QUADS_*: how the size of the quads is told. Of a layout they are its unit squares. Start with the
     * default to see the cones.
     */
    uint32_t sizing;
    /** 0. */
    uint32_t reserved;
    /**
     * RICCI_QUADS_NUMBER, RICCI_QUADS_AT_MOST: the number of quads, 1 or more. Fewer than RICCI_QUADS_COARSE
     * has are not to be had.
     */
    size_t n_quads;
    /**
     * RICCI_QUADS_EDGE: the length of edges, positive, in the units of the surface's lengths. The wanted
     * spacing of the control mesh.
     */
    double edge;
    /** Threads; 0: one for each core. 1 suits hosts that run several calls at once. */
    size_t threads;
} ricci_quads_options;

/** Figures of a quad mesh. The shape of the quads is NaN on a surface without positions. */
typedef struct ricci_quads_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Quads. */
    size_t n_quads;
    /** Vertices. */
    size_t n_vertices;
    /** Vertices inside that have not four quads, and on the boundary that have not two. */
    size_t n_irregular;
    /** Quads that were collapsed because two of their sides were one edge: those around cones of valence 1.
     */
    size_t n_collapsed;
    /** Edges on features and on the boundary. */
    size_t n_creases;
    /** Features that are not parallel to an axis exactly, so that edges need not run along them. */
    size_t n_off_axis;
    /** Rectangles of the T-mesh of the seamless map. */
    size_t n_rectangles;
    /** Arcs of the T-mesh. */
    size_t n_arcs;
    /** Vertices less edges plus quads, counted anew from the quads. */
    int64_t euler;
    /** Edges with more than one quad on a side, and sides of quads that have a vertex twice. */
    size_t n_bad_edges;
    /** Vertices whose quads form more than one fan. */
    size_t n_bad_vertices;
    /** The sum over the arcs of the squares of the edges along them less the wanted number of edges. */
    double cost;
    /** The edge length that was asked for, or found for a number of quads, units of the surface's lengths. */
    double edge;
    /** The mean deviation of the corners' angles from 90 degrees in space, radians. */
    double angle_mean;
    /** The largest deviation of a corner's angle from 90 degrees, radians. */
    double angle_max;
    /** The mean length of the edges in space. */
    double edge_mean;
    /** The standard deviation of the lengths of the edges over their mean. */
    double edge_deviation;
} ricci_quads_summary;

/** Figures of a layout of patches. */
typedef struct ricci_quad_layout_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Nodes, where arcs end. */
    size_t n_nodes;
    /** Arcs between nodes. */
    size_t n_arcs;
    /** Patches. */
    size_t n_patches;
    /** Unit squares of all patches. */
    size_t n_units;
    /** Edges of the quad mesh in one unit of length. */
    size_t n_parts;
    /** Quads of the quad mesh. */
    size_t n_quads;
    /** Vertices of the quad mesh. */
    size_t n_vertices;
} ricci_quad_layout_summary;

/**
 * The quad mesh of a seamless metric. The lines from the cones and corners of its map divide the surface into
 * rectangles; their sides get whole lengths near the wanted ones; vertices are the whole points of the map.
 * Every vertex that is no cone or corner has four quads, two on the boundary, and features and the boundary
 * are chains of edges.
 *
 * Deterministic.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (an unknown sizing, a number or an
 * edge length that is not positive), RICCI_LAYOUT (a metric so far from its target that its seams do not turn
 * by multiples of 90 degrees), RICCI_TOO_LARGE, RICCI_NO_MEMORY, RICCI_FACTORISATION, RICCI_CANCELLED.
 *
 * @param seamless  the seamless metric.
 * @param options   the options; NULL for the defaults.
 * @param control   progress and cancellation; NULL for neither.
 * @param quads     out: the new handle, to be released by ricci_quads_free.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quads_new(const ricci_seamless *seamless,
                                                          const ricci_quads_options *options,
                                                          const ricci_control *control, ricci_quads **quads);

/**
 * Release a quad mesh.
 *
 * @param quads  the handle, or NULL.
 */
RICCI_API_VOID void ricci_quads_free(ricci_quads *quads);

/**
 * The figures.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param quads    the quad mesh.
 * @param summary  out: the figures.
 * @param size     sizeof *summary.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quads_summarise(const ricci_quads *quads,
                                                                ricci_quads_summary *summary, size_t size);

/**
 * The corners of each quad, counterclockwise seen from outside.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param quads     the quad mesh.
 * @param faces     out: n_quads x 4 vertices.
 * @param capacity  entries of `faces`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quads_faces(const ricci_quads *quads, uint32_t *faces,
                                                            size_t capacity);

/**
 * Where the vertices lie on the mesh from which the seamless metric was made.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param quads             the quad mesh.
 * @param faces             out: for each vertex a triangle of the mesh that contains it.
 * @param faces_capacity    entries of `faces`.
 * @param weights           out: n_vertices x 3: its barycentric coordinates there.
 * @param weights_capacity  entries of `weights`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quads_places(const ricci_quads *quads, uint32_t *faces,
                                                             size_t faces_capacity, double *weights,
                                                             size_t weights_capacity);

/**
 * The vertices in space.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (a surface without positions), RICCI_BUFFER_TOO_SMALL.
 *
 * @param quads      the quad mesh.
 * @param positions  out: n_vertices x 3.
 * @param capacity   entries of `positions`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quads_positions(const ricci_quads *quads, double *positions,
                                                                size_t capacity);

/**
 * The edges on features and on the boundary, each by the vertices at its ends.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param quads     the quad mesh.
 * @param vertices  out: n_creases x 2 vertices.
 * @param capacity  entries of `vertices`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quads_creases(const ricci_quads *quads, uint32_t *vertices,
                                                              size_t capacity);

/**
 * The rectangle of the T-mesh that each quad is a part of. Those of some rectangles have no quads.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param quads       the quad mesh.
 * @param rectangles  out: n_quads numbers below n_rectangles.
 * @param capacity    entries of `rectangles`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quads_rectangles(const ricci_quads *quads,
                                                                 uint32_t *rectangles, size_t capacity);

/**
 * The layout of a seamless metric: the patches between the lines of edges that go straight on from the
 * irregular vertices of its quad mesh, and from corners of features and of the boundary. Each patch is a
 * rectangle of unit squares, each of which has n_parts x n_parts quads.
 *
 * Deterministic.
 * @return as ricci_quads_new.
 *
 * @param seamless  the seamless metric.
 * @param options   the options; NULL for the defaults.
 * @param control   progress and cancellation; NULL for neither.
 * @param layout    out: the new handle, to be released by ricci_quad_layout_free.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_layout_new(const ricci_seamless *seamless,
                                                                const ricci_quads_options *options,
                                                                const ricci_control *control,
                                                                ricci_quad_layout **layout);

/**
 * Release a layout. Its quad mesh lives on.
 *
 * @param layout  the handle, or NULL.
 */
RICCI_API_VOID void ricci_quad_layout_free(ricci_quad_layout *layout);

/**
 * The figures.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param layout   the layout.
 * @param summary  out: the figures.
 * @param size     sizeof *summary.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_layout_summarise(const ricci_quad_layout *layout,
                                                                      ricci_quad_layout_summary *summary,
                                                                      size_t size);

/**
 * The quad mesh under the patches, n_parts edges to a unit of length.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_NO_MEMORY.
 *
 * @param layout  the layout.
 * @param quads   out: the new handle, to be released by ricci_quads_free.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_layout_quads(const ricci_quad_layout *layout,
                                                                  ricci_quads **quads);

/**
 * The nodes: the vertex of the quad mesh, the number of patches around it, and 1 on features and the
 * boundary, else 0.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param layout    the layout.
 * @param nodes     out: n_nodes x 3 numbers.
 * @param capacity  entries of `nodes`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_layout_nodes(const ricci_quad_layout *layout,
                                                                  uint32_t *nodes, size_t capacity);

/**
 * The arcs: the nodes at both ends, the whole length, and 1 on features and the boundary, else 0.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param layout    the layout.
 * @param arcs      out: n_arcs x 4 numbers.
 * @param capacity  entries of `arcs`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_layout_arcs(const ricci_quad_layout *layout,
                                                                 uint32_t *arcs, size_t capacity);

/**
 * The vertices of the quad mesh along each arc, from its first node to its second; n_parts edges to a unit of
 * its length.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param layout           the layout.
 * @param vertices         out: the vertices of all arcs, one arc after the other.
 * @param capacity         entries of `vertices`.
 * @param starts           out: n_arcs + 1 offsets: where each arc starts in `vertices`, and the last one
 * ends.
 * @param starts_capacity  entries of `starts`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_layout_arc_vertices(const ricci_quad_layout *layout,
                                                                         uint32_t *vertices, size_t capacity,
                                                                         size_t *starts,
                                                                         size_t starts_capacity);

/**
 * The arcs along the four sides of each patch, counterclockwise: side i of patch p is list 4 p + i.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param layout           the layout.
 * @param sides            out: arc a as a + 1 in its direction and -(a + 1) against it, one side after the
 *                         other.
 * @param capacity         entries of `sides`.
 * @param starts           out: 4 n_patches + 1 offsets: where each side starts in `sides`, and the last ends.
 * @param starts_capacity  entries of `starts`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_layout_sides(const ricci_quad_layout *layout,
                                                                  int32_t *sides, size_t capacity,
                                                                  size_t *starts, size_t starts_capacity);

/**
 * The lengths of the first and the second side of each patch; opposite sides have the same.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param layout    the layout.
 * @param sizes     out: n_patches x 2 whole lengths.
 * @param capacity  entries of `sizes`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_layout_sizes(const ricci_quad_layout *layout,
                                                                  uint32_t *sizes, size_t capacity);

/**
 * The patch of each quad of the quad mesh.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param layout    the layout.
 * @param patches   out: n_quads patches.
 * @param capacity  entries of `patches`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_layout_patches(const ricci_quad_layout *layout,
                                                                    uint32_t *patches, size_t capacity);

#ifdef __cplusplus
}
#endif

#endif
