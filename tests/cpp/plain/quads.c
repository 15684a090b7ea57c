/* Quad meshes and layouts: counts and topology of our own from the arrays, places on the surface, refusals.
 */
#include "arrays.h"
#include "samples.h"
#include <ricci/quads.h>

/* With the cones of the field, or with none. */
static ricci_seamless *seamless_of(const ricci_mesh *mesh, uint32_t cones) {
    ricci_seamless *seamless = NULL;
    ricci_seamless_options options;
    ricci_seamless_summary s;
    INIT(options);
    options.cones = cones;
    OK(ricci_seamless_new(mesh, &options, NULL, &seamless));
    OK(ricci_seamless_summarise(seamless, &s, sizeof s));
    CHECK(s.converged);
    return seamless;
}

/* Edges from either side: of each there is one more from the other, unless it is on the boundary. */
static size_t borders(const uint32_t *faces, size_t n_quads) {
    size_t alone = 0;
    for (size_t a = 0; a < 4 * n_quads; a++) {
        const uint32_t tip = faces[a - a % 4 + (a + 1) % 4];
        size_t twins = 0;
        for (size_t b = 0; b < 4 * n_quads; b++)
            twins += faces[b] == tip && faces[b - b % 4 + (b + 1) % 4] == faces[a];
        CHECK(twins <= 1 && tip != faces[a]);
        alone += twins == 0;
    }
    return alone;
}

/* The sum of 4 - valence inside and 2 - valence on the boundary is 4 times the Euler characteristic, where
 * the boundary has as many vertices as edges. */
static void quads_are_right(const ricci_mesh *mesh, const ricci_quads *quads, int euler) {
    arrays given = arrays_of(mesh, 1);
    ricci_quads_summary s;
    OK(ricci_quads_summarise(quads, &s, sizeof s));
    CHECK(s.size == sizeof s && s.euler == euler && s.n_bad_edges == 0 && s.n_bad_vertices == 0);
    CHECK(s.cost >= 0 && s.edge > 0 && s.edge_mean > 0 && s.angle_mean <= s.angle_max && s.angle_max < pi);
    uint32_t *faces = (uint32_t *)room(4 * s.n_quads, sizeof *faces);
    uint32_t *on = (uint32_t *)room(s.n_vertices, sizeof *on);
    uint32_t *rectangles = (uint32_t *)room(s.n_quads, sizeof *rectangles);
    uint32_t *creases = (uint32_t *)room(2 * s.n_creases, sizeof *creases);
    double *weights = (double *)room(3 * s.n_vertices, sizeof *weights);
    double *positions = (double *)room(3 * s.n_vertices, sizeof *positions);
    OK(ricci_quads_faces(quads, faces, 4 * s.n_quads));
    OK(ricci_quads_places(quads, on, s.n_vertices, weights, 3 * s.n_vertices));
    OK(ricci_quads_positions(quads, positions, 3 * s.n_vertices));
    OK(ricci_quads_rectangles(quads, rectangles, s.n_quads));
    OK(ricci_quads_creases(quads, creases, 2 * s.n_creases));
    const size_t n_borders = borders(faces, s.n_quads);
    CHECK(n_borders == s.n_creases);
    long excess = 4 * (long)s.n_vertices - 2 * (long)n_borders - 4 * (long)s.n_quads;
    CHECK(excess == 4 * euler);
    for (size_t q = 0; q < s.n_quads; q++) CHECK(rectangles[q] < s.n_rectangles);
    for (size_t v = 0; v < s.n_vertices; v++)
        for (int i = 0; i < 3; i++) {
            double at = 0, sum = 0;
            for (int k = 0; k < 3; k++) {
                const uint32_t corner = given.faces[3 * (size_t)on[v] + k];
                at += weights[3 * v + k] * given.positions[3 * (size_t)corner + i];
                sum += weights[3 * v + k];
                CHECK(weights[3 * v + k] >= 0);
            }
            CHECK(fabs(at - positions[3 * v + i]) < 1e-12 && fabs(sum - 1) < 1e-9);
        }
    CHECK(ricci_quads_faces(quads, faces, 4 * s.n_quads - 1) == RICCI_BUFFER_TOO_SMALL);
    CHECK(ricci_quads_places(quads, on, s.n_vertices - 1, weights, 3 * s.n_vertices) ==
          RICCI_BUFFER_TOO_SMALL);
    CHECK(ricci_quads_places(quads, on, s.n_vertices, weights, 3) == RICCI_BUFFER_TOO_SMALL);
    CHECK(ricci_quads_positions(quads, NULL, 3 * s.n_vertices) == RICCI_NULL_POINTER);
    free(faces), free(on), free(rectangles), free(creases), free(weights), free(positions);
    arrays_free(&given);
}

