/* ricci: circle domains, surfaces with boundary whose loops are circles; and the circle patterns of layouts.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_circle_domain_new(mesh, NULL, NULL, &domain);
 *     ricci_circle_domain_summarise(domain, &summary, sizeof summary);
 *     ricci_circle_domain_circles(domain, circles, 4 * summary.n_circles);  // centres and radii
 *     ricci_circle_domain_layout(domain, RICCI_MODEL_POINCARE, &layout);
 *
 * The conventions are those of ricci/ricci.h.
 *
 * Sources, by the keys of docs/bibliography.md: circle patterns [Thu80; BPS15].
 */

#ifndef RICCI_CIRCLES_H
#define RICCI_CIRCLES_H

#include <ricci/ricci.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A surface with boundary whose loops are circles. */
typedef struct ricci_circle_domain ricci_circle_domain;

/** The shape in which a surface of genus 0 is laid out. */
enum {
    /** The unit disk; for an annulus the strip where doubles do not hold its inner circle in the disk. */
    RICCI_FRAME_AUTO = 0,
    /** The unit disk. */
    RICCI_FRAME_DISK = 1,
    /**
     * An annulus in log coordinates: [0, 2 pi] x [0, 2 pi m] with the sides x = 0 and x = 2 pi identified, m
     * the modulus. (x, y) is the point of the disk with the angle x and the radius e^-y; the outer loop is y
     * = 0.
     */
    RICCI_FRAME_STRIP = 2
};

/** Options of a circle domain. Zeroed by ricci_init: the defaults. */
typedef struct ricci_circle_domain_options {
    /** sizeof(ricci_circle_domain_options). */
    size_t size;
    /**
     * Tolerance, max_iterations and threads of the flows; NULL: their defaults. The defaults suit all but
     * studies of the flow.
     */
    const ricci_flow_options *flow;
    /**
     * Genus 0: the boundary loop that becomes the unit circle; NULL: the longest. NULL suits surfaces with
     * one large opening.
     */
    const uint32_t *outer;
    /**
     * Genus 0: the vertex at the centre of the unit disk. NULL, and `three` too: of an annulus both circles
     * lie about the centre; else the barycentre of the area of the faces does, and the outer loop's first
     * vertex lies at (1, 0). Name one to compare surfaces with a vertex that corresponds.
     */
    const uint32_t *centre;
    /**
     * Genus 0: three vertices of the outer loop, counterclockwise, to lie at `angles`; or NULL. They fix the
     * map altogether, as comparisons of disks need it.
     */
    const uint32_t *three;
    /**
     * Three angles, counterclockwise, radians; NULL: 0, 2 pi / 3, 4 pi / 3. The default spreads them evenly.
     */
    const double *angles;
    /** Edges of loops with fewer than this are halved; 0: 12. More make holes rounder in pictures. */
    size_t least_loop;
    /**
     * RICCI_FRAME_*; of a strip the surface is an annulus, and no vertex has a place. The default suits all
     * but textures of tubes, which the strip unrolls.
     */
    uint32_t frame;
    /** 0. */
    uint32_t reserved;
} ricci_circle_domain_options;

/** Figures of a circle domain. */
typedef struct ricci_circle_domain_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** RICCI_SPACE_E2: the unit disk (genus 0) or a flat torus (1); RICCI_SPACE_H2 for more. */
    uint32_t space;
    /**
     * 1 if the domain as it is has its curvature within the tolerance, loops that are round to 1e-9 of the
     * radius, no circles that overlap and no flipped triangle; else 0.
     */
    uint32_t converged;
    /** RICCI_STOP_*: why the flow stopped; RICCI_STOP_ROUNDING_FLOOR if the domain is less exact than it. */
    uint32_t stop_reason;
    /** Genus 0: the loop on the unit circle; else UINT32_MAX. */
    uint32_t outer;
    /** The name of the stop reason; lives as long as the program. */
    const char *stop_reason_text;
    /** Circles: one per boundary loop of the mesh. */
    size_t n_circles;
    /** Circles that overlap another one. */
    size_t n_overlapping;
    /** Newton steps of all flows. */
    size_t iterations;
    /** Edge flips. */
    size_t n_flips;
    /** Vertices that were added to the mesh before the flow: the last ones of ricci_circle_domain_mesh. */
    size_t n_halved;
    /** Vertices that flips have added to loops: some of those that the layout has beyond that mesh. */
    size_t n_crossed;
    /** Largest |K| of the metric off the outer loop, radians. */
    double max_curvature_error;
    /** Largest distance of a loop's vertex from its circle, a share of the radius. */
    double deviation;
    /**
     * An annulus: 0 and its height over its circumference. A torus with holes: the modulus of the torus.
     * Else NaN.
     */
    double modulus[2];
    /** RICCI_FRAME_DISK or RICCI_FRAME_STRIP: the shape of the layout; RICCI_FRAME_AUTO of genus 1 and more.
     */
    uint32_t frame;
    /** The loop with the largest deviation; UINT32_MAX: none. */
    uint32_t worst_loop;
    /** The vertex of the metric with the largest |K|, a hub beyond those of the mesh; UINT32_MAX: none. */
    uint32_t worst_vertex;
    /** The loop that was put about 0 because doubles do not hold it elsewhere; UINT32_MAX: none. */
    uint32_t centred_on;
} ricci_circle_domain_summary;

