#include "processing/calibration/light/directional_lights.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "drivers/error.h"
#include "processing/calibration/light/ball_shading_terms.h"

namespace lumitexel {
namespace {

constexpr std::size_t kLeastPixels = 20;
constexpr double kUnitCode = 0.01;    // residuals in hundredths of the full range
constexpr double kLossUnits = 2.0;    // of the Cauchy loss: two hundredths, some times what a good fit leaves
constexpr double kWorthwhile = 0.02;  // relative fall of the held-out error that makes a term needed

using Shading = std::array<double, 5>;  // as ball_code takes them

struct CodeResidual {
  double code;
  Eigen::Vector3d normal;

  template <typename T>
  bool operator()(const T* direction, const T* strength, const T* shading, const T* albedo, T* residual) const {
    const Eigen::Matrix<T, 3, 1> n = normal.cast<T>(), l = Eigen::Map<const Eigen::Matrix<T, 3, 1>>(direction);
    residual[0] = (ball_code(shading, n, l, albedo[0], strength[0]) - T(code)) / T(kUnitCode);
    return true;
  }
};

struct Unknowns {
  std::vector<Eigen::Vector3d> directions;
  std::vector<double> strengths, albedos;
  Shading shading{1.0, 0.0, 0.0, 0.0, 0.4};
};

void check(const std::vector<BallPixel>& pixels, const std::vector<Eigen::Vector3d>& start) {
  if (pixels.size() < kLeastPixels || start.empty()) {
    throw BadInput("directional lights",
                   std::to_string(pixels.size()) + " pixels and " + std::to_string(start.size()) + " lights",
                   "20 pixels and a light, or more");
  }
  for (const BallPixel& pixel : pixels) {
    const bool finite = std::all_of(pixel.code.begin(), pixel.code.end(), [](double c) { return std::isfinite(c); });
    if (pixel.code.size() == start.size() && finite) continue;
    throw BadInput("directional lights", std::to_string(pixel.code.size()) + " codes in a pixel",
                   "one finite code a light");
  }
}

std::vector<int> fixed_shading(const ShadingTerms& terms) {
  std::vector<int> fixed;
  if (!terms.response) fixed.push_back(0);
  if (!terms.ambient) fixed.push_back(1);
  if (!terms.roughness) fixed.push_back(2);
  if (!terms.gloss) fixed.insert(fixed.end(), {3, 4});
  return fixed;
}

void add_residuals(ceres::Problem& problem, const std::vector<BallPixel>& pixels, Unknowns& u) {
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    for (std::size_t j = 0; j < pixels[i].code.size(); ++j) {
      if (pixels[i].code[j] >= kClippedCode) continue;
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<CodeResidual, 1, 3, 1, 5, 1>(
                                   new CodeResidual{pixels[i].code[j], pixels[i].normal}),
                               new ceres::CauchyLoss(kLossUnits), u.directions[j].data(), &u.strengths[j],
                               u.shading.data(), &u.albedos[i]);
    }
  }
}

void fix(ceres::Problem& problem, Unknowns& u, const LightFitOptions& options) {
  for (std::size_t j = 0; j < u.directions.size(); ++j) {
    double* direction = u.directions[j].data();
    if (!problem.HasParameterBlock(direction)) continue;
    if (options.fix_directions) {
      problem.SetParameterBlockConstant(direction);
    } else {
      problem.SetManifold(direction, new ceres::SphereManifold<3>());
    }
    // Albedos and strengths share a factor; the first light sets it.
    if (j == 0) problem.SetParameterBlockConstant(&u.strengths[j]);
  }
  const std::vector<int> fixed = fixed_shading(options.terms);
  if (fixed.size() == u.shading.size()) {
    problem.SetParameterBlockConstant(u.shading.data());
  } else if (!fixed.empty()) {
    problem.SetManifold(u.shading.data(), new ceres::SubsetManifold(5, fixed));
  }
  problem.SetParameterLowerBound(u.shading.data(), 0, 0.2);
  problem.SetParameterUpperBound(u.shading.data(), 0, 5.0);
  problem.SetParameterLowerBound(u.shading.data(), 4, 0.02);
  problem.SetParameterUpperBound(u.shading.data(), 4, 2.0);
}

// The sandwich: H^-1 (sum over blocks of g g^T) H^-1, both after the pixels' albedos are eliminated.
class LightCovariance {
 public:
  LightCovariance(const std::vector<BallPixel>& pixels, const Unknowns& u, const ShadingTerms& terms) : unknowns_(u) {
    const std::vector<int> fixed = fixed_shading(terms);
    for (int k = 0; k < 5; ++k) {
      if (std::find(fixed.begin(), fixed.end(), k) == fixed.end()) free_.push_back(k);
    }
    size_ = static_cast<Eigen::Index>(3 * u.directions.size() + free_.size());
    for (const Eigen::Vector3d& d : u.directions) {
      const Eigen::Vector3d across = d.unitOrthogonal();
      across_.push_back({across, d.cross(across)});
    }
    hessian_ = Eigen::MatrixXd::Zero(size_, size_);
    for (std::size_t i = 0; i < pixels.size(); ++i) add(pixels[i], u.albedos[i]);
  }

