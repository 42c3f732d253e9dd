#include "processing/report/tradeoff_page.h"

#include <cmath>

#include "processing/report/html.h"
#include "processing/report/page_style.h"
#include "processing/report/tradeoff_plot.h"

namespace lumitexel {
namespace {

std::string with_spread(const ErrorWithSpread& error) {
  if (!std::isfinite(error.sigma)) return html::number(error.value);
  return html::number(error.value) + " ± " + html::number(error.sigma, 2);
}

std::string memory(const std::optional<std::int64_t>& bytes) { return bytes ? html::number(static_cast<double>(*bytes) / 1e6) : "–"; }

// What sigmas do not cover with one draw.
std::string of_one_draw(const Tradeoff& tradeoff) {
  return tradeoff.draws > 1 ? "" : " Each setting was fitted once: by how much other draws of surface points would differ is not known (--draws 4 tells).";
}

std::string tile(const std::string& value, const std::string& meaning) {
  return "<div class=\"tile\"><b>" + html::escaped(value) + "</b><span>" + html::escaped(meaning) + "</span></div>\n";
}

// The front's ends: what the fastest setting costs in accuracy, and the most accurate in time.
std::string header(const std::string& session_name, const Tradeoff& tradeoff) {
  const std::vector<bool> front = pareto_front(tradeoff.measurements);
  const TradeoffMeasurement *fastest = nullptr, *best = nullptr;
  for (std::size_t i = 0; i < front.size(); ++i) {
    const TradeoffMeasurement& m = tradeoff.measurements[i];
    if (!front[i]) continue;
    if (fastest == nullptr || m.cpu_seconds < fastest->cpu_seconds) fastest = &m;
    if (best == nullptr || m.clipped.value < best->clipped.value) best = &m;
  }
  std::string text = "<header><h1>" + html::escaped(session_name) + ": speed against accuracy</h1>\n<p>This session was fitted with one setting "
                     "after another. Each model then predicted photographs that its fit never saw.</p>\n<div class=\"tiles\">";
  if (fastest != nullptr) {
    text += tile(fastest->setting.name, "fastest: " + html::number(fastest->cpu_seconds) + " s of CPU time, error " + html::number(fastest->clipped.value));
    text += tile(best->setting.name, "most accurate: error " + html::number(best->clipped.value) + ", " + html::number(best->cpu_seconds) + " s of CPU time");
  }
  text += tile(std::to_string(tradeoff.draws), "fits of each setting");
  text += tile(std::to_string(tradeoff.fit_views), "photographs to fit");
  text += tile(std::to_string(tradeoff.heldout_views), "photographs kept out, which judge");
  return text + "</div></header>\n";
}

std::string plot_section(const Tradeoff& tradeoff) {
  const std::string plot = tradeoff_plot(tradeoff);
  if (plot.empty()) return html::section("Error against CPU time", "No setting could be measured.", "");
  return html::section(
      "Error against CPU time",
      "Lower is better, further left is faster. The steps are the Pareto front: the best error that can be had within that time.",
      html::figure(plot, "Orange: on the front. Blue: another setting is both faster and better. Bars: one standard error, over the held-out photographs and draws "
                         "that there were; settings move together, so differences are surer than the bars say (next table but one)." + of_one_draw(tradeoff)));
}

std::string error_section(const Tradeoff& tradeoff) {
  const std::vector<bool> front = pareto_front(tradeoff.measurements);
  std::vector<std::vector<std::string>> rows;
  std::string failures;
  for (std::size_t i = 0; i < front.size(); ++i) {
    const TradeoffMeasurement& m = tradeoff.measurements[i];
    if (!m.measured()) {
      failures += "<li>" + html::escaped(m.setting.name + ": " + m.failure) + "</li>";
      continue;
    }
    rows.push_back({m.setting.name, front[i] ? "front" : "", with_spread(m.clipped), html::number(m.clipped.draw_deviation), with_spread(m.relative), with_spread(m.square_root),
                    html::number(m.cpu_seconds), html::number(m.seconds), memory(m.peak_bytes), materials_text(m), std::to_string(m.runs.front().fit_views)});
  }
  std::string body = html::table({"setting", "", "clipped error", "one draw", "relative", "square roots", "CPU seconds", "seconds", "peak MB", "materials", "views"}, rows);
  if (!failures.empty()) body += "<h3>Not measured</h3><ul>" + failures + "</ul>";
  return html::section("Each setting",
                       "RMS of rendering minus photograph over that of the photograph, over all held-out pixels; clipped: both at the photograph's "
                       "99.9th percentile; square roots: of their roots. ±: one standard error, over the held-out photographs and over draws of the "
                       "surface points that materials are learnt on. One draw: how far a single fit strays (standard deviation)." + of_one_draw(tradeoff),
                       body);
}

std::string gain_section(const Tradeoff& tradeoff) {
  std::vector<std::vector<std::string>> rows;
  for (const TradeoffMeasurement& m : tradeoff.measurements) {
    const auto gain = gain_over_standard(tradeoff, m);
    if (!gain || m.setting.name == kStandardSetting) continue;
    rows.push_back({m.setting.name, with_spread(gain->gain), html::number(gain->more_cpu_seconds), html::number(gain->per_second)});
  }
  if (rows.empty()) return "";
  return html::section("Against the standard preset",
                       "Gain: standard's clipped error less this setting's; above 0, this setting is better. ± is the standard error of the "
                       "differences on the same photographs and draws: a gain within twice that, with two to four draws within three times, may be chance, and of many "
                       "settings some gain by chance alone. Per CPU second: of a slower setting, what each "
                       "second more buys; of a faster one, what each second saved costs; below 0, one of the two is both faster and better. An en "
                       "dash where the times differ by less than 5 %, as runs of one setting do.",
                       html::table({"setting", "gain", "more CPU seconds", "gain per CPU second"}, rows));
}

std::string meaning_section(const Tradeoff& tradeoff) {
  std::vector<std::vector<std::string>> rows;
  for (const TradeoffMeasurement& m : tradeoff.measurements) rows.push_back({m.setting.name, m.setting.what});
  return html::section("What the settings are",
                       "All but the presets are the standard preset with something changed. CPU seconds are of all threads, of the fit alone, the mean of its "
                       "draws; seconds are its wall time, on this machine as busy as it was. Calibration and comparison are not counted. Peak memory is "
                       "the process's during that fit.",
                       html::table({"setting", "meaning"}, rows));
}

}  // namespace

std::string tradeoff_page(const std::string& session_name, const Tradeoff& tradeoff, const std::string& json) {
  const std::string body =
      header(session_name, tradeoff) + plot_section(tradeoff) + error_section(tradeoff) + gain_section(tradeoff) + meaning_section(tradeoff);
  return html::page(session_name + " – speed against accuracy", kPageStyle, body, json);
}

}  // namespace lumitexel
