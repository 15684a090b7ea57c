/* Two threads use one metric at the same time: a const handle may be shared, results agree bit for bit, and
 * each thread has its own last error. */
#include "torus.h"
#include <pthread.h>

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
    free(jobs[0].u);
    free(jobs[1].u);
    free(target);
    ricci_metric_free(metric);
    ricci_mesh_free(mesh);
    torus_free(&t);
    return 0;
}
