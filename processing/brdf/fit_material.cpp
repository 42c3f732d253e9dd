#include "processing/brdf/fit_material.h"

#include <cmath>

#include "processing/brdf/estimate_error.h"
#include "processing/brdf/lobe_starts.h"
#include "processing/brdf/misfit.h"

namespace lumitexel {
namespace {

constexpr int kErrorRounds = 2;  // of fit and error model in turn

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
  for (int round = 0; round < kErrorRounds; ++round) {
    result.fit = fit_brdf(result.model.brdf, samples, refit_options(result.model, options));
    result.model.brdf = result.fit.brdf;
    if (!options.estimate_error) break;
    result.model.error = estimate_error_model(result.model.brdf, samples, result.model.error);
  }
  return result;
}

// Both with the same independence, which the smaller model would see too low: what it cannot explain errs together.
void set_criterion(MaterialFit& candidate, FitSamples samples, double independence, const MaterialFitOptions& options) {
  const int parameters = parameters_of(candidate.model.brdf, refit_options(candidate.model, options)).size();
  candidate.criterion = independence * misfit(candidate.model.brdf, samples, candidate.model.error) +
                        parameters * std::log(effective_samples(samples, independence));
}

MaterialFit matte(FitSamples samples, int channels, const MaterialFitOptions& options) {
  Brdf black;
  black.family = options.family;
  black.channels = channels;
  ErrorModel even = options.error;
  return refined({diffuse_alone(samples, even, black), options.error}, samples, options);
}

// The better of the kinds of lobe that may come next.
MaterialFit with_lobe(const MaterialFit& before, FitSamples samples, const MaterialFitOptions& options) {
  MaterialFit best;
  bool found = false;
  std::vector<LobeBounds> kinds{options.any_aim ? widest_bounds(options.family) : usual_bounds(options.family)};
  const bool may_return = !options.any_aim && lobe_family(options.family).aims && !before.model.brdf.lobes.empty();
  if (may_return) kinds.push_back(usual_bounds(options.family, kRetroAim));
  for (const LobeBounds& bounds : kinds) {
    const Brdf start = with_best_lobe(before.model.brdf, samples, bounds, before.model.error);
    const MaterialFit candidate = refined({start, before.model.error}, samples, options);
    if (found && misfit(best.model.brdf, samples, best.model.error) <=
                     misfit(candidate.model.brdf, samples, candidate.model.error)) continue;
    best = candidate;
    found = true;
  }
  return best;
}

// `smaller` or `larger`, by the criterion; true for larger.
bool prefers(MaterialFit& smaller, MaterialFit& larger, FitSamples samples, const MaterialFitOptions& options) {
  const double independence = options.estimate_error ? larger.model.error.independence : 1.0;
  set_criterion(smaller, samples, independence, options);
  set_criterion(larger, samples, independence, options);
  return larger.criterion < smaller.criterion;
}

}  // namespace

BrdfFitOptions refit_options(const MaterialModel& model, const MaterialFitOptions& options) {
  BrdfFitOptions fit;
  fit.shared_shape = options.shared_shape;
  fit.error = model.error;
  fit.robust = options.estimate_error;
  for (const auto& lobe : model.brdf.lobes) fit.bounds.push_back(bounds_at(lobe[0], options));
  return fit;
}

MaterialFit fit_material(FitSamples samples, int channels, const Brdf* start, const MaterialFitOptions& options) {
  MaterialFit best = matte(samples, channels, options);
  MaterialFit grown = best;
  for (int lobes = 1; lobes <= options.most_lobes; ++lobes) {
    grown = with_lobe(grown, samples, options);
    if (!options.choose_lobes || prefers(best, grown, samples, options)) best = grown;
    else break;
  }
  if (start != nullptr && start->family == options.family && static_cast<int>(start->lobes.size()) <= options.most_lobes) {
    MaterialFit other = refined({*start, best.model.error}, samples, options);
    if (options.choose_lobes || start->lobes.size() == best.model.brdf.lobes.size()) {
      if (prefers(best, other, samples, options)) best = other;
    }
  }
  set_criterion(best, samples, options.estimate_error ? best.model.error.independence : 1.0, options);
  return best;
}

MaterialFit fit_best_family(FitSamples samples, int channels, const MaterialFitOptions& options) {
  MaterialFit best;
  bool first = true;
  for (const BrdfFamily family : {BrdfFamily::Lafortune, BrdfFamily::Ggx, BrdfFamily::Ward}) {
    MaterialFitOptions own = options;
    own.family = family;
    MaterialFit fit = fit_material(samples, channels, nullptr, own);
    if (first || fit.criterion < best.criterion) best = fit;
    first = false;
  }
  return best;
}

}  // namespace lumitexel
