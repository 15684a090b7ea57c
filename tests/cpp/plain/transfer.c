/* Attributes carried to layouts, and homogeneous texture coordinates, against formulas written here. */
#include "arrays.h"
#include <ricci/uniformize.h>

enum { COMPONENTS = 2 };

/* Values without a pattern. */
static double *values(size_t n) {
    double *x = (double *)room(n, sizeof *x);
    for (size_t i = 0; i < n; i++) x[i] = sin(1.7 * (double)i) + 0.01 * (double)(i % 7);
    return x;
}

/* ricci_map_carry from `on`, values at vertices or corners. */
static ricci_status carry(const ricci_map *map, uint32_t on, uint32_t at, const double *x, size_t n,
                          size_t components, double *y, size_t capacity) {
    ricci_carried values;
    INIT(values);
    values.on = on, values.at = at, values.values = x, values.n_values = n, values.n_components = components;
    return ricci_map_carry(map, &values, y, capacity);
}

/* Values at vertices are linear along the edges of the triangulation that they come from. */
static void check_vertices(const ricci_map *map, const ricci_map_summary *s, const arrays *from,
                           uint32_t on) {
    const size_t n = from->n.n_vertices, all = COMPONENTS * s->n_vertices,
                 given = s->n_vertices - s->n_crossings;
    double *x = values(COMPONENTS * n), *y = (double *)room(all, sizeof *y);
    double *t = (double *)room(s->n_crossings, sizeof *t);
    uint32_t *edges = (uint32_t *)room(s->n_crossings, sizeof *edges);
    OK(carry(map, on, RICCI_AT_VERTICES, x, n, COMPONENTS, y, all));
    OK(ricci_map_crossings(map, on, edges, t, s->n_crossings));
    CHECK(memcmp(x, y, COMPONENTS * given * sizeof *x) == 0);
    for (size_t k = 0; k < s->n_crossings; k++)
        for (size_t i = 0; i < COMPONENTS; i++) {
            const double a = x[COMPONENTS * from->ends[2 * edges[k]] + i];
            const double b = x[COMPONENTS * from->ends[2 * edges[k] + 1] + i];
            CHECK(fabs(y[COMPONENTS * (given + k) + i] - (1 - t[k]) * a - t[k] * b) < 1e-14);
        }
    FAILS(carry(map, on, RICCI_AT_VERTICES, x, n, COMPONENTS, y, all - 1), RICCI_BUFFER_TOO_SMALL, "carried");
    FAILS(carry(map, on, RICCI_AT_VERTICES, x, n + 1, COMPONENTS, y, all), RICCI_WRONG_SIZE, "values");
    FAILS(carry(map, on, RICCI_AT_VERTICES, x, n, SIZE_MAX / 2, y, all), RICCI_TOO_LARGE, "values");
    FAILS(carry(map, on, RICCI_AT_VERTICES, NULL, n, COMPONENTS, y, all), RICCI_NULL_POINTER, "values");
    FAILS(carry(NULL, on, RICCI_AT_VERTICES, x, n, COMPONENTS, y, all), RICCI_NULL_POINTER, "map");
    FAILS(ricci_map_carry(map, NULL, y, all), RICCI_NULL_POINTER, "values");
    FAILS(carry(map, RICCI_ON_REFINEMENT, RICCI_AT_VERTICES, x, n, 1, y, all), RICCI_ARGUMENT, "on is");
    FAILS(carry(map, on, 2, x, n, COMPONENTS, y, all), RICCI_ARGUMENT, "at is 2");
    OK(carry(map, on, RICCI_AT_VERTICES, NULL, n, 0, NULL, 0));
    x[3] = NAN;
    FAILS(carry(map, on, RICCI_AT_VERTICES, x, n, COMPONENTS, y, all), RICCI_ARGUMENT, "values[3]");
    free(x), free(y), free(t), free(edges);
}

