#include "pcl_symmetry/core/axial_transform.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/base/simd.h"
#include "core/transform/axial_turns.h"
#include "core/transform/free_space.h"
#include "core/transform/moved_lines.h"
#include "core/transform/transform_rules.h"

namespace pcl_symmetry {

namespace {

constexpr std::size_t directions_per_block = 4;

/// Sums of the table's functions over the turned samples, for all axes of one direction.
class AxesOfDirection {
public:
  AxesOfDirection(const GaussianEdt& edt, const AxisGrid& grid, const LookupTable& table, LineKernel accumulate)
      : grid_(grid),
        lines_(edt, table, accumulate, grid.numOffset()),
        cell_(edt.cellSize()),
        center_(toCells(edt, grid.center())),
        totals_(table.numFunctions(), std::vector<double>(grid.numOffset())) {}

  /// Calls visit(v, u_begin, u_end, totals) with one sum per u for each row of axes.
  template <typename Visit>
  void sum(const Eigen::Matrix3d& frame, double angle, const Eigen::Matrix3Xf& samples, const Visit& visit) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, frame.col(2)).toRotationMatrix();
    const Eigen::Matrix3d rest = Eigen::Matrix3d::Identity() - turn;
    moved_.noalias() = turn.cast<float>() * samples;
    const Eigen::Vector3d step = rest * frame.col(0) * (grid_.offsetStep() / cell_);
    for (int v = 0; v < grid_.numOffset(); ++v) {
      const auto [begin, end] = rowInBall(v);
      if (begin == end) continue;
      for (auto& total : totals_) std::fill(total.begin(), total.end(), 0.0);
      const Eigen::Vector3d foot = (grid_.offset(0) * frame.col(0) + grid_.offset(v) * frame.col(1)) / cell_;
      lines_.add(moved_, (rest * (center_ + foot)).cast<float>(), step.cast<float>(), begin, end, totals_);
      visit(v, begin, end, totals_);
    }
  }

private:
  /// The bins of u with u^2 + v^2 <= radius^2.
  std::pair<int, int> rowInBall(int v) const {
    const auto inside = [&](int u) {
      return grid_.offset(u) * grid_.offset(u) + grid_.offset(v) * grid_.offset(v) <= grid_.radius() * grid_.radius();
    };
    int begin = 0;
    while (begin < grid_.numOffset() && !inside(begin)) ++begin;
    return {begin, std::max(begin, grid_.numOffset() - begin)};
  }

  const AxisGrid& grid_;
  MovedLines lines_;
  double cell_;
  Eigen::Vector3d center_;
  Eigen::Matrix3Xf moved_;
  std::vector<std::vector<double>> totals_;
};

}  // namespace

std::vector<AxialTurn> turnsOf(const std::vector<int>& folds, int num_turns, bool both_ways) {
  std::map<std::pair<int, int>, std::size_t> places;  // by reduced fraction of a full turn
  std::vector<AxialTurn> turns;
  const auto add = [&](int part, int whole, std::size_t fold, double weight) {
    const int divisor = std::gcd(part, whole);
    const auto [place, is_new] = places.try_emplace({part / divisor, whole / divisor}, turns.size());
    if (is_new) turns.push_back({2.0 * kPi * part / whole, std::vector<double>(folds.size(), 0.0)});
    turns[place->second].weights[fold] += weight;
  };
  const auto addPair = [&](int part, int whole, std::size_t fold, double weight) {
    const bool alone = 2 * part == whole;
    add(part, whole, fold, alone || both_ways ? weight : 2.0 * weight);
    if (both_ways && !alone) add(whole - part, whole, fold, weight);
  };
  for (std::size_t i = 0; i < folds.size(); ++i) {
    const int n = folds[i];
    for (int k = 1; 2 * k <= n; ++k) addPair(k, n, i, 1.0 / (n - 1));
    // The middles of equal parts of a half turn: the mean over all angles but for harmonics of 2 num_turns and more.
    for (int k = 0; n == 0 && k < num_turns; ++k) addPair(2 * k + 1, 4 * num_turns, i, 0.5 / num_turns);
  }
  return turns;
}

void AxialTransformOptions::validate() const {
  check(!folds.empty(), "number of folds", folds.size(), ">= 1");
  for (std::size_t i = 0; i < folds.size(); ++i) {
    check(folds[i] == 0 || (folds[i] >= 2 && folds[i] <= 60), "fold", folds[i], "0 or in [2, 60]");
    check(std::count(folds.begin(), folds.end(), folds[i]) == 1, "fold", folds[i], "named once");
  }
  check(num_turns >= 4 && num_turns <= 256, "num_turns", num_turns, "in [4, 256]");
  check(num_samples >= 1 && num_samples <= 1'000'000, "num_samples", num_samples, "in [1, 1000000]");
  checkNumThreads(num_threads);
  check(simdSupported(simd), "simd", static_cast<int>(simd), "one that this processor supports");
}

