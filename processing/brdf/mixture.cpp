#include "processing/brdf/mixture.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "processing/brdf/draw_phase.h"
#include "processing/brdf/estimate_error.h"
#include "processing/brdf/misfit.h"
#include "processing/brdf/ordered_sum.h"

namespace lumitexel {
namespace {

constexpr double kLeastProbability = 1e-3;  // below it a lumitexel is not worth its time in a material's fit
constexpr int kStepsPerRound = 1;         // of Levenberg-Marquardt

MaterialModel maximised(const MaterialModel& model, FitSamples samples, const MaterialFitOptions& options, bool ask_for_tails) {
  BrdfFitOptions fit = refit_options(model, options);
  fit.reweightings = 1;
  fit.brdf_alone = true;
  fit.max_iterations = kStepsPerRound;
  MaterialModel better{fit_brdf(model.brdf, samples, fit).brdf, model.error};
  if (!options.estimate_error) return better;
  better.error = ask_for_tails ? estimate_error_model(better.brdf, samples, model.error)
                             : updated_error_model(better.brdf, samples, model.error);
  return better;
}

// True if a material vanished.
bool maximise(Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels, const Responsibilities& r,
              const MaterialFitOptions& options, bool ask_for_tails) {
  std::vector<double> members(mixture.materials.size(), 0.0);
  for (std::size_t l = 0; l < lumitexels.size(); ++l) {
    for (std::size_t k = 0; k < members.size(); ++k) members[k] += r.at(l, k);
  }
  const double most = *std::max_element(members.begin(), members.end());
  oneapi::tbb::parallel_for(std::size_t{0}, members.size(), [&](std::size_t k) {
    if (members[k] < std::min(kFewestMembers, most)) return;
    mixture.materials[k] = maximised(mixture.materials[k], samples_of(observations, lumitexels, r, k), options, ask_for_tails);
  });
  Mixture kept{{}, {}, mixture.noise};
  for (std::size_t k = 0; k < members.size(); ++k) {
    if (members[k] < std::min(kFewestMembers, most)) continue;
    kept.materials.push_back(mixture.materials[k]);
    kept.share.push_back(members[k]);
  }
  const double all = std::accumulate(kept.share.begin(), kept.share.end(), 0.0);
  for (double& share : kept.share) share /= all;
  const bool vanished = kept.materials.size() != mixture.materials.size();
  mixture = std::move(kept);
  return vanished;
}

// ln of the sum of exponentials, and the exponentials themselves normalised.
double normalise(double* log_probability, std::size_t count) {
  const double most = *std::max_element(log_probability, log_probability + count);
  double sum = 0.0;
  for (std::size_t k = 0; k < count; ++k) sum += log_probability[k] = std::exp(log_probability[k] - most);
  for (std::size_t k = 0; k < count; ++k) log_probability[k] /= sum;
  return most + std::log(sum);
}

std::uint16_t view_of(const Observations& observations, const Observation& sample) {
  return observations.view.empty() ? std::uint16_t{0} : observations.view[static_cast<std::size_t>(&sample - observations.samples.data())];
}

template <typename Misfit>
Responsibilities responsibilities_by(const std::vector<Misfit>& materials, const Mixture& mixture, const Observations& observations,
                                     const LumitexelList& lumitexels) {
  const std::size_t count = materials.size();
  Responsibilities r{count, std::vector<double>(lumitexels.size() * count), std::vector<double>(lumitexels.size() * count), 0.0};
  r.log_likelihood = ordered_sum(lumitexels.size(), 0.0, [&](std::size_t l, double& sum) {
    double* log_probability = &r.probability[l * count];
    for (std::size_t k = 0; k < count; ++k) {
      const double value = materials[k].of(observations.of(lumitexels[l]));
      r.misfit[l * count + k] = value;
      log_probability[k] = std::log(mixture.share[k]) - 0.5 * value;
    }
    sum += normalise(log_probability, count);
  });
  return r;
}

}  // namespace

LumitexelList thinned(const LumitexelList& list, std::size_t most, int draw) {
  const std::size_t stride = std::max<std::size_t>(1, (list.size() + most - 1) / std::max<std::size_t>(1, most));
  LumitexelList some;
  const auto first = static_cast<std::size_t>(draw_phase(draw) * static_cast<double>(stride));
  for (std::size_t k = first; k < list.size(); k += stride) some.push_back(list[k]);
  return some;
}

LumitexelList with_samples(const Observations& observations, std::size_t fewest) {
  LumitexelList some;
  for (std::size_t i = 0; i < observations.lumitexels(); ++i) {
    if (observations.of(i).size() >= fewest) some.push_back(i);
  }
  return some;
}

Responsibilities responsibilities(const Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels) {
  if (mixture.noise.normal()) {
    std::vector<PreparedMisfit> materials;
    for (const MaterialModel& material : mixture.materials) materials.emplace_back(material.brdf, material.error);
    return responsibilities_by(materials, mixture, observations, lumitexels);
  }
  std::vector<ShapedMisfit> materials;
  for (const MaterialModel& material : mixture.materials) materials.emplace_back(material.brdf, material.error, mixture.noise);
  return responsibilities_by(materials, mixture, observations, lumitexels);
}

std::vector<FitSample> samples_of(const Observations& observations, const LumitexelList& lumitexels, const Responsibilities& r,
                                  std::size_t k) {
  std::vector<FitSample> samples;
  for (std::size_t l = 0; l < lumitexels.size(); ++l) {
    if (r.at(l, k) < kLeastProbability) continue;
    for (const Observation& sample : observations.of(lumitexels[l])) {
      samples.push_back({&sample, r.at(l, k), static_cast<std::uint32_t>(lumitexels[l]), view_of(observations, sample)});
    }
  }
  return samples;
}

std::vector<FitSample> samples_of(const Observations& observations, const LumitexelList& lumitexels) {
  std::vector<FitSample> samples;
  for (const std::size_t i : lumitexels) {
    for (const Observation& sample : observations.of(i)) {
      samples.push_back({&sample, 1.0, static_cast<std::uint32_t>(i), view_of(observations, sample)});
    }
  }
  return samples;
}

Responsibilities maximise_expectation(Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels,
                                      const MaterialFitOptions& options, const ExpectationOptions& expectation) {
  Responsibilities r = responsibilities(mixture, observations, lumitexels);
  double samples = 0.0;
  for (const std::size_t i : lumitexels) samples += static_cast<double>(observations.of(i).size());
  for (int round = 0; round < expectation.rounds; ++round) {
    const double before = r.log_likelihood;
    const bool vanished = maximise(mixture, observations, lumitexels, r, options, expectation.ask_for_tails && round == 0);
    r = responsibilities(mixture, observations, lumitexels);
    if (!vanished && std::abs(r.log_likelihood - before) <= expectation.settled * samples) break;
  }
  return r;
}

}  // namespace lumitexel
