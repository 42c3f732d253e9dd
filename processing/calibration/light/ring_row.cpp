#include "processing/calibration/light/ring_row.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "drivers/error.h"
#include "processing/calibration/light/light_position.h"
#include "processing/calibration/light/sphere_row.h"

namespace lumitexel {
namespace {

constexpr std::size_t kMostBlobs = 80;  // the search for the row grows with the cube
constexpr double kStandsElsewherePx = 1.5;
constexpr double kFitsTheLinePx = 0.2;  // ten times what a fitted highlight scatters, a tenth of what the search allows

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
      const HighlightPixel seen = highlight_pixel_of(sphere, *highlight.fit);
      xs.push_back(seen.pixel.x());
      ys.push_back(seen.pixel.y());
      sigmas.push_back(seen.sigma_px);
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
  return HighlightPixel{sphere, sum / count, sigma_sum / count};
}

std::vector<HighlightPixel> pooled_rings(const std::vector<SeenInView>& views, int places) {
  std::vector<HighlightPixel> rings;
  for (int k = 0; k < places; ++k) {
    if (const auto highlight = pooled(views, k)) rings.push_back(*highlight);
  }
  return rings;
}

SphereLine line_through(const CameraModel& camera, const std::vector<HighlightPixel>& rings,
                        const SphereLineDescription& spheres) {
  std::vector<Eigen::Vector3d> rays;
  std::vector<int> places;
  for (const HighlightPixel& ring : rings) {
    rays.push_back(camera.unproject(ring.pixel));
    places.push_back(ring.sphere);
  }
  return sphere_line_from_rays(rays, places, spheres.spacing_m, spheres.radius_m);
}

// How well fitted highlights agree with some line of the rig's spheres.
struct Agreement {
  int members = 0;
  double rms_px = 0;
};

Agreement agreement(const std::vector<HighlightPixel>& rings, const CameraModel& camera, const RigDescription& rig) {
  Agreement result;
  try {
    const double ring_m = rig.ring_flash.radius_m;
    const SphereLine line = solve_lights(camera, line_through(camera, rings, rig.spheres), ring_m, rings, {}).line;
    for (const HighlightPixel& ring : rings) {
      const double off = (ring_highlight_pixel(camera, line.sphere(ring.sphere), ring_m) - ring.pixel).norm();
      if (!(off < kFitsTheLinePx)) continue;
      ++result.members;
      result.rms_px += off * off;
    }
    result.rms_px = result.members > 0 ? std::sqrt(result.rms_px / result.members) : 0.0;
  } catch (const BadInput&) {  // no line of spheres looks like this
  }
  return result;
}

using Blobs = std::vector<Blob>;

std::optional<Blob> blob_at(const Blobs& blobs, const Eigen::Vector2d& pixel) {
  for (const Blob& blob : blobs) {
    if ((blob.pixel - pixel).norm() < kStandsElsewherePx) return blob;
  }
  return std::nullopt;
}

SeenInView members_in(const Blobs& blobs, const PartialRow& row) {
  SeenInView seen;
  for (const auto& [place, blob] : row.members) {
    if (const auto here = blob_at(blobs, blob.pixel)) seen.push_back({place, *here, std::nullopt});
  }
  return seen;
}

struct VerifiedRow {
  PartialRow row;
  int views = 0;  // in which enough of its members are seen
  Agreement agreement;

