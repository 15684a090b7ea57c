/* ricci: sample surfaces of every topology, at any resolution.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_init(&shape, sizeof shape);
 *     shape.shape = RICCI_SHAPE_TORUS, shape.a = 2, shape.b = 1, shape.n = 48, shape.m = 24;
 *     ricci_make(&shape, &mesh);
 *
 * The conventions are those of ricci/ricci.h.
 *
 * Sources, by the keys of docs/bibliography.md: pairs of pants [Bus92], periods of curves [MN19].
 */

#ifndef RICCI_SHAPES_H
#define RICCI_SHAPES_H

#include <ricci/ricci.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Surfaces, with the fields of a ricci_shape that they use. */
enum {
    /** The unit sphere: an icosahedron with each edge cut into n. 10 n^2 + 2 vertices. */
    RICCI_SHAPE_SPHERE = 0,
    /** The sphere scaled by a, b, c along x, y, z. */
    RICCI_SHAPE_ELLIPSOID = 1,
    /** The unit disk in the plane z = 0: a centre and n rings. 3 n (n + 1) + 1 vertices. */
    RICCI_SHAPE_DISK = 2,
    /**
     * A plane ring of inner radius a and outer radius b, in geometric progression: n steps outwards, m
     * vertices around.
     */
    RICCI_SHAPE_ANNULUS = 3,
    /**
     * A torus of revolution about z: a the radius of the centre circle, b that of the tube, n vertices
     * around the axis, m around the tube.
     */
    RICCI_SHAPE_TORUS = 4,
    /**
     * A smooth closed surface of any `genus`: handles in a row, the first hole a times as wide as the last
     * (0: 1; larger ratios have a limit, which the message names), n layers over a quarter of the tube. 8
     * (5 genus + 1) n^2 + 2 - 2 genus vertices.
     */
    RICCI_SHAPE_GENUS = 5,
    /**
     * A tube of radius c around the curve that goes p times around the axis and q times around the tube of
     * a torus of revolution of radii a and b; p and q coprime; n cross-sections, m vertices around. Where
     * the tube would meet itself is an error.
     */
    RICCI_SHAPE_KNOT = 6,
    /** Intrinsic: the flat torus with periods 1 and tau = a + i b, of n x m parallelograms. */
    RICCI_SHAPE_FLAT_TORUS = 7,
    /**
     * Intrinsic: the Bolza surface, a regular hyperbolic octagon with opposite sides glued; every triangle
     * cut into four n times.
     */
    RICCI_SHAPE_BOLZA = 8,
    /**
     * Intrinsic: a regular polygon with sides a1 b1 a1^-1 b1^-1 ... of this `genus` glued, cut by
     * diagonals: one vertex; curvature 0.
     */
    RICCI_SHAPE_ONE_VERTEX = 9,
    /** Intrinsic: the same polygon, cut from its centre: two vertices. */
    RICCI_SHAPE_TWO_VERTEX = 10,
    /** Intrinsic: two equilateral triangles glued along their sides, a sphere of three cones. */
    RICCI_SHAPE_TWO_TRIANGLES = 11,
    /**
     * Intrinsic: the hyperbolic pair of pants with geodesic boundaries of lengths a, b, c (1e-6 to 200);
     * triangles cut into four n times.
     */
    RICCI_SHAPE_PANTS = 12,
    /**
     * Intrinsic: the curve y^2 = (x - e_1) (x - e_2) ... as the double cover of the round sphere branched
     * over the `points` e_j: spherical edge lengths, angle 4 pi over the points. Vertex j lies over e_j. n:
     * frequency of the sphere below; 40 n^2 faces.
     */
    RICCI_SHAPE_HYPERELLIPTIC = 13,
    /**
     * Intrinsic: the hyperbolic surface of this `genus` with given Fenchel-Nielsen coordinates, pairs of
     * pants of two hexagons each; every triangle cut into four n times. `points`: length and twist of each of
     * the 3 g - 3 + b curves of ricci_fenchel_nielsen, then of each of b boundary loops its length and 0.
     * Lengths from 1e-3 to 30, twists from -30 to 30.
     */
    RICCI_SHAPE_FENCHEL_NIELSEN = 14
};

/** A surface to be made. Zeroed by ricci_init. */
typedef struct ricci_shape {
    /** sizeof(ricci_shape). */
    size_t size;
    /** RICCI_SHAPE_*, which says what the other fields mean. */
    uint32_t shape;
    /** 0. */
    uint32_t reserved;
    /** Number of handles, at least 1. */
    size_t genus;
    /** Resolution. */
    size_t n;
    /** Resolution in the other direction. */
    size_t m;
    /** First size. */
    double a;
    /** Second size. */
    double b;
    /** Third size. */
    double c;
    /** Times around the axis. */
    uint32_t p;
    /** Times around the tube. */
    uint32_t q;
    /**
     * n_points x 2: real and imaginary parts of the finite branch points, all different; or lengths and
     * twists.
     */
    const double *points;
    /**
     * 2 g + 1 (infinity is one more) or 2 g + 2, at least 3, branch points; 3 g - 3 + 2 b rows of lengths and
     * twists.
     */
    size_t n_points;
} ricci_shape;

