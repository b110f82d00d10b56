"""Inside Blender: what the add-on made of a recording, against what it should be: -- arkit|shapes|bones FILE.csv CHARACTER.glb CASES.json ADD-ON

arkit: shape keys and a neck; shapes: no bones; bones: no shape keys.
"""
import csv
import importlib.util
import json
import math
import sys

import bpy
from mathutils import Euler, Matrix, Quaternion

kind, take, character, cases, addon = sys.argv[sys.argv.index("--") + 1:]
spec = importlib.util.spec_from_file_location("facewire_recording", addon)
recording = importlib.util.module_from_spec(spec)
spec.loader.exec_module(recording)
scene = bpy.context.scene
armature = next((o for o in bpy.data.objects if o.type == "ARMATURE"), None)
faces = [o for o in bpy.data.objects if o.type == "MESH" and o.data.shape_keys]
resting = next((o for o in recording.import_character(character) if o.type == "ARMATURE"), None)  # the same, told nothing
rows = list(csv.DictReader(open(take, newline="", encoding="utf-8")))
fps = scene.render.fps / scene.render.fps_base


def at(row):
    frame = scene.frame_start + (int(row["t_us"]) - int(rows[0]["t_us"])) / 1e6 * fps
    scene.frame_set(math.floor(frame), subframe=frame % 1)
    return bpy.context.evaluated_depsgraph_get()


def turned(bone):
    """By how much, in facewire's axes: an independent way, from matrices of the world."""
    now = (armature.matrix_world @ armature.pose.bones[bone].matrix).to_3x3().normalized()
    rest = (resting.matrix_world @ resting.pose.bones[bone].matrix).to_3x3().normalized()
    axes = Matrix.Rotation(math.radians(-90), 3, "X")  # Blender's z up to y up
    return axes @ (now @ rest.inverted()) @ axes.inverted()


def expect(condition, what):
    if not condition:
        sys.exit(f"check: {what}")


def angle(a, b):
    return math.degrees((a.inverted() @ b).to_quaternion().angle)


# Without a face the pose before it stays.
for before, row in zip(rows, rows[1:]):
    row.update({key: before[key] for key in row if row[key] == ""})
for row in rows[::5] + [rows[-1]]:
    graph = at(row)
    if kind != "bones":
        keys = faces[0].evaluated_get(graph).data.shape_keys.key_blocks
        for key in keys[1:]:
            match = recording.Names().match(key.name)
            signal = next(iter(match[1]))
            expect(abs(key.value - float(row.get(signal) or 0)) < 1e-4, f"{key.name} is {key.value} and not {row.get(signal)}")
    if kind == "shapes":
        continue
    neck, jaw = recording.bone_of("neck", armature).name, "Jaw"
    angles = [math.radians(float(row[f"neck.{a}"])) for a in ("pitch", "yaw", "roll")]
    wanted = (Quaternion((0, 1, 0), angles[1]) @ Quaternion((1, 0, 0), angles[0]) @ Quaternion((0, 0, 1), angles[2])).to_matrix()
    expect(angle(turned(neck), wanted) < 0.01, f"{neck} is off by {angle(turned(neck), wanted)} degrees")
    if kind == "bones":
        # What hangs on the neck is carried by it.
        own = wanted.inverted() @ turned(jaw)
        expect(abs(angle(own, Euler((math.radians(float(row["jaw.pitch"])), 0, 0)).to_matrix())) < 0.01, "the jaw is off")

if kind != "bones":
    def vertices(frame):
        scene.frame_set(frame)
        mesh = faces[0].evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
        return [v.co.copy() for v in mesh.vertices]
    most = max((a - b).length for a, b in zip(vertices(scene.frame_start), vertices(scene.frame_start + 10)))
    expect(most > 0.003, f"no vertex moved more than {most} m")
    # The table of names means here what it means in C++ and JavaScript.
    for case in json.load(open(cases, encoding="utf-8"))["shapes"]:
        found, wanted = recording.Names().match(case["name"]), case.get("is")
        mine = None if found is None else (found[0], found[1])
        theirs = None if wanted is None else (wanted["match"], wanted["signals"])
        expect(mine == theirs, f'{case["name"]} is {mine} and not {theirs}')
print("check: good")
