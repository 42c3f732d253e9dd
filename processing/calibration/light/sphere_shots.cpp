#include "processing/calibration/light/sphere_shots.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <optional>

#include "drivers/error.h"
#include "processing/calibration/light/sphere_highlights.h"
#include "processing/image/hdr_merge.h"

namespace lumitexel {
namespace {

constexpr std::size_t kMostBlobs = 80;  // the search for the row grows with the cube
constexpr int kReachPx = 8;             // of a fit's window about the blob
// What a fit cannot know of itself: profile and pixel response differ from the model's, and the spheres stand still, so
// this does not average out.
constexpr double kSystematicPx = 0.01;
constexpr double kStandsElsewherePx = 1.5;

struct SeenHighlight {
  int sphere = 0;
  Blob blob;
  std::optional<FittedHighlight> fit;
};
using SeenInView = std::vector<SeenHighlight>;

using ShapeOn = std::function<HighlightShape(int sphere)>;

void fit_all(const MosaicRadiance& image, const std::optional<ColourBalance>& balance, const ShapeOn& shape,
             SeenInView& seen) {
  for (SeenHighlight& highlight : seen) {
    highlight.fit = fit_highlight(image, highlight.blob.pixel, kReachPx, balance, shape(highlight.sphere));
  }
}

using RecordOf = std::function<const FrameRecord&(std::size_t view)>;
using Find = std::function<SeenInView(const MosaicRadiance&)>;

// Finds highlights in every view's shot and fits them with free colours.
std::vector<SeenInView> find_highlights(std::size_t views, const RadianceReader& reader, const RecordOf& record,
                                        const Find& find, const ShapeOn& shape, const std::function<void()>& step) {
  std::vector<SeenInView> seen(views);
  tbb::parallel_for(std::size_t{0}, views, [&](std::size_t v) {
    const MosaicRadiance image = reader.read(record(v));
    seen[v] = find(image);
    fit_all(image, std::nullopt, shape, seen[v]);
    step();
  });
  return seen;
}

// Fits them again, with the lamp's balance of colours that all of them have in common.
void refit_highlights(const RadianceReader& reader, const RecordOf& record, const ShapeOn& shape,
                      std::vector<SeenInView>& seen) {
  std::vector<FittedHighlight> fits;
  for (const SeenInView& view : seen) {
    for (const SeenHighlight& highlight : view) {
      if (highlight.fit) fits.push_back(*highlight.fit);
    }
  }
  const std::optional<ColourBalance> balance = colour_balance(fits);
  if (!balance) return;
  tbb::parallel_for(std::size_t{0}, seen.size(), [&](std::size_t v) {
    if (!seen[v].empty()) fit_all(reader.read(record(v)), balance, shape, seen[v]);
  });
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The sphere's ring highlight over all views: median, then the mean of those near it.
std::optional<HighlightPixel> pooled(const std::vector<SeenInView>& views, int sphere) {
  std::vector<double> xs, ys, sigmas;
  for (const SeenInView& view : views) {
    for (const SeenHighlight& highlight : view) {
      if (highlight.sphere != sphere || !highlight.fit) continue;
      xs.push_back(highlight.fit->pixel.x());
      ys.push_back(highlight.fit->pixel.y());
      sigmas.push_back(highlight.fit->sigma_px);
    }
  }
  if (xs.empty()) return std::nullopt;
  const Eigen::Vector2d centre(median(xs), median(ys));
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double sigma_sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < xs.size(); ++i) {
    const Eigen::Vector2d pixel(xs[i], ys[i]);
    if ((pixel - centre).norm() > kStandsElsewherePx) continue;
    sum += pixel;
    sigma_sum += sigmas[i];
    ++count;
  }
  // The mean sigma, not divided by sqrt(count): it comes from a profile's misfit, which is the same in every view.
  return HighlightPixel{sphere, sum / count, std::hypot(kSystematicPx, sigma_sum / count)};
}

std::vector<HighlightPixel> ring_highlights(const std::vector<SeenInView>& views, int spheres) {
  std::vector<HighlightPixel> rings;
  for (int k = 0; k < spheres; ++k) {
    if (const auto highlight = pooled(views, k)) rings.push_back(*highlight);
  }
  if (static_cast<int>(rings.size()) < spheres) {
    throw Error("sphere shots: no view shows a straight row of " + std::to_string(spheres) + " ring-flash highlights");
  }
  return rings;
}

std::vector<HighlightPixel> fitted(const SeenInView& view) {
  std::vector<HighlightPixel> points;
  for (const SeenHighlight& highlight : view) {
    if (!highlight.fit) continue;
    points.push_back({highlight.sphere, highlight.fit->pixel, std::hypot(kSystematicPx, highlight.fit->sigma_px)});
  }
  return points;
}

SphereLine first_line(const CameraModel& camera, const std::vector<HighlightPixel>& rings,
                      const SphereLineDescription& spheres) {
  std::vector<Eigen::Vector3d> rays;
  for (const HighlightPixel& ring : rings) rays.push_back(camera.unproject(ring.pixel));
  return sphere_line_from_rays(rays, spheres.spacing_m, spheres.radius_m);
}

SeenInView find_rings(const MosaicRadiance& image, const CameraModel& camera, int spheres) {
  SeenInView seen;
  const auto row = find_sphere_row(compact_blobs(image, kMostBlobs), camera, spheres);
  if (!row) return seen;
  for (const Blob& blob : *row) seen.push_back({static_cast<int>(seen.size()), blob, std::nullopt});
  return seen;
}

SeenInView find_points(const MosaicRadiance& image, const CameraModel& camera, const SphereLine& line) {
  SeenInView seen;
  constexpr std::size_t kAll = 10'000;
  for (const auto& [sphere, blob] : find_point_highlights(compact_blobs(image, kAll), camera, line)) {
    seen.push_back({sphere, blob, std::nullopt});
  }
  return seen;
}

// The ring's reflection about its centroid.
HighlightShape ring_shape(const CameraModel& camera, const MirrorSphere& sphere, double ring_radius_m) {
  HighlightShape shape;
  const Eigen::Vector2d centre = ring_highlight_pixel(camera, sphere, ring_radius_m);
  for (const Eigen::Vector2d& pixel : ring_highlight_pixels(camera, sphere, ring_radius_m)) {
    shape.offsets_px.push_back(pixel - centre);
  }
  return shape;
}

}  // namespace

SphereHighlights read_sphere_highlights(const RadianceReader& reader, const std::vector<SphereShots>& views,
                                        const CameraModel& camera, const RigDescription& rig, Progress& progress) {
  std::atomic<std::int64_t> done{0};
  const auto step = [&] { progress.update(++done); };
  progress.begin("sphere shots", static_cast<std::int64_t>(2 * views.size()), "shots");
  const RecordOf ring = [&](std::size_t v) -> const FrameRecord& { return views[v].ring; };
  const RecordOf point = [&](std::size_t v) -> const FrameRecord& { return views[v].point; };
  const int spheres = rig.spheres.count;
  const double ring_radius_m = rig.ring_flash.radius_m;

  // Single peaks first, to know the line well enough for the ring's shape on each sphere.
  auto ring_views = find_highlights(
      views.size(), reader, ring, [&](const MosaicRadiance& image) { return find_rings(image, camera, spheres); },
      [](int) { return HighlightShape{}; }, step);
  SphereLine line = first_line(camera, ring_highlights(ring_views, spheres), rig.spheres);
  refit_highlights(
      reader, ring, [&](int k) { return ring_shape(camera, line.sphere(k), ring_radius_m); }, ring_views);
  const std::vector<HighlightPixel> rings = ring_highlights(ring_views, spheres);
  line = first_line(camera, rings, rig.spheres);

  const ShapeOn on_sphere = [&](int k) { return HighlightShape{SphereInView{camera, line.sphere(k)}}; };
  auto point_views = find_highlights(
      views.size(), reader, point, [&](const MosaicRadiance& image) { return find_points(image, camera, line); },
      on_sphere, step);
  refit_highlights(reader, point, on_sphere, point_views);
  std::vector<std::vector<HighlightPixel>> points;
  for (const SeenInView& view : point_views) points.push_back(fitted(view));
  return {rings, points, line};
}

LightSolution measure_lights(const SphereHighlights& seen, const CameraModel& camera, const RigDescription& rig,
                             const std::optional<LensMatrix>& lens_covariance) {
  return solve_lights(camera, seen.line, rig.ring_flash.radius_m, seen.rings, seen.points, {}, lens_covariance);
}

}  // namespace lumitexel
