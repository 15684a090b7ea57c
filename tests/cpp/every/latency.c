/* How long calls run on after they are cancelled: every long call is made once on a large surface, and again
 * with a control that another thread cancels after shares of the time which the first took. Prints the time
 * of each call and the longest time from cancelling to its end, and fails where a call ends otherwise than
 * with RICCI_CANCELLED or RICCI_OK, or where one of more than a tenth of a second was never
 * cancelled before its end.
 * Usage: latency [VERTICES [NAME...]]; with names only the calls whose own name contains one of them.
 */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <pthread.h>
#include <ricci/bicubic.h>
#include <ricci/circles.h>
#include <ricci/flatten.h>
#include <ricci/harmonic.h>
#include <ricci/match.h>
#include <ricci/moduli.h>
#include <ricci/quad_spline.h>
#include <ricci/quads.h>
#include <ricci/repair.h>
#include <ricci/shapes.h>
#include <ricci/structure.h>
#include <ricci/uniformize.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { SHARES = 12 };

static void check(ricci_status status) {
    if (status != RICCI_OK) {
        fprintf(stderr, "%s: %s\n", ricci_status_text(status), ricci_last_error());
        exit(1);
    }
}

/* What the calls are made on. */
static ricci_mesh *torus, *sphere, *two, *disk, *annulus;
static ricci_metric *torus_metric, *disk_metric, *cones, *flat;
static ricci_solver *solver;
static ricci_layout *layout;
static ricci_uniform *quotient, *polyhedron;
static ricci_dirichlet *dirichlet;
static ricci_deck *generators;
static ricci_forms *forms;
static ricci_matching *matching;
static ricci_seamless *seamless;
static ricci_spline *spline, *plane;
static ricci_quad_spline *quad_spline;
static ricci_soup *soup;
static size_t n_most;
static double *numbers, *points;
static uint32_t *indices, *zeros;

static ricci_mesh *made(uint32_t kind, size_t n, size_t m, double a, double b) {
    ricci_shape shape;
    ricci_mesh *mesh;
    check(ricci_init(&shape, sizeof shape));
    shape.shape = kind, shape.n = n, shape.m = m, shape.a = a, shape.b = b, shape.genus = 2;
    check(ricci_make(&shape, &mesh));
    return mesh;
}

/* A surface with noise, which no symmetry makes easy. */
static ricci_mesh *rough(ricci_mesh *mesh) {
    ricci_change_spec change;
    ricci_mesh *result;
    check(ricci_init(&change, sizeof change));
    change.change = RICCI_CHANGE_NOISE, change.amount = 0.1, change.seed = 1;
    check(ricci_change(mesh, &change, &result));
    ricci_mesh_free(mesh);
    return result;
}

static void set_up(double n) {
    const size_t side = (size_t)sqrt(n / 2);
    torus = rough(made(RICCI_SHAPE_TORUS, 2 * side, side, 2, 0.8));
    sphere = rough(made(RICCI_SHAPE_SPHERE, (size_t)sqrt(n / 10), 0, 0, 0));
    two = rough(made(RICCI_SHAPE_GENUS, (size_t)sqrt(n / 88) + 1, 0, 0, 0));
    disk = rough(made(RICCI_SHAPE_DISK, (size_t)sqrt(n / 3), 0, 0, 0));
    annulus = rough(made(RICCI_SHAPE_ANNULUS, side, side, 1, 3));
    ricci_target target;
    check(ricci_init(&target, sizeof target));
    check(ricci_metric_new(torus, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &torus_metric));
    check(ricci_metric_new(disk, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &disk_metric));
    check(ricci_flow(torus_metric, NULL, NULL, NULL, &flat));
    target.kind = RICCI_TARGET_AUTO, target.n = 8;
    check(ricci_flow(torus_metric, &target, NULL, NULL, &cones));
    check(ricci_solver_new(torus_metric, NULL, &solver));
    check(ricci_layout_new(cones, NULL, NULL, &layout));
    check(ricci_uniformize(two, NULL, NULL, &quotient));
    check(ricci_uniformize(sphere, NULL, NULL, &polyhedron));
    check(ricci_dirichlet_new(quotient, NULL, NULL, &dirichlet));
    check(ricci_deck_new(quotient, NULL, NULL, &generators));
    check(ricci_forms_new(two, NULL, NULL, &forms));
    check(ricci_match(torus, torus, NULL, NULL, &matching));
    check(ricci_seamless_new(torus, NULL, NULL, &seamless));
    check(ricci_spline_fit_surface(flat, NULL, NULL, &spline));
    const ricci_quad_spline_options one_span = {sizeof one_span, 0, 1e-8, 0, 1, 0};
    check(ricci_quad_spline_fit(seamless, NULL, &one_span, NULL, &quad_spline));
    /* A spline over a square, and points near it. */
    const double corners[] = {0, 0, 1, 0, 1, 1, 0, 1};
    const size_t starts[] = {0, 4};
    ricci_mesh *domain;
    check(ricci_spline_domain(corners, starts, 1, 0.05, &domain));
    check(ricci_spline_new(domain, NULL, &plane));
    ricci_mesh_free(domain);
    ricci_mesh_summary s;
    check(ricci_mesh_summarise(torus, &s, sizeof s));
    n_most = 3 * s.n_faces;
    numbers = malloc(6 * n_most * sizeof *numbers);
    indices = malloc(n_most * sizeof *indices);
    points = malloc(n_most * sizeof *points);
    zeros = calloc(n_most, sizeof *zeros);
    if (!numbers || !indices || !points || !zeros) exit(1);
    check(ricci_mesh_values(torus, RICCI_POSITIONS, points, 3 * s.n_vertices));
    check(ricci_mesh_faces(torus, indices, 3 * s.n_faces));
    check(ricci_soup_from_arrays(points, 0, s.n_vertices, indices, s.n_faces, &soup));
    /* From here on they lie in the unit cube, in an order that is not that of the surface. */
    for (size_t i = 0; i < n_most; i++) points[i] = fmod(0.618033988749895 * (double)(i + i / 3 % 7), 1.0);
    check(ricci_mesh_write(torus, NULL, "latency.obj"));
}

