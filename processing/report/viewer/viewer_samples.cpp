#include "processing/report/viewer/viewer_samples.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "processing/fit/outliers.h"
#include "processing/report/viewer/viewer_model.h"

namespace lumitexel {
namespace {

using nlohmann::json;

// In the order of SampleVerdict, then kBelowFittedNormal.
constexpr const char* kVerdicts[] = {"used",
                                     "outside the photograph",
                                     "hidden from the camera",
                                     "in shadow",
                                     "at the edge of what the camera sees",
                                     "at the edge of a shadow",
                                     "grazing",
                                     "flagged in the photograph: clipped, defective or masked out",
                                     "in the penumbra of a lamp of some size",
                                     "below the fitted normal"};
static_assert(std::size(kVerdicts) == std::size_t{kBelowFittedNormal} + 1 && static_cast<int>(SampleVerdict::Penumbra) == 8);

json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

json view_json(const View& view, const Eigen::Vector3d& centre) {
  const CameraModel& camera = view.camera;
  const Eigen::Matrix3d turn = view.camera_from_world.linear();
  json rotation = json::array();
  for (Eigen::Index row = 0; row < 3; ++row) rotation.push_back(vector_json(turn.row(row)));
  const bool point = view.light.type == Light::Type::Point;
  return {{"name", view.name},
          {"focal", {camera.focal_x_px, camera.focal_y_px}},
          {"principal", {camera.principal_x_px, camera.principal_y_px}},
          {"distortion", {camera.k1, camera.k2, camera.p1, camera.p2}},
          {"rotation", rotation},
          {"translation", vector_json(view.camera_from_world * centre)},
          {"light", {{"point", point}, {"vector", vector_json(point ? (view.light.vector_in_world - centre).eval() : view.light.vector_in_world)}}}};
}

std::vector<std::uint16_t> positions_in_box(const LumitexelRecords& records, const MeshBox& box, std::size_t every) {
  std::vector<std::uint16_t> planes;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double size = std::max(box.high[axis] - box.low[axis], 1e-12);
    for (std::size_t i = 0; i < records.texel.size(); i += every) {
      const double share = (records.position[i][axis] - box.low[axis]) / size;
      planes.push_back(static_cast<std::uint16_t>(std::lround(65535.0 * std::clamp(share, 0.0, 1.0))));
    }
  }
  return planes;
}

// What a list holds of every k-th lumitexel, one plane a value of a sample, as half floats.
class SampleColumn {
 public:
  SampleColumn(const LumitexelRecords& records, std::size_t every) : records_(records), every_(every) {}

  // list: of a view, `stride` values a sample.
  template <typename Value, typename List, typename Convert>
  std::vector<Value> gather(const List& list, std::size_t stride, const Convert& convert) const {
    std::vector<Value> column;
    for (std::size_t plane = 0; plane < stride; ++plane) {
      for (const ViewRecords& view : records_.by_view) {
        std::size_t s = 0;
        for (std::size_t i = 0; i < view.verdict.size(); ++i) {
          if (view.verdict[i] != static_cast<std::uint8_t>(SampleVerdict::Used)) continue;
          if (i % every_ == 0) column.push_back(convert((view.*list)[s * stride + plane]));
          ++s;
        }
      }
    }
    return column;
  }

 private:
  const LumitexelRecords& records_;
  std::size_t every_;
};

}  // namespace

json viewer_samples_json(const LumitexelRecords& records, const CalibratedSession& session, const Eigen::Vector3d& centre, std::size_t every) {
  json views = json::array(), reasons = json::array();
  for (const std::size_t v : records.used_views) views.push_back(view_json(session.views[v], centre));
  for (const OutlierReason reason : kOutlierReasons) reasons.push_back(to_string(reason));
  return {{"views", views}, {"verdicts", kVerdicts}, {"reasons", reasons}, {"every", every},
          {"lumitexels", records.texel.size()}, {"weighed", records.weighed}, {"outlier_scales", kOutlierScales}};
}

void add_sample_chunks(const LumitexelRecords& records, const Mesh& mesh, std::size_t every, PackedChunks& chunks) {
  std::vector<std::uint16_t> low, high;
  for (std::size_t i = 0; i < records.texel.size(); i += every) {
    low.push_back(static_cast<std::uint16_t>(records.texel[i] & 0xffffu));
    high.push_back(static_cast<std::uint16_t>(records.texel[i] >> 16));
  }
  chunks.add("lumitexel_low", low, ChunkCoding::Differences);
  chunks.add("lumitexel_high", high, ChunkCoding::Differences);
  chunks.add("lumitexel_position", positions_in_box(records, box_of(mesh), every), ChunkCoding::Differences);
  std::vector<std::uint8_t> verdict;
  for (const ViewRecords& view : records.by_view) {
    for (std::size_t i = 0; i < view.verdict.size(); i += every) verdict.push_back(view.verdict[i]);
  }
  chunks.add("verdict", verdict);

  const SampleColumn columns(records, every);
  const auto channels = static_cast<std::size_t>(records.channels);
  chunks.add("measured", columns.gather<std::uint16_t>(&ViewRecords::measured, channels, half_bits));
  chunks.add("predicted", columns.gather<std::uint16_t>(&ViewRecords::predicted, channels, half_bits));
  if (records.weighed) {
    chunks.add("share", columns.gather<std::uint8_t>(&ViewRecords::share, 1, [](float share) { return static_cast<std::uint8_t>(std::lround(255.0f * share)); }));
    chunks.add("scales_off", columns.gather<std::uint16_t>(&ViewRecords::scales_off, 1, half_bits));
  }
  chunks.add("reason", columns.gather<std::uint8_t>(&ViewRecords::reason, 1, [](std::uint8_t reason) { return reason; }));
}

void add_residual_chunk(const LumitexelRecords& records, const Model& model, PackedChunks& chunks) {
  const std::vector<float> rms = rms_residual(records, model);
  std::vector<std::uint16_t> halves;
  for (const std::uint32_t texel : textured_texels(model)) halves.push_back(half_bits(rms[texel]));
  chunks.add("residual", halves);
}

std::size_t add_samples_within(std::size_t most_bytes, const LumitexelRecords& records, const Mesh& mesh, PackedChunks& chunks) {
  constexpr std::size_t kTrial = 32;  // deflating is slow: a part of them says how many will fit
  PackedChunks trial;
  add_sample_chunks(records, mesh, kTrial, trial);
  for (std::size_t every = std::max(std::size_t{1}, kTrial * trial.total_bytes() / most_bytes);; ++every) {
    PackedChunks own;
    add_sample_chunks(records, mesh, every, own);
    if (own.total_bytes() > most_bytes && every < records.texel.size()) continue;
    chunks.append(std::move(own));
    return every;
  }
}

}  // namespace lumitexel
