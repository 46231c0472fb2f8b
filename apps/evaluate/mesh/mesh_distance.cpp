#include "evaluate/mesh/mesh_distance.h"

#include <Eigen/Geometry>
#include <cmath>

namespace pcl_symmetry::apps {

namespace {

/// What one query looks for and has found so far.
struct Query {
  const TriangleScene& scene;
  Eigen::Vector3d x;
  double distance;  ///< of the closest point so far
  double enough;    ///< stop at a point as close as this
  long triangle = -1;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
};

/// Embree calls this for every triangle whose box the sphere of the query touches.
bool visitTriangle(RTCPointQueryFunctionArguments* arguments) {
  auto& query = *static_cast<Query*>(arguments->userPtr);
  const Eigen::Vector3d point = closestPoint(query.scene.triangles()[arguments->primID], query.x);
  const double distance = (point - query.x).norm();
  if (!(distance <= query.distance)) return false;
  query.distance = distance;
  query.triangle = arguments->primID;
  query.point = point;
  // A little more than the distance: Embree's boxes are in single precision.
  arguments->query->radius = distance <= query.enough ? 0.0f : static_cast<float>(distance) * 1.00001f + 1e-6f;
  return true;
}

Query search(const TriangleScene& scene, const Eigen::Vector3d& x, double max_distance, double enough) {
  Query query{scene, x, max_distance, enough};
  RTCPointQuery sphere;
  sphere.x = static_cast<float>(x.x());
  sphere.y = static_cast<float>(x.y());
  sphere.z = static_cast<float>(x.z());
  sphere.time = 0.0f;
  sphere.radius = static_cast<float>(max_distance) * 1.00001f + 1e-6f;
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene.embree(), &sphere, &context, visitTriangle, &query);
  return query;
}

}  // namespace

std::optional<ClosestOnMesh> MeshDistance::closest(const Eigen::Vector3d& x, double max_distance) const {
  const Query found = search(scene_, x, max_distance, -1.0);
  if (found.triangle < 0) return std::nullopt;
  const Triangle& t = scene_.triangles()[found.triangle];
  return ClosestOnMesh{found.point, (t.b - t.a).cross(t.c - t.a).normalized(), found.distance};
}

bool MeshDistance::within(const Eigen::Vector3d& x, double distance) const {
  return search(scene_, x, distance, distance).triangle >= 0;
}

Eigen::Vector3d closestPoint(const Triangle& triangle, const Eigen::Vector3d& x) {
  const auto& [a, b, c] = triangle;
  const Eigen::Vector3d ab = b - a, ac = c - a, ax = x - a, bx = x - b, cx = x - c;
  const double d1 = ab.dot(ax), d2 = ac.dot(ax);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const double d3 = ab.dot(bx), d4 = ac.dot(bx);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + d1 / (d1 - d3) * ab;
  const double d5 = ab.dot(cx), d6 = ac.dot(cx);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  return a + (vb * ab + vc * ac) / (va + vb + vc);
}

}  // namespace pcl_symmetry::apps
