/* A torn and shuffled torus through the C face: mended, and every element traced back. */
#include "torus.h"
#include <math.h>
#include <ricci/repair.h>

/* ricci_soup_repair of arrays. */
static ricci_status mend(const double *positions, size_t n_vertices, const uint32_t *faces, size_t n_faces,
                         const ricci_repair_options *options, ricci_soup **repair) {
    ricci_soup *soup = NULL;
    OK(ricci_soup_from_arrays(positions, 0, n_vertices, faces, n_faces, &soup));
    const ricci_status status = ricci_soup_repair(soup, options, repair);
    ricci_soup_free(soup);
    return status;
}

/* A closed cube and a fin, as loose triangles: the fin stays apart, and its edge is reported. */
static void fin(void) {
    const double place[9][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},    {0, 0, 1},
                                {1, 0, 1}, {0, 1, 1}, {1, 1, 1}, {0.5, -1, -1}};
    const uint32_t corner[39] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6,
                                 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 8};
    double positions[39][3];
    uint32_t faces[39], vertices[2], meeting[3];
    size_t starts[2];
    ricci_soup *repair = NULL;
    ricci_soup_summary summary;
    for (uint32_t k = 0; k < 39; k++) {
        memcpy(positions[k], place[corner[k]], sizeof positions[k]);
        faces[k] = k;
    }
    ricci_quality_summary shape;
    OK(mend(positions[0], 39, faces, 13, NULL, &repair));
    OK(ricci_soup_quality(repair, &shape, sizeof shape));
    CHECK(shape.size == sizeof shape && shape.area > 6 && shape.min_angle > 0 && shape.edge_ratio < 3 &&
          shape.non_delaunay_fraction != shape.non_delaunay_fraction);
    FAILS(ricci_soup_quality(repair, NULL, sizeof shape), RICCI_NULL_POINTER, "quality");
    OK(ricci_soup_summarise(repair, &summary, sizeof summary));
    CHECK(summary.n_vertices == 11 && summary.refused_edges == 1 && summary.refused_faces == 3);
    FAILS(ricci_soup_refused(repair, vertices, 2, meeting, 2, starts, 2), RICCI_BUFFER_TOO_SMALL, "faces");
    OK(ricci_soup_refused(repair, vertices, 2, meeting, 3, starts, 2));
    CHECK(starts[0] == 0 && starts[1] == 3 && meeting[0] == 1 && meeting[1] == 4 && meeting[2] == 12);
    CHECK(corner[vertices[0]] + corner[vertices[1]] == 1);
    FAILS(ricci_soup_values(repair, RICCI_UV, positions[0], 117), RICCI_ARGUMENT, "uv");
    /* Two components are a defect of a mesh, and none of a file. */
    CHECK(summary.n_defects == 1);
    OK(ricci_soup_write(repair, "fin.ply"));
    FAILS(ricci_soup_write(repair, "fin.stl"), RICCI_UNKNOWN_FORMAT, ".glb");
    ricci_soup_free(repair);
}

/* Attributes stay with their elements: a triangle, given twice, the second time turned and with an unused
 * vertex. */
