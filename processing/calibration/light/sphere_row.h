// The ring flash's highlights on a line of spheres, among those of everything else.
//
// In undistorted directions such points lie on a straight line, at places that a projective map of 0, 1, 2, … gives, and
// are about equally bright, since the flash is about equally far from all.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "processing/calibration/lens/camera_model.h"
#include "processing/calibration/light/sphere_highlights.h"

namespace lumitexel {

// The `count` blobs that can be ring highlights of spheres on a line, in order, beginning with the leftmost (topmost if
// upright). None if no such row is found.
std::optional<std::vector<Blob>> find_sphere_row(const std::vector<Blob>& blobs, const CameraModel& camera, int count);

// Fewer of them: spheres behind something or out of the picture.
struct PartialRow {
  std::vector<std::pair<int, Blob>> members;  // place along the line, from 0, the first and the last of them seen
  double cost = 0;                            // of places and brightness; less is better

  int places() const { return members.back().first + 1; }
};

// More than half of the spheres, and four at least: then two neighbours are among them, and the spacing is known. Fewer could
// as well be every other one of a line twice as fine.
int least_of_row(int count);

// Rows of that many up to count - 1 members whose depth changes by no more than half along them, the fullest first, then
// those with fewest gaps, then those of least cost; at most `most` of them. Left out is what could as well have other places: 0 1 3 5 of one
// line look like 0 2 4 5 of another whose depth changes by 2.7 times more. They are guesses within some pixels: four glints
// of an object lie like that now and then.
std::vector<PartialRow> find_partial_rows(const std::vector<Blob>& blobs, const CameraModel& camera, int count,
                                          std::size_t most);

}  // namespace lumitexel
