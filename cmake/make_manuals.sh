#!/usr/bin/env bash
# Manual pages and completion for bash, made of what tools print with -h.
set -euo pipefail

usage() {
  cat <<'END'
usage: bash cmake/make_manuals.sh [-h] FOLDER OUTPUT TOOL...

Writes OUTPUT/man1/TOOL.1.gz by help2man and OUTPUT/completions/TOOL for each tool in FOLDER.

example: bash cmake/make_manuals.sh build/apps build/manuals pcl_symmetry_planes
END
}

case "${1-}" in
  -h | --help) usage; exit 0 ;;
esac
if (($# < 3)); then
  usage >&2
  exit 2
fi
folder=$1 output=$2
shift 2
mkdir -p "$output/man1" "$output/completions"
for tool in "$@"; do
  help2man --no-info --name="$("$folder/$tool" -h | sed '/^$/Q' | tr '\n' ' ' | sed 's/\. .*//')" --help-option=-h --version-option=-version "$folder/$tool" |
    gzip -9n >"$output/man1/$tool.1.gz"
  # Flags, their values such as a|b, and commands such as "a, b or c".
  words=$("$folder/$tool" -h | sed -nE 's/^  (-h), (-help) .*/\1 \2/p; s/^  (-[a-z_0-9]+)( ([a-z]+(\|[a-z]+)+)( .*)?| .*)?$/\1 \3/p; s/^  command +(.*)$/\1/p' |
    sed -E 's/[|,]/ /g; s/ or / /g' | tr '\n' ' ')
  printf 'complete -o default -W "%s" %s\n' "$words" "$tool" >"$output/completions/$tool"
done