/* A job that makes a handle, and releases it. */
#define MAKES(name, type, call)                                                                              \
    static ricci_status do_##name(const ricci_control *control) {                                            \
        type *result = NULL;                                                                                 \
        (void)control;                                                                                       \
        const ricci_status status = call;                                                                    \
        type##_free(result);                                                                                 \
        return status;                                                                                       \
    }
/* A job that fills an array. */
#define FILLS(name, call)                                                                                    \
    static ricci_status do_##name(const ricci_control *control) {                                            \
        (void)control;                                                                                       \
        return call;                                                                                         \
    }

static const ricci_target EIGHT = {sizeof EIGHT, RICCI_TARGET_AUTO, 0, 8, NULL, NULL};
static const ricci_refine_options FINE = {sizeof FINE, 2, 0, 0, 0};
static const ricci_repair_options REPAIR = {sizeof REPAIR, 1e-7, 0, 1, 1, 1, 1, SIZE_MAX, NULL, 0};
static const ricci_deck_spec DEEP = {sizeof DEEP, RICCI_DECK_DEPTH, 0, NULL, 0, NULL, 0, NULL, 0.,
                                     6,           10000000};
static const ricci_deck_spec SHORT = {sizeof SHORT, RICCI_DECK_GEODESICS, 0, NULL, 0, NULL, 0, NULL, 5, 0,
                                      10000000};
static const ricci_bounds_options NARROW = {sizeof NARROW, 1e-5, 0, RICCI_DEGREE_QUADRATIC, 0};
static const ricci_structure_options FORM = {sizeof FORM, NULL, NULL, 0, 0, RICCI_AFFINE_FORM, 0};
static const ricci_harmonic_spec ROUND = {sizeof ROUND, NULL, NULL, 0, RICCI_HARMONIC_SPHERE, 0, 0, 0};
static const ricci_quads_options MANY = {sizeof MANY, RICCI_QUADS_NUMBER, 0, 20000, 0, 0};
static const ricci_bicubic_options NEAR = {sizeof NEAR, 1e-3, 0.2, 0, 0, 1, 0};
static ricci_harmonic_summary figures;
static ricci_flatten_summary flat_figures;
static ricci_dart_summary dart_figures;
static const ricci_flatten_options LENGTHS = {.size = sizeof LENGTHS, .energy = RICCI_FLATTEN_DISTANCE};
static const ricci_flatten_options APART = {.size = sizeof APART, .injective = 1};
static const ricci_dart_options TIGHT = {.size = sizeof TIGHT, .strain_warp = 1e-9, .most = 1};
static ricci_bounds_summary bounds_figures;
static ricci_dilatation_bracket bracket_figures;
static ricci_matching_judgement judgement_figures;
static size_t n_points;
static ricci_seamless_options isometric = {.size = sizeof isometric, .isometric_steps = 5};

