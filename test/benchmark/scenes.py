"""Objects among others: planes in frames of a depth camera.

scenes.py PSB --classes train.cla --fold 1 --every 3 --scenes 45 --noise 0,1 --most-in-band 60 --json scenes.json

Models of 0.15 to 0.3 m stand on a table, none meets another, and a camera looks at them. Each object that shows enough
points is asked for in three ways:

  alone   its points, cut out of the frame, with the viewpoint: pcl_symmetry.planes()
  label   its points in the frame, as a segmentation names them: planes(indices=)
  scene   the whole frame: scene(); the object that it finds must share half of the points (IoU >= 0.5)

Answers of kind symmetry with a confidence of at least 0.5 decide, as in planes.py.
"""
import json
import math
import pathlib
import tempfile
import types

import numpy as np
import pcl_symmetry

import bench
import planes
import references

LEAST_DIAGONAL, GREATEST_DIAGONAL = 0.15, 0.30  # of models, meters
BANDS = (0.0, 0.1, 0.3, 0.5, 0.7)  # of the share of an object that others hide
MIN_IOU, MIN_POINTS, MOST_OBJECTS = 0.5, 300, 12  # points that are seen of an object; objects of a scene
DEVIATION, STEP, FLYING, EDGE = 1.425e-3, 2.85e-3, 0.5, 0.02  # structured light at 1 m (Khoshelham and Elberink 2012); shares
TABLE_RIM = 0.4  # meters


def prepare(model, arguments):
    """Size and reference symmetries of a model, in meters about its center."""
    random = bench.generator(arguments.seed, model.key, "size")
    diagonal = random.uniform(LEAST_DIAGONAL, GREATEST_DIAGONAL)
    mesh = bench.read_mesh(model.path)
    factor = diagonal / mesh.diagonal
    symmetries = references.moved(references.find_references(mesh), bench.rigid(np.eye(3), -factor * mesh.center), factor)
    return {"name": model.name, "path": model.path, "diagonal": diagonal, "symmetries": symmetries}


def standing(random):
    """Rotation that stands a model on one face of its bounding box, at any angle about the vertical."""
    up, sign, angle = random.integers(3), random.choice([1, -1]), random.uniform(0, 2 * np.pi)
    upright = np.roll(np.eye(3), 2 - up, axis=0)  # brings the axis to z
    upright = upright if sign > 0 else np.diag([1, -1, -1]) @ upright
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ upright


def draw_scene(models, arguments, number):
    """Objects that stand apart: [(index of the model, T_scene_model, middle, radius of the circle around it)]."""
    random = bench.generator(arguments.seed, "scene", number)
    count = random.integers(1, MOST_OBJECTS + 1)
    half_side, placed = 0.02 + 0.08 * math.sqrt(count), []
    for index in random.integers(len(models), size=count):
        rotation = standing(random)
        corners = bench.mesh_of_size(models[index]["path"], models[index]["diagonal"]).corners.reshape(-1, 3) @ rotation.T
        middle = 0.5 * (corners.min(0) + corners.max(0))[:2]
        radius = np.linalg.norm(corners[:, :2] - middle, axis=1).max()
        for at in random.uniform(-half_side, half_side, (100, 2)):
            if all(np.linalg.norm(other - at) > reach + radius + 0.005 for _, _, other, reach in placed):
                pose = bench.rigid(rotation, [*(at - middle), -corners[:, 2].min()])
                placed.append((int(index), pose, at, radius))
                break
    return placed, random


def look_at_middle(placed, random):
    """T_scene_sensor; most often along the line from an object to its nearest neighbor, which hides a part of it."""
    azimuth = random.uniform(0, 2 * np.pi)
    if len(placed) > 1 and random.uniform() < 0.8:
        hidden = random.integers(len(placed))
        away = np.array([other[2] - placed[hidden][2] for i, other in enumerate(placed) if i != hidden])
        nearest = away[np.argmin(np.linalg.norm(away, axis=1))]
        azimuth = math.atan2(nearest[1], nearest[0]) + random.uniform(-0.5, 0.5)
    elevation, distance = math.radians(random.uniform(10, 40)), random.uniform(0.9, 1.3)
    toward = np.array([math.cos(elevation) * math.cos(azimuth), math.cos(elevation) * math.sin(azimuth), math.sin(elevation)])
    return bench.rigid(bench.look_along(-toward), distance * toward)


