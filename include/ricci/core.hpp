// C++ ownership and errors for the C face: handles that free themselves, failures that throw, queries that
// return vectors.
//
//     const auto mesh = ricci::mesh::read("bunny.obj");
//     const auto flat = ricci::flow(ricci::metric(mesh), ricci::target::automatic(8));
//     const ricci::layout layout(flat);
//     const std::vector<double> uv = layout.uv(), factor = flat.factor();
//
// C++11; nothing is hidden: every function of the C headers takes the handles by .get(), and ricci::make,
// ricci::values and ricci::rows call those that have no method here. Objects are moved, not copied. This
// header has what flattening takes; ricci/ricci.hpp includes it and those of all other themes.
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_CORE_HPP
#define RICCI_CORE_HPP

#include <ricci/ricci.h>
#include <ricci/shapes.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace ricci {

// The exception of a call that failed: its message is what(), with the numbers of the failure.
class error : public std::runtime_error {
public:
    error() : std::runtime_error(ricci_last_error()), failure_() {
        const ricci_status told = ricci_last_failure(&failure_, sizeof failure_);
        if (told != RICCI_OK) failure_.status = told;
    }
    ricci_status status() const { return failure_.status; }
    // RICCI_ELEMENT_*, and its index: -1 where the failure has no number of one.
    std::uint32_t element() const { return failure_.element; }
    std::int64_t index() const { return failure_.index; }
    double amount() const { return failure_.amount; }
    std::size_t needed() const { return failure_.needed; }

private:
    ricci_failure failure_;
};

// Throws unless the call succeeded.
inline void check(ricci_status status) {
    if (status != RICCI_OK) throw error();
}

// A view of numbers that lie one after the other and that somebody else owns.
template <class Value> class span {
public:
    span() : data_(nullptr), size_(0) {}
    span(const Value *data, std::size_t size) : data_(data), size_(size) {}
    template <std::size_t N> span(const Value (&values)[N]) : data_(values), size_(N) {}
    // From std::vector, std::array, std::span and other containers with data() and size().
    template <class List, class = decltype(std::declval<const List &>().data())>
    span(const List &list) : data_(list.data()), size_(list.size()) {}
    const Value *data() const { return data_; }
    std::size_t size() const { return size_; }

private:
    const Value *data_;
    std::size_t size_;
};

// A struct that ricci_init has zeroed, which means the defaults.
template <class Options> Options init() {
    Options options;
    check(ricci_init(&options, sizeof options));
    return options;
}

// A handle that is freed with its owner.
template <class Handle, void (*Free)(Handle *)> class owned {
public:
    owned() : handle_(nullptr) {}
    explicit owned(Handle *handle) : handle_(handle) {}
    owned(owned &&other) noexcept : handle_(other.release()) {}
    owned &operator=(owned &&other) noexcept {
        if (this != &other) {
            Free(handle_);
            handle_ = other.release();
        }
        return *this;
    }
    owned(const owned &) = delete;
    owned &operator=(const owned &) = delete;
    ~owned() { Free(handle_); }
    Handle *get() const { return handle_; }
    Handle *release() {
        Handle *handle = handle_;
        handle_ = nullptr;
        return handle;
    }
    explicit operator bool() const { return handle_ != nullptr; }

protected:
    Handle *handle_;
};

// The handle that a function returns through its last parameter.
template <class Handle, class Function, class... Arguments>
Handle *make(Function function, Arguments... arguments) {
    Handle *handle = nullptr;
    check(function(arguments..., &handle));
    return handle;
}

// The struct that a _summarise function fills.
template <class Handle, class Summary>
Summary summary(ricci_status (*function)(const Handle *, Summary *, std::size_t), const Handle *handle) {
    Summary filled;
    check(function(handle, &filled, sizeof filled));
    return filled;
}

