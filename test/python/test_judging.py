"""How the programs of test/benchmark judge: poses, groups, segmentations, rankings and scenes that are known."""
import unittest

from tool_run import BOX_FACES, box_corners, need, np

need("open3d", "scipy", "sklearn", "pcl_symmetry")
import bench
import frames
import pcl_symmetry
import registration
import retrieval
import rotations
import scenes
import segmentation
import solids

Z = {"point": [0, 0, 0], "direction": [0, 0, 1]}


def pose(degrees, axis, way=(0, 0, 0)):
    return bench.rigid(rotated(degrees, axis), way)


def rotated(degrees, axis):
    return bench.rotation_about(np.zeros(3), np.array(axis) / np.linalg.norm(axis), np.radians(degrees))[:3, :3]


def symmetries(planes=(), axes=(), centers=()):
    planes = [{"coefficients": [*row, 0]} for row in np.eye(3)[list(planes)]]
    return {"planes": planes, "axes": axes, "centers": centers, "center": [0, 0, 0], "diagonal": 2.0}


def stone(seed, radii, at):
    """(T, 3, 3) triangles of a body without symmetry."""
    random = np.random.default_rng(seed)
    u, faces = solids.ball()
    bumps = bench.random_directions(random, 6)
    swell = (random.uniform(-0.45, 0.45, 6) * np.exp(4 * (u @ bumps.T - 1))).sum(-1)
    return (at + np.array(radii) * (1 + swell)[:, None] * u)[faces]


class Poses(unittest.TestCase):
    def error(self, estimate, **known):
        true = pose(50, (1, 2, 3), (4, 5, 6))
        return registration.pose_error(estimate @ true, true, symmetries(**known))

    def test_without_symmetry(self):
        np.testing.assert_allclose(pose(90, (0, 0, 1))[:3, 0], (0, 1, 0), atol=1e-9)
        np.testing.assert_allclose(self.error(pose(30, (1, 1, 0), (0.2, 0, 0))), (30, 0.1), atol=1e-9)
        np.testing.assert_allclose(self.error(pose(180, (0, 0, 1)), planes=[0]), (180, 0), atol=1e-5)

    def test_two_planes_make_a_half_turn(self):
        np.testing.assert_allclose(self.error(pose(180, (0, 0, 1)), planes=[0, 1]), (0, 0), atol=1e-5)
        np.testing.assert_allclose(self.error(pose(177, (0, 0, 1)), planes=[0, 1]), (3, 0), atol=1e-5)

    def test_axis_of_revolution(self):
        self.assertLess(self.error(pose(77, (0, 0, 1)), axes=[Z])[0], 1e-5)
        self.assertAlmostEqual(self.error(pose(180, (1, 0, 0)), axes=[Z])[0], 180, 5)
        self.assertLess(self.error(pose(180, (1, 1, 0)), axes=[Z], planes=[2])[0], 1e-5)  # over the plane across

    def test_sphere(self):
        error = self.error(pose(77, (3, 1, 2), (0, 0, 0.5)), centers=[{"point": [0, 0, 0]}])
        np.testing.assert_allclose(error, (0, 0.25), atol=1e-9)


class Segmentations(unittest.TestCase):
    def setUp(self):
        self.mesh = bench.make_mesh(box_corners(0.5, 0.5, 0.5), BOX_FACES)
        self.surface = segmentation.Surface(self.mesh)
        self.of = lambda *faces: segmentation.Segmentation(self.surface, np.array(faces)[self.mesh.polygons])

    def test_equal_segmentations_are_at_distance_0(self):
        found = segmentation.compare(self.surface, self.of(0, 0, 1, 1, 2, 2), self.of(5, 5, 3, 3, 4, 4))
        np.testing.assert_allclose(list(found.values()), 0, atol=1e-12)

    def test_rand_distance_counts_pairs(self):
        # 12 triangles, 66 pairs: 4 + 4 + 4 apart from one segment of 12: 66 - 3 * 6 = 48 pairs are told apart
        found = segmentation.compare(self.surface, self.of(0, 0, 1, 1, 2, 2), self.of(0, 0, 0, 0, 0, 0))
        self.assertAlmostEqual(found["rand"], 48 / 66)
        self.assertAlmostEqual(found["hamming"], 1 / 3)  # nothing is missing, two thirds are false
        self.assertTrue(np.isnan(found["cut"]))

    def test_cuts_are_as_far_apart_as_they_lie(self):
        # the borders of the faces below and above are one edge apart everywhere, there and back
        found = segmentation.compare(self.surface, self.of(1, 0, 0, 0, 0, 0), self.of(0, 1, 0, 0, 0, 0))
        self.assertAlmostEqual(found["cut"], 2 / self.surface.mean_radius)

    def test_labels_that_a_plane_swaps_agree_across_it(self):
        halves = np.array([0, 1, 2, 2, 2, 2])[self.mesh.polygons]
        self.assertAlmostEqual(segmentation.mirror_agreement(self.surface, halves, [0, 0, 1, 0]), 1)
        self.assertLess(segmentation.mirror_agreement(self.surface, halves, [0.6, 0, 0.8, 0]), 0.9)

    def test_bad_labels_get_a_sentence(self):
        self.assertRaisesRegex(bench.BadInput, "no_file.seg: is no list of labels", segmentation.read_labels, "no_file.seg", self.mesh)


