/// A virtual range scanner: a mesh seen from one side, or from the eight corners of a cube, in organized clouds like
/// those of a depth camera (Section 5.1, Figure 11).
#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <boost/filesystem/path.hpp>
#include <cmath>
#include <random>

#include "core/base/constants.h"
#include "io/answers.h"
#include "io/input_shape.h"
#include "io/shape_output.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

#if PCL_SYMMETRY_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

/// Difference of a distance in single and in double precision, diagonals of the mesh, above which the triangle is seen
/// edge on, so that the exact distance is no better.
constexpr double kCoarseError = 1e-3;
constexpr int kFirstResolution = 128;         // edge of the first image, which gives the share of hits, pixels
constexpr int kMaxResolution = 8192;          // greatest edge of the image, pixels; thin shapes then give fewer points
constexpr double kAcceptedCountError = 0.01;  // relative error of the number of points
constexpr int kMaxRounds = 8;                 // greatest number of images until the number of points has to fit

struct ScanOptions {
  std::string input, output;
  std::optional<Eigen::Vector3d> direction;
  std::optional<int> corner;
  bool all = false;
  int num_points = 10000;
  std::optional<double> field_of_view;  ///< full angle of the square image, degrees; not set: wide enough
  double distance = 2.0;                ///< distance from the center of the bounding box, diagonals of the box
  double noise = 0.0;                   ///< standard deviation of the depth along the ray, diagonals of the box
  bool random_pose = false;             ///< rotates and moves scanner and model together
  std::string format = "binary_compressed";
  CommonOptions common;
};

struct VirtualScan {
  /// One point per pixel, row by row, NaN if the ray misses, in the scan's frame; sensor_origin_ and
  /// sensor_orientation_ hold the pose of the scanner (z forward, x right, y down).
  Cloud::Ptr cloud;
  Eigen::Isometry3d T_scan_model = Eigen::Isometry3d::Identity();  ///< the identity without a random pose
  Eigen::Isometry3d T_scan_sensor = Eigen::Isometry3d::Identity();
  int num_points = 0;    ///< number of hits
  bool cropped = false;  ///< whether the model extends beyond the image
};

/// Uniform in [0, 1), the same on every platform, unlike the distributions of the standard library.
double uniform(std::mt19937_64& generator) {
  return static_cast<double>(generator() >> 11) * 0x1.0p-53;
}

/// Standard normal by Box and Muller, the same wherever the elementary functions are.
double standardNormal(std::mt19937_64& generator) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(generator)));
  return radius * std::cos(2.0 * kPi * uniform(generator));
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

struct Picture {
  Camera camera;
  Eigen::ArrayXXd distances;  ///< distance along the ray of pixel (column, row); infinite if the ray misses

  int numHits() const { return static_cast<int>(distances.isFinite().count()); }
  bool touchesBorder() const {
    return distances.topRows(1).isFinite().any() || distances.bottomRows(1).isFinite().any() ||
           distances.leftCols(1).isFinite().any() || distances.rightCols(1).isFinite().any();
  }
};

