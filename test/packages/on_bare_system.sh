#!/usr/bin/env bash
# bare_system.sh --packages, for ctest: skipped where a bare system cannot be made.
set -euo pipefail

usage() {
  cat <<'END'
usage: bash test/packages/on_bare_system.sh [-h] BUILD

Installs the Debian packages of the build folder BUILD on a bare Debian 12, uses them and removes them, see test/bare_system.sh.

Exit status 0: all works. 77: not root, no debootstrap (which nothing else needs, so that it is not installed by itself), or less
than 6 GB under TMPDIR. Otherwise something does not work.
END
}

case "${1-}" in
  -h | --help) usage; exit 0 ;;
  "" | -*) usage >&2; exit 2 ;;
esac
skip() {
  echo "skipped: $*"
  exit 77
}
((EUID == 0)) || skip "needs root"
command -v debootstrap >/dev/null || skip "the Debian package debootstrap is not installed"
free_kb=$(df --output=avail "${TMPDIR:-/tmp}" | tail -1)
((free_kb > 6000000)) || skip "needs 6 GB under ${TMPDIR:-/tmp}"
exec bash "$(dirname "${BASH_SOURCE[0]}")/../bare_system.sh" --packages "$1"
