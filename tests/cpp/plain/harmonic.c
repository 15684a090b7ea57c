/* Harmonic forms and maps through the C face: sums around faces, known moduli, zeros, and images of maps. */
#include "samples.h"
#include <math.h>
#include <ricci/harmonic.h>

static ricci_forms_summary summary_of(const ricci_forms *forms) {
    ricci_forms_summary s;
    OK(ricci_forms_summarise(forms, &s, sizeof s));
    return s;
}

/* Every form adds up to 0 around every face; holomorphic ones have 2 g - 2 zeros. */
static void check_forms(const ricci_mesh *mesh, size_t genus) {
    ricci_forms *forms = NULL;
    ricci_mesh *delaunay = NULL;
    OK(ricci_forms_new(mesh, NULL, NULL, &forms));
    const ricci_forms_summary s = summary_of(forms);
    CHECK(s.genus == genus && s.n_forms == 2 * genus && s.closedness <= 1e-12 && s.coclosedness <= 1e-10);
    CHECK(s.least_eigenvalue > 0 && s.asymmetry < 0.1 && (genus == 1) == (s.modulus[1] > 0));
    OK(ricci_forms_mesh(forms, &delaunay));
    const size_t n_faces = 2 * s.n_edges / 3;
    int32_t *sides = (int32_t *)room(3 * n_faces, sizeof *sides);
    double *values = (double *)room(2 * s.n_edges, sizeof *values);
    OK(ricci_mesh_face_edges(delaunay, sides, 3 * n_faces));
    for (size_t k = 0; k < s.n_forms; k++) {
        OK(ricci_forms_values(forms, k, values, s.n_edges));
        for (size_t f = 0; f < n_faces; f++) {
            double sum = 0;
            for (int i = 0; i < 3; i++) {
                const int32_t e = sides[3 * f + i];
                sum += e > 0 ? values[e - 1] : -values[-e - 1];
            }
            CHECK(fabs(sum) < 1e-12);
        }
    }
    double *matrix = (double *)room(2 * genus * genus, sizeof *matrix);
    OK(ricci_forms_periods(forms, matrix, 2 * genus * genus));
    for (size_t i = 0; i < genus; i++) CHECK(matrix[2 * (genus * i + i) + 1] > 0);
    double *first = (double *)room(s.n_forms, sizeof *first);
    first[0] = 1;
    OK(ricci_forms_holomorphic(forms, first, s.n_forms, values, 2 * s.n_edges));
    double *real = (double *)room(s.n_edges, sizeof *real);
    OK(ricci_forms_values(forms, 0, real, s.n_edges));
    for (size_t e = 0; e < s.n_edges; e++) CHECK(values[2 * e] == real[e]);
    size_t n = 0;
    OK(ricci_forms_zeros(forms, first, s.n_forms, NULL, 0, &n));
    int64_t *zeros = (int64_t *)room(n, sizeof *zeros), total = 0;
    OK(ricci_forms_zeros(forms, first, s.n_forms, zeros, n, &n));
    for (size_t k = 1; k < n; k += 2) total += zeros[k];
    CHECK(total == 2 * (int64_t)genus - 2);
    FAILS(ricci_forms_values(forms, s.n_forms, values, s.n_edges), RICCI_ARGUMENT, "n_forms");
    free(zeros), free(real), free(first), free(matrix), free(values), free(sides);
    ricci_mesh_free(delaunay);
    ricci_forms_free(forms);
}

static void check_open(void) {
    ricci_mesh *disk = NULL;
    ricci_forms *forms = NULL;
    ricci_forms_options options;
    INIT(options);
    options.classes = 7;
    OK(make_disk(6, &disk));
    FAILS(ricci_forms_new(disk, &options, NULL, &forms), RICCI_ARGUMENT, "classes");
    options.classes = RICCI_CLASSES_RELATIVE;
    OK(ricci_forms_new(disk, &options, NULL, &forms));
    CHECK(summary_of(forms).n_forms == 0);
    FAILS(ricci_forms_periods(forms, NULL, 0), RICCI_LAYOUT, "closed");
    ricci_forms_free(forms);
    ricci_mesh_free(disk);
}

