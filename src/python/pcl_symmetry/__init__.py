"""Symmetry of 3D shapes from point clouds.

>>> import numpy, pcl_symmetry
>>> cloud = numpy.random.default_rng(1).normal(size=(4000, 3))
>>> cloud /= numpy.abs(cloud).max(axis=1, keepdims=True)  # the surface of a cube
>>> found = pcl_symmetry.planes((cloud * (1.0, 0.8, 0.5)).astype("float32"))
>>> [plane.kind for plane in found]
['symmetry', 'symmetry', 'symmetry']
"""

import importlib.util
from typing import TYPE_CHECKING, Any, List

from ._pcl_symmetry import Merging as Merging
from ._pcl_symmetry import __version__ as __version__
from .functions import (
    complete,
    describe,
    descriptor_distance,
    descriptors,
    frame,
    local_symmetry,
    planes,
    rotations,
    sample_mesh,
    segment,
    symmetrize,
    transform,
    viewpoints,
)
from .results import (
    Axis,
    BuildReport,
    Center,
    Frame,
    Map,
    Match,
    Plane,
    Planes,
    PoseScore,
    ProbableFrame,
    Profile,
    Recognized,
    ReflectionPlane,
    RegisteredScans,
    Registration,
    Rotations,
    Symmetrized,
    RotationAxis,
    View,
)

if TYPE_CHECKING:
    from .database import Database, register, register_all

__all__ = [
    "Axis",
    "BuildReport",
    "Center",
    "Frame",
    "Map",
    "Match",
    "Merging",
    "Plane",
    "Planes",
    "PoseScore",
    "ProbableFrame",
    "Profile",
    "Recognized",
    "ReflectionPlane",
    "RegisteredScans",
    "Registration",
    "Rotations",
    "Symmetrized",
    "RotationAxis",
    "View",
    "complete",
    "describe",
    "descriptor_distance",
    "descriptors",
    "frame",
    "local_symmetry",
    "planes",
    "rotations",
    "sample_mesh",
    "segment",
    "symmetrize",
    "transform",
    "viewpoints",
]
# The libraries of PCL take longer to load than the rest: what needs them is loaded when it is first used. It is missing where
# the library was built without PCL.
if importlib.util.find_spec("._recognition", __name__):
    __all__ += ["Database", "register", "register_all"]


def __getattr__(name: str) -> Any:
    if name not in ("Database", "register", "register_all") or name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from . import database

    globals().update(Database=database.Database, register=database.register, register_all=database.register_all)
    return globals()[name]


def __dir__() -> List[str]:
    return sorted(__all__ + ["__all__", "__doc__", "__file__", "__name__", "__path__", "__version__"])
