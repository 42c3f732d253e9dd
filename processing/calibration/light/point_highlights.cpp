#include "processing/calibration/light/point_highlights.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>

#include "processing/calibration/light/highlight_assignment.h"

namespace lumitexel {
namespace {

bool some_sphere_has_two(const SeenInView& seen) {
  std::set<int> spheres;
  return std::any_of(seen.begin(), seen.end(), [&](const SeenHighlight& h) { return !spheres.insert(h.sphere).second; });
}

std::vector<HighlightPixel> fitted(const SeenInView& seen) {
  std::vector<HighlightPixel> pixels;
  for (const SeenHighlight& highlight : seen) {
    if (highlight.fit) pixels.push_back(highlight_pixel_of(highlight.sphere, *highlight.fit));
  }
  return pixels;
}

// Those of `seen` that the assignment took for one light.
SeenInView members(const SeenInView& seen, const std::vector<HighlightPixel>& chosen) {
  SeenInView result;
  for (const SeenHighlight& highlight : seen) {
    const bool taken = highlight.fit && std::any_of(chosen.begin(), chosen.end(), [&](const HighlightPixel& pixel) {
      return pixel.sphere == highlight.sphere && pixel.pixel == highlight.fit->pixel;
    });
    if (taken) result.push_back(highlight);
  }
  return result;
}

// Highlights of no assigned light, at most one a sphere, where a light at `expected` or within its reach would have one.
SeenInView near_expected(const CameraModel& camera, const SphereLine& line, const SeenInView& seen,
                         const std::vector<HighlightPixel>& left_over, const Eigen::Vector3d& expected, double reach_m) {
  SeenInView result;
  const Eigen::Vector3d aside = reach_m * expected.unitOrthogonal();
  for (int k = 0; k < line.count; ++k) {
    const Eigen::Vector2d place = highlight_pixel(camera, line.sphere(k), expected);
    double nearest = (highlight_pixel(camera, line.sphere(k), expected + aside) - place).norm();
    std::optional<SeenHighlight> best;
    for (const SeenHighlight& highlight : members(seen, left_over)) {
      const double distance = (highlight.fit->pixel - place).norm();
      if (highlight.sphere != k || !(distance < nearest)) continue;
      nearest = distance;
      best = highlight;
    }
    if (best) result.push_back(*best);
  }
  return result;
}

bool has_close_rival(const SeenHighlight& one, const SeenInView& seen) {
  return std::any_of(seen.begin(), seen.end(), [&](const SeenHighlight& other) {
    const double distance = (one.blob.pixel - other.blob.pixel).norm();
    return other.sphere == one.sphere && distance > 0.0 && distance < kHighlightReach_px;
  });
}

SeenInView without_close_rivals(const SeenInView& seen) {
  SeenInView result;
  for (const SeenHighlight& highlight : seen) {
    if (!has_close_rival(highlight, seen)) result.push_back(highlight);
  }
  return result;
}

// What a disc of the lamp's size does not fit may be a point's, of another light.
void fit_rest_as_points(const PictureOf& picture, const ShapeOf& as_point, std::vector<SeenInView>& all) {
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t v) {
    SeenInView rest;
    std::copy_if(all[v].begin(), all[v].end(), std::back_inserter(rest), [](const SeenHighlight& seen) { return !seen.fit; });
    if (rest.empty()) return;
    fit_highlights(picture(v), v, std::nullopt, as_point, rest);
    auto fitted = rest.begin();
    for (SeenHighlight& seen : all[v]) {
      if (!seen.fit) seen = *fitted++;
    }
  });
}

// Each with its own colours: a stray's are not the lamp's.
void refit_strays_as_points(const PictureOf& picture, const ShapeOf& as_point, std::vector<std::vector<SeenInView>>& strays) {
  tbb::parallel_for(std::size_t{0}, strays.size(), [&](std::size_t v) {
    if (strays[v].empty()) return;
    const MosaicRadiance image = picture(v);
    for (SeenInView& stray : strays[v]) fit_highlights(image, v, std::nullopt, as_point, stray);
  });
}

}  // namespace

