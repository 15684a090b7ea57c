/* Golden vectors (tests/vectors/README.md): the results of the C face agree with the numbers that all
 * languages are held to. Usage: vectors FOLDER. */
#include "cases.h"
#include <ricci/circles.h>
#include <ricci/harmonic.h>
#include <ricci/match.h>
#include <ricci/spline.h>
#include <ricci/structure.h>
#include <ricci/uniformize.h>

static double *room_for(size_t n) { return (double *)keep(n, sizeof(double)); }

static ricci_mesh_summary counts(const ricci_mesh *mesh) {
    ricci_mesh_summary s;
    OK(ricci_mesh_summarise(mesh, &s, sizeof s));
    return s;
}

/* The metric that the options describe: that of the mesh, or a flow's. */
static ricci_metric *solved(const ricci_mesh *mesh, const json *how) {
    ricci_metric *start = NULL, *flat = NULL;
    ricci_report_summary report;
    OK(ricci_metric_new(mesh, scheme_of(need(how, "scheme")), space_of(need(how, "space")), &start));
    if (member(how, "without_flow")) return start;
    ricci_flow_options options;
    INIT(options);
    options.flips = flips_of(how);
    const json *cones = member(how, "cones"), *curvatures = need(how, cones ? "curvatures" : "target");
    const ricci_target target = target_of(cones ? RICCI_TARGET_CONES : RICCI_TARGET_GIVEN,
                                          cones ? indices(cones) : NULL, numbers(curvatures), curvatures->n);
    OK(ricci_flow(start, &target, &options, NULL, &flat));
    OK(ricci_report_summarise(flat, &report, sizeof report));
    CHECK(report.converged);
    ricci_metric_free(start);
    return flat;
}

static void metric_case(const json *node) {
    const json *given = need(node, "mesh"), *geometry = member(given, "geometry");
    ricci_mesh *mesh = surface(given);
    const ricci_mesh_summary n = counts(mesh);
    ricci_metric *metric = NULL;
    OK(ricci_metric_new(mesh, scheme_of(need(need(node, "options"), "scheme")),
                        geometry ? space_of(geometry) : RICCI_SPACE_E2, &metric));
    double *eta = room_for(n.n_edges), *curvature = room_for(n.n_vertices);
    OK(ricci_metric_values(metric, RICCI_METRIC_ETA, eta, n.n_edges));
    OK(ricci_metric_values(metric, RICCI_METRIC_CURVATURE, curvature, n.n_vertices));
    agrees(node, "eta", eta, n.n_edges);
    agrees(node, "curvature", curvature, n.n_vertices);
    ricci_metric_free(metric), ricci_mesh_free(mesh);
}

static void triangle_case(const json *node) {
    const json *how = need(node, "options");
    ricci_mesh *mesh = triangle_surface(how);
    ricci_metric *metric = NULL;
    ricci_metric_summary s;
    double curvature[3];
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, space_of(need(how, "space")), &metric));
    OK(ricci_metric_summarise(metric, &s, sizeof s));
    OK(ricci_metric_values(metric, RICCI_METRIC_CURVATURE, curvature, 3));
    triangle_agrees(node, curvature, s.area);
    ricci_metric_free(metric), ricci_mesh_free(mesh);
}

static void flow_case(const json *node) {
    metric_case(node);
    ricci_mesh *mesh = surface(need(node, "mesh"));
    const ricci_mesh_summary n = counts(mesh);
    ricci_metric *flat = solved(mesh, need(node, "options"));
    double *u = room_for(n.n_vertices), *lengths = room_for(n.n_edges), *sides = room_for(3 * n.n_faces);
    int32_t *edges = (int32_t *)keep(3 * n.n_faces, sizeof *edges);
    OK(ricci_metric_values(flat, RICCI_METRIC_U, u, n.n_vertices));
    OK(ricci_metric_values(flat, RICCI_METRIC_LENGTH, lengths, n.n_edges));
    OK(ricci_mesh_face_edges(mesh, edges, 3 * n.n_faces));
    for (size_t c = 0; c < 3 * n.n_faces; c++) sides[c] = lengths[abs(edges[c]) - 1];
    agrees(node, "u", u, n.n_vertices);
    agrees(node, "sides", sides, 3 * n.n_faces);
    ricci_metric_free(flat), ricci_mesh_free(mesh);
}

