/* Layouts of metrics whose edges were flipped: the common subdivision, and the maps between it, the given
 * mesh and the metric's triangulation, against formulas written here. */
#include <ricci/uniformize.h>

#include "arrays.h"
#include "samples.h"

/* Pieces of more than one triangle whose map was checked. */
static size_t maps_checked = 0;

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
static size_t check_projective(const ricci_layout *layout, const ricci_map *map,
                               const ricci_layout_summary *s, const arrays *refined, const double *uv,
                               const double *bary, const uint32_t *pieces) {
    uint32_t *corners = (uint32_t *)room(3 * s->n_faces, sizeof *corners);
    double *q = (double *)room(s->n_vertices, sizeof *q);
    size_t checked = 0;
    OK(ricci_layout_corners(layout, RICCI_ON_REFINEMENT, corners, 3 * s->n_faces));
    OK(ricci_map_weights(map, q, s->n_vertices));
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
static void check_layout(const arrays *given, const ricci_metric *metric, const char *path) {
    ricci_layout *layout = NULL;
    ricci_map *map = NULL;
    ricci_layout_summary s;
    ricci_map_summary c;
    ricci_metric_summary m;
    ricci_mesh *mesh = NULL, *same = NULL, *final_mesh = NULL, *back = NULL;
    const size_t n = given->n.n_vertices;
    OK(ricci_layout_new(metric, NULL, NULL, &layout));
    OK(ricci_layout_summarise(layout, &s, sizeof s));
    OK(ricci_metric_summarise(metric, &m, sizeof m));
    OK(ricci_layout_mesh(layout, &mesh));
    OK(ricci_metric_mesh(metric, &final_mesh));
    OK(ricci_map_new(metric, NULL, &map));
    OK(ricci_map_summarise(map, &c, sizeof c));
    OK(ricci_map_mesh(map, &same));
    CHECK(c.n_vertices == s.n_vertices && c.n_edges == s.n_edges && c.n_faces == s.n_faces);
    arrays again_r = arrays_of(same, 1);
    arrays r = arrays_of(mesh, 1), last = arrays_of(final_mesh, 0);

    CHECK(memcmp(r.positions, again_r.positions, 3 * s.n_vertices * sizeof(double)) == 0);
    CHECK(memcmp(r.faces, again_r.faces, 3 * s.n_faces * sizeof *r.faces) == 0);
    arrays_free(&again_r), ricci_mesh_free(same);
    /* The same surface: counts, loops, the given vertices bit for bit. */
    CHECK(s.n_input_vertices == n && s.n_vertices == n + c.n_crossings && c.n_crossings > 0);
    CHECK(r.n.n_vertices == s.n_vertices && r.n.n_edges == s.n_edges && r.n.n_faces == s.n_faces);
    CHECK(r.n.euler == given->n.euler && r.n.n_boundary_loops == given->n.n_boundary_loops);
    CHECK(memcmp(r.positions, given->positions, 3 * n * sizeof(double)) == 0);

    /* Crossings lie on edges of both triangulations. */
    uint32_t *edges = (uint32_t *)room(c.n_crossings, sizeof *edges);
    double *t = (double *)room(c.n_crossings, sizeof *t);
    OK(ricci_map_crossings(map, RICCI_ON_INPUT, edges, t, c.n_crossings));
    for (size_t k = 0; k < c.n_crossings; k++) {
        CHECK(edges[k] < given->n.n_edges && t[k] >= 0 && t[k] <= 1);
        for (int i = 0; i < 3; i++) {
            const double a = given->positions[3 * given->ends[2 * edges[k]] + i];
            const double b = given->positions[3 * given->ends[2 * edges[k] + 1] + i];
            CHECK(fabs(r.positions[3 * (n + k) + i] - (1 - t[k]) * a - t[k] * b) <
                  1e-14 * (1 + fabs(a) + fabs(b)));
        }
    }
    OK(ricci_map_crossings(map, RICCI_ON_METRIC, edges, t, c.n_crossings));
    for (size_t k = 0; k < c.n_crossings; k++) CHECK(edges[k] < m.n_edges && t[k] >= 0 && t[k] <= 1);
    FAILS(ricci_map_crossings(map, RICCI_ON_INPUT, edges, NULL, c.n_crossings), RICCI_NULL_POINTER,
          "fractions");
    FAILS(ricci_map_crossings(map, RICCI_ON_METRIC, edges, t, c.n_crossings - 1), RICCI_BUFFER_TOO_SMALL,
          "fractions");

    /* Areas of the parts add up to those of both triangulations' faces; parts are counterclockwise. */
    uint32_t *in = (uint32_t *)room(s.n_faces, sizeof *in), *out = (uint32_t *)room(s.n_faces, sizeof *out);
    uint32_t *pieces = (uint32_t *)room(s.n_faces, sizeof *pieces);
    double *uv = (double *)room(6 * s.n_faces, sizeof *uv), total = 0;
    double *before = (double *)room(given->n.n_faces, sizeof *before);
    double *after = (double *)room(m.n_faces, sizeof *after);
    const double scale = sqrt(s.area / m.area);
    OK(ricci_map_faces(map, RICCI_ON_INPUT, in, s.n_faces));
    OK(ricci_map_faces(map, RICCI_ON_METRIC, out, s.n_faces));
    OK(ricci_map_faces(map, RICCI_ON_REFINEMENT, pieces, s.n_faces));
    OK(ricci_layout_uv(layout, RICCI_ON_REFINEMENT, uv, 6 * s.n_faces));
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
    CHECK(pieces[s.n_faces - 1] + 1 == c.n_pieces && fabs(total - s.area) < 1e-7 * total);
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
    OK(ricci_map_barycentric(map, RICCI_ON_METRIC, b, 9 * s.n_faces));
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
    OK(ricci_map_barycentric(map, RICCI_ON_INPUT, b, 9 * s.n_faces));
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
    maps_checked += check_projective(layout, map, &s, &r, uv, b, pieces);
    FAILS(ricci_map_barycentric(map, RICCI_ON_INPUT, b, 9 * s.n_faces - 1), RICCI_BUFFER_TOO_SMALL,
          "weights");
    FAILS(ricci_map_weights(map, b, s.n_vertices - 1), RICCI_BUFFER_TOO_SMALL, "weights");
    FAILS(ricci_map_faces(NULL, RICCI_ON_INPUT, in, s.n_faces), RICCI_NULL_POINTER, "map");
    FAILS(ricci_map_crossings(map, RICCI_ON_REFINEMENT, edges, t, c.n_crossings), RICCI_ARGUMENT,
          "REFINEMENT");
    FAILS(ricci_map_faces(map, RICCI_ON_METRIC, NULL, s.n_faces), RICCI_NULL_POINTER, "faces");
    FAILS(ricci_layout_mesh(layout, NULL), RICCI_NULL_POINTER, "mesh");

    /* The file is that surface with that layout. */
    ricci_mesh_summary read;
    OK(ricci_layout_write(layout, RICCI_ON_REFINEMENT, 0, path));
    OK(ricci_mesh_read(path, &back));
    OK(ricci_mesh_summarise(back, &read, sizeof read));
    CHECK(read.n_vertices == s.n_vertices && read.n_faces == s.n_faces && read.n_uv == s.n_faces);
    double *again = (double *)room(3 * s.n_vertices, sizeof *again);
    OK(ricci_mesh_values(back, RICCI_POSITIONS, again, 3 * s.n_vertices));
    CHECK(memcmp(again, r.positions, 3 * s.n_vertices * sizeof *again) == 0);

    printf("%s: %zu + %zu vertices, %zu flips, %zu faces in %zu pieces\n", path, n, c.n_crossings, m.n_flips,
           s.n_faces, c.n_pieces);
    free(edges), free(t), free(in), free(out), free(pieces), free(uv), free(before), free(after), free(b),
        free(again);
    arrays_free(&r), arrays_free(&last);
    ricci_mesh_free(back), ricci_mesh_free(mesh), ricci_mesh_free(final_mesh);
    ricci_layout_free(layout), ricci_map_free(map);
}

/* The default target with waves of this height. */
static void the_refinement_is_the_same_surface(const ricci_mesh *mesh, double waves, const char *path) {
    arrays given = arrays_of(mesh, 1);
    const size_t n = given.n.n_vertices;
    ricci_metric *metric = NULL, *flat = NULL;
    ricci_control *control = NULL;
    ricci_layout *layout = NULL;
    double *target = (double *)room(n, sizeof *target);
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(ricci_target_fill(metric, NULL, NULL, target, n));
    double sum = 0;
    for (size_t v = 0; v < n; v++) sum += waves * sin(7.0 * (double)v);
    for (size_t v = 0; v < n; v++) target[v] += waves * sin(7.0 * (double)v) - sum / (double)n;
    OK(flow_to(metric, target, n, NULL, NULL, &flat));
    check_layout(&given, flat, path);
    OK(ricci_control_new(&control));
    OK(ricci_control_cancel(control));
    FAILS(ricci_layout_new(flat, NULL, control, &layout), RICCI_CANCELLED, "");
    CHECK(layout == NULL);
    ricci_control_free(control);
    ricci_metric_free(flat), ricci_metric_free(metric);
    free(target);
    arrays_free(&given);
}

/* The map that is linear on the mesh's faces: with K the dilatation, K + 1/K is the squared norm of its
 * derivative over the determinant; both from squared lengths (cotangent formula) and areas. */
static void check_distortion_on_input(const arrays *given, const ricci_layout *layout, const double *uv) {
    const size_t n = given->n.n_faces;
    double *qc = (double *)room(n, sizeof *qc), *ratio = (double *)room(n, sizeof *ratio);
    double before = 0, after = 0, worst = 0;
    FAILS(ricci_layout_distortion(layout, RICCI_ON_INPUT, qc, ratio, n - 1), RICCI_BUFFER_TOO_SMALL,
          "area_ratio");
    FAILS(ricci_layout_distortion(layout, RICCI_ON_INPUT, NULL, ratio, n), RICCI_NULL_POINTER, "qc");
    FAILS(ricci_layout_distortion(layout, 3, qc, ratio, n), RICCI_ARGUMENT, "on is 3");
    OK(ricci_layout_distortion(layout, RICCI_ON_INPUT, qc, ratio, n));
    for (size_t f = 0; f < n; f++) {
        before += area_in_space(given->positions, given->faces + 3 * f);
        after += fabs(area_in_plane(uv + 6 * f));
    }
    for (size_t f = 0; f < n; f++) {
        const double area = area_in_space(given->positions, given->faces + 3 * f);
        const double image = fabs(area_in_plane(uv + 6 * f)), *p = uv + 6 * f;
        double squares[3], norm = 0;
        for (int k = 0; k < 3; k++) squares[k] = side(given, f, k) * side(given, f, k);
        for (int k = 0; k < 3; k++) {
            const int i = (k + 1) % 3, j = (k + 2) % 3;
            const double x = p[2 * i] - p[2 * j], y = p[2 * i + 1] - p[2 * j + 1];
            norm += (squares[i] + squares[j] - squares[k]) * (x * x + y * y);
        }
        const double expected = norm / (8 * area * image);
        CHECK(qc[f] >= 1 && fabs(qc[f] + 1 / qc[f] - expected) < 1e-10 * expected * expected);
        CHECK(fabs(ratio[f] - (image / after) / (area / before)) < 1e-9 * (1 + ratio[f]));
        worst = fmax(worst, qc[f]);
    }
    CHECK(worst > 1.01); /* the map is not conformal, so that there was something to measure */
    free(qc), free(ratio);
}

/* With the fewest edges split, no face of the mesh folds. */
static void check_repaired(const ricci_layout *layout, const ricci_layout_summary *of_layout) {
    ricci_repaired_input *repaired = NULL;
    ricci_repaired_input_summary s;
    ricci_mesh *mesh = NULL;
    ricci_mesh_summary split;
    OK(ricci_repaired_input_new(layout, NULL, &repaired));
    OK(ricci_repaired_input_summarise(repaired, &s, sizeof s));
    CHECK(s.n_flipped == 0 && s.n_input_vertices == of_layout->n_input_vertices &&
          (s.n_split_edges == 0) == (of_layout->n_flipped_input == 0));
    OK(ricci_repaired_input_mesh(repaired, &mesh));
    OK(ricci_mesh_summarise(mesh, &split, sizeof split));
    CHECK(split.n_vertices == s.n_vertices && split.n_faces == s.n_faces);
    double *points = (double *)room(2 * s.n_points, sizeof *points);
    double *weights = (double *)room(9 * s.n_faces, sizeof *weights);
    uint32_t *corners = (uint32_t *)room(3 * s.n_faces, sizeof *corners);
    uint32_t *faces = (uint32_t *)room(s.n_faces, sizeof *faces);
    uint32_t *edges = (uint32_t *)room(s.n_split_edges, sizeof *edges);
    OK(ricci_repaired_input_points(repaired, points, 2 * s.n_points));
    OK(ricci_repaired_input_barycentric(repaired, weights, 9 * s.n_faces));
    OK(ricci_repaired_input_corners(repaired, corners, 3 * s.n_faces));
    OK(ricci_repaired_input_faces(repaired, faces, s.n_faces));
    OK(ricci_repaired_input_split_edges(repaired, edges, s.n_split_edges));
    for (size_t f = 0; f < s.n_faces; f++) {
        double uv[6];
        for (size_t k = 0; k < 6; k++) uv[k] = points[2 * corners[3 * f + k / 2] + k % 2];
        CHECK(area_in_plane(uv) > 0 && faces[f] < of_layout->n_input_faces);
        for (size_t k = 0; k < 3; k++) {
            const double *w = weights + 9 * f + 3 * k;
            CHECK(fabs(w[0] + w[1] + w[2] - 1) < 1e-14);
        }
    }
    OK(ricci_repaired_input_write(repaired, "repaired_input.obj"));
    FAILS(ricci_repaired_input_points(repaired, points, 2 * s.n_points - 1), RICCI_BUFFER_TOO_SMALL,
          "points");
    free(points), free(weights), free(corners), free(faces), free(edges);
    ricci_mesh_free(mesh), ricci_repaired_input_free(repaired);
}

/* Noise in a target makes no cones: four are joined by three seams (five where those branch), along edges of
 * the mesh; its own faces have coordinates. */
static void noise_makes_no_cones(const ricci_mesh *mesh) {
    arrays given = arrays_of(mesh, 1);
    const size_t n = given.n.n_vertices, n_faces = given.n.n_faces;
    ricci_metric *metric = NULL, *flat = NULL;
    ricci_layout *layout = NULL;
    ricci_layout_summary s;
    ricci_mesh *back = NULL;
    ricci_mesh_summary read;
    double *target = (double *)room(n, sizeof *target), *uv = (double *)room(6 * n_faces, sizeof *uv);
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(ricci_target_fill(metric, NULL, NULL, target, n));
    for (size_t v = 0; v < n; v++) target[v] = target[v] != 0 ? target[v] : v % 2 ? 1e-17 : -1e-17;
    OK(flow_to(metric, target, n, NULL, NULL, &flat));
    OK(ricci_layout_new(flat, NULL, NULL, &layout));
    OK(ricci_layout_summarise(layout, &s, sizeof s));
    CHECK(s.n_seams >= 3 && s.n_seams <= 5 && s.n_flipped == 0 && s.n_input_faces == n_faces &&
          50 * s.n_flipped_input < n_faces);
    OK(ricci_layout_uv(layout, RICCI_ON_INPUT, uv, 6 * n_faces));
    check_distortion_on_input(&given, layout, uv);
    /* The faces that fold are clockwise there. */
    uint32_t *folded = (uint32_t *)room(s.n_flipped_input, sizeof *folded);
    OK(ricci_layout_flipped(layout, RICCI_ON_INPUT, folded, s.n_flipped_input));
    OK(ricci_layout_flipped(layout, RICCI_ON_REFINEMENT, NULL, 0));
    size_t clockwise = 0;
    for (size_t f = 0; f < n_faces; f++) clockwise += area_in_plane(uv + 6 * f) <= 0;
    for (size_t k = 0; k < s.n_flipped_input; k++) CHECK(area_in_plane(uv + 6 * folded[k]) < 1e-12 * s.area);
    CHECK(clockwise <= s.n_flipped_input + 2);
    free(folded);
    for (size_t k = 0; k < 6 * n_faces; k++) CHECK(isfinite(uv[k]) && fabs(uv[k]) <= s.diameter);
    FAILS(ricci_layout_uv(layout, RICCI_ON_INPUT, uv, 6 * n_faces - 1), RICCI_BUFFER_TOO_SMALL, "uv");
    OK(ricci_layout_write(layout, RICCI_ON_INPUT, 0, "refined_input.obj"));
    OK(ricci_layout_write(layout, RICCI_ON_INPUT, 0, "refined_input.ply"));
    FAILS(ricci_layout_write(layout, RICCI_ON_INPUT, 0, "refined_input.stl"), RICCI_UNKNOWN_FORMAT, ".glb");
    OK(ricci_mesh_read("refined_input.obj", &back));
    OK(ricci_mesh_summarise(back, &read, sizeof read));
    CHECK(read.n_vertices == n && read.n_faces == n_faces && read.n_uv == n_faces);
    check_repaired(layout, &s);
    ricci_mesh_free(back), ricci_layout_free(layout);
    ricci_metric_free(flat), ricci_metric_free(metric);
    free(target), free(uv);
    arrays_free(&given);
}

/* A sheared flat torus has no positions: it is unrolled, but not written. */
static void intrinsic_surfaces_are_unrolled(void) {
    ricci_mesh *mesh = NULL, *unrolled = NULL;
    ricci_metric *metric = NULL, *flat = NULL;
    ricci_layout *layout = NULL;
    ricci_layout_summary s;
    ricci_map *map = NULL;
    ricci_metric_summary m;
    double target[25] = {0};
    OK(make_sized(RICCI_SHAPE_FLAT_TORUS, 5, 5, 0.45, 0.2, 0, &mesh));
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(flow_to(metric, target, 25, NULL, NULL, &flat));
    OK(ricci_metric_summarise(flat, &m, sizeof m));
    CHECK(m.n_start_flips > 0 && m.n_flips == m.n_start_flips && !m.doubled && fabs(m.area - 0.2) < 1e-12);
    OK(ricci_layout_new(flat, NULL, NULL, &layout));
    OK(ricci_layout_summarise(layout, &s, sizeof s));
    CHECK(s.n_vertices > s.n_input_vertices && fabs(s.area - 0.2) < 1e-12);
    FAILS(ricci_layout_write(layout, RICCI_ON_REFINEMENT, 0, "never.obj"), RICCI_ARGUMENT, "intrinsic");
    OK(ricci_map_new(flat, NULL, &map));
    FAILS(ricci_map_mesh(map, &unrolled), RICCI_ARGUMENT, "intrinsic");
    OK(ricci_layout_mesh(layout, &unrolled));
    arrays r = arrays_of(unrolled, 0);
    double area = 0;
    for (size_t f = 0; f < r.n.n_faces; f++) area += heron(&r, f);
    CHECK(r.n.genus == 1 && fabs(area - 0.2) < 1e-9);
    arrays_free(&r);
    ricci_mesh_free(unrolled), ricci_mesh_free(mesh);
    ricci_layout_free(layout), ricci_map_free(map);
    ricci_metric_free(flat), ricci_metric_free(metric);
}

int main(void) {
    torus t = torus_new(24, 12);
    ricci_mesh *closed = torus_mesh(&t), *open = bump(13), *round = NULL;
    /* No flip at the start: pieces of several triangles have one map. */
    OK(make_sphere(10, &round));
    the_refinement_is_the_same_surface(round, 4, "refined_sphere.obj");
    the_refinement_is_the_same_surface(closed, 0, "refined_torus.obj");
    the_refinement_is_the_same_surface(open, 0, "refined_bump.obj");
    CHECK(maps_checked > 20);
    noise_makes_no_cones(round);
    intrinsic_surfaces_are_unrolled();
    ricci_mesh_free(closed), ricci_mesh_free(open), ricci_mesh_free(round);
    torus_free(&t);
    return 0;
}
