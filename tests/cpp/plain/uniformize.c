/* Closed surfaces as quotients: known deck groups and moduli, layouts in every model and back on the given
 * mesh. */
#include "quotient.h"

static const double sqrt2 = 1.41421356237309504880;

/* Every face of the layout has the sides of the metric, and is counterclockwise. */
static void check_layout(const laid *l) {
    CHECK(l->s.converged && l->l.n_flipped == 0 && l->s.angle_defect < 1e-14);
    CHECK(l->s.disagreement < 1e-11 && l->s.side_residual < 1e-12 && l->s.relation_residual < 1e-12);
    CHECK(l->s.n_sides == 2 * l->l.n_seams && l->s.n_polygon == 4 * l->s.genus);
    double scale = 0;
    for (size_t f = 0; f < l->l.n_faces; f++)
        for (int k = 0; k < 3; k++) {
            const double *p = l->points + 3 * l->corners[3 * f + (k + 1) % 3];
            const double *q = l->points + 3 * l->corners[3 * f + (k + 2) % 3];
            const double have = distance(p, q, l->s.space), length = side(&l->a, f, k);
            /* A torus has the area of the given surface: one scale for all. */
            if (scale == 0) scale = l->s.space == RICCI_SPACE_E2 ? have / length : 1;
            CHECK(fabs(have - scale * length) < 1e-9 * (1 + have) * exp(l->s.radius < 9 ? l->s.radius : 9));
        }
}

/* The side pairings of the octagon have |tr| = 2 (1 + sqrt 2), and opposite sides are paired. */
static void the_bolza_surface_is_the_regular_octagon(void) {
    ricci_mesh *mesh = NULL;
    ricci_uniform *quotient = NULL;
    ricci_dirichlet *octagon = NULL;
    ricci_deck *sides = NULL;
    ricci_dirichlet_summary d;
    OK(make_bolza(2, &mesh));
    OK(uniformize_at(mesh, 0, &quotient)); /* the centre */
    laid l = laid_of(quotient);
    check_layout(&l);
    CHECK(l.s.genus == 2 && l.s.base == 0 && l.s.n_generators == 4);
    CHECK(fabs(l.s.area - 4 * pi) < 1e-9 && l.s.base_lift[2] == 1);
    OK(ricci_dirichlet_new(quotient, NULL, NULL, &octagon));
    OK(ricci_dirichlet_summarise(octagon, &d, sizeof d));
    CHECK(d.n_sides == 8 && fabs(d.area - 4 * pi) < 1e-9);
    OK(deck_of(quotient, RICCI_DECK_DIRICHLET_SIDES, octagon, &sides));
    elements e = elements_of(sides);
    int32_t partners[8];
    double corners[24];
    OK(ricci_dirichlet_partners(octagon, partners, 8));
    OK(ricci_dirichlet_corners(octagon, corners, 24));
    for (int k = 0; k < 8; k++) {
        CHECK(partners[k] == (k + 4) % 8);
        CHECK(fabs(e.traces[k] - 2 * (1 + sqrt2)) < 1e-9);
        CHECK(fabs(e.lengths[k] - 2 * acosh(1 + sqrt2)) < 1e-9);
        CHECK(fabs(corners[3 * k + 2] - cosh(d.radius)) < 1e-9);
        /* The Moebius matrix is in SU(1, 1), with that trace. */
        const double *m = e.mobius + 8 * k;
        CHECK(m[4] == m[2] && m[5] == -m[3] && m[6] == m[0] && m[7] == -m[1]);
        CHECK(fabs(m[0] * m[0] + m[1] * m[1] - m[2] * m[2] - m[3] * m[3] - 1) < 1e-12);
        CHECK(fabs(2 * fabs(m[0]) - e.traces[k]) < 1e-14 * e.traces[k]);
    }
    elements_free(&e), laid_free(&l);
    ricci_deck_free(sides), ricci_dirichlet_free(octagon);
    ricci_uniform_free(quotient), ricci_mesh_free(mesh);
}

