"""How well shapes find others of their class (Section 5.2): the descriptors of Figures 12 to 14, and this library's.

retrieval.py PSB --classes train.cla --json retrieval.json --figure recall.png

Each model asks for the others of its class (Princeton Shape Benchmark). Descriptors of the paper are those of
pcl_symmetry.descriptors(), about the center of mass, in a ball of twice the mean distance of the points from it:

  PRST, PRSD   sqrt(D) of 32 x 32 x 32 planes, and of the 32 x 32 through the center; L2, weighted by sqrt(sin theta)
  by maximum   the greatest difference, as Kazhdan et al. (2004) compare PRSD
  GEDT         exp(-distance^2 / sigma^2) at 32 x 32 x 32 places; L2
  equation 1   sqrt((1 + D) / 2) in place of sqrt(D)
  x            the product of two distances

in axes of the files, and of each model turned at random, in the axes of its symmetry and in principal axes. "All turns"
compares PRST and GEDT in all 24 orders and signs of the symmetry axes, each shape as it is and stretched to equal spread.
Signatures are pcl_symmetry.describe() compared in the same way; "database" is Database.match().
"""
import itertools
import pathlib
import tempfile

import numpy as np
import pcl_symmetry
from scipy.spatial import cKDTree

import bench

NUM_POINTS = 20_000
NUM_RECALLS = 20
NUM_CONSIDERED = 32  # of the E-measure
NUM_REFERENCES, NUM_NEAREST = 200, 10  # models, of any class, and the nearest of them, that scale distances
AXES = {"files": "axes of the files", "symmetry": "symmetry axes", "principal": "principal axes"}
MEASURES = {"nearest": "nearest", "tier1": "tier 1", "tier2": "tier 2", "e": "E", "dcg": "DCG"}
ROTATIONS = [(order, np.array(signs)) for order in itertools.permutations(range(3))
             for signs in itertools.product((1, -1), repeat=3) if np.linalg.det(np.eye(3)[list(order)] * signs) > 0]  # fmt: skip


def gedt(points, num_cells):
    """(n, n, n) values of the Gaussian distance transform in a ball of radius 1, sigma = two cells, x first."""
    cell = 1 / (num_cells / 2 - 4)  # a margin of two sigmas
    along = cell * (np.arange(num_cells) - (num_cells - 1) / 2)
    cells = np.stack(np.meshgrid(along, along, along, indexing="ij"), -1).reshape(-1, 3)
    distances = cKDTree(points).query(cells, distance_upper_bound=2.6 * 2 * cell)[0]
    return np.exp(-((distances / (2 * cell)) ** 2)).reshape(3 * [num_cells])


def prst(points, bins):
    """sqrt(D) of planes (theta, phi, r) within distance 1 of the origin."""
    map_ = pcl_symmetry.transform(points, bins, radius=1.0, sigma=1 / 16, threads=1)
    return np.sqrt(np.maximum(map_.values, 0))


def in_ball(points, reach):
    """Points in units of `reach` times their mean distance from the origin."""
    return points / (reach * np.linalg.norm(points, axis=1).mean())


