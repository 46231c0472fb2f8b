#include "core/geometry/tangent_planes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

/// Symmetric matrices of three rows, element by element: m00, m10, m20, m11, m21, m22.
using Matrices = float[6][TangentPlanes::most];

/// The steps of Eigen's SelfAdjointEigenSolver::computeDirect(), between which stand an arc tangent, a sine and a
/// cosine.
struct DirectSolutions {
  Matrices scaled;  ///< without their mean eigenvalue, at most 1
  float third_trace[TangentPlanes::most], rho[TangentPlanes::most], root_q[TangentPlanes::most],
      half_b[TangentPlanes::most];
  float cosine[TangentPlanes::most], sine[TangentPlanes::most];
  std::int32_t is_open[TangentPlanes::most];  ///< 1 where two eigenvalues are so close that Eigen goes another way
};

/// Sums over the neighbors of each position, in the order in which they are given, and their covariance.
/// \param points,positions three coordinates each.
PCL_SYMMETRY_MULTIVERSION
void addUp(const float* points, const float* positions, const int* neighbors, int count, int size,
           float (*sums)[TangentPlanes::most], Matrices& m) {
  float *const s0 = sums[0], *const s1 = sums[1], *const s2 = sums[2];
  for (int i = 0; i < size; ++i) {
    s0[i] = s1[i] = s2[i] = 0.0f;
    m[0][i] = m[1][i] = m[2][i] = m[3][i] = m[4][i] = m[5][i] = 0.0f;
  }
  for (int k = 0; k < count; ++k) {
#pragma GCC ivdep
    for (int i = 0; i < size; ++i) {
      const std::int32_t j = 3 * neighbors[i * count + k];
      const float d0 = points[j] - positions[3 * i], d1 = points[j + 1] - positions[3 * i + 1],
                  d2 = points[j + 2] - positions[3 * i + 2];
      s0[i] += d0;
      s1[i] += d1;
      s2[i] += d2;
      m[0][i] += d0 * d0;
      m[1][i] += d1 * d0;
      m[2][i] += d2 * d0;
      m[3][i] += d1 * d1;
      m[4][i] += d2 * d1;
      m[5][i] += d2 * d2;
    }
  }
  const auto number = static_cast<float>(count);
#pragma GCC ivdep
  for (int i = 0; i < size; ++i) {
    m[0][i] -= s0[i] * s0[i] / number;
    m[1][i] -= s1[i] * s0[i] / number;
    m[2][i] -= s2[i] * s0[i] / number;
    m[3][i] -= s1[i] * s1[i] / number;
    m[4][i] -= s2[i] * s1[i] / number;
    m[5][i] -= s2[i] * s2[i] / number;
  }
}

[[gnu::always_inline]] inline float greater(float a, float b) {
  return a < b ? b : a;
}

[[gnu::always_inline]] inline float magnitude(float a) {
  return a < 0.0f ? -a : a;
}

PCL_SYMMETRY_MULTIVERSION
void prepareRoots(const Matrices& m, int size, DirectSolutions& solutions) {
  constexpr float third = 1.0f / 3.0f;  // as Eigen takes it
  Matrices& scaled = solutions.scaled;
  float *const third_trace = solutions.third_trace, *const rho = solutions.rho, *const root_q = solutions.root_q,
               *const halves = solutions.half_b;
#pragma GCC ivdep
  for (int i = 0; i < size; ++i) {
    const float shift = (m[0][i] + (m[3][i] + m[5][i])) / 3.0f;
    float a = m[0][i] - shift, b = m[1][i], c = m[2][i], d = m[3][i] - shift, e = m[4][i], f = m[5][i] - shift;
    const float scale = greater(greater(greater(magnitude(a), magnitude(b)), greater(magnitude(c), magnitude(d))),
                                greater(magnitude(e), magnitude(f)));
    const float by = scale > 0.0f ? scale : 1.0f;
    a /= by;
    b /= by;
    c /= by;
    d /= by;
    e /= by;
    f /= by;
    const float c0 = a * d * f + 2.0f * b * c * e - a * e * e - d * c * c - f * b * b;
    const float c1 = a * d - b * b + a * f - c * c + d * f - e * e;
    const float c2 = a + d + f, c2_third = c2 * third;
    const float a_third = greater((c2 * c2_third - c1) * third, 0.0f);
    const float half_b = 0.5f * (c0 + c2_third * (2.0f * c2_third * c2_third - c1));
    const float q = greater(a_third * a_third * a_third - half_b * half_b, 0.0f);
    scaled[0][i] = a;
    scaled[1][i] = b;
    scaled[2][i] = c;
    scaled[3][i] = d;
    scaled[4][i] = e;
    scaled[5][i] = f;
    third_trace[i] = c2_third;
    rho[i] = std::sqrt(a_third);
    root_q[i] = std::sqrt(q);
    halves[i] = half_b;
  }
}

