"""Builds a small moving scene in Blender and lets its own exporter write it as glTF.

    blender --background --factory-startup --python scenes/blender/make_moving.py -- OUT.glb [--keys]

Without --keys the exporter samples every animation at every frame, its default; with --keys it writes Blender's own key
frames (cubic splines, lines, steps). The motion is such that glTF can say it exactly either way: Bezier handles lie a
third of the way to the next key, where a Bezier curve is a cubic in time; quaternions are keyed, not angles, where
curves are bent; turns at an even pace are keyed about one axis. A frame is 1/50 s, frame 0 is time 0.

Lengths are metres, Blender's axes are +Z up; the exporter turns (x, y, z) to glTF's (x, z, -y). Needs Blender 3.4.
"""

import math
import sys
import tempfile
from pathlib import Path

import bpy
from mathutils import Euler, Matrix, Quaternion, Vector

FRAME_RATE_HZ = 50
LAST_FRAME = 50
PATTERN_SIDE = 32
HORIZONTAL_VIEW_DEG = 60.0


# --- where things are ------------------------------------------------------------------------------------------------

CAMERA_POSITION_M = (0.6, -2.0, 1.1)
CAMERA_TURN = Euler((math.radians(84), 0.0, math.radians(12)), "XYZ")
WORLD_FROM_CAMERA = Matrix.Translation(CAMERA_POSITION_M) @ CAMERA_TURN.to_matrix().to_4x4()


def before_camera(right_m, up_m, forward_m):
    """A point of the world, from its place before the camera."""
    return WORLD_FROM_CAMERA @ Vector((right_m, up_m, -forward_m))


# --- meshes ----------------------------------------------------------------------------------------------------------


def add(name, data, material=None):
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    if material is not None:
        data.materials.append(material)
    return thing


