// Light from far away in all directions: a picture of the whole sphere, latitude against longitude.
//
// Orientation, in the environment's own frame (z up): the top row looks along +z, the bottom row along -z, the middle
// of the picture along +x, a quarter of the width to its left along +y; so the picture is what one sees from inside,
// not mirrored. A pixel's radiance holds for the whole patch of sphere that it covers: nothing is interpolated, so what
// is drawn for importance and what is looked up are the same function.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

#include "processing/image/image.h"

namespace lumitexel {

class Environment {
 public:
  // radiance: width 2 at least; one channel stands for all. environment_from_world: a rotation. Throws BadInput naming
  // `where` and the pixel for a value that is negative or not finite, or if all is black.
  Environment(Image radiance, const Eigen::Matrix3d& environment_from_world, const std::string& where);

  int channels() const { return radiance_.channels; }
  // Of the unit direction, which points away from the scene; c counts up to the scene's channels.
  double radiance(const Eigen::Vector3d& direction_in_world, int c) const;
  // A direction drawn with a density (1/sr) in proportion to the mean of the channels.
  Eigen::Vector3d sample(const Eigen::Vector2d& uniform) const;
  double density(const Eigen::Vector3d& direction_in_world) const;

 private:
  struct Pixel {
    int x = 0, y = 0;
  };
  Pixel pixel_at(const Eigen::Vector3d& direction_in_world) const;
  double row_solid_angle(int y) const;  // of one pixel in it, sr
  double brightness(int x, int y) const;

  Image radiance_;
  Eigen::Matrix3d environment_from_world_;
  std::vector<double> row_ends_;     // cumulative share of the rows, height
  std::vector<double> column_ends_;  // within each row, height * width; a black row's are never asked for
  double total_ = 0;                 // brightness times solid angle, summed
};

// The rotation for an environment whose z is `up_in_world` (turned there from the world's z the shortest way; about x
// if that is upside down) and which is turned about it by turn_rad, counter-clockwise seen from above. Throws BadInput
// if `up_in_world` is zero.
Eigen::Matrix3d environment_from_world(const Eigen::Vector3d& up_in_world, double turn_rad);

// An EXR with R, G, B or Y, scaled. channels: of the scene; the file has as many, or one. Throws BadInput naming the
// file.
Environment read_environment(const std::filesystem::path& path, double scale,
                             const Eigen::Matrix3d& environment_from_world, int channels);

}  // namespace lumitexel
