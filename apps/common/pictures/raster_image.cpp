#include "common/pictures/raster_image.h"

#include <vtkImageData.h>
#include <vtkImageReader2.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkPNGWriter.h>
#include <vtkPNMReader.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <cmath>
#include <cstring>

#include "common/files/file_text.h"
#include "common/shape_output/shape_output.h"

namespace pcl_symmetry::apps {

void RasterImage::set(int x, int y, const Eigen::Vector3d& color) {
  for (int k = 0; k < 3; ++k)
    at(x, y)[k] = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(color[k], 0.0, 1.0)));
}

void RasterImage::drawDisk(const Eigen::Vector2d& center, double radius, const Eigen::Vector3d& color) {
  radius = std::max(radius, (center - center.array().round().matrix()).norm());
  const int x_end = std::min(width - 1, static_cast<int>(std::floor(center.x() + radius)));
  const int y_end = std::min(height - 1, static_cast<int>(std::floor(center.y() + radius)));
  for (int y = std::max(0, static_cast<int>(std::ceil(center.y() - radius))); y <= y_end; ++y)
    for (int x = std::max(0, static_cast<int>(std::ceil(center.x() - radius))); x <= x_end; ++x)
      if ((Eigen::Vector2d(x, y) - center).squaredNorm() <= radius * radius) set(x, y, color);
}

void RasterImage::paste(const RasterImage& tile, int x, int y) {
  for (int row = 0; row < tile.height; ++row) std::memcpy(at(x, y + row), tile.at(0, row), 3 * std::size_t(tile.width));
}

RasterImage sideBySide(const std::vector<RasterImage>& tiles, int num_columns) {
  constexpr int kGap = 4;  // pixels between pictures; chosen: half is hard to see, twice wastes room
  const int num = static_cast<int>(tiles.size()), columns = num_columns > 0 ? std::min(num_columns, num) : num;
  const int rows = (num + columns - 1) / columns, width = tiles[0].width + kGap, height = tiles[0].height + kGap;
  RasterImage image(columns * width - kGap, rows * height - kGap);
  for (int i = 0; i < num; ++i) image.paste(tiles[i], i % columns * width, i / columns * height);
  return image;
}

bool isImagePath(const std::string& path) {
  return boost::algorithm::iends_with(path, ".png") || boost::algorithm::iends_with(path, ".pgm");
}

RasterImage readImage(const std::string& path) {
  const std::string content = readWholeFile(path);
  const bool png = boost::algorithm::iends_with(path, ".png");
  if (!boost::algorithm::starts_with(content, png ? "\x89PNG" : "P5"))
    throw InputError(path + ": is no picture, must be a PNG or binary PGM file");
  vtkSmartPointer<vtkImageReader2> reader;
  if (png) {
    reader = vtkSmartPointer<vtkPNGReader>::New();
  } else {
    reader = vtkSmartPointer<vtkPNMReader>::New();
  }
  const int display = vtkObject::GetGlobalWarningDisplay();
  vtkObject::GlobalWarningDisplayOff();
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkObject::SetGlobalWarningDisplay(display);
  if (reader->GetErrorCode() != 0) throw InputError(path + ": cannot be read, the picture is damaged");
  vtkImageData* data = reader->GetOutput();
  const int* size = data->GetDimensions();
  const int channels = data->GetNumberOfScalarComponents();
  const bool wide = data->GetScalarType() == VTK_UNSIGNED_SHORT;
  if (size[0] < 1 || size[1] < 1 || channels < 1 || (!wide && data->GetScalarType() != VTK_UNSIGNED_CHAR))
    throw InputError(path + ": cannot be read, must be a picture of 8 or 16 bits");
  RasterImage image(size[0], size[1]);
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
  return image;
}

void writeImage(const RasterImage& image, const std::string& path) {
  writeAtomically(path, [&](const std::string& temporary) {
    vtkNew<vtkImageData> data;
    data->SetDimensions(image.width, image.height, 1);
    data->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
    for (int y = 0; y < image.height; ++y)
      std::memcpy(data->GetScalarPointer(0, image.height - 1 - y, 0), image.at(0, y), 3 * std::size_t(image.width));
    vtkNew<vtkPNGWriter> writer;
    writer->SetInputData(data);
    writer->SetFileName(temporary.c_str());
    writer->Write();
    if (writer->GetErrorCode() != 0) throw InputError(path + ": cannot be written");
  });
}

}  // namespace pcl_symmetry::apps
