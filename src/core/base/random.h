#pragma once

#include <cstdint>

namespace pcl_symmetry {

/// A small random stream (SplitMix64) whose numbers are the same with every compiler and standard library.
class RandomStream {
public:
  using result_type = std::uint64_t;

  /// Streams with the same seed and different \p stream numbers are independent.
  explicit RandomStream(std::uint64_t seed, std::uint64_t stream = 0) : state_(seed) {
    state_ = (*this)() + 0xD1342543DE82EF95ull * (stream + 1);
    (*this)();
  }

  /// \return 64 random bits. The constants are those of Steele, Lea and Flood 2014.
  std::uint64_t operator()() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }

  /// \return a uniform number in [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>((*this)() >> 11) * 0x1.0p-53; }

  /// \param size >= 1, at most 2^53.
  /// \return a uniform integer in [0, size).
  std::uint64_t below(std::uint64_t size) { return static_cast<std::uint64_t>(uniform() * static_cast<double>(size)); }

  // A uniform random bit generator of the standard library.
  static constexpr std::uint64_t min() { return 0; }
  static constexpr std::uint64_t max() { return ~std::uint64_t{0}; }

private:
  std::uint64_t state_;
};

}  // namespace pcl_symmetry
