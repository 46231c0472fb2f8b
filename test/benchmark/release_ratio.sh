#!/usr/bin/env bash
# Is this tree faster than an earlier revision, and by how much?
set -euo pipefail

usage() {
  cat <<'END'
usage: bash test/benchmark/release_ratio.sh [-h] REVISION [FOLDER]

Builds a revision of the library (a tag, a branch or a commit) and this tree with the preset benchmark, runs both in turn, and
prints for each row the processor time of both in milliseconds and their ratio: below 1, this tree is faster; beside it the
least and the greatest ratio of a round. Rows: the
benchmarks of benchmark_pipeline with one thread, from cloud to planes; a fresh process of pcl_symmetry_planes. Builds and outputs
go to FOLDER (build-benchmark/ratio). PCL_SYMMETRY_MODELS may name a folder with bull, cow, elephant, hand and camel .off; without
it, synthetic shapes are measured. Processor time is the least of the rounds: other programs on the machine hardly change it.

example: bash test/benchmark/release_ratio.sh v0.1
END
}

case "${1-}" in
  -h | --help) usage; exit 0 ;;
esac
(($# == 1 || $# == 2)) || { usage >&2; exit 2; }
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."
revision=$(git rev-parse --verify --quiet "$1^{commit}") || { echo "release_ratio.sh: no revision $1" >&2; exit 1; }
folder=$(realpath -m "${2-build-benchmark/ratio}")
mkdir -p "$folder"

rounds=5 # chosen: half leaves the least times apart by a tenth on a machine with other work
rows='BM_GaussianEdt/points:(10000|1000000)/cells:64/threads:0|BM_SampledTransform|BM_Detection/points:(10000|100000)/cells:64/threads:0|BM_CloudToPlanes|BM_CubeToPlanes'

# build SOURCE BUILD: the benchmarks and the tool that is started afresh.
build() {
  cmake -S "$1" -B "$2" -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DBUILD_TESTING=OFF \
    -DPCL_SYMMETRY_BUILD_BENCHMARKS=ON >/dev/null
  cmake --build "$2" --target benchmark_pipeline pcl_symmetry_planes make_shapes >"$2/build.log" 2>&1 ||
    { tail -n 20 "$2/build.log" >&2; exit 1; }
}

# processor_ms COMMAND...: user and system time of a process, milliseconds.
processor_ms() {
  local TIMEFORMAT='%U %S'
  { time "$@" >/dev/null 2>&1; } 2>&1 | awk '{ printf "%.1f\n", 1000 * ($1 + $2) }'
}

# run_once BUILD FILE: adds lines "row milliseconds" to FILE. On one core there is one thread, whose time the benchmarks print.
run_once() {
  taskset -c 0 "$1/test/benchmark/benchmark_pipeline" --benchmark_filter="$rows" 2>/dev/null |
    awk '/^BM_/ { print $1, $4 }' >>"$2"
  echo "fresh_process_of_planes $(processor_ms taskset -c 0 "$1/apps/pcl_symmetry_planes" "$folder/models/airplane.ply" -quiet -threads 1)" >>"$2"
}

rm -rf "$folder/source"
mkdir -p "$folder/source"
git archive "$revision" | tar -x -C "$folder/source"
build "$folder/source" "$folder/before"
build . "$folder/after"
mkdir -p "$folder/models"
"$folder/after/apps/make_shapes" "$folder/models" >/dev/null
rm -f "$folder"/*.times
for ((round = 0; round < rounds; ++round)); do
  run_once "$folder/before" "$folder/before.times"
  run_once "$folder/after" "$folder/after.times"
done
printf '%-52s %10s %10s %7s  %s\n' "row, processor time in ms" "before" "after" "ratio" "of single rounds"
awk '
  { of_row = FILENAME ~ /before.times$/ ? "before" : "after" }
  of_row == "before" && !seen[$1]++ { order[++count] = $1 }
  { key = of_row " " $1; round = ++rounds[key]; time[key, round] = $2; if (round == 1 || $2 < least[key]) least[key] = $2 }
  END {
    for (i = 1; i <= count; ++i) {
      row = order[i]; before = "before " row; after = "after " row
      if (!(after in least)) continue
      low = high = time[after, 1] / time[before, 1]
      for (k = 2; k <= rounds[before] && k <= rounds[after]; ++k) {
        ratio = time[after, k] / time[before, k]
        if (ratio < low) low = ratio
        if (ratio > high) high = ratio
      }
      printf "%-52s %10.2f %10.2f %7.2f  %.2f to %.2f\n", row, least[before], least[after], least[after] / least[before], low, high
    }
  }
' "$folder/before.times" "$folder/after.times"
