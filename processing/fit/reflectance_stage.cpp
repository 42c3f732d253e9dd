#include "processing/fit/reflectance_stage.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "drivers/error.h"
#include "processing/brdf/choose_bases.h"
#include "processing/brdf/choose_functions.h"
#include "processing/brdf/material_basis.h"
#include "processing/brdf/paper_clustering.h"
#include "processing/brdf/principal_functions.h"
#include "processing/brdf/select_lumitexels.h"
#include "processing/fit/fill_atlas.h"

namespace lumitexel {
namespace {

ClusterOptions cluster_options(const FitOptions& options, const ErrorModel& error, const MaterialsBefore& before) {
  ClusterOptions cluster;
  cluster.before = before;
  cluster.errors = options.errors;
  cluster.materials = options.materials;
  cluster.final_lumitexels = options.final_lumitexels;
  cluster.draw = options.draw;
  cluster.fit.family = options.family.value_or(BrdfFamily::Lafortune);
  cluster.any_family = !options.family;
  cluster.fit.most_lobes = options.most_lobes;
  cluster.lobe_shapes = options.lobe_shapes;
  cluster.fit.error = error;
  return cluster;
}

Clustering learn_materials(const Observations& observations, const FitOptions& options, const ErrorModel& error,
                           const MaterialsBefore& before, Progress& progress) {
  const auto selection = select_lumitexels(observations, options.learning_lumitexels, options.draw);
  if (selection.empty()) {
    throw Error("fit: no surface point has " + std::to_string(kFewestSamples) +
                " samples; more views or more light on the object are needed");
  }
  const auto report = [&](int done) { progress.update(done); };
  if (options.method == FitMethod::Paper) {
    progress.begin("materials", options.materials, "materials");
    const PaperOptions paper{options.materials, options.most_lobes, options.intensity_weight, options.final_lumitexels, options.draw};
    return paper_clustering(observations, selection, paper, report);
  }
  const ClusterOptions cluster = cluster_options(options, error, before);
  progress.begin("materials", clustering_steps(cluster), "steps");
  return cluster_materials(observations, selection, cluster, report);
}

std::vector<LumitexelList> members_of(const Clustering& clustering) {
  std::vector<LumitexelList> members(clustering.materials.size());
  for (std::size_t i = 0; i < clustering.label.size(); ++i) members[static_cast<std::size_t>(clustering.label[i])].push_back(i);
  return members;
}

PriorChoice prior_for(const Observations& observations, const LumitexelList& members, const std::vector<Brdf>& basis,
                      const MaterialModel& material, const FitOptions& options) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (options.plain_projection) return {{kInfinity, kInfinity}, 0.0, 0.0, 0, {}};
  return choose_prior(observations, members, TexelBasis(basis, material.brdf, material.error, options.precision));
}

std::string with_material(const std::string& what, std::size_t material) { return what + " of material " + std::to_string(material); }

// Without a prior left-out samples are not asked, and all bases stay.
PriorChoice choose_prior_and_bases(const Observations& observations, const LumitexelList& members, const MaterialModel& material,
                                   const FitOptions& options, bool shrinks, std::size_t index, std::vector<Brdf>& basis,
                                   std::vector<Choice>& choices) {
  if (!shrinks || options.plain_projection) return prior_for(observations, members, basis, material, options);
  const BasesChoice choice = choose_bases(observations, members, basis, material.error, options.precision);
  if (choice.gain) {
    choices.push_back({with_material("functions mixed by a texel", index), std::to_string(basis.size()), std::to_string(1 + kVariations), *choice.gain,
                       choice.bases == basis.size()});
  }
  basis.resize(choice.bases);
  return choice.prior;
}

std::vector<TexelWeights> project_all(const Observations& observations, const Clustering& clustering, const FitOptions& options,
                                      bool shrinks, Model& model, FitSummary& summary, Progress& progress) {
  const std::vector<LumitexelList> members = members_of(clustering);
  std::vector<TexelWeights> weights(clustering.label.size());
  progress.begin("texel weights", static_cast<std::int64_t>(model.materials.size()), "materials");
  for (std::size_t j = 0; j < members.size(); ++j) {
    const MaterialModel& material = clustering.materials[j].model;
    summary.prior.push_back(choose_prior_and_bases(observations, members[j], material, options, shrinks, j, model.materials[j].basis, summary.choices.back().choices));
    summary.bases_by_material.push_back(model.materials[j].basis.size());
    const TexelPrior prior = summary.prior.back().prior;
    const TexelBasis basis(model.materials[j].basis, material.brdf, material.error, options.precision);
    oneapi::tbb::parallel_for(std::size_t{0}, members[j].size(), [&](std::size_t k) {
      const std::size_t i = members[j][k];
      weights[i] = project_texel(observations.of(i), basis, prior);
    });
    summary.texels_by_material.push_back(static_cast<std::size_t>(std::count_if(
        members[j].begin(), members[j].end(), [&](std::size_t i) { return !observations.of(i).empty(); })));
    progress.update(static_cast<std::int64_t>(j + 1));
  }
  return weights;
}

// Each material's basis moved by principal function analysis, if lumitexels that it was not learnt from are then predicted better. The
// paper moves it always.
void move_bases(const Observations& observations, const Clustering& clustering, const FitOptions& options, FitSummary& summary,
                Model& model, Progress& progress) {
  const std::vector<LumitexelList> members = members_of(clustering);
  progress.begin("basis functions", static_cast<std::int64_t>(members.size()), "materials");
  for (std::size_t j = 0; j < members.size(); ++j) {
    const MaterialModel& material = clustering.materials[j].model;
    std::vector<Brdf>& basis = model.materials[j].basis;
    PrincipalOptions principal;
    principal.most_lumitexels = options.final_lumitexels;
    principal.draw = options.draw;
    principal.prior = summary.prior[j].prior;
    principal.fit = clustering.fit;
    bool better = options.method == FitMethod::Paper;
    if (!better) {
      const FunctionsChoice choice = choose_functions(observations, members[j], basis, material, principal, options.precision);
      better = choice.moved;
      summary.choices.back().choices.push_back({with_material("functions", j), "moved", "as found", choice.gain, better});
    }
    if (better) basis = principal_functions(observations, members[j], basis, material.error, principal).basis;
    progress.update(static_cast<std::int64_t>(j + 1));
  }
}

void set_materials(const Clustering& clustering, const Atlas& atlas, const LumitexelSet& lumitexels,
                   const Observations& observations, std::size_t most_bases, Model& model) {
  std::vector<Brdf> brdfs;
  for (const FittedMaterial& material : clustering.materials) brdfs.push_back(material.model.brdf);
  const auto counts = neighbour_counts(atlas, lumitexels, clustering.label, brdfs.size());
  const auto bases = material_bases(brdfs, counts, observations);
  for (std::size_t j = 0; j < brdfs.size(); ++j) {
    const auto end = bases[j].begin() + static_cast<std::ptrdiff_t>(std::min(bases[j].size(), most_bases));
    model.materials.push_back({brdfs[j], {bases[j].begin(), end}, {}, clustering.materials[j].sigma, clustering.materials[j].model.error});
  }
  model.single = clustering.single.brdf;
}

// The first is on the mesh's normals; what another differs in, its pass says, as it is put behind a stage's name.
std::string name_of_fit(const std::string& pass) {
  const std::size_t start = pass.find_first_not_of(", ");
  return start == std::string::npos ? "on the mesh's normals" : pass.substr(start);
}

}  // namespace

