"""Fits the weights that merge patches of a surface into parts, and writes the header that holds them.

usage: PYTHONPATH=build/src/python python3 test/benchmark/fit_segments.py PSEG/off --people PSEG/seg/Benchmark

Meshes of the Princeton Segmentation Benchmark with odd numbers, of the categories whose number (Human is 0) is 0 or 1
modulo 3; those of the others are for figures. Merges are made with weights, what people say of each is fitted, and so
on, from a rule that merges small regions first; the constant is then moved to the least mean Rand distance. There are
two fits: with all cues, and without those of an inside, for surfaces that are seen from one side.
"""
import concurrent.futures
import pathlib
import sys

import numpy as np
import pcl_symmetry

import bench
import fits
import segmentation

OUTPUT = "src/core/segmentation/merge_fit.h"
NUM_CUES = 14
KINDS = {"concavity": list(range(9)), "all": list(range(NUM_CUES))}  # cues, in the order of MergingEvidence
FIRST_RULE = np.r_[-4.0, 1, -1, -1, np.zeros(10)]  # small regions first, until areas are about a tenth of the surface
NUM_ROUNDS, ROUNDS_OF_FIT = 8, 2  # the best counts; fitted to one round alone, the weights swing from round to round
BEYOND = 6  # merges beyond even odds that count as cases: the borders of parts
AREA_POWER = 0.75  # of the product of areas, weight of a merge: with 1 first merges, with 0.5 parts have too little
SHIFTS = np.arange(-3, 3.001, 0.05)


class People:
    """The patches of a mesh, and the segments that people made of it."""

    def __init__(self, path, folder):
        mesh = bench.read_mesh(path)
        self.name, self.merging = path.stem, pcl_symmetry.Merging(mesh.vertices.astype(np.float32), mesh.triangles, threads=1)
        patches = np.array(self.merging.patches)
        files = sorted(p for p in folder.rglob(f"{path.stem}_*.seg"))
        if not files:
            raise bench.BadInput(f"{path}: no .seg file in {folder}")
        self.counts = []  # for each person, faces of each patch in each segment
        for file in files:
            labels = segmentation.read_labels(file, mesh)
            counts = np.zeros((patches.max() + 1, labels.max() + 1))
            np.add.at(counts, (patches, labels), 1)
            self.counts.append(counts)

    def run(self, weights):
        """(cases: cues, share of pairs of faces that people put together, weight; Rand distance after each merge; odds)"""
        merges = self.merging.merges(weights.tolist())
        counts = [c.copy() for c in self.counts]
        pairs = lambda c: (c * (c - 1)).sum() / 2
        all_pairs = pairs(counts[0].sum())
        rand = [np.mean([(pairs(c.sum(1)) + pairs(c.sum(0)) - 2 * pairs(c)) / all_pairs for c in counts])]
        cases = []
        likely = int(np.argmax(np.r_[merges["log_odds"], -1] <= 0))
        for i, merge in enumerate(merges):
            a, b = merge["into"], merge["from"]
            between = counts[0][a].sum() * counts[0][b].sum()
            together = np.mean([c[a] @ c[b] for c in counts])
            weight = merge["area_into"] * merge["area_from"]
            if i < likely + BEYOND and between > 0 and weight > 0:
                cases.append(np.r_[merge["cues"], together / between, weight**AREA_POWER])
            for c in counts:
                c[a] += c[b]
                c[b] = 0
            rand.append(rand[-1] + (between - 2 * together) / all_pairs)
        return np.array(cases), np.array(rand), np.minimum.accumulate(merges["log_odds"])


def read(path, folder):
    """A mesh with its people; one that cannot be used costs one sentence and itself only."""
    try:
        return People(path, folder)
    except ValueError as error:
        print(f"{path}: {error}", file=sys.stderr)
    except bench.BadInput as error:
        print(error, file=sys.stderr)


def fit_kind(meshes, cues, pool):
    """(weights, errors, Rand distance, number of cases) of the best round."""
    weights, rounds, best = FIRST_RULE, [], None
    for _ in range(NUM_ROUNDS + 1):
        rounds = [*rounds, list(pool.map(lambda mesh: mesh.run(weights), meshes))][-ROUNDS_OF_FIT:]
        if weights is not FIRST_RULE:
            ends = [rand[np.searchsorted(-odds, -SHIFTS)] for _, rand, odds in rounds[-1]]
            distance = np.mean(ends, axis=0)
            at = int(np.argmin(distance))
            if best is None or distance[at] < best[2]:
                moved = weights - SHIFTS[at] * np.eye(NUM_CUES)[0]
                best = moved[cues], errors, float(distance[at]), len(cases)
        cases = np.concatenate([case for one in rounds for case, _, _ in one])
        weights = np.zeros(NUM_CUES)
        weights[cues], errors = fits.logistic(cases[:, cues], cases[:, -2], cases[:, -1], least=0)
    return best


def header(results, num_meshes):
    rows = []
    for name, (weights, errors, rand, _) in results.items():
        texts = fits.rounded(weights, errors) + ["0"] * (NUM_CUES - len(weights))
        rows.append(f"// {name}: Rand distance {rand:.3f}\n     {{{', '.join(texts)}}}")
    return f"""
// Log odds per unit of each cue, by MergingEvidence, fitted to {num_meshes} meshes that people cut into parts.
inline constexpr std::array<MergeWeights, {len(rows)}> kMergeFit{{
    {{{(','+chr(10)+'     ').join(rows)}}}}};
"""


def program(arguments):
    folder = pathlib.Path(arguments.people)
    models = [pathlib.Path(model.path) for model in segmentation.chosen_models(arguments, (0, 1))]
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:  # the module works without Python's lock
        meshes = [mesh for mesh in pool.map(lambda path: read(path, folder), models) if mesh]
        if not meshes:
            raise bench.BadInput("nothing could be fitted")
        results = {name: fit_kind(meshes, cues, pool) for name, cues in KINDS.items()}
    lines = [[name, num, f"{rand:.4f}", " ".join(fits.rounded(w, e))] for name, (w, e, rand, num) in results.items()]
    bench.print_table(f"{len(meshes)} meshes", ["evidence", "merges", "Rand distance of patches", "weights"], lines)
    fits.write_header(arguments, header(results, len(meshes)), (['"core/segmentation/region_merging.h"'],))


if __name__ == "__main__":
    fits.main(program, __doc__, OUTPUT, people=dict(required=True, help="folder with the segments of people: 12/12_0.seg or 12_0.seg"))
