"""What the programs of this folder share: models, clouds, virtual scanners, rates, tables, and runs over many items."""
import argparse
import concurrent.futures
import contextlib
import dataclasses
import functools
import hashlib
import json
import math
import multiprocessing
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")  # items are spread over processes, each works on its own with one thread

import numpy as np
from scipy.spatial import ConvexHull, QhullError
from scipy.spatial.transform import Rotation

MESH_FORMATS = (".off", ".ply", ".obj", ".stl")
NUM_FOLDS = 3


class BadInput(Exception):
    """Input that cannot be used; the message is one sentence for the user."""


class BadProgram(BadInput):
    """A program that all items need and that cannot be run."""


@dataclasses.dataclass
class Mesh:
    vertices: np.ndarray  # (V, 3) float64, input units
    triangles: np.ndarray  # (T, 3) int32
    polygons: np.ndarray = None  # (T,) polygon of the file that each triangle is part of

    @functools.cached_property
    def corners(self):
        """(T, 3, 3) corners of the triangles."""
        return self.vertices[self.triangles]

    @functools.cached_property
    def areas(self):
        a, b, c = self.corners.swapaxes(0, 1)
        return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)

    @functools.cached_property
    def center(self):
        """(3,) middle of the bounding box of the triangles."""
        return 0.5 * (self.corners.min((0, 1)) + self.corners.max((0, 1)))

    @functools.cached_property
    def diagonal(self):
        return float(np.linalg.norm(np.ptp(self.corners.reshape(-1, 3), axis=0)))

    @functools.cached_property
    def diameter(self):
        """Greatest distance between two points."""
        return diameter(self.corners.reshape(-1, 3))

    @functools.cached_property
    def scene(self):
        """Open3D's ray casting scene of the mesh, centered and divided by its diagonal."""
        import open3d

        unit = ((self.vertices - self.center) / self.diagonal).astype(np.float32)
        scene = open3d.t.geometry.RaycastingScene()
        scene.add_triangles(open3d.core.Tensor(unit), open3d.core.Tensor(self.triangles.astype(np.uint32)))
        return scene

    def distances(self, points):
        """(N,) distances of points in the frame of `scene` from the mesh, in diagonals."""
        return self.scene.compute_distance(_tensor(points), nthreads=1).numpy()

    def closest(self, points):
        """Closest points of the mesh, and the unit normals of their triangles, in the frame of `scene`."""
        found = self.scene.compute_closest_points(_tensor(points), nthreads=1)
        a, b, c = self.corners.swapaxes(0, 1)
        normals = np.cross(b - a, c - a) / (2 * self.areas[:, None])
        return found["points"].numpy(), normals[found["primitive_ids"].numpy()]


def _tensor(rows):
    import open3d

    return open3d.core.Tensor(np.ascontiguousarray(rows, dtype=np.float32))


def diameter(points):
    """Greatest distance between two of (N, 3) points."""
    points = np.unique(points, axis=0)
    try:
        points = points[ConvexHull(points).vertices]
    except (QhullError, ValueError):  # flat or too few
        pass
    if len(points) > 3000:  # round shapes: the ends of 3000 directions hold the diameter to 1 in 1000
        directions = random_directions(np.random.default_rng(0), 3000)
        points = points[np.unique(np.argmax(points @ directions.T, axis=0))]
    return max(float(np.sqrt(((points - p) ** 2).sum(1).max())) for p in points)


def make_mesh(vertices, polygons):
    """Cuts polygons into fans and leaves out triangles without area. Raises BadInput where none is left."""
    fans = [(p[0], p[k - 1], p[k], i) for i, p in enumerate(polygons) for k in range(2, len(p))]
    fans = np.array(fans, np.int32).reshape(-1, 4)
    vertices = np.asarray(vertices, float).reshape(-1, 3)
    if len(fans) and not (0 <= fans[:, :3].min() and fans[:, :3].max() < len(vertices)):
        raise BadInput("a face has a vertex that is not there")
    mesh = Mesh(vertices, fans[:, :3], fans[:, 3])
    keep = np.isfinite(mesh.areas) & (mesh.areas > 0)
    if not keep.any():
        raise BadInput("has no face with an area")
    return Mesh(vertices, fans[keep, :3], fans[keep, 3])


