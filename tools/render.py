#!/usr/bin/env python3
"""Draw a medial mesh (.ma) to a PNG file, for a look at a result where there is no display.

Faces are coloured by orientation or radius and shaded by a light at the eye. Edges by what they are: feature edges
(between spheres on sharp lines) green, seams (three or more faces) red, free borders (one face) blue, curves (no face)
orange, all others thin grey. Dots: junction spheres dark blue, corners black. The surface, if given, is a faint shell.

    tools/render.py out/bracket.ma --surface data/bracket.stl -o bracket.png --view 30,20 --view top

Orthographic; a depth buffer in numpy. Needs python3 and numpy (Debian: python3-numpy).
"""
import argparse
import struct
import sys
import zlib
from dataclasses import dataclass

import numpy as np

VIEWS = {"front": (0, 0), "right": (90, 0), "back": (180, 0), "left": (-90, 0), "top": (0, 90), "bottom": (0, -90),
         "iso": (35, 30)}
BACKGROUND = np.array([1.0, 1.0, 1.0])
FEATURE, SEAM, BORDER, CURVE, INNER = range(5)
EDGE_COLORS = np.array([[0.0, 0.55, 0.2], [0.85, 0.1, 0.1], [0.1, 0.3, 0.9], [1.0, 0.55, 0.0], [0.35, 0.35, 0.35]])
EDGE_WIDTHS = (3, 3, 3, 3, 1)
JUNCTION, SHARP_EDGE, CORNER = 2, 3, 4  # sphere types of the .ma format
DOT_COLORS = {JUNCTION: (0.05, 0.05, 0.5), CORNER: (0.0, 0.0, 0.0)}
MAX_FRAGMENTS = 1 << 22  # pixels rasterised at a time: bounds the memory


# ---------------------------------------------------------------- readers

@dataclass
class MedialMesh:
    centers: np.ndarray  # #V x 3
    radii: np.ndarray    # #V
    types: np.ndarray    # #V
    edges: np.ndarray    # #E x 2
    faces: np.ndarray    # #F x 3


def read_ma(path):
    with open(path) as file:
        lines = [line.split() for line in file if line.strip() and not line.startswith("#")]
    rows = {"v": [], "e": [], "f": []}
    for words in lines[1:]:
        rows[words[0]].append(words[1:])
    vertices = np.array([row[:4] for row in rows["v"]], float).reshape(-1, 4)
    types = np.array([int(row[4]) if len(row) > 4 else 0 for row in rows["v"]], int)
    edges = np.array([row[:2] for row in rows["e"]], int).reshape(-1, 2)
    faces = np.array([row[:3] for row in rows["f"]], int).reshape(-1, 3)
    return MedialMesh(vertices[:, :3], vertices[:, 3], types, edges, faces)


def fan(polygons):
    return np.array([(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)], int).reshape(-1, 3)


def read_stl(data):
    if len(data) >= 84 and len(data) == 84 + 50 * struct.unpack_from("<I", data, 80)[0]:
        records = np.frombuffer(data, np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]), offset=84)
        points = records["v"].reshape(-1, 3).astype(float)
    else:
        words = data.decode("latin-1").split("vertex")[1:]
        points = np.array([word.split()[:3] for word in words], float).reshape(-1, 3)
    return points, np.arange(len(points)).reshape(-1, 3)


def read_obj(data):
    points, polygons = [], []
    for line in data.decode("latin-1").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(w) for w in words[1:4]])
        elif words[:1] == ["f"]:
            ids = [int(w.split("/")[0]) for w in words[1:]]
            polygons.append([i - 1 if i > 0 else len(points) + i for i in ids])
    return np.array(points, float), fan(polygons)


