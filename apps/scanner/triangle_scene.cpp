#include "scanner/triangle_scene.h"

#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>

namespace pcl_symmetry::apps {

namespace {

/// Distances from single and double precision that differ by more are those of a triangle seen edge on, where the exact
/// one is no better; diagonals of the mesh. chosen: half and twice give the same scans.
constexpr double kCoarseError = 1e-3;

}  // namespace

TriangleScene::TriangleScene(const pcl::PolygonMesh& mesh) {
  collectTriangles(mesh);
  try {
    buildTree();
  } catch (...) {
    release();
    throw;
  }
}

TriangleScene::~TriangleScene() {
  release();
}

void TriangleScene::release() {
  if (scene_) rtcReleaseScene(scene_);
  if (device_) rtcReleaseDevice(device_);
}

void TriangleScene::collectTriangles(const pcl::PolygonMesh& mesh) {
  pcl::PointCloud<pcl::PointXYZ> vertices;
  pcl::fromPCLPointCloud2(mesh.cloud, vertices);
  const auto corner = [&](pcl::index_t index) -> Eigen::Vector3d {
    return vertices.at(static_cast<std::size_t>(index)).getVector3fMap().cast<double>();
  };
  Eigen::AlignedBox3d box;
  for (const pcl::Vertices& polygon : mesh.polygons) {
    for (std::size_t k = 2; k < polygon.vertices.size(); ++k) {
      const Triangle triangle{corner(polygon.vertices[0]), corner(polygon.vertices[k - 1]),
                              corner(polygon.vertices[k])};
      if (!triangle.a.allFinite() || !triangle.b.allFinite() || !triangle.c.allFinite()) continue;
      box.extend(triangle.a).extend(triangle.b).extend(triangle.c);
      triangles_.push_back(triangle);
    }
  }
  if (triangles_.empty()) throw std::invalid_argument("mesh has no faces to scan");
  center_ = box.center();
  diagonal_ = box.diagonal().norm();
  if (!(diagonal_ > 0)) throw std::invalid_argument("mesh has no extent, all its corners are equal");
  for (Triangle& triangle : triangles_) {
    for (Eigen::Vector3d* point : {&triangle.a, &triangle.b, &triangle.c}) *point = (*point - center_) / diagonal_;
  }
}

/// One thread builds the tree, so that it is the same tree for any number of threads.
void TriangleScene::buildTree() {
  device_ = rtcNewDevice("threads=1");
  if (!device_) throw std::runtime_error("Embree cannot start");
  scene_ = rtcNewScene(device_);
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                3 * sizeof(float), 3 * triangles_.size()));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(unsigned), triangles_.size()));
  if (!positions || !indices) {
    rtcReleaseGeometry(geometry);
    throw std::bad_alloc();
  }
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    Eigen::Map<Eigen::Matrix3f>(positions + 9 * i) << triangles_[i].a.cast<float>(), triangles_[i].b.cast<float>(),
        triangles_[i].c.cast<float>();
    for (unsigned k = 0; k < 3; ++k) indices[3 * i + k] = static_cast<unsigned>(3 * i + k);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
  if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw std::runtime_error("Embree cannot build its tree");
}

double distanceAlong(const TriangleScene& scene, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  RTCRayHit query{};
  const Eigen::Vector3f o = origin.cast<float>(), d = direction.cast<float>();
  query.ray.org_x = o.x(), query.ray.org_y = o.y(), query.ray.org_z = o.z();
  query.ray.dir_x = d.x(), query.ray.dir_y = d.y(), query.ray.dir_z = d.z();
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = ~0u;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  intersect(scene.embree(), query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::numeric_limits<double>::infinity();
  const Triangle& triangle = scene.triangles()[query.hit.primID];
  const Eigen::Vector3d normal = (triangle.b - triangle.a).cross(triangle.c - triangle.a);
  const double distance = normal.dot(triangle.a - origin) / normal.dot(direction);
  const double coarse = query.ray.tfar;
  return std::abs(distance - coarse) < kCoarseError ? distance : coarse;
}

}  // namespace pcl_symmetry::apps
