/* Splines over whole surfaces through the C face: fits on flat metrics, against the torus that they are
 * fitted to, nearest points, tessellations, files, refusals. */
#include "samples.h"
#include <math.h>
#include <ricci/spline.h>

static ricci_spline_summary summary_of(const ricci_spline *spline) {
    ricci_spline_summary s;
    OK(ricci_spline_summarise(spline, &s, sizeof s));
    return s;
}

/* Radii 2 and 0.8: how far a point is from the torus. */
static double off(const double *p) { return fabs(hypot(hypot(p[0], p[1]) - 2, p[2]) - 0.8); }

enum { N = 300 };

/* The middles of patches, one after the other. */
static void middles(const ricci_spline *spline, uint32_t *patches, double *parameters) {
    const ricci_spline_summary s = summary_of(spline);
    const size_t each = 3 * (s.degree + 1) * 2;
    double *knots = (double *)room(s.n_patches * each, sizeof *knots);
    OK(ricci_spline_values(spline, RICCI_SPLINE_KNOTS, knots, s.n_patches * each));
    for (size_t i = 0; i < N; i++) {
        const double *of = knots + i % s.n_patches * each;
        patches[i] = (uint32_t)(i % s.n_patches);
        for (int x = 0; x < 2; x++)
            parameters[2 * i + x] = (of[x] + of[each / 3 + x] + of[2 * each / 3 + x]) / 3;
    }
    free(knots);
}

/* Neither the order of points nor the number of threads changes a bit. */
static void one_thread_finds_the_same_backwards(const ricci_spline *spline, const double *points,
                                                const double *expected) {
    double back[3 * N], found[6 * N];
    uint32_t patches[N];
    ricci_control *control = NULL;
    for (int i = 0; i < N; i++) memcpy(back + 3 * i, points + 3 * (N - 1 - i), 3 * sizeof *back);
    OK(ricci_control_new(&control));
    OK(ricci_control_set_threads(control, 1));
    OK(ricci_spline_closest(spline, back, N, control, patches, found, 6 * N));
    for (int i = 0; i < N; i++)
        CHECK(memcmp(found + 6 * i, expected + 6 * (N - 1 - i), 6 * sizeof *found) == 0);
    ricci_control_free(control);
}

/* Points that stand off the surface along its normals come back to where they stand. */
static void normals_lead_back(const ricci_spline *spline, double far) {
    uint32_t patches[N], nearest[N];
    double parameters[2 * N], values[9 * N], shape[5 * N], points[3 * N], found[6 * N];
    ricci_spline_places places;
    middles(spline, patches, parameters);
    INIT(places);
    places.patches = patches, places.parameters = parameters, places.n = N;
    OK(ricci_spline_evaluate(spline, &places, RICCI_SPLINE_FIRST, NULL, values, 9 * N));
    OK(ricci_spline_evaluate(spline, &places, RICCI_SPLINE_SHAPE, NULL, shape, 5 * N));
    for (int i = 0; i < N; i++)
        for (int x = 0; x < 3; x++) points[3 * i + x] = values[9 * i + x] + far * shape[5 * i + x];
    OK(ricci_spline_closest(spline, points, N, NULL, nearest, found, 6 * N));
    one_thread_finds_the_same_backwards(spline, points, found);
    for (int i = 0; i < N; i++) {
        const double *at = found + 6 * i;
        CHECK(nearest[i] == patches[i] && fabs(at[5] - fabs(far)) < 1e-12);
        CHECK(hypot(at[0] - parameters[2 * i], at[1] - parameters[2 * i + 1]) < 1e-9);
        for (int x = 0; x < 3; x++) CHECK(fabs(at[2 + x] - values[9 * i + x]) < 1e-10);
        /* A point of the torus has the principal curvatures 1/r and cos(b)/(R + r cos(b)), up to its side. */
        CHECK(off(values + 9 * i) < 0.01);
        const double rho = hypot(values[9 * i], values[9 * i + 1]);
        CHECK(fabs(shape[5 * i + 3] * shape[5 * i + 4] - (rho - 2) / 0.64 / rho) < 0.25);
    }
}

