/* Texture atlases through the C face: polygons, coordinates, split vertices, files, refusals. */
#include "check.h"
#include <math.h>
#include <ricci/texture.h>

/* The squares of a cube; then a wing inside it on one of its edges, and a face with two corners in one place.
 */
static const double positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0,  0,   0,   1,
                                   1, 0, 1, 0, 1, 1, 1, 1, 1, 2, 0, -1, 0.5, 0.5, 0.5};
static const uint32_t corners[] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7,
                                   3, 0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 9, 0, 0, 2};
static const size_t starts[] = {0, 4, 8, 12, 16, 20, 24, 27, 30};
enum { VERTICES = 10, POLYGONS = 8, FACES = 14, PLACED = 13 };

static ricci_soup *model(void) {
    ricci_soup *soup = NULL;
    ricci_soup_summary s;
    uint32_t polygons[FACES];
    OK(ricci_soup_from_polygons(positions, 0, VERTICES, corners, starts, POLYGONS, &soup));
    OK(ricci_soup_summarise(soup, &s, sizeof s));
    CHECK(s.n_vertices == VERTICES && s.n_faces == FACES);
    OK(ricci_soup_polygons(soup, polygons, FACES));
    for (uint32_t f = 0; f < FACES; f++) CHECK(polygons[f] == (f < 12 ? f / 2 : f - 6));
    FAILS(ricci_soup_polygons(soup, polygons, FACES - 1), RICCI_BUFFER_TOO_SMALL, "polygons");
    return soup;
}

/* The list, and the number of its faces. */
static size_t list_of(const ricci_texture_atlas *atlas, uint32_t which, uint32_t *faces) {
    if (ricci_texture_atlas_faces(atlas, which, NULL, 0) == RICCI_OK) return 0;
    ricci_failure asked;
    OK(ricci_last_failure(&asked, sizeof asked));
    OK(ricci_texture_atlas_faces(atlas, which, faces, asked.needed));
    return asked.needed;
}

static void check_split(const ricci_texture_atlas *atlas, const ricci_soup *soup, const double *uv) {
    ricci_texture_atlas_summary s;
    uint32_t given[3 * FACES], split[3 * PLACED], faces[PLACED], vertices[3 * PLACED];
    double at[6 * PLACED];
    OK(ricci_texture_atlas_summarise(atlas, &s, sizeof s));
    CHECK(s.n_split_faces == PLACED && s.n_split_vertices > VERTICES - 1 && s.n_split_vertices < 3 * PLACED);
    OK(ricci_soup_faces(soup, given, 3 * FACES));
    OK(ricci_texture_atlas_split(atlas, split, 3 * PLACED, faces, PLACED, vertices, s.n_split_vertices, at,
                                 2 * s.n_split_vertices));
    for (size_t c = 0; c < 3 * PLACED; c++) {
        const size_t corner = 3 * faces[c / 3] + c % 3;
        CHECK(split[c] < s.n_split_vertices && vertices[split[c]] == given[corner]);
        CHECK(at[2 * split[c]] == uv[2 * corner] && at[2 * split[c] + 1] == uv[2 * corner + 1]);
    }
    FAILS(ricci_texture_atlas_split(atlas, split, 3 * PLACED, faces, PLACED, vertices, s.n_split_vertices, at,
                                    2 * s.n_split_vertices - 1),
          RICCI_BUFFER_TOO_SMALL, "uv");
    FAILS(ricci_texture_atlas_split(atlas, split, 3 * PLACED, faces, PLACED - 1, vertices, s.n_split_vertices,
                                    at, 2 * s.n_split_vertices),
          RICCI_BUFFER_TOO_SMALL, "faces");
}