/* The images of a mesh's vertices, and the greatest distance of one from the origin. */
static double farthest(const ricci_mesh *mesh, const ricci_harmonic_spec *spec, double *least) {
    ricci_mesh_summary s;
    OK(ricci_mesh_summarise(mesh, &s, sizeof s));
    double *points = (double *)room(3 * s.n_vertices, sizeof *points), most = 0;
    OK(ricci_harmonic(mesh, spec, NULL, points, 3 * s.n_vertices));
    *least = INFINITY;
    for (size_t v = 0; v < s.n_vertices; v++) {
        const double *p = points + 3 * v, r = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        most = r > most ? r : most, *least = r < *least ? r : *least;
    }
    free(points);
    return most;
}

static void check_maps(void) {
    ricci_mesh *disk = NULL, *sphere = NULL;
    ricci_harmonic_spec spec;
    double least, points[3];
    INIT(spec);
    OK(make_disk(6, &disk));
    OK(make_sphere(4, &sphere));
    CHECK(fabs(farthest(disk, NULL, &least) - 1) < 1e-12);
    spec.target = RICCI_HARMONIC_RECTANGLE;
    CHECK(farthest(disk, &spec, &least) > 1);
    const uint32_t at[2] = {0, 1};
    const double places[6] = {0, 0, 5, 0, 0, 5};
    spec.target = RICCI_HARMONIC_VALUES, spec.vertices = at, spec.values = places, spec.n = 2;
    CHECK(fabs(farthest(disk, &spec, &least) - 5) < 1e-9 && fabs(least - 5) < 1e-9);
    INIT(spec);
    spec.target = RICCI_HARMONIC_SPHERE;
    CHECK(fabs(farthest(sphere, &spec, &least) - 1) < 1e-12 && fabs(least - 1) < 1e-12);
    FAILS(ricci_harmonic(disk, &spec, NULL, points, 3), RICCI_LAYOUT, "genus 0");
    spec.target = RICCI_HARMONIC_RECTANGLE, spec.vertices = at, spec.n = 2;
    FAILS(ricci_harmonic(disk, &spec, NULL, points, 3), RICCI_ARGUMENT, "four");
    ricci_mesh_free(disk);
    ricci_mesh_free(sphere);
}

/* A disk of four triangles around vertex 4, one of them with a spike and a vertex half-way up it: two edges
 * of its Delaunay triangulation have the same ends. */
static void make_spike(ricci_mesh **mesh) {
    const double points[7][3] = {{0, 0, 0},     {1, 0, 0}, {1, 1, 0},       {0, 1, 0},
                                 {0.5, 0.5, 0}, {0, 0, 0}, {0.55, 0.2, 1.5}};
    const uint32_t faces[8][3] = {{1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 1, 5},
                                  {5, 1, 6}, {1, 4, 6}, {4, 5, 6}, {4, 0, 5}};
    double placed[7][3];
    memcpy(placed, points, sizeof placed);
    for (int k = 0; k < 3; k++) placed[5][k] = 0.5 * (points[0][k] + points[6][k]);
    OK(ricci_mesh_from_arrays(&placed[0][0], 0, 7, &faces[0][0], 8, mesh));
}

static double doubled_area(const double *p, const double *q, const double *r) {
    return (q[0] - p[0]) * (r[1] - p[1]) - (r[0] - p[0]) * (q[1] - p[1]);
}

/* Without vertices on edges inside, the tip of the spike would lie between two others; the points are those
 * of the mesh. */
static void check_simple(void) {
    ricci_mesh *spike = NULL;
    ricci_harmonic_spec spec;
    double points[3 * 7 + 1];
    make_spike(&spike);
    INIT(spec);
    for (int k = 0; k < 2; k++) {
        points[21] = 7;
        OK(ricci_harmonic(spike, &spec, NULL, points, 21));
        CHECK(points[21] == 7);
        for (int i = 0; i < 6; i++) {
            for (int j = 0; j < i; j++)
                CHECK(fabs(doubled_area(points + 18, points + 3 * i, points + 3 * j)) > 1e-3);
        }
        spec.target = RICCI_HARMONIC_POLYGON, spec.n = 3;
    }
    const uint32_t corners[4] = {1, 2, 3, 0};
    spec.vertices = corners, spec.n = 4;
    OK(ricci_harmonic(spike, &spec, NULL, points, 21));
    for (int k = 0; k < 4; k++) {
        const double *p = points + 3 * corners[k], angle = k * acos(0);
        CHECK(hypot(p[0] - cos(angle), p[1] - sin(angle)) < 1e-12);
    }
    spec.n = 2;
    FAILS(ricci_harmonic(spike, &spec, NULL, points, 21), RICCI_ARGUMENT, "convex");
    spec.vertices = NULL, spec.n = 0;
    FAILS(ricci_harmonic(spike, &spec, NULL, points, 21), RICCI_ARGUMENT, "convex");
    spec.n = (size_t)-1;
    FAILS(ricci_harmonic(spike, &spec, NULL, points, 21), RICCI_ARGUMENT, "number of corners");
    spec.n = 3;
    FAILS(ricci_harmonic(spike, &spec, NULL, points, 20), RICCI_BUFFER_TOO_SMALL, "21");
    ricci_mesh_free(spike);
}

