#!/usr/bin/env bash
# Runs all fuzzers, one after the other.
set -uo pipefail

usage() {
  cat <<'END'
usage: bash test/fuzz/run.sh [-h] SECONDS [TARGET...]

Builds the fuzzers with Clang and libFuzzer (cmake --preset fuzz) into build-fuzz/ and runs each for SECONDS with the address and
undefined-behavior sanitizers, from small files of make_seeds.py and what earlier runs kept in build-fuzz/corpus. An input that
crashes, takes more than 120 s, or asks for more than 300 MB at once stays in build-fuzz/findings/TARGET.

Targets: planes rotations segment packed database, and readers of files: pcd ply off xyz csv obj stl glb nii nii.gz mgh nrrd
mha vti models_info isaac.

Exit status 0: nothing was found. 1: something was. 2: wrong usage, or the fuzzers could not be built.
END
}

case "${1-}" in
  -h | --help) usage; exit 0 ;;
  "" | *[!0-9]*) usage >&2; exit 2 ;;
esac
seconds=$1
shift
readers="pcd ply off xyz csv obj stl glb nii nii.gz mgh nrrd mha vti models_info isaac"
targets=("$@")
((${#targets[@]} > 0)) || targets=(planes rotations segment packed database $readers)
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit 2
command -v clang++ >/dev/null || { echo "run.sh: needs Clang with libFuzzer: apt-get install clang libclang-rt-dev libomp-dev" >&2; exit 2; }
cmake --preset fuzz --log-level=WARNING >/dev/null && cmake --build --preset fuzz --parallel "$(nproc)" || exit 2
folder=$PWD/build-fuzz
num_found=0
for target in "${targets[@]}"; do
  program=fuzz_$target longest=600
  if [[ " $readers " == *" $target "* ]]; then program=fuzz_files longest=4096; fi
  if [[ $target == database ]]; then longest=4000000; fi
  leaks=1
  case $target in glb | vti) leaks=0 ;; esac  # Assimp and VTK leak some kB of files that they refuse
  mkdir -p "$folder/corpus/$target" "$folder/findings/$target"
  # The option of libFuzzer does not reach the check at the end of the process.
  if FUZZ_KIND=$target OMP_NUM_THREADS=1 ASAN_OPTIONS=detect_leaks=$leaks "$folder/test/fuzz/$program" -max_total_time="$seconds" -timeout=120 -rss_limit_mb=3000 \
    -malloc_limit_mb=300 -max_len=$longest -detect_leaks=$leaks -close_fd_mask=1 -artifact_prefix="$folder/findings/$target/" \
    "$folder/corpus/$target" "$folder/test/fuzz/seeds/$target" 2>"$folder/findings/$target.log"; then
    echo "$target: nothing found, $(grep -oE 'Done [0-9]+ runs' "$folder/findings/$target.log" | head -1)"
  else
    ((++num_found))
    echo "$target: FOUND, see $folder/findings/$target.log"
  fi
done
((num_found == 0))
