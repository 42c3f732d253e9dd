#include "processing/calibration/light/point_widths.h"

#include <tbb/parallel_for.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "processing/calibration/light/median.h"

namespace lumitexel {
namespace {

HighlightShape ring_shape(const SphereInView& view, double radius_m) {
  HighlightShape shape{.sphere = view};
  const std::vector<EmitterImage> images = ring_images(view.camera, view.sphere, radius_m);
  const Eigen::Vector2d centre = centroid(images);
  for (const EmitterImage& image : images) {
    const auto offset = across_centre(view, centre, (image.point - view.sphere.centre).normalized());
    if (offset) shape.peaks.push_back({*offset, image.share});
  }
  return shape;
}

using RingFits = std::vector<std::pair<int, FittedHighlight>>;

RingFits fit_rings(const std::vector<MosaicRadiance>& pictures, const CameraModel& camera, const SphereLine& line,
                   const std::vector<HighlightPixel>& rings, double ring_radius_m, const std::optional<double>& exponent) {
  std::vector<std::optional<FittedHighlight>> fits(pictures.size() * rings.size());
  tbb::parallel_for(std::size_t{0}, fits.size(), [&](std::size_t i) {
    const HighlightPixel& ring = rings[i % rings.size()];
    HighlightShape shape = ring_shape({camera, line.sphere(ring.sphere)}, ring_radius_m);
    shape.exponent = exponent;
    fits[i] = fit_highlight(pictures[i / rings.size()], ring.pixel, kHighlightReach_px, std::nullopt, shape);
  });
  RingFits found;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (fits[i]) found.emplace_back(rings[i % rings.size()].sphere, *fits[i]);
  }
  return found;
}

}  // namespace

std::vector<std::size_t> spread_views(std::size_t views, const std::function<bool(std::size_t)>& usable) {
  std::vector<std::size_t> all, chosen;
  for (std::size_t v = 0; v < views; ++v) {
    if (usable(v)) all.push_back(v);
  }
  constexpr std::size_t kMost = 4;
  const std::size_t count = std::min(all.size(), kMost);
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(all[i * all.size() / count]);
  return chosen;
}

double mean_square_along(const Eigen::Vector2d& u, const std::vector<HighlightPeak>& peaks) {
  double sum = 0.0, shares = 0.0;
  for (const HighlightPeak& peak : peaks) {
    sum += peak.share * std::pow(peak.offset_px.dot(u), 2);
    shares += peak.share;
  }
  return peaks.empty() ? 0.0 : sum / shares;
}

PointWidths measure_point_widths(std::size_t views, const PictureOf& ring, const CameraModel& camera, const SphereLine& line,
                                 const std::vector<HighlightPixel>& rings, double ring_radius_m) {
  PointWidths widths;
  widths.log_square.assign(static_cast<std::size_t>(line.count), std::numeric_limits<double>::quiet_NaN());
  std::vector<MosaicRadiance> pictures;
  for (const std::size_t v : spread_views(views, [](std::size_t) { return true; })) pictures.push_back(ring(v));
  const RingFits free = fit_rings({pictures.front()}, camera, line, rings, ring_radius_m, std::nullopt);
  if (free.empty()) return widths;
  std::vector<double> exponents;
  for (const auto& fit : free) exponents.push_back(fit.second.exponent);
  constexpr double kLeast = 1.05, kMost = 15.9;  // what fit_highlight can hold
  widths.exponent = std::clamp(median(exponents), kLeast, kMost);
  const RingFits held = fit_rings(pictures, camera, line, rings, ring_radius_m, widths.exponent);
  for (int k = 0; k < line.count; ++k) {
    const SphereInView view{camera, line.sphere(k)};
    std::vector<double> logs;
    for (const auto& [sphere, fit] : held) {
      // Near the middle of its sphere there is hardly a slope: both directions count.
      if (sphere == k) logs.push_back(0.5 * std::log(fit.spread_px2.determinant()));
    }
    if (logs.empty()) continue;
    widths.log_square[static_cast<std::size_t>(k)] = median(logs);
    const std::vector<HighlightPeak> peaks = ring_shape(view, ring_radius_m).peaks;
    const double square = 0.5 * (mean_square_along(Eigen::Vector2d::UnitX(), peaks) + mean_square_along(Eigen::Vector2d::UnitY(), peaks));
    widths.ring_part += square / std::exp(widths.log_square[static_cast<std::size_t>(k)]) / line.count;
  }
  return widths;
}

}  // namespace lumitexel
