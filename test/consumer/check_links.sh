#!/usr/bin/env bash
# usage: bash test/consumer/check_links.sh FOLDER. The relative links of the pages in FOLDER lead to files.
set -euo pipefail
cd "$1"
broken=0
while IFS=: read -r page link; do
  link=${link#*\(}
  link=${link%[#)]*}
  if [[ -z $link || -e $(dirname "$page")/$link ]]; then continue; fi
  echo "$page: no file $link"
  broken=1
done < <(grep -roE --include='*.md' '\]\([^)# :]+[#)]' .)
[[ $broken == 0 && -s README.md ]]
