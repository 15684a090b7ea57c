/* ricci: invariants of conformal structures with bounds of their errors.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_forms_new(mesh, NULL, NULL, &forms);
 *     ricci_forms_bounds(forms, NULL, NULL, matrix, 3 * g * g, &summary, sizeof summary);
 *     // Entry i, j of the period matrix is within matrix[3 * (g * i + j) + 2] of the number before it.
 *
 * The conventions are those of ricci/ricci.h.
 *
 * Sources, by the keys of docs/bibliography.md: periods [BS16], the ball of Siegel's half-space [Sie43],
 * errors of double-double numbers [JMP17].
 */

#ifndef RICCI_MODULI_H
#define RICCI_MODULI_H

#include <ricci/deck.h>
#include <ricci/harmonic.h>
#include <ricci/match.h>
#include <ricci/uniformize.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The functions whose derivatives are added to forms. */
enum {
    /** Quadratic on faces where that narrows most; the width falls about as 1 / n_unknowns^2. */
    RICCI_DEGREE_QUADRATIC = 0,
    /** Linear on every face; the width falls as 1 / n_unknowns. */
    RICCI_DEGREE_LINEAR = 1
};

/** Options of ricci_forms_bounds; zeros are the defaults. */
typedef struct ricci_bounds_options {
    /** sizeof(ricci_bounds_options), by ricci_init. */
    size_t size;
    /**
     * The gap that is aimed at; 0: 1e-3. An infinite one takes the forms as they are, and 1e-6 is reached by
     * surfaces of small genus.
     */
    double width;
    /**
     * Largest number of unknowns of a system; 0: 4 for each vertex and 200,000 more. Raise it where the width
     * is not reached and memory is large.
     */
    size_t most_unknowns;
    /**
     * RICCI_DEGREE_.... Quadratic functions narrow faster; linear ones are what the mesh itself is solved
     * with.
     */
    uint32_t degree;
    /** 0. */
    uint32_t reserved;
} ricci_bounds_options;

/** Figures of a bound. */
typedef struct ricci_bounds_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /**
     * A proven d - 1: with the energies G of the surface's harmonic forms and those H of the matrix, H / d <=
     * G <= d H in the order of definite matrices.
     */
    double gap;
    /** The gap on the triangulation of the forms alone, rounded. */
    double first_gap;
    /** Of a torus, the modulus: real and imaginary part; NaN of others. */
    double modulus[2];
    /** Of a torus, the distance within which the modulus is; NaN of others. */
    double modulus_radius;
    /** Number of vertices that were added. */
    size_t n_added;
    /** Number of unknowns of the last system. */
    size_t n_unknowns;
    /** Number of systems that were solved. */
    size_t n_systems;
    /** 1 if the gap is at most the width, else 0. */
    uint32_t reached;
    /** 0. */
    uint32_t reserved;
} ricci_bounds_summary;

/**
 * The period matrix of a closed surface with a bound of its error, proven with the rounding of all numbers:
 * it is true of the polyhedron with exactly the edge lengths of ricci_forms_mesh.
 *
 * Where the gap is above the width, forms are sought on finer triangulations. Every entry (i, j) of the
 * surface's period matrix, in the basis of the forms, is within gap sqrt(Im P_ii Im P_jj) of P_ij.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT, RICCI_STRUCT_SIZE,
 * RICCI_LAYOUT (genus 0, or a boundary), RICCI_EDGE_LENGTH (lengths more than 1e35 apart),
 * RICCI_FACTORISATION, RICCI_TOO_LARGE, RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param forms     the forms.
 * @param options   the width, or NULL.
 * @param control   progress and cancellation, or NULL.
 * @param matrix    out: genus x genus x 3, row i, column j: real part, imaginary part, radius.
 * @param capacity  entries of `matrix`.
 * @param summary   out: the figures.
 * @param size      sizeof *summary.
 */
RICCI_API ricci_status ricci_forms_bounds(const ricci_forms *forms, const ricci_bounds_options *options,
                                          const ricci_control *control, double *matrix, size_t capacity,
                                          ricci_bounds_summary *summary, size_t size);

/** What a lower bound of dilatations is proven by. */
enum {
    /** Nothing is known of this topology: the bound is 1. */
    RICCI_LOWER_NONE = 0,
    /** Period matrices of closed surfaces, or of the doubles of surfaces with boundary. */
    RICCI_LOWER_PERIODS = 1,
    /** Moduli of annuli, or of quadrilaterals. */
    RICCI_LOWER_MODULI = 2
};

/** Two numbers between which the least dilatation K of the maps of a class lies. */
typedef struct ricci_dilatation_bracket {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** No map of the class has a smaller dilatation. */
    double lower;
    /** The dilatation of a map of the class, the largest over the pieces of ricci_matching_map. */
    double upper;
    /** The dilatation that 99 % of the source's area stay below. */
    double most;
    /** The share of the source's area in pieces that rounding leaves without a shape. */
    double left_out_area;
    /** The relative widths of the period matrices or moduli of source and target. */
    double gaps[2];
    /** Number of those pieces; they do not count in `upper`. */
    size_t n_left_out;
    /** RICCI_LOWER_*. */
    uint32_t lower_by;
    /**
     * 1 if `upper` is of the map by the numbers of vertices, which is linear on the faces of one
     * triangulation on both surfaces; else 0.
     */
    uint32_t by_numbers;
} ricci_dilatation_bracket;

