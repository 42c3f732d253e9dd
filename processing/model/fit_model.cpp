#include "processing/model/fit_model.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "drivers/error.h"
#include "processing/brdf/cluster_materials.h"
#include "processing/brdf/material_basis.h"
#include "processing/brdf/paper_clustering.h"
#include "processing/brdf/principal_functions.h"
#include "processing/brdf/select_lumitexels.h"
#include "processing/model/fill_atlas.h"
#include "processing/model/observe.h"
#include "processing/model/provenance.h"
#include "processing/normals/fit_normals.h"
#include "processing/surface/best_view.h"
#include "processing/surface/gather_lumitexels.h"

namespace lumitexel {
namespace {

// The session's reflectances in the middle, 1/sr.
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

// The error model on this session's own scale, so that a dark object is not drowned in its floor.
ErrorModel error_model(const Observations& observations, const FitOptions& options) {
  if (observations.samples.empty()) return {};
  ErrorModel error;
  error.relative = options.relative_error;
  error.floor = std::max(1e-6, options.error_floor_share * median_reflectance(observations));
  return error;
}

ClusterOptions cluster_options(const FitOptions& options, const ErrorModel& error) {
  ClusterOptions cluster;
  cluster.errors = options.errors;
  cluster.materials = options.materials;
  cluster.final_lumitexels = options.final_lumitexels;
  cluster.fit.family = options.family;
  cluster.fit.most_lobes = options.most_lobes;
  cluster.fit.shared_shape = options.shared_lobe_shape;
  cluster.fit.error = error;
  return cluster;
}

Clustering learn_materials(const Observations& observations, const FitOptions& options, const ErrorModel& error,
                           Progress& progress) {
  const int wanted = options.materials > 0 ? options.materials : kMostMaterials;
  progress.begin("materials", wanted, "materials");
  const auto selection = select_lumitexels(observations, options.learning_lumitexels);
  if (selection.empty()) {
    throw Error("fit: no surface point has " + std::to_string(kFewestSamples) +
                " samples; more views or more light on the object are needed");
  }
  const auto report = [&](int found) { progress.update(std::min(found, wanted)); };
  if (options.method == FitMethod::Paper) {
    const PaperOptions paper{options.materials, options.most_lobes, options.intensity_weight, options.final_lumitexels};
    return paper_clustering(observations, selection, paper, report);
  }
  return cluster_materials(observations, selection, cluster_options(options, error), report);
}

std::vector<LumitexelList> members_of(const Clustering& clustering) {
  std::vector<LumitexelList> members(clustering.materials.size());
  for (std::size_t i = 0; i < clustering.label.size(); ++i) members[static_cast<std::size_t>(clustering.label[i])].push_back(i);
  return members;
}

PriorChoice prior_for(const Observations& observations, const LumitexelList& members, const std::vector<Brdf>& basis,
                      const MaterialModel& material, const FitOptions& options) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (options.plain_projection) return {{kInfinity, kInfinity}, 0.0, 0.0, 0};
  return choose_prior(observations, members, basis, material.brdf, material.error);
}

std::vector<TexelWeights> project_all(const Observations& observations, const Clustering& clustering, const Model& model,
                                      const FitOptions& options, FitSummary& summary, Progress& progress) {
  const std::vector<LumitexelList> members = members_of(clustering);
  std::vector<TexelWeights> weights(clustering.label.size());
  progress.begin("texel weights", static_cast<std::int64_t>(model.materials.size()), "materials");
  for (std::size_t j = 0; j < members.size(); ++j) {
    const auto& basis = model.materials[j].basis;
    const MaterialModel& material = clustering.materials[j].model;
    summary.prior.push_back(prior_for(observations, members[j], basis, material, options));
    const TexelPrior prior = summary.prior.back().prior;
    oneapi::tbb::parallel_for(std::size_t{0}, members[j].size(), [&](std::size_t k) {
      const std::size_t i = members[j][k];
      weights[i] = project_texel(observations.of(i), observations.channels, basis, material.brdf, material.error, prior);
    });
    summary.texels_by_material.push_back(static_cast<std::size_t>(std::count_if(
        members[j].begin(), members[j].end(), [&](std::size_t i) { return !observations.of(i).empty(); })));
    progress.update(static_cast<std::int64_t>(j + 1));
  }
  return weights;
}

// Each material's basis moved by principal function analysis, if lumitexels that it was not learnt from are then predicted better. The
// paper moves it always.
void move_bases(const Observations& observations, const Clustering& clustering, const FitOptions& options, const FitSummary& summary,
                Model& model, Progress& progress) {
  constexpr double kLeastGain = 0.005;  // of the left-out error: less is not worth other functions
  const std::vector<LumitexelList> members = members_of(clustering);
  progress.begin("basis functions", static_cast<std::int64_t>(members.size()), "materials");
  for (std::size_t j = 0; j < members.size(); ++j) {
    const MaterialModel& material = clustering.materials[j].model;
    std::vector<Brdf>& basis = model.materials[j].basis;
    PrincipalOptions principal;
    principal.most_lumitexels = options.final_lumitexels;
    principal.prior = summary.prior[j].prior;
    principal.fit = clustering.fit;
    const auto moved = [&](const LumitexelList& learnt) {
      return principal_functions(observations, learnt, basis, material.error, principal).basis;
    };
    bool better = options.method == FitMethod::Paper;
    if (!better) {
      LumitexelList learnt, left_out;
      for (std::size_t k = 0; k < members[j].size(); ++k) (k % 2 == 0 ? learnt : left_out).push_back(members[j][k]);
      const double before = prior_for(observations, left_out, basis, material, options).left_out_error;
      const double after = prior_for(observations, left_out, moved(learnt), material, options).left_out_error;
      better = after < (1.0 - kLeastGain) * before;
    }
    if (better) basis = moved(members[j]);
    progress.update(static_cast<std::int64_t>(j + 1));
  }
}

void set_materials(const Clustering& clustering, const Atlas& atlas, const LumitexelSet& lumitexels,
                   const Observations& observations, Model& model) {
  std::vector<Brdf> brdfs;
  for (const FittedMaterial& material : clustering.materials) brdfs.push_back(material.model.brdf);
  const auto counts = neighbour_counts(atlas, lumitexels, clustering.label, brdfs.size());
  const auto bases = material_bases(brdfs, counts, observations);
  for (std::size_t j = 0; j < brdfs.size(); ++j) model.materials.push_back({brdfs[j], bases[j], {}});
  model.single = clustering.single.brdf;
}

// The paper's errors are as large everywhere as reflectance itself: no sample would be an outlier by them.
std::vector<ErrorModel> outlier_errors(const Clustering& clustering, const ErrorModel& given, const FitOptions& options) {
  std::vector<ErrorModel> errors;
  for (const FittedMaterial& material : clustering.materials) {
    errors.push_back(options.method == FitMethod::Paper ? given : material.model.error);
  }
  return errors;
}

std::vector<std::string> names_of(const std::vector<View>& views) {
  std::vector<std::string> names;
  for (const View& view : views) names.push_back(view.name);
  return names;
}

std::vector<std::uint32_t> texels_of(const LumitexelSet& lumitexels) {
  std::vector<std::uint32_t> texels;
  for (const LumitexelTile& tile : lumitexels.tiles) texels.insert(texels.end(), tile.texel.begin(), tile.texel.end());
  return texels;
}

// What the chain from samples to weights leaves, beside the materials in the model.
struct Reflectance {
  Clustering clustering;
  std::vector<TexelWeights> weights, projection;  // projection: before principal function analysis, if that ran
};

struct FitInputs {
  const Atlas& atlas;
  const LumitexelSet& lumitexels;
  const Observations& observations;
  const FitOptions& options;
  const ErrorModel& error;
};

// Fills model.materials and model.single. `pass` goes into the names of the stages.
Reflectance fit_reflectance(const FitInputs& inputs, const std::string& pass, Model& model, FitSummary& summary, StageTimer& timer,
                            Progress& progress) {
  const auto& [atlas, lumitexels, observations, options, error] = inputs;
  Reflectance result;
  model.materials.clear();
  summary.prior.clear();
  summary.texels_by_material.clear();
  timer.begin("materials" + pass);
  result.clustering = learn_materials(observations, options, error, progress);
  summary.errors = result.clustering.errors;
  set_materials(result.clustering, atlas, lumitexels, observations, model);
  timer.begin("projection" + pass);
  result.weights = project_all(observations, result.clustering, model, options, summary, progress);
  return result;
}

void seek_principal_functions(const FitInputs& inputs, Reflectance& reflectance, Model& model, FitSummary& summary, StageTimer& timer,
                              Progress& progress) {
  timer.begin("principal functions");
  for (ModelMaterial& material : model.materials) material.projection_basis = material.basis;
  move_bases(inputs.observations, reflectance.clustering, inputs.options, summary, model, progress);
  summary.prior.clear();
  summary.texels_by_material.clear();
  reflectance.projection = std::move(reflectance.weights);
  reflectance.weights = project_all(inputs.observations, reflectance.clustering, model, inputs.options, summary, progress);
}

FittedNormals normals_of(const CalibratedSession& session, const FitInputs& inputs, const Reflectance& reflectance, const Model& model) {
  const DirectedLumitexels lumitexels(session, inputs.lumitexels);
  std::vector<std::vector<Brdf>> bases;
  for (const ModelMaterial& material : model.materials) bases.push_back(material.basis);
  return fit_normals(lumitexels, lumitexel_neighbours(lumitexels, inputs.atlas.width), bases, reflectance.clustering.label,
                     median_reflectance(inputs.observations), inputs.options.normal_fit);
}

void turn(const std::vector<Eigen::Vector3d>& normals, LumitexelSet& lumitexels) {
  std::size_t i = 0;
  for (LumitexelTile& tile : lumitexels.tiles) {
    for (Eigen::Vector3d& normal : tile.normal) normal = normals[i++];
  }
}

void set_normal_sigma(const LumitexelSet& lumitexels, const std::vector<float>& sigma_rad, double coarse_sigma_rad, Model& model) {
  model.normal_sigma = Image(model.width, model.height, 1, static_cast<float>(coarse_sigma_rad));
  std::size_t i = 0;
  for (const LumitexelTile& tile : lumitexels.tiles) {
    for (const std::uint32_t texel : tile.texel) model.normal_sigma.data[texel] = sigma_rad[i++];
  }
}

// What stands in the model so far becomes its stages before normals.
void keep_before_normals(Model& model) {
  model.before_normals = ReflectanceLayer{model.materials, std::move(model.material), std::move(model.weights),
                                          std::move(model.projection_weights)};
  model.projection_weights = Image();
}

}  // namespace

