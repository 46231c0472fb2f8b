#pragma once

#include <pcl/impl/pcl_base.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/scalar_grid.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// The input of every class that analyzes a cloud: which points it uses, and why they may hold no answer.
///
/// setIndices() is honored, and points that are not finite are left out. Data that hold no answer give an empty
/// result: PCL_WARN prints the reason, and getReason() returns it. A used object that is given a new cloud gives the
/// results of a new object with the same options.
template <typename PointT>
class CloudAnalysis : public pcl::PCLBase<PointT> {
public:
  using typename pcl::PCLBase<PointT>::PointCloudConstPtr;

  /// Sets the cloud to analyze and clears the results of the last one.
  void setInputCloud(const PointCloudConstPtr& cloud) override {
    pcl::PCLBase<PointT>::setInputCloud(cloud);
    volume_.reset();
    clearResults();
  }

  /// Larger clouds are reduced to this number of points, one drawn from each of as many equal runs of the cloud.
  /// \param max_points >= 2 (>= 20 in SymmetrySegmentation, as fewer hold no parts).
  /// \throws pcl::BadArgumentException for other values.
  void setMaxPoints(std::size_t max_points) {
    detail::checkAtLeast("max_points", static_cast<std::int64_t>(max_points), min_max_points_);
    max_points_ = max_points;
  }

  /// \return the points that the last analysis used, as indices into the cloud.
  const pcl::Indices& getUsedIndices() const { return used_indices_; }
  /// \return why the last analysis gave no answer, one sentence; empty where it ran, whatever it found.
  const std::string& getReason() const { return reason_; }

protected:
  using pcl::PCLBase<PointT>::input_;
  using pcl::PCLBase<PointT>::indices_;
  using pcl::PCLBase<PointT>::use_indices_;

  /// Begins with no cloud.
  /// \param name name of the class, for messages.
  CloudAnalysis(std::string name, std::size_t max_points, std::int64_t min_max_points = 2)
      : name_(std::move(name)), max_points_(max_points), min_max_points_(min_max_points) {}

  const std::string& getClassName() const { return name_; }  ///< for messages

  /// Discards everything that was found in the cloud; options stay.
  virtual void clearResults() {
    used_indices_.clear();
    reason_.clear();
  }

  /// Analyzes a function on a grid in place of a cloud (Section 4.2), until a cloud is set.
  /// \param volume such as a CT or MR image; results are in its input frame.
  /// \param levels the range of intensities that is used.
  /// \throws pcl::BadArgumentException for bad levels.
  void setInputVolume(const ScalarGrid::ConstPtr& volume, const VolumeLevels& levels = {}) {
    detail::withBadArguments([&] { levels.validate(); });
    pcl::PCLBase<PointT>::setInputCloud(nullptr);
    volume_ = volume;
    levels_ = levels;
    clearResults();
  }

  /// Begins an analysis: clears the results of the last one and selects the points of the input.
  /// \return 3 x N points; N = 0 where the input holds no answer.
  Points selectInput(std::uint64_t seed) {
    if (input_) return selectFrom(*input_, seed);
    clearResults();
    return giveNoAnswer("input cloud: not set");
  }

  /// The same for another cloud with the points of the input, such as a filtered one.
  template <typename OtherPointT>
  Points selectFrom(const pcl::PointCloud<OtherPointT>& cloud, std::uint64_t seed) {
    clearResults();
    const pcl::Indices* indices = use_indices_ ? indices_.get() : nullptr;
    detail::SelectedPoints selected = detail::selectPoints(cloud, indices, max_points_, seed);
    std::string reason = detail::reasonForNoAnswer(selected.points, "input cloud", 0, indices);
    if (!reason.empty()) return giveNoAnswer(std::move(reason));
    used_indices_ = std::move(selected.indices);
    return std::move(selected.points);
  }

  /// Stores and prints the reason.
  /// \return no points.
  Points giveNoAnswer(std::string reason) {
    detail::warnOfNoAnswer(name_, reason);
    reason_ = std::move(reason);
    return Points(3, 0);
  }

  ScalarGrid::ConstPtr volume_;  ///< null where a cloud is analyzed
  VolumeLevels levels_;          ///< levels of the volume

private:
  std::string name_;
  std::size_t max_points_;
  std::int64_t min_max_points_;
  pcl::Indices used_indices_;
  std::string reason_;
};

