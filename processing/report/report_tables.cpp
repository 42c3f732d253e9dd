#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "processing/image/exr_file.h"
#include "processing/fit/outliers.h"
#include "processing/report/html.h"
#include "processing/report/report_sections.h"

namespace lumitexel {
namespace {

using Json = nlohmann::json;

struct StageName {
  const char* title;
  const char* papers;  // in its Table II
};

StageName name_of(FitStage stage) {
  switch (stage) {
    case FitStage::Single: return {"one BRDF for all", "1-RMS"};
    case FitStage::Cluster: return {"one BRDF a material", "C-RMS"};
    case FitStage::Projection: return {"a mixture a texel", "P-RMS"};
    case FitStage::Pfa: return {"of functions moved to fit", "F-RMS"};
    case FitStage::Normal: return {"on fitted normals", "NF-RMS"};
  }
  return {"", ""};
}

std::string stage_title(FitStage stage) { return std::string(name_of(stage).title) + " (" + name_of(stage).papers + ")"; }

std::string figure_at(const Json& list, std::size_t index) {
  return index < list.size() && list.at(index).is_number() ? html::number(list.at(index).get<double>()) : "–";
}

// Rows: one a stage. Columns: the entries of the stage's list.
std::string table_by_stage(const Json& lists, const std::vector<std::string>& names) {
  std::vector<std::string> header{"stage"};
  header.insert(header.end(), names.begin(), names.end());
  std::vector<std::vector<std::string>> rows;
  for (const FitStage stage : kFitStages) {
    const std::string key = to_string(stage);
    if (!lists.is_object() || !lists.contains(key) || !lists.at(key).is_array()) continue;
    std::vector<std::string> row{stage_title(stage)};
    for (std::size_t i = 0; i < lists.at(key).size(); ++i) row.push_back(figure_at(lists.at(key), i));
    row.resize(header.size(), "–");
    rows.push_back(row);
  }
  return rows.empty() ? "" : html::table(header, rows);
}

// Rows: one a material, of which there may be many. Columns: the stages that have a list.
std::string table_by_material(const Json& lists, std::size_t materials) {
  std::vector<std::string> header{"material"};
  std::vector<std::vector<std::string>> rows(materials);
  for (std::size_t m = 0; m < materials; ++m) rows[m].push_back(std::to_string(m));
  for (const FitStage stage : kFitStages) {
    const std::string key = to_string(stage);
    if (!lists.is_object() || !lists.contains(key) || !lists.at(key).is_array()) continue;
    header.push_back(name_of(stage).papers);
    for (std::size_t m = 0; m < materials; ++m) rows[m].push_back(figure_at(lists.at(key), m));
  }
  return rows.empty() || header.size() == 1 ? "" : html::table(header, rows);
}

std::size_t longest_list(const Json& lists) {
  std::size_t longest = 0;
  if (lists.is_object()) {
    for (const auto& [key, list] : lists.items()) longest = std::max(longest, list.is_array() ? list.size() : 0);
  }
  return longest;
}

std::vector<std::string> error_row(const std::string& name, const Json& error) {
  std::vector<std::string> row{name};
  for (const char* figure : {"relative_rms", "clipped_rms", "sqrt_rms", "psnr_db"}) row.push_back(html::number(number_or_nan(error, figure)));
  return row;
}

std::string error_table(const std::string& title, const Json& errors) {
  std::vector<std::vector<std::string>> rows;
  for (const FitStage stage : kFitStages) {
    const Json& error = errors.at(to_string(stage));
    if (std::isfinite(number_or_nan(error, "relative_rms"))) rows.push_back(error_row(stage_title(stage), error));
  }
  if (rows.empty()) return "";
  return "<h3>" + html::escaped(title) + "</h3>" +
         html::table({"stage", "relative RMS", "clipped", "square roots", "PSNR (dB)"}, rows);
}

std::string bars(const Json& stages, const std::string& key, double unit, const std::string& unit_name,
                 const std::string& css_class) {
  double largest = 0.0;
  for (const Json& stage : stages) largest = std::max(largest, number_or_nan(stage, key));
  if (!(largest > 0.0)) return "";
  std::string text = "<div class=\"bars\">";
  for (const Json& stage : stages) {
    const double value = number_or_nan(stage, key);
    const double percent = std::isfinite(value) ? 100.0 * value / largest : 0.0;
    text += "<span>" + html::escaped(stage.value("name", "?")) + "</span><div class=\"track\"><div class=\"fill " +
            css_class + "\" style=\"width:" + html::number(percent, 3) + "%\"></div></div><span class=\"value\">" +
            html::number(value / unit) + " " + unit_name + "</span>\n";
  }
  return text + "</div>\n";
}

// The RMS of r again, of each channel and of each material.
std::string breakdown_tables(const Json& provenance) {
  std::string body;
  const auto add = [&body](const std::string& title, const std::string& table) {
    if (!table.empty()) body += "<h3>" + title + "</h3>" + table;
  };
  const Json channels = provenance.value("rms_by_channel", Json::object());
  std::vector<std::string> names;
  for (std::size_t c = 0; c < longest_list(channels); ++c) {
    const auto known = colour_channel_names(static_cast<int>(longest_list(channels)));
    names.push_back(c < known.size() ? known[c] : std::to_string(c));
  }
  add("RMS of r by colour channel", table_by_stage(channels, names));
  const Json materials = provenance.value("rms_by_material", Json::object());
  const Json anew = {{"normal", provenance.value("rms_by_material_on_fitted_normals", Json())}};
  const bool sorted_anew = longest_list(anew) > 0;
  add(sorted_anew ? "RMS of r by material, as sorted on the mesh's normals" : "RMS of r by material",
      table_by_material(materials, longest_list(materials)));
  add("RMS of r by material, as sorted anew on fitted normals", table_by_material(anew, longest_list(anew)));
  return body;
}

}  // namespace

double number_or_nan(const Json& parent, const std::string& key) {
  return parent.is_object() && parent.contains(key) && parent.at(key).is_number() ? parent.at(key).get<double>() : NAN;
}

std::vector<std::int64_t> texels_by_material(const Model& model) {
  std::vector<std::int64_t> counts(model.materials.size());
  for (std::size_t texel = 0; texel < model.material.size(); ++texel) {
    const std::int16_t material = model.material[texel];
    if (material != Model::kNoMaterial && model.samples.data[texel] > 0.0f)
      ++counts[static_cast<std::size_t>(material)];
  }
  return counts;
}

Json stages_json(const Json& provenance, const Evaluation* evaluation) {
  const Json rms = provenance.value("rms", Json::object());
  Json stages = Json::array();
  for (const FitStage stage : kFitStages) {
    const double value = number_or_nan(rms, to_string(stage));
    if (!std::isfinite(value)) continue;
    const double share = value / number_or_nan(rms, "single");
    Json entry = {{"stage", to_string(stage)}, {"title", name_of(stage).title}, {"papers_name", name_of(stage).papers}, {"rms", value},
                  {"share_of_single", std::isfinite(share) ? Json(share) : Json(nullptr)}};
    for (const bool heldout : {true, false}) {
      const ImageError* error = nullptr;
      if (evaluation != nullptr) {
        const auto& errors = (heldout ? evaluation->heldout : evaluation->fit)[static_cast<std::size_t>(stage)];
        if (errors && std::isfinite(errors->clipped_rms)) error = &*errors;
      }
      entry[heldout ? "heldout" : "fit"] = error ? Json{{"clipped", error->clipped_rms}, {"square_roots", error->sqrt_rms}} : Json(nullptr);
    }
    stages.push_back(entry);
  }
  return stages;
}

std::string stage_section(const Json& stages, const Json& provenance) {
  std::vector<std::vector<std::string>> rows;
  for (const Json& stage : stages) {
    std::vector<std::string> row{stage.at("title").get<std::string>(), stage.at("papers_name").get<std::string>(),
                                 html::number(stage.at("rms").get<double>()), html::number(number_or_nan(stage, "share_of_single"))};
    for (const char* kind : {"heldout", "fit"}) {
      for (const char* figure : {"clipped", "square_roots"}) row.push_back(html::number(number_or_nan(stage.at(kind), figure)));
    }
    rows.push_back(row);
  }
  return html::section(
             "How much each stage of the fit explains",
             "The fit goes from coarse to fine; each row starts from the one above it. RMS of r: root mean square difference, in 1/sr, between "
             "predicted and measured reflectance r = f cos over all samples that the fit used and all channels, under the names that "
             "Lensch et al. (2003) give it in their Table II. Beside it the errors of whole re-rendered photographs, kept out of the fit and used in "
             "it. A stage that lowers the first and not the held-out ones has learned noise.",
             html::table({"stage", "in the paper", "RMS of r, 1/sr", "share of 1-RMS", "held out: clipped", "square roots", "used in the fit: clipped",
                          "square roots"},
                         rows) +
                 breakdown_tables(provenance));
}

std::string photograph_error_section(const Json& evaluation) {
  std::vector<std::vector<std::string>> rows;
  for (const Json& view : evaluation.at("views")) {
    std::vector<std::string> row = error_row(view.at("image").get<std::string>(), view);
    row.insert(row.begin() + 1, view.at("split") == "heldout" ? "held out" : "fit");
    rows.push_back(row);
  }
  std::string note =
      "Whole pictures re-rendered and compared with the photographs, over the object's pixels. A model can learn "
      "the photographs of the fit by heart; only those kept out tell how it does in a new view and light.";
  if (!evaluation.at("same_session").get<bool>())
    note += " The model was fitted to another session than the one it is compared with here.";
  return html::section(
      "How well photographs are predicted", note,
      error_table("Photographs kept out of the fit", evaluation.at("heldout_by_stage")) +
          error_table("Photographs used in the fit", evaluation.at("fit_by_stage")) + "<h3>Each photograph</h3>" +
          html::table({"photograph", "role", "relative RMS", "clipped", "square roots", "PSNR (dB)"}, rows));
}

std::string outlier_section(const Json& provenance) {
  const Json outliers = provenance.value("outliers", Json::object());
  if (!outliers.contains("count")) return "";
  std::vector<std::string> header{"photograph"};
  for (const OutlierReason reason : kOutlierReasons) header.push_back(to_string(reason));
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const std::string& name, const Json& counts) {
    std::vector<std::string> row{name};
    for (const OutlierReason reason : kOutlierReasons) row.push_back(html::number(number_or_nan(counts, to_string(reason)), 8));
    rows.push_back(row);
  };
  const Json by_view = outliers.value("by_view", Json::object());
  for (const auto& [view, counts] : by_view.items()) add(view, counts);
  add("all", outliers.at("count"));
  return html::section(
      "What the model does not explain",
      "Samples that lie more than " + html::number(number_or_nan(outliers, "beyond_scales")) +
          " scales of their material's error model from the prediction. None was dropped. Dark: under half of the diffuse light "
          "alone, as in a shadow that the mesh does not cast. No highlight: darker, where mostly a highlight was predicted. Dim: darker otherwise. Highlight: there and not "
          "predicted. Extra light: brighter away from any highlight, as by light from other surfaces. Colour: as bright, of another "
          "colour. The worst are listed in the model's outliers.csv.",
      html::table(header, rows));
}

