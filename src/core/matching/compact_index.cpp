#include "core/matching/compact_index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/check.h"
#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/matching/matching_rules.h"

namespace pcl_symmetry {

namespace {

/// The least distance of each shape among the forms.
/// \param forms indices of forms, ascending.
/// \param cosines greatest inner product of each form with a rotation of the query.
std::vector<std::pair<int, float>> leastDistances(const std::vector<int>& forms, const Eigen::RowVectorXf& cosines,
                                                  int forms_per_shape) {
  std::vector<std::pair<int, float>> shapes;
  for (std::size_t i = 0; i < forms.size(); ++i) {
    const int shape = forms[i] / forms_per_shape;
    const float sq_distance = 2.0f - 2.0f * cosines[static_cast<Eigen::Index>(i)];
    const float distance = std::sqrt(std::max(0.0f, sq_distance));
    if (shapes.empty() || shapes.back().first != shape)
      shapes.emplace_back(shape, distance);
    else
      shapes.back().second = std::min(shapes.back().second, distance);
  }
  return shapes;
}

}  // namespace

float typicalDistance(std::vector<float> distances, std::size_t num_nearest) {
  distances.erase(std::remove(distances.begin(), distances.end(), std::numeric_limits<float>::infinity()),
                  distances.end());
  const std::size_t count = std::min(num_nearest, distances.size());
  if (count == 0) return 1.0f;
  std::partial_sort(distances.begin(), distances.begin() + count, distances.end());
  const float sum = std::accumulate(distances.begin(), distances.begin() + count, 0.0f);
  return std::max(sum / static_cast<float>(count), std::numeric_limits<float>::min());
}

CompactIndex::CompactIndex(Eigen::MatrixXf compact, int forms_per_shape, const CompactIndexOptions& options,
                           std::vector<float> typical)
    : compact_(std::move(compact)), forms_per_shape_(forms_per_shape), typical_(std::move(typical)), options_(options) {
  check(forms_per_shape >= 1, "forms_per_shape", forms_per_shape, ">= 1");
  check(compact_.cols() % forms_per_shape == 0, "number of compact forms", compact_.cols(),
        "a multiple of those of a shape");
  if (typical_.empty()) typical_.assign(numShapes(), 1.0f);
  check(typical_.size() == static_cast<std::size_t>(numShapes()), "number of typical distances",
        static_cast<double>(typical_.size()), "that of the shapes");
  for (const float distance : typical_) check(distance > 0.0f, "typical distance", distance, "> 0");
  leading_ = compact_.topRows(std::min<Eigen::Index>(compact_.rows(), options.num_leading));
}

/// The forms whose leading components are nearest to any rotation of the query, by ascending index.
std::vector<int> CompactIndex::candidates(const Eigen::MatrixXf& rotations, std::size_t count) const {
  std::vector<int> forms = allIndices(compact_.cols());
  if (count >= forms.size()) return forms;
  // -1/2 of the squared distance to the nearest rotation, scaled.
  const Eigen::MatrixXf queries = rotations.topRows(leading_.rows());
  const Eigen::VectorXf sq_norms = 0.5f * queries.colwise().squaredNorm().transpose();
  std::vector<float> nearness(forms.size());
  parallelPoints(forms.size(), options_.num_threads, [&](std::size_t begin, std::size_t end) {
    const auto block = leading_.middleCols(begin, end - begin);
    Eigen::MatrixXf products = queries.transpose() * block;
    products.colwise() -= sq_norms;
    const Eigen::RowVectorXf nearest = products.colwise().maxCoeff() - 0.5f * block.colwise().squaredNorm();
    for (std::size_t i = begin; i < end; ++i)
      nearness[i] =
          nearest[static_cast<Eigen::Index>(i - begin)] / typical_[i / static_cast<std::size_t>(forms_per_shape_)];
  });
  std::nth_element(forms.begin(), forms.begin() + count, forms.end(), [&](int a, int b) {
    const float near_a = nearness[a], near_b = nearness[b];
    return near_a != near_b ? near_a > near_b : a < b;
  });
  forms.resize(count);
  std::sort(forms.begin(), forms.end());
  return forms;
}

std::vector<std::pair<int, float>> CompactIndex::nearest(const Eigen::MatrixXf& rotations, int num_nearest) const {
  check(num_nearest >= 0, "num_nearest", num_nearest, ">= 0");
  if (compact_.cols() == 0) return {};
  check(rotations.rows() == compact_.rows(), "size of a compact form", rotations.rows(), "that of the index");
  const auto share = static_cast<int>(kMatching.candidate_share * static_cast<double>(compact_.cols()));
  const std::vector<int> forms = candidates(
      rotations,
      static_cast<std::size_t>(std::max({options_.num_candidates, share, 2 * num_nearest * forms_per_shape_})));
  Eigen::MatrixXf near(compact_.rows(), static_cast<Eigen::Index>(forms.size()));
  for (std::size_t i = 0; i < forms.size(); ++i) near.col(i) = compact_.col(forms[i]);
  const Eigen::RowVectorXf cosines = (rotations.transpose() * near).colwise().maxCoeff();
  std::vector<std::pair<int, float>> found = leastDistances(forms, cosines, forms_per_shape_);
  for (auto& [shape, distance] : found) distance /= std::sqrt(typical_[shape]);
  sortAscending(found, [](const auto& one) { return one.second; });
  found.resize(std::min(found.size(), static_cast<std::size_t>(num_nearest)));
  return found;
}

}  // namespace pcl_symmetry
