// Circle domains: C++ ownership and errors, as ricci/ricci.hpp has them.
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_CIRCLES_HPP
#define RICCI_CIRCLES_HPP

#include <ricci/circles.h>
#include <ricci/core.hpp>

namespace ricci {

using circle_domain_handle = owned<ricci_circle_domain, ricci_circle_domain_free>;

// A surface with boundary whose loops are circles.
class circle_domain : public circle_domain_handle {
public:
    explicit circle_domain(ricci_circle_domain *handle) : circle_domain_handle(handle) {}
    explicit circle_domain(const mesh &on,
                           const ricci_circle_domain_options &options = init<ricci_circle_domain_options>(),
                           const control *watched = nullptr)
        : circle_domain_handle(
              make<ricci_circle_domain>(ricci_circle_domain_new, on.get(), &options, of(watched))) {}
    ricci_circle_domain_summary summary() const {
        return ricci::summary(ricci_circle_domain_summarise, get());
    }
    std::vector<double> circles() const { return values<double>(ricci_circle_domain_circles, get()); }
    std::vector<double> log_radii() const { return values<double>(ricci_circle_domain_log_radii, get()); }
    ricci::mesh mesh() const { return ricci::mesh(make<ricci_mesh>(ricci_circle_domain_mesh, get())); }
    ricci::layout layout(std::uint32_t model = RICCI_MODEL_POINCARE) const {
        return ricci::layout(make<ricci_layout>(ricci_circle_domain_layout, get(), model));
    }
};

// Centre and squared radius of each circle of a layout in the plane: RICCI_CIRCLES_*.
inline std::vector<double> circle_pattern(const layout &of_layout,
                                          std::uint32_t which = RICCI_CIRCLES_VERTICES) {
    return values<double>(ricci_layout_circles, of_layout.get(), which);
}

} // namespace ricci

#endif
