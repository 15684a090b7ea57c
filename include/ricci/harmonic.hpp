// Harmonic maps and 1-forms: C++ ownership and errors, as ricci/ricci.hpp has them.
//
//     const ricci::forms forms(mesh);
//     const std::vector<double> periods = forms.periods(), first = forms.values(0);
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_HARMONIC_HPP
#define RICCI_HARMONIC_HPP

#include <ricci/core.hpp>
#include <ricci/harmonic.h>

namespace ricci {

// The images of all vertices, 3 coordinates each: by default in the unit disk.
inline std::vector<double> harmonic(const mesh &on,
                                    const ricci_harmonic_spec &spec = init<ricci_harmonic_spec>(),
                                    const control *watched = nullptr) {
    std::vector<double> points(3 * on.summary().n_vertices);
    check(ricci_harmonic(on.get(), &spec, of(watched), points.data(), points.size()));
    return points;
}

// A harmonic map with its figures: the modulus of a rectangle, the energies of a heat flow.
struct harmonic_result {
    std::vector<double> points, energies;
    ricci_harmonic_summary summary;
};
inline harmonic_result harmonic_map(const mesh &on, const ricci_harmonic_spec &spec,
                                    const control *watched = nullptr) {
    const std::size_t most = spec.max_iterations ? spec.max_iterations : 10000;
    harmonic_result found{
        std::vector<double>(3 * on.summary().n_vertices), std::vector<double>(most + 1), {}};
    check(ricci_harmonic_map(on.get(), &spec, of(watched), found.points.data(), found.points.size(),
                             found.energies.data(), found.energies.size(), &found.summary,
                             sizeof found.summary));
    found.energies.resize(found.summary.n_energies);
    return found;
}

// The harmonic map with given places, 3 coordinates each, of some vertices.
inline std::vector<double> harmonic(const mesh &on, span<std::uint32_t> vertices, span<double> places,
                                    const control *watched = nullptr) {
    if (places.size() != 3 * vertices.size())
        throw std::invalid_argument("three coordinates for every vertex that is given");
    ricci_harmonic_spec spec = init<ricci_harmonic_spec>();
    spec.target = RICCI_HARMONIC_VALUES;
    spec.vertices = vertices.data(), spec.values = places.data(), spec.n = vertices.size();
    return harmonic(on, spec, watched);
}

// A zero of a holomorphic form: the nearest vertex, and its multiplicity.
struct zero {
    std::uint32_t vertex;
    std::int64_t multiplicity;
};

using forms_handle = owned<ricci_forms, ricci_forms_free>;

// The harmonic 1-forms of a surface.
class forms : public forms_handle {
public:
    using forms_handle::forms_handle;
    explicit forms(const mesh &on, const ricci_forms_options &options = init<ricci_forms_options>(),
                   const control *watched = nullptr)
        : forms_handle(make<ricci_forms>(ricci_forms_new, on.get(), &options, of(watched))) {}
    ricci_forms_summary summary() const { return ricci::summary(ricci_forms_summarise, get()); }
    // The triangulation that the forms live on.
    ricci::mesh triangulation() const { return ricci::mesh(make<ricci_mesh>(ricci_forms_mesh, get())); }
    // Integrals over the edges of one form.
    std::vector<double> values(std::size_t form) const {
        return ricci::values<double>(ricci_forms_values, get(), form);
    }
    // Real and imaginary part of the integrals over the edges of a holomorphic form.
    std::vector<double> holomorphic(span<double> coefficients) const {
        std::vector<double> values(2 * summary().n_edges);
        check(ricci_forms_holomorphic(handle_, coefficients.data(), coefficients.size(), values.data(),
                                      values.size()));
        return values;
    }
    std::vector<zero> zeros(span<double> coefficients) const {
        std::size_t n = 0;
        check(ricci_forms_zeros(handle_, coefficients.data(), coefficients.size(), nullptr, 0, &n));
        std::vector<std::int64_t> rows(n);
        check(ricci_forms_zeros(handle_, coefficients.data(), coefficients.size(), rows.data(), n, &n));
        std::vector<zero> all;
        for (std::size_t i = 0; i + 1 < n; i += 2)
            all.push_back({static_cast<std::uint32_t>(rows[i]), rows[i + 1]});
        return all;
    }
    // genus x genus, real and imaginary part.
    std::vector<double> periods() const { return ricci::values<double>(ricci_forms_periods, get()); }
};

} // namespace ricci

#endif
