#pragma once

#include <pcl/features/feature.h>

#include <cstdint>

#include "core/descriptors/symmetry_descriptor.h"
#include "pcl_symmetry/point_types.h"
#include "pcl_symmetry/viewpoint.h"

namespace pcl_symmetry {

/// The planar-reflective symmetry transform as a global descriptor: one for the whole cloud (Section 5.2).
///
/// Honours setIndices; points that are not finite are left out. Needs no normals, no search radius and no neighbours.
/// Where the cloud has no extent the output is empty and PCL_ERROR says why.
///
/// \code
/// pcl_symmetry::PRSTEstimation<pcl::PointXYZ> estimation;
/// estimation.setInputCloud(cloud);
/// pcl::PointCloud<pcl_symmetry::PRSTSignature32768> descriptor;
/// estimation.compute(descriptor);
/// \endcode
template <typename PointInT, typename PointOutT = PRSTSignature32768>
class PRSTEstimation : public pcl::Feature<PointInT, PointOutT> {
public:
  using Ptr = pcl::shared_ptr<PRSTEstimation<PointInT, PointOutT>>;
  using ConstPtr = pcl::shared_ptr<const PRSTEstimation<PointInT, PointOutT>>;
  using PointCloudOut = typename pcl::Feature<PointInT, PointOutT>::PointCloudOut;

  PRSTEstimation() { this->feature_name_ = "PRSTEstimation"; }

  /// Describes the cloud in the axes that it has, about its center of mass, as the paper does with models that were
  /// aligned by hand; default: in its canonical frame, see SymmetryAlignment.
  void setUseInputAxes(bool use_input_axes) { use_input_axes_ = use_input_axes; }
  bool getUseInputAxes() const { return use_input_axes_; }
  /// Of the ball that is described, in mean distances of the points from its center, > 0; default 2.
  void setRadius(double radius);
  void setRandomSeed(std::uint64_t seed) { options_.seed = seed; }
  /// 0 = one per core (default). The result does not depend on it.
  void setNumberOfThreads(int num_threads);
  /// Of larger clouds so many points are drawn, >= 2; default 20 000.
  void setMaxPoints(std::size_t max_points);
  /// Where the scanner stood; by default the data decide, as in SymmetryAlignment.
  void setViewpoint(const Viewpoint& viewpoint) { viewpoint_ = viewpoint; }

protected:
  using pcl::Feature<PointInT, PointOutT>::input_;
  using pcl::Feature<PointInT, PointOutT>::indices_;

  bool initCompute() override;
  bool deinitCompute() override;
  void computeFeature(PointCloudOut& output) override;

private:
  DescriptorOptions options_;
  bool use_input_axes_ = false;
  std::size_t max_points_ = 20'000;
  Viewpoint viewpoint_;
  pcl::IndicesPtr all_indices_;
};

/// The product of the distances of PRST and GEDT that the paper proposes. \return >= 0.
float productDistance(const PRSTSignature32768& prst_a, const GEDTSignature32768& gedt_a,
                      const PRSTSignature32768& prst_b, const GEDTSignature32768& gedt_b);

/// L2 distance, differences weighted by sqrt(sin theta).
float descriptorDistance(const PRSTSignature32768& a, const PRSTSignature32768& b);
float descriptorDistance(const PRSDSignature1024& a, const PRSDSignature1024& b);
/// L2 distance.
float descriptorDistance(const GEDTSignature32768& a, const GEDTSignature32768& b);

}  // namespace pcl_symmetry
