/* ricci: triangular B-splines over the plane; their evaluation, meshes and files, which are those of splines
 * over whole surfaces too (ricci/surface_spline.h).
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_spline_domain(corners, starts, 1, 0.1, &domain);        // triangles inside a polygon
 *     ricci_spline_new(domain, NULL, &flat);                        // cubic, over the plane z = 0
 *     ricci_spline_fit(flat, points, n, NULL, NULL, &surface);      // near points x, y, z
 *     ricci_spline_evaluate(surface, &places, RICCI_SPLINE_SECOND, NULL, values, 18 * places.n);
 *
 * The conventions are those of ricci/ricci.h. A spline of degree n, 1 to 5, has a patch for every face of its
 * domain and n + 1 knots at every vertex, the first of them the vertex itself. Its pieces are polynomials of
 * degree n, and derivatives up to the order n - 1 are continuous, except where knots were put together.
 *
 * A library that was built without the feature `splines` has these functions; each answers RICCI_LEFT_OUT.
 *
 * Sources, by the keys of docs/bibliography.md: bases [DMS92; Sei91], splines over surfaces [GHQ06;
 * GHJLQY08], fits [WPL06; CW79].
 */

#ifndef RICCI_SPLINE_H
#define RICCI_SPLINE_H

#include <ricci/ricci.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A spline surface: basis functions over a domain, with a control point each. It never changes. */
typedef struct ricci_spline ricci_spline;

/** Parts of a spline. */
enum {
    /** n_control_points x 3. */
    RICCI_SPLINE_CONTROL_POINTS = 0,
    /** n_patches x 3 x (degree + 1) x 2: for each corner of a patch its knots, the corner first. */
    RICCI_SPLINE_KNOTS = 1,
    /** n_control_points x 2: the points of the plane over which the control points of a height field lie. */
    RICCI_SPLINE_ABSCISSAS = 2,
    /**
     * n_holes x 2: of each hole around a singular vertex, with a filling in place of the spline, the total
     * angle there in turns, and the radius in the unit of the flat metric. Of a sphere the turns are -1: its
     * vertex is at infinity of a plane, and the hole lies outside a disk of the radius.
     */
    RICCI_SPLINE_HOLES = 3
};

/** The quantities of a spline at a place. */
enum {
    /** 3 numbers: the point. */
    RICCI_SPLINE_POINT = 0,
    /** 9 numbers: the point, its derivatives by x and by y. */
    RICCI_SPLINE_FIRST = 1,
    /** 18 numbers: those, and the second derivatives xx, xy, yy. */
    RICCI_SPLINE_SECOND = 2,
    /**
     * 5 numbers: the unit normal, to the side from which the domain is seen counterclockwise, and the
     * principal curvatures, the larger one first, positive where the surface bends towards the normal. All
     * are NaN where the first derivatives are parallel.
     */
    RICCI_SPLINE_SHAPE = 3
};

/** The basis functions of a spline; zeros are the defaults. */
typedef struct ricci_spline_spec {
    /** sizeof(ricci_spline_spec), by ricci_init. */
    size_t size;
    /**
     * Knots, n_vertices x (degree + 1) x 2, the first of a vertex the vertex itself; NULL: by the rules. NULL
     * suits all but spaces from other programs.
     */
    const double *knots;
    /**
     * Vertices whose knots coincide, as at corners of the boundary, so that basis functions end there as
     * those of Bezier triangles. Corners of the boundary need not be named, theirs coincide anyway.
     */
    const uint32_t *coincident;
    /** Number of these vertices. 0 with NULL. */
    size_t n_coincident;
    /**
     * Edges, n_creases x 2 vertices, across which the spline may have a crease. Edges of the part that are
     * sharp.
     */
    const uint32_t *creases;
    /** Number of these edges. 0 with NULL. */
    size_t n_creases;
    /**
     * Distance of the farthest knots from their vertex over the radius of the smallest circle inscribed in a
     * face there, above 0 and below 1; 0: a half. Far knots make a spline look smoother; with near ones more
     * points lie in one patch alone.
     */
    double spread;
    /** 1 to 5; 0: 3. 3 has continuous curvature; higher ones take more memory and time for each patch. */
    uint32_t degree;
    /** 0. */
    uint32_t reserved;
} ricci_spline_spec;

