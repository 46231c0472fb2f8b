"""Pictures of the pages that no tool draws: frames, centers of scans, a medial axis, and where algorithms go wrong.

usage: python3 apps/gallery/drawings.py PICTURE OUT.png [FILE ...]

  first_look MESH      a scan, its plane of symmetry, and the completed scan (the page that is read first)
  scene MESH MESH MESH a scan of three things on a table, as pcl_symmetry_scene draws it
  decision FRAME N …   objects of a frame of a depth camera, by number: the evidence for their best planes, and the confidence
  refinement MESH      Iterative Symmetric Points, from a plane that is off (Figure 7)
  animals MESH …       shapes with their frames (Figure 10)
  frames               mugs and mailboxes with their axes, by center of mass and PCA, and by symmetry (Figure 10)
  scan_centers MESH    eight scans of a mesh, and the centers found in each, by symmetry and by mass (Figure 11)
  turntable SCAN …     scans of one object as their files are, and brought together
  medial_axis SHAPE …  the medial axes of planar shapes, as planar.py takes them (the other half of Figure 3)
  volume               a head made of ellipsoids, tilted, with a lesion on one side: its plane and its asymmetry
  failure_frame MESH, failure_completion MESH, failure_pose, failure_name, failure_rotations, failure_volume
                       answers that the data do not tell, or that the tolerance passes over

Needs python3-matplotlib, python3-open3d, pcl_symmetry_scan, _planes and _scene on PATH, and the module (PYTHONPATH=build/src/python).
"""

import subprocess
import sys
import tempfile
import textwrap
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import pcl_symmetry
from planar import contour
from shapes import Patches, mug, write_ply

GRAY, ORANGE, BLUE, GREEN, VERMILION = "#B9C0CB", "#E69F00", "#0072B2", "#009E73", "#D55E00"
AWAY_FROM_HANDLE = (-1, 0, 0.3)  # a little from above, as a camera looks at a table
NUM_POINTS = 10000


def scan(mesh, direction, organized=False):
    """A scan by the tool from a direction: points (N, 3), or its pixels (H, W, 3), and the viewpoint (3,)."""
    with tempfile.TemporaryDirectory() as folder:
        if not isinstance(mesh, (str, Path)):
            write_ply(f"{folder}/mesh.ply", *mesh)
            mesh = f"{folder}/mesh.ply"
        out = f"{folder}/scan.pcd"
        view = ",".join(map(str, direction))
        subprocess.run(["pcl_symmetry_scan", mesh, out, f"-direction={view}", "-quiet"], check=True)
        seen = pcl_symmetry.read(out)
    return seen.points if organized else seen.points[np.isfinite(seen.points).all(axis=2)], seen.viewpoint


def load_mesh(path):
    mesh = pcl_symmetry.read(path)
    return mesh.points.astype(np.float32), mesh.faces


def sampled(mesh):
    return pcl_symmetry.sample_mesh(*mesh, NUM_POINTS)


class Sheet:
    """Panels of 3D scatter plots side by side."""

    def __init__(self, rows, columns, view, up="z", size=3.6):
        self.figure = plt.figure(figsize=(size * columns, size * rows), dpi=100, layout="constrained")
        self.rows, self.columns, self.up, self.num = rows, columns, up, 0
        self.elevation = np.degrees(np.arctan2(view[2], np.hypot(view[0], view[1])))
        self.azimuth = np.degrees(np.arctan2(view[1], view[0]))

    def panel(self, title, around):
        self.num += 1
        axes = self.figure.add_subplot(self.rows, self.columns, self.num, projection="3d")
        around = self.upright(around)
        low, high = around.min(axis=0), around.max(axis=0)
        middle, half = (low + high) / 2, 0.5 * (high - low).max()
        axes.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half))
        axes.set_zlim(middle[2] - half, middle[2] + half)
        axes.view_init(self.elevation, self.azimuth)
        axes.set_axis_off()
        axes.set_title(title, fontsize=9)
        return axes

    def upright(self, points):
        points = np.asarray(points)
        return points[..., [2, 0, 1]] if self.up == "y" else points

    def dots(self, axes, points, color, size=1.0):
        axes.scatter(*self.upright(points).T, s=size, c=color, linewidths=0, depthshade=False)

    def cross(self, axes, center, directions, half_length, colors):
        for direction, color in zip(np.asarray(directions).T, colors):
            ends = self.upright(center + half_length * np.array([[-1], [1]]) * direction)
            axes.plot(*ends.T, color=color, linewidth=2)

    def save(self, path, zoom=1.0, says=""):
        for axes in self.figure.axes:
            axes.set_box_aspect((1, 1, 1), zoom=zoom)
        self.figure.savefig(path, metadata={"Description": says})
        print(path)


