// Archives, in which results are kept as bytes and files: C++ ownership and errors, as ricci/ricci.hpp has
// them.
//
//     ricci::archive(layout).write("bunny.layout");
//     const ricci::layout again = ricci::archive::read("bunny.layout").get_as<ricci::layout>();
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_ARCHIVE_HPP
#define RICCI_ARCHIVE_HPP

#include <ricci/archive.h>
#include <ricci/circles.hpp>
#include <ricci/core.hpp>
#include <ricci/harmonic.hpp>
#include <ricci/match.hpp>
#include <ricci/quad_spline.hpp>
#include <ricci/quads.hpp>
#include <ricci/seamless.hpp>
#include <ricci/spline.hpp>
#include <ricci/structure.hpp>
#include <ricci/uniformize.hpp>

namespace ricci {

// The field of an object of this type.
inline ricci_mesh *&field_of(ricci_objects &all, const ricci_mesh *) { return all.mesh; }
inline ricci_metric *&field_of(ricci_objects &all, const ricci_metric *) { return all.metric; }
inline ricci_layout *&field_of(ricci_objects &all, const ricci_layout *) { return all.layout; }
inline ricci_charts *&field_of(ricci_objects &all, const ricci_charts *) { return all.charts; }
inline ricci_map *&field_of(ricci_objects &all, const ricci_map *) { return all.map; }
inline ricci_uniform *&field_of(ricci_objects &all, const ricci_uniform *) { return all.uniform; }
inline ricci_circle_domain *&field_of(ricci_objects &all, const ricci_circle_domain *) {
    return all.circle_domain;
}
inline ricci_forms *&field_of(ricci_objects &all, const ricci_forms *) { return all.forms; }
inline ricci_matching *&field_of(ricci_objects &all, const ricci_matching *) { return all.matching; }
inline ricci_structure *&field_of(ricci_objects &all, const ricci_structure *) { return all.structure; }
inline ricci_seamless *&field_of(ricci_objects &all, const ricci_seamless *) { return all.seamless; }
inline ricci_quads *&field_of(ricci_objects &all, const ricci_quads *) { return all.quads; }
inline ricci_quad_layout *&field_of(ricci_objects &all, const ricci_quad_layout *) { return all.quad_layout; }
inline ricci_quad_spline *&field_of(ricci_objects &all, const ricci_quad_spline *) { return all.quad_spline; }
inline ricci_spline *&field_of(ricci_objects &all, const ricci_spline *) { return all.spline; }

using archive_handle = owned<ricci_archive, ricci_archive_free>;

class archive : public archive_handle {
public:
    using archive_handle::archive_handle;
    // The archive of an object of any class.
    template <class Object, class = decltype(field_of(std::declval<ricci_objects &>(),
                                                      std::declval<const Object &>().get()))>
    explicit archive(const Object &object) {
        ricci_objects all = init<ricci_objects>();
        field_of(all, object.get()) = object.get();
        handle_ = make<ricci_archive>(ricci_archive_new, &all);
    }
    static archive read(const std::string &path) {
        return archive(make<ricci_archive>(ricci_archive_read, path.c_str()));
    }
    static archive parse(span<std::uint8_t> bytes) {
        return archive(make<ricci_archive>(ricci_archive_parse, bytes.data(), bytes.size()));
    }
    void write(const std::string &path) const { check(ricci_archive_write(handle_, path.c_str())); }
    std::vector<std::uint8_t> bytes() const { return values<std::uint8_t>(ricci_archive_bytes, get()); }
    ricci_archive_summary summary() const { return ricci::summary(ricci_archive_summarise, get()); }
    // The object in it, a new one at each call, or an object that it was made from: the mesh of a metric.
    template <class Object> Object get_as() const {
        using pointer = decltype(std::declval<const Object &>().get());
        ricci_objects all = init<ricci_objects>();
        check(ricci_archive_objects(handle_, &all, sizeof all));
        pointer found = nullptr;
        std::swap(found, field_of(all, pointer()));
        free_all(all);
        if (!found) throw std::invalid_argument(std::string("the archive holds a ") + summary().kind);
        return Object(found);
    }
    // The mesh that a map or a matching leads to.
    mesh target() const {
        ricci_objects all = init<ricci_objects>();
        check(ricci_archive_objects(handle_, &all, sizeof all));
        ricci_mesh *found = nullptr;
        std::swap(found, all.target);
        free_all(all);
        if (!found) throw std::invalid_argument(std::string("the archive holds a ") + summary().kind);
        return mesh(found);
    }

private:
    static void free_all(const ricci_objects &all) {
        ricci_mesh_free(all.mesh), ricci_metric_free(all.metric), ricci_layout_free(all.layout);
        ricci_charts_free(all.charts), ricci_map_free(all.map), ricci_uniform_free(all.uniform);
        ricci_circle_domain_free(all.circle_domain), ricci_forms_free(all.forms);
        ricci_matching_free(all.matching), ricci_structure_free(all.structure);
        ricci_seamless_free(all.seamless), ricci_quads_free(all.quads);
        ricci_quad_layout_free(all.quad_layout), ricci_quad_spline_free(all.quad_spline);
        ricci_spline_free(all.spline), ricci_mesh_free(all.target);
    }
};

} // namespace ricci

#endif
