#include "processing/calibration/light/light_position.h"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr int kMinHighlights = 3;       // two determine a light but leave nothing to check
constexpr double kOutlierSigmas = 5.0;  // with some hundred highlights no honest one lies this far out

// A line by its first centre and two small turns of a start direction: five numbers, no constraint among them.
using LineParameters = std::array<double, 5>;

struct LineChart {
  SphereLine start;
  Eigen::Vector3d across_1, across_2;

  explicit LineChart(const SphereLine& line) : start(line) {
    across_1 = line.direction.unitOrthogonal();
    across_2 = line.direction.cross(across_1);
  }
  SphereLine at(const double* p) const {
    SphereLine line = start;
    line.first_centre += Eigen::Vector3d(p[0], p[1], p[2]);
    line.direction = (start.direction + p[3] * across_1 + p[4] * across_2).normalized();
    return line;
  }
};

// The lens in units of its prior's standard deviations along the prior's axes: eight numbers that are zero, plus or minus one,
// before the highlights say anything, and of which those of terms that the lens does not use change nothing.
struct LensChart {
  CameraModel start;
  LensMatrix root = LensMatrix::Zero();  // root root^T is the prior's covariance

  LensChart(const CameraModel& camera, const std::optional<LensMatrix>& covariance) : start(camera) {
    if (!covariance) return;
    const LensVector scale = covariance->diagonal().cwiseSqrt();
    const LensVector inverse = scale.unaryExpr([](double x) { return x > 0.0 ? 1.0 / x : 0.0; });
    const Eigen::SelfAdjointEigenSolver<LensMatrix> eigen(LensMatrix(inverse.asDiagonal() * *covariance * inverse.asDiagonal()));
    const LensVector lengths = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    root = scale.asDiagonal() * eigen.eigenvectors() * lengths.asDiagonal();
  }
  CameraModel at(const double* p) const {
    return with_lens_vector(start, lens_vector(start) + root * Eigen::Map<const LensVector>(p));
  }
};

struct RingResidual {
  const LensChart* lens_chart;
  const LineChart* chart;
  double ring_radius_m;
  HighlightPixel seen;

  bool operator()(const double* line, const double* lens, double* residual) const {
    const Eigen::Vector2d expected =
        ring_highlight_pixel(lens_chart->at(lens), chart->at(line).sphere(seen.sphere), ring_radius_m);
    Eigen::Map<Eigen::Vector2d>(residual, 2) = (expected - seen.pixel) / seen.sigma_px;
    return std::isfinite(residual[0]) && std::isfinite(residual[1]);
  }
};

struct PointResidual {
  const LensChart* lens_chart;
  const LineChart* chart;
  HighlightPixel seen;
  EmitterDisc emitter;

  bool operator()(const double* line, const double* light, const double* lens, double* residual) const {
    const Eigen::Vector2d expected = disc_highlight_pixel(lens_chart->at(lens), chart->at(line).sphere(seen.sphere),
                                                          Eigen::Vector3d(light[0], light[1], light[2]), emitter);
    Eigen::Map<Eigen::Vector2d>(residual, 2) = (expected - seen.pixel) / seen.sigma_px;
    return std::isfinite(residual[0]) && std::isfinite(residual[1]);
  }
};

struct Block {
  ceres::ResidualBlockId id;
  int view;  // -1: a ring highlight
  double sigma_px;
};

// The problem and what its parameters point to; stays where it is built.
struct Adjustment {
  LineChart chart;
  LensChart lens_chart;
  LineParameters line{};
  std::array<double, kLensParameters> lens{};
  std::vector<std::array<double, 3>> lights;
  std::vector<Block> blocks;
  ceres::Problem problem;

  Adjustment(const SphereLine& start, const CameraModel& camera, const std::optional<LensMatrix>& lens_covariance)
      : chart(start), lens_chart(camera, lens_covariance) {
    problem.AddParameterBlock(lens.data(), kLensParameters);
    if (lens_covariance) {
      const ceres::Matrix unit = ceres::Matrix::Identity(kLensParameters, kLensParameters);
      problem.AddResidualBlock(new ceres::NormalPrior(unit, ceres::Vector::Zero(kLensParameters)), nullptr, lens.data());
    }
    problem.SetParameterBlockConstant(lens.data());
  }
};

