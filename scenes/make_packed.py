#!/usr/bin/env python3
"""Writes packed/: a scene with texture, vertex colours and holes, and what gltfpack makes of it and of others.

Needs Python 3 and gltfpack 0.18 on the PATH. tests/gpu_against_reference/expected/packed.json says how each file was made and how exact it is.
"""

import json
import math
import re
import shutil
import struct
import subprocess
import sys
import zlib

sys.dont_write_bytecode = True  # leaves no cache among the scenes
from make_scenes import ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER, FLOAT, HERE, UNSIGNED_SHORT, Gltf  # noqa: E402

UNSIGNED_BYTE = 5121

# What a simulator of its own light needs kept: nodes that poses name, materials' names and extras (reflectivity).
KEEP = ["-kn", "-km", "-ke"]
PACKINGS = [
    ("packed/grid.glb", "packed/grid_quantised.glb", []),
    ("packed/grid.glb", "packed/grid_normalised.glb", ["-vpn"]),
    ("packed/grid.glb", "packed/grid_packed.glb", ["-c"]),
    ("packed/grid.glb", "packed/grid_packed_cc.glb", ["-cc"]),
    ("packed/grid.glb", "packed/grid_packed_floats.glb", ["-noq", "-c"]),
    ("room.glb", "packed/room_packed.glb", ["-c"]),
    ("room.glb", "packed/room_packed_floats.glb", ["-noq", "-c"]),
    ("blender/moving.glb", "packed/moving_packed.glb", ["-c", "-af", "50"]),
    ("blender/moving.glb", "packed/moving_packed_cc.glb", ["-cc", "-af", "50"]),
]


# --- a scene of our own ----------------------------------------------------------------------------------------------


def png(columns, rows, texel):
    """RGBA, 8 bits; texel(column, row) from the top left."""

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    lines = b"".join(b"\0" + bytes(v for c in range(columns) for v in texel(c, r)) for r in range(rows))
    header = struct.pack(">IIBBBBB", columns, rows, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(lines, 9)) + chunk(b"IEND", b"")


def soft_holes(column, row):
    """Brighter to the right and downwards; alpha falls smoothly to 0 in the middle of each 8 x 8 texels."""
    away = math.hypot(column % 8 - 3.5, row % 8 - 3.5)
    return (60 + 6 * column, 80 + 5 * row, 120, min(255, int(60 * away)))


class PaintedGltf(Gltf):
    def cut_out(self, name, image, cutoff):
        self.data += b"\0" * (-len(self.data) % 4)
        view = self._append("bufferViews", {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(image)})
        self.data += image
        source = self._append("images", {"bufferView": view, "mimeType": "image/png"})
        sampler = self._append("samplers", {"magFilter": 9729, "minFilter": 9729, "wrapS": 10497, "wrapT": 33648})
        texture = self._append("textures", {"source": source, "sampler": sampler})
        return self._append(
            "materials",
            {
                "name": name,
                "alphaMode": "MASK",
                "alphaCutoff": cutoff,
                "doubleSided": True,
                "pbrMetallicRoughness": {
                    "baseColorFactor": [0.9, 0.9, 0.9, 1],
                    "baseColorTexture": {"index": texture},
                    "metallicFactor": 0,
                },
            },
        )

    def vectors(self, rows, letter, component_type, **accessor):
        data = b"".join(struct.pack(f"<{len(row)}{letter}", *row) for row in rows)
        kind = f"VEC{len(rows[0])}"
        return self._accessor(data, ARRAY_BUFFER, componentType=component_type, count=len(rows), type=kind, **accessor)

    def floats(self, rows, **accessor):
        return self.vectors(rows, "f", FLOAT, **accessor)

    def painted_mesh(self, positions, coordinates, colours, indices, material):
        exact = [struct.unpack("<3f", struct.pack("<3f", *position)) for position in positions]
        axes = list(zip(*exact))
        attributes = {
            "POSITION": self.floats(exact, min=[min(axis) for axis in axes], max=[max(axis) for axis in axes]),
            "TEXCOORD_0": self.floats(coordinates),
            "COLOR_0": self.vectors(colours, "B", UNSIGNED_BYTE, normalized=True),
        }
        data = struct.pack(f"<{len(indices)}H", *indices)
        index = self._accessor(
            data, ELEMENT_ARRAY_BUFFER, componentType=UNSIGNED_SHORT, count=len(indices), type="SCALAR"
        )
        primitive = {"attributes": attributes, "indices": index, "material": material}
        return self._append("meshes", {"primitives": [primitive]})


