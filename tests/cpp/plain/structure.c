/* Geometric structures through the C face: transitions carry shared vertices onto each other by our own
 * arithmetic, generators of the holonomy keep their relation, points are found in all their charts. */
#include "samples.h"
#include <math.h>
#include <ricci/structure.h>

static ricci_structure_summary summary_of(const ricci_structure *structure) {
    ricci_structure_summary s;
    OK(ricci_structure_summarise(structure, &s, sizeof s));
    return s;
}

/* The image of a point under a matrix of 8 or 9 numbers. */
static void image(const double *m, uint32_t n, const double *p, double *q) {
    if (n == 9) {
        const double w = m[6] * p[0] + m[7] * p[1] + m[8];
        q[0] = (m[0] * p[0] + m[1] * p[1] + m[2]) / w, q[1] = (m[3] * p[0] + m[4] * p[1] + m[5]) / w;
        return;
    }
    const double a = m[0] * p[0] - m[1] * p[1] + m[2], b = m[0] * p[1] + m[1] * p[0] + m[3];
    const double c = m[4] * p[0] - m[5] * p[1] + m[6], d = m[4] * p[1] + m[5] * p[0] + m[7];
    q[0] = (a * c + b * d) / (c * c + d * d), q[1] = (b * c - a * d) / (c * c + d * d);
}

typedef struct {
    uint32_t *entries;
    size_t *starts;
} rows;

static rows rows_of(const ricci_structure *structure, uint32_t which, size_t n) {
    rows r;
    ricci_failure failure;
    r.starts = (size_t *)room(n + 1, sizeof *r.starts);
    CHECK(ricci_structure_rows(structure, which, NULL, 0, r.starts, n + 1) == RICCI_BUFFER_TOO_SMALL);
    OK(ricci_last_failure(&failure, sizeof failure));
    r.entries = (uint32_t *)room(failure.needed, sizeof *r.entries);
    OK(ricci_structure_rows(structure, which, r.entries, failure.needed, r.starts, n + 1));
    CHECK(r.starts[n] == failure.needed);
    return r;
}

static void rows_free(rows r) { free(r.entries), free(r.starts); }

/* Every pair of every transition; corners of charts lie counterclockwise. */
static void fits_together(const ricci_structure *structure) {
    const ricci_structure_summary s = summary_of(structure);
    CHECK(s.converged && s.n_folded == 0 && s.transition_residual < 1e-9 && s.cocycle_residual < 1e-9);
    CHECK(s.relation_residual < 1e-8 && s.max_curvature_error < 1e-10 && s.n_triples > 0);
    const rows faces = rows_of(structure, RICCI_CHART_FACES, s.n_charts);
    const rows corners = rows_of(structure, RICCI_CHART_CORNERS, s.n_charts);
    const rows vertices = rows_of(structure, RICCI_CHART_VERTICES, s.n_charts);
    const rows pairs = rows_of(structure, RICCI_TRANSITION_PAIRS, s.n_transitions);
    uint32_t *triangles = (uint32_t *)room(3 * s.n_faces, sizeof *triangles);
    uint32_t *ends = (uint32_t *)room(2 * s.n_transitions, sizeof *ends);
    double *matrices = (double *)room(s.n_transitions * s.n_matrix, sizeof *matrices);
    double **at = (double **)room(s.n_charts, sizeof *at);
    OK(ricci_structure_list(structure, RICCI_STRUCTURE_TRIANGLES, triangles, 3 * s.n_faces));
    OK(ricci_structure_transitions(structure, ends, 2 * s.n_transitions, matrices,
                                   s.n_transitions * s.n_matrix));
    for (size_t c = 0; c < s.n_charts; c++) {
        const size_t n = vertices.starts[c + 1] - vertices.starts[c];
        at[c] = (double *)room(2 * n, sizeof **at);
        OK(ricci_structure_coordinates(structure, c, at[c], 2 * n));
        for (size_t i = faces.starts[c]; i < faces.starts[c + 1]; i++) {
            const uint32_t *own = corners.entries + corners.starts[c] + 3 * (i - faces.starts[c]);
            for (int k = 0; k < 3; k++)
                CHECK(vertices.entries[vertices.starts[c] + own[k]] == triangles[3 * faces.entries[i] + k]);
            const double *p = at[c] + 2 * own[0], *q = at[c] + 2 * own[1], *r = at[c] + 2 * own[2];
            CHECK((q[0] - p[0]) * (r[1] - p[1]) > (q[1] - p[1]) * (r[0] - p[0]));
        }
    }
    for (size_t t = 0; t < s.n_transitions; t++)
        for (size_t i = pairs.starts[t]; i < pairs.starts[t + 1]; i += 2) {
            const double *from = at[ends[2 * t]] + 2 * pairs.entries[i];
            const double *to = at[ends[2 * t + 1]] + 2 * pairs.entries[i + 1];
            double moved[2];
            image(matrices + t * s.n_matrix, s.n_matrix, from, moved);
            CHECK(hypot(moved[0] - to[0], moved[1] - to[1]) < 1e-9);
        }
    for (size_t c = 0; c < s.n_charts; c++) free(at[c]);
    free(at), free(matrices), free(ends), free(triangles);
    rows_free(pairs), rows_free(vertices), rows_free(corners), rows_free(faces);
}

