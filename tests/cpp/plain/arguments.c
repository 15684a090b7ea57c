/* A call with any arguments returns a status: it does not crash, and if it fails it leaves its outputs alone.
 * Writes arguments.obj, which other tests read. */
#include "torus.h"
#include <ricci/repair.h>

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
    FAILS(ricci_mesh_values(mesh, RICCI_POSITIONS, NULL, 3 * t->n_vertices), RICCI_NULL_POINTER, "positions");
    FAILS(ricci_mesh_values(mesh, RICCI_POSITIONS, x, 3), RICCI_BUFFER_TOO_SMALL, "positions");
    FAILS(ricci_metric_new(NULL, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, NULL), RICCI_NULL_POINTER, "metric");
    FAILS(ricci_flow(NULL, NULL, NULL, NULL, NULL), RICCI_NULL_POINTER, "metric");
    FAILS(ricci_mesh_from_gluing(NULL, &untouched), RICCI_NULL_POINTER, "gluing");
    FAILS(ricci_solver_new(NULL, NULL, NULL), RICCI_NULL_POINTER, "solver");
    FAILS(ricci_layout_new(NULL, NULL, NULL, NULL), RICCI_NULL_POINTER, "layout");
    FAILS(ricci_control_cancel(NULL), RICCI_NULL_POINTER, "control");
    FAILS(ricci_init(NULL, sizeof(ricci_flow_options)), RICCI_NULL_POINTER, "options");
    FAILS(ricci_last_failure(NULL, sizeof(ricci_failure)), RICCI_NULL_POINTER, "failure");
    ricci_mesh_free(mesh);

    ricci_mesh_free(NULL);
    ricci_soup_free(NULL);
    ricci_metric_free(NULL);
    ricci_solver_free(NULL);
    ricci_map_free(NULL);
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
    FAILS(ricci_metric_new(mesh, (uint32_t)77, RICCI_SPACE_E2, &metric), RICCI_ARGUMENT,
          "scheme is 77: known are RICCI_SCHEME_YAMABE, ");
    FAILS(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, (uint32_t)-1, &metric), RICCI_ARGUMENT,
          "space is 4294967295");
    CHECK(strcmp(ricci_status_text((ricci_status)-5), "unknown status") == 0);
    CHECK(strcmp(ricci_status_text(RICCI_NO_MEMORY), "unknown status") != 0);
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
    OK(ricci_mesh_values(tight, RICCI_POSITIONS, a, n));
    OK(ricci_mesh_values(loose, RICCI_POSITIONS, b, n));
    CHECK(memcmp(a, b, n * sizeof *a) == 0);
    ricci_mesh_free(tight);
    ricci_mesh_free(loose);
    free(wide);
    free(a);
    free(b);
}

