/* Flows with edge flips and their way back: the metric's own triangulation, the common refinement that is
 * unrolled, and the maps between them, against formulas written here. */
#include "torus.h"

static const double pi = 3.14159265358979323846;

/* Pieces of more than one triangle whose map was checked. */
static size_t maps_checked = 0;

/* A bump over a square, n x n vertices, with long thin triangles. */
static ricci_mesh *bump(size_t n) {
    double *positions = (double *)malloc(3 * n * n * sizeof *positions);
    uint32_t *faces = (uint32_t *)malloc(6 * n * n * sizeof *faces);
    size_t n_faces = 0;
    ricci_mesh *mesh = NULL;
    CHECK(positions && faces);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            const double x = 2.0 * i / (n - 1) - 1, y = 2.0 * j / (n - 1) - 1;
            const double point[3] = {x, 0.4 * y + 0.3 * x, exp(-4 * (x * x + y * y))};
            memcpy(positions + 3 * (i * n + j), point, sizeof point);
            if (i + 1 == n || j + 1 == n) continue;
            const size_t v = i * n + j, corners[6] = {v, v + n, v + n + 1, v, v + n + 1, v + 1};
            for (int k = 0; k < 6; k++) faces[3 * n_faces + k] = (uint32_t)corners[k];
            n_faces += 2;
        }
    OK(ricci_mesh_from_arrays(positions, 0, n * n, faces, n_faces, &mesh));
    free(positions), free(faces);
    return mesh;
}

/* A mesh as arrays. */
typedef struct {
    ricci_mesh_summary n;
    uint32_t *faces, *ends;
    int32_t *face_edges;
    double *lengths, *positions;
} arrays;

static void *room(size_t n, size_t size) {
    void *p = calloc(n + 1, size);
    CHECK(p);
    return p;
}

static arrays arrays_of(const ricci_mesh *mesh, int in_space) {
    arrays a = {0};
    OK(ricci_mesh_summarise(mesh, &a.n, sizeof a.n));
    a.faces = (uint32_t *)room(3 * a.n.n_faces, sizeof *a.faces);
    a.ends = (uint32_t *)room(2 * a.n.n_edges, sizeof *a.ends);
    a.face_edges = (int32_t *)room(3 * a.n.n_faces, sizeof *a.face_edges);
    a.lengths = (double *)room(a.n.n_edges, sizeof *a.lengths);
    OK(ricci_mesh_faces(mesh, a.faces, 3 * a.n.n_faces));
    OK(ricci_mesh_edges(mesh, a.ends, 2 * a.n.n_edges));
    OK(ricci_mesh_face_edges(mesh, a.face_edges, 3 * a.n.n_faces));
    OK(ricci_mesh_lengths(mesh, a.lengths, a.n.n_edges));
    if (in_space) {
        a.positions = (double *)room(3 * a.n.n_vertices, sizeof *a.positions);
        OK(ricci_mesh_positions(mesh, a.positions, 3 * a.n.n_vertices));
    }
    return a;
}

static void arrays_free(arrays *a) {
    free(a->faces), free(a->ends), free(a->face_edges), free(a->lengths), free(a->positions);
}

/* The length of the side opposite corner k. */
static double side(const arrays *a, size_t f, int k) {
    return a->lengths[abs(a->face_edges[3 * f + k % 3]) - 1];
}

static double heron(const arrays *a, size_t f) {
    const double x = side(a, f, 0), y = side(a, f, 1), z = side(a, f, 2), s = 0.5 * (x + y + z);
    return sqrt(s * (s - x) * (s - y) * (s - z));
}

/* The angle at corner k, by half-angles. */
static double angle(const arrays *a, size_t f, int k, ricci_space space) {
    double x = side(a, f, k), y = side(a, f, k + 1), z = side(a, f, k + 2), s = 0.5 * (x + y + z);
    double p = s - y, q = s - z, r = s - x;
    if (space == RICCI_SPACE_H2) s = sinh(s), p = sinh(p), q = sinh(q), r = sinh(r);
    return 2 * atan2(sqrt(p * q), sqrt(s * r));
}

