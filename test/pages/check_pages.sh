#!/usr/bin/env bash
# Runs the commands that the pages show and compares what they print.
set -euo pipefail

usage() {
  cat <<'END'
usage: bash test/pages/check_pages.sh [-h] [--no-models] TOOLS FOLDER [PAGE...]

Checks README.md, CONTRIBUTING.md and the pages of apps, include, src and test, or the given pages:
  console blocks  each "$ command" is run with the programs of the folder TOOLS; what it prints, on both streams, and
                  what the page shows agree: text word by word, numbers to two significant digits, times left out.
                  A line "..." on the page stands for any lines. A command that fails is an error.
  python blocks   run without an error, with the module beside TOOLS, or the installed one.
  sh blocks       are not run: scripts, presets and tools that they name exist, and have every option used.
  other blocks    after <!-- same as: FILE --> the text of a block is found in FILE, line by line.
  links           relative links and pictures, and paths of the repository in code marks, lead to what exists.

Commands run in FOLDER, page by page, in order. It holds cow.off, bull.off, elephant.off and hand.off (Debian package
libcgal-demo), the shapes of apps/gallery/shapes.py, planar.py and prism.awk, and the scans in $PCL_SYMMETRY_SCANS
(default ../shared/data/scans) where that folder exists. A block after <!-- needs: FILE --> is skipped where FILE is absent.
With --no-models none of these files is made.

Exit status 0: all agree. 1: some do not. 77: the meshes cannot be fetched.

example: bash test/pages/check_pages.sh build/apps build/pages apps/README.md
END
}

models=true
case "${1-}" in
  -h | --help) usage; exit 0 ;;
  --no-models) models=false; shift ;;
