"""Files that are cut off, promise more than they hold or mean nothing: refused with one line that names the file and the reason."""
import os
import struct

from tool_run import ToolTest, box_off, limit_of_memory, np

GARBAGE = b"\x7f\x45\0\1\2\3\xff\xfe"
RAW = b"\1" * 12
SQUARE = "0 0 0\n2 0 0\n2 1 0\n0 1 0\n"
TRIANGLE = "0 0 0\n1 0 0\n0 1 0\n"
XYZ = "property float x\nproperty float y\nproperty float z\n"
VERTEX = "element vertex 1\n" + XYZ
FACE = "element face 1\nproperty list uint int vertex_indices\n"
SQUARE_PLY = "element vertex 4\n" + XYZ + "element face 1\nproperty list uchar int vertex_indices\n"


def joined(*parts):
    return b"".join(part if isinstance(part, bytes) else part.encode() for part in parts)


def pcd(points, *data, fields="x y z", sizes="4 4 4", types="F F F", width=None, height=1):
    return joined(f"# .PCD v0.7\nVERSION 0.7\nFIELDS {fields}\nSIZE {sizes}\nTYPE {types}\nWIDTH {points if width is None else width}\n"
                  f"HEIGHT {height}\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {points}\nDATA ", *data)


def many_fields(names, data):
    """2^28 points of 8192 fields of 2^20 values of eight bytes: 2^64 bytes, which is 0 where it is not looked at."""
    body = b"\x08\0\0\0\0\0\0\xc0........" if data == "binary_compressed" else b" " * 1000
    return joined("VERSION 0.7\nFIELDS x y z ", " ".join(names), "\nSIZE 4 4 4", " 8" * 8192, "\nTYPE F F F", " F" * 8192,
                  "\nCOUNT 1 1 1", " 1048576" * 8192, f"\nWIDTH 268435456\nHEIGHT 1\nPOINTS 268435456\nDATA {data}\n", body)


def ply(kind, elements, *body):
    return joined(f"ply\nformat {kind} 1.0\n{elements}end_header\n", *body)


def glb(primitive='{"attributes":{"POSITION":0},"mode":4}', corners=((0, 0, 0), (2, 0, 0), (2, 1, 0)), view="", accessor="", more=b""):
    """Binary glTF: 12 bytes of header, a chunk of JSON, a chunk of values; another view of its buffer, with values of its own."""
    values = np.array(corners, "<f4").tobytes() + more
    text = ('{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[0,0,5]}],'
            f'"meshes":[{{"primitives":[{primitive}]}}],"buffers":[{{"byteLength":{len(values)}}}],'
            f'"bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":{len(values) - len(more)}}}{view}],'
            f'"accessors":[{{"bufferView":0,"componentType":5126,"count":{len(corners)},"type":"VEC3","min":[0,0,0],"max":[2,1,0]}}{accessor}]}}')
    text += " " * (-len(text) % 4)
    return joined(struct.pack("<4s3I4s", b"glTF", 2, 28 + len(text) + len(values), len(text), b"JSON"), text,
                  struct.pack("<I4s", len(values), b"BIN\0"), values)


def changed_glb(before, after):
    whole = glb()
    assert before.encode() in whole
    return whole.replace(before.encode(), after.ljust(len(before)).encode(), 1)


