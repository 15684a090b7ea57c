/* Maps between two surfaces through the C face: identities, landmarks, carried values, refusals. */
#include "samples.h"
#include <math.h>
#include <ricci/match.h>
#include <ricci/uniformize.h>
#include <string.h>

static ricci_matching_summary summary_of(const ricci_matching *matching) {
    ricci_matching_summary s;
    OK(ricci_matching_summarise(matching, &s, sizeof s));
    return s;
}

/* The overlay of a surface and itself is that surface, up to rounding: values of both sides agree on it. */
static void check_map(const ricci_matching *matching, size_t n) {
    ricci_map *map = NULL, *none = NULL;
    ricci_map_summary s;
    OK(ricci_matching_map(matching, NULL, &map));
    OK(ricci_map_summarise(map, &s, sizeof s));
    CHECK(s.n_vertices >= n && s.n_pieces > 0 && s.n_faces >= s.n_pieces);
    double *values = (double *)room(n, sizeof *values),
           *weights = (double *)room(s.n_vertices, sizeof *weights);
    double *first = (double *)room(s.n_vertices, sizeof *first);
    double *second = (double *)room(s.n_vertices, sizeof *second);
    for (size_t k = 0; k < n; k++) values[k] = sin((double)k);
    ricci_carried given;
    INIT(given);
    given.values = values, given.n_values = n, given.n_components = 1;
    OK(ricci_map_carry(map, &given, first, s.n_vertices));
    given.on = RICCI_ON_TARGET;
    OK(ricci_map_carry(map, &given, second, s.n_vertices));
    OK(ricci_map_weights(map, weights, s.n_vertices));
    for (size_t v = 0; v < s.n_vertices; v++) {
        CHECK(fabs(first[v] - second[v]) < 1e-6 && weights[v] > 0);
        CHECK(v >= n || first[v] == values[v]);
    }
    FAILS(ricci_matching_map(NULL, NULL, &none), RICCI_NULL_POINTER, "matching");
    free(second), free(first), free(weights), free(values);
    ricci_map_free(map);
}

/* A surface goes to itself by the identity: values are carried as they are. */
static void check_identity(const ricci_mesh *mesh, const ricci_match_options *options) {
    ricci_matching *matching = NULL;
    OK(ricci_match(mesh, mesh, options, NULL, &matching));
    const ricci_matching_summary s = summary_of(matching);
    const size_t n = s.n_source_vertices;
    CHECK(s.n_target_vertices == n && s.n_flipped == 0 && s.n_markings > 0 && s.residual < 1e-9);
    uint32_t *faces = (uint32_t *)room(n, sizeof *faces);
    double *weights = (double *)room(3 * n, sizeof *weights), *values = (double *)room(2 * n, sizeof *values);
    double *carried = (double *)room(2 * n, sizeof *carried);
    for (size_t k = 0; k < 2 * n; k++) values[k] = sin((double)k);
    for (uint32_t direction = RICCI_MATCH_FORWARD; direction <= RICCI_MATCH_BACKWARD; direction++) {
        OK(ricci_matching_faces(matching, direction, faces, n));
        OK(ricci_matching_weights(matching, direction, weights, 3 * n));
        OK(ricci_matching_carry(matching, direction, values, 2 * n, carried, 2 * n));
        for (size_t v = 0; v < n; v++) {
            CHECK(fabs(weights[3 * v] + weights[3 * v + 1] + weights[3 * v + 2] - 1) < 1e-12);
            CHECK(fabs(carried[2 * v] - values[2 * v]) < 1e-7 &&
                  fabs(carried[2 * v + 1] - values[2 * v + 1]) < 1e-7);
        }
    }
    FAILS(ricci_matching_faces(matching, 2, faces, n), RICCI_ARGUMENT, "direction");
    FAILS(ricci_matching_faces(matching, 0, faces, n - 1), RICCI_BUFFER_TOO_SMALL, "faces");
    FAILS(ricci_matching_carry(matching, 0, values, n + 1, carried, n), RICCI_WRONG_SIZE, "values");
    check_map(matching, n);
    free(carried), free(values), free(weights), free(faces);
    ricci_matching_free(matching);
}

