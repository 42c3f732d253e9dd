// How well a response is recovered: ours against OpenCV's Debevec and Robertson (8 bits only), largest relative error of
// the linear value from 2 % of the codes or 50 electrons, whichever is more, to 95 % of the codes, over seeds.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/photo.hpp>
#include <vector>

#include "processing/image/fit_response.h"
#include "tests/bench/machine.h"
#include "tests/unit/radiometry/curved_camera.h"

namespace {

using namespace lumitexel;

const std::vector<double> kExposures_s{0.004, 0.016, 0.064, 0.256};

struct Errors {
  std::vector<double> worst;
  void print(const char* name) {
    if (worst.empty()) {
      std::printf(" %s: none", name);
      return;
    }
    std::sort(worst.begin(), worst.end());
    std::printf("  %s %8.3f %8.3f", name, 100.0 * worst[worst.size() / 2], 100.0 * worst.back());
  }
};

template <typename Linear>  // code fraction -> linear, any scale
double largest_error(const CurvedResponse& truth, const Linear& linear) {
  const double scale = truth.light(0.5) / linear(0.5);
  double worst = 0.0;
  for (double u = std::max(0.02, truth.code(50.0 / 18000.0)); u <= 0.95; u += 0.005) worst = std::max(worst, std::abs(linear(u) * scale / truth.light(u) - 1.0));
  return worst;
}

// Deeper samples are cut to 8 bits, which is all that OpenCV takes.
double opencv_error(cv::CalibrateCRF& method, const std::vector<Frame>& frames, const CurvedResponse& truth,
                    const LinearSensor& sensor) {
  std::vector<cv::Mat> images;
  std::vector<float> times;
  for (const Frame& frame : frames) {
    cv::Mat image(frame.height_px, frame.width_px, CV_8UC1);
    for (std::size_t i = 0; i < frame.samples.size(); ++i) {
      const double u = (frame.samples[i] - sensor.black_level_dn) / (sensor.clip_dn - sensor.black_level_dn);
      image.data[i] = cv::saturate_cast<std::uint8_t>(255.0 * u);
    }
    images.push_back(image);
    times.push_back(static_cast<float>(frame.reported.exposure_s));
  }
  cv::Mat response;
  method.process(images, response, times);
  return largest_error(truth, [&](double u) {
    const double at = std::clamp(255.0 * u, 0.0, 254.0);
    const int i = static_cast<int>(at);
    return (1.0 - (at - i)) * static_cast<double>(response.at<float>(i)) + (at - i) * static_cast<double>(response.at<float>(i + 1));
  });
}

void print_row(int bits, const CurvedResponse& truth, int trials, std::uint64_t seed) {
  const LinearSensor sensor = sensor_of_bits(bits);
  Errors ours, debevec, robertson;
  int curves = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const std::vector<Frame> frames = curved_bracket(truth, sensor, bits, kExposures_s, seed + static_cast<std::uint64_t>(trial));
    const ResponseFit fit = fit_response({frames}, sensor);
    const double range_dn = sensor.clip_dn - sensor.black_level_dn;
    curves += fit.curve ? 1 : 0;
    if (fit.determined) {
      ours.worst.push_back(largest_error(truth, [&](double u) {
        return fit.curve ? fit.curve->linear_dn(sensor.black_level_dn + u * range_dn) : u;
      }));
    }
    debevec.worst.push_back(opencv_error(*cv::createCalibrateDebevec(), frames, truth, sensor));
    robertson.worst.push_back(opencv_error(*cv::createCalibrateRobertson(30, 0.01f), frames, truth, sensor));
  }
  std::printf("%2d bits %-17s", bits, truth.name.c_str());
  ours.print("ours");
  debevec.print("Debevec");
  robertson.print("Robertson");
  std::printf("  curve asked for in %d of %d\n", curves, trials);
}

}  // namespace

int main(int argc, char** argv) {
  int trials = 10;
  std::uint64_t seed = 1;
  CLI::App app{"Recovered responses: largest error in percent, median and worst over seeds"};
  app.add_option("--trials", trials, "seeds")->check(CLI::Range(1, 1000));
  app.add_option("--seed", seed, "the first of them");
  CLI11_PARSE(app, argc, argv);
  std::printf("%s\nlargest error in %%, median and worst of %d seeds\n", machine_line().c_str(), trials);
  for (const int bits : {8, 12, 14}) {
    for (const CurvedResponse& truth : {straight(), compressive(0.3), srgb_response(), gamma_response(2.2)})
      print_row(bits, truth, trials, seed);
  }
  return 0;
}