def mailbox(stands):
    """A box with a round roof on stands: (low corner, size)."""
    length, half_width, wall = 3.0, 0.8, 0.9

    def outline(u):  # once around: floor, wall, roof, wall
        if u < 0.25:
            return half_width * (1 - 8 * u), 0.0
        if u < 0.4:
            return -half_width, wall * (u - 0.25) / 0.15
        if u > 0.85:
            return half_width, wall * (1 - u) / 0.15
        angle = np.pi * (1 - (u - 0.4) / 0.45)
        return half_width * np.cos(angle), wall + half_width * np.sin(angle)

    def at(u, shrink, y):
        x, z = outline(u)
        return shrink * x, y, 0.5 * wall + shrink * (z - 0.5 * wall)

    mesh = Patches()
    mesh.add(80, 1, lambda u, v: at(u, 1, length * (v - 0.5)))
    for end in (-0.5, 0.5):
        mesh.add(80, 1, lambda u, v: at(u, v, length * end))
    for stand in stands:
        mesh.add_box(*stand)
    return mesh.mesh()


def mugs_and_mailboxes():
    pole, back = ((-0.12, -0.12, -1.6), (0.24, 0.24, 1.6)), ((-0.12, 0.9, -2.6), (0.24, 0.24, 2.6))
    front = [((-0.12, -1.2, -2.0), (0.24, 0.24, 2.0)), ((-0.7, -1.8, -2.1), (1.4, 1.4, 0.1))]
    return [mug(0.5, 0.6), mug(0.9, 0.9), mug(1.5, 1.0), mailbox([pole]), mailbox([back]), mailbox(front)]


def frames(out):
    clouds = [sampled(shape) for shape in mugs_and_mailboxes()]
    sheet = Sheet(2, len(clouds), (0.9, -1.6, 0.7), size=2.6)
    colors = (VERMILION, GREEN, BLUE)
    for k, cloud in enumerate(clouds):
        axes = sheet.panel("" if k else "mass, PCA", cloud)
        sheet.dots(axes, cloud, GRAY, 0.5)
        length = 0.5 * np.linalg.norm(np.ptp(cloud, axis=0))
        sheet.cross(axes, cloud.mean(axis=0), np.linalg.svd(cloud - cloud.mean(axis=0), full_matrices=False)[2].T, length, colors)
    for k, cloud in enumerate(clouds):
        frame = pcl_symmetry.frame(cloud)
        axes = sheet.panel("" if k else "symmetry", cloud)
        sheet.dots(axes, cloud, GRAY, 0.5)
        sheet.cross(axes, frame.center, frame.axes, 0.5 * np.linalg.norm(np.ptp(cloud, axis=0)), colors)
        print(f"distance of the two centers {np.linalg.norm(frame.center - cloud.mean(axis=0)):.3f}")
    sheet.save(out)


def animals(out, *paths):
    sheet = Sheet(1, len(paths), (1.6, 0.9, 0.5), up="y")
    for path in paths:
        points = sampled(load_mesh(path))
        frame = pcl_symmetry.frame(points)
        axes = sheet.panel(Path(path).stem, points)
        sheet.dots(axes, points, GRAY, 0.5)
        sheet.cross(axes, frame.center, frame.axes, 0.5 * np.linalg.norm(np.ptp(points, axis=0)), (VERMILION, GREEN, BLUE))
    sheet.save(out)


