#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "processing/report/html.h"
#include "rig/console/experiment_page.h"

namespace lumitexel {
namespace {

constexpr double kWidth_px = 960, kLeft_px = 76, kRight_px = 130;
constexpr const char* kColours[] = {"#2a5d9c", "#3f8f5b", "#b4541a", "#7a4aa0", "#a8862a"};

template <typename... Values>
std::string formatted(const char* format, Values... values) {
  char buffer[400];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

// A rectangle of the drawing and the numbers at its edges.
struct Panel {
  double top_px, bottom_px, low_x, high_x, low_y, high_y;
  double x(double value) const { return kLeft_px + (value - low_x) / (high_x - low_x) * (kWidth_px - kLeft_px - kRight_px); }
  double y(double value) const { return bottom_px - (value - low_y) / (high_y - low_y) * (bottom_px - top_px); }
};

std::string open_svg(double height_px) {
  return formatted("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" role=\"img\" font-size=\"12\" fill=\"#444b54\">\n", kWidth_px,
                   height_px);
}

std::string text(double x, double y, const char* anchor, const std::string& words, const char* fill = "#444b54") {
  return formatted("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" style=\"fill:%s\">", x, y, anchor, fill) + html::escaped(words) + "</text>\n";
}

std::string rule(const Panel& p, double value, const char* colour, const char* label) {
  return formatted("<path d=\"M%.0f %.1f H%.0f\" stroke=\"%s\"/>\n", kLeft_px, p.y(value), kWidth_px - kRight_px, colour) +
         text(kLeft_px - 8, p.y(value) + 4, "end", label);
}

std::string horizontal_rules(const Panel& p, double step, int decimals) {
  std::string svg;
  for (int i = static_cast<int>(std::ceil(p.low_y / step - 1e-9)); i * step <= p.high_y + 1e-9; ++i) {
    svg += rule(p, i * step, "#d9dde2", formatted("%.*f", decimals, i * step).c_str());
  }
  return svg;
}

std::string goal_rule(const Panel& p) {
  constexpr double kGoal = 1.1;
  return formatted("<path d=\"M%.0f %.1f H%.0f\" stroke=\"#b4541a\"/>\n", kLeft_px, p.y(kGoal), kWidth_px - kRight_px) +
         text(kWidth_px - kRight_px + 8, p.y(kGoal) + 4, "start", "goal 1.1", "#b4541a");
}

std::string side_title(const Panel& p, const std::string& words) {
  return formatted("<text transform=\"translate(18 %.0f) rotate(-90)\" text-anchor=\"middle\">", 0.5 * (p.top_px + p.bottom_px)) +
         html::escaped(words) + "</text>\n";
}

using Curve = std::vector<std::pair<double, double>>;

std::string path_of(const Panel& p, const Curve& curve, const char* first) {
  std::string path;
  for (const auto& [x, y] : curve) path += formatted("%s%.2f %.2f", path.empty() ? first : "L", p.x(x), p.y(y));
  return path;
}

std::string line(const Panel& p, const Curve& curve, const char* colour) {
  return "<path d=\"" + path_of(p, curve, "M") + "\" fill=\"none\" stroke-width=\"2\" stroke=\"" + colour + "\"/>\n";
}

std::string band(const Panel& p, const Curve& low, Curve high, const char* colour) {
  std::reverse(high.begin(), high.end());
  return "<path d=\"" + path_of(p, low, "M") + path_of(p, high, "L") + "Z\" fill-opacity=\"0.25\" fill=\"" + colour + "\"/>\n";
}

// Light at 45 degrees, the eye in the same plane, `off` away from the mirror direction towards the normal.
double in_plane(const Brdf& brdf, double off_degrees) {
  const double light = std::numbers::pi / 4.0, eye = light - off_degrees * std::numbers::pi / 180.0;
  return evaluate(brdf, 0, lobe_geometry(Eigen::Vector3d::UnitZ(), {-std::sin(light), 0.0, std::cos(light)}, {std::sin(eye), 0.0, std::cos(eye)}));
}

std::vector<const FiveMaterialsScore*> successes(const ExperimentRow& row) {
  std::vector<const FiveMaterialsScore*> list;
  for (const FiveMaterialsScore& s : row.scores) {
    if (s.all_found) list.push_back(&s);
  }
  return list;
}

struct Band {
  Curve low, middle, high;  // 5th, 50th and 95th percentile, in percent of the truth
};

constexpr double kMostOff_degrees = 45.0;

Band deviation(const ExperimentRow& row, const std::vector<Brdf>& truth, std::size_t k) {
  Band result;
  for (double off = 0.0; off <= kMostOff_degrees; off += 0.5) {
    std::vector<double> percent;
    for (const FiveMaterialsScore* s : successes(row)) percent.push_back(100.0 * (in_plane(s->fitted[k], off) / in_plane(truth[k], off) - 1.0));
    std::sort(percent.begin(), percent.end());
    const auto at = [&](double share) { return percent[static_cast<std::size_t>(std::lround(share * static_cast<double>(percent.size() - 1)))]; };
    result.low.emplace_back(off, at(0.05));
    result.middle.emplace_back(off, at(0.5));
    result.high.emplace_back(off, at(0.95));
  }
  return result;
}

std::string angle_axis(const Panel& p) {
  std::string svg;
  for (int off = 0; off <= static_cast<int>(kMostOff_degrees); off += 5) {
    svg += formatted("<path d=\"M%.1f %.0f V%.0f\" stroke=\"#d9dde2\"/>\n", p.x(off), p.top_px, p.bottom_px) +
           text(p.x(off), p.bottom_px + 18, "middle", std::to_string(off) + "°");
  }
  return svg;
}

double rms(const std::vector<double>& errors) {
  double sum = 0.0;
  for (const double e : errors) sum += e * e;
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

// One point with the spread that so many seeds leave a root mean square: 1 / sqrt(2 n) of it.
std::string bound_mark(const Panel& p, double x, const std::vector<double>& errors, const char* colour, const std::string& name) {
  const double value = rms(errors), spread = value / std::sqrt(2.0 * static_cast<double>(errors.size()));
  return formatted("<path d=\"M%.1f %.1f V%.1f\" stroke=\"%s\" stroke-opacity=\"0.5\"/>", p.x(x), p.y(std::min(p.high_y, value + spread)),
                   p.y(std::max(0.0, value - spread)), colour) +
         formatted("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4.5\" fill=\"%s\"><title>", p.x(x), p.y(std::min(p.high_y, value)), colour) +
         html::escaped(name) + ": " + html::number(value) + "</title></circle>\n" + text(p.x(x), p.bottom_px + 18, "middle", name);
}

double mean_of(const std::vector<const FiveMaterialsScore*>& scores, double FiveMaterialsScore::* member) {
  double sum = 0.0;
  for (const FiveMaterialsScore* s : scores) sum += s->*member;
  return sum / static_cast<double>(scores.size());
}

}  // namespace

std::string lobes_plot(const ExperimentRow& row) {
  if (successes(row).empty()) return "";
  const std::vector<Brdf> truth = five_materials_truth();
  std::vector<Band> bands;
  double most = 0.0, peak = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    bands.push_back(deviation(row, truth, k));
    for (const auto& [x, y] : bands[k].low) most = std::max(most, std::abs(y));
    for (const auto& [x, y] : bands[k].high) most = std::max(most, std::abs(y));
    peak = std::max(peak, in_plane(truth[k], 0.0));
  }
  const double reach = 0.1 * std::ceil(11.0 * most);
  const Panel lobes{18, 250, 0, kMostOff_degrees, 0, 2.0 * std::ceil(0.55 * peak)}, off{286, 470, 0, kMostOff_degrees, -reach, reach};
  std::string svg = open_svg(510) + horizontal_rules(lobes, 2.0, 0) + horizontal_rules(off, reach / 2.0, 2) + angle_axis(off);
  for (std::size_t k = 0; k < truth.size(); ++k) {
    Curve curve;
    for (const auto& [angle, unused] : bands[k].low) curve.emplace_back(angle, in_plane(truth[k], angle));
    svg += line(lobes, curve, kColours[k]) + band(off, bands[k].low, bands[k].high, kColours[k]) + line(off, bands[k].middle, kColours[k]);
    const double exponent = std::exp(truth[k].lobes[0][0].log_shape);
    svg += text(kWidth_px - kRight_px + 10, 60.0 + 20.0 * static_cast<double>(truth.size() - k), "start", formatted("N = %.1f", exponent), kColours[k]);
  }
  svg += side_title(lobes, "f, red, 1/sr") + side_title(off, "recovered less true, %");
  return svg + text(0.5 * (kLeft_px + kWidth_px - kRight_px), 504, "middle", "angle off the mirror direction, light at 45°") + "</svg>";
}

std::string bounds_plot(const ExperimentRow& row) {
  const auto scores = successes(row);
  if (scores.empty()) return "";
  const Panel p{18, 230, -0.7, 19.7, 0.0, 2.0};
  std::string svg = open_svg(270) + horizontal_rules(p, 0.5, 1) + goal_rule(p);
  for (std::size_t k = 0; k < 5; ++k) {
    std::vector<double> exponent;
    for (const FiveMaterialsScore* s : scores) exponent.push_back(s->log_exponent_error[k]);
    svg += bound_mark(p, static_cast<double>(k), exponent, kColours[k], formatted("N%zu", k + 1));
    for (std::size_t c = 0; c < 3; ++c) {
      std::vector<double> diffuse;
      for (const FiveMaterialsScore* s : scores) diffuse.push_back(s->diffuse_error[k][c]);
      svg += bound_mark(p, 5.0 + 3.0 * static_cast<double>(k) + static_cast<double>(c), diffuse, kColours[k], formatted("kd%zu%c", k + 1, "rgb"[c]));
    }
  }
  return svg + side_title(p, "rms error over bound") + "</svg>";
}

std::string labels_plot(const std::vector<ExperimentRow>& rows) {
  double low = 1.0, high = 0.0;
  for (const ExperimentRow& row : rows) {
    for (const FiveMaterialsScore* s : successes(row)) {
      low = std::min(low, s->accuracy);
      high = std::max({high, s->bayes_accuracy, s->accuracy});
    }
  }
  if (low > high) return "";
  const double height = 60.0 + 56.0 * static_cast<double>(rows.size());
  const Panel p{18, height - 40, std::floor(50.0 * low) / 50.0, std::ceil(50.0 * high) / 50.0, 0, static_cast<double>(rows.size())};
  std::string svg = open_svg(height);
  for (int i = 0; i <= std::lround((p.high_x - p.low_x) * 50.0); ++i) {
    const double value = p.low_x + 0.02 * i;
    svg += formatted("<path d=\"M%.1f %.0f V%.0f\" stroke=\"#d9dde2\"/>\n", p.x(value), p.top_px, p.bottom_px) +
           text(p.x(value), p.bottom_px + 18, "middle", formatted("%.2f", value));
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto scores = successes(rows[r]);
    const double y = p.y(static_cast<double>(rows.size() - r) - 0.5);
    svg += text(kLeft_px + 6, y - 14, "start", rows[r].name);
    if (scores.empty()) continue;
    for (const FiveMaterialsScore* s : scores) {
      svg += formatted("<path d=\"M%.1f %.1f v12\" stroke=\"%s\" stroke-opacity=\"0.3\"/>", p.x(s->accuracy), y - 6, kColours[0]);
    }
    svg += formatted("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"5\" fill=\"%s\"/>", p.x(mean_of(scores, &FiveMaterialsScore::accuracy)), y, kColours[0]);
    svg += formatted("<path d=\"M%.1f %.1f v20\" stroke=\"%s\" stroke-width=\"3\"/>", p.x(mean_of(scores, &FiveMaterialsScore::normal_accuracy)),
                     y - 10, kColours[2]);
    svg += formatted("<path d=\"M%.1f %.1f v20\" stroke=\"#1d2126\" stroke-width=\"3\"/>\n", p.x(mean_of(scores, &FiveMaterialsScore::bayes_accuracy)),
                     y - 10);
  }
  return svg + text(0.5 * (kLeft_px + kWidth_px - kRight_px), height - 4, "middle", "share of lumitexels labelled rightly") + "</svg>";
}

}  // namespace lumitexel
