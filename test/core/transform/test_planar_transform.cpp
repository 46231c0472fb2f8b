/// The estimators against the definition: a slow full sum over all cells with exact distances.
#include "pcl_symmetry/core/planar_transform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "core/transform/sampled_transform.h"
#include "pcl_symmetry/core/closest_point_search.h"
#include "shapes/scans.h"
#include "shapes/threads.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

/// D(f, gamma) = sum over cell centers x of f(x) f(gamma x) / sum f^2, with f of the definition: no grid, no
/// interpolation, 0 where it is less than 2e-7. (The k-d tree has its own test against brute force.)
class FullSum {
public:
  FullSum(const Points& points, const GaussianEdt& edt)
      : sq_sigma_(edt.sigma() * edt.sigma()), search_(makeFlannSearch(points)) {
    std::vector<Eigen::Vector3d> centers(edt.values().size());
    for (std::size_t i = 0; i < centers.size(); ++i) centers[i] = edt.cellCenter(i);
    const std::vector<double> values = f(centers);
    for (std::size_t i = 0; i < centers.size(); ++i) {
      sq_norm_ += values[i] * values[i];
      if (values[i] < 1e-4) continue;  // such cells hold less than 1e-4 of the sum
      cells_.push_back(centers[i]);
      values_.push_back(values[i]);
    }
  }

  double operator()(const ReflectionPlane& plane) const {
    std::vector<Eigen::Vector3d> reflected;
    for (const Eigen::Vector3d& cell : cells_) reflected.push_back(plane.reflect(cell));
    const std::vector<double> others = f(reflected);
    return std::inner_product(values_.begin(), values_.end(), others.begin(), 0.0) / sq_norm_;
  }

private:
  std::vector<double> f(const std::vector<Eigen::Vector3d>& x) const {
    Points queries(3, x.size());
    for (std::size_t i = 0; i < x.size(); ++i) queries.col(i) = x[i].cast<float>();
    std::vector<int> indices(x.size(), -1);
    std::vector<float> sq_distances;
    search_->searchWithin(queries, static_cast<float>(16.0 * sq_sigma_), indices, sq_distances);
    std::vector<double> values;
    for (const float sq_distance : sq_distances) values.push_back(std::exp(-sq_distance / sq_sigma_));
    return values;
  }

  double sq_sigma_;
  ClosestPointSearch::Ptr search_;
  std::vector<Eigen::Vector3d> cells_;
  std::vector<double> values_;
  double sq_norm_ = 0.0;
};

double prst(double d) {
  return std::sqrt(std::max(0.0, 0.5 * (1.0 + d)));
}

/// A shape, its EDT, bins of planes, and the full sum at some of them.
class Scene {
public:
  Scene(const Shape& shape, int num_cells, int num_bins, int grid_size = 16)
      : points(shape.cloud()),
        edt(points, cells(num_cells)),
        grid(grid_size, grid_size, grid_size, edt.center(), edt.radius()),
        num_bins_(num_bins) {}

  static GaussianEdtOptions cells(int num_cells) {
    GaussianEdtOptions options;
    options.num_cells = num_cells;
    return options;
  }

  double rmsError(const SymmetryMap& map) const {
    if (bins_.empty()) sumUp();
    std::vector<double> sq_errors;
    for (std::size_t i = 0; i < bins_.size(); ++i)
      sq_errors.push_back(std::pow(map.prst(bins_[i]) - prst(exact_[i]), 2));
    return std::sqrt(meanOf(sq_errors));
  }

  Points points;
  GaussianEdt edt;
  PlaneGrid grid;

private:
  /// The full sum takes most of the time of these tests, so that only those that compare with it make it.
  void sumUp() const {
    const FullSum full_sum(points, edt);
    RandomStream random(5);
    for (int i = 0; i < num_bins_; ++i) {
      bins_.push_back(random.below(grid.size()));
      exact_.push_back(full_sum(grid.plane(grid.bin(bins_.back()))));
    }
  }

  int num_bins_;
  mutable std::vector<std::size_t> bins_;
  mutable std::vector<double> exact_;
};

