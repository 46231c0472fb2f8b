/// What describes a shape, and the index that finds shapes by it.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "core/base/constants.h"
#include "core/base/random.h"
#include "core/geometry/directions.h"
#include "core/matching/compact_index.h"
#include "core/matching/shape_signature.h"
#include "core/matching/signature_projection.h"
#include "core/matching/symmetry_descriptor.h"
#include "pcl_symmetry/core/point_set.h"
#include "shapes/shapes.h"
#include "shapes/threads.h"

namespace pcl_symmetry {
namespace {

/// The surface of a box from -half to half; every tenth point on a knob, so that nothing is symmetric.
Points knobbedBox(const Eigen::Vector3d& half, const Eigen::Vector3d& knob, int num_points, std::uint64_t seed) {
  const auto surface = [&](const Eigen::Vector3d& of, int size) {
    return test::box(of, size, test::Sampling::Random, seed).cloud();
  };
  return test::joined(surface(half, num_points - num_points / 10),
                      surface(Eigen::Vector3d::Constant(0.05), num_points / 10).colwise() + knob.cast<float>());
}

Eigen::Map<const Eigen::VectorXf> vectorOf(const std::vector<float>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

float distance(const std::vector<float>& a, const std::vector<float>& b) {
  return (vectorOf(a) - vectorOf(b)).norm();
}

const Eigen::Matrix3d kOwnAxes = Eigen::Matrix3d::Identity();

TEST(ShapeSignature, HasUnitNormWhateverUnitAndPlace) {
  const Points box = knobbedBox({1.0, 0.7, 0.4}, {1.0, 0.5, 0.3}, 20'000, 1);
  const auto signature = shapeSignature(box, kOwnAxes);
  ASSERT_EQ(signature.size(), static_cast<std::size_t>(kSignatureSize));
  EXPECT_NEAR(vectorOf(signature).squaredNorm(), 1.0, 1e-4);
  for (const float unit : {1e-12f, 1e12f}) {
    const Points moved = (unit * box).colwise() + unit * Eigen::Vector3f(3.0f, -2.0f, 1.0f);
    EXPECT_LT(distance(shapeSignature(moved, kOwnAxes), signature), 0.1);
  }
}

TEST(ShapeSignature, TurnsWithTheAxes) {
  const Points box = knobbedBox({1.0, 0.7, 0.4}, {1.0, 0.5, 0.3}, 20'000, 1);
  const auto signature = shapeSignature(box, kOwnAxes);
  std::vector<float> rotated(kSignatureSize);
  for (int r = 0; r < kNumAxisRotations; ++r) {
    const Eigen::Matrix3d axes = axisRotations()[static_cast<std::size_t>(r)].cast<double>().transpose();
    const auto direct = shapeSignature(box, axes);
    rotateSignature(signature.data(), r, rotated.data());
    EXPECT_LT(distance(direct, rotated), 1e-3) << "rotation " << r;
    EXPECT_TRUE(r == 0 || distance(direct, signature) > 0.1) << "rotation " << r;
  }
}

TEST(ShapeSignature, TellsWallsFromFloors) {
  Points wall(3, 900), floor(3, 900);
  for (int i = 0; i < 900; ++i) {
    const float u = static_cast<float>(i % 30) / 30.0f, v = static_cast<float>(i / 30) / 30.0f;
    wall.col(i) << u, v, 0.2f * u;
    floor.col(i) << u, v, -0.2f * u;
  }
  EXPECT_GT(distance(shapeSignature(wall, kOwnAxes), shapeSignature(floor, kOwnAxes)), 0.3);
}

TEST(ShapeSignature, RefusesPointsWithoutExtent) {
  EXPECT_THROW(shapeSignature(Points(3, 0), kOwnAxes), std::invalid_argument);
  EXPECT_THROW(shapeSignature(Points::Ones(3, 5), kOwnAxes), std::invalid_argument);
  Points broken = Points::Random(3, 5);
  broken(1, 2) = std::nanf("");
  EXPECT_THROW(shapeSignature(broken, kOwnAxes), std::invalid_argument);
}

TEST(SignatureFrames, KeepTheFirstAxisAndSpreadTheOthers) {
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  const Points box = rotation.cast<float>() * knobbedBox({1.0, 0.7, 0.4}, {0.0, 0.0, 0.0}, 20'000, 1);
  SymmetryFrame frame;
  frame.axes.col(0) = rotation.col(1);
  frame.axes.col(1) = (rotation.col(0) + rotation.col(2)).normalized();
  frame.axes.col(2) = frame.axes.col(0).cross(frame.axes.col(1));
  const auto frames = signatureFrames(box, frame);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_TRUE(frames[1].isApprox(frame.axes));
  EXPECT_TRUE(frames[0].col(0).isApprox(rotation.col(1)));
  EXPECT_GT(std::abs(frames[0].col(1).dot(rotation.col(0))), 0.999);
  EXPECT_NEAR(frames[0].determinant(), 1.0, 1e-9);
}

/// Signatures of different boxes in their own axes.
Eigen::MatrixXf boxSignatures(int count) {
  Eigen::MatrixXf signatures(kSignatureSize, count);
  for (int i = 0; i < count; ++i) {
    RandomStream random(100 + static_cast<std::uint64_t>(i));
    const Eigen::Vector3d half(0.3 + random.uniform(), 0.3 + random.uniform(), 0.3 + random.uniform());
    const Eigen::Vector3d knob = half.cwiseProduct(Eigen::Vector3d(1.0, random.uniform(), random.uniform()));
    signatures.col(i) =
        vectorOf(shapeSignature(knobbedBox(half, knob, 3000, 7 + static_cast<std::uint64_t>(i)), kOwnAxes));
  }
  return signatures;
}

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
  test::compareThreads([&](int num_threads) {
    options.num_threads = num_threads;
    return SignatureProjection::fit(signatures, options).toValues();
  });
  const SignatureProjection one = SignatureProjection::fit(signatures, options);
  const SignatureProjection stored = SignatureProjection::fromValues(one.toValues());
  EXPECT_EQ(stored.numDimensions(), 32);
  EXPECT_EQ(stored.project(signatures), one.project(signatures));
  std::vector<float> cut = one.toValues();
  cut.pop_back();
  EXPECT_THROW(SignatureProjection::fromValues(cut), std::invalid_argument);
}

TEST(SignatureProjection, TellsApartWhatIsUnlikeAllOfFewShapes) {
  const SignatureProjection projection = SignatureProjection::fit(boxSignatures(3));
  const auto form = [&](const Eigen::Vector3d& half) -> Eigen::VectorXf {
    return projection.project(vectorOf(shapeSignature(knobbedBox(half, half, 3000, 1), kOwnAxes)));
  };
  EXPECT_LT(form({2.0, 0.05, 0.05}).dot(form({1.0, 1.0, 0.02})), 0.5) << "a rod and a plate";
}

TEST(SignatureProjection, RefusesWhatItCannotUse) {
  EXPECT_THROW(SignatureProjection::fit(Eigen::MatrixXf(kSignatureSize, 0)), std::invalid_argument);
  EXPECT_THROW(SignatureProjection::fit(Eigen::MatrixXf::Ones(5, 5)), std::invalid_argument);
  EXPECT_THROW(SignatureProjection::fit(Eigen::MatrixXf::Zero(kSignatureSize, 3)), std::invalid_argument);
}

/// Unit vectors whose components fall as those of compact signatures do.
Eigen::MatrixXf syntheticForms(int dimensions, int count, std::uint64_t seed) {
  RandomStream random(seed);
  Eigen::MatrixXf forms = Eigen::MatrixXf::NullaryExpr(dimensions, count, [&] {
    return static_cast<float>(random.uniform() + random.uniform() + random.uniform() - 1.5);
  });
  for (int d = 0; d < dimensions; ++d) forms.row(d) *= static_cast<float>(std::pow(1.0 + d, -0.5));
  forms.colwise().normalize();
  return forms;
}

/// The least distance of two shapes over all of their forms.
float signatureDistance(const Eigen::MatrixXf& rotations, const Eigen::Ref<const Eigen::MatrixXf>& compact) {
  return std::sqrt(std::max(0.0f, 2.0f - 2.0f * (rotations.transpose() * compact).maxCoeff()));
}

TEST(CompactIndex, FindsWhatAComparisonOfAllFinds) {
  const Eigen::MatrixXf forms = syntheticForms(32, 600, 1), queries = syntheticForms(32, 5, 2);
  CompactIndexOptions options;
  options.num_candidates = 600;
  const CompactIndex index(forms, 2, options);
  EXPECT_EQ(index.numShapes(), 300);
  const auto nearest = index.nearest(queries, 10);
  ASSERT_EQ(nearest.size(), 10u);
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const auto own = forms.middleCols(2 * nearest[i].first, 2);
    EXPECT_NEAR(nearest[i].second, signatureDistance(queries, own), 1e-4);
    EXPECT_TRUE(i == 0 || nearest[i].second >= nearest[i - 1].second);
  }
  int nearer = 0;
  for (int shape = 0; shape < 300; ++shape)
    nearer += signatureDistance(queries, forms.middleCols(2 * shape, 2)) < nearest.back().second - 1e-4f ? 1 : 0;
  EXPECT_EQ(nearer, 9);
}

TEST(CompactIndex, ScalesDistancesBeforeItChooses) {
  const Eigen::MatrixXf forms = syntheticForms(64, 6000, 1), queries = syntheticForms(64, 24, 2);
  RandomStream random(4);
  std::vector<float> typical;
  for (int i = 0; i < 3000; ++i) typical.push_back(static_cast<float>(0.5 + random.uniform()));
  const auto scaled = [&](int shape) {
    return signatureDistance(queries, forms.middleCols(2 * shape, 2)) /
           std::sqrt(typical[static_cast<std::size_t>(shape)]);
  };
  CompactIndexOptions options;
  options.num_leading = 64;
  const auto nearest = CompactIndex(forms, 2, options, typical).nearest(queries, 3);
  ASSERT_EQ(nearest.size(), 3u);
  int nearer = 0;
  for (int shape = 0; shape < 3000; ++shape) nearer += scaled(shape) < nearest[2].second - 1e-4f ? 1 : 0;
  EXPECT_EQ(nearer, 2) << "as a comparison of all";
  for (const auto& [shape, distance] : nearest) EXPECT_NEAR(distance, scaled(shape), 1e-4);
  EXPECT_THROW(CompactIndex(forms, 2, options, {1.0f}), std::invalid_argument);
  typical[7] = 0.0f;
  EXPECT_THROW(CompactIndex(forms, 2, options, typical), std::invalid_argument);
}

TEST(CompactIndex, FindsTheNearestOfManyByLeadingComponents) {
  const Eigen::MatrixXf forms = syntheticForms(64, 20'000, 1), noise = syntheticForms(64, 50, 3);
  const CompactIndex index(forms, 2);
  int found = 0;
  for (int i = 0; i < 50; ++i) {
    const Eigen::MatrixXf query = (forms.col(300 * i) + 0.5f * noise.col(i)).normalized();
    const auto nearest = index.nearest(query, 1);
    ASSERT_EQ(nearest.size(), 1u);
    found += nearest[0].first == 150 * i ? 1 : 0;
  }
  EXPECT_GE(found, 48);
}

TEST(CompactIndex, CopesWithLittleAndRefusesNonsense) {
  EXPECT_TRUE(CompactIndex().nearest(Eigen::MatrixXf::Ones(4, 1), 3).empty());
  const CompactIndex one(syntheticForms(4, 1, 1), 1);
  EXPECT_EQ(one.nearest(syntheticForms(4, 1, 1), 5).size(), 1u);
  EXPECT_TRUE(one.nearest(syntheticForms(4, 1, 1), 0).empty());
  EXPECT_THROW(one.nearest(syntheticForms(5, 1, 1), 1), std::invalid_argument);
  EXPECT_THROW(one.nearest(syntheticForms(4, 1, 1), -1), std::invalid_argument);
  EXPECT_THROW(CompactIndex(syntheticForms(4, 3, 1), 2), std::invalid_argument);
}

TEST(TypicalDistance, IsTheMeanOfTheNearest) {
  constexpr float kItself = std::numeric_limits<float>::infinity();
  EXPECT_FLOAT_EQ(typicalDistance({4.0f, 1.0f, kItself, 2.0f, 9.0f}, 3), (1.0f + 2.0f + 4.0f) / 3.0f);
  EXPECT_FLOAT_EQ(typicalDistance({4.0f, kItself, 1.0f}, 10), 2.5f);
  EXPECT_FLOAT_EQ(typicalDistance({kItself}), 1.0f);
  EXPECT_GT(typicalDistance({0.0f, 0.0f}), 0.0f);
}

TEST(SymmetryDescriptors, DoNotDependOnUnitsOrThreads) {
  const Points points = test::box({1.0, 0.7, 0.4}, 2000, test::Sampling::Random, 1).cloud();
  DescriptorOptions options;
  options.num_threads = 1;
  const SymmetryDescriptors one = symmetryDescriptors(points, Eigen::Isometry3d::Identity(), options);
  options.num_threads = 3;
  // A power of two changes no mantissa.
  const SymmetryDescriptors many = symmetryDescriptors(1024.0f * points, Eigen::Isometry3d::Identity(), options);
  EXPECT_EQ(one.prst, many.prst);
  EXPECT_EQ(one.prsd, many.prsd);
  EXPECT_EQ(one.gedt, many.gedt);
}

TEST(SymmetryDescriptors, RefuseWhatCannotBeDescribed) {
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  EXPECT_THROW(symmetryDescriptors(Points(3, 0), identity), std::invalid_argument);
  EXPECT_THROW(symmetryDescriptors(Points::Zero(3, 10), identity), std::invalid_argument);
  Points broken = Points::Random(3, 10);
  broken(1, 2) = std::nanf("");
  EXPECT_THROW(symmetryDescriptors(broken, identity), std::invalid_argument);
  DescriptorOptions options;
  options.num_samples = 0;
  EXPECT_THROW(symmetryDescriptors(Points::Random(3, 10), identity, options), std::invalid_argument);
}

TEST(PlaneDescriptorDistance, WeighsByTheSizeOfTheBins) {
  std::vector<float> a(kPRSTSize, 1.0f), b(kPRSTSize, 0.0f);
  double expected = 0.0;
  for (int t = 0; t < kDescriptorBins; ++t) expected += 1024.0 * std::sin((t + 0.5) * 0.5 * kPi / kDescriptorBins);
  EXPECT_NEAR(planeDescriptorDistance(a.data(), b.data(), kPRSTSize), std::sqrt(expected), 1e-2);
  EXPECT_NEAR(planeDescriptorDistance(a.data(), b.data(), kPRSDSize), std::sqrt(expected / 32.0), 1e-3);
  EXPECT_THROW(planeDescriptorDistance(a.data(), b.data(), 33), std::invalid_argument);
  EXPECT_NEAR(sqDistance(a.data(), b.data(), 1001), 1001.0, 1e-3);
}

}  // namespace
}  // namespace pcl_symmetry
