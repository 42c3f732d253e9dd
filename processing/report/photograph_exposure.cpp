#include "processing/report/photograph_exposure.h"

#include <algorithm>
#include <map>

namespace lumitexel {
namespace {

std::map<std::string, std::vector<double>> bracket_exposures_s(const SessionStore& store) {
  std::map<std::int64_t, std::string> view_of_shot;
  for (const Shot& shot : store.shots()) {
    if (shot.kind == ShotKind::Object) view_of_shot[shot.id] = shot.view;
  }
  std::map<std::string, std::vector<double>> exposures_s;
  for (const FrameRecord& frame : store.frames()) {
    const auto view = view_of_shot.find(frame.shot_id);
    if (view != view_of_shot.end()) exposures_s[view->second].push_back(frame.reported.exposure_s);
  }
  for (auto& [view, bracket] : exposures_s) std::sort(bracket.begin(), bracket.end());
  return exposures_s;
}

}  // namespace

PhotographExposure exposure_of(const RadianceImage& photograph) {
  PhotographExposure exposure;
  std::vector<double> values;
  double object = 0.0, clipped = 0.0, dark = 0.0;
  const auto channels = static_cast<std::size_t>(photograph.radiance.channels);
  for (std::size_t pixel = 0; pixel < photograph.flags.size(); ++pixel) {
    const std::uint8_t flags = photograph.flags[pixel];
    if (flags & kPixelOutside) continue;
    object += 1.0;
    clipped += (flags & kPixelSaturated) != 0;
    dark += (flags & kPixelDark) != 0;
    if (flags & kUnusablePixel) continue;
    double sum = 0.0;
    for (std::size_t c = 0; c < channels; ++c) sum += photograph.radiance.data[channels * pixel + c];
    values.push_back(sum / static_cast<double>(channels));
  }
  if (object > 0.0) {
    exposure.clipped_share = clipped / object;
    exposure.dark_share = dark / object;
  }
  for (std::size_t i = 0; i < kRadianceShares.size() && !values.empty(); ++i) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(kRadianceShares[i] * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    exposure.radiance[i] = *at;
  }
  return exposure;
}

std::vector<PhotographExposure> photograph_exposures(const SessionStore& store, const CalibratedSession& session, Progress& progress) {
  const auto brackets_s = bracket_exposures_s(store);
  std::vector<PhotographExposure> exposures;
  progress.begin("exposures", static_cast<std::int64_t>(session.views.size()), "views");
  for (const View& view : session.views) {
    PhotographExposure exposure = exposure_of(read_radiance_image(view.photograph));
    exposure.view = view.name;
    exposure.heldout = view.heldout;
    const auto bracket = brackets_s.find(view.name);
    if (bracket != brackets_s.end()) exposure.exposure_s = bracket->second;
    exposures.push_back(std::move(exposure));
    progress.update(static_cast<std::int64_t>(exposures.size()));
  }
  return exposures;
}

}  // namespace lumitexel
