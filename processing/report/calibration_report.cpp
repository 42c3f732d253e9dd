#include "processing/report/calibration_report.h"

#include <algorithm>
#include <map>
#include <sstream>

#include "processing/image/raster_file.h"
#include "processing/report/html.h"
#include "processing/report/page_style.h"

namespace lumitexel {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string measured(const std::optional<double>& value, double factor = 1.0, int digits = 3) {
  return value ? html::number(factor * *value, digits) : "–";
}

std::string notes_list(const std::vector<std::string>& notes) {
  std::string list;
  for (const std::string& note : notes) list += "<li>" + html::escaped(note) + "</li>";
  return list.empty() ? "" : "<ul>" + list + "</ul>";
}

const std::map<std::string, std::string>& captions() {
  static const std::map<std::string, std::string> texts{
      {"lens_coverage.png",
       "Where the board's corners were seen; arrows are what the lens model does not explain, magnified; shaded cells "
       "had no corner."},
      {"vignetting.png", "The lens's transmission over the picture; a contour every 5 %."}};
  return texts;
}

std::string pictures_markup(const CalibrationSummary& summary, const std::filesystem::path& folder,
                            const std::vector<std::string>& wanted) {
  std::string markup;
  for (const std::string& name : summary.pictures) {
    if (std::find(wanted.begin(), wanted.end(), name) == wanted.end()) continue;
    RasterImage raster = read_raster(folder / name);
    for (float& value : raster.code_values.data) value /= raster.maximum;
    markup += html::figure(html::picture(raster.code_values, name), captions().at(name));
  }
  return markup.empty() ? "" : "<div class=\"row\">" + markup + "</div>";
}

std::string lens_section(const CalibrationSummary& summary, const std::filesystem::path& folder) {
  const LensSummary& lens = summary.lens;
  static const char* kNames[] = {"focal length x, px", "focal length y, px", "principal point x, px",
                                 "principal point y, px", "k1", "k2", "p1", "p2"};
  Rows rows;
  for (std::size_t i = 0; i < lens.params.size(); ++i) {
    rows.push_back({kNames[i], html::number(lens.params[i], 7), i < lens.sigma.size() ? html::number(lens.sigma[i], 2) : "–"});
  }
  const bool boards = lens.boards > 0 || lens.corner_transmission;
  Rows fit{{"boards used", std::to_string(lens.boards)},
           {"re-projection, px rms", measured(lens.reprojection_px)},
           {"sigma of a corner's place, px", measured(lens.corner_sigma_px, 1.0, 2)},
           {"transmission in the corner", measured(lens.corner_transmission, 1.0, 4)},
           {"its sigma", measured(lens.corner_transmission_sigma, 1.0, 2)}};
  return html::section("Lens", "From: " + lens.source + ".",
                       html::table({"", "value", "sigma"}, rows) + (boards ? html::table({"", ""}, fit) : "") + notes_list(lens.notes) +
                           pictures_markup(summary, folder, {"lens_coverage.png", "vignetting.png"}));
}

std::string sensor_section(const SensorSummary& sensor, std::int64_t hot_pixels) {
  const Rows rows{
      {"gain, e/DN", html::number(sensor.electrons_per_dn, 5), measured(sensor.electrons_per_dn_sigma, 1.0, 2)},
      {"read noise, DN", html::number(sensor.read_noise_dn, 4), measured(sensor.read_noise_dn_sigma, 1.0, 2)},
      {"black level, DN", html::number(sensor.black_level_dn, 6), measured(sensor.black_level_dn_sigma, 1.0, 2)},
      {"saturation, DN", html::number(sensor.saturation_dn, 6), measured(sensor.saturation_dn_sigma, 1.0, 2)}};
  const Rows darks{{"hot pixels", std::to_string(hot_pixels)},
                   {"coldest, warmest frame, °C", measured(sensor.coldest_c) + ", " + measured(sensor.warmest_c)},
                   {"brackets whose darks were scaled", std::to_string(sensor.brackets_with_scaled_darks)},
                   {"least, largest scale", measured(sensor.least_dark_scale) + ", " + measured(sensor.largest_dark_scale)},
                   {"brackets with darks of another temperature, as they are",
                    std::to_string(sensor.brackets_with_drifted_darks)}};
  return html::section("Sensor",
                       "Noise figures from: " + sensor.source + ". " +
                           (sensor.linear ? "The sensor is linear." : "The sensor is not linear; its curve is undone."),
                       html::table({"", "value", "sigma"}, rows) + html::table({"", ""}, darks) + notes_list(sensor.notes));
}

std::string share_bars(const CalibrationSummary& summary) {
  std::string bars;
  for (const UncertaintyShare& share : summary.shares) {
    const std::string percent = html::number(100.0 * share.share, 3);
    bars += "<span>" + html::escaped(share.quantity + ": " + share.source) +
            "</span><span class=\"track\"><div class=\"fill\" style=\"width:" + percent +
            "%\"></div></span><span class=\"value\">" + percent + " %</span>";
  }
  return bars.empty() ? "" : "<h3>What its variance comes from</h3><div class=\"bars\">" + bars + "</div>";
}

std::string scale_section(const CalibrationSummary& summary) {
  Rows rows;
  for (std::size_t c = 0; c < summary.intensity.size(); ++c) {
    rows.push_back({"channel " + std::to_string(c), html::number(summary.intensity[c], 6),
                    html::number(100.0 * summary.scale_sigma, 2) + " %"});
  }
  const LampSummary& lamp = summary.lamp;
  std::ostringstream text;
  text << "The point light's intensity by the gray card, whose pose comes from: " << lamp.card_source << ". The card was read in "
       << lamp.card_views << " views (" << lamp.card_outliers << " of the readings do not fit). The lamp "
       << (lamp.drifts ? "drifts" : "is steady as far as can be told") << "; "
       << (lamp.at_10_deg ? "10 degrees off its axis it gives " + html::number(*lamp.at_10_deg, 4) + " ± " +
                                html::number(lamp.at_10_deg_sigma.value_or(0.0), 2) + " of its intensity."
                          : "no angular pattern was needed or measured.");
  text << " Its radius is " << html::number(1e3 * lamp.radius_m) << " mm, from: " << lamp.radius_source << "; ";
  if (lamp.highlights_radius_m) {
    text << "by its highlights " << html::number(1e3 * *lamp.highlights_radius_m) << " ± " << html::number(1e3 * *lamp.highlights_radius_sigma_m, 2) << " mm";
    text << (lamp.highlights_radius_found ? "." : ", but the search for it came to no end.");
  } else if (lamp.highlights_radius_bound_m) {
    text << "its highlights are a point's, up to " << html::number(1e3 * *lamp.highlights_radius_bound_m, 2) << " mm at 95 %.";
  } else {
    text << "its highlights tell nothing.";
  }
  return html::section("Scale and lamp", text.str(),
                       html::table({"", "intensity", "sigma"}, rows) + share_bars(summary));
}

std::string stray_note(const StrayLightSummary& light) {
  const Eigen::Vector3d& at = light.position_in_rig;
  std::string note = std::string("Stray light ") + (light.placed ? "at (" : "far away towards (") + html::number(at.x()) + ", " +
                     html::number(at.y()) + ", " + html::number(at.z()) + (light.placed ? ") m" : ")") + " in the rig's frame";
  if (light.placed) note += ", sigma " + html::number(1e3 * light.sigma_m) + " mm";
  note += ", on the spheres of " + std::to_string(light.views.size()) + " views: it is in their photographs too, and on the gray card, ";
  note += light.card_share ? "with " + html::number(100.0 * *light.card_share) + " ± " + html::number(100.0 * *light.card_share_sigma, 2) +
                                 " % of the lamp's light there (the channel with most of it) if nothing shades it."
                           : std::string("nobody knows how strongly.");
  note += light.counted_in_scale ? " Nothing is corrected: intensities may be too high by about as much, which the scale's sigma covers."
                                 : " Nothing is corrected; seen in one view alone it is taken not to shine at the card's own shots, and the scale's sigma leaves it out.";
  return note + " Move or cover it.";
}

}  // namespace

