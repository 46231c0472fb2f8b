"""Planes of volumes: phantoms with known planes, tilted, cropped, noisy, with a lesion on one side; and none."""
import unittest

import pcl_symmetry
from tool_run import np, rotation


def soft(distance, width):
    return 1 / (1 + np.exp(np.clip(distance / width, -50, 50)))


def in_ellipsoid(x, center, radii):
    return soft((np.linalg.norm((x - center) / radii, axis=-1) - 1) * np.mean(radii), 0.6)


def head(x):
    """130 x 160 x 140 units: skull, brain, pairs of nuclei, ventricles and eyes, a nose; symmetric in x = 0."""
    side = abs(x) * (1, 0, 0) + x * (0, 1, 1)
    return (0.9 * in_ellipsoid(x, (0, 0, 0), (65, 80, 70)) - 0.4 * in_ellipsoid(x, (0, 0, 0), (59, 74, 64))
            + 0.3 * in_ellipsoid(side, (20, 10, 10), (10, 25, 12)) - 0.3 * in_ellipsoid(side, (9, -15, 5), (6, 18, 8))
            + 0.4 * in_ellipsoid(side, (25, 55, -20), (10, 8, 9)) + 0.6 * in_ellipsoid(side, (0, 80, -20), (8, 14, 10)))  # fmt: skip


def spiral(x):
    """A tube that winds about z as it rises."""
    angle = np.arctan2(x[..., 1], x[..., 0])[..., None] + 2 * np.pi * np.arange(-2, 3)
    off = np.hypot(np.hypot(x[..., 0], x[..., 1])[..., None] - 38 - 2 * angle, x[..., 2:] - 7 * angle)
    return soft(np.where(abs(angle) < 9, off, 1e9).min(axis=-1) - 9, 1)


def texture(x):
    """Blobs of random place, size and sign."""
    random, total = np.random.default_rng(5), 0
    for *center, size, weight in random.uniform((-60, -60, -60, 8, -1), (60, 60, 60, 18, 1), (60, 5)):
        total = total + weight * np.exp(-((x - center) ** 2).sum(axis=-1) / size**2)
    return total


def ball(x):
    return soft(np.linalg.norm(x, axis=-1) - 60, 1)


