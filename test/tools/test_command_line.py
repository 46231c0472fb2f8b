"""The command line of all tools: flags, their help and errors, and many inputs."""
import csv
import io
import json
import os

from tool_run import CYLINDER, TOOLS, VASE, ToolTest, box_off, limit_of_memory, pcd_header


class Flags(ToolTest):
    tool = "planes"
    files = dict(box=("box.off", box_off()))

    def test_single_and_double_dash_mean_the_same(self):
        scans = []
        for k, flags in enumerate(("-noise 0.01 -seed 7", "--noise 0.01 --seed 7", "-seed 8 -noise 0.01")):
            self.run_tool("box.off", flags, f"{k}.pcd -points 500 -quiet", tool="scan")
            scans.append((self.folder / f"{k}.pcd").read_bytes())
        self.assertEqual(scans[0], scans[1])
        self.assertNotEqual(scans[0], scans[2])

    def test_former_spellings_stay_for_a_version(self):
        self.run_tool(self.box, "-quiet -colour -colour_tolerance 3 -json m.json", tool="bop")
        maps = [self.report(self.box, "-quiet -points 500 -grid 16 -method", name, tool="map") for name in ("exact", "convolution", "sampled")]
        self.assertEqual(maps[0]["greatest"], maps[1]["greatest"])
        self.assertNotEqual(maps[0]["greatest"], maps[2]["greatest"])

    def test_quiet_leaves_the_results(self):
        self.run_tool(self.box, "-points 500")
        self.assertIn("[done, ", self.error)
        shown = self.output
        self.run_tool(self.box, "-points 500 -quiet")
        self.assertEqual((self.output, self.error), (shown, ""))

    def test_help_shows_flags_with_their_defaults_and_an_example(self):
        for flag in ("-h", "-help", "--help"):
            self.run_tool(flag, tool="map")
            for part in ("Usage: pcl_symmetry_map input [output]", "-threads N", "-viewpoint auto|none|X,Y,Z", "Example:"):
                self.assertIn(part, self.output)
            self.assertNotIn(" --", self.output)
            text = " ".join(self.output.split())
            for default in ("of the distance field (64)", "0 = all (0)", "input frame (auto)", "over a mesh (10000)", "random streams (1)"):
                self.assertIn(default, text)

    def test_help_has_groups_and_names_lines_of_several_inputs_where_there_are_some(self):
        self.run_tool("-h", tool="scan")
        self.assertNotIn("JSON Lines", " ".join(self.output.split()))
        self.run_tool("-h")
        self.assertIn("JSON Lines", " ".join(self.output.split()))
        at = [self.output.index(f"\n{name}:\n") for name in ("Output", "Analysis", "Input", "Computation", "Help")]
        self.assertEqual(at, sorted(at))
        self.assertLess(at[0], self.output.index("-json"))
        self.assertLess(self.output.index("-png"), at[1])

    def test_help_fits_the_terminal(self):
        for tool in (tool.name.split("_", 2)[2] for tool in TOOLS.glob("pcl_symmetry_*") if not tool.suffix):
            for columns in (60, 90):
                lines = self.at_terminal("-h", tool=tool, columns=columns)[1].split("\nExample:")[0].splitlines()
                self.assertTrue(columns - 15 < max(map(len, lines)) <= columns, (tool, columns))
                self.assertEqual([line for line in lines if line.endswith(" ")], [], tool)

    def test_json_says_how_it_was_made(self):
        made = self.report(self.box, "-quiet -points 500 -seed 4 -approximate", "--tolerance=0.02")["made_by"]
        self.assertEqual((made["tool"], made["seed"]), ("pcl_symmetry_planes", 4))
        self.assertRegex(made["version"], r"^\d+\.\d+\.\d+$")
        options = {key: made["options"][key] for key in ("points", "seed", "approximate", "tolerance", "quiet")}
        self.assertEqual(options, {"points": "500", "seed": "4", "approximate": True, "tolerance": "0.02", "quiet": True})
        self.assertNotIn("max_planes", made["options"])

    def test_negative_vectors_are_values_and_viewpoints_have_words(self):
        flags = "-quiet -points 500 -viewpoint"
        given = self.report(self.box, flags, "-10,20,-0.25")["viewpoint"]
        self.assertEqual((given["from"], [round(x, 9) for x in given["position"]]), ("given", [-10, 20, -0.25]))
        for word in ("none", "auto"):
            self.assertEqual(self.report(self.box, flags, word)["viewpoint"], {"from": "none"})

    def test_common_flags_reach_the_library(self):
        answers = [self.report(self.box, "-quiet -points 500", flags, tool="map") for flags in
                   ("", "", "-seed 4", "-grid 32", "-sigma 0.5", "-threads 1")]
        self.assertEqual({answer["num_points"] for answer in answers}, {500})
        found = [(answer["least"], answer["greatest"]) for answer in answers]
        self.assertEqual((found[1], found[5]), (found[0], found[0]), "the same bytes for any number of threads")
        self.assertEqual(len(set(found)), 4, "others for another seed, grid and width")

    def test_what_is_wrong_is_named_with_its_rule(self):
        for flags, said in (("-viewpoint never", "-viewpoint = never, must be auto, none or X,Y,Z"),
                            ("-viewpoint 1,2", "-viewpoint = 1,2, must be auto, none or X,Y,Z"),
                            ("-threads -1", "-threads = -1, must be >= 0 and <= 4096"),
                            ("-tolerance 0", "-tolerance = 0, must be > 0 and <= 0.1"),
                            ("-tolerance nan", "-tolerance = nan, must be finite"),
                            ("-tolerance 0.5x", "-tolerance = 0.5x, must be a number"),
                            ("-seed 1.5", "-seed = 1.5, must be a whole number"),
                            ("-seed -3", "-seed = -3, must be >= 0"),
                            ("-seed 99999999999999999999", "-seed = 99999999999999999999, is too large"),
                            ("-method none", "-method = none, must be sampled|convolution|rotational|voting"),
                            ("-ground 1,x,0,0", "-ground = x, must be a number"),
                            ("-sead 1", "unknown flag -sead, did you mean -seed?"),
                            ("--bogus", "unknown flag --bogus (see"),
                            ("-seed", "the required argument for option '-seed' is missing"),
                            ("--seed 1 -seed 2", "option '-seed' cannot be specified more than once"),
                            ("-quiet -quiet", "option '-quiet' cannot be specified more than once"),
                            ("-tol 0.02", "unknown flag -tol, did you mean -tolerance?"),
                            ("-see 1", "unknown flag -see, did you mean -seed?")):  # abbreviations are not guessed
            self.fails(2, f"pcl_symmetry_planes: {said}", self.box, flags)
            self.assertTrue(self.error.endswith("(see pcl_symmetry_planes -h)\n"), self.error)
        self.fails(2, "missing argument 'input'", tool="map")
        self.fails(2, "unexpected argument 'c'", "a b c", tool="map")
        self.fails(2, "-direction = 1,nan,0, must be three finite numbers X,Y,Z", "a b.pcd -direction 1,nan,0", tool="scan")
        self.fails(2, "-up = 0,0,0, must not be zero", "a -up 0,0,0", tool="segment")
        self.fails(1, "-levels is of volumes", self.box, "-levels 0,1")
        self.fails(1, "missing.off: no such file", "missing.off -png OUT.PNG")  # the name of the picture is one
        self.fails(2, "-html = page.txt, must end in .html", self.box, "-html page.txt")
        self.fails(2, "-png = out.jpg, must end in .png", self.box, "-png out.jpg")
        self.fails(2, "min_confidence", self.box, "-min_confidence 2")
        self.fails(2, "-json needs a value, but -quiet follows", self.box, "-json -quiet")

    def test_flags_that_would_do_nothing_are_refused(self):
        self.write("a.txt", "")
        for tool, arguments, said in (
            ("map", "a.txt -fold 3", "-fold goes with -of axes"), ("map", "a.txt -of axes -scale 0.5", "-scale goes with -of planes"),
            ("map", "a.txt -of centers -method voting", "-method goes with -of planes"),
            ("map", "a.txt -refined_share 0.1", "-refined_share goes with -method rotational"),
            ("map", "a.txt -as_published", "-as_published goes with -method voting"), ("map", "a.txt -cells 9", "-cells goes with -volume"),
            ("map", "a.txt -size 99", "-size goes with -png or -slices"), ("viewpoint", "a.txt -size 99", "-size goes with -png or -icon"),
            ("map", "a.txt -scale 0.5 -method voting", "-method goes with the whole shape"),
            ("planes", "a.txt -as_published -viewpoint none", "-viewpoint goes with the decision"),
            ("planes", "a.txt -as_published -profile p.csv", "-profile goes with the decision"),
            ("planes", "a.txt -levels 0,1 -surface 1", "-levels goes with volumes, without -surface"),
            ("planes", "a.txt -tolerance 0.02 -absolute_tolerance 1", "-tolerance goes with -absolute_tolerance 0"),
            ("bop", "a.txt -tolerance 0.02 -absolute_tolerance 1", "-tolerance goes with -absolute_tolerance 0"),
            ("bop", "a.txt -sphere_angle 9", "-sphere_angle goes with -json or -dope"),
            ("viewpoint", "a.txt -as_published -viewpoint none", "-viewpoint goes with the decision"),
            ("viewpoint", "a.txt -views 1 -separation 9", "-separation goes with -views 2 or more"),
            ("segment", "a.txt -method splitting -parts 3 -depth 2", "-depth goes with -method splitting and -parts 0"),
            ("align", "a.txt -as_published -viewpoint none", "-viewpoint goes with -complete, -symmetrize and frames without"),
            ("align", "a.txt -target a.txt -grid 32", "-grid goes with frames"), ("align", "a.txt -merge m.ply -any_plane", "-any_plane goes with -complete"),
            ("describe", "d a.txt -type prst -input_axes -viewpoint none", "-viewpoint goes with axes of the symmetry"),
            ("database", "rebuild a -json x", "-json goes with all commands but"),
            ("segment", "a.txt -depth 2", "-depth goes with -method splitting"), ("segment", "a.txt -up 0,1,0", "-up goes with -png or -html"),
            ("segment", "a.txt -method splitting -evidence all", "-evidence goes with -method merging"),
            ("align", "a.txt -cut", "-cut goes with -symmetrize"), ("align", "a.txt -any_plane", "-any_plane goes with -complete"),
            ("align", "a.txt -target a.txt -as_published", "-as_published goes with frames, without -target"),
            ("planes", "a.txt -as_published -tolerance 0.02", "-tolerance goes with the decision"),
            ("planes", "a.txt -as_published -ground 0,0,1,0", "-ground goes with the decision"),
            ("scan", "a.txt a.ply -format ascii", "-format goes with an output of PCD"), ("bop", "a.txt -report r", "-report goes with -check"),
            ("bop", "a.txt -color_tolerance 3", "-color_tolerance goes with -color"), ("match", "a a.txt -candidates 3", "-candidates goes with -recognize"),
            ("database", "list a -tag x", "-tag goes with build and add"), ("database", "check a -csv x", "-csv goes with list and info"),
            ("database", "info a -unit m", "-unit goes with build, add and merge"), ("scene", "a.txt -accept 0.7", "-accept goes with -database"),
            ("describe", "d a.txt -input_axes", "-input_axes goes with -type prst, prsd and gedt"),
            ("describe", "d a.txt -type gedt -equation_1", "-equation_1 goes with -type prst and prsd")):  # fmt: skip
            self.fails(2, f"pcl_symmetry_{tool}: {said}", arguments, tool=tool)

    def test_too_little_memory_is_one_line(self):
        limit = limit_of_memory(1 << 29)
        if not limit:
            self.skipTest("sanitizers take all addresses")
        self.run_tool("box.off a.pcd -points 20000000 -quiet", code=1, tool="scan", preexec_fn=limit)
        self.assertRegex(self.error, r"^pcl_symmetry_scan: .*memory.*\n$")

    def test_standard_input_is_known_by_its_content(self):
        binary_stl = bytes(80).replace(b"\0", b"x") + b"\1\0\0\0" + bytes(50)
        for content, said in ((b"# .PCD v0.7\nVERSION", "PCD header"), (b"VERSION 0.7\n", "PCD header"),
                              (b"ply\r\nformat", "malformed PLY header line"), (b"# a mesh\nv 1 2 x\n", "z of vertex 0 = x"),
                              (b"COFF\n1 0 0\n", "x of vertex 0 is missing"), (b"solid cube\n", "is cut off"),
                              (b"SOLID cube\n", "is cut off"), (binary_stl, "no polygon has an area"), (b"glTF....", "as glb"),
                              (b"\n# a b c\n-1.5 2\n", "line 3 = -1.5 2, must hold three"), (b"//X Y\n1 2\n", "line 2 = 1 2, must hold three"),
                              (b"hello", "is of no known kind"), (b"", "is empty")):
            self.fails(1, f"standard input: {said}" if said in ("is of no known kind", "is empty") else said, "-", input=content)

    def test_outputs_to_a_pipe_are_alone_in_it(self):
        box = self.write("box.off", box_off())
        self.run_tool("build m.db -points 500", box, tool="database")
        self.run_tool(box, "a.pcd", tool="scan")
        for tool, arguments in (("bop", "box.off -points 500"), ("match", "m.db box.off -points 500"), ("match", "m.db a.pcd -recognize"),
                                ("database", "list m.db"), ("database", "info m.db"), ("database", "info m.db box"),
                                ("align", "a.pcd a.pcd -merge all.pcd"), ("scene", "a.pcd -no_frames")):
            self.run_tool(arguments, "-json -", tool=tool)
            json.loads(self.output)
        self.run_tool("list m.db -csv -", tool="database")
        self.assertTrue(self.output.startswith("name,points,"), self.output)
        for tool, arguments in (("planes", "a.pcd -csv -"), ("scene", "a.pcd -"), ("scan", "box.off -"), ("align", "a.pcd a.pcd -merge -")):
            self.fails(2, "only one output can be -", arguments, "-json -", tool=tool)


