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


def _text_of(value):
    value = value.tolist() if hasattr(value, "tolist") else value
    if isinstance(value, list):
        return "[" + ", ".join(_text_of(each) for each in value) + "]"
    return f"{value:.4g}" if isinstance(value, float) else repr(value)


def _show(**members):
    """Gives classes, by their names, a text with the members that tell most."""
    for kind, names in members.items():

        def text(self, names=tuple(names.split())):
            shown = (f"{name}={_text_of(getattr(self, name))}" for name in names)
            return f"{type(self).__name__}({', '.join(shown)})"

        globals()[kind].__repr__ = text


def _text_of_planes(found):
    return "Planes([" + "".join(f"\n  {plane!r}," for plane in found) + ("\n])" if len(found) else "])")


_show(
    ReflectionPlane="normal offset",
    Plane="kind normal offset confidence share",
    Axis="point direction confidence",
    Turn="point direction fold confidence",
    Center="point confidence",
    View="direction score",
    Frame="center axes revolution_axis",
    ProbableFrame="center axes probability",
    Rotations="name center support confidence",
    Map="sigma",
)
Planes.__repr__ = _text_of_planes

# What needs the libraries of PCL, which take longer to load, is loaded when it is first used. It is missing where the library
# was built without PCL.
_WITH_PCL = ("BuildReport", "Database", "Match", "PoseScore", "Recognized", "Registration", "register")


def __getattr__(name):
    if name not in _WITH_PCL:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from . import _recognition

    for each in _WITH_PCL:
        globals()[each] = getattr(_recognition, each)
    _show(
        BuildReport="num_added failures cancelled",
        Match="name distance",
        PoseScore="support conflict merit",
        Recognized="name confidence transform",
        Registration="transform score",
    )
    globals()["Database"].__repr__ = lambda self: f"Database(models={len(self)})"
    return globals()[name]
