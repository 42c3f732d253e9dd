#include "rig/commission/image_displacement.h"

#include <cmath>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr double kVisible = 5.0;  // times the noise: one pixel of a million by chance
constexpr std::size_t kFewestPixels = 50;

}  // namespace

DisplacementGauge::DisplacementGauge(std::vector<float> reference, const std::vector<float>& stepped, double step,
                                     int frames, const std::vector<float>& variance_dn2)
    : reference_(std::move(reference)), weighted_change_(reference_.size(), 0.0f) {
  std::size_t visible = 0;
  for (std::size_t i = 0; i < reference_.size(); ++i) {
    const double difference = static_cast<double>(stepped[i]) - reference_[i];
    if (std::abs(difference) < kVisible * std::sqrt(2.0 * variance_dn2[i] / frames)) continue;
    const double change = difference / step;
    weighted_change_[i] = static_cast<float>(change / variance_dn2[i]);
    information_ += change * change / variance_dn2[i];
    ++visible;
  }
  if (visible < kFewestPixels) {
    throw Error("only " + std::to_string(visible) + " pixels change with the axis: nothing in the picture shows its motion");
  }
}

double DisplacementGauge::displacement(Samples picture) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < reference_.size(); ++i) {
    if (weighted_change_[i] != 0.0f) sum += weighted_change_[i] * (static_cast<double>(picture[i]) - reference_[i]);
  }
  return sum / information_;
}

double DisplacementGauge::resolution() const { return 1.0 / std::sqrt(information_); }

std::vector<float> mean_picture(const std::vector<std::vector<std::uint16_t>>& frames) {
  std::vector<double> sum(frames.front().size(), 0.0);
  for (const std::vector<std::uint16_t>& frame : frames) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += frame[i];
  }
  std::vector<float> mean(sum.size());
  for (std::size_t i = 0; i < sum.size(); ++i) mean[i] = static_cast<float>(sum[i] / static_cast<double>(frames.size()));
  return mean;
}

}  // namespace lumitexel
