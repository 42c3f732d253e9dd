#include "processing/normals/normals_worth.h"

#include <cmath>
#include <map>
#include <utility>

#include "processing/normals/lumitexel_bands.h"

namespace lumitexel {
namespace {

constexpr std::size_t kLeftOutEvery = 5;
constexpr std::size_t kMostLumitexels = 40000;
constexpr int kWeightRounds = 3;       // weights count samples by how far off they are: a few rounds settle that
constexpr std::size_t kFewestSamples = 50;  // of a block of the surface in one photograph

// Every fifth photograph that the fit may see, and at least one.
std::vector<std::size_t> left_out_views(const CalibratedSession& session) {
  std::vector<std::size_t> views;
  std::size_t seen = 0;
  for (std::size_t v = 0; v < session.views.size(); ++v) {
    if (!session.views[v].heldout && seen++ % kLeftOutEvery == kLeftOutEvery / 2) views.push_back(v);
  }
  return views;
}

std::vector<int> labels_of(const LumitexelBands& bands, const std::vector<int>& label) {
  std::vector<int> result;
  for (const std::size_t i : bands.lumitexel) result.push_back(label[i]);
  return result;
}

struct Cell {
  double gain = 0;
  std::size_t samples = 0;
};

// One photograph's samples, by block.
void judge(const NormalProblem& left_out, const NormalField& mesh, const NormalField& fitted, const std::vector<std::uint32_t>& block,
           std::map<std::uint32_t, Cell>& cells) {
  std::vector<DirectedSample> samples;
  const auto misfit = [&](const NormalField& field, std::size_t i) {
    return normal_misfit(left_out.material_of(i), field.weights[i].weight, field.normal[i], samples, left_out.lumitexels.channels());
  };
  for (std::size_t i = 0; i < left_out.lumitexels.size(); ++i) {
    left_out.lumitexels.samples_of(i, samples);
    if (samples.empty()) continue;
    Cell& cell = cells[block[i]];
    cell.gain += misfit(mesh, i) - misfit(fitted, i);
    cell.samples += samples.size();
  }
}

// Cells count by their samples; their scatter about the mean says how sure the mean is.
NormalsWorth mean_gain(const std::vector<Cell>& cells) {
  NormalsWorth worth;
  for (const Cell& cell : cells) {
    worth.gain += cell.gain;
    worth.samples += cell.samples;
  }
  if (cells.size() < 2) return {0.0, 0.0, worth.samples};
  const auto samples = static_cast<double>(worth.samples);
  worth.gain /= samples;
  double squares = 0.0;
  for (const Cell& cell : cells) {
    const double off = cell.gain - worth.gain * static_cast<double>(cell.samples);
    squares += off * off;
  }
  const auto count = static_cast<double>(cells.size());
  worth.gain_sigma = std::sqrt(squares * count / (count - 1.0)) / samples;
  return worth;
}

}  // namespace

NormalsWorth normals_worth(const CalibratedSession& session, const LumitexelSet& lumitexels, int atlas_width,
                           const std::vector<std::vector<Brdf>>& bases, const std::vector<int>& label, double median_reflectance,
                           const NormalFitOptions& options) {
  const LumitexelBands bands = lumitexel_bands(lumitexels, atlas_width, kMostLumitexels);
  const std::vector<NormalMaterial> materials = normal_materials(bases, lumitexels.channels, median_reflectance, options);
  const std::vector<int> own_label = labels_of(bands, label);
  const std::vector<std::size_t> left_out = left_out_views(session);
  std::vector<bool> used(session.views.size(), true);
  for (const std::size_t view : left_out) used[view] = false;

  const DirectedLumitexels learnt(session, bands.set, used);
  const Neighbours neighbours = lumitexel_neighbours(learnt, atlas_width);
  const NormalProblem problem{learnt, neighbours, materials, own_label};
  NormalField mesh = field_on_mesh(problem);
  const NormalField fitted = smooth_normals(problem, mesh, {options.prior, options.steps});
  for (int round = 0; round < kWeightRounds; ++round) follow_with_weights(problem, mesh);

  std::vector<Cell> cells;
  for (const std::size_t view : left_out) {
    std::vector<bool> only(session.views.size(), false);
    only[view] = true;
    const DirectedLumitexels unseen(session, bands.set, only);
    std::map<std::uint32_t, Cell> by_block;
    judge({unseen, neighbours, materials, own_label}, mesh, fitted, bands.block, by_block);
    for (const auto& [block, cell] : by_block) {
      if (cell.samples >= kFewestSamples) cells.push_back(cell);
    }
  }
  return mean_gain(cells);
}

}  // namespace lumitexel
