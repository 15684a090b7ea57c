// The patches of a spline in memory, as a CAD kernel takes them: poles, distinct knots and multiplicities of
// each surface and of each curve, and which surfaces meet along which curve. In OpenCASCADE, with the arrays
// counted from 1, a patch is
//
//     Handle(Geom_BSplineSurface) face = new Geom_BSplineSurface(
//         poles, knots_u, knots_v, multiplicities_u, multiplicities_v, degree_u, degree_v, false, false);
//
// and an arc Geom_BSplineCurve(poles, knots, multiplicities, degree). Here the arrays are evaluated by de
// Boor's recurrence, and compared with what the library says.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ricci/quad_spline.hpp>
#include <ricci/shapes.h>

using point = std::array<double, 3>;

// What a kernel is told of a curve, or of a surface in one direction.
struct direction {
    std::size_t degree;
    ricci::knot_list knots;
    // Every knot as often as it occurs.
    std::vector<double> all() const {
        std::vector<double> flat;
        for (std::size_t k = 0; k < knots.knots.size(); k++)
            flat.insert(flat.end(), knots.multiplicities[k], knots.knots[k]);
        return flat;
    }
};

// De Boor's recurrence: the point of a curve with these poles.
static point on_curve(const direction &along, const std::vector<point> &poles, double x) {
    const std::vector<double> knots = along.all();
    std::size_t span = along.degree;
    while (span + 1 < poles.size() && knots[span + 1] <= x) span++;
    std::vector<point> local(poles.begin() + static_cast<std::ptrdiff_t>(span - along.degree),
                             poles.begin() + static_cast<std::ptrdiff_t>(span + 1));
    for (std::size_t step = 1; step <= along.degree; step++)
        for (std::size_t j = along.degree; j >= step; j--) {
            const double low = knots[span - along.degree + j], high = knots[span + 1 + j - step];
            const double share = (x - low) / (high - low);
            for (std::size_t i = 0; i < 3; i++)
                local[j][i] = (1 - share) * local[j - 1][i] + share * local[j][i];
        }
    return local[along.degree];
}

static std::vector<point> points_of(const std::vector<double> &numbers) {
    std::vector<point> points;
    for (std::size_t k = 0; k < numbers.size(); k += 3)
        points.push_back({{numbers[k], numbers[k + 1], numbers[k + 2]}});
    return points;
}

static double distance(const point &a, const point &b) {
    return std::sqrt(std::pow(a[0] - b[0], 2) + std::pow(a[1] - b[1], 2) + std::pow(a[2] - b[2], 2));
}

// The largest distance between the library's points of a patch and those of its arrays.
static double off(const ricci::quad_spline &spline, std::uint32_t number) {
    const ricci_quad_patch patch = spline.patch(number);
    const direction u = {patch.degrees[0], spline.knots(number, RICCI_ALONG_U)};
    const direction v = {patch.degrees[1], spline.knots(number, RICCI_ALONG_V)};
    const std::vector<point> poles = points_of(spline.poles(number));
    double worst = 0;
    for (int k = 0; k <= 16; k++) {
        const std::vector<double> at = {k / 16.0, std::fmod(0.07 + 0.31 * k, 1.0)};
        std::vector<point> column;
        for (std::size_t i = 0; i < patch.n_poles[0]; i++) {
            const auto row = poles.begin() + static_cast<std::ptrdiff_t>(i * patch.n_poles[1]);
            column.push_back(on_curve(
                v, std::vector<point>(row, row + static_cast<std::ptrdiff_t>(patch.n_poles[1])), at[1]));
        }
        const std::vector<std::uint32_t> on = {number};
        const point exact = points_of(spline.evaluate(on, at))[0];
        worst = std::fmax(worst, distance(on_curve(u, column, at[0]), exact));
    }
    return worst;
}

// The largest distance between an arc and the surface to its left, which runs along it.
static double gap(const ricci::quad_spline &spline, std::size_t number) {
    const ricci_quad_arc arc = spline.arc(number);
    if (arc.patches[0] < 0) return 0;
    const std::uint32_t patch = static_cast<std::uint32_t>(arc.patches[0]);
    const std::uint32_t along = arc.sides[0] % 2 == 0 ? RICCI_ALONG_U : RICCI_ALONG_V;
    const direction curve = {arc.degree, spline.knots(patch, along)};
    const std::vector<point> poles = points_of(spline.arc_poles(number));
    double worst = 0;
    for (int k = 0; k <= 16; k++) {
        const double x = k / 16.0;
        const std::vector<double> places[4] = {{x, 0}, {1, x}, {1 - x, 1}, {0, 1 - x}};
        const std::vector<std::uint32_t> on = {patch};
        const std::vector<double> &at = places[arc.sides[0]];
        worst = std::fmax(worst, distance(on_curve(curve, poles, x), points_of(spline.evaluate(on, at))[0]));
    }
    return worst;
}

int main(int argc, char **argv) {
    try {
        ricci_shape shape = ricci::init<ricci_shape>();
        shape.shape = RICCI_SHAPE_ELLIPSOID, shape.a = 1.6, shape.b = 1.2, shape.c = 1;
        shape.n = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 12;
        const ricci::mesh mesh(ricci::make<ricci_mesh>(ricci_make, &shape));
        const ricci::quad_spline spline{ricci::seamless(mesh)};
        const ricci_quad_spline_summary all = spline.summary();
        double worst = 0;
        for (std::uint32_t p = 0; p < all.n_patches; p++) {
            const ricci_quad_patch patch = spline.patch(p);
            worst = std::fmax(worst, off(spline, p));
            std::printf("patch %u: %zu x %zu poles, beyond its sides the patches %lld %lld %lld %lld\n", p,
                        patch.n_poles[0], patch.n_poles[1], static_cast<long long>(patch.neighbours[0]),
                        static_cast<long long>(patch.neighbours[1]),
                        static_cast<long long>(patch.neighbours[2]),
                        static_cast<long long>(patch.neighbours[3]));
        }
        for (std::size_t a = 0; a < all.n_arcs; a++) worst = std::fmax(worst, gap(spline, a));
        std::printf("%zu patches, %zu curves: arrays and library differ by %.1e; %.1e of the diagonal from "
                    "the mesh\n",
                    all.n_patches, all.n_arcs, worst, all.vertex_max);
        return worst < 1e-12 ? 0 : 1;
    } catch (const ricci::error &error) {
        std::fprintf(stderr, "%s: %s\n", ricci_status_text(error.status()), error.what());
        return 1;
    }
}
