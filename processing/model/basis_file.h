// basis.json: the model's BRDFs as a person reads them, and without loss.
//
//   {"channels": ["R","G","B"], "single": BRDF, "materials": [{"brdf": BRDF, "sigma": SIGMA, "error": ERROR, "basis": [BRDF, …]}, …],
//    "before_normals": [the same of the stages before normals were fitted, if they were]}
//   BRDF = {"family", "diffuse": [kd per channel, 1/sr], "lobes": [[LOBE per channel], …]}
//   LOBE of "lafortune" = {"peak": A (1/sr), "phi_rad", "exponent": N, "log_peak": ln A, "log_exponent": ln N}
//   SIGMA = {"diffuse": [1/sr], "lobes": [[{"log_peak", "phi_rad", "log_exponent"}]]}, one sigma of each of BRDF's numbers (brdf_sigma.h) under the names that its
//     lobes have, null where the samples do not determine it; missing in models of before it was kept
//   ERROR = {"relative", "floor" (1/sr), "freedom" (null: a normal distribution), "outlier_share", "outlier_scale", "independence", "correlation": rows of a
//     matrix, channels by channels, or null where they err independently}, by which the material's samples were weighed (error_model.h); missing likewise
//   LOBE of "ggx" = {"f0", "alpha", "log_f0", "log_alpha"}, of "ward" = {"albedo", "alpha", "log_albedo", "log_alpha"}
//
// in the parametrisations of processing/brdf/lobe_family.h; no "family" means Lafortune's. The two logarithms are what is read back, to the last bit;
// peak and exponent say the same for the reader's eye, null where they overflow. log_peak is null for a lobe that is
// switched off (minus infinity).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "processing/model/model.h"

namespace lumitexel {

struct BasisTable {
  Brdf single;
  std::vector<ModelMaterial> materials;
  std::optional<std::vector<ModelMaterial>> before_normals{};  // the stages before normals were fitted, if they were
};

std::string encode_basis(const Model& model);
// Throws BadInput naming `where` and the field for anything missing, of the wrong type or number of channels, negative
// (diffuse), not finite, outside N in [1e-2, 1e5], or where peak or exponent contradict their logarithms.
BasisTable parse_basis(const std::string& text, int channels, const std::string& where);

}  // namespace lumitexel
