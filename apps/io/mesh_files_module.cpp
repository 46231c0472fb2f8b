/// The entry of the module pcl_symmetry_mesh_files.so.
#include "io/assimp_reader.h"

extern "C" const void* pclSymmetryModule(const char* version) {
  using namespace pcl_symmetry::apps;
  static const AssimpMeshFiles files;
  return std::string(version) == PCL_SYMMETRY_VERSION ? static_cast<const MeshFiles*>(&files) : nullptr;
}
