/* ricci: canonical shapes of surfaces: spheres, and quotients with their layouts and polygons.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_uniformize(mesh, NULL, NULL, &uniform);  // on the sphere, in the plane or the hyperbolic plane
 *     ricci_uniform_summarise(uniform, &summary, sizeof summary);
 *     ricci_uniform_layout(uniform, RICCI_ON_REFINEMENT, RICCI_MODEL_POINCARE, NULL, &layout);
 *
 * Deck groups and covers: ricci/deck.h.
 *
 * The conventions are those of ricci/ricci.h. Points of the hyperbolic plane and the sphere are ambient
 * coordinates (x, y, w), n x 3; the inline functions at the end convert them. A word is an int32_t array of
 * 1-based generator numbers, negative for inverses.
 *
 * Sources, by the keys of docs/bibliography.md: discrete uniformization [BPS15; GLSW18], of spheres [Riv94;
 * Spr20].
 */

#ifndef RICCI_UNIFORMIZE_H
#define RICCI_UNIFORMIZE_H

#include <math.h>
#include <ricci/charts.h>
#include <ricci/homotopy.h>
#include <ricci/ricci.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------------------------------------------------
 * Uniformization
 */

/**
 * A surface with its metric of constant curvature.
 *
 * Closed of genus 0: a convex polyhedron inscribed in the unit sphere. Others: the quotient of the plane or
 * the hyperbolic plane, with boundary of a part with straight sides, by its deck group, with a layout about a
 * base vertex, a homotopy basis and deck transformations.
 */
typedef struct ricci_uniform ricci_uniform;

/** The shape that the boundary of a surface is given. */
enum {
    /**
     * Closed geodesics: in the hyperbolic plane where chi < 0, in the plane around an annulus. A disk has
     * none.
     */
    RICCI_BOUNDARY_GEODESIC = 0,
    /** Straight sides between corners, in the plane. */
    RICCI_BOUNDARY_STRAIGHT = 1
};

/** Options of a uniformization. Zeroed by ricci_init: the defaults. */
typedef struct ricci_uniform_options {
    /** sizeof(ricci_uniform_options). */
    size_t size;
    /**
     * How the flow is done; NULL: its defaults. A sphere takes tolerance, max_iterations (of all its flows)
     * and threads; with RICCI_METHOD_GRADIENT it flows in S2 itself, with all of them and in any scheme. The
     * defaults suit all but studies of the flow.
     */
    const ricci_flow_options *flow;
    /**
     * Where the flow starts, such as another flow's result, in its scheme; in E2 (genus 1) or H2 (more).
     * NULL: at the mesh. A near metric saves steps where a surface is uniformized again after small changes.
     */
    const ricci_metric *start;
    /**
     * The vertex at a quotient's origin, where the loops of its homotopy basis meet; of a sphere the vertex
     * that is sent to infinity, or where the layout of one that flows in S2 starts. NULL: one from which no
     * vertex is far; one from which sizes differ least; vertex 0. Name one to compare surfaces with
     * corresponding vertices; NULL gives rounder layouts.
     */
    const uint32_t *base;
    /**
     * RICCI_SCHEME_*; spheres have RICCI_SCHEME_YAMABE, but for those that flow in S2. The default, inversive
     * distances and virtual radii keep the surface's conformal structure, the two others do not
     * (docs/results/schemes.md).
     */
    uint32_t scheme;
    /** 0. */
    uint32_t reserved;
    /**
     * RICCI_BOUNDARY_STRAIGHT: n_corners vertices of the boundary. NULL: as many corners with equal angles,
     * the vertices where the boundary turns by more than 45 degrees if there are just as many, else at equal
     * distances along the longest loop; with n_corners = 0 four on a disk, none on an annulus, 4 |chi| on
     * other surfaces. NULL suits rectangles with sharp corners, such as panels.
     */
    const uint32_t *corners;
    /**
     * n_corners angles inside the corners, radians; 0: corners without an angle share the rest. NULL: all are
     * equal. NULL suits rectangles.
     */
    const double *corner_angles;
    /** Number of corners. Four make the modulus of a quadrilateral. */
    size_t n_corners;
    /**
     * RICCI_BOUNDARY_*: the shape that the boundary is given. Geodesics suit comparisons of shape, straight
     * sides textures.
     */
    uint32_t boundary;
    /** 0. */
    uint32_t reserved_too;
} ricci_uniform_options;

