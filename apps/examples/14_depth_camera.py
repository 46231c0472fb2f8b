"""From a depth image to completed objects, from a folder of meshes to a database, and figures of both.

usage: python3 apps/examples/14_depth_camera.py FOLDER [DEPTH.npy FX FY CX CY]

FOLDER receives the results. Meshes (.npz with vertices and faces) in it become its database, models.db. Without a depth image
(H, W), meters, a table with two blocks is looked at, and the models are those blocks and a rod.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, Dict, Tuple

import numpy as np
from numpy.typing import NDArray

import pcl_symmetry

Array = NDArray[Any]
Intrinsics = Tuple[float, float, float, float]


class Mesh:
    """Like those of Open3D and trimesh."""

    def __init__(self, vertices: Array, faces: Array) -> None:
        self.vertices, self.faces = vertices, faces


def block(size: Tuple[float, float, float]) -> Mesh:
    """A box on the ground, about the origin."""
    corners = [[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (0.0, 1.0)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return Mesh(np.array(corners) * size, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]))


def table(intrinsics: Intrinsics) -> Array:
    """A depth image of two blocks on a table, seen from above and in front."""
    fx, fy, cx, cy = intrinsics
    v, u = np.indices((240, 320))
    rays = np.stack([(u - cx) / fx, (v - cy) / fy, np.ones(u.shape)], axis=2)
    rays = rays @ np.array([[1, 0, 0], [0, 0.8, 0.6], [0, -0.6, 0.8]]).T
    camera = np.array([0, -0.9, -1.2])
    depth = np.full(u.shape, np.inf)
    with np.errstate(divide="ignore", invalid="ignore"):
        falls = rays[..., 1] > 1e-9
        depth[falls] = -camera[1] / rays[..., 1][falls]
        for size, center, angle in (((0.3, 0.3, 0.25), (-0.2, -0.15, 0.05), 0.6), ((0.25, 0.2, 0.15), (0.25, -0.1, 0), -0.5)):
            turned = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
            seen_from, along = (camera - center) @ turned, rays @ turned
            first, second = (-0.5 * np.array(size) - seen_from) / along, (0.5 * np.array(size) - seen_from) / along
            enters, leaves = np.minimum(first, second).max(axis=2), np.maximum(first, second).min(axis=2)
            hit = (enters < leaves) & (enters > 0) & (enters < depth)
            depth[hit] = enters[hit]
    depth[depth > 4] = 0  # nothing was measured
    return depth


def models_of(folder: Path) -> Dict[str, Mesh]:
    """Those in the folder, by name, or three blocks."""
    models: Dict[str, Mesh] = {}
    for file in sorted(folder.glob("*.npz")):
        with np.load(file) as arrays:
            models[file.stem] = Mesh(arrays["vertices"], arrays["faces"])
    return models or {"large": block((0.3, 0.25, 0.3)), "small": block((0.25, 0.15, 0.2)), "rod": block((0.05, 0.05, 0.9))}


def build(folder: Path) -> pcl_symmetry.Database:
    """The database of the models; what is stored already stays, also where this is interrupted."""
    database = pcl_symmetry.Database(folder / "models.db", create=True, unit="m")
    models = {name: mesh for name, mesh in models_of(folder).items() if name not in database}
    report = database.build(models, progress=True)
    for name, reason in report.failures:
        print(f"{name}: {reason}")
    print(f"{report.num_added} models stored, {len(database)} in all")
    return database


def describe(number: int, found: pcl_symmetry.SceneObject) -> None:
    """What is known of an object, in a few lines."""
    print(f"object {number}: {len(found.rows)} points, {len(found.added)} added")
    for axis in found.planes.axes:
        print(f"  body of revolution about {axis.direction.round(3)}, confidence {axis.confidence:.2f}")
    for center in found.planes.centers:
        print(f"  every plane through {center.point.round(3)}, confidence {center.confidence:.2f}")
    for plane in found.planes:
        print(f"  plane {plane.coefficients.round(4)}, confidence {plane.confidence:.2f}")
    for plane in found.planes.possible:
        print(f"  perhaps a plane {plane.coefficients.round(4)}, confidence {plane.confidence:.2f}")
    if not (found.planes.every or found.planes.axes or found.planes.centers):
        print("  no symmetry")
    for model in found.models[:1]:
        print(f"  is {model.name}, confidence {model.confidence:.2f}, at {model.transform[:3, 3].round(3)} of its frame")


def completed(points: Array, found: pcl_symmetry.SceneObject) -> Array:
    """(K + M, 3) measured points of an object, then those that its symmetry adds."""
    measured = points.reshape(-1, 3)[found.rows]
    return np.concatenate([measured, found.added])


def one_object(points: Array, mask: Array) -> None:
    """The same for an object that something else has found, such as a neural network: its mask is enough."""
    found = pcl_symmetry.planes(points, indices=mask)
    added, _ = pcl_symmetry.complete(points, indices=mask)
    frame = pcl_symmetry.frame(points, indices=mask)
    print(f"mask: {len(found)} planes, {len(added)} points added, center {frame.center.round(3)}")


def draw(folder: Path, points: Array, scene: pcl_symmetry.Scene) -> None:
    """The scene as a page for any browser; with matplotlib also pictures of the objects."""
    scene.show(points).save(folder / "scene.html")
    try:
        import matplotlib
    except ImportError:
        return
    matplotlib.use("Agg")
    for number, found in enumerate(scene, 1):
        whole = completed(points, found)
        planes = pcl_symmetry.planes(whole, viewpoint=None)
        planes.plot(whole).figure.savefig(folder / f"object_{number}.png")


def main(folder: Path, depth: Array, intrinsics: Intrinsics) -> None:
    points = pcl_symmetry.from_depth(depth, intrinsics)
    with build(folder) as database:
        scene = pcl_symmetry.scene(points, database=database)
    for number, found in enumerate(scene, 1):
        describe(number, found)
        np.save(folder / f"object_{number}.npy", completed(points, found))
    if len(scene):
        one_object(points, scene.labels == 1)
    draw(folder, points, scene)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 7) or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        sys.exit(0 if sys.argv[1:] in (["-h"], ["--help"]) else 2)
    camera: Intrinsics = (300.0, 300.0, 160.0, 120.0)
    if len(sys.argv) == 7:
        fx, fy, cx, cy = map(float, sys.argv[3:])
        camera = (fx, fy, cx, cy)
    image = np.load(sys.argv[2]) if len(sys.argv) == 7 else table(camera)
    Path(sys.argv[1]).mkdir(parents=True, exist_ok=True)
    main(Path(sys.argv[1]), image, camera)
