#!/usr/bin/env python3
"""Write model files that are broken in one way each, with a manifest of what a program has to say about them.

    make_bad_files.py FOLDER           broken files and FOLDER/manifest.json
    make_bad_files.py --seeds FOLDER   small valid files, one subfolder per format, as first inputs of the fuzzers

The manifest is a list of objects:
    file      name within FOLDER
    defect    what is wrong, in a few words
    stage     "read" if a reader can tell, "prepare" if only the checks of the geometry can, "cad" if it is a CAD file
    expect    "refused", "accepted" (as it is or repaired), "either", or "solid": a solid is made of it, but it is hard, and
              a guarantee of the result may fail (exit code 3)
    long      true if it takes more than some seconds
    words     for refused files: pieces of text that the message contains (compared without regard to case)
"""
import argparse
import json
import random
import struct
from math import cos, pi, sin
from pathlib import Path

from model_files import (CUBE, CUBE_QUADS, CUBE_TETS, CUBE_TRIANGLES, medial, medit, msh2, msh2_binary, msh4,
                         msh4_binary, numbers, obj, off, ply, stl_binary, stl_text, vtk, vtk_binary, vtk_offsets, vtu,
                         vtu_flavours)


# ---------------------------------------------------------------- shapes that are wrong as geometry

def moved(vertices, by, scale=1.0):
    return [tuple(scale * x + d for x, d in zip(v, by)) for v in vertices]


def joined(*parts):
    """One mesh of several (vertices, elements), without common vertices."""
    vertices, elements = [], []
    for part_vertices, part_elements in parts:
        elements += [tuple(i + len(vertices) for i in e) for e in part_elements]
        vertices += part_vertices
    return vertices, elements


def welded(vertices, elements):
    """Equal vertices become one."""
    first = {}
    ids = [first.setdefault(v, len(first)) for v in vertices]
    return list(first), [tuple(ids[i] for i in e) for e in elements]


def mobius_strip(n=12):
    vertices = []
    for k in range(n):
        a = 2 * pi * k / n
        for w in (-0.3, 0.3):
            r = 1 + w * cos(a / 2)
            vertices.append((r * cos(a), r * sin(a), w * sin(a / 2)))
    faces = []
    for k in range(n):
        a, b = 2 * k, 2 * k + 1
        c, d = (a + 2, b + 2) if k + 1 < n else (1, 0)
        faces += [(a, c, d), (a, d, b)]
    return vertices, faces


def klein_bottle(n=8):
    """Closed, one-sided: every edge has two triangles, but they cannot be oriented. It meets itself, too."""
    vertices = []
    for i in range(n):
        u = 2 * pi * i / n
        for j in range(n):
            v = 2 * pi * j / n
            r = 2 + cos(u / 2) * sin(v) - sin(u / 2) * sin(2 * v)
            vertices.append((r * cos(u), r * sin(u), sin(u / 2) * sin(v) + cos(u / 2) * sin(2 * v)))
    faces = []
    for i in range(n):
        for j in range(n):
            def at(p, q):
                return p * n + q % n if p < n else (-q) % n
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            faces += [(a, b, c), (a, c, d)]
    return vertices, faces


def sphere(n=12, radius=1.0):
    """2 n by n facets, a single vertex at each pole."""
    vertices = [(0.0, 0.0, -radius)]
    for i in range(1, n):
        a = pi * i / n
        vertices += [(radius * sin(a) * cos(pi * j / n), radius * sin(a) * sin(pi * j / n), -radius * cos(a))
                     for j in range(2 * n)]
    vertices.append((0.0, 0.0, radius))
    top, faces = len(vertices) - 1, []
    for j in range(2 * n):
        k = (j + 1) % (2 * n)
        faces += [(0, 1 + k, 1 + j), (top, top - 2 * n + j, top - 2 * n + k)]
        for i in range(n - 2):
            a, b, c, d = (1 + 2 * n * i + j, 1 + 2 * n * i + k, 1 + 2 * n * (i + 1) + k, 1 + 2 * n * (i + 1) + j)
            faces += [(a, b, c), (a, c, d)]
    return vertices, faces


def torus(large, small, n=16, m=10):
    vertices = [((large + small * cos(2 * pi * j / m)) * cos(2 * pi * i / n),
                 (large + small * cos(2 * pi * j / m)) * sin(2 * pi * i / n), small * sin(2 * pi * j / m))
                for i in range(n) for j in range(m)]
    faces = []
    for i in range(n):
        for j in range(m):
            a, b = i * m + j, (i + 1) % n * m + j
            c, d = (i + 1) % n * m + (j + 1) % m, i * m + (j + 1) % m
            faces += [(a, b, c), (a, c, d)]
    return vertices, faces


def prism(outline, height=1.0):
    """Extrusion of a polygon, which may cut itself, with fans from the mean of its corners as lids."""
    n = len(outline)
    vertices = [(x, y, z) for z in (0.0, height) for x, y in outline]
    mean = [sum(c) / n for c in zip(*outline)]
    vertices += [(*mean, 0.0), (*mean, height)]
    faces = []
    for i in range(n):
        j = (i + 1) % n
        faces += [(i, j, n + j), (i, n + j, n + i), (2 * n, j, i), (2 * n + 1, n + i, n + j)]
    return vertices, faces


def box(low, high):
    return [tuple(high[k] if v[k] else low[k] for k in range(3)) for v in CUBE], CUBE_TRIANGLES


def flipped(mesh, share=1.0, seed=1):
    generator = random.Random(seed)
    return mesh[0], [f[::-1] if generator.random() < share else f for f in mesh[1]]


def without(mesh, faces):
    return mesh[0], [f for i, f in enumerate(mesh[1]) if i not in faces]


def shaken(mesh, amount, seed=1):
    generator = random.Random(seed)
    return [tuple(x + generator.uniform(-amount, amount) for x in v) for v in mesh[0]], mesh[1]


# ---------------------------------------------------------------- the collection

class Collection:
    def __init__(self, folder):
        self.folder = folder
        self.manifest = []
        folder.mkdir(parents=True, exist_ok=True)

    def add(self, name, defect, content, *words, stage="read", expect="refused", long=False):
        data = content.encode() if isinstance(content, str) else content
        (self.folder / name).write_bytes(data)
        self.manifest.append({"file": name, "defect": defect, "stage": stage, "expect": expect, "long": long, "words": list(words)})

    def accept(self, name, defect, content, stage="read"):
        self.add(name, defect, content, stage=stage, expect="accepted")


