// The file that ricci writes of a flow with edge flips is the given surface, cut into pieces: read by
// OpenMesh it has the same area, Euler characteristic and boundary loops, and the given vertices; in the
// plane CGAL calls its faces counterclockwise.
//
//   test_unrolled [MESH]     without an argument: generated meshes
#include "measure.hpp"

#include <fstream>
#include <ricci/ricci.hpp>
#include <sstream>

namespace {

Real area(const Mesh &mesh) {
    Real sum = 0;
    for (auto f : mesh.faces()) {
        std::vector<Kernel::Point_3> p;
        for (auto v : f.vertices()) {
            const auto x = mesh.point(v);
            p.emplace_back(x[0], x[1], x[2]);
        }
        sum += std::sqrt(CGAL::squared_area(p[0], p[1], p[2]));
    }
    return sum;
}

std::size_t loops(const Mesh &mesh) {
    std::size_t count = 0;
    std::vector<bool> seen(mesh.n_halfedges());
    for (auto start : mesh.halfedges()) {
        if (!mesh.is_boundary(start) || seen[start.idx()]) continue;
        count++;
        for (auto h = start; !seen[h.idx()]; h = h.next()) seen[h.idx()] = true;
    }
    return count;
}

long euler(const Mesh &mesh) { return long(mesh.n_vertices()) - long(mesh.n_edges()) + long(mesh.n_faces()); }

// Texture coordinates with all their digits; OpenMesh keeps single ones.
std::vector<std::array<Exact::Point_2, 3>> plane_of(const char *path) {
    std::ifstream file(path);
    std::vector<Exact::Point_2> points;
    std::vector<std::array<Exact::Point_2, 3>> faces;
    for (std::string line, word; std::getline(file, line);) {
        std::istringstream words(line);
        words >> word;
        if (word == "vt") {
            double x, y;
            words >> x >> y;
            points.emplace_back(x, y);
        } else if (word == "f") {
            std::array<Exact::Point_2, 3> face;
            for (auto &corner : face) {
                words >> word;
                corner = points.at(std::stoul(word.substr(word.find('/') + 1)) - 1);
            }
            faces.push_back(face);
        }
    }
    return faces;
}

void check(const std::string &name, const Mesh &input, uint32_t scheme) {
    const char *path = "unrolled.obj";
    std::vector<int> faces;
    for (auto f : input.faces())
        for (auto v : f.vertices()) faces.push_back(v.idx());
    const std::size_t n = input.n_vertices();
    std::vector<double> positions;
    for (auto v : input.vertices())
        positions.insert(positions.end(), input.point(v).data(), input.point(v).data() + 3);
    const ricci::metric start(ricci::mesh::from(positions, faces), scheme);
    const auto end = ricci::flow(start);
    CHECK(end.report().converged);
    const ricci::layout layout(end);
    const auto plane = layout.summary();
    const auto counts = ricci::map(end).summary();
    Mesh refined;
    layout.write(path); // on the caller's own faces, by default
    CHECK(OpenMesh::IO::read_mesh(refined, path));
    CHECK(refined.n_vertices() == n && refined.n_faces() == input.n_faces());
    layout.write(path, RICCI_ON_REFINEMENT);
    CHECK(OpenMesh::IO::read_mesh(refined, path));
    CHECK(refined.n_vertices() == plane.n_vertices && refined.n_faces() == plane.n_faces);
    CHECK(refined.n_edges() == plane.n_edges && plane.n_vertices == n + counts.n_crossings);
    CHECK(euler(refined) == euler(input) && loops(refined) == loops(input));
    // OpenMesh may read single precision.
    Real size = 0;
    for (auto v : input.vertices()) size = std::max(size, Real(input.point(v).max_abs()));
    for (auto v : input.vertices()) CHECK((refined.point(v) - input.point(v)).max_abs() <= 1e-6 * size);
    const Real whole = area(input), sum = area(refined);
    CHECK(std::abs(sum - whole) <= 1e-7L * whole);

    const auto corners = plane_of(path);
    CHECK(corners.size() == plane.n_faces);
    std::size_t turned = 0;
    Real flat = 0;
    for (const auto &p : corners) {
        turned += CGAL::orientation(p[0], p[1], p[2]) != CGAL::LEFT_TURN;
        flat += CGAL::area(p[0], p[1], p[2]);
    }
    CHECK(plane.n_flipped == 0 && turned <= plane.n_degenerate);
    CHECK(std::abs(flat - whole) <= 1e-7L * whole);
    const auto metric = end.summary();
    std::printf("%s, scheme %u: %zu + %zu vertices, %zu flips, %zu faces, %zu without area; area within "
                "%.1Le, in the plane %.1Le\n",
                name.c_str(), scheme, n, counts.n_crossings, metric.n_flips, plane.n_faces,
                plane.n_degenerate, std::abs(sum - whole) / whole, std::abs(flat - whole) / whole);
}

void check_generated(uint32_t scheme) {
    const double turn = 2 * std::acos(-1.0);
    check("torus",
          grid(30, 12, true, true,
               [&](int i, int j) {
                   const double b = turn * j / 12, a = turn * i / 30 - 0.1 * std::sin(b),
                                r = 2 + 0.8 * std::cos(b);
                   return Mesh::Point(r * std::cos(a), r * std::sin(a), 0.8 * std::sin(b));
               }),
          scheme);
    check("disk",
          grid(21, 21, false, false,
               [](int i, int j) {
                   const double x = i / 10.0 - 1, y = j / 10.0 - 1;
                   return Mesh::Point(x, 0.5 * y + 0.3 * x, std::exp(-4 * (x * x + y * y)));
               }),
          scheme);
    check("annulus",
          grid(24, 9, true, false,
               [&](int i, int j) {
                   const double a = turn * i / 24, r = 1 + 0.3 * std::sin(0.5 * j) + 0.2 * std::cos(2 * a);
                   return Mesh::Point(r * std::cos(a), r * std::sin(a), 0.4 * j);
               }),
          scheme);
}

} // namespace

int main(int argc, char **argv) {
    for (uint32_t scheme : {RICCI_SCHEME_YAMABE, RICCI_SCHEME_INVERSIVE}) {
        if (argc < 2) {
            check_generated(scheme);
            continue;
        }
        Mesh mesh;
        if (!OpenMesh::IO::read_mesh(mesh, argv[1])) {
            std::fprintf(stderr, "OpenMesh cannot read %s\n", argv[1]);
            return 1;
        }
        check(argv[1], mesh, scheme);
    }
    return 0;
}
