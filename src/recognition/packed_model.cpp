#include "recognition/packed_model.h"

#include <zlib.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <new>

namespace pcl_symmetry::detail {

namespace {

// Bytes of the largest part of a model: a damaged length must not ask for more memory.
constexpr std::uint32_t kMaxPart = 1u << 30;

template <typename Integer>
void putColumn(const Eigen::Ref<const Eigen::VectorXf>& column, PackedBytes& packed) {
  const float greatest = column.size() > 0 ? column.cwiseAbs().maxCoeff() : 0.0f;
  const float step = greatest / static_cast<float>(std::numeric_limits<Integer>::max());
  packed.put(step);
  for (const float value : column)
    packed.put(static_cast<Integer>(step > 0.0f ? std::lround(static_cast<double>(value) / step) : 0));
}

template <typename Integer>
void getColumn(UnpackedBytes& packed, Eigen::Ref<Eigen::VectorXf> column) {
  const auto step = packed.get<float>();
  const char* values = packed.take(static_cast<std::size_t>(column.size()) * sizeof(Integer));
  for (Eigen::Index i = 0; i < column.size(); ++i) {
    Integer value;
    std::memcpy(&value, values + static_cast<std::size_t>(i) * sizeof(Integer), sizeof(Integer));
    column[i] = step * static_cast<float>(value);
  }
}

constexpr int kCoordinateBits = 16;
constexpr double kMaxCoordinate = (1 << kCoordinateBits) - 1;
constexpr float kViewSteps = 96.0f;         // of the value 1: the error of a view has a norm of 0.05
constexpr double kRotationSteps = 32767.0;  // 16 bits

using Quantized = std::array<std::uint16_t, 3>;

/// Morton code: points that are near in space are near in order.
std::uint64_t mortonCode(const Quantized& x) {
  std::uint64_t code = 0;
  for (int bit = kCoordinateBits - 1; bit >= 0; --bit)
    for (const std::uint16_t coordinate : x) code = 2 * code + (coordinate >> bit & 1u);
  return code;
}

std::vector<Quantized> sortedSteps(const PositionCloud& cloud, const Eigen::Vector3f& corner, double step) {
  std::vector<std::pair<std::uint64_t, Quantized>> coded;
  coded.reserve(cloud.size());
  for (const pcl::PointXYZ& point : cloud) {
    const Eigen::Vector3d x = point.getVector3fMap().cast<double>() - corner.cast<double>();
    Quantized steps{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double value = step > 0.0 ? std::round(x[static_cast<Eigen::Index>(k)] / step) : 0.0;
      steps[k] = static_cast<std::uint16_t>(std::clamp(value, 0.0, kMaxCoordinate));
    }
    coded.emplace_back(mortonCode(steps), steps);
  }
  std::sort(coded.begin(), coded.end());
  std::vector<Quantized> sorted;
  sorted.reserve(coded.size());
  for (const auto& [code, steps] : coded) sorted.push_back(steps);
  return sorted;
}

/// Small steps up and down as small numbers.
std::uint16_t folded(std::uint16_t from, std::uint16_t to) {
  const auto difference = static_cast<std::int16_t>(to - from);
  return static_cast<std::uint16_t>((2 * difference) ^ (difference >> 15));
}

std::uint16_t unfolded(std::uint16_t from, std::uint16_t code) {
  return static_cast<std::uint16_t>(from + ((code >> 1) ^ -(code & 1)));
}

std::int16_t rotationSteps(double value) {
  return static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0, 1.0) * kRotationSteps));
}

}  // namespace

std::string compressed(const std::string& bytes, Effort effort) {
  if (bytes.size() > kMaxPart) throw std::invalid_argument("is too large to be stored");
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string result(sizeof(std::uint32_t) + size, '\0');
  const auto length = static_cast<std::uint32_t>(bytes.size());
  std::memcpy(result.data(), &length, sizeof(length));
  if (compress2(reinterpret_cast<Bytef*>(result.data() + sizeof(length)), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()),
                static_cast<int>(effort)) != Z_OK)
    throw std::bad_alloc();
  result.resize(sizeof(length) + size);
  return result;
}

