// A BRDF with what does not depend on the geometry worked out once, for many samples of it: the same bits as evaluate(), in a third of
// the time.
#pragma once

#include <array>
#include <vector>

#include "processing/brdf/lobe_family.h"

namespace lumitexel {

class PreparedBrdf {
 public:
  explicit PreparedBrdf(const Brdf& brdf);

  int channels() const { return channels_; }
  // f, 1/sr; 0 if either direction is below the surface.
  ChannelValues value(const LobeGeometry& geometry) const;

 private:
  struct ChannelLobe {
    LobeShape shape;
    double strength = 0;
    bool off = true, like_before = false;  // like_before: of one shape with the channel before
  };

  const LobeFamily* family_;
  int channels_;
  ChannelValues diffuse_;
  std::vector<std::array<ChannelLobe, kMaxChannels>> lobes_;
};

// r = f cos_i in all channels.
inline ChannelValues predicted_reflectance(const PreparedBrdf& brdf, const LobeGeometry& geometry) {
  ChannelValues values = brdf.value(geometry);
  for (double& value : values) value *= geometry.cos_i;
  return values;
}

// The same of a mixture: what a texel with these weights of a basis reflects. Weights of zero are not evaluated.
ChannelValues predicted_reflectance(const std::vector<PreparedBrdf>& basis, const std::vector<float>& weight, const LobeGeometry& geometry);

}  // namespace lumitexel
