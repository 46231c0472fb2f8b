"""Seeds for the fuzzers: small files of every kind that the tools read, and bytes that become points."""

import gzip
import json
import random
import struct
import sys
import zlib
from pathlib import Path

USAGE = "usage: python3 test/fuzz/make_seeds.py FOLDER\nWrites a folder of seeds for each target into FOLDER."

CORNERS = [(x, y, z) for x in (-1.0, 1.0) for y in (-2.0, 2.0) for z in (-3.0, 3.0)]
FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
TRIANGLES = [t for a, b, c, d in FACES for t in ((a, b, c), (a, c, d))]


def text_of(rows):
    return "".join(" ".join(map(str, row)) + "\n" for row in rows).encode()


def literal_lzf(data):
    """LZF without back references: runs of at most 32 bytes, each behind its length less one."""
    return b"".join(bytes([len(data[i : i + 32]) - 1]) + data[i : i + 32] for i in range(0, len(data), 32))


def pcd(data, rows=CORNERS, extra="", viewpoint="0 0 0 1 0 0 0"):
    header = (
        f"# .PCD v0.7\nVERSION 0.7\nFIELDS x y z{' _ rgb' if extra else ''}\nSIZE 4 4 4{' 1 4' if extra else ''}\n"
        f"TYPE F F F{' U U' if extra else ''}\nCOUNT 1 1 1{' 4 1' if extra else ''}\nWIDTH {len(rows)}\nHEIGHT 1\n"
        f"VIEWPOINT {viewpoint}\nPOINTS {len(rows)}\nDATA {data}\n"
    ).encode()
    if data == "ascii":
        return header + text_of([*row, 0, 0, 0, 0, 255] if extra else row for row in rows)
    if data == "binary":
        return header + b"".join(struct.pack("<3f", *row) + (b"\0" * 8 if extra else b"") for row in rows)
    columns = struct.pack(f"<{3 * len(rows)}f", *(row[k] for k in range(3) for row in rows))
    packed = literal_lzf(columns)
    return header + struct.pack("<II", len(packed), len(columns)) + packed


def ply(kind, camera=False, scalar="float"):
    header = f"ply\nformat {kind} 1.0\ncomment a box\nelement vertex 8\n" + "".join(f"property {scalar} {c}\n" for c in "xyz")
    header += "element face 6\nproperty list uchar int vertex_indices\n"
    names = [f"{v}_axis{c}" for v in "xyz" for c in "xyz"]
    if camera:
        header += "element camera 1\n" + "".join(f"property float {n}\n" for n in ["view_px", "view_py", "view_pz", *names])
    header = (header + "end_header\n").encode()
    pose = [5, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]
    if kind == "ascii":
        return header + text_of(CORNERS) + text_of((4, *face) for face in FACES) + (text_of([pose]) if camera else b"")
    order, letter = ("<" if "little" in kind else ">"), ("f" if scalar == "float" else "d")
    body = b"".join(struct.pack(f"{order}3{letter}", *row) for row in CORNERS)
    body += b"".join(struct.pack(f"{order}B4i", 4, *face) for face in FACES)
    return header + body + (struct.pack(f"{order}12f", *pose) if camera else b"")


def stl():
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *(x for i in t for x in CORNERS[i]), 0) for t in TRIANGLES)
    return b"\0" * 80 + struct.pack("<I", len(TRIANGLES)) + body


def stl_text():
    facets = "".join(
        "facet normal 0 0 0\nouter loop\n" + "".join("vertex %g %g %g\n" % CORNERS[i] for i in t) + "endloop\nendfacet\n"
        for t in TRIANGLES
    )
    return f"solid box\n{facets}endsolid box\n".encode()


def glb(points_only=False):
    vertices = struct.pack("<24f", *(x for row in CORNERS for x in row))
    indices = struct.pack(f"<{3 * len(TRIANGLES)}H", *(i for t in TRIANGLES for i in t))
    primitive = {"attributes": {"POSITION": 0}, "mode": 0} if points_only else {"attributes": {"POSITION": 0}, "indices": 1}
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": [1, 2, 3]}], "meshes": [{"primitives": [primitive]}],
        "buffers": [{"byteLength": len(vertices + indices)}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": len(vertices)},
                        {"buffer": 0, "byteOffset": len(vertices), "byteLength": len(indices)}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [-1, -2, -3], "max": [1, 2, 3]},
                      {"bufferView": 1, "componentType": 5123, "count": 3 * len(TRIANGLES), "type": "SCALAR"}],
    }  # fmt: skip
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    body = vertices + indices
    body += b"\0" * (-len(body) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(body), 0x004E4942) + body
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def obj():
    yield text_of(("v", *row) for row in CORNERS) + text_of(("f", *(i + 1 for i in face)) for face in FACES)
    yield text_of(("v", *row) for row in CORNERS)
    yield b"o a\n" + text_of(("v", 500000.25 + x, y, z) for x, y, z in CORNERS) + b"vt 0 0\ng b\nf 1/1 2/1 3/1\nf -1 -2 -3\n"


