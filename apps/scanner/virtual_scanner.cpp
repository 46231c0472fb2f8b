#include "scanner/virtual_scanner.h"

#include <pcl/conversions.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <new>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/constants.h"
#include "core/base/parallel.h"

#if PCL_SYMMETRY_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace pcl_symmetry::apps {

namespace {

/// Difference of a distance in single and in double precision, diagonals of the mesh, above which the triangle is seen
/// edge on, so that the exact distance is no better.
constexpr double kCoarseError = 1e-3;
constexpr int kFirstResolution = 128;         // edge of the first image, which gives the share of hits, pixels
constexpr double kAcceptedCountError = 0.01;  // relative error of the number of points
constexpr int kMaxRounds = 8;                 // greatest number of images until the number of points has to fit

/// Uniform in [0, 1), the same on every platform, unlike the distributions of the standard library.
/// \param generator gives 64 random bits.
template <typename Generator>
double uniform(Generator& generator) {
  return static_cast<double>(generator() >> 11) * 0x1.0p-53;
}

/// Standard normal by Box and Muller, the same wherever the elementary functions are.
template <typename Generator>
double standardNormal(Generator& generator) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(generator)));
  return radius * std::cos(2.0 * kPi * uniform(generator));
}

/// The directions right, down and forward: the columns of the sensor's rotation. The image's up is z, or y for a
/// vertical view.
Eigen::Matrix3d lookAlong(const Eigen::Vector3d& forward) {
  const Eigen::Vector3d up =
      std::abs(forward.z()) < 0.999 * forward.norm() ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
  Eigen::Matrix3d R_model_sensor;
  R_model_sensor.col(2) = forward.normalized();
  R_model_sensor.col(0) = forward.cross(up).normalized();
  R_model_sensor.col(1) = R_model_sensor.col(2).cross(R_model_sensor.col(0));
  return R_model_sensor;
}

struct Camera {
  Eigen::Vector3d origin;
  Eigen::Matrix3d axes;  ///< columns right, down, forward
  double half_width;     ///< half the width of the image at depth one
  int resolution;

  Eigen::Vector3d rayThrough(int column, int row) const {
    const double x = (2.0 * (column + 0.5) / resolution - 1.0) * half_width;
    const double y = (2.0 * (row + 0.5) / resolution - 1.0) * half_width;
    return (axes * Eigen::Vector3d(x, y, 1.0)).normalized();
  }
};

/// The distance along the ray of each pixel, row by row; infinite if the ray misses.
struct Picture {
  Camera camera;
  std::vector<double> distances;
  int num_hits = 0;

  Picture(const Camera& from, std::vector<double> all) : camera(from), distances(std::move(all)) {
    num_hits =
        static_cast<int>(std::count_if(distances.begin(), distances.end(), [](double d) { return std::isfinite(d); }));
  }

  bool touchesBorder() const {
    const int resolution = camera.resolution;
    for (int i = 0; i < resolution; ++i) {
      const std::size_t last = static_cast<std::size_t>(resolution) * (resolution - 1);
      const std::size_t row = static_cast<std::size_t>(resolution) * i;
      for (const std::size_t pixel : {std::size_t(i), last + i, row, row + resolution - 1}) {
        if (std::isfinite(distances[pixel])) return true;
      }
    }
    return false;
  }
};

}  // namespace

/// The triangles of a mesh in a frame of their own, centered and with unit diagonal. Single precision is enough to find
/// which triangle is hit; the position is computed in double precision.
struct VirtualScanner::Scene {
  struct Triangle {
    Eigen::Vector3d a, b, c;
  };

  Eigen::Vector3d center;     ///< center of the bounding box, input units
  double diagonal;            ///< diagonal of the bounding box, input units
  std::vector<Triangle> all;  ///< (corner - center) / diagonal, in the order of Embree's indices
  std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device{rtcNewDevice("threads=1"), &rtcReleaseDevice};
  std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> tree{nullptr, &rtcReleaseScene};

  explicit Scene(const pcl::PolygonMesh& mesh) {
    collectTriangles(mesh);
    buildTree();
  }

