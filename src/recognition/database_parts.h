#pragma once

#include <stdexcept>
#include <string>

#include "pcl_symmetry/core/geometry/point_set.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/recognition/symmetry_database.h"
#include "recognition/model_folder.h"
#include "recognition/model_search.h"

namespace pcl_symmetry::detail {

/// What a database is made of: files, models, indexes.
struct DatabaseParts {
  /// Opens the folder and indexes its models.
  /// \throws pcl::IOException naming file and reason.
  DatabaseParts(const std::string& path, const DatabaseOptions& database_options);

  /// The points of a model, at most \p max_points.
  /// \throws std::invalid_argument where there is no such model, pcl::IOException.
  Points modelPoints(const std::string& name, std::size_t max_points) const;
  /// \throws std::invalid_argument where there is no such model, pcl::IOException.
  PositionCloud modelCloud(const std::string& name) const;

  DatabaseOptions options;
  ModelFolder folder;
  ModelSearch search;
  Models models;
  bool changed = false;  // since the last save
};

/// The finite points of a cloud, at most \p max_points.
inline Points finitePoints(const PositionCloud& cloud, std::size_t max_points) {
  return selectPoints(cloud, nullptr, max_points, 1).points;
}

/// Calls \p body if the points hold an answer. Else, and where the core finds that they do not (std::invalid_argument),
/// the result is empty and a PCL_WARN says why.
template <typename Body>
auto emptyWithoutAnswer(const Points& points, const Body& body) -> decltype(body()) {
  std::string reason = reasonForNoAnswer(points);
  try {
    if (reason.empty()) return body();
  } catch (const std::invalid_argument& error) {
    reason = std::string("input cloud: ") + error.what();
  }
  warnOfNoAnswer("SymmetryDatabase", reason);
  return {};
}

}  // namespace pcl_symmetry::detail
