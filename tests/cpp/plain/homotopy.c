/* Homotopy bases: loops, words, lifts and fundamental domains against each other and against the deck group's
 * matrices. */
#include "quotient.h"

/* Rows of edges or letters. */
typedef struct {
    size_t n;
    int32_t *entries;
    size_t *starts;
} rows;

static rows rows_new(size_t n, size_t n_entries) {
    rows r = {n, (int32_t *)room(n_entries, sizeof(int32_t)), (size_t *)room(n + 1, sizeof(size_t))};
    return r;
}

static void rows_free(rows *r) { free(r->entries), free(r->starts); }

static size_t row_length(const rows *r, size_t i) { return r->starts[i + 1] - r->starts[i]; }

static const int32_t *row(const rows *r, size_t i) { return r->entries + r->starts[i]; }

/* Two words are one element if the one times the inverse of the other reduces to nothing. */
static int equal(const ricci_homotopy *basis, const int32_t *u, size_t n_u, const int32_t *v, size_t n_v) {
    int32_t *word = (int32_t *)room(n_u + n_v, sizeof *word);
    size_t n = 0;
    for (size_t i = 0; i < n_u; i++) word[i] = u[i];
    for (size_t i = 0; i < n_v; i++) word[n_u + i] = -v[n_v - 1 - i];
    OK(ricci_homotopy_reduce(basis, word, n_u + n_v, NULL, 0, &n));
    free(word);
    return n == 0;
}

static ricci_homotopy_summary summary_of(const ricci_homotopy *basis) {
    ricci_homotopy_summary s;
    OK(ricci_homotopy_summarise(basis, &s, sizeof s));
    return s;
}

/* The relation, as the header spells it. */
static int32_t *relator_of(const ricci_homotopy_summary *s) {
    int32_t *relator = (int32_t *)room(s->n_relator, sizeof *relator);
    CHECK(s->n_relator == 4 * s->genus + s->n_boundary_loops);
    for (size_t i = 0; i < s->genus; i++) {
        const int32_t a = 2 * (int32_t)i + 1;
        relator[4 * i] = a, relator[4 * i + 1] = a + 1;
        relator[4 * i + 2] = -a, relator[4 * i + 3] = -a - 1;
    }
    for (size_t j = 0; j < s->n_boundary_loops; j++)
        relator[4 * s->genus + j] = (int32_t)(2 * s->genus + j) + 1;
    return relator;
}

/* Loops run along edges of the mesh from base to base; their words are their letters; they meet as they
 * should. */
static rows check_loops(const ricci_homotopy *basis, const ricci_mesh *mesh) {
    const ricci_homotopy_summary s = summary_of(basis);
    arrays a = arrays_of(mesh, 0);
    rows loops = rows_new(s.n_generators, s.n_loop_edges);
    int64_t *matrix = (int64_t *)room(s.n_generators * s.n_generators, sizeof *matrix);
    OK(ricci_homotopy_loops(basis, loops.entries, s.n_loop_edges, loops.starts, s.n_generators + 1));
    OK(ricci_homotopy_intersections(basis, matrix, s.n_generators * s.n_generators));
    for (size_t k = 0; k < s.n_generators; k++) {
        const size_t n = row_length(&loops, k);
        uint32_t at = (uint32_t)s.base;
        for (size_t i = 0; i < n; i++) {
            const int32_t e = row(&loops, k)[i];
            const size_t from = 2 * (size_t)(abs(e) - 1) + (e < 0);
            CHECK(a.ends[from] == at);
            at = a.ends[from ^ 1];
        }
        CHECK(n > 0 && at == s.base);
        /* The last boundary loop is spelled in the others. */
        const size_t letters = s.n_boundary_loops > 0 && k + 1 == s.n_generators ? s.n_relator - 1 : 1;
        const int32_t letter = (int32_t)k + 1;
        int32_t *word = (int32_t *)room(letters, sizeof *word);
        size_t n_word = 0;
        OK(ricci_homotopy_path_word(basis, row(&loops, k), n, NULL, 0, &n_word));
        CHECK(n_word == letters);
        OK(ricci_homotopy_path_word(basis, row(&loops, k), n, word, letters, &n_word));
        CHECK(n_word == letters && (letters > 1 || word[0] == letter) &&
              equal(basis, word, letters, &letter, 1));
        free(word);
        for (size_t j = 0; j < s.n_generators; j++) {
            const int pair = k < 2 * s.genus && (k ^ 1) == j;
            CHECK(matrix[s.n_generators * k + j] == (pair ? (k % 2 == 0 ? 1 : -1) : 0));
        }
    }
    free(matrix), arrays_free(&a);
    return loops;
}

