#include "processing/calibration/lens/reprojection.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/normal_prior.h>
#include <ceres/problem.h>
#include <ceres/rotation.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <limits>
#include <memory>

#include "processing/calibration/lens/chi_square.h"

namespace lumitexel {
namespace {

constexpr double kOneInAThousand_z = 3.09;
using PoseVector = Eigen::Matrix<double, 6, 1>;  // rotation vector, translation

PoseVector pose_vector(const Eigen::Isometry3d& pose) {
  const Eigen::AngleAxisd turn(pose.rotation());
  PoseVector result;
  result << turn.angle() * turn.axis(), pose.translation();
  return result;
}

Eigen::Isometry3d pose_of(const PoseVector& vector) {
  const double angle = vector.head<3>().norm();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (angle > 0.0) pose.linear() = Eigen::AngleAxisd(angle, vector.head<3>() / angle).toRotationMatrix();
  pose.translation() = vector.tail<3>();
  return pose;
}

struct LandmarkResidual {
  const Landmark& landmark;
  Eigen::MatrixXd whitening;  // L^-1

  explicit LandmarkResidual(const Landmark& l)
      : landmark(l),
        whitening(l.covariance_px2.llt().matrixL().solve(
            Eigen::MatrixXd::Identity(l.covariance_px2.rows(), l.covariance_px2.cols()))) {}

