// A view given on the command line instead of by a session.
#pragma once

#include <string>
#include <vector>

#include "processing/calibration/calibrated_session.h"

namespace lumitexel {

struct ViewOptions {
  std::string
      camera;  // "eye;target;up;fov;WxH": three points x,y,z in metres, vertical field of view in degrees, pixels
  std::string light;  // "x,y,z" in metres
  std::string
      light_intensity;  // one number or one a channel; empty: a white diffuse surface at the target has radiance 1
  std::string directional;  // "x,y,z" towards the light, of any length
  std::string directional_irradiance;  // one number or one a channel; empty: a white diffuse surface that faces it has radiance 1
};

// The view of a camera, without a light. Throws BadInput naming the option and the part of it that cannot be used.
View parse_camera(const ViewOptions& options);

// The point light and the directional one, as far as they are given. Without --camera there is no target, and a point light's
// intensity has to be given. Throws BadInput as above.
std::vector<Light> parse_lamps(const ViewOptions& options, int channels);

// "x,y,z"; `where` names the option.
Eigen::Vector3d parse_vector(const std::string& text, const std::string& where);

}  // namespace lumitexel
