#include "processing/surface/pack_rectangles.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "drivers/error.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#define STBRP_STATIC
#define STB_RECT_PACK_IMPLEMENTATION
#include <stb/stb_rect_pack.h>
#pragma GCC diagnostic pop

namespace lumitexel {
namespace {

bool pack(std::vector<stbrp_rect>& rectangles, int edge) {
  std::vector<stbrp_node> nodes(static_cast<std::size_t>(edge));
  stbrp_context context;
  stbrp_init_target(&context, edge, edge, nodes.data(), edge);
  return stbrp_pack_rects(&context, rectangles.data(), static_cast<int>(rectangles.size())) == 1;
}

}  // namespace

PackedSize pack_rectangles(std::vector<PackedRectangle>& rectangles, int smallest, int largest) {
  std::vector<stbrp_rect> packed(rectangles.size());
  double area = 0.0;
  for (std::size_t i = 0; i < rectangles.size(); ++i) {
    packed[i] = {};
    packed[i].id = static_cast<int>(i);
    packed[i].w = rectangles[i].width;
    packed[i].h = rectangles[i].height;
    area += static_cast<double>(rectangles[i].width) * rectangles[i].height;
  }
  int edge = std::max(smallest, static_cast<int>(std::sqrt(area) * 1.05));
  while (edge <= largest && !pack(packed, edge)) edge = std::max(edge + 1, edge * 6 / 5);
  if (edge > largest) {
    throw Error("texture atlas: " + std::to_string(rectangles.size()) + " patches do not fit into " + std::to_string(largest) + " x " +
                std::to_string(largest) + " texels");
  }
  PackedSize size{edge, 0};
  for (const stbrp_rect& rectangle : packed) {
    PackedRectangle& found = rectangles[static_cast<std::size_t>(rectangle.id)];
    found.x = rectangle.x;
    found.y = rectangle.y;
    size.height = std::max(size.height, rectangle.y + rectangle.h);
  }
  return size;
}

}  // namespace lumitexel
