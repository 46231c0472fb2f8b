"""The tool of scenes: objects on a table as a camera sees them."""
import unittest

import tool_run
from tool_run import ToolTest, np

WIDTH, HEIGHT = 320, 240


def seen(blocks):
    """What a camera at 0.1 -1.6 1.0 sees of blocks (center, half): rows of x y z, NaN where a ray meets none."""
    eye = np.array([0.1, -1.6, 1.0])
    forward = -eye / np.linalg.norm(eye)
    right = np.cross(forward, [0, 0, 1])
    right /= np.linalg.norm(right)
    down = np.cross(forward, right)
    y, x = np.divmod(np.arange(WIDTH * HEIGHT), WIDTH)
    rays = forward + np.outer((x - 159.5) / 190, right) + np.outer((y - 119.5) / 190, down)
    nearest = np.full(len(rays), np.inf)
    for center, half in blocks:
        a, b = ((np.array(center) + side * np.array(half) - eye) / rays for side in (-1, 1))
        enters, leaves = np.minimum(a, b).max(axis=1), np.maximum(a, b).min(axis=1)
        nearest = np.where((enters <= leaves) & (enters > 0), np.minimum(nearest, enters), nearest)
    with np.errstate(invalid="ignore"):
        return np.where(np.isfinite(nearest)[:, None], eye + nearest[:, None] * rays, np.nan).astype("<f4")


def table(*shifts):
    """Two boxes on a table whose top is z = 0."""
    boxes = [((0, 0.1, 0.12), (0.2, 0.1, 0.12)), ((0.15, -0.25, 0.1), (0.12, 0.08, 0.1))]
    return seen([((0, 0, -0.02), (0.7, 0.7, 0.02)), *((np.add(center, shift), half) for (center, half), shift in zip(boxes, shifts))])


def frame(points, rgb=False):
    """An organized PCD file; with colors, red of 200."""
    columns = [points, np.full((len(points), 1), 200 << 16, "<u4").view("<f4")] if rgb else [points]
    names = "x y z rgb".split()[:4 if rgb else 3]
    header = "VERSION 0.7\n" + "".join(f"{key} {' '.join(values)}\n" for key, values in (
        ("FIELDS", names), ("SIZE", "4" * len(names)), ("TYPE", "F" * len(names)), ("COUNT", "1" * len(names)))) + (
        f"WIDTH {WIDTH}\nHEIGHT {HEIGHT}\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {WIDTH * HEIGHT}\nDATA binary\n")
    return header.encode() + np.hstack(columns).tobytes()


BOXES = table((-0.35, 0.1, 0), (0.25, 0, 0))  # apart


class Scene(ToolTest):
    tool = "scene"

    def setUp(self):
        super().setUp()
        self.scene = self.write("scene.pcd", frame(BOXES, rgb=True))

    def test_writes_what_it_finds(self):
        report = self.report(self.scene, "completed.ply -max_points 1000 -png objects.png -html page.html")
        self.assertEqual(self.output.splitlines()[0], "1 supporting plane, 2 objects")
        self.assertEqual([len(report[key]) for key in ("objects", "supports", "junctions")], [2, 1, 0], "the boxes do not touch")
        self.assertEqual(report["viewpoint"]["from"], "rays")
        self.assertAlmostEqual(report["supports"][0]["coefficients"][2], 1, delta=0.01)
        num_added = 0
        for item in report["objects"]:
            self.assertEqual(len(item["frame"]["transform"]), 16)
            self.assertGreater(item["num_points"], 300)
            num_added += item.get("completed", {"num_added": 0})["num_added"]
        points, _ = tool_run.ply_points(self.folder / "completed.ply")
        self.assertEqual(len(points), np.isfinite(BOXES).all(axis=1).sum() + num_added)
        self.assertLessEqual({"object", "completed"}, set(points.dtype.names))
        self.assertGreater(min(tool_run.png_size(self.folder / "objects.png")), 100)
        page = self.text("page.html")
        for part in ("1 supporting plane, 2 objects", "</html>", '"picture":{"pixels":"yAAA', "2: ", "decided at 1.0 % of the diameter"):
            self.assertIn(part, page)

    def test_tells_what_touches(self):
        # A second box on the first one, off its middle.
        stack = self.write("stack.pcd", frame(table((0, 0, 0), (-0.1, 0.33, 0.24))))
        flags = "-no_frames -max_points 1000"
        report = self.report(stack, flags, "-ground 0,0,1,0")
        self.assertEqual(report["supports"][0]["coefficients"], [0, 0, 1, 0])
        for junction in report["junctions"]:
            self.assertEqual(junction["joined"], junction["objects"][0] == junction["objects"][1])
            self.assertIn(" explains ", self.output)
        together = self.report(stack, flags, "-no_separation")
        self.assertEqual([len(together["objects"]), together["junctions"]], [1, []])

    def test_refuses_what_is_no_scene(self):
        mesh = self.write("t.off", "OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        self.fails(1, f"{mesh}: is a mesh, must be a cloud as a sensor sees it", mesh)
        self.fails(1, "none.db", self.scene, "-database none.db")
        self.run_tool(self.scene, "-min_points 3", code=2)
        self.fails(2, "-ground = 0,0,1, must be four numbers A,B,C,D", self.scene, "-ground 0,0,1")
        self.run_tool(self.scene, "out.txt", code=2)
        self.run_tool(code=2)


if __name__ == "__main__":
    unittest.main()
