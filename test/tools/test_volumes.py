"""CT and MR volumes as files: the same plane from every format, and a sentence for bad ones."""
import gzip
import struct
import zlib

from tool_run import Image, ToolTest, np, ply_points, xyz

SIZE = (22, 24, 20)  # x, y, z


def body():
    """A body with a pair of spots, symmetric in the plane x = 10.25 of the grid."""
    z, y, x = 2.0 * np.indices(SIZE[::-1])
    side, v, w = abs(x - 20.5), y - 23, z - 19
    hull = np.sqrt((side / 15) ** 2 + ((v + 0.004 * w * w) / 19) ** 2 + (w / 16) ** 2)
    spot = np.hypot(side - 7, np.hypot(v - 8, w - 3))
    values = 100 / (1 + np.exp((hull - 1) * 12)) + 60 / (1 + np.exp(spot - 3)) + 30 / (1 + np.exp(np.hypot(v - 15, w + 9) - 4))
    return values.astype("<f4").tobytes()


BODY = body()
FEW = zlib.compress(BODY[:9999])


def meta_image(data, size=SIZE, thickness=6):
    """Axes of the grid along y, -x and z of the frame, spacing 4, 4 and 6: the plane is y = 4 * 10.25 + 7."""
    return (b"ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = False\n"
            b"TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 5 7 -9\nElementSpacing = 4 4 %d\nDimSize = %d %d %d\n"
            b"ElementType = MET_FLOAT\nElementDataFile = LOCAL\n" % (thickness, *size) + data)


def nrrd(data, size=SIZE, thickness=6):
    return (b"NRRD0004\ntype: float\ndimension: 3\nspace: left-posterior-superior\nsizes: %d %d %d\nendian: little\nencoding: raw\n"
            b"space directions: (0,4,0) (-4,0,0) (0,0,%d)\nspace origin: (5,7,-9)\n\n" % (*size, thickness) + data)


def nifti(data, size=SIZE, thickness=6, kind=16):
    """Its intensities are scaled by 2, minus 50."""
    header = bytearray(352)
    for at, form, *values in ((0, "<i", 348), (40, "<8h", 3, *size, 1, 1, 1, 1), (70, "<2h", kind, 32),
                              (76, "<4f", 1, 4, 4, thickness), (108, "<3f", 352, 2, -50), (254, "<h", 1),
                              (280, "<12f", 0, -4, 0, 5, 4, 0, 0, 7, 0, 0, thickness, -9), (344, "<4s", b"n+1")):
        struct.pack_into(form, header, at, *values)
    return bytes(header) + data


def vti(data, size=SIZE, thickness=6):
    extent = b"0 %d 0 %d 0 %d" % (size[0] - 1, size[1] - 1, size[2] - 1)
    return (b'<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian" header_type="UInt32">\n'
            b'<ImageData WholeExtent="%s" Origin="5 7 -9" Spacing="4 4 %d" Direction="0 -1 0 1 0 0 0 0 1"><Piece Extent="%s">'
            b'<PointData Scalars="f"><DataArray type="Float32" Name="f" format="appended" offset="0"/></PointData></Piece></ImageData>'
            b'<AppendedData encoding="raw">_' % (extent, thickness, extent)
            + struct.pack("<I", len(data)) + data + b"</AppendedData></VTKFile>\n")


FORMATS = ((".mha", meta_image), (".nrrd", nrrd), (".nii", nifti), (".vti", vti))


def mgh(data, size=SIZE):
    """The frame of the others by its middle."""
    center = np.array([5, 7, -9]) + np.array([[0, -4, 0], [4, 0, 0], [0, 0, 6]]) @ np.array(size) / 2
    header = struct.pack(">7ih15f", 1, *size, 1, 3, 0, 1, 4, 4, 6, 0, 1, 0, -1, 0, 0, 0, 0, 1, *center)
    return header.ljust(284, b"\0") + np.frombuffer(data, "<f4").astype(">f4").tobytes() + b"tags"


