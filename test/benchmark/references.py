"""The symmetries that a mesh really has, by brute force: what detectors are measured against.

A plane is a reference where it maps at least 97 % of the area to within 1 % of the diameter of the mesh; near where it
maps 90 %. All planes, 2 degrees and 1 % of the diagonal apart, are tried on points of the surface; local maxima, and
the reflections of what was found in each other, are refined on exact distances and climb to the greatest share. Planes
through one line that all hold are an axis, axes that span space a center. Nothing is shared with the detector.
"""
import math

import numpy as np
from scipy.ndimage import maximum_filter1d
from scipy.optimize import minimize
from scipy.spatial import cKDTree

import bench

MIN_SHARE, NEAR_SHARE, TOLERANCE = 0.97, 0.90, 0.01
MERGE_ANGLE, MERGE_OFFSET = math.radians(3), 0.02  # of planes closer than this, the best is kept; diagonals
SAME_ANGLE, SAME_OFFSET = math.radians(1), 0.005  # candidates that reached the same plane
SLACK = 0.05  # of shares by 1000 samples: five standard errors
GOLDEN = 0.5 * (math.sqrt(5) - 1)


# Planes are rows (n, r) with n.x = r, lines are pairs of point and direction


def offsets_and_angles(planes, plane, at=(0, 0, 0)):
    """How far a plane is from each row of planes: angles, and distances of the planes at a point."""
    planes, plane = np.atleast_2d(planes), np.asarray(plane)
    cosine = planes[:, :3] @ plane[:3]
    here = np.sign(cosine + 1e-300) * (plane[:3] @ at - plane[3])
    return np.arccos(np.minimum(1, np.abs(cosine))), np.abs(planes[:, :3] @ at - planes[:, 3] - here)


def line_from_plane(plane, point, direction, at=(0, 0, 0)):
    """Angle between a line and a plane, and distance from the plane of the line's point closest to `at`."""
    closest = point + direction * ((at - point) @ direction)
    return math.asin(min(1, abs(plane[:3] @ direction))), abs(plane[:3] @ closest - plane[3])


def line_from_line(point, direction, other_point, other_direction, at=(0, 0, 0)):
    """Angle between two lines, and distance from the first of the second one's point closest to `at`."""
    closest = other_point + other_direction * ((at - other_point) @ other_direction)
    angle = math.atan2(np.linalg.norm(np.cross(direction, other_direction)), abs(direction @ other_direction))
    return angle, np.linalg.norm(np.cross(closest - point, direction))


def planes_through_line(point, direction, count):
    u = np.cross(direction, np.eye(3)[np.argmin(np.abs(direction))])
    u /= np.linalg.norm(u)
    angles = np.pi * (GOLDEN * np.arange(count) % 1)[:, None]
    normals = np.cos(angles) * u + np.sin(angles) * np.cross(direction, u)
    return np.c_[normals, normals @ point]


def planes_through_point(point, count):
    """Normals spread evenly over half of the sphere."""
    z, angle = (np.arange(count) + 0.5) / count, 2 * np.pi * (GOLDEN * np.arange(count) % 1)
    ring = np.sqrt(1 - z * z)
    normals = np.stack([ring * np.cos(angle), ring * np.sin(angle), z], 1)
    return np.c_[normals, normals @ point]


def reflect(planes, points):
    """(P, N, 3) points in each plane."""
    heights = planes[:, :3] @ points.T - planes[:, 3:]
    return points[None] - 2 * heights[..., None] * planes[:, None, :3]


