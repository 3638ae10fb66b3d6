"""The peer of the bake race: run by `blender --background --factory-startup --python` with the folder of
model.glb, first.png and second.png behind `--`. Reads commands from standard input, answers in lines that
begin with `cycles:`.

  bake SIZE THREADS  bakes tangent-space normals; answers with processor seconds and wall seconds of the call
  save SIZE FILE     bakes without the noise and writes the result as OpenEXR
  quit
"""
import sys
import time

import bpy
import numpy

# Debian 12 pairs this importer with a numpy that has dropped the old name.
if not hasattr(numpy, "bool"):
    numpy.bool = bool

folder, frequency, height = sys.argv[sys.argv.index("--") + 1:][:3]


def answer(text):
    print("cycles: " + text, flush=True)


for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
bpy.ops.import_scene.gltf(filepath=folder + "/model.glb")
mesh = next(o for o in bpy.data.objects if o.type == "MESH")
bpy.context.view_layer.objects.active = mesh
mesh.select_set(True)

scene = bpy.context.scene
scene.render.engine = "CYCLES"
scene.cycles.device = "CPU"
scene.cycles.samples = 1
scene.cycles.use_adaptive_sampling = False
scene.cycles.use_denoising = False
scene.cycles.use_auto_tile = False
scene.render.threads_mode = "FIXED"
scene.render.bake.margin = 0
scene.render.bake.use_clear = False

material = bpy.data.materials.new("race")
material.use_nodes = True
mesh.data.materials.clear()
mesh.data.materials.append(material)
nodes = material.node_tree.nodes
links = material.node_tree.links
nodes.clear()


def normal_map(file, uv_map):
    coordinate = nodes.new("ShaderNodeUVMap")
    coordinate.uv_map = uv_map
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = bpy.data.images.load(folder + "/" + file)
    texture.image.colorspace_settings.name = "Non-Color"
    links.new(coordinate.outputs[0], texture.inputs["Vector"])
    bump = nodes.new("ShaderNodeNormalMap")
    bump.uv_map = uv_map
    links.new(texture.outputs["Color"], bump.inputs["Color"])
    return bump.outputs["Normal"]


def vector_math(operation, a, b=None):
    node = nodes.new("ShaderNodeVectorMath")
    node.operation = operation
    links.new(a, node.inputs[0])
    if b is not None:
        links.new(b, node.inputs["Scale"] if operation == "SCALE" else node.inputs[1])
    return node.outputs["Value"] if operation == "DOT_PRODUCT" else node.outputs["Vector"]


def over_cosine(bumped, base):
    """The bumped normal over its part along the base: the base less the surface gradient."""
    divide = nodes.new("ShaderNodeMath")
    divide.operation = "DIVIDE"
    divide.inputs[0].default_value = 1
    links.new(vector_math("DOT_PRODUCT", bumped, base), divide.inputs[1])
    return vector_math("SCALE", bumped, divide.outputs[0])


names = [layer.name for layer in mesh.data.uv_layers]
base = nodes.new("ShaderNodeNewGeometry").outputs["Normal"]
one = over_cosine(normal_map("first.png", names[0]), base)
two = over_cosine(normal_map("second.png", names[1]), base)
both = vector_math("NORMALIZE", vector_math("SUBTRACT", vector_math("ADD", one, two), base))

noise = nodes.new("ShaderNodeTexNoise")
noise.inputs["Scale"].default_value = float(frequency)
noise.inputs["Detail"].default_value = 0
links.new(nodes.new("ShaderNodeTexCoord").outputs["Object"], noise.inputs["Vector"])
bump = nodes.new("ShaderNodeBump")
bump.inputs["Distance"].default_value = 2 * float(height)  # its noise spans half of ours
links.new(noise.outputs["Fac"], bump.inputs["Height"])
links.new(both, bump.inputs["Normal"])

shader = nodes.new("ShaderNodeBsdfDiffuse")
links.new(shader.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
target = nodes.new("ShaderNodeTexImage")
nodes.active = target
targets = {}


def bake(size, threads, with_noise):
    if size not in targets:
        targets[size] = bpy.data.images.new(f"target {size}", size, size, float_buffer=True, is_data=True)
    target.image = targets[size]
    scene.render.threads = threads
    links.new(bump.outputs["Normal"] if with_noise else both, shader.inputs["Normal"])
    cpu, wall = time.process_time(), time.perf_counter()
    bpy.ops.object.bake(type="NORMAL", normal_space="TANGENT")
    return time.process_time() - cpu, time.perf_counter() - wall


answer("ready " + bpy.app.version_string)
for line in sys.stdin:
    command = line.split()
    if not command or command[0] == "quit":
        break
    if command[0] == "bake":
        answer("%.6f %.6f" % bake(int(command[1]), int(command[2]), True))
    elif command[0] == "save":
        bake(int(command[1]), 1, False)
        image = target.image
        image.filepath_raw = command[2]
        image.file_format = "OPEN_EXR"
        image.save()
        answer("saved")
