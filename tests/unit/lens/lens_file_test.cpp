#include "processing/calibration/lens/lens_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "processing/calibration/lens/lens_pictures.h"
#include "processing/image/raster_file.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/lens/board_placements.h"

namespace lumitexel {
namespace {

CameraModel lens() {
  CameraModel camera{1024, 768, 2950.0, 2951.0, 516.3, 379.8};
  camera.k1 = -0.18, camera.k2 = 0.15, camera.p1 = 0.0004, camera.p2 = -0.0003;
  return camera;
}

const LensCalibration& calibration() {
  static const LensCalibration result = calibrate_lens(1024, 768, placements(lens(), wide_board(), 8, 0.05, 1));
  return result;
}

LensRecord record() {
  LensRecord r = lens_record(calibration());
  r.camera_name = "camera 1, 50 mm, f/8";
  r.mosaic = Mosaic::Rggb;
  r.made_utc_s = 1'790'000'000;
  r.vignetting = Vignetting{516.3, 379.8, 640.0, {-0.3, 0.1, 0.0}, Eigen::Matrix3d::Identity()};
  return r;
}

std::filesystem::path file_path(const std::string& name) { return std::filesystem::path(testing::TempDir()) / name; }

TEST(LensFile, readsBackWhatWasWrittenBitForBit) {
  const auto path = file_path("lens_round_trip.json");
  write_lens_file(path, record());
  const LensRecord back = read_lens_file(path);
  EXPECT_EQ(lens_fingerprint(back), lens_fingerprint(record()));
  EXPECT_EQ(lens_vector(back.camera), lens_vector(record().camera));
  EXPECT_EQ(back.covariance, record().covariance);
  EXPECT_EQ(back.coverage.counts, record().coverage.counts);
  EXPECT_EQ(back.boards_used, 8);
  ASSERT_TRUE(back.vignetting);
  EXPECT_EQ(back.vignetting->terms, record().vignetting->terms);
}

TEST(LensFile, aChangedNumberIsFound) {
  const auto path = file_path("lens_changed.json");
  write_lens_file(path, record());
  std::string text;
  {
    std::ifstream in(path);
    text.assign(std::istreambuf_iterator<char>(in), {});
  }
  const auto at = text.find("\"made_utc_s\": 1790000000");
  ASSERT_NE(at, std::string::npos);
  text[at + 15] = '2';
  std::ofstream(path) << text;
  EXPECT_THROW(read_lens_file(path), Corrupt);
  std::ofstream(path) << "{";
  EXPECT_THROW(read_lens_file(path), Corrupt);
  EXPECT_BAD_INPUT(read_lens_file(file_path("no_such_lens.json")), "no_such_lens.json");
}

TEST(LensFile, fingerprintFollowsEverythingThatMatters) {
  const std::string one = lens_fingerprint(record());
  LensRecord other = record();
  other.camera.k1 = std::nextafter(other.camera.k1, 1.0);
  EXPECT_NE(lens_fingerprint(other), one);
  other = record(), other.camera_name = "camera 2";
  EXPECT_NE(lens_fingerprint(other), one);
  other = record(), other.vignetting.reset();
  EXPECT_NE(lens_fingerprint(other), one);
}

TEST(LensFile, expiresAndNamesAnotherCamera) {
  const LensRecord r = record();
  EXPECT_FALSE(lens_expired(r, r.made_utc_s + 30 * 86400 - 1));
  EXPECT_TRUE(lens_expired(r, r.made_utc_s + 30 * 86400));
  CameraLimits limits;
  limits.width_px = 1024, limits.height_px = 768, limits.mosaic = Mosaic::Rggb;
  EXPECT_EQ(lens_mismatch(r, "", limits), "");
  EXPECT_NE(lens_mismatch(r, "camera 2", limits).find("camera 2"), std::string::npos);
  limits.width_px = 2048;
  EXPECT_NE(lens_mismatch(r, "", limits).find("2048 x 768"), std::string::npos);
}

// Shapes only; set LUMITEXEL_LENS_PICTURES to a folder to look at them.
TEST(LensPictures, haveTheirShape) {
  double magnification = 0;
  const Image pictures[] = {coverage_picture(calibration(), placements(lens(), wide_board(), 8, 0.05, 1), 640),
                            distortion_picture(lens(), 640, &magnification),
                            vignetting_picture(*record().vignetting, lens(), 640, 0.6)};
  for (const Image& picture : pictures) {
    EXPECT_EQ(picture.width, 640);
    EXPECT_EQ(picture.height, 480);
    EXPECT_EQ(picture.channels, 3);
    for (const float v : picture.data) ASSERT_TRUE(v >= 0.0f && v <= 1.0f);
  }
  EXPECT_GE(magnification, 1.0);
  if (const char* folder = std::getenv("LUMITEXEL_LENS_PICTURES")) {
    const std::string names[] = {"coverage.png", "distortion.png", "vignetting.png"};
    for (std::size_t i = 0; i < 3; ++i) write_png8(std::filesystem::path(folder) / names[i], pictures[i]);
  }
}

}  // namespace
}  // namespace lumitexel