static void layout_case(const json *node) {
    ricci_mesh *mesh = surface(need(node, "mesh"));
    const size_t n = counts(mesh).n_faces;
    ricci_metric *flat = solved(mesh, need(node, "options"));
    ricci_layout *layout = NULL;
    double *uv = room_for(6 * n);
    OK(ricci_layout_new(flat, NULL, NULL, &layout));
    OK(ricci_layout_uv(layout, RICCI_ON_INPUT, uv, 6 * n));
    layout_agrees(node, uv, n);
    ricci_layout_free(layout), ricci_metric_free(flat), ricci_mesh_free(mesh);
}

/* The uniformization that the options describe. */
static ricci_uniform *uniform_of(const json *node, const ricci_mesh *mesh, ricci_uniform_summary *summary) {
    const json *how = need(node, "options"), *corners = member(how, "corners"), *base = member(how, "base");
    ricci_uniform_options options;
    ricci_flow_options flow;
    ricci_uniform *uniform = NULL;
    INIT(options);
    INIT(flow);
    flow.flips = flips_of(how);
    options.flow = &flow, options.scheme = scheme_of(need(how, "scheme"));
    if (corners)
        options.boundary = RICCI_BOUNDARY_STRAIGHT, options.corners = indices(corners),
        options.n_corners = corners->n;
    const uint32_t at = base ? (uint32_t)whole(base) : 0;
    if (base) options.base = &at;
    OK(ricci_uniformize(mesh, &options, NULL, &uniform));
    OK(ricci_uniform_summarise(uniform, summary, sizeof *summary));
    CHECK(summary->converged);
    return uniform;
}

static void uniform_case(const json *node) {
    ricci_mesh *mesh = surface(need(node, "mesh"));
    ricci_uniform_summary s;
    ricci_uniform *uniform = uniform_of(node, mesh, &s);
    agrees(node, "modulus", s.modulus, 2);
    agrees(node, "area", &s.area, 1);
    agrees(node, "extremal_distance", &s.extremal_distance, 1);
    if (asks(node, "cross_ratios")) {
        const size_t n = counts(mesh).n_vertices;
        double *points = room_for(3 * n);
        OK(ricci_sphere_points(uniform, RICCI_MODEL_AMBIENT, points, 3 * n));
        cross_ratios_agree(node, points);
    }
    ricci_uniform_free(uniform), ricci_mesh_free(mesh);
}

static void group_case(const json *node) {
    ricci_mesh *mesh = surface(need(node, "mesh"));
    ricci_uniform_summary s;
    ricci_uniform *uniform = uniform_of(node, mesh, &s);
    ricci_dirichlet *dirichlet = NULL;
    ricci_deck *deck = NULL;
    ricci_deck_spec spec;
    ricci_deck_summary n;
    INIT(spec);
    OK(ricci_dirichlet_new(uniform, NULL, NULL, &dirichlet));
    spec.kind = RICCI_DECK_WITHIN, spec.dirichlet = dirichlet, spec.limit = 100000;
    spec.radius = number(need(need(node, "options"), "radius"));
    OK(ricci_deck_new(uniform, &spec, NULL, &deck));
    OK(ricci_deck_summarise(deck, &n, sizeof n));
    double *traces = room_for(n.n_elements);
    OK(ricci_deck_values(deck, RICCI_DECK_TRACE, traces, n.n_elements));
    qsort(traces, n.n_elements, sizeof *traces, by_size);
    agrees(node, "traces", traces, n.n_elements);
    ricci_deck_free(deck), ricci_dirichlet_free(dirichlet), ricci_uniform_free(uniform),
        ricci_mesh_free(mesh);
}

