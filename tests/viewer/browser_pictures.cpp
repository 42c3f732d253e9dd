#include "tests/viewer/browser_pictures.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "rig/whole_file.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

using nlohmann::json;

std::vector<unsigned char> from_base64(const std::string& text) {
  std::vector<unsigned char> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char letter : text) {
    int value = 0;
    if (letter >= 'A' && letter <= 'Z') value = letter - 'A';
    else if (letter >= 'a' && letter <= 'z') value = letter - 'a' + 26;
    else if (letter >= '0' && letter <= '9') value = letter - '0' + 52;
    else if (letter == '+') value = 62;
    else if (letter == '/') value = 63;
    else break;
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<unsigned char>(bits >> count & 0xffu));
    }
  }
  return bytes;
}

// WebGL's bottom row first, turned over.
std::vector<float> picture(const std::string& base64, const CameraModel& camera) {
  const std::vector<unsigned char> bytes = from_base64(base64);
  const auto row = static_cast<std::size_t>(camera.width_px) * 4, rows = static_cast<std::size_t>(camera.height_px);
  std::vector<float> values(row * rows);
  if (bytes.size() != values.size() * sizeof(float)) return {};
  for (std::size_t y = 0; y < rows; ++y) {
    std::memcpy(&values[y * row], &bytes[(rows - 1 - y) * row * sizeof(float)], row * sizeof(float));
  }
  return values;
}

json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

json view_json(const View& view) {
  const Eigen::Isometry3d world_from_camera = view.camera_from_world.inverse();
  const Eigen::Vector3d eye = world_from_camera.translation();
  json intensity = json::array();
  for (std::size_t c = 0; c < 3; ++c) intensity.push_back(view.light.intensity[std::min(c, view.light.intensity.size() - 1)]);
  return {{"eye", vector_json(eye)},
          {"target", vector_json(eye + world_from_camera.linear().col(2))},
          {"up", vector_json(-world_from_camera.linear().col(1))},
          {"fov_rad", 2.0 * std::atan(0.5 * view.camera.height_px / view.camera.focal_y_px)},
          {"width", view.camera.width_px},
          {"height", view.camera.height_px},
          {"light", vector_json(view.light.vector_in_world)},
          {"intensity", intensity}};
}

std::string percent_encoded(const std::string& text) {
  std::ostringstream out;
  for (const char letter : text) {
    if (std::isalnum(static_cast<unsigned char>(letter)) != 0 || std::strchr("-_.~", letter) != nullptr) {
      out << letter;
    } else {
      out << '%' << std::hex << std::uppercase << (static_cast<unsigned>(letter) >> 4 & 15u) << (static_cast<unsigned>(letter) & 15u);
    }
  }
  return out.str();
}

// What it wrote. until: a browser that shows a page does not end of itself; with this it ends once that is in its log.
std::string chromium(const std::filesystem::path& page, const json& wanted, const std::string& options, const std::string& limit_s, const std::string& until = "") {
  const TemporaryFolder folder;
  const std::string out = (folder / "out").string();
  const std::string command = "timeout " + limit_s + " chromium --headless=new --no-sandbox --no-first-run --use-gl=angle --use-angle=swiftshader " +
                              "--enable-unsafe-swiftshader --user-data-dir=" + (folder / "profile").string() + " " + options + " 'file://" +
                              page.string() + "#measure=" + percent_encoded(wanted.dump()) + "' >" + out + " 2>" + out + ".err";
  const std::string watched = command + " & browser=$!; while kill -0 $browser 2>/dev/null && ! grep -q '" + until + "' " + out + ".err; do sleep 0.1; done; kill $browser 2>/dev/null; wait $browser 2>/dev/null";
  [[maybe_unused]] const int status = std::system((until.empty() ? command : watched).c_str());
  return read_whole_file(out) + read_whole_file(out + ".err");
}

std::string between(const std::string& text, const std::string& before, const std::string& after) {
  const std::size_t start = text.find(before);
  if (start == std::string::npos) return "";
  const std::size_t end = text.find(after, start + before.size());
  return end == std::string::npos ? "" : text.substr(start + before.size(), end - start - before.size());
}

