// How the lamp's output changed over a session, from the gray card seen in every view.
//
// Every view's card gives an apparent intensity I_v, already freed of geometry (measure_gray_card) and of the lamp's
// angular pattern (lamp_pattern.h). With t the time of the shot,
//   log I_v = m + g(t_v) + e_v,   g a Gaussian process with Matern-5/2 covariance a^2 k(|t - t'| / length),
//   e_v ~ N(0, relative_sigma_v^2 + s^2)
// m has a flat prior; a, length and the excess scatter s (dirt, a slightly wrong card pose, a light a little off) are
// the likeliest. The process enters only if it raises the restricted log-likelihood by kLeastGain; otherwise the lamp
// counts as steady. Views in which the card is shadowed are found as outliers, one worst at a time, by what the others
// predict of them.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace lumitexel {

struct CardSample {
  double time_s = 0;
  double intensity = 0;       // of any one channel or a mean of them; > 0
  double relative_sigma = 0;  // one sigma; large where the card is grazing
};

struct LampFactor {
  double factor = 1;  // output then over output at the reference time
  double sigma = 0;   // of the factor, from the samples' sigmas, the excess scatter and the process between samples
};

class LampDrift {
 public:
  // Gain in restricted log-likelihood from which on a drift is believed. Two more parameters (a, length) on a steady
  // lamp gain 2.5 in about one session of a hundred.
  static constexpr double kLeastGain = 3.0;
  static constexpr int kLeastSamples = 5;

  // Throws BadInput if a sample is not finite, or not positive. With fewer than kLeastSamples the lamp counts as steady.
  explicit LampDrift(const std::vector<CardSample>& samples);

  bool drifts() const { return amplitude_ > 0.0; }
  // Output at time_s over output at reference_s; ones with sigma 0 for a steady lamp.
  LampFactor relative(double time_s, double reference_s) const;
  // Intensity (the samples' unit) at a time, with its relative sigma; the mean of all samples for a steady lamp.
  LampFactor intensity(double time_s) const;

  const std::vector<bool>& used() const { return used_; }  // as the samples given; false: an outlier
  double gain() const { return gain_; }                    // in log-likelihood, of the process over a steady lamp
  double amplitude() const { return amplitude_; }          // a, relative; 0 if steady
  double length_s() const { return length_s_; }
  double excess_scatter() const { return scatter_; }  // s, relative

 private:
  struct Fit;
  struct Hyper;
  Fit fit(const Hyper& hyper) const;
  Hyper likeliest(bool with_process) const;
  void choose();
  bool drop_worst();
  double kernel(double dt_s) const;
  Eigen::VectorXd kernel_column(double time_s) const;

  std::vector<double> time_s_, value_, variance_;  // of the samples in use: log intensity
  std::vector<std::size_t> index_;                 // of them among the samples given
  std::vector<bool> used_;
  double span_s_ = 1;
  double amplitude_ = 0, length_s_ = 1, scatter_ = 0, gain_ = 0, mean_ = 0;
  Eigen::MatrixXd inverse_;  // of the values' covariance
  Eigen::VectorXd weights_;  // inverse * (values - mean)
  double mean_variance_ = 0;
};

}  // namespace lumitexel
