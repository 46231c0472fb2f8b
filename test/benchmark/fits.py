"""What the programs that fit decisions share: logistic regression, rounding, made-up shapes, and generated headers."""
import argparse
import json
import math
import pathlib
import sys

import numpy as np
from sklearn.linear_model import LogisticRegression

import bench
import solids

LEAST_EXAMPLES = 100  # of either kind, weights counted; with fewer a decision is a rule, not a fit


def logistic(terms, right, weights=None, pull=1e-3, name="the fit", least=LEAST_EXAMPLES):
    """(coefficients, their standard errors) of the log odds of `right` by terms, of which the first is 1.

    right: outcomes in [0, 1]; shares count as both outcomes. pull: on all but the first coefficient toward 0, in
    cases, of terms scaled to a mean square of 1. Newton's method, so that the same cases give the same bits.
    """
    terms, right = np.asarray(terms, float), np.asarray(right, float)
    weights = np.ones(len(terms)) if weights is None else np.asarray(weights, float)
    fewest = min(weights @ right, weights @ (1 - right)) if len(terms) else 0
    if fewest < least:
        raise bench.BadInput(f"{name}: {fewest:.0f} examples of one of both kinds, must be {least} or more")
    scale = np.sqrt(weights @ terms[:, 1:] ** 2 / weights.sum())
    x = np.concatenate([terms[:, 1:] / scale] * 2)
    outcomes = np.repeat([1, 0], len(terms))
    cases = np.concatenate([weights * right, weights * (1 - right)])
    keep = cases > 0
    model = LogisticRegression(C=1 / pull, solver="newton-cholesky", tol=1e-9, max_iter=200)
    model.fit(x[keep], outcomes[keep], sample_weight=cases[keep])
    p = model.predict_proba(x[: len(terms)])[:, 1]
    scaled = np.c_[terms[:, 0], terms[:, 1:] / scale]
    hessian = scaled.T @ (scaled * (weights * p * (1 - p))[:, None]) + np.diag(np.r_[0, np.full(len(scale), pull)])
    errors = np.sqrt(np.diag(np.linalg.inv(hessian)))
    return np.r_[model.intercept_, model.coef_[0] / scale], errors / np.r_[1, scale]


def rounded(values, errors):
    """Texts of numbers, to a fiftieth of their standard error: summands that hold each other stay in step."""
    digits = [max(0, math.ceil(-math.log10(error / 50))) for error in errors]
    return [f"{value:.{d}f}" for value, d in zip(values, digits)]


def main(program, description, output, **flags):
    """Runs a program; flags: what add_argument() takes of each of its own."""
    parser = bench.make_parser(description, others=False)
    parser.add_argument("--output", metavar="FILE.h", default=output, help="header that is written")
    for name, options in flags.items():
        parser.add_argument(f"--{name}", **options)
    bench.main(program, parser.parse_args())


REAL = dict(nargs="+", default=[], metavar="FILE", help="JSON lines of real scans")


def rows_of(paths):
    """The rows of files of JSON lines."""
    return [json.loads(line) for path in paths for line in pathlib.Path(path).read_text().splitlines()]


def sampled(items, function, arguments):
    """Rows of function(item, arguments) of all items. With --json FILE, FILE.fit.journal keeps them for the next fit."""
    asked = argparse.Namespace(**{**vars(arguments), "output": ""})
    return [row for rows in bench.run(items, function, asked, "fit")[0] for row in rows]


def write_header(arguments, body, includes=()):
    """Writes a generated header of the library, whole or not at all; includes: in their groups, each a list."""
    chosen = {k: getattr(arguments, k, None) for k in ("fold", "every", "shapes", "solids")}
    flags = "".join(f" --{k} {v}" for k, v in chosen.items() if v is not None)
    command = f"test/benchmark/{pathlib.Path(sys.argv[0]).name}{flags}"
    groups = "\n".join("".join(f"#include {name}\n" for name in group) for group in includes)
    text = f"// Written by {command}; do not edit.\n#pragma once\n\n{groups}\nnamespace pcl_symmetry {{\n\n"
    bench.write_whole(arguments.output, text + body.strip("\n") + "\n\n}  // namespace pcl_symmetry\n")


def with_handle(mesh):
    """The same with a handle, half an ellipse in the half plane x > 0, y = 0."""
    low, high = mesh.vertices[:, 2].min(), mesh.vertices[:, 2].max()
    radius = np.linalg.norm(mesh.vertices[:, :2], axis=1).max()
    rise = min(0.5 * radius, 0.35 * (high - low))
    along, around = np.linspace(-np.pi / 2, np.pi / 2, 25)[:, None], np.linspace(0, 2 * np.pi, 12, endpoint=False)
    reach = 0.09 * radius * np.cos(around)
    points = np.stack(np.broadcast_arrays(0.9 * radius + (0.55 * radius + reach) * np.cos(along), 0.09 * radius * np.sin(around),
                                          0.5 * (low + high) + (rise + reach) * np.sin(along)), -1)  # fmt: skip
    vertices, quads = solids.tube(points)
    first = len(mesh.vertices)
    return bench.make_mesh(np.concatenate([mesh.vertices, vertices]),
                           mesh.triangles.tolist() + (quads + first).tolist())  # fmt: skip
