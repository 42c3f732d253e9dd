#include "processing/calibration/lens/vignetting.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>

#include "drivers/error.h"
#include "processing/calibration/lens/flat_cells.h"
#include "processing/image/linear_sensor.h"

namespace lumitexel {
namespace {

constexpr int kMostTerms = 3;

Eigen::Vector3d powers(const Vignetting& v, const Eigen::Vector2d& pixel) {
  const double x = (pixel.x() - v.principal_x_px) / v.half_diagonal_px,
               y = (pixel.y() - v.principal_y_px) / v.half_diagonal_px;
  const double r2 = x * x + y * y;
  return {r2, r2 * r2, r2 * r2 * r2};
}

// Parameters: a, b, c, then for each level log(level) and the gradient's two parts.
struct FlatFit {
  Eigen::VectorXd parameters;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double chi2 = std::numeric_limits<double>::infinity(), degrees = 0;
  std::vector<double> off;  // per cell: residual over sigma
};

// Gauss-Newton on the relative residual (value - model) / sigma; nearly linear, so a few steps end it.
class FlatProblem {
 public:
  FlatProblem(const std::vector<FlatCell>& cells, const Vignetting& place, int levels)
      : cells_(cells), place_(place), levels_(levels) {}

  std::optional<FlatFit> fit(int terms, const std::vector<bool>& kept) const {
    Eigen::VectorXd p = Eigen::VectorXd::Zero(3 + 3 * levels_);
    for (int l = 0; l < levels_; ++l) p[3 + 3 * l] = start_level(l);
    constexpr int kSteps = 12;
    Eigen::MatrixXd hessian;
    double chi2 = 0;
    for (int step = 0; step < kSteps; ++step) {
      Eigen::VectorXd descent = Eigen::VectorXd::Zero(p.size());
      hessian = Eigen::MatrixXd::Zero(p.size(), p.size());
      chi2 = 0;
      for (std::size_t i = 0; i < cells_.size(); ++i) {
        if (!kept[i]) continue;
        const Slope s = slope(cells_[i], p, terms);
        for (std::size_t a = 0; a < 6; ++a) {
          descent[s.index[a]] += s.value[a] * s.residual;
          for (std::size_t b = 0; b < 6; ++b) hessian(s.index[a], s.index[b]) += s.value[a] * s.value[b];
        }
        chi2 += s.residual * s.residual;
      }
      for (int t = terms; t < kMostTerms; ++t) hessian(t, t) = 1.0;  // held at zero
      for (int l = 0; l < 3 * levels_; ++l) hessian(3 + l, 3 + l) += std::numeric_limits<double>::min();
      const Eigen::VectorXd move = hessian.ldlt().solve(descent);
      if (!move.allFinite()) return std::nullopt;
      p += move;
      if (move.dot(descent) < 1e-4) break;  // of chi square: a hundredth of a sigma
    }
    return summary(p, hessian, terms, kept);
  }

 private:
  struct Slope {
    std::array<Eigen::Index, 6> index;
    std::array<double, 6> value;
    double residual;
  };

  Slope slope(const FlatCell& cell, const Eigen::VectorXd& p, int terms) const {
    const Eigen::Index level = 3 + 3 * cell.level;
    const Eigen::Vector3d power = powers(place_, cell.pixel);
    const double x = (cell.pixel.x() - place_.principal_x_px) / place_.half_diagonal_px;
    const double y = (cell.pixel.y() - place_.principal_y_px) / place_.half_diagonal_px;
    const double lens = 1.0 + power.dot(p.head<3>()), light = p[level] + p[level + 1] * x + p[level + 2] * y;
    Slope s{{0, 1, 2, level, level + 1, level + 2}, {}, (cell.value - lens * light) / cell.sigma};
    for (int t = 0; t < kMostTerms; ++t)
      s.value[static_cast<std::size_t>(t)] = t < terms ? power[t] * light / cell.sigma : 0.0;
    s.value[3] = lens / cell.sigma, s.value[4] = lens * x / cell.sigma, s.value[5] = lens * y / cell.sigma;
    return s;
  }

  double start_level(int level) const {
    double sum = 0, count = 0;
    for (const FlatCell& cell : cells_) {
      if (cell.level == level) sum += cell.value, count += 1;
    }
    return count > 0 ? sum / count : 1.0;
  }

  FlatFit summary(const Eigen::VectorXd& p, const Eigen::MatrixXd& hessian, int terms,
                  const std::vector<bool>& kept) const {
    FlatFit fit;
    fit.parameters = p;
    fit.chi2 = 0;
    fit.off.resize(cells_.size());
    double count = 0;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      fit.off[i] = slope(cells_[i], p, terms).residual;
      if (kept[i]) fit.chi2 += fit.off[i] * fit.off[i], count += 1;
    }
    fit.degrees = count - terms - 3.0 * levels_;
    const Eigen::MatrixXd inverse = hessian.ldlt().solve(Eigen::MatrixXd::Identity(p.size(), p.size()));
    fit.covariance.topLeftCorner(terms, terms) =
        inverse.topLeftCorner(terms, terms) * std::max(1.0, fit.chi2 / fit.degrees);
    return fit;
  }

