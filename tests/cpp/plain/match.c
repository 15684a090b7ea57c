/* Maps between two surfaces through the C face: identities, landmarks, what is carried, what is refused. */
#include "samples.h"
#include <math.h>
#include <ricci/match.h>

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
    given.on = RICCI_ON_METRIC;
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