def read_off(data):
    words = " ".join(line.split("#")[0] for line in data.decode("latin-1").splitlines()).split()
    vertices, faces = int(words[1]), int(words[2])
    points = np.array(words[4:4 + 3 * vertices], float).reshape(-1, 3)
    polygons, at = [], 4 + 3 * vertices
    for _ in range(faces):
        size = int(words[at])
        polygons.append([int(w) for w in words[at + 1:at + 1 + size]])
        at += 1 + size
    return points, fan(polygons)


PLY_TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4",
             "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
             "float32": "f4", "float64": "f8"}


def read_ply(data):
    header, body = data.split(b"end_header", 1)
    body = body[body.index(b"\n") + 1:]
    lines = [line.split() for line in header.decode("latin-1").splitlines()]
    order = next(words[1] for words in lines if words[0] == "format")
    take = ply_text_taker(body) if order == "ascii" else ply_binary_taker(body, "<" if "little" in order else ">")
    elements = []
    for words in lines:
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property":
            elements[-1][2].append(words[1:])
    points, polygons = [], []
    for name, count, properties in elements:
        for _ in range(count):
            row = {p[-1]: [take(p[2]) for _ in range(int(take(p[1])))] if p[0] == "list" else take(p[0])
                   for p in properties}
            if name == "vertex":
                points.append([row["x"], row["y"], row["z"]])
            elif name == "face":
                polygons.append([int(i) for i in next(v for v in row.values() if isinstance(v, list))])
    return np.array(points, float), fan(polygons)


def ply_text_taker(body):
    words = iter(body.split())
    return lambda _: float(next(words))


def ply_binary_taker(body, order):
    at = 0

    def take(kind):
        nonlocal at
        code = np.dtype(order + PLY_TYPES[kind])
        at += code.itemsize
        return np.frombuffer(body, code, 1, at - code.itemsize)[0]
    return take


READERS = {"stl": read_stl, "obj": read_obj, "off": read_off, "ply": read_ply}


def read_surface(path):
    extension = path.rsplit(".", 1)[-1].lower()
    if extension not in READERS:
        sys.exit(f"{path}: only {', '.join(READERS)} surfaces can be drawn")
    with open(path, "rb") as file:
        return READERS[extension](file.read())


# ---------------------------------------------------------------- rasteriser

