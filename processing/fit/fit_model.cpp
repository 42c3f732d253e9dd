#include "processing/fit/fit_model.h"

#include <algorithm>
#include <utility>

#include "processing/fit/fill_atlas.h"
#include "processing/fit/indirect_trial.h"
#include "processing/fit/interreflection_stage.h"
#include "processing/fit/normal_stage.h"
#include "processing/fit/observe.h"
#include "processing/fit/provenance.h"
#include "processing/fit/reflectance_stage.h"
#include "processing/fit/unseen_mesh.h"
#include "processing/surface/best_view.h"
#include "processing/surface/gather_lumitexels.h"

namespace lumitexel {
namespace {

std::vector<ErrorModel> outlier_errors(const Clustering& clustering, const std::optional<ErrorModel>& of_all) {
  std::vector<ErrorModel> errors;
  for (const FittedMaterial& material : clustering.materials) errors.push_back(of_all.value_or(material.model.error));
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

void count_samples(const Observations& observations, FitSummary& summary) {
  summary.lumitexels = observations.lumitexels();
  summary.samples = observations.samples.size();
  summary.unusable = observations.rejected;
  summary.starved = 0;
  for (std::size_t i = 0; i < observations.lumitexels(); ++i) summary.starved += observations.of(i).empty();
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
  if (summary.unseen_triangles == best_view.size()) refuse_unseen_mesh(session);
  const Atlas atlas = lay_out(session, best_view, options.layout, summary.layout);

  timer.begin("lumitexels");
  GatheredLumitexels gathered = gather_lumitexels(session, atlas, scene, progress);
  Observations observations;
  ErrorModel error;
  // Again whenever samples or normals have changed: samples may now be below their normals.
  const auto look = [&] {
    observations = observe(session, gathered.set);
    error = error_model(observations, options);
    count_samples(observations, summary);
  };
  look();
  summary.rejected = gathered.rejected;
  summary.error = error;
  const FitInputs inputs{atlas, gathered.set, observations, options, error};
  Reflectance reflectance;
  const auto error_at = [&](FitStage stage) {
    return stage_error(model, stage, observations, reflectance.clustering.label, reflectance.weights);
  };
  const auto fill = [&] {
    fill_atlas(atlas, gathered.set, reflectance.clustering.label, reflectance.weights, reflectance.projection, model);
  };
  const auto fit_on_mesh_normals = [&](const MaterialsBefore& before, const std::string& pass) {
    reflectance = fit_reflectance(inputs, before, pass, model, summary, timer, progress);
    summary.single = error_at(FitStage::Single);
    summary.cluster = error_at(FitStage::Cluster);
    summary.projection = error_at(FitStage::Projection);
    if (options.principal_functions) {
      seek_principal_functions(inputs, reflectance, model, summary, timer, progress);
      summary.pfa = error_at(FitStage::Pfa);
    }
    fill();
  };
  // The one BRDF for everything stays that of the mesh's normals: it is the stage before all others.
  const auto fit_on_fitted_normals = [&](const MaterialsBefore& before, const std::string& pass) {
    const Brdf single = model.single;
    reflectance = fit_reflectance(inputs, before, pass, model, summary, timer, progress);
    model.single = single;
    if (options.principal_functions) {
      seek_principal_functions(inputs, reflectance, model, summary, timer, progress);
      for (ModelMaterial& material : model.materials) material.projection_basis.clear();  // the last stage has no stages of its own
      reflectance.projection.clear();
    }
    summary.normal = error_at(FitStage::Normal);
    fill();
  };
  const auto fit_again = [&](bool anew, const std::string& pass) {
    const MaterialsBefore before{&reflectance.clustering, anew};
    has_normals(model) ? fit_on_fitted_normals(before, pass) : fit_on_mesh_normals(before, pass);
  };
  fit_on_mesh_normals({}, "");

  const auto take_out = [&](IndirectRemoval& removal, FitStage stage) {
    progress.begin("light between surfaces", 1, "rounds");
    const bool worth_it = removal.remove(model, stage);
    progress.update(1);
    if (worth_it) model.indirect_bounces = options.interreflections.light.bounces;
    return worth_it;
  };
  std::optional<IndirectRemoval> indirect;
  std::optional<IndirectWorth> indirect_worth;
  // Whether the samples show what was taken out of them; else it is put back.
  const auto is_shown = [&] {
    const Observations as_photographed = std::move(observations);
    const ErrorModel error_as_photographed = error;
    look();
    indirect_worth = try_without_indirect(as_photographed, observations, model, reflectance.clustering.label, reflectance.weights, error_as_photographed);
    return indirect_worth->enough();
  };
  bool changed = false;
  if (options.interreflections.choice != InterreflectionChoice::Off) {
    timer.begin("light between surfaces");
    indirect.emplace(session, gathered.set, scene, model, options.interreflections);
    if (indirect->can_matter()) changed = take_out(*indirect, last_stage(model));
    const bool put_back = changed && !is_shown() && options.interreflections.choice == InterreflectionChoice::Auto;
    if (put_back) {
      indirect->put_back();
      model.indirect_bounces = 0;
    } else if (changed) {
      indirect->even_out_variance();
    }
    if (changed) look();
    changed = changed && !put_back;
  }
  if (want_normals(session, inputs, reflectance.clustering, summary, timer, progress)) {
    const std::vector<Eigen::Vector3d> of_mesh = normals_of(gathered.set);
    for (int round = 1; round <= options.normal_rounds; ++round) {
      const std::string again = round == 1 ? "" : ", round " + std::to_string(round);
      turn(of_mesh, gathered.set);
      const SoughtNormals normals = find_normals(session, inputs, reflectance.clustering, model, round == options.normal_rounds, again, summary, timer, progress);
      if (round == 1) keep_before_normals(model, summary);
      turn(normals.normal, gathered.set);
      look();
      set_normal_sigma(gathered.set, normals, model);
      fit_again(round == 1, " on fitted normals" + again);
    }
  } else if (changed) {
    fit_again(true, " without light between surfaces");
  }
  for (int round = 2; changed && round <= options.interreflections.rounds; ++round) {
    timer.begin("light between surfaces, round " + std::to_string(round));
    changed = take_out(*indirect, last_stage(model));
    if (!changed) break;
    indirect->even_out_variance();
    look();
    fit_again(false, ", round " + std::to_string(round));
  }
  if (indirect) {
    summary.indirect = indirect->summary();
    summary.indirect->worth = indirect_worth;
    model.indirect = indirect->map(model.width, model.height);
  }

  timer.begin("model");
  // The paper's errors are as large everywhere as reflectance itself: no sample would be an outlier by them.
  if (options.method == FitMethod::Paper) summary.outlier_error = error;
  summary.outliers = find_outliers(model, observations, outlier_errors(reflectance.clustering, summary.outlier_error),
                                   reflectance.clustering.label, reflectance.weights, session.views.size());
  model.outliers_csv = outliers_csv(summary.outliers, names_of(session.views), texels_of(gathered.set), atlas.width);
  timer.end();
  summary.stages = timer.stages();
  model.provenance_json = provenance_json(session, options, summary);
  return result;
}

}  // namespace lumitexel
