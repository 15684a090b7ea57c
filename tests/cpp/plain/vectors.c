/* Golden vectors (tests/vectors/surfaces.txt): what a host sees through the C face agrees with 60 digits. */
#include "check.h"
#include <math.h>

enum { MOST = 64 };

typedef struct {
    char name[32], geometry[8], space[8], scheme[16];
    unsigned n_vertices, n_edges, n_faces;
    uint32_t faces[3 * MOST];
    int32_t face_edges[3 * MOST];
    double lengths[MOST], eta[MOST], curvature[MOST], target[MOST], u[MOST], solution[MOST];
    int has_target;
} golden;

static void numbers(FILE *file, double *x, unsigned n) {
    for (unsigned i = 0; i < n; i++) CHECK(fscanf(file, "%lf", &x[i]) == 1); /* also hexadecimal */
}

static int read_block(FILE *file, golden *g) {
    char key[32];
    double skipped;
    if (fscanf(file, "%31s", key) != 1) return 0;
    CHECK(strcmp(key, "surface") == 0);
    CHECK(fscanf(file, "%31s %7s %7s %15s", g->name, g->geometry, g->space, g->scheme) == 4);
    g->has_target = 0;
    for (;;) {
        CHECK(fscanf(file, "%31s", key) == 1);
        if (strcmp(key, "end") == 0) return 1;
        if (strcmp(key, "counts") == 0) {
            CHECK(fscanf(file, "%u %u %u", &g->n_vertices, &g->n_edges, &g->n_faces) == 3);
            CHECK(g->n_vertices <= MOST && g->n_edges <= MOST && g->n_faces <= MOST);
        } else if (strcmp(key, "faces") == 0) {
            for (unsigned i = 0; i < 3 * g->n_faces; i++) CHECK(fscanf(file, "%u", &g->faces[i]) == 1);
        } else if (strcmp(key, "face_edges") == 0) {
            for (unsigned i = 0; i < 3 * g->n_faces; i++) CHECK(fscanf(file, "%d", &g->face_edges[i]) == 1);
        } else if (strcmp(key, "lengths") == 0) {
            numbers(file, g->lengths, g->n_edges);
        } else if (strcmp(key, "eta") == 0) {
            numbers(file, g->eta, g->n_edges);
        } else if (strcmp(key, "curvature") == 0) {
            numbers(file, g->curvature, g->n_vertices);
        } else if (strcmp(key, "derivative") == 0) {
            for (unsigned i = 0; i < g->n_vertices * g->n_vertices; i++) numbers(file, &skipped, 1);
        } else if (strcmp(key, "target") == 0) {
            numbers(file, g->target, g->n_vertices);
            g->has_target = 1;
        } else if (strcmp(key, "u") == 0) {
            numbers(file, g->u, g->n_vertices);
        } else {
            CHECK(strcmp(key, "solution") == 0);
            numbers(file, g->solution, g->n_edges);
        }
    }
}

static uint32_t space_named(const char *name) {
    return name[0] == 'e' ? RICCI_SPACE_E2 : name[0] == 'h' ? RICCI_SPACE_H2 : RICCI_SPACE_S2;
}

static uint32_t scheme_named(const char *name) {
    return name[0] == 'y'   ? RICCI_SCHEME_YAMABE
           : name[0] == 'i' ? RICCI_SCHEME_INVERSIVE
           : name[0] == 'v' ? RICCI_SCHEME_VIRTUAL
           : name[1] == 'h' ? RICCI_SCHEME_THURSTON
                            : RICCI_SCHEME_TANGENTIAL;
}

static double distance(const double *a, const double *b, unsigned n) {
    double worst = 0;
    for (unsigned i = 0; i < n; i++) worst = fmax(worst, fabs(a[i] - b[i]));
    return worst;
}

static void agree(const golden *g) {
    double x[MOST];
    ricci_mesh *mesh = NULL;
    ricci_metric *start = NULL, *class_of_space = NULL, *result = NULL;
    ricci_report_summary summary;
    const uint32_t scheme = scheme_named(g->scheme);
    ricci_gluing gluing;
    INIT(gluing);
    gluing.n_vertices = g->n_vertices, gluing.faces = g->faces, gluing.face_edges = g->face_edges;
    gluing.n_faces = g->n_faces, gluing.lengths = g->lengths, gluing.n_edges = g->n_edges;
    gluing.geometry = space_named(g->geometry);
    OK(ricci_mesh_from_gluing(&gluing, &mesh));
    OK(ricci_metric_new(mesh, scheme, space_named(g->geometry), &start));
    OK(ricci_metric_values(start, RICCI_METRIC_ETA, x, MOST));
    CHECK(distance(x, g->eta, g->n_edges) < 1e-13);
    OK(ricci_metric_values(start, RICCI_METRIC_CURVATURE, x, MOST));
    CHECK(distance(x, g->curvature, g->n_vertices) < 1e-14);
    if (g->has_target) {
        /* The solutions are those on the given triangulation. */
        ricci_flow_options options;
        INIT(options);
        options.flips = RICCI_FLIPS_NEVER;
        OK(ricci_metric_new(mesh, scheme, space_named(g->space), &class_of_space));
        OK(flow_to(class_of_space, g->target, g->n_vertices, &options, NULL, &result));
        OK(ricci_report_summarise(result, &summary, sizeof summary));
        CHECK(summary.converged && summary.max_curvature_error <= 1e-10 && summary.gauss_bonnet <= 1e-10);
        CHECK(summary.n_obstruction == 0);
        OK(ricci_metric_values(result, RICCI_METRIC_U, x, MOST));
        CHECK(distance(x, g->u, g->n_vertices) < 1e-12);
        OK(ricci_metric_values(result, RICCI_METRIC_LENGTH, x, MOST));
        CHECK(distance(x, g->solution, g->n_edges) < 1e-12);
    }
    ricci_metric_free(result);
    ricci_metric_free(class_of_space);
    ricci_metric_free(start);
    ricci_mesh_free(mesh);
}

int main(int argc, char **argv) {
    golden g;
    int blocks = 0;
    FILE *file = argc > 1 ? fopen(argv[1], "r") : NULL;
    CHECK(file != NULL);
    while (read_block(file, &g)) {
        agree(&g);
        blocks++;
    }
    fclose(file);
    CHECK(blocks == 40);
    return 0;
}