// The array that a function copies out through its last two parameters.
template <class Value, class Function, class... Arguments>
std::vector<Value> values(Function function, Arguments... arguments) {
    std::vector<Value> filled;
    const ricci_status asked = function(arguments..., static_cast<Value *>(nullptr), std::size_t(0));
    if (asked == RICCI_OK) return filled;
    const error why;
    if (asked != RICCI_BUFFER_TOO_SMALL) throw why;
    filled.resize(why.needed());
    check(function(arguments..., filled.data(), filled.size()));
    return filled;
}

// The text that a function copies out through its last three parameters: bytes with a zero at the end, their
// capacity, and how many there are.
template <class Function, class... Arguments> std::string text_of(Function function, Arguments... arguments) {
    std::size_t n = 0;
    check(function(arguments..., static_cast<char *>(nullptr), std::size_t(0), &n));
    std::vector<char> bytes(n);
    check(function(arguments..., bytes.data(), n, &n));
    return std::string(bytes.data());
}

// Lists of different lengths, such as loops, sides and words: list i is entries[starts[i] .. starts[i + 1]).
template <class Value> struct lists {
    std::vector<Value> entries;
    std::vector<std::size_t> starts;
    std::size_t size() const { return starts.size() - 1; }
    std::vector<Value> operator[](std::size_t i) const {
        const Value *data = entries.data();
        return std::vector<Value>(data + starts[i], data + starts[i + 1]);
    }
};

// The n lists that a function copies out through its last four parameters.
template <class Value, class Function, class... Arguments>
lists<Value> rows(std::size_t n, Function function, Arguments... arguments) {
    lists<Value> filled;
    filled.starts.resize(n + 1);
    const ricci_status asked =
        function(arguments..., static_cast<Value *>(nullptr), std::size_t(0), filled.starts.data(), n + 1);
    if (asked == RICCI_OK) return filled;
    const error why;
    if (asked != RICCI_BUFFER_TOO_SMALL) throw why;
    filled.entries.resize(why.needed());
    check(function(arguments..., filled.entries.data(), filled.entries.size(), filled.starts.data(), n + 1));
    return filled;
}

using control_handle = owned<ricci_control, ricci_control_free>;

// Progress of a long call, and the means to cancel it from another thread.
class control : public control_handle {
public:
    control() : control_handle(make<ricci_control>(ricci_control_new)) {}
    void cancel() const { check(ricci_control_cancel(handle_)); }
    // The number of threads of calls that have no option for it: 0, the default, is one for each core.
    void set_threads(std::size_t threads) const { check(ricci_control_set_threads(handle_, threads)); }
    // The part of the whole progress that the next calls fill: 0 <= from <= to <= 1.
    void set_part(double from, double to) const { check(ricci_control_part(handle_, from, to)); }
    // RICCI_STAGE_*, and the fraction of the whole call that is done.
    std::pair<std::uint32_t, double> progress() const {
        std::pair<std::uint32_t, double> now;
        check(ricci_control_progress(handle_, &now.first, &now.second, nullptr));
        return now;
    }
};

// As long as it lives, the control serves the calls of this thread that are given none: reading, building,
// writing.
class control_scope {
public:
    explicit control_scope(const control &used) { check(ricci_control_use(used.get())); }
    ~control_scope() { (void)!ricci_control_use(nullptr); }
    control_scope(const control_scope &) = delete;
    control_scope &operator=(const control_scope &) = delete;
};

// The pointer that a call takes for a control; NULL without one.
inline const ricci_control *of(const control *watched) { return watched ? watched->get() : nullptr; }

using mesh_handle = owned<ricci_mesh, ricci_mesh_free>;

