"""A facewire recording (.csv) as the animation of a character in Blender: an add-on, and a command.

blender -b [FILE.blend] -P facewire_recording/__init__.py -- --recording take.csv [--character head.glb] --out take.blend
"""
import argparse
import csv
import json
import math
import pathlib
import re
import sys

import bpy
import numpy
from bpy_extras.io_utils import ImportHelper
from mathutils import Matrix, Vector

bl_info = {
    "name": "facewire recording (.csv)",
    "author": "the facewire engineers",
    "version": (1, 0, 0),
    "blender": (3, 4, 0),
    "location": "File > Import > facewire recording (.csv)",
    "description": "Moves shape keys and bones of the selected character as a recording says",
    "category": "Import-Export",
}

GAP_S, EASE_S = 0.2, 0.04  # so long a pose stays, and so long the way to the next takes then
METRES = 0.01  # a recording is in centimetres
# facewire: x to the character's left, y up, z out of its face. Blender's characters look along -y, z is up.
IN_BLENDER = Matrix(((1, 0, 0), (0, 0, -1), (0, 1, 0)))
AXES = ("x", "y", "z")
TURNS = ("pitch", "yaw", "roll")
SIDES = {"l": "left", "left": "left", "r": "right", "right": "right"}
# What shapes may have told already: a bone of that beginning stays still where a shape of this beginning moves.
SAME = {"jaw": "jaw", "eye_": "eyeLook", "upper_lid": "eyeBlink", "lower_lid": "eyeBlink", "brow": "brow", "lip": "mouth",
        "upper_lip": "mouth", "lower_lip": "mouth"}
SURE = ["exact", "spelling", "synonym", "combined"]  # a whole expression is moved by no single signal


class BadInput(Exception):
    """What is wrong, where, and what would be right."""


def names_table():
    here = pathlib.Path(__file__).resolve().parent
    for folder in (here, here.parent.parent / "names"):
        if (folder / "shapes.json").is_file():
            return json.loads((folder / "shapes.json").read_text(encoding="utf-8"))
    raise BadInput(f"{here} has no shapes.json: install the add-on from its .zip, which holds both")


class Names:
    """What names of shape keys mean: the rules of `facewire rig import`, by the same table (tools/names)."""

    def __init__(self):
        self.table = names_table()
        self.arkit = [(name, "".join(words), side) for name in self.table["arkit"] for words, side in [take_apart(name)]]

    def match(self, name):
        """(how sure, {signal: gain}), or None when the name says nothing."""
        if name in self.table["arkit"]:
            return "exact", {name: 1}
        words, side = take_apart(name)
        while words:
            found = self._find("".join(words), side)
            if found:
                return found
            if words[0] not in self.table["fillers"]:
                return None
            words = words[1:]
        return None

    def _find(self, joined, side):
        found = self._find_arkit(joined, side, "spelling")
        if found:
            return found
        if joined in self.table["synonyms"]:
            return self._find_arkit(self.table["synonyms"][joined], side, "synonym")
        name = self.table["presetSynonyms"].get(joined, joined)
        for preset in self.table["presets"]:
            if preset["name"] == name and preset.get("side") == side:
                return preset["match"], dict(preset["signals"])
        return None

    def _find_arkit(self, joined, side, how):
        alike = [(name, its) for name, its_joined, its in self.arkit if its_joined == joined]
        for name, its in alike:
            if its == side:
                return how, {name: 1}
        if side is None:  # jawLeft and jawRight are opposites, no halves of a jaw
            signals = {} if joined in ("jaw", "mouth") else {name: 0.5 for name, _ in alike}
        else:
            signals = {name: 1 for name, its in alike if its is None}
        return ("combined", signals) if signals else None


def words_of(name):
    split = re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", name)
    return [word for word in re.split(r"[_\-. ]", re.sub("[A-Z]", lambda c: c[0].lower(), split)) if word]


def take_apart(name):
    """"eye.L" and "FaceEye_L" as small words and a side."""
    bare = re.split("[:|]", name)[-1]
    before, dot, behind = bare.rpartition(".")
    if dot and before:
        words = words_of(behind)
        if not (re.fullmatch("[0-9]*", behind) or (len(words) == 1 and words[0] in SIDES)):
            bare = behind
    words = words_of(bare)
    if len(words) > 1:
        for i in reversed(range(len(words))):
            if words[i] in SIDES:
                return words[:i] + words[i + 1:], SIDES[words[i]]
    ending = re.fullmatch("(.+)(left|right)", words[-1]) if words else None
    return (words[:-1] + [ending[1]], ending[2]) if ending else (words, None)