class ManyInputs(ToolTest):
    """Lines of JSON and rows of a table, in the order of the inputs."""
    tool = "planes"
    flags = "-quiet -points 500"

    def test_are_written_in_their_order(self):
        paths = [self.write(name, box_off(1.5, z)) for z, name in enumerate(("a.off", 'b "2", new.off', "c.off"), 2)]
        for threads in (1, 3):
            self.run_tool(*paths, self.flags, f"-json out.jsonl -csv out.csv -support {{}}_support.pcd -threads {threads}")
            self.assertEqual([pcd_header(f"{path.with_suffix('')}_support.pcd")["POINTS"] for path in paths], 3 * [["500"]])
            self.assertEqual([line["file"] for line in self.lines("out.jsonl")], list(map(str, paths)))
            header, *rows = csv.reader(io.StringIO(self.text("out.csv")))
            self.assertEqual(header[:7], ["file", "number", "kind", *"abcd"])
            planes = [(line["file"], plane) for line in self.lines("out.jsonl") for plane in line["planes"]]
            self.assertEqual([row[0] for row in rows], [file for file, _ in planes])
            for row, (_, plane) in zip(rows, planes, strict=True):
                self.assertEqual([float(number) for number in row[3:7]], plane["coefficients"])
                self.assertEqual(row[7:13], [""] * 6, "a plane has no point and direction")
            alone, other = self.report(paths[2], self.flags), {"timing_ms": 0, "made_by": 0}
            self.assertEqual({**alone, **other}, {**self.lines("out.jsonl")[2], **other}, "the same as one by one")

    def test_are_tables_at_a_terminal_and_lines_of_json_in_a_pipe(self):
        paths = [self.write(name, shape) for name, shape in (("a.off", box_off()), ("b.off", "no shape"), ("c.off", CYLINDER))]
        self.run_tool(*paths, "-points 500", code=1)
        self.assertEqual([json.loads(line)["file"] for line in self.output.splitlines()], list(map(str, paths)))
        self.assertTrue(self.error.startswith("3 files: 2 done, 1 failed\n"), self.error)
        code, shown = self.at_terminal(*paths)
        self.assertEqual(code, 1)
        lines = shown.splitlines()
        self.assertEqual([lines[0], lines[5], lines[-2]], [str(paths[0]), str(paths[2]), "3 files: 2 done, 1 failed"])
        self.assertEqual(lines[1].split()[:2], ["plane", "a"])
        self.assertIn("axis of revolution", lines[6])

    def test_resume_where_they_were_interrupted(self):
        names = ("a.off", "b, or not.off", "c.off", "d.off")
        paths = [self.write(name, box_off(1.5, z)) for z, name in enumerate(names, 2)]
        broken = paths[2].read_bytes()
        paths[2].write_text("no shape")
        arguments = (*paths, self.flags, "-json out.jsonl -csv out.csv")
        self.run_tool(*arguments, code=1)
        whole = self.text("out.jsonl")
        self.assertEqual(self.text("out.csv").count("\n"), 1 + 3 * 3)
        self.write("out.jsonl", whole[:-4])  # killed while it wrote the last line
        paths[2].write_bytes(broken)
        self.run_tool(*arguments, "-resume")
        self.assertEqual(self.text("out.jsonl").splitlines()[:2], whole.splitlines()[:2], "c failed and d was torn")
        self.assertEqual([line["file"] for line in self.lines("out.jsonl")], list(map(str, paths)))
        self.assertEqual(self.text("out.csv").count("\n"), 1 + 4 * 3)
        done = self.text("out.jsonl")
        self.run_tool(*arguments, "-resume")
        self.assertEqual(self.text("out.jsonl"), done, "nothing is left to do")
        self.fails(1, "goes on with the same version, options and seed", *arguments, "-resume -seed 9")
        self.assertEqual(self.text("out.jsonl"), done)
        os.utime(paths[0], (2e9, 2e9))
        self.run_tool(*arguments, "-resume")
        self.assertEqual([line["file"] for line in self.lines("out.jsonl")], [str(paths[i]) for i in (1, 2, 3, 0)], "a changed")
        self.write("out.jsonl", '{"shapes": []}\n')
        self.fails(1, "holds a line that is no result of this tool", *arguments, "-resume")
        self.assertEqual(self.text("out.jsonl"), '{"shapes": []}\n', "something else is not overwritten")

    def test_more_than_may_wait_for_an_early_one(self):
        """Nothing hangs, and the order is that of the inputs; errors are named at the end, a thousand of them."""
        first = self.write("first.off", VASE)
        names = [str(first), *(str(self.write(f"{i}.xyz", "1 2 3\n")) for i in range(1, 2000))]
        self.write("list", "\n".join(names))
        for kept in (0, 1500):
            self.write("out.jsonl", "".join(json.dumps({"file": name}) + "\n" for name in names[:kept]))
            self.run_tool("@list -quiet -threads 4 -json out.jsonl", "-resume" if kept else "", code=1)
            self.assertEqual([line["file"] for line in self.lines("out.jsonl")], names)
            self.assertEqual([sum("error" in line for line in self.lines("out.jsonl")), self.error.count("\n")],
                             [1999 if not kept else 500, 1001 if not kept else 500])

    def test_names_that_clash_are_refused(self):
        for name in ("a.off", "b.off", "more/a.off"):
            self.write(name, box_off())
        self.fails(2, "with several inputs only -json and -csv can be -", "a.off b.off -support -")
        self.fails(1, "more/a.off: has the name of a.off, names must differ", "a.off b.off more/a.off -support {}.pcd")
        self.fails(2, "-resume needs several inputs", "a.off -resume -json out.jsonl")
        self.fails(2, "-resume needs -json FILE", "a.off b.off -resume")
        self.fails(2, "must hold {}", "a.off b.off -png out.png")

    def test_are_files_folders_patterns_and_lists(self):
        for name in ("in/b.pcd", "in/a.PLY", "in/c.txt", "in/d.glb", "in/e.XYZ", "in/a.or", "in/pcd"):
            self.write(name, "x")
        self.write("list", "# comment\nin/c.txt\n\n  missing.pcd \n")
        folder = [f"in/{name}" for name in ("a.PLY", "b.pcd", "d.glb", "e.XYZ")]
        for arguments, files in (("in", folder), ("in/*.txt in/c.txt", ["in/c.txt", "in/c.txt"]),
                                 ("in/c.txt in in/c.txt", ["in/c.txt", *folder, "in/c.txt"]), ("i*", folder),
                                 ("@list -", ["in/c.txt", "missing.pcd", "-"])):
            self.run_tool(arguments, "-quiet -json out.jsonl", code=1, input=b"")
            self.assertEqual([line["file"] for line in self.lines("out.jsonl")], files)
        self.fails(1, "outputs are named by flags, such as -json FILE", "in/c.txt out.pcd")
        self.fails(1, "*.stl: no file has such a name", "in/*.stl")
        self.fails(1, "nowhere: no such file", "@nowhere")
        (self.folder / "empty").mkdir()
        self.fails(1, "empty: holds no file of type .pcd", "empty")
