#include "tests/unit/light/rough_spheres.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "processing/calibration/light/highlight_geometry.h"

namespace lumitexel {
namespace {

constexpr int kWindow_px = 11, kMargin_px = 4;  // the second: for the blur
constexpr int kSub = 4;

// GGX's distribution over the cosines; the microfacet model without shadowing and Fresnel.
double radiance(const RoughSpheres& spheres, const MirrorSphere& sphere, const Eigen::Vector3d& view, const std::vector<Eigen::Vector3d>& emitters) {
  const auto hit = mirrored_ray(sphere, {Eigen::Vector3d::Zero(), view});
  if (!hit) return 0.0;
  const Eigen::Vector3d normal = (hit->origin - sphere.centre).normalized();
  const double a2 = spheres.roughness * spheres.roughness;
  double sum = 0.0;
  for (const Eigen::Vector3d& emitter : emitters) {
    const Eigen::Vector3d to_light = emitter - hit->origin;
    const double cosine = normal.dot((to_light.normalized() - view).normalized());
    const double c2 = cosine * cosine;
    sum += a2 / std::pow(c2 * (a2 + 1.0 / c2 - 1.0), 2) / to_light.squaredNorm();
  }
  return sum / -normal.dot(view);
}

std::vector<double> blur_kernel(double sigma_px) {
  std::vector<double> kernel;
  double sum = 0.0;
  const int reach = kMargin_px * kSub;
  for (int i = -reach; i <= reach; ++i) {
    const double x = static_cast<double>(i) / kSub / std::max(sigma_px, 1e-3);
    kernel.push_back(std::exp(-0.5 * x * x));
    sum += kernel.back();
  }
  for (double& value : kernel) value /= sum;
  return kernel;
}

// One pass of a blur that keeps the raster's size; rows become columns.
std::vector<double> blurred_and_turned(const std::vector<double>& raster, int size, const std::vector<double>& kernel) {
  std::vector<double> result(raster.size(), 0.0);
  const int reach = static_cast<int>(kernel.size() / 2);
  for (int y = 0; y < size; ++y) {
    for (int x = reach; x < size - reach; ++x) {
      double sum = 0.0;
      for (int i = -reach; i <= reach; ++i) sum += kernel[static_cast<std::size_t>(i + reach)] * raster[static_cast<std::size_t>(y * size + x + i)];
      result[static_cast<std::size_t>(x * size + y)] = sum;
    }
  }
  return result;
}

void draw(const RoughSpheres& spheres, int k, const std::vector<Eigen::Vector3d>& emitters, MosaicRadiance& picture) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& emitter : emitters) centre += emitter / static_cast<double>(emitters.size());
  const MirrorSphere sphere = spheres.line.sphere(k);
  const Eigen::Vector2d place = centre.norm() > 1e-9 ? highlight_pixel(spheres.camera, sphere, centre)
                                                     : spheres.camera.project(sphere.centre);
  const int half = kWindow_px + kMargin_px, size = (2 * half + 1) * kSub;
  const int x0 = static_cast<int>(place.x()) - half, y0 = static_cast<int>(place.y()) - half;
  std::vector<double> raster(static_cast<std::size_t>(size * size));
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const Eigen::Vector2d pixel(x0 + (x + 0.5) / kSub, y0 + (y + 0.5) / kSub);
      raster[static_cast<std::size_t>(y * size + x)] = radiance(spheres, sphere, spheres.camera.unproject(pixel), emitters);
    }
  }
  if (spheres.blur_px > 0.0) {
    const std::vector<double> kernel = blur_kernel(spheres.blur_px);
    raster = blurred_and_turned(blurred_and_turned(raster, size, kernel), size, kernel);
  }
  for (int y = kMargin_px; y < 2 * half + 1 - kMargin_px; ++y) {
    for (int x = kMargin_px; x < 2 * half + 1 - kMargin_px; ++x) {
      double sum = 0.0;
      for (int s = 0; s < kSub * kSub; ++s) {
        sum += raster[static_cast<std::size_t>((y * kSub + s / kSub) * size + x * kSub + s % kSub)] / (kSub * kSub);
      }
      picture.value[picture.index(x0 + x, y0 + y)] += static_cast<float>(sum);
    }
  }
}

}  // namespace

MosaicRadiance picture_of(const RoughSpheres& spheres, const std::vector<Eigen::Vector3d>& emitters, double peak) {
  MosaicRadiance picture;
  picture.width = spheres.camera.width_px;
  picture.height = spheres.camera.height_px;
  picture.mosaic = Mosaic::Mono;
  picture.value.assign(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height), 0.0f);
  picture.flags.assign(picture.value.size(), 0);
  for (int k = 0; k < spheres.line.count; ++k) draw(spheres, k, emitters, picture);
  const float scale = static_cast<float>(peak) / *std::max_element(picture.value.begin(), picture.value.end());
  for (float& value : picture.value) value *= scale;
  picture.variance.assign(picture.value.size(), 9.0f);
  return picture;
}

std::vector<Eigen::Vector3d> disc_of_emitters(const Eigen::Vector3d& centre, const Eigen::Vector3d& faces, double radius_m) {
  if (!(radius_m > 0.0)) return {centre};
  const Eigen::Vector3d across = (faces - centre).unitOrthogonal(), other = (faces - centre).normalized().cross(across);
  std::vector<Eigen::Vector3d> emitters;
  constexpr int kEmitters = 48;  // Vogel's spiral
  for (int i = 0; i < kEmitters; ++i) {
    const double radius = radius_m * std::sqrt((i + 0.5) / kEmitters), angle = std::numbers::pi * (3.0 - std::sqrt(5.0)) * i;
    emitters.push_back(centre + radius * (std::cos(angle) * across + std::sin(angle) * other));
  }
  return emitters;
}

std::vector<Eigen::Vector3d> ring_of_emitters(double radius_m) {
  std::vector<Eigen::Vector3d> emitters;
  constexpr int kEmitters = 32;
  for (int i = 0; i < kEmitters; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kEmitters;
    emitters.push_back({radius_m * std::cos(angle), radius_m * std::sin(angle), 0.0});
  }
  return emitters;
}

MosaicRadiance with_noise(MosaicRadiance picture, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<float> noise(0.0f, 1.0f);
  for (std::size_t i = 0; i < picture.value.size(); ++i) {
    picture.variance[i] = 9.0f + picture.value[i];
    picture.value[i] += std::sqrt(picture.variance[i]) * noise(random);
  }
  return picture;
}

}  // namespace lumitexel
