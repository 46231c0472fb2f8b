/// Threads, clusters and medians.
#include "core/base/parallel.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <ctime>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/base/random.h"
#include "core/base/statistics.h"
#include "core/segmentation/symmetry_splitting.h"

extern "C" void __tsan_init() __attribute__((weak));  // null where the program runs without the thread sanitizer

namespace {

using namespace pcl_symmetry;

TEST(Parallel, AForkedChildRunsLoopsAfterItsParentHas) {
  if (__tsan_init) GTEST_SKIP() << "the thread sanitizer ends a forked child that starts threads";
  const auto sum = [] {
    std::atomic<int> result{0};
    parallelBlocks(10, 4, [&](std::size_t b) {
      parallelBlocks(3, 2, [&](std::size_t c) { result += static_cast<int>(10 * b + c); });
    });
    return result.load();
  };
  const int expected = sum();
  const pid_t child = fork();
  if (child == 0) _exit(sum() == expected ? 0 : 1);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

TEST(Parallel, NothingToDoIsDone) {
  parallelBlocks(0, 4, [](std::size_t) { FAIL(); });
  parallelRanges(0, 10, 4, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(Parallel, RangesAreFixedPiecesWhateverTheThreads) {
  for (const int num_threads : {1, 2, 8}) {
    std::vector<std::size_t> ends(5, 0);
    parallelRanges(43, 10, num_threads, [&](std::size_t begin, std::size_t end) {
      ASSERT_EQ(begin % 10, 0u);
      ends[begin / 10] = end;
    });
    EXPECT_EQ(ends, (std::vector<std::size_t>{10, 20, 30, 40, 43}));
  }
}

TEST(Parallel, BlocksMayHaveBlocks) {
  for (const int num_threads : {1, 2, 8}) {
    std::vector<std::atomic<int>> sums(5);
    parallelBlocks(sums.size(), num_threads, [&](std::size_t b) {
      std::vector<std::atomic<int>> runs(b == 0 ? 10'000 : 3);
      parallelBlocks(runs.size(), num_threads, [&](std::size_t i) { ++runs[i]; });
      for (const auto& run : runs) ASSERT_EQ(run, 1) << "the call has returned before all of its blocks have run once";
      parallelRanges(100, 7, num_threads,
                     [&](std::size_t begin, std::size_t end) { sums[b] += static_cast<int>(end - begin); });
      ASSERT_EQ(sums[b], 100);
    });
    for (const auto& sum : sums) ASSERT_EQ(sum, 100) << num_threads << " threads";
  }
}

TEST(Parallel, ExceptionsOfBlocksInBlocksReachTheCaller) {
  for (const int num_threads : {1, 2, 8}) {
    std::atomic<int> num_caught{0};
    EXPECT_THROW(parallelBlocks(4, num_threads,
                                [&](std::size_t b) {
                                  try {
                                    parallelBlocks(50, num_threads, [&](std::size_t i) {
                                      if (i == 20 + b) throw std::invalid_argument("inner");
                                    });
                                  } catch (const std::invalid_argument&) {
                                    ++num_caught;
                                    if (b == 3) throw;
                                  }
                                }),
                 std::invalid_argument);
    EXPECT_EQ(num_caught, 4) << num_threads << " threads";
  }
}

TEST(Parallel, WaitingTakesNoTimeOfACore) {
  const std::clock_t begin = std::clock();
  parallelBlocks(2, 4, [](std::size_t b) {
    if (b == 0) std::this_thread::sleep_for(std::chrono::milliseconds(400));
  });
  EXPECT_LT(std::clock() - begin, 0.1 * CLOCKS_PER_SEC) << "of all threads";
}

TEST(ProgressMonitor, ReportsTheOuterLoopAndCancelsAllLoops) {
  for (const int num_threads : {1, 4}) {
    std::vector<double> shares;
    std::atomic<int> num_blocks{0};
    const auto loops = [&] {
      const ProgressMonitor monitor([&](double share) {
        shares.push_back(share);
        if (shares.size() == 3) throw 5;
      });
      parallelBlocks(1000, num_threads, [&](std::size_t) {
        parallelBlocks(10, num_threads, [&](std::size_t) {
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
          ++num_blocks;
        });
      });
    };
    EXPECT_THROW(loops(), int) << num_threads << " threads";
    EXPECT_EQ(shares.size(), 3u);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_TRUE(shares.back() > 0.0 && shares.back() < 0.9) << "it ends before the loop";
    EXPECT_LT(num_blocks, 9000);
  }
  std::atomic<int> sum{0};
  parallelBlocks(100, 4, [&](std::size_t b) { sum += static_cast<int>(b); });
  EXPECT_EQ(sum, 4950) << "loops work after one that was ended";
}

TEST(ProgressMonitor, CancelsStepsOfOneThread) {
  constexpr int kSize = 100'000;
  const Eigen::MatrixXf features = Eigen::MatrixXf::Random(8, kSize);
  const auto clusters = [&] {
    const ProgressMonitor monitor([](double) { throw 5; });
    kMeans(features, std::vector<float>(kSize, 1.0f), 2);
  };
  EXPECT_THROW(clusters(), int);
}

TEST(RandomStream, UniformIsUniform) {
  // Mean and variance of 1e5 uniform numbers have standard errors sqrt(1/12/n) = 9.1e-4 and sqrt(1/180/n) = 2.4e-4.
  constexpr int kNum = 100'000;
  for (std::uint64_t stream = 0; stream < 4; ++stream) {
    RandomStream random(1, stream);
    double sum = 0.0, sq_sum = 0.0;
    for (int i = 0; i < kNum; ++i) {
      const double u = random.uniform();
      ASSERT_GE(u, 0.0);
      ASSERT_LT(u, 1.0);
      sum += u - 0.5;
      sq_sum += (u - 0.5) * (u - 0.5);
    }
    EXPECT_NEAR(sum / kNum, 0.0, 4 * 9.1e-4);
    EXPECT_NEAR(sq_sum / kNum, 1.0 / 12.0, 4 * 2.4e-4);
  }
}

TEST(RandomStream, StreamsAreUnrelated) {
  // The correlation of n pairs of independent numbers has a standard error of 1 / sqrt(n).
  constexpr int kNum = 100'000;
  for (const auto& [seed, stream] : {std::pair{1, 1}, std::pair{1, 2}, std::pair{2, 0}}) {
    RandomStream a(1, 0), b(seed, stream);
    double product = 0.0;
    for (int i = 0; i < kNum; ++i) product += (a.uniform() - 0.5) * (b.uniform() - 0.5);
    EXPECT_NEAR(12.0 * product / kNum, 0.0, 4.0 / std::sqrt(kNum)) << seed << ", " << stream;
  }
}

TEST(RandomStream, BelowStaysBelowAndReachesAll) {
  RandomStream random(3);
  std::array<int, 7> counts{};
  for (int i = 0; i < 7000; ++i) {
    const auto value = random.below(7);
    ASSERT_LT(value, 7u);
    ++counts[value];
  }
  // Binomial: 1000 with a standard deviation of sqrt(7000 / 7 * 6 / 7) = 29.3.
  for (const int count : counts) EXPECT_NEAR(count, 1000, 5 * 29.3);
}

TEST(KMeans, FindsCloudsThatLieApart) {
  // Three clouds of features around (0, 0), (10, 0) and (0, 10), one after the other.
  const int size = 50;
  RandomStream random(3);
  const Eigen::MatrixXf features = Eigen::MatrixXf::NullaryExpr(2, 3 * size, [&](Eigen::Index k, Eigen::Index i) {
    return static_cast<float>(random.uniform() + (i / size == k + 1 ? 10.0 : 0.0));
  });
  const Clusters clusters = kMeans(features, std::vector<float>(3 * size, 1.0f), 3);
  ASSERT_EQ(clusters.centers.cols(), 3);
  for (int i = 0; i < 3 * size; ++i) EXPECT_EQ(clusters.labels[i], clusters.labels[i / size * size]) << i;
  EXPECT_EQ(std::set<int>(clusters.labels.begin(), clusters.labels.end()).size(), 3u);
}

TEST(KMeans, FeaturesWithoutWeightDoNotMoveTheCenters) {
  Eigen::MatrixXf features(1, 4);
  features << 0.0f, 1.0f, 10.0f, 1000.0f;
  const Clusters clusters = kMeans(features, {1.0f, 1.0f, 1.0f, 0.0f}, 2);
  std::multiset<float> centers(clusters.centers.data(), clusters.centers.data() + clusters.centers.size());
  EXPECT_EQ(centers, (std::multiset<float>{0.5f, 10.0f}));
}

TEST(KMeans, GivesFewerClustersThanAskedForWhereFeaturesAreEqual) {
  const Clusters clusters = kMeans(Eigen::MatrixXf::Ones(3, 5), std::vector<float>(5, 1.0f), 2);
  EXPECT_EQ(clusters.centers.cols(), 1);
  EXPECT_EQ(clusters.labels, std::vector<int>(5, 0));
  EXPECT_EQ(clusters.sq_error, 0.0);
}

using pcl_symmetry::median;

TEST(Median, IsTheUpperOne) {
  EXPECT_EQ(median(std::vector<float>{2.5f}), 2.5f);
  EXPECT_EQ(median(std::vector<int>{3, 1, 2}), 2);
  EXPECT_EQ(median(std::vector<int>{4, 1, 3, 2}), 3);
  EXPECT_EQ(median(std::vector<double>{7.0, 7.0, 7.0, 0.0}), 7.0);
}

}  // namespace
