// The stray lights of a captured session, and how much of what its gray card and its board reflect is theirs.
//
// Nothing is corrected by it. The photographs hold a stray's light as the card does, so a lamp freed of it would make the object
// too bright; and whether something stands between the stray and the card nobody knows. Shares widen sigmas, by all of themselves.
#pragma once

#include <vector>

#include "processing/calibration/calibration_summary.h"
#include "processing/calibration/light/stray_share.h"
#include "processing/calibration/session_lights.h"

namespace lumitexel {

class SessionStrays {
 public:
  SessionStrays(const SphereHighlights& seen, const SessionLights& lights, const CameraModel& camera, const RigDescription& rig);

  bool any() const { return !strays_.empty(); }
  // Root mean squares by the shares' sigmas, per channel, of all strays' irradiance over the lamp's at a place (rig's frame) under a lamp
  // standing there. Counted are those that stand still (seen in two views or more) and those of that view; without a view,
  // of the one whose lamp stood nearest. In a channel in which a stray's share is not known it counts as much as
  // the lamp. Empty if there is no stray.
  std::vector<double> shares(const LitPlace& place, const Eigen::Vector3d& lamp_in_rig, std::size_t view) const;
  std::vector<double> shares(const LitPlace& place, const Eigen::Vector3d& lamp_in_rig) const;

  // One entry a stray; views by name, share at the card under the lamp of its own bracket.
  std::vector<StrayLightSummary> summarise(const std::vector<std::string>& view_names, const LitPlace& card,
                                           const Eigen::Vector3d& lamp_in_rig) const;

 private:
  std::size_t nearest_view(const Eigen::Vector3d& lamp_in_rig) const;
  LitPlace in_camera(const LitPlace& place) const;

  Eigen::Isometry3d camera_from_rig_;
  SphereLine line_;
  std::vector<StrayLight> strays_;
  std::vector<Strength> lamp_;  // a sphere
  std::vector<Eigen::Vector3d> lamps_in_rig_;  // a view
  std::size_t channels_;
};

}  // namespace lumitexel
