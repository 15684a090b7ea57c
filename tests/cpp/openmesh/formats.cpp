// Files go from OpenMesh to ricci and back: each format that both know, with and without attributes, is the same mesh.
//
//   test_formats [MESH]     without an argument: generated meshes
#include "measure.hpp"

#include <utility>

namespace {

using OpenMesh::IO::Options;
using Triangles = std::vector<std::array<uint32_t, 3>>;

// What a mesh is in numbers: empty lists for attributes that it does not have.
struct Content {
    std::vector<std::array<double, 3>> positions, normals;
    std::vector<std::array<double, 4>> colors;
    std::vector<std::array<double, 2>> uv; // per corner of `faces`
    Triangles faces;
};

// A face begins with its smallest corner: OpenMesh does not keep where one begins. Texture coordinates turn with it.
void canonical(Content &content) {
    for (std::size_t f = 0; f < content.faces.size(); f++) {
        auto &face = content.faces[f];
        const auto turn = std::min_element(face.begin(), face.end()) - face.begin();
        std::rotate(face.begin(), face.begin() + turn, face.end());
        if (!content.uv.empty()) {
            const auto uv = content.uv.begin() + 3 * long(f);
            std::rotate(uv, uv + turn, uv + 3);
        }
    }
}

Content content_of(const Mesh &mesh, const Options &has) {
    Content content;
    for (auto v : mesh.vertices()) {
        const auto p = mesh.point(v);
        content.positions.push_back({p[0], p[1], p[2]});
        if (has.vertex_has_normal()) {
            const auto n = mesh.normal(v);
            content.normals.push_back({n[0], n[1], n[2]});
        }
        if (has.vertex_has_color()) {
            const auto c = mesh.color(v);
            content.colors.push_back({c[0] / 255.0, c[1] / 255.0, c[2] / 255.0, 1});
        }
    }
    for (auto f : mesh.faces()) {
        std::array<uint32_t, 3> face;
        int k = 0;
        for (auto v : mesh.fv_range(f)) {
            face[k++] = uint32_t(v.idx());
            if (has.vertex_has_texcoord()) {
                const auto t = mesh.texcoord2D(v);
                content.uv.push_back({t[0], t[1]});
            }
        }
        content.faces.push_back(face);
    }
    canonical(content);
    return content;
}

Content content_of(const ricci_mesh *mesh) {
    ricci_mesh_summary size;
    OK(ricci_mesh_summarise(mesh, &size, sizeof size));
    Content content;
    content.positions.resize(size.n_vertices);
    content.normals.resize(size.n_normals);
    content.colors.resize(size.n_colors);
    content.uv.resize(3 * size.n_uv);
    content.faces.resize(size.n_faces);
    OK(ricci_mesh_positions(mesh, content.positions.data()->data(), 3 * size.n_vertices));
    OK(ricci_mesh_faces(mesh, content.faces.data()->data(), 3 * size.n_faces));
    if (size.n_normals) OK(ricci_mesh_normals(mesh, content.normals.data()->data(), 3 * size.n_normals));
    if (size.n_colors) OK(ricci_mesh_colors(mesh, content.colors.data()->data(), 4 * size.n_colors));
    if (size.n_uv) OK(ricci_mesh_uv(mesh, content.uv.data()->data(), 6 * size.n_uv));
    canonical(content);
    return content;
}

// The largest difference, or infinity where one list is longer.
template <std::size_t N>
double distance(const std::vector<std::array<double, N>> &a, const std::vector<std::array<double, N>> &b) {
    if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
    double most = 0;
    for (std::size_t i = 0; i < a.size(); i++)
        for (std::size_t k = 0; k < N; k++) most = std::max(most, std::abs(a[i][k] - b[i][k]));
    return most;
}

double extent(const Content &content) {
    double most = 0;
    for (const auto &p : content.positions)
        for (double x : p) most = std::max(most, std::abs(x));
    return most;
}

void compare(const char *what, const Content &expected, const Content &found, double positions, double others) {
    const double moved = distance(expected.positions, found.positions) / extent(expected);
    const double normals = distance(expected.normals, found.normals);
    const double colors = distance(expected.colors, found.colors), uv = distance(expected.uv, found.uv);
    std::printf("  %-44s positions %.0e, normals %.0e, colours %.0e, texture %.0e\n", what, moved, normals, colors,
                uv);
    CHECK(expected.faces == found.faces);
    CHECK(moved <= positions);
    CHECK(normals <= others);
    CHECK(colors <= 1 / 509.0);
    CHECK(uv <= others);
}

// STL has no vertices: ours are numbered in the order in which the faces name them.
Content numbered_by_faces(Content content) {
    std::vector<uint32_t> number(content.positions.size(), ~0u);
    Content again;
    for (auto face : content.faces) {
        for (auto &v : face) {
            if (number[v] == ~0u) {
                number[v] = uint32_t(again.positions.size());
                again.positions.push_back(content.positions[v]);
            }
            v = number[v];
        }
        again.faces.push_back(face);
    }
    canonical(again);
    return again;
}

struct Way {
    const char *name, *file;
    Options::Flag encoding;
    int digits; // of a decimal number; 0: 32 bits
};

const Options::Flag ASCII = Options::Default;
const std::vector<Way> ways = {
    {"OBJ", "om.obj", ASCII, 17},
    {"OBJ, 6 digits", "om.obj", ASCII, 6},
    {"OFF", "om.off", ASCII, 17},
    {"OFF binary", "om.off", Options::Binary, 0},
    {"PLY", "om.ply", ASCII, 17},
    {"PLY little-endian", "om.ply", Options::Flag(Options::Binary | Options::LSB), 0},
    {"PLY big-endian", "om.ply", Options::Flag(Options::Binary | Options::MSB), 0},
    {"STL", "om.stla", ASCII, 17},
    {"STL binary", "om.stlb", Options::Binary, 0},
};

void check(const char *name, Mesh &mesh) {
    std::printf("%s: %zu vertices\n", name, mesh.n_vertices());
    for (const Way &way : ways)
        for (int attributes = 0; attributes < 2; attributes++) {
            Options options = way.encoding;
            const bool stl = std::string(way.name).substr(0, 3) == "STL";
            if (attributes && stl) continue;
            if (attributes) options += Options::VertexNormal | Options::VertexColor | Options::VertexTexCoord;
            CHECK(OpenMesh::IO::write_mesh(mesh, way.file, options, way.digits ? way.digits : 6));
            ricci_mesh *read = nullptr;
            OK(stl ? ricci_mesh_read_stl(way.file, 0, &read) : ricci_mesh_read(way.file, &read));
            Content expected = content_of(mesh, options);
            if (stl) expected = numbered_by_faces(expected);
            compare(way.name, expected, content_of(read), 1e-6, 1e-6);
            ricci_mesh_free(read);
        }
}

} // namespace

int main(int argc, char **argv) {
    Mesh mesh;
    mesh.request_vertex_normals();
    mesh.request_vertex_colors();
    mesh.request_vertex_texcoords2D();
    mesh.request_face_normals();
    CHECK(argc > 1 && OpenMesh::IO::read_mesh(mesh, argv[1]));
    mesh.update_normals();
    for (auto v : mesh.vertices()) {
        mesh.set_color(v, Mesh::Color((unsigned char)(v.idx() % 256), 17, (unsigned char)(v.idx() / 256 % 256)));
        mesh.set_texcoord2D(v, Mesh::TexCoord2D(float(v.idx()) / 7, float(v.idx() % 3)));
    }
    check(argv[1], mesh);
}
