"""Symmetry of 3D shapes from point clouds.

>>> import numpy, pcl_symmetry
>>> cloud = numpy.random.default_rng(1).normal(size=(4000, 3))
>>> cloud /= numpy.abs(cloud).max(axis=1, keepdims=True)  # the surface of a cube
>>> found = pcl_symmetry.planes((cloud * (1.0, 0.8, 0.5)).astype("float32"))
>>> [plane.kind for plane in found]
['symmetry', 'symmetry', 'symmetry']

Each has a help of its own, such as help(pcl_symmetry.planes):

planes()               planes, axes and centers of a cloud, mesh, scan, depth image or volume
scene()                the objects of one frame of a depth camera, each with its symmetry and completion
from_depth()           points (H, W, 3) of a depth image
read()                 points of a file, with their viewpoint; all functions take its name as well
frame()                center of symmetry and principal symmetry axes
rotations()            the group of rotations that map an object onto itself
register()             the pose of a scan relative to a model, without a guess; register_all(): of many scans
complete()             what the reflection of a scan adds
symmetrize()           a shape with equal halves, and its asymmetry
segment()              parts of a cloud or mesh
Database               models in a file: similar ones, and the one that a scan shows
transform()            the symmetry of all planes; local_symmetry(): of each point
viewpoints()           views that show little repetition
describe()             signatures of a shape; descriptors(), descriptor_distance(): those of the paper
sample_mesh()          points on a mesh

What they return has one, too: help(pcl_symmetry.Planes), Plane, Axis, Frame, Rotations, Registration, Scene, SceneObject.
"""

import importlib.util
from typing import TYPE_CHECKING, Any, List

from ._pcl_symmetry import __version__ as __version__
from .functions import Merging as Merging
from .functions import (
    complete,
    describe,
    descriptor_distance,
    descriptors,
    frame,
    from_depth,
    local_symmetry,
    planes,
    read,
    rotations,
    sample_mesh,
    segment,
    symmetrize,
    transform,
    viewpoints,
)
from .results import *
from .results import __all__ as _RESULTS

if TYPE_CHECKING:
    from .database import Database, register, register_all, scene

# What they return is public, too, but left out here: help(pcl_symmetry) would show 1800 lines of it before the functions.
__all__ = [
    "planes",
    "scene",
    "from_depth",
    "read",
    "frame",
    "rotations",
    "register",
    "register_all",
    "complete",
    "symmetrize",
    "segment",
    "Database",
    "transform",
    "local_symmetry",
    "viewpoints",
    "describe",
    "descriptors",
    "descriptor_distance",
    "sample_mesh",
]
# The libraries of PCL take longer to load than the rest: what needs them is loaded when it is first used. It is missing where
# the library was built without PCL.
_OF_PCL = ["scene", "register", "register_all", "Database"]
if not importlib.util.find_spec("._recognition", __name__):
    __all__ = [name for name in __all__ if name not in _OF_PCL]


def __getattr__(name: str) -> Any:
    if name not in _OF_PCL or name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from . import database

    globals().update({each: getattr(database, each) for each in _OF_PCL})
    return globals()[name]


def __dir__() -> List[str]:
    return sorted([*__all__, *_RESULTS, "Merging", "__all__", "__doc__", "__file__", "__name__", "__path__", "__version__"])