def refinement(out, path):
    """From a plane 12 degrees and a shift off back to rest: samples, their reflections, and the closest points (Section 4.4)."""
    from scipy.spatial import cKDTree

    points = sampled(load_mesh(path)).astype(float)
    best = pcl_symmetry.planes(points)[0]
    size = np.linalg.norm(np.ptp(points, axis=0))
    tree, samples = cKDTree(points), points[::80]
    normal = best.normal + np.tan(np.radians(12)) * np.cross(best.normal, [0.0, 0.0, 1.0])
    plane = pcl_symmetry.ReflectionPlane(normal / np.linalg.norm(normal), best.offset + 0.02 * size)
    sheet = Sheet(1, 4, (0.5, 1.6, 0.4), up="y", size=3.0)
    for step in range(1, 31):
        reflected = plane.reflect(samples)
        distances, indices = tree.query(reflected)
        if step in (1, 2, 4, 30):
            axes = sheet.panel(f"step {step}: {100 * np.sqrt((distances**2).mean()) / size:.1f} % apart", points)
            sheet.dots(axes, points[::4], GRAY, 0.3)
            for dots, color in ((samples, BLUE), (reflected, VERMILION), (points[indices], GREEN)):
                sheet.dots(axes, dots, color, 6)
        # The plane that maps the samples best to the points that are closest to their reflections.
        closest, weights = points[indices], np.exp(-((distances / (0.06 * size)) ** 2))
        middle = np.average((samples + closest) / 2, axis=0, weights=weights)
        x, y = samples - middle, closest - middle
        products = np.einsum("n,ni,nj->ij", weights, x, y)
        plane = pcl_symmetry.ReflectionPlane(normal := np.linalg.eigh(products + products.T)[1][:, 0], normal @ middle)
    for axes in sheet.figure.axes:
        axes.set_box_aspect((1, 1, 1), zoom=1.5)
    sheet.save(out)


def scan_centers(out, path):
    whole = sampled(load_mesh(path))
    sheet = Sheet(2, 5, (0.6, 1, 0.5), size=2.2)
    found = []
    corners = [[1 if k >> bit & 1 else -1 for bit in range(3)] for k in range(8)]
    for k, corner in enumerate(corners):
        points, viewpoint = scan(path, corner)
        found.append((pcl_symmetry.frame(points, viewpoint=viewpoint).center, points.mean(axis=0)))
        print("center of symmetry {:7.3f} {:7.3f} {:7.3f}".format(*found[-1][0]),
              "  center of mass {:7.3f} {:7.3f} {:7.3f}".format(*found[-1][1]))
        sheet.dots(sheet.panel(f"scan {k + 1}", whole), points, "#6B7A99", 0.5)
    for title, which, color in (("centers of symmetry", 0, VERMILION), ("centers of mass", 1, GREEN)):
        axes = sheet.panel(title, whole)
        sheet.dots(axes, whole, GRAY, 0.1)
        for centers in found:
            sheet.cross(axes, centers[which], np.eye(3), 0.04 * np.linalg.norm(np.ptp(whole, axis=0)), [color] * 3)
    sheet.save(out, zoom=1.7)


def turntable(out, *paths):
    import open3d

    scans = [np.asarray(open3d.io.read_point_cloud(path).points)[::10] for path in paths]
    merged = pcl_symmetry.register_all(scans)
    posed = [scan @ T[:3, :3].T + T[:3, 3] for scan, T in zip(scans, merged.transforms) if T is not None]
    colors = [f"C{k % 10}" for k in range(len(scans))]
    sheet = Sheet(1, 3, (1, 1, 0.35), up="y")
    whole = np.concatenate(posed)
    for title, clouds, view in (("scans as they are", scans, (0.5, 1.0)), ("brought together", posed, (0.5, 1.0)), ("from behind", posed, (-0.5, -1.0))):
        axes = sheet.panel(title, whole if clouds is posed else np.concatenate(clouds))
        axes.view_init(sheet.elevation, np.degrees(np.arctan2(*view)))
        for cloud, color in zip(clouds, colors):
            sheet.dots(axes, cloud, color, 0.6)
    sheet.save(out)


