// A normal observation of which only "at least so much" is known (Tobin's model).
#pragma once

namespace lumitexel {

// Density over distribution of the standard normal at a: the slope of log(distribution). With h of it, the curvature of
// the log likelihood is -h (h + a). Finite for every finite a.
double log_cdf_slope(double a);
// The logarithm of the distribution itself.
double log_cdf(double a);

}  // namespace lumitexel
