#include "processing/normals/fit_normals.h"

namespace lumitexel {
namespace {

std::vector<NormalMaterial> materials_of(const std::vector<std::vector<Brdf>>& bases, int channels, double median_reflectance,
                                         const NormalFitOptions& options) {
  const ErrorModel error(options.relative_error, std::max(1e-6, options.floor_share * median_reflectance));
  std::vector<NormalMaterial> materials;
  for (const std::vector<Brdf>& basis : bases) materials.emplace_back(basis, channels, error, options.texel);
  return materials;
}

NormalField on_the_mesh(const NormalProblem& problem) {
  NormalField field{std::vector<Eigen::Vector3d>(problem.lumitexels.size()), std::vector<TexelWeights>(problem.lumitexels.size())};
  for (std::size_t i = 0; i < field.normal.size(); ++i) {
    field.normal[i] = problem.lumitexels.coarse_normal(i);
    field.weights[i].weight.assign(problem.material_of(i).basis.size(), 0.0f);
    field.weights[i].weight[0] = 1.0f;
  }
  return field;
}

}  // namespace

FittedNormals fit_normals(const DirectedLumitexels& lumitexels, const Neighbours& neighbours, const std::vector<std::vector<Brdf>>& bases,
                          const std::vector<int>& label, double median_reflectance, const NormalFitOptions& options) {
  const std::vector<NormalMaterial> materials = materials_of(bases, lumitexels.channels(), median_reflectance, options);
  const NormalProblem problem{lumitexels, neighbours, materials, label};
  const NormalField field = smooth_normals(problem, on_the_mesh(problem), {options.prior, options.steps});
  return {field.normal, normal_sigmas(problem, field, options.prior)};
}

}  // namespace lumitexel