class Canvas:
    """A colour and a depth buffer. Points are (x, y, depth) in pixels; the smaller depth is nearer to the eye."""

    def __init__(self, width, height):
        self.shape = (height, width)
        self.depth = np.full(width * height, np.inf)
        self.color = np.tile(BACKGROUND, (width * height, 1))

    def put(self, x, y, depth, color):
        """Writes pixels where they are nearer than what is there."""
        height, width = self.shape
        inside = (x >= 0) & (x < width) & (y >= 0) & (y < height)
        pixel, depth, color = (y * width + x)[inside], depth[inside], color[inside]
        nearer = depth < self.depth[pixel]
        pixel, depth, color = pixel[nearer], depth[nearer], color[nearer]
        order = np.argsort(-depth, kind="stable")  # of equal pixels the last write, the nearest, stays
        self.depth[pixel[order]] = depth[order]
        self.color[pixel[order]] = color[order]

    def triangles(self, corners, colors):
        """corners: #T x 3 x 3, colors: #T x 3."""
        low = np.ceil(corners[:, :, :2].min(1) - 0.5).astype(int).clip(0)
        high = np.floor(corners[:, :, :2].max(1) - 0.5).astype(int).clip(None, np.array(self.shape[::-1]) - 1)
        spans = (high - low + 1).clip(0)
        sizes = spans.prod(1)
        begin = 0
        while begin < len(corners):
            end = begin + max(1, int(np.searchsorted(np.cumsum(sizes[begin:]), MAX_FRAGMENTS)))
            self._fill(corners[begin:end], colors[begin:end], low[begin:end], spans[begin:end], sizes[begin:end])
            begin = end

    def _fill(self, corners, colors, low, spans, sizes):
        owner = np.repeat(np.arange(len(corners)), sizes)
        offset = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)
        x = low[owner, 0] + offset % spans[owner, 0].clip(1)
        y = low[owner, 1] + offset // spans[owner, 0].clip(1)
        a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
        area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
        scale = np.divide(1.0, area, out=np.zeros_like(area), where=area != 0)[owner]
        px, py = x + 0.5, y + 0.5

        def weight(p, q):
            p, q = p[owner], q[owner]
            return ((q[:, 0] - p[:, 0]) * (py - p[:, 1]) - (q[:, 1] - p[:, 1]) * (px - p[:, 0])) * scale
        wa, wb = weight(b, c), weight(c, a)
        wc = 1 - wa - wb
        covered = (wa >= 0) & (wb >= 0) & (wc >= 0) & (scale != 0)
        depth = wa * a[owner, 2] + wb * b[owner, 2] + wc * c[owner, 2]
        self.put(x[covered], y[covered], depth[covered], colors[owner[covered]])

    def lines(self, begin, end, colors, width, lift):
        """begin, end: #L x 3; `lift` moves lines towards the eye so that their own faces do not hide them."""
        if len(begin) == 0:
            return
        steps = np.ceil(np.abs(end - begin)[:, :2].max(1)).astype(int) + 1
        owner = np.repeat(np.arange(len(begin)), steps)
        t = (np.arange(steps.sum()) - np.repeat(np.cumsum(steps) - steps, steps)) / (steps - 1).clip(1)[owner]
        self.dots(begin[owner] + (end - begin)[owner] * t[:, None], colors[owner], width, lift)

    def dots(self, points, colors, width, lift):
        half = (width - 1) / 2
        for dx in range(width):
            for dy in range(width):
                x = np.floor(points[:, 0] + dx - half).astype(int)
                y = np.floor(points[:, 1] + dy - half).astype(int)
                self.put(x, y, points[:, 2] - lift, colors)

    def image(self):
        return self.color.reshape(*self.shape, 3)


# ---------------------------------------------------------------- drawing

def rotation(azimuth, elevation):
    """Rows: right, down and away from the eye, for z-up models; azimuth 0 looks along +y."""
    a, e = np.radians([azimuth, elevation])
    right = np.array([np.cos(a), np.sin(a), 0])
    away = np.array([-np.sin(a) * np.cos(e), np.cos(a) * np.cos(e), -np.sin(e)])
    return np.array([right, np.cross(away, right), away])


