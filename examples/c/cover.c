/* A surface of genus 2 as the quotient of the hyperbolic plane: its generators, and a piece of its universal
 * cover, written copy by copy into one OBJ file of the Poincare disk. */
#include <ricci/shapes.h>
#include <ricci/uniformize.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* Every call may fail; its message says what to do. */
static void check(ricci_status status) {
    if (status != RICCI_OK) {
        fprintf(stderr, "%s: %s\n", ricci_status_text(status), ricci_last_error());
        exit(1);
    }
}

static ricci_status make_surface(ricci_mesh **mesh) {
    ricci_shape shape;
    check(ricci_init(&shape, sizeof shape));
    shape.shape = RICCI_SHAPE_GENUS, shape.genus = 2, shape.n = 2;
    return ricci_make(&shape, mesh);
}

int main(int argc, char **argv) {
    ricci_mesh *mesh;
    if (argc > 1)
        check(ricci_mesh_read(argv[1], &mesh));
    else
        check(make_surface(&mesh));
    ricci_uniform *quotient;
    ricci_uniform_summary figures;
    check(ricci_uniformize(mesh, NULL, NULL, &quotient));
    check(ricci_uniform_summarise(quotient, &figures, sizeof figures));
    printf("genus %zu, area %.6f, corners agree to %.1e, relation holds to %.1e\n", figures.genus,
           figures.area, figures.disagreement, figures.relation_residual);

    ricci_deck *generators;
    double *lengths = malloc(figures.n_generators * sizeof *lengths);
    check(ricci_deck_new(quotient, NULL, NULL, &generators));
    check(ricci_deck_values(generators, RICCI_DECK_LENGTH, lengths, figures.n_generators));
    for (size_t k = 0; k < figures.n_generators; k++)
        printf("%c%zu is freely homotopic to a closed geodesic of length %.6f\n", "ab"[k % 2], k / 2 + 1,
               lengths[k]);

    /* One copy: points and the faces between them. */
    ricci_layout *layout;
    ricci_layout_summary laid;
    check(ricci_uniform_layout(quotient, RICCI_ON_METRIC, RICCI_MODEL_POINCARE, NULL, &layout));
    check(ricci_layout_summarise(layout, &laid, sizeof laid));
    const size_t n = laid.n_points, n_faces = laid.n_faces;
    double *points = malloc(3 * n * sizeof *points), *moved = malloc(3 * n * sizeof *moved);
    uint32_t *corners = malloc(3 * n_faces * sizeof *corners);
    check(ricci_layout_points(layout, RICCI_MODEL_AMBIENT, points, 3 * n));
    check(ricci_layout_corners(layout, RICCI_ON_METRIC, corners, 3 * n_faces));

    /* Where the others are, each once. */
    ricci_deck *cover;
    ricci_deck_summary copies;
    ricci_deck_spec spec;
    check(ricci_init(&spec, sizeof spec));
    spec.kind = RICCI_DECK_DEPTH, spec.depth = 2, spec.limit = 1000;
    check(ricci_deck_new(quotient, &spec, NULL, &cover));
    check(ricci_deck_summarise(cover, &copies, sizeof copies));
    FILE *file = fopen(argc > 2 ? argv[2] : "cover.obj", "w");
    if (!file) return perror("cover.obj"), 1;
    for (size_t g = 0; g < copies.n_elements; g++) {
        check(ricci_deck_apply(cover, g, points, n, moved, 3 * n));
        for (size_t i = 0; i < n; i++) {
            if (figures.space == RICCI_SPACE_H2)
                ricci_from_hyperboloid(RICCI_MODEL_POINCARE, moved + 3 * i, moved + 3 * i);
            fprintf(file, "v %.17g %.17g 0\n", moved[3 * i], moved[3 * i + 1]);
        }
        for (size_t f = 0; f < n_faces; f++)
            fprintf(file, "f %zu %zu %zu\n", g * n + corners[3 * f] + 1, g * n + corners[3 * f + 1] + 1,
                    g * n + corners[3 * f + 2] + 1);
    }
    const int failed = fclose(file) != 0;
    printf("%zu copies of %zu faces\n", copies.n_elements, n_faces);

    free(lengths), free(points), free(moved), free(corners);
    ricci_deck_free(cover), ricci_deck_free(generators), ricci_uniform_free(quotient);
    ricci_layout_free(layout), ricci_mesh_free(mesh);
    return failed || !figures.converged;
}