/* The triangulation that a metric lives on, with curvature computed anew from its lengths. */
static void check_triangulation(const arrays *given, const ricci_metric *metric, const double *target,
                                ricci_space space, double tolerance) {
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
    OK(ricci_metric_mesh_mirror(metric, mirror, n));
    OK(ricci_metric_mesh_u(metric, u, n));
    OK(ricci_metric_u(metric, given_u, given_n));
    OK(ricci_metric_curvature(metric, said, given_n));
    OK(ricci_metric_eta(metric, eta, m.n_edges));
    OK(ricci_metric_lengths(metric, lengths, m.n_edges));
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
    FAILS(ricci_metric_mesh_mirror(metric, mirror, n - 1), RICCI_BUFFER_TOO_SMALL, "mirror");
    FAILS(ricci_metric_mesh_u(metric, u, n - 1), RICCI_BUFFER_TOO_SMALL, "u");
    FAILS(ricci_metric_mesh_u(NULL, u, n), RICCI_NULL_POINTER, "metric");
    free(mirror), free(u), free(given_u), free(curvature), free(said), free(eta), free(lengths);
    arrays_free(&a);
    ricci_mesh_free(mesh);
}

static double area_in_space(const double *p, const uint32_t *face) {
    double u[3], v[3];
    for (int i = 0; i < 3; i++) {
        u[i] = p[3 * face[1] + i] - p[3 * face[0] + i];
        v[i] = p[3 * face[2] + i] - p[3 * face[0] + i];
    }
    const double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0];
    return 0.5 * sqrt(x * x + y * y + z * z);
}

static double area_in_plane(const double *uv) {
    return 0.5 * ((uv[2] - uv[0]) * (uv[5] - uv[1]) - (uv[3] - uv[1]) * (uv[4] - uv[0]));
}

