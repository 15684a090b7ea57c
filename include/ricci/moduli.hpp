// Invariants of conformal structures with bounds: C++ ownership and errors, as ricci/ricci.hpp has them.
//
//     const ricci::period_bounds bounds(ricci::forms(mesh));
//     const double off = bounds.at(0, 1).radius, gap = bounds.summary.gap;
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_MODULI_HPP
#define RICCI_MODULI_HPP

#include <ricci/harmonic.hpp>
#include <ricci/match.hpp>
#include <ricci/moduli.h>
#include <ricci/uniformize.hpp>

namespace ricci {

// A complex number that is known within a radius.
struct complex_disk {
    double real, imaginary, radius;
};

// The period matrix of a closed surface with a bound of its error.
class period_bounds {
public:
    explicit period_bounds(const forms &of_forms,
                           const ricci_bounds_options &options = init<ricci_bounds_options>(),
                           const control *watched = nullptr)
        : genus(of_forms.summary().genus), matrix(3 * genus * genus) {
        check(ricci_forms_bounds(of_forms.get(), &options, of(watched), matrix.data(), matrix.size(),
                                 &summary, sizeof summary));
    }
    complex_disk at(std::size_t row, std::size_t column) const {
        const double *entry = &matrix.at(3 * (genus * row + column));
        return {entry[0], entry[1], entry[2]};
    }

    std::size_t genus;
    // genus x genus: real part, imaginary part, radius.
    std::vector<double> matrix;
    ricci_bounds_summary summary{};
};

// The modulus of an annulus, or of a disk with four corners, between two bounds.
struct modulus_bounds {
    explicit modulus_bounds(const mesh &of_mesh, const std::vector<std::uint32_t> &corners = {},
                            const ricci_bounds_options &options = init<ricci_bounds_options>(),
                            const control *watched = nullptr) {
        double interval[2];
        check(ricci_modulus_bounds(of_mesh.get(), corners.size() == 4 ? corners.data() : nullptr, &options,
                                   of(watched), interval, &summary, sizeof summary));
        low = interval[0], high = interval[1];
    }
    double low = 0, high = 0;
    ricci_bounds_summary summary{};
};

// The bracket of the Teichmueller distance of a matching.
inline ricci_dilatation_bracket dilatation_bracket(const matching &of_matching) {
    ricci_dilatation_bracket bracket{};
    check(ricci_matching_bracket(of_matching.get(), nullptr, nullptr, nullptr, &bracket, sizeof bracket));
    return bracket;
}

// 3 g - 3 + b, by the number 2 g + b of generators.
inline std::size_t n_pants_curves(std::size_t genus, std::size_t n_generators) {
    const std::size_t sum = genus + n_generators;
    return sum < 3 ? 0 : sum - 3;
}

// Length and twist of each of the 3 g - 3 + b curves that cut a hyperbolic surface into pairs of pants.
inline std::vector<double> fenchel_nielsen(const uniform &of_surface) {
    const auto figures = of_surface.summary();
    std::vector<double> coordinates(2 * n_pants_curves(figures.genus, figures.n_generators));
    check(ricci_fenchel_nielsen(of_surface.get(), coordinates.data(), coordinates.size()));
    return coordinates;
}

// The same in the marking of loops of one's own: edge paths on the given mesh, numbered from 1, negative
// backwards.
inline std::vector<double> fenchel_nielsen(const uniform &of_surface,
                                           const std::vector<std::vector<std::int32_t>> &loops) {
    std::vector<std::int32_t> edges;
    std::vector<std::size_t> starts(1, 0);
    for (const auto &path : loops) {
        edges.insert(edges.end(), path.begin(), path.end());
        starts.push_back(edges.size());
    }
    const auto figures = of_surface.summary();
    std::vector<double> coordinates(2 * n_pants_curves(figures.genus, figures.n_generators));
    check(ricci_fenchel_nielsen_of_loops(of_surface.get(), edges.data(), starts.data(), loops.size(), nullptr,
                                         coordinates.data(), coordinates.size()));
    return coordinates;
}

// Length and twist, modulo half of the length, of curves of one's own.
inline std::vector<double> pants_of(const deck &curves, std::size_t n_curves) {
    std::vector<double> coordinates(2 * n_curves);
    check(ricci_deck_pants(curves.get(), nullptr, coordinates.data(), coordinates.size()));
    return coordinates;
}

} // namespace ricci

#endif
