#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/mesh_surface.h"
#include "pcl_symmetry/core/volume_planes.h"
#include "pcl_symmetry/impl/pcl_search.hpp"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

namespace detail {

/// The planes as published.
/// \param edt,map transform of the points; if edt is null, it is computed.
Detection planesAsPublished(const Points& points, const GaussianEdt* edt, const SymmetryMap& map,
                            const DetectionOptions& options);

/// \param all all finite points of a cloud.
/// \param cloud_size number of points of the cloud.
/// \param samples 3 x N, finite, the surface that reflected points are compared with, same frame; N = 0: no surface.
/// \param seen what the scanner saw of the cloud; null: it shows its object from all sides.
/// \return for each plane its support at each point of the cloud, in [0, 1]; NaN where it is not known.
std::vector<std::vector<float>> pointSupport(const SelectedPoints& all, std::size_t cloud_size, const Points& samples,
                                             const std::vector<ReflectionPlane>& planes, const Visibility* seen,
                                             int num_threads);

}  // namespace detail

/// Finds the planes of symmetry of a cloud: local maxima of the transform, refined by Iterative Symmetric Points
/// (Section 4.4 of the paper).
///
/// The class computes the transform itself unless it is given a map. With the defaults nothing has to be tuned, and a
/// shape without symmetry gives no plane.
template <typename PointT>
class SymmetryMaximaRefinement : public SearchingAnalysis<ScanAnalysis<PointT>, DetectionOptions> {
public:
  using Ptr = pcl::shared_ptr<SymmetryMaximaRefinement<PointT>>;
  using ConstPtr = pcl::shared_ptr<const SymmetryMaximaRefinement<PointT>>;
  using typename pcl::PCLBase<PointT>::PointCloudConstPtr;

