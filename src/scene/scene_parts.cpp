#include "scene/scene_parts.h"

#include <pcl/common/point_tests.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_plane.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/constants.h"
#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/geometry/cloud_extent.h"
#include "core/geometry/surface_normals.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "scene/scene_rules.h"

namespace pcl_symmetry::detail {

namespace {

/// A plane that sample consensus found in a set of points.
struct Consensus {
  Eigen::Vector4d coefficients;
  pcl::Indices inliers;  // into the scene
};

/// A factor, a power of two, that scales scenes of any unit alike: PCL's model of planes rejects three samples by an
/// absolute area, and prints a message.
/// \param distance distance of points that belong together.
float unitScale(double distance) {
  return static_cast<float>(std::exp2(std::round(-std::log2(distance))));
}

SymmetryScene::Cloud::ConstPtr scaled(const SymmetryScene::Cloud& scene, float factor) {
  auto cloud = pcl::make_shared<SymmetryScene::Cloud>(scene);
  for (pcl::PointXYZ& point : *cloud) point.getVector3fMap() *= factor;
  return cloud;
}

std::optional<Consensus> greatestPlane(const SymmetryScene::Cloud::ConstPtr& scene, const pcl::Indices& points,
                                       double distance) {
  if (points.size() < 3) return std::nullopt;
  // Does what pcl::SACSegmentation does, without its other models.
  using Model = pcl::SampleConsensusModelPlane<pcl::PointXYZ>;
  pcl::Indices some;
  const std::size_t stride = 1 + (points.size() - 1) / kScene.consensus_points;
  for (std::size_t i = 0; i < points.size(); i += stride) some.push_back(points[i]);
  pcl::RandomSampleConsensus<pcl::PointXYZ> consensus(pcl::make_shared<Model>(scene, some), distance);
  consensus.setMaxIterations(kScene.consensus_iterations);
  if (!consensus.computeModel()) return std::nullopt;
  checkCancelled();
  Consensus plane;
  Eigen::VectorXf found, coefficients;
  consensus.getModelCoefficients(found);
  const auto model = pcl::make_shared<Model>(scene, points);
  model->selectWithinDistance(found, distance, plane.inliers);
  model->optimizeModelCoefficients(plane.inliers, found, coefficients);
  model->selectWithinDistance(coefficients, distance, plane.inliers);
  if (plane.inliers.empty() || coefficients.size() != 4) return std::nullopt;
  plane.coefficients = coefficients.cast<double>() / coefficients.head<3>().cast<double>().norm();
  return plane;
}

/// The least-squares plane of the points nearest to a plane: sample consensus ends with a plane through three of them,
/// which is tilted by their noise and by points of objects that stand on it.
Eigen::Vector4d fitPlane(const SymmetryScene::Cloud& scene, const Consensus& plane) {
  Eigen::Vector4d coefficients = plane.coefficients;
  for (int round = 0; round < kScene.fit_rounds; ++round) {
    const auto height = [&](pcl::index_t i) { return std::abs(heightOver(coefficients, scene[i])); };
    std::vector<double> heights;
    for (const pcl::index_t i : plane.inliers) heights.push_back(height(i));
    const double max_height = kScene.fit_deviations * median(std::move(heights));
    pcl::Indices near;
    for (const pcl::index_t i : plane.inliers)
      if (height(i) <= max_height) near.push_back(i);
    const PrincipalAxes axes = principalAxes(pointsOf(scene, near));
    Eigen::Vector3d normal = axes.axes.col(2);
    if (normal.dot(coefficients.head<3>()) < 0.0) normal = -normal;
    coefficients << normal, -normal.dot(axes.center);
  }
  return coefficients;
}

/// Numbers of points above and below a plane.
struct Sides {
  std::size_t above = 0, below = 0;  ///< within its extent
  std::size_t attached = 0;          ///< close below it, also beyond its extent
};

Sides sidesOf(const SymmetryScene::Cloud& scene, const Consensus& plane, const pcl::Indices& others, double distance) {
  const Eigen::Vector3d n = plane.coefficients.head<3>(), u = n.unitOrthogonal(), v = n.cross(u);
  const auto along = [&](pcl::index_t i, const Eigen::Vector3d& axis) {
    return axis.dot(scene[i].getVector3fMap().cast<double>());
  };
  const auto extent = [&](const Eigen::Vector3d& axis) {
    std::vector<double> positions;
    for (const pcl::index_t i : plane.inliers) positions.push_back(along(i, axis));
    const auto num_cut = static_cast<std::size_t>(kScene.footprint_trim * static_cast<double>(positions.size() - 1));
    return trimmedExtent(std::move(positions), num_cut);
  };
  const auto [u_low, u_high] = extent(u);
  const auto [v_low, v_high] = extent(v);
  Sides sides;
  for (const pcl::index_t i : others) {
    const double height = along(i, n) + plane.coefficients[3], at_u = along(i, u), at_v = along(i, v);
    sides.attached += height < -distance && height > -kScene.attached * distance ? 1 : 0;
    if (std::abs(height) <= distance || at_u < u_low || at_u > u_high || at_v < v_low || at_v > v_high) continue;
    ++(height > 0.0 ? sides.above : sides.below);
  }
  return sides;
}

pcl::Indices without(const pcl::Indices& points, const pcl::Indices& removed, std::size_t scene_size) {
  std::vector<char> gone(scene_size, 0);
  for (const pcl::index_t i : removed) gone[i] = 1;
  pcl::Indices rest;
  for (const pcl::index_t i : points)
    if (!gone[i]) rest.push_back(i);
  return rest;
}

bool isRemainder(const SymmetryScene::Cloud& scene, const pcl::Indices& cluster, const SupportingPlane& support,
                 double distance) {
  const auto num_near = std::count_if(cluster.begin(), cluster.end(), [&](pcl::index_t i) {
    return std::abs(heightOver(support.coefficients, scene[i])) <= kScene.remainder * distance;
  });
  return static_cast<double>(num_near) > kScene.remainder_share * static_cast<double>(cluster.size());
}

bool carries(const SupportingPlane& support, const Points& object, double margin) {
  const Eigen::RowVector3f normal = support.coefficients.head<3>().cast<float>();
  const auto offset = static_cast<float>(support.coefficients[3] + margin);
  const auto num_above = ((normal * object).array() > -offset).count();
  return static_cast<double>(num_above) >= kScene.above_share * static_cast<double>(object.cols());
}

/// Standard deviation of the inverse depths of a camera, from the points of a plane.
double inverseDepthErrorOn(const SupportingPlane& support, const SymmetryScene::Cloud& scene,
                           const Eigen::Vector3d& viewpoint) {
  std::vector<double> errors;
  for (const pcl::index_t i : support.indices)
    errors.push_back(std::abs(heightOver(support.coefficients, scene[i])) /
                     (scene[i].getVector3fMap().cast<double>() - viewpoint).norm());
  const double height = support.coefficients.dot(viewpoint.homogeneous());
  return errors.empty() || !(height > 0.0) ? 0.0 : kDeviationPerMedian * median(std::move(errors)) / height;
}

Eigen::AlignedBox3f boxAround(const SymmetryScene::Cloud& scene, const pcl::Indices& points, double margin) {
  Eigen::AlignedBox3f box;
  for (const pcl::index_t i : points) box.extend(Eigen::Vector3f(scene[i].getVector3fMap()));
  box.min().array() -= static_cast<float>(margin);
  box.max().array() += static_cast<float>(margin);
  return box;
}

/// The height to which noise raises points of a support around a cluster.
/// \return input units, > 0; infinity if few points of the support are around the cluster.
double riseOfNoise(const SymmetryScene::Cloud& scene, const SupportingPlane& support, const pcl::Indices& cluster,
                   const SceneDistances& distances) {
  const Eigen::AlignedBox3f around = boxAround(scene, cluster, kScene.around * distances.cluster);
  std::vector<double> heights;
  for (const pcl::index_t i : support.indices)
    if (around.contains(Eigen::Vector3f(scene[i].getVector3fMap())))
      heights.push_back(std::abs(heightOver(support.coefficients, scene[i])));
  if (heights.size() < kScene.min_around) return std::numeric_limits<double>::infinity();
  return std::max(kScene.rises_at_least * distances.spacing,
                  kScene.rises * kDeviationPerMedian * median(std::move(heights)));
}

/// For each point of a scene, the squared distance from the nearest cluster and the number of that cluster; -1 = none.
using NearestClusters = std::vector<std::pair<float, int>>;

/// Assigns to a cluster the points of the supports that may be its feet.
void offerFeet(const SymmetryScene::Cloud& scene, const std::vector<SupportingPlane>& supports,
               const pcl::Indices& cluster, int number, const SceneDistances& distances, NearestClusters& nearest) {
  const Eigen::AlignedBox3f near = boxAround(scene, cluster, distances.cluster);
  pcl::Indices risen;
  for (const SupportingPlane& support : supports) {
    const double min_height = riseOfNoise(scene, support, cluster, distances);
    for (const pcl::index_t i : support.indices)
      if (near.contains(Eigen::Vector3f(scene[i].getVector3fMap())) &&
          heightOver(support.coefficients, scene[i]) > min_height)
        risen.push_back(i);
  }
  const std::vector<float> sq_distances = sqDistancesFrom(pointsOf(scene, cluster), pointsOf(scene, risen));
  for (std::size_t i = 0; i < risen.size(); ++i)
    if (sq_distances[i] <= distances.cluster * distances.cluster && sq_distances[i] < nearest[risen[i]].first)
      nearest[risen[i]] = {sq_distances[i], number};
}

/// Whether the surface continues at the outline of a cluster, and nowhere ends in front of something farther away.
bool goesOn(const SymmetryScene::Cloud& frame, const pcl::Indices& cluster, const Visibility& seen, double distance) {
  std::vector<char> is_inside(frame.size(), 0);
  for (const pcl::index_t i : cluster) is_inside[i] = 1;
  const Eigen::Vector3d viewpoint = seen.viewpoint();
  const auto width = static_cast<std::ptrdiff_t>(frame.width), height = static_cast<std::ptrdiff_t>(frame.height);
  double num_ends = 0.0, num_going_on = 0.0, num_before_farther = 0.0;
  for (const pcl::index_t i : cluster) {
    const Eigen::Vector3d x = frame[i].getVector3fMap().cast<double>();
    for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const std::ptrdiff_t u = i % width + dx, v = i / width + dy;
      const bool is_in_picture = u >= 0 && v >= 0 && u < width && v < height;
      const auto next = static_cast<std::size_t>(is_in_picture ? v * width + u : i);
      if (is_in_picture && is_inside[next]) continue;
      num_ends += 1.0;
      if (!is_in_picture || !pcl::isXYZFinite(frame[next])) continue;
      const Eigen::Vector3d beside = frame[next].getVector3fMap().cast<double>();
      if ((beside - x).norm() < distance + kScene.depth_errors * seen.depthError(x))
        num_going_on += 1.0;
      else if ((beside - viewpoint).norm() > (x - viewpoint).norm())
        num_before_farther += 1.0;
    }
  }
  return num_going_on > kScene.goes_on * num_ends && num_before_farther < kScene.before_farther * num_ends;
}

}  // namespace

