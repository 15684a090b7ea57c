// Geometric structures: C++ ownership and errors, as ricci/ricci.hpp has them.
//
//     const ricci::structure flat(mesh, RICCI_STRUCTURE_AFFINE);
//     const std::vector<ricci::place> places = flat.places(0, {{0.5, 0.25, 0.25}});
//     const std::vector<double> moved = flat.carry(places[0], places[1], places[0].coordinates);
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_STRUCTURE_HPP
#define RICCI_STRUCTURE_HPP

#include <ricci/core.hpp>
#include <ricci/structure.h>

namespace ricci {

// A point in a chart: the chart and the place of the point's face in it, and its coordinates there.
struct place {
    std::array<std::uint32_t, 2> lift;
    std::array<double, 2> coordinates;
};

// The transitions of a structure: from and to which chart, and matrices of n_matrix numbers.
struct transitions {
    std::vector<std::uint32_t> charts;
    std::vector<double> matrices;
};

using structure_handle = owned<ricci_structure, ricci_structure_free>;

class structure : public structure_handle {
public:
    explicit structure(ricci_structure *handle) : structure_handle(handle) {}
    explicit structure(const mesh &on, std::uint32_t kind,
                       const ricci_structure_options &options = init<ricci_structure_options>(),
                       const control *watched = nullptr)
        : structure_handle(
              make<ricci_structure>(ricci_structure_new, on.get(), kind, &options, of(watched))) {}
    ricci_structure_summary summary() const { return ricci::summary(ricci_structure_summarise, get()); }
    // RICCI_CHART_FACES, _CORNERS, _VERTICES of every chart, or RICCI_TRANSITION_PAIRS of every transition.
    lists<std::uint32_t> rows(std::uint32_t which) const {
        const ricci_structure_summary all = summary();
        const std::size_t n = which == RICCI_TRANSITION_PAIRS ? all.n_transitions : all.n_charts;
        return ricci::rows<std::uint32_t>(n, ricci_structure_rows, get(), which);
    }
    std::vector<double> coordinates(std::size_t chart) const {
        return values<double>(ricci_structure_coordinates, get(), chart);
    }
    ricci::transitions transitions() const {
        const ricci_structure_summary all = summary();
        ricci::transitions both{std::vector<std::uint32_t>(2 * all.n_transitions),
                                std::vector<double>(all.n_matrix * all.n_transitions)};
        check(ricci_structure_transitions(handle_, both.charts.data(), both.charts.size(),
                                          both.matrices.data(), both.matrices.size()));
        return both;
    }
    std::vector<double> holonomy() const { return values<double>(ricci_structure_holonomy, get()); }
    // The list of a constant RICCI_STRUCTURE_SINGULAR, _EXCLUDED, _FOLDED, _ZEROS or _TRIANGLES.
    std::vector<std::uint32_t> list(std::uint32_t which) const {
        return values<std::uint32_t>(ricci_structure_list, get(), which);
    }
    // All charts that contain a point of a face.
    std::vector<place> places(std::uint32_t face, const std::array<double, 3> &weights) const {
        std::size_t n = 0;
        check(ricci_structure_places(handle_, face, weights.data(), nullptr, nullptr, 0, &n));
        std::vector<std::uint32_t> lifts(2 * n);
        std::vector<double> points(2 * n);
        check(ricci_structure_places(handle_, face, weights.data(), lifts.data(), points.data(), n, &n));
        std::vector<place> all;
        for (std::size_t i = 0; i < n; i++)
            all.push_back({{{lifts[2 * i], lifts[2 * i + 1]}}, {{points[2 * i], points[2 * i + 1]}}});
        return all;
    }
    // Points of one chart, x and y each, in the coordinates of another one.
    std::vector<double> carry(const place &from, const place &to, span<double> points) const {
        return values<double>(ricci_structure_carry, get(), from.lift.data(), to.lift.data(), points.data(),
                              points.size() / 2);
    }
};

} // namespace ricci

#endif
