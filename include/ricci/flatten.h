/* ricci: flat maps of least stretch, and maps to the sphere.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_flatten_summary told;
 *     ricci_flatten(mesh, NULL, NULL, points, 2 * n_vertices, NULL, 0, &told, sizeof told);
 *     told.after[RICCI_DISTORTION_MAX_LENGTH_ERROR];  // 0.05: no edge is more than 5 % longer or shorter
 *
 * The conventions are those of ricci/ricci.h.
 *
 * Sources, by the keys of docs/bibliography.md: the energy and its barrier [SS15], its Hessian [SGK19], the
 * conformal energy [HG00], rigid maps [LZXGG08], distances of neighbours [FSD99], shortest paths [MMP87],
 * conditions by multipliers [NW06], Tutte embeddings [Flo03], triangles turned back [GKKPR21], maps of
 * triangulations from coarse to fine [PH03],
 * inflated views [KSB12], cuts to where stretch is most [GGH02].
 */

#ifndef RICCI_FLATTEN_H
#define RICCI_FLATTEN_H

#include <ricci/ricci.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * What a flat map keeps. s and t are the stretches of a triangle along two perpendicular directions; energies
 * are means over the area of the surface.
 */
enum {
    /** Lengths: s^2 + t^2 + 1/s^2 + 1/t^2, 4 where lengths are kept. */
    RICCI_FLATTEN_ISOMETRIC = 0,
    /** Lengths, as rigid as possible: (s - 1)^2 + (t - 1)^2. */
    RICCI_FLATTEN_ARAP = 1,
    /** Areas, as far as the share of the conformal energy lets them: 2 (s t + 1/(s t)). */
    RICCI_FLATTEN_AREA = 2,
    /**
     * Distances: (|p - q|/d - 1)^2 of the vertices that at most `rings` edges separate, of the lengths d of
     * the shortest paths between them, and 0.01 times the isometric energy.
     */
    RICCI_FLATTEN_DISTANCE = 3
};

/** The map that a descent started from. */
enum {
    /** The conformal layout that keeps the lengths of the outer loop. */
    RICCI_FLATTEN_FROM_CONFORMAL = 0,
    /** Every vertex at the mean of its neighbours: the conformal layout turns a triangle over. */
    RICCI_FLATTEN_FROM_TUTTE = 1,
    /** On the sphere: the conformal map turned triangles over, which were turned back. */
    RICCI_FLATTEN_FROM_UNTANGLED = 2,
    /** A seamless map, whose seams stay rotations: ricci_seamless_flatten. */
    RICCI_FLATTEN_FROM_SEAMLESS = 3,
    /** On the sphere: a map of the triangulation alone, where triangles of the conformal map stay turned
       over. */
    RICCI_FLATTEN_FROM_COARSE = 4
};

/** Why a descent ended. */
enum {
    /** A full Newton step was made whose decrement is at most the tolerance. */
    RICCI_FLATTEN_CONVERGED = 0,
    /** Doubles hold no better map. */
    RICCI_FLATTEN_ROUNDING = 1,
    /** The steps ran out. */
    RICCI_FLATTEN_MAX_ITERATIONS = 2,
    /** The energy falls on toward a triangle without area. */
    RICCI_FLATTEN_BARRIER = 3,
    /** No step along the Newton direction lowers the energy. */
    RICCI_FLATTEN_NO_STEP = 4,
    /** Pinned vertices or straight pieces are not where they are to be. */
    RICCI_FLATTEN_UNMET = 5
};

/** The entries of `before` and `after`: means are weighted by the area of the surface's triangles. */
enum {
    /** The mean of s^2 + t^2 + 1/s^2 + 1/t^2: at least 4. */
    RICCI_DISTORTION_ENERGY = 0,
    /** The least stretch of a triangle along a direction. */
    RICCI_DISTORTION_LEAST_STRETCH = 1,
    /** The largest stretch of a triangle along a direction. */
    RICCI_DISTORTION_MOST_STRETCH = 2,
    /** The mean over the edges of |length in the plane / length - 1|. */
    RICCI_DISTORTION_MEAN_LENGTH_ERROR = 3,
    /** The largest of these. */
    RICCI_DISTORTION_MAX_LENGTH_ERROR = 4,
    /** The mean of |area in the plane / area - 1|. */
    RICCI_DISTORTION_MEAN_AREA_ERROR = 5,
    /** The largest of these. */
    RICCI_DISTORTION_MAX_AREA_ERROR = 6,
    /** The mean dilatation s/t. */
    RICCI_DISTORTION_MEAN_DILATATION = 7,
    /** The largest dilatation. */
    RICCI_DISTORTION_MAX_DILATATION = 8,
    /** The area in the plane over that of the surface. */
    RICCI_DISTORTION_AREA = 9
};

