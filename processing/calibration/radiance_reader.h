// A captured session's shots as radiance: darks subtracted, the response undone, the lens's falloff taken out.
#pragma once

#include <optional>
#include <vector>

#include "processing/calibration/captured_frames.h"
#include "processing/calibration/lens/vignetting.h"
#include "processing/image/hdr_merge.h"
#include "processing/image/linear_sensor.h"
#include "processing/image/response_curve.h"

namespace lumitexel {

// What turns a sample into light.
struct SensorModel {
  LinearSensor sensor;
  std::optional<ResponseCurve> response;  // none: linear
  bool scale_darks = true;                // where a frame was warmer than its darks; else subtracted as they are
};

// Thread-safe. Keeps a reference to the frames.
class RadianceReader {
 public:
  RadianceReader(const CapturedFrames& frames, DarkLibrary darks, SensorModel sensor);

  // The falloff that every shot read from now on is freed of; none at first.
  void take_out(const Vignetting& vignetting) { vignetting_ = vignetting; }

  // One bracket (or a single shot) merged. Throws Corrupt for a changed file, BadInput for exposures without darks.
  MosaicRadiance read(const std::vector<FrameRecord>& bracket) const;
  MosaicRadiance read(const FrameRecord& shot) const { return read(std::vector<FrameRecord>{shot}); }

  const DarkLibrary& darks() const { return darks_; }
  const SensorModel& sensor() const { return sensor_; }

 private:
  std::vector<Frame> load(const std::vector<FrameRecord>& records) const;

  const CapturedFrames& frames_;
  SensorModel sensor_;
  DarkLibrary darks_;
  std::optional<Vignetting> vignetting_;
};

}  // namespace lumitexel
