/* ricci: files of GIFTI: surfaces, values and labels with notes: metadata, and the spaces of coordinates.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_gifti_notes_read("lh.pial.surf.gii", &notes);       // what the file says beside its numbers
 *     ricci_gifti_notes_add(notes, "GeometricType", "Flat");
 *     ricci_gifti_surface_write("lh.flat.surf.gii", positions, n_vertices, faces, n_faces, notes);
 *     ricci_gifti_notes_free(notes);
 *
 * Surfaces are read by ricci_mesh_read. Files that gzip has packed are read too, and written where the name
 * ends in .gz. Numbers are written in single precision. Texts that are written have the characters that XML
 * has: others below 32 than tab and line breaks are RICCI_ARGUMENT. The conventions are those of
 * ricci/ricci.h.
 *
 * Sources, by the keys of docs/bibliography.md: the format [HBC11].
 */

#ifndef RICCI_GIFTI_H
#define RICCI_GIFTI_H

#include <ricci/ricci.h>

#ifdef __cplusplus
extern "C" {
#endif

/** What a file says beside its numbers: names with values, and transforms to other spaces. */
typedef struct ricci_gifti_notes ricci_gifti_notes;

/** The arrays of a file with one number per vertex, and its table of labels. It never changes. */
typedef struct ricci_gifti_columns ricci_gifti_columns;

/** A name and its value, such as AnatomicalStructurePrimary and CortexLeft; texts are the handle's. */
typedef struct ricci_gifti_note {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** The name. */
    const char *name;
    /** The value, which may be empty. */
    const char *value;
} ricci_gifti_note;

/** The way from the coordinates of a surface to those of another space; texts are the handle's. */
typedef struct ricci_gifti_transform {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** The name of the space of the coordinates, such as NIFTI_XFORM_SCANNER_ANAT. */
    const char *from;
    /** The name of the other space. */
    const char *to;
    /** The matrix that acts on (x, y, z, 1), row by row. */
    double matrix[16];
} ricci_gifti_transform;

/** One number per vertex; texts and numbers are the handle's. */
typedef struct ricci_gifti_column {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** What the numbers are: "SHAPE", "LABEL", "TIME_SERIES", "NONE" and others. */
    const char *intent;
    /** The name of the column; empty where the file gives none. */
    const char *name;
    /** The numbers; a NaN in the file stays one. */
    const double *values;
    /** How many there are. */
    size_t n;
} ricci_gifti_column;

/** A row of the table of labels; the text is the handle's. */
typedef struct ricci_gifti_label {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** The name, which may be empty. */
    const char *name;
    /** Red, green, blue and opacity from 0 to 1. */
    double color[4];
    /** The number that stands at vertices. */
    int32_t key;
    /** 0. */
    uint32_t reserved;
} ricci_gifti_label;

/**
 * Notes that say nothing yet.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER.
 *
 * @param notes  out: the new handle, to be released by ricci_gifti_notes_free.
 */
RICCI_API ricci_status ricci_gifti_notes_new(ricci_gifti_notes **notes);

/**
 * The notes of a file: metadata of the file and of its first array but for the array's name, and the
 * transforms of its points.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (a name that is not UTF-8), RICCI_IO, RICCI_PARSE.
 *
 * @param path   file name in UTF-8.
 * @param notes  out: the new handle, to be released by ricci_gifti_notes_free.
 */
RICCI_API ricci_status ricci_gifti_notes_read(const char *path, ricci_gifti_notes **notes);

/**
 * Release notes.
 *
 * @param notes  the notes, or NULL.
 */
RICCI_API_VOID void ricci_gifti_notes_free(ricci_gifti_notes *notes);

/**
 * Add a name and its value. Texts that were asked for before stay where they are.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (not UTF-8).
 *
 * @param notes  the notes.
 * @param name   the name.
 * @param value  the value.
 */
RICCI_API ricci_status ricci_gifti_notes_add(ricci_gifti_notes *notes, const char *name, const char *value);

/**
 * Add a transform of the coordinates of a surface. Texts that were asked for before stay where they are.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (not UTF-8; an entry that is not finite).
 *
 * @param notes   the notes.
 * @param from    the name of the space of the coordinates, such as NIFTI_XFORM_SCANNER_ANAT.
 * @param to      the name of the other space.
 * @param matrix  16 numbers, row by row: the matrix that acts on (x, y, z, 1).
 */
RICCI_API ricci_status ricci_gifti_notes_add_transform(ricci_gifti_notes *notes, const char *from,
                                                       const char *to, const double *matrix);

/**
 * How many names with values and how many transforms there are.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER.
 *
 * @param notes         the notes.
 * @param n_metadata    out: number of names with values.
 * @param n_transforms  out: number of transforms.
 */
RICCI_API ricci_status ricci_gifti_notes_count(const ricci_gifti_notes *notes, size_t *n_metadata,
                                               size_t *n_transforms);

/**
 * One name and its value.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (index), RICCI_STRUCT_SIZE.
 *
 * @param notes  the notes.
 * @param index  which one, below n_metadata.
 * @param note   out: the name and the value, which live as long as the notes.
 * @param size   sizeof *note.
 */
RICCI_API ricci_status ricci_gifti_notes_get(const ricci_gifti_notes *notes, size_t index,
                                             ricci_gifti_note *note, size_t size);

/**
 * One transform.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (index), RICCI_STRUCT_SIZE.
 *
 * @param notes      the notes.
 * @param index      which one, below n_transforms.
 * @param transform  out: the spaces, whose names live as long as the notes, and the matrix.
 * @param size       sizeof *transform.
 */
RICCI_API ricci_status ricci_gifti_notes_transform(const ricci_gifti_notes *notes, size_t index,
                                                   ricci_gifti_transform *transform, size_t size);

/**
 * The arrays of a file that have one number per vertex, and its table of labels (.shape.gii, .func.gii,
 * .label.gii); surfaces and vectors are passed over.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (a name that is not UTF-8), RICCI_IO, RICCI_PARSE.
 *
 * @param path     file name in UTF-8.
 * @param columns  out: the new handle, to be released by ricci_gifti_columns_free.
 */
RICCI_API ricci_status ricci_gifti_columns_read(const char *path, ricci_gifti_columns **columns);

/**
 * Release columns.
 *
 * @param columns  the columns, or NULL.
 */
RICCI_API_VOID void ricci_gifti_columns_free(ricci_gifti_columns *columns);

/**
 * How many columns and how many labels there are.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER.
 *
 * @param columns    the columns.
 * @param n_columns  out: number of columns.
 * @param n_labels   out: number of rows of the table of labels.
 */
RICCI_API ricci_status ricci_gifti_columns_count(const ricci_gifti_columns *columns, size_t *n_columns,
                                                 size_t *n_labels);

/**
 * One column, in the order of the file.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (index), RICCI_STRUCT_SIZE.
 *
 * @param columns  the columns.
 * @param index    which one, below n_columns.
 * @param column   out: its texts and numbers, which live as long as the handle.
 * @param size     sizeof *column.
 */
RICCI_API ricci_status ricci_gifti_columns_get(const ricci_gifti_columns *columns, size_t index,
                                               ricci_gifti_column *column, size_t size);

/**
 * One row of the table of labels.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (index), RICCI_STRUCT_SIZE.
 *
 * @param columns  the columns.
 * @param index    which one, below n_labels.
 * @param label    out: the label, whose name lives as long as the handle.
 * @param size     sizeof *label.
 */
RICCI_API ricci_status ricci_gifti_columns_label(const ricci_gifti_columns *columns, size_t index,
                                                 ricci_gifti_label *label, size_t size);

/**
 * Write a surface (.surf.gii) with notes; the file appears whole or not at all.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (positions that are not in the range of single
 *         precision, faces without vertices, a text that XML has not), RICCI_TOO_LARGE, RICCI_IO.
 *
 * @param path        file name in UTF-8.
 * @param positions   n_vertices x 3.
 * @param n_vertices  number of vertices.
 * @param faces       n_faces x 3 vertex indices.
 * @param n_faces     number of faces.
 * @param notes       metadata and transforms, or NULL; without a transform the identity is written.
 */
RICCI_API ricci_status ricci_gifti_surface_write(const char *path, const double *positions, size_t n_vertices,
                                                 const uint32_t *faces, size_t n_faces,
                                                 const ricci_gifti_notes *notes);

/**
 * Write values at the vertices of a surface (.shape.gii), in columns with names; the file appears whole or
 * not at all. Transforms of the notes, which are those of points, are left out.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (a number out of the range of single precision,
 *         another number of names, a text that XML has not), RICCI_TOO_LARGE, RICCI_IO.
 *
 * @param path       file name in UTF-8.
 * @param names      the names of the columns, one to a line; an empty line is a column without one.
 * @param values     n_columns x n numbers: all of the first column, then those of the next; NaN for none.
 * @param n          number of vertices.
 * @param n_columns  number of columns.
 * @param notes      metadata, or NULL.
 */
RICCI_API ricci_status ricci_gifti_values_write(const char *path, const char *names, const double *values,
                                                size_t n, size_t n_columns, const ricci_gifti_notes *notes);

/**
 * Write labels at the vertices of a surface (.label.gii) with their table; the file appears whole or not at
 * all. Transforms of the notes, which are those of points, are left out.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (a label that the table has not, another number of
 *         names, a colour beyond 1, a text that XML has not), RICCI_TOO_LARGE, RICCI_IO.
 *
 * @param path    file name in UTF-8.
 * @param labels  n labels, which are keys of the table.
 * @param n       number of vertices.
 * @param keys    n_rows keys.
 * @param names   the names of the labels, one to a line.
 * @param colors  n_rows x 4: red, green, blue and opacity from 0 to 1.
 * @param n_rows  number of rows of the table.
 * @param notes   metadata, or NULL.
 */
RICCI_API ricci_status ricci_gifti_labels_write(const char *path, const int32_t *labels, size_t n,
                                                const int32_t *keys, const char *names, const double *colors,
                                                size_t n_rows, const ricci_gifti_notes *notes);

#ifdef __cplusplus
}
#endif

#endif
