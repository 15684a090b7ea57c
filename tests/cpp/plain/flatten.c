/* Flat maps through the C face: a half cylinder that unrolls, a bowl that is stretched a little, and what is
 * refused. */
#include "samples.h"
#include <math.h>
#include <ricci/flatten.h>

enum { M = 13, N = 7 };

/* A sheet of (M - 1) x (N - 1) squares, bent around a cylinder (by > 0) or pressed into a bowl. */
static ricci_mesh *sheet(double by) {
    static double positions[3 * M * N];
    static uint32_t faces[6 * (M - 1) * (N - 1)], *f;
    ricci_mesh *mesh = NULL;
    for (int k = 0; k < M * N; k++) {
        const double x = (k % M) / 12. - 0.5, y = (k / M) / 12. - 0.25;
        positions[3 * k] = by > 0 ? sin(by * x) / by : x;
        positions[3 * k + 1] = y;
        positions[3 * k + 2] = by > 0 ? cos(by * x) / by : x * x + y * y;
    }
    f = faces;
    for (uint32_t j = 0; j + 1 < N; j++) {
        for (uint32_t i = 0; i + 1 < M; i++, f += 6) {
            const uint32_t a = M * j + i, quad[6] = {a, a + 1, a + M + 1, a, a + M + 1, a + M};
            memcpy(f, quad, sizeof quad);
        }
    }
    OK(ricci_mesh_from_arrays(positions, 0, M * N, faces, 2 * (M - 1) * (N - 1), &mesh));
    return mesh;
}

static void check_maps(void) {
    static double points[2 * M * N], energies[501];
    ricci_flatten_summary s;
    ricci_flatten_options options;
    ricci_mesh *mesh = sheet(3);
    OK(ricci_flatten(mesh, NULL, NULL, points, 2 * M * N, NULL, 0, &s, sizeof s));
    CHECK(s.stop == RICCI_FLATTEN_CONVERGED && s.start == RICCI_FLATTEN_FROM_CONFORMAL && s.overlap == 0);
    CHECK(s.after[RICCI_DISTORTION_MAX_LENGTH_ERROR] < 1e-12);
    CHECK(fabs(s.after[RICCI_DISTORTION_ENERGY] - 4) < 1e-12);
    CHECK(fabs(s.after[RICCI_DISTORTION_LEAST_STRETCH] - 1) < 1e-12);
    ricci_mesh_free(mesh);
    mesh = sheet(0);
    OK(ricci_flatten(mesh, NULL, NULL, points, 2 * M * N, energies, 501, &s, sizeof s));
    CHECK(s.n_energies > 1 && s.n_energies < 20 && s.energy == energies[s.n_energies - 1]);
    CHECK(s.after[RICCI_DISTORTION_ENERGY] <= s.before[RICCI_DISTORTION_ENERGY]);
    CHECK(s.after[RICCI_DISTORTION_ENERGY] > 4 && s.after[RICCI_DISTORTION_MOST_STRETCH] > 1);
    const double isometric = s.after[RICCI_DISTORTION_MEAN_AREA_ERROR];
    INIT(options);
    options.energy = RICCI_FLATTEN_AREA;
    OK(ricci_flatten(mesh, &options, NULL, points, 2 * M * N, NULL, 0, &s, sizeof s));
    CHECK(s.after[RICCI_DISTORTION_MEAN_AREA_ERROR] < isometric);
    INIT(options);
    options.max_iterations = 1, options.tolerance = 1e-12;
    OK(ricci_flatten(mesh, &options, NULL, points, 2 * M * N, NULL, 0, &s, sizeof s));
    CHECK(s.stop == RICCI_FLATTEN_MAX_ITERATIONS && s.n_energies == 2);
    /* What fails writes nothing. */
    points[0] = 7;
    options.energy = 4;
    FAILS(ricci_flatten(mesh, &options, NULL, points, 2 * M * N, NULL, 0, &s, sizeof s), RICCI_ARGUMENT,
          "RICCI_FLATTEN_DISTANCE");
    options.energy = 0, options.conformal = 1.5;
    FAILS(ricci_flatten(mesh, &options, NULL, points, 2 * M * N, NULL, 0, &s, sizeof s), RICCI_ARGUMENT,
          "conformal");
    FAILS(ricci_flatten(mesh, NULL, NULL, points, 3, NULL, 0, &s, sizeof s), RICCI_BUFFER_TOO_SMALL,
          "points");
    FAILS(ricci_flatten(mesh, NULL, NULL, points, 2 * M * N, NULL, 5, &s, sizeof s), RICCI_NULL_POINTER,
          "energies");
    FAILS(ricci_flatten(mesh, NULL, NULL, points, 2 * M * N, NULL, 0, &s, 17), RICCI_STRUCT_SIZE, "size 17");
    CHECK(points[0] == 7);
    ricci_mesh_free(mesh);
    OK(make_genus(1, 4, 0, &mesh));
    FAILS(ricci_flatten(mesh, NULL, NULL, points, 2 * M * N, NULL, 0, &s, sizeof s), RICCI_LAYOUT, "genus 1");
    ricci_mesh_free(mesh);
}

