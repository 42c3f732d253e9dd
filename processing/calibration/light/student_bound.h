// Student's t by its expansion in 1 / degrees (Abramowitz, Stegun 26.7.5). Up to z = 3: exact to 2 % from three degrees on, 10 % for two;
// at z = 1 to 2 % for one, too.
#pragma once

namespace lumitexel {

// The value that t of so many degrees exceeds as seldom as a Gaussian exceeds z standard deviations.
inline double student_bound(double degrees, double z) {
  const double z2 = z * z;
  const double first = z * (z2 + 1.0) / 4.0;
  const double second = z * ((5.0 * z2 + 16.0) * z2 + 3.0) / 96.0;
  const double third = z * (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / 384.0;
  const double fourth = z * ((((79.0 * z2 + 776.0) * z2 + 1482.0) * z2 - 1920.0) * z2 - 945.0) / 92160.0;
  return z + (first + (second + (third + fourth / degrees) / degrees) / degrees) / degrees;
}

}  // namespace lumitexel
