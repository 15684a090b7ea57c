/* The cases of tests/vectors: their seals, their surfaces, and how a result is held against one. */
#ifndef CASES_H
#define CASES_H

#include "json.h"
#include <math.h>
#include <ricci/shapes.h>

/* All files, so that none is missing. */
static const char *const files[] = {
    "atlases",  "circle_domains", "circle_patterns", "cones",          "derivative",
    "flow",     "forms",          "groups",          "harmonic",       "layouts",
    "matching", "splines",        "triangles",       "uniformization", NULL};

static const char *file_name;
static int n_failed;

static inline void fails(const json *node, const char *what, double error, double tolerance) {
    fprintf(stderr, "FAILED %s/%s: %s (off by %.2e, %.2e is allowed)\n", file_name, need(node, "name")->text,
            what, error, tolerance);
    n_failed++;
}

/* 1 if the case has this quantity. */
static inline int asks(const json *node, const char *quantity) {
    return member(need(node, "expect"), quantity) != NULL;
}

/* Holds n numbers against those of the case: none is off by more than the tolerance. */
static inline void agrees_within(const json *node, const char *quantity, const double *ours, size_t n,
                                 double tolerance) {
    const json *values = need(need(need(node, "expect"), quantity), "values");
    const double *exact = numbers(values);
    double error = values->n == n ? 0 : INFINITY;
    for (size_t i = 0; i < n && i < values->n; i++)
        if (!(fabs(ours[i] - exact[i]) <= error)) error = fabs(ours[i] - exact[i]);
    if (!(error <= tolerance)) fails(node, quantity, error, tolerance);
}

/* Holds n numbers against the case, if it has this quantity. */
static inline void agrees(const json *node, const char *quantity, const double *ours, size_t n) {
    const json *expected = member(need(node, "expect"), quantity);
    if (expected) agrees_within(node, quantity, ours, n, number(need(expected, "tolerance")));
}

/* FNV-1a of the text of a case up to its seal. */
static inline int sealed(const char *from, const char *to) {
    uint64_t value = 0xcbf29ce484222325u;
    const char *seal = strstr(from, ",\"seal\":\"");
    CHECK(seal && seal < to);
    for (; from < seal; from++) value = (value ^ (unsigned char)*from) * 0x100000001b3u;
    return strtoull(seal + 9, NULL, 16) == value;
}

/* Calls `one` for every case whose seal holds. */
static inline void for_each_case(const char *folder, void (*one)(const json *)) {
    for (size_t k = 0; files[k]; k++) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s.json", folder, files[k]);
        file_name = files[k];
        FILE *file = fopen(path, "rb");
        if (!file) fprintf(stderr, "no %s\n", path);
        CHECK(file && fseek(file, 0, SEEK_END) == 0);
        const long size = ftell(file);
        char *text = (char *)room((size_t)size, 1);
        rewind(file);
        CHECK(fread(text, 1, (size_t)size, file) == (size_t)size);
        fclose(file);
        size_t n = 0;
        for (const char *at = strstr(text, "{\"name\""); at; at = strstr(at, "\n{\"name\"")) {
            at += *at == '\n';
            const char *end = strchr(at, '\n'), *p = at;
            CHECK(end);
            const json *node = json_value(&p);
            CHECK(strlen(need(node, "because")->text) > 0);
            if (sealed(at, end))
                one(node);
            else
                fails(node, "what is written is not what was sealed", 0, 0);
            json_forget();
            n++;
        }
        CHECK(n > 0);
        free(text);
    }
}

static inline uint32_t space_of(const json *name) {
    return is(name, "h2") ? RICCI_SPACE_H2 : is(name, "s2") ? RICCI_SPACE_S2 : RICCI_SPACE_E2;
}

static inline uint32_t scheme_of(const json *name) {
    const char *const schemes[] = {"yamabe", "inversive", "thurston", "tangential", "virtual"};
    for (uint32_t k = 0; k < 5; k++)
        if (is(name, schemes[k])) return k;
    CHECK(!"a scheme");
    return 0;
}

static inline uint32_t flips_of(const json *how) {
    return is(member(how, "flips"), "never") ? RICCI_FLIPS_NEVER : RICCI_FLIPS_AUTO;
}

