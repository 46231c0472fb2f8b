"""The planar case (Section 4.2): lines of symmetry of contours, and the pictures of Figures 1 to 3.

usage: python3 apps/gallery/planar.py OUT.png [--columns N] [--size N] SHAPE ...

A SHAPE is the name of a file with two columns, or one of these in quotes:

  polygon N              regular, in the unit circle
  rectangle W H [BUMP]   half width, half height, height of a bump on the upper side
  starfish NOISE         five arms; points moved along the radius by that standard deviation
  flower ARMS            a starfish with so many of its five arms
  mug HANDLE             a mug from the side, with a handle of that radius

The darker a point of the picture, the greater the symmetry of the best line through it. Prints the best two lines n.x = r of each
shape: the angle of n, r, and D. Needs python3-matplotlib and python3-scipy.
"""

import argparse
from pathlib import Path

import numpy as np
from scipy.ndimage import map_coordinates, maximum_filter
from scipy.optimize import minimize
from scipy.spatial import cKDTree

CELLS, SIGMA = 128, 2.0  # of the distance transform along an edge; its width in cells
VERMILION = 214, 94, 0


def traced(corners, step=0.004):
    """Points at equal steps along each edge of a polygon."""
    edges = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0)):
        count = int(np.linalg.norm(b - a) / step) + 1
        edges.append(a + (b - a) * ((np.arange(count) + 0.5) / count)[:, None])
    return np.vstack(edges)


def arms(number, noise):
    angle = 2 * np.pi * np.arange(2400) / 2400
    radius = 0.6 + 0.35 * np.cos(5 * angle) + noise * np.random.default_rng(1).standard_normal(2400)
    kept = (5 * angle / (2 * np.pi) + 0.5).astype(int) % 5 < number
    return (radius * np.array([np.sin(angle), np.cos(angle)])).T[kept]


def contour(shape):
    """Points (N, 2) of a shape."""
    if Path(shape).is_file():
        return np.loadtxt(shape, ndmin=2)[:, :2]
    name, *numbers = shape.split()
    n = [float(number) for number in numbers]
    if name == "polygon":
        angle = 2 * np.pi * np.arange(int(n[0])) / n[0]
        return traced(np.array([-np.sin(angle), np.cos(angle)]).T)
    if name == "rectangle":
        w, h = n[:2]
        bump = [(0.45 * w, h), (0.35 * w, h + n[2]), (0.25 * w, h)] if n[2:] else []
        return traced(np.array([(-w, -h), (w, -h), (w, h), *bump, (-w, h)]))
    if name == "mug":
        angle = np.pi * (np.arange(300) / 300 - 0.5)
        handle = np.array([0.6 + n[0] * np.cos(angle), n[0] * np.sin(angle)]).T
        return np.vstack([handle, traced(np.array([(-0.6, -0.8), (0.6, -0.8), (0.6, 0.8), (-0.6, 0.8)]))])
    if name in ("starfish", "flower"):
        return arms(5, n[0]) if name == "starfish" else arms(n[0], 0)
    raise SystemExit(f"planar.py: {shape} is no file and no shape, see -h")


