/* Whatever a caller passes, a call answers with a status: it does not crash, and it leaves its outputs alone.
 * Writes arguments.obj, which other tests read. */
#include "torus.h"

static void null_pointers_are_errors(const torus *t) {
    ricci_mesh *mesh = torus_mesh(t);
    ricci_mesh *untouched = (ricci_mesh *)&mesh;
    ricci_mesh_summary summary;
    double x[3];
    FAILS(ricci_mesh_from_arrays(NULL, 0, t->n_vertices, t->faces, t->n_faces, &untouched),
          RICCI_NULL_POINTER, "positions");
    FAILS(ricci_mesh_from_arrays(t->positions, 0, t->n_vertices, NULL, t->n_faces, &untouched),
          RICCI_NULL_POINTER, "faces");
    FAILS(ricci_mesh_from_arrays(t->positions, 0, t->n_vertices, t->faces, t->n_faces, NULL),
          RICCI_NULL_POINTER, "mesh");
    FAILS(ricci_mesh_read(NULL, &untouched), RICCI_NULL_POINTER, "path");
    FAILS(ricci_mesh_read("no such file.obj", &untouched), RICCI_IO, "no such file.obj");
    FAILS(ricci_mesh_read("no_such.format", &untouched), RICCI_UNKNOWN_FORMAT, "no_such.format");
    CHECK(untouched == (ricci_mesh *)&mesh);
    FAILS(ricci_mesh_summarise(NULL, &summary, sizeof summary), RICCI_NULL_POINTER, "mesh");
    FAILS(ricci_mesh_summarise(mesh, NULL, sizeof summary), RICCI_NULL_POINTER, "summary");
    FAILS(ricci_mesh_positions(mesh, NULL, 3 * t->n_vertices), RICCI_NULL_POINTER, "positions");
    FAILS(ricci_mesh_positions(mesh, x, 3), RICCI_BUFFER_TOO_SMALL, "positions");
    FAILS(ricci_metric_new(NULL, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, NULL), RICCI_NULL_POINTER, "metric");
    FAILS(ricci_flow(NULL, NULL, 0, NULL, NULL, NULL, NULL), RICCI_NULL_POINTER, "result");
    FAILS(ricci_solver_new(NULL, NULL, NULL), RICCI_NULL_POINTER, "solver");
    FAILS(ricci_layout_new(NULL, NULL, 0, NULL, NULL), RICCI_NULL_POINTER, "layout");
    FAILS(ricci_control_cancel(NULL), RICCI_NULL_POINTER, "control");
    FAILS(ricci_flow_options_init(NULL, sizeof(ricci_flow_options)), RICCI_NULL_POINTER, "options");
    ricci_mesh_free(mesh);

    ricci_mesh_free(NULL);
    ricci_diagnosis_free(NULL);
    ricci_metric_free(NULL);
    ricci_solver_free(NULL);
    ricci_report_free(NULL);
    ricci_layout_free(NULL);
    ricci_control_free(NULL);
}

static void impossible_counts_are_errors(const torus *t) {
    ricci_mesh *mesh = NULL;
    const size_t huge = (size_t)-1;
    FAILS(ricci_mesh_from_arrays(t->positions, 0, huge, t->faces, t->n_faces, &mesh), RICCI_TOO_LARGE,
          "positions");
    FAILS(ricci_mesh_from_arrays(t->positions, huge, 2, t->faces, t->n_faces, &mesh), RICCI_TOO_LARGE,
          "positions");
    FAILS(ricci_mesh_from_arrays(t->positions, 0, t->n_vertices, t->faces, huge / 8, &mesh), RICCI_TOO_LARGE,
          "faces");
    FAILS(ricci_mesh_from_arrays(t->positions, 16, t->n_vertices, t->faces, t->n_faces, &mesh),
          RICCI_ARGUMENT, "stride");
    FAILS(ricci_mesh_from_arrays(t->positions, 0, 3, t->faces, t->n_faces, &mesh), RICCI_DEFECTS, "");
    CHECK(ricci_mesh_from_arrays(t->positions, 0, t->n_vertices, t->faces, 0, &mesh) != RICCI_OK);
    CHECK(mesh == NULL);
}

