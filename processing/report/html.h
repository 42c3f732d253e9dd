// The few pieces of HTML that the report is made of. Every function returns markup; texts are escaped here, so that a
// name from a file cannot become markup.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "processing/image/image.h"

namespace lumitexel::html {

std::string escaped(const std::string& text);

// Three significant digits or as many as asked for; an en dash for what is not finite.
std::string number(double value, int digits = 3);

// An <img> that carries its PNG within itself. Values in [0, 1].
std::string picture(const Image& unit_values, const std::string& description);
std::string css_colour(const std::array<float, 3>& colour);  // of sRGB in [0, 1]
// A bar from one colour (sRGB in [0, 1]) to another with what its ends mean.
std::string colour_scale(const std::array<float, 3>& low, const std::array<float, 3>& high, const std::string& low_means,
                         const std::string& high_means);
// A picture (markup) over its caption (text).
std::string figure(const std::string& picture_markup, const std::string& caption);

// The first column is text, the others numbers. Cells are text.
std::string table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);

// introduction is text; body is markup.
std::string section(const std::string& title, const std::string& introduction, const std::string& body);

// A whole page: `style` is CSS, `data_json` goes into a script block of type application/json with the id "data".
std::string page(const std::string& title, const std::string& style, const std::string& body,
                 const std::string& data_json);

}  // namespace lumitexel::html
