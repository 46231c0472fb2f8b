"""What the functions of pcl_symmetry return: frozen data classes that hold numbers, texts and arrays of NumPy.

Each compares with ==, pickles, and has to_dict() and to_json(), with the keys of the tools' JSON. Lengths are in input
units, points and directions in the input frame, angles in radians.
"""

from __future__ import annotations

import dataclasses
import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Dict, Iterator, List, Optional, Tuple, TypeVar, Union, overload

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from .pages import Page

__all__ = [
    "Axis", "BuildReport", "Center", "Frame", "Junction", "Map", "Match", "ModelEvidence", "Plane", "Planes", "PoseEvidence",
    "PoseScore", "ProbableFrame", "Profile", "Recognized", "ReflectionPlane", "RegisteredScans", "Registration",
    "RotationAxis", "Rotations", "Scene", "SceneObject", "Shape", "Support", "Symmetrized", "View",
]

Self = TypeVar("Self", bound="Result")


def _plain(value: Any) -> Any:
    """Lists, dicts, numbers and texts in place of arrays and results."""
    if isinstance(value, Result):
        return value.to_dict()
    if isinstance(value, (list, tuple)):
        return [_plain(each) for each in value]
    if hasattr(value, "dtype") and value.dtype.names:
        return [dict(zip(value.dtype.names, map(_plain, row))) for row in value]
    return value.tolist() if hasattr(value, "tolist") else value


def _numbers(matrices: NDArray[np.float64]) -> Any:
    """Of matrices (..., 4, 4) 16 numbers each, row by row, as the tools write them."""
    return matrices.reshape(*matrices.shape[:-2], 16).tolist()


def _picked(found: Result, names: str) -> Dict[str, Any]:
    values = found.to_dict()
    return {name: values[name] for name in names.split()}


def _viewpoint(found: Union[Planes, Scene]) -> Dict[str, Any]:
    position = {} if found.viewpoint is None else {"position": found.viewpoint.tolist()}
    return {"from": found._viewpoint_from, **position}


def _vectors(points: ArrayLike) -> NDArray[Any]:
    """Points, (3,) or (N, 3), of a floating-point type."""
    import numpy as np

    x = np.asarray(points)
    if x.shape[-1:] != (3,):
        raise ValueError(f"points = array of shape {x.shape}, must be (3,) or (N, 3)")
    return x if x.dtype.kind == "f" else x.astype(float)


def _same(a: Any, b: Any) -> bool:
    import numpy as np

    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        if isinstance(a, np.ndarray) and isinstance(b, np.ndarray) and a.dtype == b.dtype and a.dtype.names:
            return a.tobytes() == b.tobytes()
        return np.array_equal(a, b, equal_nan=True) if a is not None and b is not None else False
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(map(_same, a, b))
    return bool(a == b)


def _text(value: Any) -> str:
    if isinstance(value, Result):
        return repr(value)
    value = list(value) if isinstance(value, (list, tuple)) else _plain(value)
    if isinstance(value, list):
        return "[" + ", ".join(map(_text, value)) + "]"
    if isinstance(value, float):
        value += 0.0  # no -0
        return f"{value:.4g}" if abs(value) < 1e4 else f"{value:.10g}"  # those of maps to the millimeter
    return repr(value)


def shown(value: Any) -> str:
    """A value in a message: of a large one the shape and type."""
    import numpy as np

    try:
        array = np.asarray(value)
    except ValueError:  # rows of different lengths
        return f"{type(value).__name__} of length {len(value)}"
    if array.ndim and (array.size > 16 or array.dtype == object):
        return f"array of shape {array.shape} and type {array.dtype}"
    text = _text(value)
    return text if len(text) <= 250 else f"{type(value).__name__} of {len(text)} characters"


@dataclass(frozen=True, eq=False, repr=False)
class Result:
    """What all results can do."""

    _in_repr: ClassVar[Tuple[str, ...]] = ()
    _writeable: ClassVar[Tuple[str, ...]] = ("points", "faces", "added")  # shapes to go on with: Open3D takes no read-only arrays

    def __post_init__(self) -> None:
        import numpy as np

        for f in dataclasses.fields(self):
            value = getattr(self, f.name)
            if isinstance(value, np.ndarray) and value.flags.writeable and f.name not in self._writeable:
                value = value.view()
                value.flags.writeable = False
                object.__setattr__(self, f.name, value)

    def to_dict(self) -> Dict[str, Any]:
        """What the tools write as JSON of it, but for file, times and fitness: the schemas in apps/schemas say what each key is. Of
        what no tool writes, the fields. Arrays become lists."""
        return self._json()

    def _json(self) -> Dict[str, Any]:
        fields = dataclasses.fields(self)
        return {f.name: _plain(getattr(self, f.name)) for f in fields if not f.name.startswith("_")}

    def to_json(self, **options: Any) -> str:
        """The text of to_dict(), with null for numbers that are not finite; options are those of json.dumps()."""
        plain = json.loads(json.dumps(self.to_dict()), parse_constant=lambda name: None)
        return json.dumps(plain, **options)

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        names = [f.name for f in dataclasses.fields(self)]
        return all(_same(getattr(self, name), getattr(other, name)) for name in names)

    def __hash__(self) -> int:
        return hash(repr(self))

    def __repr__(self) -> str:
        names = (*self._in_repr, "reason") if getattr(self, "reason", "") else self._in_repr
        return f"{type(self).__name__}({', '.join(f'{name}={_text(getattr(self, name))}' for name in names)})"

    def _moved(self: Self, shift: NDArray[np.float64]) -> Self:
        """The result in a frame whose origin lies at -shift."""
        changes: Dict[str, Any] = {}
        for f in dataclasses.fields(self):
            value = getattr(self, f.name)
            if isinstance(value, Result):
                changes[f.name] = value._moved(shift)
            elif isinstance(value, list) and value and isinstance(value[0], Result):
                changes[f.name] = [each._moved(shift) for each in value]
            elif f.name in ("point", "center", "viewpoint") and value is not None:
                changes[f.name] = value + shift
        return dataclasses.replace(self, **changes)