  const std::vector<FlatCell>& cells_;
  const Vignetting& place_;
  int levels_;
};

double median_size(std::vector<double> values) {
  for (double& v : values) v = std::abs(v);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Cells without dust: those off by less than 4 sigma (of the median's scale), nor beside one that is.
std::vector<bool> clean_cells(const std::vector<FlatCell>& cells, const std::vector<double>& off) {
  constexpr double kDust_sigma = 4.0, kMedianOfGaussian = 0.6745;
  const double unit = std::max(1.0, median_size(off) / kMedianOfGaussian);
  std::set<std::tuple<int, int, int>> dusty;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (std::abs(off[i]) < kDust_sigma * unit) continue;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) dusty.insert({cells[i].level, cells[i].column + dx, cells[i].row + dy});
    }
  }
  std::vector<bool> kept(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i)
    kept[i] = !dusty.contains({cells[i].level, cells[i].column, cells[i].row});
  return kept;
}

void check(const std::vector<MosaicRadiance>& flats, const CameraModel& camera) {
  if (flats.empty()) throw BadInput("flat fields", "none", "at least one picture of an even white surface");
  for (const MosaicRadiance& flat : flats) {
    if (flat.width != camera.width_px || flat.height != camera.height_px)
      throw BadInput("flat fields", std::to_string(flat.width) + " x " + std::to_string(flat.height) + " pixels",
                     "the camera's " + std::to_string(camera.width_px) + " x " + std::to_string(camera.height_px));
    for (std::size_t i = 0; i < flat.value.size(); ++i) {
      if (!(flat.flags[i] & kUnusablePixel) && !(flat.variance[i] > 0.0f))
        throw BadInput("flat fields", "a pixel without variance", "merged radiance with its variance");
    }
  }
}

}  // namespace

double Vignetting::transmission(const Eigen::Vector2d& pixel) const { return 1.0 + powers(*this, pixel).dot(terms); }

double Vignetting::sigma(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector3d power = powers(*this, pixel);
  return std::sqrt(std::max(0.0, power.dot(covariance * power)));
}

VignettingFit fit_vignetting(const std::vector<MosaicRadiance>& flats, const CameraModel& camera) {
  check(flats, camera);
  constexpr int kCellsAcross = 40, kRounds = 4;
  VignettingFit result;
  Vignetting& v = result.vignetting;
  v.principal_x_px = camera.principal_x_px, v.principal_y_px = camera.principal_y_px;
  v.half_diagonal_px = 0.5 * std::hypot(camera.width_px, camera.height_px);
  std::vector<FlatCell> cells;
  int levels = 0;
  for (const MosaicRadiance& flat : flats) {
    const auto more = flat_cells(flat, kCellsAcross, levels);
    cells.insert(cells.end(), more.begin(), more.end());
    levels += mosaic_channels(flat.mosaic);
  }
  constexpr std::size_t kCellsPerLevel = 24;
  if (cells.size() < kCellsPerLevel * static_cast<std::size_t>(levels)) return result;
  const FlatProblem problem(cells, v, levels);
  std::vector<bool> kept(cells.size(), true);
  for (int round = 0; round < kRounds; ++round) {
    const auto full = problem.fit(kMostTerms, kept);
    if (!full) return result;
    const auto clean = clean_cells(cells, full->off);
    if (clean == kept) break;
    kept = clean;
  }
  const auto count = static_cast<double>(std::count(kept.begin(), kept.end(), true));
  const auto full = problem.fit(kMostTerms, kept);
  if (!full || !(full->degrees >= 1.0)) return result;
  const double unit = std::max(1.0, full->chi2 / full->degrees);
  double least = std::numeric_limits<double>::infinity();
  for (int terms = 0; terms <= kMostTerms; ++terms) {
    const auto fit = problem.fit(terms, kept);
    if (!fit) continue;
    const double criterion = fit->chi2 / unit + terms * std::log(count);
    if (criterion >= least) continue;
    least = criterion;
    result.terms = terms;
    result.reduced_chi2 = fit->chi2 / fit->degrees;
    v.terms = fit->parameters.head<3>();
    v.covariance = fit->covariance;
    result.usable = v.covariance.allFinite();
  }
  result.cells_left_out = 1.0 - count / static_cast<double>(cells.size());
  return result;
}

void correct_vignetting(MosaicRadiance& image, const Vignetting& vignetting) {
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double t = vignetting.transmission({x + 0.5, y + 0.5});
      const std::size_t i = image.index(x, y);
      image.value[i] = static_cast<float>(image.value[i] / t);
      image.variance[i] = static_cast<float>(image.variance[i] / (t * t));
    }
  }
}

void correct_vignetting(RadianceImage& image, const Vignetting& vignetting) {
  for (int y = 0; y < image.radiance.height; ++y) {
    for (int x = 0; x < image.radiance.width; ++x) {
      const double t = vignetting.transmission({x + 0.5, y + 0.5});
      for (int c = 0; c < image.radiance.channels; ++c) {
        image.radiance.at(x, y, c) = static_cast<float>(image.radiance.at(x, y, c) / t);
        image.variance.at(x, y, c) = static_cast<float>(image.variance.at(x, y, c) / (t * t));
      }
    }
  }
}

}  // namespace lumitexel