FILES = {
    "empty.pcd": ("", "is empty"),
    "headerless.pcd": ("1 2 3\n4 5 6\n", "has no PCD header"),
    "garbage.pcd": (GARBAGE, "has no PCD header"),
    "cut.pcd": ("VERSION 0.7\nFIELDS x y z\n", "ends before DATA"),
    "no_z.pcd": (pcd(1, "ascii\n1 2\n", fields="x y", sizes="4 4", types="F F"), "has no field z"),
    "no_xyz.pcd": (pcd(1, "ascii\n1 2 3\n", fields="a b c"), "has no field x"),
    "short_size.pcd": (pcd(1, "ascii\n1 2 3\n", sizes="4 4"), "SIZE has 2 entries, must be 3"),
    "bad_size.pcd": (pcd(1, "ascii\n1 2 3\n", sizes="4 4 3"), "TYPE and SIZE of z = F 3"),
    "product.pcd": (pcd(3, "ascii\n1 2 3\n", width=2, height=2), "must be WIDTH * HEIGHT = 4"),
    "negative.pcd": (pcd(-1, "ascii\n"), "WIDTH = -1"),
    "no_points.pcd": (pcd(0, "ascii\n"), "POINTS = 0, must be > 0"),
    "data.pcd": (pcd(1, "zip\n1 2 3\n"), "DATA = zip"),
    "too_few.pcd": (pcd(3, "ascii\n1.25 2.25 3.25\n4.25 5.25 6.25\n"), "holds 2 points, POINTS = 3"),
    "letters.pcd": (pcd(1, "ascii\n1 two 3\n"), "not a number"),
    "row.pcd": (pcd(2, "ascii\n1 2 3\n4.55555 5\n"), "has 2 values, must be 3"),
    "huge.pcd": (pcd(2000000000, "ascii\n1 2 3\n"), "must be >= "),
    "huge_binary.pcd": (pcd(2000000000, "binary\n", RAW), "must be >= 24000000000"),
    "cut_binary.pcd": (pcd(2, "binary\n", RAW), "holds 12 bytes of points"),
    "cut_compressed.pcd": (pcd(2, "binary_compressed\n", RAW[:5]), "ends before the sizes"),
    "sizes_compressed.pcd": (pcd(2, "binary_compressed\n", RAW), "compressed size = "),
    "damaged_compressed.pcd": (pcd(1, "binary_compressed\n", b"\3\0\0\0\14\0\0\0\xff\xff\xff"), "damaged"),
    "huge_compressed.pcd": (pcd(300000000, "binary_compressed\n", b"\x04\0\0\0\0\xa4\x93\xd6...."), "damaged"),
    "empty.ply": ("", "is empty"),
    "garbage.ply": ("hello\n", "does not begin with ply"),
    "cut.ply": ("ply\nformat ascii 1.0\n", "ends before end_header"),
    "format.ply": (ply("zip", VERTEX, "1 2 3\n"), "PLY format = zip"),
    "no_vertex.ply": (ply("ascii", "element face 0\n"), "has no element vertex"),
    "no_z.ply": (ply("ascii", "element vertex 1\nproperty float x\nproperty float y\n", "1 2\n"), "vertex property z"),
    "two_billion.ply": (ply("binary_little_endian", "element vertex 2000000000\n" + XYZ, RAW), "but only 12 bytes"),
    "huge_ascii.ply": (ply("ascii", "element vertex 2000000000\n" + XYZ, "1 2 3\n"), "but only 6 bytes"),
    "huge_list.ply": (ply("ascii", VERTEX + FACE, "1 2 3\n2000000000 0 0 0\n"), "vertex_indices of face 0 is missing"),
    "twice.ply": (ply("ascii", VERTEX + "property float x\n", "1 2 3 4\n"), "property x of vertex stands twice"),
    "two_elements.ply": (ply("ascii", VERTEX + VERTEX, "1 2 3\n4 5 6\n"), "element vertex stands twice"),
    "cut_ascii.ply": (ply("ascii", "element vertex 2\n" + XYZ, "1 2 3\n4.5555555 5\n"), "is missing"),
    "list.ply": (ply("binary_little_endian", VERTEX + FACE, RAW, b"\xff\xff\xff\x7f", RAW), "a corner of face 0 = 16843009"),
    "corner.ply": (ply("ascii", SQUARE_PLY, SQUARE, "3 0 1 4\n"), "a corner of face 0 = 4, must be >= 0 and < 4"),
    "negative_corner.ply": (ply("ascii", SQUARE_PLY, SQUARE, "3 0 1 -1\n"), "a corner of face 0 = -1"),
    "letter_corner.ply": (ply("ascii", SQUARE_PLY, SQUARE, "3 0 1 x\n"), "vertex_indices of face 0 = x, must be a number"),
    "negative_list.ply": (ply("ascii", SQUARE_PLY, SQUARE, "-3 0 1 2\n"), "length of list vertex_indices of face 0"),
    "empty.off": ("", "is empty"),
    "garbage.off": ("solid cube\n", "does not begin with OFF"),
    "cut.off": ("OFF\n4 1 0\n" + TRIANGLE, "x of vertex 3 is missing"),
    "face.off": ("OFF\n3 1 0\n" + TRIANGLE + "3 0 1\n", "corner of face 0 is missing"),
    "index.off": ("OFF\n3 1 0\n" + TRIANGLE + "3 0 1 3\n", "corner of face 0 = 3, must be <= 2"),
    "letters.off": ("OFF\n3 1 0\n0 zero 0\n1 0 0\n0 1 0\n3 0 1 2\n", "y of vertex 0 = zero, must be a number"),
    "huge.off": ("OFF\n2000000000 1 0\n0 0 0\n", "too short"),
    "huge_faces.off": ("OFF\n1 2000000000 0\n0 0 0\n", "number of faces = 2000000000, the file is too short for them"),
    "huge_face.off": ("OFF\n3 1 0\n" + TRIANGLE + "2000000000 0 1 2\n", "number of corners of face 0 = 2000000000"),
    "garbage.obj": (GARBAGE, "cannot be read"),
    "empty.obj": ("", "is empty"),
    "letters.obj": ("v 0 0 0\nv 1 zero 0\n", "y of vertex 1 = zero, must be a number"),
    "corner.obj": ("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 5\n", "a corner of face 0 = 5, must be <= 4"),
    "corner_0.obj": ("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 0\n", "a corner of face 0 = 0"),
    "garbage.stl": (GARBAGE, "cannot be read"),
    "cut.stl": (b" " * 80 + b"\xff\xff\xff\x7f" + RAW, "cannot be read"),
    "half.stl": (b" " * 80 + struct.pack("<I", 4) + b"\0" * 100, "cut off: it holds 2 of 4 triangles"),
    "tail.stl": (b" " * 80 + struct.pack("<I", 1) + b"\0" * 125, "its count is 1 triangles, but 125 bytes follow"),
    "half_text.stl": ("solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n", "ends before endsolid"),
    "more.ply": (ply("binary_little_endian", VERTEX, RAW * 2), "holds more than its header says"),
    "more_text.ply": (ply("ascii", VERTEX, "1 2 3\n4 5 6\n"), "holds more than its header says"),
    "more.off": ("OFF\n3 1 0\n" + TRIANGLE + "3 0 1 2\n3 0 1 2\n", "more faces than its header says, 1"),
    "more.pcd": (pcd(1, "ascii\n1 2 3\n4 5 6\n"), "holds more points than POINTS = 1"),
    "more_binary.pcd": (pcd(1, "binary\n", RAW * 2), "holds more points than POINTS = 1"),
    "letters.csv": ("x,y,z\n1,2,3\n1,b,3\n", "line 3 has y = b, must be a number"),
    "short_row.csv": ("1,2,3\n1,2\n", "line 2 has 2 columns, must have at least 3"),
    "two_columns.xyz": ("1 2\n", "line 1 = 1 2, must hold three numbers"),
    "count.pts": ("3\n1 2 3\n", "holds 1 points, its first line says 3"),
    "empty_cell.csv": ("1,,3\n1,2,3\n", "line 1"),
    "letter.txt": ("Dear reader,\nhello\n", "has no points"),
    "garbage.glb": (GARBAGE, "cannot be read"),
    "cut.glb": (b"glTF\2\0\0\0\xff\xff\0\0", "cannot be read"),
    # A scene is a tree, and counts are those of the file: nothing is read in circles or beyond the end.
    "count.glb": (changed_glb('"count":3', '"count":4'), "accessors[0]"),
    "json.glb": (changed_glb('{"asset":', 'x"asset":'), "cannot be read as glb"),
    "offset.glb": (changed_glb('"buffer":0,"byteOffset":0,', '"buffer":0,"byteOffset":9,'), "out of range"),
    "circle.glb": (changed_glb('"translation":[0,0,5]', '"children":[0]'), "in a circle"),
    "parents.glb": (changed_glb('"translation":[0,0,5]', '"children":[0,0]'), "node 0 has two parents"),
    "strip.glb": (glb('{"attributes":{"POSITIOF":0},"mode":5}'), "strip or fan of a mesh has 0 vertices"),
    "mode.glb": (glb('{"attributes":{"POSITION":0},"mode":"4"}'), "its JSON is damaged"),
    "mesh.glb": (changed_glb('"mesh":0', '"mesh":7'), "out of bounds"),
    "type.glb": (changed_glb('"componentType":5126', '"componentType":5127'), "Unsupported Component Type"),
    "no_view.glb": (changed_glb('{"bufferView":0,"componentType":5126,', '{"componentType":5126,'), "accessors[0]"),
    "quantized.glb": (glb().replace(b'"scene":0', b'"e":"KHR_mesh_quantization"', 1), "is compressed by KHR_mesh_quantization"),
    "length.glb": (glb()[:12] + b"glTF" + glb()[16:], "is cut off"),
    "deep.glb": (glb('{"attributes":{"POSITION":0},"extras":' + "[" * 100000 + "]" * 100000 + "}"), "nested too deeply"),
    "unknown.abc": ("1 2 3\n", "unknown extension '.abc', must be .pcd"),
    "known.xyy": ("1 2 3\n", "volumes, .nii"),
    "none": ("1 2 3\n", "unknown extension ''"),
    "missing.pcd": (None, "no such file")}
