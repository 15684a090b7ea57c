/* Bounds of period matrices through the C face: known moduli, widths that are asked for, and closed
 * geodesics. */
#include "samples.h"
#include <math.h>
#include <ricci/deck.h>
#include <ricci/match.h>
#include <ricci/moduli.h>
#include <ricci/shapes.h>

/* A flat torus is known to rounding, without further vertices. */
static void a_torus_is_known(void) {
    ricci_mesh *mesh = NULL;
    ricci_forms *forms = NULL;
    ricci_bounds_summary s;
    double matrix[3];
    OK(make_sized(RICCI_SHAPE_FLAT_TORUS, 5, 4, 0.25, 1.5, 0, &mesh));
    OK(ricci_forms_new(mesh, NULL, NULL, &forms));
    OK(ricci_forms_bounds(forms, NULL, NULL, matrix, 3, &s, sizeof s));
    CHECK(s.gap >= 0 && s.gap < 1e-10 && s.reached == 1 && s.n_added == 0 && s.n_systems == 1);
    CHECK(hypot(s.modulus[0] - 0.25, s.modulus[1] - 1.5) <= s.modulus_radius + 1e-14);
    CHECK(matrix[1] > 0 && matrix[2] >= 0 && matrix[2] < 1e-9);
    FAILS(ricci_forms_bounds(forms, NULL, NULL, matrix, 2, &s, sizeof s), RICCI_BUFFER_TOO_SMALL, "3");
    FAILS(ricci_forms_bounds(forms, NULL, NULL, matrix, 3, NULL, sizeof s), RICCI_NULL_POINTER, "summary");
    FAILS(ricci_forms_bounds(forms, NULL, NULL, matrix, 3, &s, 7), RICCI_STRUCT_SIZE, "size");
    ricci_forms_free(forms), ricci_mesh_free(mesh);
}

/* Bounds of several widths, by linear and quadratic functions, agree within their radii. */
static void bounds_agree(void) {
    ricci_mesh *mesh = NULL;
    ricci_forms *forms = NULL;
    ricci_bounds_options options;
    ricci_bounds_summary s;
    double narrow[12], other[12];
    INIT(options);
    OK(make_genus(2, 4, 0, &mesh));
    OK(ricci_forms_new(mesh, NULL, NULL, &forms));
    options.width = 1e-5;
    OK(ricci_forms_bounds(forms, &options, NULL, narrow, 12, &s, sizeof s));
    CHECK(s.reached == 1 && s.gap <= 1e-5 && s.first_gap > 1e-3 && s.n_added > 0 && isnan(s.modulus[0]));
    for (int i = 0; i < 4; i++) {
        options.width = i < 2 ? HUGE_VAL : 1e-3, options.degree = (uint32_t)(i % 2);
        OK(ricci_forms_bounds(forms, &options, NULL, other, 12, &s, sizeof s));
        CHECK(i < 2 ? s.n_systems == 1 : s.gap <= 1e-3);
        for (int k = 0; k < 4; k++) {
            const double *a = narrow + 3 * k, *b = other + 3 * k;
            CHECK(hypot(a[0] - b[0], a[1] - b[1]) <= a[2] + b[2]);
        }
    }
    options.width = 1e-9, options.most_unknowns = 500;
    OK(ricci_forms_bounds(forms, &options, NULL, other, 12, &s, sizeof s));
    CHECK(s.reached == 0 && s.gap > 1e-9 && s.n_unknowns >= 500);
    options.degree = 2;
    FAILS(ricci_forms_bounds(forms, &options, NULL, other, 12, &s, sizeof s), RICCI_ARGUMENT, "degree");
    options.degree = 0, options.width = -1;
    FAILS(ricci_forms_bounds(forms, &options, NULL, other, 12, &s, sizeof s), RICCI_ARGUMENT, "width");
    options.width = NAN;
    FAILS(ricci_forms_bounds(forms, &options, NULL, other, 12, &s, sizeof s), RICCI_ARGUMENT, "width");
    ricci_forms_free(forms), ricci_mesh_free(mesh);
}

