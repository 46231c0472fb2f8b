#include <algorithm>
#include <cmath>

#include "common/scanner/virtual_scanner.h"
#include "common/shape_input/shape_input.h"
#include "core/base/constants.h"
#include "evaluate/references/reference_symmetries.h"
#include "evaluate/shapes/shape_report.h"
#include "evaluate/shapes/swept_shape.h"
#include "evaluate/shared/table_text.h"
#include "pcl_symmetry/mesh_sampling.h"

namespace pcl_symmetry::apps {

namespace {

constexpr double kPartAngle = 3.0 * kDegree, kPartOffset = 0.02;  // radians, diagonals; derived: the limits of `planes`
constexpr int kCompositeCases = 40;  // chosen: half has intervals of 1.4 times the width, twice takes four minutes
// Diameter of the smaller part, of the larger one. chosen: smaller parts are details, larger ones are as large.
constexpr double kSmallest = 0.6;
constexpr double kOverlap = 0.1;     // diameters; chosen: the parts touch in more than a point
constexpr int kMostFoldsOfPart = 4;  // chosen: parts of things have few; more planes cost time

/// A part about its own center, with unit diagonal.
struct Part {
  std::string name;
  pcl::PointCloud<pcl::PointXYZ> cloud;
  std::vector<ReflectionPlane> planes;
};

/// Brings the cloud and its planes to unit diagonal about the origin.
Part normalized(Part part, const Eigen::Vector3d& center, double diagonal) {
  for (pcl::PointXYZ& point : part.cloud)
    point.getVector3fMap() = ((point.getVector3fMap().cast<double>() - center) / diagonal).cast<float>();
  for (ReflectionPlane& plane : part.planes)
    plane = ReflectionPlane(plane.normal(), -plane.normal().dot(center) / diagonal + plane.offset() / diagonal);
  return part;
}

Part solidPart(bool report, int num_points, RandomStream& random) {
  const std::string body = foldedBodies()[random.uniform() < 0.6 ? 0 : 3];  // prisms and cones: closed
  const int folds = 2 + static_cast<int>(random.below(kMostFoldsOfPart - 1));
  const SweptShape shape = foldedShape(body, folds, report, random);
  return normalized({body + "_" + std::to_string(folds), *sampleMesh(shape.mesh, num_points, random()), shape.planes},
                    shape.center, shape.diagonal);
}

/// Models that have planes of symmetry and no axis, each searched once.
class ModelParts {
public:
  explicit ModelParts(const ShapeRowOptions& options) : options_(options) {
    if (!options.folders.empty()) models_ = listModels(options.folders, options.selection);
  }

  bool empty() const { return models_.empty(); }

