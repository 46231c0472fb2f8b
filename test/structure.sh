#!/usr/bin/env bash
# Is the house in order? Prints what a successor carries, and what breaks a rule of CONTRIBUTING.md.
case "${1-}" in
  "") ;;
  -h | --help)
    cat <<'END'
usage: bash test/structure.sh [-h]

Prints lines of C++ and Python, folders, the longest page, numbers set by hand, and how many files stand behind
symmetry_detection.h, each with its goal; then what breaks a rule: includes that run up from a module of the core to one above it,
includes of PCL by the core or of private headers by installed ones, and installed headers without a test of their name. Exit
status 0 if nothing is over its limit and no rule is broken; goals are reported only.
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

# What is allowed, and where we want to be, which is reported only.
LIMITS = dict(folders=60, page=300)
GOALS = dict(cpp=54000, library=30500, tests=11500, python=9800, numbers=560, files_behind=90)

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


def reported(what, number, goal):
    print(f"{number:7}  {what} (goal {goal}){'' if number <= goal else f', {number - goal} to go'}")


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


def numbers_by_hand(source):
    """Literals but 0, 1, 2, 3, 4, 8, 16, 32, 64, 0.25, 0.5, 180 and 360, without comments, strings and includes."""
    source = re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'|^#include[^\n]*', " ", source, flags=re.S | re.M)
    literals = re.findall(r"(?<![\w.])(?:0[xX][\da-fA-F']+|(?:\d[\d']*\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)(?=[fFlLuUzZ]*(?![\w.]))", source)
    plain = {0, 1, 2, 3, 4, 8, 16, 32, 64, 0.25, 0.5, 180, 360}
    values = [text.replace("'", "") for text in literals]
    return sum((int(v, 16) if v[:2] in ("0x", "0X") else float(v)) not in plain for v in values)


tests_of_python = [f for f in text if f.suffix == ".py" and f.parts[0] == "test"]
library = [f for f in cpp if f.parts[0] in ("src", "include")]
by_hand = [f for f in library if not text[f].startswith("// Written by")]
pages = {f: n for f, n in lines.items() if f.suffix == ".md"}
longest = max(pages, key=pages.get)
reached = behind("pcl_symmetry/symmetry_detection.h")
reported("lines of C++", sum(lines[f] for f in cpp), GOALS["cpp"])
reported("lines of C++ in src and include", sum(lines[f] for f in library), GOALS["library"])
reported("lines of C++ in test", sum(lines[f] for f in cpp if f.parts[0] == "test"), GOALS["tests"])
reported("lines of Python in test", sum(lines[f] for f in tests_of_python), GOALS["python"])
reported("numbers set by hand in src and include", sum(numbers_by_hand(text[f]) for f in by_hand), GOALS["numbers"])
reported("files behind symmetry_detection.h", len(reached), GOALS["files_behind"])
report("folders with C++", len({f.parent for f in cpp}), LIMITS["folders"])
report(f"lines of the longest page, {longest}", pages[longest], LIMITS["page"])

# The list of modules in src/CMakeLists.txt, bottom first, is the order. An installed header belongs to the module of its source,
# or of its test.
modules = re.search(r"set\(modules\n(.*?)^\)", Path("src/CMakeLists.txt").read_text(), re.S | re.M).group(1)
floors = {line.split()[0]: i for i, line in enumerate(modules.splitlines())}
module_of_name = {f.stem: f.parent.name for f in core if f.parts[0] == "src" and f.suffix == ".cpp"}
for f in cpp:
    if f.parts[:2] == ("test", "core"):
        module_of_name.setdefault(f.stem[len("test_"):], f.parent.name)


def module(f):
    return f.parts[2] if f.parts[0] == "src" else module_of_name.get(f.stem)


upward = []
for f in core:
    for name in includes(f):
        other = by_name.get(name)
        if other is None or other.stem == "exports" or f.stem == "exports":
            continue
        if other not in core:
            upward.append(f"{f}: {name} lies outside the core")
        elif floors.get(module(f)) is None or floors.get(module(other)) is None:
            upward.append(f"{f}: the module of {name} is not in the list")
        elif floors[module(other)] > floors[module(f)]:
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
