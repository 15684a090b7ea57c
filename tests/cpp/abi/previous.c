/* A job compiled with the header of an earlier version, whose structs may be smaller, runs with the library
 * of this one. */
#include <ricci/ricci.h>
#include <stdio.h>

#define OK(call)                                                                                             \
    if ((call) != RICCI_OK) return fprintf(stderr, "%s: %s\n", #call, ricci_last_error()), 1

int main(void) {
    const double positions[5][3] = {{0, 0, 0.3}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
    const uint32_t faces[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
    double uv[24], factor[5];
    ricci_mesh *mesh;
    ricci_metric *metric, *flat;
    ricci_layout *layout;
    ricci_mesh_summary counts;
    ricci_report_summary report;
    ricci_layout_summary plane;
    ricci_flow_options options;
    OK(ricci_mesh_from_arrays(positions[0], 0, 5, faces[0], 4, &mesh));
    OK(ricci_mesh_summarise(mesh, &counts, sizeof counts));
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    OK(ricci_init(&options, sizeof options));
    options.tolerance = 1e-11;
    OK(ricci_flow(metric, NULL, &options, NULL, &flat));
    OK(ricci_report_summarise(flat, &report, sizeof report));
    OK(ricci_layout_new(flat, NULL, NULL, &layout));
    OK(ricci_layout_summarise(layout, &plane, sizeof plane));
    OK(ricci_layout_uv(layout, RICCI_ON_INPUT, uv, 24));
    OK(ricci_metric_values(flat, RICCI_METRIC_FACTOR, factor, 5));
    ricci_layout_free(layout), ricci_metric_free(flat), ricci_metric_free(metric), ricci_mesh_free(mesh);
    return !(counts.n_boundary_loops == 1 && counts.euler == 1 && report.converged && plane.n_flipped == 0 &&
             report.tolerance == 1e-11 && plane.n_input_faces == 4 &&
             ricci_version_number() >= RICCI_VERSION);
}
