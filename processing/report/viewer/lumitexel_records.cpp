#include "processing/report/viewer/lumitexel_records.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "drivers/error.h"
#include "processing/brdf/ordered_sum.h"
#include "processing/fit/observe.h"
#include "processing/fit/provenance.h"
#include "processing/report/viewer/fit_errors.h"
#include "processing/report/viewer/light_taken.h"
#include "processing/report/viewer/listed_outliers.h"
#include "processing/surface/best_view.h"
#include "processing/surface/gather_lumitexels.h"

namespace lumitexel {
namespace {

using nlohmann::json;

constexpr auto kUsed = static_cast<std::uint8_t>(SampleVerdict::Used);

void check_session(const Model& model, const CalibratedSession& session, const Atlas& atlas) {
  const std::string fitted_to = fitted_session_key(model);
  if (fitted_to != session.key || atlas.width != model.width || atlas.height != model.height || session.channels != model.channels) {
    throw BadInput("session", "content " + session.key, "the one that the model was fitted to, " + fitted_to);
  }
}

// As the fit's last pass had them: on the fitted normals, where there are any.
void turn_to_fitted(const Model& model, LumitexelSet& set) {
  if (!has_normals(model)) return;
  for (LumitexelTile& tile : set.tiles) {
    for (std::size_t k = 0; k < tile.size(); ++k) {
      const float* n = &model.normal.data[std::size_t{3} * tile.texel[k]];
      const Eigen::Vector3d normal(n[0], n[1], n[2]);
      if (!normal.isZero()) tile.normal[k] = normal.normalized();
    }
  }
}

struct SampleRecord {
  ChannelValues predicted{};
  double weight = 0, scales_off = 0;  // weight: of the texel's least squares, mean of the channels
};

// Of the channels' own entries in the inverse covariance that a texel's least squares weigh the sample by (texel_system.h).
double mean_precision(const ErrorModel& error, const Observation& sample, int channels, const ChannelValues& of_material) {
  const ScaledResiduals scaled = scaled_residuals(error, sample, channels, of_material);
  const ChannelMatrix whitening = error.whitening().size() > 0 ? error.whitening() : ChannelMatrix(ChannelMatrix::Identity(channels, channels));
  double sum = 0.0;
  for (Eigen::Index c = 0; c < channels; ++c) sum += whitening.col(c).squaredNorm() / std::pow(scaled.scale[static_cast<std::size_t>(c)], 2);
  return sum / channels;
}

struct Predictor {
  const Model& model;
  std::optional<FitErrors> errors;

