// Triangle lists with defects: C++ ownership and errors, as ricci/ricci.hpp has them.
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_REPAIR_HPP
#define RICCI_REPAIR_HPP

#include <ricci/repair.h>
#include <ricci/ricci.hpp>

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

} // namespace ricci

#endif
