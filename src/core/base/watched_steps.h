/// Ends a long call between steps that run in one thread, outside the loops of parallel.h.
#pragma once

namespace pcl_symmetry {

/// Looks at the Watch of the call, as loops do after each block. Costs little beside a microsecond.
/// \throws what the watch throws, and in a block of a loop that was ended.
void lookAtWatch();

}  // namespace pcl_symmetry
