/* A torn and shuffled torus through the C face: mended, and every element traced back. */
#include "torus.h"

int main(void) {
    torus t = torus_new(12, 8);
    const size_t n_faces = t.n_faces + 2, n_vertices = 3 * t.n_faces + 1;
    double *positions = (double *)malloc(3 * n_vertices * sizeof *positions);
    double *mended = (double *)malloc(3 * n_vertices * sizeof *mended);
    uint32_t *faces = (uint32_t *)malloc(3 * n_faces * sizeof *faces);
    uint32_t *result = (uint32_t *)malloc(3 * n_faces * sizeof *result);
    uint32_t *vertex_origin = (uint32_t *)malloc(n_vertices * sizeof *vertex_origin);
    uint32_t *face_origin = (uint32_t *)malloc(n_faces * sizeof *face_origin);
    ricci_repair *repair = NULL;
    ricci_repair_options options;
    ricci_repair_summary summary;
    ricci_diagnosis *diagnosis = NULL;
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

    OK(ricci_repair_arrays(positions, 0, n_vertices, faces, n_faces, NULL, &repair));
    OK(ricci_repair_summarise(repair, &summary, sizeof summary));
    CHECK(summary.n_vertices == t.n_vertices && summary.n_faces == t.n_faces && summary.n_defects == 0);
    CHECK(summary.welded_vertices == 3 * t.n_faces - t.n_vertices && summary.isolated_vertices == 1);
    CHECK(summary.duplicate_faces == 1 && summary.degenerate_faces == 1);
    CHECK(summary.turned_faces == (t.n_faces + 4) / 5 && summary.split_vertices == 0 &&
          summary.cut_edges == 0);
    FAILS(ricci_repair_result(repair, mended, 3 * n_vertices, result, 3), RICCI_BUFFER_TOO_SMALL, "faces");
    OK(ricci_repair_result(repair, mended, 3 * n_vertices, result, 3 * n_faces));
    OK(ricci_repair_origins(repair, vertex_origin, n_vertices, face_origin, n_faces));
    for (size_t v = 0; v < summary.n_vertices; v++)
        CHECK(memcmp(mended + 3 * v, positions + 3 * vertex_origin[v], 3 * sizeof(double)) == 0);
    for (size_t f = 0; f < summary.n_faces; f++) CHECK(face_origin[f] == f);
    OK(ricci_mesh_from_arrays(mended, 0, summary.n_vertices, result, summary.n_faces, &mesh));
    OK(ricci_mesh_summarise(mesh, &size, sizeof size));
    OK(ricci_mesh_summarise(whole, &expected, sizeof expected));
    CHECK(size.genus == expected.genus && size.n_edges == expected.n_edges && size.n_boundary_loops == 0);
    ricci_mesh_free(whole);
    OK(ricci_repair_diagnosis(repair, &diagnosis));
    ricci_diagnosis_free(diagnosis);
    ricci_mesh_free(mesh);
    ricci_repair_free(repair);
    repair = NULL;

    /* Without welding there are only loose triangles. */
    OK(ricci_repair_options_init(&options, sizeof options));
    options.weld = -1;
    options.component = 0;
    OK(ricci_repair_arrays(positions, 0, n_vertices, faces, t.n_faces, &options, &repair));
    OK(ricci_repair_summarise(repair, &summary, sizeof summary));
    CHECK(summary.n_faces == 1 && summary.faces_of_other_components == t.n_faces - 1);
    ricci_repair_free(repair);
    repair = NULL;

    options.component = 1000000;
    FAILS(ricci_repair_arrays(positions, 0, n_vertices, faces, t.n_faces, &options, &repair), RICCI_ARGUMENT,
          "component");
    options.component = -1;
    options.weld = NAN;
    FAILS(ricci_repair_arrays(positions, 0, n_vertices, faces, t.n_faces, &options, &repair), RICCI_ARGUMENT,
          "weld");
    options.weld = 0;
    options.cut_non_manifold_edges = 7;
    FAILS(ricci_repair_arrays(positions, 0, n_vertices, faces, t.n_faces, &options, &repair), RICCI_ARGUMENT,
          "cut_non_manifold_edges");
    faces[0] = 4000000;
    FAILS(ricci_repair_arrays(positions, 0, n_vertices, faces, t.n_faces, NULL, &repair), RICCI_DEFECTS,
          "4000000");
    FAILS(ricci_repair_file("no such file.obj", NULL, &repair), RICCI_IO, "no such file.obj");
    FAILS(ricci_repair_arrays(positions, 0, n_vertices, faces, t.n_faces, NULL, NULL), RICCI_NULL_POINTER,
          "repair");
    CHECK(repair == NULL);
    ricci_repair_free(NULL);
    free(positions);
    free(mended);
    free(faces);
    free(result);
    free(vertex_origin);
    free(face_origin);
    torus_free(&t);
    return 0;
}
