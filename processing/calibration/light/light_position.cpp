#include "processing/calibration/light/light_position.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
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

struct RingResidual {
  const CameraModel* camera;
  const LineChart* chart;
  double ring_radius_m;
  HighlightPixel seen;

  bool operator()(const double* line, double* residual) const {
    const Eigen::Vector2d expected = ring_highlight_pixel(*camera, chart->at(line).sphere(seen.sphere), ring_radius_m);
    Eigen::Map<Eigen::Vector2d>(residual, 2) = (expected - seen.pixel) / seen.sigma_px;
    return std::isfinite(residual[0]) && std::isfinite(residual[1]);
  }
};

struct PointResidual {
  const CameraModel* camera;
  const LineChart* chart;
  HighlightPixel seen;
  EmitterDisc emitter;

  bool operator()(const double* line, const double* light, double* residual) const {
    const Eigen::Vector2d expected = disc_highlight_pixel(*camera, chart->at(line).sphere(seen.sphere),
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
  LineParameters line{};
  std::vector<std::array<double, 3>> lights;
  std::vector<Block> blocks;
  ceres::Problem problem;

  explicit Adjustment(const SphereLine& start) : chart(start) {}
};

template <typename Residual, int... Sizes>
ceres::CostFunction* numeric_cost(Residual residual) {
  // The residuals are in units of sigma (about 0.05 px) and smooth over metres: central differences are good to 1e-8.
  return new ceres::NumericDiffCostFunction<Residual, ceres::CENTRAL, 2, Sizes...>(new Residual(std::move(residual)));
}

void add_rings(Adjustment& a, const CameraModel& camera, double radius_m, const std::vector<HighlightPixel>& rings) {
  for (const HighlightPixel& seen : rings) {
    auto* cost = numeric_cost<RingResidual, 5>(RingResidual{&camera, &a.chart, radius_m, seen});
    a.blocks.push_back(
        {a.problem.AddResidualBlock(cost, new ceres::CauchyLoss(3.0), a.line.data()), -1, seen.sigma_px});
  }
}

void add_points(Adjustment& a, const CameraModel& camera, int view, const std::vector<HighlightPixel>& points,
                const EmitterDisc& emitter) {
  for (const HighlightPixel& seen : points) {
    auto* cost = numeric_cost<PointResidual, 5, 3>(PointResidual{&camera, &a.chart, seen, emitter});
    double* light = a.lights[static_cast<std::size_t>(view)].data();
    a.blocks.push_back(
        {a.problem.AddResidualBlock(cost, new ceres::CauchyLoss(3.0), a.line.data(), light), view, seen.sigma_px});
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
  std::vector<Eigen::Matrix3d> whole, own;  // own: the line held fixed
  Eigen::Matrix3d mean_of_pairs = Eigen::Matrix3d::Zero();
};

LightCovariances light_covariances(Adjustment& a, const LightSolution& solution) {
  std::vector<const double*> lights;
  for (std::size_t v = 0; v < a.lights.size(); ++v) {
    if (solution.lights[v].measured) lights.push_back(a.lights[v].data());
  }
  std::vector<std::pair<const double*, const double*>> wanted;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    for (std::size_t j = i; j < lights.size(); ++j) wanted.emplace_back(lights[i], lights[j]);
  }
  LightCovariances result;
  if (wanted.empty()) return result;
  std::vector<std::pair<const double*, const double*>> with_line = wanted;
  for (const double* light : lights) with_line.emplace_back(light, a.line.data());
  with_line.emplace_back(a.line.data(), a.line.data());
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::DENSE_SVD;  // some 60 unknowns; tolerates a weakly determined direction
  options.null_space_rank = -1;
  ceres::Covariance covariance(options);
  if (!covariance.Compute(with_line, &a.problem)) return result;
  Eigen::Matrix<double, 5, 5, Eigen::RowMajor> line;
  covariance.GetCovarianceBlock(a.line.data(), a.line.data(), line.data());
  const double scale2 = solution.sigma_scale * solution.sigma_scale;
  int between = 0;
  for (const auto& [first, second] : wanted) {
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> block;
    covariance.GetCovarianceBlock(first, second, block.data());
    if (first == second) {
      // Not by a second problem with the line held constant: Ceres 2.1's dense SVD was seen to return some of its blocks
      // five times too large, larger than with the line free.
      Eigen::Matrix<double, 3, 5, Eigen::RowMajor> mixed;
      covariance.GetCovarianceBlock(first, a.line.data(), mixed.data());
      const Eigen::Matrix3d by_line = mixed * line.ldlt().solve(mixed.transpose());
      result.whole.push_back(scale2 * block);
      result.own.push_back(scale2 * (block - by_line));
    } else {
      result.mean_of_pairs += 0.5 * scale2 * (block + block.transpose());
      ++between;
    }
  }
  if (between > 0) result.mean_of_pairs /= between;
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

void fill_covariances(Adjustment& a, LightSolution& solution) {
  const LightCovariances covariances = light_covariances(a, solution);
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
    light.own_covariance = covariances.own[next++];
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

double median_error_px(const CameraModel& camera, const SphereLine& line, const std::vector<HighlightPixel>& highlights,
                       const Eigen::Vector3d& light) {
  std::vector<double> errors;
  for (const HighlightPixel& seen : highlights) {
    const double error = (highlight_pixel(camera, line.sphere(seen.sphere), light) - seen.pixel).norm();
    errors.push_back(std::isfinite(error) ? error : std::numeric_limits<double>::infinity());
  }
  // The upper median: at least half of the highlights agree with the light this well.
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

}  // namespace

std::optional<Eigen::Vector3d> nearest_point(const std::vector<Ray>& rays) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Ray& ray : rays) {
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ray.direction * ray.direction.transpose();
    normal += across;
    right += across * ray.origin;
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(normal);
  if (rays.size() < 2 || lu.rcond() < 1e-9) return std::nullopt;  // parallel within some 1e-5 rad
  return lu.solve(right);
}

std::optional<Eigen::Vector3d> light_from_highlights(const CameraModel& camera, const SphereLine& line,
                                                     const std::vector<HighlightPixel>& highlights) {
  std::vector<Ray> rays;
  for (const HighlightPixel& seen : highlights) {
    const auto ray = mirrored_ray(line.sphere(seen.sphere), {Eigen::Vector3d::Zero(), camera.unproject(seen.pixel)});
    if (ray) rays.push_back(*ray);
  }
  // All rays together are the most precise, but one highlight of something else would spoil them; then some pair wins.
  std::optional<Eigen::Vector3d> best;
  double best_error = std::numeric_limits<double>::infinity();
  const auto consider = [&](const std::vector<Ray>& chosen) {
    const auto candidate = nearest_point(chosen);
    if (!candidate) return;
    const double error = median_error_px(camera, line, highlights, *candidate);
    if (error < best_error) {
      best_error = error;
      best = candidate;
    }
  };
  consider(rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (std::size_t j = i + 1; j < rays.size(); ++j) consider({rays[i], rays[j]});
  }
  return best;
}

Eigen::Vector2d highlight_pixel(const CameraModel& camera, const MirrorSphere& sphere, const Eigen::Vector3d& light) {
  return camera.project(mirror_point(sphere, Eigen::Vector3d::Zero(), light));
}

std::vector<Eigen::Vector2d> ring_highlight_pixels(const CameraModel& camera, const MirrorSphere& sphere,
                                                   double ring_radius_m) {
  // Opposite emitters cancel to first order; eight catch what is left, since the next terms are of fourth order.
  constexpr int kEmitters = 8;
  std::vector<Eigen::Vector2d> pixels;
  for (int i = 0; i < kEmitters; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kEmitters;
    pixels.push_back(
        highlight_pixel(camera, sphere, {ring_radius_m * std::cos(angle), ring_radius_m * std::sin(angle), 0.0}));
  }
  return pixels;
}

Eigen::Vector2d ring_highlight_pixel(const CameraModel& camera, const MirrorSphere& sphere, double ring_radius_m) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  const std::vector<Eigen::Vector2d> pixels = ring_highlight_pixels(camera, sphere, ring_radius_m);
  for (const Eigen::Vector2d& pixel : pixels) sum += pixel;
  return sum / static_cast<double>(pixels.size());
}

Eigen::Vector2d disc_highlight_pixel(const CameraModel& camera, const MirrorSphere& sphere,
                                     const Eigen::Vector3d& light, const EmitterDisc& emitter) {
  if (!(emitter.radius_m > 0.0)) return highlight_pixel(camera, sphere, light);
  const Eigen::Vector3d normal = (emitter.faces - light).normalized();
  const Eigen::Vector3d across = normal.unitOrthogonal(), other = normal.cross(across);
  constexpr int kPlaces = 8;  // as for the ring flash
  const double radius = emitter.radius_m / std::numbers::sqrt2;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int i = 0; i < kPlaces; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kPlaces;
    sum += highlight_pixel(camera, sphere, light + radius * (std::cos(angle) * across + std::sin(angle) * other));
  }
  return sum / kPlaces;
}

LightSolution solve_lights(const CameraModel& camera, const SphereLine& start, double ring_radius_m,
                           const std::vector<HighlightPixel>& rings,
                           const std::vector<std::vector<HighlightPixel>>& points, const EmitterDisc& emitter) {
  check_rings(rings);
  Adjustment adjustment(start);
  LightSolution solution;
  solution.lights.resize(points.size());
  adjustment.lights.resize(points.size());
  add_rings(adjustment, camera, ring_radius_m, rings);
  for (std::size_t v = 0; v < points.size(); ++v) {
    solution.lights[v].highlights = static_cast<int>(points[v].size());
    if (points[v].size() < kMinHighlights) continue;
    const auto first = light_from_highlights(camera, start, points[v]);
    if (!first || !first->allFinite()) continue;
    solution.lights[v].measured = true;
    adjustment.lights[v] = {first->x(), first->y(), first->z()};
    add_points(adjustment, camera, static_cast<int>(v), points[v], emitter);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-14;
  options.parameter_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &adjustment.problem, &summary);
  solution.converged = summary.termination_type == ceres::CONVERGENCE;
  solution.line = adjustment.chart.at(adjustment.line.data());
  measure_residuals(adjustment, solution);
  fill_covariances(adjustment, solution);
  for (std::size_t v = 0; v < points.size(); ++v) {
    const auto& light = adjustment.lights[v];
    if (solution.lights[v].measured) solution.lights[v].position = {light[0], light[1], light[2]};
  }
  return solution;
}

}  // namespace lumitexel
