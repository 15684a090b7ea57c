/* Closed surfaces as quotients: known deck groups and moduli, layouts in every model and back on the given
 * mesh. */
#include "quotient.h"

static const double sqrt2 = 1.41421356237309504880;

/* Every face of the layout has the sides of the metric, and is counterclockwise. */
static void check_layout(const laid *l) {
    CHECK(l->s.converged && l->s.n_flipped == 0 && l->s.n_broken == 0 && l->s.angle_defect < 1e-14);
    CHECK(l->s.disagreement < 1e-11 && l->s.side_residual < 1e-12 && l->s.relation_residual < 1e-12);
    CHECK(l->s.n_sides == 2 * l->s.n_segments && l->s.n_polygon == 4 * l->s.genus);
    double scale = 0;
    for (size_t f = 0; f < l->s.n_faces; f++)
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
    ricci_quotient *quotient = NULL;
    ricci_dirichlet *octagon = NULL;
    ricci_deck *sides = NULL;
    ricci_uniformize_options options;
    ricci_dirichlet_summary d;
    OK(ricci_shape_bolza(2, &mesh));
    OK(ricci_uniformize_options_init(&options, sizeof options));
    options.base = 0; /* the centre */
    OK(ricci_quotient_new(mesh, &options, NULL, &quotient));
    laid l = laid_of(quotient);
    check_layout(&l);
    CHECK(l.s.genus == 2 && l.s.base == 0 && l.s.n_generators == 4);
    CHECK(fabs(l.s.area - 4 * pi) < 1e-9 && l.s.base_lift[2] == 1);
    OK(ricci_dirichlet_new(quotient, NULL, NULL, &octagon));
    OK(ricci_dirichlet_summarise(octagon, &d, sizeof d));
    CHECK(d.n_sides == 8 && fabs(d.area - 4 * pi) < 1e-9);
    OK(ricci_dirichlet_sides(octagon, &sides));
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
    ricci_quotient_free(quotient), ricci_mesh_free(mesh);
}

static void a_flat_torus_has_its_modulus(void) {
    /* tau = 0.3 + 1.2 i is reduced; -1 / tau + 2 is the same torus. */
    const double re = 0.3, im = 1.2, norm = re * re + im * im;
    const double shapes[2][2] = {{0.3, 1.2}, {2 - 0.3 / norm, 1.2 / norm}};
    for (int i = 0; i < 2; i++) {
        ricci_mesh *mesh = NULL;
        ricci_quotient *quotient = NULL;
        ricci_deck *generators = NULL;
        double tau[2];
        OK(ricci_shape_flat_torus(shapes[i][0], shapes[i][1], 6, 5, &mesh));
        OK(ricci_quotient_new(mesh, NULL, NULL, &quotient));
        laid l = laid_of(quotient);
        check_layout(&l);
        CHECK(l.s.space == RICCI_SPACE_E2 && l.s.n_generators == 2 && fabs(l.s.area - shapes[i][1]) < 1e-12);
        OK(ricci_quotient_modulus(quotient, tau, 2));
        CHECK(fabs(tau[0] - re) < 1e-12 && fabs(tau[1] - im) < 1e-12);
        /* Pure translations that span the area. */
        OK(ricci_quotient_generators(quotient, &generators));
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
        ricci_deck_free(generators), ricci_quotient_free(quotient), ricci_mesh_free(mesh);
    }
}

