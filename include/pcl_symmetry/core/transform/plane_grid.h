#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "pcl_symmetry/core/geometry/reflection_plane.h"
#include "pcl_symmetry/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// The discrete space of planes (Section 4.2): theta in [0, pi/2], phi in [0, 2 pi), r in [-radius, radius] about a
/// center, cut into equal bins; bin (t, p, k) has its center at ((t + 1/2) dtheta, (p + 1/2) dphi, (k + 1/2) dr -
/// radius).
///
/// Seams: phi wraps; past the pole (theta < 0) lies (-theta, phi + pi, r); past the equator (theta > pi/2) lies
/// (pi - theta, phi + pi, -r).
class PlaneGrid {
public:
  struct Bin {
    int theta;
    int phi;
    int radius;
  };

  PlaneGrid() = default;

  /// \param num_theta,num_phi,num_radius bins, each >= 1, num_phi even.
  /// \param center,radius in input units; radius > 0 and finite.
  /// \throws std::invalid_argument naming the field.
  PlaneGrid(int num_theta, int num_phi, int num_radius, const Eigen::Vector3d& center, double radius);

  int numTheta() const { return num_theta_; }
  int numPhi() const { return num_phi_; }
  int numRadius() const { return num_radius_; }
  std::size_t numDirections() const { return static_cast<std::size_t>(num_theta_) * num_phi_; }
  std::size_t size() const { return numDirections() * num_radius_; }
  const Eigen::Vector3d& center() const { return center_; }
  double radius() const { return radius_; }

  double thetaStep() const;   ///< radians
  double phiStep() const;     ///< radians
  double radiusStep() const;  ///< input units

  /// Bins of one direction lie side by side: index = (theta * num_phi + phi) * num_radius + radius.
  std::size_t index(const Bin& bin) const {
    return (static_cast<std::size_t>(bin.theta) * num_phi_ + bin.phi) * num_radius_ + bin.radius;
  }
  Bin bin(std::size_t index) const;

  double theta(int t) const { return (t + 0.5) * thetaStep(); }
  double phi(int p) const { return (p + 0.5) * phiStep(); }
  /// Offset of the bin center from the grid's center, input units.
  double offset(int k) const { return (k + 0.5) * radiusStep() - radius_; }

  /// Unit normal at the center of direction bin (t, p).
  Eigen::Vector3d normal(int t, int p) const;

  /// The plane at the bin center, in the input frame.
  ReflectionPlane plane(const Bin& bin) const;

  /// The bin that holds the plane; none where the plane passes the center at more than radius().
  std::optional<Bin> find(const ReflectionPlane& plane) const;

  /// The bin at (t + dt, p + dp, k + dk) with dt in {-1, 0, 1}, led across the seams; none beyond the ends of r.
  std::optional<Bin> step(const Bin& bin, int dt, int dp, int dk) const;

  /// Indices of the bins around this one, without itself, ascending: one step in theta and r, and in phi as many as it
  /// takes to cover an angle of one step in theta. (At the equator that is the paper's 26 neighbours. Near the pole
  /// bins are slivers in phi, and one peak would be a maximum of many of them.)
  std::vector<std::size_t> neighbours(const Bin& bin) const;

  /// Calls visit(index) for the same bins, some of them twice, until one call returns false.
  /// \return whether all calls returned true.
  template <typename Visit>
  bool visitNeighbours(const Bin& bin, const Visit& visit) const {
    const std::size_t self = index(bin);
    for (int dt = -1; dt <= 1; ++dt) {
      const int reach = phiReach(step(bin, dt, 0, 0)->theta);
      for (int i = 0; i <= 2 * reach; ++i) {
        const int dp = i % 2 ? (i + 1) / 2 : -i / 2;  // 0, 1, -1, 2, -2 ...: the nearest first
        for (int dk = -1; dk <= 1; ++dk) {
          const auto to = step(bin, dt, dp, dk);
          if (to && index(*to) != self && !visit(index(*to))) return false;
        }
      }
    }
    return true;
  }

private:
  /// Bins in phi that cover one step of theta in this row.
  int phiReach(int t) const { return phi_reach_[t]; }

  int num_theta_ = 0;
  int num_phi_ = 0;
  int num_radius_ = 0;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  double radius_ = 0.0;
  std::vector<int> phi_reach_;
};

}  // namespace pcl_symmetry
