#!/usr/bin/env python3
"""Canonical frames of scans against those of the whole models (Section 5.1 of the paper, Figure 12).

A model is scanned from the corners of a cube. The frame of each scan is compared with that which the same method finds
for the whole model, and with the axes that the model was made in. Right is within 5 degrees.

frames.py PSB --classes train.cla --fold 1 --every 8 --views 4 --figure misalignment.png
"""

import dataclasses
import time

import numpy as np
import pcl_symmetry
from scipy.spatial.transform import Rotation

import bench
import references

RIGHT_ANGLE = 5.0  # degrees
PUSH = 0.15  # of the radius of a scan: about as far as its hidden half moves the center of mass
TIE_ANGLE = 5.0  # degrees: products of reference planes that differ by less are one rotation
ORDERS = Rotation.create_group("O").as_matrix()  # orders and signs of three axes that make a rotation
HALF_TURNS = [np.diag(signs) for signs in ((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1))]


# How far frames differ


def least_angle(rotations, axis=None):
    """Degrees of the smallest of (..., 3, 3) rotations, each followed by any rotation about the axis."""
    rotations = np.asarray(rotations).reshape(-1, 3, 3)
    trace = np.trace(rotations, axis1=1, axis2=2)
    if axis is not None:
        along = np.einsum("i,kij,j->k", axis, rotations, axis)
        skew = (rotations - rotations.swapaxes(1, 2))[:, [1, 2, 0], [2, 0, 1]] @ axis
        trace = along + np.hypot(trace - along, skew)
    return float(np.degrees(np.arccos(np.clip((trace.max() - 1) / 2, -1, 1))))


@dataclasses.dataclass
class Frame:
    center: np.ndarray
    axes: np.ndarray  # columns
    equivalent: list  # axes of the frames that are equally good, these among them
    revolution: int = -1  # column that is an axis of revolution; -1: none, 3: all are

    def moved(self, motion):
        axes, *equivalent = [motion[:3, :3] @ axes for axes in [self.axes, *self.equivalent]]
        return Frame(bench.moved(motion, self.center), axes, equivalent, self.revolution)


def angle_of_axes(axes, others, revolution=None):
    """Degrees between axes and others in any order and with any sign, at any angle about an axis of revolution."""
    return least_angle(axes @ (others @ ORDERS).swapaxes(1, 2), revolution)


def angle_of_frames(axes, whole):
    """Degrees between axes as they stand and those of a frame or one that is equally good."""
    if whole.revolution == 3:
        return 0.0
    about = lambda other: other[:, whole.revolution] if whole.revolution >= 0 else None
    return min(least_angle(axes @ other.T, about(other)) for other in whole.equivalent)


def own_revolution(whole):
    """The axis of revolution of a frame where it is one of the axes that the model was made in, (3,)."""
    if whole.revolution not in (0, 1, 2):
        return None
    cosines = np.abs(whole.axes[:, whole.revolution])
    return np.eye(3)[cosines.argmax()] if cosines.max() > np.cos(np.radians(RIGHT_ANGLE)) else None


class Ties:
    """Rotations that take the axes of a frame, without order and signs, to others that no symmetry tells from them."""

    def __init__(self, symmetries):
        """symmetries: of the mesh, found by brute force (references.py)."""
        axes = symmetries["axes"]
        self.all = bool(symmetries["centers"]) or len(axes) > 1
        self.axis = np.array(axes[0]["direction"]) if len(axes) == 1 else None
        # Axes have no signs: a reflection does to them what the half turn about its normal does.
        normals = [np.array(plane["coefficients"][:3]) for plane in symmetries["planes"]]
        if self.axis is not None:
            normals.append(np.linalg.svd(self.axis[None])[2][1])
        half_turns = [2 * np.outer(n, n) - np.eye(3) for n in normals]
        self.rotations = [np.eye(3)]
        for rotation in self.rotations:  # grows while it is walked through
            for half_turn in half_turns:
                product = half_turn @ rotation
                known = min(least_angle(product @ other.T) for other in self.rotations) < TIE_ANGLE
                if not known and len(self.rotations) < 120:  # an icosahedron has 60
                    self.rotations.append(product)

    def angle(self, axes, others):
        """Degrees between axes and others in any order and with any sign, up to these rotations."""
        if self.all:
            return 0.0
        tied = np.einsum("kij,jm,lmn->klin", self.rotations, others, ORDERS)
        return least_angle(tied @ axes.T, self.axis)


# Methods: functions of points, viewpoint (None for whole models) and seed


def by_symmetry(points, viewpoint, seed):
    found = pcl_symmetry.frame(points, viewpoint=None if viewpoint is None else tuple(viewpoint), seed=seed, threads=1)
    return Frame(found.center, found.axes, list(found.equivalent[:, :3, :3].swapaxes(1, 2)), found.revolution_axis)


