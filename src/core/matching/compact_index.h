#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace pcl_symmetry {

struct CompactIndexOptions {
  int num_leading = 24;      ///< components, which vary most, that candidates are chosen by, >= 1
  int num_candidates = 512;  ///< compact forms, at least, that all components are compared of, >= 1
  int num_threads = 0;       ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Finds the nearest of many shapes by their compact forms, see SignatureProjection.
///
/// All forms are scanned by their leading components, as one product of matrices: with 24 rotations to ask for in
/// hundreds of dimensions, randomised k-d trees (FLANN) take longer for a lower recall.
class CompactIndex {
public:
  CompactIndex() = default;

  /// \param compact K x (forms_per_shape N), unit columns, those of one shape side by side.
  /// \throws std::invalid_argument for bad options or a number of columns that does not fit.
  CompactIndex(Eigen::MatrixXf compact, int forms_per_shape, const CompactIndexOptions& options = {});

  Eigen::Index numShapes() const;

  /// \param rotations of the shape that is asked for, see SignatureProjection::rotations(). \param num_nearest >= 0.
  /// \return shape and distance as of signatureDistance(), nearest first; fewer where there are no more. Exact where
  /// there are no more forms than num_candidates.
  std::vector<std::pair<int, float>> nearest(const Eigen::MatrixXf& rotations, int num_nearest) const;

private:
  std::vector<int> candidates(const Eigen::MatrixXf& rotations, std::size_t count) const;

  Eigen::MatrixXf compact_;
  Eigen::MatrixXf leading_;  // leading components of the forms, and -1/2 their squared norm
  int forms_per_shape_ = 1;
  CompactIndexOptions options_;
};

}  // namespace pcl_symmetry
