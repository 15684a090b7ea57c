/* The host's floating-point environment does not change a result, and a call does not change the environment:
 * traps on, another rounding mode. Usage: test_environment [emulated]; valgrind does not emulate traps. */
#define _GNU_SOURCE
#include "torus.h"
#include <fenv.h>

/* u of the flat metric. */
static double *solve(const torus *t, uint32_t space, const double *target) {
    ricci_mesh *mesh = torus_mesh(t);
    ricci_metric *metric = NULL, *end = NULL;
    double *u = (double *)malloc(t->n_vertices * sizeof *u);
    CHECK(u);
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, space, &metric));
    OK(flow_to(metric, target, t->n_vertices, NULL, NULL, &end));
    OK(ricci_metric_values(end, RICCI_METRIC_U, u, t->n_vertices));
    ricci_metric_free(end);
    ricci_metric_free(metric);
    ricci_mesh_free(mesh);
    return u;
}

/* Lengths near the end of the range: squares of them overflow. Returns what the calls answer, a digit each.
 */
static long extremes(const torus *t) {
    ricci_mesh *mesh = torus_mesh(t);
    double *lengths = (double *)malloc(3 * t->n_vertices * sizeof *lengths);
    double *curvature = (double *)malloc(t->n_vertices * sizeof *curvature);
    const double scales[4] = {1e200, 1e-200, 1e308, 0};
    const uint32_t spaces[2] = {RICCI_SPACE_E2, RICCI_SPACE_H2};
    long answers = 0;
    CHECK(lengths && curvature);
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 2; k++) {
            ricci_metric *metric = NULL;
            ricci_metric_summary summary;
            OK(ricci_mesh_values(mesh, RICCI_LENGTHS, lengths, 3 * t->n_vertices));
            for (size_t e = 0; e < 3 * t->n_vertices; e++) lengths[e] *= scales[i];
            ricci_mesh *scaled = NULL;
            ricci_status status =
                ricci_mesh_with_lengths(mesh, lengths, 3 * t->n_vertices, spaces[k], &scaled);
            if (status == RICCI_OK)
                status = ricci_metric_new(scaled, RICCI_SCHEME_INVERSIVE, spaces[k], &metric);
            ricci_mesh_free(scaled);
            if (status == RICCI_OK) {
                status = ricci_metric_values(metric, RICCI_METRIC_CURVATURE, curvature, t->n_vertices);
                CHECK(status != RICCI_OK ||
                      ricci_metric_summarise(metric, &summary, sizeof summary) == RICCI_OK);
            }
            CHECK(status != RICCI_PANIC);
            CHECK(scales[i] != 0 || status == RICCI_EDGE_LENGTH);
            answers = 2 * answers + (status != RICCI_OK);
            ricci_metric_free(metric);
        }
    free(curvature);
    free(lengths);
    ricci_mesh_free(mesh);
    return answers;
}

int main(int argc, char **argv) {
    const int emulated = argc > 1 && strcmp(argv[1], "emulated") == 0;
    torus t = torus_new(emulated ? 20 : 40, emulated ? 15 : 30);
    const size_t bytes = t.n_vertices * sizeof(double);
    double *target = (double *)calloc(t.n_vertices, sizeof *target);
    CHECK(target);
    double *expected = solve(&t, RICCI_SPACE_E2, target);
    const long answers = extremes(&t);

#ifdef __GLIBC__
    feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
    double *trapped = solve(&t, RICCI_SPACE_E2, target);
    CHECK(extremes(&t) == answers);
    CHECK(emulated || fegetexcept() == (FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW));
    fedisableexcept(FE_ALL_EXCEPT);
    CHECK(memcmp(trapped, expected, bytes) == 0);
    free(trapped);
#endif

    feclearexcept(FE_ALL_EXCEPT);
    double *again = solve(&t, RICCI_SPACE_E2, target);
    CHECK(fetestexcept(FE_ALL_EXCEPT) == 0);
    free(again);

    fesetround(FE_UPWARD);
    double *upward = solve(&t, RICCI_SPACE_E2, target);
    CHECK(fegetround() == FE_UPWARD);
    fesetround(FE_TONEAREST);
    CHECK(memcmp(upward, expected, bytes) == 0);
    free(upward);

    free(expected);
    free(target);
    torus_free(&t);
    return 0;
}
