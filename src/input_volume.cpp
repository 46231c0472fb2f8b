#include "pcl_symmetry/core/volume_planes.h"
#include "pcl_symmetry/impl/symmetry_maxima_refinement.hpp"
#include "pcl_symmetry/impl/transform_analysis.hpp"

namespace pcl_symmetry::detail {

std::shared_ptr<const InputVolume> inputVolume(const std::shared_ptr<const ScalarGrid>& grid,
                                               const VolumeLevels* levels) {
  const InputVolume volume{grid, levels ? *levels : VolumeLevels()};
  withBadArguments([&] { volume.levels.validate(); });
  return grid ? std::make_shared<const InputVolume>(volume) : nullptr;
}

Detection planesOfVolume(const InputVolume& volume, const DetectionOptions& options) {
  return detectVolumePlanes(*volume.grid, options, volume.levels);
}

}  // namespace pcl_symmetry::detail
