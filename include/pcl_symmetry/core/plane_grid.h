#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Numbers of bins of a map of planes. The defaults have as many directions as the paper's 64 x 64, but are as fine in
/// phi at the equator as in theta, because a peak of D is narrower than a bin of 5.6 degrees.
struct MapSize {
  int num_theta = 32;   ///< in [1, 4096]
  int num_phi = 128;    ///< even, in [2, 4096]
  int num_radius = 64;  ///< in [1, 4096]

  /// Checks all values.
  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// The discrete space of planes (Section 4.2): theta in [0, pi/2], phi in [0, 2 pi) and r in [-radius, radius] about a
/// center, each cut into equal bins. Bin (t, p, k) has its center at theta = (t + 1/2) dtheta, phi = (p + 1/2) dphi,
/// r = (k + 1/2) dr - radius.
///
/// Seams: phi wraps around. Past the pole (theta < 0) lies (-theta, phi + pi, r); past the equator (theta > pi/2) lies
/// (pi - theta, phi + pi, -r).
class PlaneGrid {
public:
  /// Indices of a cell of the grid.
  struct Bin {
    int theta;   ///< in [0, numTheta())
    int phi;     ///< in [0, numPhi())
    int radius;  ///< in [0, numRadius())
  };

  PlaneGrid() = default;

  /// Makes a grid of planes through a ball.
  /// \param center finite, input frame; r is measured from it.
  /// \param radius finite and > 0, input units.
  /// \throws std::invalid_argument naming field, value and rule.
  PlaneGrid(const MapSize& size, const Eigen::Vector3d& center, double radius);
  /// As above.
  PlaneGrid(int num_theta, int num_phi, int num_radius, const Eigen::Vector3d& center, double radius)
      : PlaneGrid(MapSize{num_theta, num_phi, num_radius}, center, radius) {}

  int numTheta() const { return num_theta_; }                                                    ///< bins of theta
  int numPhi() const { return num_phi_; }                                                        ///< bins of phi
  int numRadius() const { return num_radius_; }                                                  ///< bins of r
  std::size_t numDirections() const { return static_cast<std::size_t>(num_theta_) * num_phi_; }  ///< theta times phi
  std::size_t size() const { return numDirections() * num_radius_; }                             ///< all bins
  const Eigen::Vector3d& center() const { return center_; }  ///< that r is measured from, input frame
  double radius() const { return radius_; }                  ///< greatest |r|, input units

  double thetaStep() const;   ///< radians
  double phiStep() const;     ///< radians
  double radiusStep() const;  ///< input units

  /// \return (theta * num_phi + phi) * num_radius + radius: bins of one direction lie side by side.
  std::size_t index(const Bin& bin) const {
    return (static_cast<std::size_t>(bin.theta) * num_phi_ + bin.phi) * num_radius_ + bin.radius;
  }
  /// \return the bin of an index; the inverse of index().
  Bin bin(std::size_t index) const;

  double theta(int t) const { return (t + 0.5) * thetaStep(); }  ///< at the bin center, radians
  double phi(int p) const { return (p + 0.5) * phiStep(); }      ///< at the bin center, radians
  /// \return r at the bin center: signed distance of the plane from the grid's center, input units.
  double offset(int k) const { return (k + 0.5) * radiusStep() - radius_; }

  /// \return unit normal at the center of direction bin (t, p).
  Eigen::Vector3d normal(int t, int p) const;
  /// The normal of a direction.
  /// \param direction t * num_phi + p, in [0, numDirections()).
  Eigen::Vector3d normal(std::size_t direction) const;

  /// \return the plane at the bin center, input frame.
  ReflectionPlane plane(const Bin& bin) const;

  /// \return the bin that contains the plane; none if the plane is farther than radius() from the center.
  std::optional<Bin> find(const ReflectionPlane& plane) const;

  /// Goes from a bin to a neighbor, across the seams of the half-sphere.
  /// \param dt,dp,dk steps, dt in {-1, 0, 1}.
  /// \return the bin at (t + dt, p + dp, k + dk), across the seams; none beyond the ends of r.
  std::optional<Bin> step(const Bin& bin, int dt, int dp, int dk) const;

  /// Calls visit(index) for the bins around a bin, some of them twice, until a call returns false: those one step away
  /// in theta and r, and as many steps in phi as cover the angle of one step in theta.
  ///
  /// At the equator these are the 26 neighbors of the paper. Departure near the pole: bins are slivers in phi there,
  /// and one peak would be a maximum in many of them.
  /// \return whether all calls returned true.
  template <typename Visit>
  bool visitNeighbors(const Bin& bin, const Visit& visit) const {
    const std::size_t self = index(bin);
    for (int dt = -1; dt <= 1; ++dt) {
      const Bin beside = *step(bin, dt, 0, 0);
      const int first = beside.radius > 0 ? beside.radius - 1 : 0;
      const int last = beside.radius + 1 < num_radius_ ? beside.radius + 1 : beside.radius;
      const int reach = phiReach(beside.theta);
      for (int i = 0; i <= 2 * reach; ++i) {
        const int phi = beside.phi + (i % 2 ? (i + 1) / 2 : -i / 2);  // 0, 1, -1, 2, -2 ... beside: the nearest first
        const int wrapped = phi < 0 ? phi + num_phi_ : phi < num_phi_ ? phi : phi - num_phi_;
        const std::size_t row = index({beside.theta, wrapped, 0});
        for (int k = first; k <= last; ++k)
          if (row + k != self && !visit(row + k)) return false;
      }
    }
    return true;
  }

private:
  /// Number of bins in phi that cover one step of theta in this row.
  int phiReach(int t) const { return phi_reach_[t]; }

  int num_theta_ = 0;
  int num_phi_ = 0;
  int num_radius_ = 0;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  double radius_ = 0.0;
  std::vector<int> phi_reach_;
};

}  // namespace pcl_symmetry
