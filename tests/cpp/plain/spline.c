/* Triangular B-splines through the C face: polynomials, fits, creases, files, refusals. */
#include "check.h"
#include <math.h>
#include <ricci/spline.h>

/* A square of side 2 with a fine enough triangulation. */
static ricci_mesh *square(void) {
    const double corners[8] = {0, 0, 2, 0, 2, 2, 0, 2};
    const size_t starts[2] = {0, 4};
    ricci_mesh *domain = NULL;
    OK(ricci_spline_domain(corners, starts, 1, 0.5, &domain));
    return domain;
}

static ricci_spline *over(const ricci_mesh *domain, uint32_t degree) {
    ricci_spline_spec spec;
    ricci_spline *spline = NULL;
    INIT(spec);
    spec.degree = degree;
    OK(ricci_spline_new(domain, &spec, &spline));
    return spline;
}

static ricci_spline_summary summary_of(const ricci_spline *spline) {
    ricci_spline_summary s;
    OK(ricci_spline_summarise(spline, &s, sizeof s));
    return s;
}

/* Places with these coordinates, in whatever patch they lie. */
static ricci_spline_places at(const double *parameters, size_t n) {
    ricci_spline_places places;
    INIT(places);
    places.parameters = parameters, places.n = n;
    return places;
}

enum { GRID = 9, PLACES = GRID * GRID };

/* A grid of places inside the square. */
static void grid(double *parameters) {
    for (int i = 0; i < PLACES; i++) {
        parameters[2 * i] = 0.05 + 1.9 * (i % GRID) / (GRID - 1);
        parameters[2 * i + 1] = 0.07 + 1.86 * (i / GRID) / (GRID - 1); /* NOLINT: rows */
    }
}

/* Places on sides of patches are moved inside by 1e-13 of the patch, so points are right to 1e-12.
 * z = x^2 / 2 - y^2 + x y, which the spline is, with its derivatives and curvatures. */
static void polynomials_are_reproduced(const ricci_mesh *domain) {
    double parameters[2 * PLACES], values[18 * PLACES], again[18 * PLACES], shape[5];
    grid(parameters);
    for (uint32_t degree = 2; degree <= 5; degree++) {
        ricci_spline *flat = over(domain, degree), *saddle = NULL;
        const ricci_spline_summary s = summary_of(flat);
        CHECK(s.degree == degree && s.n_basis == (degree + 1) * (degree + 2) / 2 && s.fit_rms != s.fit_rms);
        double *coefficients = (double *)room(3 * s.n_basis, sizeof *coefficients);
        const double terms[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0, 0, 1, 0, 0, -1};
        memcpy(coefficients, terms, sizeof terms);
        OK(ricci_spline_with_polynomial(flat, coefficients, s.n_basis, &saddle));
        ricci_spline_places places = at(parameters, PLACES);
        OK(ricci_spline_evaluate(flat, &places, RICCI_SPLINE_POINT, NULL, values, 3 * PLACES));
        for (int i = 0; i < PLACES; i++)
            CHECK(hypot(values[3 * i] - parameters[2 * i], values[3 * i + 1] - parameters[2 * i + 1]) <
                      1e-12 &&
                  values[3 * i + 2] == 0);
        OK(ricci_spline_evaluate(saddle, &places, RICCI_SPLINE_SECOND, NULL, values, 18 * PLACES));
        places.threads = 3;
        OK(ricci_spline_evaluate(saddle, &places, RICCI_SPLINE_SECOND, NULL, again, 18 * PLACES));
        CHECK(memcmp(values, again, sizeof values) == 0);
        for (int i = 0; i < PLACES; i++) {
            const double x = parameters[2 * i], y = parameters[2 * i + 1], *v = values + 18 * i;
            const double exact[18] = {
                x, y, 0.5 * x * x - y * y + x * y, 1, 0, x + y, 0, 1, x - 2 * y, 0, 0, 1, 0, 0, 1, 0, 0, -2};
            for (int k = 0; k < 18; k++)
                CHECK(fabs(v[k] - exact[k]) < (k < 3 ? 1e-12 : k < 9 ? 1e-11 : 1e-8));
        }
        OK(ricci_spline_evaluate(saddle, &places, RICCI_SPLINE_FIRST, NULL, again, 9 * PLACES));
        CHECK(again[9] == values[18] && again[17] == values[26]);
        /* Principal curvatures of a graph: H and K by hand. */
        places.n = 1;
        OK(ricci_spline_evaluate(saddle, &places, RICCI_SPLINE_SHAPE, NULL, shape, 5));
        const double p = values[5], q = values[8], w = 1 + p * p + q * q;
        const double gauss = -3 / (w * w),
                     mean = ((1 + q * q) - 2 * p * q - 2 * (1 + p * p)) / (2 * w * sqrt(w));
        CHECK(fabs(shape[3] * shape[4] - gauss) < 1e-7 && fabs(shape[3] + shape[4] - 2 * mean) < 1e-7);
        CHECK(fabs(shape[0] + p / sqrt(w)) < 1e-11 && fabs(shape[2] - 1 / sqrt(w)) < 1e-11);
        /* The blossom is symmetric, and the polynomial on the diagonal. */
        double arguments[10], point[3], other[3];
        for (uint32_t k = 0; k < degree; k++) arguments[2 * k] = 0.4, arguments[2 * k + 1] = 1.1;
        OK(ricci_spline_blossom(saddle, 1, arguments, degree, point));
        CHECK(fabs(point[2] - (0.5 * 0.16 - 1.21 + 0.44)) < 1e-12);
        arguments[0] = -1;
        OK(ricci_spline_blossom(saddle, 1, arguments, degree, point));
        arguments[0] = 0.4, arguments[2 * degree - 2] = -1;
        OK(ricci_spline_blossom(saddle, 1, arguments, degree, other));
        CHECK(fabs(point[2] - other[2]) < 1e-12);
        FAILS(ricci_spline_blossom(saddle, s.n_patches, arguments, degree, point), RICCI_SPLINE, "exist");
        FAILS(ricci_spline_blossom(saddle, 0, arguments, degree - 1, point), RICCI_WRONG_SIZE, "arguments");
        FAILS(ricci_spline_with_polynomial(flat, coefficients, s.n_basis - 1, &saddle), RICCI_WRONG_SIZE, "");
        free(coefficients);
        ricci_spline_free(saddle), ricci_spline_free(flat);
    }
}