std::string calibrated_views_section(const CalibrationSummary& summary) {
  Rows rows;
  for (std::size_t v = 0; v < summary.lights.size(); ++v) {
    const LightSummary& light = summary.lights[v];
    const PoseSummary pose = v < summary.poses.size() ? summary.poses[v] : PoseSummary{};
    const bool lamp = v < summary.lamp.factor.size() && v < summary.lamp.factor_sigma.size() && summary.lamp.factor_sigma[v] > 0.0;
    rows.push_back({light.view, measured(pose.silhouette_px), measured(pose.sigma_m, 1e3), measured(pose.sigma_deg),
                    std::to_string(pose.tags), pose.dominant, html::number(1e3 * light.sigma_m),
                    std::to_string(light.highlights), light.from_spheres ? "spheres and arm" : "arm alone",
                    lamp ? html::number(summary.lamp.factor[v], 5) : "–",
                    lamp ? html::number(summary.lamp.factor_sigma[v], 2) : "–"});
  }
  std::vector<std::string> strays;
  for (const StrayLightSummary& light : summary.stray_lights) strays.push_back(stray_note(light));
  const std::string problem =
      summary.pose_problem.empty() ? "" : " Poses are the rig description's: " + summary.pose_problem;
  return html::section(
      "Poses and lights",
      "How surely it is known where object and lamp stood; pose, light and the last column are one sigma. Silhouette: median distance between "
      "the mesh's outline and the photograph's. Lamp: output over that at the gray card; a dash where it was taken to be steady." + problem,
      "<div class=\"scroll\">" +
          html::table({"view", "silhouette, px", "pose, mm", "pose, °", "tags", "mostly from", "light, mm", "highlights",
                       "light from", "lamp", "sigma"},
                      rows) +
          "</div>" + notes_list(strays));
}

