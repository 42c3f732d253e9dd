// The interactive viewer as one self-contained HTML page that works offline, from a file: three.js and the data inside it, a shader that
// evaluates the model as processing/model/render_view.h does.
//
// Needs a browser with WebGL 2, float render targets and DecompressionStream (2023 and later). The model's atlas may be no larger than the
// browser's largest texture (mostly 16384 a side). What is lost on the way: viewer_model.h; the shader works in single precision.
#pragma once

#include <limits>
#include <map>
#include <string>

#include "processing/model/model.h"
#include "processing/report/viewer/lumitexel_records.h"

namespace lumitexel {

struct ViewerPage {
  std::string html;
  std::map<std::string, std::size_t> bytes;  // of the page, by what they hold
  std::size_t textured_texels = 0;
  std::size_t every = 0;                     // k where every k-th lumitexel is in it with its samples; 0: none
};

// What the photographs say, for the page to show beside the model.
struct ViewerSamples {
  const CalibratedSession& session;
  const LumitexelRecords& records;  // of the model and the session
  // What the whole page may have with them: as many lumitexels go in as fit (every k-th), none if hardly any would. Samples alone never have more
  // than kMostSampleBytes.
  std::size_t most_page_bytes = std::numeric_limits<std::size_t>::max();
};

// The page's hierarchy of boxes (page/bvh.js) has 8 times the number of a leaf's first triangle and their count in one single-precision number, which
// holds whole numbers up to 2^24: of larger meshes it would miss triangles.
inline constexpr std::size_t kMostViewerTriangles = std::size_t{1} << 21;

// Throws BadInput where the mesh has more. samples: null for a page of the model alone. sky: of viewer_sky.h, at most kMostSkyWidth wide; null for the built-in one.
ViewerPage viewer_page(const std::string& title, const Model& model, const ViewerSamples* samples = nullptr, const Image* sky = nullptr);

}  // namespace lumitexel