/** Figures of a uniformization. Figures that a kind of surface does not have are 0. */
typedef struct ricci_uniform_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /**
     * RICCI_SPACE_S2, RICCI_SPACE_E2, RICCI_SPACE_H2 for chi > 0, = 0, < 0; RICCI_SPACE_E2 with straight
     * sides.
     */
    uint32_t space;
    /**
     * The base vertex: at the origin of a quotient, at infinity of the plane under a sphere, where the
     * layout of a sphere starts that has flowed in S2.
     */
    uint32_t base;
    /**
     * 1 if the curvature is within the tolerance and no triangle is broken; of a sphere also every edge
     * Delaunay and the plane's outline convex to 1e-9; else 0.
     */
    uint32_t converged;
    /** RICCI_STOP_*: why the (last) flow stopped. */
    uint32_t stop_reason;
    /** Its name; lives as long as the program. */
    const char *stop_reason_text;
    /** g. */
    size_t genus;
    /** Newton steps of all flows. */
    size_t iterations;
    /** Edge flips inside the conformal class. */
    size_t n_flips;
    /** Edge flips before them, which change no distance on the surface. */
    size_t n_start_flips;
    /** Largest |K| that the flow has left, of a sphere in the plane under it (if there is one), radians. */
    double max_curvature_error;
    /**
     * Largest |K| of the metric, of a quotient after corrections in double-double precision, radians.
     */
    double angle_defect;
    /** |sum of curvatures + lambda area - 2 pi chi| of the metric. */
    double gauss_bonnet;
    /** Area: in the plane that of the given surface, else 2 pi |chi|; by a formula without angles. */
    double area;
    /** Quotients: number of generators, 2 g and one per boundary loop. */
    size_t n_generators;
    /** Quotients: number of sides of the layout as a fundamental domain. */
    size_t n_sides;
    /** Quotients: corners of ricci_uniform_polygon, 4 g and one per boundary loop. */
    size_t n_polygon;
    /**
     * Quotients: largest distance between where a face has its corner and where the corner lies, also
     * across the cut by the pairings.
     */
    double disagreement;
    /** Quotients: largest distance of a point of the layout from the origin. */
    double radius;
    /**
     * Quotients: |R - I| / max |P_k|^2 of the relation's matrix R over its partial products P_k, Frobenius
     * norms of 2 x 2 matrices.
     */
    double relation_residual;
    /** Quotients: the same of each side's pairing against its word; the largest. */
    double side_residual;
    /**
     * Quotients: ambient coordinates of the base lift, from which deck transformations are counted: the
     * origin, up to a loop of the base on the cut.
     */
    double base_lift[3];
    /**
     * Of a torus, real and imaginary part: the quotient of two periods in |Re| <= 1/2, |tau| >= 1, Im > 0,
     * on the border Re >= 0. Else NaN.
     */
    double modulus[2];
    /** Spheres: flows that were started. */
    size_t n_tried;
    /**
     * Spheres: largest minus smallest u in the plane. Beyond about 30 the positions are not accurate in
     * double precision, though the metric is.
     */
    double u_range;
    /** Spheres: length of the shortest edge. */
    double smallest_edge;
    /**
     * Spheres: by how much angles opposite an edge exceed pi in the plane at most, radians: 0 where all
     * edges are Delaunay.
     */
    double delaunay_violation;
    /** Spheres: least turning of the plane's outline, radians: not negative where it is convex. */
    double outline_turning;
    /**
     * Spheres: largest signed distance of a vertex over the plane of a neighbouring face: not positive
     * where the polyhedron is convex.
     */
    double nonconvexity;
    /**
     * Spheres: |sum of w x| / sum of w over the vertices, w one third of the area of the given faces at x.
     */
    double off_centre;
    /** Number of straight sides of the boundary; a loop without corners has one. */
    size_t n_boundary_sides;
    /**
     * Largest distance of a vertex of the boundary from the line through the ends of its side: in the
     * hyperbolic plane a length, in the plane in units of the side.
     */
    double straightness;
    /**
     * Of an annulus in the plane, and of a disk with four right angles, height over base: the distance of
     * the loops over the length of one, the length of the second side over that of the first. Else NaN.
     */
    double extremal_distance;
} ricci_uniform_summary;