/* A point of a face in the stars of its corners, carried from one to the other. */
static void points_are_carried(const ricci_structure *structure) {
    const double weights[3] = {0.5, 0.3, 0.2}, negative[3] = {1, -0.1, 0.1};
    uint32_t lifts[64], wrong[2] = {0, 1000000};
    double coordinates[64], moved[2];
    size_t n = 0;
    OK(ricci_structure_places(structure, 0, weights, NULL, NULL, 0, &n));
    CHECK(n == 3);
    OK(ricci_structure_places(structure, 0, weights, lifts, coordinates, 32, &n));
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            OK(ricci_structure_carry(structure, lifts + 2 * i, lifts + 2 * j, coordinates + 2 * i, 1, moved,
                                     2));
            CHECK(hypot(moved[0] - coordinates[2 * j], moved[1] - coordinates[2 * j + 1]) < 1e-11);
        }
    CHECK(ricci_structure_places(structure, 0, weights, lifts, coordinates, 2, &n) == RICCI_BUFFER_TOO_SMALL);
    FAILS(ricci_structure_places(structure, 0, negative, NULL, NULL, 0, &n), RICCI_ARGUMENT, "weights");
    FAILS(ricci_structure_places(structure, UINT32_MAX, weights, NULL, NULL, 0, &n), RICCI_ARGUMENT, "face");
    FAILS(ricci_structure_carry(structure, lifts, wrong, coordinates, 1, moved, 2), RICCI_ARGUMENT, "lifts");
}

/* c = a b, 3 x 3. */
static void multiply(const double *a, const double *b, double *c) {
    for (int i = 0; i < 9; i++)
        c[i] = a[i - i % 3] * b[i % 3] + a[i - i % 3 + 1] * b[3 + i % 3] + a[i - i % 3 + 2] * b[6 + i % 3];
}

/* The inverse of a matrix M of SO(2,1): J M^T J, J = diag(1, 1, -1). */
static void inverse_of(const double *m, double *inverse) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) inverse[3 * i + j] = ((i == 2) == (j == 2) ? 1 : -1) * m[3 * j + i];
}