class mesh : public mesh_handle {
public:
    using mesh_handle::mesh_handle;
    // 3 coordinates per vertex, 3 indices per face (std::uint32_t or int).
    template <class Index> static mesh from(span<double> positions, span<Index> faces) {
        static_assert(std::is_integral<Index>::value && sizeof(Index) == 4, "indices of 32 bits");
        if (positions.size() % 3 != 0 || faces.size() % 3 != 0)
            throw std::invalid_argument("positions and faces come in threes");
        return mesh(
            make<ricci_mesh>(ricci_mesh_from_arrays, positions.data(), std::size_t(0), positions.size() / 3,
                             reinterpret_cast<const std::uint32_t *>(faces.data()), faces.size() / 3));
    }
    template <class Index>
    static mesh from(const std::vector<double> &positions, const std::vector<Index> &faces) {
        return from(span<double>(positions), span<Index>(faces));
    }
    static mesh read(const std::string &path) {
        return mesh(make<ricci_mesh>(ricci_mesh_read, path.c_str()));
    }
    static mesh made(const ricci_shape &shape) { return mesh(make<ricci_mesh>(ricci_make, &shape)); }
    mesh with_lengths(span<double> lengths, std::uint32_t geometry = RICCI_SPACE_E2) const {
        return mesh(
            make<ricci_mesh>(ricci_mesh_with_lengths, get(), lengths.data(), lengths.size(), geometry));
    }
    void write(const std::string &path, const ricci_attributes *attributes = nullptr) const {
        check(ricci_mesh_write(handle_, attributes, path.c_str()));
    }
    ricci_mesh_summary summary() const { return ricci::summary(ricci_mesh_summarise, get()); }
    ricci_quality_summary quality() const { return ricci::summary(ricci_mesh_quality, get()); }
    std::vector<double> values(std::uint32_t which) const {
        return ricci::values<double>(ricci_mesh_values, get(), which);
    }
    std::vector<double> positions() const { return values(RICCI_POSITIONS); }
    std::vector<double> lengths() const { return values(RICCI_LENGTHS); }
    std::vector<std::uint32_t> faces() const { return ricci::values<std::uint32_t>(ricci_mesh_faces, get()); }
    std::vector<std::uint32_t> edges() const { return ricci::values<std::uint32_t>(ricci_mesh_edges, get()); }
    std::vector<std::int32_t> face_edges() const {
        return ricci::values<std::int32_t>(ricci_mesh_face_edges, get());
    }
    lists<std::uint32_t> boundary() const {
        return rows<std::uint32_t>(summary().n_boundary_loops, ricci_mesh_boundary, get());
    }
};

// A target by rule or by value, which keeps its arrays.
class target {
public:
    target() : target(RICCI_TARGET_DEFAULT, 0) {}
    static target uniform() { return target(RICCI_TARGET_UNIFORM, 0); }
    static target boundary() { return target(RICCI_TARGET_BOUNDARY, 0); }
    // The outer loop keeps its lengths, and holes are filled: the longest loop, or that through a vertex.
    static target outer() { return target(RICCI_TARGET_OUTER, 0); }
    static target outer(std::uint32_t vertex) {
        target all(RICCI_TARGET_OUTER, 1);
        all.vertices_.assign(1, vertex);
        return all;
    }
    static target automatic(std::size_t cones) { return target(RICCI_TARGET_AUTO, cones); }
    static target single(std::uint32_t vertex) {
        target all(RICCI_TARGET_SINGLE, 1);
        all.vertices_.assign(1, vertex);
        return all;
    }
    static target cones(span<std::uint32_t> vertices, span<double> curvatures) {
        if (vertices.size() != curvatures.size())
            throw std::invalid_argument("as many curvatures as vertices");
        target all(RICCI_TARGET_CONES, vertices.size());
        all.vertices_.assign(vertices.data(), vertices.data() + vertices.size());
        all.curvatures_.assign(curvatures.data(), curvatures.data() + curvatures.size());
        return all;
    }
    static target given(span<double> curvatures) {
        target all(RICCI_TARGET_GIVEN, curvatures.size());
        all.curvatures_.assign(curvatures.data(), curvatures.data() + curvatures.size());
        return all;
    }
    // Valid as long as the target.
    ricci_target get() const {
        ricci_target all = init<ricci_target>();
        all.kind = kind_, all.n = n_, all.vertices = vertices_.data(), all.curvatures = curvatures_.data();
        return all;
    }

private:
    target(std::uint32_t kind, std::size_t n) : kind_(kind), n_(n) {}
    std::uint32_t kind_;
    std::size_t n_;
    std::vector<std::uint32_t> vertices_;
    std::vector<double> curvatures_;
};