  // The model of camera_model.cpp, differentiable.
  template <typename T>
  bool operator()(const T* lens, const T* pose, T* residual) const {
    Eigen::Matrix<T, Eigen::Dynamic, 1> miss(whitening.rows());
    for (std::size_t i = 0; i < landmark.pixels.size(); ++i) {
      const Eigen::Matrix<T, 3, 1> x = landmark.x_in_board[i].cast<T>();
      T p[3];
      ceres::AngleAxisRotatePoint(pose, x.data(), p);
      for (int k = 0; k < 3; ++k) p[k] += pose[3 + k];
      if (!(p[2] > 0.0)) return false;
      const T u = p[0] / p[2], v = p[1] / p[2], r2 = u * u + v * v;
      const T radial = 1.0 + r2 * (lens[4] + r2 * lens[5]);
      const T du = u * radial + 2.0 * lens[6] * u * v + lens[7] * (r2 + 2.0 * u * u);
      const T dv = v * radial + lens[6] * (r2 + 2.0 * v * v) + 2.0 * lens[7] * u * v;
      miss[static_cast<Eigen::Index>(2 * i)] = lens[0] * du + lens[2] - landmark.pixels[i].x();
      miss[static_cast<Eigen::Index>(2 * i + 1)] = lens[1] * dv + lens[3] - landmark.pixels[i].y();
    }
    Eigen::Map<Eigen::Matrix<T, Eigen::Dynamic, 1>>(residual, whitening.rows()) = whitening.cast<T>() * miss;
    return true;
  }
};

using Cost = ceres::AutoDiffCostFunction<LandmarkResidual, ceres::DYNAMIC, kLensParameters, 6>;

std::unique_ptr<Cost> cost_of(const Landmark& landmark) {
  return std::make_unique<Cost>(new LandmarkResidual(landmark), static_cast<int>(2 * landmark.pixels.size()));
}

double worst_expected(const Landmark& landmark) {
  return std::sqrt(chi2_bound(2.0 * static_cast<double>(landmark.pixels.size()), kOneInAThousand_z));
}

}  // namespace

bool refine_boards(CameraModel& camera, const LensMask& free, std::vector<PlacedBoard>& boards,
                   const std::optional<LensPull>& pull) {
  LensVector lens = lens_vector(camera);
  std::vector<PoseVector> poses;
  for (const PlacedBoard& board : boards) poses.push_back(pose_vector(board.camera_from_board));
  ceres::Problem problem;
  problem.AddParameterBlock(lens.data(), kLensParameters);
  for (std::size_t b = 0; b < boards.size(); ++b) {
    for (const Landmark& landmark : boards[b].sighting.landmarks) {
      problem.AddResidualBlock(cost_of(landmark).release(), new ceres::HuberLoss(worst_expected(landmark)), lens.data(),
                               poses[b].data());
    }
  }
  if (pull) {
    // U^T U is the information.
    const Eigen::MatrixXd root = pull->information.llt().matrixU();
    problem.AddResidualBlock(new ceres::NormalPrior(root, pull->mean), nullptr, lens.data());
  }
  std::vector<int> fixed;
  for (int i = 0; i < kLensParameters; ++i) {
    if (!free[static_cast<std::size_t>(i)]) fixed.push_back(i);
  }
  if (static_cast<int>(fixed.size()) == kLensParameters) {
    problem.SetParameterBlockConstant(lens.data());
  } else if (!fixed.empty()) {
    problem.SetManifold(lens.data(), new ceres::SubsetManifold(kLensParameters, fixed));
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-10;
  options.parameter_tolerance = 1e-12;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (PoseVector& pose : poses) options.linear_solver_ordering->AddElementToGroup(pose.data(), 0);
  options.linear_solver_ordering->AddElementToGroup(lens.data(), 1);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable() || !lens.allFinite()) return false;
  camera = with_lens_vector(camera, lens);
  for (std::size_t b = 0; b < boards.size(); ++b) boards[b].camera_from_board = pose_of(poses[b]);
  return summary.termination_type == ceres::CONVERGENCE;
}

PoseFreeResiduals pose_free_residuals(const CameraModel& camera, const PlacedBoard& board) {
  const LensVector lens = lens_vector(camera);
  const PoseVector pose = pose_vector(board.camera_from_board);
  const auto rows = static_cast<Eigen::Index>(2 * board.sighting.points());
  Eigen::VectorXd residual = Eigen::VectorXd::Zero(rows);
  Eigen::MatrixXd by_lens = Eigen::MatrixXd::Zero(rows, kLensParameters), by_pose = Eigen::MatrixXd::Zero(rows, 6);
  Eigen::Index at = 0;
  for (const Landmark& landmark : board.sighting.landmarks) {
    const auto n = static_cast<Eigen::Index>(2 * landmark.pixels.size());
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    RowMajor lens_slope(n, kLensParameters), pose_slope(n, 6);
    const double* parameters[] = {lens.data(), pose.data()};
    double* slopes[] = {lens_slope.data(), pose_slope.data()};
    if (cost_of(landmark)->Evaluate(parameters, residual.data() + at, slopes)) {
      by_lens.middleRows(at, n) = lens_slope;
      by_pose.middleRows(at, n) = pose_slope;
    }
    at += n;
  }
  if (rows <= 6)
    return {Eigen::VectorXd(0), Eigen::Matrix<double, Eigen::Dynamic, kLensParameters>(0, kLensParameters)};
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(by_pose);
  const Eigen::VectorXd turned = qr.householderQ().adjoint() * residual;
  const Eigen::MatrixXd turned_slope = qr.householderQ().adjoint() * by_lens;
  return {turned.tail(rows - 6), turned_slope.bottomRows(rows - 6)};
}

BoardMisfit board_misfit(const CameraModel& camera, const PlacedBoard& board) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  BoardMisfit misfit;
  double squares = 0;
  for (const Landmark& landmark : board.sighting.landmarks) {
    const LandmarkResidual whitener(landmark);
    Eigen::VectorXd miss(whitener.whitening.rows());
    for (std::size_t i = 0; i < landmark.pixels.size(); ++i) {
      const Eigen::Vector3d x = board.camera_from_board * landmark.x_in_board[i];
      if (!(x.z() > 0.0)) return {kInfinite, kInfinite, kInfinite};
      miss.segment<2>(static_cast<Eigen::Index>(2 * i)) = camera.project(x) - landmark.pixels[i];
    }
    const double chi2 = (whitener.whitening * miss).squaredNorm();
    squares += miss.squaredNorm();
    misfit.chi2 += chi2;
    misfit.worst_landmark = std::max(misfit.worst_landmark, std::sqrt(chi2) / worst_expected(landmark));
  }
  misfit.rms_px = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, board.sighting.points())));
  return misfit;
}

}  // namespace lumitexel
