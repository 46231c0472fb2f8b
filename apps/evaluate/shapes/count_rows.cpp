#include <algorithm>
#include <array>

#include "common/scanner/virtual_scanner.h"
#include "common/shape_input/shape_input.h"
#include "core/base/constants.h"
#include "evaluate/shapes/shape_report.h"
#include "evaluate/shapes/swept_shape.h"
#include "evaluate/shared/table_text.h"
#include "pcl_symmetry/mesh_sampling.h"

namespace pcl_symmetry::apps {

namespace {

constexpr std::array<int, 3> kPointCounts = {5000, 20'000, 100'000};  // derived: the bar of this evaluation
constexpr int kCountModels = 60;  // chosen: half has intervals of 1.4 times the width, twice takes four minutes
constexpr double kSameAngle = 3.0 * kDegree, kSameOffset = 0.02;  // radians, diagonals; derived: the limits of `planes`
enum CountColumn : std::size_t { kSameDecision, kSameAnswers };

/// Whether all that one answer calls a symmetry is in the other: planes as planes or through an axis or a center.
bool holds(const ShapeAnswers& a, const ShapeAnswers& b, const Eigen::Vector3d& center, double diagonal) {
  const auto near = [&](const Difference& d) { return d.within(kSameAngle, kSameOffset * diagonal); };
  const auto lineOf = [](const SymmetryAxis& axis) { return Line3d(axis.point, axis.direction); };
  const std::vector<SymmetryPlane> planes = b.symmetries();
  const auto throughCenter = [&](const auto& shape) {
    return std::any_of(b.centers.begin(), b.centers.end(), [&](const SymmetryCenter& c) {
      return near({0.0, shape(c.point)});
    });
  };
  for (const SymmetryPlane& plane : a.symmetries()) {
    const bool found =
        std::any_of(planes.begin(), planes.end(), [&](const auto& p) { return near(difference(plane, p, center)); }) ||
        std::any_of(b.axes.begin(), b.axes.end(),
                    [&](const auto& axis) { return near(difference(plane, lineOf(axis), center)); }) ||
        throughCenter([&](const Eigen::Vector3d& point) { return std::abs(plane.signedDistance(point)); });
    if (!found) return false;
  }
  for (const SymmetryAxis& axis : a.axes) {
    const bool found =
        std::any_of(b.axes.begin(), b.axes.end(),
                    [&](const auto& other) { return near(difference(lineOf(axis), lineOf(other), center)); }) ||
        throughCenter([&](const Eigen::Vector3d& point) { return lineOf(axis).distance(point); });
    if (!found) return false;
  }
  return a.centers.empty() || !b.centers.empty();
}

std::string summary(const ShapeAnswers& answers) {
  return std::to_string(answers.symmetries().size()) + "p" + std::to_string(answers.axes.size()) + "a" +
         std::to_string(answers.centers.size()) + "c";
}

void measureCounts(const Model& model, std::uint64_t seed, const ShapeRowOptions& options, ShapeReport& report) {
  const Shape shape = loadShape(model.path);
  if (!shape.mesh) return;
  std::vector<ShapeAnswers> answers;
  Eigen::AlignedBox3d box;
  Row row;
  row.add(model.name);
  std::string confidences;
  for (const int num_points : kPointCounts) {
    const auto cloud = sampleMesh(*shape.mesh, num_points, seed);
    RandomStream random(seed);
    moveAndBlur(*cloud, randomPose(random(), 1.0), 0.0, random);
    for (const pcl::PointXYZ& point : *cloud) box.extend(point.getVector3fMap().cast<double>());
    answers.push_back(detectShape(cloud, detectionOptions(options)));
    row.add(summary(answers.back()));
    for (const SymmetryPlane& plane : answers.back().planes) confidences += fixed(plane.confidence, 2) + " ";
    confidences += "| ";
  }
  report.log(row.add(confidences).end());
  bool same_decision = true, same = true;
  for (std::size_t k = 0; k + 1 < answers.size(); ++k) {
    same_decision = same_decision && answers[k].callSymmetric() == answers[k + 1].callSymmetric();
    const double diagonal = box.sizes().norm();
    same = same && holds(answers[k], answers[k + 1], box.center(), diagonal) &&
           holds(answers[k + 1], answers[k], box.center(), diagonal);
    const std::string row_name = std::to_string(kPointCounts[k]) + " and " + std::to_string(kPointCounts[k + 1]);
    report.at(row_name, kSameDecision).add(answers[k].callSymmetric() == answers[k + 1].callSymmetric());
    report.at(row_name, kSameAnswers)
        .add(holds(answers[k], answers[k + 1], box.center(), diagonal) &&
             holds(answers[k + 1], answers[k], box.center(), diagonal));
  }
  report.at("all three", kSameDecision).add(same_decision);
  report.at("all three", kSameAnswers).add(same);
}

}  // namespace

ShapeCases pointCountCases(const ShapeRowOptions& options) {
  if (options.folders.empty()) throw UsageError("missing argument 'FOLDER': counts needs models");
  const std::vector<Model> models = listModels(options.folders, options.selection);
  const std::size_t count = std::min(models.size(), static_cast<std::size_t>(options.count(kCountModels)));
  ShapeCases cases{ShapeReport({"same decision", "same symmetries"}), static_cast<int>(count),
                   [&options, models, count](int i, ShapeReport& report) {
                     const Model& model = models[static_cast<std::size_t>(i) * models.size() / count];
                     measureCounts(model, options.caseSeed(i), options, report);
                   }};
  cases.report.log("model,at5000,at20000,at100000,confidences");
  return cases;
}

}  // namespace pcl_symmetry::apps
