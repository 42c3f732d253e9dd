#include <cstring>

#include "processing/brdf/evaluate_packed.h"
#include "processing/brdf/numerics/kernel_cases.h"
#include "processing/brdf/numerics/lobe_trials.h"

namespace lumitexel {
namespace {

constexpr double kPeakLimit = 3e-7, kElsewhereLimit = 1.2e-6, kSlopeFactor = 10.0, kFacetLimit = 3e-6;
constexpr std::size_t kBatch = 250;  // geometries for each lobe: not a multiple of any vector
// Below this base 48 bits do not tell the value for N < 1, nor the slope by aim, which goes as D^(N - 1), for N < 2.
constexpr double kLeastBase = 1e-8, kSteepLogExponent = 0.6931471805599453;

struct Batch {
  LobeTrial lobe;
  Brdf brdf;
  std::vector<LobeGeometry> geometries;
  PackedGeometries packed;

  void add(const DirectionPair& pair) {
    geometries.push_back(rounded_geometry(pair));
    packed.add(geometries.back());
  }
};

Batch batch_for(BrdfFamily family, const LobeTrial& lobe) {
  Batch batch{lobe, {family, 1, {}, std::vector<std::array<Lobe, kMaxChannels>>(1)}, {}, {}};
  if (family != BrdfFamily::Lafortune) batch.lobe.log_strength = -3.2;  // of 0.04: a reflectance
  batch.brdf.lobes[0].fill({batch.lobe.log_strength, lobe.log_shape, lobe.aim});
  return batch;
}

double base_of(const LobeTrial& lobe, const QuadSlopes& reference) {
  return reference.gain > 0 ? std::exp(std::log(static_cast<double>(reference.gain)) / std::exp(lobe.log_shape)) : 1.0;
}

class Errors {
 public:
  LargestError peak, elsewhere, slope_peak, slope_elsewhere;
  double differing = 0;
  std::size_t values_excluded = 0, slopes_excluded = 0;

  void see(const Batch& batch) {
    const std::size_t n = batch.geometries.size();
    std::vector<float> values(n), by_shape(n), by_aim(n), lone(n);
    evaluate(batch.brdf, batch.packed, values);
    const bool aims = batch.brdf.family == BrdfFamily::Lafortune;
    if (aims) lafortune_slopes(batch.brdf.lobes[0][0], batch.packed, {lone, by_shape, by_aim}, widest_vectors());
    for (std::size_t i = 0; i < n; ++i) {
      const QuadSlopes wanted = reference_slopes(batch.brdf.family, batch.lobe.log_shape, batch.lobe.aim, as_stored(batch.geometries[i]));
      const bool told = !aims || batch.lobe.log_shape >= kSteepLogExponent || base_of(batch.lobe, wanted) >= kLeastBase;
      const bool value_told = told || batch.lobe.log_shape >= 0.0;
      if (value_told) see_value(batch, i, wanted, values[i]);
      if (aims && told) see_slopes(batch, wanted, by_shape[i], by_aim[i]);
      values_excluded += !value_told;
      slopes_excluded += aims && !told;
    }
    see_widths(batch, values);
  }

 private:
  static double strength(const Batch& batch) { return std::exp(batch.lobe.log_strength); }

  void see_value(const Batch& batch, std::size_t i, const QuadSlopes& wanted, float got) {
    const Quad strong = static_cast<Quad>(strength(batch));
    const double f = static_cast<double>(strong * wanted.gain + wanted.offset);
    double top = strength(batch);
    if (batch.brdf.family != BrdfFamily::Lafortune) {
      QuadGeometry on_normal = as_stored(batch.geometries[i]);
      on_normal.across2 = 0;
      const QuadSlopes most = reference_slopes(batch.brdf.family, batch.lobe.log_shape, batch.lobe.aim, on_normal);
      top = static_cast<double>(strong * most.gain + most.offset);
    }
    const double error = (f - static_cast<double>(got)) / std::max(f, 1e-3 * top);
    (f > 0.1 * top ? peak : elsewhere).see(error);
  }

