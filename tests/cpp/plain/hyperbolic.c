/* Hyperbolic metrics of closed surfaces and of surfaces with boundary, with and without cones, unrolled into
 * the hyperbolic plane. */
#include "arrays.h"
#include "samples.h"
#include <math.h>

/* The angle at p of a triangle in the Poincare disk, counterclockwise from q to r: p is moved to the centre.
 */
static double disk_angle(const double *p, const double *q, const double *r) {
    double z[2][2];
    for (int i = 0; i < 2; i++) {
        /* (q - p) / (1 - conj(p) q), but for the modulus of the divisor */
        const double *t = i ? r : q, x = t[0] - p[0], y = t[1] - p[1];
        const double a = 1 - p[0] * t[0] - p[1] * t[1], b = p[1] * t[0] - p[0] * t[1];
        z[i][0] = x * a + y * b, z[i][1] = y * a - x * b;
    }
    return atan2(z[0][0] * z[1][1] - z[0][1] * z[1][0], z[0][0] * z[1][0] + z[0][1] * z[1][1]);
}

/* Angles about every vertex are what the target says: measured in the picture alone. */
static void check_angles(const arrays *given, const double *target, const ricci_layout *layout) {
    ricci_layout_summary s;
    ricci_mesh *mesh = NULL;
    OK(ricci_layout_summarise(layout, &s, sizeof s));
    OK(ricci_layout_mesh(layout, &mesh));
    arrays r = arrays_of(mesh, 1);
    double *points = (double *)room(2 * s.n_points, sizeof *points);
    uint32_t *corners = (uint32_t *)room(3 * s.n_faces, sizeof *corners);
    double *total = (double *)room(s.n_vertices, sizeof *total);
    int *on_boundary = (int *)room(s.n_vertices, sizeof *on_boundary);
    OK(ricci_layout_points(layout, RICCI_MODEL_POINCARE, points, 2 * s.n_points));
    OK(ricci_layout_corners(layout, RICCI_ON_REFINEMENT, corners, 3 * s.n_faces));
    double area = 0;
    for (size_t f = 0; f < s.n_faces; f++) {
        const double *z[3];
        double sum = 0;
        for (int k = 0; k < 3; k++) z[k] = points + 2 * corners[3 * f + k];
        for (int k = 0; k < 3; k++) {
            const double theta = disk_angle(z[k], z[(k + 1) % 3], z[(k + 2) % 3]);
            total[r.faces[3 * f + k]] += theta, sum += theta;
        }
        area += pi - sum;
    }
    CHECK(fabs(area - s.area) < 1e-10 * (1 + s.area));
    /* Vertices on the boundary: those of edges with one face. */
    int *sides = (int *)room(s.n_edges, sizeof *sides);
    for (size_t i = 0; i < 3 * s.n_faces; i++) sides[abs(r.face_edges[i]) - 1]++;
    for (size_t e = 0; e < s.n_edges; e++)
        if (sides[e] == 1) on_boundary[r.ends[2 * e]] = on_boundary[r.ends[2 * e + 1]] = 1;
    double worst = 0;
    for (size_t v = 0; v < s.n_vertices; v++) {
        const double full = on_boundary[v] ? pi : 2 * pi;
        const double expected = full - (v < given->n.n_vertices ? target[v] : 0);
        worst = fmax(worst, fabs(total[v] - expected));
    }
    CHECK(worst < 1e-10);
    printf("%zu faces, %zu seams, area %.6f, corners apart %.1e, angles off %.1e\n", s.n_faces, s.n_seams,
           s.area, s.consistency, worst);
    free(points), free(corners), free(total), free(on_boundary), free(sides);
    arrays_free(&r);
    ricci_mesh_free(mesh);
}

/* Flow to the target, unroll in the Poincare and the Klein disk, compare. `area`: by Gauss-Bonnet. */
static ricci_status in_model(const ricci_metric *metric, uint32_t model, ricci_layout **layout) {
    ricci_layout_options options;
    INIT(options);
    options.model = model;
    return ricci_layout_new(metric, &options, NULL, layout);
}

