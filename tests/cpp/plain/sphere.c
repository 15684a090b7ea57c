/* Closed surfaces of genus 0 on the unit sphere: the round sphere comes back, inversions change nothing, the
 * way back. */
#include "arrays.h"

static double apart(const double *p, const double *q) {
    return sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                (p[2] - q[2]) * (p[2] - q[2]));
}

static double *positions_of(const ricci_sphere *sphere, size_t n) {
    double *x = (double *)room(3 * n, sizeof *x);
    OK(ricci_sphere_positions(sphere, x, 3 * n));
    for (size_t v = 0; v < n; v++)
        CHECK(fabs(hypot(hypot(x[3 * v], x[3 * v + 1]), x[3 * v + 2]) - 1) < 1e-15);
    return x;
}

static ricci_sphere_summary summary_of(const ricci_sphere *sphere) {
    ricci_sphere_summary s;
    OK(ricci_sphere_summarise(sphere, &s, sizeof s));
    CHECK(s.converged && s.stop_reason == RICCI_STOP_CONVERGED);
    CHECK(s.max_curvature_error < 1e-10 && s.spherical_curvature_error < 1e-10 && s.gauss_bonnet < 1e-10);
    CHECK(s.delaunay_violation < 1e-9 && s.outline_turning > -1e-9 && s.nonconvexity < 1e-12 &&
          s.off_centre < 1e-9);
    return s;
}

/* A polyhedron that is inscribed in the sphere already, with its mean at the centre, is the only one: up to a
 * rotation. After an inversion its faces have other areas, so its mean is another, but cross-ratios of chords
 * are what they were. */
static void round_spheres_come_back(void) {
    ricci_mesh *mesh = NULL, *inverted = NULL;
    ricci_sphere *sphere = NULL, *other = NULL;
    const double centre[3] = {1.2, 0.5, -0.3};
    OK(ricci_shape_sphere(5, &mesh));
    OK(ricci_mesh_invert(mesh, centre, 1, &inverted));
    OK(ricci_sphere_new(mesh, NULL, NULL, &sphere));
    OK(ricci_sphere_new(inverted, NULL, NULL, &other));
    arrays a = arrays_of(mesh, 1);
    const size_t n = a.n.n_vertices;
    const ricci_sphere_summary s = summary_of(sphere), t = summary_of(other);
    CHECK(s.n_vertices == n && s.n_faces == a.n.n_faces && t.n_vertices == n);
    double *x = positions_of(sphere, n), *y = positions_of(other, n);
    for (size_t u = 0; u < n; u++)
        for (size_t v = 0; v < u; v++)
            CHECK(fabs(apart(x + 3 * u, x + 3 * v) - apart(a.positions + 3 * u, a.positions + 3 * v)) < 1e-9);
    for (size_t k = 0; k + 3 < n; k++) {
        double before[4], after[4];
        for (size_t j = 0; j < 4; j++) {
            const size_t u = 3 * (k + j), v = 3 * (k + (j + 1) % 4);
            before[j] = apart(a.positions + u, a.positions + v), after[j] = apart(y + u, y + v);
        }
        const double ratio = before[0] * before[2] / (before[1] * before[3]);
        CHECK(fabs(after[0] * after[2] / (after[1] * after[3]) - ratio) < 1e-8 * ratio);
    }
    /* The plane is the stereographic image. */
    double *plane = (double *)room(2 * n, sizeof *plane), *lifted = (double *)room(3 * n, sizeof *lifted);
    double *flat = (double *)room(2 * n, sizeof *flat);
    OK(ricci_sphere_plane(sphere, plane, 2 * n));
    OK(ricci_stereographic_lift(plane, n, lifted, 3 * n));
    CHECK(memcmp(lifted, x, 3 * n * sizeof *x) == 0);
    OK(ricci_stereographic_project(x, n, flat, 2 * n));
    for (size_t v = 0; v < n; v++) {
        const double *z = plane + 2 * v, size = hypot(z[0], z[1]);
        if (v == s.puncture)
            CHECK(x[3 * v + 2] == -1 && size == HUGE_VAL && flat[2 * v] == HUGE_VAL);
        else
            CHECK(hypot(flat[2 * v] - z[0], flat[2 * v + 1] - z[1]) < 1e-13 * (1 + size * size));
    }
    lifted[2] = 1.5, flat[3] = HUGE_VAL - HUGE_VAL;
    FAILS(ricci_stereographic_project(lifted, n, flat, 2 * n), RICCI_ARGUMENT, "row 0");
    FAILS(ricci_stereographic_lift(flat, n, lifted, 3 * n), RICCI_ARGUMENT, "row 1");
    FAILS(ricci_stereographic_lift(plane, n, lifted, 3 * n - 1), RICCI_BUFFER_TOO_SMALL, "points");
    FAILS(ricci_stereographic_project(NULL, n, flat, 2 * n), RICCI_NULL_POINTER, "points");
    free(x), free(y), free(plane), free(lifted), free(flat), arrays_free(&a);
    ricci_sphere_free(sphere), ricci_sphere_free(other), ricci_mesh_free(mesh), ricci_mesh_free(inverted);
}

