// Maps of one value a texel, as the report counts and draws them.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "processing/model/render_view.h"

namespace lumitexel {

// Fitted to samples of its own; filled-in texels know nothing.
bool is_measured(const Model& model, std::size_t texel);

// Channel `channel` of the map at the measured texels.
std::vector<float> values_where_measured(const Model& model, const Image& map, int channel = 0);

// The value that this share of all does not exceed, nearest rank; null of no values.
nlohmann::json share_below(std::vector<float> values, double share);
// {"median", "nine_tenths", "most"}
nlohmann::json spread_of(const std::vector<float>& values);

// As "6.2 %"; an en dash for null.
std::string percent(const nlohmann::json& share);

// The same surface without anything but its form: with the mesh's own normals, and the map's channel where a renderer looks for the
// reflectance's sigma (Aov::Sigma).
Model carrying(const Model& model, const Image& map, int channel = 0);

// As the page shows values along the rays of a view: position(x, y) goes to false_colour; white where `normal`, the view's Aov::Normal, has no object;
// gray where the position is not a number.
Image drawn(const Image& normal, const std::function<double(int x, int y)>& position);

// A picture over what it shows, and the scale of its colours from near-white to full red.
std::string figure_with_scale(const Image& picture, const std::string& what, const std::string& caption, const std::string& low_means,
                              const std::string& high_means);

}  // namespace lumitexel