def add_general(c):
    for extension in ("msh", "mesh", "vtk", "vtu", "stl", "obj", "off", "ply"):
        c.add(f"empty.{extension}", "empty file", "", "empty")
        c.add(f"noise.{extension}", "bytes without meaning", bytes((i * 97 + 31) % 256 for i in range(300)))
    c.add("blanks.stl", "only blanks", " \n \n", "STL")
    c.add("model.xyz", "unknown extension", "0 0 0\n", ".xyz", "convert")
    c.add("no_extension", "no extension", off(CUBE, CUBE_TRIANGLES), "convert")
    c.add("off_named.obj", "wrong extension: OFF named OBJ", off(CUBE, CUBE_TRIANGLES), "'8'", "line 2", "extension")
    c.add("stl_named.ply", "wrong extension: STL named PLY", stl_text(CUBE, CUBE_TRIANGLES), "ply", "extension")
    c.add("obj_named.off", "wrong extension: OBJ named OFF", obj(CUBE, CUBE_TRIANGLES), "OFF", "extension")
    c.add("ply_named.msh", "wrong extension: PLY named MSH", ply(CUBE, CUBE_TRIANGLES), "$MeshFormat")


def add_off(c):
    good = off(CUBE, CUBE_TRIANGLES)
    lines = good.splitlines()
    c.accept("cube.off", "nothing", good)
    c.accept("comments.off", "comments and colours", good.replace("OFF\n", "OFF # cube\n# more\n\n") + "# end\n")
    c.accept("repeated_corner.off", "a face names a vertex twice: left out", off(CUBE, CUBE_TRIANGLES + [(0, 0, 1)]))
    c.add("truncated_faces.off", "ends within the faces", "\n".join(lines[:14]) + "\n", "face 4", "truncated")
    c.add("truncated_vertices.off", "ends within the vertices", "\n".join(lines[:6]) + "\n", "truncated")
    c.add("nan.off", "NaN coordinate", good.replace("1.0 1.0 1.0", "1.0 nan 1.0"), "y coordinate", "vertex 7",
          "line 10")
    c.add("inf.off", "infinite coordinate", good.replace("1.0 1.0 1.0", "1.0 1.0 -inf"), "z coordinate", "vertex 7")
    c.add("overflow.off", "coordinate too large for a double", good.replace("1.0 1.0 1.0", "1e999 1.0 1.0"), "inf")
    c.add("word.off", "word instead of a number", good.replace("1.0 1.0 1.0", "1.0 one 1.0"), "'one'", "line 10")
    c.add("comma.off", "decimal commas", good.replace("1.0 1.0 1.0", "1,0 1,0 1,0"), "'1,0'", "line 10")
    c.add("short_line.off", "vertex of two coordinates", good.replace("1.0 1.0 1.0", "1.0 1.0"), "line 10", "vertex 7")
    c.add("index_high.off", "index beyond the vertices", off(CUBE, CUBE_TRIANGLES[:-1] + [(1, 7, 8)]), "vertex 8",
          "face 11", "line 22")
    c.add("index_negative.off", "negative index", off(CUBE, CUBE_TRIANGLES[:-1] + [(1, 7, -1)]), "vertex -1", "line 22")
    c.add("two_corners.off", "face of two corners", off(CUBE, CUBE_TRIANGLES[:-1] + [(1, 7)]), "2 corners", "line 22")
    c.add("no_faces.off", "point cloud", off(CUBE, []), "no faces", "point cloud")
    c.add("nothing.off", "no vertices", off([], []), "no vertices")
    c.add("huge_count.off", "four thousand million vertices announced", "OFF\n4000000000 1 0\n0 0 0\n", "4000000000")
    c.add("big_count.off", "more vertices announced than bytes follow", "OFF\n2000000000 1 0\n0 0 0\n", "2000000000",
          "bytes follow")
    c.add("negative_count.off", "negative count", "OFF\n-8 12 0\n0 0 0\n", "-8")
    c.add("more.off", "more faces than announced", good + "3 0 1 2\n", "more", "12 faces")
    c.add("binary.off", "binary OFF", "OFF BINARY\n" + "\0" * 50, "binary")
    c.add("four_dimensions.off", "homogeneous coordinates", good.replace("OFF", "4OFF"), "dimensions")


def add_obj(c):
    good = obj(CUBE, CUBE_TRIANGLES)
    c.accept("cube.obj", "nothing", good)
    c.accept("negative.obj", "indices that count from the end",
             obj(CUBE, [tuple(i - 9 for i in f) for f in CUBE_QUADS]))
    c.accept("faces_first.obj", "faces before the vertices",
             "\n".join(sorted(good.splitlines(), key=lambda line: line[0] == "v")) + "\n")
    c.add("zero_index.obj", "index 0", good + "f 0 1 2\n", "vertex 0", "line 22")
    c.add("index_high.obj", "index beyond the vertices", good + "f 1 2 9\n", "vertex 9", "8 vertices", "line 22")
    c.add("index_before.obj", "negative index before the first vertex", good + "f -1 -2 -9\n", "vertex -9", "line 22")
    c.add("index_word.obj", "word instead of an index", good + "f 1 2 x/1\n", "'x/1'", "line 22")
    c.add("two_corners.obj", "face of two corners", good + "f 1// 2//\n", "2 corners", "line 22")
    c.add("nan.obj", "NaN coordinate", good.replace("v 1.0 1.0 1.0", "v 1.0 1.0 nan"), "z coordinate", "line 9")
    c.add("points.obj", "point cloud", obj(CUBE, []), "point cloud")
    c.add("comment_only.obj", "only a comment", "# nothing\n", "no vertices")
    c.add("short_vertex.obj", "vertex of two coordinates", "v 1 2\n" + good, "line 1", "vertex 1")


def add_ply(c):
    good = ply(CUBE, CUBE_TRIANGLES)
    little = ply(CUBE, CUBE_TRIANGLES, "binary_little_endian")
    c.accept("cube.ply", "nothing", good)
    c.accept("little.ply", "nothing", little)
    c.accept("big.ply", "nothing", ply(CUBE, CUBE_TRIANGLES, "binary_big_endian"))
    c.add("truncated_text.ply", "ends within the faces", good[:-8], "truncated")
    c.add("truncated.ply", "ends within the faces", little[:-8], "truncated", "bytes follow")
    c.add("truncated_vertices.ply", "ends within the vertices",
          little[:little.index(b"end_header") + 30], "bytes follow")
    c.add("header_only.ply", "ends within the header", good[:good.index("property float z")], "header", "truncated")
    c.add("no_format.ply", "no format line", good.replace("format ascii 1.0\n", ""), "format")
    c.add("middle_endian.ply", "unknown format", good.replace("ascii", "binary_middle_endian"), "binary_middle_endian")
    c.add("no_z.ply", "no z coordinate", good.replace("property float z\n", ""), "x, y or z")
    c.add("type.ply", "unknown type", good.replace("float x", "quaternion x"), "'quaternion'", "line 5")
    c.add("header_word.ply", "unknown header statement", good.replace("comment a model", "colour red"), "'colour'")
    c.add("nan.ply", "NaN coordinate",
          ply(CUBE[:7] + [(1.0, 1.0, float("nan"))], CUBE_TRIANGLES, "binary_little_endian"), "z coordinate",
          "vertex 7", "byte")
    c.add("index_high.ply", "index beyond the vertices", ply(CUBE, [(0, 1, 8)], "binary_big_endian"), "vertex 8",
          "face 0")
    c.add("index_negative.ply", "negative index", ply(CUBE, [(0, 1, -2)]), "vertex -2", "face 0")
    c.add("index_real.ply", "real numbers as indices", good.replace("uchar int", "uchar float"), "real number")
    c.add("no_list.ply", "faces without a list of vertices", good.replace("vertex_indices", "colours"),
          "vertex_indices")
    c.add("points.ply", "point cloud", ply(CUBE, []), "point cloud")
    c.add("huge_count.ply", "more vertices announced than bytes follow", good.replace("vertex 8", "vertex 999999999"),
          "999999999")
    c.add("negative_count.ply", "negative count", good.replace("vertex 8", "vertex -8"), "-8")
    c.add("no_properties.ply", "element without properties", good.replace("element face", "element x 7\nelement face"),
          "'x'", "no properties")


