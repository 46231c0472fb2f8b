#!/usr/bin/env bash
# From a fresh Debian 12 to the symmetry planes of a scan, or of a file of one's own.
set -euo pipefail

usage() {
  cat <<'END'
usage: bash apps/demo.sh [-h] [FILE]

Without a file: fetches the bull of the paper's Figure 8, scans it from one side, and finds the symmetry planes of the
scan and of the whole bull. With a file (.pcd, .ply, .obj, .stl or .off): finds the symmetry planes of that.

Prints the planes; pictures (PNG) and reports (JSON) go to build/demo. Packages that are missing are installed, tools are
built where needed; run again, it starts with the planes.

example: bash apps/demo.sh my_scan.pcd
END
}

say() {
  printf '\n== %s\n' "$*"
}

fail() {
  echo "demo.sh: $*" >&2
  exit 1
}

file=
case "${1-}" in
  -h | --help) usage; exit 0 ;;
  -*) usage >&2; exit 2 ;;
  "") ;;
  *)
    [[ -f $1 ]] || fail "$1: no such file"
    file=$(realpath "$1") ;;
esac
(($# <= 1)) || { usage >&2; exit 2; }

cd "$(dirname "${BASH_SOURCE[0]}")/.."
demo=build/demo
mkdir -p "$demo"

download_package() {
  local options=(-q)
  ((EUID != 0)) || options+=(-o APT::Sandbox::User=root)
  if ! (cd "$1" && apt-get "${options[@]}" download libcgal-demo); then
    echo "No package lists yet, reading them"
    if ((EUID == 0)); then apt-get -q update; elif [[ -t 0 ]]; then sudo apt-get -q update; else sudo -n apt-get -q update; fi
    (cd "$1" && apt-get "${options[@]}" download libcgal-demo)
  fi
}

# The bull appears whole or not at all; the package that holds it is unpacked, never installed.
fetch_bull() {
  local package=$demo/package
  rm -rf "$package"
  mkdir "$package"
  download_package "$package" || fail "the Debian package libcgal-demo, which holds the bull, could not be fetched"
  dpkg -x "$package"/*.deb "$package/files"
  local archive
  archive=$(find "$package/files/usr/share/doc" -name 'data.tar.gz' | head -n 1)
  [[ -n $archive ]] || fail "the package libcgal-demo has no data.tar.gz"
  tar -xzOf "$archive" data/meshes/bull.off >"$demo/bull.off.part"
  mv "$demo/bull.off.part" "$demo/bull.off"
  rm -rf "$package"
}

# find_planes INPUT NAME: a table here, NAME_planes.json and NAME_planes.png in the demo folder.
find_planes() {
  say "Symmetry planes of $1"
  local command=(build/apps/pcl_symmetry_planes "$1" -approximate -max_planes 5
    -json "$demo/$2_planes.json" -png "$demo/$2_planes.png")
  echo "${command[*]}"
  "${command[@]}"
  echo "Picture: $demo/$2_planes.png   report: $demo/$2_planes.json"
}

say "Packages"
bash cmake/install_dependencies.sh

say "Tools"
cmake --preset release --log-level=WARNING >/dev/null
cmake --build build --parallel "$(nproc)" --target pcl_symmetry_scan pcl_symmetry_planes

if [[ -n $file ]]; then
  name=$(basename "$file")
  find_planes "$file" "${name%.*}"
  exit
fi

if [[ ! -s $demo/bull.off ]]; then
  say "Fetching the bull (Debian package libcgal-demo)"
  fetch_bull
fi
say "Scanning the bull from one side"
build/apps/pcl_symmetry_scan "$demo/bull.off" "$demo/bull_scan.pcd"
find_planes "$demo/bull_scan.pcd" bull_scan
find_planes "$demo/bull.off" bull
