/* ricci: archives, in which results are kept as bytes and files.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_objects objects;
 *     ricci_init(&objects, sizeof objects);
 *     objects.layout = layout;
 *     ricci_archive_new(&objects, &archive);
 *     ricci_archive_write(archive, "bunny.layout");
 *     ...
 *     ricci_archive_read("bunny.layout", &archive);
 *     ricci_archive_objects(archive, &objects, sizeof objects);    // objects.layout, as it was
 *
 * The conventions are those of ricci/ricci.h. What is read answers every question as the object that was
 * written, bit for bit, and goes into every further call as that would; nothing is solved again. Equal
 * objects are equal bytes, whatever the number of threads: the seconds that a call took and its number of
 * threads are not kept (seconds read as 0). A file holds all that its object came from; two objects in two
 * files have no part in common.
 *
 * The same files are read and written by the Rust crate (`ricci::archive`), the Python package and this
 * library. All numbers are little-endian. A library reads the format of its own version alone: the first
 * bytes tell, and another format is RICCI_UNKNOWN_FORMAT. Files that are cut off or damaged are found by a
 * checksum. It is no protection against files that were made to deceive; such a file gives a status, at worst
 * RICCI_PANIC, or a wrong object.
 *
 * Sources, by the keys of docs/bibliography.md: little-endian arrays behind a head that names them [Tur94].
 */

#ifndef RICCI_ARCHIVE_H
#define RICCI_ARCHIVE_H

#include <ricci/ricci.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The bytes of one object. They never change. */
typedef struct ricci_archive ricci_archive;

/**
 * One object of any type, in the field of its type. The types of other themes are declared in their headers.
 *
 * ricci_archive_objects also fills `mesh` with the mesh that a metric, a layout, charts, a map, a canonical
 * shape, forms, a matching or an atlas was made from (without attributes), `target` with the mesh that a map
 * or a matching leads to, and `layout` with the layout of charts.
 */
typedef struct ricci_objects {
    /** sizeof(ricci_objects), by ricci_init. */
    size_t size;
    /** A mesh with its attributes. */
    struct ricci_mesh *mesh;
    /** A metric with its report and the way back to its mesh. */
    struct ricci_metric *metric;
    /** A layout with its metric. */
    struct ricci_layout *layout;
    /** Charts of ricci/charts.h. */
    struct ricci_charts *charts;
    /** A common subdivision. */
    struct ricci_map *map;
    /** A canonical shape of ricci/uniformize.h. */
    struct ricci_uniform *uniform;
    /** A circle domain of ricci/circles.h. */
    struct ricci_circle_domain *circle_domain;
    /** Forms of ricci/harmonic.h. */
    struct ricci_forms *forms;
    /** A matching of ricci/match.h, with its source and target. */
    struct ricci_matching *matching;
    /** An atlas of ricci/structure.h. */
    struct ricci_structure *structure;
    /** A seamless metric of ricci/seamless.h. */
    struct ricci_seamless *seamless;
    /** A quad mesh of ricci/quads.h. */
    struct ricci_quads *quads;
    /** A layout of four-sided patches of ricci/quads.h, which goes with its seamless metric as before. */
    struct ricci_quad_layout *quad_layout;
    /** A spline of ricci/quad_spline.h. */
    struct ricci_quad_spline *quad_spline;
    /** A spline of ricci/spline.h with the figures of its fit. */
    struct ricci_spline *spline;
    /**
     * Out, of a map or a matching: the mesh that it leads to. In: not looked at.
     */
    struct ricci_mesh *target;
    /**
     * Of a matching: 1 if its source is the mirror image of the surface that the caller means. The library
     * only keeps it.
     */
    uint32_t mirrored;
    /** 0. */
    uint32_t reserved;
} ricci_objects;

/** Figures of an archive. */
typedef struct ricci_archive_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** What it holds: "mesh", "metric", "layout", "charts", "map", "uniformization", "circle domain",
     * "forms", "matching", "structure", "seamless metric", "quad mesh", "quad layout", "quad spline" or
     * "spline"; lives as long as the archive. */
    const char *kind;
    /** Number of bytes of the whole archive. */
    size_t n_bytes;
    /** The version of the format. */
    uint32_t format;
    /** 0. */
    uint32_t reserved;
} ricci_archive_summary;

/**
 * The archive of an object, in memory.
 *
 * The object is not changed.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (no object, or several),
 *         RICCI_LEFT_OUT (an object of a part that was left out), RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param objects  the object.
 * @param archive  out: the new handle, to be released by ricci_archive_free.
 */
RICCI_API ricci_status ricci_archive_new(const ricci_objects *objects, ricci_archive **archive);

/**
 * The archive with these bytes, which are copied.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_UNKNOWN_FORMAT (no archive, or one of another version),
 *         RICCI_PARSE (cut off or damaged: the byte), RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param bytes    n_bytes bytes.
 * @param n_bytes  their number.
 * @param archive  out: the new handle, to be released by ricci_archive_free.
 */
RICCI_API ricci_status ricci_archive_parse(const uint8_t *bytes, size_t n_bytes, ricci_archive **archive);

/**
 * The archive of a file.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (not UTF-8), RICCI_IO, and those of
 *         ricci_archive_parse.
 *
 * @param path     file name in UTF-8.
 * @param archive  out: the new handle, to be released by ricci_archive_free.
 */
RICCI_API ricci_status ricci_archive_read(const char *path, ricci_archive **archive);

/**
 * Release an archive.
 *
 * @param archive  the handle, or NULL.
 */
RICCI_API_VOID void ricci_archive_free(ricci_archive *archive);

/**
 * What an archive holds, and its size.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param archive  the archive.
 * @param summary  out: the figures.
 * @param size     sizeof *summary.
 */
RICCI_API ricci_status ricci_archive_summarise(const ricci_archive *archive, ricci_archive_summary *summary,
                                               size_t size);

/**
 * The bytes of an archive.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_NO_MEMORY.
 *
 * @param archive   the archive.
 * @param bytes     out: n_bytes of the summary bytes.
 * @param capacity  bytes that `bytes` has room for.
 */
RICCI_API ricci_status ricci_archive_bytes(const ricci_archive *archive, uint8_t *bytes, size_t capacity);

/**
 * Write an archive as a file, whole or not at all.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (not UTF-8), RICCI_IO, RICCI_NO_MEMORY,
 *         RICCI_CANCELLED.
 *
 * @param archive  the archive.
 * @param path     file name in UTF-8, with any extension.
 */
RICCI_API ricci_status ricci_archive_write(const ricci_archive *archive, const char *path);

/**
 * The object of an archive, a new one at each call.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE (also for an object of a later library, for which
 * the caller's struct has no field), RICCI_PARSE (the content is no such object: the byte), RICCI_LEFT_OUT
 *         (an object of a part that was left out), RICCI_UNKNOWN_FORMAT (of a kind that the library does not
 *         know), RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param archive  the archive.
 * @param objects  out: the object in the field of its type, and those that it was made from, each to be
 * released by the `_free` of its type; all other fields are NULL.
 * @param size     sizeof *objects.
 */
RICCI_API ricci_status ricci_archive_objects(const ricci_archive *archive, ricci_objects *objects,
                                             size_t size);

#ifdef __cplusplus
}
#endif

#endif