def add_stl(c):
    good, binary = stl_text(CUBE, CUBE_TRIANGLES), stl_binary(CUBE, CUBE_TRIANGLES)
    c.accept("cube.stl", "nothing", good)
    c.accept("binary.stl", "nothing", binary)
    c.accept("solid.stl", "binary whose header begins with 'solid'",
             stl_binary(CUBE, CUBE_TRIANGLES, header=b"solid cube"))
    c.accept("nan_normal.stl", "NaN in a normal, which is not used", good.replace("normal 0 0 0", "normal nan nan nan"))
    c.add("truncated.stl", "ends within the facets", binary[:-30], "12 facets", "bytes follow")
    c.add("truncated_solid.stl", "binary with 'solid', ends within the facets",
          stl_binary(CUBE, CUBE_TRIANGLES, header=b"solid cube")[:-30], "12 facets", "bytes follow")
    c.add("too_long.stl", "more bytes than announced", binary + b"\0" * 7, "12 facets", "bytes follow")
    c.add("huge_count.stl", "more facets announced than bytes follow", stl_binary(CUBE, CUBE_TRIANGLES, 0xFFFFFFFF),
          "4294967295 facets")
    c.add("no_endsolid.stl", "ends after a facet", stl_text(CUBE, CUBE_TRIANGLES, end=""), "endsolid", "truncated")
    c.add("truncated_text.stl", "ends within a facet", good[:400], "truncated")
    c.add("four_corners.stl", "facet of four corners",
          good.replace("    endloop", "      vertex 0 0 0\n    endloop", 1), "'endloop'", "'vertex'", "line 7")
    c.add("word.stl", "word instead of a number", good.replace("vertex 1.0", "vertex one", 1), "'one'", "facet 1")
    c.add("nan.stl", "NaN coordinate", stl_binary(CUBE[:7] + [(1.0, float("nan"), 1.0)], CUBE_TRIANGLES),
          "y coordinate", "facet 3", "byte")
    c.add("no_facets.stl", "no facets", "solid nothing\nendsolid nothing\n", "no faces")
    c.add("no_facets_binary.stl", "no facets", stl_binary([], []), "no faces")
    c.add("short.stl", "too short for any STL", "STL", "too short")


