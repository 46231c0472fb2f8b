#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace pcl_symmetry {

struct CompactIndexOptions {
  /// Leading components, those of greatest variance, by which candidates are chosen, >= 1. chosen: half loses true
  /// neighbours of noisy queries, twice takes twice the time.
  int num_leading = 24;
  /// Compact forms, at least, whose components are all compared, >= 1. chosen: as num_leading.
  int num_candidates = 512;
  /// The same as a share of all forms, in [0, 1]: among more forms, more share their leading components. measured:
  /// benchmark_matching 1000000, see there.
  double candidate_share = 0.02;
  int num_threads = 0;  ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Finds the nearest of many shapes by their compact forms, see SignatureProjection.
///
/// The leading components of all forms are compared, then all components of the candidates.
/// Randomised k-d trees (FLANN) take longer and find fewer of the true neighbours, as each query has 24 rotations in
/// hundreds of dimensions.
class CompactIndex {
public:
  CompactIndex() = default;

  /// \param compact K x (forms_per_shape N), unit columns, those of one shape side by side.
  /// \param forms_per_shape >= 1.
  /// \param typical distances of the N shapes, each > 0: distances to a shape are divided by the root of its own, see
  /// typicalDistance(); empty: all are 1.
  /// \throws std::invalid_argument for bad options, a number of columns that is no multiple of forms_per_shape, or
  /// another number of typical distances.
  CompactIndex(Eigen::MatrixXf compact, int forms_per_shape, const CompactIndexOptions& options = {},
               std::vector<float> typical = {});

  Eigen::Index numShapes() const;

  /// \param rotations K x 24 M, all rotations of the query's compact forms, see SignatureProjection::rotations().
  /// \param num_nearest >= 0.
  /// \return shapes and their least distances over all forms and rotations, in [0, 2], scaled, nearest first, at most
  /// \p num_nearest. Exact where the index holds no more than num_candidates forms.
  /// \throws std::invalid_argument for another K or a negative \p num_nearest.
  std::vector<std::pair<int, float>> nearest(const Eigen::MatrixXf& rotations, int num_nearest) const;

private:
  std::vector<int> candidates(const Eigen::MatrixXf& rotations, std::size_t count) const;

  Eigen::MatrixXf compact_;
  Eigen::Index num_leading_ = 0;
  // Leading components and -1/2 of their squared norm: of the first forms one number after the other, and so on.
  std::vector<float> leading_;
  int forms_per_shape_ = 1;
  std::vector<float> typical_;  // of the shapes
  CompactIndexOptions options_;
};

}  // namespace pcl_symmetry
