"""Shapes and drawings of the gallery: what they make is what they say."""
import os
import subprocess
import sys
import unittest
from pathlib import Path

from tool_run import Image, ToolTest, need, needs, np, random_pose

need("vtkmodules")

import pcl_symmetry

GALLERY = Path(__file__).resolve().parents[2] / "apps" / "gallery"
sys.path.insert(0, str(GALLERY))
import planar
import shapes


HEIGHT, ANGLE = np.linspace(-1, 1, 4000), np.pi * (3 - 5**0.5) * np.arange(4000)
DIRECTIONS = np.stack([np.sqrt(1 - HEIGHT**2) * np.cos(ANGLE), np.sqrt(1 - HEIGHT**2) * np.sin(ANGLE), HEIGHT], axis=1)


class Shapes(unittest.TestCase):
    def test_vehicles_and_the_teapot_have_the_plane_between_their_sides(self):
        for shape in (shapes.car, shapes.teapot):
            vertices, triangles = shape()
            found = pcl_symmetry.planes(pcl_symmetry.sample_mesh(vertices, triangles))
            self.assertTrue(found and abs(found[0].normal[1]) > np.cos(0.01) and abs(found[0].offset) < 0.01, shape.__name__)

    def test_a_sphere_of_marching_cubes_is_as_wide_as_asked_for(self):
        vertices, triangles = shapes.surface(shapes.ellipsoid((0, 0, 0), (1, 1, 1)), (-2, -2, -2), (2, 2, 2), 40)
        np.testing.assert_allclose(np.linalg.norm(vertices, axis=1), 1, atol=0.01)
        edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        _, count = np.unique(edges, axis=0, return_counts=True)
        self.assertTrue((count == 2).all(), "closed")

    def test_without_a_folder_it_prints_its_usage(self):
        result = subprocess.run([sys.executable, "-B", GALLERY / "shapes.py"], capture_output=True, text=True)
        self.assertEqual(result.returncode, 2)
        self.assertIn("usage", result.stderr)

    def test_a_polygon_has_a_line_through_each_corner_and_edge(self):
        for corners in (3, 4, 5):
            lines = planar.LineTransform(planar.contour(f"polygon {corners}") + (2, 1)).lines(least=0.99)
            self.assertEqual(len(lines), corners)
            step = np.diff(np.sort(lines[:, 0]))
            np.testing.assert_allclose(step, np.pi / corners, atol=1e-3)
            normals = np.array([np.cos(lines[:, 0]), np.sin(lines[:, 0])]).T
            np.testing.assert_allclose(normals @ (2, 1), lines[:, 1], atol=2e-3, err_msg="through the center")

    def test_noise_lowers_and_a_handle_moves_no_line(self):
        noise = [planar.LineTransform(planar.contour(f"starfish {size}")).lines()[0, 2] for size in (0, 0.02, 0.06)]
        self.assertEqual(noise, sorted(noise, reverse=True))
        mug = planar.LineTransform(planar.contour("mug 0.45")).lines()[:2]
        np.testing.assert_allclose(mug[:, 0], (np.pi / 2, 0), atol=2e-3)

    def test_the_transform_agrees_with_the_sum_over_cells(self):
        transform = planar.LineTransform(planar.contour("flower 4"))
        for t, k in ((0, 127), (31, 100), (90, 140)):
            self.assertAlmostEqual(transform.values[t, k], transform.value(transform.theta[t], transform.r[k]), delta=2e-3)


@unittest.skipUnless("scene" in pcl_symmetry.__all__, "the module was built without PCL")
class Views(unittest.TestCase):
    def test_of_animals_face_the_strongest_plane_and_the_worst_lie_in_it(self):  # Figure 16
        folder = Path(os.environ.get("PCL_SYMMETRY_MODELS", "build/pictures_models"))
        if subprocess.run(["bash", GALLERY.parent / "fetch_meshes.sh", folder, "bull", "elephant"], capture_output=True).returncode:
            self.skipTest("no meshes")
        for name in ("bull", "elephant"):
            shape = pcl_symmetry.read(folder / f"{name}.off")
            for seed in (1, 2, 3):
                planes = pcl_symmetry.planes(pcl_symmetry.sample_mesh(shape, seed=seed), approximate=True)
                normals, weights = zip(*((plane.normal, plane.score) for plane in planes.every))
                scores = np.abs(DIRECTIONS @ np.transpose(normals)) @ weights
                best, worst = pcl_symmetry.viewpoints(planes)[0].direction, DIRECTIONS[scores.argmin()]
                self.assertGreater(abs(normals[0] @ best), np.cos(np.radians(35)), f"{name} {seed}")
                self.assertLess(abs(normals[0] @ worst), np.sin(np.radians(10)), f"{name} {seed}")

    def test_as_published_the_worst_is_along_one_of_the_two_strongest_planes_and_the_best_along_none(self):  # Figure 16
        for shape in (shapes.car, shapes.chair):
            planes = pcl_symmetry.planes(pcl_symmetry.sample_mesh(*shape(), 2000), as_published=True)
            normals = np.array([plane.normal for plane in planes])
            scores = np.abs(DIRECTIONS @ normals.T) @ [plane.score for plane in planes]
            best, worst = pcl_symmetry.viewpoints(planes)[0], DIRECTIONS[scores.argmin()]
            self.assertGreaterEqual(best.score, scores.max(), "of all directions")
            self.assertGreater(abs(normals[0, 1]), 0.99, "between the sides")
            self.assertLess(np.abs(normals[:2] @ worst).min(), 0.05, shape.__name__)
            self.assertGreater(np.abs(normals[:2] @ best.direction).min(), 0.1, shape.__name__)