static void check_conditions(void) {
    static double points[2 * M * N], weights[2 * (M - 1) * (N - 1)];
    static const uint32_t pins[2] = {0, M - 1}, side[5] = {0, M, 2 * M, 3 * M, 4 * M}, sizes[1] = {5};
    static const double places[4] = {1, 2, 2.25, 2};
    ricci_flatten_summary s;
    ricci_flatten_options options;
    ricci_mesh *mesh = sheet(0);
    OK(ricci_flatten(mesh, NULL, NULL, points, 2 * M * N, NULL, 0, &s, sizeof s));
    CHECK(s.one_to_one == 1 && s.misfit == 0);
    const double free_energy = s.energy, mean = s.after[RICCI_DISTORTION_MEAN_LENGTH_ERROR];
    INIT(options);
    options.pins = pins, options.places = places, options.n_pins = 2;
    options.straight = side, options.straight_sizes = sizes, options.n_straight = 1, options.injective = 1;
    OK(ricci_flatten(mesh, &options, NULL, points, 2 * M * N, NULL, 0, &s, sizeof s));
    CHECK(s.stop == RICCI_FLATTEN_CONVERGED && s.one_to_one == 1 && s.misfit < 1e-12);
    CHECK(s.energy > free_energy && points[0] == 1 && points[1] == 2 && points[2 * (M - 1)] == 2.25);
    const double *p = points, *q = points + 2 * M, *r = points + 8 * M;
    CHECK(fabs((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])) < 1e-12);
    INIT(options);
    for (int f = 0; f < 2 * (M - 1) * (N - 1); f++) {
        weights[f] = f < (M - 1) * (N - 1) ? 9 : 1;
    }
    options.weights = weights, options.n_weights = 2 * (M - 1) * (N - 1);
    OK(ricci_flatten(mesh, &options, NULL, points, 2 * M * N, NULL, 0, &s, sizeof s));
    CHECK(s.after[RICCI_DISTORTION_ENERGY] >= free_energy);
    INIT(options);
    options.energy = RICCI_FLATTEN_DISTANCE, options.rings = 1;
    OK(ricci_flatten(mesh, &options, NULL, points, 2 * M * N, NULL, 0, &s, sizeof s));
    CHECK(s.after[RICCI_DISTORTION_MEAN_LENGTH_ERROR] <= mean);
    INIT(options);
    options.weights = weights, options.n_weights = 3;
    FAILS(ricci_flatten(mesh, &options, NULL, points, 2 * M * N, NULL, 0, &s, sizeof s), RICCI_ARGUMENT,
          "number of weights");
    ricci_mesh_free(mesh);
}

enum { MOST = 300 };