static void open_surfaces_are_refused(void) {
    ricci_mesh *disk = NULL;
    ricci_forms *forms = NULL;
    ricci_bounds_summary s;
    OK(make_disk(4, &disk));
    OK(ricci_forms_new(disk, NULL, NULL, &forms));
    FAILS(ricci_forms_bounds(forms, NULL, NULL, NULL, 0, &s, sizeof s), RICCI_LAYOUT, "closed");
    ricci_forms_free(forms), ricci_mesh_free(disk);
}

/* The shortest closed geodesics of the Bolza surface are twelve of length 2 arcosh(1 + sqrt 2). */
static void bolza_has_its_systoles(void) {
    ricci_mesh *mesh = NULL;
    ricci_uniform *uniform = NULL;
    ricci_deck *deck = NULL;
    ricci_deck_spec spec;
    ricci_deck_summary s;
    double lengths[64], powers[64];
    size_t n = 0, n_faces = 0;
    INIT(spec);
    OK(make_bolza(1, &mesh));
    OK(ricci_uniformize(mesh, NULL, NULL, &uniform));
    spec.kind = RICCI_DECK_GEODESICS, spec.radius = 3.1, spec.limit = 100000;
    OK(ricci_deck_new(uniform, &spec, NULL, &deck));
    OK(ricci_deck_summarise(deck, &s, sizeof s));
    CHECK(s.n_elements == 12);
    OK(ricci_deck_values(deck, RICCI_DECK_LENGTH, lengths, 64));
    OK(ricci_deck_values(deck, RICCI_DECK_POWER, powers, 64));
    for (size_t k = 0; k < 12; k++) {
        CHECK(fabs(lengths[k] - 2 * acosh(1 + sqrt(2))) < 1e-10 && powers[k] == 1);
        OK(ricci_deck_geodesic(deck, k, NULL, NULL, 0, NULL, 0, &n));
        CHECK(n > 2);
        uint32_t *faces = (uint32_t *)room(n, sizeof *faces);
        double *weights = (double *)room(3 * n, sizeof *weights);
        OK(ricci_deck_geodesic(deck, k, NULL, faces, n, weights, 3 * n, &n_faces));
        for (size_t i = 0; i < n; i++)
            CHECK(fabs(weights[3 * i] + weights[3 * i + 1] + weights[3 * i + 2] - 1) < 1e-9);
        CHECK(n_faces == n);
        FAILS(ricci_deck_geodesic(deck, k, NULL, faces, n, weights, n, &n_faces), RICCI_BUFFER_TOO_SMALL,
              "weights");
        free(faces), free(weights);
    }
    double curves[6];
    OK(ricci_fenchel_nielsen(uniform, curves, 6));
    for (size_t k = 0; k < 3; k++) CHECK(curves[2 * k] > 3.05 && isfinite(curves[2 * k + 1]));
    FAILS(ricci_fenchel_nielsen(uniform, curves, 5), RICCI_BUFFER_TOO_SMALL, "6");
    FAILS(ricci_deck_geodesic(deck, 12, NULL, NULL, 0, NULL, 0, &n), RICCI_ARGUMENT, "element");
    ricci_deck_free(deck), deck = NULL;
    OK(ricci_deck_new(uniform, NULL, NULL, &deck));
    FAILS(ricci_deck_values(deck, RICCI_DECK_POWER, powers, 64), RICCI_ARGUMENT, "GEODESICS");
    ricci_deck_free(deck), deck = NULL;
    spec.radius = 0;
    FAILS(ricci_deck_new(uniform, &spec, NULL, &deck), RICCI_ARGUMENT, "length");
    spec.radius = 9, spec.limit = 100;
    FAILS(ricci_deck_new(uniform, &spec, NULL, &deck), RICCI_TOO_LARGE, "copies");
    ricci_uniform_free(uniform), ricci_mesh_free(mesh);
}