  std::vector<double> direction_sigmas() const {
    Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(size_, size_);
    for (const auto& [block, score] : scores_) meat += score * score.transpose();
    Eigen::MatrixXd h = hessian_;
    h.row(2).setZero();  // the first strength is fixed
    h.col(2).setZero();
    h(2, 2) = 1.0;
    // The loss's second derivative, not its weight, tells how far a score moves the solution; on the average, since that of
    // single outliers is negative.
    h *= std::max(0.1, slope_sum_ / weight_sum_);
    const Eigen::MatrixXd inverse = h.completeOrthogonalDecomposition().pseudoInverse();
    const Eigen::MatrixXd covariance = inverse * meat * inverse;
    std::vector<double> sigmas;
    for (std::size_t j = 0; j < across_.size(); ++j) {
      const auto k = static_cast<Eigen::Index>(3 * j);
      sigmas.push_back(std::sqrt(0.5 * (covariance(k, k) + covariance(k + 1, k + 1))));
    }
    return sigmas;
  }

 private:
  // Per light: two turns of the direction, the strength; then the free shading constants.
  void add(const BallPixel& pixel, double albedo) {
    const auto rows = static_cast<Eigen::Index>(pixel.code.size());
    Eigen::MatrixXd j = Eigen::MatrixXd::Zero(rows, size_);
    Eigen::VectorXd by_albedo = Eigen::VectorXd::Zero(rows), r = Eigen::VectorXd::Zero(rows), w = r;
    for (Eigen::Index k = 0; k < rows; ++k) {
      const auto light = static_cast<std::size_t>(k);
      if (pixel.code[light] >= kClippedCode) continue;
      linearise(pixel, light, albedo, j, by_albedo, r);
      const double square = r[k] * r[k] / (kLossUnits * kLossUnits);
      w[k] = 1.0 / (1.0 + square);
      weight_sum_ += w[k];
      slope_sum_ += (1.0 - square) * w[k] * w[k];
    }
    const double albedo_information = by_albedo.dot(w.cwiseProduct(by_albedo));
    if (!(albedo_information > 0.0)) return;
    const Eigen::VectorXd mixed = j.transpose() * w.cwiseProduct(by_albedo);
    hessian_ += j.transpose() * w.asDiagonal() * j - mixed * mixed.transpose() / albedo_information;
    const Eigen::VectorXd wr = w.cwiseProduct(r);
    auto [score, fresh] = scores_.try_emplace(pixel.block, Eigen::VectorXd::Zero(size_));
    score->second += j.transpose() * wr - mixed * (by_albedo.dot(wr) / albedo_information);
  }

  void linearise(const BallPixel& pixel, std::size_t light, double albedo, Eigen::MatrixXd& j,
                 Eigen::VectorXd& by_albedo, Eigen::VectorXd& r) const {
    using Jet = ceres::Jet<double, 9>;  // two turns, strength, five constants, albedo
    const auto row = static_cast<Eigen::Index>(light);
    Eigen::Matrix<Jet, 3, 1> direction = unknowns_.directions[light].cast<Jet>();
    for (int a = 0; a < 3; ++a) {
      direction[a].v[0] = across_[light][0][a];
      direction[a].v[1] = across_[light][1][a];
    }
    std::array<Jet, 5> shading;
    for (int k = 0; k < 5; ++k) shading[static_cast<std::size_t>(k)] = Jet(unknowns_.shading[static_cast<std::size_t>(k)], 3 + k);
    const Eigen::Matrix<Jet, 3, 1> normal = pixel.normal.cast<Jet>();
    const Jet code = ball_code(shading.data(), normal, direction, Jet(albedo, 8), Jet(unknowns_.strengths[light], 2));
    r[row] = (code.a - pixel.code[light]) / kUnitCode;
    by_albedo[row] = code.v[8] / kUnitCode;
    for (Eigen::Index k = 0; k < 3; ++k) j(row, 3 * row + k) = code.v[k] / kUnitCode;
    const auto first = static_cast<Eigen::Index>(3 * unknowns_.directions.size());
    for (std::size_t k = 0; k < free_.size(); ++k) {
      j(row, first + static_cast<Eigen::Index>(k)) = code.v[3 + free_[k]] / kUnitCode;
    }
  }

  const Unknowns& unknowns_;
  std::vector<int> free_;
  std::vector<std::array<Eigen::Vector3d, 2>> across_;
  Eigen::Index size_ = 0;
  Eigen::MatrixXd hessian_;
  double weight_sum_ = 0, slope_sum_ = 0;
  std::map<int, Eigen::VectorXd> scores_;
};

