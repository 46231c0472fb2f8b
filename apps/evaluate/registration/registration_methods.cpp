#include "evaluate/registration/registration_methods.h"

#include <memory>

#include "common/command_line/console.h"
#include "common/modules/load_module.h"
#include "evaluate/registration/pcl_registrations.h"
#include "pcl_symmetry/registration/symmetry_registration.h"

namespace pcl_symmetry::apps {

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

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
    RegistrationTimer timer;
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

RegisterToTarget registerByPrincipalAxes(const Cloud::ConstPtr& target, std::uint64_t, int) {
  return [=](const Cloud::ConstPtr& source, const std::optional<PoseGuess>&) {
    return pclRegistrations().byPrincipalAxes(source, target);
  };
}

RegisterToTarget registerByFeatures(const Cloud::ConstPtr& target, std::uint64_t, int num_threads) {
  return [=](const Cloud::ConstPtr& source, const std::optional<PoseGuess>&) {
    return pclRegistrations().byFeatures(source, target, num_threads);
  };
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
      {"anew", "SymmetryRegistration, the target prepared for each scan", registerAnew},
      {"frames", "SymmetryRegistration, symmetry frames alone", registerByFrames},
      {"rotations", "SymmetryRegistration, rotations spread evenly alone", registerByRotations},
      {"pca", "principal axes + ICP", registerByPrincipalAxes},
      {"features", "FPFH + SampleConsensusPrerejective + ICP", registerByFeatures}};
  return methods;
}

}  // namespace pcl_symmetry::apps
