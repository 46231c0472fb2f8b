/// Registrations as PCL's users make them without symmetry, in a module that is loaded when the first one is run.
///
/// PCL's libraries of features, filters and registration take ten times longer to load than the evaluator without them.
#pragma once

#include "evaluate/registration/registration_methods.h"

namespace pcl_symmetry::apps {

/// Implemented by the module pcl_symmetry_pcl_registrations.so. Arguments as those of RegistrationMethod::toTarget and of what it returns.
class PCLRegistrations {
public:
  virtual ~PCLRegistrations() = default;
  virtual RegistrationAnswer byPrincipalAxes(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& source,
                                             const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& target) const = 0;
  virtual RegistrationAnswer byFeatures(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& source,
                                        const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& target,
                                        int num_threads) const = 0;
};

/// Loads the module at the first call.
/// \throws InputError where it is missing or that of another version.
const PCLRegistrations& pclRegistrations();

}  // namespace pcl_symmetry::apps
