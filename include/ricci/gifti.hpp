// Files of GIFTI with notes: C++ ownership and errors, as ricci/ricci.hpp has them.
//
//     ricci::gifti_notes notes;
//     notes.add("AnatomicalStructurePrimary", "CortexLeft");
//     ricci::write_gifti_values("lh.shape.gii", {{"SHAPE", "sulc", sulc}}, &notes);
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_GIFTI_HPP
#define RICCI_GIFTI_HPP

#include <ricci/core.hpp>
#include <ricci/gifti.h>

namespace ricci {

// The way from the coordinates of a surface to those of another space: a matrix that acts on (x, y, z, 1).
struct gifti_transform {
    std::string from, to;
    std::array<double, 16> matrix; // row by row
};

using gifti_notes_handle = owned<ricci_gifti_notes, ricci_gifti_notes_free>;

// What a file says beside its numbers.
class gifti_notes : public gifti_notes_handle {
public:
    using gifti_notes_handle::gifti_notes_handle;
    gifti_notes() : gifti_notes_handle(make<ricci_gifti_notes>(ricci_gifti_notes_new)) {}
    static gifti_notes read(const std::string &path) {
        return gifti_notes(make<ricci_gifti_notes>(ricci_gifti_notes_read, path.c_str()));
    }
    void add(const std::string &name, const std::string &value) {
        check(ricci_gifti_notes_add(get(), name.c_str(), value.c_str()));
    }
    void add(const gifti_transform &way) {
        check(ricci_gifti_notes_add_transform(get(), way.from.c_str(), way.to.c_str(), way.matrix.data()));
    }
    // Names and values.
    std::vector<std::pair<std::string, std::string>> metadata() const {
        std::vector<std::pair<std::string, std::string>> all(counts().first);
        for (std::size_t k = 0; k < all.size(); k++) {
            ricci_gifti_note note;
            check(ricci_gifti_notes_get(get(), k, &note, sizeof note));
            all[k].first = note.name, all[k].second = note.value;
        }
        return all;
    }
    std::vector<gifti_transform> transforms() const {
        std::vector<gifti_transform> all(counts().second);
        for (std::size_t k = 0; k < all.size(); k++) {
            ricci_gifti_transform way;
            check(ricci_gifti_notes_transform(get(), k, &way, sizeof way));
            all[k].from = way.from, all[k].to = way.to;
            for (std::size_t i = 0; i < 16; i++) all[k].matrix[i] = way.matrix[i];
        }
        return all;
    }

private:
    std::pair<std::size_t, std::size_t> counts() const {
        std::pair<std::size_t, std::size_t> n;
        check(ricci_gifti_notes_count(get(), &n.first, &n.second));
        return n;
    }
};

// One number per vertex: "SHAPE", "LABEL", ...; its name; the numbers.
struct gifti_column {
    std::string intent, name;
    std::vector<double> values;
};

// A row of the table of labels: red, green, blue and opacity are from 0 to 1.
struct gifti_label {
    std::int32_t key;
    std::string name;
    std::array<double, 4> color;
};

// What a file of values or labels holds.
struct gifti_columns {
    std::vector<gifti_column> columns;
    std::vector<gifti_label> table;
};

inline gifti_columns read_gifti_columns(const std::string &path) {
    const owned<ricci_gifti_columns, ricci_gifti_columns_free> file(
        make<ricci_gifti_columns>(ricci_gifti_columns_read, path.c_str()));
    std::size_t n_columns = 0, n_labels = 0;
    check(ricci_gifti_columns_count(file.get(), &n_columns, &n_labels));
    gifti_columns found{std::vector<gifti_column>(n_columns), std::vector<gifti_label>(n_labels)};
    for (std::size_t k = 0; k < n_columns; k++) {
        ricci_gifti_column column;
        check(ricci_gifti_columns_get(file.get(), k, &column, sizeof column));
        found.columns[k] = {column.intent, column.name,
                            std::vector<double>(column.values, column.values + column.n)};
    }
    for (std::size_t k = 0; k < n_labels; k++) {
        ricci_gifti_label label;
        check(ricci_gifti_columns_label(file.get(), k, &label, sizeof label));
        const double *c = label.color;
        found.table[k] = {label.key, label.name, {{c[0], c[1], c[2], c[3]}}};
    }
    return found;
}

// 3 coordinates per vertex, 3 indices per face.
inline void write_gifti_surface(const std::string &path, span<double> positions, span<std::uint32_t> faces,
                                const gifti_notes *notes = nullptr) {
    if (positions.size() % 3 != 0 || faces.size() % 3 != 0)
        throw std::invalid_argument("positions and faces come in threes");
    check(ricci_gifti_surface_write(path.c_str(), positions.data(), positions.size() / 3, faces.data(),
                                    faces.size() / 3, notes ? notes->get() : nullptr));
}

// Columns of one length; all are written as "SHAPE".
inline void write_gifti_values(const std::string &path, const std::vector<gifti_column> &columns,
                               const gifti_notes *notes = nullptr) {
    const std::size_t n = columns.empty() ? 0 : columns[0].values.size();
    std::string names;
    std::vector<double> values;
    for (const gifti_column &column : columns) {
        if (column.values.size() != n) throw std::invalid_argument("columns have different lengths");
        names += column.name + "\n";
        values.insert(values.end(), column.values.begin(), column.values.end());
    }
    check(ricci_gifti_values_write(path.c_str(), names.c_str(), values.data(), n, columns.size(),
                                   notes ? notes->get() : nullptr));
}

// For each vertex a key of the table.
inline void write_gifti_labels(const std::string &path, span<std::int32_t> labels,
                               const std::vector<gifti_label> &table, const gifti_notes *notes = nullptr) {
    std::string names;
    std::vector<std::int32_t> keys;
    std::vector<double> colors;
    for (const gifti_label &row : table) {
        names += row.name + "\n";
        keys.push_back(row.key);
        colors.insert(colors.end(), row.color.begin(), row.color.end());
    }
    check(ricci_gifti_labels_write(path.c_str(), labels.data(), labels.size(), keys.data(), names.c_str(),
                                   colors.data(), table.size(), notes ? notes->get() : nullptr));
}

} // namespace ricci

#endif