class Volumes(ToolTest):
    tool = "planes"

    def planes(self, path, flags=""):
        return self.report(path, "-quiet", flags)["planes"]

    def assert_plane(self, path, name):
        """Returns the first plane, that of the body."""
        plane = self.planes(path)[0]
        _, b, _, d = plane["coefficients"]  # of either sign
        self.assertAlmostEqual(abs(b), 1, delta=1e-4, msg=name)
        self.assertAlmostEqual(d / b, -48, delta=0.05, msg=name)
        return plane

    def test_of_all_formats_have_the_same_plane_in_the_frame_of_the_file(self):
        one_in_five = np.frombuffer(BODY, "<f4").reshape(SIZE[::-1])[::5].tobytes()
        for ending, write in FORMATS:
            for name, content in (("a" + ending, write(BODY)), ("thick" + ending, write(one_in_five, (22, 24, 4), 20))):
                self.assertGreater(self.assert_plane(self.write(name, content), name)["confidence"], 0.8, name)

    def test_noise_has_no_plane_and_the_best_one_no_share(self):
        noise = np.random.default_rng(0).random(SIZE[::-1]).astype("<f4").tobytes()
        self.run_tool(self.write("noise.mha", meta_image(noise)), "-quiet")
        self.assertRegex(self.output, r"no symmetry plane\nbest plane [-. 0-9]+, confidence 0\.\d+\n")

    def test_frames_of_any_handedness_and_files_apart_are_read(self):
        header = bytearray(nifti(BODY)[:348])
        apart = header[:344] + b"ni1\0"
        struct.pack_into("<f", apart, 108, 0)
        flipped = bytearray(nifti(BODY))  # both frames: that of the map counts
        struct.pack_into("<h", flipped, 252, 1)
        turned = bytearray(nifti(BODY))  # a rotation by 90 degrees about z alone
        struct.pack_into("<2h6f", turned, 252, 1, 0, 0, 0, 2 ** -0.5, 5, 7, -9)
        times = bytearray(nifti(BODY + BODY[::-1]))
        struct.pack_into("<8h", times, 40, 4, 22, 24, 20, 2, 1, 1, 1)
        detached = nrrd(b"")[:-1] + b"data file: a.raw\n"
        self.write("a.raw", BODY)
        self.write("b.raw", b"0123456789" + BODY)
        self.write("a.img", BODY)
        self.write("a.hdr", bytes(apart))
        for name, content in (("both.nii", flipped), ("turned.nii", turned), ("times.nii", times), ("a.mgh", mgh(BODY)),
                              ("a.mgz", gzip.compress(mgh(BODY))), ("a.img", None), ("a.hdr", None), ("end.nhdr", detached),
                              ("marked.nhdr", b"\xef\xbb\xbf" + detached), ("blank.nhdr", detached + b"\n"),
                              ("skip.nhdr", detached.replace(b"a.raw", b"b.raw\nbyte skip: 10")),
                              ("last.nhdr", detached.replace(b"a.raw", b"b.raw\nbyte skip: -1"))):
            self.assert_plane(self.write(name, bytes(content)) if content is not None else name, name)

    def test_maps_are_of_planes_axes_and_centers_and_seen_at_a_scale(self):
        path = self.write("a.mha", meta_image(BODY))
        for flags in ("-method convolution", "-method rotational", "-method rotational -refined_share 0.1", "-method voting -as_published",
                      "-of axes -fold 2", "-of centers", "-scale 0.4"):  # fmt: skip
            report = self.report(path, "-quiet -grid 16", flags, tool="map")
            # No center lies at the border, where the values of the map are read.
            greatest = report["centers"][0]["symmetry"] if flags == "-of centers" else report["greatest"]
            self.assertGreater(greatest, 0.6, flags)
            self.assertGreater(report["num_points"], 500, "the border of the body")

    def test_are_drawn_as_slices_and_their_surface_is_a_mesh(self):
        path = self.write("a.mha", meta_image(BODY))
        self.run_tool(path, "-quiet -png a.png")
        width, height = Image.open(self.folder / "a.png").size
        self.assertGreater(width, 3 * 400)
        self.assertGreater(height, 2 * 400)
        of_surface = self.planes(path, "-surface 50")
        self.assertAlmostEqual(abs(of_surface[0]["coefficients"][3]), 48, delta=0.5)

    def test_keep_what_their_headers_say(self):
        """The window of intensities, and the frame in all directions, are those of the file."""
        meta, scaled = self.write("a.mha", meta_image(BODY)), self.write("a.nii", nifti(BODY))
        plain, same = self.planes(meta, "-levels 20,120"), self.planes(scaled, "-levels -10,190")
        self.assertGreaterEqual(len(plain), 1)
        np.testing.assert_allclose([plane["coefficients"] for plane in same], [plane["coefficients"] for plane in plain], atol=1e-4)
        boxes = []
        for path, level in ((meta, 60), (scaled, 70)):
            self.run_tool(path, f"-quiet -surface {level} -support {path.stem}{path.suffix[1:]}.ply")
            points = xyz(ply_points(self.folder / f"{path.stem}{path.suffix[1:]}.ply")[0])
            boxes.append([points.min(axis=0), points.max(axis=0)])
        np.testing.assert_allclose(boxes[1], boxes[0], atol=0.2)

    def test_that_are_bad_get_a_sentence(self):
        zero, nan = (np.full(np.prod(SIZE), value, "<f4").tobytes() for value in (0, np.nan))
        files = [("text.nii.gz", b"no volume", "text.nii.gz"),
                 ("axes.mha", meta_image(BODY).replace(b"NDims = 3", b"NDims = 4"), "NDims must be 3"),
                 ("blank.mha", meta_image(BODY).replace(b"DataFile = LOCAL", b"DataFile = \nA = B\nElementDataFile = LOCAL"), "no field with a value"),
                 ("packed.mha", meta_image(BODY).replace(b"CompressedData = False", b"CompressedData = True\nCompressedDataSize = -1"), "does not fit its data"),
                 ("deflated.mha", meta_image(BODY).replace(b"CompressedData = False", b"CompressedData = True"), "compressed data are damaged"),
                 ("few.mha", meta_image(FEW).replace(b"CompressedData = False", b"CompressedData = True\nCompressedDataSize = %d" % len(FEW)), "fewer voxels"),
                 ("minus.mha", meta_image(BODY).replace(b"NDims = 3", b"NDims = -3"), "NDims must be 3"),
                 ("empty.nrrd", b"NRRD0004\ntype: float\nsizes:\n\n", "with a value"),
                 ("type.nii", nifti(BODY, kind=12345), "unknown type"),
                 ("text.vti", b"<VTKFile", "text.vti"),
                 ("bare.nrrd", b"NRRD0004\ntype: float\n\n" + BODY, "type, dimension"),
                 ("sizes_8.nrrd", nrrd(BODY).replace(b"sizes:", b"sizes 8:"), "type, dimension"),
                 ("line.nrrd", b"NRRD0004\ntype: short\ndimension: 1\nsizes: 810\nencoding: raw\n\n" + BODY, "dimension 3"),
                 ("ends.nrrd", nrrd(b"")[:-1] + b"\r\r\n", "with a value"),
                 ("words.nrrd", nrrd(BODY).replace(b"raw", b"ascii", 1), "must be raw or gzip"),
                 ("files.mha", b"NDims = 3\nDimSize = 5 4 12\nElementType = MET_FLOAT\nElementDataFile = %a\n", "one file"),
                 ("void.nrrd", b"NRRD0004\ntype: float\nsizes: 9 9 9\ndimension: 3\n\n", "with a value")]
        for ending, write in FORMATS:
            files += [("cut" + ending, write(BODY)[:30_000], "cut off"),
                      ("larger" + ending, write(BODY, (22, 24, 400)), "does not fit its data"),
                      ("zero" + ending, write(zero), "equal"),
                      ("nan" + ending, write(nan), "finite"),
                      ("one" + ending, write(BODY[:4 * 22 * 24], (22, 24, 1)), "slices along an axis = 1")]
        files += [("more" + ending, write(BODY + BODY[:999]), "more than the") for ending, write in FORMATS[:3]]
        for name, content, said in files:
            self.fails(1, said, self.write(name, content), "-quiet")
            self.assertEqual(self.error.count("\n"), 1, self.error)
        self.fails(1, "missing.nii", "missing.nii -quiet")
        good = self.write("a.mha", meta_image(BODY))
        self.run_tool(good, "-levels 5,3", code=2)
        for flags in ("-as_published", "-tolerance 0.02", "-absolute_tolerance 1", "-ground 0,0,1,0"):
            self.fails(1, "of points", good, flags)