/* Values at corners are linear in the faces of the triangulation that they come from. */
static void check_corners(const ricci_map *map, const ricci_map_summary *s, const arrays *from, uint32_t on) {
    const size_t n = from->n.n_faces, all = 3 * COMPONENTS * s->n_faces;
    double *x = values(3 * COMPONENTS * n), *y = (double *)room(all, sizeof *y);
    double *b = (double *)room(9 * s->n_faces, sizeof *b);
    uint32_t *of = (uint32_t *)room(s->n_faces, sizeof *of);
    OK(carry(map, on, RICCI_AT_CORNERS, x, n, COMPONENTS, y, all));
    OK(ricci_map_faces(map, on, of, s->n_faces));
    OK(ricci_map_barycentric(map, on, b, 9 * s->n_faces));
    for (size_t f = 0; f < s->n_faces; f++)
        for (size_t k = 0; k < 3; k++)
            for (size_t i = 0; i < COMPONENTS; i++) {
                double expected = 0;
                for (size_t c = 0; c < 3; c++)
                    expected += b[9 * f + 3 * k + c] * x[COMPONENTS * (3 * of[f] + c) + i];
                CHECK(fabs(y[COMPONENTS * (3 * f + k) + i] - expected) < 1e-14);
            }
    FAILS(carry(map, on, RICCI_AT_CORNERS, x, n, COMPONENTS, y, all - 1), RICCI_BUFFER_TOO_SMALL, "carried");
    FAILS(carry(map, on, RICCI_AT_CORNERS, x, n - 1, COMPONENTS, y, all), RICCI_WRONG_SIZE, "values");
    free(x), free(y), free(b), free(of);
}

/* The n_points lines `vt a b c` of a file, in order; there must be exactly as many. */
static double *texture_coordinates(const char *path, size_t n_points) {
    double *vt = (double *)room(3 * n_points, sizeof *vt);
    char line[512];
    size_t n = 0;
    FILE *file = fopen(path, "r");
    CHECK(file);
    while (fgets(line, sizeof line, file))
        if (strncmp(line, "vt ", 3) == 0) {
            double *p = vt + 3 * n++;
            CHECK(n <= n_points && sscanf(line, "vt %lf %lf %lf", p, p + 1, p + 2) == 3);
        }
    CHECK(n == n_points);
    fclose(file);
    return vt;
}

/* Divided by the third they are the plane points; the third is the weight of the vertex at every corner. */
static void check_homogeneous(const char *path, const ricci_map *map, const ricci_layout_summary *s,
                              const uint32_t *faces, const double *points, const uint32_t *corners,
                              size_t n_points) {
    double *vt = texture_coordinates(path, n_points), *q = (double *)room(s->n_vertices, sizeof *q);
    double least = INFINITY, most = 0;
    OK(ricci_map_weights(map, q, s->n_vertices));
    for (size_t c = 0; c < 3 * s->n_faces; c++) CHECK(vt[3 * corners[c] + 2] == q[faces[c]]);
    for (size_t p = 0; p < n_points; p++) {
        least = fmin(least, vt[3 * p + 2]), most = fmax(most, vt[3 * p + 2]);
        for (int i = 0; i < 2; i++)
            CHECK(fabs(vt[3 * p + i] / vt[3 * p + 2] - points[2 * p + i]) < 1e-14 * (1 + s->diameter));
    }
    CHECK(least > 0 && most > 1.05 * least); /* the map is not the identity */
    free(vt), free(q);
}

