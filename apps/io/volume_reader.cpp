#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageCast.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkMetaImageReader.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>
#include <vtkNrrdReader.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLImageDataReader.h>

#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <fstream>
#include <iostream>
#include <sstream>

#include "command_line/tool_errors.h"
#include "io/input_shape.h"
#include "pictures/drawing.h"
#include "pictures/vtk_messages.h"

namespace pcl_symmetry::apps {

namespace {

Eigen::Affine3d affineOf(const vtkMatrix4x4& matrix) {
  Eigen::Affine3d result;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) result.matrix()(i, j) = matrix.GetElement(i, j);
  return result;
}

/// The text after a key at the start of a line of a header; empty without one.
std::string headerValue(const std::string& path, const std::string& key) {
  std::ifstream file(path, std::ios::binary);
  for (std::string line; std::getline(file, line) && line.size() < 4096;)
    if (boost::algorithm::istarts_with(line, key)) return line.substr(line.find_first_of(":=", key.size()) + 1);
  return {};
}

/// VTK's reader of NRRD runs in circles or crashes where a header is no text, or has a field without a value.
void checkNRRD(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  for (std::string line; std::getline(file, line);) {
    boost::algorithm::trim(line);
    if (line.empty()) return;
    const std::size_t value = line.find_first_of(":=");
    const bool is_whole = line[0] == '#' || line.rfind("NRRD", 0) == 0 || value + 1 < line.size();
    if (!is_whole || !boost::algorithm::all(line, !boost::is_cntrl()))
      throw InputError(path + ": cannot be read, a line of its header is no field with a value");
  }
}

/// The numbers of a text, whatever stands between them; "none" is none.
std::vector<double> numbersIn(std::string text) {
  for (char& c : text)
    if (std::string("(),;").find(c) != std::string::npos) c = ' ';
  std::vector<double> numbers;
  std::istringstream words(text);
  for (std::string word; words >> word;) try {
      numbers.push_back(std::stod(word));
    } catch (const std::exception&) {
    }
  return numbers;
}

/// What VTK's readers of NRRD and MetaImage leave out: where the axes of the grid point. Columns.
Eigen::Matrix3d directionIn(const std::string& path, const char* key) {
  const std::vector<double> numbers = numbersIn(headerValue(path, key));
  if (numbers.size() < 9) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d direction = Eigen::Map<const Eigen::Matrix3d>(numbers.data());
  return direction.colwise().normalized();
}

/// The image of a file, and its frame.
struct Image {
  vtkSmartPointer<vtkImageData> data;
  Eigen::Affine3d T_input_index;
  double slope = 1.0, intercept = 0.0;
  int num_times = 1;
};

/// What MetaIO prints, as it tells of data that are cut off in no other way.
class Printed {
public:
  Printed() : old_(std::cerr.rdbuf(text_.rdbuf())) {}
  ~Printed() { std::cerr.rdbuf(old_); }
  Printed(const Printed&) = delete;
  Printed& operator=(const Printed&) = delete;
  bool nothing() const { return text_.str().empty(); }

private:
  std::ostringstream text_;
  std::streambuf* old_;
};

template <typename Reader>
vtkSmartPointer<vtkImageData> updated(Reader& reader, const std::string& path, const VtkMessages& messages) {
  const Printed printed;
  reader.SetFileName(path.c_str());
  reader.Update();
  if (reader.GetErrorCode() != 0 || !messages.firstError().empty() || !messages.firstWarning().empty() ||
      !printed.nothing())
    throw InputError(path + ": cannot be read, it is cut off or its header does not fit its data");
  return reader.GetOutput();
}

Eigen::Affine3d placedBy(const vtkImageData& data, const Eigen::Matrix3d& direction) {
  const double *spacing = const_cast<vtkImageData&>(data).GetSpacing(),
               *origin = const_cast<vtkImageData&>(data).GetOrigin();
  return ScalarGrid::placed(Eigen::Map<const Eigen::Vector3d>(spacing).cwiseAbs(),
                            Eigen::Map<const Eigen::Vector3d>(origin), direction);
}

Image imageOf(const std::string& path, const VtkMessages& messages) {
  Image image;
  const auto ends = [&](const char* ending) { return boost::algorithm::iends_with(path, ending); };
  if (ends(".vti")) {
    vtkNew<vtkXMLImageDataReader> reader;
    image.data = updated(*reader, path, messages);
    image.T_input_index = affineOf(*image.data->GetIndexToPhysicalMatrix());
  } else if (ends(".nii") || ends(".gz")) {
    vtkNew<vtkNIFTIImageReader> reader;
    image.data = updated(*reader, path, messages);
    image.T_input_index = placedBy(*image.data, Eigen::Matrix3d::Identity());
    vtkMatrix4x4* const frame = reader->GetSFormMatrix() ? reader->GetSFormMatrix() : reader->GetQFormMatrix();
    if (frame) {
      image.T_input_index.translation().setZero();  // the matrix is of positions along the axes of the grid
      image.T_input_index = affineOf(*frame) * image.T_input_index;
    }
    image.slope = reader->GetRescaleSlope();
    image.intercept = reader->GetRescaleIntercept();
    image.num_times = std::max(1, reader->GetTimeDimension());
  } else if (ends(".nrrd") || ends(".nhdr")) {
    checkNRRD(path);
    vtkNew<vtkNrrdReader> reader;
    image.data = updated(*reader, path, messages);
    image.T_input_index = placedBy(*image.data, directionIn(path, "space directions"));
    const std::vector<double> origin = numbersIn(headerValue(path, "space origin"));
    if (origin.size() == 3) image.T_input_index.translation() = Eigen::Map<const Eigen::Vector3d>(origin.data());
  } else {
    vtkNew<vtkMetaImageReader> reader;
    image.data = updated(*reader, path, messages);
    Eigen::Matrix3d direction = Eigen::Matrix3d::Identity();
    for (const char* key : {"TransformMatrix", "Orientation", "Rotation"})
      if (direction.isIdentity()) direction = directionIn(path, key);
    image.T_input_index = placedBy(*image.data, direction);
  }
  return image;
}

}  // namespace

