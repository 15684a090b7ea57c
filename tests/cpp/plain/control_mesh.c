/* Splines over control meshes: what they are, what is refused, their file. */
#include "check.h"
#include <math.h>
#include <ricci/control_mesh.h>

static const double cube[] = {-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1,
                              -1, -1, 1,  1, -1, 1,  -1, 1, 1,  1, 1, 1};
static const uint32_t sides[] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 1, 3, 7, 5, 3, 2, 6, 7, 2, 0, 4, 6};

static ricci_control_mesh control_mesh(const double *positions, const uint32_t *quads, size_t n_quads) {
    ricci_control_mesh mesh;
    INIT(mesh);
    mesh.positions = positions, mesh.n_vertices = 8, mesh.quads = quads, mesh.n_quads = n_quads;
    return mesh;
}

static void fits_a_cube(void) {
    const ricci_control_mesh mesh = control_mesh(cube, sides, 6);
    ricci_quad_spline_options lax;
    INIT(lax);
    lax.tolerance = 0.02;
    ricci_quad_spline *spline = NULL;
    OK(ricci_quad_spline_fit_quads(&mesh, &lax, NULL, &spline));
    ricci_quad_spline_summary s;
    OK(ricci_quad_spline_summarise(spline, &s, sizeof s));
    CHECK(s.n_patches == 6 && s.n_arcs == 12 && s.n_nodes == 8 && s.converged && s.normal_jump < 1e-7);
    /* Between those of the balls that touch its corners and that lie inside. */
    CHECK(s.volume > 1.6 && s.volume < 3.5);
    OK(ricci_quad_spline_write_json(spline, "control_mesh.json"));
    CHECK(ricci_quad_spline_write_json(spline, "no/such/folder.json") == RICCI_IO);
    FAILS(ricci_quad_spline_write_json(spline, "control_mesh.step"), RICCI_UNKNOWN_FORMAT, ".json");
    ricci_quad_spline_free(spline);
}

static void refuses(void) {
    ricci_control_mesh mesh = control_mesh(cube, sides, 6);
    ricci_quad_spline *none = NULL;
    CHECK(ricci_quad_spline_fit_quads(NULL, NULL, NULL, &none) == RICCI_NULL_POINTER);
    CHECK(ricci_quad_spline_fit_quads(&mesh, NULL, NULL, NULL) == RICCI_NULL_POINTER);
    mesh.quads = NULL;
    FAILS(ricci_quad_spline_fit_quads(&mesh, NULL, NULL, &none), RICCI_NULL_POINTER, "quads");
    mesh.quads = sides, mesh.n_quads = 0;
    FAILS(ricci_quad_spline_fit_quads(&mesh, NULL, NULL, &none), RICCI_SPLINE, "none");
    static const uint32_t twice[] = {0, 2, 3, 1, 0, 2, 6, 4}, negative[] = {0, 2, 3, UINT32_MAX};
    mesh = control_mesh(cube, twice, 2);
    FAILS(ricci_quad_spline_fit_quads(&mesh, NULL, NULL, &none), RICCI_SPLINE,
          "0\xe2\x80\x93"
          "2");
    mesh = control_mesh(cube, negative, 1);
    FAILS(ricci_quad_spline_fit_quads(&mesh, NULL, NULL, &none), RICCI_ARGUMENT, "negative");
    double odd[24];
    for (size_t k = 0; k < 24; k++) odd[k] = cube[k];
    odd[5] = NAN;
    mesh = control_mesh(odd, sides, 6);
    FAILS(ricci_quad_spline_fit_quads(&mesh, NULL, NULL, &none), RICCI_SPLINE, "finite");
    CHECK(none == NULL);
}

int main(void) {
    fits_a_cube();
    refuses();
    return 0;
}