class Volumes(unittest.TestCase):
    direction = rotation((1, 2, 2), 0.4)

    def phantom(self, function=head, size=64, seed=1, cropped=0.0, slices=1, pose=None):
        """Sets the arguments of planes(), the turn and the shift of the phantom, and the size of a voxel.

        cropped: units that are cut off on one side. slices: their thickness in voxels.
        """
        random = np.random.default_rng(seed)
        self.turn = rotation(random.uniform(-1, 1, 3), random.uniform(0.1, 0.4)) if pose is None else pose
        self.shift, self.voxel = random.uniform(-4, 4, 3) * (pose is None), 200 / size
        origin, spacing = self.direction @ (cropped - 100, -100, -100), self.voxel * np.array([1, 1, slices])
        parts = 4 if slices > 1 else 1
        volume = np.zeros((size, size, size // slices))
        for k in range(parts):
            index = np.stack(np.indices(volume.shape), axis=-1) + (0, 0, (k + 0.5) / parts - 0.5)
            volume += function((index * spacing @ self.direction.T + origin - self.shift) @ self.turn) / parts
        self.arguments = dict(volume=volume.astype(np.float32), spacing=spacing, origin=origin, direction=self.direction)

    def assert_plane(self, degrees, voxels):
        found = pcl_symmetry.planes(**self.arguments)
        self.assertTrue(len(found) and found[0].kind == "symmetry" and found[0].confidence > 0.75 * 0.75, found)
        self.assertLess(np.linalg.norm(np.cross(found[0].normal, self.turn[:, 0])), np.radians(degrees))
        self.assertLess(abs(found[0].distance(self.shift)), voxels * self.voxel)

    def test_of_a_tilted_head_are_exact_and_of_a_noisy_one_within_half_a_degree_and_voxel(self):
        for seed in (1, 5):
            # The last plane is nearly parallel to an axis of the grid, where voxels fall on voxels.
            pose = self.direction @ rotation((0, 0, 1), 0.115) @ rotation((0, 1, 0), 0.012) if seed == 5 else None
            self.phantom(seed=seed, pose=pose)
            self.assert_plane(0.1, 0.2)
            volume = self.arguments["volume"]
            volume += 0.5 / 3 * np.random.default_rng(seed).normal(size=volume.shape)  # a third of the signal of the brain
            self.assert_plane(0.5, 0.5)

    def test_of_heads_that_are_cropped_or_have_a_lesion_on_one_side_are_exact(self):
        with_lesion = lambda x: head(x) + 0.4 * in_ellipsoid(x, (30, -20, 20), (12, 12, 12))
        for options in (dict(cropped=45), dict(function=with_lesion)):
            self.phantom(**options)
            self.assert_plane(0.1, 0.2)

    def test_of_thick_slices_are_right(self):
        self.phantom(size=160, slices=7)
        self.assert_plane(1.5, 0.66)

    def test_of_a_spiral_and_a_random_texture_are_none(self):
        for function in (spiral, texture):
            self.phantom(function, size=32)
            found = pcl_symmetry.planes(**self.arguments, approximate=True)
            self.assertEqual((len(found), found.reason), (0, ""))
            self.assertLessEqual({plane.kind for plane in found.every}, {"approximate"})

    def test_of_a_ball_are_all_and_said_so(self):
        self.phantom(ball, size=48)
        found = pcl_symmetry.planes(**self.arguments)
        self.assertEqual((len(found), found.reason), (0, "volume: the body is round, planes in all directions map it onto itself"))

    def test_leave_out_voxels_that_are_not_known(self):
        self.phantom()
        self.arguments["volume"][self.arguments["volume"] < 0.05] = np.nan
        self.assert_plane(0.1, 0.2)

    def test_of_the_transform_are_those_of_the_search_by_every_method(self):
        self.phantom(size=48)
        for bins, options in (((16, 32, 33), dict(method="convolution")), ((16, 32, 33), dict(method="sampled")),
                              ((16, 32, 17), dict(method="rotational", cells=24, refined_share=0.1))):  # fmt: skip
            map_ = pcl_symmetry.transform(bins=bins, **options, **self.arguments)
            planes = np.array([map_.plane(*index) for index in np.ndindex(*bins)])
            off = np.abs(planes @ [*self.shift, 1])
            across = np.linalg.norm(np.cross(planes[:, :3], self.turn[:, 0]), axis=1)
            near = (across < 2 / bins[0]) & (off < 1.5 * map_.radius / bins[2])
            aside = (across < 2 / bins[0]) & (off > 0.2 * map_.radius)
            with self.subTest(**options):
                self.assertGreater(map_.values.ravel()[near].max(), 0.85)
                self.assertGreater(map_.values.ravel()[near].max(), map_.values.ravel()[aside].max() + 0.1)

    def test_map_what_lies_on_them_onto_itself_at_any_scale(self):
        self.phantom(size=48)
        on_plane = self.shift + np.array([(0, 20, 10), (0, -30, 25), (0, 45, -20)]) @ self.turn.T
        beside = on_plane + 12 * self.turn[:, 0]
        for scale in (0.4, 1.0):
            values = pcl_symmetry.local_symmetry(scale=scale, at=np.concatenate([on_plane, beside]), **self.arguments)
            self.assertGreater(values[:3].min(), 0.9, scale)
            self.assertGreater(values[:3].mean(), values[3:].mean(), scale)

    def test_have_arguments_that_points_do_not_have(self):
        self.phantom(size=16)
        points = np.zeros((9, 3))
        for function in (pcl_symmetry.transform, pcl_symmetry.local_symmetry):
            self.assertRaisesRegex(TypeError, "takes points or volume", function, points, volume=self.arguments["volume"])
            self.assertRaisesRegex(ValueError, "levels, direction: of a volume", function, points, levels=(0, 1))
        self.assertRaisesRegex(ValueError, "sigma: of points", pcl_symmetry.transform, **self.arguments, sigma=1)
        self.assertRaisesRegex(TypeError, "at: positions in a volume", pcl_symmetry.local_symmetry, **self.arguments)
