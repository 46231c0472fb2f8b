#include "evaluate/segmentation/mirror_agreement.h"

#include <Eigen/Core>
#include <algorithm>

#include "core/segmentation/merging/mirrored_labels.h"

namespace pcl_symmetry::apps {

double mirrorAgreement(const SurfaceGraph& graph, const std::vector<int>& labels, const ReflectionPlane& plane) {
  const std::vector<int> closest = reflectedElements(graph, plane);
  const int num_segments = 1 + *std::max_element(labels.begin(), labels.end());
  Eigen::MatrixXd received = Eigen::MatrixXd::Zero(num_segments, num_segments);  // by segment of the reflection, own
  for (std::size_t i = 0; i < labels.size(); ++i) received(labels[closest[i]], labels[i]) += graph.areas[i];
  return received.colwise().maxCoeff().sum() / received.sum();
}

}  // namespace pcl_symmetry::apps