def rays():
    """(480, 640, 3) rays of the pixels in the frame of the camera, z = 1."""
    x, y = np.meshgrid((np.arange(640) - 319.5) / 525, (np.arange(480) - 239.5) / 525)
    return np.stack([x, y, np.ones_like(x)], -1)


def depths_of(corners):
    """(480, 640) depths of (T, 3, 3) triangles in the frame of the camera."""
    return bench.depth_picture(corners, 640, 320 / 525)[80:560]


def table(num_objects):
    """Triangles of the table."""
    half = 0.02 + 0.08 * math.sqrt(max(1, num_objects)) + TABLE_RIM
    cuts = np.linspace(-half, half, 9)  # small triangles have small boxes in the picture
    (x, y), step = np.meshgrid(cuts[:-1], cuts[:-1], indexing="ij"), cuts[1] - cuts[0]
    a, b, c, d = (np.stack([x + i * step, y + k * step, 0 * x], -1).reshape(-1, 3) for i, k in ((0, 0), (1, 0), (1, 1), (0, 1)))
    return np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def render(models, placed, sensor):
    """(depths, ids, [(pixels of each object, pixels without the others, reaches beyond the picture)])"""
    inside = lambda corners: depths_of((corners - sensor[:3, 3]) @ sensor[:3, :3])
    alone = []
    for index, pose, _, _ in placed:
        mesh = bench.mesh_of_size(models[index]["path"], models[index]["diagonal"])
        alone.append(inside(bench.moved(pose, mesh.corners)))
    layers = np.stack([*alone, inside(table(len(placed)))])
    depths, ids = layers.min(0), layers.argmin(0)
    ids = np.where(ids == len(alone), -1, ids)
    ids[np.isinf(depths)] = -2
    border = np.ones(depths.shape, bool)
    border[1:-1, 1:-1] = False
    hits = [np.isfinite(layer) for layer in alone]
    return depths, ids, [(int((ids == k).sum()), int(hit.sum()), bool((hit & border).any())) for k, hit in enumerate(hits)]


def with_noise(depths, factor, random, flying=FLYING):
    """Errors of a depth camera with structured light, which measures disparities in whole steps and mixes the depths of
    a share of the pixels at edges, the flying ones."""
    if factor == 0:
        return depths
    noisy = depths.copy()
    for axis in (1, 0):
        beside = np.roll(depths, -1, axis)
        step = np.where(np.isfinite(depths) & np.isfinite(beside), beside, 0) - np.where(np.isfinite(depths), depths, 0)
        edge = np.isfinite(depths) & np.isfinite(beside) & (np.abs(step) > EDGE * depths)
        edge[(slice(None),) * axis + (-1,)] = False  # nothing is beside the last ones
        flies = edge & (random.uniform(size=depths.shape) < factor * flying)
        noisy[flies] = (depths + random.uniform(size=depths.shape) * step)[flies]
    disparities = 1 / (factor * STEP * noisy) + DEVIATION / STEP * random.normal(size=depths.shape)
    return np.where(np.isfinite(depths), 1 / (factor * STEP * np.maximum(1, np.round(disparities))), np.inf)