static void a_flat_torus_has_its_modulus(void) {
    /* tau = 0.3 + 1.2 i is reduced; -1 / tau + 2 is the same torus. */
    const double re = 0.3, im = 1.2, norm = re * re + im * im;
    const double shapes[2][2] = {{0.3, 1.2}, {2 - 0.3 / norm, 1.2 / norm}};
    for (int i = 0; i < 2; i++) {
        ricci_mesh *mesh = NULL;
        ricci_uniform *quotient = NULL;
        ricci_deck *generators = NULL;
        OK(make_sized(RICCI_SHAPE_FLAT_TORUS, 6, 5, shapes[i][0], shapes[i][1], 0, &mesh));
        OK(ricci_uniformize(mesh, NULL, NULL, &quotient));
        laid l = laid_of(quotient);
        check_layout(&l);
        CHECK(l.s.space == RICCI_SPACE_E2 && l.s.n_generators == 2 && fabs(l.s.area - shapes[i][1]) < 1e-12);
        CHECK(fabs(l.s.modulus[0] - re) < 1e-12 && fabs(l.s.modulus[1] - im) < 1e-12);
        /* Pure translations that span the area. */
        OK(deck_of(quotient, RICCI_DECK_GENERATORS, NULL, &generators));
        elements e = elements_of(generators);
        for (int k = 0; k < 2; k++) {
            const double *m = e.matrices + 9 * k;
            CHECK(fabs(m[0] - 1) < 1e-12 && fabs(m[1]) < 1e-12 && fabs(m[3]) < 1e-12 &&
                  fabs(m[4] - 1) < 1e-12);
            CHECK(fabs(e.lengths[k] - hypot(m[2], m[5])) < 1e-12);
        }
        const double *a = e.matrices, *b = e.matrices + 9;
        CHECK(fabs(a[2] * b[5] - a[5] * b[2] - l.s.area) < 1e-12);
        elements_free(&e), laid_free(&l);
        ricci_deck_free(generators), ricci_uniform_free(quotient), ricci_mesh_free(mesh);
    }
}

/* Points in all models are those of the hyperboloid, and lead back to it. */
static void models_agree(const ricci_uniform *quotient, const laid *l) {
    const size_t n = l->l.n_points;
    ricci_layout *layout = NULL;
    double *flat[3];
    OK(ricci_uniform_layout(quotient, RICCI_ON_METRIC, RICCI_MODEL_KLEIN, NULL, &layout));
    for (uint32_t m = 0; m < 3; m++) {
        flat[m] = (double *)room(2 * n, sizeof *flat[m]);
        OK(ricci_layout_points(layout, m, flat[m], 2 * n));
        for (size_t i = 0; i < n; i++) {
            const double *p = l->points + 3 * i;
            const double digits = m == RICCI_MODEL_HALF_PLANE ? 1e-13 : 1e-14 * p[2] * p[2];
            double back[3];
            ricci_to_hyperboloid(m, flat[m] + 2 * i, back);
            CHECK(distance(p, back, RICCI_SPACE_H2) < 1e-6 + digits);
            ricci_from_hyperboloid(m, p, back);
            CHECK(memcmp(back, flat[m] + 2 * i, 2 * sizeof *back) == 0);
            ricci_from_hyperboloid(RICCI_MODEL_AMBIENT, p, back);
            CHECK(memcmp(back, p, sizeof back) == 0);
            ricci_to_hyperboloid(RICCI_MODEL_AMBIENT, p, back);
            CHECK(fabs(back[2] - p[2]) < 1e-14 * p[2]);
        }
    }
    for (size_t i = 0; i < n; i++) {
        const double x = flat[0][2 * i], y = flat[0][2 * i + 1], r = x * x + y * y,
                     d = (1 - x) * (1 - x) + y * y;
        CHECK(r < 1 && fabs(flat[1][2 * i] - 2 * x / (1 + r)) < 1e-14);
        CHECK(fabs(flat[1][2 * i + 1] - 2 * y / (1 + r)) < 1e-14);
        /* i (1 + z)/(1 - z) */
        CHECK(fabs(flat[2][2 * i] + 2 * y / d) < 1e-9 && fabs(flat[2][2 * i + 1] - (1 - r) / d) < 1e-9);
    }
    FAILS(ricci_layout_points(layout, 4, flat[0], 2 * n), RICCI_ARGUMENT, "model is 4");
    FAILS(ricci_layout_points(layout, RICCI_MODEL_AMBIENT, flat[0], 2 * n), RICCI_BUFFER_TOO_SMALL, "points");
    FAILS(ricci_layout_uv(layout, RICCI_ON_INPUT, flat[0], 2 * n), RICCI_LAYOUT, "not of the mesh");
    FAILS(ricci_layout_distortion(layout, RICCI_ON_REFINEMENT, flat[0], flat[1], 2 * n), RICCI_LAYOUT,
          "refinement");
    FAILS(ricci_layout_distortion(layout, RICCI_ON_INPUT, flat[0], flat[1], 2 * n), RICCI_LAYOUT,
          "not of the mesh");
    ricci_layout_free(layout);
    for (int m = 0; m < 3; m++) free(flat[m]);
}

