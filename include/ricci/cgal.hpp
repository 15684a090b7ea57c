// CGAL::Surface_mesh in and out, of any point type with x(), y(), z().
//
//     const auto flat = ricci::flow(ricci::metric(ricci::cgal::from(mesh)), ricci::target::automatic(8));
//     const auto uv = ricci::cgal::uv(mesh, ricci::layout(flat));
//     const auto factor = ricci::cgal::factor(mesh, flat);
//
// `uv` is a property map of half-edges: the coordinates of the corner at their target; `factor` one of
// vertices.
// Elements keep CGAL's numbers; call collect_garbage() first where elements were removed. The maps are named
// "h:ricci_uv", "v:ricci_factor" and "v:ricci_curvature".
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_CGAL_HPP
#define RICCI_CGAL_HPP

#include <CGAL/Surface_mesh.h>
#include <ricci/core.hpp>

namespace ricci {
namespace cgal {

// The half-edges whose targets are the corners of a face, in the order of ricci.
template <class Mesh, class Face>
std::array<typename Mesh::Halfedge_index, 3> corners(const Mesh &mesh, Face f) {
    std::array<typename Mesh::Halfedge_index, 3> all;
    all[0] = mesh.halfedge(f);
    all[1] = mesh.next(all[0]);
    all[2] = mesh.next(all[1]);
    if (mesh.next(all[2]) != all[0]) throw std::invalid_argument("a face is no triangle");
    return all;
}

// The mesh, in the numbers of CGAL.
template <class Point> ricci::mesh from(const CGAL::Surface_mesh<Point> &mesh) {
    if (mesh.has_garbage()) throw std::invalid_argument("elements were removed: collect_garbage() first");
    std::vector<double> positions;
    positions.reserve(3 * mesh.number_of_vertices());
    for (const auto v : mesh.vertices()) {
        const Point &p = mesh.point(v);
        for (const double x : {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())})
            positions.push_back(x);
    }
    std::vector<std::uint32_t> faces;
    faces.reserve(3 * mesh.number_of_faces());
    for (const auto f : mesh.faces())
        for (const auto h : corners(mesh, f)) faces.push_back(mesh.target(h));
    return ricci::mesh::from(positions, faces);
}

// One number per vertex.
template <class Point>
typename CGAL::Surface_mesh<Point>::template Property_map<typename CGAL::Surface_mesh<Point>::Vertex_index,
                                                          double>
set(CGAL::Surface_mesh<Point> &mesh, const std::vector<double> &values, const char *name) {
    using Vertex = typename CGAL::Surface_mesh<Point>::Vertex_index;
    if (values.size() != mesh.number_of_vertices())
        throw std::invalid_argument("these values are not of this mesh");
    auto all = mesh.template add_property_map<Vertex, double>(name).first;
    for (const auto v : mesh.vertices()) all[v] = values[static_cast<std::size_t>(v)];
    return all;
}

// The conformal factor of every vertex (RICCI_METRIC_FACTOR).
template <class Point>
auto factor(CGAL::Surface_mesh<Point> &mesh, const metric &flat)
    -> decltype(set(mesh, std::vector<double>(), "")) {
    return set(mesh, flat.factor(), "v:ricci_factor");
}

// The curvature of every vertex.
template <class Point>
auto curvature(CGAL::Surface_mesh<Point> &mesh, const metric &flat)
    -> decltype(set(mesh, std::vector<double>(), "")) {
    return set(mesh, flat.curvature(), "v:ricci_curvature");
}

// The coordinates of every corner, at the half-edge of its face that ends there.
template <class Point>
typename CGAL::Surface_mesh<Point>::template Property_map<typename CGAL::Surface_mesh<Point>::Halfedge_index,
                                                          std::array<double, 2>>
uv(CGAL::Surface_mesh<Point> &mesh, const layout &laid) {
    using Halfedge = typename CGAL::Surface_mesh<Point>::Halfedge_index;
    const std::vector<double> values = laid.uv();
    if (values.size() != 6 * mesh.number_of_faces())
        throw std::invalid_argument("this layout is not of this mesh");
    auto all = mesh.template add_property_map<Halfedge, std::array<double, 2>>("h:ricci_uv").first;
    std::size_t i = 0;
    for (const auto f : mesh.faces())
        for (const auto h : corners(mesh, f)) {
            all[h] = {{values[i], values[i + 1]}};
            i += 2;
        }
    return all;
}

} // namespace cgal
} // namespace ricci

#endif