static void sizes_are_met(void) {
    ricci_mesh *mesh = NULL;
    ricci_quads *quads = NULL, *same = NULL;
    ricci_quads_summary s, t;
    ricci_quads_options options;
    OK(make_sized(RICCI_SHAPE_TORUS, 16, 10, 2, 1, 0, &mesh));
    ricci_seamless *seamless = seamless_of(mesh, RICCI_SEAMLESS_VALENCES);
    INIT(options);
    options.sizing = RICCI_QUADS_NUMBER;
    options.n_quads = 250;
    OK(ricci_quads_new(seamless, &options, NULL, &quads));
    OK(ricci_quads_summarise(quads, &s, sizeof s));
    CHECK(s.n_quads > 200 && s.n_quads < 300 && s.n_quads == s.n_vertices && s.n_irregular == 0);
    CHECK(s.n_creases == 0 && s.n_collapsed == 0 && s.n_off_axis == 0);
    quads_are_right(mesh, quads, 0);
    /* The edge that was found, asked for, and with another number of threads. */
    options.sizing = RICCI_QUADS_EDGE;
    options.edge = s.edge;
    options.threads = 2;
    OK(ricci_quads_new(seamless, &options, NULL, &same));
    OK(ricci_quads_summarise(same, &t, sizeof t));
    CHECK(memcmp(&s, &t, sizeof s) == 0);
    ricci_quads_free(same);
    ricci_quads_free(quads);
    options.sizing = RICCI_QUADS_COARSE;
    OK(ricci_quads_new(seamless, &options, NULL, &quads));
    OK(ricci_quads_summarise(quads, &t, sizeof t));
    CHECK(t.n_quads < s.n_quads);
    ricci_quads_free(quads);
    ricci_seamless_free(seamless);
    ricci_mesh_free(mesh);
}

static void boundaries_are_creases(void) {
    ricci_mesh *mesh = NULL;
    ricci_quads *quads = NULL;
    ricci_quads_options options;
    ricci_quads_summary s;
    OK(make_disk(4, &mesh));
    ricci_seamless *seamless = seamless_of(mesh, RICCI_SEAMLESS_FIELD);
    INIT(options);
    options.sizing = RICCI_QUADS_NUMBER;
    options.n_quads = 100;
    OK(ricci_quads_new(seamless, &options, NULL, &quads));
    ricci_seamless_free(seamless);
    quads_are_right(mesh, quads, 1);
    OK(ricci_quads_summarise(quads, &s, sizeof s));
    CHECK(s.n_creases > 8);
    ricci_quads_free(quads);
    ricci_mesh_free(mesh);
}