@dataclass(frozen=True, eq=False, repr=False, init=False)
class ReflectionPlane(Result):
    """A plane of reflection: normal . x = offset."""

    _in_repr: ClassVar[Tuple[str, ...]] = ("equation",)
    normal: NDArray[np.float64]
    """(3,) unit."""
    offset: float
    """normal . x of points x in the plane, input units."""

    def __init__(self, normal: ArrayLike, offset: float) -> None:
        """normal: (3,), finite, not zero; it is normalized, and the offset divided by its length."""
        import numpy as np

        n = np.array(normal, dtype=float)
        if n.shape != (3,) or not np.isfinite(n).all() or not n.any():
            raise ValueError(f"normal = {shown(n)}, must be (3,), finite and not zero")
        length = float(np.linalg.norm(n))
        if abs(length - 1.0) > 1e-12:
            n, offset = n / length, offset / length
        object.__setattr__(self, "normal", n)
        object.__setattr__(self, "offset", float(offset))
        self.__post_init__()

    def _json(self) -> Dict[str, Any]:
        others = super()._json()
        del others["normal"], others["offset"]
        return {"coefficients": self.coefficients.tolist(), **others}

    @property
    def coefficients(self) -> NDArray[np.float64]:
        """(4,) a, b, c, d of a x + b y + c z + d = 0."""
        import numpy as np

        result = np.append(self.normal, -self.offset)
        result.flags.writeable = False
        return result

    @property
    def equation(self) -> str:
        """The same in words, such as "0 x + 0 y + 1 z - 0.5 = 0"."""
        terms = (f"{number + 0.0:+.4g}{name}" for number, name in zip(self.coefficients, (" x", " y", " z", "")))  # no -0
        text = " ".join(f"{term[0]} {term[1:]}" for term in terms) + " = 0"
        return text[2:] if text[0] == "+" else "-" + text[2:]

    @property
    def reflection(self) -> NDArray[np.float64]:
        """(4, 4) the reflection, x -> R x."""
        import numpy as np

        result = np.eye(4)
        result[:3, :3] -= 2.0 * np.outer(self.normal, self.normal)
        result[:3, 3] = 2.0 * self.offset * self.normal
        result.flags.writeable = False
        return result

    def distance(self, x: ArrayLike) -> Any:
        """Signed distance of one point, (3,), or of each row, (N, 3); input units."""
        result = _vectors(x).astype(float) @ self.normal - self.offset
        return float(result) if result.ndim == 0 else result

    def angle_to(self, other: ReflectionPlane) -> float:
        """Angle between two planes, in [0, pi/2] radians."""
        import numpy as np

        cross = float(np.linalg.norm(np.cross(self.normal, other.normal)))
        return float(np.arctan2(cross, abs(float(self.normal @ other.normal))))

    def reflect(self, points: ArrayLike) -> NDArray[Any]:
        """The reflections of points, (3,) or (N, 3); floating-point types are kept."""
        x = _vectors(points)
        exact = x.astype(float)
        result: NDArray[Any] = exact - 2.0 * (exact @ self.normal - self.offset)[..., None] * self.normal
        return result.astype(x.dtype)

    def pairs(self, points: Any, *, max_distance: float = 0.0) -> Tuple[NDArray[np.int64], NDArray[np.float64]]:
        """The counterpart of each point of a cloud: the point closest to its reflection.

        points: (N, 3), (H, W, 3), or an object of Open3D or trimesh, of a mesh its vertices. max_distance: between a
        reflection and its counterpart, input units; 0: 1 % of the diameter.
        Returns (index, distance), each (N,): the row of the counterpart and its distance from the reflection; -1 and
        infinity where there is none, as on the unseen side of a scan.
        """
        from .functions import _core_plane, core, of_vertices

        array, shift, *_ = of_vertices("points", points)
        index, distance = core.pairs(array, _core_plane(self, shift), max_distance=max_distance)
        return index, distance

    def _moved(self: Self, shift: NDArray[np.float64]) -> Self:
        return dataclasses.replace(super()._moved(shift), offset=self.offset + float(self.normal @ shift))  # type: ignore


@dataclass(frozen=True, eq=False, repr=False)
class Plane(ReflectionPlane):
    """A local maximum of the transform, refined and judged."""

    _in_repr = ("kind", "equation", "confidence", "share")
    kind: str
    """symmetry, possible, approximate or local."""
    confidence: float
    """Probability that it is a symmetry, in [0, 1]; 0 as published."""
    reasons: Tuple[Tuple[str, Optional[float]], ...]
    """Why it has confidence and kind: (rule, factor on the odds). The first factor is the odds of the evidence; None: the plane is a
    possible symmetry at most, however confident. The product is confidence / (1 - confidence)."""
    share: float
    """Estimated share of the surface that is mapped to within the tolerance, in [0, 1]; NaN for volumes, which have no surface, and as published."""
    share_interval: Tuple[float, float]
    """Limits of that share for the whole object, 95 of 100 cases: (0, 1) of most scans, which do not show the rest."""
    score: float
    """D of equation 2, in [0, 1]."""
    support: float
    """Share of the surface seen that is mapped onto it, in [0, 1]."""
    deviation: float
    """97 % of the reflected points stay within this distance of the surface, input units; NaN where share is."""
    seen: float
    """Share of the points whose reflection the cloud could show."""
    residual: float
    """Root mean square distance of reflected points, input units."""
    iterations: int
    """Of the refinement."""
    converged: bool
    """The refinement came to rest."""

    def _json(self) -> Dict[str, Any]:
        return {**super()._json(), "reasons": [dict(rule=rule, odds=odds) for rule, odds in self.reasons]}


