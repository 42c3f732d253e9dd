#include "rig/view_order.h"

#include <algorithm>
#include <numeric>

namespace lumitexel {
namespace {

constexpr double kWorthwhile_s = 1e-9;  // gains below rounding would let 2-opt go round in circles

class Tour {
 public:
  Tour(const std::vector<RigPosition>& positions, const RigDescription& rig)
      : positions_(positions), rig_(rig), order_(positions.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
  }

  void visit_nearest_next() {
    for (std::size_t place = 0; place < order_.size(); ++place) {
      const auto nearest = std::min_element(order_.begin() + static_cast<std::ptrdiff_t>(place), order_.end(),
                                            [&](std::size_t a, std::size_t b) {
                                              const double a_s = way_s(before(place), positions_[a]);
                                              const double b_s = way_s(before(place), positions_[b]);
                                              return a_s != b_s ? a_s < b_s : a < b;
                                            });
      std::iter_swap(order_.begin() + static_cast<std::ptrdiff_t>(place), nearest);
    }
  }

  // Reverses one stretch that shortens the way; false if there is none.
  bool reverse_one() {
    for (std::size_t first = 0; first < order_.size(); ++first) {
      for (std::size_t last = first + 1; last < order_.size(); ++last) {
        if (gain_s(first, last) <= kWorthwhile_s) continue;
        std::reverse(order_.begin() + static_cast<std::ptrdiff_t>(first),
                     order_.begin() + static_cast<std::ptrdiff_t>(last) + 1);
        return true;
      }
    }
    return false;
  }

  const std::vector<std::size_t>& order() const { return order_; }

 private:
  double way_s(const RigPosition& from, const RigPosition& to) const { return sequential_motion_s(from, to, rig_); }
  RigPosition at(std::size_t place) const { return positions_[order_[place]]; }
  RigPosition before(std::size_t place) const { return place == 0 ? RigPosition{} : at(place - 1); }
  double gain_s(std::size_t first, std::size_t last) const {
    double gain = way_s(before(first), at(first)) - way_s(before(first), at(last));
    if (last + 1 < order_.size()) gain += way_s(at(last), at(last + 1)) - way_s(at(first), at(last + 1));
    return gain;
  }

  const std::vector<RigPosition>& positions_;
  const RigDescription& rig_;
  std::vector<std::size_t> order_;
};

}  // namespace

std::vector<std::size_t> short_order(const std::vector<RigPosition>& positions, const RigDescription& rig) {
  Tour tour(positions, rig);
  tour.visit_nearest_next();
  while (tour.reverse_one()) {
  }
  return tour.order();
}

}  // namespace lumitexel