static void circles_case(const json *node) {
    ricci_mesh *mesh = surface(need(node, "mesh"));
    ricci_circle_domain *domain = NULL;
    ricci_circle_domain_summary s;
    const json *three = member(need(node, "options"), "three");
    ricci_circle_domain_options options;
    INIT(options);
    options.three = three ? indices(three) : NULL;
    OK(ricci_circle_domain_new(mesh, &options, NULL, &domain));
    OK(ricci_circle_domain_summarise(domain, &s, sizeof s));
    CHECK(s.converged);
    agrees(node, "modulus", s.modulus + 1, 1);
    double *circles = room_for(4 * s.n_circles);
    OK(ricci_circle_domain_circles(domain, circles, 4 * s.n_circles));
    circles_agree(node, circles, s.n_circles);
    ricci_circle_domain_free(domain), ricci_mesh_free(mesh);
}

static void harmonic_case(const json *node) {
    const json *how = need(node, "options");
    ricci_mesh *mesh = surface(need(node, "mesh"));
    const size_t n = counts(mesh).n_vertices;
    ricci_harmonic_spec spec;
    double *points = room_for(3 * n), *radii = room_for(n);
    INIT(spec);
    spec.target = RICCI_HARMONIC_DISK;
    if (is(need(how, "to"), "values")) {
        spec.target = RICCI_HARMONIC_VALUES, spec.n = need(how, "vertices")->n;
        spec.vertices = indices(need(how, "vertices")), spec.values = numbers(need(how, "values"));
    }
    OK(ricci_harmonic(mesh, &spec, NULL, points, 3 * n));
    for (size_t v = 0; v < n; v++) radii[v] = hypot(points[3 * v], points[3 * v + 1]);
    agrees(node, "points", points, 3 * n);
    agrees(node, "radii", radii, n);
    ricci_mesh_free(mesh);
}

static void forms_case(const json *node) {
    ricci_mesh *mesh = surface(need(node, "mesh"));
    ricci_forms *forms = NULL;
    ricci_forms_summary s;
    OK(ricci_forms_new(mesh, NULL, NULL, &forms));
    OK(ricci_forms_summarise(forms, &s, sizeof s));
    double *values = room_for(s.n_edges);
    OK(ricci_forms_values(forms, 0, values, s.n_edges));
    for (size_t e = 0; e < s.n_edges; e++) values[e] = fabs(values[e]);
    qsort(values, s.n_edges, sizeof *values, by_size);
    agrees(node, "modulus", s.modulus, 2);
    agrees(node, "absolute", values, s.n_edges);
    ricci_forms_free(forms), ricci_mesh_free(mesh);
}

typedef struct {
    uint32_t *entries;
    size_t *starts;
} rows;

static rows rows_of(const ricci_structure *structure, uint32_t which, size_t n) {
    rows r;
    ricci_failure failure;
    r.starts = (size_t *)keep(n + 1, sizeof *r.starts);
    CHECK(ricci_structure_rows(structure, which, NULL, 0, r.starts, n + 1) == RICCI_BUFFER_TOO_SMALL);
    OK(ricci_last_failure(&failure, sizeof failure));
    r.entries = (uint32_t *)keep(failure.needed, sizeof *r.entries);
    OK(ricci_structure_rows(structure, which, r.entries, failure.needed, r.starts, n + 1));
    return r;
}

/* The largest distance between a point that is carried from the first chart of a face to another one, and its
 * place there. */
static double carried(const ricci_structure *structure, uint32_t face) {
    const double weights[3] = {0.5, 0.25, 0.25};
    double worst = 0, moved[2];
    size_t n = 0;
    OK(ricci_structure_places(structure, face, weights, NULL, NULL, 0, &n));
    uint32_t *lifts = (uint32_t *)keep(2 * n, sizeof *lifts);
    double *points = room_for(2 * n);
    OK(ricci_structure_places(structure, face, weights, lifts, points, n, &n));
    for (size_t i = 1; i < n; i++) {
        OK(ricci_structure_carry(structure, lifts, lifts + 2 * i, points, 1, moved, 2));
        worst = fmax(worst, fmax(fabs(moved[0] - points[2 * i]), fabs(moved[1] - points[2 * i + 1])));
    }
    return worst;
}

