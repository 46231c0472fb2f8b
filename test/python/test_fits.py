"""The fits on small made-up tables: known coefficients come back, and a header is written the same twice."""
import argparse
import contextlib
import io
import pathlib
import types
from unittest import mock

from tool_run import ToolTest, need, np

need("bench", "fits")
import bench
import fit_frames
import fit_planes
import fit_segments
import fit_rotations
import fits
import solids


def made_up_rows(random, num_models=60, per_cloud=6):
    """Rows of fit_planes: a plane is right by chance, with log odds that the first terms give."""
    rows = []
    for model in range(num_models):
        for kind, count in enumerate(fit_planes.NUM_TERMS):
            for _ in range(per_cloud):
                terms = np.zeros(7)
                terms[:count] = 1, *random.normal(size=count - 1)
                terms[count - 1] = 1 if kind < 2 else terms[count - 1]
                right = random.uniform() < 1 / (1 + np.exp(-(0.5 - 2 * terms[1])))
                share = 0.98 if right else 0.5
                rows.append([f"m{model}", fit_planes.KINDS[kind], kind, share, share, 0.95 + 0.01 * random.normal(), 0.01, *terms])
    return rows


class Fits(ToolTest):
    def test_known_coefficients_come_back(self):
        random = np.random.default_rng(1)
        terms = np.c_[np.ones(4000), 10 * random.normal(size=4000), random.normal(size=4000)]
        p = 1 / (1 + np.exp(-terms @ [0.5, 0.1, -2]))
        found, errors = fits.logistic(terms, random.uniform(size=4000) < p)
        self.assertTrue((np.abs(found - [0.5, 0.1, -2]) < 4 * errors).all(), found)
        shares, _ = fits.logistic(terms, p)  # outcomes that are shares
        np.testing.assert_allclose(shares, [0.5, 0.1, -2], atol=1e-3)

    def test_few_examples_are_refused(self):
        words = "rotations: 34 examples of one of both kinds, must be 100"
        self.assertRaisesRegex(bench.BadInput, words, fits.logistic, np.ones((500, 2)), np.arange(500) < 34, name="rotations")

    def test_numbers_are_rounded_by_their_errors(self):
        self.assertEqual(fits.rounded([1.23456, -12.3456, 0.5], [0.1, 4.0, 100]), ["1.235", "-12.35", "0"])

    @mock.patch("sys.argv", ["fit_planes.py"])
    def test_planes_write_the_same_header_twice(self):
        rows, texts = made_up_rows(np.random.default_rng(2)), []
        for name in ("a.h", "b.h"):
            table = fit_planes.Table(rows)
            fit, errors = fit_planes.fit_table(table)
            arguments = argparse.Namespace(output=f"{self.folder}/{name}", fold=0)
            fits.write_header(arguments, fit_planes.header(table, fit, errors), (["<array>"],))
            texts.append(pathlib.Path(self.folder, name).read_bytes())
        self.assertEqual(*texts)
        self.assertIn(b"fit_planes.py --fold 0; do not edit", texts[0])
        self.assertIn(b"kConfidenceFit", texts[0])
        for kind in range(3):
            self.assertLess(abs(fit[kind][1] + 2), 4 * errors[kind][1])
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            fit_planes.print_fit(table, fit, "Made up")
        self.assertIn("surface", printed.getvalue())

    def test_shapes_have_their_folds(self):
        random = np.random.default_rng(3)
        mesh = solids.folded_body("prism", solids.folded_curve(5, random), 5, random)
        rotated = mesh.vertices @ solids.about_z(2 * np.pi / 5).T
        gaps = np.linalg.norm(rotated[:, None] - mesh.vertices[None], axis=2).min(1)
        self.assertLess(gaps.max(), 1e-9)

    def test_frames_are_right_in_any_order_and_about_an_axis_of_revolution(self):
        own = bench.random_rotation(np.random.default_rng(4))
        about = solids.about_z(0.4)
        right = lambda axes, axis: fit_frames.is_right(types.SimpleNamespace(axes=axes, revolution_axis=axis), own)
        self.assertTrue(right(own[:, [2, 0, 1]] * (-1, 1, -1), -1))
        self.assertEqual([right(own @ about, axis) for axis in (-1, 0, 2, 3)], [False, False, True, True])

    def test_frames_find_the_weights(self):
        random, rows, weights = np.random.default_rng(5), [], np.array([-1.0, 2.0])
        for _ in range(400):
            x = np.c_[np.ones(4), random.normal(size=4)]
            p = np.exp(np.r_[0, x @ weights])
            chosen = random.choice(5, p=p / p.sum())
            rows.append([False, [i + 1 == chosen for i in range(4)], x.tolist()])
        found, errors = fit_frames.fit_weights(rows)
        self.assertTrue((np.abs(found - weights) < 4 * errors).all(), found)

    def test_headers_hold_all_numbers(self):
        two = np.array([1.0, 2.0]), np.array([0.1, 0.1])
        self.assertIn("{1.000, 2.000}", fit_rotations.header([two[0]] * 3, [two[1]] * 3, ["1 of 2"] * 3))
        self.assertIn("1.000, 2.000", fit_frames.header([two, two], 3, 1))
        weights = np.ones(9), np.full(9, 0.1), 0.1, 5
        self.assertEqual(fit_segments.header({"concavity": weights}, 1).count("1.000"), 9)
