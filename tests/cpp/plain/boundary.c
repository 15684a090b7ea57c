/* Surfaces with boundary: geodesic loops, and straight sides between corners. */
#include "samples.h"
#include <math.h>
#include <ricci/uniformize.h>

/* A disk as a rectangle and as a triangle with given angles, pants with geodesic boundary. */
static void boundaries_become_geodesics_or_straight_sides(void) {
    const double pi = 3.141592653589793, wanted[3] = {1, 2, 3};
    ricci_mesh *disk = NULL, *pants = NULL;
    ricci_uniform *uniform = NULL, *none = NULL;
    ricci_uniform_options options;
    ricci_uniform_summary s;
    uint32_t from[2 * 4];
    double sides[2 * 4];
    OK(make_disk(4, &disk));
    INIT(options);
    options.boundary = RICCI_BOUNDARY_STRAIGHT;
    OK(ricci_uniformize(disk, &options, NULL, &uniform));
    OK(ricci_uniform_summarise(uniform, &s, sizeof s));
    CHECK(s.converged && s.space == RICCI_SPACE_E2 && s.n_boundary_sides == 4 && s.straightness < 1e-9);
    FAILS(ricci_uniform_sides(uniform, from, sides, 3), RICCI_BUFFER_TOO_SMALL, "lengths");
    OK(ricci_uniform_sides(uniform, from, sides, 4));
    CHECK(fabs(sides[2] / sides[0] - s.extremal_distance) < 1e-9 &&
          fabs(sides[0] * sides[2] - s.area) < 1e-9);
    CHECK(from[0] == 1 && from[1] != from[3]);
    ricci_uniform_free(uniform);
    /* A right angle, a half of it, and what is left: the corners are those of the rectangle but one. */
    const uint32_t corners[3] = {from[1], from[3], from[5]};
    const double angles[3] = {pi / 2, pi / 4, 0};
    options.corners = corners, options.corner_angles = angles, options.n_corners = 3;
    OK(ricci_uniformize(disk, &options, NULL, &uniform));
    OK(ricci_uniform_summarise(uniform, &s, sizeof s));
    OK(ricci_uniform_sides(uniform, from, sides, s.n_boundary_sides));
    CHECK(s.n_boundary_sides == 3 && isnan(s.extremal_distance));
    CHECK(fabs(sides[0] - sides[4]) < 1e-9 && fabs(sides[2] - sqrt(2) * sides[0]) < 1e-9);
    ricci_uniform_free(uniform);
    options.n_corners = 1;
    FAILS(ricci_uniformize(disk, &options, NULL, &none), RICCI_TARGET_TOTAL, "corners");
    options.boundary = 2;
    FAILS(ricci_uniformize(disk, &options, NULL, &none), RICCI_ARGUMENT, "boundary");
    CHECK(none == NULL);
    OK(make(RICCI_SHAPE_PANTS, 0, 3, 0, wanted, &pants));
    OK(ricci_uniformize(pants, NULL, NULL, &uniform));
    OK(ricci_uniform_summarise(uniform, &s, sizeof s));
    CHECK(s.space == RICCI_SPACE_H2 && s.n_boundary_sides == 3 && s.n_generators == 3 &&
          s.straightness < 1e-9);
    CHECK(fabs(s.area - 2 * pi) < 1e-9);
    OK(ricci_uniform_sides(uniform, from, sides, 3));
    for (int k = 0; k < 3; k++) {
        int found = 0;
        for (int j = 0; j < 3; j++) found += fabs(sides[2 * k] - wanted[j]) < 1e-8;
        CHECK(found == 1);
    }
    ricci_uniform_free(uniform), ricci_mesh_free(disk), ricci_mesh_free(pants);
}

int main(void) {
    boundaries_become_geodesics_or_straight_sides();
    return 0;
}
