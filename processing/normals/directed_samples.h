// A lumitexel's samples with their two directions in world, for work that moves the normal.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "processing/brdf/observations.h"
#include "processing/calibration/calibrated_session.h"
#include "processing/surface/lumitexel.h"

namespace lumitexel {

struct DirectedSample {
  Eigen::Vector3d wi, wo;   // unit, in world
  Observation observation;  // measured reflectance and variance; geometry about whichever normal was set last
};

// Directions are made from positions and views each time they are asked for: in double they would fill more memory than the samples.
// Keeps references to session and lumitexels.
class DirectedLumitexels {
 public:
  // used: for each of the session's views, whether its samples are given; empty: all are.
  DirectedLumitexels(const CalibratedSession& session, const LumitexelSet& lumitexels, std::vector<bool> used = {});

  std::size_t size() const { return size_; }
  int channels() const { return lumitexels_.channels; }
  const Eigen::Vector3d& coarse_normal(std::size_t lumitexel) const { return tile(lumitexel).normal[within(lumitexel)]; }
  const Eigen::Vector3d& position(std::size_t lumitexel) const { return tile(lumitexel).position[within(lumitexel)]; }
  std::uint32_t texel(std::size_t lumitexel) const { return tile(lumitexel).texel[within(lumitexel)]; }
  // The samples whose numbers are finite, in the set's order. `out` is overwritten: a buffer of the caller's, one a thread.
  void samples_of(std::size_t lumitexel, std::vector<DirectedSample>& out) const;

 private:
  const LumitexelTile& tile(std::size_t lumitexel) const { return lumitexels_.tiles[lumitexel / LumitexelTile::kCapacity]; }
  static std::size_t within(std::size_t lumitexel) { return lumitexel % LumitexelTile::kCapacity; }

  const CalibratedSession& session_;
  const LumitexelSet& lumitexels_;
  std::vector<bool> used_;
  std::vector<Eigen::Vector3d> eyes_;
  std::size_t size_;
};

}  // namespace lumitexel
