#include "processing/fit/outliers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "processing/brdf/lobe_geometry.h"
#include "processing/brdf/ordered_sum.h"

namespace lumitexel {
namespace {

constexpr double kHighlightTangentSquared = 1.0 / 3.0;  // of 30 degrees between half vector and normal
constexpr double kSameBrightness = 0.5;                 // of the prediction

struct Prediction {
  ChannelValues all{}, diffuse{};  // r = f cos_i, 1/sr
};

Prediction predict(const ModelMaterial& material, const TexelWeights& weights, const LobeGeometry& geometry) {
  Prediction prediction;
  for (std::size_t k = 0; k < material.basis.size(); ++k) {
    const double weight = static_cast<double>(weights.weight[k]);
    if (!(weight > 0.0)) continue;
    const ChannelValues values = predicted_reflectance(material.basis[k], geometry);
    for (std::size_t c = 0; c < values.size(); ++c) {
      prediction.all[c] += weight * values[c];
      prediction.diffuse[c] += weight * material.basis[k].diffuse[c] * geometry.cos_i;
    }
  }
  return prediction;
}

double mean(const ChannelValues& values, int channels) {
  double sum = 0.0;
  for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c) sum += values[c];
  return sum / channels;
}

double scales_off(const ErrorModel& error, const Observation& sample, int channels, const ChannelValues& predicted) {
  return std::sqrt(sample_misfit(error, sample, channels, predicted).squares / channels);
}

// Whether the sample would be an outlier if the prediction were as bright as it.
bool is_of_another_colour(const ErrorModel& error, const Observation& sample, int channels, ChannelValues predicted, double factor) {
  for (double& value : predicted) value *= factor;
  return scales_off(error, sample, channels, predicted) > kOutlierScales;
}

OutlierReason reason_of_brightness(double measured, double predicted, double diffuse, const LobeGeometry& geometry) {
  if (measured > predicted) {
    return half_tangent_squared(geometry) < kHighlightTangentSquared ? OutlierReason::Highlight : OutlierReason::ExtraLight;
  }
  if (measured < 0.5 * diffuse) return OutlierReason::Dark;
  return predicted > 2.0 * diffuse ? OutlierReason::NoHighlight : OutlierReason::Dim;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char character : text) result += character == '"' ? std::string("\"\"") : std::string(1, character);
  return result + "\"";
}

// The outliers among one lumitexel's samples.
void look_at(std::size_t i, const ModelMaterial& material, const Observations& observations, const ErrorModel& error,
             const TexelWeights& weights, std::vector<Outlier>& found) {
  const int channels = observations.channels;
  for (std::size_t s = observations.first[i]; s < observations.first[i + 1]; ++s) {
    const Observation& sample = observations.samples[s];
    const Prediction prediction = predict(material, weights, sample.geometry);
    const double scales = scales_off(error, sample, channels, prediction.all);
    if (!(scales > kOutlierScales)) continue;
    ChannelValues measured{};
    for (std::size_t c = 0; c < measured.size(); ++c) measured[c] = static_cast<double>(sample.reflectance[c]);
    const double m = mean(measured, channels), p = mean(prediction.all, channels);
    const bool as_bright = std::abs(m - p) < kSameBrightness * p;
    const OutlierReason reason = as_bright && is_of_another_colour(error, sample, channels, prediction.all, m / p)
                                     ? OutlierReason::Colour
                                     : reason_of_brightness(m, p, mean(prediction.diffuse, channels), sample.geometry);
    found.push_back({i, observations.view[s], reason, scales, m, p});
  }
}

}  // namespace

const char* to_string(OutlierReason reason) {
  switch (reason) {
    case OutlierReason::Dark: return "dark";
    case OutlierReason::NoHighlight: return "no highlight";
    case OutlierReason::Dim: return "dim";
    case OutlierReason::Highlight: return "highlight";
    case OutlierReason::ExtraLight: return "extra light";
    case OutlierReason::Colour: return "colour";
  }
  return "unknown";
}

std::size_t total_of(const CountByReason& count) { return std::accumulate(count.begin(), count.end(), std::size_t{0}); }

Outliers find_outliers(const Model& model, const Observations& observations, const std::vector<ErrorModel>& errors,
                       const std::vector<int>& label, const std::vector<TexelWeights>& weights, std::size_t views) {
  std::vector<std::vector<Outlier>> found(observations.lumitexels());
  for_each_block(observations.lumitexels(), [&](std::size_t i) {
    const auto material = static_cast<std::size_t>(label[i]);
    look_at(i, model.materials[material], observations, errors[material], weights[i], found[i]);
  });
  Outliers outliers;
  outliers.samples = observations.samples.size();
  outliers.by_view.resize(views);
  outliers.by_material.resize(model.materials.size());
  for (const std::vector<Outlier>& own : found) {
    for (const Outlier& outlier : own) {
      const auto reason = static_cast<std::size_t>(outlier.reason);
      ++outliers.count[reason];
      ++outliers.by_view.at(outlier.view)[reason];
      ++outliers.by_material[static_cast<std::size_t>(label[outlier.lumitexel])][reason];
      outliers.worst.push_back(outlier);
    }
  }
  std::stable_sort(outliers.worst.begin(), outliers.worst.end(), [](const Outlier& a, const Outlier& b) { return a.scales > b.scales; });
  if (outliers.worst.size() > kMostOutliersListed) outliers.worst.resize(kMostOutliersListed);
  return outliers;
}

std::string outliers_csv(const Outliers& outliers, const std::vector<std::string>& view_names,
                         const std::vector<std::uint32_t>& texel, int atlas_width) {
  std::string text = "# the worst " + std::to_string(outliers.worst.size()) + " of " + std::to_string(total_of(outliers.count)) + " outliers among " +
                     std::to_string(outliers.samples) + " samples\nview,texel_x,texel_y,reason,scales,measured,predicted\n";
  const auto width = static_cast<std::uint32_t>(atlas_width);
  for (const Outlier& outlier : outliers.worst) {
    const std::uint32_t at = texel.at(outlier.lumitexel);
    char numbers[160];
    std::snprintf(numbers, sizeof numbers, ",%u,%u,%s,%.4g,%.6g,%.6g\n", at % width, at / width, to_string(outlier.reason),
                  outlier.scales, outlier.measured, outlier.predicted);
    text += quoted(view_names.at(outlier.view)) + numbers;
  }
  return text;
}

}  // namespace lumitexel
