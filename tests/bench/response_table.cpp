// How well a response is recovered: ours, and OpenCV's Debevec and Robertson, which take 8 bits only. Relative error of
// the linear value over the usable range of fit_response.h, the scale fixed at half the range.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/photo.hpp>
#include <vector>

#include "processing/image/fit_response.h"
#include "tests/bench/machine.h"
#include "tests/unit/radiometry/curved_camera.h"

namespace {

using namespace lumitexel;

// Ratios of 4 leave L exp(p(log L)) possible with any p of period log 4; these do not.
const std::vector<double> kUneven_s{0.004, 0.012, 0.060, 0.252}, kEven_s{0.004, 0.016, 0.064, 0.256};

struct Options {
  int bits = 0, trials = 5, pixels = 160'000;
  std::uint64_t seed = 1;
  bool profile = false, even = false;
  std::string curve;
};

struct Errors {
  std::vector<double> worst, rms;

  void add(const std::vector<double>& of_curve) {
    double sum = 0.0, most = 0.0;
    for (const double error : of_curve) {
      sum += error * error;
      most = std::max(most, std::abs(error));
    }
    worst.push_back(most);
    rms.push_back(std::sqrt(sum / static_cast<double>(of_curve.size())));
  }
  void print(const char* name) const {
    if (worst.empty()) {
      std::printf("  %s none", name);
      return;
    }
    std::vector<double> sorted = worst;
    std::sort(sorted.begin(), sorted.end());
    double square = 0.0;
    for (const double r : rms) square += r * r / static_cast<double>(rms.size());
    std::printf("  %s %7.3f %7.3f %7.3f", name, 100.0 * sorted[sorted.size() / 2], 100.0 * sorted.back(),
                100.0 * std::sqrt(square));
  }
};

// Both methods write cells of three channels whatever the images have: with one channel they write past the end.
std::vector<double> opencv_errors(cv::CalibrateCRF& method, const std::vector<Frame>& frames,
                                  const CurvedResponse& truth, const LinearSensor& sensor) {
  std::vector<cv::Mat> images;
  std::vector<float> times;
  for (const Frame& frame : frames) {
    cv::Mat image(frame.height_px, frame.width_px, CV_8UC3);
    for (int i = 0; i < frame.width_px * frame.height_px; ++i) {
      const auto code = static_cast<std::uint8_t>(frame.samples[static_cast<std::size_t>(i)]);
      image.at<cv::Vec3b>(i / frame.width_px, i % frame.width_px) = {code, code, code};
    }
    images.push_back(image);
    times.push_back(static_cast<float>(frame.reported.exposure_s));
  }
  cv::Mat response;
  method.process(images, response, times);
  return relative_errors(truth, sensor, [&](double u) {
    const double at = std::clamp(255.0 * u, 0.0, 254.0);
    const int i = static_cast<int>(at);
    const double below = static_cast<double>(response.at<cv::Vec3f>(i)[0]);
    const double above = static_cast<double>(response.at<cv::Vec3f>(i + 1)[0]);
    return below + (at - i) * (above - below);
  });
}

// Mean and scatter over the seeds, and what the fits themselves state.
void print_profile(const std::vector<ResponseFit>& fits, const CurvedResponse& truth, const LinearSensor& sensor) {
  const double range_dn = sensor.clip_dn - sensor.black_level_dn, scale = 0.5 / truth.light(0.5);
  const std::size_t points = fits[0].points.size();
  std::printf("      code  electrons   mean %%  scatter %%  stated %%\n");
  for (std::size_t i = 0; i < points; i += 3) {
    double mean = 0.0, square = 0.0, stated = 0.0, code = 0.0;
    for (const ResponseFit& fit : fits) {
      const double n = static_cast<double>(fits.size()), u = (fit.points[i].code_dn - sensor.black_level_dn) / range_dn;
      const double error = fit.points[i].linear_dn / (scale * truth.light(u) * range_dn) - 1.0;
      mean += error / n;
      square += error * error / n;
      stated += fit.points[i].relative_sigma / n;
      code += u / n;
    }
    const double electrons = truth.light(code) * sensor.electrons_per_dn * range_dn;
    std::printf("    %6.4f %10.1f %8.3f %10.3f %9.3f\n", code, electrons, 100.0 * mean,
                100.0 * std::sqrt(std::max(0.0, square - mean * mean)), 100.0 * stated);
  }
}

void print_row(int bits, const CurvedResponse& truth, const Options& options) {
  const LinearSensor sensor = sensor_of_bits(bits);
  Errors ours, debevec, robertson;
  std::vector<ResponseFit> fits;
  double residual_scale = 0.0, iterations = 0.0, kinks = 0.0;
  int curves = 0;
  for (int trial = 0; trial < options.trials; ++trial) {
    const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(trial);
    const std::vector<Frame> frames =
        curved_bracket(truth, sensor, bits, options.even ? kEven_s : kUneven_s, seed, options.pixels);
    const ResponseFit fit = fit_response({frames}, sensor);
    if (fit.determined) {
      fits.push_back(fit);
      ours.add(response_errors(fit, truth, sensor));
      residual_scale += fit.residual_scale;
      iterations += fit.iterations;
      kinks += fit.kinks;
      curves += fit.curve ? 1 : 0;
    }
    if (bits != 8 || options.profile) continue;
    debevec.add(opencv_errors(*cv::createCalibrateDebevec(300), frames, truth, sensor));
    robertson.add(opencv_errors(*cv::createCalibrateRobertson(30, 0.01f), frames, truth, sensor));
  }
  const double n = std::max(1.0, static_cast<double>(fits.size()));
  std::printf("%2d bits %-16s", bits, truth.name.c_str());
  ours.print("ours");
  std::printf(" (%zu/%d, %d curves, residuals %.3f, %.0f iterations, %.1f kinks)", fits.size(), options.trials, curves, residual_scale / n,
              iterations / n, kinks / n);
  if (bits == 8 && !options.profile) {
    debevec.print("Debevec");
    robertson.print("Robertson");
  }
  std::printf("\n");
  if (options.profile && !fits.empty()) print_profile(fits, truth, sensor);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"Recovered responses against truth"};
  app.add_option("--trials", options.trials, "seeds")->check(CLI::Range(1, 1000));
  app.add_option("--seed", options.seed, "the first of them");
  app.add_option("--pixels", options.pixels, "of each frame")->check(CLI::Range(1000, 10'000'000));
  app.add_flag("--profile", options.profile, "error, scatter and stated sigma along the curve; without OpenCV");
  app.add_option("--bits", options.bits, "only these")->check(CLI::IsMember({8, 12, 14}));
  app.add_option("--curve", options.curve, "only responses whose name begins so");
  app.add_flag("--even", options.even, "exposures at ratios of 4 instead of 3, 5 and 4.2");
  CLI11_PARSE(app, argc, argv);
  std::printf("%s\n%d seeds, %d pixels: largest error in %% (median, worst seed), rms error in %%\n",
              machine_line().c_str(), options.trials, options.pixels);
  for (const int bits : {8, 12, 14}) {
    if (options.bits != 0 && bits != options.bits) continue;
    // The first four have been tuned on.
    for (const CurvedResponse& truth :
         {straight(), compressive(0.3), srgb_response(), gamma_response(2.2), gamma_response(1.8), rec709_response(),
          romm_response(), filmic_response(), shouldered_response(), two_slopes()}) {
      if (truth.name.rfind(options.curve, 0) == 0) print_row(bits, truth, options);
    }
  }
  return 0;
}
