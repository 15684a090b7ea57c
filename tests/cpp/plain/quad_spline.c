/* Splines over layouts of four-sided patches: evaluated from their poles and knots by our own recurrence,
 * joined along their arcs, nearest places, closed meshes, matrices, files, refusals. */
#include "samples.h"
#include <math.h>
#include <ricci/quad_spline.h>

static const double pi = 3.14159265358979323846;

static ricci_seamless *seamless_of(const ricci_mesh *mesh) {
    ricci_seamless *seamless = NULL;
    OK(ricci_seamless_new(mesh, NULL, NULL, &seamless));
    return seamless;
}

static ricci_quad_spline *fitted(const ricci_seamless *seamless, const ricci_quad_layout *layout,
                                 uint32_t most_spans, size_t threads) {
    ricci_quad_spline *spline = NULL;
    ricci_quad_spline_options options;
    INIT(options);
    options.most_spans = most_spans, options.threads = threads;
    OK(ricci_quad_spline_fit(seamless, layout, &options, NULL, &spline));
    return spline;
}

static ricci_quad_spline_summary figures_of(const ricci_quad_spline *spline) {
    ricci_quad_spline_summary s;
    OK(ricci_quad_spline_summarise(spline, &s, sizeof s));
    CHECK(s.size == sizeof s);
    return s;
}

static ricci_quad_patch patch_of(const ricci_quad_spline *spline, size_t number) {
    ricci_quad_patch patch;
    OK(ricci_quad_spline_patch(spline, number, &patch, sizeof patch));
    CHECK(patch.size == sizeof patch && !patch.periodic[0] && !patch.periodic[1]);
    return patch;
}

static ricci_quad_arc arc_of(const ricci_quad_spline *spline, size_t number) {
    ricci_quad_arc arc;
    OK(ricci_quad_spline_arc(spline, number, &arc, sizeof arc));
    CHECK(arc.size == sizeof arc && arc.length > 0);
    return arc;
}

/* The knots of a patch along u or v, each as often as it occurs; their number. */
static size_t all_knots(const ricci_quad_spline *spline, size_t number, uint32_t along, double *all) {
    const ricci_quad_patch patch = patch_of(spline, number);
    const size_t n = patch.n_knots[along];
    double *knots = (double *)room(n, sizeof *knots);
    uint32_t *times = (uint32_t *)room(n, sizeof *times);
    size_t count = 0;
    OK(ricci_quad_spline_knots(spline, number, along, knots, n, times, n));
    CHECK(knots[0] == 0 && knots[n - 1] == 1);
    CHECK(times[0] == patch.degrees[along] + 1 && times[n - 1] == times[0]);
    for (size_t k = 0; k < n; k++) {
        CHECK(k == 0 || knots[k] > knots[k - 1]);
        for (uint32_t i = 0; i < times[k]; i++) all[count++] = knots[k];
    }
    CHECK(count == patch.n_poles[along] + patch.degrees[along] + 1);
    free(knots), free(times);
    return count;
}

/* The basis function of a number by the definition. */
static double basis(const double *knots, size_t i, size_t degree, double x) {
    if (degree == 0) return knots[i] <= x && x < knots[i + 1] ? 1 : 0;
    const double rise = knots[i + degree] - knots[i], fall = knots[i + degree + 1] - knots[i + 1];
    double sum = 0;
    if (rise > 0) sum += (x - knots[i]) / rise * basis(knots, i, degree - 1, x);
    if (fall > 0) sum += (knots[i + degree + 1] - x) / fall * basis(knots, i + 1, degree - 1, x);
    return sum;
}

