#include "processing/surface/coarser_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "processing/surface/layout_sites.h"
#include "processing/surface/pack_rectangles.h"
#include "processing/surface/texture_charts.h"

namespace lumitexel {
namespace {

constexpr int kGutter = 1;  // on every side of a chart, which is as far as a bilinear look-up reaches
constexpr int kReserved = 2;  // rows on top, for texel (0, 0) and its gutter
constexpr int kLargest = 16384;

struct Chart {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  int shift_x = 0, shift_y = 0;  // coarser texel = texel / 2^level + shift
  bool empty() const { return (high - low).minCoeff() <= 0.0; }
};

std::vector<Chart> charts_of(const Mesh& mesh, const std::vector<std::uint32_t>& chart, int width, int height) {
  std::vector<Chart> charts(chart.empty() ? 0 : *std::max_element(chart.begin(), chart.end()) + 1);
  for (std::size_t t = 0; t < chart.size(); ++t) {
    for (const std::uint32_t vertex : mesh.triangles[t]) {
      const Eigen::Vector2d texel = texel_of_vertex(mesh, vertex, width, height);
      charts[chart[t]].low = charts[chart[t]].low.cwiseMin(texel);
      charts[chart[t]].high = charts[chart[t]].high.cwiseMax(texel);
    }
  }
  return charts;
}

void repack_charts(const Mesh& mesh, int width, int height, int factor, CoarserLayout& layout) {
  const std::vector<std::uint32_t> chart = chart_of_triangle(mesh);
  std::vector<Chart> charts = charts_of(mesh, chart, width, height);
  std::vector<PackedRectangle> rectangles(charts.size());
  for (std::size_t i = 0; i < charts.size(); ++i) {
    if (charts[i].empty()) continue;  // takes no room
    rectangles[i].width = static_cast<int>(std::ceil(charts[i].high.x() / factor) - std::floor(charts[i].low.x() / factor)) + 2 * kGutter;
    rectangles[i].height = static_cast<int>(std::ceil(charts[i].high.y() / factor) - std::floor(charts[i].low.y() / factor)) + 2 * kGutter;
  }
  const PackedSize size = pack_rectangles(rectangles, 4, kLargest - kReserved);
  layout.width = size.width;
  layout.height = size.height + kReserved;
  for (std::size_t i = 0; i < charts.size(); ++i) {
    if (charts[i].empty()) continue;
    charts[i].shift_x = rectangles[i].x + kGutter - static_cast<int>(std::floor(charts[i].low.x() / factor));
    charts[i].shift_y = rectangles[i].y + kGutter + kReserved - static_cast<int>(std::floor(charts[i].low.y() / factor));
  }
  for (std::size_t t = 0; t < chart.size(); ++t) {
    const Chart& of = charts[chart[t]];
    for (const std::uint32_t vertex : mesh.triangles[t]) {
      Eigen::Vector2d texel(0.5, 0.5);
      if (!of.empty()) texel = texel_of_vertex(mesh, vertex, width, height) / factor + Eigen::Vector2d(of.shift_x, of.shift_y);
      layout.mesh.texcoords[vertex] = {texel.x() / layout.width, 1.0 - texel.y() / layout.height};
    }
  }
}

}  // namespace

CoarserLayout coarser_layout(const Mesh& mesh, int width, int height, int level, bool repack) {
  const int factor = 1 << level;
  CoarserLayout layout{mesh, std::max(1, width / factor), std::max(1, height / factor), {}};
  if (repack) repack_charts(mesh, width, height, factor, layout);
  for (const LayoutSite& site : layout_sites(mesh, width, height).sites) {
    const auto& [a, b, c] = mesh.triangles[site.triangle];
    const auto at = [&](std::uint32_t vertex) { return texel_of_vertex(layout.mesh, vertex, layout.width, layout.height); };
    const Eigen::Vector2d texel = (1.0 - site.u - site.v) * at(a) + site.u * at(b) + site.v * at(c);
    const int x = std::clamp(static_cast<int>(std::floor(texel.x())), 0, layout.width - 1);
    const int y = std::clamp(static_cast<int>(std::floor(texel.y())), 0, layout.height - 1);
    layout.parts.emplace_back(site.texel, static_cast<std::uint32_t>(y * layout.width + x));
  }
  return layout;
}

}  // namespace lumitexel