/* The layout on the given surface: its vertices come first, seams are glued by the side pairings, files are
 * written. */
static void the_way_back_is_a_layout_like_others(const ricci_uniform *quotient, const ricci_mesh *mesh) {
    ricci_layout *disk = NULL, *klein = NULL;
    ricci_layout_summary s, t;
    ricci_mesh *unrolled = NULL, *file = NULL;
    ricci_metric *metric = NULL;
    ricci_map *map = NULL;
    ricci_map_summary c;
    ricci_charts *charts = NULL;
    arrays given = arrays_of(mesh, 1);
    ricci_uniform_summary q;
    OK(ricci_uniform_summarise(quotient, &q, sizeof q));
    OK(ricci_uniform_layout(quotient, RICCI_ON_REFINEMENT, RICCI_MODEL_POINCARE, NULL, &disk));
    OK(ricci_uniform_layout(quotient, RICCI_ON_REFINEMENT, RICCI_MODEL_KLEIN, NULL, &klein));
    OK(ricci_uniform_metric(quotient, &metric));
    OK(ricci_map_new(metric, NULL, &map));
    OK(ricci_map_summarise(map, &c, sizeof c));
    OK(ricci_layout_summarise(disk, &s, sizeof s));
    OK(ricci_layout_summarise(klein, &t, sizeof t));
    CHECK(s.n_input_vertices == given.n.n_vertices && s.n_vertices == c.n_vertices);
    CHECK(s.n_flipped == 0 && s.n_points == t.n_points && 2 * s.n_seams == q.n_sides && s.qc_mean < 2);
    OK(ricci_layout_mesh(disk, &unrolled));
    arrays r = arrays_of(unrolled, 1);
    CHECK(r.n.genus == q.genus && r.n.euler == given.n.euler);
    CHECK(memcmp(r.positions, given.positions, 3 * given.n.n_vertices * sizeof *r.positions) == 0);
    double *z = (double *)room(2 * s.n_points, sizeof *z), *k = (double *)room(2 * s.n_points, sizeof *k);
    OK(ricci_layout_points(disk, RICCI_MODEL_POINCARE, z, 2 * s.n_points));
    OK(ricci_layout_points(disk, RICCI_MODEL_KLEIN, k, 2 * s.n_points));
    const int hyperbolic = q.space == RICCI_SPACE_H2;
    for (size_t i = 0; i < s.n_points; i++) {
        const double x = z[2 * i], y = z[2 * i + 1], f = hyperbolic ? 2 / (1 + x * x + y * y) : 1;
        CHECK(fabs(k[2 * i] - f * x) < 1e-14 + 1e-14 * fabs(x) &&
              fabs(k[2 * i + 1] - f * y) < 1e-14 + 1e-14 * fabs(y));
    }
    /* Seams run along the cut, from node to node. */
    int32_t *edges = (int32_t *)room(s.n_seam_edges, sizeof *edges);
    size_t *starts = (size_t *)room(s.n_seams + 1, sizeof *starts);
    double *motions = (double *)room(9 * s.n_seams, sizeof *motions);
    OK(ricci_layout_seam_edges(disk, RICCI_ON_REFINEMENT, edges, s.n_seam_edges, starts, s.n_seams + 1));
    CHECK(starts[s.n_seams] == s.n_seam_edges);
    for (size_t i = 0; i < s.n_seams; i++)
        for (size_t j = starts[i]; j + 1 < starts[i + 1]; j++) {
            const size_t tip = 2 * (size_t)(abs(edges[j]) - 1) + (edges[j] > 0);
            const size_t next = 2 * (size_t)(abs(edges[j + 1]) - 1) + (edges[j + 1] < 0);
            CHECK(r.ends[tip] == r.ends[next]);
        }
    if (hyperbolic) {
        FAILS(ricci_layout_seams(disk, motions, 9 * s.n_seams - 1), RICCI_BUFFER_TOO_SMALL, "seams");
        FAILS(ricci_layout_write(disk, RICCI_ON_REFINEMENT, 1, "never.obj"), RICCI_LAYOUT,
              "RICCI_MODEL_KLEIN");
    } else {
        /* Left sides are carried onto right sides: the start of an edge is the tip of its twin. */
        uint32_t *corners = (uint32_t *)room(3 * s.n_faces, sizeof *corners);
        size_t *origin = (size_t *)room(2 * r.n.n_edges, sizeof *origin);
        size_t *tip = (size_t *)room(2 * r.n.n_edges, sizeof *tip);
        OK(ricci_layout_seams(disk, motions, 9 * s.n_seams));
        OK(ricci_layout_corners(disk, RICCI_ON_REFINEMENT, corners, 3 * s.n_faces));
        for (size_t f = 0; f < s.n_faces; f++)
            for (size_t c = 0; c < 3; c++) {
                const size_t h = halfedge(r.face_edges[3 * f + c]);
                origin[h] = corners[3 * f + (c + 1) % 3], tip[h] = corners[3 * f + (c + 2) % 3];
            }
        for (size_t i = 0; i < s.n_seams; i++)
            for (size_t j = starts[i]; j < starts[i + 1]; j++) {
                const double *left = z + 2 * origin[halfedge(edges[j])],
                             *right = z + 2 * tip[halfedge(-edges[j])];
                const double x = left[0] + motions[9 * i + 2], y = left[1] + motions[9 * i + 3];
                CHECK(motions[9 * i] == 1 && motions[9 * i + 1] == 0 &&
                      hypot(x - right[0], y - right[1]) < 1e-12 * s.diameter);
            }
        free(corners), free(origin), free(tip);
    }
    /* Cut along edges of the mesh, its own corners have coordinates too. */
    ricci_layout *own = NULL;
    ricci_layout_summary o;
    OK(ricci_layout_new(metric, NULL, NULL, &own));
    OK(ricci_layout_summarise(own, &o, sizeof o));
    double *uv = (double *)room(6 * o.n_input_faces, sizeof *uv);
    OK(ricci_layout_uv(own, RICCI_ON_INPUT, uv, 6 * o.n_input_faces));
    CHECK(o.n_flipped == 0 && o.n_input_faces == given.n.n_faces && fabs(o.area - q.area) < 1e-9 * q.area);
    for (size_t i = 0; i < 6 * o.n_input_faces; i++) CHECK(isfinite(uv[i]) && fabs(uv[i]) <= o.diameter);
    free(uv), ricci_layout_free(own);
    OK(ricci_layout_write(disk, RICCI_ON_REFINEMENT, 0, "quotient_disk.obj"));
    OK(ricci_layout_write(klein, RICCI_ON_REFINEMENT, 1, "quotient_klein.obj"));
    OK(ricci_mesh_read("quotient_disk.obj", &file));
    ricci_mesh_summary m;
    OK(ricci_mesh_summarise(file, &m, sizeof m));
    CHECK(m.n_vertices == s.n_vertices && m.n_faces == s.n_faces && m.n_uv == s.n_faces);
    OK(ricci_charts_new(disk, 1.0 / 256, NULL, &charts));
    ricci_charts_free(charts);
    FAILS(ricci_uniform_layout(quotient, RICCI_ON_METRIC, RICCI_MODEL_AMBIENT, NULL, &klein), RICCI_ARGUMENT,
          "two coordinates");
    FAILS(ricci_uniform_layout(quotient, RICCI_ON_INPUT, RICCI_MODEL_KLEIN, NULL, &klein), RICCI_LAYOUT,
          "REFINEMENT");
    printf("genus %zu: %zu + %zu vertices, qc mean %.3f max %.3f\n", q.genus, s.n_input_vertices,
           c.n_crossings, s.qc_mean, s.qc_max);
    free(z), free(k), free(edges), free(starts), free(motions);
    arrays_free(&given), arrays_free(&r);
    ricci_mesh_free(file), ricci_mesh_free(unrolled);
    ricci_layout_free(disk), ricci_layout_free(klein), ricci_map_free(map), ricci_metric_free(metric);
}

