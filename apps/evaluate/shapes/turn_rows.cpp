#include <algorithm>
#include <cmath>

#include "common/scanner/virtual_scanner.h"
#include "core/base/constants.h"
#include "drawing/parametric_mesh.h"
#include "evaluate/shapes/shape_report.h"
#include "evaluate/shapes/swept_shape.h"
#include "evaluate/shared/table_text.h"

namespace pcl_symmetry::apps {

namespace {

constexpr double kTurnAngle = 1.0 * kDegree, kTurnOffset = 0.01;  // radians, diagonals; derived: the bar
constexpr int kTurnSolids = 60, kTurnViews = 8;                   // derived: the bar
constexpr int kFewestTurns = 3, kMostTurns = 8;                   // chosen: more folds are nearly round
// Shares of the points of a scan. chosen: a handle of less is hidden, one of more is in sight; scans between count
// nowhere.
constexpr double kHiddenHandle = 0.002, kVisibleHandle = 0.02;
enum TurnColumn : std::size_t { kAxisRight, kFoldRight, kConfident, kFalseRound, kWrongAxis };

/// A handle of a fixed look: half an ellipse in the half plane x > 0, y = 0.
void addHandle(TurningScan& solid) {
  constexpr double kReach = 0.55, kRise = 0.5, kThickness = 0.09;  // radii; chosen: the look of a mug
  double low = 0.0, high = 0.0;
  pcl::PointCloud<pcl::PointXYZ> vertices;
  pcl::fromPCLPointCloud2(solid.shape.mesh.cloud, vertices);
  for (const pcl::PointXYZ& vertex : vertices) {
    solid.reach = std::max(solid.reach, double(std::hypot(vertex.x, vertex.y)));
    low = std::min(low, double(vertex.z));
    high = std::max(high, double(vertex.z));
  }
  const double radius = solid.reach, middle = 0.5 * (low + high), rise = std::min(kRise * radius, 0.35 * (high - low));
  ParametricMesh handle;
  handle.addSurface(24, 12, [=](double u, double v) {
    const double along = kPi * (u - 0.5), around = 2.0 * kPi * v;
    const Eigen::Vector3d out(std::cos(along), 0.0, std::sin(along));
    const Eigen::Vector3d core(0.9 * radius + kReach * radius * out.x(), 0.0, middle + rise * out.z());
    return Eigen::Vector3d(core + kThickness * radius *
                                      (std::cos(around) * out + std::sin(around) * Eigen::Vector3d::UnitY()));
  });
  pcl::PolygonMesh both;
  pcl::PolygonMesh::concatenate(solid.shape.mesh, handle.polygonMesh(), both);
  solid.shape.mesh = both;
}

TurningScan solidOf(int i, bool report, RandomStream& random) {
  const std::vector<std::string> round = roundBodies(report), folded = foldedBodies();
  const int kind = i % 3;
  const std::size_t which = static_cast<std::size_t>(i / 3);
  if (kind == 1) {
    const int folds = kFewestTurns + static_cast<int>(random.below(kMostTurns - kFewestTurns + 1));
    return {"folds", foldedShape(folded[which % folded.size()], folds, report, random)};
  }
  TurningScan solid{kind == 0 ? "round" : "handle", roundShape(round[which % round.size()], random)};
  if (kind == 2) addHandle(solid);
  return solid;
}

double handleShare(const TurningScan& solid) {
  constexpr double kBeyond = 1.03;  // reaches; chosen: the error of a float is far below, handles reach to 1.5
  const Eigen::Isometry3d T_model_scan = solid.scan.T_scan_model.inverse();
  int num_beyond = 0, num = 0;
  for (const pcl::PointXYZ& point : *solid.scan.cloud) {
    if (!point.getVector3fMap().allFinite()) continue;
    ++num;
    const Eigen::Vector3d x = T_model_scan * point.getVector3fMap().cast<double>();
    num_beyond += x.head<2>().norm() > kBeyond * solid.reach ? 1 : 0;
  }
  return num > 0 ? static_cast<double>(num_beyond) / num : 0.0;
}

/// The error of a line, in limits.
double errorOf(const Eigen::Vector3d& point, const Eigen::Vector3d& direction, const SweptShape& shape,
               const Eigen::Isometry3d& pose) {
  const Line3d axis(pose * SweptShape::axis().origin(), pose.linear() * SweptShape::axis().direction());
  const Difference d = difference(axis, Line3d(point, direction), pose * shape.center);
  return std::max(d.angle / kTurnAngle, d.offset / (kTurnOffset * shape.diagonal));
}

/// The answer closest to the axis of a solid.
struct ClosestTurn {
  double error = std::numeric_limits<double>::infinity();  ///< in limits
  int order = -1;
  double confidence = 0.0;
  bool called_round = false, other = false;  ///< another axis of order 3 and more
};

ClosestTurn closestTurn(const ShapeAnswers& answers, const SweptShape& shape, const Eigen::Isometry3d& pose) {
  constexpr double kOther = 5.0;  // limits; chosen: an axis beyond is another one
  ClosestTurn closest;
  const auto take = [&](const Eigen::Vector3d& point, const Eigen::Vector3d& axis, int fold, double confidence) {
    const double error = errorOf(point, axis, shape, pose);
    closest.other = closest.other || error > kOther;
    if (error < closest.error) {
      closest.error = error;
      closest.order = fold;
      closest.confidence = confidence;
    }
  };
  for (const SymmetryAxis& axis : answers.axes) take(axis.point, axis.direction, 0, axis.confidence);
  for (const SymmetryTurn& turn : answers.turns)
    if (turn.confidence >= 0.5 && turn.fold > 2) take(turn.point, turn.direction, turn.fold, turn.confidence);
  closest.called_round = !answers.axes.empty();
  return closest;
}

/// What was measured of the turns nearest to the axis, whatever was decided.
void addEvidence(Row& row, const ShapeAnswers& answers, const SweptShape& shape, const Eigen::Isometry3d& pose) {
  const SymmetryTurn* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const SymmetryTurn& turn : answers.turns) {
    const double error = errorOf(turn.point, turn.direction, shape, pose);
    if (error >= least || turn.fold == 2) continue;
    least = error;
    nearest = &turn;
  }
  row.add(least);
  if (nearest) row.add(nearest->off).add(nearest->far).add(nearest->support).add(nearest->halfway);
}

void measureTurn(int i, const ShapeRowOptions& options, ShapeReport& report) {
  const TurningScan solid = turningScan(i, options);
  const SweptShape& shape = solid.shape;
  const VirtualScan& scan = solid.scan;
  const double handle = solid.kind == "handle" ? handleShare(solid) : 0.0;
  if (handle > kHiddenHandle && handle < kVisibleHandle) return;
  const bool in_sight = handle >= kVisibleHandle;
  const ShapeAnswers answers = detectShape(scan.cloud, detectionOptions(options));
  const ClosestTurn closest = closestTurn(answers, shape, scan.T_scan_model);
  const bool round = shape.num_folds == 0 || shape.isNearlyRound();
  const bool right = closest.error <= 1.0;
  const std::string row = in_sight ? "handle in sight" : solid.kind == "handle" ? "handle hidden" : solid.kind;
  for (const std::string& name : {row, std::string(in_sight ? "" : "all but handles in sight")}) {
    if (name.empty()) continue;
    if (!in_sight) {
      report.at(name, kAxisRight).add(right);
      report.at(name, kFoldRight).add(right && (closest.order == shape.num_folds || (closest.order == 0 && round)));
    }
    report.at(name, kConfident).add(std::isfinite(closest.error));
    report.at(name, kFalseRound).add(closest.called_round && (in_sight || !round));
    report.at(name, kWrongAxis).add(closest.other);
  }
  Row line;
  line.add(row).add(shape.body).add(double(shape.num_folds)).add(std::acos(std::abs(solid.direction.z())) / kDegree);
  line.add(handle).add(closest.error).add(double(closest.order)).add(closest.confidence);
  addEvidence(line, answers, shape, scan.T_scan_model);
  report.log(line.end());
}

}  // namespace

TurningScan turningScan(int i, const ShapeRowOptions& options) {
  RandomStream of_solid(options.caseSeed(i / kTurnViews)), of_view(options.caseSeed(1'000'000 + i));
  TurningScan solid = solidOf(i / kTurnViews, options.report, of_solid);
  solid.direction = randomPose(of_view(), 0.0).linear().col(0);
  VirtualScannerOptions scanning;
  scanning.num_points = options.num_points;
  scanning.random_pose = true;
  scanning.seed = of_view();
  scanning.num_threads = options.threads;
  solid.scan = VirtualScanner(solid.shape.mesh).scan(solid.direction, scanning);
  return solid;
}

ShapeCases turnCases(const ShapeRowOptions& options) {
  ShapeCases cases{ShapeReport({"axis within 1 deg, 1 %", "and its order", "called a symmetry",
                                "called round, but is not", "another axis of order 3 and more"}),
                   options.count(kTurnSolids * kTurnViews),
                   [&options](int i, ShapeReport& report) { measureTurn(i, options, report); }};
  cases.report.log("kind,body,folds,slant,handle,error,order,confidence,best_error,off,far,support,halfway");
  return cases;
}

}  // namespace pcl_symmetry::apps
