#include "processing/calibration/pose/joint_refinement.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "drivers/error.h"

namespace lumitexel {
namespace {

LensMatrix lens_block(const TurntableRegistration& registration) {
  const Eigen::Index k = registration.unknowns.lens;
  return registration.covariance.block<kLensParameters, kLensParameters>(k, k);
}

// How the unknowns go with the lens. Directions in which the lens is as good as fixed lead nowhere.
Eigen::MatrixXd gain(const TurntableRegistration& registration) {
  const LensMatrix lens = lens_block(registration);
  const LensVector scale = lens.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const LensMatrix unit = scale.cwiseInverse().asDiagonal() * lens * scale.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<LensMatrix> eigen(unit);
  const LensVector inverse = eigen.eigenvalues().unaryExpr([](double x) { return x > 1e-12 ? 1.0 / x : 0.0; });
  const LensMatrix inverse_unit = eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
  return registration.covariance.middleCols<kLensParameters>(registration.unknowns.lens) *
         scale.cwiseInverse().asDiagonal() * inverse_unit * scale.cwiseInverse().asDiagonal();
}

// What the new lens takes away from a view's variance was the lens's share of it.
void reduce_lens_share(VarianceShares& shares, double before, double after) {
  if (!(before > 0.0 && after > 0.0)) return;
  const double rest = 1.0 - shares.lens, lens = std::max(0.0, shares.lens * before - (before - after));
  const double total = rest * before + lens;
  for (double* share : {&shares.contour, &shares.tags, &shares.angles, &shares.mesh}) *share *= before / total;
  shares.lens = lens / total;
}

void check(const TurntableRegistration& registration) {
  if (registration.unknowns.lens < 0) throw BadInput("joint refinement", "a registration with an exact lens", "a free lens");
}

}  // namespace

RefinedLens lens_of(const TurntableRegistration& registration) {
  check(registration);
  return {registration.model.camera, lens_block(registration), 0.0};
}

void follow_lens(TurntableRegistration& registration, const RefinedLens& lens) {
  check(registration);
  const Eigen::MatrixXd g = gain(registration);
  const LensVector off = lens_vector(lens.camera) - lens_vector(registration.model.camera);
  const Eigen::VectorXd step = g * off;
  const Eigen::Vector3d centre = registration.model.camera_from_mesh.centre;
  registration.covariance += g * (lens.covariance - lens_block(registration)) * g.transpose();
  registration.model = moved(registration.model, registration.unknowns, step);
  registration.model.camera = lens.camera;
  for (RegisteredView& view : registration.views) {
    view.camera_from_mesh = CentredPose(view.camera_from_mesh, centre).moved(view.by_unknowns * step).camera_from_mesh();
    const double before = view.sigma_m * view.sigma_m;
    view.state(view.by_unknowns * registration.covariance * view.by_unknowns.transpose());
    reduce_lens_share(view.shares, before, view.sigma_m * view.sigma_m);
  }
}

std::vector<LightInMesh> lights_in_mesh(const TurntableRegistration& registration, const std::vector<LightInCamera>& lights) {
  const Eigen::MatrixXd g = registration.unknowns.lens >= 0 ? gain(registration) : Eigen::MatrixXd();
  std::vector<LightInMesh> result;
  for (const LightInCamera& light : lights) {
    if (light.view >= registration.views.size())
      throw BadInput("light", "view " + std::to_string(light.view), "one of the registered views");
    const RegisteredView& view = registration.views[light.view];
    const CentredPose pose(view.camera_from_mesh, registration.model.camera_from_mesh.centre);
    // x_mesh = R^T exp(-turn) (x_camera - centre - shift) + mesh's centre
    const Eigen::Vector3d arm = light.position_m - pose.centre_in_camera;
    Eigen::Matrix<double, 3, 6> by_pose;
    by_pose << pose.rotation.transpose() * cross_matrix(arm), -pose.rotation.transpose();
    const Eigen::Matrix3d from_pose = by_pose * view.covariance * by_pose.transpose();
    const Eigen::Matrix3d from_light = pose.rotation.transpose() * light.covariance * pose.rotation;
    Eigen::Matrix3d in_common = Eigen::Matrix3d::Zero();
    if (g.size() > 0) in_common = by_pose * (view.by_unknowns * (g * light.with_lens)) * pose.rotation;
    LightInMesh moved;
    moved.position_m = pose.rotation.transpose() * arm + pose.centre;
    moved.covariance = from_pose + from_light + in_common + in_common.transpose();
    const double both = from_pose.trace() + from_light.trace();
    moved.pose_share = both > 0.0 ? from_pose.trace() / both : 0.0;
    result.push_back(moved);
  }
  return result;
}

}  // namespace lumitexel
