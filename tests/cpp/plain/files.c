/* A torus with attributes goes through every format and comes back. */
#include "torus.h"
#include <ricci/repair.h>

static torus t;
static double *normals, *colors, *uv;

/* The mesh of a file is the torus, with what that format keeps of its attributes. */
static void compare(const char *path, double positions_off, int uv_kept) {
    ricci_mesh *mesh = NULL;
    ricci_mesh_summary size;
    double *numbers = (double *)malloc(6 * t.n_faces * sizeof *numbers);
    uint32_t *faces = (uint32_t *)malloc(3 * t.n_faces * sizeof *faces);
    CHECK(numbers && faces);
    OK(ricci_mesh_read(path, &mesh));
    OK(ricci_mesh_summarise(mesh, &size, sizeof size));
    CHECK(size.n_vertices == t.n_vertices && size.n_faces == t.n_faces && size.genus == 1);
    CHECK(size.n_normals == t.n_vertices && size.n_colors == t.n_vertices);
    CHECK(size.n_uv == (uv_kept ? t.n_faces : 0));
    OK(ricci_mesh_faces(mesh, faces, 3 * t.n_faces));
    CHECK(memcmp(faces, t.faces, 3 * t.n_faces * sizeof *faces) == 0);
    OK(ricci_mesh_values(mesh, RICCI_POSITIONS, numbers, 3 * t.n_vertices));
    for (size_t k = 0; k < 3 * t.n_vertices; k++) CHECK(fabs(numbers[k] - t.positions[k]) <= positions_off);
    FAILS(ricci_mesh_values(mesh, RICCI_NORMALS, numbers, 3), RICCI_BUFFER_TOO_SMALL, "values");
    OK(ricci_mesh_values(mesh, RICCI_NORMALS, numbers, 3 * t.n_vertices));
    for (size_t k = 0; k < 3 * t.n_vertices; k++) CHECK(fabs(numbers[k] - normals[k]) <= 1e-7);
    OK(ricci_mesh_values(mesh, RICCI_COLORS, numbers, 4 * t.n_vertices));
    /* Bytes, six decimals or floats. */
    for (size_t k = 0; k < 4 * t.n_vertices; k++) CHECK(fabs(numbers[k] - colors[k]) <= 1 / 509.0);
    if (uv_kept) {
        OK(ricci_mesh_values(mesh, RICCI_UV, numbers, 6 * t.n_faces));
        for (size_t k = 0; k < 6 * t.n_faces; k++) CHECK(fabs(numbers[k] - uv[k]) <= 1e-7);
    } else {
        FAILS(ricci_mesh_values(mesh, RICCI_UV, numbers, 6 * t.n_faces), RICCI_ARGUMENT, "uv");
    }
    /* A mesh that was read is written unchanged. */
    OK(ricci_mesh_write(mesh, NULL, "again.ply"));
    ricci_mesh_free(mesh);
    mesh = NULL;
    OK(ricci_mesh_read("again.ply", &mesh));
    OK(ricci_mesh_summarise(mesh, &size, sizeof size));
    CHECK(size.n_normals == t.n_vertices && size.n_uv == (uv_kept ? t.n_faces : 0));
    ricci_mesh_free(mesh);
    free(numbers);
    free(faces);
}

static int warnings = 0;

static void listen(uint32_t level, const char *message, void *user_data) {
    (void)user_data;
    warnings += level == RICCI_LOG_WARN && strstr(message, "seams") != NULL;
}

/* Normals of corners, each its own, through OBJ. */
static void hard_edges(const ricci_mesh *mesh) {
    const size_t count = 9 * t.n_faces;
    ricci_mesh *read = NULL;
    ricci_attributes attributes;
    ricci_mesh_summary size;
    double *given = (double *)malloc(count * sizeof *given), *got = (double *)malloc(count * sizeof *got);
    CHECK(given && got);
    for (size_t k = 0; k < count; k++) given[k] = (double)k;
    INIT(attributes);
    attributes.corner_normals = given;
    OK(ricci_mesh_write(mesh, &attributes, "hard.obj"));
    OK(ricci_mesh_read("hard.obj", &read));
    OK(ricci_mesh_summarise(read, &size, sizeof size));
    CHECK(size.n_vertices == t.n_vertices && size.n_normals == 0 && size.n_corner_normals == t.n_faces);
    FAILS(ricci_mesh_values(read, RICCI_CORNER_NORMALS, got, count - 1), RICCI_BUFFER_TOO_SMALL, "values");
    OK(ricci_mesh_values(read, RICCI_CORNER_NORMALS, got, count));
    CHECK(memcmp(given, got, count * sizeof *got) == 0);
    FAILS(ricci_mesh_values(mesh, RICCI_CORNER_NORMALS, got, count), RICCI_ARGUMENT, "corner normals");
    ricci_mesh_free(read);
    free(given);
    free(got);
}

