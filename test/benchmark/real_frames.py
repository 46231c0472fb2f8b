"""Symmetries of real things in frames of a Kinect and of a LiDAR.

real_frames.py kinect data             data: a clone of github.com/PointCloudLibrary/data
real_frames.py lidar SUSTechPOINTS     SUSTechPOINTS: a clone of github.com/naurril/SUSTechPOINTS

kinect: the learn frames of segmentation/mOSD, in which people labeled boxes and cylinders on a table. References are the
middle planes of boxes and the axes of cylinders, fitted to the labeled points. Each object is given alone, with its rows
and columns, by its label in the frame, and in the whole frame, where the object found counts that overlaps the label
the most, by half and more.
lidar: vehicles in the frames 000950 and 000965, in boxes that people drew: the reference is the middle plane along the
vehicle. The points in a box are given with the viewpoint of the sensor and the ground, and without.
Right is what lies within 5 degrees and 3 % of the extent of the object (vehicles: 4 %). --export writes the
clouds; --judge reads NAME.json or NAME.txt of each cloud, and of a frame NAME.json with {"objects": [{"planes": [],
"axes": [], "pixels": [positions in the frame]}]}. Other frames of both are kept apart, for tests.
"""
import functools
import json
import math
import pathlib
import subprocess
import tempfile

import numpy as np
from scipy.spatial.transform import Rotation

import bench
import planes
import references
import scenes

LEARN_BOXES, LEARN_CYLINDERS = range(25), range(33, 45)  # 25 to 32 show parts of objects
VEHICLE_FRAMES = ("000950", "000965")
MAX_ANGLE = math.radians(5)
SURE = 0.8  # confidence from which answers are counted by themselves: no number of the library is fitted to these frames


def show(repository, path):
    """Bytes of a file in a git folder."""
    done = subprocess.run(["git", "-C", repository, "show", f"HEAD:{path}"], capture_output=True)
    if done.returncode:
        raise bench.BadInput(f"{repository}: holds no {path}")
    return done.stdout


def read_sweep(repository, path):
    """(N, 3) points of a binary PCD file in a git folder, whose rows begin with x, y and z. (Open3D 0.16 ends at its
    empty fields.)"""
    header, _, rows = show(repository, path).partition(b"DATA binary\n")
    fields = {words[0]: words[1:] for words in map(str.split, header.decode().splitlines())}
    size = sum(int(bytes_) * int(count) for bytes_, count in zip(fields["SIZE"], fields["COUNT"]))
    step = len(rows) // int(fields["POINTS"][0]) if size * int(fields["POINTS"][0]) > len(rows) else size
    rows = np.frombuffer(rows, np.uint8)[: step * int(fields["POINTS"][0])].reshape(-1, step)
    points = rows[:, :12].copy().view("<f4").astype(float)
    return points[np.isfinite(points).all(1)]


def fit_plane(points):
    """(n, offset) with n.x = offset and n toward the camera at the origin."""
    mean = points.mean(0)
    n = np.linalg.eigh(np.cov((points - mean).T))[1][:, 0]
    n = -n if n @ mean > 0 else n
    return n, n @ mean


def ransac(count, draw, score):
    """The best of `count` drawn models; draw() may give None."""
    tried = [(score(model), i, model) for i, model in enumerate(draw() for _ in range(count)) if model is not None]
    return max(tried, default=(0, 0, None))


def support_plane(points, random):
    """The plane that most points lie on, within 8 mm."""

    def draw():
        a, b, c = points[random.choice(len(points), 3, replace=False)]
        n = np.cross(b - a, c - a)
        return (n / np.linalg.norm(n), a) if np.linalg.norm(n) > 1e-6 else None

    _, _, (n, a) = ransac(200, draw, lambda m: (np.abs((points[::7] - m[1]) @ m[0]) < 0.008).sum())
    return fit_plane(points[np.abs((points - a) @ n) < 0.01])[0]


def visible_faces(points, normals, random):
    """Up to three flat faces of a box, greatest first: (normal, positions of its points)."""
    left, found = np.arange(len(points)), []
    while len(left) > 0.06 * len(points) and len(found) < 3:

        def on_face(i):
            alike = np.abs(normals[left] @ normals[i]) > 0.9
            return (np.abs((points[left] - points[i]) @ normals[i]) < 0.006) & alike

        count, _, seed = ransac(120, lambda: random.choice(left), lambda i: on_face(i).sum())
        if count < 0.06 * len(points):
            break
        n, offset = fit_plane(points[left[on_face(seed)]])
        near = (np.abs(points[left] @ n - offset) < 0.006) & (np.abs(normals[left] @ n) > 0.8)
        found.append((n, left[near]))
        left = left[~near]
    return found