class Surface:
    """A mesh, centered and of unit diagonal, with points spread over it."""

    def __init__(self, mesh, tolerance, num_samples=20_000):
        self.mesh = mesh
        self.tolerance = tolerance * mesh.diameter / mesh.diagonal
        samples = bench.sample(mesh, num_samples, np.random.default_rng(1))
        self.samples = (samples - mesh.center) / mesh.diagonal
        spread = (GOLDEN * np.arange(num_samples) % 1 * num_samples).astype(int)  # any first ones are spread evenly
        self.samples = self.samples[spread]

    def share(self, planes, num_samples):
        """(P,) shares of the area that planes map to within the tolerance."""
        planes, points = np.atleast_2d(planes), self.samples[:num_samples]
        shares = [(self.mesh.distances(reflect(p[None], points)[0]) <= self.tolerance).mean() for p in planes]
        return np.array(shares)

    def least_share(self, planes, num_samples, enough):
        """Least share of the planes; stops where it falls below enough."""
        least = 1.0
        for first in range(0, len(planes), 4):
            least = min(least, self.share(planes[first : first + 4], num_samples).min())
            if least < enough:
                break
        return least

    def refine(self, planes, width, final_width, num_samples):
        """Gauss-Newton steps on the distances d of reflected points, which weigh 1 / (1 + (d / width)^2)^2."""
        planes, x = np.array(np.atleast_2d(planes), float), self.samples[:num_samples]
        widths, running = np.full(len(planes), width), np.arange(len(planes))
        for _ in range(30):
            if len(running) == 0:
                break
            n = planes[running, :3]
            u = np.cross(n, np.eye(3)[np.argmin(np.abs(n), axis=1)])
            u /= np.linalg.norm(u, axis=1, keepdims=True)
            frame = np.stack([u, np.cross(n, u)], 1)  # (P, 2, 3) directions in which n moves
            reflected = reflect(planes[running], x)
            closest, normals = self.mesh.closest(reflected)
            away = reflected - closest
            d = np.linalg.norm(away, axis=-1)
            m = np.where(d[..., None] > 1e-6, away / np.maximum(d, 1e-12)[..., None], normals)
            heights = n @ x.T - planes[running, 3:]
            m_n = np.einsum("pnk,pk->pn", m, n)
            slopes = [-2 * (frame[:, k] @ x.T * m_n + heights * np.einsum("pnk,pk->pn", m, frame[:, k])) for k in (0, 1)]
            slopes = np.stack([*slopes, 2 * m_n], -1)
            weights = (1 + (d / widths[running, None]) ** 2) ** -2.0
            h = np.einsum("pn,pni,pnj->pij", weights, slopes, slopes)
            g = np.einsum("pn,pni->pi", weights * np.einsum("pnk,pnk->pn", m, away), slopes)
            trace = np.trace(h, axis1=1, axis2=2)
            h += (1e-6 * trace + 1e-12)[:, None, None] * np.eye(3)
            step = -np.linalg.solve(h, g[..., None])[..., 0]
            length = np.linalg.norm(step, axis=1)
            step *= np.minimum(1, 0.1 / np.maximum(length, 1e-12))[:, None]
            n = n + np.einsum("pi,pik->pk", step[:, :2], frame)
            planes[running] = np.c_[n / np.linalg.norm(n, axis=1, keepdims=True), planes[running, 3] + step[:, 2]]
            small = length < widths[running]
            done = (length < 1e-5) & (widths[running] == final_width)
            widths[running] = np.where(small, np.maximum(final_width, 0.5 * widths[running]), widths[running])
            running = running[~done]
        return planes

    def climb(self, plane):
        """The plane near by that maps the most, by the downhill simplex."""
        u = np.cross(plane[:3], np.eye(3)[np.argmin(np.abs(plane[:3]))])
        u /= np.linalg.norm(u)
        v = np.cross(plane[:3], u)

        def at(step):
            n = plane[:3] + self.tolerance * (2 * step[0] * u + 2 * step[1] * v)
            return np.r_[n / np.linalg.norm(n), plane[3] + 0.5 * self.tolerance * step[2]]

        start = np.vstack([np.zeros(3), np.eye(3)])
        options = {"initial_simplex": start, "xatol": 0.1, "fatol": 5e-4, "maxfev": 80}
        found = minimize(lambda step: -self.share(at(step), 2000)[0], start[0], method="Nelder-Mead", options=options)
        return at(found.x)


