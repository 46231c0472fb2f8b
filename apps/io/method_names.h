/// Names of the estimators of the transform on the command line.
#pragma once

#include <string>
#include <vector>

#include "pcl_symmetry/core/symmetry_map.h"

namespace pcl_symmetry::apps {

inline const std::vector<std::string> kMethodNames{"sampled", "exact", "rotational", "voting"};

/// \param name one of kMethodNames.
inline TransformMethod methodNamed(const std::string& name) {
  return name == "exact"        ? TransformMethod::Convolution
         : name == "rotational" ? TransformMethod::Rotational
         : name == "voting"     ? TransformMethod::Voting
                                : TransformMethod::Sampled;
}

}  // namespace pcl_symmetry::apps
