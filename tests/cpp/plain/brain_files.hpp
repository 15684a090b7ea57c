// Files of brains through the C++ wrapper: those of FreeSurfer and of GIFTI, written and read again.
#ifndef BRAIN_FILES_HPP
#define BRAIN_FILES_HPP

#include <ricci/freesurfer.hpp>
#include <ricci/gifti.hpp>

#include <array>
#include <vector>

// Data of FreeSurfer, written and read again.
inline int brain_files() {
    ricci::write_values("every.sulc", {1, 2, 3}, 1);
    ricci::write_label("every.label", {{0, 2}, {}, {0.5, 1}});
    ricci::write_patch("every.flat", {{5}, {1, 2, 0}, {1}});
    ricci::write_annotation("every.annot", {{0, -1, 1}, {"a", "b"}, {1, 2, 3, 0, 4, 5, 6, 0}});
    const auto regions = ricci::read_annotation("every.annot");
    const bool same = ricci::read_values("every.sulc").size() == 3 &&
                      ricci::read_label("every.label").values[1] == 1 &&
                      ricci::read_patch("every.flat").vertices[0] == 5 && regions.names[1] == "b" &&
                      regions.regions[1] == -1 && regions.colors[4] == 4;
    return same ? 0 : 24;
}

// Files of GIFTI with notes, written and read again.
inline int gifti_files() {
    ricci::gifti_notes notes;
    notes.add("AnatomicalStructurePrimary", "CortexLeft");
    const std::array<double, 16> matrix = {{1, 0, 0, -18, 0, 1, 0, 2, 0, 0, 1, 0.5, 0, 0, 0, 1}};
    notes.add({"NIFTI_XFORM_SCANNER_ANAT", "NIFTI_XFORM_MNI_152", matrix});
    const std::vector<double> corners = {0, 0, 0, 1, 0, 0, 0, 1.25, 0};
    ricci::write_gifti_surface("every.surf.gii", corners, std::vector<std::uint32_t>{0, 2, 1}, &notes);
    const auto again = ricci::gifti_notes::read("every.surf.gii");
    const auto way = again.transforms();
    if (again.metadata() != notes.metadata() || again.metadata()[0].second != "CortexLeft") return 25;
    if (way.size() != 1 || way[0].to != "NIFTI_XFORM_MNI_152" || way[0].matrix != matrix) return 25;
    ricci::write_gifti_values("every.shape.gii", {{"SHAPE", "a", {1, 2}}, {"SHAPE", "", {3, 4}}}, &notes);
    const auto values = ricci::read_gifti_columns("every.shape.gii").columns;
    if (values.size() != 2 || values[0].name != "a" || values[1].values[1] != 4) return 26;
    ricci::write_gifti_labels("every.label.gii", std::vector<std::int32_t>{7, 7}, {{7, "b", {{1, 0, 0, 1}}}});
    const auto labels = ricci::read_gifti_columns("every.label.gii");
    if (labels.columns[0].values[1] != 7 || labels.table[0].key != 7 || labels.table[0].color[3] != 1)
        return 27;
    try {
        ricci::write_gifti_values("every.shape.gii", {{"SHAPE", "a", {1e39}}});
        return 28;
    } catch (const ricci::error &wrong) {
        return wrong.status() == RICCI_ARGUMENT ? 0 : 28;
    }
}

#endif