class Recording:
    """Columns of a .csv of `facewire retarget`, `facewire monitor` or the page: times in seconds, values by channel."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        try:
            with open(path, newline="", encoding="utf-8") as file:
                header, *lines = list(csv.reader(file)) or [[]]
        except (OSError, UnicodeDecodeError, csv.Error) as error:
            raise BadInput(f"{path}: {getattr(error, 'strerror', None) or error}: a recording is a .csv of facewire") from None
        fixed = [name for name in ("frame", "t_us", "age_us", "state") if name in header]
        if header[:2] != ["frame", "t_us"] or "state" not in fixed:
            raise BadInput(f"{path}: line 1 does not begin with frame,t_us and has no state: a recording is a .csv of facewire")
        self.channels = header[len(fixed):]
        twice = {name for name in self.channels if self.channels.count(name) > 1}
        if twice:
            raise BadInput(f"{path}: line 1 has {sorted(twice)[0]} twice")
        # The performer's head, which a rig with a neck follows already.
        turned = any(name.startswith("neck.") for name in self.channels)
        rows = []
        for number, line in enumerate(lines, 2):
            if len(line) != len(header):
                raise BadInput(f"{path}: line {number} has {len(line)} fields and not {len(header)}")
            if "" in line[len(fixed):]:
                continue  # no face was seen
            try:
                rows.append([float(line[1]) / 1e6] + [float(value) for value in line[len(fixed):]])
            except ValueError:
                raise BadInput(f"{path}: line {number} has something else than numbers") from None
        if not rows:
            raise BadInput(f"{path}: there is no line with values")
        table = numpy.array(rows)
        # A camera that hands out the same picture twice: what the character was told last.
        table = table[numpy.append(numpy.diff(table[:, 0]) != 0, True)]
        if not numpy.isfinite(table).all() or (numpy.diff(table[:, 0]) <= 0).any():
            raise BadInput(f"{path}: times must rise, and values be finite numbers")
        # A lost line, or a performer who was gone, leaves the character where it was until the next pose.
        held = numpy.flatnonzero(numpy.diff(table[:, 0]) > GAP_S)
        stays = table[held].copy()
        stays[:, 0] = table[held + 1, 0] - EASE_S
        table = numpy.insert(table, held + 1, stays, axis=0)
        self.times = table[:, 0] - table[0, 0]
        self.values = {name: table[:, 1 + i] for i, name in enumerate(self.channels) if not (turned and name.startswith("head."))}
        self.channels = list(self.values)


def new_action(owner, name):
    data = owner.animation_data or owner.animation_data_create()
    if data.action:
        data.action.use_fake_user = True  # what was there stays in the file
    data.action = bpy.data.actions.new(name)
    return data.action


def add_curve(action, path, index, frames, values, group=None):
    curve = action.fcurves.new(path, index=index, action_group=group or "")
    curve.keyframe_points.add(len(frames))
    curve.keyframe_points.foreach_set("co", numpy.column_stack([frames, values]).ravel().tolist())
    for point in curve.keyframe_points:
        point.interpolation = "LINEAR"
    curve.update()


def move_shapes(recording, meshes, names, frames):
    """Returns which channels moved something."""
    moved = set()
    for keys in {obj.data.shape_keys for obj in meshes if obj.data.shape_keys}:
        blocks = [(block, names.match(block.name)) for block in keys.key_blocks if block != keys.reference_key]
        own = [(block, "exact", {block.name: 1}) for block, _ in blocks if block.name in recording.values]
        taken = {block for block, _, _ in own}
        other = [(block, *match) for block, match in blocks if match and block not in taken and match[0] in SURE]
        best = {}
        for _, how, signals in own + other:
            for signal in signals:
                best[signal] = min(best.get(signal, len(SURE)), SURE.index(how))
        curves = [(block, signals) for block, how, signals in own + other
                  if all(s in recording.values for s in signals) and any(best[s] == SURE.index(how) for s in signals)]
        if not curves:
            continue
        action = new_action(keys, f"{recording.path.stem}_{keys.name}")
        for block, signals in curves:
            weights = sum(gain * recording.values[signal] for signal, gain in signals.items())
            block.slider_min, block.slider_max = min(block.slider_min, weights.min()), max(block.slider_max, weights.max())
            add_curve(action, f'key_blocks["{bpy.utils.escape_identifier(block.name)}"].value', 0, frames, weights)
            moved.update(signals)
    return moved


def turn(pitch, yaw, roll):
    """R = Ry(yaw) Rx(pitch) Rz(roll), in Blender's axes."""
    y, x, z = (Matrix.Rotation(math.radians(angle), 3, axis) for angle, axis in ((yaw, "Y"), (pitch, "X"), (roll, "Z")))
    return IN_BLENDER @ (y @ x @ z) @ IN_BLENDER.transposed()


