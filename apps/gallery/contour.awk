# The planar shapes of Figures 1 to 3 as ASCII PCD files: awk -v shape="polygon 5" -f contour.awk > pentagon.pcd
#
#   polygon N              regular, in the unit circle
#   rectangle W H [BUMP]   half width, half height, height of a bump on the upper side
#   starfish NOISE         five arms; points moved along the radius by that standard deviation
#   flower ARMS            a starfish with so many of its five arms
#   mug HANDLE             a mug from the side, with a handle of that radius

function add(px, py) {
  x[n] = px
  y[n++] = py
}

function corner(px, py) {
  cx[c] = px
  cy[c++] = py
}

function normal() {
  return sqrt(-2 * log(1 - rand())) * cos(2 * pi * rand())
}

# Points at equal steps along the polygon of the corners.
function trace(   i, k, steps, dx, dy) {
  for (i = 0; i < c; i++) {
    dx = cx[(i + 1) % c] - cx[i]
    dy = cy[(i + 1) % c] - cy[i]
    steps = int(sqrt(dx * dx + dy * dy) / 0.004) + 1
    for (k = 0; k < steps; k++) add(cx[i] + dx * (k + 0.5) / steps, cy[i] + dy * (k + 0.5) / steps)
  }
}

function arms(number, noise,   k, t, r) {
  for (k = 0; k < 2400; k++) {
    t = 2 * pi * k / 2400
    if (int(5 * t / (2 * pi) + 0.5) % 5 >= number) continue
    r = 0.6 + 0.35 * cos(5 * t) + noise * normal()
    add(r * sin(t), r * cos(t))
  }
}

BEGIN {
  pi = atan2(0, -1)
  srand(1)
  n = c = 0
  split(shape, a, " ")
  if (a[1] == "polygon") {
    for (k = 0; k < a[2]; k++) corner(-sin(2 * pi * k / a[2]), cos(2 * pi * k / a[2]))
  } else if (a[1] == "rectangle") {
    w = a[2]
    h = a[3]
    corner(-w, -h)
    corner(w, -h)
    corner(w, h)
    if (a[4]) {
      corner(0.45 * w, h)
      corner(0.35 * w, h + a[4])
      corner(0.25 * w, h)
    }
    corner(-w, h)
  } else if (a[1] == "starfish") {
    arms(5, a[2])
  } else if (a[1] == "flower") {
    arms(a[2], 0)
  } else if (a[1] == "mug") {
    corner(-0.6, -0.8)
    corner(0.6, -0.8)
    corner(0.6, 0.8)
    corner(-0.6, 0.8)
    for (k = 0; k < 300; k++) {
      t = pi * (k / 300 - 0.5)
      add(0.6 + a[2] * cos(t), a[2] * sin(t))
    }
  } else {
    print "contour.awk: unknown shape " shape > "/dev/stderr"
    exit 1
  }
  trace()
  print "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " n "\nHEIGHT 1"
  print "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS " n "\nDATA ascii"
  for (k = 0; k < n; k++) print x[k], y[k], 0
}