/// The triangles of a mesh in a frame of their own, centered and with unit diagonal. Single precision is enough to find
/// which triangle is hit; the position is computed in double precision.
class VirtualScanner {
public:
  /// \throws std::invalid_argument if no triangle with finite corners has an extent.
  explicit VirtualScanner(const pcl::PolygonMesh& mesh) {
    const detail::MeshArrays arrays = detail::toArrays(mesh);
    const auto corner = [&](int i) -> Eigen::Vector3d { return arrays.vertices.col(i).cast<double>(); };
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3i& corners : arrays.triangles) {
      const Triangle triangle{corner(corners[0]), corner(corners[1]), corner(corners[2])};
      if (!triangle.a.allFinite() || !triangle.b.allFinite() || !triangle.c.allFinite()) continue;
      box.extend(triangle.a).extend(triangle.b).extend(triangle.c);
      triangles_.push_back(triangle);
    }
    if (triangles_.empty()) throw std::invalid_argument("mesh has no faces to scan");
    center_ = box.center();
    diagonal_ = box.diagonal().norm();
    if (!(diagonal_ > 0)) throw std::invalid_argument("mesh has no extent, all its corners are equal");
    for (Triangle& triangle : triangles_)
      for (Eigen::Vector3d* point : {&triangle.a, &triangle.b, &triangle.c}) *point = (*point - center_) / diagonal_;
    buildTree();
  }

  /// \param direction direction from the center toward the scanner, in the model's frame; any length but zero. With
  /// a random pose, scanner and model are rotated and moved together, so that the view stays the same.
  /// \param noise_stream different numbers give scans of one pose different noise.
  /// \throws std::runtime_error if no ray hits.
  VirtualScan scan(const Eigen::Vector3d& direction, std::uint64_t noise_stream, const ScanOptions& options) const {
    const Eigen::Vector3d towards_scanner = direction.normalized();
    const auto pictureOf = [&](double tangent) {
      return takePictureOfPoints(
          {options.distance * towards_scanner, lookAlong(-towards_scanner), tangent, kFirstResolution}, options);
    };
    Picture picture = pictureOf(std::tan((options.field_of_view ? *options.field_of_view * kDegree : 0.4) / 2));
    // The ball around the bounding box, whose radius is half a diagonal, and a border.
    if (!options.field_of_view && picture.touchesBorder())
      picture = pictureOf(1.05 * 0.5 / std::sqrt(options.distance * options.distance - 0.25));
    VirtualScan result;
    result.num_points = picture.numHits();
    if (result.num_points == 0) throw std::runtime_error("no ray hits the model");
    result.cropped = picture.touchesBorder();
    if (options.random_pose) {
      result.T_scan_model = randomPose(options.common.seed, diagonal_);
      result.T_scan_model.translation() -= result.T_scan_model.linear() * center_;
    }
    const auto to_scan = [&](const Eigen::Vector3d& point) -> Eigen::Vector3d {
      return result.T_scan_model * (center_ + diagonal_ * point);
    };
    const Camera& camera = picture.camera;
    result.T_scan_sensor.linear() = result.T_scan_model.linear() * camera.axes;
    result.T_scan_sensor.translation() = to_scan(camera.origin);
    std::seed_seq streams{options.common.seed, options.common.seed >> 32, noise_stream};
    std::mt19937_64 generator(streams);
    result.cloud = pcl::make_shared<Cloud>(camera.resolution, camera.resolution);
    for (int row = 0; row < camera.resolution; ++row) {
      for (int column = 0; column < camera.resolution; ++column) {
        double distance = picture.distances(column, row);
        const bool is_hit = std::isfinite(distance);
        if (is_hit && options.noise > 0) distance += options.noise * standardNormal(generator);
        result.cloud->at(column, row).getVector3fMap() =
            is_hit ? to_scan(camera.origin + distance * camera.rayThrough(column, row)).cast<float>().eval()
                   : Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()).eval();
      }
    }
    result.cloud->is_dense = result.num_points == camera.resolution * camera.resolution;
    result.cloud->sensor_origin_ << result.T_scan_sensor.translation().cast<float>(), 0.0f;
    result.cloud->sensor_orientation_ = Eigen::Quaterniond(result.T_scan_sensor.linear()).normalized().cast<float>();
    return result;
  }

private:
  struct Triangle {
    Eigen::Vector3d a, b, c;
  };

  /// Builds the tree by one thread, so that it is the same for any number of threads.
  void buildTree() {
    if (!device_) throw std::runtime_error("Embree cannot start");
    tree_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(tree_.get(), RTC_SCENE_FLAG_ROBUST);
    const std::unique_ptr<RTCGeometryTy, decltype(&rtcReleaseGeometry)> geometry{
        rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE), &rtcReleaseGeometry};
    auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * triangles_.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), triangles_.size()));
    if (!positions || !indices) throw std::bad_alloc();
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      Eigen::Map<Eigen::Matrix3f>(positions + 9 * i) << triangles_[i].a.cast<float>(), triangles_[i].b.cast<float>(),
          triangles_[i].c.cast<float>();
      for (unsigned k = 0; k < 3; ++k) indices[3 * i + k] = static_cast<unsigned>(3 * i + k);
    }
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(tree_.get(), geometry.get());
    rtcCommitScene(tree_.get());
    if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE) throw std::runtime_error("Embree cannot build its tree");
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
    rtcIntersect1(tree_.get(), &query);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(tree_.get(), &context, &query);