/* Points in all models are those of the hyperboloid, and lead back to it. */
static void models_agree(const ricci_quotient *quotient, const laid *l) {
    const size_t n = l->s.n_points;
    double *flat[3], *back = (double *)room(3 * n, sizeof *back);
    for (int m = 0; m < 3; m++) {
        flat[m] = (double *)room(2 * n, sizeof *flat[m]);
        OK(ricci_quotient_points(quotient, (ricci_model)m, flat[m], 2 * n));
        OK(ricci_model_to_hyperboloid((ricci_model)m, flat[m], n, back, 3 * n));
        for (size_t i = 0; i < n; i++) {
            const double *p = l->points + 3 * i;
            const double digits = m == RICCI_MODEL_HALF_PLANE ? 1e-13 : 1e-14 * p[2] * p[2];
            CHECK(distance(p, back + 3 * i, RICCI_SPACE_H2) < 1e-6 + digits);
        }
        OK(ricci_model_from_hyperboloid((ricci_model)m, l->points, n, back, 3 * n));
        CHECK(memcmp(back, flat[m], 2 * n * sizeof *back) == 0);
    }
    for (size_t i = 0; i < n; i++) {
        const double x = flat[0][2 * i], y = flat[0][2 * i + 1], r = x * x + y * y,
                     d = (1 - x) * (1 - x) + y * y;
        CHECK(r < 1 && fabs(flat[1][2 * i] - 2 * x / (1 + r)) < 1e-14);
        CHECK(fabs(flat[1][2 * i + 1] - 2 * y / (1 + r)) < 1e-14);
        /* i (1 + z)/(1 - z) */
        CHECK(fabs(flat[2][2 * i] + 2 * y / d) < 1e-9 && fabs(flat[2][2 * i + 1] - (1 - r) / d) < 1e-9);
    }
    FAILS(ricci_model_from_hyperboloid((ricci_model)4, l->points, n, back, 3 * n), RICCI_ARGUMENT,
          "model is 4");
    FAILS(ricci_model_from_hyperboloid(RICCI_MODEL_KLEIN, NULL, n, back, 3 * n), RICCI_NULL_POINTER,
          "points");
    FAILS(ricci_model_from_hyperboloid(RICCI_MODEL_KLEIN, flat[1], 1, back, 1), RICCI_ARGUMENT, "row 0");
    FAILS(ricci_model_to_hyperboloid(RICCI_MODEL_POINCARE, flat[0], n, back, 3 * n - 1),
          RICCI_BUFFER_TOO_SMALL, "points");
    flat[0][2] = 1, flat[0][3] = 0;
    FAILS(ricci_model_to_hyperboloid(RICCI_MODEL_POINCARE, flat[0], n, back, 3 * n), RICCI_ARGUMENT, "row 1");
    for (int m = 0; m < 3; m++) free(flat[m]);
    free(back);
}

/* The layout on the given surface: its vertices come first, seams are glued by the side pairings, files are
 * written. */
