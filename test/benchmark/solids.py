"""Shapes made by code: solids whose groups of rotations are known, and bodies of random sizes."""
import dataclasses

import numpy as np
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

import bench

AROUND = 144  # sides of a body of revolution: divides by 2, 3, 4, 6 and 8; off by 2.4e-4 radii
GOLDEN = (1 + 5**0.5) / 2
CHOSEN_ON = ("bowls", "rims", "boxes", "nuts", "mugs", "keyways", "nearly round")  # the library's numbers were
SIGNS = [(a, b) for a in (-1, 1) for b in (-1, 1)]


@dataclasses.dataclass
class Solid:
    name: str
    kind: str
    group: str  # after Schoenflies, as pcl_symmetry.Rotations.name has it
    vertices: np.ndarray  # (V, 3)
    faces: np.ndarray  # (F, 3)


# Parts are pairs of vertices and faces


def surface(grid):
    """Triangles between the points of a grid, (N, M, 3)."""
    grid = np.asarray(grid, float)
    index = np.arange(grid.shape[0] * grid.shape[1]).reshape(grid.shape[:2])
    a, b, c, d = (i.ravel() for i in (index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]))
    return grid.reshape(-1, 3), np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def joined(*parts):
    first = np.cumsum([0] + [len(vertices) for vertices, _ in parts])
    faces = [faces + start for (_, faces), start in zip(parts, first)]
    return np.concatenate([vertices for vertices, _ in parts]), np.concatenate(faces)


def bent(part, move):
    return move(part[0]), part[1]


def about_z(angle):
    return Rotation.from_euler("z", angle).as_matrix()


def hull(corners):
    found = ConvexHull(np.asarray(corners, float))
    return found.points, found.simplices


def box(center, half, rotation=np.eye(3)):
    corners = np.array([[x, y, z] for x in (-1, 1) for y, z in SIGNS])
    return hull((np.asarray(center) + corners * half) @ rotation.T)


def turned(profile):
    """A profile of (radius, height) turned about z."""
    radius, height = np.transpose(profile)[:, :, None]
    angle = np.linspace(0, 2 * np.pi, AROUND + 1)
    return surface(np.stack(np.broadcast_arrays(radius * np.cos(angle), radius * np.sin(angle), height), axis=2))


def swept(outline, low, high, bore=0.0):
    """A star-shaped outline about the origin swept along z, with a round hole."""
    outer = np.concatenate([outline, outline[:1]])
    inner = bore * outer / np.linalg.norm(outer, axis=1, keepdims=True)
    curves = [(inner, low), (outer, low), (outer, high), (inner, high)] + [(inner, low)] * (bore > 0)
    return surface([np.column_stack([curve, np.full(len(curve), z)]) for curve, z in curves])


def handle(angle=0.0):
    """An elliptic handle of a mug in the half plane x > 0, y = 0, turned about z."""
    along, around = np.linspace(-np.pi / 2, np.pi / 2, 25)[:, None], np.linspace(0, 2 * np.pi, 13)
    radius = 0.75 + 0.12 * np.cos(around)
    x, y, z = 0.95 + radius * np.cos(along), 0.12 * np.sin(around), 1.1 + radius * np.sin(along)
    return surface(np.stack(np.broadcast_arrays(x, y, z), axis=2) @ about_z(angle).T)


