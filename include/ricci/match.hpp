// Maps between two surfaces: C++ ownership and errors, as ricci/ricci.hpp has them.
//
//     const ricci::matching map(source, target);
//     const std::vector<std::uint32_t> faces = map.faces();
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_MATCH_HPP
#define RICCI_MATCH_HPP

#include <ricci/core.hpp>
#include <ricci/match.h>

#include <array>
#include <stdexcept>

namespace ricci {

using matching_handle = owned<ricci_matching, ricci_matching_free>;

// A point of a face of the target.
struct matched_point {
    std::uint32_t face;
    std::array<double, 3> weights;
};

// Pairs of loops that name a homotopy class, for options that are used as long as this is kept.
class match_basis {
public:
    match_basis(const lists<std::int32_t> &source, const lists<std::int32_t> &target) {
        if (source.size() != target.size()) throw std::invalid_argument("as many loops on both surfaces");
        for (std::size_t k = 0; k < source.size(); k++)
            for (const auto &path : {source[k], target[k]}) {
                edges_.insert(edges_.end(), path.begin(), path.end());
                sizes_.push_back(static_cast<std::uint32_t>(path.size()));
            }
    }
    void name(ricci_match_options &options) const {
        options.basis = edges_.data(), options.basis_sizes = sizes_.data();
        options.n_basis = sizes_.size() / 2;
    }

private:
    std::vector<std::int32_t> edges_;
    std::vector<std::uint32_t> sizes_;
};

// A map between two surfaces and its inverse.
class matching : public matching_handle {
public:
    using matching_handle::matching_handle;
    matching(const mesh &source, const mesh &target,
             const ricci_match_options &options = init<ricci_match_options>(),
             const control *watched = nullptr)
        : matching_handle(
              make<ricci_matching>(ricci_match, source.get(), target.get(), &options, of(watched))) {}
    // The map with landmarks that are found by the shapes of the surfaces.
    static matching by_shape(const mesh &source, const mesh &target,
                             const ricci_match_options &options = init<ricci_match_options>(),
                             const control *watched = nullptr) {
        return matching(
            make<ricci_matching>(ricci_match_by_shape, source.get(), target.get(), &options, of(watched)));
    }
    // How much the map distorts, and what it is good for.
    ricci_matching_judgement judgement(const control *watched = nullptr) const {
        ricci_matching_judgement all{};
        check(ricci_matching_judge(get(), of(watched), &all, sizeof all));
        return all;
    }
    // What was found of landmarks.
    ricci_found_landmarks found() const {
        ricci_found_landmarks all{};
        check(ricci_matching_found(get(), &all, sizeof all));
        return all;
    }
    // Pairs of vertices of the source and of the target that correspond, for ricci_match_options too.
    std::vector<std::array<std::uint32_t, 2>> landmarks(std::uint32_t kind = RICCI_LANDMARKS_USED) const {
        const ricci_found_landmarks all = found();
        const std::size_t n = kind == RICCI_LANDMARKS_KEPT       ? all.n_kept
                              : kind == RICCI_LANDMARKS_MIRRORED ? all.n_mirrored
                                                                 : all.n_used;
        std::vector<std::uint32_t> flat(2 * n);
        check(ricci_matching_landmarks(get(), kind, flat.data(), flat.size()));
        std::vector<std::array<std::uint32_t, 2>> pairs(n);
        for (std::size_t k = 0; k < n; k++) pairs[k] = {flat[2 * k], flat[2 * k + 1]};
        return pairs;
    }
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
    // For each pair of points that correspond, the image of the first and the given partner.
    std::vector<std::array<matched_point, 2>> points() const {
        const std::size_t n = summary().n_points;
        std::vector<std::uint32_t> faces(2 * n);
        std::vector<double> weights(6 * n);
        check(ricci_matching_points(get(), faces.data(), faces.size(), weights.data(), weights.size()));
        std::vector<std::array<matched_point, 2>> all(n);
        for (std::size_t k = 0; k < 2 * n; k++)
            all[k / 2][k % 2] = {faces[k], {weights[3 * k], weights[3 * k + 1], weights[3 * k + 2]}};
        return all;
    }
    // The distances of the images of landmarks that need not be met from their partners.
    std::vector<double> soft_left() const {
        std::vector<double> left(summary().n_soft);
        check(ricci_matching_soft_left(get(), left.data(), left.size()));
        return left;
    }
    // The common subdivision of the two surfaces: RICCI_ON_SOURCE and RICCI_ON_TARGET are its two sides.
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
