"""Fits the confidence of planes (src/pages/algorithms/decision.md), and writes the header that holds its numbers.

usage: PYTHONPATH=build/src/python python3 test/benchmark/fit_planes.py PSB --classes train.cla --fold 0

Clouds of models, and of shapes with folds made by code, give candidates with their evidence; what each plane really
maps is measured on the mesh. A plane is right where it lies within 3 degrees and 2 % of the diagonal of one that maps
97 % of the mesh, of all candidates of all clouds of the model; where points resolve no surface, the plane itself has to.
"""
import math

import numpy as np
import pcl_symmetry

import bench
import fits
import references
import solids

OUTPUT = "src/core/evidence/confidence_fit.h"
KINDS, NUM_TERMS = ("surface", "scan", "volume"), (7, 6, 5)
SYMMETRIC, ASYMMETRIC, TOLERANCE = 0.97, 0.90, 0.01
NEAR_WEIGHT = 0.5  # of nearly symmetric planes of scans and cut clouds, which seldom show what is amiss
NUM_PASSES = 10  # which plane is the best of its cloud depends on the fit; two fits alternate from the third pass on
CALLED, LISTED = 0.5, 0.2  # confidences
# Clouds of each model: points, noise in diagonals, share cut off; of scans: points, view, moved, rows of a ring, noise
WHOLE = {"whole": (10_000, 0, 0), "1000 points": (1000, 0, 0), "3000 points": (3000, 0, 0), "40 000 points": (40_000, 0, 0),
         "noise 0.005": (10_000, 0.005, 0), "noise 0.01": (10_000, 0.01, 0), "noise 0.02": (10_000, 0.02, 0),
         "cut off 0.05": (10_000, 0, 0.05), "cut off 0.2": (10_000, 0, 0.2), "cut off 0.5": (10_000, 0, 0.5)}  # fmt: skip
SCANS = {"scan 1": (10_000, 0, False, 1, 0), "scan 2": (10_000, 1, False, 1, 0), "moved 1": (10_000, 0, True, 1, 0),
         "moved 2": (10_000, 1, True, 1, 0), "scan of 1000": (1000, 0, False, 1, 0), "scan of 2500": (2500, 0, False, 1, 0),
         "scan in rings 4": (14_000, 1, False, 4, 0), "scan in rings 8": (28_000, 1, False, 8, 0),
         "scan with noise": (10_000, 1, False, 1, 0.002)}  # fmt: skip
NUM_SHAPES = 144


def clouds_of(mesh, key, seed):
    """Yields (name, points, viewpoint, T_cloud_model) of all clouds of a model."""
    for name, (count, noise, cut) in WHOLE.items():
        random = bench.generator(seed, key, name)
        pose = bench.random_pose(random, mesh)
        points = bench.moved(pose, bench.sample(mesh, count, random))
        points += noise * mesh.diagonal * random.normal(size=points.shape)
        along = points @ bench.random_directions(random, 1)[0]
        yield name, points[along <= np.quantile(along, 1 - cut)], "auto", pose
    for name, (count, view, moved, rings, noise) in SCANS.items():
        random = bench.generator(seed, key, name)
        direction = bench.random_directions(bench.generator(seed, key, "view", view), 1)[0]
        scan = bench.scan(mesh, direction, random, count, noise, bench.random_pose(random, mesh))
        rows = scan.points[::rings].reshape(-1, 3)
        rows, pose = rows[np.isfinite(rows[:, 0])], scan.T_cloud_model
        if moved:
            again = bench.random_pose(random, mesh)
            rows, pose = bench.moved(again @ np.linalg.inv(pose), rows), again
        yield name, rows, "auto" if moved else scan.viewpoint, pose


