#include "processing/calibration/light/shading_normals.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace lumitexel {
namespace {

constexpr double kLitCode = 0.04;     // below it a picture says more of the ambient light than of its lamp
constexpr double kLossSigmas = 3.0;

struct Surface {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double albedo = 0.5;
};

std::optional<Surface> lambert_start(const DirectionalLights& lights, const std::vector<double>& code, double lit_code) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  int lit = 0;
  for (std::size_t j = 0; j < code.size(); ++j) {
    if (code[j] < lit_code || code[j] >= kClippedCode) continue;
    const Eigen::Vector3d l = lights.strengths[j] * lights.directions[j];
    normal += l * l.transpose();
    right += l * (std::pow(code[j], lights.shading.gamma) - lights.shading.ambient);
    ++lit;
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(normal);
  if (lit < 3 || lu.rcond() < 1e-6) return std::nullopt;  // fewer, or lights in one plane
  const Eigen::Vector3d g = lu.solve(right);
  if (!(g.norm() > 0.0) || !g.allFinite()) return std::nullopt;
  Surface surface{g.normalized(), g.norm()};
  surface.normal.z() = std::max(surface.normal.z(), 0.05);  // the viewer sees it
  surface.normal.normalize();
  return surface;
}

class PixelFit {
 public:
  PixelFit(const DirectionalLights& lights, const std::vector<double>& code, double sigma)
      : lights_(lights), code_(code), sigma_(sigma) {}

  Eigen::VectorXd residuals(const Surface& s) const {
    Eigen::VectorXd r = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(code_.size()));
    for (std::size_t j = 0; j < code_.size(); ++j) {
      if (code_[j] >= kClippedCode) continue;
      const double expected = lights_.shading.code(s.normal, lights_.directions[j], s.albedo, lights_.strengths[j]);
      r[static_cast<Eigen::Index>(j)] = (expected - code_[j]) / sigma_;
    }
    return r;
  }
  static double cost(const Eigen::VectorXd& r) {
    return kLossSigmas * kLossSigmas * (r.array().square() / (kLossSigmas * kLossSigmas)).log1p().sum();
  }
  static Eigen::VectorXd weights(const Eigen::VectorXd& r) {
    return (1.0 + r.array().square() / (kLossSigmas * kLossSigmas)).inverse();
  }
  static Surface moved(const Surface& s, const Eigen::Vector3d& step) {
    const Eigen::Vector3d a = s.normal.unitOrthogonal(), b = s.normal.cross(a);
    return {(s.normal + step.x() * a + step.y() * b).normalized(), s.albedo + step.z()};
  }
  Eigen::MatrixX3d jacobian(const Surface& s) const {
    Eigen::MatrixX3d j(static_cast<Eigen::Index>(code_.size()), 3);
    constexpr double kStep = 1e-5;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
      j.col(k) = (residuals(moved(s, step)) - residuals(moved(s, -step))) / (2.0 * kStep);
    }
    return j;
  }

 private:
  const DirectionalLights& lights_;
  const std::vector<double>& code_;
  double sigma_;
};

}  // namespace

std::optional<ShadedNormal> normal_from_shading(const DirectionalLights& lights, const std::vector<double>& code,
                                                double sigma_code) {
  // Where too few pictures are lit, the dark ones must do: Lambert's line through them is a start, no more.
  auto start = lambert_start(lights, code, kLitCode);
  if (!start) start = lambert_start(lights, code, 0.0);
  if (!start) return std::nullopt;
  const PixelFit fit(lights, code, sigma_code);
  Surface surface = *start;
  Eigen::VectorXd r = fit.residuals(surface);
  double cost = PixelFit::cost(r), damping = 1e-4;
  constexpr int kMaxIterations = 40;
  for (int i = 0; i < kMaxIterations && damping < 1e6; ++i) {
    const Eigen::MatrixX3d j = fit.jacobian(surface);
    const Eigen::VectorXd w = PixelFit::weights(r);
    Eigen::Matrix3d normal = j.transpose() * w.asDiagonal() * j;
    normal.diagonal() *= 1.0 + damping;
    normal.diagonal().array() += 1e-12;
    const Surface next = PixelFit::moved(surface, -normal.ldlt().solve(j.transpose() * w.cwiseProduct(r)));
    const Eigen::VectorXd next_r = fit.residuals(next);
    const double next_cost = PixelFit::cost(next_r);
    if (!(next_cost < cost)) {
      damping *= 10.0;
      continue;
    }
    const bool settled = cost - next_cost < 1e-9 * (1.0 + cost);
    surface = next;
    r = next_r;
    cost = next_cost;
    damping *= 0.2;
    if (settled) break;
  }
  if (!(surface.normal.z() > 0.0) || !(surface.albedo > 0.0)) return std::nullopt;
  const Eigen::MatrixX3d j = fit.jacobian(surface);
  const Eigen::VectorXd w = PixelFit::weights(r);
  const Eigen::Matrix3d covariance = (j.transpose() * w.asDiagonal() * j).inverse();
  const double freedom = std::max(1.0, w.sum() - 3.0), chi2 = r.dot(w.cwiseProduct(r)) / freedom;
  const double sigma = std::sqrt(0.5 * (covariance(0, 0) + covariance(1, 1)) * std::max(1.0, chi2));
  if (!std::isfinite(sigma)) return std::nullopt;
  return ShadedNormal{surface.normal, surface.albedo, sigma};
}

}  // namespace lumitexel
