#!/usr/bin/env python3
"""What `matstruct export` and `compute --export` write, opened by VTK and compared with the .ma file. Environment as in
tool_test.py. Exits with 77 where VTK's Python module is missing (Debian: python3-vtk9)."""
import collections
import json
import struct
import sys
import unittest

from tool_test import BRACKET, COARSE, ToolTest, below, run

try:
    from vtkmodules.vtkIOGeometry import vtkGLTFReader, vtkOBJReader
    from vtkmodules.vtkIOPLY import vtkPLYReader
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
except ImportError:
    print("VTK is not here: skipped")
    sys.exit(77)


def read_ma(path):
    rows = collections.defaultdict(list)
    for line in path.read_text().splitlines()[1:]:
        key, *numbers = line.split()
        if key in "vef":
            rows[key].append([float(x) if key == "v" else int(x) for x in numbers])
    return rows["v"], rows["e"], rows["f"]


def read(reader, path):
    problems = []
    reader.AddObserver("ErrorEvent", lambda *_: problems.append(str(path)))
    reader.SetFileName(str(path))
    reader.Update()
    assert not problems, problems
    return reader.GetOutput()


def points(data):
    return [data.GetPoint(k) for k in range(data.GetNumberOfPoints())]


def cells(data, corners=None):
    found = []
    for k in range(data.GetNumberOfCells()):
        cell = data.GetCell(k)
        found.append([cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())])
    return [cell for cell in found if corners in (None, len(cell))]


def field(attributes, name):
    array = attributes.GetArray(name)
    return [array.GetComponent(k, 0) for k in range(array.GetNumberOfTuples())]


def sheets_of(faces):
    """Sheets found anew: faces connected over edges with two faces. A label per face, the least face of its sheet."""
    of_edge = collections.defaultdict(list)
    for k, (a, b, c) in enumerate(faces):
        for edge in ((a, b), (a, c), (b, c)):
            of_edge[edge].append(k)
    label = list(range(len(faces)))

    def root(k):
        while label[k] != k:
            k = label[k]
        return k
    for pair in of_edge.values():
        if len(pair) == 2:
            a, b = sorted(map(root, pair))
            label[b] = a
    return [root(k) for k in range(len(faces))]


