#include "core/rotation/circle_minimax.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/constants.h"

namespace pcl_symmetry {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// 1, cos and sin of an angle.
Eigen::Vector3d termsAt(double phi) {
  return {1.0, std::cos(phi), std::sin(phi)};
}

struct Arc {
  double begin, end;
  std::vector<int> waves;  ///< those that may be the greatest somewhere on it
};

struct Crest {
  double angle;  ///< radians
  double swing;  ///< of the wave about its mean
};

Crest crestOf(const CircleWave& wave) {
  return {std::atan2(wave.sine, wave.cosine), std::hypot(wave.cosine, wave.sine)};
}

/// The angle, moved by multiples of 2 pi to where it is at most the end of the arc.
double towards(const Arc& arc, double phi) {
  return phi - 2.0 * kPi * std::ceil((phi - arc.end) / (2.0 * kPi));
}

bool isOn(const Arc& arc, double phi) {
  return towards(arc, phi) >= arc.begin;
}

/// Searches the circle arc by arc.
class MinimaxSearch {
public:
  explicit MinimaxSearch(const std::vector<CircleWave>& waves) : waves_(waves) {
    double scale = 0.0;
    crests_.reserve(waves.size());
    for (const CircleWave& wave : waves) {
      crests_.push_back(crestOf(wave));
      scale = std::max(scale, std::abs(wave.mean) + crests_.back().swing);
    }
    precision_ = 2e-13 * scale;  // a thousand times the rounding of double
  }

  double best() {
    std::vector<int> all(waves_.size());
    std::iota(all.begin(), all.end(), 0);
    std::vector<Arc> open;
    const int num_arcs = 8;
    for (int k = 0; k < num_arcs; ++k) open.push_back({2.0 * kPi * k / num_arcs, 2.0 * kPi * (k + 1) / num_arcs, all});
    while (!open.empty()) {
      Arc arc = std::move(open.back());
      open.pop_back();
      if (!narrow(arc) || arc.end - arc.begin < 1e-14) continue;
      const double middle = 0.5 * (arc.begin + arc.end);
      open.push_back({middle, arc.end, arc.waves});
      open.push_back({arc.begin, middle, std::move(arc.waves)});
    }
    return best_angle_;
  }

private:
  /// Keeps the waves that matter on the arc, and tries its candidates.
  /// \return whether there may be a better angle on it than the best one.
  bool narrow(Arc& arc) {
    const Eigen::Vector3d begin = termsAt(arc.begin), end = termsAt(arc.end);
    double bound = -kInfinity, begin_height = -kInfinity, end_height = -kInfinity;
    int highest = 0, at_begin = 0, at_end = 0;
    std::vector<double> greatest(arc.waves.size());
    for (std::size_t k = 0; k < arc.waves.size(); ++k) {
      const int i = arc.waves[k];
      const double at_first = waves_[i].at(begin), at_last = waves_[i].at(end);
      const bool has_trough = isOn(arc, crests_[i].angle + kPi), has_crest = isOn(arc, crests_[i].angle);
      const double least = has_trough ? waves_[i].mean - crests_[i].swing : std::min(at_first, at_last);
      greatest[k] = has_crest ? waves_[i].mean + crests_[i].swing : std::max(at_first, at_last);
      if (least > bound) bound = least, highest = i;
      if (at_first > begin_height) begin_height = at_first, at_begin = i;
      if (at_last > end_height) end_height = at_last, at_end = i;
    }
    if (bound >= best_ - precision_) return false;
    std::size_t size = 0;
    for (std::size_t k = 0; k < arc.waves.size(); ++k)
      if (greatest[k] >= bound) arc.waves[size++] = arc.waves[k];
    arc.waves.resize(size);
    tryAngle(arc, 0.5 * (arc.begin + arc.end));
    tryAngle(arc, crests_[highest].angle + kPi);
    tryCrossings(arc, waves_[at_begin], waves_[at_end]);
    return bound < best_ - precision_;
  }

  void tryCrossings(const Arc& arc, const CircleWave& a, const CircleWave& b) {
    const CircleWave difference{a.mean - b.mean, a.cosine - b.cosine, a.sine - b.sine};
    const Crest crest = crestOf(difference);
    if (std::abs(difference.mean) >= crest.swing) return;
    const double half = std::acos(-difference.mean / crest.swing);
    tryAngle(arc, crest.angle - half);
    tryAngle(arc, crest.angle + half);
  }

  /// Takes the angle where it lies on the arc and is better than the best one.
  void tryAngle(const Arc& arc, double phi) {
    phi = towards(arc, phi);
    if (phi < arc.begin) return;
    const Eigen::Vector3d terms = termsAt(phi);
    double greatest = -kInfinity;
    for (const int i : arc.waves) {
      greatest = std::max(greatest, waves_[i].at(terms));
      if (greatest >= best_) return;
    }
    best_ = greatest;
    best_angle_ = phi;
  }

  const std::vector<CircleWave>& waves_;
  std::vector<Crest> crests_;
  double precision_ = 0.0;
  double best_ = kInfinity;
  double best_angle_ = 0.0;
};

}  // namespace

double circleMinimax(const std::vector<CircleWave>& waves) {
  return MinimaxSearch(waves).best();
}

}  // namespace pcl_symmetry
