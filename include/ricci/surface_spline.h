/* ricci: triangular B-splines over whole surfaces: fits, and nearest points.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_spline_fit_mesh(mesh, NULL, NULL, &spline);            // over a flat metric that is made for it
 *     ricci_spline_summarise(spline, &summary, sizeof summary);    // summary.converged
 *     ricci_spline_closest(spline, points, n, NULL, patches, values, 6 * n);
 *
 * or with a flat metric of the caller's, whose singular vertices the library places:
 *
 *     ricci_spline_curvatures(mesh, NULL, RICCI_SPLINE_AUTO, 0, NULL, curvatures, n_vertices);
 *     target.kind = RICCI_TARGET_GIVEN, target.n = n_vertices, target.curvatures = curvatures;
 *     ricci_flow(metric, &target, NULL, NULL, &flat);
 *     ricci_spline_fit_surface(flat, NULL, NULL, &spline);
 *
 * The conventions are those of ricci/ricci.h.
 *
 * A library that was built without the feature `splines` has these functions; each answers RICCI_LEFT_OUT.
 *
 * Sources, by the keys of docs/bibliography.md: splines over surfaces [GHQ06; GHJLQY08], fits [WPL06; CW79].
 */

#ifndef RICCI_SURFACE_SPLINE_H
#define RICCI_SURFACE_SPLINE_H

#include <ricci/ricci.h>
#include <ricci/spline.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Options of ricci_spline_fit_surface and ricci_spline_fit_mesh; zeros are the defaults. */
typedef struct ricci_spline_surface_options {
    /** sizeof(ricci_spline_surface_options), by ricci_init. */
    size_t size;
    /**
     * Number of control points, at most; 0: a quarter of the vertices. Where no such spline holds,
     * ricci_spline_fit_mesh tries twice and four times as many too, up to 4000. More suit fine detail, as
     * long as they are far fewer than vertices.
     */
    size_t control_points;
    /**
     * Largest distance of a vertex from the spline over the diagonal of the bounding box at which no further
     * round is made; 0: 0.01. Below the noise of a scan more rounds do not help.
     */
    double tolerance;
    /**
     * Weight of the variation of bending in the first round, h^6 |D^3 F|^2 with h the longest side of each
     * triangle, as a mean over the triangles beside the mean squared distance; 0: chosen by cross-validation.
     * The default suits noise of unknown size, which it estimates.
     */
    double fairness;
    /**
     * Least distance of knots from their vertex, as in ricci_spline_spec; 0: 0.9. Keep the default, with
     * which docs/results/splines.md was made.
     */
    double spread;
    /**
     * Threads, 0 for one per core; results do not depend on it. 1 suits hosts that run several calls at once.
     */
    size_t threads;
    /** 1 to 5; 0: 3. 3 suits CAD, whose patches are bicubic. */
    uint32_t degree;
    /**
     * Times that the sizes of the triangles are adapted to the errors; 0: 6. The default ends early where the
     * tolerance is met.
     */
    uint32_t rounds;
    /**
     * Times at most that vertices are moved to where the spline is nearest, fewer where the tolerance is met
     * or little is gained; 0: 20; below 0: none. Keep the default: without them a vertex is held to its first
     * place in the domain.
     */
    int32_t corrections;
    /** 0. */
    uint32_t reserved;
} ricci_spline_surface_options;

/** Number of singular vertices: as few as keep the lengths of the flat metric comparable to those given. */
#define RICCI_SPLINE_AUTO SIZE_MAX

/**
 * Curvatures of a flat metric for a spline over a whole surface: those of singular vertices inside, and of
 * corners of the boundary, which take the rest; 0 elsewhere. ricci_flow makes the metric from them.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (a vertex that there is not,
 * on the boundary or named twice; a sphere with one singular vertex, or with too few vertices for three; a
 * range below 1), RICCI_TARGET_KIND (a number that the surface cannot have), RICCI_FACTORISATION,
 *         RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param mesh        a surface.
 * @param singular    the singular vertices, or NULL: those that distort areas least.
 * @param n_singular  their number; RICCI_SPLINE_AUTO without `singular`: as few as bring the ratio of the
 *                    largest to the least factor between lengths within `range`.
 * @param range       that ratio, above 1; 0: 30.
 * @param control     progress and cancellation, or NULL.
 * @param curvatures  out: one per vertex, radians.
 * @param capacity    entries of `curvatures`.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_spline_curvatures(const ricci_mesh *mesh,
                                                                  const uint32_t *singular, size_t n_singular,
                                                                  double range, const ricci_control *control,
                                                                  double *curvatures, size_t capacity);

/**
 * A spline over a whole surface, near its vertices. A patch is a triangle of the flat metric, in a chart of
 * its own; around singular vertices, of any total angle, a filling takes the place of the spline.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (a metric that is not Euclidean, a
 *         surface without positions), RICCI_SPLINE, RICCI_FACTORISATION, RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param flat     a metric of the plane that ricci_flow has made flat: up to few vertices, or everywhere;
 * such as that with the curvatures of ricci_spline_curvatures.
 * @param options  degree and sizes; NULL for the defaults.
 * @param control  progress and cancellation, or NULL.
 * @param fitted   out: the new handle, to be released by ricci_spline_free.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status
ricci_spline_fit_surface(const ricci_metric *flat, const ricci_spline_surface_options *options,
                         const ricci_control *control, ricci_spline **fitted);

/**
 * A spline over a whole surface of any topology, near its vertices: ricci_spline_fit_surface over flat
 * metrics that are made for it, first the usual one (a sphere has a vertex at infinity), then those with more
 * singular vertices, until a fit holds; the best of all. ricci_spline_summary's `converged` says whether it
 * holds.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (a surface without positions),
 *         RICCI_LAYOUT (no flow to a flat metric converged), RICCI_SPLINE, RICCI_FACTORISATION,
 *         RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param mesh     a surface.
 * @param options  degree and sizes; NULL for the defaults.
 * @param control  progress and cancellation, or NULL.
 * @param fitted   out: the new handle, to be released by ricci_spline_free.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_spline_fit_mesh(const ricci_mesh *mesh,
                                                                const ricci_spline_surface_options *options,
                                                                const ricci_control *control,
                                                                ricci_spline **fitted);

/**
 * The patches in which a fit to a surface folds: its normals turn by more than 60 degrees there between
 * places beside each other.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param spline    the spline.
 * @param patches   out: n_folded_patches numbers of patches, ascending.
 * @param capacity  entries of `patches`.
 */
RICCI_API ricci_status ricci_spline_folds(const ricci_spline *spline, uint32_t *patches, size_t capacity);

/**
 * For points in space the nearest ones of the surface, many at a time, in parallel.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (a point that is not finite:
 * its number; a spline without patches), RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param spline    the spline.
 * @param points    n x 3.
 * @param n         number of points.
 * @param control   progress and cancellation, or NULL.
 * @param patches   out: for each point the patch of the nearest one, n of them.
 * @param values    out: n x 6: x and y in the patch's chart, the nearest point, and its distance.
 * @param capacity  entries of `values`.
 */
RICCI_API ricci_status ricci_spline_closest(const ricci_spline *spline, const double *points, size_t n,
                                            const ricci_control *control, uint32_t *patches, double *values,
                                            size_t capacity);

#ifdef __cplusplus
}
#endif

#endif
