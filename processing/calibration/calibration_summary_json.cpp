#include "processing/calibration/calibration_summary_json.h"

#include <nlohmann/json.hpp>

namespace nlohmann {

template <>
struct adl_serializer<Eigen::Vector3d> {
  static void to_json(json& j, const Eigen::Vector3d& v) { j = {v.x(), v.y(), v.z()}; }
  static void from_json(const json& j, Eigen::Vector3d& v) {
    const auto values = j.get<std::array<double, 3>>();
    v = {values[0], values[1], values[2]};
  }
};

template <typename T>
struct adl_serializer<std::optional<T>> {
  static void to_json(json& j, const std::optional<T>& value) { j = value ? json(*value) : json(nullptr); }
  static void from_json(const json& j, std::optional<T>& value) {
    value = j.is_null() ? std::optional<T>() : j.get<T>();
  }
};

}  // namespace nlohmann

namespace lumitexel {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LightSummary, view, position_in_world, sigma_m, from_spheres, highlights, outliers,
                                   residual_px, spheres_alone_in_world, spheres_alone_sigma_m, off_the_arm)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StrayLightSummary, views, placed, position_in_rig, sigma_m, card_share, card_share_sigma,
                                   counted_in_scale)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SensorSummary, source, electrons_per_dn, read_noise_dn, black_level_dn,
                                   saturation_dn, electrons_per_dn_sigma, read_noise_dn_sigma, black_level_dn_sigma,
                                   saturation_dn_sigma, linear, coldest_c, warmest_c, brackets_with_scaled_darks,
                                   brackets_with_drifted_darks, least_dark_scale, largest_dark_scale, notes)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LensSummary, source, reprojection_px, params, sigma, corner_sigma_px, boards, notes,
                                   corner_transmission, corner_transmission_sigma)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PoseSummary, view, source, sigma_m, sigma_deg, silhouette_px, tags, dominant, given_px,
                                   contradiction, problem)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LampSummary, drifts, factor, factor_sigma, card_views, card_outliers,
                                   pattern_parameters, at_10_deg, at_10_deg_sigma, card_source, radius_m, radius_source,
                                   highlights_radius_m, highlights_radius_sigma_m, highlights_radius_bound_m,
                                   highlights_radius_found)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(JointSummary, tried, taken, chi2_gain)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(UncertaintyShare, quantity, source, share)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CalibrationSummary, lights, stray_lights, spheres_seen, sphere_residual_px, sphere_sigma_scale, arm_scatter_m,
                                   arm_residual_m, intensity, gray_card_pixel_scatter, scale_sigma, hot_pixels,
                                   views_without_silhouette, sensor, lens, poses, pose_problem, joint, rim_offset_px,
                                   rim_offset_sigma_px, lamp, shares, pictures)

nlohmann::json summary_json(const CalibrationSummary& summary) { return summary; }
CalibrationSummary summary_from_json(const nlohmann::json& json) { return json.get<CalibrationSummary>(); }

}  // namespace lumitexel
