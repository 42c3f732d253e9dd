// What to photograph: the TOML file that `lumitexel plan RIG PLAN` names second.
#pragma once

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
  bool operator==(const CapturePlan&) const = default;
};

// Reads and checks a plan; same errors as parse_rig.
CapturePlan parse_plan(const std::string& toml_text, const std::string& where);

}  // namespace lumitexel