def unsigned(center, axes):
    return Frame(center, axes, [axes @ signs for signs in HALF_TURNS])


def as_published(points, viewpoint, seed):
    found = pcl_symmetry.frame(points, as_published=True, seed=seed, threads=1)
    return unsigned(found.center, found.axes)


def by_mass(points, viewpoint, seed):
    center = points.mean(axis=0, dtype=float)
    axes = np.linalg.eigh(np.cov((points - center).T))[1][:, ::-1]
    axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
    return unsigned(center, axes)


def by_pushed_mass(points, viewpoint, seed):
    """The center of mass of a scan pushed away from the scanner."""
    frame = by_mass(points, viewpoint, seed)
    if viewpoint is not None:
        away = frame.center - viewpoint
        frame.center = frame.center + PUSH * 0.5 * bench.diameter(points) * away / np.linalg.norm(away)
    return frame


METHODS = {
    "symmetry": by_symmetry,
    "no free space": lambda points, viewpoint, seed: by_symmetry(points, None, seed),
    "as published": as_published,
    "mass": by_mass,
    "pushed mass": by_pushed_mass,
}


# Evaluation


def cloud_of(mesh, model, view, arguments, clean=False):
    """(points, scan or None, T_cloud_model) of a scan, or of the whole model, view -1, in a random pose."""
    random, count = bench.generator(arguments.seed, model.key, view), arguments.points
    noise, missing = (0.0, 0.0) if clean else (arguments.noise, arguments.missing)
    pose, scan = bench.random_pose(random, mesh), None
    if view < 0:
        points = bench.moved(pose, bench.sample(mesh, count, random))
        points = points + noise * mesh.diagonal * random.normal(size=points.shape)
    else:
        scan = bench.scan(mesh, bench.CUBE_CORNERS[view], random, count, noise, pose)
        points = scan.rows
    return bench.without_patches(points, missing, random).astype("f"), scan, pose


def judge(found, whole, diagonal, ties):
    """Errors of a frame; both in the frame of the model. Angles in degrees."""
    return {
        "own": angle_of_axes(found.axes, np.eye(3)),
        "own_turned": 0.0 if whole.revolution == 3 else angle_of_axes(found.axes, np.eye(3), own_revolution(whole)),
        "center": float(np.linalg.norm(found.center - whole.center)) / diagonal,
        "axes": angle_of_axes(found.axes, whole.axes),
        "frame": angle_of_frames(found.axes, whole),
        "tied": ties.angle(found.axes, whole.axes),
    }


def judged_answer(folder, name):
    """The frame that another program found: `center` and `axes`, as `pcl_symmetry_align -json` writes them."""
    answer = bench.read_answer(folder, name, center=3, axes=(3, 3))
    if answer is None:
        raise bench.BadInput(f"{folder}/{name}.json: is missing")
    return unsigned(answer["center"], answer["axes"].T)


def evaluate(model, arguments):
    mesh = bench.read_mesh(model.path)
    ties = Ties(references.references_of(model, mesh, arguments.references))
    rows, wholes, truths = [], {}, {}
    for view in range(-1, arguments.views):
        points, scan, pose = cloud_of(mesh, model, view, arguments)
        name = f"{model.name}_{'whole' if view < 0 else view}"
        if arguments.export:
            bench.write_cloud(f"{arguments.export}/{name}.pcd", points, scan and scan.T_cloud_sensor)
            truths[name] = {"model": model.name, "T_cloud_model": pose.tolist(), "diagonal": mesh.diagonal}
        for method in arguments.methods:
            start = time.process_time()
            if method == "judged":
                found = judged_answer(arguments.judge, name)
            else:
                found = METHODS[method](points, scan and scan.viewpoint, arguments.seed + 1)
            milliseconds = 1000 * (time.process_time() - start)
            found = found.moved(np.linalg.inv(pose))
            errors = judge(found, wholes.setdefault(method, found), mesh.diagonal, ties)
            rows.append({"model": model.name, "view": view, "method": method, **errors, "ms": milliseconds})
    return {"rows": rows, "truths": truths}


