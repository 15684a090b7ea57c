/* ricci: deck transformations, universal covers, Dirichlet domains.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_uniformize(mesh, NULL, NULL, &uniform);
 *     ricci_init(&spec, sizeof spec);
 *     spec.kind = RICCI_DECK_DEPTH, spec.depth = 2, spec.limit = 1000;
 *     ricci_deck_new(uniform, &spec, NULL, &deck);           // copies of the layout in the universal cover
 *     ricci_deck_apply(deck, k, points, n, moved, 3 * n);    // copy number k
 *     ricci_dirichlet_new(uniform, NULL, NULL, &dirichlet);  // the convex domain about the base
 *
 * The conventions are those of ricci/ricci.h; points are ambient coordinates (x, y, w), n x 3, and words
 * int32_t arrays, as in ricci/uniformize.h.
 *
 * Sources, by the keys of docs/bibliography.md: words and their problem [Deh12; Sti93], products in
 * double-double precision [Dek71].
 */

#ifndef RICCI_DECK_H
#define RICCI_DECK_H

#include <ricci/ricci.h>
#include <ricci/uniformize.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Deck transformations of a quotient, each as a word in the generators and as an isometry. They act from
 * the left: M(g h) = M(g) M(h).
 *
 * Isometries are kept in double-double precision, which ricci_deck_apply uses.
 */
typedef struct ricci_deck ricci_deck;

/**
 * The Dirichlet domain of a point in the universal cover: the points that are nearer to it than to its images
 * under the deck group. A convex polygon; each side lies on the bisector of the centre and its image under
 * the side's element, which carries the domain onto its neighbour there, or on the straight boundary of the
 * surface, which the side's element moves along itself.
 */
typedef struct ricci_dirichlet ricci_dirichlet;

/** Which deck transformations. */
enum {
    /** The generators: M(g) carries the base lift to the end of the lift of g's loop. */
    RICCI_DECK_GENERATORS = 0,
    /**
     * The sides of the layout as a fundamental domain, counterclockwise: the elements that carry it onto
     * its neighbours.
     */
    RICCI_DECK_SIDES = 1,
    /** Those of the n_words words of `letters`. */
    RICCI_DECK_WORDS = 2,
    /**
     * All of at most `depth` letters, each once, shortest first, the identity to begin with: the copies of
     * a domain in a piece of the universal cover. Whether two words are the same element is decided in the
     * group, not by coordinates.
     */
    RICCI_DECK_DEPTH = 3,
    /**
     * All that move the centre of `dirichlet` by at most `radius`, each once, nearest first: a round piece
     * of the universal cover.
     */
    RICCI_DECK_WITHIN = 4,
    /** Those of the sides of `dirichlet`. */
    RICCI_DECK_DIRICHLET_SIDES = 5,
    /**
     * All closed geodesics up to length `radius`, by length: an element of each conjugacy class, of a class
     * and that of its inverses once. The search is complete: it looks at all elements whose line can meet the
     * Dirichlet domain of the base.
     */
    RICCI_DECK_GEODESICS = 6
};

/** Numbers of deck transformations. */
enum {
    /**
     * n_elements x 2 x 2 x 2: Moebius transformations z -> (a z + b)/(c z + d): a, b, c, d, each real and
     * imaginary part; in the Poincare disk matrices of SU(1, 1), up to sign; in the plane ((e^(i theta),
     * t), (0, 1)).
     */
    RICCI_DECK_MOBIUS = 0,
    /**
     * n_elements x 3 x 3: real matrices that act on (x, y, w): of SO+(2, 1) on the hyperboloid, of SE(2) in
     * the plane w = 1.
     */
    RICCI_DECK_MATRIX = 1,
    /**
     * n_elements: |trace| of the 2 x 2 matrices of determinant 1: 2 cosh(L/2) for a translation of length L
     * in the hyperbolic plane.
     */
    RICCI_DECK_TRACE = 2,
    /**
     * n_elements: the translation lengths along their axes, which are the lengths of the closed geodesics in
     * their free homotopy classes.
     */
    RICCI_DECK_LENGTH = 3,
    /** n_elements, of RICCI_DECK_GEODESICS alone: how often each runs around a shorter one on its line;
       else 1. */
    RICCI_DECK_POWER = 4
};

