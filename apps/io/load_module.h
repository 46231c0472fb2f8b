/// Libraries that a tool loads when it needs them.
#pragma once

#include <string>

namespace pcl_symmetry::apps {

/// Loads NAME.so from where the executable's runtime path says: its own folder in the build tree, the library folder of
/// the installation otherwise. LD_LIBRARY_PATH comes before that.
/// \param purpose what it is for, in the error
/// \return what its function pclSymmetryModule() returns, given the version of this program
/// \throws InputError where it cannot be loaded or is that of another version
const void* loadModule(const std::string& name, const std::string& purpose);

}  // namespace pcl_symmetry::apps
