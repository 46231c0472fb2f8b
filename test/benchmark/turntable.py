"""Scans of a turntable in one call of register_all(), against poses that are published with them.

turntable.py FOLDER bunny buddha: FOLDER/index.json names of each scan its file, .ply, and T_object_scan. Right is within
1 degree and 1 % of the diameter, in the frame of the first scan that is kept.
"""
import json
import sys
import time
from pathlib import Path

import numpy as np
import open3d
import pcl_symmetry

import bench

parser = bench.plain_parser(__doc__)
parser.add_argument("folder", type=Path)
parser.add_argument("objects", nargs="+")
arguments = parser.parse_args()
if not (arguments.folder / "index.json").exists():
    sys.exit(print(f"skipped: {arguments.folder}/index.json is not there"))
scans = json.loads((arguments.folder / "index.json").read_text())["scans"]
for name in arguments.objects:
    names = [scan for scan in scans if scan.startswith(name + "_")]
    clouds = [np.asarray(open3d.io.read_point_cloud(str(arguments.folder / scans[scan]["file"])).points) for scan in names]
    poses = [np.array(scans[scan]["T_object_scan"]) for scan in names]
    found, ms = bench.timed(pcl_symmetry.register_all, clouds, clock=time.process_time)
    kept = [k for k, transform in enumerate(found.transforms) if transform is not None]
    diameter = np.linalg.norm(np.ptp(np.concatenate([bench.moved(poses[k], clouds[k]) for k in kept]), axis=0))
    wrong = []
    for k in kept:
        truth = np.linalg.inv(poses[kept[0]]) @ poses[k]
        off = found.transforms[k] @ np.linalg.inv(truth)
        angle = np.degrees(np.arccos(np.clip((np.trace(off[:3, :3]) - 1) / 2, -1, 1)))
        center = clouds[k].mean(axis=0)
        way = np.linalg.norm(bench.moved(found.transforms[k], center) - bench.moved(truth, center)) / diameter
        wrong += [names[k]] if angle > 1 or way > 0.01 else []
        print(f"  {names[k]}: {angle:.2f} degrees, {100 * way:.2f} % of the diameter")
    for k, reason in found.left_out.items():
        print(f"  {names[k]}: left out, {reason}")
    print(f"{name}: {len(kept) - len(wrong)} right, {len(found.left_out)} left out, {len(wrong)} wrong of {len(names)}; {ms / 1000:.1f} s")
