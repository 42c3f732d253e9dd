// What the user may choose about a fit.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "processing/brdf/cluster_materials.h"
#include "processing/interreflection/indirect_light.h"
#include "processing/normals/fit_normals.h"
#include "processing/surface/given_layout.h"

namespace lumitexel {

enum class FitMethod {
  Lumitexel,  // ours
  Paper       // as published (paper_clustering.h), with the plain projection
};

// Fitted: normals finer than the mesh's, of all lumitexels together, then everything once more. Auto: where left-out photographs are then
// predicted better (normals_worth.h). Texel: as Fitted, but each lumitexel by its own samples alone, as section 9 of the paper has it.
enum class NormalChoice { Auto, Fitted, Texel, Mesh };
const char* to_string(NormalChoice choice);  // "auto", "fitted", "texel", "mesh"

// Auto: light between the object's surfaces is taken out where it can matter and the photographs show it (indirect_worth.h). Always: where it can
// matter, without being asked for. Off: left in.
enum class InterreflectionChoice { Auto, Always, Off };
const char* to_string(InterreflectionChoice choice);  // "auto", "always", "off"

// How it is sought (interreflection_stage.h).
struct InterreflectionOptions {
  InterreflectionChoice choice = InterreflectionChoice::Auto;
  int rounds = 1;  // at most, and at least 1; the first costs no fit of its own where normals are fitted after it
  IndirectOptions light;
};

struct FitOptions {
  std::string quality = "standard";
  FitMethod method = FitMethod::Lumitexel;
  LayoutOptions layout;
  int materials = 0;                        // 0: as many as the samples ask for
  std::optional<BrdfFamily> family = BrdfFamily::Lafortune;  // none: whichever predicts left-out samples best
  int most_lobes = 2;                       // each must be asked for by the samples; with the paper's method it is the number
  bool principal_functions = false;         // tried for each material, and kept where left-out lumitexels are predicted better
  NormalChoice normals = NormalChoice::Auto;
  int normal_rounds = 1;                    // normals from materials, then materials from normals
  NormalFitOptions normal_fit;
  InterreflectionOptions interreflections;
  ErrorSource errors = ErrorSource::Auto;
  double intensity_weight = 0.3;            // s of the paper's eq. 6; only the paper's method looks at it
  std::size_t learning_lumitexels = 2000;   // that the materials are learnt on
  std::size_t final_lumitexels = 2000;      // of its own that each material is fitted to at the end
  int draw = 0;                             // which lumitexels these are, of those that might be (draw_phase.h)
  LobeShapes lobe_shapes = LobeShapes::Shared;  // of a material's channels
  int bases = 0;                            // at most so many BRDFs that a material's texels mix; 0: no more than predict left-out samples better
  Precision precision = Precision::Double;  // of the bases' values at samples
  bool plain_projection = false;            // the paper's least squares for the weights, without a prior
  // What no model on the coarse mesh can predict: a share of each prediction, and a share of the session's median
  // reflectance under everything. Both found on held-out photographs of two sessions; see the README.
  double relative_error = 0.3, error_floor_share = 0.3;

  // standard: these defaults. draft: the mesh's normals, and light between surfaces left in. reference: learnt on 50,000, fitted to all,
  // up to three lobes of the family and shapes that predict best, light taken out in up to four rounds. Throws BadInput on any other name.
  static FitOptions preset(const std::string& quality);
};

inline constexpr int kMaterialsOfThePaper = 4;  // where nobody says how many: its method does not choose

// The paper's method, complete and exactly as published: each channel one lobe of its own, least squares, principal functions always moved.
FitOptions as_published(FitOptions options);

}  // namespace lumitexel
