#!/usr/bin/env bash
# run_readme.sh PROGRAM: the program of README.md finds the one plane of a slanted elliptic cylinder, y = 0.5.
set -euo pipefail
cloud=$(mktemp --suffix=.pcd)
trap 'rm -f "$cloud"' EXIT
awk 'BEGIN {
  pi = atan2(0, -1)
  print "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 4000\nHEIGHT 1"
  print "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 4000\nDATA ascii"
  for (i = 0; i < 100; i++)
    for (j = 0; j < 40; j++) {
      angle = 2 * pi * (i + 0.5) / 100
      x = 2 * cos(angle)
      print x, sin(angle) + 0.5, (3 + x) * (j + 0.5) / 40
    }
}' >"$cloud"
printed=$("$1" "$cloud")
echo "$printed"
# A line "a b c d  confidence p": b is 1 or -1, d is 0.5 times that, confidence at least 0.5.
awk 'function near(x, y) { return x - y < 0.001 && y - x < 0.001 }
  { ++num; right = near($2 * $2, 1) && near($4 / $2, -0.5) && $6 >= 0.5 }
  END { exit num == 1 && right ? 0 : 1 }' <<<"$printed"
