#include "processing/image/response/response_kinks.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "processing/image/fit_response.h"

namespace lumitexel {
namespace {

using Vector = ResponseSpline::Vector;

// To look for kinks: a curve that bends no more than this elsewhere. The fit's own sigma has grown by the kink.
constexpr double kGentleBend = 0.02;
// Less than this, in -2 log likelihood, no kink is worth: its place alone has to be told from ten others.
constexpr double kWorthATry = 4.0;
// Of a kink to the end of the usable range, in places: half a knot, so that both its sides are known.
constexpr double kFromEnd = 0.5 / ResponseSpline::kSpans;

// The spline of coefficients that lie on a kink is the kink, rounded over two knots: what is added here is taken there.
Vector with_kink(const Vector& parameters, double bend, double place) {
  Vector more(parameters.size() + ResponseSpline::kOfKink);
  more << parameters, bend, place;
  for (int j = 0; j < ResponseSpline::kCoefficients; ++j)
    more[j] -= bend * std::max(0.0, (j - 1.0) / ResponseSpline::kSpans - place);
  return more;
}

struct Candidate {
  double gain = 0.0;  // of -2 log likelihood and prior, about
  Vector start;
};

// About the converged fit the misfit is a quadratic form of the parameters. Freeing the spline's bend at the k-th knot
// from the prior is an update of rank one to it.
class QuadraticMisfit {
 public:
  explicit QuadraticMisfit(const ResponseLeastSquares& fit) : precision_(1.0 / (kGentleBend * kGentleBend)) {
    const Eigen::Index n = fit.parameters().size();
    const ResponseMatrix change = bend_prior(n, kGentleBend) - bend_prior(n, fit.bend_sigma());
    covariance_ = (fit.covariance().inverse() + change).inverse();
    parameters_ = fit.parameters() - covariance_ * (change * fit.parameters());
  }

  Candidate kink_at(int k) const {
    Vector freed = Vector::Zero(parameters_.size());
    freed.head<ResponseSpline::kCoefficients>() = bend(k);
    const Vector moves = covariance_ * freed;
    const double held = freed.dot(parameters_), left = 1.0 - precision_ * freed.dot(moves);
    if (left < 1e-6) return {};  // the samples do not know this bend
    return {precision_ * held * held / left,
            with_kink(parameters_ + moves * (precision_ * held / left), held / left * ResponseSpline::kSpans,
                      static_cast<double>(k) / ResponseSpline::kSpans)};
  }

 private:
  double precision_;
  ResponseMatrix covariance_;
  Vector parameters_;
};

bool is_within(const ResponseLeastSquares& fit, double place) {
  const double dimmest = ResponseSpline(fit.parameters()).inverse(kUsableElectrons * fit.shot());
  return place > ResponseSpline::place(std::max(kUsableFrom, dimmest)) + kFromEnd &&
         place < ResponseSpline::place(std::min(kUsableTo, fit.reduced().highest)) - kFromEnd;
}

Candidate best_candidate(const ResponseLeastSquares& fit) {
  const QuadraticMisfit misfit(fit);
  Candidate best;
  for (int k = 0; k < kBends; ++k) {
    if (!is_within(fit, static_cast<double>(k) / ResponseSpline::kSpans)) continue;
    Candidate candidate = misfit.kink_at(k);
    if (candidate.gain > best.gain) best = std::move(candidate);
  }
  return best;
}

}  // namespace

int add_kinks(ResponseLeastSquares& fit) {
  int iterations = 0;
  while (fit.kinks() < ResponseSpline::kMostKinks) {
    const Candidate candidate = best_candidate(fit);
    if (candidate.gain < kWorthATry) break;
    ResponseLeastSquares trial = fit;
    const int taken = trial.run_from(candidate.start);
    iterations += taken;
    const double place = trial.parameters()[trial.parameters().size() - 1];
    if (taken == 0 || !is_within(trial, place) || trial.surprise() >= fit.surprise()) break;
    fit = std::move(trial);
  }
  return iterations;
}

}  // namespace lumitexel
