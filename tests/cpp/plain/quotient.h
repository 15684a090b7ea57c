/* Quotients and deck transformations as arrays, with formulas of our own. */
#ifndef QUOTIENT_H
#define QUOTIENT_H

#include "arrays.h"
#include "samples.h"
#include <ricci/uniformize.h>

/* ricci_uniformize about this base. */
static inline ricci_status uniformize_at(const ricci_mesh *mesh, uint32_t base, ricci_uniform **uniform) {
    ricci_uniform_options options;
    INIT(options);
    options.base = &base;
    return ricci_uniformize(mesh, &options, NULL, uniform);
}

/* ricci_deck_new of one kind without further fields, of words, and of a piece of the cover. */
static inline ricci_status deck_of(const ricci_uniform *uniform, uint32_t kind,
                                   const ricci_dirichlet *dirichlet, ricci_deck **deck) {
    ricci_deck_spec spec;
    INIT(spec);
    spec.kind = kind, spec.dirichlet = dirichlet;
    return ricci_deck_new(uniform, &spec, NULL, deck);
}

static inline ricci_status words_of(const ricci_uniform *uniform, const int32_t *letters, size_t n,
                                    const size_t *starts, size_t n_words, ricci_deck **deck) {
    ricci_deck_spec spec;
    INIT(spec);
    spec.kind = RICCI_DECK_WORDS, spec.letters = letters, spec.n_letters = n, spec.starts = starts;
    spec.n_words = n_words;
    return ricci_deck_new(uniform, &spec, NULL, deck);
}

static inline ricci_status to_depth(const ricci_uniform *uniform, size_t depth, size_t limit,
                                    const ricci_control *control, ricci_deck **deck) {
    ricci_deck_spec spec;
    INIT(spec);
    spec.kind = RICCI_DECK_DEPTH, spec.depth = depth, spec.limit = limit;
    return ricci_deck_new(uniform, &spec, control, deck);
}

static inline ricci_status within(const ricci_uniform *uniform, const ricci_dirichlet *dirichlet,
                                  double radius, size_t limit, ricci_deck **deck) {
    ricci_deck_spec spec;
    INIT(spec);
    spec.kind = RICCI_DECK_WITHIN, spec.dirichlet = dirichlet, spec.radius = radius, spec.limit = limit;
    return ricci_deck_new(uniform, &spec, NULL, deck);
}

/* A layout: points of the hyperboloid or of the plane w = 1, and where every half-edge starts. */
typedef struct {
    ricci_uniform_summary s;
    ricci_layout_summary l;
    arrays a;
    double *points;    /* l.n_points x 3 */
    uint32_t *corners; /* l.n_faces x 3 */
    size_t *origin; /* per half-edge the point at its origin; half-edge 2 (e - 1) of edge e, 2 (e - 1) + 1 of
                       -e */
} laid;

static inline size_t halfedge(int32_t edge) { return 2 * (size_t)(abs(edge) - 1) + (edge < 0); }

static inline laid laid_of(const ricci_uniform *uniform) {
    laid l;
    ricci_layout *layout = NULL;
    ricci_metric *metric = NULL;
    ricci_mesh *mesh = NULL;
    OK(ricci_uniform_summarise(uniform, &l.s, sizeof l.s));
    OK(ricci_uniform_layout(uniform, RICCI_ON_METRIC, RICCI_MODEL_POINCARE, NULL, &layout));
    OK(ricci_layout_summarise(layout, &l.l, sizeof l.l));
    OK(ricci_uniform_metric(uniform, &metric));
    OK(ricci_metric_mesh(metric, &mesh));
    l.a = arrays_of(mesh, 0);
    l.points = (double *)room(3 * l.l.n_points, sizeof *l.points);
    l.corners = (uint32_t *)room(3 * l.l.n_faces, sizeof *l.corners);
    l.origin = (size_t *)room(2 * l.a.n.n_edges, sizeof *l.origin);
    OK(ricci_layout_points(layout, RICCI_MODEL_AMBIENT, l.points, 3 * l.l.n_points));
    OK(ricci_layout_corners(layout, RICCI_ON_METRIC, l.corners, 3 * l.l.n_faces));
    /* Side k of a face starts behind corner k. */
    for (size_t f = 0; f < l.l.n_faces; f++)
        for (size_t k = 0; k < 3; k++)
            l.origin[halfedge(l.a.face_edges[3 * f + k])] = l.corners[3 * f + (k + 1) % 3];
    ricci_mesh_free(mesh), ricci_metric_free(metric), ricci_layout_free(layout);
    return l;
}

