/// Text of meshes with known symmetry: what is turned on a lathe, and a tetrahedron that has none.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

/// OFF text of a profile turned about z.
/// \param profile radius and height from end to end.
/// \param num_sides >= 3.
inline std::string latheOFF(const std::vector<std::pair<double, double>>& profile, int num_sides) {
  const auto num_rings = static_cast<int>(profile.size());
  std::string text =
      "OFF\n" + std::to_string(num_rings * num_sides) + " " + std::to_string((num_rings - 1) * num_sides) + " 0\n";
  for (const auto& [radius, height] : profile) {
    for (int k = 0; k < num_sides; ++k) {
      const double angle = 2.0 * M_PI * k / num_sides;
      text += std::to_string(radius * std::cos(angle)) + " " + std::to_string(radius * std::sin(angle)) + " " +
              std::to_string(height) + "\n";
    }
  }
  for (int ring = 0; ring + 1 < num_rings; ++ring) {
    for (int k = 0; k < num_sides; ++k) {
      const int a = ring * num_sides + k, b = ring * num_sides + (k + 1) % num_sides;
      text += "4 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(b + num_sides) + " " +
              std::to_string(a + num_sides) + "\n";
    }
  }
  return text;
}

/// A vase: closed at the bottom, open at the top.
inline std::string vaseOFF() {
  return latheOFF({{0.001, 0}, {0.5, 0}, {0.8, 0.5}, {0.9, 1.0}, {0.7, 1.6}, {0.3, 2.2}, {0.3, 2.5}, {0.45, 2.7}}, 64);
}

inline std::string sphereOFF() {
  std::vector<std::pair<double, double>> profile;
  for (int k = 0; k <= 48; ++k) profile.emplace_back(std::sin(M_PI * k / 48), -std::cos(M_PI * k / 48));
  return latheOFF(profile, 96);
}

/// A box from -1 -y -z to 1 y z.
inline std::string boxOFF(const std::string& y = "1.5", const std::string& z = "2") {
  std::string text = "OFF\n8 6 12\n";
  for (const std::string& at_z : {"-" + z, z})
    text +=
        "-1 -" + y + " " + at_z + "\n1 -" + y + " " + at_z + "\n1 " + y + " " + at_z + "\n-1 " + y + " " + at_z + "\n";
  return text + "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 2 3 7 6\n4 1 2 6 5\n4 3 0 4 7\n";
}

inline std::string tetrahedronOFF() {
  return "OFF\n4 4 6\n0 0 0\n2 0.1 0\n0.4 1.3 0.1\n0.7 0.2 0.9\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
}
