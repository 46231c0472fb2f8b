#include "core/detection/step_equations.h"

#include <algorithm>
#include <cmath>

#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

/// What the terms of a block depend on beside its pairs.
struct StepFrame {
  double n[3], u[3], v[3], middle[3];
  double extent, offset;
};

/// Places of the sums, the matrix column by column.
enum Sum { kH00, kH10, kH20, kH01, kH11, kH21, kH02, kH12, kH22, kG0, kG1, kG2 };

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
void pointToPlaneTerms(const PairBlock& pairs, const StepFrame& frame, double (*terms)[PairBlock::kMost]) {
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
    const double g0 = -2.0 * (u_p * m_n + height * m_u), g1 = -2.0 * (v_p * m_n + height * m_v),
                 g2 = twice_extent * m_n;
    const double weight = pairs.weights[i] * cosine * cosine;
    const double residual = weight * (m0 * (p0 - twice_height * n0 - q0) + m1 * (p1 - twice_height * n1 - q1) +
                                      m2 * (p2 - twice_height * n2 - q2));
    const double w0 = weight * g0, w1 = weight * g1;
    terms[kH00][i] = w0 * g0;
    terms[kH10][i] = w0 * g1;
    terms[kH20][i] = w0 * g2;
    terms[kH11][i] = w1 * g1;
    terms[kH21][i] = w1 * g2;
    terms[kH22][i] = weight * g2 * g2;
    terms[kG0][i] = residual * g0;
    terms[kG1][i] = residual * g1;
    terms[kG2][i] = residual * g2;
    terms[kH01][i] = terms[kH02][i] = terms[kH12][i] = 0.0;
  }
}

PCL_SYMMETRY_MULTIVERSION
void pointToPointTerms(const PairBlock& pairs, const StepFrame& frame, double (*terms)[PairBlock::kMost]) {
  const double n0 = frame.n[0], n1 = frame.n[1], n2 = frame.n[2];
  const double u0 = frame.u[0], u1 = frame.u[1], u2 = frame.u[2];
  const double v0 = frame.v[0], v1 = frame.v[1], v2 = frame.v[2];
  const double c0 = frame.middle[0], c1 = frame.middle[1], c2 = frame.middle[2];
  const double offset = frame.offset, twice_extent = 2.0 * frame.extent;
  const double w0 = twice_extent * n0, w1 = twice_extent * n1, w2 = twice_extent * n2;
#pragma GCC ivdep
  for (int i = 0; i < pairs.size; ++i) {
    const double p0 = pairs.x[0][i] - c0, p1 = pairs.x[1][i] - c1, p2 = pairs.x[2][i] - c2;
    const double q0 = pairs.y[0][i] - c0, q1 = pairs.y[1][i] - c1, q2 = pairs.y[2][i] - c2;
    const double height = n0 * p0 + n1 * p1 + n2 * p2 - offset, weight = pairs.weights[i];
    const double u_p = u0 * p0 + u1 * p1 + u2 * p2, v_p = v0 * p0 + v1 * p1 + v2 * p2;
    // Slopes of the reflected point: a column for each unknown, the last one is w.
    const double a0 = -2.0 * (u_p * n0 + height * u0), a1 = -2.0 * (u_p * n1 + height * u1),
                 a2 = -2.0 * (u_p * n2 + height * u2);
    const double b0 = -2.0 * (v_p * n0 + height * v0), b1 = -2.0 * (v_p * n1 + height * v1),
                 b2 = -2.0 * (v_p * n2 + height * v2);
    const double d0 = p0 - 2.0 * height * n0 - q0, d1 = p1 - 2.0 * height * n1 - q1, d2 = p2 - 2.0 * height * n2 - q2;
    const double wa0 = weight * a0, wa1 = weight * a1, wa2 = weight * a2;
    const double wb0 = weight * b0, wb1 = weight * b1, wb2 = weight * b2;
    const double ww0 = weight * w0, ww1 = weight * w1, ww2 = weight * w2;
    terms[kH00][i] = wa0 * a0 + wa1 * a1 + wa2 * a2;
    terms[kH10][i] = wb0 * a0 + wb1 * a1 + wb2 * a2;
    terms[kH20][i] = ww0 * a0 + ww1 * a1 + ww2 * a2;
    terms[kH01][i] = wa0 * b0 + wa1 * b1 + wa2 * b2;
    terms[kH11][i] = wb0 * b0 + wb1 * b1 + wb2 * b2;
    terms[kH21][i] = ww0 * b0 + ww1 * b1 + ww2 * b2;
    terms[kH02][i] = wa0 * w0 + wa1 * w1 + wa2 * w2;
    terms[kH12][i] = wb0 * w0 + wb1 * w1 + wb2 * w2;
    terms[kH22][i] = ww0 * w0 + ww1 * w1 + ww2 * w2;
    terms[kG0][i] = wa0 * d0 + wa1 * d1 + wa2 * d2;
    terms[kG1][i] = wb0 * d0 + wb1 * d1 + wb2 * d2;
    terms[kG2][i] = ww0 * d0 + ww1 * d1 + ww2 * d2;
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

void StepEquations::pointToPlane(const PairBlock& pairs, StepTerms& terms) const {
  terms.size = pairs.size;
  pointToPlaneTerms(pairs, frameOf(*this), terms.values);
}

void StepEquations::pointToPoint(const PairBlock& pairs, StepTerms& terms) const {
  terms.size = pairs.size;
  pointToPointTerms(pairs, frameOf(*this), terms.values);
}

void StepEquations::add(const StepTerms& terms) {
  double sums[StepTerms::kSums];
  std::copy_n(h.data(), 9, sums);
  std::copy_n(g.data(), 3, sums + kG0);
  for (int i = 0; i < terms.size; ++i)
    for (int k = 0; k < StepTerms::kSums; ++k) sums[k] += terms.values[k][i];
  std::copy_n(sums, 9, h.data());
  std::copy_n(sums + kG0, 3, g.data());
}

ReflectionPlane StepEquations::moved(const Eigen::Vector3d& step) const {
  const Eigen::Vector3d normal = (n + step[0] * u + step[1] * v).normalized();
  return ReflectionPlane(normal, normal.dot(middle) + offset + step[2] * extent);
}

}  // namespace pcl_symmetry
