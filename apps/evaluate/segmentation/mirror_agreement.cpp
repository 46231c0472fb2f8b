#include "evaluate/segmentation/mirror_agreement.h"

#include <limits>

#include "pcl_symmetry/core/neighbours/closest_point_search.h"

namespace pcl_symmetry::apps {

namespace {

double agreementAcross(const SurfaceGraph& graph, const std::vector<int>& labels, const ReflectionPlane& plane,
                       const std::vector<int>& image) {
  Points reflected(3, graph.centers.cols());
  for (Eigen::Index i = 0; i < reflected.cols(); ++i)
    reflected.col(i) = plane.reflect(graph.centers.col(i).cast<double>()).cast<float>();
  std::vector<int> closest;
  std::vector<float> sq_distances;
  makeTreeSearch(graph.centers)->search(reflected, 1, closest, sq_distances);
  double area = 0.0, agreeing = 0.0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    area += graph.areas[i];
    if (labels[closest[i]] == image[labels[i]]) agreeing += graph.areas[i];
  }
  return agreeing / area;
}

}  // namespace

double mirrorAgreement(const SurfaceGraph& graph, const Segmentation& segmentation, double min_share) {
  if (segmentation.tree.empty()) return std::numeric_limits<double>::quiet_NaN();
  const std::vector<PartPlane>& planes = segmentation.tree.front().planes;
  std::size_t next = 0;  // among those with images, which are the stronger ones in the same order
  for (const PartPlane& part : planes) {
    if (next >= segmentation.images.size()) break;
    if (part.share < kMappedShare) continue;
    const std::vector<int>& image = segmentation.images[next++];
    if (part.share >= min_share) return agreementAcross(graph, segmentation.labels, part.plane, image);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace pcl_symmetry::apps