def mesh_of(name, vertices, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    mesh.validate()
    return mesh


def box_mesh(name, side_m):
    h = side_m / 2
    corners = [(x, y, z) for x in (-h, h) for y in (-h, h) for z in (-h, h)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return mesh_of(name, corners, faces)


def sheet_mesh(name, width_m, height_m, columns=1, rows=1):
    """In the local plane z = 0 about the origin, its front towards +z; texture coordinates run from 0 to 1."""
    places = [(column / columns, row / rows) for row in range(rows + 1) for column in range(columns + 1)]
    vertices = [((u - 0.5) * width_m, (v - 0.5) * height_m, 0.0) for u, v in places]
    firsts = [row * (columns + 1) + column for row in range(rows) for column in range(columns)]
    faces = [(first, first + 1, first + columns + 2, first + columns + 1) for first in firsts]
    mesh = mesh_of(name, vertices, faces)
    layer = mesh.uv_layers.new(name="unit")
    for loop in mesh.loops:
        layer.data[loop.index].uv = places[loop.vertex_index]
    return mesh


def tube_mesh(name, radius_m, length_m, sides, rings):
    """About +y of its own frame, from 0 to its length, smooth so that its vertices are shared."""
    vertices = []
    for ring in range(rings):
        for side in range(sides):
            turn = 2 * math.pi * side / sides
            vertices.append((radius_m * math.sin(turn), length_m * ring / (rings - 1), radius_m * math.cos(turn)))
    faces = []
    for ring in range(rings - 1):
        for side in range(sides):
            following = (side + 1) % sides
            a, b = ring * sides + side, ring * sides + following
            faces.append((a, b, b + sides, a + sides))
    mesh = mesh_of(name, vertices, faces)
    for polygon in mesh.polygons:
        polygon.use_smooth = True
    return mesh


# --- images and materials --------------------------------------------------------------------------------------------


def pattern_texel(column, row):
    """sRGB bytes and alpha of the image that posters carry; row 0 is the top one. Red grows to the right, green
    downwards; blue tells the four corners apart; every second square of 4 x 4 texels is a hole."""
    blue = 40 + 60 * (column // (PATTERN_SIDE // 2)) + 120 * (row // (PATTERN_SIDE // 2))
    hole = (column // 4 + row // 4) % 2 == 1
    return (8 * column + 4, 7 * row + 20, blue, 0 if hole else 255)


def pattern_image():
    image = bpy.data.images.new("pattern", PATTERN_SIDE, PATTERN_SIDE, alpha=True)
    texels = []
    for row in reversed(range(PATTERN_SIDE)):  # Blender's first row is the bottom one
        for column in range(PATTERN_SIDE):
            texels += [value / 255 for value in pattern_texel(column, row)]
    image.pixels = texels
    image.update()
    image.pack()
    return image


def photo_image():
    """Smooth, so that JPEG hardly changes it; packed as JPEG."""
    side = 16
    image = bpy.data.images.new("photo", side, side, alpha=False)
    texels = []
    for row in range(side):
        for column in range(side):
            texels += [0.2 + 0.6 * column / (side - 1), 0.3 + 0.4 * row / (side - 1), 0.5, 1.0]
    image.pixels = texels
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "photo.jpg"
        bpy.context.scene.render.image_settings.quality = 95
        image.file_format = "JPEG"
        image.filepath_raw = str(path)
        image.save()
        bpy.data.images.remove(image)
        image = bpy.data.images.load(str(path))
        image.pack()
        image.pixels[0]  # decoded while it is there
    image.name = "photo"
    return image


def material_of(name, rgb=(0.8, 0.8, 0.8), one_sided=False):
    """A plain one; rgb is linear."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.use_backface_culling = one_sided
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*rgb, 1.0)
    return material


def textured(name, image, interpolation, extension="REPEAT", uv_map=None, mapping=None, mask=False):
    """Its base colour is the image; mapping is (offset, turn about z, scale) of the texture coordinates."""
    material = material_of(name)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    shader = nodes["Principled BSDF"]
    texture = nodes.new("ShaderNodeTexImage")
    texture.image, texture.interpolation, texture.extension = image, interpolation, extension
    links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    if uv_map is not None:
        coordinates = nodes.new("ShaderNodeUVMap")
        coordinates.uv_map = uv_map
        shift = nodes.new("ShaderNodeMapping")
        shift.vector_type = "POINT"
        offset, turn_rad, scale = mapping
        shift.inputs["Location"].default_value = (*offset, 0.0)
        shift.inputs["Rotation"].default_value = (0.0, 0.0, turn_rad)
        shift.inputs["Scale"].default_value = (*scale, 1.0)
        links.new(coordinates.outputs["UV"], shift.inputs["Vector"])
        links.new(shift.outputs["Vector"], texture.inputs["Vector"])
    if mask:
        links.new(texture.outputs["Alpha"], shader.inputs["Alpha"])
        material.blend_method, material.alpha_threshold = "CLIP", 0.5
    return material


# --- motion ----------------------------------------------------------------------------------------------------------


def key(thing, path, values, interpolation):
    """values: by frame. A Bezier curve rests at both ends and passes the keys between with the mean slope of their
    neighbours."""
    for frame, value in values.items():
        setattr(thing, path, value)
        thing.keyframe_insert(path, frame=frame)
    for curve in thing.id_data.animation_data.action.fcurves:
        if not curve.data_path.endswith(path):
            continue
        points = curve.keyframe_points
        for point in points:
            point.interpolation = interpolation
            point.handle_left_type = point.handle_right_type = "FREE"
        slopes = [(after.co.y - before.co.y) / (after.co.x - before.co.x) for before, after in zip(points, points[2:])]
        slopes = [0.0, *slopes, 0.0]
        for k, (before, after) in enumerate(zip(points, points[1:])):
            third = (after.co.x - before.co.x) / 3
            before.handle_right = (before.co.x + third, before.co.y + third * slopes[k])
            after.handle_left = (after.co.x - third, after.co.y - third * slopes[k + 1])
        curve.update()


# --- the things in the scene -----------------------------------------------------------------------------------------


def cameras(cart):
    data = bpy.data.cameras.new("Camera")
    data.sensor_fit = "HORIZONTAL"
    data.angle = math.radians(HORIZONTAL_VIEW_DEG)
    data.clip_start, data.clip_end = 0.01, 100.0
    camera = add("Camera", data)
    camera.location, camera.rotation_euler = CAMERA_POSITION_M, CAMERA_TURN
    bpy.context.scene.camera = camera
    rider = add("Rider", data.copy())
    rider.parent = cart
    rider.location = (-0.05, -0.2, 0.25)
    rider.rotation_euler = (math.radians(80), 0.0, math.radians(40))


def plate():
    """Square to the optical axis, from 1.5 m away at 1 m/s."""
    material = material_of("plate", (0.5, 0.5, 0.5), one_sided=True)
    material["pmdsim_reflectivity"] = 0.35
    thing = add("Plate", sheet_mesh("plate", 0.5, 0.4), material)
    thing.rotation_euler = CAMERA_TURN
    key(thing, "location", {0: before_camera(0, 0, 1.5), LAST_FRAME: before_camera(0, 0, 2.5)}, "LINEAR")


def cart():
    """A box that goes 1 m along the view in 1 s, with a swerve, and turns by 150 degrees; it starts and ends gently."""
    material = material_of("cart", (0.7, 0.1, 0.05))
    thing = add("Cart", box_mesh("cart", 0.3), material)
    thing.rotation_mode = "QUATERNION"
    turned = Quaternion((0.2, 0.3, 1.0), math.radians(150))
    way = {0: (0.6, -0.1, 1.8), 20: (0.75, 0.0, 2.1), LAST_FRAME: (0.6, -0.1, 2.8)}
    way = {frame: before_camera(*place) for frame, place in way.items()}
    key(thing, "location", way, "BEZIER")
    key(thing, "rotation_quaternion", {0: Quaternion(), LAST_FRAME: turned}, "BEZIER")
    light = add("Light", None)
    light.parent = thing
    light.location = (-0.1, -0.1, 0.4)
    light.rotation_euler = (math.radians(-25), 0.0, math.radians(30))
    return thing


def spinner():
    """A leaf with a colour at every vertex (floats), one turn a second; bigger from frame 21 on."""
    mesh = sheet_mesh("spinner", 0.35, 0.2)
    mesh.uv_layers.remove(mesh.uv_layers[0])
    colours = mesh.color_attributes.new("paint", "FLOAT_COLOR", "POINT")
    for item, colour in zip(colours.data, ((1, 0, 0, 1), (0, 1, 0, 1), (0.25, 0.5, 0.75, 1), (0.0625, 0.125, 1, 1))):
        item.color = colour
    thing = add("Spinner", mesh, material_of("spinner", (1.0, 0.5, 0.25)))
    thing.location = before_camera(0.05, -0.5, 1.7)
    turns = {f: (math.radians(70), 0.3, 2 * math.pi * f / LAST_FRAME) for f in range(0, LAST_FRAME + 1, 10)}
    key(thing, "rotation_euler", turns, "LINEAR")
    key(thing, "scale", {0: (1, 1, 1), 21: (1.25, 1.5, 1.0), LAST_FRAME: (1.25, 1.5, 1.0)}, "CONSTANT")


def posters(pattern, photo):
    """Three sheets with images that stand still: cut out, shifted and turned, and a JPEG."""
    cut_out = textured("poster", pattern, "Closest", extension="EXTEND", mask=True)
    poster = add("Poster", sheet_mesh("poster", 0.6, 0.6), cut_out)
    poster.location = before_camera(-0.75, 0.4, 2.2)
    poster.rotation_euler = CAMERA_TURN

    banner_mapping = ((0.125, 0.25), math.radians(30), (2.0, 1.5))
    shifted = textured("banner", pattern, "Linear", uv_map="second", mapping=banner_mapping)
    mesh = sheet_mesh("banner", 0.9, 0.3)
    second = mesh.uv_layers.new(name="second")
    for loop in mesh.loops:
        u, v = mesh.uv_layers["unit"].data[loop.index].uv
        second.data[loop.index].uv = (0.75 * u + 0.125, 0.5 * v + 0.125)
    banner = add("Banner", mesh, shifted)
    banner.location = before_camera(0.25, 0.7, 2.3)
    banner.rotation_euler = (math.radians(70), 0.0, math.radians(25))

    photograph = add("Print", sheet_mesh("print", 0.3, 0.3), textured("print", photo, "Linear", extension="EXTEND"))
    photograph.location = before_camera(-0.95, -0.2, 2.0)
    photograph.rotation_euler = CAMERA_TURN


def sleeve():
    """A tube over two bones; the outer one bends by 70 degrees while the arm as a whole rises by 0.2 m."""
    data = bpy.data.armatures.new("arm")
    arm = add("Arm", data)
    bpy.context.view_layer.objects.active = arm
    bpy.ops.object.mode_set(mode="EDIT")
    upper = data.edit_bones.new("upper")
    upper.head, upper.tail = (0, 0, 0), (0, 0.25, 0)
    lower = data.edit_bones.new("lower")
    lower.head, lower.tail = (0, 0.25, 0), (0, 0.5, 0)
    lower.parent, lower.use_connect = upper, True
    bpy.ops.object.mode_set(mode="OBJECT")

    tube = add("Sleeve", tube_mesh("sleeve", 0.07, 0.5, 6, 7), material_of("sleeve", (0.2, 0.4, 0.6)))
    tube.parent = arm
    groups = {bone: tube.vertex_groups.new(name=bone) for bone in ("upper", "lower")}
    for vertex in tube.data.vertices:
        share = min(max((vertex.co.y - 0.15) / 0.2, 0.0), 1.0)
        groups["upper"].add([vertex.index], 1.0 - share, "REPLACE")
        groups["lower"].add([vertex.index], share, "REPLACE")
    tube.modifiers.new("arm", "ARMATURE").object = arm

    arm.rotation_euler = (math.radians(75), math.radians(10), math.radians(-20))
    start, rise = before_camera(-0.55, -0.75, 2.1), Vector((0.0, 0.0, 0.2))
    key(arm, "location", {0: start, LAST_FRAME: start + rise}, "LINEAR")
    bent = Quaternion((1.0, 0.0, 0.2), math.radians(70))
    key(arm.pose.bones["lower"], "rotation_quaternion", {0: Quaternion(), 25: bent, LAST_FRAME: Quaternion()}, "BEZIER")


def cloud():
    """Loose vertices with a radius and a colour (bytes) each; the exporter writes them as points. Their material says
    how large points without a radius are: gltfpack loses them."""
    vertices = []
    for k in range(24):
        turn = 2.4 * k  # a sunflower's
        away = 0.03 * math.sqrt(k + 1)
        vertices.append((away * math.cos(turn), away * math.sin(turn), 0.01 * k))
    mesh = mesh_of("cloud", vertices, [])
    radius = mesh.attributes.new("radius", "FLOAT", "POINT")
    colours = mesh.color_attributes.new("paint", "BYTE_COLOR", "POINT")
    for k in range(24):
        radius.data[k].value = 0.01 + 0.0005 * k
        colours.data[k].color_srgb = ((10 * k + 5) / 255, 128 / 255, (250 - 10 * k) / 255, 1.0)
    material = material_of("cloud", (1.0, 1.0, 1.0))
    material["pmdsim_point_area_m2"] = 8e-4
    thing = add("Cloud", mesh, material)
    thing.location = before_camera(1.0, 0.35, 2.2)
    thing.rotation_euler = CAMERA_TURN


def floor():
    material = material_of("floor", (0.25, 0.22, 0.2))
    material.node_tree.nodes["Principled BSDF"].inputs["Specular"].default_value = 0.25
    material.node_tree.nodes["Principled BSDF"].inputs["Clearcoat"].default_value = 0.5
    thing = add("Floor", sheet_mesh("floor", 6.0, 6.0, 3, 3), material)
    thing.location = (0.0, 1.5, 0.0)


def lamp():
    """What people's scenes have and a simulator of its own light has no use for."""
    thing = add("Lamp", bpy.data.lights.new("Lamp", "SPOT"))
    thing.location = (1.0, -1.0, 3.0)


def build():
    """An empty file becomes the scene."""
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    scene = bpy.context.scene
    scene.render.fps, scene.render.fps_base = FRAME_RATE_HZ, 1.0
    scene.frame_start, scene.frame_end = 0, LAST_FRAME
    scene.render.resolution_x, scene.render.resolution_y = 160, 120
    floor()
    plate()
    cameras(cart())
    spinner()
    posters(pattern_image(), photo_image())
    sleeve()
    cloud()
    lamp()
    scene.frame_set(0)


def export(path, sampled):
    bpy.ops.export_scene.gltf(
        filepath=str(path),
        export_format="GLB",
        export_cameras=True,
        export_lights=True,
        export_extras=True,
        export_attributes=True,
        use_mesh_vertices=True,
        export_animations=True,
        export_frame_range=True,
        export_force_sampling=sampled,
        export_skins=True,
        export_yup=True,
    )


def main():
    arguments = sys.argv[sys.argv.index("--") + 1 :]
    build()
    export(Path(arguments[0]).resolve(), sampled="--keys" not in arguments[1:])


if __name__ == "__main__":
    main()