/* Six times the volume of the cone from the centre over a face. */
static double cone(const double *x, const uint32_t *face) {
    const double *p = x + 3 * face[0], *q = x + 3 * face[1], *r = x + 3 * face[2];
    return p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) +
           p[2] * (q[0] * r[1] - q[1] * r[0]);
}

/* On an ellipsoid with flips: metric, polyhedron and refinement are one surface. */
static void metric_polyhedron_and_refinement_agree(void) {
    ricci_mesh *mesh = NULL, *ball = NULL, *intrinsic = NULL, *outside = NULL, *image = NULL;
    ricci_metric *metric = NULL;
    ricci_metric_summary m;
    ricci_sphere *sphere = NULL;
    OK(ricci_shape_ellipsoid(1, 0.6, 1.7, 6, &mesh));
    OK(ricci_sphere_new(mesh, NULL, NULL, &sphere));
    const ricci_sphere_summary s = summary_of(sphere);
    OK(ricci_sphere_metric(sphere, &metric));
    OK(ricci_metric_summarise(metric, &m, sizeof m));
    OK(ricci_metric_mesh(metric, &intrinsic));
    OK(ricci_sphere_mesh(sphere, &ball));
    arrays i = arrays_of(intrinsic, 0), b = arrays_of(ball, 1), given = arrays_of(mesh, 1);
    CHECK(m.space == RICCI_SPACE_S2 && m.n_flips == s.n_flips + s.n_start_flips &&
          fabs(m.area - 4 * pi) < 1e-9);
    CHECK(memcmp(i.faces, b.faces, 3 * s.n_faces * sizeof *i.faces) == 0);
    /* Chords of the metric's arcs. */
    for (size_t e = 0; e < i.n.n_edges; e++) CHECK(fabs(2 * sin(i.lengths[e] / 2) - b.lengths[e]) < 1e-9);
    for (size_t f = 0; f < s.n_faces; f++) CHECK(cone(b.positions, b.faces + 3 * f) > 0);
    OK(ricci_sphere_refined(sphere, NULL, &outside, &image));
    arrays o = arrays_of(outside, 1), r = arrays_of(image, 1);
    CHECK(m.n_flips > 0 && o.n.n_vertices > given.n.n_vertices && o.n.euler == 2);
    CHECK(memcmp(o.faces, r.faces, 3 * o.n.n_faces * sizeof *o.faces) == 0);
    CHECK(memcmp(o.positions, given.positions, 3 * given.n.n_vertices * sizeof *o.positions) == 0);
    CHECK(memcmp(r.positions, b.positions, 3 * given.n.n_vertices * sizeof *r.positions) == 0);
    for (size_t v = 0; v < r.n.n_vertices; v++) {
        const double *x = r.positions + 3 * v;
        CHECK(fabs(hypot(hypot(x[0], x[1]), x[2]) - 1) < 1e-15);
    }
    for (size_t f = 0; f < r.n.n_faces; f++) CHECK(cone(r.positions, r.faces + 3 * f) > 0);
    arrays_free(&i), arrays_free(&b), arrays_free(&given), arrays_free(&o), arrays_free(&r);
    ricci_metric_free(metric), ricci_sphere_free(sphere);
    ricci_mesh_free(mesh), ricci_mesh_free(ball), ricci_mesh_free(intrinsic);
    ricci_mesh_free(outside), ricci_mesh_free(image);
}

static void any_threads_give_the_same_bits_and_options_count(void) {
    ricci_mesh *mesh = NULL;
    ricci_sphere *spheres[3] = {NULL, NULL, NULL}, *from_7 = NULL;
    ricci_sphere_options options;
    OK(ricci_shape_ellipsoid(1, 1.3, 0.5, 12, &mesh));
    arrays a = arrays_of(mesh, 0);
    const size_t n = a.n.n_vertices;
    OK(ricci_sphere_options_init(&options, sizeof options));
    CHECK(options.puncture == -1 && options.tolerance == 1e-10 && options.threads == 0);
    options.threads = 1;
    OK(ricci_sphere_new(mesh, &options, NULL, &spheres[0]));
    options.threads = 3;
    OK(ricci_sphere_new(mesh, &options, NULL, &spheres[1]));
    OK(ricci_sphere_from_lengths(mesh, a.lengths, a.n.n_edges, RICCI_SPACE_E2, NULL, NULL, &spheres[2]));
    double *x = positions_of(spheres[0], n);
    for (int i = 1; i < 3; i++) {
        double *y = positions_of(spheres[i], n);
        CHECK(memcmp(x, y, 3 * n * sizeof *x) == 0);
        free(y);
    }
    options.puncture = 7;
    OK(ricci_sphere_new(mesh, &options, NULL, &from_7));
    CHECK(summary_of(from_7).puncture == 7);
    /* The same sphere, turned. */
    double *y = positions_of(from_7, n);
    for (size_t v = 1; v < n; v++) CHECK(fabs(apart(x, x + 3 * v) - apart(y, y + 3 * v)) < 1e-8);
    free(x), free(y), arrays_free(&a);
    for (int i = 0; i < 3; i++) ricci_sphere_free(spheres[i]);
    ricci_sphere_free(from_7), ricci_mesh_free(mesh);
}

