"""Fits the probabilities that a frame is the one in which people put a shape, and writes the header of their weights.

usage: PYTHONPATH=build/src/python python3 test/benchmark/fit_frames.py PSB --classes train.cla --fold 0

A whole cloud and two scans of each model, in random poses, give frames with their evidence x. A frame is right where
its axes, in any order and sign, are within 5 degrees of those of the file; about an axis of revolution at any angle.
The probability of a frame is exp(w.x) / (1 + the sum of exp(w.x) over all frames of the cloud), a conditional logit
whose 1 counts for "none of them" (McFadden 1974); w maximizes the likelihood that one of the right frames is right.
"""
import numpy as np
import pcl_symmetry
from scipy.optimize import minimize
from scipy.special import logsumexp

import bench
import fits
import frames

OUTPUT = "src/core/frame/frame_fit.h"
PULL = 0.3  # of each weight to 0, clouds; at half of it no weight moves by a tenth
VIEWS = 2


def is_right(found, own):
    about = found.axes[:, found.revolution_axis] if 0 <= found.revolution_axis < 3 else None
    return found.revolution_axis == 3 or frames.angle_of_axes(found.axes, own, about) < frames.RIGHT_ANGLE


def sample_item(item, arguments):
    """A row for each cloud: whether it is a scan, what is right, and the evidence of its frames."""
    mesh, rows = bench.read_mesh(item.path), []
    for view in range(VIEWS + 1):
        random = bench.generator(arguments.seed, item.key, "frames", view)
        pose, viewpoint = bench.random_pose(random, mesh), "auto"
        if view == 0:
            points = bench.moved(pose, bench.sample(mesh, 10_000, random))
        else:
            scan = bench.scan(mesh, bench.CUBE_CORNERS[view - 1], random, pose=pose)
            points, viewpoint = scan.rows, scan.viewpoint
        frame = pcl_symmetry.frame(points.astype(np.float32), viewpoint=viewpoint, threads=1)
        right = [is_right(p, pose[:3, :3]) for p in frame.probable]
        rows.append([view > 0, right, [list(map(float, row)) for row in frame.evidence.tolist()]])
    return rows


def fit_weights(rows):
    """(weights, their standard errors)"""
    clouds = [(np.array(right, bool), np.array(x)) for _, right, x in rows if x]
    if len(clouds) < fits.LEAST_EXAMPLES:
        raise bench.BadInput(f"{len(clouds)} clouds of a kind, must be {fits.LEAST_EXAMPLES} or more")

    def loss(w):
        total, slope = 0.5 * PULL * w @ w, PULL * w
        for right, x in clouds:
            odds = np.r_[0, x @ w]
            p = np.exp(odds - logsumexp(odds))[1:]
            chosen = right if right.any() else None
            # Where no frame is right, "none of them" is, whose odds are 1.
            total -= (logsumexp(odds[1:][chosen]) if chosen is not None else 0) - logsumexp(odds)
            share = np.where(right, p, 0) / p[right].sum() if chosen is not None else 0
            slope = slope - (share - p) @ x
        return total, slope

    size = len(clouds[0][1][0])
    found = minimize(loss, np.zeros(size), jac=True, method="BFGS", options={"gtol": 1e-6, "maxiter": 500})
    return found.x, np.sqrt(np.diag(found.hess_inv))


def header(fit, num_clouds, num_models):
    numbers = ["{" + ", ".join(fits.rounded(*both)) + "}" for both in fit]
    return f"""
/// Weights of frameProbabilities(): of whole clouds and of scans.
struct FrameFit {{
  std::array<double, 8> whole, scan;
}};

// Fitted to {num_clouds} clouds of {num_models} models.
constexpr FrameFit kFrameFit{{{numbers[0]},
                             {numbers[1]}}};
"""


def program(arguments):
    models = bench.list_models(arguments)
    rows = fits.sampled(models, sample_item, arguments)
    fit = [fit_weights([row for row in rows if row[0] == scanned]) for scanned in (False, True)]
    fits.write_header(arguments, header(fit, len(rows), len(rows) // (VIEWS + 1)), (["<array>"],))


if __name__ == "__main__":
    fits.main(program, __doc__, OUTPUT)