void readVolume(const std::string& path, Volume& volume) {
  const std::lock_guard<std::mutex> lock(drawing_mutex);
  const VtkMessages messages;
  if (!boost::filesystem::is_regular_file(path)) throw InputError(path + ": is no file");
  Image image = imageOf(path, messages);
  int size[3];
  image.data->GetDimensions(size);
  const int components = image.data->GetNumberOfScalarComponents();
  if (size[0] < 1 || size[1] < 1 || size[2] < 1 || !image.data->GetPointData()->GetScalars())
    throw InputError(path + ": cannot be read, it has no voxels");
  vtkNew<vtkImageCast> cast;
  cast->SetInputData(image.data);
  cast->SetOutputScalarTypeToFloat();
  cast->Update();
  image.data = nullptr;
  const float* const from = static_cast<const float*>(cast->GetOutput()->GetScalarPointer());
  std::vector<float> values(static_cast<std::size_t>(size[0]) * size[1] * size[2]);
  const auto slope = static_cast<float>(image.slope == 0.0 ? 1.0 : image.slope);
  const auto intercept = static_cast<float>(image.intercept);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = slope * from[i * components] + intercept;
  if (components > 1) volume.left_out.push_back(std::to_string(components - 1) + " more values a voxel");
  if (image.num_times > 1) volume.left_out.push_back(std::to_string(image.num_times - 1) + " more volumes");
  volume.grid =
      std::make_shared<ScalarGrid>(ScalarGrid::Size{size[0], size[1], size[2]}, image.T_input_index, std::move(values));
}

void contourVolume(const ScalarGrid& grid, double value, ExactShape& surface) {
  const std::lock_guard<std::mutex> lock(drawing_mutex);
  vtkNew<vtkFloatArray> array;
  array->SetArray(const_cast<float*>(grid.values().data()), static_cast<vtkIdType>(grid.numVoxels()), 1);
  vtkNew<vtkImageData> image;
  image->SetDimensions(grid.size().data());
  image->GetPointData()->SetScalars(array);
  vtkNew<vtkFlyingEdges3D> edges;
  edges->SetInputData(image);
  edges->SetValue(0, value);
  edges->ComputeNormalsOff();
  edges->Update();
  vtkPolyData* const mesh = edges->GetOutput();
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
    surface.vertices.push_back(grid.T_input_index() * Eigen::Map<const Eigen::Vector3d>(mesh->GetPoint(i)));
  mesh->GetPolys()->InitTraversal();
  vtkIdType num_corners = 0;
  for (const vtkIdType* corners = nullptr; mesh->GetPolys()->GetNextCell(num_corners, corners);) {
    surface.polygons.emplace_back();
    for (vtkIdType k = 0; k < num_corners; ++k)
      surface.polygons.back().vertices.push_back(static_cast<std::uint32_t>(corners[k]));
  }
}

}  // namespace pcl_symmetry::apps
