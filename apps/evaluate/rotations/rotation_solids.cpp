#include "evaluate/rotations/rotation_solids.h"

#include <cmath>

#include "common/scanner/random_numbers.h"
#include "core/base/constants.h"
#include "core/base/random.h"
#include "core/geometry/mesh_sampling.h"
#include "core/neighbours/diameter.h"
#include "evaluate/rotations/solid_builder.h"

namespace pcl_symmetry::apps {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// All lengths below are the looks of the bodies. chosen: features clearly beyond the default limits, or clearly not.
constexpr int kRoundCorners = 96;  // corners of a round outline. chosen: half shows them, twice adds faces

Matrix3d aboutZ(double angle) {
  return Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
}

/// A regular polygon with points along its edges, so that a bore in it is round.
Outline polygon(int sides, double radius, double turn = 0.0) {
  const int steps = std::max(1, kRoundCorners / sides);
  Outline outline;
  for (int k = 0; k < sides; ++k) {
    const double a = turn + 2.0 * kPi * k / sides, b = a + 2.0 * kPi / sides;
    const Vector2d from = radius * Vector2d(std::cos(a), std::sin(a)), to = radius * Vector2d(std::cos(b), std::sin(b));
    for (int i = 0; i < steps; ++i) outline.push_back(from + (to - from) * i / steps);
  }
  return outline;
}

Outline gearOutline(int teeth, double root) {
  Outline outline;
  const double pitch = 2.0 * kPi / teeth;
  const double places[] = {0.0, 0.15, 0.35, 0.5};
  const double radii[] = {root, 1.0, 1.0, root};
  for (int k = 0; k < teeth; ++k)
    for (int i = 0; i < 4; ++i) {
      const double angle = pitch * (k + places[i]);
      outline.emplace_back(radii[i] * std::cos(angle), radii[i] * std::sin(angle));
    }
  return outline;
}

/// A circle with a slot at angle 0.
Outline slottedCircle(double radius, double half_width, double depth) {
  Outline outline;
  const double gap = std::asin(half_width / radius);
  for (int k = 0; k <= kRoundCorners; ++k) {
    const double angle = gap + (2.0 * kPi - 2.0 * gap) * k / kRoundCorners;
    outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  outline.emplace_back(radius - depth, -half_width);
  outline.emplace_back(radius - depth, half_width);
  return outline;
}

/// A quarter circle from the pole below to the equator.
Outline bowlProfile(double outer, double inner) {
  constexpr int kSteps = 24;  // chosen: half shows edges, twice adds faces
  Outline profile;
  for (int k = 0; k <= kSteps; ++k) {
    const double angle = 0.5 * kPi * k / kSteps;
    profile.emplace_back(outer * std::sin(angle), -outer * std::cos(angle));
  }
  for (int k = kSteps; k >= 0; --k) {
    const double angle = 0.5 * kPi * k / kSteps;
    profile.emplace_back(inner * std::sin(angle), -inner * std::cos(angle));
  }
  return profile;
}

Outline ballProfile() {
  Outline profile;
  for (int k = 0; k <= 48; ++k) profile.emplace_back(std::sin(kPi * k / 48), -std::cos(kPi * k / 48));
  return profile;
}

/// Collects bodies of one half.
class SolidList {
public:
  template <typename Build>
  void add(const std::string& name, const std::string& kind, const std::string& group, const Build& build) {
    solids_.push_back({name, kind, chosen_on, group});
    SolidBuilder builder(solids_.back());
    build(builder);
  }
  bool chosen_on = true;
  std::vector<RotationSolid> solids_;
};

void addBowls(SolidList& list) {
  list.add("bowl", "bowls", "Cinf", [](SolidBuilder& b) { b.turned(bowlProfile(1.0, 0.92)); });
  list.add("dish", "bowls", "Cinf", [](SolidBuilder& b) {
    b.turned({{0, 0}, {0.6, 0}, {1.0, 0.25}, {1.0, 0.31}, {0.58, 0.07}, {0, 0.07}});
  });
  list.add("bowl on a foot", "bowls", "Cinf", [](SolidBuilder& b) {
    b.turned(bowlProfile(1.0, 0.9)).turned({{0.0, -1.2}, {0.5, -1.2}, {0.45, -0.89}});
  });
}

void addRims(SolidList& list) {
  for (int n = 3; n <= 8; ++n) {
    const bool one_sided = n % 2 == 1;
    list.add("rim of " + std::to_string(n) + (one_sided ? " spokes on one side" : " spokes"), "rims",
             (one_sided ? "C" : "D") + std::to_string(n), [=](SolidBuilder& b) {
               const double z = one_sided ? 0.15 : 0.0;
               b.turned({{0.8, -0.2}, {1.0, -0.2}, {1.0, 0.2}, {0.8, 0.2}, {0.8, -0.2}});
               b.turned({{0.0, z - 0.1}, {0.2, z - 0.1}, {0.2, z + 0.1}, {0.0, z + 0.1}});
               for (int k = 0; k < n; ++k) b.box({0.5, 0, z}, {0.32, 0.09, 0.04}, aboutZ(2.0 * kPi * k / n));
             });
  }
}

void addBoxes(SolidList& list) {
  list.add("brick", "boxes", "D2", [](SolidBuilder& b) { b.box({0, 0, 0}, {1.0, 0.6, 0.35}); });
  list.add("tile", "boxes", "D4", [](SolidBuilder& b) { b.box({0, 0, 0}, {1.0, 1.0, 0.12}); });
  list.add("cube", "boxes", "O", [](SolidBuilder& b) { b.box({0, 0, 0}, {1.0, 1.0, 1.0}); });
  const auto tray = [](double x, double y) {
    return [=](SolidBuilder& b) {
      b.box({0, 0, 0}, {x, y, 0.05});
      for (const double side : {-1.0, 1.0}) {
        b.box({side * (x - 0.05), 0, 0.3}, {0.05, y, 0.25});
        b.box({0, side * (y - 0.05), 0.3}, {x - 0.1, 0.05, 0.25});
      }
    };
  };
  list.add("tray", "boxes", "C2", tray(1.0, 0.6));
  list.add("square tray", "boxes", "C4", tray(1.0, 1.0));
}

void addNuts(SolidList& list) {
  list.add("hexagonal nut", "nuts", "D6", [](SolidBuilder& b) { b.swept(polygon(6, 1.0), -0.4, 0.4, 0.5); });
  list.add("square nut", "nuts", "D4", [](SolidBuilder& b) { b.swept(polygon(4, 1.0), -0.3, 0.3, 0.35); });
  list.add("bolt", "nuts", "C6", [](SolidBuilder& b) {
    b.swept(polygon(6, 1.0), -0.35, 0.35).turned({{0.5, 0.35}, {0.5, 2.0}, {0.0, 2.0}});
  });
}

void addMugs(SolidList& list) {
  const Outline cup{{0, 0}, {1, 0}, {1, 2.2}, {0.9, 2.2}, {0.9, 0.12}, {0, 0.12}};
  list.add("mug", "mugs", "C1", [=](SolidBuilder& b) { b.turned(cup).handle({0.95, 0, 1.1}, 0.75, 0.75, 0.12); });
  list.add("cup of two handles", "mugs", "C2", [=](SolidBuilder& b) {
    for (const double turn : {0.0, kPi}) b.handle({0.95, 0, 1.1}, 0.75, 0.75, 0.12, turn);
    b.turned(cup);
  });
}

void addKeyways(SolidList& list) {
  list.add("shaft with a keyway", "keyways", "Dinf",
           [](SolidBuilder& b) { b.swept(slottedCircle(1.0, 0.1, 0.1), -2.0, 2.0); });
  list.add("wheel with a set screw", "keyways", "Cinf", [](SolidBuilder& b) {
    b.turned({{0.2, -0.3}, {1.0, -0.3}, {0.85, 0.0}, {1.0, 0.3}, {0.5, 0.3}, {0.5, 0.8}, {0.2, 0.8}, {0.2, -0.3}});
    b.box({0.5, 0, 0.55}, {0.06, 0.08, 0.08});
  });
  list.add("can with a notch", "keyways", "Cinf", [](SolidBuilder& b) {
    b.turned({{0.0, -1.0}, {1.0, -1.0}, {1.0, 0.6}, {0.7, 0.8}, {0.7, 1.1}, {0.0, 1.1}});
    b.box({1.0, 0, 0.2}, {0.05, 0.12, 0.2});
  });
}

/// Bodies that are round up to less than the default tolerance.
void addNearlyRound(SolidList& list) {
  const auto wobbly = [](double amplitude) {
    return [=](const Vector3d& x) -> Vector3d {
      const double angle = std::atan2(x.y(), x.x());
      const double wave = std::sin(2 * angle) + 0.7 * std::cos(3 * angle + 1) + 0.5 * std::sin(5 * angle + x.z());
      return {x.x() * (1 + amplitude * wave), x.y() * (1 + amplitude * wave), x.z()};
    };
  };
  list.add("beaten bowl", "nearly round", "Cinf",
           [=](SolidBuilder& b) { b.turned(bowlProfile(1.0, 0.9)).bent(wobbly(0.005)); });
  list.add("beaten can", "nearly round", "Dinf", [=](SolidBuilder& b) {
    b.turned({{0, -1.2}, {1, -1.2}, {1, -0.6}, {1, 0}, {1, 0.6}, {1, 1.2}, {0, 1.2}}).bent(wobbly(0.006));
  });
}

void addCups(SolidList& list) {
  list.add("beaker", "cups", "Cinf", [](SolidBuilder& b) {
    b.turned({{0, 0}, {0.8, 0}, {0.8, 2.0}, {0.73, 2.0}, {0.73, 0.08}, {0, 0.08}});
  });
  list.add("conical cup", "cups", "Cinf", [](SolidBuilder& b) { b.turned({{0, 0}, {0.5, 0}, {0.9, 1.5}}); });
  list.add("goblet", "cups", "Cinf", [](SolidBuilder& b) {
    b.turned(
        {{0, 0}, {0.6, 0}, {0.08, 0.1}, {0.08, 0.9}, {0.6, 1.2}, {0.7, 2.0}, {0.64, 2.0}, {0.55, 1.25}, {0, 0.98}});
  });
}

void addGears(SolidList& list) {
  for (const int n : {8, 12, 24})
    list.add("gear of " + std::to_string(n) + " teeth", "gears", "D" + std::to_string(n),
             [=](SolidBuilder& b) { b.swept(gearOutline(n, n < 20 ? 0.8 : 0.86), -0.2, 0.2, 0.3); });
  for (const int n : {10, 16})
    list.add("gear of " + std::to_string(n) + " teeth on a hub", "gears", "C" + std::to_string(n),
             [=](SolidBuilder& b) {
               b.swept(gearOutline(n, 0.82), -0.2, 0.2, 0.3).turned({{0.3, 0.7}, {0.5, 0.7}, {0.5, 0.2}});
             });
}

void addPrisms(SolidList& list) {
  for (const int n : {3, 5, 6, 8})
    list.add("prism of " + std::to_string(n) + " sides", "prisms", "D" + std::to_string(n),
             [=](SolidBuilder& b) { b.swept(polygon(n, 1.0), -0.9, 0.9); });
  list.add("pyramid", "prisms", "C4", [](SolidBuilder& b) {
    b.hull({{1, 1, -0.5}, {1, -1, -0.5}, {-1, 1, -0.5}, {-1, -1, -0.5}, {0, 0, 1.0}});
  });
}

void addPolyhedra(SolidList& list) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  std::vector<Vector3d> octahedron, icosahedron, dodecahedron;
  for (const double a : {-1.0, 1.0})
    for (int k = 0; k < 3; ++k) {
      octahedron.push_back(a * Vector3d::Unit(k));
      for (const double b : {-1.0, 1.0}) {
        const auto cyclic = [&](double y, double z) {
          Vector3d corner = Vector3d::Zero();
          corner[(k + 1) % 3] = y;
          corner[(k + 2) % 3] = z;
          return corner;
        };
        icosahedron.push_back(cyclic(a, b * g));
        dodecahedron.push_back(cyclic(a / g, b * g));
        if (k < 2) dodecahedron.push_back({a, b, k == 0 ? -1.0 : 1.0});
      }
    }
  list.add("tetrahedron", "polyhedra", "T", [](SolidBuilder& b) {
    b.hull({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}});
  });
  list.add("octahedron", "polyhedra", "O", [&](SolidBuilder& b) { b.hull(octahedron); });
  list.add("icosahedron", "polyhedra", "I", [&](SolidBuilder& b) { b.hull(icosahedron); });
  list.add("dodecahedron", "polyhedra", "I", [&](SolidBuilder& b) { b.hull(dodecahedron); });
}

