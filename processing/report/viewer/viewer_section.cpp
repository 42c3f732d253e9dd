#include "processing/report/viewer/viewer_section.h"

#include "processing/report/html.h"
#include "processing/report/viewer/packed_chunks.h"
#include "processing/report/viewer/page_files.h"

namespace lumitexel {
namespace {

constexpr const char* kTitle = "Interactive view";

std::string of_samples(std::size_t every, std::size_t most_bytes) {
  if (every == 0) return "A click shows what the model holds there; lumitexel view MODEL --session SESSION makes a page with the samples of the photographs, too.";
  const std::string shows = "A click shows what the model holds there and the samples of its photographs, each beside its prediction, with what it counted in the fit";
  if (every == 1) return shows + ".";
  return shows + ": of one surface point in " + std::to_string(every) + ", so that the viewer stays within " + std::to_string(most_bytes / 1'000'000) +
         " MB. lumitexel view MODEL --session SESSION makes a page with more of them.";
}

}  // namespace

std::string viewer_left_out(std::size_t triangles) {
  return html::section(kTitle, "The mesh has " + std::to_string(triangles) + " triangles; the interactive page holds at most " + std::to_string(kMostViewerTriangles) +
                                   ". Fit to a coarser mesh to have it.", "");
}

std::string viewer_section(const ViewerPage& page, std::size_t most_bytes) {
  PackedChunks packed;
  packed.add_text("viewer-page", page.html);
  const std::string megabytes = std::to_string((packed.total_bytes() + 500'000) / 1'000'000) + " MB";
  if (packed.total_bytes() > most_bytes) {
    return html::section(kTitle, "The interactive page of this model has " + megabytes + ", too much to be part of the report; make it with lumitexel view MODEL.", "");
  }
  return html::section(kTitle,
                       "Turn the object, move the light, look at the stages of the fit and into single texels. It is inside this file and needs no network, "
                       "but a browser with WebGL 2. " + of_samples(page.every, most_bytes),
                       "<p><button id=\"open-viewer\">Open the viewer (" + megabytes +
                           ")</button></p>\n<div id=\"viewer-frame\"></div>\n" + packed.markup() + "<script>" + page_file("section.js") + "</script>\n");
}

}  // namespace lumitexel
