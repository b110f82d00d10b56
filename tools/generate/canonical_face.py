#!/usr/bin/python3
"""Prints C++ figures of the canonical face, made from MediaPipe's geometry_pipeline_metadata_landmarks.binarypb.

    tools/generate/canonical_face.py METADATA.binarypb > core/pose/canonical_face.cc
    tools/generate/canonical_face.py --mesh METADATA.binarypb > tools/facewire/rig/canonical_mesh.cc

The file is a serialized GeometryPipelineMetadata (mediapipe/modules/face_geometry/protos): field 1 the
canonical mesh (its field 3 the vertices, five floats each: x, y, z in cm, u, v), field 2, repeated, the
landmarks of the pose fit (1 index, 2 weight).
"""

import struct
import sys


def varint(data, at):
    value = shift = 0
    while True:
        byte = data[at]
        value |= (byte & 0x7F) << shift
        shift += 7
        at += 1
        if byte < 0x80:
            return value, at


def fields(data):
    """Yields (number, value) of a protobuf message; length-delimited values as bytes."""
    at = 0
    while at < len(data):
        key, at = varint(data, at)
        kind = key & 7
        if kind == 0:
            value, at = varint(data, at)
        elif kind == 2:
            size, at = varint(data, at)
            value, at = data[at:at + size], at + size
            if len(value) != size:
                raise ValueError("the file ends too early")
        elif kind == 5:
            value, at = struct.unpack_from("<f", data, at)[0], at + 4
        else:
            raise ValueError(f"wire type {kind} does not occur in this file")
        yield key >> 3, value


def read(data):
    floats, basis = [], []
    for number, value in fields(data):
        if number == 1:
            for inner, vertices in fields(value):
                if inner == 3 and isinstance(vertices, bytes):  # packed
                    floats += struct.unpack(f"<{len(vertices) // 4}f", vertices)
                elif inner == 3:
                    floats.append(vertices)
        elif number == 2:
            entry = dict(fields(value))
            basis.append((entry[1], entry[2]))
    vertices = [floats[i:i + 3] for i in range(0, len(floats), 5)]
    if len(vertices) != 468 or len(basis) != 33:
        raise ValueError(f"{len(vertices)} vertices and {len(basis)} pose landmarks, not 468 and 33")
    return vertices, basis


def head(header, namespace):
    print(f'#include "{header}"\n')
    print("// Made by tools/generate/canonical_face.py; edit that, not this.")
    print("// Figures from MediaPipe (Apache-2.0), npm package @mediapipe/face_mesh 0.4.1657299874,")
    print("// geometry_pipeline_metadata_landmarks.binarypb.")
    print(f"namespace {namespace} {{\n")
    print("// clang-format off")


def pose(vertices, basis):
    head("core/pose/canonical_face.h", "facewire::pose")
    print("const std::array<CanonicalPoint, kCanonicalPoints> kCanonicalFace = {{")
    for index, weight in basis:
        x, y, z = vertices[index]
        print(f"    {{{index}, {weight:.6f}F, {{{x:.6f}F, {y:.6f}F, {z:.6f}F}}}},")
    print("}};")
    print("// clang-format on\n")
    print("}  // namespace facewire::pose")


def mesh(vertices):
    head("tools/facewire/rig/canonical_mesh.h", "facewire::tools::rig")
    print("const std::array<Point3, kMeshLandmarks> kCanonicalMesh = {{")
    for at in range(0, len(vertices), 3):
        print("    " + " ".join(f"{{{x:.3f}F, {y:.3f}F, {z:.3f}F}}," for x, y, z in vertices[at:at + 3]))
    print("}};")
    print("// clang-format on\n")
    print("}  // namespace facewire::tools::rig")


def main():
    arguments = [a for a in sys.argv[1:] if a != "--mesh"]
    if len(arguments) != 1:
        sys.exit("usage: canonical_face.py [--mesh] METADATA.binarypb > FILE.cc")
    try:
        with open(arguments[0], "rb") as file:
            vertices, basis = read(file.read())
    except (OSError, ValueError, KeyError, IndexError, struct.error) as error:
        sys.exit(f"canonical_face.py: {arguments[0]}: {error}")
    if "--mesh" in sys.argv:
        mesh(vertices)
    else:
        pose(vertices, basis)


if __name__ == "__main__":
    main()