static void the_way_back_is_a_layout_like_others(const ricci_quotient *quotient, const ricci_mesh *mesh) {
    ricci_layout *disk = NULL, *klein = NULL;
    ricci_layout_summary s, t;
    ricci_mesh *unrolled = NULL, *file = NULL;
    ricci_charts *charts = NULL;
    arrays given = arrays_of(mesh, 1);
    ricci_quotient_summary q;
    OK(ricci_quotient_summarise(quotient, &q, sizeof q));
    OK(ricci_quotient_layout(quotient, RICCI_MODEL_POINCARE, NULL, &disk));
    OK(ricci_quotient_layout(quotient, RICCI_MODEL_KLEIN, NULL, &klein));
    OK(ricci_layout_summarise(disk, &s, sizeof s));
    OK(ricci_layout_summarise(klein, &t, sizeof t));
    CHECK(s.n_given_vertices == given.n.n_vertices && s.n_vertices == s.n_given_vertices + s.n_crossings);
    CHECK(s.n_flipped == 0 && s.n_points == t.n_points && s.n_seams == q.n_segments && s.qc_mean < 2);
    CHECK(s.n_seam_edges >= q.n_cut_edges);
    OK(ricci_layout_mesh(disk, &unrolled));
    arrays r = arrays_of(unrolled, 1);
    CHECK(r.n.genus == q.genus && r.n.euler == given.n.euler);
    CHECK(memcmp(r.positions, given.positions, 3 * given.n.n_vertices * sizeof *r.positions) == 0);
    double *z = (double *)room(2 * s.n_points, sizeof *z), *k = (double *)room(2 * s.n_points, sizeof *k);
    OK(ricci_layout_points(disk, z, 2 * s.n_points));
    OK(ricci_layout_points(klein, k, 2 * s.n_points));
    const int hyperbolic = q.space == RICCI_SPACE_H2;
    for (size_t i = 0; i < s.n_points; i++) {
        const double x = z[2 * i], y = z[2 * i + 1], f = hyperbolic ? 2 / (1 + x * x + y * y) : 1;
        CHECK(fabs(k[2 * i] - f * x) < 1e-14 + 1e-14 * fabs(x) &&
              fabs(k[2 * i + 1] - f * y) < 1e-14 + 1e-14 * fabs(y));
    }
    /* Seams run along the cut, from node to node. */
    int32_t *edges = (int32_t *)room(s.n_seam_edges, sizeof *edges);
    size_t *starts = (size_t *)room(s.n_seams + 1, sizeof *starts);
    double *motions = (double *)room(4 * s.n_seams, sizeof *motions);
    OK(ricci_layout_seam_edges(disk, edges, s.n_seam_edges, starts, s.n_seams + 1));
    CHECK(starts[s.n_seams] == s.n_seam_edges);
    for (size_t i = 0; i < s.n_seams; i++)
        for (size_t j = starts[i]; j + 1 < starts[i + 1]; j++) {
            const size_t tip = 2 * (size_t)(abs(edges[j]) - 1) + (edges[j] > 0);
            const size_t next = 2 * (size_t)(abs(edges[j + 1]) - 1) + (edges[j + 1] < 0);
            CHECK(r.ends[tip] == r.ends[next]);
        }
    if (hyperbolic) {
        FAILS(ricci_layout_seams(disk, motions, 4 * s.n_seams), RICCI_LAYOUT, "ricci_quotient_sides");
        FAILS(ricci_layout_weights(klein, z, s.n_vertices), RICCI_LAYOUT, "projective");
        FAILS(ricci_layout_write_obj_homogeneous(disk, "never.obj"), RICCI_LAYOUT, "RICCI_MODEL_KLEIN");
    } else {
        /* Left sides are carried onto right sides: the start of an edge is the tip of its twin. */
        uint32_t *corners = (uint32_t *)room(3 * s.n_faces, sizeof *corners);
        size_t *origin = (size_t *)room(2 * r.n.n_edges, sizeof *origin);
        size_t *tip = (size_t *)room(2 * r.n.n_edges, sizeof *tip);
        OK(ricci_layout_seams(disk, motions, 4 * s.n_seams));
        OK(ricci_layout_corners(disk, corners, 3 * s.n_faces));
        for (size_t f = 0; f < s.n_faces; f++)
            for (size_t c = 0; c < 3; c++) {
                const size_t h = halfedge(r.face_edges[3 * f + c]);
                origin[h] = corners[3 * f + (c + 1) % 3], tip[h] = corners[3 * f + (c + 2) % 3];
            }
        for (size_t i = 0; i < s.n_seams; i++)
            for (size_t j = starts[i]; j < starts[i + 1]; j++) {
                const double *left = z + 2 * origin[halfedge(edges[j])],
                             *right = z + 2 * tip[halfedge(-edges[j])];
                const double x = left[0] + motions[4 * i + 1], y = left[1] + motions[4 * i + 2];
                CHECK(motions[4 * i] == 0 && hypot(x - right[0], y - right[1]) < 1e-12 * s.diameter);
            }
        free(corners), free(origin), free(tip);
    }
    OK(ricci_layout_write_obj(disk, "quotient_disk.obj"));
    OK(ricci_layout_write_obj_homogeneous(klein, "quotient_klein.obj"));
    OK(ricci_mesh_read("quotient_disk.obj", &file));
    ricci_mesh_summary m;
    OK(ricci_mesh_summarise(file, &m, sizeof m));
    CHECK(m.n_vertices == s.n_vertices && m.n_faces == s.n_faces && m.n_uv == s.n_faces);
    OK(ricci_charts_new(disk, 1.0 / 256, NULL, &charts));
    ricci_charts_free(charts);
    FAILS(ricci_quotient_layout(quotient, RICCI_MODEL_HYPERBOLOID, NULL, &disk), RICCI_ARGUMENT,
          "two coordinates");
    printf("genus %zu: %zu + %zu vertices, qc mean %.3f max %.3f\n", q.genus, s.n_given_vertices,
           s.n_crossings, s.qc_mean, s.qc_max);
    free(z), free(k), free(edges), free(starts), free(motions);
    arrays_free(&given), arrays_free(&r);
    ricci_mesh_free(file), ricci_mesh_free(unrolled);
    ricci_layout_free(disk), ricci_layout_free(klein);
}

