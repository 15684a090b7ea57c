/* ricci: fundamental groups of surfaces, words in their generators, and fundamental domains.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_homotopy_new(mesh, NULL, NULL, &homotopy);       // loops through one vertex
 *     ricci_homotopy_path_word(homotopy, path, n_path, word, capacity, &n_word);
 *     ricci_homotopy_homology(homotopy, word, n_word, sums, n_generators);
 *
 * The conventions are those of ricci/ricci.h. A word is an int32_t array of 1-based generator numbers,
 * negative for inverses.
 *
 * Sources, by the keys of docs/bibliography.md: shortest loops [EW05], words [Deh12; LPVV01], normal forms
 * [Bra21; Sti93].
 */

#ifndef RICCI_HOMOTOPY_H
#define RICCI_HOMOTOPY_H

#include <ricci/ricci.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Generators of the fundamental group of a surface: loops a1, b1, ..., ag, bg, c1, ..., cb through one base
 * vertex with the one relation a1 b1 a1^-1 b1^-1 ... ag bg ag^-1 bg^-1 c1 ... cb = 1, as a word 1, 2, -1,
 * -2, 3, 4, -3, -4, ..., 2 g + 1, ..., 2 g + b.
 *
 * Generators are numbered from 1 in this order, and a word is an array of letters: k for generator k, -k
 * for its inverse, from left to right as paths are run. b_i crosses a_i once, from right to left; c_j goes
 * around a boundary loop with the surface on its left.
 */
typedef struct ricci_homotopy ricci_homotopy;

/**
 * A surface opened along a cut into a disk, lifted to the universal cover: a polygon whose sides are paired
 * by deck transformations.
 */
typedef struct ricci_domain ricci_domain;

/* ---------------------------------------------------------------------------------------------------------
 * Homotopy bases, words and fundamental domains
 */

/** Figures of a homotopy basis. */
typedef struct ricci_homotopy_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** The base vertex. */
    size_t base;
    /** g. */
    size_t genus;
    /** b. */
    size_t n_boundary_loops;
    /** 2 g + b. */
    size_t n_generators;
    /** Letters of the relation, 4 g + b. */
    size_t n_relator;
    /** Number of edges of all loops. */
    size_t n_loop_edges;
} ricci_homotopy_summary;

/** The lift of an edge path. Zeroed by ricci_init. */
typedef struct ricci_lift {
    /** sizeof(ricci_lift). */
    size_t size;
    /** n_element letters: the deck transformation of the lift that it starts at. */
    const int32_t *element;
    /** Number of letters, 0 for the identity. */
    size_t n_element;
    /** n_path edges: 1-based, negative where the path runs against the edge's direction. */
    const int32_t *path;
    /** Number of edges. */
    size_t n_path;
    /** The vertex where the path starts. */
    uint32_t vertex;
    /** 0. */
    uint32_t reserved;
} ricci_lift;

/** Figures of a fundamental domain. */
typedef struct ricci_domain_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Number of sides, and of corners. */
    size_t n_sides;
    /** Number of edges of all sides. */
    size_t n_side_edges;
    /** Number of letters of all sides' words. */
    size_t n_side_letters;
    /** Number of letters of all corners' words. */
    size_t n_corner_letters;
    /** A half-edge of a face of the domain that starts at the base lift, as a signed edge number. */
    int64_t base_edge;
} ricci_domain_summary;

/**
 * A canonical homotopy basis of a mesh, with short loops. The surface may have boundary.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (no such vertex), RICCI_EDGE_LENGTH,
 * RICCI_CANCELLED.
 *
 * @param mesh      the mesh; loops are short in its lengths.
 * @param base      the base vertex; NULL for one from which the loops are short.
 * @param control   progress and cancellation; NULL for neither.
 * @param homotopy  out: the new handle, to be released by ricci_homotopy_free.
 */
RICCI_API ricci_status ricci_homotopy_new(const ricci_mesh *mesh, const uint32_t *base,
                                          const ricci_control *control, ricci_homotopy **homotopy);

/**
 * Release a homotopy basis.
 *
 * @param homotopy  the handle, or NULL.
 */
RICCI_API_VOID void ricci_homotopy_free(ricci_homotopy *homotopy);

/**
 * The figures of a homotopy basis.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param homotopy  the basis.
 * @param summary   out: the figures.
 * @param size      sizeof *summary.
 */
RICCI_API ricci_status ricci_homotopy_summarise(const ricci_homotopy *homotopy,
                                                ricci_homotopy_summary *summary, size_t size);

/**
 * The edges of every generator's loop, in order, from the base to the base.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param homotopy         the basis.
 * @param edges            out: n_loop_edges edge numbers, 1-based, negative where the loop runs against the
 *                         edge's direction; loop after loop.
 * @param edges_capacity   entries of `edges`.
 * @param starts           out: n_generators + 1 offsets: loop i is edges[starts[i] .. starts[i + 1]).
 * @param starts_capacity  entries of `starts`.
 */
