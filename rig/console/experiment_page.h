// What `lumitexel experiment` found, as one page for people: a single HTML file that needs nothing else.
#pragma once

#include <string>
#include <vector>

#include "processing/brdf/experiment/experiment_rows.h"

namespace lumitexel {

// rows: with their scores. way: how they were clustered, in words. json: what the command states, carried in the page's data block.
std::string experiment_page(const std::vector<ExperimentRow>& rows, const std::string& way, const std::string& json);

// Inline SVG drawings of one row; empty if no seed found all five.
// The five lobes as they are, along the plane of incidence, and below by how much the recovered ones differ: the band that nine seeds of
// ten keep to, by material.
std::string lobes_plot(const ExperimentRow& row);
// Root mean square over seeds of each parameter's error, in Cramer-Rao bounds.
std::string bounds_plot(const ExperimentRow& row);
// Of all rows, mean shares of lumitexels labelled rightly: ours, and the two that know the truth.
std::string labels_plot(const std::vector<ExperimentRow>& rows);

}  // namespace lumitexel
