"""Shapes as other programs write them: what they mean is read, and what is left out is said."""
import os
import struct
import threading

from test_refused_files import SQUARE, XYZ, glb, pcd, ply
from tool_run import ToolTest, np, pcd_header, pcd_points, ply_text, xyz

POINTS = np.array([(x, y, z) for x in (1, 4) for y in (2, 5, 7) for z in (3, 6, 8, 9.5, 10)])
CORNERS = np.array([(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0)])
FACES = "3 0 1 2\n4 0 1 2 3\n"
FACE_LIST = "element face 2\nproperty list uchar int vertex_indices\n"


def rows(line="{} {} {}\n", points=POINTS):
    """A line of text for each point."""
    return "".join(line.format(*point) for point in points)


def meshes(corners=CORNERS, xyz=XYZ):
    """A triangle and a square as text of each kind."""
    vertices = rows(points=corners)
    return {"a.off": "OFF\n4 2 0\n" + vertices + FACES, "a.obj": rows("v {} {} {}\n", corners) + "f 1 2 3\nf 1 2 3 4\n",
            "a.ply": ply("ascii", "element vertex 4\n" + xyz + FACE_LIST, vertices, FACES).decode()}  # fmt: skip


def facet(*corners):
    """Of STL as text."""
    vertices = rows("   vertex {} {} {}\n", CORNERS[list(corners)])
    return f" facet normal 0 0 1\n  outer loop\n{vertices}  endloop\n endfacet\n"


SQUARE_STL = f"solid s\n{facet(0, 1, 2)}{facet(0, 2, 3)}endsolid s\n"


def little(kind, *values):
    return np.array(values, "<" + kind).tobytes()