/** Places in a spline. Zeroed by ricci_init. */
typedef struct ricci_spline_places {
    /** sizeof(ricci_spline_places), by ricci_init. */
    size_t size;
    /**
     * The patch of each place, n of them; NULL: the one in which it lies. Giving those that are known saves
     * the search.
     */
    const uint32_t *patches;
    /** x and y of each place, n x 2. Any order is fast: places are sorted inside. */
    const double *parameters;
    /** Number of places. Many at a time are faster than one by one. */
    size_t n;
    /**
     * Threads, 0 for one per core; results do not depend on it. 1 suits hosts that run several calls at once.
     */
    size_t threads;
} ricci_spline_places;

/** Options of ricci_spline_fit; zeros are the defaults. */
typedef struct ricci_spline_fit_options {
    /** sizeof(ricci_spline_fit_options), by ricci_init. */
    size_t size;
    /** The place in the spline of each point; NULL: at its own x and y. NULL suits height fields. */
    const ricci_spline_places *places;
    /**
     * Weight of the variation of bending, times the area of the domain, beside the mean squared distance; 0:
     * 1e-12, which decides where there are few points; below 0: none. 1e-8 suits scans of 0.1 % noise, where
     * it had up to 8 times less error.
     */
    double fairness;
    /**
     * Threads, 0 for one per core; results do not depend on it. 1 suits hosts that run several calls at once.
     */
    size_t threads;
} ricci_spline_fit_options;

/** Figures of a spline. */
typedef struct ricci_spline_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** 1 to 5. */
    size_t degree;
    /** Number of patches. */
    size_t n_patches;
    /** Number of basis functions of a patch, (degree + 1) (degree + 2) / 2. */
    size_t n_basis;
    /** Number of control points. */
    size_t n_control_points;
    /**
     * Of a fit, the root of the mean squared distance between points and surface, in the unit of the points;
     * NaN of other splines.
     */
    double fit_rms;
    /** The largest such distance, in the unit of the points. */
    double fit_max;
    /** Number of holes around singular vertices. */
    size_t n_holes;
    /** Of a fit to a surface, the number of patches in which it folds: ricci_spline_folds. */
    size_t n_folded_patches;
    /** The share of the fitted surface that lies in these patches; NaN of splines that were not fitted. */
    double folded_share;
    /**
     * 1 for a fit to a surface whose distances are within the tolerance asked for (fit_max over the diagonal
     * of the bounding box at most the tolerance, fit_rms a tenth of that) and that folds nowhere; else 0.
     */
    uint32_t converged;
    /** 0. */
    uint32_t reserved;
} ricci_spline_summary;

/**
 * Triangles inside polygons, as the domain of a spline: a mesh in the plane z = 0.
 *
 * Corners of the polygons where they turn outward get a single triangle where that can be, because a spline
 * is less smooth across an edge that ends at such a corner.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (an edge that is not positive, or too short),
 *         RICCI_SPLINE (a polygon that crosses itself or another one), RICCI_DEFECTS (two parts),
 * RICCI_NO_MEMORY.
 *
 * @param corners     x and y of the corners of all polygons, n x 2; points that an odd number of them winds
 *                    around are inside.
 * @param starts      n_polygons + 1 offsets: polygon i has the corners starts[i] to starts[i + 1] - 1.
 * @param n_polygons  number of polygons.
 * @param edge        triangles are about as large as equilateral ones with this edge.
 * @param domain      out: the mesh, to be released by ricci_mesh_free.
 */
RICCI_API ricci_status ricci_spline_domain(const double *corners, const size_t *starts, size_t n_polygons,
                                           double edge, ricci_mesh **domain);

/**
 * A spline over a domain; its surface is the plane z = 0, each point over itself.
 *
 * Knots by the rules lie in general position around vertices inside, along straight sides of the boundary,
 * and coincide at its corners. Control points with the same polar arguments are one.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (degree, spread, a mesh without
 *         positions), RICCI_SPLINE (a clockwise face, a vertex that does not exist, knots that give no
 *         basis), RICCI_NO_MEMORY.
 *
 * @param domain  a mesh that lies over the plane without folds, counterclockwise; its z is not looked at.
 * @param spec    degree and knots; NULL for cubic ones.
 * @param spline  out: the new handle, to be released by ricci_spline_free.
 */
