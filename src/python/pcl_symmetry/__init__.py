"""Symmetry of 3D shapes from point clouds.

>>> import numpy, pcl_symmetry
>>> cloud = numpy.random.default_rng(1).normal(size=(4000, 3))
>>> cloud /= numpy.abs(cloud).max(axis=1, keepdims=True)  # the surface of a cube
>>> found = pcl_symmetry.planes((cloud * (1.0, 0.8, 0.5)).astype("float32"))
>>> [plane.kind for plane in found]
['symmetry', 'symmetry', 'symmetry']
"""

from ._pcl_symmetry import (
    Axis,
    Center,
    Frame,
    Map,
    Plane,
    Planes,
    ProbableFrame,
    ReflectionPlane,
    Rotations,
    Turn,
    View,
    __version__,
    complete,
    describe,
    frame,
    planes,
    rotations,
    sample_mesh,
    segment,
    transform,
    viewpoints,
)

__all__ = [
    "Axis",
    "Center",
    "Frame",
    "Map",
    "Plane",
    "Planes",
    "ProbableFrame",
    "ReflectionPlane",
    "Rotations",
    "Turn",
    "View",
    "complete",
    "describe",
    "frame",
    "planes",
    "rotations",
    "sample_mesh",
    "segment",
    "transform",
    "viewpoints",
]

# What needs the libraries of PCL, which take longer to load, is loaded when it is first used. It is missing where the library
# was built without PCL.
_WITH_PCL = ("Database", "Match", "PoseScore", "Recognized", "Registration", "register")


def __getattr__(name):
    if name not in _WITH_PCL:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from . import _recognition

    for each in _WITH_PCL:
        globals()[each] = getattr(_recognition, each)
    return globals()[name]