template <typename Residual, int... Sizes>
ceres::CostFunction* numeric_cost(Residual residual) {
  // The residuals are in units of sigma (about 0.05 px) and smooth over metres: central differences are good to 1e-8.
  return new ceres::NumericDiffCostFunction<Residual, ceres::CENTRAL, 2, Sizes...>(new Residual(std::move(residual)));
}

void add_rings(Adjustment& a, double radius_m, const std::vector<HighlightPixel>& rings) {
  for (const HighlightPixel& seen : rings) {
    auto* cost = numeric_cost<RingResidual, 5, 8>(RingResidual{&a.lens_chart, &a.chart, radius_m, seen});
    const auto id = a.problem.AddResidualBlock(cost, new ceres::CauchyLoss(3.0), a.line.data(), a.lens.data());
    a.blocks.push_back({id, -1, seen.sigma_px});
  }
}

void add_points(Adjustment& a, int view, const std::vector<HighlightPixel>& points, const EmitterDisc& emitter) {
  for (const HighlightPixel& seen : points) {
    auto* cost = numeric_cost<PointResidual, 5, 3, 8>(PointResidual{&a.lens_chart, &a.chart, seen, emitter});
    double* light = a.lights[static_cast<std::size_t>(view)].data();
    const auto id = a.problem.AddResidualBlock(cost, new ceres::CauchyLoss(3.0), a.line.data(), light, a.lens.data());
    a.blocks.push_back({id, view, seen.sigma_px});
  }
}

void measure_residuals(Adjustment& a, LightSolution& solution) {
  double sum_sigma2 = 0.0, sum_px2 = 0.0;
  std::int64_t inliers = 0;
  std::vector<double> view_px2(solution.lights.size(), 0.0);
  for (const Block& block : a.blocks) {
    std::array<double, 2> r{};
    double cost = 0.0;
    a.problem.EvaluateResidualBlock(block.id, false, &cost, r.data(), nullptr);
    const double square = r[0] * r[0] + r[1] * r[1];
    MeasuredLight* light = block.view < 0 ? nullptr : &solution.lights[static_cast<std::size_t>(block.view)];
    if (square > kOutlierSigmas * kOutlierSigmas) {
      if (light) ++light->outliers;
      continue;
    }
    ++inliers;
    sum_sigma2 += square;
    sum_px2 += square * block.sigma_px * block.sigma_px;
    if (light) view_px2[static_cast<std::size_t>(block.view)] += square * block.sigma_px * block.sigma_px;
  }
  std::int64_t unknowns = 5;
  for (std::size_t v = 0; v < solution.lights.size(); ++v) {
    MeasuredLight& light = solution.lights[v];
    if (light.measured) unknowns += 3;
    const int kept = light.highlights - light.outliers;
    light.residual_px = kept > 0 ? std::sqrt(view_px2[v] / (2.0 * kept)) : 0.0;
  }
  solution.residual_px = inliers > 0 ? std::sqrt(sum_px2 / (2.0 * static_cast<double>(inliers))) : 0.0;
  const auto freedom = static_cast<double>(2 * inliers - unknowns);
  // Never claim less than the highlights' own sigmas: a lucky fit is no better measurement.
  solution.sigma_scale = freedom > 0 ? std::max(1.0, std::sqrt(sum_sigma2 / freedom)) : 1.0;
}

// Covariances of the measured lights, in their order; empty if the problem is too degenerate for any.
struct LightCovariances {
  std::vector<Eigen::Matrix3d> whole, own;  // own: line and lens held fixed
  Eigen::Matrix3d mean_of_pairs = Eigen::Matrix3d::Zero();
  std::vector<Eigen::Matrix<double, kLensParameters, 3>> with_lens;  // a free lens's, in its chart
  LensMatrix lens = LensMatrix::Zero();
};

using BlockPair = std::pair<const double*, const double*>;

template <int Rows, int Columns>
Eigen::Matrix<double, Rows, Columns> block_of(const ceres::Covariance& covariance, const double* first, const double* second) {
  Eigen::Matrix<double, Rows, Columns, Eigen::RowMajor> block;
  covariance.GetCovarianceBlock(first, second, block.data());
  return block;
}