/** Options of ricci_flatten; zeros are the defaults. */
typedef struct ricci_flatten_options {
    /** sizeof(ricci_flatten_options), by ricci_init. */
    size_t size;
    /**
     * Share of the conformal energy 2 (s/t + t/s) in the energy that is least, from 0 to 1; 0: none, but 0.1
     * for RICCI_FLATTEN_AREA. More of it keeps angles better and lengths worse.
     */
    double conformal;
    /**
     * Newton decrement of a converged map, about the root of twice the energy that is still to be lost; 0:
     * 1e-8. The last step squares it, so that a smaller one changes little.
     */
    double tolerance;
    /**
     * Most Newton steps; 0: 2000. Flat shapes take 10, those that are stretched a hundredfold a hundred; the
     * most that was measured is 708.
     */
    size_t max_iterations;
    /**
     * RICCI_FLATTEN_ISOMETRIC ... RICCI_FLATTEN_DISTANCE. The isometric energy never comes near a triangle
     * without area; the rigid one can end there.
     */
    uint32_t energy;
    /**
     * 1 if no part of the map is to lie on another one; else 0. Sides of the border then repel each other,
     * and the steps are shorter.
     */
    uint32_t injective;
    /**
     * Per face a factor above 0 of its part in the energy; NULL: 1. 100 on a part that is to keep its lengths
     * at the cost of the rest.
     */
    const double *weights;
    /** Its entries, one for each face. 0 with NULL. */
    size_t n_weights;
    /**
     * Vertices whose places are given, each once; NULL: none. They come there to the last bit, or `stop` is
     * RICCI_FLATTEN_UNMET.
     */
    const uint32_t *pins;
    /** Their places, 2 numbers each, in the unit of the surface's lengths. The map is turned to be near them.
     */
    const double *places;
    /** The number of pinned vertices. 0 with NULL. */
    size_t n_pins;
    /**
     * Runs of vertices, one after the other, each of which becomes straight; NULL: none. Parts of the border
     * that are to be cut or sewn straight are given so.
     */
    const uint32_t *straight;
    /** Per run its number of vertices, 3 or more. Their sum is the number of entries of `straight`. */
    const uint32_t *straight_sizes;
    /** The number of runs. 0 with NULL. */
    size_t n_straight;
    /**
     * RICCI_FLATTEN_DISTANCE: most edges between two vertices whose distance is kept; 0: 2. Work grows with
     * its fourth power.
     */
    size_t rings;
} ricci_flatten_options;

/**
 * Limits of a sheet that is cut by a flat map and then takes the shape of the surface, and of the darts that
 * keep it within them; zeros are the defaults.
 */
typedef struct ricci_dart_options {
    /** sizeof(ricci_dart_options), by ricci_init. */
    size_t size;
    /**
     * Largest |strain| along the warp, from the plane to the surface; 0: no limit. 0.02 for woven cloth, 0.2
     * and more for knitted one; measure your own.
     */
    double strain_warp;
    /**
     * The same along the weft, at a right angle to the warp in the plane; 0: no limit. Most woven cloth gives
     * more along it.
     */
    double strain_weft;
    /**
     * Largest |shear|, radians between warp and weft; 0: no limit. Woven cloth bears much of it: 0.3 and
     * more.
     */
    double shear;
    /**
     * Direction of the warp in the plane, radians from the x axis. Turn it with the map, which lies as the
     * conformal layout does.
     */
    double warp;
    /** Most length of all darts together; 0: no limit. A budget of seams keeps the work of sewing in bounds.
     */
    double budget;
    /** Most darts; 0: 8. Each takes another descent. */
    size_t most;
} ricci_dart_options;

/** Figures of a surface that darts have opened. */
typedef struct ricci_dart_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Number of darts. */
    size_t n_darts;
    /** Number of vertices of the opened surface. */
    size_t n_vertices;
    /** Length of the darts together. */
    double length;
    /** The largest part of its limit that a triangle takes in the flat map without darts: more than 1 is too
     * much. */
    double before;
    /** That in the flat map of the opened surface. */
    double after;
} ricci_dart_summary;

