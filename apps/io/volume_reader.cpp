#include <vtkCellArray.h>
#include <vtkCharArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageCast.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMatrix4x4.h>
#include <vtkMetaImageReader.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>
#include <vtkNrrdReader.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkXMLImageDataReader.h>
#include <zlib.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <fstream>
#include <iostream>
#include <map>
#include <new>
#include <sstream>

#include "command_line/tool_errors.h"
#include "io/file_text.h"
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

using Fields = std::map<std::string, std::string>;

/// The fields of a header. VTK's readers of NRRD and MetaImage run in circles or crash where it is cut off, is no text,
/// or has a field twice or without a value.
Fields fieldsOf(const std::string& path, bool is_nrrd) {
  const std::string sign = is_nrrd ? ": " : "=";
  std::ifstream file(path, std::ios::binary);
  Fields fields;
  const auto next = [&](std::string& line) {
    if (!std::getline(file, line)) return false;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return true;
  };
  std::string line;
  bool is_whole = !is_nrrd || (next(line) && line.rfind("NRRD", 0) == 0 && isPrintable(line));
  while (is_whole && next(line)) {
    if (is_nrrd && line.empty()) return fields;
    const std::size_t at = line.find(sign);
    is_whole = isPrintable(line) && line.size() < (is_nrrd ? 4000 : 250) && !(is_nrrd && file.eof());
    if (is_nrrd && (line[0] == '#' || (at == std::string::npos && line.find(":=") < line.size()))) continue;
    is_whole = is_whole && at < 200;
    if (!is_whole) break;
    const std::string key = is_nrrd ? line.substr(0, at) : boost::algorithm::trim_copy(line.substr(0, at));
    const std::string value = boost::algorithm::trim_copy(line.substr(at + sign.size()));
    is_whole = !value.empty() && fields.emplace(key, value).second && (key != "sizes" || fields.count("dimension"));
    if (is_whole && key == "ElementDataFile") return fields;
  }
  if (!is_whole || is_nrrd) throw InputError(path + ": cannot be read, a line of its header is no field with a value");
  return fields;
}

[[noreturn]] void throwSeveralFiles(const std::string& path) {
  throw InputError(path + ": cannot be read, its data must be in one file");
}

/// VTK's reader of NIfTI trusts a header whose dimensions or type make no sense.
void checkNIfTI(const std::string& path) {
  char header[540] = {};
  const gzFile file = gzopen(path.c_str(), "rb");  // also of files that are not compressed
  const int size = file ? gzread(file, header, sizeof(header)) : 0;
  if (file) gzclose(file);
  const bool is_little = header[0] != 0, is_first = header[is_little ? 0 : 3] == 0x5c;  // 348, not 540
  const auto number = [&](int at) {
    const auto low = static_cast<unsigned char>(header[is_little ? at : at + 1]);
    return 256 * header[is_little ? at + 1 : at] + low;
  };
  const int num_sizes = number(is_first ? 40 : is_little ? 16 : 22), type = number(is_first ? 70 : 12);
  const int types[] = {2, 4, 8, 16, 64, 128, 256, 512, 768, 1024, 1280, 2304};
  const bool is_known = std::find(std::begin(types), std::end(types), type) != std::end(types);
  if (size < (is_first ? 348 : 540) || !is_known || num_sizes < 1 || num_sizes > 7)
    throw InputError(path + ": cannot be read, its header is not of NIfTI or has an unknown type");
}

std::string valueOf(const Fields& fields, const char* key) {
  const auto found = fields.find(key);
  return found == fields.end() ? std::string() : found->second;
}

/// VTK's reader of .vti takes what is left of data that are cut off.
void checkEnd(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  file.seekg(-std::min<std::streamoff>(40, boost::filesystem::file_size(path)), std::ios::end);
  const std::string end(std::istreambuf_iterator<char>(file), {});
  if (end.find("</VTKFile>") == std::string::npos) throw InputError(path + ": cannot be read, it is cut off");
}

