/* Circle domains: loops on their circles, found again from the layout's points; annuli, holes, refusals. */
#include "arrays.h"
#include "samples.h"
#include <ricci/circles.h>

/* Every boundary point of the layout lies on one of the circles. */
static void lies_on_circles(const ricci_circle_domain *domain, size_t n_circles) {
    ricci_layout *layout = NULL;
    ricci_layout_summary s;
    OK(ricci_circle_domain_layout(domain, RICCI_MODEL_POINCARE, &layout));
    OK(ricci_layout_summarise(layout, &s, sizeof s));
    CHECK(s.n_flipped == 0);
    double *points = (double *)room(2 * s.n_points, sizeof *points);
    double *circles = (double *)room(4 * n_circles, sizeof *circles);
    uint32_t *corners = (uint32_t *)room(3 * s.n_faces, sizeof *corners);
    OK(ricci_layout_points(layout, RICCI_MODEL_POINCARE, points, 2 * s.n_points));
    OK(ricci_layout_corners(layout, RICCI_ON_REFINEMENT, corners, 3 * s.n_faces));
    OK(ricci_circle_domain_circles(domain, circles, 4 * n_circles));
    CHECK(ricci_circle_domain_circles(domain, circles, 4 * n_circles - 1) == RICCI_BUFFER_TOO_SMALL);
    size_t on_boundary = 0;
    for (size_t a = 0; a < 3 * s.n_faces; a++) {
        const uint32_t from = corners[a], to = corners[a - a % 3 + (a + 1) % 3];
        int inside = 0;
        for (size_t b = 0; b < 3 * s.n_faces && !inside; b++)
            inside = corners[b] == to && corners[b - b % 3 + (b + 1) % 3] == from;
        if (inside) continue;
        on_boundary++;
        int on = 0;
        for (size_t k = 0; k < n_circles; k++) {
            const double *c = circles + 4 * k, *p = points + 2 * (size_t)from;
            on += fabs(hypot(p[0] - c[0], p[1] - c[1]) - c[2]) < 1e-11 * c[2];
        }
        CHECK(on == 1);
    }
    CHECK(on_boundary >= 12 * n_circles);
    free(points), free(circles), free(corners);
    ricci_layout_free(layout);
}

static void an_annulus_has_its_modulus(void) {
    ricci_mesh *mesh = NULL, *finer = NULL;
    ricci_circle_domain *domain = NULL;
    ricci_circle_domain_summary s;
    ricci_mesh_summary m;
    OK(make_sized(RICCI_SHAPE_ANNULUS, 2, 24, 0.5, 1, 0, &mesh));
    OK(ricci_circle_domain_new(mesh, NULL, NULL, &domain));
    OK(ricci_circle_domain_summarise(domain, &s, sizeof s));
    CHECK(s.converged && s.space == RICCI_SPACE_E2 && s.n_circles == 2 && s.n_overlapping == 0);
    CHECK(s.max_curvature_error < 1e-10 && s.deviation < 1e-12 && s.stop_reason == RICCI_STOP_CONVERGED);
    CHECK(fabs(s.modulus[1] - log(2) / (2 * acos(-1))) < 1e-12 && s.modulus[0] == 0);
    lies_on_circles(domain, 2);
    OK(ricci_circle_domain_mesh(domain, &finer));
    OK(ricci_mesh_summarise(finer, &m, sizeof m));
    CHECK(m.n_vertices == 3 * 24 + s.n_halved);
    ricci_mesh_free(finer);
    ricci_circle_domain_free(domain);
    ricci_mesh_free(mesh);
}

static void an_annulus_lies_in_a_strip(void) {
    ricci_mesh *mesh = NULL;
    ricci_circle_domain *domain = NULL;
    ricci_circle_domain_summary s;
    ricci_circle_domain_options options;
    double logs[2], circles[8];
    OK(ricci_init(&options, sizeof options));
    options.frame = RICCI_FRAME_STRIP;
    OK(make_sized(RICCI_SHAPE_ANNULUS, 2, 24, 0.5, 1, 0, &mesh));
    OK(ricci_circle_domain_new(mesh, &options, NULL, &domain));
    OK(ricci_circle_domain_summarise(domain, &s, sizeof s));
    CHECK(s.converged && s.frame == RICCI_FRAME_STRIP && s.centred_on == UINT32_MAX && s.worst_loop < 2);
    OK(ricci_circle_domain_log_radii(domain, logs, 2));
    CHECK(ricci_circle_domain_log_radii(domain, logs, 1) == RICCI_BUFFER_TOO_SMALL);
    OK(ricci_circle_domain_circles(domain, circles, 8));
    CHECK(logs[s.outer] == 0 && fabs(logs[1 - s.outer] + 2 * acos(-1) * s.modulus[1]) < 1e-12);
    CHECK(fabs(circles[4 * (1 - s.outer) + 2] - exp(logs[1 - s.outer])) < 1e-15);
    ricci_circle_domain_free(domain);
    options.frame = 3;
    CHECK(ricci_circle_domain_new(mesh, &options, NULL, &domain) == RICCI_ARGUMENT);
    ricci_mesh_free(mesh);
}