static void surfaces_in_space_come_back_as_layouts(void) {
    torus t = torus_new(16, 10);
    ricci_mesh *meshes[2] = {torus_mesh(&t), NULL};
    OK(ricci_shape_genus(2, 2, 1, &meshes[1]));
    for (int i = 0; i < 2; i++) {
        ricci_quotient *quotient = NULL;
        OK(ricci_quotient_new(meshes[i], NULL, NULL, &quotient));
        laid l = laid_of(quotient);
        check_layout(&l);
        if (l.s.genus == 2) {
            double tau[2];
            CHECK(fabs(l.s.area - 4 * pi) < 1e-9);
            models_agree(quotient, &l);
            FAILS(ricci_quotient_modulus(quotient, tau, 2), RICCI_LAYOUT, "torus");
        }
        the_way_back_is_a_layout_like_others(quotient, meshes[i]);
        laid_free(&l);
        ricci_quotient_free(quotient), ricci_mesh_free(meshes[i]);
    }
    torus_free(&t);
}

static int same(const laid *l, const laid *m) {
    return l->s.n_points == m->s.n_points && l->s.base == m->s.base &&
           memcmp(l->points, m->points, 3 * l->s.n_points * sizeof *l->points) == 0;
}

/* From the mesh, from its lengths, from a metric and its handle: one result, also for any number of threads.
 */
static void every_way_in_and_any_threads_give_the_same_bits(void) {
    ricci_mesh *mesh = NULL;
    ricci_metric *metric = NULL, *end = NULL;
    ricci_report *report = NULL;
    ricci_report_summary did;
    ricci_metric_summary m;
    ricci_quotient *all[5] = {NULL, NULL, NULL, NULL, NULL};
    ricci_uniformize_options options;
    OK(ricci_shape_genus(2, 2, 1.5, &mesh));
    arrays a = arrays_of(mesh, 0);
    OK(ricci_uniformize_options_init(&options, sizeof options));
    CHECK(options.base == -1 && options.tolerance == 1e-10 && options.threads == 0);
    options.threads = 1;
    OK(ricci_quotient_new(mesh, &options, NULL, &all[0]));
    options.threads = 3;
    OK(ricci_quotient_new(mesh, &options, NULL, &all[1]));
    OK(ricci_quotient_from_lengths(mesh, a.lengths, a.n.n_edges, RICCI_SPACE_E2, NULL, NULL, &all[2]));
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_H2, &metric));
    OK(ricci_quotient_from_metric(metric, NULL, NULL, &all[3]));
    /* On from its own end there is nothing to do. */
    OK(ricci_quotient_metric(all[0], &end));
    OK(ricci_quotient_from_metric(end, NULL, NULL, &all[4]));
    OK(ricci_quotient_report(all[4], &report));
    OK(ricci_report_summarise(report, &did, sizeof did));
    OK(ricci_metric_summarise(end, &m, sizeof m));
    CHECK(did.converged && did.iterations == 0 && m.space == RICCI_SPACE_H2);
    double *curvature = (double *)room(m.n_vertices, sizeof *curvature);
    OK(ricci_metric_curvature(end, curvature, m.n_vertices));
    for (size_t v = 0; v < m.n_vertices; v++) CHECK(fabs(curvature[v]) < 1e-10);
    laid first = laid_of(all[0]), last = laid_of(all[4]);
    for (int i = 1; i < 4; i++) {
        laid other = laid_of(all[i]);
        CHECK(same(&first, &other));
        laid_free(&other);
    }
    CHECK(fabs(first.s.radius - last.s.radius) < 1e-9 && last.s.converged);
    /* The scheme and the base are those asked for. */
    ricci_quotient *packing = NULL;
    options.scheme = RICCI_SCHEME_INVERSIVE, options.base = 7;
    OK(ricci_quotient_new(mesh, &options, NULL, &packing));
    laid p = laid_of(packing);
    CHECK(p.s.base == 7 && p.s.converged && !same(&first, &p));
    for (int i = 0; i < 5; i++) ricci_quotient_free(all[i]);
    laid_free(&first), laid_free(&last), laid_free(&p);
    free(curvature), arrays_free(&a);
    ricci_quotient_free(packing), ricci_report_free(report);
    ricci_metric_free(end), ricci_metric_free(metric), ricci_mesh_free(mesh);
}