static void attributes(void) {
    const char *text = "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 9\nvn 0 0 1\nvn 0 0 2\nvn 0 0 3\n"
                       "vt 0 0.5\nvt 1 0\nvt 0.25 1\nf 2/1/2 3/2/3 4/3/4\nf 3/2/3 2/1/2 4/3/4\n";
    double normals[9], uv[6], colors[12];
    ricci_soup *soup = NULL, *repair = NULL;
    ricci_mesh *mesh = NULL;
    ricci_soup_summary summary;
    ricci_attributes textured;
    FILE *file = fopen("attributes.obj", "w");
    CHECK(file && fputs(text, file) >= 0 && fclose(file) == 0);
    OK(ricci_soup_read("attributes.obj", &soup));
    OK(ricci_soup_repair(soup, NULL, &repair));
    ricci_soup_free(soup);
    OK(ricci_soup_summarise(repair, &summary, sizeof summary));
    CHECK(summary.n_vertices == 3 && summary.n_faces == 1 && summary.isolated_vertices == 1);
    FAILS(ricci_soup_values(repair, RICCI_NORMALS, normals, 8), RICCI_BUFFER_TOO_SMALL, "values");
    OK(ricci_soup_values(repair, RICCI_NORMALS, normals, 9));
    OK(ricci_soup_values(repair, RICCI_UV, uv, 6));
    FAILS(ricci_soup_values(repair, RICCI_COLORS, colors, 12), RICCI_ARGUMENT, "colors");
    CHECK(normals[2] == 1 && normals[5] == 2 && normals[8] == 3);
    CHECK(uv[1] == 0.5 && uv[2] == 1 && uv[4] == 0.25 && uv[5] == 1);
    OK(ricci_soup_write(repair, "attributes.ply"));
    INIT(textured);
    textured.uv = uv;
    OK(ricci_soup_with_attributes(repair, &textured, &soup));
    OK(ricci_soup_summarise(soup, &summary, sizeof summary));
    CHECK(summary.n_uv == 1 && summary.n_normals == 0 && summary.isolated_vertices == 0);
    FAILS(ricci_soup_with_attributes(repair, NULL, &soup), RICCI_NULL_POINTER, "attributes");
    ricci_soup_free(soup);
    ricci_soup_free(repair);

    /* And go out again with a texture. */
    const unsigned char png[] = {0x89, 'P', 'N',  'G', '\r', '\n', 0x1a, '\n', 0,    0,    0,    13,
                                 'I',  'H', 'D',  'R', 0,    0,    0,    1,    0,    0,    0,    1,
                                 8,    2,   0,    0,   0,    0x90, 0x77, 0x53, 0xde, 0,    0,    0,
                                 12,   'I', 'D',  'A', 'T',  8,    0xd7, 0x63, 0xf8, 0xff, 0xff, 0x3f,
                                 0,    5,   0xfe, 2,   0xfe, 0xdc, 0xcc, 0x59, 0xe7, 0,    0,    0,
                                 0,    'I', 'E',  'N', 'D',  0xae, 0x42, 0x60, 0x82};
    OK(ricci_mesh_read("attributes.ply", &mesh));
    INIT(textured);
    textured.uv = uv, textured.png = png, textured.png_size = sizeof png, textured.wrap = RICCI_WRAP_MIRROR;
    OK(ricci_mesh_write(mesh, &textured, "attributes.glb"));
    FAILS(ricci_mesh_write(mesh, &textured, "x.obj"), RICCI_ARGUMENT, ".glb");
    textured.wrap = 3;
    FAILS(ricci_mesh_write(mesh, &textured, "x.glb"), RICCI_ARGUMENT, "wrap is 3");
    textured.wrap = RICCI_WRAP_CLAMP, textured.png = png + 1, textured.png_size--;
    FAILS(ricci_mesh_write(mesh, &textured, "x.glb"), RICCI_ARGUMENT, "PNG");
    textured.png = NULL;
    FAILS(ricci_mesh_write(mesh, &textured, "x.glb"), RICCI_NULL_POINTER, "png");
    textured.png = png, textured.png_size = sizeof png, textured.uv = NULL;
    FAILS(ricci_mesh_write(mesh, &textured, "x.glb"), RICCI_ARGUMENT, "uv");
    ricci_mesh_free(mesh);
    mesh = NULL;
    OK(ricci_mesh_read("attributes.glb", &mesh));
    OK(ricci_mesh_values(mesh, RICCI_UV, uv, 6));
    CHECK(uv[1] == 0.5 && uv[2] == 1 && uv[4] == 0.25 && uv[5] == 1);
    ricci_mesh_free(mesh);
}

/* Two triangles of a square become 8, whose places are those of their positions; as a metric with thin
 * triangles they are refined to the angle. */