/** A set of deck transformations. Zeroed by ricci_init: the generators. */
typedef struct ricci_deck_spec {
    /** sizeof(ricci_deck_spec). */
    size_t size;
    /** RICCI_DECK_*. */
    uint32_t kind;
    /** 0. */
    uint32_t reserved;
    /** WORDS: n_letters letters, word after word. */
    const int32_t *letters;
    /** Number of letters of all words. */
    size_t n_letters;
    /** WORDS: n_words + 1 offsets: word i is letters[starts[i] .. starts[i + 1]). */
    const size_t *starts;
    /** Number of words. */
    size_t n_words;
    /** WITHIN, DIRICHLET_SIDES: a domain of this surface. */
    const ricci_dirichlet *dirichlet;
    /**
     * WITHIN: largest distance that the centre moves; GEODESICS: largest length. Twice the radius of the
     * domain reaches all copies that share a corner with it; a surface of genus 2 has about e^L / (2 L)
     * closed geodesics up to L.
     */
    double radius;
    /**
     * DEPTH: most letters of a word. 2 suits pictures: each letter multiplies the number of elements by up to
     * 4 g - 1 in genus g.
     */
    size_t depth;
    /**
     * DEPTH, WITHIN, GEODESICS: most elements that are looked at. 1000 suits pictures, 1,000,000 lengths up
     * to 9; more elements are RICCI_TOO_LARGE instead of a long wait.
     */
    size_t limit;
} ricci_deck_spec;

/** Figures of deck transformations. */
typedef struct ricci_deck_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** RICCI_SPACE_*: the space they act on. */
    uint32_t space;
    /** Most letters of a word. */
    uint32_t longest;
    /** Number of elements. */
    size_t n_elements;
    /** Number of letters of all words. */
    size_t n_letters;
} ricci_deck_summary;

/** Figures of a Dirichlet domain. */
typedef struct ricci_dirichlet_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** RICCI_SPACE_*: where it lies. */
    uint32_t space;
    /** Number of sides, and of corners. */
    uint32_t n_sides;
    /** Area of the polygon, from its sides and the rays to its corners: that of the surface. */
    double area;
    /** Largest distance of a corner from the centre. */
    double radius;
    /** Ambient coordinates of the centre. */
    double centre[3];
} ricci_dirichlet_summary;

/**
 * Deck transformations of a quotient.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_LAYOUT (a sphere), RICCI_ARGUMENT (kind;
 * no such letter; starts that do not ascend from 0 to n_letters; a radius that is NaN; a domain of another
 * surface), RICCI_TOO_LARGE (more than `limit`), RICCI_CANCELLED.
 *
 * @param uniform  the uniformization, of a quotient.
 * @param spec     the set of transformations; NULL for the generators.
 * @param control  cancellation; NULL for none.
 * @param deck     out: the new handle, to be released by ricci_deck_free.
 */
RICCI_API ricci_status ricci_deck_new(const ricci_uniform *uniform, const ricci_deck_spec *spec,
                                      const ricci_control *control, ricci_deck **deck);

/**
 * Release deck transformations.
 *
 * @param deck  the handle, or NULL.
 */
RICCI_API_VOID void ricci_deck_free(ricci_deck *deck);

/**
 * The figures of deck transformations.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param deck     the elements.
 * @param summary  out: the figures.
 * @param size     sizeof *summary.
 */
RICCI_API ricci_status ricci_deck_summarise(const ricci_deck *deck, ricci_deck_summary *summary, size_t size);

/**
 * The words of the elements, reduced.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param deck             the elements.
 * @param words            out: n_letters letters, word after word: k for generator k (1-based), -k for its
 *                         inverse.
 * @param words_capacity   entries of `words`.
 * @param starts           out: n_elements + 1 offsets: word i is words[starts[i] .. starts[i + 1]).
 * @param starts_capacity  entries of `starts`.
 */
RICCI_API ricci_status ricci_deck_words(const ricci_deck *deck, int32_t *words, size_t words_capacity,
                                        size_t *starts, size_t starts_capacity);

