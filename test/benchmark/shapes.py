"""Decisions on shapes made by code, whose symmetries are known.

shapes.py folds --half report       prisms, tubes, rims and cones of 2 to 24 folds, and round bodies, with noise
shapes.py views --half report       round bodies, balls and prisms, seen from one side
shapes.py random --half report      clouds without symmetry
shapes.py composites --half report  two symmetric solids stuck together
shapes.py heads --half report       volumes of heads: noise, a lesion, a side that is cut off, slabs

The two halves have different curves, profiles and random numbers: constants are chosen on one, figures given of the other.
"""
import dataclasses
import math

import numpy as np
import pcl_symmetry

import bench
import planes
import references
import solids

NUM_POINTS = 10_000  # of a cloud
ROUND_BODIES = {"tuning": solids.TUNING_BODIES, "report": ("jar", "goblet", "bowl", "can")}


@dataclasses.dataclass
class Shape:
    """About the z axis. Planes are all its symmetries but those of a round one through the axis."""

    body: str
    mesh: bench.Mesh
    folds: int  # 0: round
    planes: np.ndarray  # rows (n, r)
    between: float = 1.0  # share of the surface that a plane halfway between two folds maps

    @property
    def is_round(self):
        return self.between >= references.MIN_SHARE

    @property
    def is_nearly_round(self):
        return self.between >= references.NEAR_SHARE

    def truth(self, pose):
        """Planes, point and direction of the axis, and center, after a motion."""
        normals = self.planes[:, :3] @ pose[:3, :3].T
        rows = np.c_[normals, self.planes[:, 3] + normals @ pose[:3, 3]]
        return rows, pose[:3, 3], pose[:3, 2], bench.moved(pose, self.mesh.center)


def along(angle):
    return [-math.sin(angle), math.cos(angle), 0.0, 0.0]