/* Points, curves and soft landmarks come back with where they went. */
static void check_marks(const ricci_mesh *torus) {
    ricci_matching *matching = NULL;
    ricci_match_options options;
    /* The first vertices of two faces, and the middle of a third face. */
    const uint32_t point_faces[4] = {10, 10, 50, 52};
    const double point_weights[12] = {1, 0, 0, 1, 0, 0, 0.25, 0.25, 0.5, 0.25, 0.25, 0.5};
    const uint32_t soft[2] = {40, 60};
    double soft_weights[1] = {1}, left[1], half, weights[12];
    uint32_t faces[4];
    INIT(options);
    options.point_faces = point_faces, options.point_weights = point_weights, options.n_points = 2;
    OK(ricci_match(torus, torus, &options, NULL, &matching));
    ricci_matching_summary s = summary_of(matching);
    CHECK(s.n_points == 2 && s.n_soft == 0 && s.point_error < 1e-8);
    FAILS(ricci_matching_points(matching, faces, 3, weights, 12), RICCI_BUFFER_TOO_SMALL, "faces");
    FAILS(ricci_matching_points(matching, faces, 4, weights, 11), RICCI_BUFFER_TOO_SMALL, "weights");
    OK(ricci_matching_points(matching, faces, 4, weights, 12));
    for (size_t k = 0; k < 2; k++) {
        CHECK(faces[2 * k + 1] == point_faces[2 * k + 1]);
        for (size_t i = 0; i < 3; i++) CHECK(weights[6 * k + 3 + i] == point_weights[6 * k + 3 + i]);
    }
    ricci_matching_free(matching);
    INIT(options);
    options.soft = soft, options.soft_weights = soft_weights, options.n_soft = 1;
    OK(ricci_match(torus, torus, &options, NULL, &matching));
    s = summary_of(matching);
    CHECK(s.n_points == 0 && s.n_soft == 1);
    FAILS(ricci_matching_soft_left(matching, left, 0), RICCI_BUFFER_TOO_SMALL, "left");
    OK(ricci_matching_soft_left(matching, left, 1));
    half = left[0];
    CHECK(half > 0);
    ricci_matching_free(matching);
    soft_weights[0] = 1e15;
    OK(ricci_match(torus, torus, &options, NULL, &matching));
    OK(ricci_matching_soft_left(matching, left, 1));
    CHECK(left[0] < 1e-12 * half);
    ricci_matching_free(matching);
    matching = NULL;
    soft_weights[0] = -1;
    FAILS(ricci_match(torus, torus, &options, NULL, &matching), RICCI_ARGUMENT, "weight");
    CHECK(matching == NULL);
}

/* Landmarks that are found are vertices; a surface that is its own mirror image is no other one's. */
static void check_found(const ricci_matching *matching) {
    ricci_found_landmarks all;
    uint32_t pairs[2 * 64];
    OK(ricci_matching_found(matching, &all, sizeof all));
    CHECK(all.reserved == 0 && all.mirror == 0 && all.has_kept == 1 && all.has_mirrored == 1);
    CHECK(all.n_signed > 0 && all.candidate < all.n_paired + all.n_signed && all.misfit < 0.1);
    const size_t n[3] = {all.n_used, all.n_kept, all.n_mirrored};
    const size_t n_vertices = summary_of(matching).n_source_vertices;
    for (uint32_t kind = 0; kind < 3; kind++) {
        CHECK(n[kind] <= 64);
        OK(ricci_matching_landmarks(matching, kind, pairs, 2 * n[kind]));
        for (size_t k = 0; k < 2 * n[kind]; k++) CHECK(pairs[k] < n_vertices);
    }
    CHECK(n[1] > 0);
    FAILS(ricci_matching_landmarks(matching, 1, pairs, 2 * n[1] - 1), RICCI_BUFFER_TOO_SMALL, "pairs");
    FAILS(ricci_matching_landmarks(matching, 3, pairs, 2 * 64), RICCI_ARGUMENT, "kind");
    FAILS(ricci_matching_found(NULL, &all, sizeof all), RICCI_NULL_POINTER, "matching");
}