static void check_spheres(void) {
    static double points[3 * MOST], view[3 * MOST];
    static uint32_t is_wall[MOST], is_kept[MOST];
    const double medial[3] = {1, 0, 0};
    ricci_mesh_summary counts;
    ricci_flatten_summary s;
    ricci_flatten_options options;
    ricci_mesh *mesh = NULL;
    OK(make_sized(RICCI_SHAPE_ELLIPSOID, 4, 0, 1, 1.5, 2, &mesh));
    OK(ricci_mesh_summarise(mesh, &counts, sizeof counts));
    const size_t n = counts.n_vertices;
    CHECK(n <= MOST);
    OK(ricci_flatten_sphere(mesh, NULL, NULL, points, 3 * n, NULL, 0, &s, sizeof s));
    CHECK(s.stop == RICCI_FLATTEN_CONVERGED && s.one_to_one == 1);
    CHECK(s.after[RICCI_DISTORTION_ENERGY] < s.before[RICCI_DISTORTION_ENERGY]);
    for (size_t v = 0; v < n; v++) {
        const double *p = points + 3 * v;
        CHECK(fabs(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - 1) < 1e-14);
    }
    INIT(options);
    options.energy = RICCI_FLATTEN_ARAP;
    FAILS(ricci_flatten_sphere(mesh, &options, NULL, points, 3 * n, NULL, 0, &s, sizeof s), RICCI_ARGUMENT,
          "energy");
    OK(ricci_inflate(mesh, 0, 0, NULL, view, 3 * n));
    FAILS(ricci_inflate(mesh, -1, 0, NULL, view, 3 * n), RICCI_ARGUMENT, "time");
    OK(ricci_medial_wall(mesh, view, n, medial, 0.2, is_wall, n));
    FAILS(ricci_medial_wall(mesh, view, n, medial, 2, is_wall, n), RICCI_ARGUMENT, "share");
    size_t wall = 0, kept = 0;
    for (size_t v = 0; v < n; v++) {
        wall += is_wall[v];
        is_wall[v] = !is_wall[v];
    }
    CHECK(wall > n / 10 && wall < n / 3);
    OK(ricci_flat_part(mesh, is_wall, n, is_kept, n));
    for (size_t v = 0; v < n; v++) {
        kept += is_kept[v];
    }
    CHECK(kept == n - wall);
    memset(is_wall, 0, sizeof is_wall);
    FAILS(ricci_flat_part(mesh, is_wall, n, is_kept, n), RICCI_ARGUMENT, "marks");
    ricci_mesh_free(mesh);
}

static void check_darts(void) {
    static double points[2 * 2 * M * N], strains[3 * 2 * (M - 1) * (N - 1)];
    static uint32_t origins[2 * M * N];
    ricci_flatten_summary s;
    ricci_dart_options darts;
    ricci_dart_summary told;
    ricci_mesh *mesh = sheet(0), *opened = NULL;
    const size_t n_faces = 2 * (M - 1) * (N - 1);
    OK(ricci_flatten(mesh, NULL, NULL, points, 2 * M * N, NULL, 0, &s, sizeof s));
    OK(ricci_flatten_strains(mesh, points, M * N, 0, strains, 3 * n_faces));
    double most = 0;
    for (size_t f = 0; f < n_faces; f++) {
        most = fmax(most, fmax(fabs(strains[3 * f]), fabs(strains[3 * f + 1])));
    }
    CHECK(most > 0);
    INIT(darts);
    darts.strain_warp = darts.strain_weft = 0.9 * most;
    OK(ricci_flatten_darts(mesh, NULL, &darts, NULL, origins, 2 * M * N, &told, sizeof told, &opened));
    CHECK(told.n_darts > 0 && told.n_vertices > M * N && told.length > 0 &&
          fabs(told.before - 1 / 0.9) < 1e-9);
    for (uint32_t v = 0; v < M * N; v++) {
        CHECK(origins[v] == v);
    }
    CHECK(origins[M * N] < M * N);
    OK(ricci_flatten(opened, NULL, NULL, points, 2 * told.n_vertices, NULL, 0, &s, sizeof s));
    ricci_mesh_free(opened);
    OK(ricci_flatten_darts(mesh, NULL, NULL, NULL, NULL, 0, &told, sizeof told, &opened));
    CHECK(told.n_darts == 0 && told.n_vertices == M * N);
    ricci_mesh_free(opened);
    darts.shear = -1;
    FAILS(ricci_flatten_darts(mesh, NULL, &darts, NULL, NULL, 0, &told, sizeof told, &opened), RICCI_ARGUMENT,
          "shear");
    FAILS(ricci_flatten_strains(mesh, points, 3, 0, strains, 3 * n_faces), RICCI_WRONG_SIZE, "points");
    ricci_mesh_free(mesh);
}

int main(void) {
    check_maps();
    check_darts();
    check_spheres();
    check_conditions();
    return 0;
}