static void makes_an_atlas(const ricci_soup *soup) {
    ricci_texture_atlas *atlas = NULL;
    ricci_texture_options options;
    ricci_texture_atlas_summary s;
    ricci_soup *textured = NULL, *back = NULL;
    ricci_soup_summary read;
    double uv[6 * FACES], again[6 * FACES];
    uint32_t charts[FACES], list[FACES];
    INIT(options);
    options.page = 64, options.fill = -1, options.threads = 1;
    OK(ricci_texture_atlas_new(soup, &options, NULL, &atlas));
    OK(ricci_texture_atlas_summarise(atlas, &s, sizeof s));
    CHECK(s.n_faces == FACES && s.n_sheets == 2 && s.n_opened_edges == 1 && s.page == 64);
    CHECK(s.n_placeless == 1 && s.n_folded == 0 && s.n_overlapping == 0 && s.n_turned == 0);
    /* The cube and the wing are flat. */
    CHECK(s.n_charts == 2 && s.stretch_max < 1.01 && s.stretch_l2 < 1.001 && s.fill > 0.2 && s.fill < 1);
    OK(ricci_texture_atlas_uv(atlas, uv, 6 * FACES));
    OK(ricci_texture_atlas_charts(atlas, charts, FACES));
    for (size_t f = 0; f < FACES; f++) {
        const double *p = uv + 6 * f;
        const double area = (p[2] - p[0]) * (p[5] - p[1]) - (p[3] - p[1]) * (p[4] - p[0]);
        CHECK(f == 13 ? charts[f] == UINT32_MAX && area == 0 : charts[f] == (f < 12 ? 0 : 1) && area > 0);
        for (size_t k = 0; k < 6; k++) {
            CHECK(p[k] >= 0 && p[k] < 1 && ldexp(p[k], 24) == floor(ldexp(p[k], 24)));
        }
    }
    CHECK(list_of(atlas, RICCI_TEXTURE_PLACELESS, list) == 1 && list[0] == 13);
    CHECK(list_of(atlas, RICCI_TEXTURE_FOLDED, list) == 0 && list_of(atlas, RICCI_TEXTURE_TURNED, list) == 0);
    CHECK(list_of(atlas, RICCI_TEXTURE_OVERLAPPING, list) == 0);
    FAILS(ricci_texture_atlas_faces(atlas, 4, list, FACES), RICCI_ARGUMENT, "RICCI_TEXTURE_TURNED");
    FAILS(ricci_texture_atlas_uv(atlas, uv, 6 * FACES - 1), RICCI_BUFFER_TOO_SMALL, "uv");
    FAILS(ricci_texture_atlas_charts(atlas, charts, FACES - 1), RICCI_BUFFER_TOO_SMALL, "charts");
    check_split(atlas, soup, uv);
    /* What is written is read with the same coordinates. */
    OK(ricci_texture_atlas_soup(atlas, &textured));
    ricci_texture_atlas_free(atlas);
    OK(ricci_soup_write(textured, "texture.obj"));
    OK(ricci_soup_read("texture.obj", &back));
    OK(ricci_soup_summarise(back, &read, sizeof read));
    CHECK(read.n_vertices == VERTICES && read.n_faces == FACES && read.n_uv == FACES);
    OK(ricci_soup_values(back, RICCI_UV, again, 6 * FACES));
    CHECK(memcmp(uv, again, sizeof uv) == 0);
    FAILS(ricci_soup_polygons(back, list, FACES), RICCI_ARGUMENT, "polygons");
    ricci_soup_free(back), ricci_soup_free(textured);
}

/* Two squares of side 1 beside each other at 40 texels for a unit do not fit on a page of 64, nor do both
 * apart. */