static void holes_of_a_sphere_become_round(void) {
    ricci_mesh *sphere = NULL, *mesh = NULL;
    ricci_circle_domain *domain = NULL;
    ricci_circle_domain_options options;
    ricci_circle_domain_summary s;
    const uint32_t outer = 2, beyond = 4;
    OK(make_sphere(6, &sphere));
    OK(change(sphere, RICCI_CHANGE_PUNCH, 4, 0, 0, &mesh));
    INIT(options);
    options.outer = &outer;
    OK(ricci_circle_domain_new(mesh, &options, NULL, &domain));
    OK(ricci_circle_domain_summarise(domain, &s, sizeof s));
    CHECK(s.converged && s.outer == 2 && s.n_circles == 4 && s.modulus[0] != s.modulus[0]);
    double circles[16];
    OK(ricci_circle_domain_circles(domain, circles, 16));
    CHECK(circles[8] == 0 && circles[9] == 0 && circles[10] == 1);
    lies_on_circles(domain, 4);
    ricci_circle_domain_free(domain);
    /* Loops and vertices that do not exist are refused. */
    options.outer = &beyond;
    CHECK(ricci_circle_domain_new(mesh, &options, NULL, &domain) == RICCI_ARGUMENT);
    CHECK(ricci_circle_domain_new(sphere, NULL, NULL, &domain) == RICCI_ARGUMENT);
    const uint32_t vertices[3] = {0, 1, 2};
    options.outer = NULL, options.centre = vertices, options.three = vertices;
    CHECK(ricci_circle_domain_new(mesh, &options, NULL, &domain) == RICCI_ARGUMENT);
    CHECK(ricci_circle_domain_new(NULL, NULL, NULL, &domain) == RICCI_NULL_POINTER);
    ricci_circle_domain_free(NULL);
    ricci_mesh_free(mesh), ricci_mesh_free(sphere);
}

/* The circle of a face is orthogonal to those of its corners. */
static void circles_of_a_layout_are_orthogonal(void) {
    ricci_mesh *mesh = NULL;
    ricci_metric *metric = NULL, *flat = NULL;
    ricci_layout *layout = NULL;
    ricci_layout_summary s;
    ricci_flow_options rigid;
    INIT(rigid);
    rigid.flips = RICCI_FLIPS_NEVER;
    OK(make_disk(5, &mesh));
    OK(ricci_metric_new(mesh, RICCI_SCHEME_TANGENTIAL, RICCI_SPACE_E2, &metric));
    OK(ricci_flow(metric, NULL, &rigid, NULL, &flat));
    OK(ricci_layout_new(flat, NULL, NULL, &layout));
    OK(ricci_layout_summarise(layout, &s, sizeof s));
    double *of_points = (double *)room(3 * s.n_points, sizeof *of_points);
    double *of_faces = (double *)room(3 * s.n_faces, sizeof *of_faces);
    uint32_t *corners = (uint32_t *)room(3 * s.n_faces, sizeof *corners);
    OK(ricci_layout_circles(layout, RICCI_CIRCLES_VERTICES, of_points, 3 * s.n_points));
    OK(ricci_layout_circles(layout, RICCI_CIRCLES_FACES, of_faces, 3 * s.n_faces));
    OK(ricci_layout_corners(layout, RICCI_ON_METRIC, corners, 3 * s.n_faces));
    for (size_t a = 0; a < 3 * s.n_faces; a++) {
        const double *c = of_faces + 3 * (a / 3), *p = of_points + 3 * (size_t)corners[a];
        const double d = hypot(c[0] - p[0], c[1] - p[1]);
        CHECK(p[2] > 0 && fabs(d * d - c[2] - p[2]) < 1e-9 * (1 + d * d));
    }
    FAILS(ricci_layout_circles(layout, 2, of_points, 3 * s.n_points), RICCI_ARGUMENT, "which");
    FAILS(ricci_layout_circles(layout, RICCI_CIRCLES_FACES, of_faces, 3), RICCI_BUFFER_TOO_SMALL, "circles");
    FAILS(ricci_layout_circles(NULL, RICCI_CIRCLES_FACES, of_faces, 3), RICCI_NULL_POINTER, "layout");
    free(of_points), free(of_faces), free(corners);
    ricci_layout_free(layout), ricci_metric_free(flat), ricci_metric_free(metric), ricci_mesh_free(mesh);
}

int main(void) {
    circles_of_a_layout_are_orthogonal();
    an_annulus_has_its_modulus();
    an_annulus_lies_in_a_strip();
    holes_of_a_sphere_become_round();
    return 0;
}
