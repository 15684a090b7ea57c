// Seamless metrics: C++ ownership and errors, as ricci/ricci.hpp has them.
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_SEAMLESS_HPP
#define RICCI_SEAMLESS_HPP

#include <ricci/flatten.hpp>
#include <ricci/seamless.h>

namespace ricci {

using seamless_handle = owned<ricci_seamless, ricci_seamless_free>;

// A flat metric whose angles around cones and along loops are multiples of 90 degrees.
class seamless : public seamless_handle {
public:
    explicit seamless(ricci_seamless *handle) : seamless_handle(handle) {}
    explicit seamless(const mesh &on, const ricci_seamless_options &options = init<ricci_seamless_options>(),
                      const control *watched = nullptr)
        : seamless_handle(make<ricci_seamless>(ricci_seamless_new, on.get(), &options, of(watched))) {}
    ricci_seamless_summary summary() const { return ricci::summary(ricci_seamless_summarise, get()); }
    // A vertex and its valence for each cone.
    std::vector<std::uint32_t> cones() const { return values<std::uint32_t>(ricci_seamless_cones, get()); }
    // The turning of each loop, quarter turns.
    std::vector<std::int32_t> turning() const { return values<std::int32_t>(ricci_seamless_turning, get()); }
    // The vertices at the ends of each feature and edge of the boundary.
    std::vector<std::uint32_t> features() const {
        return values<std::uint32_t>(ricci_seamless_features, get());
    }
    ricci::metric metric() const { return ricci::metric(make<ricci_metric>(ricci_seamless_metric, get())); }
    // The map into the plane, with exact seams.
    ricci::layout map(const control *watched = nullptr) const {
        return ricci::layout(make<ricci_layout>(ricci_seamless_map, get(), of(watched)));
    }
    // The map of least stretch with these cones and this turning; the figures go to `told`.
    ricci::layout flatten(const ricci_flatten_options &options = init<ricci_flatten_options>(),
                          ricci_flatten_summary *told = nullptr, const control *watched = nullptr) const {
        ricci_flatten_summary own;
        return ricci::layout(make<ricci_layout>(ricci_seamless_flatten, get(), &options, of(watched), nullptr,
                                                std::size_t(0), told ? told : &own, sizeof own));
    }
};

// The smoothest field of four directions along features, near strokes and principal curvature: a unit vector
// for each face.
inline std::vector<double> cross_field(const mesh &on,
                                       const ricci_seamless_options &options = init<ricci_seamless_options>(),
                                       const control *watched = nullptr) {
    std::vector<double> directions(3 * on.summary().n_faces);
    check(ricci_seamless_field(on.get(), &options, of(watched), directions.data(), directions.size()));
    return directions;
}

} // namespace ricci

#endif