def fit_box(points, normals, random):
    """Middle planes of a box of which two or three faces are seen; None where they are not those of a box."""
    faces = visible_faces(points, normals, random)
    cover = sum(len(face) for _, face in faces) / len(points)
    if len(faces) < 2 or abs(faces[0][0] @ faces[1][0]) > 0.12 or cover < 0.75:
        return None
    a = faces[0][0]
    b = faces[1][0] - (faces[1][0] @ a) * a
    axes = np.stack([a, b / np.linalg.norm(b), np.cross(a, b / np.linalg.norm(b))])
    middles, sizes = [], []
    for axis in axes:  # faces that contain the direction show its extent
        extent = np.concatenate([points[face] @ axis for n, face in faces if abs(n @ axis) < 0.3])
        low, high = np.quantile(extent, [0.005, 0.995])
        middles.append(0.5 * (low + high))
        sizes.append(high - low)
    normals_of_planes = list(axes)
    for i, j in ((0, 1), (0, 2), (1, 2)):  # a square base has two more
        if abs(sizes[i] - sizes[j]) < 0.04 * np.linalg.norm(np.ptp(points, axis=0)):
            normals_of_planes += [(axes[i] + axes[j]) / math.sqrt(2), (axes[i] - axes[j]) / math.sqrt(2)]
    center = middles @ axes
    return {"shape": "box", "planes": [{"coefficients": [*map(float, n), float(-n @ center)]} for n in normals_of_planes]}


def level_axis(normals, up):
    """The level direction that most normals are across: the axis of a cylinder that lies on the support."""
    level = np.linalg.svd(up[None])[2][1:]
    rows = normals @ level.T
    for _ in range(3):
        axis = np.linalg.eigh(rows.T @ rows)[1][:, 0] @ level
        rows = (normals @ level.T)[np.abs(normals @ axis) < 0.3]
    return axis


def fit_cylinder(points, normals, along, random):
    """Axis of a cylinder along a direction, and the number of points on its wall; None where the wall is not round."""
    across = np.linalg.svd(along[None])[2][1:]
    wall = np.abs(normals @ along) < 0.3
    x = points[wall] @ across.T
    if len(x) < 300:
        return None

    def draw():
        a, b, c = x[random.choice(len(x), 3, replace=False)]
        sides = 2 * np.stack([b - a, c - a])
        if abs(np.linalg.det(sides)) < 1e-7:
            return None
        center = np.linalg.solve(sides, [b @ b - a @ a, c @ c - a @ a])
        return (center, np.linalg.norm(a - center)) if 0.015 < np.linalg.norm(a - center) < 0.12 else None

    off = lambda circle: np.abs(np.linalg.norm(x - circle[0], axis=1) - circle[1])
    count, _, circle = ransac(300, draw, lambda c: (off(c) < 0.004).sum())
    if count < 0.6 * len(x):
        return None
    for _ in range(10):
        y = x[off(circle) < 0.006]
        u, v, w = np.linalg.lstsq(np.c_[2 * y, np.ones(len(y))], (y * y).sum(1), rcond=None)[0]
        circle = np.array([u, v]), math.sqrt(w + u * u + v * v)
    axis = {"point": [*map(float, circle[0] @ across)], "direction": [*map(float, along)]}
    return {"shape": "cylinder", "axis": axis, "on_wall": int(count)}


def objects_of(frame, points, labels):
    """{label: truth} of the objects in a frame, and the mask of each."""
    import open3d

    random = bench.generator(0, frame)
    ok = np.isfinite(points).all(-1)
    up, truths = support_plane(points[ok & (labels < 20)], random), {}
    for label in [int(v) for v in np.unique(labels[ok]) if v >= 20]:
        p = points[ok & (labels == label)]
        if len(p) < 1500:
            continue
        some = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(random.permutation(p)[:6000]))
        some.estimate_normals(open3d.geometry.KDTreeSearchParamKNN(40))
        some.orient_normals_towards_camera_location()
        x, normals = np.asarray(some.points), np.asarray(some.normals)
        if frame in LEARN_BOXES:
            fit = fit_box(x, normals, random)
        else:
            fit, lying = (fit_cylinder(x, normals, along, random) for along in (up, level_axis(normals, up)))
            if lying and lying["on_wall"] > 3600:  # of 6000: the insides of bowls and pots have fewer
                fit = lying
        truths[label] = {"shape": None, **(fit or {}), "center": [*map(float, p.mean(0))],
                         "extent": float(np.linalg.norm(np.ptp(p, axis=0)))}  # fmt: skip
    return truths


