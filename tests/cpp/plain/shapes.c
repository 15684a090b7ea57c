/* Sample surfaces through the C face: topology, known figures, and what is refused. */
#include "check.h"
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
    OK(ricci_metric_curvature(metric, curvature, size.n_vertices));
    for (size_t v = 0; v < size.n_vertices; v++) CHECK(fabs(curvature[v]) < 1e-12);
    free(curvature);
    ricci_metric_free(metric);
}

int main(void) {
    ricci_mesh *mesh = NULL, *other = NULL;
    const double square[8] = {1, 0, 0, 1, -1, 0, 0, -1}, centre[3] = {9, 0, 0};
    double tau[2], square_of;

    OK(ricci_shape_sphere(4, &mesh));
    CHECK(check(mesh, 0, 0).n_vertices == 162);
    OK(ricci_mesh_punch(mesh, 3, &other));
    check(other, 0, 3), ricci_mesh_free(other);
    OK(ricci_mesh_grade(mesh, 0, 4, &other));
    CHECK(check(other, 0, 0).n_vertices == 162 + 4 * 5);
    ricci_mesh_free(other);
    OK(ricci_mesh_slivers(mesh, RICCI_SLIVER_NEEDLE, 7, 1e-3, 1, &other));
    CHECK(check(other, 0, 0).n_faces == 320 + 14);
    ricci_mesh_free(other);
    OK(ricci_mesh_noise(mesh, 0.1, 1, &other));
    check(other, 0, 0), ricci_mesh_free(other);
    OK(ricci_mesh_invert(mesh, centre, 9, &other));
    check(other, 0, 0), ricci_mesh_free(other);
    FAILS(ricci_mesh_punch(mesh, 1000, &other), RICCI_ARGUMENT, "holes");
    FAILS(ricci_mesh_grade(mesh, 162, 1, &other), RICCI_ARGUMENT, "vertex");
    FAILS(ricci_mesh_slivers(mesh, (ricci_sliver)2, 1, 1e-3, 1, &other), RICCI_ARGUMENT, "sliver");
    FAILS(ricci_mesh_slivers(mesh, RICCI_SLIVER_CAP, 1, 1, 1, &other), RICCI_ARGUMENT, "angle");
    FAILS(ricci_mesh_noise(mesh, -1, 1, &other), RICCI_ARGUMENT, "noise");
    FAILS(ricci_mesh_invert(mesh, NULL, 1, &other), RICCI_NULL_POINTER, "centre");
    FAILS(ricci_mesh_punch(NULL, 1, &other), RICCI_NULL_POINTER, "mesh");
    FAILS(ricci_mesh_punch(mesh, 1, NULL), RICCI_NULL_POINTER, "result");
    ricci_mesh_free(mesh);

    OK(ricci_shape_ellipsoid(3, 2, 1, 3, &mesh)), check(mesh, 0, 0), ricci_mesh_free(mesh);
    OK(ricci_shape_disk(5, &mesh)), check(mesh, 0, 1), ricci_mesh_free(mesh);
    OK(ricci_shape_annulus(0.5, 1, 4, 20, &mesh)), check(mesh, 0, 2), ricci_mesh_free(mesh);
    OK(ricci_shape_torus(2, 1, 20, 10, &mesh)), check(mesh, 1, 0), ricci_mesh_free(mesh);
    OK(ricci_shape_genus(3, 2, 2, &mesh)), check(mesh, 3, 0), ricci_mesh_free(mesh);
    OK(ricci_shape_knot(2, 3, 2, 0.9, 0.4, 100, 8, &mesh)), check(mesh, 1, 0), ricci_mesh_free(mesh);
    OK(ricci_shape_flat_torus(0.3, 1.2, 4, 4, &mesh)), check(mesh, 1, 0), ricci_mesh_free(mesh);
    OK(ricci_shape_bolza(1, &mesh)), check(mesh, 2, 0), ricci_mesh_free(mesh);
    OK(ricci_shape_one_vertex(2, &mesh)), check(mesh, 2, 0), ricci_mesh_free(mesh);
    OK(ricci_shape_two_vertex(2, &mesh)), check(mesh, 2, 0);
    FAILS(ricci_mesh_punch(mesh, 1, &other), RICCI_ARGUMENT, "intrinsic");
    ricci_mesh_free(mesh);
    OK(ricci_shape_two_triangles(&mesh)), check(mesh, 0, 0), ricci_mesh_free(mesh);
    OK(ricci_shape_pants(1, 2, 3, 2, &mesh));
    check_pants(mesh);
    ricci_mesh_free(mesh);
    OK(ricci_shape_hyperelliptic(square, 4, 6, &mesh)), check(mesh, 1, 0), ricci_mesh_free(mesh);
    /* Four points at the corners of a square: the square lattice, up to SL(2, Z). */
    OK(ricci_shape_hyperelliptic_periods(square, 4, tau, 2));
    tau[0] -= floor(tau[0] + 0.5);
    square_of = tau[0] * tau[0] + tau[1] * tau[1];
    CHECK(fabs(square_of - 1) < 1e-12 || fabs(square_of - 0.5) < 1e-12);
    FAILS(ricci_shape_hyperelliptic_periods(square, 4, tau, 1), RICCI_BUFFER_TOO_SMALL, "periods");
    FAILS(ricci_shape_hyperelliptic(square, 2, 6, &mesh), RICCI_ARGUMENT, "branch points");
    FAILS(ricci_shape_hyperelliptic(NULL, 4, 6, &mesh), RICCI_NULL_POINTER, "points");
    FAILS(ricci_shape_pants(1, 0, 1, 1, &mesh), RICCI_ARGUMENT, "boundary length");
    FAILS(ricci_shape_knot(2, 4, 2, 0.9, 0.4, 100, 8, &mesh), RICCI_ARGUMENT, "coprime");
    FAILS(ricci_shape_genus(0, 2, 1, &mesh), RICCI_ARGUMENT, "genus");
    FAILS(ricci_shape_sphere(4, NULL), RICCI_NULL_POINTER, "mesh");
    return 0;
}
