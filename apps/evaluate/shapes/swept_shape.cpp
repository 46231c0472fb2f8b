#include "evaluate/shapes/swept_shape.h"

#include <pcl/conversions.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/scanner/random_numbers.h"
#include "common/scanner/triangle_scene.h"
#include "common/scanner/virtual_scanner.h"
#include "core/base/constants.h"
#include "core/neighbours/diameter.h"
#include "drawing/parametric_mesh.h"
#include "evaluate/mesh/mesh_reflection.h"
#include "pcl_symmetry/mesh_sampling.h"

namespace pcl_symmetry::apps {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Profile = std::vector<Vector2d>;

constexpr int kCurveSteps = 192;  // vertices; chosen: a circle of 192 is round to 0.01 % of its diameter
// Share of the area, diameters. derived: the library's definition of a symmetry and of a nearly symmetric shape.
constexpr double kSymmetricShare = 0.97, kNearShare = 0.90, kTolerance = 0.01;
constexpr int kReflectedSamples = 4000;  // chosen: the standard error of a share of 0.97 is 0.3 %
// Heights of bodies in radii of their curves. chosen: from flat to slender; thinner bodies are sheets or lines.
constexpr double kLeastHeight = 0.5, kMostHeight = 2.5;
// Share that sizes have to differ by where equal ones have more symmetries (cubes, regular tetrahedra). chosen: three
// times what a plane of 97 % allows.
constexpr double kUnlike = 0.15;
constexpr int kFewestFolds = 2, kMostFoldsOfShape = 24;  // derived: the range that is asked for
// Least density of a thinned cloud, of that of its densest part. chosen: that of a scan at a slant of 75 degrees.
constexpr double kThinnest = 0.25;

double between(RandomStream& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

/// Turns the corners of one fold about the axis.
Profile repeated(int num_folds, const Profile& fold) {
  Profile curve;
  for (int k = 0; k < num_folds; ++k)
    for (const Vector2d& polar : fold) {
      const double angle = 2.0 * kPi * (k + polar.y()) / num_folds;
      curve.emplace_back(polar.x() * std::cos(angle), polar.x() * std::sin(angle));
    }
  return curve;
}

/// The corners of the curve, at a distance of one at most from each other in steps of the curve.
Profile rectangle(double aspect) {
  const double length = std::hypot(1.0, aspect);
  return {Vector2d(1, aspect) / length, Vector2d(-1, aspect) / length, Vector2d(-1, -aspect) / length,
          Vector2d(1, -aspect) / length};
}

pcl::PolygonMesh sweep(const Profile& curve, const Profile& profile) {
  ParametricMesh mesh;
  const auto count = static_cast<double>(curve.size());
  for (std::size_t i = 0; i + 1 < profile.size(); ++i)
    mesh.addSurface(1, static_cast<int>(curve.size()), [&](double u, double v) {
      const Vector2d p = (1.0 - u) * profile[i] + u * profile[i + 1];
      const Vector2d& c = curve[static_cast<std::size_t>(std::lround(v * count)) % curve.size()];
      return Vector3d(p.x() * c.x(), p.x() * c.y(), p.y());
    });
  return mesh.polygonMesh();
}

Points verticesOf(const pcl::PolygonMesh& mesh) {
  pcl::PointCloud<pcl::PointXYZ> vertices;
  pcl::fromPCLPointCloud2(mesh.cloud, vertices);
  Points points(3, static_cast<Eigen::Index>(vertices.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i) points.col(i) = vertices[i].getVector3fMap();
  return points;
}

ReflectionPlane planeAlong(double angle) {
  return ReflectionPlane(Vector3d(-std::sin(angle), std::cos(angle), 0.0), 0.0);
}

double shareOf(const pcl::PolygonMesh& mesh, const ReflectionPlane& plane) {
  const TriangleScene scene(mesh);
  const MeshReflection reflection(scene, kReflectedSamples, 1);
  const double offset = (plane.offset() - plane.normal().dot(scene.center())) / scene.diagonal();
  return reflection.share(ReflectionPlane(plane.normal(), offset),
                          kTolerance * diameter(verticesOf(mesh)) / scene.diagonal());
}

void measureBox(SweptShape& shape) {
  const Points points = verticesOf(shape.mesh);
  const Eigen::Vector3f low = points.rowwise().minCoeff(), high = points.rowwise().maxCoeff();
  shape.diagonal = (high - low).norm();
  shape.center = (0.5f * (low + high)).cast<double>();
}

/// Whether a body of a regular polygon with these sizes has symmetries beside those of its folds.
bool isSpecial(const std::string& body, int num_folds, double height, const Vector2d& corner) {
  const auto alike = [&](double length) { return std::abs(height / length - 1.0) < kUnlike; };
  const bool has_sides = num_folds == 2 || num_folds == 4;
  if (body == "cone" || body == "open cone") return num_folds == 3 && alike(std::sqrt(2.0));
  return has_sides && (alike(2.0 * corner.x()) || alike(2.0 * corner.y()) || alike(std::sqrt(2.0)));
}

Profile profileOf(const std::string& body, double height) {
  if (body == "prism") return {{0, 0}, {1, 0}, {1, height}, {0, height}};
  if (body == "tube") return {{1, 0}, {1, height}};
  if (body == "rim") return {{1, 0}, {1, height}, {0.75, height}, {0.75, 0}, {1, 0}};
  if (body == "cone") return {{0, 0}, {1, 0}, {0, height}};
  if (body == "open cone") return {{1, 0}, {0, height}};
  throw std::invalid_argument("body = " + body + ", must be one of foldedBodies()");
}

/// A half ellipse from the axis to the axis.
Profile ovalProfile(double height, int num_steps = 48) {
  Profile profile;
  for (int i = 0; i <= num_steps; ++i)
    profile.emplace_back(std::sin(kPi * i / num_steps), -0.5 * height * std::cos(kPi * i / num_steps));
  return profile;
}

/// Keeps points with a probability that falls from one to kThinnest along a direction.
void thinAlong(pcl::PointCloud<pcl::PointXYZ>& cloud, const Eigen::Vector3d& direction, const SweptShape& shape,
               RandomStream& random) {
  pcl::PointCloud<pcl::PointXYZ> kept;
  for (const pcl::PointXYZ& point : cloud) {
    const double along = (point.getVector3fMap().cast<double>() - shape.center).dot(direction) / (0.5 * shape.diagonal);
    const double density = kThinnest + (1.0 - kThinnest) * std::clamp(0.5 * (1.0 + along), 0.0, 1.0);
    if (random.uniform() < density) kept.push_back(point);
  }
  cloud = kept;
}

}  // namespace

bool SweptShape::isRound() const {
  return between >= kSymmetricShare;
}

bool SweptShape::isNearlyRound() const {
  return between >= kNearShare;
}

const std::vector<std::string>& foldedBodies() {
  static const std::vector<std::string> bodies = {"prism", "tube", "rim", "cone", "open cone"};
  return bodies;
}

std::vector<Vector2d> foldedCurve(int num_folds, bool report, RandomStream& random) {
  if (num_folds == 0) return repeated(kCurveSteps, {{1.0, 0.0}});
  if (random.uniform() < 0.4) {  // chosen: polygons are what most objects with folds have
    if (num_folds == 2) return rectangle(between(random, 0.5, 0.8));
    return repeated(num_folds, {{1.0, 0.0}});
  }
  const double depth = between(random, 0.1, 0.35);
  const double inner = 1.0 - depth;
  if (!report) {
    Profile fold;
    const int steps = std::max(8, kCurveSteps / num_folds);
    for (int i = 0; i < steps; ++i) {
      const double turn = static_cast<double>(i) / steps;
      fold.emplace_back(1.0 - 0.5 * depth * (1.0 - std::cos(2.0 * kPi * turn)), turn);
    }
    return repeated(num_folds, fold);
  }
  if (random.uniform() < 0.5) return repeated(num_folds, {{1.0, 0.0}, {num_folds == 2 ? 0.6 : inner, 0.5}});
  // A gear: teeth as wide as the gaps, with flanks.
  Profile gear;
  const int steps = std::max(1, kCurveSteps / (4 * num_folds));
  for (int i = 0; i < steps; ++i) gear.emplace_back(1.0, -0.2 + 0.4 * i / steps);
  for (int i = 0; i < steps; ++i) gear.emplace_back(inner, 0.3 + 0.4 * i / steps);
  gear.insert(gear.begin() + steps, Vector2d(1.0, 0.2));
  gear.emplace_back(inner, 0.7);
  return repeated(num_folds, gear);
}

SweptShape foldedShape(const std::string& body, int num_folds, bool report, RandomStream& random) {
  SweptShape shape;
  shape.body = body;
  shape.num_folds = num_folds;
  const Profile curve = foldedCurve(num_folds, report, random);
  double height;
  do height = between(random, kLeastHeight, kMostHeight);
  while (isSpecial(body, num_folds, height, curve.front()));
  shape.mesh = sweep(curve, profileOf(body, height));
  for (int k = 0; k < num_folds; ++k) shape.planes.push_back(planeAlong(kPi * k / num_folds));
  if (body == "prism" || body == "tube" || body == "rim") shape.planes.emplace_back(Vector3d::UnitZ(), 0.5 * height);
  if (num_folds > 0) shape.between = shareOf(shape.mesh, planeAlong(0.5 * kPi / num_folds));
  measureBox(shape);
  return shape;
}

SweptShape roundShape(const std::string& body, const std::vector<Vector2d>& profile) {
  SweptShape shape;
  shape.body = body;
  RandomStream unused(0);
  shape.mesh = sweep(foldedCurve(0, false, unused), profile);
  measureBox(shape);
  const ReflectionPlane across(Vector3d::UnitZ(), shape.center.z());
  if (shareOf(shape.mesh, across) >= kSymmetricShare) shape.planes.push_back(across);
  return shape;
}

std::vector<std::string> roundBodies(bool report) {
  if (report) return {"jar", "goblet", "bowl", "can"};
  return {"bottle", "vase", "cup", "pin"};
}

SweptShape roundShape(const std::string& body, RandomStream& random) {
  const double h = between(random, 1.6, 3.2), r = between(random, 0.25, 0.45), s = between(random, 0.5, 0.8);
  if (body == "ball") return roundShape(body, ovalProfile(2.0));
  if (body == "bottle") return roundShape(body, {{0, 0}, {1, 0}, {1, s * h}, {r, 0.85 * h}, {r, h}, {0, h}});
  if (body == "vase")
    return roundShape(body, {{0, 0},
                             {s, 0},
                             {1, 0.3 * h},
                             {0.9, 0.5 * h},
                             {r, 0.8 * h},
                             {s, h},
                             {s - 0.06, h},
                             {r - 0.06, 0.8 * h},
                             {0.84, 0.5 * h},
                             {0.94, 0.3 * h},
                             {s, 0.06},
                             {0, 0.06}});
  if (body == "cup")
    return roundShape(body, {{0, 0}, {s, 0}, {1, 0.6 * h}, {0.94, 0.6 * h}, {s - 0.05, 0.08}, {0, 0.08}});
  if (body == "pin")
    return roundShape(
        body,
        {{0, 0}, {s, 0}, {1, 0.35 * h}, {s, 0.6 * h}, {r, 0.75 * h}, {r + 0.12, 0.88 * h}, {r, 0.97 * h}, {0, h}});
  if (body == "jar")
    return roundShape(body, {{0, 0}, {0.9, 0}, {1, 0.1 * h}, {1, 0.6 * h}, {s, 0.75 * h}, {s, 0.8 * h}, {0, 0.8 * h}});
  if (body == "goblet")
    return roundShape(body, {{0, 0},
                             {s, 0},
                             {0.1, 0.1 * h},
                             {0.1, 0.4 * h},
                             {0.8, 0.6 * h},
                             {1, 0.9 * h},
                             {0.95, 0.9 * h},
                             {0.75, 0.62 * h},
                             {0, 0.45 * h}});
  if (body == "bowl")
    return roundShape(
        body,
        {{0, 0}, {r, 0}, {0.8, 0.15 * h}, {1, 0.35 * h}, {0.95, 0.35 * h}, {0.75, 0.17 * h}, {r, 0.04}, {0, 0.04}});
  if (body == "can") return roundShape(body, {{0, 0}, {1, 0}, {1, s * h}, {0.9, s * h + 0.1}, {0, s * h + 0.1}});
  throw std::invalid_argument("body = " + body + ", must be one of roundBodies()");
}

FoldedCloud foldedCloud(int i, std::uint64_t seed, bool report, int num_points) {
  RandomStream random(seed);
  FoldedCloud result;
  const auto num_bodies = static_cast<int>(foldedBodies().size()) + 1;
  const int body = i % num_bodies;
  result.body = body + 1 < num_bodies ? foldedBodies()[body] : "round";
  result.noise = i / num_bodies % 3;
  result.thinned = i / num_bodies / 3 % 2 == 1;
  const int num_folds = kFewestFolds + static_cast<int>(random.below(kMostFoldsOfShape - kFewestFolds + 1));
  const auto names = roundBodies(report);
  result.shape = result.body == "round" ? roundShape(names[random.below(names.size())], random)
                                        : foldedShape(result.body, num_folds, report, random);
  result.cloud = sampleMesh(result.shape.mesh, num_points, random());
  if (result.thinned) thinAlong(*result.cloud, randomPose(random(), 0.0).linear().col(0), result.shape, random);
  result.pose = randomPose(random(), result.shape.diagonal);
  moveAndBlur(*result.cloud, result.pose, result.noise * std::sqrt(areaOf(result.shape.mesh) / num_points), random);
  return result;
}

double areaOf(const pcl::PolygonMesh& mesh) {
  const Points vertices = verticesOf(mesh);
  double area = 0.0;
  for (const pcl::Vertices& polygon : mesh.polygons)
    for (std::size_t k = 2; k < polygon.vertices.size(); ++k) {
      const Eigen::Vector3d a = vertices.col(polygon.vertices[0]).cast<double>();
      const Eigen::Vector3d b = vertices.col(polygon.vertices[k - 1]).cast<double>() - a;
      area += 0.5 * b.cross(vertices.col(polygon.vertices[k]).cast<double>() - a).norm();
    }
  return area;
}

void moveAndBlur(pcl::PointCloud<pcl::PointXYZ>& cloud, const Eigen::Isometry3d& pose, double noise,
                 RandomStream& random) {
  for (pcl::PointXYZ& point : cloud) {
    Vector3d x = pose * point.getVector3fMap().cast<double>();
    if (noise > 0.0)
      for (int k = 0; k < 3; ++k) x[k] += noise * standardNormal(random);
    point.getVector3fMap() = x.cast<float>();
  }
}

}  // namespace pcl_symmetry::apps
