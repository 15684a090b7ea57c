// A smooth surface over a whole torus: the mesh becomes flat, a cubic spline is fitted to its vertices, and
// is asked for its curvature, for the points nearest to some others, and for a fine mesh.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ricci/shapes.h>
#include <ricci/spline.hpp>

int main(int argc, char **argv) {
    try {
        ricci_shape shape = ricci::init<ricci_shape>();
        shape.shape = RICCI_SHAPE_TORUS;
        shape.n = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 64;
        shape.m = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 32;
        shape.a = 2, shape.b = 0.8;
        const ricci::mesh torus(ricci::make<ricci_mesh>(ricci_make, &shape));
        const ricci::metric flat = ricci::flow(ricci::metric(torus), ricci::target::uniform());

        const ricci::spline surface = ricci::spline::of_surface(flat);
        const ricci_spline_summary figures = surface.summary();
        std::printf("%zu vertices, %zu patches, %zu control points: off by %.1e on average, %.1e at most\n",
                    shape.n * shape.m, figures.n_patches, figures.n_control_points, figures.fit_rms,
                    figures.fit_max);

        // The nearest points of the surface to some on its circle inside, where all of a meridian is as near.
        std::vector<double> points;
        for (int k = 0; k < 8; k++) {
            const double angle = k * std::atan(1.0);
            points.insert(points.end(), {2 * std::cos(angle), 2 * std::sin(angle), 0.1});
        }
        const ricci::closest_points nearest = surface.closest(points);
        std::vector<double> places;
        for (std::size_t k = 0; k < nearest.patches.size(); k++)
            places.insert(places.end(), {nearest.values[6 * k], nearest.values[6 * k + 1]});
        const std::vector<double> shapes = surface.evaluate(nearest.patches, places, RICCI_SPLINE_SHAPE);
        double worst = 0;
        for (std::size_t k = 0; k < nearest.patches.size(); k++) {
            std::printf("distance %.4f, principal curvatures %.2f and %.2f\n", nearest.values[6 * k + 5],
                        shapes[5 * k + 3], shapes[5 * k + 4]);
            worst = std::fmax(worst, std::abs(nearest.values[6 * k + 5] - 0.7));
        }
        surface.tessellated(4).write("torus.obj");
        surface.write("torus.json");
        return worst < 0.02 ? 0 : 1;
    } catch (const ricci::error &error) {
        std::fprintf(stderr, "%s: %s\n", ricci_status_text(error.status()), error.what());
        return 1;
    }
}
