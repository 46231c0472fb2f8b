/// Functions of libraries that take long to load, in modules that are loaded at the first call: VTK, which draws, and
/// PCL's library of files, which brings 60 others, 20 ms of processor time each; and Assimp, a tenth of the time that a
/// tool takes to find the planes of a mesh.
#pragma once

#include <string>

namespace pcl_symmetry::apps {

/// Loads MODULE.so from the folder in the executable's runtime path: its own folder in the build tree, otherwise the
/// library folder of the installation.
/// \return the address of a function with C linkage.
/// \throws InputError if there is no such module or function.
void* addressInModule(const std::string& module, const char* function);

template <typename Function>
Function* functionOf(const std::string& module, const char* name) {
  return reinterpret_cast<Function*>(addressInModule(module, name));
}

}  // namespace pcl_symmetry::apps
