#include "recognition/compact_forms.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/check.h"
#include "core/matching/shape_signature.h"
#include "core/matching/reference_scaling.h"
#include "recognition/packed_bytes.h"

namespace pcl_symmetry::detail {

namespace {

/// Rows of a projection's numbers that belong together: mean and basis, then rotations.
Eigen::Map<const Eigen::MatrixXf> columnsOf(const std::vector<float>& values, std::size_t first, Eigen::Index rows) {
  return {values.data() + first, rows, static_cast<Eigen::Index>(values.size() - first) / rows};
}

void append(const Eigen::MatrixXf& matrix, std::vector<float>& values) {
  values.insert(values.end(), matrix.data(), matrix.data() + matrix.size());
}

std::string nextPart(UnpackedBytes& packed) {
  const auto size = packed.get<std::uint32_t>();
  return {packed.take(size), size};
}

}  // namespace

std::string CompactForm::packed() const {
  PackedBytes bytes;
  bytes.put(typical);
  bytes.append(packedMatrix(compact, MatrixBits::Sixteen));
  return bytes.bytes();
}

CompactForm CompactForm::unpacked(const std::string& bytes) {
  UnpackedBytes packed(bytes);
  CompactForm form;
  form.typical = packed.get<float>();
  form.compact = unpackedMatrix(bytes.substr(sizeof(float)));
  check(form.compact.cols() == kFormsPerModel && form.typical > 0.0f, "compact form", form.compact.cols(),
        "kFormsPerModel columns");
  return form;
}

CompactForms CompactForms::fit(std::vector<std::int64_t> ids, const Eigen::MatrixXf& signatures, int num_threads) {
  const auto count = static_cast<Eigen::Index>(ids.size());
  Eigen::MatrixXf first(signatures.rows(), count);
  for (Eigen::Index i = 0; i < count; ++i) first.col(i) = signatures.col(kFormsPerModel * i);
  ProjectionOptions options;
  options.num_threads = num_threads;
  CompactForms forms;
  forms.projection_ = SignatureProjection::fit(first, options);
  forms.ids_ = std::move(ids);
  forms.references_ = forms.projection_.project(signatures);
  return unpacked(forms.packed());  // the same as those who read it
}

CompactForm CompactForms::formOf(const Eigen::MatrixXf& signatures, std::int64_t id) const {
  CompactForm form;
  form.compact = projection_.project(signatures);
  const Eigen::RowVectorXf cosines = (rotations(form).transpose() * references_).colwise().maxCoeff();
  std::vector<float> distances;
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    const float cosine = cosines.segment<kFormsPerModel>(kFormsPerModel * static_cast<Eigen::Index>(i)).maxCoeff();
    distances.push_back(ids_[i] == id ? std::numeric_limits<float>::infinity()
                                      : std::sqrt(std::max(0.0f, 2.0f - 2.0f * cosine)));
  }
  form.typical = typicalDistance(std::move(distances));
  return form;
}

std::string CompactForms::packed() const {
  const std::vector<float> values = projection_.toValues();
  const Eigen::Index k = numDimensions();
  const std::size_t turns = static_cast<std::size_t>(kSignatureSize * (1 + k));
  PackedBytes bytes;
  bytes.put(static_cast<std::uint32_t>(ids_.size()));
  for (const std::int64_t id : ids_) bytes.put(id);
  const std::vector<float> basis(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(turns));
  bytes.putText(packedMatrix(columnsOf(basis, 0, kSignatureSize), MatrixBits::Sixteen));
  bytes.putText(packedMatrix(columnsOf(values, turns, k), MatrixBits::Sixteen));
  bytes.putText(packedMatrix(references_, MatrixBits::Sixteen));
  return bytes.bytes();
}

CompactForms CompactForms::unpacked(const std::string& bytes) {
  UnpackedBytes packed(bytes);
  CompactForms forms;
  const std::size_t count = packed.get<std::uint32_t>();
  if (count > packed.left() / sizeof(std::int64_t)) throw std::invalid_argument("is incomplete");
  for (std::size_t i = 0; i < count; ++i) forms.ids_.push_back(packed.get<std::int64_t>());
  std::vector<float> values;
  for (int i = 0; i < 2; ++i) append(unpackedMatrix(nextPart(packed)), values);
  forms.projection_ = SignatureProjection::fromValues(values);
  forms.references_ = unpackedMatrix(nextPart(packed));
  check(forms.references_.rows() == forms.numDimensions() &&
            forms.references_.cols() == kFormsPerModel * static_cast<Eigen::Index>(count),
        "number of references", forms.references_.cols(), "that of their compact forms");
  return forms;
}

}  // namespace pcl_symmetry::detail