/* Two triangles with a slit between them, as ascii STL. */
static void welded(void) {
    static const char *const text = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                                    "vertex 1 1 0\nendloop\nendfacet\nfacet normal 0 0 1\nouter loop\n"
                                    "vertex 0.001 0 0\nvertex 1.001 1 0\nvertex 0 1 0\nendloop\nendfacet\n"
                                    "endsolid s\n";
    ricci_mesh *mesh = NULL;
    ricci_soup *soup = NULL, *welded_soup = NULL;
    ricci_repair_options options;
    ricci_mesh_summary size;
    FILE *file = fopen("slit.stl", "w");
    CHECK(file && fputs(text, file) >= 0 && fclose(file) == 0);
    FAILS(ricci_mesh_read("slit.stl", &mesh), RICCI_DEFECTS, "components");
    FAILS(ricci_soup_read(NULL, &soup), RICCI_NULL_POINTER, "path");
    OK(ricci_soup_read("slit.stl", &soup));
    FAILS(ricci_soup_mesh(soup, &mesh), RICCI_DEFECTS, "components");
    CHECK(mesh == NULL);
    INIT(options);
    options.weld = 0.002;
    OK(ricci_soup_repair(soup, &options, &welded_soup));
    OK(ricci_soup_mesh(welded_soup, &mesh));
    ricci_soup_free(soup), ricci_soup_free(welded_soup);
    OK(ricci_mesh_summarise(mesh, &size, sizeof size));
    CHECK(size.n_vertices == 4 && size.n_faces == 2);
    CHECK(size.n_normals == 0 && size.n_colors == 0 && size.n_uv == 0);
    ricci_mesh_free(mesh);
}

/* A thread's control serves calls that have no argument for one. */
static void reading_and_writing_have_a_control(const ricci_mesh *mesh) {
    ricci_control *control = NULL;
    ricci_mesh *read = NULL;
    uint32_t stage;
    double fraction;
    OK(ricci_control_new(&control));
    OK(ricci_control_use(control));
    OK(ricci_mesh_read("files.ply", &read));
    OK(ricci_control_progress(control, &stage, &fraction, NULL));
    CHECK(stage == RICCI_STAGE_BUILD && fraction == 1);
    /* A part of a host's bar: progress does not begin again. */
    OK(ricci_control_part(control, 0.25, 0.5));
    OK(ricci_mesh_write(mesh, NULL, "used.ply"));
    OK(ricci_control_progress(control, &stage, &fraction, NULL));
    CHECK(stage == RICCI_STAGE_WRITE && fraction == 1);
    FAILS(ricci_control_part(control, 0.5, 0.25), RICCI_ARGUMENT, "0.5");
    FAILS(ricci_control_part(control, 0, NAN), RICCI_ARGUMENT, "NaN");
    OK(ricci_control_cancel(control));
    ricci_mesh_free(read);
    read = NULL;
    FAILS(ricci_mesh_read("files.ply", &read), RICCI_CANCELLED, "cancelled");
    FAILS(ricci_mesh_write(mesh, NULL, "used.ply"), RICCI_CANCELLED, "cancelled");
    OK(ricci_control_use(NULL));
    OK(ricci_mesh_read("used.ply", &read));
    ricci_mesh_free(read);
    ricci_control_free(control);
    /* A part that a call fills, with nothing done before. */
    ricci_metric *metric = NULL, *flat = NULL;
    OK(ricci_control_new(&control));
    OK(ricci_control_part(control, 0, 0.5));
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(ricci_flow(metric, NULL, NULL, control, &flat));
    OK(ricci_control_progress(control, &stage, &fraction, NULL));
    CHECK(fraction == 0.5);
    ricci_metric_free(metric), ricci_metric_free(flat), ricci_control_free(control);
}

