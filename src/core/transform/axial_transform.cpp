#include "pcl_symmetry/core/axial_transform.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/transform/sampled_transform.h"
#include "core/transform/transform_rules.h"

namespace pcl_symmetry {

namespace {

/// A rotation about an axis, and its weight in D_n of each fold. Rotations by an angle and by its negative correlate
/// equally, but move different parts into free space.
struct AxialRotation {
  double angle;                 ///< radians, in (0, 2 pi)
  std::vector<double> weights;  ///< for each fold; the sum over all rotations is 1
};

/// The rotations that determine the D of all folds, each once.
/// \param folds as in AxialTransformOptions.
/// \param both_ways whether rotations by more than pi are included.
std::vector<AxialRotation> rotationsOf(const std::vector<int>& folds, bool both_ways) {
  const int num_rotations = kTransform.num_rotations;
  std::map<std::pair<int, int>, std::size_t> index_of;  // by reduced fraction of a full rotation
  std::vector<AxialRotation> rotations;
  const auto add = [&](int part, int whole, std::size_t fold, double weight) {
    const int divisor = std::gcd(part, whole);
    const auto [position, is_new] = index_of.try_emplace({part / divisor, whole / divisor}, rotations.size());
    if (is_new) rotations.push_back({2.0 * kPi * part / whole, std::vector<double>(folds.size(), 0.0)});
    rotations[position->second].weights[fold] += weight;
  };
  const auto addPair = [&](int part, int whole, std::size_t fold, double weight) {
    const bool alone = 2 * part == whole;
    add(part, whole, fold, alone || both_ways ? weight : 2.0 * weight);
    if (both_ways && !alone) add(whole - part, whole, fold, weight);
  };
  for (std::size_t i = 0; i < folds.size(); ++i) {
    const int n = folds[i];
    for (int k = 1; 2 * k <= n; ++k) addPair(k, n, i, 1.0 / (n - 1));
    // The middles of equal parts of a half rotation: the mean over all angles, except for harmonics of order 2
    // num_rotations and more.
    for (int k = 0; n == 0 && k < num_rotations; ++k) addPair(2 * k + 1, 4 * num_rotations, i, 0.5 / num_rotations);
  }
  return rotations;
}

constexpr std::size_t kDirectionsPerBlock = 4;

/// The bins of u with u^2 + v^2 <= radius^2.
std::pair<int, int> rowInBall(const AxisGrid& grid, int v) {
  const auto inside = [&](int u) {
    return grid.offset(u) * grid.offset(u) + grid.offset(v) * grid.offset(v) <= grid.radius() * grid.radius();
  };
  int begin = 0;
  while (begin < grid.numOffset() && !inside(begin)) ++begin;
  return {begin, std::max(begin, grid.numOffset() - begin)};
}

/// Adds the terms of one rotation for all axes of a direction to D, and to F where the table has free space.
/// \param[in,out] sums D, and F, of each fold for all axes of the direction.
void addRotation(LineSums& lines, const GaussianEdt& edt, const AxisGrid& grid, const Eigen::Matrix3d& frame,
                 const AxialRotation& rotation, double scale, const Eigen::Matrix3Xf& samples,
                 std::vector<std::vector<std::vector<float>>>& sums) {
  const Eigen::Matrix3d matrix = Eigen::AngleAxisd(rotation.angle, frame.col(2)).toRotationMatrix();
  const Eigen::Matrix3d rest = Eigen::Matrix3d::Identity() - matrix;
  const Eigen::Matrix3Xf moved = matrix.cast<float>() * samples;
  const Eigen::Vector3d center = toCells(edt, grid.center());
  const Eigen::Vector3d step = rest * frame.col(0) * (grid.offsetStep() / edt.cellSize());
  for (int v = 0; v < grid.numOffset(); ++v) {
    const auto [begin, end] = rowInBall(grid, v);
    if (begin == end) continue;
    const Eigen::Vector3d foot = (grid.offset(0) * frame.col(0) + grid.offset(v) * frame.col(1)) / edt.cellSize();
    const LineSums::Totals& totals =
        lines.ofMoved(moved, (rest * (center + foot)).cast<float>(), step.cast<float>(), begin, end);
    const std::size_t row = static_cast<std::size_t>(v) * grid.numOffset();
    for (std::size_t g = 0; g < sums.size(); ++g)
      for (std::size_t i = 0; i < rotation.weights.size(); ++i) {
        if (rotation.weights[i] == 0.0) continue;
        const double weight = scale * rotation.weights[i];
        for (int k = begin; k < end; ++k) sums[g][i][row + k] += static_cast<float>(weight * totals[g][k]);
      }
  }
}

bool isSameAxis(const Line3d& a, const Line3d& b, const Eigen::Vector3d& center, double angle, double distance) {
  const double cosine = std::abs(a.direction().dot(b.direction()));
  return cosine > std::cos(angle) && (a.projection(center) - b.projection(center)).norm() < distance;
}

/// D of axes between the bins, by the same estimate as at the bins.
class AxisClimb {
public:
  AxisClimb(const GaussianEdt& edt, const AxisMap& map, const AxialTransformOptions& options)
      : edt_(edt),
        map_(map),
        rotations_(rotationsOf(map.folds, false)),
        samples_(
            centeredSamples(edt, kTransform.more_samples * options.num_samples, options.seed, options.num_threads)) {}

