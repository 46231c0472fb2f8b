"""The example 13_distributed.py, whose workers and jobs die."""
import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

from tool_run import TOOLS, ToolTest, box_off, need, wait_for

psutil, _ = need("psutil", "dask.distributed")
EXAMPLE = str(Path(__file__).parents[2] / "apps/examples/13_distributed.py")


def tool(command, *arguments):
    return subprocess.run([f"{TOOLS}/pcl_symmetry_{command}", *map(str, arguments)], stdout=subprocess.PIPE, check=True).stdout.decode()


class Distributed(ToolTest):
    @classmethod
    def setUpClass(cls):
        """The models, and the answers of a database that was built of them in one go."""
        place = tempfile.TemporaryDirectory()
        cls.addClassCleanup(place.cleanup)
        cls.models = Path(place.name) / "models"
        cls.models.mkdir()
        for i in range(24):  # boxes, no two of one shape
            (cls.models / f"box_{i:02}.off").write_text(box_off(1.1 + 0.1 * (i % 6), 1.2 + 0.3 * (i // 6)))
        alone = Path(place.name) / "alone.db"
        tool("database", "build", alone, cls.models, "-quiet")
        cls.expected = cls.answers(alone)

    def setUp(self):
        super().setUp()
        self.database = self.folder / "models.db"

    @classmethod
    def answers(cls, database):
        queries = [cls.models / "box_03.off", cls.models / "box_17.off"]
        return [tool("database", "list", database), *(tool("match", database, query, "-quiet", "-max", "30") for query in queries)]

    def add_model(self, name, text):
        """A file among the models, until the test ends."""
        path = self.models / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
        self.addCleanup(path.unlink, missing_ok=True)
        return path

    def start(self, *arguments):
        environment = dict(os.environ, PATH=f"{TOOLS}:{self.folder}:{os.environ['PATH']}")
        return subprocess.Popen(
            [sys.executable, "-B", EXAMPLE, str(self.models), str(self.database), "--workers", "2", "--models-per-part", "2", *arguments],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment, start_new_session=True)

    def printed(self, *arguments, code=0):
        """By a run that ends with this exit code."""
        run = self.start(*arguments)
        output, _ = run.communicate(timeout=600)
        self.assertEqual(run.returncode, code, output)
        return output

    def parts(self):
        return sorted(Path(f"{self.database}.parts").glob("*.db"))

    def check_answers(self):
        """The file is whole, and answers like one that was built in one go."""
        self.run_tool("check", self.database, tool="database")
        self.assertIn("no damage", self.output + self.error)
        self.assertEqual(self.answers(self.database), self.expected)
        self.assertFalse(Path(f"{self.database}.parts").exists())

    def test_a_killed_worker_costs_nothing(self):
        run, working = self.start(), []

        def some_work():
            try:  # workers that run the tool now
                working[:] = [each for each in psutil.Process(run.pid).children() if each.children()]
            except psutil.NoSuchProcess:
                pass
            return len(self.parts()) > 1 and working

        self.assertTrue(wait_for(lambda: some_work() or run.poll() is not None))
        self.assertIsNone(run.poll(), "it ended before a worker could be killed")
        working[0].send_signal(signal.SIGKILL)
        output, _ = run.communicate(timeout=600)
        self.assertEqual(run.returncode, 0, output)
        self.check_answers()

    def test_an_interrupted_run_goes_on(self):
        run = self.start()
        self.assertTrue(wait_for(lambda: len(self.parts()) > 2 or run.poll() is not None))
        self.assertIsNone(run.poll(), "it ended before it could be interrupted")
        os.killpg(run.pid, signal.SIGKILL)
        run.communicate()
        num_parts = len(self.parts())
        self.assertGreater(num_parts, 2)
        self.add_model("broken.off", "OFF\n3 1 0\n0 0 0\n")
        output = self.printed(code=1)
        self.assertIn(f"of {13 - num_parts} parts", output)
        self.assertRegex(output, r"left out: .*broken.off: ")
        self.check_answers()

    def test_jobs_of_slurm(self):
        """With programs that start the jobs here; those that are left over are taken from the queue."""
        for name, text in (
            ("sbatch", 'echo "$@" >>"${0%/*}/jobs"; echo "7;cluster"; last=${@: -1}; for i in 1 2; do ${last#--wrap=} &>/dev/null & done'),
            ("scancel", 'echo "$@" >>"${0%/*}/cancelled"'),
        ):
            self.write(name, f"#!/bin/bash\n{text}\n").chmod(0o755)
        self.printed("--slurm=--partition=cpu --mem=1G")
        jobs = self.text("jobs").splitlines()
        self.assertEqual(len(jobs), 1)
        self.assertRegex(jobs[0], "--parsable --array=1-2 --cpus-per-task=1 --partition=cpu --mem=1G --wrap=dask worker tcp://")
        self.assertEqual(self.text("cancelled"), "7\n")
        self.check_answers()

    def test_says_what_is_wrong(self):
        self.database.write_text("mine")
        self.assertIn("models.db: exists, must be a new file", self.printed(code=1))
        self.database.unlink()
        again = self.add_model("other/box_01.off", "")
        self.assertIn("names must differ", self.printed(code=1))
        again.unlink()
        output = self.printed("--tool", "no_such_tool", code=1)
        self.assertIn("no_such_tool", output)
        self.assertNotIn("Traceback", output)