/**
 * The metric of constant curvature in the conformal class of a surface: on the sphere, in the plane or in the
 * hyperbolic plane, by its Euler characteristic and the shape of its boundary.
 *
 * Genus 0: the polyhedron whose edges, after flips, are chords with lengths in the conformal class of the
 * surface; its vertices are moved by the Moebius transformation after which their mean is the centre, each
 * weighed with one third of the area of the given faces at it: they are determined up to a rotation. With
 * RICCI_METHOD_GRADIENT the surface flows in S2, on its own triangulation, and is laid out from the base.
 * Genus 1: flat, with the area of the given surface; more: hyperbolic. If the flow has not converged, the
 * other results are as accurate as the metric. Deterministic.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (no such vertex; a sphere of less
 * than four vertices or in another scheme; a corner that is not on the boundary), RICCI_LAYOUT (geodesics
 * around a disk; `start` in another space; a vertex of a sphere has half of its area, or all lie on one
 * circle), RICCI_TARGET_TOTAL (the angles of the corners), RICCI_TARGET_AT_VERTEX, RICCI_EDGE_LENGTH,
 * RICCI_TRIANGLE_INEQUALITY, RICCI_EDGE_WEIGHT, RICCI_DOMAIN, RICCI_NO_MEMORY, RICCI_FACTORISATION,
 * RICCI_CANCELLED.
 *
 * @param mesh     the mesh; may be NULL if the options have a `start`.
 * @param options  the options; NULL for the defaults.
 * @param control  progress and cancellation; NULL for neither.
 * @param uniform  out: the new handle, to be released by ricci_uniform_free.
 */
RICCI_API ricci_status ricci_uniformize(const ricci_mesh *mesh, const ricci_uniform_options *options,
                                        const ricci_control *control, ricci_uniform **uniform);

/**
 * Release a uniformization. Handles that were made from it live on.
 *
 * @param uniform  the handle, or NULL.
 */
RICCI_API_VOID void ricci_uniform_free(ricci_uniform *uniform);

/**
 * The figures of a uniformization.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param uniform  the uniformization.
 * @param summary  out: the figures.
 * @param size     sizeof *summary.
 */
RICCI_API ricci_status ricci_uniform_summarise(const ricci_uniform *uniform, ricci_uniform_summary *summary,
                                               size_t size);

/**
 * The metric of constant curvature; of a quotient, and of a sphere that has flowed in S2, with the report of
 * the flow.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER.
 *
 * @param uniform  the uniformization.
 * @param metric   out: the new handle, to be released by ricci_metric_free.
 */
RICCI_API ricci_status ricci_uniform_metric(const ricci_uniform *uniform, ricci_metric **metric);

/**
 * The straight sides of the boundary, loop after loop in the order of the mesh's, from corner to corner with
 * the surface on the left; a loop without corners is one side.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_LAYOUT (a sphere).
 *
 * @param uniform   the uniformization, of a quotient.
 * @param from      out: n_boundary_sides x 2: the generator of the side's loop, 1-based, and the vertex of
 *                  the mesh that the side starts at.
 * @param lengths   out: n_boundary_sides x 2: the side's length; the largest distance of a vertex of the
 *                  boundary from it, as `straightness` has it.
 * @param capacity  rows of `from` and of `lengths`.
 */
RICCI_API ricci_status ricci_uniform_sides(const ricci_uniform *uniform, uint32_t *from, double *lengths,
                                           size_t capacity);

/**
 * The homotopy basis whose loops generate the deck group: on the triangulation of the metric, short in it; if
 * the metric lives on the double of the mesh, on the common subdivision.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_LAYOUT (a sphere).
 *
 * @param uniform   the uniformization, of a quotient.
 * @param homotopy  out: the new handle, to be released by ricci_homotopy_free.
 */
RICCI_API ricci_status ricci_uniform_homotopy(const ricci_uniform *uniform, ricci_homotopy **homotopy);

/**
 * The layout as a fundamental domain: its sides, in the order of RICCI_DECK_SIDES.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_LAYOUT (a sphere).
 *
 * @param uniform  the uniformization, of a quotient.
 * @param domain   out: the new handle, to be released by ricci_domain_free.
 */
RICCI_API ricci_status ricci_uniform_domain(const ricci_uniform *uniform, ricci_domain **domain);

