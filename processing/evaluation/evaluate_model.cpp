#include "processing/evaluation/evaluate_model.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "drivers/error.h"
#include "processing/evaluation/predicted_view.h"

namespace lumitexel {
namespace {

using SumsByStage = std::array<ErrorSums, std::size(kFitStages)>;

struct Comparison {
  SumsByStage all, measured;  // measured: the surface that has samples of its own
  void add(const Comparison& other) {
    for (std::size_t stage = 0; stage < all.size(); ++stage) {
      all[stage].add(other.all[stage]);
      measured[stage].add(other.measured[stage]);
    }
  }
};

std::size_t index(FitStage stage) { return static_cast<std::size_t>(stage); }

void require_finite(const View& view, const Image& prediction) {
  for (std::size_t i = 0; i < prediction.data.size(); ++i) {
    if (std::isfinite(prediction.data[i])) continue;
    const std::size_t pixel = i / static_cast<std::size_t>(prediction.channels);
    const auto width = static_cast<std::size_t>(prediction.width);
    throw Error(view.name + ": the model predicts a radiance that is not finite at pixel (" +
                std::to_string(pixel % width) + ", " + std::to_string(pixel / width) + ")");
  }
}

std::vector<std::uint8_t> measured_pixels(std::vector<std::uint8_t> counted, const Image& samples) {
  for (std::size_t pixel = 0; pixel < counted.size(); ++pixel) counted[pixel] = counted[pixel] != 0 && samples.data[pixel] > 0.0f;
  return counted;
}

Comparison compare_view(const Model& model, const ViewRenderer& renderer, const View& view) {
  const RadianceImage photograph = read_photograph(view, model.channels);
  Comparison sums;
  std::vector<std::uint8_t> counted, measured;
  for (const FitStage stage : kFitStages) {
    if (!holds_stage(model, stage)) continue;
    const RenderedView rendered = predicted_view(renderer, view, stage);
    require_finite(view, rendered.radiance);
    if (counted.empty()) {
      counted = object_pixels(photograph, rendered.hit);
      measured = measured_pixels(counted, renderer.render_aov(view, Aov::Samples));
    }
    sums.all[index(stage)].add(rendered.radiance, photograph.radiance, counted);
    sums.measured[index(stage)].add(rendered.radiance, photograph.radiance, measured);
  }
  return sums;
}

ErrorByStage errors(const Model& model, const SumsByStage& sums) {
  ErrorByStage result;
  for (const FitStage stage : kFitStages) {
    if (holds_stage(model, stage)) result[index(stage)] = sums[index(stage)].error();
  }
  return result;
}

}  // namespace

RadianceImage read_photograph(const View& view, int channels) {
  RadianceImage photograph = read_radiance_image(view.photograph);
  const auto shape = [](int width, int height, int planes) {
    return std::to_string(width) + "x" + std::to_string(height) + " pixels, " + std::to_string(planes) + " channels";
  };
  const Image& image = photograph.radiance;
  if (image.width != view.camera.width_px || image.height != view.camera.height_px || image.channels != channels) {
    throw BadInput(view.photograph.string(), shape(image.width, image.height, image.channels),
                   shape(view.camera.width_px, view.camera.height_px, channels) + " as camera and model have");
  }
  return photograph;
}

std::vector<std::uint8_t> object_pixels(const RadianceImage& photograph, const std::vector<std::uint8_t>& hit) {
  bool masked = false;
  for (const std::uint8_t flags : photograph.flags) masked = masked || (flags & kPixelOutside) != 0;
  std::vector<std::uint8_t> counted(photograph.flags.size());
  for (std::size_t pixel = 0; pixel < counted.size(); ++pixel) {
    const bool usable = (photograph.flags[pixel] & (kPixelSaturated | kPixelDefective | kPixelOutside)) == 0;
    counted[pixel] = usable && (masked || hit[pixel] != 0);
  }
  return counted;
}

Evaluation evaluate_model(const Model& model, const CalibratedSession& session, Progress& progress) {
  const auto provenance = nlohmann::json::parse(model.provenance_json);
  Evaluation evaluation;
  evaluation.last_stage = last_stage(model);
  evaluation.session_key = session.key;
  evaluation.same_session = provenance.value("session_key", "") == session.key;
  evaluation.provenance_json = model.provenance_json;

  const ViewRenderer renderer(model);
  Comparison fit, heldout;
  progress.begin("compare with photographs", static_cast<std::int64_t>(session.views.size()), "views");
  for (const View& view : session.views) {
    const Comparison sums = compare_view(model, renderer, view);
    (view.heldout ? heldout : fit).add(sums);
    if (view.heldout) evaluation.heldout_views.push_back(errors(model, sums.all));
    const ErrorSums& last = sums.all[index(evaluation.last_stage)];
    evaluation.views.push_back({view.name, view.heldout, last.values() / model.channels, last.error()});
    progress.update(static_cast<std::int64_t>(evaluation.views.size()));
  }
  evaluation.fit = errors(model, fit.all);
  evaluation.heldout = errors(model, heldout.all);
  evaluation.heldout_measured = errors(model, heldout.measured);
  const std::size_t last = index(evaluation.last_stage);
  evaluation.heldout_measured_share = static_cast<double>(heldout.measured[last].values()) / static_cast<double>(heldout.all[last].values());
  return evaluation;
}

}  // namespace lumitexel
