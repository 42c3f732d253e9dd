#include "processing/image/raster_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "rig/whole_file.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

TEST(RasterFile, SixteenBitsAndChannelOrderSurvive) {
  const TemporaryFolder folder;
  cv::Mat_<cv::Vec3w> bgr(1, 2);
  bgr(0, 0) = {3, 2, 65535};
  bgr(0, 1) = {300, 200, 100};
  for (const char* name : {"a.png", "a.tiff"}) {
    ASSERT_TRUE(cv::imwrite((folder / name).string(), bgr));
    const RasterImage image = read_raster(folder / name);
    EXPECT_EQ(image.maximum, 65535.0f);
    EXPECT_EQ(image.code_values.data, (std::vector<float>{65535, 2, 3, 100, 200, 300})) << name;
  }
}

TEST(RasterFile, GrayStaysOneChannelAndAlphaIsDropped) {
  const TemporaryFolder folder;
  cv::Mat_<unsigned char> gray(1, 2);
  gray(0, 0) = 0;
  gray(0, 1) = 255;
  cv::imwrite((folder / "gray.png").string(), gray);
  EXPECT_EQ(read_raster(folder / "gray.png").code_values.data, (std::vector<float>{0, 255}));
  cv::Mat_<cv::Vec4b> bgra(1, 1);
  bgra(0, 0) = {1, 2, 3, 4};
  cv::imwrite((folder / "alpha.png").string(), bgra);
  EXPECT_EQ(read_raster(folder / "alpha.png").code_values.data, (std::vector<float>{3, 2, 1}));
}

TEST(RasterFile, Png8ClipsAndRoundsAndNanIsBlack) {
  const TemporaryFolder folder;
  Image image(4, 1, 1);
  image.data = {-1.0f, 0.5f, 2.0f, std::nanf("")};
  write_png8(folder / "out.png", image);
  EXPECT_EQ(read_raster(folder / "out.png").code_values.data, (std::vector<float>{0, 128, 255, 0}));

  Image colour(1, 1, 3);
  colour.data = {1.0f, 0.0f, 0.2f};
  write_whole_file(folder / "colour.png", encode_png8(colour));
  EXPECT_EQ(read_raster(folder / "colour.png").code_values.data, (std::vector<float>{255, 0, 51}));
}

TEST(RasterFile, Png8KeepsAlphaLast) {
  const TemporaryFolder folder;
  Image image(1, 1, 4);
  image.data = {1.0f, 0.2f, 0.0f, 0.4f};
  write_png8(folder / "out.png", image);
  const cv::Mat bgra = cv::imread((folder / "out.png").string(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(bgra.channels(), 4);
  EXPECT_EQ(bgra.at<cv::Vec4b>(0, 0), cv::Vec4b(0, 51, 255, 102));
}

TEST(RasterFile, WhatIsNoWholeRasterIsNamed) {
  const TemporaryFolder folder;
  EXPECT_BAD_INPUT(read_raster(folder / "none.png"), "none.png", "no such file");
  std::ofstream(folder / "text.png") << "no image";
  EXPECT_BAD_INPUT(read_raster(folder / "text.png"), "text.png", "neither PNG nor TIFF");
  Image image(64, 64, 1);
  for (std::size_t i = 0; i < image.data.size(); ++i)
    image.data[i] = static_cast<float>(i * 2654435761u % 256u) / 255.0f;
  const std::string png = encode_png8(image);
  for (const double part : {0.2, 0.6, 0.95}) {
    write_whole_file(folder / "cut.png",
                     png.substr(0, static_cast<std::size_t>(static_cast<double>(png.size()) * part)));
    EXPECT_BAD_INPUT(read_raster(folder / "cut.png"), "cut.png", "ends early");
  }
}

}  // namespace
}  // namespace lumitexel