/**
 * The elements as matrices, or numbers of them.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT.
 *
 * @param deck      the elements.
 * @param which     RICCI_DECK_MOBIUS, _MATRIX, _TRACE, _LENGTH or _POWER.
 * @param values    out: the numbers, in the shape that is documented at the constant.
 * @param capacity  entries of `values`.
 */
RICCI_API ricci_status ricci_deck_values(const ricci_deck *deck, uint32_t which, double *values,
                                         size_t capacity);

/**
 * Move points by an element, computed in double-double precision: one copy of a layout in the universal
 * cover.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such element, a row is
 * not finite), RICCI_NO_MEMORY.
 *
 * @param deck      the elements.
 * @param element   the number of the element, 0-based.
 * @param points    n_points x 3, ambient coordinates: ricci_layout_points.
 * @param n_points  number of points.
 * @param moved     out: n_points x 3. May be `points`.
 * @param capacity  entries of `moved`, at least 3 n_points.
 */
RICCI_API ricci_status ricci_deck_apply(const ricci_deck *deck, size_t element, const double *points,
                                        size_t n_points, double *moved, size_t capacity);

/**
 * The Dirichlet domain of a point.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (the centre is not finite), RICCI_LAYOUT (a sphere;
 * none was found: the metric has not converged, or the centre is too far out), RICCI_CANCELLED.
 *
 * @param uniform    the uniformization, of a quotient.
 * @param centre     3 entries, ambient coordinates, of which x and y count; NULL for the origin, where the
 *                   base vertex is.
 * @param control    cancellation; NULL for none.
 * @param dirichlet  out: the new handle, to be released by ricci_dirichlet_free.
 */
RICCI_API ricci_status ricci_dirichlet_new(const ricci_uniform *uniform, const double *centre,
                                           const ricci_control *control, ricci_dirichlet **dirichlet);

/**
 * Release a Dirichlet domain.
 *
 * @param dirichlet  the handle, or NULL.
 */
RICCI_API_VOID void ricci_dirichlet_free(ricci_dirichlet *dirichlet);

/**
 * The figures of a Dirichlet domain.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param dirichlet  the domain.
 * @param summary    out: the figures.
 * @param size       sizeof *summary.
 */
RICCI_API ricci_status ricci_dirichlet_summarise(const ricci_dirichlet *dirichlet,
                                                 ricci_dirichlet_summary *summary, size_t size);

/**
 * The corners of a Dirichlet domain, counterclockwise: side k runs from corner k to the next one.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param dirichlet  the domain.
 * @param corners    out: n_sides x 3, ambient coordinates.
 * @param capacity   entries of `corners`, at least 3 n_sides.
 */
RICCI_API ricci_status ricci_dirichlet_corners(const ricci_dirichlet *dirichlet, double *corners,
                                               size_t capacity);

/**
 * The side with the inverse element, for every side.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param dirichlet  the domain.
 * @param partners   out: n_sides side numbers, 0-based.
 * @param capacity   entries of `partners`.
 */
RICCI_API ricci_status ricci_dirichlet_partners(const ricci_dirichlet *dirichlet, int32_t *partners,
                                                size_t capacity);

/**
 * The closed geodesic of an element on the given surface in its hyperbolic metric, as a closed line of points
 * on edges of the common subdivision of the given triangulation and the metric's. Of a power it is run
 * through once.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such element),
 * RICCI_LAYOUT (a surface that is not hyperbolic; the element of a loop that can be contracted),
 * RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param deck              the elements.
 * @param element           the number of one of them.
 * @param control           progress and cancellation, or NULL.
 * @param faces             out: per point a face of the given mesh; NULL with capacity 0 for their number
 * alone.
 * @param faces_capacity    entries of `faces`.
 * @param weights           out: n_points x 3, the weights of that face's corners.
 * @param weights_capacity  entries of `weights`.
 * @param n_points          out: number of points; the first one is not repeated at the end.
 */
RICCI_API ricci_status ricci_deck_geodesic(const ricci_deck *deck, size_t element,
                                           const ricci_control *control, uint32_t *faces,
                                           size_t faces_capacity, double *weights, size_t weights_capacity,
                                           size_t *n_points);

#ifdef __cplusplus
}
#endif

#endif
