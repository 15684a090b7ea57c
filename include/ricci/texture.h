/* ricci: texture atlases of whole models, on their own faces.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_soup_read("model.obj", &soup);
 *     ricci_texture_atlas_new(soup, NULL, NULL, &atlas);
 *     ricci_texture_atlas_soup(atlas, &textured);
 *     ricci_soup_write(textured, "model.glb");
 *
 * The conventions are those of ricci/ricci.h.
 *
 * Sources, by the keys of docs/bibliography.md: seams to where stretch is most [GGH02], stretch as a texture
 * has it [SSGH01], flat charts [SS15].
 */

#ifndef RICCI_TEXTURE_H
#define RICCI_TEXTURE_H

#include <ricci/repair.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A model with texture coordinates on its own faces. It never changes. */
typedef struct ricci_texture_atlas ricci_texture_atlas;

/** Lists of faces of a model. */
enum {
    /**
     * Without a place: with a corner that is missing or not finite, with two corners in one place, or so thin
     * that no chart of their own fits on the grid of the coordinates.
     */
    RICCI_TEXTURE_PLACELESS = 0,
    /** Turned over or without area on the page: there are none. */
    RICCI_TEXTURE_FOLDED = 1,
    /** Meeting the interior of an earlier face on the page: there are none. */
    RICCI_TEXTURE_OVERLAPPING = 2,
    /** Running against most faces around them, and so does their image: clockwise. */
    RICCI_TEXTURE_TURNED = 3
};

/** Options of ricci_texture_atlas_new; zeros are the defaults. */
typedef struct ricci_texture_options {
    /** sizeof(ricci_texture_options), by ricci_init. */
    size_t size;
    /**
     * The bound, above 1, of the stretch and compression of all but a hundredth of the area; 0: 1.3. A
     * smaller one makes longer seams.
     */
    double stretch;
    /**
     * The share of the page that charts are to fill, up to 1; 0: 0.68; negative: no chart is divided for it.
     * Charts are divided along short paths as long as less is filled and the page gains from it.
     */
    double fill;
    /**
     * Texels along a side of the page, a power of two from 16 to 65536; 0: 1024. Larger pages have
     * narrower margins between charts.
     */
    uint32_t page;
    /**
     * Least distance of two charts in texels; 0: 2; negative: none. Two keep linear filters from mixing
     * charts; mipmaps need more.
     */
    int32_t margin;
    /**
     * Threads; 0 for one per core. The result does not depend on it. 1 suits hosts that run several calls at
     * once.
     */
    size_t threads;
    /**
     * Texels for a unit of length on the model, and as many pages as that takes, up to 160; 0: one page,
     * filled as far as it goes. One density suits many models that share a scene; charts that are larger than
     * a page are divided, and `fill` has no effect.
     */
    double density;
} ricci_texture_options;

/** Counts and figures of an atlas. Stretches are relative to the scale that keeps the total area. */
typedef struct ricci_texture_atlas_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Faces of the model. */
    size_t n_faces;
    /** Connected pieces of the model that are surfaces. */
    size_t n_sheets;
    /** Edges with several faces along which the model was opened because it is no surface there. */
    size_t n_opened_edges;
    /** Charts. */
    size_t n_charts;
    /** Faces with a place. */
    size_t n_split_faces;
    /** Vertices after they are split along the seams. */
    size_t n_split_vertices;
    /** Faces of the list RICCI_TEXTURE_PLACELESS. */
    size_t n_placeless;
    /** Faces of the list RICCI_TEXTURE_FOLDED, by exact arithmetic. */
    size_t n_folded;
    /** Faces of the list RICCI_TEXTURE_OVERLAPPING, by exact arithmetic. */
    size_t n_overlapping;
    /** Faces of the list RICCI_TEXTURE_TURNED. */
    size_t n_turned;
    /** Texels along a side of the page. */
    size_t page;
    /** How much larger texels are on the model than evenly spread ones, root mean square: 1 at best. */
    double stretch_l2;
    /** The largest stretch or compression along a direction. */
    double stretch_max;
    /** That which is exceeded on a hundredth of the area. */
    double stretch_99;
    /** Mean by area of the largest change of an angle between two directions, degrees. */
    double angle_mean;
    /** That which is exceeded on a hundredth of the area, degrees. */
    double angle_99;
    /** Standard deviation of the logarithm of the change of areas. */
    double log_area_deviation;
    /** Length of the seams on the model, each once, over the root of its area. */
    double seam_length;
    /** The share of the pages that faces fill. */
    double fill;
    /** Texels per unit of length on the model. */
    double texel_density;
    /** Pages; 1 unless a density is asked for. */
    size_t n_pages;
} ricci_texture_atlas_summary;

/**
 * The triangle list of polygons: convex ones are fans from their first corner, others are cut ear by ear.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (stride, starts), RICCI_TOO_LARGE, RICCI_NO_MEMORY.
 *
 * @param positions   x, y, z of every vertex.
 * @param stride      bytes from one vertex to the next; 0: 24.
 * @param n_vertices  number of vertices.
 * @param corners     0-based vertices of all polygons, one polygon after the other; nothing is asked of them.
 * @param starts      n_polygons + 1 offsets: polygon i has the corners starts[i] to starts[i + 1] - 1.
 * @param n_polygons  number of polygons.
 * @param soup        out: the new handle, to be released by ricci_soup_free.
 */
