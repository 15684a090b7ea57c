/* The whole job from arrays: a torus of revolution becomes flat and is unrolled into the plane. */
#include <math.h>
#include <ricci/ricci.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { N = 48, M = 24, V = N * M, F = 2 * N * M };

static double positions[V][3], factor[V], uv[F][3][2];
static uint32_t faces[F][3];

/* Every call may fail; its message says what to do. */
static void check(ricci_status status) {
    if (status != RICCI_OK) {
        fprintf(stderr, "%s: %s\n", ricci_status_text(status), ricci_last_error());
        exit(1);
    }
}

static void make_torus(void) {
    const double turn = 8 * atan(1.0);
    for (uint32_t i = 0; i < N; i++)
        for (uint32_t j = 0; j < M; j++) {
            const double a = turn * i / N, b = turn * j / M, r = 2 + 0.7 * cos(b);
            const uint32_t v = i * M + j, right = (i + 1) % N * M + j;
            const uint32_t up = i * M + (j + 1) % M, across = (i + 1) % N * M + (j + 1) % M;
            const double point[3] = {r * cos(a), r * sin(a), 0.7 * sin(b)};
            const uint32_t pair[2][3] = {{v, right, across}, {v, across, up}};
            for (int k = 0; k < 3; k++) {
                positions[v][k] = point[k];
                faces[2 * v][k] = pair[0][k];
                faces[2 * v + 1][k] = pair[1][k];
            }
        }
}

int main(void) {
    make_torus();
    ricci_mesh *mesh;
    check(ricci_mesh_from_arrays(&positions[0][0], sizeof positions[0], V, &faces[0][0], F, &mesh));

    ricci_metric *metric, *flat;
    check(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    ricci_target target; /* zeros are defaults; here said: of a torus 0 everywhere */
    check(ricci_init(&target, sizeof target));
    target.kind = RICCI_TARGET_UNIFORM;
    ricci_flow_options options;
    check(ricci_init(&options, sizeof options));
    options.tolerance = 1e-11;
    check(ricci_flow(metric, &target, &options, NULL, &flat));

    ricci_report_summary done;
    check(ricci_report_summarise(flat, &done, sizeof done));
    printf("%s after %zu iterations, max |K - target| = %.1e\n", done.stop_reason_text, done.iterations,
           done.max_curvature_error);
    check(ricci_metric_values(flat, RICCI_METRIC_FACTOR, factor, V));
    printf("vertex 0 is scaled by %.4f\n", exp(factor[0]));

    ricci_layout *layout;
    ricci_layout_summary plane;
    check(ricci_layout_new(flat, NULL, NULL, &layout));
    check(ricci_layout_summarise(layout, &plane, sizeof plane));
    check(ricci_layout_uv(layout, RICCI_ON_INPUT, &uv[0][0][0], 6 * F));
    printf("the last face begins at (%.3f, %.3f)\n", uv[F - 1][0][0], uv[F - 1][0][1]);
    /* Edges may have been flipped: the exact map lives on parts of the faces, cut along the flipped edges. */
    ricci_map *map;
    uint32_t *part_of = malloc(plane.n_faces * sizeof *part_of);
    if (!part_of) return 1;
    check(ricci_map_new(flat, NULL, &map));
    check(ricci_map_faces(map, RICCI_ON_INPUT, part_of, plane.n_faces));
    printf("%zu faces are %zu in the plane, the last one part of face %u\n", (size_t)F, plane.n_faces,
           (unsigned)part_of[plane.n_faces - 1]);
    printf("layout: %zu points, %zu seams, %zu flipped, dilatation %.3f (mean) %.3f (max)\n", plane.n_points,
           plane.n_seams, plane.n_flipped, plane.qc_mean, plane.qc_max);

    free(part_of);
    ricci_layout_free(layout);
    ricci_map_free(map);
    ricci_metric_free(flat);
    ricci_metric_free(metric);
    ricci_mesh_free(mesh);
    return done.converged && plane.n_flipped == 0 ? 0 : 1;
}
