/* Archives: every type of object is written and read back to the same bytes, by memory and by a file, and
 * what is no archive, or the archive of nothing, is refused. */
#include "samples.h"
#include <ricci/archive.h>
#include <ricci/charts.h>
#include <ricci/circles.h>
#include <ricci/harmonic.h>
#include <ricci/match.h>
#include <ricci/quad_spline.h>
#include <ricci/spline.h>
#include <ricci/structure.h>
#include <ricci/uniformize.h>

static const char *const path = "archive.kept";

static ricci_objects none(void) {
    ricci_objects objects;
    INIT(objects);
    return objects;
}

static void objects_free(ricci_objects *all) {
    ricci_mesh_free(all->mesh), ricci_metric_free(all->metric), ricci_layout_free(all->layout);
    ricci_charts_free(all->charts), ricci_map_free(all->map), ricci_uniform_free(all->uniform);
    ricci_circle_domain_free(all->circle_domain), ricci_forms_free(all->forms);
    ricci_matching_free(all->matching), ricci_structure_free(all->structure);
    ricci_seamless_free(all->seamless), ricci_quads_free(all->quads);
    ricci_quad_layout_free(all->quad_layout), ricci_quad_spline_free(all->quad_spline);
    ricci_spline_free(all->spline), ricci_mesh_free(all->target);
}

static ricci_archive_summary summary_of(const ricci_archive *archive) {
    ricci_archive_summary s;
    OK(ricci_archive_summarise(archive, &s, sizeof s));
    return s;
}

/* The bytes of an archive, n of them. */
static uint8_t *bytes_of(const ricci_archive *archive, size_t *n) {
    *n = summary_of(archive).n_bytes;
    uint8_t *bytes = (uint8_t *)room(*n, 1);
    CHECK(ricci_archive_bytes(archive, bytes, *n - 1) == RICCI_BUFFER_TOO_SMALL);
    OK(ricci_archive_bytes(archive, bytes, *n));
    return bytes;
}

/* Both archives have the same bytes. */
static void same(const ricci_archive *a, const ricci_archive *b) {
    size_t n, m;
    uint8_t *first = bytes_of(a, &n), *second = bytes_of(b, &m);
    CHECK(n == m && memcmp(first, second, n) == 0);
    free(first), free(second);
}

/* The field that is set, cleared of what its object was made from. */
static ricci_objects object_alone(ricci_objects all, const char *kind) {
    if (strcmp(kind, "mesh") != 0) all.mesh = NULL;
    if (strcmp(kind, "charts") == 0) all.layout = NULL;
    return all;
}

/* The object comes back from memory and from a file. */
static void kept(ricci_objects given, const char *kind) {
    ricci_archive *archive, *read, *again;
    ricci_objects back = none();
    size_t n;
    OK(ricci_archive_new(&given, &archive));
    CHECK(strcmp(summary_of(archive).kind, kind) == 0 && summary_of(archive).format == 1);
    uint8_t *bytes = bytes_of(archive, &n);
    OK(ricci_archive_parse(bytes, n, &read));
    same(archive, read);
    ricci_archive_free(read);
    OK(ricci_archive_write(archive, path));
    OK(ricci_archive_read(path, &read));
    OK(ricci_archive_objects(read, &back, sizeof back));
    const ricci_objects alone = object_alone(back, kind);
    OK(ricci_archive_new(&alone, &again));
    same(archive, again);
    objects_free(&back), free(bytes), remove(path);
    ricci_archive_free(archive), ricci_archive_free(read), ricci_archive_free(again);
}

#define KEPT(field, object, kind)                                                                            \
    do {                                                                                                     \
        ricci_objects given = none();                                                                        \
        given.field = (object);                                                                              \
        kept(given, kind);                                                                                   \
    } while (0)