  void see_slopes(const Batch& batch, const QuadSlopes& wanted, float by_shape, float by_aim) {
    const double a = strength(batch), gain = static_cast<double>(wanted.gain);
    LargestError& error = gain > 0.1 ? slope_peak : slope_elsewhere;
    for (const auto& [reference, got] : {std::pair(wanted.gain_by_shape, by_shape), std::pair(wanted.gain_by_aim, by_aim)}) {
      const double slope = a * static_cast<double>(reference);
      error.see((slope - static_cast<double>(got)) / std::max({a * gain, 1e-3 * a, std::abs(slope)}));
    }
  }

  void see_widths(const Batch& batch, const std::vector<float>& values) {
    for (const VectorWidth width : {VectorWidth::Scalar, VectorWidth::Avx2}) {
      if (width > widest_vectors()) continue;
      std::vector<float> others(values.size());
      evaluate(batch.brdf, batch.packed, others, width);
      for (std::size_t i = 0; i < values.size(); ++i) differing += std::memcmp(&values[i], &others[i], sizeof(float)) != 0;
    }
  }
};

Errors random_batches(BrdfFamily family, const ShapeRange& shape, std::size_t trials) {
  RandomNumbers random(5);
  Errors errors;
  for (std::size_t done = 0; done < trials; done += kBatch) {
    Batch batch = batch_for(family, random_lobe(family, shape, random));
    for (std::size_t i = 0; i < kBatch; ++i) batch.add(random_directions(family, batch.lobe, random));
    errors.see(batch);
  }
  return errors;
}

Errors small_bases(std::size_t trials) {
  RandomNumbers random(6);
  Errors errors;
  for (std::size_t done = 0; done < trials; ++done) {
    LobeTrial lobe = random_lobe(BrdfFamily::Lafortune, {0.01, 4.0}, random);
    const DirectionPair pair = random_directions(BrdfFamily::Lafortune, lobe, random);
    if (!aim_at_small_base(pair, random, lobe.aim)) continue;
    Batch batch = batch_for(BrdfFamily::Lafortune, lobe);
    batch.add(pair);
    errors.see(batch);
  }
  return errors;
}

void add_rows(const std::string& name, const Errors& errors, NumericCases& cases) {
  const std::string values_because = errors.values_excluded > 0 ? "N under 1 and a base under 1e-8, whose 48 bits do not tell the value" : "";
  const std::string slopes_because = errors.slopes_excluded > 0 ? "N under 2 and a base under 1e-8, whose 48 bits do not tell the slope by aim" : "";
  cases.push_back({name, "value, f > peak / 10", errors.peak.value(), kPeakLimit, errors.values_excluded, values_because});
  cases.push_back({name, "value elsewhere", errors.elsewhere.value(), kElsewhereLimit, errors.values_excluded, values_because});
  cases.push_back({name, "slopes, f > peak / 10", errors.slope_peak.value(), kSlopeFactor * kPeakLimit, errors.slopes_excluded, slopes_because});
  cases.push_back({name, "slopes elsewhere", errors.slope_elsewhere.value(), kSlopeFactor * kElsewhereLimit, errors.slopes_excluded, slopes_because});
}

}  // namespace

NumericCases float_kernel_cases(std::size_t trials) {
  NumericCases cases;
  double differing = 0.0;
  for (const auto& [shape, text] : {std::pair(ShapeRange{0.01, 1.0}, "N 0.01 to 1"), std::pair(ShapeRange{1.0, 100.0}, "N 1 to 100"),
                                    std::pair(ShapeRange{100.0, 1e4}, "N 100 to 1e4"), std::pair(ShapeRange{1e4, 1e5}, "N 1e4 to 1e5")}) {
    const Errors errors = random_batches(BrdfFamily::Lafortune, shape, trials);
    add_rows(std::string("lafortune float, peaks 1e-6 to 1e6, ") + text, errors, cases);
    differing += errors.differing;
  }
  const Errors small = small_bases(trials);
  add_rows("lafortune float, base 1e-8 to 0.1, at and below zero", small, cases);
  for (const BrdfFamily family : {BrdfFamily::Ggx, BrdfFamily::Ward}) {
    const Errors errors = random_batches(family, {1e-3, 1.0}, trials);
    cases.push_back({std::string(to_string(family)) + " float, alpha 0.001 to 1", "value, to 89.99 degrees",
                     std::max(errors.peak.value(), errors.elsewhere.value()), kFacetLimit});
    differing += errors.differing;
  }
  cases.push_back({"float kernels, every vector width", "values that differ in any bit", differing + small.differing, 0.0});
  return cases;
}

}  // namespace lumitexel
