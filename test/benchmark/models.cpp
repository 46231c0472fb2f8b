#include "models.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

#include "core/base/constants.h"
#include "core/geometry/triangles.h"

namespace pcl_symmetry::benchmarks {

namespace {

/// A closed surface given by its radius in each direction, as a mesh of latitudes and longitudes.
Model starShape(const std::string& name, const std::function<double(const Eigen::Vector3d&)>& radius) {
  constexpr int kRows = 120, kColumns = 240;
  const Eigen::AngleAxisd tilt(0.7, Eigen::Vector3d(1.0, 2.0, -0.5).normalized());
  Model model{name, Points(3, (kRows + 1) * kColumns), {}};
  for (int r = 0; r <= kRows; ++r) {
    for (int c = 0; c < kColumns; ++c) {
      const double theta = kPi * r / kRows, phi = 2.0 * kPi * c / kColumns;
      const Eigen::Vector3d n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      model.vertices.col(r * kColumns + c) = (radius(tilt * n) * n).cast<float>();
      if (r == kRows) continue;
      const int a = r * kColumns + c, b = r * kColumns + (c + 1) % kColumns;
      model.triangles.emplace_back(a, b, b + kColumns);
      model.triangles.emplace_back(a, b + kColumns, a + kColumns);
    }
  }
  return model;
}

std::vector<Model> syntheticModels() {
  const auto bump = [](const Eigen::Vector3d& n, double x, double y, double z, double height) {
    return height * std::exp(8.0 * (n.dot(Eigen::Vector3d(x, y, z).normalized()) - 1.0));
  };
  return {starShape("box",
                    [](const Eigen::Vector3d& n) {
                      return 1.0 / (n.cwiseAbs().array() / Eigen::Array3d(1.0, 0.7, 0.45)).maxCoeff();
                    }),
          starShape("animal",
                    [&](const Eigen::Vector3d& n) {
                      double r = 0.5 + bump(n, 1.0, 0.0, 0.3, 0.5);
                      for (const double side : {-1.0, 1.0})
                        r += bump(n, 0.6, side * 0.5, -1.0, 0.6) + bump(n, -0.6, side * 0.5, -1.0, 0.6) +
                             bump(n, 1.0, side * 0.3, 0.6, 0.3);
                      return r;
                    }),
          starShape("ellipsoid",
                    [](const Eigen::Vector3d& n) {
                      return 1.0 / (n.array() / Eigen::Array3d(1.0, 0.6, 0.4)).matrix().norm();
                    }),
          starShape("star",
                    [](const Eigen::Vector3d& n) {
                      return 0.6 + 0.3 * std::hypot(n.x(), n.y()) * std::cos(5.0 * std::atan2(n.y(), n.x()));
                    }),
          starShape("blob", [&](const Eigen::Vector3d& n) {
            return 1.0 + bump(n, 1.0, 0.1, 0.2, 0.9) + bump(n, -0.3, 1.0, 0.1, 0.5) + bump(n, 0.2, -0.4, 1.0, 0.7) +
                   bump(n, -0.8, -0.5, -0.4, 0.35);
          })};
}

Model readOff(const std::string& folder, const std::string& name) {
  const std::string file = folder + "/" + name + ".off";
  std::ifstream in(file);
  std::string magic;
  int num_vertices = 0, num_faces = 0, num_edges = 0;
  in >> magic >> num_vertices >> num_faces >> num_edges;
  if (!in || magic != "OFF" || num_vertices < 3) throw std::runtime_error(file + ": cannot be read as OFF");
  Model model{name, Points(3, num_vertices), {}};
  for (float& coordinate : model.vertices.reshaped()) in >> coordinate;
  for (int f = 0; f < num_faces && in; ++f) {
    int size = 0, first = 0, last = 0;
    in >> size >> first >> last;
    for (int k = 2, next = 0; k < size && in >> next; ++k) {
      model.triangles.emplace_back(first, last, next);
      last = next;
    }
    in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');  // a color
  }
  if (static_cast<int>(model.triangles.size()) < num_faces) throw std::runtime_error(file + ": ends early");
  return model;
}

}  // namespace

Points Model::sample(int num_points) const {
  return sampleTriangles(vertices, triangles, num_points, 7);
}

Points Model::scan(int num_points, const Eigen::Vector3d& viewpoint) const {
  constexpr double kPixels = 350.0;  // for a slope of 1: leaves 6000 points of 40 000
  const Points points = sample(num_points);
  const Eigen::Vector3d ahead = (centerOfMass(points) - viewpoint).normalized();
  const Eigen::Vector3d u = ahead.unitOrthogonal(), v = ahead.cross(u);
  std::map<std::pair<int, int>, std::pair<double, Eigen::Index>> nearest;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d x = points.col(i).cast<double>() - viewpoint;
    const double depth = x.dot(ahead);
    const std::pair pixel(static_cast<int>(std::floor(kPixels * x.dot(u) / depth)),
                          static_cast<int>(std::floor(kPixels * x.dot(v) / depth)));
    const auto seen = nearest.try_emplace(pixel, depth, i).first;
    if (depth < seen->second.first) seen->second = {depth, i};
  }
  Points seen(3, static_cast<Eigen::Index>(nearest.size()));
  Eigen::Index k = 0;
  for (const auto& [pixel, point] : nearest) seen.col(k++) = points.col(point.second);
  return seen;
}

const std::vector<Model>& models() {
  static const std::vector<Model> models = [] {
    const char* folder = std::getenv("PCL_SYMMETRY_MODELS");
    if (!folder) return syntheticModels();
    std::vector<Model> read;
    for (const char* name : {"bull", "cow", "elephant", "hand", "camel"}) read.push_back(readOff(folder, name));
    return read;
  }();
  return models;
}

}  // namespace pcl_symmetry::benchmarks