using metric_handle = owned<ricci_metric, ricci_metric_free>;

class metric : public metric_handle {
public:
    using metric_handle::metric_handle;
    explicit metric(const mesh &on, std::uint32_t scheme = RICCI_SCHEME_YAMABE,
                    std::uint32_t space = RICCI_SPACE_E2)
        : metric_handle(make<ricci_metric>(ricci_metric_new, on.get(), scheme, space)) {}
    ricci_metric_summary summary() const { return ricci::summary(ricci_metric_summarise, get()); }
    std::vector<double> values(std::uint32_t which) const {
        return ricci::values<double>(ricci_metric_values, get(), which);
    }
    std::vector<double> factor() const { return values(RICCI_METRIC_FACTOR); }
    std::vector<double> curvature() const { return values(RICCI_METRIC_CURVATURE); }
    std::vector<double> lengths() const { return values(RICCI_METRIC_LENGTH); }
    std::vector<std::uint32_t> mirror() const {
        return ricci::values<std::uint32_t>(ricci_metric_mirror, get());
    }
    ricci::mesh triangulation() const { return ricci::mesh(make<ricci_mesh>(ricci_metric_mesh, get())); }
    std::vector<double> resolve(const target &asked, const control *watched = nullptr) const {
        const ricci_target all = asked.get();
        return ricci::values<double>(ricci_target_fill, get(), &all, of(watched));
    }
    // The report of the flow that led to this metric.
    ricci_report_summary report() const { return ricci::summary(ricci_report_summarise, get()); }
    std::vector<double> report_values(std::uint32_t which) const {
        return ricci::values<double>(ricci_report_values, get(), which);
    }
    std::vector<std::uint32_t> report_vertices(std::uint32_t which) const {
        return ricci::values<std::uint32_t>(ricci_report_vertices, get(), which);
    }
    std::vector<std::uint32_t> cones() const { return report_vertices(RICCI_REPORT_CONES); }
};

inline metric flow(const metric &start, const target &asked = target(),
                   const ricci_flow_options &options = init<ricci_flow_options>(),
                   const control *watched = nullptr) {
    const ricci_target all = asked.get();
    return metric(make<ricci_metric>(ricci_flow, start.get(), &all, &options, of(watched)));
}

using solver_handle = owned<ricci_solver, ricci_solver_free>;

class solver : public solver_handle {
public:
    explicit solver(const metric &start, const ricci_flow_options &options = init<ricci_flow_options>())
        : solver_handle(make<ricci_solver>(ricci_solver_new, start.get(), &options)) {}
    void pin(span<std::uint32_t> vertices) {
        check(ricci_solver_pin(handle_, vertices.data(), vertices.size()));
    }
    metric solve(const target &asked, const control *watched = nullptr) {
        const ricci_target all = asked.get();
        return metric(make<ricci_metric>(ricci_solver_solve, get(), &all, of(watched)));
    }
};

using layout_handle = owned<ricci_layout, ricci_layout_free>;

