// The synthetic experiment of section 11 of the paper: five materials of one diffuse colour that differ only in their exponent, under noise
// of 5 %, some 46,000 samples; and how well clustering did on it.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "processing/brdf/cluster_materials.h"

namespace lumitexel {

struct FiveMaterialsOptions {
  int lumitexels = 4182, samples_each = 11;
  bool even = true;            // false: 55, 25, 10, 6 and 4 % of the lumitexels
  bool gaussian = false;       // else uniform within +- noise, as the paper has it
  double noise = 0.05;         // half width of the uniform; a Gaussian has the same variance
  double outliers = 0;         // share of samples, all channels alike, that are multiplied by a number from 0 to 3
};
inline constexpr double kMostOutlierFactor = 3.0;
inline constexpr double kPaperError = 0.002;  // of every N and kd: what the paper reached

struct FiveMaterials {
  std::uint64_t seed = 0;
  Observations observations;
  std::vector<int> label;      // of each lumitexel
  std::vector<Brdf> truth;     // exponents 36.2 to 60.2
  double relative_sigma = 0;   // of the noise
  FiveMaterialsOptions options;
};

// Five viewing directions, lights uniform over the hemisphere above 6 degrees of elevation. The same seed, the same bits.
// Throws std::invalid_argument for outliers in Gaussian noise, whose bound nobody worked out.
FiveMaterials make_five_materials(std::uint64_t seed, const FiveMaterialsOptions& options);

std::vector<Brdf> five_materials_truth();
std::vector<double> material_shares(const FiveMaterials& world);  // of the lumitexels, as they are in this world

struct FiveMaterialsScore {
  int found = 0;                       // materials
  bool all_found = false;              // five, and each exponent nearer to its truth than halfway to the next
  double worst_exponent = 0;           // largest relative error of the five (infinite unless all were found)
  double worst_diffuse = 0;            // of the fifteen kd
  double squared_exponent = 0;         // mean over the five of (error / Cramer-Rao bound)^2, in ln N
  double squared_diffuse = 0;          // mean over the fifteen
  // The same over the bound for who is told no labels, which is worked out for Gaussian noise alone: NaN for uniform noise, or unless five were found.
  double squared_exponent_unlabelled = std::numeric_limits<double>::quiet_NaN();
  double squared_diffuse_unlabelled = std::numeric_limits<double>::quiet_NaN();
  // Of all twenty within kPaperError for who reaches the bound: the one without labels for Gaussian noise, else the one with them.
  double chance_at_bound = 0;
  // The same apart, in bounds, by material and channel; all zero unless five were found.
  std::array<double, 5> log_exponent_error{};
  std::array<ChannelValues, 5> diffuse_error{};
  std::vector<Brdf> fitted;            // in the order of the truth; empty unless five were found
  // Shares of lumitexels labelled rightly: by the clustering, and by the two references of label_bound.h.
  double accuracy = 0, bayes_accuracy = 0, normal_accuracy = 0;
};

// The bounds are those of parameter_bound.h.
FiveMaterialsScore score(const FiveMaterials& world, const Clustering& clustering);

}  // namespace lumitexel
