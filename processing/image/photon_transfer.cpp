#include "processing/image/photon_transfer.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "drivers/error.h"
#include "processing/image/exposure_pair.h"

namespace lumitexel {
namespace {

constexpr int kBinsOfAPair = 24;
constexpr double kWorstRelativeSigma = 0.05;
constexpr double kRounding_dn2 = 1.0 / 12.0;
// Variance of the trimmed variance over that of the plain one, for normal noise: cutting at four sigma costs little.
constexpr double kTrimmingLoss = 1.01;
constexpr double kLeastLinearitySignal = 0.01;  // of the range: below it the black level's error is larger than the sensor's
constexpr std::size_t kFewestClipped = 20;
constexpr double kWidestPile = 0.02;  // of the range
constexpr double kContradictionSigmas = 5.0, kContradiction = 0.02;

// variance = shot * p + reads * q with p = 1 / electrons_per_dn, q = read noise^2 + rounding.
struct VarianceRow {
  double shot = 0, reads = 0, variance_dn2 = 0, relative_sigma = 0;
};

double healthy_mean(const MasterDark& dark, double& count) {
  double sum = 0.0;
  count = 0.0;
  for (std::size_t i = 0; i < dark.mean_dn.size(); ++i) {
    if (dark.hot[i]) continue;
    sum += static_cast<double>(dark.mean_dn[i]);
    count += 1.0;
  }
  return count > 0.0 ? sum / count : dark.median_dn;
}

class Measurement {
 public:
  Measurement(const DarkLibrary& darks, const LinearSensor& described) : darks_(darks), described_(described) {
    result_.sensor = described;
    result_.electrons_per_dn.value = described.electrons_per_dn;
    result_.read_noise_dn.value = described.read_noise_dn;
    result_.black_level_dn.value = described.black_level_dn;
    result_.clip_dn.value = described.clip_dn;
  }

  PhotonTransfer run(const std::vector<std::vector<Frame>>& brackets) {
    measure_black_level();
    for (const std::vector<Frame>& bracket : brackets) add_bracket(bracket);
    add_darks();
    solve_lines();
    measure_clip();
    judge_linearity();
    return std::move(result_);
  }

 private:
  // mean = black + current * exposure over the darks at one temperature.
  void measure_black_level() {
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    double shortest_s = 0.0, longest_s = 0.0;
    for (const MasterDark& dark : darks_.all()) {
      const MasterDark& first = darks_.all().front();
      if (dark.temperature_c && first.temperature_c &&
          std::abs(*dark.temperature_c - *first.temperature_c) > kDarkTemperatureWindow_k) {
        continue;
      }
      double pixels = 0.0;
      const double mean = healthy_mean(dark, pixels);
      if (pixels < 1.0) continue;
      const double weight = pixels * dark.repetitions / std::max(dark.pixel_variance_dn2, kRounding_dn2);
      const Eigen::Vector2d row(1.0, dark.settings.exposure_s);
      normal += weight * row * row.transpose();
      right += weight * mean * row;
      shortest_s = shortest_s == 0.0 ? dark.settings.exposure_s : std::min(shortest_s, dark.settings.exposure_s);
      longest_s = std::max(longest_s, dark.settings.exposure_s);
    }
    if (normal(0, 0) == 0.0) {
      note("black level: no darks; the rig's description is used");
    } else if (longest_s < 1.5 * shortest_s) {
      set(result_.black_level_dn, right[0] / normal(0, 0), 1.0 / std::sqrt(normal(0, 0)));
      note("black level: darks of one exposure only, so it contains their dark current");
    } else {
      const Eigen::Vector2d line = normal.inverse() * right;
      set(result_.black_level_dn, line[0], std::sqrt(normal.inverse()(0, 0)));
    }
    result_.sensor.black_level_dn = result_.black_level_dn.value;
  }

  double current_dn(const MasterDark& dark) const {
    double pixels = 0.0;  // the mean: the median of a few integers' means moves in steps that would show in read noise
    return std::max(0.0, healthy_mean(dark, pixels) - result_.sensor.black_level_dn);
  }

  void add_bracket(const std::vector<Frame>& bracket) {
    std::vector<DarkedExposure> exposures;
    for (const Frame& frame : bracket) {
      if (frame.width_px != bracket[0].width_px || frame.height_px != bracket[0].height_px) {
        throw BadInput("photon transfer", "a bracket of frames of different size", "exposures by one camera");
      }
      exposures.push_back({&frame, darks_.matching(frame).dark});
    }
    std::stable_sort(exposures.begin(), exposures.end(), [](const DarkedExposure& a, const DarkedExposure& b) {
      return a.frame->reported.exposure_s < b.frame->reported.exposure_s;
    });
    for (std::size_t k = 0; k + 1 < exposures.size(); ++k) add_pair(exposures[k], exposures[k + 1]);
  }