  void collectTriangles(const pcl::PolygonMesh& mesh) {
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
        all.push_back(triangle);
      }
    }
    if (all.empty()) throw std::invalid_argument("mesh has no faces to scan");
    center = box.center();
    diagonal = box.diagonal().norm();
    if (!(diagonal > 0)) throw std::invalid_argument("mesh has no extent, all its corners are equal");
    for (Triangle& triangle : all) {
      for (Eigen::Vector3d* point : {&triangle.a, &triangle.b, &triangle.c}) *point = (*point - center) / diagonal;
    }
  }

  /// Builds the tree by one thread, so that it is the same for any number of threads.
  void buildTree() {
    if (!device) throw std::runtime_error("Embree cannot start");
    tree.reset(rtcNewScene(device.get()));
    rtcSetSceneFlags(tree.get(), RTC_SCENE_FLAG_ROBUST);
    const std::unique_ptr<RTCGeometryTy, decltype(&rtcReleaseGeometry)> geometry{
        rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE), &rtcReleaseGeometry};
    auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * all.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0,
                                                                   RTC_FORMAT_UINT3, 3 * sizeof(unsigned), all.size()));
    if (!positions || !indices) throw std::bad_alloc();
    for (std::size_t i = 0; i < all.size(); ++i) {
      Eigen::Map<Eigen::Matrix3f>(positions + 9 * i) << all[i].a.cast<float>(), all[i].b.cast<float>(),
          all[i].c.cast<float>();
      for (unsigned k = 0; k < 3; ++k) indices[3 * i + k] = static_cast<unsigned>(3 * i + k);
    }
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(tree.get(), geometry.get());
    rtcCommitScene(tree.get());
    if (rtcGetDeviceError(device.get()) != RTC_ERROR_NONE) throw std::runtime_error("Embree cannot build its tree");
  }

  /// \param origin,direction a ray with unit direction, in the frame of the triangles.
  /// \return the distance to the first triangle along the ray, infinite if there is none.
  double distanceAlong(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    RTCRayHit query{};
    const Eigen::Vector3f o = origin.cast<float>(), d = direction.cast<float>();
    query.ray.org_x = o.x(), query.ray.org_y = o.y(), query.ray.org_z = o.z();
    query.ray.dir_x = d.x(), query.ray.dir_y = d.y(), query.ray.dir_z = d.z();
    query.ray.tfar = std::numeric_limits<float>::infinity();
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if PCL_SYMMETRY_EMBREE >= 4
    rtcIntersect1(tree.get(), &query);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(tree.get(), &context, &query);
#endif
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::numeric_limits<double>::infinity();
    const Triangle& triangle = all[query.hit.primID];
    const Eigen::Vector3d normal = (triangle.b - triangle.a).cross(triangle.c - triangle.a);
    const double distance = normal.dot(triangle.a - origin) / normal.dot(direction);
    const double coarse = query.ray.tfar;
    return std::abs(distance - coarse) < kCoarseError ? distance : coarse;
  }

  Picture takePicture(const Camera& camera, int num_threads) const {
    std::vector<double> distances(static_cast<std::size_t>(camera.resolution) * camera.resolution);
    parallelBlocks(camera.resolution, num_threads, [&](std::size_t row) {
      for (int column = 0; column < camera.resolution; ++column)
        distances[row * camera.resolution + column] =
            distanceAlong(camera.origin, camera.rayThrough(column, static_cast<int>(row)));
    });
    return {camera, std::move(distances)};
  }

  /// \return the image whose number of hits is closest to the wanted one, by the choice of its resolution
  Picture takePictureOfPoints(Camera camera, const VirtualScannerOptions& options) const {
    const auto error = [&](const Picture& picture) {
      return std::abs(double(picture.num_hits) / options.num_points - 1.0);
    };
    Picture picture = takePicture(camera, options.num_threads);
    Picture best = picture;
    for (int round = 0; round < kMaxRounds && error(best) > kAcceptedCountError; ++round) {
      const double wanted = camera.resolution * std::sqrt(double(options.num_points) / std::max(picture.num_hits, 1));
      const int previous = camera.resolution;
      camera.resolution = static_cast<int>(std::clamp(std::round(wanted), 1.0, double(options.max_resolution)));
      if (picture.num_hits == 0) camera.resolution = std::min(4 * previous, options.max_resolution);
      if (camera.resolution == previous) break;
      picture = takePicture(camera, options.num_threads);
      if (error(picture) < error(best)) best = picture;
    }
    return best;
  }
};

