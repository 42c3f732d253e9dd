#include "processing/report/viewer/viewer_lumitexels.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "drivers/error.h"
#include "processing/brdf/observations.h"
#include "processing/report/viewer/viewer_model.h"
#include "processing/surface/best_view.h"
#include "processing/surface/gather_lumitexels.h"

namespace lumitexel {
namespace {

using nlohmann::json;

// In the order of SampleVerdict.
constexpr const char* kVerdicts[] = {"used",
                                     "outside the photograph",
                                     "hidden from the camera",
                                     "not lit",
                                     "within 2 px of an edge of the object or a jump in depth",
                                     "within 2 px of a shadow's edge",
                                     "seen or lit under a grazing angle",
                                     "pixel saturated, too dark or masked"};

struct FoundTexel {  // of one lumitexel
  double squares = 0;  // of predicted minus measured r, over samples and channels
  int values = 0;
};

json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

json view_json(const View& view) {
  json rotation = json::array();
  for (int row = 0; row < 3; ++row) rotation.push_back(vector_json(view.camera_from_world.linear().row(row)));
  const CameraModel& camera = view.camera;
  json intensity = json::array();
  for (const double value : view.light.intensity) intensity.push_back(value);
  return {{"name", view.name},
          {"heldout", view.heldout},
          {"width", camera.width_px},
          {"height", camera.height_px},
          {"focal", {camera.focal_x_px, camera.focal_y_px}},
          {"principal", {camera.principal_x_px, camera.principal_y_px}},
          {"distortion", {camera.k1, camera.k2, camera.p1, camera.p2}},
          {"rotation", rotation},
          {"translation", vector_json(view.camera_from_world.translation())},
          {"light",
           {{"type", view.light.type == Light::Type::Point ? "point" : "directional"},
            {"vector", vector_json(view.light.vector_in_world)},
            {"intensity", intensity}}}};
}

void require_same_session(const Model& model, const CalibratedSession& session, const Atlas& atlas) {
  const json provenance = json::parse(model.provenance_json, nullptr, false);
  const std::string fitted = provenance.is_object() ? provenance.value("session_key", "") : "";
  if (fitted != session.key || atlas.width != model.width || atlas.height != model.height) {
    throw BadInput("--session", "calibrated content " + session.key.substr(0, 12) + "…",
                   "the session that the model was fitted to (" + fitted.substr(0, 12) + "…), calibrated as it was then");
  }
}

Eigen::Vector3d normal_at(const Model& model, const LumitexelTile& tile, std::size_t i) {
  const float* n = &model.normal.data[std::size_t{3} * tile.texel[i]];
  const Eigen::Vector3d normal(n[0], n[1], n[2]);
  return normal.isZero() ? tile.normal[i] : normal.normalized();
}

FoundTexel compare(const Model& model, const CalibratedSession& session, const LumitexelTile& tile, std::size_t i) {
  FoundTexel found;
  const int x = static_cast<int>(tile.texel[i]) % model.width, y = static_cast<int>(tile.texel[i]) / model.width;
  for (std::size_t s = tile.first_sample[i]; s < tile.first_sample[i + 1]; ++s) {
    const View& view = session.views[tile.view[s]];
    const Eigen::Vector3d wi = view.light.direction_from(tile.position[i]);
    const Eigen::Vector3d wo = (view.camera_in_world() - tile.position[i]).normalized();
    const LobeGeometry geometry = lobe_geometry(normal_at(model, tile, i), wi, wo);
    for (int c = 0; c < model.channels; ++c) {
      const double measured = static_cast<double>(tile.reflectance[s * static_cast<std::size_t>(model.channels) + static_cast<std::size_t>(c)]);
      const double predicted = std::max(0.0, geometry.cos_i) * evaluate_texel(model, FitStage::Pfa, x, y, c, geometry);
      found.squares += (predicted - measured) * (predicted - measured);
      ++found.values;
    }
  }
  return found;
}

// Over the whole atlas; 0 where there are no samples.
void add_residuals(const Model& model, const CalibratedSession& session, const LumitexelSet& set, PackedChunks& chunks) {
  std::vector<float> residual(model.material.size());
  for (const LumitexelTile& tile : set.tiles) {
    oneapi::tbb::parallel_for(std::size_t{0}, tile.size(), [&](std::size_t i) {
      const FoundTexel found = compare(model, session, tile, i);
      if (found.values > 0) residual[tile.texel[i]] = static_cast<float>(std::sqrt(found.squares / found.values));
    });
  }
  std::vector<std::uint16_t> halves;
  for (const std::uint32_t texel : textured_texels(model)) halves.push_back(half_bits(residual[texel]));
  chunks.add("residual", halves);
}

struct Carried {
  std::vector<std::uint16_t> x, y, position, reflectance;
  std::vector<std::uint8_t> verdict;
  CarriedSamples count;
};

class Lattice {
 public:
  Lattice(const Model& model, int step) : step_(static_cast<std::uint32_t>(step)), width_(static_cast<std::uint32_t>(model.width)) {
    low_ = high_ = model.mesh.positions.front();
    for (const Eigen::Vector3d& position : model.mesh.positions) {
      low_ = low_.cwiseMin(position);
      high_ = high_.cwiseMax(position);
    }
  }
  bool carries(std::uint32_t texel) const { return texel % width_ % step_ == 0 && texel / width_ % step_ == 0; }
  void add(const GatheredLumitexels& gathered, const LumitexelTile& tile, std::size_t i, std::size_t lumitexel, Carried& carried) const;
  json box_json() const { return {{"low", vector_json(low_)}, {"high", vector_json(high_)}}; }