  std::vector<double> valuesAt(const Line3d& axis) const {
    std::vector<double> values(map_.folds.size(), 0.0);
    for (const AxialRotation& rotation : rotations_) {
      const double d = symmetryAt(axis, rotation.angle);
      for (std::size_t i = 0; i < values.size(); ++i) values[i] += rotation.weights[i] * d;
    }
    return values;
  }

  /// The axis, moved to where D of its best fold is greatest, in steps of half a bin that are halved repeatedly.
  AxisMaximum refine(Line3d axis) const {
    const int fold = bestFold(map_.folds, valuesAt(axis));
    const std::size_t position = std::find(map_.folds.begin(), map_.folds.end(), fold) - map_.folds.begin();
    double angle = 0.25 * kPi / map_.grid.numTheta(), offset = 0.5 * map_.grid.offsetStep();
    double best = valueAt(axis, position);
    for (int halving = 0; halving < kTransform.halvings; angle *= 0.5, offset *= 0.5, ++halving)
      for (bool moved = true; moved;) {
        moved = false;
        for (int way = 0; way < 8; ++way) {
          const Line3d next = stepped(axis, way, way % 2 ? -1.0 : 1.0, angle, offset);
          const double value = valueAt(next, position);
          if (value <= best) continue;
          axis = next;
          best = value;
          moved = true;
        }
      }
    AxisMaximum maximum{axis, fold, 0.0, valuesAt(axis)};
    maximum.fold = bestFold(map_.folds, maximum.values);
    maximum.value = *std::max_element(maximum.values.begin(), maximum.values.end());
    return maximum;
  }

private:
  double symmetryAt(const Line3d& axis, double angle) const {
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(angle, axis.direction()).toRotationMatrix();
    const Eigen::Vector3d foot = toCells(edt_, axis.origin());
    const Eigen::Vector3d middle = Eigen::Vector3d::Constant(middleCell(edt_));
    double sum = 0.0;
    for (Eigen::Index i = 0; i < samples_.cols(); ++i)
      sum += edt_.atCell(rotation * (samples_.col(i).cast<double>() - foot) + foot + middle);
    return edt_.sum() / edt_.sqNorm() * sum / static_cast<double>(samples_.cols());
  }

  double valueAt(const Line3d& axis, std::size_t fold) const {
    double value = 0.0;
    for (const AxialRotation& rotation : rotations_)
      if (rotation.weights[fold] > 0.0) value += rotation.weights[fold] * symmetryAt(axis, rotation.angle);
    return value;
  }

  Line3d stepped(const Line3d& axis, int way, double sign, double angle, double offset) const {
    const Eigen::Vector3d u = axis.direction().unitOrthogonal(), v = axis.direction().cross(u);
    const Eigen::Vector3d& along = way / 2 % 2 ? v : u;
    const Eigen::Vector3d foot = axis.projection(map_.grid.center());
    if (way >= 4) return {foot + sign * offset * along, axis.direction()};
    return {foot, (axis.direction() + sign * std::tan(angle) * along).normalized()};
  }