// What all lights share: the line's five numbers, and the lens's eight if it is free.
Eigen::MatrixXd shared_block(const ceres::Covariance& covariance, const Adjustment& a, bool free_lens) {
  Eigen::MatrixXd shared(free_lens ? 13 : 5, free_lens ? 13 : 5);
  shared.topLeftCorner<5, 5>() = block_of<5, 5>(covariance, a.line.data(), a.line.data());
  if (!free_lens) return shared;
  shared.topRightCorner<5, 8>() = block_of<5, 8>(covariance, a.line.data(), a.lens.data());
  shared.bottomLeftCorner<8, 5>() = shared.topRightCorner<5, 8>().transpose();
  shared.bottomRightCorner<8, 8>() = block_of<8, 8>(covariance, a.lens.data(), a.lens.data());
  return shared;
}

std::vector<BlockPair> wanted_blocks(const Adjustment& a, const std::vector<const double*>& lights, bool free_lens) {
  std::vector<BlockPair> wanted{{a.line.data(), a.line.data()}};
  for (std::size_t i = 0; i < lights.size(); ++i) {
    for (std::size_t j = i; j < lights.size(); ++j) wanted.emplace_back(lights[i], lights[j]);
    wanted.emplace_back(lights[i], a.line.data());
    if (free_lens) wanted.emplace_back(lights[i], a.lens.data());
  }
  if (free_lens) wanted.insert(wanted.end(), {{a.line.data(), a.lens.data()}, {a.lens.data(), a.lens.data()}});
  return wanted;
}

LightCovariances light_covariances(Adjustment& a, const LightSolution& solution, bool free_lens) {
  std::vector<const double*> lights;
  for (std::size_t v = 0; v < a.lights.size(); ++v) {
    if (solution.lights[v].measured) lights.push_back(a.lights[v].data());
  }
  LightCovariances result;
  if (lights.empty()) return result;
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::DENSE_SVD;  // some 90 unknowns; tolerates a weakly determined direction
  options.null_space_rank = -1;
  ceres::Covariance covariance(options);
  if (!covariance.Compute(wanted_blocks(a, lights, free_lens), &a.problem)) return result;
  const Eigen::MatrixXd shared = shared_block(covariance, a, free_lens);
  // A scale of all residuals would blow up the lens's prior too, of which the highlights know nothing.
  const double scale2 = free_lens ? 1.0 : solution.sigma_scale * solution.sigma_scale;
  if (free_lens) result.lens = scale2 * shared.bottomRightCorner<8, 8>();
  for (std::size_t i = 0; i < lights.size(); ++i) {
    // Not by a second problem with the line held constant: Ceres 2.1's dense SVD was seen to return some of its blocks
    // five times too large, larger than with the line free.
    Eigen::MatrixXd mixed(3, shared.cols());
    mixed.leftCols<5>() = block_of<3, 5>(covariance, lights[i], a.line.data());
    if (free_lens) mixed.rightCols<8>() = block_of<3, 8>(covariance, lights[i], a.lens.data());
    if (free_lens) result.with_lens.push_back(scale2 * mixed.rightCols<8>().transpose());
    const Eigen::Matrix3d block = block_of<3, 3>(covariance, lights[i], lights[i]);
    result.whole.push_back(scale2 * block);
    result.own.push_back(scale2 * (block - mixed * shared.ldlt().solve(Eigen::MatrixXd(mixed.transpose()))));
    for (std::size_t j = i + 1; j < lights.size(); ++j) {
      const Eigen::Matrix3d pair = block_of<3, 3>(covariance, lights[i], lights[j]);
      result.mean_of_pairs += 0.5 * scale2 * (pair + pair.transpose());
    }
  }
  const std::size_t pairs = lights.size() * (lights.size() - 1) / 2;
  if (pairs > 0) result.mean_of_pairs /= static_cast<double>(pairs);
  return result;
}

// Refused: farther than this many lengths of the line of spheres, or with a distance known to no better than its half. There
// the fit is not linear any more and its covariance means nothing.
constexpr double kFarthestLines = 200.0, kLeastKnown = 0.5;

