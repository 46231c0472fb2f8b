/// Searches for the models of a database that a shape or a scan may show.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/matching/compact_index.h"
#include "core/matching/point_pair_index.h"
#include "core/matching/pose_screening.h"
#include "core/matching/view_code.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/visibility.h"
#include "recognition/fitted_forms.h"
#include "recognition/model_store.h"
#include "recognition/recognition_rules.h"

namespace pcl_symmetry::detail {

/// Finds models of similar shape by their compact forms.
class ShapeSearch {
public:
  /// Reads the compact forms of all models, and makes those that are missing.
  /// \param stored the fitted data of the store.
  /// \throws pcl::IOException naming file and reason.
  ShapeSearch(ModelStore& store, const FittedForms& stored, const DatabaseOptions& options);

  struct Found {
    StoredModel model;
    double distance;  ///< see ModelMatch
  };
  /// Models of similar shape, nearest first.
  /// \param points 3 x N, finite, input units, at least two different ones.
  /// \param seen what a scanner saw; null = the points show the object from all sides.
  /// \param num_nearest >= 0.
  std::vector<Found> nearest(const Points& points, const Visibility* seen, int num_nearest) const;

private:
  void makeIndex(ModelStore& store, std::int64_t stored, const DatabaseOptions& options);

  int num_threads_;
  std::shared_ptr<const CompactForms> forms_;  // null if there are no models
  std::vector<StoredModel> models_;            // in the order of the index
  CompactIndex index_;
};

/// A model that looks like a scan from some side.
struct ModelOfView {
  StoredModel model;
  std::vector<Eigen::Isometry3d> T_model_scan;  ///< poses of the nearest views, nearest first
};

/// Finds models that a scan may show by their views. The views of the models with the nearest codes are read and
/// compared in full. In a small database, all views are compared.
class ViewSearch {
public:
  /// Reads the views of a model, called by several threads at once.
  using ViewReader = std::function<std::vector<View>(const StoredModel&)>;

  /// Reads the codes of all models, and makes those that are missing.
  /// \param stored the fitted data of the store.
  /// \throws pcl::IOException naming file and reason.
  ViewSearch(ModelStore& store, const FittedForms& stored, const DatabaseOptions& options);

  /// Models that look like a scan from some side, nearest first, at most \p num_nearest.
  std::vector<ModelOfView> nearest(const View& scan, int num_nearest, int num_threads, const ViewReader& read) const;

private:
  std::vector<StoredModel> models_;         // in the order of the indexes
  ViewIndex all_;                           // views of a small database
  std::shared_ptr<const ViewCoder> coder_;  // codes of a large database
  ViewCodeIndex codes_;
};

/// A few points of a model, spread evenly.
struct ModelShape {
  SurfacePoints of_pairs;    ///< points from which pairs are made
  ScreenedSurface screened;  ///< points by which poses are screened
};

/// A model that a scan may show, with its possible poses.
struct PossibleModel {
  StoredModel model;
  std::shared_ptr<const ModelShape> shape;
  std::vector<Eigen::Isometry3d> T_model_scan;
};

/// Finds models that a scan may show, even if much of the object is hidden, by poses that pairs of its points suggest,
/// see PointPairIndex.
class PairSearch {
public:
  /// Reads a model, called by several threads at once.
  using ShapeReader = std::function<std::shared_ptr<const ModelShape>(const StoredModel&)>;

  /// \param before the previous search, whose shapes are reused for the models that it has; null: none.
  PairSearch(std::vector<StoredModel> models, const ShapeReader& read, const PairSearch* before, int num_threads);

  /// All models, each with the poses that pairs of points suggest.
  /// \param scan a few points, unit of the models.
  /// \param others further poses.
  std::vector<PossibleModel> possibleModels(const SurfacePoints& scan, const std::vector<ModelOfView>& others,
                                            int num_threads) const;

private:
  std::size_t indexOf(std::int64_t model) const;

  std::vector<StoredModel> models_;
  std::vector<std::shared_ptr<const ModelShape>> shapes_;  // shape of each model
  std::optional<PointPairIndex> index_;
};

}  // namespace pcl_symmetry::detail
