"""The tool of symmetries of object models: files of the BOP benchmark, of DOPE and of Isaac, and colors."""
import json

from tool_run import BOX_FACES, CYLINDER, SPHERE, TETRAHEDRON, VASE, Image, ToolTest, box_corners, box_off, lathe, mug, np
from tool_run import off, pcd, pcd_points, ply_points, rotation, xyz

FEW = "-quiet -points 2000 -grid 32"


def cube(properties, size, more, comment=""):
    """A cube as PLY whose sides have vertices of their own.

    :param size: squares along an edge
    :param more: what a vertex has besides its position, of its side, and u and v from 0 to 1 there
    """
    vertices, faces, (i, k) = [], [], np.indices((size + 1, size + 1)).reshape(2, -1)
    squares = np.flatnonzero((i < size) & (k < size))[:, None] + (0, size + 1, size + 2, 1)
    for side in range(6):
        normal, a = (-1) ** side * np.eye(3)[side // 2], np.eye(3)[(side // 2 + 1) % 3]
        b = np.cross(normal, a)
        faces += [(4, *square) for square in squares + len(vertices)]
        vertices += [(*normal + (2 * u - 1) * a + (2 * v - 1) * b, *more(side, u, v)) for u, v in zip(i / size, k / size)]
    header = (f"ply\nformat ascii 1.0\n{comment}element vertex {len(vertices)}\n" + "".join(f"property float {x}\n" for x in "xyz")
              + "".join(f"property {one}\n" for one in properties)
              + f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    return header + "".join(" ".join(map(str, row)) + "\n" for row in vertices + faces)


def colored_cube(has_red_side, names=("red", "green", "blue")):
    """One side is red where it is told, all others are gray."""
    return cube([f"uchar {name}" for name in names], 6, lambda side, u, v: (200, 20, 20) if side == 4 and has_red_side else (120, 120, 120))


def textured_cube(texture, is_printed):
    """The sides show the white half of the picture, but one: that shows the whole picture if it is printed."""
    return cube(("float texture_u", "float texture_v"), 1,
                lambda side, u, v: (0.05 + 0.9 * u, 0.05 + ((1 if is_printed and side == 4 else 0.45) - 0.1) * v),
                f"comment TextureFile {texture}\n")


def pyramid(n):
    corners = [(np.cos(a), np.sin(a), 0) for a in 2 * np.pi * np.arange(n) / n]
    return off([*corners, (0, 0, 1.3)], [list(range(n))[::-1], *([k, (k + 1) % n, n] for k in range(n))])


def prism(n):
    return lathe([(0.001, -0.7), (1, -0.7), (1, 0.7), (0.001, 0.7)], n)


def deltahedron(corners, edge):
    """The triangles whose edges have this length."""
    corners = np.array(corners, float)
    near = np.linalg.norm(corners[:, None] - corners, axis=2) < 1.01 * edge
    count = range(len(corners))
    return off(corners, [(i, j, k) for i in count for j in range(i) for k in range(j) if near[i, j] and near[j, k] and near[k, i]])


def greatest_distance(model):
    """Between two vertices of a text of off()."""
    lines = model.split("\n")
    vertices = np.loadtxt(lines[2:2 + int(lines[1].split()[0])], dtype=np.float32).astype(float)
    return np.sqrt(((vertices[:, None] - vertices) ** 2).sum(axis=2).max())


GOLDEN = (1 + np.sqrt(5)) / 2
ICOSAHEDRON = deltahedron([np.roll((0, a, b), k) for k in range(3) for a in (-1, 1) for b in (-GOLDEN, GOLDEN)], 2)


def num_composed(axes):
    """How many rotations Isaac composes: a turn about z with one about y and one about x, the identity among each."""
    about = [[np.eye(3)] for _ in range(3)]
    for text in axes:
        about["xyz".index(text[0])].append(rotation(np.eye(3)["xyz".index(text[0])], np.radians(float(text[2:]))))
    return len({tuple((z @ y @ x).round(3).ravel() + 0.0) for x in about[0] for y in about[1] for z in about[2]})


class Bop(ToolTest):
    tool = "bop"
    files = dict(box=("obj_000003.off", box_off()), vase=("obj_000012.off", VASE))

    def test_describes_a_box_as_the_benchmark_does(self):
        info = self.report(self.box, "-quiet")
        self.assertEqual(list(info), ["3"])
        box = info["3"]
        self.assertEqual(box["diameter"], 2 * np.sqrt(1 + 1.5 ** 2 + 4), "of the vertices, exactly")
        self.assertEqual([box[key + axis] for key in ("min_", "size_") for axis in "xyz"], [-1, -1.5, -2, 2, 3, 4])
        self.assertNotIn("symmetries_continuous", box, "what there is none of is left out")
        turns = np.reshape(box["symmetries_discrete"], (-1, 4, 4))
        self.assertEqual(len(turns), 3)
        for turn in turns:
            np.testing.assert_array_equal(turn[3], (0, 0, 0, 1), "row by row")
            self.assertAlmostEqual(np.linalg.det(turn), 1, delta=1e-9)
            self.assertAlmostEqual(np.trace(turn), 0, delta=1e-9, msg="by pi")
            np.testing.assert_allclose(abs(turn), np.eye(4), atol=0.02, err_msg="about a coordinate axis")

    def test_gives_bodies_of_revolution_an_axis_and_cylinders_a_flip(self):
        vase = self.report(self.vase, "-quiet")["12"]
        self.assertAlmostEqual(vase["diameter"], greatest_distance(VASE), delta=1e-9)
        self.assertNotIn("symmetries_discrete", vase)
        self.assertEqual(len(vase["symmetries_continuous"]), 1)
        self.assertAlmostEqual(abs(vase["symmetries_continuous"][0]["axis"][2]), 1, delta=1e-4)
        np.testing.assert_allclose(vase["symmetries_continuous"][0]["offset"][:2], 0, atol=0.01)
        cylinder = self.report(self.write("can.off", CYLINDER), "-quiet")["1"]
        self.assertEqual([len(cylinder[key]) for key in ("symmetries_continuous", "symmetries_discrete")], [1, 1])
        self.assertAlmostEqual(cylinder["symmetries_discrete"][0][10], -1, delta=1e-3, msg="end over end")

    def test_gives_a_sphere_an_axis_and_tilts_and_an_asymmetric_model_nothing(self):
        sphere = self.report(self.write("ball.off", SPHERE), "-quiet -sphere_angle 90")["1"]
        self.assertEqual([len(sphere[key]) for key in ("symmetries_continuous", "symmetries_discrete")], [1, 1])
        self.assertAlmostEqual(sphere["symmetries_discrete"][0][10], -1, delta=1e-9, msg="upside down")
        self.assertAlmostEqual(sphere["diameter"], greatest_distance(SPHERE), delta=1e-9)
        tetrahedron = self.report(self.write("m7.off", TETRAHEDRON), "-quiet")["7"]
        self.assertFalse({"symmetries_continuous", "symmetries_discrete"} & set(tetrahedron))
        self.assertIn("group C1", self.output)

    def test_explains_what_fails(self):
        self.assertIn("  tolerance ", self.run_tool(self.write("mug.off", off(*mug())), "-quiet -explain -failures failures"))
        self.assertIn("  rejected ", self.output)
        points, _ = ply_points(self.folder / "failures/mug_rejected_1.ply")
        self.assertEqual(len(points), 20_000)
        self.assertIn("red", points.dtype.names)

    def test_numbers_models_as_their_files_or_else_by_the_first_free_number(self):
        zero, plain = self.write("obj_000000.off", box_off()), self.write("vase.off", VASE)
        info = self.report(self.vase, self.box, plain, zero, "-quiet -points 1000")
        self.assertEqual(list(info), ["0", "1", "3", "12"], "by number")
        self.assertEqual(self.text("report.json").count("\n"), 6, "a line for each")
        self.fails(2, "both model 3", self.box, self.write("copy_3.off", box_off()))

    def test_takes_folders(self):
        for name, content in (("obj_000002.off", box_off()), ("obj_000010.off", "OFF\n1 0 0\n0 0 0\n"),
                              ("obj_000011.off", box_off()), ("other.off", box_off()), ("readme.txt", "no model")):
            self.write(f"models/{name}", content)
        self.fails(1, "obj_000010.off", "models -quiet -points 1000 -grid 32 -json report.json")  # it has no surface
        self.assertEqual(self.error.count("\n"), 1, self.error)
        self.assertEqual(set(json.loads(self.text("report.json"))), {"2", "11"})
        (self.folder / "empty").mkdir()
        self.fails(1, "holds no .pcd", "empty")

    def check(self, given, *models):
        """Compares models with a file. Returns the comparison."""
        path = given if isinstance(given, str) else self.write("given.json", json.dumps(given)).name
        self.run_tool(*models, FEW, f"-check {path} -report check.json")
        return json.loads(self.text("check.json"))

    def test_says_where_a_file_disagrees_with_the_surface(self):
        """The box has D2; its file lists one of three half turns."""
        half_turn = [1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1]
        given = {"3": {"symmetries_discrete": [np.reshape(half_turn, (4, 4)).tolist()]}, "5": {"diameter": 3.0},
                 "12": {"symmetries_continuous": [{"axis": [0, 0, 1], "offset": [0, 0, 0]}]}}
        found = self.check(given, self.box, self.vase, self.write("plain.off", box_off()))
        self.assertIn("model 12     file Cinf  surface Cinf  agree", self.output)
        self.assertIn("1 of 2 models disagree", self.output)
        self.assertEqual((found["missing"], found["disagreeing"]), (["1"], 1))
        box = found["models"]["3"]
        self.assertEqual((box["file"], box["surface"], len(box["disagreements"])), ("C2", "D2", 2), "axes y and z")
        for row in box["disagreements"]:
            self.assertAlmostEqual(row["angle"], 180, delta=1e-6)
            self.assertTrue(row["says"] == "surface only" and row["share"] > 0.97 and row["deviation_of_diameter"] < 0.01, row)
        self.run_tool(self.box, "-report check.json", code=2)  # nothing to compare with

    def test_shows_that_a_turn_in_a_file_is_none(self):
        given = {"symmetries_discrete": [[0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]]}
        box = self.check(given, self.box)["models"]["3"]
        self.assertEqual((box["file"], box["remark"]), ("C4", "lists 1 of the 3 rotations of C4"))
        row = box["disagreements"][0]
        # A quarter turn about z swaps sides of 2 and 3: the long sides, 2 x 2 x 4 of the area 52, land 0.5 inside or outside.
        self.assertTrue(row["says"] == "file only" and row["share"] < 0.5 and row["deviation"] > 0.3, row)
        self.run_tool(self.box, self.vase, "-quiet -check given.json", code=1)  # a file of one model

    def test_agrees_with_what_it_wrote_in_every_format(self):
        models = self.box, self.vase, self.write("obj_000013.off", prism(6)), self.write("obj_000014.off", TETRAHEDRON)
        self.run_tool(*models, FEW, "-json bop.json -isaac isaac.yaml -dope dope")
        self.assertIn('"3": ["x_180", "y_180", "z_180"]  # D2', self.text("isaac.yaml"))
        for path in ("bop.json", "isaac.yaml"):
            self.check(path, *models)
            self.assertIn("0 of 4 models disagree", self.output, path)
        for model in models[:3]:
            self.check(f"dope/{model.stem}/model_info.json", model)
            self.assertIn("0 of 1 models disagree", self.output, model)

    def test_writes_axes_for_dope_to_choose_from(self):
        self.run_tool(self.write("can.off", CYLINDER), self.write("none.off", TETRAHEDRON), FEW, "-dope dope")
        across, along = (entry["object"] for entry in json.loads(self.text("dope/can/model_info.json"))["align_axes"])
        np.testing.assert_allclose(np.abs(along), (0, 0, 1), atol=1e-3)
        self.assertAlmostEqual(np.dot(across, along), 0, delta=1e-9)
        self.assertEqual(json.loads(self.text("dope/none/model_info.json")), {}, "nothing to choose from")

    def test_writes_axes_for_isaac_that_compose_the_group(self):
        slanted = off(box_corners(1, 1.5, 2) @ rotation(np.array([1.0, 2, 3]), 0.7).T, BOX_FACES)
        bodies = {"C1": TETRAHEDRON, "C4": pyramid(4), "C7": pyramid(7), "D2": box_off(), "D3": prism(3), "D6": prism(6),
                  "O": box_off(1, 1), "T": deltahedron([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)], np.sqrt(8)), "I": ICOSAHEDRON,
                  "Cinf": VASE, "Dinf": CYLINDER, "O(3)": SPHERE, "slanted": slanted}
        self.run_tool(*(self.write(f"{k + 1}.off", content) for k, content in enumerate(bodies.values())), "-quiet -isaac axes.yaml")
        orders = {"C1": 1, "C4": 4, "C7": 7, "D2": 4, "D3": 6, "D6": 12, "O": 24}
        for group, line in zip(bodies, self.text("axes.yaml").splitlines(), strict=True):
            axes = json.loads(line.split(": ")[1].split("  #")[0])
            self.assertEqual(group in ("T", "I", "slanted"), "are only a part" in line, line)
            if group in orders:
                self.assertIn(f"# {group}", line)
                self.assertEqual(num_composed(axes), orders[group], line)
        for line in ('["z_full"]  # Cinf', '["x_full", "y_full", "z_full"]'):
            self.assertIn(line, self.text("axes.yaml"))

    def test_reads_what_others_write_of_isaac(self):
        self.write("two.yaml", '# two models\n"3": ["z_90", "z_180", "z_-90"]  # C4\n12: [\'x_full\', y_180]\n')
        found = self.check("two.yaml", self.box, self.vase)["models"]
        self.assertEqual([found[key]["file"] for key in ("3", "12")], ["C4", "Dinf"])
        self.write("node.yaml", '/**:\n  ros__parameters:\n    symmetry_axes: ["z_180"]\n    max_hypothesis: 252\n')
        self.assertEqual(self.check("node.yaml", self.box)["models"]["3"]["file"], "C2")
        # A long line takes memory in proportion to it, and no more of the stack than a short one.
        self.write("long.yaml", "a: [z_1" + ", z_1" * 100_000 + "]\n")
        self.assertEqual(self.check("long.yaml", self.box)["missing"], ["3"])

    def test_refuses_files_that_list_no_motions(self):
        reflection, stretch = ("[[%d,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]]" % x for x in (-1, 2))
        for name, content, said in (
                ("a.json", "[1]", "a.json: must be a JSON object"),
                ("a.json", '{"3": {"symmetries_discrete": [[1, 2]]}}', "model 3: symmetries_discrete[0], must be 16"),
                ("a.json", '{"3": {"symmetries_discrete": %s}}' % stretch, "rigid motion"),
                ("a.json", '{"3": {"symmetries_discrete": %s}}' % reflection, "rigid motion"),
                ("a.json", '{"3": {"symmetries_continuous": [{"axis": [0,0,0]}]}}', "must not be zero"),
                ("a.json", '{"3": {"symmetries_continuous": {"axis": [0,0,1]}}}', "must be a list"),
                ("a.yaml", 'symmetry_axes: ["w_180"]\n', "w_180, must be x, y or z"),
                ("a.yaml", 'symmetry_axes: ["z_half"]\n', "z_half, must be"),
                ("a.yaml", "symmetry_axes: [z 180]\n", "z 180, must be"),
                ("a.yaml", "a: 1\n", "a.yaml: must be JSON, or have lines such as"),
                ("a.yaml", "a" * 1_000_000 + "\n", "a.yaml: must be JSON, or have lines such as")):
            self.write(name, content)
            self.fails(1, said, self.box, "-check", name)
            self.assertEqual(self.error.count("\n"), 1)

    def test_warns_of_scans(self):
        self.run_tool(self.box, "scan.pcd", tool="scan")
        points = xyz(pcd_points(self.folder / "scan.pcd"))
        self.write("moved.pcd", pcd(points[np.isfinite(points).all(axis=1)] + 1))
        for scan in ("scan.pcd", "moved.pcd"):
            self.run_tool(scan)
            self.assertIn(f"{scan}: is a scan from one side, must be a whole object", self.error)
        self.run_tool(self.box, FEW)
        self.assertNotIn("scan", self.error)

    def test_asks_for_colors_only_when_it_is_told(self):
        plain, red = self.write("obj_1.ply", colored_cube(False)), self.write("obj_2.ply", colored_cube(True))
        self.assertIn("1 of 1 models have colors, which were not looked at", self.run_tool(red, FEW))
        self.assertIn("obj_2.ply  group O", self.output)
        self.assertNotIn("not looked at", self.run_tool(plain, red, FEW, "-color"))
        for said in ("obj_1.ply  group O", "obj_2.ply  group C4", "without its colors the group is O"):
            self.assertIn(said, self.output)
        # The same red cube with its colors as coordinates in a texture that it does not name.
        self.run_tool(self.write("obj_3.ply", colored_cube(True, ("texture_u", "texture_v", "other"))), FEW, "-color")
        self.assertIn("only those of vertices, and textures that PLY files name, can be read", self.output)

    def test_reads_the_texture_that_a_model_of_the_benchmark_names(self):
        pixels = np.full((64, 64, 3), 255, np.uint8)
        pixels[:32] = (255, 0, 0)
        Image.fromarray(pixels).save(self.folder / "print.png")
        white, red = (self.write(f"obj_{k + 1}.ply", textured_cube("print.png", k == 1)) for k in range(2))
        self.assertNotIn("not looked at", self.run_tool(white, red, FEW, "-color"))
        self.assertIn("obj_1.ply  group O", self.output)
        self.assertIn("obj_2.ply  group C1", self.output, "v runs from bottom to top: half of that side is red")
        self.fails(1, "missing.png", self.write("obj_3.ply", textured_cube("missing.png", True)), "-quiet -color")
