// The viewer inside the report: the whole page (viewer_page.h) packed into a section of it, which a button unpacks into a frame.
//
// Packed it is about as large as the page itself, some 10 bytes a texel, and costs nothing until it is opened.
#pragma once

#include <string>

#include "processing/report/viewer/viewer_page.h"

namespace lumitexel {

// Beyond this the section only says how to make the page: a report should still go by mail.
inline constexpr std::size_t kMostViewerBytes = 16'000'000;

// What stands in its place for a mesh of so many triangles, more than kMostViewerTriangles.
std::string viewer_left_out(std::size_t triangles);

// HTML. Where the page has samples it says of how many surface points.
std::string viewer_section(const ViewerPage& page, std::size_t most_bytes = kMostViewerBytes);

}  // namespace lumitexel