  const GaussianEdt& edt_;
  const AxisMap& map_;
  std::vector<AxialRotation> rotations_;
  Eigen::Matrix3Xf samples_;
};

/// Bins of great values, none close to a stronger one.
std::vector<Line3d> startsOf(const AxisMap& map, std::size_t count, double min_value) {
  std::vector<std::size_t> bins;
  for (std::size_t i = 0; i < map.greatest.size(); ++i)
    if (map.greatest[i] >= min_value) bins.push_back(i);
  const std::size_t kept = std::min(bins.size(), kTransform.max_axis_bins);
  std::partial_sort(bins.begin(), bins.begin() + kept, bins.end(), [&](std::size_t a, std::size_t b) {
    return std::make_pair(-map.greatest[a], a) < std::make_pair(-map.greatest[b], b);
  });
  bins.resize(kept);
  std::vector<Line3d> starts;
  for (const std::size_t bin : bins) {
    if (starts.size() == count) break;
    const Line3d axis = map.grid.axis(map.grid.bin(bin));
    if (std::none_of(starts.begin(), starts.end(), [&](const Line3d& other) {
          return isSameAxis(axis, other, map.grid.center(), kTransform.same_start, kTransform.same_offset * map.sigma);
        }))
      starts.push_back(axis);
  }
  return starts;
}

/// Values of one direction, bilinear between their bins and 0 beyond.
class DirectionValues {
public:
  DirectionValues(const AxisMap& map, std::size_t direction)
      : num_(map.grid.numOffset()),
        values_(map.greatest.data() + direction * num_ * num_),
        per_unit_(static_cast<float>(1.0 / map.grid.offsetStep())),
        // moves offset(0) to 0
        shift_(0.5f * static_cast<float>(num_) - 0.5f) {}

  float operator()(float u, float v) const {
    // A point in the outer half of a bin at the border has the value of that bin.
    const float most = static_cast<float>(num_) - 1.0f;
    const float x = u * per_unit_ + shift_, y = v * per_unit_ + shift_;
    if (!(x >= -0.5f && y >= -0.5f && x <= most + 0.5f && y <= most + 0.5f)) return 0.0f;
    const float in_x = std::clamp(x, 0.0f, most), in_y = std::clamp(y, 0.0f, most);
    const int i = std::min(static_cast<int>(in_x), std::max(0, num_ - 2));
    const int j = std::min(static_cast<int>(in_y), std::max(0, num_ - 2));
    const int right = num_ > 1, up = num_ > 1 ? num_ : 0;
    const float s = in_x - static_cast<float>(i), t = in_y - static_cast<float>(j);
    const float* at = values_ + static_cast<std::size_t>(j) * num_ + i;
    return (1.0f - t) * ((1.0f - s) * at[0] + s * at[right]) + t * ((1.0f - s) * at[up] + s * at[up + right]);
  }

private:
  int num_;
  const float* values_;
  float per_unit_, shift_;
};

}  // namespace

AxisGrid::AxisGrid(int num_theta, int num_phi, int num_offset, const Eigen::Vector3d& center, double radius)
    : num_theta_(num_theta), num_phi_(num_phi), num_offset_(num_offset), center_(center), radius_(radius) {
  constexpr int max_per_axis = 1024;            // 0.1 degrees
  constexpr std::size_t max_bins = 1ull << 28;  // 1 GiB for each fold
  check(num_theta >= 1 && num_theta <= max_per_axis, "num_theta", num_theta, "in [1, 1024]");
  check(num_phi >= 2 && num_phi <= max_per_axis && num_phi % 2 == 0, "num_phi", num_phi, "even and in [2, 1024]");
  check(num_offset >= 1 && num_offset <= max_per_axis, "num_offset", num_offset, "in [1, 1024]");
  check(size() <= max_bins, "number of bins", size(), "at most 268435456");
  check(center.allFinite(), "center", center.transpose(), "finite");
  check(std::isfinite(radius) && radius > 0.0, "radius", radius, "finite and > 0");
}

std::size_t AxisGrid::index(const Bin& bin) const {
  const std::size_t direction = static_cast<std::size_t>(bin.theta) * num_phi_ + bin.phi;
  return (direction * num_offset_ + bin.v) * num_offset_ + bin.u;
}

AxisGrid::Bin AxisGrid::bin(std::size_t index) const {
  const std::size_t row = index / num_offset_, direction = row / num_offset_;
  return {static_cast<int>(direction / num_phi_), static_cast<int>(direction % num_phi_),
          static_cast<int>(index % num_offset_), static_cast<int>(row % num_offset_)};
}

Eigen::Matrix3d AxisGrid::frame(std::size_t direction) const {
  const double theta = (direction / num_phi_ + 0.5) * 0.5 * kPi / num_theta_;
  const double phi = (direction % num_phi_ + 0.5) * 2.0 * kPi / num_phi_;
  Eigen::Matrix3d frame;
  frame.col(0) << std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi), -std::sin(theta);
  frame.col(1) << -std::sin(phi), std::cos(phi), 0.0;
  frame.col(2) << std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta);
  return frame;
}

