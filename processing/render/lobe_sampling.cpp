#include "processing/render/lobe_sampling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumitexel {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLeastAxis = 1e-9;  // a lobe whose axis vanishes for this wo reflects nothing that matters

Eigen::Vector3d at_angles(double cosine, double sine, double azimuth) {
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

// `local` in a frame whose z is `axis` (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
Eigen::Vector3d about_axis(const Eigen::Vector3d& axis, const Eigen::Vector3d& local) {
  const double sign = std::copysign(1.0, axis.z()), a = -1.0 / (sign + axis.z()), b = axis.x() * axis.y() * a;
  const Eigen::Vector3d right(1.0 + sign * axis.x() * axis.x() * a, sign * b, -sign * axis.x());
  const Eigen::Vector3d ahead(b, sign + axis.y() * axis.y() * a, -axis.y());
  return local.x() * right + local.y() * ahead + local.z() * axis;
}

Eigen::Vector3d cosine_direction(const Eigen::Vector2d& u) {
  return at_angles(std::sqrt(1.0 - u.x()), std::sqrt(u.x()), 2.0 * kPi * u.y());
}

Eigen::Vector3d power_direction(const Eigen::Vector3d& axis, double exponent, const Eigen::Vector2d& u) {
  const double log_cosine = std::log1p(-u.x()) / (exponent + 1.0);
  const double cosine = std::exp(log_cosine), gap = -std::expm1(log_cosine);  // sharp lobes live in the gap's digits
  return about_axis(axis, at_angles(cosine, std::sqrt(gap * (1.0 + cosine)), 2.0 * kPi * u.y()));
}

Eigen::Vector3d visible_normal(const Eigen::Vector3d& wo, double alpha, const Eigen::Vector2d& u) {
  const Eigen::Vector3d stretched = Eigen::Vector3d(alpha * wo.x(), alpha * wo.y(), wo.z()).normalized();
  const double radius = std::sqrt(u.x()), azimuth = 2.0 * kPi * u.y(), shared = 0.5 * (1.0 + stretched.z());
  const double x = radius * std::cos(azimuth), rim = std::sqrt(std::max(0.0, 1.0 - x * x));
  const double y = (1.0 - shared) * rim + shared * radius * std::sin(azimuth);
  const double z = std::sqrt(std::max(0.0, 1.0 - x * x - y * y));
  const double level = stretched.head<2>().squaredNorm();
  Eigen::Vector3d right = Eigen::Vector3d::UnitX();
  if (level > 0.0) right = Eigen::Vector3d(-stretched.y(), stretched.x(), 0.0) / std::sqrt(level);
  const Eigen::Vector3d normal = x * right + y * stretched.cross(right) + z * stretched;
  return Eigen::Vector3d(alpha * normal.x(), alpha * normal.y(), std::max(0.0, normal.z())).normalized();
}

Eigen::Vector3d gaussian_normal(double alpha, const Eigen::Vector2d& u) {
  const double tangent = alpha * std::sqrt(-std::log1p(-u.x()));
  const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
  return at_angles(cosine, tangent * cosine, 2.0 * kPi * u.y());
}

Eigen::Vector3d mirrored(const Eigen::Vector3d& wo, const Eigen::Vector3d& normal) {
  return 2.0 * wo.dot(normal) * normal - wo;
}

double visible_normal_density(const Eigen::Vector3d& wo, const Eigen::Vector3d& h, double alpha) {
  const double alpha2 = alpha * alpha, spread = h.head<2>().squaredNorm() + alpha2 * h.z() * h.z();
  const double distribution = alpha2 / (kPi * spread * spread);
  const double seen = 2.0 * wo.z() / (wo.z() + std::sqrt(alpha2 + (1.0 - alpha2) * wo.z() * wo.z()));
  return distribution * seen / (4.0 * wo.z());  // G1 D max(0, wo.h) / cos_o over the mirror's 4 wo.h
}

double gaussian_normal_density(const Eigen::Vector3d& wo, const Eigen::Vector3d& h, double alpha) {
  const double cosine2 = h.z() * h.z(), tangent2 = h.head<2>().squaredNorm() / cosine2, alpha2 = alpha * alpha;
  return std::exp(-tangent2 / alpha2) / (kPi * alpha2 * cosine2 * h.z()) / (4.0 * wo.dot(h));
}

}  // namespace

LobeSampler::LobeSampler(BrdfFamily family, double log_shape, double aim) : shape_(std::exp(log_shape)) {
  switch (family) {
    case BrdfFamily::Lafortune:
      kind_ = Kind::Lafortune;
      toward_ = Eigen::Vector3d(-std::sin(aim), -std::sin(aim), std::cos(aim));
      break;
    case BrdfFamily::Ggx:
      kind_ = Kind::Ggx;
      break;
    case BrdfFamily::Ward:
      kind_ = Kind::Ward;
      break;
  }
}

Eigen::Vector3d LobeSampler::sample(const Eigen::Vector3d& wo, const Eigen::Vector2d& uniform) const {
  switch (kind_) {
    case Kind::Diffuse:
      return cosine_direction(uniform);
    case Kind::Lafortune: {
      const Eigen::Vector3d axis = toward_.cwiseProduct(wo);
      if (axis.norm() < kLeastAxis) return -Eigen::Vector3d::UnitZ();
      return power_direction(axis.normalized(), shape_, uniform);
    }
    case Kind::Ggx:
      return mirrored(wo, visible_normal(wo, shape_, uniform));
    case Kind::Ward:
      return mirrored(wo, gaussian_normal(shape_, uniform));
  }
  return -Eigen::Vector3d::UnitZ();
}

double LobeSampler::density(const Eigen::Vector3d& wo, const Eigen::Vector3d& wi) const {
  if (kind_ == Kind::Diffuse) return std::max(0.0, wi.z()) / kPi;
  if (kind_ == Kind::Lafortune) {
    const Eigen::Vector3d axis = toward_.cwiseProduct(wo);
    const double length = axis.norm();
    if (length < kLeastAxis) return 0.0;
    const double gap = 0.5 * (axis / length - wi).squaredNorm();  // one minus the cosine
    return gap < 1.0 ? (shape_ + 1.0) / (2.0 * kPi) * std::exp(shape_ * std::log1p(-gap)) : 0.0;
  }
  const Eigen::Vector3d sum = wo + wi;
  const Eigen::Vector3d h = sum.normalized();
  if (!(h.z() > 0.0) || !(wo.dot(h) > 0.0) || !(wo.z() > 0.0)) return 0.0;
  return kind_ == Kind::Ggx ? visible_normal_density(wo, h, shape_) : gaussian_normal_density(wo, h, shape_);
}

}  // namespace lumitexel
