#include "tests/unit/interreflection/bowl_session.h"

#include "processing/render/render_lit.h"
#include "tests/unit/interreflection/bowl.h"
#include "tests/unit/sphere_session.h"

namespace lumitexel {
namespace {

constexpr int kPathsPerPixel = 64;

void add_light_between(const Model& bowl, const View& view, int bounces) {
  LitOptions options;
  options.path.bounces = bounces;
  options.path.straight_light = false;
  options.limits.samples_per_pixel = kPathsPerPixel;
  NoProgress silent;
  const LitView between = render_lit(bowl, view, {{view.light}, nullptr}, options, silent, SystemClock());
  RadianceImage photograph = read_radiance_image(view.photograph);
  for (std::size_t i = 0; i < photograph.radiance.data.size(); ++i) photograph.radiance.data[i] += between.radiance.data[i];
  write_radiance_image(view.photograph, photograph);
}

}  // namespace

CalibratedSession photographed_bowl(int bounces, const TemporaryFolder& folder) {
  std::vector<View> views;
  for (int i = 0; i < 8; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / 8, aside = turn + 1.9;
    views.push_back(view_of_origin("view_" + std::to_string(i), {1.5 * std::cos(turn), 1.5 * std::sin(turn), 5.0},
                                   {(1.0 + 0.3 * i) * std::cos(aside), (1.0 + 0.3 * i) * std::sin(aside), 4.0}));
  }
  CalibratedSession session = diffuse_session(bowl_mesh(48, 48), std::move(views), folder);
  if (bounces == 0) return session;
  const double f = kSphereAlbedo / std::numbers::pi;
  const Model bowl = model_of(session.mesh, 96, 48, diffuse_brdf(f, f, f));
  for (const View& view : session.views) add_light_between(bowl, view, bounces);
  return session;
}

}  // namespace lumitexel