def make(number, arguments):
    """Writes the frames of one scene; returns {name of the frame: its objects}."""
    models = bench.read_json(f"{arguments.frames}/models.json")
    placed, random = draw_scene(models, arguments, number)
    sensor = look_at_middle(placed, random)
    depths, ids, seen = render(models, placed, sensor)
    objects, frames = [], {}
    for k, (index, pose, _, _) in enumerate(placed):
        num_visible, num_alone, cropped = seen[k]
        objects.append({"object": k, "model": models[index]["name"], "diagonal": models[index]["diagonal"],
                        "T_scene_model": pose.ravel().tolist(), "num_visible": num_visible, "num_alone": num_alone,
                        "cropped": cropped, "symmetries": references.moved(models[index]["symmetries"], pose)})  # fmt: skip
    for noise in arguments.noise:
        measured = with_noise(depths, noise, bench.generator(arguments.seed, "noise", number, noise), arguments.flying)
        points = bench.moved(sensor, np.where(np.isfinite(measured), measured, np.nan)[..., None] * rays())
        name = f"scene_{int(number):04d}_noise_{noise:g}"
        bench.write_cloud(f"{arguments.frames}/{name}.pcd", points, sensor, label=ids)
        frames[name] = objects
    return frames


def read_frame(path):
    """The shape in a file, NaN where nothing was met, and (N,) whole numbers of its field label."""
    import open3d

    try:
        return pcl_symmetry.read(path), open3d.t.io.read_point_cloud(str(path)).point["label"].numpy().ravel().astype(int)
    except (OSError, KeyError, RuntimeError, ValueError):
        raise bench.BadInput(f"{path}: is no frame with the field label") from None


def overlaps(labels, truth, shape):
    """(rows, columns) IoU of labels, from 0, with true ones; negative ones belong to nothing."""
    both = (labels >= 0) & (truth >= 0)
    common = np.bincount(labels[both] * shape[1] + truth[both], minlength=shape[0] * shape[1]).reshape(shape)
    sizes = [np.bincount(x[x >= 0], minlength=n) for x, n in zip((labels, truth), shape)]
    return common / np.maximum(1, sizes[0][:, None] + sizes[1] - common)


def analyzed(frame, seed):
    """(objects, number of the object of each point, from 1) that pcl_symmetry.scene() finds in a frame."""
    found = pcl_symmetry.scene(frame, seed=seed + 2, threads=1)
    return found.to_dict()["objects"], found.labels.ravel()


def judge_frame(frame, arguments):
    """Rows of the wanted objects of one frame: alone, and in the scene."""
    file = f"{arguments.frames}/{frame.name}.pcd"
    shape, labels = read_frame(file)
    points = shape.points.reshape(-1, 3)
    finite, sensor, rows, milliseconds = np.isfinite(points[:, 0]), bench.rigid(np.eye(3), shape.viewpoint), [], 0
    if "scene" in arguments.seen:
        (found, numbers), milliseconds = bench.timed(analyzed, file, arguments.seed)
        iou = overlaps(numbers[finite] - 1, labels[finite], (len(found), labels.max() + 1))
    for truth in frame.objects:
        k, ways = truth["object"], []  # (how it was seen, whether it was found, answers)
        own = points[finite & (labels == k)]
        if "alone" in arguments.seen:
            ways.append(("alone", True, bench.detect(own, sensor, arguments.seed + 1)))
        if "label" in arguments.seen:
            ways.append(("label", True, bench.detect(shape, seed=arguments.seed + 2, indices=np.flatnonzero(labels == k))))
        if "scene" in arguments.seen:
            best = max(range(len(found)), key=lambda i: iou[i, k], default=None)
            is_found = best is not None and bool(iou[best, k] >= MIN_IOU)
            ways.append(("scene", is_found, found[best] if is_found else bench.NO_ANSWERS))
        for seen, is_found, answers in ways:
            judged = planes.judge(answers, truth["symmetries"])
            rows.append({"frame": frame.name, "noise": frame.noise, "object": k, "model": truth["model"],
                         "kind": truth["symmetries"]["kind"], "occlusion": occlusion(truth), "points": len(own), "seen": seen,
                         "found": is_found, "called": judged["called"], "decided_right": judged["decided_right"]})  # fmt: skip
    return {"rows": rows, "milliseconds": milliseconds}


def occlusion(truth):
    return 1 - truth["num_visible"] / truth["num_alone"] if truth["num_alone"] else 1.0


def band_of(share):
    """Index of the band of occlusion; None where too little is seen."""
    return next((i for i in range(4) if BANDS[i] <= share < BANDS[i + 1]), None)


