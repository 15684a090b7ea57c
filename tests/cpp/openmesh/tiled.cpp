// A uniformized surface tiles its plane: OpenMesh loads, ricci uniformizes, and CGAL's exact predicates, in
// the Klein disk where geodesics are straight, find every face counterclockwise, and every point of a disk
// about the base in one triangle of one copy of the layout, and in one copy of the Dirichlet domain.
//
//   test_tiled [MESH]     without an argument: generated meshes
#include "measure.hpp"

#include <random>
#include <ricci/ricci.hpp>

namespace {

using Point = Exact::Point_2;
using Polygon = std::vector<Point>; // convex

// Ambient coordinates, n x 3, as points of the plane or of the Klein disk.
std::vector<Point> flat(std::vector<double> ambient, ricci_space space) {
    const std::size_t n = ambient.size() / 3, width = space == RICCI_SPACE_H2 ? 2 : 3;
    if (space == RICCI_SPACE_H2)
        OK(ricci_model_from_hyperboloid(RICCI_MODEL_KLEIN, ambient.data(), n, ambient.data(), 3 * n));
    std::vector<Point> points;
    for (std::size_t i = 0; i < n; i++) points.emplace_back(ambient[width * i], ambient[width * i + 1]);
    return points;
}

std::vector<double> moved(const ricci::deck &deck, std::size_t g, const std::vector<double> &points) {
    std::vector<double> image(points.size());
    OK(ricci_deck_apply(deck.get(), g, points.data(), points.size() / 3, image.data(), image.size()));
    return image;
}

bool contains(const Polygon &polygon, const Point &p) {
    for (std::size_t k = 0; k < polygon.size(); k++)
        if (CGAL::orientation(polygon[k], polygon[(k + 1) % polygon.size()], p) != CGAL::LEFT_TURN)
            return false;
    return true;
}

// Points spread over a disk about the origin of this radius.
std::vector<Point> samples(double radius, ricci_space space) {
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
    const auto mesh =
        ricci::make<ricci_mesh>(ricci_mesh_from_arrays_i32, input.points()->data(), sizeof(Mesh::Point),
                                input.n_vertices(), faces.data(), input.n_faces());
    const auto quotient = ricci::uniformize(mesh).second;
    CHECK(quotient != nullptr);
    const auto q = ricci::summary(ricci_quotient_summarise, quotient);
    CHECK(q.converged && q.n_flipped == 0);
    std::vector<double> points(3 * q.n_points);
    OK(ricci_quotient_points(quotient.get(), RICCI_MODEL_HYPERBOLOID, points.data(), points.size()));
    const auto corners = ricci::values(ricci_quotient_corners, quotient, 3 * q.n_faces);

    const auto domain = ricci::make<ricci_dirichlet>(ricci_dirichlet_new, quotient.get(), nullptr, nullptr);
    const auto d = ricci::summary(ricci_dirichlet_summarise, domain);
    const auto polygon = ricci::values(ricci_dirichlet_corners, domain, 3 * d.n_sides);
    // A copy that meets the disk has its centre in this one.
    const double radius = d.radius, reach = radius + std::max(d.radius, q.radius);
    const auto cover =
        ricci::make<ricci_deck>(ricci_cover_within, domain.get(), reach, std::size_t(100000), nullptr);
    const auto count = ricci::summary(ricci_deck_summarise, cover);

    const auto all = samples(radius, q.space);
    std::vector<std::size_t> triangles(all.size(), 0), polygons(all.size(), 0);
    for (std::size_t g = 0; g < count.n_elements; g++) {
        const auto layout = flat(moved(cover, g, points), q.space);
        const auto copy = flat(moved(cover, g, polygon), q.space);
        for (std::size_t i = 0; i < all.size(); i++) polygons[i] += contains(copy, all[i]);
        for (std::size_t f = 0; f < q.n_faces; f++) {
            const Polygon face = {layout[corners[3 * f]], layout[corners[3 * f + 1]],
                                  layout[corners[3 * f + 2]]};
            if (g == 0) CHECK(CGAL::orientation(face[0], face[1], face[2]) == CGAL::LEFT_TURN);
            for (std::size_t i = 0; i < all.size(); i++) triangles[i] += contains(face, all[i]);
        }
    }
    for (std::size_t i = 0; i < all.size(); i++) CHECK(triangles[i] == 1 && polygons[i] == 1);
    std::printf("%s: genus %zu, %zu copies of %zu faces and of %u sides cover %zu points once\n",
                name.c_str(), q.genus, count.n_elements, q.n_faces, unsigned(d.n_sides), all.size());
}

Mesh from_arrays(const ricci::mesh &mesh) {
    const auto n = ricci::summary(ricci_mesh_summarise, mesh);
    const auto positions = ricci::values(ricci_mesh_positions, mesh, 3 * n.n_vertices);
    const auto faces = ricci::values(ricci_mesh_faces, mesh, 3 * n.n_faces);
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
    check("torus", from_arrays(ricci::make<ricci_mesh>(ricci_shape_torus, 2.0, 0.7, 14, 9)));
    for (std::size_t genus = 2; genus < 5; genus++)
        check("genus", from_arrays(ricci::make<ricci_mesh>(ricci_shape_genus, genus, 2, 1.0)));
    return 0;
}
