/* ricci: bicubic patches near splines, for CAD.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_bicubic_new(spline, NULL, NULL, &patches);
 *     ricci_bicubic_summarise(patches, &summary, sizeof summary);  // how far from the spline, how smooth
 *     ricci_bicubic_write(patches, NULL, "surface.step");
 *
 * The conventions are those of ricci/ricci.h. A patch of the spline becomes three bicubic B-spline patches;
 * neighbours share the control points of their common side, so that there are no gaps.
 *
 * A library that was built without the feature `splines` has these functions; each answers RICCI_LEFT_OUT.
 * Without the feature `step` a STEP file is RICCI_UNKNOWN_FORMAT.
 *
 * Sources, by the keys of docs/bibliography.md: patches from their sides [Coo67].
 */

#ifndef RICCI_BICUBIC_H
#define RICCI_BICUBIC_H

#include <ricci/spline.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Bicubic patches near a spline. They never change. */
typedef struct ricci_bicubic ricci_bicubic;

/** Files of patches. */
enum {
    /**
     * STEP AP242: parts that close up are solids with outward normals, the others are shells of one surface
     * model. The same patches give the same bytes.
     */
    RICCI_BICUBIC_STEP = 0,
    /** JSON, `ricci-patches 1`: all that is needed to evaluate the patches, numbers without loss. */
    RICCI_BICUBIC_JSON = 1
};

/** The unit of the coordinates in STEP files. */
enum {
    /** Millimetres. */
    RICCI_UNIT_MILLIMETRE = 0,
    /** Metres. */
    RICCI_UNIT_METRE = 1
};

/** Options of bicubic patches: how near they are to the spline; zeros are the defaults. */
typedef struct ricci_bicubic_options {
    /** sizeof(ricci_bicubic_options), by ricci_init. */
    size_t size;
    /**
     * Largest distance from the spline over the diagonal of the summary, 1e-10 to 1; 0: 1e-4. 1e-3 makes
     * smaller files.
     */
    double tolerance;
    /**
     * Largest angle between the normals of neighbouring patches beyond that between the spline's own. Patches
     * get more spans for it, but never to more than 128 spans along a side: see normal_jump_max. 0: half a
     * degree. Half a degree is hardly seen in reflections.
     */
    double angle;
    /**
     * Threads, 0 for one per core; results do not depend on it. 1 suits hosts that run several calls at once.
     */
    size_t threads;
    /**
     * Most control points of all patches together; where more are needed nothing is made. 0: no limit. It
     * bounds the size of the file.
     */
    size_t control_points;
    /**
     * Not 0: patches of a spline that folds too, which is refused else. Only to look at what went wrong:
     * other programs refuse such solids.
     */
    uint32_t folds;
    /** 0. */
    uint32_t reserved;
} ricci_bicubic_options;

/** Entries of a STEP file beside the patches, whose faces are named `patch 0`, `patch 1`, … and whose edges
 * where the surface has one `crease`. Zeroed by ricci_init: no name, millimetres, no colours. */
typedef struct ricci_step_options {
    /** sizeof(ricci_step_options), by ricci_init. */
    size_t size;
    /** The name of the part, in UTF-8; NULL: none. Programs show it in their tree of parts. */
    const char *name;
    /** RICCI_UNIT_MILLIMETRE or RICCI_UNIT_METRE. Parts are usually in millimetres, buildings in metres. */
    uint32_t unit;
    /** 1: faces have colours that differ from those of their neighbours; 0: they have none. Colours suit a
     * look at the patches, none a part among others. */
    uint32_t colours;
} ricci_step_options;

/** Figures of bicubic patches. */
typedef struct ricci_bicubic_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Number of patches, three for each of the spline. */
    size_t n_patches;
    /** Number of curves, each a side of one patch or of two. */
    size_t n_curves;
    /** Number of control points of all patches. */
    size_t n_control_points;
    /** Least number of spans along a side. */
    size_t spans_min;
    /** Largest number of spans along a side. */
    size_t spans_max;
    /** Times that patches were made: once, and again where they missed the spline. */
    size_t rounds;
    /** Number of sides whose control points or knots differ from those of their curve: 0 is watertight. */
    size_t n_open_sides;
    /** 1: every curve is a side of two patches. */
    uint32_t closed;
    /** 0. */
    uint32_t reserved;
    /**
     * The diagonal of the bounding box of the corners, middles of sides and centroids of the spline's
     * patches.
     */
    double diagonal;
    /**
     * Largest distance of a patch from the spline's point with the same parameters, over the diagonal,
     * between the points that are interpolated.
     */
    double distance;
    /** Largest angle between the normals of neighbouring patches along their common curves. */
    double normal_jump_max;
    /** The mean of these angles. */
    double normal_jump_mean;
    /** The largest between the spline's own normals at the same places. */
    double normal_jump_of_spline;
} ricci_bicubic_summary;

/**
 * Bicubic patches within a tolerance of a spline, with as many spans as that takes, up to 128 along a side.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (tolerance or angle; more control
 *         points than allowed are needed), RICCI_SPLINE (a patch that 128 spans do not bring within the
 *         tolerance, or that folds: its number, as that of a face; a side of more than two patches; a spline
 *         without patches), RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param spline   the spline.
 * @param options  tolerance and angle; NULL for the defaults.
 * @param control  progress and cancellation, or NULL.
 * @param bicubic  out: the new handle, to be released by ricci_bicubic_free.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_bicubic_new(const ricci_spline *spline,
                                                            const ricci_bicubic_options *options,
                                                            const ricci_control *control,
                                                            ricci_bicubic **bicubic);

/**
 * Release bicubic patches.
 *
 * @param bicubic  the handle, or NULL.
 */
RICCI_API_VOID void ricci_bicubic_free(ricci_bicubic *bicubic);

/**
 * The figures of bicubic patches.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param bicubic  the patches.
 * @param summary  out: the figures.
 * @param size     sizeof *summary.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_bicubic_summarise(const ricci_bicubic *bicubic,
                                                                  ricci_bicubic_summary *summary,
                                                                  size_t size);

/**
 * Write the patches in the format of the file's extension, whole or not at all.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (not UTF-8, no such unit),
 * RICCI_IO, RICCI_UNKNOWN_FORMAT, RICCI_NO_MEMORY.
 *
 * @param bicubic  the patches.
 * @param options  of a STEP file its name and unit; NULL for the defaults.
 * @param path     file name in UTF-8, ending in .step, .stp or .json.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_bicubic_write(const ricci_bicubic *bicubic,
                                                              const ricci_step_options *options,
                                                              const char *path);

/**
 * The text of such a file.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (no such format, as above),
 *         RICCI_BUFFER_TOO_SMALL, RICCI_NO_MEMORY.
 *
 * @param bicubic   the patches.
 * @param format    RICCI_BICUBIC_STEP or RICCI_BICUBIC_JSON.
 * @param options   of a STEP file its name and unit; NULL for the defaults.
 * @param text      out: the text, NUL-terminated; NULL with capacity 0 to ask for its length.
 * @param capacity  bytes of `text`.
 * @param n_bytes   out: number of bytes with the NUL.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status ricci_bicubic_text(const ricci_bicubic *bicubic, uint32_t format,
                                                             const ricci_step_options *options, char *text,
                                                             size_t capacity, size_t *n_bytes);

#ifdef __cplusplus
}
#endif

#endif