def wanted_frames(truths, arguments):
    """Frames with the objects that are asked for: the first ones of each band, in the order of the scenes."""
    in_band, frames = {}, []
    for name in sorted(truths):
        frame = types.SimpleNamespace(name=name, noise=float(name.rsplit("_", 1)[-1]), objects=[])
        for truth in truths[name]:
            band = band_of(occlusion(truth))
            if band is None or truth.get("cropped") or truth["num_visible"] < MIN_POINTS:
                continue
            key = (frame.noise, band)
            in_band[key] = in_band.get(key, 0) + 1
            if in_band[key] <= (arguments.most_in_band or math.inf):
                frame.objects.append(truth)
        frames += [frame] if frame.objects else []
    return frames


def summarize(rows):
    """Rates of each noise, band of occlusion and way of asking."""
    groups = {}
    for row in rows:
        groups.setdefault((row["noise"], band_of(row["occlusion"]), row["seen"]), []).append(row)
    summary = []
    for (noise, band, seen), own in sorted(groups.items()):
        rates = {"found": bench.Rate(r["found"] for r in own),
                 "decided_right": bench.Rate(r["decided_right"] for r in own if r["kind"] == "symmetric"),
                 "asymmetric_called": bench.Rate(r["called"] for r in own if r["kind"] == "asymmetric")}  # fmt: skip
        summary.append({"noise": noise, "band": band, "seen": seen, "rates": rates})
    return summary


def report(summary, milliseconds):
    hidden = lambda s: f"{100 * BANDS[s['band']]:.0f} to {100 * BANDS[s['band'] + 1]:.0f} %"
    cells = lambda s, names: [f"{s['noise']:g}", hidden(s), s["seen"], *(s["rates"][name].text for name in names)]
    header = ["noise", "hidden", "seen"]
    title = f"Planes of objects in frames; median time of a whole frame {bench.median(milliseconds, 0)} ms"
    bench.print_table(title, [*header, "found, IoU >= 0.5", "symmetric: decided right", "asymmetric: called symmetric"],
                      [cells(s, ("found", "decided_right", "asymmetric_called")) for s in summary])  # fmt: skip


def make_frames(arguments):
    """Writes models.json, the frames (PCD with a field label: -1 table, -2 nothing), and truth.json last."""
    folder = pathlib.Path(arguments.frames)
    models, left_out = bench.run(bench.list_models(arguments), prepare, arguments, "models")
    bench.write_whole(folder / "models.json", json.dumps(models))
    made, failures = bench.run(range(arguments.scenes), make, arguments, "frames")
    bench.write_whole(folder / "truth.json", json.dumps({"scenes": {k: v for frames in made for k, v in frames.items()}}))
    return left_out + failures


def program(arguments):
    with tempfile.TemporaryDirectory() as temporary:
        arguments.frames = bench.work_folder(arguments, temporary)
        truth, left_out = pathlib.Path(arguments.frames, "truth.json"), []
        if not truth.exists():
            left_out = make_frames(arguments)
        frames = wanted_frames(json.loads(truth.read_text())["scenes"], arguments)
        judged, failures = bench.run(frames, judge_frame, arguments, "judged")
    rows = [row for frame in judged for row in frame["rows"]]
    summary = summarize(rows)
    report(summary, [frame["milliseconds"] for frame in judged if frame["milliseconds"]])
    bench.write_json(arguments, {"rows": summary, "objects": rows, "left_out": left_out + failures})


if __name__ == "__main__":
    parser = bench.make_parser(__doc__, others=False)
    add = parser.add_argument
    add("--scenes", type=int, default=100, help="number of scenes")
    add("--noise", type=bench.numbers(float), default="0,1", help="factors of the sensor's noise")
    add("--flying", type=float, default=FLYING, help="share of the pixels at edges that mix two depths, at noise 1")
    add("--seen", type=bench.numbers(str, ("alone", "label", "scene")), default="alone,label,scene", help="how objects are asked for")
    add("--most-in-band", type=int, default=0, help="objects of a band after which others are passed over; 0: none are")
    bench.main(program, parser.parse_args())