def bone_of(part, armature):
    """The pose bone of a rig's bone, by its name or the same name written otherwise; a head where there is no neck."""
    exact = armature.pose.bones.get(part)
    alike = [bone for bone in armature.pose.bones if take_apart(bone.name) == take_apart(part)]
    return exact or (alike[0] if alike else bone_of("head", armature) if part == "neck" else None)


def move_bones(recording, armatures, frames, told):
    """`told`: channels that shapes show already. Returns which channels moved something."""
    moved = set()
    zero = numpy.zeros(len(frames))
    wanted = {channel.rpartition(".")[0] for channel in recording.channels if channel.rpartition(".")[2] in AXES + TURNS}
    for armature in armatures:
        still = {part for part in wanted
                 if any(part.startswith(bone) and any(t.startswith(shape) for t in told) for bone, shape in SAME.items())}
        moved.update(f"{part}.{axis}" for part in still for axis in AXES + TURNS)  # by shapes
        found = {part: bone_of(part, armature) for part in sorted(wanted - still)}
        found = {part: bone for part, bone in found.items() if bone}
        if not found:
            continue
        # The character may rest in another pose than the one its mesh is bound in; an animation of its own is no rest.
        animated = armature.animation_data and armature.animation_data.action
        action = new_action(armature, f"{recording.path.stem}_{armature.name}")
        world = armature.matrix_world
        into = world.to_quaternion().to_matrix().inverted()  # from Blender's axes to the armature's
        scale = sum(world.to_scale()) / 3
        for part, bone in found.items():
            basis, posed = (Matrix(), bone.bone.matrix_local) if animated else (bone.matrix_basis.copy(), bone.matrix)
            own = basis.to_3x3().normalized()
            rest = posed.to_3x3().normalized() @ own.inverted()  # the axes that its own pose is in, in the armature's
            column = lambda axis, of=part: recording.values.get(f"{of}.{axis}", zero)
            angles = numpy.column_stack([column(a) for a in TURNS])
            # A head would leave its neck.
            shifts = numpy.column_stack([column(a) if part != "head" else zero for a in AXES])
            bone.rotation_mode = "QUATERNION"
            path = f'pose.bones["{bpy.utils.escape_identifier(bone.name)}"]'
            if angles.any():
                turns = []
                for one in angles:
                    q = (rest.inverted() @ into @ turn(*one) @ into.inverted() @ rest @ own).to_quaternion()
                    turns.append(-q if turns and q.dot(turns[-1]) < 0 else q)  # the short way between two keys
                for i in range(4):
                    add_curve(action, f"{path}.rotation_quaternion", i, frames, [q[i] for q in turns], bone.name)
            if shifts.any():
                places = [basis.translation + rest.inverted() @ into @ IN_BLENDER @ Vector(one) * (METRES / scale) for one in shifts]
                for i in range(3):
                    add_curve(action, f"{path}.location", i, frames, [p[i] for p in places], bone.name)
            moved.update(f"{part}.{axis}" for axis in AXES + TURNS if f"{part}.{axis}" in recording.values)
    return moved