def read_mesh(path):
    """Reads an OFF, PLY, OBJ or STL file. Raises BadInput that names the file."""
    import pcl_symmetry

    try:
        shape = pcl_symmetry.read(path)
        return make_mesh(shape.points, shape.faces)
    except (OSError, ValueError, BadInput) as error:
        reason = (getattr(error, "strerror", None) or str(error)).removeprefix(f"{path}: ")
        raise BadInput(f"{path}: is no mesh that can be read, {reason}") from None


@dataclasses.dataclass
class LeafClass:
    name: str  # behind its parents, "aircraft/airplane/biplane"
    number: int  # among the classes that have models, in the order of the file


def read_classes(path):
    """Class file of the Princeton Shape Benchmark: {model name: LeafClass}."""
    try:
        words = iter(open(path).read().split())
        if (next(words), next(words)) != ("PSB", "1"):
            raise BadInput(f"{path}: must begin with PSB 1")
        num_classes, num_models = int(next(words)), int(next(words))
        full_names, classes, number = {}, {}, 0
        for _ in range(num_classes):
            name, parent, size = next(words), next(words), int(next(words))
            full_names[name] = f"{full_names[parent]}/{name}" if parent in full_names else name
            for _ in range(size):
                classes[f"m{int(next(words))}"] = LeafClass(full_names[name], number)
            number += size > 0
    except (StopIteration, ValueError, OSError) as error:
        reason = getattr(error, "strerror", None) or "a number or name is missing"
        raise BadInput(f"{path}: is no class file, {reason}") from None
    if len(classes) != num_models:
        raise BadInput(f"{path}: names {len(classes)} models, must be {num_models}")
    return classes


@dataclasses.dataclass
class Model:
    name: str  # unique among the models of a run
    path: str
    key: str  # "folder/file.off", the same wherever the folder lies


def list_models(arguments):
    """Meshes of the folders of the command line, by name, as --classes, --fold, --every and --first select."""
    classes = read_classes(arguments.classes) if arguments.classes else None
    if arguments.fold is not None and classes is None:
        raise BadInput("--fold needs --classes")
    models = []
    for folder in map(pathlib.Path, arguments.models):
        if not folder.is_dir():
            raise BadInput(f"{folder}: must be a folder")
        paths = sorted(p for p in folder.iterdir() if p.suffix.lower() in MESH_FORMATS)
        if classes is not None:
            folds = range(NUM_FOLDS) if arguments.fold is None else [arguments.fold]
            paths = [p for p in paths if p.stem in classes and classes[p.stem].number % NUM_FOLDS in folds]
        paths = paths[arguments.first :: arguments.every]
        models += [Model(p.stem, str(p), f"{folder.resolve().name}/{p.name}") for p in paths]
    if not models:
        raise BadInput(f"{' '.join(arguments.models) or 'the command line'}: no mesh ({', '.join(MESH_FORMATS)}) is selected")
    names = [model.name for model in models]
    for model in models:
        if names.count(model.name) > 1:
            model.name = model.key.replace("/", "_").replace(".", "_")
    return models


@functools.lru_cache(maxsize=2)
def read_json(path):
    return json.loads(pathlib.Path(path).read_text())


@functools.lru_cache(maxsize=64)
def mesh_of_size(path, diagonal):
    """The mesh centered at the origin, with a bounding box of this diagonal."""
    mesh = read_mesh(path)
    return Mesh((mesh.vertices - mesh.center) * (diagonal / mesh.diagonal), mesh.triangles, mesh.polygons)


