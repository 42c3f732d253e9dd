#include "rig/console/commission_page.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "processing/report/html.h"
#include "processing/report/page_style.h"

namespace lumitexel {
namespace {

constexpr double kWidth_px = 480, kHeight_px = 300, kLeft_px = 92, kRight_px = 14, kTop_px = 14, kBottom_px = 44;

struct Range {
  double low = 0, high = 1;
  double share(double value) const { return (value - low) / (high - low); }
};

// Of the values, zero included, with room at both ends.
Range range_of(const std::vector<CurvePoint>& points, double CurvePoint::*part) {
  Range range{0.0, 0.0};
  for (const CurvePoint& point : points) {
    range.low = std::min(range.low, point.*part);
    range.high = std::max(range.high, point.*part);
  }
  const double room = range.high > range.low ? 0.06 * (range.high - range.low) : 1.0;
  return {range.low < 0.0 ? range.low - room : 0.0, range.high + room};
}

// A scatter plot; slope: of a line through (0, offset) to draw with it, NaN for none.
std::string plot(const std::vector<CurvePoint>& points, const std::string& x_name, const std::string& y_name,
                 double offset = 0.0, double slope = std::nan("")) {
  const Range x = range_of(points, &CurvePoint::x), y = range_of(points, &CurvePoint::y);
  const auto x_px = [&](double value) { return kLeft_px + x.share(value) * (kWidth_px - kLeft_px - kRight_px); };
  const auto y_px = [&](double value) { return kHeight_px - kBottom_px - y.share(value) * (kHeight_px - kTop_px - kBottom_px); };
  std::ostringstream svg;
  svg << "<svg viewBox=\"0 0 " << kWidth_px << ' ' << kHeight_px << "\" role=\"img\">";
  for (int i = 0; i <= 4; ++i) {
    const double x_value = x.low + 0.25 * i * (x.high - x.low), y_value = y.low + 0.25 * i * (y.high - y.low);
    svg << "<line x1=\"" << kLeft_px << "\" x2=\"" << kWidth_px - kRight_px << "\" y1=\"" << y_px(y_value) << "\" y2=\""
        << y_px(y_value) << "\" stroke=\"#d9dde2\"/><text x=\"" << kLeft_px - 6 << "\" y=\"" << y_px(y_value) + 4
        << "\" text-anchor=\"end\">" << html::number(y_value) << "</text><text x=\"" << x_px(x_value) << "\" y=\""
        << kHeight_px - kBottom_px + 16 << "\" text-anchor=\"middle\">" << html::number(x_value) << "</text>";
  }
  if (std::isfinite(slope)) {
    svg << "<line x1=\"" << x_px(x.low) << "\" x2=\"" << x_px(x.high) << "\" y1=\"" << y_px(offset + slope * x.low)
        << "\" y2=\"" << y_px(offset + slope * x.high) << "\" stroke=\"#b4541a\"/>";
  }
  for (const CurvePoint& point : points) {
    svg << "<circle cx=\"" << x_px(point.x) << "\" cy=\"" << y_px(point.y) << "\" r=\"3\" fill=\"#2a5d9c\"/>";
  }
  svg << "<text x=\"" << 0.5 * (kLeft_px + kWidth_px) << "\" y=\"" << kHeight_px - 8 << "\" text-anchor=\"middle\">"
      << html::escaped(x_name) << "</text><text transform=\"translate(14 " << 0.5 * (kHeight_px - kBottom_px)
      << ") rotate(-90)\" text-anchor=\"middle\">" << html::escaped(y_name) << "</text></svg>";
  return svg.str();
}

std::vector<std::string> row(const std::string& name, const Measured& measured, const std::string& described) {
  return {name, html::number(measured.value, 5), html::number(measured.sigma, 2), described};
}

std::string sensor_section(const CommissionReport& report, const RigDescription& rig) {
  if (!report.sensor) return "";
  const SensorFindings& sensor = *report.sensor;
  const SensorDescription& described = rig.camera.sensor;
  std::vector<std::vector<std::string>> rows{
      row("black level, DN", sensor.black_level_dn, html::number(described.black_level_dn, 5)),
      row("gain, e/DN", sensor.electrons_per_dn, html::number(described.electrons_per_dn, 5)),
      row("read noise, e", sensor.read_noise_e, html::number(described.read_noise_e, 5)),
      row("dark current, e/s", sensor.dark_current_e_per_s, "–")};
  if (sensor.full_well_e) rows.push_back(row("full well, e", *sensor.full_well_e, html::number(described.full_well_e, 5)));
  std::string body = html::table({"", "measured", "one sigma", "described"}, rows);
  const double slope = 1.0 / sensor.electrons_per_dn.value;
  const double read_variance = sensor.read_noise_dn.value * sensor.read_noise_dn.value;
  body += "<div class=\"row\">" +
          html::figure(plot(sensor.photon_transfer, "mean signal, DN", "variance, DN²", read_variance, slope),
                       "Photon transfer: the noise's variance grows with the signal by one over the gain (line).") +
          html::figure(plot(sensor.linearity, "exposure, s", "deviation, %"),
                       "Linearity: the signal against slope times exposure.") +
          "</div>";
  return html::section("Camera", "Darks, and the point light at rising and falling exposures.", body);
}

std::string latency_text(const TimingFindings& timing) {
  return timing.settings_latency_frames ? std::to_string(*timing.settings_latency_frames) : "not checked";
}

std::string axis_section(const AxisFindings& axis) {
  const std::string text =
      "Slack " + html::number(axis.backlash.value) + " ± " + html::number(axis.backlash.sigma, 2) +
      "°; returns from one side to within " + html::number(axis.repeatability, 2) + "°; one picture tells " +
      html::number(axis.resolution, 2) + "° apart. Stands " + html::number(axis.settle_s) +
      " s after its encoder says that it has arrived.";
  return html::section(axis.axis, text,
                       "<div class=\"row\">" +
                           html::figure(plot(axis.settling, "s since the encoder's arrival", "displacement, °"),
                                        "Settling, one picture per return.") +
                           "<div></div></div>");
}

}  // namespace

std::string commission_page(const CommissionReport& report, const RigDescription& rig, const std::string& json) {
  std::string body = "<header><h1>" + html::escaped(rig.name) + "</h1><p>What was measured on this rig, backend " +
                     html::escaped(rig.backend) + ".</p></header>" + sensor_section(report, rig);
  const TimingFindings& timing = report.timing;
  std::vector<std::vector<std::string>> rows{
      {"frames with the earlier settings after a change", latency_text(timing), ""},
      {"of these, frames that say so", std::to_string(timing.honest_late_frames), ""},
      {"trigger to frame, less the exposure, s", html::number(timing.frame_overhead_s.value),
       html::number(timing.frame_overhead_s.sigma, 2)},
      {"the slowest, s", html::number(timing.slowest_overhead_s), ""}};
  if (timing.clock_drift_ppm) {
    rows.push_back({"camera's clock against this machine's, ppm", html::number(timing.clock_drift_ppm->value),
                    html::number(timing.clock_drift_ppm->sigma, 2)});
  }
  body += html::section("Timing", "From all frames of this run.", html::table({"", "measured", "one sigma"}, rows));
  for (const AxisFindings& axis : report.axes) body += axis_section(axis);
  std::string unchecked = "<ul>";
  for (const std::string& what : report.not_checked) unchecked += "<li>" + html::escaped(what) + "</li>";
  body += html::section("Not checked", "", unchecked + "</ul>");
  return html::page(rig.name + " – commissioning", kPageStyle, body, json);
}

}  // namespace lumitexel