static void a_torus_is_fitted(void) {
    ricci_mesh *mesh = NULL, *fine = NULL;
    ricci_spline *spline = NULL, *again = NULL;
    OK(make_sized(RICCI_SHAPE_TORUS, 64, 32, 2, 0.8, 0, &mesh));
    ricci_metric *flat = flat_of(mesh, RICCI_TARGET_UNIFORM);
    OK(ricci_spline_fit_surface(flat, NULL, NULL, &spline));
    const ricci_spline_summary s = summary_of(spline);
    CHECK(s.degree == 3 && s.n_control_points <= 64 * 32 / 3 && s.n_holes == 0);
    CHECK(s.fit_rms > 0 && s.fit_rms < 1e-3 * 7 && s.fit_max < 0.01 * 7 && s.fit_rms <= s.fit_max);
    CHECK(ricci_spline_values(spline, RICCI_SPLINE_HOLES, NULL, 0) == RICCI_OK);
    CHECK(s.n_folded_patches == 0 && s.folded_share == 0);
    CHECK(ricci_spline_folds(spline, NULL, 0) == RICCI_OK);
    normals_lead_back(spline, 0), normals_lead_back(spline, 0.05), normals_lead_back(spline, -0.05);
    /* n control points per patch meet without gaps: the tessellation is a torus again, with normals. */
    ricci_mesh_summary figures;
    OK(ricci_spline_tessellate(spline, 3, NULL, &fine));
    OK(ricci_mesh_summarise(fine, &figures, sizeof figures));
    CHECK(figures.n_faces == 9 * s.n_patches && figures.genus == 1 && figures.n_boundary_loops == 0);
    /* A file says all of it. */
    size_t n = 0;
    OK(ricci_spline_text(spline, NULL, 0, &n));
    char *text = (char *)room(n, 1);
    OK(ricci_spline_text(spline, text, n, &n));
    OK(ricci_spline_parse(text, &again));
    const double point[3] = {1, 2, 3};
    uint32_t patch[2];
    double values[12];
    OK(ricci_spline_closest(spline, point, 1, NULL, patch, values, 6));
    OK(ricci_spline_closest(again, point, 1, NULL, patch + 1, values + 6, 6));
    CHECK(patch[0] == patch[1] && memcmp(values, values + 6, 6 * sizeof *values) == 0);
    CHECK(fabs(values[5] - (hypot(hypot(1, 2) - 2, 3) - 0.8)) < 0.01);
    free(text);
    ricci_spline_free(again);
    ricci_spline_free(spline);
    ricci_mesh_free(fine);
    ricci_metric_free(flat);
    ricci_mesh_free(mesh);
}

/* A sphere is fitted by itself; it says that it holds, and that it does not where the tolerance is too small.
 */
static void a_sphere_is_fitted(void) {
    ricci_mesh *mesh = NULL;
    ricci_spline *spline = NULL;
    ricci_spline_surface_options options;
    OK(make_sized(RICCI_SHAPE_SPHERE, 12, 0, 0, 0, 0, &mesh));
    OK(ricci_spline_fit_mesh(mesh, NULL, NULL, &spline));
    ricci_spline_summary s = summary_of(spline);
    CHECK(s.converged == 1 && s.n_folded_patches == 0 && s.fit_max < 0.01 * 2 * sqrt(3) && s.n_holes >= 1);
    const double point[3] = {0, 0, 3};
    double values[6];
    uint32_t patch;
    OK(ricci_spline_closest(spline, point, 1, NULL, &patch, values, 6));
    CHECK(fabs(values[5] - 2) < 0.01);
    ricci_spline_free(spline);
    INIT(options);
    options.tolerance = 1e-9, options.control_points = 200, options.rounds = 1;
    OK(ricci_spline_fit_mesh(mesh, &options, NULL, &spline));
    s = summary_of(spline);
    CHECK(s.converged == 0 && s.fit_max > 1e-9);
    ricci_spline_free(spline);
    spline = NULL;
    CHECK(ricci_spline_fit_mesh(NULL, NULL, NULL, &spline) == RICCI_NULL_POINTER && !spline);
    options.degree = 6;
    CHECK(ricci_spline_fit_mesh(mesh, &options, NULL, &spline) == RICCI_ARGUMENT && !spline);
    ricci_mesh_free(mesh);
}

/* Around the singular vertex of a surface of genus 2 a filling takes the place of the spline. */
static void a_hole_is_filled(void) {
    ricci_mesh *mesh = NULL;
    ricci_spline *spline = NULL;
    ricci_spline_surface_options options;
    OK(make_genus(2, 6, 1, &mesh));
    ricci_metric *flat = flat_of(mesh, RICCI_TARGET_SINGLE);
    INIT(options);
    options.rounds = 1, options.corrections = -1, options.degree = 2;
    OK(ricci_spline_fit_surface(flat, &options, NULL, &spline));
    const ricci_spline_summary s = summary_of(spline);
    double hole[2];
    CHECK(s.degree == 2 && s.n_holes == 1);
    OK(ricci_spline_values(spline, RICCI_SPLINE_HOLES, hole, 2));
    CHECK(hole[0] == 3 && hole[1] > 0);
    ricci_spline_free(spline);
    ricci_metric_free(flat);
    ricci_mesh_free(mesh);
}

