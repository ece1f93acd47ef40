#!/usr/bin/env python3
"""The command line tool, run as a user runs it. Needs MATSTRUCT_TOOL (the program) and MATSTRUCT_BUILD (its build
folder) in the environment; ctest sets them. One test class per ctest test."""
import json
import os
import pathlib
import resource
import signal
import struct
import subprocess
import sys
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor

SOURCE = pathlib.Path(__file__).resolve().parent.parent
TOOL = os.environ.get("MATSTRUCT_TOOL", str(SOURCE / "build/release/matstruct"))
BUILD = os.environ.get("MATSTRUCT_BUILD", str(SOURCE / "build/release"))
BRACKET = SOURCE / "data/bracket.stl"
FINE = SOURCE.parent / "shared/data/surface/part-2.stl"  # more tets than a shipped model
COARSE = ("--gamma", "12")  # few spheres: these tests are about the tool, not about the method
TIMEOUT = 300


def run(*arguments, **options):
    return subprocess.run([TOOL, *map(str, arguments)], capture_output=True, text=True, timeout=TIMEOUT, **options)


def below(folder):
    """All files below a folder, hidden ones too; none if it does not exist."""
    return sorted(str(path.relative_to(folder)) for path in pathlib.Path(folder).rglob("*") if path.is_file())


class ToolTest(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)
        self.out = self.folder / "out"

    def refused(self, result, code, *words):
        """The code, nothing on stdout, and one line on stderr that has the words."""
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(result.stdout, "")
        lines = result.stderr.splitlines()
        self.assertEqual(len(lines), 1, result.stderr)
        self.assertTrue(lines[0].startswith("matstruct: "), lines[0])
        for word in words:
            self.assertIn(word.lower(), lines[0].lower())

    def done(self, result):
        self.assertEqual(result.returncode, 0, result.stderr)


class Usage(ToolTest):
    COMMANDS = ("compute", "evaluate", "tetrahedralize", "info", "view", "render", "reconstruct", "export")

    def test_version_is_the_projects(self):
        project = (SOURCE / "CMakeLists.txt").read_text().split("project(matstruct VERSION ")[1].split()[0]
        self.assertEqual(run("--version").stdout, f"matstruct {project}\n")

    def test_help_goes_to_stdout(self):
        for arguments in [("--help",)] + [(command, "--help") for command in self.COMMANDS]:
            result = run(*arguments)
            self.done(result)
            self.assertIn("--help", result.stdout)
            self.assertEqual(result.stderr, "")

    def test_help_has_units_and_defaults(self):
        text = run("compute", "--help").stdout
        for words in ("--gamma X=40", "--convex-angle DEGREES=30", "--concave-angle DEGREES=30", "--thinning X=0.2",
                      "--max-rounds N=60", "--seed N=1", "--threads N=0"):
            self.assertIn(words, text)

    def test_bad_usage(self):
        self.refused(run(), 2)
        self.refused(run("frobnicate"), 2)
        self.refused(run("compute", BRACKET), 2, "--output")
        self.refused(run("compute", "-o", self.out), 2, "INPUT")
        self.refused(run("compute", BRACKET, "-o", self.out, "--frobnicate"), 2, "--frobnicate")
        self.refused(run("compute", BRACKET, "-o", self.out, "--gamma", "dense"), 2, "--gamma")
        self.refused(run("compute", BRACKET, "-o", self.out, "--gamma", "1"), 2, "gamma is 1", "between 2 and 1000")
        self.refused(run("compute", BRACKET, "-o", self.out, "--threads", "-1"), 2, "threads")
        self.refused(run("compute", BRACKET, "-o", self.out, "--quiet", "--verbose"), 2, "--quiet", "--verbose")
        self.refused(run("tetrahedralize", BRACKET, "-o", self.folder / "bracket.vtk"), 2, ".msh")
        self.refused(run("evaluate", "x.ma", "--surface", BRACKET, "--samples", "3"), 2, "--samples")
        self.assertEqual(below(self.folder), [])


