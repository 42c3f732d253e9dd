#include "tests/unit/light/photographed_balls.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>

#include "processing/calibration/light/shading_normals.h"
#include "processing/image/raster_file.h"

namespace lumitexel {
namespace {

std::vector<Eigen::Vector3d> read_given(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::size_t count = 0;
  in >> count;
  std::vector<Eigen::Vector3d> lights(count);
  for (Eigen::Vector3d& l : lights) {
    in >> l.x() >> l.y() >> l.z();
    l.normalize();
  }
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  return lights;
}

double mean_code(const Image& picture, int x, int y) {
  double sum = 0.0;
  for (int c = 0; c < picture.channels; ++c) sum += static_cast<double>(picture.at(x, y, c));
  return sum / (255.0 * picture.channels);
}

}  // namespace

PhotographedBalls read_balls(const std::filesystem::path& folder, int step) {
  const auto picture = [&](const std::string& name) { return read_raster(folder / (name + ".png")).code_values; };
  PhotographedBalls balls;
  balls.mirror = ball_of_mask(picture("chrome.mask"));
  balls.gray = ball_of_mask(picture("gray.mask"));
  balls.given = read_given(folder / "lights.txt");
  std::vector<Image> gray;
  for (std::size_t j = 0; j < balls.given.size(); ++j) {
    const auto mirrored = mirrored_direction(picture("chrome." + std::to_string(j)), balls.mirror, 255.0f);
    if (!mirrored) throw std::runtime_error("no highlight in picture " + std::to_string(j));
    balls.mirrored.push_back(mirrored->direction);
    balls.mirrored_sigma_rad.push_back(mirrored->sigma_rad);
    gray.push_back(picture("gray." + std::to_string(j)));
  }
  constexpr int kBlock = 16, kBlocksAcross = 1000;
  constexpr double kRim = 0.97;  // of the radius: what is fitted stays off the outline's error
  for (int y = 0; y < gray[0].height; ++y) {
    for (int x = 0; x < gray[0].width; ++x) {
      const auto normal = balls.gray.normal({x + 0.5, y + 0.5});
      if (!normal) continue;
      BallPixel pixel{*normal, {}, kBlocksAcross * (y / kBlock) + x / kBlock};
      for (const Image& g : gray) pixel.code.push_back(mean_code(g, x, y));
      const bool first_half = (x / kBlock + y / kBlock) % 2 == 0;
      if (!first_half && x % 2 == 0 && y % 2 == 0) balls.judged.push_back(pixel);
      if (x % step || y % step || normal->head<2>().norm() > kRim) continue;
      (first_half ? balls.fitted : balls.heldout).push_back(std::move(pixel));
    }
  }
  return balls;
}

DirectionalLights plain_lights(const std::vector<Eigen::Vector3d>& directions) {
  DirectionalLights lights;
  lights.directions = directions;
  lights.strengths.assign(directions.size(), 1.0);
  lights.sigma_rad.assign(directions.size(), 0.0);
  return lights;
}

NormalErrors normal_errors(const DirectionalLights& lights, const std::vector<BallPixel>& pixels, double sigma_code) {
  NormalErrors errors;
  std::vector<double> degrees;
  for (const BallPixel& pixel : pixels) {
    const auto found = normal_from_shading(lights, pixel.code, sigma_code);
    errors.missing += !found;
    degrees.push_back(found ? 180.0 / M_PI * std::acos(std::clamp(found->normal.dot(pixel.normal), -1.0, 1.0)) : 90.0);
  }
  std::sort(degrees.begin(), degrees.end());
  for (const double d : degrees) errors.mean_deg += d / static_cast<double>(degrees.size());
  errors.median_deg = degrees[degrees.size() / 2];
  errors.p95_deg = degrees[degrees.size() * 95 / 100];
  return errors;
}

}  // namespace lumitexel