RICCI_API ricci_status ricci_spline_new(const ricci_mesh *domain, const ricci_spline_spec *spec,
                                        ricci_spline **spline);

/**
 * The surface with other control points.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_WRONG_SIZE, RICCI_SPLINE (a coordinate is not finite),
 * RICCI_NO_MEMORY.
 *
 * @param spline    its basis functions are taken.
 * @param points    n_control_points x 3.
 * @param n_points  n_control_points.
 * @param result    out: the new handle, to be released by ricci_spline_free.
 */
RICCI_API ricci_status ricci_spline_with_points(const ricci_spline *spline, const double *points,
                                                size_t n_points, ricci_spline **result);

/**
 * The surface that is a polynomial of the spline's degree.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_WRONG_SIZE, RICCI_ARGUMENT (a spline in several charts),
 *         RICCI_SPLINE (a coordinate is not finite), RICCI_NO_MEMORY.
 *
 * @param spline          its basis functions are taken.
 * @param coefficients    n_basis x 3: the coefficients of 1, x, y, x^2, x y, y^2, ...
 * @param n_coefficients  n_basis.
 * @param result          out: the new handle, to be released by ricci_spline_free.
 */
RICCI_API ricci_status ricci_spline_with_polynomial(const ricci_spline *spline, const double *coefficients,
                                                    size_t n_coefficients, ricci_spline **result);

/**
 * The surface that is nearest to points in the sense of least squares.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_WRONG_SIZE (as many places as points),
 *         RICCI_ARGUMENT, RICCI_SPLINE (a place outside: its number), RICCI_FACTORISATION (the points do
 *         not determine it), RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param spline    its basis functions are taken.
 * @param points    n_points x 3.
 * @param n_points  number of points.
 * @param options   places and fairness, or NULL.
 * @param control   progress and cancellation, or NULL.
 * @param fitted    out: the new handle, to be released by ricci_spline_free.
 */
RICCI_API ricci_status ricci_spline_fit(const ricci_spline *spline, const double *points, size_t n_points,
                                        const ricci_spline_fit_options *options, const ricci_control *control,
                                        ricci_spline **fitted);

/**
 * Release a spline.
 *
 * @param spline  the handle, or NULL.
 */
RICCI_API_VOID void ricci_spline_free(ricci_spline *spline);

/**
 * The figures of a spline.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param spline   the spline.
 * @param summary  out: the figures.
 * @param size     sizeof *summary.
 */
RICCI_API ricci_status ricci_spline_summarise(const ricci_spline *spline, ricci_spline_summary *summary,
                                              size_t size);

/**
 * Control points, knots, or the abscissas of the control points.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such part).
 *
 * @param spline    the spline.
 * @param which     RICCI_SPLINE_CONTROL_POINTS, RICCI_SPLINE_KNOTS or RICCI_SPLINE_ABSCISSAS.
 * @param values    out: the numbers, in the shape that is documented at the constant.
 * @param capacity  entries of `values`.
 */
RICCI_API ricci_status ricci_spline_values(const ricci_spline *spline, uint32_t which, double *values,
                                           size_t capacity);

/**
 * The control points of every patch: basis function (i, j, k) of corner 0, 1, 2 stands in the order
 * (n,0,0), (n-1,1,0), (n-1,0,1), (n-2,2,0), ...
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param spline    the spline.
 * @param controls  out: n_patches x n_basis numbers of control points.
 * @param capacity  entries of `controls`.
 */
RICCI_API ricci_status ricci_spline_controls(const ricci_spline *spline, uint32_t *controls, size_t capacity);

/**
 * The patches in which points of the plane lie.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (a spline in several
 * charts), RICCI_NO_MEMORY.
 *
 * @param spline    the spline.
 * @param points    x and y, n x 2.
 * @param n         number of points.
 * @param patches   out: n patches, -1 for a point outside the domain.
 * @param capacity  entries of `patches`.
 */
