// Where a model came from, as the JSON object that model.json carries.
#pragma once

#include <string>

#include "processing/fit/fit_model.h"

namespace lumitexel {

// Keys: session_key, options, materials, lumitexels, samples, starved_lumitexels, unseen_triangles, rejected, stages,
// rms, rms_by_channel, rms_by_material, texels_by_material, prior.
std::string provenance_json(const CalibratedSession& session, const FitOptions& options, const FitSummary& summary);

// Key of the session that the model was fitted to (CalibratedSession::key); empty where the model does not say.
std::string fitted_session_key(const Model& model);

// What lay_out needs to make the model's atlas once more.
LayoutOptions layout_of(const Model& model);

}  // namespace lumitexel
