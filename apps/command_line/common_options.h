/// The flags that mean the same in every tool, and how they reach the option structs of the library.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pcl_symmetry/core/symmetry_map.h"
#include "pcl_symmetry/viewpoint.h"

namespace pcl_symmetry::apps {

/// The values of the flags that have the same meaning in every tool.
struct CommonOptions {
  std::optional<std::string> json_path;
  std::uint64_t seed = 0;
  int threads = 0;              ///< 0 = all
  int grid = 64;                ///< cells along an edge of the distance field
  std::optional<double> sigma;  ///< width of the Gaussian, input units; none: two cells
  int mesh_points = 10'000;     ///< number of points spread over a mesh
  Viewpoint viewpoint;
  bool takes_volumes = false;     ///< whether the tool analyses volumes
  std::vector<double> levels;     ///< intensities of volumes that count, two; empty: chosen from the values
  std::optional<double> surface;  ///< the intensity whose surface is analysed in place of the volume
  bool quiet = false;

  /// \return the seed of the library, whose default is 1 where that of the flag is 0
  std::uint64_t librarySeed() const { return seed + 1; }

  /// Sets seed, threads, grid and sigma of the library's options, e.g. DetectionOptions or FrameOptions.
  template <typename Options>
  void applyTo(Options& options) const {
    options.seed = librarySeed();
    options.num_threads = threads;
    options.num_cells = grid;
    options.sigma = sigma.value_or(0.0);
  }
};

/// The estimators of the transform.
inline const std::vector<std::string> kMethodNames{"sampled", "exact", "rotational", "voting"};

/// \param name one of kMethodNames.
inline TransformMethod methodNamed(const std::string& name) {
  return name == "exact"        ? TransformMethod::Convolution
         : name == "rotational" ? TransformMethod::Rotational
         : name == "voting"     ? TransformMethod::Voting
                                : TransformMethod::Sampled;
}

/// Number of points spread over a mesh by the tools of the database, where a model is described once and asked often.
/// chosen: half tells thin parts apart less well, twice takes twice the time.
constexpr int kDatabaseMeshPoints = 20'000;

/// Which of the common flags a tool offers.
enum CommonFlag : unsigned {
  kJson = 1u << 0,
  kSeed = 1u << 1,
  kThreads = 1u << 2,
  kGrid = 1u << 3,
  kViewpoint = 1u << 4,
  kQuiet = 1u << 5,
  kSigma = 1u << 6,
  kMeshPoints = 1u << 7,
  kVolumes = 1u << 8,
  kAnalysisFlags = (1u << 6) - 1,             ///< all but -sigma and -points
  kShapeFlags = kAnalysisFlags | kMeshPoints  ///< of tools that analyse one cloud or mesh
};

}  // namespace pcl_symmetry::apps