  void add_pair(const DarkedExposure& shorter, const DarkedExposure& longer) {
    const PairBins pair = difference_bins(shorter, longer, result_.sensor, kBinsOfAPair);
    const double a = pair.ratio, range_dn = described_.clip_dn - described_.black_level_dn;
    const double reads1 = a * a * (1.0 + 1.0 / shorter.dark->repetitions), reads2 = 1.0 + 1.0 / longer.dark->repetitions;
    for (const DifferenceBin& bin : pair.bins) {
      const double shot = (a + 1.0) * std::max(0.0, bin.signal_dn) + reads1 * current_dn(*shorter.dark) +
                          reads2 * current_dn(*longer.dark);
      rows_.push_back({shot, reads1 + reads2, bin.variance_dn2, std::sqrt(2.0 * kTrimmingLoss / bin.pixels)});
      differences_ += bin.pixels;
      trimmed_ += bin.trimmed;
      if (bin.signal_dn < kLeastLinearitySignal * range_dn) continue;
      result_.linearity.push_back({bin.signal_dn, bin.median_dn / bin.signal_dn,
                                   std::sqrt(kTrimmingLoss * bin.variance_dn2 / bin.pixels) / bin.signal_dn,
                                   shorter.frame->reported.exposure_s, longer.frame->reported.exposure_s});
    }
    const std::vector<std::uint16_t> clipped = saturated_samples(shorter, longer, described_);
    clipped_.insert(clipped_.end(), clipped.begin(), clipped.end());
  }

  void add_darks() {
    for (const MasterDark& dark : darks_.all()) {
      if (dark.repetitions < 2) continue;
      const double freedoms = static_cast<double>(dark.mean_dn.size() - static_cast<std::size_t>(dark.hot_count)) *
                              (dark.repetitions - 1);
      if (freedoms < 1.0) continue;
      rows_.push_back({current_dn(dark), 1.0, dark.pixel_variance_dn2, std::sqrt(2.0 / freedoms)});
    }
  }

  // Weighted by the variances that the lines themselves predict: weights by what was measured would prefer low ones.
  void solve_lines() {
    Eigen::Vector2d line(1.0 / described_.electrons_per_dn, described_.variance_dn2(0.0));
    Eigen::Matrix2d normal;
    if (rows_.empty()) return note("noise: neither pairs of exposures nor repeated darks; the rig's description is used");
    for (int pass = 0; pass < 5; ++pass) {
      normal.setZero();
      Eigen::Vector2d right = Eigen::Vector2d::Zero();
      for (const VarianceRow& row : rows_) {
        const Eigen::Vector2d terms(row.shot, row.reads);
        const double sigma = std::max(terms.dot(line), 1e-6) * row.relative_sigma;
        normal += terms * terms.transpose() / (sigma * sigma);
        right += terms * row.variance_dn2 / (sigma * sigma);
      }
      // Where no light fell the gain's column is nothing: a prior of 100 % keeps the system whole and is seen to rule.
      normal(0, 0) += described_.electrons_per_dn * described_.electrons_per_dn;
      right[0] += described_.electrons_per_dn;
      line = normal.ldlt().solve(right).cwiseMax(1e-9);
    }
    take_lines(line, normal.inverse());
  }

