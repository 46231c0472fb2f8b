#!/usr/bin/env bash
# The reference is made without a warning.
set -euo pipefail

usage() {
  cat <<'END'
usage: bash test/pages/check_doxygen.sh [-h] FOLDER

Writes the reference of cmake/Doxyfile into FOLDER/html and prints Doxygen's warnings: comments that do not parse, names and links that
lead nowhere, parameters that do not exist, classes, functions and members without a comment. Typedefs such as Ptr and
protected functions that override one of PCL may have none.

Exit status 0: none. 1: warnings, or a page or a section of it that is missing. 77: Doxygen is not installed.
END
}

case "${1-}" in
  -h | --help) usage; exit 0 ;;
  "" | -*) usage >&2; exit 2 ;;
esac
folder=$(realpath -m "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
command -v doxygen >/dev/null || { echo "skipped: the Debian package doxygen is not installed"; exit 77; }
rm -rf "$folder/html"
mkdir -p "$folder"
{ cat cmake/Doxyfile; echo "OUTPUT_DIRECTORY = $folder"; } | doxygen - 2>"$folder/all_warnings" >/dev/null
grep -vE 'warning: Member .*(\(typedef\)|override \(function\)) of .* is not documented\.$' "$folder/all_warnings" >"$folder/warnings" || true
cat "$folder/warnings"
if [[ -s $folder/warnings ]]; then
  echo "check_doxygen.sh: $(grep -c . "$folder/warnings") lines of warnings"
  exit 1
fi
# The class of each row of the tables is in the reference, and so are the pages.
missing=0
for name in $(grep -oE '`pcl_symmetry::[A-Za-z0-9]+`' src/pages/main_page.md | tr -d '`' | sort -u); do
  grep -qrl --include='*.html' ">${name#pcl_symmetry::}<\|$name" "$folder/html" || { echo "not in the reference: $name"; missing=1; }
done
for text in 'Which class do I need' 'From the paper to the command line'; do
  grep -q "$text" "$folder/html/index.html" || { echo "not on the main page: $text"; missing=1; }
done
for page in src/pages/*.md src/pages/{algorithms,tools}/*.md; do
  title=$(sed -n '1s/^# //p' "$page")
  [[ $page == */main_page.md ]] || grep -q ">$title<" "$folder/html/pages.html" || { echo "not among the pages: $title"; missing=1; }
done
for page in src/pages/algorithms/*.md; do
  for section in Idea Example Parameters Cost Limits 'Where it fails'; do
    grep -q "^[*][*]$section[.][*][*]" "$page" || { echo "$page: no section '$section'"; missing=1; }
  done
  (($(grep -c '^!\[' "$page") >= 2)) || { echo "$page: needs a picture of what it does and one of a failure"; missing=1; }
done
for picture in $(grep -ohE '<img src="[^"]*[.]png"' "$folder"/html/*.html | cut -d'"' -f2 | sort -u); do
  [[ -s $folder/html/$picture ]] || { echo "not in the reference: $picture"; missing=1; }
done
((missing == 0)) && echo "reference: $(find "$folder/html" -name '*.html' | wc -l) pages, no warning"
exit "$missing"