/* Words are reduced, compared, written and read. */
static void check_words(const ricci_homotopy *basis) {
    const ricci_homotopy_summary s = summary_of(basis);
    int32_t *relator = relator_of(&s);
    CHECK(equal(basis, relator, s.n_relator, NULL, 0));
    /* The relation says what its first letter is: the inverse of the rest. */
    int32_t *rest = (int32_t *)room(s.n_relator, sizeof *rest);
    for (size_t i = 1; i < s.n_relator; i++) rest[i - 1] = -relator[s.n_relator - i];
    CHECK(equal(basis, relator, 1, rest, s.n_relator - 1));
    const int32_t ab[2] = {1, 2}, ba[2] = {2, 1}, back[4] = {1, 2, -2, -1}, none[1] = {0}, far[2] = {1, 99};
    CHECK(equal(basis, ab, 2, ba, 2) == (s.genus == 1 && s.n_boundary_loops == 0));
    size_t n = 77;
    OK(ricci_homotopy_reduce(basis, back, 4, NULL, 0, &n));
    CHECK(n == 0);
    OK(ricci_homotopy_reduce(basis, relator, s.n_relator, rest, s.n_relator, &n));
    CHECK(n == 0);
    int64_t *sums = (int64_t *)room(s.n_generators, sizeof *sums);
    OK(ricci_homotopy_homology(basis, back, 2, sums, s.n_generators));
    CHECK(sums[0] == 1 && sums[1] == 1);
    char text[64];
    const int32_t word[3] = {2, -1, -1};
    OK(ricci_homotopy_word_text(basis, word, 3, NULL, 0, &n));
    CHECK(n == strlen("b1 a1^-1 a1^-1") + 1);
    OK(ricci_homotopy_word_text(basis, word, 3, text, n, &n));
    CHECK(strcmp(text, "b1 a1^-1 a1^-1") == 0);
    int32_t read[3] = {0, 0, 0};
    OK(ricci_homotopy_word_parse(basis, text, read, 3, &n));
    CHECK(n == 3 && memcmp(read, word, sizeof word) == 0);
    FAILS(ricci_homotopy_word_parse(basis, "a1 z3", read, 3, &n), RICCI_ARGUMENT, "z3");
    FAILS(ricci_homotopy_word_parse(basis, NULL, read, 3, &n), RICCI_NULL_POINTER, "word");
    FAILS(ricci_homotopy_word_text(basis, word, 3, text, 4, &n), RICCI_BUFFER_TOO_SMALL, "15 entries");
    FAILS(ricci_homotopy_reduce(basis, none, 1, read, 3, &n), RICCI_ARGUMENT, "word[0] is 0");
    FAILS(ricci_homotopy_reduce(basis, far, 2, read, 3, &n), RICCI_ARGUMENT, "word[1] is 99");
    FAILS(ricci_homotopy_reduce(basis, word, 3, read, 2, &n), RICCI_BUFFER_TOO_SMALL, "3 entries");
    FAILS(ricci_homotopy_reduce(basis, word, 3, read, 3, NULL), RICCI_NULL_POINTER, "number of entries");
    CHECK(n == 3);
    free(relator), free(rest), free(sums);
}