/**
 * The layout of a quotient about its base. Its seams are the segments of the cut, two sides of the domain
 * each.
 * The corners of the mesh itself have coordinates in ricci_layout_new of its metric, which is cut along edges
 * of the mesh.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (RICCI_MODEL_AMBIENT), RICCI_LAYOUT (a sphere, whose
 * points are ricci_sphere_points; RICCI_ON_INPUT: the cut does not run along edges of the mesh;
 * RICCI_ON_METRIC: the metric lives on the double of the mesh), RICCI_TRIANGLE_INEQUALITY, RICCI_DOMAIN,
 * RICCI_EDGE_WEIGHT, RICCI_TOO_LARGE (the common subdivision), RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param uniform  the uniformization, of a quotient.
 * @param on       RICCI_ON_METRIC: the metric's own triangulation; RICCI_ON_REFINEMENT: on the given
 *                 surface.
 * @param model    RICCI_MODEL_* with two coordinates; in the Klein disk the map is projective on every
 *                 piece.
 * @param control  progress and cancellation; NULL for neither.
 * @param layout   out: the new handle, to be released by ricci_layout_free.
 */
RICCI_API ricci_status ricci_uniform_layout(const ricci_uniform *uniform, uint32_t on, uint32_t model,
                                            const ricci_control *control, ricci_layout **layout);

/**
 * The canonical polygon: geodesics from lift to lift of the base along the relation. Its sides a1, b1,
 * a1^-1, b1^-1, ... are paired by the generators; its corners are one point of the surface, so its angles
 * add up to 2 pi. It need not be convex.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_LAYOUT (a sphere).
 *
 * @param uniform   the uniformization, of a quotient.
 * @param corners   out: n_polygon x 3, ambient coordinates; corner k is where the first k letters of the
 *                  relation carry the base lift.
 * @param angles    out: n_polygon angles inside, radians, from 0 to below 2 pi.
 * @param capacity  rows of `corners` and entries of `angles`.
 */
RICCI_API ricci_status ricci_uniform_polygon(const ricci_uniform *uniform, double *corners, double *angles,
                                             size_t capacity);

/**
 * The lift of an edge path of the triangulation of the homotopy basis that starts at the base, from the base
 * lift, in ambient coordinates: the start, then the end of each edge. That of a loop ends where the loop's
 * element carries the base lift.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such edges, no path, or
 * not from the base), RICCI_LAYOUT (a sphere).
 *
 * @param uniform   the uniformization, of a quotient.
 * @param path      n_path edges: 1-based, negative where the path runs against the edge's direction.
 * @param n_path    number of edges.
 * @param points    out: (n_path + 1) x 3.
 * @param capacity  entries of `points`.
 */
RICCI_API ricci_status ricci_uniform_lift(const ricci_uniform *uniform, const int32_t *path, size_t n_path,
                                          double *points, size_t capacity);

/**
 * The lift of a closed loop through vertices of the given mesh, each joined to the next by an edge and the
 * last to the first: points of the universal cover in ambient coordinates, from a corner of the layout on,
 * and the deck transformation that carries the first point to the last. The loop is contracted if and only if
 * its word is empty.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (fewer than two vertices, no
 * such vertex, neighbours that no edge joins), RICCI_LAYOUT (a sphere, a layout of another uniformization).
 *
 * @param uniform           the uniformization, of a quotient.
 * @param layout            its layout by ricci_uniform_layout on RICCI_ON_REFINEMENT.
 * @param vertices          the loop; the first vertex may also be named again at the end.
 * @param n_vertices        number of entries of `vertices`.
 * @param points            out: n_points / 3 points along the loop, the first vertex's at both ends; where
 *                          edges of the metric's triangulation cross the loop, points of the crossings are
 *                          between them. NULL with capacity 0 to ask for their number.
 * @param capacity          entries of `points`.
 * @param n_points          out: entries of `points`.
 * @param letters           out: the word of the deck transformation; NULL with capacity 0 to ask for its
 *                          length.
 * @param letters_capacity  entries of `letters`.
 * @param n_letters         out: number of letters.
 */
RICCI_API ricci_status ricci_uniform_lift_loop(const ricci_uniform *uniform, const ricci_layout *layout,
                                               const uint32_t *vertices, size_t n_vertices, double *points,
                                               size_t capacity, size_t *n_points, int32_t *letters,
                                               size_t letters_capacity, size_t *n_letters);

/**
 * The vertices of the given mesh on the unit sphere, or in the plane under it, where coordinates near (0, 0,
 * 1) have far more digits.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT, RICCI_LAYOUT (not a
 * sphere; the plane under one that has flowed in S2).
 *
 * @param uniform   the uniformization, of a sphere.
 * @param model     RICCI_MODEL_AMBIENT: unit vectors; else the plane (ricci_to_plane), infinite at the
 *                  base.
 * @param points    out: n_vertices x 3, or x 2.
 * @param capacity  entries of `points`.
 */
RICCI_API ricci_status ricci_sphere_points(const ricci_uniform *uniform, uint32_t model, double *points,
                                           size_t capacity);