/* A rectangle of 2 by 1 has the modulus 2; the heat flow lowers the energy to that of the map. */
static void check_figures(void) {
    enum { M = 9, N = 5 };
    double positions[3 * M * N], points[3 * M * N], energies[2000];
    uint32_t faces[6 * (M - 1) * (N - 1)], *f = faces;
    const uint32_t corners[4] = {0, M - 1, M * N - 1, M * (N - 1)};
    for (int k = 0; k < M * N; k++)
        positions[3 * k] = (k % M) * 0.25, positions[3 * k + 1] = (k / M) * 0.25, positions[3 * k + 2] = 0;
    for (uint32_t j = 0; j + 1 < N; j++) {
        for (uint32_t i = 0; i + 1 < M; i++, f += 6) {
            const uint32_t a = M * j + i, quad[6] = {a, a + 1, a + M + 1, a, a + M + 1, a + M};
            memcpy(f, quad, sizeof quad);
        }
    }
    ricci_mesh *mesh = NULL;
    ricci_harmonic_spec spec;
    ricci_harmonic_summary s;
    OK(ricci_mesh_from_arrays(positions, 0, M * N, faces, 2 * (M - 1) * (N - 1), &mesh));
    INIT(spec);
    spec.target = RICCI_HARMONIC_RECTANGLE, spec.vertices = corners, spec.n = 4;
    OK(ricci_harmonic_map(mesh, &spec, NULL, points, 3 * M * N, NULL, 0, &s, sizeof s));
    CHECK(fabs(s.modulus - 2) < 1e-12 && s.modulus_low < 2 + 1e-12 && s.modulus_high > 2 - 1e-12);
    CHECK(s.n_energies == 0 && s.converged == 1);
    spec.method = RICCI_HARMONIC_HEAT;
    FAILS(ricci_harmonic_map(mesh, &spec, NULL, points, 3 * M * N, NULL, 0, &s, sizeof s), RICCI_ARGUMENT,
          "linear solves");
    INIT(spec);
    OK(ricci_harmonic_map(mesh, &spec, NULL, points, 3 * M * N, NULL, 0, &s, sizeof s));
    const double energy = s.energy;
    spec.method = RICCI_HARMONIC_HEAT;
    OK(ricci_harmonic_map(mesh, &spec, NULL, points, 3 * M * N, energies, 2000, &s, sizeof s));
    CHECK(s.converged == 1 && s.n_energies > 10 && s.n_energies < 2000 && s.modulus != s.modulus);
    for (size_t k = 1; k < s.n_energies; k++) CHECK(energies[k] < energies[k - 1] + 1e-13);
    CHECK(fabs(s.energy - energy) < 1e-10);
    // What fails writes nothing, into earlier buffers neither.
    points[0] = 7;
    FAILS(ricci_harmonic_map(mesh, &spec, NULL, points, 3 * M * N, NULL, 0, &s, 17), RICCI_STRUCT_SIZE,
          "size 17");
    CHECK(points[0] == 7);
    FAILS(ricci_harmonic_map(mesh, &spec, NULL, points, 3 * M * N, NULL, 5, &s, sizeof s), RICCI_NULL_POINTER,
          "energies");
    CHECK(points[0] == 7);
    ricci_mesh_free(mesh);
}

int main(void) {
    ricci_mesh *mesh = NULL;
    OK(make_bolza(2, &mesh));
    check_forms(mesh, 2);
    ricci_mesh_free(mesh);
    OK(make_genus(1, 4, 0, &mesh));
    check_forms(mesh, 1);
    ricci_mesh_free(mesh);
    check_open();
    check_maps();
    check_simple();
    check_figures();
    return 0;
}