bool is_credible(const MeasuredLight& light, const Eigen::Vector3d& position, const SphereLine& line) {
  const Eigen::Vector3d middle = line.first_centre + 0.5 * (line.count - 1) * line.spacing_m * line.direction;
  const double distance = (position - middle).norm();
  const double worst = std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(light.covariance).eigenvalues()[2]);
  return distance < kFarthestLines * line.spacing_m * std::max(1, line.count - 1) && worst < kLeastKnown * distance;
}

void fill_covariances(Adjustment& a, bool free_lens, LightSolution& solution) {
  const LightCovariances covariances = light_covariances(a, solution, free_lens);
  const LensMatrix& root = a.lens_chart.root;
  if (free_lens && !covariances.whole.empty()) solution.lens->covariance = root * covariances.lens * root.transpose();
  solution.shared_covariance = covariances.mean_of_pairs;
  std::size_t next = 0;
  for (std::size_t v = 0; v < solution.lights.size(); ++v) {
    MeasuredLight& light = solution.lights[v];
    if (!light.measured) continue;
    if (next >= covariances.whole.size()) {  // without an uncertainty there is no measurement
      light.measured = false;
      solution.converged = false;
      continue;
    }
    light.covariance = covariances.whole[next];
    light.own_covariance = covariances.own[next];
    if (free_lens) light.with_lens = root * covariances.with_lens[next];
    ++next;
    const auto& p = a.lights[v];
    light.measured = is_credible(light, {p[0], p[1], p[2]}, solution.line);
  }
}

void check_rings(const std::vector<HighlightPixel>& rings) {
  std::set<int> spheres;
  for (const HighlightPixel& seen : rings) spheres.insert(seen.sphere);
  if (spheres.size() < 3) {
    throw BadInput("sphere shots", "ring highlights on " + std::to_string(spheres.size()) + " spheres", "at least 3");
  }
}

}  // namespace

namespace {

// Returns twice the cost: chi square, with outliers held down.
double solve(Adjustment& adjustment, LightSolution& solution) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-14;
  options.parameter_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &adjustment.problem, &summary);
  solution.converged = summary.termination_type == ceres::CONVERGENCE;
  return 2.0 * summary.final_cost;
}

}  // namespace

LightSolution solve_lights(const CameraModel& camera, const SphereLine& start, double ring_radius_m,
                           const std::vector<HighlightPixel>& rings,
                           const std::vector<std::vector<HighlightPixel>>& points, const EmitterDisc& emitter,
                           const std::optional<LensMatrix>& lens_covariance) {
  check_rings(rings);
  Adjustment adjustment(start, camera, lens_covariance);
  LightSolution solution;
  solution.lights.resize(points.size());
  adjustment.lights.resize(points.size());
  add_rings(adjustment, ring_radius_m, rings);
  for (std::size_t v = 0; v < points.size(); ++v) {
    solution.lights[v].highlights = static_cast<int>(points[v].size());
    if (points[v].size() < kMinHighlights) continue;
    const auto first = light_from_highlights(camera, start, points[v]);
    if (!first || !first->allFinite()) continue;
    solution.lights[v].measured = true;
    adjustment.lights[v] = {first->x(), first->y(), first->z()};
    add_points(adjustment, static_cast<int>(v), points[v], emitter);
  }
  const double chi2_held = solve(adjustment, solution);
  if (lens_covariance) {
    adjustment.problem.SetParameterBlockVariable(adjustment.lens.data());
    const double chi2_free = solve(adjustment, solution);
    solution.lens = {adjustment.lens_chart.at(adjustment.lens.data()), LensMatrix::Zero(), chi2_held - chi2_free};
  }
  solution.line = adjustment.chart.at(adjustment.line.data());
  measure_residuals(adjustment, solution);
  fill_covariances(adjustment, lens_covariance.has_value(), solution);
  for (std::size_t v = 0; v < points.size(); ++v) {
    const auto& light = adjustment.lights[v];
    if (solution.lights[v].measured) solution.lights[v].position = {light[0], light[1], light[2]};
  }
  return solution;
}

}  // namespace lumitexel
