#!/usr/bin/env bash
# Sets up, builds and tests everything: from a fresh Debian 12 to one line of counts.
set -uo pipefail

usage() {
  cat <<'END'
usage: bash test/run.sh [-h] [--all] [--filter REGEX]

Installs missing packages, builds libraries, tools and tests into build/ and runs the tests. With --all, builds the
libraries once more with the address and undefined-behavior sanitizers into build-sanitize/ and runs their tests, then the
core, which starts all threads, with the thread sanitizer and without PCL into build-thread/ and runs its tests of
threads. The last line says "N passed, N failed, N skipped"; a step that fails before its tests counts as one failure.
Exit status 0 if tests ran and none failed.

  --all            with sanitizers
  --filter REGEX   only tests whose name matches; sanitizers run all of theirs

example: bash test/run.sh --filter consumer
END
}

sanitize=false
filter=.
while (($# > 0)); do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --all) sanitize=true ;;
    --filter)
      if [[ -z ${2-} ]]; then echo "run.sh: --filter needs a regular expression" >&2; exit 2; fi
      filter=$2
      shift ;;
    *) echo "run.sh: unknown option $1" >&2; usage >&2; exit 2 ;;
  esac
  shift
done

cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
jobs=$(nproc)
passed=0 failed=0 skipped=0

say() {
  printf '\n== %s (%d s)\n' "$*" "$SECONDS"
}

finish() {
  printf '\n%d passed, %d failed, %d skipped\n' "$passed" "$failed" "$skipped"
  ((failed == 0 && passed > 0))
  exit
}

# Runs a step; where it fails, nothing after it makes sense.
step() {
  "$@" </dev/null && return
  echo "run.sh: failed: $*" >&2
  ((++failed))
  finish
}

# Adds what a JUnit report of ctest holds. A test that could not be started has failed; "notrun" is also what ctest
# says of one that skipped itself.
count() {
  local counts
  counts=$(awk '
    /<testcase / { status = $0; sub(/.* status="/, "", status); sub(/".*/, "", status) }
    /<testcase / && status == "run" { passed++ }
    /<testcase / && status == "fail" { failed++ }
    /<testcase / && status == "disabled" { skipped++ }
    /<skipped / && status == "notrun" { if (/message="SKIP_/) skipped++; else failed++ }
    END { print passed + 0, failed + 0, skipped + 0 }' "$1") || return
  local p f s
  read -r p f s <<<"$counts"
  ((passed += p, failed += f, skipped += s, 1))
}

configure() {  # with the tests, which apps/demo.sh leaves out of build/; sanitizers link those that build/ compiled
  local tests_of=
  [[ $1 == release ]] || tests_of=$PWD/build
  cmake --preset "$1" -DBUILD_TESTING=ON -DPCL_SYMMETRY_TESTS_OF="$tests_of" --log-level=WARNING >/dev/null
}

# build_and_test PRESET FOLDER TARGET [ctest options]
build_and_test() {
  local preset=$1 folder=$2 target=$3
  shift 3
  say "Building $target into $folder"
  step configure "$preset"
  step cmake --build "$folder" --parallel "$jobs" --target "$target"
  say "Testing $folder"
  rm -f "$folder/tests.xml"
  # One more than there are cores: tests of programs that die wait for them.
  ctest --preset "$preset" --parallel "$((jobs + 1))" --tests-regex "$filter" --output-junit tests.xml "$@" </dev/null
  local status=$? failed_before=$failed
  if [[ ! -s $folder/tests.xml ]] || ! count "$folder/tests.xml" || { ((status != 0)) && ((failed == failed_before)); }; then
    echo "run.sh: ctest ended with status $status" >&2
    ((++failed))
  fi
}

say "Installing packages"
step bash cmake/install_dependencies.sh
# Nothing is compiled twice in a run, and an empty cache costs a sixth of the time to compile.
if $sanitize && ccache --print-stats 2>/dev/null | grep -qx $'files_in_cache\t0'; then export CCACHE_DISABLE=1; fi
build_and_test release build all
if $sanitize; then
  filter=.  # these tests have other names
  build_and_test sanitize build-sanitize library_tests --label-regex '^(core|pcl)$'
  build_and_test thread build-thread library_tests --label-regex '^core$'
fi
finish
