"""Writers of small models in every format, flavour by flavour, for make_bad_files.py. Python's standard library only."""
import base64
import itertools
import struct
import zlib

CUBE = [(float(x), float(y), float(z)) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
CUBE_QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
CUBE_TRIANGLES = [t for a, b, c, d in CUBE_QUADS for t in ((a, b, c), (a, c, d))]
CUBE_TETS = [(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)]


def numbers(values):
    return " ".join(repr(v) for v in values)


def off(vertices, faces):
    lines = ["OFF", f"{len(vertices)} {len(faces)} 0"]
    lines += [numbers(v) for v in vertices] + [numbers((len(f), *f)) for f in faces]
    return "\n".join(lines) + "\n"


def obj(vertices, faces):
    lines = ["# a model"] + ["v " + numbers(v) for v in vertices] + ["f " + numbers(i + 1 for i in f) for f in faces]
    return "\n".join(lines) + "\n"


def ply(vertices, faces, kind="ascii", extra=""):
    header = (f"ply\nformat {kind} 1.0\ncomment a model\nelement vertex {len(vertices)}\n"
              "property float x\nproperty float y\nproperty float z\n"
              f"element face {len(faces)}\nproperty list uchar int vertex_indices\n{extra}end_header\n")
    if kind == "ascii":
        return header + "".join(numbers(v) + "\n" for v in vertices) + "".join(
            numbers((len(f), *f)) + "\n" for f in faces)
    order = "<" if kind == "binary_little_endian" else ">"
    body = b"".join(struct.pack(order + "3f", *v) for v in vertices)
    body += b"".join(struct.pack(f"{order}B{len(f)}i", len(f), *f) for f in faces)
    return header.encode() + body


def stl_text(vertices, triangles, end="endsolid cube\n"):
    text = "solid cube\n"
    for t in triangles:
        corners = "".join(f"      vertex {numbers(vertices[i])}\n" for i in t)
        text += f"  facet normal 0 0 0\n    outer loop\n{corners}    endloop\n  endfacet\n"
    return text + end


def stl_binary(vertices, triangles, announced=None, header=b"a model"):
    count = len(triangles) if announced is None else announced
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *vertices[a], *vertices[b], *vertices[c], 0) for a, b, c in triangles)
    return header.ljust(80, b"\0") + struct.pack("<I", count) + body


def msh2(vertices, elements):
    """`elements`: (Gmsh type, corners from 0)."""
    text = f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(vertices)}\n"
    text += "".join(f"{i} {numbers(v)}\n" for i, v in enumerate(vertices, 1))
    text += f"$EndNodes\n$Elements\n{len(elements)}\n"
    text += "".join(f"{i} {kind} 2 1 1 {numbers(c + 1 for c in corners)}\n"
                    for i, (kind, corners) in enumerate(elements, 1))
    return text + "$EndElements\n"


def msh2_binary(vertices, tets, order="<"):
    data = b"$MeshFormat\n2.2 1 8\n" + struct.pack(order + "i", 1) + b"\n$EndMeshFormat\n"
    data += b"$Nodes\n%d\n" % len(vertices)
    data += b"".join(struct.pack(order + "i3d", i, *v) for i, v in enumerate(vertices, 1))
    data += b"\n$EndNodes\n$Elements\n%d\n" % len(tets) + struct.pack(order + "3i", 4, len(tets), 2)
    data += b"".join(struct.pack(order + "7i", i, 1, 1, *(c + 1 for c in t)) for i, t in enumerate(tets, 1))
    return data + b"\n$EndElements\n"


def msh4(vertices, tets):
    n, m = len(vertices), len(tets)
    text = f"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 {n} 1 {n}\n3 1 0 {n}\n"
    text += "".join(f"{i}\n" for i in range(1, n + 1)) + "".join(numbers(v) + "\n" for v in vertices)
    text += f"$EndNodes\n$Elements\n1 {m} 1 {m}\n3 1 4 {m}\n"
    return text + "".join(f"{i} {numbers(c + 1 for c in t)}\n" for i, t in enumerate(tets, 1)) + "$EndElements\n"


def msh4_binary(vertices, tets, order="<"):
    n, m = len(vertices), len(tets)
    data = b"$MeshFormat\n4.1 1 8\n" + struct.pack(order + "i", 1) + b"\n$EndMeshFormat\n$Nodes\n"
    data += struct.pack(order + "4Q3iQ", 1, n, 1, n, 3, 1, 0, n) + struct.pack(f"{order}{n}Q", *range(1, n + 1))
    data += b"".join(struct.pack(order + "3d", *v) for v in vertices) + b"\n$EndNodes\n$Elements\n"
    data += struct.pack(order + "4Q3iQ", 1, m, 1, m, 3, 1, 4, m)
    data += b"".join(struct.pack(order + "5Q", i, *(c + 1 for c in t)) for i, t in enumerate(tets, 1))
    return data + b"\n$EndElements\n"


def medit(vertices, tets):
    text = f"MeshVersionFormatted 2\nDimension 3\nVertices\n{len(vertices)}\n"
    text += "".join(f"{numbers(v)} 0\n" for v in vertices) + f"Tetrahedra\n{len(tets)}\n"
    return text + "".join(f"{numbers(c + 1 for c in t)} 0\n" for t in tets) + "End\n"


