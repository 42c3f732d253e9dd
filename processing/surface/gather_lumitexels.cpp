#include "processing/surface/gather_lumitexels.h"

#include <oneapi/tbb/parallel_for.h>

#include <cmath>

#include "drivers/error.h"
#include "processing/surface/view_geometry.h"

namespace lumitexel {
namespace {

struct Site {  // of one lumitexel
  std::uint32_t texel;
  SurfacePoint point;
};

using Verdict = SampleVerdict;

struct ViewSamples {  // of one view, for every site
  std::vector<Verdict> verdict;
  std::vector<float> reflectance, variance;  // sites * channels
};

// One site for every pixel of the view whose triangle has its best image here, and its lumitexels at pixels.
void collect_sites(const ViewGeometry& geometry, const Atlas& atlas, const Mesh& mesh, int view,
                   std::vector<Site>& sites) {
  for (int y = 0; y < geometry.height; ++y) {
    for (int x = 0; x < geometry.width; ++x) {
      const std::size_t i = geometry.index(x, y);
      const std::uint32_t triangle = geometry.triangle[i];
      if (triangle == ViewGeometry::kNoTriangle) continue;
      const int patch_index = atlas.patch_of_triangle[triangle];
      if (patch_index < 0 || atlas.at_texel[triangle] != 0) continue;
      const AtlasPatch& patch = atlas.patches[static_cast<std::size_t>(patch_index)];
      if (patch.view != view) continue;
      const int texel = (y + patch.shift_y) * atlas.width + x + patch.shift_x;
      sites.push_back({static_cast<std::uint32_t>(texel),
                       surface_point(mesh, triangle, static_cast<double>(geometry.u[i]), static_cast<double>(geometry.v[i]))});
    }
  }
}

// The up to four pixels whose centres surround a position, with bilinear weights. A position on a pixel's centre (as in the best
// view) uses that pixel alone.
struct Footprint {
  int x = 0, y = 0;
  double right = 0, down = 0;  // weights of the right column and the lower row
};

Footprint footprint_at(const Eigen::Vector2d& pixel, const CameraModel& camera) {
  constexpr double kOnCentre = 1e-3;  // of a pixel; what rounding of the traced surface point leaves
  Footprint foot;
  const auto split = [](double position, int size, int& cell, double& weight) {
    const double clamped = std::min(std::max(position - 0.5, 0.0), size - 1.0);
    cell = std::min(static_cast<int>(clamped), size - 2);
    weight = clamped - cell;
    if (weight < kOnCentre) weight = 0.0;
    if (weight > 1.0 - kOnCentre) weight = 1.0;
  };
  split(pixel.x(), camera.width_px, foot.x, foot.right);
  split(pixel.y(), camera.height_px, foot.y, foot.down);
  return foot;
}

struct ViewContext {
  const View& view;
  const ViewGeometry& geometry;
  const RadianceImage& photograph;
  const RayScene& scene;
  Eigen::Vector3d eye;
  int channels;
};

// Reads the photograph; false if any pixel it would use is flagged. Sets `edges` to the geometry's flags there.
bool read_footprint(const ViewContext& context, const Footprint& foot, float* radiance, float* variance,
                    std::uint8_t& edges) {
  bool usable = true;
  for (int dy = 0; dy <= 1; ++dy) {
    for (int dx = 0; dx <= 1; ++dx) {
      const double weight = (dx == 1 ? foot.right : 1.0 - foot.right) * (dy == 1 ? foot.down : 1.0 - foot.down);
      if (weight == 0.0) continue;
      const int x = foot.x + dx, y = foot.y + dy;
      edges |= context.geometry.flags[context.geometry.index(x, y)];
      if (context.photograph.flag(x, y) & kUnusablePixel) usable = false;
      for (int c = 0; c < context.channels; ++c) {
        radiance[c] += static_cast<float>(weight * context.photograph.radiance.at(x, y, c));
        variance[c] += static_cast<float>(weight * weight * context.photograph.variance.at(x, y, c));
      }
    }
  }
  return usable;
}

Verdict sample(const ViewContext& context, const SurfacePoint& point, float* reflectance, float* variance) {
  const Eigen::Vector3d in_camera = context.view.camera_from_world * point.position;
  if (in_camera.z() <= 0.0) return Verdict::OutsideFrame;
  const Eigen::Vector2d pixel = context.view.camera.project(in_camera);
  if (!context.view.camera.contains(pixel)) return Verdict::OutsideFrame;

  const Eigen::Vector3d to_eye = context.eye - point.position;
  const double distance = to_eye.norm();
  const double cos_o = point.normal.dot(to_eye) / distance;
  if (cos_o <= 0.0) return Verdict::Hidden;
  if (cos_o < kGrazingCosine) return Verdict::Grazing;
  const double cos_i = point.normal.dot(context.view.light.direction_from(point.position));
  if (cos_i <= 0.0) return Verdict::InShadow;
  if (cos_i < kGrazingCosine) return Verdict::Grazing;
  if (context.scene.occluded(point.position, to_eye / distance, context.scene.surface_offset_m(), distance)) {
    return Verdict::Hidden;
  }
  switch (lighting_of(context.view.light, point, context.scene)) {
    case Lighting::Dark: return Verdict::InShadow;
    case Lighting::Partly: return Verdict::Penumbra;
    case Lighting::Full: break;
  }

  std::uint8_t edges = 0;
  const bool usable = read_footprint(context, footprint_at(pixel, context.view.camera), reflectance, variance, edges);
  if (!usable) return Verdict::Flagged;
  if (edges & (kViewDepthEdge | kViewMiss)) return Verdict::DepthEdge;
  if (edges & kViewShadowEdge) return Verdict::ShadowEdge;
  for (int c = 0; c < context.channels; ++c) {
    const double irradiance = context.view.light.irradiance(point.position, c);
    reflectance[c] = static_cast<float>(reflectance[c] / irradiance);
    variance[c] = static_cast<float>(variance[c] / (irradiance * irradiance));
    if (!std::isfinite(reflectance[c]) || !std::isfinite(variance[c])) return Verdict::Flagged;
  }
  return Verdict::Used;
}

ViewSamples sample_view(const ViewContext& context, const std::vector<Site>& sites) {
  const auto channels = static_cast<std::size_t>(context.channels);
  ViewSamples samples;
  samples.verdict.assign(sites.size(), Verdict::Hidden);
  samples.reflectance.assign(sites.size() * channels, 0.0f);
  samples.variance.assign(sites.size() * channels, 0.0f);
  oneapi::tbb::parallel_for(std::size_t{0}, sites.size(), [&](std::size_t i) {
    samples.verdict[i] = sample(context, sites[i].point, &samples.reflectance[i * channels],
                                &samples.variance[i * channels]);
  });
  return samples;
}

void count(const ViewSamples& samples, RejectionCounts& counts) {
  for (const Verdict verdict : samples.verdict) {
    switch (verdict) {
      case Verdict::Used: break;
      case Verdict::OutsideFrame: ++counts.outside_frame; break;
      case Verdict::Hidden: ++counts.hidden; break;
      case Verdict::InShadow: ++counts.in_shadow; break;
      case Verdict::DepthEdge: ++counts.near_depth_edge; break;
      case Verdict::ShadowEdge: ++counts.near_shadow_edge; break;
      case Verdict::Grazing: ++counts.grazing; break;
      case Verdict::Flagged: ++counts.photograph_flag; break;
      case Verdict::Penumbra: ++counts.in_penumbra; break;
    }
  }
}

LumitexelSet assemble(const std::vector<Site>& sites, const std::vector<std::size_t>& used_views,
                      const std::vector<ViewSamples>& samples, int channels) {
  LumitexelSet set;
  set.channels = channels;
  const auto stride = static_cast<std::size_t>(channels);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (i % LumitexelTile::kCapacity == 0) set.tiles.emplace_back();
    LumitexelTile& tile = set.tiles.back();
    tile.position.push_back(sites[i].point.position);
    tile.normal.push_back(sites[i].point.normal);
    tile.texel.push_back(sites[i].texel);
    for (std::size_t k = 0; k < used_views.size(); ++k) {
      if (samples[k].verdict[i] != Verdict::Used) continue;
      tile.view.push_back(static_cast<std::uint16_t>(used_views[k]));
      for (std::size_t c = 0; c < stride; ++c) {
        tile.reflectance.push_back(samples[k].reflectance[i * stride + c]);
        tile.variance.push_back(samples[k].variance[i * stride + c]);
      }
    }
    tile.first_sample.push_back(static_cast<std::uint32_t>(tile.samples()));
  }
  return set;
}

RadianceImage read_checked(const View& view, int channels) {
  RadianceImage photograph;
  try {
    photograph = read_radiance_image(view.photograph);
  } catch (const Error& error) {
    throw Corrupt(std::string(error.what()) + " (delete the session's folder derived/; it is made again)");
  }
  const Image& radiance = photograph.radiance;
  if (radiance.width != view.camera.width_px || radiance.height != view.camera.height_px ||
      radiance.channels != channels) {
    throw Corrupt(view.photograph.string() + ": " + std::to_string(radiance.width) + " x " +
                  std::to_string(radiance.height) + " x " + std::to_string(radiance.channels) +
                  " does not match the camera of view " + view.name);
  }
  return photograph;
}

}  // namespace

