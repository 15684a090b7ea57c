#include <ricci/ricci.h>
#include <stdio.h>

#define TRY(call)                                                                                            \
    if ((call) != RICCI_OK) return fprintf(stderr, "%s\n", ricci_last_error()), 1

int main(int argc, char **argv) {
    ricci_mesh *mesh;
    ricci_metric *metric, *flat;
    ricci_layout *layout;
    TRY(ricci_mesh_read(argc > 1 ? argv[1] : "mesh.obj", &mesh));
    TRY(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    TRY(ricci_flow(metric, NULL, NULL, NULL, &flat)); /* the default target */
    TRY(ricci_layout_new(flat, NULL, NULL, &layout));
    TRY(ricci_layout_write(layout, RICCI_ON_INPUT, 0, argc > 2 ? argv[2] : "uv.obj"));
    ricci_layout_free(layout), ricci_metric_free(flat), ricci_metric_free(metric), ricci_mesh_free(mesh);
    return 0;
}