static void fills_pages(void) {
    static const double plate[] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0};
    static const uint32_t halves[] = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};
    ricci_soup *soup = NULL;
    ricci_texture_atlas *atlas = NULL;
    ricci_texture_options options;
    ricci_texture_atlas_summary s;
    double uv[24];
    uint32_t pages[4];
    OK(ricci_soup_from_arrays(plate, 0, 6, halves, 4, &soup));
    INIT(options);
    options.page = 64, options.density = 25, options.threads = 1;
    OK(ricci_texture_atlas_new(soup, &options, NULL, &atlas));
    OK(ricci_texture_atlas_summarise(atlas, &s, sizeof s));
    CHECK(s.n_pages == 1 && s.n_charts == 1 && fabs(s.texel_density - 25) < 1e-3);
    ricci_texture_atlas_free(atlas);
    options.density = 40;
    OK(ricci_texture_atlas_new(soup, &options, NULL, &atlas));
    OK(ricci_texture_atlas_summarise(atlas, &s, sizeof s));
    OK(ricci_texture_atlas_uv(atlas, uv, 24));
    OK(ricci_texture_atlas_pages(atlas, pages, 4));
    CHECK(s.n_pages == 2 && s.n_charts > 1 && fabs(s.texel_density - 40) < 1e-3);
    for (size_t k = 0; k < 24; k += 2) {
        CHECK(floor(uv[k]) == pages[k / 6] && floor(uv[k + 1]) == 0);
        CHECK(ldexp(uv[k], 20) == floor(ldexp(uv[k], 20)));
    }
    FAILS(ricci_texture_atlas_pages(atlas, pages, 3), RICCI_BUFFER_TOO_SMALL, "pages");
    ricci_texture_atlas_free(atlas), atlas = NULL;
    options.density = 200;
    FAILS(ricci_texture_atlas_new(soup, &options, NULL, &atlas), RICCI_LAYOUT, "larger than a page");
    ricci_soup_free(soup);
}

static void refuses(const ricci_soup *soup) {
    ricci_texture_atlas *none = NULL;
    ricci_soup *nothing = NULL, *list = NULL;
    ricci_texture_options options;
    INIT(options);
    options.page = 100;
    FAILS(ricci_texture_atlas_new(soup, &options, NULL, &none), RICCI_ARGUMENT, "page");
    options.page = 64, options.margin = 9;
    FAILS(ricci_texture_atlas_new(soup, &options, NULL, &none), RICCI_ARGUMENT, "margin");
    options.margin = -1, options.stretch = 1;
    FAILS(ricci_texture_atlas_new(soup, &options, NULL, &none), RICCI_ARGUMENT, "stretch");
    options.stretch = 0, options.fill = NAN;
    FAILS(ricci_texture_atlas_new(soup, &options, NULL, &none), RICCI_ARGUMENT, "fill");
    options.fill = 0, options.density = -1;
    FAILS(ricci_texture_atlas_new(soup, &options, NULL, &none), RICCI_ARGUMENT, "density");
    FAILS(ricci_texture_atlas_new(NULL, NULL, NULL, &none), RICCI_NULL_POINTER, "soup");
    FAILS(ricci_texture_atlas_new(soup, NULL, NULL, NULL), RICCI_NULL_POINTER, "texture atlas");
    OK(ricci_soup_from_polygons(positions, 0, VERTICES, corners + 27, starts, 0, &nothing));
    FAILS(ricci_texture_atlas_new(nothing, NULL, NULL, &none), RICCI_LAYOUT, "no face");
    const size_t back[] = {0, 4, 3}, late[] = {1, 4};
    FAILS(ricci_soup_from_polygons(positions, 0, VERTICES, corners, back, 2, &list), RICCI_ARGUMENT,
          "starts[2]");
    FAILS(ricci_soup_from_polygons(positions, 0, VERTICES, corners, late, 1, &list), RICCI_ARGUMENT,
          "starts[0]");
    FAILS(ricci_soup_from_polygons(positions, 0, VERTICES, NULL, starts, 2, &list), RICCI_NULL_POINTER,
          "corners");
    FAILS(ricci_soup_from_polygons(positions, 8, VERTICES, corners, starts, 2, &list), RICCI_ARGUMENT,
          "stride");
    CHECK(none == NULL && list == NULL);
    ricci_soup_free(nothing);
    ricci_texture_atlas_free(NULL);
}

int main(void) {
    ricci_soup *soup = model();
    makes_an_atlas(soup);
    fills_pages();
    refuses(soup);
    ricci_soup_free(soup);
    return 0;
}