class Commands(ToolTest):
    """Each command on a shipped model."""

    def test_compute_evaluate_info(self):
        result = run("compute", BRACKET, "-o", self.out, *COARSE)
        self.done(result)
        self.assertEqual(result.stdout, "")
        self.assertEqual(below(self.out), ["bracket.ma", "bracket.ply", "bracket.report.json", "bracket.solid.ply",
                                           "bracket.structure.json"])
        report = json.loads((self.out / "bracket.report.json").read_text())
        self.assertTrue(report["guarantees_hold"])
        self.assertTrue(report["topology"]["equal"])
        self.assertEqual(report["options"]["gamma"], 12)

        result = run("evaluate", self.out / "bracket.ma", "--surface", BRACKET, "--json")
        self.done(result)
        evaluation = json.loads(result.stdout)
        self.assertEqual(evaluation["mesh"], report["mesh"])
        self.assertEqual(evaluation["topology"]["betti"], report["input"]["betti"])
        for name in ("triangle_quality", "mser", "spikes", "medialness_mean_percent"):
            self.assertAlmostEqual(evaluation["metrics"][name], report["metrics"][name], places=9, msg=name)
        self.assertEqual(evaluation["structure_errors"]["told_by"], "types")
        self.assertGreater(evaluation["structure"]["sheets"], 0)
        self.assertGreater(evaluation["spacing"]["sheets"]["mean"], 0)
        self.assertNotIn("comparison", evaluation)

        result = run("info", self.out / "bracket.ma")
        self.done(result)
        self.assertIn(f"{report['mesh']['spheres']} spheres", result.stdout)
        self.assertIn(f"components {report['input']['betti'][0]}, tunnels {report['input']['betti'][1]}", result.stdout)

    def test_evaluate_compares_two_meshes(self):
        for gamma in (8, 12):
            self.done(run("compute", BRACKET, "-o", self.folder / str(gamma), "--gamma", gamma))
        fine, coarse = self.folder / "12/bracket.ma", self.folder / "8/bracket.ma"
        result = run("evaluate", fine, "--surface", BRACKET, "--compare", fine, "--json", "--samples", 2000)
        self.done(result)
        same = json.loads(result.stdout)["comparison"]
        self.assertLess(same["hausdorff_percent"], 1e-6)
        self.assertTrue(same["structure_equal"])
        result = run("evaluate", fine, "--surface", BRACKET, "--compare", coarse, "--json", "--samples", 2000)
        self.done(result)
        self.assertGreater(json.loads(result.stdout)["comparison"]["hausdorff_percent"], 0.1)
        result = run("evaluate", fine, "--surface", BRACKET, "--compare", coarse)
        self.done(result)
        for words in ("MSER", "spikes", "medialness", "compared with the other", "structure of the other"):
            self.assertIn(words, result.stdout)
        self.refused(run("evaluate", fine, "--surface", BRACKET, "--compare", self.folder / "none.ma", "--quiet",
                         "--samples", 1000), 1, "none.ma")

    def test_tetrahedralize_then_compute(self):
        tets = self.folder / "tets/bracket.msh"
        self.done(run("tetrahedralize", BRACKET, "-o", tets))
        self.assertEqual(below(tets.parent), ["bracket.msh"])
        result = run("info", tets)
        self.done(result)
        self.assertIn("tetrahedral mesh", result.stdout)
        self.done(run("compute", tets, "-o", self.out, *COARSE))
        self.done(run("compute", BRACKET, "-o", self.folder / "direct", *COARSE))
        self.assertEqual((self.out / "bracket.ma").read_bytes(), (self.folder / "direct/bracket.ma").read_bytes())

    def test_flat_faces_are_merged_unless_triangles_are_to_be_kept(self):
        points = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 2)] + [(0.5, 0.5, 1)]
        faces = ["0 2 3", "0 3 1", "4 5 8", "5 7 8", "7 6 8", "6 4 8", "0 1 5", "0 5 4", "2 6 7", "2 7 3", "0 4 6",
                 "0 6 2", "1 3 7", "1 7 5"]
        box = self.folder / "box.off"
        box.write_text("OFF\n9 14 0\n" + "".join(f"{x} {y} {z}\n" for x, y, z in points)
                       + "".join(f"3 {face}\n" for face in faces))
        for options, triangles in (((), 12), (("--keep-triangles",), 14)):
            out = self.folder / str(triangles)
            self.done(run("compute", box, "-o", out, *COARSE, *options))
            self.assertEqual(json.loads((out / "box.report.json").read_text())["input"]["surface_triangles"], triangles)

    def test_reconstruct(self):
        self.done(run("compute", BRACKET, "-o", self.out, "--quiet", *COARSE))
        mesh = self.out / "bracket.ma"
        self.done(run("reconstruct", mesh, "--tolerance", "1", "--quiet"))
        surface = self.out / "bracket.surface.ply"
        plain = surface.read_bytes()
        self.assertIn(b"comment written by matstruct", plain)

        colored = self.folder / "colored.ply"
        result = run("reconstruct", mesh, "-o", colored, "--tolerance", "1", "--surface", BRACKET, "--verify", "--json",
                     "--threads", "1")
        self.done(result)
        figures = json.loads(result.stdout)
        self.assertEqual((figures["topology"]["components"], figures["topology"]["genus"]), (1, 2))  # two holes
        self.assertTrue(figures["topology"]["equal"] and figures["envelope"]["holds"])
        self.assertIs(figures["surface"]["self_intersection"], False)
        self.assertLessEqual(figures["envelope"]["surface_to_envelope_percent"], 1)
        for key in ("surface_to_input_percent", "input_to_surface_percent"):
            self.assertTrue(0 < figures["input"][key] < 10, key)
        # The same surface, with a distance and a colour for each vertex.
        header, body = colored.read_bytes().split(b"end_header\n", 1)
        for words in (b"property double distance", b"property uchar red"):
            self.assertIn(words, header)
        before, place = plain.split(b"end_header\n", 1)[1], struct.Struct("<3d")
        row = struct.Struct("<4d3B")
        vertices = [row.unpack_from(body, k * row.size) for k in range(figures["surface"]["vertices"])]
        self.assertEqual([v[:3] for v in vertices], [place.unpack_from(before, k * place.size) for k in range(len(vertices))])
        greatest = 100 * max(v[3] for v in vertices)
        nearest, furthest = min(vertices, key=lambda v: v[3]), max(vertices, key=lambda v: v[3])
        self.assertGreater(greatest, 0)
        self.assertGreater(sum(furthest[4:]), sum(nearest[4:]))  # lighter where it is further

    def test_reconstruct_refuses(self):
        self.refused(run("reconstruct", self.folder / "none.ma"), 1, "none.ma")
        self.done(run("compute", BRACKET, "-o", self.out, "--quiet", *COARSE))
        before = below(self.out)
        for arguments in (("--tolerance", "0"), ("--tolerance", "11"), ("-o", self.folder / "x.stl")):
            self.refused(run("reconstruct", self.out / "bracket.ma", *arguments), 2)
        self.assertEqual(below(self.out), before)

    def test_info_of_an_open_surface_says_why_it_is_no_solid(self):
        triangle = self.folder / "triangle.off"
        triangle.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        result = run("info", triangle)
        self.done(result)
        self.assertIn("3 vertices, 1 triangles", result.stdout)
        self.assertRegex(result.stdout, "not a solid .*open")

    def test_an_assembly_gives_a_result_per_part(self):
        self.done(run("compute", SOURCE / "data/assembly.step", "-o", self.out, *COARSE))
        self.assertEqual([name for name in below(self.out) if name.endswith(".ma")],
                         ["assembly-plate-2.ma", "assembly-plate.ma", "assembly-round_pin.ma"])
        report = json.loads((self.out / "assembly-plate.report.json").read_text())
        self.assertEqual(report["topology"]["betti"], [1, 1, 0])
        self.assertEqual(report["input"]["part"], "plate")
        self.assertEqual(report["features"]["lines"], 14)
        self.assertLess(report["input"]["deviation_percent"], 0.05)
        result = run("info", SOURCE / "data/assembly.step")
        self.done(result)
        self.assertIn("round pin", result.stdout)

    def test_a_repair_is_in_the_report(self):
        cube = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
        faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        lines = ["v %g %g %g" % (x + d, y + d, z + d) for d in (0, 0.5) for x, y, z in cube]
        lines += ["f " + " ".join(str(i + k) for i in face) for k in (1, 9) for face in faces]
        (self.folder / "two.obj").write_text("\n".join(lines) + "\n")
        result = run("compute", self.folder / "two.obj", "-o", self.out, *COARSE)
        self.done(result)
        self.assertIn("was repaired", result.stderr)
        repair = json.loads((self.out / "two.report.json").read_text())["input"]["repair"]
        self.assertEqual(len(repair["steps"]), 1)
        self.assertAlmostEqual(repair["volume_change_percent"], -6.25)
        result = run("info", self.folder / "two.obj")
        self.assertRegex(result.stdout, r"(?m)^intersections +\d+, at \(")

    def test_threads_do_not_change_the_bytes(self):
        for threads in (1, 2):
            self.done(run("compute", BRACKET, "-o", self.folder / str(threads), "--threads", threads, *COARSE))
        for name in ("bracket.ma", "bracket.ply", "bracket.structure.json"):
            self.assertEqual((self.folder / "1" / name).read_bytes(), (self.folder / "2" / name).read_bytes(), name)

    @unittest.skipUnless(FINE.exists(), "the shared models are not here")
    def test_the_environment_does_not_change_the_bytes(self):
        for name, places in (("short", 1), ("long", 40)):
            path = ":".join(["/usr/bin", *["/usr/local/bin"] * places])
            environment = {**os.environ, "PATH": path, "HOME": str(self.folder / name)}
            self.done(run("compute", FINE, "-o", self.folder / name, *COARSE, env=environment))
        for file in ("part-2.ma", "part-2.solid.ply"):
            self.assertEqual((self.folder / "short" / file).read_bytes(), (self.folder / "long" / file).read_bytes())

    def test_quiet_says_nothing(self):
        result = run("compute", BRACKET, "-o", self.out, "--quiet", *COARSE)
        self.done(result)
        self.assertEqual(result.stderr, "")

    def test_progress_without_terminal_is_a_line_per_stage(self):
        result = run("compute", BRACKET, "-o", self.out, *COARSE)
        self.assertRegex(result.stderr, r"(?m)^ +\d+\.\d\d s  tetrahedralise$")
        self.assertNotIn("\r", result.stderr)


