/* Cones placed on a torus, and its layout in charts. */
#include "samples.h"
#include "torus.h"
#include <ricci/uniformize.h>

/* The layout of a closed surface is bounded by seams alone; drawn and written as geometry. */
static void check_lines(const ricci_layout *layout) {
    enum { MOST = 4000 };
    int32_t *lines = (int32_t *)room(4 * MOST, sizeof *lines);
    size_t n_lines = 0, n_points = 0;
    memset(lines, -1, 4 * MOST * sizeof *lines);
    OK(ricci_layout_lines(layout, RICCI_ON_REFINEMENT, 3, lines, 4 * MOST));
    for (; n_lines < MOST && lines[4 * n_lines + 3] > 0; n_lines++) {
        CHECK(lines[4 * n_lines] == RICCI_LAYER_SEAMS && lines[4 * n_lines + 1] >= 0);
        n_points += (size_t)lines[4 * n_lines + 3];
    }
    CHECK(n_lines > 1 && n_points >= 2 * n_lines);
    uint32_t *points = (uint32_t *)room(n_points, sizeof *points);
    OK(ricci_layout_line_points(layout, RICCI_ON_REFINEMENT, 3, points, n_points));
    FAILS(ricci_layout_line_points(layout, RICCI_ON_REFINEMENT, 3, points, n_points - 1),
          RICCI_BUFFER_TOO_SMALL, "points");
    FAILS(ricci_layout_lines(layout, RICCI_ON_REFINEMENT, 4, lines, 4 * MOST), RICCI_ARGUMENT, "fold_angle");
    OK(ricci_layout_write_flat(layout, RICCI_ON_REFINEMENT, 3, RICCI_SHEET_MILLIMETRE, "charts.dxf"));
    FAILS(ricci_layout_write_flat(layout, RICCI_ON_REFINEMENT, 3, RICCI_SHEET_MILLIMETRE, "charts.txt"),
          RICCI_UNKNOWN_FORMAT, "charts.txt");
    free(points);
    free(lines);
}