def medial_axis(out, *shapes):
    """Where the closest contour points of neighboring pixels lie in different directions."""
    from scipy.ndimage import label
    from scipy.spatial import cKDTree

    size, figure = 220, plt.figure(figsize=(2.2 * len(shapes), 2.2), dpi=100)
    for k, shape in enumerate(shapes):
        points = contour(shape)
        low, high = points.min(axis=0), points.max(axis=0)
        edge = 1.12 * (high - low).max()
        low = (low + high - edge) / 2
        step = edge / size
        x, y = np.meshgrid(*(low[:, None] + step * (np.arange(size) + 0.5)))
        distance, index = cKDTree(points).query(np.stack([x, y], -1))
        offset = points[index] - np.stack([x, y], -1)
        labels, _ = label(distance >= step)
        inside = (labels != labels[0, 0]) & (distance > step)
        axis = np.zeros_like(inside)
        for shift in ((0, 1), (1, 0)):
            other, point = np.roll(offset, (-shift[0], -shift[1]), (0, 1)), np.roll(points[index], (-shift[0], -shift[1]), (0, 1))
            apart = np.linalg.norm(points[index] - point, axis=-1) > 2 * step
            cosine = (offset * other).sum(-1) / np.maximum(np.linalg.norm(offset, axis=-1) * np.linalg.norm(other, axis=-1), 1e-12)
            axis |= inside & apart & (cosine < np.cos(np.radians(8)))
        axes = figure.add_axes((k / len(shapes), 0, 1 / len(shapes), 1))
        axes.plot(x[axis], y[axis], "k.", markersize=1.5)
        axes.plot(*points.T, ".", color=VERMILION, markersize=1.5)
        axes.set(xlim=(low[0], low[0] + edge), ylim=(low[1], low[1] + edge), aspect="equal")
        axes.set_axis_off()
    figure.savefig(out)
    print(out)


def failure_frame(out, path):
    """A hand is not symmetric: its whole and a scan of it have frames of their own."""
    whole = sampled(load_mesh(path))
    points, viewpoint = scan(path, (1, 1, 1))
    first, second = pcl_symmetry.frame(whole), pcl_symmetry.frame(points, viewpoint=viewpoint)
    cosine = np.abs((first.axes.T @ second.axes).diagonal()).min()
    sheet = Sheet(1, 2, (1, 1, 0.6), up="y")
    titles = ("frame of the whole hand", f"of a scan of it, {np.degrees(np.arccos(min(1, cosine))):.0f} degrees off")
    for title, cloud, frame in zip(titles, (whole, points), (first, second)):
        axes = sheet.panel(title, whole)
        sheet.dots(axes, cloud, GRAY)
        sheet.cross(axes, frame.center, frame.axes, 0.5 * np.linalg.norm(np.ptp(whole, axis=0)), (VERMILION, GREEN, BLUE))
    sheet.save(out)