const std::vector<Scene>& scenes() {
  static const std::vector<Scene> scenes = [] {
    std::vector<Scene> made;
    for (const Shape& shape : {box(1000, Sampling::Random, 1), prism(5, 1000, Sampling::Random, 2),
                               asymmetricBlob(1000, 3), cylinder(1000, 4), scaleneTetrahedron(1000, 5)})
      made.emplace_back(moved(shape, randomPose(made.size() + 1)), 32, 20);
    return made;
  }();
  return scenes;
}

/// Sampled, exact and rotational maps in one test, as they share the full sum, which takes long.
TEST(Transforms, AreAsNearToTheFullSumAsTheirPageSays) {
  for (const Scene& scene : scenes()) {
    const SymmetryMap map = sampledTransform(scene.edt, scene.grid);
    EXPECT_LE(scene.rmsError(map), 0.01);
    EXPECT_EQ(map.method, TransformMethod::Sampled);
    EXPECT_EQ(map.sigma, scene.edt.sigma());
    EXPECT_EQ(map.values.size(), scene.grid.size());
    EXPECT_LE(scene.rmsError(convolutionTransform(scene.edt, scene.grid)), 0.003);
  }
  for (const Shape& shape :
       {moved(box(5000, Sampling::Random, 1), randomPose(1)), moved(asymmetricBlob(5000, 3), randomPose(3))}) {
    const Scene scene(shape, 64, 4);
    EXPECT_LE(scene.rmsError(convolutionTransform(scene.edt, scene.grid)), 0.002);
  }

  RotationalTransformOptions options;
  options.refined_share = 0.1;
  for (const Shape& shape :
       {moved(prism(5, 1000, Sampling::Random, 2), randomPose(2)), moved(asymmetricBlob(1000, 3), randomPose(3))}) {
    const Scene scene(shape, 24, 20, 8);
    const SymmetryMap full = rotationalTransform(scene.edt, scene.grid);
    EXPECT_LE(scene.rmsError(full), 0.002);
    const SymmetryMap refined = rotationalTransform(scene.edt, scene.grid, options);
    EXPECT_LE(scene.rmsError(refined), 0.01);
    EXPECT_EQ(refined[full.strongest()], full[full.strongest()]) << "the greatest values are refined";
    EXPECT_NE(refined.values, full.values);
  }

  // Independent samples would give samples^-1/2, stratified ones give more: a factor of 2 at least for 16 times as many
  // is asked for, until the error of the table (0.2 %) is met.
  const auto error = [](int num_samples) {
    std::vector<double> sq_errors;
    for (const Scene& scene : scenes())
      for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        SampledTransformOptions sampled;
        sampled.num_samples = num_samples;
        sampled.seed = seed;
        sq_errors.push_back(std::pow(scene.rmsError(sampledTransform(scene.edt, scene.grid, sampled)), 2));
      }
    return std::sqrt(meanOf(sq_errors));
  };
  const double coarse = error(16), middle = error(256), fine = error(4096);
  EXPECT_LT(middle, coarse / 4.0);
  EXPECT_LT(fine, middle / 2.0);
  EXPECT_LT(fine, 0.002);
}

TEST(Transforms, AtASharpMaximumConvolutionIsWithinThreePerCentOfDAndRotationsWithinAHalf) {
  // A box whose plane of symmetry is that of a bin, in a grid with few others.
  const PlaneGrid about_origin(16, 6, 1, Eigen::Vector3d::Zero(), 1.0);
  for (const int theta : {3, 8, 13}) {
    const ReflectionPlane plane = about_origin.plane({theta, 0, 0});
    const Eigen::Isometry3d pose(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), plane.normal()));
    const Scene scene(moved(box(5000, Sampling::Random, 1), pose), 32, 0);
    const PlaneGrid grid(16, 6, 1, Eigen::Vector3d::Zero(), scene.edt.radius());
    const std::size_t bin = grid.index({theta, 0, 0});
    const double exact = FullSum(scene.points, scene.edt)(grid.plane(grid.bin(bin)));
    EXPECT_GT(exact, 0.95);
    EXPECT_NEAR(convolutionTransform(scene.edt, grid)[bin], exact, 0.03);
    EXPECT_NEAR(rotationalTransform(scene.edt, grid)[bin], exact, 0.005);
  }
}

