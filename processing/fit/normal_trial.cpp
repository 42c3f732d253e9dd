#include "processing/fit/normal_trial.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "processing/brdf/select_lumitexels.h"
#include "processing/fit/observe.h"
#include "processing/normals/lumitexel_bands.h"

namespace lumitexel {
namespace {

constexpr std::size_t kLeftOutEvery = 5;
constexpr std::size_t kMostLumitexels = 40000;
constexpr std::size_t kMostLearnt = 2000;   // lumitexels that the trial's materials are learnt on
constexpr std::size_t kFewestSamples = 50;  // of a block of the surface in one photograph

// Of the photographs that the fit may see, those that turn number `turn` of the trial leaves out: over all turns each once.
std::vector<bool> left_out_views(const CalibratedSession& session, std::size_t turn) {
  std::vector<bool> left_out(session.views.size(), false);
  std::size_t seen = 0;
  for (std::size_t v = 0; v < left_out.size(); ++v) {
    if (!session.views[v].heldout) left_out[v] = seen++ % kLeftOutEvery == (kLeftOutEvery / 2 + turn) % kLeftOutEvery;
  }
  return left_out;
}

struct Cell {
  double gain = 0;  // sum of deviances on the mesh's normals less those on fitted ones
  std::size_t samples = 0;
};
using Cells = std::map<std::pair<std::uint32_t, std::uint16_t>, Cell>;  // by block and photograph

// What a fit to some of the photographs makes of the others. A left-out sample below its surface is predicted to be black.
class Arm {
 public:
  Arm(const CalibratedSession& session, const FitInputs& inputs, const MaterialsBefore& materials, const LumitexelSet& learnt,
      const Observations& observations, const LumitexelSet& left_out)
      : left_out_(left_out) {
    FitOptions options = inputs.options;
    options.learning_lumitexels = std::min(options.learning_lumitexels, kMostLearnt);
    options.final_lumitexels = std::min(options.final_lumitexels, kMostLearnt);
    FitSummary summary;
    StageTimer timer;
    NoProgress quiet;
    reflectance_ = fit_reflectance({inputs.atlas, learnt, observations, options, inputs.error}, materials, "", model_, summary, timer, quiet);
    for (const ModelMaterial& material : model_.materials) prepared_.emplace_back(material.basis.begin(), material.basis.end());
    for (const View& view : session.views) eyes_.push_back(view.camera_in_world());
  }

  FittedNormals normals(const CalibratedSession& session, const LumitexelSet& learnt, const FitInputs& inputs, double median) const {
    const DirectedLumitexels directed(session, learnt);
    return fit_normals(directed, lumitexel_neighbours(directed, inputs.atlas.width), bases_of(model_), reflectance_.clustering.label, median,
                       inputs.options.normal_fit, Uncertainty::None);
  }

  // Of sample s of lumitexel i of a tile of the left-out set, i being number `lumitexel` of all.
  double deviance_of(const CalibratedSession& session, const ErrorModel& error, std::size_t t, std::size_t i, std::size_t s,
                     std::size_t lumitexel) const {
    const LumitexelTile& tile = left_out_.tiles[t];
    const auto channels = static_cast<std::size_t>(left_out_.channels);
    const LobeGeometry geometry = lobe_geometry(tile.normal[i], session.views[tile.view[s]].light.direction_from(tile.position[i]),
                                                (eyes_[tile.view[s]] - tile.position[i]).normalized());
    ChannelValues predicted{};
    const std::vector<float>& weight = reflectance_.weights[lumitexel].weight;
    const std::vector<PreparedBrdf>& basis = prepared_[static_cast<std::size_t>(reflectance_.clustering.label[lumitexel])];
    if (geometry.cos_i > 0.0 && geometry.cos_o > 0.0) predicted = predicted_reflectance(basis, weight, geometry);
    Observation sample;
    for (std::size_t c = 0; c < channels; ++c) {
      sample.reflectance[c] = tile.reflectance[s * channels + c];
      sample.variance[c] = tile.variance[s * channels + c];
    }
    return deviance(error, sample_misfit(error, sample, left_out_.channels, predicted), left_out_.channels);
  }

