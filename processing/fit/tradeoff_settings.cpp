#include "processing/fit/tradeoff_settings.h"

#include <algorithm>

#include "drivers/error.h"
#include "processing/brdf/material_basis.h"
#include "processing/brdf/nnls.h"

namespace lumitexel {
namespace {

constexpr const char* kReferenceSetting = "reference";
constexpr const char* kPaperSetting = "paper";

// What a setting changes is stated against the standard preset, which is in the list itself.
std::vector<TradeoffSetting> all_settings(std::optional<int> materials) {
  std::vector<TradeoffSetting> settings;
  const auto add = [&](const std::string& name, const std::string& what, const std::string& quality = kStandardSetting) -> TradeoffSetting& {
    settings.push_back({name, what, FitOptions::preset(quality)});
    if (materials) settings.back().options.materials = *materials;
    return settings.back();
  };
  add("draft", "draft preset: the mesh's normals, and light between surfaces left in", "draft");
  add(kStandardSetting, "standard preset: learnt on 2,000 points, up to two Lafortune lobes, normals where they pay, light between surfaces taken out once where photographs show it");
  for (const std::size_t learning : {500u, 1000u, 5000u, 10000u}) {
    const std::string number = std::to_string(learning);
    add("learning-" + number, "materials learnt on " + number + " points").options.learning_lumitexels = learning;
  }
  for (const int count : {0, 2, 4, 8}) {
    if (count == settings.front().options.materials) continue;
    const std::string number = std::to_string(count);
    if (count == 0) add("materials-auto", "as many materials as the samples ask for").options.materials = 0;
    else add("materials-" + number, number + " materials").options.materials = count;
  }
  add("final-10000", "each material fitted to 10,000 of its points").options.final_lumitexels = 10000;
  add("rounds-2", "light between surfaces taken out twice, where photographs show it").options.interreflections.rounds = 2;
  add("principal", "basis functions moved where that predicts better").options.principal_functions = true;
  add("errors-given", "30 % errors everywhere, nothing estimated").options.errors = ErrorSource::Given;
  add("lobes-1", "no more than one lobe a material").options.most_lobes = 1;
  add("lobes-3", "up to three lobes a material").options.most_lobes = 3;
  add("ggx", "GGX lobes").options.family = BrdfFamily::Ggx;
  add("family-auto", "lobes of the family that predicts best").options.family.reset();
  add("lobe-shapes-auto", "a lobe shape for each channel where that predicts better").options.lobe_shapes = LobeShapes::Auto;
  add("bases-1", "every texel its material, brighter or darker, nothing mixed").options.bases = 1;
  add("bases-3", "a texel mixes its material's own variations").options.bases = 1 + kVariations;
  add("bases-8", "and other materials, asked for or not").options.bases = kMaxBasis;
  add("float", "weights of texels from values in float").options.precision = Precision::Float;
  add("normals-mesh", "the mesh's normals, nothing fitted").options.normals = NormalChoice::Mesh;
  add("direct", "light between surfaces left in").options.interreflections.choice = InterreflectionChoice::Off;
  FitOptions& paper = add(kPaperSetting, "clustering, fits and projection as published").options;
  paper = as_published(paper);
  for (const std::size_t views : {16u, 12u, 8u}) {
    const std::string number = std::to_string(views);
    add("views-" + number, "fitted to " + number + " photographs").fit_views = views;
  }
  for (const int block : {2, 4}) {
    const std::string number = std::to_string(block);
    add("scale-1/" + number, "fitted to photographs of " + number + " times larger pixels").pixel_block = block;
  }
  add(kReferenceSetting, "reference preset: learnt on 50,000 points, up to three lobes of the family and shapes that predict best", "reference");
  return settings;
}

void require_known(const std::vector<TradeoffSetting>& settings, const std::vector<std::string>& names) {
  std::string known;
  for (const TradeoffSetting& setting : settings) known += (known.empty() ? "" : ", ") + setting.name;
  for (const std::string& name : names) {
    const bool found = std::any_of(settings.begin(), settings.end(), [&](const auto& setting) { return setting.name == name; });
    if (!found) throw BadInput("--only", "'" + name + "'", "one of " + known);
  }
}

}  // namespace

std::vector<TradeoffSetting> tradeoff_settings(std::optional<int> materials, bool full, const std::vector<std::string>& only) {
  std::vector<TradeoffSetting> settings = all_settings(materials);
  require_known(settings, only);
  if (materials == 0) {  // asked for, not only as the presets have it
    if (std::find(only.begin(), only.end(), kPaperSetting) != only.end()) {
      throw BadInput("--materials", "auto with --only paper", "a number: the paper does not choose it");
    }
    std::erase_if(settings, [](const TradeoffSetting& setting) { return setting.name == kPaperSetting; });
  }
  std::erase_if(settings, [&](const TradeoffSetting& setting) {
    if (setting.name == kReferenceSetting && full) return false;
    if (only.empty()) return setting.name == kReferenceSetting;
    return std::find(only.begin(), only.end(), setting.name) == only.end();
  });
  return settings;
}

}  // namespace lumitexel
