#include "io/load_module.h"

#include <dlfcn.h>

#include "command_line/tool_errors.h"
#include "io/cloud_files.h"
#include "io/drawing.h"
#include "io/mesh_files.h"

namespace pcl_symmetry::apps {

const void* loadModule(const std::string& name, const std::string& purpose) {
  const std::string file = name + ".so";
  const auto fail = [&](const std::string& why) {
    return InputError(purpose + " need " + file + ", which cannot be loaded: " + why);
  };
  // The module stays loaded to the end: VTK cannot be unloaded.
  void* const library = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (!library) throw fail(dlerror());
  using Entry = const void*(const char*);
  Entry* const entry = reinterpret_cast<Entry*>(dlsym(library, "pclSymmetryModule"));
  if (!entry) throw fail("it is no module of pcl_symmetry");
  const void* const found = entry(PCL_SYMMETRY_VERSION);
  if (!found) throw fail("it is that of another version than " PCL_SYMMETRY_VERSION);
  return found;
}

const Drawing& drawing() {
  static const auto* const loaded = static_cast<const Drawing*>(loadModule("pcl_symmetry_drawing", "pictures"));
  return *loaded;
}

const CloudFiles& cloudFiles() {
  static const auto* const loaded =
      static_cast<const CloudFiles*>(loadModule("pcl_symmetry_cloud_files", "PLY files and clouds to be written"));
  return *loaded;
}

const MeshFiles& meshFiles() {
  static const auto* const loaded =
      static_cast<const MeshFiles*>(loadModule("pcl_symmetry_mesh_files", "OBJ and STL files"));
  return *loaded;
}

}  // namespace pcl_symmetry::apps
