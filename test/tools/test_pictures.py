"""Pictures and pages that tools write, with and without a display."""
import json
import os
import signal
import subprocess
from pathlib import Path

from tool_run import TOOLS, VASE, Image, ToolTest, box_off, np, pcd, points_on_sphere, wait_for


class Pages(ToolTest):
    tool = "planes"

    def scene(self, page):
        """The JSON in a page, its arrays of numbers decoded to their sizes in bytes."""
        text = self.text(page).split('id="scene">')[1].split("</script>")[0]
        return json.loads(text)

    @staticmethod
    def num_bytes(text):
        """Bytes that a base64 text holds."""
        return len(text) // 4 * 3 - text.count("=")

    def test_hold_everything_in_little_room(self):
        # A name that would end the script of the page.
        path = self.write("a </script>.off", box_off())
        self.run_tool(path, "-quiet -html upright.html -up 0,1,0")
        upright = self.scene("upright.html")
        self.assertEqual(upright["up"], [0, 1, 0])
        self.assertGreater(upright["view"][1], 0, "from above")
        self.run_tool(path, "-quiet -html a.html")
        page = self.text("a.html")
        self.assertLess(len(page), 1_500_000)
        self.assertTrue(page.startswith("<!DOCTYPE html>"))
        self.assertIn("The MIT License", page, "the license of three.js goes with it")
        for outside in ("src=", "href=", "@import", 'fetch("http'):
            self.assertNotIn(outside, page, "nothing comes from elsewhere")
        self.assertEqual(page.count("</script>"), 3)
        scene = self.scene("a.html")
        self.assertEqual((scene["title"], scene["text"]), (str(path), self.output))
        self.assertEqual([self.num_bytes(scene[key]) for key in ("points", "normals")], [120_000, 30_000])
        colors = np.array([color[4:-1].split(",") for color in scene["support_colors"]], float)
        self.assertLess(colors[0].sum(), 130, "dark blue")
        self.assertEqual(colors[-1].tolist(), [255, 234, 70], "yellow")
        self.assertGreater(np.diff(colors @ (0.2126, 0.7152, 0.0722)).min(), 0, "ever lighter")
        self.assertEqual(len(scene["panels"]), 3)
        for k, panel in enumerate(scene["panels"], 1):
            self.assertTrue(panel["label"].startswith(f"plane {k} (symmetry): "), panel["label"])
            self.assertEqual(self.num_bytes(panel["point_colors"]), 30_000)
            self.assertEqual(len(panel["planes"][0]["corners"]), 4)
        self.run_tool(self.write("vase.off", VASE), "-quiet -html v.html")
        self.assertEqual(len(self.scene("v.html")["panels"][0]["axes"][0]["ends"]), 2)

    def test_thin_large_clouds_and_leave_out_what_is_not_finite(self):
        points = points_on_sphere(450_000)
        points[0, 0] = np.nan
        self.run_tool(self.write("a.pcd", pcd(points)), "-quiet -html a.html")
        self.assertEqual(self.num_bytes(self.scene("a.html")["points"]), 12 * 150_000, "every third")

    def test_show_the_parts_of_a_mesh(self):
        self.run_tool(self.write("box.off", box_off()), "-quiet -parts 3 -html a.html", tool="segment")
        page = self.scene("a.html")
        num_triangles = 6 * 2
        self.assertEqual(self.num_bytes(page["mesh"]), 36 * num_triangles)
        self.assertEqual(self.num_bytes(page["panels"][0]["mesh_colors"]), 9 * num_triangles)
        self.assertFalse(page["panels"][0]["show_points"])
        self.assertEqual([len(panel["segments"]) for panel in page["panels"]], [3, 1, 1, 1], "a swatch for each part")


class Pictures(ToolTest):
    tool = "viewer"
    files = dict(box=("box.off", box_off(1.4)))
    no_display = {key: value for key, value in os.environ.items() if key != "DISPLAY"}

    def test_are_made_without_a_screen(self):
        pictures = set()
        for plane in ("1", "2"):
            self.run_tool(self.box, "-quiet -symmetries -screenshot a.png -plane", plane, env=self.no_display)
            self.assertEqual(Image.open(self.folder / "a.png").size, (1000, 750))
            pictures.add((self.folder / "a.png").read_bytes())
        self.assertEqual(len(pictures), 2)
        self.run_tool(self.box, "-quiet -symmetries -screenshot b.png -plane 9", env=self.no_display, code=2)
        self.assertIn("-plane: 9, must be <= 3", self.error)
        for tool, flag in (("planes", "-png -"), ("segment", "-png=-")):
            command = [TOOLS / f"pcl_symmetry_{tool}", self.box, "-quiet", *flag.split()]
            picture = subprocess.run(command, env=self.no_display, stdout=subprocess.PIPE, check=True).stdout
            self.assertEqual(picture[:4], b"\x89PNG", "on standard output")

    def test_hold_panels_of_several_scenes(self):
        self.run_tool(self.box, "-quiet -points 2000 -size 100 -png views.png -icon best.png", tool="viewpoint")
        self.assertEqual([Image.open(self.folder / name).size for name in ("views.png", "best.png")], [(300, 100), (100, 100)])
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["best.png", "box.off", "views.png"])
        best, *panels = (np.asarray(Image.open(self.folder / name)) for name in ("best.png", "views.png"))
        score, again, worst = np.split(panels[0], 3, axis=1)
        for picture in (best, score, again, worst):
            self.assertGreater(np.unique(picture.reshape(-1, picture.shape[2]), axis=0).shape[0], 10, "not blank")
        self.assertTrue((again != worst).any() and (score != again).any())

    def test_leave_nothing_behind_when_the_tool_is_stopped(self):
        """The X server that a picture is drawn on ends with the tool, whatever ends that."""
        names = [f"b{i}.off" for i in range(400)]
        for name in names:
            self.write(name, box_off(1.4))
        for stop in (signal.SIGTERM, signal.SIGKILL, signal.SIGINT):
            command = [TOOLS / "pcl_symmetry_planes", *names, "-png", "{}.png", "-quiet", "-threads", "1", "-json", "o.json"]
            tool = subprocess.Popen(command, cwd=self.folder, env=self.no_display, stdout=subprocess.DEVNULL)
            self.assertTrue(wait_for(lambda: self.children_of(tool.pid) and list(self.folder.glob("*.png")), 30))
            server, = self.children_of(tool.pid)
            tool.send_signal(stop)
            self.assertEqual(tool.wait(timeout=10), -stop)
            self.assertTrue(wait_for(lambda: not self.runs(server), 10), stop)

    @staticmethod
    def runs(pid):
        """Whether a process is there, and no zombie that nobody waited for."""
        try:
            return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
        except OSError:
            return False

    @staticmethod
    def children_of(pid):
        """Those that have become another program."""
        children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
        return [int(child) for child in children if Path(f"/proc/{child}/comm").read_text().strip() == "Xvfb"]

    def test_say_why_nothing_can_be_drawn(self):
        self.fails(1, "there is no display", self.box, env=self.no_display)
        self.assertIn("-screenshot FILE needs none", self.error)
        for tool, flags in (("planes", "-png a.png"), ("viewer", "-screenshot a.png")):
            self.fails(1, "Xvfb is missing", self.box, "-quiet", flags, tool=tool, env={**self.no_display, "PATH": "/nowhere"})
            self.assertEqual([path.name for path in self.folder.iterdir()], ["box.off"])
