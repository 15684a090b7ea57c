/* Closed surfaces of genus 0 on the unit sphere: the round sphere comes back, inversions change nothing, and
 * maps lead back to the mesh. */
#include "arrays.h"
#include "samples.h"
#include <ricci/uniformize.h>

static double apart(const double *p, const double *q) {
    return sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                (p[2] - q[2]) * (p[2] - q[2]));
}

static double *positions_of(const ricci_uniform *sphere, size_t n) {
    double *x = (double *)room(3 * n, sizeof *x);
    OK(ricci_sphere_points(sphere, RICCI_MODEL_AMBIENT, x, 3 * n));
    for (size_t v = 0; v < n; v++)
        CHECK(fabs(hypot(hypot(x[3 * v], x[3 * v + 1]), x[3 * v + 2]) - 1) < 1e-15);
    return x;
}

static ricci_uniform_summary summary_of(const ricci_uniform *sphere) {
    ricci_uniform_summary s;
    OK(ricci_uniform_summarise(sphere, &s, sizeof s));
    CHECK(s.converged && s.stop_reason == RICCI_STOP_CONVERGED);
    CHECK(s.max_curvature_error < 1e-10 && s.angle_defect < 1e-10 && s.gauss_bonnet < 1e-10);
    CHECK(s.delaunay_violation < 1e-9 && s.outline_turning > -1e-9 && s.nonconvexity < 1e-12 &&
          s.off_centre < 1e-9);
    return s;
}

/* A polyhedron that is inscribed in the sphere already, with its mean at the centre, is the only one: up to a
 * rotation. After an inversion its faces have other areas, so its mean is another, but cross-ratios of chords
 * are what they were. */
static void round_spheres_come_back(void) {
    ricci_mesh *mesh = NULL, *inverted = NULL;
    ricci_uniform *sphere = NULL, *other = NULL;
    const double centre[3] = {1.2, 0.5, -0.3};
    OK(make_sphere(5, &mesh));
    OK(invert(mesh, centre, 1, &inverted));
    OK(ricci_uniformize(mesh, NULL, NULL, &sphere));
    OK(ricci_uniformize(inverted, NULL, NULL, &other));
    arrays a = arrays_of(mesh, 1);
    const size_t n = a.n.n_vertices;
    const ricci_uniform_summary s = summary_of(sphere), t = summary_of(other);
    CHECK(s.genus == 0 && s.space == RICCI_SPACE_S2 && t.converged);
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
    double *plane = (double *)room(2 * n, sizeof *plane);
    OK(ricci_sphere_points(sphere, RICCI_MODEL_POINCARE, plane, 2 * n));
    for (size_t v = 0; v < n; v++) {
        const double *z = plane + 2 * v, size = hypot(z[0], z[1]);
        double there[3];
        ricci_to_sphere(z, there);
        CHECK(memcmp(there, x + 3 * v, sizeof there) == 0);
        ricci_to_plane(x + 3 * v, there);
        if (v == s.base)
            CHECK(x[3 * v + 2] == -1 && size == HUGE_VAL && there[0] == HUGE_VAL);
        else
            CHECK(hypot(there[0] - z[0], there[1] - z[1]) < 1e-13 * (1 + size * size));
    }
    FAILS(ricci_sphere_points(sphere, RICCI_MODEL_AMBIENT, plane, 2 * n), RICCI_BUFFER_TOO_SMALL, "points");
    free(x), free(y), free(plane), arrays_free(&a);
    ricci_uniform_free(sphere), ricci_uniform_free(other), ricci_mesh_free(mesh), ricci_mesh_free(inverted);
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
    ricci_map *map = NULL;
    ricci_metric_summary m;
    ricci_uniform *sphere = NULL;
    OK(make_sized(RICCI_SHAPE_ELLIPSOID, 6, 0, 1, 0.6, 1.7, &mesh));
    OK(ricci_uniformize(mesh, NULL, NULL, &sphere));
    const ricci_uniform_summary s = summary_of(sphere);
    OK(ricci_uniform_metric(sphere, &metric));
    OK(ricci_metric_summarise(metric, &m, sizeof m));
    OK(ricci_metric_mesh(metric, &intrinsic));
    OK(ricci_sphere_mesh(sphere, RICCI_ON_METRIC, NULL, &ball));
    arrays i = arrays_of(intrinsic, 0), b = arrays_of(ball, 1), given = arrays_of(mesh, 1);
    CHECK(m.space == RICCI_SPACE_S2 && m.n_flips == s.n_flips + s.n_start_flips &&
          fabs(m.area - 4 * pi) < 1e-9);
    CHECK(memcmp(i.faces, b.faces, 3 * b.n.n_faces * sizeof *i.faces) == 0);
    /* Chords of the metric's arcs. */
    for (size_t e = 0; e < i.n.n_edges; e++) CHECK(fabs(2 * sin(i.lengths[e] / 2) - b.lengths[e]) < 1e-9);
    for (size_t f = 0; f < b.n.n_faces; f++) CHECK(cone(b.positions, b.faces + 3 * f) > 0);
    OK(ricci_map_new(metric, NULL, &map));
    OK(ricci_map_mesh(map, &outside));
    OK(ricci_sphere_mesh(sphere, RICCI_ON_REFINEMENT, NULL, &image));
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
    ricci_metric_free(metric), ricci_map_free(map), ricci_uniform_free(sphere);
    ricci_mesh_free(mesh), ricci_mesh_free(ball), ricci_mesh_free(intrinsic);
    ricci_mesh_free(outside), ricci_mesh_free(image);
}

