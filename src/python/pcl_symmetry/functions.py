"""The functions of pcl_symmetry that need no library of PCL."""

from __future__ import annotations

import dataclasses
import os
import re
import sys
import warnings
from typing import TYPE_CHECKING, Any, Callable, Dict, List, NamedTuple, Optional, Sequence, Tuple, Union

from . import _pcl_symmetry
from .progress import Progress, shares_of, telling
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
    Shape,
    View,
    shown,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    Shift = Optional[NDArray[np.float64]]


def warn(text: str) -> None:
    """A RuntimeWarning at the line outside the package that called it."""
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and frame.f_globals.get("__name__", "").startswith(f"{__package__}."):
        frame, level = frame.f_back, level + 1
    warnings.warn(text, RuntimeWarning, stacklevel=level)


class Core:
    """A module of pybind11, or an object of it; where that lists all its types, the argument that has another one is named."""

    def __init__(self, asked: Any, module: Any = None) -> None:
        self._asked, self._module = asked, module or asked

    def __getattr__(self, name: str) -> Any:
        found = getattr(self._asked, name)
        return self._named(found) if callable(found) else found

    def _named(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """The function; its parameter told is progress of the package's functions."""

        def call(*points: Any, told: Progress = None, **arguments: Any) -> Any:
            try:
                with telling(self._module, told):
                    return function(*points, **arguments)
            except ValueError as error:
                named = re.sub(r"^num_(threads|parts|cells|samples)\b", r"\1", str(error))
                raise ValueError(re.sub(r"^num_(theta|phi|r)\b", r"bins of \1", named)) from None
            except TypeError as error:
                if not re.search("incompatible (function|constructor) arguments", str(error)):
                    raise
                raise _wrong_argument(str(error), arguments) from None

        return call


core = Core(_pcl_symmetry)


def _wrong_argument(text: str, arguments: Dict[str, Any]) -> Exception:
    """Names the first one that a message of pybind11 lists another type for; a ValueError where only size or shape is wrong."""
    import numpy as np

    types: Dict[str, Any] = {"bool": (bool, np.bool_), "str": str, "int": (int, np.integer), "float": (int, float, np.number)}
    for name, value in arguments.items():
        rule = re.search(rf"\b{name}: (Optional\[)?(?:({'|'.join(types)})\b|numpy\.ndarray\[\S+\[(\d), (\d)\]|Tuple\[(float), float\])", text)
        if not rule or (rule[1] and value is None):
            continue
        _, kind, rows, columns, pair = rule.groups()
        low, high = (0, 2**64) if name in ("seed", "max_points") else (-(2**31), 2**31)
        if kind:
            error = ValueError if isinstance(value, types[kind]) else TypeError
            fits = error is ValueError and (kind != "int" or low <= value < high)
            words = f"int, {low} to {high - 1}" if kind == "int" else kind
        else:
            shape = (2,) if pair else (int(rows),) if columns == "1" else (int(rows), int(columns))
            try:
                error, fits = ValueError, np.asarray(value, dtype=float).shape == shape
            except (TypeError, ValueError):
                error, fits = TypeError, False
            words = f"numbers of shape {shape}"
        if not fits:
            return error(f"{name} = {shown(value)}, must be {words}")
    return TypeError(" ".join(text.split("Invoked with:")[0].split()))


Viewpoint = Union[str, None, "ArrayLike"]
"""Where a scanner stood: "auto" (the points decide), None (seen from all sides) or (x, y, z), input frame."""

_NUM_MESH_POINTS = 10_000
_EXTENSIONS = (".pcd", ".ply", ".off", ".obj", ".stl", ".xyz", ".pts", ".asc", ".txt", ".csv")


class Cloud(NamedTuple):
    """The points that a function was given."""

    array: NDArray[Any]
    """(N, 3); of a mesh those that were spread over it."""
    shift: Shift = None
    """What was subtracted from them, if anything."""
    shape: Tuple[int, ...] = ()
    """(H, W) of an organized array, which became rows; else (N,)."""
    mesh: Any = None
    """(vertices, faces) in the frame of the array; None for a cloud."""
    stored: Any = None
    """The viewpoint of a Shape of read(), input frame, or None."""

    def surface(self) -> Any:
        """The mesh as the core has it, on which symmetries become exact."""
        return None if self.mesh is None else core.MeshSurface(*self.mesh)

    def seen_from(self, viewpoint: Viewpoint) -> Any:
        """The viewpoint as the core takes it; "auto" is that of the file, where there is one."""
        is_auto = isinstance(viewpoint, str) and viewpoint == "auto"
        if is_auto and self.mesh is not None:
            return None  # points spread evenly over a mesh have no density to infer one from
        if is_auto and self.stored is not None:
            return core.StoredViewpoint(self.stored if self.shift is None else self.stored - self.shift)
        position = _seen_from(viewpoint, self.shift)
        if not isinstance(position, (str, type(None))) and (why := core.why_not_seen_from(self.array, position)):
            warn(f"points: {why}")
        return position


def prepare(name: str, points: Any, num_mesh_points: int = _NUM_MESH_POINTS) -> Cloud:
    """The points of an array, a file or an object of Open3D or trimesh.

    Double coordinates far from the origin are centered before they become float32. Meshes are sampled.
    """
    import numpy as np

    points = opened(points)
    positions, faces = parts_of(name, points)
    if faces is not None:
        vertices, shift = _near_origin(name, positions)
        sampled = core.sample_mesh(vertices, faces, num_mesh_points, seed=1)
        return Cloud(sampled, shift, (len(sampled),), (vertices, np.asarray(faces)))
    array, shift = _near_origin(name, positions.reshape(-1, 3) if positions.ndim == 3 and positions.shape[2] == 3 else positions)
    return Cloud(array, shift, positions.shape[: max(1, positions.ndim - 1)], stored=points.viewpoint if isinstance(points, Shape) else None)


def of_vertices(name: str, points: Any) -> Cloud:
    """The same with the vertices of a mesh in place of points on it: answers about single points then name the vertices."""
    points = opened(points)
    return prepare(name, dataclasses.replace(points, faces=points.faces[:0]) if isinstance(points, Shape) else parts_of(name, points)[0])


def parts_of(name: str, points: Any) -> Tuple[NDArray[Any], Any]:
    """Points or vertices as an array, and the faces of a mesh, None for a cloud."""
    import numpy as np

    points = opened(points)
    if points is None or isinstance(points, bytes):
        raise TypeError(f"{name} = {shown(points)}, must be an array of shape (N, 3), a cloud or mesh of Open3D or trimesh, or the name of a file")
    if isinstance(points, Shape):
        return points.points, points.faces if len(points.faces) else None
    faces = None
    for member, positions in (("point", "positions"), ("vertex", "positions"), ("points", ""), ("vertices", "")):
        found = None if hasattr(points, "__array__") else getattr(points, member, None)
        found = getattr(found, positions, None) if positions else found
        if found is None:
            continue
        if member == "vertex":  # of a mesh of open3d.t
            faces = getattr(getattr(points, "triangle", None), "indices", None)
        elif member == "vertices":
            faces = getattr(points, "triangles", getattr(points, "faces", None))
        points = found
        break
    faces = None if faces is None or not len(faces) else _array(faces)
    try:
        array = _array(points)
    except ValueError:  # rows of different lengths
        raise ValueError(f"{name} = {shown(points)}, must be (N, 3), Shape(points, faces) for a mesh") from None
    if array.ndim == 0 and not isinstance(points, np.ndarray):  # a number, a dict, a generator
        raise TypeError(f"{name} = {type(points).__name__}, must be an array of shape (N, 3)")
    if array.ndim in (2, 3) and array.shape[-1] != 3:
        raise ValueError(f"{name} = array of shape {array.shape}, must be (N, 3){_how_to_reshape(name, array.shape)}")
    masked: Any = np.ma
    if isinstance(points, masked.MaskedArray) and array.dtype.kind in "fiu":
        array = np.where(masked.getmaskarray(points), np.nan, array)
    return array, faces


def _how_to_reshape(name: str, shape: Tuple[int, ...]) -> str:
    if len(shape) == 3:
        return " or (H, W, 3)" + (f": {name}[..., :3] leaves out what else each pixel has" if shape[2] > 3 else "")
    if shape[0] == 3:
        return f": {name}.T"
    if 3 < shape[1] < 16:
        return f": {name}[:, :3] leaves out what else each point has"
    return "; from_depth() makes points of a depth image" if min(shape) >= 16 else ""


def _array(values: Any) -> NDArray[Any]:
    import numpy as np

    if type(values).__module__.startswith("open3d") and hasattr(values, "cpu"):
        values = values.cpu().numpy()  # a tensor, maybe of a graphics card
    return np.asarray(values)


def _near_origin(name: str, array: NDArray[Any]) -> Tuple[NDArray[Any], Shift]:
    import numpy as np

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
            warn(
                f"{name}: float32 coordinates up to {greatest:.4g} leave {digits} digits of an extent of {extent:.4g}; "
                "subtract an offset in float64 before they become float32"
            )
        return array, None
    if greatest <= 64 * extent:
        return array, None
    shift = (low + high) / 2
    return (array - shift).astype(np.float32), shift


class Used(NamedTuple):
    """The points that an analysis uses, and what a scanner saw of them."""

    array: NDArray[Any]
    viewpoint: Any
    """As the core takes it: "auto", None, a position, or what the pixels of an organized array show."""
    viewpoint_from: str
    """given, rays or inferred, where there is one."""
    rows: Any = None
    """(M,) rows of the array that was given; None: the core selects them."""
    may_be_rings: bool = False
    reason: str = ""
    """Why there is no answer; of selected rows only."""


def look(
    cloud: Cloud,
    viewpoint: Viewpoint,
    indices: Optional[ArrayLike] = None,
    ground: Optional[ArrayLike] = None,
    max_points: int = 50_000,
    as_measured: bool = False,
    seed: int = 1,
    threads: int = 0,
) -> Used:
    """What the classes for PCL select of an organized array, of a part of a scene, and of what stands on a ground."""
    import numpy as np

    seen_from = cloud.seen_from(viewpoint)
    if cloud.mesh is not None and indices is not None:
        raise ValueError("indices: must be left out with a mesh")
    if len(cloud.shape) == 1 and indices is None and ground is None:
        known = "given" if isinstance(seen_from, (np.ndarray, type(None))) else "inferred" if isinstance(seen_from, str) else "stored"
        return Used(cloud.array, seen_from, known)
    plane = None
    if ground is not None:
        plane = np.array(ground, dtype=float)
        if plane.shape == (4,) and cloud.shift is not None:
            plane[3] += plane[:3] @ cloud.shift
    points, rows, seen, viewpoint_from, may_be_rings, reason = _pcl("organized arrays, indices and ground").look(
        cloud.array.reshape(*cloud.shape, 3) if len(cloud.shape) == 2 else cloud.array,
        rows_of(indices, cloud.shape),
        viewpoint=seen_from,
        ground=plane,
        max_points=max_points,
        as_measured=as_measured,
        seed=seed,
        threads=threads,
    )
    if ground is not None and seen is None and not reason:
        warn("ground: has no effect without a viewpoint")
    return Used(points, seen, viewpoint_from, rows, may_be_rings, re.sub("^input cloud: ", "", reason))


def _pcl(what: str) -> Core:
    try:
        from . import _recognition
    except ImportError:
        raise ValueError(f"{what}: of a module that was built with PCL") from None
    return Core(_recognition)


def opened(points: Any) -> Any:
    """What a file holds in place of its name."""
    return read(points) if isinstance(points, (str, os.PathLike)) else points


def read(file: Union[str, "os.PathLike[str]"]) -> Shape:
    """What a file holds: PCD, PLY, OFF, OBJ, STL, or text with a point on each line. Functions take its name as well.

    Points keep their order, and those of PCD and PLY their viewpoint. Of a mesh they are its vertices, and functions sample it.
    Other readers drop rows that are not finite, and with them the rows and columns of a camera, and the viewpoint: Open3D needs
    read_point_cloud(file, remove_nan_points=False) and the reshape to (H, W, 3).
    Raises OSError where the file cannot be read, and ValueError, naming it, where it is no such file or is damaged.
    """
    import numpy as np

    name = os.fspath(file)
    extension = os.path.splitext(name)[1].lower()
    if extension not in _EXTENSIONS:
        others = "trimesh.load() reads other meshes, and from_depth() takes the pixels of a depth image"
        raise ValueError(f"{name}: unknown extension '{extension}', must be {', '.join(_EXTENSIONS[:-1])} or {_EXTENSIONS[-1]}; {others}")
    with open(name, "rb") as file_of_points:
        points, faces, viewpoint = _pcl("reading files").read(name, file_of_points.read(), extension)
    return Shape(points, np.array(faces, dtype=np.int32).reshape(-1, 3), viewpoint)


def rows_of(indices: Optional[ArrayLike], shape: Tuple[int, ...]) -> Optional[List[int]]:
    """Of a mask of the shape of the points, or of row numbers."""
    import numpy as np

    if indices is None:
        return None
    chosen = np.asarray(indices)
    if chosen.dtype == bool:
        if chosen.shape != shape:
            raise ValueError(f"indices = mask of shape {chosen.shape}, must be {shape}, as the points")
        chosen = np.flatnonzero(chosen)
    if chosen.ndim != 1 or (chosen.dtype.kind not in "iu" and chosen.size):
        raise ValueError(f"indices = array of shape {chosen.shape} and type {chosen.dtype}, must be rows (K,) or a mask")
    return [int(row) for row in chosen]


def _seen_from(viewpoint: Viewpoint, shift: Shift, name: str = "viewpoint") -> Any:
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


def plane_of(plane: Union[ReflectionPlane, ArrayLike]) -> ReflectionPlane:
    """A plane, also of its coefficients."""
    import numpy as np

    if isinstance(plane, ReflectionPlane):
        return plane
    if isinstance(plane, Planes) or np.shape(plane) != (4,):
        raise TypeError(f"plane = {type(plane).__name__}, must be a plane, such as planes()[0], or (4,) a, b, c, d")
    *normal, d = np.asarray(plane, dtype=float)
    return ReflectionPlane(normal, -d)


def _core_plane(plane: ReflectionPlane, shift: Shift) -> Any:
    """The plane in the frame of points that prepare() moved."""
    moved = plane if shift is None else plane._moved(-shift)
    return core.ReflectionPlane(moved.normal, moved.offset)


def _warn_of_stray(count: int) -> None:
    if count:
        warn(f"points: {count} stray, far from all others, left out")


def _planes_of(found: Dict[str, Any], cloud: Cloud, used: Optional[Used] = None, judged: bool = True, quiet: bool = False) -> Planes:
    """judged: only symmetries are in the list. quiet: whoever asked is not warned of what has no answer."""
    import numpy as np

    every = [Plane(**p) for p in found["planes"]]
    reason = used.reason if used is not None and used.reason else found["reason"]
    if reason and not quiet:
        warn(reason if reason.startswith("volume") else f"points: {reason}")
    if not quiet:
        _warn_of_stray(found["stray_points"])
    found.update(
        planes=[p for p in every if not judged or p.kind == "symmetry"],
        possible=[p for p in every if p.kind == "possible"],
        approximate=[p for p in every if judged and p.kind in ("approximate", "local")],
        axes=[Axis(**a) for a in found["axes"]],
        centers=[Center(**c) for c in found["centers"]],
        rotations=[RotationAxis(**r) for r in found["rotations"]],
        best=None if found["best"] is None else Plane(**found["best"]),
        samples=None if cloud.mesh is None else cloud.array if cloud.shift is None else cloud.array + cloud.shift,
        reason=reason,
        _rows=np.asarray(found["_rows"] if used is None or used.rows is None else used.rows, dtype=np.int64),
        _shape=cloud.shape,
        _viewpoint_from="none" if found["viewpoint"] is None or used is None else used.viewpoint_from,
    )
    return Planes(**found)


def planes(
    points: Any = None,
    *,
    volume: Optional[ArrayLike] = None,
    spacing: ArrayLike = (1.0, 1.0, 1.0),
    origin: ArrayLike = (0.0, 0.0, 0.0),
    direction: Optional[ArrayLike] = None,
    levels: Optional[Tuple[float, float]] = None,
    viewpoint: Viewpoint = "auto",
    indices: Optional[ArrayLike] = None,
    ground: Optional[ArrayLike] = None,
    tolerance: Optional[float] = None,
    absolute_tolerance: float = 0.0,
    min_confidence: float = 0.5,
    approximate: bool = False,
    max_planes: int = 128,
    normals: Optional[ArrayLike] = None,
    max_points: int = 50_000,
    evidence: bool = False,
    as_published: bool = False,
    method: str = "convolution",
    progress: Progress = None,
    seed: int = 1,
    threads: int = 0,
) -> Planes:
    """Planes of symmetry of a cloud or of a volume (Sections 4.1 to 4.4): a list of symmetries, empty where there is none.

    points: (N, 3), input units, the name of a file, see read(), or a cloud or mesh of Open3D or trimesh; float32 rows are not copied.
        (H, W, 3): the pixels of a depth camera, see from_depth(), whose rays show what it saw. Rows that are not finite are left out. The planes of a
        mesh are exact: the last step refines on the mesh itself.
    viewpoint: where the scanner stood: "auto" (the file, or the points decide), None (seen from all sides) or (x, y, z).
    indices: the object is a part of the points, its scene: rows (K,), or a mask of the shape of the points, such as
        labels == 3. The other points hide it, and it stands on them.
    ground: (4,) a, b, c, d of the plane a x + b y + c z + d = 0 that the object stands on; with a viewpoint, sparse points of
        a LiDAR are then decided by the box around them.
    tolerance: how far a symmetric surface may be off, share of the greatest distance between two points, in (0, 0.1].
        None: 0.01, or what a depth camera or few points resolve, at most 0.03.
    absolute_tolerance: the same in input units; 0: tolerance decides.
    min_confidence: least probability of a plane that is called a symmetry.
    approximate: also the other maxima of the transform, and symmetries of parts.
    normals: as the points, of any length and sign; None: estimated.
    max_points: larger clouds are thinned to that number; 0: never. threads: 0 = one per core.
    evidence: also what the decisions are taken from; takes about as long again.
    as_published: refine the maxima of the map as the paper does (Section 4.4), without a decision: all planes are in the
        list; only then method, of the map: sampled, convolution, rotational or voting. Of the other parameters seed and
        threads count; the rest is refused.
    progress: True shows a bar, a function is called with the share of the running step that is done, in [0, 1].
    volume: (I, J, K) in place of points, such as a CT or MR image, first index along the first axis (as nibabel has it;
        arrays of SimpleITK are transposed). spacing, origin, direction: of its voxels, input units and frame; direction
        is (3, 3) with the axes of the grid in columns. levels: (low, high) intensities that count; None: chosen.
        confidence is then 0 for a plane like any other and 1 where both halves are equal, and support a correlation.
        Of the other parameters approximate, max_planes, seed and threads count; the rest is refused.
    Raises ValueError for bad parameters; points that hold no answer, such as too few, and whole frames are warned of (RuntimeWarning).
    """
    import numpy as np

    given = locals()
    _check_one_of("planes", points, volume)
    if method != "convolution" and not as_published:
        raise ValueError(f"method = {method if isinstance(method, str) else shown(method)}, must be convolution without as_published")
    of_decision = "viewpoint indices ground tolerance absolute_tolerance min_confidence normals max_points evidence"
    if volume is not None:
        left_out(planes, given, "volume", of_decision + " as_published")
        options = dict(approximate=approximate, max_planes=max_planes, seed=seed, threads=threads)
        found = core.volume_planes(_volume(volume, spacing, origin, direction, levels), told=progress, **options)
        return _planes_of(found, Cloud(np.empty((0, 3)), shape=(0,)))
    _check_no_volume(planes, given)
    cloud = prepare("points", points)
    if cloud.mesh is not None:
        left_out(planes, given, "a mesh", "normals")
    if absolute_tolerance:
        left_out(planes, given, "absolute_tolerance", "tolerance")
    if viewpoint is None:
        left_out(planes, given, "viewpoint None", "ground")
    if as_published:
        left_out(planes, given, "as_published", of_decision + " approximate max_planes")
        found = core.published_planes(cloud.array, method=method, num_points=10_000, told=progress, seed=seed, threads=threads)
        result = _planes_of(found, cloud, judged=False)
        return result if cloud.shift is None else result._moved(cloud.shift)
    used = look(cloud, viewpoint, indices, ground, max_points, seed=seed, threads=threads)
    if normals is not None:
        normals = parts_of("normals", normals)[0].reshape(-1, 3) if len(cloud.shape) == 2 else normals
        normals = normals if used.rows is None else parts_of("normals", normals)[0][used.rows]
    found = core.planes(
        used.array,
        viewpoint=used.viewpoint,
        tolerance=tolerance,
        absolute_tolerance=absolute_tolerance,
        min_confidence=min_confidence,
        approximate=approximate,
        max_planes=max_planes,
        normals=normals,
        max_points=max_points,
        evidence=evidence,
        told=progress,
        seed=seed,
        threads=threads,
        mesh=cloud.surface(),
        may_be_rings=used.may_be_rings,
    )
    result = _planes_of(found, cloud, used)
    has_symmetry = result.planes or result.axes or result.centers or result.rotations or result.reason
    if len(cloud.shape) == 2 and indices is None and result.viewpoint is not None and not has_symmetry:
        warn("points: no symmetry; if this is a whole frame, scene() finds its objects")
    if result.undecided and result.best is not None:
        low, high = result.best.share_interval
        warn(f"points: they leave it open, a share of {low:.2f} to {high:.2f} for the best plane")
    return result if cloud.shift is None else result._moved(cloud.shift)


def _check_one_of(function: str, points: Any, volume: Any) -> None:
    if (points is None) == (volume is None):
        raise TypeError(f"{function}() takes points or volume")


def _check_no_volume(function: Callable[..., Any], given: Dict[str, Any]) -> None:
    names = "spacing origin levels direction"
    if _not_default(function, given, names):
        raise ValueError(f"{names.replace(' ', ', ')}: of a volume, must be left out with points")


def _not_default(function: Callable[..., Any], given: Dict[str, Any], names: str) -> List[str]:
    import numpy as np

    defaults: Dict[str, Any] = function.__kwdefaults__
    return [name for name in names.split() if not np.array_equal(given[name], defaults[name])]


def left_out(function: Callable[..., Any], given: Dict[str, Any], beside: str, names: str) -> None:
    """Refuses parameters that would do nothing beside another one: those of the names that do not have their default."""
    if idle := _not_default(function, given, names):
        raise ValueError(f"{', '.join(idle)}: must be left out with {beside}")


def faces_of(own: Any, faces: Any) -> Any:
    """The faces of a mesh, or those that are given beside vertices."""
    if own is not None and faces is not None:
        raise ValueError("faces: must be left out with a mesh, which has its own")
    return faces if own is None else own


def _volume(volume: Any, spacing: Any, origin: Any, direction: Any, levels: Optional[Tuple[float, float]]) -> Any:
    import numpy as np

    array = np.asarray(volume)
    if array.ndim != 3 or array.dtype.kind not in "fiub":
        raise ValueError(f"volume = array of shape {array.shape} and type {array.dtype}, must be (I, J, K), numbers")
    placed = dict(spacing=spacing, origin=origin, direction=np.eye(3) if direction is None else direction)
    return core.volume(array, levels=(0.0, 0.0) if levels is None else levels, **placed)


def local_symmetry(
    points: Any = None,
    scale: float = 1.0,
    *,
    volume: Optional[ArrayLike] = None,
    spacing: ArrayLike = (1.0, 1.0, 1.0),
    origin: ArrayLike = (0.0, 0.0, 0.0),
    direction: Optional[ArrayLike] = None,
    levels: Optional[Tuple[float, float]] = None,
    at: Optional[ArrayLike] = None,
    progress: Progress = None,
    seed: int = 1,
    threads: int = 0,
) -> NDArray[np.float32]:
    """(N,) for each point the greatest D of a plane through it, of the shape within scale (Section 6).

    points: as in planes(); of a mesh the values of its vertices are returned, of an organized array (H, W) values. Rows that
    are not finite have NaN.
    scale: radius of the window around each point as a share of the radius of the shape, in (0, 1].
    Time grows with the number of points, about 2 ms each on one core, and up to twice that at scale 1. D is estimated from
    samples: it may exceed 1 by up to a tenth.
    volume, spacing, origin, direction, levels: as in planes(), with at: (N, 3) the positions, input frame.
    """
    import numpy as np

    given = locals()
    _check_one_of("local_symmetry", points, volume)
    if not 0 < scale <= 1:
        raise ValueError(f"scale = {shown(scale)}, must be in (0, 1]")
    if (volume is None) != (at is None):
        raise TypeError("at: positions in a volume, must be given with volume and left out with points")
    cloud: Any = None
    if volume is None:
        _check_no_volume(local_symmetry, given)
        cloud = prepare("points", points)
        shape, positions = cloud.array, cloud.array if cloud.mesh is None else cloud.mesh[0]
    else:
        shape, positions = _volume(volume, spacing, origin, direction, levels), parts_of("at", at)[0]
    result = np.full(len(positions), np.nan, np.float32)
    try:
        values = core.local_symmetry(shape, positions, scale=scale, told=progress, seed=seed, threads=threads)
        result[np.isfinite(positions).all(axis=1)] = values
    except NoAnswer as none:
        no_answer(none)
    return result.reshape(cloud.shape) if cloud and cloud.mesh is None else result


def complete(
    points: Any,
    plane: Union[ReflectionPlane, Axis, Center, ArrayLike, None] = None,
    *,
    viewpoint: Viewpoint = "auto",
    indices: Optional[ArrayLike] = None,
    threads: int = 0,
) -> Tuple[NDArray[Any], NDArray[np.int64]]:
    """Completes a scan by its reflection in a plane.

    points, viewpoint, indices: as in planes(); of a mesh its vertices. plane: a symmetry, or a possible one, of planes(); any
    other is refused, unless it comes as its coefficients, (4,) a, b, c, d of a x + b y + c z + d = 0. Of a body of revolution
    its Axis, of a ball its Center: the plane through it and across the view is taken. None: what planes() finds, with its warnings.
    Returns (added, rows). added: (M, 3) points that neither fall onto the measured surface nor into space that was seen to be
    empty. rows: (M,) the row of the point that each is the reflection of: added is plane.reflect(points.reshape(-1, 3)[rows]).
    Warns (RuntimeWarning) where nothing is added, and where the plane is only possible, with its confidence.
    """
    import numpy as np

    cloud = of_vertices("points", points)
    if plane is None:
        search = planes(points, viewpoint=viewpoint, indices=indices, threads=threads)
        if not (found_by := [*search.centers, *search.axes, *search, *search.possible]):
            if not search.reason:
                warn("points: no symmetry, nothing is added")
            return np.empty((0, 3), np.float32), np.empty(0, np.int64)
        plane = found_by[0]
    if isinstance(plane, Plane) and plane.kind not in ("symmetry", "possible"):
        raise ValueError(
            f"plane.kind = {plane.kind}, must be symmetry or possible; plane.coefficients are taken as they are"
        )
    used = look(cloud, viewpoint, indices, max_points=0, as_measured=True, threads=threads)
    by = axis = None
    if isinstance(plane, (Axis, Center)):
        point = plane.point if cloud.shift is None else plane.point - cloud.shift
        axis = (point, plane.direction if isinstance(plane, Axis) else None)
    else:
        by = _core_plane(plane_of(plane), cloud.shift)
    added, found = core.complete(used.array, by, axis=axis, viewpoint=used.viewpoint, threads=threads)
    rows = np.asarray(found, dtype=np.int64)
    if used.rows is not None:
        rows = np.asarray(used.rows, dtype=np.int64)[rows]
    doubt = ""
    if isinstance(plane, Plane) and plane.kind == "possible":
        doubt = f" across a plane that is only possible, of confidence {plane.confidence:.2f}"
    if doubt or not len(added):
        finite = np.isfinite(used.array).all(axis=1).any()
        why = used.reason or ("their reflections fall onto the points or into space seen to be empty" if finite else "no finite point")
        warn(f"points: {len(added)} are added{doubt}" + ("" if len(added) else f": {why}"))
    return (added if cloud.shift is None else added + cloud.shift), rows


def symmetrize(
    points: Any,
    plane: Union[ReflectionPlane, ArrayLike],
    half: str = "mean",
    *,
    faces: Optional[ArrayLike] = None,
    cut: bool = False,
    threads: int = 0,
) -> Symmetrized:
    """The shape that a plane maps onto itself, and the asymmetry of each point.

    points: as in planes(); rows of a cloud that are not finite are left out, and their asymmetry is NaN. faces: (F, 3) of a mesh
        given by its vertices; a mesh keeps them. Where faces of both sides do not match, it is its own reflection but for their
        deviation from the surface.
    plane: of planes(), or (4,) a, b, c, d of a x + b y + c z + d = 0.
    half: mean: both halves are the mean of the two sides; left or right: the side that the normal of the plane points away
        from or to, and its reflection.
    cut: cuts a mesh at the plane, and takes one side (of mean the left one) and its reflection: an exact one, with other faces.
    """
    import numpy as np

    given = locals()
    plane = plane_of(plane)
    points, own_faces = parts_of("points", points)
    faces = faces_of(own_faces, faces)
    if faces is None:
        left_out(symmetrize, given, "a cloud", "cut")
    array, shift, *_ = prepare("points", points)
    found = core.symmetrize(array, faces, _core_plane(plane, shift), half=half, threads=threads)
    moved, kept = found.pop("points"), found.pop("kept")
    result, rows = moved if shift is None else moved + shift, np.arange(len(array))
    if faces is None:
        rows = np.asarray(kept, dtype=np.int64)
        result = np.concatenate([result[rows], plane.reflect(result[rows])])
        rows = np.concatenate([rows, rows])
    elif cut:
        result, faces, rows = core.mirrored_half(moved, faces, _core_plane(plane, shift), half != "right")
        result, rows, found["deviation"] = result if shift is None else result + shift, np.asarray(rows), 0.0
    return Symmetrized(points=result, faces=None if faces is None else np.asarray(faces), rows=rows, **found)


def viewpoints(
    points: Any,
    *,
    number: int = 4,
    up: ArrayLike = (0.0, 0.0, 1.0),
    separation: float = 0.7,
    worst: bool = False,
    seed: int = 1,
    threads: int = 0,
) -> List[View]:
    """Directions from the object to the camera that show the least repetition (Section 5.4), best first.

    points: as in planes(), whose planes(approximate=True) are looked for. Planes, or a list of Plane, are taken as they are: the
        object is then unknown, so that no view hides some of it or has a pose; seed and threads do nothing.
    number: of views at most, >= 1. separation: angle between them, and from each other's mirror images, radians, in [0, pi].
    up: direction that is about up; views are from above, and cameras stand upright along the nearest principal symmetry axis.
    worst: the worst view alone in place of the good ones.
    Points that hold no answer are warned of (RuntimeWarning) and have none.
    """
    import numpy as np

    if number < 1:
        raise ValueError(f"number = {number}, must be >= 1")
    cloud: Any = None
    given = points = opened(points)
    if not isinstance(points, Planes) and not (isinstance(points, (list, tuple)) and all(isinstance(each, Plane) for each in points)):
        cloud = prepare("points", points)
        given = planes(points, approximate=True, seed=seed, threads=threads)
        if given.reason:
            return []
    every = given.every if isinstance(given, Planes) else sorted(given, key=lambda plane: bool(plane.kind != "symmetry"))
    axes, maxima = (given.axes, given._maxima) if isinstance(given, Planes) else ([], [])
    found = _pcl("viewpoints()").views(
        planes=[(p.normal, p.score) for p in every],
        num_symmetries=sum(p.kind == "symmetry" for p in every),
        axes=[(a.direction, a.score) for a in axes],
        maxima=maxima,
        points=None if cloud is None else cloud.array,
        up=up,
        number=number,
        separation=separation,
        worst=worst,
    )
    shift = np.zeros(3) if cloud is None or cloud.shift is None else cloud.shift
    to_input = np.eye(4)
    to_input[:3, 3] = shift
    return [View(direction, score, None if cloud is None else to_input @ pose) for direction, score, pose in found]


class Merging(_pcl_symmetry.Merging):
    """Small patches of a mesh, and the merges that make parts of them."""

    def __init__(self, points: ArrayLike, faces: Any, *, seed: int = 1, threads: int = 0) -> None:
        """points: (V, 3) vertices. faces: (F, 3), or lists of indices of vertices, three or more each."""
        core._named(super().__init__)(parts_of("points", points)[0], faces, seed=seed, threads=threads)


def sample_mesh(
    vertices: Any, faces: Optional[ArrayLike] = None, num_points: int = 10_000, *, seed: int = 1
) -> NDArray[Any]:
    """(num_points, 3) points spread evenly over a mesh of (V, 3) vertices and (F, 3) faces, or of a file, Open3D or trimesh."""
    if isinstance(faces, int):
        raise TypeError(f"faces = {faces}, must be (F, 3); num_points={faces} is a number of points")
    positions, own_faces = parts_of("vertices", vertices)
    faces = faces_of(own_faces, faces)
    if faces is None:
        raise TypeError("faces = None, must be (F, 3), or vertices a mesh of a file, Open3D or trimesh")
    array, shift, *_ = prepare("vertices", positions)
    points: NDArray[Any] = core.sample_mesh(array, faces, num_points=num_points, seed=seed)
    return points if shift is None else points + shift


def from_depth(depth: ArrayLike, intrinsics: ArrayLike, *, unit: float = 1.0) -> NDArray[np.float32]:
    """(H, W, 3) points of a depth image in the frame of the camera: x to the right, y down, z forward.

    depth: (H, W), along the optical axis; 0 and values that are not finite are missing, and become NaN.
    intrinsics: (3, 3) matrix of the camera, (fx, fy, cx, cy), pixels, or intrinsics of Open3D.
    unit: of the depths, such as 0.001 where they are millimeters and points are to be in meters.
    """
    import numpy as np

    if isinstance(depth, (str, bytes, os.PathLike)):
        raise TypeError(f"depth = {shown(depth)}, must be (H, W), numbers; PIL.Image.open() and open3d.io.read_image() read files")
    z = np.asarray(depth)
    if z.ndim != 2 or z.dtype.kind not in "fiu":
        raise ValueError(f"depth = array of shape {z.shape} and type {z.dtype}, must be (H, W), numbers")
    if not (np.isfinite(unit) and unit > 0):
        raise ValueError(f"unit = {unit}, must be > 0")
    if z.dtype.kind != "f" and unit == 1.0:
        warn("depth: whole numbers are taken as they are; unit=0.001 makes meters of millimeters")
    k = np.asarray(getattr(intrinsics, "intrinsic_matrix", intrinsics), dtype=float)
    if k.shape == (3, 3):
        k = k[[0, 1, 0, 1], [0, 1, 2, 2]]
    size = getattr(intrinsics, "height", -1), getattr(intrinsics, "width", -1)  # those of Open3D, -1 where it knows none
    if min(size) > 0 and size != z.shape:
        raise ValueError(f"depth = array of shape {z.shape}, must be {size}, that of the intrinsics")
    if k.shape != (4,) or not np.isfinite(k).all() or not (k[:2] > 0).all():
        raise ValueError(f"intrinsics = {shown(intrinsics)}, must be (3, 3) or (fx, fy, cx, cy), fx and fy > 0")
    z = np.where(np.isfinite(z) & (z > 0), z, np.nan) * unit
    v, u = np.indices(z.shape)
    points: NDArray[np.float32] = np.stack([(u - k[2]) / k[0] * z, (v - k[3]) / k[1] * z, z], axis=2).astype(np.float32)
    return points


NoAnswer = _pcl_symmetry.NoAnswer
"""Raised by the core, once all parameters are checked, for points that hold no answer."""


def no_answer(found: Exception, reason: str = "") -> str:
    """Why points hold no answer; whoever asked for one is warned of it. reason: of selected rows."""
    name, why = str(found).split(": ", 1)
    warn(f"{name}: {reason or why}")
    return reason or why


def _no_frame(reason: str) -> Frame:
    import numpy as np

    nothing = np.full((3, 3), np.nan)
    return Frame(
        center=nothing[0], axes=nothing, revolution_axis=-1, scores=nothing[0], transform=np.full((4, 4), np.nan),
        equivalent=np.empty((0, 4, 4)), rotations=[], probable=[], evidence=np.empty(0), stray_points=0, reason=reason,
    )  # fmt: skip


def frame(
    points: Any,
    *,
    viewpoint: Viewpoint = "auto",
    indices: Optional[ArrayLike] = None,
    ground: Optional[ArrayLike] = None,
    max_points: int = 50_000,
    as_published: bool = False,
    progress: Progress = None,
    seed: int = 1,
    threads: int = 0,
) -> Frame:
    """Canonical frame of a cloud (Section 5.1). Parameters as in planes(); as_published: the paper's own method."""
    if as_published:
        left_out(frame, locals(), "as_published", "viewpoint ground")
    elif viewpoint is None:
        left_out(frame, locals(), "viewpoint None", "ground")
    cloud = prepare("points", points)
    used = look(cloud, viewpoint, indices, ground, max_points, as_published, seed, threads)
    options = dict(max_points=max_points, as_published=as_published, told=progress, seed=seed, threads=threads)
    try:
        found = core.frame(used.array, viewpoint=used.viewpoint, mesh=None if as_published else cloud.surface(), **options)
    except NoAnswer as none:
        return _no_frame(no_answer(none, used.reason))
    _warn_of_stray(found["stray_points"])
    result = _frame(found)
    return result if cloud.shift is None else result._moved(cloud.shift)


def _frame(found: Dict[str, Any]) -> Frame:
    found["probable"] = [ProbableFrame(**f) for f in found["probable"]]
    found["rotations"] = [RotationAxis(**r) for r in found["rotations"]]
    return Frame(reason="", **found)


def rotations(
    points: Any,
    *,
    tolerance: float = 0.01,
    absolute_tolerance: float = 0.0,
    max_feature: float = 0.15,
    progress: Progress = None,
    seed: int = 1,
    threads: int = 0,
) -> Rotations:
    """The group of rotations that map a whole object onto itself (Section 6).

    points, tolerance, absolute_tolerance, progress: as in planes().
    max_feature: share of the surface, such as a screw or a notch, that a symmetry may map off it, in [0, 1].
    Points that show no surface at the tolerance, as solid samples, atoms and few points do, have a reason in place of a
    group, with the least tolerance at which they do; a group that takes points to points is found all the same. So have scans
    from one side, whose axes planes() finds: what they hide would be taken for empty.
    Raises ValueError for bad parameters; every reason is warned of (RuntimeWarning), as of fewer than 20 distinct points.
    """
    import numpy as np

    if absolute_tolerance:
        left_out(rotations, locals(), "absolute_tolerance", "tolerance")
    cloud = prepare("points", points)
    used = look(cloud, "auto", max_points=0, as_measured=True, seed=seed, threads=threads)
    options = dict(tolerance=tolerance, absolute_tolerance=absolute_tolerance, max_feature=max_feature, seed=seed, threads=threads)
    try:
        found = core.rotations(cloud.array, viewpoint=used.viewpoint, told=progress, mesh=cloud.surface(), **options)
    except NoAnswer as none:
        nothing: Dict[str, Any] = dict(support=0.0, confidence=0.0, fold=1, continuous=[], tolerance=0.0, stray_points=0)
        return Rotations(name="", center=np.full(3, np.nan), discrete=np.empty((0, 4, 4)), reason=no_answer(none), **nothing)
    result = Rotations(**found.fields)
    _warn_of_stray(result.stray_points)
    if result.reason:
        warn(f"points: {result.reason}")
    return result if cloud.shift is None else result._moved(cloud.shift)


def segment(
    points: Any,
    faces: Optional[ArrayLike] = None,
    *,
    parts: int = 0,
    method: str = "merging",
    depth: int = 3,
    as_published: bool = False,
    progress: Progress = None,
    seed: int = 1,
    threads: int = 0,
) -> NDArray[np.int32]:
    """Cuts a surface into parts by its symmetries (Section 5.3).

    points: as in planes(), or the vertices of a mesh. faces: (F, 3), or None for a cloud.
    parts: number of parts, 0: the method finds it; a RuntimeWarning says why there is another number. method: merging, or the
    paper's splitting; depth: splits in a row at most; as_published: splitting to the letter of the paper. progress: as in
    planes(), of the whole.
    Returns the label of each point or face; -1 for points that were left out. Raises ValueError for an unknown method.
    """
    import numpy as np

    if method == "merging":
        left_out(segment, locals(), "method merging", "depth as_published")
    if parts:
        left_out(segment, locals(), "parts", "depth")
    positions, own_faces = parts_of("points", points)
    faces = faces_of(own_faces, faces)
    cloud = prepare("points", positions)
    options = dict(parts=parts, method=method, depth=depth, as_published=as_published, seed=seed, threads=threads)
    try:
        with shares_of(progress) as tell:
            found, reason = core.segment(cloud.array, faces, progress=tell, **options)
    except NoAnswer as none:
        no_answer(none)
        return np.full(cloud.shape, -1, np.int32)
    if reason:
        warn(re.sub("^num_parts", "parts", reason))
    labels = np.asarray(found, dtype=np.int32)
    return labels.reshape(cloud.shape) if faces is None else labels


def describe(
    points: Any, *, viewpoint: Viewpoint = "auto", progress: Progress = None, seed: int = 1, threads: int = 0
) -> NDArray[np.float32]:
    """(2, K) signatures of unit norm, the same in all poses and sizes (Section 5.2); (0, 0) for too few points."""
    import numpy as np

    cloud = prepare("points", points)
    used = look(cloud, viewpoint, max_points=0, as_measured=True, seed=seed, threads=threads)
    try:
        result: NDArray[np.float32] = core.describe(
            used.array, viewpoint=used.viewpoint, told=progress, seed=seed, threads=threads
        )
    except NoAnswer as none:
        no_answer(none, used.reason)
        result = np.empty((0, 0), np.float32)
    return result


def descriptors(
    points: Any,
    *,
    viewpoint: Viewpoint = "auto",
    input_axes: bool = False,
    by_equation_1: bool = False,
    progress: Progress = None,
    seed: int = 1,
    threads: int = 0,
) -> Tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]:
    """The descriptors that the paper compares (Section 5.2): PRST, (32, 32, 32), PRSD, (32, 32), and GEDT, (32, 32, 32).

    viewpoint: as in planes(). input_axes: about the center of mass in the axes of the input, as for models aligned by
    hand; False: in frame(). by_equation_1: sqrt((1 + D) / 2) in place of sqrt(max(D, 0)). The paper's best distance is
    descriptor_distance() of PRST times that of GEDT. All are empty for too few points.
    """
    import numpy as np

    if input_axes:
        left_out(descriptors, locals(), "input_axes", "viewpoint")
    used = look(prepare("points", points), viewpoint, max_points=0, as_measured=True, seed=seed, threads=threads)
    options = dict(viewpoint=used.viewpoint, input_axes=input_axes, by_equation_1=by_equation_1, seed=seed, threads=threads)
    try:
        found = core.descriptors(used.array, told=progress, **options)
    except NoAnswer as none:
        no_answer(none, used.reason)
        return np.empty((0, 0, 0), np.float32), np.empty((0, 0), np.float32), np.empty((0, 0, 0), np.float32)
    prst, prsd, gedt = (np.asarray(values, dtype=np.float32) for values in found)
    return prst.reshape(32, 32, 32), prsd.reshape(32, 32), gedt.reshape(32, 32, 32)