@functools.lru_cache(maxsize=1)
def opened_database(path):
    import pcl_symmetry

    return pcl_symmetry.Database(path, threads=1)


def generator(seed, *names):
    """Random numbers that depend on the seed and on names alone, whatever else is drawn."""
    digest = hashlib.sha256(repr((seed, *map(str, names))).encode()).digest()
    return np.random.default_rng(np.frombuffer(digest, np.uint32))


def random_directions(random, count):
    """(count, 3) unit vectors, uniform on the sphere."""
    v = random.normal(size=(count, 3))
    return v / np.linalg.norm(v, axis=1, keepdims=True)


def random_rotation(random):
    """(3, 3) uniform among all rotations."""
    w, x, y, z = random.normal(size=4)
    return Rotation.from_quat([x, y, z, w]).as_matrix()


def rigid(rotation, translation=(0, 0, 0)):
    """(4, 4) that rotates, then translates."""
    motion = np.eye(4)
    motion[:3, :3], motion[:3, 3] = rotation, translation
    return motion


def random_pose(random, mesh):
    """T_cloud_model, (4, 4): rotates about the center of the mesh, and moves it by up to a diagonal along each axis."""
    rotation = random_rotation(random)
    return rigid(rotation, mesh.diagonal * random.uniform(-1, 1, 3) - rotation @ mesh.center)


def rotation_about(point, direction, angle):
    """(4, 4) by an angle in radians about a line of unit direction."""
    rotation = Rotation.from_rotvec(angle * np.asarray(direction, float)).as_matrix()
    return rigid(rotation, point - rotation @ point)


def moved(pose, points):
    return points @ pose[:3, :3].T + pose[:3, 3]


def sample(mesh, count, random, even=True):
    """(count, 3) points of the surface, by area; even: one in each of `count` equal shares of the area."""
    shares = np.arange(count) if even else count * np.sort(random.uniform(size=count))
    up_to = np.cumsum(mesh.areas)
    at = (shares + (random.uniform(size=count) if even else 0)) * up_to[-1] / count
    index = np.minimum(np.searchsorted(up_to, at, side="right"), len(up_to) - 1)
    root, along = np.sqrt(random.uniform(size=(count, 1))), random.uniform(size=(count, 1))
    a, b, c = mesh.corners[index].swapaxes(0, 1)
    return (1 - root) * a + root * (1 - along) * b + root * along * c


def depth_picture(corners, size, half_width):
    """(size, size) depth z of the nearest of (T, 3, 3) triangles at each pixel, infinite where there is none.

    Frame of the sensor: x right, y down, z forward; the picture is 2 half_width wide at depth one. Exact at the middle
    of each pixel. (Rays of Open3D miss everything where Embree has ray masks, as in Debian 12.)
    """
    z = corners[..., 2]
    corners, z = corners[(z > 0).any(1)], z[(z > 0).any(1)]
    pixels = (corners[..., :2] / np.maximum(z, 1e-9)[..., None] / half_width + 1) * size / 2 - 0.5
    pixels[(z <= 0).any(1), 0], pixels[(z <= 0).any(1), 1] = -1, size  # reaches behind the sensor: all pixels are tried
    x, y = np.meshgrid(*2 * [(2 * (np.arange(size) + 0.5) / size - 1) * half_width])
    rays = np.stack([x, y, np.ones_like(x)], -1).reshape(-1, 3)
    depths = np.full(size * size, np.inf)
    low = np.clip(np.ceil(pixels.min(1)), 0, size).astype(int)  # first and last column and row in which a triangle can be
    high = np.clip(np.floor(pixels.max(1)), -1, size - 1).astype(int)
    counts = np.prod(np.maximum(high - low + 1, 0), axis=1)
    order = np.flatnonzero(counts)
    blocks = np.cumsum(counts[order]) // 1_000_000
    for block in np.split(order, np.flatnonzero(np.diff(blocks)) + 1):
        if len(block) == 0:
            continue
        index = np.repeat(block, counts[block])
        within = np.arange(len(index)) - np.repeat(np.cumsum(counts[block]) - counts[block], counts[block])
        columns = (high - low + 1)[index, 0]
        pixel = (low[index, 1] + within // columns) * size + low[index, 0] + within % columns
        a, b, c = corners[block].swapaxes(0, 1)
        edges = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], 1)  # a ray hits where all signs agree
        volume = np.einsum("ij,ij->i", a, edges[:, 0])
        position = np.repeat(np.arange(len(block)), counts[block])
        sides = sum(edges[position, :, k] * rays[pixel, k, None] for k in range(3))
        total = sides.sum(1)
        sides *= np.sign(total)[:, None]
        hit = (sides >= -1e-12 * np.abs(total)[:, None]).all(1) & (total != 0)
        at = volume[position[hit]] / total[hit]
        np.minimum.at(depths, pixel[hit][at > 0], at[at > 0])
    return depths.reshape(size, size)