/// MetaIO runs in circles where compressed data are damaged, and leaves voxels at zero where they are too few.
/// \return bytes of the data.
double checkDeflated(const std::string& path, const boost::filesystem::path& data, bool is_behind_header) {
  std::ifstream file(data.string(), std::ios::binary);
  std::string line;
  while (is_behind_header && std::getline(file, line) && line.find("ElementDataFile") != 0) continue;
  z_stream stream{};
  std::vector<unsigned char> deflated(1 << 16), inflated(1 << 16);
  constexpr int kZlibOrGzip = 15 + 32;
  int state = inflateInit2(&stream, kZlibOrGzip);
  while (state == Z_OK && file) {
    file.read(reinterpret_cast<char*>(deflated.data()), static_cast<std::streamsize>(deflated.size()));
    stream.next_in = deflated.data();
    stream.avail_in = static_cast<uInt>(file.gcount());
    while (state == Z_OK && stream.avail_in > 0) {
      stream.next_out = inflated.data();
      stream.avail_out = static_cast<uInt>(inflated.size());
      state = inflate(&stream, Z_NO_FLUSH);
    }
  }
  inflateEnd(&stream);
  if (state != Z_STREAM_END) throw InputError(path + ": cannot be read, its compressed data are damaged or cut off");
  return static_cast<double>(stream.total_out);
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
Eigen::Matrix3d directionIn(const Fields& fields, const char* key) {
  const std::vector<double> numbers = numbersIn(valueOf(fields, key));
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

/// \return bytes of an image at most, as its header has it; 0 where it has no voxel.
double sizeOf(vtkInformation* image) {
  const int* const extent = image->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT());
  vtkInformation* const voxel = vtkDataObject::GetActiveFieldInformation(image, vtkDataObject::FIELD_ASSOCIATION_POINTS,
                                                                         vtkDataSetAttributes::SCALARS);
  if (!voxel) return 0.0;
  double size = sizeof(double);
  if (voxel->Has(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS()))
    size *= voxel->Get(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS());
  for (int k = 0; k < 3; ++k) size *= extent ? std::max(0.0, 1.0 + extent[2 * k + 1] - extent[2 * k]) : 0.0;
  return size;
}

template <typename Reader>
vtkSmartPointer<vtkImageData> updated(Reader& reader, const std::string& path, const VtkMessages& messages) {
  constexpr double kMostPacked = 8.0 * 1100.0;  // bytes of an image for one of the file: those of zlib, as double
  const Printed printed;
  reader.SetFileName(path.c_str());
  reader.UpdateInformation();
  const double size = sizeOf(reader.GetOutputInformation(0));
  const bool is_apart = boost::algorithm::iends_with(path, "hdr") || boost::algorithm::iends_with(path, "mhd");
  const double most = is_apart ? 1e15 : kMostPacked * static_cast<double>(boost::filesystem::file_size(path));
  const bool is_sound = size > 0.0 && size <= most;
  if (is_sound) {
    vtkNew<vtkCharArray> room;  // the readers write where they got none
    if (!room->Allocate(static_cast<vtkIdType>(size))) throw std::bad_alloc();
    room->Initialize();
    reader.Update();
  }
  if (!is_sound || reader.GetErrorCode() != 0 || !messages.firstError().empty() || !messages.firstWarning().empty() ||
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
    checkEnd(path);
    vtkNew<vtkXMLImageDataReader> reader;
    image.data = updated(*reader, path, messages);
    image.T_input_index = affineOf(*image.data->GetIndexToPhysicalMatrix());
  } else if (ends(".nii") || ends(".gz")) {
    checkNIfTI(path);
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
    const Fields fields = fieldsOf(path, true);
    const std::string sizes = valueOf(fields, "sizes"), encoding = valueOf(fields, "encoding");
    const std::string file = valueOf(fields, "data file") + valueOf(fields, "datafile");
    if (!boost::algorithm::all(sizes, boost::is_digit() || boost::is_space()) || numbersIn(sizes).size() != 3 ||
        valueOf(fields, "dimension") != "3" || valueOf(fields, "type").empty() ||
        (fields.count("space dimension") && valueOf(fields, "space dimension") != "3"))
      throw InputError(path + ": cannot be read, its header must have type, dimension 3 and three sizes");
    if (encoding != "raw" && encoding != "gzip" && encoding != "gz")
      throw InputError(path + ": encoding = " + encoding + ", must be raw or gzip");
    if (file.find_first_of("% \t") < file.size() || file == "LIST") throwSeveralFiles(path);
    vtkNew<vtkNrrdReader> reader;
    image.data = updated(*reader, path, messages);
    image.T_input_index = placedBy(*image.data, directionIn(fields, "space directions"));
    const std::vector<double> origin = numbersIn(valueOf(fields, "space origin"));
    if (origin.size() == 3) image.T_input_index.translation() = Eigen::Map<const Eigen::Vector3d>(origin.data());
  } else {
    const Fields fields = fieldsOf(path, false);
    // VTK's reader makes room for three axes, and MetaIO fills all.
    if (valueOf(fields, "NDims") != "3" || numbersIn(valueOf(fields, "DimSize")).size() != 3)
      throw InputError(path + ": cannot be read, NDims must be 3, with three numbers of DimSize");
    const std::string file = valueOf(fields, "ElementDataFile");
    if (file.find('%') != std::string::npos) throwSeveralFiles(path);
    // MetaIO makes room for the number of bytes that the header names.
    const boost::filesystem::path data = file == "LOCAL" ? path : boost::filesystem::path(path).parent_path() / file;
    boost::system::error_code missing;
    for (const double size : numbersIn(valueOf(fields, "CompressedDataSize")))
      if (!(size >= 0.0 && size <= static_cast<double>(boost::filesystem::file_size(data, missing))))
        throw InputError(path + ": cannot be read, it is cut off or its header does not fit its data");
    const bool is_compressed = valueOf(fields, "CompressedData").find_first_of("TtYy1") == 0;
    const double num_bytes = is_compressed ? checkDeflated(path, data, file == "LOCAL") : 0.0;
    vtkNew<vtkMetaImageReader> reader;
    image.data = updated(*reader, path, messages);
    vtkDataArray* const voxels = image.data->GetPointData()->GetScalars();
    if (is_compressed && voxels && num_bytes < 1.0 * voxels->GetNumberOfValues() * voxels->GetDataTypeSize())
      throw InputError(path + ": cannot be read, its data hold fewer voxels than its header says");
    Eigen::Matrix3d direction = Eigen::Matrix3d::Identity();
    for (const char* key : {"TransformMatrix", "Orientation", "Rotation"})
      if (direction.isIdentity()) direction = directionIn(fields, key);
    image.T_input_index = placedBy(*image.data, direction);
  }
  return image;
}

}  // namespace

void readVolume(const std::string& path, Volume& volume) {
  const std::lock_guard<std::mutex> lock(drawing_mutex);
  const VtkMessages messages;
  if (!boost::filesystem::exists(path)) throw InputError(path + ": no such file");
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