RICCI_API ricci_status ricci_spline_locate(const ricci_spline *spline, const double *points, size_t n,
                                           int32_t *patches, size_t capacity);

/**
 * Points of the surface with derivatives, normals or curvatures, many at a time, in parallel. On a side of a
 * patch they are the limits from inside.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT,
 *         RICCI_SPLINE (a place outside its patch, or outside the domain), RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param spline    the spline.
 * @param places    the places.
 * @param which     RICCI_SPLINE_POINT, RICCI_SPLINE_FIRST, RICCI_SPLINE_SECOND or RICCI_SPLINE_SHAPE.
 * @param control   progress and cancellation, or NULL.
 * @param values    out: for each place the numbers that are documented at the constant.
 * @param capacity  entries of `values`.
 */
RICCI_API ricci_status ricci_spline_evaluate(const ricci_spline *spline, const ricci_spline_places *places,
                                             uint32_t which, const ricci_control *control, double *values,
                                             size_t capacity);

/**
 * The polar form, or blossom, of the polynomial that the surface is in the middle of a patch: symmetric,
 * affine in each argument, and the polynomial itself where all arguments are equal.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_WRONG_SIZE, RICCI_SPLINE (no such patch).
 *
 * @param spline       the spline.
 * @param patch        the patch.
 * @param arguments    points of the plane, degree x 2.
 * @param n_arguments  degree.
 * @param point        out: 3 coordinates.
 */
RICCI_API ricci_status ricci_spline_blossom(const ricci_spline *spline, size_t patch, const double *arguments,
                                            size_t n_arguments, double *point);

/**
 * A mesh of the surface with normals (0 where there is none) and, as texture coordinates, the places of its
 * corners.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (no sides), RICCI_TOO_LARGE, RICCI_DEFECTS (a domain
 *         that is not connected), RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param spline   the spline.
 * @param sides    each patch becomes sides x sides triangles.
 * @param control  progress and cancellation, or NULL.
 * @param mesh     out: the mesh, to be released by ricci_mesh_free.
 */
RICCI_API ricci_status ricci_spline_tessellate(const ricci_spline *spline, size_t sides,
                                               const ricci_control *control, ricci_mesh **mesh);

/**
 * Read a spline file, `ricci-spline 1`.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT, RICCI_IO, RICCI_PARSE, RICCI_WRONG_SIZE,
 *         RICCI_SPLINE (knots that give no basis, numbers that do not fit), RICCI_NO_MEMORY.
 *
 * @param path    the file, in UTF-8.
 * @param spline  out: the new handle, to be released by ricci_spline_free.
 */
RICCI_API ricci_status ricci_spline_read(const char *path, ricci_spline **spline);

/**
 * The spline of a text that is such a file's.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT, RICCI_PARSE, RICCI_WRONG_SIZE, RICCI_SPLINE,
 * RICCI_NO_MEMORY.
 *
 * @param text    the text, NUL-terminated, in UTF-8.
 * @param spline  out: the new handle, to be released by ricci_spline_free.
 */
RICCI_API ricci_status ricci_spline_parse(const char *text, ricci_spline **spline);

/**
 * Write a spline file, whole or not at all. It says all that is needed to evaluate the spline, and numbers
 * are read back as they were.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT, RICCI_IO, RICCI_NO_MEMORY.
 *
 * @param spline  the spline.
 * @param path    the file, in UTF-8.
 */
RICCI_API ricci_status ricci_spline_write(const ricci_spline *spline, const char *path);

/**
 * The text of a spline's file.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_NO_MEMORY.
 *
 * @param spline    the spline.
 * @param text      out: the text, NUL-terminated; NULL with capacity 0 to ask for its length.
 * @param capacity  bytes of `text`.
 * @param n_bytes   out: number of bytes with the NUL.
 */
RICCI_API ricci_status ricci_spline_text(const ricci_spline *spline, char *text, size_t capacity,
                                         size_t *n_bytes);

#ifdef __cplusplus
}
#endif

/* It was a part of this header. */
#include <ricci/surface_spline.h>

#endif
