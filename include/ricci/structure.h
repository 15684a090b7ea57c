/* ricci: geometric structures of surfaces, by charts and transitions.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_structure_new(mesh, RICCI_STRUCTURE_AFFINE, NULL, NULL, &structure);
 *     ricci_structure_summarise(structure, &summary, sizeof summary);  // charts, transitions, residuals
 *     ricci_structure_places(structure, face, weights, lifts, coordinates, capacity, &n);
 *     ricci_structure_carry(structure, lifts, lifts + 2, coordinates, 1, moved, 2);  // = coordinates + 2
 *
 * The conventions are those of ricci/ricci.h. The charts are pieces of the plane: of the complex plane for
 * conformal, spherical and hyperbolic structures, on which Moebius transformations act, of the Euclidean
 * plane or the Klein disk for affine and projective ones, with 3 x 3 matrices that act on (x, y, 1) up to
 * scale.
 *
 * Sources, by the keys of docs/bibliography.md: structures from the Ricci flow [JKLLG08], affine atlases
 * [GHQ06].
 */

#ifndef RICCI_STRUCTURE_H
#define RICCI_STRUCTURE_H

#include <ricci/ricci.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A geometric structure of a surface. It never changes. */
typedef struct ricci_structure ricci_structure;

/** Kinds of structures. */
enum {
    /** Any surface: Moebius transformations of the complex plane. */
    RICCI_STRUCTURE_CONFORMAL = 0,
    /** Genus 0: stereographic charts of the unit sphere, rotations. */
    RICCI_STRUCTURE_SPHERICAL = 1,
    /** Motions of the Euclidean plane; closed surfaces of genus other than 1 have singular vertices. */
    RICCI_STRUCTURE_AFFINE = 2,
    /** Negative Euler characteristic: charts in the Poincare disk. */
    RICCI_STRUCTURE_HYPERBOLIC = 3,
    /** Negative Euler characteristic: charts in the Klein disk, where geodesics are straight. */
    RICCI_STRUCTURE_PROJECTIVE = 4,
    /**
     * Any surface: the quads of a mesh are unit squares in charts, transitions turn by multiples of 90
     * degrees and move by whole numbers. The triangulation is that of the quads, two triangles each, with
     * the vertices of ricci_layout_new (or of ricci_quads_new for n_quads) and its places on the mesh.
     */
    RICCI_STRUCTURE_INTEGER = 5
};

/** What the charts are. */
enum {
    /** The star of every vertex that is not singular. */
    RICCI_CHARTS_STARS = 0,
    /** Pieces that grow until they would overlap themselves or reach too far. */
    RICCI_CHARTS_PATCHES = 1
};

/** Where an affine structure comes from. */
enum {
    /** A flow to a metric that is flat but for one vertex, or but for the boundary. */
    RICCI_AFFINE_FLOW = 0,
    /** A holomorphic 1-form of a closed surface of genus 1 or more: transitions are translations. */
    RICCI_AFFINE_FORM = 1
};

/** Lists of different lengths. */
enum {
    /** A row for each chart: its faces. One that a star meets twice is there twice. */
    RICCI_CHART_FACES = 0,
    /** A row for each chart: 3 corners for each of its faces, as places in its row of vertices, from 0. */
    RICCI_CHART_CORNERS = 1,
    /** A row for each chart: its vertices. One that is reached by different ways is there more than once. */
    RICCI_CHART_VERTICES = 2,
    /** A row for each transition: the vertices of the overlap, two entries each, as places in both charts. */
    RICCI_TRANSITION_PAIRS = 3
};

/** Lists of numbers. */
enum {
    /** n_singular vertices that no chart has inside. */
    RICCI_STRUCTURE_SINGULAR = 0,
    /** n_excluded faces of no chart. */
    RICCI_STRUCTURE_EXCLUDED = 1,
    /** n_folded charts whose faces do not lie counterclockwise beside each other. */
    RICCI_STRUCTURE_FOLDED = 2,
    /** n_zeros x 2: the nearest vertex and the multiplicity of each zero of the 1-form. */
    RICCI_STRUCTURE_ZEROS = 3,
    /** n_faces x 3: the vertices of the triangulation, of which the first ones are those of the mesh. */
    RICCI_STRUCTURE_TRIANGLES = 4
};