esac
(($# >= 2)) || { usage >&2; exit 2; }
repository=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
tools=$(realpath "$1")
folder=$(realpath -m "$2")
shift 2
pages=("$@")
cd "$repository"
if ((${#pages[@]} == 0)); then
  mapfile -t pages < <(find README.md CONTRIBUTING.md apps include src test -name '*.md' ! -name mistakes.md | sort)
fi
scans=${PCL_SYMMETRY_SCANS-../shared/data/scans}
export PATH=$tools:$PATH
num_checks=0 num_failed=0 num_skipped=0

passed() { ((++num_checks)); }
failed() {
  ((++num_checks, ++num_failed))
  echo "FAILED $1"
  if (($# > 1)); then echo "$2"; fi
}
skipped() {
  ((++num_skipped))
  printf 'skipped %s\n' "$1"
}

# models_into FOLDER: what the commands of the pages work on.
models_into() {
  bash apps/fetch_meshes.sh "$1" cow bull elephant hand || { echo "check_pages.sh: no meshes, nothing checked"; exit 77; }
  /usr/bin/python3 apps/gallery/shapes.py "$1" || { echo "check_pages.sh: no shapes, nothing checked"; exit 77; }
  cp apps/gallery/*.awk apps/gallery/planar.py "$1"
  if [[ -d $scans ]]; then cp "$scans"/*.pcd "$1"; fi
}

# blocks_of PAGE FOLDER: the text of each fenced block as NNN.block, its line and language in NNN.fence, and the comment
# before the fence in NNN.needs or NNN.same.
blocks_of() {
  awk -v folder="$2" '
    !inside && /^<!-- needs: .* -->$/ { needs = $3 }
    !inside && /^<!-- same as: .* -->$/ { same = $4 }
    !inside && /^```[a-z+]+$/ {
      inside = 1
      name = sprintf("%s/%03d", folder, ++num)
      print NR, substr($0, 4) >(name ".fence")
      if (needs != "") print needs >(name ".needs")
      if (same != "") print same >(name ".same")
      printf "" >(name ".block")
      next
    }
    inside && /^```$/ { inside = 0; needs = same = ""; close(name ".block"); next }
    inside { print >(name ".block") }' "$1"
}

# compare EXPECTED PRINTED: prints the first line that differs and fails.
compare() {
  awk -v printed_file="$2" '
    # One line without times, its words with one blank between.
    function plain(line) {
      gsub(/[0-9]+(\.[0-9]+)? (ms|s)( |,|:|\]|\)|$)/, "TIME ", line)
      gsub(/[ \t]+/, " ", line)
      sub(/^ /, "", line)
      sub(/ $/, "", line)
      return line
    }
    function magnitude(x) { return x < 0 ? -x : x }
    # Within half a unit of the second digit of the larger one; what is below 0.0005 is zero.
    function agree(a, b,   larger, unit) {
      larger = magnitude(a) > magnitude(b) ? magnitude(a) : magnitude(b)
      if (magnitude(a - b) <= 0.0005) return 1
      unit = exp(log(10) * (int(log(larger) / log(10) + 100 + 1e-9) - 101))
      return magnitude(a - b) <= 0.5 * unit * (1 + 1e-6)
    }
    function same(page, printed,   number, a, b, before) {
      number = "[-+]?[0-9]+(\\.[0-9]+)?([eE][-+]?[0-9]+)?"
      for (;;) {
        if (!match(page, number)) return page == printed
        before = substr(page, 1, RSTART - 1)
        a = substr(page, RSTART, RLENGTH)
        page = substr(page, RSTART + RLENGTH)
        if (!match(printed, number) || substr(printed, 1, RSTART - 1) != before) return 0
        b = substr(printed, RSTART, RLENGTH)
        printed = substr(printed, RSTART + RLENGTH)
        if (!agree(a + 0, b + 0)) return 0
      }
    }
    BEGIN {
      while ((getline line <printed_file) > 0) printed[++num_printed] = line
      at = 1
    }
    $0 == "..." { anything = 1; next }
    {
      if (anything) while (at <= num_printed && !same(plain($0), plain(printed[at]))) ++at
      anything = 0
      if (at <= num_printed && same(plain($0), plain(printed[at]))) { ++at; next }
      print "  page:    " $0
      print "  printed: " (at <= num_printed ? printed[at] : "(nothing more)")
      different = 1
      exit
    }
    END {
      if (!different && !anything && at <= num_printed) {
        print "  page:    (nothing more)"
        print "  printed: " printed[at]
        different = 1
      }
      exit different
    }' "$1"
}

# run_console BLOCK LABEL: the commands of a console block, in the current folder.
run_console() {
  local label=$2 commands=$1.commands command index=0 difference
  rm -rf "$commands"
  mkdir "$commands"
  awk -v folder="$commands" '
    continued { print >(name ".command"); continued = /\\$/; next }
    /^\$ / {
      name = sprintf("%s/%02d", folder, ++num)
      printf "" >(name ".page")
      print substr($0, 3) >(name ".command")
      continued = /\\$/
      next
    }
    { print >(name ".page") }' "$1"
  for command in "$commands"/*.command; do
    ((++index))
    local name=${command%.command} status=0
    echo "$label: $(head -n 1 "$command")"
    bash "$command" >"$name.printed" 2>&1 </dev/null || status=$?
    if ((status != 0)); then
      failed "$label: exit status $status: $(head -n 1 "$command")"
      cat "$name.printed"
    elif difference=$(compare "$name.page" "$name.printed"); then
      passed
    else
      failed "$label: $(head -n 1 "$command")" "$difference"
    fi
  done
}

# help_of TOOL: its list of flags, cached.
help_of() {
  local file=$folder/help/$1
  mkdir -p "$folder/help"
  [[ -s $file ]] || "$tools/$1" -h >"$file" 2>&1 || true
  cat "$file"
}

# The options of one command of an sh block.
check_options() {
  local label=$1 tool option help
  shift
  tool=$(basename "$1")
  shift
  case "$tool" in
    time) check_options "$label" "$@"; return ;;
    bash)
      if [[ ! -f $1 ]]; then failed "$label: no file $1"; return; fi
      help=$(cat "$1") ;;
    cmake)
      local text=$*
      if [[ $text =~ --preset\ ([a-z]+) ]]; then
        if grep -q "\"name\": \"${BASH_REMATCH[1]}\"" CMakePresets.json; then passed; else failed "$label: no preset ${BASH_REMATCH[1]}"; fi
      fi
      while [[ $text =~ -D(PCL_SYMMETRY_[A-Z_]+)=(.*) ]]; do
        text=${BASH_REMATCH[2]}
        if grep -rqw "${BASH_REMATCH[1]}" CMakeLists.txt cmake; then passed; else failed "$label: no option ${BASH_REMATCH[1]}"; fi
      done
      return ;;
    pcl_symmetry_*)
      if [[ ! -x $tools/$tool ]]; then skipped "$label: $tool is not built"; return; fi
      help=$(help_of "$tool") ;;
    *) return ;;
  esac
  for option in "$@"; do
    [[ $option =~ ^--?[a-z][a-z_-]*$ ]] || continue
    if grep -qE -- "(^|[^a-z-])$option([^a-z_-]|\$)" <<<"$help"; then
      passed
    else
      failed "$label: no option $option: $tool $*"
    fi
  done
}

python_of_tools() { PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$tools/../src/python${PYTHONPATH:+:$PYTHONPATH} /usr/bin/python3 "$@"; }

check_sh() {
  local label=$2 line words
  while IFS= read -r line; do
    read -ra words <<<"${line%%#*}"
    ((${#words[@]} == 0)) || check_options "$label" "${words[@]}"
  done < <(sed -e ':a' -e '/\\$/N; s/\\\n//; ta' "$1")
}

# check_copy BLOCK FILE LABEL: the lines of the block follow each other in the file.
check_copy() {
  if [[ ! -f $2 ]]; then
    failed "$3: no file $2"
  elif awk -v block="$1" '
      BEGIN { while ((getline line <block) > 0) wanted = wanted "\n" line }
      { text = text "\n" $0 }
      END { exit index(text "\n", wanted "\n") ? 0 : 1 }' "$2"; then
    passed
  else
    failed "$3: the block differs from $2"
  fi
}

check_links() {
  local page=$1 link
  while IFS= read -r link; do
    link=${link%%#*}
    if [[ -z $link || $link == *://* ]]; then continue; fi
    if [[ -e $(dirname "$page")/$link ]]; then passed; else failed "$page: no file $link"; fi
  done < <(grep -oE '\]\([^) ]+\)' "$page" | sed 's/^](//; s/)$//')
}

# Files and folders of this repository that a page names in code marks. Where the next column of a table has a name in code
# marks, the file has that name.
check_paths() {
  local page=$1 path
  while IFS= read -r path; do
    if [[ -e $path ]]; then passed; else failed "$page: no file $path"; fi
  done < <(grep -oE '`(apps|cmake|include|src|test)/[a-zA-Z0-9_./-]+`' "$page" | tr -d '`')
  local name
  while IFS='`' read -r _ path _ name _; do
    if grep -qsw -- "${name##*::}" "$path"; then passed; else failed "$page: no $name in $path"; fi
  done < <(grep -E '`(include|src)/[a-z0-9_./-]+\.(h|cpp)` \| `[A-Za-z:_]+`' "$page" || true)
}

check_page() {
  local page=$1 fence block line language label needs
  local blocks=$folder/${page//\//_}.blocks work=$folder/${page//\//_}.work
  rm -rf "$blocks" "$work"
  mkdir -p "$blocks"
  blocks_of "$page" "$blocks"
  check_links "$page"
  check_paths "$page"
  for fence in "$blocks"/*.fence; do
    [[ -f $fence ]] || continue
    block=${fence%.fence}
    read -r line language <"$fence"
    label=$page:$line
    if [[ -f $block.needs ]]; then
      needs=$(cat "$block.needs")
      if [[ ! -e $folder/models/$needs ]]; then skipped "$label: needs $needs, which is not there"; continue; fi
    fi
    if [[ -f $block.same ]]; then check_copy "$block.block" "$(cat "$block.same")" "$label"; fi
    case $language in
      sh) check_sh "$block.block" "$label" ;;
      python)
        local printed
        if [[ ! -d $work ]]; then cp -r "$folder/models" "$work"; fi
        if grep -q 'pcl_symmetry' "$block.block" && ! python_of_tools -c 'import pcl_symmetry' 2>/dev/null; then
          skipped "$label: needs the Python module"
        elif printed=$(cd "$work" && python_of_tools "$block.block" 2>&1 </dev/null); then
          passed
        else
          failed "$label" "$printed"
        fi ;;
      console)
        if [[ ! -d $work ]]; then cp -r "$folder/models" "$work"; fi
        cd "$work"
        run_console "$block.block" "$label"
        cd "$repository" ;;
    esac
  done
}

rm -rf "$folder/help"
mkdir -p "$folder/models"
if $models; then models_into "$folder/models"; fi
for page in "${pages[@]}"; do check_page "$page"; done
echo "$num_failed of $num_checks checks failed, $num_skipped skipped"
((num_failed == 0))
