#include "evaluate/registration/registration_methods.h"

#include "common/command_line/console.h"
#include "common/modules/load_module.h"
#include "evaluate/registration/pcl_registrations.h"
#include "pcl_symmetry/registration/symmetry_registration.h"

namespace pcl_symmetry::apps {

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

RegistrationAnswer runSymmetryRegistration(SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ>& registration,
                                           const Cloud::ConstPtr& source, const Cloud::ConstPtr& target,
                                           const std::optional<PoseGuess>& guess, std::uint64_t seed, int num_threads) {
  RegistrationAnswer answer;
  Stopwatch watch;
  registration.setInputSource(source);
  registration.setInputTarget(target);
  registration.setRandomSeed(seed);
  registration.setNumberOfThreads(num_threads);
  Cloud aligned;
  if (guess) {
    registration.setSearchAround(guess->angle, guess->distance);
    registration.align(aligned, guess->T_target_source.matrix().cast<float>());
  } else {
    registration.align(aligned);
  }
  answer.converged = registration.hasConverged();
  answer.T_target_source = Eigen::Isometry3d(registration.getFinalTransformation().cast<double>());
  answer.support = registration.getScore().support;
  answer.conflict = registration.getScore().conflict;
  answer.milliseconds = watch.lap();
  return answer;
}

RegistrationAnswer registerBySymmetry(const Cloud::ConstPtr& source, const Cloud::ConstPtr& target,
                                      const std::optional<PoseGuess>& guess, std::uint64_t seed, int num_threads) {
  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  return runSymmetryRegistration(registration, source, target, guess, seed, num_threads);
}

RegistrationAnswer registerByFrames(const Cloud::ConstPtr& source, const Cloud::ConstPtr& target,
                                    const std::optional<PoseGuess>& guess, std::uint64_t seed, int num_threads) {
  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  PoseSearchOptions options = registration.getSearchOptions();
  options.num_rotations = 0;
  registration.setSearchOptions(options);
  return runSymmetryRegistration(registration, source, target, guess, seed, num_threads);
}

RegistrationAnswer registerByRotations(const Cloud::ConstPtr& source, const Cloud::ConstPtr& target,
                                       const std::optional<PoseGuess>& guess, std::uint64_t seed, int num_threads) {
  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  registration.setUseFrames(false);
  return runSymmetryRegistration(registration, source, target, guess, seed, num_threads);
}

RegistrationAnswer registerByPrincipalAxes(const Cloud::ConstPtr& source, const Cloud::ConstPtr& target,
                                           const std::optional<PoseGuess>&, std::uint64_t, int) {
  return pclRegistrations().byPrincipalAxes(source, target);
}

RegistrationAnswer registerByFeatures(const Cloud::ConstPtr& source, const Cloud::ConstPtr& target,
                                      const std::optional<PoseGuess>&, std::uint64_t, int num_threads) {
  return pclRegistrations().byFeatures(source, target, num_threads);
}

}  // namespace

const PCLRegistrations& pclRegistrations() {
  static const auto* const loaded = static_cast<const PCLRegistrations*>(
      loadModule("pcl_symmetry_pcl_registrations", "the methods pca and features"));
  return *loaded;
}

const std::vector<RegistrationMethod>& registrationMethods() {
  static const std::vector<RegistrationMethod> methods = {
      {"symmetry", "SymmetryRegistration", registerBySymmetry},
      {"frames", "SymmetryRegistration, symmetry frames alone", registerByFrames},
      {"rotations", "SymmetryRegistration, rotations spread evenly alone", registerByRotations},
      {"pca", "principal axes + ICP", registerByPrincipalAxes},
      {"features", "FPFH + SampleConsensusPrerejective + ICP", registerByFeatures}};
  return methods;
}

}  // namespace pcl_symmetry::apps
