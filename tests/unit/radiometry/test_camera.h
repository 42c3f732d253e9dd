// Frames of a sensor that does exactly what the noise model says, and its darks.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "processing/image/dark_frames.h"

namespace lumitexel {

inline LinearSensor test_sensor() {
  LinearSensor sensor;
  sensor.electrons_per_dn = 1.2;
  sensor.read_noise_dn = 3.0;
  sensor.black_level_dn = 256.0;
  sensor.clip_dn = 15000.0;
  return sensor;
}

// Frames of a sensor that does what the noise model says: Poisson electrons, normal read noise, rounding, clipping.
class TestCamera {
 public:
  TestCamera(const LinearSensor& sensor, int width, int height, std::uint64_t seed)
      : sensor_(sensor), width_(width), height_(height), random_(seed) {}

  // rate: DN per second of light, per pixel; dark_dn: dark current's signal, per pixel.
  template <typename Rate, typename Dark>
  Frame expose(double exposure_s, const Rate& rate, const Dark& dark_dn) {
    Frame frame;
    frame.width_px = width_;
    frame.height_px = height_;
    frame.bits = 14;
    frame.reported.exposure_s = exposure_s;
    std::normal_distribution<double> read(0.0, sensor_.read_noise_dn);
    for (int i = 0; i < width_ * height_; ++i) {
      const double electrons = (rate(i) * exposure_s + dark_dn(i)) * sensor_.electrons_per_dn;
      const double shot = electrons > 0.0 ? std::poisson_distribution<long>(electrons)(random_) : 0.0;
      const double dn = sensor_.black_level_dn + shot / sensor_.electrons_per_dn + read(random_);
      frame.samples.push_back(static_cast<std::uint16_t>(std::clamp(std::round(dn), 0.0, sensor_.clip_dn)));
    }
    return frame;
  }

 private:
  LinearSensor sensor_;
  int width_, height_;
  std::mt19937_64 random_;
};

inline const auto kNothing = [](int) { return 0.0; };

inline DarkLibrary darks_for(TestCamera& camera, const std::vector<double>& exposures, int repetitions) {
  DarkLibrary library;
  for (const double exposure : exposures) {
    std::vector<Frame> frames;
    for (int i = 0; i < repetitions; ++i) frames.push_back(camera.expose(exposure, kNothing, kNothing));
    library.add(make_master_dark(frames, test_sensor()));
  }
  return library;
}

}  // namespace lumitexel