std::size_t AxisMap::strongest() const {
  return greatest.empty() ? 0 : std::max_element(greatest.begin(), greatest.end()) - greatest.begin();
}

int AxisMap::fold(std::size_t index) const {
  std::vector<double> of_bin;
  for (const std::vector<float>& of_fold : values) of_bin.push_back(of_fold[index]);
  return bestFold(folds, of_bin);
}

int bestFold(const std::vector<int>& folds, const std::vector<double>& values) {
  const double least = *std::max_element(values.begin(), values.end()) - kTransform.equal_orders;
  int best = -1;
  for (std::size_t i = 0; i < folds.size(); ++i)
    if (values[i] >= least && best != 0 && (folds[i] == 0 || folds[i] > best)) best = folds[i];
  return best;
}

namespace {

/// sums[k] += weight * totals[k], rounded.
PCL_SYMMETRY_MULTIVERSION
void addWeighted(const double* totals, double weight, int begin, int end, float* sums) {
#pragma GCC ivdep
  for (int k = begin; k < end; ++k) sums[k] += static_cast<float>(weight * totals[k]);
}

/// Adds what one turn says about all axes of a direction to D, and to F where the table has free space.
void addTurn(AxesOfDirection& axes, const AxisGrid& grid, std::size_t direction, const AxialTurn& turn, double scale,
             const Eigen::Matrix3Xf& samples, std::vector<std::vector<std::vector<float>>>& sums) {
  axes.sum(grid.frame(direction), turn.angle, samples, [&](int v, int begin, int end, const auto& totals) {
    const std::size_t row = static_cast<std::size_t>(v) * grid.numOffset();
    for (std::size_t g = 0; g < sums.size(); ++g)
      for (std::size_t i = 0; i < turn.weights.size(); ++i) {
        if (turn.weights[i] == 0.0) continue;
        const double weight = scale * turn.weights[i];
        addWeighted(totals[g].data(), weight, begin, end, sums[g][i].data() + row);
      }
  });
}

/// Writes D of axes, and the greatest of any fold.
void writeValues(const float* d, std::size_t size, float* values, float* greatest) {
  for (std::size_t k = 0; k < size; ++k) {
    values[k] = d[k];
    greatest[k] = std::max(greatest[k], d[k]);
  }
}

/// The same for scans.
PCL_SYMMETRY_MULTIVERSION
void writeSeen(const float* d, const float* f, std::size_t size, float* values, float* greatest) {
#pragma GCC ivdep
  for (std::size_t k = 0; k < size; ++k) {
    const auto value = static_cast<float>(seenSymmetry(d[k], f[k]));
    values[k] = value;
    greatest[k] = greatest[k] < value ? value : greatest[k];
  }
}

}  // namespace

AxisMap axialTransform(const GaussianEdt& edt, const AxisGrid& grid, const AxialTransformOptions& options,
                       const Visibility* visibility) {
  options.validate();
  const LookupTable table = tableOf(edt, visibility, options.num_threads);
  const Eigen::Matrix3Xf samples = centeredSamples(edt, options.num_samples, options.seed, options.num_threads);
  const std::vector<AxialTurn> turns = turnsOf(options.folds, options.num_turns, visibility != nullptr);
  const LineKernel accumulate = lineKernel(options.simd, table.numFunctions());
  const double scale = edt.sum() / (edt.sqNorm() * options.num_samples * LookupTable::kOne);
  const std::size_t per_direction = static_cast<std::size_t>(grid.numOffset()) * grid.numOffset();
  AxisMap map{grid, options.folds, {}, std::vector<float>(grid.size(), 0.0f), edt.sigma()};
  map.values.assign(options.folds.size(), map.greatest);
  const auto run = [&](std::size_t begin, std::size_t end) {
    AxesOfDirection axes(edt, grid, table, accumulate);
    const std::vector<std::vector<float>> nothing(options.folds.size(), std::vector<float>(per_direction, 0.0f));
    for (std::size_t direction = begin; direction < end; ++direction) {
      std::vector<std::vector<std::vector<float>>> sums(table.numFunctions(), nothing);
      for (const AxialTurn& turn : turns) addTurn(axes, grid, direction, turn, scale, samples, sums);
      for (std::size_t i = 0; i < options.folds.size(); ++i) {
        float* const values = map.values[i].data() + direction * per_direction;
        float* const greatest = map.greatest.data() + direction * per_direction;
        if (visibility)
          writeSeen(sums[0][i].data(), sums[1][i].data(), per_direction, values, greatest);
        else
          writeValues(sums[0][i].data(), per_direction, values, greatest);
      }
    }
  };
  parallelRanges(grid.numDirections(), directions_per_block, options.num_threads, run);
  return map;
}

}  // namespace pcl_symmetry