def bumpy_grid(columns, rows, width_m, height_m):
    """About the origin, its front towards +z."""
    positions, coordinates, colours, indices = [], [], [], []
    for row in range(rows + 1):
        for column in range(columns + 1):
            u, v = column / columns, row / rows
            bump = 0.06 * math.sin(9 * u) * math.cos(7 * v)
            positions.append(((u - 0.5) * width_m, (0.5 - v) * height_m, bump))
            coordinates.append((2 * u, 1.5 * v))
            colours.append((255 - 3 * column, 130 + 3 * row, 190, 255))
    for row in range(rows):
        for column in range(columns):
            first = row * (columns + 1) + column
            below = first + columns + 1
            indices += [first, below, below + 1, first, below + 1, first + 1]
    return positions, coordinates, colours, indices


def grid():
    scene = PaintedGltf()
    view = {"yfov": math.radians(45), "aspectRatio": 4 / 3, "znear": 0.01}
    scene.json["cameras"] = [{"type": "perspective", "perspective": view}]
    scene.node({"name": "Camera", "camera": 0, "translation": [0.1, 0.2, 0.5]})
    material = scene.cut_out("lace", png(32, 32, soft_holes), 0.25)
    turn = math.radians(20) / 2
    scene.node(
        {
            "name": "grid",
            "mesh": scene.painted_mesh(*bumpy_grid(40, 40, 1.2, 0.9), material),
            "translation": [0.1, 0.2, -1],
            "rotation": [0, math.sin(turn), 0, math.cos(turn)],
        }
    )
    scene.write_glb("packed/grid.glb")


# --- packing ---------------------------------------------------------------------------------------------------------


def document_of(name):
    data = (HERE / name).read_bytes()
    return json.loads(data[20 : 20 + struct.unpack_from("<I", data, 12)[0]])


def position_step_m(document):
    """The largest step of quantised positions, 0 where they are floats. A mesh hangs on a node whose scale turns
    integers to metres; of a skin's mesh the inverse bind matrices do, and it has no step here."""
    step = 0.0
    for node in document["nodes"]:
        if "mesh" not in node or "skin" in node:
            continue
        for primitive in document["meshes"][node["mesh"]]["primitives"]:
            accessor = document["accessors"][primitive["attributes"]["POSITION"]]
            if accessor["componentType"] != FLOAT:
                unit = 65535 if accessor.get("normalized") else 1
                step = max(step, max(node.get("scale", [1])) / unit)
    return step


def quantisation_bits(options, document):
    """gltfpack's defaults. A value that is not named stays as it was; colours have 8 bits always."""
    floats, strong = "-noq" in options, "-cc" in options
    bits = {} if floats else {"position": 14, "texture_coordinate": 12}
    bits["colour"] = 8
    if "skins" in document:
        bits["weight"] = 8
    if "animations" in document:
        bits |= {"translation": 16, "rotation": 12, "scale": 16} if strong else {"rotation": 16}
    return bits


def pack(source, name, options):
    arguments = ["-i", str(HERE / source), "-o", str(HERE / name), *options, *KEEP]
    subprocess.run(["gltfpack", *arguments], check=True)
    document = document_of(name)
    return {
        "file": name,
        "plain": source,
        "options": options + KEEP,
        "position_step_m": position_step_m(document),
        "bits": quantisation_bits(options, document),
        "extensions_required": document.get("extensionsRequired", []),
        "extensions_used": document.get("extensionsUsed", []),
    }


def gltfpack_version():
    shown = subprocess.run(["gltfpack", "-v"], capture_output=True, text=True)
    return re.search(r"gltfpack (\S+)", shown.stdout + shown.stderr).group(1)


def main():
    if shutil.which("gltfpack") is None:
        raise SystemExit("gltfpack is not on the PATH (Debian: apt install gltfpack)")
    (HERE / "packed").mkdir(exist_ok=True)
    grid()
    entries = [pack(*packing) for packing in PACKINGS]
    lines = ",\n".join("  " + json.dumps(entry) for entry in entries)
    text = f'{{\n "gltfpack": "{gltfpack_version()}",\n "files": [\n{lines}\n ]\n}}\n'
    (HERE.parent / "tests/gpu_against_reference/expected/packed.json").write_text(text)
    for entry in entries:
        print(f"{entry['file']:34} {(HERE / entry['file']).stat().st_size:6} B", end="  ")
        print(f"step {entry['position_step_m'] * 1e6:8.3f} um  {' '.join(entry['options'])}  {entry['bits']}")


if __name__ == "__main__":
    main()
