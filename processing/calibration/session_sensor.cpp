#include "processing/calibration/session_sensor.h"

#include <algorithm>

#include "processing/image/fit_response.h"
#include "processing/image/photon_transfer.h"

namespace lumitexel {
namespace {

// A lamp that changes by a few tenths of a percent within a bracket bends a curve by up to this; sensors that are not
// linear are so by far more.
constexpr double kLampBends = 0.02;
constexpr std::size_t kBracketsAsked = 4;  // more tell little new, and all are held in memory at once

// Brackets spread over the session: their views, and so the radiances, differ.
std::vector<std::vector<Frame>> some_brackets(const CapturedFrames& frames, const std::vector<ViewFrames>& views) {
  std::vector<std::vector<Frame>> brackets;
  const std::size_t count = std::min(kBracketsAsked, views.size());
  for (std::size_t i = 0; i < count; ++i) {
    const ViewFrames& view = views[i * views.size() / count];
    if (view.bracket.size() > 1) brackets.push_back(frames.load(view.bracket));
  }
  return brackets;
}

std::optional<double> sigma_of(const SensorValue& value) {
  return value.measured ? std::optional<double>(value.sigma) : std::nullopt;
}

void describe(const PhotonTransfer& transfer, SensorSummary& sensor) {
  if (transfer.electrons_per_dn.measured) sensor.source = "photon transfer";
  sensor.electrons_per_dn_sigma = sigma_of(transfer.electrons_per_dn);
  sensor.read_noise_dn_sigma = sigma_of(transfer.read_noise_dn);
  sensor.black_level_dn_sigma = sigma_of(transfer.black_level_dn);
  sensor.saturation_dn_sigma = sigma_of(transfer.clip_dn);
  sensor.notes = transfer.notes;
}

void describe(const LinearSensor& model, SensorSummary& sensor) {
  sensor.electrons_per_dn = model.electrons_per_dn;
  sensor.read_noise_dn = model.read_noise_dn;
  sensor.black_level_dn = model.black_level_dn;
  sensor.saturation_dn = model.clip_dn;
}

void describe_temperatures(const std::vector<FrameRecord>& records, SensorSummary& sensor) {
  for (const FrameRecord& record : records) {
    if (record.sensor_temperature_c == 0.0) continue;  // exactly 0: the camera tells none
    sensor.coldest_c = std::min(sensor.coldest_c.value_or(record.sensor_temperature_c), record.sensor_temperature_c);
    sensor.warmest_c = std::max(sensor.warmest_c.value_or(record.sensor_temperature_c), record.sensor_temperature_c);
  }
}

}  // namespace

RadianceReader measure_sensor(const CapturedFrames& frames, const CapturedInputs& in,
                              const std::vector<ViewFrames>& views, const CalibrationOptions& options,
                              CalibrationSummary& summary, Progress& progress) {
  progress.begin("dark frames and sensor", 2, "steps");
  DarkLibrary darks = frames.master_darks(in.nominal_sensor);
  for (const MasterDark& dark : darks.all()) summary.hot_pixels = std::max(summary.hot_pixels, dark.hot_count);
  progress.update(1);
  SensorModel model{in.nominal_sensor, std::nullopt, options.takes(CalibrationStep::DarkScale)};
  const std::vector<std::vector<Frame>> brackets = some_brackets(frames, views);
  // The response first: a curve looks like noise to a photon transfer that takes the sensor for linear.
  if (options.takes(CalibrationStep::Response) && !brackets.empty()) {
    ResponseFit response = fit_response(brackets, model.sensor);
    if (response.curve && response.largest_departure > kLampBends) {
      // A linearised sample has a unit of its own, half the range being its fixed point, and so its own gain.
      if (response.electrons_measured) model.sensor.electrons_per_dn = response.electrons_per_dn;
      model.response = std::move(response.curve);
    }
    if (model.response) summary.sensor.notes.emplace_back("the sensor is not linear: a response curve is undone");
  }
  if (options.takes(CalibrationStep::PhotonTransfer) && !model.response) {
    const PhotonTransfer transfer = measure_photon_transfer(brackets, darks, model.sensor);
    model.sensor = transfer.sensor;
    describe(transfer, summary.sensor);
  }
  summary.sensor.linear = !model.response;
  describe(model.sensor, summary.sensor);
  for (const ViewFrames& view : views) describe_temperatures(view.bracket, summary.sensor);
  progress.update(2);
  return RadianceReader(frames, std::move(darks), std::move(model));
}

}  // namespace lumitexel
