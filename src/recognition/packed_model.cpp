#include "recognition/packed_model.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "recognition/packed_bytes.h"

namespace pcl_symmetry::detail {

namespace {

constexpr int kCoordinateBits = 16;  // chosen: half is coarser than clouds are dense, twice is more than float holds
constexpr double kLargestCoordinate = (1 << kCoordinateBits) - 1;  // derived: of that number of bits
// Steps of the value 1. measured: 80 views of the training models of the Princeton Shape Benchmark take 11.7 kB on
// average, 10.4 kB at two thirds of the steps, 8.6 kB at half of them. The error of a view has a norm of 0.05.
constexpr float kViewSteps = 96.0f;
constexpr double kRotationSteps = 32767.0;  // derived: 16 bits

using Quantised = std::array<std::uint16_t, 3>;

/// The bits of the three coordinates in turn, so that neighbours in space are neighbours in order.
std::uint64_t placeOf(const Quantised& x) {
  std::uint64_t place = 0;
  for (int bit = kCoordinateBits - 1; bit >= 0; --bit)
    for (const std::uint16_t coordinate : x) place = 2 * place + (coordinate >> bit & 1u);
  return place;
}

std::vector<Quantised> sortedSteps(const PositionCloud& cloud, const Eigen::Vector3f& corner, double step) {
  std::vector<std::pair<std::uint64_t, Quantised>> placed;
  placed.reserve(cloud.size());
  for (const pcl::PointXYZ& point : cloud) {
    const Eigen::Vector3d x = point.getVector3fMap().cast<double>() - corner.cast<double>();
    Quantised steps{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double value = step > 0.0 ? std::round(x[static_cast<Eigen::Index>(k)] / step) : 0.0;
      steps[k] = static_cast<std::uint16_t>(std::clamp(value, 0.0, kLargestCoordinate));
    }
    placed.emplace_back(placeOf(steps), steps);
  }
  std::sort(placed.begin(), placed.end());
  std::vector<Quantised> sorted;
  sorted.reserve(placed.size());
  for (const auto& [place, steps] : placed) sorted.push_back(steps);
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

std::string packedCloud(const PositionCloud& cloud) {
  const auto points = cloud.getMatrixXfMap(3, 4, 0);
  Eigen::Vector3f corner = Eigen::Vector3f::Zero();
  double step = 0.0;
  if (!cloud.empty()) {
    corner = points.rowwise().minCoeff();
    step = (points.rowwise().maxCoeff().cast<double>() - corner.cast<double>()).maxCoeff() / kLargestCoordinate;
  }
  PackedBytes packed;
  packed.put(static_cast<std::uint32_t>(cloud.size()));
  for (const float coordinate : corner) packed.put(coordinate);
  packed.put(step);
  const std::vector<Quantised> sorted = sortedSteps(cloud, corner, step);
  // Bytes of the same meaning side by side compress better.
  for (std::size_t k = 0; k < 3; ++k) {
    for (const int shift : {8, 0}) {
      std::uint16_t last = 0;
      for (const Quantised& steps : sorted) {
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
  constexpr std::size_t kPoseBytes = 4 * sizeof(float) + 4 * sizeof(std::int16_t);  // derived: see packedViews()
  if (packed.left() != count * (kPoseBytes + kViewSignatureSize))
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

}  // namespace pcl_symmetry::detail