static void surfaces_in_space_come_back_as_layouts(void) {
    torus t = torus_new(16, 10);
    ricci_mesh *meshes[2] = {torus_mesh(&t), NULL};
    OK(make_genus(2, 2, 1, &meshes[1]));
    for (int i = 0; i < 2; i++) {
        ricci_uniform *quotient = NULL;
        OK(ricci_uniformize(meshes[i], NULL, NULL, &quotient));
        laid l = laid_of(quotient);
        check_layout(&l);
        if (l.s.genus == 2) {
            CHECK(fabs(l.s.area - 4 * pi) < 1e-9 && l.s.modulus[0] != l.s.modulus[0]);
            models_agree(quotient, &l);
        }
        the_way_back_is_a_layout_like_others(quotient, meshes[i]);
        laid_free(&l);
        ricci_uniform_free(quotient), ricci_mesh_free(meshes[i]);
    }
    torus_free(&t);
}

static int same(const laid *l, const laid *m) {
    return l->l.n_points == m->l.n_points && l->s.base == m->s.base &&
           memcmp(l->points, m->points, 3 * l->l.n_points * sizeof *l->points) == 0;
}

/* From the mesh, from its lengths, from a metric and its handle: one result, also for any number of threads.
 */
static void every_way_in_and_any_threads_give_the_same_bits(void) {
    ricci_mesh *mesh = NULL, *measured = NULL;
    ricci_metric *metric = NULL, *end = NULL, *last_metric = NULL;
    ricci_report_summary did;
    ricci_metric_summary m;
    ricci_uniform *all[5] = {NULL, NULL, NULL, NULL, NULL};
    ricci_uniform_options options;
    ricci_flow_options flow;
    OK(make_genus(2, 2, 1.5, &mesh));
    arrays a = arrays_of(mesh, 0);
    INIT(options), INIT(flow);
    options.flow = &flow;
    flow.threads = 1;
    OK(ricci_uniformize(mesh, &options, NULL, &all[0]));
    flow.threads = 3;
    OK(ricci_uniformize(mesh, &options, NULL, &all[1]));
    OK(ricci_mesh_with_lengths(mesh, a.lengths, a.n.n_edges, RICCI_SPACE_E2, &measured));
    OK(ricci_uniformize(measured, NULL, NULL, &all[2]));
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_H2, &metric));
    options.start = metric;
    OK(ricci_uniformize(NULL, &options, NULL, &all[3]));
    /* On from its own end there is nothing to do. */
    OK(ricci_uniform_metric(all[0], &end));
    options.start = end;
    OK(ricci_uniformize(NULL, &options, NULL, &all[4]));
    OK(ricci_uniform_metric(all[4], &last_metric));
    OK(ricci_report_summarise(last_metric, &did, sizeof did));
    OK(ricci_metric_summarise(end, &m, sizeof m));
    CHECK(did.converged && did.iterations == 0 && m.space == RICCI_SPACE_H2);
    double *curvature = (double *)room(m.n_vertices, sizeof *curvature);
    OK(ricci_metric_values(end, RICCI_METRIC_CURVATURE, curvature, m.n_vertices));
    for (size_t v = 0; v < m.n_vertices; v++) CHECK(fabs(curvature[v]) < 1e-10);
    laid first = laid_of(all[0]), last = laid_of(all[4]);
    for (int i = 1; i < 4; i++) {
        laid other = laid_of(all[i]);
        CHECK(same(&first, &other));
        laid_free(&other);
    }
    CHECK(fabs(first.s.radius - last.s.radius) < 1e-9 && last.s.converged);
    /* The scheme and the base are those asked for. */
    ricci_uniform *packing = NULL;
    const uint32_t seven = 7;
    options.scheme = RICCI_SCHEME_INVERSIVE, options.base = &seven, options.start = NULL;
    OK(ricci_uniformize(mesh, &options, NULL, &packing));
    laid p = laid_of(packing);
    CHECK(p.s.base == 7 && p.s.converged && !same(&first, &p));
    for (int i = 0; i < 5; i++) ricci_uniform_free(all[i]);
    laid_free(&first), laid_free(&last), laid_free(&p);
    free(curvature), arrays_free(&a);
    ricci_uniform_free(packing), ricci_metric_free(last_metric);
    ricci_metric_free(end), ricci_metric_free(metric), ricci_mesh_free(measured), ricci_mesh_free(mesh);
}

