// Eigen matrices in and out, as libigl has them: V (n x 3), F (m x 3), of any scalar and storage order.
//
//     const auto flat = ricci::flow(ricci::metric(ricci::eigen::from(V, F)), ricci::target::automatic(8));
//     const ricci::layout layout(flat);
//     const auto UV = ricci::eigen::points(layout);  // n_points x 2: vertices on seams have several
//     const auto FUV = ricci::eigen::corners(layout); // m x 3: rows of UV
//     const Eigen::VectorXd factor = ricci::eigen::factor(flat);
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_EIGEN_HPP
#define RICCI_EIGEN_HPP

#include <Eigen/Core>
#include <ricci/core.hpp>

namespace ricci {
namespace eigen {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

// The mesh, vertices and faces in the order of the rows.
template <class Positions, class Faces>
ricci::mesh from(const Eigen::MatrixBase<Positions> &V, const Eigen::MatrixBase<Faces> &F) {
    if (V.cols() != 3 || F.cols() != 3) throw std::invalid_argument("V and F have three columns");
    const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> positions = V.template cast<double>();
    const Triangles faces = F.template cast<int>();
    return ricci::mesh::from(span<double>(positions.data(), static_cast<std::size_t>(positions.size())),
                             span<int>(faces.data(), static_cast<std::size_t>(faces.size())));
}

// Numbers of the library as a column.
inline Eigen::VectorXd column(const std::vector<double> &values) {
    return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// The conformal factor of every vertex (RICCI_METRIC_FACTOR).
inline Eigen::VectorXd factor(const metric &flat) { return column(flat.factor()); }

// The curvature of every vertex.
inline Eigen::VectorXd curvature(const metric &flat) { return column(flat.curvature()); }

// The points of a layout in a model with two coordinates.
inline Points points(const layout &laid, std::uint32_t model = RICCI_MODEL_POINCARE) {
    const std::vector<double> values = laid.points(model);
    return Eigen::Map<const Points>(values.data(), static_cast<Eigen::Index>(values.size() / 2), 2);
}

// The row of `points` at every corner of every face: of the caller's F, by default.
inline Triangles corners(const layout &laid, std::uint32_t on = RICCI_ON_INPUT) {
    const std::vector<std::uint32_t> values = laid.corners(on);
    using Rows = Eigen::Matrix<std::uint32_t, Eigen::Dynamic, 3, Eigen::RowMajor>;
    return Eigen::Map<const Rows>(values.data(), static_cast<Eigen::Index>(values.size() / 3), 3).cast<int>();
}

} // namespace eigen
} // namespace ricci

#endif