/* Lengths and twists lead to a surface, and its loops back to them. */
static void coordinates_lead_back(void) {
    static const double given[] = {2, 0.4, 3, -1, 1.5, 0, 0.7, 0},
                        crooked[] = {2, 0.4, 3, -1, 1.5, 1, 0.7, 0};
    ricci_mesh *mesh = NULL;
    ricci_uniform *uniform = NULL;
    ricci_deck *deck = NULL;
    ricci_shape shape;
    int32_t *edges;
    size_t starts[5];
    double found[4];
    INIT(shape);
    shape.shape = RICCI_SHAPE_FENCHEL_NIELSEN, shape.genus = 1, shape.n = 1;
    shape.points = given, shape.n_points = 4;
    OK(ricci_make(&shape, &mesh));
    FAILS(ricci_make_loops(&shape, NULL, 0, starts, 5), RICCI_BUFFER_TOO_SMALL, "edges");
    edges = (int32_t *)room(100000, sizeof *edges);
    OK(ricci_make_loops(&shape, edges, 100000, starts, 5));
    CHECK(starts[0] == 0 && starts[4] > starts[3] && starts[3] > starts[2]);
    FAILS(ricci_make_loops(NULL, edges, 100000, starts, 5), RICCI_NULL_POINTER, "shape");
    OK(ricci_uniformize(mesh, NULL, NULL, &uniform));
    OK(ricci_fenchel_nielsen_of_loops(uniform, edges, starts, 4, NULL, found, 4));
    for (size_t k = 0; k < 4; k++) CHECK(fabs(found[k] - given[k]) < 1e-10);
    FAILS(ricci_fenchel_nielsen_of_loops(uniform, edges, starts, 3, NULL, found, 4), RICCI_WRONG_SIZE,
          "canonical basis");
    FAILS(ricci_fenchel_nielsen_of_loops(uniform, edges, starts + 1, 3, NULL, found, 4), RICCI_ARGUMENT,
          "starts");
    FAILS(ricci_fenchel_nielsen_of_loops(NULL, edges, starts, 4, NULL, found, 4), RICCI_NULL_POINTER,
          "uniform");
    OK(ricci_deck_new(uniform, NULL, NULL, &deck));
    FAILS(ricci_deck_pants(deck, NULL, found, 4), RICCI_WRONG_SIZE, "pants");
    FAILS(ricci_deck_pants(NULL, NULL, found, 4), RICCI_NULL_POINTER, "deck");
    ricci_deck_free(deck), ricci_uniform_free(uniform), ricci_mesh_free(mesh), mesh = NULL;
    shape.points = crooked;
    FAILS(ricci_make(&shape, &mesh), RICCI_ARGUMENT, "twist");
    shape.shape = RICCI_SHAPE_BOLZA;
    FAILS(ricci_make_loops(&shape, edges, 100000, starts, 5), RICCI_ARGUMENT, "loops");
    free(edges);
}

