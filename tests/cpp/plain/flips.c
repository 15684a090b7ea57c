/* Flows with edge flips: the triangulation that a metric comes to live on, edges and vertices that are held,
 * several flows in a row. */
#include "arrays.h"
#include "samples.h"

/* The triangulation that a metric lives on, with curvature computed anew from its lengths. */
static void check_triangulation(const arrays *given, const ricci_metric *metric, const double *target,
                                uint32_t space, double tolerance) {
    ricci_mesh *mesh = NULL;
    ricci_metric_summary m;
    OK(ricci_metric_mesh(metric, &mesh));
    OK(ricci_metric_summarise(metric, &m, sizeof m));
    arrays a = arrays_of(mesh, 0);
    const size_t n = m.n_mesh_vertices, given_n = given->n.n_vertices;
    CHECK(m.n_vertices == given_n && a.n.n_vertices == n && a.n.n_edges == m.n_edges &&
          a.n.n_faces == m.n_faces);
    CHECK(m.doubled == (given->n.n_boundary_loops > 0) && a.n.n_boundary_loops == 0);
    CHECK(n == (m.doubled ? 2 * given_n - given->n.n_boundary_vertices : given_n));
    CHECK(a.n.euler == (m.doubled ? 2 : 1) * given->n.euler);

    uint32_t *mirror = (uint32_t *)room(n, sizeof *mirror);
    double *u = (double *)room(n, sizeof *u), *given_u = (double *)room(n, sizeof *u);
    double *curvature = (double *)room(n, sizeof *curvature), *said = (double *)room(n, sizeof *said);
    double *eta = (double *)room(m.n_edges, sizeof *eta),
           *lengths = (double *)room(m.n_edges, sizeof *lengths);
    size_t images = 0;
    OK(ricci_metric_mirror(metric, mirror, n));
    OK(ricci_metric_values(metric, RICCI_METRIC_MESH_U, u, n));
    OK(ricci_metric_values(metric, RICCI_METRIC_U, given_u, given_n));
    OK(ricci_metric_values(metric, RICCI_METRIC_CURVATURE, said, given_n));
    OK(ricci_metric_values(metric, RICCI_METRIC_ETA, eta, m.n_edges));
    OK(ricci_metric_values(metric, RICCI_METRIC_LENGTH, lengths, m.n_edges));
    CHECK(memcmp(u, given_u, given_n * sizeof *u) == 0);
    CHECK(memcmp(lengths, a.lengths, m.n_edges * sizeof *lengths) == 0);
    for (size_t v = 0; v < n; v++) {
        CHECK(mirror[mirror[v]] == v && fabs(u[v] - u[mirror[v]]) < 1e-8);
        images += v < given_n && mirror[v] == v;
        curvature[v] = 2 * pi;
    }
    CHECK(images == (m.doubled ? given->n.n_boundary_vertices : given_n));
    for (size_t e = 0; e < m.n_edges;
         e++) { /* vertex scaling: l = sqrt(2 eta) e^((u_i + u_j) / 2), 2 sinh(l / 2) alike */
        const double l = sqrt(2 * eta[e]) * exp(0.5 * (u[a.ends[2 * e]] + u[a.ends[2 * e + 1]]));
        const double expected = space == RICCI_SPACE_H2 ? 2 * asinh(l) : l;
        CHECK(fabs(lengths[e] - expected) < 1e-11 * expected);
    }
    double area = 0;
    for (size_t f = 0; f < m.n_faces; f++) {
        double sum = 0;
        for (int k = 0; k < 3; k++) {
            const double at = angle(&a, f, k, space);
            curvature[a.faces[3 * f + k]] -= at;
            sum += at;
        }
        area += space == RICCI_SPACE_H2 ? pi - sum : heron(&a, f);
    }
    CHECK(fabs(area - (m.doubled ? 2 : 1) * m.area) < 1e-9 * area);
    for (size_t v = 0; v < n; v++) {
        const size_t of = v < given_n ? v : mirror[v];
        const double both = m.doubled && mirror[v] == v ? 2 : 1;
        CHECK(fabs(curvature[v] - both * target[of]) < tolerance);
        CHECK(fabs(curvature[v] - both * said[of]) < tolerance);
    }
    FAILS(ricci_metric_mirror(metric, mirror, n - 1), RICCI_BUFFER_TOO_SMALL, "mirror");
    FAILS(ricci_metric_values(metric, RICCI_METRIC_MESH_U, u, n - 1), RICCI_BUFFER_TOO_SMALL, "u");
    FAILS(ricci_metric_values(NULL, RICCI_METRIC_MESH_U, u, n), RICCI_NULL_POINTER, "metric");
    free(mirror), free(u), free(given_u), free(curvature), free(said), free(eta), free(lengths);
    arrays_free(&a);
    ricci_mesh_free(mesh);
}

