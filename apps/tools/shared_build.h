/// A database that several processes build.
#pragma once

#include <string>
#include <vector>

#include "common/processes/shared_work.h"
#include "pcl_symmetry/symmetry_database.h"

namespace pcl_symmetry::apps {

enum class StoreOrder {
  AsDescribed,  ///< each as soon as it is described: an interrupted build keeps the most
  OfInputs      ///< the file is the same whatever the number of processes
};

/// SymmetryDatabase::build() by all processes of an MPI run: they describe models, and the first one stores each as
/// soon as it is described. Only the first one opens the file.
/// \return what was done, on the first process.
BuildReport buildShared(SharedWork& processes, const std::string& file, const DatabaseOptions& options,
                        const std::vector<ModelInput>& inputs, StoreOrder order, const BuildProgress& progress);

}  // namespace pcl_symmetry::apps