static inline void laid_free(laid *l) {
    arrays_free(&l->a);
    free(l->points), free(l->corners), free(l->origin);
}

/* Deck transformations. */
typedef struct {
    ricci_deck_summary n;
    int32_t *letters;
    size_t *starts;
    double *matrices, *mobius, *traces, *lengths;
} elements;

static inline elements elements_of(const ricci_deck *deck) {
    elements e;
    OK(ricci_deck_summarise(deck, &e.n, sizeof e.n));
    e.letters = (int32_t *)room(e.n.n_letters, sizeof *e.letters);
    e.starts = (size_t *)room(e.n.n_elements + 1, sizeof *e.starts);
    e.matrices = (double *)room(9 * e.n.n_elements, sizeof *e.matrices);
    e.mobius = (double *)room(8 * e.n.n_elements, sizeof *e.mobius);
    e.traces = (double *)room(e.n.n_elements, sizeof *e.traces);
    e.lengths = (double *)room(e.n.n_elements, sizeof *e.lengths);
    OK(ricci_deck_words(deck, e.letters, e.n.n_letters, e.starts, e.n.n_elements + 1));
    OK(ricci_deck_values(deck, RICCI_DECK_MATRIX, e.matrices, 9 * e.n.n_elements));
    OK(ricci_deck_values(deck, RICCI_DECK_MOBIUS, e.mobius, 8 * e.n.n_elements));
    OK(ricci_deck_values(deck, RICCI_DECK_TRACE, e.traces, e.n.n_elements));
    OK(ricci_deck_values(deck, RICCI_DECK_LENGTH, e.lengths, e.n.n_elements));
    return e;
}

static inline void elements_free(elements *e) {
    free(e->letters), free(e->starts);
    free(e->matrices), free(e->mobius), free(e->traces), free(e->lengths);
}

static inline void times(const double *a, const double *b, double *product) {
    double c[9];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            c[3 * i + j] = 0;
            for (int k = 0; k < 3; k++) c[3 * i + j] += a[3 * i + k] * b[3 * k + j];
        }
    memcpy(product, c, sizeof c);
}

static inline void image(const double *m, const double *p, double *q) {
    for (int i = 0; i < 3; i++) q[i] = m[3 * i] * p[0] + m[3 * i + 1] * p[1] + m[3 * i + 2] * p[2];
}

/* The inverse of an isometry by the form it keeps: of (x, y, w) in SO+(2, 1), of a translation in the plane.
 */
static inline void inverse(const double *m, uint32_t space, double *out) {
    double c[9];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const double sign = (i == 2) != (j == 2) ? -1 : 1;
            c[3 * i + j] = space == RICCI_SPACE_H2 ? sign * m[3 * j + i]
                           : i == j                ? 1
                           : j == 2                ? -m[3 * i + 2]
                                                   : 0;
        }
    memcpy(out, c, sizeof c);
}

/* Distance of two points, from the square of their difference. */
static inline double distance(const double *p, const double *q, uint32_t space) {
    const double x = p[0] - q[0], y = p[1] - q[1], w = p[2] - q[2];
    if (space == RICCI_SPACE_E2) return hypot(x, y);
    return 2 * asinh(0.5 * sqrt(fmax(0, x * x + y * y - w * w)));
}

#endif
