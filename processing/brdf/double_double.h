// A number as the unevaluated sum of two doubles: about 106 bits, for the few places where rounding an intermediate result to a
// double would show in the final one. Dekker's and Knuth's error-free sums and products.
#pragma once

#include <cmath>

namespace lumitexel {

struct DoubleDouble {
  double high = 0, low = 0;  // |low| at most half a unit in the last place of high
};

inline DoubleDouble exact_sum(double a, double b) {
  const double sum = a + b, part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

inline DoubleDouble exact_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

inline DoubleDouble renormalised(double high, double low) {
  const double sum = high + low;
  return {sum, low - (sum - high)};
}

inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = exact_sum(a.high, b.high), low = exact_sum(a.low, b.low);
  const DoubleDouble sum = renormalised(high.high, high.low + low.high);
  return renormalised(sum.high, sum.low + low.low);
}

inline DoubleDouble operator-(const DoubleDouble& a) { return {-a.high, -a.low}; }

inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble product = exact_product(a.high, b.high);
  return renormalised(product.high, product.low + (a.high * b.low + a.low * b.high));
}

inline DoubleDouble operator/(const DoubleDouble& a, double b) {
  const double quotient = a.high / b;
  return renormalised(quotient, (std::fma(-quotient, b, a.high) + a.low) / b);
}

}  // namespace lumitexel