@dataclass(frozen=True, eq=False, repr=False)
class Axis(Result):
    """All planes through a line are symmetries: a body of revolution."""

    _in_repr = ("point", "direction", "confidence")
    point: NDArray[np.float64]
    """(3,) of the axis."""
    direction: NDArray[np.float64]
    """(3,) unit."""
    confidence: float
    """As that of Plane."""
    score: float
    """As that of Plane."""
    support: float
    """As that of Plane."""

    def rotate(self, points: ArrayLike, angle: float) -> NDArray[Any]:
        """Points, (3,) or (N, 3), rotated about the axis by an angle in radians; floating-point types are kept."""
        import numpy as np

        x = _vectors(points)
        k, y = self.direction, x.astype(float) - self.point
        along = (y @ k)[..., None] * k
        result: NDArray[Any] = self.point + along + np.cos(angle) * (y - along) + np.sin(angle) * np.cross(k, y)
        return result.astype(x.dtype)

    def profile(self, points: Any, num_points: int = 200) -> Profile:
        """The curve that gives the body of revolution when it is rotated about the axis, averaged over all angles.

        points: (N, 3), or an object of Open3D or trimesh. num_points: of the curve, about.
        """
        from .functions import core, prepare

        array, shift, *_ = prepare("points", points)
        point = self.point if shift is None else self.point - shift
        rows = core.profile(array, point, self.direction, num_points=num_points)
        return Profile(radius=rows[:, 0], height=rows[:, 1], spread=rows[:, 2], count=rows[:, 3].astype(int))


@dataclass(frozen=True, eq=False, repr=False)
class Profile(Result):
    """The profile of a body of revolution: points of a curve, in order."""

    _in_repr = ("radius", "height")
    radius: NDArray[np.float64]
    """(K,) distance from the axis."""
    height: NDArray[np.float64]
    """(K,) along the direction of the axis, from its point."""
    spread: NDArray[np.float64]
    """(K,) standard deviation of the points about the curve."""
    count: NDArray[np.int64]
    """(K,) points that decide there."""

    def plot(self, axes: Any = None) -> Any:
        """Draws the curve and its spread with matplotlib; savefig() of its figure writes SVG. Returns the axes."""
        from .plots import plot_profile

        return plot_profile(self, axes)


@dataclass(frozen=True, eq=False, repr=False)
class Symmetrized(Result):
    """A shape that a plane maps onto itself, and the asymmetry of the given one."""

    _in_repr = ("mean_asymmetry", "greatest_asymmetry")
    points: NDArray[Any]
    """(M, 3): the vertices of a mesh; of a cloud the points that stay, then their reflections."""
    faces: Optional[NDArray[Any]]
    """(F, 3) rows of points, of a mesh."""
    rows: NDArray[np.int64]
    """(M,) row of the given point that each is, or is the reflection of."""
    asymmetry: NDArray[np.float32]
    """(N,) how far the shape is outside of the reflection of its other side at each given point, along its normal; NaN where
    the other side has nothing."""
    mean_asymmetry: float
    """Mean of the absolute values, of a mesh by area."""
    greatest_asymmetry: float
    deviation: float
    """Greatest distance of the result from its own reflection; 0 where it was cut."""


@dataclass(frozen=True, eq=False, repr=False)
class RotationAxis(Result):
    """Rotations about a line map what a scanner saw onto itself or into occluded space."""

    _in_repr = ("point", "direction", "fold", "confidence")
    point: NDArray[np.float64]
    """(3,) of the axis."""
    direction: NDArray[np.float64]
    """(3,) unit."""
    fold: int
    """Order of the rotations; 0: by any angle."""
    confidence: float
    """Probability that these rotations are symmetries of the whole object."""
    support: float
    """Share of the points that the best rotation maps onto the surface."""
    off: float
    """Share that the worst rotation maps into free space."""
    far: float
    """The same, beyond ten tolerances."""
    halfway: float
    """The same of rotations halfway between those of the fold."""


@dataclass(frozen=True, eq=False, repr=False)
class Center(Result):
    """All planes through a point are symmetries: a sphere."""

    _in_repr = ("point", "confidence")
    point: NDArray[np.float64]
    """(3,)"""
    confidence: float
    """As that of Plane."""
    score: float
    """As that of Plane."""
    support: float
    """As that of Plane."""


@dataclass(frozen=True, eq=False, repr=False)
class View(Result):
    """A direction to look at an object from."""

    _in_repr = ("direction", "score")
    direction: NDArray[np.float64]
    """(3,) unit, from the object to the camera."""
    score: float
    """S of Section 5.4, >= 0."""
    pose: Optional[NDArray[np.float64]] = None
    """(4, 4) of a camera there, which sees the whole object at 25 degrees: from its frame (x right, y down, z forward) to that of
    the input; None where planes alone were given."""

    def _json(self) -> Dict[str, Any]:
        found = super()._json()
        pose = found.pop("pose")
        return found if pose is None else {**found, "pose": _numbers(self.pose)}  # type: ignore[arg-type]


@dataclass(frozen=True, eq=False, repr=False)
class Shape(Result):
    """What read() found in a file, or points and faces of your own; every function takes it as points."""

    points: NDArray[Any]
    """(N, 3), or (H, W, 3) with rows and columns of a camera, NaN where nothing was measured; float64 where the file has it."""
    faces: NDArray[np.int32]
    """(F, 3) rows of points; (0, 3) of a cloud."""
    viewpoint: Optional[NDArray[np.float64]] = None
    """(3,) where the sensor stood, which viewpoint="auto" means; None where the file says nothing of it."""

    def __len__(self) -> int:
        return len(self.points)

    def __array__(self, dtype: Any = None) -> NDArray[Any]:
        import numpy as np

        return np.asarray(self.points, dtype=dtype)

    def __repr__(self) -> str:
        return f"Shape(points={self.points.shape}, faces={len(self.faces)}, viewpoint={_text(self.viewpoint)})"


