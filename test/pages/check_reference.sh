#!/usr/bin/env bash
# The reference is made without a warning, and nothing is missing in it.
set -euo pipefail

usage() {
  cat <<'END'
usage: bash test/pages/check_reference.sh [-h] FOLDER PYTHON

Makes the reference in FOLDER by cmake/make_reference.sh and looks for the classes of src/pages/main_page.md, the names of the
Python package in the folder PYTHON, pages with the sections of an algorithm, pictures, typeset formulas, and addresses
that depend on where the repository lies.

Exit status 0: all is there. 1: warnings, or what is missing. 77: programs that make it are not installed.
END
}

case "${1-}" in
  -h | --help) usage; exit 0 ;;
  "" | -*) usage >&2; exit 2 ;;
esac
folder=$(realpath -m "$1") python=$(realpath -m "$2")
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
bash cmake/make_reference.sh "$folder" "$python"
html=$folder/html
missing=0
miss() { echo "$*"; missing=1; }
for name in $(grep -oE '`pcl_symmetry::[A-Za-z0-9]+`' src/pages/main_page.md | tr -d '`' | sort -u); do
  grep -qr --include='*.html' "<span class=\"pre\">${name#pcl_symmetry::}</span></span></span>.*<a class=\"headerlink\"" "$html/cpp" || miss "not in the reference: $name"
done
for name in $(PYTHONPATH=$python /usr/bin/python3 -c 'import pcl_symmetry; print(*(n for n in dir(pcl_symmetry) if n[0] != "_"))'); do
  grep -q "id=\"pcl_symmetry.$name\"" "$html/python.html" || miss "not in the reference: $name of Python"
done
# Setters and computations say in a sentence what they do, before their parameters.
for page in "$html"/cpp/symmetry_maxima_refinement.html "$html"/cpp/symmetry_registration.html; do
  grep -qE '<dd><p>(Sets|Finds)' "$page" || miss "no summaries: $page"
done
for page in src/pages/algorithms/*.md; do
  for section in Idea Example Parameters Cost Limits 'Where it fails'; do
    grep -q "^[*][*]$section[.][*][*]" "$page" || miss "$page: no section '$section'"
  done
  (($(grep -c '^!\[' "$page") >= 2)) || miss "$page: needs a picture of what it does and one of a failure"
done
grep -q '<mfrac>' "$html/src/pages/algorithms/transform.html" || miss "formulas are not typeset"
for page in $(find "$html" -name '*.html'); do
  for picture in $(grep -ohE '<img [^>]*src="[^"]*"' "$page" | sed 's/.*src="//; s/"//'); do
    [[ $picture == data:* || -s $(dirname "$page")/$picture ]] || miss "$page: no picture $picture"
  done
done
if found=$(grep -rlF "$PWD" "$html"); then miss "the folder of the repository is in: $found"; fi
((missing == 0)) && echo "reference: nothing is missing"
exit "$missing"