static void structure_case(const json *node) {
    const json *how = need(node, "options"), *kind = need(how, "kind");
    ricci_mesh *mesh = surface(need(node, "mesh"));
    ricci_structure *structure = NULL;
    ricci_structure_options options;
    ricci_structure_summary s;
    ricci_flow_options flow;
    INIT(options);
    INIT(flow);
    flow.flips = flips_of(how), options.flow = &flow;
    OK(ricci_structure_new(mesh, kind_of(kind), &options, NULL, &structure));
    OK(ricci_structure_summarise(structure, &s, sizeof s));
    const rows faces = rows_of(structure, RICCI_CHART_FACES, s.n_charts);
    const rows corners = rows_of(structure, RICCI_CHART_CORNERS, s.n_charts);
    const rows vertices = rows_of(structure, RICCI_CHART_VERTICES, s.n_charts);
    double *sides = room_for(3 * s.n_faces), worst = 0;
    for (size_t c = 0; c < s.n_charts; c++) {
        const size_t n = vertices.starts[c + 1] - vertices.starts[c];
        double *points = room_for(2 * n), triangle[6];
        OK(ricci_structure_coordinates(structure, c, points, 2 * n));
        for (size_t i = faces.starts[c]; i < faces.starts[c + 1]; i++) {
            const uint32_t f = faces.entries[i],
                           *at = corners.entries + corners.starts[c] + 3 * (i - faces.starts[c]);
            if (sides[3 * f] > 0) continue;
            for (int k = 0; k < 3; k++) memcpy(triangle + 2 * k, points + 2 * at[k], 2 * sizeof *points);
            sides_of(model_of(kind), triangle, sides + 3 * f);
        }
    }
    for (uint32_t f = 0; f < s.n_faces; f++) worst = fmax(worst, carried(structure, f));
    agrees(node, "sides", sides, 3 * s.n_faces);
    agrees(node, "carried", &worst, 1);
    ricci_structure_free(structure), ricci_mesh_free(mesh);
}

/* The flat spline of a case over its domain. */
static ricci_spline *flat_spline(const json *node, ricci_spline_summary *summary) {
    const json *how = need(node, "options"), *knots = member(how, "knots");
    ricci_mesh *domain = surface(need(node, "mesh"));
    ricci_spline_spec spec;
    ricci_spline *flat = NULL;
    INIT(spec);
    spec.degree = (uint32_t)whole(need(how, "degree")), spec.knots = knots ? numbers(knots) : NULL;
    OK(ricci_spline_new(domain, &spec, &flat));
    OK(ricci_spline_summarise(flat, summary, sizeof *summary));
    ricci_mesh_free(domain);
    return flat;
}

static ricci_spline_places places_of(const json *parameters) {
    ricci_spline_places places;
    INIT(places);
    places.parameters = numbers(parameters), places.n = parameters->n / 2;
    return places;
}

static void spline_case(const json *node) {
    const json *how = need(node, "options");
    ricci_spline_summary s;
    ricci_spline *flat = flat_spline(node, &s), *spline = NULL;
    const size_t n = s.n_basis * s.n_patches;
    const double *given = numbers(need(how, "control"));
    uint32_t *controls = (uint32_t *)keep(n, sizeof *controls);
    double *points = room_for(3 * s.n_control_points);
    CHECK(need(how, "control")->n == 3 * n);
    OK(ricci_spline_controls(flat, controls, n));
    for (size_t i = 0; i < n; i++) memcpy(points + 3 * controls[i], given + 3 * i, 3 * sizeof *points);
    OK(ricci_spline_with_points(flat, points, s.n_control_points, &spline));
    ricci_spline_places places = places_of(need(how, "places"));
    places.patches = indices(need(how, "patches"));
    double *values = room_for(18 * places.n);
    OK(ricci_spline_evaluate(spline, &places, RICCI_SPLINE_SECOND, NULL, values, 18 * places.n));
    jets_agree(node, values, places.n);
    ricci_spline_free(spline), ricci_spline_free(flat);
}