def apply(recording, objects, scene):
    """Moves `objects` as the recording says, from the scene's first frame on. Returns the channels that moved nothing."""
    meshes = [obj for obj in objects if obj.type == "MESH"]
    armatures = [obj for obj in objects if obj.type == "ARMATURE"]
    bpy.context.view_layer.update()  # an imported pose counts from here on
    fps = scene.render.fps / scene.render.fps_base
    frames = scene.frame_start + recording.times * fps
    shown = move_shapes(recording, meshes, Names(), frames)
    moved = shown | move_bones(recording, armatures, frames, shown)
    if not moved:
        raise BadInput(f"{recording.path}: nothing of {', '.join(o.name for o in objects) or 'an empty selection'} has a name "
                       "of the recording: shape keys have ARKit's names, bones those of the rig")
    scene.frame_end = max(scene.frame_end, math.ceil(frames[-1]))
    return [channel for channel in recording.channels if channel not in moved]


def import_character(path):
    if not pathlib.Path(path).is_file():
        raise BadInput(f"{path}: no such file: a character is a .glb or .gltf")
    # The importer of Debian 12's Blender asks for a name that its numpy no longer has.
    if not hasattr(numpy, "bool"):
        numpy.bool = bool
    before = set(bpy.data.objects)
    try:
        bpy.ops.import_scene.gltf(filepath=str(path))
    except RuntimeError as error:
        raise BadInput(f"{path}: {str(error).strip().splitlines()[-1]}") from None
    return [obj for obj in bpy.data.objects if obj not in before]


class ImportRecording(bpy.types.Operator, ImportHelper):
    """Moves the selected character as a facewire recording says"""
    bl_idname = "import_anim.facewire"
    bl_label = "Import facewire recording"
    bl_options = {"REGISTER", "UNDO"}
    filename_ext = ".csv"
    filter_glob: bpy.props.StringProperty(default="*.csv", options={"HIDDEN"})

    def execute(self, context):
        chosen = context.selected_objects or list(context.scene.objects)
        whole = {child for obj in chosen for child in [obj, *obj.children_recursive]}
        try:
            idle = apply(Recording(self.filepath), sorted(whole, key=lambda obj: obj.name), context.scene)
        except BadInput as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"moves nothing: {', '.join(idle)}" if idle else "every channel moves something")
        return {"FINISHED"}


def menu(self, _):
    self.layout.operator(ImportRecording.bl_idname, text=bl_info["name"])


def register():
    bpy.utils.register_class(ImportRecording)
    bpy.types.TOPBAR_MT_file_import.append(menu)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(menu)
    bpy.utils.unregister_class(ImportRecording)


def main(arguments):
    parser = argparse.ArgumentParser(prog="facewire_recording", description=__doc__.splitlines()[0])
    parser.add_argument("--recording", required=True, help=".csv of facewire retarget, facewire monitor or the page")
    parser.add_argument("--character", help=".glb or .gltf; else the characters of the file that is open")
    parser.add_argument("--out", required=True, help="the .blend to write")
    parser.add_argument("--fps", type=float, default=24, help="frames a second of the scene (24)")
    options = parser.parse_args(arguments)
    try:
        recording = Recording(options.recording)
        if not 1 <= options.fps <= 1000:
            raise BadInput(f"--fps {options.fps:g}: 1 to 1000 frames a second")
        if options.character and not bpy.data.filepath:
            bpy.ops.wm.read_factory_settings(use_empty=True)
        scene = bpy.context.scene
        scene.render.fps, scene.render.fps_base = math.ceil(options.fps), math.ceil(options.fps) / options.fps
        objects = import_character(options.character) if options.character else list(scene.objects)
        idle = apply(recording, objects, scene)
        bpy.ops.wm.save_as_mainfile(filepath=str(pathlib.Path(options.out).resolve()))
    except BadInput as error:
        print(f"facewire_recording: {error}", file=sys.stderr)
        return 2
    except RuntimeError as error:
        print(f"facewire_recording: {options.out}: {str(error).strip().splitlines()[-1]}", file=sys.stderr)
        return 1
    print(f"{len(recording.times)} poses, {recording.times[-1]:.1f} s, into {options.out}")
    if idle:
        print(f"moves nothing: {', '.join(idle)}")
    return 0


if __name__ == "__main__":
    # Blender's own arguments end at "--"; without it, somebody runs this in Blender's text editor.
    if "--" in sys.argv:
        sys.exit(main(sys.argv[sys.argv.index("--") + 1:]))
    register()
