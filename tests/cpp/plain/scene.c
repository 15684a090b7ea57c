/* Scenes of glTF through the C face: read, atlas, file, what is not as it was, refusals. */
#include "check.h"
#include <ricci/scene.h>

/* A cube of 8 vertices, as the library's own writer makes a scene of it: one node, one mesh, one material. */
enum { VERTICES = 8, FACES = 12 };
static const double positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1};
static const uint32_t faces[] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};

/* Each face of both lists has its corners in the same places. */
static void check_places(const ricci_soup *one, const ricci_soup *other) {
    double p[3 * VERTICES], q[3 * 3 * FACES];
    uint32_t f[3 * FACES], g[3 * FACES];
    OK(ricci_soup_values(one, RICCI_POSITIONS, p, 3 * VERTICES));
    OK(ricci_soup_values(other, RICCI_POSITIONS, q, 3 * 3 * FACES));
    OK(ricci_soup_faces(one, f, 3 * FACES));
    OK(ricci_soup_faces(other, g, 3 * FACES));
    for (size_t c = 0; c < 3 * FACES; c++) {
        CHECK(memcmp(p + 3 * f[c], q + 3 * g[c], 3 * sizeof *p) == 0);
    }
}

static ricci_soup *cube(void) {
    ricci_soup *bare = NULL, *soup = NULL;
    ricci_attributes attributes;
    double normals[3 * VERTICES];
    for (size_t k = 0; k < 3 * VERTICES; k++) normals[k] = 2 * positions[k] - 1;
    OK(ricci_soup_from_arrays(positions, 0, VERTICES, faces, FACES, &bare));
    INIT(attributes);
    attributes.normals = normals;
    OK(ricci_soup_with_attributes(bare, &attributes, &soup));
    ricci_soup_free(bare);
    return soup;
}

static void keeps_the_scene(const ricci_soup *soup) {
    ricci_scene *scene = NULL, *again = NULL;
    ricci_scene_summary s;
    ricci_scene_options options;
    ricci_scene_report report;
    ricci_texture_options page;
    ricci_texture_atlas *atlas = NULL;
    ricci_soup *back = NULL;
    OK(ricci_soup_write(soup, "scene.glb"));
    OK(ricci_scene_read("scene.glb", &scene));
    OK(ricci_scene_summarise(scene, &s, sizeof s));
    CHECK(s.n_nodes == 1 && s.n_meshes == 1 && s.n_primitives == 1 && s.n_materials == 1);
    CHECK(s.n_vertices == VERTICES && s.n_faces == FACES);
    INIT(page);
    page.page = 64, page.fill = -1, page.threads = 1;
    OK(ricci_scene_texture_atlas(scene, &page, NULL, &atlas));
    OK(ricci_scene_write(scene, atlas, NULL, "scene_atlas.glb", &report, sizeof report));
    CHECK(report.texcoord == 0 && report.n_primitives == 1 && report.n_vertices == VERTICES);
    /* A cube that is cut open along a tree of 7 edges has 14 corners. */
    CHECK(report.n_split_vertices == 14 && report.n_replaced == 0 && report.n_tangents == 0);
    OK(ricci_soup_read("scene_atlas.glb", &back));
    check_places(soup, back);
    ricci_soup_free(back);
    INIT(options);
    options.texcoord = 1, options.tangents = 1;
    OK(ricci_scene_write(scene, atlas, &options, "scene_atlas.glb", &report, sizeof report));
    CHECK(report.texcoord == 1 && report.n_tangents == 1 && report.n_without_tangents == 0);
    OK(ricci_scene_read("scene_atlas.glb", &again));
    OK(ricci_scene_summarise(again, &s, sizeof s));
    CHECK(s.n_vertices == 14 && s.n_faces == FACES);
    options.texcoord = 8;
    FAILS(ricci_scene_write(scene, atlas, &options, "scene_atlas.glb", &report, sizeof report),
          RICCI_ARGUMENT, "texcoord");
    FAILS(ricci_scene_write(scene, atlas, NULL, "scene_atlas.glb", NULL, sizeof report), RICCI_NULL_POINTER,
          "report");
    FAILS(ricci_scene_write(scene, NULL, NULL, "scene_atlas.glb", &report, sizeof report), RICCI_NULL_POINTER,
          "texture atlas");
    ricci_texture_atlas_free(atlas), atlas = NULL;
    page.page = 100;
    FAILS(ricci_scene_texture_atlas(scene, &page, NULL, &atlas), RICCI_ARGUMENT, "page");
    ricci_scene_free(again), ricci_scene_free(scene);
}

/* A list without normals gets them with its tangents; one without coordinates has none. */
static void writes_tangents(void) {
    ricci_soup *bare = NULL, *textured = NULL, *back = NULL;
    ricci_soup_summary s;
    ricci_texture_options page;
    ricci_texture_atlas *atlas = NULL;
    OK(ricci_soup_from_arrays(positions, 0, VERTICES, faces, FACES, &bare));
    FAILS(ricci_soup_write_with_tangents(bare, "tangents.glb"), RICCI_ARGUMENT, "tangents");
    INIT(page);
    page.page = 64, page.fill = -1, page.threads = 1;
    OK(ricci_texture_atlas_new(bare, &page, NULL, &atlas));
    OK(ricci_texture_atlas_soup(atlas, &textured));
    OK(ricci_soup_write_with_tangents(textured, "tangents.glb"));
    OK(ricci_soup_read("tangents.glb", &back));
    OK(ricci_soup_summarise(back, &s, sizeof s));
    CHECK(s.n_faces == FACES && s.n_uv == FACES && s.n_normals + s.n_corner_normals > 0);
    check_places(bare, back);
    ricci_soup_free(back), ricci_soup_free(textured), ricci_texture_atlas_free(atlas), ricci_soup_free(bare);
}

static void refuses(const ricci_soup *soup) {
    ricci_scene *scene = NULL;
    ricci_soup *less = NULL;
    ricci_texture_options page;
    ricci_texture_atlas *other = NULL;
    ricci_scene_report report;
    OK(ricci_soup_write(soup, "scene.obj"));
    FAILS(ricci_scene_read("scene.obj", &scene), RICCI_UNKNOWN_FORMAT, "glb");
    FAILS(ricci_scene_read("no such scene.glb", &scene), RICCI_IO, "no such scene");
    OK(ricci_scene_read("scene.glb", &scene));
    INIT(page);
    page.page = 64, page.fill = -1, page.threads = 1;
    OK(ricci_soup_from_arrays(positions, 0, VERTICES, faces, 2, &less));
    OK(ricci_texture_atlas_new(less, &page, NULL, &other));
    FAILS(ricci_scene_write(scene, other, NULL, "scene_atlas.glb", &report, sizeof report), RICCI_ARGUMENT,
          "atlas");
    ricci_texture_atlas_free(other), ricci_soup_free(less);
    ricci_scene_free(scene), ricci_scene_free(NULL);
}

int main(void) {
    ricci_soup *soup = cube();
    keeps_the_scene(soup);
    writes_tangents();
    refuses(soup);
    ricci_soup_free(soup);
    return 0;
}