FILLS(target_fill, ricci_target_fill(torus_metric, &EIGHT, control, numbers, n_most))
MAKES(flow, ricci_metric, ricci_flow(torus_metric, NULL, NULL, control, &result))
MAKES(flow_of_cones, ricci_metric, ricci_flow(torus_metric, &EIGHT, NULL, control, &result))
MAKES(flow_with_boundary, ricci_metric, ricci_flow(disk_metric, NULL, NULL, control, &result))
MAKES(solver_solve, ricci_metric, ricci_solver_solve(solver, &EIGHT, control, &result))
MAKES(layout_new, ricci_layout, ricci_layout_new(cones, NULL, control, &result))
MAKES(map_new, ricci_map, ricci_map_new(cones, control, &result))
MAKES(repaired_input_new, ricci_repaired_input, ricci_repaired_input_new(layout, control, &result))
MAKES(charts_new, ricci_charts, ricci_charts_new(layout, 0.01, control, &result))
MAKES(homotopy_new, ricci_homotopy, ricci_homotopy_new(two, NULL, control, &result))
MAKES(uniformize_sphere, ricci_uniform, ricci_uniformize(sphere, NULL, control, &result))
MAKES(uniformize_torus, ricci_uniform, ricci_uniformize(torus, NULL, control, &result))
MAKES(uniformize_genus_2, ricci_uniform, ricci_uniformize(two, NULL, control, &result))
MAKES(uniform_layout, ricci_layout,
      ricci_uniform_layout(quotient, RICCI_ON_REFINEMENT, RICCI_MODEL_POINCARE, control, &result))
MAKES(sphere_mesh, ricci_mesh, ricci_sphere_mesh(polyhedron, RICCI_ON_REFINEMENT, control, &result))
MAKES(deck_new, ricci_deck, ricci_deck_new(quotient, &DEEP, control, &result))
MAKES(deck_geodesics, ricci_deck, ricci_deck_new(quotient, &SHORT, control, &result))
FILLS(deck_geodesic,
      ricci_deck_geodesic(generators, 0, control, indices, n_most, numbers, 6 * n_most, &n_points))
MAKES(dirichlet_new, ricci_dirichlet, ricci_dirichlet_new(quotient, NULL, control, &result))
MAKES(circle_domain_new, ricci_circle_domain, ricci_circle_domain_new(annulus, NULL, control, &result))
FILLS(flatten,
      ricci_flatten(disk, NULL, control, numbers, n_most, NULL, 0, &flat_figures, sizeof flat_figures))
FILLS(flatten_distance,
      ricci_flatten(disk, &LENGTHS, control, numbers, n_most, NULL, 0, &flat_figures, sizeof flat_figures))
FILLS(flatten_injective,
      ricci_flatten(disk, &APART, control, numbers, n_most, NULL, 0, &flat_figures, sizeof flat_figures))
FILLS(flatten_sphere, ricci_flatten_sphere(sphere, NULL, control, numbers, n_most, NULL, 0, &flat_figures,
                                           sizeof flat_figures))
FILLS(inflate, ricci_inflate(sphere, 0, 0, control, numbers, n_most))
MAKES(flatten_darts, ricci_mesh,
      ricci_flatten_darts(disk, NULL, &TIGHT, control, NULL, 0, &dart_figures, sizeof dart_figures, &result))
FILLS(harmonic, ricci_harmonic(disk, NULL, control, numbers, n_most))
FILLS(harmonic_map_to_sphere, ricci_harmonic_map(sphere, &ROUND, control, numbers, n_most, numbers + n_most,
                                                 n_most, &figures, sizeof figures))
MAKES(forms_new, ricci_forms, ricci_forms_new(two, NULL, control, &result))
FILLS(forms_bounds,
      ricci_forms_bounds(forms, &NARROW, control, numbers, n_most, &bounds_figures, sizeof bounds_figures))
FILLS(modulus_bounds,
      ricci_modulus_bounds(annulus, NULL, &NARROW, control, numbers, &bounds_figures, sizeof bounds_figures))
FILLS(matching_bracket,
      ricci_matching_bracket(matching, NULL, NULL, control, &bracket_figures, sizeof bracket_figures))
FILLS(matching_judge, ricci_matching_judge(matching, control, &judgement_figures, sizeof judgement_figures))
MAKES(match_by_shape, ricci_matching, ricci_match_by_shape(sphere, sphere, NULL, control, &result))
MAKES(match_tori, ricci_matching, ricci_match(torus, torus, NULL, control, &result))
MAKES(match_spheres, ricci_matching, ricci_match(sphere, sphere, NULL, control, &result))
MAKES(match_genus_2, ricci_matching, ricci_match(two, two, NULL, control, &result))
MAKES(matching_map, ricci_map, ricci_matching_map(matching, control, &result))
MAKES(seamless_new, ricci_seamless, ricci_seamless_new(torus, NULL, control, &result))
MAKES(seamless_isometric, ricci_seamless, ricci_seamless_new(torus, &isometric, control, &result))
FILLS(seamless_field, ricci_seamless_field(torus, NULL, control, numbers, n_most))
MAKES(seamless_map, ricci_layout, ricci_seamless_map(seamless, control, &result))
MAKES(seamless_flatten, ricci_layout,
      ricci_seamless_flatten(seamless, NULL, control, NULL, 0, &flat_figures, sizeof flat_figures, &result))
