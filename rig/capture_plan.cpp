#include "rig/capture_plan.h"

#include <set>

#include "rig/toml_table.h"

namespace lumitexel {
namespace {

// Wider than any rig; what this rig reaches is checked when the shots are scheduled.
const NumberRange kTurn = NumberRange::between(-3600.0, 3600.0);
const NumberRange kAzimuth = NumberRange::between(-180.0, 180.0);
const NumberRange kElevation = NumberRange::between(-90.0, 90.0);
constexpr int kMostDarks = 1000, kMostFlatFields = 1000;
constexpr int kMostPlacements = 200;

bool is_file_stem(const std::string& name) {
  constexpr const char* kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  return name.find_first_not_of(kAllowed) == std::string::npos && name.front() != '-';
}

PlannedView read_view(const TomlTable& table) {
  PlannedView view;
  view.name = table.string("name");
  if (!is_file_stem(view.name)) table.reject("name", view.name, "letters, digits, '_' and '-' only");
  const std::string split = table.string("split");
  if (split != "fit" && split != "heldout") table.reject("split", split, "fit or heldout");
  view.heldout = split == "heldout";
  view.turntable_deg = table.number("turntable_deg", kTurn);
  view.light_azimuth_deg = table.number("light_azimuth_deg", kAzimuth);
  view.light_elevation_deg = table.number("light_elevation_deg", kElevation);
  table.reject_unread();
  return view;
}

std::vector<double> read_bracket(const TomlTable& table, const std::string& key) {
  const std::vector<double> exposures_s = table.numbers(key, 0, NumberRange::positive());
  for (std::size_t i = 1; i < exposures_s.size(); ++i) {
    if (exposures_s[i] <= exposures_s[i - 1]) table.reject(key, "not ascending", "exposures from short to long");
  }
  return exposures_s;
}

void read_exposures(const TomlTable& table, CapturePlan& plan) {
  plan.bracket_exposures_s = read_bracket(table, "bracket_s");
  plan.gray_card_exposures_s = read_bracket(table, "gray_card_s");
  plan.silhouette_exposure_s = table.number("silhouette_s", NumberRange::positive());
  plan.spheres_ring_exposure_s = table.number("spheres_ring_s", NumberRange::positive());
  plan.spheres_point_exposure_s = table.number("spheres_point_s", NumberRange::positive());
  table.reject_unread();
}

std::vector<PlannedView> read_views(const TomlTable& table) {
  std::vector<PlannedView> views;
  std::set<std::string> names;
  bool any_fit = false;
  for (const TomlTable& entry : table.tables("views")) {
    views.push_back(read_view(entry));
    if (!names.insert(views.back().name).second) {
      entry.reject("name", views.back().name + " for a second time", "a name of its own for every view");
    }
    any_fit = any_fit || !views.back().heldout;
  }
  if (!any_fit) table.reject("views", "every view is held out", "at least one view with split = \"fit\"");
  return views;
}

void read_lamp_pattern(const TomlTable& table, LensPlan& lens) {
  if (lens.board_placements == 0) table.reject("lamp_pattern_s", "given without board_placements", "a board to shine at");
  lens.lamp_pattern_exposures_s = read_bracket(table, "lamp_pattern_s");
  lens.light_azimuth_deg = table.number("light_azimuth_deg", kAzimuth);
  lens.light_elevation_deg = table.number("light_elevation_deg", kElevation);
}

LensPlan read_lens(const TomlTable& table) {
  LensPlan lens;
  if (table.has("board_s") || table.has("board_placements")) {
    lens.board_exposure_s = table.number("board_s", NumberRange::positive());
    lens.board_placements = table.integer("board_placements", 1, kMostPlacements);
  }
  if (table.has("flat_field_s") || table.has("flat_field_frames")) {
    lens.flat_field_exposures_s = read_bracket(table, "flat_field_s");
    lens.flat_field_frames = table.integer("flat_field_frames", 1, kMostFlatFields);
  }
  if (table.has("lamp_pattern_s")) read_lamp_pattern(table, lens);
  table.reject_unread();
  return lens;
}

// What only plans with views have; without them it would say something that nobody does.
void read_views_and_exposures(const TomlTable& table, CapturePlan& plan) {
  plan.mesh = table.string("mesh");
  read_exposures(table.table("exposures"), plan);
  const TomlTable card = table.table("gray_card");
  plan.gray_card_light_azimuth_deg = card.number("light_azimuth_deg", kAzimuth);
  plan.gray_card_light_elevation_deg = card.number("light_elevation_deg", kElevation);
  card.reject_unread();
  plan.views = read_views(table);
}

void reject_without_views(const TomlTable& table) {
  for (const char* key : {"mesh", "exposures", "gray_card"}) {
    if (table.has(key)) table.reject(key, "given in a plan without views", "views as well, or [lens] alone");
  }
}

}  // namespace

CapturePlan parse_plan(const std::string& toml_text, const std::string& where) {
  const TomlTable table = TomlTable::parse(toml_text, where);
  CapturePlan plan;
  plan.name = table.string("name");
  plan.gain_db = table.number("gain_db", NumberRange::finite());
  plan.darks_per_exposure = table.integer("darks_per_exposure", 1, kMostDarks);
  if (table.has("lens")) plan.lens = read_lens(table.table("lens"));
  if (table.has("views") || !plan.lens) {
    read_views_and_exposures(table, plan);
  } else {
    reject_without_views(table);
  }
  table.reject_unread();
  return plan;
}

}  // namespace lumitexel