def unit_normals(points, triangles):
    corners = points[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return normals / np.linalg.norm(normals, axis=1, keepdims=True).clip(1e-300)


def face_colors(mesh, normals, away, by_radius):
    if by_radius:
        top = mesh.radii.max(initial=0) or 1.0
        t = (mesh.radii[mesh.faces].mean(1) / top)[:, None]
        base = (1 - t) * np.array([0.15, 0.25, 0.8]) + t * np.array([1.0, 0.85, 0.2])
    else:
        base = 0.45 + 0.5 * np.abs(normals)
    return base * (0.45 + 0.55 * np.abs(normals @ away))[:, None]


def edge_classes(mesh):
    """The class of every edge, by its spheres' types and the number of its faces."""
    if len(mesh.edges) == 0:
        return np.zeros(0, int)
    key = lambda ends: np.sort(ends, axis=1) @ np.array([len(mesh.centers), 1])
    sides = np.concatenate([key(mesh.faces[:, pair]) for pair in ([0, 1], [1, 2], [0, 2])])
    ids, counts = np.unique(sides, return_counts=True)
    keys = key(mesh.edges)
    at = np.searchsorted(ids, keys).clip(0, max(len(ids) - 1, 0))
    uses = np.where(ids[at] == keys, counts[at], 0) if len(ids) else np.zeros(len(keys), int)
    classes = np.select([uses == 0, uses == 1, uses == 2], [CURVE, BORDER, INNER], SEAM)
    classes[(mesh.types[mesh.edges] >= SHARP_EDGE).all(1)] = FEATURE
    return classes


def draw_shell(image, points, triangles, away, screen):
    """Blends the front of the surface over the image: almost clear where it faces the eye, grey at the silhouette."""
    height, width, _ = image.shape
    shell = Canvas(width, height)
    facing = np.abs(unit_normals(points, triangles) @ away)
    strength = 0.04 + 0.4 * (1 - facing) ** 3
    shell.triangles(screen(points)[triangles], np.repeat(strength[:, None], 3, axis=1))
    alpha = np.where(np.isfinite(shell.depth)[:, None], shell.color, 0).reshape(height, width, 3)
    return image * (1 - alpha) + alpha * 0.35


def draw(mesh, surface, view, args):
    axes = rotation(*view)
    framed = surface[0] if surface else mesh.centers
    bounds = np.array([(framed @ axes.T).min(0), (framed @ axes.T).max(0)])
    size = args.size * 2  # drawn at twice the size, then averaged
    zoom = 0.92 * size / max((bounds[1] - bounds[0])[:2].max(), 1e-300)
    middle = bounds.mean(0)
    screen = lambda points: (points @ axes.T - middle) * zoom + np.array([size / 2, size / 2, 0])

    canvas = Canvas(size, size)
    spheres, lift = screen(mesh.centers), 0.004 * size
    normals = unit_normals(mesh.centers, mesh.faces)
    canvas.triangles(spheres[mesh.faces], face_colors(mesh, normals, axes[2], args.color == "radius"))
    classes = edge_classes(mesh)
    drawn = {"all": (INNER, BORDER, CURVE, SEAM, FEATURE), "features": (BORDER, CURVE, SEAM, FEATURE), "none": ()}
    for kind in drawn[args.edges]:
        begin, end = (spheres[mesh.edges[classes == kind, k]] for k in (0, 1))
        canvas.lines(begin, end, np.tile(EDGE_COLORS[kind], (len(begin), 1)), EDGE_WIDTHS[kind], lift)
    for kind, color in DOT_COLORS.items():
        dots = spheres[mesh.types == kind]
        canvas.dots(dots, np.tile(color, (len(dots), 1)), 7, 2 * lift)
    image = canvas.image()
    if surface:
        image = draw_shell(image, *surface, axes[2], screen)
    return image.reshape(args.size, 2, args.size, 2, 3).mean((1, 3))


def write_png(path, image):
    pixels = (image.clip(0, 1) * 255 + 0.5).astype(np.uint8)
    height, width, _ = pixels.shape
    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, -1)], axis=1)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)) + chunk(b"IEND", b""))


def view_angles(text):
    if text in VIEWS:
        return VIEWS[text]
    azimuth, elevation = text.split(",")
    return float(azimuth), float(elevation)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh", help="medial mesh, .ma")
    parser.add_argument("-o", "--output", required=True, help="the PNG file")
    parser.add_argument("--surface", help=f"draw this surface as a faint shell: {', '.join(READERS)}")
    parser.add_argument("--view", action="append", type=view_angles, metavar="VIEW",
                        help=f"azimuth,elevation in degrees or one of {', '.join(VIEWS)}; may be repeated (default iso)")
    parser.add_argument("--size", type=int, default=800, help="pixels of a view's side (default 800)")
    parser.add_argument("--color", choices=("orientation", "radius"), default="orientation")
    parser.add_argument("--edges", choices=("all", "features", "none"), default="all")
    args = parser.parse_args()
    mesh = read_ma(args.mesh)
    if len(mesh.centers) == 0:
        sys.exit(f"{args.mesh}: no spheres to draw")
    surface = read_surface(args.surface) if args.surface else None
    views = args.view or [VIEWS["iso"]]
    write_png(args.output, np.concatenate([draw(mesh, surface, view, args) for view in views], axis=1))


if __name__ == "__main__":
    main()
