#include "tests/unit/normals/normal_patch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "processing/brdf/prepared_brdf.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

constexpr double kSpacing_m = 1e-3;
constexpr double kAway_m = 1.0;

Eigen::Vector3d above(double azimuth, double polar) {
  return {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)};
}

std::vector<View> views_around(int count, std::mt19937& random) {
  std::uniform_real_distribution<double> turn(0.0, 2.0 * std::numbers::pi), height(0.1, 1.0);
  std::vector<View> views(static_cast<std::size_t>(count));
  for (std::size_t v = 0; v < views.size(); ++v) {
    views[v].name = "view_" + std::to_string(v);
    const double azimuth = turn(random);
    views[v].camera_from_world.translation() = -kAway_m * above(azimuth, height(random));
    // Half of the lights opposite the camera, so that highlights are seen.
    const double lit_from = v % 2 == 0 ? azimuth + std::numbers::pi : turn(random);
    views[v].light.vector_in_world = kAway_m * above(lit_from, height(random));
  }
  return views;
}

struct Wave {
  double kx, ky, phase, slope;
};

std::vector<Wave> waves(double slope_rms, std::mt19937& random) {
  std::uniform_real_distribution<double> turn(0.0, 2.0 * std::numbers::pi), texels(8.0, 20.0);
  std::vector<Wave> result;
  constexpr int kWaves = 8;
  for (int i = 0; i < kWaves; ++i) {
    const double k = 2.0 * std::numbers::pi / texels(random), direction = turn(random);
    result.push_back({k * std::cos(direction), k * std::sin(direction), turn(random), slope_rms * std::sqrt(4.0 / kWaves)});
  }
  return result;
}

// Of a height whose slope along each wave is slope * cos(phase).
Eigen::Vector3d normal_at(const std::vector<Wave>& of, int x, int y) {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  for (const Wave& wave : of) {
    const double k = std::hypot(wave.kx, wave.ky), slope = wave.slope * std::cos(wave.kx * x + wave.ky * y + wave.phase);
    normal.x() -= slope * wave.kx / k;
    normal.y() -= slope * wave.ky / k;
  }
  return normal.normalized();
}

void add_samples(const NormalPatch& patch, const PreparedBrdf& brdf, const Eigen::Vector3d& position, const Eigen::Vector3d& normal,
                 double noise, std::mt19937& random, LumitexelTile& tile) {
  std::normal_distribution<double> error;
  for (std::size_t v = 0; v < patch.session.views.size(); ++v) {
    const View& view = patch.session.views[v];
    const LobeGeometry geometry =
        lobe_geometry(normal, view.light.direction_from(position), (view.camera_in_world() - position).normalized());
    if (geometry.cos_i <= 0.0 || geometry.cos_o <= 0.0) continue;
    const ChannelValues value = predicted_reflectance(brdf, geometry);
    tile.view.push_back(static_cast<std::uint16_t>(v));
    for (std::size_t c = 0; c < 3; ++c) {
      tile.reflectance.push_back(static_cast<float>(value[c] * (1.0 + noise * error(random))));
      tile.variance.push_back(static_cast<float>(noise * noise * value[c] * value[c]));
    }
  }
}

}  // namespace

NormalPatch make_patch(const PatchSettings& settings) {
  std::mt19937 random(settings.seed);
  NormalPatch patch;
  patch.width = settings.side;
  patch.session.views = views_around(settings.views, random);
  patch.lumitexels.channels = 3;
  const Brdf brdf = one_lobe({0.1, 0.08, 0.05}, {0.3, 0.3, 0.3}, 0.0, 30.0);
  patch.bases = {{brdf, diffuse_brdf(0.1, 0.08, 0.05)}};
  const PreparedBrdf prepared(brdf);
  const std::vector<Wave> surface = waves(settings.slope_rms_rad, random);
  for (int y = 0; y < settings.side; ++y) {
    for (int x = 0; x < settings.side; ++x) {
      if (patch.truth.size() % LumitexelTile::kCapacity == 0) patch.lumitexels.tiles.emplace_back();
      LumitexelTile& tile = patch.lumitexels.tiles.back();
      const Eigen::Vector3d position(kSpacing_m * (x - 0.5 * settings.side), kSpacing_m * (y - 0.5 * settings.side), 0.0);
      const double ridge = std::tan(settings.ridge_rad) * (2 * x < settings.side ? -1.0 : 1.0);
      patch.truth.push_back((normal_at(surface, x, y) + ridge * Eigen::Vector3d::UnitX()).normalized());
      tile.position.push_back(position);
      tile.normal.push_back(Eigen::Vector3d::UnitZ());
      tile.texel.push_back(static_cast<std::uint32_t>(y * settings.side + x));
      add_samples(patch, prepared, position, patch.truth.back(), settings.noise, random, tile);
      tile.first_sample.push_back(static_cast<std::uint32_t>(tile.samples()));
    }
  }
  patch.label.assign(patch.truth.size(), 0);
  std::vector<float> values = patch.lumitexels.tiles.front().reflectance;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  patch.median_reflectance = static_cast<double>(values[values.size() / 2]);
  return patch;
}

double angle_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

double rms_angle(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += std::pow(angle_rad(a[i], b[i]), 2);
  return std::sqrt(squares / static_cast<double>(a.size()));
}

std::vector<Eigen::Vector3d> mesh_normals(const NormalPatch& patch) {
  std::vector<Eigen::Vector3d> normals;
  for (const LumitexelTile& tile : patch.lumitexels.tiles) normals.insert(normals.end(), tile.normal.begin(), tile.normal.end());
  return normals;
}

}  // namespace lumitexel
