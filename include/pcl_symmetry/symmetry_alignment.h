#pragma once

#include <pcl/pcl_base.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/frame/symmetry_frame.h"
#include "pcl_symmetry/viewpoint.h"

namespace pcl_symmetry {

/// From a cloud, whole or seen from one side, to its canonical frame: center of symmetry and principal symmetry axes
/// (Section 5.1 of the paper).
///
/// Honours setIndices; points that are not finite are left out.
template <typename PointT>
class SymmetryAlignment : public pcl::PCLBase<PointT> {
public:
  using Ptr = pcl::shared_ptr<SymmetryAlignment<PointT>>;
  using ConstPtr = pcl::shared_ptr<const SymmetryAlignment<PointT>>;

  /// Every option at once. \throws pcl::BadArgumentException naming field, value and rule.
  void setOptions(const FrameOptions& options);
  const FrameOptions& getOptions() const { return options_; }

  /// Frames whose scores are this close to the best are equally good, >= 0.
  void setTie(double tie);
  /// Cells of the distance transform along each side, in [8, 512]; default 64.
  void setGridSize(int num_cells);
  void setRandomSeed(std::uint64_t seed);
  /// 0 = one per core (default). The result does not depend on it.
  void setNumberOfThreads(int num_threads);
  /// Of larger clouds so many points are drawn, >= 2; default 50 000.
  void setMaxPoints(std::size_t max_points);

  /// Where the scanner stood. By default the data decide: an organized cloud tells by its own rays, another one by its
  /// sensor_origin_ if the points can have been seen from there. Reflections that land in space that the scanner saw to
  /// be empty then speak against a plane, those that land behind the surface do not.
  void setViewpointMode(Viewpoint::Mode mode) { viewpoint_.mode = mode; }
  /// The scanner stood here, input frame.
  void setViewpoint(const Eigen::Vector3d& position) { viewpoint_ = {Viewpoint::Mode::Given, position}; }
  void setViewpoint(const Viewpoint& viewpoint) { viewpoint_ = viewpoint; }
  const Viewpoint& getViewpoint() const { return viewpoint_; }

  /// \return the frame, in the frame of the input.
  /// \throws pcl::BadArgumentException without input, or where the finite points have no extent.
  SymmetryFrame compute();

  /// Of the last compute(): whether a viewpoint was used.
  bool usedViewpoint() const { return used_viewpoint_; }
  /// Of the last compute(): the points used.
  const pcl::Indices& getUsedIndices() const { return used_indices_; }
  /// Of the last compute(): stages and their milliseconds, in order.
  const std::vector<std::pair<std::string, double>>& getTiming() const { return timing_ms_; }

protected:
  using pcl::PCLBase<PointT>::input_;
  using pcl::PCLBase<PointT>::indices_;
  using pcl::PCLBase<PointT>::use_indices_;

private:
  FrameOptions options_;
  std::size_t max_points_ = 50'000;
  Viewpoint viewpoint_;
  bool used_viewpoint_ = false;
  pcl::Indices used_indices_;
  std::vector<std::pair<std::string, double>> timing_ms_;
};

}  // namespace pcl_symmetry
