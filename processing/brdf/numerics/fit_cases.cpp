#include "processing/brdf/numerics/fit_cases.h"

#include "processing/brdf/cluster_materials.h"
#include "processing/brdf/fit_material.h"
#include "processing/brdf/numerics/synthetic_observations.h"
#include "processing/brdf/reject_samples.h"
#include "processing/brdf/select_lumitexels.h"

namespace lumitexel {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPi = 3.141592653589793;

double prediction_error(const Brdf& fitted, const Brdf& truth, const Observations& observations) {
  double largest = 0.0;
  for (const Observation& sample : observations.samples) largest = std::max(largest, predicted_reflectance(truth, 0, sample.geometry));
  LargestError error;
  for (const Observation& sample : observations.samples) {
    const ChannelValues found = predicted_reflectance(fitted, sample.geometry), wanted = predicted_reflectance(truth, sample.geometry);
    for (std::size_t c = 0; c < static_cast<std::size_t>(truth.channels); ++c) {
      error.see((found[c] - wanted[c]) / std::max(wanted[c], 1e-3 * largest));
    }
  }
  return error.value();
}

bool all_finite(const BrdfFit& fit) { return fit.covariance.allFinite() && std::isfinite(fit.misfit) && std::isfinite(fit.chi_squared); }

double material_error(const Observations& observations, const Brdf& truth) {
  const MaterialFit fit = fit_material(all_samples(observations), observations.channels, nullptr, {});
  if (!all_finite(fit.fit) || !std::isfinite(fit.criterion)) return kInfinity;
  return prediction_error(fit.model.brdf, truth, observations);
}

// Samples with light and view at given angles, measured without noise.
template <typename Directions>
Observations measured(const Brdf& truth, std::size_t count, const Directions& directions) {
  RandomNumbers random(11);
  Observations observations;
  observations.channels = truth.channels;
  for (std::size_t i = 0; i < count; ++i) {
    Observation sample;
    sample.geometry = rounded_geometry(directions(random));
    const ChannelValues values = predicted_reflectance(truth, sample.geometry);
    for (std::size_t c = 0; c < kMaxChannels; ++c) sample.reflectance[c] = static_cast<float>(values[c]);
    observations.samples.push_back(sample);
    if (i % 5 == 4) observations.first.push_back(observations.samples.size());
  }
  return observations;
}

NumericCase all_equal() {
  const Brdf truth = shiny_brdf(0.1, 1.0, 30.0);
  const Observations observations = measured(truth, 300, [](RandomNumbers&) { return DirectionPair{0.5, 0.6, 3.0}; });
  const BrdfFit fit = fit_brdf(shiny_brdf(0.2, 0.5, 10.0), all_samples(observations), {});
  const bool stated = fit.rank_deficient && all_finite(fit);
  return {"all samples equal", "fit_brdf: prediction, and the flag", stated ? prediction_error(fit.brdf, truth, observations) : kInfinity, 1e-3};
}

NumericCase one_light() {
  const Brdf truth = shiny_brdf(0.1, 1.0, 30.0);
  const Observations observations = measured(truth, 500, [](RandomNumbers& random) {
    return DirectionPair{0.6, random.uniform(0.0, 1.3), random.uniform(0.0, 2.0 * kPi)};
  });
  return {"one light, many views", "fit_material: prediction", material_error(observations, truth), 1e-2};
}

NumericCase coplanar_views() {
  const Brdf truth = shiny_brdf(0.1, 1.0, 30.0);
  const Observations observations = measured(truth, 500, [](RandomNumbers& random) {
    return DirectionPair{random.uniform(0.0, 1.3), random.uniform(0.0, 1.3), random.uniform() < 0.5 ? 0.0 : kPi};
  });
  return {"light and all views in one plane", "fit_material: prediction", material_error(observations, truth), 1e-2};
}

NumericCase grazing() {
  const Brdf truth = shiny_brdf(0.1, 1.0, 30.0);
  const Observations observations = measured(truth, 500, [](RandomNumbers& random) {
    const double most = 1.570621793869697;
    return DirectionPair{random.uniform(1.4, most), random.uniform(1.4, most), kPi + random.uniform(-0.3, 0.3)};
  });
  return {"light and views from 80 to 89.99 degrees", "fit_material: prediction", material_error(observations, truth), 1e-2};
}

NumericCase samples_each(std::size_t lumitexels, std::size_t samples) {
  const Brdf truth = shiny_brdf(0.1, 1.0, 30.0);
  return {std::to_string(samples) + (samples == 1 ? " sample" : " samples") + " a lumitexel", "fit_material: prediction",
          material_error(random_observations(truth, lumitexels, samples, 0.0, 12), truth), 1e-2};
}

// A black object with a mirror's highlight: reflectances from 1e-8 to 1e4 in one fit.
NumericCase twelve_decades() {
  const Brdf truth = shiny_brdf(1e-8, 1e4, 1e5);
  const Observations observations = measured(truth, 2000, [](RandomNumbers& random) {
    const double theta = random.uniform(0.0, 1.0), width = std::exp(random.uniform(std::log(1e-3), std::log(0.5)));
    return DirectionPair{theta, std::abs(theta + random.uniform(-width, width)), kPi + random.uniform(-width, width)};
  });
  BrdfFitOptions options;
  options.bounds = {widest_bounds(BrdfFamily::Lafortune)};
  options.error.relative = 0.01;
  options.error.floor = 1e-10;
  options.error.freedom = ErrorModel::kGaussian;
  const BrdfFit fit = fit_brdf(shiny_brdf(2e-8, 8e3, 0.9e5), all_samples(observations), options);
  LargestError error;
  for (const Observation& sample : observations.samples) {
    error.see(predicted_reflectance(fit.brdf, 0, sample.geometry) / predicted_reflectance(truth, 0, sample.geometry) - 1.0);
  }
  return {"radiances over 12 decades (kd 1e-8, peak 1e4, N 1e5)", "fit_brdf: prediction, relative at every sample",
          all_finite(fit) ? error.value() : kInfinity, 1e-3};
}

// The whole scale of the numbers wrong by up to a million, as by a forgotten unit.
NumericCase scales() {
  double worst = 0.0;
  for (const double scale : {1e-6, 1e-3, 1e3, 1e6}) {
    Observations observations = random_observations(shiny_brdf(0.1, 1.0, 30.0), 40, 6, 0.02, 13);
    for (Observation& sample : observations.samples) {
      for (float& value : sample.reflectance) value *= static_cast<float>(scale);
    }
    const MaterialFit fit = fit_material(all_samples(observations), 3, nullptr, {});
    bool finite = all_finite(fit.fit) && std::isfinite(fit.criterion);
    for (const Observation& sample : observations.samples) finite = finite && std::isfinite(predicted_reflectance(fit.model.brdf, 0, sample.geometry));
    worst += !finite;
  }
  return {"reflectances 1e-6 to 1e6 times too large", "fit_material: scales with a number that is none", worst, 0.0};
}

NumericCase nothing_at_all() {
  const MaterialFit material = fit_material({}, 3, nullptr, {});
  const BrdfFit fit = fit_brdf(shiny_brdf(0.1, 1.0, 30.0), {}, {});
  const bool good = fit.rank_deficient && all_finite(fit) && all_finite(material.fit) && std::isfinite(material.criterion);
  return {"no samples", "fit_brdf, fit_material: finite, and the flag", good ? 0.0 : kInfinity, 0.0};
}

// Every kind of number that is none, planted; what is left must give the fit of the clean samples, bit for bit.
NumericCase poisoned() {
  const Observations clean = random_observations(shiny_brdf(0.1, 1.0, 30.0), 100, 6, 0.02, 14);
  Observations poisoned;
  poisoned.channels = clean.channels;
  std::size_t planted = 0;
  for (std::size_t i = 0; i < clean.lumitexels(); ++i) {
    for (const Observation& sample : clean.of(i)) {
      poisoned.samples.push_back(sample);
      Observation bad = sample;
      switch (planted++ % 4) {
        case 0: bad.reflectance[1] = std::numeric_limits<float>::quiet_NaN(); break;
        case 1: bad.reflectance[2] = std::numeric_limits<float>::infinity(); break;
        case 2: bad.variance[0] = -std::numeric_limits<float>::infinity(); break;
        default: bad.geometry.mirror_gap = std::numeric_limits<double>::quiet_NaN(); break;
      }
      poisoned.samples.push_back(bad);
    }
    poisoned.first.push_back(poisoned.samples.size());
  }
  const RejectedSamples rejected = reject_unusable(poisoned);
  const bool counted = rejected.not_finite == planted && rejected.below_surface == 0 && poisoned.samples.size() == clean.samples.size();
  const Brdf a = fit_material(all_samples(clean), 3, nullptr, {}).model.brdf, b = fit_material(all_samples(poisoned), 3, nullptr, {}).model.brdf;
  bool same = counted && a.lobes.size() == b.lobes.size() && a.diffuse == b.diffuse;
  for (std::size_t l = 0; same && l < a.lobes.size(); ++l) {
    for (std::size_t c = 0; c < 3; ++c) same = same && a.lobes[l][c].log_strength == b.lobes[l][c].log_strength && a.lobes[l][c].same_shape(b.lobes[l][c]);
  }
  return {"NaN and infinities among the samples", "all counted at the gate; fit as without them", same ? 0.0 : kInfinity, 0.0};
}

}  // namespace

