/// What more cores bring: benchmark_scaling [MOST_THREADS], as many as there are cores by default. Clouds of 10 000
/// points of five models, or as many as a row says, or scans of them; wall time by the number of threads, which doubles
/// from row to row, and whether the results are the same bytes as those of one thread.
#include <Eigen/Geometry>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <thread>

#include "models.h"
#include "pcl_symmetry/core/plane_detection.h"
#include "pcl_symmetry/core/rotational_symmetry.h"
#include "pcl_symmetry/core/planar_transform.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::benchmarks;

constexpr int kNumPoints = 10'000, kManyPoints = 100'000;
constexpr int kScannedPoints = 40'000;  // chosen: of these, 7000 to 16 000 are seen from one side
constexpr int kRepeats = 15;            // chosen: the least of 15 is hardly changed by other programs
constexpr int kCloudsPerThread = 40;    // chosen: a second of work
constexpr double kMilliseconds = 1e3;   // derived: of a second
using Numbers = std::vector<double>;    // of a result, to compare it with another

/// What is given to the work.
enum class Input { Cloud, LargeCloud, Scan };

/// A cloud and, of a scan, what the scanner saw.
struct Given {
  Points points;
  std::optional<Visibility> visibility;
};

/// One kind of work: what it returns does not depend on the number of threads.
struct Work {
  std::string name;
  std::function<Numbers(const Given&, int num_threads)> run;
  Input input = Input::Cloud;
};

Given givenOf(const Model& model, Input input) {
  if (input != Input::Scan) return {model.sample(input == Input::Cloud ? kNumPoints : kManyPoints), std::nullopt};
  const Scan scan = model.scan(kScannedPoints);
  return {scan.points, Visibility::fromPoints(scan.points, scan.viewpoint)};
}

void append(Numbers& numbers, const Eigen::Vector3d& x) {
  numbers.insert(numbers.end(), x.data(), x.data() + x.size());
}

Numbers numbersOf(const Detection& detection) {
  Numbers numbers;
  for (const SymmetryPlane& plane : detection.planes) {
    append(numbers, plane.normal());
    numbers.insert(numbers.end(), {plane.offset(), plane.confidence, plane.share, plane.score});
  }
  for (const SymmetryTurn& turn : detection.turns) {
    append(numbers, turn.direction);
    numbers.insert(numbers.end(), {turn.confidence, turn.support, turn.off});
  }
  return numbers;
}

Numbers distanceTransform(const Given& given, int num_threads) {
  GaussianEdtOptions options;
  options.num_threads = num_threads;
  return {GaussianEdt(given.points, options).sum()};
}

/// A transform of 64 x 64 x 64 planes; the distance transform before it is timed with it.
Numbers exactTransform(const Given& given, int num_threads) {
  GaussianEdtOptions edt_options;
  edt_options.num_threads = num_threads;
  const GaussianEdt edt(given.points, edt_options);
  const PlaneGrid grid(64, 64, 64, edt.center(), edt.radius());
  ConvolutionTransformOptions options;
  options.num_threads = num_threads;
  const SymmetryMap map = convolutionTransform(edt, grid, options);
  return Numbers(map.values.begin(), map.values.end());
}

Numbers planes(const Given& given, int num_threads, bool approximate) {
  DetectionOptions options;
  options.num_threads = options.edt.num_threads = num_threads;
  options.approximate = approximate;
  return numbersOf(detectPlanes(given.points, options, nullptr, given.visibility ? &*given.visibility : nullptr));
}

Numbers rotations(const Given& given, int num_threads) {
  ObjectSymmetryOptions options;
  options.num_threads = num_threads;
  const ObjectSymmetries found = objectSymmetries(given.points, options);
  Numbers numbers{static_cast<double>(found.fold), found.support, found.confidence};
  append(numbers, found.center);
  for (const Eigen::Isometry3d& motion : found.discrete)
    numbers.insert(numbers.end(), motion.data(), motion.data() + motion.matrix().size());
  return numbers;
}

