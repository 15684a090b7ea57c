/* Checks of the plain C tests: the first one that fails ends the program with 1. */
#ifndef CHECK_H
#define CHECK_H

#include <ricci/ricci.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void check_failed(const char *file, int line, const char *what) {
    fprintf(stderr, "%s:%d: %s (last error: %s)\n", file, line, what, ricci_last_error());
    exit(1);
}
#define CHECK(condition) ((condition) ? (void)0 : check_failed(__FILE__, __LINE__, #condition))
#define OK(call) CHECK((call) == RICCI_OK)
/* The call fails with this status, and its message has this word. */
#define FAILS(call, status, word) CHECK((call) == (status) && strstr(ricci_last_error(), (word)) != NULL)
/* A struct with its size, and zeros. */
#define INIT(options) OK(ricci_init(&(options), sizeof(options)))

/* Memory for n entries, zeroed. */
static inline void *room(size_t n, size_t size) {
    void *p = calloc(n + 1, size);
    CHECK(p);
    return p;
}

static inline ricci_target target_of(uint32_t kind, const uint32_t *vertices, const double *curvatures,
                                     size_t n) {
    ricci_target target;
    INIT(target);
    target.kind = kind, target.vertices = vertices, target.curvatures = curvatures, target.n = n;
    return target;
}

/* The curvatures of a target by rule, at n_vertices vertices. */
static inline ricci_status fill(const ricci_metric *metric, ricci_target target, double *curvatures,
                                size_t n_vertices) {
    return ricci_target_fill(metric, &target, NULL, curvatures, n_vertices);
}

/* 1 if curvatures are admissible. */
static inline ricci_status check_target(const ricci_metric *metric, const double *curvatures, size_t n) {
    double *filled = (double *)room(n, sizeof *filled);
    const ricci_status status = fill(metric, target_of(RICCI_TARGET_GIVEN, NULL, curvatures, n), filled, n);
    free(filled);
    return status;
}

/* ricci_flow and ricci_solver_solve to given curvatures. */
static inline ricci_status flow_to(const ricci_metric *metric, const double *curvatures, size_t n,
                                   const ricci_flow_options *options, const ricci_control *control,
                                   ricci_metric **result) {
    const ricci_target target = target_of(RICCI_TARGET_GIVEN, NULL, curvatures, n);
    return ricci_flow(metric, &target, options, control, result);
}

static inline ricci_status solve_to(ricci_solver *solver, const double *curvatures, size_t n,
                                    ricci_metric **result) {
    const ricci_target target = target_of(RICCI_TARGET_GIVEN, NULL, curvatures, n);
    return ricci_solver_solve(solver, &target, NULL, result);
}

#endif
