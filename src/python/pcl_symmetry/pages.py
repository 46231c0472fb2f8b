"""The pages that the tools write, for notebooks: results in three dimensions, turned with the mouse, without network."""

from __future__ import annotations

import base64
import html
import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Tuple, Union

import numpy as np

if TYPE_CHECKING:
    from .results import Planes, ReflectionPlane, Scene

# As in the pictures of the tools: the scale of cividis, the colors of planes (Okabe and Ito), and plain points and meshes.
_SCALE = np.array([[int(c[k : k + 2], 16) for k in (0, 2, 4)] for c in (
    "00204D 00306F 2A406C 48526B 5E626E 727374 878479 9E9677 B6A971 D0BE67 EAD357 FFEA46".split())])  # fmt: skip
_COLORS = [[0.90, 0.62, 0.0], [0.0, 0.45, 0.70], [0.0, 0.62, 0.45], [0.80, 0.47, 0.65], [0.34, 0.71, 0.91]]
_AXIS_COLOR, _PLAIN_POINT, _PLAIN_MESH = [0.84, 0.37, 0.0], [76, 97, 133], [219, 219, 224]
_GREY, _MOST_POINTS = np.array([170, 170, 170], np.uint8), 200_000


def counted(number: int, what: str) -> str:
    plural = what[:-2] + "es" if what == "axis" else what + "s"
    return f"{number} {what if number == 1 else plural}"