class Exports(ToolTest):
    def setUp(self):
        super().setUp()
        self.done(run("compute", BRACKET, "-o", self.out, "--quiet", *COARSE, "--export", "vtp,obj,glb"))
        self.spheres, self.edges, self.faces = read_ma(self.out / "bracket.ma")

    def same_partition(self, sheets):
        """The ids name the sheets that the faces form, in the order of their first faces."""
        firsts = sheets_of(self.faces)
        order = {first: k for k, first in enumerate(sorted(set(firsts)))}
        self.assertGreater(len(order), 1)
        self.assertEqual(sheets, [order[first] for first in firsts])
        return len(order)

    def outer_edges(self):
        """Edges that lie inside no sheet."""
        faces = collections.Counter(e for a, b, c in self.faces for e in ((a, b), (a, c), (b, c)))
        return sorted(tuple(e) for e in self.edges if faces[tuple(e)] != 2)

    def test_all_appear_at_once(self):
        self.assertEqual([name for name in below(self.out) if not name.endswith((".json", ".solid.ply"))],
                         [f"bracket.{extension}" for extension in ("glb", "ma", "obj", "ply", "vtp")])

    def test_export_writes_what_compute_does(self):
        files = [self.folder / "deep/x.vtp", self.folder / "x.ply", self.folder / "x.obj", self.folder / "x.glb"]
        self.done(run("export", self.out / "bracket.ma", "-o", *files, "--quiet"))
        for file in files:
            self.assertEqual(file.read_bytes(), (self.out / f"bracket{file.suffix}").read_bytes(), file)

    def test_refusals(self):
        self.refused(run("export", self.out / "bracket.ma", "-o", self.folder / "x.stp"), 2, "x.stp", ".vtp")
        self.refused(run("export", self.folder / "none.ma", "-o", self.folder / "x.vtp"), 1, "none.ma")
        self.refused(run("compute", BRACKET, "-o", self.out, "--export", "vtp,stp"), 2, "--export")

    def test_vtp(self):
        data = read(vtkXMLPolyDataReader(), self.out / "bracket.vtp")
        self.assertEqual(points(data), [tuple(s[:3]) for s in self.spheres])
        self.assertEqual(field(data.GetPointData(), "radius"), [s[3] for s in self.spheres])
        self.assertEqual(field(data.GetPointData(), "type"), [s[4] for s in self.spheres])
        lines, polys = data.GetNumberOfLines(), data.GetNumberOfPolys()
        self.assertEqual(polys, len(self.faces))
        shape = cells(data)
        self.assertEqual(shape[lines:], self.faces)
        sheet, stratum = (field(data.GetCellData(), name) for name in ("sheet", "stratum"))
        self.assertEqual(sheet[:lines], [-1] * lines)
        sheets = self.same_partition(sheet[lines:])
        self.assertEqual(stratum, [sheets + k for k in range(lines)] + sheet[lines:])
        # The lines are the edges that lie inside no sheet, each once.
        self.assertEqual(sorted(tuple(sorted(pair)) for line in shape[:lines] for pair in zip(line, line[1:])),
                         self.outer_edges())
        of_vertex = field(data.GetPointData(), "stratum")
        on_lines = {v for line in shape[:lines] for v in line}
        for v, of in enumerate(of_vertex):
            self.assertEqual(of >= sheets, v in on_lines, v)
            if sheets <= of < sheets + lines:
                self.assertIn(v, shape[int(of) - sheets])

    def test_ply(self):
        data = read(vtkPLYReader(), self.out / "bracket.ply")
        self.assertEqual(data.GetNumberOfPoints(), len(self.spheres))
        for place, sphere in zip(points(data), self.spheres):  # VTK keeps places of this format in single precision
            for x, y in zip(place, sphere):
                self.assertAlmostEqual(x, y, delta=1e-6 * max(1, abs(y)))
        self.assertEqual(cells(data, 3), self.faces)
        # VTK leaves out fields that it does not know: they are read here.
        bytes_ = (self.out / "bracket.ply").read_bytes()
        body = bytes_.index(b"end_header\n") + 11
        vtp = read(vtkXMLPolyDataReader(), self.out / "bracket.vtp")
        vertex, face = struct.Struct("<4dBi"), struct.Struct("<B3ii")
        rows = [vertex.unpack_from(bytes_, body + k * vertex.size) for k in range(len(self.spheres))]
        self.assertEqual([list(row[:5]) for row in rows], self.spheres)
        self.assertEqual([row[5] for row in rows], field(vtp.GetPointData(), "stratum"))
        body += len(self.spheres) * vertex.size
        self.same_partition([face.unpack_from(bytes_, body + k * face.size)[4] for k in range(len(self.faces))])

    def test_obj(self):
        data = read(vtkOBJReader(), self.out / "bracket.obj")
        self.assertEqual(data.GetNumberOfPoints(), len(self.spheres))
        self.assertEqual(data.GetNumberOfPolys(), len(self.faces))
        groups = collections.defaultdict(list)
        for line in (self.out / "bracket.obj").read_text().splitlines():
            if line.startswith("g "):
                group = line[2:]
            elif line[0] in "flp":
                groups[group].append([int(x) - 1 for x in line.split()[1:]])
        sheet = {tuple(f): int(name.split("_")[1]) for name, rows in groups.items() if name.startswith("sheet") for f in rows}
        self.same_partition([sheet[tuple(f)] for f in self.faces])
        curves = [row for name, rows in groups.items() if name.startswith(("seam", "boundary", "curve")) for row in rows]
        self.assertEqual(sorted(tuple(sorted(pair)) for row in curves for pair in zip(row, row[1:])), self.outer_edges())

    def test_glb(self):
        path = self.out / "bracket.glb"
        bytes_ = path.read_bytes()
        magic, version, length, json_length, kind = struct.unpack_from("<5I", bytes_)
        self.assertEqual((magic, version, length, kind), (0x46546c67, 2, len(bytes_), 0x4e4f534a))
        scene = json.loads(bytes_[20:20 + json_length])
        self.assertEqual(struct.unpack_from("<2I", bytes_, 20 + json_length),
                         (scene["buffers"][0]["byteLength"], 0x004e4942))

        blocks = read(vtkGLTFReader(), path)
        triangles, segments, places, meshes = [], [], set(), 0
        walk = [blocks]
        while walk:
            block = walk.pop()
            if hasattr(block, "GetNumberOfBlocks"):
                walk += [block.GetBlock(k) for k in range(block.GetNumberOfBlocks())]
                continue
            meshes += 1
            triangles += cells(block, 3)
            segments += cells(block, 2)
            places.update(points(block))
        self.assertEqual(sorted(map(sorted, triangles)), sorted(self.faces))
        self.assertEqual(sorted(tuple(sorted(s)) for s in segments), self.outer_edges())
        self.assertGreaterEqual(meshes, len(set(sheets_of(self.faces))))
        # (x, y, z) of the part is (x, z, -y) here, where y is up.
        wanted = [(x, z, -y) for x, y, z, *_ in self.spheres]
        self.assertEqual(len({min(range(len(wanted)), key=lambda k: max(abs(a - b) for a, b in zip(wanted[k], p)))
                              for p in places}), len(wanted))
        size = max(abs(x) for p in wanted for x in p)
        for p in places:
            self.assertLess(min(max(abs(a - b) for a, b in zip(w, p)) for w in wanted), 1e-5 * size)


if __name__ == "__main__":
    unittest.main()