static void numbers_that_are_no_enum_are_errors(const torus *t) {
    ricci_mesh *mesh = torus_mesh(t);
    ricci_metric *metric = NULL;
    FAILS(ricci_metric_new(mesh, (ricci_scheme)77, RICCI_SPACE_E2, &metric), RICCI_ARGUMENT, "scheme is 77");
    FAILS(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, (ricci_space)-1, &metric), RICCI_ARGUMENT,
          "space is -1");
    CHECK(strcmp(ricci_status_text((ricci_status)-5), "unknown status") == 0);
    CHECK(strcmp(ricci_stop_reason_text((ricci_stop_reason)99), "unknown") == 0);
    ricci_mesh_free(mesh);
}

static void strided_positions_give_the_same_mesh(const torus *t) {
    /* Six doubles per vertex, and not even aligned. */
    const size_t stride = 6 * sizeof(double);
    char *wide = (char *)malloc(t->n_vertices * stride + 1);
    const size_t n = 3 * t->n_vertices;
    double *a = (double *)malloc(n * sizeof *a), *b = (double *)malloc(n * sizeof *b);
    ricci_mesh *tight = torus_mesh(t), *loose = NULL;
    CHECK(wide && a && b);
    for (size_t v = 0; v < t->n_vertices; v++)
        memcpy(wide + 1 + v * stride, t->positions + 3 * v, 3 * sizeof(double));
    OK(ricci_mesh_from_arrays((const double *)(void *)(wide + 1), stride, t->n_vertices, t->faces, t->n_faces,
                              &loose));
    OK(ricci_mesh_positions(tight, a, n));
    OK(ricci_mesh_positions(loose, b, n));
    CHECK(memcmp(a, b, n * sizeof *a) == 0);
    ricci_mesh_free(tight);
    ricci_mesh_free(loose);
    free(wide);
    free(a);
    free(b);
}

static void int32_faces_are_read_and_negative_ones_named(const torus *t) {
    int32_t *faces = (int32_t *)malloc(3 * t->n_faces * sizeof *faces);
    uint32_t *back = (uint32_t *)malloc(3 * t->n_faces * sizeof *back);
    ricci_mesh *mesh = NULL;
    CHECK(faces && back);
    for (size_t i = 0; i < 3 * t->n_faces; i++) faces[i] = (int32_t)t->faces[i];
    OK(ricci_mesh_from_arrays_i32(t->positions, 0, t->n_vertices, faces, t->n_faces, &mesh));
    OK(ricci_mesh_faces(mesh, back, 3 * t->n_faces));
    CHECK(memcmp(back, t->faces, 3 * t->n_faces * sizeof *back) == 0);
    ricci_mesh_free(mesh);
    mesh = NULL;
    faces[3 * 7 + 2] = -4;
    FAILS(ricci_mesh_from_arrays_i32(t->positions, 0, t->n_vertices, faces, t->n_faces, &mesh),
          RICCI_ARGUMENT, "face 7, corner 2: vertex -4");
    CHECK(mesh == NULL);
    free(faces);
    free(back);
}

static void structs_of_older_versions_are_filled_and_unknown_sizes_refused(const torus *t) {
    ricci_mesh *mesh = torus_mesh(t);
    ricci_metric *metric = NULL, *flat = NULL;
    ricci_mesh_summary summary;
    ricci_flow_options options;
    double *target = (double *)malloc(t->n_vertices * sizeof *target);
    CHECK(target);
    memset(&summary, 0x5a, sizeof summary);
    OK(ricci_mesh_summarise(mesh, &summary, offsetof(ricci_mesh_summary, n_faces)));
    CHECK(summary.size == offsetof(ricci_mesh_summary, n_faces));
    CHECK(summary.n_vertices == t->n_vertices && summary.n_edges == 3 * t->n_vertices);
    CHECK(summary.n_faces == (size_t)0x5a5a5a5a5a5a5a5a);
    FAILS(ricci_mesh_summarise(mesh, &summary, 0), RICCI_STRUCT_SIZE, "size 0");
    FAILS(ricci_mesh_summarise(mesh, &summary, sizeof summary - 1), RICCI_STRUCT_SIZE, "sizeof");
    OK(ricci_mesh_summarise(mesh, &summary, sizeof summary));
    CHECK(summary.size == sizeof summary && summary.n_faces == t->n_faces);
    CHECK(summary.euler == 0 && summary.genus == 1 && summary.n_boundary_loops == 0);

    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(ricci_target_default(metric, target, t->n_vertices));
    FAILS(ricci_flow_options_init(&options, 0), RICCI_STRUCT_SIZE, "size 0");
    /* An older caller: knows nothing from `threads` on, whose bytes are not options at all. */
    memset(&options, 0x5a, sizeof options);
    OK(ricci_flow_options_init(&options, offsetof(ricci_flow_options, threads)));
    CHECK(options.size == offsetof(ricci_flow_options, threads) && options.tolerance == 1e-10);
    OK(ricci_flow(metric, target, t->n_vertices, &options, NULL, &flat, NULL));
    ricci_metric_free(flat);
    flat = NULL;
    options.size = 0;
    FAILS(ricci_flow(metric, target, t->n_vertices, &options, NULL, &flat, NULL), RICCI_STRUCT_SIZE,
          "size 0");
    /* A newer caller: its new field is zero, or not. */
    struct {
        ricci_flow_options known;
        double added;
    } newer;
    OK(ricci_flow_options_init(&newer.known, sizeof newer.known));
    newer.known.size = sizeof newer;
    newer.added = 0;
    OK(ricci_flow(metric, target, t->n_vertices, &newer.known, NULL, &flat, NULL));
    ricci_metric_free(flat);
    flat = NULL;
    newer.added = 1;
    FAILS(ricci_flow(metric, target, t->n_vertices, &newer.known, NULL, &flat, NULL), RICCI_STRUCT_SIZE,
          "does not know");
    CHECK(flat == NULL);
    ricci_metric_free(metric);
    ricci_mesh_free(mesh);
    free(target);
}

