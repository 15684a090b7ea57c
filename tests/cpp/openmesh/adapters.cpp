// The adapters of OpenMesh, CGAL and Eigen carry one mesh in and its UVs, factors and curvature out: on the
// same corners and vertices as the C face has them.
#include "measure.hpp"

#include <ricci/cgal.hpp>
#include <ricci/eigen.hpp>
#include <ricci/openmesh.hpp>

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

namespace {

using Floats = OpenMesh::TriMesh_ArrayKernelT<>;
using Doubles = Mesh;
using Surface_mesh = CGAL::Surface_mesh<Exact::Point_3>;

// A bump over a square, of n x n vertices.
const int n = 12;

std::array<double, 3> place(int i) {
    const double x = i / n / 5.5 - 1, y = i % n / 5.5 - 1;
    return {{x, y, std::exp(-2 * (x * x + y * y))}};
}

std::vector<std::array<int, 3>> triangles() {
    std::vector<std::array<int, 3>> all;
    for (int i = 0; i + 1 < n; i++)
        for (int j = 0; j + 1 < n; j++) {
            const int v = n * i + j;
            all.push_back({{v, v + n, v + n + 1}});
            all.push_back({{v, v + n + 1, v + 1}});
        }
    return all;
}

template <class Kernel> Kernel openmesh() {
    Kernel mesh;
    for (int i = 0; i < n * n; i++) {
        const auto p = place(i);
        using Number = typename Kernel::Scalar;
        mesh.add_vertex(typename Kernel::Point(Number(p[0]), Number(p[1]), Number(p[2])));
    }
    for (const auto &t : triangles())
        mesh.add_face(mesh.vertex_handle(unsigned(t[0])), mesh.vertex_handle(unsigned(t[1])),
                      mesh.vertex_handle(unsigned(t[2])));
    return mesh;
}

// The results of the C face for a mesh: the vertex and the point of every corner, and the factors.
struct Expected {
    ricci::metric flat;
    ricci::layout layout;
    std::vector<double> uv, factor, curvature;
    std::vector<std::uint32_t> faces;
    explicit Expected(const ricci::mesh &mesh)
        : flat(ricci::flow(ricci::metric(mesh), ricci::target::automatic(2))), layout(flat), uv(layout.uv()),
          factor(flat.factor()), curvature(flat.curvature()), faces(mesh.faces()) {
        CHECK(flat.report().converged && flat.cones().size() == 2 && layout.summary().n_flipped == 0);
    }
};

// A mesh is refused while it has a deleted face, and taken once that is gone.
void check_deleted() {
    using Kernel = OpenMesh::TriMesh_ArrayKernelT<>;
    Kernel mesh = openmesh<Kernel>();
    mesh.request_vertex_status();
    mesh.request_edge_status();
    mesh.request_halfedge_status();
    mesh.request_face_status();
    const std::size_t n_faces = mesh.n_faces();
    CHECK(ricci::openmesh::from(mesh).summary().n_faces == n_faces);
    mesh.delete_face(OpenMesh::FaceHandle(0), true);
    bool refused = false;
    try {
        ricci::openmesh::from(mesh);
    } catch (const std::invalid_argument &error) {
        refused = std::string(error.what()).find("garbage_collection") != std::string::npos;
    }
    CHECK(refused);
    mesh.garbage_collection();
    CHECK(ricci::openmesh::from(mesh).summary().n_faces == n_faces - 1);
}

template <class Kernel> std::vector<double> check_openmesh(double off) {
    Kernel mesh = openmesh<Kernel>();
    const ricci::mesh in = ricci::openmesh::from(mesh);
    const auto positions = in.positions();
    for (std::size_t k = 0; k < positions.size(); k++)
        CHECK(std::abs(positions[k] - place(int(k / 3))[k % 3]) <= off);
    const Expected expected(in);
    const auto uv = ricci::openmesh::uv(mesh, expected.layout);
    const auto factor = ricci::openmesh::factor(mesh, expected.flat);
    const auto curvature = ricci::openmesh::curvature(mesh, expected.flat);
    const auto again = ricci::openmesh::factor(mesh, expected.flat);
    CHECK(again.idx() == factor.idx()); // not added twice
    for (auto v : mesh.vertices()) {
        CHECK(mesh.property(factor, v) == expected.factor[std::size_t(v.idx())]);
        CHECK(mesh.property(curvature, v) == expected.curvature[std::size_t(v.idx())]);
    }
    for (auto f : mesh.faces()) {
        std::size_t k = 3 * std::size_t(f.idx());
        for (auto h : ricci::openmesh::corners(mesh, f)) {
            CHECK(std::uint32_t(mesh.to_vertex_handle(h).idx()) == expected.faces[k] &&
                  mesh.face_handle(h) == f);
            CHECK(mesh.property(uv, h)[0] == expected.uv[2 * k] &&
                  mesh.property(uv, h)[1] == expected.uv[2 * k + 1]);
            k++;
        }
    }
    return expected.factor;
}

// The quads of a surface of genus 2 as a PolyMesh: closed, of its topology, irregular at its cones alone.
template <class PolyMesh> void check_quads() {
    ricci_shape shape = ricci::init<ricci_shape>();
    shape.shape = RICCI_SHAPE_GENUS, shape.n = 4, shape.genus = 2;
    const ricci::seamless flat(ricci::mesh::made(shape));
    const ricci::quads quads(flat, ricci::quads_of_number(300));
    const PolyMesh mesh = ricci::openmesh::poly_mesh<PolyMesh>(quads);
    const auto summary = quads.summary();
    CHECK(mesh.n_faces() == summary.n_quads && mesh.n_vertices() == summary.n_vertices);
    CHECK(int(mesh.n_vertices()) - int(mesh.n_edges()) + int(mesh.n_faces()) == -2);
    const auto positions = quads.positions();
    const auto faces = quads.faces();
    std::size_t irregular = 0;
    int excess = 0;
    for (auto v : mesh.vertices()) {
        CHECK(!mesh.is_boundary(v));
        irregular += mesh.valence(v) != 4;
        excess += 4 - int(mesh.valence(v));
        for (unsigned k = 0; k < 3; k++)
            CHECK(mesh.point(v)[k] == typename PolyMesh::Scalar(positions[3 * std::size_t(v.idx()) + k]));
    }
    CHECK(irregular == summary.n_irregular && excess == -8);
    for (auto f : mesh.faces()) {
        std::vector<std::uint32_t> corners;
        for (auto v : mesh.fv_range(f)) corners.push_back(std::uint32_t(v.idx()));
        const auto first = faces.begin() + 4 * f.idx();
        CHECK(corners.size() == 4 && std::is_permutation(corners.begin(), corners.end(), first));
    }
}

std::vector<double> check_cgal() {
    Surface_mesh mesh;
    for (int i = 0; i < n * n; i++) mesh.add_vertex(Exact::Point_3(place(i)[0], place(i)[1], place(i)[2]));
    for (const auto &t : triangles())
        mesh.add_face(Surface_mesh::Vertex_index(unsigned(t[0])), Surface_mesh::Vertex_index(unsigned(t[1])),
                      Surface_mesh::Vertex_index(unsigned(t[2])));
    const Expected expected(ricci::cgal::from(mesh));
    const auto uv = ricci::cgal::uv(mesh, expected.layout);
    const auto factor = ricci::cgal::factor(mesh, expected.flat);
    const auto curvature = ricci::cgal::curvature(mesh, expected.flat);
    for (auto v : mesh.vertices())
        CHECK(factor[v] == expected.factor[v] && curvature[v] == expected.curvature[v]);
    for (auto f : mesh.faces()) {
        std::size_t k = 3 * std::size_t(f);
        for (auto h : ricci::cgal::corners(mesh, f)) {
            CHECK(mesh.target(h) == Surface_mesh::Vertex_index(expected.faces[k]));
            CHECK(uv[h][0] == expected.uv[2 * k] && uv[h][1] == expected.uv[2 * k + 1]);
            k++;
        }
    }
    mesh.remove_vertex(Surface_mesh::Vertex_index(0));
    try {
        ricci::cgal::from(mesh);
        CHECK(false);
    } catch (const std::invalid_argument &) {
    }
    return expected.factor;
}

std::vector<double> check_eigen() {
    Eigen::MatrixXf V(n * n, 3); // any scalar and order
    Eigen::MatrixXi F(int(triangles().size()), 3);
    for (int i = 0; i < n * n; i++)
        for (int k = 0; k < 3; k++) V(i, k) = float(place(i)[std::size_t(k)]);
    for (int f = 0; f < F.rows(); f++)
        for (int k = 0; k < 3; k++) F(f, k) = triangles()[std::size_t(f)][std::size_t(k)];
    const Expected expected(ricci::eigen::from(V, F));
    const auto UV = ricci::eigen::points(expected.layout);
    const auto FUV = ricci::eigen::corners(expected.layout);
    CHECK(FUV.rows() == F.rows() && UV.rows() == Eigen::Index(expected.layout.summary().n_points));
    for (int f = 0; f < F.rows(); f++)
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 2; i++)
                CHECK(UV(FUV(f, k), i) == expected.uv[std::size_t(6 * f + 2 * k + i)]);
    CHECK(ricci::eigen::curvature(expected.flat)[3] == expected.curvature[3]);
    const Eigen::VectorXd factor = ricci::eigen::factor(expected.flat);
    return std::vector<double>(factor.data(), factor.data() + factor.size());
}

} // namespace

int main() {
    check_deleted();
    check_quads<OpenMesh::PolyMesh_ArrayKernelT<>>();
    check_quads<OpenMesh::PolyMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>>();
    const auto doubles = check_openmesh<Doubles>(0), floats = check_openmesh<Floats>(1e-7);
    const auto cgal = check_cgal(), eigen = check_eigen();
    double off = 0;
    for (std::size_t v = 0; v < doubles.size(); v++) {
        CHECK(floats[v] == eigen[v]); // the same numbers, rounded
        off = std::max(off, std::abs(doubles[v] - cgal[v]));
    }
    std::printf("factors of OpenMesh and CGAL agree to %.1e\n", off);
    return off < 1e-9 ? 0 : 1;
}