def shape_files():
    yield "pcd", [pcd("ascii"), pcd("binary"), pcd("binary_compressed"), pcd("ascii", extra="x"), pcd("binary", extra="x"),
                  pcd("ascii", [(float("nan"), 0, 0), *CORNERS], viewpoint="1 2 3 0.5 0.5 -0.5 0.5")]  # fmt: skip
    kinds = ("ascii", "binary_little_endian", "binary_big_endian")
    yield "ply", [ply(k, c, s) for k in kinds for c, s in ((False, "float"), (True, "float"), (False, "double"))]
    off = text_of(CORNERS) + text_of((4, *face) for face in FACES)
    yield "off", [b"OFF\n8 6 0\n" + off, b"OFF8 6 12\n" + off, b"8 6 0\n# corners\n" + off, b"OFF BINARY\n"]
    yield "csv", [b"x;y;z;t\n" + text_of(CORNERS).replace(b" ", b";"), b"3\n1,2,3,a\n4,5,6,b\n7,8,9,c\n"]
    yield "xyz", [text_of(CORNERS), b"# points\n" + text_of((*row, 255) for row in CORNERS)]
    yield "obj", list(obj())
    yield "stl", [stl(), stl_text()]
    yield "glb", [glb(), glb(True)]


def nifti(values):
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, 12, 5, 4, 1, 1, 1, 1)
    struct.pack_into("<2h8f3f", header, 70, 16, 32, 1, 2, 2, 3, 0, 0, 0, 0, 352, 2, -50)
    struct.pack_into("<h", header, 254, 1)
    struct.pack_into("<12f4s", header, 280, 0, -2, 0, 5, 2, 0, 0, 7, 0, 0, 3, -9, b"n+1")
    return bytes(header) + values


def nrrd(encoding, values):
    header = "space: left-posterior-superior\nspace directions: (0,2,0) (-2,0,0) (0,0,3)\nspace origin: (5,7,-9)\n"
    return f"NRRD0004\ntype: float\ndimension: 3\nsizes: 12 5 4\nendian: little\nencoding: {encoding}\n{header}\n".encode() + values


def meta_image(values, size=None):
    packed = f"CompressedData = {bool(size)}\n" + (f"CompressedDataSize = {size}\n" if size else "")
    header = "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n" + packed
    header += "TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 5 7 -9\nElementSpacing = 2 2 3\nDimSize = 12 5 4\n"
    return (header + "ElementType = MET_FLOAT\nElementDataFile = LOCAL\n").encode() + values


def vtk_image(text):
    return (
        '<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n<ImageData WholeExtent='
        '"0 11 0 4 0 3" Origin="5 7 -9" Spacing="2 2 3" Direction="0 -1 0 1 0 0 0 0 1"><Piece Extent="0 11 0 4 0 3">\n'
        '<PointData Scalars="v"><DataArray type="Float32" Name="v" format="ascii">' + text + "</DataArray></PointData>\n"
        "</Piece></ImageData></VTKFile>\n"
    ).encode()


def volume_files():
    numbers = [k * k % 7 - 1.5 for k in range(240)]
    values, text = struct.pack("<240f", *numbers), " ".join(map(str, numbers))
    yield "nii", [nifti(values)]
    yield "nii.gz", [gzip.compress(nifti(values), mtime=0)]
    frame = struct.pack(">7ih15f", 1, 12, 5, 4, 1, 3, 0, 1, 2, 2, 3, 0, 1, 0, -1, 0, 0, 0, 0, 1, 5, 7, -9)
    yield "mgh", [frame.ljust(284, b"\0") + struct.pack(">240f", *numbers)]
    yield "nrrd", [nrrd("raw", values), nrrd("gzip", gzip.compress(values, mtime=0))]
    yield "mha", [meta_image(values), meta_image(zlib.compress(values), len(zlib.compress(values)))]
    yield "vti", [vtk_image(text)]


def symmetry_files():
    turn = [1, 0, 0, 0, 0, -1, 0, 4, 0, 0, -1, 0, 0, 0, 0, 1]
    axis = {"axis": [0, 0, 1], "offset": [0, 0.5, 0]}
    models = {"1": {"diameter": 10.0, "symmetries_discrete": [turn]}, "2": {"symmetries_continuous": [axis]}, "3": {}}
    rows = [turn[i : i + 4] for i in range(0, 16, 4)]
    yield "models_info", [json.dumps(models).encode(), json.dumps({"symmetries_discrete": [rows], "align_axes": []}).encode()]
    yield "isaac", [b'obj_1: ["z_90", "z_180"]\nobj_2: ["x_full"] # any angle\n', b"symmetry_axes: ['y_full']\n"]


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
    yield "packed", [b"\0" + matrix(3, 8), b"\1" + matrix(4, 2), b"\2" + matrix(280, 1), b"\3" + matrix(4, 2) + matrix(1, 1),
                     b"\4" + struct.pack("<Iq", 1, 7) + matrix(12, 1) + matrix(4, 2), b"\5" + bytes(52), b"\6" + matrix(3, 2) + matrix(3, 2)]  # fmt: skip


def main(folder):
    for name, files in [*shape_files(), *volume_files(), *symmetry_files(), *packed_parts()]:
        write(Path(folder) / name, files)
    for name, num_options in (("planes", 15), ("rotations", 4), ("segment", 7)):
        write(Path(folder) / name, list(point_bytes(num_options, 8)))


def write(folder, files):
    folder.mkdir(parents=True, exist_ok=True)
    for i, content in enumerate(files):
        (folder / f"seed{i}").write_bytes(content)


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] in ("-h", "--help"):
        print(USAGE)
        sys.exit(0 if "-h" in sys.argv or "--help" in sys.argv else 2)
    main(sys.argv[1])
