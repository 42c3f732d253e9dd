#include "processing/render/render_lit.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "drivers/error.h"
#include "processing/render/lamp_light.h"
#include "processing/render/progressive.h"

namespace lumitexel {
namespace {

constexpr int kSamplesToBelieve = 16;
constexpr int kProgressSteps = 1000;

void check(const Model& model, const View& view, const Lighting& lighting, const LitOptions& options) {
  check_lamps(view, lighting.lamps, model.channels);
  if (lighting.environment != nullptr && lighting.environment->channels() != 1 &&
      lighting.environment->channels() != model.channels) {
    throw BadInput("environment", std::to_string(lighting.environment->channels()) + " channels",
                   "1 or " + std::to_string(model.channels) + " as the model has");
  }
  if (lighting.environment == nullptr && lighting.lamps.empty())
    throw BadInput(view.name, "no light", "a lamp or an environment");
  const RenderLimits& limits = options.limits;
  if (limits.samples_per_pixel < 1) {
    throw BadInput("samples per pixel", std::to_string(limits.samples_per_pixel), "1 or more");
  }
  if (!(limits.time_s > 0.0)) throw BadInput("time limit", std::to_string(limits.time_s), "more than 0 s");
  if (!(limits.noise >= 0.0)) throw BadInput("noise", std::to_string(limits.noise), "0 or more");
  if (options.path.bounces < 0) throw BadInput("bounces", std::to_string(options.path.bounces), "0 or more");
}

// How much of the work is done: of the three limits, that which is nearest.
class Advance {
 public:
  Advance(const RenderLimits& limits, Progress& progress, const Clock& clock)
      : limits_(limits), progress_(progress), clock_(clock), started_s_(clock.now_s()) {
    progress_.begin("rendering", kProgressSteps, "thousandths");
  }
  double elapsed_s() const { return clock_.now_s() - started_s_; }

  void show(double samples, std::optional<double> noise) {
    double share = std::max(samples / limits_.samples_per_pixel, elapsed_s() / limits_.time_s);
    if (noise && *noise > 0.0) share = std::max(share, limits_.noise / *noise * (limits_.noise / *noise));
    progress_.update(static_cast<std::int64_t>(std::min(1.0, share) * kProgressSteps));
  }

 private:
  const RenderLimits& limits_;
  Progress& progress_;
  const Clock& clock_;
  double started_s_;
};

class Passes {
 public:
  Passes(const Model& model, const View& view, const Lighting& lighting, const LitOptions& options)
      : surface_(model),
        reflecting_(model, options.stage),
        view_(view),
        world_from_camera_(view.camera_from_world.inverse()),
        lighting_(lighting),
        options_(options),
        picture_(view.camera.width_px, view.camera.height_px, model.channels) {}

  // One sample more in every pixel. `row_done` is called from any thread with the number of rows done.
  template <typename RowDone>
  void add(int index, const RowDone& row_done) {
    std::atomic<int> rows = 0;
    tbb::parallel_for(0, view_.camera.height_px, [&](int y) {
      PathTracer tracer(surface_, reflecting_, lighting_, options_.path);
      for (int x = 0; x < view_.camera.width_px; ++x) add_sample(tracer, x, y, index);
      row_done(++rows);
    });
  }
  const ProgressivePicture& picture() const { return picture_; }
  std::int64_t dropped() const { return dropped_; }

 private:
  void add_sample(PathTracer& tracer, int x, int y, int index) {
    SampleSequence numbers(x, y, index % kReplicates, static_cast<std::uint32_t>(index / kReplicates));
    const Eigen::Vector2d inside = numbers.next();
    const Eigen::Vector3d direction =
        world_from_camera_.linear() * view_.camera.unproject({x + inside.x(), y + inside.y()});
    PathSample sample = tracer.trace(world_from_camera_.translation(), direction, numbers);
    if (!std::all_of(sample.radiance.begin(), sample.radiance.end(),
                     [](double value) { return std::isfinite(value); })) {
      ++dropped_;
      sample.radiance = {};
    }
    picture_.add(x, y, index, sample.radiance, sample.hit);
  }

  const ModelSurface surface_;
  const ReflectingModel reflecting_;
  const View& view_;
  const Eigen::Isometry3d world_from_camera_;
  const Lighting& lighting_;
  const LitOptions& options_;
  ProgressivePicture picture_;
  std::atomic<std::int64_t> dropped_ = 0;
};

}  // namespace

const char* to_string(RenderEnd end) {
  switch (end) {
    case RenderEnd::Samples:
      return "samples";
    case RenderEnd::Time:
      return "time";
    case RenderEnd::Noise:
      return "noise";
    case RenderEnd::Stopped:
      return "stopped";
  }
  return "unknown";
}

LitView render_lit(const Model& model, const View& view, const Lighting& lighting, const LitOptions& options,
                   Progress& progress, const Clock& clock, std::stop_token stop) {
  check(model, view, lighting, options);
  const RenderLimits& limits = options.limits;
  Advance advance(limits, progress, clock);
  Passes passes(model, view, lighting, options);
  LitView result;
  double slowest_pass_s = 0.0;
  while (true) {
    const double before_s = advance.elapsed_s();
    passes.add(result.samples_per_pixel, [&](int rows) {
      advance.show(result.samples_per_pixel + static_cast<double>(rows) / view.camera.height_px, result.noise);
    });
    ++result.samples_per_pixel;
    result.noise = passes.picture().noise(result.samples_per_pixel);
    result.seconds = advance.elapsed_s();
    slowest_pass_s = std::max(slowest_pass_s, result.seconds - before_s);
    const bool asked = limits.noise > 0.0 && result.samples_per_pixel >= kSamplesToBelieve;
    if (asked && result.noise && *result.noise <= limits.noise) {
      result.end = RenderEnd::Noise;
      break;
    }
    if (result.samples_per_pixel == limits.samples_per_pixel) break;
    if (stop.stop_requested()) {
      result.end = RenderEnd::Stopped;
      break;
    }
    if (result.seconds + slowest_pass_s > limits.time_s) {
      result.end = RenderEnd::Time;
      break;
    }
  }
  progress.update(kProgressSteps);
  result.radiance = passes.picture().mean(result.samples_per_pixel);
  result.hit = passes.picture().hit();
  result.dropped_samples = passes.dropped();
  return result;
}

LitView render_environment(const Model& model, const View& view, const Environment& environment,
                           const LitOptions& options) {
  NoProgress silent;
  return render_lit(model, view, {{}, &environment}, options, silent, SystemClock());
}

}  // namespace lumitexel