/* The map of a small torus to itself, whose landmarks are looked for, is the identity and judged to be good.
 */
static void check_judgement(const ricci_mesh *torus) {
    ricci_matching *matching = NULL;
    ricci_matching_judgement all;
    OK(ricci_match_by_shape(torus, torus, NULL, NULL, &matching));
    OK(ricci_matching_judge(matching, NULL, &all, sizeof all));
    CHECK(all.verdict == RICCI_VERDICT_GOOD && all.reserved == 0 && all.agreement > 0.999);
    CHECK(all.area_log_99 < 1e-6 && all.qc_99 < 1 + 1e-6 && all.cycle_mean < 1e-6);
    FAILS(ricci_matching_judge(NULL, NULL, &all, sizeof all), RICCI_NULL_POINTER, "matching");
    check_found(matching);
    ricci_matching_free(matching);
    matching = NULL;
    FAILS(ricci_match_by_shape(torus, NULL, NULL, NULL, &matching), RICCI_NULL_POINTER, "mesh");
    CHECK(matching == NULL);
}

/* A curve, and the number of points that its vertices make. */
static void check_curves(const ricci_mesh *disk) {
    ricci_matching *matching = NULL;
    ricci_match_options options;
    /* From the centre of the disk to a vertex of the first ring, and to another one. */
    const uint32_t curves[4] = {0, 1, 0, 2}, far[4] = {0, 60, 0, 2}, sizes[2] = {2, 2};
    INIT(options);
    options.curves = curves, options.curve_sizes = sizes, options.n_curves = 1;
    OK(ricci_match(disk, disk, &options, NULL, &matching));
    const ricci_matching_summary s = summary_of(matching);
    CHECK(s.n_points == 2 && s.point_error < 1e-8);
    ricci_matching_free(matching);
    matching = NULL;
    options.curves = far;
    FAILS(ricci_match(disk, disk, &options, NULL, &matching), RICCI_MATCHING, "curve 0");
    CHECK(matching == NULL);
}

/* The class that loops name: the identity by the surface's own basis, a twist by a twisted one. */
static void check_basis(const ricci_mesh *torus) {
    ricci_matching *matching = NULL;
    ricci_homotopy *homotopy = NULL;
    ricci_homotopy_summary h;
    ricci_match_options options;
    OK(ricci_homotopy_new(torus, NULL, NULL, &homotopy));
    OK(ricci_homotopy_summarise(homotopy, &h, sizeof h));
    CHECK(h.n_generators == 2);
    int32_t *edges = (int32_t *)room(h.n_loop_edges, sizeof *edges);
    size_t starts[3];
    OK(ricci_homotopy_loops(homotopy, edges, h.n_loop_edges, starts, 3));
    const size_t a = starts[1], b = starts[2] - starts[1];
    int32_t *basis = (int32_t *)room(4 * (a + b), sizeof *basis);
    uint32_t sizes[4] = {(uint32_t)a, (uint32_t)a, (uint32_t)b, (uint32_t)b};
    memcpy(basis, edges, a * sizeof *basis);
    memcpy(basis + a, edges, a * sizeof *basis);
    memcpy(basis + 2 * a, edges + a, b * sizeof *basis);
    memcpy(basis + 2 * a + b, edges + a, b * sizeof *basis);
    INIT(options);
    options.basis = basis, options.basis_sizes = sizes, options.n_basis = 2;
    check_identity(torus, &options);
    OK(ricci_match(torus, torus, &options, NULL, &matching));
    const double energy = summary_of(matching).energy;
    CHECK(summary_of(matching).n_markings == 1);
    ricci_matching_free(matching);
    matching = NULL;
    /* b goes to b a a. */
    memcpy(basis + 2 * a + 2 * b, edges, a * sizeof *basis);
    memcpy(basis + 3 * a + 2 * b, edges, a * sizeof *basis);
    sizes[3] = (uint32_t)(2 * a + b);
    OK(ricci_match(torus, torus, &options, NULL, &matching));
    CHECK(summary_of(matching).energy > 1.05 * energy && summary_of(matching).n_flipped == 0);
    ricci_matching_free(matching);
    matching = NULL;
    basis[0] = 0;
    FAILS(ricci_match(torus, torus, &options, NULL, &matching), RICCI_ARGUMENT, "basis[0]");
    basis[0] = edges[0];
    options.n_basis = 1;
    FAILS(ricci_match(torus, torus, &options, NULL, &matching), RICCI_MATCHING, "generate");
    CHECK(matching == NULL);
    free(basis), free(edges);
    ricci_homotopy_free(homotopy);
}

