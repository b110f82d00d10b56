"""The 51 ARKit shapes that landmarks can show (all but tongueOut), and what they belong to."""


def sides(*names):
    return [name + side for name in names for side in ("Left", "Right")]


ALL = (["browInnerUp"] + sides("browDown", "browOuterUp") +
       sides("eyeBlink", "eyeLookDown", "eyeLookIn", "eyeLookOut", "eyeLookUp", "eyeSquint", "eyeWide") +
       ["cheekPuff"] + sides("cheekSquint", "noseSneer") + ["jawForward", "jawLeft", "jawRight", "jawOpen"] +
       ["mouthClose", "mouthFunnel", "mouthPucker", "mouthLeft", "mouthRight"] +
       sides("mouthSmile", "mouthFrown", "mouthDimple", "mouthStretch", "mouthPress", "mouthLowerDown", "mouthUpperUp") +
       ["mouthRollLower", "mouthRollUpper", "mouthShrugLower", "mouthShrugUpper"])


def is_mouth(shape):
    return shape.startswith(("mouth", "jaw", "cheekPuff"))


def is_brow(shape):
    return shape.startswith("brow")
