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

# Eight colors that remain apart for color-blind eyes (Okabe and Ito), as in the pictures of the tools.
COLORS = ["#E69F00", "#0072B2", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#F0E442", "#595959"]


def draw_values(points, title, **how):
    axes = plt.figure(figsize=(6, 6), dpi=100).add_subplot(projection="3d")
    axes.set(title=title, aspect="equal")
    axes.set_axis_off()
    return axes, axes.scatter(*points.T, s=1, **how)


def draw_support(points, found):
    values = found.point_support(0) if len(found) else np.zeros(len(points))
    title = "support of the first plane" if len(found) else "no plane"
    axes, shown = draw_values(points, title, c=values, cmap="cividis", vmin=0, vmax=1)
    axes.figure.colorbar(shown, shrink=0.6)
    return axes


def draw_parts(points):
    labels = np.asarray(pcl_symmetry.segment(points))
    colors = [COLORS[label % 8] if label >= 0 else "#BFBFBF" for label in labels]
    return draw_values(points, f"{labels.max() + 1} parts", c=colors)[0]


def main(folder, *models):
    Path(folder).mkdir(parents=True, exist_ok=True)
    for model in models:
        points = np.load(model) if model.endswith(".npy") else np.loadtxt(model, ndmin=2)
        points = np.ascontiguousarray(points[:, :3], dtype=np.float32)
        found = pcl_symmetry.planes(points)
        pictures = {
            "planes": found.plot(points),
            "support": draw_support(points, found),
            "frame": pcl_symmetry.frame(points).plot(points),
            "map": pcl_symmetry.transform(points).plot(),
            "parts": draw_parts(points),
        }
        for name, axes in pictures.items():
            path = Path(folder) / f"{Path(model).stem}_{name}.png"
            axes.figure.savefig(path)
            plt.close(axes.figure)
            print(path)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        print(__doc__)
        sys.exit(0 if "-h" in sys.argv or "--help" in sys.argv else 2)
    main(*sys.argv[1:])
