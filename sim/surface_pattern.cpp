#include "sim/surface_pattern.h"

#include <algorithm>
#include <cmath>

#include "sim/gradient_noise.h"
#include "sim/seeded_random.h"

namespace lumitexel {

int PatternPoint::dominant() const {
  return static_cast<int>(std::max_element(weight.begin(), weight.end()) - weight.begin());
}

PatternPoint SurfacePattern::at(const Eigen::Vector3d& x_in_table) const {
  const Eigen::Vector3d x = x_in_table / size_m;
  constexpr double kPatchesPerSize = 4.0, kGrainsPerSize = 24.0;
  // Scores differ by some 4 per size_m across a border; the factor makes its logistic edge about 0.5 % of the size wide.
  constexpr double kEdgeSharpness = 120.0;
  constexpr double kNegligible = 1e-3;  // spares evaluating materials that nobody could see

  std::array<double, kMaxObjectMaterials> score{};
  for (int m = 0; m < materials; ++m) {
    score[static_cast<std::size_t>(m)] =
        gradient_noise(kPatchesPerSize * x, extended_key(seed, std::uint64_t(100 + m)));
  }
  const double best = *std::max_element(score.begin(), score.begin() + materials);
  PatternPoint point;
  double sum = 0.0;
  for (std::size_t m = 0; m < static_cast<std::size_t>(materials); ++m) {
    const double weight = std::exp(kEdgeSharpness * (score[m] - best));
    point.weight[m] = weight > kNegligible ? weight : 0.0;
    sum += point.weight[m];
  }
  for (double& weight : point.weight) weight /= sum;
  const double grain = gradient_noise(kGrainsPerSize * x, extended_key(seed, std::uint64_t(200)));
  point.albedo_scale = std::clamp(0.8 + 0.9 * grain, 0.4, 1.2);
  return point;
}

}  // namespace lumitexel
