// Materials as a mixture: each lumitexel belongs to one, nobody says which. Expectation-maximisation finds BRDFs, error models and
// shares together; a lumitexel that two materials explain alike counts for both, so that the estimates are not bent by hard labels.
#pragma once

#include <cstddef>
#include <vector>

#include "processing/brdf/fit_material.h"
#include "processing/brdf/noise_shape.h"

namespace lumitexel {

struct Mixture {
  std::vector<MaterialModel> materials;
  std::vector<double> share;  // of lumitexels, summing to 1
  NoiseShape noise = {};      // of all materials' errors; only whose a lumitexel is goes by it
};

// Lumitexel l of a list belongs to material k with probability at(l, k).
struct Responsibilities {
  std::size_t materials = 0;
  std::vector<double> probability;  // lumitexels * materials
  std::vector<double> misfit;       // the same shape: of the lumitexel under each material
  double log_likelihood = 0;        // of all lumitexels under the mixture

  double at(std::size_t l, std::size_t k) const { return probability[l * materials + k]; }
  double misfit_at(std::size_t l, std::size_t k) const { return misfit[l * materials + k]; }
  std::size_t lumitexels() const { return materials > 0 ? probability.size() / materials : 0; }
};

using LumitexelList = std::vector<std::size_t>;  // indices into Observations, ascending

// Every so manieth, so that at most `most` remain. draw: from which on (draw_phase.h).
LumitexelList thinned(const LumitexelList& list, std::size_t most, int draw = 0);
// Those with at least so many samples.
LumitexelList with_samples(const Observations& observations, std::size_t fewest = 1);

Responsibilities responsibilities(const Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels);

// Samples of the lumitexels that may belong to material k, with their shares.
std::vector<FitSample> samples_of(const Observations& observations, const LumitexelList& lumitexels,
                                  const Responsibilities& responsibilities, std::size_t k);
std::vector<FitSample> samples_of(const Observations& observations, const LumitexelList& lumitexels);

// Both steps in turn until the log likelihood changes by no more than `settled` a sample, or `rounds` have passed. Materials left with fewer than kFewestMembers lumitexels
// vanish. Returns the responsibilities under the final mixture.
inline constexpr double kFewestMembers = 20;
struct ExpectationOptions {
  int rounds = 24;
  double settled = 1e-5;
  bool ask_for_tails = true;  // what kind of tails each material's errors have, and how heavy; false: as they are, only scales follow
};
Responsibilities maximise_expectation(Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels,
                                      const MaterialFitOptions& options, const ExpectationOptions& expectation);

}  // namespace lumitexel