def summarize(rows, method):
    mine = [row for row in rows if row["method"] == method]
    scans, wholes = [r for r in mine if r["view"] >= 0], [r for r in mine if r["view"] < 0]
    mass = [row for row in rows if row["method"] == "mass" and row["view"] >= 0]
    names = [row["model"] for row in wholes]
    center = lambda rows: np.array([[r["center"] for r in rows if r["model"] == name] for name in names])
    errors, by_mass = center(scans), center(mass)
    rate = lambda rows, key: bench.Rate(r[key] < RIGHT_ANGLE for r in rows)
    # The ratio of the mean errors, and its interval: models drawn anew with all their scans.
    drawn = np.random.default_rng(1).integers(len(names), size=(1000, len(names)))
    ratios = by_mass.mean(axis=1)[drawn].sum(axis=1) / errors.mean(axis=1)[drawn].sum(axis=1)
    return {
        "closer_models": bench.Rate(errors.mean(axis=1) < by_mass.mean(axis=1)),
        "closer_scans": bench.Rate((errors < by_mass).ravel()),
        "ratio": [by_mass.mean() / errors.mean(), *np.quantile(ratios, [0.025, 0.975])],
        "own_scans": rate(scans, "own"),
        "own_wholes": rate(wholes, "own"),
        "own_wholes_turned": rate(wholes, "own_turned"),
        "like_for_like": rate(scans, "tied"),
        "frames": rate(scans, "frame"),
        "median_ms": float(np.median([row["ms"] for row in scans])),
    }


def draw(rows, methods, key, scale, bins, label):
    """Shares of the scans by misalignment, with bands of 95 % intervals (Figure 12)."""

    def histograms(axes):
        for method in methods:
            values = [scale * r[key] for r in rows if r["method"] == method and r["view"] >= 0]
            counts = np.histogram(np.minimum(values, bins[-1] - 1e-9), bins)[0]
            low, high = np.transpose([bench.wilson(int(count), len(values)) for count in counts])
            middles = 0.5 * (bins[1:] + bins[:-1])
            (line,) = axes.plot(middles, 100 * counts / len(values), label=method)
            axes.fill_between(middles, 100 * low, 100 * high, alpha=0.2, color=line.get_color(), linewidth=0)
        axes.set(xlabel=f"{label} (last bin: and more)", ylabel="share of the scans, %")
        axes.set(xlim=(0, bins[-1]), ylim=(0, None))
        axes.legend()

    return histograms


def main(arguments):
    found, left_out = bench.run(bench.list_models(arguments), evaluate, arguments)
    rows = [row for each in found for row in each["rows"]]
    bench.write_truth(arguments, {name: truth for each in found for name, truth in each["truths"].items()})
    results = {method: summarize(rows, method) for method in arguments.methods}
    num_models, num_scans = (len({r["model"] for r in rows}), sum(r["view"] >= 0 for r in rows) // len(results))
    texts = ("closer_models", "closer_scans", "ratio", "own_scans", "own_wholes", "own_wholes_turned", "like_for_like")
    text = lambda cell: "{:.2f} ({:.2f} to {:.2f})".format(*cell) if isinstance(cell, list) else cell.text
    bench.print_table(
        f"Frames of {num_scans} scans of {num_models} models",
        ["", "closer, models", "closer, scans", "times smaller than by mass", "own axes, scans", "own axes, wholes",
         "the same at any angle about an axis", "like for like", "ms"],
        [[m, *(text(r[key]) for key in texts), f"{r['median_ms']:.0f}"] for m, r in results.items()],
    )  # fmt: skip
    print("Closer: to the center of the whole than the center of mass is. Own axes: those that the model was made in,")
    print("in any order and sign. Like for like: those that the method gives the whole, up to symmetries of the mesh.")
    bench.write_json(arguments, {"methods": results, "left_out": left_out, "rows": rows})
    if arguments.figure:
        drawn = [m for m in ("symmetry", "as published", "mass", "pushed mass") if m in results]
        stem, dot, ending = arguments.figure.rpartition(".")
        centers = draw(rows, drawn, "center", 100, np.arange(0, 22.0), "distance of the centers, % of the diagonal")
        drawn = [m for m in drawn if m != "pushed mass"]  # its axes are those of mass
        axes = draw(rows, drawn, "axes", 1, np.arange(0, 65, 2.5), "angle of the axes in any order and sign, degrees")
        bench.save_figure(f"{stem}_translation{dot}{ending}", centers)
        bench.save_figure(f"{stem}_rotation{dot}{ending}", axes)


def make_parser(description, methods):
    """Parser of the flags that frames.py and registration.py share."""
    parser = bench.make_parser(description)
    parser.add_argument("--views", type=int, choices=range(1, 9), default=8, help="scans of a model")
    parser.add_argument("--points", type=int, default=10_000, help="of a cloud")
    parser.add_argument("--noise", type=float, default=0.0, help="standard deviation, along rays in scans, in diagonals")
    parser.add_argument("--missing", type=float, default=0.0, help="share of the points taken away, in ten patches")
    parser.add_argument("--references", metavar="DIR", help="keep the symmetries of the meshes here: a second each")
    names = ",".join(methods)
    parser.add_argument("--methods", type=bench.numbers(str, methods), default=names, help="of " + names)
    return parser


if __name__ == "__main__":
    parser = make_parser(__doc__, METHODS)
    asked = parser.parse_args()
    asked.methods = [m for m in METHODS if m in {*asked.methods, "mass"}] if not asked.judge else ["judged", "mass"]
    bench.main(main, asked)
