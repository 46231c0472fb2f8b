#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/views/view_index.h"
#include "recognition/storage/model_store.h"

namespace pcl_symmetry::detail {

/// A model that looks like a scan from some side.
struct ModelOfView {
  StoredModel model;
  std::vector<Eigen::Isometry3d> T_model_scan;  ///< poses of the nearest views, nearest first
};

/// Finds models that a scan can show by their views.
class ViewSearch {
public:
  /// Reads the views of all models.
  /// \throws pcl::IOException naming file and reason.
  ViewSearch(ModelStore& store, int num_threads);

  /// Models that look like a scan from some side, nearest first.
  std::vector<ModelOfView> nearest(const View& scan, const ViewSearchOptions& options) const;

private:
  std::vector<StoredModel> models_;  // in the order of the index
  ViewIndex index_;
};

}  // namespace pcl_symmetry::detail
