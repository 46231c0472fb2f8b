/// Error against time as a picture.
#pragma once

#include <string>
#include <vector>

namespace pcl_symmetry::benchmarks {

struct Series {
  std::string name;
  std::vector<double> milliseconds;
  std::vector<double> error;  ///< share of PRST
};

/// Draws the series on two logarithmic axes, with a line at an error of one per cent.
/// \throws std::runtime_error where there is no display or the file cannot be written.
void writeErrorPlot(const std::string& file, const std::vector<Series>& series);

}  // namespace pcl_symmetry::benchmarks
