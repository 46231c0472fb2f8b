/// The stages of the library: the least work that their results need, and the time that they take.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "models.h"
#include "speed/machine_kernels.h"

namespace pcl_symmetry::benchmarks {

/// How often each Step has to be taken, whatever the algorithm.
using Work = std::array<double, kNumSteps>;

struct Stage {
  std::string name;
  Work work;
  double milliseconds;  ///< of processor time of one thread, the least of all repetitions
};

/// Measures all stages with one thread.
/// \param whole a model with a plane of symmetry.
std::vector<Stage> measureStages(const Model& whole, int num_repeats);

}  // namespace pcl_symmetry::benchmarks
