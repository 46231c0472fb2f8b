#!/usr/bin/env bash
# Installs the Debian packages that build, tests and demo need; without network and at once where all are installed.
set -euo pipefail

to_build=(
  build-essential cmake ninja-build pkg-config
  libpcl-dev libflann-dev libeigen3-dev libboost-dev                      # the library,
  libsqlite3-dev zlib1g-dev                                               # its database of models
  libboost-filesystem-dev libboost-program-options-dev nlohmann-json3-dev # the tools: options, files, reports,
  libassimp-dev libembree-dev                                             # meshes, the virtual scanner,
  libvtk9-dev python3-vtk9 libx11-dev xvfb libgl1-mesa-dri                # pictures, also without a screen
  pybind11-dev python3-dev python3-numpy                                  # the Python module
)
to_develop=(
  ccache mypy python3-dask python3-distributed                            # types, work that several machines share,
  python3-scipy python3-sklearn python3-matplotlib python3-open3d         # what measures: fits, figures, distances to meshes
  doxygen python3-sphinx python3-breathe python3-myst-parser furo         # the reference
  help2man file chromium                                                  # manual pages, Debian packages, pages of results
  libgtest-dev libgmock-dev libbenchmark-dev python3-jsonschema           # tests and benchmarks
)
packages=("${to_build[@]}" "${to_develop[@]}")

usage() {
  cat <<END
usage: bash cmake/install_dependencies.sh [-h] [--build-only]

Installs what is missing of these packages with apt-get, as root or through sudo:
$(printf '  %s\n' "${to_build[@]}")
and without --build-only, for tests, measurements and pages:
$(printf '  %s\n' "${to_develop[@]}")
END
}

fail() {
  echo "install_dependencies.sh: $*" >&2
  exit 1
}

missing_packages() {
  local package
  for package in "${packages[@]}"; do
    [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || echo "$package"
  done
}

as_root() {
  if ((EUID == 0)); then
    "$@"
  elif [[ -t 0 ]]; then
    sudo "$@"
  else
    sudo -n "$@"
  fi
}

apt() {
  as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o Acquire::Retries=3 -o DPkg::Lock::Timeout=300 "$@" </dev/null
}

case "${1-}" in
  -h | --help) usage; exit 0 ;;
  --build-only) packages=("${to_build[@]}") ;;
  "") ;;
  *) usage >&2; exit 2 ;;
esac

command -v dpkg-query >/dev/null && command -v apt-get >/dev/null ||
  fail "needs Debian or a relative of it (dpkg and apt-get); elsewhere install the like of: ${packages[*]}"

mapfile -t missing < <(missing_packages)
if ((${#missing[@]} == 0)); then
  echo "All ${#packages[@]} packages are installed."
  exit 0
fi

echo "Installing ${missing[*]}"
((EUID == 0)) || command -v sudo >/dev/null || fail "has to run as root, or with sudo, to install: ${missing[*]}"
apt update || echo "install_dependencies.sh: not every package list could be read, going on with those there are" >&2
apt install -y --no-install-recommends "${missing[@]}" || fail "apt-get could not install: ${missing[*]}"

mapfile -t missing < <(missing_packages)
((${#missing[@]} == 0)) || fail "still missing: ${missing[*]}"
