// How much one exposure can tell about the light on a pixel at best: the Fisher information of one raw sample.
#pragma once

namespace lumitexel {

struct SensorNoise {
  double electrons_per_dn = 1.0, read_noise_e = 0.0, full_well_e = 0.0;
};

// Of the mean number of electrons `mean_e` (light and dark current alike), in 1/electrons^2: electrons are Poisson, stop
// at the full well, then read noise and rounding (as a variance of 1/12 DN^2) are added. Poisson exactly below 200
// electrons, as its normal limit above. Numerical integration, relative error below 1e-3.
double sample_information(double mean_e, const SensorNoise& noise);

}  // namespace lumitexel
