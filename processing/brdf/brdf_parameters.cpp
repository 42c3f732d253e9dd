#include "processing/brdf/brdf_parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lumitexel {
namespace {

constexpr double kLeastLogStrength = -16.0;  // 1e-7: off; comes back only where many samples ask for it, see unseen()
// Four times all the light that arrives is more than coarse normals and glancing light can feign.
constexpr double kMostEnergy = 4.0;
constexpr double kUsualMostLogExponent = 8.517193191416238;  // ln 5000
constexpr double kUsualLeastLogAlpha = -3.912023005428146;   // ln 0.02
// A lobe's value is exponential in its parameters, its slopes are not: a step that trusted them further could carry the lobe in one leap
// between all samples, where nothing calls it back.
constexpr double kLongestOfStrength = 2.302585092994046;  // ln 10
constexpr double kLongestOfShape = 1.0986122886681098;    // ln 3
constexpr double kLongestOfAim = 0.2;                     // radians

}  // namespace

LobeBounds usual_bounds(BrdfFamily family, AimRange aim) {
  if (family == BrdfFamily::Lafortune) return {aim, 0.0, kUsualMostLogExponent};
  return {aim, kUsualLeastLogAlpha, 0.0};
}

LobeBounds widest_bounds(BrdfFamily family) {
  return {kAnyAim, lobe_family(family).least_log_shape, lobe_family(family).most_log_shape};
}

BrdfParameters::BrdfParameters(BrdfFamily family, int channels, bool shared_shape, std::vector<LobeBounds> bounds)
    : family_(family), channels_(channels), shared_shape_(shared_shape), bounds_(std::move(bounds)),
      shapes_(lobe_family(family).aims ? 2 : 1), lobe_size_(channels + shapes_ * (shared_shape ? 1 : channels)) {}

BrdfParameters::Range BrdfParameters::range(int index, const Eigen::VectorXd& values) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (index < channels_) return {0.0, kInfinity};
  const int lobe = (index - channels_) / lobe_size_, within = (index - channels_) % lobe_size_;
  const LobeBounds& bounds = bounds_[static_cast<std::size_t>(lobe)];
  if (within < channels_) {
    return {kLeastLogStrength, family().most_log_strength(values[log_shape(lobe, within)], kMostEnergy)};
  }
  if ((within - channels_) % shapes_ == 0) return {bounds.least_log_shape, bounds.most_log_shape};
  return {bounds.aim.least, bounds.aim.most};
}

void BrdfParameters::clamp(Eigen::VectorXd& values) const {
  for (int lobe = 0; lobe < lobes(); ++lobe) {  // shapes first: the strengths' bounds depend on them
    for (int i = log_shape(lobe, 0); i < log_strength(lobe + 1, 0); ++i) {
      const Range bounds = range(i, values);
      values[i] = std::clamp(values[i], bounds.least, bounds.most);
    }
  }
  for (int i = 0; i < size(); ++i) {
    const Range bounds = range(i, values);
    values[i] = std::clamp(values[i], bounds.least, bounds.most);
  }
}

Eigen::VectorXd BrdfParameters::stepped(const Eigen::VectorXd& values, const Eigen::VectorXd& step) const {
  Eigen::VectorXd reached = values + step;
  const auto cut = [&](int i, double longest) { reached[i] = values[i] + std::clamp(step[i], -longest, longest); };
  for (int lobe = 0; lobe < lobes(); ++lobe) {
    for (int c = 0; c < channels_; ++c) {
      cut(log_strength(lobe, c), kLongestOfStrength);
      cut(log_shape(lobe, c), kLongestOfShape);
      if (shapes_ > 1) cut(aim(lobe, c), kLongestOfAim);
    }
  }
  clamp(reached);
  return reached;
}

std::vector<bool> BrdfParameters::unseen(const Eigen::VectorXd& curvature, double cost) const {
  std::vector<bool> result(static_cast<std::size_t>(size()), false);
  const double shows = std::numeric_limits<double>::epsilon() * cost;
  for (int i = channels_; i < size(); ++i) result[static_cast<std::size_t>(i)] = curvature[i] < shows;
  return result;
}

std::vector<bool> BrdfParameters::held(const Eigen::VectorXd& values, const Eigen::VectorXd& gradient) const {
  std::vector<bool> result(static_cast<std::size_t>(size()));
  for (int i = 0; i < size(); ++i) {
    const Range bounds = range(i, values);
    result[static_cast<std::size_t>(i)] =
        (values[i] <= bounds.least && gradient[i] > 0.0) || (values[i] >= bounds.most && gradient[i] < 0.0);
  }
  return result;
}

Eigen::VectorXd BrdfParameters::from(const Brdf& brdf) const {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(size());
  for (int c = 0; c < channels_; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    values[diffuse(c)] = brdf.diffuse[channel];
    for (int l = 0; l < lobes(); ++l) {
      const bool exists = static_cast<std::size_t>(l) < brdf.lobes.size();
      const Lobe lobe = exists ? brdf.lobes[static_cast<std::size_t>(l)][channel] : Lobe{};
      values[log_strength(l, c)] = lobe.log_strength;
      if (shared_shape_ && c > 0) continue;
      values[log_shape(l, c)] = lobe.log_shape;
      if (shapes_ > 1) values[aim(l, c)] = lobe.aim;
    }
  }
  clamp(values);
  return values;
}

Brdf BrdfParameters::brdf(const Eigen::VectorXd& values) const {
  Brdf brdf;
  brdf.family = family_;
  brdf.channels = channels_;
  brdf.lobes.resize(bounds_.size());
  for (int c = 0; c < channels_; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    brdf.diffuse[channel] = values[diffuse(c)];
    for (int l = 0; l < lobes(); ++l) {
      Lobe& lobe = brdf.lobes[static_cast<std::size_t>(l)][channel];
      lobe.log_strength = values[log_strength(l, c)];
      lobe.log_shape = values[log_shape(l, c)];
      lobe.aim = shapes_ > 1 ? values[aim(l, c)] : kMirrorAim;
    }
  }
  return brdf;
}

}  // namespace lumitexel