MAKES(quads_new, ricci_quads, ricci_quads_new(seamless, &MANY, control, &result))
MAKES(quad_layout_new, ricci_quad_layout, ricci_quad_layout_new(seamless, NULL, control, &result))
MAKES(structure_affine, ricci_structure,
      ricci_structure_new(two, RICCI_STRUCTURE_AFFINE, NULL, control, &result))
MAKES(structure_of_form, ricci_structure,
      ricci_structure_new(two, RICCI_STRUCTURE_AFFINE, &FORM, control, &result))
MAKES(spline_fit, ricci_spline, ricci_spline_fit(plane, points, n_most / 3, NULL, control, &result))
FILLS(spline_curvatures, ricci_spline_curvatures(two, NULL, RICCI_SPLINE_AUTO, 0, control, numbers, n_most))
MAKES(spline_fit_surface, ricci_spline, ricci_spline_fit_surface(flat, NULL, control, &result))
/* The sizes of triangles are adapted once. */
static const ricci_spline_surface_options ONCE = {.size = sizeof ONCE, .tolerance = 0.05, .rounds = 1};
MAKES(spline_fit_mesh, ricci_spline, ricci_spline_fit_mesh(two, &ONCE, control, &result))
FILLS(spline_closest, ricci_spline_closest(spline, points, n_most / 3, control, indices, numbers, 6 * n_most))
MAKES(spline_tessellate, ricci_mesh, ricci_spline_tessellate(spline, 16, control, &result))
MAKES(bicubic_new, ricci_bicubic, ricci_bicubic_new(spline, &NEAR, control, &result))
MAKES(mesh_refine_angle, ricci_mesh, ricci_mesh_refine_angle(torus, NULL, control, NULL, 0, &result))
MAKES(mesh_read, ricci_mesh, ricci_mesh_read("latency.obj", &result))
FILLS(mesh_write, ricci_mesh_write(torus, NULL, "latency.ply"))
MAKES(soup_refine, ricci_soup, ricci_soup_refine(soup, &FINE, &result))
MAKES(soup_repair, ricci_soup, ricci_soup_repair(soup, &REPAIR, &result))

/* What is rough is not met to a thousandth. */
static const ricci_quad_spline_options ROUGH = {sizeof ROUGH, 0.02, 1e-8, 0, 2, 0};
MAKES(quad_spline_fit_mesh, ricci_quad_spline,
      ricci_quad_spline_fit_mesh(sphere, 0, &ROUGH, control, &result))
MAKES(quad_spline_fit, ricci_quad_spline, ricci_quad_spline_fit(seamless, NULL, &ROUGH, control, &result))
FILLS(quad_spline_closest,
      ricci_quad_spline_closest(quad_spline, points, n_most / 3, control, indices, numbers, 6 * n_most))
MAKES(quad_spline_tessellate, ricci_mesh, ricci_quad_spline_tessellate(quad_spline, 100, 0, control, &result))
FILLS(quad_spline_patch_of_faces,
      ricci_quad_spline_patch_of_faces(quad_spline, torus, control, indices, n_most))

static ricci_status do_quad_spline_evaluate(const ricci_control *control) {
    ricci_spline_places places;
    check(ricci_init(&places, sizeof places));
    places.patches = zeros, places.parameters = points, places.n = n_most / 3;
    return ricci_quad_spline_evaluate(quad_spline, &places, RICCI_QUAD_SPLINE_POINT, control, numbers,
                                      n_most);
}

static ricci_status do_spline_evaluate(const ricci_control *control) {
    ricci_spline_places places;
    check(ricci_init(&places, sizeof places));
    places.parameters = points, places.n = n_most / 3;
    return ricci_spline_evaluate(plane, &places, RICCI_SPLINE_SECOND, control, numbers, 6 * n_most);
}

