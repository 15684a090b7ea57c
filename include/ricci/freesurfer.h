/* ricci: data at the vertices of surfaces in the files of FreeSurfer: values, labels, patches, annotations.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_values_read("lh.sulc", NULL, 0, &n);             // how many
 *     ricci_values_read("lh.sulc", values, n, &n);
 *
 * Surfaces themselves are read and written by ricci_mesh_read and ricci_mesh_write. Files that gzip has
 * packed are read too, and written where the name ends in .gz. The conventions are those of ricci/ricci.h.
 *
 * Sources, by the keys of docs/bibliography.md: flat patches of cortices [FSD99].
 */

#ifndef RICCI_FREESURFER_H
#define RICCI_FREESURFER_H

#include <ricci/ricci.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Values at the vertices of a surface: curv, sulc, area, thickness; by its content also a file of GIFTI with
 * one array of values (.shape.gii, .func.gii).
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (a name that is not UTF-8),
 *         RICCI_IO, RICCI_PARSE.
 *
 * @param path      file name in UTF-8.
 * @param values    out: the values; NULL with capacity 0 to ask for their number.
 * @param capacity  entries of `values`.
 * @param n         out: number of values.
 */
RICCI_API ricci_status ricci_values_read(const char *path, double *values, size_t capacity, size_t *n);

/**
 * Write values at the vertices of a surface, in single precision; the file appears whole or not at all.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (a number out of the range of single precision),
 *         RICCI_TOO_LARGE, RICCI_IO.
 *
 * @param path     file name in UTF-8.
 * @param values   the values.
 * @param n        number of values.
 * @param n_faces  number of faces of the surface, which the file names too.
 */
RICCI_API ricci_status ricci_values_write(const char *path, const double *values, size_t n, size_t n_faces);

/**
 * A label: a set of vertices, with their places and a value each. Buffers are NULL with capacity 0 where they
 * are not asked for.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (a name that is not UTF-8),
 *         RICCI_IO, RICCI_PARSE.
 *
 * @param path                file name in UTF-8.
 * @param vertices            out: n vertices; -1 for a point of the volume that belongs to none.
 * @param vertices_capacity   entries of `vertices`.
 * @param positions           out: n x 3.
 * @param positions_capacity  entries of `positions`.
 * @param values              out: n values, such as probabilities.
 * @param values_capacity     entries of `values`.
 * @param n                   out: number of entries of the label.
 */
RICCI_API ricci_status ricci_label_read(const char *path, int32_t *vertices, size_t vertices_capacity,
                                        double *positions, size_t positions_capacity, double *values,
                                        size_t values_capacity, size_t *n);

/**
 * Write a label; the file appears whole or not at all.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (numbers that are not finite, a comment of several
 * lines), RICCI_IO.
 *
 * @param path       file name in UTF-8.
 * @param comment    the first line, or NULL.
 * @param vertices   n vertices; -1 for a point of the volume that belongs to none.
 * @param positions  n x 3, or NULL for zeros.
 * @param values     n values, or NULL for zeros.
 * @param n          number of entries of the label.
 */
RICCI_API ricci_status ricci_label_write(const char *path, const char *comment, const int32_t *vertices,
                                         const double *positions, const double *values, size_t n);

/**
 * A patch: a part of the vertices of a surface with places of their own. Buffers are NULL with capacity 0
 * where they are not asked for.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (a name that is not UTF-8),
 *         RICCI_IO, RICCI_PARSE.
 *
 * @param path                file name in UTF-8.
 * @param vertices            out: n vertices of the whole surface.
 * @param vertices_capacity   entries of `vertices`.
 * @param positions           out: n x 3; z = 0 where the part lies flat.
 * @param positions_capacity  entries of `positions`.
 * @param is_border           out: n, 1 for vertices on the part's border, else 0.
 * @param is_border_capacity  entries of `is_border`.
 * @param n                   out: number of vertices of the patch.
 */
RICCI_API ricci_status ricci_patch_read(const char *path, uint32_t *vertices, size_t vertices_capacity,
                                        double *positions, size_t positions_capacity, uint32_t *is_border,
                                        size_t is_border_capacity, size_t *n);

/**
 * Write a patch, in single precision; the file appears whole or not at all.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (a number out of the range of single precision),
 *         RICCI_TOO_LARGE, RICCI_IO.
 *
 * @param path       file name in UTF-8.
 * @param vertices   n vertices of the whole surface.
 * @param positions  n x 3.
 * @param is_border  n, 1 for vertices on the part's border, else 0.
 * @param n          number of vertices of the patch.
 */
RICCI_API ricci_status ricci_patch_write(const char *path, const uint32_t *vertices, const double *positions,
                                         const uint32_t *is_border, size_t n);

/**
 * An annotation: one named region per vertex, with the colours of the regions; by its content also labels of
 * GIFTI (.label.gii). Buffers are NULL with capacity 0 where they are not asked for; the number of regions is
 * that of the lines of `names`.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (a name that is not UTF-8),
 *         RICCI_IO, RICCI_PARSE.
 *
 * @param path              file name in UTF-8.
 * @param regions           out: n regions, from 0; -1 for a vertex in none.
 * @param regions_capacity  entries of `regions`.
 * @param n                 out: number of vertices.
 * @param colors            out: four numbers for each region: red, green, blue from 0 to 255, transparency.
 * @param colors_capacity   entries of `colors`.
 * @param names             out: the names of the regions, each followed by a line break, NUL-terminated.
 * @param names_capacity    bytes of `names`.
 * @param n_bytes           out: number of bytes of `names` with the NUL.
 */
RICCI_API ricci_status ricci_annotation_read(const char *path, int32_t *regions, size_t regions_capacity,
                                             size_t *n, uint32_t *colors, size_t colors_capacity, char *names,
                                             size_t names_capacity, size_t *n_bytes);

/**
 * Write an annotation; the file appears whole or not at all.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (regions that do not exist, colours beyond 255, two
 *         regions with one colour, another number of names), RICCI_TOO_LARGE, RICCI_IO.
 *
 * @param path       file name in UTF-8.
 * @param regions    n regions, from 0; negative for a vertex in none.
 * @param n          number of vertices.
 * @param names      the names of the regions, one to a line.
 * @param colors     four numbers for each region: red, green, blue from 0 to 255, transparency.
 * @param n_regions  number of regions.
 */
RICCI_API ricci_status ricci_annotation_write(const char *path, const int32_t *regions, size_t n,
                                              const char *names, const uint32_t *colors, size_t n_regions);

#ifdef __cplusplus
}
#endif

#endif