static double wave(double x, double y) { return sin(2 * x) * cos(1.5 * y); }

static void fits_come_near_their_points(const ricci_mesh *domain) {
    enum { N = 60 };
    ricci_spline *flat = over(domain, 3), *fitted = NULL;
    ricci_spline_fit_options options;
    INIT(options);
    static double points[3 * N * N], parameters[2 * N * N];
    for (int i = 0; i < N * N; i++) {
        const double x = 2.0 * (i % N) / (N - 1), y = 2.0 * (i / N) / (N - 1); /* NOLINT: rows */
        points[3 * i] = parameters[2 * i] = x, points[3 * i + 1] = parameters[2 * i + 1] = y;
        points[3 * i + 2] = wave(x, y);
    }
    OK(ricci_spline_fit(flat, points, N * N, NULL, NULL, &fitted));
    const ricci_spline_summary s = summary_of(fitted);
    CHECK(s.fit_max < 0.02 && s.fit_rms < s.fit_max && s.fit_rms > 0);
    ricci_spline_free(fitted);
    /* The same points at places that are said, moved up: no longer over their own x and y. */
    const ricci_spline_places places = at(parameters, N * N);
    options.places = &places, options.fairness = -1;
    for (int i = 0; i < N * N; i++) points[3 * i] += 7;
    FAILS(ricci_spline_fit(flat, points, N * N, NULL, NULL, &fitted), RICCI_SPLINE, "point 0");
    OK(ricci_spline_fit(flat, points, N * N, &options, NULL, &fitted));
    CHECK(fabs(summary_of(fitted).fit_max - s.fit_max) < 1e-2 * s.fit_max);
    ricci_spline_free(fitted);
    /* Too few points leave the spline open without a bending energy, and are enough with one. */
    enum { FEW = 20 };
    double few[3 * FEW], under[2 * FEW];
    for (int i = 0; i < FEW; i++) {
        const int from = 173 * i;
        memcpy(few + 3 * i, points + 3 * from, 3 * sizeof *few);
        memcpy(under + 2 * i, parameters + 2 * from, 2 * sizeof *under);
    }
    const ricci_spline_places scattered = at(under, FEW);
    options.places = &scattered;
    FAILS(ricci_spline_fit(flat, few, FEW, &options, NULL, &fitted), RICCI_FACTORISATION, "fairness");
    options.fairness = 1e-6;
    OK(ricci_spline_fit(flat, few, FEW, &options, NULL, &fitted));
    ricci_spline_free(fitted);
    FAILS(ricci_spline_fit(flat, points, FEW + 1, &options, NULL, &fitted), RICCI_WRONG_SIZE, "points");
    options.fairness = NAN;
    FAILS(ricci_spline_fit(flat, few, FEW, &options, NULL, &fitted), RICCI_ARGUMENT, "fairness");
    ricci_spline_free(flat);
}

