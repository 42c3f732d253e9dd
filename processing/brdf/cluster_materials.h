// Finds the materials of an object by clustering lumitexels: section 7 of the paper's task, solved as a mixture.
#pragma once

#include <functional>
#include <vector>

#include "processing/brdf/choice.h"
#include "processing/brdf/fit_material.h"
#include "processing/brdf/mixture.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

// Whose error model the materials are fitted with. Given: MaterialFitOptions::error, and BRDFs that are the best mean prediction.
// Estimated: from each material's own residuals, outlying samples counting less. Labels: estimated for telling materials apart, while BRDFs
// are mean predictions under the given one. Auto: whichever predicts left-out samples best (error_choice.h).
enum class ErrorSource { Given, Labels, Estimated, Auto };
const char* to_string(ErrorSource source);  // "given", "labels", "estimated", "auto"

// One lobe shape for all channels of a material or one a channel; Auto: the latter where that predicts left-out samples better.
enum class LobeShapes { Shared, Separate, Auto };
const char* to_string(LobeShapes shapes);  // "shared", "separate", "auto"

struct Clustering;

// Materials of the same lumitexels before their samples or normals changed: adapted to what they are now, they are one more candidate
// beside those found anew, or without `anew` the only one. A search from nothing may end elsewhere for no reason but chance.
struct MaterialsBefore {
  const Clustering* clustering = nullptr;
  bool anew = true;
};

struct ClusterOptions {
  ErrorSource errors = ErrorSource::Auto;
  int materials = 4;                    // 0: as many as the samples ask for, from a search that begins with about twice kMostMaterials
  std::size_t final_lumitexels = 5000;  // a material's final fit takes about so many of its members
  int draw = 0;                         // which of them (draw_phase.h)
  MaterialFitOptions fit;               // its shared_shape is what `lobe_shapes` says
  bool any_family = false;              // true: fit.family, or another where that predicts left-out samples better
  LobeShapes lobe_shapes = LobeShapes::Shared;
  MaterialsBefore before;
};
inline constexpr int kMostMaterials = 12;

struct FittedMaterial {
  MaterialModel model;
  BrdfFit fit;              // with the covariance
  std::size_t members = 0;  // lumitexels
  BrdfSigma sigma{};        // of model.brdf, from its final samples
};

struct Clustering {
  MaterialModel single;                   // one BRDF for everything, the best mean prediction under the given error model
  std::vector<FittedMaterial> materials;  // fewer than asked for if the samples do not tell so many apart
  ErrorSource errors = ErrorSource::Given;  // which source it was
  std::vector<Choice> choices;            // that left-out samples made on the way
  MaterialFitOptions fit;                 // as every material was fitted at the end: which family, which shapes
  std::vector<int> label;                 // material of every lumitexel; those without samples get the largest material
};

// Counts members, and labels the lumitexels without samples with the largest material. label: of each in `all`.
void set_labels(const std::vector<int>& label, const LumitexelList& all, std::size_t lumitexels, Clustering& clustering);

// Learns on `selection` (lumitexel indices, ascending): splits into about twice as many materials as wanted (split_materials.h), lets
// the mixture settle, merges (merge_materials.h), asks each material anew which lobes it needs, and settles on many of each
// material's members. Materials known before, adapted, stand beside those found so, or in their place. Then labels every lumitexel with its
// most probable material. report is called with the steps done, of clustering_steps.
Clustering cluster_materials(const Observations& observations, const LumitexelList& selection, const ClusterOptions& options,
                             const std::function<void(int)>& report);
int clustering_steps(const ClusterOptions& options);

}  // namespace lumitexel
