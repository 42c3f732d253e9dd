#include "processing/brdf/split_directions.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace lumitexel {
namespace {

constexpr double kStep = 0.25;  // largest relative change of a parameter on either side

LafortuneBrdf scaled(const LafortuneBrdf& brdf, const Eigen::VectorXd& log_gain) {
  LafortuneBrdf result = brdf;
  for (int c = 0; c < brdf.channels; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    result.diffuse[channel] *= std::exp(log_gain[c]);
    for (auto& lobe : result.lobes) lobe[channel].log_peak += log_gain[c];
  }
  return result;
}

// ln of the factor by which the BRDF, scaled, fits the lumitexel best, per channel; kept within a factor of 8.
Eigen::VectorXd log_gain(const LafortuneBrdf& brdf, std::span<const Observation> samples, const ErrorModel& error) {
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

BrdfPair split_along_covariance(const FittedMaterial& material, bool shared_shape) {
  const LobeParameters centre = LobeParameters::from(material.brdf, shared_shape);
  // In relative units, so that kd (1/sr) and the logarithms compare.
  Eigen::VectorXd unit = Eigen::VectorXd::Ones(centre.size());
  for (int c = 0; c < centre.channels; ++c) unit[centre.diffuse(c)] = std::max(1e-4, centre.values[centre.diffuse(c)]);
  const Eigen::VectorXd inverse = unit.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(inverse.asDiagonal() * material.covariance *
                                                             inverse.asDiagonal());
  Eigen::VectorXd direction = eigen.eigenvectors().col(centre.size() - 1);
  direction *= kStep / std::max(1e-12, direction.cwiseAbs().maxCoeff());
  direction = direction.cwiseProduct(unit);
  LobeParameters up = centre, down = centre;
  up.values += direction;
  down.values -= direction;
  return {up.brdf(), down.brdf()};
}

BrdfPair split_along_brightness(const FittedMaterial& material, const Observations& observations,
                                const std::vector<std::size_t>& members, const ErrorModel& error) {
  const int channels = observations.channels;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(channels);
  Eigen::MatrixXd second = Eigen::MatrixXd::Zero(channels, channels);
  for (const std::size_t i : members) {
    const Eigen::VectorXd gain = log_gain(material.brdf, observations.of(i), error);
    mean += gain;
    second += gain * gain.transpose();
  }
  const double count = std::max<double>(1.0, static_cast<double>(members.size()));
  mean /= count;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(second / count - mean * mean.transpose());
  const double spread = std::sqrt(std::max(0.0, eigen.eigenvalues()[channels - 1]));
  const Eigen::VectorXd step = eigen.eigenvectors().col(channels - 1) * std::max(0.05, spread);
  return {scaled(material.brdf, mean + step), scaled(material.brdf, mean - step)};
}

}  // namespace lumitexel
