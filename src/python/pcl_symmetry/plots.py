"""Pictures of results, made with matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib.pyplot as plt
import numpy as np

from .pages import corners_of, counted, diagonal, label_of, rows_of_planes, rows_of_shown, support_colors, view_of

if TYPE_CHECKING:
    from .results import Frame, Map, Planes, Profile, Scene

# Colors that remain apart for color-blind eyes (Okabe and Ito), as in the pictures of the tools.
COLORS = ["#E69F00", "#0072B2", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#F0E442", "#595959"]


def _axes_for(points: Any, axes: Any, title: str, colors: Any = "#4D6185", view: Any = (), around: Any = None) -> Any:
    """Axes of projection 3d with the points in them, all directions to one scale.

    view: direction to the camera, and what is up; empty: that of matplotlib. around: points that fill the picture; None: all.
    """
    if axes is None:
        axes = plt.figure(figsize=(6, 6), dpi=100).add_subplot(projection="3d")
    if not np.isfinite(points).all(axis=1).any():
        points, colors, around = np.zeros((1, 3)), "#4D6185", None
    around = points if around is None else around
    low, high = np.nanmin(around, axis=0), np.nanmax(around, axis=0)
    middle, half = (low + high) / 2, (high - low).max() / 2 or 1.0
    axes.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half), title=title)
    axes.set_zlim(middle[2] - half, middle[2] + half)
    axes.set_box_aspect((1, 1, 1))
    if view:
        _look(axes, *view)
    axes.set_axis_off()
    axes.scatter(*points.T, s=1, c=colors)
    return axes


def _look(axes: Any, to_camera: Any, up: Any) -> None:
    elevation = np.clip(np.arcsin(to_camera[2] / np.linalg.norm(to_camera)), -1.57, 1.57)  # 1.5708 would leave z no direction
    azimuth = np.arctan2(to_camera[1], to_camera[0])
    level = np.array([np.cos(azimuth), np.sin(azimuth), 0])
    to_camera = np.cos(elevation) * level + np.sin(elevation) * np.eye(3)[2]
    above = np.cos(elevation) * np.eye(3)[2] - np.sin(elevation) * level  # what is up without roll
    roll = np.arctan2(up @ np.cross(to_camera, above), up @ above)
    axes.view_init(*np.degrees([elevation, azimuth, -roll]))


def plot_planes(found: Planes, points: Any, axes: Any) -> Any:
    points = rows_of_planes(found, points)
    colors: Any = "#4D6185"
    if found.planes and found._support:  # as the pictures of the tools: the support for the best plane
        colors = support_colors(found.point_support(0).reshape(-1)) / 255
    counts = ((len(found), "plane"), (len(found.axes), "axis"))
    title = ", ".join(counted(number, what) for number, what in counts if number) or "no symmetry"
    axes = _axes_for(points, axes, title, colors, view_of(found, points[np.isfinite(points).all(axis=1)]))
    _draw(axes, found, points, COLORS)
    return axes


def _draw(axes: Any, found: Planes, points: Any, colors: Any) -> None:
    """The planes and axes of points."""
    for plane, color in zip(found, colors):
        axes.plot_trisurf(*corners_of(plane, points).T, triangles=[(0, 1, 2), (0, 2, 3)], color=color, alpha=0.25)
    for axis in found.axes:
        reach = np.array([[-1], [1]]) * diagonal(points) * 0.6
        axes.plot(*(axis.point + reach * axis.direction).T, color=COLORS[4], linewidth=3, zorder=10)


def plot_scene(found: Scene, points: Any, axes: Any) -> Any:
    points, labels = rows_of_shown(points, found._shape, "scene"), found.labels.reshape(-1)
    colors = np.where(labels > 0, np.array(COLORS)[(labels - 1) % len(COLORS)], "#AAAAAA")
    finite = np.isfinite(points).all(axis=1)
    of_objects = points[finite & (labels > 0)] if len(found) else points[finite]
    shown = finite if not len(found) else (np.abs(points - of_objects.mean(axis=0)) < 1.5 * diagonal(of_objects)).all(axis=1)
    axes = _axes_for(points[shown], axes, counted(len(found), "object"), colors[shown], view_of(found, of_objects), of_objects)
    for k, each in enumerate(found):
        color = COLORS[k % len(COLORS)]
        _draw(axes, each.planes, points[each.rows], () if each.planes.axes else len(each.planes) * [color])
        axes.plot([], [], [], "o", color=color, label=label_of(found, k))
    if len(found):
        axes.legend(loc="lower center", fontsize="small", ncol=1 + (len(found) > 6))
    return axes


def plot_frame(frame: Frame, points: Any, axes: Any) -> Any:
    from .functions import prepare

    array, shift, *_ = prepare("points", points)
    points = array.astype(float) if shift is None else array + shift
    axes = _axes_for(points, axes, "center of symmetry and principal symmetry axes")
    for k in range(3):
        reach = np.array([[-1], [1]]) * diagonal(points) / 2 * frame.scores[k]
        axes.plot(*(frame.center + reach * frame.axes[:, k]).T, color=COLORS[k], linewidth=2)
    return axes


def plot_profile(profile: Profile, axes: Any) -> Any:
    if axes is None:
        axes = plt.figure(figsize=(6, 6), dpi=100).add_subplot()
    axes.plot(profile.radius, profile.height, ".", markersize=3)
    axes.fill_betweenx(profile.height, profile.radius - profile.spread, profile.radius + profile.spread, alpha=0.2)
    axes.set(xlabel="radius", ylabel="height", aspect="equal")
    return axes


def plot_map(found: Map, axes: Any) -> Any:
    if axes is None:
        axes = plt.subplots(figsize=(6, 4), dpi=100)[1]
    shown = axes.imshow(found.values.max(axis=2), aspect="auto", cmap="cividis", extent=(0, 360, 90, 0))
    axes.set(xlabel="phi, degrees", ylabel="theta, degrees", title="greatest symmetry of each direction of normals")
    axes.figure.colorbar(shown)
    return axes
