"""Runs all blocks of README.md in order, in one shell, as a reader pastes them.

usage: python3 test/pages/paste_readme.py [-h] [FIRST]

FIRST: number of the block to begin with, from 1; blocks are named as they run. A block is saved as the file that is named
before it. In a fresh Debian 12: bash test/bare_system.sh --user python3 test/pages/paste_readme.py
"""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def steps(text):
    """Lines of a shell for each block."""
    parts = re.split(r"```(\w*)\n(.*?)```", text, flags=re.S)
    for before, kind, body in zip(parts[::3], parts[1::3], parts[2::3]):
        words = [line for line in before.splitlines() if line and not line.startswith("<!--")]
        named = re.match(r"`([\w.]+)`(?:, run by `([^`]+)`)?:$", words[-1]) if words else None
        if kind == "console":
            yield "\n".join(line[2:] for line in body.splitlines() if line.startswith("$ "))
        elif named:
            yield f"cat >{named[1]} <<'END_OF_BLOCK'\n{body}END_OF_BLOCK\n{named[2] or ''}".rstrip()
        elif kind == "sh":
            yield body.rstrip()


def main(arguments):
    if arguments[:1] in (["-h"], ["--help"]):
        return print(__doc__)
    first = int(arguments[0]) if arguments else 1
    lines = ["set -euo pipefail", f"cd '{ROOT}'"]
    for k, step in enumerate(steps((ROOT / "README.md").read_text()), 1):
        if k < first and not step.startswith("export"):
            continue
        lines += [f"echo '== block {k}'", step]
    sys.exit(subprocess.run(["bash", "-c", "\n".join(lines)]).returncode)


if __name__ == "__main__":
    main(sys.argv[1:])
