#include <nlohmann/json.hpp>

#include "processing/fit/normals_worth.h"
#include "processing/report/html.h"
#include "processing/report/report_sections.h"

namespace lumitexel {
namespace {

using Json = nlohmann::json;

std::string percent(double share) { return html::number(100.0 * share, 2) + " %"; }

std::vector<std::string> choice_row(const Json& choice) {
  return {choice.value("fit", ""),
          choice.value("of", "?"),
          choice.value("over", "?"),
          choice.value("candidate", "?"),
          percent(number_or_nan(choice, "gain")),
          "± " + percent(number_or_nan(choice, "gain_sigma")),
          choice.value("taken", false) ? "taken" : "not taken"};
}

std::string normals_sentence(const Json& provenance) {
  const Json worth = provenance.value("normals_worth", Json());
  if (!worth.is_object()) return "";
  return "<p>Normals of the texels' own: photographs left out for it are predicted better by " + html::number(number_or_nan(worth, "deviance_gain")) +
         " ± " + html::number(number_or_nan(worth, "deviance_gain_sigma")) + " of deviance (minus twice the log likelihood) a sample; more than " +
         html::number(NormalsWorth::kLeastGain) + " and one sigma was asked for, so " +
         (provenance.value("normals", "") == "fitted" ? "they were fitted." : "the mesh's were kept.") + "</p>";
}

}  // namespace

std::string choice_section(const Json& provenance) {
  const Json choices = provenance.value("choices", Json::array());
  std::vector<std::vector<std::string>> rows;
  for (const Json& choice : choices) rows.push_back(choice_row(choice));
  const std::string normals = normals_sentence(provenance);
  if (rows.empty() && normals.empty()) return "";
  const std::string table = rows.empty() ? "" : html::table({"fit", "choice", "from", "to", "gain", "one sigma", "outcome"}, rows);
  return html::section("What the samples decided",
                       "Where the fit could go more than one way, samples or photographs that were left out of it were predicted both ways. The gain is "
                       "by how much the second errs less, as a share of the first one's error. Other lobes, functions and materials are taken for half a percent "
                       "and two sigmas of gain; another source of errors for two sigmas, and estimated ones, which make the more exact fits, also if "
                       "they lose less than 2 % and not surely more than half a percent. Sigmas take surface points as independent, "
                       "which neighbours are not, and are rather too small; by photographs they take photographs as independent.",
                       table + normals);
}

}  // namespace lumitexel
