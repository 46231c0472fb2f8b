#!/usr/bin/env bash
# Is the house in order? Counts, and what breaks a rule of CONTRIBUTING.md.
set -euo pipefail

usage() {
  cat <<'END'
usage: bash test/structure.sh [-h] [-v]

Prints, for the tree that it stands in: installed headers (at most 45, each with a test of its name), includes that run
up from a room of the core to one above it, includes of private headers by installed ones, functions longer than 60
lines, folders with more than 12 source files, and named constants without an origin (derived, measured, fitted or
chosen). Exit status 0 if no rule is broken. -v also lists all functions from 50 lines on.

A function may be longer where the line above it, or its comment, says "Long because" and why.
END
}

verbose=false
case "${1-}" in
  -h | --help) usage; exit 0 ;;
  -v) verbose=true ;;
  "") ;;
  *) usage >&2; exit 2 ;;
esac
cd "$(dirname "${BASH_SOURCE[0]}")/.."
max_headers=45 max_lines=60 max_files=12
broken=0

# report NUMBER TEXT [LIST]: a line, and what breaks the rule.
report() {
  local count
  count=$(grep -c . <<<"${3-}" || true)
  printf '%6s  %s\n' "$1" "$2"
  if [[ -n ${3-} ]]; then
    sed 's/^/          /' <<<"$3"
    broken=$((broken + count))
  fi
}

mapfile -t sources < <(git ls-files -co --exclude-standard -- 'include/*.h' 'include/*.hpp' 'src/*.h' 'src/*.cpp' 'apps/*.h' 'apps/*.cpp' |
  while read -r file; do [[ -f $file ]] && echo "$file"; done)
mapfile -t headers < <(printf '%s\n' "${sources[@]}" | grep '^include/')

too_many=""
((${#headers[@]} <= max_headers)) || too_many="${#headers[@]} headers, at most $max_headers"
report "${#headers[@]}" "installed headers, .hpp counted (at most $max_headers)" "$too_many"

untested=$(for header in "${headers[@]}"; do
  [[ $header == *.hpp || $header == */exports.h ]] && continue
  name=$(basename "$header" .h)
  compgen -G "test/core/*/test_$name.cpp" >/dev/null || compgen -G "test/pcl/test_$name.cpp" >/dev/null ||
    compgen -G "test/pcl/*/test_$name.cpp" >/dev/null || echo "$header"
done)
report "$(grep -c . <<<"$untested" || true)" "installed headers without a test of their name (0)" "$untested"

leaks=$(grep -n '#include "' "${headers[@]}" | grep -v '"pcl_symmetry/' || true)
report "$(grep -c . <<<"$leaks" || true)" "includes of private headers by installed ones (0)" "$leaks"

pcl_in_core=$(grep -nE '#include <(pcl|vtk)' $(printf '%s\n' "${sources[@]}" | grep -E '^(src|include/pcl_symmetry)/core/') || true)
report "$(grep -c . <<<"$pcl_in_core" || true)" "includes of PCL or VTK by the core (0)" "$pcl_in_core"

# The list of rooms in src/CMakeLists.txt, bottom first, is the order.
upward=$(awk '
  FNR == NR {
    if (/^set\(rooms/) inside = 1
    else if (inside && /^\)/) inside = 0
    else if (inside) floor[$1] = ++num_floors
    next
  }
  FNR == 1 { from = FILENAME; sub(/.*core\//, "", from); sub(/\/.*/, "", from) }
  /^#include "/ {
    to = $2; gsub(/"/, "", to)
    if (to == "pcl_symmetry/core/exports.h") next
    if (to ~ /^(pcl_symmetry\/)?core\//) { sub(/.*core\//, "", to); sub(/\/.*/, "", to) }
    else { print FILENAME ": " $2 " lies outside the core"; next }
    if (!(from in floor) || !(to in floor)) print FILENAME ": room of " $2 " is not in the list"
    else if (floor[to] > floor[from]) print FILENAME ": " $2 " lies above"
  }' src/CMakeLists.txt $(printf '%s\n' "${sources[@]}" | grep -E '^(src|include/pcl_symmetry)/core/.*/'))
report "$(grep -c . <<<"$upward" || true)" "includes that run up in the core (0)" "$upward"

# Formatted code: a body ends with a closing brace under the first character of its signature; classes and namespaces
# hold functions and are none.
functions=$(awk '
  function begin(line, at, signature) {
    start = at; name = signature; first = 0
    match(line, /^ */); indent = RLENGTH
    sub(/^ */, "", name); sub(/\(.*/, "", name)
    reason = index(comment, "Long because")
  }
  FNR == 1 { start = first = 0; comment = "" }
  start {
    match($0, /^ */)
    if (/^ *\}/ && RLENGTH == indent) {
      print FNR - start + 1, FILENAME ":" start, name, reason ? "reason" : ""
      start = 0; comment = ""
    }
    next
  }
  /^ *\/\// { comment = comment $0; next }
  first {
    if (/\{$/) begin(signature, first, signature)
    else if (/[;}]$/) first = 0
    next
  }
  /^ ? ?[A-Za-z~]/ && !/^ *(namespace|class|struct|enum|extern|union|using|if|for|while|switch|else|do|try|return|constexpr)[ ({]/ {
    if (/\(.*\{$/) { begin($0, FNR, $0); next }
    if (/\(/ && !/[;}]$/) { first = FNR; signature = $0; next }
  }
  !/^ *$/ { comment = "" }' "${sources[@]}" | sort -rn)
long=$(awk -v most=$max_lines '$1 > most && $NF != "reason"' <<<"$functions")
report "$(head -1 <<<"$functions" | cut -d' ' -f1)" "lines in the longest function: $(head -1 <<<"$functions" | cut -d' ' -f2-) (at most $max_lines, or its reason)" "$long"
if $verbose; then awk '$1 >= 50 { print "          " $0 }' <<<"$functions"; fi

folders=$(printf '%s\n' "${sources[@]}" $(git ls-files -co --exclude-standard -- 'test/*.h' 'test/*.cpp') | sort -u |
  while read -r file; do [[ -f $file ]] && dirname "$file"; done | sort | uniq -c | sort -rn)
crowded=$(awk -v most=$max_files '$1 > most { print $1, $2 }' <<<"$folders")
report "$(awk 'NR == 1 { print $1 }' <<<"$folders")" "source files in the fullest folder: $(awk 'NR == 1 { print $2 }' <<<"$folders") (at most $max_files)" "$crowded"

# An origin stands on the line of the constant, or in the comment over the run of constants that it belongs to.
constants=$(awk '
  FNR == 1 { origin = 0; in_comment = 0 }
  /^ *\/\// { if (!in_comment) origin = 0; in_comment = 1; if (/(derived|measured|fitted|chosen):/) origin = 1; next }
  { in_comment = 0 }
  /^ *((static|inline) )*constexpr [^(=]*[ &*]k[A-Z][A-Za-z0-9_]*(\[[^\]]*\])* *(=|\{)/ {
    print (origin || /(derived|measured|fitted|chosen):/) ? "good" : FILENAME ":" FNR ": " $0
    next
  }
  { if (!/,$/) origin = 0 }' "${sources[@]}")
without=$(grep -v '^good$' <<<"$constants" || true)
report "$(grep -c . <<<"$without" || true)" "of $(grep -c . <<<"$constants") named constants without an origin (0)" "$without"

if ((broken > 0)); then
  echo "structure.sh: $broken findings"
  exit 1
fi
