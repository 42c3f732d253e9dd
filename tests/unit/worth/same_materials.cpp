#include "tests/unit/worth/same_materials.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "processing/brdf/material_basis.h"
#include "processing/fit/fill_atlas.h"
#include "processing/fit/observe.h"
#include "processing/fit/reflectance_stage.h"
#include "processing/surface/best_view.h"
#include "processing/surface/gather_lumitexels.h"

namespace lumitexel {
namespace {

// Of a session, as a fit lays it out: texels are its pixels.
struct Looked {
  Atlas atlas;
  LumitexelSet lumitexels;
  Observations observations;
};

Looked look(const CalibratedSession& session) {
  NoProgress quiet;
  const RayScene scene(session.mesh);
  Looked looked{make_atlas(session, choose_best_views(session, scene)), {}, {}};
  looked.lumitexels = gather_lumitexels(session, looked.atlas, scene, quiet).set;
  looked.observations = observe(session, looked.lumitexels);
  return looked;
}

std::vector<LumitexelList> members_of(const std::vector<int>& label, std::size_t materials) {
  std::vector<LumitexelList> members(materials);
  for (std::size_t i = 0; i < label.size(); ++i) members[static_cast<std::size_t>(label[i])].push_back(i);
  return members;
}

}  // namespace

SameMaterials::SameMaterials(const CalibratedSession& reference, const FitOptions& options) : options_(options) {
  NoProgress quiet;
  StageTimer timer;
  FitSummary summary;
  Model model;
  const Looked looked = look(reference);
  options_.bases = kMaxBasis;  // how many pay is one more such choice
  const ErrorModel error = error_model(looked.observations, options_);
  const FitInputs inputs{looked.atlas, looked.lumitexels, looked.observations, options_, error};
  clustering_ = fit_reflectance(inputs, {}, "", model, summary, timer, quiet).clustering;
  for (const PriorChoice& choice : summary.prior) prior_.push_back(choice.prior);
}

// Each lumitexel's most probable material; those without samples get the largest.
std::vector<int> SameMaterials::labels_of(const Observations& observations) const {
  Mixture mixture;
  const LumitexelList seen = with_samples(observations);
  std::size_t largest = 0;
  for (const FittedMaterial& material : clustering_.materials) {
    if (material.members > clustering_.materials[largest].members) largest = mixture.materials.size();
    mixture.materials.push_back(material.model);
    mixture.share.push_back(static_cast<double>(material.members) / static_cast<double>(clustering_.label.size()));
  }
  const Responsibilities r = responsibilities(mixture, observations, seen);
  std::vector<int> labels(observations.lumitexels(), static_cast<int>(largest));
  for (std::size_t l = 0; l < seen.size(); ++l) {
    const auto first = r.probability.begin() + static_cast<std::ptrdiff_t>(l * r.materials);
    labels[seen[l]] = static_cast<int>(std::max_element(first, first + static_cast<std::ptrdiff_t>(r.materials)) - first);
  }
  return labels;
}

Model SameMaterials::fit(const CalibratedSession& session) const {
  const Looked looked = look(session);
  const Observations& observations = looked.observations;
  const std::vector<int> label = labels_of(observations);
  const std::vector<LumitexelList> members = members_of(label, clustering_.materials.size());
  Model model;
  model.channels = session.channels;
  std::vector<Brdf> brdfs;
  for (std::size_t k = 0; k < members.size(); ++k) {
    const MaterialModel& material = clustering_.materials[k].model;
    const auto samples = samples_of(observations, thinned(members[k], options_.final_lumitexels));
    brdfs.push_back(fit_brdf(material.brdf, samples, refit_options(material, clustering_.fit)).brdf);
  }
  const auto bases = material_bases(brdfs, neighbour_counts(looked.atlas, looked.lumitexels, label, brdfs.size()), observations);
  std::vector<TexelBasis> mixed;
  for (std::size_t k = 0; k < brdfs.size(); ++k) mixed.emplace_back(bases[k], brdfs[k], clustering_.materials[k].model.error);
  std::vector<TexelWeights> weights(label.size());
  tbb::parallel_for(std::size_t{0}, weights.size(), [&](std::size_t i) {
    const auto k = static_cast<std::size_t>(label[i]);
    weights[i] = project_texel(observations.of(i), mixed[k], prior_[k]);
  });
  for (std::size_t k = 0; k < brdfs.size(); ++k) model.materials.push_back({brdfs[k], bases[k], {}});
  model.single = clustering_.single.brdf;
  fill_atlas(looked.atlas, looked.lumitexels, label, weights, {}, model);
  return model;
}

}  // namespace lumitexel