def describe(model, arguments):
    """Writes the descriptors of one model, half precision; a worker on another machine needs the same folder."""
    mesh = bench.read_mesh(model.path)
    random = bench.generator(arguments.seed, model.key)
    cloud = bench.sample(mesh, NUM_POINTS, random)
    turned = (cloud - mesh.center) @ bench.random_rotation(random).T
    frame = pcl_symmetry.frame(turned, viewpoint=None, threads=1).axes
    principal = np.linalg.eigh(np.cov(turned.T))[1][:, ::-1]
    axes = {"files": (cloud, np.eye(3)), "symmetry": (turned, frame), "principal": (turned, right_handed(principal))}
    forms = {}
    for name, (points, columns) in axes.items():
        of_paper = pcl_symmetry.descriptors((points - points.mean(0)) @ columns, input_axes=True, threads=1)
        forms.update({f"{form} {name}": values for form, values in zip(("prst", "prsd", "gedt"), of_paper)})
    points = turned @ right_handed(frame)  # about the point half-way between center of mass and middle of the extent
    points = points - 0.5 * (points.mean(0) + 0.5 * (points.min(0) + points.max(0)))
    spread = np.sqrt((points**2).mean(0))
    shapes = [in_ball(points, 2.2), in_ball(points / np.maximum(spread, 0.05 * spread.max()), 2.0)]
    forms["prst turns"] = [prst(shape, (24, 48, 24)) for shape in shapes]
    forms["gedt turns"] = [gedt(shape, 24) for shape in shapes]
    signature = pcl_symmetry.describe(turned, viewpoint=None, threads=1)[0]
    forms["signature"] = signature.reshape(2, 6, 12, 12, 12).transpose(0, 1, 4, 3, 2)
    np.savez(pathlib.Path(arguments.descriptors, model.name), turned=turned.astype(np.float32),
             **{name: np.asarray(values, np.float16) for name, values in forms.items()})  # fmt: skip
    return True


def right_handed(axes):
    return axes * [1, 1, np.sign(np.linalg.det(axes))]


# Rotations that map the axes onto each other: axis a of the rotated shape is axis order[a], times signs[a]


def rotated_cubes(cubes, order, signs):
    """Rotates (..., n, n, n) values at cells."""
    first = cubes.ndim - 3
    turned = cubes.transpose(*range(first), *(first + axis for axis in order))
    return np.flip(turned, [first + a for a in range(3) if signs[a] < 0])


def rotated_signatures(signatures, order, signs):
    """Rotates (N, 2, 6, n, n, n) products of the normals xx, yy, zz, yz, zx, xy."""
    pairs = [(0, 0), (1, 1), (2, 2), (1, 2), (2, 0), (0, 1)]
    index = lambda a, b: a if a == b else 6 - a - b
    source = [index(order[a], order[b]) for a, b in pairs]
    flips = np.array([signs[a] * signs[b] for a, b in pairs], np.float32)
    return rotated_cubes(signatures[:, :, source] * flips[:, None, None, None], order, signs)


def rotated_planes(maps, order, signs):
    """Rotates (..., theta, phi, r) values at planes; each takes the value of the nearest direction."""
    num_theta, num_phi = maps.shape[-3:-1]
    theta, phi = np.meshgrid((np.arange(num_theta) + 0.5) * np.pi / 2 / num_theta,
                             (np.arange(num_phi) + 0.5) * 2 * np.pi / num_phi, indexing="ij")  # fmt: skip
    normals = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], -1)
    source = np.empty_like(normals)
    source[..., list(order)] = normals * signs
    opposite = source[..., 2] < 0
    source = np.where(opposite[..., None], -source, source)
    t = np.minimum((np.arccos(np.clip(source[..., 2], -1, 1)) * num_theta / (np.pi / 2)).astype(int), num_theta - 1)
    p = (np.arctan2(source[..., 1], source[..., 0]) % (2 * np.pi) * num_phi / (2 * np.pi)).astype(int) % num_phi
    values = maps[..., t, p, :]
    return np.where(opposite[..., None], values[..., ::-1], values)


# Distances of N models, (N, N): pcl_symmetry.descriptor_distance() of all pairs at once


def l2(rows):
    rows = rows.reshape(len(rows), -1).astype(np.float32)
    squares = (rows**2).sum(1)
    return np.sqrt(np.maximum(squares[:, None] + squares - 2 * rows @ rows.T, 0))


def plane_weights(shape):
    """Roots of the sizes of the bins, sqrt(sin theta)."""
    return np.sqrt(np.sin((np.arange(shape[0]) + 0.5) * np.pi / 2 / shape[0]))[:, None, None].astype(np.float32)