/* Patches are rectangles of whole sides, which together are the surface. */
static void layouts_are_rectangles(void) {
    ricci_mesh *mesh = NULL;
    ricci_quads *quads = NULL;
    ricci_quad_layout *layout = NULL;
    ricci_quad_layout_summary s;
    OK(make_genus(2, 4, 0, &mesh));
    ricci_seamless *seamless = seamless_of(mesh, RICCI_SEAMLESS_FIELD);
    OK(ricci_quad_layout_new(seamless, NULL, NULL, &layout));
    ricci_seamless_free(seamless);
    OK(ricci_quad_layout_summarise(layout, &s, sizeof s));
    CHECK(s.n_nodes + s.n_patches + 2 == s.n_arcs && s.n_quads == s.n_units * s.n_parts * s.n_parts);
    uint32_t *nodes = (uint32_t *)room(3 * s.n_nodes, sizeof *nodes);
    uint32_t *arcs = (uint32_t *)room(4 * s.n_arcs, sizeof *arcs);
    uint32_t *sizes = (uint32_t *)room(2 * s.n_patches, sizeof *sizes);
    uint32_t *patches = (uint32_t *)room(s.n_quads, sizeof *patches);
    size_t *starts = (size_t *)room(4 * s.n_patches + 1, sizeof *starts);
    size_t *arc_starts = (size_t *)room(s.n_arcs + 1, sizeof *arc_starts);
    OK(ricci_quad_layout_nodes(layout, nodes, 3 * s.n_nodes));
    OK(ricci_quad_layout_arcs(layout, arcs, 4 * s.n_arcs));
    OK(ricci_quad_layout_sizes(layout, sizes, 2 * s.n_patches));
    OK(ricci_quad_layout_patches(layout, patches, s.n_quads));
    size_t total = 0, units = 0;
    for (size_t a = 0; a < s.n_arcs; a++) total += s.n_parts * arcs[4 * a + 2] + 1;
    uint32_t *along = (uint32_t *)room(total, sizeof *along);
    int32_t *sides = (int32_t *)room(2 * s.n_arcs, sizeof *sides);
    OK(ricci_quad_layout_arc_vertices(layout, along, total, arc_starts, s.n_arcs + 1));
    /* On a closed surface each arc is in two sides. */
    OK(ricci_quad_layout_sides(layout, sides, 2 * s.n_arcs, starts, 4 * s.n_patches + 1));
    CHECK(ricci_quad_layout_sides(layout, sides, 2 * s.n_arcs - 1, starts, 4 * s.n_patches + 1) ==
          RICCI_BUFFER_TOO_SMALL);
    CHECK(arc_starts[s.n_arcs] == total && starts[4 * s.n_patches] == 2 * s.n_arcs);
    for (size_t a = 0; a < s.n_arcs; a++) {
        CHECK(along[arc_starts[a]] == nodes[3 * (size_t)arcs[4 * a]]);
        CHECK(along[arc_starts[a + 1] - 1] == nodes[3 * (size_t)arcs[4 * a + 1]]);
        CHECK(arcs[4 * a + 3] == 0);
    }
    int excess = 0;
    for (size_t k = 0; k < s.n_nodes; k++) excess += 4 - (int)nodes[3 * k + 1];
    CHECK(excess == -8);
    for (size_t side = 0; side < 4 * s.n_patches; side++) {
        uint32_t length = 0;
        for (size_t k = starts[side]; k < starts[side + 1]; k++)
            length += arcs[4 * (size_t)(abs(sides[k]) - 1) + 2];
        CHECK(length > 0 && length == sizes[2 * (side / 4) + side % 2]);
    }
    size_t *count = (size_t *)room(s.n_patches, sizeof *count);
    for (size_t p = 0; p < s.n_patches; p++) count[p] = 0;
    for (size_t q = 0; q < s.n_quads; q++) count[patches[q]]++;
    for (size_t p = 0; p < s.n_patches; p++) {
        const size_t n = (size_t)sizes[2 * p] * sizes[2 * p + 1];
        CHECK(count[p] == n * s.n_parts * s.n_parts);
        units += n;
    }
    CHECK(units == s.n_units);
    OK(ricci_quad_layout_quads(layout, &quads));
    ricci_quad_layout_free(layout);
    ricci_quads_summary q;
    OK(ricci_quads_summarise(quads, &q, sizeof q));
    CHECK(q.n_quads == s.n_quads && q.n_vertices == s.n_vertices && q.euler == -2);
    ricci_quads_free(quads);
    ricci_mesh_free(mesh);
    free(nodes), free(arcs), free(sizes), free(patches), free(starts), free(arc_starts), free(along);
    free(sides), free(count);
}