HighlightShape lamp_shape(const SphereInView& view, const Eigen::Vector3d& light, const EmitterDisc& lamp) {
  HighlightShape shape{.sphere = view};
  if (!(lamp.radius_m > 0.0)) return shape;
  const Eigen::Vector2d centre = disc_highlight_pixel(view.camera, view.sphere, light, lamp);
  for (const EmitterImage& image : emitter_images(view.camera, view.sphere, places_on_disc(light, lamp))) {
    const auto offset = across_centre(view, centre, (image.point - view.sphere.centre).normalized());
    if (offset) shape.peaks.push_back({*offset, image.share});
  }
  return shape;
}

SortedHighlights sort_highlights(const CameraModel& camera, const SphereLine& line, const SeenInView& all,
                                 const Eigen::Vector3d& expected, double reach_m) {
  if (!some_sphere_has_two(all)) return {all, {}};
  const SeenInView seen = without_close_rivals(all);
  const HighlightAssignment assignment = assign_highlights(camera, line, fitted(seen));
  std::optional<std::size_t> own;
  double nearest = reach_m;
  for (std::size_t i = 0; i < assignment.lights.size(); ++i) {
    const double distance = (assignment.lights[i].position - expected).norm();
    if (!(distance < nearest)) continue;
    nearest = distance;
    own = i;
  }
  SortedHighlights sorted;
  for (std::size_t i = 0; i < assignment.lights.size(); ++i) {
    const SeenInView light = members(seen, assignment.lights[i].highlights);
    if (i == own) {
      sorted.own = light;
    } else {
      sorted.strays.push_back(light);
    }
  }
  if (!own) sorted.own = near_expected(camera, line, seen, assignment.left_over, expected, reach_m);
  return sorted;
}

PointHighlights read_point_highlights(const PictureOf& picture, const CameraModel& camera,
                                      const SphereLine& line, const ExpectedLights& expected,
                                      const std::function<void()>& step) {
  const ShapeOf on_sphere = [&](std::size_t view, const SeenHighlight& highlight) {
    return lamp_shape({camera, line.sphere(highlight.sphere)}, expected.positions[view], expected.lamp);
  };
  constexpr std::size_t kAll = 10'000;
  const FindIn find = [&](std::size_t, const MosaicRadiance& image) {
    SeenInView seen;
    for (const auto& [sphere, blob] : find_point_highlights(compact_blobs(image, kAll), camera, line)) {
      seen.push_back({sphere, blob, std::nullopt});
    }
    return seen;
  };
  // The disc's places hang on where the lamp stands; other lights stand elsewhere, and nothing says how large they are.
  const ShapeOf as_point = [&](std::size_t, const SeenHighlight& highlight) {
    return HighlightShape{.sphere = SphereInView{camera, line.sphere(highlight.sphere)}};
  };
  std::vector<SeenInView> all = find_highlights(expected.positions.size(), picture, find, on_sphere, step);
  const bool disc = expected.lamp.radius_m > 0.0;
  if (disc) fit_rest_as_points(picture, as_point, all);
  std::vector<SeenInView> own;
  std::vector<std::vector<SeenInView>> strays;
  for (std::size_t v = 0; v < all.size(); ++v) {
    SortedHighlights sorted = sort_highlights(camera, line, all[v], expected.positions[v], expected.reach_m);
    own.push_back(std::move(sorted.own));
    strays.push_back(std::move(sorted.strays));
  }
  if (disc) refit_strays_as_points(picture, as_point, strays);
  PointHighlights result;
  for (const std::vector<SeenInView>& view : strays) {
    std::vector<std::vector<HighlightPixel>>& lights = result.strays.emplace_back();
    for (const SeenInView& stray : view) lights.push_back(fitted(stray));
  }
  refit_highlights(picture, on_sphere, own);
  for (const SeenInView& view : own) result.own.push_back(fitted(view));
  result.seen = std::move(own);
  return result;
}

}  // namespace lumitexel
