#include "processing/render/progressive.h"

#include <algorithm>
#include <cmath>

namespace lumitexel {

ProgressivePicture::ProgressivePicture(int width_px, int height_px, int channels)
    : width_px_(width_px),
      height_px_(height_px),
      channels_(channels),
      hit_(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px)) {
  for (auto& sums : sums_) sums.resize(hit_.size() * static_cast<std::size_t>(channels));
}

void ProgressivePicture::add(int x, int y, int sample_index, const ChannelValues& radiance, bool hit) {
  const std::size_t pixel =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px_) + static_cast<std::size_t>(x);
  double* sums =
      &sums_[static_cast<std::size_t>(sample_index % kReplicates)][pixel * static_cast<std::size_t>(channels_)];
  for (int c = 0; c < channels_; ++c) sums[c] += radiance[static_cast<std::size_t>(c)];
  if (hit) hit_[pixel] = 1;
}

Image ProgressivePicture::mean(int samples) const {
  Image image(width_px_, height_px_, channels_);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    double sum = 0.0;
    for (const auto& sums : sums_) sum += sums[i];
    image.data[i] = static_cast<float>(sum / samples);
  }
  return image;
}

std::optional<double> ProgressivePicture::noise(int samples) const {
  const int replicates = std::min(samples, kReplicates);
  if (replicates < 2) return std::nullopt;
  const auto channels = static_cast<std::size_t>(channels_);
  double variance = 0.0, radiance = 0.0;
  std::size_t values = 0;
  for (std::size_t i = 0; i < hit_.size() * channels; ++i) {
    if (hit_[i / channels] == 0) continue;
    double sum = 0.0, scatter = 0.0;
    for (const auto& sums : sums_) sum += sums[i];
    const double mean = sum / samples;
    for (int r = 0; r < replicates; ++r) {
      const int count = (samples - r + kReplicates - 1) / kReplicates;
      const double off = sums_[static_cast<std::size_t>(r)][i] / count - mean;
      scatter += count * off * off;
    }
    variance += scatter / ((replicates - 1.0) * samples);
    radiance += mean;
    ++values;
  }
  if (!(radiance > 0.0)) return std::nullopt;
  const auto count = static_cast<double>(values);
  return std::sqrt(variance / count) / (radiance / count);
}

}  // namespace lumitexel
