#!/usr/bin/env python3
"""Describes a folder of models on many cores or machines, and builds one database of them.

Workers of Dask store a few models at a time in a file of their own, a part, with pcl_symmetry_database; the parts become
one database at the end. A part appears when it is whole: where a worker dies, Dask gives its models to another one, and
where the run is interrupted, the same command goes on with the parts that are missing.

example: 13_distributed.py models models.db --workers 8
         13_distributed.py models models.db --workers 64 --slurm=--partition=cpu  # from a folder that all machines share
         13_distributed.py models models.db --scheduler tcp://host:8786
"""
import argparse
import contextlib
import hashlib
import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
from pathlib import Path

from dask.distributed import Client, LocalCluster, as_completed

KINDS = {".pcd", ".ply", ".obj", ".stl", ".off", ".xyz", ".glb", ".txt", ".csv", ".pts", ".asc"}


def describe(tool, files, part):
    """Runs on a worker. Returns the models that were left out and why."""
    with tempfile.TemporaryDirectory() as folder:  # on a disk of the worker: SQLite needs its locks
        made, listed, report = (os.path.join(folder, name) for name in ("part.db", "files.txt", "report.json"))
        Path(listed).write_text("\n".join(files))
        # Dask tells malloc to give memory back at once, which would cost a fifth of the time.
        environment = {name: value for name, value in os.environ.items() if name != "MALLOC_TRIM_THRESHOLD_"}
        run = subprocess.run([tool, "build", made, f"@{listed}", "-part", "-threads", "1", "-quiet", "-json", report],
                             stderr=subprocess.PIPE, text=True, check=False, env=environment)
        if not os.path.exists(report):
            raise RuntimeError(f"{socket.gethostname()}: {tool}: {run.stderr.strip() or run.returncode}")
        if os.path.exists(made):
            os.replace(shutil.copyfile(made, f"{part}.{socket.gethostname()}.{os.getpid()}"), part)
        return json.loads(Path(report).read_text())["failures"]


def parts_of(models, folder, size):
    """The files of each part. Its name says which files, so that a part of other files is never taken for it."""
    files = sorted(path for path in models.resolve().rglob("*") if path.suffix.lower() in KINDS and path.is_file())
    known, parts = {}, {}
    for file in files:
        if known.setdefault(file.stem, file) != file:
            sys.exit(f"{file}: has the name of {known[file.stem]}, names must differ")
    for some in (files[first : first + size] for first in range(0, len(files), size)):
        text = "".join(f"{path} {path.stat().st_size} {path.stat().st_mtime_ns}\n" for path in some)
        parts[f"{folder}/{hashlib.sha1(text.encode()).hexdigest()}.db"] = [str(path) for path in some]
    return parts


@contextlib.contextmanager
def cluster_of(options):
    if options.scheduler:
        yield options.scheduler
        return
    here = dict(n_workers=options.workers, threads_per_worker=1)
    if options.slurm is not None:  # all addresses of this machine: its name may be one of its own alone
        here = dict(n_workers=0, host="0.0.0.0")
    with LocalCluster(dashboard_address=None, **here) as cluster:
        if options.slurm is None:
            yield cluster
            return
        worker = f"dask worker {cluster.scheduler_address} --nthreads 1 --no-dashboard --death-timeout 600"
        jobs = ["sbatch", "--parsable", f"--array=1-{options.workers}", "--cpus-per-task=1", *options.slurm.split()]
        number = subprocess.run([*jobs, f"--wrap={worker}"], stdout=subprocess.PIPE, text=True, check=True).stdout
        try:
            yield cluster
        finally:  # also those that have not begun
            subprocess.run(["scancel", number.split(";")[0].strip()], check=False)


def describe_all(options, parts):
    num_done, failures, lost = 0, [], []
    with cluster_of(options) as cluster, Client(cluster) as client:
        futures = {client.submit(describe, options.tool, files, part, pure=False): part for part, files in parts.items()}
        for future in as_completed(futures):
            try:  # waits again where the worker died with its answer
                failures += future.result()
                num_done += 1
            except Exception as error:  # the tool could not run there, or several workers died of this part
                lost.append(f"{futures[future]}: {error}\n")
            print(f"\r{num_done} of {len(parts)} parts", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    if lost:
        sys.exit(f"{''.join(lost)}the same command goes on with what is missing")
    return failures


def merge(options, folder, parts):
    """Returns the names of the models."""
    if not parts:
        return set()
    Path(folder, "parts.txt").write_text("\n".join(parts))
    run = subprocess.run([options.tool, "merge", options.database, f"@{folder}/parts.txt", "-quiet"], check=False)
    if run.returncode != 0:
        sys.exit(f"{options.database}: could not be made of the parts, which stay in {folder}")
    run = subprocess.run([options.tool, "list", options.database], stdout=subprocess.PIPE, text=True, check=True)
    shutil.rmtree(folder)
    return set(run.stdout.splitlines())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", type=Path, help="folder with the files of the models, also in folders of it")
    parser.add_argument("database", type=Path, help="new file; the parts lie in DATABASE.parts until it is whole")
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="number of processes, one core each")
    parser.add_argument("--slurm", metavar="OPTIONS", help="each worker is a job of Slurm: options of sbatch, or ''")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask that runs already, with its own workers")
    parser.add_argument("--models-per-part", type=int, default=50)
    parser.add_argument("--tool", default="pcl_symmetry_database", help="program on the workers")
    options = parser.parse_args()
    folder = f"{options.database.resolve()}.parts"
    if options.database.exists():
        sys.exit(f"{options.database}: exists, must be a new file")
    parts = parts_of(options.models, folder, options.models_per_part)
    if not parts:
        sys.exit(f"{options.models}: holds no models")
    os.makedirs(folder, exist_ok=True)
    missing = {part: files for part, files in parts.items() if not os.path.exists(part)}
    failures = describe_all(options, missing) if missing else []
    stored = merge(options, folder, [part for part in parts if os.path.exists(part)])
    reasons = {failure["name"]: failure["reason"] for failure in failures}
    left_out = [file for files in parts.values() for file in files if Path(file).stem not in stored]
    for file in left_out:
        print(f"left out: {file}: {reasons.get(Path(file).stem, 'cannot be used')}", file=sys.stderr)
    return 1 if left_out else 0


if __name__ == "__main__":
    sys.exit(main())