/* A path that runs a loop and then the relation ends at that loop's element. */
static void check_lifts(const ricci_homotopy *basis, const rows *loops, const ricci_uniform *quotient) {
    const ricci_homotopy_summary s = summary_of(basis);
    int32_t *relator = relator_of(&s);
    int32_t *path = (int32_t *)room(4 * s.n_loop_edges + s.n_loop_edges, sizeof *path);
    size_t n = 0;
    for (size_t i = 0; i <= s.n_relator; i++) {
        const int32_t letter = i == 0 ? 2 : relator[i - 1];
        const size_t k = (size_t)abs(letter) - 1, m = row_length(loops, k);
        for (size_t j = 0; j < m; j++) path[n++] = letter > 0 ? row(loops, k)[j] : -row(loops, k)[m - 1 - j];
    }
    size_t *starts = (size_t *)room(n + 2, sizeof *starts), n_word = 0;
    const int32_t from[1] = {-1};
    ricci_lift lift;
    INIT(lift);
    lift.vertex = (uint32_t)s.base, lift.element = from, lift.n_element = 1, lift.path = path,
    lift.n_path = n;
    OK(ricci_homotopy_lift(basis, &lift, NULL, 0, starts, n + 2));
    int32_t *letters = (int32_t *)room(starts[n + 1], sizeof *letters), word = 0;
    OK(ricci_homotopy_lift(basis, &lift, letters, starts[n + 1], starts, n + 2));
    CHECK(starts[1] == 1 && letters[0] == -1);
    const int32_t end[2] = {-1, 2};
    CHECK(equal(basis, letters + starts[n], starts[n + 1] - starts[n], end, 2));
    OK(ricci_homotopy_path_word(basis, path, n, NULL, 0, &n_word));
    CHECK(n_word == 1);
    OK(ricci_homotopy_path_word(basis, path, n, &word, 1, &n_word));
    CHECK(word == 2);
    FAILS(ricci_homotopy_path_word(basis, path, n, &word, 0, &n_word), RICCI_BUFFER_TOO_SMALL, "letters");
    if (quotient) {
        /* In coordinates too: it ends where the generator carries the base lift. */
        ricci_uniform_summary q;
        double *points = (double *)room(3 * (n + 1), sizeof *points), there[3];
        ricci_deck *generators = NULL;
        OK(ricci_uniform_summarise(quotient, &q, sizeof q));
        OK(ricci_uniform_lift(quotient, path, n, points, 3 * (n + 1)));
        OK(deck_of(quotient, RICCI_DECK_GENERATORS, NULL, &generators));
        elements e = elements_of(generators);
        OK(ricci_deck_apply(generators, 1, q.base_lift, 1, there, 3));
        CHECK(distance(points, q.base_lift, q.space) < 1e-12 &&
              distance(points + 3 * n, there, q.space) < 1e-8);
        double *first = (double *)room(3 * (n + 1), sizeof *first);
        for (size_t k = 0; k < s.n_generators; k++) {
            const size_t m = row_length(loops, k);
            OK(ricci_uniform_lift(quotient, row(loops, k), m, first, 3 * (m + 1)));
            image(e.matrices + 9 * k, q.base_lift, there);
            CHECK(distance(first + 3 * m, there, q.space) < 1e-8);
        }
        FAILS(ricci_uniform_lift(quotient, path, n, points, 3 * n), RICCI_BUFFER_TOO_SMALL, "points");
        free(points), free(first), elements_free(&e), ricci_deck_free(generators);
    }
    const int32_t jump[2] = {path[0], path[0]}, missing[1] = {1000000};
    if (row_length(loops, 1) > 1)
        FAILS(ricci_homotopy_path_word(basis, jump, 2, &word, 1, &n_word), RICCI_ARGUMENT, "half-edge");
    FAILS(ricci_homotopy_path_word(basis, missing, 1, &word, 1, &n_word), RICCI_ARGUMENT,
          "path[0] is 1000000");
    lift.vertex = 1000000, lift.n_element = 0;
    FAILS(ricci_homotopy_lift(basis, &lift, NULL, 0, starts, n + 2), RICCI_ARGUMENT, "1000000");
    free(relator), free(path), free(starts), free(letters);
}

