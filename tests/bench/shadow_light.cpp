// What bounces add, against photographs: the light in the shadows of a session's held-out views, where by the model no
// direct light falls at all, photographed and as rendered.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>

#include "drivers/clock.h"
#include "processing/evaluation/evaluate_model.h"
#include "processing/model/model_file.h"
#include "processing/model/render_view.h"
#include "processing/render/render_lit.h"
#include "rig/session_store.h"
#include "tests/bench/machine.h"

namespace lumitexel {
namespace {

constexpr int kMargin_px =
    3;  // to the object's outline and to light: photographs have a pixel filter, and edges of shadows err

// Pixels of the object in which, and around which, the model is without direct light.
std::vector<std::uint8_t> shadow_pixels(const RenderedView& direct, const std::vector<std::uint8_t>& object) {
  const Image& image = direct.radiance;
  std::vector<std::uint8_t> dark(object.size(), 0);
  for (int y = kMargin_px; y + kMargin_px < image.height; ++y) {
    for (int x = kMargin_px; x + kMargin_px < image.width; ++x) {
      bool all = true;
      for (int j = -kMargin_px; j <= kMargin_px && all; ++j) {
        for (int i = -kMargin_px; i <= kMargin_px && all; ++i) {
          const auto p = static_cast<std::size_t>((y + j) * image.width + x + i);
          all = object[p] != 0 && direct.hit[p] != 0;
          for (int c = 0; c < image.channels; ++c) all = all && image.at(x + i, y + j, c) == 0.0f;
        }
      }
      dark[static_cast<std::size_t>(y * image.width + x)] = all;
    }
  }
  return dark;
}

void compare(const Model& model, const View& view, int bounces, int samples) {
  const RadianceImage photograph = read_photograph(view, model.channels);
  const RenderedView direct = ViewRenderer(model).render(view, {});
  const std::vector<std::uint8_t> dark = shadow_pixels(direct, object_pixels(photograph, direct.hit));
  LitOptions options;
  options.path.bounces = bounces;
  options.limits.samples_per_pixel = samples;
  NoProgress silent;
  const LitView lit = render_lit(model, view, {{view.light}, nullptr}, options, silent, SystemClock());
  std::vector<double> seen(static_cast<std::size_t>(model.channels)), predicted(seen.size());
  double squares = 0.0, left = 0.0, pixels = 0.0;
  for (std::size_t p = 0; p < dark.size(); ++p) {
    if (dark[p] == 0) continue;
    pixels += 1.0;
    for (std::size_t c = 0; c < seen.size(); ++c) {
      const double q = photograph.radiance.data[p * seen.size() + c], r = lit.radiance.data[p * seen.size() + c];
      seen[c] += q;
      predicted[c] += r;
      squares += q * q;
      left += (q - r) * (q - r);
    }
  }
  std::printf("%s: %.0f pixels in shadow, mean radiance photographed", view.name.c_str(), pixels);
  for (const double sum : seen) std::printf(" %.4f", sum / pixels);
  std::printf(", rendered");
  for (const double sum : predicted) std::printf(" %.4f", sum / pixels);
  std::printf("; rms of what is left over that of the light %.3f\n", std::sqrt(left / squares));
}

int run(int argc, char** argv) {
  CLI::App app("Light in shadows: photographed in held-out views, and as bounces predict it");
  std::string model_path, session_path;
  int bounces = 2, samples = 256;
  app.add_option("MODEL", model_path, "Folder of the model")->required();
  app.add_option("SESSION", session_path, "Folder of the session")->required();
  app.add_option("--bounces", bounces, "Between surfaces")->capture_default_str();
  app.add_option("--spp", samples, "Samples a pixel")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  std::printf("%s\n", machine_line().c_str());
  const Model model = read_model(model_path);
  NoProgress silent;
  const SessionStore store = SessionStore::open(session_path, OpenMode::ReadOnly);
  for (const View& view : calibrate_session(store, silent).views) {
    if (view.heldout) compare(model, view, bounces, samples);
  }
  return 0;
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) { return lumitexel::run(argc, argv); }