def vtk(vertices, tets):
    text = f"# vtk DataFile Version 3.0\na model\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {len(vertices)} double\n"
    text += "".join(numbers(v) + "\n" for v in vertices) + f"CELLS {len(tets)} {5 * len(tets)}\n"
    return text + "".join(f"4 {numbers(t)}\n" for t in tets) + f"CELL_TYPES {len(tets)}\n" + "10\n" * len(tets)


def vtk_binary(vertices, tets):
    data = b"# vtk DataFile Version 3.0\na model\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS %d double\n" % len(vertices)
    data += b"".join(struct.pack(">3d", *v) for v in vertices) + b"\nCELLS %d %d\n" % (len(tets), 5 * len(tets))
    data += b"".join(struct.pack(">5i", 4, *t) for t in tets) + b"\nCELL_TYPES %d\n" % len(tets)
    return data + struct.pack(f">{len(tets)}i", *[10] * len(tets)) + b"\n"


def vtk_offsets(vertices, tets):
    data = b"# vtk DataFile Version 5.1\na model\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS %d float\n" % len(vertices)
    data += b"".join(struct.pack(">3f", *v) for v in vertices) + b"\nMETADATA\nINFORMATION 0\n\n"
    data += b"CELLS %d %d\nOFFSETS vtktypeint64\n" % (len(tets) + 1, 4 * len(tets))
    data += struct.pack(f">{len(tets) + 1}q", *range(0, 4 * len(tets) + 1, 4)) + b"\nCONNECTIVITY vtktypeint64\n"
    data += b"".join(struct.pack(">4q", *t) for t in tets) + b"\nCELL_TYPES %d\n" % len(tets)
    return data + struct.pack(f">{len(tets)}i", *[10] * len(tets)) + b"\n"


def vtu(vertices, tets, form="ascii", order="<", words="I", deflate=0, real="d", whole="q", encoding="raw", pieces=1,
        announced=None):
    """VTK XML unstructured grid. `form`: of the arrays; `words`: type of lengths; `deflate`: bytes in a block, 0 for no
    compression; `encoding`: of appended data; each of the `pieces` has all points and its share of the tetrahedra."""
    names = {"f": "Float32", "d": "Float64", "i": "Int32", "q": "Int64", "B": "UInt8", "I": "UInt32", "Q": "UInt64"}
    appended = b""

    def stored(data, in_text):
        code = base64.b64encode if in_text else bytes
        if not deflate:
            return code(struct.pack(order + words, len(data)) + data)
        blocks = [data[k:k + deflate] for k in range(0, len(data), deflate)]
        packed = [zlib.compress(block) for block in blocks]
        head = (len(blocks), deflate, len(data) % deflate, *map(len, packed))
        return code(struct.pack(f"{order}{len(head)}{words}", *head)) + code(b"".join(packed))

    def array(name, kind, values, components=""):
        nonlocal appended
        start = f'<DataArray type="{names[kind]}" Name="{name}"{components} format="{form}"'.encode()
        if form == "ascii":
            return start + b">\n" + numbers(values).encode() + b"\n</DataArray>\n"
        data = struct.pack(f"{order}{len(values)}{kind}", *values)
        if form == "binary":
            return start + b">\n" + stored(data, True) + b"\n</DataArray>\n"
        offset = len(appended)
        appended += stored(data, encoding == "base64")
        return start + b' offset="%d"/>\n' % offset

    text = b'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0"'
    text += f' byte_order="{"Little" if order == "<" else "Big"}Endian" header_type="{names[words]}"'.encode()
    text += (b' compressor="vtkZLibDataCompressor"' if deflate else b"") + b">\n<UnstructuredGrid>\n"
    for p in range(pieces):
        part = tets[p * len(tets) // pieces:(p + 1) * len(tets) // pieces]
        text += b'<Piece NumberOfPoints="%d" NumberOfCells="%d">\n<Points>\n' % (announced or len(vertices), len(part))
        text += array("Points", real, [x for v in vertices for x in v], ' NumberOfComponents="3"')
        text += b"</Points>\n<Cells>\n" + array("connectivity", whole, [i for t in part for i in t])
        text += array("offsets", whole, [4 * (k + 1) for k in range(len(part))])
        text += array("types", "B", [10] * len(part)) + b"</Cells>\n</Piece>\n"
    text += b"</UnstructuredGrid>\n"
    if form == "appended":
        text += b'<AppendedData encoding="%s">\n_' % encoding.encode() + appended + b"\n</AppendedData>\n"
    return text + b"</VTKFile>\n"


def vtu_flavours():
    """The cube in every way of storing it; blocks of 40 bytes leave a shorter one at the end, 64 do not."""
    kinds = itertools.product("<>", (("I", "f", "i"), ("Q", "d", "q")), (0, 40, 64),
                              (("binary", ""), ("appended", "raw"), ("appended", "base64")))
    return [vtu(CUBE, CUBE_TETS)] + [vtu(CUBE, CUBE_TETS, form, order, words, deflate, real, whole, encoding)
                                     for order, (words, real, whole), deflate, (form, encoding) in kinds]


def medial():
    return "3 3 1\nv 0 0 0 1 0\nv 1 0 0 1 1\nv 0 1 0 0.5 2\ne 0 1\ne 0 2\ne 1 2\nf 0 1 2\n"