def descriptor_distance(a: ArrayLike, b: ArrayLike, *, of_planes: bool = True) -> float:
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
    points: Any = None,
    bins: Sequence[int] = (64, 64, 64),
    *,
    volume: Optional[ArrayLike] = None,
    spacing: ArrayLike = (1.0, 1.0, 1.0),
    origin: ArrayLike = (0.0, 0.0, 0.0),
    direction: Optional[ArrayLike] = None,
    levels: Optional[Tuple[float, float]] = None,
    method: str = "sampled",
    center: ArrayLike = (0.0, 0.0, 0.0),
    radius: float = 0.0,
    sigma: float = 0.0,
    cells: int = 64,
    samples: int = 0,
    refined_share: float = 1.0,
    as_published: bool = False,
    progress: Progress = None,
    seed: int = 1,
    threads: int = 0,
) -> Map:
    """The planar-reflective symmetry transform (Section 4). bins: of theta, phi and r.

    method: sampled, convolution, rotational or voting; as_published: near pairs of points vote like all others (Section 4.3).
    center, radius: of the ball whose planes are measured, input frame and units; radius 0: the bounding ball of the points.
    sigma: width of the Gaussian, input units; 0: two cells. cells: of its grid along each side, in [8, 512].
    samples: points of sampled (0: 128), pairs of voting (0: two million). refined_share: of rotational, multiresolution: planes
        with this share of the greatest D are computed finely, the others coarsely, in [0, 1].
    volume, spacing, origin, direction, levels: as in planes(), in place of points; sigma is then left out.
    Points that hold no answer are warned of (RuntimeWarning): the map is then empty, with a reason.
    """
    import numpy as np

    given = locals()
    _check_one_of("transform", points, volume)
    sizes = np.asarray(bins)
    if sizes.shape != (3,) or sizes.dtype.kind not in "iu":
        raise TypeError(f"bins = {shown(bins)}, must be three whole numbers, of theta, phi and r")
    shape: Any = None
    shift: Any = None
    for names, methods in (("samples", "sampled voting"), ("refined_share", "rotational"), ("as_published", "voting")):
        if method not in methods.split():
            left_out(transform, given, f"method {method}", names)
    if not radius:
        left_out(transform, given, "radius 0", "center")
    if volume is None:
        _check_no_volume(transform, given)
        shape, shift, *_ = prepare("points", points)
    elif sigma:
        raise ValueError("sigma: of points, must be left out with volume")
    else:
        shape = _volume(volume, spacing, origin, direction, levels)
    options = dict(center=_seen_from(center, shift, "center"), radius=radius, sigma=sigma, as_published=as_published)
    options.update(cells=cells, samples=samples, refined_share=refined_share)
    try:
        found = core.transform(shape, sizes.tolist(), method=method, told=progress, seed=seed, threads=threads, **options)
    except NoAnswer as none:
        nothing = np.empty((0, 0, 0), np.float32)
        return Map(sigma=0.0, center=np.full(3, np.nan), radius=0.0, values=nothing, reason=no_answer(none))
    result = Map(sigma=found.sigma, center=found.center, radius=found.radius, values=found.values)
    return result if shift is None else result._moved(shift)
