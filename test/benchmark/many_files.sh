#!/usr/bin/env bash
# Memory and cores of one call of a tool on many files.
set -euo pipefail

usage() {
  cat <<'END'
usage: bash test/benchmark/many_files.sh [-h] APPS [POINTS]

Writes 10 000 clouds of POINTS points (500) into a temporary folder, boxes of random sizes, and runs pcl_symmetry_planes of the
folder APPS on 1 000 and on all 10 000 of them in one call each. Prints time, files a second, peak of memory, and the share of all
cores that was used; other work on the machine lowers that share.

example: bash test/benchmark/many_files.sh build/apps
END
}

case "${1-}" in
  -h | --help) usage; exit 0 ;;
  "") usage >&2; exit 2 ;;
esac
apps=$1 points=${2-500} num_files=10000
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/clouds"
awk -v folder="$work/clouds" -v points="$points" -v files=$num_files 'BEGIN {
  srand(1)
  for (i = 1; i <= files; ++i) {
    file = sprintf("%s/%05d.xyz", folder, i)
    for (k = 0; k < 3; ++k) size[k] = 0.5 + rand()
    for (j = 0; j < points; ++j) {
      face = int(3 * rand())
      for (k = 0; k < 3; ++k) x[k] = size[k] * (k == face ? (rand() < 0.5 ? -1 : 1) : 2 * rand() - 1)
      printf "%.5f %.5f %.5f\n", x[0], x[1], x[2] > file
    }
    close(file)
  }
}'
for count in 1000 $num_files; do
  printf '%s\n' "$work"/clouds/*.xyz | head -"$count" >"$work/list" || true
  # %U + %S: seconds of processor time; %e: of the clock; %M: kB
  /usr/bin/time -o "$work/time" -f "%U %S %e %M" "$apps/pcl_symmetry_planes" "@$work/list" -quiet -json "$work/planes.jsonl"
  lines=$(wc -l <"$work/planes.jsonl")
  awk -v count="$count" -v lines="$lines" -v cores="$(nproc)" '{
    printf "%d files, %d results: %.1f s, %.0f files a second, %.1f MB, %.1f %% of %d cores\n", count, lines, $3, count / $3, $4 / 1000, 100 * ($1 + $2) / $3 / cores, cores
  }' "$work/time"
done