/* Words of curves that cut a surface into pairs of pants, and words that do not. */
static void words_name_pants(void) {
    static const int32_t letters[] = {1, 3, 1, 2, -1, -2}, crossing[] = {1, 2, 3};
    static const size_t starts[] = {0, 1, 2, 6}, single[] = {0, 1, 2, 3};
    ricci_mesh *mesh = NULL;
    ricci_uniform *uniform = NULL;
    ricci_deck *deck = NULL;
    ricci_deck_spec spec;
    double found[6], canonical[6];
    OK(make_genus(2, 4, 1, &mesh));
    OK(ricci_uniformize(mesh, NULL, NULL, &uniform));
    OK(ricci_fenchel_nielsen(uniform, canonical, 6));
    INIT(spec);
    spec.kind = RICCI_DECK_WORDS, spec.letters = letters, spec.n_letters = 6, spec.starts = starts,
    spec.n_words = 3;
    OK(ricci_deck_new(uniform, &spec, NULL, &deck));
    OK(ricci_deck_pants(deck, NULL, found, 6));
    for (size_t k = 0; k < 3; k++) CHECK(fabs(found[2 * k] - canonical[2 * k]) < 1e-10);
    FAILS(ricci_deck_pants(deck, NULL, found, 5), RICCI_BUFFER_TOO_SMALL, "6");
    ricci_deck_free(deck), deck = NULL;
    spec.letters = crossing, spec.n_letters = 3, spec.starts = single;
    OK(ricci_deck_new(uniform, &spec, NULL, &deck));
    FAILS(ricci_deck_pants(deck, NULL, found, 6), RICCI_LAYOUT, "a1 and b1 cross");
    ricci_deck_free(deck), ricci_uniform_free(uniform), ricci_mesh_free(mesh);
}

/* A ring between circles has a modulus near that of the round one. */
static void moduli_are_bounded(void) {
    ricci_mesh *mesh = NULL;
    ricci_bounds_options options;
    ricci_bounds_summary s;
    double interval[2];
    static const uint32_t corners[] = {0, 1, 2, 3};
    INIT(options);
    options.width = 1e-5;
    OK(make_sized(RICCI_SHAPE_ANNULUS, 24, 96, 0.4, 1, 0, &mesh));
    OK(ricci_modulus_bounds(mesh, NULL, &options, NULL, interval, &s, sizeof s));
    CHECK(s.reached == 1 && interval[0] < interval[1] && interval[1] < interval[0] * (1 + 2.1e-5));
    CHECK(fabs(interval[0] - log(2.5) / 6.283185307179586) < 2e-3);
    FAILS(ricci_modulus_bounds(mesh, corners, &options, NULL, interval, &s, sizeof s), RICCI_ARGUMENT,
          "annulus");
    FAILS(ricci_modulus_bounds(mesh, NULL, &options, NULL, NULL, &s, sizeof s), RICCI_NULL_POINTER,
          "interval");
    FAILS(ricci_modulus_bounds(NULL, NULL, &options, NULL, interval, &s, sizeof s), RICCI_NULL_POINTER,
          "mesh");
    ricci_mesh_free(mesh);
}

/* The affine map of flat tori is extremal; its dilatation is bracketed closely. */
static void tori_have_a_distance(void) {
    ricci_mesh *source = NULL, *target = NULL;
    ricci_matching *matching = NULL;
    ricci_dilatation_bracket bracket;
    OK(make_sized(RICCI_SHAPE_FLAT_TORUS, 6, 6, 0, 1, 0, &source));
    OK(make_sized(RICCI_SHAPE_FLAT_TORUS, 5, 5, 0, 3, 0, &target));
    OK(ricci_match(source, target, NULL, NULL, &matching));
    OK(ricci_matching_bracket(matching, NULL, NULL, NULL, &bracket, sizeof bracket));
    CHECK(bracket.lower_by == RICCI_LOWER_PERIODS && bracket.lower > 1);
    CHECK(bracket.lower <= bracket.upper * (1 + 1e-9) && bracket.upper < bracket.lower * (1 + 1e-6));
    FAILS(ricci_matching_bracket(matching, NULL, NULL, NULL, NULL, sizeof bracket), RICCI_NULL_POINTER,
          "bracket");
    FAILS(ricci_matching_bracket(NULL, NULL, NULL, NULL, &bracket, sizeof bracket), RICCI_NULL_POINTER,
          "matching");
    ricci_matching_free(matching), ricci_mesh_free(source), ricci_mesh_free(target);
}

int main(void) {
    a_torus_is_known();
    bounds_agree();
    open_surfaces_are_refused();
    bolza_has_its_systoles();
    coordinates_lead_back();
    words_name_pants();
    moduli_are_bounded();
    tori_have_a_distance();
    return 0;
}