static void any_threads_give_the_same_bits_and_options_count(void) {
    ricci_mesh *mesh = NULL, *measured = NULL;
    ricci_uniform *spheres[3] = {NULL, NULL, NULL}, *from_7 = NULL;
    ricci_uniform_options options;
    ricci_flow_options flow;
    const uint32_t seven = 7;
    OK(make_sized(RICCI_SHAPE_ELLIPSOID, 12, 0, 1, 1.3, 0.5, &mesh));
    arrays a = arrays_of(mesh, 0);
    const size_t n = a.n.n_vertices;
    INIT(options), INIT(flow);
    options.flow = &flow;
    flow.threads = 1;
    OK(ricci_uniformize(mesh, &options, NULL, &spheres[0]));
    flow.threads = 3;
    OK(ricci_uniformize(mesh, &options, NULL, &spheres[1]));
    OK(ricci_mesh_with_lengths(mesh, a.lengths, a.n.n_edges, RICCI_SPACE_E2, &measured));
    OK(ricci_uniformize(measured, NULL, NULL, &spheres[2]));
    double *x = positions_of(spheres[0], n);
    for (int i = 1; i < 3; i++) {
        double *y = positions_of(spheres[i], n);
        CHECK(memcmp(x, y, 3 * n * sizeof *x) == 0);
        free(y);
    }
    options.base = &seven;
    OK(ricci_uniformize(mesh, &options, NULL, &from_7));
    CHECK(summary_of(from_7).base == 7);
    /* The same sphere, turned. */
    double *y = positions_of(from_7, n);
    for (size_t v = 1; v < n; v++) CHECK(fabs(apart(x, x + 3 * v) - apart(y, y + 3 * v)) < 1e-8);
    free(x), free(y), arrays_free(&a);
    for (int i = 0; i < 3; i++) ricci_uniform_free(spheres[i]);
    ricci_uniform_free(from_7), ricci_mesh_free(mesh), ricci_mesh_free(measured);
}

/* By the gradient flow in S2: on the given triangulation, with a report, without a plane. */
static void spheres_flow_in_their_own_space(void) {
    ricci_mesh *mesh = NULL, *ball = NULL;
    ricci_uniform *sphere = NULL;
    ricci_metric *metric = NULL;
    ricci_uniform_options options;
    ricci_flow_options flow;
    ricci_uniform_summary s;
    ricci_report_summary report;
    const uint32_t five = 5;
    double *plane;
    INIT(options), INIT(flow);
    flow.method = RICCI_METHOD_GRADIENT;
    options.flow = &flow, options.base = &five, options.scheme = RICCI_SCHEME_INVERSIVE;
    OK(make_sized(RICCI_SHAPE_ELLIPSOID, 6, 0, 1, 0.9, 1.2, &mesh));
    OK(ricci_uniformize(mesh, &options, NULL, &sphere));
    OK(ricci_uniform_summarise(sphere, &s, sizeof s));
    CHECK(s.converged && s.base == 5 && s.space == RICCI_SPACE_S2 && s.angle_defect < 1e-9);
    CHECK(s.n_flips == 0 && s.n_tried == 0 && s.smallest_edge > 0);
    OK(ricci_uniform_metric(sphere, &metric));
    OK(ricci_report_summarise(metric, &report, sizeof report));
    CHECK(report.iterations == s.iterations && report.converged);
    OK(ricci_sphere_mesh(sphere, RICCI_ON_METRIC, NULL, &ball));
    arrays b = arrays_of(ball, 1);
    for (size_t f = 0; f < b.n.n_faces; f++) CHECK(cone(b.positions, b.faces + 3 * f) > 0);
    free(positions_of(sphere, b.n.n_vertices));
    plane = (double *)room(2 * b.n.n_vertices, sizeof *plane);
    FAILS(ricci_sphere_points(sphere, RICCI_MODEL_POINCARE, plane, 2 * b.n.n_vertices), RICCI_LAYOUT,
          "RICCI_MODEL_AMBIENT");
    free(plane), arrays_free(&b);
    ricci_metric_free(metric), ricci_uniform_free(sphere), ricci_mesh_free(mesh), ricci_mesh_free(ball);
}

