/* Sample surfaces of ricci/shapes.h in one line each, and flat metrics of them. */
#ifndef SAMPLES_H
#define SAMPLES_H

#include "check.h"
#include <ricci/shapes.h>

static inline ricci_status make(uint32_t kind, size_t genus, size_t n, size_t m, const double sizes[3],
                                ricci_mesh **mesh) {
    ricci_shape shape;
    INIT(shape);
    shape.shape = kind, shape.genus = genus, shape.n = n, shape.m = m;
    shape.a = sizes[0], shape.b = sizes[1], shape.c = sizes[2];
    return ricci_make(&shape, mesh);
}

static inline ricci_status make_sized(uint32_t kind, size_t n, size_t m, double a, double b, double c,
                                      ricci_mesh **mesh) {
    const double sizes[3] = {a, b, c};
    return make(kind, 0, n, m, sizes, mesh);
}

static inline ricci_status make_sphere(size_t n, ricci_mesh **mesh) {
    return make_sized(RICCI_SHAPE_SPHERE, n, 0, 0, 0, 0, mesh);
}
static inline ricci_status make_disk(size_t n, ricci_mesh **mesh) {
    return make_sized(RICCI_SHAPE_DISK, n, 0, 0, 0, 0, mesh);
}
static inline ricci_status make_bolza(size_t level, ricci_mesh **mesh) {
    return make_sized(RICCI_SHAPE_BOLZA, level, 0, 0, 0, 0, mesh);
}
static inline ricci_status make_genus(size_t genus, size_t n, double ratio, ricci_mesh **mesh) {
    const double sizes[3] = {ratio, 0, 0};
    return make(RICCI_SHAPE_GENUS, genus, n, 0, sizes, mesh);
}
static inline ricci_status make_glued(uint32_t kind, size_t genus, ricci_mesh **mesh) {
    const double sizes[3] = {0, 0, 0};
    return make(kind, genus, 0, 0, sizes, mesh);
}

static inline ricci_status change(const ricci_mesh *mesh, uint32_t kind, size_t count, double amount,
                                  uint32_t vertex, ricci_mesh **result) {
    ricci_change_spec spec;
    INIT(spec);
    spec.change = kind, spec.count = count, spec.amount = amount, spec.vertex = vertex, spec.seed = 1;
    return ricci_change(mesh, &spec, result);
}

static inline ricci_status invert(const ricci_mesh *mesh, const double *centre, double radius,
                                  ricci_mesh **result) {
    ricci_change_spec spec;
    INIT(spec);
    spec.change = RICCI_CHANGE_INVERT, spec.amount = radius;
    memcpy(spec.centre, centre, sizeof spec.centre);
    return ricci_change(mesh, &spec, result);
}

/* The flat metric of a closed surface: everywhere flat, or up to vertex 0. */
static inline ricci_metric *flat_of(const ricci_mesh *mesh, uint32_t kind) {
    const uint32_t vertex = 0;
    ricci_metric *metric = NULL, *flat = NULL;
    ricci_target target;
    OK(ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric));
    INIT(target);
    target.kind = kind, target.n = kind == RICCI_TARGET_SINGLE, target.vertices = &vertex;
    OK(ricci_flow(metric, &target, NULL, NULL, &flat));
    ricci_metric_free(metric);
    return flat;
}

#endif
