#!/usr/bin/env bash
# check_installed.sh BUILD PYTHON FOLDER: Python looks where `cmake --install` puts the module.
set -euo pipefail
build=$1 python=$2 folder=$3
paths=$("$python" -c 'import sys; print(*sys.path)')
rm -rf "$folder"
for prefix in /usr /usr/local; do
  root=$folder/$(basename "$prefix")
  cmake --install "$build" --prefix "$root$prefix" --component python >/dev/null
  file=$(find "$root" -name __init__.py)
  packages=${file%/pcl_symmetry/__init__.py}
  [[ " $paths " == *" ${packages#"$root"} "* ]] ||
    { echo "check_installed.sh: Python does not look into ${packages#"$root"}, but into $paths"; exit 1; }
  PYTHONPATH=$packages "$python" -c 'import pcl_symmetry'
done
echo "found below /usr and /usr/local"
