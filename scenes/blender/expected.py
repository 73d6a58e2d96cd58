"""Writes what Blender itself says about the scene of make_moving.py at some times: the numbers that any reader of the
exported files must find.

    blender --background --factory-startup --python scenes/blender/expected.py -- OUT.json

Places come from Blender's evaluated scene, not from glTF; only axes are turned, (x, y, z) to (x, z, -y). Colours come
from Blender's images, texture coordinates and node settings by the formulas below.
"""

import json
import math
import sys
from pathlib import Path

import bpy

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))
import make_moving  # noqa: E402

TIMES_S = (0.0, 0.26, 0.5, 0.9)  # on whole frames, where sampled animations are exact
NODES = ("Camera", "Rider", "Light")


def to_gltf(v):
    return [v[0], v[2], -v[1]]


def rounded(values, digits=7):
    return [round(value, digits) + 0.0 for value in values]


def transformed(matrix, point, w=1.0):
    """In double; Blender's matrices hold floats."""
    return [sum(matrix[row][k] * point[k] for k in range(3)) + matrix[row][3] * w for row in range(3)]


# --- places ----------------------------------------------------------------------------------------------------------


def world_vertices(thing, graph):
    evaluated = thing.evaluated_get(graph)
    mesh = evaluated.to_mesh()
    vertices = [to_gltf(transformed(evaluated.matrix_world, vertex.co)) for vertex in mesh.vertices]
    evaluated.to_mesh_clear()
    return vertices


def places(thing, graph):
    vertices = [rounded(vertex) for vertex in world_vertices(thing, graph)]
    return {
        "min_m": [min(axis) for axis in zip(*vertices)],
        "max_m": [max(axis) for axis in zip(*vertices)],
        "vertices_m": sorted(vertices),
    }


def node_pose(thing, graph):
    """Cameras look along their own -Z in both worlds. An empty's axes are turned as its place is, so that glTF's
    -Z is Blender's +Y and glTF's +Y is Blender's +Z."""
    world = thing.evaluated_get(graph).matrix_world
    along, up = ((0, 0, -1), (0, 1, 0)) if thing.type == "CAMERA" else ((0, 1, 0), (0, 0, 1))
    return {
        "position_m": rounded(to_gltf(transformed(world, (0, 0, 0)))),
        "view_axis": rounded(to_gltf(transformed(world, along, 0.0))),
        "up": rounded(to_gltf(transformed(world, up, 0.0))),
    }


def at(time_s):
    frame = time_s * make_moving.FRAME_RATE_HZ
    assert abs(frame - round(frame)) < 1e-9
    bpy.context.scene.frame_set(round(frame))
    graph = bpy.context.evaluated_depsgraph_get()
    meshes = [thing for thing in bpy.context.scene.objects if thing.type == "MESH"]
    return {
        "time_s": time_s,
        "plate_range_m": round(1.5 + time_s, 7),
        "nodes": {name: node_pose(bpy.data.objects[name], graph) for name in NODES},
        "objects": {thing.name: places(thing, graph) for thing in meshes},
    }


# --- colours ---------------------------------------------------------------------------------------------------------


def linear(srgb):
    return srgb / 12.92 if srgb <= 0.04045 else ((srgb + 0.055) / 1.055) ** 2.4


def luminance(rgb):
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]


