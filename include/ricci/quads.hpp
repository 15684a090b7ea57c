// Quad meshes and layouts of patches: C++ ownership and errors, as ricci/ricci.hpp has them.
//
//     const ricci::seamless flat(mesh);
//     const ricci::quads quads(flat);                     // about 1,000
//     const std::vector<std::uint32_t> faces = quads.faces();
//     const ricci::quad_layout layout(flat);              // few patches
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_QUADS_HPP
#define RICCI_QUADS_HPP

#include <ricci/quads.h>
#include <ricci/seamless.hpp>

namespace ricci {

// The options for about this number of quads.
inline ricci_quads_options quads_of_number(std::size_t n_quads) {
    ricci_quads_options options = init<ricci_quads_options>();
    options.sizing = RICCI_QUADS_NUMBER, options.n_quads = n_quads;
    return options;
}

// The options for quads with edges of about this length.
inline ricci_quads_options quads_of_edge(double edge) {
    ricci_quads_options options = init<ricci_quads_options>();
    options.sizing = RICCI_QUADS_EDGE, options.edge = edge;
    return options;
}

using quads_handle = owned<ricci_quads, ricci_quads_free>;

// A mesh of quads on a surface.
class quads : public quads_handle {
public:
    explicit quads(ricci_quads *handle) : quads_handle(handle) {}
    explicit quads(const seamless &on, const ricci_quads_options &options = init<ricci_quads_options>(),
                   const control *watched = nullptr)
        : quads_handle(make<ricci_quads>(ricci_quads_new, on.get(), &options, of(watched))) {}
    ricci_quads_summary summary() const { return ricci::summary(ricci_quads_summarise, get()); }
    // Four corners of each quad.
    std::vector<std::uint32_t> faces() const { return values<std::uint32_t>(ricci_quads_faces, get()); }
    // For each vertex a triangle of the surface, and three barycentric coordinates in it.
    std::pair<std::vector<std::uint32_t>, std::vector<double>> places() const {
        const std::size_t n = summary().n_vertices;
        std::pair<std::vector<std::uint32_t>, std::vector<double>> both{std::vector<std::uint32_t>(n),
                                                                        std::vector<double>(3 * n)};
        check(ricci_quads_places(get(), both.first.data(), n, both.second.data(), 3 * n));
        return both;
    }
    // x, y, z of each vertex.
    std::vector<double> positions() const { return values<double>(ricci_quads_positions, get()); }
    // The vertices at the ends of each edge on features and on the boundary.
    std::vector<std::uint32_t> creases() const { return values<std::uint32_t>(ricci_quads_creases, get()); }
    // The rectangle of the T-mesh that each quad is a part of.
    std::vector<std::uint32_t> rectangles() const {
        return values<std::uint32_t>(ricci_quads_rectangles, get());
    }
};

using quad_layout_handle = owned<ricci_quad_layout, ricci_quad_layout_free>;

// A layout of four-sided patches, each a rectangle of quads.
class quad_layout : public quad_layout_handle {
public:
    explicit quad_layout(ricci_quad_layout *handle) : quad_layout_handle(handle) {}
    explicit quad_layout(const seamless &on, const ricci_quads_options &options = init<ricci_quads_options>(),
                         const control *watched = nullptr)
        : quad_layout_handle(
              make<ricci_quad_layout>(ricci_quad_layout_new, on.get(), &options, of(watched))) {}
    ricci_quad_layout_summary summary() const { return ricci::summary(ricci_quad_layout_summarise, get()); }
    ricci::quads quads() const { return ricci::quads(make<ricci_quads>(ricci_quad_layout_quads, get())); }
    // Vertex, valence and crease of each node.
    std::vector<std::uint32_t> nodes() const { return values<std::uint32_t>(ricci_quad_layout_nodes, get()); }
    // Both nodes, length and crease of each arc.
    std::vector<std::uint32_t> arcs() const { return values<std::uint32_t>(ricci_quad_layout_arcs, get()); }
    // The vertices of the quad mesh along each arc.
    lists<std::uint32_t> arc_vertices() const {
        return rows<std::uint32_t>(summary().n_arcs, ricci_quad_layout_arc_vertices, get());
    }
    // Four lists for each patch: arc a as a + 1 in its direction, -(a + 1) against it.
    lists<std::int32_t> sides() const {
        return rows<std::int32_t>(4 * summary().n_patches, ricci_quad_layout_sides, get());
    }
    // The lengths of the first and the second side of each patch.
    std::vector<std::uint32_t> sizes() const { return values<std::uint32_t>(ricci_quad_layout_sizes, get()); }
    // The patch of each quad.
    std::vector<std::uint32_t> patches() const {
        return values<std::uint32_t>(ricci_quad_layout_patches, get());
    }
};

} // namespace ricci

#endif
