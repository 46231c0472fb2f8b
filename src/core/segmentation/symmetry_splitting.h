#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/surface_segmentation.h"

namespace pcl_symmetry {

struct Clusters {
  std::vector<int> labels;  ///< N, in [0, K)
  Eigen::MatrixXf centers;  ///< D x K; K < num_clusters if there are fewer distinct features of positive weight
  double sq_error = 0.0;    ///< weighted sum of the squared distances from the centers
};

/// Lloyd's k-means on weighted features, from starts that lie far apart (k-means++, Arthur and Vassilvitskii 2007).
/// \param features D x N, finite, N >= 1.
/// \param weights N values >= 0, not all 0.
/// \param num_clusters k, >= 1.
/// \param seed seed of the starts.
/// \return the clusters of the best of four runs.
Clusters kMeans(const Eigen::MatrixXf& features, const std::vector<float>& weights, int num_clusters,
                std::uint64_t seed = 1);

/// The paper's segmentation (Section 5.3): parts are split in two, the largest part first, until the depth or the
/// number of parts is reached or no plane maps between 10 % and 90 % of a part onto itself.
/// \param graph N elements with an area > 0.
/// \return labels and tree; no images.
Segmentation segmentBySplitting(const SurfaceGraph& graph, const SegmentationOptions& options);

}  // namespace pcl_symmetry
