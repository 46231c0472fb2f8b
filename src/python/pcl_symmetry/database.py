"""What needs the libraries of PCL: registration, the database of models, and scenes."""

from __future__ import annotations

import dataclasses
import os
import tempfile
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

from . import _recognition
from .functions import Cloud, Core, NoAnswer, Viewpoint, _frame, _planes_of, left_out, no_answer, opened, prepare, rows_of, warn
from .progress import Progress, shares_of
from .results import (
    BuildReport,
    Junction,
    Match,
    ModelEvidence,
    PoseEvidence,
    PoseScore,
    Recognized,
    ReflectionPlane,
    RegisteredScans,
    Registration,
    Scene,
    SceneObject,
    Shape,
    Support,
    shown,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

core = Core(_recognition)

Path = Union[str, "os.PathLike[str]"]


def register(
    source: Any,
    target: Any,
    *,
    guess: Optional[ArrayLike] = None,
    around: Optional[Tuple[float, float]] = None,
    source_viewpoint: Viewpoint = "auto",
    target_viewpoint: Viewpoint = "auto",
    progress: Progress = None,
    seed: int = 1,
    threads: int = 0,
) -> Registration:
    """The pose of a scan, or a whole object, relative to another cloud of it, from any start (Section 5.1).

    source, target: as points in planes(), same units; 10 000 points of larger ones are used.
    guess: (4, 4), tried beside many other poses; None: the identity.
    around: (radians, input units), how far the pose may be from the guess, for tracks; None: all poses.
    source_viewpoint, target_viewpoint, progress: as in planes().
    Two scans need not show the same part: points that face the surface of the other cloud have to lie on it. A pose whose
    confidence is below 0.5 does not converge, and its reason says what speaks against it. Points that hold no answer, such as
    too few, are warned of (RuntimeWarning): the identity is then returned, and does not converge.
    """
    import numpy as np

    scan, known = prepare("source", source), prepare("target", target)
    source_shift, target_shift = scan.shift, known.shift
    s = np.zeros(3) if source_shift is None else source_shift
    t = np.zeros(3) if target_shift is None else target_shift
    start = np.eye(4) if guess is None else np.array(guess, dtype=float)
    if start.shape == (4, 4):
        start = start.copy()
        start[:3, 3] += start[:3, :3] @ s - t
    viewpoints = dict(source_viewpoint=scan.seen_from(source_viewpoint), target_viewpoint=known.seen_from(target_viewpoint))
    try:
        found = core.register(_camera_points(scan), _camera_points(known), guess=start, around=around, told=progress, seed=seed, threads=threads, **viewpoints)
    except NoAnswer as none:
        no_answer(none)
        return Registration(
            transform=np.eye(4), score=PoseScore(0, 0, 0), converged=False, confidence=0.0, reason=str(none), poses=[],
            evidence=PoseEvidence(0, 0, 0, 0, 0, 0, 0, 0, 0, size_ratio=1, uniqueness=1), covariance=None,
        )  # fmt: skip
    poses = [(pose, PoseScore(**score)) for pose, score in found["poses"]]
    found.update(score=PoseScore(**found["score"]), evidence=PoseEvidence(**found["evidence"]), poses=poses)
    result = Registration(**found)
    return result if source_shift is None and target_shift is None else result._moved_between(s, t)


def register_all(
    clouds: Sequence[Any], *, viewpoint: Viewpoint = "auto", progress: Progress = None, seed: int = 1, threads: int = 0
) -> RegisteredScans:
    """Brings many scans of one object together, such as those of a turntable, without a guess.

    clouds: each as points in planes(), same units; scans that follow each other are tried first.
    viewpoint: as in planes(), in the frame of each scan. progress: as there.
    Scans that fit no others are left out, with the reason. The poses are in the frame of the first scan that is kept.
    Costs about two register() a scan, some tenths of a second of processor time each, where neighbors overlap; scans that fit no
    neighbor are tried with all others, and each refusal takes longer.
    """
    import numpy as np

    if isinstance(clouds, (str, bytes)) or not hasattr(clouds, "__iter__"):
        raise TypeError(f"clouds = {shown(clouds)}, must be a list of clouds")
    arrays, shifts, viewpoints = [], [], []
    for k, cloud in enumerate(clouds):
        scan = prepare(f"clouds[{k}]", cloud)
        arrays.append(_camera_points(scan))
        shifts.append(np.zeros(3) if scan.shift is None else scan.shift)
        viewpoints.append(scan.seen_from(viewpoint))
    found, merged = core.register_all(arrays, viewpoints=viewpoints, told=progress, seed=seed, threads=threads)
    transforms = found["transforms"]
    first = next((k for k, transform in enumerate(transforms) if transform is not None), 0)
    for transform, shift in zip(transforms, shifts):
        if transform is not None:
            transform[:3, 3] += shifts[first] - transform[:3, :3] @ shift
    scans, rows = merged[:, 0], merged[:, 1]
    points = np.zeros((len(merged), 3))
    for k, transform in enumerate(transforms):
        if transform is not None:
            from_scan = arrays[k].reshape(-1, 3)[rows[scans == k]].astype(float) + shifts[k]
            points[scans == k] = from_scan @ transform[:3, :3].T + transform[:3, 3]
    return RegisteredScans(points=points, scans=scans, rows=rows, **found)


class Database:
    """Models in one file, found by shape (Section 5.2).

    Iterates over the names of its models; database[name] is the cloud of one, and an unknown name a KeyError. A context manager, which
    closes the file.
    """

    def __init__(self, file: Path, *, create: bool = False, unit: str = "", threads: int = 0) -> None:
        """Opens a file. create: where it is missing, the first model makes it. unit: of the models, such as "m"; threads: 0 = one per core.

        Raises FileNotFoundError for a missing file without create, ValueError for another unit than the file has, and OSError where it is no database that can be used, or cannot
        be made.
        """
        name = os.fspath(file)
        if name != ":memory:" and not os.path.exists(name):
            if not create:
                raise FileNotFoundError(f"{name}: no such database; create=True makes one")
            try:
                tempfile.TemporaryFile(dir=os.path.dirname(name) or ".").close()
            except OSError as error:
                raise type(error)(f"{name}: cannot be made: {error.strerror}") from None
        self._open: Optional[Any] = Core(core.Database(name, unit=unit, threads=threads), _recognition)
        self._file = name

    @property
    def _core(self) -> Any:
        if self._open is None:
            raise ValueError(f"{self._file}: the database was closed")
        return self._open

    def close(self) -> None:
        """Closes the file; what was stored is on the disk already."""
        self._open = None

    def __enter__(self) -> Database:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    @property
    def names(self) -> List[str]:
        """Names of all models, sorted."""
        return list(self._core.names)

    @property
    def unit(self) -> str:
        """The unit that the database was made with; empty where none was given."""
        return str(self._core.unit)

    def __len__(self) -> int:
        return int(self._core.__len__())

    def __bool__(self) -> bool:
        return True

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and bool(self._core.__contains__(name))

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __getitem__(self, name: str) -> NDArray[np.float32]:
        return self.cloud(name)

    def __repr__(self) -> str:
        return f"Database({self._file!r}, " + ("closed)" if self._open is None else f"models={len(self)})")

    def add(self, name: str, points: Any) -> None:
        """Stores a model, (N, 3) points all around it, a file, or a cloud or mesh of Open3D or trimesh; on the disk on return.

        A model of the same name is replaced.
        """
        self._core.add(name=name, points=_near_origin(points).array)

    def build(
        self,
        models: Union[Mapping[str, Any], Iterable[Tuple[str, Any]]],
        *,
        progress: Union[bool, Callable[[float], Optional[bool]], None] = None,
    ) -> BuildReport:
        """Stores many models, each as soon as it is described, on all threads.

        models: dict of name to points as add() takes them, or pairs of both. A model of the same name in the file is replaced. progress: True shows a bar, a function is called
        with the share done, in [0, 1]; where it returns False the rest is left. A model that cannot be used does not stop
        the others. What is stored when Ctrl-C ends the call stays stored.
        """
        with shares_of(progress) as tell:
            return BuildReport(**self._core.build(_models_of(models), progress=tell))

    def merge(self, files: Sequence[Path]) -> int:
        """Adds all models of other databases, such as parts that several machines built; all of them or none.

        Returns their number. Raises OSError, naming file and reason, where one is missing, damaged or of another version or
        unit, or two have a model of the same name; nothing is changed then.
        """
        return int(self._core.merge([os.fspath(file) for file in files]))

    def remove(self, name: str) -> None:
        """Removes a model. Raises KeyError for an unknown name."""
        self._known(name).remove(name=name)

    def cloud(self, name: str) -> NDArray[np.float32]:
        """(N, 3) points of a model. Raises KeyError for an unknown name."""
        result: NDArray[np.float32] = self._known(name).cloud(name=name)
        return result

    def _known(self, name: str) -> Any:
        if isinstance(name, str) and name not in self and name not in self.names:  # where the index of names is damaged, the core says so
            raise KeyError(name)
        return self._core

    def match(
        self, points: Any, num_nearest: int = 10, *, viewpoint: Viewpoint = "auto", progress: Progress = None
    ) -> List[Match]:
        """The models most like a cloud, in any pose and size, nearest first. points, viewpoint: as in planes().

        Points that hold no answer are warned of (RuntimeWarning) and have none.
        """
        cloud = _near_origin(points)
        try:
            found = self._core.match(_camera_points(cloud), num_nearest=num_nearest, viewpoint=cloud.seen_from(viewpoint), told=progress)
        except NoAnswer as none:
            no_answer(none)
            return []
        return [Match(**m) for m in found]

    def recognize(
        self,
        points: Any,
        *,
        viewpoint: Viewpoint = "auto",
        indices: Optional[ArrayLike] = None,
        min_confidence: float = 0.5,
        progress: Progress = None,
        threads: int = 0,
    ) -> List[Recognized]:
        """The model that a scan shows, in its own size, best first; empty for an unknown object, and, with a warning
        (RuntimeWarning), for points that hold no answer.

        points, viewpoint, indices: as in planes(). min_confidence: least probability of a model that is accepted, in [0, 1].
        """
        cloud = _near_origin(points)
        options = dict(viewpoint=cloud.seen_from(viewpoint), min_confidence=min_confidence, told=progress, threads=threads)
        try:
            found = self._core.recognize(_camera_points(cloud), indices=rows_of(indices, cloud.shape), **options)
        except NoAnswer as none:
            no_answer(none)
            return []
        return [_recognized(m) for m in found]


def _recognized(found: Dict[str, Any]) -> Recognized:
    found.update(score=PoseScore(**found["score"]), evidence=ModelEvidence(**found["evidence"]))
    return Recognized(**found)


def _camera_points(cloud: Cloud) -> NDArray[Any]:
    """(H, W, 3) where the points are the pixels of a camera."""
    return cloud.array.reshape(*cloud.shape, 3) if len(cloud.shape) == 2 else cloud.array


def _models_of(models: Any) -> Iterator[Any]:
    """Pairs of names and points; files, meshes and clouds of other libraries become arrays when they are used."""
    members = ("points", "vertices", "point", "vertex", "__fspath__")
    for pair in models.items() if hasattr(models, "items") else models:
        if isinstance(pair, tuple) and len(pair) == 2 and (isinstance(pair[1], str) or any(hasattr(pair[1], m) for m in members)):
            pair = pair[0], lambda points=pair[1]: _near_origin(points).array
        yield pair


def _near_origin(points: Any) -> Cloud:
    """Points as they are: the frames of models and scans stay those of the arrays."""
    import numpy as np

    cloud = prepare("points", points)
    if cloud.shift is not None and np.nanmax(np.abs(cloud.array)) > 0:  # points at one place have no frame to keep
        raise ValueError("points = coordinates too large for the extent of the points, must be moved near the origin")
    return cloud


def scene(
    points: Any,
    *,
    viewpoint: Viewpoint = "auto",
    ground: Optional[ArrayLike] = None,
    database: Optional[Database] = None,
    max_range: float = 0.0,
    plane_distance: float = 0.0,
    cluster_distance: float = 0.0,
    min_points: int = 300,
    max_points: int = 5_000,
    separate: bool = True,
    frames: bool = True,
    complete: bool = True,
    min_confidence: float = 0.5,
    min_name_confidence: float = 0.5,
    progress: Progress = None,
    seed: int = 1,
    threads: int = 0,
) -> Scene:
    """The objects of one frame of a depth camera or scanner, and their symmetries.

    points: (H, W, 3), the pixels of a camera, see from_depth(), the name of a file, or (N, 3) with the viewpoint that they were
    seen from.
    viewpoint: as in planes(). ground: (4,) a, b, c, d of what the objects stand on, in place of supporting planes that are
    searched for.
    database: names objects by its models that they show, of a confidence of at least min_name_confidence.
    max_range: points at a greater depth are background; plane_distance: of points that belong to a supporting plane;
    cluster_distance: between points of one object. Input units; 0: no background, and from the points.
    min_points: of an object. max_points: of an object that are analyzed.
    separate: cut objects that touch apart where their surface bends inwards, and join pieces that one symmetry explains.
    frames, complete: also the frame of each object, and the points that its symmetry adds.
    min_confidence: least probability of a plane that is called a symmetry.
    Raises ValueError for bad parameters; points of which none is finite, and what looks like one object alone, are warned of
    (RuntimeWarning).
    """
    import numpy as np

    if database is None:
        left_out(scene, locals(), "no database", "min_name_confidence")
    points = opened(points)
    cloud = prepare("points", points)
    if cloud.mesh is not None:
        raise ValueError("points: are a mesh, must be a cloud as a sensor sees it")
    seen_from = cloud.seen_from(viewpoint)
    # A file is seen from where it says, which is the origin where it says nothing.
    if len(cloud.shape) == 1 and not isinstance(points, Shape) and (seen_from is None or isinstance(seen_from, str)):
        raise ValueError("viewpoint: of rows without order must be (x, y, z), where the sensor stood; pixels (H, W, 3) show theirs")
    if not isinstance(database, (Database, type(None))):
        raise TypeError(f"database = {shown(database)}, must be a Database")
    options = core.SceneOptions(
        max_range=max_range,
        plane_distance=plane_distance,
        cluster_distance=cluster_distance,
        min_points=min_points,
        max_points=max_points,
        separate=separate,
        frames=frames,
        complete=complete,
        min_confidence=min_confidence,
        min_name_confidence=min_name_confidence,
        seed=seed,
        threads=threads,
    )
    plane = None if ground is None else np.array(ground, dtype=float)
    if plane is not None and cloud.shift is not None:
        plane[3] += plane[:3] @ cloud.shift
    kept = None if database is None else database._core._asked
    found = core.scene(_camera_points(cloud), viewpoint=seen_from, ground=plane, database=kept, options=options, told=progress)
    reason = found["reason"]
    if reason or found["alone"]:
        alone = f"{found['alone']}; if this is one object, planes() takes it as a whole"
        warn(f"points: {reason or alone}")
    sensor = None if found["seen"] is None else found["seen"].viewpoint
    seen: Dict[str, Any] = dict(viewpoint=sensor, _shape=cloud.shape, _viewpoint_from=found["viewpoint_from"])
    result = Scene(
        objects=[_scene_object(each, seen) for each in found["objects"]],
        supports=[Support(coefficients=c, rows=np.asarray(rows, dtype=np.int64)) for c, rows in found["supports"]],
        junctions=[Junction((a, b), (sizes[0], sizes[1]), *shares) for a, b, sizes, *shares in found["junctions"]],
        plane_distance=found["plane_distance"],
        cluster_distance=found["cluster_distance"],
        reason=reason,
        **seen,
    )
    return result if cloud.shift is None else result._moved(cloud.shift)


def _scene_object(found: Any, seen: Dict[str, Any]) -> SceneObject:
    """seen: what its planes have of the scene."""
    import numpy as np

    rows = np.asarray(found["indices"], dtype=np.int64)
    search, by, frame = found["planes"], found["completed_by"], found["frame"]
    planes = _planes_of(search, Cloud(np.empty((0, 3)), shape=(0,)), quiet=True)
    planes = dataclasses.replace(planes, _rows=rows, _support=[], **seen)
    return SceneObject(
        rows=rows,
        planes=planes,
        frame=None if frame is None else _frame(frame),
        completed_by=None if by is None else ReflectionPlane(by.normal, by.offset),
        added=found["added"],
        models=[_recognized(m) for m in found["models"]],
        model_reason=found["model_reason"],
    )
