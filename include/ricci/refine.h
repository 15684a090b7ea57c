/* ricci: refined surfaces: smaller triangles of a list, and metrics without small angles.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_init(&options, sizeof options);
 *     options.longest_edge = 0.01;
 *     ricci_soup_refine(soup, &options, &refined);                    // the same surface in space
 *     ricci_mesh_refine_angle(mesh, NULL, NULL, NULL, 0, &intrinsic); // no angle below 25 degrees
 *
 * The conventions are those of ricci/ricci.h.
 *
 * Sources, by the keys of docs/bibliography.md: Delaunay refinement [Rup95], of intrinsic triangulations
 * [SSC19].
 */

#ifndef RICCI_REFINE_H
#define RICCI_REFINE_H

#include <ricci/repair.h>
#include <ricci/ricci.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How far to refine. Zeroed by ricci_init: nothing is refined in space, metrics to 25 degrees. */
typedef struct ricci_refine_options {
    /** sizeof(ricci_refine_options). */
    size_t size;
    /**
     * Of a triangle list: the number of times that every face is cut into four. 1 halves the edges, and makes
     * four times as many faces.
     */
    size_t levels;
    /**
     * Of a triangle list: the length above which no edge is left; 0: any. It suits values at vertices, which
     * need a resolution.
     */
    double longest_edge;
    /**
     * Of a metric: the least angle of its triangles, radians, at most 30 degrees; 0: 25 degrees. Larger ones
     * need more vertices.
     */
    double least_angle;
    /**
     * Of a metric: the most vertices that are added; 0: ten per face and 100000. It is a limit of time and
     * memory.
     */
    size_t most_added;
} ricci_refine_options;

/** The course of a refinement of a metric. */
typedef struct ricci_refine_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Vertices that were added inside the surface. */
    size_t n_inside;
    /** Vertices that were added on the boundary. */
    size_t n_on_boundary;
    /** Edges that were flipped. */
    size_t n_flips;
    /** Triangles with a smaller angle than asked for: 0 unless the most vertices were added. */
    size_t n_below;
    /** Triangles whose smaller angle the surface forces, at corners where it has an angle below 60 degrees.
     */
    size_t n_forced;
    /** The smallest angle of the given triangles, radians. */
    double given_angle;
    /** The smallest angle of the triangles where the surface forces none, radians. */
    double least_angle;
} ricci_refine_summary;

/**
 * The same surface in smaller triangles: edges are halved at their midpoints, every face is cut by straight
 * lines. The given vertices come first and keep their numbers; attributes are interpolated. The list may have
 * defects, but no face that uses a vertex twice.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (a result of more than 67 million
 *         faces, too), RICCI_NO_MEMORY, RICCI_CANCELLED (the control of the thread).
 *
 * @param soup     the triangle list.
 * @param options  levels and longest_edge, or NULL.
 * @param refined  out: the new handle, to be released by ricci_soup_free.
 */
RICCI_API ricci_status ricci_soup_refine(const ricci_soup *soup, const ricci_refine_options *options,
                                         ricci_soup **refined);

/**
 * Where the elements of a refined list lie in the list that it was made from.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (the list was not refined).
 *
 * @param refined                the refined list.
 * @param faces                  out: for each face the given face that it is a part of.
 * @param faces_capacity         entries of `faces`.
 * @param vertex_faces           out: for each vertex a given face that contains it; UINT32_MAX for a vertex
 *                               that no face uses.
 * @param vertex_faces_capacity  entries of `vertex_faces`.
 * @param weights                out: for each vertex its three barycentric coordinates there.
 * @param weights_capacity       entries of `weights`.
 */
RICCI_API ricci_status ricci_soup_places(const ricci_soup *refined, uint32_t *faces, size_t faces_capacity,
                                         uint32_t *vertex_faces, size_t vertex_faces_capacity,
                                         double *weights, size_t weights_capacity);

/**
 * The same Euclidean metric on a Delaunay triangulation without small angles: an intrinsic mesh, whose first
 * vertices are the given ones.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (an angle above 30 degrees, lengths
 *         of another geometry), RICCI_EDGE_LENGTH, RICCI_CONNECTIVITY, RICCI_TOO_LARGE, RICCI_NO_MEMORY,
 *         RICCI_CANCELLED.
 *
 * @param mesh     the surface.
 * @param options  least_angle and most_added, or NULL.
 * @param control  progress and cancellation, or NULL.
 * @param summary  out: the course, or NULL.
 * @param size     sizeof *summary.
 * @param refined  out: the new handle, to be released by ricci_mesh_free.
 */
RICCI_API ricci_status ricci_mesh_refine_angle(const ricci_mesh *mesh, const ricci_refine_options *options,
                                               const ricci_control *control, ricci_refine_summary *summary,
                                               size_t size, ricci_mesh **refined);

/**
 * Where the vertices of a refined metric lie on the surface that it was made from. Edges between them are
 * geodesics of that surface, which may cross any of its faces.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (not a mesh of
 *         ricci_mesh_refine_angle).
 *
 * @param refined           the refined metric.
 * @param faces             out: for each vertex a given face that contains it.
 * @param faces_capacity    entries of `faces`.
 * @param weights           out: for each vertex its three barycentric coordinates there, none negative.
 * @param weights_capacity  entries of `weights`.
 */
RICCI_API ricci_status ricci_mesh_places(const ricci_mesh *refined, uint32_t *faces, size_t faces_capacity,
                                         double *weights, size_t weights_capacity);

#ifdef __cplusplus
}
#endif

#endif