static void flips_reach_the_target(const ricci_mesh *mesh) {
    arrays given = arrays_of(mesh, 1);
    const size_t n = given.n.n_vertices;
    ricci_metric *metric = NULL, *flat = NULL, *again = NULL;
    ricci_report_summary done;
    ricci_metric_summary m;
    double *target = (double *)room(n, sizeof *target);
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(ricci_target_fill(metric, NULL, NULL, target, n));
    OK(flow_to(metric, target, n, NULL, NULL, &flat));
    OK(ricci_report_summarise(flat, &done, sizeof done));
    OK(ricci_metric_summarise(flat, &m, sizeof m));
    CHECK(done.converged && m.n_flips > 0 && m.n_flips == m.n_start_flips + done.flips);
    check_triangulation(&given, flat, target, RICCI_SPACE_E2, 1e-8);

    /* Reported vertices are given ones. */
    uint32_t worst[64];
    double errors[64];
    OK(ricci_report_vertices(flat, RICCI_REPORT_WORST, worst, 64));
    OK(ricci_report_values(flat, RICCI_REPORT_WORST_ERRORS, errors, 64));
    for (size_t i = 0; i < done.n_worst; i++) CHECK(worst[i] < n);

    /* A result that flows again is there already. */
    const size_t flips = m.n_flips;
    OK(flow_to(flat, target, n, NULL, NULL, &again));
    OK(ricci_report_summarise(again, &done, sizeof done));
    OK(ricci_metric_summarise(again, &m, sizeof m));
    CHECK(done.converged && done.iterations <= 1 && m.n_flips == flips + done.flips);
    ricci_metric_free(again);

    /* Cancelled before it began. */
    ricci_control *control = NULL;
    again = NULL;
    OK(ricci_control_new(&control));
    OK(ricci_control_cancel(control));
    FAILS(flow_to(metric, target, n, NULL, control, &again), RICCI_CANCELLED, "");
    uint32_t stage = 99;
    double fraction = -1, since = -1;
    OK(ricci_control_progress(control, &stage, &fraction, &since));
    CHECK(stage <= RICCI_STAGE_WRITE && fraction >= 0 && fraction <= 1 && since >= 0);
    FAILS(ricci_control_progress(control, NULL, &fraction, NULL), RICCI_NULL_POINTER, "stage");
    CHECK(again == NULL);
    ricci_control_free(control);
    ricci_metric_free(flat), ricci_metric_free(metric);
    free(target);
    arrays_free(&given);
}

/* Edges of the mesh that are asked to stay do; with all of them, and without flips, the mesh itself is
 * unrolled. */