#endif
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::numeric_limits<double>::infinity();
    const Triangle& triangle = triangles_[query.hit.primID];
    const Eigen::Vector3d normal = (triangle.b - triangle.a).cross(triangle.c - triangle.a);
    const double distance = normal.dot(triangle.a - origin) / normal.dot(direction);
    const double coarse = query.ray.tfar;
    return std::abs(distance - coarse) < kCoarseError ? distance : coarse;
  }

  Picture takePicture(const Camera& camera, int num_threads) const {
    Picture picture{camera, Eigen::ArrayXXd(camera.resolution, camera.resolution)};
    parallelBlocks(camera.resolution, num_threads, [&](std::size_t row) {
      for (int column = 0; column < camera.resolution; ++column)
        picture.distances(column, row) = distanceAlong(camera.origin, camera.rayThrough(column, static_cast<int>(row)));
    });
    return picture;
  }

  /// \return the image whose number of hits is closest to the wanted one, by the choice of its resolution
  Picture takePictureOfPoints(Camera camera, const ScanOptions& options) const {
    const auto error = [&](int num_hits) { return std::abs(double(num_hits) / options.num_points - 1.0); };
    Picture best = takePicture(camera, options.common.threads);
    int num_hits = best.numHits(), most_fitting = num_hits;
    for (int round = 0; round < kMaxRounds && error(most_fitting) > kAcceptedCountError; ++round) {
      const double wanted = camera.resolution * std::sqrt(double(options.num_points) / std::max(num_hits, 1));
      const int previous = camera.resolution;
      camera.resolution = static_cast<int>(std::clamp(std::round(wanted), 1.0, double(kMaxResolution)));
      if (num_hits == 0) camera.resolution = std::min(4 * previous, kMaxResolution);
      if (camera.resolution == previous) break;
      Picture picture = takePicture(camera, options.common.threads);
      num_hits = picture.numHits();
      if (error(num_hits) >= error(most_fitting)) continue;
      best = std::move(picture);
      most_fitting = num_hits;
    }
    return best;
  }

  Eigen::Vector3d center_;           ///< center of the bounding box, input units
  double diagonal_;                  ///< diagonal of the bounding box, input units
  std::vector<Triangle> triangles_;  ///< (corner - center) / diagonal, in the order of Embree's indices
  std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device_{rtcNewDevice("threads=1"), &rtcReleaseDevice};
  std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> tree_{nullptr, &rtcReleaseScene};
};

CommandLine commandLine(ScanOptions& options) {
  CommandLine line("pcl_symmetry_scan",
                   "Scans a mesh from one side, as a range scanner would, into an organized cloud.",
                   "pcl_symmetry_scan bull.off bull.pcd -direction 1,-1,0.5 -noise 0.001");
  line.positional("mesh", options.input, ".off, .obj, .stl or .ply with faces")
      .positional("output", options.output, ".pcd or .ply; with -all eight files, NAME_0.pcd to NAME_7.pcd")
      .direction("direction", options.direction, "from the object's center toward the scanner (1,1,1)")
      .number("corner", options.corner, Range::closed(0, 7),
              "corner of a cube around the object; bit 0, 1, 2 set: positive x, y, z")
      .flag("all", options.all, "scan from all eight corners")
      .number("points", options.num_points, Range::closed(1, 20000000), "wanted number of points")
      .number("fov", options.field_of_view, Range::open(0, 180),
              "field of view, degrees (22.9183, or more where the mesh needs it)")
      .number("distance", options.distance, Range::above(0.5), "from the center, in bounding-box diagonals")
      .number("noise", options.noise, Range::closed(0, 1), "deviation of the depth, in diagonals")
      .flag("random_pose", options.random_pose, "turn and move the model at random first")
      .choice("format", options.format, {"ascii", "binary", "binary_compressed"}, "encoding of PCD files")
      .common(options.common, kSeed | kThreads | kJson | kQuiet);
  return line;
}

struct View {
  Eigen::Vector3d direction;
  std::string path;
};

/// Corner \p i of a cube around the object: bit k is set where coordinate k is positive.
Eigen::Vector3d cubeCorner(int i) {
  return Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1).normalized();
}