static void options_out_of_range_are_errors(const torus *t) {
    ricci_mesh *mesh = torus_mesh(t);
    ricci_metric *metric = NULL, *flat = NULL;
    ricci_flow_options options;
    double *target = (double *)malloc(t->n_vertices * sizeof *target);
    CHECK(target);
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(ricci_target_uniform(metric, target, t->n_vertices));
    OK(ricci_flow_options_init(&options, sizeof options));
    options.method = (ricci_method)5;
    FAILS(ricci_flow(metric, target, t->n_vertices, &options, NULL, &flat, NULL), RICCI_ARGUMENT,
          "method is 5");
    options.method = RICCI_METHOD_NEWTON;
    options.tolerance = -1;
    FAILS(ricci_flow(metric, target, t->n_vertices, &options, NULL, &flat, NULL), RICCI_ARGUMENT,
          "tolerance");
    options.tolerance = 0;
    FAILS(ricci_flow(metric, target, t->n_vertices, &options, NULL, &flat, NULL), RICCI_ARGUMENT,
          "tolerance");
    FAILS(ricci_flow(metric, target, t->n_vertices - 1, NULL, NULL, &flat, NULL), RICCI_WRONG_SIZE, "target");
    CHECK(flat == NULL);
    ricci_metric_free(metric);
    ricci_mesh_free(mesh);
    free(target);
}

static void inadmissible_targets_say_where_and_by_how_much(const torus *t) {
    ricci_mesh *mesh = torus_mesh(t);
    ricci_metric *metric = NULL;
    double *target = (double *)calloc(t->n_vertices, sizeof *target);
    const uint32_t vertices[2] = {3, 11}, beyond[2] = {3, 100000};
    const double cones[2] = {1.5, -1.5};
    CHECK(target);
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(ricci_target_check(metric, target, t->n_vertices));
    target[5] = 7;
    FAILS(ricci_target_check(metric, target, t->n_vertices), RICCI_TARGET_AT_VERTEX, "vertex 5");
    target[5] = 0.25;
    FAILS(ricci_target_check(metric, target, t->n_vertices), RICCI_TARGET_TOTAL, "2.5000e-1");
    FAILS(ricci_target_boundary(metric, target, t->n_vertices), RICCI_TARGET_KIND, "boundary");
    FAILS(ricci_target_single(metric, 100000, target, t->n_vertices), RICCI_ARGUMENT, "100000");
    FAILS(ricci_target_cones(metric, beyond, cones, 2, target, t->n_vertices), RICCI_ARGUMENT, "100000");
    CHECK(target[5] == 0.25);
    OK(ricci_target_cones(metric, vertices, cones, 2, target, t->n_vertices));
    CHECK(target[3] == 1.5 && target[11] == -1.5 && target[5] == 0);
    ricci_metric_free(metric);
    ricci_mesh_free(mesh);
    free(target);
}