@dataclass(frozen=True, eq=False, repr=False)
class Planes(Result):
    """What planes() found; behaves as the list of the planes of symmetry: a sphere has an empty one, and a center."""

    planes: List[Plane]
    """The symmetries, best first; with as_published all planes, which nothing judged."""
    possible: List[Plane]
    """What may be a symmetry: planes of a confidence of 0.2 to 0.5, and those that the points cannot decide; best first."""
    approximate: List[Plane]
    """With planes(approximate=True): approximate symmetries, then those of parts (local); each best first."""
    axes: List[Axis]
    """Best first."""
    centers: List[Center]
    rotations: List[RotationAxis]
    """Of scans from one side, most confident first."""
    best: Optional[Plane]
    """Where there is no symmetry and no possible one: the plane that comes closest; else None."""
    undecided: bool
    """Whether there is no symmetry, as few points of a whole cloud leave it open: best may be one."""
    flat: Optional[NDArray[np.float64]]
    """(4,) plane that all points of a sheet or a disc lie near; None: the cloud is not flat."""
    tolerance: float
    """That was decided at, input units."""
    resolution: float
    """Least tolerance that the sensor and the spacing of the points resolve, input units; 0: not known."""
    diameter: float
    """Greatest distance between two points, input units."""
    stray_points: int
    """Number of points that were left out, as they are few and far from all others."""
    reason: str
    """Why there is no answer; empty where the search ran."""
    viewpoint: Optional[NDArray[np.float64]]
    """(3,) where the scanner stood; None: seen from all sides."""
    evidence: NDArray[Any]
    """With planes(evidence=True), what the decisions are taken from: structured array, one row a candidate, best first.

    - coefficients: (4,) a, b, c, d. kind: 0 surface, 1 scan, 2 points that resolve no surface
    - flat: all points lie in one plane. confidence: by this evidence alone
    - share, double_share: of the surface that the plane maps to within once and twice the tolerance; all shares are in [0, 1]
    - unknown: share that is uninformative, as its reflection was not seen or was cut off
    - score: D of equation 2. own_score: what noise leaves of D for a symmetry, in [0.5, 1]
    - support, conflict: mean over the points. baseline: support of the points on the surface of all others
    - hold: of scans, how firmly the matches hold the plane, >= 0
    - spacing, tolerance: over the radius of the points. roughness: over the spacing
    - share_unit: unit of the error of the share, for share_interval
    - terms: (7,) summands of the log odds of the confidence before their coefficients, by kind 7, 6 and 5 of them, then 0;
      the last one of kinds 0 and 1 counts for planes beside the best of the cloud
    """
    rotation_evidence: NDArray[Any]
    """The same for the rotations of scans, also those of no confidence.

    - point, direction: (3,) each. fold: order of the rotations; 0: by any angle
    - kind: 0 by any angle, 1 half turns, 2 of order 3 and more. confidence: of the rotations
    - support: share of the points seen that the best rotation maps onto the surface
    - off, far: share that the worst rotation maps into free space, beyond one and ten tolerances
    - halfway: off of rotations halfway between those of the fold
    - grown: of half turns, extent with the image over that without, >= 1. hold: of these, how firmly the matches hold the
      line, >= 0. planes_off: off of the best pair of planes through it. beside: 1 where another rotation fits better
    - terms: (7,) summands of the log odds before their coefficients, by kind 4, 7 and 6 of them, then 0
    """
    samples: Optional[NDArray[Any]]
    """(M, 3) points that were spread over a mesh, which point_support() is of; None for a cloud."""
    _support: List[NDArray[np.float32]]
    _rows: NDArray[np.int64]
    _maxima: List[Tuple[NDArray[np.float64], float]]
    _shape: Tuple[int, ...]
    _viewpoint_from: str

    def _json(self) -> Dict[str, Any]:
        num_points = 0 if self.reason else len(self._rows) or self._shape[0]
        found: Dict[str, Any] = dict(num_points=num_points, partial=self.viewpoint is not None, undecided=self.undecided)
        found.update(viewpoint=_viewpoint(self), planes=_plain(self.every))
        found.update({name: _plain(getattr(self, name)) for name in "axes centers tolerance resolution stray_points".split()})
        if self.viewpoint is not None:
            found["rotations"] = _plain(self.rotations)
        if self.best is not None:
            found["best"] = self.best.to_dict()
        if self.flat is not None:
            found["flat"] = {"coefficients": self.flat.tolist()}
        return {**found, "error": self.reason} if self.reason else found

    @property
    def every(self) -> List[Plane]:
        """Symmetries, possible, approximate and local planes."""
        return [*self.planes, *self.possible, *self.approximate]

    def point_support(self, index: Union[int, Plane]) -> NDArray[np.float32]:
        """Support for one of `every`, or its index, at each point of the input, in [0, 1].

        NaN for points that were not used, and where the scanner could not see whether their reflection lies on the surface.
        (N,) for rows, (H, W) for an organized array, (M,) for a mesh: that of its samples.
        """
        import numpy as np

        if isinstance(index, Plane):
            if index not in self.every:
                raise ValueError(f"index = {index}, must be a plane of this answer")
            index = self.every.index(index)
        if not isinstance(index, (int, np.integer)):
            raise TypeError(f"index = {shown(index)}, must be int or a plane of this answer")
        if self.every and not self._support:
            raise ValueError("no support of points is kept; for an object of a scene planes(points, indices=object.rows) has it")
        if not -len(self._support) <= index < len(self._support):
            raise IndexError(f"index = {index}, must be that of one of {len(self._support)} planes with support")
        values = self._support[index]
        result = np.full(int(np.prod(self._shape)), np.nan, np.float32)
        if len(self._rows):
            result[self._rows[: len(values)]] = values
        else:
            result[: len(values)] = values
        return result.reshape(self._shape)

    def show(self, points: Any) -> Page:
        """A page with the points and the planes in three dimensions, as the tools write with -html: a notebook shows it.

        points: those of planes().
        """
        from .pages import page_of_planes

        return page_of_planes(self, points)

    def plot(self, points: Any, axes: Any = None) -> Any:
        """Draws points, planes and axes with matplotlib into axes of projection 3d, by default new ones; returns them.

        points: those of planes(), of which only those that were used are drawn.
        """
        from .plots import plot_planes

        return plot_planes(self, points, axes)

    def __len__(self) -> int:
        return len(self.planes)

    def __iter__(self) -> Iterator[Plane]:
        return iter(self.planes)

    @overload
    def __getitem__(self, index: int) -> Plane: ...
    @overload
    def __getitem__(self, index: slice) -> List[Plane]: ...
    def __getitem__(self, index: Union[int, slice]) -> Union[Plane, List[Plane]]:
        return self.planes[index]

    def __repr__(self) -> str:
        if self.reason:
            return f"Planes([], reason={self.reason!r})"
        names = "possible approximate axes centers rotations".split()
        others = "".join(f", {name}={len(getattr(self, name))}" for name in names if getattr(self, name))
        if not self.planes and self.best is not None:
            others += f", best={self.best!r}" + ", undecided" * self.undecided
        return "Planes([" + "".join(f"\n  {plane!r}," for plane in self.planes) + ("\n]" if self.planes else "]") + others + ")"

    def _moved(self, shift: NDArray[np.float64]) -> Planes:
        changes: Dict[str, Any] = {}
        if self.flat is not None:
            changes["flat"] = self.flat.copy()
            changes["flat"][3] -= self.flat[:3] @ shift
        for name in ("evidence", "rotation_evidence"):
            rows = changes[name] = getattr(self, name).copy()
            if "coefficients" in rows.dtype.names:
                rows["coefficients"][:, 3] -= rows["coefficients"][:, :3] @ shift
            if "point" in rows.dtype.names:
                rows["point"] += shift
        return dataclasses.replace(super()._moved(shift), **changes)