/* The jump of the first derivatives across the edge between two vertices, of a surface with uneven control
 * points. */
static double kink(const ricci_mesh *domain, const ricci_spline_spec *spec, const double *a,
                   const double *b) {
    ricci_spline *flat = NULL, *rough = NULL;
    OK(ricci_spline_new(domain, spec, &flat));
    const size_t n = summary_of(flat).n_control_points;
    double *points = (double *)room(3 * n, sizeof *points), values[18];
    for (size_t i = 0; i < 3 * n; i++) points[i] = sin(7.0 * (double)i);
    OK(ricci_spline_with_points(flat, points, n, &rough));
    FAILS(ricci_spline_with_points(flat, points, n - 1, &rough), RICCI_WRONG_SIZE, "points");
    const double x = 0.5 * (a[0] + b[0]), y = 0.5 * (a[1] + b[1]);
    const double u = 1e-9 * (b[1] - a[1]), v = 1e-9 * (a[0] - b[0]);
    const double parameters[4] = {x + u, y + v, x - u, y - v};
    const ricci_spline_places places = at(parameters, 2);
    OK(ricci_spline_evaluate(rough, &places, RICCI_SPLINE_FIRST, NULL, values, 18));
    double jump = 0;
    for (int k = 3; k < 9; k++) jump = fmax(jump, fabs(values[k] - values[9 + k]));
    free(points);
    ricci_spline_free(rough), ricci_spline_free(flat);
    return jump;
}

static void knots_are_what_is_asked_for(const ricci_mesh *domain) {
    ricci_mesh_summary m;
    ricci_spline_spec spec;
    ricci_spline *spline = NULL, *again = NULL;
    OK(ricci_mesh_summarise(domain, &m, sizeof m));
    double *positions = (double *)room(3 * m.n_vertices, sizeof *positions);
    uint32_t *faces = (uint32_t *)room(3 * m.n_faces, sizeof *faces);
    OK(ricci_mesh_values(domain, RICCI_POSITIONS, positions, 3 * m.n_vertices));
    OK(ricci_mesh_faces(domain, faces, 3 * m.n_faces));
    INIT(spec);
    spec.degree = 2;
    OK(ricci_spline_new(domain, &spec, &spline));
    const ricci_spline_summary s = summary_of(spline);
    CHECK(s.n_patches == m.n_faces);
    /* A quadratic has the control points of Lagrange's nodes: vertices and edges. */
    CHECK(s.n_control_points == m.n_vertices + m.n_edges);
    double *knots = (double *)room(18 * s.n_patches, sizeof *knots);
    uint32_t *controls = (uint32_t *)room(6 * s.n_patches, sizeof *controls);
    double *where = (double *)room(2 * s.n_control_points, sizeof *where);
    double *points = (double *)room(3 * s.n_control_points, sizeof *points);
    double *own = (double *)room(6 * m.n_vertices, sizeof *own);
    OK(ricci_spline_values(spline, RICCI_SPLINE_KNOTS, knots, 18 * s.n_patches));
    OK(ricci_spline_values(spline, RICCI_SPLINE_ABSCISSAS, where, 2 * s.n_control_points));
    OK(ricci_spline_values(spline, RICCI_SPLINE_CONTROL_POINTS, points, 3 * s.n_control_points));
    OK(ricci_spline_controls(spline, controls, 6 * s.n_patches));
    CHECK(ricci_spline_controls(spline, controls, 6 * s.n_patches - 1) == RICCI_BUFFER_TOO_SMALL);
    FAILS(ricci_spline_values(spline, 9, knots, 0), RICCI_ARGUMENT, "which");
    size_t inner[2] = {0, 0};
    for (size_t t = 0; t < s.n_patches; t++)
        for (int k = 0; k < 3; k++) {
            const uint32_t v = faces[3 * t + k], w = faces[3 * t + (k + 1) % 3];
            const double *of = knots + 18 * t + 6 * k, *p = positions + 3 * v, *q = positions + 3 * w;
            CHECK(of[0] == p[0] && of[1] == p[1]);
            memcpy(own + 6 * v, of, 6 * sizeof *own);
            /* The control point of v alone lies at the mean of its first two knots. */
            const uint32_t c = controls[6 * t + (k == 0 ? 0 : k == 1 ? 3 : 5)];
            CHECK(fabs(where[2 * c] - 0.5 * (of[0] + of[2])) < 1e-15 && points[3 * c] == where[2 * c]);
            const int inside = p[0] > 0.1 && p[0] < 1.9 && p[1] > 0.1 && p[1] < 1.9 && q[0] > 0.1 &&
                               q[0] < 1.9 && q[1] > 0.1 && q[1] < 1.9;
            if (inside) inner[0] = v, inner[1] = w;
        }
    CHECK(inner[0] != inner[1]);
    /* Given back, the knots make the same spline. */
    spec.knots = own;
    OK(ricci_spline_new(domain, &spec, &again));
    const double place[2] = {0.8, 1.3};
    const ricci_spline_places places = at(place, 1);
    double here[18], there[18];
    OK(ricci_spline_evaluate(spline, &places, RICCI_SPLINE_SECOND, NULL, here, 18));
    OK(ricci_spline_evaluate(again, &places, RICCI_SPLINE_SECOND, NULL, there, 18));
    CHECK(memcmp(here, there, sizeof here) == 0);
    /* Knots on a line through three corners are refused. */
    own[6 * faces[0] + 2] = positions[3 * faces[1]], own[6 * faces[0] + 3] = positions[3 * faces[1] + 1];
    ricci_spline *none = NULL;
    FAILS(ricci_spline_new(domain, &spec, &none), RICCI_SPLINE, "knots");
    spec.knots = NULL;
    const uint32_t crease[2] = {(uint32_t)inner[0], (uint32_t)inner[1]};
    const double *a = positions + 3 * inner[0], *b = positions + 3 * inner[1];
    CHECK(kink(domain, &spec, a, b) < 1e-5);
    spec.creases = crease, spec.n_creases = 1;
    CHECK(kink(domain, &spec, a, b) > 1e-2);
    spec.creases = NULL, spec.n_creases = 0, spec.coincident = crease, spec.n_coincident = 2;
    CHECK(kink(domain, &spec, a, b) > 1e-2);
    const uint32_t beyond = (uint32_t)m.n_vertices;
    spec.coincident = &beyond, spec.n_coincident = 1;
    FAILS(ricci_spline_new(domain, &spec, &none), RICCI_SPLINE, "exist");
    free(own), free(points), free(where), free(controls), free(knots), free(faces), free(positions);
    ricci_spline_free(again), ricci_spline_free(spline);
}

