/* A torus of revolution, n x m vertices. */
#ifndef TORUS_H
#define TORUS_H

#include "check.h"
#include <math.h>

typedef struct {
    size_t n_vertices, n_faces;
    double *positions; /* n_vertices x 3 */
    uint32_t *faces;   /* n_faces x 3 */
} torus;

static inline torus torus_new(size_t n, size_t m) {
    torus t = {n * m, 2 * n * m, NULL, NULL};
    t.positions = (double *)malloc(3 * t.n_vertices * sizeof(double));
    t.faces = (uint32_t *)malloc(3 * t.n_faces * sizeof(uint32_t));
    CHECK(t.positions && t.faces);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < m; j++) {
            const double turn = 8 * atan(1.0), a = turn * i / n, b = turn * j / m;
            const double r = 2 + 0.8 * cos(b) + 0.1 * sin(3 * a);
            const size_t v = i * m + j, right = (i + 1) % n * m + j;
            const size_t up = i * m + (j + 1) % m, across = (i + 1) % n * m + (j + 1) % m;
            const size_t corners[6] = {v, right, across, v, across, up};
            t.positions[3 * v] = r * cos(a);
            t.positions[3 * v + 1] = r * sin(a);
            t.positions[3 * v + 2] = 0.8 * sin(b);
            for (int k = 0; k < 6; k++) t.faces[6 * v + k] = (uint32_t)corners[k];
        }
    return t;
}

static inline ricci_mesh *torus_mesh(const torus *t) {
    ricci_mesh *mesh = NULL;
    OK(ricci_mesh_from_arrays(t->positions, 0, t->n_vertices, t->faces, t->n_faces, &mesh));
    return mesh;
}

static inline void torus_free(torus *t) {
    free(t->positions);
    free(t->faces);
}

#endif
