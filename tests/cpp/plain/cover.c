/* Finite pieces of the universal cover: how many copies there are, and that they meet along their sides. */
#include "quotient.h"

/* The elements of words of at most this length. */
static size_t count(const ricci_uniform *quotient, size_t depth) {
    ricci_deck *deck = NULL;
    ricci_deck_summary n;
    OK(to_depth(quotient, depth, 100000, NULL, &deck));
    OK(ricci_deck_summarise(deck, &n, sizeof n));
    CHECK(n.longest <= depth);
    ricci_deck_free(deck);
    return n.n_elements;
}

/* Copies of the layout across a side have that side's points in common, wherever the copy lies. */
static void copies_meet_along_their_sides(const ricci_uniform *quotient, size_t depth, double tolerance) {
    laid l = laid_of(quotient);
    ricci_domain *domain = NULL;
    ricci_domain_summary d;
    ricci_deck *sides = NULL, *cover = NULL;
    OK(ricci_uniform_domain(quotient, &domain));
    OK(ricci_domain_summarise(domain, &d, sizeof d));
    int32_t *edges = (int32_t *)room(d.n_side_edges, sizeof *edges);
    size_t *starts = (size_t *)room(d.n_sides + 1, sizeof *starts), n = 0;
    OK(ricci_domain_sides(domain, edges, d.n_side_edges, starts, d.n_sides + 1));
    OK(deck_of(quotient, RICCI_DECK_SIDES, NULL, &sides));
    OK(to_depth(quotient, depth, 100000, NULL, &cover));
    elements s = elements_of(sides), c = elements_of(cover);
    CHECK(s.n.n_elements == d.n_sides && d.n_sides == l.s.n_sides);
    double *own = (double *)room(3 * l.l.n_points, sizeof *own);
    double *next = (double *)room(3 * l.l.n_points, sizeof *next), worst = 0;
    int32_t *word = (int32_t *)room(c.n.longest + s.n.longest, sizeof *word);
    for (size_t g = 0; g < c.n.n_elements; g++) {
        const size_t n_own = c.starts[g + 1] - c.starts[g];
        OK(ricci_deck_apply(cover, g, l.points, l.l.n_points, own, 3 * l.l.n_points));
        memcpy(word, c.letters + c.starts[g], n_own * sizeof *word);
        for (size_t k = 0; k < d.n_sides; k++) {
            /* The copy across side k: the element, then that of the side. */
            const size_t n_side = s.starts[k + 1] - s.starts[k], both[2] = {0, n_own + n_side};
            ricci_deck *across = NULL;
            memcpy(word + n_own, s.letters + s.starts[k], n_side * sizeof *word);
            OK(words_of(quotient, word, both[1], both, 1, &across));
            OK(ricci_deck_apply(across, 0, l.points, l.l.n_points, next, 3 * l.l.n_points));
            for (size_t i = starts[k]; i < starts[k + 1]; i++) {
                /* Half-edge e starts where its twin ends: at the start of the twin's successor, a corner
                 * beside. */
                const double *p = own + 3 * l.origin[halfedge(edges[i])];
                double nearest = HUGE_VAL;
                for (size_t f = 0; f < l.l.n_faces; f++)
                    for (size_t j = 0; j < 3; j++)
                        if (l.a.face_edges[3 * f + j] == -edges[i])
                            nearest = distance(p, next + 3 * l.corners[3 * f + (j + 2) % 3], l.s.space);
                worst = fmax(worst, nearest), n++;
            }
            ricci_deck_free(across);
        }
    }
    CHECK(n > 0 && worst < tolerance);
    printf("genus %zu, depth %zu: %zu copies meet at %zu points to %.1e\n", l.s.genus, depth, c.n.n_elements,
           n, worst);
    free(edges), free(starts), free(own), free(next), free(word);
    elements_free(&s), elements_free(&c), laid_free(&l);
    ricci_deck_free(sides), ricci_deck_free(cover), ricci_domain_free(domain);
}

/* Every corner of a Dirichlet domain is as near to its centre as to any other image of it, and its sides lie
 * on bisectors. */
