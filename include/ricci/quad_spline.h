/* ricci: splines over layouts of four-sided patches, for CAD and for analysis.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_quad_spline_fit_mesh(mesh, 0, NULL, NULL, &spline);       // with as few patches as will do
 *     ricci_quad_spline_summarise(spline, &summary, sizeof summary);  // how near, how smooth
 *     ricci_quad_spline_write_step(spline, NULL, "part.step");
 *
 * The conventions are those of ricci/ricci.h. A patch has degree 5 along u and v, which run from 0 to 1, and
 * one polynomial for each span. Side 0 runs from (0, 0) to (1, 0), side 1 from (1, 0) to (1, 1), side 2 from
 * (1, 1) to (0, 1), side 3 from (0, 1) to (0, 0), counterclockwise seen from outside. Patches meet along
 * whole sides, the arcs of the layout, with the same control points, and tangent planes are continuous across
 * all arcs but creases.
 *
 * Sources, by the keys of docs/bibliography.md: tangent planes across arcs [Pet02], B-splines [dB01].
 */

#ifndef RICCI_QUAD_SPLINE_H
#define RICCI_QUAD_SPLINE_H

#include <ricci/bicubic.h>
#include <ricci/quads.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A spline over a layout of four-sided patches. It never changes. */
typedef struct ricci_quad_spline ricci_quad_spline;

/** The quantities of a spline at a place. */
enum {
    /** 3 numbers: the point. */
    RICCI_QUAD_SPLINE_POINT = 0,
    /** 9 numbers: the point, its derivatives by u and by v. */
    RICCI_QUAD_SPLINE_FIRST = 1,
    /** 18 numbers: those, and the second derivatives uu, uv, vv. */
    RICCI_QUAD_SPLINE_SECOND = 2,
    /** 30 numbers: those, and the third derivatives uuu, uuv, uvv, vvv; at inner knots those behind them. */
    RICCI_QUAD_SPLINE_THIRD = 3,
    /**
     * 5 numbers: the unit normal, outwards, and the principal curvatures, the larger one first, positive
     * where the surface bends towards the normal. All are NaN where the first derivatives are parallel.
     */
    RICCI_QUAD_SPLINE_SHAPE = 4
};

/** A direction of the parameters of a patch. */
enum {
    /** Along u. */
    RICCI_ALONG_U = 0,
    /** Along v. */
    RICCI_ALONG_V = 1
};

/** Options of fits over layouts; zeros are the defaults. */
typedef struct ricci_quad_spline_options {
    /** sizeof(ricci_quad_spline_options), by ricci_init. */
    size_t size;
    /**
     * Largest distance between spline and surface over the diagonal of the bounding box; patches that are
     * farther off get more spans. 0: 0.001 or, where that is more, four times the noise of the surface.
     */
    double tolerance;
    /**
     * The weight of bending, up to 1e-5; below 0: none; 0: 1e-8 and, where that misses the tolerance, as
     * little as suits the measured noise, down to 1e-11. 1e-8 suits scans with a noise of a thousandth of the
     * diagonal.
     */
    double bending;
    /** Threads, 0 for one per core; results do not depend on it. 1 suits hosts that run several calls at
     * once. */
    size_t threads;
    /** Most spans of a patch in each direction, up to 32; 0: 6. One gives the smallest files. */
    uint32_t most_spans;
    /** 0. */
    uint32_t reserved;
} ricci_quad_spline_options;

/** Figures of a spline over a layout. */
typedef struct ricci_quad_spline_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Number of patches. */
    size_t n_patches;
    /** Number of arcs, each a side of one patch or of two. */
    size_t n_arcs;
    /** Number of nodes, where arcs end. */
    size_t n_nodes;
    /** The degree along u and v: 5. */
    size_t degree;
    /** Largest number of spans of a patch along u or v. */
    size_t most_spans;
    /** Number of control points of all patches, those on common sides once. */
    size_t n_control_points;
    /** Number of free control points, of which all others are combinations. */
    size_t n_free;
    /** Number of entries of the extraction matrix. */
    size_t n_entries;
    /** Number of patches that are turned over somewhere. */
    size_t n_folded_patches;
    /** The diagonal of the bounding box of the surface that was fitted. */
    double diagonal;
    /** Root of the mean squared distance of places of the patches from the surface, over the diagonal. */
    double rms;
    /** The largest of these distances, over the diagonal. */
    double max;
    /** Root of the mean squared distance of the vertices from the spline, over the diagonal. */
    double vertex_rms;
    /** The largest of these distances, over the diagonal. */
    double vertex_max;
    /** The largest angle between the normals of spline and surface, radians. */
    double normal_error;
    /** The largest angle between normals on both sides of an arc that is no crease, radians. */
    double normal_jump;
    /**
     * The standard deviation of the noise of the surface's vertices over the diagonal, as their heights over
     * the spline tell.
     */
    double noise;
    /** The tolerance, over the diagonal: the one that was asked for, else as in the options. */
    double tolerance;
    /** 1 for distances within the tolerance, and no patch turned over; else 0. */
    uint32_t converged;
    /** 0. */
    uint32_t reserved;
    /** The volume inside, negative if normals point inwards; NaN with a boundary. */
    double volume;
} ricci_quad_spline_summary;

