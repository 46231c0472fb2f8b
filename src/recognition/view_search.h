#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <vector>

#include "core/matching/view_code.h"
#include "recognition/fitted_forms.h"
#include "recognition/model_store.h"

namespace pcl_symmetry::detail {

/// A model that looks like a scan from some side.
struct ModelOfView {
  StoredModel model;
  std::vector<Eigen::Isometry3d> T_model_scan;  ///< poses of the nearest views, nearest first
};

/// Finds models that a scan can show by their views: those with the nearest codes, whose views are then read and
/// compared in full. In a small database all views are compared.
class ViewSearch {
public:
  /// Reads the views of a model, called by several threads at once.
  using ViewReader = std::function<std::vector<View>(const StoredModel&)>;

  /// Reads the codes of all models, and makes those that are missing.
  /// \param stored what is fitted in the store.
  /// \throws pcl::IOException naming file and reason.
  ViewSearch(ModelStore& store, const FittedForms& stored, const DatabaseOptions& options);

  /// Models that look like a scan from some side, nearest first, at most \p num_nearest.
  std::vector<ModelOfView> nearest(const View& scan, int num_nearest, int num_threads, const ViewReader& read) const;

private:
  std::vector<StoredModel> models_;         // in the order of the indexes
  ViewIndex all_;                           // of a small database
  std::shared_ptr<const ViewCoder> coder_;  // of a large one
  ViewCodeIndex codes_;
};

}  // namespace pcl_symmetry::detail