std::string decompressed(const std::string& bytes) {
  UnpackedBytes packed(bytes);
  const auto length = packed.get<std::uint32_t>();
  if (length > kMaxPart) throw std::invalid_argument("is too large");
  // zlib packs at most 1032 bytes into one.
  const std::size_t packed_size = bytes.size() - sizeof(length);
  if (length / 1032 > packed_size) throw std::invalid_argument("has fewer bytes than it says");
  std::string result(length, '\0');
  uLongf size = length;
  const auto* data = reinterpret_cast<const Bytef*>(packed.take(packed_size));
  if (uncompress(reinterpret_cast<Bytef*>(result.data()), &size, data, static_cast<uLong>(packed_size)) != Z_OK ||
      size != length)
    throw std::invalid_argument("cannot be decompressed");
  return result;
}

Checksum& Checksum::add(const std::string& bytes) {
  add(static_cast<std::int64_t>(bytes.size()));
  value_ = static_cast<std::uint32_t>(
      crc32_z(value_, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<z_size_t>(bytes.size())));
  return *this;
}

Checksum& Checksum::add(std::int64_t number) {
  Bytef bytes[sizeof(number)];
  std::memcpy(bytes, &number, sizeof(number));
  value_ = static_cast<std::uint32_t>(crc32_z(value_, bytes, sizeof(bytes)));
  return *this;
}

std::string packedMatrix(const Eigen::Ref<const Eigen::MatrixXf>& matrix, MatrixBits bits) {
  PackedBytes packed;
  packed.put(static_cast<std::uint8_t>(bits));
  packed.put(static_cast<std::uint32_t>(matrix.rows()));
  packed.put(static_cast<std::uint32_t>(matrix.cols()));
  for (Eigen::Index i = 0; i < matrix.cols(); ++i) {
    if (bits == MatrixBits::Eight)
      putColumn<std::int8_t>(matrix.col(i), packed);
    else
      putColumn<std::int16_t>(matrix.col(i), packed);
  }
  return packed.bytes();
}

Eigen::MatrixXf unpackedMatrix(const std::string& bytes) {
  UnpackedBytes packed(bytes);
  const auto size_of_value = packed.get<std::uint8_t>();
  const std::size_t rows = packed.get<std::uint32_t>(), cols = packed.get<std::uint32_t>();
  // The first condition keeps the product in range.
  if (cols > packed.left() / sizeof(float) || (size_of_value != 1 && size_of_value != 2) ||
      rows * cols * size_of_value + cols * sizeof(float) != packed.left())
    throw std::invalid_argument("has another size than it says");
  Eigen::MatrixXf matrix(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(cols));
  for (Eigen::Index i = 0; i < matrix.cols(); ++i) {
    if (size_of_value == 1)
      getColumn<std::int8_t>(packed, matrix.col(i));
    else
      getColumn<std::int16_t>(packed, matrix.col(i));
  }
  return matrix;
}

std::string packedCloud(const PositionCloud& cloud) {
  const auto points = cloud.getMatrixXfMap(3, 4, 0);
  Eigen::Vector3f corner = Eigen::Vector3f::Zero();
  double step = 0.0;
  if (!cloud.empty()) {
    corner = points.rowwise().minCoeff();
    step = (points.rowwise().maxCoeff().cast<double>() - corner.cast<double>()).maxCoeff() / kMaxCoordinate;
  }
  PackedBytes packed;
  packed.put(static_cast<std::uint32_t>(cloud.size()));
  for (const float coordinate : corner) packed.put(coordinate);
  packed.put(step);
  const std::vector<Quantized> sorted = sortedSteps(cloud, corner, step);
  // Bytes of the same meaning side by side compress better.
  for (std::size_t k = 0; k < 3; ++k) {
    for (const int shift : {8, 0}) {
      std::uint16_t last = 0;
      for (const Quantized& steps : sorted) {
        packed.put(static_cast<std::uint8_t>(folded(last, steps[k]) >> shift));
        last = steps[k];
      }
    }
  }
  return compressed(packed.bytes(), Effort::Low);  // more makes it 2 % smaller
}