/** Figures of a flat map. */
typedef struct ricci_flatten_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Number of energies: that at the start, then one per step. */
    size_t n_energies;
    /** Number of steps by the Hessian itself; the others replace negative eigenvalues by 0. */
    size_t n_unclamped;
    /** The least energy: that of the options, after the last step. */
    double energy;
    /** The Newton decrement of the last step; infinite without one. */
    double decrement;
    /** The largest slope of the energy in a coordinate, times the diameter of the map. */
    double gradient;
    /** The share of the map's area that lies on other parts of it. */
    double overlap;
    /** The change of lengths and areas at the start: RICCI_DISTORTION_... */
    double before[10];
    /** That at the end. */
    double after[10];
    /** RICCI_FLATTEN_FROM_... */
    uint32_t start;
    /** RICCI_FLATTEN_CONVERGED ... RICCI_FLATTEN_UNMET. */
    uint32_t stop;
    /**
     * The largest distance of a pinned vertex from its place, and of a vertex from the line of its run, over
     * the diameter of the map.
     */
    double misfit;
    /**
     * 1 if no part of the map lies on another one, by exact arithmetic on the points; else 0.
     */
    uint32_t one_to_one;
    /** 0. */
    uint32_t reserved;
} ricci_flatten_summary;

/**
 * The map to the plane of least distortion of an open surface of genus 0, with a free boundary: Newton's
 * method from the conformal layout that keeps the lengths of the outer loop.
 *
 * No triangle is turned over, by exact arithmetic on `points`. A descent that does not converge gives the
 * best map found, and `stop` says why. The points are the same bits for any number of threads.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_STRUCT_SIZE, RICCI_ARGUMENT,
 *         RICCI_LAYOUT (a closed surface, one of higher genus, a triangle without area, `injective` without a
 *         start that is one to one),
 *         RICCI_TRIANGLE_INEQUALITY, RICCI_FACTORISATION, RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param mesh               the surface.
 * @param options            the energy, or NULL.
 * @param control            progress and cancellation, or NULL.
 * @param points             out: n_vertices x 2, in the unit of the surface's lengths.
 * @param capacity           entries of `points`.
 * @param energies           out: the energies of the steps, as many as there is room for; NULL for none.
 * @param energies_capacity  entries of `energies`.
 * @param summary            out: the figures.
 * @param size               sizeof *summary.
 */
RICCI_API ricci_status ricci_flatten(const ricci_mesh *mesh, const ricci_flatten_options *options,
                                     const ricci_control *control, double *points, size_t capacity,
                                     double *energies, size_t energies_capacity,
                                     ricci_flatten_summary *summary, size_t size);

/**
 * The map to the unit sphere of least distortion of a closed surface of genus 0: Newton's method from the
 * conformal map. Stretches are those to a sphere with the area of the surface.
 *
 * No triangle is turned over as seen from outside, by exact arithmetic on `points`; surfaces on whose limbs
 * the conformal map is too small for doubles start from a map of the triangulation alone. With the isometric
 * energy areas and shapes are distorted alike; `conformal` and RICCI_FLATTEN_AREA weigh them otherwise. The
 * sphere is turned as the surface is in space [Kab76]. The points are the same bits for any number of
 * threads.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (a surface
 *         that is no sphere; an energy or a condition of maps to the plane alone), RICCI_LAYOUT (a triangle
 *         without area, triangles that stay turned over), RICCI_TRIANGLE_INEQUALITY, RICCI_FACTORISATION,
 *         RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param mesh               the surface.
 * @param options            the energy, isometric or of areas, or NULL.
 * @param control            progress and cancellation, or NULL.
 * @param points             out: n_vertices x 3, unit vectors.
 * @param capacity           entries of `points`.
 * @param energies           out: the energies of the steps, as many as there is room for; NULL for none.
 * @param energies_capacity  entries of `energies`.
 * @param summary            out: the figures.
 * @param size               sizeof *summary.
 */
RICCI_API ricci_status ricci_flatten_sphere(const ricci_mesh *mesh, const ricci_flatten_options *options,
                                            const ricci_control *control, double *points, size_t capacity,
                                            double *energies, size_t energies_capacity,
                                            ricci_flatten_summary *summary, size_t size);

