"""How well planes of symmetry are found in clouds of models, and how well the detector refuses.

planes.py PSB --classes train.cla --fold 2 --json planes.json

Each model gives whole clouds, scans from a random side, the same scans moved and without viewpoint, and clouds of which
a random plane cuts off a part. An answer is right within 3 degrees and 2 % of the diagonal of a reference plane, or of
an axis of revolution (references.py). Answers of kind symmetry with a confidence of at least 0.5 decide.
"""
import math

import numpy as np

import bench
import references

MAX_ANGLE, MAX_AXIS_ANGLE, MAX_OFFSET = math.radians(3), math.radians(1), 0.02  # offset in diagonals
MIN_CONFIDENCE = 0.5
ROWS = ("whole", "noise", "scan", "moved", "crop", "random")
NOISE, CROPS = 0.02, (0.05, 0.2, 0.5)  # standard deviation in diagonals; shares of the points cut off


def clouds_of(mesh, key, arguments):
    """Yields (row of the table, name, points, T_cloud_model, scan) of one model; scan is None for whole clouds."""

    def whole(name, points, noise=0.0, cut=0.0):
        random = bench.generator(arguments.seed, key, name)
        pose = bench.random_pose(bench.generator(arguments.seed, key, "pose"), mesh)
        points = bench.moved(pose, points) + noise * mesh.diagonal * random.normal(size=points.shape)
        if cut:
            along = points @ bench.random_directions(bench.generator(arguments.seed, key, "cut"), 1)[0]
            points = points[np.sort(np.argsort(along, kind="stable")[: round((1 - cut) * len(points))])]
        return name, name.replace(" ", "_").replace("%", "percent"), points, pose, None

    even = bench.sample(mesh, arguments.points, bench.generator(arguments.seed, key, "sample"))
    if "whole" in arguments.rows:
        yield whole("whole", even)
    if "noise" in arguments.rows:
        yield whole(f"noise {100 * NOISE:g} %", even, noise=NOISE)
    if {"scan", "moved"} & set(arguments.rows):
        random = bench.generator(arguments.seed, key, "view", 0)
        direction, pose = bench.random_directions(random, 1)[0], bench.random_pose(random, mesh)
        scan = bench.scan(mesh, direction, random, arguments.points, pose=pose)
        if "scan" in arguments.rows:
            yield "scan", "scan_0", scan.points, pose, scan
        if "moved" in arguments.rows:
            motion = bench.random_pose(random, mesh)
            to = mesh.diagonal * random.uniform(-1, 1, 3)
            motion[:3, 3] = to - motion[:3, :3] @ bench.moved(pose, mesh.center)
            lost = bench.Scan(None, motion @ pose, motion @ scan.T_cloud_sensor, scan.half_width)
            yield "moved scan", "moved_0", bench.moved(motion, scan.rows), motion @ pose, lost
    for cut in CROPS if "crop" in arguments.rows else ():
        yield whole(f"cut off {100 * cut:g} %", even, cut=cut)
    if "random" in arguments.rows:
        yield whole("random", bench.sample(mesh, arguments.points, bench.generator(arguments.seed, key, "random"), even=False))


