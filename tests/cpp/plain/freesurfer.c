/* Data of FreeSurfer through the C face: values, labels, patches and annotations read back, packed or not. */
#include "samples.h"
#include <ricci/freesurfer.h>

static void check_values(void) {
    const double values[3] = {0.5, -2, 1024.25};
    double back[3];
    size_t n = 0;
    OK(ricci_values_write("lh.sulc", values, 3, 1));
    OK(ricci_values_write("lh.sulc.gz", values, 3, 1));
    OK(ricci_values_read("lh.sulc", NULL, 0, &n));
    CHECK(n == 3);
    OK(ricci_values_read("lh.sulc.gz", back, 3, &n));
    CHECK(memcmp(values, back, sizeof back) == 0);
    FAILS(ricci_values_read("lh.sulc", back, 2, &n), RICCI_BUFFER_TOO_SMALL, "values");
    FAILS(ricci_values_read("no/such.sulc", back, 3, &n), RICCI_IO, "no/such.sulc");
}

static void check_labels(void) {
    const int32_t vertices[2] = {7, -1};
    const double positions[6] = {1, 2, 3, 4, 5, 6}, values[2] = {0.25, 0.75};
    int32_t back[2];
    double places[6], weights[2];
    size_t n = 0;
    OK(ricci_label_write("lh.cortex.label", "a label", vertices, positions, values, 2));
    OK(ricci_label_read("lh.cortex.label", back, 2, places, 6, weights, 2, &n));
    CHECK(n == 2 && back[0] == 7 && back[1] == -1 && places[5] == 6 && weights[1] == 0.75);
    OK(ricci_label_write("lh.cortex.label", NULL, vertices, NULL, NULL, 2));
    OK(ricci_label_read("lh.cortex.label", NULL, 0, places, 6, NULL, 0, &n));
    CHECK(places[5] == 0);
    FAILS(ricci_label_read("lh.sulc", back, 2, NULL, 0, NULL, 0, &n), RICCI_PARSE, "lh.sulc");
}

static void check_patches(void) {
    const uint32_t vertices[2] = {4, 9}, border[2] = {0, 1};
    const double positions[6] = {1, 2, 0, 4, 5, 0};
    uint32_t back[2], on_border[2];
    double places[6];
    size_t n = 0;
    OK(ricci_patch_write("lh.flat", vertices, positions, border, 2));
    OK(ricci_patch_read("lh.flat", back, 2, places, 6, on_border, 2, &n));
    CHECK(n == 2 && back[0] == 4 && back[1] == 9 && places[3] == 4 && on_border[0] == 0 && on_border[1] == 1);
    FAILS(ricci_patch_read("lh.flat", back, 1, NULL, 0, NULL, 0, &n), RICCI_BUFFER_TOO_SMALL, "vertices");
}

static void check_annotations(void) {
    const int32_t regions[4] = {1, 0, -1, 1};
    const uint32_t colors[8] = {10, 20, 30, 0, 200, 0, 0, 0};
    int32_t back[4];
    uint32_t rows[8];
    char names[32];
    size_t n = 0, bytes = 0;
    OK(ricci_annotation_write("lh.annot", regions, 4, "bank\ncuneus\n", colors, 2));
    OK(ricci_annotation_read("lh.annot", back, 4, &n, rows, 8, names, sizeof names, &bytes));
    CHECK(n == 4 && memcmp(back, regions, sizeof back) == 0 && memcmp(rows, colors, sizeof rows) == 0);
    CHECK(strcmp(names, "bank\ncuneus\n") == 0 && bytes == 13);
    FAILS(ricci_annotation_write("lh.annot", regions, 4, "bank", colors, 2), RICCI_ARGUMENT, "1 lines");
    const uint32_t wrong[8] = {10, 20, 300, 0, 200, 0, 0, 0};
    FAILS(ricci_annotation_write("lh.annot", regions, 4, "a\nb", wrong, 2), RICCI_ARGUMENT, "300");
}

int main(void) {
    check_values();
    check_labels();
    check_patches();
    check_annotations();
    return 0;
}
