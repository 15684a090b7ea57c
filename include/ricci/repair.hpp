// Triangle lists with defects: C++ ownership and errors, as ricci/ricci.hpp has them.
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_REPAIR_HPP
#define RICCI_REPAIR_HPP

#include <ricci/core.hpp>
#include <ricci/repair.h>

namespace ricci {

using soup_handle = owned<ricci_soup, ricci_soup_free>;

// A triangle list, which may have defects.
class soup : public soup_handle {
public:
    using soup_handle::soup_handle;
    static soup read(const std::string &path) {
        return soup(make<ricci_soup>(ricci_soup_read, path.c_str()));
    }
    static soup from(span<double> positions, span<std::uint32_t> faces) {
        return soup(make<ricci_soup>(ricci_soup_from_arrays, positions.data(), std::size_t(0),
                                     positions.size() / 3, faces.data(), faces.size() / 3));
    }
    soup with(const ricci_attributes &attributes) const {
        return soup(make<ricci_soup>(ricci_soup_with_attributes, get(), &attributes));
    }
    ricci_soup_summary summary() const { return ricci::summary(ricci_soup_summarise, get()); }
    ricci_quality_summary quality() const { return ricci::summary(ricci_soup_quality, get()); }
    ricci_defect defect(std::size_t index) const {
        ricci_defect one;
        check(ricci_soup_defect(handle_, index, &one, sizeof one));
        return one;
    }
    // A finding that is no defect: an open seam, T-junctions, coarse coordinates.
    ricci_defect hint(std::size_t index) const {
        ricci_defect one;
        check(ricci_soup_hint(handle_, index, &one, sizeof one));
        return one;
    }
    // The boundary loops: their lengths and their vertices.
    struct loops_of_surface {
        std::vector<double> lengths;
        std::vector<std::uint32_t> vertices;
        std::vector<std::size_t> starts;
    };
    loops_of_surface loops() const {
        const ricci_soup_summary n = summary();
        loops_of_surface all{std::vector<double>(n.n_loops), std::vector<std::uint32_t>(n.n_loop_vertices),
                             std::vector<std::size_t>(n.n_loops + 1)};
        check(ricci_soup_loops(handle_, all.lengths.data(), all.lengths.size(), all.vertices.data(),
                               all.vertices.size(), all.starts.data(), all.starts.size()));
        return all;
    }
    // Two vertices of each edge at which the surface turns by so many radians or more, and these angles.
    std::pair<std::vector<std::uint32_t>, std::vector<double>> sharp_edges(double angle) const {
        std::size_t n = 0;
        check(ricci_soup_sharp_edges(handle_, angle, nullptr, 0, nullptr, 0, &n));
        std::pair<std::vector<std::uint32_t>, std::vector<double>> both{std::vector<std::uint32_t>(2 * n),
                                                                        std::vector<double>(n)};
        check(ricci_soup_sharp_edges(handle_, angle, both.first.data(), both.first.size(), both.second.data(),
                                     both.second.size(), &n));
        return both;
    }
    std::vector<std::uint32_t> corners(double angle) const {
        std::size_t n = 0;
        check(ricci_soup_corners(handle_, angle, nullptr, 0, &n));
        std::vector<std::uint32_t> vertices(n);
        check(ricci_soup_corners(handle_, angle, vertices.data(), n, &n));
        return vertices;
    }
    // For each face the number of its name (RICCI_LABEL_OBJECT, ...), and the names.
    std::pair<std::vector<std::uint32_t>, std::vector<std::string>> names(std::uint32_t which) const {
        std::size_t n = 0;
        std::pair<std::vector<std::uint32_t>, std::vector<std::string>> both{
            std::vector<std::uint32_t>(summary().n_faces), {}};
        check(ricci_soup_labels(handle_, which, both.first.data(), both.first.size(), &n));
        for (std::size_t k = 0; k < n; ++k) {
            both.second.push_back(text_of(ricci_soup_label, get(), which, k));
        }
        return both;
    }
    // Further numbers of vertices or faces (RICCI_OF_VERTICES, RICCI_OF_FACES) with their name.
    std::pair<std::string, std::vector<double>> numbers(std::uint32_t of, std::size_t index) const {
        const std::uint32_t which =
            of == RICCI_OF_VERTICES ? RICCI_LABEL_VERTEX_NUMBERS : RICCI_LABEL_FACE_NUMBERS;
        return {text_of(ricci_soup_label, get(), which, index),
                ricci::values<double>(ricci_soup_numbers, get(), of, index)};
    }
    // A hole that a repair was asked to fill.
    ricci_hole hole(std::size_t index) const {
        ricci_hole one;
        check(ricci_soup_hole(handle_, index, &one, sizeof one));
        return one;
    }
    // The connected pieces, those with the most faces first; origins() of a piece lead back to this list.
    std::vector<soup> components() const {
        std::vector<soup> pieces;
        ricci_repair_options options = init<ricci_repair_options>();
        options.weld = -1.0;
        for (std::size_t k = 1; k <= summary().n_components; ++k) {
            options.component = k;
            pieces.push_back(repaired(options));
        }
        return pieces;
    }
    std::vector<double> values(std::uint32_t which) const {
        return ricci::values<double>(ricci_soup_values, get(), which);
    }
    std::vector<std::uint32_t> faces() const { return ricci::values<std::uint32_t>(ricci_soup_faces, get()); }
    soup repaired(const ricci_repair_options &options = init<ricci_repair_options>()) const {
        return soup(make<ricci_soup>(ricci_soup_repair, get(), &options));
    }
    // The vertices and faces of the original list that those of a repaired list come from.
    std::pair<std::vector<std::uint32_t>, std::vector<std::uint32_t>> origins() const {
        const ricci_soup_summary n = summary();
        std::pair<std::vector<std::uint32_t>, std::vector<std::uint32_t>> both{
            std::vector<std::uint32_t>(n.n_vertices), std::vector<std::uint32_t>(n.n_faces)};
        check(ricci_soup_origins(handle_, both.first.data(), both.first.size(), both.second.data(),
                                 both.second.size()));
        return both;
    }
    // The same surface in smaller triangles.
    soup refined(const ricci_refine_options &options) const {
        return soup(make<ricci_soup>(ricci_soup_refine, get(), &options));
    }
    // Of a refined list: for each face its given face; for each vertex a given face and coordinates in it.
    struct places {
        std::vector<std::uint32_t> faces, vertex_faces;
        std::vector<double> weights;
    };
    places where() const {
        const ricci_soup_summary n = summary();
        places all{std::vector<std::uint32_t>(n.n_faces), std::vector<std::uint32_t>(n.n_vertices),
                   std::vector<double>(3 * n.n_vertices)};
        check(ricci_soup_places(handle_, all.faces.data(), all.faces.size(), all.vertex_faces.data(),
                                all.vertex_faces.size(), all.weights.data(), all.weights.size()));
        return all;
    }
    ricci::mesh build() const { return ricci::mesh(make<ricci_mesh>(ricci_soup_mesh, get())); }
    void write(const std::string &path) const { check(ricci_soup_write(handle_, path.c_str())); }
};

// The same metric without small angles, as an intrinsic mesh.
inline mesh refined_to_angle(const mesh &on,
                             const ricci_refine_options &options = init<ricci_refine_options>(),
                             const control *watched = nullptr) {
    return mesh(make<ricci_mesh>(ricci_mesh_refine_angle, on.get(), &options, of(watched),
                                 static_cast<ricci_refine_summary *>(nullptr), std::size_t(0)));
}
// Of such a mesh: for each vertex a face of the given mesh, and coordinates in it.
inline std::pair<std::vector<std::uint32_t>, std::vector<double>> places_of(const mesh &refined) {
    std::vector<std::uint32_t> faces(refined.summary().n_vertices);
    std::vector<double> weights(3 * faces.size());
    check(ricci_mesh_places(refined.get(), faces.data(), faces.size(), weights.data(), weights.size()));
    return {std::move(faces), std::move(weights)};
}

} // namespace ricci

#endif
