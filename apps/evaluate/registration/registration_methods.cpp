#include "evaluate/registration/registration_methods.h"

#include <pcl/common/common.h>
#include <pcl/common/io.h>
#include <pcl/features/fpfh_omp.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/filters/filter.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/sample_consensus_prerejective.h>

#include <ctime>
#include <limits>
#include <memory>

#include "common/command_line/console.h"
#include "core/base/parallel.h"
#include "core/geometry/principal_axes.h"
#include "pcl_symmetry/registration/symmetry_registration.h"

namespace pcl_symmetry::apps {

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using NormalCloud = pcl::PointCloud<pcl::PointNormal>;
using FeatureCloud = pcl::PointCloud<pcl::FPFHSignature33>;

/// Share of the diagonal of the target's bounding box. chosen: half makes ICP and FPFH slow, twice loses small parts.
constexpr float kLeaf = 0.015f;
constexpr int kIcpIterations = 50;  // chosen: half stops early on long ways, twice changes few results

struct Leaf {
  float size;

  explicit Leaf(const Cloud& target) {
    Eigen::Vector4f low, high;
    pcl::getMinMax3D(target, low, high);
    size = kLeaf * (high - low).head<3>().norm();
  }

  Cloud::Ptr downsample(const Cloud::ConstPtr& cloud) const {
    pcl::VoxelGrid<pcl::PointXYZ> grid;
    grid.setInputCloud(cloud);
    grid.setLeafSize(size, size, size);
    auto voxels = pcl::make_shared<Cloud>();
    grid.filter(*voxels);
    return voxels;
  }
};

Cloud::Ptr finitePoints(const Cloud& cloud) {
  auto finite = pcl::make_shared<Cloud>();
  pcl::Indices kept;
  pcl::removeNaNFromPointCloud(cloud, *finite, kept);
  return finite;
}

Points pointsOf(const Cloud& cloud) {
  return cloud.getMatrixXfMap(3, 4, 0);
}

struct IcpResult {
  Eigen::Matrix4f transform;
  double fitness;
  bool converged;
};

IcpResult alignByIcp(pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ>& icp, const Eigen::Matrix4f& guess) {
  Cloud aligned;
  icp.align(aligned, guess);
  return {icp.getFinalTransformation(), icp.getFitnessScore(), icp.hasConverged()};
}

void prepareIcp(pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ>& icp, const Cloud::ConstPtr& source,
                const Cloud::ConstPtr& target) {
  icp.setInputSource(source);
  icp.setInputTarget(target);
  icp.setMaximumIterations(kIcpIterations);
  icp.setTransformationEpsilon(1e-10);
}

/// Wall time and processor time.
class Timer {
public:
  void stop(RegistrationAnswer& answer) {
    answer.milliseconds = watch_.lap();
    answer.processor_ms = 1000.0 * static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC;
  }

private:
  Stopwatch watch_;
  const std::clock_t start_ = std::clock();
};

using Registration = SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ>;

/// \param keeps whether tracks keep the target that was prepared.
RegisterToTarget bySymmetry(const std::shared_ptr<Registration>& registration, const Cloud::ConstPtr& target,
                            std::uint64_t seed, int num_threads, bool keeps = true) {
  registration->setRandomSeed(seed);
  registration->setNumberOfThreads(num_threads);
  const auto is_prepared = std::make_shared<bool>(false);
  return [=](const Cloud::ConstPtr& source, const std::optional<PoseGuess>& guess) {
    Cloud aligned;
    const auto align = [&] {
      registration->setInputSource(source);
      if (!*is_prepared) registration->setInputTarget(target);
      if (guess) {
        registration->setSearchAround(guess->angle, guess->distance);
        registration->align(aligned, guess->T_target_source.matrix().cast<float>());
      } else {
        registration->setSearchEverywhere();
        registration->align(aligned);
      }
    };
    if (guess && keeps && !*is_prepared) {
      align();
      *is_prepared = true;
    }
    RegistrationAnswer answer;
    Timer timer;
    align();
    timer.stop(answer);
    answer.converged = registration->hasConverged();
    answer.T_target_source = Eigen::Isometry3d(registration->getFinalTransformation().cast<double>());
    answer.support = registration->getScore().support;
    answer.conflict = registration->getScore().conflict;
    return answer;
  };
}

RegisterToTarget registerBySymmetry(const Cloud::ConstPtr& target, std::uint64_t seed, int num_threads) {
  return bySymmetry(std::make_shared<Registration>(), target, seed, num_threads);
}

RegisterToTarget registerAnew(const Cloud::ConstPtr& target, std::uint64_t seed, int num_threads) {
  return bySymmetry(std::make_shared<Registration>(), target, seed, num_threads, false);
}

RegisterToTarget registerByFrames(const Cloud::ConstPtr& target, std::uint64_t seed, int num_threads) {
  const auto registration = std::make_shared<Registration>();
  PoseSearchOptions options = registration->getSearchOptions();
  options.num_rotations = 0;
  registration->setSearchOptions(options);
  return bySymmetry(registration, target, seed, num_threads);
}

RegisterToTarget registerByRotations(const Cloud::ConstPtr& target, std::uint64_t seed, int num_threads) {
  const auto registration = std::make_shared<Registration>();
  registration->setUseFrames(false);
  return bySymmetry(registration, target, seed, num_threads);
}

RegistrationAnswer alignByPrincipalAxes(const Cloud::ConstPtr& raw, const Cloud::ConstPtr& target) {
  RegistrationAnswer answer;
  Timer timer;
  const Cloud::Ptr source = finitePoints(*raw);
  const Leaf leaf(*target);
  const PrincipalAxes of_source = principalAxes(pointsOf(*source)), of_target = principalAxes(pointsOf(*target));
  pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> coarse;
  prepareIcp(coarse, leaf.downsample(source), leaf.downsample(target));
  IcpResult best{Eigen::Matrix4f::Identity(), std::numeric_limits<double>::infinity(), false};
  for (const Eigen::Vector3d& signs :
       {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(1, -1, -1), Eigen::Vector3d(-1, 1, -1), Eigen::Vector3d(-1, -1, 1)}) {
    Eigen::Isometry3d guess(Eigen::Isometry3d::Identity());
    guess.linear() = of_target.axes * signs.asDiagonal() * of_source.axes.transpose();
    guess.translation() = of_target.center - guess.linear() * of_source.center;
    const IcpResult result = alignByIcp(coarse, guess.matrix().cast<float>());
    if (result.fitness < best.fitness) best = result;
  }
  pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> fine;
  prepareIcp(fine, source, target);
  const IcpResult result = alignByIcp(fine, best.transform);
  answer.T_target_source = Eigen::Isometry3d(result.transform.cast<double>());
  answer.converged = result.converged;
  timer.stop(answer);
  return answer;
}

/// Normals that look to the viewpoint, or else away from the middle.
NormalCloud::Ptr withNormals(const Cloud::ConstPtr& cloud, double radius,
                             const std::optional<Eigen::Vector3f>& viewpoint, int num_threads) {
  auto normals = pcl::make_shared<NormalCloud>();
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::PointNormal> estimation(num_threads);
  estimation.setInputCloud(cloud);
  estimation.setRadiusSearch(radius);
  estimation.compute(*normals);
  pcl::copyPointCloud(*cloud, *normals);
  const Eigen::Vector3f center = centerOfMass(pointsOf(*cloud)).cast<float>();
  for (pcl::PointNormal& point : *normals) {
    const Eigen::Vector3f outwards = viewpoint ? Eigen::Vector3f(*viewpoint - point.getVector3fMap())
                                               : Eigen::Vector3f(point.getVector3fMap() - center);
    if (outwards.dot(point.getNormalVector3fMap()) < 0.0f) point.getNormalVector3fMap() *= -1.0f;
  }
  return normals;
}

FeatureCloud::Ptr featuresOf(const NormalCloud::ConstPtr& cloud, double radius, int num_threads) {
  auto features = pcl::make_shared<FeatureCloud>();
  pcl::FPFHEstimationOMP<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> estimation(num_threads);
  estimation.setInputCloud(cloud);
  estimation.setInputNormals(cloud);
  estimation.setRadiusSearch(radius);
  estimation.compute(*features);
  return features;
}

RegisterToTarget registerByPrincipalAxes(const Cloud::ConstPtr& target, std::uint64_t, int) {
  return [=](const Cloud::ConstPtr& source, const std::optional<PoseGuess>&) {
    return alignByPrincipalAxes(source, target);
  };
}

RegistrationAnswer alignByFeatures(const Cloud::ConstPtr& raw, const Cloud::ConstPtr& target, int num_threads) {
  RegistrationAnswer answer;
  Timer timer;
  const int threads = resolveNumThreads(num_threads);
  const Cloud::Ptr source = finitePoints(*raw);
  const Leaf leaf(*target);
  const Eigen::Vector3f viewpoint = raw->sensor_origin_.head<3>();
  const NormalCloud::Ptr source_normals = withNormals(leaf.downsample(source), 2.5 * leaf.size, viewpoint, threads);
  const NormalCloud::Ptr target_normals = withNormals(leaf.downsample(target), 2.5 * leaf.size, std::nullopt, threads);

  pcl::SampleConsensusPrerejective<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> alignment;
  alignment.setInputSource(source_normals);
  alignment.setSourceFeatures(featuresOf(source_normals, 6.0 * leaf.size, threads));
  alignment.setInputTarget(target_normals);
  alignment.setTargetFeatures(featuresOf(target_normals, 6.0 * leaf.size, threads));
  alignment.setMaximumIterations(50'000);
  alignment.setNumberOfSamples(3);
  alignment.setCorrespondenceRandomness(5);
  alignment.setSimilarityThreshold(0.9f);
  alignment.setMaxCorrespondenceDistance(2.5 * leaf.size);
  alignment.setInlierFraction(0.25f);
  NormalCloud aligned;
  alignment.align(aligned);
  answer.converged = alignment.hasConverged();
  if (answer.converged) {
    pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
    prepareIcp(icp, source, target);
    icp.setMaxCorrespondenceDistance(5.0 * leaf.size);
    const IcpResult result = alignByIcp(icp, alignment.getFinalTransformation());
    answer.T_target_source = Eigen::Isometry3d(result.transform.cast<double>());
    answer.converged = result.converged;
  }
  timer.stop(answer);
  return answer;
}

RegisterToTarget registerByFeatures(const Cloud::ConstPtr& target, std::uint64_t, int num_threads) {
  return [=](const Cloud::ConstPtr& source, const std::optional<PoseGuess>&) {
    return alignByFeatures(source, target, num_threads);
  };
}

}  // namespace

const std::vector<RegistrationMethod>& registrationMethods() {
  static const std::vector<RegistrationMethod> methods = {
      {"symmetry", "SymmetryRegistration", registerBySymmetry},
      {"anew", "SymmetryRegistration, the target prepared for each scan", registerAnew},
      {"frames", "SymmetryRegistration, symmetry frames alone", registerByFrames},
      {"rotations", "SymmetryRegistration, rotations spread evenly alone", registerByRotations},
      {"pca", "principal axes + ICP", registerByPrincipalAxes},
      {"features", "FPFH + SampleConsensusPrerejective + ICP", registerByFeatures}};
  return methods;
}

}  // namespace pcl_symmetry::apps
