// What calibration measured beside what the fit needs: uncertainties, and figures that tell whether to trust it. One
// sigma throughout; what was not measured is empty, and `source` or a note says what was taken instead.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lumitexel {

struct LightSummary {
  std::string view;
  Eigen::Vector3d position_in_world = Eigen::Vector3d::Zero();  // for directional lights the unit vector towards it
  double sigma_m = 0;                                           // per axis; 0 if unknown
  bool from_spheres = false;                                    // false: predicted by the arm alone, or imported
  int highlights = 0, outliers = 0;
  double residual_px = 0;
  Eigen::Vector3d spheres_alone_in_world = Eigen::Vector3d::Zero();  // the spheres' measurement without the arm's help
  double spheres_alone_sigma_m = 0;
  bool off_the_arm = false;  // farther from the aligned arm than 5 sigma
};

// A light that is not the rig's own but shone with it (processing/calibration/light/stray_lights.h).
struct StrayLightSummary {
  std::vector<std::string> views;                              // whose spheres show it
  bool placed = true;                                          // false: too far away for its distance to be known
  Eigen::Vector3d position_in_rig = Eigen::Vector3d::Zero();  // as the rig's file has the camera; not placed: unit vector towards it
  double sigma_m = 0;                                          // per axis; 0 if not placed
  // Its irradiance at the gray card over the lamp's, in the channel with most of it, if nothing stands between: empty where it
  // could not be told; channels in which it could not the scale's sigma counts as much as the lamp.
  std::optional<double> card_share{}, card_share_sigma{};
  // Whether the scale's sigma holds it: false where one view alone showed it, and not the one whose lamp stood nearest to that of the
  // gray card's bracket (then it is taken not to have shone there).
  bool counted_in_scale = true;
};

struct SensorSummary {
  std::string source = "rig description";  // of the noise figures; else "photon transfer"
  double electrons_per_dn = 0, read_noise_dn = 0, black_level_dn = 0, saturation_dn = 0;
  std::optional<double> electrons_per_dn_sigma, read_noise_dn_sigma, black_level_dn_sigma, saturation_dn_sigma;
  bool linear = true;                                      // false: a response curve was undone
  std::optional<double> coldest_c, warmest_c;              // over the session's frames
  int brackets_with_scaled_darks = 0;                      // the frames' dark current was not that of their darks
  int brackets_with_drifted_darks = 0;                     // nor could it be told how much it was
  std::optional<double> least_dark_scale, largest_dark_scale;
  std::vector<std::string> notes{};
};

struct LensSummary {
  std::string source = "rig description";  // else "boards of this session"; of imports "given", "silhouettes"
  std::optional<double> reprojection_px;   // rms
  std::vector<double> params{};            // focal x, y, principal x, y (px), k1, k2, p1, p2; empty for imports
  std::vector<double> sigma{};             // of each, or of the first four; empty if unknown
  std::optional<double> corner_sigma_px;   // of where the lens puts a direction, in the corner where it knows least
  int boards = 0;                          // used
  std::vector<std::string> notes{};        // boards rejected and why, parts of the picture without boards, refusals
  std::optional<double> corner_transmission, corner_transmission_sigma;  // against the principal point
};

struct PoseSummary {
  std::string view;
  std::string source = "rig description";           // else "silhouette", "silhouette and tags", "given"
  std::optional<double> sigma_m, sigma_deg;          // of |shift| and |turn| of the object before the camera
  std::optional<double> silhouette_px;               // median distance between the mesh's outline and the picture's
  int tags = 0;
  std::string dominant{};                            // what most of the shift's variance comes from
  // Of imported poses: the same distance at the given pose, the chi-square (six degrees of freedom) by which the silhouette contradicts
  // it, and why nothing was measured or the silhouette does not determine the pose.
  std::optional<double> given_px{}, contradiction{};
  std::string problem{};
};

struct JointSummary {
  bool tried = false, taken = false;  // highlights asked about the lens; what they say was significant
  double chi2_gain = 0;               // by which chi square of highlights and prior fell
};

struct LampSummary {
  bool drifts = false;
  std::vector<double> factor{}, factor_sigma{};   // a view: output over that at the gray card's bracket
  int card_views = 0, card_outliers = 0;          // views in which the card could be measured, and did not fit
  int pattern_parameters = 0;                     // 0: equal in all directions, as far as is known
  std::optional<double> at_10_deg, at_10_deg_sigma;  // relative to its axis
  std::string card_source = "rig description";    // of the card's pose; else "tags"
  double radius_m = 0;                            // of its disc; 0: a point, as far as is known
  std::string radius_source = "rig description";  // else "highlights", which contradict it
  // By the highlights, whatever the source: a radius with its sigma, or a 95 % bound of one too small to be told from a point; neither
  // where they tell nothing.
  std::optional<double> highlights_radius_m{}, highlights_radius_sigma_m{}, highlights_radius_bound_m{};
  bool highlights_radius_found = true;  // false: the search ended at the largest lamp there may be, or before it was near
};

// Shares of a quantity's variance.
struct UncertaintyShare {
  std::string quantity, source;
  double share = 0;
};

struct CalibrationSummary {
  std::vector<LightSummary> lights;  // in the order of the session's views
  std::vector<StrayLightSummary> stray_lights;
  int spheres_seen = 0;              // by the ring flash, of the rig's
  double sphere_residual_px = 0;     // rms over all highlights of the session
  double sphere_sigma_scale = 0;     // residuals over stated sigmas
  double arm_scatter_m = 0, arm_residual_m = 0;
  std::vector<double> intensity, gray_card_pixel_scatter;
  double scale_sigma = 0;            // relative
  std::int64_t hot_pixels = 0;       // in the darks with the most of them
  int views_without_silhouette = 0;  // masked by the mesh's projection alone
  SensorSummary sensor;
  LensSummary lens;
  std::vector<PoseSummary> poses;  // in the order of the session's views
  std::string pose_problem;        // why poses are the rig description's; empty if they are not, or nothing was tried
  JointSummary joint;
  std::optional<double> rim_offset_px, rim_offset_sigma_px;  // imports: masks' rims lie outside of the mesh's outline by this
  LampSummary lamp;
  std::vector<UncertaintyShare> shares;  // sums to 1 for each quantity
  std::vector<std::string> pictures;     // PNG files beside the photographs, "lens_coverage.png"
};

}  // namespace lumitexel
