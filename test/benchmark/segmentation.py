"""How close segmentations come to those that people made (Section 5.3): Princeton Segmentation Benchmark.

segmentation.py PSEG/off --people PSEG/seg/Benchmark --remainders 2 --json parts.json

Takes meshes whose name is an odd number; those with even numbers are kept apart. The measures are those of Chen,
Golovinskiy and Funkhouser (A Benchmark for 3D Mesh Segmentation, 2009): means over all people and models, 0 for equal
segmentations. Methods:

  people       each person judged by all others
  one, k-means one segment; six clusters of the centers of the faces
  segment      pcl_symmetry.segment() on the mesh
  points       the same on 30 000 points; a face takes the label of the nearest one
  paper-1 to paper-4        the same by splitting as in the paper, by depth
"""
import argparse
import functools
import pathlib

import numpy as np
import pcl_symmetry
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree
from sklearn.cluster import KMeans
from sklearn.metrics import rand_score

import bench
import references

MEASURES = {"rand": "Rand", "cut": "cut", "hamming": "Hamming"}
NUM_POINTS = 30_000  # of "points": about one a face


class Surface:
    """What comparisons of segmentations need of a mesh."""

    def __init__(self, mesh):
        self.centers, self.areas = mesh.corners.mean(axis=1), mesh.areas / mesh.areas.sum()
        self.mean_radius = self.areas @ np.linalg.norm(self.centers - self.areas @ self.centers, axis=1)
        sides = np.sort(mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        self.edges, first, self.edge_of_sides = np.unique(sides, axis=0, return_index=True, return_inverse=True)
        self.face_of_sides = np.arange(len(sides)) // 3
        self.other_of_sides = self.face_of_sides[first][self.edge_of_sides]  # a face at the same edge
        self.lengths = np.linalg.norm(np.subtract(*mesh.vertices[self.edges.T]), axis=1)
        size = len(mesh.vertices)
        self.graph = csr_matrix((np.maximum(self.lengths, 1e-300), tuple(self.edges.T)), (size, size))


class Segmentation:
    """Labels of faces, from 0 without gaps, with the edges at their borders and distances from these along edges."""

    def __init__(self, surface, labels):
        self.labels = np.unique(labels, return_inverse=True)[1]
        self.num_segments = self.labels.max() + 1
        differs = self.labels[surface.face_of_sides] != self.labels[surface.other_of_sides]
        self.cuts = np.unique(surface.edge_of_sides[differs])
        self.distances = None
        if len(self.cuts):
            ends = np.unique(surface.edges[self.cuts])
            self.distances = dijkstra(surface.graph, directed=False, indices=ends, min_only=True)


def cut_distance(surface, from_, to):
    """Mean distance of the cuts of one segmentation from those of another, in mean radii of the surface."""
    lengths = surface.lengths[from_.cuts]
    distances = to.distances[surface.edges[from_.cuts]].mean(axis=1)
    known = np.isfinite(distances)  # elsewhere no way along the surface leads to a cut
    return (lengths @ np.where(known, distances, 0)) / (lengths[known].sum() * surface.mean_radius) if known.any() else np.nan


def compare(surface, reference, other):
    """Measures of the benchmark, by their names. Areas weigh in all but the Rand index."""
    shape, cell = (reference.num_segments, other.num_segments), reference.labels * other.num_segments + other.labels
    areas = np.bincount(cell, surface.areas, np.prod(shape)).reshape(shape)
    both_cut = len(reference.cuts) and len(other.cuts)
    cut = cut_distance(surface, reference, other) + cut_distance(surface, other, reference) if both_cut else np.nan
    missing, false = max(0, 1 - areas.max(1).sum()), max(0, 1 - areas.max(0).sum())
    return {"rand": 1 - rand_score(reference.labels, other.labels), "cut": cut, "hamming": (missing + false) / 2}


def mirror_agreement(surface, labels, plane):
    """Share of the area whose image in a plane lies in the partner of its segment, which receives most of it."""
    normal, d = np.asarray(plane[:3]), plane[3]
    images = surface.centers - 2 * np.outer(surface.centers @ normal + d, normal)
    nearest = cKDTree(surface.centers).query(images)[1]
    labels = np.unique(labels, return_inverse=True)[1]
    size = labels.max() + 1
    received = np.bincount(labels[nearest] * size + labels, surface.areas, size * size).reshape(size, size)
    return received.max(0).sum() / received.sum()


# Methods: (mesh, path, arguments) -> a label for each triangle


def segment(mesh, path, arguments, **options):
    return pcl_symmetry.segment(mesh.vertices, mesh.triangles, threads=1, **options)


def segment_points(mesh, path, arguments):
    points = bench.sample(mesh, NUM_POINTS, bench.generator(arguments.seed, path))
    labels = np.array(pcl_symmetry.segment(points, threads=1))
    points, labels = points[labels >= 0], labels[labels >= 0]
    return labels[cKDTree(points).query(mesh.corners.mean(axis=1))[1]]


METHODS = {"people": None, "one": lambda mesh, path, arguments: np.zeros(len(mesh.triangles), int),
           "k-means": lambda mesh, path, arguments: KMeans(6, n_init=1, random_state=arguments.seed).fit_predict(
               mesh.corners.mean(axis=1), sample_weight=mesh.areas),
           "segment": segment, "points": segment_points,
           **{f"paper-{depth}": functools.partial(segment, method="splitting", as_published=True, depth=depth)
              for depth in (1, 2, 3, 4)}}  # fmt: skip


def read_labels(path, mesh):
    """Labels of the triangles of a mesh from a .seg file, a number for each face of its file."""
    try:
        labels = np.array(pathlib.Path(path).read_text().split(), int)
    except (OSError, ValueError) as error:
        raise bench.BadInput(f"{path}: is no list of labels, {getattr(error, 'strerror', None) or error}") from None
    if len(labels) <= mesh.polygons.max():
        raise bench.BadInput(f"{path}: {len(labels)} labels, must be one for each face, more than {mesh.polygons.max()}")
    return labels[mesh.polygons]


def mean(rows):
    """Means of the values with one name; those that are not defined do not count."""
    return {name: float(np.nanmean(values)) if np.isfinite(values).any() else None
            for name, values in ((name, np.array([row[name] for row in rows], float)) for name in rows[0])}  # fmt: skip


def reference_plane(mesh, arguments):
    """Coefficients of the best plane that maps the mesh onto itself, or None."""
    found = references.find_references(mesh)["planes"] if arguments.mirrored else []
    return max(found, key=lambda plane: plane["share"])["coefficients"] if found else None


def evaluate(model, arguments):
    """{method: measures} of one mesh."""
    mesh = bench.read_mesh(model.path)
    surface = Surface(mesh)
    files = sorted(pathlib.Path(arguments.people, model.name).glob("*.seg"))
    if not files:
        raise bench.BadInput(f"{model.path}: no .seg file in {arguments.people}/{model.name}")
    people = [Segmentation(surface, read_labels(path, mesh)) for path in files]
    plane = reference_plane(mesh, arguments)
    mirrored = lambda labels: np.nan if plane is None else mirror_agreement(surface, labels, plane)
    rows = {}
    for method in arguments.methods:
        if method == "people":
            pairs = [compare(surface, a, b) for a in people for b in people if a is not b]
            own = [{"segments": p.num_segments, "mirrored": mirrored(p.labels), "milliseconds": np.nan} for p in people]
            rows[method] = {**mean(pairs), **mean(own)} if pairs else None
            continue
        labels, milliseconds = bench.timed(METHODS[method], mesh, model.path, arguments)
        found = Segmentation(surface, labels)
        own = {"segments": found.num_segments, "mirrored": mirrored(labels), "milliseconds": milliseconds}
        rows[method] = {**mean([compare(surface, person, found) for person in people]), **mean([own])}
    return {"model": model.name, "methods": rows}


def interval(values):
    """Mean and half the width of its 95 % interval over models, or None."""
    values = np.array([value for value in values if value is not None], float)
    if not len(values):
        return None, None
    return float(values.mean()), float(1.96 * values.std(ddof=1) / np.sqrt(len(values))) if len(values) > 1 else None


def summarize(results):
    """{method: {measure: [mean, half of the 95 % interval], ...}}"""
    methods = {name for result in results for name in result["methods"]}
    summary = {}
    for method in sorted(methods, key=list(METHODS).index):
        rows = {r["model"]: r["methods"][method] for r in results if r["methods"].get(method)}
        names = [*MEASURES, "segments", "mirrored", "milliseconds"]
        summary[method] = {"models": len(rows), **{name: interval([row[name] for row in rows.values()]) for name in names}}
        others = {r["model"]: r["methods"].get("segment") for r in results}
        gains = [row["rand"] - others[model]["rand"] for model, row in rows.items() if others.get(model)]
        summary[method]["minus segment"] = interval(gains)
    return summary


def report(summary):
    between = lambda pair, digits=3: "-" if pair[0] is None else f"{pair[0]:.{digits}f}" + (
        f" ({pair[0] - pair[1]:.{digits}f} to {pair[0] + pair[1]:.{digits}f})" if pair[1] is not None else "")  # fmt: skip
    plain = lambda value, digits=3: "-" if value is None else f"{value:.{digits}f}"
    header = ["", "models", "Rand", "minus segment", *list(MEASURES.values())[1:], "segments", "mirrored", "ms"]
    rows = [[name, s["models"], between(s["rand"]), between(s["minus segment"]) if name != "segment" else "",
             *(plain(s[m][0]) for m in list(MEASURES)[1:]), plain(s["segments"][0], 1), plain(s["mirrored"][0]),
             plain(s["milliseconds"][0], 0)] for name, s in summary.items()]  # fmt: skip
    bench.print_table("Distance from segmentations of people, means over models with 95 % intervals", header, rows)


def chosen_models(arguments, remainders):
    """Every N-th of the models with odd numbers whose category, modulo 3, is one of these remainders."""
    models = bench.list_models(argparse.Namespace(**{**vars(arguments), "every": 1}))
    models = [m for m in models if m.name.isdigit() and int(m.name) % 2 and (int(m.name) - 1) // 20 % 3 in remainders]
    if not models:
        raise bench.BadInput(f"{arguments.models[0]}: no mesh with an odd number of these categories")
    return models[:: arguments.every]


def main(arguments):
    results, left_out = bench.run(chosen_models(arguments, arguments.remainders), evaluate, arguments)
    summary = summarize(results)
    report(summary)
    bench.write_json(arguments, {"methods": summary, "models": results, "left_out": left_out})


if __name__ == "__main__":
    parser = bench.make_parser(__doc__, others=False)
    parser.add_argument("--people", metavar="DIR", required=True, help="folder of .seg files: 12/12_0.seg, ...")
    parser.add_argument("--methods", type=bench.numbers(str, METHODS), default="people,one,k-means,segment")
    parser.add_argument("--remainders", type=bench.numbers(int, (0, 1, 2)), default="0,1,2",
                        help="categories, numbered from 0, modulo 3; weights were fitted to 0 and 1")  # fmt: skip
    parser.add_argument("--mirrored", action="store_true", help="also agreement with the mirror image")
    bench.main(main, parser.parse_args())