def add_msh(c):
    tets = [(4, t) for t in CUBE_TETS]
    good, binary = msh2(CUBE, tets), msh2_binary(CUBE, CUBE_TETS)
    four, four_binary = msh4(CUBE, CUBE_TETS), msh4_binary(CUBE, CUBE_TETS)
    c.accept("cube2.msh", "nothing", good)
    c.accept("cube2_binary.msh", "nothing", binary)
    c.accept("cube2_big.msh", "big-endian", msh2_binary(CUBE, CUBE_TETS, ">"))
    c.accept("cube4.msh", "nothing", four)
    c.accept("cube4_binary.msh", "nothing", four_binary)
    c.accept("cube4_big.msh", "big-endian", msh4_binary(CUBE, CUBE_TETS, ">"))
    c.accept("mixed.msh", "points, lines, triangles among the tetrahedra",
             msh2(CUBE, [(15, (0,)), (1, (0, 1)), (2, (0, 1, 2)), (3, (0, 1, 3, 2))] + tets))
    c.add("hexahedron.msh", "hexahedron", msh2(CUBE, [(5, range(8))]), "hexahedron", "type 5")
    c.add("second_order.msh", "second-order tetrahedra", msh2(CUBE + CUBE[:2], [(11, range(10))]), "second-order", "11")
    c.add("unknown_type.msh", "unknown element type", msh2(CUBE, [(77, (0, 1, 2, 3))]), "77", "not known")
    c.add("no_elements.msh", "only points", msh2(CUBE, [(15, (0,))]), "no tetrahedra", "8 of them")
    c.add("no_section.msh", "no elements section", good[:good.index("$Elements")], "$Elements")
    c.add("no_nodes.msh", "no nodes", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", "$Nodes")
    c.add("version1.msh", "version 1", "$NOD\n1\n1 0 0 0\n$ENDNOD\n", "version 1")
    c.add("version40.msh", "version 4.0", four.replace("4.1 0 8", "4 0 8"), "'4'", "4.1 or 2.2")
    c.add("unknown_node.msh", "unknown node", msh2(CUBE, tets + [(4, (0, 1, 2, 98))]), "node 99", "element 7",
          "line 23")
    c.add("node_twice.msh", "node number used twice", good.replace("\n3 0.0", "\n2 0.0"), "two nodes", "2")
    c.add("corner_twice.msh", "tetrahedron with a corner twice", msh2(CUBE, tets + [(4, (0, 1, 2, 2))]), "twice",
          "element 7")
    c.add("nan.msh", "NaN coordinate", good.replace("1.0 1.0 1.0", "nan 1.0 1.0"), "x coordinate", "node 8", "line 13")
    c.add("word.msh", "word instead of a number", good.replace("1.0 1.0 1.0", "1.0 1.0 up"), "'up'", "line 13")
    c.add("truncated_text.msh", "ends within the elements", good[:-60], "truncated")
    c.add("no_end.msh", "ends without $EndElements", good[:good.index("$EndElements")], "truncated")
    c.add("truncated2.msh", "ends within the elements", binary[:-40], "bytes follow")
    c.add("truncated4.msh", "ends within the elements", four_binary[:-60], "bytes follow")
    c.add("truncated4_nodes.msh", "ends within the nodes", four_binary[:200], "bytes follow")
    c.add("byte_order.msh", "impossible byte order mark",
          binary.replace(struct.pack("<i", 1) + b"\n$EndM", b"abcd\n$EndM"), "byte order")
    c.add("huge_count2.msh", "more nodes announced than bytes follow", good.replace("$Nodes\n8", "$Nodes\n800000000"),
          "800000000")
    c.add("huge_count4.msh", "more nodes announced than bytes follow",
          four_binary.replace(struct.pack("<4Q", 1, 8, 1, 8), struct.pack("<4Q", 1, 2**40, 1, 8)), str(2**40))
    c.add("block_count4.msh", "blocks hold fewer nodes than announced", four.replace("1 8 1 8", "1 9 1 9"), "fewer")
    c.add("width.msh", "4-byte sizes", four_binary.replace(b"4.1 1 8", b"4.1 1 4"), "4 bytes")


def add_medit_and_vtk(c):
    good = medit(CUBE, CUBE_TETS)
    c.accept("cube.mesh", "nothing", good)
    c.add("index_zero.mesh", "index 0", good.replace("\n1 2 4 8", "\n0 2 4 8"), "vertex 0", "tetrahedron 1", "line 15")
    c.add("index_high.mesh", "index beyond the vertices", good.replace("\n1 2 4 8", "\n1 2 4 9"), "vertex 9", "line 15")
    c.add("dimension.mesh", "two dimensions", good.replace("Dimension 3", "Dimension 2"), "dimension 2")
    c.add("hexahedra.mesh", "hexahedra", good.replace("End\n", "Hexahedra\n1\n1 2 3 4 5 6 7 8 0\nEnd\n"), "Hexahedra")
    c.add("count_low.mesh", "more tetrahedra than announced", good.replace("Tetrahedra\n6", "Tetrahedra\n5"), "keyword")
    c.add("truncated.mesh", "ends within the tetrahedra", good[:-20], "truncated")
    c.add("nan.mesh", "NaN coordinate", good.replace("1.0 1.0 1.0", "1.0 1.0 nan"), "z coordinate", "vertex 8")
    c.add("other.mesh", "another .mesh format", "<mesh/>\n", "MeshVersionFormatted")

    good, binary, offsets = vtk(CUBE, CUBE_TETS), vtk_binary(CUBE, CUBE_TETS), vtk_offsets(CUBE, CUBE_TETS)
    c.accept("cube.vtk", "nothing", good)
    c.accept("cube_binary.vtk", "nothing", binary)
    c.accept("cube_offsets.vtk", "nothing", offsets)
    c.add("truncated.vtk", "ends within the points", binary[:200], "bytes follow")
    c.add("truncated_types.vtk", "ends within the cell types", binary[:-10], "bytes follow")
    c.add("voxel.vtk", "unhandled cell type", good.replace("\n10\n", "\n11\n", 1), "type 11", "cell 0")
    c.add("corners.vtk", "tetrahedron of three corners", good.replace("CELLS 6 30\n4 0 1 3 7", "CELLS 6 29\n3 0 1 3"),
          "3 corners")
    c.add("index_high.vtk", "index beyond the points", good.replace("\n4 0 1 3 7", "\n4 0 1 3 8"), "vertex 8", "cell 0")
    c.add("cell_size.vtk", "wrong size of the cells", good.replace("CELLS 6 30", "CELLS 6 31"), "31")
    c.add("offsets.vtk", "offsets out of order",
          offsets.replace(struct.pack(">2q", 4, 8), struct.pack(">2q", 8, 4)), "offset 2")
    c.add("dataset.vtk", "unhandled dataset", good.replace("UNSTRUCTURED_GRID", "STRUCTURED_POINTS"),
          "STRUCTURED_POINTS")
    c.add("xml.vtk", "XML format named .vtk", "<?xml version=\"1.0\"?>\n<VTKFile/>\n", "legacy")
    c.add("inf.vtk", "infinite coordinate", good.replace("1.0 1.0 1.0", "1.0 inf 1.0"), "y coordinate", "point 7")


def add_vtu(c):
    text = vtu(CUBE, CUBE_TETS).decode()
    inline = vtu(CUBE, CUBE_TETS, "binary").decode()
    raw = vtu(CUBE, CUBE_TETS, "appended")
    deflated = vtu(CUBE, CUBE_TETS, "appended", deflate=64)
    first = raw.index(b"\n_") + 2  # the length of the points
    first_deflated = deflated.index(b"\n_") + 2

    def changed(data, old, new):
        assert old in data
        return data.replace(old, new, 1)

    def word(data, place, value, kind="<I"):
        return data[:place] + struct.pack(kind, value) + data[place + struct.calcsize(kind):]

    c.accept("cube.vtu", "nothing", text)
    c.accept("cube_binary.vtu", "nothing", inline)
    c.accept("cube_raw.vtu", "nothing", raw)
    c.accept("cube_deflated.vtu", "nothing", deflated)
    c.accept("empty_piece.vtu", "a piece without points", changed(
        text, "<Piece", '<Piece NumberOfPoints="0" NumberOfCells="0"><Points/><Cells/></Piece>\n<Piece'))
    c.accept("pieces.vtu", "several pieces: one mesh", vtu(CUBE, CUBE_TETS, "appended", pieces=2))
    c.add("legacy.vtu", "legacy format named .vtu", vtk(CUBE, CUBE_TETS), "VTKFile", "legacy")
    c.add("truncated_text.vtu", "ends within an array", text[:500], "well-formed", "truncated")
    c.add("truncated_raw.vtu", "ends within the appended data", raw[:first + 100], "AppendedData", "truncated")
    c.add("unclosed.vtu", "an element is not closed", changed(text, "</Points>", ""), "well-formed", "line 21")
    c.add("no_underscore.vtu", "no '_' before the appended data", changed(raw, b"\n_", b"\n"), "'_'", "line 15")
    c.add("dataset.vtu", "unhandled dataset", changed(text, "UnstructuredGrid", "PolyData"), "PolyData", "line 2")
    c.add("order.vtu", "unknown byte order", changed(text, "LittleEndian", "PdpEndian"), "PdpEndian")
    c.add("header_type.vtu", "unknown type of lengths", changed(text, "UInt32", "UInt16"), "UInt16")
    for name in ("LZ4", "LZMA"):
        c.add(f"{name.lower()}.vtu", "compressor that is not handled",
              changed(deflated, b"vtkZLib", b"vtk" + name.encode()), f"vtk{name}DataCompressor", "zlib")
    c.add("encoding.vtu", "unknown encoding", changed(raw, b'encoding="raw"', b'encoding="hex"'), "'hex'", "line 15")
    c.add("format.vtu", "unknown format of an array", changed(text, '"ascii"', '"octal"'), "'octal'", "line 6")
    c.add("type.vtu", "unknown type of numbers", changed(text, "Float64", "Float128"), "'Float128'", "line 6")
    c.add("no_points.vtu", "no array of points", changed(text, "Points>", "Dots>").replace("</Points>", "</Dots>"),
          "no array of points", "line 4")
    c.add("components.vtu", "points of two coordinates", changed(text, 'Components="3"', 'Components="2"'), "'2'")
    c.add("no_types.vtu", "no types of cells", changed(text, '"types"', '"kinds"'), "'types'", "line 4")
    c.add("no_count.vtu", "no number of points", changed(text, ' NumberOfPoints="8"', ""), "NumberOfPoints", "line 4")
    c.add("count_word.vtu", "word instead of a count", changed(text, 'Points="8"', 'Points="8x"'), "'8x'", "line 4")
    c.add("negative_count.vtu", "negative count", changed(text, 'Points="8"', 'Points="-8"'), "is -8", "line 4")
    c.add("huge_count.vtu", "four thousand million points announced",
          changed(text, 'Points="8"', 'Points="4000000000"'), "4000000000", "line 4")
    c.add("big_count.vtu", "more points announced than the file can hold",
          changed(text, 'Points="8"', 'Points="2000000000"'), "2000000000", "line 4")
    c.add("count_high.vtu", "one point too many announced", changed(text, 'Points="8"', 'Points="9"'), "point 8",
          "array ends", "line 8")
    c.add("count_low.vtu", "one point too few announced", changed(text, 'Points="8"', 'Points="7"'), "'1.0'", "line 7")
    zeros = vtu([(0, 0, 0)] * 200000, [], "appended", deflate=1 << 20, real="B")
    piece = b'<Piece NumberOfPoints="200000" NumberOfCells="0"><Points><DataArray type="UInt8" NumberOfComponents="3" ' \
            b'format="appended" offset="0"/></Points></Piece>\n'
    c.add("shared.vtu", "many pieces of the same points, more than zlib could make of the file",
          changed(zeros, b"</UnstructuredGrid>", piece * 40 + b"</UnstructuredGrid>"), "points are announced")
    c.add("word.vtu", "word instead of a number", changed(text, "1.0 1.0 1.0", "1.0 one 1.0"), "'one'", "line 7")
    c.add("nan.vtu", "NaN coordinate", changed(text, "1.0 1.0 1.0", "1.0 nan 1.0"), "z coordinate", "point 6", "line 7")
    c.add("inf.vtu", "infinite coordinate", word(raw, first + 4 + 7 * 24, float("inf"), "<d"), "x coordinate",
          "point 7", "line 6", "'Points'")
    c.add("interrupted.vtu", "an element within the values", changed(text, "1.0 1.0 1.0", "1.0 <x/> 1.0 1.0"),
          "interrupted", "line 6")
    c.add("no_values.vtu", "array without values", changed(text, "\n10 10 10 10 10 10\n", ""), "no values", "line 17")
    c.add("index_high.vtu", "index beyond the points", changed(text, "\n0 1 3 7", "\n0 1 3 8"), "vertex 8", "cell 0",
          "line 12")
    c.add("index_binary.vtu", "index beyond the points", vtu(CUBE, [(0, 1, 3, 7), (0, 1, 3, 8)], "binary"), "vertex 8",
          "cell 1", "line 11", "'connectivity'", "byte 56")
    c.add("index_negative.vtu", "negative index", vtu(CUBE, [(0, 1, 3, -7)], "appended"), "vertex -7", "cell 0")
    c.add("index_real.vtu", "real numbers as indices", changed(text, "Int64", "Float64"), "real number")
    c.add("repeated_corner.vtu", "tetrahedron that names a vertex twice", vtu(CUBE, [(0, 1, 3, 3)]), "degenerate",
          "cell 0", "line 18")
    c.add("voxel.vtu", "unhandled cell type", changed(text, "\n10 ", "\n11 "), "type 11", "cell 0", "line 18")
    c.add("corners.vtu", "tetrahedron of three corners", changed(text, "\n4 8 ", "\n3 8 "), "3 corners", "cell 0")
    c.add("offsets.vtu", "offsets out of order", changed(text, "\n4 8 12 ", "\n4 12 8 "), "offset 2 ", "line 15")
    c.add("no_cells.vtu", "points only", vtu(CUBE, []), "no tetrahedra")
    c.add("no_piece.vtu", "no pieces", text[:text.index("<Piece")] + "</UnstructuredGrid></VTKFile>", "no tetrahedra")
    c.add("offset.vtu", "array beyond the appended data", changed(raw, b'offset="0"', b'offset="9999"'), "9999",
          "line 6")
    c.add("length.vtu", "length that does not fit the count", word(raw, first, 200), "200 bytes", "192", "line 6")
    c.add("array_cut.vtu", "array that the file cannot hold", vtu(CUBE, CUBE_TETS, "appended", announced=500),
          "192 bytes", "12000")
    c.add("base64_character.vtu", "character that is not of base64", changed(inline, "AAAA8D8A", "AAA*8D8A"), "'*'",
          "'Points'")
    c.add("base64_cut.vtu", "base64 that ends early", changed(inline, "=\n</", "\n</"), "group of four")
    c.add("base64_short.vtu", "base64 that ends early", changed(inline, "AAAA8D8A", ""), "bytes", "'Points'")
    c.add("base64_long.vtu", "base64 that goes on", changed(inline, "\n</", "AAAA\n</"), "goes on", "'Points'")
    c.add("deflated_block.vtu", "block that zlib cannot inflate", word(deflated, first_deflated + 30, 0, "<Q"),
          "block 0", "zlib")
    c.add("deflated_blocks.vtu", "far too many blocks", word(deflated, first_deflated, 0xffffffff), "4294967295 blocks")
    c.add("deflated_size.vtu", "block size that does not fit", word(deflated, first_deflated + 4, 65), "65 bytes", "192")
    c.add("deflated_length.vtu", "block longer than what it holds", word(deflated, first_deflated + 12, 0x7fffffff),
          "2147483647", "block 0")
    c.add("deflated_cut.vtu", "block longer than the file", word(deflated, first_deflated + 12, 2000), "2000 bytes")
    c.add("deflated_empty.vtu", "blocks without bytes", word(deflated, first_deflated + 4, 0), "3 blocks of 0 bytes")
    bomb = vtu([(0.0, 0.0, 0.0)] * 50000, CUBE_TETS, "appended", deflate=1 << 21)
    bomb = changed(bomb, b'Points="50000"', b'Points="8"')
    table = bomb.index(b"\n_") + 2  # one block, shorter than the size of blocks
    c.add("bomb.vtu", "deflated zeros behind a small count", bomb, "1200000", "192")
    c.add("bomb_block.vtu", "deflated zeros behind a small count and size", word(bomb, table + 8, 192), "block 0", "192")


def add_geometry(c):
    """What is read without complaint and must be refused, or repaired, when the shape is checked."""
    def bad(name, defect, content, *words):
        c.add(name, defect, content, *words, stage="prepare")

    def good(name, defect, content):
        c.accept(name, defect, content, stage="prepare")

    far = moved(CUBE, (3.0, 0.0, 0.0))
    bad("open_one_triangle.off", "one triangle missing", off(CUBE, CUBE_TRIANGLES[:-1]), "open")
    bad("open_box.off", "box without lid", off(CUBE, CUBE_TRIANGLES[2:]), "open")
    bad("single_triangle.off", "one triangle", off(CUBE[:3], [(0, 1, 2)]), "open")
    bad("mobius.off", "Moebius strip", off(*mobius_strip()), "open")
    bad("klein.off", "Klein bottle: closed but one-sided", off(*klein_bottle()), "one-sided")
    good("edge_of_four.off", "two cubes that share an edge",
         off(*welded(*joined((CUBE, CUBE_TRIANGLES), (moved(CUBE, (1.0, 1.0, 0.0)), CUBE_TRIANGLES)))))
    good("overlapping_cubes.off", "two cubes that intersect",
         off(*joined((CUBE, CUBE_TRIANGLES), (moved(CUBE, (0.5, 0.4, 0.3)), CUBE_TRIANGLES))))
    good("pierced.off", "a spike through the opposite face",
         off(CUBE + [(0.4, 0.5, -0.5)],
             CUBE_TRIANGLES[:2] + CUBE_TRIANGLES[4:] + [(4, 5, 8), (5, 7, 8), (7, 6, 8), (6, 4, 8)]))
    bad("sheet.off", "two triangles back to back: zero thickness", off(CUBE[:3], [(0, 1, 2), (0, 2, 1)]))
    bad("flat_box.off", "box of zero thickness", off([(x, y, 0.0) for x, y, _ in CUBE], CUBE_TRIANGLES))
    bad("all_equal.off", "all vertices at one point", off([(1.0, 2.0, 3.0)] * 8, CUBE_TRIANGLES), "extent")
    bad("soup.stl", "triangles without common edges",
        stl_binary(*joined(*((moved(CUBE[:3], (0.0, 0.0, float(k))), [(0, 1, 2)]) for k in range(5)))), "open")
    bad("zero_volume.msh", "tetrahedron of zero volume", msh2(CUBE, [(4, t) for t in CUBE_TETS] + [(4, (0, 1, 2, 3))]),
        "volume")
    bad("overlapping_tets.msh", "two tetrahedra on one side of their common facet",
        msh2(CUBE + [(0.2, 0.3, 0.6)], [(4, (0, 1, 2, 4)), (4, (0, 1, 2, 8))]), "tet")
    bad("facet_of_three.msh", "three tetrahedra on one facet",
        msh2(CUBE + [(0.2, 0.3, 0.6), (0.3, 0.3, -1.0)],
             [(4, (0, 1, 2, 4)), (4, (0, 1, 2, 8)), (4, (0, 2, 1, 9))]), "tets")
    bad("huge_extent.msh", "extent beyond what can be computed with",
        msh2(moved(CUBE, (0.0, 0.0, 0.0), 1e305), [(4, t) for t in CUBE_TETS]), "extent")
    bad("flat.msh", "all tetrahedra flat", msh2([(x, y, 0.0) for x, y, _ in CUBE], [(4, t) for t in CUBE_TETS]),
        "volume")

    good("inverted_tets.msh", "inverted tetrahedra: flipped",
         msh2(CUBE, [(4, (t[1], t[0], t[2], t[3])) for t in CUBE_TETS]))
    good("one_inverted.msh", "one inverted tetrahedron: flipped",
         msh2(CUBE, [(4, (CUBE_TETS[0][1], CUBE_TETS[0][0], *CUBE_TETS[0][2:]))] + [(4, t) for t in CUBE_TETS[1:]]))
    good("duplicated.msh", "vertices duplicated per tetrahedron: welded",
         msh2([CUBE[i] for t in CUBE_TETS for i in t], [(4, tuple(range(4 * k, 4 * k + 4))) for k in range(6)]))
    good("unused.msh", "vertices that no tetrahedron uses", msh2(CUBE + far, [(4, t) for t in CUBE_TETS]))
    good("inward.off", "inward orientation: turned", off(CUBE, [(a, c_, b) for a, b, c_ in CUBE_TRIANGLES]))
    good("mixed_orientation.off", "one triangle turned over: turned back",
         off(CUBE, [CUBE_TRIANGLES[0][::-1]] + CUBE_TRIANGLES[1:]))
    good("two_cubes.off", "two components", off(*joined((CUBE, CUBE_TRIANGLES), (far, CUBE_TRIANGLES))))
    good("cavity.off", "cube with a cubic cavity",
         off(*joined((CUBE, CUBE_TRIANGLES), (moved(CUBE, (0.3, 0.3, 0.3), 0.4), CUBE_TRIANGLES))))
    good("micro.off", "units of 1e-6", off(moved(CUBE, (0.0, 0.0, 0.0), 1e-6), CUBE_TRIANGLES))
    good("mega.off", "units of 1e6", off(moved(CUBE, (0.0, 0.0, 0.0), 1e6), CUBE_TRIANGLES))
    good("far_away.off", "far from the origin", off(moved(CUBE, (1e5, 1e5, 1e5)), CUBE_TRIANGLES))
    good("unwelded.off", "vertices of each triangle of its own: welded",
         off([CUBE[i] for t in CUBE_TRIANGLES for i in t], [(3 * k, 3 * k + 1, 3 * k + 2) for k in range(12)]))


def add_repairs(c):
    """Surfaces that bound no solid as they are: some can be repaired, some not, some depend."""
    def good(name, defect, mesh):
        c.accept(name + ".off", defect, off(*mesh), stage="prepare")

    def bad(name, defect, mesh, *words):
        c.add(name + ".off", defect, off(*mesh), *words, stage="prepare")

    def either(name, defect, mesh, long=False):
        c.add(name + ".off", defect, off(*mesh), stage="prepare", expect="either", long=long)

    def solid(name, defect, mesh, long=False):
        c.add(name + ".off", defect, off(*mesh), stage="prepare", expect="solid", long=long)

    ball, cube, ring = sphere(), (CUBE, CUBE_TRIANGLES), torus(1.0, 0.4)
    # Holes
    good("hole_of_one", "ball with one triangle missing at a pole", without(sphere(24), {0}))
    good("holes_of_one", "ball with five small triangles missing", without(sphere(40), {0, 9, 81, 900, 2001}))
    bad("no_cap", "ball without its upper half", (ball[0], [f for f in ball[1] if all(ball[0][i][2] <= 1e-9 for i in f)]),
        "open")
    bad("half_the_triangles", "ball with every second triangle missing", without(ball, set(range(0, 999, 2))), "open")
    good("gap_of_rounding", "two halves of a box, 1e-9 apart",
         joined((box((0, 0, 0), (1, 1, 1))[0], [f for f in CUBE_TRIANGLES if f not in CUBE_TRIANGLES[2:4]]),
                (moved(CUBE, (0.0, 0.0, 1.0 + 1e-9)), [f for f in CUBE_TRIANGLES if f not in CUBE_TRIANGLES[:2]])))
    either("slit", "two halves of a box, 1e-4 apart",
         joined((CUBE, [f for f in CUBE_TRIANGLES if f not in CUBE_TRIANGLES[2:4]]),
                (moved(CUBE, (0.0, 0.0, 1.0001)), [f for f in CUBE_TRIANGLES if f not in CUBE_TRIANGLES[:2]])))
    either("wide_slit", "two halves of a box, 0.1 apart",
           joined((CUBE, [f for f in CUBE_TRIANGLES if f not in CUBE_TRIANGLES[2:4]]),
                  (moved(CUBE, (0.0, 0.0, 1.1)), [f for f in CUBE_TRIANGLES if f not in CUBE_TRIANGLES[:2]])))
    bad("tube_without_lids", "tube open at both ends", without(prism([(cos(k), sin(k)) for k in range(6)]),
                                                             {4 * k + i for k in range(6) for i in (2, 3)}), "open")
    # Orientation
    good("some_flipped", "ball, a tenth of the triangles turned over", flipped(ball, 0.1))
    good("half_flipped", "ring, half of the triangles turned over", flipped(ring, 0.5))
    good("inside_out", "ball inside out", flipped(ball))
    good("cavity_outward", "cube with a cavity that is oriented outward", joined(cube, (moved(CUBE, (.3, .3, .3), .4), cube[1])))
    good("nested_four", "four nested boxes of any orientation",
         joined(cube, flipped(box((.1, .1, .1), (.9, .9, .9))), box((.2, .2, .2), (.8, .8, .8)),
                box((.3, .3, .3), (.7, .7, .7))))
    # Duplicates
    good("duplicated_triangles", "ball, ten triangles twice", (ball[0], ball[1] + ball[1][:10]))
    good("duplicated_turned", "ball, ten triangles twice, once turned over", (ball[0], ball[1] + [f[::-1] for f in ball[1][:10]]))
    good("duplicated_shell", "ball twice", joined(ball, ball))
    good("duplicated_shell_turned", "ball twice, once inside out", joined(ball, flipped(ball)))
    for distance in (1e-12, 1e-8, 1e-4, 1e-2):
        either(f"shell_shifted_{distance:g}", "ball twice, slightly shifted",
               joined(ball, (moved(ball[0], (distance, distance / 2, distance / 3)), ball[1])))
    good("shell_in_shell", "ball within a slightly greater one of the same orientation",
         joined(ball, (moved(ball[0], (0.0, 0.0, 0.0), 0.99), ball[1])))
    # T-junctions and slivers
    half = CUBE + [(0.5, 0.0, 0.0)]
    good("t_junction", "vertex on an edge of the neighbour",
         (half, [f for f in CUBE_TRIANGLES if f not in ((0, 1, 5), (0, 5, 4))] + [(0, 8, 4), (8, 5, 4), (8, 1, 5)]))
    for offset in (1e-9, 1e-5):
        solid(f"t_junction_{offset:g}", "vertex near an edge of the neighbour",
             (CUBE + [(0.5, -offset, -offset)],
              [f for f in CUBE_TRIANGLES if f not in ((0, 1, 5), (0, 5, 4))] + [(0, 8, 4), (8, 5, 4), (8, 1, 5)]))
    good("needle", "box with a triangle of height 1e-9",
         (CUBE + [(0.5, 0.0, 1e-9)],
          [f for f in CUBE_TRIANGLES if f not in ((0, 1, 5), (0, 5, 4))] + [(0, 1, 8), (0, 8, 4), (8, 5, 4), (8, 1, 5)]))
    good("flat_ball", "ball squeezed to a hundredth", ([(x, y, z / 100) for x, y, z in ball[0]], ball[1]))
    either("very_flat_ball", "ball squeezed to a millionth", ([(x, y, z * 1e-6) for x, y, z in ball[0]], ball[1]))
    good("thin_plate", "plate of a thousandth of its diagonal", box((0, 0, 0), (1, 1, 1.4e-3)))
    solid("thin_walled_box", "box with walls of a thousandth of its diagonal",
          joined(cube, flipped(box((2e-3, 2e-3, 2e-3), (1 - 2e-3, 1 - 2e-3, 1 - 2e-3)))), long=True)
    either("rounded", "ball whose coordinates have one decimal", ([tuple(round(x, 1) for x in v) for v in ball[0]], ball[1]))
    # Bodies that touch
    good("touch_in_vertex", "two cubes that share a corner", joined(cube, (moved(CUBE, (1.0, 1.0, 1.0)), cube[1])))
    good("touch_on_edge", "two cubes that share an edge", joined(cube, (moved(CUBE, (1.0, 1.0, 0.0)), cube[1])))
    good("touch_on_face", "two cubes that share a face", joined(cube, (moved(CUBE, (1.0, 0.0, 0.0)), cube[1])))
    good("touch_welded", "two cubes that share a face and its vertices",
         welded(*joined(cube, (moved(CUBE, (1.0, 0.0, 0.0)), cube[1]))))
    good("touch_partly", "a small cube on a large one", joined(cube, (moved(CUBE, (0.25, 0.25, 1.0), 0.5), cube[1])))
    good("touch_inside", "a cavity with a wall of no thickness", joined(cube, flipped((moved(CUBE, (0.25, 0.25, 0.5), 0.5), cube[1]))))
    good("edge_ring", "four cubes in a ring that share edges",
         joined(*[(moved(CUBE, (float(x), float(y), 0.0)), cube[1]) for x, y in ((1, 0), (0, 1), (2, 1), (1, 2))]))
    good("vertex_on_face", "a pyramid whose tip touches a face",
         joined(cube, ([(0.5, 0.5, 1.0), (0.2, 0.2, 2.0), (0.8, 0.2, 2.0), (0.5, 0.8, 2.0)],
                       [(0, 2, 1), (0, 3, 2), (0, 1, 3), (1, 2, 3)])))
    # Overlaps
    good("overlap_coplanar", "two boxes that overlap with faces in one plane", joined(cube, box((0.5, 0, 0), (1.5, 1, 1))))
    good("overlap_coplanar_rotated", "a box on a prism, coplanar lids",
         joined(box((-.5, -.5, 0), (.5, .5, 1)), prism([(.7 * cos(k * pi / 3), .7 * sin(k * pi / 3)) for k in range(6)])))
    solid("three_beams", "three beams that cross",
          joined(box((-2, -.3, -.3), (2, .3, .3)), box((-.3, -2, -.3), (.3, 2, .3)), box((-.3, -.3, -2), (.3, .3, 2))))
    good("two_balls", "two balls that overlap", joined(ball, (moved(ball[0], (1.0, 0.1, 0.05)), ball[1])))
    good("ball_through_ring", "ball and ring that overlap", joined(ring, (moved(ball[0], (1.0, 0.0, 0.0), 0.5), ball[1])))
    good("overlap_micro", "two boxes that overlap, units of 1e-6",
         joined((moved(CUBE, (0, 0, 0), 1e-6), cube[1]), (moved(CUBE, (4e-7, 3e-7, 2e-7), 1e-6), cube[1])))
    good("overlap_mega", "two boxes that overlap, units of 1e6",
         joined((moved(CUBE, (0, 0, 0), 1e6), cube[1]), (moved(CUBE, (4e5, 3e5, 2e5), 1e6), cube[1])))
    good("overlap_far", "two boxes that overlap, far from the origin",
         joined((moved(CUBE, (1e5, 2e5, 3e5)), cube[1]), (moved(CUBE, (1e5 + .4, 2e5 + .3, 3e5 + .2)), cube[1])))
    good("cavity_reaches_out", "cavity that cuts the outer surface",
         joined(cube, flipped((moved(CUBE, (0.5, 0.4, 0.3)), cube[1]))))
    bad("body_in_nothing", "box minus a larger box: nothing is left",
        (CUBE[:3], [(0, 1, 2), (0, 2, 1), (0, 1, 2)]))
    good("inner_wall", "box with a wall inside", (CUBE, CUBE_TRIANGLES + [(0, 3, 7), (0, 7, 4)]))
    good("inner_triangle", "box with a triangle floating inside",
         joined(cube, ([(.3, .3, .3), (.6, .3, .4), (.3, .6, .5)], [(0, 1, 2)])))
    either("outer_triangle", "box with a triangle floating outside",
           joined(cube, ([(2.3, .3, .3), (2.6, .3, .4), (2.3, .6, .5)], [(0, 1, 2)])))
    either("fin", "box with a fin of no thickness", (CUBE + [(0.5, 0.5, 2.0)], CUBE_TRIANGLES + [(4, 7, 8), (4, 8, 7)]))
    # Surfaces that cut themselves
    either("spindle", "ring that is thicker than its hole", torus(0.5, 0.8), long=True)
    good("star", "extruded pentagram", prism([(cos(4 * pi * k / 5), sin(4 * pi * k / 5)) for k in range(5)]))
    either("bow_tie", "extruded figure of eight", prism([(-1.0, -1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, 1.0)]))
    either("twisted", "box whose lid is turned half round", (CUBE[:4] + CUBE[:3:-1], CUBE_TRIANGLES))
    solid("shaken_0.05", "ball, vertices moved at random", shaken(ball, 0.05), long=True)
    either("shaken_0.2", "ball, vertices moved at random", shaken(ball, 0.2), long=True)
    solid("shaken_ring", "ring, vertices moved at random", shaken(ring, 0.15), long=True)
    # One-sided surfaces
    bad("klein_fine", "Klein bottle of many facets", klein_bottle(16), "one-sided")
    bad("klein_and_cube", "Klein bottle beside a cube", joined(cube, (moved(klein_bottle()[0], (9, 0, 0)), klein_bottle()[1])),
        "one-sided")
    bad("mobius_fine", "Moebius strip of many facets", mobius_strip(40), "open")
    bad("projective_plane", "projective plane of six vertices",
        ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 2, 3), (3, 1, 2)],
         [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5), (0, 5, 1), (1, 2, 4), (2, 3, 5), (3, 4, 1), (4, 5, 2), (5, 1, 3)]),
        "one-sided")
    # Nothing inside
    bad("folded_sheet", "two sheets on each other", joined((CUBE[:4], CUBE_TRIANGLES[:2]), (CUBE[:4], [f[::-1] for f in CUBE_TRIANGLES[:2]])))
    bad("line", "all vertices on a line", ([(x, 2 * x, 4 * x) for x, _, _ in cube[0]], cube[1]), "zero area")
    either("nearly_line", "all vertices on a line but for rounding", ([(x, 2 * x, 3 * x) for x, _, _ in ball[0]], ball[1]),
           long=True)


