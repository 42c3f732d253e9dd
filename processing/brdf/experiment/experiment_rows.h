// The settings that the five-material experiment is run with, and what many seeds of one come to.
#pragma once

#include <string>
#include <vector>

#include "processing/brdf/experiment/five_materials.h"

namespace lumitexel {

struct ExperimentRow {
  std::string name;
  FiveMaterialsOptions options;
  std::vector<FiveMaterialsScore> scores;  // one a seed
};

// Even and uneven shares, each with uniform noise, Gaussian noise, and uniform noise with 2 % outliers; no scores yet.
std::vector<ExperimentRow> experiment_settings();

// Medians and root mean squares are over the seeds in which all five were found; NaN if none.
struct ExperimentTally {
  int seeds = 0;
  int five = 0;         // seeds that ended with five materials
  int found = 0;        // and with each exponent nearest to its own truth
  int under_paper = 0;  // and every N and kd within kPaperError
  double under_paper_at_bound = 0;  // as many as for who reaches the bound
  double worst_exponent = 0, worst_diffuse = 0;            // medians
  double exponent_over_bound = 0, diffuse_over_bound = 0;  // rms
  double exponent_over_unlabelled = 0, diffuse_over_unlabelled = 0;  // rms, over the bound for who is told no labels; NaN but for Gaussian noise
  // Of the accuracy of labels, in means: short of what the true law of the noise allows, and of what a normal one does.
  double short_of_bayes = 0, short_of_normal = 0;
};

ExperimentTally tally(const ExperimentRow& row);

}  // namespace lumitexel
