#include "processing/normals/fit_normals.h"

namespace lumitexel {

std::vector<NormalMaterial> normal_materials(const std::vector<std::vector<Brdf>>& bases, int channels, double median_reflectance,
                                             const NormalFitOptions& options) {
  const ErrorModel error(options.relative_error, std::max(1e-6, options.floor_share * median_reflectance));
  std::vector<NormalMaterial> materials;
  for (const std::vector<Brdf>& basis : bases) materials.emplace_back(basis, channels, error, options.texel);
  return materials;
}

std::vector<Eigen::Vector3d> normals_of(const LumitexelSet& lumitexels) {
  std::vector<Eigen::Vector3d> normals;
  for (const LumitexelTile& tile : lumitexels.tiles) normals.insert(normals.end(), tile.normal.begin(), tile.normal.end());
  return normals;
}

void turn(const std::vector<Eigen::Vector3d>& normals, LumitexelSet& lumitexels) {
  std::size_t i = 0;
  for (LumitexelTile& tile : lumitexels.tiles) {
    for (Eigen::Vector3d& normal : tile.normal) normal = normals[i++];
  }
}

FittedNormals fit_normals(const DirectedLumitexels& lumitexels, const Neighbours& neighbours, const std::vector<std::vector<Brdf>>& bases,
                          const std::vector<int>& label, double median_reflectance, const NormalFitOptions& options,
                          Uncertainty wanted, const std::function<void(int)>& after_step) {
  const std::vector<NormalMaterial> materials = normal_materials(bases, lumitexels.channels(), median_reflectance, options);
  const NormalProblem problem{lumitexels, neighbours, materials, label};
  const NormalField field = smooth_normals(problem, field_on_mesh(problem), {options.prior, options.most_steps}, after_step);
  FittedNormals fitted{field.normal, {}, {}};
  if (wanted == Uncertainty::None) return fitted;
  fitted.sigma = normal_sigmas(problem, field, options.prior, wanted == Uncertainty::Draws ? &fitted.prior_draws : nullptr);
  return fitted;
}

}  // namespace lumitexel
