#include <cmath>
#include <map>
#include <memory>
#include <sstream>
#include <tuple>

#include "rig/capture_estimate.h"
#include "rig/console/capture_inputs.h"
#include "rig/console/command.h"
#include "rig/console/duration_text.h"

namespace lumitexel {
namespace {

struct PlanOptions {
  std::string rig, plan, mesh;
};

std::string summary_text(const CapturePlan& plan, const RigDescription& rig, const std::vector<Shot>& shots,
                         const CaptureEstimate& estimate) {
  std::map<ShotKind, int> per_kind;
  for (const Shot& shot : shots) ++per_kind[shot.kind];
  std::ostringstream text;
  text << plan.name << " on " << rig.name << ": " << plan.views.size() << " views, " << shots.size() << " shots\n";
  for (const auto& [kind, count] : per_kind) text << "  " << count << " " << to_string(kind) << "\n";
  text << "estimate    " << duration_text(estimate.estimate_s) << " (exposure " << duration_text(estimate.exposure_s)
       << ", readout " << duration_text(estimate.readout_s) << ", motion " << duration_text(estimate.motion_s) << ")\n"
       << "lower bound " << duration_text(estimate.lower_bound_s) << " (motion "
       << duration_text(estimate.shortest_motion_s) << ": all axes at once, no settling)\n"
       << "storage     " << static_cast<double>(estimate.bytes) / 1e6 << " MB\n";
  return text.str();
}

// Exposures that the camera can only approximate: {asked for, applied} in s.
std::vector<std::pair<double, double>> approximated(const CapturePlan& plan, const CameraLimits& limits) {
  constexpr double kWorthSaying = 1e-3;  // relative
  std::vector<double> asked{plan.silhouette_exposure_s, plan.spheres_ring_exposure_s, plan.spheres_point_exposure_s};
  asked.insert(asked.end(), plan.bracket_exposures_s.begin(), plan.bracket_exposures_s.end());
  asked.insert(asked.end(), plan.gray_card_exposures_s.begin(), plan.gray_card_exposures_s.end());
  std::vector<std::pair<double, double>> found;
  for (const double exposure_s : asked) {
    const double applied_s = quantise({exposure_s, plan.gain_db}, limits, "the rig's camera").exposure_s;
    if (std::abs(applied_s / exposure_s - 1.0) > kWorthSaying) found.emplace_back(exposure_s, applied_s);
  }
  return found;
}

CommandResult run(const PlanOptions& options) {
  const CaptureInputs inputs = read_capture_inputs(options.rig, options.plan, options.mesh);
  const auto& [rig, plan, shots] = std::tie(inputs.rig, inputs.plan, inputs.shots);
  const CaptureEstimate estimate = estimate_capture(shots, rig);
  CommandResult result;
  result.json = {{"shots", shots.size()},
                 {"views", plan.views.size()},
                 {"estimate_s", estimate.estimate_s},
                 {"lower_bound_s", estimate.lower_bound_s},
                 {"exposure_s", estimate.exposure_s},
                 {"readout_s", estimate.readout_s},
                 {"motion_s", estimate.motion_s},
                 {"bytes", estimate.bytes}};
  result.text = summary_text(plan, rig, shots, estimate);
  result.json["approximated_s"] = nlohmann::json::array();
  for (const auto& [asked_s, applied_s] : approximated(plan, rig.camera.limits)) {
    result.json["approximated_s"].push_back({asked_s, applied_s});
    std::ostringstream line;
    line << "note        the camera takes " << applied_s << " s for the plan's exposure of " << asked_s << " s\n";
    result.text += line.str();
  }
  return result;
}

}  // namespace

void add_plan_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<PlanOptions>();
  Command command(app, "plan", "Check a plan against a rig and say what it will cost; moves nothing");
  command.add_option("RIG", options->rig, "Rig description, TOML").required();
  command.add_option("PLAN", options->plan, "Capture plan, TOML").required();
  command.add_option("--mesh", options->mesh, "The object's coarse mesh (PLY, OBJ), instead of the plan's");
  command.callback([options, &action] { action = [options](CommandContext&) { return run(*options); }; });
}

}  // namespace lumitexel
