/* Cancels a flow from another thread: starts it on a large torus, waits until it is under way, and says how
 * long the call took to come back. Usage: example_cancel [COLUMNS ROWS]; 400 x 250 is 100,000 vertices. */
#define _POSIX_C_SOURCE 200112L
#include <math.h>
#include <pthread.h>
#include <ricci/ricci.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static void check(ricci_status status) {
    if (status != RICCI_OK) {
        fprintf(stderr, "%s: %s\n", ricci_status_text(status), ricci_last_error());
        exit(1);
    }
}

static ricci_mesh *make_torus(size_t n, size_t m) {
    const double turn = 8 * atan(1.0);
    double *positions = malloc(3 * n * m * sizeof *positions);
    uint32_t *faces = malloc(6 * n * m * sizeof *faces);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < m; j++) {
            const double a = turn * (double)i / (double)n, b = turn * (double)j / (double)m,
                         r = 2 + cos(b) + 0.2 * sin(5 * a) * sin(3 * b);
            const size_t v = i * m + j, right = (i + 1) % n * m + j;
            const size_t up = i * m + (j + 1) % m, across = (i + 1) % n * m + (j + 1) % m;
            const double point[3] = {r * cos(a), r * sin(a), sin(b)};
            const size_t corners[6] = {v, right, across, v, across, up};
            for (size_t k = 0; k < 3; k++) positions[3 * v + k] = point[k];
            for (size_t k = 0; k < 6; k++) faces[6 * v + k] = (uint32_t)corners[k];
        }
    ricci_mesh *mesh;
    check(ricci_mesh_from_arrays(positions, 0, n * m, faces, 2 * n * m, &mesh));
    free(positions);
    free(faces);
    return mesh;
}

/* Waits until the flow has begun, then cancels it. */
static void *cancel_when_running(void *control) {
    const struct timespec pause = {0, 1000000};
    uint32_t stage = RICCI_STAGE_IDLE;
    double fraction = 0;
    while (stage != RICCI_STAGE_FLOW) {
        nanosleep(&pause, NULL);
        check(ricci_control_progress(control, &stage, &fraction, NULL));
    }
    check(ricci_control_cancel(control));
    return NULL;
}

int main(int argc, char **argv) {
    const size_t n = argc > 2 ? strtoul(argv[1], NULL, 10) : 400;
    const size_t m = argc > 2 ? strtoul(argv[2], NULL, 10) : 250;
    ricci_mesh *mesh = make_torus(n, m);
    ricci_metric *metric, *result = NULL;
    ricci_control *control;
    check(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    check(ricci_control_new(&control));
    double *before = malloc(n * m * sizeof *before), *after = malloc(n * m * sizeof *after);
    check(ricci_metric_values(metric, RICCI_METRIC_U, before, n * m));

    ricci_flow_options options;
    check(ricci_init(&options, sizeof options));
    options.method = RICCI_METHOD_GRADIENT; /* thousands of steps: it is still running when it is cancelled */
    options.max_iterations = 1000000;

    pthread_t other;
    pthread_create(&other, NULL, cancel_when_running, control);
    const ricci_status status = ricci_flow(metric, NULL, &options, control, &result);
    uint32_t stage;
    double fraction, latency;
    check(ricci_control_progress(control, &stage, &fraction, &latency));
    pthread_join(other, NULL);
    check(ricci_metric_values(metric, RICCI_METRIC_U, after, n * m));

    const int unchanged = memcmp(before, after, n * m * sizeof *before) == 0;
    printf("%zu vertices: %s; latency %.1f ms\n", n * m, ricci_status_text(status), 1000 * latency);
    free(before);
    free(after);
    ricci_control_free(control);
    ricci_metric_free(metric);
    ricci_mesh_free(mesh);
    return status == RICCI_CANCELLED && result == NULL && unchanged ? 0 : 1;
}
