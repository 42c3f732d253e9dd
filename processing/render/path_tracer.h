// The radiance that arrives along one ray: light from lamps and an environment, reflected by the model towards the ray,
// directly and after up to a number of bounces between the model's own surfaces. One random sample of it, without bias.
//
// At every point of a path one of the four texels around it is drawn by its bilinear weight; its BRDF and normal hold
// for the point. The mean over many paths is the blend that ViewRenderer computes. Lamps are asked one by one (next
// event estimation), each with a shadow ray. The environment is asked twice, by a direction drawn from it and by one
// drawn from the texel's BRDF, the two combined by the power heuristic (Veach, Guibas 1995); the BRDF's direction also
// finds the next surface.
//
// Where the shading normal and the triangle disagree: light reaches a point only from above both, and leaves it only
// above both. What would pass below the triangle is blocked by it, what would pass below the shading normal's horizon
// is absorbed. Energy is lost there and none is ever made. Light that comes from other surfaces is scaled down where a
// fitted BRDF would reflect more than it gets (its albedo above 1 in a channel), so that no chain of bounces gains;
// light straight from lamps and environment is left as the BRDF says, as photographs measured it.
//
// Backs of triangles and holes of the atlas are black, and cast shadows.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/model/model_surface.h"
#include "processing/render/environment.h"
#include "processing/render/sample_sequence.h"
#include "processing/render/texel_brdf.h"

namespace lumitexel {

struct Lighting {
  std::vector<Light> lamps;                  // point and directional
  const Environment* environment = nullptr;  // none: dark beside the lamps
};

enum class EnvironmentSampling {
  Combined,     // what is described above
  Environment,  // its own directions alone
  Brdf,         // the BRDF's directions alone
  Uniform,      // all directions alike: slow, and what the others are checked against
};

struct PathOptions {
  int bounces = 0;                // between the model's surfaces
  bool straight_light = true;     // false: only light that came to the ray's first point from other surfaces
  bool show_environment = false;  // beside the object; otherwise that is black
  EnvironmentSampling sampling = EnvironmentSampling::Combined;
};

struct PathSample {
  ChannelValues radiance{};
  bool hit = false;  // the ray itself meets the model
};

// Not for two threads at once; what it refers to may be shared.
class PathTracer {
 public:
  // lighting: as many channels as the model. All are kept by reference.
  PathTracer(const ModelSurface& surface, const ReflectingModel& reflecting, const Lighting& lighting,
             const PathOptions& options);

  PathSample trace(const Eigen::Vector3d& origin, Eigen::Vector3d direction, SampleSequence& numbers);

 private:
  struct Sky {
    Eigen::Vector3d direction;
    double density;
  };
  bool arrive(const TexturedPoint& point, const Eigen::Vector3d& wo, double choice);
  void add_lamps(const TexturedPoint& point);
  void add_drawn_sky(const TexturedPoint& point, const Eigen::Vector2d& uniform);
  void add_sky(const Sky& sky, double weight);
  std::optional<TexturedPoint> follow(const TexturedPoint& point, const Sky& drawn, bool last, bool sky_counts);
  Sky sky_direction(const Eigen::Vector2d& uniform) const;

  const ModelSurface& surface_;
  const Lighting& lighting_;
  const PathOptions& options_;
  bool asks_sky_, sky_answers_brdf_;  // which of the two ways the environment is drawn
  TexelReflection texel_;
  ChannelValues throughput_{};
  PathSample sample_;
};

}  // namespace lumitexel
