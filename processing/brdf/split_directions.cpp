#include "processing/brdf/split_directions.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace lumitexel {
namespace {

constexpr double kStep = 0.25;  // largest relative change of a parameter on either side

Brdf scaled(const Brdf& brdf, const Eigen::VectorXd& log_gain) {
  Brdf result = brdf;
  for (int c = 0; c < brdf.channels; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    result.diffuse[channel] *= std::exp(log_gain[c]);
    for (auto& lobe : result.lobes) lobe[channel].log_strength += log_gain[c];
  }
  return result;
}

// ln of the factor by which the BRDF, scaled, fits the lumitexel best, per channel; kept within a factor of 8.
Eigen::VectorXd log_gain(const Brdf& brdf, std::span<const Observation> samples, const ErrorModel& error) {
  Eigen::VectorXd gain(brdf.channels);
  for (int c = 0; c < brdf.channels; ++c) {
    double mr = 1e-9, mm = 1e-9;  // a weak pull towards a gain of one
    for (const Observation& sample : samples) {
      const double m = predicted_reflectance(brdf, c, sample.geometry);
      const auto channel = static_cast<std::size_t>(c);
      const double w = 1.0 / error.variance(m, static_cast<double>(sample.variance[channel]));
      mr += w * m * static_cast<double>(sample.reflectance[channel]);
      mm += w * m * m;
    }
    gain[c] = std::log(std::clamp(mr / mm, 0.125, 8.0));
  }
  return gain;
}

}  // namespace

BrdfPair split_along_covariance(const Brdf& brdf, const Eigen::MatrixXd& covariance, const BrdfParameters& layout) {
  const Eigen::VectorXd centre = layout.from(brdf);
  // In relative units, so that kd (1/sr) and the logarithms compare.
  Eigen::VectorXd unit = Eigen::VectorXd::Ones(layout.size());
  for (int c = 0; c < layout.channels(); ++c) unit[layout.diffuse(c)] = std::max(1e-4, centre[layout.diffuse(c)]);
  const Eigen::VectorXd inverse = unit.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(inverse.asDiagonal() * covariance * inverse.asDiagonal());
  Eigen::VectorXd direction = eigen.eigenvectors().col(layout.size() - 1);
  direction *= kStep / std::max(1e-12, direction.cwiseAbs().maxCoeff());
  direction = direction.cwiseProduct(unit);
  Eigen::VectorXd up = centre + direction, down = centre - direction;
  layout.clamp(up);
  layout.clamp(down);
  return {layout.brdf(up), layout.brdf(down)};
}

BrdfPair split_along_brightness(const Brdf& brdf, const Observations& observations, const std::vector<std::size_t>& members,
                                const ErrorModel& error) {
  const int channels = observations.channels;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(channels);
  Eigen::MatrixXd second = Eigen::MatrixXd::Zero(channels, channels);
  for (const std::size_t i : members) {
    const Eigen::VectorXd gain = log_gain(brdf, observations.of(i), error);
    mean += gain;
    second += gain * gain.transpose();
  }
  const double count = std::max<double>(1.0, static_cast<double>(members.size()));
  mean /= count;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(second / count - mean * mean.transpose());
  const double spread = std::sqrt(std::max(0.0, eigen.eigenvalues()[channels - 1]));
  const Eigen::VectorXd step = eigen.eigenvectors().col(channels - 1) * std::max(0.05, spread);
  return {scaled(brdf, mean + step), scaled(brdf, mean - step)};
}

}  // namespace lumitexel