/* a1 b1 a1^-1 b1^-1 a2 b2 a2^-1 b2^-1 = 1. */
static void the_relation_holds(const ricci_structure *structure) {
    double m[4][9], product[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, next[9], inverse[9], largest = 1;
    OK(ricci_structure_holonomy(structure, m[0], 36));
    for (int k = 0; k < 8; k++) {
        const double *letter = m[2 * (k / 4) + k % 2]; /* NOLINT: commutators */
        inverse_of(letter, inverse);
        multiply(product, k % 4 < 2 ? letter : inverse, next);
        memcpy(product, next, sizeof next);
        for (int i = 0; i < 9; i++) largest = fmax(largest, fabs(product[i]));
    }
    for (int i = 0; i < 9; i++) CHECK(fabs(product[i] - (i % 4 == 0)) < 1e-9 * largest);
    CHECK(largest > 10);
}

static ricci_structure *made(const ricci_mesh *mesh, uint32_t kind, uint32_t charts, uint32_t source) {
    ricci_structure_options options;
    ricci_structure *structure = NULL;
    INIT(options);
    options.charts = charts, options.source = source;
    OK(ricci_structure_new(mesh, kind, &options, NULL, &structure));
    CHECK(summary_of(structure).kind == kind);
    fits_together(structure);
    return structure;
}

static void genus_two(void) {
    ricci_mesh *mesh = NULL;
    ricci_structure *structure = NULL;
    ricci_structure_summary s;
    OK(make_genus(2, 4, 0, &mesh));
    structure = made(mesh, RICCI_STRUCTURE_PROJECTIVE, RICCI_CHARTS_STARS, 0);
    s = summary_of(structure);
    CHECK(s.space == RICCI_SPACE_H2 && s.n_matrix == 9 && s.n_generators == 4 && s.n_singular == 0);
    CHECK(s.n_charts == s.n_vertices && s.n_excluded == 0 && s.n_zeros == 0);
    points_are_carried(structure);
    the_relation_holds(structure);
    CHECK(ricci_structure_holonomy(structure, NULL, 0) == RICCI_BUFFER_TOO_SMALL);
    FAILS(ricci_structure_coordinates(structure, s.n_charts, NULL, 0), RICCI_ARGUMENT, "chart");
    FAILS(ricci_structure_list(structure, 9, NULL, 0), RICCI_ARGUMENT, "which");
    FAILS(ricci_structure_rows(structure, 9, NULL, 0, NULL, 0), RICCI_ARGUMENT, "which");
    ricci_structure_free(structure);
    structure = made(mesh, RICCI_STRUCTURE_HYPERBOLIC, RICCI_CHARTS_PATCHES, 0);
    CHECK(summary_of(structure).n_matrix == 8 && summary_of(structure).n_charts < s.n_charts);
    ricci_structure_free(structure);
    /* All curvature at a vertex that is chosen; or at the zeros of a form. */
    const uint32_t seven = 7;
    uint32_t found[8];
    ricci_structure_options options;
    INIT(options);
    options.singular = &seven;
    OK(ricci_structure_new(mesh, RICCI_STRUCTURE_AFFINE, &options, NULL, &structure));
    fits_together(structure);
    CHECK(summary_of(structure).n_singular == 1 && summary_of(structure).space == RICCI_SPACE_E2);
    OK(ricci_structure_list(structure, RICCI_STRUCTURE_SINGULAR, found, 1));
    CHECK(found[0] == 7);
    ricci_structure_free(structure);
    structure = made(mesh, RICCI_STRUCTURE_AFFINE, RICCI_CHARTS_STARS, RICCI_AFFINE_FORM);
    s = summary_of(structure);
    CHECK(s.n_zeros >= 1 && s.n_zeros <= 2);
    OK(ricci_structure_list(structure, RICCI_STRUCTURE_ZEROS, found, 2 * s.n_zeros));
    CHECK(found[1] + (s.n_zeros == 2 ? found[3] : 0) == 2);
    ricci_structure_free(structure);
    structure = NULL;
    FAILS(ricci_structure_new(mesh, RICCI_STRUCTURE_SPHERICAL, NULL, NULL, &structure), RICCI_ARGUMENT,
          "structure");
    FAILS(ricci_structure_new(mesh, 6, NULL, NULL, &structure), RICCI_ARGUMENT, "kind of structure is 6");
    options.source = 2;
    FAILS(ricci_structure_new(mesh, RICCI_STRUCTURE_AFFINE, &options, NULL, &structure), RICCI_ARGUMENT,
          "source");
    CHECK(ricci_structure_new(NULL, 0, NULL, NULL, &structure) == RICCI_NULL_POINTER && structure == NULL);
    ricci_structure_free(NULL);
    ricci_mesh_free(mesh);
}

int main(void) {
    ricci_mesh *mesh = NULL;
    ricci_structure *structure = NULL;
    genus_two();
    OK(make_genus(1, 4, 0, &mesh));
    structure = made(mesh, RICCI_STRUCTURE_AFFINE, RICCI_CHARTS_STARS, 0);
    CHECK(summary_of(structure).n_singular == 0 && summary_of(structure).n_generators == 2);
    ricci_structure_free(structure), ricci_mesh_free(mesh);
    OK(make_sphere(4, &mesh));
    structure = made(mesh, RICCI_STRUCTURE_SPHERICAL, RICCI_CHARTS_PATCHES, 0);
    CHECK(summary_of(structure).space == RICCI_SPACE_S2 && summary_of(structure).n_generators == 0);
    ricci_structure_free(structure);
    structure = made(mesh, RICCI_STRUCTURE_INTEGER, RICCI_CHARTS_PATCHES, 0);
    /* Two triangles for each quad, 8 cones of valence 3 at least, and no transition that rounding moved. */
    CHECK(summary_of(structure).n_faces % 2 == 0 && summary_of(structure).n_singular >= 8);
    CHECK(summary_of(structure).transition_residual == 0);
    ricci_structure_free(structure), ricci_mesh_free(mesh);
    return 0;
}