/* Loops of a torus become circles where that is asked for. */
static void check_circles(const ricci_mesh *disk) {
    ricci_mesh *torus = NULL, *holes = NULL;
    ricci_matching *matching = NULL;
    ricci_match_options options;
    OK(make_sized(RICCI_SHAPE_TORUS, 36, 18, 2, 0.8, 0, &torus));
    OK(change(torus, RICCI_CHANGE_PUNCH, 2, 0, 0, &holes));
    OK(ricci_match(holes, holes, NULL, NULL, &matching));
    CHECK(summary_of(matching).n_circles == 0 && summary_of(matching).roundness == 0);
    ricci_matching_free(matching);
    INIT(options);
    options.loop_shape = RICCI_MATCH_CIRCLES;
    OK(ricci_match(holes, holes, &options, NULL, &matching));
    const ricci_matching_summary s = summary_of(matching);
    CHECK(s.n_circles == 2 && s.roundness < 1e-9 && s.n_flipped == 0 && s.distance_max < 1e-8);
    ricci_matching_free(matching);
    matching = NULL;
    FAILS(ricci_match(disk, disk, &options, NULL, &matching), RICCI_MATCHING, "circles");
    options.loop_shape = 2;
    FAILS(ricci_match(holes, holes, &options, NULL, &matching), RICCI_ARGUMENT, "shape");
    CHECK(matching == NULL);
    ricci_mesh_free(holes);
    ricci_mesh_free(torus);
}

int main(void) {
    ricci_mesh *sphere = NULL, *torus = NULL, *disk = NULL;
    ricci_matching *matching = NULL;
    ricci_match_options options;
    const uint32_t pairs[10] = {0, 0, 3, 3, 5, 5, 8, 8, 11, 11}, twice[6] = {0, 0, 3, 5, 8, 5};
    OK(make_sphere(4, &sphere));
    OK(make_disk(5, &disk));
    OK(make_sized(RICCI_SHAPE_TORUS, 12, 8, 2, 0.8, 0, &torus));
    check_identity(disk, NULL);
    check_identity(torus, NULL);
    check_marks(torus);
    check_judgement(torus);
    check_curves(disk);
    check_basis(torus);
    check_circles(disk);
    INIT(options);
    options.landmarks = pairs, options.n_landmarks = 5, options.threads = 1;
    check_identity(sphere, &options);
    INIT(options);
    options.boundary = RICCI_MATCH_ARC_LENGTH;
    check_identity(disk, &options);
    options.boundary = 2;
    FAILS(ricci_match(disk, disk, &options, NULL, &matching), RICCI_ARGUMENT, "boundaries");
    options.boundary = RICCI_MATCH_SLIDES;
    options.landmarks = pairs, options.n_landmarks = 5, options.threads = 1;
    FAILS(ricci_match(sphere, torus, NULL, NULL, &matching), RICCI_MATCHING, "genus");
    options.landmarks = twice, options.n_landmarks = 3;
    FAILS(ricci_match(sphere, sphere, &options, NULL, &matching), RICCI_MATCHING, "conflict");
    FAILS(ricci_match(NULL, sphere, NULL, NULL, &matching), RICCI_NULL_POINTER, "mesh");
    CHECK(matching == NULL);
    ricci_matching_free(NULL);
    ricci_mesh_free(disk);
    ricci_mesh_free(torus);
    ricci_mesh_free(sphere);
    return 0;
}
