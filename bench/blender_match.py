"""A baked model in Blender: run by `blender --background --factory-startup --python` with, behind `--`, a glTF
binary that carries its baked map, pictures of the composed and of the interpolated normals (OpenEXR, world space)
and the camera that they were made with: side of the pictures, position, target, vertical field of view in degrees.
Renders the model's normals with Cycles and prints how far they are from the composed ones, as one line of JSON
behind `match: `.

Left out are pixels whose composed normal mirrors the viewer to below the surface: Cycles bends such normals, with
whatever map, until it does not.
"""
import json
import math
import os
import shutil
import sys
import tempfile

import bpy
import mathutils
import numpy

# Debian 12 pairs this importer with a numpy that has dropped the old name.
if not hasattr(numpy, "bool"):
    numpy.bool = bool

model, composed, interpolated, *camera = sys.argv[sys.argv.index("--") + 1:]
side = int(camera[0])
position, target = ([float(v) for v in camera[i:i + 3]] for i in (1, 4))
fov = math.radians(float(camera[7]))


def from_gltf(v):
    """glTF's y is up, Blender's is z."""
    return mathutils.Vector((v[0], -v[2], v[1]))


for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
bpy.ops.import_scene.gltf(filepath=model)

eye = bpy.data.cameras.new("eye")
eye.sensor_fit = "VERTICAL"
eye.angle = fov
eye.clip_start = 0.001
place = bpy.data.objects.new("eye", eye)
place.location = from_gltf(position)
place.rotation_euler = (from_gltf(target) - place.location).to_track_quat("-Z", "Y").to_euler()
bpy.context.collection.objects.link(place)

scene = bpy.context.scene
scene.camera = place
scene.render.engine = "CYCLES"
scene.cycles.device = "CPU"
scene.cycles.samples = 1
scene.cycles.use_adaptive_sampling = False
scene.cycles.use_denoising = False
scene.cycles.max_bounces = 0
# One sample in the middle of each pixel, as our picture has.
scene.cycles.pixel_filter_type = "BOX"
scene.cycles.filter_width = 0.01
scene.render.resolution_x = scene.render.resolution_y = side
scene.render.resolution_percentage = 100
bpy.context.view_layer.use_pass_normal = True

scene.use_nodes = True
nodes = scene.node_tree.nodes
nodes.clear()
layers = nodes.new("CompositorNodeRLayers")
folder = tempfile.mkdtemp()
writer = nodes.new("CompositorNodeOutputFile")
writer.base_path = folder
writer.format.file_format = "OPEN_EXR"
writer.format.color_depth = "32"
scene.node_tree.links.new(layers.outputs["Normal"], writer.inputs[0])
scene.render.filepath = os.path.join(folder, "unused")
bpy.ops.render.render()


def pixels_of(file):
    image = bpy.data.images.load(file)
    image.colorspace_settings.name = "Non-Color"
    values = numpy.empty(len(image.pixels), dtype=numpy.float32)
    image.pixels.foreach_get(values)
    return values.reshape(side, side, -1)[:, :, :3].astype(numpy.float64)


theirs = pixels_of(os.path.join(folder, os.listdir(folder)[0]))
shutil.rmtree(folder)
theirs = numpy.stack([theirs[:, :, 0], theirs[:, :, 2], -theirs[:, :, 1]], axis=2)
ours = pixels_of(composed)
base = pixels_of(interpolated)

lengths = numpy.linalg.norm(ours, axis=2), numpy.linalg.norm(theirs, axis=2)
shown = (lengths[0] > 0.5) & (lengths[1] > 0.5)

# Towards the viewer of every pixel.
half = math.tan(fov / 2)
steps = (numpy.arange(side) + 0.5) / side * 2 - 1
forward = numpy.array(target) - numpy.array(position)
forward /= numpy.linalg.norm(forward)
right = numpy.cross(forward, [0, 1, 0])
right /= numpy.linalg.norm(right)
up = numpy.cross(right, forward)
to_viewer = -(forward + half * (steps[None, :, None] * right + steps[:, None, None] * up))
to_viewer /= numpy.linalg.norm(to_viewer, axis=2, keepdims=True)
mirrored = 2 * numpy.sum(ours * to_viewer, axis=2, keepdims=True) * ours - to_viewer
unbent = numpy.sum(mirrored * base, axis=2) > 0.05
compared = shown & unbent
a, b = ours[compared], theirs[compared]
degrees = numpy.degrees(numpy.arctan2(numpy.linalg.norm(numpy.cross(a, b), axis=1), numpy.sum(a * b, axis=1)))
degrees.sort()
print("match: " + json.dumps({
    "blender": bpy.app.version_string,
    "pixels": int(compared.sum()),
    "left_out": int((shown & ~unbent).sum()),
    "mean_deg": float(degrees.mean()),
    "half_deg": float(degrees[len(degrees) // 2]),
    "high_deg": float(degrees[int(0.99 * len(degrees))]),
}), flush=True)