class layout : public layout_handle {
public:
    using layout_handle::layout_handle;
    explicit layout(const metric &flat, const ricci_layout_options &options = init<ricci_layout_options>(),
                    const control *watched = nullptr)
        : layout_handle(make<ricci_layout>(ricci_layout_new, flat.get(), &options, of(watched))) {}
    ricci_layout_summary summary() const { return ricci::summary(ricci_layout_summarise, get()); }
    // u, v of every corner of every face: of the caller's mesh, by default.
    std::vector<double> uv(std::uint32_t on = RICCI_ON_INPUT) const {
        return values<double>(ricci_layout_uv, get(), on);
    }
    std::vector<std::uint32_t> corners(std::uint32_t on = RICCI_ON_INPUT) const {
        return values<std::uint32_t>(ricci_layout_corners, get(), on);
    }
    std::vector<double> points(std::uint32_t model) const {
        return values<double>(ricci_layout_points, get(), model);
    }
    std::vector<double> seams() const { return values<double>(ricci_layout_seams, get()); }
    lists<std::int32_t> seam_edges(std::uint32_t on = RICCI_ON_INPUT) const {
        return rows<std::int32_t>(summary().n_seams, ricci_layout_seam_edges, get(), on);
    }
    std::vector<std::uint32_t> flipped(std::uint32_t on = RICCI_ON_INPUT) const {
        return values<std::uint32_t>(ricci_layout_flipped, get(), on);
    }
    // Dilatations and area ratios of every face: of the caller's mesh, by default.
    std::pair<std::vector<double>, std::vector<double>> distortion(std::uint32_t on = RICCI_ON_INPUT) const {
        const ricci_layout_summary all = summary();
        const std::size_t n = on == RICCI_ON_INPUT ? all.n_input_faces : all.n_faces;
        std::pair<std::vector<double>, std::vector<double>> both{std::vector<double>(n),
                                                                 std::vector<double>(n)};
        check(ricci_layout_distortion(handle_, on, both.first.data(), both.second.data(), n));
        return both;
    }
    ricci::mesh laid_out() const { return ricci::mesh(make<ricci_mesh>(ricci_layout_mesh, get())); }
    // OBJ with texture coordinates: the caller's mesh, by default.
    void write(const std::string &path, std::uint32_t on = RICCI_ON_INPUT, bool homogeneous = false) const {
        check(ricci_layout_write(handle_, on, homogeneous ? 1 : 0, path.c_str()));
    }
    // Four numbers for each line along which the layout is cut or folded: RICCI_LAYER_*, the seam or -1, 1 if
    // it is closed, the number of its points. The angle is in radians.
    std::vector<std::int32_t> lines(double fold_angle, std::uint32_t on = RICCI_ON_INPUT) const {
        return values<std::int32_t>(ricci_layout_lines, get(), on, fold_angle);
    }
    std::vector<std::uint32_t> line_points(double fold_angle, std::uint32_t on = RICCI_ON_INPUT) const {
        return values<std::uint32_t>(ricci_layout_line_points, get(), on, fold_angle);
    }
    // The layout as geometry: a mesh of points (x, y, 0), or lines for cutting (.svg, .dxf).
    void write_flat(const std::string &path, double fold_angle, std::uint32_t on = RICCI_ON_INPUT,
                    std::uint32_t unit = RICCI_SHEET_MILLIMETRE) const {
        check(ricci_layout_write_flat(handle_, on, fold_angle, unit, path.c_str()));
    }
};

using map_handle = owned<ricci_map, ricci_map_free>;

class map : public map_handle {
public:
    using map_handle::map_handle;
    explicit map(const metric &flat, const control *watched = nullptr)
        : map_handle(make<ricci_map>(ricci_map_new, flat.get(), of(watched))) {}
    ricci_map_summary summary() const { return ricci::summary(ricci_map_summarise, get()); }
    ricci::mesh refinement() const { return ricci::mesh(make<ricci_mesh>(ricci_map_mesh, get())); }
    std::vector<std::uint32_t> faces(std::uint32_t on) const {
        return values<std::uint32_t>(ricci_map_faces, get(), on);
    }
    std::vector<double> barycentric(std::uint32_t on) const {
        return values<double>(ricci_map_barycentric, get(), on);
    }
    std::vector<double> weights() const { return values<double>(ricci_map_weights, get()); }
    std::vector<double> carry(const ricci_carried &given) const {
        return values<double>(ricci_map_carry, get(), &given);
    }
};

} // namespace ricci

#endif
