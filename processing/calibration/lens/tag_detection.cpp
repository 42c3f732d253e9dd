#include "processing/calibration/lens/tag_detection.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "processing/calibration/lens/patch_fit.h"
#include "processing/calibration/lens/visible_picture.h"

namespace lumitexel {
namespace {

constexpr double kLeastEdge_px = 12.0;
constexpr double kCellsPerEdge = 8.0;  // tag36h11: 6 bits and the black border on both sides
using Corners = std::array<Eigen::Vector2d, 4>;

struct Found {
  int id;
  Corners corners;
};

std::vector<Found> find_tags(const GrayPicture& picture) {
  const std::unique_ptr<apriltag_family_t, decltype(&tag36h11_destroy)> family(tag36h11_create(), &tag36h11_destroy);
  const std::unique_ptr<apriltag_detector_t, decltype(&apriltag_detector_destroy)> detector(apriltag_detector_create(),
                                                                                            &apriltag_detector_destroy);
  apriltag_detector_add_family_bits(detector.get(), family.get(), 1);
  detector->quad_decimate = 1.0f;  // small tags count
  detector->nthreads = 1;
  image_u8_t view{picture.width, picture.height, picture.width, const_cast<std::uint8_t*>(picture.data.data())};
  const std::unique_ptr<zarray_t, decltype(&apriltag_detections_destroy)> detections(
      apriltag_detector_detect(detector.get(), &view), &apriltag_detections_destroy);
  apriltag_detector_clear_families(detector.get());
  std::vector<Found> found;
  for (int i = 0; i < zarray_size(detections.get()); ++i) {
    apriltag_detection_t* detection = nullptr;
    zarray_get(detections.get(), i, &detection);
    Found tag{detection->id, {}};
    // Lower left, lower right, upper right, upper left as printed, and with the project's pixel centres (both tested).
    for (std::size_t c = 0; c < 4; ++c) tag.corners[c] = {detection->p[c][0], detection->p[c][1]};
    found.push_back(tag);
  }
  return found;
}

struct Edge {
  Eigen::Vector2d from, along, outward;  // unit vectors
  double length;
  Edge(const Eigen::Vector2d& a, const Eigen::Vector2d& b) : from(a), length((b - a).norm()) {
    along = (b - a) / length;
    outward = {-along.y(), along.x()};  // the corners run counter-clockwise as one sees them, y down
  }
};

// Parameters: eight coordinates, blur, black, then the white at each corner.
constexpr Eigen::Index kBlur = 8, kBlack = 9, kWhite = 10, kParameters = 14;
using Bows = std::array<double, 4>;  // outward, in the middle of each edge

// How far a straight edge's picture lies outside the chord between its ends.
Bows bows_of(const Corners& corners, const std::optional<CameraModel>& lens) {
  Bows bows{};
  if (!lens) return bows;
  for (std::size_t e = 0; e < 4; ++e) {
    const Eigen::Vector2d &a = corners[e], &b = corners[(e + 1) % 4];
    // Towards the chord's middle, turned into the plane of the two rays: there lies the straight edge.
    const Eigen::Vector3d across = lens->unproject(a).cross(lens->unproject(b)).normalized();
    const Eigen::Vector3d middle = lens->unproject(0.5 * (a + b));
    const Eigen::Vector2d on_edge = lens->project(middle - across.dot(middle) * across);
    bows[e] = Edge(a, b).outward.dot(on_edge - a);
  }
  return bows;
}

double edge_profile(const PatchSample& sample, const Bows& bows, const Eigen::VectorXd& p, Eigen::VectorXd& gradient) {
  const Eigen::Index i = sample.part, j = (i + 1) % 4;
  const Edge edge(p.segment<2>(2 * i), p.segment<2>(2 * j));
  const Eigen::Vector2d from_corner = sample.pixel - edge.from;
  const double t = edge.along.dot(from_corner) / edge.length;
  const double distance = edge.outward.dot(from_corner) - 4.0 * t * (1.0 - t) * bows[static_cast<std::size_t>(i)];
  const double blur = p[kBlur], share = normal_integral(distance / blur);
  const double white = (1.0 - t) * p[kWhite + i] + t * p[kWhite + j];
  const double slope = (white - p[kBlack]) * normal_density(distance / blur) / blur;
  gradient.setZero();
  gradient.segment<2>(2 * i) = -slope * (1.0 - t) * edge.outward;
  gradient.segment<2>(2 * j) = -slope * t * edge.outward;
  gradient[kBlur] = -slope * distance / blur;
  gradient[kBlack] = 1.0 - share;
  gradient[kWhite + i] = share * (1.0 - t);
  gradient[kWhite + j] = share * t;
  return p[kBlack] + (white - p[kBlack]) * share;
}

// Samples in a band about each edge that holds nothing but border and margin. Pixels near a corner see two edges.
std::vector<PatchSample> edge_samples(const MosaicRadiance& image, const Corners& corners) {
  constexpr double kNearCorner_px = 2.5, kWidestBand_px = 4.0, kLeastBand_px = 1.0;
  constexpr double kBitsBlur_px = 1.5,
                   kMarginBlur_px = 0.5;  // how far inside bits, and outside what follows the margin, may show
  const Eigen::Vector2d reach(kWidestBand_px, kWidestBand_px);
  std::vector<PatchSample> samples;
  for (int e = 0; e < 4; ++e) {
    const Eigen::Vector2d &a = corners[static_cast<std::size_t>(e)],
                          &b = corners[static_cast<std::size_t>((e + 1) % 4)];
    const Eigen::Vector2d &c = corners[static_cast<std::size_t>((e + 2) % 4)],
                          &d = corners[static_cast<std::size_t>((e + 3) % 4)];
    const Edge edge(a, b);
    const double depth = std::min(std::abs(edge.outward.dot(c - a)), std::abs(edge.outward.dot(d - a)));
    const double cell = depth / kCellsPerEdge;
    const double inside = std::clamp(cell - kBitsBlur_px, kLeastBand_px, kWidestBand_px);
    const double outside = std::clamp(cell - kMarginBlur_px, kLeastBand_px, kWidestBand_px);
    const double skipped = std::min(kNearCorner_px, 0.15 * edge.length);
    for (PatchSample sample : patch_samples(image, a.cwiseMin(b) - reach, a.cwiseMax(b) + reach)) {
      const double across = edge.outward.dot(sample.pixel - a), along = edge.along.dot(sample.pixel - a);
      if (across < -inside || across > outside || along < skipped || along > edge.length - skipped) continue;
      sample.part = e;
      samples.push_back(sample);
    }
  }
  return samples;
}

Eigen::VectorXd edge_start(const std::vector<PatchSample>& samples, const Corners& corners) {
  Eigen::VectorXd start = Eigen::VectorXd::Zero(kParameters);
  for (Eigen::Index c = 0; c < 4; ++c) start.segment<2>(2 * c) = corners[static_cast<std::size_t>(c)];
  start[kBlur] = 0.7;
  start[kBlack] = std::numeric_limits<double>::infinity();
  for (const PatchSample& sample : samples) {
    start[kBlack] = std::min(start[kBlack], sample.value);
    double& white = start[kWhite + sample.part];
    white = std::max(white, sample.value);
  }
  return start;
}

std::optional<DetectedTag> refined(const MosaicRadiance& image, const Found& found,
                                   const std::optional<CameraModel>& lens) {
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < 4; ++c) {
    shortest = std::min(shortest, (found.corners[(c + 1) % 4] - found.corners[c]).norm());
    const Eigen::Vector2d& p = found.corners[c];
    if (!p.allFinite() || p.x() < 1 || p.y() < 1 || p.x() > image.width - 1 || p.y() > image.height - 1)
      return std::nullopt;
  }
  if (shortest < kLeastEdge_px) return std::nullopt;
  Corners corners = found.corners;
  std::optional<PatchFit> fit;
  for (int round = 0; round < 2; ++round) {  // the band follows the edges that were found
    const auto samples = edge_samples(image, corners);
    if (samples.empty()) return std::nullopt;
    const Bows bows = bows_of(corners, lens);
    fit = fit_patch(samples, edge_start(samples, corners),
                    [&bows](const PatchSample& sample, const Eigen::VectorXd& p, Eigen::VectorXd& gradient) {
                      return edge_profile(sample, bows, p, gradient);
                    });
    if (!fit || !(fit->parameters[kBlur] > 0.05) || fit->parameters[kBlur] > shortest / kCellsPerEdge)
      return std::nullopt;
    for (Eigen::Index c = 0; c < 4; ++c) corners[static_cast<std::size_t>(c)] = fit->parameters.segment<2>(2 * c);
  }
  for (std::size_t c = 0; c < 4; ++c) {
    if ((corners[c] - found.corners[c]).norm() > std::max(1.0, 0.1 * shortest)) return std::nullopt;
  }
  DetectedTag tag;
  tag.id = found.id;
  tag.corners_px = corners;
  tag.covariance_px2 = fit->covariance.topLeftCorner<8, 8>();
  tag.sigma_px = std::sqrt(tag.covariance_px2.diagonal().mean());
  tag.blur_px = fit->parameters[kBlur];
  tag.reduced_chi2 = fit->reduced_chi2;
  tag.found_px = found.corners;
  return tag;
}

}  // namespace

std::vector<DetectedTag> detect_tags(const MosaicRadiance& image, const std::optional<CameraModel>& lens) {
  std::vector<DetectedTag> tags;
  if (image.width < kLeastEdge_px || image.height < kLeastEdge_px) return tags;
  for (const Found& found : find_tags(visible_picture(image))) {
    if (auto tag = refined(image, found, lens)) tags.push_back(*tag);
  }
  std::sort(tags.begin(), tags.end(), [](const DetectedTag& a, const DetectedTag& b) {
    return a.id != b.id ? a.id < b.id : a.corners_px[0].x() < b.corners_px[0].x();
  });
  return tags;
}

}  // namespace lumitexel