/* One call: spheres on the sphere, all others as quotients, with the results of the calls for one kind. */
static void one_call_takes_every_closed_surface(void) {
    ricci_mesh *meshes[3] = {NULL, NULL, NULL}, *disk = NULL;
    OK(ricci_shape_sphere(3, &meshes[0]));
    OK(ricci_shape_torus(2, 1, 9, 7, &meshes[1]));
    OK(ricci_shape_genus(2, 1, 1, &meshes[2]));
    for (size_t i = 0; i < 3; i++) {
        ricci_sphere *sphere = (ricci_sphere *)&meshes, *same_sphere = NULL;
        ricci_quotient *quotient = (ricci_quotient *)&meshes, *same_quotient = NULL;
        OK(ricci_uniformize(meshes[i], NULL, NULL, &sphere, &quotient));
        CHECK((sphere != NULL) == (i == 0) && (quotient != NULL) == (i > 0));
        if (sphere) {
            ricci_sphere_summary s;
            OK(ricci_sphere_new(meshes[i], NULL, NULL, &same_sphere));
            OK(ricci_sphere_summarise(sphere, &s, sizeof s));
            double *x = (double *)room(3 * s.n_vertices, sizeof *x),
                   *y = (double *)room(3 * s.n_vertices, sizeof *y);
            OK(ricci_sphere_positions(sphere, x, 3 * s.n_vertices));
            OK(ricci_sphere_positions(same_sphere, y, 3 * s.n_vertices));
            CHECK(s.converged && memcmp(x, y, 3 * s.n_vertices * sizeof *x) == 0);
            free(x), free(y);
        } else {
            OK(ricci_quotient_new(meshes[i], NULL, NULL, &same_quotient));
            laid l = laid_of(quotient), m = laid_of(same_quotient);
            CHECK(l.s.genus == i && same(&l, &m));
            laid_free(&l), laid_free(&m);
        }
        ricci_sphere_free(sphere), ricci_sphere_free(same_sphere);
        ricci_quotient_free(quotient), ricci_quotient_free(same_quotient);
    }
    ricci_sphere *sphere = NULL;
    ricci_quotient *quotient = NULL;
    ricci_uniformize_options options;
    OK(ricci_uniformize_options_init(&options, sizeof options));
    options.scheme = RICCI_SCHEME_INVERSIVE;
    OK(ricci_shape_disk(2, &disk));
    FAILS(ricci_uniformize(disk, NULL, NULL, &sphere, &quotient), RICCI_LAYOUT, "closed");
    FAILS(ricci_uniformize(meshes[0], &options, NULL, &sphere, &quotient), RICCI_ARGUMENT, "yamabe");
    FAILS(ricci_uniformize(meshes[0], NULL, NULL, NULL, &quotient), RICCI_NULL_POINTER, "sphere");
    FAILS(ricci_uniformize(meshes[0], NULL, NULL, &sphere, NULL), RICCI_NULL_POINTER, "quotient");
    CHECK(sphere == NULL && quotient == NULL);
    for (int i = 0; i < 3; i++) ricci_mesh_free(meshes[i]);
    ricci_mesh_free(disk);
}

