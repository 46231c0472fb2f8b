#!/usr/bin/env bash
# The Debian packages hold all that a user needs.
set -euo pipefail

usage() {
  cat <<'END'
usage: bash test/packages/check_packages.sh [-h] BUILD [ROOT]

Makes the packages of the build folder BUILD, unpacks them beside it, and uses what is in them: finds the planes of a box by the
tool and by the Python module, and opens the manual.

With ROOT, a bare Debian system (`debootstrap --variant=minbase bookworm ROOT`), installs the packages there with apt, as root,
does the same there and builds a program against the library; then removes them and looks for what is left. ROOT changes.

example: bash test/packages/check_packages.sh build
END
}

case "${1-}" in
  -h | --help) usage; exit 0 ;;
  "") usage >&2; exit 2 ;;
esac

say() {
  printf '\n== %s\n' "$*"
}

fail() {
  echo "check_packages.sh: $*" >&2
  exit 1
}

# use_packages COMMAND...: COMMAND runs a command where the packages are.
use_packages() {
  "$@" bash -euc '
    cd "$(mktemp -d)"
    /usr/bin/python3 - <<END
import pcl_symmetry, numpy
random = numpy.random.default_rng(1)
points = random.normal(size=(4000, 3))
points = (points / numpy.abs(points).max(axis=1, keepdims=True) * (1, 0.8, 0.5)).astype("float32")
numpy.savetxt("box.xyz", points)
assert len(pcl_symmetry.planes(points)) == 3
END
    pcl_symmetry_planes box.xyz -quiet | grep -c symmetry | grep -qx 3
    pcl_symmetry_map -version
    # By the module that writes clouds, which the tools load.
    pcl_symmetry_planes box.xyz -quiet -support box.ply -html box.html >/dev/null
    [[ -s box.ply && -s box.html ]]
  '
}

build=$(realpath "$1")
root=${2-}
source=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
packages=$build/packages
say "Packages"
rm -rf "$packages"
mkdir -p "$packages"
(cd "$packages" && cpack -G DEB --config "$build/CPackConfig.cmake" >cpack.log) || fail "cpack failed: $(tail -5 "$packages/cpack.log")"
ls -l "$packages"/*.deb
for package in libpcl-symmetry-dev pcl-symmetry-tools python3-pcl-symmetry; do
  compgen -G "$packages/${package}_*.deb" >/dev/null || fail "$package was not made"
done

if [[ -z $root ]]; then
  say "Unpacked"
  for deb in "$packages"/*.deb; do dpkg-deb -x "$deb" "$packages/unpacked"; done
  usr=$packages/unpacked/usr
  use_packages env PATH="$usr/bin:$PATH" PYTHONPATH="$usr/lib/python3/dist-packages"
  for file in include/pcl_symmetry/symmetry_detection.h share/man/man1/pcl_symmetry_planes.1.gz \
    share/bash-completion/completions/pcl_symmetry_planes share/doc/pcl_symmetry/README.md \
    share/doc/pcl_symmetry/apps/README.md share/doc/pcl_symmetry/apps/examples/01_first_plane.cpp; do
    [[ -s $usr/$file ]] || fail "no package holds /usr/$file"
  done
  bash "$source/test/consumer/check_links.sh" "$usr/share/doc/pcl_symmetry" || fail "links of pages lead nowhere"
  for word in database:merge map:voting; do
    grep -qw "${word#*:}" "$usr/share/bash-completion/completions/pcl_symmetry_${word%:*}" || fail "completion lacks $word"
  done
  descriptions=$(for deb in "$packages"/*.deb; do dpkg-deb -f "$deb" Description | sed -n 1p; done | sort | uniq -d)
  [[ -z $descriptions ]] || fail "packages share the description $descriptions"
  ! find "$usr" -name '*test*' | grep . || fail "tests are in the packages"
  # Shared libraries have a package of their own, and say of each symbol which of them it belongs to.
  mapfile -t libraries < <(find "$usr" -name 'libpcl_symmetry*.so.*.*.*')
  if compgen -G "$packages/libpcl-symmetry[0-9]*.deb" >/dev/null; then
    ((${#libraries[@]} == 2)) || fail "${#libraries[@]} shared libraries in place of two"
  fi
  for library in "${libraries[@]}"; do
    soname=$(objdump -p "$library" | awk '/SONAME/ { print $2 }')
    unversioned=$(nm -D --defined-only --with-symbol-versions "$library" | grep -v " A $soname\$" | grep -vc "@@\?$soname" || true)
    ((unversioned == 0)) || fail "$library has $unversioned symbols without a version"
    dpkg-deb -I "$packages"/libpcl-symmetry[0-9]*.deb shlibs | grep "^${soname%%.so*} " >/dev/null || fail "no shlibs for $soname"
  done
  say "All is there"
  exit
fi

say "Installed in $root"
mkdir -p "$root/tmp/packages"
cp "$packages"/*.deb "$root/tmp/packages"
cp -r "$source/test/consumer/cmake_pcl" "$root/tmp/consumer"
in_root() { chroot "$root" env DEBIAN_FRONTEND=noninteractive "$@"; }
in_root apt-get -q update
in_root bash -c 'apt-get -q install -y --no-install-recommends /tmp/packages/*.deb g++ cmake make'
use_packages in_root
in_root bash -euc 'cmake -S /tmp/consumer -B /tmp/consumer/build -DCMAKE_BUILD_TYPE=Release >/dev/null
  cmake --build /tmp/consumer/build && /tmp/consumer/build/cmake_pcl'
say "Removed"
mapfile -t names < <(for deb in "$packages"/*.deb; do dpkg-deb -f "$deb" Package; done)
in_root apt-get -q purge -y "${names[@]}"
! find "$root/usr" -name '*pcl_symmetry*' | grep . || fail "files are left"
say "All works, nothing is left"
