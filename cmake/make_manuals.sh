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
  help2man --no-info --name="$("$folder/$tool" -h | sed -n 1p)" --help-option=-h --version-option=-version "$folder/$tool" |
    gzip -9n >"$output/man1/$tool.1.gz"
  # A tool with commands prints the flags of each by "TOOL COMMAND -h"; the completion offers those of the tool itself.
  flags=$("$folder/$tool" -h | sed -nE 's/^  (-[a-z_]+)( .*)?$/\1/p' | tr '\n' ' ')
  printf 'complete -o default -W "%s" %s\n' "$flags" "$tool" >"$output/completions/$tool"
done
