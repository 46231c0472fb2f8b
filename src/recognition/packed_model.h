#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Core>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/matching/surface_points.h"
#include "core/matching/view_signature.h"

namespace pcl_symmetry::detail {

/// Numbers as bytes, in the order of the machine, which is that of all machines that PCL runs on: lowest byte first.
class PackedBytes {
public:
  template <typename Number>
  void put(Number number) {
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof(number));
  }
  void putText(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size()));
    bytes_ += text;
  }
  void append(const std::string& bytes) { bytes_ += bytes; }

  const std::string& bytes() const { return bytes_; }

private:
  std::string bytes_;
};

/// Reads what PackedBytes put together. Every function throws std::invalid_argument where bytes are missing.
class UnpackedBytes {
public:
  explicit UnpackedBytes(const std::string& bytes) : bytes_(bytes) {}

  template <typename Number>
  Number get() {
    Number number;
    std::memcpy(&number, take(sizeof(number)), sizeof(number));
    return number;
  }
  /// \return the next \p size bytes.
  const char* take(std::size_t size) {
    if (size > left()) throw std::invalid_argument("is incomplete");
    position_ += size;
    return bytes_.data() + position_ - size;
  }
  /// \return what putText() put.
  std::string text() {
    const auto size = get<std::uint32_t>();
    return {take(size), size};
  }
  std::size_t left() const { return bytes_.size() - position_; }

private:
  const std::string& bytes_;
  std::size_t position_ = 0;
};

enum class Effort { Low = 1, High = 6 };  ///< levels of zlib
/// Compressed bytes with their length before them.
std::string compressed(const std::string& bytes, Effort effort);
/// \throws std::invalid_argument for bytes that compressed() did not make.
std::string decompressed(const std::string& bytes);

/// CRC-32 of the bytes that follow each other: any change of up to 32 neighboring bits changes it.
class Checksum {
public:
  Checksum& add(const std::string& bytes);
  Checksum& add(std::int64_t number);
  std::int64_t value() const { return value_; }

private:
  std::uint32_t value_ = 0;
};

/// A matrix with the step of each column in bits: errors are at most half a step.
enum class MatrixBits {
  Eight = 1,   ///< step: 1/127 of the greatest value of the column
  Sixteen = 2  ///< step: 1/32767 of it
};
std::string packedMatrix(const Eigen::Ref<const Eigen::MatrixXf>& matrix, MatrixBits bits);
/// \throws std::invalid_argument for other bytes.
Eigen::MatrixXf unpackedMatrix(const std::string& bytes);

/// The parts of a model as bytes. Reading throws std::invalid_argument where the bytes are no such part.

using PositionCloud = pcl::PointCloud<pcl::PointXYZ>;

/// Coordinates in steps of 1/65535 of the greatest extent: their error is at most 7.7e-6 of it. The order of the points
/// is lost: neighbors follow each other.
/// \param cloud finite points.
std::string packedCloud(const PositionCloud& cloud);
PositionCloud unpackedCloud(const std::string& bytes);

/// Values in steps of 1/127 of the greatest one of each column.
std::string packedSignatures(const Eigen::MatrixXf& signatures);
Eigen::MatrixXf unpackedSignatures(const std::string& bytes);

/// Values in steps of 1/96, rotations in steps of 1/32767.
std::string packedViews(const std::vector<View>& views);
std::vector<View> unpackedViews(const std::string& bytes);

/// Coordinates and normals in steps of 1/32767 of the greatest one from the center of mass, in their order.
std::string packedSurfaces(const std::vector<SurfacePoints>& surfaces);
std::vector<SurfacePoints> unpackedSurfaces(const std::string& bytes);

}  // namespace pcl_symmetry::detail