static double determinant(const double *a, const double *b, const double *c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/* In a piece (q x, q y, q) is linear: what holds of the corners of one triangle holds of the fourth corner of
 * its neighbour. */
static size_t check_projective(const ricci_layout *layout, const ricci_layout_summary *s,
                               const arrays *refined, const double *uv, const double *bary,
                               const uint32_t *pieces) {
    uint32_t *corners = (uint32_t *)room(3 * s->n_faces, sizeof *corners);
    double *q = (double *)room(s->n_vertices, sizeof *q);
    size_t checked = 0;
    OK(ricci_layout_corners(layout, corners, 3 * s->n_faces));
    OK(ricci_layout_weights(layout, q, s->n_vertices));
    for (size_t v = 0; v < s->n_vertices; v++) CHECK(q[v] > 0 && q[v] < HUGE_VAL);
    for (size_t f = 0; f + 1 < s->n_faces; f++) {
        int fourth = -1, shared = 0;
        for (int k = 0; k < 3; k++) {
            int found = 0;
            for (int l = 0; l < 3; l++) found |= corners[3 * (f + 1) + k] == corners[3 * f + l];
            shared += found;
            if (!found) fourth = k;
        }
        if (pieces[f] != pieces[f + 1] || shared != 2) continue;
        const double *b = bary + 9 * f, *at = bary + 9 * (f + 1) + 3 * fourth;
        const double all = determinant(b, b + 3, b + 6);
        if (all < 1e-6) continue; /* too thin to say anything */
        const double c[3] = {determinant(at, b + 3, b + 6) / all, determinant(b, at, b + 6) / all,
                             determinant(b, b + 3, at) / all};
        for (int i = 0; i < 3; i++) { /* q x, q y, q */
            const double own = i < 2 ? uv[6 * (f + 1) + 2 * fourth + i] : 1;
            double expected = 0, size = 0;
            for (int k = 0; k < 3; k++) {
                const double value = i < 2 ? uv[6 * f + 2 * k + i] : 1, weight = q[refined->faces[3 * f + k]];
                expected += c[k] * weight * value;
                size += fabs(c[k] * weight) * (i < 2 ? s->diameter : 1);
            }
            CHECK(fabs(q[refined->faces[3 * (f + 1) + fourth]] * own - expected) < 1e-9 * size);
        }
        checked++;
    }
    free(corners), free(q);
    return checked;
}

/* The layout of a metric in E2 whose edges were flipped. */
static void check_layout(const arrays *given, const ricci_metric *metric, const double *target,
                         const char *path) {
    ricci_layout *layout = NULL;
    ricci_layout_summary s;
    ricci_metric_summary m;
    ricci_mesh *mesh = NULL, *final_mesh = NULL, *back = NULL;
    const size_t n = given->n.n_vertices;
    OK(ricci_layout_new(metric, target, n, NULL, &layout));
    OK(ricci_layout_summarise(layout, &s, sizeof s));
    OK(ricci_metric_summarise(metric, &m, sizeof m));
    OK(ricci_layout_mesh(layout, &mesh));
    OK(ricci_metric_mesh(metric, &final_mesh));
    arrays r = arrays_of(mesh, 1), last = arrays_of(final_mesh, 0);

    /* The same surface: counts, loops, the given vertices bit for bit. */
    CHECK(s.n_given_vertices == n && s.n_vertices == n + s.n_crossings && s.n_crossings > 0);
    CHECK(r.n.n_vertices == s.n_vertices && r.n.n_edges == s.n_edges && r.n.n_faces == s.n_faces);
    CHECK(r.n.euler == given->n.euler && r.n.n_boundary_loops == given->n.n_boundary_loops);
    CHECK(memcmp(r.positions, given->positions, 3 * n * sizeof(double)) == 0);

    /* Crossings lie on edges of both triangulations. */
    uint32_t *edges = (uint32_t *)room(s.n_crossings, sizeof *edges);
    double *t = (double *)room(s.n_crossings, sizeof *t);
    OK(ricci_layout_input_crossings(layout, edges, t, s.n_crossings));
    for (size_t k = 0; k < s.n_crossings; k++) {
        CHECK(edges[k] < given->n.n_edges && t[k] >= 0 && t[k] <= 1);
        for (int i = 0; i < 3; i++) {
            const double a = given->positions[3 * given->ends[2 * edges[k]] + i];
            const double b = given->positions[3 * given->ends[2 * edges[k] + 1] + i];
            CHECK(fabs(r.positions[3 * (n + k) + i] - (1 - t[k]) * a - t[k] * b) <
                  1e-14 * (1 + fabs(a) + fabs(b)));
        }
    }
    OK(ricci_layout_final_crossings(layout, edges, t, s.n_crossings));
    for (size_t k = 0; k < s.n_crossings; k++) CHECK(edges[k] < m.n_edges && t[k] >= 0 && t[k] <= 1);
    FAILS(ricci_layout_input_crossings(layout, edges, NULL, s.n_crossings), RICCI_NULL_POINTER, "fractions");
    FAILS(ricci_layout_final_crossings(layout, edges, t, s.n_crossings - 1), RICCI_BUFFER_TOO_SMALL,
          "fractions");

    /* Areas of the parts add up to those of both triangulations' faces; parts are counterclockwise. */
    uint32_t *in = (uint32_t *)room(s.n_faces, sizeof *in), *out = (uint32_t *)room(s.n_faces, sizeof *out);
    uint32_t *pieces = (uint32_t *)room(s.n_faces, sizeof *pieces);
    double *uv = (double *)room(6 * s.n_faces, sizeof *uv), total = 0;
    double *before = (double *)room(given->n.n_faces, sizeof *before);
    double *after = (double *)room(m.n_faces, sizeof *after);
    const double scale = sqrt(s.area / m.area);
    OK(ricci_layout_input_faces(layout, in, s.n_faces));
    OK(ricci_layout_final_faces(layout, out, s.n_faces));
    OK(ricci_layout_pieces(layout, pieces, s.n_faces));
    OK(ricci_layout_uv(layout, uv, 6 * s.n_faces));
    CHECK(s.n_flipped == 0 && s.n_degenerate == 0 && s.consistency < 1e-8);
    for (size_t f = 0; f < s.n_faces; f++) {
        const double area = area_in_plane(uv + 6 * f);
        CHECK(in[f] < given->n.n_faces && out[f] < m.n_faces && area > 0);
        CHECK(f == 0 ? pieces[f] == 0 : pieces[f] - pieces[f - 1] <= 1);
        CHECK(f == 0 || pieces[f] != pieces[f - 1] || (in[f] == in[f - 1] && out[f] == out[f - 1]));
        before[in[f]] += area_in_space(r.positions, r.faces + 3 * f);
        after[out[f]] += area;
        total += area;
    }
    CHECK(pieces[s.n_faces - 1] + 1 == s.n_pieces && fabs(total - s.area) < 1e-7 * total);
    for (size_t f = 0; f < given->n.n_faces; f++) {
        const double whole = area_in_space(given->positions, given->faces + 3 * f);
        CHECK(fabs(before[f] - whole) < 1e-12 * s.area + 1e-9 * whole);
    }
    for (size_t f = 0; f < m.n_faces;
         f++) { /* a final face of a double may lie in both copies, or in the other */
        const double whole = scale * scale * heron(&last, f);
        CHECK(after[f] < whole + 1e-7 * s.area && (m.doubled || after[f] > whole - 1e-7 * s.area));
    }

    /* Barycentric coordinates give the positions in space, and the lengths in the plane. */
    double *b = (double *)room(9 * s.n_faces, sizeof *b);
    OK(ricci_layout_final_barycentric(layout, b, 9 * s.n_faces));
    for (size_t f = 0; f < s.n_faces; f++)
        for (int k = 0; k < 3; k++) {
            const double *from = b + 9 * f + 3 * k, *to = b + 9 * f + 3 * ((k + 1) % 3);
            const double *p = uv + 6 * f + 2 * k, *q = uv + 6 * f + 2 * ((k + 1) % 3);
            double squared = 0;
            for (int i = 0; i < 3; i++) {
                const double l = side(&last, out[f], i); /* opposite corner i: between the other two */
                squared -=
                    l * l * (to[(i + 1) % 3] - from[(i + 1) % 3]) * (to[(i + 2) % 3] - from[(i + 2) % 3]);
            }
            const double length = scale * sqrt(fabs(squared));
            CHECK(fabs(length - hypot(q[0] - p[0], q[1] - p[1])) < 1e-7 * s.diameter);
            CHECK(fabs(from[0] + from[1] + from[2] - 1) < 1e-14);
        }
    OK(ricci_layout_input_barycentric(layout, b, 9 * s.n_faces));
    for (size_t f = 0; f < s.n_faces; f++)
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 3; i++) {
                double x = 0, size = 1;
                for (int c = 0; c < 3; c++) {
                    const double weight = b[9 * f + 3 * k + c];
                    CHECK(weight >= 0 && weight <= 1);
                    x += weight * given->positions[3 * given->faces[3 * in[f] + c] + i];
                    size += fabs(x);
                }
                CHECK(fabs(x - r.positions[3 * r.faces[3 * f + k] + i]) < 1e-14 * size);
            }
    maps_checked += check_projective(layout, &s, &r, uv, b, pieces);
    FAILS(ricci_layout_input_barycentric(layout, b, 9 * s.n_faces - 1), RICCI_BUFFER_TOO_SMALL, "weights");
    FAILS(ricci_layout_weights(layout, b, s.n_vertices - 1), RICCI_BUFFER_TOO_SMALL, "weights");
    FAILS(ricci_layout_input_faces(NULL, in, s.n_faces), RICCI_NULL_POINTER, "layout");
    FAILS(ricci_layout_final_faces(layout, NULL, s.n_faces), RICCI_NULL_POINTER, "faces");
    FAILS(ricci_layout_mesh(layout, NULL), RICCI_NULL_POINTER, "mesh");

    /* The file is that surface with that layout. */
    ricci_mesh_summary read;
    OK(ricci_layout_write_obj(layout, path));
    OK(ricci_mesh_read(path, &back));
    OK(ricci_mesh_summarise(back, &read, sizeof read));
    CHECK(read.n_vertices == s.n_vertices && read.n_faces == s.n_faces && read.n_uv == s.n_faces);
    double *again = (double *)room(3 * s.n_vertices, sizeof *again);
    OK(ricci_mesh_positions(back, again, 3 * s.n_vertices));
    CHECK(memcmp(again, r.positions, 3 * s.n_vertices * sizeof *again) == 0);

    printf("%s: %zu + %zu vertices, %zu flips, %zu faces in %zu pieces\n", path, n, s.n_crossings, m.n_flips,
           s.n_faces, s.n_pieces);
    free(edges), free(t), free(in), free(out), free(pieces), free(uv), free(before), free(after), free(b),
        free(again);
    arrays_free(&r), arrays_free(&last);
    ricci_mesh_free(back), ricci_mesh_free(mesh), ricci_mesh_free(final_mesh);
    ricci_layout_free(layout);
}

