#include "processing/brdf/fit_material.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "processing/brdf/estimate_error.h"
#include "processing/brdf/left_out_photographs.h"
#include "processing/brdf/lobe_starts.h"
#include "processing/brdf/misfit.h"

namespace lumitexel {
namespace {

LobeBounds bounds_at(const Lobe& lobe, const MaterialFitOptions& options) {
  if (options.any_aim) return widest_bounds(options.family);
  return usual_bounds(options.family, lobe.aim < 0.0 ? kRetroAim : kForwardAim);
}

double effective_samples(FitSamples samples, double independence) {
  double sum = 0.0;
  for (const FitSample& sample : samples) sum += sample.share;
  return std::max(2.0, sum * independence);
}

MaterialFit refined(const MaterialModel& start, FitSamples samples, const MaterialFitOptions& options) {
  MaterialFit result{start, {}, 0.0};
  if (options.estimate_error) {
    BrdfFitOptions first = refit_options(start, options);
    first.brdf_alone = true;
    result.model.brdf = fit_brdf(start.brdf, samples, first).brdf;
    result.model.error = estimate_error_model(result.model.brdf, samples, start.error);
  }
  result.fit = fit_brdf(result.model.brdf, samples, refit_options(result.model, options));
  result.model.brdf = result.fit.brdf;
  if (options.estimate_error) result.model.error = updated_error_model(result.model.brdf, samples, result.model.error);
  return result;
}

// What the BRDF is to explain the samples by: where it is a mean prediction, the likelihood of outlier-tolerant errors would prefer the
// one that leaves highlights out.
double lack_of_fit(const MaterialFit& fit, FitSamples samples, const MaterialFitOptions& options) {
  return misfit(fit.model.brdf, samples, options.mean_fit.value_or(fit.model.error));
}

// Both with the same independence, which the smaller model would see too low: what it cannot explain errs together.
void set_criterion(MaterialFit& candidate, FitSamples samples, double independence, const MaterialFitOptions& options) {
  const int parameters = parameters_of(candidate.model.brdf, refit_options(candidate.model, options)).size();
  candidate.criterion = independence * lack_of_fit(candidate, samples, options) +
                        parameters * std::log(effective_samples(samples, independence));
}

MaterialFit matte(FitSamples samples, int channels, const MaterialFitOptions& options) {
  Brdf black;
  black.family = options.family;
  black.channels = channels;
  ErrorModel even = options.error;
  return refined({diffuse_alone(samples, even, black), options.error}, samples, options);
}

std::vector<LobeBounds> kinds_of_lobe(const Brdf& before, const MaterialFitOptions& options) {
  if (options.any_aim) return {widest_bounds(options.family)};
  std::vector<LobeBounds> kinds{usual_bounds(options.family)};
  if (lobe_family(options.family).aims && !before.lobes.empty()) kinds.push_back(usual_bounds(options.family, kRetroAim));
  return kinds;
}

// The better of the kinds of lobe that may come next.
MaterialFit with_lobe(const MaterialFit& before, FitSamples samples, const MaterialFitOptions& options) {
  MaterialFit best;
  double least = std::numeric_limits<double>::infinity();
  for (const LobeBounds& bounds : kinds_of_lobe(before.model.brdf, options)) {
    const Brdf start = with_best_lobe(before.model.brdf, samples, bounds, options.mean_fit.value_or(before.model.error));
    const MaterialFit candidate = refined({start, before.model.error}, samples, options);
    const double value = lack_of_fit(candidate, samples, options);
    if (value < least || best.model.brdf.lobes.empty()) best = candidate, least = value;
  }
  return best;
}

// `smaller` or `larger`, which has more lobes, by the criterion and by photographs left out; true for larger.
bool prefers(MaterialFit& smaller, MaterialFit& larger, FitSamples samples, const MaterialFitOptions& options) {
  const double independence = options.estimate_error ? larger.model.error.independence : 1.0;
  set_criterion(smaller, samples, independence, options);
  set_criterion(larger, samples, independence, options);
  return larger.criterion < smaller.criterion && predicts_other_photographs(smaller.model, larger.model, samples, options);
}

}  // namespace

BrdfFitOptions refit_options(const MaterialModel& model, const MaterialFitOptions& options) {
  BrdfFitOptions fit;
  fit.shared_shape = options.shared_shape;
  fit.error = options.mean_fit.value_or(model.error);
  fit.robust = options.estimate_error && !options.mean_fit;
  for (const auto& lobe : model.brdf.lobes) fit.bounds.push_back(bounds_at(lobe[0], options));
  return fit;
}

BrdfSigma sigma_of(const MaterialModel& model, FitSamples samples, const MaterialFitOptions& options) {
  const BrdfFitOptions fit = refit_options(model, options);
  return sigma_of(covariance_by_lumitexel(model.brdf, samples, fit), parameters_of(model.brdf, fit));
}

MaterialFit fit_material(FitSamples samples, int channels, const Brdf* start, const MaterialFitOptions& options) {
  MaterialFit best = matte(samples, channels, options);
  MaterialFit grown = best;
  const bool usable = start != nullptr && start->family == options.family && !start->lobes.empty();
  for (int lobes = 1; lobes <= options.most_lobes; ++lobes) {
    const bool started = usable && static_cast<int>(start->lobes.size()) == lobes;
    grown = started ? refined({*start, grown.model.error}, samples, options) : with_lobe(grown, samples, options);
    if (!options.choose_lobes || prefers(best, grown, samples, options)) {
      best = grown;
      continue;
    }
    // Growth has ended; a start of more lobes is asked all the same.
    const int of_start = usable ? static_cast<int>(start->lobes.size()) : 0;
    if (of_start > lobes && of_start <= options.most_lobes) {
      MaterialFit more = refined({*start, best.model.error}, samples, options);
      if (prefers(best, more, samples, options)) best = more;
    }
    break;
  }
  set_criterion(best, samples, options.estimate_error ? best.model.error.independence : 1.0, options);
  return best;
}

}  // namespace lumitexel