static void check_refined(void) {
    const double square[12] = {0, 0, 0, 8, 0, 0, 8, 1, 0, 0, 1, 0};
    const uint32_t two[6] = {0, 1, 2, 0, 2, 3};
    double positions[27], weights[27];
    uint32_t origin[8], at[9];
    ricci_soup *soup = NULL, *finer = NULL;
    ricci_mesh *mesh = NULL, *fat = NULL;
    ricci_soup_summary n;
    ricci_refine_options options;
    ricci_refine_summary course;
    OK(ricci_soup_from_arrays(square, 0, 4, two, 2, &soup));
    FAILS(ricci_soup_places(soup, origin, 8, at, 9, weights, 27), RICCI_ARGUMENT, "was not refined");
    INIT(options);
    options.levels = 1;
    OK(ricci_soup_refine(soup, &options, &finer));
    OK(ricci_soup_summarise(finer, &n, sizeof n));
    CHECK(n.n_vertices == 9 && n.n_faces == 8 && n.n_defects == 0 && n.euler == 1);
    OK(ricci_soup_values(finer, RICCI_POSITIONS, positions, 27));
    FAILS(ricci_soup_places(finer, origin, 8, at, 9, weights, 26), RICCI_BUFFER_TOO_SMALL, "27");
    OK(ricci_soup_places(finer, origin, 8, at, 9, weights, 27));
    for (int f = 0; f < 8; f++) CHECK(origin[f] == (uint32_t)f / 4);
    for (int v = 0; v < 9; v++) {
        for (int k = 0; k < 3; k++) {
            double x = 0;
            for (int c = 0; c < 3; c++) x += weights[3 * v + c] * square[3 * two[3 * at[v] + c] + k];
            CHECK(x == positions[3 * v + k]);
        }
    }
    options.longest_edge = -1;
    FAILS(ricci_soup_refine(soup, &options, &finer), RICCI_ARGUMENT, "longest edge");
    OK(ricci_soup_mesh(soup, &mesh));
    OK(ricci_mesh_refine_angle(mesh, NULL, NULL, &course, sizeof course, &fat));
    CHECK(course.n_below == 0 && course.n_forced == 0 && course.n_on_boundary > 0);
    CHECK(course.given_angle < 0.2 && course.least_angle >= 25 * acos(-1) / 180);
    ricci_mesh_summary found;
    OK(ricci_mesh_summarise(fat, &found, sizeof found));
    uint32_t *faces = malloc(found.n_vertices * sizeof *faces);
    double *places = malloc(3 * found.n_vertices * sizeof *places);
    FAILS(ricci_mesh_places(mesh, faces, 4, places, 12), RICCI_ARGUMENT, "was not refined");
    FAILS(ricci_mesh_places(fat, faces, found.n_vertices, places, 5), RICCI_BUFFER_TOO_SMALL, "weights");
    OK(ricci_mesh_places(fat, faces, found.n_vertices, places, 3 * found.n_vertices));
    for (size_t v = 0; v < found.n_vertices; v++) {
        double x[2] = {0, 0};
        for (int k = 0; k < 6; k++) {
            x[k % 2] += places[3 * v + k / 2] * square[3 * two[3 * faces[v] + k / 2] + k % 2];
        }
        if (v < 4) CHECK(x[0] == square[3 * v] && x[1] == square[3 * v + 1]);
        CHECK(x[0] >= 0 && x[0] <= 8 && x[1] >= 0 && x[1] <= 1);
    }
    free(faces);
    free(places);
    ricci_mesh_free(fat);
    fat = NULL;
    options.least_angle = 1;
    FAILS(ricci_mesh_refine_angle(mesh, &options, NULL, NULL, 0, &fat), RICCI_ARGUMENT, "30");
    ricci_mesh_free(mesh);
    ricci_soup_free(finer);
    ricci_soup_free(soup);
}

/* A square cut along its diagonal, with the parts a little apart: the seam is found with the weld that closes
 * it. */
static void seam(void) {
    const double positions[18] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1e-9, 0, 1, 1 + 1e-9, 0, 0, 1, 0};
    const uint32_t faces[6] = {0, 1, 2, 3, 4, 5};
    ricci_soup *soup = NULL;
    ricci_soup_summary summary;
    ricci_defect hint;
    OK(ricci_soup_from_arrays(positions, 0, 6, faces, 2, &soup));
    OK(ricci_soup_summarise(soup, &summary, sizeof summary));
    CHECK(summary.n_hints == 1);
    OK(ricci_soup_hint(soup, 0, &hint, sizeof hint));
    CHECK(hint.size == sizeof hint);
    FAILS(ricci_soup_hint(soup, 1, &hint, sizeof hint), RICCI_ARGUMENT, "hint 1");
    FAILS(ricci_soup_hint(soup, 0, NULL, sizeof hint), RICCI_NULL_POINTER, "defect");
    ricci_soup_free(soup);
}

