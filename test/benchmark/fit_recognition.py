"""Fits the probability that a scan shows the model that fits it best, and writes the header of its weights.

usage: PYTHONPATH=build/src/python python3 test/benchmark/fit_recognition.py PSB --classes train.cla --fold 0 --every 6 --real FILE...

Scans of each model, clean and with noise, are brought to a database of nine of ten of them: right is the model itself, wrong
what fits best where it is not in the database, or is left out of the answer. --real adds the answers for real scans: lines of
JSON with "object" and "models", as real_recognition.py --rows writes them. A file that is named twice counts twice.
"""
import tempfile

import numpy as np
from sklearn.metrics import log_loss
from sklearn.model_selection import GroupKFold

import bench
import fits
import recognition

OUTPUT = "src/recognition/recognition_fit.h"
NOISES = (0.0, 0.005)  # diagonals
MAX_LEAD = 0.4
FEW, MOST_SHOWN = 0.02, 0.85


def answer_of(models):
    """What the fit needs of each model in an answer to a scan."""
    return [{"name": m.name, "on_model": m.evidence.on_model, "shown": m.evidence.shown, "merit": m.score.merit} for m in models]


def cases_of(row):
    """(terms, right) of the best model of an answer, and of the best one without the model that the scan shows."""
    others = [model for model in row["models"] if model["name"] != row["object"]]
    for models in [row["models"]] + ([others] if len(others) < len(row["models"]) else []):
        if models:
            best, second, *_ = sorted(models, key=lambda m: -m["merit"]) + [{"merit": 0.0}]
            lead = min(best["merit"] - second["merit"], MAX_LEAD)
            terms = [1, -np.log(1 + FEW - best["on_model"]), np.log(min(best["shown"], MOST_SHOWN) + FEW), lead]
            yield terms, best["name"] == row["object"]


def sample_item(item, arguments):
    mesh, random = bench.read_mesh(item.path), bench.generator(arguments.seed, item.key)
    direction, pose = bench.random_directions(random, 1)[0], bench.random_pose(random, mesh)
    database, rows = bench.opened_database(arguments.database), []
    for noise in NOISES:
        scan = bench.scan(mesh, direction, random, 10_000, noise, pose)
        found = database.recognize(scan.rows.astype(np.float32), viewpoint=scan.viewpoint, min_confidence=0.0, threads=1)
        rows.append({"object": item.name, "models": answer_of(found)})
    return rows


def main(arguments):
    models = bench.list_models(arguments)
    with tempfile.TemporaryDirectory() as temporary:
        arguments.database = temporary + "/models.db"
        recognition.build_of_meshes([model for i, model in enumerate(models) if i % 10 != 9], arguments)
        rows = fits.sampled(models, sample_item, arguments)
    rows += fits.rows_of(arguments.real)
    cases = [(terms, right, row["object"] or "unknown") for row in rows for terms, right in cases_of(row)]
    terms, right, names = map(np.array, zip(*cases))

    losses = []
    for train, test in GroupKFold(5).split(terms, right, names):
        odds = terms[test] @ fits.logistic(terms[train], right[train], pull=0.3)[0]
        losses.append(log_loss(right[test], 1 / (1 + np.exp(-odds)), labels=[False, True]))
    weights, errors = fits.logistic(terms, right, pull=0.3)
    accepted = terms @ weights > 0
    print(f"{right.sum()} right models, {(right & ~accepted).sum()} of them refused; {(~right).sum()} wrong ones, "
          f"{(~right & accepted).sum()} of them accepted; loss for objects left out {np.mean(losses):.3f} nats")  # fmt: skip
    texts = fits.rounded(weights, errors)
    fits.write_header(arguments, f"""
/// Log odds that a scan shows a model: a constant, and the weights of what ModelEvidence says and of its lead.
inline constexpr std::array<double, {len(texts)}> kRecognitionFit{{{", ".join(texts)}}};
""", [["<array>"]])  # fmt: skip


if __name__ == "__main__":
    fits.main(main, __doc__, OUTPUT, real=fits.REAL)
