#!/usr/bin/env bash
# Tools that only compute load one library of PCL, and neither VTK nor Assimp.
set -euo pipefail

case "${1-}" in
  -h | --help)
    echo "usage: bash test/tools/check_libraries.sh [-h] APPS"
    echo "Looks at the shared libraries of all tools in the folder APPS but the viewer. libpcl_common alone is loaded at the start:"
    echo "the other libraries of PCL, and VTK behind them, take long to load."
    exit 0 ;;
  "") echo "check_libraries.sh: missing folder of the tools" >&2; exit 2 ;;
esac
command -v ldd >/dev/null || { echo "skipped: there is no ldd"; exit 77; }
num_tools=0 bad=0
for tool in "$1"/pcl_symmetry_*; do
  [[ -f $tool && -x $tool && $tool != *.so && $tool != *_viewer ]] || continue
  num_tools=$((num_tools + 1))
  libraries=$(ldd "$tool" | grep -oE 'lib(pcl_|vtk|assimp)[A-Za-z_]*' | grep -vx libpcl_common | sort -u | tr '\n' ' ') || true
  [[ -z $libraries ]] || { echo "$(basename "$tool") loads $libraries" >&2; bad=1; }
done
((num_tools > 0)) || { echo "check_libraries.sh: no tools in $1" >&2; exit 2; }
((bad == 0)) && echo "$num_tools tools load libpcl_common alone"
exit $bad
