// The tags that a captured session's views show.
#pragma once

#include <vector>

#include "processing/calibration/captured_inputs.h"
#include "processing/calibration/lens/tag_detection.h"
#include "processing/calibration/radiance_reader.h"
#include "rig/progress.h"

namespace lumitexel {

// By view, in the plan's order: the tags seen in its ring-flash shot, which lights them evenly and from where it looks, so
// that nothing lies in shadow. Only tags that the rig's description names; none of them where an id is seen twice.
std::vector<std::vector<DetectedTag>> detect_session_tags(const RadianceReader& reader,
                                                          const std::vector<ViewFrames>& views,
                                                          const std::vector<TagDescription>& tags,
                                                          const CameraModel& camera, Progress& progress);

}  // namespace lumitexel
