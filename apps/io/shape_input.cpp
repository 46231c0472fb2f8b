#include "io/shape_input.h"

#include <pcl/conversions.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <cctype>

#include "io/answers.h"
#include "io/cloud_fields.h"
#include "io/file_text.h"
#include "io/input_shape.h"
#include "io/load_module.h"
#include "io/shape_readers.h"
#include "pictures/drawing.h"

namespace pcl_symmetry::apps {

namespace {

/// \param shape a shape with the fields of a cloud, or without: then the coordinates become the fields.
/// \return the shape with its points, with a shift if float loses digits, and its mesh.
Shape completed(const std::string& path, Shape shape, const std::vector<Eigen::Vector3d>& exact,
                std::vector<pcl::Vertices> polygons) {
  if (exact.empty()) throw InputError(path + ": has no points");
  shape.shift = shiftFor(exact);
  shape.points.reset(new Cloud(shifted(exact, shape.shift)));
  if (shape.cloud.fields.empty()) shape.cloud = toFields(*shape.points, shape.shift);
  shape.points->width = shape.cloud.width;
  shape.points->height = shape.cloud.height;
  if (!polygons.empty()) {
    shape.mesh.emplace();
    shape.mesh->polygons = std::move(polygons);
    shape.mesh->cloud = shape.cloud;
    // Meshes are always read as PointXYZ.
    if (VectorField(shape.cloud).isDouble() || !shape.shift.isZero(0.0))
      pcl::toPCLPointCloud2(*shape.points, shape.mesh->cloud);
  }
  shape.points->is_dense = std::all_of(shape.points->begin(), shape.points->end(),
                                       [](const pcl::PointXYZ& point) { return point.getVector3fMap().allFinite(); });
  shape.points->sensor_origin_ = shape.sensor_origin;
  // With coordinates so large, an origin of zero is a default, and has to stay one.
  if (!shape.sensor_origin.head<3>().isZero(0.0f))
    shape.points->sensor_origin_.head<3>() = (shape.sensor_origin.head<3>().cast<double>() - shape.shift).cast<float>();
  shape.points->sensor_orientation_ = shape.sensor_orientation;
  return shape;
}

Shape fromCloudFile(const std::string& path, CloudFile file) {
  const VectorField xyz(file.cloud);
  std::vector<Eigen::Vector3d> exact(std::size_t{file.cloud.width} * file.cloud.height);
  for (std::size_t i = 0; i < exact.size(); ++i) exact[i] = xyz.get(file.cloud, i);
  Shape shape;
  shape.cloud = std::move(file.cloud);
  shape.sensor_origin = file.sensor_origin;
  shape.sensor_orientation = file.sensor_orientation;
  shape.left_out = std::move(file.left_out);
  return completed(path, std::move(shape), exact, std::move(file.polygons));
}

Shape fromExact(const std::string& path, ExactShape exact) {
  Shape shape;
  shape.left_out = std::move(exact.left_out);
  return completed(path, std::move(shape), exact.vertices, std::move(exact.polygons));
}

bool isOFF(const std::string& word) {
  const std::size_t tail = word.find("OFF");
  return tail != std::string::npos && tail <= 4 && word.find_first_not_of("STCN") >= tail;
}

bool isOneOf(const std::string& word, std::initializer_list<const char*> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// \param name name of the file in messages.
Shape shapeOf(const std::string& name, const std::string& text, const std::string& extension) {
  if (extension == ".pcd") return fromCloudFile(name, readPCD(name, text));
  if (extension == ".ply") return fromCloudFile(name, readPLY(name, text));
  if (extension == ".off") return fromExact(name, readOFF(name, text));
  if (extension == ".obj") return fromExact(name, readOBJ(name, text));
  if (isOneOf(extension, {".xyz", ".pts", ".asc", ".txt", ".csv"})) return fromExact(name, readColumns(name, text));
  if (extension == ".stl") return fromExact(name, readSTL(name, text));
  if (extension == ".glb") {
    ExactShape shape;
    functionOf<decltype(readGLB)>("pcl_symmetry_mesh_files", "readGLB")(name, text, shape);
    return fromExact(name, std::move(shape));
  }
  throw InputError(name + ": unknown extension '" + extension + "', must be " + kShapeFiles +
                   "; planes and map also read volumes, " + kVolumeFiles + ", and scene depth images, .png");
}

}  // namespace

bool hasShapeExtension(const std::string& path) {
  const std::string ending = boost::algorithm::to_lower_copy(boost::filesystem::path(path).extension().string());
  if (ending.empty()) return false;
  const std::string known = boost::algorithm::replace_all_copy(std::string(" ") + kShapeFilesOfFolders + " ", ",", " ");
  return known.find(" " + ending + " ") != std::string::npos;
}

std::string extensionOfContent(const std::string& content) {
  if (boost::algorithm::starts_with(content, "glTF")) return ".glb";
  if (boost::algorithm::starts_with(content, "# .PCD")) return ".pcd";
  const std::string begin = content.substr(0, 1 << 16);
  TokenReader tokens(begin, "standard input");
  const std::string word(tokens.next());
  if (word == "ply") return ".ply";
  if (isOneOf(word, {"VERSION", "FIELDS", "COLUMNS"})) return ".pcd";
  if (boost::algorithm::iequals(word, "solid") || isBinarySTL(content)) return ".stl";
  if (isOneOf(word, {"v", "vn", "vt", "o", "g", "s", "mtllib", "usemtl"})) return ".obj";
  if (isOFF(word)) return ".off";
  const bool has_number = begin.find_first_of("0123456789") != std::string::npos;
  const bool is_text =
      std::all_of(begin.begin(), begin.end(), [](unsigned char c) { return c >= ' ' || std::isspace(c); });
  return has_number && is_text ? ".xyz" : "";
}

Shape loadShape(const std::string& path) {
  const bool is_stdin = isStandardStream(path);
  const std::string name = is_stdin ? "standard input" : path;
  std::string text = is_stdin ? readStandardInput() : readWholeFile(path);
  std::string extension = boost::algorithm::to_lower_copy(boost::filesystem::path(path).extension().string());
  if (is_stdin || (extension.empty() && !boost::filesystem::is_regular_file(path))) {  // such as <(...) of a shell
    extension = extensionOfContent(text);
    if (extension.empty()) throw InputError(name + ": is of no known kind, must be " + kShapeFiles);
  }
  if (extension != ".glb" && !isBinarySTL(text)) text = withoutMark(std::move(text));
  return namingFile(
      name, [&] { return shapeOf(name, text, extension); }, "cannot be read, ");
}

Shape surfaceOf(const std::string& path, const ScalarGrid& volume, double value) {
  ExactShape surface;
  functionOf<decltype(contourVolume)>(kDrawingModule, "contourVolume")(volume, value, surface);
  if (surface.polygons.empty()) throw InputError(path + formatted(": no surface of value %g", value));
  return fromExact(path, std::move(surface));
}

Points finitePoints(const Cloud& cloud, std::vector<std::size_t>* indices) {
  Points points(3, static_cast<Eigen::Index>(cloud.size()));
  Eigen::Index size = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud[i].getVector3fMap().allFinite()) continue;
    points.col(size++) = cloud[i].getVector3fMap();
    if (indices) indices->push_back(i);
  }
  points.conservativeResize(3, size);
  return points;
}

}  // namespace pcl_symmetry::apps
