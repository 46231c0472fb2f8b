#include "recognition/packed_model.h"

#include <Eigen/Geometry>
#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace pcl_symmetry::detail {

namespace {

constexpr Eigen::Index kPoseSize = 8;  // radius, quaternion and translation of a view, before its values

/// The matrices in \p bytes, which hold \p count matrices of \p rows rows each; -1 = any number.
std::vector<Eigen::MatrixXf> matricesOf(const std::string& bytes, Eigen::Index rows, std::ptrdiff_t count) {
  std::vector<Eigen::MatrixXf> matrices = unpackedMatrices(bytes);
  bool fits = count < 0 || static_cast<std::ptrdiff_t>(matrices.size()) == count;
  for (const Eigen::MatrixXf& matrix : matrices) fits = fits && (rows < 0 || matrix.rows() == rows);
  if (!fits) throw std::invalid_argument("has another size than it must have");
  return matrices;
}

}  // namespace

std::string packedMatrices(const std::vector<Eigen::MatrixXf>& matrices) {
  std::string bytes;
  for (const Eigen::MatrixXf& matrix : matrices) {
    const std::uint32_t size[] = {static_cast<std::uint32_t>(matrix.rows()), static_cast<std::uint32_t>(matrix.cols())};
    bytes.append(reinterpret_cast<const char*>(size), sizeof(size));
    bytes.append(reinterpret_cast<const char*>(matrix.data()), static_cast<std::size_t>(matrix.size()) * sizeof(float));
  }
  return bytes;
}

std::vector<Eigen::MatrixXf> unpackedMatrices(const std::string& bytes) {
  std::vector<Eigen::MatrixXf> matrices;
  for (std::size_t at = 0; at < bytes.size();) {
    std::uint32_t size[2];
    if (bytes.size() - at < sizeof(size)) throw std::invalid_argument("is incomplete");
    std::memcpy(size, bytes.data() + at, sizeof(size));
    at += sizeof(size);
    const std::size_t left = (bytes.size() - at) / sizeof(float), rows = size[0], cols = size[1];
    if (cols > 0 && rows > left / cols) throw std::invalid_argument("has another size than it says");
    Eigen::MatrixXf& matrix = matrices.emplace_back(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(cols));
    if (matrix.size() > 0) std::memcpy(matrix.data(), bytes.data() + at, rows * cols * sizeof(float));
    at += rows * cols * sizeof(float);
    if (!matrix.allFinite()) throw std::invalid_argument("has numbers that are not finite");
  }
  return matrices;
}

std::string packedCloud(const PositionCloud& cloud) {
  return packedMatrices({cloud.getMatrixXfMap(3, 4, 0)});
}

PositionCloud unpackedCloud(const std::string& bytes) {
  const Eigen::MatrixXf points = matricesOf(bytes, 3, 1)[0];
  PositionCloud cloud(static_cast<std::uint32_t>(points.cols()), 1);
  cloud.getMatrixXfMap(3, 4, 0) = points;
  return cloud;
}

std::string packedSignatures(const Eigen::MatrixXf& signatures) {
  return packedMatrices({signatures});
}

Eigen::MatrixXf unpackedSignatures(const std::string& bytes) {
  return matricesOf(bytes, -1, 1)[0];
}

std::string packedViews(const std::vector<View>& views) {
  Eigen::MatrixXf columns(kPoseSize + kViewSignatureSize, static_cast<Eigen::Index>(views.size()));
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    const View& view = views[i];
    const Eigen::Quaterniond rotation(view.T_view_input.linear());
    columns.col(i) << static_cast<float>(view.radius), rotation.coeffs().cast<float>(),
        view.T_view_input.translation().cast<float>(), view.values;
  }
  return packedMatrices({columns});
}

std::vector<View> unpackedViews(const std::string& bytes) {
  const Eigen::MatrixXf columns = matricesOf(bytes, kPoseSize + kViewSignatureSize, 1)[0];
  std::vector<View> views;
  for (const auto column : columns.colwise()) {
    View& view = views.emplace_back();
    view.radius = static_cast<double>(column[0]);
    const Eigen::Quaterniond rotation(column.segment<4>(1).cast<double>());
    view.T_view_input.linear() = rotation.normalized().toRotationMatrix();
    view.T_view_input.translation() = column.segment<3>(5).cast<double>();
    view.values = column.tail<kViewSignatureSize>();
  }
  return views;
}

std::string packedSurfaces(const std::vector<SurfacePoints>& surfaces) {
  std::vector<Eigen::MatrixXf> matrices;
  for (const SurfacePoints& surface : surfaces) matrices.insert(matrices.end(), {surface.points, surface.normals});
  return packedMatrices(matrices);
}

std::vector<SurfacePoints> unpackedSurfaces(const std::string& bytes) {
  const std::vector<Eigen::MatrixXf> matrices = matricesOf(bytes, 3, -1);
  std::vector<SurfacePoints> surfaces;
  for (std::size_t i = 0; i + 1 < matrices.size(); i += 2) surfaces.push_back({matrices[i], matrices[i + 1]});
  for (const SurfacePoints& surface : surfaces)
    if (surface.points.cols() == 0 || surface.normals.cols() != surface.points.cols())
      throw std::invalid_argument("has points without normals");
  return surfaces;
}

}  // namespace pcl_symmetry::detail