Line3d AxisGrid::axis(const Bin& bin) const {
  const Eigen::Matrix3d axes = frame(static_cast<std::size_t>(bin.theta) * num_phi_ + bin.phi);
  return {center_ + offset(bin.u) * axes.col(0) + offset(bin.v) * axes.col(1), axes.col(2)};
}

void AxialTransformOptions::validate() const {
  check(!folds.empty(), "number of folds", folds.size(), ">= 1");
  for (std::size_t i = 0; i < folds.size(); ++i) {
    check(folds[i] == 0 || (folds[i] >= 2 && folds[i] <= 60), "fold", folds[i], "0 or in [2, 60]");
    check(std::count(folds.begin(), folds.end(), folds[i]) == 1, "fold", folds[i], "named once");
  }
  check(num_samples >= 1 && num_samples <= 1'000'000, "num_samples", num_samples, "in [1, 1000000]");
  checkNumThreads(num_threads);
}

AxisMap axialTransform(const GaussianEdt& edt, const AxisGrid& grid, const AxialTransformOptions& options,
                       const Visibility* visibility) {
  options.validate();
  const LookupTable table(edt, freeSpace(edt, visibility, options.num_threads), options.num_threads);
  const Eigen::Matrix3Xf samples = centeredSamples(edt, options.num_samples, options.seed, options.num_threads);
  const std::vector<AxialRotation> rotations = rotationsOf(options.folds, visibility != nullptr);
  const double scale = edt.sum() / (edt.sqNorm() * options.num_samples * LookupTable::kOne);
  const std::size_t per_direction = static_cast<std::size_t>(grid.numOffset()) * grid.numOffset();
  AxisMap map{grid, options.folds, {}, std::vector<float>(grid.size(), 0.0f), edt.sigma()};
  map.values.assign(options.folds.size(), map.greatest);
  const auto run = [&](std::size_t begin, std::size_t end) {
    LineSums lines(edt, table, grid.numOffset());
    const std::vector<std::vector<float>> nothing(options.folds.size(), std::vector<float>(per_direction, 0.0f));
    for (std::size_t direction = begin; direction < end; ++direction) {
      std::vector<std::vector<std::vector<float>>> sums(table.numFunctions(), nothing);
      for (const AxialRotation& rotation : rotations)
        addRotation(lines, edt, grid, grid.frame(direction), rotation, scale, samples, sums);
      for (std::size_t i = 0; i < options.folds.size(); ++i) {
        float* const values = map.values[i].data() + direction * per_direction;
        float* const greatest = map.greatest.data() + direction * per_direction;
        for (std::size_t k = 0; k < per_direction; ++k) {
          const float d = sums[0][i][k];
          values[k] = visibility ? static_cast<float>(seenSymmetry(d, sums[1][i][k])) : d;
          greatest[k] = std::max(greatest[k], values[k]);
        }
      }
    }
  };
  parallelRanges(grid.numDirections(), kDirectionsPerBlock, options.num_threads, run);
  return map;
}

int bestFold(const std::vector<int>& folds, const std::vector<double>& values) {
  const double least = *std::max_element(values.begin(), values.end()) - kTransform.equal_orders;
  int best = -1;
  for (std::size_t i = 0; i < folds.size(); ++i)
    if (values[i] >= least && best != 0 && (folds[i] == 0 || folds[i] > best)) best = folds[i];
  return best;
}

std::vector<AxisMaximum> axisMaxima(const AxisMap& map, const GaussianEdt& edt, int count, double min_value,
                                    const AxialTransformOptions& options) {
  options.validate();
  check(count >= 1, "count", count, ">= 1");
  check(min_value >= 0.0 && min_value <= 1.0, "min_value", min_value, "in [0, 1]");
  if (map.empty()) return {};
  const std::vector<Line3d> starts =
      startsOf(map, static_cast<std::size_t>(count) * kTransform.starts_per_maximum, kTransform.min_of_bin * min_value);
  const AxisClimb climb(edt, map, options);
  std::vector<AxisMaximum> candidates(starts.size());
  parallelBlocks(starts.size(), options.num_threads, [&](std::size_t i) { candidates[i] = climb.refine(starts[i]); });
  sortDescending(candidates, &AxisMaximum::value);
  std::vector<AxisMaximum> maxima;
  for (const AxisMaximum& maximum : candidates) {
    if (maximum.value < min_value || static_cast<int>(maxima.size()) == count) break;
    if (std::none_of(maxima.begin(), maxima.end(), [&](const AxisMaximum& other) {
          return isSameAxis(maximum.axis, other.axis, map.grid.center(), kTransform.same_maximum,
                            kTransform.same_offset * map.sigma);
        }))
      maxima.push_back(maximum);
  }
  return maxima;
}

