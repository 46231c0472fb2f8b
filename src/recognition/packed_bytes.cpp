#include "recognition/packed_bytes.h"

#include <zlib.h>

#include <cmath>
#include <limits>
#include <vector>

namespace pcl_symmetry::detail {

namespace {

// Bytes. chosen: no part of a model is as large; twice would let a damaged length ask for more memory.
constexpr std::uint32_t kLargestPart = 1u << 30;
// Bytes that one compressed byte stands for at most. derived: of the format; 258 bytes take two bits or more.
constexpr std::size_t kMostExpansion = 1032;

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

}  // namespace

std::string compressed(const std::string& bytes, Effort effort) {
  if (bytes.size() > kLargestPart) throw std::invalid_argument("is too large to be stored");
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
  if (length > kLargestPart) throw std::invalid_argument("is too large");
  const std::size_t packed_size = bytes.size() - sizeof(length);
  if (length / kMostExpansion > packed_size) throw std::invalid_argument("has fewer bytes than it says");
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

}  // namespace pcl_symmetry::detail