/**
 * A bracket of the Teichmueller distance of two surfaces, log(K) / 2 for the least dilatation K of the maps
 * in the class of a matching.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT, RICCI_STRUCT_SIZE, RICCI_EDGE_LENGTH,
 * RICCI_FACTORISATION, RICCI_MATCHING (triangles so thin that the order of their lines cannot be decided),
 * RICCI_TOO_LARGE, RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param matching  the matching.
 * @param corners   4 x 2 vertices of the boundaries of disks, of source and target, that the maps of the
 * class bring to each other, or NULL.
 * @param options   the width of period matrices or moduli, or NULL.
 * @param control   progress and cancellation, or NULL.
 * @param bracket   out: the bracket.
 * @param size      sizeof *bracket.
 */
RICCI_API ricci_status ricci_matching_bracket(const ricci_matching *matching, const uint32_t *corners,
                                              const ricci_bounds_options *options,
                                              const ricci_control *control, ricci_dilatation_bracket *bracket,
                                              size_t size);

/**
 * Two proven bounds of the modulus of an annulus, or of the quadrilateral of a disk with four corners,
 * rounding included: of the polyhedron with exactly the given lengths. The modulus is height over base of the
 * conformal image: of an annulus the distance of its loops over the length of one, of a quadrilateral the
 * second side over the first, which starts at the first corner.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (another surface; corners that are not four vertices
 * of the boundary), RICCI_STRUCT_SIZE, RICCI_EDGE_LENGTH (lengths more than 1e35 apart), RICCI_FACTORISATION,
 * RICCI_TOO_LARGE, RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param mesh      the surface.
 * @param corners   4 vertices, or NULL for an annulus.
 * @param options   the width, or NULL.
 * @param control   progress and cancellation, or NULL.
 * @param interval  out: 2 entries, the bounds.
 * @param summary   out: the figures of the torus of mirror images on which the bounds are proven.
 * @param size      sizeof *summary.
 */
RICCI_API ricci_status ricci_modulus_bounds(const ricci_mesh *mesh, const uint32_t *corners,
                                            const ricci_bounds_options *options, const ricci_control *control,
                                            double *interval, ricci_bounds_summary *summary, size_t size);

/**
 * Fenchel-Nielsen coordinates of a hyperbolic surface of genus g with b boundary loops: the lengths and
 * twists of 3 g - 3 + b curves that cut it into pairs of pants, a1, ..., ag, the commutators a_i b_i a_i^-1
 * b_i^-1 (in genus 2 without boundary the first alone; in genus 1 with one boundary loop none), and the
 * products d_i of the first i of commutators and boundary loops for i from 2 to g + b - 2.
 *
 * The twist is the way along the curve, in its direction, from the foot of the neighbour on its right to that
 * of the neighbour on its left; docs/notation.md, section 13, has the neighbours.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_LAYOUT (another surface).
 *
 * @param uniform      the surface in its hyperbolic metric.
 * @param coordinates  out: (3 g - 3 + b) x 2: length and twist of each curve.
 * @param capacity     entries of `coordinates`.
 */
RICCI_API ricci_status ricci_fenchel_nielsen(const ricci_uniform *uniform, double *coordinates,
                                             size_t capacity);

/**
 * The same coordinates with loops of one's own as the generators a1, b1, ..., c1, ..., such as those of
 * ricci_make_loops: edge paths on the given mesh that start and end at one vertex.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such edge; edges that do
 * not follow each other; loops that do not start and end at one vertex; starts), RICCI_SIZE (another number
 * of loops than 2 g + b), RICCI_LAYOUT (another surface; loops whose relator is not 1), RICCI_NO_MEMORY,
 * RICCI_CANCELLED.
 *
 * @param uniform      the surface in its hyperbolic metric.
 * @param edges        the paths one after the other: edges numbered from 1, negative backwards.
 * @param starts       n_loops + 1 offsets: path k is edges[starts[k] .. starts[k + 1]).
 * @param n_loops      2 g + b.
 * @param control      progress and cancellation, or NULL.
 * @param coordinates  out: (3 g - 3 + b) x 2: length and twist of each curve.
 * @param capacity     entries of `coordinates`.
 */
RICCI_API ricci_status ricci_fenchel_nielsen_of_loops(const ricci_uniform *uniform, const int32_t *edges,
                                                      const size_t *starts, size_t n_loops,
                                                      const ricci_control *control, double *coordinates,
                                                      size_t capacity);

/**
 * Lengths and twists of curves of one's own that cut a hyperbolic surface into pairs of pants: the closed
 * geodesics of 3 g - 3 + b deck transformations, as of RICCI_DECK_WORDS. Without loops that cross the curves
 * a twist is known modulo half of the length; it is that between -1/4 and 1/4 of it.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_SIZE (another number of elements),
 * RICCI_LAYOUT (another surface; a curve that crosses itself or another, runs around another loop several
 * times or along the boundary, or can be contracted; two that are one), RICCI_TOO_LARGE, RICCI_NO_MEMORY,
 * RICCI_CANCELLED.
 *
 * @param deck         the elements.
 * @param control      progress and cancellation, or NULL.
 * @param coordinates  out: (3 g - 3 + b) x 2: length and twist of each curve.
 * @param capacity     entries of `coordinates`.
 */
RICCI_API ricci_status ricci_deck_pants(const ricci_deck *deck, const ricci_control *control,
                                        double *coordinates, size_t capacity);

#ifdef __cplusplus
}
#endif

#endif
