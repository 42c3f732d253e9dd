#include "processing/normals/sigma_scale.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "processing/normals/lumitexel_bands.h"

namespace lumitexel {
namespace {

constexpr std::size_t kMostLumitexels = 40000;
constexpr std::size_t kFewestSamples = 3;  // in each half: with fewer, both halves show the prior

// Every second of the photographs that the fit may see.
std::vector<bool> half_of(const CalibratedSession& session, std::size_t which) {
  std::vector<bool> used(session.views.size(), false);
  std::size_t seen = 0;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!session.views[v].heldout) used[v] = seen++ % 2 == which;
  }
  return used;
}

}  // namespace

double normal_sigma_scale(const CalibratedSession& session, const LumitexelSet& lumitexels, int atlas_width,
                          const std::vector<std::vector<Brdf>>& bases, const std::vector<int>& label, double median_reflectance,
                          const NormalFitOptions& options) {
  const LumitexelBands bands = lumitexel_bands(lumitexels, atlas_width, kMostLumitexels);
  std::vector<int> own_label;
  for (const std::size_t i : bands.lumitexel) own_label.push_back(label[i]);
  std::array<FittedNormals, 2> fitted;
  std::vector<bool> judged(bands.lumitexel.size(), true);
  for (std::size_t half = 0; half < 2; ++half) {
    const DirectedLumitexels seen(session, bands.set, half_of(session, half));
    fitted[half] = fit_normals(seen, lumitexel_neighbours(seen, atlas_width), bases, own_label, median_reflectance, options, Uncertainty::Draws);
    std::vector<DirectedSample> samples;
    for (std::size_t i = 0; i < judged.size(); ++i) {
      seen.samples_of(i, samples);
      judged[i] = judged[i] && samples.size() >= kFewestSamples;
    }
  }
  double squares = 0.0, expected = 0.0;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    if (!judged[i]) continue;
    squares += (fitted[0].normal[i] - fitted[1].normal[i]).squaredNorm();
    for (std::uint64_t k = 0; k < kSigmaDraws; ++k) {
      squares -= (fitted[0].prior_draws[k][i] - fitted[1].prior_draws[k][i]).squaredNorm() / static_cast<double>(kSigmaDraws);
    }
    for (const FittedNormals& half : fitted) expected += 2.0 * std::pow(static_cast<double>(half.sigma.samples_rad[i]), 2);  // two axes
  }
  return expected > 0.0 ? std::sqrt(std::max(1.0, squares / expected)) : 1.0;
}

std::vector<float> widened(const NormalSigmas& sigmas, double scale, const NormalPrior& prior) {
  std::vector<float> whole(sigmas.samples_rad.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const double of_samples = scale * static_cast<double>(sigmas.samples_rad[i]), of_prior = static_cast<double>(sigmas.prior_rad[i]);
    whole[i] = static_cast<float>(std::min(std::hypot(of_samples, of_prior), prior.coarse_sigma_rad));
  }
  return whole;
}

}  // namespace lumitexel