  auto rank() const { return std::tuple(views, agreement.members, -agreement.rms_px); }
};

VerifiedRow verified(const PartialRow& row, std::size_t v, const MosaicRadiance& image, const std::vector<Blobs>& blobs,
                     const CameraModel& camera, const RigDescription& rig) {
  VerifiedRow result{row, 0, {}};
  SeenInView seen = members_in(blobs[v], row);
  fit_highlights(image, v, std::nullopt, [](std::size_t, const SeenHighlight&) { return HighlightShape{}; }, seen);
  std::vector<HighlightPixel> rings;
  for (const SeenHighlight& highlight : seen) {
    if (highlight.fit) rings.push_back(highlight_pixel_of(highlight.sphere, *highlight.fit));
  }
  const int least = least_of_row(rig.spheres.count);
  if (static_cast<int>(rings.size()) < least) return result;
  result.agreement = agreement(rings, camera, rig);
  for (const Blobs& view : blobs) result.views += static_cast<int>(members_in(view, row).size()) >= least;
  return result;
}

std::optional<VerifiedRow> best_of_view(const std::vector<PartialRow>& rows, std::size_t v, const MosaicRadiance& image,
                                        const std::vector<Blobs>& blobs, const CameraModel& camera, const RigDescription& rig) {
  std::optional<VerifiedRow> best;
  for (const PartialRow& row : rows) {
    const VerifiedRow candidate = verified(row, v, image, blobs, camera, rig);
    const bool agrees = candidate.agreement.members >= least_of_row(rig.spheres.count);
    if (agrees && (!best || candidate.rank() > best->rank())) best = candidate;
  }
  return best;
}

// The best row of some of the spheres, in every view where its members are seen.
std::vector<SeenInView> partial_rows(const PictureOf& picture, const std::vector<Blobs>& blobs,
                                     const CameraModel& camera, const RigDescription& rig) {
  constexpr std::size_t kMostRows = 12;  // a view
  const int least = least_of_row(rig.spheres.count);
  std::vector<std::optional<VerifiedRow>> best(blobs.size());
  tbb::parallel_for(std::size_t{0}, blobs.size(), [&](std::size_t v) {
    const std::vector<PartialRow> rows = find_partial_rows(blobs[v], camera, rig.spheres.count, kMostRows);
    if (rows.empty()) return;
    best[v] = best_of_view(rows, v, picture(v), blobs, camera, rig);
  });
  const auto chosen = std::max_element(best.begin(), best.end(), [](const auto& a, const auto& b) {
    return b && (!a || a->rank() < b->rank());
  });
  if (chosen == best.end() || !*chosen) {
    throw Error("sphere shots: no view shows a straight row of " + std::to_string(rig.spheres.count) +
                " ring-flash highlights, nor " + std::to_string(least) +
                " of them whose gaps tell which they are; so many spheres must be in the picture with nothing before them");
  }
  std::vector<SeenInView> seen;
  for (const Blobs& view : blobs) seen.push_back(members_in(view, (*chosen)->row));
  return seen;
}

}  // namespace

RingRow read_ring_row(std::size_t views, const PictureOf& picture, const CameraModel& camera,
                      const RigDescription& rig, const std::function<void()>& step) {
  const int spheres = rig.spheres.count;
  const ShapeOf single = [](std::size_t, const SeenHighlight&) { return HighlightShape{}; };
  std::vector<Blobs> blobs(views);
  const FindIn find = [&](std::size_t v, const MosaicRadiance& image) {
    blobs[v] = compact_blobs(image, kMostBlobs);
    SeenInView seen;
    const auto row = find_sphere_row(blobs[v], camera, spheres);
    for (int k = 0; row && k < spheres; ++k) seen.push_back({k, (*row)[static_cast<std::size_t>(k)], std::nullopt});
    return seen;
  };
  // Single peaks first, to know the line well enough for the ring's shape on each sphere.
  auto seen = find_highlights(views, picture, find, single, step);
  if (static_cast<int>(pooled_rings(seen, spheres).size()) < spheres) {
    seen = partial_rows(picture, blobs, camera, rig);
    tbb::parallel_for(std::size_t{0}, views, [&](std::size_t v) {
      if (!seen[v].empty()) fit_highlights(picture(v), v, std::nullopt, single, seen[v]);
    });
  }
  const SphereLine line = line_through(camera, pooled_rings(seen, spheres), rig.spheres);
  const ShapeOf ring = [&](std::size_t, const SeenHighlight& highlight) {
    HighlightShape shape;
    const std::vector<EmitterImage> images = ring_images(camera, line.sphere(highlight.sphere), rig.ring_flash.radius_m);
    const Eigen::Vector2d centre = centroid(images);
    for (const EmitterImage& image : images) {
      shape.peaks.push_back({image.pixel - centre, image.share});
    }
    return shape;
  };
  refit_highlights(picture, ring, seen);
  RingRow row;
  row.rings = pooled_rings(seen, spheres);
  row.line = line_through(camera, row.rings, rig.spheres);
  return row;
}

}  // namespace lumitexel
