"""Files that are written hold all fields, and survive kills, signals and full disks."""
import os
import resource
import signal
import subprocess
import time

from tool_run import TOOLS, ToolTest, box_off, np, pcd, pcd_header, pcd_points, xyz

OLD = "# pcl_symmetry_scan"
COMMANDS = {"o.pcd": "scan box.off OUT -format ascii", "binary.pcd": "scan box.off OUT -format binary", "packed.pcd": "segment box.off OUT",
            "o.ply": "align box.off OUT", "mesh.ply": "align box.off OUT -symmetrize mean", "o.seg": "segment box.off OUT",
            "o.json": "planes box.off -json OUT", "o.csv": "planes box.off -csv OUT", "lines.json": "planes @list -json OUT",
            "rows.csv": "planes @list -csv OUT", "o.html": "planes box.off -html OUT", "o.png": "viewpoint box.off -icon OUT",
            "support.pcd": "planes box.off -support OUT", "o.vti": "map box.off -volume OUT", "o.yaml": "bop box.off -isaac OUT",
            "o.db": "database build OUT box.off", "list.csv": "database list box.db -csv OUT"}


class SafeFiles(ToolTest):
    files = dict(box=("box.off", box_off()))

    def interrupt(self, number):
        """Sends a signal to the scanner while it writes big.pcd. Returns its exit status; None where it was done before."""
        command = [TOOLS / "pcl_symmetry_scan", *"box.off big.pcd -points 200000 -format ascii -quiet -threads 1".split()]
        with subprocess.Popen(command, cwd=self.folder) as process:
            while process.poll() is None:
                if any(name.startswith(".big.") for name in os.listdir(self.folder)):
                    process.send_signal(number)
                    break
                time.sleep(0.002)
            return None if process.wait() == 0 else process.returncode

    def test_an_output_that_is_an_input_or_another_output_is_refused(self):
        self.write("models.db", "a database")
        (self.folder / "link.off").symlink_to("box.off")
        for arguments in ("planes box.off -json box.off", "planes box.off -csv link.off", "planes box.off -html ./box.off",
                          "planes box.off -json a.json -csv a.json", "align box.off box.off", "align box.off box.off -target link.off",
                          "align box.off out.pcd -json out.pcd", "match models.db box.off -json models.db", "bop box.off -json box.off",
                          "align box.off link.off -merge box.off"):  # fmt: skip
            tool, rest = arguments.split(" ", 1)
            self.fails(2, "an output needs a name of its own", rest, tool=tool)
        self.assertEqual((self.text("box.off"), self.text("models.db")), (box_off(), "a database"))
        self.assertEqual(sorted(os.listdir(self.folder)), ["box.off", "link.off", "models.db"])

    def test_a_cloud_of_somebody_else_is_not_replaced(self):
        for _ in range(2):
            self.run_tool("box.off mine.pcd -format ascii -quiet", tool="scan")
        theirs = self.text("mine.pcd").replace("# pcl_symmetry_scan\n", "")
        self.write("theirs.pcd", theirs)
        for tool in ("align", "segment", "scene", "map"):
            self.fails(2, "was not written by this tool", "mine.pcd theirs.pcd", tool=tool)
        self.fails(2, "was not written by this tool", "theirs.pcd mine.pcd", tool="align")  # scans of the virtual scanner
        self.fails(2, "not replaced; -merge FILE brings several scans together", "-merge theirs.pcd mine.pcd box.off", tool="align")
        self.write("name_0.pcd", theirs)
        self.fails(1, "name_0.pcd: cannot be written, it is there", "box.off name.pcd -all -quiet", tool="scan")
        self.assertEqual([self.text(name) for name in ("theirs.pcd", "name_0.pcd")], [theirs, theirs])
        self.write("other.off", box_off())
        for flag in ("-json", "-csv"):  # the name of the file was forgotten
            self.fails(2, "there and was not written by this tool", f"{flag} other.off box.off -quiet", tool="planes")
        self.assertEqual(self.text("other.off"), box_off())

    def test_what_can_be_written_is_written(self):
        self.fails(1, "is no body of revolution", "box.off -json a.json -html a.html -profile a.svg", tool="planes")
        self.assertTrue(self.text("a.html") and self.text("a.json"))

    def test_killed_writers_leave_whole_files(self):
        self.write("big.pcd", OLD)
        num_killed = 0
        for _ in range(20):
            status = self.interrupt(signal.SIGKILL)
            if status is None:
                self.assertGreater(len(self.text("big.pcd").splitlines()), 100_000)
                self.write("big.pcd", OLD)
            else:
                num_killed += 1
                self.assertEqual((status, self.text("big.pcd")), (-signal.SIGKILL, OLD))
            for left in self.folder.glob(".big.*"):
                left.unlink()
            if num_killed == 3:
                return
        self.fail("no kill came while the file was written")

    def test_signals_remove_what_is_half_written(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            for _ in range(20):
                status = self.interrupt(number)
                if status is not None:
                    break
                (self.folder / "big.pcd").unlink()
            self.assertEqual((status, os.listdir(self.folder)), (-number, ["box.off"]))

    def test_full_disks_leave_the_old_file(self):
        """The size of files is limited: the kernel then answers a write as on a full disk, with another error number."""
        writers = list(COMMANDS)[:6]  # of clouds of each encoding, of meshes and of labels
        for name in writers:
            tool, command = COMMANDS[name].replace("OUT", name).split(" ", 1)
            command += " -points 3000" * (tool == "scan")
            self.run_tool(command, tool=tool)
            whole = (self.folder / name).read_bytes()
            for limit in (1, len(whole) // 2, len(whole) - 1):
                def limited(limit=limit):
                    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

                self.fails(1, f"{name}: cannot be written", command, tool=tool, preexec_fn=limited)
                self.assertEqual((self.folder / name).read_bytes(), whole)
        self.assertEqual(set(os.listdir(self.folder)), {"box.off", *writers}, "nothing half-written stays")

    def test_a_full_disk_is_named(self):
        """Each way that a tool writes a file: there is a message, status 1, and no stray file."""
        self.write("list", "box.off\nbox.off\n")
        self.run_tool("build box.db box.off -quiet", tool="database")
        (self.folder / "disk").mkdir()
        # A disk of 16 kB, seen by this shell alone.
        script = "mount -t tmpfs -o size=16k none disk && head -c 16384 /dev/zero >disk/full || exit 77\n"
        for name, command in COMMANDS.items():
            tool = TOOLS / f"pcl_symmetry_{command.replace('OUT', 'disk/' + name)}"
            script += f"{tool} -quiet >/dev/null 2>{name}.said; echo $? `ls -A disk` >{name}.left\n"
        for flags in ("-m", "-rm"):  # as root, or as a user who becomes root in a space of names
            if subprocess.run(["unshare", flags, "sh", "-c", script], cwd=self.folder, check=False).returncode == 0:
                break
        else:
            self.skipTest("no file system can be mounted here")
        for name, command in COMMANDS.items():
            self.assertIn(f"{name}: cannot be written", self.text(f"{name}.said"), command)
            self.assertEqual(self.text(f"{name}.left"), "1 full\n", command)

    def test_names_that_cannot_be_written_are_named(self):
        for name in ("missing/a.json", ".", "/dev/full", "/proc/a.json"):
            self.fails(1, f"{name}: cannot be written", "box.off -quiet -json", name, tool="planes")
        self.run_tool("a/b/ box.off -type prsd -points 500", tool="describe")
        self.run_tool("a/. box.off -type prsd -points 500", tool="describe")
        self.write("file", "")
        for folder in ("file", "file/below"):
            self.fails(1, f"{folder}: cannot be made", folder, "box.off", tool="describe")

    def test_clouds_keep_fields_organization_and_pose(self):
        i = np.arange(60)
        values = {"x": np.float32(1e9) / 7 * (i % 5), "y": np.float32(1e-20) / 3 + i // 5 % 4,
                  "z": np.where(i == 5, np.nan, 1e8 * (i // 20)),
                  "curvature": i, "rgb": (i << 8 | i << 16).astype("<u4").view("<f4")}
        cloud = np.rec.fromarrays([column.astype("<f4") for column in values.values()], names=list(values))
        content = pcd(xyz(cloud), 20, (1, -2, 0.5), curvature=cloud["curvature"], rgb=cloud["rgb"])
        self.write("a.pcd", content.replace(b"0.5 1 0 0 0", b"0.5 0.5 0.5 -0.5 0.5"))
        for source, target in (("a.pcd", "b.pcd"), ("b.pcd", "c.ply"), ("c.ply", "d.pcd")):
            self.run_tool(source, target, "-parts 1 -threads 1", tool="segment")
            file = self.folder / target
            file.write_bytes(file.read_bytes().replace(b"label", b"in_" + target[0].encode() + b"_", 1))  # makes room for the next one
        for name in ("b.pcd", "d.pcd"):
            found = pcd_header(self.folder / name)
            self.assertEqual([found[key] for key in ("WIDTH", "HEIGHT")], [["20"], ["3"]])
            np.testing.assert_allclose(np.array(found["VIEWPOINT"], float), [1, -2, 0.5, 0.5, 0.5, -0.5, 0.5], atol=1e-5)
            points = pcd_points(self.folder / name)
            for field in "x", "y", "z", "curvature":
                np.testing.assert_array_equal(points[field], cloud[field], f"{field} of {name}")
            np.testing.assert_array_equal(points["rgb"].view("<u4") & 0xffffff, cloud["rgb"].view("<u4") & 0xffffff, name)

    def test_clouds_have_no_other_kind(self):
        self.fails(2, "a.xyz", "box.off a.xyz", tool="scan")
        self.run_tool("box.off a.PCD -points 500", tool="scan")
