// A smooth surface through noisy heights over an L-shaped sheet: a cubic spline is fitted to them, and its
// height, slope and curvature are asked for at a few places.
#include <cmath>
#include <cstdio>
#include <ricci/spline.hpp>

namespace {

double hill(double x, double y) {
    return 0.4 * std::exp(-3 * ((x - 0.6) * (x - 0.6) + (y - 0.6) * (y - 0.6)));
}

} // namespace

int main() {
    try {
        const std::vector<double> sheet = {0, 0, 2, 0, 2, 1, 1, 1, 1, 2, 0, 2};
        const ricci::spline flat(ricci::spline_domain(sheet, 0.25));

        // Heights on a grid, as far as it lies on the sheet.
        std::vector<double> grid, heights;
        for (int i = 0; i <= 60; i++)
            for (int j = 0; j <= 60; j++) grid.insert(grid.end(), {i / 30.0, j / 30.0});
        const auto patches = flat.locate(grid);
        for (std::size_t k = 0; k < patches.size(); k++)
            if (patches[k] >= 0) {
                const double x = grid[2 * k], y = grid[2 * k + 1], noise = 1e-3 * std::sin(1e4 * double(k));
                heights.insert(heights.end(), {x, y, hill(x, y) + noise});
            }
        const ricci::spline surface = flat.fitted(heights);
        const auto figures = surface.summary();
        std::printf("%zu heights, %zu patches, %zu control points: off by %.1e on average, %.1e at most\n",
                    heights.size() / 3, figures.n_patches, figures.n_control_points, figures.fit_rms,
                    figures.fit_max);

        // Many places at a time: points with derivatives, and the shape.
        const std::vector<double> places = {0.6, 0.6, 0.3, 0.9, 1.7, 0.4, 0.5, 1.8};
        const auto jets = surface.evaluate(places, RICCI_SPLINE_FIRST);
        const auto shapes = surface.evaluate(places, RICCI_SPLINE_SHAPE);
        double worst = 0;
        for (std::size_t k = 0; k < places.size() / 2; k++) {
            const double *p = &jets[9 * k], *s = &shapes[5 * k];
            std::printf("(%.1f, %.1f): height %.4f, slope (%.3f, %.3f), principal curvatures %.2f and %.2f\n",
                        p[0], p[1], p[2], p[5], p[8], s[3], s[4]);
            worst = std::fmax(worst, std::abs(p[2] - hill(places[2 * k], places[2 * k + 1])));
        }
        surface.tessellated(4).write("sheet.obj");
        return worst < 1e-3 ? 0 : 1;
    } catch (const ricci::error &error) {
        std::fprintf(stderr, "%s: %s\n", ricci_status_text(error.status()), error.what());
        return 1;
    }
}
