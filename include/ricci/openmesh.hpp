// OpenMesh in and out: any TriMesh kernel, of float or double, and quads as any PolyMesh kernel. Include
// OpenMesh before.
//
//     const auto flat = ricci::flow(ricci::metric(ricci::openmesh::from(mesh)), ricci::target::automatic(8));
//     const auto uv = ricci::openmesh::uv(mesh, ricci::layout(flat));
//     const auto factor = ricci::openmesh::factor(mesh, flat);
//
//     const ricci::quads quads{ricci::seamless(ricci::openmesh::from(mesh))};
//     const auto four_sided = ricci::openmesh::poly_mesh<OpenMesh::PolyMesh_ArrayKernelT<>>(quads);
//
// `uv` is a property of half-edges: the coordinates of the corner at their tip; `factor` one of vertices.
// Elements keep OpenMesh's numbers; a mesh with deleted elements is refused until garbage_collection().
// Properties are added under the names "ricci:uv", "ricci:factor" and "ricci:curvature", or written again
// where the mesh has them.
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_OPENMESH_HPP
#define RICCI_OPENMESH_HPP

#include <OpenMesh/Core/Geometry/VectorT.hh>
#include <OpenMesh/Core/Utils/Property.hh>
#include <ricci/core.hpp>
#include <ricci/quads.hpp>

namespace ricci {
namespace openmesh {

// The half-edges whose tips are the corners of a face, in the order of ricci.
template <class Mesh>
std::array<::OpenMesh::HalfedgeHandle, 3> corners(const Mesh &mesh, ::OpenMesh::FaceHandle f) {
    std::array<::OpenMesh::HalfedgeHandle, 3> all;
    all[0] = mesh.halfedge_handle(f);
    all[1] = mesh.next_halfedge_handle(all[0]);
    all[2] = mesh.next_halfedge_handle(all[1]);
    return all;
}

// True if the mesh still has elements that were deleted.
template <class Mesh> bool has_deleted(const Mesh &mesh) {
    if (mesh.has_vertex_status())
        for (std::size_t v = 0; v < mesh.n_vertices(); v++)
            if (mesh.status(::OpenMesh::VertexHandle(static_cast<int>(v))).deleted()) return true;
    if (mesh.has_face_status())
        for (std::size_t f = 0; f < mesh.n_faces(); f++)
            if (mesh.status(::OpenMesh::FaceHandle(static_cast<int>(f))).deleted()) return true;
    return false;
}

// The mesh, in the numbers of OpenMesh. Throws std::invalid_argument for one with deleted elements.
template <class Mesh> ricci::mesh from(const Mesh &mesh) {
    if (has_deleted(mesh))
        throw std::invalid_argument("the mesh has deleted elements: call garbage_collection() first");
    std::vector<double> positions;
    positions.reserve(3 * mesh.n_vertices());
    for (std::size_t v = 0; v < mesh.n_vertices(); v++) {
        const auto &p = mesh.point(::OpenMesh::VertexHandle(static_cast<int>(v)));
        for (unsigned k = 0; k < 3; k++) positions.push_back(static_cast<double>(p[k]));
    }
    std::vector<int> faces;
    faces.reserve(3 * mesh.n_faces());
    for (std::size_t f = 0; f < mesh.n_faces(); f++)
        for (const auto h : corners(mesh, ::OpenMesh::FaceHandle(static_cast<int>(f))))
            faces.push_back(mesh.to_vertex_handle(h).idx());
    return ricci::mesh::from(positions, faces);
}

// A property of this name, added if the mesh has none.
template <class Property, class Mesh> Property property(Mesh &mesh, const char *name) {
    Property found;
    if (!mesh.get_property_handle(found, name)) mesh.add_property(found, name);
    return found;
}

// One number per vertex.
template <class Mesh>
::OpenMesh::VPropHandleT<double> set(Mesh &mesh, const std::vector<double> &values, const char *name) {
    if (values.size() != mesh.n_vertices()) throw std::invalid_argument("these values are not of this mesh");
    const auto all = property<::OpenMesh::VPropHandleT<double>>(mesh, name);
    for (std::size_t v = 0; v < values.size(); v++)
        mesh.property(all, ::OpenMesh::VertexHandle(static_cast<int>(v))) = values[v];
    return all;
}

// The conformal factor of every vertex (RICCI_METRIC_FACTOR).
template <class Mesh>::OpenMesh::VPropHandleT<double> factor(Mesh &mesh, const metric &flat) {
    return set(mesh, flat.factor(), "ricci:factor");
}

// The curvature of every vertex.
template <class Mesh>::OpenMesh::VPropHandleT<double> curvature(Mesh &mesh, const metric &flat) {
    return set(mesh, flat.curvature(), "ricci:curvature");
}

// The coordinates of every corner, at the half-edge of its face that ends there.
template <class Mesh>::OpenMesh::HPropHandleT<::OpenMesh::Vec2d> uv(Mesh &mesh, const layout &laid) {
    const std::vector<double> values = laid.uv();
    if (values.size() != 6 * mesh.n_faces()) throw std::invalid_argument("this layout is not of this mesh");
    const auto all = property<::OpenMesh::HPropHandleT<::OpenMesh::Vec2d>>(mesh, "ricci:uv");
    std::size_t i = 0;
    for (std::size_t f = 0; f < mesh.n_faces(); f++)
        for (const auto h : corners(mesh, ::OpenMesh::FaceHandle(static_cast<int>(f)))) {
            mesh.property(all, h) = ::OpenMesh::Vec2d(values[i], values[i + 1]);
            i += 2;
        }
    return all;
}

// A mesh of quads, with the numbers of ricci, as a PolyMesh. Throws std::invalid_argument for quads that
// OpenMesh does not join, as those with an edge or a vertex that is not manifold.
template <class PolyMesh> PolyMesh poly_mesh(const quads &made) {
    PolyMesh mesh;
    const std::vector<double> positions = made.positions();
    using Number = typename PolyMesh::Scalar;
    for (std::size_t k = 0; k < positions.size(); k += 3)
        mesh.add_vertex(typename PolyMesh::Point(static_cast<Number>(positions[k]),
                                                 static_cast<Number>(positions[k + 1]),
                                                 static_cast<Number>(positions[k + 2])));
    const std::vector<std::uint32_t> faces = made.faces();
    std::vector<::OpenMesh::VertexHandle> around(4);
    for (std::size_t q = 0; q < faces.size(); q += 4) {
        for (std::size_t k = 0; k < 4; k++)
            around[k] = ::OpenMesh::VertexHandle(static_cast<int>(faces[q + k]));
        if (!mesh.add_face(around).is_valid())
            throw std::invalid_argument("OpenMesh does not join quad " + std::to_string(q / 4));
    }
    return mesh;
}

} // namespace openmesh
} // namespace ricci

#endif
