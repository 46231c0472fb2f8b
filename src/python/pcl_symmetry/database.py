"""What needs the libraries of PCL: registration and the database of models."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Callable, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

from . import _recognition
from .functions import Core, Viewpoint, _fields, _seen_from, prepare
from .results import BuildReport, Match, PoseScore, Recognized, RegisteredScans, Registration

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

core = Core(_recognition)

Path = Union[str, "os.PathLike[str]"]


def _score(score: Any) -> PoseScore:
    return PoseScore(score.support, score.conflict, score.merit)


def register(
    source: Any,
    target: Any,
    *,
    guess: Optional["ArrayLike"] = None,
    around: Optional[Tuple[float, float]] = None,
    source_viewpoint: Viewpoint = "auto",
    target_viewpoint: Viewpoint = "auto",
    seed: int = 1,
    threads: int = 0,
) -> Registration:
    """The pose of a scan, or a whole object, relative to another cloud of it, from any start (Section 5.1).

    source, target: (N, 3) and (M, 3), same units, or clouds or meshes of Open3D or trimesh.
    guess: (4, 4), tried beside many other poses; None: the identity.
    around: (radians, input units), how far the pose may be from the guess, for tracks; None: all poses.
    source_viewpoint, target_viewpoint: as in planes().
    With thousands of points, poses of a wrong object have a merit below 0.32, those of the right one 0.5 or more. Points
    too few to tell do not converge: fewer than 100, or where less than 45 % of them lie on the surface of the other cloud.
    """
    import numpy as np

    points, source_shift = prepare("source", source)
    model, target_shift = prepare("target", target)
    s = np.zeros(3) if source_shift is None else source_shift
    t = np.zeros(3) if target_shift is None else target_shift
    start = np.eye(4) if guess is None else np.array(guess, dtype=float)
    if start.shape == (4, 4):
        start = start.copy()
        start[:3, 3] += start[:3, :3] @ s - t
    found = core.register(
        points,
        model,
        guess=start,
        around=around,
        source_viewpoint=_seen_from(source_viewpoint, source_shift),
        target_viewpoint=_seen_from(target_viewpoint, target_shift),
        seed=seed,
        threads=threads,
    )
    result = Registration(
        score=_score(found.score),
        poses=[(pose, _score(score)) for pose, score in found.poses],
        **_fields(found, "transform", "converged", "on_surface", "covariance"),
    )
    return result if source_shift is None and target_shift is None else result._moved_between(s, t)


def register_all(
    clouds: Sequence[Any], *, viewpoint: Viewpoint = "auto", seed: int = 1, threads: int = 0
) -> RegisteredScans:
    """Brings many scans of one object together, such as those of a turntable, without a guess.

    clouds: each (N, 3), same units, or clouds of Open3D; scans that follow each other are tried first.
    viewpoint: as in planes(), in the frame of each scan.
    Scans that fit no others are left out, with the reason. The poses are in the frame of the first scan that is kept.
    """
    import numpy as np

    arrays, shifts = [], []
    for k, cloud in enumerate(clouds):
        array, shift = prepare(f"clouds[{k}]", cloud)
        arrays.append(array)
        shifts.append(np.zeros(3) if shift is None else shift)
    viewpoints = [_seen_from(viewpoint, shift) for shift in shifts]
    found, merged = core.register_all(arrays, viewpoints=viewpoints, seed=seed, threads=threads)
    transforms, left_out, pairs = found.transforms, found.left_out, found.pairs
    first = next((k for k, transform in enumerate(transforms) if transform is not None), 0)
    for transform, shift in zip(transforms, shifts):
        if transform is not None:
            transform[:3, 3] += shifts[first] - transform[:3, :3] @ shift
    scans, rows = merged[:, 0], merged[:, 1]
    points = np.zeros((len(merged), 3))
    for k, transform in enumerate(transforms):
        if transform is not None:
            from_scan = arrays[k][rows[scans == k]].astype(float) + shifts[k]
            points[scans == k] = from_scan @ transform[:3, :3].T + transform[:3, 3]
    return RegisteredScans(transforms=transforms, left_out=left_out, pairs=pairs, points=points, scans=scans, rows=rows)


class Database:
    """Models in one file, found by shape (Section 5.2).

    Iterates over the names of its models; database[name] is the cloud of one. A context manager, which closes the file.
    """

    def __init__(self, file: Path, *, create: bool = False, unit: str = "", threads: int = 0) -> None:
        """Opens a file. create: makes it where it is missing. unit: of the models, such as "m"; threads: 0 = one per core.

        Raises FileNotFoundError for a missing file without create, and OSError where it is no database that can be used.
        """
        name = os.fspath(file)
        if not create and name != ":memory:" and not os.path.exists(name):
            raise FileNotFoundError(f"{name}: no such database; create=True makes one")
        self._open: Optional[Any] = core.Database(name, unit=unit, threads=threads)
        self._file = name

    @property
    def _core(self) -> Any:
        if self._open is None:
            raise ValueError(f"{self._file}: the database was closed")
        return self._open

    def close(self) -> None:
        """Closes the file; what was stored is on the disk already."""
        self._open = None

    def __enter__(self) -> "Database":
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    @property
    def names(self) -> List[str]:
        """Names of all models, sorted."""
        return list(self._core.names)

    def __len__(self) -> int:
        return len(self._core)

    def __bool__(self) -> bool:
        return True

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and name in self._core

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __getitem__(self, name: str) -> "NDArray[np.float32]":
        if name not in self:
            raise KeyError(name)
        return self.cloud(name)

    def __repr__(self) -> str:
        return f"Database({self._file!r}, " + ("closed)" if self._open is None else f"models={len(self)})")

    def add(self, name: str, points: Any) -> None:
        """Stores a model, (N, 3) points all around it; on the disk on return."""
        self._core.add(name, _near_origin(points))

    def build(
        self,
        models: Union[Mapping[str, Any], Iterable[Tuple[str, Any]]],
        *,
        progress: Optional[Callable[[float], Optional[bool]]] = None,
    ) -> BuildReport:
        """Stores many models, each as soon as it is described, on all threads.

        models: dict of name to (N, 3) points, or pairs of both. progress: called with the share done, in [0, 1]; where it
        returns False the rest is left. A model that cannot be used does not stop the others.
        """
        return BuildReport(**_fields(self._core.build(models, progress=progress), "num_added", "num_kept", "failures", "cancelled"))

    def merge(self, files: Sequence[Path]) -> int:
        """Adds all models of other databases, such as parts that several machines built; all of them or none.

        Returns their number. Raises OSError, naming file and reason, where one is missing, damaged or of another version or
        unit, or two have a model of the same name; nothing is changed then.
        """
        return int(self._core.merge([os.fspath(file) for file in files]))

    def remove(self, name: str) -> None:
        """Removes a model."""
        self._core.remove(name)

    def cloud(self, name: str) -> "NDArray[np.float32]":
        """(N, 3) points of a model."""
        result: "NDArray[np.float32]" = self._core.cloud(name)
        return result

    def match(self, points: Any, num_nearest: int = 10, *, viewpoint: Viewpoint = "auto") -> List[Match]:
        """The models most like a cloud, in any pose and size, nearest first."""
        found = self._core.match(_near_origin(points), num_nearest, viewpoint=viewpoint)
        return [Match(m.name, m.distance) for m in found]

    def recognize(
        self, points: Any, *, viewpoint: Viewpoint = "auto", min_confidence: float = 0.5, threads: int = 0
    ) -> List[Recognized]:
        """The model that a scan shows, in its own size, best first; empty for an unknown object.

        min_confidence: least probability of a model that is accepted, in [0, 1].
        """
        found = self._core.recognize(
            _near_origin(points), viewpoint=viewpoint, min_confidence=min_confidence, threads=threads
        )
        return [Recognized(m.name, m.confidence, m.transform, _score(m.score)) for m in found]


def _near_origin(points: Any) -> Any:
    """Points as they are: the frames of models and scans stay those of the arrays."""
    array, shift = prepare("points", points)
    if shift is not None:
        raise ValueError("points = coordinates too large for the extent of the points, must be moved near the origin")
    return array
