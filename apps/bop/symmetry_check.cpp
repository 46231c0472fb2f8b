#include "bop/symmetry_check.h"

#include <algorithm>
#include <cmath>

#include "core/base/constants.h"
#include "core/geometry/directions.h"
#include "core/geometry/geometry_rules.h"
#include "io/answers.h"

namespace pcl_symmetry::apps {

namespace {

// Greatest displacement of a point between rotations that count as one, as a share of the diameter.
constexpr double kOneTurn = 0.02;
constexpr int kNumAngles = 8;  // rotations that represent all rotations about an axis

const Eigen::Isometry3d kIdentity = Eigen::Isometry3d::Identity();

/// The fixed point of a rotation that is closest to the origin.
Eigen::Vector3d fixedPointOf(const Eigen::Isometry3d& motion) {
  const Eigen::AngleAxisd turn(motion.linear());
  const Eigen::Vector3d across = motion.translation() - turn.axis().dot(motion.translation()) * turn.axis();
  return 0.5 * (across + turn.axis().cross(across) / std::tan(0.5 * turn.angle()));
}

/// Compares one model.
class Comparison {
public:
  Comparison(const SurfaceEvidence& surface, double diameter)
      : surface_(surface), points_(cornersOf(surface.points())), limit_(kOneTurn * diameter) {}

  bool has(const ObjectSymmetries& group, const Eigen::Isometry3d& motion) const {
    return group.surfaceDistance(kIdentity, motion, points_) <= limit_;
  }

  /// Whether a group has all rotations about an axis.
  bool hasAll(const ObjectSymmetries& group, const ContinuousSymmetry& symmetry) const {
    for (int k = 1; k <= kNumAngles; ++k)
      if (!has(group, motionAbout({symmetry.offset, symmetry.axis}, 2.0 * kPi * goldenFraction(k)))) return false;
    return true;
  }

  Disagreement aboutTurn(const std::string& says, const Eigen::Isometry3d& motion) const {
    const Eigen::AngleAxisd turn(motion.linear());
    return {says, turn.axis(), fixedPointOf(motion), turn.angle(), surface_.of(motion)};
  }

  Disagreement aboutAxis(const std::string& says, const ContinuousSymmetry& symmetry) const {
    Disagreement result{says, symmetry.axis, symmetry.offset, 0.0, {}};
    for (int k = 1; k <= kNumAngles; ++k) {
      const MotionEvidence evidence =
          surface_.of(motionAbout({symmetry.offset, symmetry.axis}, 2.0 * kPi * goldenFraction(k)));
      if (evidence.deviation >= result.evidence.deviation) result.evidence = evidence;
    }
    return result;
  }

private:
  /// The points farthest along many directions, which determine greatest distances.
  static Points cornersOf(const Points& points) {
    constexpr int kNumDirections = 200;
    std::vector<int> corners;
    for (const Eigen::Vector3d& direction : evenDirections(kNumDirections)) {
      int farthest = 0;
      (direction.cast<float>().transpose() * points).maxCoeff(&farthest);
      corners.push_back(farthest);
    }
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    return points(Eigen::all, corners);
  }

  const SurfaceEvidence& surface_;
  Points points_;
  double limit_;
};

/// What is wrong with a list that should be a group as bop_toolkit composes it; empty if nothing is.
std::string lacksOf(const ListedSymmetries& listed, const ObjectSymmetries& group) {
  if (listed.is_composed) return "";
  if (group.kind == RotationGroupKind::Spherical && listed.continuous.size() > 1)
    return "axes of revolution are not composed with each other: a sphere needs one axis and tilts";
  if (isContinuous(group.kind)) return "";
  std::size_t num_listed = 1;
  for (const Eigen::Isometry3d& motion : group.discrete) {
    const bool is_listed = std::any_of(listed.discrete.begin(), listed.discrete.end(), [&](const auto& other) {
      return Eigen::AngleAxisd(other.linear().transpose() * motion.linear()).angle() < kDegree;
    });
    num_listed += is_listed ? 1 : 0;
  }
  const std::size_t size = group.discrete.size() + 1;
  if (num_listed == size) return "";
  return "lists " + std::to_string(num_listed - 1) + " of the " + std::to_string(size - 1) + " rotations of " +
         group.name();
}

std::optional<ObjectSymmetries> groupOf(const ListedSymmetries& listed, std::string& remark) {
  try {
    const ObjectSymmetries group = ObjectSymmetries::from(listed.discrete, listed.continuous);
    remark = lacksOf(listed, group);
    return group;
  } catch (const std::invalid_argument& error) {
    remark = error.what();
    return std::nullopt;
  }
}

bool isParallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.cross(b).norm() < std::sin(kDegree);
}

/// Listed rotations that the surface does not have: the smallest one about each axis.
std::vector<Eigen::Isometry3d> wrongTurns(const ListedSymmetries& listed, const ObjectSymmetries& found,
                                          const Comparison& comparison) {
  std::vector<Eigen::Isometry3d> wrong;
  for (const Eigen::Isometry3d& motion : listed.discrete) {
    if (comparison.has(found, motion)) continue;
    const Eigen::AngleAxisd turn(motion.linear());
    const auto known = std::find_if(wrong.begin(), wrong.end(), [&](const Eigen::Isometry3d& other) {
      return isParallel(Eigen::AngleAxisd(other.linear()).axis(), turn.axis());
    });
    if (known == wrong.end())
      wrong.push_back(motion);
    else if (turn.angle() < Eigen::AngleAxisd(known->linear()).angle())
      *known = motion;
  }
  return wrong;
}

/// Adds rotations that the file has and the surface has not. For a sphere, which has many tilts, only the worst one.
void addWrong(const ListedSymmetries& listed, const ObjectSymmetries& found, bool is_sphere,
              const Comparison& comparison, std::vector<Disagreement>& disagreements) {
  std::vector<Disagreement> wrong;
  for (const ContinuousSymmetry& symmetry : listed.continuous)
    if (!comparison.hasAll(found, symmetry)) wrong.push_back(comparison.aboutAxis("file only", symmetry));
  for (const Eigen::Isometry3d& motion : wrongTurns(listed, found, comparison))
    wrong.push_back(comparison.aboutTurn("file only", motion));
  if (is_sphere && wrong.size() > 1) {
    std::sort(wrong.begin(), wrong.end(),
              [](const auto& a, const auto& b) { return a.evidence.deviation > b.evidence.deviation; });
    wrong.resize(1);
  }
  disagreements.insert(disagreements.end(), wrong.begin(), wrong.end());
}

/// Adds rotations of the surface that the file does not list: one axis at a time, by its smallest rotation.
void addMissing(const ObjectSymmetries& found, const ObjectSymmetries& given, const Comparison& comparison,
                std::vector<Disagreement>& disagreements) {
  for (const ContinuousSymmetry& symmetry : found.continuous)
    if (!comparison.hasAll(given, symmetry)) disagreements.push_back(comparison.aboutAxis("surface only", symmetry));
  for (const RotationAxis& axis : axesOf(found.discrete)) {
    const Eigen::Isometry3d turn = motionAbout({found.center, axis.direction}, 2.0 * kPi / axis.order);
    if (!comparison.has(given, turn)) disagreements.push_back(comparison.aboutTurn("surface only", turn));
  }
}

}  // namespace

