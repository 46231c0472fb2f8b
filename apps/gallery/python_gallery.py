"""Five pictures of what the Python module finds, made with matplotlib.

usage: python3 apps/gallery/python_gallery.py FOLDER MODEL.xyz|MODEL.npy|...

The folder receives NAME_planes.png, NAME_support.png, NAME_frame.png, NAME_map.png and NAME_parts.png. A model is an array of points:
columns of text, or a file of NumPy. Needs python3-matplotlib, and the module (python3-pcl-symmetry, or PYTHONPATH=build/src/python).
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import pcl_symmetry

# Eight colours that remain apart for colour-blind eyes (Okabe and Ito), as in the pictures of the tools.
COLORS = ["#E69F00", "#0072B2", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#F0E442", "#595959"]


def axes_for(points, title):
    figure = plt.figure(figsize=(6, 6), dpi=100)
    axes = figure.add_subplot(projection="3d")
    low, high = points.min(axis=0), points.max(axis=0)
    middle, half = (low + high) / 2, (high - low).max() / 2
    axes.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half), title=title)
    axes.set_zlim(middle[2] - half, middle[2] + half)
    axes.set_box_aspect((1, 1, 1))
    axes.set_axis_off()
    return figure, axes


def corners_of(plane, points):
    """The corners of a square in the plane around the points, (4, 3)."""
    normal = np.asarray(plane.normal)
    u = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    u /= np.linalg.norm(u)
    v = np.cross(normal, u)
    center = points.mean(axis=0)
    center = center - (normal @ center - plane.offset) * normal
    half = 0.6 * np.linalg.norm(points.max(axis=0) - points.min(axis=0)) / np.sqrt(2)
    return np.array([center + half * (a * u + b * v) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


def draw_planes(points, found):
    figure, axes = axes_for(points, f"{len(found)} planes, {len(found.axes)} axes")
    axes.scatter(*points.T, s=1, c="#4D6185")
    for plane, color in zip(found, COLORS):
        axes.plot_trisurf(*corners_of(plane, points).T, triangles=[(0, 1, 2), (0, 2, 3)], color=color, alpha=0.25)
    for axis in found.axes:
        reach = np.array([-1, 1])[:, None] * np.linalg.norm(np.ptp(points, axis=0)) / 2
        axes.plot(*(np.asarray(axis.point) + reach * np.asarray(axis.direction)).T, color=COLORS[4], linewidth=2)
    return figure


def draw_support(points, found):
    figure, axes = axes_for(points, "support of the first plane" if len(found) else "no plane")
    values = found.point_support(0) if len(found) else np.zeros(len(points))
    shown = axes.scatter(*points.T, s=1, c=values, cmap="cividis", vmin=0, vmax=1)
    figure.colorbar(shown, shrink=0.6)
    return figure


def draw_frame(points):
    frame = pcl_symmetry.frame(points)
    figure, axes = axes_for(points, "center of symmetry and principal symmetry axes")
    axes.scatter(*points.T, s=1, c="#4D6185")
    length = np.linalg.norm(np.ptp(points, axis=0)) / 2
    for k in range(3):
        ends = frame.center + np.array([[-1], [1]]) * length * frame.axes[:, k] * frame.scores[k]
        axes.plot(*ends.T, color=COLORS[k], linewidth=2)
    return figure


def draw_map(points):
    values = pcl_symmetry.transform(points).values
    figure, axes = plt.subplots(figsize=(6, 4), dpi=100)
    shown = axes.imshow(values.max(axis=2), aspect="auto", cmap="cividis", extent=(0, 360, 90, 0))
    axes.set(xlabel="phi, degrees", ylabel="theta, degrees", title="greatest symmetry of each direction of normals")
    figure.colorbar(shown)
    return figure


def draw_parts(points):
    labels = np.asarray(pcl_symmetry.segment(points))
    figure, axes = axes_for(points, f"{labels.max() + 1} parts")
    axes.scatter(*points.T, s=1, c=[COLORS[label % 8] if label >= 0 else "#BFBFBF" for label in labels])
    return figure


def main(folder, *models):
    Path(folder).mkdir(parents=True, exist_ok=True)
    for model in models:
        points = np.load(model) if model.endswith(".npy") else np.loadtxt(model, ndmin=2)
        points = np.ascontiguousarray(points[:, :3], dtype=np.float32)
        found = pcl_symmetry.planes(points)
        pictures = {
            "planes": draw_planes(points, found),
            "support": draw_support(points, found),
            "frame": draw_frame(points),
            "map": draw_map(points),
            "parts": draw_parts(points),
        }
        for name, figure in pictures.items():
            path = Path(folder) / f"{Path(model).stem}_{name}.png"
            figure.savefig(path)
            plt.close(figure)
            print(path)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        print(__doc__)
        sys.exit(0 if "-h" in sys.argv or "--help" in sys.argv else 2)
    main(*sys.argv[1:])
