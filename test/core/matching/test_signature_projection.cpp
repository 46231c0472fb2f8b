#include "core/matching/signature_projection.h"

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/geometry/axis_rotations.h"
#include "shapes/knobbed_box.h"

namespace pcl_symmetry {

namespace {

/// Signatures of different boxes in their own axes.
Eigen::MatrixXf boxSignatures(int count) {
  Eigen::MatrixXf signatures(kSignatureSize, count);
  for (int i = 0; i < count; ++i) {
    RandomStream random(100 + static_cast<std::uint64_t>(i));
    const Eigen::Vector3d half(0.3 + random.uniform(), 0.3 + random.uniform(), 0.3 + random.uniform());
    const Eigen::Vector3d knob = half.cwiseProduct(Eigen::Vector3d(1.0, random.uniform(), random.uniform()));
    const auto signature = shapeSignature(test::knobbedBox(half, knob, 3000, 7 + static_cast<std::uint64_t>(i)),
                                          Eigen::Matrix3d::Identity());
    signatures.col(i) = Eigen::Map<const Eigen::VectorXf>(signature.data(), kSignatureSize);
  }
  return signatures;
}

}  // namespace

TEST(SignatureProjection, RotatesAsSignaturesDo) {
  const Eigen::MatrixXf signatures = boxSignatures(6);
  // All there is to know of 6 shapes: then the space of the components is closed.
  ProjectionOptions options;
  options.num_dimensions = 6 * kNumAxisRotations;
  const SignatureProjection projection = SignatureProjection::fit(signatures, options);
  Eigen::VectorXf rotated(kSignatureSize);
  const Eigen::VectorXf compact = projection.project(signatures.col(3));
  EXPECT_NEAR(compact.norm(), 1.0, 1e-5);
  const Eigen::MatrixXf rotations = projection.rotations(compact);
  for (int r = 0; r < kNumAxisRotations; ++r) {
    rotateSignature(signatures.col(3).data(), r, rotated.data());
    EXPECT_LT((projection.project(rotated) - rotations.col(r)).norm(), 0.05) << "rotation " << r;
  }
}

TEST(SignatureProjection, IsTheSameWithAnyNumberOfThreadsAndAfterStorage) {
  const Eigen::MatrixXf signatures = boxSignatures(4);
  ProjectionOptions options;
  options.num_dimensions = 32;
  options.num_threads = 1;
  const SignatureProjection one = SignatureProjection::fit(signatures, options);
  options.num_threads = 3;
  const SignatureProjection many = SignatureProjection::fit(signatures, options);
  EXPECT_EQ(one.toValues(), many.toValues());
  const SignatureProjection stored = SignatureProjection::fromValues(one.toValues());
  EXPECT_EQ(stored.numDimensions(), 32);
  EXPECT_EQ(stored.project(signatures), one.project(signatures));
  std::vector<float> cut = one.toValues();
  cut.pop_back();
  EXPECT_THROW(SignatureProjection::fromValues(cut), std::invalid_argument);
}

TEST(SignatureProjection, RefusesWhatItCannotUse) {
  EXPECT_THROW(SignatureProjection::fit(Eigen::MatrixXf(kSignatureSize, 0)), std::invalid_argument);
  EXPECT_THROW(SignatureProjection::fit(Eigen::MatrixXf::Ones(5, 5)), std::invalid_argument);
  EXPECT_THROW(SignatureProjection::fit(Eigen::MatrixXf::Zero(kSignatureSize, 3)), std::invalid_argument);
}

}  // namespace pcl_symmetry
