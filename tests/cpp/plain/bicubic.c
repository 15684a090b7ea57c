/* Bicubic patches near splines through the C face: of a torus, closed, and of a square, open; their figures,
 * their files as STEP and JSON, refusals. */
#include "samples.h"
#include <math.h>
#include <ricci/bicubic.h>

static ricci_bicubic_summary figures_of(const ricci_bicubic *bicubic) {
    ricci_bicubic_summary s;
    OK(ricci_bicubic_summarise(bicubic, &s, sizeof s));
    CHECK(s.size == sizeof s);
    return s;
}

static ricci_bicubic *patches_near(const ricci_spline *spline, double tolerance, double angle,
                                   size_t threads) {
    ricci_bicubic *bicubic = NULL;
    ricci_bicubic_options options;
    INIT(options);
    options.tolerance = tolerance, options.angle = angle, options.threads = threads;
    OK(ricci_bicubic_new(spline, &options, NULL, &bicubic));
    return bicubic;
}

static char *text_of(const ricci_bicubic *bicubic, uint32_t format, const ricci_step_options *options) {
    size_t n = 0, again = 0;
    OK(ricci_bicubic_text(bicubic, format, options, NULL, 0, &n));
    char *text = (char *)room(n, 1);
    OK(ricci_bicubic_text(bicubic, format, options, text, n, &again));
    CHECK(again == n && strlen(text) == n - 1);
    return text;
}

static size_t count(const char *text, const char *word) {
    size_t n = 0;
    for (const char *at = text; (at = strstr(at, word)) != NULL; at += strlen(word)) n++;
    return n;
}

static int ends_with(const char *text, const char *end) {
    return strlen(text) >= strlen(end) && strcmp(text + strlen(text) - strlen(end), end) == 0;
}

/* A file has this text. */
static void file_is(const char *path, const char *text) {
    const size_t n = strlen(text);
    char *bytes = (char *)room(n + 1, 1);
    FILE *file = fopen(path, "rb");
    CHECK(file && fread(bytes, 1, n + 1, file) == n && memcmp(bytes, text, n) == 0);
    fclose(file);
    free(bytes);
}

/* A spline over the unit square, or half of it, with control points that go up and down by `height`. */
static ricci_spline *waves(size_t n_corners, uint32_t degree, double height) {
    const double corners[8] = {0, 0, 1, 0, 1, 1, 0, 1};
    const size_t starts[2] = {0, n_corners};
    ricci_mesh *domain = NULL;
    ricci_spline *flat = NULL, *spline = NULL;
    OK(ricci_spline_domain(corners, starts, 1, 2, &domain));
    ricci_spline_spec spec;
    INIT(spec);
    spec.degree = degree;
    OK(ricci_spline_new(domain, &spec, &flat));
    ricci_spline_summary s;
    OK(ricci_spline_summarise(flat, &s, sizeof s));
    double *points = (double *)room(3 * s.n_control_points, sizeof *points);
    OK(ricci_spline_values(flat, RICCI_SPLINE_CONTROL_POINTS, points, 3 * s.n_control_points));
    for (size_t i = 0; i < s.n_control_points; i++) points[3 * i + 2] = i % 2 ? height : -height;
    OK(ricci_spline_with_points(flat, points, s.n_control_points, &spline));
    free(points);
    ricci_spline_free(flat);
    ricci_mesh_free(domain);
    return spline;
}

/* A cubic fitted to a torus of radii 2 and 0.8. */
static ricci_spline *torus(void) {
    ricci_mesh *mesh = NULL;
    ricci_spline *spline = NULL;
    ricci_spline_surface_options options;
    OK(make_sized(RICCI_SHAPE_TORUS, 32, 16, 2, 0.8, 0, &mesh));
    ricci_metric *flat = flat_of(mesh, RICCI_TARGET_UNIFORM);
    INIT(options);
    options.rounds = 1;
    OK(ricci_spline_fit_surface(flat, &options, NULL, &spline));
    ricci_metric_free(flat);
    ricci_mesh_free(mesh);
    return spline;
}

