"""Tools run as their users run them, the files that go in and come out, and shapes to test with."""
import importlib.util
import json
import os
import re
import resource
import shlex
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path


def need(*packages):
    """Packages of Python; where one is not installed, the test is skipped."""
    try:
        return [importlib.import_module(package) for package in packages]
    except ImportError as error:
        print(f"skipped: {error}")
        sys.exit(77)


def needs(*packages):
    """A decorator of tests that are skipped where one of these packages of Python is not installed."""
    missing = [package for package in packages if not importlib.util.find_spec(package)]
    return unittest.skipIf(missing, f"not installed: {', '.join(missing)}")


np, Image = need("numpy", "PIL.Image")
TOOLS = Path(os.environ.get("TOOLS", ""))  # their folder
SCHEMAS = Path(__file__).resolve().parents[2] / "apps/schemas"


def wait_for(condition, seconds=300):
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.01)
    return condition()


def limit_of_memory(size):
    """What to do before a tool runs with so many bytes; None where that is too little for its help: sanitizers take all addresses."""
    limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (size, size))
    run = subprocess.run([TOOLS / "pcl_symmetry_scan", "-h"], stdout=subprocess.DEVNULL, preexec_fn=limit, check=False)
    return limit if run.returncode == 0 else None


class ToolTest(unittest.TestCase):
    tool = ""  # without the common beginning, e.g. "planes"
    files = {}  # {attribute: (name, content)}, in the folder of each test

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="pcl_symmetry_")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        for attribute, (name, content) in self.files.items():
            setattr(self, attribute, self.write(name, content))

    def write(self, name, content):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def text(self, name):
        return (self.folder / name).read_text(errors="replace")

    def lines(self, name):
        """The values of a file of JSON Lines."""
        return [json.loads(line) for line in self.text(name).splitlines()]

    def run_tool(self, *arguments, code=0, tool=None, **options):
        """Runs a tool in the folder of the test: paths as they are, strings cut at blanks. Returns what it printed.

        That is in self.output, and its messages in self.error.
        """
        words = [word for argument in arguments for word in ([argument] if isinstance(argument, Path) else argument.split())]
        done = subprocess.run([TOOLS / f"pcl_symmetry_{tool or self.tool}", *words], capture_output=True, cwd=self.folder, **options)
        self.output, self.error = (text.decode(errors="replace") for text in (done.stdout, done.stderr))
        self.assertEqual(done.returncode, code, f"{words}: {self.error}")
        return self.output

    def at_terminal(self, *words, tool=None, columns=80):
        """Exit code of a tool at a terminal, and what it shows there."""
        command = f"stty cols {columns}; {TOOLS}/pcl_symmetry_{tool or self.tool} {shlex.join(map(str, words))}"
        done = subprocess.run(["script", "-qec", command, "/dev/null"], cwd=self.folder, stdout=subprocess.PIPE, check=False)
        return done.returncode, done.stdout.decode()

    def report(self, *arguments, **options):
        """Runs a tool that must not fail. Returns what it reports."""
        self.run_tool(*arguments, "-json report.json", **options)
        return json.loads(self.text("report.json"))

    def assert_follows(self, document, schema):
        try:
            import jsonschema
        except ImportError:
            self.skipTest("jsonschema is not installed (Debian package python3-jsonschema)")
        schema = json.loads((SCHEMAS / f"{schema}.schema.json").read_text())
        jsonschema.Draft202012Validator.check_schema(schema)
        jsonschema.Draft202012Validator(schema).validate(document)

    def fails(self, code, words, *arguments, **options):
        """The tool ends with this exit code and these words among its errors."""
        self.run_tool(*arguments, code=code, **options)
        self.assertIn(words, self.error)


def off(vertices, faces):
    lines = ["OFF", f"{len(vertices)} {len(faces)} 0"]
    lines += [" ".join(f"{x:.12g}" for x in vertex) for vertex in vertices]
    return "\n".join(lines + [" ".join(map(str, [len(face), *face])) for face in faces]) + "\n"


