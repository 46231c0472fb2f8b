"""Groups of rotations of solids made by code, of meshes, and of single scans, and the poses that they make equal.

Without a folder: solids of known groups, in random poses (solids.py), and distances of poses under the groups that
are found. With a folder: groups of clouds of meshes, judged by exact distances on the mesh. With --views: the rotations
that are found in this number of scans of each mesh, judged alike. A rotation is right where it maps at most 10 % of the
area further off the surface than 1 % of the diameter, and at most 1.25 % further than ten times that.

rotations.py --counts 2000,10000
rotations.py PSB --classes train.cla --fold 1
rotations.py PSB --classes train.cla --fold 1 --every 4 --views 2
"""
import dataclasses
import itertools
import time

import numpy as np
import pcl_symmetry
from scipy.spatial.transform import Rotation

import bench
import solids

TOLERANCE, MAX_OFF, MAX_FAR, FAR = 0.01, 0.10, 0.0125, 10  # diameters, shares of the area, shares, tolerances
NUM_ANGLES = 16  # of an axis of revolution, of 1/17 of a turn: no fold divides it
NUM_POSES = 20  # pairs that distances of poses are tried on


def about(point, direction, fold=0):
    """Rotations of a fold about a line, up to half a turn; of fold 0 by any angle."""
    angles = np.arange(1, fold // 2 + 1) / fold if fold else np.arange(1, NUM_ANGLES + 1) / (NUM_ANGLES + 1)
    return [bench.rotation_about(point, direction, 2 * np.pi * angle) for angle in angles]


def motions_of(group):
    """The rotations that pcl_symmetry.Rotations says the shape has."""
    return list(group.discrete) + [motion for axis in group.continuous for motion in about(*axis)]


def excess(mesh, points, motions):
    """By how much the worst motion fails: the greater of its shares over what is allowed of each; <= 1 is right.

    points: of the mesh, spread by area. Both and the motions in the frame of the mesh.
    """
    worst = 0.0
    for motion in motions:
        images = (bench.moved(motion, points) - mesh.center) / mesh.diagonal
        away = mesh.distances(images) * mesh.diagonal / (TOLERANCE * mesh.diameter)
        worst = max(worst, (away > 1).mean() / MAX_OFF, (away > FAR).mean() / MAX_FAR)
    return float(worst)


def in_frame_of(pose, motion):
    """A motion of the moved frame as one of the frame before."""
    return np.linalg.inv(pose) @ motion @ pose


def surface_distance(estimate, truth, points, symmetries):
    """The maximum distance of the surface under the symmetries (MSSD), by its definition."""
    where = bench.moved(estimate, points)
    return min(np.linalg.norm(where - bench.moved(truth @ symmetry, points), axis=1).max() for symmetry in symmetries)


def judge_poses(group, points, random):
    """How the group's distances of poses agree with the definition, and whether tracks go on without a jump.

    Returns the worst errors: of distances, and of an equivalent pose from the first one, in diameters; between the
    matrices of what should be one canonical pose; and by how much a track turns farther than the object.
    """
    size = bench.diameter(points)
    symmetries = [np.eye(4), *group.discrete]
    for point, direction in group.continuous[:1]:
        around = [bench.rotation_about(point, direction, 2 * np.pi * k / 720) for k in range(720)]
        symmetries = [a @ b for a in around for b in symmetries]
    errors = []
    for _ in range(NUM_POSES):
        angle = random.uniform(0, 0.4)
        truth = bench.rigid(bench.random_rotation(random), random.normal(size=3))
        motion = bench.rotation_about(np.zeros(3), bench.random_directions(random, 1)[0], angle)
        symmetry = symmetries[random.integers(len(symmetries))]
        estimate = truth @ motion @ symmetry  # turned a little, and then as the symmetry has it
        exact = surface_distance(estimate, truth, points, symmetries) if group.name != "SO3" else None
        went_on = group.closest_to(estimate, truth)
        errors.append({
            "surface distance": 0.0 if exact is None else abs(group.mssd(estimate, truth, points) - exact) / size,
            "equal poses": group.mssd(truth @ symmetry, truth, points) / size,
            "canonical pose": np.abs(group.canonical(truth @ symmetry) - group.canonical(truth)).max(),
            "track, degrees": np.degrees(Rotation.from_matrix(went_on[:3, :3] @ truth[:3, :3].T).magnitude() - angle),
        })  # fmt: skip
    return worst_of(errors)


def worst_of(errors):
    return {key: max(float(error[key]) for error in errors) for key in errors[0]}


@dataclasses.dataclass
class Trial:
    solid: solids.Solid
    count: int
    noise: float

    @property
    def name(self):
        return f"{self.solid.name}, {self.count} points, noise {self.noise:g}, seed 1"


def find_group(trial, arguments):
    solid = trial.solid
    mesh = bench.make_mesh(solid.vertices, solid.faces)
    random = bench.generator(arguments.seed, trial.name)
    pose = bench.rigid(bench.random_rotation(random))
    points = bench.moved(pose, bench.sample(mesh, trial.count, random))
    points = (points + trial.noise * mesh.diameter * random.normal(size=points.shape)).astype("f")
    group, milliseconds = bench.timed(pcl_symmetry.rotations, points, threads=1, clock=time.process_time)
    on_mesh = bench.sample(mesh, 2000, random)
    wrong = [excess(mesh, on_mesh, [in_frame_of(pose, motion)]) > 1 for motion in motions_of(group)]
    row = {"solid": solid.name, "kind": solid.kind, "group": solid.group, "points": trial.count, "noise": trial.noise}
    row.update(found=group.name, confidence=group.confidence, ms=milliseconds)
    row.update(rotations=len(wrong), false=int(sum(wrong)))
    if trial.noise == 0 and trial.count == arguments.counts[0] and group.name == solid.group:
        row["poses"] = judge_poses(group, points[:: max(1, len(points) // 200)], random)
    return row


def measure_solids(arguments):
    trials = [Trial(*case) for case in itertools.product(solids.solids(), arguments.counts, arguments.noise)]
    rows, left_out = bench.run(trials, find_group, arguments)
    cells = {}
    for row in rows:
        cells.setdefault((row["solid"], row["noise"]), set()).add(row["found"])
    is_right = lambda row: row["found"] == row["group"]
    rates = {"all": bench.Rate(map(is_right, rows))}
    others = [row for row in rows if row["kind"] not in solids.CHOSEN_ON]
    rates["kinds that no number was chosen on"] = bench.Rate(map(is_right, others))
    for count, noise in itertools.product(arguments.counts, arguments.noise):
        some = [row for row in rows if (row["points"], row["noise"]) == (count, noise)]
        rates[f"{count} points, noise of {100 * noise:g} %"] = bench.Rate(map(is_right, some))
    rates["the same group for all numbers of points"] = bench.Rate(len(found) == 1 for found in cells.values())
    num_rotations, num_false = sum(row["rotations"] for row in rows), sum(row["false"] for row in rows)
    rates["false rotations, of all that are found"] = bench.Rate(k < num_false for k in range(num_rotations))
    rates["spheres that are none"] = bench.Rate(row["found"] == "SO3" for row in rows if row["group"] != "SO3")
    bench.print_table("Groups of solids made by code", ["", "rate"], [[k, rate.text] for k, rate in rates.items()])
    wrong = [[r["solid"], r["group"], r["found"], r["points"], r["noise"]] for r in rows if not is_right(r)]
    if wrong:
        bench.print_table("Wrong answers", ["solid", "group", "found", "points", "noise"], wrong)
    poses = {}
    for row in rows:
        if "poses" in row:
            poses.setdefault(row["group"], []).append(row["poses"])
    worst = {group: worst_of(some) for group, some in sorted(poses.items())}
    cells = [[group, *(f"{value:.0e}" for value in errors.values())] for group, errors in worst.items()]
    names = list(next(iter(worst.values()), []))
    bench.print_table("Poses that symmetry makes equal: worst errors, distances in diameters", ["group", *names], cells)
    bench.write_json(arguments, {"rates": rates, "poses": worst, "left_out": left_out, "rows": rows})


def judge_mesh(model, arguments):
    """Groups of clouds of the whole mesh."""
    mesh = bench.read_mesh(model.path)
    random = bench.generator(arguments.seed, model.key)
    pose = bench.random_pose(random, mesh)
    clouds = {count: bench.moved(pose, bench.sample(mesh, count, random)).astype("f") for count in arguments.counts}
    found = {count: pcl_symmetry.rotations(points, threads=1) for count, points in clouds.items()}
    group = found[10_000 if 10_000 in found else arguments.counts[0]]
    row = {"mesh": model.name, "group": group.name, "confidence": group.confidence}
    motions = [in_frame_of(pose, motion) for motion in motions_of(group)]
    row["excess"] = excess(mesh, bench.sample(mesh, 5000, random), motions) if motions else None
    return {**row, "names": [g.name for g in found.values()]}


def judge_scans(model, arguments):
    """Rotations that are found in scans from random sides."""
    mesh = bench.read_mesh(model.path)
    points = bench.sample(mesh, 5000, bench.generator(arguments.seed, model.key))
    rows = []
    for view in range(arguments.views):
        random = bench.generator(arguments.seed, model.key, view)
        pose = bench.random_pose(random, mesh)
        scan = bench.scan(mesh, bench.random_directions(random, 1)[0], random, pose=pose)
        found = pcl_symmetry.planes(scan.rows.astype("f"), viewpoint=scan.viewpoint, threads=1)
        for turn in found.rotations:
            motions = about(turn.point, turn.direction, turn.fold)
            worst = excess(mesh, points, [in_frame_of(pose, motion) for motion in motions])
            row = {"mesh": model.name, "view": view, "fold": turn.fold}
            rows.append({**row, "confidence": turn.confidence, "excess": worst})
    return rows


def measure_meshes(arguments):
    scans = arguments.views > 0
    results, left_out = bench.run(bench.list_models(arguments), judge_scans if scans else judge_mesh, arguments)
    rows = [row for some in results for row in some] if scans else results
    judged = [row for row in rows if row["excess"] is not None]
    confidence, right = [r["confidence"] for r in judged], [r["excess"] <= 1 for r in judged]
    reliability = bench.calibration(confidence, right)
    rates = {}
    for low, high in ((0.9, 1.01), (0.5, 0.9), (0.5, 1.01), (0.0, 0.5)):
        within = [r for c, r in zip(confidence, right) if low <= c < high]
        rates[f"right, confidence of {low:g} to {min(1, high):g}"] = bench.Rate(within)
    if not scans:
        names = [set(row["names"]) for row in rows]
        rates["the same group for all numbers of points"] = bench.Rate(len(n) == 1 for n in names)
        rates["the same, of meshes with a rotation"] = bench.Rate(len(n) == 1 for n in names if n != {"C1"})
    what = "Rotations of scans" if scans else "Groups of meshes"
    bench.print_table(what, ["", "rate"], [[k, rate.text] for k, rate in rates.items()])
    text = "{answers} answers: calibration error {error:.3f} ({by_chance:.3f} by chance), Brier score {brier:.3f}"
    print(text.format(**reliability))
    bench.write_json(arguments, {"rates": rates, "reliability": reliability, "left_out": left_out, "rows": rows})


if __name__ == "__main__":
    parser = bench.make_parser(__doc__, others=False)
    parser.add_argument("--counts", type=bench.numbers(int), default="2000,10000,50000", help="points of the clouds")
    parser.add_argument("--noise", type=bench.numbers(float), default="0,0.003", help="of solids, in diameters")
    parser.add_argument("--views", type=int, default=0, help="judge the rotations found in this number of scans of each mesh")
    asked = parser.parse_args()
    bench.main(measure_meshes if asked.models else measure_solids, asked)