for encoding in "ascii", "binary", "binary_compressed":
    FILES[f"fields_{encoding}.pcd"] = (many_fields([f"f{i}" for i in range(8192)], encoding), "SIZE and COUNT of a point are more than 2 GB")
    FILES[f"padding_{encoding}.pcd"] = (many_fields("_" * 8192, encoding), "SIZE and COUNT of a point are more than 2 GB")


class RefusedFiles(ToolTest):
    tool = "planes"

    def test_have_one_line_each(self):
        for name, (content, _) in FILES.items():
            if content is not None:
                self.write(name, content)
        self.write("list", "\n".join(FILES) + "\n")
        limit = limit_of_memory(3 << 30)  # headers cannot ask for more than their files hold
        self.run_tool("@list -json answers.json -quiet -threads 1", code=1, preexec_fn=limit)
        answers = self.lines("answers.json")
        self.assertEqual([answer["file"] for answer in answers], list(FILES))
        for answer, (_, said) in zip(answers, FILES.values()):
            self.assertEqual(answer["error"].split(": ")[0], answer["file"])
            self.assertIn(said, answer["error"])
            self.assertNotIn("memory", answer["error"])
        self.assertEqual(self.output, "")
        self.assertEqual(self.error, "".join(f"error: {answer['error']}\n" for answer in answers))

    def test_are_no_folders_and_may_be_read(self):
        self.write("box.off", box_off())
        (self.folder / "folder.pcd").mkdir()
        self.fails(1, "folder.pcd: is a folder", "box.off -target folder.pcd", tool="align")
        if os.geteuid() != 0:
            self.write("locked.pcd", "x").chmod(0)
            self.fails(1, "locked.pcd: cannot be opened", "locked.pcd")