def _conjugated(motions: NDArray[np.float64], shift: NDArray[np.float64]) -> NDArray[np.float64]:
    """Motions (..., 4, 4) of a frame whose origin lies at -shift."""
    moved = motions.copy()
    moved[..., :3, 3] += shift - motions[..., :3, :3] @ shift
    return moved


def _from_moved(transforms: NDArray[np.float64], shift: NDArray[np.float64]) -> NDArray[np.float64]:
    """Transforms (..., 4, 4) of points x in place of x - shift."""
    moved = transforms.copy()
    moved[..., :3, 3] -= transforms[..., :3, :3] @ shift
    return moved


@dataclass(frozen=True, eq=False, repr=False)
class ProbableFrame(Result):
    """A frame that may be the shape's own."""

    _in_repr = ("center", "axes", "probability")
    center: NDArray[np.float64]
    """(3,) center of symmetry."""
    axes: NDArray[np.float64]
    """(3, 3) axes in columns, orthonormal, right-handed."""
    probability: float
    """That the axes are the shape's own, in any order and sign, at any angle about an axis of revolution."""
    revolution_axis: int
    """As of Frame."""

    def _json(self) -> Dict[str, Any]:
        return {**super()._json(), "axes": self.axes.T.tolist()}


@dataclass(frozen=True, eq=False, repr=False)
class Frame(Result):
    """Canonical frame of a shape (Section 5.1): center and principal symmetry axes."""

    _in_repr = ("center", "axes", "revolution_axis")
    center: NDArray[np.float64]
    """(3,) center of symmetry."""
    axes: NDArray[np.float64]
    """(3, 3) axes in columns, orthonormal, right-handed: normals of the best plane, of the best one perpendicular to it, and of both."""
    revolution_axis: int
    """Column that is an axis of revolution; -1: none, 3: every line through the center."""
    scores: NDArray[np.float64]
    """(3,) score of the plane across each axis, in [0, 1]."""
    transform: NDArray[np.float64]
    """(4, 4) from the input to the canonical frame."""
    equivalent: NDArray[np.float64]
    """(K, 4, 4) all transforms that symmetry leaves equally good, `transform` first."""
    rotations: List[RotationAxis]
    """Of scans from one side, most confident first."""
    probable: List[ProbableFrame]
    """This frame, then others by falling probability."""
    evidence: NDArray[Any]
    """What the probabilities are taken from: structured array, one row for each of `probable`.

    constant: 1. value: of the frame less that of the best one, <= 0. first_score: of the plane across the first axis.
    contact: longest stretch of the outline on its box, share of the longer side. principal_angle: to the principal axes
    over 20 degrees, at most 1. best: 1 for the frame that the search put first. other_scores: sum of the scores of the
    other planes. best_score: first_score of the frame that the search put first, else 0.
    """
    stray_points: int
    """Number of points that were left out, as they are few and far from all others."""
    reason: str
    """Why there is no answer: all numbers are NaN then. Else empty."""

    def __bool__(self) -> bool:
        return not self.reason

    def _json(self) -> Dict[str, Any]:
        if self.reason:
            return {"error": self.reason}
        found = super()._json()
        del found["evidence"], found["reason"]
        return {**found, "axes": self.axes.T.tolist(), "transform": _numbers(self.transform), "equivalent": _numbers(self.equivalent)}

    def plot(self, points: Any, axes: Any = None) -> Any:
        """Draws points and axes with matplotlib into axes of projection 3d, by default new ones; returns them."""
        from .plots import plot_frame

        return plot_frame(self, points, axes)

    def _moved(self, shift: NDArray[np.float64]) -> Frame:
        transforms = {name: _from_moved(getattr(self, name), shift) for name in ("transform", "equivalent")}
        return dataclasses.replace(super()._moved(shift), **transforms)


@dataclass(frozen=True, eq=False, repr=False)
class Rotations(Result):
    """The rotations that map a shape onto itself."""

    _in_repr = ("name", "center", "support", "confidence")
    name: str
    """After Schoenflies: C3, D4, T, O, I, Cinf, Dinf or SO3."""
    center: NDArray[np.float64]
    """(3,) point that all axes pass through."""
    support: float
    """Share of the surface that is mapped onto the surface."""
    confidence: float
    """Probability that the whole surface, not its points alone, keeps to the limits."""
    fold: int
    """Order of the main axis; 0 where it is one of revolution."""
    discrete: NDArray[np.float64]
    """(K, 4, 4) motions of the input frame, without the identity."""
    continuous: List[Tuple[NDArray[np.float64], NDArray[np.float64]]]
    """(point, direction) of axes of revolution."""
    tolerance: float
    """That was decided at, input units."""
    stray_points: int
    """Number of points that were left out, as they are few and far from all others."""
    reason: str
    """Why there is no answer: the name is empty then. Else empty."""

    def __bool__(self) -> bool:
        return not self.reason

    def _json(self) -> Dict[str, Any]:
        found = super()._json()
        del found["discrete"], found["continuous"]
        axes = [dict(axis=direction.tolist(), offset=point.tolist()) for point, direction in self.continuous]
        return {**found, "symmetries_discrete": _numbers(self.discrete), "symmetries_continuous": axes}

    def equivalents(self, pose: ArrayLike, step: float = 0.5) -> NDArray[np.float64]:
        """(K, 4, 4) the poses that look like one, it first.

        pose: (4, 4) from the input frame to any other, as that of a camera. step: radians between rotations about an axis
        of revolution.
        """
        result: NDArray[np.float64] = self._group().equivalents(pose=pose, step=step)
        return result

    def canonical(self, pose: ArrayLike) -> NDArray[np.float64]:
        """(4, 4) one pose for all that look the same: the one that is rotated least."""
        result: NDArray[np.float64] = self._group().canonical(pose=pose)
        return result

    def closest_to(self, pose: ArrayLike, previous: ArrayLike) -> NDArray[np.float64]:
        """(4, 4) the pose that looks like the first and is rotated least from the second: what continues a track."""
        result: NDArray[np.float64] = self._group().closest_to(pose=pose, previous=previous)
        return result

    def mssd(self, estimate: ArrayLike, truth: ArrayLike, points: Any) -> float:
        """Maximum surface distance of two poses under the symmetries (MSSD of the BOP benchmark), input units.

        points: (N, 3), such as the vertices of the model.
        """
        from .functions import of_vertices

        array, shift, *_ = of_vertices("points", points)
        return float(self._group().mssd(estimate=estimate, truth=truth, points=array if shift is None else array + shift))

    def _group(self) -> Any:
        from .functions import Core, core

        return Core(core.rotations_of(self.discrete, self.continuous))

    def _moved(self, shift: NDArray[np.float64]) -> Rotations:
        continuous = [(point + shift, direction) for point, direction in self.continuous]
        changes: Dict[str, Any] = dict(discrete=_conjugated(self.discrete, shift), continuous=continuous)
        return dataclasses.replace(super()._moved(shift), **changes)


