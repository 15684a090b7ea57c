/* ricci: layouts on the faces of the mesh, and in charts.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_repaired_input_new(layout, NULL, &repaired);     // no face of the mesh turned over
 *     ricci_repaired_input_write(repaired, "flat.obj");
 *     ricci_charts_new(layout, 0.01, NULL, &charts);           // charts that do not overlap, packed
 *     ricci_charts_write(charts, 0, "charts.obj");
 *
 * The conventions are those of ricci/ricci.h.
 *
 * Sources, by the keys of docs/bibliography.md: packing [Jyl10].
 */

#ifndef RICCI_CHARTS_H
#define RICCI_CHARTS_H

#include <ricci/ricci.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * A layout on the faces of the mesh, with the fewest edges of the mesh split that let the map be linear on
 * each face without turning any over.
 *
 * The added vertices lie on edges of the mesh, so the surface stays as it is. The first vertices are those
 * of the mesh; the triangles of a face of the mesh follow one another.
 */
typedef struct ricci_repaired_input ricci_repaired_input;

/** A layout in charts that do not overlap, packed into the unit square. */
typedef struct ricci_charts ricci_charts;

/* ---------------------------------------------------------------------------------------------------------
 * Repaired inputs
 */

/** Figures of a repaired input. */
typedef struct ricci_repaired_input_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** V: those of the mesh, then the added ones. */
    size_t n_vertices;
    /** E. */
    size_t n_edges;
    /** F. */
    size_t n_faces;
    /** V of the mesh. */
    size_t n_input_vertices;
    /** Number of edges of the mesh that were split. */
    size_t n_split_edges;
    /** Number of points: vertices count once per piece of their star between cuts. */
    size_t n_points;
    /** Faces that are not counterclockwise, by exact arithmetic. */
    size_t n_flipped;
    /** Faces without area on either side; the distortions below leave them out. */
    size_t n_degenerate;
    /** Quasi-conformal dilatation of the linear maps of the faces: mean over the area of the mesh. */
    double qc_mean;
    /** Largest quasi-conformal dilatation. */
    double qc_max;
    /** Smallest area distortion: share of the layout's area over share of the mesh's. */
    double area_ratio_min;
    /** Largest area distortion. */
    double area_ratio_max;
} ricci_repaired_input_summary;

/**
 * Split the fewest edges of the mesh so that no face folds in a layout.
 *
 * Every split is needed: without any one of them a face would fold. If no face folds, none is split.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_LAYOUT (as of ricci_layout_corners), RICCI_NO_MEMORY,
 * RICCI_CANCELLED.
 *
 * @param layout    the layout.
 * @param control   progress and cancellation; NULL for neither.
 * @param repaired  out: the new handle, to be released by ricci_repaired_input_free.
 */
RICCI_API ricci_status ricci_repaired_input_new(const ricci_layout *layout, const ricci_control *control,
                                                ricci_repaired_input **repaired);

/**
 * Release a repaired input.
 *
 * @param repaired  the handle, or NULL.
 */
RICCI_API_VOID void ricci_repaired_input_free(ricci_repaired_input *repaired);

/**
 * The figures of a repaired input.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param repaired  the repaired input.
 * @param summary   out: the figures.
 * @param size      sizeof *summary.
 */
RICCI_API ricci_status ricci_repaired_input_summarise(const ricci_repaired_input *repaired,
                                                      ricci_repaired_input_summary *summary, size_t size);

/**
 * The mesh with its edges split.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (an intrinsic mesh).
 *
 * @param repaired  the repaired input.
 * @param mesh      out: the new handle, to be released by ricci_mesh_free.
 */
RICCI_API ricci_status ricci_repaired_input_mesh(const ricci_repaired_input *repaired, ricci_mesh **mesh);

/**
 * The face of the mesh in which every face lies.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param repaired  the repaired input.
 * @param faces     out: n_faces face indices, ascending.
 * @param capacity  entries of `faces`.
 */
RICCI_API ricci_status ricci_repaired_input_faces(const ricci_repaired_input *repaired, uint32_t *faces,
                                                  size_t capacity);

/**
 * The barycentric coordinates of the corners of every face in its face of the mesh.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param repaired  the repaired input.
 * @param weights   out: n_faces x 3 x 3, corner by corner.
 * @param capacity  entries of `weights`.
 */
RICCI_API ricci_status ricci_repaired_input_barycentric(const ricci_repaired_input *repaired, double *weights,
                                                        size_t capacity);

/**
 * The edges of the mesh that were split.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param repaired  the repaired input.
 * @param edges     out: n_split_edges edge indices, ascending.
 * @param capacity  entries of `edges`.
 */
RICCI_API ricci_status ricci_repaired_input_split_edges(const ricci_repaired_input *repaired, uint32_t *edges,
                                                        size_t capacity);

/**
 * The points of the opened mesh, in the layout's model.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param repaired  the repaired input.
 * @param points    out: n_points x 2.
 * @param capacity  entries of `points`.
 */
RICCI_API ricci_status ricci_repaired_input_points(const ricci_repaired_input *repaired, double *points,
                                                   size_t capacity);

/**
 * The point of every corner of every face.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param repaired  the repaired input.
 * @param corners   out: n_faces x 3 indices of points.
 * @param capacity  entries of `corners`.
 */