static void files_and_meshes(const ricci_mesh *domain) {
    ricci_spline *spline = over(domain, 3), *read = NULL, *parsed = NULL;
    const ricci_spline_summary s = summary_of(spline);
    ricci_mesh *mesh = NULL;
    ricci_mesh_summary m;
    size_t n = 0;
    OK(ricci_spline_write(spline, "spline.json"));
    OK(ricci_spline_read("spline.json", &read));
    OK(ricci_spline_text(spline, NULL, 0, &n));
    char *text = (char *)room(n, 1), *again = (char *)room(n, 1);
    OK(ricci_spline_text(spline, text, n, &n));
    OK(ricci_spline_parse(text, &parsed));
    OK(ricci_spline_text(parsed, again, n, &n));
    CHECK(strlen(text) + 1 == n && strcmp(text, again) == 0);
    OK(ricci_spline_text(read, again, n, &n));
    CHECK(strcmp(text, again) == 0 && summary_of(read).n_control_points == s.n_control_points);
    CHECK(ricci_spline_text(spline, text, n - 1, &n) == RICCI_BUFFER_TOO_SMALL);
    ricci_spline *none = NULL;
    text[n / 2] = '\0';
    FAILS(ricci_spline_parse(text, &none), RICCI_PARSE, "text:1");
    FAILS(ricci_spline_read("no such spline.json", &none), RICCI_IO, "no such spline.json");
    CHECK(ricci_spline_parse(NULL, &none) == RICCI_NULL_POINTER);
    OK(ricci_spline_tessellate(spline, 3, NULL, &mesh));
    OK(ricci_mesh_summarise(mesh, &m, sizeof m));
    CHECK(m.n_faces == 9 * s.n_patches && m.euler == 1 && m.n_normals == m.n_vertices);
    double *normals = (double *)room(3 * m.n_vertices, sizeof *normals);
    OK(ricci_mesh_values(mesh, RICCI_NORMALS, normals, 3 * m.n_vertices));
    for (size_t v = 0; v < m.n_vertices; v++) CHECK(fabs(normals[3 * v + 2] - 1) < 1e-12);
    ricci_mesh *nothing = NULL;
    FAILS(ricci_spline_tessellate(spline, 0, NULL, &nothing), RICCI_ARGUMENT, "side");
    free(normals), free(again), free(text);
    ricci_mesh_free(mesh);
    ricci_spline_free(parsed), ricci_spline_free(read), ricci_spline_free(spline);
}

