"""Solids made by code whose groups of rotations are known: what rotations.py counts by."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

AROUND = 144  # sides of a body of revolution: divides by 2, 3, 4, 6 and 8; off by 2.4e-4 radii


@dataclass
class Solid:
    name: str
    kind: str
    group: str  # after Schoenflies, as pcl_symmetry.Rotations.name has it
    vertices: np.ndarray  # (V, 3)
    faces: np.ndarray  # (F, 3)

    @property
    def diameter(self):
        """Greatest distance between two vertices."""
        corners = self.vertices[ConvexHull(self.vertices).vertices]
        return np.linalg.norm(corners[:, None] - corners[None], axis=2).max()


def mesh(quads):
    """Triangles of (N, 4, 3) corners; those of no area are left out."""
    quads = np.asarray(quads, float)
    triangles = np.concatenate([quads[:, (0, 1, 2)], quads[:, (0, 2, 3)]])
    areas = np.linalg.norm(
        np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1
    )
    triangles = triangles[areas > 1e-12]
    return triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3)


def joined(*parts):
    """One mesh of several."""
    first = np.cumsum([0] + [len(vertices) for vertices, _ in parts])
    return np.concatenate([vertices for vertices, _ in parts]), np.concatenate(
        [faces + start for (_, faces), start in zip(parts, first)]
    )


def about_z(angle):
    return Rotation.from_euler("z", angle).as_matrix()


def box(center, half, rotation=np.eye(3)):
    corners = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)])
    corners = (np.asarray(center) + corners * half) @ rotation.T
    return mesh(corners[[[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]])


def surface(grid):
    """A (N, M, 3) grid of points as quads."""
    grid = np.asarray(grid)
    return mesh(np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=2).reshape(-1, 4, 3))


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


def hull(corners):
    found = ConvexHull(np.asarray(corners, float))
    return found.points, found.simplices


def handle(foot, reach, rise, thickness, angle=0.0):
    """An elliptic handle in the half plane x > 0, y = 0, turned about z."""
    along = np.linspace(-np.pi / 2, np.pi / 2, 25)[:, None]
    around = np.linspace(0, 2 * np.pi, 13)
    radius = thickness * np.cos(around)
    points = np.stack(
        np.broadcast_arrays(
            foot[0] + (reach + radius) * np.cos(along),
            thickness * np.sin(around),
            foot[2] + (rise + radius) * np.sin(along),
        ),
        axis=2,
    )
    return surface(points @ about_z(angle).T)


def bent(part, move):
    return move(part[0]), part[1]


def polygon(sides, radius=1.0):
    """A regular polygon with points along its edges, so that a bore in it is round."""
    corners = radius * np.exp(2j * np.pi * np.arange(sides + 1) / sides)
    steps = np.arange(96 // sides) / (96 // sides)
    edges = corners[:-1, None] + (corners[1:] - corners[:-1])[:, None] * steps
    return np.column_stack([edges.ravel().real, edges.ravel().imag])


def gear_outline(teeth, root):
    angle = 2 * np.pi / teeth * (np.arange(teeth)[:, None] + np.array([0, 0.15, 0.35, 0.5])).ravel()
    radius = np.tile([root, 1, 1, root], teeth)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


def slotted_circle(half_width, depth):
    gap = np.arcsin(half_width)
    angle = np.linspace(gap, 2 * np.pi - gap, 97)
    slot = [[1 - depth, -half_width], [1 - depth, half_width]]
    return np.concatenate([np.column_stack([np.cos(angle), np.sin(angle)]), slot])


def bowl(outer, inner):
    angle = np.linspace(0, np.pi / 2, 25)[:, None]
    wall = np.hstack([np.sin(angle), -np.cos(angle)])
    return turned(np.concatenate([outer * wall, inner * wall[::-1]]))


def ball():
    angle = np.linspace(0, np.pi, 49)
    return turned(np.column_stack([np.sin(angle), -np.cos(angle)]))


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


def polyhedron_corners(kind):
    golden = (1 + 5**0.5) / 2
    signs = [(a, b) for a in (-1, 1) for b in (-1, 1)]
    cyclic = lambda y, z: [np.roll([0, y, z], k) for k in range(3)]  # noqa: E731
    cube = [(a, b, c) for a in (-1, 1) for b, c in signs]
    return {
        "tetrahedron": [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)],
        "octahedron": [sign * row for sign in (-1, 1) for row in np.eye(3)],
        "icosahedron": [corner for a, b in signs for corner in cyclic(a, b * golden)],
        "dodecahedron": cube + [corner for a, b in signs for corner in cyclic(a / golden, b * golden)],
    }[kind]


def solids(kind=None):
    """All solids, or those of one kind."""
    made = []

    def add(kind_of_solid, name, group, part):
        if kind in (None, kind_of_solid):
            made.append(Solid(name, kind_of_solid, group, *part))

    add("bowls", "bowl", "Cinf", bowl(1.0, 0.92))
    add("bowls", "dish", "Cinf", turned([(0, 0), (0.6, 0), (1, 0.25), (1, 0.31), (0.58, 0.07), (0, 0.07)]))
    foot = turned([(0, -1.2), (0.5, -1.2), (0.45, -0.89)])
    add("bowls", "bowl on a foot", "Cinf", joined(bowl(1.0, 0.9), foot))
    for n in range(3, 9):
        add("rims", f"rim of {n} spokes", f"{'CD'[n % 2 == 0]}{n}", rim(n))
    add("boxes", "brick", "D2", box((0, 0, 0), (1, 0.6, 0.35)))
    add("boxes", "tile", "D4", box((0, 0, 0), (1, 1, 0.12)))
    add("boxes", "cube", "O", box((0, 0, 0), (1, 1, 1)))
    add("boxes", "tray", "C2", tray(1.0, 0.6))
    add("boxes", "square tray", "C4", tray(1.0, 1.0))
    add("nuts", "hexagonal nut", "D6", swept(polygon(6), -0.4, 0.4, 0.5))
    add("nuts", "square nut", "D4", swept(polygon(4), -0.3, 0.3, 0.35))
    shank = turned([(0.5, 0.35), (0.5, 2), (0, 2)])
    add("nuts", "bolt", "C6", joined(swept(polygon(6), -0.35, 0.35), shank))
    cup = turned([(0, 0), (1, 0), (1, 2.2), (0.9, 2.2), (0.9, 0.12), (0, 0.12)])
    handles = [handle((0.95, 0, 1.1), 0.75, 0.75, 0.12, angle) for angle in (0, np.pi)]
    add("mugs", "mug", "C1", joined(cup, handles[0]))
    add("mugs", "cup of two handles", "C2", joined(cup, *handles))
    # Up to features of less than a tenth of the surface, and of a tolerance, these are round.
    add("keyways", "shaft with a keyway", "Dinf", swept(slotted_circle(0.1, 0.1), -2, 2))
    wheel = [(0.2, -0.3), (1, -0.3), (0.85, 0), (1, 0.3), (0.5, 0.3), (0.5, 0.8), (0.2, 0.8), (0.2, -0.3)]
    screw = box((0.5, 0, 0.55), (0.06, 0.08, 0.08))
    add("keyways", "wheel with a set screw", "Cinf", joined(turned(wheel), screw))
    can = turned([(0, -1), (1, -1), (1, 0.6), (0.7, 0.8), (0.7, 1.1), (0, 1.1)])
    add("keyways", "can with a notch", "Cinf", joined(can, box((1, 0, 0.2), (0.05, 0.12, 0.2))))
    add("nearly round", "beaten bowl", "Cinf", bent(bowl(1.0, 0.9), wobbly(0.005)))
    side = turned([(0, -1.2), (1, -1.2), (1, -0.6), (1, 0), (1, 0.6), (1, 1.2), (0, 1.2)])
    add("nearly round", "beaten can", "Dinf", bent(side, wobbly(0.006)))

    beaker = [(0, 0), (0.8, 0), (0.8, 2), (0.73, 2), (0.73, 0.08), (0, 0.08)]
    add("cups", "beaker", "Cinf", turned(beaker))
    add("cups", "conical cup", "Cinf", turned([(0, 0), (0.5, 0), (0.9, 1.5)]))
    goblet = [(0, 0), (0.6, 0), (0.08, 0.1), (0.08, 0.9), (0.6, 1.2), (0.7, 2), (0.64, 2), (0.55, 1.25), (0, 0.98)]
    add("cups", "goblet", "Cinf", turned(goblet))
    for n in (8, 12, 24):
        outline = gear_outline(n, 0.8 if n < 20 else 0.86)
        add("gears", f"gear of {n} teeth", f"D{n}", swept(outline, -0.2, 0.2, 0.3))
    hub = turned([(0.3, 0.7), (0.5, 0.7), (0.5, 0.2)])
    for n in (10, 16):
        gear = swept(gear_outline(n, 0.82), -0.2, 0.2, 0.3)
        add("gears", f"gear of {n} teeth on a hub", f"C{n}", joined(gear, hub))
    for n in (3, 5, 6, 8):
        add("prisms", f"prism of {n} sides", f"D{n}", swept(polygon(n), -0.9, 0.9))
    pyramid = [(1, 1, -0.5), (1, -1, -0.5), (-1, 1, -0.5), (-1, -1, -0.5), (0, 0, 1)]
    add("prisms", "pyramid", "C4", hull(pyramid))
    for name, group in (("tetrahedron", "T"), ("octahedron", "O"), ("icosahedron", "I"), ("dodecahedron", "I")):
        add("polyhedra", name, group, hull(polyhedron_corners(name)))
    add("balls", "ball", "SO3", ball())
    add("balls", "ball with a valve", "SO3", joined(ball(), turned([(0.08, 0.95), (0.08, 1.05), (0, 1.05)])))
    add("ellipsoids", "long ellipsoid", "Dinf", bent(ball(), lambda x: x * (0.7, 0.7, 1.2)))
    add("ellipsoids", "flat ellipsoid", "Dinf", bent(ball(), lambda x: x * (1, 1, 0.6)))
    add("ellipsoids", "ellipsoid of three axes", "D2", bent(ball(), lambda x: x * (1.2, 0.85, 0.6)))
    egg = bent(ball(), lambda x: x * np.column_stack([1 - 0.25 * x[:, 2], 1 - 0.25 * x[:, 2], np.full(len(x), 1.3)]))
    add("ellipsoids", "egg", "Cinf", egg)
    bow = swept(polygon(24, 0.5), -0.05, 0.05, 0.2)
    bits = [box((1.4, 0.3, 0), (0.12, 0.2, 0.05)), box((1.95, 0.4, 0), (0.15, 0.3, 0.05))]
    add("blades", "key", "C1", joined(bow, box((1.3, 0, 0), (0.85, 0.12, 0.05)), *bits))
    pitch = Rotation.from_euler("x", 0.6).as_matrix()
    blades = [box((0.6, 0, 0), (0.45, 0.2, 0.03), about_z(2 * np.pi * k / 3) @ pitch) for k in range(3)]
    add("blades", "propeller", "C3", joined(turned([(0, -0.1), (0.16, -0.1), (0.16, 0.5), (0, 0.5)]), *blades))
    return made
