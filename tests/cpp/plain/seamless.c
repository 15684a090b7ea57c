/* Seamless metrics: convergence, exact seams of the layout's own doubles, cones that add up, refusals. */
#include "arrays.h"
#include "samples.h"
#include <ricci/seamless.h>

/* Every edge of a seam is exactly a rotation of its other side by a multiple of 90 degrees. */
static void seams_are_exact(ricci_layout *layout) {
    ricci_layout_summary s;
    OK(ricci_layout_summarise(layout, &s, sizeof s));
    CHECK(s.n_flipped == 0 && s.n_seam_edges > 0);
    double *points = (double *)room(2 * s.n_points, sizeof *points);
    uint32_t *corners = (uint32_t *)room(3 * s.n_faces, sizeof *corners);
    OK(ricci_layout_points(layout, RICCI_MODEL_POINCARE, points, 2 * s.n_points));
    OK(ricci_layout_corners(layout, RICCI_ON_REFINEMENT, corners, 3 * s.n_faces));
    ricci_mesh *mesh = NULL;
    OK(ricci_layout_mesh(layout, &mesh));
    uint32_t *faces = (uint32_t *)room(3 * s.n_faces, sizeof *faces);
    OK(ricci_mesh_faces(mesh, faces, 3 * s.n_faces));
    size_t seams = 0;
    for (size_t a = 0; a < 3 * s.n_faces; a++) {
        const size_t b = a - a % 3 + (a + 1) % 3;
        for (size_t c = a + 1; c < 3 * s.n_faces; c++) {
            const size_t d = c - c % 3 + (c + 1) % 3;
            if (faces[a] != faces[d] || faces[b] != faces[c]) continue;
            if (corners[a] == corners[d] && corners[b] == corners[c]) continue;
            const double *p = points + 2 * (size_t)corners[a], *q = points + 2 * (size_t)corners[b];
            const double *r = points + 2 * (size_t)corners[d], *t = points + 2 * (size_t)corners[c];
            const double x = q[0] - p[0], y = q[1] - p[1], z = t[0] - r[0], w = t[1] - r[1];
            CHECK((z == x && w == y) || (z == -y && w == x) || (z == -x && w == -y) || (z == y && w == -x));
            seams++;
        }
    }
    CHECK(seams >= s.n_seam_edges);
    free(points), free(corners), free(faces);
    ricci_mesh_free(mesh);
    ricci_layout_free(layout);
}

static void cones_add_up(const ricci_seamless *result, size_t n, int total) {
    uint32_t *cones = (uint32_t *)room(2 * n, sizeof *cones);
    OK(ricci_seamless_cones(result, cones, 2 * n));
    if (n > 0) CHECK(ricci_seamless_cones(result, cones, 2 * n - 1) == RICCI_BUFFER_TOO_SMALL);
    int sum = 0;
    for (size_t k = 0; k < n; k++) sum += 4 - (int)cones[2 * k + 1];
    CHECK(sum == total);
    free(cones);
}

static void surfaces_become_seamless(void) {
    ricci_mesh *mesh = NULL;
    ricci_seamless *result = NULL;
    ricci_seamless_summary s;
    ricci_seamless_options options;
    ricci_layout *layout = NULL;
    INIT(options);
    options.cones = RICCI_SEAMLESS_AUTO;
    options.n_cones = 8;
    OK(make_genus(2, 5, 0, &mesh));
    OK(ricci_seamless_new(mesh, &options, NULL, &result));
    OK(ricci_seamless_summarise(result, &s, sizeof s));
    CHECK(s.converged && s.n_loops == 4 && s.error < 1e-10 && s.tolerance == 1e-10);
    cones_add_up(result, s.n_cones, -8);
    int32_t turning[4], other[4];
    OK(ricci_seamless_turning(result, turning, 4));
    ricci_metric *metric = NULL;
    ricci_metric_summary m;
    OK(ricci_seamless_metric(result, &metric));
    OK(ricci_metric_summarise(metric, &m, sizeof m));
    CHECK(m.space == RICCI_SPACE_E2 && m.broken_triangles == 0);
    ricci_metric_free(metric);
    OK(ricci_seamless_map(result, NULL, &layout));
    seams_are_exact(layout);
    ricci_seamless_free(result);
    /* The turning that was found, asked for. */
    options.quarter_turns = turning;
    options.n_quarter_turns = 4;
    OK(ricci_seamless_new(mesh, &options, NULL, &result));
    OK(ricci_seamless_turning(result, other, 4));
    CHECK(memcmp(turning, other, sizeof turning) == 0);
    ricci_seamless_free(result);
    options.n_quarter_turns = 3;
    result = NULL;
    CHECK(ricci_seamless_new(mesh, &options, NULL, &result) == RICCI_WRONG_SIZE && result == NULL);
    ricci_mesh_free(mesh);
}