Unknowns start_unknowns(const std::vector<BallPixel>& pixels, const std::vector<Eigen::Vector3d>& start,
                        const ShadingTerms& terms) {
  Unknowns u;
  u.directions = start;
  u.strengths.assign(start.size(), 1.0);
  for (const BallPixel& pixel : pixels) u.albedos.push_back(*std::max_element(pixel.code.begin(), pixel.code.end()));
  if (terms.roughness) u.shading[2] = 0.3;  // at zero its slope is zero
  if (terms.gloss) u.shading[3] = 0.02;
  return u;
}

double solve_rms(ceres::Problem& problem, bool& converged) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-8;
  options.num_threads = 1;  // the result must not depend on it
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  converged = summary.termination_type == ceres::CONVERGENCE;
  std::vector<double> residuals;
  ceres::Problem::EvaluateOptions plain;
  plain.apply_loss_function = false;
  problem.Evaluate(plain, nullptr, &residuals, nullptr, nullptr);
  double sum = 0.0;
  for (const double r : residuals) sum += r * r;
  return kUnitCode * std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, residuals.size())));
}

// The albedo that the codes of all lights but one ask for: Gauss-Newton in one number.
double albedo_without(const DirectionalLights& lights, const BallPixel& pixel, std::size_t left_out) {
  double albedo = 0.5;
  constexpr int kIterations = 8;
  for (int i = 0; i < kIterations; ++i) {
    double slopes = 0.0, products = 0.0;
    for (std::size_t j = 0; j < pixel.code.size(); ++j) {
      if (j == left_out || pixel.code[j] >= kClippedCode) continue;
      constexpr double kStep = 1e-5;
      const auto code = [&](double a) { return lights.shading.code(pixel.normal, lights.directions[j], a, lights.strengths[j]); };
      const double slope = (code(albedo + kStep) - code(albedo - kStep)) / (2.0 * kStep), r = pixel.code[j] - code(albedo);
      const double weight = 1.0 / (1.0 + std::pow(r / (kLossUnits * kUnitCode), 2));
      slopes += weight * slope * slope;
      products += weight * slope * r;
    }
    if (!(slopes > 0.0)) break;
    albedo = std::max(1e-3, albedo + products / slopes);
  }
  return albedo;
}

}  // namespace

DirectionalLights fit_directional_lights(const std::vector<BallPixel>& pixels,
                                         const std::vector<Eigen::Vector3d>& start, const LightFitOptions& options) {
  check(pixels, start);
  Unknowns u = start_unknowns(pixels, start, options.terms);
  DirectionalLights result;
  {
    ceres::Problem problem;
    add_residuals(problem, pixels, u);
    fix(problem, u, options);
    result.rms_code = solve_rms(problem, result.converged);
  }
  for (Eigen::Vector3d& direction : u.directions) direction.normalize();
  result.directions = u.directions;
  result.strengths = u.strengths;
  result.shading = {u.shading[0], u.shading[1], std::abs(u.shading[2]), u.shading[3], u.shading[4]};
  result.sigma_rad.assign(start.size(), 0.0);
  if (!options.fix_directions) result.sigma_rad = LightCovariance(pixels, u, options.terms).direction_sigmas();
  return result;
}

double prediction_rms(const DirectionalLights& lights, const std::vector<BallPixel>& pixels) {
  double sum = 0.0;
  std::int64_t count = 0;
  for (const BallPixel& pixel : pixels) {
    for (std::size_t j = 0; j < pixel.code.size(); ++j) {
      if (pixel.code[j] >= kClippedCode || !(pixel.normal.dot(lights.directions[j]) > 0.0)) continue;
      const double albedo = albedo_without(lights, pixel, j);
      const double code = lights.shading.code(pixel.normal, lights.directions[j], albedo, lights.strengths[j]);
      sum += std::pow(code - pixel.code[j], 2);
      ++count;
    }
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0;
}

ChosenLights choose_terms(const std::vector<BallPixel>& pixels, const std::vector<BallPixel>& heldout,
                          const std::vector<Eigen::Vector3d>& start, bool fix_directions) {
  ChosenLights best;
  best.lights = fit_directional_lights(pixels, start, {{}, fix_directions});
  best.heldout_rms = prediction_rms(best.lights, heldout);
  best.tried_rms = {best.heldout_rms};
  constexpr std::array<bool ShadingTerms::*, 4> kOrder{&ShadingTerms::response, &ShadingTerms::roughness,
                                                       &ShadingTerms::gloss, &ShadingTerms::ambient};
  for (const auto term : kOrder) {
    ShadingTerms terms = best.terms;
    terms.*term = true;
    DirectionalLights lights = fit_directional_lights(pixels, start, {terms, fix_directions});
    const double rms = prediction_rms(lights, heldout);
    best.tried_rms.push_back(rms);
    if (rms > (1.0 - kWorthwhile) * best.heldout_rms) continue;
    best.terms = terms;
    best.lights = std::move(lights);
    best.heldout_rms = rms;
  }
  return best;
}

}  // namespace lumitexel