/* One call: spheres on the sphere, all others as quotients. */
static void one_call_takes_every_closed_surface(void) {
    ricci_mesh *meshes[3] = {NULL, NULL, NULL}, *disk = NULL;
    const uint32_t spaces[3] = {RICCI_SPACE_S2, RICCI_SPACE_E2, RICCI_SPACE_H2};
    ricci_uniform *none = NULL;
    ricci_uniform_options options;
    OK(make_sphere(3, &meshes[0]));
    OK(make_sized(RICCI_SHAPE_TORUS, 9, 7, 2, 1, 0, &meshes[1]));
    OK(make_genus(2, 1, 1, &meshes[2]));
    OK(make_disk(2, &disk));
    for (size_t i = 0; i < 3; i++) {
        ricci_uniform *uniform = NULL;
        ricci_uniform_summary s;
        ricci_homotopy *basis = NULL;
        double x[3];
        OK(ricci_uniformize(meshes[i], NULL, NULL, &uniform));
        OK(ricci_uniform_summarise(uniform, &s, sizeof s));
        CHECK(s.converged && s.genus == i && s.space == spaces[i] &&
              strcmp(s.stop_reason_text, "converged") == 0);
        if (i == 0) {
            FAILS(ricci_uniform_homotopy(uniform, &basis), RICCI_LAYOUT, "sphere");
        } else {
            FAILS(ricci_sphere_points(uniform, RICCI_MODEL_AMBIENT, x, 3), RICCI_LAYOUT, "no sphere");
        }
        ricci_uniform_free(uniform);
    }
    INIT(options);
    options.scheme = RICCI_SCHEME_INVERSIVE;
    FAILS(ricci_uniformize(disk, NULL, NULL, &none), RICCI_LAYOUT, "disk");
    FAILS(ricci_uniformize(meshes[0], &options, NULL, &none), RICCI_ARGUMENT, "yamabe");
    FAILS(ricci_uniformize(meshes[0], NULL, NULL, NULL), RICCI_NULL_POINTER, "uniform");
    CHECK(none == NULL);
    for (int i = 0; i < 3; i++) ricci_mesh_free(meshes[i]);
    ricci_mesh_free(disk);
}