def look_along(forward):
    """(3, 3) axes of a sensor in columns, right, down and forward; up in the picture is z, or y for a vertical view."""
    forward = np.asarray(forward, float) / np.linalg.norm(forward)
    right = np.cross(forward, [0, 0, 1] if abs(forward[2]) < 0.999 else [0, 1, 0])
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(forward, right), forward], 1)


def without_patches(points, share, random, num_patches=10):
    """The points that are left where patches of neighbors are missing, as occlusion and drop-outs leave them."""
    size = int(share * len(points) / num_patches)
    for _ in range(num_patches if size else 0):
        order = np.argsort(((points - points[random.integers(len(points))]) ** 2).sum(1))
        points = points[np.sort(order[size:])]
    return points


@dataclasses.dataclass
class Scan:
    points: np.ndarray  # (H, W, 3) row by row, NaN where the ray misses, in the frame of the cloud
    T_cloud_model: np.ndarray
    T_cloud_sensor: np.ndarray  # x right, y down, z forward
    half_width: float  # of the square picture at depth one

    @property
    def rows(self):
        """(N, 3) points that were hit."""
        return self.points[np.isfinite(self.points[..., 0])]

    @property
    def viewpoint(self):
        return self.T_cloud_sensor[:3, 3]


def scan(mesh, direction, random, num_points=10_000, noise=0.0, pose=None):
    """What a depth camera two diagonals away sees from `direction` (model frame, toward the camera), about `num_points` of it.

    noise: standard deviation along the ray, in diagonals. pose: T_cloud_model. The picture has up to 1024 rows.
    """
    axes, half = look_along(-np.asarray(direction, float)), math.tan(0.2)
    origin = mesh.center - 2 * mesh.diagonal * axes[:, 2]
    corners = (mesh.corners - origin) @ axes
    sizes, size = {}, 128
    error = lambda depth: abs(np.isfinite(depth).sum() / num_points - 1)
    while size not in sizes:
        sizes[size] = depth = depth_picture(corners, size, half)
        if error(depth) < 0.01 or len(sizes) > 8:
            break
        num_hits = np.isfinite(depth).sum()
        size = round(size * math.sqrt(num_points / num_hits)) if num_hits else 4 * size
        size = min(max(size, 1), 1024)
    size, depth = min(sizes.items(), key=lambda picture: error(picture[1]))
    hit = np.isfinite(depth)
    if not hit.any():
        raise BadInput("no ray hits the model")
    x, y = np.meshgrid(*2 * [(2 * (np.arange(size) + 0.5) / size - 1) * half])
    rays = np.stack([x, y, np.ones_like(x)], -1)
    length = np.linalg.norm(rays, axis=-1)
    depth = np.where(hit, depth + noise * mesh.diagonal / length * random.normal(size=depth.shape), np.nan)
    pose = np.eye(4) if pose is None else pose
    sensor = rigid(pose[:3, :3] @ axes, moved(pose, origin))
    return Scan(moved(sensor, depth[..., None] * rays), pose, sensor, half)