/* A surface: positions and faces, a gluing, or a shape. */
static inline ricci_mesh *surface(const json *given) {
    ricci_mesh *mesh = NULL;
    const json *shape = member(given, "shape");
    if (shape) {
        ricci_shape made;
        INIT(made);
        made.shape = is(shape, "two_vertex") ? RICCI_SHAPE_TWO_VERTEX : RICCI_SHAPE_TORUS;
        if (member(given, "genus")) made.genus = whole(need(given, "genus"));
        if (made.shape == RICCI_SHAPE_TORUS) {
            made.a = number(need(given, "a")), made.b = number(need(given, "b"));
            made.n = whole(need(given, "n")), made.m = whole(need(given, "m"));
        }
        OK(ricci_make(&made, &mesh));
        return mesh;
    }
    const json *faces = need(given, "faces"), *positions = member(given, "positions");
    const size_t n = whole(need(given, "n_vertices"));
    if (positions) {
        OK(ricci_mesh_from_arrays(numbers(positions), 0, n, indices(faces), faces->n / 3, &mesh));
        return mesh;
    }
    ricci_gluing gluing;
    INIT(gluing);
    gluing.n_vertices = n, gluing.n_faces = faces->n / 3, gluing.faces = indices(faces);
    gluing.face_edges = signed_indices(need(given, "face_edges"));
    gluing.lengths = numbers(need(given, "lengths")), gluing.n_edges = need(given, "lengths")->n;
    gluing.geometry = space_of(need(given, "geometry"));
    OK(ricci_mesh_from_gluing(&gluing, &mesh));
    return mesh;
}

/* The triangle of a case as a surface of one face. */
static inline ricci_mesh *triangle_surface(const json *how) {
    static const uint32_t corners[] = {0, 1, 2};
    static const int32_t edges[] = {1, 2, 3};
    ricci_mesh *mesh = NULL;
    ricci_gluing gluing;
    INIT(gluing);
    gluing.n_vertices = 3, gluing.n_faces = 1, gluing.faces = corners, gluing.face_edges = edges;
    gluing.lengths = numbers(need(how, "lengths")), gluing.n_edges = 3;
    gluing.geometry = space_of(need(how, "space"));
    OK(ricci_mesh_from_gluing(&gluing, &mesh));
    return mesh;
}

/* Holds the curvatures at the corners, pi minus the angles, and the area of a triangle's surface against the
 * case. In the hyperbolic plane its lengths go through the variables of the class, whose rounding weighs the
 * more the less the two shorter sides have over the longest: by the root of that at angles, by itself in the
 * area. The tolerances are other ones than those of the formulas. */
static inline void triangle_agrees(const json *node, const double *curvature, double area) {
    const json *how = need(node, "options"), *expected = need(need(node, "expect"), "area");
    const double *l = numbers(need(how, "lengths")), exact = numbers(need(expected, "values"))[0];
    const double rounding = 8 * 2.220446049250313e-16, pi = acos(-1);
    double angles[3], spare = 1;
    for (int k = 0; k < 3; k++) {
        const double a = l[k], b = l[(k + 1) % 3], c = l[(k + 2) % 3];
        angles[k] = pi - curvature[k];
        if (a >= b && a >= c && is(need(how, "space"), "h2"))
            spare = fmin(1, 2 * (fmin(b, c) - (a - fmax(b, c))) / a);
    }
    agrees_within(node, "angles", angles, 3, rounding / sqrt(spare));
    agrees_within(node, "area", &area, 1, rounding / spare * exact);
}

/* The space and the model by which the numbers of a layout or chart become distances. */
enum { IN_PLANE, IN_POINCARE, UNDER_SPHERE, IN_KLEIN };

static inline double distance(int model, const double *p, const double *q) {
    const double apart = hypot(p[0] - q[0], p[1] - q[1]), cross = p[0] * q[1] - p[1] * q[0];
    const double a = p[0] * p[0] + p[1] * p[1], b = q[0] * q[0] + q[1] * q[1];
    if (model == IN_PLANE) return apart;
    if (model == IN_POINCARE) return 2 * asinh(apart / sqrt((1 - a) * (1 - b)));
    if (model == IN_KLEIN) return asinh(sqrt((apart * apart - cross * cross) / ((1 - a) * (1 - b))));
    return 2 * asin(fmin(1, apart / sqrt((1 + a) * (1 + b))));
}

static inline uint32_t kind_of(const json *name) {
    const char *const kinds[] = {"conformal", "spherical", "affine", "hyperbolic", "projective"};
    for (uint32_t k = 0; k < 5; k++)
        if (is(name, kinds[k])) return k;
    CHECK(!"a kind of structure");
    return 0;
}

