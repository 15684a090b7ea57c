/* A pyramid of four triangles is flattened. */
#include <ricci/ricci.h>
#include <stdio.h>

#define TRY(call)                                                                                            \
    if ((call) != RICCI_OK) return fprintf(stderr, "%s: %s\n", #call, ricci_last_error()), 1

int main(void) {
    const double positions[5][3] = {{0, 0, 0.3}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
    const uint32_t faces[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
    double uv[24];
    ricci_mesh *mesh;
    ricci_metric *metric, *flat;
    ricci_layout *layout;
    TRY(ricci_mesh_from_arrays(positions[0], 0, 5, faces[0], 4, &mesh));
    TRY(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    TRY(ricci_flow(metric, NULL, NULL, NULL, &flat));
    TRY(ricci_layout_new(flat, NULL, NULL, &layout));
    TRY(ricci_layout_uv(layout, RICCI_ON_INPUT, uv, 24));
    printf("ricci %s: corner 0 of face 0 at (%g, %g)\n", ricci_version(), uv[0], uv[1]);
    ricci_layout_free(layout), ricci_metric_free(flat), ricci_metric_free(metric), ricci_mesh_free(mesh);
    return 0;
}
