#!/usr/bin/env bash
# Is the house in order? Prints what a successor carries, and what breaks a rule of CONTRIBUTING.md.
case "${1-}" in
  "") ;;
  -h | --help)
    cat <<'END'
usage: bash test/structure.sh [-h]

Prints lines of C++, folders, named constants, the longest page, and how many files stand behind symmetry_detection.h, each with
its limit; then what breaks a rule: includes that run up from a room of the core to one above it, includes of PCL by the core
or of private headers by installed ones, and installed headers without a test of their name. Exit status 0 if nothing is over
its limit and no rule is broken.
END
    exit 0 ;;
  *) echo "structure.sh: unknown option $1" >&2; exit 2 ;;
esac
cd "$(dirname "${BASH_SOURCE[0]}")/.." && exec python3 - <<'END'
import os
import re
import subprocess
import sys
from pathlib import Path

# What is allowed: lines of C++, lines in src and include, lines of Python, folders with C++, named constants, lines of the
# longest page, and files and lines behind symmetry_detection.h.
LIMITS = dict(cpp=64420, library=37310, python=5500, folders=60, constants=122, page=300, files_behind=147, lines_behind=14330)

listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], capture_output=True, text=True, check=True).stdout
files = [Path(name) for name in listed.splitlines() if os.path.isfile(name)]
text = {f: f.read_text(errors="replace") for f in files if f.suffix in (".cpp", ".h", ".hpp", ".py", ".md")}
cpp = [f for f in text if f.suffix in (".cpp", ".h", ".hpp")]
lines = {f: t.count("\n") for f, t in text.items()}
core = [f for f in cpp if "core" in f.parts and f.parts[0] in ("src", "include")]
installed = [f for f in cpp if f.parts[0] == "include"]
broken = 0


def report(what, number, limit, findings=()):
    """A line of the report, and what breaks the rule below it."""
    global broken
    over = number > limit
    broken += over
    print(f"{number:7}  {what} (at most {limit}){'  TOO MANY' if over else ''}")
    for finding in findings:
        print("         " + finding)


def includes(f):
    return re.findall(r'^#include ["<]([^">]+)[">]', text[f], re.M)


by_name = {}
for f in cpp:
    for root in ("include/", "src/"):
        if str(f).startswith(root):
            by_name[str(f)[len(root):]] = f


def behind(header):
    """All files of the project that a header reaches: its includes, and the sources of the headers among them."""
    sources = {}
    for f in cpp:
        if f.suffix == ".cpp" and f.parts[0] == "src":
            sources.setdefault(f.stem, []).append(f)
    found, todo = set(), [by_name[header]]
    while todo:
        f = todo.pop()
        if f in found:
            continue
        found.add(f)
        todo += [by_name[i] for i in includes(f) if i in by_name]
        if f.suffix != ".cpp":
            # A header of src has its source beside it, one of include wherever it stands.
            todo += [s for s in sources.get(f.stem, []) if s.parent == f.parent or f.parts[0] == "include"]
    return found


research = [f for f in text if f.suffix == ".py" and f.parts[:2] == ("test", "benchmark")]
constants = [m for f in cpp if f.parts[0] in ("src", "include") for m in re.findall(r"constexpr [a-zA-Z_:<> ]+ k[A-Z]\w*", text[f])]
pages = {f: n for f, n in lines.items() if f.suffix == ".md"}
longest = max(pages, key=pages.get)
reached = behind("pcl_symmetry/symmetry_detection.h")
report("lines of C++", sum(lines[f] for f in cpp), LIMITS["cpp"])
report("lines of C++ in src and include", sum(lines[f] for f in cpp if f.parts[0] in ("src", "include")), LIMITS["library"])
report("lines of Python in test/benchmark", sum(lines[f] for f in research), LIMITS["python"])
report("folders with C++", len({f.parent for f in cpp}), LIMITS["folders"])
report("named constants in src and include", len(constants), LIMITS["constants"])
report(f"lines of the longest page, {longest}", pages[longest], LIMITS["page"])
report("files behind symmetry_detection.h", len(reached), LIMITS["files_behind"])
report("lines of these files", sum(lines[f] for f in reached), LIMITS["lines_behind"])

# The list of rooms in src/CMakeLists.txt, bottom first, is the order. An installed header belongs to the room of its source,
# or of its test.
rooms = re.search(r"set\(rooms\n(.*?)^\)", Path("src/CMakeLists.txt").read_text(), re.S | re.M).group(1)
floors = {line.split()[0]: i for i, line in enumerate(rooms.splitlines())}
room_of_name = {f.stem: f.parent.name for f in core if f.parts[0] == "src" and f.suffix == ".cpp"}
for f in cpp:
    if f.parts[:2] == ("test", "core"):
        room_of_name.setdefault(f.stem[len("test_"):], f.parent.name)


def room(f):
    return f.parts[2] if f.parts[0] == "src" else room_of_name.get(f.stem)


upward = []
for f in core:
    for name in includes(f):
        other = by_name.get(name)
        if other is None or other.stem == "exports" or f.stem == "exports":
            continue
        if other not in core:
            upward.append(f"{f}: {name} lies outside the core")
        elif floors.get(room(f)) is None or floors.get(room(other)) is None:
            upward.append(f"{f}: the room of {name} is not in the list")
        elif floors[room(other)] > floors[room(f)]:
            upward.append(f"{f}: {name} lies above")
report("includes that run up in the core", len(upward), 0, upward)
of_pcl = [f"{f}: {name}" for f in core for name in includes(f) if name.startswith(("pcl/", "vtk"))]
report("includes of PCL or VTK by the core", len(of_pcl), 0, of_pcl)
leaks = [f"{f}: {name}" for f in installed for name in includes(f) if name in by_name and by_name[name].parts[0] != "include"]
report("includes of private headers by installed ones", len(leaks), 0, leaks)
tests = {f.stem for f in cpp if f.parts[0] == "test"}
untested = [str(f) for f in installed if f.suffix == ".h" and f.stem != "exports" and "test_" + f.stem not in tests]
report("installed headers without a test of their name", len(untested), 0, untested)

if broken:
    print(f"structure.sh: {broken} findings")
sys.exit(broken > 0)
END
