// Error of the merged radiance over the Cramer-Rao bound of its bracket: over five decades, and about the radiance at
// which each exposure saturates; and the merge's speed.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "processing/image/hdr_merge.h"
#include "tests/bench/machine.h"
#include "tests/bench/sensor_information.h"

namespace {

using namespace lumitexel;

struct Setup {
  std::vector<double> exposures_s{0.0005, 0.004, 0.032, 0.256};
  int darks = 4, pixels = 40'000;
  std::uint64_t seed = 1;
  LinearSensor sensor{.electrons_per_dn = 1.2, .read_noise_dn = 4.0 / 1.2, .black_level_dn = 256.0, .clip_dn = 15256.0};
  SensorNoise noise{1.2, 4.0, 18000.0};
};

// Poisson electrons up to the full well, read noise, rounding: what config/rigs/simulated.toml describes.
Frame expose(const Setup& setup, double exposure_s, double rate, std::mt19937_64& random) {
  Frame frame;
  frame.width_px = setup.pixels / 100;
  frame.height_px = 100;
  frame.bits = 14;
  frame.reported.exposure_s = exposure_s;
  frame.samples.reserve(static_cast<std::size_t>(setup.pixels));
  std::normal_distribution<double> read(0.0, setup.noise.read_noise_e);
  const double mean_e = rate * exposure_s * setup.noise.electrons_per_dn;
  std::poisson_distribution<long> shot(std::max(mean_e, 1e-12));
  for (int i = 0; i < frame.width_px * frame.height_px; ++i) {
    const double electrons = mean_e > 1e6 ? setup.noise.full_well_e : std::min(static_cast<double>(shot(random)), setup.noise.full_well_e);
    const double dn = setup.sensor.black_level_dn + (electrons + read(random)) / setup.noise.electrons_per_dn;
    frame.samples.push_back(static_cast<std::uint16_t>(std::clamp(std::round(dn), 0.0, 16383.0)));
  }
  return frame;
}

DarkLibrary darks(const Setup& setup, std::mt19937_64& random) {
  DarkLibrary library;
  for (const double exposure_s : setup.exposures_s) {
    std::vector<Frame> frames;
    for (int i = 0; i < setup.darks; ++i) frames.push_back(expose(setup, exposure_s, 0.0, random));
    library.add(make_master_dark(frames, setup.sensor));
  }
  return library;
}

// Standard deviation of the best unbiased estimate of the rate; a dark's mean is an estimate of its own.
double bound(const Setup& setup, double rate) {
  const double dark_variance_e2 =
      (setup.noise.read_noise_e * setup.noise.read_noise_e + setup.noise.electrons_per_dn * setup.noise.electrons_per_dn / 12.0) / setup.darks;
  double information = 0.0;
  for (const double exposure_s : setup.exposures_s) {
    const double per_rate_e = exposure_s * setup.noise.electrons_per_dn;
    const double one = sample_information(rate * per_rate_e, setup.noise);
    if (one > 0.0) information += per_rate_e * per_rate_e / (1.0 / one + dark_variance_e2);
  }
  return 1.0 / std::sqrt(information);
}

struct Score {
  double ratio = 0, bias = 0, chi_square = 0, saturated = 0;
};

Score score(const Setup& setup, double rate) {
  std::mt19937_64 random(setup.seed + static_cast<std::uint64_t>(1e3 * std::log10(rate)));
  const DarkLibrary library = darks(setup, random);
  std::vector<Frame> frames;
  for (const double exposure_s : setup.exposures_s) frames.push_back(expose(setup, exposure_s, rate, random));
  const MosaicRadiance merged = merge_bracket(frames, library, setup.sensor);
  double sum = 0.0, squares = 0.0, chi = 0.0, count = 0.0;
  for (std::size_t i = 0; i < merged.value.size(); ++i) {
    if (merged.flags[i] & kUnusablePixel) continue;
    const double error = static_cast<double>(merged.value[i]) - rate;
    sum += error;
    squares += error * error;
    chi += error * error / static_cast<double>(merged.variance[i]);
    count += 1.0;
  }
  const double best = bound(setup, rate);
  return {std::sqrt(squares / count) / best, sum / count / best, chi / count,
          1.0 - count / static_cast<double>(merged.value.size())};
}

void print_speed(const Setup& setup) {
  std::mt19937_64 random(setup.seed);
  Setup large = setup;
  large.pixels = 1'000'000;
  const DarkLibrary library = darks(large, random);
  std::vector<Frame> frames;
  for (const double exposure_s : large.exposures_s) frames.push_back(expose(large, exposure_s, 2e5, random));
  // A scene's radiances spread over decades; every pixel its own.
  std::lognormal_distribution<double> spread(std::log(3e4), 3.0);
  std::normal_distribution<double> read(0.0, 3.3);
  for (std::size_t i = 0; i < frames[0].samples.size(); ++i) {
    const double rate = spread(random);
    for (Frame& frame : frames) {
      const double mean = rate * frame.reported.exposure_s;
      const double dn = 256.0 + std::min(mean + std::sqrt(mean / 1.2) * read(random) / 3.3, 15000.0) + read(random);
      frame.samples[i] = static_cast<std::uint16_t>(std::clamp(dn, 0.0, 16383.0));
    }
  }
  double best_s = 1e9;
  for (int i = 0; i < 7; ++i) {
    const auto start = std::chrono::steady_clock::now();
    merge_bracket(frames, library, large.sensor);
    best_s = std::min(best_s, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::printf("merge of %zu exposures: %.1f ns a pixel, best of 7, all cores\n", frames.size(), best_s * 1e9 / 1e6);
}

Score print_row(const Setup& setup, double rate) {
  const Score s = score(setup, rate);
  std::printf("%12.4g %10.3f %10.3f %10.3f %10.4f\n", rate, s.ratio, s.bias, s.chi_square, s.saturated);
  return s;
}

void print_decades(const Setup& setup, int per_decade, double highest) {
  double worst = 0.0, squares = 0.0;
  int radiances = 0;
  for (int i = 5 * per_decade; i >= 0; --i) {
    const Score s = print_row(setup, highest * std::pow(10.0, -static_cast<double>(i) / per_decade));
    worst = std::max(worst, s.ratio);
    squares += s.ratio * s.ratio;
    ++radiances;
    if (i < 5 * per_decade && i % per_decade == 0) {
      std::printf("decade: largest %.3f, root mean square %.3f\n", worst, std::sqrt(squares / radiances));
      worst = squares = 0.0;
      radiances = 0;
    }
  }
}

// Whether one sample came out below the limit decides there how much a pixel knows: no estimator reaches the bound at
// every radiance, and those above it profit. What counts is the mean over the neighbourhood.
void print_saturation(const Setup& setup, double exposure_s) {
  std::printf("about the saturation of %g s\n", exposure_s);
  double squares = 0.0, bounds = 0.0;
  for (int step = -6; step <= 10; ++step) {
    const double rate = (1.0 + 0.005 * step) * (setup.sensor.clip_dn - setup.sensor.black_level_dn) / exposure_s;
    const double best = bound(setup, rate);
    squares += std::pow(print_row(setup, rate).ratio * best, 2);
    bounds += best * best;
  }
  std::printf("root mean square over this neighbourhood / the bound's: %.3f\n", std::sqrt(squares / bounds));
}

}  // namespace

int main(int argc, char** argv) {
  Setup setup;
  int per_decade = 10;
  CLI::App app{"Error of merged radiance over the Cramer-Rao bound"};
  app.add_option("--trials", setup.pixels, "pixels for every radiance")->check(CLI::Range(1000, 10'000'000));
  app.add_option("--seed", setup.seed, "of the noise");
  app.add_option("--per-decade", per_decade, "radiances a decade");
  app.add_option("--exposures", setup.exposures_s, "in seconds");
  CLI11_PARSE(app, argc, argv);
  setup.pixels = setup.pixels / 100 * 100;
  std::printf("%s\n%d pixels a radiance, %zu exposures, seed %llu\n", machine_line().c_str(), setup.pixels,
              setup.exposures_s.size(), static_cast<unsigned long long>(setup.seed));
  std::printf("%12s %10s %10s %10s %10s\n", "DN/s", "RMSE/CRB", "bias/CRB", "chi2/n", "left out");
  const double shortest_s = *std::min_element(setup.exposures_s.begin(), setup.exposures_s.end());
  const double highest = 0.95 * (setup.sensor.clip_dn - setup.sensor.black_level_dn) / shortest_s;
  print_decades(setup, per_decade, highest);
  for (const double exposure_s : setup.exposures_s) {
    if (exposure_s > shortest_s) print_saturation(setup, exposure_s);
  }
  print_speed(setup);
  return 0;
}