def unit(rows):
    """Rows of unit norm; each of the two shapes counts for half."""
    rows = rows.astype(np.float32)
    norms = np.sqrt((rows**2).sum(tuple(range(2, rows.ndim)), keepdims=True))
    return rows / np.maximum(norms, 1e-30) * np.float32(np.sqrt(0.5))


def least_distances(*forms):
    """Distances in that rotation of the axes where the product over all forms (rows, rotate, unit) is least."""
    size = len(forms[0][0])
    flat = lambda rows: rows.reshape(len(rows), -1)
    units = [flat(unit(rows)) for rows, _, unit in forms]
    least = np.full((size, size), np.inf, np.float32)
    for rotation in ROTATIONS:
        for first in range(0, size, 64):
            block = slice(first, first + 64)
            product = np.float32(1)
            for units_of_all, (rows, rotate, unit) in zip(units, forms):
                cosines = units_of_all @ flat(unit(rotate(rows[block], *rotation))).T
                product = product * np.sqrt(np.maximum(2 - 2 * cosines, 0))
            least[:, block] = np.minimum(least[:, block], product)
    return np.minimum(least, least.T)


def scaled(distances, seed):
    """Distances divided by the roots of both models' mean distance to the nearest of the references."""
    size = len(distances)
    references = bench.generator(seed, "references").permutation(size)[:NUM_REFERENCES]
    to_references = distances[:, references].copy()
    to_references[references, np.arange(len(references))] = np.inf
    nearest = np.sort(to_references, axis=1)[:, :NUM_NEAREST]
    typical = np.array([row[np.isfinite(row)].mean() if np.isfinite(row).any() else 1 for row in nearest])
    return distances / np.sqrt(np.outer(typical, typical) + 1e-30)


def published(load, axes):
    """{row: distances} of the paper's descriptors in one kind of axes."""
    roots, through_center, f = load(f"prst {axes}"), load(f"prsd {axes}"), load(f"gedt {axes}")
    weights = plane_weights(roots.shape[1:])
    rows = {"PRSD by maximum": np.stack([np.abs(through_center - one).max((1, 2)) for one in through_center])}
    rows |= {"PRSD": l2(weights[..., 0] * through_center), "PRST": l2(weights * roots), "GEDT": l2(f)}
    rows["PRST by equation 1"] = l2(weights * np.sqrt((1 + roots**2) / 2))
    rows["PRST x GEDT"] = rows["PRST"] * rows["GEDT"]
    rows["PRST by equation 1 x GEDT"] = rows["PRST by equation 1"] * rows["GEDT"]
    return {f"{name}, {AXES[axes]}": distances for name, distances in rows.items()}


def in_all_turns(load, seed):
    maps = load("prst turns")
    prst_form = maps, rotated_planes, lambda rows: unit(plane_weights(maps.shape[2:]) * rows)
    gedt_form = load("gedt turns"), rotated_cubes, unit
    rows = {"PRST": [prst_form], "GEDT": [gedt_form], "PRST x GEDT": [prst_form, gedt_form],
            "signatures": [(load("signature"), rotated_signatures, unit)]}  # fmt: skip
    found = {}
    for name, parts in rows.items():
        found[f"{name}, all turns"] = least_distances(*parts)
        found[f"{name}, all turns, scaled"] = scaled(found[f"{name}, all turns"], seed)
    return found


def by_database(clouds, seed):
    """Database.match(): each cloud, turned once more, asks a database of all."""
    distances = np.full((len(clouds), len(clouds)), 1e6, np.float32)
    with tempfile.TemporaryDirectory() as folder:
        database = pcl_symmetry.Database(f"{folder}/models.db", create=True, threads=1)
        database.build((str(i), cloud) for i, cloud in enumerate(clouds))
        for i, cloud in enumerate(clouds):
            turned = cloud @ bench.random_rotation(bench.generator(seed, "query", i)).T
            for match in database.match(turned, len(clouds), viewpoint=None):
                distances[int(match.name), i] = match.distance
    return {"Database.match": distances}


