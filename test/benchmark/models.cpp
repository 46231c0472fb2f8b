#include "models.h"

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

#include "core/geometry/mesh_sampling.h"

namespace pcl_symmetry::benchmarks {

namespace {

/// A closed surface given by its radius in each direction, as a mesh of latitudes and longitudes.
Model starShape(const std::string& name, const std::function<double(const Eigen::Vector3d&)>& radius) {
  constexpr int kRows = 120, kColumns = 240;
  constexpr double kPi = 3.14159265358979323846;
  Model model{name, Points(3, (kRows + 1) * kColumns), {}};
  for (int r = 0; r <= kRows; ++r) {
    for (int c = 0; c < kColumns; ++c) {
      const double theta = kPi * r / kRows, phi = 2.0 * kPi * c / kColumns;
      const Eigen::Vector3d n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      model.vertices.col(r * kColumns + c) = (radius(n) * n).cast<float>();
      if (r == kRows) continue;
      const int a = r * kColumns + c, b = r * kColumns + (c + 1) % kColumns;
      model.triangles.emplace_back(a, b, b + kColumns);
      model.triangles.emplace_back(a, b + kColumns, a + kColumns);
    }
  }
  return model;
}

Eigen::Vector3d tilted(const Eigen::Vector3d& n) {
  return Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()) * n;
}

std::vector<Model> syntheticModels() {
  const auto bump = [](const Eigen::Vector3d& n, double x, double y, double z, double height) {
    return height * std::exp(8.0 * (n.dot(Eigen::Vector3d(x, y, z).normalized()) - 1.0));
  };
  return {starShape("box",
                    [](const Eigen::Vector3d& n) {
                      return 1.0 / (tilted(n).cwiseAbs().array() / Eigen::Array3d(1.0, 0.7, 0.45)).maxCoeff();
                    }),
          starShape("ellipsoid",
                    [](const Eigen::Vector3d& n) {
                      return 1.0 / (tilted(n).array() / Eigen::Array3d(1.0, 0.6, 0.4)).matrix().norm();
                    }),
          starShape("star",
                    [](const Eigen::Vector3d& n) {
                      const Eigen::Vector3d m = tilted(n);
                      return 0.6 + 0.3 * std::hypot(m.x(), m.y()) * std::cos(5.0 * std::atan2(m.y(), m.x()));
                    }),
          starShape("animal",
                    [&](const Eigen::Vector3d& n) {
                      const Eigen::Vector3d m = tilted(n);
                      double r = 0.5;
                      for (const double side : {-1.0, 1.0})
                        r += bump(m, 0.6, side * 0.5, -1.0, 0.6) + bump(m, -0.6, side * 0.5, -1.0, 0.6) +
                             bump(m, 1.0, side * 0.3, 0.6, 0.3);
                      return r + bump(m, 1.0, 0.0, 0.3, 0.5);
                    }),
          starShape("blob", [&](const Eigen::Vector3d& n) {
            return 1.0 + bump(n, 1.0, 0.1, 0.2, 0.9) + bump(n, -0.3, 1.0, 0.1, 0.5) + bump(n, 0.2, -0.4, 1.0, 0.7) +
                   bump(n, -0.8, -0.5, -0.4, 0.35);
          })};
}

/// The nearest point in each pixel.
Points seenFrom(const Points& points, const Eigen::Vector3d& viewpoint) {
  constexpr double kPixels = 350.0;  // for a slope of 1. chosen: leaves 6000 points of 40 000
  const Eigen::Vector3d middle = centerOfMass(points), ahead = (middle - viewpoint).normalized();
  const Eigen::Vector3d u = ahead.unitOrthogonal(), v = ahead.cross(u);
  std::map<std::pair<int, int>, std::pair<double, Eigen::Index>> nearest;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d x = points.col(i).cast<double>() - viewpoint;
    const double depth = x.dot(ahead);
    const std::pair pixel(static_cast<int>(std::floor(kPixels * x.dot(u) / depth)),
                          static_cast<int>(std::floor(kPixels * x.dot(v) / depth)));
    const auto place = nearest.try_emplace(pixel, depth, i).first;
    if (depth < place->second.first) place->second = {depth, i};
  }
  Points seen(3, static_cast<Eigen::Index>(nearest.size()));
  Eigen::Index k = 0;
  for (const auto& [pixel, point] : nearest) seen.col(k++) = points.col(point.second);
  return seen;
}

}  // namespace

Points Model::sample(int num_points) const {
  return sampleTriangles(vertices, triangles, num_points, 7);
}

Scan Model::scan(int num_points) const {
  const Points all = sample(num_points);
  const BoundingBall ball = boundingBall(all);
  const Eigen::Vector3d viewpoint = ball.center + 4.0 * ball.radius * Eigen::Vector3d(0.6, 0.5, 0.62).normalized();
  return {seenFrom(all, viewpoint), viewpoint};
}

Model readOff(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file + ": cannot be read");
  std::string magic;
  int num_vertices = 0, num_faces = 0, num_edges = 0;
  in >> magic >> num_vertices >> num_faces >> num_edges;
  if (!in || magic != "OFF" || num_vertices < 3 || num_faces < 1) throw std::runtime_error(file + ": not an OFF file");
  const auto slash = file.find_last_of('/') + 1;
  Model model{file.substr(slash, file.find_last_of('.') - slash), Points(3, num_vertices), {}};
  for (int i = 0; i < num_vertices; ++i) in >> model.vertices(0, i) >> model.vertices(1, i) >> model.vertices(2, i);
  for (int f = 0; f < num_faces && in; ++f) {
    int size = 0, first = 0, last = 0;
    in >> size >> first >> last;
    for (int k = 2; k < size; ++k) {
      int next = 0;
      in >> next;
      model.triangles.emplace_back(first, last, next);
      last = next;
    }
    in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');  // a color
  }
  if (static_cast<int>(model.triangles.size()) < num_faces) throw std::runtime_error(file + ": ends early");
  return model;
}

std::vector<Model> fiveModels(const std::string& folder) {
  if (folder.empty()) return syntheticModels();
  std::vector<Model> models;
  for (const char* name : {"bull", "cow", "elephant", "hand", "camel"})
    models.push_back(readOff(folder + "/" + name + ".off"));
  return models;
}

}  // namespace pcl_symmetry::benchmarks