def folded_curve(folds, half, random):
    """Those of solids.py (tuning), or a polygon, a star or a gear (report); complex, up to modulus 1, one fold at angle 0."""
    if half == "tuning":
        return solids.folded_curve(folds, random)
    if random.uniform() < 0.4:
        if folds == 2:
            aspect = random.uniform(0.5, 0.8)
            return np.array([1 + aspect * 1j, -1 + aspect * 1j, -1 - aspect * 1j, 1 - aspect * 1j]) / math.hypot(1, aspect)
        radius, at = np.ones(1), np.zeros(1)
    else:
        inner = 1 - random.uniform(0.1, 0.35)
        if random.uniform() < 0.5:
            radius, at = np.array([1, 0.6 if folds == 2 else inner]), np.array([0, 0.5])
        else:  # teeth as wide as the gaps, with flanks
            steps = np.linspace(-0.2, 0.2, max(2, 192 // (4 * folds)))
            radius, at = np.repeat([1, inner], len(steps)), np.r_[steps, steps + 0.5]
    angle = (2 * math.pi * (np.arange(folds)[:, None] + at) / folds).ravel()
    return np.tile(radius, folds) * np.exp(1j * angle)


def folded_shape(body, folds, half, random):
    mesh = solids.folded_body(body, folded_curve(folds, half, random), folds, random)
    rows = [along(math.pi * k / folds) for k in range(folds)]
    rows += [] if "cone" in body else [[0, 0, 1, mesh.center[2]]]
    return Shape(body, mesh, folds, np.array(rows), share(mesh, along(0.5 * math.pi / folds)))


def round_shape(body, random):
    mesh = solids.round_body(body, random)
    across = [0, 0, 1, mesh.center[2]]
    return Shape(body, mesh, 0, np.array([across] if share(mesh, across) >= references.MIN_SHARE else []).reshape(-1, 4))


def share(mesh, plane):
    surface = references.Surface(mesh, references.TOLERANCE, 4000)
    plane = np.array(plane, float)
    plane[3] = (plane[3] - plane[:3] @ mesh.center) / mesh.diagonal
    return float(surface.share(plane, 4000)[0])


def is_near(errors, angle, offset, diagonal):
    return errors[0] <= math.radians(angle) and errors[1] <= offset * diagonal


def symmetries(answers):
    return [planes.plane_row(p) for p in answers["planes"] if p["kind"] == "symmetry"]


def calls(answers):
    return bool(symmetries(answers) or answers["axes"] or answers["centers"])


FOLD_RANGES = {0: "round", 6: "2 to 6 folds", 12: "7 to 12 folds", 24: "13 to 24 folds"}


# Kinds: each gives [(row of the table, column, yes or no)] of cloud number i


def folds(i, arguments, random):
    bodies = ["prism", "tube", "rim", "cone", "open cone", "round"]
    body, noise, thinned = bodies[i % 6], i // 6 % 3, i // 18 % 2 == 1
    num_folds = random.integers(2, 25)
    if body == "round":
        shape = round_shape(random.choice(ROUND_BODIES[arguments.half]), random)
    else:
        shape = folded_shape(body, num_folds, arguments.half, random)
    points, mesh = bench.sample(shape.mesh, NUM_POINTS, random), shape.mesh
    if thinned:  # to a quarter of the density along a direction
        side = (points - mesh.center) @ bench.random_directions(random, 1)[0] / (0.5 * mesh.diagonal)
        points = points[random.uniform(size=len(points)) < 0.25 + 0.75 * np.clip(0.5 * (1 + side), 0, 1)]
    pose = bench.random_pose(random, mesh)
    points = bench.moved(pose, points)
    points += noise * math.sqrt(mesh.areas.sum() / NUM_POINTS) * random.normal(size=points.shape)
    answers = bench.ask(f"folds_{i}", points, None, arguments, max_planes=64)
    size = next(name for most, name in FOLD_RANGES.items() if shape.folds <= most)
    rows = ["all", f"noise of {noise} spacings", size, *["thinned"] * thinned]
    cases = [case for angle in (1, 5) for case in judge_folds(shape, pose, answers, angle)]
    return [(row, *case) for row in rows for case in cases]


def judge_folds(shape, pose, answers, angle):
    """Recall and precision of planes and axes; where planes between folds are nearly symmetries, an axis finds the folds
    and is neither right nor wrong."""
    true, point, direction, center = shape.truth(pose)
    near = lambda errors: is_near(errors, angle, 0.01, shape.mesh.diagonal)
    lines = [planes.line_of(axis) for axis in answers["axes"]]
    is_axis = [near(references.line_from_line(point, direction, *line, center)) for line in lines]
    found, recall, precision = symmetries(answers), f"recall, {angle} deg", f"precision, {angle} deg"
    cases = [(precision, right and shape.is_round) for right in is_axis
             if not right or shape.is_round or not shape.is_nearly_round]  # fmt: skip
    cases += [(precision, False) for _ in answers["centers"]]
    same = lambda a, b: near([v[0] for v in references.offsets_and_angles(a, b, center)])
    for plane in found:
        through = near(references.line_from_plane(plane, point, direction, center))
        right = any(same(t, plane) for t in true) or (through and shape.is_round)
        if right or not through or not shape.is_nearly_round:
            cases.append((precision, right))
    has_axis = any(is_axis) and shape.is_nearly_round
    cases += [(recall, has_axis)] if shape.folds == 0 else []
    cases += [(recall, any(same(t, p) for p in found) or (has_axis and abs(t[:3] @ direction) < 0.5)) for t in true]
    if angle == 5 and not shape.is_nearly_round:
        cases.append(("axis in place of folds", any(is_axis)))
    return cases


def views(i, arguments, random):
    bodies = [*ROUND_BODIES[arguments.half], "ball", "prism"]
    body = bodies[i % len(bodies)]
    if body == "prism":
        shape = folded_shape(body, random.integers(2, 7), arguments.half, random)
    else:
        shape = round_shape(body, random)
    view, pose = bench.random_directions(random, 1)[0], bench.random_pose(random, shape.mesh)
    scan = bench.scan(shape.mesh, view, random, NUM_POINTS, pose=pose)
    answers = bench.ask(f"views_{i}", scan.points, scan.T_cloud_sensor, arguments, max_planes=64)
    family = bool(answers["axes"] or answers["centers"])
    if body == "prism":
        return [("prism", "family of a prism, which has none", family and not shape.is_nearly_round)]
    _, point, direction, center = shape.truth(pose)
    lines = [planes.line_of(axis) for axis in answers["axes"]]
    if body == "ball":
        errors = [(0, np.linalg.norm(np.array(c["point"]) - center)) for c in answers["centers"]]
        errors += [(0, np.linalg.norm(np.cross(center - p, d))) for p, d in lines]
    else:
        errors = [references.line_from_line(point, direction, *line, center) for line in lines]
    slant = math.degrees(math.acos(abs(view[2])))
    side = "any side" if body == "ball" else "along the axis" if slant < 30 else "oblique" if slant < 60 else "across the axis"
    return [(row, *case) for row in ("all", body, side) for case in (
        ("axis or center within 1 deg, 1 %", any(is_near(e, 1, 0.01, shape.mesh.diagonal) for e in errors)),
        ("within 5 deg, 5 %", any(is_near(e, 5, 0.05, shape.mesh.diagonal) for e in errors)),
        ("symmetries, but no family", not family and calls(answers)), ("no symmetry", not calls(answers)))]  # fmt: skip


def filled(count, half, random):
    x = random.uniform(-1, 1, (20 * count, 3))
    x = x if half == "tuning" else x[np.linalg.norm(x, axis=1) < 1]
    return x[:count] * random.uniform(0.2, 1, 3)


def blobs(count, half, random):
    num = 1 if half == "tuning" else 3
    which, widths = random.integers(num, size=count), random.uniform(0.2, 1, (num, 3))
    centers = random.uniform(-2, 2, (num, 3)) * (num > 1)
    return centers[which] + widths[which] * random.normal(size=(count, 3))


def walk(count, half, random):
    """A random walk, which (report) may begin anew at an earlier position."""
    x = np.zeros((count, 3))
    for i in range(1, count):
        start = random.integers(i) if half == "report" and random.uniform() < 0.02 else i - 1
        x[i] = x[start] + random.normal(size=3)
    return x


def sheet(count, half, random, noise=None):
    """Of a random outline; of the report half wavy."""
    k = np.arange(1, 6)
    heights, phases = 0.25 * random.normal(size=5) / k, random.uniform(0, 2 * math.pi, 5)
    wave = random.uniform(-3, 3, 3)
    x = random.uniform(-2, 2, (40 * count + 400, 2))
    radius = 1 + (heights * np.cos(np.arctan2(x[:, 1], x[:, 0])[:, None] * k + phases)).sum(1)
    x = x[np.hypot(*x.T) < np.maximum(0.2, radius)][:count]
    height = (0.05 if half == "report" and noise is None else 0) * np.sin(x @ wave[:2] + wave[2])
    return np.c_[x, height + (0.01 * random.uniform() if noise is None else noise) * random.normal(size=len(x))]


def line(count, half, random):
    """Straight, or (report) bent."""
    t, k = random.uniform(size=(count, 1)), np.arange(1, 4)
    waves = random.normal(size=(3, 3)) * (0.3 / k)[:, None] * (half == "report")
    x = np.c_[t, np.zeros((count, 2))] + np.sin(math.pi * k * t + k - 1) @ waves
    return x + 0.01 * random.uniform() * random.normal(size=x.shape)


def wire(count, half, random):
    """A cubic curve between random positions, or (report) a spiral that opens and climbs."""
    t, p = random.uniform(size=(count, 1)), random.normal(size=(4, 3))
    x = (1 - t) ** 3 * p[0] + 3 * (1 - t) ** 2 * t * p[1] + 3 * (1 - t) * t * t * p[2] + t**3 * p[3]
    if half == "report":
        angle, radius = 2 * math.pi * random.uniform(0.75, 1.75) * t, 0.2 + random.uniform(0.3, 1.3) * t * t
        x = np.c_[radius * np.cos(angle), radius * np.sin(angle), random.uniform(0.3, 1.3) * t]
    return x + 0.01 * random.uniform() * random.normal(size=x.shape)


def table(count, half, random):
    """A flat table of a random outline, and on a part of it boxes or (report) balls."""
    noise, num = 0.004 * random.uniform(), random.integers(3, 6)
    place, size = random.uniform(-0.6, 0.6, (num, 2)), random.uniform(0.1, 0.3, (num, 3))
    which = random.integers(num, size=round(0.3 * count))
    x = random.uniform(-1, 1, (len(which), 3))
    if half == "report":
        x, size = x / np.linalg.norm(x, axis=1, keepdims=True), np.repeat(size[:, :1], 3, axis=1)
    else:
        face = random.integers(3, size=len(x))
        x[np.arange(len(x)), face] = np.where(face == 2, 1, np.sign(x[np.arange(len(x)), face]))
    things = np.c_[place, size[:, 2]][which] + x * size[which] + noise * random.normal(size=x.shape)
    return np.concatenate([sheet(count - len(which), half, random, noise), things])


RANDOM_KINDS = {  # with the least and the greatest number of points
    "fewer than 20 points": (filled, 5, 19), "filled": (filled, 5, 500), "blobs": (blobs, 5, 500), "walk": (walk, 5, 500),
    "sheet": (sheet, 5, 500), "line": (line, 5, 500), "table with objects": (table, 500, 10_000), "wire": (wire, 5, 500),
}  # fmt: skip


def random_clouds(i, arguments, random):
    kind = list(RANDOM_KINDS)[i % len(RANDOM_KINDS)]
    make, low, high = RANDOM_KINDS[kind]
    points = make(round(low * (high / low) ** random.uniform()), arguments.half, random)
    rotation = bench.random_rotation(random)
    answers = bench.ask(f"random_{i}", points @ rotation.T + random.uniform(-1, 1, 3), None, arguments)
    axes, found = [planes.line_of(axis)[1] for axis in answers["axes"]], symmetries(answers)
    is_line = kind == "line" and arguments.half == "tuning" and axes and not found and not answers["centers"]
    is_line = is_line and all(abs(a @ rotation[:, 0]) > math.cos(math.radians(3)) for a in axes)  # its axis is true
    return [(row, *case) for row in ("all", kind) for case in (
        ("called symmetric", calls(answers) and not is_line), ("a plane", bool(found)), ("an axis", bool(axes)),
        ("a center", bool(answers["centers"])), ("a possible plane", len(answers["planes"]) > len(found)))]  # fmt: skip


def composites(i, arguments, random):
    parts = [part(arguments, random) for _ in range(2)]
    rotations, size = [bench.random_rotation(random) for _ in parts], random.uniform(0.6, 1)
    side, scales = bench.random_directions(random, 1)[0], (1.0, size)
    reach = [s * (x @ r.T @ (sign * side)).max() for (x, _), r, s, sign in zip(parts, rotations, scales, (1, -1))]
    places = (np.zeros(3), (sum(reach) - 0.1) * side)
    clouds, true = [], []
    for (x, rows), rotation, scale, place in zip(parts, rotations, scales, places):
        x = x[random.uniform(size=len(x)) < scale * scale]  # as dense as the other part
        clouds.append(scale * x @ rotation.T + place)
        normals = rows[:, :3] @ rotation.T
        true.append(np.c_[normals, scale * rows[:, 3] + normals @ place])
    points = np.concatenate(clouds)
    center, diagonal = 0.5 * (points.min(0) + points.max(0)), np.linalg.norm(np.ptp(points, axis=0))
    answers = bench.ask(f"composites_{i}", points, None, arguments, approximate=True, max_planes=64)
    same = lambda a, b: is_near([v[0] for v in references.offsets_and_angles(a, b, center)], 3, 0.02, diagonal)
    found = [planes.plane_row(p) for p in answers["planes"]]
    local = [planes.plane_row(p) for p in answers["planes"] if p["kind"] not in ("approximate", "possible")]
    has = [[any(same(t, p) for p in found) for t in rows] for rows in true]
    wrong = [not any(same(t, p) for rows in true for t in rows) for p in local]
    cases = [("planes of parts found", yes) for yes in sum(has, [])]
    cases += [("right, of local planes", not no) for no in wrong]
    cases += [("with a plane of each part", all(map(any, has))), ("called symmetric", calls(answers))]
    return [("all", *case) for case in [*cases, ("without a wrong plane", not any(wrong))]]


def part(arguments, random):
    """(points, planes) of a prism or a cone of 2 to 4 folds, centered and of unit diagonal."""
    body = "prism" if random.uniform() < 0.6 else "cone"
    shape = folded_shape(body, random.integers(2, 5), arguments.half, random)
    mesh, rows = shape.mesh, shape.planes
    points = (bench.sample(mesh, NUM_POINTS // 2, random) - mesh.center) / mesh.diagonal
    return points, np.c_[rows[:, :3], (rows[:, 3] - rows[:, :3] @ mesh.center) / mesh.diagonal]


NUM_VOXELS, VOXEL = 64, 3.125  # along an edge of a volume, and their size in millimeters
HEADS = ("whole", "noise", "lesion", "a side cut off", "slab across x", "slab across y", "slab across z")


def body(x, center, radii, power):
    """1 inside an ellipsoid, or between that and its box; (..., 3) positions in millimeters."""
    distance = (np.abs((x - center) / radii) ** power).sum(-1) ** (1 / power) - 1
    return 1 / (1 + np.exp(np.clip(distance * np.mean(radii) / 0.6, -50, 50)))


def head(half, random):
    """A function of positions, symmetric in x = 0: a skull, a nose and bodies in pairs; (report) of other outlines, with
    bodies in the middle."""
    power = 2 if half == "tuning" else 2.6
    skull, parts = random.uniform((60, 75, 65), (70, 85, 75)), []
    for _ in range(4 if half == "tuning" else 6):
        where, size = random.uniform((8, -45, -35), (35, 45, 35)), random.uniform(6, 18, 3)
        parts.append((where * (half == "tuning" or random.uniform() < 0.7, 1, 1), size, random.choice((-1, 1)) * random.uniform(0.2, 0.5)))

    def density(x):
        side = np.abs(x) * (1, 0, 0) + x * (0, 1, 1)
        sum_ = 0.9 * body(x, 0, skull, power) - 0.4 * body(x, 0, skull - 6, power)
        sum_ += 0.6 * body(x, (0, skull[1], -20), (8, 14, 10), power)
        return sum_ + sum(weight * body(side, where, size, power) for where, size, weight in parts)

    return density


def heads(i, arguments, random):
    """Right: within 3 degrees and two voxels. Wrong: neither that nor a plane that maps what the volume holds, without its
    noise, onto itself with a correlation of 0.99."""
    kind = HEADS[i % len(HEADS)]
    density, turn, shift = head(arguments.half, random), bench.random_rotation(random), random.uniform(-4, 4, 3)
    low, high = np.zeros(3, int), np.full(3, NUM_VOXELS)
    if kind == "a side cut off":
        low[0] = random.uniform(20, 60) / VOXEL
    elif kind.startswith("slab"):
        axis = "xyz".index(kind[-1])
        low[axis] = random.integers(18, 34)
        high[axis] = low[axis] + random.integers(12, 28)
    at = VOXEL * (np.stack(np.indices(high - low), axis=-1) + low - NUM_VOXELS / 2)
    exact = lambda at: density((at - shift) @ turn) + (0.4 * body((at - shift) @ turn, (30, -20, 20), 12, 2) if kind == "lesion" else 0)
    volume = exact(at) + (kind != "whole") * random.uniform(0.02, 0.15) * random.normal(size=at.shape[:3])
    found = pcl_symmetry.planes(volume=volume.astype("f"), spacing=(VOXEL,) * 3, origin=VOXEL * (low - NUM_VOXELS / 2), threads=1)
    near = lambda plane: abs(plane.distance(shift)) < 2 * VOXEL and np.linalg.norm(np.cross(plane.normal, turn[:, 0])) < math.sin(math.radians(3))

    def maps(plane):
        images = at - 2 * plane.distance(at.reshape(-1, 3)).reshape(*at.shape[:3], 1) * plane.normal
        is_inside = ((images >= at[0, 0, 0]) & (images <= at[-1, -1, -1])).all(-1)
        pairs = np.stack([exact(at[is_inside]), exact(images[is_inside])])
        return np.corrcoef(pairs[:, pairs.max(0) > 0.2])[0, 1] > 0.99

    right = [plane for plane in found.every if near(plane)]
    return [(row, *case) for row in ("all", kind) for case in (
        ("listed", any(plane.kind in ("symmetry", "possible") for plane in right)), ("decided", any(plane.kind == "symmetry" for plane in right)),
        ("wrong symmetry", any(not near(plane) and not maps(plane) for plane in found)))]  # fmt: skip


KINDS = {"folds": (folds, 144), "views": (views, 180), "random": (random_clouds, 700), "composites": (composites, 40), "heads": (heads, 140)}


def evaluate(i, arguments):
    cases = KINDS[arguments.kind][0](i, arguments, bench.generator(arguments.seed, arguments.half, arguments.kind, i))
    return [(row, column, bool(yes)) for row, column, yes in cases]


def program(arguments):
    count = arguments.num or KINDS[arguments.kind][1]
    results, left_out = bench.run(range(count), evaluate, arguments)
    rates = {}
    for row, column, yes in sum(results, []):
        rates.setdefault(row, {}).setdefault(column, bench.Rate()).add(yes)
    columns = list(dict.fromkeys(column for row in rates.values() for column in row))
    order = sorted(rates, key=lambda row: (row != "all", row))
    table_rows = [[row, *(rates[row].get(column, bench.Rate()).text for column in columns)] for row in order]
    title = f"{arguments.kind}, {arguments.half} half, {len(results)} clouds; 95 % Wilson intervals"
    bench.print_table(title, ["", *columns], table_rows)
    bench.write_json(arguments, {"rates": rates, "left_out": left_out})


if __name__ == "__main__":
    parser = bench.make_parser(__doc__, models=False)
    parser.add_argument("kind", choices=KINDS)
    parser.add_argument("--half", choices=["tuning", "report"], default="tuning", help="half of the shapes")
    parser.add_argument("--num", type=int, help="number of clouds; about two minutes by default")
    bench.main(program, parser.parse_args())