SymmetryCheck checkSymmetries(const ListedSymmetries& listed, const ObjectSymmetries& found,
                              const SurfaceEvidence& surface, double diameter) {
  const Comparison comparison(surface, diameter);
  SymmetryCheck check;
  check.surface_group = found.name();
  const std::optional<ObjectSymmetries> given = groupOf(listed, check.remark);
  const bool is_sphere = given && given->kind == RotationGroupKind::Spherical;
  addWrong(listed, found, is_sphere, comparison, check.disagreements);
  if (given) {
    check.file_group = given->name();
    addMissing(found, *given, comparison, check.disagreements);
  }
  return check;
}

nlohmann::ordered_json toJson(const SymmetryCheck& check, double diameter) {
  nlohmann::ordered_json json{{"file", check.file_group},
                              {"surface", check.surface_group},
                              {"agrees", check.agrees()},
                              {"remark", check.remark}};
  json["disagreements"] = nlohmann::ordered_json::array();
  for (const Disagreement& disagreement : check.disagreements)
    json["disagreements"].push_back({{"says", disagreement.says},
                                     {"axis", numbersOf(disagreement.axis)},
                                     {"point", numbersOf(disagreement.point)},
                                     {"angle", disagreement.angle / kDegree},
                                     {"share", disagreement.evidence.share},
                                     {"mean", disagreement.evidence.mean},
                                     {"deviation", disagreement.evidence.deviation},
                                     {"deviation_of_diameter", disagreement.evidence.deviation / diameter}});
  return json;
}

void printCheck(const std::string& name, const SymmetryCheck& check, double diameter) {
  std::printf("model %-6s file %-5s surface %-5s %s%s\n", name.c_str(),
              check.file_group.empty() ? "none" : check.file_group.c_str(), check.surface_group.c_str(),
              check.agrees() ? "agree" : "disagree", check.remark.empty() ? "" : (": " + check.remark).c_str());
  for (const Disagreement& disagreement : check.disagreements) {
    const Eigen::Vector3d& axis = disagreement.axis;
    const double angle = disagreement.angle;
    const std::string turns = angle == 0.0 ? "any angle" : formatted("%.2f degrees", angle / kDegree);
    std::printf("  %-12s  axis %9.6f %9.6f %9.6f  %-14s  share %.3f  mean %5.2f %%  deviation %5.2f %%\n",
                disagreement.says.c_str(), axis.x(), axis.y(), axis.z(), turns.c_str(), disagreement.evidence.share,
                100.0 * disagreement.evidence.mean / diameter, 100.0 * disagreement.evidence.deviation / diameter);
  }
}

SurfaceEvidence::SurfaceEvidence(Points points, double tolerance)
    : points_(std::move(points)),
      tolerance_(tolerance),
      search_(makeFlannSearch(points_)),
      samples_(surfaceSamples(points_, localGeometry(points_, *search_, 1))) {}

std::vector<float> SurfaceEvidence::distances(const Eigen::Isometry3d& motion) const {
  const Points moved = (motion.cast<float>() * points_.colwise().homogeneous()).eval();
  return surfaceDistances(moved, search_->closest(moved), samples_);
}

MotionEvidence SurfaceEvidence::of(const Eigen::Isometry3d& motion) const {
  std::vector<float> distances = this->distances(motion);
  MotionEvidence evidence;
  for (const double distance : distances) evidence.mean += distance / static_cast<double>(distances.size());
  evidence.share = shareWithin(distances, tolerance_);
  const auto rank = static_cast<std::ptrdiff_t>(kSymmetricShare * static_cast<double>(distances.size() - 1));
  std::nth_element(distances.begin(), distances.begin() + rank, distances.end());
  evidence.deviation = distances[rank];
  return evidence;
}

}  // namespace pcl_symmetry::apps