def add_cad(c):
    empty = "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n" \
            "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n"
    for name, defect, content in (("empty.step", "empty file", ""), ("noise.step", "bytes without meaning", bytes(range(256))),
                                  ("nothing.stp", "STEP without shapes", empty), ("cut.step", "ends in the header", empty[:60]),
                                  ("stl_named.step", "STL named STEP", stl_text(CUBE, CUBE_TRIANGLES)),
                                  ("noise.brep", "bytes without meaning", bytes(range(255, -1, -1))),
                                  ("header.brep", "only the first line", "DBRep_DrawableShape\n\nCASCADE Topology V1\n")):
        c.add("cad_" + name, defect, content, "empty" if not content else "CAD file", stage="cad")


def write_bad_files(folder):
    c = Collection(folder)
    for add in (add_repairs, add_cad, add_general, add_off, add_obj, add_ply, add_stl, add_msh, add_medit_and_vtk, add_vtu, add_geometry):
        add(c)
    names = [entry["file"] for entry in c.manifest]
    assert len(names) == len(set(names)), "two entries share a file name"
    (folder / "manifest.json").write_text(json.dumps(c.manifest, indent=1) + "\n")


def write_seeds(folder):
    tets = [(4, t) for t in CUBE_TETS]
    seeds = {
        "off": [off(CUBE, CUBE_TRIANGLES), off(CUBE, CUBE_QUADS).replace("OFF", "COFF # comment")],
        "obj": [obj(CUBE, CUBE_TRIANGLES), "v 0 0 0\nv 1 0 0\nv 0 1 0 1 0 0\nvt 0 0\nf -3/1 -2//1 -1/1/1\n"],
        "ply": [ply(CUBE, CUBE_TRIANGLES, kind) for kind in ("ascii", "binary_little_endian", "binary_big_endian")],
        "stl": [stl_text(CUBE, CUBE_TRIANGLES), stl_binary(CUBE, CUBE_TRIANGLES)],
        "msh": [msh2(CUBE, tets), msh2(CUBE, [(15, (0,)), (2, (0, 1, 2)), (3, (0, 1, 3, 2))]),
                msh2_binary(CUBE, CUBE_TETS), msh2_binary(CUBE, CUBE_TETS, ">"), msh4(CUBE, CUBE_TETS),
                msh4_binary(CUBE, CUBE_TETS)],
        "medit": [medit(CUBE, CUBE_TETS)],
        "vtk": [vtk(CUBE, CUBE_TETS), vtk_binary(CUBE, CUBE_TETS), vtk_offsets(CUBE, CUBE_TETS)],
        "vtu": [*vtu_flavours(), vtu(CUBE, CUBE_TETS, pieces=2)],
        "ma": [medial()],
    }
    for kind, contents in seeds.items():
        (folder / kind).mkdir(parents=True, exist_ok=True)
        for i, content in enumerate(contents):
            data = content.encode() if isinstance(content, str) else content
            (folder / kind / f"seed{i}").write_bytes(data)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seeds", action="store_true", help="write valid files for the fuzzers instead")
    arguments = parser.parse_args()
    (write_seeds if arguments.seeds else write_bad_files)(arguments.folder)


if __name__ == "__main__":
    main()
