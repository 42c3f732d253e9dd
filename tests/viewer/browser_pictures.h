// What the viewer's page draws, got out of headless Chromium (its software renderer) as numbers.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "processing/model/model.h"
#include "processing/calibration/calibrated_session.h"

namespace lumitexel {

struct BrowserPicture {
  std::vector<float> radiance;  // width * height * 4, top row first: channels, then 1 on the object and 0 beside it
  std::vector<float> texel;     // the same: nearest texel's x and y, material, triangle; -1 in holes of the atlas and beside the object
};

bool has_chromium();

// What a page of the test's own writes into <pre id="measured">, JSON; nothing if it wrote none.
std::optional<nlohmann::json> browser_answer(const std::filesystem::path& page);

// By stage. The view: a camera without distortion, its principal point in the middle, and a point light without a pattern. Nothing if
// the browser did not come up with it; `page` is the viewer's file.
std::optional<std::map<FitStage, BrowserPicture>> browser_pictures(const std::filesystem::path& page, const View& view,
                                                                   const std::vector<FitStage>& stages);

// The page's surroundings, turned about the world's z: after each number of passes (rising) four floats a pixel, top row first: the mean
// radiance, and the share of the passes that met the object.
std::optional<std::vector<std::vector<float>>> browser_sky(const std::filesystem::path& page, const View& view, FitStage stage, double turn_rad,
                                                           const std::vector<int>& passes);

// As the page reads them: sigma, samples, residual and the normal's sigma of every pixel, top row first, -1 for none.
std::optional<std::vector<float>> browser_figures(const std::filesystem::path& page, const View& view);

// Of a page with samples: what it says at each of the texels (page/samples.js), an array; the view only has to be one.
std::optional<nlohmann::json> browser_samples(const std::filesystem::path& page, const View& view,
                                              const std::vector<std::array<int, 2>>& texels);

// Of the same page: milliseconds a picture while the camera turns once around, by the browser's clock.
std::optional<double> browser_frame_ms(const std::filesystem::path& page, const View& view, FitStage stage, int frames);

}  // namespace lumitexel