 private:
  const LumitexelSet& left_out_;
  Model model_;
  Reflectance reflectance_;
  std::vector<std::vector<PreparedBrdf>> prepared_;
  std::vector<Eigen::Vector3d> eyes_;
};

// Cells count by their samples; their scatter about the mean says how sure the mean is.
NormalsWorth mean_gain(const Cells& cells) {
  NormalsWorth worth;
  double squares = 0.0, count = 0.0, sum = 0.0;
  for (const auto& [place, cell] : cells) {
    if (cell.samples < kFewestSamples) continue;
    sum += cell.gain;
    worth.samples += cell.samples;
    count += 1.0;
  }
  if (count < 2.0) return {0.0, 0.0, worth.samples};
  worth.gain = sum / static_cast<double>(worth.samples);
  for (const auto& [place, cell] : cells) {
    if (cell.samples < kFewestSamples) continue;
    const double off = cell.gain - worth.gain * static_cast<double>(cell.samples);
    squares += off * off;
  }
  worth.gain_sigma = std::sqrt(squares * count / (count - 1.0)) / static_cast<double>(worth.samples);
  return worth;
}

bool finite(const LumitexelTile& tile, std::size_t sample, std::size_t channels) {
  for (std::size_t c = 0; c < channels; ++c) {
    if (!std::isfinite(tile.reflectance[sample * channels + c]) || !std::isfinite(tile.variance[sample * channels + c])) return false;
  }
  return true;
}

// Without some of the photographs, and only on part of the surface, materials may have nothing to be learnt on.
bool can_learn(const Observations& observations) { return !select_lumitexels(observations, kMostLearnt).empty(); }

// Adds what the left-out photographs say; nothing where the others are too few to learn from.
void judge(const CalibratedSession& session, const FitInputs& inputs, const Clustering& materials, const LumitexelBands& bands,
           const std::vector<bool>& left_out_view, Cells& cells) {
  std::vector<bool> learnt_view = left_out_view;
  learnt_view.flip();
  const LumitexelSet learnt = only_views(bands.set, learnt_view), left_out = only_views(bands.set, left_out_view);
  if (learnt.samples() == 0 || left_out.samples() == 0) return;
  const Observations observations = observe(session, learnt);
  if (!can_learn(observations)) return;
  const Arm on_mesh(session, inputs, {&materials, false}, learnt, observations, left_out);

  LumitexelSet turned = learnt, left_out_turned = left_out;
  const FittedNormals fitted = on_mesh.normals(session, learnt, inputs, median_reflectance(observations));
  turn(fitted.normal, turned);
  turn(fitted.normal, left_out_turned);
  const Observations observations_turned = observe(session, turned);
  if (!can_learn(observations_turned)) return;
  const Arm on_fitted(session, inputs, {&materials, true}, turned, observations_turned, left_out_turned);

  std::size_t number = 0;
  const auto channels = static_cast<std::size_t>(left_out.channels);
  for (std::size_t t = 0; t < left_out.tiles.size(); ++t) {
    const LumitexelTile& tile = left_out.tiles[t];
    for (std::size_t i = 0; i < tile.size(); ++i, ++number) {
      for (std::size_t s = tile.first_sample[i]; s < tile.first_sample[i + 1]; ++s) {
        if (!finite(tile, s, channels)) continue;
        Cell& cell = cells[{bands.block[number], tile.view[s]}];
        cell.gain += on_mesh.deviance_of(session, inputs.error, t, i, s, number) - on_fitted.deviance_of(session, inputs.error, t, i, s, number);
        ++cell.samples;
      }
    }
  }
}

}  // namespace

NormalsWorth try_normals(const CalibratedSession& session, const FitInputs& inputs, const Clustering& materials) {
  const LumitexelBands bands = lumitexel_bands(inputs.lumitexels, inputs.atlas.width, kMostLumitexels);
  Cells cells;
  NormalsWorth worth;
  for (std::size_t turn = 0; turn < kLeftOutEvery && !worth.is_clear(); ++turn) {
    judge(session, inputs, materials, bands, left_out_views(session, turn), cells);
    worth = mean_gain(cells);
  }
  return worth;
}

}  // namespace lumitexel
