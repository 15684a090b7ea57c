/* ricci: scenes of glTF with a texture atlas: nodes, materials and names stay as they were.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_scene_read("scene.glb", &scene);
 *     ricci_scene_texture_atlas(scene, NULL, NULL, &atlas);
 *     ricci_scene_write(scene, atlas, NULL, "out.glb", &report, sizeof report);
 *
 * The conventions are those of ricci/ricci.h.
 *
 * Sources, by the keys of docs/bibliography.md: the averages of tangents [Mik08].
 */

#ifndef RICCI_SCENE_H
#define RICCI_SCENE_H

#include <ricci/texture.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * A glTF file with everything that is in it, and the triangles of its meshes. A mesh counts once, however
 * many nodes show it, in the size of the node that enlarges it most. It never changes.
 */
typedef struct ricci_scene ricci_scene;

/** Counts of a scene. */
typedef struct ricci_scene_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Nodes. */
    size_t n_nodes;
    /** Meshes with triangles. */
    size_t n_meshes;
    /** Primitives with triangles: parts of meshes that have one material each. */
    size_t n_primitives;
    /** Materials. */
    size_t n_materials;
    /** Vertices of all these primitives; those that several primitives of a mesh share count once. */
    size_t n_vertices;
    /** Triangles. */
    size_t n_faces;
} ricci_scene_summary;

/** Options of ricci_scene_write; zeros are the defaults. */
typedef struct ricci_scene_options {
    /** sizeof(ricci_scene_options), by ricci_init. */
    size_t size;
    /**
     * The set of texture coordinates that the atlas becomes, TEXCOORD_n, up to 7; negative: TEXCOORD_0; 0:
     * that if no texture of the scene uses it, else the first set that no texture uses and no mesh has. A
     * given set suits engines that look for light maps in one; textures that use it lose their places, and
     * are counted.
     */
    int32_t texcoord;
    /**
     * 1 writes tangents of the atlas where there are normals, and the normal map, if there is one, uses the
     * same set. It suits normal maps that are baked for the atlas.
     */
    uint32_t tangents;
} ricci_scene_options;

/** What was written, and what is not as it was. */
typedef struct ricci_scene_report {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** The set of texture coordinates that holds the atlas. */
    size_t texcoord;
    /** Primitives that have it. */
    size_t n_primitives;
    /** Their vertices in the file that was read. */
    size_t n_vertices;
    /** Their vertices in the file that was written. */
    size_t n_split_vertices;
    /** Primitives that had coordinates in this set, which are gone. */
    size_t n_replaced;
    /** Textures of materials that use other sets, which are as they were. */
    size_t n_kept_textures;
    /** Textures that use this set, whose pictures no longer fit: 0 unless the set was asked for. */
    size_t n_misplaced_textures;
    /** Primitives with tangents of the atlas. */
    size_t n_tangents;
    /** Primitives without, though they were asked for: without normals, or with a normal map on another set.
     */
    size_t n_without_tangents;
    /** Primitives whose tangents are gone with the coordinates that they belonged to. */
    size_t n_dropped_tangents;
    /** Strips and fans that became lists of triangles. */
    size_t n_unrolled;
    /** Meshes that several nodes show. */
    size_t n_shared_meshes;
    /** Pictures in files beside the scene that could not move into the file; the log names them. */
    size_t n_notes;
} ricci_scene_report;

/**
 * Read a scene from a .glb or .gltf file, which may be packed by gzip.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (not UTF-8), RICCI_IO, RICCI_PARSE,
 *         RICCI_UNKNOWN_FORMAT (no glTF, or a library built without it), RICCI_TOO_LARGE, RICCI_NO_MEMORY.
 *
 * @param path   file name in UTF-8.
 * @param scene  out: the new handle, to be released by ricci_scene_free.
 */
RICCI_API ricci_status ricci_scene_read(const char *path, ricci_scene **scene);

/**
 * Release a scene.
 *
 * @param scene  the scene, or NULL.
 */
RICCI_API_VOID void ricci_scene_free(ricci_scene *scene);

/**
 * Counts of a scene.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param scene    the scene.
 * @param summary  out: the counts.
 * @param size     sizeof *summary.
 */
RICCI_API ricci_status ricci_scene_summarise(const ricci_scene *scene, ricci_scene_summary *summary,
                                             size_t size);

/**
 * The texture atlas of a scene: one page for all its meshes, with texels of one size in the scene. No chart
 * joins two meshes. The model of the atlas is the list of all triangles, mesh by mesh.
 *
 * The result is the same for any number of threads.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (an option outside its range),
 *         RICCI_LAYOUT (no face has a place, or the page has no room), RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param scene    the scene.
 * @param options  stretch, page and margin, or NULL.
 * @param control  progress and cancellation, or NULL.
 * @param atlas    out: the new handle, to be released by ricci_texture_atlas_free.
 */
RICCI_API ricci_status ricci_scene_texture_atlas(const ricci_scene *scene,
                                                 const ricci_texture_options *options,
                                                 const ricci_control *control, ricci_texture_atlas **atlas);

/**
 * Write a scene with its atlas as .glb. Nodes, cameras, materials, animations, skins, names and extras are as
 * they were; vertices keep their numbers, and those along seams are repeated behind all others, with all
 * attributes and morph targets, bit for bit. All buffers become one, and pictures beside the file move into
 * it.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (an atlas of another number of
 * faces, a set above 7, not UTF-8), RICCI_PARSE (a damaged attribute), RICCI_TOO_LARGE (4 GB), RICCI_IO,
 *         RICCI_NO_MEMORY.
 *
 * @param scene    the scene.
 * @param atlas    an atlas of ricci_scene_texture_atlas.
 * @param options  the set and tangents, or NULL.
 * @param path     file name in UTF-8.
 * @param report   out: what was written.
 * @param size     sizeof *report.
 */
RICCI_API ricci_status ricci_scene_write(const ricci_scene *scene, const ricci_texture_atlas *atlas,
                                         const ricci_scene_options *options, const char *path,
                                         ricci_scene_report *report, size_t size);

/**
 * Write a triangle list with texture coordinates, such as that of an atlas, as .glb with tangents: averages
 * of those of a vertex's corners, weighted by angles. Vertices without normals get averages of those of their
 * faces.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (no texture coordinates, numbers that are not finite,
 * not UTF-8), RICCI_UNKNOWN_FORMAT (a library built without glTF), RICCI_TOO_LARGE, RICCI_IO,
 *         RICCI_NO_MEMORY.
 *
 * @param soup  the triangle list.
 * @param path  file name in UTF-8.
 */
RICCI_API ricci_status ricci_soup_write_with_tangents(const ricci_soup *soup, const char *path);

#ifdef __cplusplus
}
#endif

#endif
