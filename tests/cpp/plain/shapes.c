/* Sample surfaces through the C face: topology, known figures, refusals. Writes cones.obj, which
 * other tests read. */
#include "samples.h"
#include <math.h>

static ricci_mesh_summary check(ricci_mesh *mesh, size_t genus, size_t n_boundary_loops) {
    ricci_mesh_summary size;
    OK(ricci_mesh_summarise(mesh, &size, sizeof size));
    CHECK(size.genus == genus && size.n_boundary_loops == n_boundary_loops);
    return size;
}

/* A pair of pants has curvature 0 everywhere. */
static void check_pants(ricci_mesh *mesh) {
    ricci_metric *metric = NULL;
    const ricci_mesh_summary size = check(mesh, 0, 3);
    double *curvature = (double *)malloc(size.n_vertices * sizeof(double));
    CHECK(curvature);
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_H2, &metric));
    OK(ricci_metric_values(metric, RICCI_METRIC_CURVATURE, curvature, size.n_vertices));
    for (size_t v = 0; v < size.n_vertices; v++) CHECK(fabs(curvature[v]) < 1e-12);
    free(curvature);
    ricci_metric_free(metric);
}

/* Right isosceles triangles all over. */
static void shapes_have_their_angles(void) {
    const double places[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const uint32_t faces[6] = {0, 1, 2, 0, 2, 3};
    ricci_mesh *square = NULL;
    ricci_quality_summary shape;
    OK(ricci_mesh_from_arrays(places[0], 0, 4, faces, 2, &square));
    OK(ricci_mesh_quality(square, &shape, sizeof shape));
    CHECK(fabs(shape.area - 1) < 1e-15 && fabs(shape.min_angle - atan(1)) < 1e-15);
    CHECK(shape.obtuse_fraction == 0 && fabs(shape.edge_ratio - sqrt(2)) < 1e-15);
    CHECK(shape.non_delaunay_fraction == 0);
    FAILS(ricci_mesh_quality(NULL, &shape, sizeof shape), RICCI_NULL_POINTER, "mesh");
    ricci_mesh_free(square);
}

int main(void) {
    shapes_have_their_angles();
    ricci_mesh *mesh = NULL, *other = NULL;
    const double square[8] = {1, 0, 0, 1, -1, 0, 0, -1}, centre[3] = {9, 0, 0};
    double tau[2], square_of;
    ricci_shape shape;

    OK(make_sphere(4, &mesh));
    CHECK(check(mesh, 0, 0).n_vertices == 162);
    OK(change(mesh, RICCI_CHANGE_PUNCH, 3, 0, 0, &other));
    check(other, 0, 3), ricci_mesh_free(other);
    OK(change(mesh, RICCI_CHANGE_GRADE, 4, 0, 0, &other));
    CHECK(check(other, 0, 0).n_vertices == 162 + 4 * 5);
    ricci_mesh_free(other);
    OK(change(mesh, RICCI_CHANGE_NEEDLES, 7, 1e-3, 0, &other));
    CHECK(check(other, 0, 0).n_faces == 320 + 14);
    ricci_mesh_free(other);
    OK(change(mesh, RICCI_CHANGE_NOISE, 0, 0.1, 0, &other));
    check(other, 0, 0), ricci_mesh_free(other);
    OK(invert(mesh, centre, 9, &other));
    check(other, 0, 0), ricci_mesh_free(other);
    FAILS(change(mesh, RICCI_CHANGE_PUNCH, 1000, 0, 0, &other), RICCI_ARGUMENT, "holes");
    FAILS(change(mesh, RICCI_CHANGE_GRADE, 1, 0, 162, &other), RICCI_ARGUMENT, "vertex");
    FAILS(change(mesh, 6, 1, 1e-3, 0, &other), RICCI_ARGUMENT, "change is 6");
    FAILS(change(mesh, RICCI_CHANGE_CAPS, 1, 1, 0, &other), RICCI_ARGUMENT, "angle");
    FAILS(change(mesh, RICCI_CHANGE_NOISE, 0, -1, 0, &other), RICCI_ARGUMENT, "noise");
    FAILS(ricci_change(mesh, NULL, &other), RICCI_NULL_POINTER, "change");
    FAILS(change(NULL, RICCI_CHANGE_PUNCH, 1, 0, 0, &other), RICCI_NULL_POINTER, "mesh");
    FAILS(change(mesh, RICCI_CHANGE_PUNCH, 1, 0, 0, NULL), RICCI_NULL_POINTER, "mesh");
    ricci_mesh_free(mesh);

    OK(make_sized(RICCI_SHAPE_ELLIPSOID, 3, 0, 3, 2, 1, &mesh)), check(mesh, 0, 0), ricci_mesh_free(mesh);
    OK(make_disk(5, &mesh)), check(mesh, 0, 1), ricci_mesh_free(mesh);
    OK(make_sized(RICCI_SHAPE_ANNULUS, 4, 20, 0.5, 1, 0, &mesh)), check(mesh, 0, 2), ricci_mesh_free(mesh);
    OK(make_sized(RICCI_SHAPE_TORUS, 20, 10, 2, 1, 0, &mesh)), check(mesh, 1, 0), ricci_mesh_free(mesh);
    OK(make_genus(3, 2, 2, &mesh)), check(mesh, 3, 0), ricci_mesh_free(mesh);
    INIT(shape);
    shape.shape = RICCI_SHAPE_KNOT, shape.p = 2, shape.q = 3, shape.n = 100, shape.m = 8;
    shape.a = 2, shape.b = 0.9, shape.c = 0.4;
    OK(ricci_make(&shape, &mesh)), check(mesh, 1, 0), ricci_mesh_free(mesh);
    shape.q = 4;
    FAILS(ricci_make(&shape, &mesh), RICCI_ARGUMENT, "coprime");
    OK(make_sized(RICCI_SHAPE_FLAT_TORUS, 4, 4, 0.3, 1.2, 0, &mesh)), check(mesh, 1, 0),
        ricci_mesh_free(mesh);
    OK(make_bolza(1, &mesh)), check(mesh, 2, 0), ricci_mesh_free(mesh);
    OK(make_glued(RICCI_SHAPE_ONE_VERTEX, 2, &mesh)), check(mesh, 2, 0), ricci_mesh_free(mesh);
    OK(make_glued(RICCI_SHAPE_TWO_VERTEX, 2, &mesh)), check(mesh, 2, 0);
    FAILS(change(mesh, RICCI_CHANGE_PUNCH, 1, 0, 0, &other), RICCI_ARGUMENT, "intrinsic");
    ricci_mesh_free(mesh);
    OK(make_glued(RICCI_SHAPE_TWO_TRIANGLES, 0, &mesh)), check(mesh, 0, 0), ricci_mesh_free(mesh);
    OK(make_sized(RICCI_SHAPE_PANTS, 2, 0, 1, 2, 3, &mesh));
    check_pants(mesh);
    ricci_mesh_free(mesh);
    INIT(shape);
    shape.shape = RICCI_SHAPE_HYPERELLIPTIC, shape.n = 6, shape.points = square, shape.n_points = 4;
    OK(ricci_make(&shape, &mesh)), check(mesh, 1, 0), ricci_mesh_free(mesh);
    /* Four points at the corners of a square: the square lattice, up to SL(2, Z). */
    OK(ricci_hyperelliptic_periods(square, 4, tau, 2));
    tau[0] -= floor(tau[0] + 0.5);
    square_of = tau[0] * tau[0] + tau[1] * tau[1];
    CHECK(fabs(square_of - 1) < 1e-12 || fabs(square_of - 0.5) < 1e-12);
    FAILS(ricci_hyperelliptic_periods(square, 4, tau, 1), RICCI_BUFFER_TOO_SMALL, "periods");
    shape.n_points = 2;
    FAILS(ricci_make(&shape, &mesh), RICCI_ARGUMENT, "branch points");
    shape.n_points = 4, shape.points = NULL;
    FAILS(ricci_make(&shape, &mesh), RICCI_NULL_POINTER, "points");
    FAILS(make_sized(RICCI_SHAPE_PANTS, 1, 0, 1, 0, 1, &mesh), RICCI_ARGUMENT, "boundary length");
    FAILS(make_glued(15, 1, &mesh), RICCI_ARGUMENT, "shape is 15");
    FAILS(ricci_make(NULL, &mesh), RICCI_NULL_POINTER, "shape");
    FAILS(make_genus(0, 2, 1, &mesh), RICCI_ARGUMENT, "genus");
    FAILS(make_sphere(4, NULL), RICCI_NULL_POINTER, "mesh");
    /* A mesh for the examples. */
    OK(make_sized(RICCI_SHAPE_ELLIPSOID, 12, 0, 1, 0.7, 1.6, &mesh));
    OK(ricci_mesh_write(mesh, NULL, "cones.obj"));
    ricci_mesh_free(mesh);
    return 0;
}