@dataclass(frozen=True, eq=False, repr=False)
class Map(Result):
    """The transform D(f, gamma) of equation 2 on a grid of planes."""

    _in_repr = ("sigma", "center", "radius")
    sigma: float
    """Width of the Gaussian, input units."""
    center: NDArray[np.float64]
    """(3,) that r is measured from."""
    radius: float
    """Greatest |r|, input units."""
    values: NDArray[np.float32]
    """(theta, phi, r) values of D, 1 for a perfect symmetry."""
    reason: str = ""
    """Why there is no map; empty otherwise."""

    def plane(self, theta: int, phi: int, r: int) -> NDArray[np.float64]:
        """(4,) coefficients a, b, c, d of the plane at the center of a bin."""
        import numpy as np

        shape = self.values.shape
        if not all(0 <= i < n for i, n in zip((theta, phi, r), shape)):
            raise IndexError(f"bin = {(theta, phi, r)}, must lie in a map of {shape}")
        t, p = (theta + 0.5) * np.pi / 2 / shape[0], (phi + 0.5) * 2 * np.pi / shape[1]
        normal = np.array([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)])
        offset = (r + 0.5) * 2 * self.radius / shape[2] - self.radius
        return np.append(normal, -(offset + normal @ self.center))

    def prst(self) -> NDArray[np.float32]:
        """(theta, phi, r) PRST by equation 1, sqrt((1 + D) / 2): 1 for a perfect symmetry, 0.71 for none."""
        import numpy as np

        prst: NDArray[np.float32] = np.sqrt(np.maximum(0, (1 + self.values) / 2))
        return prst

    def plot(self, axes: Any = None) -> Any:
        """Draws the greatest value of each direction of normals with matplotlib, by default into new axes; returns them."""
        from .plots import plot_map

        return plot_map(self, axes)


@dataclass(frozen=True, eq=False, repr=False)
class PoseScore(Result):
    """What two clouds say about a pose."""

    _in_repr = ("support", "conflict", "merit")
    support: float
    """Share of the source that lies on the target, in [0, 1]."""
    conflict: float
    """Share of either that lies in space seen to be empty, in [0, 2]."""
    merit: float
    """support - conflict / 2; a perfect pose has 1."""


@dataclass(frozen=True, eq=False, repr=False)
class PoseEvidence(Result):
    """What decides whether a pose is right: points that face the other surface have to lie on it."""

    _in_repr = ("overlap_source", "overlap_target", "agreement", "contradicted", "missing", "outside")
    overlap_source: float
    """Share of the source's points that lie on the surface of the target, in [0, 1]."""
    overlap_target: float
    """Share of the target's points that lie on the surface of the source, in [0, 1]."""
    agreement: float
    """Of the points that face the other surface, the share that lies on it, in [0, 1]."""
    on_surface: float
    """Lower limit of the share of the scan's points that lie on the surface of the model, in [0, 1]: points count by a Gaussian of
    their distance, 2.5 % of the model's radius wide. The source is the scan, unless only the target was seen from one side."""
    contradicted: float
    """Of the surface of a cloud that the scanner of the other one would see at this pose, the share that lies in space it saw to
    be empty, before what it measured, in [0, 1]. The greater one where both were scanned; 0 where none was."""
    missing: float
    """The same, the share where it measured nothing, in [0, 1]: beside the cloud or in its holes."""
    aside: float
    """The share of both, in [0, 1], that lies farther than 5 % of the smaller diameter from all that it measured."""
    outside: float
    """The share of the surface in parts that only one of the clouds has: what is missing beyond the outline of what was
    measured, or contradicted far from it, less what is missing within the outline, as holes would be in both places; or what
    a scan shows farther than 5 % of the smaller diameter from a model of the whole object, but for its open borders."""
    noise: float
    """Of the noisier cloud, in diameters of the smaller one."""
    size_ratio: float
    """Diameter of the source over that of the target."""
    uniqueness: float
    """Share of the pose in the odds of all that were judged, in (0, 1]: 0.5 where another one fits as well. Poses that differ by
    a symmetry of the model, or between two scans by a motion that neither of them speaks against, are one. 1 where the pose
    alone does not convince."""