static void flips_lead_there_and_back(const ricci_mesh *mesh, const char *path) {
    arrays given = arrays_of(mesh, 1);
    const size_t n = given.n.n_vertices;
    ricci_metric *metric = NULL, *flat = NULL, *again = NULL;
    ricci_report *report = NULL;
    ricci_report_summary done;
    ricci_metric_summary m;
    double *target = (double *)room(n, sizeof *target);
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(ricci_target_default(metric, target, n));
    OK(ricci_flow(metric, target, n, NULL, NULL, &flat, &report));
    OK(ricci_report_summarise(report, &done, sizeof done));
    OK(ricci_metric_summarise(flat, &m, sizeof m));
    CHECK(done.converged && m.n_flips > 0 && m.n_flips == m.n_start_flips + done.flips);
    check_triangulation(&given, flat, target, RICCI_SPACE_E2, 1e-8);
    check_layout(&given, flat, target, path);

    /* Reported vertices are given ones. */
    uint32_t worst[64];
    double errors[64];
    OK(ricci_report_worst(report, worst, errors, 64));
    for (size_t i = 0; i < done.n_worst; i++) CHECK(worst[i] < n);
    ricci_report_free(report);

    /* A result that flows again is there already. */
    const size_t flips = m.n_flips;
    OK(ricci_flow(flat, target, n, NULL, NULL, &again, &report));
    OK(ricci_report_summarise(report, &done, sizeof done));
    OK(ricci_metric_summarise(again, &m, sizeof m));
    CHECK(done.converged && done.iterations <= 1 && m.n_flips == flips + done.flips);
    ricci_report_free(report), ricci_metric_free(again);

    /* Cancelled before it began. */
    ricci_control *control = NULL;
    ricci_layout *layout = NULL;
    again = NULL;
    OK(ricci_control_new(&control));
    OK(ricci_control_cancel(control));
    FAILS(ricci_flow(metric, target, n, NULL, control, &again, NULL), RICCI_CANCELLED, "");
    FAILS(ricci_layout_new(flat, target, n, control, &layout), RICCI_CANCELLED, "");
    CHECK(again == NULL && layout == NULL);
    FAILS(ricci_layout_new(flat, target, n + 1, NULL, &layout), RICCI_WRONG_SIZE, "target");
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
    OK(ricci_target_default(metric, target, n));
    for (int way = 0; way < 3; way++) { /* all fixed, no flips, every third fixed */
        ricci_metric_summary m;
        ricci_layout *layout = NULL;
        ricci_layout_summary s;
        ricci_mesh *unrolled = NULL;
        size_t kept = n_edges;
        OK(ricci_flow_options_init(&options, sizeof options));
        CHECK(options.fixed_edges == NULL && options.n_fixed_edges == 0 && options.flips == RICCI_FLIPS_AUTO);
        if (way == 1) options.flips = RICCI_FLIPS_NEVER;
        if (way == 2) {
            for (kept = 0; 3 * kept < n_edges; kept++) fixed[kept] = (uint32_t)(3 * kept);
        }
        if (way != 1) options.fixed_edges = fixed, options.n_fixed_edges = kept;
        OK(ricci_flow(metric, target, n, &options, NULL, &flat, NULL));
        OK(ricci_metric_summarise(flat, &m, sizeof m));
        if (way < 2) {
            CHECK(m.n_flips == 0 && m.doubled == (way == 0 && given.n.n_boundary_loops > 0));
            OK(ricci_layout_new(flat, target, n, NULL, &layout));
            OK(ricci_layout_summarise(layout, &s, sizeof s));
            OK(ricci_layout_mesh(layout, &unrolled));
            CHECK(s.n_crossings == 0 && s.n_vertices == n && s.n_faces == n_faces && s.n_pieces == n_faces);
            OK(ricci_mesh_faces(unrolled, faces, 3 * n_faces));
            CHECK(memcmp(faces, given.faces, 3 * n_faces * sizeof *faces) == 0);
            OK(ricci_layout_input_faces(layout, faces, n_faces));
            for (size_t f = 0; f < n_faces; f++) CHECK(faces[f] == f);
            OK(ricci_layout_input_crossings(layout, faces, NULL, 0));
            double *q = (double *)room(n, sizeof *q), *u = (double *)room(n, sizeof *u);
            OK(ricci_layout_weights(layout, q, n));
            OK(ricci_metric_u(flat, u, n));
            for (size_t v = 0; v < n; v++) CHECK(fabs(q[v] * exp(u[v]) - 1) < 1e-13);
            free(q), free(u);
            ricci_mesh_free(unrolled), ricci_layout_free(layout);
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
    FAILS(ricci_flow(metric, target, n, &options, NULL, &flat, NULL), RICCI_ARGUMENT, "fixed edge");
    options.fixed_edges = NULL;
    FAILS(ricci_flow(metric, target, n, &options, NULL, &flat, NULL), RICCI_NULL_POINTER, "fixed_edges");
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
    OK(ricci_target_default(metric, target, n));
    OK(ricci_solver_new(metric, NULL, &solver));
    for (int round = 0; round < 3; round++) { /* free, pinned, free again */
        if (round == 1) OK(ricci_solver_pin(solver, rim, m));
        if (round == 2) OK(ricci_solver_pin(solver, NULL, 0));
        OK(ricci_solver_solve(solver, target, n, NULL, &flat, NULL));
        OK(ricci_metric_summarise(flat, &s, sizeof s));
        CHECK(s.doubled == (round != 1) && s.n_vertices == n);
        OK(ricci_metric_curvature(flat, got, n));
        for (size_t v = 0; v < n; v++) CHECK(round == 1 || fabs(got[v] - target[v]) < 1e-9);
        if (round == 1) {
            double *inside = (double *)room(n, sizeof *inside);
            for (size_t k = 0; k < m; k++) inside[rim[k]] = 1;
            for (size_t v = 0; v < n; v++) CHECK(inside[v] != 0 || fabs(got[v]) < 1e-9);
            OK(ricci_metric_u(flat, got, n));
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

/* A sheared flat torus has no positions: it is unrolled, but not written. */
static void intrinsic_surfaces_are_unrolled(void) {
    ricci_mesh *mesh = NULL, *unrolled = NULL;
    ricci_metric *metric = NULL, *flat = NULL;
    ricci_layout *layout = NULL;
    ricci_layout_summary s;
    ricci_metric_summary m;
    double target[25] = {0};
    OK(ricci_shape_flat_torus(0.45, 0.2, 5, 5, &mesh));
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(ricci_flow(metric, target, 25, NULL, NULL, &flat, NULL));
    OK(ricci_metric_summarise(flat, &m, sizeof m));
    CHECK(m.n_start_flips > 0 && m.n_flips == m.n_start_flips && !m.doubled && fabs(m.area - 0.2) < 1e-12);
    OK(ricci_layout_new(flat, target, 25, NULL, &layout));
    OK(ricci_layout_summarise(layout, &s, sizeof s));
    CHECK(s.n_crossings > 0 && fabs(s.area - 0.2) < 1e-12);
    FAILS(ricci_layout_write_obj(layout, "never.obj"), RICCI_ARGUMENT, "intrinsic");
    OK(ricci_layout_mesh(layout, &unrolled));
    arrays r = arrays_of(unrolled, 0);
    double area = 0;
    for (size_t f = 0; f < r.n.n_faces; f++) area += heron(&r, f);
    CHECK(r.n.genus == 1 && fabs(area - 0.2) < 1e-9);
    arrays_free(&r);
    ricci_mesh_free(unrolled), ricci_mesh_free(mesh);
    ricci_layout_free(layout);
    ricci_metric_free(flat), ricci_metric_free(metric);
}

/* In H2 there are flips and the triangulation, and no layout. */
static void hyperbolic_flows_flip_too(void) {
    ricci_mesh *mesh = NULL;
    ricci_metric *metric = NULL, *end = NULL;
    ricci_layout *layout = NULL;
    ricci_metric_summary m;
    OK(ricci_shape_genus(2, 4, 1, &mesh));
    arrays given = arrays_of(mesh, 1);
    double *target = (double *)room(given.n.n_vertices, sizeof *target);
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_H2, &metric));
    OK(ricci_target_default(metric, target, given.n.n_vertices));
    OK(ricci_flow(metric, target, given.n.n_vertices, NULL, NULL, &end, NULL));
    OK(ricci_metric_summarise(end, &m, sizeof m));
    CHECK(m.n_flips > 0 && fabs(m.area - 4 * pi) < 1e-8);
    check_triangulation(&given, end, target, RICCI_SPACE_H2, 1e-8);
    FAILS(ricci_layout_new(end, target, given.n.n_vertices, NULL, &layout), RICCI_LAYOUT, "h2");
    ricci_metric_free(end), ricci_metric_free(metric);
    ricci_mesh_free(mesh);
    free(target);
    arrays_free(&given);
}

int main(void) {
    torus t = torus_new(24, 12);
    ricci_mesh *closed = torus_mesh(&t), *open = bump(13);
    flips_lead_there_and_back(closed, "refined_torus.obj");
    flips_lead_there_and_back(open, "refined_bump.obj");
    printf("%zu projective maps\n", maps_checked);
    CHECK(maps_checked > 20);
    fixed_edges_stay(closed);
    fixed_edges_stay(open);
    pins_keep_the_boundary(open);
    intrinsic_surfaces_are_unrolled();
    hyperbolic_flows_flip_too();
    ricci_mesh_free(closed), ricci_mesh_free(open);
    torus_free(&t);
    return 0;
}
