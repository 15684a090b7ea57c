// Scenes of glTF with a texture atlas: C++ ownership and errors, as ricci/ricci.hpp has them.
//
//     const ricci::scene scene("scene.glb");
//     scene.write(scene.atlas(), "out.glb");
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_SCENE_HPP
#define RICCI_SCENE_HPP

#include <ricci/scene.h>
#include <ricci/texture.hpp>

namespace ricci {

using scene_handle = owned<ricci_scene, ricci_scene_free>;

// A glTF file with everything that is in it.
class scene : public scene_handle {
public:
    using scene_handle::scene_handle;
    explicit scene(const std::string &path)
        : scene_handle(make<ricci_scene>(ricci_scene_read, path.c_str())) {}
    ricci_scene_summary summary() const { return ricci::summary(ricci_scene_summarise, get()); }
    // One atlas for all meshes.
    texture_atlas atlas(const ricci_texture_options &options = init<ricci_texture_options>(),
                        const control *watched = nullptr) const {
        return texture_atlas(
            make<ricci_texture_atlas>(ricci_scene_texture_atlas, get(), &options, of(watched)));
    }
    // The file with the atlas; nodes, materials and names are as they were.
    ricci_scene_report write(const texture_atlas &made, const std::string &path,
                             const ricci_scene_options &options = init<ricci_scene_options>()) const {
        ricci_scene_report report{};
        check(ricci_scene_write(get(), made.get(), &options, path.c_str(), &report, sizeof report));
        return report;
    }
};

// A triangle list with texture coordinates as .glb with tangents.
inline void write_with_tangents(const soup &textured, const std::string &path) {
    check(ricci_soup_write_with_tangents(textured.get(), path.c_str()));
}

} // namespace ricci

#endif
