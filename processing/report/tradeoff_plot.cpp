#include "processing/report/tradeoff_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "processing/report/html.h"

namespace lumitexel {
namespace {

constexpr double kWidth_px = 960, kHeight_px = 520, kLeft_px = 76, kRight_px = 24, kTop_px = 18, kBottom_px = 56;
constexpr double kLetter_px = 6.6, kLine_px = 14;  // of the 12 px labels
constexpr const char* kFrontColour = "#b4541a";
constexpr const char* kOtherColour = "#2a5d9c";

struct Box {
  double left, top, right, bottom;
  bool meets(const Box& o) const { return left < o.right && o.left < right && top < o.bottom && o.top < bottom; }
};

struct Point {
  std::string name;
  double seconds, error, sigma;  // of CPU time
  bool front;
};

template <typename... Values>
std::string formatted(const char* format, Values... values) {
  char buffer[400];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

// Decadic logarithms of what an axis spans.
struct Range {
  double low = 1e9, high = -1e9;
  void take(double value) {
    low = std::min(low, std::log10(value));
    high = std::max(high, std::log10(value));
  }
  Range with_room(double share) const {
    const double room = share * (high - low) + 0.02;
    return {low - room, high + room};
  }
  double share(double value) const { return std::clamp((std::log10(value) - low) / (high - low), 0.0, 1.0); }
  double least() const { return std::pow(10.0, low); }
  double most() const { return std::pow(10.0, high); }
};

struct Axes {
  Range seconds, error;
  double x(double value) const { return kLeft_px + seconds.share(value) * (kWidth_px - kLeft_px - kRight_px); }
  double y(double value) const { return kHeight_px - kBottom_px - error.share(value) * (kHeight_px - kTop_px - kBottom_px); }
};

std::vector<Point> points_of(const Tradeoff& tradeoff) {
  const std::vector<bool> front = pareto_front(tradeoff.measurements);
  std::vector<Point> points;
  for (std::size_t i = 0; i < front.size(); ++i) {
    const TradeoffMeasurement& m = tradeoff.measurements[i];
    if (!m.measured() || !std::isfinite(m.clipped.value) || m.clipped.value <= 0.0 || m.cpu_seconds <= 0.0) continue;
    points.push_back({m.setting.name, m.cpu_seconds, m.clipped.value, std::isfinite(m.clipped.sigma) ? m.clipped.sigma : 0.0, front[i]});
  }
  return points;
}

// Both logarithmic: the paper's method may err three times as much as all others, which should not make those one heap.
Axes axes_of(const std::vector<Point>& points) {
  constexpr double kDeepestBar = 0.5;  // of the error: a bar to zero has no end on such an axis
  Axes axes;
  for (const Point& point : points) {
    axes.seconds.take(point.seconds);
    axes.error.take(std::max(point.error - point.sigma, kDeepestBar * point.error));
    axes.error.take(point.error + point.sigma);
  }
  return {axes.seconds.with_room(0.08), axes.error.with_room(0.06)};
}

double round_step(double range) {
  const double rough = range / 6.0, decade = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * decade >= rough) return digit * decade;
  }
  return 10.0 * decade;
}

// 1, 2, 5 times powers of ten that lie on the axis; where those would be fewer than three, equal round steps.
std::vector<double> ticks_of(const Range& range) {
  std::vector<double> ticks;
  for (double decade = std::pow(10.0, std::floor(range.low)); decade <= range.most(); decade *= 10.0) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      if (digit * decade >= range.least() && digit * decade <= range.most()) ticks.push_back(digit * decade);
    }
  }
  if (ticks.size() >= 3) return ticks;
  ticks.clear();
  const double step = round_step(range.most() - range.least());
  for (double k = std::ceil(range.least() / step); k * step <= range.most(); k += 1.0) ticks.push_back(k * step);
  return ticks;
}

std::string grid(const Axes& axes) {
  std::string svg;
  for (const double error : ticks_of(axes.error)) {
    svg += formatted("<path d=\"M%.0f %.1f H%.0f\" stroke=\"#d9dde2\"/><text x=\"%.0f\" y=\"%.1f\" text-anchor=\"end\">%.4g</text>\n", kLeft_px,
                     axes.y(error), kWidth_px - kRight_px, kLeft_px - 8, axes.y(error) + 4, error);
  }
  for (const double seconds : ticks_of(axes.seconds)) {
    svg += formatted("<path d=\"M%.1f %.0f V%.0f\" stroke=\"#d9dde2\"/><text x=\"%.1f\" y=\"%.0f\" text-anchor=\"middle\">%g</text>\n",
                     axes.x(seconds), kTop_px, kHeight_px - kBottom_px, axes.x(seconds), kHeight_px - kBottom_px + 18, seconds);
  }
  svg += formatted("<text x=\"%.0f\" y=\"%.0f\" text-anchor=\"middle\">CPU seconds of the fit (logarithmic)</text>", 0.5 * (kLeft_px + kWidth_px),
                   kHeight_px - 12);
  return svg + formatted("<text transform=\"translate(18 %.0f) rotate(-90)\" text-anchor=\"middle\">clipped error on held-out "
                         "photographs (logarithmic)</text>\n",
                         0.5 * (kHeight_px - kBottom_px));
}