#define JOB(name)                                                                                            \
    { #name, do_##name }
static const struct {
    const char *name;
    ricci_status (*call)(const ricci_control *control);
} JOBS[] = {JOB(target_fill),
            JOB(flow),
            JOB(flow_of_cones),
            JOB(flow_with_boundary),
            JOB(solver_solve),
            JOB(layout_new),
            JOB(map_new),
            JOB(repaired_input_new),
            JOB(charts_new),
            JOB(homotopy_new),
            JOB(uniformize_sphere),
            JOB(uniformize_torus),
            JOB(uniformize_genus_2),
            JOB(uniform_layout),
            JOB(sphere_mesh),
            JOB(deck_new),
            JOB(deck_geodesics),
            JOB(deck_geodesic),
            JOB(dirichlet_new),
            JOB(circle_domain_new),
            JOB(flatten),
            JOB(flatten_distance),
            JOB(flatten_injective),
            JOB(flatten_sphere),
            JOB(inflate),
            JOB(flatten_darts),
            JOB(harmonic),
            JOB(harmonic_map_to_sphere),
            JOB(forms_new),
            JOB(forms_bounds),
            JOB(modulus_bounds),
            JOB(matching_bracket),
            JOB(matching_judge),
            JOB(match_by_shape),
            JOB(match_tori),
            JOB(match_spheres),
            JOB(match_genus_2),
            JOB(matching_map),
            JOB(seamless_new),
            JOB(seamless_isometric),
            JOB(seamless_field),
            JOB(seamless_map),
            JOB(seamless_flatten),
            JOB(quads_new),
            JOB(quad_layout_new),
            JOB(structure_affine),
            JOB(structure_of_form),
            JOB(spline_fit),
            JOB(spline_curvatures),
            JOB(spline_fit_surface),
            JOB(spline_fit_mesh),
            JOB(spline_closest),
            JOB(spline_evaluate),
            JOB(spline_tessellate),
            JOB(bicubic_new),
            JOB(quad_spline_fit_mesh),
            JOB(quad_spline_fit),
            JOB(quad_spline_evaluate),
            JOB(quad_spline_closest),
            JOB(quad_spline_tessellate),
            JOB(quad_spline_patch_of_faces),
            JOB(mesh_refine_angle),
            JOB(mesh_read),
            JOB(mesh_write),
            JOB(soup_refine),
            JOB(soup_repair)};

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* Cancels a control after a while. */
typedef struct canceller {
    const ricci_control *control;
    double after;
} canceller;

static void *cancel_later(void *data) {
    const canceller *c = data;
    struct timespec pause;
    pause.tv_sec = (time_t)c->after;
    pause.tv_nsec = (long)(1e9 * (c->after - (double)pause.tv_sec));
    nanosleep(&pause, NULL);
    check(ricci_control_cancel(c->control));
    return NULL;
}

/* Makes a call with a control, which is the thread's too; the latency is -1 where the call ended before. */
static ricci_status watched(ricci_status (*call)(const ricci_control *), double after, double *latency) {
    ricci_control *control;
    pthread_t other;
    uint32_t stage;
    double fraction;
    check(ricci_control_new(&control));
    check(ricci_control_use(control));
    canceller c = {control, after};
    if (pthread_create(&other, NULL, cancel_later, &c) != 0) exit(1);
    const ricci_status status = call(control);
    check(ricci_control_progress(control, &stage, &fraction, latency));
    pthread_join(other, NULL);
    if (status != RICCI_CANCELLED) *latency = -1;
    check(ricci_control_use(NULL));
    ricci_control_free(control);
    return status;
}

int main(int argc, char **argv) {
    int failed = 0;
    set_up(argc > 1 ? atof(argv[1]) : 50000);
    printf("| call | seconds | milliseconds to its end after cancelling, at most | at this share "
           "|\n|---|---|---|---|\n");
    for (size_t i = 0; i < sizeof JOBS / sizeof *JOBS; i++) {
        int is_asked = argc < 3;
        for (int k = 2; k < argc; k++) is_asked |= strstr(JOBS[i].name, argv[k]) != NULL;
        if (!is_asked) continue;
        const double start = now();
        check(JOBS[i].call(NULL));
        const double whole = now() - start;
        double worst = -1, at = 0;
        for (int k = 0; k < SHARES; k++) {
            const double share = (k + 0.5) / SHARES;
            double latency;
            const ricci_status status = watched(JOBS[i].call, share * whole, &latency);
            if (status != RICCI_CANCELLED && status != RICCI_OK) {
                fprintf(stderr, "%s: %s\n", JOBS[i].name, ricci_last_error());
                failed = 1;
            }
            if (latency > worst) worst = latency, at = share;
        }
        printf("| %s | %.3f | %.1f | %.2f |\n", JOBS[i].name, whole, 1e3 * worst, at);
        fflush(stdout);
        if (worst < 0 && whole > 0.1) failed = 1;
    }
    return failed;
}