static void unroll(ricci_mesh *mesh, const double *target, double area, size_t n_seams) {
    ricci_metric *metric = NULL, *end = NULL;
    ricci_layout *disk = NULL, *klein = NULL;
    ricci_layout_summary s, t;
    arrays given = arrays_of(mesh, 1);
    const size_t n = given.n.n_vertices;
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_H2, &metric));
    OK(flow_to(metric, target, n, NULL, NULL, &end));
    OK(in_model(end, RICCI_MODEL_POINCARE, &disk));
    OK(in_model(end, RICCI_MODEL_KLEIN, &klein));
    OK(ricci_layout_summarise(disk, &s, sizeof s));
    OK(ricci_layout_summarise(klein, &t, sizeof t));
    CHECK(s.n_flipped == 0 && s.consistency < 1e-8 && s.n_points == t.n_points && s.n_faces == t.n_faces);
    CHECK(fabs(s.area - area) < 1e-9 * (1 + area) && s.area == t.area && s.qc_max >= 1);
    CHECK(n_seams == 0 ? s.n_seams == 0 : s.n_seams >= n_seams);
    check_angles(&given, target, disk);
    double *z = (double *)room(2 * s.n_points, sizeof *z), *k = (double *)room(2 * s.n_points, sizeof *k);
    OK(ricci_layout_points(disk, RICCI_MODEL_POINCARE, z, 2 * s.n_points));
    OK(ricci_layout_points(disk, RICCI_MODEL_KLEIN, k, 2 * s.n_points));
    for (size_t i = 0; i < s.n_points; i++) {
        const double r = z[2 * i] * z[2 * i] + z[2 * i + 1] * z[2 * i + 1];
        for (int j = 0; j < 2; j++) CHECK(fabs(k[2 * i + j] - 2 * z[2 * i + j] / (1 + r)) < 1e-14);
    }
    /* In the Klein disk the way there is projective, in the Poincare disk it is not. */
    double *q = (double *)room(s.n_faces * 3, sizeof *q);
    OK(ricci_layout_write(klein, RICCI_ON_REFINEMENT, 1, "hyperbolic_klein.obj"));
    FAILS(ricci_layout_write(disk, RICCI_ON_REFINEMENT, 1, "hyperbolic_disk.obj"), RICCI_LAYOUT, "KLEIN");
    /* Seams are isometries of the disk, which carry the middle of an edge's left side to that of its right
     * side. */
    double *seams = (double *)room(9 * s.n_seams, sizeof *seams);
    OK(ricci_layout_seams(disk, seams, 9 * s.n_seams));
    for (size_t i = 0; i < s.n_seams; i++) {
        const double *m = seams + 9 * i;
        CHECK(fabs(m[0] * m[0] + m[1] * m[1] - m[2] * m[2] - m[3] * m[3] - 1) < 1e-12 && m[8] < 1e-8);
        CHECK(m[4] == m[2] && m[5] == -m[3] && m[6] == m[0] && m[7] == -m[1]);
    }
    free(seams);
    ricci_layout *none = NULL;
    FAILS(in_model(end, RICCI_MODEL_AMBIENT, &none), RICCI_ARGUMENT, "two coordinates");
    FAILS(in_model(end, 4, &none), RICCI_ARGUMENT, "model is 4");
    FAILS(in_model(NULL, RICCI_MODEL_KLEIN, &none), RICCI_NULL_POINTER, "metric");
    const uint32_t beyond = 1000000;
    ricci_layout_options options;
    INIT(options);
    options.cones = &beyond, options.n_cones = 1;
    FAILS(ricci_layout_new(end, &options, NULL, &none), RICCI_ARGUMENT, "1000000");
    options.cones = NULL;
    FAILS(ricci_layout_new(end, &options, NULL, &none), RICCI_NULL_POINTER, "vertices");
    options.n_cones = 0, options.root = &beyond;
    FAILS(ricci_layout_new(end, &options, NULL, &none), RICCI_ARGUMENT, "1000000");
    CHECK(none == NULL);
    free(z), free(k), free(q);
    ricci_layout_free(disk), ricci_layout_free(klein);
    ricci_metric_free(end), ricci_metric_free(metric);
    arrays_free(&given);
}

/* A target of 0 inside, and the same at every vertex of the boundary: together 2 pi chi + area. */
static void with_boundary(ricci_mesh *mesh, double area, size_t n_seams) {
    arrays given = arrays_of(mesh, 1);
    const size_t n = given.n.n_vertices, m = given.n.n_boundary_vertices, loops = given.n.n_boundary_loops;
    uint32_t *rim = (uint32_t *)room(m, sizeof *rim);
    size_t *starts = (size_t *)room(loops + 1, sizeof *starts);
    double *target = (double *)room(n, sizeof *target);
    OK(ricci_mesh_boundary(mesh, rim, m, starts, loops + 1));
    for (size_t k = 0; k < m; k++) target[rim[k]] = (2 * pi * given.n.euler + area) / m;
    unroll(mesh, target, area, n_seams);
    free(rim), free(starts), free(target);
    arrays_free(&given);
}

int main(void) {
    ricci_mesh *disk = bump(13), *annulus = NULL, *closed = NULL;
    with_boundary(disk, 0.5, 0);
    OK(make_sized(RICCI_SHAPE_ANNULUS, 24, 6, 0.5, 1, 0, &annulus));
    with_boundary(annulus, 1, 1);
    OK(make_genus(2, 4, 1, &closed));
    ricci_mesh_summary c;
    OK(ricci_mesh_summarise(closed, &c, sizeof c));
    double *target = (double *)room(c.n_vertices, sizeof *target);
    unroll(closed, target, 4 * pi, 4);
    /* A torus with one cone of angle pi. */
    torus t = torus_new(24, 12);
    ricci_mesh *cone = torus_mesh(&t);
    double *one = (double *)room(t.n_vertices, sizeof *one);
    one[5] = pi;
    unroll(cone, one, pi, 2);
    free(one), free(target);
    torus_free(&t);
    ricci_mesh_free(disk), ricci_mesh_free(annulus), ricci_mesh_free(closed), ricci_mesh_free(cone);
    return 0;
}
