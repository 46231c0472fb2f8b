#include <algorithm>
#include <array>
#include <cmath>

#include "common/scanner/random_numbers.h"
#include "common/scanner/virtual_scanner.h"
#include "core/base/constants.h"
#include "evaluate/shapes/shape_report.h"
#include "evaluate/shapes/swept_shape.h"
#include "evaluate/shared/table_text.h"

namespace pcl_symmetry::apps {

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Eigen::Vector3d;

constexpr int kFewest = 5, kMost = 500;                     // points; derived: the bar of this evaluation
constexpr int kFewestOfScene = 500, kMostOfScene = 10'000;  // points; chosen: what is left of a depth image
constexpr int kNoPlaneBelow = 20;                           // points; derived: the library's least number
constexpr int kRandomCases = 700;  // chosen: half leaves an upper limit of 2 % where none is called symmetric

Vector3d normalVector(RandomStream& random) {
  const double x = standardNormal(random), y = standardNormal(random), z = standardNormal(random);
  return {x, y, z};
}

Vector3d uniformVector(RandomStream& random) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return Vector3d(2 * x - 1, 2 * y - 1, 2 * z - 1);
}

void add(Cloud& cloud, const Vector3d& x) {
  cloud.emplace_back(static_cast<float>(x.x()), static_cast<float>(x.y()), static_cast<float>(x.z()));
}

/// Independent points: in a box, or in a ball.
Cloud filled(int count, bool ball, RandomStream& random) {
  Cloud cloud;
  const Vector3d size = Vector3d::Constant(0.6) + 0.4 * uniformVector(random);
  while (static_cast<int>(cloud.size()) < count) {
    const Vector3d x = uniformVector(random);
    if (!ball || x.norm() < 1.0) add(cloud, x.cwiseProduct(size));
  }
  return cloud;
}

/// Normal distributions of several widths.
Cloud blobs(int count, int num_blobs, RandomStream& random) {
  std::vector<std::pair<Vector3d, Vector3d>> parts;
  for (int k = 0; k < num_blobs; ++k)
    parts.emplace_back(num_blobs > 1 ? Vector3d(2.0 * uniformVector(random)) : Vector3d(0, 0, 0),
                       Vector3d(0.6 * Vector3d::Ones() + 0.4 * uniformVector(random)));
  Cloud cloud;
  for (int i = 0; i < count; ++i) {
    const auto& [center, width] = parts[random.below(parts.size())];
    add(cloud, center + width.cwiseProduct(normalVector(random)));
  }
  return cloud;
}

/// Steps of a random walk, which may begin anew at an earlier place.
Cloud walk(int count, bool branching, RandomStream& random) {
  std::vector<Vector3d> places{Vector3d::Zero()};
  while (static_cast<int>(places.size()) < count) {
    const bool jumps = branching && random.uniform() < 0.02;
    places.push_back((jumps ? places[random.below(places.size())] : places.back()) + normalVector(random));
  }
  Cloud cloud;
  for (const Vector3d& x : places) add(cloud, x);
  return cloud;
}

/// Radius by angle of an outline without symmetry.
class Outline {
public:
  explicit Outline(RandomStream& random) {
    for (std::size_t k = 0; k < waves_.size(); ++k)
      waves_[k] = {0.25 * standardNormal(random) / static_cast<double>(k + 1), 2.0 * kPi * random.uniform()};
  }
  bool holds(double x, double y) const {
    const double angle = std::atan2(y, x);
    double radius = 1.0;
    for (std::size_t k = 0; k < waves_.size(); ++k)
      radius += waves_[k].first * std::cos(static_cast<double>(k + 1) * angle + waves_[k].second);
    return std::hypot(x, y) < std::max(0.2, radius);
  }

private:
  std::array<std::pair<double, double>, 5> waves_;
};

/// A sheet of a random outline.
/// \param height of waves; 0 = flat but for noise.
Cloud sheet(int count, double height, double noise, RandomStream& random) {
  const Outline outline(random);
  const Vector3d wave = 3.0 * uniformVector(random);
  Cloud cloud;
  while (static_cast<int>(cloud.size()) < count) {
    const Vector3d x = 2.0 * uniformVector(random);
    if (!outline.holds(x.x(), x.y())) continue;
    add(cloud, {x.x(), x.y(),
                height * std::sin(wave.x() * x.x() + wave.y() * x.y() + wave.z()) + noise * standardNormal(random)});
  }
  return cloud;
}

/// Points along a line, or along a curve without symmetry.
Cloud line(int count, bool bent, RandomStream& random) {
  const double noise = 0.01 * random.uniform();  // lengths
  std::array<Vector3d, 3> waves;
  for (std::size_t k = 0; k < waves.size(); ++k) waves[k] = normalVector(random) * (bent ? 0.3 / double(k + 1) : 0.0);
  Cloud cloud;
  for (int i = 0; i < count; ++i) {
    const double t = random.uniform();
    Vector3d x(t, 0, 0);
    for (std::size_t k = 0; k < waves.size(); ++k) x += waves[k] * std::sin(kPi * double(k + 1) * t + double(k));
    add(cloud, x + noise * normalVector(random));
  }
  return cloud;
}

