#include <vtkCellArray.h>
#include <vtkCharArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageCast.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMatrix4x4.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkXMLImageDataReader.h>

#include <algorithm>

#include "io/file_text.h"
#include "io/input_shape.h"
#include "pictures/drawing.h"
#include "pictures/vtk_messages.h"

namespace pcl_symmetry::apps {

namespace {

/// \return greatest number of bytes of an image, according to its header; 0 if it has no voxel.
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

}  // namespace

void readVTI(const std::string& path, Volume& volume) {
  const std::lock_guard<std::mutex> lock(drawing_mutex);
  const VtkMessages messages;
  const std::string text = readWholeFile(path);
  // VTK accepts truncated data.
  if (text.rfind("</VTKFile>") == std::string::npos) reject(path, "cannot be read, it is cut off");
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(path.c_str());
  reader->UpdateInformation();
  // Greatest number of bytes of an image for one byte of the file: zlib's limit, with voxels of type double.
  constexpr double kMostPacked = 8.0 * 1100.0;
  const double size = sizeOf(reader->GetOutputInformation(0));
  const bool is_sound = size > 0.0 && size <= kMostPacked * static_cast<double>(text.size());
  if (is_sound) {
    vtkNew<vtkCharArray> room;  // the reader would write even without memory for it
    if (!room->Allocate(static_cast<vtkIdType>(size))) throw std::bad_alloc();
    room->Initialize();
    reader->Update();
  }
  if (!is_sound || reader->GetErrorCode() != 0 || !messages.firstError().empty() || !messages.firstWarning().empty())
    reject(path, "cannot be read, it is cut off or its header does not fit its data");
  vtkImageData* const data = reader->GetOutput();
  int extent[3];
  data->GetDimensions(extent);
  const int components = data->GetNumberOfScalarComponents();
  if (extent[0] < 1 || extent[1] < 1 || extent[2] < 1 || !data->GetPointData()->GetScalars())
    reject(path, "cannot be read, it has no voxels");
  vtkNew<vtkImageCast> cast;
  cast->SetInputData(data);
  cast->SetOutputScalarTypeToFloat();
  cast->Update();
  const float* const from = static_cast<const float*>(cast->GetOutput()->GetScalarPointer());
  std::vector<float> values(static_cast<std::size_t>(extent[0]) * extent[1] * extent[2]);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = from[i * components];
  if (components > 1) volume.left_out.push_back(std::to_string(components - 1) + " more values a voxel");
  Eigen::Affine3d T_input_index;
  for (int i = 0; i < 16; ++i)
    T_input_index.matrix()(i / 4, i % 4) = data->GetIndexToPhysicalMatrix()->GetElement(i / 4, i % 4);
  volume.grid =
      std::make_shared<ScalarGrid>(ScalarGrid::Size{extent[0], extent[1], extent[2]}, T_input_index, std::move(values));
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
