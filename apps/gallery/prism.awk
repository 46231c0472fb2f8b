# A regular prism of circumradius 36 and height 120 as an OFF file: awk -v sides=6 -f prism.awk > prism.off
# With many sides it is a can.

BEGIN {
  pi = atan2(0, -1)
  print "OFF"
  print 2 * sides, sides + 2, 0
  for (level = 0; level < 2; level++)
    for (i = 0; i < sides; i++) print 36 * cos(2 * pi * i / sides), 36 * sin(2 * pi * i / sides), 120 * level - 60
  floor = roof = sides
  for (i = 0; i < sides; i++) {
    next_i = (i + 1) % sides
    print 4, i, next_i, sides + next_i, sides + i
    floor = floor " " (sides - 1 - i)
    roof = roof " " (sides + i)
  }
  print floor
  print roof
}