/// Points along a bent wire: a cubic curve between random places, or a spiral that opens and climbs.
Cloud wire(int count, bool spiral, RandomStream& random) {
  const double noise = 0.01 * random.uniform();  // lengths
  std::array<Vector3d, 4> places;
  for (Vector3d& place : places) place = normalVector(random);
  const double turns = 0.75 + random.uniform(), opening = 0.3 + random.uniform(), climb = 0.3 + random.uniform();
  Cloud cloud;
  for (int i = 0; i < count; ++i) {
    const double t = random.uniform(), s = 1.0 - t, angle = 2.0 * kPi * turns * t, radius = 0.2 + opening * t * t;
    const Vector3d x = spiral ? Vector3d(radius * std::cos(angle), radius * std::sin(angle), climb * t)
                              : Vector3d(s * s * s * places[0] + 3.0 * s * s * t * places[1] +
                                         3.0 * s * t * t * places[2] + t * t * t * places[3]);
    add(cloud, x + noise * normalVector(random));
  }
  return cloud;
}

/// A flat table of a random outline, and objects on a part of it: boxes, or balls.
Cloud table(int count, bool balls, RandomStream& random) {
  constexpr double kOnObjects = 0.3;  // share of the points; chosen: with less than 0.1 the outline alone decides
  const double noise = 0.004 * random.uniform();
  Cloud cloud = sheet(static_cast<int>((1.0 - kOnObjects) * count), 0.0, noise, random);
  struct Thing {
    Vector3d place, size;
  };
  std::vector<Thing> things(3 + random.below(3));
  for (Thing& thing : things)
    thing = {0.6 * uniformVector(random), Vector3d::Constant(0.2) + 0.1 * uniformVector(random)};
  while (static_cast<int>(cloud.size()) < count) {
    const Thing& thing = things[random.below(things.size())];
    Vector3d x = uniformVector(random);
    if (balls) {
      x.normalize();
    } else {
      const auto face = static_cast<Eigen::Index>(random.below(3));
      x[face] = face == 2 || x[face] > 0.0 ? 1.0 : -1.0;
    }
    x = x.cwiseProduct(balls ? Vector3d(Vector3d::Constant(thing.size.x())) : thing.size);
    add(cloud, Vector3d(thing.place.x(), thing.place.y(), thing.size.z()) + x + noise * normalVector(random));
  }
  return cloud;
}

const std::vector<std::string>& randomKinds() {
  static const std::vector<std::string> kinds = {"fewer than 20 points", "filled", "blobs", "walk", "sheet", "line",
                                                 "table with objects",   "wire"};
  return kinds;
}

Cloud randomCloud(const std::string& kind, bool report, RandomStream& random) {
  const auto drawn = [&](int low, int high) {
    return static_cast<int>(std::lround(low * std::pow(double(high) / low, random.uniform())));
  };
  if (kind == "fewer than 20 points") return filled(drawn(kFewest, kNoPlaneBelow - 1), report, random);
  if (kind == "table with objects") return table(drawn(kFewestOfScene, kMostOfScene), report, random);
  const int count = drawn(kFewest, kMost);
  if (kind == "filled") return filled(count, report, random);
  if (kind == "blobs") return blobs(count, report ? 3 : 1, random);
  if (kind == "walk") return walk(count, report, random);
  if (kind == "wire") return wire(count, report, random);
  if (kind == "sheet") return sheet(count, report ? 0.05 : 0.0, 0.01 * random.uniform(), random);
  return line(count, report, random);
}

void measureRandomCloud(int i, const ShapeRowOptions& options, ShapeReport& report) {
  RandomStream random(options.caseSeed(i));
  const auto& kinds = randomKinds();
  const std::string& kind = kinds[static_cast<std::size_t>(i) % kinds.size()];
  Cloud::Ptr cloud(new Cloud(randomCloud(kind, options.report, random)));
  const Eigen::Isometry3d pose = randomPose(random(), 1.0);
  moveAndBlur(*cloud, pose, 0.0, random);
  const ShapeAnswers answers = detectShape(cloud, detectionOptions(options));
  const auto num_planes = answers.symmetries().size();
  // A straight line has an axis: to say so is right.
  const bool is_line = kind == "line" && !options.report && answers.callLine(pose.linear().col(0));
  for (const std::string& row : {kind, std::string("all")}) {
    report.at(row, 0).add(answers.callSymmetric() && !is_line);
    report.at(row, 1).add(num_planes > 0);
    report.at(row, 2).add(!answers.axes.empty());
    report.at(row, 3).add(!answers.centers.empty());
    report.at(row, 4).add(answers.planes.size() > num_planes);
    report.at(row, 5).add(is_line);
  }
  Row row;
  row.add(kind).add(double(cloud->size())).add(double(num_planes)).add(double(answers.axes.size()));
  row.add(double(answers.centers.size())).add(double(answers.planes.size() - num_planes));
  if (!answers.planes.empty())
    row.add(answers.planes[0].confidence)
        .add(answers.planes[0].share)
        .add(answers.planes[0].score)
        .add(answers.planes[0].deviation);
  report.log(row.end());
}

}  // namespace

ShapeCases randomCases(const ShapeRowOptions& options) {
  ShapeCases cases{
      ShapeReport({"called symmetric", "a plane", "an axis", "a center", "possible", "a line that has its axis"}),
      options.count(kRandomCases), [&options](int i, ShapeReport& report) { measureRandomCloud(i, options, report); }};
  cases.report.log("kind,points,planes,axes,centers,possible,confidence,share,score,deviation");
  return cases;
}

}  // namespace pcl_symmetry::apps