  SampleRecord operator()(std::uint32_t texel, const Observation& sample) const {
    const int x = static_cast<int>(texel) % model.width, y = static_cast<int>(texel) / model.width;
    SampleRecord record;
    for (int c = 0; c < model.channels; ++c) {
      record.predicted[static_cast<std::size_t>(c)] = sample.geometry.cos_i * evaluate_texel(model, FitStage::Normal, x, y, c, sample.geometry);
    }
    const int material = model.material[texel];
    if (!errors || material == Model::kNoMaterial) return record;
    const auto m = static_cast<std::size_t>(material);
    record.weight = mean_precision(errors->weights[m], sample, model.channels, predicted_reflectance(model.materials[m].brdf, sample.geometry));
    record.scales_off = std::sqrt(sample_misfit(errors->residuals[m], sample, model.channels, record.predicted).squares / model.channels);
    return record;
  }
};

// Weights of one lumitexel's samples become shares.
void share_out(std::span<SampleRecord> samples) {
  double sum = 0.0;
  for (const SampleRecord& sample : samples) sum += sample.weight;
  for (SampleRecord& sample : samples) sample.weight = sum > 0.0 ? sample.weight / sum : 0.0;
}

std::vector<SampleRecord> predict_all(const Predictor& predict, const Observations& observations, const std::vector<std::uint32_t>& texel) {
  std::vector<SampleRecord> samples(observations.samples.size());
  for_each_block(observations.lumitexels(), [&](std::size_t i) {
    const std::size_t first = observations.first[i], count = observations.first[i + 1] - first;
    for (std::size_t s = first; s < first + count; ++s) samples[s] = predict(texel[i], observations.samples[s]);
    share_out({samples.data() + first, count});
  });
  return samples;
}

// indirect: of the sample's channels, what was taken out of it; or null.
void append(const Observation& sample, const SampleRecord& record, const float* indirect, const LumitexelRecords& records, std::uint8_t reason, ViewRecords& view) {
  for (std::size_t c = 0; c < static_cast<std::size_t>(records.channels); ++c) {
    const float between = indirect != nullptr ? indirect[c] : 0.0f;
    view.measured.push_back(sample.reflectance[c] + between);
    view.predicted.push_back(static_cast<float>(record.predicted[c]) + between);
  }
  if (records.weighed) {
    view.share.push_back(static_cast<float>(record.weight));
    view.scales_off.push_back(static_cast<float>(record.scales_off));
  }
  view.reason.push_back(reason);
}

// Observations are in the order of lumitexels, then of views, but lack the samples that no fit may meet; `indirect` (of take_light_of_fit) has them.
void sort_by_view(const CalibratedSession& session, const Model& model, const Observations& observations,
                  const std::vector<SampleRecord>& samples, const std::vector<float>& indirect, LumitexelRecords& records) {
  const auto listed = listed_outliers(model.outliers_csv, model.width);
  const auto channels = static_cast<std::size_t>(records.channels);
  std::size_t gathered = 0;
  for (std::size_t i = 0; i < observations.lumitexels(); ++i) {
    std::size_t s = observations.first[i];
    for (std::size_t k = 0; k < records.used_views.size(); ++k) {
      ViewRecords& view = records.by_view[k];
      if (view.verdict[i] != kUsed) continue;
      const float* between = indirect.empty() ? nullptr : &indirect[channels * gathered];
      ++gathered;
      if (s == observations.first[i + 1] || observations.view[s] != records.used_views[k]) {
        view.verdict[i] = kBelowFittedNormal;
        continue;
      }
      const auto found = listed.find({session.views[records.used_views[k]].name, records.texel[i]});
      append(observations.samples[s], samples[s], between, records, found == listed.end() ? 0 : static_cast<std::uint8_t>(1 + static_cast<int>(found->second)), view);
      ++s;
    }
  }
}

}  // namespace

LumitexelRecords lumitexel_records(const Model& model, const CalibratedSession& session, Progress& progress) {
  const json provenance = json::parse(model.provenance_json);
  const RayScene scene(session.mesh);
  LayoutSummary ignored;
  const Atlas atlas = lay_out(session, choose_best_views(session, scene), layout_of(model), ignored);
  check_session(model, session, atlas);
  GatheredLumitexels gathered = gather_lumitexels(session, atlas, scene, progress);
  turn_to_fitted(model, gathered.set);
  if (model.indirect_bounces > 0) progress.begin("light between surfaces", 1, "rounds");
  const std::vector<float> indirect = take_light_of_fit(model, session, gathered.set);
  if (model.indirect_bounces > 0) progress.update(1);
  const Observations observations = observe(session, gathered.set);

  const Predictor predictor{model, errors_of_fit(model)};
  LumitexelRecords records{model.channels, predictor.errors.has_value(), {}, {}, gathered.used_views, {}};
  for (const LumitexelTile& tile : gathered.set.tiles) {
    records.texel.insert(records.texel.end(), tile.texel.begin(), tile.texel.end());
    records.position.insert(records.position.end(), tile.position.begin(), tile.position.end());
  }
  for (const auto& verdicts : gathered.verdict) {
    records.by_view.emplace_back();
    for (const SampleVerdict verdict : verdicts) records.by_view.back().verdict.push_back(static_cast<std::uint8_t>(verdict));
  }
  sort_by_view(session, model, observations, predict_all(predictor, observations, records.texel), indirect, records);
  return records;
}

std::vector<float> rms_residual(const LumitexelRecords& records, const Model& model) {
  const auto channels = static_cast<std::size_t>(records.channels);
  std::vector<double> squares(model.material.size(), 0.0);
  std::vector<std::size_t> values(model.material.size(), 0);
  for (const ViewRecords& view : records.by_view) {
    std::size_t s = 0;
    for (std::size_t i = 0; i < records.texel.size(); ++i) {
      if (view.verdict[i] != kUsed) continue;
      for (std::size_t c = 0; c < channels; ++c, ++s) {
        const double residual = static_cast<double>(view.measured[s]) - static_cast<double>(view.predicted[s]);
        squares[records.texel[i]] += residual * residual;
        ++values[records.texel[i]];
      }
    }
  }
  std::vector<float> rms(model.material.size(), -1.0f);
  for (std::size_t i = 0; i < rms.size(); ++i) {
    if (values[i] > 0) rms[i] = static_cast<float>(std::sqrt(squares[i] / static_cast<double>(values[i])));
  }
  return rms;
}

}  // namespace lumitexel