def judge(answers, truth):
    """Judges the answers for a cloud by the references in its frame. Returns a dictionary of what tables count."""
    is_within = lambda error: error[0] <= error[2] and error[1] <= MAX_OFFSET
    center, diagonal = np.array(truth["center"]), truth["diagonal"]
    refs = [("plane", r) for r in truth["planes"]] + [("axis", r) for r in truth["axes"]]
    refs += [("center", r) for r in truth["centers"]]
    near = [("plane", r) for r in truth["near_planes"]] + [("axis", r) for r in truth["near_axes"]]
    found, family, rows, errors = set(), set(), [], []
    for kind, answer, called in _in_order(answers):
        matches = [(_error(kind, answer, r, center, diagonal), i) for i, r in enumerate(refs)]
        matches = sorted((max(e[0] / e[2], e[1] / MAX_OFFSET), i, e) for e, i in matches if e and is_within(e))[:1]
        if kind == "axis" and not matches:  # a prism that is round but for its corners: eight planes and more
            planes_of_refs = [(i, r) for i, (type_, r) in enumerate(refs) if type_ == "plane"]
            around = [(0, i, _error("plane", r, ("axis", answer), center, diagonal)) for i, r in planes_of_refs]
            around = [(0, i, e) for _, i, e in around if e[0] <= MAX_AXIS_ANGLE and e[1] <= MAX_OFFSET]
            matches = around if len(around) >= 8 else []
        new = {i for _, i, _ in matches} - found
        near_errors = [_error(kind, answer, r, center, diagonal) for r in near]
        is_near = not matches and any(e and is_within(e) for e in near_errors)
        repeats = any(i in family for _, i, _ in matches)
        verdict = "right" if new else "neutral" if repeats or is_near else "false"
        found |= new
        family |= {i for _, i, _ in matches if refs[i][0] != "plane" or len(matches) > 1}
        if verdict == "right" and not errors:
            errors = [math.degrees(max(e[0] for *_, e in matches)), 100 * max(e[1] for *_, e in matches)]
        rows.append({"kind": kind, "verdict": verdict, "called": called, "confidence": answer.get("confidence"),
                     "at_reference": bool(matches)})  # fmt: skip
    decisive = [row["verdict"] for row in rows if row["verdict"] != "neutral"]
    decided = [row["verdict"] for row in rows if row["verdict"] != "neutral" and row["called"]]
    return {"answers": rows, "called": any(row["called"] for row in rows), "decided_right": decided[:1] == ["right"],
            "first_right": decisive[:1] == ["right"], "false": decided.count("false"), "found": len(found),
            "references": len(refs), "angle": errors[0] if errors else None,
            "offset": errors[1] if errors else None}  # fmt: skip


def _in_order(answers):
    """Centers, axes and planes, each best first: (kind, answer, whether it decides)."""
    for kind in ("center", "axis", "plane"):
        for answer in answers[{"center": "centers", "axis": "axes", "plane": "planes"}[kind]]:
            called = answer.get("kind", "symmetry") == "symmetry" and answer.get("confidence", 1) >= MIN_CONFIDENCE
            yield kind, answer, called


def plane_row(answer):
    row = np.array(answer["coefficients"], float)
    return np.r_[row[:3], -row[3]] / np.linalg.norm(row[:3])


def line_of(answer):
    direction = np.array(answer["direction"], float)
    return np.array(answer["point"], float), direction / np.linalg.norm(direction)


def _error(kind, answer, reference, center, diagonal):
    """(angle, offset in diagonals, limit of the angle) of an answer at a reference; None where it cannot be right."""
    type_, truth = reference
    point = np.array(truth["point"]) if type_ == "center" else None
    if kind == "plane" and type_ == "plane":
        angle, offset = (v[0] for v in references.offsets_and_angles(plane_row(truth), plane_row(answer), center))
    elif kind == "plane" and type_ == "axis":
        angle, offset = references.line_from_plane(plane_row(answer), *line_of(truth), center)
    elif kind == "axis" and type_ == "axis":
        angle, offset = references.line_from_line(*line_of(truth), *line_of(answer), center)
        return angle, offset / diagonal, MAX_AXIS_ANGLE
    elif kind == "plane" and type_ == "center":
        angle, offset = 0.0, abs(plane_row(answer)[:3] @ point - plane_row(answer)[3])
    elif kind == "axis" and type_ == "center":
        angle, offset = 0.0, np.linalg.norm(np.cross(point - line_of(answer)[0], line_of(answer)[1]))
    elif kind == "center" and type_ == "center":
        angle, offset = 0.0, np.linalg.norm(np.array(answer["point"]) - point)
    else:
        return None
    return angle, offset / diagonal, MAX_ANGLE


