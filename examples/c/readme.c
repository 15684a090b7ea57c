#include <ricci/ricci.h>
#include <stdio.h>
#include <stdlib.h>

#define TRY(call)                                                                                            \
    if ((call) != RICCI_OK) return fprintf(stderr, "%s\n", ricci_last_error()), 1

int main(int argc, char **argv) {
    ricci_mesh *mesh;
    ricci_metric *metric, *flat;
    ricci_layout *layout;
    ricci_mesh_summary size;
    TRY(ricci_mesh_read(argc > 1 ? argv[1] : "mesh.obj", &mesh));
    TRY(ricci_mesh_summarise(mesh, &size, sizeof size));
    TRY(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    double *target = malloc(size.n_vertices * sizeof *target);
    TRY(ricci_target_default(metric, target, size.n_vertices));
    TRY(ricci_flow(metric, target, size.n_vertices, NULL, NULL, &flat, NULL));
    TRY(ricci_layout_new(flat, target, size.n_vertices, NULL, &layout));
    TRY(ricci_layout_write_obj(layout, argc > 2 ? argv[2] : "uv.obj"));
    ricci_layout_free(layout), ricci_metric_free(flat), ricci_metric_free(metric), ricci_mesh_free(mesh);
    free(target);
    return 0;
}
