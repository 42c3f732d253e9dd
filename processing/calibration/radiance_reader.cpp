#include "processing/calibration/radiance_reader.h"

namespace lumitexel {
namespace {

// With temperatures that are all the same no dark counts as drifted.
constexpr double kOneTemperature_c = 25.0;

}  // namespace

RadianceReader::RadianceReader(const CapturedFrames& frames, DarkLibrary darks, SensorModel sensor)
    : frames_(frames), sensor_(std::move(sensor)), darks_(std::move(darks)) {}

std::vector<Frame> RadianceReader::load(const std::vector<FrameRecord>& records) const {
  std::vector<Frame> loaded = frames_.load(records);
  if (sensor_.scale_darks) return loaded;
  for (Frame& frame : loaded) {
    const DarkMatch match = darks_.matching(frame);
    frame.sensor_temperature_c = match.dark->temperature_c.value_or(kOneTemperature_c);
  }
  return loaded;
}

MosaicRadiance RadianceReader::read(const std::vector<FrameRecord>& bracket) const {
  MosaicRadiance merged =
      merge_bracket(load(bracket), darks_, sensor_.sensor, sensor_.response ? &*sensor_.response : nullptr);
  if (vignetting_) correct_vignetting(merged, *vignetting_);
  return merged;
}

}  // namespace lumitexel
