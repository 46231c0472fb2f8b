#include "evaluate/retrieval/model_forms.h"

#include <cstring>
#include <vector>

#include "core/descriptors/turnable_gedt.h"
#include "core/descriptors/turnable_prst.h"
#include "core/geometry/principal_axes.h"
#include "core/matching/shape_description.h"
#include "recognition/packing/packed_bytes.h"

namespace pcl_symmetry::apps {

namespace {

Eigen::Matrix3d axesOf(const Points& cloud, ModelAxes axes) {
  if (axes == ModelAxes::AsGiven) return Eigen::Matrix3d::Identity();
  if (axes == ModelAxes::Principal) return principalAxes(cloud).axes;
  DescriptionOptions description;
  description.num_threads = 1;
  return describeShape(cloud, description).frame.axes;
}

void putValues(detail::PackedBytes& bytes, const float* values, std::size_t size) {
  bytes.append({reinterpret_cast<const char*>(values), size * sizeof(float)});
}

}  // namespace

std::string nameOf(ModelAxes axes) {
  if (axes == ModelAxes::Symmetry) return "symmetry axes";
  return axes == ModelAxes::Principal ? "principal axes" : "axes of the files";
}

SymmetryDescriptors publishedForms(const Points& cloud, ModelAxes axes) {
  Eigen::Isometry3d T_frame_input = Eigen::Isometry3d::Identity();
  T_frame_input.linear() = axesOf(cloud, axes).transpose();
  T_frame_input.translation() = -T_frame_input.linear() * centerOfMass(cloud);
  DescriptorOptions descriptor;
  descriptor.num_threads = 1;
  return symmetryDescriptors(cloud, T_frame_input, descriptor);
}

TurnableForms turnableForms(const Points& cloud) {
  DescriptionOptions description;
  description.num_threads = 1;
  const ShapeDescription shape = describeShape(cloud, description);
  TurnableForms all;
  all.signatures = shape.signatures;
  const std::vector<Eigen::Matrix3d> frames = signatureFrames(cloud, shape.frame);
  const auto fill = [&](Eigen::MatrixXf& forms, const auto& describe) {
    for (std::size_t f = 0; f < frames.size(); ++f) {
      const std::vector<float> values = describe(cloud, frames[f]);
      if (f == 0) forms.resize(static_cast<Eigen::Index>(values.size()), static_cast<Eigen::Index>(frames.size()));
      forms.col(static_cast<Eigen::Index>(f)) = Eigen::Map<const Eigen::VectorXf>(values.data(), forms.rows());
    }
  };
  fill(all.prst, turnablePRST);
  fill(all.gedt, turnableGEDT);
  return all;
}

std::string packed(const SymmetryDescriptors& forms) {
  detail::PackedBytes bytes;
  for (const std::vector<float>* values : {&forms.prst, &forms.prsd, &forms.gedt}) {
    bytes.put(static_cast<std::uint32_t>(values->size()));
    putValues(bytes, values->data(), values->size());
  }
  return bytes.bytes();
}

void unpack(const std::string& packed, SymmetryDescriptors& forms) {
  detail::UnpackedBytes bytes(packed);
  for (std::vector<float>* values : {&forms.prst, &forms.prsd, &forms.gedt}) {
    values->resize(bytes.get<std::uint32_t>());
    std::memcpy(values->data(), bytes.take(values->size() * sizeof(float)), values->size() * sizeof(float));
  }
}

std::string packed(const TurnableForms& forms) {
  detail::PackedBytes bytes;
  for (const Eigen::MatrixXf* matrix : {&forms.prst, &forms.gedt, &forms.signatures}) {
    bytes.put(static_cast<std::uint32_t>(matrix->rows()));
    bytes.put(static_cast<std::uint32_t>(matrix->cols()));
    putValues(bytes, matrix->data(), static_cast<std::size_t>(matrix->size()));
  }
  return bytes.bytes();
}

void unpack(const std::string& packed, TurnableForms& forms) {
  detail::UnpackedBytes bytes(packed);
  for (Eigen::MatrixXf* matrix : {&forms.prst, &forms.gedt, &forms.signatures}) {
    const auto rows = bytes.get<std::uint32_t>(), columns = bytes.get<std::uint32_t>();
    const std::size_t size = std::size_t{rows} * columns * sizeof(float);
    const char* const values = bytes.take(size);
    matrix->resize(rows, columns);
    std::memcpy(matrix->data(), values, size);
  }
}

}  // namespace pcl_symmetry::apps
