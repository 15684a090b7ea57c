// Splines over layouts of four-sided patches: C++ ownership and errors, as ricci/ricci.hpp has them.
//
//     const ricci::seamless flat(mesh);
//     const ricci::quad_spline spline(flat);
//     const std::vector<double> poles = spline.poles(0);  // of the first patch
//     spline.write_step("part.step");
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_QUAD_SPLINE_HPP
#define RICCI_QUAD_SPLINE_HPP

#include <ricci/bicubic.hpp>
#include <ricci/quad_spline.h>
#include <ricci/quads.hpp>

namespace ricci {

// Distinct knots, and how often each occurs.
struct knot_list {
    std::vector<double> knots;
    std::vector<std::uint32_t> multiplicities;
};

// A sparse matrix by rows: the entries of row i are starts[i] to starts[i + 1] - 1.
struct extraction_matrix {
    std::vector<std::size_t> starts;
    std::vector<std::uint32_t> columns;
    std::vector<double> values;
};

using quad_spline_handle = owned<ricci_quad_spline, ricci_quad_spline_free>;

// A spline over a layout of four-sided patches.
class quad_spline : public quad_spline_handle {
public:
    explicit quad_spline(ricci_quad_spline *handle) : quad_spline_handle(handle) {}
    // With few patches near a mesh; edges at which it turns by the angle stay sharp, none for 0.
    explicit quad_spline(const mesh &near, double feature_angle = 0,
                         const ricci_quad_spline_options &options = init<ricci_quad_spline_options>(),
                         const control *watched = nullptr)
        : quad_spline_handle(make<ricci_quad_spline>(ricci_quad_spline_fit_mesh, near.get(), feature_angle,
                                                     &options, of(watched))) {}
    // On the coarsest layout.
    explicit quad_spline(const seamless &on,
                         const ricci_quad_spline_options &options = init<ricci_quad_spline_options>(),
                         const control *watched = nullptr)
        : quad_spline_handle(
              make<ricci_quad_spline>(ricci_quad_spline_fit, on.get(), nullptr, &options, of(watched))) {}
    quad_spline(const seamless &on, const quad_layout &layout,
                const ricci_quad_spline_options &options = init<ricci_quad_spline_options>(),
                const control *watched = nullptr)
        : quad_spline_handle(make<ricci_quad_spline>(ricci_quad_spline_fit, on.get(), layout.get(), &options,
                                                     of(watched))) {}
    // Near the Catmull-Clark surface of a control mesh.
    explicit quad_spline(const ricci_control_mesh &control_mesh,
                         const ricci_quad_spline_options &options = init<ricci_quad_spline_options>(),
                         const control *watched = nullptr)
        : quad_spline_handle(
              make<ricci_quad_spline>(ricci_quad_spline_fit_quads, &control_mesh, &options, of(watched))) {}
    ricci_quad_spline_summary summary() const { return ricci::summary(ricci_quad_spline_summarise, get()); }
    // The patches that are turned over somewhere.
    std::vector<std::uint32_t> folds() const { return values<std::uint32_t>(ricci_quad_spline_folds, get()); }
    ricci_quad_patch patch(std::size_t number) const {
        ricci_quad_patch found = init<ricci_quad_patch>();
        check(ricci_quad_spline_patch(get(), number, &found, sizeof found));
        return found;
    }
    // x, y, z of pole i along u and j along v at i n_poles[1] + j.
    std::vector<double> poles(std::size_t patch) const {
        return values<double>(ricci_quad_spline_poles, get(), patch);
    }
    // Along RICCI_ALONG_U or RICCI_ALONG_V.
    knot_list knots(std::size_t patch, std::uint32_t along) const {
        const std::size_t n = this->patch(patch).n_knots[along == RICCI_ALONG_U ? 0 : 1];
        knot_list found{std::vector<double>(n), std::vector<std::uint32_t>(n)};
        check(ricci_quad_spline_knots(get(), patch, along, found.knots.data(), n, found.multiplicities.data(),
                                      n));
        return found;
    }
    // The numbers of the control points of a patch, in the order of its poles.
    std::vector<std::uint32_t> controls(std::size_t patch) const {
        return values<std::uint32_t>(ricci_quad_spline_controls, get(), patch);
    }
    ricci_quad_arc arc(std::size_t number) const {
        ricci_quad_arc found = init<ricci_quad_arc>();
        check(ricci_quad_spline_arc(get(), number, &found, sizeof found));
        return found;
    }
    // x, y, z of each pole from the start of an arc to its end.
    std::vector<double> arc_poles(std::size_t arc) const {
        return values<double>(ricci_quad_spline_arc_poles, get(), arc);
    }
    // The quantities of the surface at places, u and v each, in these patches.
    std::vector<double> evaluate(span<std::uint32_t> patches, span<double> parameters,
                                 std::uint32_t which = RICCI_QUAD_SPLINE_POINT,
                                 const control *watched = nullptr) const {
        if (2 * patches.size() != parameters.size()) throw std::invalid_argument("u and v for every patch");
        ricci_spline_places places = init<ricci_spline_places>();
        places.patches = patches.data(), places.parameters = parameters.data();
        places.n = patches.size();
        return values<double>(ricci_quad_spline_evaluate, get(), &places, which, of(watched));
    }
    // The nearest places to points, 3 coordinates each.
    closest_points closest(span<double> points, const control *watched = nullptr) const {
        const std::size_t n = points.size() / 3;
        closest_points found{std::vector<std::uint32_t>(n), std::vector<double>(6 * n)};
        check(ricci_quad_spline_closest(get(), points.data(), n, of(watched), found.patches.data(),
                                        found.values.data(), 6 * n));
        return found;
    }
    // With so many parts of each side.
    mesh tessellated(std::size_t parts, const control *watched = nullptr) const {
        return mesh(make<ricci_mesh>(ricci_quad_spline_tessellate, get(), parts, 0.0, of(watched)));
    }
    // No farther from the surface than this.
    mesh tessellated_within(double tolerance, const control *watched = nullptr) const {
        return mesh(
            make<ricci_mesh>(ricci_quad_spline_tessellate, get(), std::size_t(0), tolerance, of(watched)));
    }
    // The patch of each face of a mesh of the surface.
    std::vector<std::uint32_t> patch_of_faces(const mesh &surface, const control *watched = nullptr) const {
        return values<std::uint32_t>(ricci_quad_spline_patch_of_faces, get(), surface.get(), of(watched));
    }
    extraction_matrix extraction() const {
        const ricci_quad_spline_summary all = summary();
        extraction_matrix found{std::vector<std::size_t>(all.n_control_points + 1),
                                std::vector<std::uint32_t>(all.n_entries),
                                std::vector<double>(all.n_entries)};
        check(ricci_quad_spline_extraction(get(), found.columns.data(), all.n_entries, found.values.data(),
                                           all.n_entries, found.starts.data(), found.starts.size()));
        return found;
    }
    // Per span 6 x 6 weights of control points in Bezier points.
    std::vector<double> bezier(std::size_t patch, std::uint32_t along) const {
        return values<double>(ricci_quad_spline_bezier, get(), patch, along);
    }
    // Writes the patches as .step or .stp.
    void write_step(const std::string &path,
                    const ricci_step_options &options = init<ricci_step_options>()) const {
        check(ricci_quad_spline_write_step(get(), &options, path.c_str()));
    }
    void write_json(const std::string &path) const {
        check(ricci_quad_spline_write_json(get(), path.c_str()));
    }
};

} // namespace ricci

#endif