class Image:
    """Blender's: the first row is the bottom one, texture coordinates grow upwards from there."""

    def __init__(self, image, repeat):
        self.columns, self.rows = image.size
        values = list(image.pixels)
        self.texels = [values[k : k + 4] for k in range(0, len(values), 4)]
        self.repeat = repeat

    def texel(self, column, row):
        if self.repeat:
            column, row = column % self.columns, row % self.rows
        column, row = min(max(column, 0), self.columns - 1), min(max(row, 0), self.rows - 1)
        red, green, blue, alpha = self.texels[row * self.columns + column]
        return [linear(red), linear(green), linear(blue), alpha]

    def closest(self, u, v):
        return self.texel(math.floor(u * self.columns), math.floor(v * self.rows))

    def interpolated(self, u, v):
        """Between linear values, as glTF asks for."""
        x, y = u * self.columns - 0.5, v * self.rows - 0.5
        left, bottom = math.floor(x), math.floor(y)
        right_share, top_share = x - left, y - bottom
        result = [0.0] * 4
        for column, column_share in ((left, 1 - right_share), (left + 1, right_share)):
            for row, row_share in ((bottom, 1 - top_share), (bottom + 1, top_share)):
                for k, value in enumerate(self.texel(column, row)):
                    result[k] += column_share * row_share * value
        return result


def texture_node(thing):
    nodes = thing.data.materials[0].node_tree.nodes
    return next(node for node in nodes if node.type == "TEX_IMAGE")


def mapped(thing, uv):
    """Blender's Mapping node, kind Point: scaled, turned, shifted."""
    nodes = thing.data.materials[0].node_tree.nodes
    mapping = next((node for node in nodes if node.type == "MAPPING"), None)
    if mapping is None:
        return uv
    scale, offset = mapping.inputs["Scale"].default_value, mapping.inputs["Location"].default_value
    turn = mapping.inputs["Rotation"].default_value[2]
    x, y = scale[0] * uv[0], scale[1] * uv[1]
    cos, sin = math.cos(turn), math.sin(turn)
    return (cos * x - sin * y + offset[0], sin * x + cos * y + offset[1])


def corner_values(thing, layer):
    """By vertex: a sheet's vertices have one texture coordinate each."""
    uvs = {loop.vertex_index: thing.data.uv_layers[layer].data[loop.index].uv for loop in thing.data.loops}
    return [uvs[k] for k in range(4)]


