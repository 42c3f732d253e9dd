// Samples out of bytes written by hand: what the driver and the simulated camera agree on, they might agree on wrongly.
#include "drivers/aravis/pixel_layout.h"

#include <gtest/gtest.h>

#include "sim/protocol/gige/pixel_packing.h"

namespace lumitexel {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Samples = std::vector<std::uint16_t>;

TEST(PixelLayout, DecodesEachPacking) {
  EXPECT_EQ(decoded(*pixel_layout("Mono8"), Bytes{1, 255}, 2), (Samples{1, 255}));
  EXPECT_EQ(decoded(*pixel_layout("Mono16"), Bytes{0x34, 0x12, 0xff, 0xff}, 2), (Samples{0x1234, 0xffff}));
  EXPECT_EQ(decoded(*pixel_layout("Mono12"), Bytes{0xbc, 0x0a}, 1), (Samples{0xabc}));
  EXPECT_EQ(decoded(*pixel_layout("Mono12Packed"), Bytes{0xab, 0xfc, 0xde}, 2), (Samples{0xabc, 0xdef}));
  EXPECT_EQ(decoded(*pixel_layout("Mono12p"), Bytes{0xbc, 0xfa, 0xde}, 2), (Samples{0xabc, 0xdef}));
  EXPECT_EQ(decoded(*pixel_layout("BayerGB12p"), Bytes{0xbc, 0x0a, 0x00}, 1), (Samples{0xabc}));
}

TEST(PixelLayout, KnowsWhichMosaicAFormatHas) {
  EXPECT_EQ(pixel_layout("BayerRG12")->mosaic, Mosaic::Rggb);
  EXPECT_EQ(pixel_layout("BayerBG8")->mosaic, Mosaic::Bggr);
  EXPECT_EQ(pixel_layout("BayerGR16")->mosaic, Mosaic::Grbg);
  EXPECT_EQ(pixel_layout("BayerGB12Packed")->mosaic, Mosaic::Gbrg);
  EXPECT_FALSE(pixel_layout("RGB8").has_value());
  EXPECT_FALSE(pixel_layout("Mono12Strange").has_value());
}

TEST(PixelLayout, SuitsTheRigWithNoMoreBitsThanNeeded) {
  const std::vector<std::string> offered{"Mono8", "Mono12", "Mono12Packed", "Mono16", "BayerRG8"};
  EXPECT_EQ(suitable_layout(Mosaic::Mono, 8, offered)->name, "Mono8");
  EXPECT_EQ(suitable_layout(Mosaic::Mono, 10, offered)->name, "Mono12");
  EXPECT_EQ(suitable_layout(Mosaic::Mono, 14, offered)->name, "Mono16");
  EXPECT_FALSE(suitable_layout(Mosaic::Rggb, 12, offered).has_value());
}

TEST(PixelLayout, UndoesWhatTheSimulatedCameraPacks) {
  const Samples samples{0, 1, 0xabc, 0xdef, 4095};  // an odd number of them
  for (const gige::PixelFormat& format : gige::pixel_formats(Mosaic::Mono, 12)) {
    const Bytes bytes = gige::packed(format, samples);
    EXPECT_EQ(bytes.size(), pixel_layout(format.name)->bytes(samples.size())) << format.name;
    EXPECT_EQ(decoded(*pixel_layout(format.name), bytes, samples.size()), samples) << format.name;
  }
}

}  // namespace
}  // namespace lumitexel
