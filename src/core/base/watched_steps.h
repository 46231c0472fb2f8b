/// Ends a long call between steps that run in one thread, outside the loops of parallel.h.
#pragma once

namespace pcl_symmetry {

/// Looks at the Watch of the call, as loops do after each block; for steps of some microseconds and more.
/// \throws what the watch throws; in a block of a loop, also where the loop was ended.
void lookAtWatch();

}  // namespace pcl_symmetry
