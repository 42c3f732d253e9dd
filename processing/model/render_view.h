// A model seen by a camera under a light, ray traced.
//
// The radiance of a surface point is f(wi, wo) * cos(theta_i) * irradiance in the unit of the session's photographs
// (see Light). f * cos is computed at each of the four texels around the point with that texel's own normal and
// blended bilinearly over those that have a material. Hard shadows; 0 in shadow, where the surface faces away, in a
// hole of the atlas and beside the object. No light bounces twice.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/image/image.h"
#include "processing/model/model_surface.h"

namespace lumitexel {

struct RenderOptions {
  FitStage stage = FitStage::Normal;  // all that the model holds
  // 1: a ray through the pixel's centre. More: the mean over a fixed pattern that is stratified in both directions.
  int samples_per_pixel = 1;
};

struct RenderedView {
  Image radiance;                 // the model's channels
  std::vector<std::uint8_t> hit;  // per pixel 1 where the ray through the centre meets the mesh
};

// What else can be asked of a view, always along the pixel's central ray.
enum class Aov {
  Radiance,
  Normal,    // the blended shading normal, unit, in world; 0 beside the object
  Position,  // in world, metres; 0 beside the object
  Cluster,   // material of the nearest texel; 65535 where there is none
  Samples,   // how many samples the nearest texel was fitted to
  Sigma,     // one sigma of the texels' reflectance, relative, blended
  NormalSigma  // one sigma of the texels' normals per tangent axis, radians, blended
};

class ViewRenderer {
 public:
  // Keeps a reference to the model.
  explicit ViewRenderer(const Model& model) : surface_(model) {}
  const Model& model() const { return surface_.model(); }

  // Throws BadInput naming the view if its light has another number of channels than the model.
  RenderedView render(const View& view, const RenderOptions& options) const;
  // One channel, or three for normal and position; for Radiance as `render` with one ray at the last stage.
  Image render_aov(const View& view, Aov aov) const;

 private:
  ModelSurface surface_;
};

// A view of the whole mesh from `towards_camera` (a direction), lit from beside the camera so that a white diffuse
// surface in the middle has a radiance of about 1. For looking at a model without a session.
View framing_view(const Mesh& mesh, int channels, int size_px, const Eigen::Vector3d& towards_camera,
                  const Eigen::Vector3d& up);

}  // namespace lumitexel
