#include "processing/image/hdr_merge.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <list>
#include <string>

#include "drivers/error.h"
#include "processing/image/merge_pixel.h"

namespace lumitexel {
namespace {

void check_frames(const std::vector<Frame>& frames) {
  if (frames.empty()) throw BadInput("bracket", "no frames", "at least one exposure");
  const Frame& first = frames[0];
  const std::size_t pixels = static_cast<std::size_t>(first.width_px) * static_cast<std::size_t>(first.height_px);
  for (const Frame& frame : frames) {
    if (frame.width_px != first.width_px || frame.height_px != first.height_px || frame.mosaic != first.mosaic ||
        frame.bits != first.bits || frame.samples.size() != pixels) {
      throw BadInput("bracket", "frames of different size, bit depth or mosaic", "exposures by one camera");
    }
    if (frame.reported.gain_db != first.reported.gain_db) {
      throw BadInput("bracket",
                     "gains of " + std::to_string(first.reported.gain_db) + " and " +
                         std::to_string(frame.reported.gain_db) + " dB",
                     "one gain, which the noise model is for");
    }
    if (!std::isfinite(frame.reported.exposure_s) || frame.reported.exposure_s <= 0.0) {
      throw BadInput("bracket", "an exposure of " + std::to_string(frame.reported.exposure_s) + " s", "a positive time");
    }
  }
}

struct MatchedFrame {
  const Frame* frame = nullptr;
  DarkMatch match;
};

// Darks that fit, scaled where the frames say that the sensor's temperature was another one.
class MatchedDarks {
 public:
  MatchedDarks(const std::vector<Frame>& frames, const DarkLibrary& darks, const LinearSensor& sensor,
               MosaicRadiance& merged) {
    std::vector<DarkedFrame> doubtful;
    bool drifted = false;
    for (const Frame& frame : frames) {
      matched_.push_back({&frame, darks.matching(frame)});
      const DarkMatch& match = matched_.back().match;
      if (match.temperature != DarkMatch::Temperature::Same) doubtful.push_back({&frame, match.dark});
      drifted = drifted || match.temperature == DarkMatch::Temperature::Drifted;
    }
    if (doubtful.empty()) return;
    merged.dark_scale = fit_dark_scale(doubtful, sensor);
    merged.darks_drifted = drifted && !merged.dark_scale.determined;
    if (!merged.dark_scale.needed) return;
    for (MatchedFrame& m : matched_) {
      if (m.match.temperature == DarkMatch::Temperature::Same) continue;
      scaled_.push_back(scaled_dark(*m.match.dark, merged.dark_scale, sensor));
      m.match.dark = &scaled_.back();
    }
  }

  std::vector<BracketExposure> ascending() const {
    std::vector<BracketExposure> exposures;
    for (const MatchedFrame& m : matched_)
      exposures.push_back({m.frame->samples.data(), m.match.dark, m.frame->reported.exposure_s});
    std::stable_sort(exposures.begin(), exposures.end(),
                     [](const BracketExposure& a, const BracketExposure& b) { return a.time_s < b.time_s; });
    return exposures;
  }

 private:
  std::vector<MatchedFrame> matched_;
  std::list<MasterDark> scaled_;  // a list: pointers into it stay
};

}  // namespace

MosaicRadiance merge_bracket(const std::vector<Frame>& frames, const DarkLibrary& darks, const LinearSensor& sensor,
                             const ResponseCurve* response) {
  check_frames(frames);
  check_sensor(sensor);
  MosaicRadiance merged;
  merged.width = frames[0].width_px;
  merged.height = frames[0].height_px;
  merged.mosaic = frames[0].mosaic;
  const std::size_t pixels = frames[0].samples.size();
  merged.value.resize(pixels);
  merged.variance.resize(pixels);
  merged.flags.resize(pixels);
  const MatchedDarks matched(frames, darks, sensor, merged);
  const PixelMerger merger(matched.ascending(), frames[0].bits, sensor, response);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels, 4096), [&](const tbb::blocked_range<std::size_t>& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const PixelEstimate pixel = merger.merge(i);
      merged.value[i] = static_cast<float>(pixel.rate);
      merged.variance[i] = static_cast<float>(pixel.variance);
      merged.flags[i] = pixel.flags;
    }
  });
  return merged;
}

}  // namespace lumitexel
