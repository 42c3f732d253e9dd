// How much of the light that a model predicts by way of other surfaces is taken out of samples, and what that adds to their variance: for the fit
// (interreflection_stage.h), and for whoever gathers its samples once more.
//
// A model from which too little was taken is too bright, and predicts too much. Light by way of another surface is reflected twice where a lamp's is
// once: with t the straight part of a lumitexel's light, d the straight part that the model was fitted to and I what the model sends by way of other
// surfaces, I (t / d)^2 is what it should send. So t + I (t / d)^2 = what was photographed, solved for t.
#pragma once

#include <vector>

#include "processing/surface/lumitexel.h"

namespace lumitexel {

// Scales the predicted light of each lumitexel and channel, and its variance, to what is to be taken. All lists as tile.reflectance. photographed: the
// samples before anything was taken out of them; taken_before: what was, when the model was fitted.
void scale_to_take(const LumitexelTile& tile, int channels, const std::vector<float>& photographed, const std::vector<float>& taken_before,
                   std::vector<float>& light, std::vector<float>& light_variance);

// What tile.variance has beyond the photographs' own: each lumitexel's samples get its mean, channel by channel. A sample's own goes with how much its
// few paths happened to find, and would make samples count more from which too little is taken.
void even_out_variance(const std::vector<float>& photographed_variance, int channels, LumitexelTile& tile);

}  // namespace lumitexel
