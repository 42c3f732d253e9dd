#include "processing/brdf/paper_clustering.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

#include "processing/brdf/split_directions.h"

namespace lumitexel {
namespace {

constexpr int kHalvesRounds = 10, kGlobalRounds = 20;
constexpr double kSettled = 0.001;   // share of labels that may still move
constexpr std::size_t kFewest = 20;  // lumitexels that a material must keep

struct Materials {
  std::vector<Brdf> brdfs;
  std::vector<int> label;      // of each lumitexel in the list at hand
  std::vector<double> error;   // E_f of each under its material
};

MaterialFitOptions as_published(const Observations& observations, const PaperOptions& options) {
  MaterialFitOptions fit;
  fit.most_lobes = options.lobes;
  fit.choose_lobes = false;
  fit.shared_shape = false;
  fit.estimate_error = false;
  fit.any_aim = true;
  fit.error = ErrorModel::paper(observations.channels, options.intensity_weight);
  return fit;
}

// Mean over the lumitexel's samples (eq. 6).
double lumitexel_error(const Brdf& brdf, std::span<const Observation> samples, const ErrorModel& error) {
  double sum = 0.0;
  for (const Observation& sample : samples) {
    sum += sample_misfit(error, sample, brdf.channels, predicted_reflectance(brdf, sample.geometry)).squares;
  }
  return samples.empty() ? 0.0 : sum / static_cast<double>(samples.size());
}

class PaperClusterer {
 public:
  PaperClusterer(const Observations& observations, const MaterialFitOptions& fit) : observations_(observations), fit_(fit) {}

  BrdfFit fit(const LumitexelList& members, const Brdf* start) const {
    const auto samples = samples_of(observations_, members);
    if (start == nullptr) return fit_material(samples, observations_.channels, nullptr, fit_).fit;
    BrdfFitOptions options = refit_options({*start, fit_.error}, fit_);
    options.reweightings = 1;  // absolute residuals: there is nothing to reweight by
    return fit_brdf(*start, samples, options);
  }

  void assign(const LumitexelList& lumitexels, Materials& materials) const {
    materials.label.assign(lumitexels.size(), 0);
    materials.error.assign(lumitexels.size(), 0.0);
    oneapi::tbb::parallel_for(std::size_t{0}, lumitexels.size(), [&](std::size_t l) {
      for (std::size_t k = 0; k < materials.brdfs.size(); ++k) {
        const double error = lumitexel_error(materials.brdfs[k], observations_.of(lumitexels[l]), fit_.error);
        if (k > 0 && error >= materials.error[l]) continue;
        materials.error[l] = error;
        materials.label[l] = static_cast<int>(k);
      }
    });
  }

  // Assigns and refits in turn until hardly a label moves.
  void recluster(const LumitexelList& lumitexels, Materials& materials, int rounds) const {
    assign(lumitexels, materials);
    for (int round = 0; round < rounds; ++round) {
      const std::vector<int> before = materials.label;
      oneapi::tbb::parallel_for(std::size_t{0}, materials.brdfs.size(), [&](std::size_t k) {
        const LumitexelList members = members_of(lumitexels, materials.label, k);
        if (members.size() >= kFewest) materials.brdfs[k] = fit(members, &materials.brdfs[k]).brdf;
      });
      assign(lumitexels, materials);
      std::size_t moved = 0;
      for (std::size_t l = 0; l < before.size(); ++l) moved += before[l] != materials.label[l];
      if (static_cast<double>(moved) <= kSettled * static_cast<double>(before.size())) break;
    }
  }

  static LumitexelList members_of(const LumitexelList& lumitexels, const std::vector<int>& label, std::size_t material) {
    LumitexelList members;
    for (std::size_t l = 0; l < lumitexels.size(); ++l) {
      if (label[l] == static_cast<int>(material)) members.push_back(lumitexels[l]);
    }
    return members;
  }

  // False if the material of largest error cannot be split.
  bool split(const LumitexelList& lumitexels, Materials& materials) const {
    std::vector<double> total(materials.brdfs.size(), 0.0);
    for (std::size_t l = 0; l < lumitexels.size(); ++l) total[static_cast<std::size_t>(materials.label[l])] += materials.error[l];
    const auto worst = static_cast<std::size_t>(std::max_element(total.begin(), total.end()) - total.begin());
    const LumitexelList members = members_of(lumitexels, materials.label, worst);
    if (members.size() < 2 * kFewest) return false;
    const BrdfFit whole = fit(members, &materials.brdfs[worst]);
    const BrdfPair pair = split_along_covariance(whole.brdf, whole.covariance,
                                                 parameters_of(whole.brdf, refit_options({whole.brdf, fit_.error}, fit_)));
    Materials halves{{pair.first, pair.second}, {}, {}};
    recluster(members, halves, kHalvesRounds);
    materials.brdfs[worst] = halves.brdfs[0];
    materials.brdfs.push_back(halves.brdfs[1]);
    recluster(lumitexels, materials, kGlobalRounds);
    return true;
  }

 private:
  const Observations& observations_;
  const MaterialFitOptions& fit_;
};

}  // namespace

Clustering paper_clustering(const Observations& observations, const LumitexelList& selection, const PaperOptions& options,
                            const std::function<void(int)>& report) {
  const MaterialFitOptions fit = as_published(observations, options);
  const PaperClusterer clusterer(observations, fit);
  Clustering result;
  result.fit = fit;
  Materials materials{{clusterer.fit(selection, nullptr).brdf}, {}, {}};
  clusterer.assign(selection, materials);
  for (int found = 1; found < options.materials && clusterer.split(selection, materials); ++found) report(found + 1);

  const LumitexelList all = with_samples(observations);
  clusterer.assign(all, materials);
  result.single = {clusterer.fit(thinned(all, options.final_lumitexels, options.draw), nullptr).brdf, fit.error};
  for (std::size_t k = 0; k < materials.brdfs.size(); ++k) {
    const LumitexelList members = PaperClusterer::members_of(all, materials.label, k);
    const LumitexelList finalists = thinned(members, options.final_lumitexels, options.draw);
    const BrdfFit final_fit = clusterer.fit(finalists, &materials.brdfs[k]);
    if (!members.empty()) materials.brdfs[k] = final_fit.brdf;
    const MaterialModel model{materials.brdfs[k], fit.error};
    result.materials.push_back({model, final_fit, 0, sigma_of(model, samples_of(observations, finalists), fit)});
  }
  clusterer.assign(all, materials);
  set_labels(materials.label, all, observations.lumitexels(), result);
  return result;
}

}  // namespace lumitexel
