// Common parts of the OpenMesh tests: the kernels, lengths, angles and curvature in long double, and grids.
#ifndef MEASURE_HPP
#define MEASURE_HPP

#include <ricci/ricci.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Simple_cartesian.h>
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

using Real = long double;
using Mesh = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;
using Kernel = CGAL::Simple_cartesian<Real>;
using Exact = CGAL::Exact_predicates_inexact_constructions_kernel;

const Real pi = std::acos(Real(-1));
const Real epsilon = std::numeric_limits<double>::epsilon();

[[noreturn]] inline void fail(const char *file, int line, const char *what) {
    std::fprintf(stderr, "%s:%d: %s (last error: %s)\n", file, line, what, ricci_last_error());
    std::exit(1);
}
#define CHECK(condition) ((condition) ? void() : fail(__FILE__, __LINE__, #condition))
#define OK(call) CHECK((call) == RICCI_OK)

// The angle between sides a and b of a triangle, opposite c, by the half-angle form; and how far it moves
// when each length is rounded to double (first order, with a margin).
struct Angle {
    Real value, rounding;
};

inline Angle angle(Real a, Real b, Real c, uint32_t space) {
    const auto s = [&](Real x) { return space == RICCI_SPACE_H2 ? std::sinh(x) : x; };
    const Real p = (a + b + c) / 2;
    const Real value = 2 * std::atan2(std::sqrt(s(p - a) * s(p - b)), std::sqrt(s(p) * s(p - c)));
    const Real slope = s(c) * (a + b + c) / (s(a) * s(b) * std::sin(value));
    return {value, 4 * epsilon * slope + 16 * epsilon};
}

// Connectivity as ricci numbers it.
struct Surface {
    std::size_t n_vertices, n_edges, n_faces;
    std::vector<std::array<int32_t, 3>> faces;
    std::vector<std::array<int32_t, 3>> face_edges; // bc, ca, ab; 1-based, signed
    std::vector<bool> boundary;

    std::array<Real, 3> sides(const std::vector<double> &lengths, std::size_t f) const {
        std::array<Real, 3> l;
        for (int k = 0; k < 3; k++) l[k] = lengths[std::abs(face_edges[f][k]) - 1];
        return l;
    }

    // Curvature of every vertex, and a bound on what rounding the lengths does to it.
    void curvature(const std::vector<double> &lengths, uint32_t space, std::vector<Real> &at,
                   std::vector<Real> &rounding) const {
        at.assign(n_vertices, 2 * pi);
        rounding.assign(n_vertices, 0);
        for (std::size_t v = 0; v < n_vertices; v++)
            if (boundary[v]) at[v] = pi;
        for (std::size_t f = 0; f < n_faces; f++) {
            const auto l = sides(lengths, f);
            for (int k = 0; k < 3; k++) {
                const Angle corner = angle(l[(k + 1) % 3], l[(k + 2) % 3], l[k], space);
                at[faces[f][k]] -= corner.value;
                rounding[faces[f][k]] += corner.rounding;
            }
        }
    }
};

// The angle at a corner, from positions.
inline Real cgal_angle(const Mesh::Point &at, const Mesh::Point &p, const Mesh::Point &q) {
    const auto exact = [](const Mesh::Point &x) { return Kernel::Point_3(x[0], x[1], x[2]); };
    const Kernel::Vector_3 u(exact(at), exact(p)), v(exact(at), exact(q));
    return std::atan2(std::sqrt(CGAL::cross_product(u, v).squared_length()), u * v);
}

// An n x m grid, closed up in neither, one or both directions; `place` gives the positions.
template <class Place> Mesh grid(int n, int m, bool close_n, bool close_m, Place place) {
    Mesh mesh;
    std::vector<Mesh::VertexHandle> vertices;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < m; j++) vertices.push_back(mesh.add_vertex(place(i, j)));
    const auto at = [&](int i, int j) { return vertices[i % n * m + j % m]; };
    for (int i = 0; i + (close_n ? 0 : 1) < n; i++)
        for (int j = 0; j + (close_m ? 0 : 1) < m; j++) {
            mesh.add_face(at(i, j), at(i + 1, j), at(i + 1, j + 1));
            mesh.add_face(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    return mesh;
}

#endif
