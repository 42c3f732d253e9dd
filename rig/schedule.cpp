#include "rig/schedule.h"

#include <algorithm>
#include <set>
#include <sstream>

#include "drivers/error.h"
#include "rig/motion_time.h"
#include "rig/view_order.h"

namespace lumitexel {
namespace {

// The plan's exposures as this camera can do them.
struct Exposures {
  CameraSettings silhouette, spheres_ring, spheres_point;
  std::vector<CameraSettings> bracket, gray_card;
};

struct LensExposures {
  CameraSettings board;
  std::vector<CameraSettings> flat_field, lamp_pattern;
};

class ExposureReader {
 public:
  ExposureReader(const CapturePlan& plan, const CameraLimits& limits, const std::string& where)
      : plan_(plan), limits_(limits), where_(where) {}

  // keys are the plan's, with their table: "exposures.bracket_s"
  CameraSettings single(double exposure_s, const std::string& key) const {
    try {
      return quantise({exposure_s, plan_.gain_db}, limits_, "the rig's camera");
    } catch (const OutOfRange& error) {
      throw BadInput(where_ + ": " + key, error.what(), "an exposure within these limits");
    }
  }

  std::vector<CameraSettings> bracket(const std::vector<double>& exposures_s, const std::string& key) const {
    std::vector<CameraSettings> settings;
    for (const double exposure_s : exposures_s) {
      settings.push_back(single(exposure_s, key));
      if (settings.size() > 1 && settings.back() == settings[settings.size() - 2]) {
        std::ostringstream step;
        step << "exposures further apart than the camera's step of " << limits_.exposure_step_s << " s";
        throw BadInput(where_ + ": " + key, "two exposures become the same", step.str());
      }
    }
    return settings;
  }

 private:
  const CapturePlan& plan_;
  const CameraLimits& limits_;
  const std::string& where_;
};

Exposures read_exposures(const CapturePlan& plan, const CameraLimits& limits, const std::string& where) {
  const ExposureReader read(plan, limits, where);
  return {read.single(plan.silhouette_exposure_s, "exposures.silhouette_s"),
          read.single(plan.spheres_ring_exposure_s, "exposures.spheres_ring_s"),
          read.single(plan.spheres_point_exposure_s, "exposures.spheres_point_s"),
          read.bracket(plan.bracket_exposures_s, "exposures.bracket_s"),
          read.bracket(plan.gray_card_exposures_s, "exposures.gray_card_s")};
}

LensExposures read_lens_exposures(const CapturePlan& plan, const CameraLimits& limits, const std::string& where) {
  const ExposureReader read(plan, limits, where);
  const LensPlan& lens = *plan.lens;
  LensExposures exposures;
  if (lens.board_placements > 0) exposures.board = read.single(lens.board_exposure_s, "lens.board_s");
  exposures.flat_field = read.bracket(lens.flat_field_exposures_s, "lens.flat_field_s");
  exposures.lamp_pattern = read.bracket(lens.lamp_pattern_exposures_s, "lens.lamp_pattern_s");
  return exposures;
}

void require_reach(const LightPositionerDescription& arm, double azimuth_deg, double elevation_deg,
                   const std::string& place) {
  const auto check = [&](const char* key, double value, double min, double max) {
    if (value >= min && value <= max) return;
    std::ostringstream what, expected;
    what << value;
    expected << "a position within the rig's light positioner's reach, " << min << " to " << max;
    throw BadInput(place + "." + key, what.str(), expected.str());
  };
  check("light_azimuth_deg", azimuth_deg, arm.azimuth_min_deg, arm.azimuth_max_deg);
  check("light_elevation_deg", elevation_deg, arm.elevation_min_deg, arm.elevation_max_deg);
}

void require_reach(const CapturePlan& plan, const LightPositionerDescription& arm, const std::string& where) {
  for (const PlannedView& view : plan.views) {
    require_reach(arm, view.light_azimuth_deg, view.light_elevation_deg, where + ": views." + view.name);
  }
  if (!plan.views.empty()) {
    require_reach(arm, plan.gray_card_light_azimuth_deg, plan.gray_card_light_elevation_deg, where + ": gray_card");
  }
  if (plan.lens && !plan.lens->lamp_pattern_exposures_s.empty()) {
    require_reach(arm, plan.lens->light_azimuth_deg, plan.lens->light_elevation_deg, where + ": lens");
  }
}

void require_board(const CapturePlan& plan, const RigDescription& rig, const std::string& where) {
  if (plan.lens && plan.lens->board_placements > 0 && !rig.board) {
    throw BadInput(where + ": lens.board_placements", "the rig has no board", "a [board] in the rig's file");
  }
}

// The view after which the card costs the least motion; usually the plan gives the card the light of one of its
// views, so that this view's spheres say where the card's light stood.
std::size_t view_for_gray_card(const CapturePlan& plan, const std::vector<RigPosition>& positions,
                               const RigDescription& rig) {
  const auto detour_s = [&](const RigPosition& view) {
    return sequential_motion_s(
        view, {view.turntable_deg, plan.gray_card_light_azimuth_deg, plan.gray_card_light_elevation_deg}, rig);
  };
  const auto nearest = std::min_element(positions.begin(), positions.end(), [&](const auto& a, const auto& b) {
    return detour_s(a) < detour_s(b);
  });
  return static_cast<std::size_t>(nearest - positions.begin());
}

class ShotList {
 public:
  void stand_at(const RigPosition& position) { position_ = position; }

