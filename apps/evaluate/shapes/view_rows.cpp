#include <algorithm>
#include <cmath>

#include "common/scanner/virtual_scanner.h"
#include "core/base/constants.h"
#include "evaluate/shapes/shape_report.h"
#include "evaluate/shapes/swept_shape.h"
#include "evaluate/shared/table_text.h"

namespace pcl_symmetry::apps {

namespace {

constexpr double kViewAngle = 1.0 * kDegree, kViewOffset = 0.01;  // radians, diagonals; derived: the bar
constexpr int kViewCases = 180;  // chosen: half has intervals of 1.4 times the width, twice takes four minutes
// Times the limits. chosen: an axis beyond is another one.
constexpr double kNear = 5.0;
constexpr int kFewestSides = 2, kMostSides = 6;  // chosen: more sides are nearly round
enum ViewColumn : std::size_t { kWithin, kNearby, kOnlyPlanes, kNothing, kFalseFamily };

/// How far the nearest family is off, in limits; infinite without one.
double errorOf(const ShapeAnswers& answers, const SweptShape& shape, const Eigen::Isometry3d& pose) {
  const Line3d axis(pose * SweptShape::axis().origin(), pose.linear() * SweptShape::axis().direction());
  const Eigen::Vector3d center = pose * shape.center;
  double least = std::numeric_limits<double>::infinity();
  const auto take = [&](const Difference& d) {
    least = std::min(least, std::max(d.angle / kViewAngle, d.offset / (kViewOffset * shape.diagonal)));
  };
  const bool is_ball = shape.body == "ball";
  for (const SymmetryCenter& found : answers.centers)
    if (is_ball) take({0.0, (found.point - center).norm()});
  for (const SymmetryAxis& found : answers.axes) {
    const Line3d line(found.point, found.direction);
    take(is_ball ? Difference{0.0, line.distance(center)} : difference(axis, line, center));
  }
  return least;
}

void measureView(int i, const ShapeRowOptions& options, ShapeReport& report) {
  std::vector<std::string> bodies = roundBodies(options.report);
  bodies.emplace_back("ball");
  bodies.emplace_back("prism");
  RandomStream random(options.caseSeed(i));
  const std::string& body = bodies[i % bodies.size()];
  const SweptShape shape =
      body == "prism" ? foldedShape(body, kFewestSides + static_cast<int>(random.below(kMostSides - kFewestSides + 1)),
                                    options.report, random)
                      : roundShape(body, random);
  VirtualScannerOptions scanning;
  scanning.num_points = options.num_points;
  scanning.random_pose = true;
  scanning.seed = random();
  scanning.num_threads = options.threads;
  const Eigen::Vector3d direction = randomPose(random(), 0.0).linear().col(0);
  const VirtualScan scan = VirtualScanner(shape.mesh).scan(direction, scanning);
  const ShapeAnswers answers = detectShape(scan.cloud, detectionOptions(options));
  const double error = errorOf(answers, shape, scan.T_scan_model);
  const bool has_family = !answers.axes.empty() || !answers.centers.empty();
  const double slant = std::acos(std::abs(direction.z())) / kDegree;  // of the view against the axis
  const std::string view = slant < 30 ? "along the axis" : slant < 60 ? "oblique" : "across the axis";
  if (body == "prism") {
    report.at(body, kFalseFamily).add(has_family && !shape.isNearlyRound());
  } else {
    for (const std::string& row : {body, body == "ball" ? std::string("any") : view, std::string("all")}) {
      report.at(row, kWithin).add(error <= 1.0);
      report.at(row, kNearby).add(error <= kNear);
      report.at(row, kOnlyPlanes).add(!has_family && answers.callSymmetric());
      report.at(row, kNothing).add(!answers.callSymmetric());
    }
  }
  Row row;
  row.add(shape.body).add(slant).add(error).add(double(answers.axes.size())).add(double(answers.centers.size()));
  row.add(double(answers.symmetries().size())).add(double(answers.planes.size()));
  if (!answers.planes.empty())
    row.add(answers.planes[0].confidence).add(answers.planes[0].share).add(answers.planes[0].score);
  report.log(row.end());
}

}  // namespace

ShapeCases viewCases(const ShapeRowOptions& options) {
  ShapeCases cases{ShapeReport({"axis or center within 1 deg, 1 %", "within 5 deg, 5 %", "symmetries, but no family",
                                "no symmetry", "family of a prism, which has none"}),
                   options.count(kViewCases),
                   [&options](int i, ShapeReport& report) { measureView(i, options, report); }};
  cases.report.log("body,slant,error,axes,centers,symmetries,planes,confidence,share,score");
  return cases;
}

}  // namespace pcl_symmetry::apps
