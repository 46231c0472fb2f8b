"""Error of the estimators of the transform against the time of one thread (Figure 6): a table and a picture.

Root mean square and median over bins of the error of PRST, means of the meshes, n x n x n cells and bins. Voting estimates
averages over bins and is judged by those of an exact map twice as fine, the others by the sum over all cells.

example: error_against_time.py error.png bull.off cow.off elephant.off hand.off camel.off
"""
import time
from collections import defaultdict

import numpy as np
import pcl_symmetry
from scipy.spatial import cKDTree

import bench

PAIRS = [20_000, 200_000, 2_000_000, 20_000_000]
# Estimator, what it is called with, and settings: sizes n of the grid, and samples or pairs.
CURVES = [(f"voting, {n}", dict(method="voting"), [(n, pairs) for pairs in PAIRS]) for n in (16, 32, 64)]
CURVES += [(f"voting as published, {n}", dict(method="voting", as_published=True), [(n, pairs) for pairs in PAIRS]) for n in (16, 32, 64)]
CURVES += [("sampled, 64", dict(method="sampled"), [(64, samples) for samples in (32, 128, 512, 2048)])]
CURVES += [(f"{method}, 16 to 64", dict(method=method), [(n, 0) for n in (16, 32, 64)]) for method in ("convolution", "rotational")]


def prst(d):
    return np.sqrt(np.maximum(0, (1 + d) / 2))


def averages(points, n):
    """(n, n, n) D over each bin: the mean of two by two by two bins in one."""
    fine = pcl_symmetry.transform(points, (2 * n,) * 3, cells=n, method="convolution").values
    return fine.reshape(n, 2, n, 2, n, 2).mean(axis=(1, 3, 5))


def at_centers(points, n, bins):
    """D of some bins as the sum of f(x) f(gamma x) over cells 0.7 sigma wide, with exact distances."""
    grid = pcl_symmetry.transform(points, (n,) * 3, cells=n, samples=1)
    surface = cKDTree(points)

    def f(x):
        return np.exp(-((surface.query(x, distance_upper_bound=3 * grid.sigma, workers=-1)[0] / grid.sigma) ** 2))

    side = np.arange(-grid.radius - 3 * grid.sigma, grid.radius + 3 * grid.sigma, 0.7 * grid.sigma)
    cells = np.stack(np.meshgrid(side, side, side), axis=-1).reshape(-1, 3) + grid.center
    values = f(cells)
    cells, values = cells[values > 0], values[values > 0]
    result = []
    for a, b, c, d in (grid.plane(*each) for each in bins):
        normal = np.array([a, b, c])
        result.append(values @ f(cells - 2 * np.outer(cells @ normal + d, normal)) / (values @ values))
    return np.array(result)


def program(arguments):
    rows = defaultdict(list)
    for path in arguments.meshes:
        points = bench.sample(bench.read_mesh(path), 10_000, np.random.default_rng(1)).astype("f")
        exact = {}
        for n in (16, 32, 64):
            bins = np.random.default_rng(3).integers(n, size=(100, 3))
            exact[n] = averages(points, n), bins, at_centers(points, n, bins)
        for name, options, settings in CURVES:
            for n, samples in settings:
                options = {**options, "bins": (n,) * 3, "cells": n, "samples": samples, "threads": 1}
                found, milliseconds = bench.timed(pcl_symmetry.transform, points, clock=time.process_time, **options)
                found, (means, bins, sums) = found.values, exact[n]
                errors = prst(found) - prst(means) if "voting" in name else prst(found[tuple(bins.T)]) - prst(sums)
                rows[name, n, samples].append((milliseconds, 100 * np.sqrt((errors**2).mean()), 100 * np.median(np.abs(errors))))
    means = {key: np.mean(each, axis=0) for key, each in rows.items()}
    cells = [[f"{name.split(',')[0]}, {n}", samples or "all", f"{milliseconds:.0f}", f"{rms:.2f}", f"{median:.2f}"]
             for (name, n, samples), (milliseconds, rms, median) in means.items()]  # fmt: skip
    bench.print_table("Errors of PRST", ["estimator, n", "samples", "ms", "root mean square, %", "median, %"], cells)

    def draw(axes):
        for name, _, settings in CURVES:
            milliseconds, rms, median = np.transpose([means[(name, *setting)] for setting in settings])
            (line,) = axes.loglog(milliseconds, rms, "o-", label=name)
            axes.loglog(milliseconds, median, "--", color=line.get_color(), linewidth=1)
        axes.axhline(1.0, color="gray", linewidth=0.8)
        axes.set(xlabel="time of one thread [ms]", ylabel="error of PRST [%]: root mean square, dashed median")
        axes.legend(fontsize=8)

    bench.save_figure(arguments.picture, draw)


if __name__ == "__main__":
    parser = bench.plain_parser(__doc__)
    parser.add_argument("picture", help="file that is written")
    parser.add_argument("meshes", nargs="+", help="OFF files")
    bench.main(program, parser.parse_args())
