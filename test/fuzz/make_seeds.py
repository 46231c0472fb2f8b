"""Seeds for the fuzzers: whole files of every kind that the tools read, those that their tests find refused, and bytes that
become points."""
import gzip
import json
import random
import struct
import sys
import zlib
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tools"))
import numpy as np
import test_refused_files as shapes
import test_volumes as volumes
from tool_run import BOX_FACES, box_corners, triangles

USAGE = "usage: python3 test/fuzz/make_seeds.py FOLDER\nWrites a folder of seeds for each target into FOLDER."
CORNERS = box_corners(1.0, 2.0, 3.0)
TRIANGLES = triangles(BOX_FACES)
LARGEST_REFUSED = 4000  # bytes


def rows(table):
    return "".join(" ".join(map(str, row)) + "\n" for row in table)


def literal_lzf(data):
    """LZF without back references: runs of at most 32 bytes, each behind its length less one."""
    return b"".join(bytes([len(data[i : i + 32]) - 1]) + data[i : i + 32] for i in range(0, len(data), 32))


def pcd():
    values, columns = CORNERS.astype("<f4").tobytes(), CORNERS.T.astype("<f4").tobytes()
    packed = struct.pack("<II", len(literal_lzf(columns)), len(columns)) + literal_lzf(columns)
    more = dict(fields="x y z _ rgb", sizes="4 4 4 1 4", types="F F F U U\nCOUNT 1 1 1 4 1")
    yield shapes.pcd(8, "ascii\n", rows(CORNERS))
    yield shapes.pcd(8, "binary\n", values)
    yield shapes.pcd(8, "binary_compressed\n", packed)
    yield shapes.pcd(8, "ascii\n", rows([*row, 0, 0, 0, 0, 255] for row in CORNERS), **more)
    yield shapes.pcd(8, "binary\n", b"".join(row.astype("<f4").tobytes() + bytes(8) for row in CORNERS), **more)
    yield shapes.pcd(9, "ascii\nnan 0 0\n", rows(CORNERS)).replace(b"0 0 0 1 0 0 0", b"1 2 3 0.5 0.5 -0.5 0.5")


def ply():
    camera = "element camera 1\n" + "".join(f"property float {n}\n" for n in ("view_px", "view_py", "view_pz"))
    camera += "".join(f"property float {v}_axis{c}\n" for v in "xyz" for c in "xyz")
    pose = np.array([5, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1])
    for kind, order in (("ascii", ""), ("binary_little_endian", "<"), ("binary_big_endian", ">")):
        for scalar, more in (("float", ""), ("float", camera), ("double", "")):
            elements = "comment a box\nelement vertex 8\n" + shapes.XYZ.replace("float", scalar)
            elements += "element face 6\nproperty list uchar int vertex_indices\n" + more
            body = [rows(CORNERS), rows((4, *face) for face in BOX_FACES), rows([pose] if more else [])]
            if order:
                faces = b"".join(struct.pack(order + "B4i", 4, *face) for face in BOX_FACES)
                body = [CORNERS.astype(order + scalar[0]).tobytes(), faces, pose.astype(order + "f4").tobytes() if more else b""]
            yield shapes.ply(kind, elements, *body)


def stl():
    facets = [np.r_[0, 0, 0, CORNERS[t].ravel()].astype("<f4").tobytes() + bytes(2) for t in TRIANGLES]
    yield bytes(80) + struct.pack("<I", len(TRIANGLES)) + b"".join(facets)
    facets = ["facet normal 0 0 0\nouter loop\n" + rows(("vertex", *CORNERS[i]) for i in t) + "endloop\nendfacet\n" for t in TRIANGLES]
    yield f"solid box\n{''.join(facets)}endsolid box\n"


def glb():
    view = ',{"buffer":0,"byteOffset":96,"byteLength":72}'
    accessor = ',{"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}'
    yield shapes.glb('{"attributes":{"POSITION":0},"indices":1}', CORNERS, view, accessor, TRIANGLES.astype("<u2").tobytes())
    yield shapes.glb('{"attributes":{"POSITION":0},"mode":0}', CORNERS)


def obj():
    vertices = rows(("v", *row) for row in CORNERS)
    yield vertices + rows(("f", *(i + 1 for i in face)) for face in BOX_FACES)
    yield vertices
    yield "o a\n" + rows(("v", 500000.25 + x, y, z) for x, y, z in CORNERS) + "vt 0 0\ng b\nf 1/1 2/1 3/1\nf -1 -2 -3\n"