RICCI_API ricci_status ricci_homotopy_loops(const ricci_homotopy *homotopy, int32_t *edges,
                                            size_t edges_capacity, size_t *starts, size_t starts_capacity);

/**
 * The intersection numbers of the generators' loops, measured on the mesh: in row i and column j how often
 * loop j crosses loop i from right to left, minus how often from left to right. a_i and b_i have 1, b_i and
 * a_i -1, all others 0.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param homotopy  the basis.
 * @param matrix    out: n_generators x n_generators.
 * @param capacity  entries of `matrix`.
 */
RICCI_API ricci_status ricci_homotopy_intersections(const ricci_homotopy *homotopy, int64_t *matrix,
                                                    size_t capacity);

/**
 * The tree path from the base to a vertex, along which lifts are named (ricci_homotopy_lift).
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such vertex).
 *
 * @param homotopy  the basis.
 * @param vertex    where the path ends.
 * @param edges     out: its edges, 1-based, negative against the edge's direction; NULL with capacity 0 to
 *                  ask for their number.
 * @param capacity  entries of `edges`.
 * @param n_edges   out: number of edges.
 */
RICCI_API ricci_status ricci_homotopy_tree_path(const ricci_homotopy *homotopy, uint32_t vertex,
                                                int32_t *edges, size_t capacity, size_t *n_edges);

/**
 * The element of an edge path: of the loop along the tree to its start, along the path, and back from its
 * end; for a loop at the base, of the loop itself. Reduced: empty if and only if the loop can be
 * contracted.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such edges, or they do
 * not follow each other).
 *
 * @param homotopy   the basis.
 * @param path       n_path edges: 1-based, negative where the path runs against the edge's direction.
 * @param n_path     number of edges.
 * @param letters    out: the word; NULL with capacity 0 to ask for its length.
 * @param capacity   entries of `letters`.
 * @param n_letters  out: number of letters.
 */
RICCI_API ricci_status ricci_homotopy_path_word(const ricci_homotopy *homotopy, const int32_t *path,
                                                size_t n_path, int32_t *letters, size_t capacity,
                                                size_t *n_letters);

/**
 * A shorter word of the same element, empty if and only if it is the identity. So u and v are one element
 * if and only if u v^-1 becomes empty.
 *
 * On a torus a1^p b1^q, with boundary a freely reduced word without the last c: equal elements, equal
 * words. On closed surfaces of genus 2 and more (Dehn's algorithm) equal elements may keep different words.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such letter).
 *
 * @param homotopy   the basis.
 * @param word       n_word letters: k for generator k (1-based), -k for its inverse.
 * @param n_word     number of letters.
 * @param letters    out: the reduced word; NULL with capacity 0 to ask for its length.
 * @param capacity   entries of `letters`.
 * @param n_letters  out: number of letters.
 */
RICCI_API ricci_status ricci_homotopy_reduce(const ricci_homotopy *homotopy, const int32_t *word,
                                             size_t n_word, int32_t *letters, size_t capacity,
                                             size_t *n_letters);

/**
 * The homology class of a word: the sum of each generator's exponents; with boundary the last c counts as
 * minus the sum of the others.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such letter).
 *
 * @param homotopy  the basis.
 * @param word      n_word letters.
 * @param n_word    number of letters.
 * @param sums      out: n_generators sums, one less with boundary.
 * @param capacity  entries of `sums`.
 */
RICCI_API ricci_status ricci_homotopy_homology(const ricci_homotopy *homotopy, const int32_t *word,
                                               size_t n_word, int64_t *sums, size_t capacity);

/**
 * A word as text, `a1 b1 a1^-1`; the empty word is `1`. A word of one letter gives the generator's name.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such letter).
 *
 * @param homotopy  the basis.
 * @param word      n_word letters; they are reduced freely.
 * @param n_word    number of letters.
 * @param text      out: the text, NUL-terminated; NULL with capacity 0 to ask for its length.
 * @param capacity  bytes of `text`.
 * @param n_bytes   out: number of bytes with the NUL.
 */
RICCI_API ricci_status ricci_homotopy_word_text(const ricci_homotopy *homotopy, const int32_t *word,
                                                size_t n_word, char *text, size_t capacity, size_t *n_bytes);

/**
 * The word of a text like `a1 b1 a1^-1`, freely reduced; `1` stands for the identity.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (what is no letter).
 *
 * @param homotopy   the basis.
 * @param word       the text, NUL-terminated UTF-8.
 * @param letters    out: the word; NULL with capacity 0 to ask for its length.
 * @param capacity   entries of `letters`.
 * @param n_letters  out: number of letters.
 */
