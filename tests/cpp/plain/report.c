/* The report of a flow to a target that no circle packing of the surface can have. */
#include "torus.h"

int main(void) {
    torus t = torus_new(12, 8);
    ricci_mesh *mesh = torus_mesh(&t);
    ricci_metric *metric = NULL, *result = NULL;
    ricci_report_summary summary;
    uint32_t vertices[96];
    double errors[96];
    double *target = (double *)malloc(t.n_vertices * sizeof *target);
    const double pi = 4 * atan(1.0);
    CHECK(target);
    OK(ricci_metric_new(mesh, RICCI_SCHEME_TANGENTIAL, RICCI_SPACE_E2, &metric));
    /* Every vertex has six triangles: K > -4 pi. Two neighbours have ten: together K > -6 pi. */
    for (size_t v = 0; v < t.n_vertices; v++) target[v] = 6.2 * pi / (double)(t.n_vertices - 2);
    target[0] = target[1] = -3.1 * pi;
    OK(flow_to(metric, target, t.n_vertices, NULL, NULL, &result));
    FAILS(ricci_report_summarise(metric, &summary, sizeof summary), RICCI_ARGUMENT, "no flow");
    OK(ricci_report_summarise(result, &summary, sizeof summary));
    CHECK(!summary.converged && summary.stop_reason == RICCI_STOP_INFEASIBLE);
    CHECK(strcmp(summary.stop_reason_text, "infeasible") == 0);
    CHECK(summary.n_obstruction == 2);
    CHECK(fabs(summary.obstruction_target + 6.2 * pi) < 1e-12);
    CHECK(fabs(summary.obstruction_above + 6 * pi) < 1e-12);
    OK(ricci_report_vertices(result, RICCI_REPORT_OBSTRUCTION, vertices, 2));
    CHECK(vertices[0] == 0 && vertices[1] == 1);
    FAILS(ricci_report_vertices(result, RICCI_REPORT_OBSTRUCTION, vertices, 1), RICCI_BUFFER_TOO_SMALL,
          "vertices");
    FAILS(ricci_report_vertices(result, RICCI_REPORT_OBSTRUCTION, NULL, 2), RICCI_NULL_POINTER, "vertices");
    CHECK(summary.n_worst > 1 && summary.n_worst <= 96);
    OK(ricci_report_vertices(result, RICCI_REPORT_WORST, vertices, 96));
    OK(ricci_report_values(result, RICCI_REPORT_WORST_ERRORS, errors, 96));
    CHECK(fabs(errors[0]) == summary.max_curvature_error);
    for (size_t i = 1; i < summary.n_worst; i++) CHECK(fabs(errors[i]) <= fabs(errors[i - 1]));
    FAILS(ricci_report_values(result, RICCI_REPORT_WORST_ERRORS, NULL, 96), RICCI_NULL_POINTER, "values");
    FAILS(ricci_report_values(result, RICCI_REPORT_WORST_ERRORS, errors, 0), RICCI_BUFFER_TOO_SMALL,
          "values");
    /* The target comes back, and its cones with it. */
    double *asked = (double *)room(t.n_vertices, sizeof *asked);
    OK(ricci_report_values(result, RICCI_REPORT_TARGET, asked, t.n_vertices));
    for (size_t v = 0; v < t.n_vertices; v++) CHECK(fabs(asked[v] - target[v]) < 1e-14);
    OK(ricci_report_vertices(result, RICCI_REPORT_CONES, vertices, 96));
    CHECK(summary.n_cones == t.n_vertices && vertices[95] == 95);
    free(asked);
    ricci_metric_free(result);
    result = NULL;

    /* Below the bound of a single vertex: refused at once, with the vertex and the amount. */
    target[0] = -4.5 * pi;
    target[1] = -1.7 * pi;
    FAILS(flow_to(metric, target, t.n_vertices, NULL, NULL, &result), RICCI_TARGET_BELOW, "vertex 0");
    CHECK(strstr(ricci_last_error(), "too small by 1.5708") && result == NULL);
    ricci_metric_free(metric);
    ricci_mesh_free(mesh);
    free(target);
    torus_free(&t);
    return 0;
}
