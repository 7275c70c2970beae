#pragma once
/// @file
/// Short names for the vectors and matrices used everywhere. SI units; columns of a coordinate matrix are
/// nodes.

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tautline {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using VecX = Eigen::VectorXd;
using MatX = Eigen::MatrixXd;
template <int N>
using Vec = Eigen::Matrix<double, N, 1>;
template <int R, int C = R>
using Mat = Eigen::Matrix<double, R, C>;

using Points = std::vector<Vec3>;

}  // namespace tautline