/* A roof of two slopes beside a flat triangle apart from it: loops, the ridge, its corners, and the pieces.
 */
static void lists(void) {
    const double positions[27] = {0, 0, 0, 4, 0, 0, 4, 1,  1, 0, 1, 1, 4, 2,
                                  0, 0, 2, 0, 9, 0, 0, 10, 0, 0, 9, 1, 0};
    const uint32_t faces[15] = {6, 7, 8, 0, 1, 2, 0, 2, 3, 3, 2, 4, 3, 4, 5};
    uint32_t around[9], ends[2], corners[9], origin[6], of[5];
    size_t starts[3], n = 9;
    double lengths[2], angle, numbers[9];
    char name[8];
    ricci_soup *soup = NULL, *piece = NULL;
    ricci_soup_summary summary;
    ricci_repair_options options;
    OK(ricci_soup_from_arrays(positions, 0, 9, faces, 5, &soup));
    OK(ricci_soup_summarise(soup, &summary, sizeof summary));
    CHECK(summary.n_components == 2 && summary.n_loops == 2 && summary.n_loop_vertices == 9);
    FAILS(ricci_soup_loops(soup, lengths, 2, around, 8, starts, 3), RICCI_BUFFER_TOO_SMALL, "vertices");
    OK(ricci_soup_loops(soup, lengths, 2, around, 9, starts, 3));
    CHECK(starts[1] == 3 && starts[2] == 9 && around[0] == 6 && around[1] == 7 && around[3] == 0);
    CHECK(fabs(lengths[0] - 2 - sqrt(2)) < 1e-14 && fabs(lengths[1] - 8 - 4 * sqrt(2)) < 1e-14);
    OK(ricci_soup_sharp_edges(soup, 1.0, NULL, 0, NULL, 0, &n));
    CHECK(n == 1);
    FAILS(ricci_soup_sharp_edges(soup, 1.0, ends, 2, &angle, 0, &n), RICCI_BUFFER_TOO_SMALL, "angles");
    OK(ricci_soup_sharp_edges(soup, 1.0, ends, 2, &angle, 1, &n));
    CHECK(ends[0] == 2 && ends[1] == 3 && fabs(angle - acos(0)) < 1e-14);
    FAILS(ricci_soup_sharp_edges(soup, 0, ends, 2, &angle, 1, &n), RICCI_ARGUMENT, "angle");
    OK(ricci_soup_corners(soup, 1.0, corners, 9, &n));
    CHECK(n == 9);
    for (size_t k = 1; k < n; k++) CHECK(corners[k - 1] < corners[k]);
    OK(ricci_soup_labels(soup, RICCI_LABEL_MATERIAL, of, 5, &n));
    CHECK(n == 1 && of[0] == 0 && of[4] == 0);
    OK(ricci_soup_label(soup, RICCI_LABEL_MATERIAL, 0, name, 8, &n));
    CHECK(n == 1 && strcmp(name, "") == 0);
    FAILS(ricci_soup_label(soup, RICCI_LABEL_MATERIAL, 1, name, 8, &n), RICCI_ARGUMENT, "name 1");
    FAILS(ricci_soup_labels(soup, 6, of, 5, &n), RICCI_ARGUMENT, "RICCI_LABEL_SMOOTHING");
    FAILS(ricci_soup_numbers(soup, RICCI_OF_FACES, 0, numbers, 9), RICCI_ARGUMENT, "numbers 0");
    INIT(options);
    options.weld = -1, options.component = 2;
    OK(ricci_soup_repair(soup, &options, &piece));
    OK(ricci_soup_origins(piece, origin, 3, of, 1));
    CHECK(origin[0] == 6 && origin[1] == 7 && origin[2] == 8 && of[0] == 0);
    ricci_soup_free(piece);
    ricci_soup_free(soup);
}

