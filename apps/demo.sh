#!/usr/bin/env bash
# From a fresh Debian 12 to the symmetry planes of a scan, or of your own file.
set -euo pipefail

usage() {
  cat <<'END'
usage: bash apps/demo.sh [-h] [FILE]

Without a file: fetches the mesh of a cow, scans it from one side and finds its plane of symmetry in the scan; then finds the
planes of the bull of the paper's Figure 8 and of its parts. With a file (.pcd, .ply, .obj, .stl, .off, .xyz or .glb): finds the
planes of that file.

Prints the planes; writes pictures (PNG) and reports (JSON) to build/demo. Installs missing packages and builds the tools; a
second run skips both.

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

# find_planes INPUT NAME [FLAG ...]: prints a table and writes NAME_planes.json and NAME_planes.png to the demo folder.
find_planes() {
  say "Symmetry planes of $1"
  local input=$1 name=$2
  shift 2
  local command=(build/apps/pcl_symmetry_planes "$input" "$@"
    -json "$demo/${name}_planes.json" -png "$demo/${name}_planes.png")
  echo "${command[*]}"
  "${command[@]}"
  echo "Picture: $demo/${name}_planes.png   report: $demo/${name}_planes.json"
}

say "Packages"
bash cmake/install_dependencies.sh --build-only

say "Tools"
cmake --preset release -DBUILD_TESTING=OFF --log-level=WARNING >/dev/null
cmake --build build --parallel "$(nproc)" --target pcl_symmetry_scan pcl_symmetry_planes

if [[ -n $file ]]; then
  name=$(basename "$file")
  find_planes "$file" "${name%.*}"
  exit
fi

say "Fetching a cow and a bull (Debian package libcgal-demo)"
bash apps/fetch_meshes.sh "$demo" cow bull
say "Scanning the cow from one side"
rm -f "$demo/cow_scan.pcd"  # of any version
build/apps/pcl_symmetry_scan "$demo/cow.off" "$demo/cow_scan.pcd"
find_planes "$demo/cow_scan.pcd" cow_scan -up 0,1,0
find_planes "$demo/bull.off" bull -approximate -max_planes 6 -up 0,1,0
