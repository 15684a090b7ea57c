// Golden vectors (tests/vectors/README.md): the C++ wrapper agrees with the numbers that all languages are
// held to. Usage: vectors FOLDER.
#include "cases.h"

#include <ricci/circles.hpp>
#include <ricci/harmonic.hpp>
#include <ricci/match.hpp>
#include <ricci/spline.hpp>
#include <ricci/structure.hpp>
#include <ricci/uniformize.hpp>

#include <algorithm>

namespace {

int n_cases = 0;

ricci::mesh mesh_of(const json *node) { return ricci::mesh(surface(node)); }

std::vector<double> doubles(const json *list) {
    const double *x = numbers(list);
    return std::vector<double>(x, x + list->n);
}

std::vector<std::uint32_t> naturals(const json *list) {
    const std::uint32_t *x = indices(list);
    return std::vector<std::uint32_t>(x, x + list->n);
}

void agrees(const json *node, const char *quantity, const std::vector<double> &ours) {
    ::agrees(node, quantity, ours.data(), ours.size());
}

// The metric that the options describe: that of the mesh, or a flow's.
ricci::metric solved(const ricci::mesh &mesh, const json *how) {
    ricci::metric start(mesh, scheme_of(need(how, "scheme")), space_of(need(how, "space")));
    if (member(how, "without_flow")) return start;
    auto options = ricci::init<ricci_flow_options>();
    options.flips = flips_of(how);
    const auto target = member(how, "cones") ? ricci::target::cones(naturals(need(how, "cones")),
                                                                    doubles(need(how, "curvatures")))
                                             : ricci::target::given(doubles(need(how, "target")));
    ricci::metric flat = ricci::flow(start, target, options);
    CHECK(flat.report().converged);
    return flat;
}

void metric_case(const json *node) {
    const json *geometry = member(need(node, "mesh"), "geometry");
    const ricci::metric start(mesh_of(need(node, "mesh")), scheme_of(need(need(node, "options"), "scheme")),
                              geometry ? space_of(geometry) : std::uint32_t(RICCI_SPACE_E2));
    agrees(node, "eta", start.values(RICCI_METRIC_ETA));
    agrees(node, "curvature", start.curvature());
}

void triangle_case(const json *node) {
    const json *how = need(node, "options");
    const ricci::metric start(ricci::mesh(triangle_surface(how)), std::uint32_t(RICCI_SCHEME_YAMABE),
                              space_of(need(how, "space")));
    triangle_agrees(node, start.curvature().data(), start.summary().area);
}

void flow_case(const json *node) {
    metric_case(node);
    const ricci::mesh mesh = mesh_of(need(node, "mesh"));
    const ricci::metric flat = solved(mesh, need(node, "options"));
    const std::vector<double> lengths = flat.lengths();
    std::vector<double> sides;
    for (const std::int32_t edge : mesh.face_edges())
        sides.push_back(lengths[static_cast<std::size_t>(std::abs(edge)) - 1]);
    agrees(node, "u", flat.values(RICCI_METRIC_U));
    agrees(node, "sides", sides);
}

void layout_case(const json *node) {
    const ricci::mesh mesh = mesh_of(need(node, "mesh"));
    const ricci::layout layout(solved(mesh, need(node, "options")));
    const std::vector<double> uv = layout.uv();
    layout_agrees(node, uv.data(), uv.size() / 6);
}

ricci::uniform uniform_of(const json *node) {
    const json *how = need(node, "options"), *corners = member(how, "corners"), *base = member(how, "base");
    auto options = ricci::init<ricci_uniform_options>();
    auto flow = ricci::init<ricci_flow_options>();
    flow.flips = flips_of(how);
    options.flow = &flow, options.scheme = scheme_of(need(how, "scheme"));
    if (corners) {
        options.boundary = RICCI_BOUNDARY_STRAIGHT;
        options.corners = indices(corners), options.n_corners = corners->n;
    }
    const auto at = static_cast<std::uint32_t>(base ? whole(base) : 0);
    if (base) options.base = &at;
    return ricci::uniform(mesh_of(need(node, "mesh")), options);
}

void uniform_case(const json *node) {
    const ricci::uniform uniform = uniform_of(node);
    const ricci_uniform_summary s = uniform.summary();
    CHECK(s.converged);
    agrees(node, "modulus", {s.modulus[0], s.modulus[1]});
    agrees(node, "area", {s.area});
    agrees(node, "extremal_distance", {s.extremal_distance});
    if (asks(node, "cross_ratios")) cross_ratios_agree(node, uniform.sphere_points().data());
}

void group_case(const json *node) {
    const ricci::uniform uniform = uniform_of(node);
    const ricci::dirichlet dirichlet = uniform.dirichlet();
    auto spec = ricci::init<ricci_deck_spec>();
    spec.kind = RICCI_DECK_WITHIN, spec.dirichlet = dirichlet.get(), spec.limit = 100000;
    spec.radius = number(need(need(node, "options"), "radius"));
    std::vector<double> traces = uniform.deck(spec).values(RICCI_DECK_TRACE);
    std::sort(traces.begin(), traces.end());
    agrees(node, "traces", traces);
}

void circles_case(const json *node) {
    const json *three = member(need(node, "options"), "three");
    auto options = ricci::init<ricci_circle_domain_options>();
    options.three = three ? indices(three) : nullptr;
    const ricci::circle_domain domain(mesh_of(need(node, "mesh")), options);
    CHECK(domain.summary().converged);
    std::vector<double> circles = domain.circles();
    circles_agree(node, circles.data(), circles.size() / 4);
    agrees(node, "modulus", {domain.summary().modulus[1]});
}

void harmonic_case(const json *node) {
    const json *how = need(node, "options");
    const ricci::mesh mesh = mesh_of(need(node, "mesh"));
    const std::vector<double> points =
        is(need(how, "to"), "values")
            ? ricci::harmonic(mesh, naturals(need(how, "vertices")), doubles(need(how, "values")))
            : ricci::harmonic(mesh);
    std::vector<double> radii;
    for (std::size_t v = 0; v < points.size(); v += 3) radii.push_back(std::hypot(points[v], points[v + 1]));
    agrees(node, "points", points);
    agrees(node, "radii", radii);
}

void forms_case(const json *node) {
    const ricci::forms forms(mesh_of(need(node, "mesh")));
    std::vector<double> values = forms.values(0);
    for (double &x : values) x = std::fabs(x);
    std::sort(values.begin(), values.end());
    agrees(node, "modulus", {forms.summary().modulus[0], forms.summary().modulus[1]});
    agrees(node, "absolute", values);
}

void structure_case(const json *node) {
    const json *how = need(node, "options"), *kind = need(how, "kind");
    auto options = ricci::init<ricci_structure_options>();
    auto flow = ricci::init<ricci_flow_options>();
    flow.flips = flips_of(how), options.flow = &flow;
    const ricci::structure structure(mesh_of(need(node, "mesh")), kind_of(kind), options);
    const ricci_structure_summary s = structure.summary();
    const auto faces = structure.rows(RICCI_CHART_FACES), corners = structure.rows(RICCI_CHART_CORNERS);
    std::vector<double> sides(3 * s.n_faces);
    for (std::size_t c = 0; c < s.n_charts; c++) {
        const std::vector<double> points = structure.coordinates(c);
        const std::vector<std::uint32_t> in = faces[c], at = corners[c];
        for (std::size_t i = 0; i < in.size(); i++) {
            double triangle[6], *shown = &sides[3 * in[i]];
            if (shown[0] > 0) continue;
            for (std::size_t k = 0; k < 6; k++) triangle[k] = points[2 * at[3 * i + k / 2] + k % 2];
            sides_of(model_of(kind), triangle, shown);
        }
    }
    double worst = 0;
    for (std::uint32_t f = 0; f < s.n_faces; f++) {
        const std::vector<ricci::place> places = structure.places(f, {{0.5, 0.25, 0.25}});
        for (const ricci::place &other : places) {
            const std::vector<double> moved = structure.carry(places[0], other, places[0].coordinates);
            for (std::size_t k = 0; k < 2; k++)
                worst = std::max(worst, std::fabs(moved[k] - other.coordinates[k]));
        }
    }
    agrees(node, "sides", sides);
    agrees(node, "carried", {worst});
}

void spline_case(const json *node) {
    const json *how = need(node, "options");
    auto spec = ricci::init<ricci_spline_spec>();
    spec.degree = static_cast<std::uint32_t>(whole(need(how, "degree")));
    spec.knots = numbers(need(how, "knots"));
    const ricci::spline flat(mesh_of(need(node, "mesh")), spec);
    const std::vector<std::uint32_t> controls = flat.controls();
    const std::vector<double> given = doubles(need(how, "control"));
    std::vector<double> points(3 * flat.summary().n_control_points);
    CHECK(given.size() == 3 * controls.size());
    for (std::size_t i = 0; i < given.size(); i++) points[3 * controls[i / 3] + i % 3] = given[i];
    const std::vector<double> values = flat.with_points(points).evaluate(
        naturals(need(how, "patches")), doubles(need(how, "places")), RICCI_SPLINE_SECOND);
    jets_agree(node, values.data(), values.size() / 18);
}

void fit_case(const json *node) {
    const json *how = need(node, "options");
    const ricci::spline flat(mesh_of(need(node, "mesh")),
                             static_cast<std::uint32_t>(whole(need(how, "degree"))));
    auto places = ricci::init<ricci_spline_places>();
    auto options = ricci::init<ricci_spline_fit_options>();
    places.parameters = numbers(need(how, "parameters")), places.n = need(how, "parameters")->n / 2;
    options.places = &places, options.fairness = -1;
    const ricci::spline fitted = flat.fitted(doubles(need(how, "points")), options);
    agrees(node, "point", fitted.evaluate(doubles(need(how, "places"))));
}

void surface_fit_case(const json *node) {
    const json *how = need(node, "options");
    auto options = ricci::init<ricci_spline_surface_options>();
    options.degree = static_cast<std::uint32_t>(whole(need(how, "degree")));
    options.control_points = whole(need(how, "control_points"));
    const ricci::metric flat = ricci::flow(ricci::metric(mesh_of(need(node, "mesh"))));
    const std::vector<double> points = ricci::spline::of_surface(flat, options).tessellated(3).positions();
    torus_agrees(node, points.data(), points.size() / 3);
}

void match_case(const json *node) {
    const json *how = need(node, "options"), *places = need(need(node, "target"), "positions");
    auto options = ricci::init<ricci_match_options>();
    options.landmarks = indices(need(how, "landmarks")), options.n_landmarks = need(how, "landmarks")->n / 2;
    if (is(member(how, "boundary"), "arc_length")) options.boundary = RICCI_MATCH_ARC_LENGTH;
    const ricci::mesh source = mesh_of(need(node, "mesh")), target = mesh_of(need(node, "target"));
    const ricci::matching matching(source, target, options);
    std::vector<double> images(3 * source.summary().n_vertices);
    ricci::check(ricci_matching_carry(matching.get(), RICCI_MATCH_FORWARD, numbers(places), places->n,
                                      images.data(), images.size()));
    agrees(node, "images", images);
}

const struct {
    const char *call;
    void (*run)(const json *);
} calls[] = {{"metric", metric_case},
             {"flow", flow_case},
             {"layout", layout_case},
             {"uniformize", uniform_case},
             {"group", group_case},
             {"circles", circles_case},
             {"harmonic", harmonic_case},
             {"forms", forms_case},
             {"structure", structure_case},
             {"spline", spline_case},
             {"fit", fit_case},
             {"surface_fit", surface_fit_case},
             {"match", match_case},
             {"triangle", triangle_case},
             // Formulas below the C face, which the Rust test calls: their seals alone are held here.
             {"circle_pattern", nullptr},
             {"derivative", nullptr}};

void run(const json *node) {
    const json *call = need(node, "call");
    for (const auto &known : calls)
        if (is(call, known.call)) {
            if (known.run) known.run(node), n_cases++;
            return;
        }
    fails(node, "no such call", 0, 0);
}

} // namespace

int main(int argc, char **argv) {
    CHECK(argc == 2);
    for_each_case(argv[1], run);
    std::printf("%d cases, %d numbers that do not agree\n", n_cases, n_failed);
    return n_failed > 0;
}
