#include "processing/render/render_lit.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <cmath>
#include <numbers>

#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/render/skies.h"

namespace lumitexel {
namespace {

// A clock that passes a hundredth of a second whenever it is asked.
class TickingClock final : public Clock {
 public:
  double now_s() const override { return 0.01 * ticks_++; }
  std::int64_t utc_ns() const override { return 0; }
  void sleep_until(double, std::stop_token) override {}

 private:
  mutable std::atomic<int> ticks_ = 0;
};

struct CountingProgress final : Progress {
  void begin(const std::string&, std::int64_t steps, const std::string&) override { total = steps; }
  void update(std::int64_t steps) override { done = std::max(done.load(), steps); }
  std::int64_t total = 0;
  std::atomic<std::int64_t> done = 0;
};

Model plate() { return model_of(square_mesh(), 2, 2, diffuse_brdf(0.1, 0.2, 0.3)); }

LitView lit(const RenderLimits& limits, const Environment& sky, Progress& progress, const Clock& clock) {
  LitOptions options;
  options.limits = limits;
  return render_lit(plate(), view_from_above(16, 5.0), {{}, &sky}, options, progress, clock);
}

TEST(RenderLit, IsTheSameForAnyNumberOfThreads) {
  const Environment sky = uneven_sky(16, 8);
  const Model model = model_of(sphere_mesh(40, 20), 4, 4, diffuse_brdf(0.1, 0.2, 0.3));
  LitOptions options;
  options.limits.samples_per_pixel = 5;
  options.path.bounces = 2;
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return render_environment(model, view_from_above(32, 4.0), sky, options);
  };
  const LitView one = run(1), two = run(2), four = run(4);
  EXPECT_EQ(one.radiance.data, two.radiance.data);
  EXPECT_EQ(one.radiance.data, four.radiance.data);
  EXPECT_EQ(*one.noise, *four.noise);
  EXPECT_EQ(one.samples_per_pixel, 5);
  EXPECT_EQ(one.end, RenderEnd::Samples);
}

// However the work came to its end, the picture depends on the samples done alone.
TEST(RenderLit, EndsInTimeWithThePictureOfThatManySamples) {
  const Environment sky = uneven_sky(16, 8);
  CountingProgress progress;
  const LitView stopped = lit({1 << 20, 3.0, 0.0}, sky, progress, TickingClock());
  EXPECT_EQ(stopped.end, RenderEnd::Time);
  EXPECT_LE(stopped.seconds, 3.0);
  EXPECT_GT(stopped.samples_per_pixel, 5) << "a pass asks the clock about 20 times";
  EXPECT_LT(stopped.samples_per_pixel, 30);
  EXPECT_EQ(progress.done, progress.total);
  NoProgress silent;
  const LitView counted = lit({stopped.samples_per_pixel}, sky, silent, SystemClock());
  EXPECT_EQ(counted.radiance.data, stopped.radiance.data);
  const LitView hurried = lit({64, 1e-9, 0.0}, sky, silent, TickingClock());
  EXPECT_EQ(hurried.samples_per_pixel, 1) << "the first pass is always made";
  EXPECT_FALSE(hurried.noise.has_value());
}

// Asks for a stop once so many thousandths are done.
struct StoppingProgress final : Progress {
  explicit StoppingProgress(std::int64_t steps) : most(steps) {}
  void begin(const std::string&, std::int64_t, const std::string&) override {}
  void update(std::int64_t steps) override {
    if (steps >= most) source.request_stop();
  }
  std::int64_t most;
  std::stop_source source;
};

TEST(RenderLit, StopsAfterThePassThatIsUnderWay) {
  const Environment sky = uneven_sky(16, 8);
  LitOptions options;
  options.limits.samples_per_pixel = 10;
  const auto stopped_at = [&](std::int64_t thousandths) {
    StoppingProgress progress(thousandths);
    return render_lit(plate(), view_from_above(16, 5.0), {{}, &sky}, options, progress, SystemClock(), progress.source.get_token());
  };
  const LitView third = stopped_at(250);  // in the middle of the third pass of ten
  EXPECT_EQ(third.end, RenderEnd::Stopped);
  EXPECT_EQ(third.samples_per_pixel, 3);
  NoProgress silent;
  EXPECT_EQ(third.radiance.data, lit({3}, sky, silent, SystemClock()).radiance.data);
  EXPECT_EQ(stopped_at(0).samples_per_pixel, 1) << "the first pass is always made";
  EXPECT_EQ(stopped_at(990).end, RenderEnd::Samples) << "nothing is missing";
}

TEST(RenderLit, EndsWhereTheNoiseIsLowEnoughAndTheNoiseIsTrue) {
  const Environment sky = constant_sky(1.0, 1.0, 1.0);
  LitOptions options;
  options.path.sampling = EnvironmentSampling::Uniform;
  options.limits = {1 << 14, std::numeric_limits<double>::infinity(), 0.008};
  const LitView result = render_environment(plate(), view_from_above(32, 5.0), sky, options);
  EXPECT_EQ(result.end, RenderEnd::Noise);
  EXPECT_LE(*result.noise, 0.008);
  ASSERT_GT(result.samples_per_pixel, 16);
  options.limits = {result.samples_per_pixel - 1};
  EXPECT_GT(*render_environment(plate(), view_from_above(32, 5.0), sky, options).noise, 0.008) << "no pass too many";
  double squares = 0.0, mean = 0.0;
  for (std::size_t i = 0; i < result.radiance.data.size(); ++i) {
    const double expected = 0.1 * (1.0 + static_cast<double>(i % 3)) * std::numbers::pi;
    squares += std::pow(result.radiance.data[i] - expected, 2) / static_cast<double>(result.radiance.data.size());
    mean += expected / static_cast<double>(result.radiance.data.size());
  }
  // 1024 pixels with three degrees of freedom each: 2 % of a standard error, and 2 % of the actual error's own.
  EXPECT_NEAR(std::sqrt(squares) / mean, *result.noise, 0.12 * *result.noise);
}

TEST(RenderLit, RefusesWhatMakesNoSense) {
  const Environment sky = constant_sky(1.0, 1.0, 1.0);
  NoProgress silent;
  const SystemClock clock;
  EXPECT_BAD_INPUT(lit({0}, sky, silent, clock), "samples per pixel", "0");
  EXPECT_BAD_INPUT(lit({4, 0.0}, sky, silent, clock), "time limit");
  EXPECT_BAD_INPUT(lit({4, 1.0, -1.0}, sky, silent, clock), "noise");
  LitOptions options;
  const View view = view_from_above(4, 5.0);
  EXPECT_BAD_INPUT(render_lit(plate(), view, {}, options, silent, clock), "no light");
  Light lamp;
  lamp.intensity = {1.0};
  EXPECT_BAD_INPUT(render_lit(plate(), view, {{lamp}, nullptr}, options, silent, clock), "light", "1 channels");
  options.path.bounces = -1;
  EXPECT_BAD_INPUT(render_environment(plate(), view, sky, options), "bounces", "-1");
  Model gray = plate();
  gray.channels = 1;
  EXPECT_BAD_INPUT(render_environment(gray, view, sky, {}), "environment", "3 channels");
}

}  // namespace
}  // namespace lumitexel
