#include "evaluate/planes/visible_surface.h"

#include <algorithm>
#include <cmath>

#include "evaluate/references/plane_families.h"

namespace pcl_symmetry::apps {

namespace {

/// Share of the visible surface; chosen: what a symmetry may leave without counterpart, 1 - min_share of references.
constexpr double kMostContradicted = 0.03;
constexpr int kNumFamilyPlanes = 12;  // through an axis or a center; chosen: half misses a handle, twice the time
constexpr int kNumSamples = 2500;     // of the whole mesh; chosen: half doubles the variance, twice the time
/// Diagonals by which a point lies behind the surface that it is on. derived: rounding of single precision in the rays.
constexpr double kSlack = 1e-4;

}  // namespace

VisibleSurface::VisibleSurface(const TriangleScene& scene, const MeshReflection& reflection, const TestCloud& scan,
                               double tolerance)
    : scene_(scene),
      distance_(scene),
      T_cloud_model_(scan.T_cloud_model),
      T_sensor_cloud_(scan.view->T_cloud_sensor.inverse()),
      half_width_(scan.view->half_width),
      tolerance_(tolerance) {
  const Eigen::Vector3d sensor = scan.view->T_cloud_sensor.translation();
  origin_ = (T_cloud_model_.inverse() * sensor - scene.center()) / scene.diagonal();
  const Points& samples = reflection.samples();
  const Eigen::Index stride = std::max<Eigen::Index>(1, samples.cols() / kNumSamples);
  for (Eigen::Index i = 0; i < samples.cols(); i += stride) {
    const Eigen::Vector3d x = samples.col(i).cast<double>();
    if (inPicture(x) && isInSight(x)) visible_.push_back(x);
  }
}

bool VisibleSurface::inPicture(const Eigen::Vector3d& x) const {
  const Eigen::Vector3d in_sensor =
      T_sensor_cloud_ * (T_cloud_model_ * Eigen::Vector3d(scene_.center() + scene_.diagonal() * x));
  return in_sensor.z() > 0.0 && in_sensor.head<2>().cwiseAbs().maxCoeff() <= half_width_ * in_sensor.z();
}

bool VisibleSurface::isInSight(const Eigen::Vector3d& x) const {
  const Eigen::Vector3d ray = x - origin_;
  const Eigen::Vector3f o = origin_.cast<float>(), d = ray.normalized().cast<float>();
  RTCRayHit query{};
  query.ray.org_x = o.x(), query.ray.org_y = o.y(), query.ray.org_z = o.z();
  query.ray.dir_x = d.x(), query.ray.dir_y = d.y(), query.ray.dir_z = d.z();
  query.ray.tfar = static_cast<float>(ray.norm() - kSlack);
  query.ray.mask = ~0u;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  intersect(scene_.embree(), query);
  return query.hit.geomID == RTC_INVALID_GEOMETRY_ID;
}

double VisibleSurface::contradictedShare(const ReflectionPlane& plane) const {
  if (visible_.empty()) return 0.0;
  const ReflectionPlane in_model = plane.transformed(T_cloud_model_.inverse());
  const ReflectionPlane in_scene(in_model.normal(),
                                 (in_model.offset() - in_model.normal().dot(scene_.center())) / scene_.diagonal());
  const auto num_contradicted = std::count_if(visible_.begin(), visible_.end(), [&](const Eigen::Vector3d& x) {
    const Eigen::Vector3d reflected = in_scene.reflect(x);
    return inPicture(reflected) && isInSight(reflected) && !distance_.within(reflected, tolerance_);
  });
  return static_cast<double>(num_contradicted) / static_cast<double>(visible_.size());
}

ViewVerdict VisibleSurface::verdictOf(const Answer& answer) const {
  std::vector<ReflectionPlane> planes = {answer.plane};
  if (answer.type == Answer::Type::Axis) planes = planesThrough(answer.axis, kNumFamilyPlanes);
  if (answer.type == Answer::Type::Center) planes = planesThrough(answer.point, kNumFamilyPlanes);
  const bool contradicted = std::any_of(planes.begin(), planes.end(), [&](const ReflectionPlane& plane) {
    return contradictedShare(plane) > kMostContradicted;
  });
  return contradicted ? ViewVerdict::Contradicted : ViewVerdict::Undecidable;
}

}  // namespace pcl_symmetry::apps
