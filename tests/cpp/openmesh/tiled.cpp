// A uniformized surface tiles its plane: OpenMesh loads, ricci uniformizes, and CGAL's exact predicates, in
// the Klein disk where geodesics are straight, find every face counterclockwise, and every point of a disk
// about the base in one triangle of one copy of the layout, and in one copy of the Dirichlet domain.
//
//   test_tiled [MESH]     without an argument: generated meshes
#include "measure.hpp"

#include <random>
#include <ricci/uniformize.hpp>

namespace {

using Point = Exact::Point_2;
using Polygon = std::vector<Point>; // convex

// Ambient coordinates, n x 3, as points of the plane or of the Klein disk.
std::vector<Point> flat(const std::vector<double> &ambient, uint32_t space) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < ambient.size() / 3; i++) {
        double p[3] = {ambient[3 * i], ambient[3 * i + 1], ambient[3 * i + 2]};
        if (space == RICCI_SPACE_H2) ricci_from_hyperboloid(RICCI_MODEL_KLEIN, p, p);
        points.emplace_back(p[0], p[1]);
    }
    return points;
}

bool contains(const Polygon &polygon, const Point &p) {
    for (std::size_t k = 0; k < polygon.size(); k++)
        if (CGAL::orientation(polygon[k], polygon[(k + 1) % polygon.size()], p) != CGAL::LEFT_TURN)
            return false;
    return true;
}

// Points spread over a disk about the origin of this radius.
std::vector<Point> samples(double radius, uint32_t space) {
    std::mt19937 random(7);
    std::vector<double> ambient;
    for (int i = 0; i < 40; i++) {
        const double a = double(random()) / 4294967296.0 * 2 * double(pi);
        const double r = std::sqrt(double(random()) / 4294967296.0) * radius;
        const bool hyperbolic = space == RICCI_SPACE_H2;
        const double d = hyperbolic ? std::sinh(r) : r;
        ambient.insert(ambient.end(), {d * std::cos(a), d * std::sin(a), hyperbolic ? std::cosh(r) : 1});
    }
    return flat(ambient, space);
}

void check(const std::string &name, const Mesh &input) {
    std::vector<int> faces;
    for (auto f : input.faces())
        for (auto v : f.vertices()) faces.push_back(v.idx());
    std::vector<double> positions;
    for (auto v : input.vertices())
        positions.insert(positions.end(), input.point(v).data(), input.point(v).data() + 3);
    const ricci::uniform quotient(ricci::mesh::from(positions, faces));
    const auto q = quotient.summary();
    const auto laid = quotient.layout(RICCI_ON_METRIC);
    const auto l = laid.summary();
    CHECK(q.converged && l.n_flipped == 0);
    const auto points = laid.points(RICCI_MODEL_AMBIENT);
    const auto corners = laid.corners(RICCI_ON_METRIC);

    const auto domain = quotient.dirichlet();
    const auto d = domain.summary();
    const auto polygon = domain.corners();
    // A copy that meets the disk has its centre in this one.
    const double radius = d.radius, reach = radius + std::max(d.radius, q.radius);
    auto spec = ricci::init<ricci_deck_spec>();
    spec.kind = RICCI_DECK_WITHIN, spec.dirichlet = domain.get(), spec.radius = reach, spec.limit = 100000;
    const auto cover = quotient.deck(spec);
    const auto count = cover.summary();

    const auto all = samples(radius, q.space);
    std::vector<std::size_t> triangles(all.size(), 0), polygons(all.size(), 0);
    for (std::size_t g = 0; g < count.n_elements; g++) {
        const auto layout = flat(cover.moved(g, points), q.space);
        const auto copy = flat(cover.moved(g, polygon), q.space);
        for (std::size_t i = 0; i < all.size(); i++) polygons[i] += contains(copy, all[i]);
        for (std::size_t f = 0; f < l.n_faces; f++) {
            const Polygon face = {layout[corners[3 * f]], layout[corners[3 * f + 1]],
                                  layout[corners[3 * f + 2]]};
            if (g == 0) CHECK(CGAL::orientation(face[0], face[1], face[2]) == CGAL::LEFT_TURN);
            for (std::size_t i = 0; i < all.size(); i++) triangles[i] += contains(face, all[i]);
        }
    }
    for (std::size_t i = 0; i < all.size(); i++) CHECK(triangles[i] == 1 && polygons[i] == 1);
    std::printf("%s: genus %zu, %zu copies of %zu faces and of %u sides cover %zu points once\n",
                name.c_str(), q.genus, count.n_elements, l.n_faces, unsigned(d.n_sides), all.size());
}

Mesh from_arrays(const ricci_shape &shape) {
    const auto mesh = ricci::mesh::made(shape);
    const auto n = mesh.summary();
    const auto positions = mesh.positions();
    const auto faces = mesh.faces();
    Mesh copy;
    std::vector<Mesh::VertexHandle> vertices;
    for (std::size_t v = 0; v < n.n_vertices; v++)
        vertices.push_back(
            copy.add_vertex(Mesh::Point(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2])));
    for (std::size_t f = 0; f < n.n_faces; f++)
        copy.add_face(vertices[faces[3 * f]], vertices[faces[3 * f + 1]], vertices[faces[3 * f + 2]]);
    return copy;
}

} // namespace

int main(int argc, char **argv) {
    if (argc > 1) {
        Mesh mesh;
        if (!OpenMesh::IO::read_mesh(mesh, argv[1])) {
            std::fprintf(stderr, "OpenMesh cannot read %s\n", argv[1]);
            return 1;
        }
        check(argv[1], mesh);
        return 0;
    }
    auto shape = ricci::init<ricci_shape>();
    shape.shape = RICCI_SHAPE_TORUS, shape.a = 2, shape.b = 0.7, shape.n = 14, shape.m = 9;
    check("torus", from_arrays(shape));
    shape = ricci::init<ricci_shape>();
    shape.shape = RICCI_SHAPE_GENUS, shape.n = 2;
    for (shape.genus = 2; shape.genus < 5; shape.genus++) check("genus", from_arrays(shape));
    return 0;
}
