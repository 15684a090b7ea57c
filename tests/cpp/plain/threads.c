/* Results are the same bit for bit for 1, 2 and 3 threads, and for a solver as for a single call.
 * Usage: test_threads [COLUMNS ROWS] */
#include "torus.h"

/* Lengths of the metric for this target, by this method and number of threads; 0 threads: a solver with 2. */
static double *solve(const torus *t, const double *target, uint32_t method, size_t threads) {
    ricci_mesh *mesh = torus_mesh(t);
    ricci_metric *metric = NULL, *end = NULL;
    ricci_report_summary done;
    ricci_flow_options options;
    double *lengths = (double *)malloc(3 * t->n_vertices * sizeof *lengths);
    CHECK(lengths);
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    INIT(options);
    options.method = method;
    options.threads = threads ? threads : 2;
    if (method == RICCI_METHOD_GRADIENT) options.tolerance = 1e-4;
    if (threads) {
        OK(flow_to(metric, target, t->n_vertices, &options, NULL, &end));
    } else {
        ricci_solver *solver = NULL;
        OK(ricci_solver_new(metric, &options, &solver));
        OK(solve_to(solver, target, t->n_vertices, &end));
        ricci_solver_free(solver);
    }
    OK(ricci_report_summarise(end, &done, sizeof done));
    CHECK(done.converged == 1 && done.stop_reason == RICCI_STOP_CONVERGED);
    CHECK(done.max_curvature_error <= done.tolerance && done.gauss_bonnet < 1e-10);
    if (method == RICCI_METHOD_NEWTON) {
        double residuals[64];
        CHECK(done.n_residuals == done.iterations + 1 && done.n_residuals <= 64);
        OK(ricci_report_values(end, RICCI_REPORT_RESIDUALS, residuals, 64));
        CHECK(done.max_curvature_error <= residuals[done.n_residuals - 1]);
    } else {
        double *trace = (double *)malloc(5 * done.n_trace * sizeof *trace);
        CHECK(trace && done.n_trace == done.iterations + 1);
        OK(ricci_report_values(end, RICCI_REPORT_TRACE, trace, 5 * done.n_trace));
        CHECK(trace[0] == 0 && trace[5] == 1);
        CHECK(trace[5 * (done.n_trace - 1) + 1] < 0); /* the energy went down */
        free(trace);
    }
    OK(ricci_metric_values(end, RICCI_METRIC_LENGTH, lengths, 3 * t->n_vertices));
    ricci_metric_free(end);
    ricci_metric_free(metric);
    ricci_mesh_free(mesh);
    return lengths;
}

/* A solver that has been elsewhere comes back to the same metric, and pinned vertices keep their u. */
static void a_solver_serves_many_targets(const torus *t, const double *target, const double *expected) {
    ricci_mesh *mesh = torus_mesh(t);
    ricci_metric *metric = NULL, *end = NULL;
    ricci_solver *solver = NULL;
    const uint32_t cones[2] = {0, 100}, pins[2] = {7, 8};
    const double curvatures[2] = {2.5, -2.5};
    const size_t n = t->n_vertices;
    double *other = (double *)malloc(n * sizeof *other), *lengths = (double *)malloc(3 * n * sizeof *lengths);
    double *before = (double *)malloc(n * sizeof *before), *after = (double *)malloc(n * sizeof *after);
    CHECK(other && lengths && before && after);
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(fill(metric, target_of(RICCI_TARGET_CONES, cones, curvatures, 2), other, n));
    OK(ricci_solver_new(metric, NULL, &solver));
    OK(solve_to(solver, other, n, &end));
    OK(ricci_metric_values(end, RICCI_METRIC_CURVATURE, after, n));
    for (size_t v = 0; v < n; v++) CHECK(fabs(after[v] - other[v]) < 1e-9);
    ricci_metric_free(end);
    OK(solve_to(solver, target, n, &end));
    OK(ricci_metric_values(end, RICCI_METRIC_LENGTH, lengths, 3 * n));
    for (size_t e = 0; e < 3 * n; e++) CHECK(fabs(lengths[e] - expected[e]) < 1e-8 * expected[e]);
    OK(ricci_metric_values(end, RICCI_METRIC_U, before, n));
    ricci_metric_free(end);

    OK(ricci_solver_pin(solver, pins, 2));
    OK(solve_to(solver, other, n, &end));
    OK(ricci_metric_values(end, RICCI_METRIC_U, after, n));
    CHECK(after[7] == before[7] && after[8] == before[8] && after[0] != before[0]);
    ricci_metric_free(end);
    FAILS(ricci_solver_pin(solver, &(const uint32_t){100000}, 1), RICCI_ARGUMENT, "100000");
    ricci_solver_free(solver);
    ricci_metric_free(metric);
    ricci_mesh_free(mesh);
    free(other);
    free(lengths);
    free(before);
    free(after);
}

int main(int argc, char **argv) {
    const size_t columns = argc > 2 ? strtoul(argv[1], NULL, 10) : 60;
    torus t = torus_new(columns, argc > 2 ? strtoul(argv[2], NULL, 10) : 40);
    double *target = (double *)calloc(t.n_vertices, sizeof *target);
    const size_t bytes = 3 * t.n_vertices * sizeof(double);
    const uint32_t methods[2] = {RICCI_METHOD_NEWTON, RICCI_METHOD_GRADIENT};
    CHECK(target);
    for (int m = 0; m < 2; m++) {
        double *one = solve(&t, target, methods[m], 1);
        for (size_t threads = 0; threads <= 3; threads++) {
            double *other = solve(&t, target, methods[m], threads);
            CHECK(memcmp(one, other, bytes) == 0);
            free(other);
        }
        if (methods[m] == RICCI_METHOD_NEWTON) a_solver_serves_many_targets(&t, target, one);
        free(one);
    }
    free(target);
    torus_free(&t);
    return 0;
}