def contradicted(surface, mesh, scan, kind, answer):
    """Whether a scan rules an answer out: a plane (of an axis or a center one of 12) maps more than 3 % of the visible
    surface to where the picture shows that nothing is, further than the tolerance from the mesh."""
    if kind == "plane":
        planes = plane_row(answer)[None]
    elif kind == "axis":
        planes = references.planes_through_line(*line_of(answer), 12)
    else:
        planes = references.planes_through_point(np.array(answer["point"]), 12)
    to_sensor = np.linalg.inv(scan.T_cloud_sensor)
    corners = bench.moved(to_sensor @ scan.T_cloud_model, mesh.corners.reshape(-1, 3)).reshape(-1, 3, 3)
    size = 512
    depth = np.pad(bench.depth_picture(corners, size, scan.half_width), 1, constant_values=-np.inf)

    def in_front(points, slack):  # in the frame of the cloud: in the picture, and nothing lies before them
        x = bench.moved(to_sensor, points)
        pixel = ((x[:, :2] / x[:, 2:] / scan.half_width + 1) * size / 2 - 0.5).round().clip(-1, size).astype(int) + 1
        return x[:, 2] <= depth[pixel[:, 1], pixel[:, 0]] + slack

    samples = bench.moved(scan.T_cloud_model, mesh.center + mesh.diagonal * surface.samples[:2500])
    visible = samples[in_front(samples, 0.005 * mesh.diagonal)]
    if len(visible) == 0:
        return False
    to_model = np.linalg.inv(scan.T_cloud_model)
    for reflected in references.reflect(planes, visible):
        free = in_front(reflected, 0.0)
        far = mesh.distances((bench.moved(to_model, reflected) - mesh.center) / mesh.diagonal) > surface.tolerance
        if (free & far).mean() > 1 - references.MIN_SHARE:
            return True
    return False


def maps_at_twice(mesh, pose, answer):
    """Whether a plane maps as much of the mesh as a symmetry within twice the tolerance."""
    row = plane_row(answer)
    offset = row[:3] @ bench.moved(pose, mesh.center) - row[3]
    plane = np.r_[row[:3] @ pose[:3, :3], -offset / mesh.diagonal]
    return bool(references.Surface(mesh, 2 * references.TOLERANCE, 4000).share(plane, 4000)[0] >= references.MIN_SHARE)


def evaluate(model, arguments):
    """Rows of the clouds of one model."""
    mesh = bench.read_mesh(model.path)
    truth = references.find_references(mesh)
    rows, truths = [], {}
    for group, suffix, points, pose, scan in clouds_of(mesh, model.key, arguments):
        name = f"{model.name}_{suffix}"
        here = references.moved(truth, pose)
        sensor = None if scan is None or scan.points is None else scan.T_cloud_sensor
        truths[name] = {**here, "model": model.name, "group": group}
        asked = {"as_published": True, "method": arguments.as_published} if arguments.as_published else {}
        answers = bench.ask(name, points, sensor, arguments, **asked)
        row = judge(answers, here)
        row["contradicted"] = 0
        called = [answer for kind, answer, is_called in _in_order(answers) if kind == "plane" and is_called]
        row["at_twice"] = [maps_at_twice(mesh, pose, answer) for answer in called]
        if scan is not None and row["false"]:
            surface = references.Surface(mesh, references.TOLERANCE, 4000)
            wrong = [a for a, r in zip(_in_order(answers), row["answers"]) if r["called"] and r["verdict"] == "false"]
            row["contradicted"] = sum(contradicted(surface, mesh, scan, kind, answer) for kind, answer, _ in wrong)
        row.update(model=model.name, cloud=name, group=group, kind=truth["kind"], best_share=truth["best_share"],
                   scan=scan is not None, failed=answers["failed"], milliseconds=answers["milliseconds"])  # fmt: skip
        rows.append(row)
    return {"rows": rows, "truths": truths if arguments.export else {}}