/** A patch: what a host needs beside poles and knots to build its own B-spline surface. */
typedef struct ricci_quad_patch {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** The degrees along u and v. */
    size_t degrees[2];
    /** Number of poles along u and v. */
    size_t n_poles[2];
    /** Number of distinct knots along u and v. */
    size_t n_knots[2];
    /** 0 and 0: periodic in neither direction. */
    size_t periodic[2];
    /** The arc on each of its four sides. */
    size_t arcs[4];
    /** 1 for a side whose arc runs against the way around the patch, else 0. */
    size_t reversed[4];
    /** The patch on the other side of each arc; -1 on the border. */
    int64_t neighbours[4];
    /** The side of that patch on which it lies; -1 on the border. */
    int64_t neighbour_sides[4];
    /** 1 for a side across which the normal may jump, else 0. */
    size_t creases[4];
} ricci_quad_patch;

/** An arc: a curve that is a side of one patch or of two. */
typedef struct ricci_quad_arc {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Its degree. */
    size_t degree;
    /** Number of its poles. */
    size_t n_poles;
    /** Number of its distinct knots, which are those of the patches beside it along their side. */
    size_t n_knots;
    /** The nodes at its start and its end. */
    size_t ends[2];
    /** The patch to its left and that to its right; -1 for none. */
    int64_t patches[2];
    /** The sides of these patches; -1 for none. Those on the left run as the arc, those on the right against.
     */
    int64_t sides[2];
    /** Its length in parameters, the same for opposite sides of a patch; tangents are continuous in these. */
    double length;
    /** 1 if the normal may jump across it, else 0. */
    uint32_t crease;
    /** 0. */
    uint32_t reserved;
} ricci_quad_arc;

/**
 * A spline with few patches, near a mesh: over the coarsest layouts of seamless metrics with other cones in
 * turn, and last over a layout with up to twice as many patches. Patches that miss the tolerance get more
 * spans; the first fit within the tolerance, or else that with the fewest patches turned over, then the
 * least distance.
 *
 * Deterministic.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (an angle below 0 or not finite,
 *         bending, spans, a mesh without positions), RICCI_TARGET_KIND (no cones fit the surface),
 *         RICCI_LAYOUT (no layout was found), RICCI_SPLINE (a face without area), RICCI_TOO_LARGE,
 *         RICCI_NO_MEMORY, RICCI_FACTORISATION, RICCI_CANCELLED; those of ricci_seamless_new.
 *
 * @param mesh           the mesh.
 * @param feature_angle  edges at which the surface turns by this much, radians, become sides of patches
 *                       across which normals may jump; 0: none.
 * @param options        the options; NULL for the defaults.
 * @param control        progress and cancellation, or NULL.
 * @param spline         out: the new handle, to be released by ricci_quad_spline_free.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_spline_fit_mesh(const ricci_mesh *mesh,
                                                                     double feature_angle,
                                                                     const ricci_quad_spline_options *options,
                                                                     const ricci_control *control,
                                                                     ricci_quad_spline **spline);

/**
 * A spline over the patches of a layout, near the surface of its seamless metric. Patches that miss the
 * tolerance get more spans; the first fit within the tolerance, or else that with the fewest patches turned
 * over, then the least distance.
 *
 * Deterministic.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (bending, spans; a layout of
 *         another seamless metric), RICCI_LAYOUT (a surface without positions; sides of patches that are
 *         several arcs; a metric so far from its target that it has no quads), RICCI_SPLINE (a layout with
 * one or two patches around a node; a face without area), RICCI_TOO_LARGE, RICCI_NO_MEMORY,
 *         RICCI_FACTORISATION, RICCI_CANCELLED.
 *
 * @param seamless  the seamless metric.
 * @param layout    a layout of it; NULL for the coarsest one.
 * @param options   the options; NULL for the defaults.
 * @param control   progress and cancellation, or NULL.
 * @param spline    out: the new handle, to be released by ricci_quad_spline_free.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_spline_fit(const ricci_seamless *seamless,
                                                                const ricci_quad_layout *layout,
                                                                const ricci_quad_spline_options *options,
                                                                const ricci_control *control,
                                                                ricci_quad_spline **spline);

/**
 * Release a spline.
 *
 * @param spline  the handle, or NULL.
 */
