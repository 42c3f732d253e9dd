#include "processing/render/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "processing/render/lamp_light.h"

namespace lumitexel {
namespace {

constexpr double kUniformDensity = 1.0 / (4.0 * std::numbers::pi);

// One of the texels around the point, by its weight; `choice` becomes what is left of it, again uniform.
const TexelShare& drawn_texel(const TexturedPoint& point, double& choice) {
  int i = 0;
  while (i + 1 < point.texel_count && choice >= point.texels[static_cast<std::size_t>(i)].weight) {
    choice -= point.texels[static_cast<std::size_t>(i++)].weight;
  }
  const TexelShare& texel = point.texels[static_cast<std::size_t>(i)];
  choice = std::clamp(choice / texel.weight, 0.0, 1.0);
  return texel;
}

// The power heuristic for a direction drawn with the first density that the other way would have drawn with the second.
double shared_weight(double own_density, double other_density) {
  const double own = own_density * own_density, other = other_density * other_density;
  return own > 0.0 ? own / (own + other) : 0.0;
}

}  // namespace

PathTracer::PathTracer(const ModelSurface& surface, const ReflectingModel& reflecting, const Lighting& lighting,
                       const PathOptions& options)
    : surface_(surface),
      lighting_(lighting),
      options_(options),
      asks_sky_(lighting.environment != nullptr && options.sampling != EnvironmentSampling::Brdf),
      sky_answers_brdf_(lighting.environment != nullptr && (options.sampling == EnvironmentSampling::Combined ||
                                                            options.sampling == EnvironmentSampling::Brdf)),
      texel_(reflecting) {}

PathSample PathTracer::trace(const Eigen::Vector3d& origin, Eigen::Vector3d direction, SampleSequence& numbers) {
  sample_ = {};
  throughput_.fill(1.0);
  std::optional<TexturedPoint> point = surface_.trace(origin, direction);
  sample_.hit = point.has_value();
  if (!point && options_.show_environment && lighting_.environment != nullptr) {
    for (int c = 0; c < surface_.model().channels; ++c) {
      sample_.radiance[static_cast<std::size_t>(c)] = lighting_.environment->radiance(direction, c);
    }
  }
  for (int bounce = 0; point; ++bounce) {
    const Eigen::Vector2d choices = numbers.next(), for_sky = numbers.next(), for_brdf = numbers.next();
    if (!arrive(*point, -direction, choices.x())) break;
    const bool counts = options_.straight_light || bounce > 0;
    if (counts) add_lamps(*point);
    if (counts && asks_sky_) add_drawn_sky(*point, for_sky);
    const bool last = bounce == options_.bounces;
    if (last && !sky_answers_brdf_) break;
    direction = texel_.sample(choices.y(), for_brdf);
    const Sky drawn{direction, texel_.density(direction)};
    point = follow(*point, drawn, last, counts);
  }
  return sample_;
}

bool PathTracer::arrive(const TexturedPoint& point, const Eigen::Vector3d& wo, double choice) {
  if (point.texel_count == 0 || !(point.geometric_normal.dot(wo) > 0.0)) return false;
  const TexelShare& texel = drawn_texel(point, choice);
  return texel_.set(texel.x, texel.y, surface_.shading_normal(texel, point, texel_.stage()), wo);
}

void PathTracer::add_lamps(const TexturedPoint& point) {
  const ChannelValues light = light_of_lamps(surface_, point, texel_, lighting_.lamps);
  for (std::size_t c = 0; c < light.size(); ++c) sample_.radiance[c] += throughput_[c] * light[c];
}

PathTracer::Sky PathTracer::sky_direction(const Eigen::Vector2d& uniform) const {
  if (options_.sampling == EnvironmentSampling::Uniform) {
    const double z = 1.0 - 2.0 * uniform.x(), level = std::sqrt(std::max(0.0, 1.0 - z * z));
    const double longitude = 2.0 * std::numbers::pi * uniform.y();
    return {{level * std::cos(longitude), level * std::sin(longitude), z}, kUniformDensity};
  }
  const Eigen::Vector3d direction = lighting_.environment->sample(uniform);
  return {direction, lighting_.environment->density(direction)};
}

void PathTracer::add_drawn_sky(const TexturedPoint& point, const Eigen::Vector2d& uniform) {
  const Sky drawn = sky_direction(uniform);
  if (!(point.geometric_normal.dot(drawn.direction) > 0.0) || !surface_.sees_sky(point, drawn.direction)) return;
  add_sky(drawn, sky_answers_brdf_ ? shared_weight(drawn.density, texel_.density(drawn.direction)) : 1.0);
}

void PathTracer::add_sky(const Sky& sky, double weight) {
  if (!(sky.density > 0.0)) return;
  const ChannelValues r = texel_.reflectance(sky.direction);
  for (std::size_t c = 0; c < static_cast<std::size_t>(surface_.model().channels); ++c) {
    sample_.radiance[c] += throughput_[c] * r[c] * weight / sky.density *
                           lighting_.environment->radiance(sky.direction, static_cast<int>(c));
  }
}

// The next surface in the direction drawn from the BRDF, or nothing; then what the sky sends from there has been added.
// On the last leg only the sky matters.
std::optional<TexturedPoint> PathTracer::follow(const TexturedPoint& point, const Sky& drawn, bool last, bool sky_counts) {
  if (!(drawn.density > 0.0) || !(point.geometric_normal.dot(drawn.direction) > 0.0)) return std::nullopt;
  std::optional<TexturedPoint> next;
  const bool blocked = last ? !surface_.sees_sky(point, drawn.direction)
                            : (next = surface_.trace(surface_.start_above(point), drawn.direction)).has_value();
  if (!blocked && sky_counts && sky_answers_brdf_) {
    add_sky(drawn, asks_sky_ ? shared_weight(drawn.density, lighting_.environment->density(drawn.direction)) : 1.0);
  }
  if (!next) return std::nullopt;
  const ChannelValues r = texel_.reflectance(drawn.direction);
  if (r == ChannelValues{}) return std::nullopt;
  for (std::size_t c = 0; c < r.size(); ++c) {
    throughput_[c] *= r[c] / drawn.density / std::max(1.0, texel_.albedo()[c]);
  }
  return next;
}

}  // namespace lumitexel
