"""The pages that the tools write, for notebooks: results in three dimensions, turned with the mouse, without network."""

from __future__ import annotations

import base64
import html
import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Union

import numpy as np

if TYPE_CHECKING:
    from .results import Planes

# As in the pictures of the tools: the scale of cividis, the colors of planes (Okabe and Ito), and plain points and meshes.
_SCALE = np.array([[int(c[k : k + 2], 16) for k in (0, 2, 4)] for c in (
    "00204D 00306F 2A406C 48526B 5E626E 727374 878479 9E9677 B6A971 D0BE67 EAD357 FFEA46".split())])  # fmt: skip
_COLORS = [[0.90, 0.62, 0.0], [0.0, 0.45, 0.70], [0.0, 0.62, 0.45], [0.80, 0.47, 0.65], [0.34, 0.71, 0.91]]
_AXIS_COLOR, _PLAIN_POINT, _PLAIN_MESH = [0.84, 0.37, 0.0], [76, 97, 133], [219, 219, 224]
_MOST_POINTS = 200_000


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


def page_of_planes(found: "Planes", points: Any) -> Page:
    from .plots import _diagonal, _square

    every = np.asarray(points, dtype=float)
    if every.shape != (found._num_rows, 3):
        raise ValueError(f"points = array of shape {every.shape}, must be ({found._num_rows}, 3), those of the planes")
    rows = np.flatnonzero(np.isfinite(every).all(axis=1))
    rows = rows[:: -(-len(rows) // _MOST_POINTS) or 1]
    used = every[rows]
    middle, half = (used.max(axis=0) + used.min(axis=0)) / 2, _diagonal(used) / 2 or 1.0

    def inside(x: Any) -> List[Any]:
        return ((np.asarray(x) - middle) / half * 0.5).tolist()  # type: ignore[no-any-return]

    panels: List[Dict[str, Any]] = []

    def add(label: str, **shown: Any) -> None:
        panel = dict(label=label, show_points=True, has_support=False, shade=[0.65, 0.35], point_colors=None, mesh_colors=None)
        panels.append({**panel, "planes": [], "axes": [], "segments": [], **shown})

    for axis in found.axes:
        ends = inside(axis.point + np.array([[-1], [1]]) * half * axis.direction)
        add(f"axis of revolution: confidence {axis.confidence:.2f}", axes=[dict(ends=ends, color=_AXIS_COLOR)])
    for k, plane in enumerate(found):
        support = np.nan_to_num(found.point_support(k)[rows])
        at = np.clip(support, 0, 1)[:, None] * (len(_SCALE) - 1)
        low = np.minimum(at.astype(int), len(_SCALE) - 2)[:, 0]
        colors = (_SCALE[low] + (at - low[:, None]) * (_SCALE[low + 1] - _SCALE[low])).round().astype(np.uint8)
        square = dict(corners=inside(_square(plane, used)), color=_COLORS[k % len(_COLORS)])
        label = f"plane {k + 1} ({plane.kind}): confidence {plane.confidence:.2f}, support {plane.support:.2f}"
        add(label, planes=[square], has_support=True, point_colors=_bytes(colors))
    if not panels:
        add("no symmetry plane")
    scene = dict(title="pcl_symmetry", text=repr(found), view=[1.0, -1.6, 0.8], up=[0.0, 0.0, 1.0], panels=panels)
    scene.update(plain_point=_PLAIN_POINT, plain_mesh=_PLAIN_MESH, point_size=0.5 / max(1, len(used)) ** 0.5)
    scene.update(points=_bytes(np.asarray(inside(used), dtype=np.float32)), normals="", mesh="")
    scene["support_colors"] = [f"rgb({r},{g},{b})" for r, g, b in _SCALE.tolist()]
    return Page(scene)
