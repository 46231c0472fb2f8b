"""Known objects in frames of depth cameras: names and poses found, wrong names, unknown objects called known.

usage: PYTHONPATH=build/src/python python3 test/benchmark/real_recognition.py FOLDER [--unknown FRAME.pcd ...]

FOLDER/index.json lists models (file), scenes (file of an organized cloud, max_range, objects: model, T_scene_model, and
unlabeled: models that stand there without a known pose) and scans (file, object, T_object_scan). The database holds all
models. Each frame is analyzed in one call of scene(), and each scan alone by recognize(). A pose is right within 5 degrees
and 5 % of the diameter, up to the symmetries of the model. A frame given by --unknown shows none of the models.
"""
import json
import pathlib
import tempfile
import time

import numpy as np
import pcl_symmetry
from scipy.spatial import cKDTree

import bench
from fit_recognition import answer_of
from real_registration import is_right, read


def rows_of(frame, found, scene, surfaces):
    """What the fit needs of each object; nothing of those that show several models or may be one without a label."""
    rows = []
    for k, object in enumerate(found.objects):
        share, shown = max([(0.0, None), *shares_on(frame[found.labels == k + 1], scene, surfaces)], key=lambda pair: pair[0])
        models = answer_of(object.models)
        if share > 0.7:
            rows.append({"object": shown, "models": models})
        elif share < 0.1 and not any(model["name"] in scene.get("unlabeled", []) for model in models[:1]):
            rows.append({"object": None, "models": models})
    return rows


def shares_on(points, scene, surfaces):
    """(share, model) for each model: of the points of an object, those that lie on its surface to 8 mm."""
    for model in scene["objects"]:
        distances = cKDTree(bench.moved(np.array(model["T_scene_model"]), surfaces[model["model"]])).query(points)[0]
        yield (distances < 0.008).mean(), model["model"]


def main(arguments):
    folder = pathlib.Path(arguments.folder)
    index = json.loads((folder / "index.json").read_text())
    surfaces = {name: read(folder / model["file"])[0] for name, model in index["models"].items()}
    diameters = {name: model["diameter"] for name, model in index["models"].items()}
    centers = {name: points.mean(axis=0) for name, points in surfaces.items()}

    def pose_is_right(name, T, truth):
        return bool(is_right(np.linalg.inv(T), np.linalg.inv(truth), surfaces[name], diameters[name], True))

    rows = []
    with tempfile.TemporaryDirectory() as temporary:
        database = pcl_symmetry.Database(temporary + "/models.db", create=True)
        database.build((name, points.astype(np.float32)) for name, points in surfaces.items())
        table, total = [], {key: bench.Rate() for key in ("named", "with the right pose", "frames with more than one wrong name")}
        for name, scene in index["scenes"].items():
            start = time.process_time()
            frame = pcl_symmetry.read(folder / scene["file"]).points
            found = pcl_symmetry.scene(frame, database=database, max_range=scene["max_range"] or 0.0, complete=False, min_name_confidence=0.0, threads=1)
            seconds = time.process_time() - start
            rows += rows_of(frame, found, scene, surfaces)
            names = [object.models[0] for object in found.objects if object.models and object.models[0].confidence >= 0.5]
            there = {model["model"]: np.array(model["T_scene_model"]) for model in scene["objects"]}
            texts, seen = [], set()
            for model, truth in there.items():
                mine = [m for m in names if m.name == model and np.linalg.norm(bench.moved(np.linalg.inv(m.transform), centers[model]) - bench.moved(truth, centers[model])) < 0.6 * diameters[model]]
                seen.update(id(m) for m in mine)
                right = any(pose_is_right(model, np.linalg.inv(m.transform), truth) for m in mine)
                total["named"].add(bool(mine))
                total["with the right pose"].add(right)
                texts.append(f"{model} {'right' if right else 'pose wrong' if mine else 'not named'}")
            wrong = [m for m in names if id(m) not in seen and m.name not in scene.get("unlabeled", [])]
            total["frames with more than one wrong name"].add(len(wrong) > 1)
            table.append([name, len(found.objects), "; ".join(texts), "; ".join(f"{m.name} {m.confidence:.2f}" for m in wrong), f"{seconds:.1f}"])
        bench.print_table("Frames", ["", "objects", "known", "wrong names", "s"], table)
        bench.print_table("All frames", ["", "rate"], [[key, rate.text] for key, rate in total.items()])
        answers = []
        for scan in index["scans"].values():
            if scan["object"] not in surfaces:
                continue
            points = read(folder / scan["file"])[0].astype(np.float32)
            models = database.recognize(points, viewpoint=tuple(scan["viewpoint"] or scan["sensor"]), min_confidence=0.0, threads=1)
            rows.append({"object": scan["object"], "models": answer_of(models)})
            models = [model for model in models if model.confidence >= 0.5]
            if not models:
                answers.append("unknown")
            elif models[0].name != scan["object"]:
                answers.append("wrong name")
            else:
                good = pose_is_right(scan["object"], np.linalg.inv(models[0].transform), np.linalg.inv(np.array(scan["T_object_scan"])))
                answers.append("right" if good else "pose wrong")
        rates = {key: bench.Rate(answer == key for answer in answers) for key in ("right", "pose wrong", "unknown", "wrong name")}
        bench.print_table("Scans alone", ["", "rate"], [[key, rate.text] for key, rate in rates.items()])
        unknown = []
        for path in arguments.unknown:
            frame = pcl_symmetry.read(path).points
            found = pcl_symmetry.scene(frame, database=database, max_range=1.3, complete=False, min_name_confidence=0.0)
            rows += rows_of(frame, found, {"objects": []}, surfaces)
            unknown.append([pathlib.Path(path).stem, len(found.objects), "; ".join(o.models[0].name for o in found.objects if o.models and o.models[0].confidence >= 0.5)])
        if arguments.rows:
            bench.write_whole(arguments.rows, "".join(json.dumps(row) + "\n" for row in rows))
        if unknown:
            bench.print_table("Frames without known objects", ["", "objects", "named"], unknown)


if __name__ == "__main__":
    parser = bench.plain_parser(__doc__)
    parser.add_argument("folder", help="with index.json")
    parser.add_argument("--unknown", nargs="*", default=[], metavar="FRAME")
    parser.add_argument("--rows", metavar="FILE", help="a line of JSON for each object, for fit_recognition.py")
    main(parser.parse_args())
