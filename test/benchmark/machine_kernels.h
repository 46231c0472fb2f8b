/// What the smallest steps of the library's work take on this machine: the units of the roofline.
#pragma once

#include <string>
#include <vector>

namespace pcl_symmetry::benchmarks {

/// A step that is repeated many times, as fast as a loop without anything else runs it.
enum class Step {
  LookUp,       ///< a byte of a table of 64^3 bytes, along straight lines
  Trilinear,    ///< the eight values about a place in a table of 64^3 floats
  Exponential,  ///< exp() of a double
  Nearest,      ///< the nearest of 32 points that lie side by side: a cell of a grid and those about it
  NineNearest,  ///< the nine nearest of 64 such points
  ByteNear,     ///< a byte read from the second cache
  ByteFar,      ///< a byte read from memory
};
constexpr int kNumSteps = 7;

struct MachineStep {
  std::string name;
  double nanoseconds;  ///< of processor time for one step
};

/// Measures every step, in the order of Step.
std::vector<MachineStep> measureMachine();

}  // namespace pcl_symmetry::benchmarks
