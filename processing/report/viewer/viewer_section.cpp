#include "processing/report/viewer/viewer_section.h"

#include "processing/report/html.h"
#include "processing/report/viewer/packed_chunks.h"
#include "processing/report/viewer/page_files.h"

namespace lumitexel {

std::string viewer_section(const ViewerPage& page, std::size_t most_bytes) {
  const std::string title = "Interactive view";
  PackedChunks packed;
  packed.add_text("viewer-page", page.html);
  const std::string megabytes = std::to_string((packed.total_bytes() + 500'000) / 1'000'000) + " MB";
  if (packed.total_bytes() > most_bytes) {
    return html::section(title, "The interactive page of this model has " + megabytes + ", too much to be part of the report; make it with lumitexel view MODEL.", "");
  }
  return html::section(title,
                       "Turn the object, move the light, look at the stages of the fit and into single texels. It is inside this file and needs no network, "
                       "but a browser with WebGL 2.",
                       "<p><button id=\"open-viewer\">Open the viewer (" + megabytes +
                           ")</button></p>\n<div id=\"viewer-frame\"></div>\n" + packed.markup() + "<script>" + page_file("section.js") + "</script>\n");
}

}  // namespace lumitexel
