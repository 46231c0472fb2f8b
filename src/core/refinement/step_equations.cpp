#include "core/refinement/step_equations.h"

#include <cmath>

#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

/// What the terms of a block depend on beside its pairs.
struct StepFrame {
  double n[3], u[3], v[3], middle[3];
  double extent, offset;
};

/// Slope and value of the residual of each pair of a block, and its weight.
struct StepTerms {
  PairBlock::Coordinates slopes;
  double residuals[PairBlock::kMost], weights[PairBlock::kMost];
};

StepFrame frameOf(const StepEquations& equations) {
  StepFrame frame{{}, {}, {}, {}, equations.extent, equations.offset};
  for (int k = 0; k < 3; ++k) {
    frame.n[k] = equations.n[k];
    frame.u[k] = equations.u[k];
    frame.v[k] = equations.v[k];
    frame.middle[k] = equations.middle[k];
  }
  return frame;
}

PCL_SYMMETRY_MULTIVERSION
void pointToPlaneTerms(const PairBlock& pairs, const StepFrame& frame, StepTerms& terms) {
  const double n0 = frame.n[0], n1 = frame.n[1], n2 = frame.n[2];
  const double u0 = frame.u[0], u1 = frame.u[1], u2 = frame.u[2];
  const double v0 = frame.v[0], v1 = frame.v[1], v2 = frame.v[2];
  const double c0 = frame.middle[0], c1 = frame.middle[1], c2 = frame.middle[2];
  const double offset = frame.offset, twice_extent = 2.0 * frame.extent;
#pragma GCC ivdep
  for (int i = 0; i < pairs.size; ++i) {
    const double p0 = pairs.x[0][i] - c0, p1 = pairs.x[1][i] - c1, p2 = pairs.x[2][i] - c2;
    const double q0 = pairs.y[0][i] - c0, q1 = pairs.y[1][i] - c1, q2 = pairs.y[2][i] - c2;
    const double a0 = pairs.x_normals[0][i], a1 = pairs.x_normals[1][i], a2 = pairs.x_normals[2][i];
    const double b0 = pairs.y_normals[0][i], b1 = pairs.y_normals[1][i], b2 = pairs.y_normals[2][i];
    const double height = n0 * p0 + n1 * p1 + n2 * p2 - offset;
    const double twice_a = 2.0 * (n0 * a0 + n1 * a1 + n2 * a2);
    const double t0 = a0 - twice_a * n0, t1 = a1 - twice_a * n1, t2 = a2 - twice_a * n2;
    const double cosine = t0 * b0 + t1 * b1 + t2 * b2;
    const double s0 = b0 + (cosine < 0.0 ? -t0 : t0), s1 = b1 + (cosine < 0.0 ? -t1 : t1),
                 s2 = b2 + (cosine < 0.0 ? -t2 : t2);
    const double sq_length = s0 * s0 + s1 * s1 + s2 * s2;
    const double length = sq_length > 0.0 ? std::sqrt(sq_length) : 1.0;
    const double m0 = s0 / length, m1 = s1 / length, m2 = s2 / length;
    const double m_n = m0 * n0 + m1 * n1 + m2 * n2;
    const double m_u = m0 * u0 + m1 * u1 + m2 * u2, m_v = m0 * v0 + m1 * v1 + m2 * v2;
    const double u_p = u0 * p0 + u1 * p1 + u2 * p2, v_p = v0 * p0 + v1 * p1 + v2 * p2;
    const double twice_height = 2.0 * height;
    terms.slopes[0][i] = -2.0 * (u_p * m_n + height * m_u);
    terms.slopes[1][i] = -2.0 * (v_p * m_n + height * m_v);
    terms.slopes[2][i] = twice_extent * m_n;
    terms.residuals[i] =
        m0 * (p0 - twice_height * n0 - q0) + m1 * (p1 - twice_height * n1 - q1) + m2 * (p2 - twice_height * n2 - q2);
    terms.weights[i] = pairs.weights[i] * cosine * cosine;
  }
}

}  // namespace

StepEquations::StepEquations(const ReflectionPlane& plane, const Eigen::Vector3d& middle_of_samples,
                             double extent_of_samples)
    : n(plane.normal()),
      u(n.unitOrthogonal()),
      v(n.cross(u)),
      middle(middle_of_samples),
      extent(extent_of_samples),
      offset(plane.offset() - n.dot(middle)) {}

void StepEquations::addPointToPlane(const PairBlock& pairs) {
  StepTerms terms;
  pointToPlaneTerms(pairs, frameOf(*this), terms);
  double h00 = h(0, 0), h10 = h(1, 0), h20 = h(2, 0), h11 = h(1, 1), h21 = h(2, 1), h22 = h(2, 2);
  double g0 = g[0], g1 = g[1], g2 = g[2];
  for (int i = 0; i < pairs.size; ++i) {
    const double s0 = terms.slopes[0][i], s1 = terms.slopes[1][i], s2 = terms.slopes[2][i];
    const double weight = terms.weights[i], residual = weight * terms.residuals[i];
    const double w0 = weight * s0, w1 = weight * s1;
    h00 += w0 * s0;
    h10 += w0 * s1;
    h20 += w0 * s2;
    h11 += w1 * s1;
    h21 += w1 * s2;
    h22 += weight * s2 * s2;
    g0 += residual * s0;
    g1 += residual * s1;
    g2 += residual * s2;
  }
  h(0, 0) = h00;
  h(1, 0) = h10;
  h(2, 0) = h20;
  h(1, 1) = h11;
  h(2, 1) = h21;
  h(2, 2) = h22;
  g = {g0, g1, g2};
}

void StepEquations::addPointToPoint(const PairBlock& pairs) {
  for (int i = 0; i < pairs.size; ++i) {
    const Eigen::Vector3d p = Eigen::Vector3d(pairs.x[0][i], pairs.x[1][i], pairs.x[2][i]) - middle;
    const Eigen::Vector3d q = Eigen::Vector3d(pairs.y[0][i], pairs.y[1][i], pairs.y[2][i]) - middle;
    const double height = n.dot(p) - offset, weight = pairs.weights[i];
    Eigen::Matrix3d slopes;  // of the reflected point
    slopes.col(0) = -2.0 * (u.dot(p) * n + height * u);
    slopes.col(1) = -2.0 * (v.dot(p) * n + height * v);
    slopes.col(2) = 2.0 * extent * n;
    h += weight * slopes.transpose() * slopes;
    g += weight * slopes.transpose() * (p - 2.0 * height * n - q);
  }
}

ReflectionPlane StepEquations::moved(const Eigen::Vector3d& step) const {
  const Eigen::Vector3d normal = (n + step[0] * u + step[1] * v).normalized();
  return ReflectionPlane(normal, normal.dot(middle) + offset + step[2] * extent);
}

}  // namespace pcl_symmetry