static void what_is_no_sphere_is_refused(void) {
    ricci_mesh *torus = NULL, *disk = NULL, *ball = NULL, *three = NULL, *one = NULL, *two = NULL;
    ricci_sphere *none = NULL, *sphere = NULL;
    ricci_control *control = NULL;
    ricci_sphere_options options;
    ricci_sphere_summary s;
    double x[3];
    /* A tetrahedron without positions. */
    const uint32_t faces[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    const int32_t edges[4][3] = {{4, -2, 1}, {-5, -1, 3}, {-6, -4, 5}, {-3, 2, 6}};
    const double lengths[6] = {1, 1, 1, 1, 1, 1};
    OK(ricci_shape_torus(2, 1, 6, 5, &torus));
    OK(ricci_shape_disk(2, &disk));
    OK(ricci_shape_sphere(2, &ball));
    OK(ricci_shape_two_triangles(&three));
    FAILS(ricci_sphere_new(torus, NULL, NULL, &none), RICCI_ARGUMENT, "genus 0");
    FAILS(ricci_sphere_new(disk, NULL, NULL, &none), RICCI_ARGUMENT, "with boundary");
    FAILS(ricci_sphere_new(three, NULL, NULL, &none), RICCI_ARGUMENT, "four vertices");
    FAILS(ricci_sphere_new(NULL, NULL, NULL, &none), RICCI_NULL_POINTER, "mesh");
    FAILS(ricci_sphere_new(ball, NULL, NULL, NULL), RICCI_NULL_POINTER, "sphere");
    FAILS(ricci_sphere_from_lengths(ball, x, 3, RICCI_SPACE_E2, NULL, NULL, &none), RICCI_WRONG_SIZE,
          "lengths");
    OK(ricci_sphere_options_init(&options, sizeof options));
    options.puncture = 1000000;
    FAILS(ricci_sphere_new(ball, &options, NULL, &none), RICCI_ARGUMENT, "1000000");
    options.puncture = -3;
    FAILS(ricci_sphere_new(ball, &options, NULL, &none), RICCI_ARGUMENT, "puncture is -3");
    options.size = 12;
    FAILS(ricci_sphere_new(ball, &options, NULL, &none), RICCI_STRUCT_SIZE, "size 12");
    OK(ricci_control_new(&control));
    OK(ricci_control_cancel(control));
    FAILS(ricci_sphere_new(ball, NULL, control, &none), RICCI_CANCELLED, "");
    CHECK(none == NULL);
    ricci_mesh *tetrahedron = NULL;
    OK(ricci_mesh_from_gluing(4, faces[0], edges[0], 4, lengths, 6, RICCI_SPACE_E2, &tetrahedron));
    OK(ricci_sphere_new(tetrahedron, NULL, NULL, &sphere));
    s = summary_of(sphere);
    double *y = positions_of(sphere, 4);
    for (int v = 1; v < 4; v++) CHECK(fabs(apart(y, y + 3 * v) - sqrt(8.0 / 3)) < 1e-10);
    FAILS(ricci_sphere_refined(sphere, NULL, &one, &two), RICCI_ARGUMENT, "intrinsic");
    CHECK(one == NULL && two == NULL);
    OK(ricci_sphere_refined(sphere, NULL, NULL, &two));
    FAILS(ricci_sphere_refined(sphere, control, NULL, &one), RICCI_CANCELLED, "");
    FAILS(ricci_sphere_positions(sphere, x, 3), RICCI_BUFFER_TOO_SMALL, "12 entries");
    FAILS(ricci_sphere_plane(sphere, NULL, 8), RICCI_NULL_POINTER, "points");
    FAILS(ricci_sphere_mesh(NULL, &one), RICCI_NULL_POINTER, "sphere");
    FAILS(ricci_sphere_summarise(sphere, &s, 4), RICCI_STRUCT_SIZE, "size 4");
    /* Both sides of a square: four vertices on a circle. */
    const double corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const uint32_t sides[4][3] = {{0, 1, 2}, {0, 2, 3}, {1, 0, 3}, {1, 3, 2}};
    ricci_mesh *square = NULL;
    OK(ricci_mesh_from_arrays(corners[0], 0, 4, sides[0], 4, &square));
    FAILS(ricci_sphere_new(square, NULL, NULL, &none), RICCI_LAYOUT,
          "all 4 vertices come to lie on one circle");
    ricci_mesh_free(square);
    free(y), ricci_sphere_free(NULL), ricci_sphere_free(sphere), ricci_control_free(control);
    ricci_mesh_free(torus), ricci_mesh_free(disk), ricci_mesh_free(ball), ricci_mesh_free(three);
    ricci_mesh_free(two), ricci_mesh_free(tetrahedron);
}

int main(void) {
    round_spheres_come_back();
    metric_polyhedron_and_refinement_agree();
    any_threads_give_the_same_bits_and_options_count();
    what_is_no_sphere_is_refused();
    return 0;
}