const std::vector<Work>& works() {
  static const std::vector<Work> works = {
      {"distance transform", distanceTransform},
      {"exact transform of 64 x 64 x 64 planes", exactTransform},
      {"planes of a whole cloud", [](const Given& given, int threads) { return planes(given, threads, false); }},
      {"the same, -approximate", [](const Given& given, int threads) { return planes(given, threads, true); }},
      {"planes of 100 000 points", [](const Given& given, int threads) { return planes(given, threads, false); },
       Input::LargeCloud},
      {"planes and turns of a scan", [](const Given& given, int threads) { return planes(given, threads, false); },
       Input::Scan},
      {"rotations", rotations},
  };
  return works;
}

double secondsOf(const std::function<void()>& body) {
  const auto start = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// What one number of threads gave.
struct Outcome {
  double amount;  ///< milliseconds of one cloud, or clouds a second
  std::vector<Numbers> results;
};

Outcome measureWork(const Work& work, const std::vector<Model>& models, int num_threads) {
  Outcome outcome{0.0, {}};
  for (const Model& model : models) {
    const Given given = givenOf(model, work.input);
    double least = std::numeric_limits<double>::infinity();
    Numbers numbers;
    for (int i = 0; i < kRepeats; ++i)
      least = std::min(least, secondsOf([&] { numbers = work.run(given, num_threads); }));
    outcome.amount += kMilliseconds * least / static_cast<double>(models.size());
    outcome.results.push_back(std::move(numbers));
  }
  return outcome;
}

/// Many clouds, each by one thread.
Outcome measureMany(const std::vector<Points>& clouds, int num_threads) {
  const std::size_t count = static_cast<std::size_t>(kCloudsPerThread) * static_cast<std::size_t>(num_threads);
  Outcome outcome{0.0, std::vector<Numbers>(clouds.size())};
  DetectionOptions options;
  options.num_threads = num_threads;
  const double seconds = secondsOf([&] {
    detectPlanesOfMany(
        count, [&](std::size_t i) { return clouds[i % clouds.size()]; },
        [&](std::size_t i, const Detection& found) { outcome.results[i % clouds.size()] = numbersOf(found); }, options);
  });
  outcome.amount = static_cast<double>(count) / seconds;
  return outcome;
}

/// \return whether two results are the same bytes.
bool same(const std::vector<Numbers>& a, const std::vector<Numbers>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Numbers& x, const Numbers& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0;
  });
}

/// Prints a row of the table for each number of threads.
/// \param faster more is better.
void printRows(const std::string& name, int most_threads, bool faster, const std::function<Outcome(int)>& measure) {
  const Outcome alone = measure(1);
  std::printf("| %s | 1 | %.1f | 1.0 | |\n", name.c_str(), alone.amount);
  for (int threads = 2; threads <= most_threads; threads *= 2) {
    const Outcome now = measure(threads);
    std::printf("| | %d | %.1f | %.1f | %s |\n", threads, now.amount,
                faster ? now.amount / alone.amount : alone.amount / now.amount,
                same(alone.results, now.results) ? "yes" : "NO");
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int most_threads = argc > 1 ? std::atoi(argv[1]) : static_cast<int>(std::thread::hardware_concurrency());
  if (argc > 2 || most_threads < 1) {
    std::fprintf(stderr, "usage: benchmark_scaling [MOST_THREADS], MOST_THREADS >= 1\n");
    return 2;
  }
  const char* folder = std::getenv("PCL_SYMMETRY_MODELS");
  const std::vector<Model> models = fiveModels(folder ? folder : "");
  std::vector<Points> clouds;
  for (const Model& model : models) clouds.push_back(model.sample(kNumPoints));
  std::printf("| | threads | ms | times as fast | same bytes |\n|---|---|---|---|---|\n");
  for (const Work& work : works())
    printRows(work.name, most_threads, false, [&](int threads) { return measureWork(work, models, threads); });
  printRows("many clouds, each by one thread: clouds a second", most_threads, true,
            [&](int threads) { return measureMany(clouds, threads); });
  return 0;
}
