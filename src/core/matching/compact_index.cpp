#include "core/matching/compact_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

// Forms whose leading components are compared at once. chosen: half has too few sums at a time for the processor, twice
// too many for its registers.
constexpr std::size_t kForms = 64;
constexpr std::size_t kBlock =
    64;  // times kForms: work of a thread. chosen: half costs overhead, twice leaves threads idle

/// Rotations of a query, as the leading components are compared with them.
struct LeadingQueries {
  std::size_t count, rows;      // rows: the leading components, and one for the squared norm of the form
  std::vector<float> values;    // count x rows
  std::vector<float> sq_norms;  // halves
};

/// -1/2 of the squared distances of kForms forms to the nearest query.
/// \param leading rows x kForms.
PCL_SYMMETRY_MULTIVERSION
void nearnessOfForms(const float* leading, const LeadingQueries& queries, float* nearness) {
  for (std::size_t i = 0; i < kForms; ++i) nearness[i] = -std::numeric_limits<float>::max();
  for (std::size_t q = 0; q < queries.count; ++q) {
    float sums[kForms];
    for (std::size_t i = 0; i < kForms; ++i) sums[i] = -queries.sq_norms[q];
    const float* values = queries.values.data() + q * queries.rows;
    for (std::size_t row = 0; row < queries.rows; ++row) {
      const float value = values[row];
      const float* forms = leading + row * kForms;
      for (std::size_t i = 0; i < kForms; ++i) sums[i] += value * forms[i];
    }
    for (std::size_t i = 0; i < kForms; ++i) nearness[i] = nearness[i] < sums[i] ? sums[i] : nearness[i];
  }
}

/// The least distance of each shape among the forms.
/// \param forms rising indices of forms.
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

void CompactIndexOptions::validate() const {
  check(num_leading >= 1, "num_leading", num_leading, ">= 1");
  check(num_candidates >= 1, "num_candidates", num_candidates, ">= 1");
  check(candidate_share >= 0.0 && candidate_share <= 1.0, "candidate_share", candidate_share, "in [0, 1]");
  checkNumThreads(num_threads);
}

CompactIndex::CompactIndex(Eigen::MatrixXf compact, int forms_per_shape, const CompactIndexOptions& options,
                           std::vector<float> typical)
    : compact_(std::move(compact)), forms_per_shape_(forms_per_shape), typical_(std::move(typical)), options_(options) {
  options.validate();
  check(forms_per_shape >= 1, "forms_per_shape", forms_per_shape, ">= 1");
  check(compact_.cols() % forms_per_shape == 0, "number of compact forms", compact_.cols(),
        "a multiple of those of a shape");
  if (typical_.empty()) typical_.assign(static_cast<std::size_t>(numShapes()), 1.0f);
  check(typical_.size() == static_cast<std::size_t>(numShapes()), "number of typical distances",
        static_cast<double>(typical_.size()), "that of the shapes");
  for (const float distance : typical_) check(distance > 0.0f, "typical distance", distance, "> 0");
  num_leading_ = std::min<Eigen::Index>(compact_.rows(), options.num_leading);
  const auto rows = static_cast<std::size_t>(num_leading_) + 1;
  leading_.assign((static_cast<std::size_t>(compact_.cols()) + kForms - 1) / kForms * kForms * rows, 0.0f);
  for (Eigen::Index i = 0; i < compact_.cols(); ++i) {
    const auto form = static_cast<std::size_t>(i);
    float* values = leading_.data() + form / kForms * kForms * rows + form % kForms;
    for (Eigen::Index row = 0; row < num_leading_; ++row)
      values[static_cast<std::size_t>(row) * kForms] = compact_(row, i);
    values[(rows - 1) * kForms] = -0.5f * compact_.col(i).head(num_leading_).squaredNorm();
  }
}

Eigen::Index CompactIndex::numShapes() const {
  return compact_.cols() / forms_per_shape_;
}

/// The forms whose leading components are nearest to those of any rotation of the query, by rising index.
std::vector<int> CompactIndex::candidates(const Eigen::MatrixXf& rotations, std::size_t count) const {
  std::vector<int> forms(static_cast<std::size_t>(compact_.cols()));
  std::iota(forms.begin(), forms.end(), 0);
  if (count >= forms.size()) return forms;
  LeadingQueries queries{
      static_cast<std::size_t>(rotations.cols()), static_cast<std::size_t>(num_leading_) + 1, {}, {}};
  for (Eigen::Index q = 0; q < rotations.cols(); ++q) {
    const auto values = rotations.col(q).head(num_leading_);
    queries.values.insert(queries.values.end(), values.data(), values.data() + num_leading_);
    queries.values.push_back(1.0f);
    queries.sq_norms.push_back(0.5f * values.squaredNorm());
  }
  std::vector<float> nearness(forms.size());  // -1/2 of the squared scaled distance to the nearest rotation
  const std::size_t num_pieces = (forms.size() + kForms - 1) / kForms;
  parallelRanges(num_pieces, kBlock, options_.num_threads, [&](std::size_t begin, std::size_t end) {
    std::array<float, kForms> nearest;
    for (std::size_t piece = begin; piece < end; ++piece) {
      nearnessOfForms(leading_.data() + piece * kForms * queries.rows, queries, nearest.data());
      for (std::size_t i = piece * kForms; i < std::min(forms.size(), (piece + 1) * kForms); ++i)
        nearness[i] = nearest[i % kForms] / typical_[i / static_cast<std::size_t>(forms_per_shape_)];
    }
  });
  std::nth_element(forms.begin(), forms.begin() + static_cast<std::ptrdiff_t>(count), forms.end(), [&](int a, int b) {
    const float near_a = nearness[static_cast<std::size_t>(a)], near_b = nearness[static_cast<std::size_t>(b)];
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
  const auto share = static_cast<int>(options_.candidate_share * static_cast<double>(compact_.cols()));
  const std::vector<int> forms = candidates(
      rotations,
      static_cast<std::size_t>(std::max({options_.num_candidates, share, 2 * num_nearest * forms_per_shape_})));
  Eigen::MatrixXf near(compact_.rows(), static_cast<Eigen::Index>(forms.size()));
  for (std::size_t i = 0; i < forms.size(); ++i) near.col(static_cast<Eigen::Index>(i)) = compact_.col(forms[i]);
  const Eigen::RowVectorXf cosines = (rotations.transpose() * near).colwise().maxCoeff();
  std::vector<std::pair<int, float>> found = leastDistances(forms, cosines, forms_per_shape_);
  for (auto& [shape, distance] : found) distance /= std::sqrt(typical_[static_cast<std::size_t>(shape)]);
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  found.resize(std::min(found.size(), static_cast<std::size_t>(num_nearest)));
  return found;
}

}  // namespace pcl_symmetry
