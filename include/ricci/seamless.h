/* ricci: seamless metrics and maps, whose cones and handles turn by multiples of 90 degrees.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_seamless_new(mesh, NULL, NULL, &result);
 *     ricci_seamless_summarise(result, &summary, sizeof summary);
 *     ricci_seamless_map(result, NULL, &layout);   // a layout with exact seams
 *
 * The conventions are those of ricci/ricci.h.
 *
 * A library that was built without the feature `quads` has these functions; each answers RICCI_LEFT_OUT.
 *
 * Sources, by the keys of docs/bibliography.md: prescribed turning [CZ24], cross fields [KCPS13], maps of
 * least stretch [SS15].
 */

#ifndef RICCI_SEAMLESS_H
#define RICCI_SEAMLESS_H

#include <ricci/flatten.h>
#include <ricci/uniformize.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A flat metric whose angles around cones and along loops are multiples of 90 degrees. */
typedef struct ricci_seamless ricci_seamless;

/** The way in which the cones of a seamless metric are chosen. */
enum {
    /**
     * Those of the smoothest field of four directions: along features and the boundary, near strokes and
     * principal curvature.
     */
    RICCI_SEAMLESS_FIELD = 0,
    /** `n_cones` cones, placed so that areas change little, their angles rounded to multiples of 90 degrees.
     * Closed surfaces without features only. */
    RICCI_SEAMLESS_AUTO = 1,
    /** The `vertices` with their `valences`. */
    RICCI_SEAMLESS_VALENCES = 2
};

/** Options of a seamless metric. Zeroed by ricci_init: the defaults. */
typedef struct ricci_seamless_options {
    /** sizeof(ricci_seamless_options). */
    size_t size;
    /**
     * RICCI_SEAMLESS_*: how cones are chosen. The field suits quad meshes along features; the second is for
     * closed surfaces with few cones.
     */
    uint32_t cones;
    /** 0. */
    uint32_t reserved;
    /**
     * RICCI_SEAMLESS_AUTO: the number of cones; RICCI_SEAMLESS_VALENCES: entries of both arrays. 8 on a
     * sphere are the corners of a cube.
     */
    size_t n_cones;
    /** RICCI_SEAMLESS_VALENCES: the vertices of the cones. Corners of the shape are good places. */
    const uint32_t *vertices;
    /**
     * RICCI_SEAMLESS_VALENCES: the number of right angles around each, 1 or more; 4 at any other vertex
     * inside, 2 at any other on the boundary. The sum of 4 - valence, and of 2 - valence on the boundary, is
     * 4 chi. Without features only. 3 and 5 suit most corners, 1 and 2 tips.
     */
    const uint32_t *valences;
    /**
     * The turning of each of the `n_loops` paths, quarter turns; NULL: the nearest to that of the conformal
     * metric with these cones. NULL distorts least.
     */
    const int32_t *quarter_turns;
    /** Its entries, `n_loops`. 0 with NULL. */
    size_t n_quarter_turns;
    /**
     * Largest deviation of an angle from its target, radians; 0: 1e-10. Keep the default: since Newton's last
     * steps double the digits, a larger one saves little.
     */
    double tolerance;
    /** Most Newton steps after the conformal flow; 0: 100. 26 is the most in docs/results/seamless.md. */
    size_t max_iterations;
    /** Threads; 0: one for each core. 1 suits hosts that run several calls at once. */
    size_t threads;
    /**
     * Edges, by the two vertices at their ends, that become straight and parallel to an axis, with angles of
     * multiples of 90 degrees where they meet; NULL: none. Edges of the boundary do so anyway. Those around a
     * piece with too few vertices to have right angles in all its corners are left out; with the cones of the
     * field also those near angles that are furthest off where the target is not reached. Give the edges of
     * the CAD model, or `feature_angle`.
     */
    const uint32_t *features;
    /** The number of features. 0 with NULL. */
    size_t n_features;
    /**
     * Edges at which the surface turns by so many radians are features too; 0: none. 0.7 (40 degrees) is that
     * of docs/results/seamless.md and suits parts; 0 suits scans, whose noise has sharp edges too.
     */
    double feature_angle;
    /**
     * The strength by which the field is drawn along principal curvature; 0: not at all. Raise it until quads
     * follow folds; 0 suits shapes without a preferred direction.
     */
    double curvature;
    /**
     * Vertices at which the field is drawn along strokes; NULL: none. A few strokes suffice where the field
     * is free otherwise.
     */
    const uint32_t *stroke_vertices;
    /** Their directions in space, 3 numbers each. Their lengths do not count. */
    const double *strokes;
    /** The number of strokes. 0 with NULL. */
    size_t n_strokes;
    /**
     * Steps towards the lengths of the surface with the same angles and turning; 0: none. 0 is the fastest;
     * more make quads of more even size.
     */
    size_t isometric_steps;
    /**
     * Per vertex the factor by which lengths near it are to be larger than those of the surface, for the
     * isometric steps; NULL: 1. 2 where quads are to be half as long.
     */
    const double *sizes;
    /** Its entries, one for each vertex. 0 with NULL. */
    size_t n_sizes;
} ricci_seamless_options;