static void what_cannot_be_is_refused(void) {
    ricci_mesh *mesh = NULL;
    ricci_quads *quads = NULL;
    ricci_quad_layout *layout = NULL;
    ricci_quads_options options;
    ricci_quads_summary s;
    double position;
    OK(make_sized(RICCI_SHAPE_TORUS, 8, 6, 2, 1, 0, &mesh));
    ricci_seamless *seamless = seamless_of(mesh, RICCI_SEAMLESS_FIELD);
    INIT(options);
    CHECK(ricci_quads_new(NULL, NULL, NULL, &quads) == RICCI_NULL_POINTER);
    CHECK(ricci_quads_new(seamless, NULL, NULL, NULL) == RICCI_NULL_POINTER);
    CHECK(ricci_quad_layout_new(NULL, NULL, NULL, &layout) == RICCI_NULL_POINTER);
    options.sizing = 4;
    CHECK(ricci_quads_new(seamless, &options, NULL, &quads) == RICCI_ARGUMENT);
    options.sizing = RICCI_QUADS_NUMBER;
    CHECK(ricci_quads_new(seamless, &options, NULL, &quads) == RICCI_ARGUMENT);
    options.n_quads = SIZE_MAX;
    CHECK(ricci_quads_new(seamless, &options, NULL, &quads) == RICCI_TOO_LARGE);
    options.sizing = RICCI_QUADS_EDGE;
    const double edges[] = {0, -1, NAN, INFINITY};
    for (int k = 0; k < 4; k++) {
        options.edge = edges[k];
        CHECK(ricci_quad_layout_new(seamless, &options, NULL, &layout) == RICCI_ARGUMENT);
    }
    options.edge = 1e-200;
    CHECK(ricci_quads_new(seamless, &options, NULL, &quads) == RICCI_TOO_LARGE);
    options.reserved = 1;
    CHECK(ricci_quads_new(seamless, &options, NULL, &quads) == RICCI_STRUCT_SIZE);
    ricci_control *control = NULL;
    OK(ricci_control_new(&control));
    OK(ricci_control_cancel(control));
    CHECK(ricci_quads_new(seamless, NULL, control, &quads) == RICCI_CANCELLED);
    ricci_control_free(control);
    CHECK(quads == NULL && layout == NULL);
    ricci_seamless_free(seamless);
    ricci_mesh_free(mesh);
    ricci_quads_free(NULL);
    ricci_quad_layout_free(NULL);
    /* A metric that is far from its target. */
    const int32_t turns[4] = {9, -9, 9, -9};
    ricci_seamless_options far_off;
    INIT(far_off);
    far_off.quarter_turns = turns;
    far_off.n_quarter_turns = 4;
    far_off.max_iterations = 1;
    OK(make_genus(2, 4, 0, &mesh));
    OK(ricci_seamless_new(mesh, &far_off, NULL, &seamless));
    CHECK(ricci_quads_new(seamless, NULL, NULL, &quads) == RICCI_LAYOUT && quads == NULL);
    CHECK(ricci_quad_layout_new(seamless, NULL, NULL, &layout) == RICCI_LAYOUT && layout == NULL);
    ricci_seamless_free(seamless);
    ricci_mesh_free(mesh);
    /* A surface without positions has places and no shape. */
    OK(make_bolza(2, &mesh));
    seamless = seamless_of(mesh, RICCI_SEAMLESS_FIELD);
    options.reserved = 0;
    options.sizing = RICCI_QUADS_COARSE;
    OK(ricci_quads_new(seamless, &options, NULL, &quads));
    OK(ricci_quads_summarise(quads, &s, sizeof s));
    CHECK(isnan(s.angle_mean) && isnan(s.edge_deviation) && s.edge > 0 && s.euler == -2);
    CHECK(ricci_quads_positions(quads, &position, 1) == RICCI_ARGUMENT);
    ricci_quads_free(quads);
    ricci_seamless_free(seamless);
    ricci_mesh_free(mesh);
}

int main(void) {
    sizes_are_met();
    boundaries_are_creases();
    layouts_are_rectangles();
    what_cannot_be_is_refused();
    return 0;
}