static void check_dirichlet(const ricci_uniform *quotient, const double *centre) {
    ricci_dirichlet *dirichlet = NULL;
    ricci_dirichlet_summary d;
    ricci_deck *around = NULL, *sides = NULL;
    ricci_uniform_summary q;
    OK(ricci_uniform_summarise(quotient, &q, sizeof q));
    OK(ricci_dirichlet_new(quotient, centre, NULL, &dirichlet));
    OK(ricci_dirichlet_summarise(dirichlet, &d, sizeof d));
    CHECK(d.space == q.space && fabs(d.area - q.area) < 1e-7 * q.area && d.n_sides >= 4);
    double *corners = (double *)room(3 * d.n_sides, sizeof *corners), there[3], last = 0;
    OK(ricci_dirichlet_corners(dirichlet, corners, 3 * d.n_sides));
    OK(deck_of(quotient, RICCI_DECK_DIRICHLET_SIDES, dirichlet, &sides));
    OK(within(quotient, dirichlet, 2 * d.radius + 1e-6, 100000, &around));
    elements e = elements_of(around), s = elements_of(sides);
    CHECK(e.n.n_elements > d.n_sides);
    for (size_t g = 0; g < e.n.n_elements; g++) {
        image(e.matrices + 9 * g, d.centre, there);
        const double moved = distance(there, d.centre, d.space);
        CHECK(moved > last - 1e-6 && moved < 2 * d.radius + 1e-5 && (g == 0) == (moved < 1e-6));
        last = moved;
        for (size_t k = 0; k < d.n_sides; k++)
            CHECK(distance(corners + 3 * k, there, d.space) >
                  distance(corners + 3 * k, d.centre, d.space) - 1e-6);
    }
    for (size_t k = 0; k < d.n_sides; k++) {
        const double *p = corners + 3 * k, *r = corners + 3 * ((k + 1) % d.n_sides);
        image(s.matrices + 9 * k, d.centre, there);
        CHECK(fabs(distance(p, there, d.space) - distance(p, d.centre, d.space)) < 1e-6);
        CHECK(fabs(distance(r, there, d.space) - distance(r, d.centre, d.space)) < 1e-6);
    }
    free(corners), elements_free(&e), elements_free(&s);
    ricci_deck_free(around), ricci_deck_free(sides), ricci_dirichlet_free(dirichlet);
}

/* Words of the plane's lattice are points; a disk has as many as can be counted one by one. */
static void a_torus_is_covered_by_its_lattice(void) {
    ricci_mesh *mesh = NULL;
    ricci_uniform *quotient = NULL;
    ricci_dirichlet *dirichlet = NULL;
    ricci_deck *round = NULL;
    ricci_deck_summary n;
    const double re = 0.3, im = 1.2, radius = 7.013, centre[3] = {0.4, -3, 1};
    size_t lattice = 0;
    OK(make_sized(RICCI_SHAPE_FLAT_TORUS, 3, 4, re, im, 0, &mesh));
    OK(ricci_uniformize(mesh, NULL, NULL, &quotient));
    for (size_t depth = 0; depth < 6; depth++) CHECK(count(quotient, depth) == 2 * depth * (depth + 1) + 1);
    OK(ricci_dirichlet_new(quotient, centre, NULL, &dirichlet));
    OK(within(quotient, dirichlet, radius, 1000, &round));
    OK(ricci_deck_summarise(round, &n, sizeof n));
    for (int i = -20; i <= 20; i++)
        for (int j = -20; j <= 20; j++) lattice += hypot(i + j * re, j * im) <= radius;
    CHECK(n.n_elements == lattice);
    copies_meet_along_their_sides(quotient, 3, 1e-10);
    check_dirichlet(quotient, NULL), check_dirichlet(quotient, centre);
    ricci_deck_free(round), ricci_dirichlet_free(dirichlet);
    ricci_uniform_free(quotient), ricci_mesh_free(mesh);
}

/* Below half the relation's length all reduced words are different: 8 letters, then 7 more each. At half,
 * each of the 8 cyclic shifts of the relation and of its inverse makes two words one. */
static void a_surface_of_genus_2_is_covered_by_its_words(void) {
    ricci_mesh *mesh = NULL;
    ricci_uniform *quotient = NULL;
    const double centre[3] = {0.2, -0.1, 0};
    OK(make_genus(2, 1, 1, &mesh));
    OK(ricci_uniformize(mesh, NULL, NULL, &quotient));
    CHECK(count(quotient, 0) == 1 && count(quotient, 1) == 9 && count(quotient, 2) == 65);
    CHECK(count(quotient, 3) == 457 && count(quotient, 4) == 457 + 8 * 343 - 8);
    copies_meet_along_their_sides(quotient, 0, 1e-10);
    copies_meet_along_their_sides(quotient, 2, 1e-8);
    check_dirichlet(quotient, NULL), check_dirichlet(quotient, centre);
    ricci_uniform_free(quotient), ricci_mesh_free(mesh);
}

/* The eight nearest copies about the centre of the Bolza surface lie at 2 arcosh(1 + sqrt 2), and every trace
 * is 2 (m + n sqrt 2). */
