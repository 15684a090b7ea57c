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

} // namespace

int main() {
    if (const int failed = whole_job()) return failed;
    try {
        ricci::make<ricci_mesh>(ricci_mesh_read, "no such file.obj");
    } catch (const ricci::error &error) {
        return error.status == RICCI_IO && std::strstr(error.what(), "no such file.obj") ? 0 : 4;
    }
    return 5;
}