static void metrics_and_layouts(void) {
    ricci_mesh *mesh;
    ricci_layout *layout;
    ricci_charts *charts;
    ricci_map *map;
    OK(make_sized(RICCI_SHAPE_TORUS, 12, 8, 2, 1, 0, &mesh));
    KEPT(mesh, mesh, "mesh");
    ricci_metric *flat = flat_of(mesh, RICCI_TARGET_UNIFORM);
    KEPT(metric, flat, "metric");
    OK(ricci_layout_new(flat, NULL, NULL, &layout));
    KEPT(layout, layout, "layout");
    OK(ricci_charts_new(layout, 0.01, NULL, &charts));
    KEPT(charts, charts, "charts");
    OK(ricci_map_new(flat, NULL, &map));
    KEPT(map, map, "map");
    ricci_map_free(map), ricci_charts_free(charts), ricci_layout_free(layout), ricci_metric_free(flat);
    ricci_mesh_free(mesh);
}

static void shapes_and_maps(void) {
    ricci_mesh *mesh, *ring, *ball;
    ricci_uniform *uniform;
    ricci_circle_domain *circles;
    ricci_forms *forms;
    ricci_matching *matching;
    ricci_structure *structure;
    OK(make_genus(2, 3, 0, &mesh));
    OK(ricci_uniformize(mesh, NULL, NULL, &uniform));
    KEPT(uniform, uniform, "uniformization");
    OK(ricci_forms_new(mesh, NULL, NULL, &forms));
    KEPT(forms, forms, "forms");
    OK(ricci_structure_new(mesh, RICCI_STRUCTURE_HYPERBOLIC, NULL, NULL, &structure));
    KEPT(structure, structure, "structure");
    OK(make_sized(RICCI_SHAPE_ANNULUS, 2, 24, 0.5, 1, 0, &ring));
    OK(ricci_circle_domain_new(ring, NULL, NULL, &circles));
    KEPT(circle_domain, circles, "circle domain");
    OK(make_sphere(3, &ball));
    OK(ricci_match(ball, ball, NULL, NULL, &matching));
    KEPT(matching, matching, "matching");
    ricci_matching_free(matching), ricci_circle_domain_free(circles), ricci_structure_free(structure);
    ricci_forms_free(forms), ricci_uniform_free(uniform);
    ricci_mesh_free(mesh), ricci_mesh_free(ring), ricci_mesh_free(ball);
}

static void quads_and_splines(void) {
    ricci_mesh *mesh, *disk;
    ricci_seamless *seamless;
    ricci_quads *quads;
    ricci_quad_layout *layout;
    ricci_quad_spline *surface;
    ricci_spline *spline;
    ricci_quad_spline_options options;
    ricci_spline_spec spec;
    INIT(options);
    INIT(spec);
    options.most_spans = 2;
    spec.degree = 2;
    OK(make_sized(RICCI_SHAPE_TORUS, 16, 8, 2, 1, 0, &mesh));
    OK(ricci_seamless_new(mesh, NULL, NULL, &seamless));
    KEPT(seamless, seamless, "seamless metric");
    OK(ricci_quads_new(seamless, NULL, NULL, &quads));
    KEPT(quads, quads, "quad mesh");
    OK(ricci_quad_layout_new(seamless, NULL, NULL, &layout));
    KEPT(quad_layout, layout, "quad layout");
    OK(ricci_quad_spline_fit(seamless, layout, &options, NULL, &surface));
    KEPT(quad_spline, surface, "quad spline");
    OK(make_disk(2, &disk));
    OK(ricci_spline_new(disk, &spec, &spline));
    KEPT(spline, spline, "spline");
    ricci_spline_free(spline), ricci_quad_spline_free(surface), ricci_quad_layout_free(layout);
    ricci_quads_free(quads), ricci_seamless_free(seamless), ricci_mesh_free(mesh), ricci_mesh_free(disk);
}

