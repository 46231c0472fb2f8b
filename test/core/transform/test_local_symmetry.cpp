/// Symmetry within a window around each point.
#include "pcl_symmetry/core/local_symmetry.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;

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

TEST(LocalSymmetry, RefusesBadOptionsAndIsTheSameForAnyNumberOfThreads) {
  const Points box = test::box(500, test::Sampling::Random, 4).cloud();
  const GaussianEdt edt(box);
  EXPECT_THROW(localSymmetry(edt, box, optionsFor(0.0)), std::invalid_argument);
  LocalSymmetryOptions options = optionsFor(0.3 * edt.radius());
  options.num_threads = 1;
  const std::vector<float> expected = localSymmetry(edt, box, options);
  options.num_threads = 8;
  EXPECT_EQ(localSymmetry(edt, box, options), expected);
}

}  // namespace
