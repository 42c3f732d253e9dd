// A view given on the command line instead of by a session.
#pragma once

#include <string>

#include "processing/calibration/calibrated_session.h"

namespace lumitexel {

struct ViewOptions {
  std::string
      camera;  // "eye;target;up;fov;WxH": three points x,y,z in metres, vertical field of view in degrees, pixels
  std::string light;  // "x,y,z" in metres
  std::string
      light_intensity;  // one number or one a channel; empty: a white diffuse surface at the target has radiance 1
};

// Throws BadInput naming the option and the part of it that cannot be used.
View parse_view(const ViewOptions& options, int channels);

}  // namespace lumitexel
