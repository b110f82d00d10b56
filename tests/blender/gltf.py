"""Inside Blender: a .glb of `facewire retarget` or of the page beside its .csv: -- FILE.glb FILE.csv"""
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
faces = [o for o in bpy.data.objects if o.type == "MESH" and o.data.shape_keys and o.data.shape_keys.animation_data]
# What Otto's bones show already has shape keys, too, which stay still; brow_inner_L.x and its like are in their own units.
moving = {}
for face in faces:
    curves = face.data.shape_keys.animation_data.action.fcurves
    shown = [c.data_path.split('"')[1] for c in curves if len({p.co.y for p in c.keyframe_points}) > 1]
    moving[face] = [name for name in shown if "." not in name]
names = {name for some in moving.values() for name in some}
if len(names) < 20:
    sys.exit(f"gltf: it moves {sorted(names)} only")
table = list(csv.DictReader(open(table, newline="", encoding="utf-8")))
rows = [row for row in table if row["jawOpen"]]
for row in rows[:: max(1, len(rows) // 20)]:
    frame = (int(row["t_us"]) - int(table[0]["t_us"])) / 1e6 * 24
    bpy.context.scene.frame_set(math.floor(frame), subframe=frame % 1)
    graph = bpy.context.evaluated_depsgraph_get()
    for face, own in moving.items():
        keys = face.evaluated_get(graph).data.shape_keys.key_blocks
        for name in own:
            if abs(keys[name].value - float(row[name])) > 1e-3:
                sys.exit(f"gltf: {name} at {row['t_us']} us is {keys[name].value} and not {row[name]}")
print(f"gltf: good, {len(names)} shape keys move")