@dataclass(frozen=True, eq=False, repr=False)
class RegisteredScans(Result):
    """Scans of one object in the frame of the first one that is kept."""

    transforms: List[Optional[NDArray[np.float64]]]
    """(4, 4) from the frame of each scan to that of the first one that is kept; None where it is left out."""
    confidences: List[float]
    """Of each scan the estimated probability that it fits the others there, in [0, 1]; 0 where it is left out."""
    left_out: Dict[int, str]
    """Why each scan that is left out is, by its index."""
    pairs: List[Tuple[int, int, float, bool]]
    """(source, target, overlap, used): share of the source's points that lie on the target, and whether the registration of
    the two alone agrees with the poses of all."""
    points: NDArray[np.float64]
    """(M, 3) points of all scans that are kept, thinned where they overlap."""
    scans: NDArray[Any]
    """(M,) index of the scan of each point."""
    rows: NDArray[Any]
    """(M,) row of each point in its scan."""
    resolution: float
    """Distance that the scans resolve, input units: of the points in a cube as wide one is kept."""

    def _json(self) -> Dict[str, Any]:
        scans: List[Dict[str, Any]] = []
        for k, transform in enumerate(self.transforms):
            kept = transform is not None and dict(transform=_numbers(transform), confidence=self.confidences[k])
            scans.append(dict(file=f"clouds[{k}]", **(kept or dict(left_out=self.left_out[k]))))
        pairs = [
            dict(source=f"clouds[{source}]", target=f"clouds[{target}]", overlap=overlap, used=used)
            for source, target, overlap, used in self.pairs
        ]
        return dict(scans=scans, pairs=pairs, resolution=self.resolution)

    def __len__(self) -> int:
        return len(self.transforms)

    def __iter__(self) -> Iterator[Optional[NDArray[np.float64]]]:
        """transforms"""
        return iter(self.transforms)

    def __getitem__(self, index: int) -> Optional[NDArray[np.float64]]:
        """The transform of a scan."""
        return self.transforms[index]

    def __repr__(self) -> str:
        scans = [
            f"left out: {self.left_out[k]}" if t is None else f"{_text(t)}, confidence={self.confidences[k]:.3g}"
            for k, t in enumerate(self.transforms)
        ]
        lines = "".join(f"\n  {scan}," for scan in scans)
        return f"RegisteredScans([{lines}\n], pairs={_text(self.pairs)}, points={len(self.points)})"


@dataclass(frozen=True, eq=False, repr=False)
class Registration(Result):
    """The pose of one cloud relative to another."""

    _in_repr = ("transform", "confidence", "converged")
    transform: NDArray[np.float64]
    """(4, 4) from the frame of the source to that of the target; where it did not converge, the best pose that was found."""
    score: PoseScore
    """Of the transform."""
    converged: bool
    """Whether both clouds have 100 points and the confidence is at least 0.5."""
    confidence: float
    """Estimated probability that the transform is right, in [0, 1]."""
    evidence: PoseEvidence
    """What the confidence follows from."""
    reason: str
    """What speaks against the pose; empty where it converged."""
    poses: List[Tuple[NDArray[np.float64], PoseScore]]
    """(transform, score), best first: poses that symmetry makes equal have like merits."""
    covariance: Optional[NDArray[np.float64]]
    """(6, 6) of the small rotation, radians, and translation, input units, by which noise and sampling put the pose off,
    frame of the target; None where no pose was found."""

    def __bool__(self) -> bool:
        return self.converged

    def _json(self) -> Dict[str, Any]:
        found = _picked(self.score, "support conflict")
        found.update(transform=_numbers(self.transform), converged=self.converged, confidence=self.confidence)
        found["evidence"] = self.evidence.to_dict()
        return found if self.converged else {**found, "reason": self.reason}

    @property
    def merit(self) -> float:
        """That of the score."""
        return self.score.merit

    def _moved_between(self, source: NDArray[np.float64], target: NDArray[np.float64]) -> "Registration":
        import numpy as np

        def moved(transform: NDArray[np.float64]) -> NDArray[np.float64]:
            result = _from_moved(transform, source)
            result[:3, 3] += target
            return result

        covariance = self.covariance
        if covariance is not None:
            x, y, z = target
            step = np.eye(6)
            step[3:, :3] = [[0, -z, y], [z, 0, -x], [-y, x, 0]]
            covariance = step @ covariance @ step.T
        poses = [(moved(pose), score) for pose, score in self.poses]
        return dataclasses.replace(self, transform=moved(self.transform), poses=poses, covariance=covariance)


@dataclass(frozen=True, eq=False, repr=False)
class Match(Result):
    """A model that is like a shape."""

    _in_repr = ("name", "distance")
    name: str
    distance: float
    """1 between shapes as far apart as from what is most like them."""


@dataclass(frozen=True, eq=False, repr=False)
class ModelEvidence(Result):
    """What speaks for a model where a scan puts it. Surfaces are one within what the scanner resolves."""

    _in_repr = ("on_model", "shown")
    on_model: float
    """Of the scan's points near the model, the share on its surface, in [0, 1]."""
    shown: float
    """Of the surface of the model that faces the scanner, the share that was measured, in [0, 1]."""


@dataclass(frozen=True, eq=False, repr=False)
class Recognized(Result):
    """A model that a scan shows."""

    _in_repr = ("name", "confidence", "transform")
    name: str
    confidence: float
    """Probability that the scan shows this model."""
    transform: NDArray[np.float64]
    """(4, 4) from the frame of the scan to that of the model."""
    score: PoseScore
    evidence: ModelEvidence
    """What the confidence follows from."""

    def _json(self) -> Dict[str, Any]:
        known = dict(name=self.name, confidence=self.confidence, transform=_numbers(self.transform))
        return {**known, **_picked(self.score, "support conflict")}


@dataclass(frozen=True, eq=False, repr=False)
class BuildReport(Result):
    """What Database.build() did."""

    _in_repr = ("num_added", "failures", "cancelled")
    num_added: int
    """Models that were stored."""
    num_kept: int
    """Models that were stored before, unchanged."""
    failures: List[Tuple[str, str]]
    """(name, reason), in the order of the models."""
    cancelled: bool
    """The progress function returned False."""

    def _json(self) -> Dict[str, Any]:
        failures = [dict(name=name, reason=reason) for name, reason in self.failures]
        return dict(added=self.num_added, kept=self.num_kept, failures=failures)


