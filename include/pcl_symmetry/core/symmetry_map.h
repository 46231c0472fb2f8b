#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Numbers of bins of a map of planes. The defaults have as many directions as the paper's 64 x 64, but are as fine in
/// phi at the equator as in theta, because a peak of D is narrower than a bin of 5.6 degrees.
struct MapSize {
  int num_theta = 32;   ///< bins of theta, in [1, 4096]
  int num_phi = 128;    ///< bins of phi, even, in [2, 4096]
  int num_radius = 64;  ///< bins of r, in [1, 4096]

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
  const Eigen::Vector3d& center() const { return center_; }  ///< origin of r, input frame
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

  /// Calls visit(index) for the bins around a bin, some of them twice, until a call returns false. These are the bins
  /// one step away in theta and r, and as many steps in phi as cover the angle of one step in theta.
  ///
  /// At the equator these are the 26 neighbors of the paper. Departure from the paper: near the pole, bins are slivers
  /// in phi, and one peak would be a maximum in many of them.
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
        const int phi = beside.phi + (i % 2 ? (i + 1) / 2 : -i / 2);  // steps 0, 1, -1, 2, -2 ...: the nearest first
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

class GaussianEdt;

/// Estimators of the transform. All give the same normalized quantity.
enum class TransformMethod {
  Sampled,      ///< draws one point of each pair and looks up the other; the default and the fastest
  Convolution,  ///< exact correlation along each normal (Section 4.2, Figure 4a)
  Rotational,   ///< exact correlation of the planes through each of many points (Section 4.2, Figure 4b)
  Voting        ///< Monte Carlo voting of point pairs (Section 4.3); averages over bins instead of values at centers
};

/// The planar-reflective symmetry transform of a shape: D(f, gamma) = f . gamma(f) / |f|^2 (Equation 2) for every bin
/// of planes.
struct SymmetryMap {
  PlaneGrid grid;  ///< the planes of the values
  /// grid.size() values of D, 1 for a perfect symmetry. Estimates exceed [0, 1] by their error.
  std::vector<float> values;
  TransformMethod method = TransformMethod::Sampled;  ///< estimator that made the values
  double sigma = 0.0;                                 ///< width of the GEDT that the map was made from, input units
  /// Mean of the points, input frame. The threshold 1 - r / R of Section 4.4 measures r from it.
  Eigen::Vector3d center_of_mass = Eigen::Vector3d::Zero();

  /// \return D at a bin.
  float operator[](std::size_t index) const { return values[index]; }

  /// \return PRST = sqrt((1 + D) / 2) at a bin (Equation 1).
  double prst(std::size_t index) const { return std::sqrt(std::max(0.0, 0.5 * (1.0 + values[index]))); }

  /// \return index of the bin with the greatest value; 0 for an empty map.
  std::size_t strongest() const { return std::max_element(values.begin(), values.end()) - values.begin(); }

  bool empty() const { return values.empty(); }  ///< no transform was computed

  /// \return a map of \p edt whose values are 0, with the center of the grid as center of mass.
  static SymmetryMap zero(const GaussianEdt& edt, const PlaneGrid& grid, TransformMethod method);
};

/// The transform mapped back from planes to points (Figures 1 and 2): for each point the greatest D of any plane
/// through it. The planes have the directions of the map and any r, with cubic interpolation between the bins of r.
/// \param points 3 x N, finite, input frame.
/// \param num_threads 0 = one per core; the values do not depend on it.
/// \return one value per point, >= 0; 0 where no plane of the map passes.
std::vector<float> pointSymmetry(const SymmetryMap& map, const PointsRef& points, int num_threads = 0);

/// The paper's thresholds on local maxima, each a share of the value at the strongest one (Section 4.4).
struct LocalMaximaOptions {
  double strength = 0.1;   ///< keeps D >= strength * D_strongest * (1 - r / R), in [0, 1]; the paper's 1/10
  double laplacian = 0.1;  ///< keeps -Laplacian >= laplacian * -Laplacian_strongest, in [0, 1]; the paper's 1/10

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// A bin higher than all its neighbors.
struct LocalMaximum {
  PlaneGrid::Bin bin;     ///< bin whose value is the greatest among its neighbors
  ReflectionPlane plane;  ///< at the bin center, input frame
  double value;           ///< D at the bin
};

/// Local maxima of the map that pass the thresholds (Section 4.4).
///
/// r is the distance of the plane from the center of mass, R the radius of the grid. The discrete Laplacian is the sum
/// of the second differences along theta, phi and r in steps of the grid. A maximum on a seam of the grid is found
/// once.
/// \param map may be empty.
/// \param num_threads 0 = one per core; the maxima do not depend on it.
/// \return strongest first.
/// \throws std::invalid_argument for bad options.
std::vector<LocalMaximum> findLocalMaxima(const SymmetryMap& map, const LocalMaximaOptions& options = {},
                                          int num_threads = 0);

}  // namespace pcl_symmetry
