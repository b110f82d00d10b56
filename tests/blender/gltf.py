"""Inside Blender: a .glb of `facewire retarget` beside its .csv: -- FILE.glb FILE.csv"""
import csv
import math
import sys

import bpy
import numpy

glb, table = sys.argv[sys.argv.index("--") + 1:]
if not hasattr(numpy, "bool"):
    numpy.bool = bool  # Debian 12's importer asks for a name that its numpy no longer has
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.context.scene.render.fps = 24  # before importing: Blender turns seconds into frames then
bpy.ops.import_scene.gltf(filepath=glb)
face = next(o for o in bpy.data.objects if o.type == "MESH" and o.data.shape_keys)
rows = [row for row in csv.DictReader(open(table, newline="", encoding="utf-8")) if row["jawOpen"]]
for row in rows[::20]:
    frame = int(row["t_us"]) / 1e6 * 24
    bpy.context.scene.frame_set(math.floor(frame), subframe=frame % 1)
    keys = face.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.shape_keys.key_blocks
    for key in keys[1:]:
        if abs(key.value - float(row[key.name])) > 1e-3:
            sys.exit(f"gltf: {key.name} at {row['t_us']} us is {key.value} and not {row[key.name]}")
print("gltf: good")
