#include "evaluate/segmentation/segmentation_distance.h"

#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <stdexcept>

namespace pcl_symmetry::apps {

namespace {

using Table = Eigen::MatrixXd;

double numPairs(double n) {
  return 0.5 * n * (n - 1.0);
}

/// Pairs that both put together.
double pairsTogether(const Table& counts) {
  return counts.unaryExpr(&numPairs).sum();
}

/// Share of the pairs of faces on which two segmentations differ.
/// \param counts faces in both of two segments.
double randDistance(const Table& counts) {
  const double all = numPairs(counts.sum());
  if (all == 0.0) return 0.0;
  const Table rows = counts.rowwise().sum(), columns = counts.colwise().sum();
  return (pairsTogether(rows) + pairsTogether(columns) - 2.0 * pairsTogether(counts)) / all;
}

/// Local refinement errors, by rows: the share of a row's segment outside the column's.
Table refinementErrors(const Table& areas) {
  Table errors = Table::Zero(areas.rows(), areas.cols());
  for (Eigen::Index i = 0; i < areas.rows(); ++i) {
    const double whole = areas.row(i).sum();
    if (whole > 0.0) errors.row(i) = 1.0 - areas.row(i).array() / whole;
  }
  return errors;
}

}  // namespace

SegmentationComparison::SegmentationComparison(const pcl::PolygonMesh& mesh) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  if (mesh.cloud.width > 0) pcl::fromPCLPointCloud2(mesh.cloud, cloud);
  for (const pcl::PointXYZ& point : cloud) vertices_.emplace_back(point.getVector3fMap());

  std::map<std::pair<int, int>, std::vector<int>> faces_of_edge;
  std::vector<Eigen::Vector3d> centers;
  for (std::size_t f = 0; f < mesh.polygons.size(); ++f) {
    const auto& corners = mesh.polygons[f].vertices;
    Eigen::Vector3d twice_area = Eigen::Vector3d::Zero(), center = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const int a = static_cast<int>(corners[k]), b = static_cast<int>(corners[(k + 1) % corners.size()]);
      if (a < 0 || static_cast<std::size_t>(a) >= vertices_.size())
        throw std::invalid_argument("face " + std::to_string(f) + ": vertex " + std::to_string(a) + " does not exist");
      faces_of_edge[std::minmax(a, b)].push_back(static_cast<int>(f));
      center += vertices_[a].cast<double>() / static_cast<double>(corners.size());
      if (k < 2) continue;
      const Eigen::Vector3d p = vertices_[corners[0]].cast<double>(), q = vertices_[corners[k - 1]].cast<double>();
      twice_area += (q - p).cross(vertices_[a].cast<double>() - p);
    }
    areas_.push_back(0.5 * twice_area.norm());
    centers.push_back(center);
  }

  double area = 0.0;
  Eigen::Vector3d center_of_mass = Eigen::Vector3d::Zero();
  for (std::size_t f = 0; f < areas_.size(); ++f) {
    area += areas_[f];
    center_of_mass += areas_[f] * centers[f];
  }
  center_of_mass /= std::max(area, 1e-300);
  for (std::size_t f = 0; f < areas_.size(); ++f) {
    areas_[f] /= std::max(area, 1e-300);
    mean_radius_ += areas_[f] * (centers[f] - center_of_mass).norm();
  }

  first_neighbour_.assign(vertices_.size() + 1, 0);
  for (const auto& [ends, faces] : faces_of_edge) {
    const float length = (vertices_[ends.first] - vertices_[ends.second]).norm();
    edges_.push_back({ends.first, ends.second, faces, length});
    ++first_neighbour_[ends.first + 1];
    ++first_neighbour_[ends.second + 1];
  }
  for (std::size_t v = 0; v < vertices_.size(); ++v) first_neighbour_[v + 1] += first_neighbour_[v];
  neighbours_.resize(2 * edges_.size());
  std::vector<int> next(first_neighbour_.begin(), first_neighbour_.end() - 1);
  for (const Edge& edge : edges_) {
    neighbours_[next[edge.begin]++] = {edge.end, edge.length};
    neighbours_[next[edge.end]++] = {edge.begin, edge.length};
  }
}

