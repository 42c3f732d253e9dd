#include "processing/calibration/import/colmap_text.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/bad_input_matcher.h"

namespace lumitexel {
namespace {

const std::string kCameras =
    "# a comment\n"
    "1 PINHOLE 800 600 1100.5 1101.5 402 299\n"
    "\n"
    "2 OPENCV 640 480 500 501 320 240 0.1 -0.2 0.003 -0.004\r\n"
    "7 SIMPLE_RADIAL 640 480 500 320 240 0.05\n";

std::vector<PosedImage> parse_images(const std::string& text) {
  return parse_images_txt(text, "images.txt", parse_cameras_txt(kCameras, "cameras.txt"));
}

TEST(CamerasTxt, EachModelsParametersGoWhereTheyBelong) {
  const auto cameras = parse_cameras_txt(kCameras, "cameras.txt");
  ASSERT_EQ(cameras.size(), 3u);
  const CameraModel& pinhole = cameras.at(1);
  EXPECT_EQ(pinhole.width_px, 800);
  EXPECT_EQ(pinhole.height_px, 600);
  EXPECT_EQ(pinhole.focal_x_px, 1100.5);
  EXPECT_EQ(pinhole.focal_y_px, 1101.5);
  EXPECT_EQ(pinhole.principal_x_px, 402.0);
  EXPECT_EQ(pinhole.principal_y_px, 299.0);
  EXPECT_EQ(pinhole.k1, 0.0);
  const CameraModel& opencv = cameras.at(2);
  EXPECT_EQ(opencv.k1, 0.1);
  EXPECT_EQ(opencv.k2, -0.2);
  EXPECT_EQ(opencv.p1, 0.003);
  EXPECT_EQ(opencv.p2, -0.004);
  const CameraModel& radial = cameras.at(7);
  EXPECT_EQ(radial.focal_x_px, 500.0);
  EXPECT_EQ(radial.focal_y_px, 500.0);
  EXPECT_EQ(radial.principal_y_px, 240.0);
  EXPECT_EQ(radial.k1, 0.05);
}

TEST(CamerasTxt, BadFieldsAreNamed) {
  const auto parse = [](const std::string& text) { return parse_cameras_txt(text, "c.txt"); };
  EXPECT_BAD_INPUT(parse("# nothing\n"), "c.txt", "no camera");
  EXPECT_BAD_INPUT(parse("\n1 FISHEYE 8 6 1 2 3 4\n"), "c.txt:2", "MODEL", "FISHEYE");
  EXPECT_BAD_INPUT(parse("1 PINHOLE 8 6 1 2 3\n"), "c.txt:1", "PARAMS", "4 for PINHOLE");
  EXPECT_BAD_INPUT(parse("1 PINHOLE 8 6 1 2 3 4 5\n"), "c.txt:1", "PARAMS");
  EXPECT_BAD_INPUT(parse("1 PINHOLE 8 6 1 2 nan 4\n"), "c.txt:1", "cx", "nan");
  EXPECT_BAD_INPUT(parse("1 PINHOLE 8 0 1 2 3 4\n"), "c.txt:1", "HEIGHT");
  EXPECT_BAD_INPUT(parse("1 PINHOLE 8.5 6 1 2 3 4\n"), "c.txt:1", "WIDTH", "8.5");
  EXPECT_BAD_INPUT(parse("1 PINHOLE 8 6 0 2 3 4\n"), "c.txt:1", "fx");
  EXPECT_BAD_INPUT(parse("1 PINHOLE 8 6 1 2 3 4\n1 PINHOLE 8 6 1 2 3 4\n"), "c.txt:2", "CAMERA_ID", "twice");
}

TEST(ImagesTxt, PosesAreCameraFromWorldWithTheQuaternionsRealPartFirst) {
  const double half = std::sqrt(0.5);  // a quarter turn about z
  const auto images = parse_images("# c\n3 " + std::to_string(half) + " 0 0 " + std::to_string(half) +
                                   " 1 2 3 1 sub folder/a b.exr\n\n9 1 0 0 0 0 0 0 7 b.png\n10.5 20.5 -1 1 2 3\n");
  ASSERT_EQ(images.size(), 2u);
  EXPECT_EQ(images[0].name, "sub folder/a b.exr");
  EXPECT_EQ(images[0].place, "images.txt:2");
  EXPECT_EQ(images[1].camera_id, 7);
  // Six decimals in the text, but the quaternion is made unit.
  const Eigen::Vector3d turned = images[0].camera_from_world * Eigen::Vector3d::UnitX();
  EXPECT_LT((turned - Eigen::Vector3d(1, 3, 3)).norm(), 1e-12);
}

TEST(ImagesTxt, TheLastPointsLineMayBeMissing) { EXPECT_EQ(parse_images("1 1 0 0 0 0 0 0 1 a.exr").size(), 1u); }

TEST(ImagesTxt, BadFieldsAreNamed) {
  EXPECT_BAD_INPUT(parse_images(""), "images.txt", "no image");
  EXPECT_BAD_INPUT(parse_images("1 1 0 0 0 0 0 0 1\n"), "images.txt:1", "NAME");
  EXPECT_BAD_INPUT(parse_images("1 1 0 0 0 0 x 0 1 a\n"), "images.txt:1", "TY", "'x'");
  EXPECT_BAD_INPUT(parse_images("1 1 0 0 0 0 inf 0 1 a\n"), "images.txt:1", "TY", "inf");
  EXPECT_BAD_INPUT(parse_images("1 2 0 0 0 0 0 0 1 a\n"), "images.txt:1", "QW", "length 1");
  EXPECT_BAD_INPUT(parse_images("1 0 0 0 0 0 0 0 1 a\n"), "images.txt:1", "QW");
  EXPECT_BAD_INPUT(parse_images("1 1 0 0 0 0 0 0 4 a\n"), "images.txt:1", "CAMERA_ID", "4");
  EXPECT_BAD_INPUT(parse_images("1 1 0 0 0 0 0 0 1 a\n\n2 1 0 0 0 0 0 0 1 a\n"), "images.txt:3", "NAME", "twice");
  // Without the lines of points every other image would be lost silently.
  EXPECT_BAD_INPUT(parse_images("1 1 0 0 0 0 0 0 1 a\n2 1 0 0 0 0 0 0 1 b\n"), "images.txt:2", "10 fields");
}

}  // namespace
}  // namespace lumitexel