CUBE_CORNERS = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]) / math.sqrt(3)


def write_cloud(path, points, T_cloud_sensor=None, **fields):
    """Binary PCD of (N, 3) or organized (H, W, 3) points, with the pose of the sensor where it is known, and fields of
    one number for each point."""
    height, width = points.shape[:2] if points.ndim == 3 else (1, len(points))
    viewpoint = [0, 0, 0, 1, 0, 0, 0]
    if T_cloud_sensor is not None:
        x, y, z, w = Rotation.from_matrix(T_cloud_sensor[:3, :3]).as_quat()
        viewpoint = [*T_cloud_sensor[:3, 3], w, x, y, z]
    names, values = ["x", "y", "z", *fields], [points, *(np.asarray(f)[..., None] for f in fields.values())]
    repeated = lambda word: " ".join(len(names) * [word])
    header = (f"VERSION 0.7\nFIELDS {' '.join(names)}\nSIZE {repeated('4')}\nTYPE {repeated('F')}\nCOUNT {repeated('1')}\n"
              f"WIDTH {width}\nHEIGHT {height}\n"
              f"VIEWPOINT {' '.join(f'{v:.9g}' for v in viewpoint)}\nPOINTS {width * height}\nDATA binary\n")  # fmt: skip
    pathlib.Path(path).write_bytes(header.encode() + np.concatenate(values, -1).astype("<f4").tobytes())


# In the shape that `pcl_symmetry_planes -json` writes.
NO_ANSWERS = {"planes": [], "axes": [], "centers": [], "best": None, "failed": True, "milliseconds": None}


def detect(points, sensor=None, seed=1, **options):
    """Answers of this library for (N, 3) or (H, W, 3) points or a file that was read; bad clouds are failures with no answer.

    sensor: T_cloud_sensor of a scan; None: the points decide where the scanner stood.
    """
    import pcl_symmetry

    viewpoint = "auto" if sensor is None or "as_published" in options else tuple(sensor[:3, 3])
    if isinstance(points, np.ndarray):
        points = np.ascontiguousarray(points, np.float32)
    try:
        found, milliseconds = timed(pcl_symmetry.planes, points, viewpoint=viewpoint, seed=seed, threads=1, **options)
    except ValueError:
        return NO_ANSWERS
    return {**NO_ANSWERS, **found.to_dict(), "failed": bool(found.reason), "milliseconds": milliseconds}


def timed(function, *arguments, clock=time.perf_counter, **options):
    """What a function returns, and the milliseconds that it took."""
    start = clock()
    result = function(*arguments, **options)
    return result, 1000 * (clock() - start)


def seconds_of_children():
    """Processor time of all programs that were run and have ended."""
    return sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])


def ask(name, points, sensor, arguments, **options):
    """Answers for one cloud, written for --export: those of --judge or of the Python module."""
    if arguments.export:
        write_cloud(f"{arguments.export}/{name}.pcd", points, sensor)
    if arguments.judge:
        return read_answers(arguments.judge, name)
    return detect(points, sensor, arguments.seed + 1, **options)


PER_MILLISECOND = {"ns": 1e6, "us": 1e3, "ms": 1.0, "s": 1e-3}