def relevant_ranks(distances, classes, query):
    """Ranks, from 1, of the models of the query's class among all others; equal distances go by index."""
    order = np.argsort(distances[:, query], kind="stable")
    order = order[order != query]
    return np.flatnonzero(classes[order] == classes[query]) + 1


def scores(ranks):
    """Measures of one query (Shilane et al. 2004), in [0, 1], and the precision where each recall is reached."""
    k = len(ranks)
    gain = lambda rank: 1 / np.maximum(np.log2(rank), 1)  # 1, 1, 1 / log2(3), ...
    found = lambda considered: np.sum(ranks <= considered)
    needed = np.maximum(1, -(-k * np.arange(1, NUM_RECALLS + 1) // NUM_RECALLS))
    return {"nearest": float(ranks[0] == 1), "tier1": found(k) / k, "tier2": found(2 * k) / k,
            "e": 2 * found(NUM_CONSIDERED) / (NUM_CONSIDERED + k),
            "dcg": gain(ranks).sum() / gain(np.arange(1, k + 1)).sum(), "precision": needed / ranks[needed - 1]}  # fmt: skip


def judge(distances, classes):
    """{measure: values of all queries}; a model that is alone in its class is no query."""
    ranks = [relevant_ranks(distances, classes, query) for query in range(len(classes))]
    queries = [scores(r) for r in ranks if len(r)]
    values = {name: np.array([query[name] for query in queries]) for name in (*MEASURES, "precision")}
    return {**values, "class": np.array([c for c, r in zip(classes, ranks) if len(r)])}


def interval(values, classes):
    """Mean of values of queries and its 95 % interval, by drawing classes anew: queries of a class are alike."""
    names, index = np.unique(classes, return_inverse=True)
    sums, counts = np.bincount(index, values), np.bincount(index)
    drawn = np.random.default_rng(1).integers(len(names), size=(2000, len(names)))
    means = np.sort(sums[drawn].sum(1) / counts[drawn].sum(1))
    return float(np.mean(values)), float(means[50]), float(means[-51])


def report(judged):
    """Prints the tables of a run and returns what they hold."""
    percent = lambda values: [f"{100 * v:.1f}" for v in values]
    num_queries = len(next(iter(judged.values()))["class"])
    rows = []
    for name, q in judged.items():
        nearest, dcg = (interval(q[m], q["class"]) for m in ("nearest", "dcg"))
        between = ["{} ({} to {})".format(*percent(v)) for v in (nearest, dcg)]
        rows.append([name, between[0], *percent(q[m].mean() for m in ("tier1", "tier2", "e")), between[1]])
    title = f"Per cent of {num_queries} queries, 95 % intervals by drawing classes anew"
    bench.print_table(title, ["", *MEASURES.values()], rows)
    by_class = classes_by_gain(judged)
    ends = by_class[:5] + by_class[5:][-5:]
    bench.print_table("Classes that PRST finds best and worst compared with GEDT (Figure 14), DCG in axes of the files",
                      ["", "PRST", "GEDT", "product"], [[c["class"], *percent(c["dcg"])] for c in ends])  # fmt: skip
    methods = {name: {**{m: float(q[m].mean()) for m in MEASURES}, "precision": q["precision"].mean(0).tolist(),
                      "nearest interval": interval(q["nearest"], q["class"])} for name, q in judged.items()}  # fmt: skip
    return {"queries": num_queries, "methods": methods, "classes": by_class}


def classes_by_gain(judged):
    rows = [judged[f"{name}, axes of the files"] for name in ("PRST", "GEDT", "PRST x GEDT")]
    of_class = lambda c: [float(q["dcg"][q["class"] == c].mean()) for q in rows]
    found = [{"class": str(c), "dcg": of_class(c)} for c in np.unique(rows[0]["class"])]
    return sorted(found, key=lambda c: c["dcg"][1] - c["dcg"][0])


def draw_curves(judged, names, title, axes):
    """Figure 13: precision against recall, with 95 % bands."""
    recalls = np.arange(1, NUM_RECALLS + 1) / NUM_RECALLS
    for name in names:
        q = judged[name]
        mean, low, high = np.transpose([interval(q["precision"][:, k], q["class"]) for k in range(NUM_RECALLS)])
        (line,) = axes.plot(recalls, mean, label=name)
        axes.fill_between(recalls, low, high, color=line.get_color(), alpha=0.12)
    axes.set(xlabel="recall", ylabel="precision", xlim=(0, 1), ylim=(0, 1), title=title)
    axes.legend(fontsize="small")


def draw_classes(by_class, axes):
    """Figure 14: what PRST and the product gain over GEDT, class by class."""
    dcg = 100 * np.array([c["dcg"] for c in by_class])
    axes.plot(dcg[:, 0] - dcg[:, 1], "o", ms=4, label="PRST")
    axes.plot(dcg[:, 2] - dcg[:, 1], "s", ms=4, label="PRST x GEDT")
    axes.axhline(0, color="black", lw=1)
    axes.set(xlabel="class, by what PRST gains", ylabel="DCG less that of GEDT, points", title="Classes, axes of the files")
    axes.legend()


CURVES = {"files": ("axes of the files", [f"{name}, axes of the files" for name in ("PRSD", "PRST", "GEDT", "PRST x GEDT")]),
          "turned": ("models turned at random", ["PRST x GEDT, principal axes", "PRST x GEDT, symmetry axes", "PRST, all turns",
                     "GEDT, all turns", "PRST x GEDT, all turns", "signatures, all turns, scaled", "Database.match"])}  # fmt: skip


def draw(judged, by_class, path):
    path = pathlib.Path(path)
    for end, (title, names) in CURVES.items():
        bench.save_figure(path.with_stem(f"{path.stem}_{end}"), lambda axes: draw_curves(judged, names, title, axes))
    bench.save_figure(path.with_stem(f"{path.stem}_classes"), lambda axes: draw_classes(by_class, axes))


def distances_of(models, arguments):
    """{row: distances}, row by row of the table: matrices of all rows would fill the memory."""
    def load(form):
        return np.stack([np.load(pathlib.Path(arguments.descriptors, f"{m.name}.npz"))[form].astype(np.float32) for m in models])

    for axes in AXES:
        yield from published(load, axes).items()
    yield from in_all_turns(load, arguments.seed).items()
    yield from by_database(load("turned"), arguments.seed).items()


def main(arguments):
    if not arguments.classes:
        raise bench.BadInput("--classes FILE is missing: it says which models belong together")
    with tempfile.TemporaryDirectory() as temporary:
        arguments.descriptors = bench.work_folder(arguments, temporary)
        models, class_of = bench.list_models(arguments), bench.read_classes(arguments.classes)
        _, left_out = bench.run(models, describe, arguments)
        models = [m for m in models if pathlib.Path(arguments.descriptors, f"{m.name}.npz").exists()]
        classes = np.array([class_of[model.name].name for model in models])
        if np.unique(classes, return_counts=True)[1].max() < 2:
            raise bench.BadInput(f"{arguments.classes}: no class holds two of the meshes")
        judged = {name: judge(distances, classes) for name, distances in distances_of(models, arguments)}
    summary = report(judged)
    if arguments.figure:
        draw(judged, summary["classes"], arguments.figure)
    bench.write_json(arguments, {**summary, "left_out": left_out})


if __name__ == "__main__":
    parser = bench.make_parser(__doc__, others=False)
    parser.add_argument("--figure", metavar="FILE.png", help="draw FILE_files.png, FILE_turned.png and FILE_classes.png")
    bench.main(main, parser.parse_args())
