// Flat maps of least stretch: C++ ownership and errors, as ricci/ricci.hpp has them.
//
//     const ricci::flatten_result flat = ricci::flatten(mesh);
//     flat.summary.after[RICCI_DISTORTION_ENERGY];
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_FLATTEN_HPP
#define RICCI_FLATTEN_HPP

#include <ricci/core.hpp>
#include <ricci/flatten.h>

namespace ricci {

// A flat map: 2 coordinates per vertex, on the sphere 3, the energies of the steps, the figures.
struct flatten_result {
    std::vector<double> points, energies;
    ricci_flatten_summary summary;
};
inline flatten_result flatten(const mesh &on,
                              const ricci_flatten_options &options = init<ricci_flatten_options>(),
                              const control *watched = nullptr) {
    const std::size_t most = options.max_iterations ? options.max_iterations : 2000;
    flatten_result found{std::vector<double>(2 * on.summary().n_vertices), std::vector<double>(most + 1), {}};
    check(ricci_flatten(on.get(), &options, of(watched), found.points.data(), found.points.size(),
                        found.energies.data(), found.energies.size(), &found.summary, sizeof found.summary));
    found.energies.resize(found.summary.n_energies);
    return found;
}

// The same on the unit sphere: 3 coordinates per vertex.
inline flatten_result flatten_sphere(const mesh &on,
                                     const ricci_flatten_options &options = init<ricci_flatten_options>(),
                                     const control *watched = nullptr) {
    const std::size_t most = options.max_iterations ? options.max_iterations : 2000;
    flatten_result found{std::vector<double>(3 * on.summary().n_vertices), std::vector<double>(most + 1), {}};
    check(ricci_flatten_sphere(on.get(), &options, of(watched), found.points.data(), found.points.size(),
                               found.energies.data(), found.energies.size(), &found.summary,
                               sizeof found.summary));
    found.energies.resize(found.summary.n_energies);
    return found;
}

// Positions after folds were smoothed away; 0 for the usual time and number of steps.
inline std::vector<double> inflate(const mesh &on, double time = 0, std::size_t steps = 0,
                                   const control *watched = nullptr) {
    std::vector<double> positions(3 * on.summary().n_vertices);
    check(ricci_inflate(on.get(), time, steps, of(watched), positions.data(), positions.size()));
    return positions;
}

// 1 for vertices of the medial wall, by an inflated view.
inline std::vector<std::uint32_t> medial_wall(const mesh &on, const std::vector<double> &view,
                                              const std::array<double, 3> &medial, double share = 0.08) {
    std::vector<std::uint32_t> is_wall(on.summary().n_vertices);
    check(ricci_medial_wall(on.get(), view.data(), view.size() / 3, medial.data(), share, is_wall.data(),
                            is_wall.size()));
    return is_wall;
}

// 1 for the marked vertices that belong to the largest piece that is a surface with boundary.
inline std::vector<std::uint32_t> flat_part(const mesh &on, const std::vector<std::uint32_t> &marked) {
    std::vector<std::uint32_t> is_kept(on.summary().n_vertices);
    check(ricci_flat_part(on.get(), marked.data(), marked.size(), is_kept.data(), is_kept.size()));
    return is_kept;
}

// A surface that darts have opened: the mesh, per vertex the given one, the figures.
struct darted_mesh {
    mesh opened;
    std::vector<std::uint32_t> origins;
    ricci_dart_summary summary;
};
inline darted_mesh flatten_darts(const mesh &on, const ricci_dart_options &darts = init<ricci_dart_options>(),
                                 const ricci_flatten_options &options = init<ricci_flatten_options>(),
                                 const control *watched = nullptr) {
    std::vector<std::uint32_t> origins(2 * on.summary().n_vertices);
    ricci_dart_summary told;
    mesh opened(make<ricci_mesh>(ricci_flatten_darts, on.get(), &options, &darts, of(watched), origins.data(),
                                 origins.size(), &told, sizeof told));
    origins.resize(told.n_vertices);
    return {std::move(opened), std::move(origins), told};
}

// Three numbers for each triangle of a flat map: strain along warp and weft, and shear.
inline std::vector<double> flatten_strains(const mesh &on, const std::vector<double> &points,
                                           double warp = 0) {
    std::vector<double> values(3 * on.summary().n_faces);
    check(ricci_flatten_strains(on.get(), points.data(), points.size() / 2, warp, values.data(),
                                values.size()));
    return values;
}

} // namespace ricci

#endif
