// A bench whose camera sees the rendered world through the simulated sensor.
#include "sim/render_radiance.h"
#include "sim/sensor.h"
#include "sim/simulated_bench.h"
#include "sim/simulated_rig.h"

namespace lumitexel {
namespace {

struct RenderedPixels {
  explicit RenderedPixels(const std::shared_ptr<const SimulatedWorld>& world)
      : renderer(world), sensor(world->rig.camera, world->settings) {}
  RadianceRenderer renderer;
  SimulatedSensor sensor;
};

}  // namespace

std::shared_ptr<SimulatedBench> make_rendered_bench(const RigDescription& rig, std::shared_ptr<SimulatedWorld> world,
                                                    std::shared_ptr<Clock> clock) {
  const auto pixels = std::make_shared<RenderedPixels>(world);
  return std::make_shared<SimulatedBench>(
      rig, world->settings, std::move(clock),
      [pixels](const WorldState& state, const CameraSettings& settings, std::uint64_t noise_key) {
        // One lamp at a time: the sequencer sees to that.
        const double light_share = state.point_light && !state.flat_field ? state.lamp_strength : 1.0;
        return pixels->sensor.expose(*pixels->renderer.render(state), settings, noise_key, light_share,
                                     state.sensor_warming_k);
      });
}

}  // namespace lumitexel