RICCI_API ricci_status ricci_soup_from_polygons(const double *positions, size_t stride, size_t n_vertices,
                                                const uint32_t *corners, const size_t *starts,
                                                size_t n_polygons, ricci_soup **soup);

/**
 * The polygons that the faces of a list of ricci_soup_from_polygons are parts of.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (not such a list).
 *
 * @param soup      the list.
 * @param polygons  out: for each face the number of its polygon.
 * @param capacity  entries of `polygons`.
 */
RICCI_API ricci_status ricci_soup_polygons(const ricci_soup *soup, uint32_t *polygons, size_t capacity);

/**
 * A texture atlas of a model: every face of a triangle list keeps its number and gets a place on a square
 * page. The list may have any defects: it is opened where it is no surface.
 *
 * The result is the same for any number of threads.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (an option outside its range),
 *         RICCI_LAYOUT (no face has a place, the page has no room, a face is larger than a page, or more
 *         than 160 pages are needed), RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param soup     the model.
 * @param options  stretch, page and margin, or NULL.
 * @param control  progress and cancellation, or NULL.
 * @param atlas    out: the new handle, to be released by ricci_texture_atlas_free.
 */
RICCI_API ricci_status ricci_texture_atlas_new(const ricci_soup *soup, const ricci_texture_options *options,
                                               const ricci_control *control, ricci_texture_atlas **atlas);

/**
 * Release an atlas.
 *
 * @param atlas  the atlas, or NULL.
 */
RICCI_API_VOID void ricci_texture_atlas_free(ricci_texture_atlas *atlas);

/**
 * Counts and figures of an atlas.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param atlas    the atlas.
 * @param summary  out: the figures.
 * @param size     sizeof *summary.
 */
RICCI_API ricci_status ricci_texture_atlas_summarise(const ricci_texture_atlas *atlas,
                                                     ricci_texture_atlas_summary *summary, size_t size);

/**
 * The texture coordinates of the corners of the model's faces: multiples of 2^-24 in the unit square, which
 * files of 32-bit numbers hold too. Of several pages they are in the tiles of UDIM, multiples of 2^-20: page
 * p has u from p mod 10 and v from p / 10, rounded down.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param atlas     the atlas.
 * @param uv        out: n_faces x 3 x 2 numbers; 0 for faces without a place.
 * @param capacity  entries of `uv`.
 */
RICCI_API ricci_status ricci_texture_atlas_uv(const ricci_texture_atlas *atlas, double *uv, size_t capacity);

/**
 * The charts of the model's faces, numbered by their area, the largest first.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param atlas     the atlas.
 * @param charts    out: for each face its chart; UINT32_MAX for one without a place.
 * @param capacity  entries of `charts`.
 */
RICCI_API ricci_status ricci_texture_atlas_charts(const ricci_texture_atlas *atlas, uint32_t *charts,
                                                  size_t capacity);

/**
 * The pages of the model's faces.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param atlas     the atlas.
 * @param pages     out: for each face its page, below n_pages; 0 for one without a place.
 * @param capacity  entries of `pages`.
 */
RICCI_API ricci_status ricci_texture_atlas_pages(const ricci_texture_atlas *atlas, uint32_t *pages,
                                                 size_t capacity);

/**
 * A list of faces, ascending, of which the summary has the number.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (no such list), RICCI_BUFFER_TOO_SMALL.
 *
 * @param atlas     the atlas.
 * @param which     RICCI_TEXTURE_PLACELESS ... RICCI_TEXTURE_TURNED.
 * @param faces     out: the faces.
 * @param capacity  entries of `faces`.
 */
RICCI_API ricci_status ricci_texture_atlas_faces(const ricci_texture_atlas *atlas, uint32_t which,
                                                 uint32_t *faces, size_t capacity);

/**
 * The model with one pair of texture coordinates for each vertex, as renderers take it: vertices are split
 * along the seams, and faces without a place are left out.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param atlas             the atlas.
 * @param corners           out: n_split_faces x 3 split vertices.
 * @param corners_capacity  entries of `corners`.
 * @param faces             out: for each of these faces its number in the model, ascending.
 * @param faces_capacity    entries of `faces`.
 * @param vertices          out: for each split vertex the model's vertex that it is a copy of.
 * @param vertices_capacity entries of `vertices`.
 * @param uv                out: n_split_vertices x 2 texture coordinates.
 * @param uv_capacity       entries of `uv`.
 */
RICCI_API ricci_status ricci_texture_atlas_split(const ricci_texture_atlas *atlas, uint32_t *corners,
                                                 size_t corners_capacity, uint32_t *faces,
                                                 size_t faces_capacity, uint32_t *vertices,
                                                 size_t vertices_capacity, double *uv, size_t uv_capacity);

/**
 * The model with the texture coordinates of the atlas in place of its own, for ricci_soup_write; its other
 * attributes, vertices and faces are as they were.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_NO_MEMORY.
 *
 * @param atlas  the atlas.
 * @param soup   out: the new handle, to be released by ricci_soup_free.
 */
RICCI_API ricci_status ricci_texture_atlas_soup(const ricci_texture_atlas *atlas, ricci_soup **soup);

#ifdef __cplusplus
}
#endif

#endif
