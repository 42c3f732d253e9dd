#include "processing/fit/thinned_session.h"

#include <algorithm>
#include <limits>

#include "drivers/error.h"

namespace lumitexel {
namespace {

struct Directions {
  Eigen::Vector3d camera, lamp;  // unit vectors from the object's middle
  double squared_distance(const Directions& other) const {
    return (camera - other.camera).squaredNorm() + (lamp - other.lamp).squaredNorm();
  }
};

Eigen::Vector3d middle_of(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& position : mesh.positions) box.extend(position);
  return box.center();
}

// Indices of `kept` of the given directions, in the order in which they were chosen.
std::vector<std::size_t> farthest_points(const std::vector<Directions>& directions, std::size_t kept) {
  std::vector<double> nearest(directions.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> chosen{0};
  while (chosen.size() < kept) {
    for (std::size_t i = 0; i < directions.size(); ++i) {
      nearest[i] = std::min(nearest[i], directions[i].squared_distance(directions[chosen.back()]));
    }
    for (const std::size_t i : chosen) nearest[i] = -1.0;  // also where two views stand at one place
    chosen.push_back(static_cast<std::size_t>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin()));
  }
  return chosen;
}

}  // namespace

std::size_t heldout_views(const CalibratedSession& session) {
  return static_cast<std::size_t>(
      std::count_if(session.views.begin(), session.views.end(), [](const View& view) { return view.heldout; }));
}

std::size_t fit_views(const CalibratedSession& session) { return session.views.size() - heldout_views(session); }

CalibratedSession with_fit_views(const CalibratedSession& session, std::size_t kept) {
  if (kept == 0 || kept > fit_views(session)) {
    throw BadInput("views to fit", std::to_string(kept), "1 to " + std::to_string(fit_views(session)) + ", as many as the session has");
  }
  const Eigen::Vector3d middle = middle_of(session.mesh);
  std::vector<Directions> directions;
  std::vector<std::size_t> place;  // in session.views
  for (std::size_t v = 0; v < session.views.size(); ++v) {
    const View& view = session.views[v];
    if (view.heldout) continue;
    directions.push_back({(view.camera_in_world() - middle).normalized(), view.light.direction_from(middle)});
    place.push_back(v);
  }
  std::vector<bool> keep(session.views.size());
  for (const std::size_t i : farthest_points(directions, kept)) keep[place[i]] = true;

  CalibratedSession thinned = session;
  thinned.views.clear();
  for (std::size_t v = 0; v < session.views.size(); ++v) {
    if (session.views[v].heldout || keep[v]) thinned.views.push_back(session.views[v]);
  }
  return thinned;
}

}  // namespace lumitexel