PreparedSegmentation SegmentationComparison::prepare(const std::vector<int>& labels) const {
  if (labels.size() != numFaces())
    throw std::invalid_argument(std::to_string(labels.size()) + " labels, must be one for each of " +
                                std::to_string(numFaces()) + " faces");
  PreparedSegmentation prepared;
  std::map<int, int> compact;
  for (const int label : labels)
    prepared.labels.push_back(compact.emplace(label, static_cast<int>(compact.size())).first->second);
  prepared.num_segments = static_cast<int>(compact.size());
  for (const Edge& edge : edges_) {
    const auto differs = [&](int face) { return prepared.labels[face] != prepared.labels[edge.faces.front()]; };
    if (std::any_of(edge.faces.begin(), edge.faces.end(), differs)) prepared.cuts.emplace_back(edge.begin, edge.end);
  }
  if (!prepared.cuts.empty()) prepared.distance = distancesFrom(prepared.cuts);
  return prepared;
}

std::vector<float> SegmentationComparison::distancesFrom(const std::vector<std::pair<int, int>>& cuts) const {
  std::vector<float> distance(vertices_.size(), std::numeric_limits<float>::infinity());
  using Entry = std::pair<float, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const auto& [a, b] : cuts)
    for (const int v : {a, b}) {
      if (distance[v] == 0.0f) continue;
      distance[v] = 0.0f;
      queue.emplace(0.0f, v);
    }
  while (!queue.empty()) {
    const auto [d, v] = queue.top();
    queue.pop();
    if (d > distance[v]) continue;
    for (int i = first_neighbour_[v]; i < first_neighbour_[v + 1]; ++i) {
      const auto& [to, length] = neighbours_[i];
      if (d + length >= distance[to]) continue;
      distance[to] = d + length;
      queue.emplace(distance[to], to);
    }
  }
  return distance;
}

double SegmentationComparison::meanDistance(const PreparedSegmentation& from, const PreparedSegmentation& to) const {
  double sum = 0.0, length = 0.0;
  for (const auto& [a, b] : from.cuts) {
    const double weight = (vertices_[a] - vertices_[b]).norm();
    const double distance = 0.5 * (to.distance[a] + to.distance[b]);
    if (!std::isfinite(distance)) continue;  // in a component without a cut
    sum += weight * distance;
    length += weight;
  }
  return length > 0.0 ? sum / (length * mean_radius_) : std::numeric_limits<double>::quiet_NaN();
}

SegmentationDistance SegmentationComparison::compare(const PreparedSegmentation& reference,
                                                     const PreparedSegmentation& other) const {
  Table counts = Table::Zero(reference.num_segments, other.num_segments), areas = counts;
  for (std::size_t f = 0; f < numFaces(); ++f) {
    counts(reference.labels[f], other.labels[f]) += 1.0;
    areas(reference.labels[f], other.labels[f]) += areas_[f];
  }
  SegmentationDistance d;
  d.rand = randDistance(counts);
  if (!reference.cuts.empty() && !other.cuts.empty())
    d.cut_discrepancy = meanDistance(reference, other) + meanDistance(other, reference);
  d.hamming_missing = std::max(0.0, 1.0 - areas.rowwise().maxCoeff().sum());
  d.hamming_false = std::max(0.0, 1.0 - areas.colwise().maxCoeff().sum());
  d.hamming = 0.5 * (d.hamming_missing + d.hamming_false);
  const Table first = refinementErrors(areas), second = refinementErrors(areas.transpose()).transpose();
  d.global_consistency = std::min(areas.cwiseProduct(first).sum(), areas.cwiseProduct(second).sum());
  d.local_consistency = areas.cwiseProduct(first.cwiseMin(second)).sum();
  return d;
}

}  // namespace pcl_symmetry::apps