  void add(ShotKind kind, const std::string& view, int index, const CameraSettings& camera) {
    shots_.push_back({static_cast<std::int64_t>(shots_.size()) + 1, kind, view, index, camera, position_.turntable_deg,
                      position_.light_azimuth_deg, position_.light_elevation_deg});
  }
  void add_bracket(ShotKind kind, const std::string& view, const std::vector<CameraSettings>& bracket) {
    for (std::size_t i = 0; i < bracket.size(); ++i) add(kind, view, static_cast<int>(i), bracket[i]);
  }
  void add_darks(int repetitions) {
    std::set<std::pair<double, double>> used;  // sorted, so that the order is the same every time
    for (const Shot& shot : shots_) used.insert({shot.camera.exposure_s, shot.camera.gain_db});
    for (const auto& [exposure_s, gain_db] : used) {
      for (int i = 0; i < repetitions; ++i) add(ShotKind::Dark, "", i, {exposure_s, gain_db});
    }
  }
  std::vector<Shot> take() { return std::move(shots_); }

 private:
  std::vector<Shot> shots_;
  RigPosition position_;
};

// Where the axes stand when a session begins.
RigPosition at_rest(const LightPositionerDescription& arm) {
  return {0.0, std::clamp(0.0, arm.azimuth_min_deg, arm.azimuth_max_deg),
          std::clamp(0.0, arm.elevation_min_deg, arm.elevation_max_deg)};
}

void add_lens_shots(const CapturePlan& plan, const RigDescription& rig, const std::string& where, ShotList& list) {
  const LensPlan& lens = *plan.lens;
  const LensExposures exposures = read_lens_exposures(plan, rig.camera.limits, where);
  list.stand_at(at_rest(rig.light_positioner));
  for (int placement = 1; placement <= lens.board_placements; ++placement) {
    list.add(ShotKind::Board, "", placement, exposures.board);
    if (placement > 1 || exposures.lamp_pattern.empty()) continue;
    list.stand_at({0.0, lens.light_azimuth_deg, lens.light_elevation_deg});
    list.add_bracket(ShotKind::LampPattern, "", exposures.lamp_pattern);
  }
  for (const CameraSettings& settings : exposures.flat_field) {
    for (int i = 0; i < lens.flat_field_frames; ++i) list.add(ShotKind::FlatField, "", i, settings);
  }
}

void add_views(const CapturePlan& plan, const RigDescription& rig, const std::string& where, ShotList& list) {
  const Exposures exposures = read_exposures(plan, rig.camera.limits, where);
  std::vector<RigPosition> positions;
  for (const PlannedView& view : plan.views) {
    positions.push_back({view.turntable_deg, view.light_azimuth_deg, view.light_elevation_deg});
  }
  const std::size_t card_view = view_for_gray_card(plan, positions, rig);
  for (const std::size_t i : short_order(positions, rig)) {
    const std::string& view = plan.views[i].name;
    list.stand_at(positions[i]);
    list.add(ShotKind::Silhouette, view, 0, exposures.silhouette);
    list.add(ShotKind::SpheresRing, view, 0, exposures.spheres_ring);
    list.add(ShotKind::SpheresPoint, view, 0, exposures.spheres_point);
    list.add_bracket(ShotKind::Object, view, exposures.bracket);
    if (i != card_view) continue;
    list.stand_at(
        {positions[i].turntable_deg, plan.gray_card_light_azimuth_deg, plan.gray_card_light_elevation_deg});
    list.add_bracket(ShotKind::GrayCard, "", exposures.gray_card);
  }
}

}  // namespace

std::vector<Shot> schedule_shots(const CapturePlan& plan, const RigDescription& rig, const std::string& plan_where) {
  require_reach(plan, rig.light_positioner, plan_where);
  require_board(plan, rig, plan_where);
  ShotList list;
  if (plan.lens) add_lens_shots(plan, rig, plan_where, list);
  if (!plan.views.empty()) add_views(plan, rig, plan_where, list);
  list.add_darks(plan.darks_per_exposure);
  return list.take();
}

}  // namespace lumitexel