def shape_files():
    text, off = rows(CORNERS), rows(CORNERS) + rows((4, *face) for face in BOX_FACES)
    found = {"pcd": [*pcd()], "ply": [*ply()], "stl": [*stl()], "glb": [*glb()], "obj": [*obj()],
             "off": ["OFF\n8 6 0\n" + off, "OFF8 6 12\n" + off, "8 6 0\n# corners\n" + off, "OFF BINARY\n"],
             "csv": ["x;y;z;t\n" + text.replace(" ", ";"), "3\n1,2,3,a\n4,5,6,b\n7,8,9,c\n"],
             "xyz": [text, "# points\n" + rows((*row, 255) for row in CORNERS)]}  # fmt: skip
    for name, (content, _) in shapes.FILES.items():
        if Path(name).suffix[1:] in found and content and len(content) < LARGEST_REFUSED:
            found[Path(name).suffix[1:]].append(content)
    return found


def volume_files():
    size = (12, 5, 4)
    values = (np.arange(240) ** 2 % 7 - 1.5).astype("<f4").tobytes()
    nifti, packed = volumes.nifti(values, size), zlib.compress(values)
    compressed = b"CompressedData = True\nCompressedDataSize = %d" % len(packed)
    return {"nii": [nifti], "nii.gz": [gzip.compress(nifti, mtime=0)], "mgh": [volumes.mgh(values, size)], "vti": [volumes.vti(values, size)],
            "nrrd": [volumes.nrrd(values, size), volumes.nrrd(gzip.compress(values, mtime=0), size).replace(b": raw", b": gzip", 1)],
            "mha": [volumes.meta_image(values, size), volumes.meta_image(packed, size).replace(b"CompressedData = False", compressed)]}  # fmt: skip


def symmetry_files():
    turn = [1, 0, 0, 0, 0, -1, 0, 4, 0, 0, -1, 0, 0, 0, 0, 1]
    axis = {"axis": [0, 0, 1], "offset": [0, 0.5, 0]}
    models = {"1": {"diameter": 10.0, "symmetries_discrete": [turn]}, "2": {"symmetries_continuous": [axis]}, "3": {}}
    table = [turn[i : i + 4] for i in range(0, 16, 4)]
    return {"models_info": [json.dumps(models), json.dumps({"symmetries_discrete": [table], "align_axes": []})],
            "isaac": ['obj_1: ["z_90", "z_180"]\nobj_2: ["x_full"] # any angle\n', "symmetry_axes: ['y_full']\n"]}  # fmt: skip


def point_bytes(num_options, count):
    """Bytes of options, the kind of points, and points: of a surface on a lattice, or floats."""
    stream = random.Random(1)
    for kind in range(3):
        for _ in range(count):
            points = [bytes((stream.choice((20, 236)), stream.randrange(256), stream.randrange(256))) for _ in range(90)]
            body = b"".join(points)
            if kind == 0:
                body = struct.pack("<90f", *(stream.uniform(-1, 1) for _ in range(90)))
            yield bytes(2 * stream.randrange(128) for _ in range(num_options)) + bytes([kind]) + body


def packed_parts():
    """The kind of the part, and matrices as the database packs them."""
    matrix = lambda rows, cols, value=0.5: struct.pack(f"<II{rows * cols}f", rows, cols, *[value] * (rows * cols))
    return {"packed": [b"\0" + matrix(3, 8), b"\1" + matrix(4, 2), b"\2" + matrix(280, 1), b"\3" + matrix(4, 2) + matrix(1, 1),
                       b"\4" + struct.pack("<Iq", 1, 7) + matrix(12, 1) + matrix(4, 2), b"\5" + bytes(52), b"\6" + matrix(3, 2) + matrix(3, 2)]}  # fmt: skip


def main(folder):
    of_points = {name: [*point_bytes(num_options, 8)] for name, num_options in (("planes", 15), ("rotations", 4), ("segment", 7))}
    for name, files in {**shape_files(), **volume_files(), **symmetry_files(), **packed_parts(), **of_points}.items():
        (Path(folder) / name).mkdir(parents=True, exist_ok=True)
        for i, content in enumerate(files):
            (Path(folder) / name / f"seed{i}").write_bytes(content.encode() if isinstance(content, str) else content)


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] in ("-h", "--help"):
        print(USAGE)
        sys.exit(0 if "-h" in sys.argv or "--help" in sys.argv else 2)
    main(sys.argv[1])