RICCI_API ricci_status ricci_homotopy_word_parse(const ricci_homotopy *homotopy, const char *word,
                                                 int32_t *letters, size_t capacity, size_t *n_letters);

/**
 * The lift of an edge path to the universal cover, vertex by vertex: the start, then the end of each edge.
 *
 * The lift (v, w) of vertex v is where the deck transformation w carries the end of the lifted tree path to
 * v. A loop's lift closes if and only if the loop can be contracted; that of a loop at the base, from
 * (base, 1), ends at (base, its word). Words are reduced.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such
 * vertex, letters or edges; the path does not start there).
 *
 * @param homotopy         the basis.
 * @param lift             where it starts, and the path.
 * @param words            out: the words of the n_path + 1 lifts, one after the other; NULL with capacity 0
 *                         to ask for `starts`.
 * @param words_capacity   entries of `words`.
 * @param starts           out: n_path + 2 offsets: word i is words[starts[i] .. starts[i + 1]).
 * @param starts_capacity  entries of `starts`.
 */
RICCI_API ricci_status ricci_homotopy_lift(const ricci_homotopy *homotopy, const ricci_lift *lift,
                                           int32_t *words, size_t words_capacity, size_t *starts,
                                           size_t starts_capacity);

/**
 * The fundamental domain of a cut, one of those that have a corner at the base lift.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (no such edge), RICCI_LAYOUT (the cut does not leave
 * a disk).
 *
 * @param homotopy  names lifts and deck transformations.
 * @param cut       n_cut edges, 0-based, that open the surface into a disk; NULL for those of the basis's
 *                  own polygon.
 * @param n_cut     number of edges.
 * @param domain    out: the new handle, to be released by ricci_domain_free.
 */
RICCI_API ricci_status ricci_domain_new(const ricci_homotopy *homotopy, const uint32_t *cut, size_t n_cut,
                                        ricci_domain **domain);

/**
 * Release a fundamental domain.
 *
 * @param domain  the handle, or NULL.
 */
RICCI_API_VOID void ricci_domain_free(ricci_domain *domain);

/**
 * The figures of a fundamental domain.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param domain   the domain.
 * @param summary  out: the figures.
 * @param size     sizeof *summary.
 */
RICCI_API ricci_status ricci_domain_summarise(const ricci_domain *domain, ricci_domain_summary *summary,
                                              size_t size);

/**
 * The edges of every side, counterclockwise: the domain lies on their left.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param domain           the domain.
 * @param edges            out: n_side_edges edge numbers, 1-based, negative against the edge's direction;
 *                         side after side.
 * @param edges_capacity   entries of `edges`.
 * @param starts           out: n_sides + 1 offsets: side i is edges[starts[i] .. starts[i + 1]).
 * @param starts_capacity  entries of `starts`.
 */
RICCI_API ricci_status ricci_domain_sides(const ricci_domain *domain, int32_t *edges, size_t edges_capacity,
                                          size_t *starts, size_t starts_capacity);

/**
 * The side with the same edges, run through the other way.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param domain    the domain.
 * @param partners  out: n_sides side numbers, 0-based; -1 on the boundary of the surface.
 * @param capacity  entries of `partners`.
 */
RICCI_API ricci_status ricci_domain_partners(const ricci_domain *domain, int32_t *partners, size_t capacity);

/**
 * The deck transformation of every side: it carries the side's partner onto it, and the domain onto its
 * neighbour there.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param domain           the domain.
 * @param words            out: n_side_letters letters, word after word; the partner's element is the
 *                         inverse.
 * @param words_capacity   entries of `words`.
 * @param starts           out: n_sides + 1 offsets: the word of side i is words[starts[i] .. starts[i +
 *                         1]).
 * @param starts_capacity  entries of `starts`.
 */
RICCI_API ricci_status ricci_domain_elements(const ricci_domain *domain, int32_t *words,
                                             size_t words_capacity, size_t *starts, size_t starts_capacity);

/**
 * The lifts at which the sides start (ricci_homotopy_lift): vertices and deck transformations.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param domain             the domain.
 * @param vertices           out: n_sides vertices.
 * @param vertices_capacity  entries of `vertices`.
 * @param words              out: n_corner_letters letters, word after word.
 * @param words_capacity     entries of `words`.
 * @param starts             out: n_sides + 1 offsets: the word of corner i is words[starts[i] .. starts[i +
 *                           1]).
 * @param starts_capacity    entries of `starts`.
 */
RICCI_API ricci_status ricci_domain_corners(const ricci_domain *domain, uint32_t *vertices,
                                            size_t vertices_capacity, int32_t *words, size_t words_capacity,
                                            size_t *starts, size_t starts_capacity);

#ifdef __cplusplus
}
#endif

#endif
