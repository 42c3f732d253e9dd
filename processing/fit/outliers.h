// Samples that the finished model does not explain, and what each looks like.
//
// Nothing is dropped for being one: a fit either lets it count less or not (FitOptions::errors). They are listed so that somebody can
// look at the photographs: they are where meshes, shadows and light between surfaces go wrong.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "processing/brdf/error_model.h"
#include "processing/brdf/project_weights.h"
#include "processing/model/model.h"

namespace lumitexel {

enum class OutlierReason {
  Dark,         // under half of the diffuse light alone: a shadow that the mesh does not cast, or something in the way
  NoHighlight,  // darker than predicted, which was mostly a highlight: the normal, the position or the material is wrong
  Dim,          // darker than predicted otherwise
  Highlight,    // brighter than predicted, half vector within 30 degrees of the normal: a highlight that was not predicted
  ExtraLight,   // brighter than predicted elsewhere: light from other surfaces, or another material
  Colour        // as bright as predicted within a half, and an outlier even if it were just as bright: of another colour
};
inline constexpr OutlierReason kOutlierReasons[] = {OutlierReason::Dark,      OutlierReason::NoHighlight, OutlierReason::Dim,
                                                    OutlierReason::Highlight, OutlierReason::ExtraLight,  OutlierReason::Colour};
using CountByReason = std::array<std::size_t, std::size(kOutlierReasons)>;
const char* to_string(OutlierReason reason);  // "dark", "no highlight", "dim", "highlight", "extra light", "colour"

struct Outlier {
  std::size_t lumitexel = 0;
  std::uint16_t view = 0;
  OutlierReason reason = OutlierReason::Dark;
  double scales = 0;  // root mean square of the channels' residuals over the error model's scales
  double measured = 0, predicted = 0;  // reflectance r, mean of the channels, 1/sr
};

// From this many scales on a sample is an outlier: a Gaussian error passes it once in a hundred thousand samples of three channels.
inline constexpr double kOutlierScales = 3.0;
inline constexpr std::size_t kMostOutliersListed = 10000;

struct Outliers {
  std::size_t samples = 0;                 // looked at
  CountByReason count{};                   // of all, listed or not
  std::vector<CountByReason> by_view, by_material;
  std::vector<Outlier> worst;              // at most kMostOutliersListed, the worst first
};
std::size_t total_of(const CountByReason& count);

// observations.view must be filled. errors: one a material. label: material of each lumitexel. weights: of the model's basis, one entry
// a lumitexel.
Outliers find_outliers(const Model& model, const Observations& observations, const std::vector<ErrorModel>& errors,
                       const std::vector<int>& label, const std::vector<TexelWeights>& weights, std::size_t views);

// "# the worst 10000 of 23456 outliers among 300000 samples", then "view,texel_x,texel_y,reason,scales,measured,predicted" and a row for each of
// the worst; names in double quotes (RFC 4180). texel: atlas index of each lumitexel.
std::string outliers_csv(const Outliers& outliers, const std::vector<std::string>& view_names,
                         const std::vector<std::uint32_t>& texel, int atlas_width);

}  // namespace lumitexel
