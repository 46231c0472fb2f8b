/// Numbers and points made of the arbitrary bytes that a fuzzer hands to a target.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

/// Ends the program with a message, which the fuzzer takes for a finding. It holds in builds without assertions too.
#define FUZZ_CHECK(condition)                                                             \
  do {                                                                                    \
    if (!(condition)) {                                                                   \
      std::fprintf(stderr, "%s:%d: does not hold: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                       \
    }                                                                                     \
  } while (false)

namespace pcl_symmetry::fuzz {

/// Takes values from the front of the bytes; zeros where none are left.
class ByteSource {
public:
  ByteSource(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  std::size_t left() const { return size_; }

  template <typename Value>
  Value take() {
    Value value{};
    const std::size_t count = std::min(sizeof(Value), size_);
    if (count > 0) std::memcpy(&value, data_, count);
    data_ += count;
    size_ -= count;
    return value;
  }

  /// \return a whole number in [0, limit).
  int below(int limit) { return take<std::uint8_t>() % limit; }
  bool flag() { return (take<std::uint8_t>() & 1) != 0; }

  /// \return the bytes that are left.
  std::string rest() {
    std::string bytes(reinterpret_cast<const char*>(data_), size_);
    size_ = 0;
    return bytes;
  }

private:
  const std::uint8_t* data_;
  std::size_t size_;
};

/// Points of three kinds: floats as they are, not finite ones too; points of a small lattice, of which many coincide,
/// lie on lines and are symmetric; the same at a scale between 1e-6 and 1e6, far from the origin.
/// \param max_count number of points.
inline Points takePoints(ByteSource& source, int max_count) {
  const int kind = source.below(3);
  const float scale = kind == 2 ? std::pow(10.0f, static_cast<float>(source.below(13) - 6)) : 1.0f;
  const float shift = kind == 2 ? scale * static_cast<float>(source.take<std::int16_t>()) : 0.0f;
  const std::size_t bytes = kind == 0 ? sizeof(float) : 1;
  const auto size = std::min<std::size_t>(max_count, source.left() / (3 * bytes));
  Points points(3, static_cast<Eigen::Index>(size));
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    for (int k = 0; k < 3; ++k)
      points(k, i) = kind == 0 ? source.take<float>() : shift + scale * static_cast<float>(source.take<std::int8_t>());
  return points;
}

inline bool isShare(double value) {
  return value >= 0.0 && value <= 1.0;
}

}  // namespace pcl_symmetry::fuzz

/// What each target defines.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
