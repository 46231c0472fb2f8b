#include "io/load_module.h"

#include <dlfcn.h>

#include "command_line/tool_errors.h"

namespace pcl_symmetry::apps {

void* addressInModule(const std::string& module, const char* function) {
  // The module stays loaded to the end, because VTK cannot be unloaded.
  void* const library = ::dlopen((module + ".so").c_str(), RTLD_LAZY | RTLD_LOCAL);
  void* const address = library ? ::dlsym(library, function) : nullptr;
  if (!address) throw InputError(module + ".so cannot be loaded: " + ::dlerror());
  return address;
}

}  // namespace pcl_symmetry::apps