class Page:
    """A page of HTML. A notebook shows it; save() writes it for any browser."""

    def __init__(self, scene: Dict[str, Any]) -> None:
        folder = Path(__file__).parent
        head, library, viewer = ((folder / name).read_text() for name in ("page.html", "three.min.js", "viewer.js"))
        data = json.dumps(scene).replace("</", "<\\/")
        self.html = (
            f'{head}{library}</script>\n<script type="application/json" id="scene">{data}</script>\n'
            f"<script>\n{viewer}</script>\n</body>\n</html>\n"
        )

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the page."""
        Path(path).write_text(self.html)

    def _repr_html_(self) -> str:
        return f'<iframe srcdoc="{html.escape(self.html)}" style="width: 100%; height: 500px; border: 0"></iframe>'


def _bytes(values: Any) -> str:
    return base64.b64encode(np.ascontiguousarray(values).tobytes()).decode()


def rows_of_shown(points: Any, shape: Tuple[int, ...], what: str) -> Any:
    """(N, 3) rows of the points that an answer is of."""
    from .functions import parts_of

    array = parts_of("points", points)[0]
    if array.shape != (*shape, 3):
        raise ValueError(f"points = array of shape {array.shape}, must be {(*shape, 3)}, those of the {what}")
    return array.reshape(-1, 3).astype(float)


def rows_of_planes(found: Planes, points: Any) -> Any:
    """(N, 3) the points that planes were searched in, NaN for others; of a mesh its samples."""
    if found.samples is not None:
        return found.samples.astype(float)
    every = rows_of_shown(points, found._shape, "planes")
    if len(found._rows):
        others = np.ones(len(every), bool)
        others[found._rows] = False
        every[others] = np.nan
    return every


def diagonal(points: Any) -> float:
    return float(np.linalg.norm(np.nanmax(points, axis=0) - np.nanmin(points, axis=0)))


def corners_of(plane: ReflectionPlane, points: Any) -> Any:
    """The corners of a square in the plane around the points, (4, 3)."""
    u = np.cross(plane.normal, np.eye(3)[np.abs(plane.normal).argmin()])
    u /= np.linalg.norm(u)
    v = np.cross(plane.normal, u)
    center = np.nanmean(points, axis=0)
    center = center - plane.distance(center) * plane.normal
    half = 0.6 * diagonal(points) / np.sqrt(2)
    return np.array([center + half * (a * u + b * v) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


class _Panels:
    """The list of a page, in coordinates in which all points lie within half a unit of the origin."""

    def __init__(self, every: Any) -> None:
        rows = np.flatnonzero(np.isfinite(every).all(axis=1))
        self.rows = rows[:: -(-len(rows) // _MOST_POINTS) or 1]
        self.used = every[self.rows]
        self.empty = not len(self.used)
        if self.empty:
            self.used = np.zeros((1, 3))
        self._middle = (self.used.max(axis=0) + self.used.min(axis=0)) / 2
        self._half = diagonal(self.used) / 2 or 1.0
        self.panels: List[Dict[str, Any]] = []

    def inside(self, x: Any) -> List[Any]:
        return ((np.asarray(x) - self._middle) / self._half * 0.5).tolist()  # type: ignore[no-any-return]

    def add(self, label: str, **shown: Any) -> None:
        panel = dict(label=label, show_points=True, has_support=False, shade=[0.65, 0.35], point_colors=None, mesh_colors=None)
        self.panels.append({**panel, "planes": [], "axes": [], "segments": [], **shown})

    def axis(self, point: Any, direction: Any, half: float = 0.0) -> Dict[str, Any]:
        ends = self.inside(point + np.array([[-1], [1]]) * (half or self._half) * direction)
        return dict(ends=ends, color=_AXIS_COLOR)

    def page(self, text: str, view: Any = (1.0, -1.6, 0.8), up: Any = (0.0, 0.0, 1.0)) -> Page:
        scene = dict(title="pcl_symmetry", text=text, view=list(map(float, view)), up=list(map(float, up)), panels=self.panels)
        scene.update(plain_point=_PLAIN_POINT, plain_mesh=_PLAIN_MESH, point_size=0.5 / max(1, len(self.used)) ** 0.5)
        points = np.asarray(self.inside(self.used), dtype=np.float32)
        scene.update(points=_bytes(points[: 0 if self.empty else None]), normals="", mesh="")
        scene["support_colors"] = [f"rgb({r},{g},{b})" for r, g, b in _SCALE.tolist()]
        return Page(scene)


def page_of_planes(found: Planes, points: Any) -> Page:
    panels = _Panels(rows_of_planes(found, points))
    for axis in found.axes:
        panels.add(f"axis of revolution: confidence {axis.confidence:.2f}", axes=[panels.axis(axis.point, axis.direction)])
    for turn in found.rotations:
        if turn.fold:
            label = f"axis of order {turn.fold}: confidence {turn.confidence:.2f}"
            panels.add(label, axes=[panels.axis(turn.point, turn.direction)])
    for center in found.centers:
        lines = [panels.axis(center.point, direction) for direction in np.eye(3)]
        panels.add(f"every plane through the center: confidence {center.confidence:.2f}", axes=lines)
    for k, plane in enumerate(found.every):
        support = _bytes(support_colors(found.point_support(k).reshape(-1)[panels.rows])) if found._support else None
        square = dict(corners=panels.inside(corners_of(plane, panels.used)), color=_COLORS[k % len(_COLORS)])
        where = "" if found.viewpoint is None else f" of {100 * plane.seen:.0f} % seen"
        label = f"plane {k + 1} ({plane.kind}): confidence {plane.confidence:.2f}, support {plane.support:.2f}{where}"
        panels.add(label, planes=[square], has_support=support is not None, point_colors=support)
    if not panels.panels:
        panels.add("no symmetry plane")
    return panels.page(repr(found), *view_of(found, panels.used))


def support_colors(support: Any) -> Any:
    """(N, 3) bytes for support in [0, 1], violet for NaN: not seen."""
    at = np.clip(np.nan_to_num(support), 0, 1)[:, None] * (len(_SCALE) - 1)
    low = np.minimum(at.astype(int), len(_SCALE) - 2)[:, 0]
    colors = _SCALE[low] + (at - low[:, None]) * (_SCALE[low + 1] - _SCALE[low])
    return np.where(np.isnan(support)[:, None], (201, 179, 222), colors.round()).astype(np.uint8)


def view_of(found: Union[Planes, Scene], points: Any) -> Tuple[Any, ...]:
    """The direction to a camera slightly above the sensor, and what is up there: nothing where no sensor is known.

    Up is away from the first supporting plane; else of a sensor at the origin -y, as of a camera, and of another one z.
    """
    if found.viewpoint is None or not len(points):
        return ()
    to_sensor = found.viewpoint - points.mean(axis=0)
    is_camera = np.linalg.norm(found.viewpoint) < 1e-3 * np.linalg.norm(to_sensor)
    to_sensor /= np.linalg.norm(to_sensor)
    up = np.array([0.0, -1.0, 0.0] if is_camera else [0.0, 0.0, 1.0])
    for support in getattr(found, "supports", ())[:1]:
        if abs(support.coefficients[:3] @ to_sensor) < 0.95:  # a wall that faces the sensor is not below the objects
            up = support.coefficients[:3]
    return to_sensor + 0.25 * up, up


def label_of(found: Scene, index: int) -> str:
    planes = found[index].planes
    best = max([p.confidence for p in (*planes, *planes.axes)], default=0.0)
    what = "axis of revolution" if planes.axes else counted(len(planes), "plane") if planes else "no symmetry"
    name = found[index].models[0].name + ", " if found[index].models else ""
    return f"object {index + 1}: {name}{what}" + (f", confidence {best:.2f}" if best else "")


def page_of_scene(found: Scene, points: Any) -> Page:
    """All objects, each in a color with its best plane or axis, then one by one."""
    panels = _Panels(rows_of_shown(points, found._shape, "scene"))
    labels = found.labels.reshape(-1)[panels.rows]
    bright = (255 * np.array(_COLORS)).round().astype(np.uint8)
    colors = np.where(labels[:, None] > 0, bright[(labels - 1) % len(bright)], _GREY)
    drawn: List[Dict[str, Any]] = []
    every = rows_of_shown(points, found._shape, "scene")
    for k, each in enumerate(found.objects):
        of_object, color = every[each.rows], _COLORS[k % len(_COLORS)]
        of_object = of_object[np.isfinite(of_object).all(axis=1)]
        reach = 0.7 * diagonal(of_object)
        lines = [panels.axis(axis.point, axis.direction, reach) for axis in each.planes.axes]
        squares = [dict(corners=panels.inside(corners_of(plane, of_object)), color=color) for plane in each.planes]
        drawn.append(dict(axes=lines, planes=squares[: not lines], planes_of_object=squares))
    first = dict(axes=[a for d in drawn for a in d["axes"]], planes=[p for d in drawn for p in d["planes"]])
    panels.add(counted(len(found), "object"), point_colors=_bytes(colors), **first)
    for k, d in enumerate(drawn):
        own = np.where((labels == k + 1)[:, None], colors, _GREY)
        panels.add(label_of(found, k), point_colors=_bytes(own), axes=d["axes"], planes=d["planes_of_object"])
    of_objects = panels.used[labels > 0] if (labels > 0).any() else panels.used
    return panels.page(f"Scene({counted(len(found), 'object')}, {counted(len(found.supports), 'supporting plane')})", *view_of(found, of_objects))
