#!/usr/bin/env bash
# Sets up, builds and tests everything: from a fresh Debian 12 to one line of counts.
set -uo pipefail

usage() {
  cat <<'END'
usage: bash test/run.sh [-h] [--all] [--until SECONDS] [--filter REGEX]

Installs missing packages, builds libraries, tools and tests into build/ and runs the tests. With --all, builds the
libraries once more with the address and undefined-behaviour sanitizers into build-sanitize/ and runs their tests, then the
core, which starts all threads, with the thread sanitizer and without PCL into build-thread/ and runs its tests of threads, and
the tools and their tests into build-sanitize/ at last. The last line says "N passed, N failed, N skipped"; a step that
fails before its tests counts as one failure. Exit status 0 if tests ran and none failed.

  --all            with sanitizers
  --until SECONDS  leaves out what would not end before that many seconds, judging by the time that the build and the tests
                   without sanitizers took; what is left out is named, and counts as one skipped test
  --filter REGEX   only tests whose name matches

example: bash test/run.sh --filter consumer
END
}

sanitize=false
until=0
filter=.
while (($# > 0)); do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --all) sanitize=true ;;
    --until)
      if [[ ! ${2-} =~ ^[1-9][0-9]*$ ]]; then echo "run.sh: --until needs a number of seconds" >&2; exit 2; fi
      until=$2
      shift ;;
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

configure() {
  cmake --preset "$1" --log-level=WARNING >/dev/null
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
begin=$SECONDS
build_and_test release build all
took=$((SECONDS - begin))
# with_sanitizers PER_CENT PRESET TARGET LABELS: PER_CENT of the time without sanitizers are needed.
with_sanitizers() {
  if ((until > 0 && SECONDS + took * $1 / 100 > until)); then
    say "Left out for want of time: $3 in build-$2"
    ((++skipped))
  else
    build_and_test "$2" "build-$2" "$3" --label-regex "^($4)$"
  fi
}
if $sanitize; then
  # measured: on two slow cores with an empty compiler cache, where the build and the tests without sanitizers took 1500 s;
  # a fifth is added
  with_sanitizers 115 sanitize library_tests 'core|pcl'
  with_sanitizers 35 thread library_tests core
  with_sanitizers 180 sanitize all apps
fi
finish
