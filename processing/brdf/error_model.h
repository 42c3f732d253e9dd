// How far a measured reflectance may lie from a predicted one: the photograph's noise, plus what the model cannot know
// (the coarse mesh's normals, misregistration, light between surfaces), which grows with the signal.
#pragma once

namespace lumitexel {

struct ErrorModel {
  double relative = 0.3;  // standard deviation as a fraction of the predicted reflectance
  double floor = 1e-3;    // standard deviation for a prediction of zero, 1/sr

  double variance(double predicted, double measured_variance) const {
    const double share = relative * predicted;
    return share * share + floor * floor + measured_variance;
  }
};

}  // namespace lumitexel