double heightOver(const Eigen::Vector4d& plane, const pcl::PointXYZ& point) {
  return plane.dot(point.getVector3fMap().cast<double>().homogeneous().eval());
}

Points pointsOf(const SymmetryScene::Cloud& scene, const pcl::Indices& indices) {
  Points points(3, indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) points.col(i) = scene[indices[i]].getVector3fMap();
  return points;
}

std::vector<float> sqDistancesFrom(const Points& surface, const Points& points) {
  std::vector<int> closest;
  std::vector<float> sq_distances;
  makeFlannSearch(surface)->search(points, 1, closest, sq_distances);
  return sq_distances;
}

SceneDistances sceneDistances(const SymmetryScene::Cloud& scene, const pcl::Indices& points) {
  const Points surface = pointsOf(scene, points);
  const std::size_t stride = 1 + (points.size() - 1) / kScene.scale_samples;
  Points positions(3, (points.size() + stride - 1) / stride);
  for (Eigen::Index i = 0; i < positions.cols(); ++i)
    positions.col(i) = surface.col(i * static_cast<Eigen::Index>(stride));
  const auto search = makeFlannSearch(surface);
  checkCancelled();
  const int num_neighbors = static_cast<int>(std::min<std::size_t>(kNumSupportNeighbors + 1, points.size()));
  std::vector<int> closest;
  std::vector<float> sq_distances;
  search->search(positions, num_neighbors, closest, sq_distances);
  std::vector<float> spacings(positions.cols());
  for (std::size_t i = 0; i < spacings.size(); ++i)
    // As in LocalGeometry::spacing, pi r^2 holds the neighbors within r.
    spacings[i] =
        std::sqrt(static_cast<float>(kPi) * sq_distances[(i + 1) * static_cast<std::size_t>(num_neighbors) - 1] /
                  static_cast<float>(std::max(1, num_neighbors - 1)));
  const double spacing = median(std::move(spacings));
  const double roughness = median(localGeometryAt(surface, *search, positions).roughness);
  return {spacing, kScene.plane_spacings * spacing + kScene.plane_roughnesses * roughness,
          kScene.cluster_spacings * spacing};
}

