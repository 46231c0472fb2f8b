/// The triangles of a mesh, in the form that rays and distances are computed against.
#pragma once

#include <pcl/PolygonMesh.h>

#include <Eigen/Core>
#include <vector>

#if PCL_SYMMETRY_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace pcl_symmetry::apps {

/// Finds the first triangle along a ray: Embree 3 takes a context for that, Embree 4 does not.
inline void intersect(RTCScene scene, RTCRayHit& query) {
#if PCL_SYMMETRY_EMBREE >= 4
  rtcIntersect1(scene, &query);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &query);
#endif
}

struct Triangle {
  Eigen::Vector3d a, b, c;
};

/// Triangles in a frame of their own, centred and with unit diagonal, where single precision is enough to find which
/// one is hit or closest; where exactly can be computed in double precision.
class TriangleScene {
public:
  /// Polygons are cut into fans; triangles with non-finite corners are left out.
  /// \throws std::invalid_argument if no triangle is left, or all corners are equal.
  explicit TriangleScene(const pcl::PolygonMesh& mesh);
  ~TriangleScene();
  TriangleScene(const TriangleScene&) = delete;
  TriangleScene& operator=(const TriangleScene&) = delete;

  /// Centre and diagonal of the bounding box of the triangles, input units.
  const Eigen::Vector3d& center() const { return center_; }
  double diagonal() const { return diagonal_; }

  /// (corner - center) / diagonal; the index is the primitive's in embree().
  const std::vector<Triangle>& triangles() const { return triangles_; }
  RTCScene embree() const { return scene_; }

private:
  void collectTriangles(const pcl::PolygonMesh& mesh);
  void buildTree();
  void release();

  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  double diagonal_ = 0;
  std::vector<Triangle> triangles_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

/// \param origin,direction of a unit ray, in the frame of TriangleScene::triangles().
/// \return the distance to the first triangle along the ray, infinite if there is none.
double distanceAlong(const TriangleScene& scene, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

}  // namespace pcl_symmetry::apps