static void what_is_no_quotient_is_refused(void) {
    ricci_mesh *sphere = NULL, *disk = NULL, *bolza = NULL;
    ricci_metric *flat = NULL;
    ricci_control *control = NULL;
    ricci_quotient *quotient = NULL, *sound = NULL;
    ricci_dirichlet *dirichlet = NULL;
    ricci_deck *deck = NULL;
    ricci_uniformize_options options;
    ricci_quotient_summary s;
    double x[3] = {0, 0, 0};
    OK(ricci_shape_sphere(2, &sphere));
    OK(ricci_shape_disk(2, &disk));
    OK(ricci_shape_bolza(1, &bolza));
    FAILS(ricci_quotient_new(sphere, NULL, NULL, &quotient), RICCI_LAYOUT, "genus 1 and more");
    FAILS(ricci_quotient_new(disk, NULL, NULL, &quotient), RICCI_LAYOUT, "closed");
    FAILS(ricci_quotient_new(NULL, NULL, NULL, &quotient), RICCI_NULL_POINTER, "mesh");
    FAILS(ricci_quotient_new(bolza, NULL, NULL, NULL), RICCI_NULL_POINTER, "quotient");
    FAILS(ricci_quotient_from_lengths(bolza, x, 3, RICCI_SPACE_E2, NULL, NULL, &quotient), RICCI_WRONG_SIZE,
          "lengths");
    OK(ricci_metric_new(bolza, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &flat));
    FAILS(ricci_quotient_from_metric(flat, NULL, NULL, &quotient), RICCI_LAYOUT, "in h2");
    FAILS(ricci_uniformize_options_init(&options, 8), RICCI_STRUCT_SIZE, "size 8");
    OK(ricci_uniformize_options_init(&options, sizeof options));
    options.base = 1000000;
    FAILS(ricci_quotient_new(bolza, &options, NULL, &quotient), RICCI_ARGUMENT, "1000000");
    options.base = -2;
    FAILS(ricci_quotient_new(bolza, &options, NULL, &quotient), RICCI_ARGUMENT, "base is -2");
    options.base = -1, options.scheme = (ricci_scheme)9;
    FAILS(ricci_quotient_new(bolza, &options, NULL, &quotient), RICCI_ARGUMENT, "scheme is 9");
    options.scheme = RICCI_SCHEME_YAMABE, options.size = 3;
    FAILS(ricci_quotient_new(bolza, &options, NULL, &quotient), RICCI_STRUCT_SIZE, "size 3");
    OK(ricci_control_new(&control));
    OK(ricci_control_cancel(control));
    FAILS(ricci_quotient_new(bolza, NULL, control, &quotient), RICCI_CANCELLED, "");
    CHECK(quotient == NULL);
    OK(ricci_quotient_new(bolza, NULL, NULL, &sound));
    FAILS(ricci_quotient_summarise(sound, NULL, sizeof s), RICCI_NULL_POINTER, "summary");
    FAILS(ricci_quotient_points(sound, RICCI_MODEL_KLEIN, x, 2), RICCI_BUFFER_TOO_SMALL, "points");
    FAILS(ricci_quotient_points(NULL, RICCI_MODEL_KLEIN, x, 2), RICCI_NULL_POINTER, "quotient");
    FAILS(ricci_quotient_polygon(sound, x, x, 1), RICCI_BUFFER_TOO_SMALL, "8 entries");
    FAILS(ricci_dirichlet_new(sound, NULL, control, &dirichlet), RICCI_CANCELLED, "");
    x[0] = HUGE_VAL;
    FAILS(ricci_dirichlet_new(sound, x, NULL, &dirichlet), RICCI_ARGUMENT, "finite");
    FAILS(ricci_quotient_generators(sound, NULL), RICCI_NULL_POINTER, "deck");
    FAILS(ricci_quotient_generators(NULL, &deck), RICCI_NULL_POINTER, "quotient");
    CHECK(dirichlet == NULL && deck == NULL);
    ricci_quotient_free(NULL), ricci_dirichlet_free(NULL), ricci_deck_free(NULL);
    ricci_quotient_free(sound), ricci_control_free(control), ricci_metric_free(flat);
    ricci_mesh_free(sphere), ricci_mesh_free(disk), ricci_mesh_free(bolza);
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
