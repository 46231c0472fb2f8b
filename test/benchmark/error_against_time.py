#!/usr/bin/env python3
"""Error of the estimators of the transform on meshes against the time of one thread (Figure 6).

bash apps/fetch_meshes.sh meshes bull cow elephant hand camel
error_against_time.py meshes --grids 32,64 --figure error.png

Errors are of PRST, against the full sum with exact distances at random planes of the grid; those of voting, which estimates
averages over bins, against the convolution on a grid of twice as many bins along each side. A grid of N has N^3 cells, too.
"""
import time

import numpy as np
import pcl_symmetry
from scipy.spatial import cKDTree

import bench
import references

SETTINGS = {
    "sampled": [dict(samples=n) for n in (32, 128, 512, 2048)],
    "convolution": [dict()],
    "rotational": [dict(refined_share=0.1), dict()],
    "voting": [dict(samples=n) for n in (200_000, 2_000_000, 20_000_000)],
    "voting as published": [dict(samples=n, as_published=True) for n in (200_000, 2_000_000, 20_000_000)],
}
NUM_PLANES = 300


def prst(d):
    return np.sqrt(np.maximum(0, (1 + d) / 2))


def full_sums(points, map_, bins, grid):
    """D of some bins: sum f(x) f(gamma x) / sum f(x)^2 over a lattice of grid^3 cells, with exact distances."""
    tree, half = cKDTree(points), map_.radius + 3 * map_.sigma
    lattice = map_.center + half * ((np.indices((grid,) * 3).reshape(3, -1).T + 0.5) * 2 / grid - 1)
    f = lambda x: np.exp(-((tree.query(x, distance_upper_bound=3 * map_.sigma)[0] / map_.sigma) ** 2))
    lattice = lattice[tree.query(lattice, distance_upper_bound=3 * map_.sigma)[0] < 2.7 * map_.sigma]
    values = f(lattice)
    planes = np.array([map_.plane(*bin_) for bin_ in bins]) * (1, 1, 1, -1)
    return np.array([values @ f(references.reflect(plane[None], lattice)[0]) for plane in planes]) / (values @ values)


def evaluate(model, arguments):
    mesh, rows = bench.read_mesh(model.path), []
    points = bench.sample(mesh, 10_000, bench.generator(arguments.seed, model.key)).astype("f")
    for grid in arguments.grids:
        ask = lambda n=grid, **options: pcl_symmetry.transform(points, (n,) * 3, cells=grid, threads=1, **options)
        fine = ask(2 * grid, method="convolution").values.reshape(grid, 2, grid, 2, grid, 2)
        sines = np.sin((np.arange(2 * grid) + 0.5) * np.pi / (4 * grid)).reshape(grid, 2, 1, 1, 1, 1)
        averages = (fine * sines).mean((1, 3, 5)) / sines.mean(1)[..., 0, 0]
        bins = tuple(bench.generator(arguments.seed, model.key, grid).integers(grid, size=(3, NUM_PLANES)))
        sums = full_sums(points, ask(samples=1), np.transpose(bins), grid)
        for method in arguments.methods:
            for options in SETTINGS[method]:
                start = time.process_time()
                found = ask(method=method.split()[0], **options).values
                seconds, voted = time.process_time() - start, method.startswith("voting")
                error = np.abs(prst(found) - prst(averages)) if voted else np.abs(prst(found[bins]) - prst(sums))
                rows.append((grid, method, str(options.get("samples", options.get("refined_share", ""))), 1000 * seconds,
                             100 * np.sqrt((error**2).mean()), 100 * np.median(error), found.max()))  # fmt: skip
    return rows


def program(arguments):
    found, _ = bench.run(bench.list_models(arguments), evaluate, arguments)
    keys = list(dict.fromkeys(row[:3] for rows in found for row in rows))
    means = {key: np.mean([row[3:] for rows in found for row in rows if row[:3] == key], axis=0) for key in keys}
    header = ["grid", "estimator", "setting", "ms", "root mean square, %", "median, %", "greatest D"]
    cells = [[*key, *(f"{v:.{d}f}" for v, d in zip(means[key], (1, 2, 2, 2)))] for key in keys]
    bench.print_table(f"Error of PRST, mean of {len(found)} meshes", header, cells)

    def draw(axes):
        for grid, method in dict.fromkeys(key[:2] for key in keys):
            curve = np.array([means[key] for key in keys if key[:2] == (grid, method)])
            axes.loglog(curve[:, 0], curve[:, 2], "o-", label=f"{method}, {grid}")
        axes.axhline(1.0, color="gray", linewidth=0.8)
        axes.set(xlabel="time of one thread [ms]", ylabel="median error of PRST [%]")
        axes.legend(fontsize=7)

    if arguments.figure:
        bench.save_figure(arguments.figure, draw)


if __name__ == "__main__":
    parser = bench.make_parser(__doc__)
    parser.add_argument("--grids", type=bench.numbers(int), default="32,64", help="bins and cells along each side")
    parser.add_argument("--methods", type=bench.numbers(str, SETTINGS), default=",".join(SETTINGS), help="of " + ",".join(SETTINGS))
    bench.main(program, parser.parse_args())