/** What ricci_structure_new can be asked; zeros are the defaults. */
typedef struct ricci_structure_options {
    /** sizeof(ricci_structure_options), by ricci_init. */
    size_t size;
    /** Of the flow; NULL: its defaults. The defaults suit all but studies of the flow. */
    const ricci_flow_options *flow;
    /**
     * The singular vertex of an affine structure by the flow; NULL: where areas are distorted least. NULL
     * suits splines.
     */
    const uint32_t *singular;
    /**
     * How far a patch reaches in the sphere or the hyperbolic plane; 0: by the size of the triangles. 0 gives
     * few charts whose coordinates keep their digits.
     */
    double radius;
    /**
     * RICCI_CHARTS_... Stars suit checks of the structure, patches files for other programs, since there are
     * far fewer.
     */
    uint32_t charts;
    /** RICCI_AFFINE_... The 1-form suits translations alone, at the price of several zeros. */
    uint32_t source;
    /**
     * The number of quads of an integer structure, about; 0: those of the layout with as few patches as are
     * found. 0 suits splines and analysis, a number a grid of one size.
     */
    size_t n_quads;
} ricci_structure_options;

/** Figures of a structure. */
typedef struct ricci_structure_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** RICCI_STRUCTURE_... */
    uint32_t kind;
    /** RICCI_SPACE_..., of which the charts are pieces. */
    uint32_t space;
    /** 1 if the flow came to its target. */
    uint32_t converged;
    /**
     * Numbers of a matrix: 8, real and imaginary parts of [[a, b], [c, d]] of z -> (a z + b) / (c z + d); or
     * 9, by rows.
     */
    uint32_t n_matrix;
    /** Number of vertices of the triangulation. */
    size_t n_vertices;
    /** Number of its faces. */
    size_t n_faces;
    /** Number of charts. */
    size_t n_charts;
    /** Number of transitions: one for each connected overlap of two charts. */
    size_t n_transitions;
    /** Number of generators of the fundamental group: 2 g + b. */
    size_t n_generators;
    /** Number of singular vertices. */
    size_t n_singular;
    /** Number of faces of no chart. */
    size_t n_excluded;
    /** Number of zeros of the 1-form. */
    size_t n_zeros;
    /** Number of charts that are folded. */
    size_t n_folded;
    /** How many overlaps of three charts were composed. */
    size_t n_triples;
    /** Largest distance between the image of a shared vertex and its place, over the size of the chart. */
    double transition_residual;
    /** How far transitions around overlaps of three charts are from the identity, at most. */
    double cocycle_residual;
    /**
     * How far the relation of the group is from the identity, over its partial products; 0 for an integer
     * structure with singular vertices, around which it turns: there is no relation then.
     */
    double relation_residual;
    /** Largest |K| at a vertex that is not singular, radians. */
    double max_curvature_error;
} ricci_structure_summary;

/**
 * A structure of a surface.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (a structure that the surface has
 *         not, options that do not belong to it), RICCI_LAYOUT (no regular vertex), RICCI_EDGE_LENGTH,
 *         RICCI_TRIANGLE_INEQUALITY, RICCI_FACTORISATION, RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param mesh       the surface.
 * @param kind       RICCI_STRUCTURE_...
 * @param options    charts, source and singular vertex, or NULL.
 * @param control    progress and cancellation, or NULL.
 * @param structure  out: the new handle, to be released by ricci_structure_free.
 */
RICCI_API ricci_status ricci_structure_new(const ricci_mesh *mesh, uint32_t kind,
                                           const ricci_structure_options *options,
                                           const ricci_control *control, ricci_structure **structure);

/**
 * Release a structure.
 *
 * @param structure  the handle, or NULL.
 */
RICCI_API_VOID void ricci_structure_free(ricci_structure *structure);

/**
 * The figures of a structure.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param structure  the structure.
 * @param summary    out: the figures.
 * @param size       sizeof *summary.
 */
RICCI_API ricci_status ricci_structure_summarise(const ricci_structure *structure,
                                                 ricci_structure_summary *summary, size_t size);