def across(corners, a, b):
    """Of a sheet's values at its lower left, lower right, upper left and upper right corner."""
    shares = ((1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b)
    return [sum(share * value[k] for share, value in zip(shares, corners)) for k in range(len(corners[0]))]


def painted_point(name, layer, a, b):
    thing = bpy.data.objects[name]
    node = texture_node(thing)
    image = Image(node.image, node.extension == "REPEAT")
    uv = across(corner_values(thing, layer), a, b)
    u, v = mapped(thing, uv)
    rgba = image.closest(u, v) if node.interpolation == "Closest" else image.interpolated(u, v)
    masked = thing.data.materials[0].blend_method == "CLIP"
    local = across([vertex.co for vertex in thing.data.vertices], a, b)
    return {
        "object": name,
        "point_m": rounded(to_gltf(transformed(thing.matrix_world, local))),
        "texture_coordinate": rounded((uv[0], 1 - uv[1])),
        "image_coordinate": rounded((u, 1 - v)),
        "rgb": rounded(rgba[:3]),
        "alpha": round(rgba[3], 7),
        "reflectivity": round(luminance(rgba), 7),
        "is_there": not masked or rgba[3] >= 0.5,
    }


def textures():
    """Shares of the width and height from the lower left; on the poster away from the edges of texels and holes."""
    fine = [(c + 0.3) / 32 for c in (0, 1, 5, 9, 14, 18, 23, 31)]
    points = [("Poster", "unit", a, b) for a, b in zip(fine, [fine[k] for k in (0, 6, 2, 7, 4, 1, 3, 5)])]
    points += [("Banner", "second", a, b) for a, b in ((0.1, 0.1), (0.37, 0.81), (0.5, 0.5), (0.7, 0.2), (0.95, 0.9))]
    points += [("Print", "unit", a, b) for a, b in ((0.01, 0.99), (0.3, 0.6), (0.5, 0.5), (0.77, 0.21))]
    return [painted_point(*point) for point in points]


def base_colour(thing):
    shader = thing.data.materials[0].node_tree.nodes["Principled BSDF"]
    return list(shader.inputs["Base Color"].default_value)[:3]


def vertex_colours(name):
    """Times the material's base colour."""
    thing = bpy.data.objects[name]
    factor = base_colour(thing)
    radius = thing.data.attributes.get("radius")
    result = []
    for k, vertex in enumerate(thing.data.vertices):
        rgb = [factor[c] * thing.data.color_attributes["paint"].data[k].color[c] for c in range(3)]
        entry = {
            "point_m": rounded(to_gltf(transformed(thing.matrix_world, vertex.co))),
            "rgb": rounded(rgb),
            "reflectivity": round(luminance(rgb), 7),
        }
        if radius is not None:
            entry["radius_m"] = round(radius.data[k].value, 7)
        result.append(entry)
    return result


def plain_reflectivities():
    plain = ("Floor", "Cart", "Sleeve")
    result = {name: round(luminance(base_colour(bpy.data.objects[name])), 7) for name in plain}
    result["Plate"] = bpy.data.objects["Plate"].data.materials[0]["pmdsim_reflectivity"]
    return result


# --- the file --------------------------------------------------------------------------------------------------------

MEANING = [
    "What Blender's evaluated scene says, world frame of glTF, metres; written by expected.py, no reader of glTF.",
    "moving.glb holds every animation sampled at 50 Hz, moving_keys.glb as key frames (cubic spline, linear, step).",
    "Both give these numbers: places within tolerance_m, unit axes within tolerance_axis, linear colours within",
    "tolerance_colour (Print, a JPEG: tolerance_jpeg).",
    "vertices_m: each vertex once, sorted by x, y, z. The exporter repeats vertices at sharp edges: compare both ways",
    "by the nearest one, not by index.",
    "nodes: view_axis is the node's -Z, up its +Y. plate_range_m: from the Camera along its axis to the Plate, which",
    "is square to it and recedes at 1 m/s.",
    "textures, vertex_colours: at time 0. texture_coordinate is the file's (v down), image_coordinate follows from",
    "KHR_texture_transform. Texels are nearest on the Poster, linear between the four around elsewhere; the Banner is",
    "opaque, its colour is the image's whatever the alpha. is_there: alpha is at least the cutoff.",
    "reflectivity: 0.2126 red + 0.7152 green + 0.0722 blue.",
]


def document():
    times = [at(time_s) for time_s in TIMES_S]
    bpy.context.scene.frame_set(0)
    data = bpy.data.objects["Camera"].data
    vertical = 2 * math.atan(math.tan(data.angle / 2) * 120 / 160)
    return {
        "meaning": MEANING,
        "files": ["moving.glb", "moving_keys.glb"],
        "tolerance_m": 1e-5,
        "tolerance_axis": 1e-5,
        "tolerance_colour": 1e-4,
        "tolerance_jpeg": 0.02,
        "camera_yfov_rad": round(vertical, 7),
        "reflectivity": plain_reflectivities(),
        "textures": textures(),
        "vertex_colours": {name: vertex_colours(name) for name in ("Spinner", "Cloud")},
        "times": times,
    }


def text(value, indent=0):
    """JSON with one line for everything that fits one."""
    line = json.dumps(value)
    if len(line) + indent <= 118 or not isinstance(value, (dict, list)):
        return line
    inner = " " * (indent + 1)
    if isinstance(value, dict):
        items = [f"{json.dumps(key)}: {text(item, indent + 1)}" for key, item in value.items()]
        return "{\n" + ",\n".join(inner + item for item in items) + "\n" + " " * indent + "}"
    items = [text(item, indent + 1) for item in value]
    return "[\n" + ",\n".join(inner + item for item in items) + "\n" + " " * indent + "]"


def main():
    make_moving.build()
    out = sys.argv[sys.argv.index("--") + 1]
    Path(out).write_text(text(document()) + "\n")


if __name__ == "__main__":
    main()
