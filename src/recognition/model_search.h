#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/matching/compact_index.h"
#include "core/matching/signature_projection.h"
#include "core/views/view_index.h"
#include "pcl_symmetry/core/scan/visibility.h"
#include "pcl_symmetry/recognition/symmetry_database.h"
#include "recognition/model_folder.h"

namespace pcl_symmetry::detail {

/// A model that looks like a scan from some side.
struct ModelOfView {
  std::string name;
  std::vector<Eigen::Isometry3d> T_model_scan;  ///< poses of the nearest views, nearest first
};

/// Finds models: by their compact forms those of like shape, by their views those that a scan can show.
class ModelSearch {
public:
  ModelSearch(int max_references, int num_threads) : max_references_(max_references), num_threads_(num_threads) {}

  /// Takes a projection that was fitted before.
  void restore(SignatureProjection projection, int num_references);

  /// Fits the projection to the signatures of up to max_references models, spread over all. The compact forms of all
  /// models become invalid and are emptied.
  /// \throws pcl::IOException, std::invalid_argument where all models are alike.
  void fit(Models& models, const ModelFolder& folder);
  /// True where the projection has no references, or less than half of those that fit() would take now.
  bool isOutgrown(const Models& models) const;

  /// Makes the compact forms that are missing and indexes all models.
  /// \throws pcl::IOException naming file and reason.
  void index(Models& models, const ModelFolder& folder);

  /// Leaves a model that was changed or removed out of all results, until index() is called.
  void forget(const std::string& name);

  const SignatureProjection& projection() const { return projection_; }
  int numReferences() const { return num_references_; }

  /// Models of like shape, nearest first.
  /// \param points 3 x N, finite, input units, at least two different ones.
  /// \param seen what a scanner saw; null = the points show the object from all sides.
  /// \param num_nearest >= 0.
  std::vector<ModelMatch> likeShapes(const Points& points, const Visibility* seen, int num_nearest) const;
  /// Models that look like a scan from some side, nearest first.
  std::vector<ModelOfView> likeViews(const View& scan, const ViewSearchOptions& options) const;

private:
  int max_references_;
  int num_threads_;
  SignatureProjection projection_;
  int num_references_ = 0;          // models that the projection was fitted to
  std::vector<std::string> names_;  // of the models, in the order of both indexes; empty: forgotten
  CompactIndex shapes_;
  ViewIndex views_;
};

}  // namespace pcl_symmetry::detail
