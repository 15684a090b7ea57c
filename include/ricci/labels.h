/* ricci: the names under which faces stand in a file, and further numbers of vertices and faces.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_soup_labels(soup, RICCI_LABEL_MATERIAL, numbers, n_faces, &n_names);
 *     ricci_soup_label(soup, RICCI_LABEL_MATERIAL, numbers[face], name, sizeof name, &n_bytes);
 *     ricci_soup_numbers(soup, RICCI_OF_VERTICES, 0, values, n_vertices);   // `quality` of PLY
 *
 * The conventions are those of ricci/ricci.h.
 *
 * Sources, by the keys of docs/bibliography.md: properties of vertices and faces in PLY files [Tur94].
 */

#ifndef RICCI_LABELS_H
#define RICCI_LABELS_H

#include <ricci/repair.h>
#include <ricci/ricci.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Which names. */
enum {
    /** Objects (`o` of OBJ). */
    RICCI_LABEL_OBJECT = 0,
    /** Groups (`g`); several of one face are one name, with blanks between them. */
    RICCI_LABEL_GROUP = 1,
    /** Materials (`usemtl`). */
    RICCI_LABEL_MATERIAL = 2,
    /** Smoothing groups (`s`). */
    RICCI_LABEL_SMOOTHING = 3,
    /** Not of faces, but of the further numbers of vertices, in their order. */
    RICCI_LABEL_VERTEX_NUMBERS = 4,
    /** Of the further numbers of faces. */
    RICCI_LABEL_FACE_NUMBERS = 5
};

/** The elements that further numbers belong to. */
enum {
    /** Vertices. */
    RICCI_OF_VERTICES = 0,
    /** Faces. */
    RICCI_OF_FACES = 1
};

/**
 * The names under which faces stand in a file, each once, and for each face the number of its name.
 *
 * Name 0 is empty: that of faces without one. The others come in the order of their first faces. Names of
 * numbers belong to no faces.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such names).
 *
 * @param soup      the triangle list.
 * @param which     RICCI_LABEL_*.
 * @param numbers   out: n_faces numbers of names, none for names of numbers; NULL with capacity 0 asks
 *                  for the number of names alone.
 * @param capacity  entries of `numbers`.
 * @param n_names   out: the number of names.
 */
RICCI_API ricci_status ricci_soup_labels(const ricci_soup *soup, uint32_t which, uint32_t *numbers,
                                         size_t capacity, size_t *n_names);

/**
 * One name of faces, or of further numbers.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (index, no such names).
 *
 * @param soup      the triangle list.
 * @param which     RICCI_LABEL_*.
 * @param index     which one, below n_names.
 * @param name      out: the name in UTF-8, NUL-terminated; NULL with capacity 0 to ask for its length.
 * @param capacity  bytes of `name`.
 * @param n_bytes   out: number of bytes with the NUL.
 */
RICCI_API ricci_status ricci_soup_label(const ricci_soup *soup, uint32_t which, size_t index, char *name,
                                        size_t capacity, size_t *n_bytes);

/**
 * Further numbers of vertices or faces, which a file has under a name of its own, such as `quality` in PLY;
 * ricci_soup_label has their names.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (index, no such elements).
 *
 * @param soup      the triangle list.
 * @param of        RICCI_OF_VERTICES or RICCI_OF_FACES.
 * @param index     which ones, below n_vertex_numbers or n_face_numbers.
 * @param values    out: n_vertices or n_faces numbers, which may be NaN.
 * @param capacity  entries of `values`.
 */
RICCI_API ricci_status ricci_soup_numbers(const ricci_soup *soup, uint32_t of, size_t index, double *values,
                                          size_t capacity);

#ifdef __cplusplus
}
#endif

#endif