SeenSpace seenOfObject(const SeenSpace& seen, const SymmetryScene::Cloud& scene,
                       const std::vector<SupportingPlane>& supports, const pcl::Indices& object,
                       const SceneDistances& distances, double tolerance) {
  SeenSpace result = seen.withoutSupport();
  if (!seen.visibility() || supports.empty()) return result;
  const Points points = pointsOf(scene, object);
  const double off = std::max(tolerance * boxDiagonal(points), seen.visibility()->resolvedTolerance(points));
  const double max_rise = kScene.support_margin * distances.plane;
  for (const SupportingPlane& support : supports) {
    if (!carries(support, points, max_rise)) continue;
    // A symmetric surface may be off by the tolerance and by noise. A wider margin would leave unknown space below a
    // table, where reflections are not penalized.
    const double rise = riseOfNoise(scene, support, object, distances);
    result = result.withSupport(support.coefficients, std::min(max_rise, rise + off));
  }
  return result;
}

SeenSpace seenOfModel(const SeenSpace& seen, const SymmetryScene::Cloud& scene,
                      const std::vector<SupportingPlane>& supports, const pcl::Indices& object,
                      const SceneDistances& distances) {
  const Points points = pointsOf(scene, object);
  const auto support = std::find_if(supports.begin(), supports.end(), [&](const SupportingPlane& plane) {
    return carries(plane, points, kScene.support_margin * distances.plane);
  });
  if (!seen.visibility() || support == supports.end()) return seen;
  const SeenSpace standing = seen.withSupport(support->coefficients, kScene.model_margin * distances.plane);
  if (seen.source() != ViewpointSource::Rays) return standing;
  const double error = inverseDepthErrorOn(*support, scene, seen.visibility()->viewpoint());
  return {standing.visibility()->withDepthErrors(error), seen.source()};
}

