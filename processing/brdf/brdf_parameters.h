// A BRDF as one vector of numbers for an optimiser, and the bounds it stays in.
//
// Order: kd per channel; then for each lobe ln(strength) per channel, and ln(shape) and, if the family aims, aim: once if the
// channels share the lobe's shape, else once a channel.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "processing/brdf/lobe_family.h"

namespace lumitexel {

// Where a lobe may point (Lafortune's phi, radians): what kind of lobe it is.
struct AimRange {
  double least = 0, most = 0;
};
// Within about 8 degrees of the mirror direction's parameter (Cz / |Cx| from 0.74 to 1.35). A forward lobe off it further peaks
// where no rig has samples, near grazing, and extrapolates there without bound.
inline constexpr AimRange kForwardAim{0.6353981633974483, 0.9353981633974483};
inline constexpr AimRange kRetroAim{-0.9353981633974483, -0.6353981633974483};
inline constexpr AimRange kAnyAim{-1.5707963267948966, 1.5707963267948966};

struct LobeBounds {
  AimRange aim = kForwardAim;
  double least_log_shape = 0, most_log_shape = 0;
};

// Bounds that a fit to photographs should keep to. For Lafortune N from 1 (broader lobes are diffuse light) to 5000, a highlight of
// 1.3 degrees: the normals of a scanned mesh are not known better, and a narrower lobe would sit on single outliers. For
// microfacets alpha from 0.02 to 1.
LobeBounds usual_bounds(BrdfFamily family, AimRange aim = kForwardAim);
// All that the formula allows.
LobeBounds widest_bounds(BrdfFamily family);

class BrdfParameters {
 public:
  // bounds: one entry a lobe.
  BrdfParameters(BrdfFamily family, int channels, bool shared_shape, std::vector<LobeBounds> bounds);

  int channels() const { return channels_; }
  int lobes() const { return static_cast<int>(bounds_.size()); }
  bool shared_shape() const { return shared_shape_; }
  const LobeFamily& family() const { return lobe_family(family_); }
  int diffuse(int c) const { return c; }
  int log_strength(int lobe, int c) const { return channels_ + lobe * lobe_size_ + c; }
  int log_shape(int lobe, int c) const { return channels_ + lobe * lobe_size_ + channels_ + (shared_shape_ ? 0 : c * shapes_); }
  int aim(int lobe, int c) const { return log_shape(lobe, c) + 1; }  // only if the family aims
  int size() const { return channels_ + lobes() * lobe_size_; }

  Eigen::VectorXd from(const Brdf& brdf) const;  // clamped; a shared shape is the first channel's
  Brdf brdf(const Eigen::VectorXd& values) const;
  void clamp(Eigen::VectorXd& values) const;
  // values + step, cut where a lobe's parameters would leave what their slopes say anything about, and at the bounds.
  Eigen::VectorXd stepped(const Eigen::VectorXd& values, const Eigen::VectorXd& step) const;
  // Whether each parameter stands at a bound beyond which the cost, by its gradient, would go on falling.
  std::vector<bool> held(const Eigen::VectorXd& values, const Eigen::VectorXd& gradient) const;
  // Parameters of lobes that the samples do not see: their curvature, the normal matrix's diagonal, is less than the cost's rounding, so that a
  // step by one gains less than 3e-8 of the cost (2 sqrt(curvature cost), by Cauchy and Schwarz), which is less than a fit ends at.
  std::vector<bool> unseen(const Eigen::VectorXd& curvature, double cost) const;

 private:
  struct Range {
    double least, most;
  };
  Range range(int index, const Eigen::VectorXd& values) const;

  BrdfFamily family_;
  int channels_;
  bool shared_shape_;
  std::vector<LobeBounds> bounds_;
  int shapes_, lobe_size_;
};

}  // namespace lumitexel
