// Triangular B-splines: C++ ownership and errors, as ricci/ricci.hpp has them.
//
//     const auto domain = ricci::spline_domain(square, 0.2);
//     const auto surface = ricci::spline(domain).fitted(points);
//     const std::vector<double> values = surface.evaluate(places, RICCI_SPLINE_SECOND);
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_SPLINE_HPP
#define RICCI_SPLINE_HPP

#include <ricci/core.hpp>
#include <ricci/spline.h>

namespace ricci {

// Triangles inside a closed polygon, x and y of its corners, about as large as equilateral ones with this
// edge.
inline mesh spline_domain(span<double> corners, double edge) {
    if (corners.size() % 2 != 0) throw std::invalid_argument("x and y of every corner");
    const std::size_t starts[2] = {0, corners.size() / 2};
    return mesh(make<ricci_mesh>(ricci_spline_domain, corners.data(), starts, std::size_t(1), edge));
}

// Triangles inside several polygons: points that an odd number of them winds around are inside.
inline mesh spline_domain(const lists<double> &corners, double edge) {
    std::vector<std::size_t> starts;
    for (std::size_t start : corners.starts) starts.push_back(start / 2);
    return mesh(
        make<ricci_mesh>(ricci_spline_domain, corners.entries.data(), starts.data(), corners.size(), edge));
}

// The nearest points of a spline to points in space.
struct closest_points {
    std::vector<std::uint32_t> patches;
    // For each point x and y in the patch's chart, the nearest point, and its distance.
    std::vector<double> values;
};

using spline_handle = owned<ricci_spline, ricci_spline_free>;

// A spline surface.
class spline : public spline_handle {
public:
    using spline_handle::spline_handle;
    // The plane z = 0 over a domain.
    explicit spline(const mesh &domain, const ricci_spline_spec &spec = init<ricci_spline_spec>())
        : spline_handle(make<ricci_spline>(ricci_spline_new, domain.get(), &spec)) {}
    spline(const mesh &domain, std::uint32_t degree) : spline(domain, of_degree(degree)) {}
    static spline read(const std::string &path) {
        return spline(make<ricci_spline>(ricci_spline_read, path.c_str()));
    }
    static spline parse(const std::string &text) {
        return spline(make<ricci_spline>(ricci_spline_parse, text.c_str()));
    }
    // The curvatures of a flat metric of a whole surface with the singular vertices that distort areas
    // least, or with those given; by default as few as keep its lengths within `range` of each other.
    static std::vector<double> curvatures(const mesh &surface, std::size_t n_singular = RICCI_SPLINE_AUTO,
                                          double range = 0, const control *watched = nullptr) {
        std::vector<double> found(surface.summary().n_vertices);
        check(ricci_spline_curvatures(surface.get(), nullptr, n_singular, range, of(watched), found.data(),
                                      found.size()));
        return found;
    }
    static std::vector<double> curvatures_at(const mesh &surface, span<std::uint32_t> singular,
                                             const control *watched = nullptr) {
        std::vector<double> found(surface.summary().n_vertices);
        check(ricci_spline_curvatures(surface.get(), singular.data(), singular.size(), 0, of(watched),
                                      found.data(), found.size()));
        return found;
    }
    // Near the vertices of a whole surface, on a flat metric of it.
    static spline
    of_surface(const metric &flat,
               const ricci_spline_surface_options &options = init<ricci_spline_surface_options>(),
               const control *watched = nullptr) {
        return spline(make<ricci_spline>(ricci_spline_fit_surface, flat.get(), &options, of(watched)));
    }
    // Near the vertices of a whole surface of any topology, on flat metrics that are made for it.
    static spline of_mesh(const mesh &surface,
                          const ricci_spline_surface_options &options = init<ricci_spline_surface_options>(),
                          const control *watched = nullptr) {
        return spline(make<ricci_spline>(ricci_spline_fit_mesh, surface.get(), &options, of(watched)));
    }
    void write(const std::string &path) const { check(ricci_spline_write(handle_, path.c_str())); }
    std::string text() const { return text_of(ricci_spline_text, get()); }
    // With other control points, 3 coordinates each.
    spline with_points(span<double> points) const {
        return spline(make<ricci_spline>(ricci_spline_with_points, get(), points.data(), points.size() / 3));
    }
    // The polynomial with these coefficients of 1, x, y, x^2, ..., 3 coordinates each.
    spline with_polynomial(span<double> coefficients) const {
        return spline(make<ricci_spline>(ricci_spline_with_polynomial, get(), coefficients.data(),
                                         coefficients.size() / 3));
    }
    // The nearest surface to points, 3 coordinates each: by default over their own x and y.
    spline fitted(span<double> points,
                  const ricci_spline_fit_options &options = init<ricci_spline_fit_options>(),
                  const control *watched = nullptr) const {
        return spline(make<ricci_spline>(ricci_spline_fit, get(), points.data(), points.size() / 3, &options,
                                         of(watched)));
    }
    ricci_spline_summary summary() const { return ricci::summary(ricci_spline_summarise, get()); }
    std::vector<double> values(std::uint32_t which) const {
        return ricci::values<double>(ricci_spline_values, get(), which);
    }
    std::vector<double> control_points() const { return values(RICCI_SPLINE_CONTROL_POINTS); }
    std::vector<double> knots() const { return values(RICCI_SPLINE_KNOTS); }
    // Of a fit to a surface, the patches in which it folds.
    std::vector<std::uint32_t> folds() const {
        return ricci::values<std::uint32_t>(ricci_spline_folds, get());
    }
    std::vector<std::uint32_t> controls() const {
        return ricci::values<std::uint32_t>(ricci_spline_controls, get());
    }
    // The patch of each point, x and y: -1 outside.
    std::vector<std::int32_t> locate(span<double> points) const {
        return ricci::values<std::int32_t>(ricci_spline_locate, get(), points.data(), points.size() / 2);
    }
    // The quantities of the surface at places, x and y each; their patches are searched.
    std::vector<double> evaluate(span<double> parameters, std::uint32_t which = RICCI_SPLINE_POINT,
                                 const control *watched = nullptr) const {
        return evaluate(span<std::uint32_t>(), parameters, which, watched);
    }
    // The same in given patches.
    std::vector<double> evaluate(span<std::uint32_t> patches, span<double> parameters,
                                 std::uint32_t which = RICCI_SPLINE_POINT,
                                 const control *watched = nullptr) const {
        if (patches.data() && 2 * patches.size() != parameters.size())
            throw std::invalid_argument("x and y for every patch");
        ricci_spline_places places = init<ricci_spline_places>();
        places.patches = patches.data(), places.parameters = parameters.data();
        places.n = parameters.size() / 2;
        return ricci::values<double>(ricci_spline_evaluate, get(), &places, which, of(watched));
    }
    // The nearest points to these, 3 coordinates each.
    closest_points closest(span<double> points, const control *watched = nullptr) const {
        const std::size_t n = points.size() / 3;
        closest_points found{std::vector<std::uint32_t>(n), std::vector<double>(6 * n)};
        check(ricci_spline_closest(handle_, points.data(), n, of(watched), found.patches.data(),
                                   found.values.data(), 6 * n));
        return found;
    }
    std::array<double, 3> blossom(std::size_t patch, span<double> arguments) const {
        std::array<double, 3> point{};
        check(ricci_spline_blossom(handle_, patch, arguments.data(), arguments.size() / 2, point.data()));
        return point;
    }
    ricci::mesh tessellated(std::size_t sides, const control *watched = nullptr) const {
        return ricci::mesh(make<ricci_mesh>(ricci_spline_tessellate, get(), sides, of(watched)));
    }

private:
    static ricci_spline_spec of_degree(std::uint32_t degree) {
        ricci_spline_spec spec = init<ricci_spline_spec>();
        spec.degree = degree;
        return spec;
    }
};

} // namespace ricci

#endif