SeenSpace standingInScene(const SeenSpace& seen, const SymmetryScene::Cloud::ConstPtr& scene, const pcl::Indices& part,
                          double tolerance) {
  pcl::Indices finite;
  for (std::size_t i = 0; i < scene->size(); ++i)
    if (pcl::isXYZFinite((*scene)[i])) finite.push_back(static_cast<pcl::index_t>(i));
  // A face of the object is not a table.
  const pcl::Indices others = without(finite, part, scene->size()), object = without(finite, others, scene->size());
  if (object.empty() || others.empty()) return seen;
  const SceneDistances distances = sceneDistances(*scene, others);
  if (!(distances.plane > 0.0)) return seen;
  const std::vector<SupportingPlane> supports =
      findSupports(scene, others, finite, seen.visibility()->viewpoint(), distances.plane);
  return seenOfObject(seen, *scene, supports, object, distances, tolerance);
}

std::vector<SupportingPlane> findSupports(const SymmetryScene::Cloud::ConstPtr& scene, const pcl::Indices& points,
                                          pcl::Indices others, const std::optional<Eigen::Vector3d>& viewpoint,
                                          double distance) {
  std::vector<SupportingPlane> supports;
  pcl::Indices candidates = points;
  const float scale = unitScale(distance);
  const SymmetryScene::Cloud::ConstPtr in_unit = scaled(*scene, scale);
  for (int round = 0; round < kScene.max_planes; ++round) {
    std::optional<Consensus> plane = greatestPlane(in_unit, candidates, scale * distance);
    const auto share = [&](std::size_t count) {
      return static_cast<double>(count) / static_cast<double>(points.size());
    };
    if (!plane || share(plane->inliers.size()) < kScene.min_share) break;
    checkCancelled();
    plane->coefficients[3] /= scale;
    plane->coefficients = fitPlane(*scene, *plane);
    candidates = without(candidates, plane->inliers, scene->size());
    if (viewpoint && plane->coefficients.dot(viewpoint->homogeneous()) < 0.0) plane->coefficients *= -1.0;
    checkCancelled();
    Sides sides = sidesOf(*scene, *plane, others, distance);
    if (!viewpoint && sides.below > sides.above) {
      plane->coefficients *= -1.0;
      std::swap(sides.above, sides.below);
    }
    const double few = kScene.telling_share * static_cast<double>(plane->inliers.size());
    const bool tells = static_cast<double>(sides.above + sides.below) > few;
    // Objects stand above a table; behind the face of a box, its other faces begin.
    const bool is_bare =
        share(plane->inliers.size()) >= kScene.bare_share && static_cast<double>(sides.attached) <= few;
    const bool supports_others = tells ? sides.above >= sides.below : is_bare;
    if (!supports_others) continue;
    others = without(others, plane->inliers, scene->size());
    supports.push_back({plane->coefficients, std::move(plane->inliers)});
  }
  return supports;
}