  void take_lines(const Eigen::Vector2d& line, const Eigen::Matrix2d& covariance) {
    double chi_square = 0.0;
    for (const VarianceRow& row : rows_) {
      const double predicted = row.shot * line[0] + row.reads * line[1];
      chi_square += std::pow((row.variance_dn2 / predicted - 1.0) / row.relative_sigma, 2);
    }
    if (rows_.size() > 2) result_.chi_square_per_freedom = chi_square / static_cast<double>(rows_.size() - 2);
    // A model that misses by more than the noise knows its values less well, too.
    const double widening = std::sqrt(std::max(1.0, result_.chi_square_per_freedom));
    const double gain_sigma = widening * std::sqrt(covariance(0, 0)) / line[0];
    if (gain_sigma < kWorstRelativeSigma) {
      set(result_.electrons_per_dn, 1.0 / line[0], gain_sigma / line[0]);
    } else {
      note("electrons per DN: too little light or too few pixels for 5 %; the rig's description is used");
    }
    const double read_dn2 = line[1] - kRounding_dn2, read_sigma_dn2 = widening * std::sqrt(covariance(1, 1));
    if (read_dn2 > 0.0 && read_sigma_dn2 < 2.0 * kWorstRelativeSigma * read_dn2) {
      set(result_.read_noise_dn, std::sqrt(read_dn2), 0.5 * read_sigma_dn2 / std::sqrt(read_dn2));
    } else {
      note("read noise: not told apart from rounding, or too few darks; the rig's description is used");
    }
    result_.gain_read_correlation = -covariance(0, 1) / std::sqrt(covariance(0, 0) * covariance(1, 1));
    result_.trimmed_share = differences_ > 0.0 ? trimmed_ / differences_ : 0.0;
    result_.sensor.electrons_per_dn = result_.electrons_per_dn.value;
    result_.sensor.read_noise_dn = result_.read_noise_dn.value;
    compare("electrons per DN", result_.electrons_per_dn, described_.electrons_per_dn);
    compare("read noise", result_.read_noise_dn, described_.read_noise_dn);
  }

  // Saturated samples pile up at one value; they were chosen by other exposures, so their mean is unbiased.
  void measure_clip() {
    if (clipped_.size() < kFewestClipped) return note("saturation: no pile of clipped samples; the rig's description is used");
    std::sort(clipped_.begin(), clipped_.end());
    const double middle = clipped_[clipped_.size() / 2];
    std::vector<double> off;
    for (const std::uint16_t sample : clipped_) off.push_back(std::abs(sample - middle));
    std::nth_element(off.begin(), off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2), off.end());
    const double width = std::max(1.4826 * off[off.size() / 2], 0.5);
    if (width > kWidestPile * (described_.clip_dn - described_.black_level_dn)) {
      return note("saturation: pixels that should be clipped do not pile up; the rig's description is used");
    }
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (const std::uint16_t sample : clipped_) {
      if (std::abs(sample - middle) > 4.0 * width) continue;
      sum += sample - middle;
      squares += std::pow(sample - middle, 2);
      count += 1.0;
    }
    const double variance = std::max(0.0, squares / count - std::pow(sum / count, 2));
    set(result_.clip_dn, middle + sum / count, std::sqrt((variance + kRounding_dn2) / count));
    result_.sensor.clip_dn = result_.clip_dn.value;
    result_.sensor.clip_spread_dn = std::sqrt(std::max(0.0, variance - result_.sensor.variance_dn2(0.0)));
    compare("saturation", result_.clip_dn, described_.clip_dn);
  }

  void judge_linearity() {
    double chi_square = 0.0;
    for (const LinearityPoint& point : result_.linearity) {
      const double sigmas = std::abs(point.deviation) / point.sigma;
      chi_square += sigmas * sigmas;
      if (sigmas > 3.0 && std::abs(point.deviation) > std::abs(result_.largest_nonlinearity)) {
        result_.largest_nonlinearity = point.deviation;
        result_.largest_nonlinearity_sigma = point.sigma;
      }
    }
    const double n = static_cast<double>(result_.linearity.size());
    // Wilson and Hilferty's cube root of chi-square is nearly normal: at most 1 % of linear sensors fail.
    if (n > 0.0) {
      result_.looks_linear = std::cbrt(chi_square / n) < 1.0 - 2.0 / (9.0 * n) + 2.326 * std::sqrt(2.0 / (9.0 * n));
    } else {
      note("linearity: no pairs of exposures with enough light");
    }
  }

  void compare(const std::string& name, const SensorValue& measured, double described) {
    const double off = std::abs(measured.value - described);
    if (!measured.measured || off < kContradictionSigmas * measured.sigma || off < kContradiction * described) return;
    note(name + ": measured " + std::to_string(measured.value) + ", the rig's description says " + std::to_string(described));
  }

  static void set(SensorValue& value, double measured, double sigma) { value = {measured, sigma, true}; }
  void note(std::string text) { result_.notes.push_back(std::move(text)); }

  const DarkLibrary& darks_;
  const LinearSensor described_;
  PhotonTransfer result_;
  std::vector<VarianceRow> rows_;
  std::vector<std::uint16_t> clipped_;
  double differences_ = 0, trimmed_ = 0;
};

}  // namespace

PhotonTransfer measure_photon_transfer(const std::vector<std::vector<Frame>>& brackets, const DarkLibrary& darks,
                                       const LinearSensor& described) {
  check_sensor(described);
  return Measurement(darks, described).run(brackets);
}

}  // namespace lumitexel
