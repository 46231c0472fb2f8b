#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace pcl_symmetry {

struct CompactIndexOptions {
  int num_leading = 24;      ///< components of greatest variance, by which candidates are selected, >= 1
  int num_candidates = 512;  ///< least number of candidates, forms of which all components are compared, >= 1
  int num_threads = 0;       ///< >= 0; 0 = one per core
};

/// The mean distance of a shape to the nearest shapes of a fixed reference set.
/// d(a, b) / sqrt(typical(a) typical(b)) makes distances of common and of unusual shapes comparable. The classes of the
/// references need not be known.
/// \param distances distances to the references; infinite ones, such as that to the shape itself, are left out.
/// \return > 0; 1 where no distance is left.
float typicalDistance(std::vector<float> distances, std::size_t num_nearest = 10);

/// Finds the nearest of many shapes by their compact forms, see SignatureProjection.
///
/// The leading components of all forms are compared, then all components of the candidates. Randomized k-d trees
/// (FLANN) take longer and find fewer of the true neighbors, as each query has 24 rotations in hundreds of dimensions.
class CompactIndex {
public:
  CompactIndex() = default;

  /// \param compact K x (forms_per_shape N), unit columns, the forms of one shape side by side.
  /// \param forms_per_shape >= 1.
  /// \param typical typical distances of the N shapes, each > 0: distances to a shape are divided by the root of its
  /// own, see typicalDistance(); empty: all are 1.
  /// \throws std::invalid_argument if the number of columns is no multiple of forms_per_shape, or the number of typical
  /// distances does not fit.
  CompactIndex(Eigen::MatrixXf compact, int forms_per_shape, const CompactIndexOptions& options = {},
               std::vector<float> typical = {});

  Eigen::Index numShapes() const { return compact_.cols() / forms_per_shape_; }

  /// \param rotations K x 24 M, all rotations of the query's compact forms, see SignatureProjection::rotations().
  /// \param num_nearest >= 0.
  /// \return shapes and their least distances over all forms and rotations, in [0, 2], scaled, nearest first, at most
  /// \p num_nearest. Exact where the index holds no more than num_candidates forms.
  /// \throws std::invalid_argument for another K or a negative \p num_nearest.
  std::vector<std::pair<int, float>> nearest(const Eigen::MatrixXf& rotations, int num_nearest) const;

private:
  std::vector<int> candidates(const Eigen::MatrixXf& rotations, std::size_t count) const;

  Eigen::MatrixXf compact_;
  Eigen::MatrixXf leading_;  // the first components of compact_
  int forms_per_shape_ = 1;
  std::vector<float> typical_;  // typical distance of each shape
  CompactIndexOptions options_;
};

}  // namespace pcl_symmetry