def first_look(out, path):
    """A scan from one side, the plane that is found in it, and what its reflection adds."""
    pixels, _ = scan(path, (1, 1, 1), organized=True)
    whole, found = sampled(load_mesh(path)), pcl_symmetry.planes(pixels)
    added, _ = pcl_symmetry.complete(pixels, found[0])
    points = pixels[np.isfinite(pixels).all(axis=2)]
    sheet = Sheet(1, 3, (-0.75, 1.15, 0.4), up="y", size=3.4)
    sheet.figure.set_size_inches(10.2, 3.0)
    sheet.dots(sheet.panel("a scan from one side", whole), points, "#6B7A99")
    title = f"its plane of symmetry, confidence {found[0].confidence:.2f}"
    axes = sheet.panel(title, whole)
    sheet.dots(axes, points, "#6B7A99")
    reach = np.ptp(whole, axis=0).max() * 0.46
    along = np.cross(found[0].normal, [0, 1, 0])
    up = np.cross(along, found[0].normal)
    middle = whole.mean(axis=0) - found[0].distance(whole.mean(axis=0)) * found[0].normal
    corners = [middle + reach * (a * along / np.linalg.norm(along) + 0.66 * b * up / np.linalg.norm(up)) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    axes.plot_trisurf(*sheet.upright(np.array(corners)).T, triangles=[(0, 1, 2), (0, 2, 3)], color=ORANGE, alpha=0.3)
    axes = sheet.panel("completed by its reflection (blue)", whole)
    sheet.dots(axes, points, "#6B7A99")
    sheet.dots(axes, added, BLUE)
    sheet.save(out, zoom=1.6, says=title)


def scene(out, *paths):
    """A scan of three things on a table, as pcl_symmetry_scene draws it."""
    corners = np.array([(x, y, z) for z in (-0.1, 0) for y in (-2.6, 2.6) for x in (-3.6, 3.6)])
    quads = [(0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5), (0, 2, 3, 1), (4, 5, 7, 6)]
    vertices, triangles = [corners], [[t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]]
    for path, (x, y, angle) in zip(paths, ((-1.7, -0.3, -0.3), (0.5, 0.9, 0), (1.9, -0.8, 2.2))):
        points, faces = load_mesh(path)
        turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        triangles.append(faces + sum(map(len, vertices)))
        vertices.append(points @ turn.T + (x, y, -points[:, 2].min()))
    with tempfile.TemporaryDirectory() as folder:
        write_ply(f"{folder}/table.ply", np.concatenate(vertices), np.concatenate(triangles))
        flags = "-direction=-0.2,-1,0.75 -points 60000 -noise 0.0003 -quiet".split()
        subprocess.run(["pcl_symmetry_scan", f"{folder}/table.ply", f"{folder}/table.pcd", *flags], check=True)
        subprocess.run(["pcl_symmetry_scene", f"{folder}/table.pcd", "-png", out, "-quiet"], check=True, stdout=subprocess.DEVNULL)


def decision(out, path, *numbers):
    """Objects of a frame: where their points are reflected to, the share of the surface that maps, and the odds that follow."""
    pixels = pcl_symmetry.read(path).points
    objects = pcl_symmetry.scene(pixels, max_range=1.2).objects
    rows = np.flatnonzero(np.isfinite(pixels).all(axis=2))
    points = pixels.reshape(-1, 3)
    row, column = np.divmod(rows, pixels.shape[1])
    focal = [np.polyfit(points[rows, k] / points[rows, 2], at, 1) for k, at in enumerate((column, row))]  # of a pinhole camera
    figure, axes = plt.subplots(len(numbers), 3, figsize=(11, 3 * len(numbers)), dpi=100, layout="constrained", width_ratios=(1, 1, 1.5))
    for line, number in zip(axes, map(int, numbers)):
        cloud = points[objects[number - 1].rows].astype(float)
        planes = objects[number - 1].planes
        plane = planes.every[0] if planes.every else planes.best
        # Where each reflection lands: on the surface, in space that the camera saw through, or where it could not see.
        images = plane.reflect(cloud)
        on = plane.pairs(cloud, max_distance=1.5 * planes.tolerance)[0] >= 0
        u, v = (np.polyval(f, images[:, k] / images[:, 2]).round().astype(int) for k, f in enumerate(focal))
        inside = (u >= 0) & (u < pixels.shape[1]) & (v >= 0) & (v < pixels.shape[0])
        depth = pixels[v.clip(0, pixels.shape[0] - 1), u.clip(0, pixels.shape[1] - 1), 2]
        empty = ~on & inside & (images[:, 2] < depth - 1.5 * planes.tolerance)
        hidden = ~on & ~empty
        for chosen, color in ((hidden, GRAY), (on, BLUE), (empty, VERMILION)):
            line[0].scatter(cloud[chosen, 0], -cloud[chosen, 1], s=1, c=color, linewidths=0)
        line[0].set(aspect="equal", xticks=[], yticks=[])
        line[0].set_frame_on(False)
        shares = [on.mean(), empty.mean(), hidden.mean()]
        names = ["on the surface", "into space seen to be empty", "where the camera could not see"]
        for k, (share, name, color) in enumerate(zip(shares, names, (BLUE, VERMILION, GRAY))):
            line[1].barh(2.8 - k, share, height=0.4, color=color)
            line[1].text(0.0, 3.04 - k, f"{name}: {share:.0%}", fontsize=9, va="bottom")
        line[1].text(0.0, 0.0, f"share that maps: {plane.share:.0%} (a symmetry: 97%)", fontsize=9, weight="bold")
        line[1].set(xlim=(0, 1), ylim=(-0.2, 3.4), xticks=[], yticks=[])
        line[1].set_frame_on(False)
        # From the odds of the evidence by each factor to those of the confidence.
        odds, height = 1.0, len(plane.reasons)
        for k, (reason, factor) in enumerate(plane.reasons):
            before, odds = odds, odds * factor
            at = height - k
            ends = [o / (1 + o) for o in (before, odds)]
            line[2].annotate("", (ends[1], at), (ends[0], at), arrowprops=dict(arrowstyle="-|>", color="#444444", lw=1.6))
            text = textwrap.fill(f"odds x {factor:.2g}: {reason}", 48)
            line[2].text(0.5, at + 0.18, text, fontsize=8, ha="center", va="bottom")
        for low, high, name, color in ((0, 0.2, "no symmetry", "#EEEEEE"), (0.2, 0.5, "possible", "#FBE9C6"), (0.5, 1, "symmetry", "#CDE8DC")):
            line[2].axvspan(low, high, color=color, zorder=0)
            line[2].text((low + high) / 2, 0.08, name, ha="center", fontsize=8, color="#444444")
        line[2].plot(plane.confidence, 0.6, "o", color="black")
        line[2].text(plane.confidence, 0.7, f"{plane.confidence:.2f}", ha="center", va="bottom", fontsize=10, weight="bold")
        line[2].set(xlim=(0, 1), ylim=(0, height + 0.7), yticks=[], xticks=[0, 0.2, 0.5, 1])
    for title, each in zip(("1. reflect each point", "2. count where the reflections land", "3. odds, from even ones, and confidence"), axes[0]):
        each.set_title(title, fontsize=11, loc="left")
    figure.savefig(out)
    print(out)


def failure_completion(out, path):
    """The other half of a hand is not that of its best plane."""
    whole = sampled(load_mesh(path))
    points, viewpoint = scan(path, (1, 1, 1))
    found = pcl_symmetry.planes(points, viewpoint=viewpoint)
    best = found[0] if found else found.best
    added, _ = pcl_symmetry.complete(points, pcl_symmetry.ReflectionPlane(best.normal, best.offset), viewpoint=viewpoint)
    sheet = Sheet(1, 2, (-1.0, -1.4, 0.4), up="y")
    sheet.dots(sheet.panel("the hand", whole), whole, GRAY)
    axes = sheet.panel("measured (orange), added (blue)", whole)
    sheet.dots(axes, points, ORANGE)
    sheet.dots(axes, added, BLUE)
    sheet.save(out)


def failure_pose(out):
    """A mug whose handle the scanner does not see fits at any angle at which the handle is hidden."""
    model = sampled(mug())
    points, viewpoint = scan(mug(), AWAY_FROM_HANDLE)
    found = pcl_symmetry.register(points, model, source_viewpoint=viewpoint)
    rotation = np.asarray(found.transform)[:3, :3]
    angle = np.degrees(np.arccos(np.clip((np.trace(rotation) - 1) / 2, -1, 1)))
    sheet = Sheet(1, 2, (-0.6, -1.0, 1.3))
    aligned = points @ rotation.T + np.asarray(found.transform)[:3, 3]
    for title, cloud in (("true pose", points), (f"pose found, {angle:.0f} degrees off, merit {found.score.merit:.2f}", aligned)):
        axes = sheet.panel(title, model)
        sheet.dots(axes, model, GRAY)
        sheet.dots(axes, cloud, ORANGE)
    sheet.save(out)


def failure_name(out):
    """Seen from the side without a handle, a mug is a cup."""
    sheet = Sheet(1, 2, (-1, 0.7, 0.8))
    with tempfile.TemporaryDirectory() as folder:
        database = pcl_symmetry.Database(f"{folder}/models.db", create=True)
        database.add("mug", sampled(mug()))
        database.add("cup", sampled(mug(0.01, 0.01)))
        for direction in ((0.5, 1, 0.6), (-1, 0.7, 0.3)):
            points, viewpoint = scan(mug(), direction)
            names = [f"{m.name} {m.confidence:.2f}" for m in database.recognize(points, viewpoint=viewpoint)]
            sheet.azimuth = np.degrees(np.arctan2(direction[1], direction[0]))
            axes = sheet.panel("scan of the mug: " + (", ".join(names) or "no name"), points)
            sheet.dots(axes, points, BLUE)
    sheet.save(out)


def failure_rotations(out):
    """What is smaller than max_feature is passed over."""
    sheet = Sheet(1, 2, (0.9, -1.6, 0.7))
    for handle in (0.25, 0.9):
        cloud = sampled(mug(handle, handle))
        found = pcl_symmetry.rotations(cloud)
        axes = sheet.panel(f"group {found.name}, confidence {found.confidence:.2f}", cloud)
        sheet.dots(axes, cloud, BLUE)
    sheet.save(out)


def head(out, gain_per_mm):
    """Planes of a volume of 1 mm voxels, drawn by the tool. The lesion is to one side; the head leans by 12 degrees.

    gain_per_mm: by what share the intensity grows to one side, as near a coil of an MR scanner.
    """
    size = np.array([180, 200, 180])
    x = np.indices(size).reshape(3, -1).T + 0.5 - size / 2
    gain = np.exp(gain_per_mm * x[:, 0])
    c, s = np.cos(np.radians(12)), np.sin(np.radians(12))
    x = x @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) + (4, 0, 0)
    side = np.abs(x[:, 0])
    values = np.zeros(len(x))
    for center, half_axes, value in (((0, 0, 0), (68, 84, 80), 400), ((0, 60, -45), (30, 34, 30), 400),
                                     ((0, 0, 0), (62, 78, 74), 900), ((14, -14, 0), (7, 30, 12), 300),
                                     ((24, 62, -8), (12, 18, 12), 600), ((0, 64, -48), (22, 26, 22), 600),
                                     ((30, -50, -40), (26, 22, 16), 700)):
        values[(((np.column_stack([side, x[:, 1:]]) - center) / half_axes) ** 2).sum(1) < 1] = value
    values[np.linalg.norm(x - (-40, 15, 0), axis=1) < 13] = 1300
    values = gain * values + np.random.default_rng(1).normal(0, 25, len(values))
    header = ("ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
              f"DimSize = {size[0]} {size[1]} {size[2]}\nElementSpacing = 1 1 1\n"
              "ElementType = MET_FLOAT\nElementDataFile = LOCAL\n")
    with tempfile.TemporaryDirectory() as folder:
        image = values.reshape(size).astype("<f4").tobytes(order="F")
        Path(folder, "head.mha").write_bytes(header.encode() + image)
        subprocess.run(["pcl_symmetry_planes", f"{folder}/head.mha", "-png", out], check=True)


def volume(out):
    head(out, 0)


def failure_volume(out):
    """An intensity that grows to one side moves the plane, and fills the picture of the asymmetry."""
    head(out, 0.006)


if __name__ == "__main__":
    pictures = {f.__name__: f for f in (first_look, scene, decision, refinement, animals, frames, scan_centers, turntable, medial_axis, volume, failure_frame, failure_completion,
                                        failure_pose, failure_name, failure_rotations, failure_volume)}
    if len(sys.argv) < 3 or sys.argv[1] not in pictures:
        print(__doc__)
        sys.exit(0 if "-h" in sys.argv or "--help" in sys.argv else 2)
    pictures[sys.argv[1]](*sys.argv[2:])
