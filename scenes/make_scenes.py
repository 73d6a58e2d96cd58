#!/usr/bin/env python3
"""Writes every glTF file and radiation diagram in this folder, byte for byte the same each time. Needs nothing but Python 3."""

import base64
import json
import math
import struct
from pathlib import Path

HERE = Path(__file__).resolve().parent
SPEED_OF_LIGHT = 299792458.0

ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
UNSIGNED_SHORT, FLOAT = 5123, 5126


class Gltf:
    """A scene under construction: one buffer that all meshes share, one node an object."""

    def __init__(self):
        self.data = b""
        self.json = {
            "asset": {"version": "2.0", "generator": "pmdsim scenes/make_scenes.py"},
            "scene": 0,
            "scenes": [{"nodes": []}],
            "nodes": [],
        }

    def _append(self, name, value):
        self.json.setdefault(name, []).append(value)
        return len(self.json[name]) - 1

    def _accessor(self, data, target, **accessor):
        self.data += b"\0" * (-len(self.data) % 4)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        if target is not None:
            view["target"] = target
        self.data += data
        return self._append("accessors", {"bufferView": self._append("bufferViews", view), **accessor})

    def node(self, node):
        index = self._append("nodes", node)
        self.json["scenes"][0]["nodes"].append(index)
        return index

    def material(self, name, reflectivity):
        return self._append("materials", {"name": name, "extras": {"pmdsim_reflectivity": reflectivity}})

    def mesh(self, positions, indices, material):
        floats = [struct.unpack("<3f", struct.pack("<3f", *p)) for p in positions]
        position = self._accessor(
            b"".join(struct.pack("<3f", *p) for p in floats),
            ARRAY_BUFFER,
            componentType=FLOAT,
            count=len(floats),
            type="VEC3",
            min=[min(p[axis] for p in floats) for axis in range(3)],
            max=[max(p[axis] for p in floats) for axis in range(3)],
        )
        index = self._accessor(
            struct.pack(f"<{len(indices)}H", *indices),
            ELEMENT_ARRAY_BUFFER,
            componentType=UNSIGNED_SHORT,
            count=len(indices),
            type="SCALAR",
        )
        primitive = {"attributes": {"POSITION": position}, "indices": index, "material": material}
        return self._append("meshes", {"primitives": [primitive]})

    def animation(self, node, path, times_s, values):
        """Linear between keys."""
        keys = self._accessor(
            struct.pack(f"<{len(times_s)}f", *times_s),
            None,
            componentType=FLOAT,
            count=len(times_s),
            type="SCALAR",
            min=[min(times_s)],
            max=[max(times_s)],
        )
        numbers = [number for value in values for number in value]
        output = self._accessor(
            struct.pack(f"<{len(numbers)}f", *numbers),
            None,
            componentType=FLOAT,
            count=len(values),
            type={3: "VEC3", 4: "VEC4"}[len(values[0])],
        )
        self._append(
            "animations",
            {
                "samplers": [{"input": keys, "output": output, "interpolation": "LINEAR"}],
                "channels": [{"sampler": 0, "target": {"node": node, "path": path}}],
            },
        )

    def write_gltf(self, name):
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        self.json["buffers"] = [{"byteLength": len(self.data), "uri": uri}]
        (HERE / name).write_text(json.dumps(self.json, indent=1) + "\n")

    def write_glb(self, name):
        self.json["buffers"] = [{"byteLength": len(self.data)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        data = self.data + b"\0" * (-len(self.data) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
        (HERE / name).write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


def rectangle(left, right, bottom, top):
    """In the plane z = 0, its front towards +z."""
    corners = [(left, bottom, 0), (right, bottom, 0), (right, top, 0), (left, top, 0)]
    return corners, [0, 1, 2, 0, 2, 3]


def box(width, height, depth):
    """Centred on the origin in x and z, standing on y = 0, without its hidden bottom."""
    x, z = width / 2, depth / 2
    faces = [
        [(-x, 0, z), (x, 0, z), (x, height, z), (-x, height, z)],
        [(x, 0, -z), (-x, 0, -z), (-x, height, -z), (x, height, -z)],
        [(x, 0, z), (x, 0, -z), (x, height, -z), (x, height, z)],
        [(-x, 0, -z), (-x, 0, z), (-x, height, z), (-x, height, -z)],
        [(-x, height, z), (x, height, z), (x, height, -z), (-x, height, -z)],
    ]
    positions = [corner for face in faces for corner in face]
    indices = [4 * face + k for face in range(len(faces)) for k in (0, 1, 2, 0, 2, 3)]
    return positions, indices


def sphere(radius, slices, stacks):
    """About the origin; poles on the y axis."""
    positions = [(0, radius, 0)]
    for stack in range(1, stacks):
        polar = math.pi * stack / stacks
        for part in range(slices):
            around = 2 * math.pi * part / slices
            positions.append(
                (
                    radius * math.sin(polar) * math.sin(around),
                    radius * math.cos(polar),
                    radius * math.sin(polar) * math.cos(around),
                )
            )
    positions.append((0, -radius, 0))
    indices = []
    last = len(positions) - 1
    for part in range(slices):
        following = (part + 1) % slices
        indices += [0, 1 + part, 1 + following]
        for stack in range(stacks - 2):
            upper, lower = 1 + stack * slices, 1 + (stack + 1) * slices
            indices += [upper + part, lower + part, lower + following]
            indices += [upper + part, lower + following, upper + following]
        bottom = 1 + (stacks - 2) * slices
        indices += [bottom + part, last, bottom + following]
    return positions, indices


def wall(name, size_m, distance_m):
    """A square that faces a camera in the world's origin."""
    scene = Gltf()
    half = size_m / 2
    mesh = scene.mesh(*rectangle(-half, half, -half, half), scene.material("white", 1.0))
    scene.node({"name": "wall", "mesh": mesh, "translation": [0, 0, -distance_m]})
    scene.write_gltf(name)


def room():
    scene = Gltf()
    camera = {"type": "perspective", "perspective": {"yfov": math.radians(60), "aspectRatio": 1, "znear": 0.01}}
    scene.json["cameras"] = [camera]
    tilt = math.radians(-12) / 2
    scene.node(
        {
            "name": "Camera",
            "camera": 0,
            "translation": [0, 0.4, 1.0],
            "rotation": [math.sin(tilt), 0, 0, math.cos(tilt)],
        }
    )
    scene.node(
        {
            "name": "wall",
            "mesh": scene.mesh(*rectangle(-3, 3, 0, 4), scene.material("wall paint", 0.8)),
            "translation": [0, -1, -3],
        }
    )
    flat = math.radians(-90) / 2
    scene.node(
        {
            "name": "floor",
            "mesh": scene.mesh(*rectangle(-3, 3, -2, 2), scene.material("carpet", 0.2)),
            "translation": [0, -1, -1],
            "rotation": [math.sin(flat), 0, 0, math.cos(flat)],
        }
    )
    turn = math.radians(30) / 2
    scene.node(
        {
            "name": "box",
            "mesh": scene.mesh(*box(0.6, 0.8, 0.5), scene.material("cardboard", 0.45)),
            "translation": [-0.7, -1, -1.6],
            "rotation": [0, math.sin(turn), 0, math.cos(turn)],
        }
    )
    scene.node(
        {
            "name": "sphere",
            "mesh": scene.mesh(*sphere(0.5, 72, 70), scene.material("rubber", 0.6)),
            "translation": [0.6, -0.5, -1.4],
        }
    )
    scene.write_glb("room.glb")


def upright(radius, height, slices):
    """A closed cylinder about the y axis, standing on y = 0, without its hidden bottom."""
    around = [2 * math.pi * part / slices for part in range(slices)]
    foot = [(radius * math.sin(angle), 0, radius * math.cos(angle)) for angle in around]
    positions = foot + [(x, height, z) for x, _, z in foot] + [(0, height, 0)]
    indices = []
    for part in range(slices):
        following = (part + 1) % slices
        indices += [part, following, slices + following, part, slices + following, slices + part]
        indices += [slices + part, slices + following, 2 * slices]
    return positions, indices


def together(*parts):
    """One mesh of several (shape, (x, y, z)): each moved there."""
    positions, indices = [], []
    for (shape, corners), (x, y, z) in parts:
        first = len(positions)
        positions += [(px + x, py + y, pz + z) for px, py, pz in shape]
        indices += [first + corner for corner in corners]
    return positions, indices


def on_legs(width, depth, height, thickness, leg, *more):
    """A plate on four legs, closed on all sides, and more parts."""
    x, z = (width - leg) / 2, (depth - leg) / 2
    length = height - thickness
    legs = [(closed_bar(leg, length, leg), (sx * x, length / 2, sz * z)) for sx in (-1, 1) for sz in (-1, 1)]
    return together((closed_bar(width, thickness, depth), (0, height - thickness / 2, 0)), *legs, *more)


def showroom():
    """A table with a ball on it, two chairs, a column and crates in the corner of a room."""
    scene = Gltf()
    paint, wood, stone = (scene.material(*of) for of in (("wall paint", 0.8), ("wood", 0.5), ("stone", 0.35)))
    carpet, rubber, cardboard = (scene.material(*of) for of in (("carpet", 0.3), ("rubber", 0.7), ("cardboard", 0.45)))

    def put(name, shape, material, place, turn_deg=0.0, axis=(0, 1, 0)):
        half = math.radians(turn_deg) / 2
        rotation = [math.sin(half) * along for along in axis] + [math.cos(half)]
        mesh = shape if isinstance(shape, int) else scene.mesh(*shape, material)
        scene.node({"name": name, "mesh": mesh, "translation": list(place), "rotation": rotation})

    put("floor", rectangle(-2.4, 3.4, -2.5, 2.5), carpet, (0, 0, -0.5), -90, (1, 0, 0))
    put("back wall", rectangle(-2.4, 3.4, 0, 3.2), paint, (0, 0, -3))
    put("left wall", rectangle(-2.5, 2.5, 0, 3.2), paint, (-2.4, 0, -0.5), 90)
    put("table", on_legs(1.3, 0.75, 0.74, 0.05, 0.06), wood, (0.1, 0, -1.1), 12)
    put("ball", sphere(0.17, 48, 32), rubber, (0.25, 0.91, -1.1))
    back = (closed_bar(0.44, 0.45, 0.04), (0, 0.68, -0.2))
    chair = scene.mesh(*on_legs(0.44, 0.44, 0.45, 0.04, 0.05, back), wood)
    put("left chair", chair, wood, (-0.95, 0, -0.75), 70)
    put("right chair", chair, wood, (0.55, 0, -1.95), -10)
    put("column", upright(0.16, 3.2, 48), stone, (-1.5, 0, -2.0))
    put("crate", box(0.6, 0.6, 0.6), cardboard, (1.55, 0, -2.1), 25)
    put("small crate", box(0.35, 0.35, 0.35), cardboard, (1.5, 0.6, -2.1), -20)
    scene.write_glb("showroom/showroom.glb")


def moving():
    """A board that moves away at 1 m/s before a wall, a box that turns once in 2 s, a lamp that swings by."""
    scene = Gltf()
    wall = scene.mesh(*rectangle(-2, 2, -1.5, 1.5), scene.material("wall paint", 0.8))
    scene.node({"name": "wall", "mesh": wall, "translation": [0, 0, -4]})
    board = scene.mesh(*rectangle(-0.25, 0.25, -0.25, 0.25), scene.material("board", 0.6))
    board = scene.node({"name": "board", "mesh": board, "translation": [-0.4, 0.1, -1.5]})
    carton = scene.mesh(*box(0.5, 0.5, 0.5), scene.material("cardboard", 0.45))
    carton = scene.node({"name": "box", "mesh": carton, "translation": [0.5, -0.5, -2.5]})
    lamp = scene.node({"name": "Lamp", "translation": [-1, 0.8, 0]})
    scene.animation(board, "translation", [0, 2], [[-0.4, 0.1, -1.5], [-0.4, 0.1, -3.5]])
    quarters = [math.pi / 4 * k for k in range(5)]
    scene.animation(carton, "rotation", [0, 0.5, 1, 1.5, 2], [[0, math.sin(a), 0, math.cos(a)] for a in quarters])
    scene.animation(lamp, "translation", [0, 2], [[-1, 0.8, 0], [1, 0.8, 0]])
    scene.write_gltf("moving.gltf")


def closed_bar(width, height, depth):
    """Centred on the origin, all six sides, fronts outwards."""
    x, y, z = width / 2, height / 2, depth / 2
    positions = [(sx * x, sy * y, sz * z) for sx in (-1, 1) for sy in (-1, 1) for sz in (-1, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return positions, [face[k] for face in faces for k in (0, 1, 2, 0, 2, 3)]


def bars():
    """A grid of bars 2 mm wide and 30 mm apart, upright ones at 0.8 m and level ones right behind them; a wall at 2 m."""
    scene = Gltf()
    wall = scene.mesh(*rectangle(-1.5, 1.5, -1.5, 1.5), scene.material("wall paint", 0.8))
    scene.node({"name": "wall", "mesh": wall, "translation": [0, 0, -2]})
    steel = scene.material("steel", 0.5)
    length, width, pitch, count = 1.4, 0.002, 0.03, 42
    upright = scene.mesh(*closed_bar(width, length, width), steel)
    level = scene.mesh(*closed_bar(length, width, width), steel)
    for k in range(count):
        place = round(pitch * (k - (count - 1) / 2), 6)
        scene.node({"name": f"upright {k}", "mesh": upright, "translation": [place, 0, -0.8]})
        scene.node({"name": f"level {k}", "mesh": level, "translation": [0, place, -0.81]})
    scene.write_gltf("bars.gltf")


def inside_of_box(size, parts):
    """Centred on the origin, fronts inwards; every side is a grid of `parts` a direction, with vertices of its own."""
    positions, indices = [], []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (-1, 1):
            first = len(positions)
            for i in range(parts[u] + 1):
                for j in range(parts[v] + 1):
                    corner = [0.0, 0.0, 0.0]
                    corner[axis] = side * size[axis] / 2
                    corner[u] = size[u] * (i / parts[u] - 0.5)
                    corner[v] = size[v] * (j / parts[v] - 0.5)
                    positions.append(tuple(corner))
            for i in range(parts[u]):
                for j in range(parts[v]):
                    a = first + i * (parts[v] + 1) + j
                    b, c, d = a + parts[v] + 1, a + parts[v] + 2, a + 1
                    face = (a, d, c, b) if side > 0 else (a, b, c, d)
                    indices += [face[k] for k in (0, 1, 2, 0, 2, 3)]
    return positions, indices


def closed_box():
    """A box of 2 x 2 x 3 m, seen from inside by a camera that is turned, tilted and rolled."""
    scene = Gltf()
    camera = {"type": "perspective", "perspective": {"yfov": math.radians(100), "aspectRatio": 1, "znear": 0.01}}
    scene.json["cameras"] = [camera]
    turn, tilt, roll = (math.radians(angle) / 2 for angle in (25, -20, 10))
    rotation = [0, math.sin(turn), 0, math.cos(turn)]
    for next_rotation in ([math.sin(tilt), 0, 0, math.cos(tilt)], [0, 0, math.sin(roll), math.cos(roll)]):
        rotation = quaternion_product(rotation, next_rotation)
    scene.node({"name": "Camera", "camera": 0, "translation": [0.1, -0.15, 0.4], "rotation": rotation})
    mesh = scene.mesh(*inside_of_box((2.0, 2.0, 3.0), (5, 4, 7)), scene.material("cardboard", 0.45))
    scene.node({"name": "box", "mesh": mesh})
    scene.write_gltf("closed_box.gltf")


def quaternion_product(a, b):
    """x, y, z, w: first b, then a."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ]


def penumbra():
    """A wall at 2 m and half of a plane at 1 m, whose slanting edge is the border of what is seen."""
    scene = Gltf()
    wall = scene.mesh(*rectangle(-2, 2, -2, 2), scene.material("wall paint", 0.8))
    scene.node({"name": "wall", "mesh": wall, "translation": [0, 0, -2]})
    slant = math.radians(12) / 2
    scene.node(
        {
            "name": "half-plane",
            "mesh": scene.mesh(*rectangle(0, 2, -2, 2), scene.material("board", 0.3)),
            "translation": [0.3, 0, -1],
            "rotation": [0, 0, math.sin(slant), math.cos(slant)],
        }
    )
    scene.write_gltf("penumbra.gltf")


def corner():
    """Two walls that meet at a right angle 2.5 m before the camera, and the floor between them."""
    scene = Gltf()
    walls = scene.material("wall paint", 0.8)
    turn = math.radians(45) / 2
    for name, left, right, side in (("left wall", -1.6, 0, 1), ("right wall", 0, 1.6, -1)):
        scene.node(
            {
                "name": name,
                "mesh": scene.mesh(*rectangle(left, right, -0.7, 0.9), walls),
                "translation": [0, 0, -2.5],
                "rotation": [0, side * math.sin(turn), 0, math.cos(turn)],
            }
        )
    lying = math.radians(-90) / 2
    scene.node(
        {
            "name": "floor",
            "mesh": scene.mesh(*rectangle(-1.2, 1.2, 1.3, 2.5), scene.material("floor", 0.5)),
            "translation": [0, -0.7, 0],
            "rotation": [math.sin(lying), 0, 0, math.cos(lying)],
        }
    )
    scene.write_gltf("corner.gltf")


# The cameras of the analytic scenes: square pixels of 10 micrometres behind a lens of 1 m, one row of them. A pixel is
# so narrow that every sample of it is equally far, to a few nanometres.
PIXEL_PER_METRE = 10e-6


def patch(scene, name, columns, first, last, distance_m, reflectivity):
    """Fills the columns from edge `first` to edge `last` of a row of `columns` pixels, and a bit beyond the view."""
    beyond = 2
    left = first if first > 0 else -beyond
    right = last if last < columns else columns + beyond
    pixel_m = PIXEL_PER_METRE * distance_m
    edges = [(edge - columns / 2) * pixel_m for edge in (left, right)]
    mesh = scene.mesh(*rectangle(*edges, -beyond * pixel_m, beyond * pixel_m), scene.material(name, reflectivity))
    scene.node({"name": name, "mesh": mesh, "translation": [0, 0, -distance_m]})


def staircase(name, distances_m):
    """One pixel a distance, from left to right."""
    scene = Gltf()
    for column, distance_m in enumerate(distances_m):
        patch(scene, f"at {distance_m} m", len(distances_m), column, column + 1, distance_m, 1.0)
    scene.write_gltf(name)


def mixed(name, near_m, far_m, near_reflectivity):
    """Three pixels: the left one on the near patch, the right one on the far one, the middle one half on each."""
    scene = Gltf()
    patch(scene, "near", 3, 0, 1.5, near_m, near_reflectivity)
    patch(scene, "far", 3, 0, 3, far_m, 1.0)
    scene.write_gltf(name)


def cosine_diagram(name, order):
    """J = cos(theta)^order from 0 to 90 degrees in steps of 1, as CSV and as IES LM-63-2002."""
    angles = range(91)
    relative = [f"{0.0 if angle == 90 else math.cos(math.radians(angle)) ** order:.9f}" for angle in angles]
    rows = [f"{angle}, {value}" for angle, value in zip(angles, relative)]
    (HERE / f"{name}.csv").write_text("\n".join(["angle_deg, relative", *rows]) + "\n")

    def wrapped(words, per_line):
        return "\n".join(" ".join(words[i : i + per_line]) for i in range(0, len(words), per_line))

    ies = [
        "IESNA:LM-63-2002",
        "[TEST] none, computed by pmdsim scenes/make_scenes.py",
        "[MANUFAC] none",
        f"[LUMINAIRE] a diode with the diagram cos^{order}",
        "TILT=NONE",
        f"1 -1 1.0 {len(angles)} 1 1 2 0 0 0",
        "1.0 1.0 1.0",
        wrapped([str(angle) for angle in angles], 20),
        "0",
        wrapped(relative, 8),
    ]
    (HERE / f"{name}.ies").write_text("\n".join(ies) + "\n")


def main():
    wall("wall_2m.gltf", 0.4, 2.0)
    wall("wall_0m3.gltf", 0.45, 0.3)
    room()
    showroom()
    bars()
    closed_box()
    penumbra()
    corner()
    moving()
    cosine_diagram("led_cos3", 3)
    staircase("analytic/wrap_10mhz.gltf", [15.0, 20.0, 49.0])
    staircase("analytic/on_axis_baseline.gltf", [0.5, 1.0, 2.0, 5.0])
    staircase("analytic/inverse_square.gltf", [0.5, 1.0, 2.0, 4.0, 8.0])
    mixed("analytic/mixed_equal.gltf", 1.0, 1.5, (1.0 / 1.5) ** 2)
    mixed("analytic/mixed_inverse_square.gltf", 1.0, 1.5, 1.0)
    cancelling_m = 1.0 + SPEED_OF_LIGHT / (4 * 20e6)
    mixed("analytic/cancel.gltf", 1.0, cancelling_m, (1.0 / cancelling_m) ** 2)


if __name__ == "__main__":
    main()
