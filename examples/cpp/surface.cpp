// A smooth surface over a whole torus: the mesh becomes flat, a cubic spline is fitted to its vertices, and
// is asked for its curvature, for the points nearest to some others, for a fine mesh, and for a solid for
// CAD.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ricci/bicubic.hpp>
#include <ricci/shapes.h>

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

        // Patches that differ from the surface by a thousandth of its size, with normals that turn by a
        // degree at common sides, as one solid in millimetres.
        ricci_bicubic_options asked = ricci::init<ricci_bicubic_options>();
        const double degrees = 45 / std::atan(1.0);
        asked.tolerance = 1e-3, asked.angle = 1 / degrees;
        const ricci::bicubic patches(surface, asked);
        const ricci_bicubic_summary report = patches.summary();
        std::printf(
            "%zu bicubic patches, %zu to %zu spans a side, %zu control points, %s: off by %.1e of the "
            "diagonal, normals turn by %.2f degrees at most, %.3f on average\n",
            report.n_patches, report.spans_min, report.spans_max, report.n_control_points,
            report.closed ? "closed" : "open", report.distance, degrees * report.normal_jump_max,
            degrees * report.normal_jump_mean);
        ricci_step_options step = ricci::init<ricci_step_options>();
        step.name = "torus";
        patches.write("torus.step", step);
        return worst < 0.02 && report.closed && report.n_open_sides == 0 ? 0 : 1;
    } catch (const ricci::error &error) {
        std::fprintf(stderr, "%s: %s\n", ricci_status_text(error.status()), error.what());
        return 1;
    }
}