/* The point of a patch by its poles and knots alone. */
static void patches_are_their_poles(const ricci_quad_spline *spline) {
    const ricci_quad_spline_summary s = figures_of(spline);
    double knots[2][256];
    for (size_t p = 0; p < s.n_patches; p++) {
        const ricci_quad_patch patch = patch_of(spline, p);
        CHECK(all_knots(spline, p, RICCI_ALONG_U, knots[0]) < 256);
        CHECK(all_knots(spline, p, RICCI_ALONG_V, knots[1]) < 256);
        const size_t m = patch.n_poles[0], n = patch.n_poles[1];
        double *poles = (double *)room(3 * m * n, sizeof *poles);
        OK(ricci_quad_spline_poles(spline, p, poles, 3 * m * n));
        CHECK(ricci_quad_spline_poles(spline, p, poles, 3 * m * n - 1) == RICCI_BUFFER_TOO_SMALL);
        const uint32_t on[2] = {(uint32_t)p, (uint32_t)p};
        const double at[4] = {0.37, 0.81, 0.6, 0.05};
        double values[60], sum[3] = {0, 0, 0};
        ricci_spline_places places;
        INIT(places);
        places.patches = on, places.parameters = at, places.n = 2;
        OK(ricci_quad_spline_evaluate(spline, &places, RICCI_QUAD_SPLINE_THIRD, NULL, values, 60));
        for (size_t i = 0; i < m; i++)
            for (size_t j = 0; j < n; j++) {
                const double w =
                    basis(knots[0], i, patch.degrees[0], at[0]) * basis(knots[1], j, patch.degrees[1], at[1]);
                for (size_t x = 0; x < 3; x++) sum[x] += w * poles[3 * (i * n + j) + x];
            }
        for (int x = 0; x < 3; x++) CHECK(fabs(sum[x] - values[x]) < 1e-12);
        /* Along a line of patches the third derivative by u is that of its second by differences. */
        double less[18], more[18];
        const double before[2] = {at[0] - 1e-5, at[1]}, behind[2] = {at[0] + 1e-5, at[1]};
        places.n = 1, places.parameters = before;
        OK(ricci_quad_spline_evaluate(spline, &places, RICCI_QUAD_SPLINE_SECOND, NULL, less, 18));
        places.parameters = behind;
        OK(ricci_quad_spline_evaluate(spline, &places, RICCI_QUAD_SPLINE_SECOND, NULL, more, 18));
        for (int x = 0; x < 3; x++)
            CHECK(fabs((more[9 + x] - less[9 + x]) / 2e-5 - values[18 + x]) < 1e-3 * s.diagonal);
        free(poles);
    }
}

/* The place among the poles of a patch of pole i along a side, in the direction around the patch. */
static size_t along_side(const ricci_quad_patch *patch, size_t side, size_t i) {
    const size_t m = patch->n_poles[0], n = patch->n_poles[1];
    const size_t at[4][2] = {{i, 0}, {m - 1, i}, {m - 1 - i, n - 1}, {0, n - 1 - i}};
    return at[side % 4][0] * n + at[side % 4][1];
}

/* Neighbours name each other, and have the numbers and poles of their arc in common. Returns open sides. */
static size_t patches_join(const ricci_quad_spline *spline) {
    const ricci_quad_spline_summary s = figures_of(spline);
    size_t open = 0;
    for (size_t p = 0; p < s.n_patches; p++) {
        const ricci_quad_patch patch = patch_of(spline, p);
        const size_t count = patch.n_poles[0] * patch.n_poles[1];
        double *poles = (double *)room(3 * count, sizeof *poles);
        uint32_t *controls = (uint32_t *)room(count, sizeof *controls);
        OK(ricci_quad_spline_poles(spline, p, poles, 3 * count));
        OK(ricci_quad_spline_controls(spline, p, controls, count));
        for (size_t k = 0; k < count; k++) CHECK(controls[k] < s.n_control_points);
        for (size_t side = 0; side < 4; side++) {
            const ricci_quad_arc arc = arc_of(spline, patch.arcs[side]);
            const int own = patch.reversed[side] ? 1 : 0;
            CHECK(arc.patches[own] == (int64_t)p && arc.sides[own] == (int64_t)side);
            CHECK(arc.patches[1 - own] == patch.neighbours[side]);
            CHECK(arc.sides[1 - own] == patch.neighbour_sides[side]);
            CHECK(arc.n_poles == patch.n_poles[side % 2] && arc.n_knots == patch.n_knots[side % 2]);
            CHECK(arc.ends[0] < s.n_nodes && arc.ends[1] < s.n_nodes);
            double *curve = (double *)room(3 * arc.n_poles, sizeof *curve);
            OK(ricci_quad_spline_arc_poles(spline, patch.arcs[side], curve, 3 * arc.n_poles));
            for (size_t i = 0; i < arc.n_poles; i++) {
                const size_t k = patch.reversed[side] ? arc.n_poles - 1 - i : i;
                CHECK(memcmp(curve + 3 * k, poles + 3 * along_side(&patch, side, i), 24) == 0);
            }
            free(curve);
            if (patch.neighbours[side] < 0) {
                open++;
                continue;
            }
            const ricci_quad_patch next = patch_of(spline, (size_t)patch.neighbours[side]);
            const size_t back = (size_t)patch.neighbour_sides[side];
            CHECK(next.neighbours[back] == (int64_t)p && next.neighbour_sides[back] == (int64_t)side);
            CHECK(next.creases[back] == patch.creases[side] && next.arcs[back] == patch.arcs[side]);
            CHECK(next.reversed[back] != patch.reversed[side]);
        }
        free(poles), free(controls);
    }
    return open;
}