PositionCloud unpackedCloud(const std::string& bytes) {
  const std::string plain = decompressed(bytes);
  UnpackedBytes packed(plain);
  const auto size = packed.get<std::uint32_t>();
  Eigen::Vector3d corner;
  for (double& coordinate : corner) coordinate = static_cast<double>(packed.get<float>());
  const auto step = packed.get<double>();
  if (packed.left() != std::size_t{6} * size) throw std::invalid_argument("has another size than it says");
  PositionCloud cloud(size, 1);
  for (int k = 0; k < 3; ++k) {
    const char *high = packed.take(size), *low = packed.take(size);
    std::uint16_t last = 0;
    for (std::uint32_t i = 0; i < size; ++i) {
      last = unfolded(last, static_cast<std::uint16_t>(static_cast<std::uint8_t>(high[i]) << 8 |
                                                       static_cast<std::uint8_t>(low[i])));
      cloud[i].data[k] = static_cast<float>(corner[k] + step * last);
    }
  }
  return cloud;
}

std::string packedSignatures(const Eigen::MatrixXf& signatures) {
  return compressed(packedMatrix(signatures, MatrixBits::Eight), Effort::High);
}

Eigen::MatrixXf unpackedSignatures(const std::string& bytes) {
  return unpackedMatrix(decompressed(bytes));
}

std::string packedViews(const std::vector<View>& views) {
  PackedBytes packed;
  packed.put(static_cast<std::uint32_t>(views.size()));
  for (const View& view : views) {
    const Eigen::Quaterniond rotation(view.T_view_input.linear());
    packed.put(static_cast<float>(view.radius));
    for (const double part : rotation.coeffs()) packed.put(rotationSteps(part));
    for (const double part : view.T_view_input.translation()) packed.put(static_cast<float>(part));
  }
  for (Eigen::Index i = 0; i < kViewSignatureSize; ++i)
    for (const View& view : views)
      packed.put(static_cast<std::int8_t>(std::lround(std::clamp(view.values[i], -1.0f, 1.0f) * kViewSteps)));
  return compressed(packed.bytes(), Effort::High);
}

std::vector<View> unpackedViews(const std::string& bytes) {
  const std::string plain = decompressed(bytes);
  UnpackedBytes packed(plain);
  const auto count = packed.get<std::uint32_t>();
  const std::size_t pose_bytes = 4 * sizeof(float) + 4 * sizeof(std::int16_t);
  if (packed.left() != count * (pose_bytes + kViewSignatureSize))
    throw std::invalid_argument("has another size than it says");
  std::vector<View> views(count);
  for (View& view : views) {
    view.radius = packed.get<float>();
    Eigen::Quaterniond rotation;
    for (double& part : rotation.coeffs()) part = packed.get<std::int16_t>() / kRotationSteps;
    view.T_view_input.linear() = rotation.normalized().toRotationMatrix();
    for (double& part : view.T_view_input.translation()) part = packed.get<float>();
  }
  for (View& view : views) view.values.resize(kViewSignatureSize);
  for (Eigen::Index i = 0; i < kViewSignatureSize; ++i)
    for (View& view : views) view.values[i] = static_cast<float>(packed.get<std::int8_t>()) / kViewSteps;
  for (View& view : views)
    if (const float norm = view.values.norm(); norm > 0.0f) view.values /= norm;
  return views;
}

std::string packedSurfaces(const std::vector<SurfacePoints>& surfaces) {
  PackedBytes packed;
  for (const SurfacePoints& surface : surfaces) {
    const Eigen::Vector3f center = centerOfMass(surface.points).cast<float>();
    Eigen::MatrixXf rows(surface.points.cols(), 6);
    rows << (surface.points.colwise() - center).transpose(), surface.normals.transpose();
    for (const float coordinate : center) packed.put(coordinate);
    packed.putText(packedMatrix(rows, MatrixBits::Sixteen));
  }
  return packed.bytes();
}

std::vector<SurfacePoints> unpackedSurfaces(const std::string& bytes) {
  UnpackedBytes packed(bytes);
  std::vector<SurfacePoints> surfaces;
  while (packed.left() > 0) {
    Eigen::Vector3f center;
    for (float& coordinate : center) coordinate = packed.get<float>();
    const Eigen::MatrixXf rows = unpackedMatrix(packed.text());
    if (rows.cols() != 6 || rows.rows() == 0) throw std::invalid_argument("has another size than it says");
    if (!rows.allFinite() || !center.allFinite()) throw std::invalid_argument("has points that are not finite");
    surfaces.push_back({rows.leftCols<3>().transpose().colwise() + center, rows.rightCols<3>().transpose()});
  }
  return surfaces;
}

}  // namespace pcl_symmetry::detail
