"""What the example 13_distributed.py takes with some numbers of workers, and what a million models would cost.

A row for each number of workers: seconds of the clock while models are described, the share of it that workers spend in
calls of pcl_symmetry_database, the share of as many cores that these use, their processor seconds and those of all else
(Dask, Python, start and end); processor time of a model in them, in a call without Dask for the first 500 models, and in
the merge; seconds of the merge; bytes. What other programs take of the machine is missing in the share of cores alone.

example: distributed.py build/apps models --workers 1,2,4
         distributed.py build/apps models --workers 2 --make 20000 --of PSB   # copies of small meshes, each stretched anew
"""
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import bench

EXAMPLE = Path(__file__).parents[2] / "apps/examples/13_distributed.py"
NUM_ALONE, NUM_MESHES = 500, 200  # models of the call without Dask; meshes that others are made of
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
    try:
        done, milliseconds = bench.timed(subprocess.run, list(map(str, command)), clock=bench.seconds_of_children)
    except OSError as error:
        raise bench.BadInput(f"{command[0]}: cannot be run, {error.strerror}") from None
    if done.returncode not in (0, 1):  # 1 where a model was left out
        raise bench.BadInput(f"{command[0]}: ended with {done.returncode}")
    return milliseconds / 1000


def make_models(source, folder, count):
    paths = sorted(source.glob("*.off"), key=lambda path: (path.stat().st_size, path.name))[:NUM_MESHES]
    if not paths:
        raise bench.BadInput(f"{source}: must be a folder with .off meshes")
    meshes = [bench.read_mesh(path) for path in paths]
    folder.mkdir(exist_ok=True)
    for i in range(count):
        random, mesh = bench.generator(0, i), meshes[i % len(meshes)]
        vertices = mesh.vertices @ bench.random_rotation(random) * random.uniform(0.5, 1, 3)
        with open(folder / f"{i}.off", "w") as file:
            file.write(f"OFF\n{len(vertices)} {len(mesh.triangles)} 0\n")
            np.savetxt(file, vertices, "%.6g")
            np.savetxt(file, mesh.triangles, "3 %d %d %d")


def measure(options):
    if options.make:
        make_models(options.of, options.models, options.make)
    if not options.models.is_dir():
        raise bench.BadInput(f"{options.models}: must be a folder")
    tool = (options.tools / "pcl_symmetry_database").resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        first = sorted(path for path in options.models.rglob("*") if path.is_file())[:NUM_ALONE]
        folder.joinpath("first.txt").write_text("\n".join(map(str, first)))
        alone = used_by([tool, "build", folder / "alone.db", f"@{folder}/first.txt", "-part", "-threads", 1, "-quiet"])
        print("workers  models  seconds  in calls, %  of cores, %  processor s in calls  of all else  ms a model  "
              "without Dask  to merge  s to merge  kB")  # fmt: skip
        for workers in options.workers:
            log, wrapper, database = folder / f"log_{workers}", folder / "tool", folder / f"models_{workers}.db"
            wrapper.write_text(WRAPPER.format(tool=tool, log=log))
            wrapper.chmod(0o755)
            total = used_by([sys.executable, EXAMPLE, options.models, database, "--workers", workers, "--tool", wrapper])
            if not database.exists():
                raise bench.BadInput(f"{options.models}: {EXAMPLE.name} made no database of it")
            calls = [line.split() for line in log.read_text().splitlines()]
            calls = [(what, float(b), float(e), float(u) + float(s)) for what, b, e, u, s in calls]
            begins, ends, used = zip(*(call[1:] for call in calls if call[0] == "build"))
            merging, merge_wall = sum(c[3] for c in calls if c[0] != "build"), sum(c[2] - c[1] for c in calls if c[0] == "merge")
            listed = subprocess.run([tool, "list", database], stdout=subprocess.PIPE, check=True).stdout
            num, wall, used = len(listed.splitlines()), max(ends) - min(begins), sum(used)
            busy, kilobytes = (sum(ends) - sum(begins)) / (workers * wall), database.stat().st_size / 1000 / num
            print(f"{workers:>7} {num:7} {wall:8.1f} {100 * busy:12.1f} {100 * used / (workers * wall):12.1f} {used:21.1f} "
                  f"{total - merging - used:12.1f} {1000 * used / num:11.1f} {1000 * alone / len(first):13.1f} "
                  f"{1000 * merging / num:9.1f} {merge_wall:11.1f} {kilobytes:3.0f}", flush=True)  # fmt: skip
    hours, gigabytes = (used + 0.004 * num) / num * 1e6 / 3600, (kilobytes * num - 28000) / num  # 4 ms to merge
    print(f"a million models, without what does not grow with them (start, fit, 28 MB): {hours:.1f} hours of a core, "
          f"{0.04 * hours:.2f} $ at 0.04 $ an hour; {gigabytes:.0f} GB, {0.08 * gigabytes:.2f} $ a month at 0.08 $ a GB")  # fmt: skip


if __name__ == "__main__":
    parser = bench.plain_parser(__doc__)
    parser.add_argument("tools", type=Path, help="folder of the tools")
    parser.add_argument("models", type=Path, help="folder of models")
    parser.add_argument("--workers", type=bench.numbers(int), default="1,2,4", help="numbers of workers")
    parser.add_argument("--make", type=int, default=0, metavar="N", help="fill the folder with N models first")
    parser.add_argument("--of", type=Path, default=Path(), metavar="DIR", help="folder of the meshes that they are made of")
    bench.main(measure, parser.parse_args())
