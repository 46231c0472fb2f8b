#include "core/matching/signature_projection.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/base/symmetric_solvers.h"
#include "core/geometry/directions.h"
#include "core/matching/matching_rules.h"
#include "core/matching/shape_signature.h"

namespace pcl_symmetry {

namespace {

/// Index of the rotation a^T b, for indices \p a and \p b of rotations.
int quotient(int a, int b) {
  const auto& rotations = axisRotations();
  const Eigen::Matrix3i product = rotations[a].transpose() * rotations[b];
  return static_cast<int>(std::find(rotations.begin(), rotations.end(), product) - rotations.begin());
}

/// a * b, computed by blocks of rows.
Eigen::MatrixXf product(const Eigen::MatrixXf& a, const Eigen::Ref<const Eigen::MatrixXf>& b, int num_threads) {
  Eigen::MatrixXf result(a.rows(), b.cols());
  parallelRanges(a.rows(), 512, num_threads, [&](std::size_t begin, std::size_t end) {
    const auto first = static_cast<Eigen::Index>(begin), count = static_cast<Eigen::Index>(end - begin);
    result.middleRows(first, count).noalias() = a.middleRows(first, count) * b;
  });
  return result;
}

/// Inner products of all N shapes in all rotations. Shape i in rotation g has index g N + i.
Eigen::MatrixXf innerProducts(const Eigen::MatrixXf& signatures, SignatureRotation rotate, int num_threads) {
  const Eigen::Index n = signatures.cols();
  std::vector<Eigen::MatrixXf> with_rotated(kNumAxisRotations);
  parallelBlocks(kNumAxisRotations, num_threads, [&](std::size_t r) {
    Eigen::MatrixXf rotated(signatures.rows(), n);
    for (Eigen::Index i = 0; i < n; ++i) rotate(signatures.col(i).data(), static_cast<int>(r), rotated.col(i).data());
    with_rotated[r].noalias() = signatures.transpose() * rotated;
  });
  Eigen::MatrixXf products(kNumAxisRotations * n, kNumAxisRotations * n);
  for (int g = 0; g < kNumAxisRotations; ++g)
    for (int h = 0; h < kNumAxisRotations; ++h) products.block(g * n, h * n, n, n) = with_rotated[quotient(g, h)];
  return products;
}

struct Components {
  Eigen::MatrixXf vectors;    // orthonormal columns
  Eigen::VectorXf variances;  // variances along the columns, decreasing
};

/// The greatest eigenvalues of a symmetric matrix by subspace iteration.
Components principalComponents(const Eigen::MatrixXf& products, const ProjectionOptions& options) {
  const Eigen::Index size = products.rows();
  const Eigen::Index searched = std::min<Eigen::Index>(size, options.num_dimensions + 16);
  RandomStream random(1);
  const auto orthonormal = [&](const Eigen::MatrixXf& spanning) -> Eigen::MatrixXf {
    return orthonormalColumns(spanning.cast<double>()).cast<float>();
  };
  Eigen::MatrixXf space =
      Eigen::MatrixXf::NullaryExpr(size, searched, [&] { return static_cast<float>(random.uniform() - 0.5); });
  for (int i = 0; i < kMatching.num_iterations; ++i) space = product(products, orthonormal(space), options.num_threads);
  space = orthonormal(space);
  const Eigen::MatrixXf within = space.transpose() * product(products, space, options.num_threads);
  const SymmetricEigen<Eigen::MatrixXd> solver(within.cast<double>());
  const Eigen::VectorXf falling = solver.eigenvalues().reverse().cast<float>();
  check(falling[0] > 0.0f, "variance of the shapes", falling[0], "> 0");
  Eigen::Index kept = 0;
  while (kept < std::min<Eigen::Index>(searched, options.num_dimensions) && falling[kept] > 1e-5f * falling[0]) ++kept;
  return {space * solver.eigenvectors().cast<float>().rowwise().reverse().leftCols(kept), falling.head(kept)};
}

/// S x K: signatures times the basis are compact forms. The scale of the weights does not matter, as compact forms have
/// unit norm.
Eigen::MatrixXf whitenedBasis(const Eigen::MatrixXf& signatures, const Components& components, SignatureRotation rotate,
                              const ProjectionOptions& options) {
  const Eigen::Index n = signatures.cols(), k = components.variances.size();
  Eigen::MatrixXf basis = Eigen::MatrixXf::Zero(signatures.rows(), k);
  for (int r = 0; r < kNumAxisRotations; ++r) {
    const Eigen::MatrixXf part = product(signatures, components.vectors.middleRows(r * n, n), options.num_threads);
    parallelBlocks(k, options.num_threads, [&](std::size_t c) {
      const auto column = static_cast<Eigen::Index>(c);
      Eigen::VectorXf rotated(signatures.rows());
      rotate(part.col(column).data(), r, rotated.data());
      basis.col(column) += rotated;
    });
  }
  const Eigen::ArrayXf deviations = components.variances.array().sqrt();
  const Eigen::ArrayXf weights = deviations.pow(-static_cast<float>(kMatching.whitening));
  basis *= (weights / deviations).matrix().asDiagonal();
  return basis;
}

/// K x K matrices that rotate compact forms. A rotated component is the same sum over shapes in other rotations.
/// Components that a rotation maps to each other have the same variance, so that weights do not matter.
std::vector<Eigen::MatrixXf> rotationsOfComponents(const Components& components, Eigen::Index num_shapes,
                                                   int num_threads) {
  const Eigen::Index n = num_shapes;
  std::vector<Eigen::MatrixXf> rotations(kNumAxisRotations);
  parallelBlocks(kNumAxisRotations, num_threads, [&](std::size_t r) {
    Eigen::MatrixXf moved(components.vectors.rows(), components.vectors.cols());
    for (int g = 0; g < kNumAxisRotations; ++g)
      moved.middleRows(g * n, n) = components.vectors.middleRows(quotient(static_cast<int>(r), g) * n, n);
    rotations[r].noalias() = components.vectors.transpose() * moved;
  });
  return rotations;
}

}  // namespace

SignatureProjection SignatureProjection::fit(const Eigen::MatrixXf& signatures, const ProjectionOptions& options,
                                             SignatureRotation rotate) {
  check(rotate != rotateSignature || signatures.rows() == kSignatureSize, "size of a signature", signatures.rows(),
        "kSignatureSize");
  check(signatures.cols() >= 1, "number of shapes", signatures.cols(), ">= 1");
  const Components components = principalComponents(innerProducts(signatures, rotate, options.num_threads), options);
  SignatureProjection result;
  result.basis_ = whitenedBasis(signatures, components, rotate, options);
  result.rotations_ = rotationsOfComponents(components, signatures.cols(), options.num_threads);
  return result;
}

Eigen::MatrixXf SignatureProjection::project(const Eigen::Ref<const Eigen::MatrixXf>& signatures) const {
  check(signatures.rows() == basis_.rows(), "size of a signature", signatures.rows(), "that of the projection");
  Eigen::MatrixXf compact(numDimensions(), signatures.cols());
  // Column by column: a product of matrices would copy the basis, which takes longer than to use it.
  for (Eigen::Index i = 0; i < compact.cols(); ++i) {
    compact.col(i).noalias() = basis_.transpose() * signatures.col(i);
    compact.col(i).stableNormalize();
  }
  return compact;
}

Eigen::MatrixXf SignatureProjection::rotations(const Eigen::Ref<const Eigen::MatrixXf>& compact) const {
  check(compact.rows() == basis_.cols(), "size of a compact form", compact.rows(), "that of the projection");
  Eigen::MatrixXf result(numDimensions(), kNumAxisRotations * compact.cols());
  for (int r = 0; r < kNumAxisRotations; ++r)
    for (Eigen::Index i = 0; i < compact.cols(); ++i)
      result.col(kNumAxisRotations * i + r) = (rotations_[r] * compact.col(i)).stableNormalized();
  return result;
}

std::vector<float> SignatureProjection::toValues() const {
  std::vector<float> values(basis_.data(), basis_.data() + basis_.size());
  for (const Eigen::MatrixXf& rotation : rotations_)
    values.insert(values.end(), rotation.data(), rotation.data() + rotation.size());
  return values;
}

SignatureProjection SignatureProjection::fromValues(const std::vector<float>& values) {
  // S K + 24 K K values: solved for K.
  const double s = kSignatureSize, count = static_cast<double>(values.size());
  const auto k = static_cast<Eigen::Index>(
      std::lround((std::sqrt(s * s + 4.0 * kNumAxisRotations * count) - s) / (2.0 * kNumAxisRotations)));
  const auto size = static_cast<std::size_t>(kSignatureSize * k + kNumAxisRotations * k * k);
  check(k >= 1 && values.size() == size, "number of values", values.size(), "that of a projection");
  SignatureProjection result;
  const float* next = values.data();
  result.basis_ = Eigen::Map<const Eigen::MatrixXf>(next, kSignatureSize, k);
  next += kSignatureSize * k;
  for (int r = 0; r < kNumAxisRotations; ++r, next += k * k)
    result.rotations_.emplace_back(Eigen::Map<const Eigen::MatrixXf>(next, k, k));
  return result;
}

}  // namespace pcl_symmetry