std::vector<float> axialPointSymmetry(const AxisMap& map, const PointsRef& points, int num_threads) {
  std::vector<float> greatest(points.cols(), 0.0f);
  if (map.empty()) return greatest;
  const Points centered = normalizePoints(points, map.grid.center(), 1.0);
  parallelPoints(greatest.size(), num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t direction = 0; direction < map.grid.numDirections(); ++direction) {
      const DirectionValues values(map, direction);
      const Eigen::Matrix3f frame = map.grid.frame(direction).cast<float>();
      for (std::size_t i = begin; i < end; ++i) {
        const auto x = centered.col(i);
        greatest[i] = std::max(greatest[i], values(frame.col(0).dot(x), frame.col(1).dot(x)));
      }
    }
  });
  return greatest;
}

Eigen::Vector3d CenterMap::center(std::size_t index) const {
  const std::size_t n = num_centers;
  return origin + step * Eigen::Vector3d(static_cast<double>(index % n), static_cast<double>(index / n % n),
                                         static_cast<double>(index / n / n));
}

double CenterMap::operator()(const Eigen::Vector3d& x) const {
  if (values.empty()) return 0.0;
  const Eigen::Array3d position = (x - origin).array() / step;
  if (!((position >= 0.0).all() && (position <= num_centers - 1.0).all())) return 0.0;
  const Eigen::Array3i low = position.cast<int>().min(num_centers - 2);
  const Eigen::Array3d part = position - low.cast<double>();
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Array3i high(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    const Eigen::Array3i at = low + high;
    const std::size_t index = (static_cast<std::size_t>(at.z()) * num_centers + at.y()) * num_centers + at.x();
    sum += values[index] * (high.cast<double>() * part + (1 - high).cast<double>() * (1.0 - part)).prod();
  }
  return sum;
}

CenterMap centralTransform(const GaussianEdt& edt, int num_centers, const AxialTransformOptions& options,
                           const Visibility* visibility) {
  options.validate();
  check(num_centers >= 2 && num_centers <= 512, "num_centers", num_centers, "in [2, 512]");
  const LookupTable table(edt, freeSpace(edt, visibility, options.num_threads), options.num_threads);
  // The image of x is 2 c - x.
  const Eigen::Matrix3Xf reflected = -centeredSamples(edt, options.num_samples, options.seed, options.num_threads);
  // |f|^2 / S from the same samples: their noise cancels, so that no D exceeds 1 by the 2 % of the draw.
  double own = 0.0;
  for (Eigen::Index i = 0; i < reflected.cols(); ++i) {
    const Eigen::Array3i cell = (static_cast<float>(middleCell(edt)) - reflected.col(i).array()).round().cast<int>();
    own += edt.values()[(static_cast<std::size_t>(cell.z()) * edt.numCells() + cell.y()) * edt.numCells() + cell.x()];
  }
  const double scale = 1.0 / (own * LookupTable::kOne);
  CenterMap map;
  map.num_centers = num_centers;
  map.step = 2.0 * edt.radius() / num_centers;
  map.origin = edt.center().array() - edt.radius() + 0.5 * map.step;
  map.values.resize(static_cast<std::size_t>(num_centers) * num_centers * num_centers);
  parallelBlocks(num_centers, options.num_threads, [&](std::size_t z) {
    LineSums lines(edt, table, num_centers);
    const Eigen::Vector3f step(static_cast<float>(2.0 * map.step / edt.cellSize()), 0.0f, 0.0f);
    for (int y = 0; y < num_centers; ++y) {
      const std::size_t first = (z * num_centers + y) * num_centers;
      const Eigen::Vector3d start = 2.0 * toCells(edt, map.center(first));
      const LineSums::Totals& totals = lines.ofMoved(reflected, start.cast<float>(), step, 0, num_centers);
      for (int x = 0; x < num_centers; ++x) {
        const double d = scale * totals[0][x];
        map.values[first + x] = static_cast<float>(visibility ? seenSymmetry(d, scale * totals[1][x]) : d);
      }
    }
  });
  return map;
}

}  // namespace pcl_symmetry