class KnownAnswers(unittest.TestCase):
    def test_order_and_signs_of_axes_do_not_matter(self):
        axes = rotated(40, (1, 2, 0)) @ np.array([[0, 0, 1], [-1, 0, 0], [0, -1, 0]])
        self.assertAlmostEqual(frames.angle_of_axes(rotated(4, (1, 0, 0)) @ axes, rotated(40, (1, 2, 0))), 4, 5)

    def test_ties_of_a_prism_and_of_a_body_of_revolution(self):
        triangle = [{"coefficients": [np.cos(a), np.sin(a), 0, 0]} for a in np.radians([0, 60, 120])]
        ties = frames.Ties({"planes": triangle, "axes": [], "centers": []})
        self.assertAlmostEqual(ties.angle(rotated(62, (0, 0, 1)), np.eye(3)), 2, 5)
        self.assertAlmostEqual(ties.angle(rotated(45, (0, 0, 1)), np.eye(3)), 15, 5)
        ties = frames.Ties({"planes": [], "axes": [Z], "centers": []})
        self.assertLess(ties.angle(rotated(45, (0, 0, 1)), np.eye(3)), 1e-5)
        self.assertAlmostEqual(ties.angle(rotated(30, (1, 0, 0)), np.eye(3)), 30, 5)

    def test_solids_have_the_rotations_that_they_are_said_to_have(self):
        golden = (1 + 5**0.5) / 2
        known = {"rim of 5 spokes": ((0, 0, 1), 5), "gear of 16 teeth on a hub": ((0, 0, 1), 16), "goblet": ((0, 0, 1), 0),
                 "cube": ((1, 1, 1), 3), "tetrahedron": ((1, 1, 1), 3), "icosahedron": ((0, 1, golden), 5)}  # fmt: skip
        for solid in (solid for solid in solids.solids() if solid.name in known):
            mesh, (axis, order) = bench.make_mesh(solid.vertices, solid.faces), known[solid.name]
            points, axis = bench.sample(mesh, 500, np.random.default_rng(1)), np.array(axis) / np.linalg.norm(axis)
            about = lambda degrees: [bench.rotation_about(np.zeros(3), axis, np.radians(degrees))]
            with self.subTest(solid.name):
                self.assertLessEqual(rotations.excess(mesh, points, about(360 / order if order else 77)), 1)
                if order:
                    self.assertGreater(rotations.excess(mesh, points, about(360 / order) + about(180 / order)), 1)

    def test_surface_distance_is_the_least_over_the_symmetries(self):
        corners, thirds = np.array([[2, 0, 0], [0, 0, 1.0]]), [pose(120 * k, (0, 0, 1)) for k in range(3)]
        distance = rotations.surface_distance(pose(125, (0, 0, 1)), np.eye(4), corners, thirds)
        self.assertAlmostEqual(distance, 4 * np.sin(np.radians(2.5)))

    def test_measures_of_a_known_ranking(self):
        found = retrieval.scores(np.array([1, 4, 5]))
        self.assertEqual(found["nearest"], 1)
        self.assertAlmostEqual(found["tier1"], 1 / 3)  # among the first 3
        self.assertAlmostEqual(found["tier2"], 1)  # among the first 6
        self.assertAlmostEqual(found["e"], 2 * 3 / (32 + 3))
        best = 1 + 1 + 1 / np.log2(3)
        self.assertAlmostEqual(found["dcg"], (1 + 1 / 2 + 1 / np.log2(5)) / best)
        np.testing.assert_allclose(found["precision"][[0, 6, 19]], [1, 2 / 4, 3 / 5])  # recalls 0.05, 0.35 and 1

    def test_ranks_leave_the_query_out_and_equal_distances_go_by_index(self):
        distances = np.zeros((4, 4))
        ranks = retrieval.relevant_ranks(distances, np.array(["a", "b", "a", "a"]), 2)
        np.testing.assert_array_equal(ranks, [1, 3])

    def test_a_model_alone_in_its_class_is_no_query(self):
        judged = retrieval.judge(np.array([[0, 1, 2], [1, 0, 3], [2, 3, 0.0]]), np.array(["a", "a", "b"]))
        self.assertEqual(list(judged["class"]), ["a", "a"])
        self.assertEqual(judged["nearest"].mean(), 1)

    def test_distances_of_all_pairs_are_those_of_the_library(self):
        roots = np.random.default_rng(1).uniform(size=(3, 8, 6, 4))
        for weights, of_planes in ((retrieval.plane_weights(roots.shape[1:]), True), (1, False)):
            expected = [[pcl_symmetry.descriptor_distance(a, b, of_planes=of_planes) for b in roots] for a in roots]
            np.testing.assert_allclose(retrieval.l2(weights * roots), expected, atol=0.01)  # roots of rounding errors

    def test_descriptors_rotate_with_the_points(self):
        points = np.random.default_rng(1).normal(size=(300, 3)) * [0.5, 0.3, 0.15]
        for order, signs in retrieval.ROTATIONS[::5]:
            turned = points[:, list(order)] * signs
            expected = retrieval.gedt(turned, 12)
            np.testing.assert_allclose(retrieval.rotated_cubes(retrieval.gedt(points, 12), order, signs), expected, atol=1e-9)

    def test_all_turns_find_a_turned_copy(self):
        cubes = retrieval.unit(np.random.default_rng(1).uniform(size=(3, 2, 6, 6, 6)))
        copy = retrieval.rotated_cubes(cubes[:1], *retrieval.ROTATIONS[7])
        distances = retrieval.least_distances((np.concatenate([cubes, copy]), retrieval.rotated_cubes, retrieval.unit))
        self.assertLess(distances[0, 3], 1e-3)
        self.assertGreater(distances[0, 1], 0.1)

    def test_planes_rotate_with_their_normals(self):
        maps = np.zeros((1, 8, 16, 4))
        maps[0, 7, 0, 3] = 1  # nearly x, at the greatest r
        order, signs = next(r for r in retrieval.ROTATIONS if r[0] == (1, 2, 0) and tuple(r[1]) == (1, 1, 1))  # x becomes z
        turned = retrieval.rotated_planes(maps, order, signs)
        self.assertGreater(turned[0, 0, :, 3].max(), 0)  # theta is near 0
        self.assertEqual(turned[0, 3:].max(), 0)

    def test_objects_match_by_the_share_of_common_points(self):
        found, truth = np.array([0, 0, 0, 1, -1, 1]), np.array([1, 1, -1, 0, 0, 0])
        np.testing.assert_allclose(scenes.overlaps(found, truth, (2, 2)), [[0, 2 / 3], [2 / 3, 0]])

    def test_bands_of_occlusion(self):
        self.assertEqual([scenes.band_of(x) for x in (0, 0.1, 0.69, 0.7)], [0, 1, 3, None])

    def test_a_camera_sees_a_square_where_it_is(self):
        square = np.array([(-0.1, -0.1, 2), (0.1, -0.1, 2), (0.1, 0.1, 2), (-0.1, 0.1, 2)])[[[0, 1, 2], [0, 2, 3]]]
        depths = scenes.depths_of(square)
        hit = np.isfinite(depths)
        np.testing.assert_allclose(depths[hit], 2, atol=1e-9)
        self.assertLess(np.abs(scenes.rays()[hit, :2]).max(), 0.05)
        self.assertLess(abs(hit.sum() / 53**2 - 1), 0.1)  # 105 / 2 pixels

    def test_disparities_come_in_steps(self):
        noisy = scenes.with_noise(np.full((20, 20), 1.3), 1.0, bench.generator(1))
        steps = 1 / (scenes.STEP * noisy)
        np.testing.assert_allclose(steps, np.round(steps), atol=1e-6)
        self.assertGreater(noisy.std(), 0)

    def test_models_cut_objects_that_touch_where_no_symmetry_does(self):
        c, s = np.cos(0.6), np.sin(0.6)
        toward_camera = np.array([[1, 0, 0], [0, -s, -c], [0, c, -s]])
        stones = [stone(11, (0.06, 0.05, 0.07), (-0.045, 0, 0)), stone(12, (0.05, 0.06, 0.05), (0.05, 0, 0))]
        low = min(each[..., 2].min() for each in stones)
        table = np.array([(-0.5, -0.4, low), (0.5, -0.4, low), (0.5, 0.4, low), (-0.5, 0.4, low)])[[[0, 1, 2], [0, 2, 3]]]
        depths = np.stack([scenes.depths_of(each @ toward_camera.T + (0, 0, 0.8)) for each in (table, *stones)])
        frame = (scenes.rays() * np.where(np.isfinite(depths.min(0)), depths.min(0), np.nan)[..., None]).astype(np.float32)
        database = pcl_symmetry.Database(":memory:")
        mesh = lambda corners: bench.Mesh(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))
        database.build({name: bench.sample(mesh(each), 20_000, bench.generator(0)) for name, each in zip("ab", stones)})
        united = pcl_symmetry.scene(frame, complete=False)
        self.assertEqual(len(united), 1)
        found = pcl_symmetry.scene(frame, complete=False, database=database)
        self.assertEqual([object.models[0].name for object in found], ["a", "b"])
        for k in (1, 2):
            self.assertGreater((depths.argmin(0)[found.labels == k] == k).mean(), 0.97)
        self.assertEqual([junction.objects for junction in found.junctions], [(0, 1)])
