#include "core/geometry/search_views.h"

#include <algorithm>
#include <utility>

#include "core/base/check.h"

namespace pcl_symmetry {

namespace {

class SearchInFrame : public ClosestPointSearch {
public:
  SearchInFrame(Ptr search, const Eigen::Vector3d& center, double scale)
      : search_(std::move(search)), center_(center), scale_(scale) {}

  void search(const PointsRef& queries, int num_neighbors, std::vector<int>& indices,
              std::vector<float>& sq_distances) const override {
    const Points moved = ((queries.cast<double>() * scale_).colwise() + center_).cast<float>();
    search_->search(moved, num_neighbors, indices, sq_distances);
    for (float& sq_distance : sq_distances) sq_distance = static_cast<float>(sq_distance / (scale_ * scale_));
  }

private:
  Ptr search_;
  Eigen::Vector3d center_;
  double scale_;
};

class SearchAmong : public ClosestPointSearch {
public:
  SearchAmong(Ptr search, std::size_t num_points, const std::vector<int>& kept)
      : search_(std::move(search)), num_kept_(kept.size()), index_of_(num_points, -1) {
    for (std::size_t i = 0; i < kept.size(); ++i) index_of_[kept[i]] = static_cast<int>(i);
  }

  /// Asks for more neighbors until enough of them are kept.
  void search(const PointsRef& queries, int num_neighbors, std::vector<int>& indices,
              std::vector<float>& sq_distances) const override {
    const auto wanted = static_cast<std::size_t>(num_neighbors);
    check(wanted <= num_kept_, "num_neighbors", num_neighbors, "at most the number of points");
    indices.clear();
    sq_distances.clear();
    std::vector<int> found;
    std::vector<float> sq_found;
    for (Eigen::Index i = 0; i < queries.cols(); ++i) {
      const std::size_t end = static_cast<std::size_t>(i + 1) * wanted;
      for (std::size_t count = 2 * wanted; indices.size() < end; count *= 2) {
        count = std::min(count, index_of_.size());
        search_->search(queries.col(i), static_cast<int>(count), found, sq_found);
        indices.resize(end - wanted);
        sq_distances.resize(end - wanted);
        for (std::size_t k = 0; k < count && indices.size() < end; ++k) {
          const int index = index_of_[found[k]];
          if (index < 0) continue;
          indices.push_back(index);
          sq_distances.push_back(sq_found[k]);
        }
      }
    }
  }

private:
  Ptr search_;
  std::size_t num_kept_;
  std::vector<int> index_of_;  ///< among those kept, of each point; -1: not kept
};

}  // namespace

ClosestPointSearch::Ptr inFrame(ClosestPointSearch::Ptr search, const Eigen::Vector3d& center, double scale) {
  return std::make_shared<SearchInFrame>(std::move(search), center, scale);
}

ClosestPointSearch::Ptr among(ClosestPointSearch::Ptr search, std::size_t num_points, const std::vector<int>& kept) {
  return std::make_shared<SearchAmong>(std::move(search), num_points, kept);
}

}  // namespace pcl_symmetry