@dataclass(frozen=True, eq=False, repr=False)
class SceneObject(Result):
    """An object of a scene, and what was found, in the frame of the scene."""

    rows: NDArray[np.int64]
    """(K,) of its points in the flattened scene."""
    planes: Planes
    """As of planes(), plotted with the points of the scene; without point_support()."""
    frame: Optional[Frame]
    """None without scene(frames=True)."""
    completed_by: Optional[ReflectionPlane]
    """The plane that it was completed by: its best one, or through its axis or center and across the view; None where none decides."""
    added: NDArray[np.float32]
    """(M, 3) points that this reflection adds."""
    models: List["Recognized"]
    """Best first; empty without a database, and where the object is unknown."""
    model_reason: str
    """Why no model of the database fits; empty where one does."""

    def __repr__(self) -> str:
        kinds = {name: getattr(self.planes, name) for name in "planes possible axes centers".split()}
        found = "".join(f", {name}={_text([each.confidence for each in all_])}" for name, all_ in kinds.items() if all_)
        models = f", models={[m.name for m in self.models]}" if self.models else ""
        return f"SceneObject(rows={len(self.rows)}{found or ', no symmetry'}, added={len(self.added)}{models})"

    def _json(self) -> Dict[str, Any]:
        found: Dict[str, Any] = dict(
            num_points=len(self.rows),
            planes=[plane._json() for plane in self.planes.every],
            axes=[_picked(axis, "point direction confidence") for axis in self.planes.axes],
            centers=[_picked(center, "point confidence") for center in self.planes.centers],
            models=[
                dict(name=m.name, confidence=m.confidence, merit=m.score.merit, T_model_scene=_numbers(m.transform)) for m in self.models
            ],
            **{name: getattr(self.planes, name) for name in ("tolerance", "resolution", "diameter")},
        )
        if self.frame is not None:
            found["frame"] = _picked(self.frame, "center axes scores revolution_axis transform")
        if self.completed_by is not None:
            found["completed"] = dict(by=self.completed_by.coefficients.tolist(), num_added=len(self.added))
        reasons = dict(reason=self.planes.reason, model_reason=self.model_reason)
        return {**found, **{name: why for name, why in reasons.items() if why}}


@dataclass(frozen=True, eq=False, repr=False)
class Support(Result):
    """A table, floor or wall."""

    _in_repr = ("coefficients",)
    coefficients: NDArray[np.float64]
    """(4,) a, b, c, d; the normal points toward the viewer."""
    rows: NDArray[np.int64]
    """(K,) of its points in the flattened scene."""

    def _json(self) -> Dict[str, Any]:
        return dict(coefficients=self.coefficients.tolist(), num_points=len(self.rows))


@dataclass(frozen=True, eq=False, repr=False)
class Junction(Result):
    """Two pieces that touch, and what symmetry says of them: one object where one symmetry explains both."""

    _in_repr = ("objects", "together", "apart")
    objects: Tuple[int, int]
    """Indices of the objects of the pieces: the same where symmetry joined them."""
    num_points: Tuple[int, int]
    """Of the pieces."""
    together: float
    """Share of their points that the best symmetry of both maps onto them, in [0, 1]; 0 where there is none."""
    apart: float
    """The same, each piece by its own symmetries."""

    def _json(self) -> Dict[str, Any]:
        first, second = self.objects
        return {**super()._json(), "objects": [first + 1, second + 1], "joined": first == second}


@dataclass(frozen=True, eq=False, repr=False)
class Scene(Result):
    """The objects of one frame of a sensor; behaves as the list of its objects."""

    _in_repr = ("objects", "supports")
    objects: List[SceneObject]
    """Most points first."""
    supports: List[Support]
    """In the order in which they were found."""
    junctions: List[Junction]
    plane_distance: float
    """Of points of a supporting plane, that was used, input units."""
    cluster_distance: float
    """Between points of one object, that was used, input units."""
    viewpoint: Optional[NDArray[np.float64]]
    """(3,) where the sensor stood."""
    reason: str
    """Why there is no answer; empty where the search ran."""
    _shape: Tuple[int, ...]
    _viewpoint_from: str

    def _json(self) -> Dict[str, Any]:
        import numpy as np

        found = dict(num_points=int(np.prod(self._shape)), viewpoint=_viewpoint(self))
        names = ("supports", "objects", "junctions", "plane_distance", "cluster_distance")
        found.update({name: _plain(getattr(self, name)) for name in names})
        return {**found, "error": self.reason} if self.reason else found

    @property
    def labels(self) -> NDArray[np.int32]:
        """For each point the object, counted from 1, -1 for supporting planes, 0 for others; of the shape of the points."""
        import numpy as np

        result = np.zeros(int(np.prod(self._shape)), np.int32)
        for support in self.supports:
            result[support.rows] = -1
        for i, each in enumerate(self.objects):
            result[each.rows] = i + 1
        return result.reshape(self._shape)

    def show(self, points: Any) -> Page:
        """A page with the scene, its objects, planes and axes in three dimensions: a notebook shows it.

        points: those of scene().
        """
        from .pages import page_of_scene

        return page_of_scene(self, points)

    def plot(self, points: Any, axes: Any = None) -> Any:
        """Draws the scene, its objects, planes and axes with matplotlib, by default into new axes; returns them.

        points: those of scene().
        """
        from .plots import plot_scene

        return plot_scene(self, points, axes)

    def __len__(self) -> int:
        return len(self.objects)

    def __iter__(self) -> Iterator[SceneObject]:
        return iter(self.objects)

    def __getitem__(self, index: int) -> SceneObject:
        return self.objects[index]

    def _moved(self, shift: NDArray[np.float64]) -> Scene:
        objects = [dataclasses.replace(each._moved(shift), added=each.added + shift) for each in self.objects]
        supports = []
        for support in self.supports:
            coefficients = support.coefficients.copy()
            coefficients[3] -= coefficients[:3] @ shift
            supports.append(dataclasses.replace(support, coefficients=coefficients))
        return dataclasses.replace(super()._moved(shift), objects=objects, supports=supports)


def _show_fields() -> None:
    """Puts the texts behind the fields of results into those of their classes, for help()."""
    import ast

    try:
        with open(__file__, encoding="utf-8") as source:
            body = ast.parse(source.read()).body
    except OSError:  # the package is not in a folder
        return
    for node in body:
        if not isinstance(node, ast.ClassDef) or node.name not in __all__:
            continue
        texts = [
            f"{field.target.id}: {ast.get_docstring(ast.Module([text], []))}"
            for field, text in zip(node.body, node.body[1:])
            if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name) and isinstance(text, ast.Expr)
        ]
        if texts:
            thing = globals()[node.name]
            thing.__doc__ = "\n".join([thing.__doc__, "", "Fields:", *texts])


_show_fields()