std::string timing_section(const Json& provenance) {
  const Json stages = provenance.value("stages", Json::array());
  if (stages.empty()) return "";
  constexpr double kMebibyte = 1024.0 * 1024.0;
  return html::section("What it took", "Wall time and the process's peak memory at the end of each stage of the fit.",
                       "<h3>Time</h3>" + bars(stages, "seconds", 1.0, "s", "time") + "<h3>Peak memory</h3>" +
                           bars(stages, "peak_bytes", kMebibyte, "MiB", "memory"));
}

std::string definitions_section() {
  return html::section(
      "What the figures mean", "All comparisons are made in linear radiance, before any tone curve.",
      html::table(
          {"figure", "definition"},
          {{"relative RMS", "RMS of rendering minus photograph, divided by the RMS of the photograph"},
           {"clipped",
            "the same, both clipped at the photograph's 99.9th percentile, so that a few highlights do not decide"},
           {"square roots", "the same on square roots, closer to how differences look"},
           {"PSNR", "peak signal to noise in decibels; the peak is the photograph's 99.9th percentile"},
           {"in words", "by the error on square roots: almost exactly below 5 %, closely below 10 %, well below 20 %, recognisably below 40 %, "
                        "else poorly"},
           {"surface measured", "share of the mesh's area whose texels were fitted to samples of their own"},
           {"several photographs", "the pixels of all are pooled, each photograph with its own percentile"}}) +
          "<p>Pixels that saturated or were defective, and those outside the object's mask, are left out. Where the "
          "mesh misses an "
          "object pixel, the rendering counts as black. Every number on this page is also in its JSON block (id "
          "“data”).</p>");
}

}  // namespace lumitexel