 private:
  std::uint32_t step_, width_;
  Eigen::Vector3d low_, high_;
};

void Lattice::add(const GatheredLumitexels& gathered, const LumitexelTile& tile, std::size_t i, std::size_t lumitexel,
                  Carried& carried) const {
  constexpr double kSteps = 65535.0;
  carried.x.push_back(static_cast<std::uint16_t>(tile.texel[i] % width_));
  carried.y.push_back(static_cast<std::uint16_t>(tile.texel[i] / width_));
  for (int k = 0; k < 3; ++k) {
    const double extent = high_[k] - low_[k], along = extent > 0.0 ? (tile.position[i][k] - low_[k]) / extent : 0.0;
    carried.position.push_back(static_cast<std::uint16_t>(std::lround(std::clamp(along, 0.0, 1.0) * kSteps)));
  }
  for (const auto& verdicts : gathered.verdict) carried.verdict.push_back(static_cast<std::uint8_t>(verdicts[lumitexel]));
  const auto channels = static_cast<std::size_t>(gathered.set.channels);
  for (std::size_t v = tile.first_sample[i] * channels; v < tile.first_sample[i + 1] * channels; ++v) {
    carried.reflectance.push_back(half_bits(tile.reflectance[v]));
  }
  ++carried.count.lumitexels;
  carried.count.samples += tile.first_sample[i + 1] - tile.first_sample[i];
}

// One plane a channel or view instead of all of one lumitexel together: neighbours deflate better.
template <typename Value>
std::vector<Value> transposed(const std::vector<Value>& values, std::size_t columns) {
  std::vector<Value> planes;
  planes.reserve(values.size());
  for (std::size_t column = 0; column < columns; ++column) {
    for (std::size_t at = column; at < values.size(); at += columns) planes.push_back(values[at]);
  }
  return planes;
}

}  // namespace

CarriedSamples add_lumitexels(const Model& model, const CalibratedSession& session, int lattice_step, json& document,
                              PackedChunks& chunks, Progress& progress) {
  const RayScene scene(session.mesh);
  const Atlas atlas = make_atlas(session, choose_best_views(session, scene));
  require_same_session(model, session, atlas);
  const GatheredLumitexels gathered = gather_lumitexels(session, atlas, scene, progress);
  const Lattice lattice(model, lattice_step);
  Carried carried;
  std::size_t lumitexel = 0;
  for (const LumitexelTile& tile : gathered.set.tiles) {
    for (std::size_t i = 0; i < tile.size(); ++i, ++lumitexel) {
      if (lattice.carries(tile.texel[i])) lattice.add(gathered, tile, i, lumitexel, carried);
    }
  }
  add_residuals(model, session, gathered.set, chunks);
  chunks.add("lumitexel_x", carried.x, ChunkCoding::Differences);
  chunks.add("lumitexel_y", carried.y, ChunkCoding::Differences);
  chunks.add("lumitexel_position", transposed(carried.position, 3), ChunkCoding::Differences);
  chunks.add("verdict", transposed(carried.verdict, gathered.used_views.size()));
  chunks.add("reflectance", transposed(carried.reflectance, static_cast<std::size_t>(gathered.set.channels)));
  document["views"] = json::array();
  for (const View& view : session.views) document["views"].push_back(view_json(view));
  document["used_views"] = gathered.used_views;
  document["lattice"] = lattice_step;
  document["box"] = lattice.box_json();
  document["verdicts"] = kVerdicts;
  chunks.add_text("outliers", model.outliers_csv);
  return carried.count;
}

}  // namespace lumitexel
