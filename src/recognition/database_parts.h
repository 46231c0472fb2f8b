#pragma once

#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/symmetry_database.h"
#include "recognition/model_search.h"
#include "recognition/model_store.h"
#include "recognition/packed_model.h"

namespace pcl_symmetry::detail {

/// The parts of a database: the file, and the data read from it for queries. Every function throws pcl::IOException,
/// which names the file and the reason. All functions may be called by several threads at once; `store` may be used
/// only by the thread that holds `mutex`.
struct DatabaseParts {
  DatabaseParts(const std::string& file, const DatabaseOptions& database_options)
      : options(database_options), store(file, database_options.lock_timeout, database_options.unit) {}

  /// The indexes of the state that is read at present.
  std::shared_ptr<const ShapeSearch> shapes();
  std::shared_ptr<const ViewSearch> views();
  /// Pairs of points of all models; null in a large database.
  std::shared_ptr<const PairSearch> pairs();
  /// The fitted data of the store; the forms are null if there are none. The mutex must be held.
  FittedForms storedForms();

  /// Views of a model.
  std::vector<View> viewsOf(const StoredModel& model) { return detail::viewsOf(store, model, mutex); }

  PositionCloud cloud(const StoredModel& model);
  /// The points of a model, at most \p max_points.
  Points points(const StoredModel& model, std::size_t max_points);
  std::shared_ptr<const ModelShape> shape(const StoredModel& model);

  /// Stores a model with its compact form where there is a projection.
  void add(const ModelInfo& info, const PackedModel& model, const Eigen::MatrixXf& signatures);
  /// See SymmetryDatabase::save().
  void save();
  void rebuild();

  DatabaseOptions options;
  std::mutex mutex;
  ModelStore store;

private:
  template <typename Search>
  std::shared_ptr<const Search> latest(std::shared_ptr<const Search>& made, std::uint64_t& version_of_made);

  std::shared_ptr<const ShapeSearch> shapes_;
  std::shared_ptr<const ViewSearch> views_;
  std::shared_ptr<const PairSearch> pairs_;
  // Versions of the store when they were read.
  std::uint64_t shapes_version_ = 0, views_version_ = 0, pairs_version_ = 0;
  FittedForms forms_;
};

/// Seconds since 1970 (UTC).
std::int64_t currentTime();

/// \throws std::invalid_argument unless it is 1 to 200 bytes of UTF-8 without "/" and control characters, not "."
/// first.
void checkModelName(const std::string& name);

/// A model as stored.
struct DescribedModel {
  PackedModel packed;
  Eigen::MatrixXf signatures;  ///< signatures as stored
};
/// \throws std::invalid_argument for points that hold no answer.
DescribedModel describedModel(const Points& points, const DatabaseOptions& options);

/// The finite points of a cloud, at most \p max_points.
inline Points finitePoints(const PositionCloud& cloud, std::size_t max_points) {
  return selectPoints(cloud, nullptr, max_points, 1).points;
}

/// Calls \p body if the points hold an answer. Otherwise, and if the core finds that they do not
/// (std::invalid_argument), the result is empty and a PCL_WARN gives the reason.
/// \param indices indices by which the points were chosen; null: all points were taken.
template <typename Body>
auto emptyWithoutAnswer(const Points& points, const Body& body, const pcl::Indices* indices = nullptr)
    -> decltype(body()) {
  std::string reason = reasonForNoAnswer(points, "input cloud", 0, indices);
  try {
    if (reason.empty()) return body();
  } catch (const std::invalid_argument& error) {
    reason = std::string("input cloud: ") + error.what();
  }
  warnOfNoAnswer("SymmetryDatabase", reason);
  return {};
}

}  // namespace pcl_symmetry::detail
