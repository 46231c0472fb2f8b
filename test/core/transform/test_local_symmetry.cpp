/// Symmetry at a scale, and where the space was seen to be free.
#include "pcl_symmetry/core/local_symmetry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "core/transform/sampled_transform.h"
#include "shapes/scans.h"
#include "shapes/threads.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

LocalSymmetryOptions optionsFor(double scale) {
  LocalSymmetryOptions options;
  options.scale = scale;
  return options;
}

TEST(LocalSymmetry, OfAWindowAroundAllIsThatOfTheShape) {
  const Points box = test::box(6000, test::Sampling::Random, 4).cloud();
  const GaussianEdt edt(box);
  Points asked(3, 2);
  asked.col(0).setZero();              // in all planes of symmetry
  asked.col(1) << 0.5f, 0.35f, 0.22f;  // in none
  const std::vector<float> all = localSymmetry(edt, asked, optionsFor(20.0 * edt.radius()));
  EXPECT_GT(all[0], 0.85f);
  EXPECT_LT(all[1], all[0] - 0.1f);
}

TEST(LocalSymmetry, OfAFlatPieceIsOneWhereverTheShapeIsNotSymmetric) {
  const Points box = test::box(20'000, test::Sampling::Random, 4).cloud();
  GaussianEdtOptions fine;
  fine.num_cells = 96;
  const GaussianEdt edt(box, fine);
  Eigen::Index top;
  box.row(2).maxCoeff(&top);
  const Points asked = box.col(top);
  EXPECT_GT(localSymmetry(edt, asked, optionsFor(0.12 * edt.radius()))[0], 0.8f);
}

TEST(LocalSymmetry, RefusesNoScaleAndIsTheSameForAnyNumberOfThreads) {
  const Points box = test::box(500, test::Sampling::Random, 4).cloud();
  const GaussianEdt edt(box);
  EXPECT_THROW(localSymmetry(edt, box, optionsFor(0.0)), std::invalid_argument);
  LocalSymmetryOptions options = optionsFor(0.3 * edt.radius());
  const Points asked = box.leftCols(100);
  compareThreads([&](int num_threads) {
    options.num_threads = num_threads;
    return localSymmetry(edt, asked, options);
  });
  const std::vector<float> values = localSymmetry(edt, asked, options);
  EXPECT_LT(*std::max_element(values.begin(), values.end()), 1.2f) << "D and the error of the samples";
}

const Eigen::Vector3d kViewpoint(0.5, -1.0, -5.0);

TEST(FreeSpace, IsFreeInFrontAndBesideAndNothingBehind) {
  const Points points = facing(sphere(20'000, 1).cloud(), kViewpoint);
  const auto seen = Visibility::fromPoints(points, kViewpoint);
  ASSERT_TRUE(seen);
  const GaussianEdt edt(points);
  const std::vector<float> free = freeSpace(edt, &*seen);
  ASSERT_EQ(free.size(), edt.values().size());
  const Eigen::Vector3d forward = -kViewpoint.normalized();
  int num_front = 0, num_behind = 0, num_lost = 0, num_wrong = 0;
  for (std::size_t i = 0; i < free.size(); ++i) {
    ASSERT_GE(free[i], 0.0f);
    ASSERT_LE(free[i], 1.0f - edt.values()[i]) << "on the surface nothing is free";
    const Eigen::Vector3d x = edt.cellCenter(i);
    // The picture is exact to a pixel: cells that lie farther than that from the surface and the silhouette are clear.
    const double across = (x - x.dot(forward) * forward).norm(), before = -x.dot(forward);
    if (before > 0.3 && x.norm() > 1.1) {
      ++num_front;
      num_lost += free[i] != 1.0f - edt.values()[i] ? 1 : 0;
    } else if (across < 0.8 && (x.norm() < 0.9 || before < 0.0)) {
      ++num_behind;
      num_wrong += free[i] != 0.0f ? 1 : 0;
    }
  }
  EXPECT_GT(num_front, 1000);
  EXPECT_GT(num_behind, 1000);
  EXPECT_EQ(num_lost, 0) << "of " << num_front << " cells in front";
  EXPECT_EQ(num_wrong, 0) << "of " << num_behind << " cells within the sphere and in its shadow";
  for (const int num_threads : {1, 8}) EXPECT_EQ(freeSpace(edt, &*seen, num_threads), free) << num_threads;
}

TEST(SeenSymmetry, HasTheLimitsThatItShould) {
  EXPECT_EQ(seenSymmetry(1.0, 0.0), 1.0);
  EXPECT_EQ(seenSymmetry(0.0, 0.0), 0.0) << "what nobody could see has no merit";
  EXPECT_EQ(seenSymmetry(0.0, 1.0), 0.0);
  for (double d = 0.0; d < 1.0; d += 0.1) {
    for (double f = 0.0; f < 1.0; f += 0.1) {
      EXPECT_GE(seenSymmetry(d, f), 0.0);
      EXPECT_LE(seenSymmetry(d, f), 1.0);
      EXPECT_GT(seenSymmetry(d + 0.1, f), seenSymmetry(d, f));
      EXPECT_TRUE(d == 0.0 || seenSymmetry(d, f + 0.1) < seenSymmetry(d, f)) << d << ", " << f;
    }
  }
}

}  // namespace