static void step_files(const ricci_bicubic *bicubic, const ricci_bicubic_summary *s) {
    ricci_step_options options;
    char *plain = text_of(bicubic, RICCI_BICUBIC_STEP, NULL);
    char *again = text_of(bicubic, RICCI_BICUBIC_STEP, NULL);
    CHECK(strncmp(plain, "ISO-10303-21;", 13) == 0 && ends_with(plain, "END-ISO-10303-21;\n"));
    CHECK(strcmp(plain, again) == 0);
    CHECK(count(plain, " = MANIFOLD_SOLID_BREP(") == 1 && count(plain, " = OPEN_SHELL(") == 0);
    CHECK(count(plain, " = ADVANCED_FACE(") == s->n_patches);
    CHECK(count(plain, " = EDGE_CURVE(") == s->n_curves);
    CHECK(count(plain, "SI_UNIT(.MILLI.,.METRE.)") == 1);
    INIT(options);
    options.name = "my torus", options.unit = RICCI_UNIT_METRE;
    char *named = text_of(bicubic, RICCI_BICUBIC_STEP, &options);
    CHECK(!strstr(plain, "my torus") && strstr(named, "'my torus'"));
    CHECK(!strstr(named, ".MILLI.") && count(named, "SI_UNIT($,.METRE.)") == 1);
    OK(ricci_bicubic_write(bicubic, NULL, "bicubic.step"));
    file_is("bicubic.step", plain);
    OK(ricci_bicubic_write(bicubic, &options, "bicubic.STP"));
    file_is("bicubic.STP", named);
    free(plain), free(again), free(named);
}

/* The ends of curves are points of the spline: they lie on the torus as near as the fit, and their bounding
 * box is the one whose diagonal distances are divided by. */