/* A square hole in a square plate is filled; the loop outside stays open as it is not asked for. */
static void holes(void) {
    double positions[24];
    uint32_t faces[24];
    for (int k = 0; k < 4; k++) {
        const double x = k == 0 || k == 3 ? -1 : 1, y = k < 2 ? -1 : 1;
        const uint32_t next = (uint32_t)(k + 1) % 4, v = (uint32_t)k;
        const uint32_t two[6] = {v, next, 4 + next, v, 4 + next, 4 + v};
        positions[3 * k] = 2 * x, positions[3 * k + 1] = 2 * y, positions[3 * k + 2] = 0;
        positions[12 + 3 * k] = x, positions[13 + 3 * k] = y, positions[14 + 3 * k] = 0;
        memcpy(faces + 6 * k, two, sizeof two);
    }
    const uint32_t through = 4;
    ricci_soup *soup = NULL, *filled = NULL;
    ricci_repair_options options;
    ricci_soup_summary summary;
    ricci_hole hole;
    OK(ricci_soup_from_arrays(positions, 0, 8, faces, 8, &soup));
    FAILS(ricci_soup_hole(soup, 0, &hole, sizeof hole), RICCI_ARGUMENT, "was not repaired");
    INIT(options);
    options.holes = &through, options.n_holes = 1;
    OK(ricci_soup_repair(soup, &options, &filled));
    OK(ricci_soup_summarise(filled, &summary, sizeof summary));
    CHECK(summary.filled_holes == 1 && summary.open_holes == 0);
    OK(ricci_soup_hole(filled, 0, &hole, sizeof hole));
    CHECK(hole.filled == 1 && strcmp(hole.reason, "filled") == 0 && hole.n_edges == 4 && hole.vertex == 4);
    CHECK(fabs(hole.length - 8) < 1e-12 && fabs(hole.area - 4) < 1e-12);
    CHECK(hole.first_face == 8 && hole.first_face + hole.n_faces == summary.n_faces);
    CHECK(hole.first_vertex == 8 && hole.first_vertex + hole.n_vertices == summary.n_vertices);
    FAILS(ricci_soup_hole(filled, 1, &hole, sizeof hole), RICCI_ARGUMENT, "hole 1");
    ricci_soup_free(filled);
    ricci_soup_free(soup);
}

/* A file's own numbers of vertices. */
static void further_numbers_are_read(void) {
    ricci_soup *soup = NULL;
    double numbers[3];
    FILE *file = fopen("numbers.ply", "w");
    CHECK(file);
    CHECK(fputs("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                "property float z\nproperty float quality\nelement face 1\n"
                "property list uchar int vertex_indices\nend_header\n"
                "0 0 0 0.5\n1 0 0 0.25\n0 1 0 2\n3 0 1 2\n",
                file) >= 0);
    CHECK(fclose(file) == 0);
    OK(ricci_soup_read("numbers.ply", &soup));
    OK(ricci_soup_numbers(soup, RICCI_OF_VERTICES, 0, numbers, 3));
    CHECK(numbers[0] == 0.5 && numbers[1] == 0.25 && numbers[2] == 2);
    ricci_soup_free(soup);
}