/** Figures of a seamless metric. */
typedef struct ricci_seamless_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** 1 if every angle is within the tolerance of its target; else 0. */
    uint32_t converged;
    /** 0. */
    uint32_t reserved;
    /** Cones, and corners of the boundary. */
    size_t n_cones;
    /**
     * Paths whose turning decides that of all others: 2g loops on a closed surface; between features and the
     * boundary, two to a handle, and arcs to each walk along features from the first of its piece.
     */
    size_t n_loops;
    /** Steps of the conformal flow. */
    size_t flow_iterations;
    /** Newton steps after it. */
    size_t iterations;
    /** Edge flips. */
    size_t n_flips;
    /**
     * Largest deviation, radians, of the angle around a vertex from its target, and of the turning of loops
     * that were found anew, from another vertex, from multiples of 90 degrees.
     */
    double error;
    /** The tolerance that was asked for. */
    double tolerance;
    /** Features and edges of the boundary, which are straight. */
    size_t n_features;
    /**
     * Root mean square over the edges of the change of twice the logarithm of lengths, less its mean, before
     * the isometric steps.
     */
    double conformal_change;
    /** The same in the result. */
    double length_change;
    /** Features inside the surface that were asked for and are not straight. */
    size_t n_left_out;
} ricci_seamless_summary;

/**
 * A seamless metric of a surface near its conformal class: first the conformal metric with the cones, then
 * least changes of the logarithms of lengths until the loops turn as they are to. Edges of the boundary and
 * features become straight lines parallel to an axis.
 *
 * Not reaching the target is RICCI_OK with `converged` 0. Deterministic.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (an unknown
 * choice, one that does not fit a boundary or features, a tolerance that is not positive), RICCI_WRONG_SIZE
 * (quarter turns), RICCI_TARGET_KIND (cones or a signature that no metric has), RICCI_EDGE_LENGTH,
 * RICCI_TRIANGLE_INEQUALITY, RICCI_EDGE_WEIGHT, RICCI_DOMAIN, RICCI_TOO_LARGE, RICCI_NO_MEMORY,
 * RICCI_FACTORISATION, RICCI_CANCELLED.
 *
 * @param mesh     the mesh.
 * @param options  the options; NULL for the defaults.
 * @param control  progress and cancellation; NULL for neither.
 * @param result   out: the new handle, to be released by ricci_seamless_free.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_seamless_new(const ricci_mesh *mesh,
                                                             const ricci_seamless_options *options,
                                                             const ricci_control *control,
                                                             ricci_seamless **result);

/**
 * Release a seamless metric. Handles that were made from it live on.
 *
 * @param result  the handle, or NULL.
 */
RICCI_API_VOID void ricci_seamless_free(ricci_seamless *result);