SupportingPlane supportOf(const SymmetryScene::Cloud& scene, const pcl::Indices& points,
                          const std::optional<Eigen::Vector3d>& viewpoint, const Eigen::Vector4d& plane,
                          double distance) {
  SupportingPlane support{plane, {}};
  std::size_t num_above = 0;
  for (const pcl::index_t i : points) {
    const double height = heightOver(plane, scene[i]);
    if (std::abs(height) <= distance) support.indices.push_back(i);
    num_above += height > 0.0 ? 1 : 0;
  }
  const bool is_up = viewpoint ? plane.dot(viewpoint->homogeneous()) >= 0.0 : 2 * num_above >= points.size();
  if (!is_up) support.coefficients *= -1.0;
  return support;
}

pcl::Indices withoutSupports(const pcl::Indices& points, const std::vector<SupportingPlane>& supports,
                             std::size_t scene_size) {
  pcl::Indices rest = points;
  for (const SupportingPlane& support : supports) rest = without(rest, support.indices, scene_size);
  return rest;
}

std::vector<pcl::Indices> findClusters(const SymmetryScene::Cloud::ConstPtr& scene, const pcl::Indices& points,
                                       const std::vector<SupportingPlane>& supports, const SceneDistances& distances,
                                       int min_points) {
  if (points.empty()) return {};
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
  extraction.setClusterTolerance(distances.cluster);
  extraction.setMinClusterSize(min_points);
  // PCL's own choice for organized clouds estimates the camera from these points, which are too few for that.
  extraction.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>(false));
  extraction.setInputCloud(scene);
  extraction.setIndices(pcl::make_shared<pcl::Indices>(points));
  checkCancelled();
  std::vector<pcl::PointIndices> found;
  extraction.extract(found);
  checkCancelled();
  std::vector<pcl::Indices> clusters;
  for (pcl::PointIndices& cluster : found) {
    const bool is_remainder = std::any_of(supports.begin(), supports.end(), [&](const SupportingPlane& support) {
      return isRemainder(*scene, cluster.indices, support, distances.plane);
    });
    if (!is_remainder) clusters.push_back(std::move(cluster.indices));
  }
  sortDescending(clusters, [](const pcl::Indices& cluster) { return cluster.size(); });
  return clusters;
}