/// The input of classes that also take into account what a scanner saw.
///
/// By default, the data decide where the scanner stood: an organized cloud shows it by its own rays, any other cloud by
/// its sensor_origin_ if the points can have been seen from there, or by the density of its points, which in a scan
/// falls with the slant and the distance of the surface. A sensor_origin_ of 0 0 0 without a rotation may be a default:
/// the density has to confirm it. Reflections in free space then count against a plane; reflections behind the surface
/// do not count.
///
/// If setIndices() selects a part of the cloud, what the scanner saw is determined from the whole cloud: another object
/// in front hides what lies behind it, space beyond the cloud is unknown, and nothing of the part lies behind the
/// table, floor or wall that it stands on or in front of. For many parts of one scene, SymmetryScene finds these planes
/// once.
template <typename PointT>
class ScanAnalysis : public CloudAnalysis<PointT> {
public:
  /// \param mode how the viewpoint is found; default Viewpoint::Mode::Auto.
  void setViewpointMode(Viewpoint::Mode mode) { viewpoint_.mode = mode; }
  /// \param position where the scanner stood, input frame; it must see the points within 75 degrees of one direction.
  /// \throws pcl::BadArgumentException if it is not finite.
  void setViewpoint(const Eigen::Vector3d& position) { setViewpoint(Viewpoint{Viewpoint::Mode::Given, position}); }
  /// Sets mode and position at once.
  void setViewpoint(const Viewpoint& viewpoint) { viewpoint_ = detail::checkedViewpoint(viewpoint); }
  const Viewpoint& getViewpoint() const { return viewpoint_; }  ///< see setViewpoint()

  /// Sets the plane that the object stands on, a x + b y + c z + d = 0 in the frame of the input: nothing of the object
  /// lies below. It is used only with a viewpoint. Sparse unorganized points, such as the rings of a LiDAR, are then
  /// decided by the middle plane of the upright box around them.
  /// \throws pcl::BadArgumentException for a zero normal or a value that is not finite.
  void setGround(const Eigen::Vector4d& coefficients) { ground_ = detail::unitPlane(coefficients); }

  /// Sets what the scanners of a scene saw, determined once for all its objects, in place of what follows from the
  /// viewpoint and the input. The errors of its depths should then also be removed once, by withoutDepthErrors().
  /// \param seen in the frame of the input; null (default): each analysis determines it for itself.
  void setSeenSpace(const SeenSpace::ConstPtr& seen) { seen_space_ = seen; }

  /// \return whether the last analysis used a viewpoint.
  bool usedViewpoint() const { return used_space_.visibility() != nullptr; }
  /// \return how the last analysis determined its viewpoint.
  ViewpointSource getViewpointSource() const { return used_space_.source(); }
  /// \return the viewpoint that the last analysis used, input frame; nothing where it used none.
  std::optional<Eigen::Vector3d> getUsedViewpoint() const {
    if (!usedViewpoint()) return std::nullopt;
    return used_space_.visibility()->viewpoint();
  }

protected:
  using CloudAnalysis<PointT>::CloudAnalysis;

  void clearResults() override {
    CloudAnalysis<PointT>::clearResults();
    used_space_ = {};
  }

  /// Selects points, from which the errors of a depth camera are removed if rows and columns show one.
  /// \param num_threads 0 = one per core.
  /// \param as_measured keeps the errors.
  Points selectInput(std::uint64_t seed, int num_threads, bool as_measured = false) {
    const bool asks_data = !as_measured && !seen_space_ && viewpoint_.mode == Viewpoint::Mode::Auto;
    frame_ = asks_data && this->input_ && this->input_->isOrganized() && this->input_->width > 1
                 ? detail::depthFrame(detail::positionsOf(*this->input_), num_threads)
                 : detail::DepthFrame();
    return frame_.filtered ? this->selectFrom(*frame_.filtered, seed) : CloudAnalysis<PointT>::selectInput(seed);
  }

  /// \return whether the caller may have given the support of the object, by setGround() or setSeenSpace().
  bool hasGivenSupport() const { return ground_ || (seen_space_ && !seen_space_->asksForSupport()); }

  /// Determines what the scanner saw.
  /// \param points selected from the input, 3 x N, N >= 1.
  /// \return what the scanner saw; null without a viewpoint.
  /// \throws std::invalid_argument where the points surround the viewpoint that was given.
  const Visibility* seenSpace(const Points& points) {
    const bool is_part = this->use_indices_ && this->indices_->size() < this->input_->size();
    const double tolerance = DetectionOptions().tolerance;
    const detail::DepthFrame frame = std::exchange(frame_, {});
    used_space_ = seen_space_               ? *seen_space_
                  : frame.seen.visibility() ? frame.seen
                                            : detail::findSeenSpace(*this->input_, points, viewpoint_, is_part);
    if (is_part && used_space_.asksForSupport())
      used_space_ =
          detail::standingInScene(used_space_, detail::positionsOf(*this->input_), *this->indices_, tolerance);
    if (ground_) used_space_ = detail::standingOn(used_space_, *ground_, points, tolerance);
    return seen();
  }
  /// \return what seenSpace() returned last; null if the input selected since then has none.
  const Visibility* seen() const { return used_space_.visibility(); }

private:
  Viewpoint viewpoint_;
  std::optional<Eigen::Vector4d> ground_;
  SeenSpace::ConstPtr seen_space_;
  detail::DepthFrame frame_;  // of the current analysis
  SeenSpace used_space_;      // of the last analysis
};

}  // namespace pcl_symmetry
