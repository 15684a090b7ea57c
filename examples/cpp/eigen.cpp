// V and F as in libigl are flattened with eight cones that the library places: UV and FUV, a factor per
// vertex, the distortion.
#include <iostream>
#include <ricci/eigen.hpp>

int main(int argc, char **argv) {
    try {
        const auto mesh = ricci::mesh::read(argc > 1 ? argv[1] : "mesh.obj");
        const auto read = mesh.positions();
        const auto numbers = mesh.faces();
        using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
        using Indices = Eigen::Matrix<std::uint32_t, Eigen::Dynamic, 3, Eigen::RowMajor>;
        const Eigen::MatrixXd V = Eigen::Map<const Rows>(read.data(), Eigen::Index(read.size() / 3), 3);
        const Eigen::MatrixXi F =
            Eigen::Map<const Indices>(numbers.data(), Eigen::Index(numbers.size() / 3), 3).cast<int>();

        const auto flat = ricci::flow(ricci::metric(ricci::eigen::from(V, F)), ricci::target::automatic(8));
        const ricci::layout layout(flat);
        const auto UV = ricci::eigen::points(layout);
        const auto FUV = ricci::eigen::corners(layout);
        const Eigen::VectorXd factor = ricci::eigen::factor(flat);
        const auto figures = layout.summary();
        std::cout << flat.report().stop_reason_text << ", " << flat.cones().size() << " cones\n"
                  << V.rows() << " vertices, " << UV.rows() << " points; corner 0 of face 0 at ("
                  << UV.row(FUV(0, 0)) << ")\nlog scale " << factor.minCoeff() << " to " << factor.maxCoeff()
                  << "\ndilatation " << figures.qc_mean << " (mean) " << figures.qc_max
                  << " (max), area ratio " << figures.area_ratio_min << " to " << figures.area_ratio_max
                  << "\n";
        return flat.report().converged && figures.n_flipped == 0 && FUV.rows() == F.rows() ? 0 : 1;
    } catch (const ricci::error &error) {
        std::cerr << ricci_status_text(error.status()) << ": " << error.what() << "\n";
        return 1;
    }
}
