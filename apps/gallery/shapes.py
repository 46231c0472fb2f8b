"""Writes ten shapes of our own as PLY meshes: familiar objects that no package brings.

usage: python3 apps/gallery/shapes.py FOLDER

The folder receives teapot, octopus, mug, car, airplane, chair, carton, propeller, rim and bottle. Solids are functions of
points, (N, 3), that are negative inside and grow about as fast as the distance; their surfaces come from marching cubes
(VTK). Needs python3-numpy and python3-vtk9.
"""

import sys
from pathlib import Path

import numpy as np


def ellipsoid(center, half_axes):
    def solid(x):
        scaled = (x - center) / half_axes
        length, slope = np.linalg.norm(scaled, axis=1), np.linalg.norm(scaled / half_axes, axis=1)
        return np.where(slope > 0, length * (length - 1) / np.where(slope > 0, slope, 1), -np.min(half_axes))

    return solid


def box(center, half_sizes, rounding=0.0):
    def solid(x):
        beyond = np.abs(x - center) - half_sizes + rounding
        return np.linalg.norm(np.maximum(beyond, 0), axis=1) + np.minimum(0, beyond.max(axis=1)) - rounding

    return solid


def wheel(center, radius, half_width):
    """A disc whose axis is y."""

    def solid(x):
        d = x - center
        return np.maximum(np.hypot(d[:, 0], d[:, 2]) - radius, np.abs(d[:, 1]) - half_width)

    return solid