double median_reflectance(const Observations& observations) {
  std::vector<float> values;
  for (const Observation& sample : observations.samples) {
    values.insert(values.end(), sample.reflectance.begin(), sample.reflectance.begin() + observations.channels);
  }
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

std::vector<std::vector<Brdf>> bases_of(const Model& model) {
  std::vector<std::vector<Brdf>> bases;
  for (const ModelMaterial& material : model.materials) bases.push_back(material.basis);
  return bases;
}

ErrorModel error_model(const Observations& observations, const FitOptions& options) {
  if (observations.samples.empty()) return {};
  ErrorModel error;
  error.relative = options.relative_error;
  error.floor = std::max(1e-6, options.error_floor_share * median_reflectance(observations));
  return error;
}

Reflectance fit_reflectance(const FitInputs& inputs, const MaterialsBefore& before, const std::string& pass, Model& model, FitSummary& summary,
                            StageTimer& timer, Progress& progress) {
  const auto& [atlas, lumitexels, observations, options, error] = inputs;
  Reflectance result;
  model.materials.clear();
  summary.prior.clear();
  summary.bases_by_material.clear();
  summary.texels_by_material.clear();
  summary.lobes_by_material.clear();
  timer.begin("materials" + pass);
  result.clustering = learn_materials(observations, options, error, before, progress);
  summary.choices.push_back({name_of_fit(pass), result.clustering.choices});
  summary.errors = result.clustering.errors;
  summary.family = result.clustering.fit.family;
  summary.lobe_shapes = result.clustering.fit.shared_shape ? LobeShapes::Shared : LobeShapes::Separate;
  for (const FittedMaterial& material : result.clustering.materials) summary.lobes_by_material.push_back(material.model.brdf.lobes.size());
  const std::size_t most_bases = options.bases > 0 ? static_cast<std::size_t>(options.bases) : kMaxBasis;
  set_materials(result.clustering, atlas, lumitexels, observations, most_bases, model);
  timer.begin("projection" + pass);
  result.weights = project_all(observations, result.clustering, options, options.bases == 0, model, summary, progress);
  return result;
}

void seek_principal_functions(const FitInputs& inputs, Reflectance& reflectance, Model& model, FitSummary& summary, StageTimer& timer,
                              Progress& progress) {
  timer.begin("principal functions");
  for (ModelMaterial& material : model.materials) material.projection_basis = material.basis;
  move_bases(inputs.observations, reflectance.clustering, inputs.options, summary, model, progress);
  summary.prior.clear();
  summary.bases_by_material.clear();
  summary.texels_by_material.clear();
  reflectance.projection = std::move(reflectance.weights);
  reflectance.weights = project_all(inputs.observations, reflectance.clustering, inputs.options, false, model, summary, progress);
}

}  // namespace lumitexel