/* The space and the model of the charts of a structure. */
static inline int model_of(const json *kind) {
    const int models[] = {IN_PLANE, UNDER_SPHERE, IN_PLANE, IN_POINCARE, IN_KLEIN};
    return models[kind_of(kind)];
}

/* The sides opposite the corners of a triangle, x and y of each. */
static inline void sides_of(int model, const double *corners, double *sides) {
    for (int k = 0; k < 3; k++)
        sides[k] = distance(model, corners + 2 * ((k + 1) % 3), corners + 2 * ((k + 2) % 3));
}

/* The quantities of a layout that do not depend on its position, from its corners in the plane. */
static inline void layout_agrees(const json *node, const double *uv, size_t n_faces) {
    const int models[] = {IN_PLANE, IN_POINCARE, UNDER_SPHERE};
    const int model = models[space_of(need(need(node, "options"), "space"))];
    double *sides = (double *)keep(3 * n_faces, sizeof *sides);
    double *distances = (double *)keep(3 * n_faces, sizeof *distances);
    for (size_t f = 0; f < n_faces; f++) sides_of(model, uv + 6 * f, sides + 3 * f);
    for (size_t c = 0; c < 3 * n_faces; c++) distances[c] = distance(model, uv, uv + 2 * c);
    agrees(node, "sides", sides, 3 * n_faces);
    agrees(node, "distances", distances, 3 * n_faces);
}

/* For the corners of every face: of the edge opposite, i j with k here and l across, |il| |jk| / (|lj| |ki|).
 */
static inline void cross_ratios_agree(const json *node, const double *points) {
    const json *list = need(need(node, "mesh"), "faces");
    const uint32_t *faces = indices(list);
    double *ratios = (double *)keep(list->n, sizeof *ratios);
    for (size_t c = 0; c < list->n; c++) {
        const size_t f = c - c % 3;
        const uint32_t k = faces[c], i = faces[f + (c + 1) % 3], j = faces[f + (c + 2) % 3];
        uint32_t l = k;
        for (size_t d = 0; d < list->n; d++)
            if (faces[d - d % 3 + (d + 1) % 3] == j && faces[d - d % 3 + (d + 2) % 3] == i) l = faces[d];
        const uint32_t pairs[8] = {i, l, j, k, l, j, k, i};
        double lengths[4];
        for (int m = 0; m < 4; m++) {
            const double *p = points + 3 * pairs[2 * m], *q = points + 3 * pairs[2 * m + 1];
            lengths[m] = hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
        }
        ratios[c] = lengths[0] * lengths[1] / (lengths[2] * lengths[3]);
    }
    agrees(node, "cross_ratios", ratios, list->n);
}

/* The distances of points in space from the torus of revolution of the case. */
static inline void torus_agrees(const json *node, const double *points, size_t n) {
    const json *torus = need(node, "mesh");
    const double a = number(need(torus, "a")), b = number(need(torus, "b"));
    double worst = 0;
    for (size_t i = 0; i < n; i++) {
        const double *p = points + 3 * i;
        worst = fmax(worst, fabs(hypot(hypot(p[0], p[1]) - a, p[2]) - b));
    }
    agrees(node, "distance", &worst, 1);
}

static inline int by_size(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static inline int by_radius(const void *a, const void *b) {
    return by_size((const double *)b + 2, (const double *)a + 2);
}

/* x, y, radius of every circle, the largest first, from rows of four numbers, which are put into that order.
 */
static inline void circles_agree(const json *node, double *rows, size_t n) {
    double *ours = (double *)keep(3 * n, sizeof *ours);
    qsort(rows, n, 4 * sizeof *rows, by_radius);
    for (size_t i = 0; i < n; i++) memcpy(ours + 3 * i, rows + 4 * i, 3 * sizeof *ours);
    agrees(node, "circles", ours, 3 * n);
}

/* Points, first and second derivatives, from the 18 numbers of every place. */
static inline void jets_agree(const json *node, const double *values, size_t n) {
    double *parts[3];
    const char *const names[3] = {"point", "first", "second"};
    const size_t start[4] = {0, 3, 9, 18};
    for (int k = 0; k < 3; k++) {
        const size_t width = start[k + 1] - start[k];
        parts[k] = (double *)keep(n * width, sizeof(double));
        for (size_t i = 0; i < n; i++)
            memcpy(parts[k] + i * width, values + 18 * i + start[k], width * sizeof(double));
        agrees(node, names[k], parts[k], n * width);
    }
}

#endif
