"""The tools of the map, of views and of parts."""
from tool_run import TETRAHEDRON, Image, ToolTest, box_off, mug, np, off, pcd, pcd_header, ply_points, xyz


class Map(ToolTest):
    tool = "map"
    files = dict(box=("box.off", box_off(1.4)))

    def test_points_on_the_planes_of_a_box_are_the_most_symmetric(self):
        report = self.report(self.box, "box.ply -quiet")
        points, _ = ply_points(self.folder / "box.ply")
        self.assertEqual((report["num_points"], len(points)), (10000, 10000))
        distance = abs(xyz(points)).min(axis=1)
        self.assertGreater(points["intensity"][distance < 0.05].mean(), 0.85)
        self.assertLess(points["intensity"][distance > 0.5].mean(), 0.75)

    def test_shows_on_a_terminal_how_far_it_is(self):
        _, shown = self.at_terminal(self.box, "-points", "150000", "-grid", "16")
        self.assertIn("\rMapping back to points [", shown)
        self.assertIn(" 66 %", shown)

    def test_writes_a_vtk_image_and_slices(self):
        self.run_tool(self.box, "-quiet -cells 20 -size 50 -volume a.vti -slices a.png")
        self.assertIn('WholeExtent="0 11 0 14 0 19"', self.text("a.vti"))
        self.assertIn('Name="symmetry"', self.text("a.vti"))
        self.assertEqual(Image.open(self.folder / "a.png").size, (158, 50))

    def test_a_box_has_three_axes_of_half_turns_and_a_center(self):
        common = "-quiet -grid 32 -points 3000"
        axes = self.report(self.box, common, "-of axes -fold 2 -png a.png")["axes"]
        self.assertIn("symmetry of the axes through the points", self.output)
        self.assertEqual(Image.open(self.folder / "a.png").size, (800, 800))
        self.assertGreaterEqual(len(axes), 3)
        for axis in axes[:3]:
            self.assertEqual(axis["fold"], 2)
            # 2 cells of 16 in the cube are wide; measured: 1 to 2 degrees
            self.assertGreater(max(map(abs, axis["direction"])), 0.995)
            self.assertGreater(axis["symmetry"], 0.9)
        np.testing.assert_allclose(self.report(self.box, common, "-of centers")["centers"][0]["point"], 0, atol=0.2)

    def test_refuses_folds_and_kinds_that_have_no_meaning(self):
        self.fails(2, "a rotation of order 1 changes nothing", self.box, "-of axes -fold 1")
        self.run_tool(self.box, "-of lines", code=2)


class Viewpoint(ToolTest):
    tool = "viewpoint"
    files = dict(box=("box.off", box_off(1.4)), tetrahedron=("t.off", TETRAHEDRON))

    def test_lists_views_by_their_score(self):
        """The module has the same views: test_depth_cameras."""
        answer = self.report(self.box, "-quiet")
        self.assertEqual((len(answer["best"]["pose"]), answer["good"][0]), (16, answer["best"]))
        self.assertGreater(min(map(abs, answer["best"]["direction"])), 0.3, "from a corner")
        self.assertGreater(max(map(abs, answer["worst"]["direction"])), 0.99, "along its planes")
        self.assertIn("worst", self.output)
        self.assertGreater(self.report(self.box, "-quiet -as_published -points 2000")["best"]["score"], answer["best"]["score"], "all maxima")
        scores = [view["score"] for view in self.report("t.off -quiet -views 8 -separation 15")["good"]]
        self.assertEqual((len(scores) > 4, scores), (True, sorted(scores, reverse=True)))


class Segment(ToolTest):
    tool = "segment"
    vertices, quads = mug()
    files = dict(mesh=("mug.off", off(vertices, quads)))

    def labels(self):
        return np.loadtxt(self.folder / "out.seg", int)

    def test_writes_a_segment_for_each_face_a_tree_and_a_picture(self):
        tree = self.report(self.mesh, "out.seg -parts 3 -size 300 -png p.png -html p.html")
        self.assertIn('"part 3: ', self.text("p.html"), "parts one by one")
        self.assertEqual((len(self.labels()), set(self.labels())), (len(self.quads), {0, 1, 2}))
        sizes = np.bincount(self.labels())
        self.assertEqual([tree["elements"], [each["size"] for each in tree["segments"]]], ["faces", sizes.tolist()])
        self.assertEqual((len(tree["tree"]), tree["tree"][0]["parent"]), (5, -1), "three leaves of a binary tree")
        self.assertNotEqual(tree["tree"][0]["planes"], [])
        self.assertIn("3 parts", self.error)
        self.assertEqual(self.output, f"3 parts of {sizes[2]} to {sizes[0]} faces\n")
        self.assertEqual(Image.open(self.folder / "p.png").size, (300, 300))
        self.run_tool(self.mesh, "-parts 3 -size 300 -up 1,0,0 -png q.png")
        self.assertNotEqual((self.folder / "p.png").read_bytes(), (self.folder / "q.png").read_bytes())
        many = self.report(self.mesh, "-parts 1000")
        self.assertIn(f"mug.off: num_parts = 1000, {len(many['segments'])} possible: parts are made of", self.error)
        self.assertIn(many["reason"], self.error)

    def test_methods_of_the_paper(self):
        for flag in ("", "-as_published"):
            self.run_tool(self.mesh, "out.seg -method splitting -depth 1 -quiet", flag)
            self.assertEqual((self.labels().max(), self.error), (1, ""), flag)

    def test_labels_points_of_clouds_and_keeps_their_fields(self):
        centers = np.array([self.vertices[quad].mean(axis=0) for quad in self.quads])
        cloud = self.write("cloud.pcd", pcd(centers, weight=np.full(len(centers), 7.0)))
        self.run_tool(cloud, "labeled.pcd -parts 2 -png p.png")
        header = pcd_header(self.folder / "labeled.pcd")
        self.assertCountEqual(header["FIELDS"], ["x", "y", "z", "weight", "label"])
        self.assertEqual(header["WIDTH"], [str(len(centers))])
        self.run_tool(cloud, "out.seg", code=1)  # a cloud has no faces

    def test_colors_the_faces_of_a_mesh_in_ply(self):
        self.run_tool(self.mesh, "parts.ply -parts 2")
        self.assertIn(f"element face {len(self.quads)}", self.text("parts.ply"))
        self.assertIn("property int label", self.text("parts.ply"))

    def test_refuses_what_does_not_fit_together(self):
        for flags in ("out.obj", "-parts -1"):
            self.run_tool(self.mesh, flags, code=2)
