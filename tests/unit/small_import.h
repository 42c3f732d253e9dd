// A small, valid import layout on disk, for tests to read or to break in one place.
#pragma once

#include <string>

#include "processing/calibration/import/import_session.h"
#include "processing/image/exr_file.h"
#include "processing/image/raster_file.h"
#include "rig/whole_file.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {

// Three photographs a.exr, b.exr, c.exr (held out) of 16x12 pixels, red 1, green 2, blue 3 + 0.01 x, of a tetrahedron 2
// m ahead, and masks whose left column is off the object.
class SmallImport {
 public:
  static constexpr int kWidth = 16, kHeight = 12;

  SmallImport() {
    std::filesystem::create_directories(folder_ / "images");
    std::filesystem::create_directories(folder_ / "masks");
    put("cameras.txt", "1 PINHOLE 16 12 20 20 8 6\n");
    put("images.txt", "1 1 0 0 0 0 0 2 1 a.exr\n\n2 1 0 0 0 0.1 0 2 1 b.exr\n\n3 1 0 0 0 -0.1 0 2 1 c.exr\n\n");
    put("lights.csv",
        "image,type,x,y,z,intensity_r,intensity_g,intensity_b,split\n"
        "a.exr,point,1,0,-2,10,11,12,fit\n"
        "b.exr,directional,0,0,-1,1,2,3,fit\n"
        "c.exr,point,0,1,-2,10,10,10,heldout\n");
    put("mesh.obj", "v 0 0 0\nv 0.3 0 0\nv 0 0.3 0\nv 0 0 0.3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    for (const char* name : {"a", "b", "c"}) {
      write_exr_colour(path(std::string("images/") + name + ".exr"), photograph());
      write_png8(path(std::string("masks/") + name + ".png"), mask());
    }
  }

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  void put(const std::string& name, const std::string& bytes) const { write_whole_file(path(name), bytes); }
  void remove(const std::string& name) const { std::filesystem::remove(path(name)); }
  // Puts `to` where `from` first stands in a text.
  void replace(const std::string& name, const std::string& from, const std::string& to) const {
    std::string text = read_whole_file(path(name));
    const std::size_t at = text.find(from);
    if (at == std::string::npos) throw std::logic_error(name + " has no " + from);
    put(name, text.replace(at, from.size(), to));
  }

  static Image photograph() {
    Image image(kWidth, kHeight, 3);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        for (int c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<float>(c + 1) + 0.01f * static_cast<float>(x);
      }
    }
    return image;
  }
  static Image mask() {
    Image image(kWidth, kHeight, 1, 1.0f);
    for (int y = 0; y < kHeight; ++y) image.at(0, y) = 0.0f;
    return image;
  }

  // Eight-bit photographs in the place of the EXR ones; values are fractions of 255.
  void use_png(const Image& unit_values) const {
    for (const char* name : {"a", "b", "c"}) {
      remove(std::string("images/") + name + ".exr");
      write_png8(path(std::string("images/") + name + ".png"), unit_values);
      replace("images.txt", std::string(name) + ".exr", std::string(name) + ".png");
      replace("lights.csv", std::string(name) + ".exr", std::string(name) + ".png");
    }
  }

  ImportSources sources() const {
    return {folder_.path(), path("images"), path("lights.csv"), path("mesh.obj"), path("masks"), ""};
  }
  std::filesystem::path session() const { return folder_ / "made/session"; }

 private:
  TemporaryFolder folder_;
};

}  // namespace lumitexel
