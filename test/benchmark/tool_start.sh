#!/usr/bin/env bash
# How long tools take to start.
set -euo pipefail

usage() {
  cat <<'END'
usage: bash test/benchmark/tool_start.sh [-h] FOLDER [FOLDER ...]

Runs each tool in the folders with -h, 21 times in turn, and prints for each folder the median of the time in milliseconds and the
number of shared libraries. With several folders (builds before and after a change) their columns stand side by side.

example: bash test/benchmark/tool_start.sh ../before/build/apps build/apps
END
}

case "${1-}" in
  -h | --help) usage; exit 0 ;;
  "") usage >&2; exit 2 ;;
esac

rounds=21 # chosen: half gives medians that change by a tenth from run to run

# milliseconds COMMAND: the wall time of one start.
milliseconds() {
  local begin=$EPOCHREALTIME
  "$1" -h >/dev/null
  local end=$EPOCHREALTIME
  echo $(((${end/./} - ${begin/./}))) | awk '{ printf "%.2f\n", $1 / 1000 }'
}

printf '%-26s' tool
for folder in "$@"; do printf '%12s %10s' "ms" "libraries"; done
printf '   of each: %s\n' "$*"
for tool in "${@: -1}"/pcl_symmetry_*; do
  [[ -x $tool && -f $tool && $tool != *.so ]] || continue
  name=$(basename "$tool")
  times=$(for ((round = 0; round < rounds; ++round)); do
    for folder in "$@"; do
      if [[ -x $folder/$name ]]; then echo "$folder $(milliseconds "$folder/$name")"; fi
    done
  done)
  printf '%-26s' "$name"
  for folder in "$@"; do
    if [[ ! -x $folder/$name ]]; then
      printf '%12s %10s' - -
      continue
    fi
    median=$(awk -v folder="$folder" '$1 == folder { print $2 }' <<<"$times" | sort -n | sed -n "$((rounds / 2 + 1))p")
    printf '%12s %10d' "$median" "$(ldd "$folder/$name" | wc -l)"
  done
  echo
done
