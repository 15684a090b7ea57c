// Files go from OpenMesh to ricci and back: each format that both know, with and without attributes, is the
// same mesh.
//
//   test_formats [MESH]     without an argument: generated meshes
#include "measure.hpp"

#include <utility>

namespace {

using OpenMesh::IO::Options;
using Triangles = std::vector<std::array<uint32_t, 3>>;

// The numbers of a mesh: lists are empty for attributes that it does not have.
struct Content {
    std::vector<std::array<double, 3>> positions, normals;
    std::vector<std::array<double, 4>> colors;
    std::vector<std::array<double, 2>> uv; // per corner of `faces`
    Triangles faces;
};

// A face begins with its smallest corner: OpenMesh does not keep where one begins. Texture coordinates turn
// with it.
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
            content.colors.push_back({c[0], c[1], c[2], c[3]});
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
    OK(ricci_mesh_values(mesh, RICCI_POSITIONS, content.positions.data()->data(), 3 * size.n_vertices));
    OK(ricci_mesh_faces(mesh, content.faces.data()->data(), 3 * size.n_faces));
    if (size.n_normals)
        OK(ricci_mesh_values(mesh, RICCI_NORMALS, content.normals.data()->data(), 3 * size.n_normals));
    if (size.n_colors)
        OK(ricci_mesh_values(mesh, RICCI_COLORS, content.colors.data()->data(), 4 * size.n_colors));
    if (size.n_uv) OK(ricci_mesh_values(mesh, RICCI_UV, content.uv.data()->data(), 6 * size.n_uv));
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

// Checks that a mesh equals the expected one within `off`, positions relative to the size of the mesh.
void compare(const std::string &what, Content expected, Content found, double off) {
    canonical(expected);
    canonical(found);
    const double moved = distance(expected.positions, found.positions) / extent(expected);
    const double normals = distance(expected.normals, found.normals);
    const double colors = distance(expected.colors, found.colors), uv = distance(expected.uv, found.uv);
    std::printf("  %-50s positions %.0e, normals %.0e, colours %.0e, texture %.0e\n", what.c_str(), moved,
                normals, colors, uv);
    CHECK(expected.faces == found.faces);
    CHECK(moved <= off);
    CHECK(normals <= off);
    CHECK(colors <= std::max(off, 1e-6)); // bytes, or six decimals
    CHECK(uv <= off);
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
    return again;
}

// OpenMesh hands positions and normals to its readers and writers in 32 bits, whatever the mesh has.
const double SINGLE = std::pow(2.0, -24);

struct Way {
    const char *name, *file;
    Options::Flag encoding;
    int digits;
};

const Options::Flag ASCII = Options::Default, MSB = Options::Flag(Options::Binary | Options::MSB);
const std::vector<Way> ways = {
    {"OBJ", "om.obj", ASCII, 17},
    {"OBJ of 6 digits", "om.obj", ASCII, 6},
    {"OFF", "om.off", ASCII, 17},
    {"OFF binary", "om.off", Options::Binary, 6},
    {"OFF binary big-endian", "om.off", MSB, 6},
    {"PLY", "om.ply", ASCII, 17},
    {"PLY binary", "om.ply", Options::Binary, 6},
    {"PLY binary big-endian", "om.ply", MSB, 6},
    {"STL", "om.stla", ASCII, 17},
    {"STL binary", "om.stlb", Options::Binary, 6},
};

const std::vector<std::pair<const char *, int>> attributes = {
    {"", 0},
    {" with normals", Options::VertexNormal},
    {" with texture", Options::VertexTexCoord},
    {" with colours", Options::VertexColor},
    {" with colours and opacity", Options::VertexColor | Options::ColorAlpha},
    {" with all", Options::VertexNormal | Options::VertexTexCoord | Options::VertexColor},
};

void from_openmesh(const Mesh &mesh) {
    for (const Way &way : ways)
        for (const auto &[suffix, flags] : attributes) {
            const std::string format = way.name, name = format + suffix;
            const bool stl = format.substr(0, 3) == "STL";
            if (stl && flags) continue;
            // OpenMesh writes no colours of vertices to OBJ, though it reads them.
            if (format.substr(0, 3) == "OBJ" && (flags & Options::VertexColor)) continue;
            Options options = way.encoding;
            options += Options::Flag(flags);
            CHECK(OpenMesh::IO::write_mesh(mesh, way.file, options, way.digits));
            ricci_mesh *read = nullptr;
            // OpenMesh tells ascii from binary by an ending that is nobody else's.
            const char *file = stl ? "om.stl" : way.file;
            if (stl) CHECK(std::rename(way.file, file) == 0);
            OK(ricci_mesh_read(file, &read));
            Content expected = content_of(mesh, options);
            if (stl) expected = numbered_by_faces(expected);
            const bool text = way.encoding == ASCII;
            compare(name, expected, content_of(read),
                    text ? std::max(SINGLE, 5 * std::pow(10, -way.digits)) : SINGLE);
            ricci_mesh_free(read);
        }
}

// Texture coordinates are those of vertices: OpenMesh ends a binary PLY file with an unexpected end where
// faces have a list beside their corners, for it does not skip what such a list holds.
void to_openmesh(const Mesh &mesh) {
    Content content =
        content_of(mesh, Options::VertexNormal | Options::VertexTexCoord | Options::VertexColor);
    ricci_mesh *handle = nullptr;
    OK(ricci_mesh_from_arrays(content.positions.data()->data(), 0, content.positions.size(),
                              content.faces.data()->data(), content.faces.size(), &handle));
    for (const char *file : {"ricci.obj", "ricci.off", "ricci.ply"})
        for (const auto &[suffix, flags] : attributes) {
            Options options = Options::Flag(flags);
            Content expected = content_of(mesh, options);
            ricci_attributes given;
            OK(ricci_init(&given, sizeof given));
            if (!expected.normals.empty()) given.normals = expected.normals.data()->data();
            if (!expected.colors.empty()) given.colors = expected.colors.data()->data();
            if (!expected.uv.empty()) given.uv = expected.uv.data()->data();
            OK(ricci_mesh_write(handle, &given, file));
            Mesh read;
            read.request_vertex_normals();
            read.request_vertex_colors();
            read.request_vertex_texcoords2D();
            Options found = options;
            CHECK(OpenMesh::IO::read_mesh(read, file, found));
            compare(std::string(file) + suffix, expected, content_of(read, found), SINGLE);
        }
    ricci_mesh_free(handle);
}

void check(const char *name, Mesh &mesh) {
    std::printf("%s: %zu vertices\n", name, mesh.n_vertices());
    mesh.request_face_normals();
    mesh.update_normals();
    for (auto v : mesh.vertices()) {
        const int i = v.idx();
        mesh.set_color(v, Mesh::Color(float(i % 256) / 255, 0.2f, float(i / 256 % 256) / 255, 1));
        mesh.set_texcoord2D(v, Mesh::TexCoord2D(float(i % 7) / 7, float(i % 3)));
    }
    from_openmesh(mesh);
    to_openmesh(mesh);
}

} // namespace

int main(int argc, char **argv) {
    Mesh mesh;
    mesh.request_vertex_normals();
    mesh.request_vertex_colors();
    mesh.request_vertex_texcoords2D();
    if (argc > 1) {
        CHECK(OpenMesh::IO::read_mesh(mesh, argv[1]));
        check(argv[1], mesh);
        return 0;
    }
    // A hill with coordinates of all 53 bits.
    const int n = 24;
    std::vector<Mesh::VertexHandle> at;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            const double x = i / 11.5 - 1, y = j / 11.5 - 1;
            at.push_back(mesh.add_vertex(Mesh::Point(x, y, 0.7 * std::exp(-3 * (x * x + y * y)))));
        }
    for (int i = 0; i + 1 < n; i++)
        for (int j = 0; j + 1 < n; j++) {
            const auto a = at[n * i + j], b = at[n * (i + 1) + j], c = at[n * (i + 1) + j + 1];
            mesh.add_face(a, b, c);
            mesh.add_face(a, c, at[n * i + j + 1]);
        }
    check("hill", mesh);
}