static void fit_case(const json *node) {
    const json *how = need(node, "options"), *points = need(how, "points");
    ricci_spline_summary s;
    ricci_spline *flat = flat_spline(node, &s), *fitted = NULL;
    ricci_spline_fit_options options;
    INIT(options);
    const ricci_spline_places under = places_of(need(how, "parameters")),
                              places = places_of(need(how, "places"));
    options.places = &under, options.fairness = -1;
    OK(ricci_spline_fit(flat, numbers(points), points->n / 3, &options, NULL, &fitted));
    double *values = room_for(3 * places.n);
    OK(ricci_spline_evaluate(fitted, &places, RICCI_SPLINE_POINT, NULL, values, 3 * places.n));
    agrees(node, "point", values, 3 * places.n);
    ricci_spline_free(fitted), ricci_spline_free(flat);
}

static void surface_fit_case(const json *node) {
    const json *how = need(node, "options");
    ricci_mesh *mesh = surface(need(node, "mesh")), *fine = NULL;
    ricci_metric *start = NULL, *flat = NULL;
    ricci_spline_surface_options options;
    ricci_spline *fitted = NULL;
    INIT(options);
    options.degree = (uint32_t)whole(need(how, "degree"));
    options.control_points = whole(need(how, "control_points"));
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &start));
    OK(ricci_flow(start, NULL, NULL, NULL, &flat));
    OK(ricci_spline_fit_surface(flat, &options, NULL, &fitted));
    OK(ricci_spline_tessellate(fitted, 3, NULL, &fine));
    const size_t n = counts(fine).n_vertices;
    double *points = room_for(3 * n);
    OK(ricci_mesh_values(fine, RICCI_POSITIONS, points, 3 * n));
    torus_agrees(node, points, n);
    ricci_mesh_free(fine), ricci_spline_free(fitted), ricci_metric_free(flat), ricci_metric_free(start);
    ricci_mesh_free(mesh);
}

static void match_case(const json *node) {
    const json *how = need(node, "options"), *given = need(node, "target"),
               *places = need(given, "positions");
    ricci_mesh *source = surface(need(node, "mesh")), *target = surface(given);
    ricci_match_options options;
    ricci_matching *matching = NULL;
    INIT(options);
    options.landmarks = indices(need(how, "landmarks")), options.n_landmarks = need(how, "landmarks")->n / 2;
    if (is(member(how, "boundary"), "arc_length")) options.boundary = RICCI_MATCH_ARC_LENGTH;
    const size_t n = counts(source).n_vertices;
    double *images = room_for(3 * n);
    OK(ricci_match(source, target, &options, NULL, &matching));
    OK(ricci_matching_carry(matching, RICCI_MATCH_FORWARD, numbers(places), places->n, images, 3 * n));
    agrees(node, "images", images, 3 * n);
    ricci_matching_free(matching), ricci_mesh_free(target), ricci_mesh_free(source);
}

static const struct {
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
             /* Formulas below the C face, which the Rust test calls: their seals alone are held here. */
             {"circle_pattern", NULL},
             {"derivative", NULL}};

static int n_cases;

static void run(const json *node) {
    const json *call = need(node, "call");
    for (size_t k = 0; k < sizeof calls / sizeof *calls; k++)
        if (is(call, calls[k].call)) {
            if (calls[k].run) calls[k].run(node), n_cases++;
            return;
        }
    fails(node, "no such call", 0, 0);
}

int main(int argc, char **argv) {
    CHECK(argc == 2);
    for_each_case(argv[1], run);
    printf("%d cases, %d numbers that do not agree\n", n_cases, n_failed);
    return n_failed > 0;
}