/* Sides are paired with inverse elements, and an element carries the corners of the partner to those of its
 * side. */
static void check_domain(const ricci_homotopy *basis, const ricci_domain *domain, size_t n_boundary_edges) {
    ricci_domain_summary d;
    OK(ricci_domain_summarise(domain, &d, sizeof d));
    rows sides = rows_new(d.n_sides, d.n_side_edges), words = rows_new(d.n_sides, d.n_side_letters);
    rows corners = rows_new(d.n_sides, d.n_corner_letters);
    int32_t *partners = (int32_t *)room(d.n_sides, sizeof *partners);
    uint32_t *vertices = (uint32_t *)room(d.n_sides, sizeof *vertices);
    OK(ricci_domain_sides(domain, sides.entries, d.n_side_edges, sides.starts, d.n_sides + 1));
    OK(ricci_domain_elements(domain, words.entries, d.n_side_letters, words.starts, d.n_sides + 1));
    OK(ricci_domain_partners(domain, partners, d.n_sides));
    OK(ricci_domain_corners(domain, vertices, d.n_sides, corners.entries, d.n_corner_letters, corners.starts,
                            d.n_sides + 1));
    int32_t *product = (int32_t *)room(d.n_side_letters + d.n_corner_letters, sizeof *product);
    size_t open = 0;
    for (size_t i = 0; i < d.n_sides; i++) {
        const size_t n = row_length(&sides, i);
        if (partners[i] < 0) {
            open += n;
            CHECK(row_length(&words, i) == 0);
            continue;
        }
        const size_t j = (size_t)partners[i], end = (j + 1) % d.n_sides, letters = row_length(&words, i);
        CHECK(partners[j] == (int32_t)i && row_length(&sides, j) == n);
        for (size_t k = 0; k < n; k++) CHECK(row(&sides, i)[k] == -row(&sides, j)[n - 1 - k]);
        for (size_t k = 0; k < letters; k++) product[k] = -row(&words, i)[letters - 1 - k];
        CHECK(equal(basis, product, letters, row(&words, j), row_length(&words, j)));
        memcpy(product, row(&words, i), letters * sizeof *product);
        memcpy(product + letters, row(&corners, end), row_length(&corners, end) * sizeof *product);
        CHECK(vertices[i] == vertices[end]);
        CHECK(equal(basis, product, letters + row_length(&corners, end), row(&corners, i),
                    row_length(&corners, i)));
    }
    CHECK(open == n_boundary_edges && d.base_edge != 0);
    FAILS(ricci_domain_partners(domain, partners, d.n_sides - 1), RICCI_BUFFER_TOO_SMALL, "partners");
    FAILS(ricci_domain_sides(NULL, sides.entries, 0, sides.starts, 0), RICCI_NULL_POINTER, "domain");
    rows_free(&sides), rows_free(&words), rows_free(&corners);
    free(partners), free(vertices), free(product);
}

/* In C, with the matrices: the relation's product is the identity, as far as its partial products allow in
 * doubles: an error of theirs is carried on by what leads back from there. */