def polygon(sides, radius=1.0):
    """A regular polygon with points along its edges, so that a bore in it is round."""
    corners = radius * np.exp(2j * np.pi * np.arange(sides + 1) / sides)
    edges = corners[:-1, None] + np.diff(corners)[:, None] * np.arange(96 // sides) / (96 // sides)
    return np.column_stack([edges.ravel().real, edges.ravel().imag])


def gear(teeth, root):
    angle = 2 * np.pi / teeth * (np.arange(teeth)[:, None] + np.array([0, 0.15, 0.35, 0.5])).ravel()
    outline = np.tile([root, 1, 1, root], teeth)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    return swept(outline, -0.2, 0.2, 0.3)


def slotted_circle(half_width=0.1, depth=0.1):
    gap = np.arcsin(half_width)
    angle = np.linspace(gap, 2 * np.pi - gap, 97)
    slot = [[1 - depth, -half_width], [1 - depth, half_width]]
    return np.concatenate([np.column_stack([np.cos(angle), np.sin(angle)]), slot])


def bowl(outer, inner):
    angle = np.linspace(0, np.pi / 2, 25)[:, None]
    wall = np.hstack([np.sin(angle), -np.cos(angle)])
    return turned(np.concatenate([outer * wall, inner * wall[::-1]]))


def ball(move=lambda x: x):
    angle = np.linspace(0, np.pi, 49)
    return bent(turned(np.column_stack([np.sin(angle), -np.cos(angle)])), move)


def wobbly(amplitude):
    def move(x):
        angle = np.arctan2(x[:, 1], x[:, 0])
        wave = np.sin(2 * angle) + 0.7 * np.cos(3 * angle + 1) + 0.5 * np.sin(5 * angle + x[:, 2])
        return x * np.column_stack([1 + amplitude * wave, 1 + amplitude * wave, np.ones(len(x))])

    return move


def rim(spokes):
    z = 0.15 if spokes % 2 else 0.0  # on one side: no half turn across
    return joined(
        turned([(0.8, -0.2), (1, -0.2), (1, 0.2), (0.8, 0.2), (0.8, -0.2)]),
        turned([(0, z - 0.1), (0.2, z - 0.1), (0.2, z + 0.1), (0, z + 0.1)]),
        *(box((0.5, 0, z), (0.32, 0.09, 0.04), about_z(2 * np.pi * k / spokes)) for k in range(spokes)),
    )


def tray(x, y):
    walls = [box((side * (x - 0.05), 0, 0.3), (0.05, y, 0.25)) for side in (-1, 1)]
    walls += [box((0, side * (y - 0.05), 0.3), (x - 0.1, 0.05, 0.25)) for side in (-1, 1)]
    return joined(box((0, 0, 0), (x, y, 0.05)), *walls)


def cyclic(y, z):
    return [np.roll([0, y, z], k) for k in range(3)]


def solids():
    cup = turned([(0, 0), (1, 0), (1, 2.2), (0.9, 2.2), (0.9, 0.12), (0, 0.12)])
    wheel = [(0.2, -0.3), (1, -0.3), (0.85, 0), (1, 0.3), (0.5, 0.3), (0.5, 0.8), (0.2, 0.8), (0.2, -0.3)]
    can = turned([(0, -1), (1, -1), (1, 0.6), (0.7, 0.8), (0.7, 1.1), (0, 1.1)])
    side = turned([(0, -1.2), (1, -1.2), (1, -0.6), (1, 0), (1, 0.6), (1, 1.2), (0, 1.2)])
    beaker = [(0, 0), (0.8, 0), (0.8, 2), (0.73, 2), (0.73, 0.08), (0, 0.08)]
    goblet = [(0, 0), (0.6, 0), (0.08, 0.1), (0.08, 0.9), (0.6, 1.2), (0.7, 2), (0.64, 2), (0.55, 1.25), (0, 0.98)]
    hub = turned([(0.3, 0.7), (0.5, 0.7), (0.5, 0.2)])
    key = [(1.3, 0, 0), (0.85, 0.12, 0.05)], [(1.4, 0.3, 0), (0.12, 0.2, 0.05)], [(1.95, 0.4, 0), (0.15, 0.3, 0.05)]
    pitch = Rotation.from_euler("x", 0.6).as_matrix()
    blades = [box((0.6, 0, 0), (0.45, 0.2, 0.03), about_z(2 * np.pi * k / 3) @ pitch) for k in range(3)]
    made = {
        "bowls": [
            ("bowl", "Cinf", bowl(1.0, 0.92)),
            ("dish", "Cinf", turned([(0, 0), (0.6, 0), (1, 0.25), (1, 0.31), (0.58, 0.07), (0, 0.07)])),
            ("bowl on a foot", "Cinf", joined(bowl(1.0, 0.9), turned([(0, -1.2), (0.5, -1.2), (0.45, -0.89)]))),
        ],
        "rims": [(f"rim of {n} spokes", f"{'DC'[n % 2]}{n}", rim(n)) for n in range(3, 9)],
        "boxes": [
            ("brick", "D2", box((0, 0, 0), (1, 0.6, 0.35))),
            ("tile", "D4", box((0, 0, 0), (1, 1, 0.12))),
            ("cube", "O", box((0, 0, 0), (1, 1, 1))),
            ("tray", "C2", tray(1.0, 0.6)),
            ("square tray", "C4", tray(1.0, 1.0)),
        ],
        "nuts": [
            ("hexagonal nut", "D6", swept(polygon(6), -0.4, 0.4, 0.5)),
            ("square nut", "D4", swept(polygon(4), -0.3, 0.3, 0.35)),
            ("bolt", "C6", joined(swept(polygon(6), -0.35, 0.35), turned([(0.5, 0.35), (0.5, 2), (0, 2)]))),
        ],
        "mugs": [
            ("mug", "C1", joined(cup, handle())),
            ("cup of two handles", "C2", joined(cup, handle(), handle(np.pi))),
        ],
        "keyways": [  # round up to a feature of less than a tenth of the surface
            ("shaft with a keyway", "Dinf", swept(slotted_circle(), -2, 2)),
            ("wheel with a set screw", "Cinf", joined(turned(wheel), box((0.5, 0, 0.55), (0.06, 0.08, 0.08)))),
            ("can with a notch", "Cinf", joined(can, box((1, 0, 0.2), (0.05, 0.12, 0.2)))),
        ],
        "nearly round": [  # up to less than the tolerance
            ("beaten bowl", "Cinf", bent(bowl(1.0, 0.9), wobbly(0.005))),
            ("beaten can", "Dinf", bent(side, wobbly(0.006))),
        ],
        "cups": [
            ("beaker", "Cinf", turned(beaker)),
            ("conical cup", "Cinf", turned([(0, 0), (0.5, 0), (0.9, 1.5)])),
            ("goblet", "Cinf", turned(goblet)),
        ],
        "gears": [(f"gear of {n} teeth", f"D{n}", gear(n, 0.8 if n < 20 else 0.86)) for n in (8, 12, 24)]
        + [(f"gear of {n} teeth on a hub", f"C{n}", joined(gear(n, 0.82), hub)) for n in (10, 16)],
        "prisms": [(f"prism of {n} sides", f"D{n}", swept(polygon(n), -0.9, 0.9)) for n in (3, 5, 6, 8)]
        + [("pyramid", "C4", hull([(a, b, -0.5) for a, b in SIGNS] + [(0, 0, 1)]))],
        "polyhedra": [
            ("tetrahedron", "T", hull([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)])),
            ("octahedron", "O", hull(np.vstack([np.eye(3), -np.eye(3)]))),
            ("icosahedron", "I", hull([x for a, b in SIGNS for x in cyclic(a, b * GOLDEN)])),
            ("dodecahedron", "I", hull([x for a, b in SIGNS for x in [(a, b, 1), (a, b, -1), *cyclic(a / GOLDEN, b * GOLDEN)]])),
        ],
        "balls": [
            ("ball", "SO3", ball()),
            ("ball with a valve", "SO3", joined(ball(), turned([(0.08, 0.95), (0.08, 1.05), (0, 1.05)]))),
        ],
        "ellipsoids": [
            ("long ellipsoid", "Dinf", ball(lambda x: x * (0.7, 0.7, 1.2))),
            ("flat ellipsoid", "Dinf", ball(lambda x: x * (1, 1, 0.6))),
            ("ellipsoid of three axes", "D2", ball(lambda x: x * (1.2, 0.85, 0.6))),
            ("egg", "Cinf", ball(lambda x: x * np.outer(1 - 0.25 * x[:, 2], (1, 1, 0)) + np.outer(1.3 * x[:, 2], (0, 0, 1)))),
        ],
        "blades": [
            ("key", "C1", joined(swept(polygon(24, 0.5), -0.05, 0.05, 0.2), *(box(*part) for part in key))),
            ("propeller", "C3", joined(turned([(0, -0.1), (0.16, -0.1), (0.16, 0.5), (0, 0.5)]), *blades)),
        ],
    }  # fmt: skip
    return [Solid(name, k, group, *part) for k, some in made.items() for name, group, part in some]


