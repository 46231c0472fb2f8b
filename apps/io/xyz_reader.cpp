#include "io/xyz_reader.h"

#include "io/file_text.h"

namespace pcl_symmetry::apps {

ExactShape readXYZ(const std::string& path) {
  const std::string text = readWholeFile(path);
  TokenReader reader(text, path);
  ExactShape shape;
  for (std::uint64_t i = 0; !reader.atEnd(); ++i) {
    Eigen::Vector3d point;
    for (int k = 0; k < 3; ++k) {
      const std::string what = std::string(1, "xyz"[k]) + " of point";
      point[k] = k == 0 ? reader.number(what.c_str(), i) : reader.numberOnLine(what.c_str(), i);
    }
    shape.vertices.push_back(point);
    reader.skipLine();
  }
  if (shape.vertices.empty()) throw InputError(path + ": has no points");
  return shape;
}

}  // namespace pcl_symmetry::apps