  /// Uses at most 50 000 points, see setMaxPoints().
  SymmetryMaximaRefinement()
      : SearchingAnalysis<ScanAnalysis<PointT>, DetectionOptions>("SymmetryMaximaRefinement", 50'000) {}

  /// Sets the cloud to analyze; clears the results of the last one, and the map that was given for it.
  void setInputCloud(const PointCloudConstPtr& cloud) override {
    ScanAnalysis<PointT>::setInputCloud(cloud);
    map_ = {};
    edt_.reset();
    mesh_.reset();
  }

  using CloudAnalysis<PointT>::setInputVolume;

  /// \param min_confidence a plane of at least this confidence is a symmetry, in [0, 1]; default 0.5.
  void setMinConfidence(double min_confidence) {
    this->change([&](DetectionOptions& changed) {
      changed.min_confidence = min_confidence;
      changed.min_possible = std::min(changed.min_possible, min_confidence);
    });
  }
  /// \param tolerance greatest deviation of a symmetric surface, as a share of the greatest distance between two
  /// points, in (0, 0.1], whatever the sensor resolves. Default: 0.01, or what a depth camera (up to 0.03) or sparse
  /// points (up to 0.02) resolve.
  void setTolerance(double tolerance) {
    this->change([&](DetectionOptions& changed) { changed.tolerance = changed.max_tolerance = tolerance; });
  }
  /// \param approximate also reports maxima of less confidence: approximate symmetries and symmetries of parts, marked
  /// by SymmetryPlane::kind; default false.
  void setApproximate(bool approximate) { options_.approximate = approximate; }
  /// \param max_planes greatest number of planes, >= 1; default 128.
  void setMaxPlanes(int max_planes) {
    this->change([&](DetectionOptions& changed) { changed.max_planes = max_planes; });
  }
  /// \param num_cells cells of the distance transform along each side, in [8, 512]; default 64.
  void setGridSize(int num_cells) {
    this->change([&](DetectionOptions& changed) { changed.num_cells = num_cells; });
  }
  /// \param sigma width of the Gaussian, input units, >= 0; 0 (default) = two cells, or the spacing of the points where
  /// that is more.
  void setSigma(double sigma) {
    this->change([&](DetectionOptions& changed) { changed.sigma = sigma; });
  }

  /// \param use_input_normals true (default): uses the normals of point types that have them, if they are finite and
  /// not zero. false, and for other point types: all normals are estimated from the neighbors.
  void setUseInputNormals(bool use_input_normals) { use_input_normals_ = use_input_normals; }

  /// Sets the map whose maxima are refined, in place of one that the class computes. Call it after setInputCloud(),
  /// which discards it.
  /// \param map,edt made by PlanarSymmetryTransform for the same cloud.
  void setSymmetryMap(const SymmetryMap& map, const std::shared_ptr<const GaussianEdt>& edt);

  /// Sets the mesh that the points of the cloud were spread over: the last step refines on it, see refineOnMesh(),
  /// unless the points were seen from one side or setAsPublished() is set. Call it after setInputCloud(), which
  /// discards it.
  void setMesh(const MeshSurface& mesh) { mesh_ = mesh; }

  /// Follows Section 4.4 to the letter: local maxima of the given map, or of the exact one with 64 x 64 x 64 bins,
  /// refined by publishedPlanes() and not judged. Viewpoint, mesh and normals are not used. Volumes ignore this
  /// setting.
  void setAsPublished(bool as_published) { as_published_ = as_published; }

  /// \return the planes, best first, in the frame of the input: symmetries, then possible ones. Empty where there is
  /// neither, and where the input holds no answer, see getReason().
  /// \throws pcl::BadArgumentException if the points surround the viewpoint that was given.
  std::vector<SymmetryPlane> compute();

  /// Tells how well a plane maps each point onto the surface.
  /// \return the support for a plane at each point of the input cloud, also at points that compute() did not use, in
  /// [0, 1]; NaN for points that are not finite, where the scanner could not see whether the reflection lies on the
  /// surface, and for all points where compute() has not given an answer.
  std::vector<float> computePointSupport(const ReflectionPlane& plane) const;
  /// The same for several planes, faster than one by one, because the surface of the points is prepared once.
  std::vector<std::vector<float>> computePointSupport(const std::vector<ReflectionPlane>& planes) const;

  /// \return all that the last compute() found, with the planes, in the frame of the input: axes and centers, rotations
  /// of scans, the best plane where there is no symmetry, the tolerance, and the time of each stage.
  const Detection& getDetection() const { return found_; }
  const std::vector<SymmetryAxis>& getAxes() const { return found_.axes; }  ///< Detection::axes
  /// \return the given map, or else the map that the last compute() made.
  const SymmetryMap& getSymmetryMap() const { return edt_ ? map_ : found_.map; }

protected:
  using pcl::PCLBase<PointT>::input_;

  void clearResults() override {
    ScanAnalysis<PointT>::clearResults();
    found_ = {};
    samples_.resize(3, 0);
  }

private:
  using SearchingAnalysis<ScanAnalysis<PointT>, DetectionOptions>::options_;

  bool use_input_normals_ = true;
  bool as_published_ = false;
  SymmetryMap map_;  // the given map
  std::shared_ptr<const GaussianEdt> edt_;
  std::optional<MeshSurface> mesh_;
  Detection found_;
  Points samples_ = Points(3, 0);  // the points used
};

template <typename PointT>
void SymmetryMaximaRefinement<PointT>::setSymmetryMap(const SymmetryMap& map,
                                                      const std::shared_ptr<const GaussianEdt>& edt) {
  if (map.empty() || !edt) detail::throwBadArgument("symmetry map: empty, must be made by PlanarSymmetryTransform");
  map_ = map;
  edt_ = edt;
}

template <typename PointT>
std::vector<SymmetryPlane> SymmetryMaximaRefinement<PointT>::compute() {
  return detail::withBadArguments([&] {
    if (this->volume_) {
      clearResults();
      found_ = detectVolumePlanes(*this->volume_, options_, this->levels_);
      if (!found_.reason.empty()) this->giveNoAnswer(found_.reason);
      return found_.planes;
    }
    samples_ = this->selectInput(options_.seed, options_.num_threads, as_published_);
    if (samples_.cols() == 0) {
      found_.reason = this->getReason();
      return found_.planes;
    }
    if (as_published_) {
      found_ = detail::planesAsPublished(samples_, edt_.get(), map_, options_);
      return found_.planes;
    }
    PlaneInput input(samples_, this->seenSpace(samples_));
    const std::optional<Points> normals =
        use_input_normals_ ? detail::normalsOf(*input_, this->getUsedIndices()) : std::nullopt;
    if (normals) input.normals = &*normals;
    input.edt = edt_.get();
    input.map = edt_ ? &map_ : nullptr;
    input.make_search = this->makeSearch();
    input.may_be_rings = this->hasGivenSupport() && this->getViewpointSource() != ViewpointSource::Rays;
    found_ = detectPlanes(input, options_);
    if (mesh_ && !input.visibility) refineOnMesh(*mesh_, found_, options_);
    return found_.planes;
  });
}

template <typename PointT>
std::vector<float> SymmetryMaximaRefinement<PointT>::computePointSupport(const ReflectionPlane& plane) const {
  return computePointSupport(std::vector<ReflectionPlane>{plane}).front();
}

template <typename PointT>
std::vector<std::vector<float>> SymmetryMaximaRefinement<PointT>::computePointSupport(
    const std::vector<ReflectionPlane>& planes) const {
  if (!input_) return std::vector<std::vector<float>>(planes.size());
  const detail::SelectedPoints all = detail::selectPoints(*input_, nullptr, input_->size(), 0);
  return detail::pointSupport(all, input_->size(), samples_, planes, this->seen(), options_.num_threads);
}

}  // namespace pcl_symmetry
