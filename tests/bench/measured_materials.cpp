// Beyond the families: how near each comes to 100 measured materials (MERL, as the fits of the Shifted Gamma Distribution
// have them) from what the rig would see of a sphere, against the truth in views held out.
//
//   build/release/tests/bench/measured_materials [--table FILE] [--step N] [--lumitexels N] [--json] [--picture FILE.png]
//                                                [--profile MATERIAL]
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "drivers/error.h"
#include "processing/brdf/cluster_materials.h"
#include "processing/brdf/select_lumitexels.h"
#include "processing/fit/reflectance_stage.h"
#include "processing/image/raster_file.h"
#include "rig/rig_file.h"
#include "rig/whole_file.h"
#include "sim/sgd_brdf.h"
#include "tests/bench/machine.h"
#include "tests/bench/material_errors.h"
#include "tests/bench/material_samples.h"
#include "tests/bench/material_spheres.h"

namespace lumitexel {
namespace {

constexpr double kSphereRadius_m = 0.08;

struct Settings {
  std::string table, rig, plan, picture, only;
  int step = 1, on_sphere = 12000, selected = 2000, most_lobes = 2;
  unsigned seed = 1;
  PhotographNoise noise;
  bool json = false, automatic_alone = false;
};

struct Method {
  const char* name;
  std::optional<BrdfFamily> family;  // none: the automatic choice
  int lobes;
};

std::vector<Method> methods(const Settings& settings) {
  const Method automatic{"automatic", {}, settings.most_lobes};
  if (settings.automatic_alone) return {automatic};
  return {automatic,
          {"lafortune 1", BrdfFamily::Lafortune, 1},
          {"lafortune 2", BrdfFamily::Lafortune, 2},
          {"lafortune 3", BrdfFamily::Lafortune, 3},
          {"ggx 1", BrdfFamily::Ggx, 1},
          {"ggx 2", BrdfFamily::Ggx, 2},
          {"ward 1", BrdfFamily::Ward, 1},
          {"ward 2", BrdfFamily::Ward, 2}};
}

std::vector<KnownMaterial> known_materials(const Settings& settings) {
  const std::string csv = read_whole_file(settings.table);
  std::vector<KnownMaterial> known;
  std::stringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    const std::string name = line.substr(0, line.find(','));
    if (name.empty() || name.front() == '#' || name == "material") continue;
    const SgdBrdf sgd = sgd_from_table(csv, name, settings.table);
    known.push_back({name, [sgd](const LobeGeometry& geometry) {
                       const Eigen::Array3d f = evaluate(sgd, geometry);
                       return ChannelValues{f[0], f[1], f[2]};
                     }});
  }
  return known;
}

struct MethodResult {
  MaterialFit fit;
  RelativeErrors errors;
  double seconds = 0;
};

struct MaterialResult {
  std::size_t material = 0;
  std::vector<MethodResult> by_method;
  std::vector<NearMaterial> nearest;  // to the automatic fit, among all of the table
};

BrdfValues values_of(const Brdf& brdf) {
  return [brdf](const LobeGeometry& geometry) { return evaluate(brdf, geometry); };
}

// These lumitexels and no others.
Observations alone(const Observations& observations, const LumitexelList& lumitexels) {
  Observations some;
  some.channels = observations.channels;
  for (const std::size_t l : lumitexels) {
    const auto samples = observations.of(l);
    some.samples.insert(some.samples.end(), samples.begin(), samples.end());
    some.first.push_back(some.samples.size());
  }
  return some;
}

// As `fit --materials 1 --family auto` does it, of an object that has no other lumitexels.
MaterialFit automatic_fit(const Observations& sphere, const LumitexelList& selected, int most_lobes) {
  const Observations observations = alone(sphere, selected);
  ClusterOptions options;
  options.materials = 1;
  options.any_family = true;
  options.fit.most_lobes = most_lobes;
  options.fit.error = error_model(observations, {});
  const Clustering clustering = cluster_materials(observations, with_samples(observations), options, [](int) {});
  return {clustering.materials[0].model, clustering.materials[0].fit, 0.0};
}

MaterialFit fit_of(const Method& method, const Observations& observations, const LumitexelList& lumitexels) {
  if (!method.family) return automatic_fit(observations, lumitexels, method.lobes);
  MaterialFitOptions options;
  options.most_lobes = method.lobes;
  options.family = *method.family;
  options.choose_lobes = false;
  return fit_material(samples_of(observations, lumitexels), observations.channels, nullptr, options);
}

MethodResult measured(const Method& method, const Observations& observations, const LumitexelList& lumitexels, const BrdfValues& truth,
                      const SeenSphere& sphere) {
  MethodResult result;
  const auto start = std::chrono::steady_clock::now();
  result.fit = fit_of(method, observations, lumitexels);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.errors = relative_errors(truth, values_of(result.fit.model.brdf), sphere.heldout);
  return result;
}

MaterialResult measured(std::size_t material, const std::vector<KnownMaterial>& known, const SeenSphere& sphere, const Settings& settings) {
  const BrdfValues& truth = known[material].values;
  const Observations observations = photographed(truth, sphere, settings.noise, settings.seed + static_cast<unsigned>(material));
  const auto lumitexels = select_lumitexels(observations, static_cast<std::size_t>(settings.selected));
  MaterialResult result{material, {}, {}};
  for (const Method& method : methods(settings)) result.by_method.push_back(measured(method, observations, lumitexels, truth, sphere));
  result.nearest = nearest_materials(result.by_method[0].fit.model.brdf, known);
  return result;
}

std::string chosen(const Brdf& brdf) { return std::string(to_string(brdf.family)) + " " + std::to_string(brdf.lobes.size()); }

std::string shapes(const Brdf& brdf) {
  std::string text;
  for (const auto& lobe : brdf.lobes) {
    char one[64];
    std::snprintf(one, sizeof one, " %.3g", std::exp(lobe[0].log_shape));
    text += one;
    if (lobe[0].aim < 0.0) text += "<";
  }
  return text;
}

void print_row(const MaterialResult& result, const std::vector<KnownMaterial>& known) {
  const MethodResult& automatic = result.by_method[0];
  std::printf("%-27s %-12s %6.3f %6.3f %6.3f |", known[result.material].name.c_str(), chosen(automatic.fit.model.brdf).c_str(),
              automatic.errors.raw, automatic.errors.clipped, automatic.errors.roots);
  for (std::size_t m = 1; m < result.by_method.size(); ++m) std::printf(" %6.3f", result.by_method[m].errors.clipped);
  std::printf(" | %-24s %.4f |%s\n", known[result.nearest[0].index].name.c_str(), result.nearest[0].distance,
              shapes(automatic.fit.model.brdf).c_str());
}

void print_summary(const std::vector<MaterialResult>& results, const Settings& settings) {
  std::printf("\n%-12s  raw: median    p90  clipped: median    p90  square roots: median    p90  fewest clipped errors  s/fit\n", "");
  const std::vector<Method> all = methods(settings);
  for (std::size_t m = 0; m < all.size(); ++m) {
    std::vector<double> raw, clipped, roots, seconds;
    int wins = 0;
    for (const MaterialResult& result : results) {
      const RelativeErrors& errors = result.by_method[m].errors;
      raw.push_back(errors.raw), clipped.push_back(errors.clipped), roots.push_back(errors.roots);
      seconds.push_back(result.by_method[m].seconds);
      wins += std::all_of(result.by_method.begin() + 1, result.by_method.end(),
                          [&](const MethodResult& other) { return errors.clipped <= other.errors.clipped; });
    }
    std::printf("%-12s  %11.3f %6.3f  %15.3f %6.3f  %20.3f %6.3f  %21d  %5.2f\n", all[m].name, quantile(raw, 0.5), quantile(raw, 0.9),
                quantile(clipped, 0.5), quantile(clipped, 0.9), quantile(roots, 0.5), quantile(roots, 0.9), wins, quantile(seconds, 0.5));
  }
}

nlohmann::json json_of(const std::vector<MaterialResult>& results, const std::vector<KnownMaterial>& known, const Settings& settings) {
  nlohmann::json rows = nlohmann::json::array();
  const std::vector<Method> all = methods(settings);
  for (const MaterialResult& result : results) {
    nlohmann::json row{{"material", known[result.material].name},
                       {"nearest", known[result.nearest[0].index].name},
                       {"nearest_distance", result.nearest[0].distance}};
    for (std::size_t m = 0; m < all.size(); ++m) {
      const MethodResult& one = result.by_method[m];
      row["methods"][all[m].name] = {{"fitted", chosen(one.fit.model.brdf)}, {"raw", one.errors.raw},  {"clipped", one.errors.clipped},
                                     {"square_roots", one.errors.roots},     {"seconds", one.seconds}, {"criterion", one.fit.criterion}};
    }
    rows.push_back(row);
  }
  return {{"machine", machine_line()}, {"materials", rows}};
}

// f in green over the half vector's angle at one difference angle: where a fit leaves the truth.
void print_profile(const MaterialResult& result, const KnownMaterial& material, const Settings& settings) {
  const std::vector<Method> all = methods(settings);
  std::printf("\n%-12s %12s %9s %9s %9s %9s  shapes, strengths in green\n", "", "misfit", "relative", "floor", "freedom", "independ.");
  for (std::size_t m = 0; m < all.size(); ++m) {
    const MaterialModel& model = result.by_method[m].fit.model;
    std::printf("%-12s %12.1f %9.4f %9.2g %9.3g %9.3f %s;", all[m].name, result.by_method[m].fit.fit.misfit,
                model.error.relative, model.error.floor,
                model.error.freedom, model.error.independence, shapes(model.brdf).c_str());
    for (const auto& lobe : model.brdf.lobes) std::printf(" %.3g", std::exp(lobe[1].log_strength));
    std::printf("\n");
  }
  for (const double difference_deg : {10.0, 35.0, 60.0, 75.0}) {
    std::printf("\n%s, difference angle %.0f deg, f in green over the half vector's angle\n%6s %10s", material.name.c_str(), difference_deg, "deg",
                "truth");
    for (const Method& method : all) std::printf(" %11s", method.name);
    std::printf("\n");
    for (const double half_deg : {0.0, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 36.0, 48.0, 64.0}) {
      constexpr double kDegree = 0.017453292519943295;
      const double h = half_deg * kDegree, d = difference_deg * kDegree;
      // The half vector tilts across the plane of the two directions, so that both stay above the surface.
      const Eigen::Vector3d half(0.0, std::sin(h), std::cos(h)), side = std::sin(d) * Eigen::Vector3d::UnitX();
      const LobeGeometry g = lobe_geometry(Eigen::Vector3d::UnitZ(), std::cos(d) * half + side, std::cos(d) * half - side);
      std::printf("%6.1f %10.4f", half_deg, material.values(g)[1]);
      for (const MethodResult& one : result.by_method) std::printf(" %11.4f", evaluate(one.fit.model.brdf, g)[1]);
      std::printf("\n");
    }
  }
}

void print_table(const std::vector<MaterialResult>& results, const std::vector<KnownMaterial>& known, const Settings& settings) {
  std::printf("held-out error relative to the truth's rms; automatic: raw, clipped, square roots; then clipped of");
  const std::vector<Method> all = methods(settings);
  for (std::size_t m = 1; m < all.size(); ++m) std::printf(" %s,", all[m].name);
  std::printf(" nearest material of the table, its distance, the lobes' shapes (< points back)\n");
  for (const MaterialResult& result : results) print_row(result, known);
  print_summary(results, settings);
  const auto found = std::count_if(results.begin(), results.end(), [](const MaterialResult& r) { return r.nearest[0].index == r.material; });
  std::printf("nearest material of the table to the automatic fit is the true one: %td of %zu\n", found, results.size());
}

void write_picture(const std::vector<MaterialResult>& results, const std::vector<KnownMaterial>& known, const std::string& file) {
  std::vector<std::pair<BrdfValues, BrdfValues>> pairs;
  for (const MaterialResult& r : results) pairs.emplace_back(known[r.material].values, values_of(r.by_method[0].fit.model.brdf));
  write_png8(file, sphere_sheet(pairs, 10, 80));
}

void run(const Settings& settings) {
  const std::vector<KnownMaterial> known = known_materials(settings);
  const RigDescription rig = parse_rig(read_rig_file(settings.rig), settings.rig);
  const CapturePlan plan = parse_plan(read_whole_file(settings.plan), settings.plan);
  const SeenSphere sphere = sphere_on_rig(rig, plan, kSphereRadius_m, settings.on_sphere);
  std::vector<MaterialResult> results;
  for (std::size_t i = 0; i < known.size(); i += static_cast<std::size_t>(settings.step)) {
    if (!settings.only.empty() && known[i].name != settings.only) continue;
    results.push_back(measured(i, known, sphere, settings));
  }
  std::stable_sort(results.begin(), results.end(), [](const MaterialResult& a, const MaterialResult& b) {
    return a.by_method[0].errors.clipped < b.by_method[0].errors.clipped;
  });
  if (settings.json) std::cout << json_of(results, known, settings).dump(2) << '\n';
  else print_table(results, known, settings);
  if (!settings.only.empty() && !settings.json) {
    for (const MaterialResult& result : results) print_profile(result, known[result.material], settings);
  }
  if (!settings.picture.empty()) write_picture(results, known, settings.picture);
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) {
  CLI::App app("The families of BRDF against 100 measured materials");
  lumitexel::Settings settings;
  settings.table = LUMITEXEL_SOURCE_DIR "/config/materials/merl_sgd.csv";
  settings.rig = LUMITEXEL_SOURCE_DIR "/config/rigs/simulated.toml";
  settings.plan = LUMITEXEL_SOURCE_DIR "/config/plans/first_light.toml";
  app.add_option("--table", settings.table, "SGD fits of the MERL materials, as sim/sgd_brdf.h reads them")
      ->check(CLI::ExistingFile)
      ->capture_default_str();
  app.add_option("--rig", settings.rig, "the rig's description")->check(CLI::ExistingFile);
  app.add_option("--plan", settings.plan, "the views")->check(CLI::ExistingFile);
  app.add_option("--step", settings.step, "every so many materials")->check(CLI::Range(1, 100));
  app.add_option("--profile", settings.only, "this material alone, with its profiles");
  app.add_option("--on-sphere", settings.on_sphere, "lumitexels on the sphere")->check(CLI::Range(100, 1000000));
  app.add_option("--lumitexels", settings.selected, "of them are fitted to")->check(CLI::Range(20, 1000000));
  app.add_option("--most-lobes", settings.most_lobes, "of the automatic choice")->check(CLI::Range(0, 3));
  app.add_option("--noise", settings.noise.relative, "relative standard deviation")->check(CLI::Range(0.0, 1.0));
  app.add_option("--seed", settings.seed, "of the noise");
  app.add_option("--picture", settings.picture, "PNG: spheres, truth beside the automatic fit, in the table's order");
  app.add_flag("--automatic", settings.automatic_alone, "the automatic choice alone");
  app.add_flag("--json", settings.json, "the table as JSON");
  CLI11_PARSE(app, argc, argv);
  try {
    if (!settings.json) std::printf("%s\n", lumitexel::machine_line().c_str());
    lumitexel::run(settings);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