RICCI_API_VOID void ricci_quad_spline_free(ricci_quad_spline *spline);

/**
 * The figures of a spline.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param spline   the spline.
 * @param summary  out: the figures.
 * @param size     sizeof *summary.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_spline_summarise(const ricci_quad_spline *spline,
                                                                      ricci_quad_spline_summary *summary,
                                                                      size_t size);

/**
 * The patches that are turned over somewhere: their normal is more than a right angle off the surface's.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param spline    the spline.
 * @param patches   out: n_folded_patches numbers of patches, ascending.
 * @param capacity  entries of `patches`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_spline_folds(const ricci_quad_spline *spline,
                                                                  uint32_t *patches, size_t capacity);

/**
 * Degrees and sizes of a patch, its arcs, and the patches that it meets.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_SPLINE (no such patch).
 *
 * @param spline  the spline.
 * @param patch   the patch.
 * @param result  out: the patch.
 * @param size    sizeof *result.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_spline_patch(const ricci_quad_spline *spline,
                                                                  size_t patch, ricci_quad_patch *result,
                                                                  size_t size);

/**
 * The poles of a patch: its control points, without weights.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_SPLINE (no such patch).
 *
 * @param spline    the spline.
 * @param patch     the patch.
 * @param poles     out: n_poles[0] x n_poles[1] x 3: that of i along u and j along v at i n_poles[1] + j.
 * @param capacity  entries of `poles`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_spline_poles(const ricci_quad_spline *spline,
                                                                  size_t patch, double *poles,
                                                                  size_t capacity);

/**
 * The distinct knots of a patch along u or v, and how often each occurs: degree + 1 times at both ends.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such direction),
 *         RICCI_SPLINE (no such patch).
 *
 * @param spline                   the spline.
 * @param patch                    the patch.
 * @param along                    RICCI_ALONG_U or RICCI_ALONG_V.
 * @param knots                    out: n_knots numbers, ascending from 0 to 1.
 * @param knots_capacity           entries of `knots`.
 * @param multiplicities           out: n_knots numbers.
 * @param multiplicities_capacity  entries of `multiplicities`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_spline_knots(const ricci_quad_spline *spline,
                                                                  size_t patch, uint32_t along, double *knots,
                                                                  size_t knots_capacity,
                                                                  uint32_t *multiplicities,
                                                                  size_t multiplicities_capacity);

/**
 * The numbers of the control points of a patch, in the order of its poles: equal on common sides.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_SPLINE (no such patch).
 *
 * @param spline    the spline.
 * @param patch     the patch.
 * @param controls  out: n_poles[0] x n_poles[1] numbers below n_control_points.
 * @param capacity  entries of `controls`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_spline_controls(const ricci_quad_spline *spline,
                                                                     size_t patch, uint32_t *controls,
                                                                     size_t capacity);

/**
 * The ends of an arc, and the patches beside it.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_SPLINE (no such arc).
 *
 * @param spline  the spline.
 * @param arc     the arc.
 * @param result  out: the arc.
 * @param size    sizeof *result.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_spline_arc(const ricci_quad_spline *spline, size_t arc,
                                                                ricci_quad_arc *result, size_t size);

/**
 * The poles of an arc, the same numbers as those of the patches beside it.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_SPLINE (no such arc).
 *
 * @param spline    the spline.
 * @param arc       the arc.
 * @param poles     out: n_poles x 3, from its start to its end.
 * @param capacity  entries of `poles`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_spline_arc_poles(const ricci_quad_spline *spline,
                                                                      size_t arc, double *poles,
                                                                      size_t capacity);

/**
 * Points of the surface with derivatives, normals or curvatures, many at a time, in parallel.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER (also for places without patches), RICCI_STRUCT_SIZE,
 *         RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such quantity), RICCI_SPLINE (a patch that does not
 *         exist, parameters that are not from 0 to 1), RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param spline    the spline.
 * @param places    the places, with a patch for each.
 * @param which     RICCI_QUAD_SPLINE_POINT and its like.
 * @param control   progress and cancellation, or NULL.
 * @param values    out: for each place the numbers that are documented at the constant.
 * @param capacity  entries of `values`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_spline_evaluate(const ricci_quad_spline *spline,
                                                                     const ricci_spline_places *places,
                                                                     uint32_t which,
                                                                     const ricci_control *control,
                                                                     double *values, size_t capacity);

/**
 * For points in space the nearest places of the spline, many at a time, in parallel. The first call makes a
 * search structure, which the handle keeps.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (a point that is not finite),
 *         RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param spline    the spline.
 * @param points    n x 3.
 * @param n         number of points.
 * @param control   progress and cancellation, or NULL.
 * @param patches   out: for each point the patch of the nearest place, n of them.
 * @param values    out: n x 6: u and v, the nearest point, and its distance.
 * @param capacity  entries of `values`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_spline_closest(const ricci_quad_spline *spline,
                                                                    const double *points, size_t n,
                                                                    const ricci_control *control,
                                                                    uint32_t *patches, double *values,
                                                                    size_t capacity);

/**
 * A mesh of the surface, patch after patch, with common vertices on common sides. It has normals (0 where
 * there is none), at creases those of both sides, and u and v as texture coordinates of its corners.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (both sizes, or a tolerance that is not positive),
 *         RICCI_TOO_LARGE, RICCI_DEFECTS, RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param spline     the spline.
 * @param parts      each patch is divided into parts x parts cells of two triangles; 0: by the tolerance.
 * @param tolerance  largest distance between a triangle and the surface, in the units of the surface; 0: a
 *                   thousandth of the diagonal.
 * @param control    progress and cancellation, or NULL.
 * @param mesh       out: the mesh, to be released by ricci_mesh_free.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_spline_tessellate(const ricci_quad_spline *spline,
                                                                       size_t parts, double tolerance,
                                                                       const ricci_control *control,
                                                                       ricci_mesh **mesh);

/**
 * The patch on which each face of a mesh lies: the nearest one to its centroid of those that face the same
 * way there.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (a mesh without positions),
 *         RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param spline    the spline.
 * @param mesh      the mesh from which the seamless metric was made, or another one of the same surface.
 * @param control   progress and cancellation, or NULL.
 * @param patches   out: for each face of the mesh its patch.
 * @param capacity  entries of `patches`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_spline_patch_of_faces(const ricci_quad_spline *spline,
                                                                           const ricci_mesh *mesh,
                                                                           const ricci_control *control,
                                                                           uint32_t *patches,
                                                                           size_t capacity);

/**
 * The extraction matrix, by rows: every control point as a combination of the free ones, so that functions of
 * the surface with continuous gradients are combinations of n_free basis functions. Rows add up to 1.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param spline            the spline.
 * @param columns           out: n_entries numbers of free control points, row after row.
 * @param columns_capacity  entries of `columns`.
 * @param values            out: n_entries weights.
 * @param values_capacity   entries of `values`.
 * @param starts            out: n_control_points + 1 offsets: where each row starts, and the last one ends.
 * @param starts_capacity   entries of `starts`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status
ricci_quad_spline_extraction(const ricci_quad_spline *spline, uint32_t *columns, size_t columns_capacity,
                             double *values, size_t values_capacity, size_t *starts, size_t starts_capacity);

/**
 * The Bezier extraction of a patch along u or v: per span the 6 Bezier points as combinations of the 6
 * control points from 3 x span on. The Bezier points of a rectangle of two spans are the products of both.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such direction),
 *         RICCI_SPLINE (no such patch).
 *
 * @param spline    the spline.
 * @param patch     the patch.
 * @param along     RICCI_ALONG_U or RICCI_ALONG_V.
 * @param weights   out: (n_knots - 1) x 6 x 6: the weight of control point j in point k of span i at
 *                  36 i + 6 k + j.
 * @param capacity  entries of `weights`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_spline_bezier(const ricci_quad_spline *spline,
                                                                   size_t patch, uint32_t along,
                                                                   double *weights, size_t capacity);

/**
 * Write the patches as STEP AP242, whole or not at all: parts that close up are solids with outward normals,
 * the others shells of one surface model; faces on planes and cylinders, else one for each patch. The same
 * spline gives the same bytes.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (not UTF-8, no such unit),
 * RICCI_IO, RICCI_UNKNOWN_FORMAT (another extension; a library built without STEP), RICCI_SPLINE,
 *         RICCI_NO_MEMORY.
 *
 * @param spline   the spline.
 * @param options  name and unit; NULL for the defaults.
 * @param path     file name in UTF-8, ending in .step or .stp.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_spline_write_step(const ricci_quad_spline *spline,
                                                                       const ricci_step_options *options,
                                                                       const char *path);

/**
 * Write the knots and control points of the patches as JSON (`ricci-quad-spline 1`).
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (not UTF-8), RICCI_IO, RICCI_UNKNOWN_FORMAT (another
 *         extension; a library built without JSON), RICCI_NO_MEMORY.
 *
 * @param spline  the spline.
 * @param path    file name in UTF-8, ending in .json.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_quad_spline_write_json(const ricci_quad_spline *spline,
                                                                       const char *path);

#ifdef __cplusplus
}
#endif

#include <ricci/control_mesh.h>

#endif
