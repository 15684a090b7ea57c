// Both headers are clean C++11; handles free themselves, failures throw with status and message.
#include <ricci/ricci.hpp>

#include <cmath>
#include <cstring>
#include <vector>

namespace {

// A tetrahedron whose four corners become cones of pi: the flat metric of the regular one.
int whole_job() {
    const double positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1.2, 0}, {0, 0.3, 0.9}};
    const uint32_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    ricci::mesh mesh = ricci::make<ricci_mesh>(ricci_mesh_from_arrays, positions[0], 0, 4, faces[0], 4);
    const auto counts = ricci::summary(ricci_mesh_summarise, mesh);
    if (counts.euler != 2 || counts.n_edges != 6) return 1;
    ricci::metric start =
        ricci::make<ricci_metric>(ricci_metric_new, mesh.get(), RICCI_SCHEME_TANGENTIAL, RICCI_SPACE_E2);
    const std::vector<double> target(4, 3.14159265358979323846);
    ricci::report report;
    ricci::metric end = ricci::flow(start, target.data(), 4, ricci::flow_options(), &report);
    if (!ricci::summary(ricci_report_summarise, report).converged) return 2;
    const std::vector<double> lengths = ricci::values(ricci_metric_lengths, end, 6);
    for (double l : lengths)
        if (std::abs(l / lengths[0] - 1) > 1e-9) return 3;
    return 0;
}

// One call for every closed surface; words and loops as rows.
int uniformization() {
    const ricci::mesh bolza = ricci::make<ricci_mesh>(ricci_shape_bolza, 1);
    const ricci::mesh ball = ricci::make<ricci_mesh>(ricci_shape_sphere, 2);
    const auto first = ricci::uniformize(ball);
    if (!first.first || first.second || !ricci::summary(ricci_sphere_summarise, first.first).converged)
        return 6;
    ricci_uniformize_options options = ricci::uniformize_options();
    options.base = 0;
    const auto second = ricci::uniformize(bolza, options);
    if (second.first || !second.second || ricci::summary(ricci_quotient_summarise, second.second).genus != 2)
        return 7;
    const auto octagon =
        ricci::make<ricci_dirichlet>(ricci_dirichlet_new, second.second.get(), nullptr, nullptr);
    const auto sides = ricci::make<ricci_deck>(ricci_dirichlet_sides, octagon.get());
    const auto count = ricci::summary(ricci_deck_summarise, sides);
    const auto words = ricci::values(ricci_deck_words, sides, count.n_letters, count.n_elements);
    if (count.n_elements != 8 || words.size() != 8 || words[0].empty()) return 8;
    for (double trace : ricci::values(ricci_deck_traces, sides, 8))
        if (std::abs(trace - 2 * (1 + std::sqrt(2.0))) > 1e-9) return 9;
    const auto basis = ricci::make<ricci_homotopy>(ricci_quotient_homotopy, second.second.get());
    const auto figures = ricci::summary(ricci_homotopy_summarise, basis);
    const auto loops = ricci::values(ricci_homotopy_loops, basis, figures.n_loop_edges, figures.n_generators);
    size_t edges = 0;
    for (size_t k = 0; k < loops.size(); k++) edges += loops[k].size();
    return edges == figures.n_loop_edges ? 0 : 10;
}

} // namespace

int main() {
    if (const int failed = whole_job()) return failed;
    if (const int failed = uniformization()) return failed;
    try {
        ricci::make<ricci_mesh>(ricci_mesh_read, "no such file.obj");
    } catch (const ricci::error &error) {
        return error.status == RICCI_IO && std::strstr(error.what(), "no such file.obj") ? 0 : 4;
    }
    return 5;
}
