#include "processing/report/html.h"

#include <cmath>
#include <cstdio>

#include "processing/image/raster_file.h"
#include "processing/report/base64.h"

namespace lumitexel::html {
namespace {

// "</script>" inside a string would end the block; "<\/" means the same to JSON and nothing to HTML.
std::string safe_in_script(const std::string& json) {
  std::string text;
  for (std::size_t i = 0; i < json.size(); ++i) {
    text += json[i];
    if (json[i] == '<' && i + 1 < json.size() && json[i + 1] == '/') text += '\\';
  }
  return text;
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += letter;
    }
  }
  return safe;
}

std::string number(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  char text[40];
  const double magnitude = std::abs(value);
  if (value != 0.0 && (magnitude < 1e-4 || magnitude >= 1e7)) {
    std::snprintf(text, sizeof text, "%.*e", digits - 1, value);
    return text;
  }
  const int before_point = magnitude >= 1.0 ? static_cast<int>(std::floor(std::log10(magnitude))) + 1 : 0;
  const int leading_zeros =
      magnitude > 0.0 && magnitude < 1.0 ? -static_cast<int>(std::floor(std::log10(magnitude))) - 1 : 0;
  const int decimals = value == std::floor(value) ? 0 : std::max(0, digits - before_point + leading_zeros);
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

std::string picture(const Image& unit_values, const std::string& description) {
  return "<img alt=\"" + escaped(description) + "\" width=\"" + std::to_string(unit_values.width) + "\" height=\"" +
         std::to_string(unit_values.height) + "\" src=\"data:image/png;base64," + base64(encode_png8(unit_values)) +
         "\">";
}

std::string css_colour(const std::array<float, 3>& colour) {
  char text[40];
  std::snprintf(text, sizeof text, "rgb(%.0f,%.0f,%.0f)", 255.0 * colour[0], 255.0 * colour[1], 255.0 * colour[2]);
  return text;
}

std::string colour_scale(const std::array<float, 3>& low, const std::array<float, 3>& high, const std::string& low_means,
                         const std::string& high_means) {
  return "<div class=\"scale\"><div class=\"bar\" style=\"background:linear-gradient(to right," + css_colour(low) + "," + css_colour(high) +
         ")\"></div><div class=\"ends\"><span>" + escaped(low_means) + "</span><span>" + escaped(high_means) + "</span></div></div>\n";
}

std::string figure(const std::string& picture_markup, const std::string& caption) {
  return "<figure>" + picture_markup + "<figcaption>" + escaped(caption) + "</figcaption></figure>\n";
}

std::string table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows) {
  std::string text = "<div class=\"scroll\"><table><thead><tr>";
  for (const std::string& cell : header) text += "<th>" + escaped(cell) + "</th>";
  text += "</tr></thead><tbody>\n";
  for (const auto& row : rows) {
    text += "<tr>";
    for (const std::string& cell : row) text += "<td>" + escaped(cell) + "</td>";
    text += "</tr>\n";
  }
  return text + "</tbody></table></div>\n";
}

std::string section(const std::string& title, const std::string& introduction, const std::string& body) {
  return "<section><h2>" + escaped(title) + "</h2>\n<p>" + escaped(introduction) + "</p>\n" + body + "</section>\n";
}

std::string page(const std::string& title, const std::string& style, const std::string& body,
                 const std::string& data_json) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         escaped(title) + "</title>\n<style>\n" + style + "</style></head>\n<body><main>\n" + body +
         "</main>\n<script type=\"application/json\" id=\"data\">" + safe_in_script(data_json) +
         "</script>\n</body></html>\n";
}

}  // namespace lumitexel::html
