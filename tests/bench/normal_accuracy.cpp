// How far a fit's normals are from the true surface's, beside the coarse mesh's and plain Lambertian photometric stereo's on the same
// samples: for sessions whose true surface is known as a mesh.
#include <CLI/CLI.hpp>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>

#include "processing/fit/fit_model.h"
#include "processing/normals/directed_samples.h"
#include "processing/surface/best_view.h"
#include "processing/surface/gather_lumitexels.h"
#include "processing/surface/mesh_file.h"
#include "processing/surface/view_geometry.h"
#include "rig/session_store.h"
#include "tests/bench/fit_settings.h"
#include "tests/bench/machine.h"

namespace lumitexel {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kReach = 0.02;  // of the mesh's diagonal: how far the true surface may be from the scanned one

// The true surface's normal where a line along the coarse normal meets it; zero where it does not.
class TrueNormals {
 public:
  explicit TrueNormals(Mesh mesh) : mesh_(with_normals(std::move(mesh))), scene_(mesh_) {
    Eigen::Vector3d low = mesh_.positions[0], high = low;
    for (const Eigen::Vector3d& p : mesh_.positions) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    reach_m_ = kReach * (high - low).norm();
  }
  Eigen::Vector3d at(const Eigen::Vector3d& position, const Eigen::Vector3d& coarse) const {
    const auto hit = scene_.closest(position + reach_m_ * coarse, -coarse);
    if (!hit || hit->distance_m > 2.0 * reach_m_) return Eigen::Vector3d::Zero();
    return surface_point(mesh_, hit->triangle, hit->u, hit->v).normal;
  }

 private:
  static Mesh with_normals(Mesh mesh) {
    if (mesh.normals.empty()) mesh.normals = vertex_normals(mesh);
    return mesh;
  }
  Mesh mesh_;
  RayScene scene_;
  double reach_m_ = 0;
};

// Woodham's: albedo times normal by least squares over the channels' mean. The coarse normal where fewer than three lights tell.
Eigen::Vector3d photometric_stereo(const std::vector<DirectedSample>& samples, int channels, const Eigen::Vector3d& coarse) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const DirectedSample& sample : samples) {
    double mean = 0.0;
    for (int c = 0; c < channels; ++c) mean += static_cast<double>(sample.observation.reflectance[static_cast<std::size_t>(c)]) / channels;
    matrix += sample.wi * sample.wi.transpose();
    right += mean * sample.wi;
  }
  const Eigen::Vector3d scaled = matrix.ldlt().solve(right);
  return scaled.allFinite() && scaled.norm() > 0.0 ? scaled.normalized() : coarse;
}

struct Row {
  std::size_t samples;
  double coarse, stereo, fitted;  // degrees off the truth
  double sigma;                   // stated, of one axis, degrees
};

double degrees(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return kDegrees * std::atan2(a.cross(b).norm(), a.dot(b)); }

Eigen::Vector3d model_normal(const Model& model, std::uint32_t texel, const Eigen::Vector3d& coarse) {
  const float* n = &model.normal.data[std::size_t{3} * texel];
  const Eigen::Vector3d normal(n[0], n[1], n[2]);
  return normal.isZero() ? coarse : normal;
}

std::vector<Row> rows_of(const CalibratedSession& session, const Model& model, const TrueNormals& truth) {
  NoProgress quiet;
  const RayScene scene(session.mesh);
  const Atlas atlas = make_atlas(session, choose_best_views(session, scene));  // as the fit made it
  const GatheredLumitexels gathered = gather_lumitexels(session, atlas, scene, quiet);
  const DirectedLumitexels lumitexels(session, gathered.set);
  std::vector<Row> rows;
  std::vector<DirectedSample> samples;
  for (std::size_t i = 0; i < lumitexels.size(); ++i) {
    const Eigen::Vector3d coarse = lumitexels.coarse_normal(i), right = truth.at(lumitexels.position(i), coarse);
    if (right.isZero()) continue;
    lumitexels.samples_of(i, samples);
    const std::uint32_t texel = lumitexels.texel(i);
    rows.push_back({samples.size(), degrees(coarse, right), degrees(photometric_stereo(samples, session.channels, coarse), right),
                    degrees(model_normal(model, texel, coarse), right),
                    has_normals(model) ? kDegrees * static_cast<double>(model.normal_sigma.data[texel]) : 0.0});
  }
  return rows;
}