/// The eigenvectors of the least eigenvalues.
PCL_SYMMETRY_MULTIVERSION
void findLeastAxes(DirectSolutions& solutions, float root_of_3, int size, float (*axes)[TangentPlanes::most]) {
  const Matrices& m = solutions.scaled;
  const float *const third_trace = solutions.third_trace, *const rho = solutions.rho, *const cosine = solutions.cosine,
                     *const sine = solutions.sine;
  std::int32_t* const is_open = solutions.is_open;
#pragma GCC ivdep
  for (int i = 0; i < size; ++i) {
    const float least = third_trace[i] - rho[i] * (cosine[i] + root_of_3 * sine[i]),
                middle = third_trace[i] - rho[i] * (cosine[i] - root_of_3 * sine[i]),
                most = third_trace[i] + 2.0f * rho[i] * cosine[i];
    const float above = most - middle, below = middle - least;
    // Beside the greatest eigenvalue, the two others may be alike.
    // As Eigen compares them.
    constexpr float epsilon = std::numeric_limits<float>::epsilon();
    is_open[i] = (most - least <= epsilon) | ((above > below) & (below <= 2.0f * epsilon * above));
    const float a = m[0][i] - least, b = m[1][i], c = m[2][i], d = m[3][i] - least, e = m[4][i], f = m[5][i] - least;
    const float abs_a = magnitude(a), abs_d = magnitude(d), abs_f = magnitude(f);
    // The column of the greatest element of the diagonal, and the two that follow it.
    const bool second = (abs_d > abs_a) & !(abs_f > abs_d), third = (abs_f > abs_a) & (abs_f > abs_d);
    const float u0 = third ? c : second ? b : a, u1 = third ? e : second ? d : b, u2 = third ? f : second ? e : c;
    const float v0 = third ? a : second ? c : b, v1 = third ? b : second ? e : d, v2 = third ? c : second ? f : e;
    const float w0 = third ? b : second ? a : c, w1 = third ? d : second ? b : e, w2 = third ? e : second ? c : f;
    const float p0 = u1 * v2 - u2 * v1, p1 = u2 * v0 - u0 * v2, p2 = u0 * v1 - u1 * v0;
    const float q0 = u1 * w2 - u2 * w1, q1 = u2 * w0 - u0 * w2, q2 = u0 * w1 - u1 * w0;
    const float sq_p = p0 * p0 + (p1 * p1 + p2 * p2), sq_q = q0 * q0 + (q1 * q1 + q2 * q2);
    const bool first = sq_p > sq_q;
    const float length = std::sqrt(first ? sq_p : sq_q);
    axes[0][i] = (first ? p0 : q0) / length;
    axes[1][i] = (first ? p1 : q1) / length;
    axes[2][i] = (first ? p2 : q2) / length;
  }
}

/// Axes that are no unit vectors are put along z; distances of the neighbors from the planes.
PCL_SYMMETRY_MULTIVERSION
void findRoughness(const Matrices& m, int count, int size, float (*axes)[TangentPlanes::most], float* roughness) {
  const auto number = static_cast<float>(std::max(1, count - 3));
#pragma GCC ivdep
  for (int i = 0; i < size; ++i) {
    const float x = axes[0][i], y = axes[1][i], z = axes[2][i];
    const bool usable = magnitude(x * x + (y * y + z * z) - 1.0f) < 0.1f;  // false where one is no number
    const float a = m[0][i], b = m[1][i], c = m[2][i], d = m[3][i], e = m[4][i], f = m[5][i];
    const float p0 = a * x + (b * y + c * z), p1 = b * x + (d * y + e * z), p2 = c * x + (e * y + f * z);
    const float sq_residual = usable ? x * p0 + (y * p1 + z * p2) : a + (d + f);
    axes[0][i] = usable ? x : 0.0f;
    axes[1][i] = usable ? y : 0.0f;
    axes[2][i] = usable ? z : 1.0f;
    roughness[i] = std::sqrt((sq_residual > 0.0f ? sq_residual : 0.0f) / number);
  }
}

}  // namespace

void TangentPlanes::fit(const Points& points, const PointsRef& positions, const int* neighbors, int count) {
  const auto size = static_cast<int>(positions.cols());
  Matrices covariances;
  addUp(points.data(), positions.data(), neighbors, count, size, offset_sum, covariances);
  DirectSolutions solutions;
  prepareRoots(covariances, size, solutions);
  for (int i = 0; i < size; ++i) {
    const float theta = std::atan2(solutions.root_q[i], solutions.half_b[i]) * (1.0f / 3.0f);
    solutions.cosine[i] = std::cos(theta);
    solutions.sine[i] = std::sin(theta);
  }
  findLeastAxes(solutions, std::sqrt(3.0f), size, normal);
  for (int i = 0; i < size; ++i) {
    if (solutions.is_open[i] == 0) continue;
    Eigen::Matrix3f covariance;
    for (int row = 0, k = 0; row < 3; ++row)
      for (int column = row; column < 3; ++column, ++k)
        covariance(row, column) = covariance(column, row) = covariances[k][i];
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
    solver.computeDirect(covariance);
    for (int k = 0; k < 3; ++k) normal[k][i] = solver.eigenvectors()(k, 0);
  }
  findRoughness(covariances, count, size, normal, roughness);
}

}  // namespace pcl_symmetry