class ShapeInput(ToolTest):
    """The tool of parts writes all that it read: the polygons of a mesh, or the fields of a cloud."""
    tool = "segment"

    def mesh(self, name, content=None):
        """Vertices and polygons of a mesh, and the type of its coordinates."""
        if content is not None:
            self.write(name, content)
        self.run_tool(name, "out.ply -parts 1 -threads 1")
        header, vertices, polygons = ply_text(self.text("out.ply"))
        self.assertIn("element face", header)
        return vertices, polygons, header.split("property ")[1].split()[0]

    def cloud(self, name, content=None):
        """The points of a cloud with all their fields, and the header of PCD."""
        if content is not None:
            self.write(name, content)
        self.run_tool(name, "out.pcd -parts 1 -threads 1")
        return pcd_points(self.folder / "out.pcd"), pcd_header(self.folder / "out.pcd")

    def assert_points(self, name, content, expected=POINTS):
        points, _ = self.cloud(name, content)
        np.testing.assert_array_equal(xyz(points), expected, name)
        return points

    def test_meshes_of_every_kind(self):
        for name, content in (*meshes().items(),
                              ("same_line.off", "OFF 4 2 0\n# comment\n" + SQUARE + "3 0 1 2 255 0 0\n4 0 1 2 3\n"),
                              ("glued.OFF", "OFF4 2 0\n" + SQUARE + FACES + "2 0 1\n"),
                              ("color.off", "COFF\n4 2 0\n" + rows("{} {} {} 9 9 9 9\n", CORNERS) + FACES)):
            vertices, polygons, kind = self.mesh(name, content)
            np.testing.assert_array_equal(vertices, CORNERS, name)
            self.assertEqual((polygons, kind), ([[0, 1, 2], [0, 1, 2, 3]], "float"), name)

    def test_points_of_columns_and_of_files_without_faces(self):
        self.assert_points("a.xyz", "# x y z red\n" + rows("{} {} {} 255\n\n"))
        self.assert_points("a.obj", "# points\n" + rows("  v {} {} {}\n"))
        self.assert_points("a.off", "OFF\n30 0 0\n" + rows())

    def test_corners_of_stl_are_joined(self):
        for content in (SQUARE_STL, SQUARE_STL.upper(), *(before + SQUARE_STL for before in ("\n\n", "# made by hand\n", "\t"))):
            vertices, polygons, _ = self.mesh("square.stl", content)
            np.testing.assert_array_equal(vertices[polygons[0]], CORNERS[:3], content)
            self.assertEqual((len(vertices), len(polygons)), (4, 2))
        triangle = struct.pack("<80s I 12f 2x", b"", 1, 0, 0, 1, *CORNERS[:3].ravel())
        for behind in (b"", b"\n", b"1234567"):
            vertices, polygons, _ = self.mesh("binary.stl", triangle + behind)
            np.testing.assert_array_equal(vertices[polygons[0]], CORNERS[:3])

    def test_count_of_binary_stl_may_be_wrong_where_its_size_tells(self):
        for count in (0, 1, 2**32 - 1):
            triangles = b"".join(struct.pack("<12f 2x", 0, 0, 1, *CORNERS[corners].ravel()) for corners in ([0, 1, 2], [0, 2, 3]))
            vertices, polygons, _ = self.mesh("count.stl", b"exported".ljust(80) + struct.pack("<I", count) + triangles)
            self.assertEqual((len(vertices), len(polygons)), (4, 2))
            self.assertIn(f"its count, {count} for 2 triangles", self.error)

    def test_marks_of_text_are_no_text(self):
        for encoding in ("utf-8-sig", "utf-16"):
            for name, text in {**meshes(), "a.stl": SQUARE_STL}.items():
                vertices, polygons, _ = self.mesh(name, text.encode(encoding))
                self.assertEqual((len(vertices), len(polygons)), (4, 2), (name, encoding))
            self.assert_points("a.xyz", rows().encode(encoding))
            self.assert_points("a.pcd", pcd(30, "ascii\n", rows()).decode().encode(encoding))

    def test_coordinates_may_be_in_capitals(self):
        self.assert_points("a.ply", ply("ascii", "element vertex 30\n" + "".join(f"property float {c}\n" for c in "XYZ"), rows()))
        self.assert_points("a.pcd", pcd(30, "ascii\n", rows(), fields="X Y Z"))

    def test_points_of_range_grids(self):
        elements = (f"obj_info num_cols 31\nobj_info num_rows 1\nelement vertex 30\n{XYZ}"
                    "element range_grid 31\nproperty list uchar int vertex_indices\n")
        self.assert_points("grid.ply", ply("ascii", elements, rows(), "0\n", "".join(f"1 {k}\n" for k in range(30))))

    def test_binary_gltf(self):
        def primitive(mode):
            return f'{{"attributes":{{"POSITION":0}},"mode":{mode}}}'

        for mode in (4, 6):  # triangles, a fan
            vertices, polygons, _ = self.mesh("mesh.glb", glb(primitive(mode)))
            np.testing.assert_array_equal(vertices[polygons[0]], CORNERS[:3] + (0, 0, 5), "in the frame of the scene")
            self.assertEqual(len(polygons), 1)
        self.assert_points("points.glb", glb(primitive(0), POINTS), POINTS + (0, 0, 5))

    def test_coordinates_that_float_cannot_hold_are_shifted(self):
        """Map coordinates in meters; the spacing of float there is half a meter. The shift is exact."""
        far = np.array([500000.25, 5000000.125, 100])
        corners = CORNERS + far
        for name, content in meshes(corners, XYZ.replace("float", "double")).items():
            vertices, _, kind = self.mesh(name, content)
            np.testing.assert_array_equal(vertices, corners, name)
            self.assertEqual(kind, "double", "of the input frame")
        lines = rows(points=POINTS + far)
        for name, content in (("b.xyz", lines), ("b.pcd", pcd(30, "ascii\n", lines, sizes="8 8 8"))):
            self.assert_points(name, content, POINTS + far)

    def test_extents_that_are_no_normal_numbers_do_no_harm(self):
        for x in ("1e300", "0", "1"):
            self.fails(1, "tiny.pcd", self.write("tiny.pcd", pcd(2, "ascii\n", f"{x} 0 0\n{x} 5e-324 0\n", sizes="8 8 8")))
            self.assertNotIn("nan", self.error)

    def test_ply_lists_of_any_type(self):
        faces = "".join(f"7 {face}\n" for face in FACES.splitlines())
        lengths = "char", "uchar", "short", "ushort", "int", "uint", "int8", "uint32"
        for length, index in zip(lengths, ("uint", "int", "uint16", "ushort", "char", "uchar", "short", "uint")):
            elements = f"element vertex 4\n{XYZ}element face 2\nproperty uchar flags\nproperty list {length} {index} vertex_index\n"
            _, polygons, _ = self.mesh("a.ply", ply("ascii", elements, SQUARE, faces))
            self.assertEqual(polygons, [[0, 1, 2], [0, 1, 2, 3]], (length, index))
            self.assertNotIn("left out", self.error)
        elements = f"element vertex 3\n{XYZ}element face 1\nproperty list ushort uint vertex_indices\n"
        for name, order in (("little", "<"), ("big", ">")):
            body = CORNERS[:3].astype(order + "f4").tobytes() + struct.pack(order + "H3I", 3, 2, 1, 0)
            vertices, polygons, _ = self.mesh("b.ply", ply(f"binary_{name}_endian", elements, body))
            np.testing.assert_array_equal(vertices, CORNERS[:3])
            self.assertEqual(polygons, [[2, 1, 0]], order)

    def test_ply_strips_of_triangles(self):
        elements = f"element vertex 4\n{XYZ}element tristrips 1\nproperty list int int vertex_indices\n"
        _, polygons, _ = self.mesh("a.ply", ply("ascii", elements, SQUARE, "8 0 1 3 2 -1 0 1 2\n"))
        self.assertEqual(polygons, [[0, 1, 3], [3, 1, 2], [0, 1, 2]], "the same side is in front")

    def test_ply_properties_of_any_type_and_order(self):
        body = b"".join(little("u1", 9) + little("f4", *point) for point in POINTS)
        self.assert_points("a.ply", ply("binary_little_endian", "element vertex 30\nproperty uchar red\n" + XYZ, body))
        names = "uchar red", "uchar green", "uchar blue", "float z", "float nx", "float x", "float y"
        elements = "element vertex 30\n" + "".join(f"property {name}\n" for name in names)
        points = self.assert_points("b.ply", ply("ascii", elements, rows("1 2 3 {} 0.5 {} {}\n", POINTS[:, [2, 0, 1]])))
        self.assertEqual(points.dtype.names, ("label", "rgb", "z", "normal_x", "x", "y"))
        self.assertEqual((points["rgb"].tobytes()[:4], points["normal_x"][0]), (b"\3\2\1\0", 0.5))
        whole = POINTS.round() * (-1, 1, 1)
        properties = "property int x\nproperty short y\nproperty uchar z\n"
        self.assert_points("c.ply", ply("ascii", "element vertex 30\n" + properties, rows("{:.0f} {:.0f} {:.0f}\n", whole)), whole)
        elements = f"element vertex 30\nproperty list uchar int parts\n{XYZ}element edge 1\nproperty int a\n"
        self.assert_points("d.ply", ply("ascii", elements, rows("2 0 1 {} {} {}\n"), "7\n"))
        for left_out in ("list parts of the vertices left out", "1 of element edge left out"):
            self.assertIn(left_out, self.error)
        camera = "element camera 1\nproperty float viewportx\nproperty float viewporty\n"
        for width, expected in (("10", "10"), ("7.5", "30")):  # pixels are whole
            _, header = self.cloud("e.ply", ply("ascii", f"{camera}element vertex 30\n{XYZ}", f"{width} {30 / float(width)}\n", rows()))
            self.assertEqual(header["WIDTH"], [expected])

    def test_pcd_with_empty_padding_and_whole_coordinates(self):
        body = b"".join(little("f4", *point) + little("u1", k, 0, 0, 0) for k, point in enumerate(POINTS))
        padded = pcd(30, "binary\n", body, fields="x y z _ ring _", sizes="4 4 4 1 1 1", types="F F F U U U\nCOUNT 1 1 1 0 1 3")
        points = self.assert_points("a.pcd", padded)
        np.testing.assert_array_equal(points["ring"], range(30))
        whole = POINTS.round() * (-1, 10000, 1)
        self.assert_points("b.pcd", pcd(30, "ascii\n", rows("{:.0f} {:.0f} {:.0f}\n", whole), sizes="2 4 1", types="I I U"), whole)

    def test_pcd_integers_of_every_size_and_several_values(self):
        lines = rows("+{} {:e} {} -128 65535 18446744073709551615 7 4294967295\n") + "nan 0 0 1 2 3 4 5\n"
        content = pcd(31, "ascii\n", lines, fields="x y z i u big pair", sizes="4 4 4 1 2 8 4", types="F F F I U U U\nCOUNT 1 1 1 1 1 1 2")
        points, _ = self.cloud("a.pcd", content)
        np.testing.assert_array_equal(xyz(points)[:30], POINTS)
        self.assertTrue(np.isnan(points["x"][30]))
        self.assertEqual([points[name][0] for name in ("i", "u", "big")], [-128, 65535, 2 ** 64 - 1])
        self.assertEqual(points["pair"][0].tolist(), [7, 4294967295])

    def test_obj_that_names_textures_and_normals_it_does_not_have(self):
        vertices = rows("v {} {} {}\n", CORNERS)
        for faces in ("f 1/1/1 2/2/2 3/3/3 4/4/4\n", "f 1//7 2//7 3//7 4//7\n", "f 1/5 2/6 3/7 4/8\n", "f -4 -3 -2 -1\n",
                      "f 1 2 \\\n 3 4\r\n"):
            found, polygons, _ = self.mesh("a.obj", f"mtllib no_such.mtl\no part\n{vertices}usemtl red\ns off\n{faces}")
            np.testing.assert_array_equal(found, CORNERS)
            self.assertEqual(polygons, [[0, 1, 2, 3]], faces)

    def test_columns_of_text(self):
        for name, head, line in (("cloud_compare.xyz", "//X Y Z\n", "{} {} {}\n"), ("words.xyz", "X Y Z R G B\n", "{} {} {} 9 9 9\n"),
                                 ("commas.txt", "", "{},{},{}\n"), ("mark.xyz", "\ufeff", "{} {} {}\r\n"),
                                 ("count.pts", "30\n", "{} {} {} -2047 9 9 9\n"), ("semicolons.csv", "", "{};{};{}\n"),
                                 ("tabs.asc", "", "{}\t{}\t{}\n"), ("names.csv", 'time,"x","y","z",id\n', "0.5,{},{},{},a\n"),
                                 ("paraview.csv", '"Temp","Points:0","Points:1","Points:2"\n', "7,{},{},{}\n"),
                                 ("last_cell_empty.csv", "id,x,y,z,comment\n", "7,{},{},{},\n"), ("labels.csv", "", "point,{},{},{}\n"),
                                 ("title.txt", "Points of a box\n\n", "{} {} {}\n"), ("sentence.xyz", "# made from x y z\n", "{} {} {}\n"),
                                 ("spaced.csv", " x , y , z \n", " {} , {} , {} ,\n")):
            self.assert_points(name, head + rows(line))
            if "9 9" in line or name == "names.csv":
                self.assertEqual(self.error.count("left out"), 1, name)
        self.assert_points("one_more.csv", rows("{},{},{},7\n"))
        self.assertIn(": 1 column besides x, y and z left out", self.error)
        self.assert_points("decimal_commas.csv", rows("{};{};{}\n").replace(".", ","))

    def test_pipes(self):
        for name in ("pipe.xyz", "pipe"):  # the second as <(...) of a shell
            os.mkfifo(self.folder / name)
            writer = threading.Thread(target=(self.folder / name).write_text, args=(rows(),))
            writer.start()
            self.assert_points(name, None)
            writer.join()
