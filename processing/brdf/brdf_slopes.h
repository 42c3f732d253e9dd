// What a parameter vector predicts for one sample, and how that changes with each parameter.
#pragma once

#include <Eigen/Core>

#include "processing/brdf/brdf_parameters.h"

namespace lumitexel {

inline constexpr int kMaxLobes = 3;
inline constexpr int kMaxBrdfParameters = kMaxChannels * (1 + 3 * kMaxLobes);
using SampleValues = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxChannels, 1>;
using SampleSlopes = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMaxChannels, kMaxBrdfParameters>;

// What does not depend on the geometry is worked out once.
class BrdfSlopes {
 public:
  BrdfSlopes(const BrdfParameters& layout, const Eigen::VectorXd& at);

  // r = f cos_i per channel (1/sr), and a row of derivatives a channel, a column a parameter of the layout.
  void predict(const LobeGeometry& geometry, SampleValues& value, SampleSlopes& slope) const;

 private:
  struct ChannelLobe {
    LobeShape shape;
    double strength = 0;
  };

  const BrdfParameters& layout_;
  std::array<double, kMaxChannels> diffuse_{};
  std::vector<std::array<ChannelLobe, kMaxChannels>> lobes_;
};

}  // namespace lumitexel