void attachHiddenParts(const SymmetryScene::Cloud& scene, const Eigen::Vector3d& viewpoint, int min_points,
                       std::vector<pcl::Indices>& clusters) {
  const auto first_part = std::find_if(clusters.begin(), clusters.end(), [&](const pcl::Indices& cluster) {
    return static_cast<int>(cluster.size()) < min_points;
  });
  const std::vector<pcl::Indices> parts(first_part, clusters.end());
  clusters.erase(first_part, clusters.end());
  std::vector<int> body_of(scene.size(), -1);
  std::vector<double> diagonals;
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    for (const pcl::index_t i : clusters[k]) body_of[i] = static_cast<int>(k);
    diagonals.push_back(boxDiagonal(pointsOf(scene, clusters[k])));
  }
  const auto rangeOf = [&](int i) { return (scene[i].getVector3fMap().cast<double>() - viewpoint).norm(); };
  const int width = static_cast<int>(scene.width), height = static_cast<int>(scene.height);
  for (const pcl::Indices& part : parts) {
    std::vector<int> num_hiding(clusters.size() + 1, 0);  // pairs of pixels; the last is for no body
    for (const pcl::index_t i : part)
      for (int v = std::max(0, i / width - kScene.hidden_border);
           v <= std::min(height - 1, i / width + kScene.hidden_border); ++v)
        for (int u = std::max(0, i % width - kScene.hidden_border);
             u <= std::min(width - 1, i % width + kScene.hidden_border); ++u) {
          const int body = body_of[v * width + u];
          const double behind = body < 0 ? 0.0 : rangeOf(i) - rangeOf(v * width + u);
          if (behind > 0.0 && behind < diagonals[body]) ++num_hiding[body];
        }
    const auto most = std::max_element(num_hiding.begin(), num_hiding.end());
    if (*most > 0) append(clusters[most - num_hiding.begin()], part);
  }
}

void returnFeet(const SymmetryScene::Cloud& scene, std::vector<SupportingPlane>& supports,
                std::vector<pcl::Indices>& clusters, const SceneDistances& distances) {
  NearestClusters nearest(scene.size(), {std::numeric_limits<float>::max(), -1});
  for (std::size_t k = 0; k < clusters.size(); ++k)
    offerFeet(scene, supports, clusters[k], static_cast<int>(k), distances, nearest);
  for (SupportingPlane& support : supports) {
    pcl::Indices rest;
    for (const pcl::index_t i : support.indices) {
      const int owner = nearest[i].second;
      (owner < 0 ? rest : clusters[owner]).push_back(i);
    }
    support.indices = std::move(rest);
  }
  for (pcl::Indices& cluster : clusters) std::sort(cluster.begin(), cluster.end());
}

bool isBulge(const SymmetryScene::Cloud& frame, const pcl::Indices& cluster, const Visibility* seen, double tolerance,
             double distance) {
  if (!frame.isOrganized() || !seen) return false;
  const Points points = pointsOf(frame, cluster);
  const double thickness = std::sqrt(principalAxes(points).variances[2]);  // root mean square distance from their plane
  return thickness < kScene.bulge_tolerances * tolerance * boxDiagonal(points) &&
         goesOn(frame, cluster, *seen, distance);
}

}  // namespace pcl_symmetry::detail
