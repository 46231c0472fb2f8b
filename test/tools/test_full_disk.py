"""Each way that a tool writes a file: the disk is full, and there is a message, status 1, and no stray file."""
import subprocess

import tool_run
from tool_run import ToolTest

COMMANDS = {"o.pcd": "scan box.off OUT -format ascii", "binary.pcd": "scan box.off OUT -format binary", "packed.pcd": "segment box.off OUT",
            "o.ply": "align box.off OUT", "mesh.ply": "align box.off OUT -symmetrize mean", "o.seg": "segment box.off OUT",
            "o.json": "planes box.off -json OUT", "o.csv": "planes box.off -csv OUT", "lines.json": "planes @list -json OUT",
            "rows.csv": "planes @list -csv OUT", "o.html": "planes box.off -html OUT", "o.png": "viewpoint box.off -icon OUT",
            "support.pcd": "planes box.off -support OUT", "o.vti": "map box.off -volume OUT", "o.yaml": "bop box.off -isaac OUT",
            "o.db": "database build OUT box.off", "list.csv": "database list box.db -csv OUT"}


class FullDisk(ToolTest):
    def test_is_named(self):
        self.write("box.off", tool_run.box())
        self.write("list", "box.off\nbox.off\n")
        self.run_tool("build box.db box.off -quiet", tool="database")
        (self.folder / "disk").mkdir()
        # A disk of 16 kB, seen by this shell alone.
        script = "mount -t tmpfs -o size=16k none disk && head -c 16384 /dev/zero >disk/full || exit 77\n"
        for name, command in COMMANDS.items():
            tool = tool_run.TOOLS / f"pcl_symmetry_{command.replace('OUT', 'disk/' + name)}"
            script += f"{tool} -quiet >/dev/null 2>{name}.said; echo $? `ls -A disk` >{name}.left\n"
        for flags in ("-m", "-rm"):  # as root, or as a user who becomes root in a space of names
            if subprocess.run(["unshare", flags, "sh", "-c", script], cwd=self.folder, check=False).returncode == 0:
                break
        else:
            self.skipTest("no file system can be mounted here")
        for name, command in COMMANDS.items():
            self.assertIn(f"{name}: cannot be written", self.text(f"{name}.said"), command)
            self.assertEqual(self.text(f"{name}.left"), "1 full\n", command)
