// How the code values of an 8- or 16-bit photograph taken elsewhere map to linear radiance.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lumitexel {

class CodeResponse {
 public:
  static CodeResponse linear();
  static CodeResponse srgb();  // IEC 61966-2-1, code to linear
  // A curve, linear between its points: lines "FRACTION,LINEAR", the code value as a fraction of the largest, from 0 to
  // 1 and rising strictly, and the linear value, not negative, not falling, and rising over all. Lines that are blank
  // or begin with #, and a first line "code,linear", are skipped. Throws BadInput naming `where`, line and field.
  static CodeResponse from_csv(std::string_view text, const std::string& where);

  // fraction: code value / largest code value, in [0, 1].
  double radiance(double fraction) const;

 private:
  enum class Kind { Linear, Srgb, Curve };
  struct Point {
    double fraction, linear;
  };
  Kind kind_ = Kind::Linear;
  std::vector<Point> curve_;
};

}  // namespace lumitexel
