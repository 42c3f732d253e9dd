#include "processing/report/view_pictures.h"

#include <algorithm>
#include <cmath>

#include "processing/evaluation/evaluate_model.h"
#include "processing/evaluation/image_error.h"
#include "processing/evaluation/predicted_view.h"
#include "processing/image/tone_map.h"

namespace lumitexel {
namespace {

constexpr double kWhiteFraction = 0.99;
constexpr int kMargin_px = 6;

struct Box {
  int left, top, right, bottom;  // right and bottom excluded
};

Box box_of(const std::vector<std::uint8_t>& counted, int width, int height) {
  Box box{width, height, 0, 0};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (counted[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] == 0)
        continue;
      box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x + 1), std::max(box.bottom, y + 1)};
    }
  }
  if (box.right <= box.left) return {0, 0, width, height};
  return {std::max(0, box.left - kMargin_px), std::max(0, box.top - kMargin_px),
          std::min(width, box.right + kMargin_px), std::min(height, box.bottom + kMargin_px)};
}

// Mean over blocks of whole pixels, before any tone curve.
Image reduced(const Image& image, const Box& box, int factor) {
  Image small(std::max(1, (box.right - box.left) / factor), std::max(1, (box.bottom - box.top) / factor),
              image.channels);
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      for (int c = 0; c < image.channels; ++c) {
        double sum = 0.0;
        for (int i = 0; i < factor * factor; ++i) {
          sum += image.at(box.left + x * factor + i % factor, box.top + y * factor + i / factor, c);
        }
        small.at(x, y, c) = static_cast<float>(sum / (factor * factor));
      }
    }
  }
  return small;
}

Image difference_picture(const Image& photograph, const Image& rendering, double white) {
  Image shown(photograph.width, photograph.height, 3);
  for (int y = 0; y < shown.height; ++y) {
    for (int x = 0; x < shown.width; ++x) {
      double difference = 0.0;
      for (int c = 0; c < photograph.channels; ++c) difference += rendering.at(x, y, c) - photograph.at(x, y, c);
      const auto colour = false_colour(difference / photograph.channels / (kDifferenceRange * white));
      std::copy(colour.begin(), colour.end(), &shown.at(x, y));
    }
  }
  return shown;
}

// What is beside the object is neither right nor wrong: both pictures show it black.
void blacken_uncounted(Image& image, const std::vector<std::uint8_t>& counted) {
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    if (counted[i / static_cast<std::size_t>(image.channels)] == 0) image.data[i] = 0.0f;
  }
}

double white_of(const RadianceImage& photograph, const std::vector<std::uint8_t>& counted) {
  const double white = percentile(photograph.radiance, counted, kWhiteFraction);
  return white > 0.0 ? white : 1.0;
}

// Where a pixel's centre meets the mesh.
std::vector<std::uint8_t> hits_of(const ViewRenderer& renderer, const View& view) {
  const Image normal = renderer.render_aov(view, Aov::Normal);
  std::vector<std::uint8_t> hit(normal.data.size() / 3);
  for (std::size_t i = 0; i < hit.size(); ++i) hit[i] = std::any_of(&normal.data[3 * i], &normal.data[3 * i] + 3, [](float x) { return x != 0.0f; });
  return hit;
}

}  // namespace

std::array<float, 3> false_colour(double position) {
  constexpr std::array<double, 3> kDark{0.10, 0.30, 0.66}, kEqual{0.96, 0.96, 0.96}, kBright{0.75, 0.16, 0.12};
  const double share = std::min(1.0, std::abs(position));
  const auto& end = position < 0.0 ? kDark : kBright;
  std::array<float, 3> colour{};
  for (std::size_t c = 0; c < 3; ++c) colour[c] = static_cast<float>(kEqual[c] + share * (end[c] - kEqual[c]));
  return colour;
}

double shown_white(const ViewRenderer& renderer, const View& view, int channels) {
  const RadianceImage photograph = read_photograph(view, channels);
  return white_of(photograph, object_pixels(photograph, hits_of(renderer, view)));
}

ViewPictures make_view_pictures(const ViewRenderer& renderer, const View& view, int channels, FitStage stage,
                                int width_px) {
  RadianceImage photograph = read_photograph(view, channels);
  RenderedView rendered = predicted_view(renderer, view, stage);
  const auto counted = object_pixels(photograph, rendered.hit);
  blacken_uncounted(photograph.radiance, counted);
  blacken_uncounted(rendered.radiance, counted);

  ViewPictures pictures;
  pictures.white = white_of(photograph, counted);
  const Box box = box_of(counted, view.camera.width_px, view.camera.height_px);
  const int factor = std::max(1, (box.right - box.left + width_px - 1) / width_px);
  const Image small_photograph = reduced(photograph.radiance, box, factor);
  const Image small_rendering = reduced(rendered.radiance, box, factor);
  pictures.photograph = tone_mapped(small_photograph, pictures.white);
  pictures.rendering = tone_mapped(small_rendering, pictures.white);
  pictures.difference = difference_picture(small_photograph, small_rendering, pictures.white);
  return pictures;
}

}  // namespace lumitexel