void addRoundBodies(SolidList& list) {
  const auto stretched = [](double x, double y, double z) {
    return [=](SolidBuilder& b) {
      b.turned(ballProfile()).bent([=](const Vector3d& p) -> Vector3d { return p.cwiseProduct(Vector3d(x, y, z)); });
    };
  };
  list.add("ball", "balls", "SO3", stretched(1, 1, 1));
  list.add("ball with a valve", "balls", "SO3", [](SolidBuilder& b) {
    b.turned(ballProfile()).turned({{0.08, 0.95}, {0.08, 1.05}, {0, 1.05}});
  });
  list.add("long ellipsoid", "ellipsoids", "Dinf", stretched(0.7, 0.7, 1.2));
  list.add("flat ellipsoid", "ellipsoids", "Dinf", stretched(1, 1, 0.6));
  list.add("ellipsoid of three axes", "ellipsoids", "D2", stretched(1.2, 0.85, 0.6));
  list.add("egg", "ellipsoids", "Cinf", [](SolidBuilder& b) {
    b.turned(ballProfile()).bent([](const Vector3d& p) -> Vector3d {
      return {p.x() * (1 - 0.25 * p.z()), p.y() * (1 - 0.25 * p.z()), 1.3 * p.z()};
    });
  });
}

void addBladed(SolidList& list) {
  list.add("key", "blades", "C1", [](SolidBuilder& b) {
    b.swept(polygon(24, 0.5), -0.05, 0.05, 0.2).box({1.3, 0, 0}, {0.85, 0.12, 0.05});
    b.box({1.4, 0.3, 0}, {0.12, 0.2, 0.05}).box({1.95, 0.4, 0}, {0.15, 0.3, 0.05});
  });
  list.add("propeller", "blades", "C3", [](SolidBuilder& b) {
    const Matrix3d pitch = Eigen::AngleAxisd(0.6, Vector3d::UnitX()).toRotationMatrix();
    for (int k = 0; k < 3; ++k) b.box({0.6, 0, 0}, {0.45, 0.2, 0.03}, aboutZ(2.0 * kPi * k / 3) * pitch);
    b.turned({{0, -0.1}, {0.16, -0.1}, {0.16, 0.5}, {0, 0.5}});
  });
}

}  // namespace