NumericCases fit_cases() {
  return {samples_each(400, 1), samples_each(10, 200), all_equal(), one_light(), coplanar_views(), grazing(), twelve_decades(), scales(),
          nothing_at_all(), poisoned()};
}

NumericCases extent_cases(std::size_t lumitexels) {
  const Brdf first = shiny_brdf(0.1, 1.0, 30.0), second = shiny_brdf(0.4, 0.3, 8.0);
  ClusterOptions options;
  options.materials = 2;
  const Observations lone = random_observations(first, 1, 4, 0.0, 15);
  const Clustering of_one = cluster_materials(lone, {0}, options, [](int) {});
  const bool good = of_one.label.size() == 1 && !of_one.materials.empty();
  NumericCases cases{{"1 lumitexel", "cluster_materials: prediction",
                      good ? prediction_error(of_one.materials[0].model.brdf, first, lone) : kInfinity, 0.5}};

  Observations many = random_observations(first, lumitexels / 2, 3, 0.02, 16);
  const Observations others = random_observations(second, lumitexels - lumitexels / 2, 3, 0.02, 17);
  const std::size_t before = many.samples.size();
  many.samples.insert(many.samples.end(), others.samples.begin(), others.samples.end());
  for (std::size_t i = 1; i < others.first.size(); ++i) many.first.push_back(before + others.first[i]);
  const Clustering found = cluster_materials(many, select_lumitexels(many, 400), options, [](int) {});
  std::size_t agreeing = 0;
  for (std::size_t i = 0; i < many.lumitexels(); ++i) agreeing += (found.label[i] == found.label[0]) == (i < lumitexels / 2);
  cases.push_back({std::to_string(lumitexels) + " lumitexels of two materials", "cluster_materials: share mislabelled",
                   1.0 - static_cast<double>(agreeing) / static_cast<double>(lumitexels), 1e-2});
  return cases;
}

}  // namespace lumitexel