class Drawings(ToolTest):
    @needs("matplotlib")
    def test_frames_of_mugs_and_mailboxes_have_their_center_where_their_planes_meet(self):  # Figure 10
        import drawings

        for i, points in enumerate(map(drawings.sampled, drawings.mugs_and_mailboxes())):
            planes, some = pcl_symmetry.planes(points[::2], as_published=True), points[::10]
            diameter = np.linalg.norm(some[:, None] - some, axis=2).max()
            across = [next(plane for plane in planes if abs(plane.normal[k]) > np.cos(np.radians(5))) for k in range(3)]
            meet = np.linalg.solve([plane.normal for plane in across], [plane.offset for plane in across])
            for seed in range(3):
                turn = random_pose(seed)[0].astype("f")
                center = pcl_symmetry.frame(points @ turn.T).center
                self.assertLess(np.linalg.norm(center - turn @ meet), 0.01 * diameter, f"{i} {seed}")
            if not os.environ.get("TOOLS"):
                continue
            np.savetxt(self.folder / "turned.xyz", points @ turn.T, "%.9g")
            np.testing.assert_allclose(self.report("turned.xyz -quiet", tool="align")["center"], center, atol=1e-6)

    @needs("matplotlib", "open3d")
    @unittest.skipUnless(os.environ.get("TOOLS"), "needs the tools")
    def test_the_picture_of_the_first_page_is_what_is_found_today(self):
        if subprocess.run(["bash", GALLERY.parent / "fetch_meshes.sh", self.folder, "cow"], stdout=subprocess.DEVNULL).returncode:
            self.skipTest("the mesh cannot be fetched")
        tools = {**os.environ, "PATH": f"{os.environ['TOOLS']}:{os.environ['PATH']}"}
        drawing = [sys.executable, "-B", GALLERY / "drawings.py", "first_look", f"{self.folder}/now.png", f"{self.folder}/cow.off"]
        subprocess.run(drawing, env=tools, check=True, stdout=subprocess.DEVNULL)
        now, shown = (Image.open(path) for path in (f"{self.folder}/now.png", GALLERY.parent / "pictures/first_look.png"))
        off = np.abs(np.asarray(now, float) - np.asarray(shown, float))[..., :3].mean() / 255
        self.assertEqual((shown.text["Description"], shown.size), (now.text["Description"], now.size), "bash apps/gallery/make.sh --only first_look apps")
        self.assertLess(off, 0.005)

    @needs("matplotlib")
    def test_the_medial_axis_of_a_rectangle_is_a_ridge_with_a_branch_to_each_corner(self):
        across, along = np.arange(-1, 1.001, 0.01), np.arange(-0.49, 0.491, 0.01)
        border = [(x, y) for x in across for y in (0.5, -0.5)] + [(x, y) for y in along for x in (1, -1)]
        contour, picture = self.folder / "rectangle.txt", self.folder / "axis.png"
        np.savetxt(contour, border)
        subprocess.run([sys.executable, "-B", GALLERY / "drawings.py", "medial_axis", picture, contour], check=True, stdout=subprocess.DEVNULL)
        image = np.asarray(Image.open(picture), float)[:, :, :3].max(axis=2) / 255
        size = len(image)

        def is_dark(x, y):
            column, row = int(size * (0.5 + x / 2.24)), int(size * (0.5 - y / 2.24))
            return image[row - 2 : row + 3, column - 2 : column + 3].min() < 0.5

        for x, y in [(0, 0), (0.4, 0)] + [(x, y) for x in (-0.75, 0.75) for y in (-0.25, 0.25)]:
            self.assertTrue(is_dark(x, y), (x, y))
        for x, y in [(0, 0.25), (0.85, 0)]:
            self.assertFalse(is_dark(x, y), (x, y))