class StructureFile(ToolTest):
    """NAME.structure.json as docs/structure-schema.md has it."""
    TYPES = {"sheet": 0, "seam": 1, "junction": 2, "sharp": 3, "corner": 4}

    def structure_of(self, surface):
        """The file, and vertex types, edges and faces of the .ma file."""
        self.done(run("compute", surface, "-o", self.out, "--samples", 1000, "--gamma", 16))
        text = (self.out / f"{surface.stem}.structure.json").read_text()
        structure = json.loads(text)
        self.assertEqual(json.loads(json.dumps(structure)), structure)
        lines = [line.split() for line in (self.out / f"{surface.stem}.ma").read_text().splitlines()]
        types = [int(line[5]) for line in lines if line[0] == "v"]
        edges = {tuple(map(int, line[1:])) for line in lines if line[0] == "e"}
        faces = [tuple(map(int, line[1:])) for line in lines if line[0] == "f"]
        self.assertEqual(structure["mesh"], {"vertices": len(types), "edges": len(edges), "faces": len(faces)})
        return structure, types, edges, faces

    def box(self):
        """2 x 3 x 5, as an .off file."""
        file = self.folder / "box.off"
        corners = [(2 * (k & 1), 3 * (k >> 1 & 1), 5 * (k >> 2)) for k in range(8)]
        quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        file.write_text("OFF\n8 6 0\n" + "".join(f"{x} {y} {z}\n" for x, y, z in corners) +
                        "".join("4 " + " ".join(map(str, q)) + "\n" for q in quads))
        return file

    def check_consistent(self, structure, types, edges, faces):
        kinds = ("sheets", "seams", "boundaries", "curves", "junctions", "corners")
        strata = [(kind, k, s) for kind in kinds for k, s in enumerate(structure[kind])]
        self.assertEqual([s["id"] for _, _, s in strata], list(range(len(strata))))
        self.assertEqual(sorted(f for s in structure["sheets"] for f in s["faces"]), list(range(len(faces))))
        count = {edge: 0 for edge in edges}
        for a, b, c in faces:
            for edge in ((a, b), (a, c), (b, c)):
                count[edge] += 1
        chains = {}
        for kind in ("seams", "boundaries", "curves"):
            for curve in structure[kind]:
                self.assertEqual(curve["closed"], curve["vertices"][0] == curve["vertices"][-1])
                for a, b in zip(curve["vertices"], curve["vertices"][1:]):
                    edge = (min(a, b), max(a, b))
                    self.assertNotIn(edge, chains)
                    chains[edge] = kind
                    self.assertEqual(count[edge], len(curve["sheets"]))
        self.assertEqual(set(chains), {edge for edge in edges if count[edge] != 2})
        on_seams = {v for curve in structure["seams"] for v in curve["vertices"]}
        junctions = {p["vertex"] for p in structure["junctions"]}
        for v, t in enumerate(types):
            if t not in (self.TYPES["sharp"], self.TYPES["corner"]):
                name = "junction" if v in junctions else "seam" if v in on_seams else "sheet"
                self.assertEqual(t, self.TYPES[name])
        for lower, higher in structure["adjacency"]:
            self.assertTrue(0 <= higher < lower < len(strata))
        contacts = structure["contacts"]
        self.assertEqual(len(contacts["start"]), len(types) + 1)
        self.assertEqual(contacts["start"][-1], len(contacts["points"]))
        self.assertEqual(len(contacts["points"]), len(contacts["triangles"]))
        self.assertLess(max(contacts["triangles"]), len(contacts["patch_of_triangle"]))

    def test_box(self):
        structure, types, edges, faces = self.structure_of(self.box())
        self.assertEqual((structure["schema"], structure["schema_version"]), ("matstruct-structure", 1))
        sizes = {kind: len(structure[kind]) for kind in ("sheets", "seams", "boundaries", "curves", "junctions", "corners")}
        self.assertEqual(sizes, {"sheets": 13, "seams": 12, "boundaries": 12, "curves": 0, "junctions": 4, "corners": 8})
        self.check_consistent(structure, types, edges, faces)
        self.assertEqual(len(set(structure["contacts"]["patch_of_triangle"])), 6)
        contacts = [b - a for a, b in zip(structure["contacts"]["start"], structure["contacts"]["start"][1:])]
        for kind, number in (("sheet", 2), ("seam", 3), ("junction", 4)):
            self.assertEqual({n for n, t in zip(contacts, types) if t == self.TYPES[kind]}, {number})
        self.assertEqual([s["closed"] for s in structure["seams"]], 12 * [False])
        self.assertEqual([b["sharp"] for b in structure["boundaries"]], 12 * [True])
        # Exact: the seams to the eight corners and around the sheet in the middle, 1 x 3.
        lengths = sorted(round(s["length"], 6) for s in structure["seams"])
        self.assertEqual(lengths, [1, 1] + 8 * [1.732051] + [3, 3])
        middle = [s for s in structure["sheets"] if not s["boundaries"]]
        self.assertEqual(len(middle), 1)
        self.assertAlmostEqual(middle[0]["area"], 3)
        self.assertAlmostEqual(middle[0]["mean_radius"], 1)
        report = json.loads((self.out / "box.report.json").read_text())["structure"]
        self.assertEqual((report["sheets"], report["seams"], report["junctions"]), (13, 12, 4))
        self.assertEqual(report["seam_spheres_tangent"], report["seam_spheres"])

    def test_bracket(self):
        self.check_consistent(*self.structure_of(BRACKET))


