/* Meshes as arrays, measured with formulas of our own. */
#ifndef ARRAYS_H
#define ARRAYS_H

#include "torus.h"

static const double pi = 3.14159265358979323846;

/* A bump over a sheared square, n x n vertices: edges are flipped across its boundary, so it flows on its
 * double. */
static inline ricci_mesh *bump(size_t n) {
    double *positions = (double *)malloc(3 * n * n * sizeof *positions);
    uint32_t *faces = (uint32_t *)malloc(6 * n * n * sizeof *faces);
    size_t n_faces = 0;
    ricci_mesh *mesh = NULL;
    CHECK(positions && faces);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            const double x = 2.0 * i / (n - 1) - 1, y = 2.0 * j / (n - 1) - 1;
            const double point[3] = {x, 0.4 * y + 1.1 * x, exp(-4 * (x * x + y * y))};
            memcpy(positions + 3 * (i * n + j), point, sizeof point);
            if (i + 1 == n || j + 1 == n) continue;
            const size_t v = i * n + j, corners[6] = {v, v + n, v + n + 1, v, v + n + 1, v + 1};
            for (int k = 0; k < 6; k++) faces[3 * n_faces + k] = (uint32_t)corners[k];
            n_faces += 2;
        }
    OK(ricci_mesh_from_arrays(positions, 0, n * n, faces, n_faces, &mesh));
    free(positions), free(faces);
    return mesh;
}

/* A mesh as arrays. */
typedef struct {
    ricci_mesh_summary n;
    uint32_t *faces, *ends;
    int32_t *face_edges;
    double *lengths, *positions;
} arrays;

static inline arrays arrays_of(const ricci_mesh *mesh, int in_space) {
    arrays a = {0};
    OK(ricci_mesh_summarise(mesh, &a.n, sizeof a.n));
    a.faces = (uint32_t *)room(3 * a.n.n_faces, sizeof *a.faces);
    a.ends = (uint32_t *)room(2 * a.n.n_edges, sizeof *a.ends);
    a.face_edges = (int32_t *)room(3 * a.n.n_faces, sizeof *a.face_edges);
    a.lengths = (double *)room(a.n.n_edges, sizeof *a.lengths);
    OK(ricci_mesh_faces(mesh, a.faces, 3 * a.n.n_faces));
    OK(ricci_mesh_edges(mesh, a.ends, 2 * a.n.n_edges));
    OK(ricci_mesh_face_edges(mesh, a.face_edges, 3 * a.n.n_faces));
    OK(ricci_mesh_values(mesh, RICCI_LENGTHS, a.lengths, a.n.n_edges));
    if (in_space) {
        a.positions = (double *)room(3 * a.n.n_vertices, sizeof *a.positions);
        OK(ricci_mesh_values(mesh, RICCI_POSITIONS, a.positions, 3 * a.n.n_vertices));
    }
    return a;
}

static inline void arrays_free(arrays *a) {
    free(a->faces), free(a->ends), free(a->face_edges), free(a->lengths), free(a->positions);
}

/* The length of the side opposite corner k. */
static inline double side(const arrays *a, size_t f, int k) {
    return a->lengths[abs(a->face_edges[3 * f + k % 3]) - 1];
}

static inline double heron(const arrays *a, size_t f) {
    const double x = side(a, f, 0), y = side(a, f, 1), z = side(a, f, 2), s = 0.5 * (x + y + z);
    return sqrt(s * (s - x) * (s - y) * (s - z));
}

/* The angle at corner k, by half-angles. */
static inline double angle(const arrays *a, size_t f, int k, uint32_t space) {
    double x = side(a, f, k), y = side(a, f, k + 1), z = side(a, f, k + 2), s = 0.5 * (x + y + z);
    double p = s - y, q = s - z, r = s - x;
    if (space == RICCI_SPACE_H2) s = sinh(s), p = sinh(p), q = sinh(q), r = sinh(r);
    return 2 * atan2(sqrt(p * q), sqrt(s * r));
}

#endif