/**
 * Changes of a surface in space, with the fields of a ricci_change_spec that they use. New vertices come
 * last.
 */
enum {
    /**
     * Cut `count` round holes, as far from each other and from the boundary as the vertices allow; no room
     * for one is an error. Vertices and faces keep their order, those cut out are dropped.
     */
    RICCI_CHANGE_PUNCH = 0,
    /**
     * Halve the edges around `vertex`, then those of the smaller triangles around it, `count` times, at
     * most 100.
     */
    RICCI_CHANGE_GRADE = 1,
    /**
     * Cut `count` faces, chosen by `seed`, into three by a vertex near the middle of a side: smallest angle
     * `amount`, 1e-7 to 0.1.
     */
    RICCI_CHANGE_CAPS = 2,
    /** The same by a vertex near a corner: a short edge. */
    RICCI_CHANGE_NEEDLES = 3,
    /**
     * Move every vertex by up to `amount` (0 to 1000) of the mean edge length in each coordinate; the same
     * on every machine for a `seed`.
     */
    RICCI_CHANGE_NOISE = 4,
    /**
     * Map by the inversion in the sphere of this `centre`, away from every vertex, and radius `amount`;
     * faces keep their outside.
     */
    RICCI_CHANGE_INVERT = 5
};

/** A change to be made. Zeroed by ricci_init. */
typedef struct ricci_change_spec {
    /** sizeof(ricci_change_spec). */
    size_t size;
    /** RICCI_CHANGE_*. */
    uint32_t change;
    /** A vertex. */
    uint32_t vertex;
    /** A number of elements, or of repetitions. */
    size_t count;
    /** A size. */
    double amount;
    /** Seed of the random numbers. */
    uint64_t seed;
    /** A point in space. */
    double centre[3];
} ricci_change_spec;

/**
 * A sample surface.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT, RICCI_TOO_LARGE,
 * RICCI_TRIANGLE_INEQUALITY (triangles too thin for double precision).
 *
 * @param shape  the surface and its sizes.
 * @param mesh   out: the new handle, to be released by ricci_mesh_free.
 */
RICCI_API ricci_status ricci_make(const ricci_shape *shape, ricci_mesh **mesh);

/**
 * The loops a1, b1, ..., ag, bg, c1, ..., cb that the coordinates of RICCI_SHAPE_FENCHEL_NIELSEN belong to,
 * as edge paths of the surface that ricci_make makes; they start and end at vertex 0.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (also:
 * another shape), RICCI_SIZE (another number of curves), RICCI_TOO_LARGE, RICCI_TRIANGLE_INEQUALITY.
 *
 * @param shape            the surface.
 * @param edges            out: the paths one after the other: edges numbered from 1, negative backwards; NULL
 * with capacity 0 for their number alone.
 * @param edges_capacity   entries of `edges`.
 * @param starts           out: 2 g + b + 1 offsets: path k is edges[starts[k] .. starts[k + 1]).
 * @param starts_capacity  entries of `starts`.
 */
RICCI_API ricci_status ricci_make_loops(const ricci_shape *shape, int32_t *edges, size_t edges_capacity,
                                        size_t *starts, size_t starts_capacity);

/**
 * A changed copy of a surface in space, without its attributes.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (also: the mesh is intrinsic),
 * RICCI_TOO_LARGE.
 *
 * @param mesh    the surface.
 * @param change  the change and its arguments.
 * @param result  out: the new handle, to be released by ricci_mesh_free.
 */
RICCI_API ricci_status ricci_change(const ricci_mesh *mesh, const ricci_change_spec *change,
                                    ricci_mesh **result);

/**
 * The period matrix of the curve of RICCI_SHAPE_HYPERELLIPTIC, with respect to some symplectic basis of
 * cycles.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT.
 *
 * @param points    n_points x 2: real and imaginary parts of the finite branch points, all different.
 * @param n_points  2 g + 1 (infinity is one more) or 2 g + 2, at least 3.
 * @param periods   out: g x g x 2, real and imaginary parts of the symmetric matrix.
 * @param capacity  entries of `periods`, at least 2 g^2.
 */
RICCI_API ricci_status ricci_hyperelliptic_periods(const double *points, size_t n_points, double *periods,
                                                   size_t capacity);

#ifdef __cplusplus
}
#endif

#endif