std::size_t LumitexelSet::size() const {
  std::size_t total = 0;
  for (const LumitexelTile& tile : tiles) total += tile.size();
  return total;
}

std::size_t LumitexelSet::samples() const {
  std::size_t total = 0;
  for (const LumitexelTile& tile : tiles) total += tile.samples();
  return total;
}

GatheredLumitexels gather_lumitexels(const CalibratedSession& session, const Atlas& atlas, const RayScene& scene,
                                     Progress& progress) {
  std::vector<std::size_t> used_views;
  for (std::size_t v = 0; v < session.views.size(); ++v) {
    if (!session.views[v].heldout) used_views.push_back(v);
  }
  progress.begin("views: geometry", static_cast<std::int64_t>(used_views.size()), "views");
  std::vector<ViewGeometry> geometry;
  std::vector<Site> sites;
  for (const std::size_t v : used_views) {
    geometry.push_back(trace_view(session.views[v], session.mesh, scene));
    collect_sites(geometry.back(), atlas, session.mesh, static_cast<int>(v), sites);
    progress.update(static_cast<std::int64_t>(geometry.size()));
  }
  for (const LayoutSite& site : atlas.sites) {
    sites.push_back({site.texel, surface_point(session.mesh, site.triangle, site.u, site.v)});
  }
  // Where both kinds of triangle meet, a texel may be asked for twice: the pixel's lumitexel, which came first, has it.
  const auto by_texel = [](const Site& a, const Site& b) { return a.texel < b.texel; };
  std::stable_sort(sites.begin(), sites.end(), by_texel);
  sites.erase(std::unique(sites.begin(), sites.end(), [](const Site& a, const Site& b) { return a.texel == b.texel; }), sites.end());

  progress.begin("views: samples", static_cast<std::int64_t>(used_views.size()), "views");
  GatheredLumitexels result;
  std::vector<ViewSamples> samples;
  for (std::size_t k = 0; k < used_views.size(); ++k) {
    const View& view = session.views[used_views[k]];
    const RadianceImage photograph = read_checked(view, session.channels);
    samples.push_back(
        sample_view({view, geometry[k], photograph, scene, view.camera_in_world(), session.channels}, sites));
    count(samples.back(), result.rejected);
    progress.update(static_cast<std::int64_t>(k + 1));
  }
  result.set = assemble(sites, used_views, samples, session.channels);
  result.used_views = used_views;
  for (ViewSamples& of_view : samples) result.verdict.push_back(std::move(of_view.verdict));
  return result;
}

}  // namespace lumitexel
