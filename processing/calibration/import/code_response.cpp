#include "processing/calibration/import/code_response.h"

#include <algorithm>
#include <cmath>

#include "drivers/error.h"
#include "processing/calibration/import/text_fields.h"

namespace lumitexel {

CodeResponse CodeResponse::linear() { return {}; }

CodeResponse CodeResponse::srgb() {
  CodeResponse response;
  response.kind_ = Kind::Srgb;
  return response;
}

CodeResponse CodeResponse::from_csv(std::string_view text, const std::string& where) {
  CodeResponse response;
  response.kind_ = Kind::Curve;
  std::vector<Point>& curve = response.curve_;
  for (const TextLine& line : lines_of(text, where)) {
    const std::string_view content = trimmed(line.text);
    if (content.empty() || content.front() == '#' || (curve.empty() && content == "code,linear")) continue;
    const std::vector<std::string_view> fields = split_at(content, ',');
    if (fields.size() != 2) throw BadInput(line.place, std::to_string(fields.size()) + " fields", "code,linear");
    const Point point{number_from(fields[0], line.place, "code"), number_from(fields[1], line.place, "linear")};
    if (!curve.empty() && point.fraction <= curve.back().fraction) {
      throw BadInput(line.place + ": code", std::string(fields[0]), "more than in the line before");
    }
    if (point.linear < (curve.empty() ? 0.0 : curve.back().linear)) {
      throw BadInput(line.place + ": linear", std::string(fields[1]),
                     "no less than in the line before, and not negative");
    }
    curve.push_back(point);
  }
  if (curve.size() < 2 || curve.front().fraction != 0.0 || curve.back().fraction != 1.0) {
    throw BadInput(where + ": code", "a curve that does not reach from 0 to 1", "0 in the first line, 1 in the last");
  }
  if (curve.back().linear <= curve.front().linear) throw BadInput(where + ": linear", "a flat curve", "a rising one");
  return response;
}

double CodeResponse::radiance(double fraction) const {
  switch (kind_) {
    case Kind::Linear:
      return fraction;
    case Kind::Srgb:
      return fraction <= 0.04045 ? fraction / 12.92 : std::pow((fraction + 0.055) / 1.055, 2.4);
    case Kind::Curve:
      break;
  }
  const auto above = std::lower_bound(curve_.begin() + 1, curve_.end() - 1, fraction,
                                      [](const Point& point, double value) { return point.fraction < value; });
  const Point &low = *(above - 1), &high = *above;
  return std::lerp(low.linear, high.linear, (fraction - low.fraction) / (high.fraction - low.fraction));
}

}  // namespace lumitexel