/**
 * The figures.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param result   the seamless metric.
 * @param summary  out: the figures.
 * @param size     sizeof *summary.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_seamless_summarise(const ricci_seamless *result,
                                                                   ricci_seamless_summary *summary,
                                                                   size_t size);

/**
 * The cones, by vertex: the vertex and its valence, the number of right angles around it.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_WRONG_SIZE.
 *
 * @param result    the seamless metric.
 * @param cones     out: 2 `n_cones` numbers.
 * @param capacity  the room in `cones`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_seamless_cones(const ricci_seamless *result, uint32_t *cones,
                                                               size_t capacity);

/**
 * The turning of each loop that was asked for, quarter turns.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_WRONG_SIZE.
 *
 * @param result         the seamless metric.
 * @param quarter_turns  out: `n_loops` numbers.
 * @param capacity       the room in `quarter_turns`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_seamless_turning(const ricci_seamless *result,
                                                                 int32_t *quarter_turns, size_t capacity);

/**
 * The features that were kept and the edges of the boundary, each by the vertices at its ends.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param result    the seamless metric.
 * @param vertices  out: 2 `n_features` numbers.
 * @param capacity  the room in `vertices`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_seamless_features(const ricci_seamless *result,
                                                                  uint32_t *vertices, size_t capacity);

/**
 * The smoothest field of four directions along features and the boundary, near strokes and principal
 * curvature: one of the directions in each face, a unit vector in space.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (a mesh without positions, a
 * feature or vertex that does not exist), RICCI_BUFFER_TOO_SMALL, RICCI_NO_MEMORY, RICCI_FACTORISATION,
 * RICCI_CANCELLED.
 *
 * @param mesh        the mesh.
 * @param options     features, curvature and strokes; NULL for none.
 * @param control     progress and cancellation; NULL for neither.
 * @param directions  out: 3 numbers for each face.
 * @param capacity    the room in `directions`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_seamless_field(const ricci_mesh *mesh,
                                                               const ricci_seamless_options *options,
                                                               const ricci_control *control,
                                                               double *directions, size_t capacity);

/**
 * The metric on its Delaunay triangulation. Its report is that of the conformal flow.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_NO_MEMORY.
 *
 * @param result  the seamless metric.
 * @param metric  out: the new handle, to be released by ricci_metric_free.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_seamless_metric(const ricci_seamless *result,
                                                                ricci_metric **metric);

/**
 * The map into the plane, cut through all cones; edges of the boundary and features are parallel to an axis
 * exactly, features to rounding where whole numbers on the grid of coordinates have no solution for them.
 * Each edge of a seam is exactly, in the doubles of
 * ricci_layout_points, a rotation by a multiple of 90 degrees and a translation of its other side.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_LAYOUT (a metric that has not converged), RICCI_TOO_LARGE,
 * RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param result   the seamless metric.
 * @param control  progress and cancellation; NULL for neither.
 * @param layout   out: the new handle, to be released by ricci_layout_free.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_seamless_map(const ricci_seamless *result,
                                                             const ricci_control *control,
                                                             ricci_layout **layout);

/**
 * The map into the plane of least distortion among those with the cones and the turning of a seamless metric:
 * Newton's method from its map. Seams stay rotations by multiples of 90 degrees and translations, exactly in
 * the doubles of ricci_layout_points; a boundary is free, and features need not stay straight.
 *
 * The mesh of the layout is the given one; where the map of the metric turns triangles over, the fewest of
 * its edges are split, and its first vertices are the given ones. Distortions of the layout are those against
 * the surface. No triangle is turned over. A descent that does not converge gives the best
 * map found, and `stop` says why. The points are the same bits for any number of threads.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_STRUCT_SIZE, RICCI_ARGUMENT
 * (RICCI_FLATTEN_DISTANCE, `injective`, pinned vertices and straight runs, which are for maps without seams),
 * RICCI_LAYOUT (a metric that has not converged, triangles that stay turned over, a triangle without area),
 * RICCI_TRIANGLE_INEQUALITY, RICCI_TOO_LARGE, RICCI_FACTORISATION, RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param result    the seamless metric.
 * @param options   the energy, weights of the faces of the given mesh, or NULL.
 * @param control   progress and cancellation, or NULL.
 * @param energies  out: the energies of the steps, as many as there is room for; NULL for none.
 * @param capacity  entries of `energies`.
 * @param summary   out: the figures. Overlap and `one_to_one` are those of the surface cut open.
 * @param size      sizeof *summary.
 * @param layout    out: the new handle, to be released by ricci_layout_free.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_seamless_flatten(
    const ricci_seamless *result, const ricci_flatten_options *options, const ricci_control *control,
    double *energies, size_t capacity, ricci_flatten_summary *summary, size_t size, ricci_layout **layout);

#ifdef __cplusplus
}
#endif

#endif
