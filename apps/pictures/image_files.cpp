#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkImageReader2.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkPNGWriter.h>
#include <vtkPNMReader.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLImageDataWriter.h>

#include <algorithm>

#include "pictures/drawing.h"
#include "pictures/vtk_messages.h"

namespace pcl_symmetry::apps {

namespace {

vtkSmartPointer<vtkImageReader2> readerOf(const std::string& path, bool png) {
  vtkSmartPointer<vtkImageReader2> reader;
  if (png)
    reader = vtkSmartPointer<vtkPNGReader>::New();
  else
    reader = vtkSmartPointer<vtkPNMReader>::New();
  const VtkMessages messages;
  reader->SetFileName(path.c_str());
  reader->Update();
  if (reader->GetErrorCode() != 0) throw InputError(path + ": cannot be read, the picture is damaged");
  return reader;
}

}  // namespace

void decodeDepth(const std::string& path, Cloud& pixels) {
  const std::lock_guard<std::mutex> lock(drawing_mutex);
  const auto reader = readerOf(path, true);
  vtkImageData* const data = reader->GetOutput();
  if (data->GetNumberOfScalarComponents() != 1 || data->GetScalarType() != VTK_UNSIGNED_SHORT)
    throw InputError(path + ": is no depth image, must have one channel of 16 bits");
  const int width = data->GetDimensions()[0], height = data->GetDimensions()[1];
  pixels.resize(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      pixels(x, y).getVector3fMap() << float(x), float(y), data->GetScalarComponentAsFloat(x, height - 1 - y, 0, 0);
}

void decodeImage(const std::string& path, bool png, RasterImage& image) {
  const std::lock_guard<std::mutex> lock(drawing_mutex);
  const auto reader = readerOf(path, png);
  vtkImageData* data = reader->GetOutput();
  const int* size = data->GetDimensions();
  const int channels = data->GetNumberOfScalarComponents();
  const bool wide = data->GetScalarType() == VTK_UNSIGNED_SHORT;
  if (size[0] < 1 || size[1] < 1 || channels < 1 || (!wide && data->GetScalarType() != VTK_UNSIGNED_CHAR))
    throw InputError(path + ": cannot be read, must be a picture of 8 or 16 bits");
  image = RasterImage(size[0], size[1]);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto value = [&](int channel) {
        return data->GetScalarComponentAsDouble(x, image.height - 1 - y, 0, channel) / (wide ? 65535.0 : 255.0);
      };
      const bool has_alpha = channels == 2 || channels == 4;
      const double alpha = has_alpha ? value(channels - 1) : 1.0;
      Eigen::Vector3d color;
      for (int k = 0; k < 3; ++k) color[k] = alpha * value(channels < 3 ? 0 : k) + (1.0 - alpha);
      image.set(x, y, color);
    }
  }
}

void encodeImage(const RasterImage& image, const std::string& path, const std::string& file) {
  const std::lock_guard<std::mutex> lock(drawing_mutex);
  vtkNew<vtkImageData> data;
  data->SetDimensions(image.width, image.height, 1);
  data->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  for (int y = 0; y < image.height; ++y)
    std::memcpy(data->GetScalarPointer(0, image.height - 1 - y, 0), image.at(0, y), 3 * std::size_t(image.width));
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(data);
  writer->SetFileName(file.c_str());
  writer->Write();
  if (writer->GetErrorCode() != 0) throw InputError(path + ": cannot be written");
}

void encodeVolume(const VolumeImage& volume, const std::string& path, const std::string& file) {
  const std::lock_guard<std::mutex> lock(drawing_mutex);
  vtkNew<vtkFloatArray> array;
  array->SetName(volume.name.c_str());
  array->SetNumberOfTuples(static_cast<vtkIdType>(volume.values.size()));
  std::copy(volume.values.begin(), volume.values.end(), array->GetPointer(0));
  vtkNew<vtkImageData> image;
  image->SetDimensions(volume.size.x(), volume.size.y(), volume.size.z());
  image->SetOrigin(volume.origin.data());
  image->SetSpacing(volume.cell_size, volume.cell_size, volume.cell_size);
  image->GetPointData()->SetScalars(array);
  vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetInputData(image);
  writer->SetFileName(file.c_str());
  if (!writer->Write()) throw InputError(path + ": cannot be written");
}

}  // namespace pcl_symmetry::apps
