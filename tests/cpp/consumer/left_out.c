/* With a library that was built without features, and with debug assertions: what is left out says so, what
 * is there works, a second release is refused. */
#include <ricci/bicubic.h>
#include <ricci/gifti.h>
#include <ricci/quads.h>
#include <ricci/scene.h>
#include <ricci/shapes.h>
#include <stdio.h>
#include <string.h>

#define MUST(condition)                                                                                      \
    do {                                                                                                     \
        if (!(condition)) {                                                                                  \
            fprintf(stderr, "line %d: %s\n", __LINE__, ricci_last_error());                                  \
            return 1;                                                                                        \
        }                                                                                                    \
    } while (0)

int main(void) {
    ricci_shape shape;
    ricci_mesh *mesh = NULL;
    ricci_metric *metric = NULL, *flat = NULL;
    ricci_spline *spline = NULL;
    ricci_seamless *seamless = NULL;
    ricci_gifti_notes *notes = NULL;
    ricci_scene *scene = NULL;
    MUST(ricci_init(&shape, sizeof shape) == RICCI_OK);
    shape.shape = RICCI_SHAPE_TORUS, shape.n = 16, shape.m = 8, shape.a = 2, shape.b = 1;
    MUST(ricci_make(&shape, &mesh) == RICCI_OK);
    MUST(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric) == RICCI_OK);
    MUST(ricci_flow(metric, NULL, NULL, NULL, &flat) == RICCI_OK);
    MUST(ricci_spline_fit_surface(flat, NULL, NULL, &spline) == RICCI_LEFT_OUT && !spline);
    MUST(strstr(ricci_last_error(), "splines were left out") != NULL);
    MUST(ricci_seamless_new(mesh, NULL, NULL, &seamless) == RICCI_LEFT_OUT && !seamless);
    MUST(ricci_gifti_notes_new(&notes) == RICCI_LEFT_OUT && !notes);
    MUST(ricci_scene_read("left_out.glb", &scene) == RICCI_UNKNOWN_FORMAT && !scene);
    MUST(ricci_mesh_write(mesh, NULL, "left_out.glb") == RICCI_UNKNOWN_FORMAT);
    MUST(ricci_mesh_write(mesh, NULL, "left_out.obj") == RICCI_OK);
    ricci_spline_free(spline);
    ricci_seamless_free(seamless);
    ricci_gifti_notes_free(notes);
    ricci_metric_free(flat);
    ricci_metric_free(metric);
    ricci_mesh_free(mesh);
    /* Builds with debug assertions know which handles are alive. */
    ricci_mesh_free(mesh);
    MUST(strstr(ricci_last_error(), "was freed before") != NULL);
    return 0;
}