def summarize(rows):
    """What the tables say of the clouds of one row."""
    of = lambda kind: [row for row in rows if row["kind"] == kind]
    symmetric, asymmetric, nearly = of("symmetric"), of("asymmetric"), of("nearly symmetric")
    stated = [a for row in rows for a in row["answers"] if a["confidence"] is not None]
    return {
        "decided_right": bench.Rate(row["decided_right"] for row in symmetric),
        "first_right": bench.Rate(row["first_right"] for row in symmetric),
        "found": bench.Rate(row["found"] > 0 for row in symmetric),
        "asymmetric_called": bench.Rate(row["called"] for row in asymmetric),
        "asymmetric_contradicted": bench.Rate(row["contradicted"] > 0 for row in asymmetric if row["scan"]),
        "nearly_called": bench.Rate(row["called"] for row in nearly),
        "at_twice": bench.Rate(at_twice for row in rows for at_twice in row["at_twice"]),
        "false_per_cloud": sum(row["false"] for row in symmetric) / max(1, len(symmetric)),
        "recall": sum(row["found"] for row in symmetric) / max(1, sum(row["references"] for row in symmetric)),
        "calibration": bench.calibration([a["confidence"] for a in stated], [a["at_reference"] for a in stated]),
    }


def report(rows):
    groups = list(dict.fromkeys(row["group"] for row in rows))
    sums = {group: summarize([row for row in rows if row["group"] == group]) for group in groups}
    models = {row["model"]: row["kind"] for row in rows}
    kinds = [f"{list(models.values()).count(kind)} {kind}" for kind in ("symmetric", "nearly symmetric", "asymmetric")]
    print(", ".join(kinds), "models\n")
    bench.print_table(
        "Decisions at one operating point: kind symmetry, confidence >= 0.5; 95 % Wilson intervals",
        ["clouds", "decided and right, of symmetric", "called, of asymmetric", "against a visible point",
         "called, of nearly symmetric", "false a cloud", "planes called that map 97 % at twice the tolerance"],
        [[g, s["decided_right"].text, s["asymmetric_called"].text, s["asymmetric_contradicted"].text,
          s["nearly_called"].text, f"{s['false_per_cloud']:.2f}", s["at_twice"].text] for g, s in sums.items()])  # fmt: skip
    of_group = lambda group, field: [row[field] for row in rows if row["group"] == group]
    number = lambda value: f"{value:.3f}"
    bench.print_table(
        "Rankings, errors of the first right answer, calibration, and time of one thread",
        ["clouds", "first answer right", "a reference among the answers", "recall", "angle, deg", "offset, %", "answers", "ECE", "by chance", "Brier", "ms"],
        [[g, s["first_right"].text, s["found"].text, f"{100 * s['recall']:.1f} %", bench.median(of_group(g, "angle")),
          bench.median(of_group(g, "offset")), s["calibration"]["answers"], number(s["calibration"]["error"]),
          number(s["calibration"]["by_chance"]), number(s["calibration"]["brier"]),
          bench.median(of_group(g, "milliseconds"), 0)] for g, s in sums.items()])  # fmt: skip
    return sums


def program(arguments):
    results, left_out = bench.run(bench.list_models(arguments), evaluate, arguments)
    rows = [row for result in results for row in result["rows"]]
    bench.write_truth(arguments, {name: truth for result in results for name, truth in result["truths"].items()})
    sums = report(rows)
    bench.write_json(arguments, {"groups": sums, "left_out": left_out, "clouds": rows})


if __name__ == "__main__":
    parser = bench.make_parser(__doc__)
    parser.add_argument("--rows", type=bench.numbers(str, ROWS), default="whole,noise,scan,moved,crop", help="of " + ",".join(ROWS))
    parser.add_argument("--points", type=int, default=10_000, help="of a cloud")
    methods = ("sampled", "convolution", "voting")
    parser.add_argument("--as_published", choices=methods, help="refine the maxima of this map as the paper does")
    bench.main(program, parser.parse_args())
