// Maps between two surfaces: C++ ownership and errors, as ricci/ricci.hpp has them.
//
//     const ricci::matching map(source, target);
//     const std::vector<std::uint32_t> faces = map.faces();
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_MATCH_HPP
#define RICCI_MATCH_HPP

#include <ricci/match.h>
#include <ricci/ricci.hpp>

namespace ricci {

using matching_handle = owned<ricci_matching, ricci_matching_free>;

// A map between two surfaces and its inverse.
class matching : public matching_handle {
public:
    using matching_handle::matching_handle;
    matching(const mesh &source, const mesh &target,
             const ricci_match_options &options = init<ricci_match_options>(),
             const control *watched = nullptr)
        : matching_handle(
              make<ricci_matching>(ricci_match, source.get(), target.get(), &options, of(watched))) {}
    ricci_matching_summary summary() const { return ricci::summary(ricci_matching_summarise, get()); }
    // The faces that the vertices go to.
    std::vector<std::uint32_t> faces(std::uint32_t direction = RICCI_MATCH_FORWARD) const {
        std::vector<std::uint32_t> all(size(direction));
        check(ricci_matching_faces(get(), direction, all.data(), all.size()));
        return all;
    }
    // Barycentric coordinates of the images, 3 for each.
    std::vector<double> weights(std::uint32_t direction = RICCI_MATCH_FORWARD) const {
        std::vector<double> all(3 * size(direction));
        check(ricci_matching_weights(get(), direction, all.data(), all.size()));
        return all;
    }
    // The two surfaces laid over each other: RICCI_ON_INPUT is the source, RICCI_ON_METRIC the target.
    ricci::map map(const control *watched = nullptr) const {
        return ricci::map(make<ricci_map>(ricci_matching_map, get(), of(watched)));
    }

private:
    std::size_t size(std::uint32_t direction) const {
        const ricci_matching_summary s = summary();
        return direction == RICCI_MATCH_BACKWARD ? s.n_target_vertices : s.n_source_vertices;
    }
};

} // namespace ricci

#endif
