#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>

#include "drivers/error.h"
#include "processing/image/exr_file.h"
#include "processing/model/render_view.h"
#include "processing/render/render_lit.h"
#include "processing/report/viewer/viewer_page.h"
#include "processing/report/viewer/viewer_sky.h"
#include "tests/unit/temporary_folder.h"
#include "tests/viewer/browser_pictures.h"
#include "tests/viewer/bumpy_model.h"

namespace lumitexel {
namespace {

// Noise alone stands between the pictures: a sixteenth of it in the mean square after 16 times the samples is 12 dB, of which the
// reference's own noise and rare bright samples take a little.
constexpr double kLeastPsnr_db = 33.0, kLeastGain_db = 10.0;
constexpr double kMeansApart = 0.006;  // three times what the noise of some 2500 pixels leaves in their mean

// Dim, with a lamp of a few pixels and a brighter half; no symmetry that a wrong axis or turn could hide behind.
Image uneven_sky() {
  Image sky(32, 16, 3);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x) {
      const bool lamp = x >= 9 && x < 11 && y >= 4 && y < 6;
      for (int c = 0; c < 3; ++c) sky.at(x, y, c) = lamp ? 30.0f - 6.0f * static_cast<float>(c) : (x < 16 ? 0.3f : 0.1f) + 0.02f * static_cast<float>(y + c);
    }
  }
  return sky;
}

struct Difference {
  double psnr_db = 0;     // against the reference's value that 99 % of the lit values do not pass
  double of_means = 0;    // of the pictures, relative
};

Difference difference(const std::vector<float>& picture, const Image& reference) {
  double squares = 0.0, sum = 0.0, reference_sum = 0.0;
  std::vector<float> lit;
  for (std::size_t i = 0; i < reference.data.size(); ++i) {
    const auto value = static_cast<double>(picture[i / 3 * 4 + i % 3]), of_reference = static_cast<double>(reference.data[i]);
    squares += (value - of_reference) * (value - of_reference);
    sum += value;
    reference_sum += of_reference;
    if (of_reference > 0.0) lit.push_back(reference.data[i]);
  }
  const auto at = lit.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(lit.size()));
  std::nth_element(lit.begin(), at, lit.end());
  const auto white = static_cast<double>(*at);
  return {10.0 * std::log10(white * white * static_cast<double>(reference.data.size()) / squares), sum / reference_sum - 1.0};
}

TEST(ViewerSky, ConvergesToThePathTracersPicture) {
  if (!has_chromium()) GTEST_SKIP() << "NOT TESTED: no chromium here to draw the viewer's page with";
  constexpr double kTurn_rad = 0.7;
  const Model model = bumpy_model();
  const Image sky = uneven_sky();
  const TemporaryFolder folder;
  std::ofstream(folder / "page.html", std::ios::binary) << viewer_page("bumpy", model, nullptr, &sky).html;
  const View view = framing_view(model.mesh, model.channels, 64, {0.5, -1.0, 0.4}, Eigen::Vector3d::UnitZ());
  const auto pictures = browser_sky(folder / "page.html", view, FitStage::Normal, kTurn_rad, {16, 256});
  ASSERT_TRUE(pictures.has_value());
  LitOptions options;
  options.limits.samples_per_pixel = 1024;
  const Environment environment(sky, environment_from_world(Eigen::Vector3d::UnitZ(), kTurn_rad), "sky");
  const LitView reference = render_environment(model, view, environment, options);
  ASSERT_EQ(pictures->size(), 2u);
  const Difference few = difference(pictures->at(0), reference.radiance), many = difference(pictures->at(1), reference.radiance);
  // Of a light and a turn that are wrong by a little the picture keeps a share however long it gathers.
  EXPECT_GT(many.psnr_db, kLeastPsnr_db);
  EXPECT_GT(many.psnr_db, few.psnr_db + kLeastGain_db);
  EXPECT_LT(std::abs(many.of_means), kMeansApart);
  std::cout << few.psnr_db << " dB after 16 samples a pixel, " << many.psnr_db << " dB after 256; reference's noise " << reference.noise.value_or(-1.0)
            << "; means differ by " << many.of_means << "\n";
}

TEST(ViewerSky, IsReducedWithoutLosingLight) {
  Image sky(1024, 512, 3);
  for (std::size_t i = 0; i < sky.data.size(); ++i) sky.data[i] = static_cast<float>((i * 7919) % 1000) / 500.0f;
  const Image small = reduced_sky(sky, "sky");
  ASSERT_EQ(small.width, 256);
  ASSERT_EQ(small.height, 128);
  const auto total = [](const Image& image) {
    double sum = 0.0;
    for (int y = 0; y < image.height; ++y) {
      const double height = std::cos(M_PI * y / image.height) - std::cos(M_PI * (y + 1) / image.height);
      for (int x = 0; x < image.width; ++x) sum += height / image.width * static_cast<double>(image.at(x, y, 1));
    }
    return sum;
  };
  EXPECT_NEAR(total(small), total(sky), 1e-5 * total(sky));  // single precision
  EXPECT_EQ(reduced_sky(small, "sky").data, small.data);
  EXPECT_THROW(reduced_sky(Image(1023, 512, 3, 1.0f), "sky"), BadInput);
}

TEST(ViewerSky, RefusesWhatIsNoEnvironment) {
  const TemporaryFolder folder;
  write_exr_colour(folder / "black.exr", Image(8, 4, 3));
  EXPECT_THROW(read_sky(folder / "black.exr", 3), BadInput);
  write_exr_colour(folder / "colour.exr", Image(8, 4, 3, 1.0f));
  EXPECT_THROW(read_sky(folder / "colour.exr", 1), BadInput);
  EXPECT_EQ(read_sky(folder / "colour.exr", 3).width, 8);
  write_exr_colour(folder / "gray.exr", Image(8, 4, 1, 1.0f));
  EXPECT_EQ(read_sky(folder / "gray.exr", 3).channels, 1);
}

}  // namespace
}  // namespace lumitexel
