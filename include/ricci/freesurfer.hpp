// Data of FreeSurfer at the vertices of surfaces: C++ ownership and errors, as ricci/ricci.hpp has them.
//
//     const std::vector<double> sulc = ricci::read_values("lh.sulc");
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_FREESURFER_HPP
#define RICCI_FREESURFER_HPP

#include <ricci/core.hpp>
#include <ricci/freesurfer.h>

namespace ricci {

inline std::vector<double> read_values(const std::string &path) {
    std::size_t n = 0;
    check(ricci_values_read(path.c_str(), nullptr, 0, &n));
    std::vector<double> values(n);
    check(ricci_values_read(path.c_str(), values.data(), n, &n));
    return values;
}

inline void write_values(const std::string &path, const std::vector<double> &values, std::size_t n_faces) {
    check(ricci_values_write(path.c_str(), values.data(), values.size(), n_faces));
}

// A label: vertices (-1 for none), 3 coordinates and a value each.
struct vertex_label {
    std::vector<std::int32_t> vertices;
    std::vector<double> positions, values;
};

inline vertex_label read_label(const std::string &path) {
    std::size_t n = 0;
    check(ricci_label_read(path.c_str(), nullptr, 0, nullptr, 0, nullptr, 0, &n));
    vertex_label found{std::vector<std::int32_t>(n), std::vector<double>(3 * n), std::vector<double>(n)};
    check(ricci_label_read(path.c_str(), found.vertices.data(), n, found.positions.data(), 3 * n,
                           found.values.data(), n, &n));
    return found;
}

inline void write_label(const std::string &path, const vertex_label &label, const char *comment = nullptr) {
    const bool placed = !label.positions.empty(), valued = !label.values.empty();
    check(ricci_label_write(path.c_str(), comment, label.vertices.data(),
                            placed ? label.positions.data() : nullptr, valued ? label.values.data() : nullptr,
                            label.vertices.size()));
}

// A patch: vertices of a whole surface, 3 coordinates each, 1 for those on the border.
struct surface_patch {
    std::vector<std::uint32_t> vertices;
    std::vector<double> positions;
    std::vector<std::uint32_t> is_border;
};

inline surface_patch read_patch(const std::string &path) {
    std::size_t n = 0;
    check(ricci_patch_read(path.c_str(), nullptr, 0, nullptr, 0, nullptr, 0, &n));
    surface_patch found{std::vector<std::uint32_t>(n), std::vector<double>(3 * n),
                        std::vector<std::uint32_t>(n)};
    check(ricci_patch_read(path.c_str(), found.vertices.data(), n, found.positions.data(), 3 * n,
                           found.is_border.data(), n, &n));
    return found;
}

inline void write_patch(const std::string &path, const surface_patch &patch) {
    check(ricci_patch_write(path.c_str(), patch.vertices.data(), patch.positions.data(),
                            patch.is_border.data(), patch.vertices.size()));
}

// An annotation: per vertex a region or -1; per region a name, and red, green, blue and transparency.
struct annotation {
    std::vector<std::int32_t> regions;
    std::vector<std::string> names;
    std::vector<std::uint32_t> colors;
};

inline annotation read_annotation(const std::string &path) {
    std::size_t n = 0, bytes = 0;
    check(ricci_annotation_read(path.c_str(), nullptr, 0, &n, nullptr, 0, nullptr, 0, &bytes));
    std::vector<char> text(bytes);
    annotation found;
    found.regions.resize(n);
    check(ricci_annotation_read(path.c_str(), found.regions.data(), n, &n, nullptr, 0, text.data(), bytes,
                                &bytes));
    std::string name;
    for (const char *at = text.data(); *at; at++) {
        if (*at == '\n') {
            found.names.push_back(name);
            name.clear();
        } else {
            name += *at;
        }
    }
    found.colors.resize(4 * found.names.size());
    check(ricci_annotation_read(path.c_str(), nullptr, 0, &n, found.colors.data(), found.colors.size(),
                                nullptr, 0, &bytes));
    return found;
}

inline void write_annotation(const std::string &path, const annotation &given) {
    std::string names;
    for (const std::string &name : given.names) names += name + "\n";
    check(ricci_annotation_write(path.c_str(), given.regions.data(), given.regions.size(), names.c_str(),
                                 given.colors.data(), given.names.size()));
}

} // namespace ricci

#endif