std::vector<View> viewsOf(const ScanOptions& options) {
  if (options.direction) return {{*options.direction, options.output}};
  if (!options.all) return {{cubeCorner(options.corner.value_or(7)), options.output}};
  std::vector<View> views;
  const boost::filesystem::path path(options.output);
  for (int i = 0; i < 8; ++i) {
    const std::string name = path.stem().string() + "_" + std::to_string(i) + path.extension().string();
    views.push_back({cubeCorner(i), (path.parent_path() / name).string()});
  }
  return views;
}

PCDEncoding encodingOf(const std::string& format) {
  if (format == "ascii") return PCDEncoding::Ascii;
  return format == "binary" ? PCDEncoding::Binary : PCDEncoding::BinaryCompressed;
}

nlohmann::json describe(const VirtualScan& scan, const std::string& path, const Eigen::Vector3d& mesh_shift,
                        const Eigen::Vector3d& scan_shift) {
  const Eigen::Isometry3d sensor_pose = shiftedBack(scan.T_scan_sensor, Eigen::Vector3d::Zero(), scan_shift);
  return {{"file", path},
          {"num_points", scan.num_points},
          {"width", scan.cloud->width},
          {"height", scan.cloud->height},
          {"viewpoint", numbersOf(sensor_pose.translation())},
          {"transform", rowMajor(shiftedBack(scan.T_scan_model, mesh_shift, scan_shift))},
          {"sensor_pose", rowMajor(sensor_pose)},
          {"cropped", scan.cropped}};
}

void save(const VirtualScan& scan, const std::string& path, const Eigen::Vector3d& shift, PCDEncoding encoding) {
  Eigen::Vector4f origin = scan.cloud->sensor_origin_;
  if (!shift.isZero(0.0)) origin.head<3>() = (scan.T_scan_sensor.translation() + shift).cast<float>();
  saveCloud(path, toFields(*scan.cloud, shift), origin, scan.cloud->sensor_orientation_, encoding);
}

int run(int argc, char** argv) {
  ScanOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  if (int(options.direction.has_value()) + int(options.corner.has_value()) + int(options.all) > 1)
    throw UsageError("only one of -direction, -corner and -all may be given");
  checkCloudExtension(options.output);
  line.goWith("an output of PCD", !boost::algorithm::iends_with(options.output, ".ply"), {"format"});
  line.goWith("-noise or -random_pose", options.noise > 0.0 || options.random_pose, {"seed"});
  const std::vector<View> views = viewsOf(options);
  for (const View& view : views) checkTarget(view.path);
  isStandardOutputFree({options.output, options.common.json_path});
  const Console console(options.common.quiet);

  Step loading(console, "Loading " + options.input);
  const Shape shape = loadShape(options.input);
  if (!shape.mesh) throw InputError(options.input + ": has no faces, the scanner needs a mesh");
  const double loading_ms = loading.done(counted(shape.mesh->polygons.size(), "face"));
  warnOfLeftOut(console, options.input, shape);

  double scanning_ms = 0.0;
  std::vector<VirtualScan> scans;
  namingFile(options.input, [&] {
    Step scanning(console, "Scanning from " + std::string(views.size() > 1 ? "eight corners" : "one side"));
    const VirtualScanner scanner(*shape.mesh);
    int num_points = 0;
    for (const View& view : views) {
      scans.push_back(scanner.scan(view.direction, scans.size(), options));
      num_points += scans.back().num_points;
      scanning.progress(double(scans.size()) / double(views.size()));
    }
    scanning_ms = scanning.done(counted(num_points, "point"));
  });
  if (std::any_of(scans.begin(), scans.end(), [](const VirtualScan& scan) { return scan.cropped; }))
    console.warn(options.input + ": reaches beyond the picture; a larger -fov or -distance shows all of it");

  nlohmann::json report;
  // A scan without a random pose is at the position of its mesh, shifted; one with a random pose is near the origin.
  const Eigen::Vector3d shift = options.random_pose ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : shape.shift;
  Step saving(console, "Saving " + (options.all ? std::to_string(views.size()) + " files" : options.output));
  for (std::size_t i = 0; i < views.size(); ++i) {
    save(scans[i], views[i].path, shift, encodingOf(options.format));
    report["scans"].push_back(describe(scans[i], views[i].path, shape.shift, shift));
  }
  const double saving_ms = saving.done();
  report["timing_ms"] = {{"load", loading_ms}, {"scan", scanning_ms}, {"save", saving_ms}};
  writeJson(options.common, report);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