int main(void) {
    torus t = torus_new(40, 20);
    ricci_mesh *mesh = torus_mesh(&t);
    ricci_metric *metric = NULL, *flat = NULL, *curved = NULL;
    ricci_layout *layout = NULL;
    ricci_charts *charts = NULL;
    ricci_charts_summary summary;
    ricci_layout_summary plane;
    const size_t n = t.n_vertices;
    double *target = (double *)malloc(n * sizeof *target), *again = (double *)malloc(n * sizeof *again);
    CHECK(target && again);
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));

    OK(fill(metric, target_of(RICCI_TARGET_AUTO, NULL, NULL, 6), target, n));
    OK(fill(metric, target_of(RICCI_TARGET_AUTO, NULL, NULL, 6), again, n));
    CHECK(memcmp(target, again, n * sizeof *target) == 0);
    OK(check_target(metric, target, n));
    double sum = 0;
    size_t cones = 0;
    for (size_t v = 0; v < n; v++) {
        sum += target[v];
        cones += target[v] != 0;
    }
    CHECK(cones == 6 && fabs(sum) < 1e-12);
    FAILS(fill(metric, target_of(RICCI_TARGET_AUTO, NULL, NULL, 1), target, n), RICCI_TARGET_KIND, "torus");
    FAILS(fill(metric, target_of(RICCI_TARGET_AUTO, NULL, NULL, 257), target, n), RICCI_TARGET_KIND, "256");
    FAILS(fill(metric, target_of(RICCI_TARGET_AUTO, NULL, NULL, n + 1), target, n), RICCI_TARGET_KIND,
          "interior");
    FAILS(fill(metric, target_of(RICCI_TARGET_AUTO, NULL, NULL, 6), target, n - 1), RICCI_BUFFER_TOO_SMALL,
          "curvatures");
    FAILS(fill(NULL, target_of(RICCI_TARGET_AUTO, NULL, NULL, 6), target, n), RICCI_NULL_POINTER, "metric");
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_H2, &curved));
    FAILS(fill(curved, target_of(RICCI_TARGET_AUTO, NULL, NULL, 6), target, n), RICCI_TARGET_KIND, "e2");

    /* An open torus has four of them by default. */
    ricci_mesh *open = NULL;
    ricci_metric *around = NULL;
    OK(change(mesh, RICCI_CHANGE_PUNCH, 1, 0, 0, &open));
    OK(ricci_metric_new(open, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &around));
    OK(fill(around, target_of(RICCI_TARGET_AUTO, NULL, NULL, 4), again, n));
    OK(ricci_target_fill(around, NULL, NULL, target, n));
    CHECK(memcmp(target, again, n * sizeof *target) == 0);
    ricci_metric_free(around);
    ricci_mesh_free(open);

    OK(fill(metric, target_of(RICCI_TARGET_AUTO, NULL, NULL, 6), target, n));
    OK(flow_to(metric, target, n, NULL, NULL, &flat));
    OK(ricci_layout_new(flat, NULL, NULL, &layout));
    OK(ricci_layout_summarise(layout, &plane, sizeof plane));
    check_lines(layout);
    FAILS(ricci_charts_new(layout, 1, NULL, &charts), RICCI_ARGUMENT, "margin");
    FAILS(ricci_charts_new(NULL, 0.01, NULL, &charts), RICCI_NULL_POINTER, "layout");
    FAILS(ricci_charts_new(layout, 0.01, NULL, NULL), RICCI_NULL_POINTER, "charts");
    OK(ricci_charts_new(layout, 0.01, NULL, &charts));
    double *uv = (double *)room(6 * plane.n_faces, sizeof *uv);
    OK(ricci_layout_uv(layout, RICCI_ON_REFINEMENT, uv, 6 * plane.n_faces));
    ricci_layout_free(layout); /* charts live on */
    OK(ricci_charts_summarise(charts, &summary, sizeof summary));
    CHECK(summary.n_faces == plane.n_faces && plane.n_vertices > plane.n_input_vertices &&
          summary.n_flipped == 0 && summary.n_charts >= 1);
    CHECK(summary.efficiency > 0.05 && summary.efficiency < 1 && summary.chart_seams >= summary.layout_seams);

    const size_t n_faces = summary.n_faces;
    double *points = (double *)malloc(2 * summary.n_points * sizeof *points), area = 0;
    uint32_t *corners = (uint32_t *)malloc(3 * n_faces * sizeof *corners);
    uint32_t *chart = (uint32_t *)malloc(n_faces * sizeof *chart);
    CHECK(points && corners && chart);
    OK(ricci_charts_points(charts, points, 2 * summary.n_points));
    OK(ricci_charts_corners(charts, corners, 3 * n_faces));
    OK(ricci_charts_faces(charts, chart, n_faces));
    FAILS(ricci_charts_points(charts, points, 2 * summary.n_points - 1), RICCI_BUFFER_TOO_SMALL, "points");
    FAILS(ricci_charts_corners(charts, corners, 0), RICCI_BUFFER_TOO_SMALL, "corners");
    FAILS(ricci_charts_faces(charts, NULL, n_faces), RICCI_NULL_POINTER, "charts");
    for (size_t k = 0; k < 2 * summary.n_points; k++) CHECK(points[k] >= 0 && points[k] <= 1);
    for (size_t f = 0; f < n_faces; f++) {
        const double *a = points + 2 * corners[3 * f], *b = points + 2 * corners[3 * f + 1];
        const double *c = points + 2 * corners[3 * f + 2];
        const double twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        CHECK(twice > 0 && chart[f] < summary.n_charts);
        area += 0.5 * twice;
    }
    CHECK(fabs(area - summary.efficiency) < 1e-9);
    OK(ricci_charts_write(charts, 0, "charts.obj"));
    /* Each chart is the layout, scaled, turned and moved. */
    double *motions = (double *)room(3 * summary.n_charts, sizeof *motions);
    OK(ricci_charts_motions(charts, motions, 3 * summary.n_charts));
    FAILS(ricci_charts_motions(charts, motions, 3 * summary.n_charts - 1), RICCI_BUFFER_TOO_SMALL, "motions");
    for (size_t k = 0; k < 3 * n_faces; k++) {
        const double *m = motions + 3 * chart[k / 3], *p = points + 2 * corners[k];
        const double x = summary.scale * uv[2 * k], y = summary.scale * uv[2 * k + 1];
        CHECK(fabs(cos(m[0]) * x - sin(m[0]) * y + m[1] - p[0]) < 1e-9);
        CHECK(fabs(sin(m[0]) * x + cos(m[0]) * y + m[2] - p[1]) < 1e-9);
    }
    free(uv), free(motions);

    ricci_charts_free(charts);
    ricci_charts_free(NULL);
    ricci_metric_free(flat);
    ricci_metric_free(curved);
    ricci_metric_free(metric);
    ricci_mesh_free(mesh);
    free(points), free(corners), free(chart), free(target), free(again);
    torus_free(&t);
    return 0;
}
