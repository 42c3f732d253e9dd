// The interactive viewer as one self-contained HTML page that works offline, from a file: three.js and the data inside it, a shader that
// evaluates the model as processing/model/render_view.h does.
//
// Needs a browser with WebGL 2, float render targets and DecompressionStream (2023 and later). The model's atlas may be no larger than the
// browser's largest texture (mostly 16384). Shadows while something moves come from the same rays as at rest unless the frame rate is too
// low for it; the page says which.
#pragma once

#include <map>
#include <string>

#include "processing/calibration/calibrated_session.h"
#include "processing/model/model.h"
#include "rig/progress.h"

namespace lumitexel {

struct ViewerSubject {
  std::string name;  // the page's title
  const Model& model;
  const CalibratedSession* session = nullptr;  // with it texels show their samples
  // Samples go along of every n-th texel in both directions: 1 for all.
  int sample_lattice = 2;
};

struct ViewerPage {
  std::string html;
  std::map<std::string, std::size_t> bytes;  // by part of the page
  std::size_t textured_texels = 0, lumitexels = 0, samples = 0;  // the latter two: carried with their samples
};

// Throws BadInput if the session is not the one that the model was fitted to.
ViewerPage viewer_page(const ViewerSubject& subject, Progress& progress);

// The page inside another one, as an element: <iframe srcdoc="…">. For the report.
std::string viewer_frame(const ViewerPage& page, const std::string& title);

}  // namespace lumitexel
