// Lumitexels as the viewer's page carries them: for every photograph what became of its look at the lumitexel, and of its samples what was
// measured and predicted.
//
// What is lost on the way: reflectances and scales are half floats (relative 5e-4 at most), shares 1/255, positions 1/65535 of the mesh's box
// a coordinate. Where the page would carry more than kMostSampleBytes, it carries every k-th lumitexel in the atlas's order.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "processing/report/viewer/lumitexel_records.h"
#include "processing/report/viewer/packed_chunks.h"

namespace lumitexel {

inline constexpr std::size_t kMostSampleBytes = 16'000'000;

// The views that the fit used, with camera (pinhole and distortion as CameraModel; "rotation" by rows, "translation": camera from world)
// and light ("point": position or direction, in world, m), both in the page's frame, about `centre`; names of verdicts and of reasons;
// "every" (k), "lumitexels" (all of them), "weighed", "outlier_scales".
nlohmann::json viewer_samples_json(const LumitexelRecords& records, const CalibratedSession& session, const Eigen::Vector3d& centre, std::size_t every);

// Lists by lumitexel: "lumitexel_low" and "_high" (of its texel's atlas index), "lumitexel_position" (a plane a coordinate, in the box of
// `mesh`), "verdict" (a plane a view). Lists by sample, view after view and in each by lumitexel: "measured" and "predicted" (a plane a
// channel), "share", "scales_off", "reason".
void add_sample_chunks(const LumitexelRecords& records, const Mesh& mesh, std::size_t every, PackedChunks& chunks);

// "residual" (rms_residual, half floats) of the texels with a material.
void add_residual_chunk(const LumitexelRecords& records, const Model& model, PackedChunks& chunks);

// Adds the chunks with a k that keeps them within `most_bytes` (1 if that does), and returns it.
std::size_t add_samples_within(std::size_t most_bytes, const LumitexelRecords& records, const Mesh& mesh, PackedChunks& chunks);

}  // namespace lumitexel
