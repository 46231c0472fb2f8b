"""How many instructions does one thread of the tools take, and in which stages? By callgrind, which counts the same on any day.

Callgrind runs programs as on a processor with AVX2, 50 times slower. Writes inputs and profiles to FOLDER: the demo's cow as a mesh
and scanned from one side, and a cloud of 10 000 points without a plane. Shares of stages are inclusive: one may be part of another.

example: instructions.py build/apps build/instructions
"""
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np

import bench

STAGES = {  # functions, each with what it calls
    "distance transform": r"pcl_symmetry::GaussianEdt::GaussianEdt\(",
    "free space": r"pcl_symmetry::freeSpace\(",
    "transform": r"pcl_symmetry::sampledTransform\(",
    "geometry": r"pcl_symmetry::localGeometry\(",
    "refinement": r"pcl_symmetry::refineSymmetricPoints\(",
    "axes of scan": r"pcl_symmetry::scanAxes\(",
    "on mesh": r"pcl_symmetry::refineOnMesh\(",
    "FLANN": r"pcl_symmetry::FlannSearch::(search|searchWithin|FlannSearch)\(",
}


def write_blob(path, count):
    """Points of a ball with waves that no plane reflects onto each other."""
    random = np.random.default_rng(1)
    points, waves, phases = bench.random_directions(random, count), random.normal(size=(12, 3)), random.uniform(0, 6, 12)
    radius = 1.0 + 0.08 * np.sin(1.5 * points @ waves.T + phases).sum(axis=1, keepdims=True)
    np.savetxt(path, radius * points, "%.6f")


def profile(tools, folder, name, command):
    """Instructions in all, and of each stage."""
    out = folder / f"{name}.callgrind"
    bench.run_tool("/usr/bin", "valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", tools / command[0], *command[1:], "-threads", "1", "-quiet")
    listed = subprocess.run(["callgrind_annotate", "--inclusive=yes", "--threshold=100", out], capture_output=True, text=True, check=True).stdout
    counts = {}  # a function that calls itself is listed twice
    for count, function in re.findall(r"^ *([\d,]+) \([^)]*\) +(?:\?\?\?:)?(.*?)(?: \[.*)?$", listed, re.M):
        counts[function] = max(int(count.replace(",", "")), counts.get(function, 0))
    total = counts["PROGRAM TOTALS"]
    return total, [sum(count for function, count in counts.items() if re.match(stage, function)) for stage in STAGES.values()]


def report(options):
    if not shutil.which("valgrind"):
        raise bench.BadInput("valgrind is not installed")
    tools, folder = Path(options.tools).resolve(), Path(options.folder).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    fetch = Path(__file__).resolve().parents[2] / "apps/fetch_meshes.sh"
    bench.run_tool("/usr/bin", "bash", fetch, folder, "cow")
    mesh, scan, blob = folder / "cow.off", folder / "cow_scan.pcd", folder / "blob.xyz"
    bench.run_tool(tools, "pcl_symmetry_scan", mesh, scan, "-quiet")
    write_blob(blob, 10_000)
    commands = {
        "mesh": ["pcl_symmetry_planes", mesh],
        "scan": ["pcl_symmetry_planes", scan],
        "cloud": ["pcl_symmetry_planes", blob],
        "frame": ["pcl_symmetry_align", mesh, folder / "aligned.pcd"],
        "register": ["pcl_symmetry_align", scan, "-target", mesh],
        "viewpoint": ["pcl_symmetry_viewpoint", mesh],
        "published": ["pcl_symmetry_planes", scan, "-as_published"],
    }
    rows = []
    for name, command in commands.items():
        total, stages = profile(tools, folder, name, command)
        rows.append([name, f"{total / 1e6:.0f}", *(f"{100 * stage / total:.0f} %" if stage else "-" for stage in stages)])
    bench.print_table("Instructions of one thread", ["input", "million", *STAGES], rows)


if __name__ == "__main__":
    parser = bench.plain_parser(__doc__)
    parser.add_argument("tools", help="folder of the tools")
    parser.add_argument("folder", help="for inputs and profiles")
    bench.main(report, parser.parse_args())