Points RotationSolid::sampled(int num_points, std::uint64_t seed, double noise) const {
  Points corners(3, static_cast<Eigen::Index>(vertices.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i)
    corners.col(static_cast<Eigen::Index>(i)) = vertices[i].cast<float>();
  const double sigma = noise * farthestPair(corners);
  Points points = sampleTriangles(corners, triangles, num_points, seed);
  RandomStream random(seed, 1);
  const Eigen::Quaterniond turn(standardNormal(random), standardNormal(random), standardNormal(random),
                                standardNormal(random));
  const Eigen::Matrix3d rotation = turn.normalized().toRotationMatrix();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    Vector3d x = rotation * points.col(i).cast<double>();
    if (sigma > 0.0)
      for (int k = 0; k < 3; ++k) x[k] += sigma * standardNormal(random);
    points.col(i) = x.cast<float>();
  }
  return points;
}

std::vector<RotationSolid> rotationSolids() {
  SolidList list;
  for (const auto& add : {addBowls, addRims, addBoxes, addNuts, addMugs, addKeyways, addNearlyRound}) add(list);
  list.chosen_on = false;
  for (const auto& add : {addCups, addGears, addPrisms, addPolyhedra, addRoundBodies, addBladed}) add(list);
  return std::move(list.solids_);
}

}  // namespace pcl_symmetry::apps
