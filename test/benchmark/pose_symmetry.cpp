/// Cost of one call for poses of symmetric objects, by group.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "core/base/constants.h"
#include "core/base/random.h"
#include "pcl_symmetry/core/rotational_symmetry.h"

namespace {

using namespace pcl_symmetry;

constexpr int kNumPoses = 256;  // chosen: more poses than a cache line holds, so that none is guessed

std::vector<Eigen::Isometry3d> posesFrom(std::uint64_t seed) {
  RandomStream random(seed);
  const auto symmetric = [&] { return 2.0 * random.uniform() - 1.0; };
  std::vector<Eigen::Isometry3d> poses(kNumPoses);
  for (Eigen::Isometry3d& T : poses) {
    const Eigen::Quaterniond q(symmetric(), symmetric(), symmetric(), symmetric());
    T = Eigen::Translation3d(symmetric(), symmetric(), symmetric()) * q.normalized();
  }
  return poses;
}

ObjectSymmetries groupOf(const std::string& name) {
  const auto turn = [](const Eigen::Vector3d& axis, double angle) {
    return Eigen::Isometry3d(Eigen::AngleAxisd(angle, axis));
  };
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), z = Eigen::Vector3d::UnitZ(), origin = Eigen::Vector3d::Zero();
  if (name == "C2") return ObjectSymmetries::from({turn(z, kPi)}, {});
  if (name == "D6") return ObjectSymmetries::from({turn(z, kPi / 3.0), turn(x, kPi)}, {});
  if (name == "I") {
    std::vector<Eigen::Isometry3d> generators;
    for (const Eigen::Matrix3d& R : RotationGroup{RotationGroupKind::Icosahedral, 5}.generators())
      generators.emplace_back(Eigen::AngleAxisd(R));
    return ObjectSymmetries::from(generators, {});
  }
  if (name == "Cinf") return ObjectSymmetries::from({}, {{z, origin}});
  if (name == "Dinf") return ObjectSymmetries::from({turn(x, kPi)}, {{z, origin}});
  return ObjectSymmetries::from({}, {{z, origin}, {x, origin}});
}

template <typename Call>
void runOn(benchmark::State& state, const Call& call) {
  const std::vector<Eigen::Isometry3d> first = posesFrom(1), second = posesFrom(2);
  int k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(call(first[k], second[k]));
    k = (k + 1) % kNumPoses;
  }
}

void registerCalls(const std::string& name) {
  const auto add = [&](const std::string& call, const auto& body) {
    benchmark::RegisterBenchmark((call + "/" + name).c_str(), body);
  };
  const ObjectSymmetries group = groupOf(name);
  add("closestTo", [group](benchmark::State& state) {
    runOn(state, [&](const auto& a, const auto& b) { return group.closestTo(a, b).matrix().sum(); });
  });
  add("canonical", [group](benchmark::State& state) {
    runOn(state, [&](const auto& a, const auto&) { return group.canonical(a).matrix().sum(); });
  });
  add("distance", [group](benchmark::State& state) {
    runOn(state, [&](const auto& a, const auto& b) { return group.distance(a, b).angle; });
  });
  add("surfaceDistance of 1000 points", [group](benchmark::State& state) {
    RandomStream random(3);
    Points points(3, 1000);
    for (Eigen::Index i = 0; i < points.size(); ++i) points(i) = static_cast<float>(random.uniform() - 0.5);
    runOn(state, [&](const auto& a, const auto& b) { return group.surfaceDistance(a, b, points); });
  });
}

}  // namespace

int main(int argc, char** argv) {
  for (const char* name : {"C2", "D6", "I", "Cinf", "Dinf", "SO3"}) registerCalls(name);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