static void a_diagnosis_names_the_elements_of_every_defect(void) {
    /* Two triangles that run the same way along their common edge 0-1, and a vertex in no face. */
    const double positions[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {5, 5, 5}};
    const uint32_t faces[2][3] = {{0, 1, 2}, {0, 1, 3}}, sound[1][3] = {{0, 1, 2}};
    ricci_diagnosis *diagnosis = NULL;
    ricci_mesh *mesh = NULL;
    ricci_diagnosis_summary summary;
    ricci_defect defect;
    FAILS(ricci_mesh_from_arrays(positions[0], 0, 5, faces[0], 2, &mesh), RICCI_DEFECTS, "");
    OK(ricci_diagnose_arrays(positions[0], 0, 5, faces[0], 2, &diagnosis));
    OK(ricci_diagnosis_summarise(diagnosis, &summary, sizeof summary));
    CHECK(summary.n_vertices == 5 && summary.n_edges == 5 && summary.n_faces == 2);
    int isolated = 0, turned = 0;
    for (size_t i = 0; i < summary.n_defects; i++) {
        OK(ricci_diagnosis_defect(diagnosis, i, &defect, sizeof defect));
        CHECK(strlen(defect.message) > 0 && strlen(defect.remedy) > 0);
        if (strcmp(defect.code, "isolated_vertex") == 0)
            isolated += defect.n_vertices == 1 && defect.vertices[0] == 4 && defect.n_faces == 0;
        if (strcmp(defect.code, "inconsistent_orientation") == 0)
            turned +=
                defect.n_vertices == 2 && defect.n_faces == 2 && defect.vertices[0] + defect.vertices[1] == 1;
    }
    CHECK(isolated == 1 && turned == 1);
    FAILS(ricci_diagnosis_defect(diagnosis, summary.n_defects, &defect, sizeof defect), RICCI_ARGUMENT,
          "index");
    ricci_diagnosis_free(diagnosis);
    OK(ricci_diagnose_arrays(positions[0], 0, 3, sound[0], 1, &diagnosis));
    OK(ricci_diagnosis_summarise(diagnosis, &summary, sizeof summary));
    CHECK(summary.n_defects == 0 && summary.n_boundary_loops == 1 && summary.genus == 0);
    ricci_diagnosis_free(diagnosis);
}

static void a_gluing_is_given_back_as_it_came(void) {
    /* A torus of one vertex: a square with sides a = 1, b = 2 and diagonal c = 3, all of them loops. */
    const uint32_t faces[2][3] = {{0, 0, 0}, {0, 0, 0}};
    const int32_t gluing[2][3] = {{2, -3, 1}, {-1, -2, 3}};
    const double lengths[3] = {1, 1, 1.4142135623730951}, bad[3] = {1, -1, 1};
    int32_t back[2][3];
    double curvature = 1;
    ricci_mesh *mesh = NULL;
    ricci_metric *metric = NULL;
    ricci_mesh_summary summary;
    FAILS(ricci_mesh_from_gluing(1, faces[0], gluing[0], 2, lengths, 2, RICCI_SPACE_E2, &mesh),
          RICCI_WRONG_SIZE, "lengths");
    FAILS(ricci_mesh_from_gluing(1, faces[0], gluing[0], 2, bad, 3, RICCI_SPACE_E2, &mesh), RICCI_EDGE_LENGTH,
          "edge 1");
    OK(ricci_mesh_from_gluing(1, faces[0], gluing[0], 2, lengths, 3, RICCI_SPACE_E2, &mesh));
    OK(ricci_mesh_summarise(mesh, &summary, sizeof summary));
    CHECK(summary.n_vertices == 1 && summary.n_edges == 3 && summary.n_faces == 2 && summary.genus == 1);
    OK(ricci_mesh_face_edges(mesh, back[0], 6));
    CHECK(memcmp(back, gluing, sizeof gluing) == 0);
    FAILS(ricci_mesh_write_obj(mesh, "never.obj"), RICCI_ARGUMENT, "intrinsic");
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(ricci_metric_curvature(metric, &curvature, 1));
    CHECK(curvature < 1e-14 && curvature > -1e-14);
    ricci_metric_free(metric);
    ricci_mesh_free(mesh);
}

