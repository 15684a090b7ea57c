// C++ ownership and errors for the C face: handles that free themselves, statuses that throw.
//
//     ricci::mesh mesh = ricci::make<ricci_mesh>(ricci_mesh_read, "bunny.obj");
//     ricci::metric metric = ricci::make<ricci_metric>(ricci_metric_new, mesh.get(), RICCI_SCHEME_YAMABE,
//                                                      RICCI_SPACE_E2);
//     auto counts = ricci::summary(ricci_mesh_summarise, mesh);
//     std::vector<double> u = ricci::values(ricci_metric_u, metric, counts.n_vertices);
//
// C++11; nothing is hidden: every function of ricci.h takes the handles by .get().
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_HPP
#define RICCI_HPP

#include <ricci/ricci.h>

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

namespace ricci {

// A call that failed: its status, and as what() the detail message.
class error : public std::runtime_error {
public:
    explicit error(ricci_status status) : std::runtime_error(ricci_last_error()), status(status) {}
    const ricci_status status;
};

// Throws unless the call succeeded.
inline void check(ricci_status status) {
    if (status != RICCI_OK) throw error(status);
}

struct deleter {
    void operator()(ricci_mesh *p) const { ricci_mesh_free(p); }
    void operator()(ricci_diagnosis *p) const { ricci_diagnosis_free(p); }
    void operator()(ricci_repair *p) const { ricci_repair_free(p); }
    void operator()(ricci_metric *p) const { ricci_metric_free(p); }
    void operator()(ricci_report *p) const { ricci_report_free(p); }
    void operator()(ricci_solver *p) const { ricci_solver_free(p); }
    void operator()(ricci_layout *p) const { ricci_layout_free(p); }
    void operator()(ricci_charts *p) const { ricci_charts_free(p); }
    void operator()(ricci_sphere *p) const { ricci_sphere_free(p); }
    void operator()(ricci_quotient *p) const { ricci_quotient_free(p); }
    void operator()(ricci_homotopy *p) const { ricci_homotopy_free(p); }
    void operator()(ricci_domain *p) const { ricci_domain_free(p); }
    void operator()(ricci_deck *p) const { ricci_deck_free(p); }
    void operator()(ricci_dirichlet *p) const { ricci_dirichlet_free(p); }
    void operator()(ricci_control *p) const { ricci_control_free(p); }
};

template <class Handle> using owned = std::unique_ptr<Handle, deleter>;

using mesh = owned<ricci_mesh>;
using diagnosis = owned<ricci_diagnosis>;
using repair = owned<ricci_repair>;
using metric = owned<ricci_metric>;
using report = owned<ricci_report>;
using solver = owned<ricci_solver>;
using layout = owned<ricci_layout>;
using charts = owned<ricci_charts>;
using sphere = owned<ricci_sphere>;
using quotient = owned<ricci_quotient>;
using homotopy = owned<ricci_homotopy>;
using domain = owned<ricci_domain>;
using deck = owned<ricci_deck>;
using dirichlet = owned<ricci_dirichlet>;
using control = owned<ricci_control>;

// The handle that a function of ricci.h hands out through its last parameter.
template <class Handle, class Function, class... Arguments>
owned<Handle> make(Function function, Arguments &&...arguments) {
    Handle *handle = nullptr;
    check(function(std::forward<Arguments>(arguments)..., &handle));
    return owned<Handle>(handle);
}

// The struct that a _summarise function fills.
template <class Handle, class Summary>
Summary summary(ricci_status (*function)(const Handle *, Summary *, size_t), const owned<Handle> &handle) {
    Summary filled;
    check(function(handle.get(), &filled, sizeof filled));
    return filled;
}

// The array that a function copies out: `entries` is its capacity, rows times columns.
template <class Handle, class Value>
std::vector<Value> values(ricci_status (*function)(const Handle *, Value *, size_t),
                          const owned<Handle> &handle, size_t entries) {
    std::vector<Value> filled(entries);
    check(function(handle.get(), filled.data(), entries));
    return filled;
}

// Options with their defaults.
inline ricci_flow_options flow_options() {
    ricci_flow_options options;
    check(ricci_flow_options_init(&options, sizeof options));
    return options;
}

// ricci_flow; `done`, if given, receives the report.
inline metric flow(const metric &start, const double *target, size_t n_vertices,
                   const ricci_flow_options &options = flow_options(), report *done = nullptr,
                   const ricci_control *control = nullptr) {
    ricci_metric *end = nullptr;
    ricci_report *what = nullptr;
    check(ricci_flow(start.get(), target, n_vertices, &options, control, &end, done ? &what : nullptr));
    if (done) done->reset(what);
    return metric(end);
}

// Rows of different lengths, such as loops, sides and words: row i is entries[starts[i] .. starts[i + 1]).
template <class Value> struct rows {
    std::vector<Value> entries;
    std::vector<size_t> starts;
    size_t size() const { return starts.size() - 1; }
    std::vector<Value> operator[](size_t i) const {
        return {entries.begin() + static_cast<std::ptrdiff_t>(starts[i]),
                entries.begin() + static_cast<std::ptrdiff_t>(starts[i + 1])};
    }
};

// The rows that a function copies out.
template <class Handle, class Value>
rows<Value> values(ricci_status (*function)(const Handle *, Value *, size_t, size_t *, size_t),
                   const owned<Handle> &handle, size_t entries, size_t n_rows) {
    rows<Value> filled{std::vector<Value>(entries), std::vector<size_t>(n_rows + 1)};
    check(function(handle.get(), filled.entries.data(), entries, filled.starts.data(), n_rows + 1));
    return filled;
}

// Options with their defaults.
inline ricci_uniformize_options uniformize_options() {
    ricci_uniformize_options options;
    check(ricci_uniformize_options_init(&options, sizeof options));
    return options;
}

// ricci_uniformize: one of the two is not null.
inline std::pair<sphere, quotient> uniformize(const mesh &surface,
                                              const ricci_uniformize_options &options = uniformize_options(),
                                              const ricci_control *control = nullptr) {
    ricci_sphere *ball = nullptr;
    ricci_quotient *plane = nullptr;
    check(ricci_uniformize(surface.get(), &options, control, &ball, &plane));
    return {sphere(ball), quotient(plane)};
}

} // namespace ricci

#endif
