/// How a tool takes memory from the system, and gives it back.
#pragma once

namespace pcl_symmetry::apps {

/// For one input: what is allocated from now on lies in one heap of large pages, where the system has them. The first
/// use of each page costs more than what most steps do with it.
void takeLargePages();

/// For many inputs: what was freed is given back now, and large blocks from now on when they are freed.
void giveMemoryBack();

}  // namespace pcl_symmetry::apps
