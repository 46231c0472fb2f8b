"""The paper's own way to a canonical frame (Section 5.1), with Iterative Symmetric Points (Section 4.4)."""

from dataclasses import dataclass

import numpy as np
import pcl_symmetry
from scipy.ndimage import convolve1d, maximum_filter
from scipy.spatial import cKDTree

NUM_POINTS = 10_000  # reflected in each iteration, as in the paper
MOST_REFINED = 8  # maxima of the map: the first plane is the strongest of them once they are refined
MOST_STEPS = 50
AT_REST = 1e-3  # radians, and shares of the radius: far below the 5 degrees that count
NUM_ANGLES = 128  # of second planes over the half turn: as far apart as the bins of theta
NUM_CELLS = 64  # of the Gaussian distance transform along each side
NUM_SEARCHED = 1000  # points that rank the planes perpendicular to the axes found before


@dataclass
class Plane:
    """{x: normal . x = offset}"""

    normal: np.ndarray
    offset: float

    def reflect(self, x):
        return x - 2 * (x @ self.normal - self.offset)[:, None] * self.normal


class PublishedFrame:
    """Planes through a cloud, and what the transform says of them."""

    def __init__(self, points, method="convolution", seed=1):
        points = np.asarray(points, float)
        self.points = points[np.random.default_rng(seed).permutation(len(points))[:NUM_POINTS]]
        self.map = pcl_symmetry.transform(points.astype("f"), method=method, seed=seed, threads=1)
        self.tree = cKDTree(points)
        self.surface = points
        self.mass = points.mean(axis=0)
        first, last = self._plane((0, 0, 0)), self._plane((0, 0, self.map.values.shape[2] - 1))
        self.radius = 0.5 * (last.offset - first.offset) / (1 - 1 / self.map.values.shape[2])

    def frame(self, refined=True):
        """The center, (3,), and the axes in the columns of a (3, 3) array, in the order in which they are found."""
        first = self._first(refined)
        across = np.linalg.svd(first.normal[None])[2][1:].T
        second = self._within(across, refined)
        axes = np.column_stack([first.normal, second.normal, np.cross(first.normal, second.normal)])
        third = self._within(axes[:, 2:], refined)
        return np.linalg.solve(axes.T, [first.offset, second.offset, third.offset]), axes

    def _plane(self, index):
        coefficients = self.map.plane(*(int(i) for i in index))
        return Plane(coefficients[:3], -coefficients[3])

    def _first(self, refined):
        """The plane of greatest symmetry."""
        best = self._plane(np.unravel_index(self.map.values.argmax(), self.map.values.shape))
        return self._strongest([best] + self._local_maxima(), np.eye(3)) if refined else best

    def _local_maxima(self):
        """Planes at bins that no neighbor exceeds and that keep to the thresholds of Section 4.4, strongest first."""
        values = self.map.values
        modes = ("nearest", "wrap", "nearest")  # theta, phi, r
        laplacian = sum(convolve1d(values, [1, -2, 1], axis, mode=mode) for axis, mode in enumerate(modes))
        strongest = values.argmax()
        found = (values == maximum_filter(values, 3, mode=modes)) & (laplacian <= 0.1 * laplacian.flat[strongest])
        bins = np.argwhere(found)
        bins = bins[np.argsort(-values[tuple(bins.T)], kind="stable")]
        planes = []
        for index in bins:
            plane = self._plane(index)
            from_mass = abs(plane.normal @ self.mass - plane.offset)
            if values[tuple(index)] >= 0.1 * values.max() * (1 - from_mass / self.radius):
                planes.append(plane)
            if len(planes) == MOST_REFINED:
                break
        return planes

    def _within(self, basis, refined):
        """The plane of greatest symmetry whose normal lies in the span of the columns of basis, two or one."""
        angles = np.pi * np.arange(NUM_ANGLES) / NUM_ANGLES if basis.shape[1] == 2 else np.zeros(1)
        normals = np.outer(np.cos(angles), basis[:, 0]) + np.outer(np.sin(angles), basis[:, -1])
        grid, origin, cell = self._distance_transform()
        middle = origin + 0.5 * (NUM_CELLS - 1) * cell
        offsets = np.arange(-(NUM_CELLS // 2), NUM_CELLS // 2 + 1) * cell
        x = self.points[:NUM_SEARCHED] - middle
        best = (-1.0, None)
        for normal in normals:
            # (offsets, points, 3) cells that the reflections fall into
            reflected = x[None] - 2 * ((x @ normal)[None] - offsets[:, None])[:, :, None] * normal
            cells = np.rint(reflected / cell + 0.5 * (NUM_CELLS - 1)).astype(int)
            inside = ((cells >= 0) & (cells < NUM_CELLS)).all(axis=2)
            cells[~inside] = 0
            sums = (grid[cells[..., 0], cells[..., 1], cells[..., 2]] * inside).sum(axis=1)
            if sums.max() > best[0]:
                best = (sums.max(), Plane(normal, normal @ middle + offsets[sums.argmax()]))
        return self._strongest([best[1]], basis) if refined else best[1]

    def _distance_transform(self):
        """exp(-d^2 / sigma^2) at the centers of cells, d the distance to the closest point."""
        if not hasattr(self, "_grid"):
            middle = 0.5 * (self.surface.min(axis=0) + self.surface.max(axis=0))
            cell = 2 * self.radius / NUM_CELLS
            origin = middle - 0.5 * (NUM_CELLS - 1) * cell
            centers = origin + cell * np.stack(np.meshgrid(*[np.arange(NUM_CELLS)] * 3, indexing="ij"), axis=-1)
            sigma = self.map.sigma
            distance = self.tree.query(centers.reshape(-1, 3), distance_upper_bound=3 * sigma)[0]
            self._grid = np.exp(-((distance / sigma) ** 2)).reshape([NUM_CELLS] * 3), origin, cell
        return self._grid

    def _symmetry(self, plane):
        """Mean of the distance transform at the reflected points: D up to a factor that all planes share."""
        distance = self.tree.query(plane.reflect(self.points), distance_upper_bound=3 * self.map.sigma)[0]
        return np.exp(-((distance / self.map.sigma) ** 2)).mean()

    def _strongest(self, starts, basis):
        """The plane of greatest symmetry among some and what they become when they are refined. Maxima that leave their
        cell stay, because so the method does best."""
        planes = starts + [self._refined(start, basis) for start in starts]
        return planes[int(np.argmax([self._symmetry(plane) for plane in planes]))]

    def _refined(self, plane, basis):
        """Iterative Symmetric Points with the normal in the span of basis."""
        for _ in range(MOST_STEPS):
            distance, closest = self.tree.query(plane.reflect(self.points), distance_upper_bound=3 * self.map.sigma)
            near = np.isfinite(distance)
            if not near.any():
                break
            x, y = self.points[near], self.surface[closest[near]]
            weight = np.exp(-((distance[near] / self.map.sigma) ** 2))
            middle = weight @ (x + y) / (2 * weight.sum())
            product = (weight[:, None] * (x - middle)).T @ (y - middle)
            # sum w |x' - y|^2 = const + 4 sum w (n.x - r)(n.y - r): the eigenvector of the smallest eigenvalue.
            normal = basis @ np.linalg.eigh(basis.T @ (product + product.T) @ basis)[1][:, 0]
            moved = Plane(normal, normal @ middle)
            angle = np.arccos(min(1.0, abs(normal @ plane.normal)))
            sign = np.sign(normal @ plane.normal)
            shift = abs((moved.offset - normal @ self.mass) - sign * (plane.offset - plane.normal @ self.mass))
            plane = moved
            if angle < AT_REST and shift < AT_REST * self.radius:
                break
        return plane
