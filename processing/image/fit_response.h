// The response of a sensor that is not linear, recovered from brackets with known exposure times.
//
// sample = black + F(E) + noise with E = rate * exposure; its inverse L is what is looked for. OpenCV has Debevec and
// Malik's (1997) and Robertson's (1999) methods for 8 bits, with a table entry for every code and no noise model;
// tests/bench/response_table compares them. Here: maximum likelihood in the samples, every pixel's rate eliminated,
// with the sensor's noise (shot noise goes with E, read noise and rounding with the code). The curve is
//     L(u) = integral from 0 to u of exp(q),   u = (code - black) / (clip - black),
// so that it cannot fall; q is a cubic spline whose bends have a normal prior, its sigma chosen by the samples (MacKay
// 1992). Kinks of q, such as the end of sRGB's straight toe, are added where the evidence prefers a curve with them: a
// spline rounds them, by 0.3 to 0.5 % of sRGB. q's constant is the scale, which exposures cannot tell: L = u at u = 1/2.
//
// What kept it from the truth, and what is done: samples near clipping are censored (Tobin), not left out; those that
// count are chosen by the pixel's other samples, since a choice by the whole pixel prefers one sign of noise; shot
// noise is measured from the residuals, for its unit is that of L; a bent curve moves the mean code within the shot
// noise. Exposures at powers of one ratio r leave L exp(p(log L)) possible with any p of period log r, which only the
// prior holds back: prefer uneven ratios such as 3, 5, 4.2.
//
// The usable range is kUsableFrom to kUsableTo of the codes, and kUsableElectrons on. Above, shot noise reaches into
// clipping; below, one sample is good to 20 % at best, and a steep curve's mean code no longer tells its mean light.
// Known weak: a step of the slope (ROMM RGB's toe, a sensor of two slopes) is no kink of this kind and is rounded, by
// 4 to 8 % within a knot of it; kinks within half a knot of the usable range's ends are not looked for.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "processing/image/dark_frames.h"
#include "processing/image/linear_sensor.h"
#include "processing/image/response_curve.h"

namespace lumitexel {

struct ResponsePoint {
  double code_dn = 0, linear_dn = 0;
  double relative_sigma = 0;  // of linear_dn, the scale fixed at half the range
};

struct ResponseFit {
  // The curve, if the frames need one: its departure from a straight line is more than their noise explains (1 % error
  // of the first kind) and more than kNegligibleCurvature somewhere. Empty for a linear sensor.
  std::optional<ResponseCurve> curve;
  bool determined = false;  // the fit converged on enough samples; else `why` says what was lacking
  std::string why;
  std::vector<ResponsePoint> points;  // over the range that the samples cover
  double chi_square = 0;              // Wald's statistic of the straight line; freedoms: how many it has
  int freedoms = 0;
  double largest_departure = 0;  // from a straight line through the origin, relative, over `points`: at least so much
  double residual_scale = 0;     // root of the residuals' reduced chi-square; 1 if the noise model is right
  // Of linear_dn, from the residuals: merge with it. A linear sensor's is no guide, for the scale of the curve is free.
  double electrons_per_dn = 0;
  bool electrons_measured = false;  // else the sensor's own: too few pixels in which shot noise prevails
  int pixels = 0, iterations = 0;
  int kinks = 0;  // of the curve's log slope, which the samples demand
};

inline constexpr double kNegligibleCurvature = 0.003;  // the fit's own bias is up to 0.002
inline constexpr double kUsableFrom = 0.01, kUsableTo = 0.98, kUsableElectrons = 25.0;

// brackets: each of one still scene at two or more exposures whose times differ; black is subtracted as
// sensor.black_level says (dark current belongs to the light; keep exposures short). sensor: clip_dn bounds the codes;
// its noise in code units. Throws BadInput for frames that differ in size, exposures that are not positive, or a sensor
// that is none.
ResponseFit fit_response(const std::vector<std::vector<Frame>>& brackets, const LinearSensor& sensor);

}  // namespace lumitexel