def tube(control, start, end):
    """Along a cubic Bezier curve, (4, 3), with radii from start to end."""
    num_pieces = 24
    t = np.linspace(0, 1, num_pieces + 1)[:, None]
    a, b, c, d = np.asarray(control, float)
    curve = (1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * d

    def solid(x):
        distance = np.linalg.norm(x - curve[0], axis=1) - start
        for i in range(num_pieces):
            edge = curve[i + 1] - curve[i]
            square = edge @ edge
            along = np.clip((x - curve[i]) @ edge / square, 0, 1) if square > 0 else np.zeros(len(x))
            radius = start + (end - start) * (i + along) / num_pieces
            distance = np.minimum(distance, np.linalg.norm(x - curve[i] - along[:, None] * edge, axis=1) - radius)
        return distance

    return solid


def ring(center, radius, thickness):
    """A torus about z."""

    def solid(x):
        d = x - center
        return np.hypot(np.hypot(d[:, 0], d[:, 1]) - radius, d[:, 2]) - thickness

    return solid


def common(a, b):
    return lambda x: np.maximum(a(x), b(x))


def joined(parts, fillet):
    def solid(x):
        distance = parts[0](x)
        for part in parts[1:]:
            other = part(x)
            overlap = np.maximum(0, fillet - np.abs(distance - other)) / fillet
            distance = np.minimum(distance, other) - 0.25 * fillet * overlap**2
        return distance

    return solid


def rotated(solid, axis, angle):
    """The solid rotated by an angle about a coordinate axis (0 to 2)."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    back = np.eye(3)
    back[i, i] = back[j, j] = np.cos(angle)
    back[i, j], back[j, i] = np.sin(angle), -np.sin(angle)
    return lambda x: solid(x @ back.T)


def flattened(solid, factor):
    return lambda x: solid(x * (1, 1, factor)) / factor


def surface(solid, low, high, num_cells):
    """Marching cubes: vertices (N, 3) and triangles (M, 3). num_cells: along the longest side of the bounds."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D

    low, high = np.asarray(low, float), np.asarray(high, float)
    step = (high - low).max() / num_cells
    size = np.ceil((high - low) / step).astype(int) + 1
    # Blocks of corners without a surface in or beside them take the value of their middle.
    block = 3
    num_blocks = -(-size // block)
    first = block * np.stack(np.meshgrid(*map(np.arange, num_blocks), indexing="ij"), -1).reshape(-1, 3)
    middle = solid(low + step * (first + (block - 1) / 2))
    reach = 1.5 * step * np.sqrt(3) * ((block - 1) / 2 + 1)  # pressed solids grow faster than the distance
    corners = np.stack(np.meshgrid(*[np.arange(block)] * 3, indexing="ij"), -1).reshape(-1, 3)
    values = np.zeros(block * num_blocks, np.float32)
    index = first[:, None] + corners
    values[tuple(np.moveaxis(index, -1, 0))] = middle[:, None]
    near = index[np.abs(middle) <= reach].reshape(-1, 3)
    values[tuple(near.T)] = solid(low + step * near)
    values = values[: size[0], : size[1], : size[2]]

    image = vtkImageData()
    image.SetOrigin(*low)
    image.SetSpacing(step, step, step)
    image.SetDimensions(*map(int, size))
    scalars = numpy_to_vtk(values.ravel(order="F"), deep=True)
    image.GetPointData().SetScalars(scalars)
    edges = vtkFlyingEdges3D()
    edges.SetInputData(image)
    edges.SetValue(0, 0.0)
    edges.ComputeNormalsOff()
    edges.Update()
    found = edges.GetOutput()
    triangles = vtk_to_numpy(found.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return vtk_to_numpy(found.GetPoints().GetData()), triangles


class Patches:
    """A mesh made of curved patches."""

    def __init__(self):
        self.vertices, self.triangles = [], []

    def add(self, num_u, num_v, patch):
        """patch takes u and v in [0, 1] to a point; num_u x num_v quadrangles, each as two triangles."""
        first = len(self.vertices)
        for i in range(num_u + 1):
            self.vertices += [patch(i / num_u, j / num_v) for j in range(num_v + 1)]
        for i in range(num_u):
            for j in range(num_v):
                a = first + i * (num_v + 1) + j
                b = a + num_v + 1
                self.triangles += [(a, b, b + 1), (a, b + 1, a + 1)]

    def add_revolved(self, profile):
        """profile: (radius, height) from end to end, about z."""
        profile = np.asarray(profile, float)
        for p, q in zip(profile[:-1], profile[1:]):

            def patch(u, v, p=p, q=q):
                radius, height = (1 - u) * p + u * q
                return radius * np.cos(2 * np.pi * v), radius * np.sin(2 * np.pi * v), height

            self.add(1, 96, patch)

    def add_box(self, low, size):
        low, size = np.asarray(low, float), np.asarray(size, float)
        for axis in range(3):
            for end in (0, 1):

                def patch(u, v, axis=axis, end=end):
                    at = np.zeros(3)
                    at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3] = end, u, v
                    return low + at * size

                self.add(1, 1, patch)

    def mesh(self):
        return np.array(self.vertices, np.float32), np.array(self.triangles)


def teapot():
    """In the manner of the one in Utah."""
    body = common(ellipsoid((0, 0, 0), (1.05, 1.05, 0.8)), box((0, 0, -0.02), (2, 2, 0.62)))
    lid = ellipsoid((0, 0, 0.58), (0.6, 0.6, 0.2))
    pot = joined([body, ring((0, 0, 0.6), 0.64, 0.05), lid, ellipsoid((0, 0, 0.86), (0.13, 0.13, 0.11))], 0.05)
    handle = tube(((-0.8, 0, 0.4), (-1.75, 0, 0.6), (-1.85, 0, -0.25), (-0.85, 0, -0.38)), 0.09, 0.09)
    spout = tube(((0.7, 0, -0.25), (1.55, 0, -0.4), (1.25, 0, 0.45), (1.85, 0, 0.58)), 0.33, 0.1)
    return surface(joined([pot, handle, spout], 0.08), (-2, -1.2, -0.8), (2.1, 1.2, 1.1), 110)


def octopus():
    """Each arm in another pose."""
    parts = [ellipsoid((-0.05, 0, 1.0), (0.62, 0.62, 0.8))]
    for i, bend in enumerate((0.25, -0.35, 0.1, 0.45, -0.2, 0.35, -0.45, -0.05)):
        angle = 2 * np.pi * (i + 0.5) / 8
        c, s = np.cos(angle), np.sin(angle)
        arm = np.array([(0.3, 0, 0.35), (0.9, 0, 0.5), (1.3, 0.3 * bend, -0.35), (2.1 - abs(bend), 1.6 * bend, bend)])
        parts.append(tube(arm @ np.array([(c, s, 0), (-s, c, 0), (0, 0, 1)]), 0.19, 0.06))
    return surface(joined(parts, 0.12), (-2.4, -2.4, -0.8), (2.4, 2.4, 1.95), 130)


def car():
    parts = [box((0, 0, 0.65), (2.1, 0.85, 0.33), 0.18), box((-0.3, 0, 1.1), (1.1, 0.75, 0.38), 0.28)]
    parts += [wheel((x, y, 0.38), 0.38, 0.14) for x in (-1.25, 1.3) for y in (-0.75, 0.75)]
    return surface(joined(parts, 0.04), (-2.3, -1.1, -0.1), (2.3, 1.1, 1.6), 130)


def airplane():
    def wing(root, tip, start, end):  # a tube pressed flat
        return flattened(tube((root, root, tip, tip), start, end), 5)

    parts = [
        tube(((1.7, 0, 0), (0.8, 0, 0), (-1.0, 0, 0), (-2.1, 0, 0.12)), 0.27, 0.12),
        ellipsoid((1.7, 0, 0), (0.5, 0.27, 0.27)),
        tube(((-1.9, 0, 0.1), (-2.0, 0, 0.3), (-2.1, 0, 0.5), (-2.3, 0, 0.75)), 0.12, 0.08),
    ]
    for side in (-1, 1):
        parts.append(wing((0.25, 0.2 * side, -0.3), (-0.65, 2.1 * side, 0.3), 0.42, 0.2))
        parts.append(wing((-1.9, 0.1 * side, 0.6), (-2.25, 0.8 * side, 0.7), 0.22, 0.12))
        parts.append(tube([(x, 0.75 * side, -0.2) for x in (0.4, 0.3, 0.0, -0.15)], 0.13, 0.1))
    return surface(joined(parts, 0.05), (-2.6, -2.5, -0.6), (2.4, 2.5, 1.0), 150)


def chair():
    mesh = Patches()
    mesh.add_box((-0.5, -0.5, 0.85), (1.0, 1.0, 0.1))
    mesh.add_box((-0.5, -0.5, 0.95), (0.08, 1.0, 1.05))
    for x in (-0.5, 0.4):
        for y in (-0.5, 0.4):
            mesh.add_box((x, y, 0), (0.1, 0.1, 0.85))
    return mesh.mesh()


def carton():
    """A milk carton with a gable and the fin on it."""
    half, wall, ridge, fin = 0.48, 1.9, 2.4, 0.18
    mesh = Patches()
    mesh.add_box((-half, -half, 0), (2 * half, 2 * half, wall))
    for side in (-1, 1):
        mesh.add(1, 1, lambda u, v: (half * (2 * u - 1), side * half * (1 - v), wall + (ridge - wall) * v))
        mesh.add(2, 1, lambda u, v: (side * half * (1 - 0.5 * v * (1 - abs(2 * u - 1))), half * (2 * u - 1) * (1 - v),
                                     wall + (ridge - wall) * v))
    mesh.add_box((-half, -0.02, ridge), (2 * half, 0.04, fin))
    return mesh.mesh()


def propeller():
    """Three pitched blades on a hub: rotations without a plane."""
    blade = rotated(flattened(ellipsoid((1.05, 0, 0), (0.85, 0.42, 0.42)), 4), 0, 0.6)
    parts = [ellipsoid((0, 0, 0), (0.36, 0.36, 0.5))] + [rotated(blade, 2, 2 * np.pi * k / 3) for k in range(3)]
    return surface(joined(parts, 0.05), (-2, -2, -0.7), (2, 2, 0.7), 130)


def rim():
    """The wheel of a car without its tire."""
    spoke = tube(((0.1, 0, 0.15), (0.5, 0, 0.25), (0.9, 0, 0.25), (1.35, 0, 0.1)), 0.17, 0.12)
    parts = [ellipsoid((0, 0, 0.15), (0.3, 0.3, 0.15)), ring((0, 0, 0.2), 1.35, 0.12), ring((0, 0, -0.3), 1.35, 0.12)]
    parts += [ring((0, 0, -0.05), 1.3, 0.17)] + [rotated(spoke, 2, 2 * np.pi * k / 5) for k in range(5)]
    return surface(joined(parts, 0.06), (-1.7, -1.7, -0.6), (1.7, 1.7, 0.6), 130)


def bottle():
    mesh = Patches()
    mesh.add_revolved([(0, 0), (0.42, 0), (0.45, 0.08), (0.45, 1.3), (0.38, 1.55), (0.17, 1.85), (0.15, 2.3),
                       (0.19, 2.32), (0.19, 2.42), (0, 2.42)])
    return mesh.mesh()


def mug(reach=0.9, rise=0.9):
    """A cup of radius 1 and height 2.4 with an elliptic handle. reach, rise: its half axes."""
    height, inner, floor, thickness = 2.4, 0.92, 0.1, 0.11
    mesh = Patches()
    mesh.add_revolved([(0, 0), (1, 0), (1, height), (inner, height), (inner, floor), (0, floor)])

    def handle(u, v):
        angle, around = np.pi * (u - 0.5), 2 * np.pi * v
        out = np.array([np.cos(angle), 0, np.sin(angle)])
        middle = np.array([0.95 + reach * out[0], 0, height / 2 + rise * out[2]])
        return middle + thickness * (np.cos(around) * out + np.sin(around) * np.array([0, 1, 0]))

    mesh.add(24, 12, handle)
    return mesh.mesh()


def write_ply(path, vertices, triangles):
    """Binary PLY."""
    faces = np.zeros(len(triangles), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, triangles
    with open(path, "wb") as file:
        file.write(
            f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n"
            "property float x\nproperty float y\nproperty float z\n"
            f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n".encode()
        )
        file.write(np.ascontiguousarray(vertices, "<f4").tobytes() + faces.tobytes())


def main(folder):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for shape in (teapot, octopus, mug, car, airplane, chair, carton, propeller, rim, bottle):
        write_ply(folder / f"{shape.__name__}.ply", *shape())


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__, file=sys.stdout if sys.argv[1:] in (["-h"], ["--help"]) else sys.stderr)
        sys.exit(0 if sys.argv[1:] in (["-h"], ["--help"]) else 2)
    main(sys.argv[1])