def google_benchmark(command, *flags):
    """Rows, with `cpu_ms`, that a program of Google Benchmark writes; command: its path, or words that end with it."""
    command = [command] if isinstance(command, str) else command
    try:
        run = subprocess.run([*command, *flags, "--benchmark_format=json"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
        return [{**row, "cpu_ms": row["cpu_time"] / PER_MILLISECOND[row["time_unit"]]} for row in json.loads(run.stdout)["benchmarks"]]
    except (OSError, ValueError, KeyError, TypeError, subprocess.CalledProcessError):
        raise BadInput(f"{command[-1]}: is no program of Google Benchmark that runs") from None


def run_tool(folder, name, *arguments):
    """Runs a command-line tool; what it says against its input is said of the item that it was run for."""
    try:
        subprocess.run([pathlib.Path(folder, name), *arguments], check=True, capture_output=True, text=True)
    except OSError as error:
        raise BadProgram(f"{folder}/{name}: cannot be run, {error.strerror}") from None
    except subprocess.CalledProcessError as error:
        raise BadInput(error.stderr.strip()) from None


def read_answers(folder, name):
    """Answers of another program: NAME.json as `pcl_symmetry_planes -json` writes it, or NAME.txt with rows
    `a b c d [confidence]`, best first. No file is a failure."""
    base = pathlib.Path(folder) / name
    answers = {**NO_ANSWERS, "planes": [], "failed": False}
    try:
        if base.with_name(name + ".json").exists():
            content = json.loads(base.with_name(name + ".json").read_text())
            time_ms = content.get("timing_ms", {}).get("total")
            return {**answers, **{k: content[k] for k in answers if k in content}, "milliseconds": time_ms}
        if not base.with_name(name + ".txt").exists():
            return NO_ANSWERS
        for line in base.with_name(name + ".txt").read_text().splitlines():
            row = [float(word) for word in line.split()]
            if row:
                extra = {"confidence": row[4]} if len(row) > 4 else {}
                answers["planes"].append({"coefficients": [row[0], row[1], row[2], row[3]], "kind": "symmetry", **extra})
        return answers
    except (ValueError, IndexError, AttributeError, OSError):
        raise BadInput(f"{base}: is no list of planes") from None


def wilson(count, total):
    """95 % interval of a rate (Wilson 1927), in [0, 1]; it treats the cases as independent."""
    from scipy.stats import binomtest

    return tuple(binomtest(count, total).proportion_ci(method="wilson")) if total else (0.0, 1.0)


class Rate:
    """Counts yes among cases: add(), then text or json."""

    def __init__(self, cases=()):
        self.count = self.total = 0
        for case in cases:
            self.add(case)

    def add(self, yes):
        self.count += bool(yes)
        self.total += 1

    @property
    def text(self):
        if self.total == 0:
            return "-"
        low, high = wilson(self.count, self.total)
        return f"{100 * self.count / self.total:.1f} % of {self.total} ({100 * low:.1f} to {100 * high:.1f})"

    @property
    def json(self):
        low, high = wilson(self.count, self.total)
        return {"count": self.count, "total": self.total, "rate": self.count / max(self.total, 1), "low": low, "high": high}


def calibration(confidences, right):
    """Expected calibration error in ten bins, its mean by chance if all confidences were true, and Brier score."""
    p, y = np.clip(np.asarray(confidences, float), 0, 1), np.asarray(right, float)
    if len(p) == 0:
        return {"answers": 0, "error": math.nan, "by_chance": math.nan, "brier": math.nan}
    bins = np.minimum((10 * p).astype(int), 9)
    error = lambda outcome: np.abs(np.bincount(bins, p - outcome, 10)).sum() / len(p)
    random = np.random.default_rng(1)
    by_chance = np.mean([error(random.uniform(size=len(p)) < p) for _ in range(200)])
    return {"answers": len(p), "error": error(y), "by_chance": by_chance, "brier": float(np.mean((p - y) ** 2))}


def median(values, digits=2):
    values = [v for v in values if v is not None]
    return f"{np.median(values):.{digits}f}" if values else "-"


def print_table(title, header, rows):
    """Prints a table in Markdown, aligned."""
    rows = [[str(cell) for cell in row] for row in [header, *rows]]
    widths = [max(len(row[k]) for row in rows) for k in range(len(header))]
    lines = ["| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths)) + " |" for row in rows]
    lines.insert(1, "|" + "|".join("-" * (width + 2) for width in widths) + "|")
    print(f"{title}\n\n" + "\n".join(lines) + "\n", flush=True)


def save_figure(path, draw):
    """Draws on fresh axes of matplotlib, draw(axes), and writes the picture."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(8, 5), layout="constrained")
    draw(axes)
    axes.grid(alpha=0.3)
    figure.savefig(path, dpi=150)
    pyplot.close(figure)


def plain_parser(description):
    return argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)


def make_parser(description, models=True, others=True):
    """Parser of the flags that all programs share; models: with those that choose meshes; others: with those that hand clouds
    to other programs."""
    parser = plain_parser(description)
    add = parser.add_argument

    def natural(text):
        if not text.isdigit() or int(text) < 1:
            raise argparse.ArgumentTypeError(f"{text}, must be >= 1")
        return int(text)

    if models:
        add("models", nargs="*", help="folders of .off, .ply, .obj and .stl meshes")
        add("--classes", metavar="FILE", help="class file (.cla): take only the models that it names")
        add("--fold", type=int, help="with --classes: only models whose leaf class number modulo 3 is this one")
        add("--every", type=natural, default=1, help="take every N-th mesh of each folder")
        add("--first", type=int, default=0, help="index of the first mesh that is taken")
    add("--jobs", type=natural, default=os.cpu_count(), help="number of processes, all cores by default")
    add("--json", metavar="FILE", help="write the results; an interrupted run goes on from FILE.journal")
    add("--seed", type=int, default=0, help="of all random numbers")
    if others:
        add("--export", metavar="DIR", help="write each cloud as PCD, and truth.json")
        add("--judge", metavar="DIR", help="judge what another program answered: a file NAME.json or NAME.txt a cloud")
    return parser


def numbers(kind, known=None):
    """Type of a flag of several values, "0.05,0.2", all among the known ones."""

    def values(text):
        found = [kind(part) for part in text.split(",")]
        if known and set(found) - set(known):
            raise argparse.ArgumentTypeError(f"{text}, must be of {','.join(known)}")
        return found

    return values


def main(program, arguments):
    """Runs program(arguments); input that cannot be used costs one sentence and exit code 1."""
    try:
        for flag in ("repository", "people", "judge"):
            path = getattr(arguments, flag, None)
            if path and not os.path.exists(path):
                raise BadInput(f"{path}: does not exist")
        program(arguments)
    except (BadInput, ImportError, OSError) as error:
        hint = ", set PYTHONPATH=build/src/python" if isinstance(error, ImportError) and "pcl_symmetry" in str(error) else ""
        sys.exit(f"{pathlib.Path(sys.argv[0]).name}: {error}{hint}")
    except KeyboardInterrupt:
        sys.exit("interrupted" + ", the same command goes on from its journal" * bool(getattr(arguments, "json", None)))


def write_json(arguments, content):
    """Writes the results of --json, rates as numbers, whole or not at all; then the journal is not needed any more."""
    if arguments.json:
        write_whole(arguments.json, json.dumps(content, indent=1, default=lambda rate: rate.json) + "\n")
        for path in pathlib.Path(arguments.json).parent.glob(pathlib.Path(arguments.json).name + "*.journal"):
            path.unlink()
        for folder in pathlib.Path(arguments.json).parent.glob(pathlib.Path(arguments.json).name + ".*.work"):
            shutil.rmtree(folder)


def write_truth(arguments, truths):
    """Writes truth.json of --export: {cloud name: what is true of it}."""
    if arguments.export:
        write_whole(pathlib.Path(arguments.export) / "truth.json", json.dumps(truths, indent=1) + "\n")


def write_whole(path, text):
    """Writes a file whole or not at all."""
    part = pathlib.Path(f"{path}.part")
    part.write_text(text)
    part.replace(path)


def _asked(arguments):
    """What the results of a run depend on."""
    return {k: v for k, v in vars(arguments).items() if k not in ("jobs", "json", "figure")}


def work_folder(arguments, temporary):
    """Folder for what a run makes on its way: one beside --json, from which the same run goes on after an interruption and
    which write_json() deletes; without --json the temporary one."""
    digest = hashlib.sha256(json.dumps(_asked(arguments), default=str).encode()).hexdigest()[:8]
    folder = pathlib.Path(f"{arguments.json}.{digest}.work" if arguments.json else temporary)
    folder.mkdir(parents=True, exist_ok=True)
    return str(folder)


def run(items, function, arguments, stage=""):
    """[function(item, arguments) for each item], spread over processes.

    Items have a `name`, or are their own name; results can be written as JSON. With --json, finished items are kept in
    a journal, and a run with the same arguments goes on from it. An item that fails costs one sentence and itself only.
    stage: tells several runs of one program apart. Returns (results in the order of the items, sentences of failures).
    """
    named = {getattr(item, "name", str(item)): item for item in items}
    if getattr(arguments, "export", None):
        pathlib.Path(arguments.export).mkdir(parents=True, exist_ok=True)
    with _journal(arguments, stage) as (finished, keep):
        results = {name: result for name, result in finished.items() if name in named}
        waiting = {name: item for name, item in named.items() if name not in results}
        left_out, start, first = [], time.monotonic(), len(results)
        for name, result, failure in _spread(waiting, function, arguments):
            if failure:
                left_out.append(failure)
                print(f"{chr(13) * sys.stderr.isatty()}{failure}", file=sys.stderr)
            else:
                results[name] = result
                keep(name, result)
            num_done = len(results) + len(left_out)
            if sys.stderr.isatty():
                rest = (time.monotonic() - start) * (len(named) - num_done) / max(1, num_done - first)
                print(f"\r{stage} {num_done} of {len(named)}, {rest:.0f} s left   ", end="", file=sys.stderr)
    if sys.stderr.isatty():
        print(file=sys.stderr)
    if not results:
        raise BadInput("nothing could be evaluated")
    return [results[name] for name in named if name in results], left_out


def _attempt(function, item, arguments, name):
    """(result, sentence of the failure)"""
    try:
        return function(item, arguments), None
    except (BadProgram, ImportError):  # of all items
        raise
    except BadInput as error:
        return None, str(error) if name in str(error) else f"{name}: {error}"
    except Exception as error:  # a fault of one model must not end the run
        return None, f"{name}: {type(error).__name__}, {error}"


def _spread(waiting, function, arguments):
    """Yields (name, result, failure) as items end."""
    if arguments.jobs == 1:
        for name, item in waiting.items():
            yield (name, *_attempt(function, item, arguments, name))
        return
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs, multiprocessing.get_context("spawn")) as pool:
        futures = {pool.submit(_attempt, function, item, arguments, name): name for name, item in waiting.items()}
        try:
            for future in concurrent.futures.as_completed(futures):
                yield (futures[future], *future.result())
        except concurrent.futures.process.BrokenProcessPool:
            raise BadProgram("a process died; --jobs 1 ends at the item that it died of") from None
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


@contextlib.contextmanager
def _journal(arguments, stage):
    """Yields {name: result} of the items that were finished when a run was interrupted, and a function that keeps one more.

    The journal has a line of what was asked for, and one for each item.
    """
    if not arguments.json:
        yield {}, lambda name, result: None
        return
    path, asked = pathlib.Path(f"{arguments.json}{'.' * bool(stage)}{stage}.journal"), json.dumps(_asked(arguments))
    lines = path.read_text().splitlines(keepends=True) if path.exists() else []
    finished = lines[1:] if lines[:1] == [asked + "\n"] else []
    results = dict(json.loads(line) for line in finished if line.endswith("\n"))  # the last one may be cut off
    with open(path, "w") as file:
        keep = lambda *row: print(json.dumps(row), file=file, flush=True)
        print(asked, file=file, flush=True)
        for row in results.items():
            keep(*row)
        yield results, keep
