#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "core/registration/posed_surface.h"
#include "pcl_symmetry/core/symmetry_frame.h"
#include "pcl_symmetry/symmetry_registration.h"

namespace pcl_symmetry {

/// The data of one cloud for pose searches. Each part is computed on first use, and kept as long as the unit stays the
/// same.
class PreparedCloud {
public:
  /// \param name name of the cloud in messages.
  /// \param points 3 x N, finite, input units; stray ones are left out.
  /// \param seen what the scanner saw of them, input frame.
  /// \param options frame, seed and num_threads are used.
  /// \throws std::invalid_argument for points without extent.
  PreparedCloud(const std::string& name, const Points& points, const std::optional<Visibility>& seen,
                const CloudRegistrationOptions& options);

  const BoundingBall& ball() const { return ball_; }
  bool isScan() const { return seen_.has_value(); }

  /// The surface about the center of the ball, like all parts.
  /// \param unit unit of its coordinates, input units, > 0.
  std::shared_ptr<const PosedSurface> surface(double unit) const;
  std::shared_ptr<const SymmetryFrame> frame(double unit) const;
  Eigen::Index size() const { return points_.cols(); }

private:
  const Points points_;
  const std::optional<Visibility> seen_;
  const CloudRegistrationOptions options_;
  const BoundingBall ball_;
  mutable std::mutex mutex_;  // guards the following members
  mutable double unit_ = 0.0;
  mutable std::shared_ptr<const PosedSurface> surface_;
  mutable std::shared_ptr<const SymmetryFrame> frame_;

  /// The mutex must be held.
  const std::shared_ptr<const PosedSurface>& surfaceIn(double unit) const;
};

}  // namespace pcl_symmetry
