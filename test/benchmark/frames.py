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
TIE_ANGLE = 5.0  # degrees: products of reference planes that differ by less are one rotation
ORDERS = Rotation.create_group("O").as_matrix()  # orders and signs of three axes that make a rotation


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


def angle_of_axes(axes, others, revolution=None):
    """Degrees between axes and others in any order and with any sign, at any angle about an axis of revolution."""
    return least_angle(axes @ (others @ ORDERS).swapaxes(1, 2), revolution)


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
    return pcl_symmetry.frame(points, viewpoint=viewpoint, seed=seed, threads=1)


def as_published(points, viewpoint, seed):
    return pcl_symmetry.frame(points, as_published=True, seed=seed, threads=1)


def by_mass(points, viewpoint, seed):
    center = points.mean(axis=0, dtype=float)
    axes = np.linalg.eigh(np.cov((points - center).T))[1][:, ::-1]
    axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
    return Frame(center, axes)


METHODS = {"symmetry": by_symmetry, "as published": as_published, "mass": by_mass}


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
        "center": float(np.linalg.norm(found.center - whole.center)) / diagonal,
        "axes": angle_of_axes(found.axes, whole.axes),
        "tied": ties.angle(found.axes, whole.axes),
    }


def evaluate(model, arguments):
    mesh = bench.read_mesh(model.path)
    ties = Ties(references.find_references(mesh))
    rows, wholes = [], {}
    for view in range(-1, arguments.views):
        points, scan, pose = cloud_of(mesh, model, view, arguments)
        for method in arguments.methods:
            seen = points, scan and scan.viewpoint, arguments.seed + 1
            found, milliseconds = bench.timed(METHODS[method], *seen, clock=time.process_time)  # with center and axes
            back = np.linalg.inv(pose)
            found = Frame(bench.moved(back, found.center), back[:3, :3] @ found.axes)
            errors = judge(found, wholes.setdefault(method, found), mesh.diagonal, ties)
            rows.append({"model": model.name, "view": view, "method": method, **errors, "ms": milliseconds})
    return rows


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
        "like_for_like": rate(scans, "tied"),
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
    rows = [row for each in found for row in each]
    results = {method: summarize(rows, method) for method in arguments.methods}
    num_models, num_scans = (len({r["model"] for r in rows}), sum(r["view"] >= 0 for r in rows) // len(results))
    texts = ("closer_models", "closer_scans", "ratio", "own_scans", "own_wholes", "like_for_like")
    text = lambda cell: "{:.2f} ({:.2f} to {:.2f})".format(*cell) if isinstance(cell, list) else cell.text
    bench.print_table(
        f"Frames of {num_scans} scans of {num_models} models",
        ["", "closer, models", "closer, scans", "times smaller than by mass", "own axes, scans", "own axes, wholes",
         "like for like", "ms"],
        [[m, *(text(r[key]) for key in texts), f"{r['median_ms']:.0f}"] for m, r in results.items()],
    )  # fmt: skip
    print("Closer: to the center of the whole than the center of mass is. Own axes: those that the model was made in,")
    print("in any order and sign. Like for like: those that the method gives the whole, up to symmetries of the mesh.")
    bench.write_json(arguments, {"methods": results, "left_out": left_out, "rows": rows})
    if arguments.figure:
        stem, dot, ending = arguments.figure.rpartition(".")
        centers = draw(rows, results, "center", 100, np.arange(0, 22.0), "distance of the centers, % of the diagonal")
        axes = draw(rows, results, "axes", 1, np.arange(0, 65, 2.5), "angle of the axes in any order and sign, degrees")
        bench.save_figure(f"{stem}_translation{dot}{ending}", centers)
        bench.save_figure(f"{stem}_rotation{dot}{ending}", axes)


def make_parser(description, methods):
    """Parser of the flags that frames.py and registration.py share."""
    parser = bench.make_parser(description, others=False)
    parser.add_argument("--views", type=int, choices=range(1, 9), default=8, help="scans of a model")
    parser.add_argument("--points", type=int, default=10_000, help="of a cloud")
    parser.add_argument("--noise", type=float, default=0.0, help="standard deviation, along rays in scans, in diagonals")
    parser.add_argument("--missing", type=float, default=0.0, help="share of the points taken away, in ten patches")
    names = ",".join(methods)
    parser.add_argument("--methods", type=bench.numbers(str, methods), default=names, help="of " + names)
    return parser


if __name__ == "__main__":
    parser = make_parser(__doc__, METHODS)
    parser.add_argument("--figure", metavar="FILE.png", help="draw FILE_translation.png and FILE_rotation.png")
    asked = parser.parse_args()
    asked.methods = [m for m in METHODS if m in {*asked.methods, "mass"}]
    bench.main(main, asked)