// From the fastest to the slowest.
std::vector<Point> front_of(std::vector<Point> points) {
  std::erase_if(points, [](const Point& point) { return !point.front; });
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.seconds < b.seconds; });
  return points;
}

std::string front_steps(const Axes& axes, const std::vector<Point>& points) {
  if (points.empty()) return "";
  std::string path = formatted("M%.1f %.0f V%.1f", axes.x(points.front().seconds), kTop_px, axes.y(points.front().error));
  for (const Point& point : points) path += formatted(" H%.1f V%.1f", axes.x(point.seconds), axes.y(point.error));
  path += formatted(" H%.0f", kWidth_px - kRight_px);
  return "<path d=\"" + path + "\" fill=\"none\" stroke=\"" + kFrontColour + "\" stroke-width=\"2\" stroke-opacity=\"0.6\"/>\n";
}

// The strips that the steps cover, for labels to keep out of.
std::vector<Box> step_boxes(const Axes& axes, const std::vector<Point>& front) {
  std::vector<Box> boxes;
  double above = kTop_px;
  for (std::size_t i = 0; i < front.size(); ++i) {
    const double x = axes.x(front[i].seconds), y = axes.y(front[i].error);
    const double next = i + 1 < front.size() ? axes.x(front[i + 1].seconds) : kWidth_px - kRight_px;
    boxes.push_back({x - 1, above, x + 1, y});
    boxes.push_back({x, y - 1, next, y + 1});
    above = y;
  }
  return boxes;
}

Box label_box(double x, double y, std::size_t letters, bool right) {
  const double width = kLetter_px * static_cast<double>(letters);
  return right ? Box{x, y - kLine_px, x + width, y + 3} : Box{x - width, y - kLine_px, x, y + 3};
}

// Beside the point, on the first side and height that is inside the drawing and free of points and other labels. Only what is on the front is
// named from further away: a name that stands nearer to another point than to its own misleads.
std::string label(const Axes& axes, const Point& point, std::vector<Box>& taken) {
  constexpr double kNear_px = 22.0;
  for (const double down : {4.0, -8.0, 17.0, -22.0, 31.0, -36.0, 45.0, -50.0, 59.0}) {
    if (!point.front && std::abs(down) > kNear_px) break;
    for (const bool right : {true, false}) {
      const double x = axes.x(point.seconds) + (right ? 9.0 : -9.0), y = axes.y(point.error) + down;
      const Box box = label_box(x, y, point.name.size(), right);
      const bool inside = box.left > kLeft_px && box.right < kWidth_px && box.top > 0.0 && box.bottom < kHeight_px - kBottom_px;
      const bool free = std::none_of(taken.begin(), taken.end(), [&](const Box& other) { return box.meets(other); });
      if (!inside || !free) continue;
      taken.push_back(box);
      return formatted("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" style=\"fill:%s\">", x, y, right ? "start" : "end",
                       point.front ? kFrontColour : kOtherColour) + html::escaped(point.name) + "</text>\n";
    }
  }
  return "";  // crowded out; the point's own title still names it
}

std::string mark(const Axes& axes, const Point& point) {
  const char* colour = point.front ? kFrontColour : kOtherColour;
  const double x = axes.x(point.seconds);
  std::string svg = formatted("<path d=\"M%.1f %.1f V%.1f\" stroke=\"%s\" stroke-opacity=\"0.35\"/>", x, axes.y(point.error + point.sigma),
                              axes.y(std::max(point.error - point.sigma, axes.error.least())), colour);
  svg += formatted("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"5\" fill=\"%s\"><title>", x, axes.y(point.error), colour);
  return svg + html::escaped(point.name) + ": " + html::number(point.error) + " in " + html::number(point.seconds) + " s</title></circle>\n";
}

}  // namespace

std::string tradeoff_plot(const Tradeoff& tradeoff) {
  const std::vector<Point> points = points_of(tradeoff);
  if (points.empty()) return "";
  const Axes axes = axes_of(points);
  std::string svg = formatted("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" role=\"img\">\n", kWidth_px, kHeight_px);
  const std::vector<Point> front = front_of(points);
  svg += grid(axes) + front_steps(axes, front);
  std::vector<Box> taken = step_boxes(axes, front);
  for (const Point& point : points) {
    svg += mark(axes, point);
    const double x = axes.x(point.seconds), y = axes.y(point.error);
    taken.push_back({x - 6, y - 6, x + 6, y + 6});
  }
  for (const Point& point : front) svg += label(axes, point, taken);
  for (const Point& point : points) svg += point.front ? "" : label(axes, point, taken);
  return svg + "</svg>";
}

}  // namespace lumitexel
