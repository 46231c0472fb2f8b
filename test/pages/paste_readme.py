"""Runs all blocks of README.md in order, in one shell, as a reader pastes them.

usage: python3 test/pages/paste_readme.py [-h] [BUILD PREFIX FOLDER]

BUILD PREFIX FOLDER: does not build and install first, but takes the programs and the module of the folder BUILD, the library
installed below PREFIX, and FOLDER in place of that of the demo, which is made anew. A block is saved as the file that is
named before it. In a fresh Debian 12: bash test/bare_system.sh --user python3 test/pages/paste_readme.py
"""
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def steps(text):
    """Lines of a shell for each block."""
    parts = re.split(r"```(\w*)\n(.*?)```", text, flags=re.S)
    for before, kind, body in zip(parts[::3], parts[1::3], parts[2::3]):
        words = [line for line in before.splitlines() if line]
        named = re.match(r"`([\w.]+)`(?:, run by `([^`]+)`)?:$", words[-1]) if words else None
        if kind == "console":
            yield "\n".join(line[2:] for line in body.splitlines() if line.startswith("$ "))
        elif named:
            yield f"cat >{named[1]} <<'END_OF_BLOCK'\n{body}END_OF_BLOCK\n{named[2] or ''}".rstrip()
        elif kind == "sh":
            yield body.rstrip()


def without_building(blocks, build, prefix, folder):
    """The same with what is built and installed already."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    demo = [f"bash apps/fetch_meshes.sh {folder} cow", f"{build}/apps/pcl_symmetry_scan {folder}/cow.off {folder}/cow_scan.pcd"]
    for block in blocks[1:]:
        yield block.replace("$PWD/build/installed", str(prefix)).replace("$PWD/build", str(build)).replace(
            "cd build/demo", "\n".join([*demo, f"cd {folder}"]))  # fmt: skip


def main(arguments):
    if arguments[:1] in (["-h"], ["--help"]) or len(arguments) not in (0, 3):
        return print(__doc__)
    blocks = list(steps((ROOT / "README.md").read_text()))
    if arguments:
        blocks = list(without_building(blocks, *(Path(a).resolve() for a in arguments)))
    lines = ["set -euo pipefail", f"cd '{ROOT}'"]
    for k, block in enumerate(blocks, 1):
        lines += [f"echo '== block {k}'", block]
    with subprocess.Popen(["bash", "-c", "\n".join(lines)], stdout=subprocess.PIPE, text=True) as run:
        printed = ""
        for line in run.stdout:
            print(line, end="", flush=True)
            printed += line
    # The planes that the programs of the page print: of a scan in C++, and of a depth image in Python.
    for expected in (r"^ *(-?\d\S* +){4}confidence 0\.[5-9]", r"^symmetry \[.*\] 0\.[5-9]"):
        if not run.returncode and not re.search(expected, printed, re.M):
            sys.exit(f"paste_readme.py: no line {expected}")
    sys.exit(run.returncode)


if __name__ == "__main__":
    main(sys.argv[1:])