static void check_layout(const ricci_mesh *mesh, uint32_t flips, const char *path) {
    arrays given = arrays_of(mesh, 1);
    const size_t n = given.n.n_vertices;
    ricci_metric *metric = NULL, *flat = NULL;
    ricci_layout *layout = NULL;
    ricci_map *map = NULL;
    ricci_map_summary counts;
    ricci_charts *charts = NULL;
    ricci_mesh *refined = NULL, *final_mesh = NULL;
    ricci_layout_summary s;
    ricci_charts_summary c;
    ricci_flow_options options;
    double *target = (double *)room(n, sizeof *target);
    INIT(options);
    options.flips = flips;
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(ricci_target_fill(metric, NULL, NULL, target, n));
    OK(flow_to(metric, target, n, &options, NULL, &flat));
    OK(ricci_layout_new(flat, NULL, NULL, &layout));
    OK(ricci_layout_summarise(layout, &s, sizeof s));
    OK(ricci_layout_mesh(layout, &refined));
    OK(ricci_metric_mesh(flat, &final_mesh));
    arrays r = arrays_of(refined, 1), last = arrays_of(final_mesh, 0);

    OK(ricci_map_new(flat, NULL, &map));
    OK(ricci_map_summarise(map, &counts, sizeof counts));
    CHECK((counts.n_crossings > 0) == (flips == RICCI_FLIPS_AUTO));
    check_vertices(map, &counts, &given, RICCI_ON_INPUT);
    check_vertices(map, &counts, &last, RICCI_ON_METRIC);
    check_corners(map, &counts, &given, RICCI_ON_INPUT);
    check_corners(map, &counts, &last, RICCI_ON_METRIC);
    /* Positions are such values. */
    double *positions = (double *)room(3 * s.n_vertices, sizeof *positions);
    OK(carry(map, RICCI_ON_INPUT, RICCI_AT_VERTICES, given.positions, n, 3, positions, 3 * s.n_vertices));
    CHECK(memcmp(positions, r.positions, 3 * s.n_vertices * sizeof *positions) == 0);

    double *points = (double *)room(2 * s.n_points, sizeof *points);
    uint32_t *corners = (uint32_t *)room(3 * s.n_faces, sizeof *corners);
    OK(ricci_layout_points(layout, RICCI_MODEL_POINCARE, points, 2 * s.n_points));
    OK(ricci_layout_corners(layout, RICCI_ON_REFINEMENT, corners, 3 * s.n_faces));
    OK(ricci_layout_write(layout, RICCI_ON_REFINEMENT, 1, path));
    check_homogeneous(path, map, &s, r.faces, points, corners, s.n_points);
    FAILS(ricci_layout_write(layout, RICCI_ON_INPUT, 1, path), RICCI_ARGUMENT, "homogeneous");
    FAILS(ricci_layout_write(layout, RICCI_ON_REFINEMENT, 1, NULL), RICCI_NULL_POINTER, "path");
    free(points);

    OK(ricci_charts_new(layout, 0.01, NULL, &charts));
    OK(ricci_charts_summarise(charts, &c, sizeof c));
    points = (double *)room(2 * c.n_points, sizeof *points);
    OK(ricci_charts_points(charts, points, 2 * c.n_points));
    OK(ricci_charts_corners(charts, corners, 3 * c.n_faces));
    OK(ricci_charts_write(charts, 1, path));
    check_homogeneous(path, map, &s, r.faces, points, corners, c.n_points);
    FAILS(ricci_charts_write(NULL, 1, path), RICCI_NULL_POINTER, "charts");

    printf("%s: %zu vertices, %zu crossings, %zu charts\n", path, n, counts.n_crossings, c.n_charts);
    free(points), free(corners), free(positions), free(target);
    arrays_free(&r), arrays_free(&last), arrays_free(&given);
    ricci_mesh_free(refined), ricci_mesh_free(final_mesh);
    ricci_charts_free(charts), ricci_layout_free(layout), ricci_map_free(map);
    ricci_metric_free(flat), ricci_metric_free(metric);
}

int main(void) {
    torus t = torus_new(24, 12);
    ricci_mesh *closed = torus_mesh(&t), *open = bump(13);
    check_layout(closed, RICCI_FLIPS_AUTO, "transfer_torus.obj");
    check_layout(closed, RICCI_FLIPS_NEVER, "transfer_unflipped.obj");
    check_layout(open, RICCI_FLIPS_AUTO, "transfer_bump.obj");
    ricci_mesh_free(closed), ricci_mesh_free(open);
    torus_free(&t);
    return 0;
}
