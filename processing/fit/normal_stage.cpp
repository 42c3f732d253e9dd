#include "processing/fit/normal_stage.h"

#include "processing/fit/normal_trial.h"
#include "processing/normals/sigma_scale.h"

namespace lumitexel {

bool want_normals(const CalibratedSession& session, const FitInputs& inputs, const Clustering& materials, FitSummary& summary, StageTimer& timer,
                  Progress& progress) {
  if (inputs.options.normals != NormalChoice::Auto) return inputs.options.normals != NormalChoice::Mesh;
  timer.begin("are normals worth it");
  progress.begin("are normals worth it", 1, "trials");
  summary.normals_worth = try_normals(session, inputs, materials);
  progress.update(1);
  return summary.normals_worth->enough();
}

SoughtNormals find_normals(const CalibratedSession& session, const FitInputs& inputs, const Clustering& materials, const Model& model, bool sigmas,
                           const std::string& pass, FitSummary& summary, StageTimer& timer, Progress& progress) {
  const FitOptions& options = inputs.options;
  NormalFitOptions normal_fit = options.normal_fit;
  if (options.normals == NormalChoice::Texel) normal_fit.prior = NormalPrior::alone();
  const std::vector<std::vector<Brdf>> bases = bases_of(model);
  const double median = median_reflectance(inputs.observations);
  timer.begin("normals" + pass);
  progress.begin("normals" + pass, normal_fit.most_steps, "steps");
  const DirectedLumitexels lumitexels(session, inputs.lumitexels);
  FittedNormals fitted = fit_normals(lumitexels, lumitexel_neighbours(lumitexels, inputs.atlas.width), bases, materials.label, median, normal_fit,
                                     sigmas ? Uncertainty::Sigmas : Uncertainty::None, [&](int step) { progress.update(step); });
  SoughtNormals sought{std::move(fitted.normal), {}, normal_fit.prior};
  if (sigmas) {
    summary.normal_sigma_scale =
        normal_sigma_scale(session, inputs.lumitexels, inputs.atlas.width, bases, materials.label, median, normal_fit);
    sought.sigma_rad = widened(fitted.sigma, *summary.normal_sigma_scale, normal_fit.prior);
  } else {
    sought.sigma_rad.assign(sought.normal.size(), static_cast<float>(normal_fit.prior.coarse_sigma_rad));
  }
  return sought;
}

void keep_before_normals(Model& model, FitSummary& summary) {
  model.before_normals = ReflectanceLayer{model.materials, std::move(model.material), std::move(model.weights),
                                          std::move(model.projection_weights)};
  model.projection_weights = Image();
  summary.texels_before_normals = summary.texels_by_material;
}

void set_normal_sigma(const LumitexelSet& lumitexels, const SoughtNormals& normals, Model& model) {
  model.normal_sigma = Image(model.width, model.height, 1, static_cast<float>(normals.prior.coarse_sigma_rad));
  std::size_t i = 0;
  for (const LumitexelTile& tile : lumitexels.tiles) {
    for (const std::uint32_t texel : tile.texel) model.normal_sigma.data[texel] = normals.sigma_rad[i++];
  }
}

}  // namespace lumitexel
