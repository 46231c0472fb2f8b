#pragma once

#include <pcl/console/print.h>
#include <pcl/search/flann_search.h>
#include <pcl/search/kdtree.h>

#include <cstdint>
#include <mutex>
#include <stdexcept>
#include <string>
#include <typeinfo>
#include <vector>

#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/impl/cloud_analysis.hpp"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

namespace detail {

/// A search of PCL over some points. Its input cloud is replaced by a cloud of these points.
template <typename PointT>
class PCLPointSearch : public ClosestPointSearch {
public:
  /// Wraps a search of PCL.
  /// \param one_at_a_time whether queries wait for each other because the search may not be called from several
  /// threads.
  PCLPointSearch(const typename pcl::search::Search<PointT>::Ptr& search, const PointsRef& points, bool one_at_a_time)
      : search_(search), one_at_a_time_(one_at_a_time) {
    const auto cloud = pcl::make_shared<pcl::PointCloud<PointT>>();
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      PointT point;
      point.getVector3fMap() = points.col(i);
      cloud->push_back(point);
    }
    search_->setInputCloud(cloud);
  }

  void search(const PointsRef& queries, int num_neighbors, std::vector<int>& indices,
              std::vector<float>& sq_distances) const override {
    indices.clear();
    sq_distances.clear();
    pcl::Indices found;
    std::vector<float> sq_found;
    std::unique_lock<std::mutex> lock(mutex_, std::defer_lock);
    if (one_at_a_time_) lock.lock();
    for (Eigen::Index i = 0; i < queries.cols(); ++i) {
      PointT query;
      query.getVector3fMap() = queries.col(i);
      if (search_->nearestKSearch(query, num_neighbors, found, sq_found) < num_neighbors)
        throw std::invalid_argument("search method: found fewer neighbors than points, must find all");
      indices.insert(indices.end(), found.begin(), found.begin() + num_neighbors);
      sq_distances.insert(sq_distances.end(), sq_found.begin(), sq_found.begin() + num_neighbors);
    }
  }

private:
  typename pcl::search::Search<PointT>::Ptr search_;
  bool one_at_a_time_;
  mutable std::mutex mutex_;
};

/// Wraps the search that a user gave to a class; PCL_WARN reports what cannot be honored.
/// \param search null: the library's own search.
/// \param class_name for messages.
/// \param num_threads number of threads of the class.
/// \return null if the library's own search is used.
template <typename PointT>
MakeSearch searchOf(const typename pcl::search::Search<PointT>::Ptr& search, const std::string& class_name,
                    int num_threads) {
  if (!search) return nullptr;
  const pcl::search::Search<PointT>& given = *search;
  if (given.getName() == "OrganizedNeighbor") {
    PCL_WARN("[pcl_symmetry::%s] search method %s: finds no points behind what the sensor saw, FLANN is used instead\n",
             class_name.c_str(), given.getName().c_str());
    return nullptr;
  }
  // Classes derived from these may not be safe.
  const bool is_safe =
      typeid(given) == typeid(pcl::search::KdTree<PointT>) || typeid(given) == typeid(pcl::search::FlannSearch<PointT>);
  if (!is_safe && num_threads != 1)
    PCL_WARN(
        "[pcl_symmetry::%s] search method %s: may not be safe to call from several threads, its queries wait for "
        "each other\n",
        class_name.c_str(), given.getName().c_str());
  return [search, is_safe](const PointsRef& points) -> ClosestPointSearch::Ptr {
    return std::make_shared<PCLPointSearch<PointT>>(search, points, !is_safe);
  };
}

}  // namespace detail

/// An analysis with a struct of options that finds the closest points by a search.
/// \param Analysis CloudAnalysis or ScanAnalysis of a point type.
template <typename Analysis, typename Options>
class SearchingAnalysis : public Analysis {
public:
  using PointT = typename Analysis::PointCloud::PointType;
  using SearchPtr = typename pcl::search::Search<PointT>::Ptr;

  /// Sets every option at once.
  /// \throws pcl::BadArgumentException "field = value, must be rule", as do all setters here.
  void setOptions(const Options& options) {
    change([&](Options& changed) { changed = options; });
  }
  const Options& getOptions() const { return options_; }            ///< see setOptions()
  void setRandomSeed(std::uint64_t seed) { options_.seed = seed; }  ///< sets the seed of all random draws
  /// \param num_threads >= 0; 0 = one per core (default). The result does not depend on it.
  void setNumberOfThreads(int num_threads) {
    change([&](Options& changed) { changed.num_threads = num_threads; });
  }

  /// Sets a search of PCL for the closest points, in place of FLANN's k-d tree. It is used by Iterative Symmetric
  /// Points, for the neighbors that SymmetrySegmentation joins, and by SymmetryAlignment for the axes of rotation of a
  /// scan (FrameOptions::rotations).
  /// \param search receives clouds of the distinct points used, of a large cloud a subset, and of parts of them.
  /// pcl::search::KdTree and FlannSearch are called from all threads, others from one at a time.
  /// pcl::search::OrganizedNeighbor is not used, because reflected points lie behind what the sensor saw; PCL_WARN says
  /// so. Null: FLANN (default).
  void setSearchMethod(const SearchPtr& search) { search_ = search; }

protected:
  using Analysis::Analysis;

  /// Changes the options; if the new ones are invalid, the old ones stay.
  template <typename Change>
  void change(const Change& change) {
    detail::changeOptions(options_, change);
  }
  /// \return null if the library's own search is used.
  MakeSearch makeSearch() const {
    return detail::searchOf<PointT>(search_, this->getClassName(), options_.num_threads);
  }

  Options options_;  ///< see setOptions()

private:
  SearchPtr search_;
};

}  // namespace pcl_symmetry
