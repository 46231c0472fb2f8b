#include "evaluate/segmentation/mirror_agreement.h"

#include <Eigen/Core>
#include <algorithm>

#include "pcl_symmetry/core/neighbours/closest_point_search.h"

namespace pcl_symmetry::apps {

double mirrorAgreement(const SurfaceGraph& graph, const std::vector<int>& labels, const ReflectionPlane& plane) {
  Points reflected(3, graph.centers.cols());
  for (Eigen::Index i = 0; i < reflected.cols(); ++i)
    reflected.col(i) = plane.reflect(graph.centers.col(i).cast<double>()).cast<float>();
  std::vector<int> closest;
  std::vector<float> sq_distances;
  makeTreeSearch(graph.centers)->search(reflected, 1, closest, sq_distances);
  const int num_segments = 1 + *std::max_element(labels.begin(), labels.end());
  Eigen::MatrixXd received = Eigen::MatrixXd::Zero(num_segments, num_segments);  // by segment of the reflection, own
  for (std::size_t i = 0; i < labels.size(); ++i) received(labels[closest[i]], labels[i]) += graph.areas[i];
  return received.colwise().maxCoeff().sum() / received.sum();
}

}  // namespace pcl_symmetry::apps