FittedModel fit_model(const CalibratedSession& session, const FitOptions& options, StageTimer timer, Progress& progress) {
  FittedModel result;
  Model& model = result.model;
  FitSummary& summary = result.summary;
  model.channels = session.channels;

  timer.begin("atlas");
  const RayScene scene(session.mesh);
  const std::vector<int> best_view = choose_best_views(session, scene);
  summary.unseen_triangles = static_cast<std::size_t>(std::count(best_view.begin(), best_view.end(), kUnseen));
  if (summary.unseen_triangles == best_view.size()) throw Error("fit: no view sees any triangle of the mesh");
  const Atlas atlas = lay_out(session, best_view, options.layout, summary.layout);

  timer.begin("lumitexels");
  GatheredLumitexels gathered = gather_lumitexels(session, atlas, scene, progress);
  Observations observations = observe(session, gathered.set);
  summary.lumitexels = observations.lumitexels();
  summary.samples = observations.samples.size();
  summary.rejected = gathered.rejected;
  summary.unusable = observations.rejected;
  for (std::size_t i = 0; i < observations.lumitexels(); ++i) summary.starved += observations.of(i).empty();

  const ErrorModel error = error_model(observations, options);
  summary.error = error;
  const FitInputs inputs{atlas, gathered.set, observations, options, error};
  Reflectance reflectance = fit_reflectance(inputs, "", model, summary, timer, progress);
  const auto error_at = [&](FitStage stage) {
    return stage_error(model, stage, observations, reflectance.clustering.label, reflectance.weights);
  };
  summary.single = error_at(FitStage::Single);
  summary.cluster = error_at(FitStage::Cluster);
  summary.projection = error_at(FitStage::Projection);
  if (options.principal_functions) {
    seek_principal_functions(inputs, reflectance, model, summary, timer, progress);
    summary.pfa = error_at(FitStage::Pfa);
  }
  fill_atlas(atlas, gathered.set, reflectance.clustering.label, reflectance.weights, reflectance.projection, model);
  if (options.normals) {
    timer.begin("normals");
    const FittedNormals normals = normals_of(session, inputs, reflectance, model);
    turn(normals.normal, gathered.set);
    observations = observe(session, gathered.set);
    keep_before_normals(model);
    const Brdf single = model.single;
    summary.texels_before_normals = summary.texels_by_material;
    reflectance = fit_reflectance(inputs, " on fitted normals", model, summary, timer, progress);
    model.single = single;
    summary.normal = error_at(FitStage::Normal);
    fill_atlas(atlas, gathered.set, reflectance.clustering.label, reflectance.weights, {}, model);
    set_normal_sigma(gathered.set, normals.sigma_rad, options.normal_fit.prior.coarse_sigma_rad, model);
  }

  timer.begin("model");
  summary.outliers = find_outliers(model, observations, outlier_errors(reflectance.clustering, error, options),
                                   reflectance.clustering.label, reflectance.weights, session.views.size());
  model.outliers_csv = outliers_csv(summary.outliers, names_of(session.views), texels_of(gathered.set), atlas.width);
  timer.end();
  summary.stages = timer.stages();
  model.provenance_json = provenance_json(session, options, summary);
  return result;
}

}  // namespace lumitexel
