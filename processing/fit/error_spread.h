// Held-out errors of several fits of one setting, and how sure they are.
//
// Two chances are in such an error: which photographs judge, and which surface points the materials were learnt on (the draw). Settings share the
// first, and most of them the second, so differences between settings are taken view by view and draw by draw.
#pragma once

#include <limits>
#include <vector>

namespace lumitexel {

// One error of one model on the held-out views.
struct HeldoutError {
  double pooled = std::numeric_limits<double>::quiet_NaN();  // over all of their pixels
  std::vector<double> by_view;                               // in the session's order
};

struct ErrorWithSpread {
  double value = std::numeric_limits<double>::quiet_NaN();
  // Standard error. NaN with fewer than two views. Of one draw only that over views: it then says nothing about other draws.
  double sigma = std::numeric_limits<double>::quiet_NaN();
  // Standard deviation of one draw's figure, by which a single fit may be off. NaN with fewer than two draws.
  double draw_deviation = std::numeric_limits<double>::quiet_NaN();
};

// value: mean of the draws' pooled errors. sigma^2: variance over views of the mean over draws / views + variance over draws / draws. What
// is due to neither alone but to both is in both terms, so sigma is rather too large. All with the same views.
ErrorWithSpread over_draws(const std::vector<HeldoutError>& draws);

// a less b, pooled and view by view.
HeldoutError difference(const HeldoutError& a, const HeldoutError& b);

}  // namespace lumitexel