RICCI_API ricci_status ricci_repaired_input_corners(const ricci_repaired_input *repaired, uint32_t *corners,
                                                    size_t capacity);

/**
 * Write the mesh with its edges split and the layout as texture coordinates, in the format of the file's
 * extension, as ricci_layout_write does.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (an intrinsic mesh; what the format has no place for),
 * RICCI_IO, RICCI_UNKNOWN_FORMAT.
 *
 * @param repaired  the repaired input.
 * @param path      the file, UTF-8, ending in .obj, .off, .ply or .glb.
 */
RICCI_API ricci_status ricci_repaired_input_write(const ricci_repaired_input *repaired, const char *path);

/* ---------------------------------------------------------------------------------------------------------
 * Charts
 */

/** Figures of the charts of a layout. */
typedef struct ricci_charts_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Number of charts. */
    size_t n_charts;
    /** F of the layout's mesh. */
    size_t n_faces;
    /** Number of points in the unit square. */
    size_t n_points;
    /** Faces that are clockwise by more than rounding, each a chart of its own. */
    size_t n_flipped;
    /**
     * Faces without area beyond rounding, in the layout or in the unit square; they lie in the charts of
     * their neighbours, and are exempt from the guarantee that no faces overlap.
     */
    size_t n_degenerate;
    /** Lengths in the unit square over lengths in the layout, the same for all charts. */
    double scale;
    /** Share of the unit square that is covered. */
    double efficiency;
    /** Total length of the layout's seams, in its units. */
    double layout_seams;
    /** Total length of the charts' seams, in units of the layout. */
    double chart_seams;
} ricci_charts_summary;

/**
 * Cut a layout into charts and pack them into the unit square.
 *
 * Every chart is connected, and no two faces overlap (decided exactly, in the layout's coordinates and in
 * those of the charts), save degenerate ones. Charts are turned and moved, and all scaled by one factor. An
 * injective layout is one chart. Deterministic.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (margin), RICCI_LAYOUT (no area), RICCI_CANCELLED.
 *
 * @param layout   the layout.
 * @param margin   least distance of two charts, in sides of the unit square, from 0 to below 1; 1/256 is
 *                 usual.
 * @param control  progress and cancellation; NULL for neither.
 * @param packed   out: the new handle, to be released by ricci_charts_free.
 */
RICCI_API ricci_status ricci_charts_new(const ricci_layout *layout, double margin,
                                        const ricci_control *control, ricci_charts **packed);

/**
 * Release charts.
 *
 * @param packed  the handle, or NULL.
 */
RICCI_API_VOID void ricci_charts_free(ricci_charts *packed);

/**
 * The figures of charts.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param packed    the charts.
 * @param summary  out: the figures.
 * @param size     sizeof *summary.
 */
RICCI_API ricci_status ricci_charts_summarise(const ricci_charts *packed, ricci_charts_summary *summary,
                                              size_t size);

/**
 * The chart of every face of the layout's mesh, from 0; charts with more area come first.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param packed     the charts.
 * @param charts    out: n_faces chart numbers.
 * @param capacity  entries of `charts`.
 */
RICCI_API ricci_status ricci_charts_faces(const ricci_charts *packed, uint32_t *charts, size_t capacity);

/**
 * The points of the charts, in the unit square.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param packed     the charts.
 * @param points    out: n_points x 2, from 0 to 1.
 * @param capacity  entries of `points`, at least 2 n_points.
 */
RICCI_API ricci_status ricci_charts_points(const ricci_charts *packed, double *points, size_t capacity);

/**
 * The point of every corner of every face of the layout's mesh: as OBJ's `vt` indices, but 0-based.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param packed     the charts.
 * @param corners   out: n_faces x 3 indices of points.
 * @param capacity  entries of `corners`, at least 3 n_faces.
 */
RICCI_API ricci_status ricci_charts_corners(const ricci_charts *packed, uint32_t *corners, size_t capacity);

/**
 * The motions from the layout to the charts: the motion of chart k carries the layout's points, times `scale`
 * of the summary, to those of the chart, z -> exp(i rotation) z + translation. The inverse of the motion of
 * chart j, followed by the motion of chart k, leads from chart j to chart k.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param packed     the charts.
 * @param motions   out: n_charts x 3: rotation (radians), translation x, y.
 * @param capacity  entries of `motions`, at least 3 n_charts.
 */
RICCI_API ricci_status ricci_charts_motions(const ricci_charts *packed, double *motions, size_t capacity);

/**
 * Write the layout's mesh with its charts as texture coordinates, in the format of the file's extension, as
 * ricci_layout_write does.
 *
 * A file of that name is replaced only once the new one is complete.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_IO, RICCI_UNKNOWN_FORMAT, RICCI_ARGUMENT (the mesh is
 * intrinsic; what the format has no place for), RICCI_DOMAIN, RICCI_LAYOUT (homogeneous charts of a layout
 * that is not in E2).
 *
 * @param packed        the charts.
 * @param homogeneous  1: `vt qx qy q` with the q of ricci_map_weights; 0: `vt x y`.
 * @param path         file name in UTF-8, ending in .obj, .off, .ply or .glb.
 */
RICCI_API ricci_status ricci_charts_write(const ricci_charts *packed, uint32_t homogeneous, const char *path);

#ifdef __cplusplus
}
#endif

#endif