static void what_is_no_quotient_is_refused(void) {
    ricci_mesh *bolza = NULL, *other_mesh = NULL;
    ricci_metric *flat = NULL;
    ricci_control *control = NULL;
    ricci_uniform *quotient = NULL, *sound = NULL, *other = NULL;
    ricci_dirichlet *dirichlet = NULL, *foreign = NULL;
    ricci_deck *deck = NULL;
    ricci_uniform_options options;
    ricci_flow_options flow;
    ricci_uniform_summary s;
    const uint32_t beyond = 1000000;
    double x[3] = {0, 0, 0};
    OK(make_bolza(1, &bolza));
    FAILS(ricci_uniformize(NULL, NULL, NULL, &quotient), RICCI_NULL_POINTER, "mesh");
    OK(ricci_metric_new(bolza, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &flat));
    INIT(options), INIT(flow);
    options.start = flat;
    FAILS(ricci_uniformize(NULL, &options, NULL, &quotient), RICCI_LAYOUT, "in h2");
    options.start = NULL, options.base = &beyond;
    FAILS(ricci_uniformize(bolza, &options, NULL, &quotient), RICCI_ARGUMENT, "1000000");
    options.base = NULL, options.scheme = 9;
    FAILS(ricci_uniformize(bolza, &options, NULL, &quotient), RICCI_ARGUMENT, "scheme is 9");
    options.scheme = RICCI_SCHEME_YAMABE, options.flow = &flow, flow.size = 3;
    FAILS(ricci_uniformize(bolza, &options, NULL, &quotient), RICCI_STRUCT_SIZE, "size 3");
    options.size = 5;
    FAILS(ricci_uniformize(bolza, &options, NULL, &quotient), RICCI_STRUCT_SIZE, "size 5");
    OK(ricci_control_new(&control));
    OK(ricci_control_cancel(control));
    FAILS(ricci_uniformize(bolza, NULL, control, &quotient), RICCI_CANCELLED, "");
    CHECK(quotient == NULL);
    OK(ricci_uniformize(bolza, NULL, NULL, &sound));
    FAILS(ricci_uniform_summarise(sound, NULL, sizeof s), RICCI_NULL_POINTER, "summary");
    FAILS(ricci_uniform_summarise(sound, &s, 8), RICCI_STRUCT_SIZE, "size 8");
    FAILS(ricci_uniform_polygon(sound, x, x, 1), RICCI_BUFFER_TOO_SMALL, "8 entries");
    FAILS(ricci_dirichlet_new(sound, NULL, control, &dirichlet), RICCI_CANCELLED, "");
    x[0] = HUGE_VAL;
    FAILS(ricci_dirichlet_new(sound, x, NULL, &dirichlet), RICCI_ARGUMENT, "finite");
    FAILS(deck_of(sound, RICCI_DECK_GENERATORS, NULL, NULL), RICCI_NULL_POINTER, "deck");
    FAILS(deck_of(NULL, RICCI_DECK_GENERATORS, NULL, &deck), RICCI_NULL_POINTER, "uniform");
    FAILS(deck_of(sound, 7, NULL, &deck), RICCI_ARGUMENT, "kind is 7");
    FAILS(deck_of(sound, RICCI_DECK_DIRICHLET_SIDES, NULL, &deck), RICCI_NULL_POINTER, "dirichlet");
    OK(make_genus(2, 1, 1, &other_mesh));
    OK(ricci_uniformize(other_mesh, NULL, NULL, &other));
    OK(ricci_dirichlet_new(other, NULL, NULL, &foreign));
    FAILS(deck_of(sound, RICCI_DECK_DIRICHLET_SIDES, foreign, &deck), RICCI_ARGUMENT, "another surface");
    CHECK(dirichlet == NULL && deck == NULL);
    ricci_uniform_free(NULL), ricci_dirichlet_free(NULL), ricci_deck_free(NULL), ricci_charts_free(NULL);
    ricci_uniform_free(sound), ricci_uniform_free(other), ricci_dirichlet_free(foreign);
    ricci_control_free(control), ricci_metric_free(flat);
    ricci_mesh_free(bolza), ricci_mesh_free(other_mesh);
}

int main(void) {
    the_bolza_surface_is_the_regular_octagon();
    a_flat_torus_has_its_modulus();
    surfaces_in_space_come_back_as_layouts();
    every_way_in_and_any_threads_give_the_same_bits();
    one_call_takes_every_closed_surface();
    what_is_no_quotient_is_refused();
    return 0;
}
