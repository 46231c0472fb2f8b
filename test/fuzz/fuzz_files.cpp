/// Readers of files. FUZZ_KIND in the environment names one of them: a kind of shape file such as pcd, or of volumes
/// such as nii.gz, or isaac, models_info.
#include <unistd.h>

#include <fstream>
#include <functional>
#include <map>

#include "bop/models_info.h"
#include "command_line/tool_errors.h"
#include "fuzz/byte_source.h"
#include "io/input_shape.h"
#include "io/load_module.h"
#include "io/shape_input.h"
#include "io/shape_readers.h"

// The modules are linked, not loaded.
void* pcl_symmetry::apps::addressInModule(const std::string&, const char* function) {
  return std::string(function) == "readGLB" ? reinterpret_cast<void*>(&readGLB) : reinterpret_cast<void*>(&readVTI);
}

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

using Reader = std::function<void(const std::string&)>;

void readShape(const std::string& path) {
  const Shape shape = loadShape(path);
  FUZZ_CHECK(shape.points && !shape.points->empty());
  FUZZ_CHECK(shape.shift.allFinite());
  if (!shape.mesh) return;
  for (const pcl::Vertices& polygon : shape.mesh->polygons) {
    FUZZ_CHECK(polygon.vertices.size() >= 3);
    for (const auto corner : polygon.vertices) FUZZ_CHECK(static_cast<std::size_t>(corner) < shape.points->size());
  }
}

void readModelsSymmetries(const std::string& path) {
  for (const auto& [name, listed] : readModelsInfo(path))
    for (const Eigen::Isometry3d& motion : listed.discrete) FUZZ_CHECK(motion.linear().isUnitary(1e-6));
}

void readVoxels(const std::string& path) {
  const Volume volume = loadVolume(path);
  FUZZ_CHECK(volume.grid && volume.grid->numVoxels() > 0);
}

struct Kind {
  std::string extension;
  Reader read;
};

Kind kindOf(const std::string& name) {
  static const std::map<std::string, Kind> kinds = {
      {"nii", {".nii", readVoxels}},
      {"nii.gz", {".nii.gz", readVoxels}},
      {"mgh", {".mgh", readVoxels}},
      {"nrrd", {".nrrd", readVoxels}},
      {"mha", {".mha", readVoxels}},
      {"vti", {".vti", readVoxels}},
      {"isaac", {".yaml", [](const std::string& path) { readIsaacAxes(path); }}},
      {"models_info", {".json", readModelsSymmetries}}};
  const auto known = kinds.find(name);
  return known == kinds.end() ? Kind{"." + name, readShape} : known->second;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const char* const name = std::getenv("FUZZ_KIND");
  static const Kind kind = kindOf(name ? name : "pcd");
  static const std::string path = "/dev/shm/pcl_symmetry_fuzz_" + std::to_string(::getpid()) + kind.extension;
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    kind.read(path);
  } catch (const std::invalid_argument&) {  // the tools put the file's name before it
  } catch (const InputError& error) {
    FUZZ_CHECK(std::string(error.what()).find('\n') == std::string::npos);
  }
  ::unlink(path.c_str());
  return 0;
}
