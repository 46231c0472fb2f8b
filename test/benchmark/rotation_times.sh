#!/bin/bash
# How long rotations take: rotation_times.sh TOOLS FILE...
#
# Runs pcl_symmetry_bop on each file alone, 10 000 points and one thread. Prints the median and the ninth tenth of the processor
# time from start to end, and the greatest memory; then the same of all files in one call with two threads.
set -e
if [ $# -lt 2 ]; then
  sed -n '2,5s/^# \?//p' "$0"
  exit 2
fi
tools=$1
shift
times=$(mktemp)
trap 'rm -f "$times"' EXIT
for file in "$@"; do
  /usr/bin/time -a -o "$times" -f '%U %S %M' "$tools"/pcl_symmetry_bop "$file" -points 10000 -threads 1 -quiet >/dev/null
done
awk '{ print 1000 * ($1 + $2), $3 / 1024 }' "$times" | sort -n | awk '
  { t[NR] = $1; if ($2 > m) m = $2 }
  END { printf "%d models: median %.0f ms, nine of ten below %.0f ms, %.0f MB\n", NR, t[int((NR + 1) / 2)], t[int(0.9 * NR + 0.5)], m }'
# The same in one call, one model on each thread.
/usr/bin/time -o "$times" -f '%U %S %M' "$tools"/pcl_symmetry_bop "$@" -points 10000 -threads 2 -quiet >/dev/null
awk -v n=$# '{ printf "in one call with two threads: %.0f ms of processor time a model, %.0f MB\n", 1000 * ($1 + $2) / n, $3 / 1024 }' "$times"