void print(const std::string& title, const std::vector<Row>& rows, std::size_t least, std::size_t most) {
  const auto column = [&](double Row::*value) {
    std::vector<double> values;
    for (const Row& row : rows) {
      if (row.samples >= least && row.samples <= most) values.push_back(row.*value);
    }
    std::sort(values.begin(), values.end());
    return values;
  };
  const std::size_t count = column(&Row::fitted).size();
  std::printf("%-18s %8zu", title.c_str(), count);
  if (count == 0) {
    std::printf("\n");
    return;
  }
  for (double Row::*value : {&Row::coarse, &Row::stereo, &Row::fitted}) {
    const std::vector<double> sorted = column(value);
    double sum = 0.0;
    for (const double x : sorted) sum += x;
    std::printf("   %6.2f %6.2f", sorted[count / 2], sum / static_cast<double>(count));
  }
  std::vector<double> over;  // squares: of one axis in the mean 1
  for (const Row& row : rows) {
    if (row.samples >= least && row.samples <= most && row.sigma > 0.0) over.push_back(row.fitted * row.fitted / (2.0 * row.sigma * row.sigma));
  }
  if (over.empty()) {
    std::printf("\n");
    return;
  }
  std::sort(over.begin(), over.end());
  const double mean = std::accumulate(over.begin(), over.end(), 0.0) / static_cast<double>(over.size());
  // Of two axes that err normally the squares' median is ln 2.
  std::printf("   %6.2f %6.2f\n", std::sqrt(over[over.size() / 2] / std::numbers::ln2), std::sqrt(mean));
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) {
  CLI::App app("Angles between a fit's normals and the true surface's");
  lumitexel::FitSettings settings;
  std::string truth;
  settings.ask_for(app);
  app.add_option("--truth", truth, "The true surface, PLY or OBJ, in the frame of the session's mesh")->required();
  bool alone = false;
  app.add_flag("--texel", alone, "Each texel's normal by its own samples alone, as the paper has it");
  int steps = lumitexel::NormalFitOptions().most_steps;
  app.add_option("--steps", steps, "Most steps of the search for normals")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  using namespace lumitexel;
  NoProgress quiet;
  const CalibratedSession session = calibrate_session(SessionStore::open(settings.session, OpenMode::ReadOnly), quiet);
  FitOptions options = settings.options();
  options.normals = alone ? NormalChoice::Texel : NormalChoice::Fitted;
  options.normal_fit.most_steps = steps;
  const FittedModel fitted = fit_model(session, options, StageTimer(), quiet);
  std::printf("%s\n%s, %s quality, %d materials, %d lobes; degrees off the true normal, median and mean\n", machine_line().c_str(),
              settings.session.c_str(), settings.quality.c_str(), options.materials, options.most_lobes);
  std::printf("%-18s %8s   %13s   %13s   %13s   %s\n", "samples", "texels", "mesh", "stereo", "fitted", "fitted over its sigma, median and rms");
  const std::vector<Row> rows = rows_of(session, fitted.model, TrueNormals(read_mesh(truth)));
  constexpr std::size_t kMost = 10000;
  print("3 and more", rows, 3, kMost);
  print("none", rows, 0, 0);
  print("1, 2", rows, 1, 2);
  print("3, 4", rows, 3, 4);
  print("5 to 8", rows, 5, 8);
  print("9 and more", rows, 9, kMost);
  const double before = fitted.summary.projection.rms, after = fitted.summary.normal->rms;
  std::printf("RMS of the samples: P-RMS %.5f, N-RMS %.5f, ratio %.2f\n", before, after, after / before);
}