namespace {

/// The points of the pixels, with noise, in the frame of the scan.
pcl::PointCloud<pcl::PointXYZ>::Ptr cloudOf(const Picture& picture, const VirtualScannerOptions& options,
                                            const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& to_scan) {
  const Camera& camera = picture.camera;
  std::seed_seq streams{options.seed, options.seed >> 32, options.noise_stream};
  std::mt19937_64 generator(streams);
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>(camera.resolution, camera.resolution));
  for (int row = 0; row < camera.resolution; ++row) {
    for (int column = 0; column < camera.resolution; ++column) {
      double distance = picture.distances[static_cast<std::size_t>(row) * camera.resolution + column];
      pcl::PointXYZ& point = cloud->at(column, row);
      if (!std::isfinite(distance)) {
        point.x = point.y = point.z = std::numeric_limits<float>::quiet_NaN();
        continue;
      }
      if (options.noise > 0) distance += options.noise * standardNormal(generator);
      point.getVector3fMap() = to_scan(camera.origin + distance * camera.rayThrough(column, row)).cast<float>();
    }
  }
  cloud->is_dense = picture.num_hits == camera.resolution * camera.resolution;
  return cloud;
}

/// A rotation drawn uniformly and a translation drawn from the cube [-extent, extent]^3: Shoemake, Uniform random
/// rotations, Graphics Gems III.
Eigen::Isometry3d randomPose(std::uint64_t seed, double extent) {
  std::mt19937_64 generator(seed);
  const double u = uniform(generator), v = 2 * kPi * uniform(generator), w = 2 * kPi * uniform(generator);
  const Eigen::Quaterniond rotation(std::sqrt(u) * std::cos(w), std::sqrt(1 - u) * std::sin(v),
                                    std::sqrt(1 - u) * std::cos(v), std::sqrt(u) * std::sin(w));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation.normalized().toRotationMatrix();
  for (int k = 0; k < 3; ++k) pose.translation()[k] = extent * (2 * uniform(generator) - 1);
  return pose;
}

}  // namespace

VirtualScanner::VirtualScanner(const pcl::PolygonMesh& mesh) : scene_(std::make_unique<Scene>(mesh)) {}

VirtualScanner::~VirtualScanner() = default;

double VirtualScanner::diagonal() const {
  return scene_->diagonal;
}

VirtualScan VirtualScanner::scan(const Eigen::Vector3d& direction, const VirtualScannerOptions& options) const {
  const Eigen::Vector3d towards_scanner = direction.normalized();
  const auto pictureOf = [&](double tangent) {
    return scene_->takePictureOfPoints({options.distance * towards_scanner, lookAlong(-towards_scanner), tangent,
                                        std::min(kFirstResolution, options.max_resolution)},
                                       options);
  };
  Picture picture = pictureOf(std::tan(options.field_of_view.value_or(0.4) / 2));
  // The ball around the bounding box, whose radius is half a diagonal, and a border.
  if (!options.field_of_view && picture.touchesBorder())
    picture = pictureOf(1.05 * 0.5 / std::sqrt(options.distance * options.distance - 0.25));
  if (picture.num_hits == 0) throw std::runtime_error("no ray hits the model");
  VirtualScan result;
  result.num_points = picture.num_hits;
  result.cropped = picture.touchesBorder();
  if (options.random_pose) {
    result.T_scan_model = randomPose(options.seed, scene_->diagonal);
    result.T_scan_model.translation() -= result.T_scan_model.linear() * scene_->center;
  }
  const auto to_scan = [&](const Eigen::Vector3d& point) -> Eigen::Vector3d {
    return result.T_scan_model * (scene_->center + scene_->diagonal * point);
  };
  result.T_scan_sensor.linear() = result.T_scan_model.linear() * picture.camera.axes;
  result.T_scan_sensor.translation() = to_scan(picture.camera.origin);
  result.cloud = cloudOf(picture, options, to_scan);
  result.cloud->sensor_origin_.head<3>() = result.T_scan_sensor.translation().cast<float>();
  result.cloud->sensor_origin_[3] = 0.0f;
  result.cloud->sensor_orientation_ = Eigen::Quaterniond(result.T_scan_sensor.linear()).normalized().cast<float>();
  return result;
}

std::array<Eigen::Vector3d, 8> cubeCorners() {
  std::array<Eigen::Vector3d, 8> corners;
  for (int i = 0; i < 8; ++i) {
    corners[i] = Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1).normalized();
  }
  return corners;
}

}  // namespace pcl_symmetry::apps