/**
 * Faces, corners and vertices of the charts, or shared vertices of the transitions.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such lists).
 *
 * @param structure        the structure.
 * @param which            RICCI_CHART_FACES, RICCI_CHART_CORNERS, RICCI_CHART_VERTICES or
 *                         RICCI_TRANSITION_PAIRS.
 * @param entries          out: row after row.
 * @param capacity         entries of `entries`.
 * @param starts           out: offsets, one more than rows: row i is entries[starts[i] .. starts[i + 1]).
 * @param starts_capacity  entries of `starts`.
 */
RICCI_API ricci_status ricci_structure_rows(const ricci_structure *structure, uint32_t which,
                                            uint32_t *entries, size_t capacity, size_t *starts,
                                            size_t starts_capacity);

/**
 * The coordinates of the vertices of a chart.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such chart).
 *
 * @param structure    the structure.
 * @param chart        the chart, below n_charts.
 * @param coordinates  out: x and y of each vertex, in the order of its row of RICCI_CHART_VERTICES.
 * @param capacity     entries of `coordinates`.
 */
RICCI_API ricci_status ricci_structure_coordinates(const ricci_structure *structure, size_t chart,
                                                   double *coordinates, size_t capacity);

/**
 * The transitions: which charts they join, and their matrices.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param structure          the structure.
 * @param charts             out: n_transitions x 2: from which chart to which.
 * @param charts_capacity    entries of `charts`.
 * @param matrices           out: n_transitions x n_matrix.
 * @param matrices_capacity  entries of `matrices`.
 */
RICCI_API ricci_status ricci_structure_transitions(const ricci_structure *structure, uint32_t *charts,
                                                   size_t charts_capacity, double *matrices,
                                                   size_t matrices_capacity);

/**
 * The holonomy: the matrix of every generator a1, b1, ..., ag, bg, c1, ..., cb of the fundamental group.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param structure  the structure.
 * @param matrices   out: n_generators x n_matrix.
 * @param capacity   entries of `matrices`.
 */
RICCI_API ricci_status ricci_structure_holonomy(const ricci_structure *structure, double *matrices,
                                                size_t capacity);

/**
 * Singular vertices, excluded faces, folded charts, zeros, or the triangulation.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such list).
 *
 * @param structure  the structure.
 * @param which      RICCI_STRUCTURE_SINGULAR, _EXCLUDED, _FOLDED, _ZEROS or _TRIANGLES.
 * @param numbers    out: the list.
 * @param capacity   entries of `numbers`.
 */
RICCI_API ricci_status ricci_structure_list(const ricci_structure *structure, uint32_t which,
                                            uint32_t *numbers, size_t capacity);

/**
 * All charts that contain a point.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such face; weights that
 * are negative, or without a positive sum).
 *
 * @param structure    the structure.
 * @param face         a face of the triangulation.
 * @param weights      3 weights of its corners.
 * @param lifts        out: n_places x 2: the chart, and the place of the face in its row of faces; NULL, with
 *                     NULL and capacity 0, for their number alone.
 * @param coordinates  out: n_places x 2: the point's coordinates in the chart.
 * @param capacity     places for which there is room in `lifts` and `coordinates`.
 * @param n_places     out: number of places.
 */
RICCI_API ricci_status ricci_structure_places(const ricci_structure *structure, uint32_t face,
                                              const double *weights, uint32_t *lifts, double *coordinates,
                                              size_t capacity, size_t *n_places);

/**
 * Points of a chart in the coordinates of another one that overlaps it.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (lifts of different faces).
 *
 * @param structure  the structure.
 * @param from       2 entries of `lifts` of ricci_structure_places: where a face lies in the one chart.
 * @param to         the same of the other chart.
 * @param points     coordinates in the one chart, n x 2.
 * @param n          number of points.
 * @param moved      out: coordinates in the other chart, n x 2.
 * @param capacity   entries of `moved`.
 */
RICCI_API ricci_status ricci_structure_carry(const ricci_structure *structure, const uint32_t *from,
                                             const uint32_t *to, const double *points, size_t n,
                                             double *moved, size_t capacity);

#ifdef __cplusplus
}
#endif

#endif