static void curvatures_add_up(void) {
    enum { MOST = 2000 };
    static double curvatures[MOST];
    const uint32_t named[3] = {0, 50, 100}, twice[3] = {0, 50, 50};
    ricci_mesh *mesh = NULL;
    OK(make_sized(RICCI_SHAPE_SPHERE, 8, 0, 0, 0, 0, &mesh));
    ricci_mesh_summary size;
    OK(ricci_mesh_summarise(mesh, &size, sizeof size));
    OK(ricci_spline_curvatures(mesh, NULL, 5, 0, NULL, curvatures, MOST));
    double sum = 0;
    int cones = 0;
    for (size_t v = 0; v < size.n_vertices; v++) sum += curvatures[v], cones += curvatures[v] != 0;
    CHECK(cones == 5 && fabs(sum - 16 * atan(1)) < 1e-9);
    OK(ricci_spline_curvatures(mesh, named, 3, 0, NULL, curvatures, MOST));
    CHECK(curvatures[0] > 0 && curvatures[50] > 0 && curvatures[100] > 0);
    CHECK(ricci_spline_curvatures(mesh, twice, 3, 0, NULL, curvatures, MOST) == RICCI_ARGUMENT);
    CHECK(ricci_spline_curvatures(mesh, NULL, 1, 0, NULL, curvatures, MOST) == RICCI_ARGUMENT);
    CHECK(ricci_spline_curvatures(mesh, NULL, 2, 0, NULL, curvatures, MOST) == RICCI_TARGET_KIND);
    CHECK(ricci_spline_curvatures(mesh, NULL, RICCI_SPLINE_AUTO, 0.5, NULL, curvatures, MOST) ==
          RICCI_ARGUMENT);
    CHECK(ricci_spline_curvatures(mesh, NULL, 5, 0, NULL, curvatures, 3) == RICCI_BUFFER_TOO_SMALL);
    CHECK(ricci_spline_curvatures(NULL, NULL, 5, 0, NULL, curvatures, MOST) == RICCI_NULL_POINTER);
    ricci_mesh_free(mesh);
}

static void what_cannot_be_is_refused(void) {
    ricci_mesh *mesh = NULL;
    ricci_metric *metric = NULL;
    ricci_spline *spline = NULL;
    ricci_spline_surface_options options;
    OK(make_sized(RICCI_SHAPE_TORUS, 24, 12, 2, 0.8, 0, &mesh));
    CHECK(ricci_spline_fit_surface(NULL, NULL, NULL, &spline) == RICCI_NULL_POINTER);
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_H2, &metric));
    CHECK(ricci_spline_fit_surface(metric, NULL, NULL, &spline) == RICCI_ARGUMENT);
    ricci_metric_free(metric);
    metric = flat_of(mesh, RICCI_TARGET_UNIFORM);
    INIT(options);
    options.degree = 6;
    CHECK(ricci_spline_fit_surface(metric, &options, NULL, &spline) == RICCI_ARGUMENT && !spline);
    options.degree = 1, options.rounds = 1;
    OK(ricci_spline_fit_surface(metric, &options, NULL, &spline));
    double bad[6] = {0, 0, 0, 0, HUGE_VAL, 0}, values[12];
    uint32_t patches[2];
    CHECK(ricci_spline_closest(spline, bad, 2, NULL, patches, values, 12) == RICCI_ARGUMENT);
    CHECK(ricci_spline_closest(spline, bad, 2, NULL, patches, values, 11) == RICCI_BUFFER_TOO_SMALL);
    CHECK(ricci_spline_closest(spline, bad, 2, NULL, NULL, values, 12) != RICCI_OK);
    CHECK(ricci_spline_closest(NULL, bad, 2, NULL, patches, values, 12) == RICCI_NULL_POINTER);
    ricci_spline_free(spline);
    ricci_metric_free(metric);
    ricci_mesh_free(mesh);
}

int main(void) {
    a_torus_is_fitted();
    a_sphere_is_fitted();
    a_hole_is_filled();
    curvatures_add_up();
    what_cannot_be_is_refused();
    return 0;
}
