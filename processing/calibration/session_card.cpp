#include "processing/calibration/session_card.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "drivers/error.h"
#include "processing/calibration/session_lights.h"

namespace lumitexel {
namespace {

constexpr double kMedianOverMean = 1.25;  // standard deviation of a median over that of a mean
constexpr double kLeastSigma_px = 0.005;  // what averaging cannot take away

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

SeenTag pooled(int id, const std::vector<const DetectedTag*>& sightings) {
  SeenTag tag{id, {}, 0.0};
  for (std::size_t corner = 0; corner < 4; ++corner) {
    std::vector<double> xs, ys;
    for (const DetectedTag* seen : sightings) {
      xs.push_back(seen->corners_px[corner].x());
      ys.push_back(seen->corners_px[corner].y());
    }
    tag.corners_px[corner] = {median(xs), median(ys)};
  }
  for (const DetectedTag* seen : sightings) tag.sigma_px += seen->sigma_px;
  const auto count = static_cast<double>(sightings.size());
  tag.sigma_px = std::max(kLeastSigma_px, kMedianOverMean * tag.sigma_px / count / std::sqrt(count));
  return tag;
}

std::vector<SeenTag> pooled_tags(const std::vector<std::vector<DetectedTag>>& tags) {
  std::map<int, std::vector<const DetectedTag*>> by_id;
  for (const auto& view : tags) {
    for (const DetectedTag& tag : view) by_id[tag.id].push_back(&tag);
  }
  std::vector<SeenTag> seen;
  for (const auto& [id, sightings] : by_id) seen.push_back(pooled(id, sightings));
  return seen;
}

std::vector<TagDescription> tags_of_card(const RigDescription& rig) {
  std::vector<TagDescription> tags;
  for (const TagDescription& tag : rig.tags) {
    const auto& ids = rig.gray_card.tag_ids;
    if (std::find(ids.begin(), ids.end(), tag.id) != ids.end()) tags.push_back(tag);
  }
  return tags;
}

}  // namespace

SessionCard::SessionCard(const CapturedInputs& in, const CameraModel& camera,
                         const std::vector<std::vector<DetectedTag>>& tags, const CalibrationOptions& options)
    : in_(in), camera_(camera) {
  const std::vector<TagDescription> on_card = tags_of_card(in.rig);
  if (on_card.empty() || !options.takes(CalibrationStep::CardPose)) return;
  const CardPose pose = solve_card_pose(camera, on_card, pooled_tags(tags));
  if (pose.found && !pose.ambiguous) pose_ = pose;
}

std::optional<CardReading> SessionCard::read(const MosaicRadiance& picture, const ArmPrediction& light) const {
  const Eigen::Isometry3d& camera_from_rig = in_.rig.camera.camera_from_rig;
  const GrayCardDescription& card = in_.rig.gray_card;
  CardReading reading;
  GrayCardIntensity measured;
  try {
    if (pose_) {
      const Eigen::Matrix3d turn = camera_from_rig.linear();
      PosedCardIntensity posed =
          measure_posed_card(picture, camera_, *pose_, card, camera_from_rig * light.position_in_rig,
                             turn * light.covariance * turn.transpose());
      measured = std::move(posed.measured);
      reading.pose_sigma = posed.pose_sigma;
      reading.light_sigma = posed.light_sigma;
      const Eigen::Isometry3d rig_from_card = camera_from_rig.inverse() * pose_->camera_from_card;
      reading.card_in_rig = rig_from_card * card.centre_in_rig;
      reading.normal_in_rig = rig_from_card.linear() * card.normal_in_rig.normalized();
    } else {
      measured = measure_gray_card(picture, camera_, camera_from_rig, card, light.position_in_rig);
      // Intensity goes with the distance squared.
      reading.light_sigma =
          2.0 * per_axis_sigma(light.covariance) / (light.position_in_rig - card.centre_in_rig).norm();
      reading.card_in_rig = card.centre_in_rig;
      reading.normal_in_rig = card.normal_in_rig.normalized();
    }
  } catch (const BadInput&) {
    return std::nullopt;
  }
  reading.intensity = std::move(measured.intensity);
  reading.pixel_scatter = std::move(measured.pixel_scatter);
  reading.pixel_sigma = *std::max_element(measured.relative_sigma.begin(), measured.relative_sigma.end());
  return reading;
}

}  // namespace lumitexel