def shape_clouds(i, seed):
    """(mesh, [(name, points, viewpoint, T_cloud_model)]) of a shape with folds, or of a round one."""
    random = bench.generator(seed, "folds", i)
    body, noise, thinned = [*solids.FOLDED, "round"][i % 6], i // 6 % 3, i // 18 % 2
    folds, count = int(random.integers(2, 25)), (10_000, 3000, 30_000)[i // 36 % 3]
    if body == "round":
        mesh = solids.round_body(solids.TUNING_BODIES[random.integers(4)], random)
    else:
        mesh = solids.folded_body(body, solids.folded_curve(folds, random), folds, random)
    points, pose = bench.sample(mesh, count, random), bench.random_pose(random, mesh)
    if thinned:
        along = (points - mesh.center) @ bench.random_directions(random, 1)[0] / mesh.diagonal
        points = points[random.uniform(size=count) < 0.25 + 0.75 * np.clip(0.5 + along, 0, 1)]
    points = bench.moved(pose, points) + noise * math.sqrt(mesh.areas.sum() / count) * random.normal(size=points.shape)
    return mesh, [(f"folds noise {noise}", points, "auto", pose)]


def sample_item(item, arguments):
    """Rows of all clouds: model, cloud, kind, share on the mesh, near share, share, its unit and the terms."""
    if isinstance(item, str):
        mesh, clouds = shape_clouds(int(item.split()[1]), arguments.seed)
    else:
        mesh = bench.read_mesh(item.path)
        clouds = clouds_of(mesh, item.key, arguments.seed)
    rows, planes = [], []
    for name, points, viewpoint, pose in clouds:
        found = pcl_symmetry.planes(points.astype(np.float32), viewpoint=viewpoint, tolerance=TOLERANCE, evidence=True, threads=1)
        for e in found.evidence:
            plane = references_plane(e["coefficients"], pose, mesh)
            planes.append(plane)
            rows.append([str(getattr(item, "name", item)), name, int(e["kind"]), 0, 0, float(e["share"]), float(e["share_unit"]), *map(float, e["terms"])])
    label(rows, np.array(planes), references.Surface(mesh, TOLERANCE, 4000))
    return rows


def references_plane(coefficients, pose, mesh):
    """A plane of the cloud as row (n, r) in the frame of references.Surface."""
    at = coefficients @ pose  # [n', d'] in the frame of the mesh
    return np.r_[at[:3], (-at[3] - at[:3] @ mesh.center) / mesh.diagonal]


def label(rows, planes, surface):
    """Fills in what planes map of the mesh, and the most that any plane maps which could not be told from them."""
    shares = np.zeros(len(planes))
    going = np.arange(len(planes))
    for count, least in ((100, 0.6), (500, 0.8), (4000, 0)):  # planes far from a symmetry need no exact share
        shares[going] = surface.share(planes[going], count)
        going = going[shares[going] >= least]
    near = shares.copy()
    for j in going:
        angles, offsets = references.offsets_and_angles(planes, planes[j])
        close = (angles <= references.MERGE_ANGLE) & (offsets <= references.MERGE_OFFSET)
        near[close] = np.maximum(near[close], shares[j])
    for row, share, most in zip(rows, shares, near):
        row[3:5] = round(float(share), 4), round(float(most), 4)


class Table:
    """Rows of the evidence of many clouds; those of a cloud stand side by side, best merit first."""

    def __init__(self, rows):
        self.models = np.array([row[0] for row in rows])
        self.clouds = np.array([row[1] for row in rows])
        numbers = np.array([row[2:] for row in rows], float)
        self.kind, self.on_mesh, self.near, self.share, self.unit = numbers[:, :5].T
        self.terms = numbers[:, 5:]
        same = (self.models[1:] == self.models[:-1]) & (self.clouds[1:] == self.clouds[:-1])
        self.group = np.cumsum(np.r_[0, ~same])
        self.right = np.where(self.kind == 2, self.on_mesh, self.near) >= SYMMETRIC
        nearly = (self.near >= ASYMMETRIC) & (self.near < SYMMETRIC)
        hides = (self.kind == 1) | np.char.startswith(self.clouds, "cut off")
        self.weight = np.where(nearly & hides, NEAR_WEIGHT, 1.0)

    def best(self, worth):
        """Mask of the plane of most worth of each cloud, the first of equal ones."""
        order = np.lexsort((np.arange(len(worth)), -worth, self.group))
        first = np.r_[True, np.diff(self.group[order]) > 0]
        mask = np.zeros(len(worth), bool)
        mask[order[first]] = True
        return mask

    def odds(self, fit, best):
        """Log odds; best: mask of planes for which the term of those beside the best does not count."""
        odds = np.zeros(len(self.kind))
        for kind, count in enumerate(NUM_TERMS):
            of_kind = self.kind == kind
            terms = self.terms[of_kind, :count].copy()
            if kind < 2:
                terms[:, -1] *= ~best[of_kind]
            odds[of_kind] = terms @ fit[kind]
        return odds

    def alone(self, fit):
        return self.odds(fit, np.ones(len(self.kind), bool))


def fit_table(table):
    """([coefficients], [errors]) by kind."""
    best = table.best(-np.arange(len(table.kind), dtype=float))
    for _ in range(NUM_PASSES):
        fit, errors = [], []
        for kind, count in enumerate(NUM_TERMS):
            of_kind = table.kind == kind
            terms = table.terms[of_kind, :count].copy()
            if kind < 2:
                terms[:, -1] *= ~best[of_kind]
            one, error = fits.logistic(terms, table.right[of_kind], table.weight[of_kind], name=KINDS[kind])
            fit.append(one)
            errors.append(error)
        best = table.best(table.alone(fit))
    return fit, errors


def share_errors(table, kind):
    """95 of 100 errors of the share lie between these, in units of share_unit."""
    may_be = (table.kind == kind) & (table.share > ASYMMETRIC)
    low, high = np.quantile((table.on_mesh - table.share)[may_be] / table.unit[may_be], [0.025, 0.975])
    return min(0.0, low), max(0.0, high)


def print_fit(table, fit, title):
    """What the fit decides, by groups of clouds, and whether its probabilities come true."""
    best_share = {model: table.on_mesh[table.models == model].max() for model in np.unique(table.models)}
    confidence = 1 / (1 + np.exp(-table.odds(fit, table.best(table.alone(fit)))))
    group_of = lambda cloud: "whole" if "points" in cloud else next((g for g in ("noise", "scan", "moved", "folds") if cloud.startswith(g)), cloud)
    groups = {}
    starts = np.flatnonzero(np.r_[True, np.diff(table.group) > 0])
    for first, last in zip(starts, [*starts[1:], len(table.group)]):
        rows = np.arange(first, last)[np.argsort(-confidence[first:last], kind="stable")]
        right, wrong, forecasts = groups.setdefault(group_of(table.clouds[first]), (bench.Rate(), bench.Rate(), []))
        forecasts += [(confidence[r], table.near[r] >= SYMMETRIC) for r in rows if confidence[r] >= LISTED]
        share = best_share[table.models[first]]
        if share < ASYMMETRIC:
            wrong.add(confidence[rows[0]] >= CALLED)
        elif share >= SYMMETRIC:
            told = [r for r in rows if not ASYMMETRIC <= table.near[r] < SYMMETRIC]
            right.add(bool(told) and confidence[told[0]] >= CALLED and table.near[told[0]] >= SYMMETRIC)
    rows = [(name, right.text, wrong.text, f"{bench.calibration(*zip(*f))['error']:.3f}" if f else "-")
            for name, (right, wrong, f) in sorted(groups.items())]  # fmt: skip
    bench.print_table(title, ["clouds", "symmetric: decided right", "asymmetric: called symmetric", "calibration error"], rows)


def header(table, fit, errors):
    numbers = ["{" + ", ".join(fits.rounded(*both)) + "}" for both in zip(fit, errors)]
    intervals = ["{%.3g, %.3g}" % share_errors(table, kind) for kind in range(3)]
    counts = [f"{table.right[table.kind == k].sum()} of {(table.kind == k).sum()}" for k in range(3)]
    return f"""
/// The fitted numbers of the decision, by CloudKind.
struct ConfidenceFit {{
  std::array<std::vector<double>, 3> log_odds;  ///< coefficients of logOddsTerms(), then that of furtherTerm()
  std::array<ShareInterval, 3> share_errors;    ///< of the share, units of shareUnit()
}};

// clang-format off
// Fitted to candidates of {len(np.unique(table.models))} models and shapes; symmetries among them: {", ".join(counts)}.
inline const ConfidenceFit kConfidenceFit{{
    {{{{{(","+chr(10)+"      ").join(numbers)}}}}},
    {{{{{", ".join(intervals)}}}}}}};
// clang-format on
"""


def program(arguments):
    items = [*bench.list_models(arguments), *(f"shape {i}" for i in range(arguments.shapes))]
    table = Table(fits.sampled(items, sample_item, arguments))
    fit, errors = fit_table(table)
    print_fit(table, fit, "Models of the fit")
    includes = (["<array>", "<vector>"], ['"core/evidence/plane_confidence.h"'])
    fits.write_header(arguments, header(table, fit, errors), includes)


if __name__ == "__main__":
    fits.main(program, __doc__, OUTPUT, shapes=dict(type=int, default=NUM_SHAPES, help="number of clouds of shapes made by code"))
