/// A flat strip of squares along x, 1 by 1 each, on which distances between segmentations are known exactly.
#pragma once

#include <sstream>
#include <string>

inline std::string stripOFF(int num_squares) {
  std::ostringstream off;
  off << "OFF\n" << 2 * (num_squares + 1) << ' ' << num_squares << " 0\n";
  for (int i = 0; i <= num_squares; ++i) off << i << " 0 0\n" << i << " 1 0\n";
  for (int i = 0; i < num_squares; ++i)
    off << "4 " << 2 * i << ' ' << 2 * i + 2 << ' ' << 2 * i + 3 << ' ' << 2 * i + 1 << '\n';
  return off.str();
}
