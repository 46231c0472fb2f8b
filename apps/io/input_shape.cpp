#include "io/input_shape.h"

#include "command_line/file_errors.h"
#include "io/exact_coordinates.h"
#include "pcl_symmetry/mesh_sampling.h"

namespace pcl_symmetry::apps {

pcl::PCLPointCloud2 InputShape::fields() const {
  return shape.mesh ? toFields(*points, shape.shift) : shape.cloud;
}

InputShape loadInput(const std::string& path, int mesh_points, std::uint64_t seed) {
  InputShape input;
  input.path = path;
  input.shape = loadShape(path);
  input.points = input.shape.points;
  if (input.shape.mesh) {
    input.points = namingFile(path, [&] { return sampleMesh(*input.shape.mesh, mesh_points, seed); });
    if (input.points->empty()) throw InputError(path + ": no polygon has an area");
  }
  return input;
}

void warnOfLeftOut(const Console& console, const std::string& path, const Shape& shape) {
  for (const std::string& what : shape.left_out) console.warn(path + ": " + what + " left out");
}

InputShape loadInput(const Console& console, const std::string& path, const CommonOptions& common) {
  Step loading(console, "Loading " + path);
  InputShape input = loadInput(path, common.mesh_points, common.librarySeed());
  input.loading_ms = loading.done(std::to_string(input.points->size()) + " points");
  warnOfLeftOut(console, path, input.shape);
  return input;
}

}  // namespace pcl_symmetry::apps