TEST(ConvolutionTransform, ManyBundlesAreAddedUpInTurn) {
  // With 160 cells and half the spacing a direction has a thousand bundles; the sums of 200 fit in 32 bits.
  ConvolutionTransformOptions options;
  options.spacing = 0.5;
  const GaussianEdt edt(box(20'000, Sampling::Random, 1).cloud(), Scene::cells(160));
  const PlaneGrid grid(4, 4, 17, edt.center(), edt.radius());
  SampledTransformOptions sampled;
  sampled.num_samples = 20'000;
  const SymmetryMap expected = sampledTransform(edt, grid, sampled), map = convolutionTransform(edt, grid, options);
  for (std::size_t i = 0; i < grid.size(); ++i) EXPECT_NEAR(map[i], expected[i], 0.02) << i;
}

/// Bin averages of D: the mean of convolution over 3^3 bins in one. The measure d theta d phi dr is that of the bins.
std::vector<double> binAverages(const Scene& scene) {
  const PlaneGrid& grid = scene.grid;
  const PlaneGrid fine(3 * grid.numTheta(), 3 * grid.numPhi(), 3 * grid.numRadius(), grid.center(), grid.radius());
  const SymmetryMap map = convolutionTransform(scene.edt, fine);
  std::vector<double> averages(grid.size(), 0.0);
  for (std::size_t i = 0; i < fine.size(); ++i) {
    const auto bin = fine.bin(i);
    averages[grid.index({bin.theta / 3, bin.phi / 3, bin.radius / 3})] += map[i] / 27.0;
  }
  return averages;
}

/// Errors of voting, from the scatter of independent seeds.
struct VotingError {
  VotingError(const Scene& scene, VotingTransformOptions options, int num_seeds) {
    const std::vector<double> averages = binAverages(scene);
    const int num_theta = scene.grid.numTheta();
    Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(num_theta), sq_sum = sum, mean = sum;
    for (int seed = 1; seed <= num_seeds; ++seed) {
      options.seed = static_cast<std::uint64_t>(seed);
      const SymmetryMap map = votingTransform(scene.edt, scene.grid, options);
      Eigen::ArrayXd error = Eigen::ArrayXd::Zero(num_theta);
      for (std::size_t i = 0; i < averages.size(); ++i) {
        error[scene.grid.bin(i).theta] += map[i] - averages[i];
        mean[scene.grid.bin(i).theta] += averages[i] / num_seeds;
      }
      sum += error, sq_sum += error.square();
    }
    const Eigen::ArrayXd standard = ((sq_sum - sum.square() / num_seeds) * num_seeds / (num_seeds - 1)).sqrt();
    normalized = sum / standard;
    relative = (standard / (mean * num_seeds)).tail(num_theta - 2);
  }

  Eigen::ArrayXd normalized;  ///< mean error over the bins of each theta, in standard errors
  Eigen::ArrayXd relative;    ///< standard error of this mean as a share of D, away from the pole
};

TEST(VotingTransform, EstimatesTheBinAverageWithinItsStandardError) {
  double sum = 0.0;
  int n = 0;
  VotingTransformOptions options;
  options.num_pairs = 50'000;
  for (const Scene& scene : scenes()) {
    const VotingError error(scene, options, 20);
    sum += error.normalized.square().sum();
    n += static_cast<int>(error.normalized.size());
    EXPECT_LT(error.relative.maxCoeff(), 0.01);
  }
  // The normalized errors of 20 seeds follow Student's t with 19 degrees of freedom: squares have the mean 19 / 17, and
  // the mean of 80 of them is more than 1.66 one time in a hundred.
  EXPECT_LT(sum / n, 1.66);
}

TEST(VotingTransform, NoVoteAsPublishedWeighsMoreThanThatOfPointsACellApart) {
  // Two points, so that many pairs are nearer than a cell.
  Points points(3, 2);
  points << -1.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f;
  const GaussianEdt edt(points, Scene::cells(16));
  const PlaneGrid grid(8, 8, 8, edt.center(), edt.radius());
  const std::vector<float> f = edt.sharpened(1.0 / 24.0);
  const double sum = std::accumulate(f.begin(), f.end(), 0.0);
  const double flat = 0.5 * sum * sum * edt.cellSize() / edt.sqNorm() / (grid.phiStep() * grid.radiusStep());
  int num_near = 0;
  VotingTransformOptions one{1, 0.0, 1, 1};
  for (; one.seed <= 2000; ++one.seed) {
    const SymmetryMap map = votingTransform(edt, grid, one);
    const std::size_t bin = map.strongest();
    const double theta = grid.bin(bin).theta * grid.thetaStep();
    const double greatest = flat / (std::cos(theta) - std::cos(theta + grid.thetaStep()));
    EXPECT_LE(map[bin], greatest * 1.0001);
    num_near += map[bin] > greatest * 0.9999;
  }
  EXPECT_GT(num_near, 0);
}

TEST(LineSums, VectorInstructionsGiveTheSumsOfThePlainLoop) {
  const GaussianEdt& edt = scenes()[2].edt;
  const CoordinateRows points = drawPoints(edt, 1300, 1, 1);  // more than one chunk
  for (const std::vector<float>& free_space : {std::vector<float>{}, edt.values()}) {
    const LookupTable table(edt, free_space, 1);
    for (const int num_planes : {1, 7, 16, 33}) {
      LineSums vector(edt, table, num_planes), scalar(edt, table, num_planes, true);
      const ParallelPlanes planes{{0.6f, 0.0f, 0.8f}, -8.0f, 16.0f / num_planes, num_planes};
      const LineSums::Totals reflected = vector.ofReflected(points, planes);
      EXPECT_EQ(reflected, scalar.ofReflected(points, planes)) << num_planes;
      EXPECT_NE(reflected.back(), std::vector<double>(num_planes, 0.0));
      const Eigen::Vector3f start(0.3f, -9.0f, 0.2f), step(0.1f, 0.5f, 0.2f);
      const LineSums::Totals moved = vector.ofMoved(points, start, step, 0, num_planes);
      EXPECT_EQ(moved, scalar.ofMoved(points, start, step, 0, num_planes)) << num_planes;
    }
  }
}

TEST(Transforms, SameBytesForAnyNumberOfThreads) {
  const Scene scene(moved(cylinder(1000, 4), randomPose(4)), 32, 0);
  const PlaneGrid grid(8, 8, 16, scene.edt.center(), scene.edt.radius());
  compareThreads([&](int num_threads) {
    SampledTransformOptions sampled;
    ConvolutionTransformOptions convolution;
    VotingTransformOptions voting;
    RotationalTransformOptions rotational;
    rotational.refined_share = 0.01;
    voting.num_pairs = 50'001;
    sampled.num_threads = convolution.num_threads = rotational.num_threads = voting.num_threads = num_threads;
    return std::array<std::vector<float>, 4>{
        sampledTransform(scene.edt, grid, sampled).values, convolutionTransform(scene.edt, grid, convolution).values,
        rotationalTransform(scene.edt, grid, rotational).values, votingTransform(scene.edt, grid, voting).values};
  });
}

TEST(Transforms, AGridMayHaveAnotherCenter) {
  // A grid about another point: its bins are other planes, at which D is that of the definition too.
  Scene scene(moved(box(1000, Sampling::Random, 1), randomPose(1)), 32, 20);
  const Eigen::Vector3d center = scene.edt.center() + Eigen::Vector3d(0.2, -0.1, 0.15);
  scene.grid = PlaneGrid(8, 8, 8, center, 0.6 * scene.edt.radius());
  ConvolutionTransformOptions close;
  close.spacing = 0.5;
  EXPECT_LE(scene.rmsError(convolutionTransform(scene.edt, scene.grid, close)), 0.002);
  EXPECT_LE(scene.rmsError(sampledTransform(scene.edt, scene.grid)), 0.01);
}

TEST(Transforms, ManySamplesDoNotOverflow) {
  const Scene& scene = scenes()[0];
  const PlaneGrid grid(2, 4, 5, scene.edt.center(), scene.edt.radius());
  SampledTransformOptions options;
  options.num_samples = 10'000;
  const SymmetryMap some = sampledTransform(scene.edt, grid, options);
  options.num_samples = 300'000;
  const SymmetryMap many = sampledTransform(scene.edt, grid, options);
  for (std::size_t i = 0; i < grid.size(); ++i) EXPECT_NEAR(some.prst(i), many.prst(i), 0.005);
}

TEST(Transforms, RefuseBadOptions) {
  const Scene& scene = scenes()[0];
  EXPECT_THROW(sampledTransform(scene.edt, scene.grid, {0}), std::invalid_argument);
  EXPECT_THROW(sampledTransform(scene.edt, scene.grid, {100, 1, -1}), std::invalid_argument);
  EXPECT_THROW(convolutionTransform(scene.edt, scene.grid, {0.0}), std::invalid_argument);
  EXPECT_THROW(convolutionTransform(scene.edt, scene.grid, {1.5}), std::invalid_argument);
  EXPECT_THROW(convolutionTransform(scene.edt, scene.grid, {0.9, -1}), std::invalid_argument);
  EXPECT_THROW(rotationalTransform(scene.edt, scene.grid, {0.0}), std::invalid_argument);
  EXPECT_THROW(rotationalTransform(scene.edt, scene.grid, {0.9, 1.1}), std::invalid_argument);
  EXPECT_THROW(votingTransform(scene.edt, scene.grid, {0}), std::invalid_argument);
  EXPECT_THROW(votingTransform(scene.edt, scene.grid, {100, -1.0}), std::invalid_argument);
  EXPECT_THROW(votingTransform(scene.edt, scene.grid, {100, 4.0, 1, -1}), std::invalid_argument);
}

class TransformWithFreeSpace : public testing::Test {
protected:
  const Scan scan_ = scan(blockBox(), {2.5, -3.0, 2.0});
  const Points points_ = scan_.cloud();
  const GaussianEdt edt_{points_};
  const PlaneGrid grid_{16, 32, 32, edt_.center(), edt_.radius()};
  const Visibility visibility_ = scan_.visibility();
  const std::vector<float> free_ = freeSpace(edt_, &visibility_);
};

TEST_F(TransformWithFreeSpace, IsSeenSymmetryOfTheTwoMeans) {
  SampledTransformOptions options;
  options.num_samples = 300;
  const SymmetryMap both = sampledTransform(edt_, grid_, options, free_);
  const SymmetryMap d = sampledTransform(edt_, grid_, options);
  const std::vector<float> f = freeOverlap(edt_, grid_, free_, options);
  ASSERT_EQ(both.values.size(), grid_.size());
  ASSERT_EQ(f.size(), grid_.size());
  SymmetryMap weighed = d;
  weighSeen(weighed, f);
  EXPECT_EQ(weighed.values, both.values);
  std::size_t num_weighed = 0;
  for (std::size_t i = 0; i < grid_.size(); ++i) {
    EXPECT_GE(f[i], 0.0f);
    EXPECT_EQ(both.values[i], static_cast<float>(seenSymmetry(d.values[i], f[i])));
    num_weighed += f[i] > 0.01f ? 1 : 0;
  }
  EXPECT_GT(num_weighed, grid_.size() / 10) << "free space is met by many planes";
}

TEST_F(TransformWithFreeSpace, EveryMethodGivesNearlyTheSameMap) {
  PlanarTransformOptions options;
  options.sampled.num_samples = 2000;
  options.voting.num_pairs = 2'000'000;
  const auto map = [&](TransformMethod method) {
    options.method = method;
    return planarTransform(edt_, grid_, centerOfMass(points_), options, &visibility_);
  };
  const SymmetryMap sampled = map(TransformMethod::Sampled);
  EXPECT_EQ(sampled.values, sampledTransform(edt_, grid_, options.sampled, free_).values);
  EXPECT_EQ(sampled.center_of_mass, centerOfMass(points_));
  const auto rms = [&](const SymmetryMap& other) {
    std::vector<double> sq_errors;
    for (std::size_t i = 0; i < grid_.size(); ++i)
      sq_errors.push_back(std::pow(other.values[i] - sampled.values[i], 2));
    return std::sqrt(meanOf(sq_errors));
  };
  const double convolution = rms(map(TransformMethod::Convolution)), voting = rms(map(TransformMethod::Voting));
  // 0.0060 and 0.0298 were measured: the noise of 2000 samples and 2 million pairs, and bins in place of their centers.
  EXPECT_LT(convolution, 0.01);
  EXPECT_LT(voting, 0.04);
}

TEST_F(TransformWithFreeSpace, RefusesFreeSpaceOfAnotherGrid) {
  const std::vector<float> wrong(100, 0.0f);
  EXPECT_THROW(sampledTransform(edt_, grid_, {}, wrong), std::invalid_argument);
  EXPECT_THROW(freeOverlap(edt_, grid_, wrong), std::invalid_argument);
}

}  // namespace
