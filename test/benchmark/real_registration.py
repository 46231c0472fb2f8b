"""Registration of real scans with known poses, by what it is brought to: right, refused, wrong.

usage: PYTHONPATH=build/src/python python3 test/benchmark/real_registration.py FOLDER [--kinds model scan impostor foreign] [--axes] [--seed N] [--rows FILE]

FOLDER/index.json lists scans (file, object, T_object_scan) and pairs: model_pairs and scan_pairs (scan, target, diameter,
T_target_scan), impostor_pairs (scan, target: a model of another object). "foreign" are scans brought to scans of other
objects. Right is within 5 degrees and 5 % of the diameter, up to the motions that map 97 % of the target to within 2 % of the
diameter of itself. Clouds are brought together as the files are, without viewpoints, guess or options.

--axes aligns as the paper does (Section 5.1, Figure 11): the principal symmetry axes of both clouds fall together, with the signs
that bring the points nearest to the target. It has no confidence: each pose counts as accepted.

--rows writes a line of JSON a pair, for fit_registration.py.
"""
import dataclasses
import functools
import json
import pathlib
import time
import types

import numpy as np
import pcl_symmetry
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

import bench

RIGHT_ANGLE, RIGHT_DISTANCE = 5.0, 0.05
MAX_POINTS = 10_000
SYMMETRIC_SHARE, SYMMETRIC_DISTANCE = 0.97, 0.02


def read(path, seed=0):
    """10 000 points of a cloud, or on the surface of a mesh."""
    import open3d

    open3d.utility.set_verbosity_level(open3d.utility.VerbosityLevel.Error)
    random = np.random.default_rng(seed)
    mesh = open3d.io.read_triangle_mesh(str(path)) if path.suffix == ".ply" else open3d.geometry.TriangleMesh()
    if len(mesh.triangles):
        open3d.utility.random.seed(seed)
        return np.asarray(mesh.sample_points_uniformly(MAX_POINTS).points), True
    points = np.asarray(open3d.io.read_point_cloud(str(path)).points)
    points = points[np.isfinite(points).all(axis=1)]
    return points[random.permutation(len(points))[:MAX_POINTS]], False


def nearest_symmetry(S, points, diameter):
    """The motion near S that maps the points onto themselves, by ICP; None if there is none."""
    tree, some = cKDTree(points), points[::4]
    for _ in range(30):
        x = bench.moved(S, some)
        y = points[tree.query(x)[1]]
        R, _ = Rotation.align_vectors(y - y.mean(axis=0), x - x.mean(axis=0))
        S = bench.rigid(R.as_matrix(), y.mean(axis=0) - R.apply(x.mean(axis=0))) @ S
    reach = SYMMETRIC_DISTANCE * diameter + 0.5 * np.quantile(tree.query(points, k=2)[0][:, 1], 0.9)
    return S if (tree.query(bench.moved(S, points))[0] < reach).mean() >= SYMMETRIC_SHARE else None


def is_right(found, truth, target, diameter, may_be_symmetric):
    center = target.mean(axis=0)[None]

    def is_near(a, b):
        angle = np.degrees(Rotation.from_matrix(a[:3, :3] @ b[:3, :3].T).magnitude())
        return angle < RIGHT_ANGLE and np.linalg.norm(bench.moved(a, center) - bench.moved(b, center)) < RIGHT_DISTANCE * diameter

    S = found @ np.linalg.inv(truth)  # what the answer does to the target
    if is_near(S, np.eye(4)):
        return True
    symmetry = nearest_symmetry(S, target, diameter) if may_be_symmetric else None
    return symmetry is not None and is_near(S, symmetry)


@functools.lru_cache(maxsize=None)
def published_frames(path, seed):
    """Transforms to the frame of the paper's own method, with all signs."""
    return pcl_symmetry.frame(read(path, seed)[0], as_published=True, threads=1).equivalent


def by_axes(source, target, source_frames, target_frames):
    tree = cKDTree(target)
    poses = [np.linalg.inv(target_frames[0]) @ T for T in source_frames]
    return min(poses, key=lambda T: np.median(tree.query(bench.moved(T, source[::10]))[0]))


def pairs_of(index, kind):
    if kind != "foreign":
        return index[kind + "_pairs"]
    random, scans = np.random.default_rng(1), index["scans"]
    others = lambda pair: [name for name in scans if scans[name]["object"] != scans[pair["scan"]]["object"]]
    return [{**pair, "scan": random.choice(others(pair))} for pair in index["scan_pairs"]]


def main(arguments):
    folder = pathlib.Path(arguments.folder)
    index = json.loads((folder / "index.json").read_text())
    lines, table = [], []
    for kind in arguments.kinds:
        right, wrong, refused, seconds = bench.Rate(), bench.Rate(), bench.Rate(), []
        for pair in pairs_of(index, kind):
            scan = index["scans"][pair["scan"]]
            files = [folder / file for file in (scan["file"], pair["target"])]
            (source, _), (target, is_mesh) = (read(file, arguments.seed) for file in files)
            start = time.process_time()
            if arguments.axes:
                pose = by_axes(source, target, *(published_frames(file, arguments.seed) for file in files))
                found = types.SimpleNamespace(transform=pose, converged=True, confidence=1.0, evidence=None)
            else:
                found = pcl_symmetry.register(source, target, target_viewpoint=None if is_mesh else "auto", seed=arguments.seed, threads=1)
            seconds.append(time.process_time() - start)
            good = False
            if kind in ("model", "scan"):
                truth = np.array(pair["T_target_scan"])
                truth[:3, :3] = Rotation.from_matrix(truth[:3, :3]).as_matrix()
                good = bool(is_right(found.transform, truth, target, pair["diameter"], is_mesh))
            right.add(found.converged and good)
            wrong.add(found.converged and not good)
            refused.add(not found.converged)
            evidence = dataclasses.asdict(found.evidence) if found.evidence else {}
            lines.append({"kind": kind, "scan": pair["scan"], "object": scan["object"], "seed": arguments.seed, "good": good, "confidence": found.confidence, **evidence})
        table.append([kind, right.text, refused.text, wrong.text, f"{np.median(seconds):.2f}"])
    bench.print_table("Real scans, by what they are brought to", ["", "right", "refused", "wrong", "s"], table)
    if arguments.rows:
        bench.write_whole(arguments.rows, "".join(json.dumps(line) + "\n" for line in lines))


if __name__ == "__main__":
    parser = bench.plain_parser(__doc__)
    parser.add_argument("folder", help="with index.json")
    kinds = ["model", "scan", "impostor", "foreign"]
    parser.add_argument("--kinds", nargs="+", choices=kinds, default=kinds)
    parser.add_argument("--axes", action="store_true", help="align as the paper does, by principal symmetry axes")
    parser.add_argument("--seed", type=int, default=0, help="of the points that are taken, and of the search")
    parser.add_argument("--rows", metavar="FILE", help="a line of JSON for each pair")
    main(parser.parse_args())