def is_right(kind, answer, truth, max_offset):
    """Whether a plane or an axis is one of a box, of a cylinder (planes through its axis), or of a vehicle."""
    center = np.array(truth["center"])
    limit = (MAX_ANGLE, max_offset * truth["extent"])
    if kind == "plane" and truth["shape"] == "cylinder":
        errors = references.line_from_plane(planes.plane_row(answer), *planes.line_of(truth["axis"]), center)
        return np.less(errors, limit).all()
    if kind == "plane":
        rows = np.array([planes.plane_row(plane) for plane in truth["planes"]])
        angles, offsets = references.offsets_and_angles(rows, planes.plane_row(answer), center)
        return bool(((angles < limit[0]) & (offsets < limit[1])).any())
    if kind == "axis" and truth["shape"] == "cylinder":
        errors = references.line_from_line(*planes.line_of(truth["axis"]), *planes.line_of(answer), center)
        return np.less(errors, limit).all()
    return False


def judge(answers, truth, max_offset=0.03):
    """decided: the first answer that decides is right; listed: any answer is, possible ones too; wrong; none; sure: right
    where that answer is one of confidence SURE and more, else None."""
    right = lambda kind, answer: bool(is_right(kind, answer, truth, max_offset))
    axes, found = answers.get("axes", []), answers.get("planes", [])
    deciding = [("axis", a) for a in axes if a.get("confidence", 1) >= planes.MIN_CONFIDENCE]
    deciding += [("plane", p) for p in found if p.get("kind", "symmetry") == "symmetry"]
    decided = [right(*answer) for answer in deciding]
    is_sure = bool(deciding) and deciding[0][1].get("confidence", 0) >= SURE
    every = [right("axis", a) for a in axes] + [right("plane", p) for p in found]
    if answers.get("best"):
        every.append(right("plane", answers["best"]))
    center = bool(answers.get("centers"))
    return {"decided": decided[:1] == [True], "listed": any(every), "none": not decided and not center,
            "sure": decided[0] if is_sure else None, "wrong": decided[:1] == [False] or (center and not decided)}  # fmt: skip


def objects_found(name, points, arguments):
    """Objects of a whole frame with their planes and pixels; None where nobody answers for frames."""
    if arguments.export:
        bench.write_cloud(f"{arguments.export}/{name}.pcd", points)
    if arguments.judge:
        path = pathlib.Path(arguments.judge) / f"{name}.json"
        return json.loads(path.read_text())["objects"] if path.exists() else None
    objects, labels = scenes.analyzed(points.astype(np.float32), arguments.seed)
    return [{**o, "pixels": np.flatnonzero(labels == i + 1).tolist()} for i, o in enumerate(objects)]


def kinect_frame(frame, arguments):
    """Rows of the objects of one frame: alone, by label, and in the whole."""
    path = f"segmentation/mOSD/learn/learn{frame}.pcd"
    file = tempfile.NamedTemporaryFile(suffix=".pcd")
    file.write(show(arguments.repository, path))
    file.flush()
    shape, labels = scenes.read_frame(file.name)
    points, labels = shape.points.astype(float).reshape(480, 640, 3), labels.reshape(480, 640)
    truths, rows, exported = objects_of(frame, points, labels), [], {}
    objects = objects_found(f"learn_{frame}", points, arguments)
    for label, truth in truths.items():
        name, mask = f"learn_{frame}_{label}", labels == label
        exported[name] = truth
        if truth["shape"]:
            answers = bench.ask(name, np.where(mask[..., None], points, np.nan), None, arguments)
            rows.append({"cloud": name, "way": "alone", "shape": truth["shape"], **judge(answers, truth)})
        if truth["shape"] and not arguments.judge:
            answers = bench.detect(points, None, arguments.seed + 2, indices=mask)
            rows.append({"cloud": name, "way": "label", "shape": truth["shape"], **judge(answers, truth)})
        if objects is None:
            continue
        own = set(np.flatnonzero(mask & np.isfinite(points).all(-1)))
        overlap = [len(own & set(o["pixels"])) / len(own | set(o["pixels"])) for o in objects]
        best = int(np.argmax(overlap)) if overlap else -1
        found = best >= 0 and overlap[best] >= 0.5
        row = {"cloud": name, "way": "frame", "shape": truth["shape"], "found": bool(found)}
        rows.append({**row, **(judge(objects[best] if found else {}, truth) if truth["shape"] else {})})
    return {"rows": rows, "truths": exported}


