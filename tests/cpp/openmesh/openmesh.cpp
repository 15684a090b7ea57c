// A mesh of OpenMesh goes to ricci without a copy. The results of ricci are then checked
// against OpenMesh (counts, loops), CGAL (angles, areas, exact orientation) and formulas in long double on
// the numbers that ricci returns: curvature before and after the flow, conformality, layout.
//
//   test_openmesh [MESH]     without an argument: generated meshes
#include "measure.hpp"

#include <complex>

namespace {

ricci_target given_target(const std::vector<double> &curvatures) {
    ricci_target target;
    OK(ricci_init(&target, sizeof target));
    target.kind = RICCI_TARGET_GIVEN, target.curvatures = curvatures.data(), target.n = curvatures.size();
    return target;
}

// Counts and loops are OpenMesh's.
Surface compare_topology(const Mesh &input, const ricci_mesh *mesh) {
    ricci_mesh_summary summary;
    OK(ricci_mesh_summarise(mesh, &summary, sizeof summary));
    CHECK(summary.n_vertices == input.n_vertices());
    CHECK(summary.n_edges == input.n_edges());
    CHECK(summary.n_faces == input.n_faces());
    const auto euler = long(input.n_vertices()) - long(input.n_edges()) + long(input.n_faces());
    CHECK(summary.euler == euler);

    std::size_t loops = 0, on_boundary = 0;
    std::vector<bool> seen(input.n_halfedges());
    for (auto start : input.halfedges()) {
        if (!input.is_boundary(start) || seen[start.idx()]) continue;
        loops++;
        for (auto h = start; !seen[h.idx()]; h = h.next()) seen[h.idx()] = true, on_boundary++;
    }
    CHECK(summary.n_boundary_loops == loops);
    CHECK(summary.n_boundary_vertices == on_boundary);
    CHECK(long(2 - 2 * summary.genus - loops) == euler);

    // Each loop runs with the surface on its left: along OpenMesh half-edges that have a face.
    std::vector<uint32_t> vertices(on_boundary);
    std::vector<std::size_t> starts(loops + 1);
    OK(ricci_mesh_boundary(mesh, vertices.data(), vertices.size(), starts.data(), starts.size()));
    for (std::size_t i = 0; i < loops; i++)
        for (std::size_t k = starts[i]; k < starts[i + 1]; k++) {
            const auto next = k + 1 < starts[i + 1] ? k + 1 : starts[i];
            const auto h = input.find_halfedge(Mesh::VertexHandle(int(vertices[k])),
                                               Mesh::VertexHandle(int(vertices[next])));
            CHECK(h.is_valid() && !input.is_boundary(h));
            CHECK(input.is_boundary(input.opposite_halfedge_handle(h)));
        }

    Surface surface{summary.n_vertices, summary.n_edges, summary.n_faces, {}, {}, {}};
    surface.faces.resize(summary.n_faces);
    surface.face_edges.resize(summary.n_faces);
    OK(ricci_mesh_faces(mesh, reinterpret_cast<uint32_t *>(surface.faces.data()), 3 * summary.n_faces));
    OK(ricci_mesh_face_edges(mesh, surface.face_edges.data()->data(), 3 * summary.n_faces));
    for (auto v : input.vertices()) surface.boundary.push_back(input.is_boundary(v));
    return surface;
}

// Corner angles from ricci's lengths are CGAL's from the positions; so is curvature.
void compare_angles(const Mesh &input, const ricci_mesh *mesh, const Surface &surface) {
    std::vector<double> lengths(surface.n_edges), curvature(surface.n_vertices);
    OK(ricci_mesh_values(mesh, RICCI_LENGTHS, lengths.data(), lengths.size()));
    std::vector<Real> expected(surface.n_vertices, 2 * pi), rounding(surface.n_vertices, 0);
    for (std::size_t v = 0; v < surface.n_vertices; v++)
        if (surface.boundary[v]) expected[v] = pi;
    Real worst = 0;
    for (std::size_t f = 0; f < surface.n_faces; f++) {
        const auto l = surface.sides(lengths, f);
        for (int k = 0; k < 3; k++) {
            const auto at = [&](int i) { return input.point(Mesh::VertexHandle(surface.faces[f][i % 3])); };
            const Real exact = cgal_angle(at(k), at(k + 1), at(k + 2));
            const Angle ours = angle(l[(k + 1) % 3], l[(k + 2) % 3], l[k], RICCI_SPACE_E2);
            CHECK(std::abs(ours.value - exact) <= ours.rounding);
            worst = std::max(worst, std::abs(ours.value - exact));
            expected[surface.faces[f][k]] -= exact;
            rounding[surface.faces[f][k]] += ours.rounding;
        }
    }
    ricci_metric *metric = nullptr;
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(ricci_metric_values(metric, RICCI_METRIC_CURVATURE, curvature.data(), curvature.size()));
    ricci_metric_free(metric);
    Real off = 0;
    for (std::size_t v = 0; v < surface.n_vertices; v++) {
        CHECK(std::abs(curvature[v] - expected[v]) <= 2 * rounding[v]);
        off = std::max(off, std::abs(curvature[v] - expected[v]));
    }
    std::printf("  angles within %.1Le, curvature within %.1Le of CGAL's\n", worst, off);
}

// In E2 a vertex scaling multiplies each length by exp((f_i + f_j) / 2).
void check_conformality(const ricci_mesh *mesh, const ricci_metric *end, const Surface &surface) {
    std::vector<double> before(surface.n_edges), after(surface.n_edges), factor(surface.n_vertices);
    OK(ricci_mesh_values(mesh, RICCI_LENGTHS, before.data(), before.size()));
    OK(ricci_metric_values(end, RICCI_METRIC_LENGTH, after.data(), after.size()));
    OK(ricci_metric_values(end, RICCI_METRIC_FACTOR, factor.data(), factor.size()));
    for (std::size_t f = 0; f < surface.n_faces; f++)
        for (int k = 0; k < 3; k++) {
            const auto e = std::abs(surface.face_edges[f][k]) - 1;
            const Real i = factor[surface.faces[f][(k + 1) % 3]], j = factor[surface.faces[f][(k + 2) % 3]];
            const Real off = 2 * std::log(Real(after[e]) / before[e]) - i - j;
            CHECK(std::abs(off) <= 8 * epsilon * (1 + std::abs(i) + std::abs(j)));
        }
}

// The layout has the metric's lengths up to one factor, the input's area, and no triangle that CGAL calls
// clockwise.
void check_layout(const Mesh &input, const ricci_metric *end, const Surface &surface) {
    ricci_layout *layout = nullptr;
    ricci_layout_summary summary;
    std::vector<double> uv(6 * surface.n_faces), lengths(surface.n_edges), qc(surface.n_faces);
    OK(ricci_layout_new(end, nullptr, nullptr, &layout));
    OK(ricci_layout_summarise(layout, &summary, sizeof summary));
    OK(ricci_layout_uv(layout, RICCI_ON_REFINEMENT, uv.data(), uv.size()));
    std::vector<double> ratio(surface.n_faces), input_uv(uv.size());
    std::vector<double> input_qc(qc), input_ratio(qc);
    OK(ricci_layout_distortion(layout, RICCI_ON_REFINEMENT, qc.data(), ratio.data(), qc.size()));
    OK(ricci_layout_distortion(layout, RICCI_ON_INPUT, input_qc.data(), input_ratio.data(), qc.size()));
    OK(ricci_layout_uv(layout, RICCI_ON_INPUT, input_uv.data(), input_uv.size()));
    CHECK(input_uv == uv && input_qc == qc && input_ratio == ratio); // no edge was flipped
    OK(ricci_metric_values(end, RICCI_METRIC_LENGTH, lengths.data(), lengths.size()));
    const auto point = [&](std::size_t f, int k) {
        return Exact::Point_2(uv[6 * f + 2 * (k % 3)], uv[6 * f + 2 * (k % 3) + 1]);
    };
    std::size_t flipped = 0;
    Real area = 0, input_area = 0, metric_area = 0;
    for (std::size_t f = 0; f < surface.n_faces; f++) {
        flipped += CGAL::orientation(point(f, 0), point(f, 1), point(f, 2)) != CGAL::LEFT_TURN;
        area += CGAL::area(point(f, 0), point(f, 1), point(f, 2));
        const auto l = surface.sides(lengths, f);
        metric_area += l[0] * l[1] * std::sin(angle(l[0], l[1], l[2], RICCI_SPACE_E2).value) / 2;
        const auto corner = [&](int k) {
            const auto p = input.point(Mesh::VertexHandle(surface.faces[f][k]));
            return Kernel::Point_3(p[0], p[1], p[2]);
        };
        input_area += std::sqrt(CGAL::squared_area(corner(0), corner(1), corner(2)));
        CHECK(qc[f] >= 1 && qc[f] <= summary.qc_max);
    }
    CHECK(summary.n_flipped == flipped && flipped == 0);
    CHECK(std::abs(area - input_area) <= 1e-8L * input_area);
    const Real scale = std::sqrt(input_area / metric_area);
    Real worst = 0;
    for (std::size_t f = 0; f < surface.n_faces; f++)
        for (int k = 0; k < 3; k++) {
            const auto p = point(f, k + 1), q = point(f, k + 2);
            const Real expected = scale * lengths[std::abs(surface.face_edges[f][k]) - 1];
            worst = std::max(worst, std::abs(std::sqrt(Real(CGAL::squared_distance(p, q))) - expected));
        }
    CHECK(summary.consistency <= 1e-7);
    CHECK(worst <= 2 * (summary.consistency + 1e-13L) * summary.diameter);

    // A seam's motion z -> e^(i rotation) z + t carries its left side onto its right: each edge of it, looked
    // up in the two faces that have it.
    std::vector<double> seams(9 * summary.n_seams);
    std::vector<int32_t> edges(summary.n_seam_edges);
    std::vector<std::size_t> starts(summary.n_seams + 1);
    OK(ricci_layout_seams(layout, seams.data(), seams.size()));
    OK(ricci_layout_seam_edges(layout, RICCI_ON_REFINEMENT, edges.data(), edges.size(), starts.data(),
                               starts.size()));
    std::vector<std::size_t> side(2 * surface.n_edges); // face and opposite corner of +e and of -e
    for (std::size_t f = 0; f < surface.n_faces; f++)
        for (int k = 0; k < 3; k++) {
            const auto e = surface.face_edges[f][k];
            side[2 * (std::abs(e) - 1) + (e < 0)] = 3 * f + k;
        }
    using Complex = std::complex<Real>;
    const auto corner = [&](std::size_t at, int k) {
        const auto p = point(at / 3, int(at % 3) + k);
        return Complex(p.x(), p.y());
    };
    for (std::size_t i = 0; i < summary.n_seams; i++) {
        const Complex turn(seams[9 * i], seams[9 * i + 1]), t(seams[9 * i + 2], seams[9 * i + 3]);
        for (auto k = starts[i]; k < starts[i + 1]; k++) {
            const auto e = edges[k];
            const auto left = side[2 * (std::abs(e) - 1) + (e < 0)],
                       right = side[2 * (std::abs(e) - 1) + (e > 0)];
            const Real tail = std::abs(turn * corner(left, 1) + t - corner(right, 2));
            const Real tip = std::abs(turn * corner(left, 2) + t - corner(right, 1));
            CHECK(std::max(tail, tip) <= (seams[9 * i + 8] + 1e-13L) * summary.diameter);
        }
        CHECK(seams[9 * i + 8] <= 1e-7);
    }
    std::printf("  layout: %zu seams, lengths within %.1Le of the metric's (of %.3g)\n", summary.n_seams,
                worst, summary.diameter);
    ricci_layout_free(layout);
}

// The flow, and its residual recomputed here from the lengths that it returns.
bool check_flow(const Mesh &input, const ricci_mesh *mesh, const Surface &surface, uint32_t scheme,
                uint32_t space) {
    ricci_metric *metric = nullptr, *end = nullptr;
    ricci_report_summary done;
    ricci_flow_options options; // the faces stay the kernel's; refined.cpp has flips
    OK(ricci_init(&options, sizeof options));
    options.flips = RICCI_FLIPS_NEVER;
    std::vector<double> target(surface.n_vertices), lengths(surface.n_edges), curvature(surface.n_vertices);
    OK(ricci_metric_new(mesh, scheme, space, &metric));
    // Where no values at vertices prescribe the default target, boundaries bend by their length.
    ricci_target boundary;
    OK(ricci_init(&boundary, sizeof boundary));
    boundary.kind = RICCI_TARGET_BOUNDARY;
    const auto filled = ricci_target_fill(metric, nullptr, nullptr, target.data(), target.size());
    if (filled == RICCI_TARGET_KIND)
        OK(ricci_target_fill(metric, &boundary, nullptr, target.data(), target.size()));
    else
        OK(filled);
    const ricci_target given = given_target(target);
    OK(ricci_flow(metric, &given, &options, nullptr, &end));
    OK(ricci_report_summarise(end, &done, sizeof done));
    OK(ricci_metric_values(end, RICCI_METRIC_LENGTH, lengths.data(), lengths.size()));
    OK(ricci_metric_values(end, RICCI_METRIC_CURVATURE, curvature.data(), curvature.size()));
    std::printf("  scheme %u, space %u: %s, %zu iterations, max |K - target| = %.1e", scheme, space,
                done.stop_reason_text, done.iterations, done.max_curvature_error);

    std::size_t broken = 0;
    for (std::size_t f = 0; f < surface.n_faces; f++) {
        const auto l = surface.sides(lengths, f);
        const Real perimeter = l[0] + l[1] + l[2];
        broken += 2 * *std::max_element(l.begin(), l.end()) >= perimeter;
    }
    CHECK((broken == 0) == (done.broken_triangles == 0));
    if (broken == 0) {
        std::vector<Real> recomputed, rounding;
        surface.curvature(lengths, space, recomputed, rounding);
        Real residual = 0;
        for (std::size_t v = 0; v < surface.n_vertices; v++) {
            const Real off = std::abs(recomputed[v] - target[v]);
            CHECK(off <= done.max_curvature_error + rounding[v]);
            CHECK(std::abs(recomputed[v] - curvature[v]) <= 2 * rounding[v]);
            residual = std::max(residual, off);
        }
        std::printf(", recomputed %.1Le", residual);
        CHECK(done.gauss_bonnet <= 1e-10);
    }
    std::printf("\n");
    CHECK(!done.converged || (broken == 0 && done.max_curvature_error <= done.tolerance));
    CHECK(done.converged || done.stop_reason != RICCI_STOP_CONVERGED);
    if (done.converged && space == RICCI_SPACE_E2) {
        if (scheme == RICCI_SCHEME_YAMABE) check_conformality(mesh, end, surface);
        check_layout(input, end, surface);
    }
    ricci_metric_free(end);
    ricci_metric_free(metric);
    return done.converged;
}

// Returns how many of the schemes reached the target.
int check(const std::string &name, const Mesh &input) {
    std::printf("%s: %zu vertices\n", name.c_str(), input.n_vertices());
    std::vector<std::array<int, 3>> faces;
    for (auto f : input.faces()) {
        std::array<int, 3> corners;
        int k = 0;
        for (auto v : f.vertices()) corners[k++] = v.idx();
        faces.push_back(corners);
    }
    ricci_mesh *mesh = nullptr;
    OK(ricci_mesh_from_arrays(input.points()->data(), sizeof(Mesh::Point), input.n_vertices(),
                              reinterpret_cast<const uint32_t *>(faces.data()), faces.size(), &mesh));
    const Surface surface = compare_topology(input, mesh);
    CHECK(std::equal(faces.begin(), faces.end(), surface.faces.begin()));
    compare_angles(input, mesh, surface);
    const long euler = long(surface.n_vertices) - long(surface.n_edges) + long(surface.n_faces);
    const auto &boundary = surface.boundary;
    const bool closed = std::find(boundary.begin(), boundary.end(), true) == boundary.end();
    const uint32_t space = closed && euler < 0 ? RICCI_SPACE_H2 : RICCI_SPACE_E2;
    int reached = 0;
    for (uint32_t scheme : {RICCI_SCHEME_YAMABE, RICCI_SCHEME_INVERSIVE, RICCI_SCHEME_TANGENTIAL})
        reached += check_flow(input, mesh, surface, scheme, space);
    ricci_mesh_free(mesh);
    return reached;
}

int check_generated() {
    const double turn = 2 * std::acos(-1.0);
    const auto torus = [&](int i, int j) {
        const double a = turn * i / 48, b = turn * j / 20, r = 2 + 0.6 * std::cos(b) + 0.1 * std::sin(3 * a);
        return Mesh::Point(r * std::cos(a), r * std::sin(a), 0.6 * std::sin(b));
    };
    const auto bump = [](int i, int j) {
        const double x = i / 15.0 - 1, y = j / 15.0 - 1;
        return Mesh::Point(x, y, 0.7 * std::exp(-3 * (x * x + y * y)));
    };
    const auto tube = [&](int i, int j) {
        const double a = turn * i / 32, r = 1 + 0.3 * std::sin(0.5 * j) + 0.1 * std::cos(2 * a);
        return Mesh::Point(r * std::cos(a), r * std::sin(a), 0.25 * j);
    };
    int failed = 0;
    failed += check("torus", grid(48, 20, true, true, torus)) != 3;
    failed += check("disk", grid(31, 31, false, false, bump)) != 3;
    failed += check("annulus", grid(32, 13, true, false, tube)) != 3;
    return failed;
}

} // namespace

int main(int argc, char **argv) {
    if (argc < 2) return check_generated() == 0 ? 0 : 1;
    Mesh mesh;
    if (!OpenMesh::IO::read_mesh(mesh, argv[1])) {
        std::fprintf(stderr, "OpenMesh cannot read %s\n", argv[1]);
        return 1;
    }
    return check(argv[1], mesh) > 0 ? 0 : 1;
}
