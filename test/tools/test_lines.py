"""The tool of lines in a plane and the pictures it reads."""
import unittest

import tool_run
from tool_run import ToolTest, np


def triangle():
    """A dark isosceles triangle about x = 30 on light ground, its tip in row 6 of 48."""
    y, x = np.indices((48, 64))
    dark = (y >= 6) & (y < 42) & (abs(x - 30) <= (y - 6) // 2)
    return np.where(dark, 0, 255)[:, :, None].repeat(3, axis=2)


class Lines(ToolTest):
    tool = "lines"

    def line(self, picture, *flags):
        """The best line: normal, offset with x to the right and y upwards in pixels, and score."""
        line = self.report(self.write("a.png", tool_run.png(picture)), "-quiet", *flags)["shapes"][0]["lines"][0]
        a, b, c = line["coefficients"]
        sign = np.sign(a + b)
        return sign * a, sign * b, -sign * c, line["score"]

    def test_finds_the_line_of_a_picture(self):
        for flag in ("", "-filled"):
            a, _, offset, score = self.line(triangle(), flag)
            self.assertAlmostEqual(a, 1, delta=1e-3)
            self.assertAlmostEqual(offset, 30, delta=0.1)
            self.assertGreater(score, 0.95)
            self.assertIn("a.png", self.output)
        _, b, offset, _ = self.line(triangle().transpose(1, 0, 2))
        self.assertAlmostEqual(b, 1, delta=1e-3)
        self.assertAlmostEqual(offset, 63 - 30, delta=0.1, msg="upwards, of 64 rows")
        outline, filled = (self.report("a.png -quiet", flag)["shapes"][0]["num_points"] for flag in ("", "-filled"))
        self.assertEqual(filled, (triangle()[:, :, 0] == 0).sum())
        self.assertLess(outline, filled / 2)

    def test_reads_pgm_and_draws_without_a_display(self):
        y, x = abs(np.indices((15, 15)) - 7)
        plus = np.where((x * y == 0) & (x + y < 7), 255, 0).astype(np.uint8)
        self.write("plus.pgm", b"P5\n15 15\n255\n" + plus.tobytes())
        self.write("triangle.png", tool_run.png(triangle()))
        self.run_tool("plus.pgm triangle.png -quiet -columns 1 -size 40 -png a.png")
        pixels = tool_run.png_pixels(self.folder / "a.png")
        self.assertEqual(pixels.shape[:2], (84, 40))
        self.assertLess(pixels[18, 20, 0], 60, "the middle of a plus lies on four lines, its surroundings on none")
        self.assertTrue((pixels == (214, 94, 0)).all(axis=2).any(), "the contour")

    def test_refuses_what_it_cannot_use(self):
        self.run_tool(code=2)
        self.run_tool("missing.png", code=1)
        for name, content, said in (("broken.png", "no picture", "must be a PNG or binary PGM"),
                                    ("cut.pgm", "P5\n7 7\n255\nabc", "cut.pgm"),
                                    ("empty.png", tool_run.png(np.full((8, 8, 3), 255)), "shows nothing"),
                                    ("box.off", tool_run.box(), "8 distinct points, at least 20 are needed"),
                                    ("lattice.xyz", "".join(f"{i % 3} {i // 3 % 3} {i // 9}\n" for i in range(27)), "off a plane")):
            self.fails(1, said, self.write(name, content))


if __name__ == "__main__":
    unittest.main()