/* Rows of the matrices add up to 1. */
static void matrices_are_affine(const ricci_quad_spline *spline) {
    const ricci_quad_spline_summary s = figures_of(spline);
    uint32_t *columns = (uint32_t *)room(s.n_entries, sizeof *columns);
    double *values = (double *)room(s.n_entries, sizeof *values);
    size_t *starts = (size_t *)room(s.n_control_points + 1, sizeof *starts);
    OK(ricci_quad_spline_extraction(spline, columns, s.n_entries, values, s.n_entries, starts,
                                    s.n_control_points + 1));
    CHECK(starts[0] == 0 && starts[s.n_control_points] == s.n_entries && s.n_free < s.n_control_points);
    for (size_t row = 0; row < s.n_control_points; row++) {
        double sum = 0;
        for (size_t k = starts[row]; k < starts[row + 1]; k++) {
            CHECK(columns[k] < s.n_free);
            sum += values[k];
        }
        CHECK(fabs(sum - 1) < 1e-9);
    }
    CHECK(ricci_quad_spline_extraction(spline, columns, s.n_entries - 1, values, s.n_entries, starts,
                                       s.n_control_points + 1) == RICCI_BUFFER_TOO_SMALL);
    free(columns), free(values), free(starts);
    for (uint32_t along = RICCI_ALONG_U; along <= RICCI_ALONG_V; along++) {
        const size_t spans = patch_of(spline, 0).n_knots[along] - 1;
        double *weights = (double *)room(36 * spans, sizeof *weights);
        OK(ricci_quad_spline_bezier(spline, 0, along, weights, 36 * spans));
        for (size_t row = 0; row < 6 * spans; row++) {
            double sum = 0;
            for (size_t k = 0; k < 6; k++) sum += weights[6 * row + k];
            CHECK(fabs(sum - 1) < 1e-12);
        }
        free(weights);
    }
}

/* Points off the surface along its normal have their foot for the nearest place. */
static void nearest_places_are_feet(const ricci_quad_spline *spline) {
    const ricci_quad_spline_summary s = figures_of(spline);
    const size_t n = 4 * s.n_patches;
    uint32_t *on = (uint32_t *)room(n, sizeof *on), *found = (uint32_t *)room(n, sizeof *found);
    double *at = (double *)room(2 * n, sizeof *at), *shapes = (double *)room(5 * n, sizeof *shapes);
    double *points = (double *)room(3 * n, sizeof *points), *values = (double *)room(6 * n, sizeof *values);
    for (size_t k = 0; k < n; k++) {
        on[k] = (uint32_t)(k / 4);
        at[2 * k] = 0.2 + 0.6 * (double)(k % 2), at[2 * k + 1] = 0.2 + 0.6 * (double)(k % 4 / 2);
    }
    ricci_spline_places places;
    INIT(places);
    places.patches = on, places.parameters = at, places.n = n;
    OK(ricci_quad_spline_evaluate(spline, &places, RICCI_QUAD_SPLINE_POINT, NULL, points, 3 * n));
    OK(ricci_quad_spline_evaluate(spline, &places, RICCI_QUAD_SPLINE_SHAPE, NULL, shapes, 5 * n));
    for (size_t k = 0; k < 3 * n; k++) points[k] += 0.1 * shapes[5 * (k / 3) + k % 3];
    OK(ricci_quad_spline_closest(spline, points, n, NULL, found, values, 6 * n));
    for (size_t k = 0; k < n; k++) {
        CHECK(found[k] == on[k] && fabs(values[6 * k + 5] - 0.1) < 1e-9);
        CHECK(hypot(values[6 * k] - at[2 * k], values[6 * k + 1] - at[2 * k + 1]) < 1e-6);
    }
    CHECK(ricci_quad_spline_closest(spline, points, n, NULL, found, values, 6 * n - 1) ==
          RICCI_BUFFER_TOO_SMALL);
    free(on), free(found), free(at), free(shapes), free(points), free(values);
}