class LineTransform:
    """D(theta, r) of all lines n.x = r, n = (cos theta, sin theta): 128 angles in [0, pi), r every half cell about the middle."""

    def __init__(self, points):
        self.center = (points.min(axis=0) + points.max(axis=0)) / 2
        self.radius = np.linalg.norm(points - self.center, axis=1).max()
        self.cell = 2 * self.radius / (CELLS - 8 * SIGMA)
        self.at = np.arange(CELLS) - (CELLS - 1) / 2  # cells from the middle
        x, y = np.meshgrid(self.at, self.at)
        distance, _ = cKDTree((points - self.center) / self.cell).query(np.stack([x, y], -1))
        self.f = np.exp(-(distance / SIGMA) ** 2)
        self.theta = np.pi * np.arange(CELLS) / CELLS
        self.r = (np.arange(2 * CELLS - 1) - (CELLS - 1)) / 2
        self.values = np.array([self.of_direction(theta) for theta in self.theta])

    def at_points(self, x, y):
        return map_coordinates(self.f, [y + (CELLS - 1) / 2, x + (CELLS - 1) / 2], order=3)

    def of_direction(self, theta):
        """D of all lines with one normal: with f rotated so that the normal is x, a correlation of each row with its reverse."""
        x, y = np.meshgrid(self.at, self.at)
        rotated = self.at_points(np.cos(theta) * x - np.sin(theta) * y, np.sin(theta) * x + np.cos(theta) * y)
        spectrum = np.fft.rfft(rotated, 2 * CELLS, axis=1)
        return np.fft.irfft((spectrum**2).sum(axis=0))[: 2 * CELLS - 1] / (self.f**2).sum()

    def value(self, theta, r):
        """D of one line."""
        x, y = np.meshgrid(self.at, self.at)
        along = 2 * (r - np.cos(theta) * x - np.sin(theta) * y)
        return (self.f * self.at_points(x + along * np.cos(theta), y + along * np.sin(theta))).sum() / (self.f**2).sum()

    def lines(self, least=0.5):
        """Local maxima: rows of theta in [0, pi), r in input units about the origin, and D, best first."""
        wrapped = np.vstack([self.values[-1:, ::-1], self.values, self.values[:1, ::-1]])  # past theta = pi lies (0, -r)
        peaks = np.argwhere((maximum_filter(wrapped, 5)[1:-1] == self.values) & (self.values > 0.9 * least))
        found = []
        for t, k in peaks:
            best = minimize(lambda line: -self.value(*line), (self.theta[t], self.r[k]), method="Nelder-Mead",
                            options={"initial_simplex": np.add((self.theta[t], self.r[k]), ((0, 0), (0.02, 0), (0, 0.5)))})
            theta, r = best.x
            sign = 1 if np.floor(theta / np.pi) % 2 == 0 else -1
            theta %= np.pi
            r = sign * r * self.cell + self.center @ (np.cos(theta), np.sin(theta))
            found.append((theta, r, -best.fun))
        return np.array(sorted((line for line in found if line[2] > least), key=lambda line: -line[2]))

    def picture(self, points, size):
        """For each pixel the greatest D of any line through it, dark where that is 1, with the contour on top."""
        step = 2.24 * self.radius / self.cell / size
        at = step * (np.arange(size) + 0.5 - size / 2)
        x, y = np.meshgrid(at, -at)
        rows = zip(self.theta, self.values)
        symmetry = np.max([np.interp(np.cos(t) * x + np.sin(t) * y, self.r, row, 0, 0) for t, row in rows], axis=0)
        pixels = (255 * (1 - symmetry.clip(0, 1))).round().astype(np.uint8)[:, :, None].repeat(3, axis=2)
        column, row = ((points - self.center) / self.cell / step * (1, -1) + size / 2).astype(int).T
        pixels[row, column] = VERMILION
        return pixels


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, usage=argparse.SUPPRESS)
    parser.add_argument("out")
    parser.add_argument("shapes", nargs="+")
    parser.add_argument("--columns", type=int, default=8)
    parser.add_argument("--size", type=int, default=220)
    arguments = parser.parse_args()
    import matplotlib.image

    tiles = []
    for shape in arguments.shapes:
        points = contour(shape)
        transform = LineTransform(points)
        tiles.append(np.pad(transform.picture(points, arguments.size), ((0, 4), (0, 4), (0, 0)), constant_values=255))
        for theta, r, value in transform.lines()[:2]:
            print(f"{shape}: normal at {np.degrees(theta):.1f} degrees, r = {round(r, 3) + 0.0:.3f}, D = {value:.3f}")
    tiles += [np.full_like(tiles[0], 255)] * (-len(tiles) % min(arguments.columns, len(tiles)))
    columns = min(arguments.columns, len(tiles))
    rows = [np.hstack(tiles[k : k + columns]) for k in range(0, len(tiles), columns)]
    matplotlib.image.imsave(arguments.out, np.vstack(rows)[:-4, :-4])


if __name__ == "__main__":
    main()