/* By a cast; a negative index shows as what it is. */
static void int32_faces_are_read_and_negative_ones_named(const torus *t) {
    int32_t *faces = (int32_t *)malloc(3 * t->n_faces * sizeof *faces);
    ricci_mesh *mesh = NULL;
    ricci_failure failure;
    CHECK(faces);
    for (size_t i = 0; i < 3 * t->n_faces; i++) faces[i] = (int32_t)t->faces[i];
    faces[3 * 7 + 2] = -4;
    FAILS(ricci_mesh_from_arrays(t->positions, 0, t->n_vertices, (const uint32_t *)faces, t->n_faces, &mesh),
          RICCI_ARGUMENT, "face 7, corner 2: vertex -4");
    OK(ricci_last_failure(&failure, sizeof failure));
    CHECK(failure.status == RICCI_ARGUMENT && failure.element == RICCI_ELEMENT_FACE && failure.index == 7);
    CHECK(mesh == NULL);
    free(faces);
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

    /* A newer caller's summary: what this library knows is filled, the rest is zero. */
    struct {
        ricci_mesh_summary known;
        size_t added;
    } larger;
    memset(&larger, 0x5a, sizeof larger);
    OK(ricci_mesh_summarise(mesh, &larger.known, sizeof larger));
    CHECK(larger.known.size == sizeof larger.known && larger.added == 0 && larger.known.genus == 1);

    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(ricci_target_fill(metric, NULL, NULL, target, t->n_vertices));
    FAILS(ricci_init(&options, 0), RICCI_STRUCT_SIZE, "size 0");
    /* An older caller: knows nothing from `threads` on, whose bytes are not options at all. */
    memset(&options, 0x5a, sizeof options);
    OK(ricci_init(&options, offsetof(ricci_flow_options, threads)));
    CHECK(options.size == offsetof(ricci_flow_options, threads) && options.tolerance == 0);
    CHECK(options.threads == (size_t)0x5a5a5a5a5a5a5a5a);
    OK(flow_to(metric, target, t->n_vertices, &options, NULL, &flat));
    ricci_metric_free(flat);
    flat = NULL;
    options.size = 0;
    FAILS(flow_to(metric, target, t->n_vertices, &options, NULL, &flat), RICCI_STRUCT_SIZE, "size 0");
    /* A newer caller: its size is kept, and its new field is zero, or is not ignored. */
    struct {
        ricci_flow_options known;
        double added;
    } newer;
    OK(ricci_init(&newer, sizeof newer));
    CHECK(newer.known.size == sizeof newer && newer.added == 0);
    OK(flow_to(metric, target, t->n_vertices, &newer.known, NULL, &flat));
    ricci_metric_free(flat);
    flat = NULL;
    newer.added = 1;
    FAILS(flow_to(metric, target, t->n_vertices, &newer.known, NULL, &flat), RICCI_STRUCT_SIZE,
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
    OK(fill(metric, target_of(RICCI_TARGET_UNIFORM, NULL, NULL, 0), target, t->n_vertices));
    INIT(options);
    options.method = (uint32_t)5;
    FAILS(flow_to(metric, target, t->n_vertices, &options, NULL, &flat), RICCI_ARGUMENT, "method is 5");
    options.method = RICCI_METHOD_NEWTON;
    options.tolerance = -1;
    FAILS(flow_to(metric, target, t->n_vertices, &options, NULL, &flat), RICCI_ARGUMENT, "tolerance");
    options.tolerance = NAN;
    FAILS(flow_to(metric, target, t->n_vertices, &options, NULL, &flat), RICCI_ARGUMENT, "tolerance");
    FAILS(flow_to(metric, target, t->n_vertices - 1, NULL, NULL, &flat), RICCI_WRONG_SIZE, "curvatures");
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
    ricci_failure failure;
    CHECK(target);
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(check_target(metric, target, t->n_vertices));
    target[5] = 7;
    FAILS(check_target(metric, target, t->n_vertices), RICCI_TARGET_AT_VERTEX, "vertex 5");
    OK(ricci_last_failure(&failure, sizeof failure));
    CHECK(failure.element == RICCI_ELEMENT_VERTEX && failure.index == 5);
    CHECK(fabs(failure.amount - (7 - 8 * atan(1.0))) < 1e-12 && failure.needed == 0);
    target[5] = 0.25;
    FAILS(check_target(metric, target, t->n_vertices), RICCI_TARGET_TOTAL, "2.5000e-1");
    OK(ricci_last_failure(&failure, sizeof failure));
    CHECK(failure.index == -1 && fabs(failure.amount - 0.25) < 1e-12);
    FAILS(fill(metric, target_of(RICCI_TARGET_BOUNDARY, NULL, NULL, 0), target, t->n_vertices),
          RICCI_TARGET_KIND, "boundary");
    FAILS(fill(metric, target_of(RICCI_TARGET_SINGLE, beyond + 1, NULL, 1), target, t->n_vertices),
          RICCI_ARGUMENT, "100000");
    FAILS(fill(metric, target_of(RICCI_TARGET_CONES, beyond, cones, 2), target, t->n_vertices),
          RICCI_ARGUMENT, "100000");
    CHECK(target[5] == 0.25);
    OK(fill(metric, target_of(RICCI_TARGET_CONES, vertices, cones, 2), target, t->n_vertices));
    CHECK(target[3] == 1.5 && target[11] == -1.5 && target[5] == 0);
    ricci_metric_free(metric);
    ricci_mesh_free(mesh);
    free(target);
}

static void a_diagnosis_names_the_elements_of_every_defect(void) {
    /* Two triangles that run the same way along their common edge 0-1, and a vertex in no face. */
    const double positions[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {5, 5, 5}};
    const uint32_t faces[2][3] = {{0, 1, 2}, {0, 1, 3}}, sound[1][3] = {{0, 1, 2}};
    ricci_soup *soup = NULL;
    ricci_mesh *mesh = NULL;
    ricci_soup_summary summary;
    ricci_defect defect;
    FAILS(ricci_mesh_from_arrays(positions[0], 0, 5, faces[0], 2, &mesh), RICCI_DEFECTS, "");
    ricci_failure failure;
    OK(ricci_last_failure(&failure, sizeof failure));
    CHECK(failure.element == RICCI_ELEMENT_VERTEX && (failure.index == 0 || failure.index == 4));
    OK(ricci_soup_from_arrays(positions[0], 0, 5, faces[0], 2, &soup));
    OK(ricci_soup_summarise(soup, &summary, sizeof summary));
    CHECK(summary.n_vertices == 5 && summary.n_edges == 5 && summary.n_faces == 2);
    int isolated = 0, turned = 0;
    for (size_t i = 0; i < summary.n_defects; i++) {
        OK(ricci_soup_defect(soup, i, &defect, sizeof defect));
        CHECK(strlen(defect.message) > 0 && strlen(defect.remedy) > 0);
        if (strcmp(defect.code, "isolated_vertex") == 0)
            isolated += defect.n_vertices == 1 && defect.vertices[0] == 4 && defect.n_faces == 0;
        if (strcmp(defect.code, "inconsistent_orientation") == 0)
            turned +=
                defect.n_vertices == 2 && defect.n_faces == 2 && defect.vertices[0] + defect.vertices[1] == 1;
    }
    CHECK(isolated == 1 && turned == 1);
    FAILS(ricci_soup_defect(soup, summary.n_defects, &defect, sizeof defect), RICCI_ARGUMENT, "defect");
    ricci_soup_free(soup);
    OK(ricci_soup_from_arrays(positions[0], 0, 3, sound[0], 1, &soup));
    OK(ricci_soup_summarise(soup, &summary, sizeof summary));
    CHECK(summary.n_defects == 0 && summary.n_boundary_loops == 1 && summary.genus == 0);
    OK(ricci_soup_mesh(soup, &mesh));
    ricci_mesh_free(mesh);
    ricci_soup_free(soup);
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
    ricci_gluing given;
    INIT(given);
    given.n_vertices = 1, given.faces = faces[0], given.face_edges = gluing[0], given.n_faces = 2;
    given.lengths = lengths, given.n_edges = 2;
    FAILS(ricci_mesh_from_gluing(&given, &mesh), RICCI_WRONG_SIZE, "lengths");
    given.n_edges = 3, given.lengths = bad;
    FAILS(ricci_mesh_from_gluing(&given, &mesh), RICCI_EDGE_LENGTH, "edge 1");
    given.lengths = lengths, given.geometry = 3;
    FAILS(ricci_mesh_from_gluing(&given, &mesh), RICCI_ARGUMENT, "space is 3");
    given.geometry = RICCI_SPACE_E2;
    OK(ricci_mesh_from_gluing(&given, &mesh));
    OK(ricci_mesh_summarise(mesh, &summary, sizeof summary));
    CHECK(summary.n_vertices == 1 && summary.n_edges == 3 && summary.n_faces == 2 && summary.genus == 1);
    OK(ricci_mesh_face_edges(mesh, back[0], 6));
    CHECK(memcmp(back, gluing, sizeof gluing) == 0);
    FAILS(ricci_mesh_write(mesh, NULL, "never.obj"), RICCI_ARGUMENT, "intrinsic");
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(ricci_metric_values(metric, RICCI_METRIC_CURVATURE, &curvature, 1));
    CHECK(curvature < 1e-14 && curvature > -1e-14);
    ricci_metric_free(metric);
    ricci_mesh_free(mesh);
}

/* A size is asked for with NULL and capacity 0, in numbers. */
static void sizes_are_answered(const torus *t) {
    ricci_mesh *mesh = torus_mesh(t);
    ricci_failure failure;
    CHECK(ricci_mesh_values(mesh, RICCI_POSITIONS, NULL, 0) == RICCI_BUFFER_TOO_SMALL);
    OK(ricci_last_failure(&failure, sizeof failure));
    CHECK(failure.status == RICCI_BUFFER_TOO_SMALL && failure.needed == 3 * t->n_vertices);
    FAILS(ricci_mesh_values(mesh, 6, NULL, 0), RICCI_ARGUMENT, "which is 6");
    ricci_mesh_free(mesh);
}

/* Whatever the compiler evaluates first, the message is that of the call. */
static void the_message_does_not_dangle(void) {
    ricci_mesh *mesh = NULL;
    char text[256], far_too_long[5001];
    const char *before = ricci_last_error();
    snprintf(text, sizeof text, "%u %s", ricci_mesh_read("first.nothing", &mesh), ricci_last_error());
    CHECK(strstr(text, "first.nothing") && ricci_last_error() == before);
    memset(far_too_long, 'x', 5000), far_too_long[5000] = 0;
    FAILS(ricci_mesh_read(far_too_long, &mesh), RICCI_UNKNOWN_FORMAT, "xxx");
    CHECK(strlen(ricci_last_error()) == 1023 && ricci_last_error() == before);
    FAILS(ricci_mesh_read("\xff.obj", &mesh), RICCI_ARGUMENT, "UTF-8");
}

static void versions_agree(void) {
    char text[32];
    snprintf(text, sizeof text, "%d.%d.%d", RICCI_VERSION_MAJOR, RICCI_VERSION_MINOR, RICCI_VERSION_PATCH);
    CHECK(strcmp(text, ricci_version()) == 0 && ricci_version_number() == RICCI_VERSION);
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
    OK(fill(metric, target_of(RICCI_TARGET_UNIFORM, NULL, NULL, 0), target, t->n_vertices));
    OK(flow_to(metric, target, t->n_vertices, NULL, NULL, &flat));
    ricci_metric_free(metric);
    OK(ricci_layout_new(flat, NULL, NULL, &layout));
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

static void keep_message(uint32_t level, const char *message, void *user_data) {
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
    FAILS(ricci_log_set(NULL, NULL, (uint32_t)9), RICCI_ARGUMENT, "level is 9");
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
    sizes_are_answered(&t);
    the_message_does_not_dangle();
    versions_agree();
    handles_may_be_freed_in_any_order(&t);
    the_log_goes_to_the_callback_while_it_is_set(&t);

    ricci_mesh *mesh = torus_mesh(&t);
    OK(ricci_mesh_write(mesh, NULL, "arguments.obj"));
    ricci_mesh_free(mesh);
    torus_free(&t);
    return 0;
}
