"""The functions of pcl_symmetry that need no library of PCL."""

from __future__ import annotations

import re
import warnings
from typing import TYPE_CHECKING, Any, Callable, Dict, List, Optional, Sequence, Tuple, Union

from . import _pcl_symmetry
from .results import (
    Axis,
    Center,
    Frame,
    Map,
    Plane,
    Planes,
    ProbableFrame,
    ReflectionPlane,
    Rotations,
    Symmetrized,
    RotationAxis,
    View,
    _text,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    Shift = Optional[NDArray[np.float64]]


class Core:
    """A module of pybind11; where that lists all its types, the argument that has another one is named."""

    def __init__(self, module: Any) -> None:
        self._module = module

    def __getattr__(self, name: str) -> Any:
        found = getattr(self._module, name)
        return self._named(found) if callable(found) and not isinstance(found, type) else found

    @staticmethod
    def _named(function: Callable[..., Any]) -> Callable[..., Any]:
        def call(*points: Any, **arguments: Any) -> Any:
            try:
                return function(*points, **arguments)
            except ValueError as error:
                raise ValueError(re.sub(r"^num_(threads|parts)\b", r"\1", str(error))) from None
            except TypeError as error:
                if "incompatible function arguments" not in str(error):
                    raise
                raise TypeError(_wrong_argument(str(error), arguments)) from None

        return call


core = Core(_pcl_symmetry)


def _wrong_argument(text: str, arguments: Dict[str, Any]) -> str:
    """Names the first one that does not have the type that a message of pybind11 lists for it."""
    import numpy as np

    types: Dict[str, Any] = {"bool": (bool, np.bool_), "str": str, "int": (int, np.integer), "float": (int, float, np.number)}
    for name, value in arguments.items():
        rule = re.search(rf"\b{name}: (Optional\[)?(?:({'|'.join(types)})\b|numpy\.ndarray\[\S+\[(\d), (\d)\]|Tuple\[(float), float\])", text)
        if not rule or (rule[1] and value is None):
            continue
        _, kind, rows, columns, pair = rule.groups()
        low, high = (0, 2**64) if name in ("seed", "max_points") else (-(2**31), 2**31)
        if kind:
            fits = isinstance(value, types[kind]) and (kind != "int" or low <= value < high)
            words = f"int, {low} to {high - 1}" if kind == "int" else kind
        else:
            shape = (2,) if pair else (int(rows),) if columns == "1" else (int(rows), int(columns))
            try:
                fits = np.asarray(value, dtype=float).shape == shape
            except (TypeError, ValueError):
                fits = False
            words = f"numbers of shape {shape}"
        if not fits:
            return f"{name} = {_text(value)}, must be {words}"
    return " ".join(text.split())


Viewpoint = Union[str, None, "ArrayLike"]
"""Where a scanner stood: "auto" (the points decide), None (seen from all sides) or (x, y, z), input frame."""

_NUM_MESH_POINTS = 10_000


def prepare(name: str, points: Any, num_mesh_points: int = _NUM_MESH_POINTS) -> Tuple["NDArray[Any]", "Shift"]:
    """The points of an array or an object of Open3D or trimesh, and what was subtracted from them, if anything.

    Double coordinates far from the origin are centered before they become float32. Meshes are sampled.
    """
    import numpy as np

    if points is None or isinstance(points, str):
        raise TypeError(f"{name} = {points!r}, must be an array of shape (N, 3), or a cloud or mesh of Open3D or trimesh")
    faces = _faces(points)
    if faces is not None:
        vertices, shift = prepare(name, np.asarray(points.vertices))
        return core.sample_mesh(vertices, faces, num_mesh_points, seed=1), shift
    for member in ("points", "vertices"):
        if not hasattr(points, "__array__") and hasattr(points, member):
            points = getattr(points, member)
    try:
        array = np.asarray(points)
    except ValueError as error:
        raise ValueError(f"{name}: {error}, must be (N, 3)") from None
    if array.ndim == 0 and not isinstance(points, np.ndarray):  # a number, a dict, a generator
        raise TypeError(f"{name} = {type(points).__name__}, must be an array of shape (N, 3)")
    masked: Any = np.ma
    if isinstance(points, masked.MaskedArray) and array.dtype.kind in "fiu":
        array = np.where(masked.getmaskarray(points), np.nan, array)
    if array.ndim != 2 or array.shape[1] != 3 or array.dtype.kind not in "fiu" or not len(array):
        return array, None  # the core says what is wrong
    # A few rows tell how far away the points are; the whole array is looked at only where that is far.
    few = array[:: max(1, len(array) // 64)].astype(float)
    with np.errstate(invalid="ignore"):
        greatest = float(np.nanmax(np.abs(few), initial=0.0))
        if not np.isfinite(greatest) or greatest <= 64 * float(np.nanmax(np.ptp(few, axis=0), initial=0.0)):
            return array, None
    used = array[np.isfinite(array).all(axis=1)].astype(float)
    if not len(used):
        return array, None
    low, high = used.min(axis=0), used.max(axis=0)
    extent, greatest = float(np.linalg.norm(high - low)), float(max(abs(low).max(), abs(high).max()))
    if array.dtype.kind == "f" and array.dtype.itemsize <= 4:
        rounding = float(np.finfo(np.float32).eps) * greatest
        if extent > 0 and rounding > 1e-4 * extent:
            digits = max(0, int(np.floor(np.log10(extent / rounding))))
            warnings.warn(
                f"{name}: float32 coordinates up to {greatest:.4g} leave {digits} digits of an extent of {extent:.4g}; "
                "subtract an offset in float64 before they become float32",
                RuntimeWarning,
                stacklevel=3,
            )
        return array, None
    if greatest <= 64 * extent:
        return array, None
    shift = (low + high) / 2
    return (array - shift).astype(np.float32), shift


def _faces(points: Any) -> Any:
    """Those of a mesh of Open3D or trimesh; None for anything else."""
    faces = getattr(points, "triangles", getattr(points, "faces", None))
    return faces if faces is not None and len(faces) and hasattr(points, "vertices") else None


def _prepare_with_mesh(name: str, points: Any) -> Tuple["NDArray[Any]", "Shift", Any]:
    """As prepare(), and the mesh itself, where symmetries become exact; None for a cloud."""
    import numpy as np

    faces = _faces(points)
    if faces is None:
        return (*prepare(name, points), None)
    vertices, shift = prepare(name, np.asarray(points.vertices))
    return core.sample_mesh(vertices, faces, _NUM_MESH_POINTS, seed=1), shift, core.MeshSurface(vertices, faces)


def _seen_from(viewpoint: Viewpoint, shift: "Shift", name: str = "viewpoint") -> Any:
    import numpy as np

    if viewpoint is None or isinstance(viewpoint, str):
        return viewpoint
    try:
        position = np.asarray(viewpoint, dtype=float)
    except (TypeError, ValueError):
        raise TypeError(f'{name} = {type(viewpoint).__name__}, must be "auto", None or (x, y, z)') from None
    if position.shape != (3,):
        raise ValueError(f'{name} = array of shape {position.shape}, must be "auto", None or (x, y, z)')
    return position if shift is None else position - shift


def _fields(found: Any, *names: str) -> Dict[str, Any]:
    return {name: getattr(found, name) for name in names}


def _plane(p: Any) -> Plane:
    plane = object.__new__(Plane)
    names = ("kind", "confidence", "reasons", "share", "share_interval", "score", "support", "deviation", "seen", "residual")
    for name, value in _fields(p, "normal", "offset", *names).items():
        object.__setattr__(plane, name, value)
    return plane


def _rotation_axis(t: Any) -> RotationAxis:
    return RotationAxis(**_fields(t, "point", "direction", "fold", "confidence", "support", "off"))


def _core_plane(plane: ReflectionPlane, shift: "Shift") -> Any:
    """The plane in the frame of points that prepare() moved."""
    if not isinstance(plane, ReflectionPlane):
        raise TypeError(f"plane = {type(plane).__name__}, must be a ReflectionPlane, such as one of planes()")
    moved = plane if shift is None else plane._moved(-shift)
    return core.ReflectionPlane(moved.normal, moved.offset)


def _planes_of(found: Any, num_rows: int) -> Planes:
    import numpy as np

    scores = ("confidence", "score", "support")
    return Planes(
        planes=[_plane(p) for p in found.planes],
        axes=[Axis(**_fields(a, "point", "direction", *scores)) for a in found.axes],
        centers=[Center(**_fields(c, "point", *scores)) for c in found.centers],
        rotations=[_rotation_axis(t) for t in found.rotations],
        best=None if found.best is None else _plane(found.best),
        evidence=found.evidence,
        rotation_evidence=found.rotation_evidence,
        _support=found.support,
        _rows=np.asarray(found.rows, dtype=np.int64),
        _num_rows=num_rows,
        **_fields(found, "flat", "tolerance", "reason", "viewpoint"),
    )


def planes(
    points: Any = None,
    *,
    volume: Optional["ArrayLike"] = None,
    spacing: "ArrayLike" = (1.0, 1.0, 1.0),
    origin: "ArrayLike" = (0.0, 0.0, 0.0),
    direction: Optional["ArrayLike"] = None,
    levels: Optional[Tuple[float, float]] = None,
    viewpoint: Viewpoint = "auto",
    tolerance: Optional[float] = None,
    absolute_tolerance: float = 0.0,
    approximate: bool = False,
    max_planes: int = 12,
    normals: Optional["ArrayLike"] = None,
    max_points: int = 50_000,
    evidence: bool = False,
    as_published: bool = False,
    method: str = "convolution",
    seed: int = 1,
    threads: int = 0,
) -> Planes:
    """Planes of symmetry of a cloud or of a volume (Sections 4.1 to 4.4).

    points: (N, 3), input units, or a cloud or mesh of Open3D or trimesh; float32 rows are not copied. Rows that are not
        finite are left out. The planes of a mesh are exact: the last step refines on the mesh itself.
    viewpoint: where the scanner stood: "auto" (the points decide), None (seen from all sides) or (x, y, z).
    tolerance: how far a symmetric surface may be off, share of the greatest distance between two points, in (0, 0.1].
        None: 0.01, or what a depth camera or few points resolve, at most 0.03.
    absolute_tolerance: the same in input units; 0: tolerance decides.
    approximate: also the other maxima of the transform, and symmetries of parts.
    normals: (N, 3), of any length and sign; None: estimated.
    max_points: larger clouds are thinned to that number; 0: never. threads: 0 = one per core.
    evidence: also what the decisions are taken from; takes about as long again.
    as_published: refine the maxima of the map as the paper does (Section 4.4), without a decision; only then method, of
        the map: sampled, convolution, rotational or voting. Of the other parameters seed and threads count.
    volume: (I, J, K) in place of points, such as a CT or MR image, first index along the first axis (as nibabel has it;
        arrays of SimpleITK are transposed). spacing, origin, direction: of its voxels, input units and frame; direction
        is (3, 3) with the axes of the grid in columns. levels: (low, high) intensities that count; None: chosen.
        confidence is then 0 for a plane like any other and 1 where both halves are equal, and support a correlation.
        Of the other parameters approximate, max_planes, seed and threads count.
    Raises ValueError for bad parameters.
    """
    import numpy as np

    if (points is None) == (volume is None):
        raise TypeError("planes() takes points or volume")
    if method != "convolution" and not as_published:
        raise ValueError(f"method = {method}, must be convolution without as_published")
    if volume is not None:
        if tolerance is not None or absolute_tolerance or normals is not None or as_published:
            raise ValueError("tolerance, absolute_tolerance, normals, as_published: of points, must be left out with volume")
        return _volume_planes(volume, spacing, origin, direction, levels, approximate, max_planes, seed, threads)
    array, shift, mesh = _prepare_with_mesh("points", points)
    if as_published:
        found = core.published_planes(array, method=method, num_points=10_000, seed=seed, threads=threads)
        result = _planes_of(found, len(array))
        return result if shift is None else result._moved(shift)
    found = core.planes(
        array,
        viewpoint=_seen_from(viewpoint, shift),
        tolerance=tolerance,
        absolute_tolerance=absolute_tolerance,
        approximate=approximate,
        max_planes=max_planes,
        normals=normals,
        max_points=max_points,
        evidence=evidence,
        seed=seed,
        threads=threads,
        mesh=mesh,
    )
    result = _planes_of(found, len(array))
    return result if shift is None else result._moved(shift)


def _volume_planes(
    volume: Any,
    spacing: Any,
    origin: Any,
    direction: Any,
    levels: Optional[Tuple[float, float]],
    approximate: bool,
    max_planes: int,
    seed: int,
    threads: int,
) -> Planes:
    import numpy as np

    array = np.asarray(volume)
    if array.ndim != 3 or array.dtype.kind not in "fiub":
        raise ValueError(f"volume = array of shape {array.shape} and type {array.dtype}, must be (I, J, K), numbers")
    found = core.volume_planes(
        array,
        spacing=spacing,
        origin=origin,
        direction=np.eye(3) if direction is None else direction,
        levels=(0.0, 0.0) if levels is None else levels,
        approximate=approximate,
        max_planes=max_planes,
        seed=seed,
        threads=threads,
    )
    return _planes_of(found, 0)


def local_symmetry(points: Any, scale: float, *, seed: int = 1, threads: int = 0) -> "NDArray[np.float32]":
    """(N,) for each point the greatest D of a plane through it, of the surface within scale (Section 6).

    scale: radius of the window around each point as a share of the radius of the shape, in (0, 1].
    """
    import numpy as np

    if not 0 < scale <= 1:
        raise ValueError(f"scale = {_text(scale)}, must be in (0, 1]")
    array, _ = prepare("points", points)
    return np.asarray(core.local_symmetry(array, scale, seed=seed, threads=threads), dtype=np.float32)


def complete(
    points: Any, plane: ReflectionPlane, *, viewpoint: Viewpoint = "auto", threads: int = 0
) -> Tuple["NDArray[Any]", List[int]]:
    """Completes a scan by its reflection in a plane.

    Returns (added, rows): (M, 3) points that neither fall onto the measured surface nor into space that was seen to be
    empty, and the row of the point that each is the reflection of.
    """
    array, shift = prepare("points", points)
    added, rows = core.complete(array, _core_plane(plane, shift), viewpoint=_seen_from(viewpoint, shift), threads=threads)
    return (added if shift is None else added + shift), list(rows)


def symmetrize(
    points: Any,
    plane: ReflectionPlane,
    half: str = "mean",
    *,
    faces: Optional["ArrayLike"] = None,
    cut: bool = False,
    threads: int = 0,
) -> Symmetrized:
    """The shape that a plane maps onto itself, and the asymmetry of each point.

    points: (N, 3), all finite, or a cloud or mesh of Open3D or trimesh. faces: (F, 3) of a mesh given by its vertices; a mesh
        keeps them. Where faces of both sides do not match, it is its own reflection but for their deviation from the surface.
    half: mean: both halves are the mean of the two sides; left or right: the side that the normal of the plane points away
        from or to, and its reflection.
    cut: cuts a mesh at the plane, and takes one side (of mean the left one) and its reflection: an exact one, with other faces.
    """
    import numpy as np

    own_faces = _faces(points)
    if own_faces is not None:
        points, faces = np.asarray(points.vertices), own_faces
    array, shift = prepare("points", points)
    found = core.symmetrize(array, faces, _core_plane(plane, shift), half, threads)
    result = found.points if shift is None else found.points + shift
    rows, deviation = np.arange(len(array)), found.deviation
    if faces is None:
        rows = np.asarray(found.kept, dtype=np.int64)
        result = np.concatenate([result[rows], plane.reflect(result[rows])])
        rows = np.concatenate([rows, rows])
    elif cut:
        result, faces, rows = core.mirrored_half(found.points, faces, _core_plane(plane, shift), half != "right")
        result, rows, deviation = result if shift is None else result + shift, np.asarray(rows), 0.0
    own = None if faces is None else np.asarray(faces)
    measures = _fields(found, "asymmetry", "mean_asymmetry", "greatest_asymmetry")
    return Symmetrized(points=result, faces=own, rows=rows, deviation=deviation, **measures)


def viewpoints(planes: Union[Planes, Sequence[Plane]]) -> List[View]:
    """Directions from the object to the camera that show the least repetition (Section 5.4), best first."""
    if not all(isinstance(plane, Plane) for plane in planes):
        raise TypeError("planes = other objects, must be Planes or a list of Plane")
    return [View(v.direction, v.score) for v in core.viewpoints([(p.normal, p.score) for p in planes])]


def sample_mesh(vertices: "ArrayLike", faces: "ArrayLike", num_points: int = 10_000, *, seed: int = 1) -> "NDArray[Any]":
    """(num_points, 3) points spread evenly over a mesh of (V, 3) vertices and (F, 3) faces."""
    array, shift = prepare("vertices", vertices)
    points: "NDArray[Any]" = core.sample_mesh(array, faces, num_points, seed=seed)
    return points if shift is None else points + shift


def frame(
    points: Any,
    *,
    viewpoint: Viewpoint = "auto",
    max_points: int = 50_000,
    as_published: bool = False,
    seed: int = 1,
    threads: int = 0,
) -> Frame:
    """Canonical frame of a cloud (Section 5.1). Parameters as in planes(); as_published: the paper's own method."""
    array, shift, mesh = _prepare_with_mesh("points", points)
    seen_from = _seen_from(viewpoint, shift)
    options = dict(max_points=max_points, as_published=as_published, seed=seed, threads=threads)
    found = core.frame(array, viewpoint=seen_from, mesh=None if as_published else mesh, **options)
    result = Frame(
        probable=[ProbableFrame(**_fields(f, "center", "axes", "probability", "revolution_axis")) for f in found.probable],
        rotations=[_rotation_axis(t) for t in found.rotations],
        **_fields(found, "center", "axes", "scores", "revolution_axis", "transform", "equivalent", "evidence"),
    )
    return result if shift is None else result._moved(shift)


def rotations(
    points: Any,
    *,
    tolerance: float = 0.01,
    absolute_tolerance: float = 0.0,
    max_feature: float = 0.15,
    seed: int = 1,
    threads: int = 0,
) -> Rotations:
    """The group of rotations that map a whole object onto itself (Section 6).

    tolerance, absolute_tolerance: as in planes().
    max_feature: share of the surface, such as a screw or a notch, that a symmetry may map off it, in [0, 1].
    Raises ValueError for bad parameters, fewer than 20 distinct points, and points on a line.
    """
    array, shift, mesh = _prepare_with_mesh("points", points)
    found = core.rotations(
        array,
        tolerance=tolerance,
        absolute_tolerance=absolute_tolerance,
        max_feature=max_feature,
        seed=seed,
        threads=threads,
        mesh=mesh,
    )
    names = ("name", "center", "support", "confidence", "fold", "discrete", "continuous", "tolerance")
    result = Rotations(**_fields(found, *names))
    return result if shift is None else result._moved(shift)


def segment(
    points: Any,
    faces: Optional["ArrayLike"] = None,
    *,
    parts: int = 0,
    method: str = "merging",
    depth: int = 3,
    as_published: bool = False,
    progress: Optional[Callable[[float], None]] = None,
    seed: int = 1,
    threads: int = 0,
) -> List[int]:
    """Cuts a surface into parts by its symmetries (Section 5.3).

    points: (N, 3), points of a cloud or vertices of a mesh. faces: (F, 3), or None for a cloud.
    parts: number of parts; 0: the method finds it. method: merging, or the paper's splitting; depth: splits in a row at
    most; as_published: splitting to the letter of the paper. progress: called with the share done, in [0, 1].
    Returns the label of each point or face; -1 for points that were left out. Raises ValueError for an unknown method.
    """
    array, _ = prepare("points", points)
    options = dict(parts=parts, method=method, depth=depth, as_published=as_published, progress=progress)
    return list(core.segment(array, faces, **options, seed=seed, threads=threads))


def describe(points: Any, *, viewpoint: Viewpoint = "auto", seed: int = 1, threads: int = 0) -> "NDArray[np.float32]":
    """(2, K) signatures of unit norm, the same in all poses and sizes (Section 5.2)."""
    array, shift = prepare("points", points)
    result: "NDArray[np.float32]" = core.describe(array, viewpoint=_seen_from(viewpoint, shift), seed=seed, threads=threads)
    return result


def descriptors(
    points: Any, *, input_axes: bool = False, by_equation_1: bool = False, seed: int = 1, threads: int = 0
) -> Tuple["NDArray[np.float32]", "NDArray[np.float32]", "NDArray[np.float32]"]:
    """The descriptors that the paper compares (Section 5.2): PRST and GEDT, (32, 32, 32), and PRSD, (32, 32).

    input_axes: about the center of mass in the axes of the input, as for models aligned by hand; False: in frame().
    by_equation_1: sqrt((1 + D) / 2) in place of sqrt(max(D, 0)). The paper's best distance is descriptor_distance() of PRST
    times that of GEDT.
    """
    import numpy as np

    array, _ = prepare("points", points)
    options = dict(input_axes=input_axes, by_equation_1=by_equation_1, seed=seed, threads=threads)
    prst, prsd, gedt = (np.asarray(values, dtype=np.float32) for values in core.descriptors(array, **options))
    return prst.reshape(32, 32, 32), prsd.reshape(32, 32), gedt.reshape(32, 32, 32)


def descriptor_distance(a: "ArrayLike", b: "ArrayLike", *, of_planes: bool = True) -> float:
    """Distance of two descriptors() of one kind (Section 5.2), arrays of one shape: L2.

    of_planes: PRST or PRSD, whose values count by the size of their bins, sin(theta) along the first axis; False: GEDT.
    Raises ValueError if the shapes differ.
    """
    import numpy as np

    first, second = np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64)
    if first.shape != second.shape:
        raise ValueError(f"a, b: shapes {first.shape} and {second.shape}, must be equal")
    sq_difference = ((first - second) ** 2).reshape(len(first), -1).sum(axis=1)
    theta = (np.arange(len(first)) + 0.5) * np.pi / 2 / len(first)
    return float(np.sqrt(sq_difference @ np.sin(theta) if of_planes else sq_difference.sum()))


def transform(
    points: Any,
    bins: Sequence[int] = (64, 64, 64),
    *,
    method: str = "sampled",
    center: "ArrayLike" = (0.0, 0.0, 0.0),
    radius: float = 0.0,
    sigma: float = 0.0,
    as_published: bool = False,
    seed: int = 1,
    threads: int = 0,
) -> Map:
    """The planar-reflective symmetry transform (Section 4). bins: of theta, phi and r.

    method: sampled, convolution, rotational or voting; as_published: near pairs of points vote like all others (Section 4.3).
    center, radius: of the ball whose planes are measured, input frame and units; radius 0: the bounding ball of the points.
    sigma: width of the Gaussian, input units; 0: two cells of a grid of 64.
    """
    import numpy as np

    sizes = np.asarray(bins)
    if sizes.shape != (3,) or sizes.dtype.kind not in "iu":
        raise TypeError(f"bins = {_text(bins)}, must be three whole numbers, of theta, phi and r")
    array, shift = prepare("points", points)
    options = dict(center=_seen_from(center, shift, "center"), radius=radius, sigma=sigma, as_published=as_published)
    found = core.transform(array, sizes.tolist(), method=method, seed=seed, threads=threads, **options)
    result = Map(**_fields(found, "sigma", "center", "radius", "values"))
    return result if shift is None else result._moved(shift)