static void what_is_no_sphere_is_refused(void) {
    ricci_mesh *ball = NULL, *three = NULL, *two = NULL, *none_mesh = NULL;
    ricci_uniform *none = NULL, *sphere = NULL;
    ricci_control *control = NULL;
    ricci_layout *layout = NULL;
    ricci_uniform_summary s;
    double x[3];
    /* A tetrahedron without positions. */
    const uint32_t faces[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    const int32_t edges[4][3] = {{4, -2, 1}, {-5, -1, 3}, {-6, -4, 5}, {-3, 2, 6}};
    const double lengths[6] = {1, 1, 1, 1, 1, 1};
    OK(make_sphere(2, &ball));
    OK(make_glued(RICCI_SHAPE_TWO_TRIANGLES, 0, &three));
    FAILS(ricci_uniformize(three, NULL, NULL, &none), RICCI_ARGUMENT, "four vertices");
    OK(ricci_control_new(&control));
    OK(ricci_control_cancel(control));
    FAILS(ricci_uniformize(ball, NULL, control, &none), RICCI_CANCELLED, "");
    CHECK(none == NULL);
    ricci_mesh *tetrahedron = NULL;
    ricci_gluing gluing;
    INIT(gluing);
    gluing.n_vertices = 4, gluing.faces = faces[0], gluing.face_edges = edges[0], gluing.n_faces = 4;
    gluing.lengths = lengths, gluing.n_edges = 6;
    OK(ricci_mesh_from_gluing(&gluing, &tetrahedron));
    OK(ricci_uniformize(tetrahedron, NULL, NULL, &sphere));
    s = summary_of(sphere);
    double *y = positions_of(sphere, 4);
    for (int v = 1; v < 4; v++) CHECK(fabs(apart(y, y + 3 * v) - sqrt(8.0 / 3)) < 1e-10);
    OK(ricci_sphere_mesh(sphere, RICCI_ON_REFINEMENT, NULL, &two));
    FAILS(ricci_sphere_mesh(sphere, RICCI_ON_INPUT, NULL, &none_mesh), RICCI_LAYOUT, "RICCI_ON_METRIC");
    FAILS(ricci_uniform_layout(sphere, RICCI_ON_METRIC, RICCI_MODEL_KLEIN, NULL, &layout), RICCI_LAYOUT,
          "sphere");
    FAILS(ricci_sphere_points(sphere, RICCI_MODEL_AMBIENT, x, 3), RICCI_BUFFER_TOO_SMALL, "12 entries");
    FAILS(ricci_sphere_points(sphere, RICCI_MODEL_POINCARE, NULL, 8), RICCI_NULL_POINTER, "points");
    FAILS(ricci_uniform_summarise(sphere, &s, 4), RICCI_STRUCT_SIZE, "size 4");
    /* Both sides of a square: four vertices on a circle. */
    const double corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const uint32_t sides[4][3] = {{0, 1, 2}, {0, 2, 3}, {1, 0, 3}, {1, 3, 2}};
    ricci_mesh *square = NULL;
    OK(ricci_mesh_from_arrays(corners[0], 0, 4, sides[0], 4, &square));
    FAILS(ricci_uniformize(square, NULL, NULL, &none), RICCI_LAYOUT,
          "all 4 vertices come to lie on one circle");
    ricci_mesh_free(square);
    free(y), ricci_uniform_free(sphere), ricci_control_free(control);
    ricci_mesh_free(ball), ricci_mesh_free(three), ricci_mesh_free(two), ricci_mesh_free(tetrahedron);
}

int main(void) {
    round_spheres_come_back();
    metric_polyhedron_and_refinement_agree();
    any_threads_give_the_same_bits_and_options_count();
    spheres_flow_in_their_own_space();
    what_is_no_sphere_is_refused();
    return 0;
}
