#!/usr/bin/env bash
# Memory and cores of one call of a tool on many files.
set -euo pipefail

usage() {
  cat <<'END'
usage: bash test/benchmark/many_files.sh [-h] APPS [POINTS]

Writes 10 000 clouds of POINTS points (500) into a temporary folder, boxes of random sizes, and runs pcl_symmetry_planes of the
folder APPS on 1 000 and on all 10 000 of them in one call each. Prints time, files a second, peak of memory, the share of all
cores that was used, which other work on the machine lowers, and the share of the time that the threads ran or waited for a core: what
they would use of an idle machine.

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
  "$apps/pcl_symmetry_planes" "@$work/list" -quiet -json "$work/planes.jsonl" &
  tool=$!
  begin=$EPOCHREALTIME busy=
  # Nanoseconds that each thread ran and waited, as the kernel counts them; VmHWM in kB. The last sample counts.
  while sample=$(cat "/proc/$tool"/task/*/schedstat 2>/dev/null) && memory=$(grep VmHWM "/proc/$tool/status" 2>/dev/null); do
    busy=$(awk -v now="$EPOCHREALTIME" -v begin="$begin" -v cores="$(nproc)" -v memory="$memory" '
      { ran += $1; waited += $2; ++threads }
      END {
        split(memory, words)
        seconds = now - begin
        printf "%.1f MB, %.1f %% of %d cores, threads ran or waited for a core %.1f %% of the time", words[2] / 1000,
          100 * ran / 1e9 / seconds / cores, cores, 100 * (ran + waited) / 1e9 / seconds / threads
      }' <<<"$sample")
    sleep 0.5
  done
  wait "$tool"
  seconds=$(awk -v now="$EPOCHREALTIME" -v begin="$begin" 'BEGIN { print now - begin }')
  lines=$(wc -l <"$work/planes.jsonl")
  awk -v count="$count" -v lines="$lines" -v seconds="$seconds" -v busy="$busy" 'BEGIN {
    printf "%d files, %d results: %.1f s, %.0f files a second, %s\n", count, lines, seconds, count / seconds, busy
  }'
done
