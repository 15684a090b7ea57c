// Canonical shapes, groups, covers and charts: C++ ownership and errors, as ricci/ricci.hpp has them.
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_UNIFORMIZE_HPP
#define RICCI_UNIFORMIZE_HPP

#include <ricci/core.hpp>
#include <ricci/uniformize.h>

namespace ricci {

using homotopy_handle = owned<ricci_homotopy, ricci_homotopy_free>;

class homotopy : public homotopy_handle {
public:
    using homotopy_handle::homotopy_handle;
    explicit homotopy(const mesh &on, const std::uint32_t *base = nullptr, const control *watched = nullptr)
        : homotopy_handle(make<ricci_homotopy>(ricci_homotopy_new, on.get(), base, of(watched))) {}
    ricci_homotopy_summary summary() const { return ricci::summary(ricci_homotopy_summarise, get()); }
    lists<std::int32_t> loops() const {
        return rows<std::int32_t>(summary().n_generators, ricci_homotopy_loops, get());
    }
    std::vector<std::int32_t> reduced(span<std::int32_t> word) const {
        std::vector<std::int32_t> shorter(word.size());
        std::size_t n = 0;
        check(ricci_homotopy_reduce(handle_, word.data(), word.size(), shorter.data(), shorter.size(), &n));
        shorter.resize(n);
        return shorter;
    }
};

using deck_handle = owned<ricci_deck, ricci_deck_free>;

class deck : public deck_handle {
public:
    using deck_handle::deck_handle;
    ricci_deck_summary summary() const { return ricci::summary(ricci_deck_summarise, get()); }
    lists<std::int32_t> words() const {
        return rows<std::int32_t>(summary().n_elements, ricci_deck_words, get());
    }
    std::vector<double> values(std::uint32_t which) const {
        return ricci::values<double>(ricci_deck_values, get(), which);
    }
    // Points in ambient coordinates, moved by one element.
    std::vector<double> moved(std::size_t element, span<double> points) const {
        return ricci::values<double>(ricci_deck_apply, get(), element, points.data(), points.size() / 3);
    }
    // The closed geodesic of an element: faces of the given mesh, and three weights each.
    std::pair<std::vector<std::uint32_t>, std::vector<double>>
    geodesic(std::size_t element, const control *watched = nullptr) const {
        std::size_t n = 0;
        check(ricci_deck_geodesic(get(), element, of(watched), nullptr, 0, nullptr, 0, &n));
        std::pair<std::vector<std::uint32_t>, std::vector<double>> line{std::vector<std::uint32_t>(n),
                                                                        std::vector<double>(3 * n)};
        check(ricci_deck_geodesic(get(), element, of(watched), line.first.data(), n, line.second.data(),
                                  3 * n, &n));
        return line;
    }
};

using dirichlet_handle = owned<ricci_dirichlet, ricci_dirichlet_free>;

class dirichlet : public dirichlet_handle {
public:
    using dirichlet_handle::dirichlet_handle;
    ricci_dirichlet_summary summary() const { return ricci::summary(ricci_dirichlet_summarise, get()); }
    std::vector<double> corners() const { return values<double>(ricci_dirichlet_corners, get()); }
    std::vector<std::int32_t> partners() const {
        return values<std::int32_t>(ricci_dirichlet_partners, get());
    }
};

using uniform_handle = owned<ricci_uniform, ricci_uniform_free>;

// A closed surface with its metric of constant curvature.
class uniform : public uniform_handle {
public:
    explicit uniform(ricci_uniform *handle) : uniform_handle(handle) {}
    explicit uniform(const mesh &on, const ricci_uniform_options &options = init<ricci_uniform_options>(),
                     const control *watched = nullptr)
        : uniform_handle(make<ricci_uniform>(ricci_uniformize, on.get(), &options, of(watched))) {}
    ricci_uniform_summary summary() const { return ricci::summary(ricci_uniform_summarise, get()); }
    ricci::metric metric() const { return ricci::metric(make<ricci_metric>(ricci_uniform_metric, get())); }
    ricci::homotopy homotopy() const {
        return ricci::homotopy(make<ricci_homotopy>(ricci_uniform_homotopy, get()));
    }
    ricci::layout layout(std::uint32_t on = RICCI_ON_REFINEMENT,
                         std::uint32_t model = RICCI_MODEL_POINCARE) const {
        return ricci::layout(make<ricci_layout>(ricci_uniform_layout, get(), on, model, of(nullptr)));
    }
    ricci::deck deck(const ricci_deck_spec &spec = init<ricci_deck_spec>(),
                     const control *watched = nullptr) const {
        return ricci::deck(make<ricci_deck>(ricci_deck_new, get(), &spec, of(watched)));
    }
    ricci::dirichlet dirichlet(const double *centre = nullptr) const {
        return ricci::dirichlet(make<ricci_dirichlet>(ricci_dirichlet_new, get(), centre, of(nullptr)));
    }
    std::vector<double> sphere_points(std::uint32_t model = RICCI_MODEL_AMBIENT) const {
        return values<double>(ricci_sphere_points, get(), model);
    }
    // A closed loop lifted to the universal cover: points in ambient coordinates, and the word of the deck
    // transformation that carries the first to the last.
    struct lifted_loop {
        std::vector<double> points;
        std::vector<std::int32_t> word;
    };
    lifted_loop lift_loop(const ricci::layout &on, const std::vector<std::uint32_t> &vertices) const {
        std::size_t n_points = 0, n_letters = 0;
        const auto call = [&](double *points, std::size_t size, std::int32_t *word, std::size_t length) {
            check(ricci_uniform_lift_loop(get(), on.get(), vertices.data(), vertices.size(), points, size,
                                          &n_points, word, length, &n_letters));
        };
        call(nullptr, 0, nullptr, 0);
        lifted_loop made{std::vector<double>(n_points), std::vector<std::int32_t>(n_letters)};
        call(made.points.data(), made.points.size(), made.word.data(), made.word.size());
        return made;
    }
};

using repaired_input_handle = owned<ricci_repaired_input, ricci_repaired_input_free>;

// A layout on the faces of the mesh, with the fewest edges split that leave no face folded.
class repaired_input : public repaired_input_handle {
public:
    explicit repaired_input(const layout &of_layout, const control *watched = nullptr)
        : repaired_input_handle(
              make<ricci_repaired_input>(ricci_repaired_input_new, of_layout.get(), of(watched))) {}
    ricci_repaired_input_summary summary() const {
        return ricci::summary(ricci_repaired_input_summarise, get());
    }
    ricci::mesh mesh() const {
        return ricci::mesh(ricci::make<ricci_mesh>(ricci_repaired_input_mesh, get()));
    }
    std::vector<std::uint32_t> faces() const {
        return values<std::uint32_t>(ricci_repaired_input_faces, get());
    }
    std::vector<double> barycentric() const {
        return values<double>(ricci_repaired_input_barycentric, get());
    }
    std::vector<std::uint32_t> split_edges() const {
        return values<std::uint32_t>(ricci_repaired_input_split_edges, get());
    }
    std::vector<double> points() const { return values<double>(ricci_repaired_input_points, get()); }
    std::vector<std::uint32_t> corners() const {
        return values<std::uint32_t>(ricci_repaired_input_corners, get());
    }
    void write(const std::string &path) const { check(ricci_repaired_input_write(handle_, path.c_str())); }
};

using charts_handle = owned<ricci_charts, ricci_charts_free>;

class charts : public charts_handle {
public:
    explicit charts(ricci_charts *handle) : charts_handle(handle) {}
    explicit charts(const layout &of_layout, double margin = 1.0 / 256, const control *watched = nullptr)
        : charts_handle(make<ricci_charts>(ricci_charts_new, of_layout.get(), margin, of(watched))) {}
    ricci_charts_summary summary() const { return ricci::summary(ricci_charts_summarise, get()); }
    std::vector<std::uint32_t> faces() const { return values<std::uint32_t>(ricci_charts_faces, get()); }
    std::vector<double> points() const { return values<double>(ricci_charts_points, get()); }
    std::vector<std::uint32_t> corners() const { return values<std::uint32_t>(ricci_charts_corners, get()); }
    void write(const std::string &path, bool homogeneous = false) const {
        check(ricci_charts_write(handle_, homogeneous ? 1 : 0, path.c_str()));
    }
};

} // namespace ricci

#endif