def scan_all_planes(surface, num_normals=5955, num_offsets=101, reach=0.04, num_samples=256):
    """Local maxima, best first, of how close all planes map points to the mesh: mean of (1 - (d / reach)^2)^2.

    5955 normals are 2 degrees apart. Planes that cut off less than a twentieth of the points are left out.
    """
    size, half = 96, 0.6
    grid = np.zeros((size, size, size), np.float32)
    middles = lambda count: (np.stack(np.indices(3 * (count,)), -1) + 0.5) * (2 * half / count) - half
    blocks = surface.mesh.distances(middles(size // 4)) < reach + math.sqrt(3) * 2 * half / size * 2
    near = np.repeat(np.repeat(np.repeat(blocks, 4, 0), 4, 1), 4, 2)
    grid[near] = np.maximum(0, 1 - (surface.mesh.distances(middles(size)[near]) / reach) ** 2) ** 2
    grid = np.pad(grid, 1).ravel()

    def closeness(x):
        """Means over points (..., N, 3)."""
        cells = np.clip((x + np.float32(half)) * np.float32(size / (2 * half)) + 1, 0, size + 1).astype(np.int32)
        return grid[(cells[..., 0] * (size + 2) + cells[..., 1]) * (size + 2) + cells[..., 2]].mean(-1)

    normals = planes_through_point(np.zeros(3), num_normals)[:, :3].astype(np.float32)
    offsets = np.linspace(-0.5, 0.5, num_offsets, dtype=np.float32)
    x = surface.samples[:num_samples].astype(np.float32)
    heights = np.sort(normals @ x.T, axis=1)
    low, high = heights[:, num_samples // 20, None] - 0.01, heights[:, -1 - num_samples // 20, None] + 0.01
    tried = (low <= offsets) & (offsets <= high)
    values = np.full((num_normals, num_offsets), -1.0, np.float32)
    for first in range(0, num_normals, 16):
        rows = slice(first, first + 16)
        columns, n = np.flatnonzero(tried[rows].any(0)), normals[rows, None]
        on_origin = x[None, :64] - 2 * (normals[rows] @ x[:64].T)[..., None] * n
        rough = closeness(on_origin[:, None] + 2 * offsets[columns, None, None] * n[:, None])
        values[rows, columns] = np.where(tried[rows, columns], rough, -1)
    promising = np.argwhere(values >= 0.35)
    for part in np.array_split(promising, len(promising) // 4000 + 1):
        planes = np.c_[normals[part[:, 0]], offsets[part[:, 1]]]
        values[part[:, 0], part[:, 1]] = closeness(reflect(planes, x))
    values += 1e-6 * np.random.default_rng(1).uniform(size=values.shape).astype(np.float32)  # no ties
    widest = maximum_filter1d(values, 5, axis=1)  # half a diagonal times two degrees
    neighbors = cKDTree(np.vstack([normals, -normals])).query_ball_point(normals, 2 * math.sin(math.radians(1.5)))
    both = np.vstack([widest, widest[:, ::-1]])
    highest = np.stack([both[rows].max(0) for rows in neighbors])
    maxima = np.argwhere((values >= highest) & (values > 0))
    maxima = maxima[np.argsort(-values[maxima[:, 0], maxima[:, 1]])]
    return np.c_[normals[maxima[:, 0]], offsets[maxima[:, 1]]].astype(float), values[maxima[:, 0], maxima[:, 1]]


class Search:
    """Finds planes, axes and centers of one surface."""

    def __init__(self, surface):
        self.surface, self.axes, self.centers = surface, [], []
        self.planes, self.shares, self.best = np.zeros((0, 4)), np.zeros(0), 0.0

    def run(self):
        planes, closeness = scan_all_planes(self.surface)
        planes = planes[(np.arange(len(planes)) < 20) | ((closeness >= 0.5) & (np.arange(len(planes)) < 300))]
        planes = self.surface.refine(planes, 0.04, self.surface.tolerance, 400)
        planes, shares = self.merged(planes, self.surface.share(planes, 1000), SAME_ANGLE, SAME_OFFSET)
        keep = (np.arange(len(planes)) == 0) | (shares >= NEAR_SHARE - SLACK)
        planes, shares = planes[keep], shares[keep]
        self.find_axes(planes, shares)
        keep = [not self.in_family(p, s + SLACK) for p, s in zip(planes, shares)]
        self.planes, self.shares = self.merged(*self.refined(planes[keep]), MERGE_ANGLE, MERGE_OFFSET)
        self.close()
        self.best = max([0.0, *self.shares, *(a[2] for a in self.axes), *(c[1] for c in self.centers)])
        self.find_axes(self.planes, self.shares)
        keep = [not self.in_family(p, s) for p, s in zip(self.planes, self.shares)]
        self.planes, self.shares = self.planes[keep], self.shares[keep]

    def refined(self, planes):
        """The same planes on more samples, each moved to the greatest share near by, and their shares."""
        if len(planes) == 0:
            return planes, np.zeros(0)
        planes = self.surface.refine(planes, 0.01, 0.1 * self.surface.tolerance, 4000)
        shares = self.surface.share(planes, len(self.surface.samples))
        for i in np.flatnonzero(shares < 0.995):
            higher = self.surface.climb(planes[i])
            share = self.surface.share(higher, len(self.surface.samples))[0]
            if share > shares[i] + 0.002:
                planes[i], shares[i] = higher, share
        return planes, shares

    @staticmethod
    def merged(planes, shares, angle, offset):
        """Those that are not close to a better one, best first."""
        kept = []
        for i in np.argsort(-shares, kind="stable"):
            if not kept or not Search.holds(planes[kept], planes[i], angle, offset):
                kept.append(i)
        return planes[kept], shares[kept]

    def close(self):
        """Adds the reflections of symmetries in each other, until there are no new ones."""
        changed = True
        while changed and len(self.planes) < 64:
            changed, images = False, []
            whole = self.planes[self.shares >= MIN_SHARE]
            for a in whole:
                for b in whole:
                    n = b[:3] - 2 * (a[:3] @ b[:3]) * a[:3]
                    image = np.r_[n, n @ reflect(a[None], (b[3] * b[:3])[None])[0, 0]]
                    if not self.known(image, 1.0) and not (images and self.holds(images, image, SAME_ANGLE, SAME_OFFSET)):
                        images.append(image)
            for plane, share in zip(*self.refined(np.array(images[:64]))):
                if share >= NEAR_SHARE and not self.known(plane, share):
                    self.planes, self.shares, changed = np.vstack([self.planes, plane]), np.r_[self.shares, share], True
            order = np.argsort(-self.shares, kind="stable")
            self.planes, self.shares = self.planes[order], self.shares[order]

    @staticmethod
    def holds(planes, plane, angle, offset):
        angles, offsets = offsets_and_angles(planes, plane)
        return bool(((angles <= angle) & (offsets <= offset)).any())

    def known(self, plane, share):
        return self.holds(self.planes, plane, MERGE_ANGLE, MERGE_OFFSET) or self.in_family(plane, share)

    def in_family(self, plane, share):
        """Whether an axis or a center counts the plane. A near axis leaves out what is better than near: a cup is
        nearly round, and has one plane through its handle."""
        for point, direction, axis_share in self.axes:
            angle, offset = line_from_plane(plane, point, direction)
            if (axis_share >= MIN_SHARE or share < MIN_SHARE) and angle <= MERGE_ANGLE and offset <= MERGE_OFFSET:
                return True
        return any(abs(plane[:3] @ point - plane[3]) <= MERGE_OFFSET for point, _ in self.centers)

    def find_axes(self, planes, shares):
        """Axes are looked for where two planes meet."""
        tested = []
        for i in range(min(len(planes), 24)):
            for j in range(i):
                a, b = planes[i], planes[j]
                direction = np.cross(a[:3], b[:3])
                if np.linalg.norm(direction) < math.sin(math.radians(10)) or self.centers:
                    continue
                if self.in_family(a, shares[i]) or self.in_family(b, shares[j]):
                    continue
                direction /= np.linalg.norm(direction)
                line = np.linalg.solve(np.stack([a[:3], b[:3], direction]), [a[3], b[3], 0]), direction
                near = lambda other: np.less(line_from_line(*other[:2], *line), (math.radians(2), 0.01)).all()
                if any(map(near, tested)) or any(map(near, self.axes)):
                    continue
                tested.append(line)
                axis = self.test_axis(*line)
                if axis:
                    self.axes.append(axis)
                    self.find_center()

    def test_axis(self, point, direction):
        """(point, direction, least share) of the axis near the line if all planes through it are at least near."""
        least = NEAR_SHARE - SLACK
        if self.surface.least_share(planes_through_line(point, direction, 24), 1000, least) < least:
            return None
        planes = self.surface.refine(planes_through_line(point, direction, 8), 0.01, self.surface.tolerance, 1000)
        direction = np.linalg.eigh(planes[:, :3].T @ planes[:, :3])[1][:, 0]
        rows, values = np.vstack([planes[:, :3], direction]), np.r_[planes[:, 3], direction @ point]
        point = np.linalg.lstsq(rows, values, rcond=None)[0]
        share = self.surface.least_share(planes_through_line(point, direction, 24), 5000, NEAR_SHARE)
        return (point, direction, share) if share >= NEAR_SHARE else None

    def find_center(self):
        """Three axes that do not lie in a plane make a sphere."""
        if len(self.axes) < 3 or abs(np.linalg.det([axis[1] for axis in self.axes[-3:]])) < 0.2:
            return
        across = [np.eye(3) - np.outer(d, d) for _, d, _ in self.axes[-3:]]
        point = np.linalg.solve(sum(across), sum(p @ axis[0] for p, axis in zip(across, self.axes[-3:])))
        share = self.surface.least_share(planes_through_point(point, 24), 5000, MIN_SHARE)
        if share >= MIN_SHARE:
            self.axes, self.centers = [], [(point, share)]


def find_references(mesh):
    """The symmetries of a mesh, in its frame and units, as a dictionary that JSON can hold."""
    search = Search(Surface(mesh, TOLERANCE))
    search.run()
    at = lambda point: [float(v) for v in mesh.center + mesh.diagonal * np.asarray(point)]
    unit = lambda v: [float(x) for x in v]
    planes = [{"coefficients": unit(np.r_[p[:3], -(mesh.diagonal * p[3] + p[:3] @ mesh.center)]), "share": float(s)}
              for p, s in zip(search.planes, search.shares)]  # fmt: skip
    axes = [{"point": at(p), "direction": unit(d), "share": float(s)} for p, d, s in search.axes]
    centers = [{"point": at(p), "share": float(s)} for p, s in search.centers]
    whole, near = (lambda x: x["share"] >= MIN_SHARE), (lambda x: NEAR_SHARE <= x["share"] < MIN_SHARE)
    best = max([search.best, *(x["share"] for x in planes + axes + centers)])
    found = any(map(whole, planes + axes + centers))
    return {"kind": "symmetric" if found else "nearly symmetric" if best >= NEAR_SHARE else "asymmetric",
            "best_share": float(best), "center": unit(mesh.center), "diagonal": mesh.diagonal,
            "diameter": mesh.diameter, "tolerance": TOLERANCE * mesh.diameter,
            "planes": list(filter(whole, planes)), "axes": list(filter(whole, axes)), "centers": centers,
            "near_planes": list(filter(near, planes)), "near_axes": list(filter(near, axes))}  # fmt: skip


def moved(references, pose, factor=1.0):
    """The same symmetries of the mesh after it was enlarged about the origin, and moved."""
    point = lambda p: [float(v) for v in bench.moved(pose, factor * np.asarray(p))]
    vector = lambda v: [float(x) for x in pose[:3, :3] @ np.asarray(v)]

    def plane(row):
        n = np.asarray(vector(row["coefficients"][:3]))
        return {**row, "coefficients": [*map(float, n), float(factor * row["coefficients"][3] - n @ pose[:3, 3])]}

    axis = lambda row: {**row, "point": point(row["point"]), "direction": vector(row["direction"])}
    center = lambda row: {**row, "point": point(row["point"])}
    change = {"planes": plane, "near_planes": plane, "axes": axis, "near_axes": axis, "centers": center}
    lists = {name: [function(row) for row in references[name]] for name, function in change.items()}
    sizes = {name: factor * references[name] for name in ("diagonal", "diameter", "tolerance")}
    return {**references, **lists, **sizes, "center": point(references["center"])}