int main(void) {
    ricci_mesh *mesh = NULL, *read = NULL;
    ricci_attributes attributes;
    ricci_mesh_summary size;
    double few[3];
    t = torus_new(12, 8);
    normals = (double *)malloc(3 * t.n_vertices * sizeof *normals);
    colors = (double *)malloc(4 * t.n_vertices * sizeof *colors);
    uv = (double *)malloc(6 * t.n_faces * sizeof *uv);
    CHECK(normals && colors && uv);
    for (size_t v = 0; v < t.n_vertices; v++) {
        const double a = 0.7 * (double)v, n[3] = {cos(a), 0.6 * sin(a), 0.8 * sin(a)};
        for (int k = 0; k < 3; k++) normals[3 * v + k] = n[k];
        for (int k = 0; k < 4; k++) colors[4 * v + k] = k == 3 ? 1 : fmod((double)(v + k) / 7, 1);
    }
    /* One pair per vertex: then OFF and GLB keep it too. */
    for (size_t k = 0; k < 3 * t.n_faces; k++) {
        uv[2 * k] = (double)(t.faces[k] % 8) / 8;
        uv[2 * k + 1] = (double)t.faces[k] / (double)t.n_vertices;
    }
    mesh = torus_mesh(&t);
    INIT(attributes);
    CHECK(attributes.normals == NULL && attributes.colors == NULL && attributes.uv == NULL);
    attributes.normals = normals;
    attributes.colors = colors;
    attributes.uv = uv;
    OK(ricci_mesh_write(mesh, &attributes, "files.ply"));
    OK(ricci_mesh_write(mesh, &attributes, "files.off"));
    OK(ricci_mesh_write(mesh, &attributes, "files.OBJ"));
    OK(ricci_mesh_write(mesh, &attributes, "files.glb"));
    compare("files.ply", 0, 1);
    compare("files.off", 0, 1);
    compare("files.OBJ", 0, 1);
    compare("files.glb", 3e-7, 1);

    /* A seam: the last face has a place of its own in the texture, which OFF cannot say and GLB says by more
     * vertices, of which there are as many as before when it is read. */
    uv[6 * t.n_faces - 1] += 0.5;
    OK(ricci_log_set(listen, NULL, RICCI_LOG_WARN));
    OK(ricci_mesh_write(mesh, &attributes, "files.glb"));
    compare("files.glb", 3e-7, 1);
    CHECK(warnings == 0);
    OK(ricci_mesh_write(mesh, &attributes, "files.off"));
    CHECK(warnings == 1);
    OK(ricci_log_set(NULL, NULL, RICCI_LOG_WARN));
    compare("files.off", 0, 0);
    OK(ricci_mesh_write(mesh, &attributes, "files.ply"));
    compare("files.ply", 0, 1);

    /* Nothing was read with this mesh, so nothing is written with it. */
    OK(ricci_mesh_write(mesh, NULL, "plain.ply"));
    OK(ricci_mesh_read("plain.ply", &read));
    OK(ricci_mesh_summarise(read, &size, sizeof size));
    CHECK(size.n_normals == 0 && size.n_colors == 0 && size.n_uv == 0);
    FAILS(ricci_mesh_values(read, RICCI_NORMALS, few, 3), RICCI_ARGUMENT, "normals");
    FAILS(ricci_mesh_values(read, RICCI_COLORS, few, 3), RICCI_ARGUMENT, "colors");
    ricci_mesh_free(read);

    FAILS(ricci_mesh_write(mesh, NULL, "files.stl"), RICCI_UNKNOWN_FORMAT, ".glb");
    FAILS(ricci_mesh_write(mesh, NULL, "no such folder/x.ply"), RICCI_IO, "no such folder");
    FAILS(ricci_mesh_write(mesh, NULL, NULL), RICCI_NULL_POINTER, "path");
    FAILS(ricci_mesh_write(NULL, NULL, "x.ply"), RICCI_NULL_POINTER, "mesh");
    attributes.size = 7;
    FAILS(ricci_mesh_write(mesh, &attributes, "x.ply"), RICCI_STRUCT_SIZE, "attributes");
    attributes.size = sizeof attributes;
    normals[4] = NAN;
    FAILS(ricci_mesh_write(mesh, &attributes, "x.ply"), RICCI_ARGUMENT, "normal");

    welded();
    hard_edges(mesh);
    reading_and_writing_have_a_control(mesh);
    ricci_mesh_free(mesh);
    free(normals);
    free(colors);
    free(uv);
    torus_free(&t);
    return 0;
}