static void the_bolza_surface_has_its_traces(void) {
    ricci_mesh *mesh = NULL;
    ricci_uniform *quotient = NULL;
    ricci_dirichlet *octagon = NULL;
    ricci_deck *near = NULL, *far = NULL;
    const double sqrt2 = sqrt(2.0), shortest = 2 * acosh(1 + sqrt2);
    OK(make_bolza(1, &mesh));
    OK(uniformize_at(mesh, 0, &quotient));
    OK(ricci_dirichlet_new(quotient, NULL, NULL, &octagon));
    OK(within(quotient, octagon, shortest - 1e-8, 1000, &near));
    elements e = elements_of(near);
    CHECK(e.n.n_elements == 1 && e.n.n_letters == 0);
    elements_free(&e), ricci_deck_free(near), near = NULL;
    OK(within(quotient, octagon, shortest + 1e-8, 1000, &near));
    e = elements_of(near);
    CHECK(e.n.n_elements == 9);
    elements_free(&e);
    OK(to_depth(quotient, 3, 1000, NULL, &far));
    e = elements_of(far);
    for (size_t g = 1; g < e.n.n_elements; g++) {
        /* m + n sqrt 2 with its conjugate m - n sqrt 2 in [-1, 1], as in every arithmetic group of this kind.
         */
        const double half = e.traces[g] / 2, n = floor(half / sqrt2);
        double off = HUGE_VAL;
        for (double k = floor(n / 2) - 2; k <= floor(n / 2) + 3; k++)
            off = fmin(off, fabs(half - k * sqrt2 - floor(half - k * sqrt2 + 0.5)));
        CHECK(off < 1e-8 * half && e.traces[g] > 2 * (1 + sqrt2) - 1e-9);
    }
    elements_free(&e);
    ricci_deck_free(near), ricci_deck_free(far), ricci_dirichlet_free(octagon);
    ricci_uniform_free(quotient), ricci_mesh_free(mesh);
}

static void what_does_not_exist_is_refused(void) {
    ricci_mesh *mesh = NULL;
    ricci_uniform *quotient = NULL;
    ricci_dirichlet *dirichlet = NULL;
    ricci_control *control = NULL;
    ricci_deck *deck = NULL, *words = NULL;
    const int32_t letters[3] = {1, -2, 9}, good[3] = {1, 2, -1};
    const size_t starts[3] = {0, 2, 3}, wrong[3] = {0, 3, 2};
    double x[9] = {0, 0, 1};
    OK(make_bolza(0, &mesh));
    OK(ricci_uniformize(mesh, NULL, NULL, &quotient));
    OK(ricci_dirichlet_new(quotient, NULL, NULL, &dirichlet));
    OK(ricci_control_new(&control));
    OK(ricci_control_cancel(control));
    FAILS(to_depth(quotient, 3, 100, NULL, &deck), RICCI_TOO_LARGE, "101");
    FAILS(to_depth(quotient, 3, 1000, control, &deck), RICCI_CANCELLED, "");
    FAILS(to_depth(NULL, 3, 1000, NULL, &deck), RICCI_NULL_POINTER, "uniform");
    FAILS(to_depth(quotient, 3, 1000, NULL, NULL), RICCI_NULL_POINTER, "deck");
    FAILS(within(quotient, dirichlet, HUGE_VAL - HUGE_VAL, 10, &deck), RICCI_ARGUMENT, "not a number");
    FAILS(within(quotient, dirichlet, HUGE_VAL, 10, &deck), RICCI_TOO_LARGE, "11");
    FAILS(words_of(quotient, letters, 3, starts, 2, &deck), RICCI_ARGUMENT, "letters[2] is 9");
    FAILS(words_of(quotient, good, 3, wrong, 2, &deck), RICCI_ARGUMENT, "starts");
    FAILS(words_of(quotient, good, 3, starts, (size_t)-1, &deck), RICCI_TOO_LARGE, "starts");
    CHECK(deck == NULL);
    OK(words_of(quotient, good, 3, starts, 2, &words));
    elements e = elements_of(words);
    CHECK(e.n.n_elements == 2 && e.n.n_letters == 3 && e.n.longest == 2 &&
          memcmp(e.letters, good, sizeof good) == 0);
    FAILS(ricci_deck_apply(words, 2, x, 1, x, 3), RICCI_ARGUMENT, "element 2");
    FAILS(ricci_deck_apply(words, 0, x, 1, x, 2), RICCI_BUFFER_TOO_SMALL, "moved");
    FAILS(ricci_deck_apply(words, 0, NULL, 1, x, 3), RICCI_NULL_POINTER, "points");
    FAILS(ricci_deck_values(words, RICCI_DECK_MOBIUS, x, 9), RICCI_BUFFER_TOO_SMALL, "16 entries");
    FAILS(ricci_deck_words(words, e.letters, 3, NULL, 0), RICCI_BUFFER_TOO_SMALL, "starts");
    elements_free(&e);
    ricci_deck_free(words), ricci_dirichlet_free(dirichlet), ricci_control_free(control);
    ricci_uniform_free(quotient), ricci_mesh_free(mesh);
}

int main(void) {
    a_torus_is_covered_by_its_lattice();
    a_surface_of_genus_2_is_covered_by_its_words();
    the_bolza_surface_has_its_traces();
    what_does_not_exist_is_refused();
    return 0;
}