static void json_files(const ricci_bicubic *bicubic, const ricci_bicubic_summary *s, double off) {
    static const char points[] = "\"points\":[";
    char *text = text_of(bicubic, RICCI_BICUBIC_JSON, NULL);
    CHECK(strncmp(text, "{\"format\":\"ricci-patches 1\",", 28) == 0 && ends_with(text, "]}\n"));
    CHECK(count(text, "\"source\"") == s->n_patches && count(text, "\"ends\"") == s->n_curves);
    char *at = strstr(text, points);
    CHECK(at);
    size_t n = 0;
    double low[3] = {9, 9, 9}, high[3] = {-9, -9, -9};
    for (at += strlen(points) - 1; *at != ']'; at++, n++) {
        double p[3];
        at = strchr(at + 1, '[');
        CHECK(at);
        for (int x = 0; x < 3; x++) {
            p[x] = strtod(at + 1, &at);
            low[x] = fmin(low[x], p[x]), high[x] = fmax(high[x], p[x]);
        }
        CHECK(*at == ']' && fabs(hypot(hypot(p[0], p[1]) - 2, p[2]) - 0.8) < off);
        CHECK(at[1] == ',' || at[1] == ']');
    }
    /* One for each vertex, side and triangle of the spline: V + E + F is 3 F on a torus. */
    CHECK(n == s->n_patches);
    const double diagonal = hypot(hypot(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
    CHECK(fabs(s->diagonal - diagonal) < 1e-13 && diagonal > 7);
    OK(ricci_bicubic_write(bicubic, NULL, "bicubic.json"));
    file_is("bicubic.json", text);
    free(text);
}

static void a_torus_is_a_solid(void) {
    ricci_spline *spline = torus();
    ricci_spline_summary of;
    OK(ricci_spline_summarise(spline, &of, sizeof of));
    ricci_bicubic *bicubic = patches_near(spline, 1e-2, 3, 1), *same = patches_near(spline, 1e-2, 3, 2);
    ricci_bicubic *finer = patches_near(spline, 3e-3, 0.5, 0);
    ricci_spline_free(spline);
    const ricci_bicubic_summary s = figures_of(bicubic), t = figures_of(same), u = figures_of(finer);
    CHECK(memcmp(&s, &t, sizeof s) == 0);
    CHECK(s.n_patches == 3 * of.n_patches && s.n_curves == 6 * of.n_patches);
    CHECK(s.closed == 1 && s.n_open_sides == 0 && s.reserved == 0);
    CHECK(s.spans_min >= 1 && s.spans_min <= s.spans_max && s.spans_max <= 128 && s.rounds >= 1);
    CHECK(s.n_control_points >= 16 * s.n_patches);
    CHECK(s.distance > 0 && s.distance <= 1e-2 && u.distance <= 3e-3 && u.distance < s.distance);
    CHECK(u.n_control_points > s.n_control_points && u.n_patches == s.n_patches);
    CHECK(0 < s.normal_jump_mean && s.normal_jump_mean <= s.normal_jump_max && s.normal_jump_max < 3);
    /* Half a radian is reached with spans to spare. */
    CHECK(u.normal_jump_max < 0.5 && u.normal_jump_max < s.normal_jump_max && u.spans_max < 128);
    CHECK(s.normal_jump_of_spline >= 0 && s.normal_jump_of_spline < 1e-6);
    step_files(bicubic, &s);
    json_files(bicubic, &s, of.fit_max + 0.02);
    /* Texts of the same patches are the same whatever the number of threads. */
    char *one = text_of(bicubic, RICCI_BICUBIC_STEP, NULL), *two = text_of(same, RICCI_BICUBIC_STEP, NULL);
    CHECK(strcmp(one, two) == 0);
    free(one), free(two);
    ricci_bicubic_free(bicubic), ricci_bicubic_free(same), ricci_bicubic_free(finer);
}

static void a_square_is_a_shell(void) {
    ricci_spline *spline = waves(4, 3, 0);
    ricci_bicubic *bicubic = NULL;
    OK(ricci_bicubic_new(spline, NULL, NULL, &bicubic));
    const ricci_bicubic_summary s = figures_of(bicubic);
    CHECK(s.n_patches == 6 && s.closed == 0 && s.n_open_sides == 0 && s.distance <= 1e-4);
    CHECK(s.normal_jump_max < 1e-12 && fabs(s.diagonal - sqrt(2)) < 1e-11);
    char *text = text_of(bicubic, RICCI_BICUBIC_STEP, NULL);
    CHECK(count(text, " = SHELL_BASED_SURFACE_MODEL(") == 1 && count(text, " = OPEN_SHELL(") == 1);
    CHECK(count(text, " = ADVANCED_FACE(") == 6 && !strstr(text, "MANIFOLD_SOLID_BREP"));
    /* A caller with the struct of an earlier version gets the fields that it knows. */
    ricci_bicubic_summary early;
    memset(&early, 7, sizeof early);
    OK(ricci_bicubic_summarise(bicubic, &early, 2 * sizeof(size_t)));
    CHECK(early.size == 2 * sizeof(size_t) && early.n_patches == 6 && early.n_curves > 6);
    free(text);
    ricci_bicubic_free(bicubic);
    ricci_spline_free(spline);
}

static void what_cannot_be_is_refused(void) {
    ricci_spline *spline = waves(3, 5, 0.1);
    ricci_bicubic *bicubic = NULL;
    ricci_bicubic_options options;
    ricci_failure failure;
    FAILS(ricci_bicubic_new(NULL, NULL, NULL, &bicubic), RICCI_NULL_POINTER, "spline");
    FAILS(ricci_bicubic_new(spline, NULL, NULL, NULL), RICCI_NULL_POINTER, "bicubic");
    INIT(options);
    const double tolerances[4] = {-1e-3, NAN, 2, 1e-11};
    for (int i = 0; i < 4; i++) {
        options.tolerance = tolerances[i];
        FAILS(ricci_bicubic_new(spline, &options, NULL, &bicubic), RICCI_ARGUMENT, "tolerance");
    }
    options.tolerance = 1e-3, options.angle = -1;
    FAILS(ricci_bicubic_new(spline, &options, NULL, &bicubic), RICCI_ARGUMENT, "angle");
    options.tolerance = 1e-10, options.angle = 0;
    FAILS(ricci_bicubic_new(spline, &options, NULL, &bicubic), RICCI_SPLINE, "128 spans");
    OK(ricci_last_failure(&failure, sizeof failure));
    CHECK(failure.element == RICCI_ELEMENT_FACE && failure.index == 0);
    options.tolerance = 1e-2, options.control_points = 10;
    FAILS(ricci_bicubic_new(spline, &options, NULL, &bicubic), RICCI_ARGUMENT, "larger tolerance");
    /* A control point far above the others folds the surface, which is refused unless it is allowed. */
    options.control_points = 0;
    ricci_spline_summary figures;
    OK(ricci_spline_summarise(spline, &figures, sizeof figures));
    double *points = (double *)room(figures.n_control_points, 3 * sizeof *points);
    ricci_spline *bent = NULL;
    OK(ricci_spline_values(spline, RICCI_SPLINE_CONTROL_POINTS, points, 3 * figures.n_control_points));
    points[3 * (figures.n_control_points / 2)] += 100;
    OK(ricci_spline_with_points(spline, points, figures.n_control_points, &bent));
    FAILS(ricci_bicubic_new(bent, &options, NULL, &bicubic), RICCI_SPLINE, "turns back on itself");
    options.folds = 1;
    OK(ricci_bicubic_new(bent, &options, NULL, &bicubic));
    ricci_bicubic_free(bicubic);
    bicubic = NULL;
    ricci_spline_free(bent);
    free(points);
    options.size = sizeof options - 4;
    FAILS(ricci_bicubic_new(spline, &options, NULL, &bicubic), RICCI_STRUCT_SIZE, "options");
    ricci_control *control = NULL;
    OK(ricci_control_new(&control));
    OK(ricci_control_cancel(control));
    CHECK(ricci_bicubic_new(spline, NULL, control, &bicubic) == RICCI_CANCELLED && !bicubic);
    ricci_control_free(control);
    ricci_bicubic_free(NULL);
    ricci_spline_free(spline);
}

static void files_that_cannot_be_are_refused(void) {
    ricci_spline *spline = waves(4, 3, 0);
    ricci_bicubic *bicubic = patches_near(spline, 1e-2, 0, 1);
    ricci_bicubic_summary s;
    ricci_step_options options;
    char text[16];
    size_t n = 1;
    INIT(options);
    FAILS(ricci_bicubic_summarise(NULL, &s, sizeof s), RICCI_NULL_POINTER, "bicubic");
    FAILS(ricci_bicubic_summarise(bicubic, NULL, sizeof s), RICCI_NULL_POINTER, "summary");
    FAILS(ricci_bicubic_write(NULL, NULL, "a.step"), RICCI_NULL_POINTER, "bicubic");
    FAILS(ricci_bicubic_write(bicubic, NULL, NULL), RICCI_NULL_POINTER, "path");
    FAILS(ricci_bicubic_write(bicubic, NULL, "a.obj"), RICCI_UNKNOWN_FORMAT, "a.obj: unknown format");
    FAILS(ricci_bicubic_write(bicubic, NULL, "no such folder/a.step"), RICCI_IO, "no such folder");
    FAILS(ricci_bicubic_text(bicubic, 2, NULL, NULL, 0, &n), RICCI_ARGUMENT, "format is 2");
    FAILS(ricci_bicubic_text(bicubic, 0, NULL, text, sizeof text, &n), RICCI_BUFFER_TOO_SMALL, "text");
    FAILS(ricci_bicubic_text(bicubic, 0, NULL, NULL, 0, NULL), RICCI_NULL_POINTER, "number of entries");
    options.unit = 2;
    FAILS(ricci_bicubic_text(bicubic, 0, &options, NULL, 0, &n), RICCI_ARGUMENT, "unit is 2");
    options.unit = 0, options.name = "\xff";
    FAILS(ricci_bicubic_write(bicubic, &options, "a.step"), RICCI_ARGUMENT, "name is not UTF-8");
    CHECK(n == 1 && !fopen("a.step", "rb"));
    ricci_bicubic_free(bicubic);
    ricci_spline_free(spline);
}

int main(void) {
    a_torus_is_a_solid();
    a_square_is_a_shell();
    what_cannot_be_is_refused();
    files_that_cannot_be_are_refused();
    return 0;
}