def lidar_frame(frame, arguments):
    """Rows of the vehicles of one frame, with viewpoint and ground, and without."""
    points = read_sweep(arguments.repository, f"data/example/lidar/{frame}.pcd")
    labels = json.loads(show(arguments.repository, f"data/example/label/{frame}.json"))
    rows, exported = [], {}
    for number, box in enumerate(labels):
        if box["obj_type"] not in ("Car", "Truck", "Bus"):
            continue
        center, size, angles = ([box["psr"][k][axis] for axis in "xyz"] for k in ("position", "scale", "rotation"))
        axes = Rotation.from_euler("xyz", angles).as_matrix()
        local = (points - center) @ axes
        inside = (np.abs(local) < np.array(size) / 2 + 0.05).all(1) & (local[:, 2] > -size[2] / 2 + 0.15)
        if inside.sum() < 150:
            continue
        p, n = points[inside].round(4), axes[:, 1]  # a tenth of a millimeter
        truth = {"shape": "vehicle", "planes": [{"coefficients": [*map(float, n), float(-n @ center)]}], "center": center,
                 "extent": float(np.linalg.norm(np.ptp(p, axis=0)))}  # fmt: skip
        ground = {"ground": (0, 0, 1, round(size[2] / 2 - center[2], 3))}  # what the wheels stand on
        for way, sensor, options in (("with viewpoint and ground", np.eye(4), ground), ("without", None, {})):
            name = f"{frame}_{number}_{way.split()[0]}"
            exported[name] = truth
            answers = bench.ask(name, p, sensor, arguments, **options)
            rows.append({"cloud": name, "way": way, "shape": "vehicle", **judge(answers, truth, 0.04)})
    return {"rows": rows, "truths": exported}


def report(rows):
    groups = list(dict.fromkeys((row["way"], row["shape"]) for row in rows if row["shape"]))
    of = lambda group, field: bench.Rate(row[field] for row in rows if (row["way"], row["shape"]) == group)
    fields = ("decided", "listed", "wrong", "none")
    table_rows = [[*group, *(of(group, field).text for field in fields)] for group in groups]
    header = ["way", "shape", "decided right", "listed", "wrong", "none"]
    bench.print_table("Answers for real things; 95 % Wilson intervals", header, table_rows)
    for way in dict.fromkeys(way for way, _ in groups):
        sure = bench.Rate(row["sure"] for row in rows if row["way"] == way and row.get("sure") is not None)
        print(f"{way}: right of the answers with a confidence of {SURE} and more: {sure.text}")
    found = bench.Rate(row["found"] for row in rows if "found" in row)
    if found.total:
        print("Objects of frames found with an overlap of half and more:", found.text)
    return {" ".join(group): {field: of(group, field) for field in fields} for group in groups} | {"found": found}


def program(arguments):
    frames = [*LEARN_BOXES, *LEARN_CYLINDERS] if arguments.kind == "kinect" else VEHICLE_FRAMES
    evaluate = kinect_frame if arguments.kind == "kinect" else lidar_frame
    show(arguments.repository, "segmentation/mOSD/learn" if arguments.kind == "kinect" else "data/example/lidar")
    results, left_out = bench.run(frames, evaluate, arguments)
    rows = [row for result in results for row in result["rows"]]
    bench.write_truth(arguments, functools.reduce(lambda a, b: {**a, **b["truths"]}, results, {}))
    bench.write_json(arguments, {"rates": report(rows), "left_out": left_out, "clouds": rows})


if __name__ == "__main__":
    parser = bench.make_parser(__doc__, models=False)
    parser.add_argument("kind", choices=["kinect", "lidar"])
    parser.add_argument("repository", help="git folder of the data")
    bench.main(program, parser.parse_args())
