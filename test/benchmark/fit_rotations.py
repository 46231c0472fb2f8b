"""Fits the confidence of rotations that single scans show, and writes the header that holds its numbers.

usage: PYTHONPATH=build/src/python python3 test/benchmark/fit_rotations.py PSB --classes train.cla --fold 0

Scans of models, and of solids made by code (round, with folds, with a handle), give rotations about lines with their
evidence; by exact distances, what they map off the mesh. Rotations are right where they map all but 10 % of the surface to
within 1 % of the diameter of the surface, and all but 1.25 % to within ten times that. Half turns are fitted to the
models alone: prisms have them more often than objects do.
"""
import numpy as np
import pcl_symmetry

import bench
import fits
import references
import rotations
import solids

OUTPUT = "src/core/rotation/rotation_confidence_fit.h"
KINDS, NUM_TERMS = ("by any angle", "half turns", "of order 3 and more"), (4, 7, 6)
NUM_SAMPLES = 5000  # of the mesh: a share of 0.1 is known to 0.004
PULL = 0.5  # cases; half and twice change no confidence by 0.05, and without any separable cases would be certain
NUM_SCANS, NUM_SOLIDS = 4, 900


def solid(i, random):
    """A round body, one with 3 to 8 folds, or a round one with a handle."""
    if i % 3 == 1:
        body, folds = list(solids.FOLDED)[i // 3 % 5], int(random.integers(3, 9))
        return solids.folded_body(body, solids.folded_curve(folds, random), folds, random)
    mesh = solids.round_body(solids.TUNING_BODIES[i // 3 % 4], random)
    return fits.with_handle(mesh) if i % 3 == 2 else mesh


def sample_item(item, arguments):
    """Rows of the rotations of all scans of a model or solid: model, kind, excess and terms."""
    name = str(getattr(item, "name", item))
    if isinstance(item, str):
        mesh, num_scans = solid(int(item.split()[1]), bench.generator(arguments.seed, item)), 1
    else:
        mesh, num_scans = bench.read_mesh(item.path), NUM_SCANS
    surface, rows = references.Surface(mesh, rotations.TOLERANCE, NUM_SAMPLES), []
    on_mesh = mesh.center + mesh.diagonal * surface.samples
    for view in range(num_scans):
        random = bench.generator(arguments.seed, name, "turns", view)
        scan = bench.scan(mesh, bench.random_directions(random, 1)[0], random, pose=bench.random_pose(random, mesh))
        found = pcl_symmetry.planes(scan.rows.astype(np.float32), viewpoint=scan.viewpoint, evidence=True, threads=1)
        T_model_cloud = np.linalg.inv(scan.T_cloud_model)
        for e in found.rotation_evidence:
            line = bench.moved(T_model_cloud, e["point"]), T_model_cloud[:3, :3] @ e["direction"]
            right = rotations.excess(mesh, on_mesh, rotations.about(*line, e["fold"]))
            rows.append([name, int(e["kind"]), round(right, 4), *map(float, e["terms"])])
    return rows


def header(fit, errors, counts):
    numbers = ["{" + ", ".join(fits.rounded(*both)) + "}" for both in zip(fit, errors)]
    return f"""
// Coefficients of rotationOddsTerms(), by RotationKind.
// Fitted; symmetries among the rotations of each kind: {", ".join(counts)}.
inline const std::array<std::vector<double>, 3> kRotationConfidenceFit{{
    {{{(","+chr(10)+"     ").join(numbers)}}}}};
"""


def program(arguments):
    items = [*bench.list_models(arguments), *(f"solid {i}" for i in range(arguments.solids))]
    rows = fits.sampled(items, sample_item, arguments)
    names, table = np.array([row[0] for row in rows]), np.array([row[1:] for row in rows])
    kinds, right, terms = table[:, 0], table[:, 1] <= 1, table[:, 2:]
    results, counts = [], []
    for kind, count in enumerate(NUM_TERMS):
        use = (kinds == kind) & ~((kind == 1) & np.char.startswith(names, "solid "))
        x, y = terms[use, :count], right[use]
        results.append(fits.logistic(x, y, pull=PULL, name=KINDS[kind]))
        counts.append(f"{y.sum()} of {len(y)}")
    fits.write_header(arguments, header(*zip(*results), counts), (["<array>", "<vector>"],))


if __name__ == "__main__":
    fits.main(program, __doc__, OUTPUT, solids=dict(type=int, default=NUM_SOLIDS, help="number of scans of solids made by code"))
