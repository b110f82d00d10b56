import { AdditiveBlending, MeshPhysicalMaterial, MeshStandardMaterial } from 'three';

// What the character is made of.
export function materials() {
  return {
    shell: new MeshPhysicalMaterial({ name: 'shell', color: 0xe6ddcd, roughness: 0.42, clearcoat: 0.55, clearcoatRoughness: 0.22 }),
    lid: new MeshPhysicalMaterial({ name: 'lid', color: 0xcdb29c, roughness: 0.45, clearcoat: 0.35, clearcoatRoughness: 0.3 }),
    skin: new MeshPhysicalMaterial({ name: 'skin', color: 0xffffff, vertexColors: true, roughness: 0.5, clearcoat: 0.25, clearcoatRoughness: 0.35 }),
    blush: new MeshPhysicalMaterial({ name: 'blush', color: 0xe2c2ad, roughness: 0.45, clearcoat: 0.3, clearcoatRoughness: 0.3 }),
    light: new MeshStandardMaterial({ name: 'light', color: 0x0b2b2c, emissive: 0x27d3cf, emissiveIntensity: 1.6 }),
    brow: new MeshStandardMaterial({ name: 'brow', color: 0x33241d, roughness: 0.6 }),
    graphite: new MeshStandardMaterial({ name: 'graphite', color: 0x24272b, roughness: 0.5, metalness: 0.55 }),
    rubber: new MeshStandardMaterial({ name: 'rubber', color: 0x17181a, roughness: 0.7 }),
    brass: new MeshStandardMaterial({ name: 'brass', color: 0xc8965a, roughness: 0.28, metalness: 1 }),
    steel: new MeshStandardMaterial({ name: 'steel', color: 0xb9bec4, roughness: 0.25, metalness: 1 }),
    enamel: new MeshPhysicalMaterial({ name: 'enamel', color: 0xf1ece0, roughness: 0.25, clearcoat: 0.6 }),
    tongue: new MeshPhysicalMaterial({ name: 'tongue', color: 0xa9484a, roughness: 0.4, clearcoat: 0.5 }),
    eye: new MeshPhysicalMaterial({ name: 'eye', vertexColors: true, roughness: 0.35, clearcoat: 0.3 }),
    cornea: new MeshPhysicalMaterial({ name: 'cornea', color: 0x000000, roughness: 0.03, transparent: true, blending: AdditiveBlending, depthWrite: false }),
  };
}
