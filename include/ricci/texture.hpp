// Texture atlases of whole models: C++ ownership and errors, as ricci/ricci.hpp has them.
//
//     const ricci::texture_atlas atlas(ricci::soup::read("model.obj"));
//     atlas.textured().write("model.glb");
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_TEXTURE_HPP
#define RICCI_TEXTURE_HPP

#include <ricci/repair.hpp>
#include <ricci/texture.h>

namespace ricci {

using texture_atlas_handle = owned<ricci_texture_atlas, ricci_texture_atlas_free>;

// The triangles of polygons, each a list of vertices.
inline soup soup_of_polygons(span<double> positions, const lists<std::uint32_t> &polygons) {
    return soup(make<ricci_soup>(ricci_soup_from_polygons, positions.data(), std::size_t(0),
                                 positions.size() / 3, polygons.entries.data(), polygons.starts.data(),
                                 polygons.size()));
}
// Of such a list: for each face its polygon.
inline std::vector<std::uint32_t> polygons_of(const soup &triangles) {
    return values<std::uint32_t>(ricci_soup_polygons, triangles.get());
}

// A model with texture coordinates on its own faces.
class texture_atlas : public texture_atlas_handle {
public:
    using texture_atlas_handle::texture_atlas_handle;
    explicit texture_atlas(const soup &model,
                           const ricci_texture_options &options = init<ricci_texture_options>(),
                           const control *watched = nullptr)
        : texture_atlas_handle(
              make<ricci_texture_atlas>(ricci_texture_atlas_new, model.get(), &options, of(watched))) {}
    ricci_texture_atlas_summary summary() const {
        return ricci::summary(ricci_texture_atlas_summarise, get());
    }
    // Six numbers for each face: the coordinates of its corners.
    std::vector<double> uv() const { return values<double>(ricci_texture_atlas_uv, get()); }
    // For each face its chart; UINT32_MAX without a place.
    std::vector<std::uint32_t> charts() const {
        return values<std::uint32_t>(ricci_texture_atlas_charts, get());
    }
    // For each face its page.
    std::vector<std::uint32_t> pages() const {
        return values<std::uint32_t>(ricci_texture_atlas_pages, get());
    }
    // The faces of a list: RICCI_TEXTURE_PLACELESS, ...
    std::vector<std::uint32_t> faces(std::uint32_t which) const {
        return values<std::uint32_t>(ricci_texture_atlas_faces, get(), which);
    }
    // The model with its vertices split along the seams, so that each has one pair of coordinates.
    struct split_model {
        std::vector<std::uint32_t> corners;  // three vertices of each face with a place
        std::vector<std::uint32_t> faces;    // their numbers in the model
        std::vector<std::uint32_t> vertices; // for each vertex that of the model that it is a copy of
        std::vector<double> uv;              // two for each vertex
    };
    split_model split() const {
        const ricci_texture_atlas_summary n = summary();
        split_model all{
            std::vector<std::uint32_t>(3 * n.n_split_faces), std::vector<std::uint32_t>(n.n_split_faces),
            std::vector<std::uint32_t>(n.n_split_vertices), std::vector<double>(2 * n.n_split_vertices)};
        check(ricci_texture_atlas_split(get(), all.corners.data(), all.corners.size(), all.faces.data(),
                                        all.faces.size(), all.vertices.data(), all.vertices.size(),
                                        all.uv.data(), all.uv.size()));
        return all;
    }
    // The model with these texture coordinates in place of its own.
    soup textured() const { return soup(make<ricci_soup>(ricci_texture_atlas_soup, get())); }
};

} // namespace ricci

#endif