/* The files of tests/archives are written to the same bytes again. */
static void files_keep_their_bytes(const char *folder) {
    static const char *const names[] = {"mesh",        "metric",         "layout",        "charts",
                                        "map",         "uniformization", "circle-domain", "forms",
                                        "matching",    "structure",      "seamless",      "quads",
                                        "quad-layout", "quad-spline",    "spline"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char file[1024];
        ricci_archive *archive, *again;
        ricci_objects back = none();
        snprintf(file, sizeof file, "%s/%s.ricci", folder, names[k]);
        OK(ricci_archive_read(file, &archive));
        OK(ricci_archive_objects(archive, &back, sizeof back));
        const ricci_objects alone = object_alone(back, summary_of(archive).kind);
        OK(ricci_archive_new(&alone, &again));
        same(archive, again);
        objects_free(&back), ricci_archive_free(archive), ricci_archive_free(again);
    }
}

/* A matching says again that its source is a mirror image. */
static void mirror_images_are_remembered(void) {
    ricci_mesh *ball;
    ricci_objects given = none(), back = none();
    ricci_archive *archive;
    OK(make_sphere(2, &ball));
    OK(ricci_match(ball, ball, NULL, NULL, &given.matching));
    given.mirrored = 1;
    OK(ricci_archive_new(&given, &archive));
    OK(ricci_archive_objects(archive, &back, sizeof back));
    CHECK(back.mirrored == 1 && back.mesh && back.target && back.matching);
    objects_free(&back), ricci_archive_free(archive), ricci_matching_free(given.matching);
    ricci_mesh_free(ball);
}

static void others_are_refused(void) {
    ricci_objects objects = none();
    ricci_archive *archive = NULL, *other = NULL;
    ricci_mesh *mesh, *second;
    size_t n;
    FAILS(ricci_archive_new(&objects, &archive), RICCI_ARGUMENT, "no object");
    CHECK(ricci_archive_new(&objects, NULL) == RICCI_NULL_POINTER);
    OK(make_disk(2, &mesh));
    objects.mesh = mesh;
    objects.metric = flat_of(mesh, RICCI_TARGET_OUTER);
    FAILS(ricci_archive_new(&objects, &archive), RICCI_ARGUMENT, "2 objects");
    objects.mesh = NULL;
    OK(ricci_archive_new(&objects, &archive));
    uint8_t *bytes = bytes_of(archive, &n);
    FAILS(ricci_archive_parse(bytes, n - 1, &other), RICCI_PARSE, "cut off");
    FAILS(ricci_archive_parse(bytes, 5, &other), RICCI_PARSE, "cut off");
    CHECK(ricci_archive_parse(NULL, n, &other) == RICCI_NULL_POINTER);
    bytes[n / 2] ^= 1;
    FAILS(ricci_archive_parse(bytes, n, &other), RICCI_PARSE, "damaged");
    bytes[0] ^= 1;
    FAILS(ricci_archive_parse(bytes, n, &other), RICCI_UNKNOWN_FORMAT, "no archive");
    FAILS(ricci_archive_read("there-is-no-such.file", &other), RICCI_IO, "there-is-no-such.file");
    FAILS(ricci_archive_write(archive, "no-such-folder/kept"), RICCI_IO, "no-such-folder");
    /* A program that was compiled for a library without metrics has no field for one. */
    second = objects.mesh;
    CHECK(ricci_archive_objects(archive, &objects, 2 * sizeof(size_t)) == RICCI_STRUCT_SIZE);
    CHECK(ricci_archive_objects(archive, NULL, sizeof objects) == RICCI_NULL_POINTER);
    CHECK(objects.mesh == second && other == NULL);
    free(bytes), ricci_archive_free(archive), ricci_metric_free(objects.metric), ricci_mesh_free(mesh);
}

int main(int argc, char **argv) {
    if (argc > 1) files_keep_their_bytes(argv[1]);
    metrics_and_layouts();
    shapes_and_maps();
    quads_and_splines();
    mirror_images_are_remembered();
    others_are_refused();
    return 0;
}
