#include "processing/image/exr_file.h"

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "rig/whole_file.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/shared_data.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

const ExrPlane& plane(const ExrImage& image, const std::string& name) {
  for (const ExrPlane& candidate : image.planes) {
    if (candidate.name == name) return candidate;
  }
  throw std::runtime_error("no plane " + name);
}

TEST(ExrFile, PlanesComeBackInTheirOwnTypes) {
  const TemporaryFolder folder;
  const ExrImage written{3,
                         2,
                         {{"weight3", ExrPixel::Float, {0.1f, 1e-30f, 3e38f, -2.5f, 0.0f, 7.0f}},
                          {"normal.X", ExrPixel::Half, {0.5f, -1.0f, 65504.0f, 0.25f, 2048.0f, 1.0f / 3.0f}},
                          {"flags", ExrPixel::Uint, {0.0f, 1.0f, 255.0f, 16777215.0f, 8.0f, 2.0f}}}};
  write_exr(folder / "a.exr", written);
  const ExrImage read = read_exr(folder / "a.exr");
  ASSERT_EQ(read.width, 3);
  ASSERT_EQ(read.height, 2);
  ASSERT_EQ(read.planes.size(), 3u);
  EXPECT_EQ(plane(read, "weight3").data, written.planes[0].data);
  EXPECT_EQ(plane(read, "flags").data, written.planes[2].data);
  EXPECT_EQ(plane(read, "flags").stored, ExrPixel::Uint);
  EXPECT_EQ(plane(read, "normal.X").stored, ExrPixel::Half);
  for (std::size_t i = 0; i < 6; ++i) {
    // Half the spacing of half floats: 2^-11 relative.
    const float truth = written.planes[1].data[i];
    EXPECT_NEAR(plane(read, "normal.X").data[i], truth, std::abs(truth) * 0x1p-11f);
  }
}

TEST(ExrFile, ColourIsInTheOrderRgbWhateverTheFilesOrder) {
  const TemporaryFolder folder;
  Image image(2, 1, 3);
  image.data = {1, 2, 3, 4, 5, 6};
  write_exr_colour(folder / "rgb.exr", image);
  const ExrImage planes = read_exr(folder / "rgb.exr");
  EXPECT_EQ(plane(planes, "R").data, (std::vector<float>{1, 4}));
  EXPECT_EQ(plane(planes, "B").data, (std::vector<float>{3, 6}));
  EXPECT_EQ(read_exr_colour(folder / "rgb.exr").data, image.data);

  Image gray(2, 1, 1);
  gray.data = {0.25f, 0.5f};
  write_exr_colour(folder / "y.exr", gray, ExrPixel::Half);
  EXPECT_EQ(read_exr_colour(folder / "y.exr").channels, 1);
  EXPECT_EQ(read_exr_colour(folder / "y.exr").data, gray.data);
}

// The data window is what the file holds; the display window is what the camera saw.
TEST(ExrFile, ADataWindowOffTheDisplayWindowIsPutWhereItBelongs) {
  const TemporaryFolder folder;
  const Imath::Box2i display({10, 20}, {13, 22}), window({9, 21}, {11, 23});  // 4x3 and 3x3
  Imf::Header header(display, window);
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  std::vector<float> data{1, 2, 3, 4, 5, 6, 7, 8, 9};
  Imf::FrameBuffer buffer;
  buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, data.data(), window));
  {
    Imf::OutputFile file((folder / "window.exr").c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(3);
  }
  const Image read = read_exr_colour(folder / "window.exr");
  EXPECT_EQ(read.width, 4);
  EXPECT_EQ(read.height, 3);
  EXPECT_EQ(read.data, (std::vector<float>{0, 0, 0, 0, 2, 3, 0, 0, 5, 6, 0, 0}));
}

TEST(ExrFile, WhatIsNoWholeExrIsNamed) {
  const TemporaryFolder folder;
  EXPECT_BAD_INPUT(read_exr(folder / "none.exr"), "none.exr", "no such file");
  std::ofstream(folder / "text.exr") << "certainly not an image";
  EXPECT_BAD_INPUT(read_exr(folder / "text.exr"), "text.exr", "OpenEXR");
  write_exr(folder / "depth.exr", {1, 1, {{"Z", ExrPixel::Float, {1.0f}}}});
  EXPECT_BAD_INPUT(read_exr_colour(folder / "depth.exr"), "depth.exr", "no channel Y");

  Image noise(64, 64, 3);
  for (std::size_t i = 0; i < noise.data.size(); ++i) noise.data[i] = static_cast<float>(i * 2654435761u % 1000u);
  write_exr_colour(folder / "whole.exr", noise);
  const std::string bytes = read_whole_file(folder / "whole.exr");
  for (const double part : {0.01, 0.1, 0.5, 0.99}) {
    write_whole_file(folder / "cut.exr",
                     bytes.substr(0, static_cast<std::size_t>(static_cast<double>(bytes.size()) * part)));
    EXPECT_BAD_INPUT(read_exr(folder / "cut.exr"), "cut.exr");
  }
}

TEST(ExrFile, AFailedWriteLeavesNothing) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_exr(folder / "no/such/folder.exr", {1, 1, {{"Y", ExrPixel::Float, {1.0f}}}}), Error);
  EXPECT_THROW(write_exr(folder / "size.exr", {2, 1, {{"Y", ExrPixel::Float, {1.0f}}}}), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(ExrFile, ReadsAnUnrelatedRenderersHalfFloats) {
  SKIP_WITHOUT_SHARED_DATA("oracle_a");
  const Image image = read_exr_colour(shared_data() / "oracle_a/images/fit_000.exr");
  EXPECT_EQ(image.width, 800);
  EXPECT_EQ(image.height, 600);
  EXPECT_EQ(image.channels, 3);
}

}  // namespace
}  // namespace lumitexel