static double volume(const ricci_mesh *mesh) {
    ricci_mesh_summary s;
    OK(ricci_mesh_summarise(mesh, &s, sizeof s));
    double *x = (double *)room(3 * s.n_vertices, sizeof *x), sum = 0;
    uint32_t *faces = (uint32_t *)room(3 * s.n_faces, sizeof *faces);
    OK(ricci_mesh_values(mesh, RICCI_POSITIONS, x, 3 * s.n_vertices));
    OK(ricci_mesh_faces(mesh, faces, 3 * s.n_faces));
    for (size_t f = 0; f < s.n_faces; f++) {
        const double *a = x + 3 * (size_t)faces[3 * f], *b = x + 3 * (size_t)faces[3 * f + 1],
                     *c = x + 3 * (size_t)faces[3 * f + 2];
        sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    free(x), free(faces);
    return sum / 6;
}

/* Meshes are closed, fill the ellipsoid, and lie on the patches that they were made of. */
static void meshes_are_closed(const ricci_quad_spline *spline, double exact) {
    const ricci_quad_spline_summary s = figures_of(spline);
    ricci_mesh *mesh = NULL, *finer = NULL;
    ricci_mesh_summary t;
    OK(ricci_quad_spline_tessellate(spline, 6, 0, NULL, &mesh));
    OK(ricci_mesh_summarise(mesh, &t, sizeof t));
    CHECK(t.n_faces == 72 * s.n_patches && t.n_boundary_loops == 0 && t.euler == 2);
    const double coarse = volume(mesh);
    uint32_t *on = (uint32_t *)room(t.n_faces, sizeof *on);
    OK(ricci_quad_spline_patch_of_faces(spline, mesh, NULL, on, t.n_faces));
    for (size_t f = 0; f < t.n_faces; f++) CHECK(on[f] == f / 72);
    CHECK(ricci_quad_spline_patch_of_faces(spline, mesh, NULL, on, 1) == RICCI_BUFFER_TOO_SMALL);
    free(on);
    OK(ricci_quad_spline_tessellate(spline, 0, 1e-3, NULL, &finer));
    const double fine = volume(finer);
    CHECK(fabs(fine / exact - 1) < 5e-3 && fabs(coarse / exact - 1) < 5e-2 && coarse < fine);
    ricci_mesh_free(finer);
    finer = NULL;
    OK(ricci_quad_spline_tessellate(spline, 0, 0, NULL, &finer));
    ricci_mesh_free(finer);
    ricci_mesh_free(mesh);
}

static size_t count_in_file(const char *path, const char *word) {
    FILE *file = fopen(path, "rb");
    CHECK(file && fseek(file, 0, SEEK_END) == 0);
    const long n = ftell(file);
    rewind(file);
    char *text = (char *)room((size_t)n + 1, 1);
    CHECK(fread(text, 1, (size_t)n, file) == (size_t)n);
    fclose(file);
    size_t count = 0;
    for (const char *at = text; (at = strstr(at, word)) != NULL; at += strlen(word)) count++;
    free(text);
    return count;
}

static void an_ellipsoid_is_met(void) {
    ricci_mesh *mesh = NULL;
    ricci_quad_layout *layout = NULL;
    OK(make_sized(RICCI_SHAPE_ELLIPSOID, 8, 0, 1.6, 1.2, 1, &mesh));
    ricci_seamless *seamless = seamless_of(mesh);
    ricci_mesh_free(mesh);
    OK(ricci_quad_layout_new(seamless, NULL, NULL, &layout));
    ricci_quad_spline *spline = fitted(seamless, NULL, 2, 1), *same = fitted(seamless, layout, 2, 2);
    ricci_quad_layout_free(layout);
    ricci_seamless_free(seamless);
    const ricci_quad_spline_summary s = figures_of(spline), t = figures_of(same);
    CHECK(memcmp(&s, &t, sizeof s) == 0);
    ricci_quad_spline_free(same);
    CHECK(s.n_patches + s.n_nodes == s.n_arcs + 2 && s.degree == 5 && s.most_spans <= 2);
    CHECK(s.rms <= s.max && s.vertex_rms <= s.vertex_max && s.max < 5e-3 && s.n_folded_patches == 0);
    CHECK(s.normal_jump < 1e-6 && s.converged == (s.max <= 1e-3 && s.vertex_max <= 1e-3));
    uint32_t none = 7;
    OK(ricci_quad_spline_folds(spline, &none, 1));
    patches_are_their_poles(spline);
    CHECK(patches_join(spline) == 0);
    matrices_are_affine(spline);
    nearest_places_are_feet(spline);
    meshes_are_closed(spline, 4.0 / 3.0 * pi * 1.6 * 1.2);
    ricci_step_options step;
    INIT(step);
    step.name = "ellipsoid", step.unit = RICCI_UNIT_METRE, step.colours = 1;
    OK(ricci_quad_spline_write_step(spline, &step, "quad_spline.step"));
    CHECK(count_in_file("quad_spline.step", "ADVANCED_FACE(") == s.n_patches);
    CHECK(count_in_file("quad_spline.step", "MANIFOLD_SOLID_BREP(") == 1);
    CHECK(count_in_file("quad_spline.step", "'ellipsoid'") > 0);
    CHECK(count_in_file("quad_spline.step", " STYLED_ITEM(") == s.n_patches);
    CHECK(count_in_file("quad_spline.step", " PCURVE(") == 2 * s.n_arcs);
    ricci_quad_spline_free(spline);
}

static void a_disk_has_a_border(void) {
    ricci_mesh *mesh = NULL;
    OK(make_disk(4, &mesh));
    ricci_seamless *seamless = seamless_of(mesh);
    ricci_mesh_free(mesh);
    ricci_quad_spline *spline = fitted(seamless, NULL, 1, 1);
    ricci_seamless_free(seamless);
    CHECK(patches_join(spline) > 0);
    patches_are_their_poles(spline);
    ricci_quad_spline_free(spline);
}

static void what_cannot_be_is_refused(void) {
    ricci_mesh *mesh = NULL, *finer = NULL;
    ricci_quad_layout *layout = NULL;
    ricci_quad_spline *spline = NULL, *none = NULL;
    OK(make_sized(RICCI_SHAPE_ELLIPSOID, 4, 0, 1.6, 1.2, 1, &mesh));
    OK(make_sized(RICCI_SHAPE_ELLIPSOID, 5, 0, 1.6, 1.2, 1, &finer));
    ricci_seamless *seamless = seamless_of(mesh), *other = seamless_of(finer);
    ricci_mesh_free(finer);
    OK(ricci_quad_layout_new(other, NULL, NULL, &layout));
    ricci_quad_spline_options options;
    INIT(options);
    CHECK(ricci_quad_spline_fit_mesh(NULL, 0, NULL, NULL, &none) == RICCI_NULL_POINTER);
    CHECK(ricci_quad_spline_fit_mesh(mesh, 0, NULL, NULL, NULL) == RICCI_NULL_POINTER);
    FAILS(ricci_quad_spline_fit_mesh(mesh, -1, NULL, NULL, &none), RICCI_ARGUMENT, "angle");
    FAILS(ricci_quad_spline_fit_mesh(mesh, INFINITY, NULL, NULL, &none), RICCI_ARGUMENT, "angle");
    CHECK(ricci_quad_spline_fit(NULL, NULL, NULL, NULL, &none) == RICCI_NULL_POINTER);
    CHECK(ricci_quad_spline_fit(seamless, NULL, NULL, NULL, NULL) == RICCI_NULL_POINTER);
    FAILS(ricci_quad_spline_fit(seamless, layout, NULL, NULL, &none), RICCI_ARGUMENT, "another");
    options.bending = 1;
    FAILS(ricci_quad_spline_fit(seamless, NULL, &options, NULL, &none), RICCI_ARGUMENT, "bending");
    options.bending = 0, options.reserved = 1;
    CHECK(ricci_quad_spline_fit(seamless, NULL, &options, NULL, &none) == RICCI_STRUCT_SIZE);
    ricci_control *control = NULL;
    OK(ricci_control_new(&control));
    OK(ricci_control_cancel(control));
    CHECK(ricci_quad_spline_fit(seamless, NULL, NULL, control, &none) == RICCI_CANCELLED);
    CHECK(ricci_quad_spline_fit_mesh(mesh, 0, NULL, control, &none) == RICCI_CANCELLED);
    ricci_quad_layout_free(layout);
    ricci_seamless_free(other);
    ricci_quad_spline_options lax;
    INIT(lax);
    lax.tolerance = 0.02, lax.most_spans = 1;
    OK(ricci_quad_spline_fit_mesh(mesh, 0, &lax, NULL, &spline));
    CHECK(figures_of(spline).n_patches >= 6 && figures_of(spline).converged);
    ricci_quad_spline_free(spline);
    spline = fitted(seamless, NULL, 1, 1);
    ricci_seamless_free(seamless);
    const ricci_quad_spline_summary s = figures_of(spline);
    ricci_quad_patch patch;
    ricci_quad_arc arc;
    double values[400], point[3] = {0, NAN, 0};
    uint32_t numbers[400];
    FAILS(ricci_quad_spline_patch(spline, s.n_patches, &patch, sizeof patch), RICCI_SPLINE, "patch");
    FAILS(ricci_quad_spline_arc(spline, s.n_arcs, &arc, sizeof arc), RICCI_SPLINE, "arc");
    CHECK(ricci_quad_spline_arc_poles(spline, s.n_arcs, values, 400) == RICCI_SPLINE);
    CHECK(ricci_quad_spline_poles(spline, s.n_patches, values, 400) == RICCI_SPLINE);
    CHECK(ricci_quad_spline_controls(spline, s.n_patches, numbers, 400) == RICCI_SPLINE);
    FAILS(ricci_quad_spline_knots(spline, 0, 2, values, 400, numbers, 400), RICCI_ARGUMENT, "along");
    FAILS(ricci_quad_spline_bezier(spline, 0, 2, values, 400), RICCI_ARGUMENT, "along");
    CHECK(ricci_quad_spline_bezier(spline, s.n_patches, 0, values, 400) == RICCI_SPLINE);
    FAILS(ricci_quad_spline_closest(spline, point, 1, NULL, numbers, values, 6), RICCI_ARGUMENT, "point");
    point[1] = 0;
    CHECK(ricci_quad_spline_closest(spline, point, 1, NULL, NULL, values, 6) == RICCI_NULL_POINTER);
    CHECK(ricci_quad_spline_closest(spline, point, 1, control, numbers, values, 6) == RICCI_CANCELLED);
    ricci_spline_places places;
    INIT(places);
    places.parameters = point, places.n = 1;
    FAILS(ricci_quad_spline_evaluate(spline, &places, 0, NULL, values, 3), RICCI_NULL_POINTER, "patches");
    numbers[0] = (uint32_t)s.n_patches, places.patches = numbers;
    CHECK(ricci_quad_spline_evaluate(spline, &places, 0, NULL, values, 3) == RICCI_SPLINE);
    numbers[0] = 0, point[0] = 1.5;
    FAILS(ricci_quad_spline_evaluate(spline, &places, 0, NULL, values, 3), RICCI_SPLINE, "1.5");
    CHECK(ricci_quad_spline_evaluate(spline, &places, 5, NULL, values, 3) == RICCI_ARGUMENT);
    ricci_mesh *made = NULL;
    CHECK(ricci_quad_spline_tessellate(spline, 3, 0.1, NULL, &made) == RICCI_ARGUMENT);
    CHECK(ricci_quad_spline_tessellate(spline, 0, -0.1, NULL, &made) == RICCI_ARGUMENT);
    CHECK(ricci_quad_spline_tessellate(spline, 0, NAN, NULL, &made) == RICCI_ARGUMENT);
    const ricci_status huge = ricci_quad_spline_tessellate(spline, SIZE_MAX, 0, NULL, &made);
    CHECK(huge == RICCI_NO_MEMORY || huge == RICCI_TOO_LARGE);
    CHECK(made == NULL);
    CHECK(ricci_quad_spline_write_step(spline, NULL, "no/such/folder.step") == RICCI_IO);
    FAILS(ricci_quad_spline_write_step(spline, NULL, "spline.iges"), RICCI_UNKNOWN_FORMAT, ".step");
    CHECK(ricci_quad_spline_write_step(spline, NULL, NULL) == RICCI_NULL_POINTER);
    ricci_control_free(control);
    ricci_quad_spline_free(spline);
    ricci_quad_spline_free(NULL);
    ricci_mesh_free(mesh);
    /* A surface without positions has a layout and nothing to fit. */
    OK(make_bolza(2, &mesh));
    seamless = seamless_of(mesh);
    FAILS(ricci_quad_spline_fit(seamless, NULL, NULL, NULL, &none), RICCI_LAYOUT, "positions");
    CHECK(none == NULL);
    ricci_seamless_free(seamless);
    ricci_mesh_free(mesh);
}

int main(void) {
    an_ellipsoid_is_met();
    a_disk_has_a_border();
    what_cannot_be_is_refused();
    return 0;
}
