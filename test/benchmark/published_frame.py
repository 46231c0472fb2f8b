"""The paper's own way to a canonical frame (Section 5.1), with Iterative Symmetric Points (Section 4.4)."""

import functools

import numpy as np
import pcl_symmetry
from scipy.ndimage import convolve1d, map_coordinates, maximum_filter
from scipy.spatial import cKDTree

NUM_POINTS = 10_000  # reflected in each iteration, as in the paper
MOST_REFINED = 8  # maxima of the map: the first plane is the strongest of them once they are refined
MOST_STEPS, AT_REST = 50, 1e-3  # of the refinement; radians and shares of the radius, far below 5 degrees
NUM_ANGLES = 128  # of second planes over the half turn: as far apart as the bins of theta
NUM_CELLS = 64  # of the distance transform along each side
NUM_SAMPLES = 2048  # points drawn from the distance transform, at which the symmetry of a plane is measured


class PublishedFrame:
    """Planes (normal, offset) through a cloud, {x: normal . x = offset}, and what the transform says of them."""

    def __init__(self, points, seed=1):
        self.surface = np.asarray(points, float)
        self.points = self.surface[np.random.default_rng(seed).permutation(len(points))[:NUM_POINTS]]
        self.map = pcl_symmetry.transform(self.surface.astype("f"), method="convolution", seed=seed, threads=1)
        self.tree, self.mass = cKDTree(self.surface), self.surface.mean(axis=0)
        last = self.map.values.shape[2] - 1
        self.radius = 0.5 * (self._plane((0, 0, last))[1] - self._plane((0, 0, 0))[1]) * (last + 1) / last

    def frame(self, refined=True):
        """The center, (3,), and the axes in the columns of a (3, 3) array, in the order in which they are found."""
        first = self._first(refined)
        second = self._within(np.linalg.svd(first[0][None])[2][1:].T, refined)
        axes = np.column_stack([first[0], second[0], np.cross(first[0], second[0])])
        third = self._within(axes[:, 2:], refined)
        return np.linalg.solve(axes.T, [first[1], second[1], third[1]]), axes

    def _plane(self, index):
        coefficients = self.map.plane(*(int(i) for i in index))
        return coefficients[:3], -coefficients[3]

    def _first(self, refined):
        """The plane of greatest symmetry."""
        best = self._plane(np.unravel_index(self.map.values.argmax(), self.map.values.shape))
        return self._strongest([best, *self._local_maxima()], np.eye(3)) if refined else best

    def _local_maxima(self):
        """Planes at bins that no neighbor exceeds and that keep to the thresholds of Section 4.4, strongest first."""
        values, modes = self.map.values, ("nearest", "wrap", "nearest")  # theta, phi, r
        laplacian = sum(convolve1d(values, [1, -2, 1], axis, mode=mode) for axis, mode in enumerate(modes))
        curved = laplacian <= 0.1 * laplacian.flat[values.argmax()]
        bins = np.argwhere((values == maximum_filter(values, 3, mode=modes)) & curved)
        planes = []
        for index in bins[np.argsort(-values[tuple(bins.T)], kind="stable")]:
            normal, offset = self._plane(index)
            nearness = 1 - abs(normal @ self.mass - offset) / self.radius
            if values[tuple(index)] >= 0.1 * values.max() * nearness and len(planes) < MOST_REFINED:
                planes.append((normal, offset))
        return planes

    def _within(self, basis, refined):
        """The plane of greatest symmetry whose normal lies in the span of the columns of basis, two or one."""
        angles = np.pi * np.arange(NUM_ANGLES) / NUM_ANGLES if basis.shape[1] == 2 else np.zeros(1)
        middle, cell, grid, samples = self._distance_transform
        offsets = np.arange(-(NUM_CELLS // 2), NUM_CELLS // 2 + 1) * cell
        x, best = samples - middle, (-1.0, None)
        for normal in np.outer(np.cos(angles), basis[:, 0]) + np.outer(np.sin(angles), basis[:, -1]):
            reflected = x - 2 * ((x @ normal) - offsets[:, None])[..., None] * normal  # (offsets, points, 3)
            cells = np.moveaxis(reflected / cell + 0.5 * (NUM_CELLS - 1), -1, 0)
            sums = map_coordinates(grid, cells, order=0, mode="constant").sum(axis=1)
            best = max(best, (sums.max(), (normal, normal @ middle + offsets[sums.argmax()])), key=lambda b: b[0])
        return self._strongest([best[1]], basis) if refined else best[1]

    @functools.cached_property
    def _distance_transform(self):
        """Middle, edge of a cell, f = exp(-d^2 / sigma^2) at the centers of cells, d the distance to the closest point,
        and points drawn with probability f: D is the mean of f at their reflections, up to a factor."""
        middle, cell = 0.5 * (self.surface.min(axis=0) + self.surface.max(axis=0)), 2 * self.radius / NUM_CELLS
        centers = middle + cell * (np.moveaxis(np.indices([NUM_CELLS] * 3), 0, -1) - 0.5 * (NUM_CELLS - 1))
        grid = self._nearness(centers)[0].astype("f")
        up_to = np.cumsum(grid, dtype=float)
        drawn = np.searchsorted(up_to, up_to[-1] * (np.arange(NUM_SAMPLES) + 0.5) / NUM_SAMPLES)
        return middle, cell, grid, centers.reshape(-1, 3)[drawn]

    def _nearness(self, x):
        """exp(-d^2 / sigma^2) and index of the closest points to x; 0 and no index beyond three sigma."""
        distance, closest = self.tree.query(x, distance_upper_bound=3 * self.map.sigma)
        return np.exp(-((distance / self.map.sigma) ** 2)), closest

    @staticmethod
    def _reflected(x, plane):
        return x - 2 * (x @ plane[0] - plane[1])[:, None] * plane[0]

    def _strongest(self, starts, basis):
        """The plane of greatest symmetry among some and what they become when they are refined. Maxima that leave their
        cell stay, because so the method does best."""
        planes = starts + [self._refined(start, basis) for start in starts]
        samples = self._distance_transform[3]
        return max(planes, key=lambda plane: self._nearness(self._reflected(samples, plane))[0].mean())

    def _refined(self, plane, basis):
        """Iterative Symmetric Points with the normal in the span of basis."""
        for _ in range(MOST_STEPS):
            weight, closest = self._nearness(self._reflected(self.points, plane))
            near = weight > 0
            if not near.any():
                break
            x, y, weight = self.points[near], self.surface[closest[near]], weight[near]
            middle = weight @ (x + y) / (2 * weight.sum())
            product = (weight[:, None] * (x - middle)).T @ (y - middle)
            # sum w |x' - y|^2 = const + 4 sum w (n.x - r)(n.y - r): the eigenvector of the smallest eigenvalue
            normal = basis @ np.linalg.eigh(basis.T @ (product + product.T) @ basis)[1][:, 0]
            normal = normal if normal @ plane[0] >= 0 else -normal
            way = normal - plane[0], normal @ (middle - self.mass) - (plane[1] - plane[0] @ self.mass)
            plane = normal, normal @ middle
            if np.linalg.norm(way[0]) < AT_REST and abs(way[1]) < AT_REST * self.radius:
                break
        return plane