/**
 * The polyhedron as a mesh with unit vectors as positions, counterclockwise from outside.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT, RICCI_LAYOUT (not a sphere; RICCI_ON_INPUT),
 * RICCI_DOMAIN, RICCI_EDGE_WEIGHT, RICCI_TOO_LARGE, RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param uniform  the uniformization, of a sphere.
 * @param on       RICCI_ON_METRIC: the metric's triangulation; RICCI_ON_REFINEMENT: the common subdivision
 *                 with the mesh, whose faces are those of ricci_map_mesh on the given surface.
 * @param control  progress and cancellation; NULL for neither.
 * @param mesh     out: the new handle, to be released by ricci_mesh_free.
 */
RICCI_API ricci_status ricci_sphere_mesh(const ricci_uniform *uniform, uint32_t on,
                                         const ricci_control *control, ricci_mesh **mesh);

/* ---------------------------------------------------------------------------------------------------------
 * Points in other coordinates. Inline, without a check: rows that are no points of their model give
 * meaningless numbers.
 */

/**
 * A point (x, y, w) of the hyperboloid in a RICCI_MODEL_*: two coordinates, three for RICCI_MODEL_AMBIENT.
 * `to` may be `from`.
 */
static inline void ricci_from_hyperboloid(uint32_t model, const double *from, double *to) {
    const double x = from[0], y = from[1], w = from[2];
    const double rest = model == RICCI_MODEL_POINCARE ? 1 + w
                        : model == RICCI_MODEL_KLEIN  ? w
                        : x > 0                       ? (1 + y * y) / (w + x) /* w - x without cancellation */
                                                      : w - x;
    if (model == RICCI_MODEL_AMBIENT) {
        to[0] = x, to[1] = y, to[2] = w;
    } else if (model == RICCI_MODEL_HALF_PLANE) {
        to[0] = -y / rest, to[1] = 1 / rest;
    } else {
        to[0] = x / rest, to[1] = y / rest;
    }
}

/** The point (x, y, w) of the hyperboloid from its coordinates in a RICCI_MODEL_*. `to` may be `from`. */
static inline void ricci_to_hyperboloid(uint32_t model, const double *from, double *to) {
    const double x = from[0], y = from[1], r = hypot(x, y), rest = (1 - r) * (1 + r);
    if (model == RICCI_MODEL_POINCARE) {
        to[0] = 2 * x / rest, to[1] = 2 * y / rest, to[2] = (1 + r * r) / rest;
    } else if (model == RICCI_MODEL_KLEIN) {
        to[2] = 1 / sqrt(rest), to[0] = x * to[2], to[1] = y * to[2];
    } else if (model == RICCI_MODEL_HALF_PLANE) {
        const double sum = (x * x + y * y) / y;
        to[0] = 0.5 * (sum - 1 / y), to[1] = -x / y, to[2] = 0.5 * (sum + 1 / y);
    } else {
        to[0] = x, to[1] = y, to[2] = hypot(r, 1);
    }
}

/**
 * A unit vector (x, y, w) in the plane, seen from the south pole: (x + i y)/(1 + w); infinite for (0, 0,
 * -1). `to` may be `from`.
 */
static inline void ricci_to_plane(const double *from, double *to) {
    const double x = from[0], y = from[1], w = from[2];
    const double rest = w >= 0 ? 1 + w : (x * x + y * y) / (1 - w);
    to[0] = rest > 0 ? x / rest : HUGE_VAL, to[1] = rest > 0 ? y / rest : HUGE_VAL;
}

/**
 * The unit vector over a point of the plane, the inverse of ricci_to_plane: 0 goes to (0, 0, 1), infinity
 * to (0, 0, -1). `to` may be `from`.
 */
static inline void ricci_to_sphere(const double *from, double *to) {
    const double x = from[0], y = from[1], r = hypot(x, y);
    if (r <= 1) {
        const double d = 1 + r * r;
        to[0] = 2 * x / d, to[1] = 2 * y / d, to[2] = (1 - r) * (1 + r) / d;
    } else if (r == HUGE_VAL) {
        to[0] = 0, to[1] = 0, to[2] = -1;
    } else {
        const double q = 1 / r, d = 1 + q * q;
        to[0] = 2 * (x / r) * q / d, to[1] = 2 * (y / r) * q / d, to[2] = -(1 - q) * (1 + q) / d;
    }
}

#ifdef __cplusplus
}
#endif

/* It was a part of this header. */
#include <ricci/deck.h>

#endif
