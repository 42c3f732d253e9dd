// The texts of the import layout, joined into views.
#pragma once

#include <string>
#include <vector>

#include "processing/calibration/calibrated_session.h"

namespace lumitexel {

struct NamedText {
  std::string text;
  std::string where;  // the file, for errors
};

// A view for each image of images.txt, in its order, with three intensities and no photograph yet. Throws BadInput
// naming file, line and field for what the parsers of colmap_text.h and lights_csv.h refuse, for an image without a
// light and a light without an image, and if every view is held out.
std::vector<View> join_views(const NamedText& cameras_txt, const NamedText& images_txt, const NamedText& lights_csv);

// Leaves the light an intensity for each of 1 or 3 channels; a grayscale camera sees the mean of the three.
void reduce_intensity(Light& light, int channels);

// Whether any vertex lies in front of the camera and inside its frame.
bool has_in_sight(const View& view, const Mesh& mesh);

}  // namespace lumitexel