/**
 * The positions of a closed surface after its folds were smoothed away: implicit steps of the mean curvature
 * flow with the Laplacian of the surface at its start [KSB12]. Area and centre are kept.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (a surface that is not closed
 * or has no positions, a negative time), RICCI_TRIANGLE_INEQUALITY, RICCI_FACTORISATION, RICCI_NO_MEMORY,
 *         RICCI_CANCELLED.
 *
 * @param mesh       the surface.
 * @param time       a share of the surface's area; 0: 0.002. Folds narrower than about its root times that of
 *                   the area are gone.
 * @param steps      implicit steps; 0: 10.
 * @param control    progress and cancellation, or NULL.
 * @param positions  out: n_vertices x 3.
 * @param capacity   entries of `positions`.
 */
RICCI_API ricci_status ricci_inflate(const ricci_mesh *mesh, double time, size_t steps,
                                     const ricci_control *control, double *positions, size_t capacity);

/**
 * The vertices of the medial wall of a cortical hemisphere, by its inflated view: those nearest, along the
 * edges of the view, to the one that its middle sees along `medial`, until they have a share of the surface's
 * area, and what they cut off from the largest part of the others.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_WRONG_SIZE, RICCI_ARGUMENT (a share
 * that is not between 0 and 1, a direction without length, a surface without positions).
 *
 * @param mesh      the surface.
 * @param view      the inflated positions, n_view x 3.
 * @param n_view    the number of points, n_vertices.
 * @param medial    the direction towards the other hemisphere, 3 numbers.
 * @param share     the wall's share of the surface's area; 0.08 suits human cortices.
 * @param is_wall   out: n_vertices, 1 for vertices of the wall, else 0.
 * @param capacity  entries of `is_wall`.
 */
RICCI_API ricci_status ricci_medial_wall(const ricci_mesh *mesh, const double *view, size_t n_view,
                                         const double *medial, double share, uint32_t *is_wall,
                                         size_t capacity);

/**
 * Of marked vertices those of the largest piece that is a surface with boundary: pieces join faces with three
 * marked vertices along edges, and vertices at which a piece touches itself are left out.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_WRONG_SIZE, RICCI_ARGUMENT (no face has
 * three marked vertices).
 *
 * @param mesh      the surface.
 * @param marked    per vertex 1 if it is marked, else 0.
 * @param n_marked  entries of `marked`, n_vertices.
 * @param is_kept   out: n_vertices, 1 for vertices of the piece, else 0.
 * @param capacity  entries of `is_kept`.
 */
RICCI_API ricci_status ricci_flat_part(const ricci_mesh *mesh, const uint32_t *marked, size_t n_marked,
                                       uint32_t *is_kept, size_t capacity);

/**
 * The surface opened by darts: seams from the border to the vertex at which the conformal layout changes
 * areas most [GGH02], one after the other, until its flat map strains a sheet no more than its limits.
 * ricci_flatten of the opened surface with the same options is that map.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (limits
 * that are negative; pinned vertices and straight runs, which darts can take apart), and those of
 *         ricci_flatten.
 *
 * @param mesh      the surface.
 * @param options   of the flat maps, or NULL.
 * @param darts     the limits, or NULL: no dart.
 * @param control   progress and cancellation, or NULL.
 * @param origins   out: per vertex of the opened surface the given one; NULL for none.
 * @param capacity  entries of `origins`: 2 n_vertices is enough.
 * @param summary   out: the figures.
 * @param size      sizeof *summary.
 * @param opened    out: the surface with the vertices of darts doubled, faces in the order of the given ones.
 */
RICCI_API ricci_status ricci_flatten_darts(const ricci_mesh *mesh, const ricci_flatten_options *options,
                                           const ricci_dart_options *darts, const ricci_control *control,
                                           uint32_t *origins, size_t capacity, ricci_dart_summary *summary,
                                           size_t size, ricci_mesh **opened);

/**
 * The strain of a sheet that is cut by a flat map, triangle by triangle: length on the surface over length in
 * the plane, less 1, along the warp and the weft, and the radians by which the angle between them becomes
 * less than a right one.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_WRONG_SIZE, RICCI_ARGUMENT,
 * RICCI_LAYOUT (a triangle without area).
 *
 * @param mesh      the surface.
 * @param points    the flat map, n_points x 2.
 * @param n_points  n_vertices.
 * @param warp      direction of the warp in the plane, radians from the x axis.
 * @param values    out: n_faces x 3.
 * @param capacity  entries of `values`.
 */
RICCI_API ricci_status ricci_flatten_strains(const ricci_mesh *mesh, const double *points, size_t n_points,
                                             double warp, double *values, size_t capacity);

#ifdef __cplusplus
}
#endif

#endif