static void fixed_edges_stay(const ricci_mesh *mesh) {
    arrays given = arrays_of(mesh, 1);
    const size_t n = given.n.n_vertices, n_edges = given.n.n_edges, n_faces = given.n.n_faces;
    uint32_t *fixed = (uint32_t *)room(n_edges, sizeof *fixed),
             *faces = (uint32_t *)room(3 * n_faces, sizeof *faces);
    double *target = (double *)room(n, sizeof *target);
    ricci_metric *metric = NULL, *flat = NULL;
    ricci_flow_options options;
    for (size_t e = 0; e < n_edges; e++) fixed[e] = (uint32_t)e;
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(ricci_target_fill(metric, NULL, NULL, target, n));
    for (int way = 0; way < 3; way++) { /* all fixed, no flips, every third fixed */
        ricci_metric_summary m;
        ricci_layout *layout = NULL;
        ricci_layout_summary s;
        ricci_map *map = NULL;
        ricci_map_summary c;
        ricci_mesh *unrolled = NULL;
        size_t kept = n_edges;
        INIT(options);
        if (way == 1) options.flips = RICCI_FLIPS_NEVER;
        if (way == 2) {
            for (kept = 0; 3 * kept < n_edges; kept++) fixed[kept] = (uint32_t)(3 * kept);
        }
        if (way != 1) options.fixed_edges = fixed, options.n_fixed_edges = kept;
        OK(flow_to(metric, target, n, &options, NULL, &flat));
        OK(ricci_metric_summarise(flat, &m, sizeof m));
        if (way < 2) {
            CHECK(m.n_flips == 0 && !m.doubled);
            OK(ricci_layout_new(flat, NULL, NULL, &layout));
            OK(ricci_layout_summarise(layout, &s, sizeof s));
            OK(ricci_layout_mesh(layout, &unrolled));
            OK(ricci_map_new(flat, NULL, &map));
            OK(ricci_map_summarise(map, &c, sizeof c));
            CHECK(c.n_crossings == 0 && s.n_vertices == n && s.n_faces == n_faces && c.n_pieces == n_faces);
            OK(ricci_mesh_faces(unrolled, faces, 3 * n_faces));
            CHECK(memcmp(faces, given.faces, 3 * n_faces * sizeof *faces) == 0);
            OK(ricci_map_faces(map, RICCI_ON_INPUT, faces, n_faces));
            for (size_t f = 0; f < n_faces; f++) CHECK(faces[f] == f);
            OK(ricci_map_crossings(map, RICCI_ON_INPUT, faces, NULL, 0));
            double *q = (double *)room(n, sizeof *q), *u = (double *)room(n, sizeof *u);
            OK(ricci_map_weights(map, q, n));
            OK(ricci_metric_values(flat, RICCI_METRIC_U, u, n));
            for (size_t v = 0; v < n; v++) CHECK(fabs(q[v] * exp(u[v]) - 1) < 1e-13);
            free(q), free(u);
            ricci_mesh_free(unrolled), ricci_layout_free(layout), ricci_map_free(map);
        } else {
            ricci_mesh *final_mesh = NULL;
            OK(ricci_metric_mesh(flat, &final_mesh));
            arrays last = arrays_of(final_mesh, 0);
            CHECK(m.n_flips > 0);
            for (size_t k = 0; k < kept; k++)
                CHECK(memcmp(last.ends + 2 * fixed[k], given.ends + 2 * fixed[k], 2 * sizeof *last.ends) ==
                      0);
            arrays_free(&last);
            ricci_mesh_free(final_mesh);
        }
        ricci_metric_free(flat);
    }
    flat = NULL;
    fixed[0] = (uint32_t)n_edges;
    FAILS(flow_to(metric, target, n, &options, NULL, &flat), RICCI_ARGUMENT, "fixed edge");
    options.fixed_edges = NULL;
    FAILS(flow_to(metric, target, n, &options, NULL, &flat), RICCI_NULL_POINTER, "fixed_edges");
    CHECK(flat == NULL);
    ricci_metric_free(metric);
    free(fixed), free(faces), free(target);
    arrays_free(&given);
}

