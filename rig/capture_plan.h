// What to photograph: the TOML file that `lumitexel plan RIG PLAN` names second.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/camera.h"

namespace lumitexel {

struct PlannedView {
  std::string name;  // "fit_000", "heldout_003": unique, a file name without extension
  bool heldout = false;
  double turntable_deg = 0, light_azimuth_deg = 0, light_elevation_deg = 0;
  bool operator==(const PlannedView&) const = default;
};

// What to photograph for the lens and the lamp's pattern, before the views. A part that is not wanted is empty.
struct LensPlan {
  double board_exposure_s = 0;
  int board_placements = 0;
  std::vector<double> flat_field_exposures_s;  // ascending
  int flat_field_frames = 0;                   // at each exposure
  std::vector<double> lamp_pattern_exposures_s;  // ascending
  double light_azimuth_deg = 0, light_elevation_deg = 0;  // of the point light for the lamp's pattern
  bool operator==(const LensPlan&) const = default;
};

// A plan with [lens] may come without views, and then without mesh, exposures and gray card.
struct CapturePlan {
  std::string name;
  std::string mesh;  // the coarse mesh in the table's frame: a path relative to the plan, or "scan" for the
                     // simulated scanner
  std::vector<PlannedView> views;
  std::vector<double> bracket_exposures_s;    // of the object, ascending
  std::vector<double> gray_card_exposures_s;  // ascending
  double silhouette_exposure_s = 0, spheres_ring_exposure_s = 0, spheres_point_exposure_s = 0;
  double gray_card_light_azimuth_deg = 0, gray_card_light_elevation_deg = 0;
  int darks_per_exposure = 0;
  double gain_db = 0;
  std::optional<LensPlan> lens;
  bool operator==(const CapturePlan&) const = default;
};

// Reads and checks a plan; same errors as parse_rig.
CapturePlan parse_plan(const std::string& toml_text, const std::string& where);

}  // namespace lumitexel
