#!/usr/bin/env bash
# Meshes of the Debian package libcgal-demo, which is unpacked, never installed.
set -euo pipefail

usage() {
  cat <<'END'
usage: bash apps/fetch_meshes.sh [-h] FOLDER NAME...

Puts NAME.off of each NAME into FOLDER, unless it is there. A mesh appears whole or not at all.

example: bash apps/fetch_meshes.sh build/demo cow bull
END
}

fail() {
  echo "fetch_meshes.sh: $*" >&2
  exit 1
}

case "${1-}" in
  -h | --help) usage; exit 0 ;;
esac
(($# >= 2)) || { usage >&2; exit 2; }
folder=$1
shift
missing=()
for name in "$@"; do
  [[ -s $folder/$name.off ]] || missing+=("$name")
done
((${#missing[@]} > 0)) || exit 0
mkdir -p "$folder"

download_package() {
  local options=(-q)
  ((EUID != 0)) || options+=(-o APT::Sandbox::User=root)
  if ! (cd "$1" && apt-get "${options[@]}" download libcgal-demo); then
    echo "No package lists yet, reading them"
    if ((EUID == 0)); then apt-get -q update; elif [[ -t 0 ]]; then sudo apt-get -q update; else sudo -n apt-get -q update; fi
    (cd "$1" && apt-get "${options[@]}" download libcgal-demo)
  fi
}

package=$folder/package
rm -rf "$package"
mkdir "$package"
download_package "$package" || fail "the Debian package libcgal-demo, which holds the meshes, could not be fetched"
dpkg -x "$package"/*.deb "$package/files"
archive=$(find "$package/files/usr/share/doc" -name 'data.tar.gz' | head -n 1)
[[ -n $archive ]] || fail "the package libcgal-demo has no data.tar.gz"
for name in "${missing[@]}"; do
  tar -xzOf "$archive" "data/meshes/$name.off" >"$folder/$name.off.part" || fail "$name: no such mesh in libcgal-demo"
  mv "$folder/$name.off.part" "$folder/$name.off"
done
rm -rf "$package"