static void the_relation_holds_for_the_matrices(const ricci_uniform *quotient) {
    ricci_uniform_summary q;
    ricci_deck *generators = NULL;
    OK(ricci_uniform_summarise(quotient, &q, sizeof q));
    OK(deck_of(quotient, RICCI_DECK_GENERATORS, NULL, &generators));
    elements e = elements_of(generators);
    double *corners = (double *)room(3 * q.n_polygon, sizeof *corners);
    double *angles = (double *)room(q.n_polygon, sizeof *angles), sum = 0, largest = 1;
    double product[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, back[9], there[3];
    OK(ricci_uniform_polygon(quotient, corners, angles, q.n_polygon));
    for (size_t i = 0; i < q.n_polygon; i++) {
        const size_t handle = i / 4, k = 2 * handle + i % 2;
        image(product, q.base_lift, there);
        for (int j = 0; j < 3; j++)
            CHECK(fabs(there[j] - corners[3 * i + (size_t)j]) < 1e-13 * largest * largest);
        inverse(e.matrices + 9 * k, q.space, back);
        times(product, i % 4 < 2 ? e.matrices + 9 * k : back, product);
        for (int j = 0; j < 9; j++) largest = fmax(largest, fabs(product[j]));
        sum += angles[i];
    }
    for (int j = 0; j < 9; j++) CHECK(fabs(product[j] - (j % 4 == 0)) < 1e-13 * largest * largest);
    CHECK(fabs(sum - 2 * pi) < 1e-8);
    if (q.space == RICCI_SPACE_H2) /* all hyperbolic */
        for (size_t k = 0; k < q.n_generators; k++)
            CHECK(e.traces[k] > 2 && fabs(e.lengths[k] - 2 * acosh(e.traces[k] / 2)) < 1e-9 * e.lengths[k]);
    free(corners), free(angles), elements_free(&e), ricci_deck_free(generators);
}

/* A loop of vertices of the given mesh: the edges of a face are contracted. */
static void check_loop_of_vertices(const ricci_uniform *quotient, const ricci_mesh *given) {
    arrays a = arrays_of(given, 0);
    ricci_layout *layout = NULL;
    ricci_uniform_summary q;
    size_t n = 0, n_letters = 9;
    const uint32_t *around = a.faces;
    OK(ricci_uniform_summarise(quotient, &q, sizeof q));
    OK(ricci_uniform_layout(quotient, RICCI_ON_REFINEMENT, RICCI_MODEL_POINCARE, NULL, &layout));
    OK(ricci_uniform_lift_loop(quotient, layout, around, 3, NULL, 0, &n, NULL, 0, &n_letters));
    CHECK(n >= 12 && n_letters == 0);
    double *points = (double *)room(n, sizeof *points);
    FAILS(ricci_uniform_lift_loop(quotient, layout, around, 3, points, n - 1, &n, NULL, 0, &n_letters),
          RICCI_BUFFER_TOO_SMALL, "points");
    OK(ricci_uniform_lift_loop(quotient, layout, around, 3, points, n, &n, NULL, 0, &n_letters));
    CHECK(distance(points, points + n - 3, q.space) < 1e-8);
    FAILS(ricci_uniform_lift_loop(quotient, layout, around, 1, NULL, 0, &n, NULL, 0, &n_letters),
          RICCI_ARGUMENT, "two or more");
    free(points), ricci_layout_free(layout), arrays_free(&a);
}

static void closed_surfaces(void) {
    ricci_mesh *meshes[4] = {NULL, NULL, NULL, NULL};
    torus t = torus_new(12, 8);
    meshes[0] = torus_mesh(&t);
    OK(make_genus(2, 2, 1, &meshes[1]));
    OK(make_genus(3, 1, 1, &meshes[2]));
    OK(make_glued(RICCI_SHAPE_ONE_VERTEX, 2, &meshes[3])); /* loops on every edge */
    for (int i = 0; i < 4; i++) {
        ricci_uniform *quotient = NULL;
        ricci_homotopy *basis = NULL, *own = NULL;
        ricci_domain *domain = NULL, *layout = NULL;
        ricci_mesh *mesh = NULL;
        ricci_metric *metric = NULL;
        OK(ricci_homotopy_new(meshes[i], NULL, NULL, &own));
        rows loops = check_loops(own, meshes[i]);
        check_words(own), check_lifts(own, &loops, NULL);
        rows_free(&loops);
        OK(ricci_uniformize(meshes[i], NULL, NULL, &quotient));
        OK(ricci_uniform_homotopy(quotient, &basis));
        OK(ricci_uniform_metric(quotient, &metric));
        OK(ricci_metric_mesh(metric, &mesh));
        ricci_metric_free(metric);
        OK(ricci_uniform_domain(quotient, &layout));
        OK(ricci_domain_new(basis, NULL, 0, &domain));
        loops = check_loops(basis, mesh);
        check_words(basis), check_lifts(basis, &loops, quotient);
        check_domain(basis, domain, 0), check_domain(basis, layout, 0);
        the_relation_holds_for_the_matrices(quotient);
        if (i < 3) check_loop_of_vertices(quotient, meshes[i]);
        ricci_uniform_free(quotient);
        CHECK(summary_of(basis).base < 1000000); /* lives on */
        rows_free(&loops);
        ricci_domain_free(domain), ricci_domain_free(layout);
        ricci_homotopy_free(basis), ricci_homotopy_free(own);
        ricci_mesh_free(mesh), ricci_mesh_free(meshes[i]);
    }
    torus_free(&t);
}

static void surfaces_with_boundary(void) {
    torus t = torus_new(12, 8);
    ricci_mesh *whole = torus_mesh(&t), *mesh = NULL;
    ricci_homotopy *basis = NULL, *none = NULL;
    ricci_domain *domain = NULL;
    ricci_mesh_summary m;
    uint32_t cut[1] = {1000000};
    OK(change(whole, RICCI_CHANGE_PUNCH, 2, 0, 0, &mesh));
    OK(ricci_mesh_summarise(mesh, &m, sizeof m));
    const uint32_t five = 5, beyond = 1000000;
    OK(ricci_homotopy_new(mesh, &five, NULL, &basis));
    const ricci_homotopy_summary s = summary_of(basis);
    CHECK(s.base == 5 && s.genus == 1 && s.n_boundary_loops == 2 && s.n_generators == 4);
    rows loops = check_loops(basis, mesh);
    check_words(basis), check_lifts(basis, &loops, NULL);
    OK(ricci_domain_new(basis, NULL, 0, &domain));
    check_domain(basis, domain, m.n_boundary_vertices);
    rows_free(&loops);
    /* The tree path to a vertex has no element. */
    size_t n = 0, n_word = 1;
    OK(ricci_homotopy_tree_path(basis, 40, NULL, 0, &n));
    int32_t *path = (int32_t *)room(n, sizeof *path);
    OK(ricci_homotopy_tree_path(basis, 40, path, n, &n));
    OK(ricci_homotopy_path_word(basis, path, n, NULL, 0, &n_word));
    CHECK(n > 0 && n_word == 0);
    ricci_domain_free(domain), domain = NULL;
    FAILS(ricci_domain_new(basis, cut, 1, &domain), RICCI_ARGUMENT, "1000000");
    cut[0] = 0;
    FAILS(ricci_domain_new(basis, cut, 1, &domain), RICCI_LAYOUT, "disk");
    FAILS(ricci_homotopy_new(mesh, &beyond, NULL, &none), RICCI_ARGUMENT, "1000000");
    FAILS(ricci_homotopy_new(NULL, NULL, NULL, &none), RICCI_NULL_POINTER, "mesh");
    FAILS(ricci_homotopy_loops(basis, path, 1, NULL, 0), RICCI_BUFFER_TOO_SMALL, "entries");
    CHECK(domain == NULL && none == NULL);
    ricci_homotopy_free(NULL), ricci_domain_free(NULL);
    free(path), ricci_homotopy_free(basis), ricci_mesh_free(mesh), ricci_mesh_free(whole);
    torus_free(&t);
}

int main(void) {
    closed_surfaces();
    surfaces_with_boundary();
    return 0;
}