  /// \return nothing where the model cannot be read, or has no plane.
  std::optional<Part> part(std::size_t index, int num_points, std::uint64_t seed) const {
    const Model& model = models_[index % models_.size()];
    const Shape shape = loadShape(model.path);
    if (!shape.mesh) return std::nullopt;
    ReferenceOptions searching;
    searching.num_samples = 4000;  // chosen: half as exact as the default; half of it loses planes
    searching.num_threads = options_.threads;
    const ReferenceSymmetries found = findReferenceSymmetries(*shape.mesh, searching);
    if (found.planes.empty() || !found.axes.empty() || !found.centers.empty()) return std::nullopt;
    Part part{model.name, *sampleMesh(*shape.mesh, num_points, seed), {}};
    for (const ReferencePlane& plane : found.planes) part.planes.push_back(plane.plane);
    return normalized(std::move(part), found.center, found.diagonal);
  }

private:
  const ShapeRowOptions& options_;
  std::vector<Model> models_;
};

/// Greatest extent of a cloud along a direction from the origin.
double reach(const pcl::PointCloud<pcl::PointXYZ>& cloud, const Eigen::Vector3d& direction) {
  double farthest = 0.0;
  for (const pcl::PointXYZ& point : cloud)
    farthest = std::max(farthest, direction.dot(point.getVector3fMap().cast<double>()));
  return farthest;
}

struct Composite {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud{new pcl::PointCloud<pcl::PointXYZ>};
  std::vector<ReflectionPlane> planes;  ///< of the parts
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double diagonal = 1.0;
};

/// Puts the second part beside the first.
Composite joined(const Part& a, const Part& b, RandomStream& random) {
  Composite result;
  const double size = kSmallest + (1.0 - kSmallest) * random.uniform();
  const Eigen::Isometry3d turn_a = randomPose(random(), 0.0), turn_b = randomPose(random(), 0.0);
  const Eigen::Vector3d side = randomPose(random(), 0.0).linear().col(0);
  const double distance = reach(a.cloud, turn_a.linear().transpose() * side) +
                          size * reach(b.cloud, -(turn_b.linear().transpose() * side)) - kOverlap;
  const auto put = [&](const Part& part, const Eigen::Isometry3d& turn, double scale, const Eigen::Vector3d& place) {
    for (const pcl::PointXYZ& point : part.cloud) {
      // As dense as the other part: fewer points on the smaller surface.
      if (random.uniform() >= scale * scale) continue;
      const Eigen::Vector3d x = scale * (turn * point.getVector3fMap().cast<double>()) + place;
      result.cloud->emplace_back(static_cast<float>(x.x()), static_cast<float>(x.y()), static_cast<float>(x.z()));
    }
    for (const ReflectionPlane& plane : part.planes) {
      const Eigen::Vector3d n = turn.linear() * plane.normal();
      result.planes.emplace_back(n, scale * plane.offset() + n.dot(place));
    }
  };
  put(a, turn_a, 1.0, Eigen::Vector3d::Zero());
  put(b, turn_b, size, distance * side);
  Eigen::AlignedBox3d box;
  for (const pcl::PointXYZ& point : *result.cloud) box.extend(point.getVector3fMap().cast<double>());
  result.center = box.center();
  result.diagonal = box.sizes().norm();
  return result;
}

const char kNumModels[] = "models", kNumWrong[] = "wrong local planes";  // chosen: the words of the note

void measureComposite(int i, const ModelParts& models, const ShapeRowOptions& options, ShapeReport& report) {
  RandomStream random(options.caseSeed(i));
  std::vector<Part> parts;
  for (int k = 0; k < 2; ++k) {
    if (models.empty()) {
      parts.push_back(solidPart(options.report, options.num_points / 2, random));
    } else if (auto part = models.part(static_cast<std::size_t>(2 * i + k), options.num_points / 2, random())) {
      parts.push_back(std::move(*part));
    }
  }
  if (parts.size() < 2) return;
  const Composite composite = joined(parts[0], parts[1], random);
  DetectionOptions detection = detectionOptions(options);
  detection.approximate = true;
  const ShapeAnswers answers = detectShape(composite.cloud, detection);
  const auto same = [&](const ReflectionPlane& a, const ReflectionPlane& b) {
    return difference(a, b, composite.center).within(kPartAngle, kPartOffset * composite.diagonal);
  };
  int found = 0, local = 0, wrong = 0;
  std::vector<int> of_part(2, 0);
  for (std::size_t k = 0; k < composite.planes.size(); ++k) {
    const bool has = std::any_of(answers.planes.begin(), answers.planes.end(),
                                 [&](const auto& plane) { return same(plane, composite.planes[k]); });
    found += has ? 1 : 0;
    of_part[k < parts[0].planes.size() ? 0 : 1] += has ? 1 : 0;
    report.at("all", 0).add(has);
  }
  for (const SymmetryPlane& plane : answers.planes) {
    if (plane.kind == PlaneKind::Approximate || plane.kind == PlaneKind::Possible) continue;
    const bool right = std::any_of(composite.planes.begin(), composite.planes.end(),
                                   [&](const auto& other) { return same(plane, other); });
    report.at("all", 1).add(right);
    local += 1;
    wrong += right ? 0 : 1;
  }
  report.at("all", 2).add(of_part[0] > 0 && of_part[1] > 0);
  report.at("all", 3).add(answers.callSymmetric());
  report.tally(kNumModels) += 1;
  report.tally(kNumWrong) += wrong;
  Row row;
  row.add(parts[0].name + "+" + parts[1].name).add(double(composite.planes.size())).add(double(found));
  row.add(double(local)).add(double(wrong)).add(double(answers.symmetries().size())).add(double(answers.axes.size()));
  report.log(row.end());
}

}  // namespace

ShapeCases compositeCases(const ShapeRowOptions& options) {
  ShapeCases cases{
      ShapeReport({"planes of parts found", "right, of local ones", "models with a plane of each", "called symmetric"}),
      options.count(kCompositeCases),
      [&options, models = ModelParts(options)](int i, ShapeReport& report) {
        measureComposite(i, models, options, report);
      },
      [](ShapeReport& report) {
        const int num_models = report.tally(kNumModels), num_wrong = report.tally(kNumWrong);
        report.note("wrong local planes a model: " + fixed(num_models > 0 ? double(num_wrong) / num_models : 0.0, 2) +
                    " of " + std::to_string(num_models) + " models");
      }};
  cases.report.log("parts,planes,found,local,wrong,symmetries,axes");
  return cases;
}

}  // namespace pcl_symmetry::apps
