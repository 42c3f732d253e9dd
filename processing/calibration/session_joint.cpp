#include "processing/calibration/session_joint.h"

#include <cmath>

#include "processing/calibration/lens/chi_square.h"
#include "processing/calibration/pose/joint_refinement.h"

namespace lumitexel {
namespace {

constexpr double kOneInTwenty_z = 1.645;

// Highlights that fit worse than they say count for less, so that they do not outweigh the lens's own measurement.
SphereHighlights with_honest_sigmas(SphereHighlights seen, double sigma_scale) {
  for (HighlightPixel& ring : seen.rings) ring.sigma_px *= sigma_scale;
  for (std::vector<HighlightPixel>& view : seen.points) {
    for (HighlightPixel& point : view) point.sigma_px *= sigma_scale;
  }
  return seen;
}

int terms_of(const LensMatrix& covariance) { return static_cast<int>((covariance.diagonal().array() > 0.0).count()); }

void take_lens(const RefinedLens& refined, SessionLens& lens, LensSummary& summary) {
  lens.camera = refined.camera;
  lens.covariance = refined.covariance;
  const LensVector params = lens_vector(refined.camera);
  summary.params.assign(params.begin(), params.end());
  for (int i = 0; i < kLensParameters; ++i) summary.sigma[static_cast<std::size_t>(i)] = std::sqrt(refined.covariance(i, i));
}

void take_poses(const RefinedLens& refined, SessionPoses& poses, std::vector<PoseSummary>& summaries) {
  follow_lens(*poses.registration, refined);
  for (std::size_t v = 0; v < poses.registration->views.size(); ++v) {
    const RegisteredView& view = poses.registration->views[v];
    summaries[v].sigma_m = view.sigma_m;
    summaries[v].sigma_deg = view.sigma_deg;
    summaries[v].dominant = view.shares.dominant();
    if (poses.replaced) poses.camera_from_world[v] = view.camera_from_mesh;
  }
}

}  // namespace

LightSolution refine_jointly(const SphereHighlights& seen, const CapturedInputs& in, const CalibrationOptions& options,
                             SessionLens& lens, SessionPoses& poses, CalibrationSummary& summary) {
  if (!options.takes(CalibrationStep::Joint) || !lens.covariance) return measure_lights(seen, lens.camera, in.rig);
  const RefinedLens before = poses.registration ? lens_of(*poses.registration) : RefinedLens{lens.camera, *lens.covariance, 0.0};
  const LightSolution held = measure_lights(seen, before.camera, in.rig);
  LightSolution free = measure_lights(with_honest_sigmas(seen, held.sigma_scale), before.camera, in.rig, before.covariance);
  summary.joint.tried = true;
  summary.joint.chi2_gain = free.lens->chi2_gain;
  summary.joint.taken = free.converged && free.lens->chi2_gain > chi2_bound(terms_of(*lens.covariance), kOneInTwenty_z);
  free.sigma_scale = held.sigma_scale;
  if (!summary.joint.taken) {
    take_lens(before, lens, summary.lens);
    for (std::size_t v = 0; v < free.lights.size(); ++v) free.lights[v].position = held.lights[v].position;
    free.line = held.line;
    return free;
  }
  take_lens(*free.lens, lens, summary.lens);
  if (poses.registration) take_poses(*free.lens, poses, summary.poses);
  return free;
}

}  // namespace lumitexel
