#include "processing/export/nearest_texel.h"

#include <limits>
#include <utility>

namespace lumitexel {

std::vector<std::size_t> nearest_known_texel(int width, int height, const std::vector<std::uint8_t>& known) {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> source(known.size(), kNone), queue;
  for (std::size_t t = 0; t < source.size(); ++t) {
    if (known[t] == 0) continue;
    source[t] = t;
    queue.push_back(t);
  }
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const std::size_t from = queue[head];
    const int x = static_cast<int>(from % static_cast<std::size_t>(width)), y = static_cast<int>(from / static_cast<std::size_t>(width));
    for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      if (x + dx < 0 || y + dy < 0 || x + dx >= width || y + dy >= height) continue;
      const std::size_t to = static_cast<std::size_t>(y + dy) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x + dx);
      if (source[to] != kNone) continue;
      source[to] = source[from];
      queue.push_back(to);
    }
  }
  for (std::size_t t = 0; t < source.size(); ++t) {
    if (source[t] == kNone) source[t] = t;
  }
  return source;
}

}  // namespace lumitexel
