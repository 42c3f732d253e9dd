#include "processing/calibration/import/imported_poses.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <memory>
#include <sstream>

#include "processing/calibration/pose/register_posed_views.h"

namespace lumitexel {
namespace {

constexpr int kLeastSize_px = 32;

bool same(const CameraModel& a, const CameraModel& b) {
  return a.width_px == b.width_px && a.height_px == b.height_px && a.focal_x_px == b.focal_x_px && a.focal_y_px == b.focal_y_px &&
         a.principal_x_px == b.principal_x_px && a.principal_y_px == b.principal_y_px && a.k1 == b.k1 && a.k2 == b.k2 && a.p1 == b.p1 &&
         a.p2 == b.p2;
}

bool one_camera(const CalibratedSession& session) {
  return std::all_of(session.views.begin(), session.views.end(),
                     [&](const View& view) { return same(view.camera, session.views[0].camera); });
}

// One a view; null where the mask has no rim to measure.
std::vector<std::unique_ptr<ContourLookup>> rims_of(const std::vector<std::optional<ObjectPixels>>& masks) {
  std::vector<std::unique_ptr<ContourLookup>> rims(masks.size());
  tbb::parallel_for(std::size_t{0}, masks.size(), [&](std::size_t v) {
    if (!masks[v] || std::min(masks[v]->width_px, masks[v]->height_px) < kLeastSize_px) return;
    const SilhouetteContour contour = contour_of_mask(masks[v]->inside, masks[v]->width_px, masks[v]->height_px);
    if (!contour.points.empty()) rims[v] = std::make_unique<ContourLookup>(contour);
  });
  return rims;
}

// Nothing if the views have several cameras.
void state_params(const CalibratedSession& session, LensSummary& lens) {
  if (!one_camera(session)) return;
  const CameraModel& c = session.views[0].camera;
  lens.params = {c.focal_x_px, c.focal_y_px, c.principal_x_px, c.principal_y_px, c.k1, c.k2, c.p1, c.p2};
}

std::string lens_note(const PosedViewsRegistration& result, const Eigen::Vector3d& sigma) {
  std::ostringstream text;
  const Eigen::Vector3d& step = *result.lens_step;
  text << std::setprecision(3) << "silhouettes against the given lens: focal length " << 100.0 * step[0] << " ± " << 100.0 * sigma[0]
       << " %, principal point " << step[1] << " ± " << sigma[1] << ", " << step[2] << " ± " << sigma[2] << " px; chi-square "
       << result.lens_chi_square << " with three degrees of freedom (the limit is 7.8): the given lens "
       << (result.lens_contradicted ? "is replaced" : "stays");
  return text.str();
}

void state_lens(const PosedViewsRegistration& result, CalibratedSession& session, LensSummary& lens) {
  if (result.lens_step) {
    const Eigen::Vector3d sigma = result.lens_covariance.diagonal().cwiseSqrt(), &step = *result.lens_step;
    lens.source = result.lens_contradicted ? "silhouettes" : "given, confirmed by the silhouettes";
    lens.notes.push_back(lens_note(result, sigma));
    if (result.lens_contradicted) {
      for (View& view : session.views) view.camera = with_shared_lens(view.camera, step);
    }
    state_params(session, lens);
    const CameraModel& c = session.views[0].camera;
    lens.sigma = {sigma[0] * c.focal_x_px, sigma[0] * c.focal_y_px, sigma[1], sigma[2]};
  } else if (!one_camera(session)) {
    lens.notes.push_back("the views have several cameras: none of them was compared with the silhouettes");
  }
}

void state_pose(const RegisteredPosedView& found, View& view, PoseSummary& pose) {
  pose.problem = found.problem;
  if (!found.measured) return;
  pose.source = found.contradicted ? "silhouette" : found.problem.empty() ? "given, confirmed by the silhouette" : "given";
  pose.sigma_m = found.sigma_m;
  pose.sigma_deg = found.sigma_deg;
  pose.given_px = found.given_px;
  pose.silhouette_px = found.contradicted ? found.silhouette_px : found.given_px;
  pose.contradiction = found.chi_square;
  const double most = std::max({found.contour_share, found.given_share, found.rim_share});
  pose.dominant = most == found.contour_share ? "contour" : most == found.given_share ? "given pose" : "rim of the masks";
  if (found.contradicted) view.camera_from_world = found.camera_from_mesh;
}

void state_shares(const std::vector<RegisteredPosedView>& views, std::vector<UncertaintyShare>& shares) {
  double contour = 0.0, given = 0.0, rim = 0.0;
  for (const RegisteredPosedView& view : views) {
    if (!view.measured) continue;
    const double variance = view.sigma_m * view.sigma_m;
    contour += view.contour_share * variance;
    given += view.given_share * variance;
    rim += view.rim_share * variance;
  }
  const double total = contour + given + rim;
  if (!(total > 0.0)) return;
  shares.push_back({"poses", "contour", contour / total});
  shares.push_back({"poses", "given poses", given / total});
  shares.push_back({"poses", "rim of the masks", rim / total});
}

void take_over(const PosedViewsRegistration& result, const std::vector<std::size_t>& registered, CalibratedSession& session,
               CalibrationSummary& summary) {
  if (!result.converged) {
    summary.pose_problem = result.problem;
    return;
  }
  summary.rim_offset_px = result.rim_offset_px;
  summary.rim_offset_sigma_px = result.rim_offset_sigma_px;
  state_lens(result, session, summary.lens);
  for (std::size_t k = 0; k < registered.size(); ++k) {
    state_pose(result.views[k], session.views[registered[k]], summary.poses[registered[k]]);
  }
  state_shares(result.views, summary.shares);
}

}  // namespace

void check_given_poses(CalibratedSession& session, const std::vector<std::optional<ObjectPixels>>& masks,
                       const CalibrationOptions& options, CalibrationSummary& summary, Progress& progress) {
  for (const View& view : session.views) {
    PoseSummary& pose = summary.poses.emplace_back();
    pose.view = view.name;
    pose.source = "given";
  }
  summary.lens.source = "given";
  state_params(session, summary.lens);
  if (!options.takes(CalibrationStep::Pose)) return;
  if (std::none_of(masks.begin(), masks.end(), [](const auto& mask) { return mask.has_value(); })) {
    summary.pose_problem = "no masks were given, and a photograph under a point light shows no outline to be trusted";
    return;
  }
  const auto rims = rims_of(masks);
  const MeshSilhouette mesh(session.mesh);
  std::vector<PosedView> views;
  std::vector<std::size_t> registered;
  for (std::size_t v = 0; v < session.views.size(); ++v) {
    const View& view = session.views[v];
    if (!rims[v] || !((view.camera_from_world * mesh.extent().centre).z() > 0.0)) {
      summary.poses[v].problem = rims[v] ? "the object's middle is behind the camera" : "its mask has no rim that could be measured";
      continue;
    }
    views.push_back({rims[v].get(), view.camera, view.camera_from_world});
    registered.push_back(v);
  }
  if (views.empty()) {
    summary.pose_problem = "no mask has a rim that could be measured";
    return;
  }
  PosedViewsOptions registration;
  registration.refine_lens = options.takes(CalibrationStep::Lens) && one_camera(session);
  progress.begin("poses", 1, "fits");
  take_over(register_posed_views(mesh, views, registration), registered, session, summary);
  progress.update(1);
}

}  // namespace lumitexel