/* Pins keep the boundary as it is: no double then, and one again once they are released. */
static void pins_keep_the_boundary(const ricci_mesh *mesh) {
    arrays given = arrays_of(mesh, 1);
    const size_t n = given.n.n_vertices, m = given.n.n_boundary_vertices;
    uint32_t *rim = (uint32_t *)room(m, sizeof *rim);
    size_t *starts = (size_t *)room(given.n.n_boundary_loops + 1, sizeof *starts);
    double *target = (double *)room(n, sizeof *target), *got = (double *)room(n, sizeof *got);
    ricci_metric *metric = NULL, *flat = NULL;
    ricci_solver *solver = NULL;
    ricci_metric_summary s;
    OK(ricci_mesh_boundary(mesh, rim, m, starts, given.n.n_boundary_loops + 1));
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(ricci_target_fill(metric, NULL, NULL, target, n));
    OK(ricci_solver_new(metric, NULL, &solver));
    for (int round = 0; round < 3; round++) { /* free, pinned, free again */
        if (round == 1) OK(ricci_solver_pin(solver, rim, m));
        if (round == 2) OK(ricci_solver_pin(solver, NULL, 0));
        OK(solve_to(solver, target, n, &flat));
        OK(ricci_metric_summarise(flat, &s, sizeof s));
        CHECK(s.doubled == (round != 1) && s.n_vertices == n);
        OK(ricci_metric_values(flat, RICCI_METRIC_CURVATURE, got, n));
        for (size_t v = 0; v < n; v++) CHECK(round == 1 || fabs(got[v] - target[v]) < 1e-9);
        if (round == 1) {
            double *inside = (double *)room(n, sizeof *inside);
            for (size_t k = 0; k < m; k++) inside[rim[k]] = 1;
            for (size_t v = 0; v < n; v++) CHECK(inside[v] != 0 || fabs(got[v]) < 1e-9);
            OK(ricci_metric_values(flat, RICCI_METRIC_U, got, n));
            for (size_t k = 0; k < m; k++) CHECK(got[rim[k]] == 0);
            free(inside);
        }
        ricci_metric_free(flat);
    }
    ricci_solver_free(solver);
    ricci_metric_free(metric);
    free(rim), free(starts), free(target), free(got);
    arrays_free(&given);
}

/* In H2 there are flips and the triangulation too, and one function lays both out. */
static void hyperbolic_flows_flip_too(void) {
    ricci_mesh *mesh = NULL;
    ricci_metric *metric = NULL, *end = NULL;
    ricci_layout *layout = NULL;
    ricci_layout_summary plane;
    ricci_metric_summary m;
    OK(make_genus(2, 4, 1, &mesh));
    arrays given = arrays_of(mesh, 1);
    double *target = (double *)room(given.n.n_vertices, sizeof *target);
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_H2, &metric));
    OK(ricci_target_fill(metric, NULL, NULL, target, given.n.n_vertices));
    OK(flow_to(metric, target, given.n.n_vertices, NULL, NULL, &end));
    OK(ricci_metric_summarise(end, &m, sizeof m));
    CHECK(m.n_flips > 0 && fabs(m.area - 4 * pi) < 1e-8);
    check_triangulation(&given, end, target, RICCI_SPACE_H2, 1e-8);
    OK(ricci_layout_new(end, NULL, NULL, &layout));
    OK(ricci_layout_summarise(layout, &plane, sizeof plane));
    CHECK(plane.space == RICCI_SPACE_H2 && plane.n_flipped == 0 && fabs(plane.area - m.area) < 1e-9);
    ricci_layout_free(layout);
    ricci_metric_free(end), ricci_metric_free(metric);
    ricci_mesh_free(mesh);
    free(target);
    arrays_free(&given);
}

int main(void) {
    torus t = torus_new(24, 12);
    ricci_mesh *closed = torus_mesh(&t), *open = bump(13);
    flips_reach_the_target(closed);
    flips_reach_the_target(open);
    fixed_edges_stay(closed);
    fixed_edges_stay(open);
    pins_keep_the_boundary(open);
    hyperbolic_flows_flip_too();
    ricci_mesh_free(closed), ricci_mesh_free(open);
    torus_free(&t);
    return 0;
}
