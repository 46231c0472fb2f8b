#!/usr/bin/env bash
# Makes the reference: pages, C++ and Python in one site.
set -euo pipefail

usage() {
  cat <<'END'
usage: bash cmake/make_reference.sh [-h] FOLDER [PYTHON]

Writes FOLDER/html/index.html: the pages of the repository, the public headers and the Python package, which the folder
PYTHON holds, by Doxygen and Sphinx. Any warning of either is an error. The pages need no network.

Exit status 77: doxygen, python3-sphinx, python3-breathe, python3-myst-parser or furo (Debian packages) is not installed.

example: cmake --build build --target reference
END
}

case "${1-}" in
  -h | --help) usage; exit 0 ;;
  "" | -*) usage >&2; exit 2 ;;
esac
folder=$(realpath -m "$1")
python=${2+$(realpath -m "$2")}
cd "$(dirname "${BASH_SOURCE[0]}")/.."
if ! command -v doxygen >/dev/null || ! /usr/bin/python3 -c 'import sphinx, breathe, myst_parser, furo' 2>/dev/null; then
  echo "make_reference.sh: needs the Debian packages doxygen, python3-sphinx, python3-breathe, python3-myst-parser and furo" >&2
  exit 77
fi
# The pages lie as in the repository, so that their links hold and addresses do not depend on the folder.
pages=$folder/pages
rm -rf "$folder"
mkdir -p "$pages"
for name in README.md CONTRIBUTING.md CHANGELOG.md LICENSE package.xml apps cmake include src test; do ln -s "$PWD/$name" "$pages/$name"; done
for file in "$PWD"/cmake/reference/{conf.py,index.rst,cpp.rst,python.rst}; do ln -s "$file" "$pages"; done
{ cat cmake/reference/Doxyfile; echo "OUTPUT_DIRECTORY = $folder"; } | doxygen - >/dev/null
PYTHONPATH=$python PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -m sphinx -q -W --keep-going -d "$folder/read" "$pages" "$folder/html"
echo "reference: $(find "$folder/html" -name '*.html' | wc -l) pages in $folder/html"
