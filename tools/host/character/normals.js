import { BufferAttribute, BufferGeometry } from 'three';

// A file without normals is drawn in facets, as glTF says. A face whose triangles share vertices was meant to be round: it gets
// normals, and each of its shapes how it changes them, so that light follows a smile.
export function smooth(mesh) {
  const { geometry } = mesh, { position, normal } = geometry.attributes;
  if (normal || !geometry.index) return;
  geometry.computeVertexNormals();
  const rest = geometry.attributes.normal, moved = new BufferGeometry().setIndex(geometry.index);
  const shapes = geometry.morphAttributes.position;
  if (shapes) geometry.morphAttributes.normal = shapes.map((offsets) => {
    const places = new Float32Array(3 * position.count);
    for (let i = 0; i < position.count; ++i) {
      places[3 * i] = position.getX(i) + offsets.getX(i);
      places[3 * i + 1] = position.getY(i) + offsets.getY(i);
      places[3 * i + 2] = position.getZ(i) + offsets.getZ(i);
    }
    moved.setAttribute('position', new BufferAttribute(places, 3));
    moved.deleteAttribute('normal');
    moved.computeVertexNormals();
    return new BufferAttribute(moved.attributes.normal.array.map((n, i) => n - rest.array[i]), 3);
  });
  for (const material of [mesh.material].flat()) {
    material.flatShading = false;
    material.needsUpdate = true;
  }
}
