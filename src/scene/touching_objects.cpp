#include "scene/touching_objects.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "core/base/constants.h"
#include "core/neighbours/closest_point_grid.h"
#include "pcl_symmetry/core/neighbours/closest_point_search.h"

namespace pcl_symmetry::detail {

namespace {

// Points of a cluster that planes are judged by, and points that they may fall on. chosen: cuts are as fine as these
// are apart; half cuts off more of the other part, twice takes twice the time.
constexpr int kJudgedPoints = 500, kSurfacePoints = 2000;
// Directions and places of upright planes. chosen: 6 degrees and a twenty-fourth of the cluster, within the tolerance
// below; half misses planes of small parts, twice takes four times as long.
constexpr int kNumAngles = 30, kNumOffsets = 24;
// Radii of the cluster, within which a reflected point meets the surface. derived: half a step of the angles moves a
// point half a radius away by 0.03, half a step of the places by 0.04.
constexpr double kMeets = 0.08;
// Share of the points that a plane has to explain to be one of a part, that each part holds, and that two planes
// explain beyond the best single one. chosen: half cuts handles and lids off, twice cuts equal objects only.
constexpr double kLeastExplained = 0.15, kLeastPart = 0.12, kLeastGain = 0.15;
// Planes that pairs are made of, and cuts that are returned. chosen: twice takes four times as long; half loses pairs
// of small parts.
constexpr std::size_t kMostUpright = 300, kMostCuts = 6;
// Neighbours that decide by vote to which part a point belongs. chosen: half leaves islands, twice rounds corners off.
constexpr int kVoters = 9;
// Share of the points by which two cuts differ. chosen: half tries nearly the same cut again, twice misses others.
constexpr double kOtherCut = 0.1;
// Share of the points below a foot. chosen: flying points lie below; at five times as many, the lowest of the points
// are a twentieth of the height up.
constexpr double kFootShare = 0.01;

/// What a plane says of a point: +1 its reflection meets the surface, -1 it lies where the sensor saw nothing, 0
/// nobody saw that place, or the point is on the plane.
using Opinions = std::vector<std::int8_t>;

int sumOf(const Opinions& opinions) {
  int sum = 0;
  for (const std::int8_t opinion : opinions) sum += opinion;
  return sum;
}

Points pointsOf(const SymmetryScene::Cloud& scene, const pcl::Indices& indices, int most) {
  const auto size = std::min<std::size_t>(indices.size(), static_cast<std::size_t>(most));
  Points points(3, static_cast<Eigen::Index>(size));
  for (std::size_t i = 0; i < size; ++i)
    points.col(static_cast<Eigen::Index>(i)) = scene[indices[i * indices.size() / size]].getVector3fMap();
  return points;
}

/// What upright planes say of the points of a cluster.
class PlaneOpinions {
public:
  PlaneOpinions(const SymmetryScene::Cloud& scene, const pcl::Indices& cluster, const Visibility& seen)
      : judged_(pointsOf(scene, cluster, kJudgedPoints)),
        surface_(pointsOf(scene, cluster, kSurfacePoints)),
        grid_(surface_),
        seen_(seen),
        reach_(kMeets * boundingBall(surface_).radius) {}

  const Points& judged() const { return judged_; }