BOX_FACES = [(3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (2, 3, 7, 6), (1, 2, 6, 5), (3, 0, 4, 7)]
TETRAHEDRON = "OFF\n4 4 6\n0 0 0\n2 0.1 0\n0.4 1.3 0.1\n0.7 0.2 0.9\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"  # no symmetry


def box_corners(x, y, z):
    """The corners of a box about the origin: counterclockwise below, then above."""
    return np.array([[a * x, b * y, c * z] for c in (-1, 1) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


def box_off(y=1.5, z=2.0):
    """A box from -1 -y -z to 1 y z."""
    return off(box_corners(1.0, y, z), BOX_FACES)


def grid_faces(rows, columns):
    """Quads between vertices in rows, each of which is a ring."""
    return [[i * columns + k, i * columns + (k + 1) % columns, (i + 1) * columns + (k + 1) % columns, (i + 1) * columns + k]
            for i in range(rows - 1) for k in range(columns)]


def triangles(quads):
    return np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def mug(has_handle=True):
    """Vertices and quads of a cup, open at the top, and of its handle."""
    (cup, faces), around, handle = turned(((0.001, 0), (0.7, 0), (0.75, 1.6)), 96), np.arange(8) * np.pi / 4, []
    for along in np.linspace(-0.5, 0.5, 17) * np.pi:
        r = 0.45 + 0.08 * np.cos(around)
        handle += [*np.stack([0.7 + r * np.cos(along), 0.08 * np.sin(around), 0.8 + r * np.sin(along)], axis=1)]
    faces += [[len(cup) + corner for corner in face] for face in grid_faces(17, 8)] * has_handle
    return np.array([*cup, *handle * has_handle]), faces


def points_on_box(size=(1.0, 0.7, 0.4), num_points=6000, seed=1):
    """Points on the surface of a box of the given edges about the origin, (N, 3) float32."""
    random, edges = np.random.default_rng(seed), np.asarray(size)
    areas = np.repeat(np.prod(edges) / edges, 2)
    side = random.choice(6, num_points, p=areas / areas.sum())
    points = (random.random((num_points, 3)) - 0.5) * edges
    points[np.arange(num_points), side // 2] = (side % 2 - 0.5) * edges[side // 2]
    return points.astype(np.float32)


def points_on_sphere(count, seed=1):
    points = np.random.default_rng(seed).normal(size=(count, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def swept(outline, profile):
    """Vertices and quads of an outline about z, complex, that is scaled and raised along a profile of (scale, height)."""
    vertices = [np.c_[scale * outline.real, scale * outline.imag, np.full(len(outline), height)] for scale, height in profile]
    return np.vstack(vertices), grid_faces(len(profile), len(outline))


def turned(profile, num_sides):
    """A profile of (radius, height) turned about z."""
    return swept(np.exp(2j * np.pi * np.arange(num_sides) / num_sides), profile)


def lathe(profile, num_sides):
    return off(*turned(profile, num_sides))


VASE = lathe([(0.001, 0), (0.5, 0), (0.8, 0.5), (0.9, 1.0), (0.7, 1.6), (0.3, 2.2), (0.3, 2.5), (0.45, 2.7)], 64)  # open at the top
CYLINDER = lathe([(0.001, -1), (0.6, -1), (0.6, 1), (0.001, 1)], 128)
SPHERE = lathe([(np.sin(np.pi * k / 48), -np.cos(np.pi * k / 48)) for k in range(49)], 96)


def rotation(axis, angle):
    """By an angle in radians about an axis, 3 x 3."""
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def random_pose(seed):
    """A uniformly random rotation and a translation by up to 3 along each axis."""
    random = np.random.default_rng(seed)
    q, r = np.linalg.qr(random.normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q * np.sign(np.linalg.det(q)), random.uniform(-3, 3, 3)


def pcd(points, width=0, viewpoint=(0, 0, 0), **columns):
    """A binary PCD file, of rows and columns where a width is given, with fields besides x, y and z: float or whole numbers."""
    values = [np.asarray(each) for each in (*np.transpose(points), *columns.values())]
    kinds = ["U" if each.dtype.kind in "iu" and name else "F" for name, each in zip((*3 * [""], *columns), values)]
    cloud = np.rec.fromarrays(values, formats=["<u4" if kind == "U" else "<f4" for kind in kinds])
    width = width or len(points)
    return (f"VERSION 0.7\nFIELDS {' '.join(['x', 'y', 'z', *columns])}\nSIZE{' 4' * len(kinds)}\nTYPE {' '.join(kinds)}\n"
            f"COUNT{' 1' * len(kinds)}\nWIDTH {width}\nHEIGHT {len(points) // width}\nVIEWPOINT {' '.join(map(str, viewpoint))} 1 0 0 0\n"
            f"POINTS {len(points)}\nDATA binary\n").encode() + cloud.tobytes()


def pcd_header(path):
    """Of a PCD file of any encoding, by the first words of its lines."""
    lines = Path(path).read_bytes().split(b"\nDATA")[0].decode().splitlines()
    return {line.split()[0]: line.split()[1:] for line in lines}


def unpacked(data, size):
    """What the compression of PCD (LZF) packed."""
    out, at = bytearray(), 0
    while len(out) < size:
        code, at = data[at], at + 1
        if code < 32:  # bytes as they are
            out += data[at:at + code + 1]
            at += code + 1
        else:  # bytes of before
            length, at = (code >> 5, at) if code >> 5 < 7 else (7 + data[at], at + 1)
            start, at = len(out) - ((code & 31) << 8) - data[at] - 1, at + 1
            for k in range(start, start + length + 2):
                out.append(out[k])
    return bytes(out)


def pcd_points(path):
    """The points of a PCD file, binary or compressed, with all fields."""
    header = pcd_header(path)
    count, counts = int(header["POINTS"][0]), list(map(int, header["COUNT"]))
    fields = [(name, f"<{kind.lower()}{size}", (number,) if number > 1 else ())
              for name, kind, size, number in zip(header["FIELDS"], header["TYPE"], header["SIZE"], counts)]
    encoding, body = Path(path).read_bytes().split(b"\nDATA ")[1].split(b"\n", 1)
    if encoding == b"binary":
        return np.frombuffer(body, fields, count)
    packed, size = struct.unpack("<II", body[:8])
    body, points = unpacked(body[8:8 + packed], size), np.zeros(count, fields)
    for name, kind, shape in fields:  # one after the other
        values, body = body[:points[name].nbytes], body[points[name].nbytes:]
        points[name] = np.frombuffer(values, kind).reshape((count, *shape))
    return points


def ply_points(path):
    """The vertices of a binary PLY file, with all properties, and its header."""
    header, body = Path(path).read_bytes().split(b"end_header\n", 1)
    header = header.decode()
    types = {"char": "i1", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4", "float": "<f4", "double": "<f8"}
    count, properties = re.search(r"element vertex (\d+)\n((?:property [a-z0-9]+ \w+\n)+)", header).groups()
    names = [line.split()[1:] for line in properties.splitlines()]
    return np.frombuffer(body, [(name, types[kind]) for kind, name in names], int(count)), header


def ply_text(text):
    """Header, vertices and polygons of a mesh in a PLY file of text."""
    header, body = text.split("end_header\n")
    lines, count = [line.split() for line in body.splitlines()], int(header.split("element vertex ")[1].split()[0])
    return header, np.array(lines[:count], float), [[int(word) for word in line[1:1 + int(line[0])]] for line in lines[count:]]


def xyz(points):
    return np.stack([points["x"], points["y"], points["z"]], axis=1)
