/* Two threads use one metric at the same time: a const handle may be shared, results agree bit for bit, and
 * each thread has its own last error. A process that is forked while a thread changes a solver may use every
 * handle but that one. */
#include "torus.h"
#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

typedef struct {
    const ricci_metric *metric;
    const double *target;
    size_t n_vertices;
    uint32_t no_vertex; /* an index beyond the mesh, different in each thread */
    double *u;
} job;

static void *work(void *argument) {
    job *j = (job *)argument;
    char number[16];
    sprintf(number, "%u", (unsigned)j->no_vertex);
    for (int round = 0; round < 3; round++) {
        ricci_metric *end = NULL;
        ricci_layout *layout = NULL;
        FAILS(fill(j->metric, target_of(RICCI_TARGET_SINGLE, &j->no_vertex, NULL, 1), j->u, j->n_vertices),
              RICCI_ARGUMENT, number);
        OK(flow_to(j->metric, j->target, j->n_vertices, NULL, NULL, &end));
        OK(ricci_metric_values(end, RICCI_METRIC_U, j->u, j->n_vertices));
        OK(ricci_layout_new(end, NULL, NULL, &layout));
        CHECK(strstr(ricci_last_error(), number) != NULL);
        ricci_layout_free(layout);
        ricci_metric_free(end);
    }
    return NULL;
}

typedef struct {
    ricci_solver *solver;
    const ricci_target *target;
    ricci_control *control;
} long_job;

static void *solve_until_cancelled(void *argument) {
    long_job *j = (long_job *)argument;
    ricci_metric *end = NULL;
    CHECK(ricci_solver_solve(j->solver, j->target, j->control, &end) == RICCI_CANCELLED);
    CHECK(end == NULL);
    return NULL;
}

static void a_child_is_told_of_a_solver_that_was_changing(const ricci_mesh *mesh,
                                                          const ricci_metric *metric) {
    const uint32_t cones[2] = {0, 100};
    const double curvatures[2] = {2.5, -2.5};
    const ricci_target target = target_of(RICCI_TARGET_CONES, cones, curvatures, 2);
    ricci_flow_options options;
    long_job j = {NULL, &target, NULL};
    pthread_t thread;
    uint32_t stage = RICCI_STAGE_IDLE;
    double fraction = 0;
    int ended = 0;
    INIT(options);
    options.method = RICCI_METHOD_GRADIENT;
    options.tolerance = 1e-300;
    options.max_iterations = 1000000000;
    OK(ricci_solver_new(metric, &options, &j.solver));
    OK(ricci_control_new(&j.control));
    CHECK(pthread_create(&thread, NULL, solve_until_cancelled, &j) == 0);
    while (stage != RICCI_STAGE_FLOW) OK(ricci_control_progress(j.control, &stage, &fraction, NULL));
    const pid_t child = fork();
    CHECK(child >= 0);
    if (child == 0) {
        ricci_metric *end = NULL;
        ricci_mesh_summary summary;
        const int is_told = ricci_solver_solve(j.solver, &target, NULL, &end) == RICCI_POISONED &&
                            strstr(ricci_last_error(), "forked") != NULL;
        const int is_readable = ricci_mesh_summarise(mesh, &summary, sizeof summary) == RICCI_OK;
        /* Another program says the outcome: what the parent's threads hold would be a leak of this one. */
        if (is_told && is_readable) execl("/bin/true", "true", (char *)NULL);
        execl("/bin/false", "false", (char *)NULL);
        _exit(1);
    }
    CHECK(waitpid(child, &ended, 0) == child);
    OK(ricci_control_cancel(j.control));
    CHECK(pthread_join(thread, NULL) == 0);
    CHECK(WIFEXITED(ended) && WEXITSTATUS(ended) == 0);
    ricci_solver_free(j.solver);
    ricci_control_free(j.control);
}

/* A solver that rests keeps its threads, which a child does not have: it is told so and does not wait for
 * them. */
static void a_child_is_told_of_a_solver_that_rested(const ricci_metric *metric) {
    ricci_flow_options options;
    ricci_solver *solver = NULL;
    ricci_metric *flat = NULL;
    int ended = 0;
    INIT(options);
    options.threads = 2;
    OK(ricci_solver_new(metric, &options, &solver));
    OK(ricci_solver_solve(solver, NULL, NULL, &flat));
    const pid_t child = fork();
    CHECK(child >= 0);
    if (child == 0) {
        ricci_metric *end = NULL;
        const int is_told = ricci_solver_solve(solver, NULL, NULL, &end) == RICCI_POISONED;
        ricci_solver_free(solver);
        const int is_well = ricci_flow(metric, NULL, &options, NULL, &end) == RICCI_OK;
        if (is_told && is_well) execl("/bin/true", "true", (char *)NULL);
        _exit(1);
    }
    CHECK(waitpid(child, &ended, 0) == child);
    CHECK(WIFEXITED(ended) && WEXITSTATUS(ended) == 0);
    ricci_metric_free(flat);
    ricci_solver_free(solver);
}

int main(void) {
    torus t = torus_new(24, 16);
    const size_t n = t.n_vertices;
    ricci_mesh *mesh = torus_mesh(&t);
    ricci_metric *metric = NULL;
    double *target = (double *)calloc(n, sizeof *target);
    job jobs[2];
    pthread_t threads[2];
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    for (int i = 0; i < 2; i++) {
        job j = {metric, target, n, 1000000 + i, (double *)malloc(n * sizeof(double))};
        jobs[i] = j;
        CHECK(target && j.u);
        CHECK(pthread_create(&threads[i], NULL, work, &jobs[i]) == 0);
    }
    for (int i = 0; i < 2; i++) CHECK(pthread_join(threads[i], NULL) == 0);
    CHECK(memcmp(jobs[0].u, jobs[1].u, n * sizeof(double)) == 0);
    a_child_is_told_of_a_solver_that_was_changing(mesh, metric);
    a_child_is_told_of_a_solver_that_rested(metric);
    free(jobs[0].u);
    free(jobs[1].u);
    free(target);
    ricci_metric_free(metric);
    ricci_mesh_free(mesh);
    torus_free(&t);
    return 0;
}
