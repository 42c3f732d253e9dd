#include "processing/calibration/session_tags.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

namespace lumitexel {
namespace {

std::vector<DetectedTag> described_once(const std::vector<DetectedTag>& seen, const std::vector<TagDescription>& tags) {
  std::vector<DetectedTag> kept;
  for (const DetectedTag& tag : seen) {
    const auto same_id = [&](const auto& other) { return other.id == tag.id; };
    if (std::none_of(tags.begin(), tags.end(), same_id)) continue;
    if (std::count_if(seen.begin(), seen.end(), same_id) == 1) kept.push_back(tag);
  }
  return kept;
}

}  // namespace

std::vector<std::vector<DetectedTag>> detect_session_tags(const RadianceReader& reader,
                                                          const std::vector<ViewFrames>& views,
                                                          const std::vector<TagDescription>& tags,
                                                          const CameraModel& camera, Progress& progress) {
  std::vector<std::vector<DetectedTag>> seen(views.size());
  if (tags.empty()) return seen;
  progress.begin("tags", static_cast<std::int64_t>(views.size()), "views");
  std::atomic<std::int64_t> done{0};
  tbb::parallel_for(std::size_t{0}, views.size(), [&](std::size_t v) {
    seen[v] = described_once(detect_tags(reader.read(views[v].spheres.ring), camera), tags);
    progress.update(++done);
  });
  return seen;
}

}  // namespace lumitexel
