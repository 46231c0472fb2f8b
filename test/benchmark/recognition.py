"""Which model a scan shows (Section 5.2): pcl_symmetry.Database on scans from one side.

recognition.py PSB --classes train.cla --fold 1 --query-every 8 --json recognition.json

Scans each model from a random direction in a random pose, and asks a database of all models but some which of them it
is.
"""
import pathlib
import tempfile

import numpy as np
import pcl_symmetry

import bench

MODEL_POINTS = 20_000  # of a model in a database


def build_of_meshes(models, arguments):
    """Builds a database, whole or not at all; returns sentences about those that were left out."""
    left_out, clouds = [], []
    for model in models:
        try:
            random = bench.generator(arguments.seed, model.key, "model")
            clouds.append((model.name, bench.sample(bench.read_mesh(model.path), MODEL_POINTS, random)))
        except bench.BadInput as error:
            left_out.append(str(error))
    part = pathlib.Path(f"{arguments.database}.part")
    part.unlink(missing_ok=True)
    with pcl_symmetry.Database(part, create=True, threads=arguments.jobs) as database:
        report = database.build((name, points.astype(np.float32)) for name, points in clouds)
    part.replace(arguments.database)
    return left_out + [f"{name}: {reason}" for name, reason in report.failures]


def ask(model, arguments):
    """What the database says about a scan of the model."""
    mesh, random = bench.read_mesh(model.path), bench.generator(arguments.seed, model.key)
    direction, pose = bench.random_directions(random, 1)[0], bench.random_pose(random, mesh)
    scan = bench.scan(mesh, direction, random, pose=pose)
    database, points = bench.opened_database(arguments.database), scan.rows.astype(np.float32)
    found, milliseconds = bench.timed(database.recognize, points, viewpoint=scan.viewpoint, threads=1)
    name, confidence = (found[0].name, found[0].confidence) if found else (None, None)
    return {"model": model.name, "answer": name, "confidence": confidence, "milliseconds": milliseconds}


def judge(results, known, class_of):
    """Rates of the answers. known: names in the database. class_of: {name: class}; without it each is its own."""
    alike = lambda a, b: a == b or (a in class_of and class_of[a] == class_of.get(b))
    inside, outside = ([r for r in results if (r["model"] in known) == yes] for yes in (True, False))
    return {"the scanned model first": bench.Rate(r["answer"] == r["model"] for r in inside),
            "a model of its class first": bench.Rate(alike(r["answer"], r["model"]) for r in inside),
            "falsely unknown": bench.Rate(r["answer"] is None for r in inside),
            "unknown objects found to be unknown": bench.Rate(r["answer"] is None for r in outside)}  # fmt: skip


def main(arguments):
    models = bench.list_models(arguments)
    leaves = bench.read_classes(arguments.classes) if arguments.classes else {}
    class_of = {name: leaf.name for name, leaf in leaves.items()}
    is_left_out = lambda i: i % arguments.leave_out == arguments.leave_out - 1
    inside = [model for i, model in enumerate(models) if not is_left_out(i)]
    asked = [model for i, model in enumerate(models) if is_left_out(i) or i % arguments.query_every == 0]
    with tempfile.TemporaryDirectory() as temporary:
        arguments.database = bench.work_folder(arguments, temporary) + "/models.db"
        failures = [] if pathlib.Path(arguments.database).exists() else build_of_meshes(inside, arguments)
        results, left_out = bench.run(asked, ask, arguments)
    rates = judge(results, {model.name for model in inside}, class_of)
    times = [r["milliseconds"] for r in results]
    title = f"{len(results)} scans, {len(inside) - len(failures)} models; median {bench.median(times, 0)} ms"
    bench.print_table(title, ["", "rate"], [[name, rate.text] for name, rate in rates.items()])
    bench.write_json(arguments, {"rates": rates, "scans": results, "left_out": failures + left_out})


if __name__ == "__main__":
    parser = bench.make_parser(__doc__, others=False)
    add = parser.add_argument
    add("--leave-out", type=int, default=10, help="every N-th model is not in the database")
    add("--query-every", type=int, default=1, help="scan every N-th model of the database only")
    bench.main(main, parser.parse_args())
