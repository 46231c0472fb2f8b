#!/usr/bin/env python3
"""What the example 13_distributed.py takes with some numbers of workers, and what a million models would cost.

A row for each number of workers: seconds of the clock while models are described, the share of it that workers spend in
calls of pcl_symmetry_database, processor seconds of these calls and of all else (Dask, Python, start and end), processor
time of a model in them, in one call for all models without Dask, and of its part of the merge, and bytes. Processor times
and shares hold on a machine that does other work too.

example: distributed.py build/apps models --workers 1,2,4
"""
import argparse
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

EXAMPLE = Path(__file__).parents[2] / "apps/examples/13_distributed.py"
WRAPPER = """#!/bin/bash
exec 3>&1 4>&2
TIMEFORMAT='%U %S'
begin=$EPOCHREALTIME
used=$({{ time {tool} "$@" >&3 2>&4; }} 2>&1)
code=$?
echo "$1 $begin $EPOCHREALTIME $used" >>{log}
exit $code
"""


def used_by(command):
    """Processor seconds of a command and of all that it started."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(list(map(str, command)), check=False)  # 1 where a model was left out
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return sum(after[:2]) - sum(before[:2])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tools", type=Path, help="folder of the tools")
    parser.add_argument("models", type=Path, help="folder of models")
    parser.add_argument("--workers", default="1,2,4", help="numbers of workers")
    options = parser.parse_args()
    tool = (options.tools / "pcl_symmetry_database").resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        alone = used_by([tool, "build", folder / "alone.db", options.models, "-part", "-threads", 1, "-quiet"])
        print("workers  models  seconds  in calls, %  processor s in calls  of all else  ms a model  without Dask  to merge  kB")
        for workers in options.workers.split(","):
            log, wrapper, database = folder / f"log_{workers}", folder / "tool", folder / f"models_{workers}.db"
            wrapper.write_text(WRAPPER.format(tool=tool, log=log))
            wrapper.chmod(0o755)
            total = used_by([sys.executable, EXAMPLE, options.models, database, "--workers", workers, "--tool", wrapper])
            calls = [line.split() for line in log.read_text().splitlines()]
            builds = [(float(b), float(e), float(u) + float(s)) for what, b, e, u, s in calls if what == "build"]
            merging = sum(float(u) + float(s) for what, _, _, u, s in calls if what in ("merge", "list"))
            begins, ends, used = zip(*builds)
            wall, used = max(ends) - min(begins), sum(used)
            listed = subprocess.run([tool, "list", database], stdout=subprocess.PIPE, check=True).stdout
            num = len(listed.splitlines())
            busy = (sum(ends) - sum(begins)) / (int(workers) * wall)
            kilobytes = database.stat().st_size / 1000 / num
            print(f"{workers:>7} {num:7} {wall:8.1f} {100 * busy:12.1f} {used:20.1f} {total - merging - used:12.1f} "
                  f"{1000 * used / num:11.1f} {1000 * alone / num:13.1f} {1000 * merging / num:9.1f} {kilobytes:3.0f}", flush=True)
    hours, gigabytes = (used + 0.004 * num) / num * 1e6 / 3600, (kilobytes * num - 14000) / num  # 4 ms to merge
    print(f"a million models, without what does not grow with them (start, fit, 14 MB): {hours:.1f} hours of a core, "
          f"{0.04 * hours:.2f} $ at 0.04 $ an hour; {gigabytes:.0f} GB, {0.08 * gigabytes:.2f} $ a month at 0.08 $ a GB")


if __name__ == "__main__":
    main()