// Of the few letters that the browser writes otherwise.
std::string unescaped(std::string text) {
  const std::pair<const char*, const char*> kLetters[] = {{"&lt;", "<"}, {"&gt;", ">"}, {"&nbsp;", "\u00a0"}, {"&amp;", "&"}};
  for (const auto& [code, letter] : kLetters) {
    for (std::size_t at = 0; (at = text.find(code, at)) != std::string::npos; at += std::strlen(letter)) text.replace(at, std::strlen(code), letter);
  }
  return text;
}

// What the page wrote; discarded if it wrote nothing.
json measured_by(const std::filesystem::path& page, const json& wanted) {
  // The browser's clock stands still while it works, so a slow machine does not end it early.
  const std::string dumped = chromium(page, wanted, "--virtual-time-budget=20000 --dump-dom", "150");
  return json::parse(unescaped(between(dumped, "<pre id=\"measured\">", "</pre>")), nullptr, false);
}

}  // namespace

bool has_chromium() { return std::system("command -v chromium >/dev/null 2>&1") == 0; }

std::optional<json> browser_answer(const std::filesystem::path& page) {
  const json answer = measured_by(page, json::object());
  return answer.is_discarded() ? std::nullopt : std::optional<json>(answer);
}

std::optional<std::map<FitStage, BrowserPicture>> browser_pictures(const std::filesystem::path& page, const View& view,
                                                                   const std::vector<FitStage>& stages) {
  json wanted = view_json(view);
  for (const FitStage stage : stages) wanted["stages"].push_back(to_string(stage));
  const json measured = measured_by(page, wanted);
  if (measured.is_discarded()) return std::nullopt;
  std::map<FitStage, BrowserPicture> pictures;
  for (const FitStage stage : stages) {
    pictures[stage] = {picture(measured["radiance"][to_string(stage)], view.camera), picture(measured["texel"], view.camera)};
    if (pictures[stage].radiance.empty() || pictures[stage].texel.empty()) return std::nullopt;
  }
  return pictures;
}

std::optional<std::vector<std::vector<float>>> browser_sky(const std::filesystem::path& page, const View& view, FitStage stage, double turn_rad,
                                                           const std::vector<int>& passes) {
  json wanted = view_json(view);
  wanted["stages"] = {to_string(stage)};
  wanted["sky_turn_rad"] = turn_rad;
  wanted["sky_passes"] = passes;
  const json measured = measured_by(page, wanted);
  if (measured.is_discarded()) return std::nullopt;
  std::vector<std::vector<float>> pictures;
  for (const json& text : measured.at("sky")) pictures.push_back(picture(text, view.camera));
  return pictures;
}

std::optional<std::vector<float>> browser_figures(const std::filesystem::path& page, const View& view) {
  json wanted = view_json(view);
  wanted["stages"] = json::array();
  wanted["figures"] = true;
  const json measured = measured_by(page, wanted);
  if (measured.is_discarded()) return std::nullopt;
  return picture(measured.at("figures"), view.camera);
}

std::optional<json> browser_samples(const std::filesystem::path& page, const View& view, const std::vector<std::array<int, 2>>& texels) {
  json wanted = view_json(view);
  wanted["stages"] = json::array();
  wanted["samples_at"] = texels;
  const json measured = measured_by(page, wanted);
  if (measured.is_discarded()) return std::nullopt;
  return measured.at("samples");
}

std::optional<double> browser_frame_ms(const std::filesystem::path& page, const View& view, FitStage stage, int frames) {
  json wanted = view_json(view);
  wanted["stages"] = {to_string(stage)};
  wanted["frames"] = frames;
  const std::string log = chromium(page, wanted, "--enable-logging=stderr", "200", "frame_ms=");
  const std::string figure = between(log, "frame_ms=", ";");
  return figure.empty() ? std::nullopt : std::optional<double>(std::stod(figure));
}

}  // namespace lumitexel