static void a_panic_is_a_status_and_poisons_the_handle(const torus *t) {
    ricci_mesh *mesh = torus_mesh(t), *sound = torus_mesh(t);
    ricci_mesh_summary summary;
    ricci_metric *metric = NULL;
    FAILS(ricci_debug_panic(mesh), RICCI_PANIC, "ricci_debug_panic");
    FAILS(ricci_mesh_summarise(mesh, &summary, sizeof summary), RICCI_POISONED, "mesh");
    FAILS(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric), RICCI_POISONED, "mesh");
    FAILS(ricci_debug_panic(mesh), RICCI_POISONED, "mesh");
    OK(ricci_mesh_summarise(sound, &summary, sizeof summary));
    ricci_mesh_free(mesh);
    ricci_mesh_free(sound);
}

static void handles_may_be_freed_in_any_order(const torus *t) {
    ricci_mesh *mesh = torus_mesh(t);
    ricci_metric *metric = NULL, *flat = NULL;
    ricci_layout *layout = NULL;
    ricci_layout_summary summary;
    double *target = (double *)malloc(t->n_vertices * sizeof *target);
    CHECK(target);
    OK(ricci_metric_new(mesh, RICCI_SCHEME_INVERSIVE, RICCI_SPACE_E2, &metric));
    ricci_mesh_free(mesh);
    OK(ricci_target_uniform(metric, target, t->n_vertices));
    OK(ricci_flow(metric, target, t->n_vertices, NULL, NULL, &flat, NULL));
    ricci_metric_free(metric);
    OK(ricci_layout_new(flat, target, t->n_vertices, NULL, &layout));
    ricci_metric_free(flat);
    OK(ricci_layout_summarise(layout, &summary, sizeof summary));
    CHECK(summary.n_flipped == 0 && summary.consistency < 1e-9);
    ricci_layout_free(layout);
    free(target);
}

typedef struct {
    size_t warnings, others;
    char last[200];
} messages;

static void keep_message(ricci_log_level level, const char *message, void *user_data) {
    messages *m = (messages *)user_data;
    if (level == RICCI_LOG_WARN)
        m->warnings++;
    else
        m->others++;
    strncpy(m->last, message, sizeof m->last - 1);
}

static void the_log_goes_to_the_callback_while_it_is_set(const torus *t) {
    messages m = {0, 0, {0}};
    ricci_mesh *mesh = torus_mesh(t);
    ricci_metric *metric = NULL;
    OK(ricci_log_set(keep_message, &m, RICCI_LOG_WARN));
    FAILS(ricci_mesh_read("no_such.format", &mesh), RICCI_UNKNOWN_FORMAT, "no_such.format");
    CHECK(m.warnings == 1 && strcmp(m.last, ricci_last_error()) == 0);
    OK(ricci_metric_new(mesh, RICCI_SCHEME_TANGENTIAL, RICCI_SPACE_E2, &metric));
    ricci_metric_free(metric);
    CHECK(m.others == 0);
    OK(ricci_log_set(keep_message, &m, RICCI_LOG_INFO));
    OK(ricci_metric_new(mesh, RICCI_SCHEME_TANGENTIAL, RICCI_SPACE_E2, &metric));
    CHECK(m.others == 1 && strstr(m.last, "tangential"));
    OK(ricci_log_set(NULL, NULL, RICCI_LOG_TRACE));
    FAILS(ricci_mesh_read("no_such.format", &mesh), RICCI_UNKNOWN_FORMAT, "no_such.format");
    FAILS(ricci_log_set(NULL, NULL, (ricci_log_level)9), RICCI_ARGUMENT, "level is 9");
    CHECK(m.warnings == 1 && m.others == 1);
    ricci_metric_free(metric);
    ricci_mesh_free(mesh);
}

int main(void) {
    torus t = torus_new(24, 12);
    null_pointers_are_errors(&t);
    impossible_counts_are_errors(&t);
    numbers_that_are_no_enum_are_errors(&t);
    strided_positions_give_the_same_mesh(&t);
    int32_faces_are_read_and_negative_ones_named(&t);
    structs_of_older_versions_are_filled_and_unknown_sizes_refused(&t);
    options_out_of_range_are_errors(&t);
    inadmissible_targets_say_where_and_by_how_much(&t);
    a_diagnosis_names_the_elements_of_every_defect();
    a_gluing_is_given_back_as_it_came();
    a_panic_is_a_status_and_poisons_the_handle(&t);
    handles_may_be_freed_in_any_order(&t);
    the_log_goes_to_the_callback_while_it_is_set(&t);

    ricci_mesh *mesh = torus_mesh(&t);
    OK(ricci_mesh_write_obj(mesh, "arguments.obj"));
    ricci_mesh_free(mesh);
    torus_free(&t);
    return 0;
}
