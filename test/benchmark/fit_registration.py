"""Fits the probability that a pose of one cloud in another is right, and writes the header of its weights.

usage: PYTHONPATH=build/src/python python3 test/benchmark/fit_registration.py PSB --classes train.cla --fold 0 --real FILE...

Scans of each model are brought to the model, to the scan from the next corner, and to the model and a scan of an object of
another class, where no pose is right, clean and with noise. --real adds poses of real scans that were judged elsewhere: lines of
JSON with "good", "object", "seed" and the fields of PoseEvidence; a pose with several seeds counts once. All scans of models
together count a fifth of these: of real objects that are left out, more make the fit worse (log loss 0.101; 0.113 with a half).
Poses beside which another one fits as well are left out.
"""
import argparse
import dataclasses

import numpy as np

import bench
import fits
import references
import registration

OUTPUT = "src/core/registration/registration_fit.h"
NOISES = (0.0, 0.005)  # diagonals
UNIQUE = 0.9


def terms_of(e):
    """The terms of poseConfidence() in src/core/registration/pose_evidence.cpp."""
    agreement = np.log(e["agreement"] / (1 - e["agreement"]))
    noise = np.log(np.clip(e["noise"], 0.0015, 0.01) / 0.001 + 0.5)
    return [1, agreement, e["on_surface"], e["contradicted"], np.log(e["missing"] + 0.1), noise, abs(np.log(e["size_ratio"]))]


def sample_item(item, arguments):
    """A row for each pose: its terms, and whether it is right."""
    mesh, rows = bench.read_mesh(item.path), []
    other = bench.read_mesh(item.other.path) if item.other is not None else None
    symmetries = references.find_references(mesh)
    cloud_of = lambda *a, **k: registration.seen(*registration.cloud_of(*a, **k))
    for view, noise in enumerate(NOISES):
        asked = argparse.Namespace(**{**vars(arguments), "noise": noise, "points": 10_000, "missing": 0.0})
        source, T_source_model = cloud_of(mesh, item, view, asked)
        targets = [(cloud_of(mesh, item, -1, asked, clean=True), True), (cloud_of(mesh, item, view ^ 1, asked), True)]
        if other is not None:
            targets += [(cloud_of(other, item.other, -1, asked, clean=True), False), (cloud_of(other, item.other, view, asked), False)]
        for (target, T_target_model), is_own in targets:
            found = registration.register(source, target)
            if found.covariance is None:
                continue
            right = False
            if is_own:
                error = registration.pose_error(np.linalg.inv(T_target_model) @ found.transform, np.linalg.inv(T_source_model), symmetries)
                right = error[0] <= registration.RIGHT_ANGLE and error[1] <= registration.RIGHT_DISTANCE
            rows.append([bool(right), dataclasses.asdict(found.evidence)])
    return rows


def main(arguments):
    models = bench.list_models(arguments)
    classes = bench.read_classes(arguments.classes) if arguments.classes else {}
    class_of = lambda model: classes[model.name].name if classes else model.name
    for i, model in enumerate(models):
        others = (dataclasses.replace(other) for other in models[i::-1] if class_of(other) != class_of(model))
        model.other = next(others, None)
    made = [(right, terms_of(e), "made") for right, e in fits.sampled(models, sample_item, arguments) if e["uniqueness"] > UNIQUE]
    rows = [row for row in fits.rows_of(arguments.real) if row["uniqueness"] > UNIQUE]
    real = [(row["good"], terms_of(row), row["object"]) for row in rows]
    right, terms, names = map(np.array, zip(*(made + real)))
    weights = np.r_[np.full(len(made), 0.2 * len(real) / len(made) if real else 1.0), np.ones(len(real))]
    pull = float(max(1, len({row["seed"] for row in rows})))

    print("Each object judged by the fit to all others:")
    for name in sorted(set(names) - {"made"}):
        train, test = names != name, names == name
        accepted = terms[test] @ fits.logistic(terms[train], right[train], weights[train], pull=pull)[0] > 0
        wrong, missed = (accepted & ~right[test]).sum(), (~accepted & right[test]).sum()
        print(f"  {name}: {right[test].sum()} right poses, {missed} of them refused;"
              f" {(~right[test]).sum()} wrong poses, {wrong} of them accepted")
    w, errors = fits.logistic(terms, right, weights, pull=pull)
    print("weights", w, "errors", errors)
    texts = fits.rounded(w, errors)
    fits.write_header(arguments, f"""
/// Weights of the terms of poseConfidence().
inline constexpr std::array<double, {len(texts)}> kRegistrationFit{{{", ".join(texts)}}};
""", [["<array>"]])  # fmt: skip


if __name__ == "__main__":
    fits.main(main, __doc__, OUTPUT, real=fits.REAL)
