// The module that registers with PCL's own classes: see registration/pcl_registrations.h.
#include <pcl/common/common.h>
#include <pcl/common/io.h>
#include <pcl/features/fpfh_omp.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/filters/filter.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/sample_consensus_prerejective.h>

#include <cstdlib>
#include <limits>
#include <string>

#include "common/command_line/console.h"
#include "core/base/parallel.h"
#include "core/geometry/principal_axes.h"
#include "evaluate/registration/pcl_registrations.h"

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

RegistrationAnswer registerByPrincipalAxes(const Cloud::ConstPtr& raw, const Cloud::ConstPtr& target) {
  RegistrationAnswer answer;
  RegistrationTimer timer;
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

RegistrationAnswer registerByFeatures(const Cloud::ConstPtr& raw, const Cloud::ConstPtr& target, int num_threads) {
  RegistrationAnswer answer;
  RegistrationTimer timer;
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
  std::srand(1);  // the class draws from this stream: an answer does not depend on those before
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

class Registrations : public PCLRegistrations {
public:
  RegistrationAnswer byPrincipalAxes(const Cloud::ConstPtr& source, const Cloud::ConstPtr& target) const override {
    return registerByPrincipalAxes(source, target);
  }

  RegistrationAnswer byFeatures(const Cloud::ConstPtr& source, const Cloud::ConstPtr& target,
                                int num_threads) const override {
    return registerByFeatures(source, target, num_threads);
  }
};

}  // namespace

}  // namespace pcl_symmetry::apps

extern "C" const void* pclSymmetryModule(const char* version) {
  static const pcl_symmetry::apps::Registrations registrations;
  using pcl_symmetry::apps::PCLRegistrations;
  return std::string(version) == PCL_SYMMETRY_VERSION ? static_cast<const PCLRegistrations*>(&registrations) : nullptr;
}
