// A picture that gathers samples, and how noisy it still is.
//
// A pixel's samples go round-robin into four replicates that are independent of each other (sample_sequence.h), each
// well stratified in itself. The scatter of the replicates' means is therefore an honest estimate of the pixel's
// variance, where the scatter of single samples would be far too large. One pixel's estimate is rough (three degrees of
// freedom); the picture's is not. What no sample has met yet, a rare bright path, no estimate can tell.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "processing/brdf/brdf.h"
#include "processing/image/image.h"

namespace lumitexel {

inline constexpr int kReplicates = 4;

class ProgressivePicture {
 public:
  ProgressivePicture(int width_px, int height_px, int channels);

  // sample_index counts up from 0 in every pixel. hit: the object counts as seen there. Different pixels may be added
  // to at once.
  void add(int x, int y, int sample_index, const ChannelValues& radiance, bool hit);

  // Both for the same number of samples in every pixel, at least 1.
  Image mean(int samples) const;
  // Root mean square over object pixels and channels of the mean's standard error, over the object's mean radiance.
  // Nothing for one sample, and without an object or light.
  std::optional<double> noise(int samples) const;
  const std::vector<std::uint8_t>& hit() const { return hit_; }  // per pixel: any of its rays met the model

 private:
  int width_px_, height_px_, channels_;
  std::array<std::vector<double>, kReplicates> sums_;
  std::vector<std::uint8_t> hit_;
};

}  // namespace lumitexel