int main(void) {
    fin();
    attributes();
    lists();
    holes();
    torus t = torus_new(12, 8);
    const size_t n_faces = t.n_faces + 2, n_vertices = 3 * t.n_faces + 1;
    double *positions = (double *)malloc(3 * n_vertices * sizeof *positions);
    double *mended = (double *)malloc(3 * n_vertices * sizeof *mended);
    uint32_t *faces = (uint32_t *)malloc(3 * n_faces * sizeof *faces);
    uint32_t *result = (uint32_t *)malloc(3 * n_faces * sizeof *result);
    uint32_t *vertex_origin = (uint32_t *)malloc(n_vertices * sizeof *vertex_origin);
    uint32_t *face_origin = (uint32_t *)malloc(n_faces * sizeof *face_origin);
    ricci_soup *repair = NULL;
    ricci_repair_options options;
    ricci_soup_summary summary;
    ricci_mesh *mesh = NULL, *whole = torus_mesh(&t);
    ricci_mesh_summary size, expected;
    CHECK(positions && mended && faces && result && vertex_origin && face_origin);

    /* Each face has corners of its own; every fifth is turned; one is repeated, one has a corner twice. */
    for (size_t k = 0; k < 3 * t.n_faces; k++) {
        memcpy(positions + 3 * k, t.positions + 3 * t.faces[k], 3 * sizeof(double));
        faces[k] = (uint32_t)k;
    }
    for (size_t f = 0; f < t.n_faces; f += 5) {
        faces[3 * f + 1] = (uint32_t)(3 * f + 2);
        faces[3 * f + 2] = (uint32_t)(3 * f + 1);
    }
    for (uint32_t k = 0; k < 3; k++) {
        faces[3 * t.n_faces + k] = k;
        faces[3 * t.n_faces + 3 + k] = k / 2;
        positions[3 * n_vertices - 3 + k] = 9;
    }

    OK(mend(positions, n_vertices, faces, n_faces, NULL, &repair));
    OK(ricci_soup_summarise(repair, &summary, sizeof summary));
    CHECK(summary.n_vertices == t.n_vertices && summary.n_faces == t.n_faces && summary.n_defects == 0);
    CHECK(summary.welded_vertices == 3 * t.n_faces - t.n_vertices && summary.isolated_vertices == 1);
    CHECK(summary.duplicate_faces == 1 && summary.degenerate_faces == 1);
    CHECK(summary.turned_faces == (t.n_faces + 4) / 5 && summary.split_vertices == 0 &&
          summary.cut_edges == 0);
    FAILS(ricci_soup_faces(repair, result, 3), RICCI_BUFFER_TOO_SMALL, "faces");
    OK(ricci_soup_values(repair, RICCI_POSITIONS, mended, 3 * n_vertices));
    FAILS(ricci_soup_values(repair, RICCI_LENGTHS, mended, 3 * n_vertices), RICCI_ARGUMENT, "no lengths");
    OK(ricci_soup_faces(repair, result, 3 * n_faces));
    OK(ricci_soup_origins(repair, vertex_origin, n_vertices, face_origin, n_faces));
    for (size_t v = 0; v < summary.n_vertices; v++)
        CHECK(memcmp(mended + 3 * v, positions + 3 * vertex_origin[v], 3 * sizeof(double)) == 0);
    for (size_t f = 0; f < summary.n_faces; f++) CHECK(face_origin[f] == f);
    OK(ricci_soup_mesh(repair, &mesh));
    OK(ricci_mesh_summarise(mesh, &size, sizeof size));
    OK(ricci_mesh_summarise(whole, &expected, sizeof expected));
    CHECK(size.genus == expected.genus && size.n_edges == expected.n_edges && size.n_boundary_loops == 0);
    ricci_mesh_free(whole);
    FAILS(ricci_soup_defect(repair, 0, NULL, 0), RICCI_ARGUMENT, "defect 0 does not exist");
    ricci_mesh_free(mesh);
    ricci_soup_free(repair);
    repair = NULL;

    /* Without welding there are only loose triangles. */
    INIT(options);
    options.weld = -1;
    options.component = 1;
    OK(mend(positions, n_vertices, faces, t.n_faces, &options, &repair));
    OK(ricci_soup_summarise(repair, &summary, sizeof summary));
    CHECK(summary.n_faces == 1 && summary.faces_of_other_components == t.n_faces - 1);
    ricci_soup_free(repair);
    repair = NULL;

    options.component = 1000000;
    FAILS(mend(positions, n_vertices, faces, t.n_faces, &options, &repair), RICCI_ARGUMENT, "component");
    options.component = 0;
    options.weld = NAN;
    FAILS(mend(positions, n_vertices, faces, t.n_faces, &options, &repair), RICCI_ARGUMENT, "weld");
    options.weld = 0;
    options.cut_non_manifold_edges = 7;
    FAILS(mend(positions, n_vertices, faces, t.n_faces, &options, &repair), RICCI_ARGUMENT,
          "cut_non_manifold_edges");
    faces[0] = 4000000;
    FAILS(mend(positions, n_vertices, faces, t.n_faces, NULL, &repair), RICCI_DEFECTS, "4000000");
    FAILS(ricci_soup_read("no such file.obj", &repair), RICCI_IO, "no such file.obj");
    FAILS(mend(positions, n_vertices, faces, t.n_faces, NULL, NULL), RICCI_NULL_POINTER, "soup");
    CHECK(repair == NULL);
    ricci_soup_free(NULL);
    free(positions);
    free(mended);
    free(faces);
    free(result);
    free(vertex_origin);
    free(face_origin);
    torus_free(&t);
    check_refined();
    seam();
    further_numbers_are_read();
    return 0;
}
