/* Files of GIFTI through the C face: notes, transforms, columns and labels read back, packed or not. */
#include "samples.h"
#include <math.h>
#include <ricci/freesurfer.h>
#include <ricci/gifti.h>

static const double POSITIONS[12] = {0, 0, 0, 1.5, 0, 0, 0, -2.25, 0, 0, 0, 0.5};
static const uint32_t FACES[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
static const double MATRIX[16] = {0.1, -2, 3e-7, 4.5, 0, 1, 0, -18, 0, 0, 1, 1e9, 0, 0, 0, 1};

/* Two names with values, and one transform. */
static ricci_gifti_notes *given_notes(void) {
    ricci_gifti_notes *notes = NULL;
    OK(ricci_gifti_notes_new(&notes));
    OK(ricci_gifti_notes_add(notes, "AnatomicalStructurePrimary", "CortexLeft"));
    OK(ricci_gifti_notes_add(notes, "a & b", "<]]>"));
    OK(ricci_gifti_notes_add_transform(notes, "NIFTI_XFORM_SCANNER_ANAT", "NIFTI_XFORM_MNI_152", MATRIX));
    return notes;
}

/* The notes of a file are those, with so many transforms. */
static void check_read(const char *path, size_t n_transforms) {
    ricci_gifti_notes *notes = NULL;
    ricci_gifti_note note;
    ricci_gifti_transform way;
    size_t n = 0, m = 0;
    OK(ricci_gifti_notes_read(path, &notes));
    OK(ricci_gifti_notes_count(notes, &n, &m));
    CHECK(n == 2 && m == n_transforms);
    OK(ricci_gifti_notes_get(notes, 0, &note, sizeof note));
    CHECK(!strcmp(note.name, "AnatomicalStructurePrimary") && !strcmp(note.value, "CortexLeft"));
    OK(ricci_gifti_notes_get(notes, 1, &note, sizeof note));
    CHECK(!strcmp(note.name, "a & b") && !strcmp(note.value, "<]]>"));
    FAILS(ricci_gifti_notes_get(notes, 2, &note, sizeof note), RICCI_ARGUMENT, "there are 2");
    if (n_transforms) {
        OK(ricci_gifti_notes_transform(notes, 0, &way, sizeof way));
        CHECK(!strcmp(way.from, "NIFTI_XFORM_SCANNER_ANAT") && !strcmp(way.to, "NIFTI_XFORM_MNI_152"));
        CHECK(memcmp(way.matrix, MATRIX, sizeof MATRIX) == 0);
    }
    FAILS(ricci_gifti_notes_transform(notes, 1, &way, sizeof way), RICCI_ARGUMENT, "transform 1");
    /* Texts stay where they are while notes are added. */
    OK(ricci_gifti_notes_add(notes, "c", ""));
    CHECK(!strcmp(note.value, "<]]>"));
    ricci_gifti_notes_free(notes);
}

static void check_surfaces(void) {
    ricci_gifti_notes *notes = given_notes();
    ricci_mesh *mesh = NULL;
    double places[12];
    OK(ricci_gifti_surface_write("lh.surf.gii", POSITIONS, 4, FACES, 4, notes));
    OK(ricci_gifti_surface_write("lh.surf.gii.gz", POSITIONS, 4, FACES, 4, notes));
    check_read("lh.surf.gii", 1);
    check_read("lh.surf.gii.gz", 1);
    OK(ricci_mesh_read("lh.surf.gii", &mesh));
    OK(ricci_mesh_values(mesh, RICCI_POSITIONS, places, 12));
    CHECK(memcmp(places, POSITIONS, sizeof places) == 0);
    ricci_mesh_free(mesh);
    OK(ricci_gifti_surface_write("plain.surf.gii", POSITIONS, 4, FACES, 4, NULL));
    const uint32_t wrong[3] = {0, 1, 9};
    FAILS(ricci_gifti_surface_write("lh.surf.gii", POSITIONS, 4, wrong, 1, notes), RICCI_ARGUMENT, "9");
    FAILS(ricci_gifti_surface_write(NULL, POSITIONS, 4, FACES, 4, notes), RICCI_NULL_POINTER, "path");
    /* What is refused leaves the file as it was. */
    check_read("lh.surf.gii", 1);
    ricci_gifti_notes_free(notes);
}

static void check_values(void) {
    const double values[6] = {0.5, -1.25, 1024.25, 2, NAN, 3}, far[1] = {1e39};
    ricci_gifti_notes *notes = given_notes();
    ricci_gifti_columns *columns = NULL;
    ricci_gifti_column column;
    double back[3];
    size_t n = 0, m = 0;
    OK(ricci_gifti_values_write("lh.shape.gii", "sulc\n\n", values, 3, 2, notes));
    OK(ricci_gifti_columns_read("lh.shape.gii", &columns));
    OK(ricci_gifti_columns_count(columns, &n, &m));
    CHECK(n == 2 && m == 0);
    OK(ricci_gifti_columns_get(columns, 0, &column, sizeof column));
    CHECK(!strcmp(column.intent, "SHAPE") && !strcmp(column.name, "sulc") && column.n == 3);
    CHECK(memcmp(column.values, values, sizeof back) == 0);
    OK(ricci_gifti_columns_get(columns, 1, &column, sizeof column));
    CHECK(!column.name[0] && column.values[0] == 2 && isnan(column.values[1]) && column.values[2] == 3);
    FAILS(ricci_gifti_columns_get(columns, 2, &column, sizeof column), RICCI_ARGUMENT, "column 2");
    FAILS(ricci_gifti_columns_get(columns, 0, &column, 7), RICCI_STRUCT_SIZE, "column");
    ricci_gifti_columns_free(columns);
    FAILS(ricci_gifti_values_write("x.gii", "a", values, 3, 2, NULL), RICCI_ARGUMENT, "1 lines for 2");
    FAILS(ricci_gifti_values_write("x.gii", "a", far, 1, 1, NULL), RICCI_ARGUMENT, "single precision");
    FAILS(ricci_gifti_values_write("x.gii", "\001", far, 0, 1, NULL), RICCI_ARGUMENT, "XML");
    /* One column is also read by the function for files of values, whose buffer may be too short. */
    OK(ricci_gifti_values_write("lh.sulc.shape.gii", "\n", values, 3, 1, notes));
    check_read("lh.sulc.shape.gii", 0);
    OK(ricci_values_read("lh.sulc.shape.gii", back, 3, &n));
    CHECK(n == 3 && memcmp(back, values, sizeof back) == 0);
    FAILS(ricci_values_read("lh.sulc.shape.gii", back, 2, &n), RICCI_BUFFER_TOO_SMALL, "values");
    ricci_gifti_notes_free(notes);
}

static void check_labels(void) {
    const int32_t labels[3] = {7, 0, 7}, keys[2] = {0, 7}, foreign[1] = {3};
    const double colors[8] = {0, 0, 0, 0, 1, 0.25, 0.5, 1}, bright[8] = {0, 0, 0, 0, 1, 2, 0.5, 1};
    ricci_gifti_columns *columns = NULL;
    ricci_gifti_column column;
    ricci_gifti_label label;
    size_t n = 0, m = 0;
    OK(ricci_gifti_labels_write("lh.label.gii", labels, 3, keys, "???\ncuneus", colors, 2, NULL));
    OK(ricci_gifti_columns_read("lh.label.gii", &columns));
    OK(ricci_gifti_columns_count(columns, &n, &m));
    CHECK(n == 1 && m == 2);
    OK(ricci_gifti_columns_get(columns, 0, &column, sizeof column));
    CHECK(!strcmp(column.intent, "LABEL") && column.n == 3 && column.values[0] == 7 && column.values[1] == 0);
    OK(ricci_gifti_columns_label(columns, 1, &label, sizeof label));
    CHECK(!strcmp(label.name, "cuneus") && label.key == 7 && memcmp(label.color, colors + 4, 32) == 0);
    FAILS(ricci_gifti_columns_label(columns, 2, &label, sizeof label), RICCI_ARGUMENT, "label 2");
    ricci_gifti_columns_free(columns);
    FAILS(ricci_gifti_labels_write("x.gii", foreign, 1, keys, "a\nb", colors, 2, NULL), RICCI_ARGUMENT, "3");
    FAILS(ricci_gifti_labels_write("x.gii", labels, 3, keys, "a\nb", bright, 2, NULL), RICCI_ARGUMENT, "2");
}

static void check_damage(void) {
    ricci_gifti_notes *notes = given_notes(), *none = NULL;
    ricci_gifti_columns *columns = NULL;
    double wrong[16];
    memcpy(wrong, MATRIX, sizeof wrong);
    wrong[5] = NAN;
    FAILS(ricci_gifti_notes_add_transform(notes, "a", "b", wrong), RICCI_ARGUMENT, "entry 5");
    FAILS(ricci_gifti_notes_add_transform(notes, "a", "b", NULL), RICCI_NULL_POINTER, "matrix");
    FAILS(ricci_gifti_notes_add(notes, "\xff", "b"), RICCI_ARGUMENT, "UTF-8");
    FAILS(ricci_gifti_notes_add(NULL, "a", "b"), RICCI_NULL_POINTER, "notes");
    FILE *file = fopen("cut.surf.gii", "w");
    CHECK(file && fputs("<GIFTI Version=\"1.0\"><MetaData><MD><Name>a</Name>", file) >= 0 && !fclose(file));
    FAILS(ricci_gifti_notes_read("cut.surf.gii", &none), RICCI_PARSE, "cut.surf.gii");
    FAILS(ricci_gifti_columns_read("cut.surf.gii", &columns), RICCI_PARSE, "cut.surf.gii");
    FAILS(ricci_gifti_notes_read("no/such.gii", &none), RICCI_IO, "no/such.gii");
    CHECK(!none && !columns);
    ricci_gifti_notes_free(notes);
    ricci_gifti_notes_free(NULL);
    ricci_gifti_columns_free(NULL);
}

int main(void) {
    check_surfaces();
    check_values();
    check_labels();
    check_damage();
    return 0;
}