class Failures(ToolTest):
    """Whatever goes wrong, nothing half-written stays."""

    def test_missing_input(self):
        self.refused(run("compute", "missing.stl", "-o", self.out), 1, "missing.stl")
        self.refused(run("info", "missing.stl"), 1, "missing.stl")
        self.refused(run("evaluate", "missing.ma", "--surface", BRACKET), 1, "missing.ma")
        self.refused(run("tetrahedralize", "missing.stl", "-o", self.out / "x.msh"), 1, "missing.stl")
        self.assertFalse(self.out.exists())

    def test_output_folder_is_a_file(self):
        self.out.write_text("mine")
        self.refused(run("compute", BRACKET, "-o", self.out), 1, str(self.out))
        self.assertEqual(self.out.read_text(), "mine")

    @unittest.skipIf(os.geteuid() == 0, "root may write everywhere")
    def test_output_folder_is_read_only(self):
        self.out.mkdir(mode=0o500)
        self.refused(run("compute", BRACKET, "-o", self.out), 1, str(self.out))

    def test_one_result_cannot_be_moved_to_its_place(self):
        (self.out / "bracket.report.json").mkdir(parents=True)
        result = run("compute", BRACKET, "-o", self.out, "--quiet", *COARSE)
        self.refused(result, 1, "bracket.report.json")
        self.assertEqual(below(self.out), [])

    def test_full_disk(self):
        tets = self.folder / "bracket.msh"
        self.done(run("tetrahedralize", BRACKET, "-o", tets))
        # Python ignores SIGXFSZ; with restore_signals off so does the tool, and writing beyond the limit fails.
        result = run("compute", tets, "-o", self.out, "--quiet", *COARSE, restore_signals=False,
                     preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100)))
        self.refused(result, 1, "bracket")
        self.assertFalse(self.out.exists())

    def interrupt(self, number, out):
        process = subprocess.Popen([TOOL, "compute", str(BRACKET), "-o", str(out), "--gamma", "200"],
                                   stderr=subprocess.PIPE, text=True)
        first = process.stderr.readline()  # a stage is done: the run is on its way
        process.send_signal(number)
        rest = process.communicate(timeout=TIMEOUT)[1]
        self.assertEqual(process.returncode, 130, first + rest)
        self.assertEqual(rest.splitlines()[-1], "matstruct: interrupted; nothing was written.")

    def test_interrupted_run_leaves_nothing(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            self.interrupt(number, self.out)
            self.assertFalse(self.out.exists())

    def test_interrupted_run_keeps_what_was_there(self):
        self.out.mkdir()
        (self.out / "bracket.ma").write_text("older")
        self.interrupt(signal.SIGINT, self.out)
        self.assertEqual(below(self.out), ["bracket.ma"])
        self.assertEqual((self.out / "bracket.ma").read_text(), "older")


class BadFiles(ToolTest):
    """Files of tools/make_bad_files.py are refused with one sentence, or repaired, as their manifest says."""

    def run_all(self, chosen, least):
        files = self.folder / "bad"
        subprocess.run([sys.executable, SOURCE / "tools/make_bad_files.py", files], check=True, timeout=TIMEOUT)
        manifest = json.loads((files / "manifest.json").read_text())
        # bench/run_bad_files.py runs all.
        manifest = [entry for entry in manifest if not entry["long"] and chosen(entry)]
        self.assertGreaterEqual(len(manifest), least)

        def compute(entry):
            return run("compute", files / entry["file"], "-o", self.out / entry["file"], "--quiet", "--threads", 1,
                       *COARSE)
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            for entry, result in zip(manifest, pool.map(compute, manifest)):
                with self.subTest(file=entry["file"], defect=entry["defect"]):
                    self.check(entry, result, self.out / entry["file"])

    def check(self, entry, result, out):
        if entry["expect"] == "accepted" or (entry["expect"] == "either" and result.returncode == 0):
            self.done(result)
            self.assertEqual(len(below(out)), 5)
        elif entry["expect"] == "solid":
            self.assertIn(result.returncode, (0, 3), result.stderr)
        else:
            self.refused(result, 1, pathlib.Path(entry["file"]).name, *entry["words"])
            self.assertFalse(out.exists())


class Refusals(BadFiles):
    def test_refused(self):
        self.run_all(lambda entry: entry["expect"] == "refused", 150)


class BadInput(BadFiles):
    def test_not_refused(self):
        self.run_all(lambda entry: entry["expect"] != "refused", 50)


class Consumer(ToolTest):
    """Another project finds, links and runs the installed library."""

    def test_find_package(self):
        prefix, project = self.folder / "prefix", self.folder / "build"

        def quietly(*command):
            result = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=TIMEOUT)
            self.assertEqual(result.returncode, 0, result.stdout[-4000:] + result.stderr[-4000:])
            return result.stdout
        quietly("cmake", "--install", BUILD, "--prefix", prefix)
        quietly("cmake", "-S", SOURCE / "tests/consumer", "-B", project, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}",
                "-DCMAKE_BUILD_TYPE=Release")
        quietly("cmake", "--build", project)
        self.assertEqual(quietly(project / "consumer"), "topology kept: yes\n")

    def test_installed_tool_finds_its_mesher(self):
        quiet = {"check": True, "capture_output": True, "timeout": TIMEOUT}
        subprocess.run(["cmake", "--install", BUILD, "--prefix", self.folder / "prefix"], **quiet)
        subprocess.run([self.folder / "prefix/bin/matstruct", "tetrahedralize", BRACKET, "-o", self.folder / "b.msh"], **quiet)
        self.assertIn("b.msh", below(self.folder))


if __name__ == "__main__":
    unittest.main(verbosity=2)