# Bodies of random sizes: a closed curve, complex numbers up to modulus 1, swept along a profile of (radius, height)

TUNING_BODIES = ("bottle", "vase", "cup", "pin")  # round ones that numbers were chosen on
FOLDED = {"prism": [(0, 0), (1, 0), (1, 1), (0, 1)], "tube": [(1, 0), (1, 1)], "cone": [(0, 0), (1, 0), (0, 1)],
          "rim": [(1, 0), (1, 1), (0.75, 1), (0.75, 0), (1, 0)], "open cone": [(1, 0), (0, 1)]}  # fmt: skip


def tube(rings):
    """Vertices and quads between closed rings, (N, K, 3)."""
    i, k = np.meshgrid(np.arange(len(rings) - 1), np.arange(rings.shape[1]), indexing="ij")
    corner = lambda di, dk: (i + di) * rings.shape[1] + (k + dk) % rings.shape[1]
    quads = np.stack([corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)], -1).reshape(-1, 4)
    return rings.reshape(-1, 3), quads


def sweep(curve, profile):
    """Mesh of a closed curve swept along a profile."""
    radius, height = np.transpose(profile)[..., None]
    vertices, quads = tube(np.stack(np.broadcast_arrays(radius * curve.real, radius * curve.imag, height), -1))
    return bench.make_mesh(vertices, quads.tolist())


