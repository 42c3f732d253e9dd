#include "processing/report/plan_drawing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "processing/report/html.h"

namespace lumitexel {
namespace {

constexpr double kSize_px = 480, kMargin_px = 26;
constexpr const char* kAxisNames = "xyz";

struct Drawing {
  int horizontal, vertical;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double reach_m = 1.0;  // from the centre to the drawing's edge

  Eigen::Vector2d flat(const Eigen::Vector3d& x) const { return {x[horizontal], x[vertical]}; }
  Eigen::Vector2d pixel(const Eigen::Vector2d& point) const {
    const double scale = (0.5 * kSize_px - kMargin_px) / reach_m;
    return {0.5 * kSize_px + scale * (point - centre).x(), 0.5 * kSize_px - scale * (point - centre).y()};
  }
};

std::string xy(const Eigen::Vector2d& pixel) {
  char text[48];
  std::snprintf(text, sizeof text, "%.1f,%.1f ", pixel.x(), pixel.y());
  return text;
}

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

// Andrew's monotone chain.
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  std::vector<Eigen::Vector2d> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const Eigen::Vector2d& point : points) {
      while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 0.0) hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();  // the other side starts with it
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

Eigen::Vector2d light_place(const Drawing& drawing, const Light& light) {
  const Eigen::Vector2d flat = drawing.flat(light.vector_in_world);
  return light.type == Light::Type::Point ? flat : Eigen::Vector2d(drawing.centre + drawing.reach_m * flat);
}

Drawing framed(const CalibratedSession& session, int horizontal, int vertical) {
  Drawing drawing{horizontal, vertical};
  Eigen::Vector3d low = session.mesh.positions.front(), high = low;
  for (const Eigen::Vector3d& position : session.mesh.positions) {
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
  }
  drawing.centre = drawing.flat(0.5 * (low + high));
  double reach_m = 0.5 * (high - low).norm();
  const auto include = [&](const Eigen::Vector3d& x) {
    reach_m = std::max(reach_m, (drawing.flat(x) - drawing.centre).norm());
  };
  for (const View& view : session.views) {
    include(view.camera_in_world());
    if (view.light.type == Light::Type::Point) include(view.light.vector_in_world);
  }
  drawing.reach_m = reach_m;
  return drawing;
}

std::string object_shape(const Drawing& drawing, const Mesh& mesh) {
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector3d& position : mesh.positions) points.push_back(drawing.flat(position));
  std::string text = "<polygon fill=\"#c9ced6\" points=\"";
  for (const Eigen::Vector2d& corner : convex_hull(std::move(points))) text += xy(drawing.pixel(corner));
  return text + "\"><title>the object's outline (convex hull)</title></polygon>\n";
}

// A small triangle whose flat side looks where the camera looks.
std::string camera_shape(const Drawing& drawing, const View& view) {
  const Eigen::Vector2d at = drawing.pixel(drawing.flat(view.camera_in_world()));
  const Eigen::Vector2d looking = drawing.flat(view.camera_from_world.inverse().linear().col(2));
  // Pixels run down. A camera that looks along the line of sight of this drawing is drawn looking up.
  const Eigen::Vector2d ahead =
      looking.norm() > 1e-6 ? Eigen::Vector2d(looking.x(), -looking.y()).normalized() : Eigen::Vector2d(0.0, -1.0);
  const Eigen::Vector2d aside(-ahead.y(), ahead.x());
  return "<polygon fill=\"" + std::string(view.heldout ? kHeldoutColour : kFitColour) + "\" points=\"" + xy(at) +
         xy(at + 11.0 * ahead + 6.0 * aside) + xy(at + 11.0 * ahead - 6.0 * aside) + "\"><title>camera of " +
         html::escaped(view.name) + "</title></polygon>\n";
}

std::string light_shape(const Drawing& drawing, const View& view) {
  const Eigen::Vector2d at = drawing.pixel(light_place(drawing, view.light));
  char circle[160];
  std::snprintf(circle, sizeof circle,
                "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4.5\" fill=\"#fff3c4\" stroke=\"%s\" stroke-width=\"1.8\">",
                at.x(), at.y(), view.heldout ? kHeldoutColour : kFitColour);
  return circle + std::string("<title>light of ") + html::escaped(view.name) + "</title></circle>\n";
}

std::string scale_bar(const Drawing& drawing) {
  const double length_m = std::pow(10.0, std::floor(std::log10(drawing.reach_m)));
  const double length_px = length_m * (0.5 * kSize_px - kMargin_px) / drawing.reach_m;
  char text[320];
  std::snprintf(
      text, sizeof text,
      "<path d=\"M12 %.0f h%.1f\" stroke=\"#5c6672\" stroke-width=\"2\"/><text x=\"12\" y=\"%.0f\">%g m</text>"
      "<text x=\"%.0f\" y=\"%.0f\" text-anchor=\"end\">%c to the right, %c up</text>\n",
      kSize_px - 12, length_px, kSize_px - 18, length_m, kSize_px - 12, kSize_px - 12, kAxisNames[drawing.horizontal],
      kAxisNames[drawing.vertical]);
  return text;
}

}  // namespace

std::string plan_drawing(const CalibratedSession& session, int horizontal, int vertical) {
  const Drawing drawing = framed(session, horizontal, vertical);
  char head[160];
  std::snprintf(
      head, sizeof head,
      "<svg viewBox=\"0 0 %.0f %.0f\" role=\"img\"><rect width=\"100%%\" height=\"100%%\" fill=\"#f5f6f8\"/>\n",
      kSize_px, kSize_px);
  std::string text = head + object_shape(drawing, session.mesh);
  for (const View& view : session.views) text += camera_shape(drawing, view);
  for (const View& view : session.views) text += light_shape(drawing, view);
  return text + scale_bar(drawing) + "</svg>";
}

}  // namespace lumitexel