static void bad_input_has_names(const ricci_mesh *domain) {
    ricci_spline *spline = over(domain, 3), *none = NULL;
    ricci_spline_spec spec;
    ricci_failure failure;
    double values[9];
    INIT(spec);
    spec.degree = 6;
    FAILS(ricci_spline_new(domain, &spec, &none), RICCI_ARGUMENT, "degree is 6");
    spec.degree = 3, spec.spread = 1;
    FAILS(ricci_spline_new(domain, &spec, &none), RICCI_ARGUMENT, "spread");
    CHECK(ricci_spline_new(NULL, NULL, &none) == RICCI_NULL_POINTER);
    const double parameters[6] = {1, 1, 0.5, 0.3, 3, 1};
    ricci_spline_places places = at(parameters, 3);
    FAILS(ricci_spline_evaluate(spline, &places, RICCI_SPLINE_POINT, NULL, values, 9), RICCI_SPLINE,
          "outside");
    OK(ricci_last_failure(&failure, sizeof failure));
    CHECK(failure.element == RICCI_ELEMENT_ENTRY && failure.index == 2);
    int32_t patches[3];
    OK(ricci_spline_locate(spline, parameters, 3, patches, 3));
    CHECK(patches[0] >= 0 && patches[1] >= 0 && patches[2] == -1);
    const uint32_t in[3] = {(uint32_t)patches[0], (uint32_t)patches[1], (uint32_t)patches[0]};
    places.patches = in, places.n = 2;
    OK(ricci_spline_evaluate(spline, &places, RICCI_SPLINE_POINT, NULL, values, 6));
    CHECK(fabs(values[0] - 1) < 1e-12 && fabs(values[4] - 0.3) < 1e-12);
    places.n = 3;
    FAILS(ricci_spline_evaluate(spline, &places, RICCI_SPLINE_POINT, NULL, values, 9), RICCI_SPLINE,
          "outside");
    OK(ricci_last_failure(&failure, sizeof failure));
    CHECK(failure.element == RICCI_ELEMENT_FACE && failure.index == patches[0]);
    CHECK(ricci_spline_evaluate(spline, &places, RICCI_SPLINE_POINT, NULL, values, 8) ==
          RICCI_BUFFER_TOO_SMALL);
    FAILS(ricci_spline_evaluate(spline, &places, 4, NULL, values, 9), RICCI_ARGUMENT, "which");
    /* Polygons that are none, and a domain that is upside down. */
    const double bow[8] = {0, 0, 1, 1, 1, 0, 0, 1};
    const size_t starts[2] = {0, 4}, backwards[3] = {0, 4, 2};
    ricci_mesh *mesh = NULL;
    FAILS(ricci_spline_domain(bow, starts, 1, 0.1, &mesh), RICCI_SPLINE, "polygon 0");
    FAILS(ricci_spline_domain(bow, starts, 1, 0, &mesh), RICCI_ARGUMENT, "edge");
    FAILS(ricci_spline_domain(bow, backwards, 2, 0.1, &mesh), RICCI_ARGUMENT, "starts");
    const double positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t turned[3] = {0, 2, 1};
    OK(ricci_mesh_from_arrays(positions, 0, 3, turned, 1, &mesh));
    FAILS(ricci_spline_new(mesh, NULL, &none), RICCI_SPLINE, "triangle 0");
    ricci_control *control = NULL;
    OK(ricci_control_new(&control));
    OK(ricci_control_cancel(control));
    places.n = 2;
    CHECK(ricci_spline_evaluate(spline, &places, RICCI_SPLINE_POINT, control, values, 6) == RICCI_CANCELLED);
    ricci_control_free(control);
    ricci_mesh_free(mesh);
    ricci_spline_free(spline), ricci_spline_free(NULL);
}

int main(void) {
    ricci_mesh *domain = square();
    polynomials_are_reproduced(domain);
    fits_come_near_their_points(domain);
    knots_are_what_is_asked_for(domain);
    files_and_meshes(domain);
    bad_input_has_names(domain);
    ricci_mesh_free(domain);
    return 0;
}