  Opinions of(const ReflectionPlane& plane) const {
    Opinions opinions(static_cast<std::size_t>(judged_.cols()), 0);
    for (Eigen::Index i = 0; i < judged_.cols(); ++i) {
      const Eigen::Vector3d x = judged_.col(i).cast<double>();
      if (std::abs(plane.signedDistance(x)) < reach_) continue;
      const Eigen::Vector3d reflected = plane.reflect(x);
      const Eigen::Vector3f at = reflected.cast<float>();
      if ((surface_.col(grid_.closest(at)) - at).norm() < reach_)
        opinions[static_cast<std::size_t>(i)] = 1;
      else if (seen_.depthBehind(reflected) < -reach_)
        opinions[static_cast<std::size_t>(i)] = -1;
    }
    return opinions;
  }

private:
  const Points judged_, surface_;
  const ClosestPointGrid grid_;
  const Visibility& seen_;
  const double reach_;
};

/// Opinions of the planes upright on a support that explain enough of a cluster, most first.
std::vector<Opinions> uprightOpinions(const PlaneOpinions& cluster, const Eigen::Vector3d& up) {
  const Eigen::Vector3d u = up.unitOrthogonal(), v = up.cross(u);
  std::vector<std::pair<int, Opinions>> ranked;
  const auto least = static_cast<int>(kLeastExplained * static_cast<double>(cluster.judged().cols()));
  for (int a = 0; a < kNumAngles; ++a) {
    const Eigen::Vector3d normal = std::cos(kPi * a / kNumAngles) * u + std::sin(kPi * a / kNumAngles) * v;
    const Eigen::RowVectorXf along = normal.cast<float>().transpose() * cluster.judged();
    const double low = along.minCoeff(), high = along.maxCoeff();
    for (int r = 0; r < kNumOffsets; ++r) {
      Opinions opinions = cluster.of(ReflectionPlane(normal, low + (r + 0.5) / kNumOffsets * (high - low)));
      const auto explained = static_cast<int>(std::count(opinions.begin(), opinions.end(), 1));
      if (explained >= least) ranked.emplace_back(explained, std::move(opinions));
    }
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  if (ranked.size() > kMostUpright) ranked.resize(kMostUpright);
  std::vector<Opinions> all;
  for (auto& [explained, opinions] : ranked) all.push_back(std::move(opinions));
  return all;
}

/// How two planes share the judged points.
struct Sharing {
  int explained = 0;          ///< sum of the better opinions
  int first = 0, second = 0;  ///< points that are better with one of them
  std::size_t a = 0, b = 0;   ///< the planes
};

Sharing sharingOf(const Opinions& a, const Opinions& b) {
  Sharing sharing;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sharing.explained += std::max(a[i], b[i]);
    sharing.first += a[i] > b[i] ? 1 : 0;
    sharing.second += b[i] > a[i] ? 1 : 0;
  }
  return sharing;
}

std::vector<Sharing> bestSharings(const std::vector<Opinions>& planes, std::size_t num_points) {
  int single = 0;
  for (const Opinions& plane : planes) single = std::max(single, sumOf(plane));
  const double gain = kLeastGain * static_cast<double>(num_points), part = kLeastPart * static_cast<double>(num_points);
  std::vector<Sharing> sharings;
  for (std::size_t a = 0; a < planes.size(); ++a)
    for (std::size_t b = a + 1; b < planes.size(); ++b) {
      Sharing sharing = sharingOf(planes[a], planes[b]);
      if (sharing.explained < single + gain || std::min(sharing.first, sharing.second) < part) continue;
      sharing.a = a;
      sharing.b = b;
      sharings.push_back(sharing);
    }
  std::stable_sort(sharings.begin(), sharings.end(),
                   [](const Sharing& x, const Sharing& y) { return x.explained > y.explained; });
  return sharings;
}

/// +1 for the points of the cluster that belong to the first plane, -1 for those of the second: by the vote of judged
/// points around them that are not equally well off with both.
std::vector<std::int8_t> sidesOfPoints(const Points& cluster, const Points& judged, const Opinions& a,
                                       const Opinions& b) {
  std::vector<Eigen::Index> voters;
  for (Eigen::Index i = 0; i < judged.cols(); ++i)
    if (a[static_cast<std::size_t>(i)] != b[static_cast<std::size_t>(i)]) voters.push_back(i);
  Points places(3, static_cast<Eigen::Index>(voters.size()));
  for (std::size_t i = 0; i < voters.size(); ++i) places.col(static_cast<Eigen::Index>(i)) = judged.col(voters[i]);
  std::vector<int> closest;
  std::vector<float> sq_distances;
  const int num_voters = std::min<int>(kVoters, static_cast<int>(voters.size()));
  makeTreeSearch(places)->search(cluster, num_voters, closest, sq_distances);
  std::vector<std::int8_t> sides(static_cast<std::size_t>(cluster.cols()));
  for (std::size_t i = 0; i < sides.size(); ++i) {
    int vote = 0;
    for (int k = 0; k < num_voters; ++k) {
      const auto voter = static_cast<std::size_t>(voters[static_cast<std::size_t>(closest[i * num_voters + k])]);
      vote += a[voter] > b[voter] ? 1 : -1;
    }
    sides[i] = vote > 0 ? 1 : -1;
  }
  return sides;
}

/// Share of the points that two cuts put on other sides.
double differenceOf(const std::vector<std::int8_t>& one, const std::vector<std::int8_t>& other) {
  std::size_t differ = 0;
  for (std::size_t i = 0; i < one.size(); ++i) differ += one[i] != other[i] ? 1 : 0;
  const double share = static_cast<double>(differ) / static_cast<double>(one.size());
  return std::min(share, 1.0 - share);
}

}  // namespace

std::vector<TouchingParts> touchingParts(const SymmetryScene::Cloud& scene, const pcl::Indices& cluster,
                                         const Visibility& seen, const Eigen::Vector4d& support, int least,
                                         double stands) {
  const PlaneOpinions opinions(scene, cluster, seen);
  const std::vector<Opinions> planes = uprightOpinions(opinions, support.head<3>());
  const Points points = pointsOf(scene, cluster, static_cast<int>(cluster.size()));
  std::vector<TouchingParts> cuts;
  std::vector<std::vector<std::int8_t>> tried;
  for (const Sharing& sharing : bestSharings(planes, static_cast<std::size_t>(opinions.judged().cols()))) {
    const auto sides = sidesOfPoints(points, opinions.judged(), planes[sharing.a], planes[sharing.b]);
    const bool is_known = std::any_of(tried.begin(), tried.end(), [&](const std::vector<std::int8_t>& other) {
      return differenceOf(sides, other) < kOtherCut;
    });
    if (is_known) continue;
    tried.push_back(sides);
    TouchingParts parts;
    for (std::size_t i = 0; i < cluster.size(); ++i) (sides[i] > 0 ? parts.first : parts.second).push_back(cluster[i]);
    const auto is_object = [&](const pcl::Indices& part) {
      return part.size() >= static_cast<std::size_t>(least) && footOf(scene, part, support) <= stands;
    };
    if (is_object(parts.first) && is_object(parts.second)) cuts.push_back(std::move(parts));
    if (tried.size() == kMostCuts) break;
  }
  return cuts;
}

double contradictedShare(const SymmetryScene::Cloud& scene, const pcl::Indices& points, const Visibility& seen,
                         const ReflectionPlane& plane) {
  const Points judged = pointsOf(scene, points, kJudgedPoints);
  const double margin = kMeets * boundingBall(judged).radius;
  double count = 0.0;
  for (Eigen::Index i = 0; i < judged.cols(); ++i)
    count += seen.depthBehind(plane.reflect(judged.col(i).cast<double>())) < -margin ? 1.0 : 0.0;
  return count / static_cast<double>(judged.cols());
}

double footOf(const SymmetryScene::Cloud& scene, const pcl::Indices& points, const Eigen::Vector4d& support) {
  std::vector<double> heights;
  for (const pcl::index_t i : points)
    heights.push_back(support.dot(scene[i].getVector3fMap().cast<double>().homogeneous().eval()));
  const auto foot = heights.begin() + static_cast<std::ptrdiff_t>(kFootShare * static_cast<double>(heights.size()));
  std::nth_element(heights.begin(), foot, heights.end());
  return *foot;
}

}  // namespace pcl_symmetry::detail