std::string given_poses_section(const CalibrationSummary& summary) {
  Rows rows;
  for (const PoseSummary& pose : summary.poses) {
    rows.push_back({pose.view, pose.source, measured(pose.given_px), measured(pose.silhouette_px), measured(pose.contradiction, 1.0, 4),
                    measured(pose.sigma_m, 1e3), measured(pose.sigma_deg), pose.dominant, pose.problem});
  }
  std::string text =
      "Poses were given with the session. One is replaced only if its silhouette contradicts it: by a chi-square with six degrees of "
      "freedom, at 5 % for all views together. Silhouette: median distance between the mesh's outline and the mask's rim. One sigma "
      "each. Lights and scale are as given; nothing in the session measures them.";
  if (!summary.pose_problem.empty()) text += " Nothing was compared: " + summary.pose_problem + ".";
  if (summary.rim_offset_px) {
    text += " The masks' rims lie " + measured(summary.rim_offset_px) + " ± " + measured(summary.rim_offset_sigma_px, 1.0, 2) +
            " px outside of the mesh's outline.";
  }
  return html::section("Poses", text,
                       "<div class=\"scroll\">" +
                           html::table({"view", "pose", "silhouette as given, px", "silhouette, px", "chi-square of the given", "sigma, mm",
                                        "sigma, °", "mostly from", ""},
                                       rows) +
                           "</div>" + share_bars(summary));
}

std::string calibration_report(const CalibratedSession& session, const CalibrationSummary& summary,
                               const std::filesystem::path& pictures, const std::string& truth_text,
                               const std::string& data_json) {
  std::string body = "<header><h1>Calibration</h1><p>" + std::to_string(session.views.size()) +
                     " views. Every sigma is one standard deviation; a dash means: not measured.</p></header>";
  if (!session.views.empty()) body += summary.intensity.empty() ? given_poses_section(summary) : calibrated_views_section(summary);
  if (!summary.intensity.empty()) body += scale_section(summary);
  if (!summary.lens.params.empty()) body += lens_section(summary, pictures);
  if (summary.sensor.electrons_per_dn > 0) body += sensor_section(summary.sensor, summary.hot_pixels);
  if (!truth_text.empty()) {
    body += html::section("Against the simulation's truth", "Known because the session was simulated.",
                          "<pre>" + html::escaped(truth_text) + "</pre>");
  }
  return html::page("Calibration", kPageStyle, body, data_json);
}

}  // namespace lumitexel