def folded_curve(folds, random):
    """A polygon, or a flower with waves."""
    if random.uniform() < 0.4:
        aspect = random.uniform(0.5, 0.8)
        corners = np.array([1 + aspect * 1j, -1 + aspect * 1j, -1 - aspect * 1j, 1 - aspect * 1j]) / abs(1 + aspect * 1j)
        return corners if folds == 2 else np.exp(2j * np.pi * np.arange(folds) / folds)
    depth, steps = random.uniform(0.1, 0.35), max(8, 192 // folds)
    turn = np.arange(folds * steps) / steps
    return (1 - 0.5 * depth * (1 - np.cos(2 * np.pi * turn))) * np.exp(2j * np.pi * turn / folds)


def folded_body(body, curve, folds, random):
    """A body of FOLDED, without those whose sizes make more symmetries than the folds have: cubes and tetrahedra."""
    while True:
        height = random.uniform(0.5, 2.5)
        special = [2 * abs(curve[0].real), 2 * abs(curve[0].imag), 2**0.5] if folds in (2, 4) else [2**0.5]
        if "cone" in body and folds != 3 or "cone" not in body and folds not in (2, 4):
            special = []
        if all(abs(height / length - 1) > 0.15 for length in special if length):
            return sweep(curve, [(r, height * z) for r, z in FOLDED[body]])


def round_body(body, random):
    h, r, s = random.uniform(1.6, 3.2), random.uniform(0.25, 0.45), random.uniform(0.5, 0.8)
    profile = {
        "bottle": [(0, 0), (1, 0), (1, s * h), (r, 0.85 * h), (r, h), (0, h)],
        "vase": [(0, 0), (s, 0), (1, 0.3 * h), (0.9, 0.5 * h), (r, 0.8 * h), (s, h), (s - 0.06, h), (r - 0.06, 0.8 * h),
                 (0.84, 0.5 * h), (0.94, 0.3 * h), (s, 0.06), (0, 0.06)],
        "cup": [(0, 0), (s, 0), (1, 0.6 * h), (0.94, 0.6 * h), (s - 0.05, 0.08), (0, 0.08)],
        "pin": [(0, 0), (s, 0), (1, 0.35 * h), (s, 0.6 * h), (r, 0.75 * h), (r + 0.12, 0.88 * h), (r, 0.97 * h), (0, h)],
        "jar": [(0, 0), (0.9, 0), (1, 0.1 * h), (1, 0.6 * h), (s, 0.75 * h), (s, 0.8 * h), (0, 0.8 * h)],
        "goblet": [(0, 0), (s, 0), (0.1, 0.1 * h), (0.1, 0.4 * h), (0.8, 0.6 * h), (1, 0.9 * h), (0.95, 0.9 * h),
                   (0.75, 0.62 * h), (0, 0.45 * h)],
        "bowl": [(0, 0), (r, 0), (0.8, 0.15 * h), (1, 0.35 * h), (0.95, 0.35 * h), (0.75, 0.17 * h), (r, 0.04), (0, 0.04)],
        "can": [(0, 0), (1, 0), (1, s * h), (0.9, s * h + 0.1), (0, s * h + 0.1)],
        "ball": [(np.sin(t), -np.cos(t)) for t in np.linspace(0, np.pi, 49)],
    }[body]  # fmt: skip
    return sweep(np.exp(2j * np.pi * np.arange(192) / 192), profile)