static void impossible_signatures_are_refused(void) {
    ricci_mesh *mesh = NULL;
    ricci_seamless *result = NULL;
    ricci_seamless_options options;
    const uint32_t vertices[2] = {0, 30}, valences[2] = {3, 5};
    INIT(options);
    OK(make_sized(RICCI_SHAPE_TORUS, 12, 8, 2, 1, 0, &mesh));
    options.cones = RICCI_SEAMLESS_VALENCES;
    options.vertices = vertices;
    options.valences = valences;
    options.n_cones = 2;
    CHECK(ricci_seamless_new(mesh, &options, NULL, &result) == RICCI_TARGET_KIND && result == NULL);
    options.n_cones = 1;
    CHECK(ricci_seamless_new(mesh, &options, NULL, &result) == RICCI_TARGET_KIND);
    options.cones = 3;
    CHECK(ricci_seamless_new(mesh, &options, NULL, &result) == RICCI_ARGUMENT);
    options.cones = RICCI_SEAMLESS_VALENCES;
    options.vertices = NULL;
    CHECK(ricci_seamless_new(mesh, &options, NULL, &result) == RICCI_NULL_POINTER);
    CHECK(ricci_seamless_new(NULL, NULL, NULL, &result) == RICCI_NULL_POINTER);
    ricci_mesh_free(mesh);
    OK(make_sized(RICCI_SHAPE_ANNULUS, 2, 24, 0.5, 1, 0, &mesh));
    INIT(options);
    options.cones = RICCI_SEAMLESS_AUTO;
    options.n_cones = 4;
    CHECK(ricci_seamless_new(mesh, &options, NULL, &result) == RICCI_ARGUMENT);
    ricci_mesh_free(mesh);
}

/* The map of least stretch with the same turning: exact seams, less energy, at each step. */
static void stretches_less(const ricci_seamless *result) {
    ricci_flatten_options options;
    ricci_flatten_summary told;
    ricci_layout_summary s;
    ricci_layout *layout = NULL;
    double energies[3];
    INIT(options);
    options.injective = 1;
    FAILS(ricci_seamless_flatten(result, &options, NULL, NULL, 0, &told, sizeof told, &layout),
          RICCI_ARGUMENT, "injective");
    CHECK(ricci_seamless_flatten(NULL, NULL, NULL, NULL, 0, &told, sizeof told, &layout) ==
          RICCI_NULL_POINTER);
    OK(ricci_seamless_flatten(result, NULL, NULL, energies, 3, &told, sizeof told, &layout));
    CHECK(told.start == RICCI_FLATTEN_FROM_SEAMLESS && told.stop == RICCI_FLATTEN_CONVERGED);
    CHECK(told.n_energies > 3 && energies[0] > energies[1] && energies[1] > energies[2]);
    CHECK(told.energy < energies[2] && told.energy > 4);
    OK(ricci_layout_summarise(layout, &s, sizeof s));
    CHECK(s.n_flipped == 0 && s.symmetric_dirichlet > 4 && s.symmetric_dirichlet < energies[0]);
    seams_are_exact(layout);
}

/* An annulus becomes a cylinder without cones or corners, whose 48 edges on the boundary are straight. */
static void boundaries_become_straight(void) {
    ricci_mesh *mesh = NULL;
    ricci_seamless *result = NULL;
    ricci_seamless_options options;
    ricci_seamless_summary s;
    uint32_t ends[96];
    const uint32_t edge[2] = {0, 9999}, vertex = 0;
    const double zero[3] = {0, 0, 0};
    double field[3 * 96];
    ricci_layout *layout = NULL;
    INIT(options);
    OK(make_sized(RICCI_SHAPE_ANNULUS, 2, 24, 0.5, 1, 0, &mesh));
    options.isometric_steps = 2;
    OK(ricci_seamless_new(mesh, &options, NULL, &result));
    OK(ricci_seamless_summarise(result, &s, sizeof s));
    CHECK(s.converged && s.n_cones == 0 && s.n_loops == 1 && s.n_features == 48);
    CHECK(s.length_change <= s.conformal_change && s.n_left_out == 0);
    OK(ricci_seamless_features(result, ends, 96));
    CHECK(ricci_seamless_features(result, ends, 95) == RICCI_BUFFER_TOO_SMALL);
    OK(ricci_seamless_map(result, NULL, &layout));
    seams_are_exact(layout);
    stretches_less(result);
    ricci_seamless_free(result);
    OK(ricci_seamless_field(mesh, NULL, NULL, field, 3 * 96));
    CHECK(ricci_seamless_field(mesh, NULL, NULL, field, 3) == RICCI_BUFFER_TOO_SMALL);
    options.features = edge;
    options.n_features = 1;
    CHECK(ricci_seamless_new(mesh, &options, NULL, &result) == RICCI_ARGUMENT);
    options.n_features = 0;
    options.stroke_vertices = &vertex;
    options.strokes = zero;
    options.n_strokes = 1;
    CHECK(ricci_seamless_field(mesh, &options, NULL, field, 3 * 96) == RICCI_ARGUMENT);
    ricci_mesh_free(mesh);
}

int main(void) {
    surfaces_become_seamless();
    impossible_signatures_are_refused();
    boundaries_become_straight();
    return 0;
}