/**
 * A surface with boundary in the metric of its conformal class, flat or hyperbolic, whose boundary loops are
 * circles: of genus 0 in the unit disk, one of the loops the unit circle; of genus 1 in a flat torus; of more
 * in a hyperbolic surface.
 *
 * Edges of loops are halved where a loop has few, lies opposite an obtuse angle, or has a circle that
 * overlaps another one. Deterministic.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (a closed surface; no such loop or
 * vertex; `centre` and `three` together, or for a surface of higher genus; `three` not counterclockwise on
 * the outer loop; no edge inside), RICCI_LAYOUT (no plane was found; circles overlap however fine the loops
 * are), RICCI_EDGE_LENGTH, RICCI_TRIANGLE_INEQUALITY, RICCI_EDGE_WEIGHT, RICCI_DOMAIN, RICCI_TOO_LARGE,
 * RICCI_NO_MEMORY, RICCI_FACTORISATION, RICCI_CANCELLED.
 *
 * @param mesh     the mesh.
 * @param options  the options; NULL for the defaults.
 * @param control  progress and cancellation; NULL for neither.
 * @param domain   out: the new handle, to be released by ricci_circle_domain_free.
 */
RICCI_API ricci_status ricci_circle_domain_new(const ricci_mesh *mesh,
                                               const ricci_circle_domain_options *options,
                                               const ricci_control *control, ricci_circle_domain **domain);

/**
 * Release a circle domain. Handles that were made from it live on.
 *
 * @param domain  the handle, or NULL.
 */
RICCI_API_VOID void ricci_circle_domain_free(ricci_circle_domain *domain);

/**
 * The figures of a circle domain.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param domain   the circle domain.
 * @param summary  out: the figures.
 * @param size     sizeof *summary.
 */
RICCI_API ricci_status ricci_circle_domain_summarise(const ricci_circle_domain *domain,
                                                     ricci_circle_domain_summary *summary, size_t size);

/**
 * The circles, loop by loop, loops in the order of their first edges: centre in the plane or the Poincare
 * disk (of one lift), radius in the metric, and the largest distance of a vertex of the loop from the circle
 * as a share of the radius.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param domain    the circle domain.
 * @param circles   out: n_circles x 4: x, y, radius, deviation.
 * @param capacity  entries of `circles`.
 */
RICCI_API ricci_status ricci_circle_domain_circles(const ricci_circle_domain *domain, double *circles,
                                                   size_t capacity);

/**
 * The logarithms of the radii, loop by loop; in a strip also those of circles whose radius is below the range
 * of doubles.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param domain     the circle domain.
 * @param log_radii  out: n_circles logarithms.
 * @param capacity   entries of `log_radii`.
 */
RICCI_API ricci_status ricci_circle_domain_log_radii(const ricci_circle_domain *domain, double *log_radii,
                                                     size_t capacity);

/**
 * The given mesh with the vertices that were added to its loops before the flow; its first vertices are the
 * given ones, in order.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER.
 *
 * @param domain  the circle domain.
 * @param mesh    out: the new handle, to be released by ricci_mesh_free.
 */
RICCI_API ricci_status ricci_circle_domain_mesh(const ricci_circle_domain *domain, ricci_mesh **mesh);

/**
 * The layout of the surface without its holes, as on RICCI_ON_REFINEMENT: its mesh refines
 * ricci_circle_domain_mesh, which is its input. Of a torus it has the area of the given surface.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (RICCI_MODEL_AMBIENT), RICCI_NO_MEMORY.
 *
 * @param domain  the circle domain.
 * @param model   RICCI_MODEL_* with two coordinates.
 * @param layout  out: the new handle, to be released by ricci_layout_free.
 */
RICCI_API ricci_status ricci_circle_domain_layout(const ricci_circle_domain *domain, uint32_t model,
                                                  ricci_layout **layout);

/** The circles of a layout in E2. */
enum {
    /**
     * Per point of the layout, the circle of its vertex: a real one in the circle schemes, of radius 0 with
     * vertex scaling, of imaginary radius in RICCI_SCHEME_VIRTUAL.
     */
    RICCI_CIRCLES_VERTICES = 0,
    /** Per face of the metric's triangulation, the circle orthogonal to those of its vertices. */
    RICCI_CIRCLES_FACES = 1
};

/**
 * The circle pattern of a layout in the plane.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT, RICCI_LAYOUT (another space
 * than E2), RICCI_DOMAIN (a radius that no double holds).
 *
 * @param layout    the layout.
 * @param which     RICCI_CIRCLES_*.
 * @param circles   out: rows of three: the centre and the square of the radius, negative where that is
 *                  imaginary; NaN where there is none: at a crossing of the refinement, of a face that is not
 *                  laid out or has no area. n_points x 3, or n_faces of the metric x 3.
 * @param capacity  entries of `circles`.
 */
RICCI_API ricci_status ricci_layout_circles(const ricci_layout *layout, uint32_t which, double *circles,
                                            size_t capacity);

#ifdef __cplusplus
}
#endif

#endif
